"""One spoke as a solid: the stepped outline of its voxels, cut at every voxel plane, a section a phase.

Frame as in the decks: rim at x = 0, hub at x = L, mid-plane z = 0, y across. The part is extruded from z = 0 upward and
its instance lowered by half the thickness.
"""

from __future__ import division

from abaqusConstants import CARTESIAN, DEFORMABLE_BODY, HEX, ON, STRUCTURED, THREE_D, XYPLANE, XZPLANE, YZPLANE

from . import VoxelasticaError, cells, ends, materials, morph
from .messages import progress, say

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from typing import Any  # novm

    from abaqus.Assembly.Assembly import Assembly
    from abaqus.BasicGeometry.CellArray import CellArray
    from abaqus.Model.Model import Model
    from abaqus.Part.Part import Part

    from .design import Design

PART = "SPOKE"
INSTANCE = "SPOKE-1"


def outline(design):
    # type: (Design) -> list[tuple[float, float]]
    """Corners of the stepped outline, counter-clockwise from the rim's lower corner: [(x, y)] in mm."""
    edge, halves = design.edge, design.half_widths
    upper = [(0.0, halves[0] * edge)]
    for i in range(1, design.slices):
        if halves[i] != halves[i - 1]:
            upper += [(i * edge, halves[i - 1] * edge), (i * edge, halves[i] * edge)]
    upper.append((design.slices * edge, halves[-1] * edge))
    return [(x, -y) for x, y in upper] + upper[::-1]


def names(design):
    # type: (Design) -> dict[str, list[str]]
    """Names that the model must not have yet: a dict from repository to names."""
    return {
        "parts": [PART],
        "materials": [phase["material"] for phase in design.present()],
        "sections": ["PHASE-" + phase["label"] for phase in design.present()],
        "steps": [morph.STEP_NAME],
        "amplitudes": [motion.amplitude for motion in design.motions],
        "instances": [INSTANCE],
        "sets": ["MIDLINE", "RIM", "HUB", "RP-RIM", "RP-HUB"],
        "constraints": ["RIM", "HUB"],
        "boundaryConditions": [motion.amplitude for motion in design.motions] + ["RIM-HELD", "HUB-HELD"],
        "fieldOutputRequests": [morph.FIELD_REQUEST],
        "historyOutputRequests": [morph.REQUEST + name for name in ("MIDLINE", "RP-RIM", "RP-HUB")],
    }


def check(design):
    # type: (Design) -> None
    """Raises VoxelasticaError where a strip cannot be built as geometry."""
    if not design.listed:
        raise VoxelasticaError(
            "%s does not list its %d voxels one by one: so many cannot be partitioned; import the mesh"
            % (design.path, design.voxels)
        )
    if design.initial_bow:
        raise VoxelasticaError(
            "%s: the strip is to buckle and starts bowed by %g mm, which flat geometry has not; import the mesh"
            % (design.path, design.initial_bow)
        )


def build(model, design, mesh=True, find="auto"):
    # type: (Model, Design, bool, str) -> None
    """Builds part, sections, assembly, constraints, step and outputs in a model.

    ``mesh``: generate the mesh. ``find``: how cells are found, "planes", "runs" or "auto" (see cells.py).
    """
    part = _solid(model, design)
    _partition(part, design)
    _sets(part, design, find)
    for phase in design.present():
        materials.solid_section(model, part, "PHASE-" + phase["label"], materials.phase(model, phase))
    per_edge, _ = design.elements_per_edge()
    element = materials.solid_element(design, design.layers * per_edge)
    part.setElementType(regions=(part.cells,), elemTypes=(materials.element_type(element),))
    part.setMeshControls(regions=part.cells, elemShape=HEX, technique=STRUCTURED)
    part.seedPart(size=design.edge / per_edge, deviationFactor=0.1, minSizeFactor=0.1)
    if mesh:
        part.generateMesh()
        wanted = design.voxels * per_edge**3
        if len(part.elements) != wanted:
            raise VoxelasticaError(
                "CAE meshed %d elements of %d; import the mesh instead" % (len(part.elements), wanted)
            )
    assembly = _assemble(model, part, design, mesh)
    morph.step(model, design)
    morph.rim(model, design, assembly.sets["RP-RIM"])
    morph.hub(model, design, assembly.sets["RP-HUB"])
    nodes = design.voxels * per_edge**3
    morph.outputs(model, assembly.sets, nodes, "MIDLINE", ("RP-RIM", "RP-HUB"))


