"""The FreeCAD macro in the real FreeCAD, headless: solids, shell, phases, files, and an analysis solved by CalculiX."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import EXAMPLES, design, read_json, run

from .conftest import MACRO, Host

HEMISPHERE = EXAMPLES / "hemisphere.toml"

SMALL = """
name = "small dome"
[target]
kind = "hemi-ellipsoid"
[strips]
count = 6
length_mm = 40.0
hub_radius_mm = 4.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
pattern = "centred"
"""


def macro(host: Host, **variables: object) -> object:
    return host.run(MACRO / "Voxelastica.FCMacro", **variables)


def hexahedra(text: str) -> list[float]:
    """Volumes of the hexahedra of a deck, from the Jacobian at their centres."""
    nodes: dict[int, np.ndarray] = {}
    elements, block = [], ""
    for line in text.splitlines():
        if line.startswith("*"):
            block = "" if line.startswith("**") else line.lower().replace(" ", "")
        elif not line.strip():
            continue
        elif block.startswith("*node,"):
            number, *place = line.split(",")
            nodes[int(number)] = np.array([float(value) for value in place])
        elif block.startswith("*element") and "c3d8" in block:
            elements.append([int(cell) for cell in line.split(",") if cell.strip()][1:])
    signs = np.array(
        [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]
    )
    return [8 * np.linalg.det(signs.T @ np.array([nodes[n] for n in corners]) / 8) for corners in elements]


@pytest.fixture(scope="session")
def hemisphere(program: Path, tmp_path_factory: pytest.TempPathFactory) -> dict:
    folder = tmp_path_factory.mktemp("hemisphere")
    assert run("design", HEMISPHERE, "-o", folder).code == 0
    return read_json(folder / "design.json")


@pytest.fixture
def small(program: Path, tmp_path: Path) -> Path:
    return design(SMALL + "[decks]\nwrite = []\n", tmp_path, "small")


def test_the_papers_hemisphere_as_cad(host: Host, hemisphere: dict, tmp_path: Path) -> None:
    found = host.facts(tmp_path, VOXELASTICA_DESIGN=HEMISPHERE, VOXELASTICA_EXPORT="step,stl,fcstd", CHECK_OWN_WRITER=1)
    print(found["freecad"], {k: v for k, v in found.items() if k not in ("tree", "elements", "materials")})
    summary = hemisphere["summary"]
    volumes = summary["volume_mm3"]
    assert found["freecad"].startswith(host.version)
    # Solids: valid, closed, and of the designed volume within 0.1 %.
    assert [row[0] for row in found["solids"]] == [f"Spoke_{i}" for i in range(1, 9)] + ["Hub"]
    assert all(row[1:4] == [1, True, True] for row in found["solids"])
    for row in found["solids"][:8]:
        assert row[4] == pytest.approx(volumes["spoke_smooth"], rel=1e-5)
    assert found["solids"][8][4] == pytest.approx(volumes["hub"], rel=1e-9)
    assert sum(row[4] for row in found["solids"]) == pytest.approx(volumes["flower"], rel=1e-5)
    assert found["wires"] == [1, True, True]
    assert found["face_area"] == pytest.approx(volumes["spoke_smooth"] / 2, rel=1e-5)
    assert found["volume_ratio_at_twice_the_thickness"] == pytest.approx(2, rel=1e-9)
    # The shell: its area is that of the flat spokes, its height that of the dome.
    valid, area, low, high, reach = found["shell"]
    assert valid and area == pytest.approx(8 * volumes["spoke_smooth"] / 2, rel=1e-4)
    assert (low, high) == pytest.approx((0, summary["height_mm"]), abs=0.02)
    assert found["hub_height"] == pytest.approx(summary["height_mm"], abs=0.02)
    assert reach == pytest.approx(summary["rim_radius_mm"], abs=0.02)
    # Phases: closed surfaces of all voxels, in the flower's frame.
    counts = summary["voxels"]
    for (label, voxels, volume, closed, extent), (name, count) in zip(found["phases"], counts.items(), strict=True):
        assert label == f"Phase_{name}" and voxels == count and closed
        assert volume == pytest.approx(0.125 * count, rel=1e-5)
        # Within one slice: none need hold both phases.
        assert extent == pytest.approx([10, 110], abs=0.51)
    # Files.
    flat, morphed = found["step"]["hemisphere_flat.step"], found["step"]["hemisphere_morphed.step"]
    assert flat[0] == 9 and flat[1] == pytest.approx(sum(row[4] for row in found["solids"]), rel=1e-6)
    assert {"Spoke_1", "Hub"} <= set(flat[3])
    assert morphed[2] > area
    assert found["reopened"][0] == len(found["tree"])
    assert found["reopened"][1] == pytest.approx(volumes["spoke_smooth"], rel=1e-5) and found["reopened"][2] > 50_000
    assert (tmp_path / "hemisphere_flat.stl").stat().st_size > 10_000
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]
    # The analysis: every element has one material, within the phases, and the mesh has the strip's volume.
    assert found["mesh"] == [1701, 960]
    assert found["element_type"] == "C3D8I"
    assert found["elements"] == list(range(1, 961))
    assert found["bodies"][0] == len(found["materials"])
    assert found["bodies"][1] == pytest.approx(volumes["spoke_smooth"], rel=1e-3)
    moduli = [row[1] for row in found["materials"]]
    assert 12.6 / 2.3158 - 0.1 < min(moduli) and max(moduli) <= 12.6
    assert len(moduli) > 12 and all(row[2] == pytest.approx(0.3) for row in found["materials"])
    assert all(1145 <= row[3] <= 1170 for row in found["materials"])
    assert len(found["constraints"]) == 2 and all(row[2] == 1 for row in found["constraints"])
    assert "-90.00" in found["constraints"][0][1]
    # FreeCAD's own writer understands the analysis, too: no prerequisite is missing, every band has its section.
    problems, own = found["own_writer"]
    assert problems == ""
    text = Path(own).read_text(encoding="utf-8")
    assert len(re.findall(r"^\*SOLID SECTION", text, re.M)) == len(moduli)
    # Its hexahedra are not inside out, and fill the bodies.
    sizes = hexahedra(text)
    assert len(sizes) == 960 and min(sizes) > 0 and sum(sizes) == pytest.approx(found["bodies"][1], rel=1e-3)


def test_the_banded_analysis_is_solved_and_takes_the_shape(host: Host, ccx: str, tmp_path: Path) -> None:
    solved(host, tmp_path, 12)


def test_the_graded_analysis_is_solved_and_takes_the_shape(system: Host, ccx: str, tmp_path: Path) -> None:
    solved(system, tmp_path, 0)


def solved(host: Host, tmp_path: Path, bands: int) -> None:
    """Solves the paper's hemisphere in FreeCAD; the program agrees about the mid-line that FreeCAD read."""
    variables = {"VOXELASTICA_PARTS": "analysis", "VOXELASTICA_BANDS": bands, "VOXELASTICA_SOLVE": 1}
    found = host.facts(tmp_path, VOXELASTICA_DESIGN=HEMISPHERE, **variables)
    print(f"FreeCAD {found['freecad']}, {bands} bands: {found['max_error_percent']:.4f} % of L")
    assert found["max_error_percent"] < 1.0
    assert found["results"] >= 1
    folder = tmp_path / "design"
    assert run("design", HEMISPHERE, "-o", folder).code == 0
    result = run("compare", folder, "--result", found["midline"], "--target-error", 1)
    assert result.code == 0, result.err
    record = read_json(folder / "comparison.json")
    assert record["max_error_percent"] == pytest.approx(found["max_error_percent"], abs=2e-3)


