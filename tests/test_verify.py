"""`verify` with the real CalculiX, and with solvers that are missing or fail."""

from __future__ import annotations

import math
import os
import subprocess
from pathlib import Path

import meshio
import numpy as np
import pytest
from conftest import EXAMPLES, design, read_json, run

STRIP = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = {length}
hub_radius_mm = {hub}
thickness_mm = 2.0
[thrust]
hub = "{support}"
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = {size}
[decks]
solvers = ["calculix"]
"""

GRADED = ("--solver", "ccx", "--model", "graded")

long = pytest.mark.skipif(not os.environ.get("VOXELASTICA_LONG"), reason="a long run: scripts/test --long")


def verified(folder: Path, *options: object, limit: float) -> dict:
    """Verifies a design and returns the figures, which must be within a limit (percent of the length)."""
    result = run("verify", folder, *options, "--target-error", limit)
    assert result.code == 0, result.err
    figures = read_json(folder / "verification.json")
    print(folder.name, {key: value for key, value in figures.items() if key != "midline_mm"})
    assert figures["max_error_percent"] <= limit
    assert figures["rms_error_percent"] <= figures["max_error_percent"]
    name = "CalculiX" if "ccx" in options else "embedded"
    assert figures["solver"]["name"] == name and figures["solver"]["version"]
    assert figures["version"] and figures["seed"] == 1
    assert figures["design_sha256"] == read_json(folder / "design.json")["provenance"]["design_sha256"]
    assert "<svg" in (folder / "verification.svg").read_text(encoding="utf-8")
    return figures


def test_a_graded_hemisphere_morphs_into_the_target(ccx: str, examples: dict[str, Path]) -> None:
    figures = verified(examples["hemisphere"], *GRADED, limit=0.5)
    midline = figures["midline_mm"]
    assert midline[0][1:] == pytest.approx([0, 0], abs=1e-6)
    assert midline[-1][1] == pytest.approx(63.66198, abs=1e-3)


def test_a_held_uniform_hemisphere_morphs_into_the_target(ccx: str, tmp_path: Path) -> None:
    folder = design(STRIP.format(length=100.0, hub=10.0, support="held", size=1.0), tmp_path)
    assert read_json(folder / "design.json")["summary"]["contrast"] == pytest.approx(1, abs=1e-6)
    verified(folder, *GRADED, limit=0.5)


def test_a_voxel_hemisphere_strip_morphs_into_the_target(ccx: str, tmp_path: Path) -> None:
    folder = design(STRIP.format(length=40.0, hub=4.0, support="free", size=1.0), tmp_path)
    ours = verified(folder, limit=1.5)
    theirs = verified(folder, "--solver", "ccx", limit=1.5)
    # The same mesh: every point of the mid-line within 0.05 % of the length.
    for here, there in zip(ours["midline_mm"], theirs["midline_mm"], strict=True):
        assert math.dist(here, there) < 0.0005 * 40.0


@long
@pytest.mark.parametrize("name", ["nose_cone", "trumpet", "roof"])
def test_the_papers_other_shapes_morph_into_their_targets(ccx: str, examples: dict[str, Path], name: str) -> None:
    verified(examples[name], *GRADED, limit=0.5)


@long
@pytest.mark.parametrize("name", ["rectangular_0.5", "rectangular_1", "rectangular_2"])
def test_clamped_strips_take_the_elasticas_shape(ccx: str, examples: dict[str, Path], name: str) -> None:
    verified(examples[name], *GRADED, limit=1.0)


@long
def test_free_standing_shapes_of_the_paper_with_a_pair_that_reaches_them(ccx: str, tmp_path: Path) -> None:
    pair = (
        '[[materials.custom]]\nname = "a"\nmodulus_mpa = 1.0\npoisson = 0.3\n'
        '[[materials.custom]]\nname = "b"\nmodulus_mpa = 12.0\npoisson = 0.3\n'
    )
    for name in ["nose_cone", "trumpet"]:
        text = (EXAMPLES / f"{name}.toml").read_text(encoding="utf-8")
        text = text.replace('hub = "held"', 'hub = "free"').replace('"FLX9070", "FLX9095"', '"a", "b"') + pair
        verified(design(text, tmp_path, name), *GRADED, limit=0.5)


def test_voxels_are_solved_inside_and_another_program_reads_them(program: Path, tmp_path: Path) -> None:
    """No deck, no solver installed: only design.json is needed."""
    folder = design(STRIP.format(length=20.0, hub=4.0, support="free", size=1.0) + "write = []\n", tmp_path)
    figures = verified(folder, limit=3.0)
    assert not figures["unstable_branch"] and figures["residual"] < 1e-6
    thrust = read_json(folder / "design.json")["summary"]["thrust"]["per_spoke"]["beam"]
    assert figures["reactions"]["rim_moment_nmm"] == pytest.approx(thrust["rim_moment_nmm"], rel=0.3)
    mesh = meshio.read(folder / "verification.vtu")
    cells = mesh.cells_dict["hexahedron"]
    assert len(cells) == read_json(folder / "design.json")["summary"]["voxels_per_spoke"]
    assert set(np.unique(mesh.cell_data["phase"][0])) == {0, 1}
    moved = mesh.points + mesh.point_data["displacement_mm"]
    # The mid-line of the file is that of the figures.
    middle = np.flatnonzero((mesh.points[:, 1] == 0) & (mesh.points[:, 2] == 0))
    middle = middle[np.argsort(mesh.points[middle, 0])]
    line = moved[middle] - moved[middle[0]]
    assert line[:, [0, 2]] == pytest.approx(np.array(figures["midline_mm"])[:, 1:], abs=1e-4)
    strain = np.max(mesh.cell_data["largest_principal_strain"][0])
    assert strain == pytest.approx(max(figures["largest_principal_strain"].values()), rel=1e-5)
    stress = mesh.cell_data["second_piola_kirchhoff_stress_mpa"][0]
    assert stress.shape == (len(cells), 6) and np.isfinite(stress).all()


def test_a_design_that_was_changed_by_hand_is_not_verified(program: Path, tmp_path: Path) -> None:
    folder = small(tmp_path)
    text = (folder / "design.json").read_text(encoding="utf-8")
    (folder / "design.json").write_text(text.replace('"seed": 1', '"seed": 2'), encoding="utf-8")
    result = run("verify", folder)
    assert result.code == 2 and "design again" in result.err, result.err


def test_a_refined_design_is_closer_and_is_computed_again(program: Path, tmp_path: Path) -> None:
    text = STRIP.format(length=20.0, hub=4.0, support="free", size=1.0)
    folder = design(text + "[refine]\niterations = 2\n", tmp_path)
    document = read_json(folder / "design.json")
    refined = document["summary"]["refinement"]
    assert refined["error_after_percent"] < refined["error_before_percent"]
    assert "Refined error" in (folder / "report.html").read_text(encoding="utf-8")
    figures = verified(folder, limit=5.0)
    assert figures["max_error_percent"] == pytest.approx(refined["error_after_percent"], abs=1e-3)
    # From its own record, without solving, to the last byte; another seed is another design.
    again = tmp_path / "again"
    assert run("design", folder / "design.json", "-o", again).code == 0
    for name in ["design.json", "slices.csv", "calculix/voxel_solid.inp"]:
        assert (again / name).read_bytes() == (folder / name).read_bytes(), name
    plain = read_json(design(text, tmp_path, "plain") / "design.json")
    assert plain["provenance"]["design_sha256"] != document["provenance"]["design_sha256"]
    assert "refine" not in plain["design"] and "refinement" not in plain["summary"]


def small(tmp_path: Path) -> Path:
    return design(STRIP.format(length=20.0, hub=4.0, support="free", size=1.0), tmp_path)


def stand_in(tmp_path: Path, body: str) -> Path:
    """A program in the solver's place."""
    script = tmp_path / "fake-ccx"
    script.write_text("#!/bin/sh\nif [ \"$1\" = -v ]; then echo 'This is Version 9.99'; exit 0; fi\n" + body)
    script.chmod(0o755)
    return script