def _solid(model, design):
    # type: (Model, Design) -> Part
    corners = outline(design)
    sketch = model.ConstrainedSketch(name="__voxelastica__", sheetSize=2.0 * design.length)
    for start, end in zip(corners, corners[1:] + corners[:1]):
        sketch.Line(point1=start, point2=end)
    part = model.Part(name=PART, dimensionality=THREE_D, type=DEFORMABLE_BODY)
    part.BaseSolidExtrude(sketch=sketch, depth=design.thickness)
    del model.sketches["__voxelastica__"]
    return part


def _partition(part, design):
    # type: (Part, Design) -> None
    """Cuts the solid at every voxel plane: layers, slices, columns."""
    edge, most = design.edge, max(design.half_widths)
    cuts = []  # type: list[tuple[Any, float]]
    cuts += [(XYPLANE, layer * edge) for layer in range(1, design.layers)]
    cuts += [(YZPLANE, i * edge) for i in range(1, design.slices)]
    cuts += [(XZPLANE, j * edge) for j in range(1 - most, most)]
    for done, (plane, offset) in enumerate(cuts):
        if done % 20 == 0:
            progress("Voxelastica: cutting", "planes", done, len(cuts))
        datum = part.DatumPlaneByPrincipalPlane(principalPlane=plane, offset=offset)
        part.PartitionCellByDatumPlane(datumPlane=part.datums[datum.id], cells=part.cells)
    if len(part.cells) != design.voxels:
        raise VoxelasticaError(
            "CAE made %d cells of %d voxels; import the mesh instead" % (len(part.cells), design.voxels)
        )


def _box(part, design, slices=None, layers=None, columns=None):
    # type: (Part, Design, tuple[int, int] | None, tuple[int, int] | None, tuple[int, int] | None) -> CellArray
    """The cells inside a box of voxels; ranges (first, end), all where None."""
    edge, slack, most = design.edge, 0.1 * design.edge, max(design.half_widths)
    x, z, y = slices or (0, design.slices), layers or (0, design.layers), columns or (-most, most)
    return part.cells.getByBoundingBox(
        xMin=x[0] * edge - slack,
        yMin=y[0] * edge - slack,
        zMin=z[0] * edge - slack,
        xMax=x[1] * edge + slack,
        yMax=y[1] * edge + slack,
        zMax=z[1] * edge + slack,
    )


def _sets(part, design, find):
    # type: (Part, Design, str) -> None
    """Part sets SLICE-i and PHASE-NAME."""
    slabs = [_box(part, design, slices=(i, i + 1)) for i in range(design.slices)]
    for i, slab in enumerate(slabs):
        part.Set(name="SLICE-%d" % (i + 1), cells=slab)
    boxes = cells.runs(design) if find != "planes" else []
    asked = cells.planes(design) - design.slices
    if find == "runs" or (find == "auto" and len(boxes) <= asked):
        _check(part, design, _by_runs(part, design, boxes))
        return
    problem = _check(part, design, _by_planes(part, design, slabs), strict=find == "planes")
    if problem:
        say("Voxelastica: %s; looking the voxels up run by run, which takes longer" % problem)
        _check(part, design, _by_runs(part, design, boxes))


