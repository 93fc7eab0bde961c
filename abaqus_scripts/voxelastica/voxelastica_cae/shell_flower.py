"""The whole flower as shells: all spokes with their smooth outline and the hub, the modulus an analytical field.

Frame as in the decks: hub at the origin, z up, spoke 1 along +x, the others counter-clockwise. Every spoke has a datum
system of its own, X from the rim inward, Y across, Z up; the field's expression, the boundary conditions and the
reactions are in it.
"""

from __future__ import division

import math

from abaqusConstants import (
    AXIS_3,
    CARTESIAN,
    CONSTANT_THROUGH_THICKNESS,
    DEFORMABLE_BODY,
    FIELD,
    FINER,
    FORWARD,
    ON,
    QUAD,
    STACK_3,
    STRUCTURED,
    SWEEP,
    SYSTEM,
    THREE_D,
    UNIFORM,
    XZPLANE,
)

from . import VoxelasticaError, ends, materials, morph
from .messages import say

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from typing import Any  # novm

    from abaqus.Assembly.Assembly import Assembly
    from abaqus.Assembly.PartInstance import PartInstance
    from abaqus.BasicGeometry.EdgeArray import EdgeArray
    from abaqus.Datum.Datum import Datum
    from abaqus.Model.Model import Model
    from abaqus.Part.Part import Part
    from abaqus.Region.Set import Set

    from .design import Design

PART = "SPOKE"
HUB_PART = "HUB-PLATE"
#: Name of the graded material and of its section.
GRADED = "GRADED"
#: Stations of the outline's splines: as dense as a curve that steep and smooth needs.
_OUTLINE = 100
#: Of lengths, as a share of the spoke's: how far entities may lie off where they are sought.
_SLACK = 1e-5


def names(design):
    # type: (Design) -> dict[str, list[str]]
    """Names that the model must not have yet: a dict from repository to names."""
    spokes = range(1, design.count + 1)
    sets = ["HUB", "HUB-PLATE", "RP-HUB", "RP-RIMS", "RP-HUBS"]
    for kind in ("MIDLINE", "RIM", "HUB", "RP-RIM", "RP-HUB", "SPOKE"):
        sets += ["%s-%d" % (kind, i) for i in spokes]
    # The hub rises as a whole; all else is a spoke's own.
    middle = [motion.amplitude for motion in design.motions if motion is design.hub_height] + ["HUB-HELD"]
    own = [motion.amplitude for motion in design.motions if motion is not design.hub_height] + ["RIM-HELD", "HUB-HELD"]
    points = ["%s-%d" % (name, i) for name in ("RP-RIM", "RP-HUB") for i in spokes] + ["RP-HUB"]
    return {
        "parts": [PART, HUB_PART],
        "materials": [GRADED, "HUB"],
        "sections": [GRADED, "HUB"],
        "steps": [morph.STEP_NAME],
        "amplitudes": [motion.amplitude for motion in design.motions],
        "analyticalFields": ["MODULUS-%d" % i for i in spokes],
        "instances": ["SPOKE-%d" % i for i in spokes] + ["HUB-PLATE-1"],
        "sets": sets,
        "constraints": ["HUB"] + ["%s-%d" % (name, i) for name in ("RIM", "HUB", "HUB-HEIGHT") for i in spokes],
        "boundaryConditions": middle + ["%s-%d" % (name, i) for name in own for i in spokes],
        "predefinedFields": ["MODULUS-HUB"] + ["MODULUS-%d" % i for i in spokes],
        "fieldOutputRequests": [morph.FIELD_REQUEST],
        "historyOutputRequests": [morph.REQUEST + name for name in ["MIDLINE-1"] + points],
    }


