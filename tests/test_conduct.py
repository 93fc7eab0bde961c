"""`conduct`: heat and current through a design's strip, its files, and what it refuses."""

from __future__ import annotations

import csv
import os
from pathlib import Path
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
from conftest import EXAMPLES, design, read_json, run

STRIP = """
[target]
kind = "strip"
width_mm = 6.0
{target}
[strips]
length_mm = 20.0
thickness_mm = 2.0
[materials]
phases = ["PI + 15 % graphite", "PLA + 30 % carbon fibre"]
[voxels]
size_mm = 1.0
pattern = "{pattern}"
[decks]
write = []
{more}
"""
CONDUCTIVITIES = {"heat": (0.3155, 2.01), "current": (1e-7, 2.86e-23)}

long = pytest.mark.skipif(not os.environ.get("VOXELASTICA_LONG"), reason="a long run: scripts/test --long")


def strip(target: str, folder: Path, name: str, pattern: str = "random", more: str = "") -> Path:
    return design(STRIP.format(target=target, pattern=pattern, more=more), folder, name)


def conduct(folder: Path, *options: object) -> dict:
    result = run("conduct", folder, *options)
    assert result.code == 0, result.err
    return read_json(folder / "conduct.json")


def rows(file: Path) -> tuple[list[str], list[dict[str, str]]]:
    """Comment lines and rows of a table."""
    lines = file.read_text(encoding="utf-8").splitlines()
    comments = [line for line in lines if line.startswith("#")]
    return comments, list(csv.DictReader(lines[len(comments) :]))


def test_pure_phases_have_their_own_conductivities(program: Path, tmp_path: Path) -> None:
    for phase, fraction in enumerate((0.0, 1.0)):
        folder = strip(f"rigid_fraction = {fraction}", tmp_path, f"pure{phase}")
        document = conduct(folder, "--heat-times", "10", "--current-times", "1e-4", "--no-vtu")
        for case in document["cases"]:
            exact = CONDUCTIVITIES[case["problem"]][phase]
            assert case["steady"]["effective_conductivity"] == pytest.approx(exact, rel=1e-4)
            by_time = case["transient"]["effective_conductivities"][-1]
            print(phase, case["problem"], case["transient"]["critical_times_s"], by_time)
            if case["problem"] == "heat":
                assert by_time == pytest.approx(exact, rel=1e-3)
            else:
                # One time constant, eps / sigma (0.3 ms or 29 000 years): the plateau to 0.1 % after ln(1000) of them.
                critical = case["transient"]["critical_times_s"][0]
                permittivity = (3.4, 3.0)[phase] * 8.8541878128e-12
                assert critical == pytest.approx(np.log(1000) * permittivity / exact, rel=1e-3)
                assert by_time == pytest.approx(exact, rel=2e-3)


@pytest.fixture(scope="module")
def composite(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    more = "[conduction]\ngraded_elements = [20, 6, 2]"
    folder = strip("modulus_ratio = 0.5\nshortening = 0.5", tmp_path_factory.mktemp("conduct"), "composite", more=more)
    conduct(folder, "--shape", "both", "--model", "both", "--ashby", "--time-tolerance", "1e-4")
    return folder


def test_every_case_is_between_the_pure_phases(composite: Path) -> None:
    document = read_json(composite / "conduct.json")
    assert document["schema"] == "voxelastica/conduction/1"
    assert document["design_sha256"] == read_json(composite / "design.json")["provenance"]["design_sha256"]
    assert len(document["cases"]) == 8
    for case in document["cases"]:
        steady = case["steady"]
        low, high = sorted(CONDUCTIVITIES[case["problem"]])
        assert low < steady["effective_conductivity"] < high
        assert steady["imbalance"] < 1e-5
        assert steady["series_bound"] * 0.9999 <= steady["effective_conductivity"] <= steady["parallel_bound"] * 1.0001
    flat = {case["model"]: case for case in document["cases"] if case["problem"] == "heat" and case["shape"] == "flat"}
    # Phases side by side conduct better than voxels that are not lined up.
    graded, voxel = (flat[m]["steady"]["effective_conductivity"] for m in ("graded", "voxel"))
    assert voxel < graded


def test_assumptions_are_marked_in_every_output(composite: Path) -> None:
    document = read_json(composite / "conduct.json")
    assert document["rests_on_assumptions"] is True
    assert {a["property"] for a in document["assumptions"]} == {"specific_heat_j_kgk", "relative_permittivity"}
    for name in document["files"]:
        text = (composite / name).read_text(encoding="utf-8")
        if "ashby" in name:
            continue
        assert "assum" in text.lower(), name
    assert "(assumed)" in (composite / "report.html").read_text(encoding="utf-8")


def test_tables_hold_what_the_document_says(composite: Path) -> None:
    document = read_json(composite / "conduct.json")
    comments, cases = rows(composite / "conduction" / "cases.csv")
    assert len(comments) == 4 and len(cases) == len(document["cases"])
    for row, case in zip(cases, document["cases"], strict=True):
        assert float(row["effective_by_flow"]) == pytest.approx(case["steady"]["effective_conductivity"], rel=1e-8)
    _, history = rows(composite / "conduction" / "heat_voxel_flat_history.csv")
    temperatures = [float(row["temperature_1_k"]) for row in history]
    assert temperatures[0] == pytest.approx(316.15) and temperatures[-1] > 393.07
    assert all(b >= a - 1e-2 for a, b in zip(temperatures, temperatures[1:], strict=False))
    _, profile = rows(composite / "conduction" / "heat_voxel_flat_profile.csv")
    assert len(profile) == 21
    assert float(profile[0]["temperature_steady_k"]) == pytest.approx(393.15)
    _, chart = rows(composite / "conduction" / "ashby_thermal.csv")
    mixtures = [row for row in chart if row["kind"] == "mixture"]
    assert len(mixtures) == 54
    assert all(0.3155 < float(row["conductivity_w_mk"]) < 2.01 for row in mixtures)


def test_fields_and_pictures_are_read_by_others(composite: Path) -> None:
    folder = composite / "conduction"
    mesh = meshio.read(folder / "heat_voxel_morphed.vtu")
    assert mesh.cells[0].type == "hexahedron" and len(mesh.cells[0].data) == 240
    field = mesh.point_data["temperature_K_steady"]
    assert field.min() == pytest.approx(316.15) and field.max() == pytest.approx(393.15)
    assert set(np.unique(mesh.cell_data["rigid_fraction"][0])) <= {0.0, 1.0}
    # Right-handed bricks of about their flat volume.
    p = mesh.points[mesh.cells[0].data]
    volume = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 3] - p[:, 0]), p[:, 4] - p[:, 0])
    assert (volume > 0.2).all() and volume.sum() == pytest.approx(240, rel=0.15)
    for svg in folder.glob("*.svg"):
        ElementTree.parse(svg)


