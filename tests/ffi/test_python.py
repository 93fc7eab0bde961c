"""The Python package, with numpy and without, on every Python that is there."""

from __future__ import annotations

import ctypes
import doctest
import gc
import json
import math
import os
import pickle
import shutil
import subprocess
import sys
import threading
from array import array
from pathlib import Path

import numpy as np
import pytest
from conftest import EXAMPLES, read_json

from .conftest import PACKAGE, ROOT

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
"""


@pytest.fixture(scope="module")
def design():
    import voxelastica

    return voxelastica.Design.from_file(ROOT / "examples" / "hemisphere.toml")


def test_the_worked_example_of_the_docs_is_right() -> None:
    import voxelastica

    result = doctest.testmod(voxelastica)
    assert result.attempted > 5 and result.failed == 0


def test_a_design_reads_as_its_files_do(design, examples: dict[str, Path]) -> None:
    written = read_json(examples["hemisphere"] / "design.json")
    assert design.summary == written["summary"]
    assert design.hash == written["provenance"]["design_sha256"]
    assert design.input == written["design"]
    profile = design.profile
    for name in ("s_mm", "x_mm", "z_mm", "rho_mm", "width_mm", "modulus_ratio", "modulus_mpa", "rigid_fraction"):
        assert np.array_equal(getattr(profile, name), written["profile"][name]), name
    assert np.array_equal(np.degrees(profile.inclination), written["profile"]["theta_deg"])
    for name, column in design.slices.items():
        assert np.array_equal(column, written["slices"][name]), name
    voxels = design.voxels
    for phase, label in enumerate(written["summary"]["voxels"]):
        assert voxels.count(phase) == written["summary"]["voxels"][label] == len(voxels.centres(phase))
    whole = json.loads(design.to_json())
    assert {**whole, "files": None} == {**written, "files": None}


def test_arrays_are_borrowed_read_only_and_keep_their_design_alive() -> None:
    import voxelastica

    design = voxelastica.Design.from_toml(SMALL)
    width = design.profile.width_mm
    address = width.__array_interface__["data"][0]
    assert address == design.profile.width_mm.__array_interface__["data"][0]
    assert not width.flags.writeable and not width.flags.owndata
    strided = design.slices["modulus_mpa"]
    assert strided.strides[0] > 8
    positions = design.mesh(0.5).positions
    kept = width.copy(), strided.copy(), positions.copy()
    del design
    gc.collect()
    assert width.__array_interface__["data"][0] == address
    assert all(np.array_equal(a, b) for a, b in zip(kept, (width, strided, positions), strict=True))


def test_nothing_stays_behind() -> None:
    import voxelastica

    gc.collect()
    before = voxelastica._LIBRARY.voxelastica_live_objects()
    for _ in range(50):
        design = voxelastica.Design.from_toml(SMALL)
        flower = design.flower(along=4, across=2)
        flower.fill(0.5, flower.buffer())
        with pytest.raises(voxelastica.VoxelasticaError):
            design.mesh(2.0)
    del design, flower
    gc.collect()
    assert voxelastica._LIBRARY.voxelastica_live_objects() == before


def test_errors_are_those_of_the_command_line() -> None:
    import voxelastica

    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        voxelastica.Design.from_toml(SMALL.replace("size_mm = 1.0", "size_mm = 0.3"), file="my.toml")
    error = caught.value
    assert (error.code, error.key, error.value) == (error.INPUT, "voxels.size_mm", "0.3")
    assert "voxels.size_mm = 0.3: voxels of 0.3 mm do not divide" in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert vars(again) == vars(error) and str(again) == str(error)
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        voxelastica.Design.from_toml("[target]\nkind = 'hemi-ellipsoid'\n[strips]\ncuont = 3\n", file="my.toml")
    assert (caught.value.file, caught.value.line, caught.value.key) == ("my.toml", 4, "strips.cuont")
    assert str(caught.value).startswith("my.toml:4: strips.cuont")


def test_progress_is_told_and_cancels() -> None:
    import voxelastica

    design = voxelastica.Design.from_toml(SMALL)
    told: list[tuple[int, int]] = []
    design.path(50, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (50, 50)
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        design.path(100_000, progress=lambda done, total: False)
    assert caught.value.code == caught.value.CANCELLED

    def broken(done: int, total: int) -> bool:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        design.path(100_000, progress=broken)


@pytest.mark.parametrize("after", [0, 1_000_000])
def test_a_large_deck_is_cancelled_while_planned_and_while_written(tmp_path: Path, after: int) -> None:
    import voxelastica

    large = SMALL.replace("length_mm = 20.0", "length_mm = 100.0").replace("size_mm = 1.0", "size_mm = 0.1")
    design = voxelastica.Design.from_toml(large)
    asked: list[int] = []

    def stop(done: int, total: int) -> bool:
        asked.append(done)
        return done < after

    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        design.write(tmp_path / "out", ["voxel_solid"], allow_large=True, progress=stop)
    assert caught.value.code == caught.value.CANCELLED
    assert asked[-1] >= after and all(done < after for done in asked[:-1])
    assert not (tmp_path / "out").exists()


def test_reading_a_mesh_is_told_of(tmp_path: Path) -> None:
    import voxelastica

    example = Path(__file__).parents[2] / "examples" / "mesh.toml"
    told: list[tuple[int, int]] = []
    voxelastica.Design.from_file(example, progress=lambda done, total: told.append((done, total)))
    assert told
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        voxelastica.Design.from_file(tmp_path / "none.toml", progress=lambda done, total: True)
    assert caught.value.code == caught.value.INPUT


def test_writing_by_kind(tmp_path: Path) -> None:
    import voxelastica

    design = voxelastica.Design.from_toml(SMALL)
    files = design.write(tmp_path / "a", ["tables", "voxel_solid"])
    names = {str(file.relative_to(tmp_path / "a")) for file in files}
    assert names == {"profile.csv", "slices.csv", "abaqus/voxel_solid.inp", "calculix/voxel_solid.inp"}
    assert all(file.is_file() for file in files) and not (tmp_path / "a" / "design.json").exists()
    with pytest.raises(ValueError, match="no outputs"):
        design.write(tmp_path, ["everything"])
    none = voxelastica.Design.from_toml(SMALL + "[decks]\nwrite = []\n")
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        none.write(tmp_path / "b", ["voxel_solid"])
    assert caught.value.key == "decks.write"


CONDUCTING = SMALL.replace('["FLX9070", "FLX9095"]', '["PI + 15 % graphite", "PLA + 30 % carbon fibre"]')


def test_a_design_is_solved_corrected_and_made(tmp_path: Path) -> None:
    import voxelastica

    design = voxelastica.Design.from_toml(SMALL)
    told: list[tuple[int, int]] = []
    found = design.verify(progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (1000, 1000) and found["solver"]["name"] == "embedded"
    assert 0 < found["rms_error_percent"] <= found["max_error_percent"] < 5 and len(found["midline_mm"]) == 21
    refined = design.refine(2)
    assert refined.input["refine"]["errors_percent"][0] == pytest.approx(found["max_error_percent"], abs=1e-3)
    assert refined.hash != design.hash and voxelastica.Design.from_json(refined.to_json()).hash == refined.hash
    assert refined.verify()["max_error_percent"] <= found["max_error_percent"]
    files = design.fabricate(tmp_path, ["svg", "stl"])
    assert all(file.is_file() for file in files) and any(file.suffix == ".stl" for file in files)
    with pytest.raises(ValueError, match="files to make"):
        design.fabricate(tmp_path, ["paper"])
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        design.verify(progress=lambda done, total: False)
    assert caught.value.code == caught.value.CANCELLED


def test_input_is_completed_without_a_design(tmp_path: Path) -> None:
    import voxelastica

    keys = {
        "target": {"kind": "mesh", "file": "dome.obj"},
        "strips": {"count": 8, "length_mm": 100.0, "hub_radius_mm": 0.5, "thickness_mm": 2.0},
        "materials": {"phases": ["FLX9070", "FLX9095"]},
        "voxels": {"size_mm": 1.0},
    }
    # Infeasible standing freely, but the meridian is there.
    found = voxelastica.complete(keys, folder=EXAMPLES)
    assert found["voxels"]["pattern"] == "random" and found["target"]["meridian"][-1][0] == pytest.approx(0.5)
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        voxelastica.Design.from_dict(found)
    assert caught.value.code == caught.value.INFEASIBLE
    with pytest.raises(voxelastica.VoxelasticaError, match="voxels.size_m"):
        voxelastica.complete({**keys, "voxels": {"size_m": 1.0}}, folder=EXAMPLES)


def test_calculix_solves_a_design(ccx: str) -> None:
    import voxelastica

    small = SMALL + "[decks]\ncalculix_graded_elements = [24, 4, 2]\n"
    design = voxelastica.Design.from_toml(small)
    found = design.verify_ccx(ccx=ccx)
    assert found["solver"]["name"] == "CalculiX" and found["model"] == "graded" and found["max_error_percent"] < 2
    with pytest.raises(voxelastica.VoxelasticaError, match="/nowhere/ccx") as caught:
        design.verify_ccx(ccx="/nowhere/ccx")
    assert caught.value.code == caught.value.SOLVER
    without = voxelastica.Design.from_toml(SMALL + '[decks]\nsolvers = ["abaqus"]\n')
    with pytest.raises(voxelastica.VoxelasticaError, match="decks.solvers"):
        without.verify_ccx(ccx=ccx)
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        design.verify_ccx(ccx=ccx, progress=lambda done, total: False)
    assert caught.value.code == caught.value.CANCELLED


def test_heat_and_current_flow_and_say_what_is_assumed() -> None:
    import voxelastica

    design = voxelastica.Design.from_toml(CONDUCTING)
    heat = design.conduct("heat", regime="both")
    steady = heat["steady"]
    assert steady["series_bound"] <= steady["effective_conductivity"] <= steady["parallel_bound"]
    assert heat["assumptions"] and heat["transient"]["critical_times_s"][-1] > 0
    with pytest.raises(ValueError, match="flow must be one of"):
        design.conduct("water")  # type: ignore[arg-type]
    with pytest.raises(voxelastica.VoxelasticaError) as caught:
        voxelastica.Design.from_toml(SMALL).conduct("heat")
    assert caught.value.code == caught.value.INPUT


def test_the_flower_is_its_spokes_turned(design) -> None:
    flower = design.flower(along=20, across=4)
    positions, normals = flower.buffer("d"), flower.buffer("d")
    flower.fill(0.6, positions, normals)
    whole = np.concatenate([design.mesh(0.6, spoke=i, along=20, across=4).positions for i in range(8)])
    assert np.abs(positions - whole).max() < 1e-9
    assert np.allclose(np.linalg.norm(normals, axis=1), 1)
    assert flower.quads.max() == flower.vertices - 1
    single = flower.buffer()
    flower.fill(0.6, single)
    assert np.array_equal(single, positions.astype(np.float32))
    plain = array("f", bytes(12 * flower.vertices))
    flower.fill(0.6, plain)
    assert np.array_equal(np.frombuffer(plain, np.float32), single.ravel())
    for wrong in (np.zeros(5, np.float32), np.zeros((flower.vertices, 3), np.int32), b"x" * 12 * flower.vertices):
        with pytest.raises((TypeError, Exception)):
            flower.fill(0.6, wrong)


def test_several_threads_read_one_design(design) -> None:
    expected = [design.mesh(i / 10).positions.copy() for i in range(10)]
    wrong: list[int] = []

    def work() -> None:
        for i, wanted in enumerate(expected):
            if not np.array_equal(design.mesh(i / 10).positions, wanted):
                wrong.append(i)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_forces_along_the_path_end_at_the_summary(design) -> None:
    path = design.path(11)
    beam = design.summary["thrust"]["per_spoke"]["beam"]
    assert math.isclose(path.horizontal_n[-1], beam["horizontal_n"], rel_tol=1e-6)
    assert math.isclose(path.rim_moment_nmm[-1], beam["rim_moment_nmm"], rel_tol=1e-6)
    assert math.isclose(path.height_mm[-1], design.summary["height_mm"], rel_tol=1e-6)
    assert path.horizontal_n[0] == 0 and path.span_mm[0] == pytest.approx(100.0)


def test_strips_have_no_hub() -> None:
    import voxelastica

    strip = voxelastica.Design.from_file(ROOT / "examples" / "rectangular_2.toml")
    assert strip.hub(1.0) == [] and strip.spokes == 1 and len(strip.mesh(1.0).positions) == 909


def test_lists_are_what_forms_are_built_from() -> None:
    import voxelastica

    assert voxelastica.materials()[0]["name"] == "FLX9070"
    keys = {parameter["key"]: parameter for parameter in voxelastica.parameters()}
    assert keys["voxels.size_mm"]["unit"] == "mm" and keys["strips.count"]["type"] == "integer"
    assert voxelastica.schema()["properties"]["voxels"]["properties"]["size_mm"]["x-unit"] == "mm"


def interpreters() -> list[tuple[str, str | None]]:
    """Pythons 3.10 to 3.14: on the path, or where version managers put them."""
    found = []
    roots = [Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"]
    for minor in range(10, 15):
        managed = [p for root in roots for p in sorted(root.glob(f"3.{minor}.*/bin/python"))]
        candidates = [*map(str, managed), shutil.which(f"python3.{minor}")]
        found.append((f"3.{minor}", next((c for c in candidates if c and works(c)), None)))
    return found


def works(python: str) -> bool:
    return subprocess.run([python, "-c", "import ctypes"], check=False, capture_output=True).returncode == 0


PLAIN = """
import sys
sys.modules["numpy"] = None  # The standard library alone.
import voxelastica
design = voxelastica.Design.from_file(sys.argv[1])
flower = design.flower(along=20, across=4)
buffer = flower.buffer("d")
flower.fill(0.5, buffer)
table = design.slices["modulus_mpa"]
centres = design.voxels.centres(0)
mesh = design.mesh(0.5)
assert len(design.outline) == 2002 and design.outline[0, 1] < 0 and mesh.quads[0, 0] == 0
assert mesh.positions.readonly and len(design.path(5).fraction) == 5 and len(design.hub(0.5)) == 8
try:
    design.mesh(7.0)