def test_a_missing_solver_says_what_would_help(program: Path, tmp_path: Path) -> None:
    folder = small(tmp_path)
    result = run("verify", folder, *GRADED, "--ccx", tmp_path / "nowhere")
    assert result.code == 4 and "not found" in result.err and "--ccx" in result.err
    assert not (folder / "verification.json").exists()


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("echo ' *ERROR in gen3dmodel: zero volume'; exit 201", ["code 201", "zero volume"]),
        ("echo ' *ERROR reading *STEP'; exit 0", ["reported an error", "*STEP"]),
        ("echo ok; echo ' 1 1 1 4 0.5 0.5 0.5' > job.sta; exit 0", ["50.0 % of the step"]),
        ("echo ok; echo ' 1 1 1 4 1.0 1.0 1.0' > job.sta; exit 0", ["result"]),
        (
            "echo ok; echo ' 1 1 1 4 1.0 1.0 1.0' > job.sta; echo 'garbage 1 2' > job.dat; exit 0",
            ["result"],
        ),
        ("kill -9 $$", ["killed"]),
    ],
)
def test_a_failing_solver_gives_its_last_lines_and_no_figures(
    program: Path, tmp_path: Path, body: str, words: list[str]
) -> None:
    folder = small(tmp_path)
    result = run("verify", folder, *GRADED, "--ccx", stand_in(tmp_path, body))
    assert result.code == 4, (result.code, result.err)
    for word in words:
        assert word in result.err, result.err
    assert not (folder / "verification.json").exists()