def test_a_voxel_strip_is_solved_by_phase(system: Host, ccx: str, small: Path, tmp_path: Path) -> None:
    variables = {"VOXELASTICA_PARTS": "analysis,phases", "VOXELASTICA_MODEL": "voxel", "VOXELASTICA_PHASES": "bodies"}
    found = system.facts(tmp_path, VOXELASTICA_DESIGN=small, VOXELASTICA_SOLVE=1, **variables)
    summary = read_json(small / "design.json")["summary"]
    assert [row[0] for row in found["materials"]] == ["PHASE-FLX9070", "PHASE-FLX9095"]
    assert [row[1] for row in found["materials"]] == pytest.approx([3.1, 12.6])
    assert found["mesh"][1] == summary["voxels_per_spoke"]
    assert found["bodies"][1] == pytest.approx(summary["volume_mm3"]["spoke_voxels"], rel=1e-9)
    for row, count in zip(found["phases"], summary["voxels"].values(), strict=True):
        assert row[2] == pytest.approx(count, rel=1e-9) and row[3]
    print(f"voxel strip: {found['max_error_percent']:.3f} % of L")
    assert found["max_error_percent"] < 1.5


def test_edited_materials_are_what_is_solved(system: Host, small: Path, tmp_path: Path) -> None:
    """The deck gets the document's materials, all of its elements once, and no field any more."""
    variables = {"VOXELASTICA_PARTS": "analysis", "VOXELASTICA_BANDS": 5, "EDIT_MATERIAL": "7.25 MPa"}
    found = system.facts(tmp_path, VOXELASTICA_DESIGN=small, **variables)
    assert found["materials"][0][1] == pytest.approx(7.25)
    text = Path(found["input"]).read_text(encoding="utf-8")
    assert "*INITIAL CONDITIONS, TYPE=TEMPERATURE" not in text and "*RIGID BODY" in text and "TYPE=C3D8I" in text
    sections = re.findall(r"^\*SOLID SECTION, ELSET=(\S+), MATERIAL=(\S+)$", text, re.M)
    assert len(sections) == len(found["materials"]) and all(a == b for a, b in sections)
    moduli = [float(value) for value in re.findall(r"^\*ELASTIC\n([^,]+),", text, re.M)]
    assert moduli == pytest.approx([row[1] for row in found["materials"]], rel=1e-6)