def build(model, design, mesh=True):
    # type: (Model, Design, bool) -> None
    """Builds parts, sections, fields, assembly, constraints, step and outputs in a model."""
    materials.graded(model, design, GRADED)
    stiffest = design.phases[-1]
    density = materials.density(stiffest)
    everywhere = all(materials.density(phase) is not None for phase in design.phases)
    modulus, poisson = float(stiffest["modulus_mpa"]), float(stiffest["poisson"])
    materials.plain(model, "HUB", modulus, poisson, density if everywhere else None)
    spoke = _spoke(model, design)
    hub = _hub(model, design)
    if mesh:
        _mesh(spoke, design)
        hub.generateMesh()
    _phase_sets(spoke, design, mesh)
    assembly = model.rootAssembly
    assembly.DatumCsysByDefault(coordSysType=CARTESIAN)
    morph.step(model, design)
    systems = []
    for i in range(1, design.count + 1):
        systems.append(_place(model, spoke, design, i))
    _middle(model, hub, design)
    _reference_sets(assembly, design)
    for i, csys in enumerate(systems, 1):
        suffix = "-%d" % i
        morph.rim(model, design, assembly.sets["RP-RIM" + suffix], suffix, csys)
        morph.hub(model, design, assembly.sets["RP-HUB" + suffix], suffix, csys, height=False)
        terms = ((1.0, "RP-HUB" + suffix, 3), (-1.0, "RP-HUB", 3))
        model.Equation(name="HUB-HEIGHT" + suffix, terms=terms)
    morph.middle(model, design, assembly.sets["RP-HUB"])
    along, across = design.decks["shell_elements"]
    nodes = design.count * (along + 1) * (across + 1)
    references = ["%s-%d" % (name, i) for name in ("RP-RIM", "RP-HUB") for i in range(1, design.count + 1)]
    # The temperature is the modulus. Spokes are alike: the history of one mid-line is enough.
    morph.outputs(model, assembly.sets, nodes, "MIDLINE-1", references + ["RP-HUB"], ("S", "LE", "TEMP"))


