# SPDX-License-Identifier: GPL-3.0-or-later
"""What several operators ask first."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from ..logic import library, presets
from . import flower
from .preferences import PACKAGE


def preset_folder(create: bool = False) -> Path:
    """Where the user's presets are kept."""
    return Path(bpy.utils.extension_path_user(PACKAGE, path="presets", create=create))


def preset_files() -> dict[str, Path]:
    """All presets by name: those that come with the add-on, then the user's."""
    return presets.bundled() | presets.saved(preset_folder())


def ready(cls: Any) -> bool:
    """Whether the library is there; else says so."""
    if library.problem():
        cls.poll_message_set("Voxelastica's library did not load; the panel says why")
        return False
    return True


def has_flower(cls: Any, context: bpy.types.Context) -> bool:
    """Whether there is a flower to work on; else says so."""
    if not ready(cls):
        return False
    root = flower.shown(context)
    if root is None:
        cls.poll_message_set("Select a flower, or make one with New Flower")
        return False
    if root.library or root.override_library:
        cls.poll_message_set("This flower is linked from another file: make it local first")
        return False
    if mode := flower.busy_mode(root):
        cls.poll_message_set(f"Leave {mode} first")
        return False
    return True