def _by_planes(part, design, slabs):
    # type: (Part, Design, list[CellArray]) -> dict | None
    """Cells of each present phase from the indices of slices, layers and columns."""
    most = max(design.half_widths)
    slice_of, layer_of, column_of = {}, {}, {}
    for i, slab in enumerate(slabs):
        slice_of.update((cell.index, i) for cell in slab)
    for layer in range(design.layers):
        layer_of.update((cell.index, layer) for cell in _box(part, design, layers=(layer, layer + 1)))
    for j in range(-most, most):
        column_of.update((cell.index, j) for cell in _box(part, design, columns=(j, j + 1)))
    if not len(slice_of) == len(layer_of) == len(column_of) == design.voxels:
        return None
    indices = [[] for _ in design.phases]
    for index, i in slice_of.items():
        half = design.half_widths[i]
        indices[design.phase_of(i, layer_of[index], column_of[index] + half)].append(index)
    found = {}
    for phase, of_phase in zip(design.phases, indices):
        if of_phase:
            found[phase["label"]] = part.cells.getSequenceFromMask(mask=cells.mask(of_phase))
    return found


def _by_runs(part, design, boxes):
    # type: (Part, Design, list) -> dict
    """Cells of each present phase, one question a run of equal voxels."""
    parts = [[] for _ in design.phases]
    for done, (phase, slices, layers, columns) in enumerate(boxes):
        if done % 100 == 0:
            progress("Voxelastica: finding voxels", "runs", done, len(boxes))
        parts[phase].append(_box(part, design, slices, layers, columns))
    found = {}
    for phase, sequences in zip(design.phases, parts):
        # Joined in pairs: adding one by one would copy the first ones over and over.
        while len(sequences) > 1:
            pairs = zip(sequences[::2], sequences[1::2])
            sequences = [a + b for a, b in pairs] + (sequences[-1:] if len(sequences) % 2 else [])
        if sequences:
            found[phase["label"]] = sequences[0]
    return found


def _check(part, design, found, strict=True):
    # type: (Part, Design, dict | None, bool) -> str
    """Makes the sets of the phases if they hold as many cells as the design has voxels; else says what is wrong."""
    problem = "" if found else "the planes of voxels do not hold every cell"
    found = found or {}
    for phase in design.present() if found else []:
        count, wanted = len(found.get(phase["label"], ())), design.counts[phase["label"]]
        if count != wanted:
            problem = "%d cells were found for %d voxels of %s" % (count, wanted, phase["name"])
    if problem and strict:
        raise VoxelasticaError(problem + "; import the mesh instead")
    if not problem:
        for phase in design.present():
            part.Set(name="PHASE-" + phase["label"], cells=found[phase["label"]])
    return problem


def _assemble(model, part, design, mesh):
    # type: (Model, Part, Design, bool) -> Assembly
    """Instance, reference points, sets of the ends and the mid-line, rigid ends."""
    assembly = model.rootAssembly
    assembly.DatumCsysByDefault(coordSysType=CARTESIAN)
    instance = assembly.Instance(name=INSTANCE, part=part, dependent=ON)
    assembly.translate(instanceList=(INSTANCE,), vector=(0.0, 0.0, -0.5 * design.thickness))
    slack, wide, thick = 0.1 * design.edge, max(design.half_widths) * design.edge, 0.5 * design.thickness
    for name, x in (("RIM", 0.0), ("HUB", design.length)):
        faces = instance.faces.getByBoundingBox(
            xMin=x - slack,
            yMin=-wide - slack,
            zMin=-thick - slack,
            xMax=x + slack,
            yMax=wide + slack,
            zMax=thick + slack,
        )
        assembly.Set(name=name, faces=faces)
        ends.reference_point(assembly, "RP-" + name, (x, 0.0, 0.0))
        ends.pin(model, name)
    line = dict(xMin=-slack, yMin=-slack, zMin=-slack, xMax=design.length + slack, yMax=slack, zMax=slack)
    if design.layers % 2 == 0:
        assembly.Set(name="MIDLINE", edges=instance.edges.getByBoundingBox(**line))
    elif mesh:
        assembly.Set(name="MIDLINE", nodes=instance.nodes.getByBoundingBox(**line))
    else:
        raise VoxelasticaError("with an odd number of layers the mid-line has nodes but no edges: generate the mesh")
    return assembly