def outline(design):
    # type: (Design) -> list[tuple[float, float]]
    """Points of the spoke's upper edge, rim first: [(x, y)] in mm in the flower's frame."""
    s, width = design.profile["s_mm"], design.profile["width_mm"]
    every = max(1, (len(s) - 1) // _OUTLINE)
    at = list(range(0, len(s) - 1, every)) + [len(s) - 1]
    return [(design.hub_radius + design.length - s[k], 0.5 * width[k]) for k in at]


def _spoke(model, design):
    # type: (Model, Design) -> Part
    """The part of all spokes: half above and half below its mid-line, seeded and with a section."""
    upper = outline(design)
    lower = [(x, -y) for x, y in upper]
    sketch = model.ConstrainedSketch(name="__voxelastica__", sheetSize=4.0 * design.length)
    for side in (upper, lower):
        if max(y for _, y in side) - min(y for _, y in side) < _SLACK * design.length:
            sketch.Line(point1=side[0], point2=side[-1])
        else:
            sketch.Spline(points=tuple(side))
    for end in (0, -1):
        sketch.Line(point1=lower[end], point2=upper[end])
    part = model.Part(name=PART, dimensionality=THREE_D, type=DEFORMABLE_BODY)
    part.BaseShell(sketch=sketch)
    del model.sketches["__voxelastica__"]
    plane = part.DatumPlaneByPrincipalPlane(principalPlane=XZPLANE, offset=0.0)
    part.PartitionFaceByDatumPlane(datumPlane=part.datums[plane.id], faces=part.faces)
    part.Set(name="SPOKE", faces=part.faces)
    materials.shell_section(model, part, "SPOKE", GRADED, GRADED, design.thickness)
    axes = part.DatumCsysByThreePoints(  # pyright: ignore[reportCallIssue]  lines are for the other form
        name="ALONG",
        coordSysType=CARTESIAN,
        origin=(upper[0][0], 0.0, 0.0),
        point1=(upper[-1][0], 0.0, 0.0),
        point2=(upper[-1][0], -1.0, 0.0),
    )
    part.MaterialOrientation(
        region=part.sets["SPOKE"],
        orientationType=SYSTEM,
        localCsys=part.datums[axes.id],  # pyright: ignore[reportArgumentType]  a Datum of the repository
        axis=AXIS_3,
        stackDirection=STACK_3,
    )
    _seed(part, design, upper)
    return part


def _seed(part, design, upper):
    # type: (Part, Design, list[tuple[float, float]]) -> None
    """Elements along and across as in the deck, swept along the mid-line."""
    along, across = design.decks["shell_elements"]
    narrow = 0.25 * min(y for _, y in upper)
    for sign in (1, -1):
        part.seedEdgeByNumber(edges=_edges(part, design, upper, side=sign * narrow), number=along, constraint=FINER)
    part.seedEdgeByNumber(edges=_edges(part, design, upper, y=0.0), number=along, constraint=FINER)
    for x in (upper[0][0], upper[-1][0]):
        part.seedEdgeByNumber(edges=_edges(part, design, upper, x=x), number=across // 2, constraint=FINER)
    part.setElementType(regions=(part.faces,), elemTypes=(materials.element_type(design.decks["shell_element"]),))
    midline = _edges(part, design, upper, y=0.0)[0]
    try:
        part.setMeshControls(regions=part.faces, elemShape=QUAD, technique=SWEEP)
        for face in part.faces:
            # The stub wants a string; the face itself is what CAE records.
            part.setSweepPath(region=face, edge=midline, sense=FORWARD)  # pyright: ignore[reportArgumentType]
    except (AttributeError, TypeError):  # a mistake of this script, not CAE's refusal
        raise
    except Exception as error:
        say("Voxelastica: CAE does not sweep the spoke (%s); its mesh is structured" % error)
        part.setMeshControls(regions=part.faces, elemShape=QUAD, technique=STRUCTURED)


def _mesh(part, design):
    # type: (Part, Design) -> None
    """Meshes the spoke; where sweeping leaves the seeds unheeded, structured."""
    along, across = design.decks["shell_elements"]
    part.generateMesh()
    if len(part.elements) != along * across:
        say("Voxelastica: swept, the spoke has %d elements; its mesh is structured" % len(part.elements))
        part.deleteMesh(regions=part.faces)  # pyright: ignore[reportArgumentType]  faces are regions
        part.setMeshControls(regions=part.faces, elemShape=QUAD, technique=STRUCTURED)
        part.generateMesh()
    if len(part.elements) != along * across:
        raise VoxelasticaError(
            "CAE meshed %d elements where the seeds ask for %d" % (len(part.elements), along * across)
        )


def _edges(of, design, upper, x=None, y=None, side=None):
    # type: (Part | PartInstance, Design, list[tuple[float, float]], float | None, float | None, float | None) -> EdgeArray
    """Edges of a part or of spoke 1: at one x (an end's), at one y (the mid-line), or beyond `side` (an outline)."""
    slack, wide = _SLACK * design.length, 2.0 * max(y for _, y in upper)
    low, high = [upper[-1][0] - slack, -wide], [upper[0][0] + slack, wide]
    if x is not None:
        low[0], high[0] = x - slack, x + slack
    if y is not None:
        low[1], high[1] = y - slack, y + slack
    if side is not None:
        (low if side > 0 else high)[1] = side
    return of.edges.getByBoundingBox(xMin=low[0], yMin=low[1], zMin=-slack, xMax=high[0], yMax=high[1], zMax=slack)


def _hub(model, design):
    # type: (Model, Design) -> Part
    """The hub: a polygon whose edges the spokes meet."""
    half = math.pi / design.count
    radius = design.hub_radius / math.cos(half)
    corners = [
        (radius * math.cos(half * (2 * k - 1)), radius * math.sin(half * (2 * k - 1))) for k in range(design.count)
    ]
    sketch = model.ConstrainedSketch(name="__voxelastica__", sheetSize=4.0 * design.length)
    for start, end in zip(corners, corners[1:] + corners[:1]):
        sketch.Line(point1=start, point2=end)
    part = model.Part(name=HUB_PART, dimensionality=THREE_D, type=DEFORMABLE_BODY)
    part.BaseShell(sketch=sketch)
    del model.sketches["__voxelastica__"]
    part.Set(name="HUB", faces=part.faces)
    materials.shell_section(model, part, "HUB", "HUB", "HUB", design.thickness)
    part.setElementType(regions=(part.faces,), elemTypes=(materials.element_type(design.decks["shell_element"]),))
    # Rigid: its mesh need not be fine.
    part.seedPart(size=0.25 * design.hub_radius, deviationFactor=0.1, minSizeFactor=0.1)
    return part


def _phase_sets(part, design, mesh):
    # type: (Part, Design, bool) -> None
    """Part sets PHASE-NAME: where the mixture contains the phase, by elements unless that is everywhere."""
    end, slack = design.hub_radius + design.length, _SLACK * design.length
    step, wide = design.length / design.decks["shell_elements"][0], max(design.profile["width_mm"])
    for k, phase in enumerate(design.phases):
        within = [fraction(design, k, modulus) > 1e-9 for modulus in design.profile["modulus_mpa"]]
        if all(within):
            part.Set(name="PHASE-" + phase["label"], faces=part.faces)
        elif any(within) and mesh:
            found = None
            for first, last in _stretches(design.profile["s_mm"], within):
                here = part.elements.getByBoundingBox(
                    xMin=end - last - step - slack,
                    yMin=-wide,
                    zMin=-slack,
                    xMax=end - first + step + slack,
                    yMax=wide,
                    zMax=slack,
                )
                found = here if found is None else found + here
            part.Set(name="PHASE-" + phase["label"], elements=found)


def _stretches(s, within):
    """Where something holds, as [(first, last)] in mm."""
    found, first = [], None
    for k, here in enumerate(list(within) + [False]):
        if here and first is None:
            first = k
        if not here and first is not None:
            found.append((s[first], s[k - 1]))
            first = None
    return found


def fraction(design, phase, modulus):
    # type: (Design, int, float) -> float
    """Share of a phase in the mixture of this modulus: linear between the rows of the design's table."""
    rows = design.rows
    if modulus <= rows[0]["modulus_mpa"]:
        return rows[0]["fractions"][phase]
    for below, above in zip(rows, rows[1:]):
        if modulus <= above["modulus_mpa"]:
            share = (modulus - below["modulus_mpa"]) / (above["modulus_mpa"] - below["modulus_mpa"])
            return (1.0 - share) * below["fractions"][phase] + share * above["fractions"][phase]
    return rows[-1]["fractions"][phase]


def outward(design, i):
    # type: (Design, int) -> tuple[float, ...]
    """Unit vector from the hub along spoke i, exact along the axes."""
    angle = 2.0 * math.pi * (i - 1) / design.count
    return tuple(0.0 if abs(c) < 1e-14 else c for c in (math.cos(angle), math.sin(angle)))


def _place(model, part, design, i):
    # type: (Model, Part, Design, int) -> Datum
    """Instance i with its system, sets, rigid ends, field and predefined field; returns the datum system.

    Edges are sought before the instance is turned: there they lie along the axes.
    """
    assembly, suffix, name = model.rootAssembly, "-%d" % i, "SPOKE-%d" % i
    upper = outline(design)
    instance = assembly.Instance(name=name, part=part, dependent=ON)
    assembly.Set(name="RIM" + suffix, edges=_edges(instance, design, upper, x=upper[0][0]))
    assembly.Set(name="HUB" + suffix, edges=_edges(instance, design, upper, x=upper[-1][0]))
    assembly.Set(name="MIDLINE" + suffix, edges=_edges(instance, design, upper, y=0.0))
    assembly.Set(name=name, faces=instance.faces)
    if i > 1:
        assembly.rotate(
            instanceList=(name,),
            axisPoint=(0.0, 0.0, 0.0),
            axisDirection=(0.0, 0.0, 1.0),
            angle=360.0 * (i - 1) / design.count,
        )
    cos, sin = outward(design, i)
    rim, hub = [(radius * cos, radius * sin, 0.0) for radius in (upper[0][0], upper[-1][0])]
    axes = assembly.DatumCsysByThreePoints(  # pyright: ignore[reportCallIssue]  lines are for the other form
        name="ALONG" + suffix,
        coordSysType=CARTESIAN,
        origin=rim,
        point1=hub,
        point2=(hub[0] + sin, hub[1] - cos, 0.0),
    )
    csys = assembly.datums[axes.id]
    for end, at in (("RIM", rim), ("HUB", hub)):
        ends.reference_point(assembly, "RP-" + end + suffix, at)
        ends.tie(model, end + suffix, end + suffix)
    field = "MODULUS" + suffix
    model.ExpressionField(  # pyright: ignore[reportAttributeAccessIssue]  the stubs forgot the base class
        name=field,
        localCsys=csys,
        description="Young's modulus in MPa, X in mm from the rim",
        expression=design.expression,
    )
    _modulus(model, field, assembly.sets[name], distributionType=FIELD, field=field, magnitude=1.0)
    return csys


def _modulus(model, name, region, distributionType, field, magnitude):
    # type: (Model, str, Set, Any, str, float) -> None
    """The temperature that is the modulus: the field's value times the magnitude, or the magnitude alone."""
    model.Temperature(
        name=name,
        createStepName="Initial",
        region=region,
        distributionType=distributionType,
        crossSectionDistribution=CONSTANT_THROUGH_THICKNESS,
        field=field,
        magnitudes=(magnitude,),  # pyright: ignore[reportArgumentType]  CAE records a tuple
    )


def _middle(model, part, design):
    # type: (Model, Part, Design) -> None
    """The rigid hub plate with its reference point."""
    assembly = model.rootAssembly
    instance = assembly.Instance(name="HUB-PLATE-1", part=part, dependent=ON)
    assembly.Set(name="HUB", faces=instance.faces)
    assembly.Set(name="HUB-PLATE", faces=instance.faces)
    ends.reference_point(assembly, "RP-HUB", (0.0, 0.0, 0.0))
    ends.tie(model, "HUB", "HUB-PLATE")
    # Its material does not depend on the temperature; a value makes a plot of the modulus complete.
    modulus = float(design.phases[-1]["modulus_mpa"])
    _modulus(model, "MODULUS-HUB", assembly.sets["HUB"], distributionType=UNIFORM, field="", magnitude=modulus)


def _reference_sets(assembly, design):
    # type: (Assembly, Design) -> None
    """Sets of all rims' and all hub ends' reference points."""
    for name in ("RP-RIM", "RP-HUB"):
        points = tuple(assembly.sets["%s-%d" % (name, i)].referencePoints[0] for i in range(1, design.count + 1))
        assembly.Set(name=name + "S", referencePoints=points)
