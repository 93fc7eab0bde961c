# SPDX-License-Identifier: MIT OR Apache-2.0
"""Finds the project's Python package and, through it, the native library."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import FreeCAD as App

from .settings import MacroError

#: Where the panel keeps the folder that the user chose.
PREFERENCES = "User parameter:Plugins/Voxelastica"


def _places() -> Iterator[Path]:
    """Folders that may hold the package: said by the user, beside the macro, in the sources."""
    if stated := os.environ.get("VOXELASTICA_PYTHON"):
        yield Path(stated)
        return
    if chosen := App.ParamGet(PREFERENCES).GetString("PythonPath", ""):
        yield Path(chosen)
    here = Path(__file__).resolve().parent.parent
    yield here / "lib"
    yield here.parent / "ffi" / "python"


def voxelastica() -> Any:
    """The package. Raises :class:`MacroError` that says what would help."""
    if sys.version_info < (3, 10):
        version = ".".join(map(str, sys.version_info[:2]))
        raise MacroError(f"this FreeCAD runs Python {version}, Voxelastica needs 3.10; install a newer FreeCAD")
    places = list(_places())
    for place in places:
        if (place / "voxelastica" / "__init__.py").is_file() and str(place) not in sys.path:
            sys.path.insert(0, str(place))
            break
    try:
        import voxelastica as package
    except ImportError as error:
        raise MacroError(
            f"the Python package voxelastica cannot be loaded ({error}); looked in {', '.join(map(str, places))}. "
            "Install its wheel with pip install --target into one of these folders, or set VOXELASTICA_PYTHON"
        ) from None
    return package
