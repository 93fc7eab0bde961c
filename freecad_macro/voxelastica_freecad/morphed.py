# SPDX-License-Identifier: MIT OR Apache-2.0
"""The flower at a fraction of the morph, as a shell of ruled surfaces coloured by modulus."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import Part

from . import colours
from .tree import Tree, Vector, note, show

#: Points of an edge's spline, and faces along a spoke.
POINTS = 120
FACES = 24


def _splines(design: Any, fraction: float) -> tuple[Any, Any, list[float]]:
    """The two edges of spoke 1 from rim to hub, with the arc length as their parameter, and the modulus of every face."""
    mesh = design.mesh(fraction, along=POINTS, across=1)
    length = design.input["strips"]["length_mm"]
    # Without numpy the rows are those of a memoryview of two dimensions, which does not iterate.
    rows = mesh.positions.tolist()
    parameters = [length * i / POINTS for i in range(POINTS + 1)]
    edges = []
    for side in (0, 1):
        spline = Part.BSplineCurve()
        spline.interpolate(Points=[Vector(*p) for p in rows[side::2]], Parameters=parameters)
        edges.append(spline)
    moduli = list(mesh.modulus_mpa)[::2]
    step = POINTS // FACES
    return edges[0], edges[1], [moduli[i * step + step // 2] for i in range(FACES)]


def _piece(spline: Any, low: float, high: float) -> Any:
    """Part of a spline as an edge, without the poles of the rest: files are several times smaller."""
    piece = spline.copy()
    piece.segment(low, high)
    return piece.toShape()


def build(tree: Tree, design: Any, fraction: float) -> dict[str, Any]:
    """The shell below a group ``Morphed``; returns ``shell``, ``hub`` (or ``None``) and the group."""
    group = tree.group("Morphed")
    left, right, moduli = _splines(design, fraction)
    length = design.input["strips"]["length_mm"]
    limits = [length * i / FACES for i in range(FACES + 1)]
    faces = []
    for low, high in zip(limits, limits[1:]):
        faces.append(Part.makeRuledSurface(_piece(left, low, high), _piece(right, low, high)))
    everything = []
    for i in range(design.spokes):
        turn = App.Placement(Vector(), App.Rotation(Vector(0, 0, 1), 360.0 * i / design.spokes))
        for face in faces:
            turned = face.copy()
            turned.Placement = turn
            everything.append(turned)
    shape = Part.makeCompound(everything)
    shell = tree.add("Part::Feature", "Morphed_shell", group)
    shell.Shape = shape
    note(shell, "Fraction", fraction, "Fraction of the morph: 0 flat, 1 closed", "App::PropertyFloat")
    scale = (min(design.profile.modulus_mpa), max(design.profile.modulus_mpa))
    shades = [(*colours.shade(modulus, *scale), 0.0) for modulus in moduli] * design.spokes
    show(shell, visible=True, DiffuseColor=shades, Deviation=0.1, DisplayMode="Shaded")
    hub = None
    if corners := design.hub(fraction):
        points = [Vector(*corner) for corner in corners]
        hub = tree.add("Part::Feature", "Morphed_hub", group)
        hub.Shape = Part.Face(Part.makePolygon([*points, points[0]]))
        show(hub, visible=True, ShapeColor=colours.HUB)
    return {"group": group, "shell": shell, "hub": hub}
