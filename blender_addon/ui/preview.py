# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview: from a flower's properties to its meshes."""

from __future__ import annotations

import json
import os
import zlib
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from ..logic import colours, designs, inputs, lines, results, surface, voxel_mesh
from ..logic.library import api
from ..logic.messages import said
from . import animation, fields, flower, form, legend, meshes, target_mesh
from .properties import known


def design_changed(root: bpy.types.Object) -> None:
    """Computes the design of a flower's properties and shows it; where that fails the message says why and the last good
    preview stays."""
    if not flower.is_flower(root):
        return
    settings = flower.settings(root)
    flower.scene_of(root).voxelastica_shown = root.name
    try:
        found, hint = _computed(root)
    except (api().VoxelasticaError, ValueError, OSError) as error:
        settings.problem = said(error)
        return
    settings.problem = ""
    settings.hint = " ".join([hint, *found.design.warnings]).strip()
    settings.design = found.text
    if settings.target.kind == "points" and not hint:
        settings.meridian = json.dumps(found.input["target"]["meridian"])
        settings.meridian_kind = "points"
    look_changed(root)


def _computed(root: bpy.types.Object) -> tuple[designs.Prepared, str]:
    """The design of a form, and a hint."""
    settings = flower.settings(root)
    if settings.target.kind == "mesh" and settings.target_object is not None and _outdated(settings):
        target_mesh.take(root)
    values = form.values(settings)
    hint = ""
    if values["target.kind"] == "points":
        file = values.get("target.file")
        if file and os.path.isfile(file):
            values.pop("target.meridian", None)
        elif "target.meridian" in values:
            if file:
                hint = f"{file} is not there any more: the meridian that the design keeps is used."
            values["target.file"] = None
        elif not file:
            raise ValueError("Choose a CSV file with the columns rho and z, from rim to hub or from hub to rim.")
    if values["target.kind"] == "mesh" and "target.meridian" not in values:
        raise ValueError(
            "Choose a mesh: an object in the scene that is a surface of revolution, such as half a UV sphere."
        )
    keys = inputs.assemble(values, known())
    found = designs.computed(keys)
    corrected = results.corrected(keys, found.input, settings.refinement)
    return (designs.computed(corrected) if corrected else found), hint


def _outdated(settings: Any) -> bool:
    """Whether the stored meridian is not the target object's about the axis that is set."""
    return settings.meridian_kind != "mesh" or settings.meridian_axis != settings.target.axis


def mesh_changed(root: bpy.types.Object) -> None:
    """Takes the meridian of the target object anew."""
    settings = flower.settings(root)
    with fields.quiet():
        settings.target.kind = "mesh"
    if settings.target_object is None and settings.meridian_kind == "mesh":
        design_changed(root)
        return
    try:
        target_mesh.take(root)
    except ValueError as error:
        settings.problem = str(error)
        return
    design_changed(root)


def scale_of_mesh(settings: Any, prepared: designs.Prepared) -> float | None:
    """How much larger the dome is than the mesh it was taken from; None for other targets."""
    if settings.target.kind != "mesh" or settings.meridian_kind != "mesh" or not settings.meridian:
        return None
    rim = json.loads(settings.meridian)[0][0]
    return prepared.design.summary["rim_radius_mm"] / rim


def look_changed(root: bpy.types.Object) -> None:
    """Shows the design that a flower stores, in full."""
    if not flower.is_flower(root):
        return
    found = flower.prepared(root)
    if found is None or not _writable(root):
        return
    settings = flower.settings(root)
    _spokes(root, settings, found)
    _hub(root, settings, found)
    _target(root, settings, found)
    _voxels(root, settings, found)
    _midline(root, settings, found)
    if settings.states:
        animation.rebuild(root)
    _colours(root, settings, found)


def morph_changed(root: bpy.types.Object) -> None:
    """Moves a flower to its fraction of the morph; colours follow where they depend on it."""
    if not flower.is_flower(root):
        return
    found = flower.prepared(root)
    if found is None or not _writable(root):
        return
    settings = flower.settings(root)
    if settings.states:
        root.update_tag()
    else:
        for child, shape in shapes(root):
            meshes.place(child.data, shape(settings.morph))
    if settings.colour_by == "curvature":
        _colours(root, settings, found)


