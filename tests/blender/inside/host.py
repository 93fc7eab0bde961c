"""What the scripts that run inside Blender share."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

NAME = "bl_ext.user_default.voxelastica"


def install(enable: bool = True) -> None:
    """Installs the zip as a user does, and switches it on."""
    archive = os.environ["ADDON_ZIP"]
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=enable)
    if enable:
        assert NAME in bpy.context.preferences.addons


def module(name: str) -> Any:
    """A module of the installed add-on, such as ``ui.preview``."""
    return sys.modules[f"{NAME}.{name}"]


def empty() -> None:
    """A scene with nothing in it."""
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)


def new(preset: str = "hemisphere") -> bpy.types.Object:
    """A new flower."""
    assert bpy.ops.voxelastica.new(preset=preset) == {"FINISHED"}
    root = bpy.context.object
    assert root.voxelastica.part == "SPOKES"
    return root


def design(root: bpy.types.Object) -> Any:
    """The design a flower stores."""
    return module("ui.flower").prepared(root).design


def part(root: bpy.types.Object, name: str) -> bpy.types.Object | None:
    """A part of a flower."""
    return next((child for child in root.children if child.voxelastica.part == name), None)


def points(target: bpy.types.Object, evaluated: bool = False) -> np.ndarray:
    """Vertices of a mesh, (n, 3)."""
    mesh = target.data
    if evaluated:
        mesh = target.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    found = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3).astype(float)


def refused(operator: Any, *words: str, **arguments: Any) -> str:
    """Calls an operator that must report an error with these words, and returns it."""
    try:
        result = operator(**arguments)
    except RuntimeError as error:  # Blender raises what an operator reports as an error.
        said = str(error)
    else:
        raise AssertionError(f"{operator} was not refused: {result}")
    for word in words:
        assert word in said, f"{word!r} is not in {said!r}"
    assert "Traceback" not in said, said
    return said


def dome(scale: tuple[float, float, float] = (1, 1, 1), segments: int = 64, rings: int = 48) -> bpy.types.Object:
    """The upper half of a UV sphere of radius 1, with a scale."""
    import bmesh

    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=rings)
    made = bpy.context.object
    grid = bmesh.new()
    grid.from_mesh(made.data)
    bmesh.ops.delete(grid, geom=[vertex for vertex in grid.verts if vertex.co.z < -1e-6], context="VERTS")
    grid.to_mesh(made.data)
    grid.free()
    made.scale = scale
    return made


def report(text: str) -> None:
    """A figure for the tests' own report."""
    print("REPORT", text)


def done() -> None:
    """Says that the script came to its end."""
    sys.stdout.flush()
    print("DONE")


def scratch() -> Path:
    """The folder the script runs in."""
    return Path.cwd()
