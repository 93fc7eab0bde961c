# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays into Blender's meshes, quickly."""

from __future__ import annotations

import bpy
import numpy as np

from .flower import COLOURS


def fill(mesh: bpy.types.Mesh, points: np.ndarray, faces: np.ndarray, size: int) -> None:
    """Replaces a mesh's geometry by faces of ``size`` corners each; ``faces`` may be flat."""
    faces = np.ascontiguousarray(faces, dtype=np.int32).reshape(-1, size)
    mesh.clear_geometry()
    if len(points) == 0:
        return
    count = len(faces)
    mesh.vertices.add(len(points))
    mesh.loops.add(count * size)
    mesh.polygons.add(count)
    mesh.loops.foreach_set("vertex_index", faces.ravel())
    mesh.polygons.foreach_set("loop_start", np.arange(0, count * size, size, dtype=np.int32))
    place(mesh, points)
    mesh.update(calc_edges=True)


def fill_edges(mesh: bpy.types.Mesh, points: np.ndarray, edges: np.ndarray) -> None:
    """Replaces a mesh's geometry by edges."""
    mesh.clear_geometry()
    mesh.vertices.add(len(points))
    mesh.edges.add(len(edges))
    mesh.edges.foreach_set("vertices", np.ascontiguousarray(edges, dtype=np.int32).ravel())
    place(mesh, points)
    mesh.update()


def place(mesh: bpy.types.Mesh, points: np.ndarray) -> None:
    """Moves a mesh's vertices; (n, 3) in the scene's unit."""
    flat = np.ascontiguousarray(points, dtype=np.float32).ravel()
    mesh.attributes["position"].data.foreach_set("vector", flat)
    mesh.update()


def colour(mesh: bpy.types.Mesh, rgba: np.ndarray, by_face: bool, corners: int = 4) -> None:
    """Colours vertices, or faces of ``corners`` corners; linear RGBA, one row each."""
    domain = "CORNER" if by_face else "POINT"
    layer = mesh.color_attributes.get(COLOURS)
    if layer is not None and (layer.domain != domain or layer.data_type != "FLOAT_COLOR"):
        mesh.color_attributes.remove(layer)
        layer = None
    if layer is None:
        layer = mesh.color_attributes.new(COLOURS, "FLOAT_COLOR", domain)
        index = mesh.color_attributes.find(COLOURS)
        mesh.color_attributes.active_color_index = index
        mesh.color_attributes.render_color_index = index
    rows = np.repeat(rgba, corners, axis=0) if by_face else rgba
    layer.data.foreach_set("color", np.ascontiguousarray(rows, dtype=np.float32).ravel())
    mesh.update()


def smooth(mesh: bpy.types.Mesh) -> None:
    """Shades all faces smooth."""
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), dtype=bool))