except voxelastica.VoxelasticaError as error:
    assert error.key == "fraction"
print(sum(design.profile.width_mm), sum(buffer), sum(table), centres[0, 0], sum(design.voxels.phases), design.hash)
"""


@pytest.mark.parametrize(("version", "python"), interpreters(), ids=lambda value: str(value)[:5])
def test_every_python_without_numpy(version: str, python: str | None, design) -> None:
    if python is None:
        pytest.skip(f"Python {version} is not installed")
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE)}
    done = subprocess.run(
        [python, "-W", "error", "-c", PLAIN, ROOT / "examples" / "hemisphere.toml"],
        check=False,
        capture_output=True,
        text=True,
        env=environment,
    )
    assert done.returncode == 0, done.stderr
    said = done.stdout.split()
    assert float(said[0]) == pytest.approx(float(np.sum(design.profile.width_mm)))
    assert said[-1] == design.hash


def test_a_missing_library_says_what_to_do(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE), "VOXELASTICA_LIBRARY": str(tmp_path / "no.so")}
    command = [sys.executable, "-c", "import voxelastica"]
    done = subprocess.run(command, check=False, capture_output=True, text=True, env=environment)
    assert done.returncode == 1 and "no.so" in done.stderr and "VOXELASTICA_LIBRARY" in done.stderr
    assert ctypes.sizeof(ctypes.c_void_p) == 8
