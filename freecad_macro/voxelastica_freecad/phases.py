# SPDX-License-Identifier: MIT OR Apache-2.0
"""The phases of one spoke: the exact surface of their voxels as meshes, or solids."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import FreeCAD as App
import Mesh
import Part

from . import colours
from .settings import MacroError
from .source import variant
from .tree import Tree, Vector, note, show

#: Most boxes of solids; FreeCAD becomes slow beyond.
MOST_BOXES = 12_000


def _place(design: Any) -> Any:
    """From the strip's frame (rim at x = 0) to that of the flower, where spoke 1 runs from the rim inwards."""
    if not design.hub(0.0):
        return App.Placement()
    reach = design.input["strips"]["hub_radius_mm"] + design.input["strips"]["length_mm"]
    return App.Placement(Vector(reach, 0, 0), App.Rotation(Vector(0, 0, 1), 180))


def build(tree: Tree, design: Any, kind: str) -> dict[str, Any]:
    """The phases below a group ``Phases``, one object each, softest first: meshes or compounds of boxes."""
    group = tree.group("Phases")
    made = _bodies(tree, group, design) if kind == "bodies" else _meshes(tree, group, design)
    place, edge = _place(design), design.input["voxels"]["size_mm"]
    for i, (item, name) in enumerate(zip(made, design.phases)):
        item.Placement = place
        note(item, "Phase", name, "Material of this phase")
        note(item, "Voxels", design.voxels.count(i), "Number of voxels", "App::PropertyInteger")
        note(item, "DesignedVolume", edge**3 * design.voxels.count(i), "Volume of the voxels", "App::PropertyVolume")
        share = i / max(len(made) - 1, 1)
        show(item, visible=False, ShapeColor=colours.ramp(share))
    return {"group": group, "phases": made}


def _label(design: Any, index: int) -> str:
    """The phase's name as in the decks: capitals, digits and underscores."""
    import re

    return re.sub("[^A-Z0-9]+", "_", design.phases[index].upper())


def _meshes(tree: Tree, group: Any, design: Any) -> list[Any]:
    table = {**design.input.get("fabrication", {}), "write": ["stl"], "scope": "spoke"}
    made = []
    with tempfile.TemporaryDirectory() as folder:
        paths = variant(design, "fabrication", table).fabricate(folder, ["stl"])
        for i in range(len(design.phases)):
            label = _label(design, i)
            found = [path for path in paths if Path(path).stem == f"spoke_{label}"]
            item = tree.add("Mesh::Feature", f"Phase_{label}", group)
            if found:
                item.Mesh = Mesh.Mesh(str(found[0]))
            elif design.voxels.count(i):
                raise MacroError(f"{design.name}: the library wrote no STL of {design.phases[i]}", 1)
            made.append(item)
    return made


def _bodies(tree: Tree, group: Any, design: Any) -> list[Any]:
    voxels, runs = design.voxels, [[] for _ in design.phases]
    edge, low = voxels.size_mm, -0.5 * voxels.size_mm * voxels.layers
    phases, offsets, halves = (v.tolist() for v in (voxels.phases, voxels.offsets, voxels.half_widths))
    for i in range(voxels.slices):
        width = 2 * halves[i]
        for layer in range(voxels.layers):
            first = offsets[i] + layer * width
            row = phases[first : first + width]
            start = 0
            for j in range(1, width + 1):
                if j == width or row[j] != row[start]:
                    runs[row[start]].append((i, layer, start - halves[i], j - start))
                    start = j
    total = sum(map(len, runs))
    if total > MOST_BOXES:
        raise MacroError(
            f"VOXELASTICA_PHASES = bodies: {total} boxes, more than {MOST_BOXES}; use meshes, or coarser voxels"
        )
    made = []
    for index, boxes in enumerate(runs):
        item = tree.add("Part::Feature", f"Phase_{_label(design, index)}", group)
        item.Shape = Part.makeCompound(
            [
                Part.makeBox(edge, edge * count, edge, Vector(edge * i, edge * start, low + edge * layer))
                for i, layer, start, count in boxes
            ]
        )
        made.append(item)
    return made
