"""Bad input: each its exit code, a message that names file, key and value, and nothing half-written."""

from __future__ import annotations

import math
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, design, read_json, run

GOOD = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 20.0
hub_radius_mm = 4.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
"""

POINTS = GOOD.replace('kind = "hemi-ellipsoid"', 'kind = "points"\nfile = "meridian.csv"')
MESH = GOOD.replace('kind = "hemi-ellipsoid"', 'kind = "mesh"\nfile = "dome.obj"')


def fails(folder: Path, text: str, code: int, *words: str) -> str:
    """Designs a text and expects an exit code, words in the message, and no output."""
    file = folder / "bad.toml"
    file.write_text(text, encoding="utf-8")
    out = folder / "out"
    result = run("design", file, "-o", out)
    assert result.code == code, (result.code, result.err)
    for word in words:
        assert word in result.err, (word, result.err)
    assert result.err.startswith("error: ")
    assert not out.exists(), list(out.rglob("*"))
    return result.err


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("count = 8", "cuont = 8", ["bad.toml:5", "strips.cuont", "unknown key", '"count"']),
        ("[target]", "[target", ["bad.toml:2", "not TOML"]),
        ("count = 8", "count = 2", ["strips.count = 2", "between 3"]),
        ("length_mm = 20.0", "length_mm = -1", ["strips.length_mm = -1"]),
        ("length_mm = 20.0", "length_mm = inf", ["strips.length_mm = inf", "finite"]),
        ("hub_radius_mm = 4.0", "hub_radius_mm = 0", ["strips.hub_radius_mm = 0", "greater than 0"]),
        ("size_mm = 1.0", "size_mm = 0.3", ["voxels.size_mm = 0.3", "nearest size that does is"]),
        ("size_mm = 1.0", "size_mm = 5.0", ["less than one voxel"]),
        ("FLX9070", "FLX907", ["materials.phases", '"FLX907"', 'did you mean "FLX9070"']),
        ('"FLX9070", "FLX9095"', '"FLX9095", "FLX9070"', ["softest to the stiffest", "swap"]),
        ("size_mm = 1.0", "size_mm = 0.001", ["voxels.size_mm", "limit", "--yes"]),
    ],
)
def test_wrong_design_files(program: Path, tmp_path: Path, old: str, new: str, words: list[str]) -> None:
    assert old in GOOD
    fails(tmp_path, GOOD.replace(old, new, 1), 2, *words)


def test_missing_files_are_named(program: Path, tmp_path: Path) -> None:
    result = run("design", tmp_path / "nowhere.toml")
    assert result.code == 2 and "nowhere.toml" in result.err and "no such file" in result.err
    fails(tmp_path, POINTS, 2, "target.file", "meridian.csv", "no such file")
    fails(tmp_path, MESH, 2, "target.file", "dome.obj", "no such file")
    assert run("design").code == 2
    assert run("desing", "x.toml").code == 2


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("rho,z\n10,0\n9,x\n8,2\n7,3\n6,4\n5,5\n", ["meridian.csv", "line 3", "x"]),
        ("rho,z\n10,0\n9,nan\n8,2\n7,3\n6,4\n5,5\n", ["meridian.csv", "line 3", "NaN"]),
        ("rho,z\n10,0\n9,1,1\n8,2\n7,3\n6,4\n5,5\n", ["meridian.csv", "line 3"]),
        ("rho,z\n10,0\n9,1\n", ["meridian.csv", "point(s)"]),
        ("", ["meridian.csv"]),
        ("rho,z\n10,0\n9,1\n9.9,0.2\n7,3\n6,4\n5,5\n4,6\n2,7\n", ["meridian.csv", "doubles back at line"]),
        ("rho,z\n10,0\n5,0\n5,5\n8,5\n8,-3\n4,-3\n3,-3\n1,-3\n", ["meridian.csv", "cross"]),
    ],
)
def test_wrong_meridians(program: Path, tmp_path: Path, rows: str, words: list[str]) -> None:
    (tmp_path / "meridian.csv").write_text(rows, encoding="utf-8")
    fails(tmp_path, POINTS, 2, "target.file", *words)


def dome(stretch: float = 1.0, rings: int = 12, segments: int = 24) -> str:
    """A hemisphere as OBJ, stretched along x."""
    lines = []
    for i in range(rings):
        q = math.pi / 2 * i / rings
        for k in range(segments):
            f = 2 * math.pi * k / segments
            lines.append(f"v {stretch * math.cos(q) * math.cos(f)} {math.cos(q) * math.sin(f)} {math.sin(q)}")
    lines.append("v 0 0 1")
    for i in range(rings - 1):
        for k in range(segments):
            a, b = i * segments + k + 1, i * segments + (k + 1) % segments + 1
            lines.append(f"f {a} {b} {b + segments} {a + segments}")
    top = rings * segments + 1
    last = (rings - 1) * segments
    lines += [f"f {last + k + 1} {last + (k + 1) % segments + 1} {top}" for k in range(segments)]
    return "\n".join(lines) + "\n"


def test_a_mesh_of_revolution_is_taken_and_a_stretched_one_refused_with_its_figure(
    program: Path, tmp_path: Path
) -> None:
    (tmp_path / "dome.obj").write_text(dome(), encoding="utf-8")
    out = design(MESH, tmp_path)
    summary = read_json(out / "design.json")["summary"]
    assert summary["rim_angle_deg"] == pytest.approx(90, abs=0.2)
    (tmp_path / "dome.obj").write_text(dome(1.2), encoding="utf-8")
    fails(tmp_path, MESH, 2, "target.file", "dome.obj", "% of the rim radius", "2 %")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", ["dome.obj"]),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", ["triangle"]),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", ["dome.obj"]),
        ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ["dome.obj"]),
        ("not a mesh at all", ["dome.obj"]),
    ],
)
def test_wrong_meshes(program: Path, tmp_path: Path, content: str, words: list[str]) -> None:
    (tmp_path / "dome.obj").write_text(content, encoding="utf-8")
    fails(tmp_path, MESH, 2, "target.file", *words)


def test_a_huge_mesh_is_refused_before_it_is_read(program: Path, tmp_path: Path) -> None:
    with (tmp_path / "dome.obj").open("wb") as file:
        file.truncate(3 << 30)
    fails(tmp_path, MESH, 2, "target.file", "dome.obj", "more than the limit")


def test_a_mesh_of_unknown_format_is_refused(program: Path, tmp_path: Path) -> None:
    (tmp_path / "dome.ply").write_text("ply", encoding="utf-8")
    fails(tmp_path, MESH.replace("dome.obj", "dome.ply"), 2, "target.file", ".ply", ".stl")


def test_a_straight_meridian_is_infeasible(program: Path, tmp_path: Path) -> None:
    polynomial = 'kind = "inclination-polynomial"\ncoefficients_deg = [30.0]'
    fails(tmp_path, GOOD.replace('kind = "hemi-ellipsoid"', polynomial), 3, "straight")


@pytest.mark.parametrize(
    ("coefficients", "thrust", "words"),
    [
        ("[300.0, -450.0, 180.0, 0.0]", "", ["2 inflections", "held"]),
        ("[-600.0, 1120.0, -672.0, 153.6, 0.0]", 'hub = "held"', ["3 inflections", "at most 2"]),
        ("[100.0, -150.0, 75.0, 0.0]", "", ["touches zero", "s = "]),
        ("[-20.0, 170.0]", "", ["strips.hub_radius_mm", "radius is"]),
    ],
)
def test_infeasible_shapes(program: Path, tmp_path: Path, coefficients: str, thrust: str, words: list[str]) -> None:
    target = f'kind = "inclination-polynomial"\ncoefficients_deg = {coefficients}'
    text = GOOD.replace('kind = "hemi-ellipsoid"', target)
    if thrust:
        text += f"[thrust]\n{thrust}\n"
    fails(tmp_path, text, 3, *words)


def test_a_contrast_out_of_reach_says_by_how_much_and_what_would_help(program: Path, tmp_path: Path) -> None:
    target = (
        'kind = "inclination-polynomial"\ncoefficients_deg = [26.52, -116.3, 162.3, -132.0, 63.5, -47.14, 18.64, 41.56]'
    )
    text = GOOD.replace('kind = "hemi-ellipsoid"', target).replace("count = 8", "count = 12")
    text = text.replace("hub_radius_mm = 4.0", "hub_radius_mm = 1.0")
    fails(tmp_path, text, 3, "bad.toml: materials.phases", "6.313", "4.065", "held hub", "1.930")


def test_a_modulus_of_mixed_sign_says_where(program: Path, tmp_path: Path) -> None:
    target = 'kind = "inclination-polynomial"\ncoefficients_deg = [-165.0, 90.0]'
    text = GOOD.replace('kind = "hemi-ellipsoid"', target)
    fails(tmp_path, text, 3, "bad.toml: target", "negative", "from s = 0.000 mm to s = 2.360 mm", "least-contrast")


def as_nobody() -> tuple[str, ...]:
    """A prefix that gives up root's rights, where this is root."""
    if os.geteuid() != 0:
        return ()
    if not shutil.which("setpriv"):
        pytest.skip("setpriv is not installed")
    return ("setpriv", "--reuid=65534", "--regid=65534", "--clear-groups")