def _writable(root: bpy.types.Object) -> bool:
    """Whether a flower's mesh may be replaced now."""
    settings = flower.settings(root)
    if mode := flower.busy_mode(root):
        settings.problem = f"Leave {mode}: the preview replaces the meshes of the flower."
        return False
    if root.data.users > 1:  # A linked duplicate shows a design of its own from now on.
        root.data = root.data.copy()
    return True


def shapes(root: bpy.types.Object) -> list[tuple[bpy.types.Object, Callable[[float], np.ndarray]]]:
    """The parts that move, each with the function from a fraction of the morph to its vertices in the scene's unit."""
    settings, found = flower.settings(root), flower.prepared(root)
    if found is None:
        return []
    factor = 1.0 / flower.unit_mm(flower.scene_of(root))
    prepared = found.flower(settings.along, settings.across)

    def spokes(fraction: float) -> np.ndarray:
        points = prepared.buffer()
        prepared.fill(fraction, points)
        points *= np.float32(factor)
        return points

    moving = [(root, spokes)]
    hub = flower.part(root, "HUB")
    if hub:
        moving.append((hub, lambda fraction: np.array(found.design.hub(fraction)) * factor))
    voxels = flower.part(root, "VOXELS")
    if voxels and len(voxels.data.vertices):
        pieces = _voxel_pieces(settings, found)
        moving.append(
            (
                voxels,
                lambda fraction: factor
                * np.concatenate([voxel_mesh.placed(faces, found.design, fraction, spoke) for spoke, faces in pieces]),
            )
        )
    return moving


def _without_keys(child: bpy.types.Object) -> None:
    if child.data.shape_keys:
        child.shape_key_clear()


def _spokes(root: bpy.types.Object, settings: Any, found: designs.Prepared) -> None:
    mesh = root.data
    quads = found.flower(settings.along, settings.across).quads
    spokes = found.design.spokes
    grid = f"{settings.along} x {settings.across} x {spokes}"
    same = len(mesh.polygons) == len(quads) and settings.shown == grid
    if same and not settings.states:
        meshes.place(mesh, shapes(root)[0][1](settings.morph))
    else:
        _without_keys(root)
        meshes.fill(mesh, shapes(root)[0][1](0.0 if settings.states else settings.morph), np.asarray(quads), 4)
        meshes.smooth(mesh)
        settings.shown = grid
    flower.use_material(root, flower.colour_material())


def _hub(root: bpy.types.Object, settings: Any, found: designs.Prepared) -> None:
    child = flower.new_mesh(root, "HUB")
    factor = 1.0 / flower.unit_mm(flower.scene_of(root))
    corners = np.array(found.design.hub(0.0 if settings.states else settings.morph)) * factor
    _without_keys(child)
    meshes.fill(child.data, corners, np.arange(len(corners)), len(corners))
    meshes.colour(child.data, np.array([colours.GREY] * len(corners)), False)
    flower.use_material(child, flower.colour_material())


def _target(root: bpy.types.Object, settings: Any, found: designs.Prepared) -> None:
    if not settings.show_target:
        flower.remove(flower.part(root, "TARGET"))
        return
    child = flower.new_mesh(root, "TARGET")
    points, edges = found.once("target", lambda: lines.target(found.design))
    meshes.fill_edges(child.data, points / flower.unit_mm(flower.scene_of(root)), edges)
    child.display_type = "WIRE"
    child.hide_render = True