def test_the_same_run_gives_the_same_bytes(program: Path, tmp_path: Path) -> None:
    folder = strip("modulus_ratio = 2.0", tmp_path, "twice")
    found = []
    for name in ("a", "b"):
        out = tmp_path / name
        assert run("conduct", folder, "--time-tolerance", "1e-3", "-o", out).code == 0
        found.append({f.relative_to(out): f.read_bytes() for f in sorted(out.rglob("*")) if f.is_file()})
    assert found[0] == found[1] and len(found[0]) > 8


def test_parameters_come_from_the_design_and_from_the_command_line(program: Path, tmp_path: Path) -> None:
    more = '[conduction]\nthreshold = 0.9\nthreshold_of = "rise"\nmeasure_at = [0.25, 1.0]\nheat_times_s = []'
    folder = strip("modulus_ratio = 2.0", tmp_path, "table", more=more)
    options = ("--flow", "heat", "--no-vtu", "--time-tolerance", "1e-4")
    document = conduct(folder, *options)
    assert document["parameters"]["measure_at"] == [0.25, 1.0]
    near, far = document["cases"][0]["transient"]["critical_times_s"]
    assert near < far
    later = conduct(folder, *options, "--threshold", "0.95")["cases"][0]["transient"]["critical_times_s"][1]
    assert later > far
    of_value = conduct(folder, *options, "--threshold-of", "value", "--threshold", "0.99")
    # 0.99 of 393.15 K is 0.94894 of the rise.
    assert of_value["cases"][0]["transient"]["critical_times_s"][1] == pytest.approx(later, rel=0.01)


def test_wrong_input_is_named(program: Path, tmp_path: Path) -> None:
    folder = strip("modulus_ratio = 2.0", tmp_path, "wrong")
    result = run("conduct", tmp_path)
    assert result.code == 2 and "design.json" in result.err
    result = run("conduct", folder, "--measure-at", "1.5")
    assert result.code == 2 and "measure_at" in result.err
    result = run("conduct", folder, "--current=-1")
    assert result.code == 2 and "current_a" in result.err
    result = run("conduct", folder, "--threshold", "0.5", "--threshold-of", "value")
    assert result.code == 2 and "conduction.threshold" in result.err
    result = run("conduct", folder, "--shape", "morphed")
    assert result.code == 2 and "stretched" in result.err
    assert not (folder / "conduct.json").exists()
    text = STRIP.format(target="modulus_ratio = 2.0", pattern="random", more="")
    text = text.replace("PI + 15 % graphite", "FLX9070").replace("PLA + 30 % carbon fibre", "FLX9095")
    result = run("conduct", design(text, tmp_path, "resins"))
    assert result.code == 2 and "conductivity_w_mk" in result.err and "FLX9070" in result.err


@long
def test_the_cases_of_the_paper(program: Path, tmp_path: Path) -> None:
    for file in sorted((EXAMPLES / "conduction").glob("*.toml")):
        folder = tmp_path / file.stem
        assert run("design", file, "-o", folder).code == 0
        shape = "both" if file.stem.startswith("hemisphere") else "flat"
        document = conduct(folder, "--shape", shape, "--no-vtu")
        for case in document["cases"]:
            low, high = sorted(CONDUCTIVITIES[case["problem"]])
            found = case["steady"]["effective_conductivity"]
            assert low * 0.999 <= found <= high * 1.001
            by_time = case["transient"]["effective_conductivities"][-1]
            print(
                f"{file.stem:32}{case['problem']:8}{case['shape']:8}{found:12.4e} {by_time} "
                f"{case['transient']['critical_times_s'][-1]}"
            )