def test_a_folder_without_rights_is_named(program: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    # The path must be open to somebody else, which pytest's own folders are not.
    base = Path("/tmp") / f"voxelastica-rights-{os.getpid()}"
    base.mkdir(mode=0o755)
    try:
        (base / "good.toml").write_text(GOOD, encoding="utf-8")
        copied = base / "voxelastica"
        shutil.copy(PROGRAM, copied)
        copied.chmod(0o755)
        locked = base / "locked"
        locked.mkdir(mode=0o555)
        command = [*as_nobody(), str(copied), "design", str(base / "good.toml"), "-o", str(locked / "out")]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=60)
        assert done.returncode == 5, done.stderr
        assert "locked" in done.stderr and "permission" in done.stderr
        assert list(locked.iterdir()) == []
    finally:
        shutil.rmtree(base)


def test_a_file_in_the_folders_place_is_named_and_kept(program: Path, tmp_path: Path) -> None:
    (tmp_path / "good.toml").write_text(GOOD, encoding="utf-8")
    blocked = tmp_path / "blocked"
    blocked.write_text("mine", encoding="utf-8")
    result = run("design", tmp_path / "good.toml", "-o", blocked / "out")
    assert result.code == 5 and "blocked" in result.err
    assert blocked.read_text(encoding="utf-8") == "mine"