def test_what_an_earlier_run_left_behind_verifies_nothing(program: Path, tmp_path: Path) -> None:
    folder = small(tmp_path)
    keep = tmp_path / "kept"
    keep.mkdir()
    (keep / "job.sta").write_text(" 1 1 1 4 1.0 1.0 1.0\n", encoding="utf-8")
    (keep / "job.dat").write_text(" displacements (vx,vy,vz) for set MIDLINE and time  0.1000000E+01\n\n 1 0. 0. 0.\n")
    result = run("verify", folder, *GRADED, "--keep", keep, "--ccx", stand_in(tmp_path, "exit 0"))
    assert result.code == 4, (result.out, result.err)
    assert not (folder / "verification.json").exists()


def test_a_solver_may_be_named_by_a_relative_path(program: Path, tmp_path: Path) -> None:
    folder = small(tmp_path)
    stand_in(tmp_path, "echo ' *ERROR of the stand-in'; exit 201")
    result = run("verify", folder, *GRADED, "--ccx", "./fake-ccx", cwd=tmp_path)
    assert result.code == 4 and "stand-in" in result.err, result.err


def test_decks_of_another_design_are_not_verified(program: Path, tmp_path: Path) -> None:
    folder = small(tmp_path)
    deck = folder / "calculix" / "graded_solid.inp"
    sha = read_json(folder / "design.json")["provenance"]["design_sha256"]
    deck.write_text(deck.read_text(encoding="utf-8").replace(sha, "0" * 64), encoding="utf-8")
    result = run("verify", folder, *GRADED)
    assert result.code == 2 and "another design" in result.err
    deck.unlink()
    result = run("verify", folder, *GRADED)
    assert result.code == 2 and "not there" in result.err
    assert run("verify", tmp_path / "nowhere").code == 2


def test_a_coupon_has_no_shape_to_verify(program: Path, examples: dict[str, Path]) -> None:
    result = run("verify", examples["coupon_1"])
    assert result.code == 2 and "no shape" in result.err


def test_a_missed_target_error_has_its_own_exit_code(program: Path, tmp_path: Path) -> None:
    folder = small(tmp_path)
    result = run("verify", folder, "--target-error", "0.0001")
    assert result.code == 6 and "--target-error" in result.err
    assert (folder / "verification.json").exists()


@pytest.mark.parametrize("model", ["graded_solid", "voxel_solid"])
def test_the_coupons_decks_run_and_pull_between_the_bounds(
    ccx: str, examples: dict[str, Path], tmp_path: Path, model: str
) -> None:
    """A coupon of half soft and half rigid voxels, stretched by 1 %, between equal stress and equal strain."""
    deck = examples["coupon_1"] / "calculix" / f"{model}.inp"
    (tmp_path / "job.inp").write_bytes(deck.read_bytes())
    done = subprocess.run([ccx, "job"], cwd=tmp_path, capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stdout[-2000:]
    lines = (tmp_path / "job.dat").read_text(encoding="utf-8").splitlines()
    starts = [i for i, line in enumerate(lines) if "forces" in line and "RP-RIM and" in line and "total" not in line]
    pull = abs(float(lines[starts[-1] + 2].split()[1]))
    area_strain = 6 * 2 * 0.01
    soft, rigid = 3.1, 12.6
    voigt, reuss = (soft + rigid) / 2, 2 / (1 / soft + 1 / rigid)
    # Ends that cannot contract stiffen a coupon by a few percent.
    assert reuss * area_strain < pull < 1.05 * voigt * area_strain, pull
