# SPDX-License-Identifier: MIT OR Apache-2.0
"""The flat flower: sketches of spoke and hub, faces, solids."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import Part
import Sketcher

from . import colours
from .settings import MacroError
from .tree import Tree, Vector, note, show

#: Largest distance of an outline's spline from the design's width, mm.
OUTLINE_ACCURACY = 1e-3


def half_width(design: Any) -> Any:
    """Half the width over the arc length as a spline ``(s, y)`` with ``s`` as its parameter."""
    s, width = list(design.profile.s_mm), list(design.profile.width_mm)
    last = len(s) - 1
    pieces = 4
    while True:
        pieces = min(2 * pieces, last)
        rows = [round(i * last / pieces) for i in range(pieces + 1)]
        spline = Part.BSplineCurve()
        points = [Vector(s[i], 0.5 * width[i], 0) for i in rows]
        spline.interpolate(Points=points, Parameters=[s[i] for i in rows])
        off = max(abs(spline.value(s[i]).y - 0.5 * width[i]) for i in range(last + 1))
        if off <= OUTLINE_ACCURACY:
            return spline
        if pieces == last:
            raise MacroError(f"{design.name}: no spline follows the outline, {off:.4f} mm remain", 1)


def _edge(spline: Any, reach: float | None, side: float) -> Any:
    """One edge of a spoke from the rim to the hub: in the flower's frame, or along x for a single strip."""
    poles = [Vector(p.x if reach is None else reach - p.x, side * p.y, 0) for p in spline.getPoles()]
    edge = Part.BSplineCurve()
    multiplicities, knots = spline.getMultiplicities(), spline.getKnots()
    edge.buildFromPolesMultsKnots(poles, multiplicities, knots, False, spline.Degree)
    if all(abs(p.y - poles[0].y) < 1e-9 for p in poles):
        return Part.LineSegment(poles[0], poles[-1])
    return edge


def _sketch(tree: Tree, group: Any, name: str, curves: list[Any], ends: list[tuple[int, int]]) -> Any:
    """A closed sketch. ``ends`` are the first and last point of every curve in the sense of the loop (1 start, 2 end)."""
    sketch = tree.add("Sketcher::SketchObject", name, group)
    sketch.addGeometry(curves, False)
    constraints = []
    for i, (_, last) in enumerate(ends):
        j = (i + 1) % len(ends)
        constraints.append(Sketcher.Constraint("Coincident", i, last, j, ends[j][0]))
    # What the design says is not to be dragged with the mouse.
    constraints += [Sketcher.Constraint("Block", i) for i in range(len(curves))]
    sketch.addConstraint(constraints)
    tree.document.recompute()
    if not sketch.Shape.Wires or not sketch.Shape.Wires[0].isClosed():
        raise MacroError(f"{name}: FreeCAD made no closed wire of this outline", 1)
    return sketch


def _solid(tree: Tree, group: Any, name: str, sketch: Any, sheet: Any) -> Any:
    """A sketch extruded to both sides of its plane by the sheet's thickness."""
    solid = tree.add("Part::Extrusion", name, group)
    solid.Base = sketch
    solid.DirMode = "Normal"
    solid.Solid = True
    solid.Symmetric = True
    solid.setExpression("LengthFwd", f"{sheet.Name}.thickness")
    show(sketch, visible=False)
    return solid


def _face(tree: Tree, group: Any, name: str, sketch: Any) -> Any:
    face = tree.add("Part::Face", name, group)
    face.Sources = [sketch]
    face.FaceMakerClass = "Part::FaceMakerBullseye"
    show(face, visible=False)
    return face


def build(tree: Tree, design: Any, sheet: Any) -> dict[str, Any]:
    """The flat flower below a group ``Flat``; returns ``solids`` (spokes and hub), ``flower`` and the group."""
    group = tree.group("Flat")
    hub_corners = design.hub(0.0)
    length = design.input["strips"]["length_mm"]
    reach = design.input["strips"]["hub_radius_mm"] + length if hub_corners else None
    spline = half_width(design)
    upper, lower = _edge(spline, reach, 1.0), _edge(spline, reach, -1.0)
    at_hub = Part.LineSegment(upper.EndPoint, lower.EndPoint)
    at_rim = Part.LineSegment(lower.StartPoint, upper.StartPoint)
    outline = _sketch(tree, group, "Spoke_outline", [upper, at_hub, lower, at_rim], [(1, 2), (1, 2), (2, 1), (1, 2)])
    _face(tree, group, "Spoke_face", outline)
    name = "Spoke_1" if design.spokes > 1 else "Strip"
    first = _solid(tree, group, name, outline, sheet)
    show(first, visible=True, ShapeColor=colours.SHEET)
    solids = [first]
    for i in range(1, design.spokes):
        spoke = tree.add("App::Link", f"Spoke_{i + 1}", group)
        spoke.LinkedObject = first
        spoke.Placement = App.Placement(Vector(), App.Rotation(Vector(0, 0, 1), 360.0 * i / design.spokes))
        solids.append(spoke)
    if hub_corners:
        corners = [Vector(x, y, 0) for x, y, _ in hub_corners]
        sides = [Part.LineSegment(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]
        hub_outline = _sketch(tree, group, "Hub_outline", sides, [(1, 2)] * len(sides))
        _face(tree, group, "Hub_face", hub_outline)
        hub = _solid(tree, group, "Hub", hub_outline, sheet)
        show(hub, visible=True, ShapeColor=colours.HUB)
        solids.append(hub)
    flower = None
    if len(solids) > 1:
        flower = tree.add("Part::Compound", "Flower", group)
        flower.Links = solids
    tree.document.recompute()
    if flower is not None:
        show(flower, visible=False)
        for solid in solids:
            show(solid, visible=True)
    _check(solids, design)
    return {"group": group, "solids": solids, "flower": flower or first}


def _check(solids: list[Any], design: Any) -> None:
    """Refuses solids that are none, and states volumes as properties."""
    for solid in solids:
        shape = Part.getShape(solid)
        if shape.isNull() or not shape.isValid() or len(shape.Solids) != 1 or shape.Volume <= 0:
            raise MacroError(f"{solid.Label}: FreeCAD made no valid solid of it", 1)
    note(
        solids[0],
        "DesignedVolume",
        design.summary["volume_mm3"]["spoke_smooth"],
        "Volume by the design",
        "App::PropertyVolume",
    )