@pytest.fixture
def small_disk(tmp_path: Path):
    """A disk of one megabyte."""
    if os.geteuid() != 0:
        pytest.skip("only root can mount a small disk")
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(disk)], check=False, capture_output=True
    )
    if mounted.returncode != 0:
        pytest.skip("a tmpfs cannot be mounted here")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


def test_a_full_disk_is_foreseen_and_when_it_fills_up_leaves_what_was_there(
    program: Path, small_disk: Path, tmp_path: Path
) -> None:
    (tmp_path / "good.toml").write_text(GOOD, encoding="utf-8")
    out = small_disk / "out"
    foreseen = run("design", tmp_path / "good.toml", "-o", out)
    assert foreseen.code == 5 and "MB" in foreseen.err and "--yes" in foreseen.err
    assert not out.exists()
    out.mkdir()
    (out / "design.json").write_text("{}", encoding="utf-8")
    insisted = run("design", tmp_path / "good.toml", "-o", out, "--yes")
    assert insisted.code == 5 and "disk is full" in insisted.err, insisted.err
    assert [p.name for p in out.rglob("*")] == ["design.json"]
    assert (out / "design.json").read_text(encoding="utf-8") == "{}"


def test_an_interrupt_leaves_nothing_behind(program: Path, tmp_path: Path) -> None:
    text = GOOD.replace("length_mm = 20.0", "length_mm = 100.0").replace("hub_radius_mm = 4.0", "hub_radius_mm = 10.0")
    file = tmp_path / "large.toml"
    file.write_text(text.replace("size_mm = 1.0", "size_mm = 0.1"), encoding="utf-8")
    out = tmp_path / "out"
    process = subprocess.Popen([PROGRAM, "design", file, "-o", out], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not list(out.rglob("*.tmp")) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert "cancelled" in err
    assert not out.exists()


def test_an_earlier_design_is_replaced_and_strangers_are_left_alone(program: Path, tmp_path: Path) -> None:
    out = design(GOOD, tmp_path)
    (out / "notes.txt").write_text("mine", encoding="utf-8")
    (out / "abaqus" / "mine.inp").write_text("mine", encoding="utf-8")
    design(GOOD + '[decks]\nwrite = ["graded_solid"]\nsolvers = ["calculix"]\n', tmp_path)
    left = sorted(str(p.relative_to(out)) for p in out.rglob("*") if p.is_file())
    assert left == [
        "abaqus/mine.inp",
        "calculix/graded_solid.inp",
        "design.json",
        "notes.txt",
        "profile.csv",
        "report.html",
        "slices.csv",
    ]
    assert read_json(out / "design.json")["design"]["decks"]["solvers"] == ["calculix"]
