# SPDX-License-Identifier: GPL-3.0-or-later
"""Flowers in a scene: the object of the spokes, which holds the design, and its parts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from ..logic import designs
from ..logic.library import api

COLOURS = "Voxelastica"
MATERIAL = "Voxelastica Colours"
_TEXT_MATERIAL = "Voxelastica Labels"
_TEXT_COLOUR = (0.01, 0.01, 0.01, 1.0)

_NAMES = {
    "SPOKES": "spokes",
    "HUB": "hub",
    "TARGET": "target",
    "VOXELS": "voxels",
    "LEGEND": "legend",
    "LABELS": "legend labels",
    "MIDLINE": "solver's mid-line",
}


def settings(root: bpy.types.Object) -> Any:
    """What a flower stores."""
    return root.voxelastica


def is_flower(candidate: bpy.types.Object | None) -> bool:
    """Whether an object is a flower."""
    return candidate is not None and candidate.type == "MESH" and candidate.voxelastica.part == "SPOKES"


def root_of(candidate: bpy.types.Object | None) -> bpy.types.Object | None:
    """The flower that an object is, or is a part of."""
    while candidate is not None:
        if is_flower(candidate):
            return candidate
        candidate = candidate.parent if candidate.voxelastica.part != "NONE" else None
    return None


def shown(context: bpy.types.Context) -> bpy.types.Object | None:
    """The flower that the panel is about: the active one, or the one that was worked on last."""
    found = root_of(context.object)
    if found is None and context.scene.voxelastica_shown:
        found = context.scene.objects.get(context.scene.voxelastica_shown)
        found = found if is_flower(found) else None
    return found


def part(root: bpy.types.Object, name: str) -> bpy.types.Object | None:
    """A flower's part, if it has it."""
    return next((child for child in root.children if child.voxelastica.part == name), None)


def parts(root: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """All parts that were made for a flower."""
    return (child for child in root.children if child.voxelastica.part != "NONE")


def busy_mode(root: bpy.types.Object) -> str:
    """The mode in which a flower or a part is worked on by hand, as *Edit Mode*; empty in Object Mode.

    Meshes must not be replaced meanwhile.
    """
    modes = (found.mode for found in (root, *parts(root)) if found.mode != "OBJECT")
    return next((f"{mode.replace('_', ' ').title()} Mode" for mode in modes), "")


def unit_mm(scene: bpy.types.Scene) -> float:
    """Millimetres in one unit of a scene's coordinates."""
    return 1000.0 * scene.unit_settings.scale_length


def scene_of(root: bpy.types.Object) -> bpy.types.Scene:
    """The scene that a flower is in; the current one where it is in several."""
    scenes = root.users_scene
    return bpy.context.scene if not scenes or bpy.context.scene in scenes else scenes[0]


def new_mesh(root: bpy.types.Object, name: str) -> bpy.types.Object:
    """A part with a mesh, made where it is missing."""
    return part(root, name) or _child(root, name, bpy.data.meshes.new(f"{root.name} {_NAMES[name]}"))


def new_curve(root: bpy.types.Object, name: str, kind: str) -> bpy.types.Object:
    """A part with a curve or a text, made where it is missing."""
    return part(root, name) or _child(root, name, bpy.data.curves.new(f"{root.name} {_NAMES[name]}", kind))


def _child(root: bpy.types.Object, name: str, data: Any) -> bpy.types.Object:
    child = bpy.data.objects.new(f"{root.name} {_NAMES[name]}", data)
    child.parent = root
    child.voxelastica.part = name
    for collection in root.users_collection or [scene_of(root).collection]:
        collection.objects.link(child)
    return child


def remove(candidate: bpy.types.Object | None) -> None:
    """Removes a part and the data that nothing else uses."""
    if candidate is None:
        return
    data = candidate.data
    bpy.data.objects.remove(candidate)
    if data is not None and data.users == 0:
        getattr(bpy.data, "meshes" if isinstance(data, bpy.types.Mesh) else "curves").remove(data)


def colour_material() -> bpy.types.Material:
    """The material that shows the colours when rendered; made once a file, then the user's."""
    found = bpy.data.materials.get(MATERIAL)
    if found:
        return found
    made = bpy.data.materials.new(MATERIAL)
    made.use_nodes = True
    tree = made.node_tree
    source = tree.nodes.new("ShaderNodeVertexColor")
    source.layer_name = COLOURS
    source.location = (-300, 300)
    shader = next((node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if shader:
        tree.links.new(source.outputs["Color"], shader.inputs["Base Color"])
        shader.inputs["Roughness"].default_value = 0.6
    return made


def label_material() -> bpy.types.Material:
    """The dark material of labels; made once a file, then the user's."""
    found = bpy.data.materials.get(_TEXT_MATERIAL)
    if found:
        return found
    made = bpy.data.materials.new(_TEXT_MATERIAL)
    made.use_nodes = True
    made.diffuse_color = _TEXT_COLOUR
    shader = next((node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED"), None)
    if shader:
        shader.inputs["Base Color"].default_value = _TEXT_COLOUR
    return made


def use_material(target: bpy.types.Object, material: bpy.types.Material) -> None:
    """Gives an object a material unless it has one: the user's choice stays."""
    if not target.data.materials:
        target.data.materials.append(material)


def prepared(root: bpy.types.Object) -> designs.Prepared | None:
    """The design that a flower stores; None where it stores none, or one that this version of the library does not take."""
    text = root.voxelastica.design
    try:
        return designs.stored(text) if text else None
    except api().VoxelasticaError:
        return None
