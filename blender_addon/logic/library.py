# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads the project's Python package, and remembers why where it does not load."""

from __future__ import annotations

import importlib
import platform
from types import ModuleType

_package: ModuleType | None = None
_problem = "The library is not loaded yet."


class LibraryMissing(RuntimeError):
    """The native library did not load; the message says why and what helps."""


def load() -> bool:
    """Loads the library; whether it is there now. Safe to call again."""
    global _package, _problem
    if _package is None:
        try:
            _package = importlib.import_module("voxelastica")
        except Exception as error:  # noqa: BLE001 - whatever it is, the panel says it and Blender goes on
            machine = f"{platform.system()} on {platform.machine()}"
            _problem = (
                f"Voxelastica's library did not load here ({machine}): {error}. "
                "Install the zip that was built for this platform."
            )
            return False
        _problem = ""
    return True


def problem() -> str:
    """Why the library is not there; empty where it is."""
    return _problem


def api() -> ModuleType:
    """The package ``voxelastica``.

    :raises LibraryMissing: where it did not load
    """
    if _package is None:
        raise LibraryMissing(_problem)
    return _package
