# SPDX-License-Identifier: MIT OR Apache-2.0
"""Writes STEP, STL and FreeCAD's own format; files appear under their names only when they are whole."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import Part

from .settings import MacroError

#: Largest distance of triangles from a face, mm, and largest turn between them, rad.
STL_ACCURACY = (0.02, 0.2)


def require_writable(folder: str) -> Path:
    """Makes a folder and tries to write into it, before anything is built."""
    place = Path(folder).expanduser()
    try:
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=place):
            pass
    except OSError as error:
        raise MacroError(
            f"{place}: files cannot be written here: {error.strerror}; choose another folder (VOXELASTICA_FOLDER)", 5
        ) from None
    return place


def _whole(path: Path, write: Callable[[str], object]) -> Path:
    """Writes into a folder beside the final name and renames. (FreeCAD keeps a copy of a file that it overwrites.)"""
    try:
        with tempfile.TemporaryDirectory(prefix=".", dir=path.parent) as folder:
            temporary = os.path.join(folder, path.name)
            write(temporary)
            if not os.path.isfile(temporary) or not os.path.getsize(temporary):
                raise MacroError(f"{path}: FreeCAD wrote nothing", 5)
            os.replace(temporary, path)
    except OSError as error:
        raise MacroError(f"{path}: this cannot be written: {error.strerror}", 5) from None
    return path


def step(folder: Path, name: str, objects: list[Any]) -> Path:
    """Solids and shells as one STEP file, with their names."""
    import Import

    return _whole(folder / f"{name}.step", lambda path: Import.export(objects, path))


def stl(folder: Path, name: str, flower: Any) -> Path:
    """The flat flower as one binary STL: closed solids that touch along the hub."""
    import MeshPart

    shape = Part.getShape(flower)

    def write(path: str) -> None:
        linear, angular = STL_ACCURACY
        mesh = MeshPart.meshFromShape(Shape=shape, LinearDeflection=linear, AngularDeflection=angular, Relative=False)
        mesh.write(path)

    return _whole(folder / f"{name}.stl", write)


def save(folder: Path, name: str, document: Any) -> Path:
    """The document as a copy; the open one keeps its own name and place."""
    path = folder / f"{name}.FCStd"
    return _whole(path, lambda temporary: document.saveCopy(temporary))


def file_name(name: str) -> str:
    """A design's name as a file's name."""
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in name) or "design"