@pytest.mark.parametrize("name", ["rectangular_1", "trumpet", "mesh", "coupon_1"])
def test_other_targets(system: Host, tmp_path: Path, name: str) -> None:
    variables = {"VOXELASTICA_PARTS": "flat,morphed" + (",analysis" if name != "coupon_1" else "")}
    found = system.facts(tmp_path, VOXELASTICA_DESIGN=EXAMPLES / f"{name}.toml", **variables)
    folder = tmp_path / "design"
    assert run("design", EXAMPLES / f"{name}.toml", "-o", folder).code == 0
    volumes = read_json(folder / "design.json")["summary"]["volume_mm3"]
    assert all(row[1:4] == [1, True, True] for row in found["solids"])
    assert found["solids"][0][4] == pytest.approx(volumes["spoke_smooth"], rel=1e-3)
    assert sum(row[4] for row in found["solids"]) == pytest.approx(volumes["flower"], rel=1e-3)


def test_the_shell_half_way(system: Host, small: Path, tmp_path: Path) -> None:
    found = system.facts(tmp_path, VOXELASTICA_DESIGN=small, VOXELASTICA_PARTS="morphed", VOXELASTICA_FRACTION=0.5)
    height = read_json(small / "design.json")["summary"]["height_mm"]
    assert found["shell"][0] and 0.4 * height < found["shell"][3] < 0.99 * height


# What is wrong.


@pytest.mark.parametrize(
    ("text", "name", "code", "words"),
    [
        ('{"schema": "voxelastica/design/9"}', "design.json", 2, ["design/9", "design/1"]),
        ('{"schema": "voxelastica/design/1", "design": {"na', "design.json", 2, ["design.json:1", "cut short"]),
        ("[1, 2]", "design.json", 2, ["no design"]),
        ("\x00\x01", "dome.toml", 2, ["dome.toml"]),
        (SMALL.replace("size_mm = 1.0", "size_mm = 0.3"), "dome.toml", 2, ["voxels.size_mm", "0.3"]),
        (SMALL.replace("size_mm", "size"), "dome.toml", 2, ["size_mm"]),
        (None, "nowhere.toml", 2, ["nowhere.toml", "no such file"]),
    ],
)
def test_wrong_files_are_told_and_nothing_is_built(
    system: Host, tmp_path: Path, text: str | None, name: str, code: int, words: list[str]
) -> None:
    file = tmp_path / name
    if text is not None:
        file.write_text(text, encoding="utf-8")
    result = macro(system, VOXELASTICA_DESIGN=file, VOXELASTICA_FOLDER=tmp_path / "out", VOXELASTICA_EXPORT="step")
    assert result.code == code, result.out + result.err
    said = result.out + result.err
    assert "Voxelastica: " in said and "Traceback" not in said, said
    for word in words:
        assert word in said, said
    assert not list((tmp_path / "out").glob("*"))


