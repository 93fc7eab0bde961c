# SPDX-License-Identifier: MIT OR Apache-2.0
"""A FEM analysis of one spoke: the deck's mesh, materials by modulus band or by phase, constraints, solver.

FreeCAD writes plain C3D8 elements, which lock in bending, and before 1.0 it has no rigid bodies. The analysis therefore keeps the
project's own deck (elements C3D8I, rigid end faces, the path of the morph); what is solved is that deck with the
materials of the document.
"""

from __future__ import annotations

import math
import tempfile
from itertools import groupby
from pathlib import Path
from typing import Any

import FreeCAD as App
import Fem
import ObjectsFem
import Part

from . import colours
from .deck import Deck
from .settings import MacroError
from .source import write_deck
from .tree import Tree, Vector, note, show

#: Where the corners of a C3D8 stand in FreeCAD's order, as in its own reader of decks.
_ORDER = (5, 6, 7, 4, 1, 2, 3, 0)


def femmesh(deck: Deck) -> Any:
    """The deck's hexahedra with their numbers; reference nodes are left out."""
    mesh, nodes, elements = Fem.FemMesh(), deck.nodes(), deck.elements()
    for number in sorted({node for corners in elements.values() for node in corners}):
        mesh.addNode(*nodes[number], number)
    for number, corners in elements.items():
        mesh.addVolume([corners[k] for k in _ORDER], number)
    return mesh


def _columns(deck: Deck) -> list[tuple[float, float, list[int], float]]:
    """Elements between the same two cross-sections, rim first: x of both, numbers, mean field."""
    nodes, field = deck.nodes(), deck.field()
    columns: dict[tuple[float, float], list[int]] = {}
    for number, corners in deck.elements().items():
        x = [nodes[node][0] for node in corners]
        columns.setdefault((min(x), max(x)), []).append(number)
    elements = deck.elements()
    made = []
    for (low, high), numbers in sorted(columns.items()):
        values = [field.get(node, 0.0) for number in numbers for node in elements[number]]
        made.append((low, high, numbers, sum(values) / len(values)))
    return made


def bands(deck: Deck, count: int) -> list[list[int]]:
    """Modulus bands: for every column of :func:`_columns` its band, grouped into runs of equal bands, rim first.

    Bands divide the range of the modulus into ``count`` equal parts. Returns lists of columns.
    """
    moduli = [column[3] for column in _columns(deck)]
    low, high = min(moduli), max(moduli)
    step = (high - low) / count or 1.0
    numbers = [min(int((modulus - low) / step), count - 1) for modulus in moduli]
    return [[i for i, _ in run] for _, run in groupby(enumerate(numbers), key=lambda pair: pair[1])]


def _outline(deck: Deck) -> dict[float, float]:
    """Half the width of the mesh over x, mm."""
    nodes = deck.nodes()
    halves: dict[float, float] = {}
    for corners in deck.elements().values():
        for node in corners:
            x, y, _ = nodes[node]
            halves[x] = max(halves.get(x, 0.0), y)
    return halves


def _body(stations: list[tuple[float, float]], thickness: float) -> Any:
    """A solid between the mid-plane's stations ``(x, half-width)``."""
    upper = [Vector(x, y, -0.5 * thickness) for x, y in stations]
    lower = [Vector(x, -y, -0.5 * thickness) for x, y in reversed(stations)]
    wire = Part.makePolygon([*upper, *lower, upper[0]])
    return Part.Face(wire).extrude(Vector(0, 0, thickness))


def _graded(deck: Deck, count: int, thickness: float) -> tuple[list[Any], list[dict[str, Any]]]:
    """Solids along the spoke, one a run of a band, and the materials, each with its solids and elements."""
    columns, halves = _columns(deck), _outline(deck)
    bodies, materials = [], []
    for run in bands(deck, max(count, 1)):
        stations = [columns[i][0] for i in run] + [columns[run[-1]][1]]
        bodies.append(_body([(x, halves[x]) for x in stations], thickness))
        elements = sorted(number for i in run for number in columns[i][2])
        weights = [columns[i][1] - columns[i][0] for i in run]
        modulus = sum(w * columns[i][3] for w, i in zip(weights, run)) / sum(weights)
        name = f"BAND-{len(bodies)}"
        materials.append({"name": name, "set": name, "modulus": modulus, "elements": elements, "solids": [len(bodies)]})
    return bodies, materials


