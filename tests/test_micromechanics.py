"""`micromechanics`, decks of heat and current, and NASTRAN meshes, read by other programs."""

from __future__ import annotations

import csv
import xml.etree.ElementTree as ET
from pathlib import Path

import meshio
import numpy as np
import pytest
from conftest import design, run
from decks.keywords import check_deck

CONDUCTING = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 12.0
hub_radius_mm = 3.0
thickness_mm = 2.0
[materials]
phases = ["PI", "PLA"]
[[materials.custom]]
name = "PI"
modulus_mpa = 3330.0
poisson = 0.3
density_kg_m3 = 1410.0
conductivity_w_mk = 0.3155
electrical_conductivity_s_m = 1e-7
specific_heat_j_kgk = 1100.0
[[materials.custom]]
name = "PLA"
modulus_mpa = 10200.0
poisson = 0.3
density_kg_m3 = 1270.0
conductivity_w_mk = 2.01
electrical_conductivity_s_m = 2.86e-23
specific_heat_j_kgk = 1200.0
[voxels]
size_mm = 1.0
[decks]
write = ["voxel_solid", "graded_solid", "voxel_heat", "graded_heat", "voxel_current", "graded_current"]
solvers = ["abaqus", "calculix", "nastran"]
style = "{style}"
"""


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_all_layouts_are_listed_between_their_bounds(program: Path, tmp_path: Path) -> None:
    result = run("micromechanics", "--phases", "FLX9070", "12.6:0.3", "-o", tmp_path / "out")
    assert result.code == 0, result.err
    assert "every modulus lies between Reuss and Voigt" in result.out
    table = rows(tmp_path / "out" / "unit_cells.csv")
    assert len(table) == 512
    assert len({row["layout"] for row in table}) == 512
    for row in table:
        for axis in "xyz":
            modulus = float(row[f"e{axis}_mpa"])
            assert float(row["reuss_mpa"]) * (1 - 1e-8) <= modulus <= float(row["voigt_mpa"]) * (1 + 1e-8), row
    multiplicities = {row["class"]: int(row["multiplicity"]) for row in table}
    assert len(multiplicities) == 102
    assert sum(multiplicities.values()) == 512
    for name in ("unit_cells_modulus.svg", "unit_cells_departure.svg"):
        texts = [e.text or "" for e in ET.parse(tmp_path / "out" / name).getroot().iter() if e.tag.endswith("text")]
        assert any("volume fraction" in text for text in texts)
    again = run("micromechanics", "--phases", "FLX9070", "12.6:0.3", "-o", tmp_path / "again")
    assert again.code == 0
    for file in sorted((tmp_path / "out").iterdir()):
        assert file.read_bytes() == (tmp_path / "again" / file.name).read_bytes()


def test_decks_of_a_layout_pass_the_checker(program: Path, tmp_path: Path) -> None:
    result = run("micromechanics", "--cell", "2x2x1", "--deck", "10/01", "-o", tmp_path)
    assert result.code == 0, result.err
    for axis in "xyz":
        for solver in ("abaqus", "calculix"):
            path = tmp_path / solver / f"unit_cell_10-01_{axis}.inp"
            assert check_deck(path, solver) == []
            mesh = meshio.read(path)
            assert sum(len(block.data) for block in mesh.cells) == 4 * 4 * 2


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("--phases", "FLX9070", "rubber"), "rubber"),
        (("--phases", "0:0.3", "FLX9070"), "must be positive"),
        (("--phases", "FLX9095", "FLX9070"), "soft phase first"),
        (("--phases", "FLX9070", "FLX9070"), "both phases"),
        (("--phases", "FLX9070", "5:0.5"), "0.499"),
        (("--deck", "1010"), "9 digits"),
        (("--design", "nowhere.toml"), "nowhere.toml"),
    ],
)
def test_wrong_requests_are_wrong_input(program: Path, tmp_path: Path, arguments: tuple, part: str) -> None:
    result = run("micromechanics", *arguments, "-o", tmp_path / "out")
    assert result.code == 2
    assert part in result.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("style", ["parts", "flat"])
def test_decks_of_heat_and_current_pass_the_checker(program: Path, tmp_path: Path, style: str) -> None:
    folder = design(CONDUCTING.format(style=style), tmp_path)
    written = {solver: {p.stem for p in (folder / solver).iterdir()} for solver in ("abaqus", "calculix", "nastran")}
    heat = {"voxel_heat", "graded_heat"}
    solids = {"voxel_solid", "graded_solid"}
    assert written["abaqus"] == solids | heat | {"voxel_current", "graded_current"}
    assert written["calculix"] == solids | heat
    assert written["nastran"] == solids | {"fractions"}
    for solver in ("abaqus", "calculix"):
        for name in sorted(written[solver]):
            assert check_deck(folder / solver / f"{name}.inp", solver) == [], f"{solver} {name}"


def test_nastran_meshes_are_those_of_the_decks(program: Path, tmp_path: Path) -> None:
    folder = design(CONDUCTING.format(style="flat"), tmp_path)
    for name in ("voxel_solid", "graded_solid"):
        mesh = meshio.read(folder / "nastran" / f"{name}.bdf", file_format="nastran")
        deck = meshio.read(folder / "calculix" / f"{name}.inp")
        assert [block.type for block in mesh.cells] == ["hexahedron"] * len(mesh.cells)
        bricks = np.concatenate([block.data for block in mesh.cells])
        # The decks have four reference nodes more.
        assert len(mesh.points) == len(deck.points) - 4
        assert np.allclose(mesh.points, deck.points[:-4], atol=1e-6)
        order = np.lexsort(bricks.T[::-1])
        expected = np.concatenate([block.data for block in deck.cells])
        assert np.array_equal(bricks[order], expected[np.lexsort(expected.T[::-1])])
        properties = np.concatenate(mesh.cell_data["nastran:ref"])
        if name == "voxel_solid":
            counts = [int(row["count_PLA"]) for row in rows(folder / "slices.csv")]
            assert np.count_nonzero(properties == 2) == sum(counts)
        else:
            assert sorted(set(properties)) == list(range(1, 81))
        text = (folder / "nastran" / f"{name}.bdf").read_text("ascii")
        assert all(len(line) <= 80 for line in text.splitlines())
        assert text.count("MAT1*") == text.count("PSOLID") == len(set(properties))
    table = rows(folder / "nastran" / "fractions.csv")
    assert len(table) == 201
    for row in table:
        soft, rigid = float(row["fraction_PI"]), float(row["fraction_PLA"])
        assert abs(soft + rigid - 1) < 1e-8
        assert abs(3330 * soft + 10200 * rigid - float(row["modulus_mpa"])) < 1e-4


def test_a_phase_that_does_not_conduct_is_named(program: Path, tmp_path: Path) -> None:
    text = CONDUCTING.format(style="flat").replace("conductivity_w_mk = 0.3155\n", "")
    (tmp_path / "wrong.toml").write_text(text, encoding="utf-8")
    result = run("design", tmp_path / "wrong.toml", "-o", tmp_path / "out")
    assert result.code == 2
    assert "decks.write" in result.err
    assert '"PI"' in result.err
    assert "conductivity_w_mk" in result.err
