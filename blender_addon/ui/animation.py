# SPDX-License-Identifier: GPL-3.0-or-later
"""The morph on the timeline: shape keys of true states, blended linearly by drivers of the flower's morph."""

from __future__ import annotations

import bpy
import numpy as np

from ..logic import states as blending
from . import flower

_PATH = "voxelastica.morph"


def animate(root: bpy.types.Object, first: int, last: int, percent: float) -> None:
    """Gives a flower shape keys that stay within ``percent`` of the length of the true path, and keys its morph from 0 at
    the frame ``first`` to 1 at ``last``.

    :raises ValueError: where no number of states is enough
    """
    from . import preview

    settings = flower.settings(root)
    design = flower.prepared(root)
    if design is None:
        raise ValueError("the design that this flower stores cannot be read: update the flower first")
    length, unit = design.input["strips"]["length_mm"], flower.unit_mm(flower.scene_of(root))
    count, worst = 0, 0.0
    for _, shape in preview.shapes(root):
        found, off = blending.enough(lambda fraction, shape=shape: unit * shape(fraction), 0.01 * percent * length)
        count, worst = max(count, found), max(worst, off)
    # An earlier animation goes only once there is another.
    clear(root)
    settings.states = count
    off = 100.0 * worst / length
    settings.animation_note = f"{count + 1} states; between them at most {off:.2g} % of the length off the true path"
    rebuild(root)
    settings.morph = 0.0
    root.keyframe_insert(_PATH, frame=first)
    settings.morph = 1.0
    root.keyframe_insert(_PATH, frame=last)


def rebuild(root: bpy.types.Object) -> None:
    """Makes the shape keys of all moving parts anew, in the flower's present design."""
    from . import preview

    count = flower.settings(root).states
    for child, shape in preview.shapes(root):
        if child.data.shape_keys:
            child.shape_key_clear()
        child.shape_key_add(name="Flat", from_mix=False)
        for state in range(1, count + 1):
            key = child.shape_key_add(name=f"Morph {state}/{count}", from_mix=False)
            key.value = 0.0
            points = np.ascontiguousarray(shape(state / count), dtype=np.float32)
            key.data.foreach_set("co", points.ravel())
            _drive(root, key, state, count)


def _drive(root: bpy.types.Object, key: bpy.types.ShapeKey, state: int, count: int) -> None:
    driver = key.driver_add("value").driver
    driver.type = "SCRIPTED"
    variable = driver.variables.new()
    variable.name = "morph"
    variable.type = "SINGLE_PROP"
    variable.targets[0].id = root
    variable.targets[0].data_path = _PATH
    driver.expression = blending.expression(state, count)


def clear(root: bpy.types.Object) -> None:
    """Takes shape keys and the morph's keyframes away; the flower follows its slider again."""
    from . import preview

    settings = flower.settings(root)
    for child in (root, *flower.parts(root)):
        if child.type == "MESH" and child.data.shape_keys:
            child.shape_key_clear()
    settings.states = 0
    settings.animation_note = ""
    _remove_keyframes(root)
    preview.look_changed(root)


def is_keyed(root: bpy.types.Object) -> bool:
    """Whether the morph has keyframes."""
    return _curve(root) is not None


def _curves(root: bpy.types.Object):
    """The curves of an object's action, in Blender before and after layered actions."""
    data = root.animation_data
    if data is None or data.action is None:
        return None
    action = data.action
    if hasattr(action, "fcurves"):
        return action.fcurves
    for layer in action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(data.action_slot)
            if bag is not None:
                return bag.fcurves
    return None


def _curve(root: bpy.types.Object):
    curves = _curves(root)
    return curves.find(_PATH) if curves is not None else None


def _remove_keyframes(root: bpy.types.Object) -> None:
    curve = _curve(root)
    if curve is not None:
        _curves(root).remove(curve)