def _stepped(design: Any, thickness: float) -> list[Any]:
    """Solids along the stepped outline of the voxels, one a run of slices of equal width."""
    voxels = design.voxels
    edge, bodies, at = voxels.size_mm, [], 0
    for half, run in groupby(voxels.half_widths.tolist()):
        length = len(list(run))
        stations = [(edge * at, edge * half), (edge * (at + length), edge * half)]
        bodies.append(_body(stations, thickness))
        at += length
    return bodies


def _end_face(body: Any, x: float) -> str:
    """Name of the face of a solid in the plane of an end."""
    for i, face in enumerate(body.Faces, 1):
        if abs(face.BoundBox.XMin - x) < 1e-6 and abs(face.BoundBox.XMax - x) < 1e-6:
            return f"Face{i}"
    raise MacroError(f"the strip has no face at x = {x}", 1)


def build(tree: Tree, design: Any, model: str, band_count: int) -> dict[str, Any]:
    """The analysis and its parts below a group ``Analysis``: returns ``analysis``, ``materials``, ``mesh``, ``solver``."""
    if design.input["target"]["kind"] == "strip" and "shortening" not in design.input["target"]:
        raise MacroError(
            f"{design.name}: a strip that is only stretched takes no shape; leave analysis out of the parts"
        )
    group = tree.group("FEM")
    document = tree.document
    with tempfile.TemporaryDirectory() as folder:
        path = write_deck(design, model, Path(folder))
        text = path.read_text(encoding="utf-8")
        deck = Deck(text, f"{design.name} ({path.name})")
        analysis = ObjectsFem.makeAnalysis(document, "Analysis")
        group.addObject(analysis)
        analysis.addProperty(
            "App::PropertyFileIncluded", "Deck", "Voxelastica", "The deck that is solved, but for its materials"
        )
        analysis.Deck = str(path)
    note(analysis, "Model", model, "Strip that is solved: graded or voxel")
    note(
        analysis,
        "KeepField",
        model == "graded" and band_count == 0,
        "Keep the deck's modulus field",
        "App::PropertyBool",
    )
    profile, length = design.profile, design.input["strips"]["length_mm"]
    target = [Vector(x, 0, z) for x, z in zip(profile.x_mm, profile.z_mm)]
    note(
        analysis,
        "Target",
        target,
        "Target of the mid-line, evenly spaced, seen from the rim",
        "App::PropertyVectorList",
    )
    note(analysis, "StripLength", length, "Length of the strip", "App::PropertyLength")
    note(analysis, "DesignHash", design.hash, "SHA-256 of the design")

    thickness = design.input["strips"]["thickness_mm"]
    if model == "graded":
        bodies, rows = _graded(deck, band_count, thickness)
    else:
        bodies = _stepped(design, thickness)
        rows = []
    geometry = tree.add("Part::Feature", "FEM_bodies", group)
    geometry.Shape = Part.makeCompound(bodies)

    mesh = document.addObject("Fem::FemMeshObject", "FEM_mesh")
    mesh.FemMesh = femmesh(deck)
    note(mesh, "ElementType", deck.element_type(), "Elements that are solved")
    analysis.addObject(mesh)

    if model == "graded":
        poisson = deck.poisson()
        materials = [
            _material(document, analysis, row, poisson, deck.density_kg_m3(row["modulus"]), geometry) for row in rows
        ]
    else:
        materials = _phases(document, analysis, design, deck)
    constraints = _constraints(document, analysis, deck, geometry, length)
    make = getattr(ObjectsFem, "makeSolverCalculiXCcxTools", None) or ObjectsFem.makeSolverCalculixCcxTools
    solver = make(document, "CalculiX")
    solver.GeometricalNonlinearity = "nonlinear"
    solver.MaterialNonlinearity = "linear"
    solver.IterationsControlParameterTimeUse = False
    analysis.addObject(solver)
    document.recompute()
    show(geometry, visible=False, DiffuseColor=_shades(geometry, rows, design), Transparency=0)
    show(mesh, visible=False)
    made = {"group": group, "analysis": analysis, "materials": materials, "mesh": mesh, "solver": solver}
    return {**made, "bodies": geometry, "constraints": constraints}


