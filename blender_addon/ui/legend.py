# SPDX-License-Identifier: GPL-3.0-or-later
"""The legend: what colours mean, as an object beside the flower that renders with it."""

from __future__ import annotations

import math

import bpy
import numpy as np

from ..logic.colours import Scale
from . import flower, meshes

#: Sizes as shares of the flat flower's radius.
_LINE = 0.075
_LETTER = 0.058
_BAR = 0.06
_GAP = 0.12
_STEPS = 64
#: How far it leans up from the ground, degrees: it can be read from above and from the front.
_TILT = math.radians(60)


def draw(root: bpy.types.Object, scales: list[Scale]) -> None:
    """Shows the legend of one or more scales, or none."""
    if not scales:
        flower.remove(flower.part(root, "LABELS"))
        flower.remove(flower.part(root, "LEGEND"))
        return
    found = flower.prepared(root)
    strips = found.input["strips"]
    radius = (strips["hub_radius_mm"] + strips["length_mm"]) / flower.unit_mm(flower.scene_of(root))
    # Beside the flat flower's corners, where its closed state is not in the way.
    half_width = 0.5 * found.design.profile.width_mm[0] / flower.unit_mm(flower.scene_of(root))
    left = float(np.hypot(radius, half_width)) + _GAP * radius
    lines: list[str] = []
    quads, rgba = [], []
    count = sum(len(scale.marks()) + 1 for scale in scales) + len(scales) - 1
    top = count * _LINE * radius

    def box(high: float, low: float, colours: np.ndarray) -> None:
        x = (0.0, _BAR * radius)
        quads.append([(x[0], low, 0), (x[1], low, 0), (x[1], high, 0), (x[0], high, 0)])
        rgba.append(colours)

    for scale in scales:
        if lines:
            lines.append("")
        lines.append(scale.title)
        first = len(lines)
        lines.extend(scale.marks())

        def height(line: float) -> float:
            return top - line * _LINE * radius

        if scale.names or len(scale.marks()) == 1:
            values = np.arange(len(scale.names))[::-1] if scale.names else np.array([scale.low])
            for i, colour in enumerate(scale.colours(values)):
                box(height(first + i - 0.4), height(first + i + 0.4), np.tile(colour, (4, 1)))
        else:
            edges = np.linspace(height(len(lines) - 1), height(first), _STEPS + 1)
            colours = scale.colours(np.linspace(scale.low, scale.high, _STEPS + 1))
            for i in range(_STEPS):
                box(edges[i + 1], edges[i], colours[[i, i, i + 1, i + 1]])
    bar = flower.new_mesh(root, "LEGEND")
    meshes.fill(bar.data, np.array(quads).reshape(-1, 3), np.arange(4 * len(quads)), 4)
    # Corners of one face are neighbours in memory: a colour a vertex.
    meshes.colour(bar.data, np.concatenate(rgba), False)
    flower.use_material(bar, flower.colour_material())
    labels = flower.new_curve(root, "LABELS", "FONT")
    text = labels.data
    text.body = "\n".join(lines)
    text.size = _LETTER * radius
    text.space_line = _LINE / _LETTER
    text.align_y = "TOP_BASELINE"
    base = top - 0.35 * text.size
    bar.location = (left, 0, 0)
    labels.location = (left + (_BAR + 0.03) * radius, base * math.cos(_TILT), base * math.sin(_TILT))
    bar.rotation_euler = labels.rotation_euler = (_TILT, 0, 0)
    flower.use_material(labels, flower.label_material())