def test_an_infeasible_design_says_what_would_help(system: Host, tmp_path: Path) -> None:
    text = (EXAMPLES / "trumpet.toml").read_text(encoding="utf-8").replace('hub = "held"', 'hub = "free"')
    (tmp_path / "trumpet.toml").write_text(text, encoding="utf-8")
    result = macro(system, VOXELASTICA_DESIGN=tmp_path / "trumpet.toml")
    assert result.code == 3 and "infeasible" in result.out + result.err


@pytest.mark.parametrize(
    ("variables", "words"),
    [
        ({"VOXELASTICA_PARTS": "flat,petals"}, "petals"),
        ({"VOXELASTICA_FRACTION": "1.5"}, "1.5"),
        ({"VOXELASTICA_BANDS": "many"}, "many"),
        ({"VOXELASTICA_EXPORT": "step"}, "VOXELASTICA_FOLDER"),
        ({"VOXELASTICA_DOCUMENT": "Mine"}, "Mine"),
        ({"VOXELASTICA_PYTHON": "/nowhere"}, "VOXELASTICA_PYTHON"),
    ],
)
def test_wrong_settings_are_told(system: Host, small: Path, variables: dict[str, str], words: str) -> None:
    result = macro(system, VOXELASTICA_DESIGN=small, **variables)
    said = result.out + result.err
    assert result.code == 2 and words in said and "Traceback" not in said, said


def test_a_folder_without_rights(system: Host, small: Path, tmp_path: Path) -> None:
    locked = tmp_path / "locked"
    locked.mkdir(mode=0o555)
    for path in [*tmp_path.parents, tmp_path]:
        if path.stat().st_uid == 0 and path not in (Path("/"), Path("/tmp")):
            path.chmod(path.stat().st_mode | 0o055)
    home = tmp_path / "home"
    home.mkdir()
    home.chmod(0o777)
    prefix = ("setpriv", "--reuid=65534", "--clear-groups")
    if not shutil.which("setpriv"):
        pytest.skip("setpriv is not installed")
    result = system.run(
        MACRO / "Voxelastica.FCMacro",
        prefix=prefix,
        HOME=home,
        VOXELASTICA_DESIGN=small,
        VOXELASTICA_FOLDER=locked,
        VOXELASTICA_EXPORT="step",
    )
    said = result.out + result.err
    assert result.code == 5 and str(locked) in said and "Traceback" not in said, said
    assert not list(locked.iterdir())


