"""Marks the wheel as one that holds a native library for a platform, and for any Python 3."""

from __future__ import annotations

import os
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class NativeHook(BuildHookInterface):
    """Sets the wheel's tag."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Called by hatchling before it builds; an editable install keeps its plain tag."""
        if version == "standard":
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{os.environ.get('VOXELASTICA_PLATFORM', 'manylinux_2_17_x86_64')}"
