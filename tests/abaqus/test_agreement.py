"""The recorded model against the deck of the same design: sets, counts, fields, boundary values, and how much is asked."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

from conftest import read_json

from decks.keywords import parse_deck
from decks.model import Deck
from .recording import Model, Recorder


def deck_boundaries(deck: Deck, sets: list[str]) -> dict[tuple[str, int], tuple[float, str | None]]:
    """Value at the end and amplitude of every prescribed degree of freedom of the sets with one node."""
    nodes = {name: deck.nset(name) for name in sets}
    found = {}
    for block in deck.steps[0].blocks:
        if block.keyword != "BOUNDARY":
            continue
        for _, items in block.rows():
            members = set(deck.nset(items[0]))
            for name, refs in nodes.items():
                for dof in range(int(items[1]), int(items[2]) + 1) if set(refs) <= members else ():
                    value = float(items[3]) if len(items) > 3 else 0.0
                    found[name, dof] = (value, block.get("AMPLITUDE"))
    return found


def same_boundaries(model: Model, deck: Deck, references: list[str]) -> None:
    ours, theirs = model.boundary_values(), deck_boundaries(deck, references)
    assert set(ours) == set(theirs)
    for key, (value, amplitude) in theirs.items():
        assert ours[key][0] == pytest.approx(value, rel=1e-8, abs=1e-12), key
        assert ours[key][1] == amplitude, key


def same_amplitudes(model: Model, deck: Deck) -> None:
    ours = model.amplitudes()
    assert set(ours) == set(deck.amplitudes)
    for name, block in deck.amplitudes.items():
        numbers = [float(item) for _, items in block.rows() for item in items]
        assert [v for pair in ours[name] for v in pair] == pytest.approx(numbers, rel=1e-8, abs=1e-10), name


def same_step(model: Model, deck: Deck) -> None:
    (step,) = model.called("StaticStep")
    block = deck.steps[0].block
    (items,) = [items for _, items in deck.steps[0].procedure.rows()]
    assert step["name"] == block.get("NAME") and step["nlgeom"] == "ON"
    assert step["maxNumInc"] == int(block.get("INC"))
    ours = [float(step[key]) for key in ("initialInc", "timePeriod", "minInc", "maxInc")]
    assert ours == pytest.approx([float(item) for item in items])


def same_materials(model: Model, deck: Deck, names: dict[str, str] | None = None) -> None:
    """Tables of the elasticity and the density; the deck's field variable is CAE's temperature."""
    ours: dict[str, dict] = {}
    for path, arguments in model.run.calls:
        if ".materials['" in path and path.rsplit(".", 1)[-1] in ("Elastic", "Density"):
            name, method = path.split(".materials['")[1].split("']")[0], path.rsplit(".", 1)[-1].upper()
            ours.setdefault(name, {})[method] = [[float(v) for v in row] for row in arguments["table"]]
    assert set(ours) == set(deck.materials)
    for name, material in deck.materials.items():
        assert set(ours[name]) == set(material.options)
        for option, block in material.options.items():
            theirs = [[float(item) for item in items if item] for _, items in block.rows()]
            assert ours[name][option] == [pytest.approx(row, rel=1e-9) for row in theirs], (name, option)


@pytest.mark.parametrize("name", ["hemisphere", "held", "odd", "centred", "through", "coupon"])
def test_the_strip_as_geometry_is_that_of_the_deck(record: Recorder, designs: dict[str, Path], name: str) -> None:
    folder = designs[name]
    document = read_json(folder / "design.json")
    deck = parse_deck(folder / "abaqus" / "voxel_solid.inp")
    model = record.build(folder, "geometry")
    part, per_edge = model.sets("SPOKE"), document["design"]["decks"]["elements_per_voxel_edge"]
    if per_edge * document["voxels"]["layers"] % 2:
        per_edge *= 2
    # Sets and counts: one cell a voxel, per_edge^3 elements a cell.
    (scope,) = deck.parts.values()
    assert set(part) == set(scope.elsets)
    for key, of in scope.elsets.items():
        assert part[key] == ("cells", len(of.members) // per_edge**3), key
        assert len(of.members) == part[key][1] * per_edge**3, key
    for phase, count in document["summary"]["voxels"].items():
        assert part[f"PHASE-{phase}"] == ("cells", count)
    # Sets of the assembly.
    ours = model.sets("rootAssembly")
    assert set(ours) == set(deck.root.nsets)
    rows = {}
    for end, slice_ in (("RIM", 0), ("HUB", -1)):
        columns = 2 * document["slices"]["half_width_voxels"][slice_]
        layers = document["voxels"]["layers"]
        assert ours[end] == ("faces", columns * layers)
        rows[end] = (columns * per_edge + 1) * (layers * per_edge + 1)
        assert len(deck.nset(end)) == rows[end]
    kind, members = ours["MIDLINE"]
    nodes = members * per_edge + 1 if kind == "edges" else members
    assert nodes == len(deck.nset("MIDLINE"))
    # One section assignment a phase, one seed, the deck's element.
    present = [k for k, v in document["summary"]["voxels"].items() if v]
    assert model.count("SectionAssignment") == len(present)
    (seed,) = model.called("seedPart")
    assert float(seed["size"]) == pytest.approx(document["voxels"]["size_mm"] / per_edge)
    (types,) = model.called("setElementType")
    element = scope.elements[0].type
    assert f"elemCode={element}" in str(types["elemTypes"])
    assert ("ENHANCED" in str(types["elemTypes"])) == (element == "C3D8R")
    same_boundaries(model, deck, ["RP-RIM", "RP-HUB"])
    same_amplitudes(model, deck)
    same_step(model, deck)
    same_materials(model, deck)
    bodies = {of["name"]: of for of in model.called("RigidBody")}
    assert set(bodies) == {"RIM", "HUB"} and all("pinRegion" in of and "tieRegion" not in of for of in bodies.values())


@pytest.mark.parametrize("name", ["hemisphere", "three_phases", "held", "nose_cone"])
def test_the_flower_is_that_of_the_deck(record: Recorder, designs: dict[str, Path], name: str) -> None:
    folder = designs[name]
    document = read_json(folder / "design.json")
    deck = parse_deck(folder / "abaqus" / "graded_shell.inp")
    model, count = record.build(folder, "shell"), document["design"]["strips"]["count"]
    ours = model.sets("rootAssembly")
    assert set(ours) == set(deck.root.nsets) | set(deck.root.elsets)
    # Counts: faces with 96 x 20 elements a spoke by the seeds; edges with their nodes.
    along, across = document["design"]["decks"]["shell_elements"]
    numbers = [(of["edges"], of["number"]) for of in model.called("seedEdgeByNumber")]
    assert sorted(n for _, n in numbers) == sorted([along] * 3 + [across // 2] * 2)
    assert sum(int(edges.split("[")[1].split(" ")[0]) for edges, _ in numbers) == 7
    for i in range(1, count + 1):
        assert ours[f"MIDLINE-{i}"] == ("edges", 1) and len(deck.nset(f"MIDLINE-{i}")) == along + 1
        assert ours[f"RIM-{i}"] == ours[f"HUB-{i}"] == ("edges", 2) and len(deck.nset(f"RIM-{i}")) == across + 1
        assert ours[f"SPOKE-{i}"] == ("faces", 2) and len(deck.elset(f"SPOKE-{i}")) == along * across
    # A phase is where the mixture holds it: everywhere, or the same rows of elements within two at every end.
    part = deck.parts["SPOKE"]
    phases = {k: v for k, v in model.sets("SPOKE").items() if k.startswith("PHASE-")}
    assert set(phases) == {k for k in part.elsets if k.startswith("PHASE-")}
    for key, (kind, members) in phases.items():
        elements = members // 2 * along * across if kind == "faces" else members
        assert abs(elements - len(part.elsets[key].members)) <= 4 * across, key
    references = [f"{name}-{i}" for name in ("RP-RIM", "RP-HUB") for i in range(1, count + 1)] + ["RP-HUB"]
    same_boundaries(model, deck, references)
    same_amplitudes(model, deck)
    same_step(model, deck)
    same_materials(model, deck)
    # Every end follows its point; all hub ends rise with the hub.
    bodies = {of["name"]: of for of in model.called("RigidBody")}
    assert len(bodies) == 2 * count + 1 and all("tieRegion" in of for of in bodies.values())
    terms = [[(float(a), b, c) for a, b, c in of["terms"]] for of in model.called("Equation")]
    assert terms == [[(1.0, f"RP-HUB-{i}", 3), (-1.0, "RP-HUB", 3)] for i in range(1, count + 1)]
    same_axes(model, deck, count)
    same_field(model, deck, document)


def same_axes(model: Model, deck: Deck, count: int) -> None:
    """Datum systems, reference points and boundary conditions' axes are those of the deck's *TRANSFORM."""
    systems = model.systems()
    assert len(systems) == count
    axes = {}
    for block in deck.root.transforms:
        (items,) = [items for _, items in block.rows()]
        axes[block.get("NSET")] = [float(item) for item in items]
    for of in model.called("DisplacementBC"):
        name = of["region"].split("sets['")[1].rstrip("']")
        if of.get("localCsys") is None:
            assert name == "RP-HUB" and name not in axes
            continue
        _, direction = systems[of["localCsys"]]
        assert [*direction, 0] == pytest.approx(axes[name][:3], abs=1e-9), name
    points = {}
    for path, of in model.run.calls:
        if path.endswith(".ReferencePoint"):
            points[len(points)] = [float(v) for v in of["point"]]
    theirs = sorted(p for i in range(1, count + 1) for n in ("RP-RIM", "RP-HUB") for p in deck.points(f"{n}-{i}"))
    ours = sorted(points.values())
    assert len(ours) == 2 * count + 1
    for point in [*theirs, (0.0, 0.0, 0.0)]:
        assert min(math.dist(point, p) for p in ours) < 1e-7


def same_field(model: Model, deck: Deck, document: dict) -> None:
    """The expression in each spoke's system at 200 nodes of the deck gives the deck's value there, within its own error."""
    systems, fields = model.systems(), {of["name"]: of for of in model.called("ExpressionField")}
    values: dict = {}
    for _, items in [row for block in deck.initial for row in block.rows()]:
        for ref in deck.refs(items[0].upper()) or []:
            values[ref] = float(items[1])
    spokes = [ref for ref in values if ref[0].startswith("SPOKE-")]
    chosen = random.Random(7).sample(spokes, 200)
    allowed = document["modulus_field"]["max_error_percent"] / 100 + 1e-6
    given = {of["name"]: of for of in model.called("Temperature")}
    assert len({ref[0] for ref in chosen}) == document["design"]["strips"]["count"]
    for ref in chosen:
        number = ref[0].removeprefix("SPOKE-")
        field, predefined = fields[f"MODULUS-{number}"], given[f"MODULUS-{number}"]
        assert predefined["region"].endswith(f"sets['SPOKE-{number}']") and predefined["field"] == field["name"]
        assert predefined["distributionType"] == "FIELD" and predefined["createStepName"] == "Initial"
        origin, direction = systems[field["localCsys"]]
        x, y, _ = deck.point(ref)
        along = (x - origin[0]) * direction[0] + (y - origin[1]) * direction[1]
        scope = {"X": along, "exp": math.exp, "pow": math.pow, "__builtins__": {}}
        modulus = eval(field["expression"], scope) * float(predefined["magnitudes"][0])
        assert modulus == pytest.approx(values[ref], rel=allowed), (ref, along)
    (hub,) = [of for of in given.values() if of["name"] == "MODULUS-HUB"]
    assert float(hub["magnitudes"][0]) == document["phases"][-1]["modulus_mpa"]


def test_the_outline_is_that_of_the_deck(record: Recorder, designs: dict[str, Path]) -> None:
    """Points of the splines against the deck's edge nodes, and the hub's polygon."""
    folder = designs["hemisphere"]
    document = read_json(folder / "design.json")
    model = record.build(folder, "shell")
    splines = [[[float(v) for v in p] for p in of["points"]] for of in model.called("Spline")]
    assert len(splines) == 2
    s, width = document["profile"]["s_mm"], document["profile"]["width_mm"]
    for x, y in splines[0]:
        at = 110.0 - x
        k = min(range(len(s)), key=lambda k: abs(s[k] - at))
        assert abs(s[k] - at) < 1e-9 and y == pytest.approx(width[k] / 2)
    hub = [[float(v) for v in of["point1"]] for of in model.called("Line")][2:]
    assert len(hub) == 8
    assert all(math.hypot(*p) * math.cos(math.pi / 8) == pytest.approx(10.0) for p in hub)


def test_the_papers_strip_asks_little(
    record: Recorder, designs: dict[str, Path], record_property: pytest.RecordProperty
) -> None:
    """L = 100, eta = 0.5: a script that finds voxels one by one makes 67 000 findAt and as many section assignments."""
    model = record.build(designs["hemisphere"], "geometry")
    assert read_json(designs["hemisphere"] / "design.json")["summary"]["voxels_per_spoke"] == 67000
    record_property("calls", len(model.run.calls))
    print(f"\n{len(model.run.calls)} calls, {model.count('getByBoundingBox')} getByBoundingBox")
    assert len(model.run.calls) < 10_000
    assert model.count("findAt") == 0
    assert model.count("SectionAssignment") == 2
    assert model.count("milestone") == 17
    # Slices, layers and columns once each; two ends and the mid-line.
    assert model.count("getByBoundingBox") == 200 + 4 + 122 + 3


@pytest.mark.parametrize("name", ["held", "centred", "through", "odd", "coupon"])
def test_both_ways_find_the_same_cells(record: Recorder, designs: dict[str, Path], name: str) -> None:
    def sets(model: Model) -> list[dict]:
        return [of for path, of in model.run.calls if path.endswith("parts['SPOKE'].Set")]

    planes = record.build(designs[name], "geometry", find="planes")
    runs = record.build(designs[name], "geometry", find="runs")
    assert sets(planes) == sets(runs)
    auto = record.build(designs[name], "geometry")
    least = min(planes.count("getByBoundingBox"), runs.count("getByBoundingBox"))
    assert auto.count("getByBoundingBox") == least
    if name == "coupon":
        # Three runs along the whole strip.
        assert runs.count("getByBoundingBox") < planes.count("getByBoundingBox")


def test_the_mesh_is_the_deck(record: Recorder, designs: dict[str, Path]) -> None:
    folder = designs["three_phases"]
    document = read_json(folder / "design.json")
    model = record.build(folder, "mesh")
    (imported,) = model.called("ModelFromInputFile")
    assert imported["inputFileName"] == str(folder / "abaqus" / "voxel_solid.inp")
    sets = model.sets("SPOKE")
    for phase, count in document["summary"]["voxels"].items():
        assert sets[f"PHASE-{phase}"] == ("elements", 8 * count)


def test_the_job_has_the_users_cores_and_memory(record: Recorder, designs: dict[str, Path]) -> None:
    model = record.build(designs["held"], "geometry", cores=6, memory=12, memory_unit="gb", job="my-job")
    (job,) = model.called("Job")
    assert (job["name"], job["numCpus"], job["numDomains"]) == ("my-job", 6, 6)
    assert (job["memory"], job["memoryUnits"]) == (12, "GIGA_BYTES")


def test_outputs_hold_what_the_extraction_reads(record: Recorder, designs: dict[str, Path]) -> None:
    for kind, midline, references in (("geometry", "MIDLINE", 2), ("shell", "MIDLINE-1", 17)):
        model = record.build(designs["held"], kind)
        (field,) = model.called("FieldOutputRequest")
        assert "U" in field["variables"]
        history = model.called("HistoryOutputRequest")
        assert len(history) == references + 1 and history[0]["region"].endswith(f"sets['{midline}']")
        for of in history[1:]:
            assert {"U1", "U2", "RF1", "RF3", "RM2"} <= set(of["variables"]) and of["useGlobal"] == "OFF"
        # What CAE asks for by itself is gone.
        requests = model.run.actions[0]["after"][model.name]
        assert requests["fieldOutputRequests"] == ["VOXELASTICA-FIELD"]
        assert all(name.startswith("VOXELASTICA-") for name in requests["historyOutputRequests"])


@pytest.mark.parametrize("method", ["setSweepPath", "generateMesh"])
def test_a_spoke_that_is_not_swept_is_structured(record: Recorder, designs: dict[str, Path], method: str) -> None:
    """CAE refuses the sweep path, or the swept mesh ignores the seeds."""
    path = str(designs["held"] / "design.json")
    if method == "setSweepPath":
        fault = {"do": "fail", "method": ["MeshPart", method]}
    else:
        fault = {"do": "coarse"}
    run = record(fault, {"do": "build", "design": path, "options": {"kind": "shell"}})
    assert "error" not in run.actions[1], run.actions[1]
    assert "its mesh is structured" in run.out
    controls = [of["technique"] for of in Model(run, "held-shell").called("setMeshControls")]
    assert controls == ["SWEEP", "STRUCTURED"]
    assert Model(run, "held-shell").count("deleteMesh") == (method == "generateMesh")