def _shades(geometry: Any, rows: list[dict[str, Any]], design: Any) -> list[tuple[float, ...]]:
    """A colour for every face of the bodies."""
    if not rows:
        return [(*colours.ramp(0.45), 0.0)] * len(geometry.Shape.Faces)
    scale = (min(design.profile.modulus_mpa), max(design.profile.modulus_mpa))
    solids = geometry.Shape.Solids
    return [(*colours.shade(r["modulus"], *scale), 0.0) for r, solid in zip(rows, solids) for _ in solid.Faces]


def _material(document: Any, analysis: Any, row: dict[str, Any], poisson: float, density: float, geometry: Any) -> Any:
    material = ObjectsFem.makeMaterialSolid(document, row["name"].replace("-", "_").capitalize())
    material.Label = f"{row['name']}: {row['modulus']:.4g} MPa"
    values = dict(material.Material)
    values.update(
        Name=row["name"],
        YoungsModulus=f"{row['modulus']!r} MPa",
        PoissonRatio=f"{poisson!r}",
        Density=f"{density!r} kg/m^3",
    )
    material.Material = values
    if row["solids"]:
        material.References = [(geometry, tuple(f"Solid{i}" for i in row["solids"]))]
    note(material, "ElementSet", row["set"], "Set of the deck")
    note(material, "Elements", row["elements"], "Elements of a set that the deck has not", "App::PropertyIntegerList")
    analysis.addObject(material)
    return material


def _phases(document: Any, analysis: Any, design: Any, deck: Deck) -> list[Any]:
    """One material a phase, on the deck's own sets."""
    import json

    made, sections = [], deck.sections()
    for phase in json.loads(design.to_json())["phases"]:
        name = f"PHASE-{phase['label']}"
        if name not in sections:
            continue
        row = {"name": name, "set": name, "modulus": phase["modulus_mpa"], "elements": [], "solids": []}
        made.append(_material(document, analysis, row, phase["poisson"], phase.get("density_kg_m3") or 0.0, None))
    return made


def _constraints(document: Any, analysis: Any, deck: Deck, geometry: Any, length: float) -> list[Any]:
    """What holds the two end faces at the end of the morph: a rigid body where FreeCAD has one, displacements otherwise."""
    values, solids = deck.boundary(), geometry.Shape.Solids
    made = []
    for name, body, x in (("RIM", solids[0], 0.0), ("HUB", solids[-1], length)):
        # Faces are numbered through the compound.
        before = sum(len(s.Faces) for s in (solids[: len(solids) - 1] if name == "HUB" else []))
        face = f"Face{before + int(_end_face(body, x)[4:])}"
        moves = [values.get((f"RP-{name}", freedom)) for freedom in (1, 2, 3)]
        turn = values.get((f"RP-{name}-ROT", 2), 0.0)
        make = getattr(ObjectsFem, "makeConstraintRigidBody", None)
        if make is not None:
            item = make(document, f"{name.capitalize()}_constraint")
            item.ReferenceNode = Vector(x, 0, 0)
            for axis, value in zip("XYZ", moves):
                setattr(item, f"TranslationalMode{axis}", "Free" if value is None else "Constraint")
                setattr(item, f"RotationalMode{axis}", "Constraint")
            item.Displacement = Vector(*(value or 0.0 for value in moves))
            item.Rotation = App.Rotation(Vector(0, 1, 0), math.degrees(turn))
        else:
            item = ObjectsFem.makeConstraintDisplacement(document, f"{name.capitalize()}_constraint")
            for axis, value in zip("xyz", moves):
                setattr(item, f"{axis}Free", value is None)
                setattr(item, f"{axis}Fix", value == 0.0)
                setattr(item, f"{axis}Displacement", value or 0.0)
        item.References = [(geometry, face)]
        item.Label = f"{name}: turned by {math.degrees(turn):.2f} degrees about y"
        note(item, "Turn", math.degrees(turn), "Rotation of the end face about y at the end", "App::PropertyAngle")
        analysis.addObject(item)
        # Its symbols stand on the strip's frame, amid the flower.
        show(item, visible=False)
        made.append(item)
    return made
