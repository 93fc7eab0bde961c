"""What `design` writes, read by other programs."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import jsonschema
import meshio
import numpy as np
import pytest
from conftest import EXAMPLES, design, read_json, run
from decks.keywords import check_deck, parse_deck

PROFILE = "s_mm,theta_deg,x_mm,z_mm,rho_mm,width_mm,modulus_ratio,modulus_mpa,rigid_fraction"

SMALL = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 6
length_mm = 20.0
hub_radius_mm = 3.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
pattern = "{pattern}"
[decks]
style = "{style}"
"""
#: Decks beside the morph that are written where they are asked for.
UNDER_LOAD = ["graded_shell_indentation", "graded_solid_indentation", "voxel_shell_indentation"]


def table(path: Path) -> tuple[list[str], np.ndarray]:
    with path.open(encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0], np.array([[float(cell) for cell in row] for row in rows[1:]])


def test_every_example_has_its_files_and_consistent_figures(examples: dict[str, Path]) -> None:
    assert len(examples) >= 12
    for name, folder in examples.items():
        document = read_json(folder / "design.json")
        assert document["schema"] == "voxelastica/design/1"
        for file in document["files"]:
            assert (folder / file).is_file(), f"{name}: {file}"
        header, profile = table(folder / "profile.csv")
        assert ",".join(header) == PROFILE
        assert len(profile) >= 201
        steps = np.diff(profile[:, 0])
        assert np.allclose(steps, steps[0])
        header, slices = table(folder / "slices.csv")
        assert header[:5] == ["slice", "s_mm", "width_voxels", "layers", "voxels"]
        summary = document["summary"]
        for phase, count in summary["voxels"].items():
            assert slices[:, header.index(f"count_{phase}")].sum() == count
        volume = summary["volume_mm3"]
        assert volume["spoke_voxels"] == pytest.approx(
            slices[:, 4].sum() * document["design"]["voxels"]["size_mm"] ** 3
        )
        assert summary["contrast"] == pytest.approx(profile[:, 7].max() / profile[:, 7].min(), rel=1e-3)


def test_the_modulus_expression_is_python_and_gives_the_profile(examples: dict[str, Path]) -> None:
    import math

    for name, folder in examples.items():
        field = read_json(folder / "design.json")["modulus_field"]
        assert field["variable"] == "X" and field["unit"] == "MPa"
        _, profile = table(folder / "profile.csv")
        for row in profile[::20]:
            value = eval(field["expression"], {"__builtins__": {}, **vars(math)}, {"X": row[0]})
            assert value > 0
            assert abs(value / row[7] - 1) <= field["max_error_percent"] / 100 + 1e-6, name
        assert field["max_error_percent"] < 0.5, name


def test_every_deck_obeys_the_keyword_reference(examples: dict[str, Path]) -> None:
    checked = 0
    for name, folder in examples.items():
        for deck in sorted(folder.glob("*/*.inp")):
            if deck.stat().st_size > 12_000_000:
                continue
            dialect = "calculix" if deck.parent.name == "calculix" else "abaqus"
            assert check_deck(deck, dialect=dialect) == [], f"{name}/{deck.parent.name}/{deck.name}"
            checked += 1
    assert checked >= 20


@pytest.mark.parametrize("pattern", ["random", "one-edge"])
@pytest.mark.parametrize("style", ["parts", "flat"])
def test_small_decks_obey_the_reference_and_agree_with_the_design(
    program: Path, tmp_path: Path, style: str, pattern: str
) -> None:
    folder = design(SMALL.format(style=style, pattern=pattern), tmp_path)
    document = read_json(folder / "design.json")
    decks = sorted(folder.glob("*/*.inp"))
    assert len(decks) == 6
    for path in decks:
        dialect = "calculix" if path.parent.name == "calculix" else "abaqus"
        assert check_deck(path, dialect=dialect) == [], path
        deck = parse_deck(path)
        if path.name == "voxel_solid.inp":
            edge = 1 if dialect == "calculix" else 2
            for phase, count in document["summary"]["voxels"].items():
                prefix = "" if deck.flat else "SPOKE-1."
                assert len(deck.elset(f"{prefix}PHASE-{phase}")) == count * edge**3
        if path.name == "voxel_shell.inp":
            per_spoke = document["summary"]["voxels_per_spoke"] / document["summary"]["lattice"]["layers"]
            assert len(list(deck.elements())) == 6 * per_spoke
        if "solid" in path.name:
            midline = np.array(deck.points("MIDLINE"))
            assert midline[0][0] == 0 and midline[-1][0] == 20
            assert np.all(np.diff(midline[:, 0]) > 0)
            assert np.allclose(midline[:, 1:], 0)


@pytest.mark.parametrize("extra", ["", '[indentation]\nindenter = "hub"\n', '[thrust]\nhub = "held"\n'])
@pytest.mark.parametrize("style", ["parts", "flat"])
def test_decks_under_load_obey_the_reference(program: Path, tmp_path: Path, style: str, extra: str) -> None:
    text = SMALL.format(style=style, pattern="random") + f"write = {json.dumps(UNDER_LOAD)}\n{extra}"
    folder = design(text, tmp_path)
    decks = sorted(folder.glob("*/*.inp"))
    assert [path.stem for path in decks] == sorted(UNDER_LOAD, key=lambda name: ("solid" in name, name))
    for path in decks:
        dialect = "calculix" if path.parent.name == "calculix" else "abaqus"
        assert check_deck(path, dialect=dialect) == [], path
        deck = parse_deck(path)
        assert len(deck.steps) == 2
        explicit = [step.explicit for step in deck.steps]
        assert explicit == [path.name.startswith("voxel_shell")] * 2, path


