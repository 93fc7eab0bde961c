"""`compare`: mid-lines of other solvers, and scans of domes anywhere in space."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from conftest import EXAMPLES, design, read_json, run

NOISE = 0.1

DOME = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 100.0
hub_radius_mm = 10.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = {size}
[decks]
write = []
"""

STRIP = """
[target]
kind = "strip"
width_mm = 12.0
rigid_fraction = 0.5
shortening = 0.3
[strips]
length_mm = 60.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
[decks]
write = []
"""


@pytest.fixture(scope="session")
def dome(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return design(DOME.format(size=1.0), tmp_path_factory.mktemp("compare"), "dome")


@pytest.fixture(scope="session")
def roof(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    text = (EXAMPLES / "roof.toml").read_text(encoding="utf-8").split("[decks]")[0]
    text = text.replace("size_mm = 0.5", "size_mm = 1.0") + "\n[decks]\nwrite = []\n"
    return design(text, tmp_path_factory.mktemp("compare"), "roof")


def profile(folder: Path) -> dict[str, np.ndarray]:
    """The columns of profile.csv."""
    with (folder / "profile.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def rotation(axis: tuple[float, float, float], degrees: float) -> np.ndarray:
    """The matrix of a rotation (Rodrigues)."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


def surface(folder: Path, spokes: int | None, count: int, seed: int, scale: float = 1.0) -> np.ndarray:
    """Random points of a dome in its own frame: of revolution, or of spokes that are straight across."""
    columns = profile(folder)
    random = np.random.default_rng(seed)
    s = random.uniform(0, columns["s_mm"][-1], 4 * count)
    rho, z = np.interp(s, columns["s_mm"], columns["rho_mm"]), np.interp(s, columns["s_mm"], columns["z_mm"])
    # As many points everywhere on the surface.
    keep = random.uniform(0, columns["rho_mm"].max(), len(s)) < rho
    rho, z = rho[keep][:count], scale * z[keep][:count]
    phi = random.uniform(0, 2 * np.pi, len(rho))
    if spokes:
        sector = 2 * np.pi / spokes
        rho = rho / np.cos(phi - sector * np.round(phi / sector))
    return np.stack([rho * np.cos(phi), rho * np.sin(phi), z], axis=1)


def missing(points: np.ndarray, share: float) -> np.ndarray:
    """The points without a wedge from rim to hub, which is what a scanner does not see."""
    phi = np.arctan2(points[:, 1], points[:, 0])
    return points[phi > -np.pi + 2 * np.pi * share]


def write(path: Path, header: str, rows: np.ndarray) -> Path:
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.6f")
    return path


def placed(record: dict, points: np.ndarray) -> np.ndarray:
    """The points where a placement lays them."""
    placement = record["placement"]
    turned = rotation(tuple(placement["rotation_axis"]), placement["rotation_angle_deg"])
    return points @ turned.T + np.array(placement["shift_mm"])


PLACES = [((0.3, -0.5, 0.8), 37.0), ((1.0, 0.2, 0.1), 173.0), ((-0.4, 0.9, -0.2), 98.0)]


@pytest.mark.parametrize("spokes", [None, 8])
@pytest.mark.parametrize(("axis", "degrees"), PLACES)
def test_a_noisy_turned_and_shifted_scan_with_a_fifth_missing_is_recovered(
    dome: Path, tmp_path: Path, spokes: int | None, axis: tuple[float, float, float], degrees: float
) -> None:
    clean = missing(surface(dome, spokes, 6000, seed=1), 0.2)
    turn, shift = rotation(axis, degrees), np.array([412.0, -87.5, 1033.0])
    noise = np.random.default_rng(2).normal(0, NOISE, clean.shape)
    scan = (clean + noise) @ turn.T + shift
    result = run("compare", dome, "--result", write(tmp_path / "scan.csv", "x_mm,y_mm,z_mm", scan))
    assert result.code == 0, result.err
    assert "best fit: turned by" in result.out and "scan.csv" in result.out
    record = read_json(dome / "comparison.json")
    assert record["surface"] == ("spokes" if spokes else "revolution")
    # Every point is back where it came from, but for turns that map the dome onto itself.
    back = placed(record["target"], (scan - noise @ turn.T))
    away = np.abs(np.hypot(back[:, 0], back[:, 1]) - np.hypot(clean[:, 0], clean[:, 1]))
    worst = max(away.max(), np.abs(back[:, 2] - clean[:, 2]).max())
    print(f"{spokes} {degrees}: worst point {worst:.4f} mm, meridian {record['max_error_percent']:.4f} % of L")
    assert worst < 0.2
    # The shape, too: L is 100 mm, so percent are mm.
    assert record["max_error_percent"] < 0.2 and record["rms_error_percent"] < 0.05
    assert record["target"]["points"]["rms_mm"] == pytest.approx(NOISE, rel=0.1)
    assert record["target"]["points"]["stray"] == 0
    assert record["target"]["placement"]["rotation_uncertainty_deg"] < 0.1
    assert "<svg" in (dome / "comparison.svg").read_text(encoding="utf-8")


def test_half_a_dome_and_a_single_spoke_find_their_place(dome: Path, tmp_path: Path) -> None:
    clean = surface(dome, 8, 16000, seed=7)
    phi = np.arctan2(clean[:, 1], clean[:, 0])
    noise = np.random.default_rng(8).normal(0, NOISE, clean.shape)
    for name, part in {"half": phi > 0, "spoke": np.abs(phi) < 0.38}.items():
        scan = (clean + noise)[part] @ rotation((1, 2, 3), 111.0).T + [50.0, 60.0, 70.0]
        result = run("compare", dome, "--result", write(tmp_path / f"{name}.csv", "x,y,z", scan))
        assert result.code == 0, result.err
        record = read_json(dome / "comparison.json")
        assert record["surface"] == "spokes", name
        # A single spoke slides along its width.
        assert ("leave the placement open" in result.err) == (name == "spoke"), (name, result.err)
        assert record["target"]["points"]["rms_mm"] == pytest.approx(NOISE, rel=0.15), (name, record["target"])


def test_the_dome_of_another_pattern_and_its_hub_and_the_table_below_are_told_apart(roof: Path, tmp_path: Path) -> None:
    columns = profile(roof)
    clean = surface(roof, 6, 8000, seed=3)
    random = np.random.default_rng(4)
    hub = np.zeros((500, 3))
    hub[:, :2] = random.uniform(-10, 10, (500, 2))
    hub[:, 2] = columns["z_mm"][-1]
    table = np.stack([random.uniform(-300, 300, 900), random.uniform(-300, 300, 900), np.full(900, -25.0)], axis=1)
    scan = np.concatenate([clean, hub, table])
    scan = (scan + random.normal(0, NOISE, scan.shape)) @ rotation((0.2, 1, 0.4), 64.0).T + [5.0, 6.0, 7.0]
    result = run("compare", roof, "--result", write(tmp_path / "scan.csv", "x,y,z", scan))
    assert result.code == 0, result.err
    record = read_json(roof / "comparison.json")
    points = record["target"]["points"]
    assert record["surface"] == "spokes"
    assert points["on_hub"] == pytest.approx(500, abs=40)
    assert points["stray"] == pytest.approx(900, abs=20)
    assert record["max_error_percent"] < 0.2, record["target"]
    assert "on the hub" in result.out and "tenth of the length" in result.out


def test_the_outer_face_lies_half_the_thickness_outside(dome: Path, tmp_path: Path) -> None:
    columns = profile(dome)
    theta = np.radians(columns["theta_deg"])
    outer = np.stack([columns["rho_mm"] + np.sin(theta), columns["z_mm"] + np.cos(theta) + 3.0], axis=1)
    file = write(tmp_path / "meridian.csv", "rho_mm,z_mm", outer)
    assert run("compare", dome, "--result", file, "--face", "outer").code == 0
    record = read_json(dome / "comparison.json")
    assert record["face"] == "outer" and record["max_error_percent"] < 0.02
    assert record["target"]["placement"]["shift_mm"] == pytest.approx([0, 0, -3], abs=0.01)
    assert run("compare", dome, "--result", file, "--placement", "as-given").code == 0
    assert read_json(dome / "comparison.json")["max_error_percent"] > 2.5


def test_a_dome_that_is_too_flat_is_measured_as_such(dome: Path, tmp_path: Path) -> None:
    scan = surface(dome, None, 5000, seed=5, scale=0.95) @ rotation((1, 1, 0), 20.0).T
    file = write(tmp_path / "flat.csv", "x_mm;y_mm;z_mm".replace(";", ","), scan)
    result = run("compare", dome, "--result", file, "--target-error", 0.5)
    assert result.code == 6 and "--target-error" in result.err and "flat.csv" in result.err
    record = read_json(dome / "comparison.json")
    # 3.2 mm of 63.7 mm of height; sliding along the steep rim costs nothing, so the best fit takes most of it.
    assert 0.5 < record["max_error_percent"] < 2.5, record["target"]


def test_a_meridian_of_both_sides_may_be_tilted(dome: Path, tmp_path: Path) -> None:
    columns = profile(dome)
    rho, z = columns["rho_mm"], columns["z_mm"]
    both = np.stack([np.concatenate([rho, -rho[::-1]]), np.concatenate([z, z[::-1]])], axis=1)
    sin, cos = math.sin(math.radians(4)), math.cos(math.radians(4))
    both = both @ np.array([[cos, sin], [-sin, cos]]) + [2.0, -40.0]
    assert run("compare", dome, "--result", write(tmp_path / "both.csv", "rho,z", both)).code == 0
    record = read_json(dome / "comparison.json")
    assert record["max_error_percent"] < 0.02
    assert abs(record["target"]["placement"]["rotation_angle_deg"]) == pytest.approx(4, abs=0.01)


def test_the_midline_of_a_solver_gives_the_errors_of_verify(dome: Path, tmp_path: Path) -> None:
    assert run("verify", dome, "--model", "graded").code == 0
    verified = read_json(dome / "verification.json")
    line = np.array(verified["midline_mm"]) + [0, 12.0, -3.0]
    file = write(tmp_path / "midline.csv", "s_mm,x_mm,z_mm", line)
    result = run("compare", dome, "--result", file)
    assert result.code == 0 and "by its rim" in result.out, result.err
    record = read_json(dome / "comparison.json")
    for key in ("max_error_percent", "rms_error_percent"):
        assert record[key] == pytest.approx(verified[key], abs=1e-4)
    assert record["target"]["max_shape_error_percent"] == pytest.approx(verified["max_shape_error_percent"], abs=1e-4)
    assert record["prediction"]["max_error_percent"] < 1.0
    assert record["result"]["kind"] == "midline" and record["result"]["file"] == "midline.csv"
    assert record["design_sha256"] == verified["design_sha256"]
    # A photographed strip: turned, hub first.
    turned = line[::-1].copy()
    turned[:, 1:] = turned[:, 1:] @ np.array([[0.6, 0.8], [-0.8, 0.6]])
    file = write(tmp_path / "photo.csv", "s_mm,x_mm,z_mm", turned)
    assert run("compare", dome, "--result", file, "--placement", "fit").code == 0
    fitted = read_json(dome / "comparison.json")
    assert fitted["rms_error_percent"] <= record["rms_error_percent"]
    assert fitted["target"]["placement"]["rotation_angle_deg"] == pytest.approx(53.13, abs=0.2)


def test_a_strip_has_a_midline_but_no_axis(program: Path, tmp_path: Path) -> None:
    folder = design(STRIP, tmp_path)
    columns = profile(folder)
    line = np.stack([columns["s_mm"], columns["x_mm"], columns["z_mm"]], axis=1)
    assert run("compare", folder, "--result", write(tmp_path / "line.csv", "s_mm,x_mm,z_mm", line)).code == 0
    assert read_json(folder / "comparison.json")["max_error_percent"] < 1e-3
    result = run("compare", folder, "--result", write(tmp_path / "rz.csv", "rho,z", line[:, 1:]))
    assert result.code == 2 and "no axis" in result.err and "s_mm,x_mm,z_mm" in result.err


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("", (), "no rows"),
        ("s_mm,x_mm,z_mm\n0,0,0\n1,oops,0\n2,2,0\n", (), "bad.csv:3: x_mm = oops"),
        ("s_mm,x_mm,z_mm\n0,0,0\n2,2,0\n1,1,0\n", (), "bad.csv:4: s_mm = 1: this arc length does not follow"),
        (
            "s_mm,x_mm,z_mm\n0,0,0\n50,40,0\n150,90,0\n",
            (),
            "bad.csv:4: s_mm = 150: this arc length is not on the strip",
        ),
        ("s_mm,x_mm,z_mm\n0,0,0\n1,1,0\n2,2,0\n", ("--face", "outer"), "no faces"),
        ("rho,z\n70,0\n69,10\n65,20\n", ("--placement", "rim"), "only a mid-line"),
        ("rho,z\n700,0\n690,10\n650,20\n", (), "only 0 of 3 points lie on the dome"),
        ("time,force\n0,1\n", (), "the columns are named time,force"),
    ],
)
def test_wrong_input_names_the_place(
    dome: Path, tmp_path: Path, text: str, options: tuple[str, ...], words: str
) -> None:
    file = tmp_path / "bad.csv"
    file.write_text(text, encoding="utf-8")
    before = (dome / "comparison.json").read_bytes() if (dome / "comparison.json").exists() else None
    result = run("compare", dome, "--result", file, *options)
    assert result.code == 2, (result.out, result.err)
    assert words in result.err and "bad.csv" in result.err, result.err
    after = (dome / "comparison.json").read_bytes() if (dome / "comparison.json").exists() else None
    assert before == after


def test_missing_files_and_folders(dome: Path, tmp_path: Path) -> None:
    result = run("compare", dome, "--result", tmp_path / "nowhere.csv")
    assert result.code == 2 and "nowhere.csv" in result.err
    result = run("compare", dome, "--result", tmp_path)
    assert result.code == 2 and "regular file" in result.err
    assert run("compare", tmp_path / "nowhere", "--result", tmp_path / "nowhere.csv").code == 2


def test_the_same_scan_gives_the_same_bytes(dome: Path, tmp_path: Path) -> None:
    file = write(tmp_path / "scan.csv", "x,y,z", surface(dome, 8, 3000, seed=6))
    assert run("compare", dome, "--result", file).code == 0
    first = (dome / "comparison.json").read_bytes()
    assert run("compare", dome, "--result", file).code == 0
    assert (dome / "comparison.json").read_bytes() == first