def test_a_file_in_the_folders_place(system: Host, small: Path, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file", encoding="utf-8")
    result = macro(system, VOXELASTICA_DESIGN=small, VOXELASTICA_FOLDER=tmp_path / "taken", VOXELASTICA_EXPORT="stl")
    assert result.code == 5 and "taken" in result.out + result.err


def test_a_solver_that_is_missing_or_fails(system: Host, small: Path, tmp_path: Path) -> None:
    broken = tmp_path / "ccx"
    broken.write_text(
        "#!/bin/sh\necho 'This is CalculiX'\necho ' *ERROR in the stand-in'\nexit 201\n", encoding="utf-8"
    )
    broken.chmod(0o755)
    result = macro(
        system,
        VOXELASTICA_DESIGN=small,
        VOXELASTICA_PARTS="analysis",
        VOXELASTICA_SOLVE=1,
        VOXELASTICA_FOLDER=tmp_path / "out",
        VOXELASTICA_CCX=broken,
    )
    said = result.out + result.err
    assert result.code == 4 and "stand-in" in said, said


def test_the_users_document_is_left_as_it_was(system: Host, small: Path, tmp_path: Path) -> None:
    """A tree of the same name is refused, an error half-way undoes everything, and replacing replaces."""
    script = tmp_path / "twice.py"
    script.write_text(
        f"""
import os, sys, traceback
try:
    sys.path.insert(0, {str(MACRO)!r})
    import FreeCAD as App
    from voxelastica_freecad import core, morphed
    from voxelastica_freecad.settings import MacroError, Settings

    document = App.newDocument("Mine")
    box = document.addObject("Part::Box", "Box")
    box.Label = "my own box"
    document.recompute()

    def settings(**more):
        return Settings(design={str(small)!r}, parts=("flat", "morphed"), document="Mine", **more)

    def names():
        return [(item.Name, item.Label) for item in document.Objects]

    # Something fails after the flat flower was built.
    whole = morphed.build
    def fails(*_):
        raise RuntimeError("half-way")
    morphed.build = fails
    try:
        core.build(settings())
        raise SystemExit("nothing was raised")
    except RuntimeError:
        pass
    morphed.build = whole
    assert names() == [("Box", "my own box")], names()
    assert abs(box.Shape.Volume - 1000) < 1e-9 and document.UndoMode == 0

    core.build(settings())
    before = names()
    assert before[0] == ("Box", "my own box") and len(before) > 8
    try:
        core.build(settings())
        raise SystemExit("nothing was raised")
    except MacroError as error:
        assert "Voxelastica small dome" in str(error) and "is there already" in str(error), error
    assert names() == before
    core.build(settings(replace=True))
    assert len(document.Objects) == len(before), names()
    # An object of the user's that happens to have that name is never removed.
    document.getObjectsByLabel("Voxelastica small dome")[0].Label = "other"
    box.Label = "Voxelastica small dome"
    try:
        core.build(settings(replace=True))
        raise SystemExit("nothing was raised")
    except MacroError:
        pass
    assert document.getObject("Box") is not None
    # A new document that could not be filled is closed again.
    morphed.build = fails
    try:
        core.build(Settings(design={str(small)!r}, parts=("morphed",)))
    except RuntimeError:
        pass
    assert list(App.listDocuments()) == ["Mine"], App.listDocuments()
    print("as it was")
except BaseException:
    traceback.print_exc()
    sys.stdout.flush()
    sys.exit(3)
""",
        encoding="utf-8",
    )
    result = system.run(script)
    assert result.code == 0 and "as it was" in result.out, result.out + result.err


def test_the_test_driver_sees_exceptions(system: Host, tmp_path: Path) -> None:
    """FreeCAD ends with 0 whatever a macro raises; these tests do not."""
    script = tmp_path / "raises.py"
    script.write_text("raise RuntimeError('lost')\n", encoding="utf-8")
    assert system.run(script).code == 0
    broken = tmp_path / "macro"
    shutil.copytree(MACRO, broken)
    module = broken / "voxelastica_freecad" / "flat.py"
    module.write_text(module.read_text(encoding="utf-8").replace("Part.BSplineCurve()", "Part.BSplinCurve()"))
    result = system.run(
        broken / "Voxelastica.FCMacro",
        VOXELASTICA_DESIGN=HEMISPHERE,
        VOXELASTICA_PARTS="flat",
        VOXELASTICA_PYTHON=MACRO.parent / "ffi" / "python",
    )
    assert result.code == 1 and "BSplinCurve" in result.out + result.err


def test_the_package_file_is_what_the_addon_manager_reads(system: Host, tmp_path: Path) -> None:
    script = tmp_path / "package.py"
    script.write_text(
        f"""
import sys, traceback
try:
    import FreeCAD as App
    metadata = App.Metadata({str(MACRO / "package.xml")!r})
    macro = metadata.Content["macro"][0]
    assert metadata.Name == "Voxelastica" and macro.File == ["Voxelastica.FCMacro"], (metadata.Name, macro.File)
    assert macro.supportsCurrentFreeCAD() and metadata.Icon == "icon.svg"
    print("read", metadata.Version)
except BaseException:
    traceback.print_exc()
    sys.stdout.flush()
    sys.exit(3)
""",
        encoding="utf-8",
    )
    result = system.run(script)
    assert result.code == 0 and "read 0.1.0" in result.out, result.out + result.err
    assert all((MACRO / name).is_file() for name in ("Voxelastica.FCMacro", "icon.svg", "package.xml"))