def test_meshio_reads_flat_decks_with_the_same_nodes_elements_and_sets(program: Path, tmp_path: Path) -> None:
    folder = design(SMALL.format(style="flat", pattern="random"), tmp_path)
    for path in sorted(folder.glob("*/*.inp")):
        ours = parse_deck(path)
        mesh = meshio.read(path, file_format="abaqus")
        assert len(mesh.points) == len(ours.root.node_ids)
        kind = "quad" if "shell" in path.name else "hexahedron"
        assert sum(len(block.data) for block in mesh.cells if block.type == kind) == len(list(ours.elements()))
        assert {block.type for block in mesh.cells} == {kind}
        numbers = sorted(ours.root.node_ids)
        place = {number: i for i, number in enumerate(numbers)}
        coordinates = np.array([ours.point((None, number)) for number in numbers])
        assert np.allclose(mesh.points, coordinates, atol=1e-9), path.name
        wanted = np.array([[place[node] for _, node in nodes] for _, _, nodes in ours.elements()])
        read = np.concatenate([block.data for block in mesh.cells])
        assert np.array_equal(read[np.lexsort(read.T)], wanted[np.lexsort(wanted.T)]), path.name
        names = {name.upper(): members for name, members in mesh.point_sets.items()}
        midline = "MIDLINE-1" if "shell" in path.name else "MIDLINE"
        for name in [midline, midline.replace("MIDLINE", "RIM"), midline.replace("MIDLINE", "HUB")]:
            assert sorted(names[name]) == sorted(place[node] for _, node in ours.nset(name)), f"{path.name}: {name}"
        cells = {name.upper(): sum(len(part) for part in parts) for name, parts in mesh.cell_sets.items()}
        compared = [name for name in cells if name.startswith(("PHASE-", "SLICE-", "SPOKE"))]
        for name in compared:
            assert cells[name] == len(ours.elset(name)), f"{path.name}: {name}"
        assert compared, path.name


def test_the_schema_accepts_every_example_and_refuses_an_unknown_key(program: Path) -> None:
    tomllib = pytest.importorskip("tomllib")
    schema = json.loads(run("schema").out)
    jsonschema.Draft202012Validator.check_schema(schema)
    for file in EXAMPLES.glob("*.toml"):
        jsonschema.validate(tomllib.loads(file.read_text(encoding="utf-8")), schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"target": {"kind": "hemi-ellipsoid"}, "strip": {}}, schema)


def test_the_same_design_gives_the_same_bytes_also_from_its_own_result(program: Path, tmp_path: Path) -> None:
    first = design(SMALL.format(style="parts", pattern="random"), tmp_path, "one")
    second = tmp_path / "again"
    assert run("design", tmp_path / "one.toml", "-o", second).code == 0
    third = tmp_path / "from-json"
    assert run("design", first / "design.json", "-o", third).code == 0
    for path in sorted(p for p in first.rglob("*") if p.is_file()):
        relative = path.relative_to(first)
        assert path.read_bytes() == (second / relative).read_bytes(), relative
        assert path.read_bytes() == (third / relative).read_bytes(), relative
    other = design(
        SMALL.format(style="parts", pattern="random").replace("[voxels]", "[voxels]\nseed = 2"), tmp_path, "two"
    )
    hashes = [read_json(folder / "design.json")["provenance"]["design_sha256"] for folder in (first, other)]
    assert hashes[0] != hashes[1]


@pytest.mark.parametrize("name", ["mesh", "points", "rectangular_2"])
def test_a_result_can_be_computed_again_without_the_files_it_came_from(
    examples: dict[str, Path], tmp_path: Path, name: str
) -> None:
    alone = tmp_path / "design.json"
    alone.write_bytes((examples[name] / "design.json").read_bytes())
    assert run("design", alone, "-o", tmp_path / "again").code == 0
    for file in ["design.json", "profile.csv", "slices.csv", "calculix/graded_solid.inp"]:
        assert (tmp_path / "again" / file).read_bytes() == (examples[name] / file).read_bytes(), file


def test_spelling_out_a_default_changes_nothing(program: Path, tmp_path: Path) -> None:
    short = SMALL.format(style="parts", pattern="random")
    spelt = short + '[thrust]\nhub = "free"\nchoice = "equal-ends"\n'
    folders = [design(text, tmp_path, name) for name, text in [("a", short), ("b", spelt)]]
    designs = [read_json(folder / "design.json")["design"] for folder in folders]
    assert designs[0]["thrust"] == {"hub": "free", "choice": "equal-ends"}
    assert {**designs[0], "name": ""} == {**designs[1], "name": ""}


def test_every_text_file_says_where_it_comes_from(examples: dict[str, Path]) -> None:
    folder = examples["hemisphere"]
    sha = read_json(folder / "design.json")["provenance"]["design_sha256"]
    for path in [*folder.glob("*/*.inp"), folder / "report.html"]:
        text = path.read_text(encoding="utf-8")
        assert sha in (text[:8192] if path.suffix == ".inp" else text), path.name