def _voxel_pieces(settings: Any, found: designs.Prepared) -> list[tuple[int, voxel_mesh.Exposed]]:
    """The spokes whose voxels are shown, with their faces."""
    voxels = found.design.voxels
    each = len(voxels.phases)
    phase = min(int(settings.voxel_phase or 0), len(found.design.phases)) - 1
    if each > settings.voxel_limit:
        slices = voxel_mesh.slices_within(voxels.offsets, settings.voxel_limit)
        return [(0, found.exposed(slices, phase))] if slices else []
    count = min(found.design.spokes, settings.voxel_limit // each)
    return [(spoke, found.exposed(voxels.slices, phase)) for spoke in range(count)]


def _voxels(root: bpy.types.Object, settings: Any, found: designs.Prepared) -> None:
    settings.voxels_note = ""
    if not settings.show_voxels:
        flower.remove(flower.part(root, "VOXELS"))
        return
    pieces = _voxel_pieces(settings, found)
    settings.voxels_note = _voxels_note(settings, found, pieces)
    child = flower.new_mesh(root, "VOXELS")
    _without_keys(child)
    key = f"{zlib.crc32(settings.design.encode())} {settings.voxel_phase} {settings.voxel_limit}"
    if child.voxelastica.shown == key and len(child.data.vertices) and not settings.states:
        meshes.place(child.data, dict(shapes(root))[child](settings.morph))
        return
    if not pieces:
        child.data.clear_geometry()
        return
    starts = np.cumsum([0, *(len(faces.points) for _, faces in pieces)])
    quads = np.concatenate([faces.quads + start for (_, faces), start in zip(pieces, starts, strict=False)])
    factor = 1.0 / flower.unit_mm(flower.scene_of(root))
    fraction = 0.0 if settings.states else settings.morph
    points = np.concatenate([voxel_mesh.placed(faces, found.design, fraction, spoke) for spoke, faces in pieces])
    meshes.fill(child.data, points * factor, quads, 4)
    phases = np.concatenate([faces.phases for _, faces in pieces])
    rgba = surface.Scale("phase", names=tuple(found.design.phases)).colours(phases)
    meshes.colour(child.data, rgba, True)
    child.voxelastica.shown = key
    flower.use_material(child, flower.colour_material())


def _voxels_note(settings: Any, found: designs.Prepared, pieces: list[tuple[int, voxel_mesh.Exposed]]) -> str:
    voxels = found.design.voxels
    total = len(voxels.phases) * found.design.spokes
    count = sum(faces.count for _, faces in pieces)
    if len(voxels.phases) > settings.voxel_limit:
        slices = voxel_mesh.slices_within(voxels.offsets, settings.voxel_limit)
        where = f"the first {slices:,} of {voxels.slices:,} slices of spoke 1"
    else:
        where = f"{len(pieces)} of {found.design.spokes} spokes"
    return f"{count:,} of {total:,} voxels shown: {where}"


def _midline(root: bpy.types.Object, settings: Any, found: designs.Prepared) -> None:
    record = json.loads(settings.verification) if settings.verification else None
    if record is None or not settings.show_midline:
        flower.remove(flower.part(root, "MIDLINE"))
        return
    child = flower.new_mesh(root, "MIDLINE")
    radius = 0.004 * found.input["strips"]["length_mm"]
    pieces = [
        lines.tube(line, radius)
        for line in lines.midlines(record["midline_mm"], record["rim_radius_mm"], record["spokes"])
    ]
    starts = np.cumsum([0, *(len(points) for points, _ in pieces)])
    quads = np.concatenate([quads + start for (_, quads), start in zip(pieces, starts, strict=False)])
    points = np.concatenate([points for points, _ in pieces]) / flower.unit_mm(flower.scene_of(root))
    meshes.fill(child.data, points, quads, 4)
    meshes.smooth(child.data)
    meshes.colour(child.data, np.tile(colours.MIDLINE, (len(points), 1)), False)
    flower.use_material(child, flower.colour_material())


def _colours(root: bpy.types.Object, settings: Any, found: designs.Prepared) -> None:
    values, scale, by_face = surface.figures(found, settings.colour_by, settings.along, settings.across, settings.morph)
    key = ("colours", settings.colour_by, settings.along, settings.across)
    rgba = (
        found.once(key, lambda: scale.colours(values)) if settings.colour_by != "curvature" else scale.colours(values)
    )
    meshes.colour(root.data, rgba, by_face)
    if settings.show_voxels and settings.colour_by != "phase":
        scales = [scale, surface.Scale("phase", names=tuple(found.design.phases))]
    else:
        scales = [scale]
    legend.draw(root, scales if settings.show_legend else [])
