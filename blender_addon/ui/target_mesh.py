# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of the scene as the target."""

from __future__ import annotations

import json
import re

import bpy
import numpy as np

from ..logic import mesh_target
from ..logic.library import api
from ..logic.messages import said
from . import fields, flower


def measured(context: bpy.types.Context, source: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Vertices, mm, and triangles of an object, with its modifiers and scale, along its own axes.

    The object's place and rotation are taken off, so that the axes x, y and z are the object's own; parents' scale and
    shear stay in.
    """
    graph = context.evaluated_depsgraph_get()
    evaluated = source.evaluated_get(graph)
    mesh = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices), dtype=np.float64)
        mesh.vertices.foreach_get("co", vertices)
        triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
    finally:
        evaluated.to_mesh_clear()
    world = np.array(evaluated.matrix_world)[:3, :3]
    own = np.array(evaluated.matrix_world.to_quaternion().to_matrix()).T @ world
    points = vertices.reshape(-1, 3) @ own.T * flower.unit_mm(context.scene)
    return points, triangles.reshape(-1, 3)


def take(root: bpy.types.Object) -> None:
    """Takes the meridian of a flower's target object and stores it with the flower.

    :raises ValueError: no mesh, one without faces, or one that is no surface of revolution; the message names it
    """
    settings = flower.settings(root)
    source = settings.target_object
    if source is None:
        raise ValueError("Choose an object whose surface is one of revolution, such as half a UV sphere.")
    if source.type != "MESH":
        raise ValueError(f"{source.name} is no mesh: choose a mesh object, or convert it to one.")
    if source.name not in bpy.context.scene.objects:
        raise ValueError(f"{source.name} is not in the scene any more: choose another object.")
    vertices, triangles = measured(bpy.context, source)
    share = settings.strips.hub_radius_mm / settings.strips.length_mm
    try:
        found = mesh_target.extract(vertices, triangles, settings.target.axis, share)
    except (api().VoxelasticaError, ValueError) as error:
        problem = re.sub(r"^target\.file = \S+: ", "", said(error))
        raise ValueError(f"{source.name}: {problem}") from error
    with fields.quiet():
        settings.target.kind = "mesh"
        settings.meridian = json.dumps(found.meridian)
        settings.meridian_kind, settings.meridian_axis = "mesh", settings.target.axis
        share = found.roundness_percent
        roundness = f"{share:.2g}" if share >= 0.01 else "less than 0.01"
        settings.meridian_note = (
            f"{source.name}: rim radius {found.rim_radius_mm:.4g} mm, {roundness} % (rms) out of round"
        )
