"""Wrong input: a clear line in the message area, and the user's models as they were."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from conftest import read_json

from .recording import SCRIPTS, Recorder, Run


def refused(run: Run, index: int = -1) -> str:
    """The line that a refused action printed; nothing has changed."""
    action = run.actions[index]
    assert "error" not in action, action["error"]
    assert action["before"] == action["after"]
    lines = [line for line in run.out.splitlines() if line.startswith("Voxelastica: ")]
    assert lines, run.out
    return lines[-1]


def dialog(*arguments: object) -> dict:
    """What the form sends to the kernel."""
    return {"do": "dialog", "call": "build_model", "arguments": list(arguments)}


@pytest.fixture
def damaged(designs: dict[str, Path], tmp_path: Path):
    """A copy of a small design.json with something changed."""

    def change(edit) -> Path:
        document = read_json(designs["held"] / "design.json")
        edit(document)
        path = tmp_path / "design.json"
        path.write_text(json.dumps(document), encoding="utf-8")
        return path

    return change


def test_another_schema(record: Recorder, damaged) -> None:
    path = damaged(lambda document: document.update(schema="voxelastica/design/2"))
    line = refused(record(dialog(str(path), "geometry")))
    assert str(path) in line and "'voxelastica/design/2'" in line and "'voxelastica/design/1'" in line


@pytest.mark.parametrize("kept", [0, 1, 0.5, 0.999])
def test_a_truncated_file(record: Recorder, designs: dict[str, Path], tmp_path: Path, kept: float) -> None:
    text = (designs["held"] / "design.json").read_text(encoding="utf-8")
    path = tmp_path / "design.json"
    path.write_text(text[: int(len(text) * kept)] if kept != 1 else "[]", encoding="utf-8")
    line = refused(record(dialog(str(path), "geometry")))
    assert str(path) in line and ("is not whole" in line or "schema" in line)


def test_an_older_file(record: Recorder, damaged) -> None:
    path = damaged(lambda document: [document.pop(key) for key in ("voxels", "morph_step")])
    line = refused(record(dialog(str(path), "geometry")))
    assert "lacks voxels, morph_step" in line and "run voxelastica design again" in line


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda d: d["voxels"]["phases"].pop(), "do not fit its slices"),
        (lambda d: d["design"].pop("strips"), "is damaged"),
        (lambda d: d["voxels"].update(size_mm="wide"), "is damaged"),
        (lambda d: d["morph_step"].update(rim_travel=None), "is damaged"),
    ],
)
def test_a_damaged_file(record: Recorder, damaged, edit, message: str) -> None:
    assert message in refused(record(dialog(str(damaged(edit)), "geometry")))


def test_a_file_that_is_no_text(record: Recorder, tmp_path: Path) -> None:
    path = tmp_path / "design.json"
    path.write_bytes(bytes(range(128, 256)))
    assert "is not a text file" in refused(record(dialog(str(path), "auto")))


def test_no_file_and_a_folder(record: Recorder, tmp_path: Path) -> None:
    assert "cannot be read" in refused(record(dialog(str(tmp_path / "none.json"), "auto")))
    assert "cannot be read" in refused(record(dialog(str(tmp_path), "auto")))


def test_a_part_name_that_exists(record: Recorder, designs: dict[str, Path]) -> None:
    for kind in ("geometry", "shell"):
        run = record(
            {"do": "occupy", "model": "Model-1", "part": "SPOKE"},
            dialog(str(designs["held"] / "design.json"), kind, "Model-1"),
        )
        line = refused(run)
        assert "Model-1" in line and "parts SPOKE" in line and "choose another model" in line


def test_a_model_and_a_job_that_exist(record: Recorder, designs: dict[str, Path]) -> None:
    path = str(designs["held"] / "design.json")
    twice = record(dialog(path, "geometry"), dialog(path, "geometry"))
    assert "there is a job held-geometry already" in refused(twice)
    mesh = record(dialog(path, "mesh", "Model-1"))
    assert "there is a model Model-1 already" in refused(mesh)


@pytest.mark.parametrize(
    ("kind", "method"),
    [
        ("geometry", ("MeshPart", "generateMesh")),
        ("geometry", ("JobMdb", "Job")),
        ("geometry", ("RegionAssembly", "Set")),
        ("shell", ("ConstraintModel", "Equation")),
        ("shell", ("StepModel", "StaticStep")),
    ],
)
@pytest.mark.parametrize("model", ["", "Model-1"])
def test_a_failure_half_way_leaves_nothing(
    record: Recorder, designs: dict[str, Path], kind: str, method: tuple[str, str], model: str
) -> None:
    """The interface itself refuses; the model of the user keeps its part, ours is gone."""
    run = record(
        {"do": "occupy", "model": "Model-1", "part": "MINE"},
        {"do": "fail", "method": list(method)},
        dialog(str(designs["held"] / "design.json"), kind, model),
    )
    action = run.actions[-1]
    assert action["error"].endswith("the interface refused")
    assert action["before"] == action["after"]
    assert action["after"]["Model-1"]["parts"] == ["MINE"]
    assert len(action["calls"]) > 20


def test_building_into_the_users_model_keeps_what_is_there(record: Recorder, designs: dict[str, Path]) -> None:
    run = record(
        {"do": "occupy", "model": "Model-1", "part": "MINE"},
        dialog(str(designs["held"] / "design.json"), "geometry", "Model-1"),
    )
    assert "error" not in run.actions[-1]
    assert run.actions[-1]["after"]["Model-1"]["parts"] == ["MINE", "SPOKE"]


@pytest.mark.parametrize("name", ["held", "odd"])
@pytest.mark.parametrize("kind", ["geometry", "shell"])
def test_no_name_is_taken_unasked(record: Recorder, designs: dict[str, Path], kind: str, name: str) -> None:
    """CAE replaces what has the same name without a word: all that is made is looked up before."""
    path = str(designs[name] / "design.json")
    run = record(dialog(path, kind, "Model-1"), {"do": "names", "kind": kind, "design": path})
    assert "error" not in run.actions[0]
    before, after = (run.actions[0][when]["Model-1"] for when in ("before", "after"))
    for repository in set(after) - {"features", "sketches"}:
        made = set(after[repository]) - set(before[repository])
        assert made == set(run.actions[1]["result"].get(repository, ())), repository


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("geometry", "", "two", "90"), "cores = 'two' is not a whole number"),
        (("geometry", "", "0", "90"), "cores = 0"),
        (("geometry", "", "1", "120"), "memory = 120 percent"),
        (("solid", "", "1", "90"), "kind = 'solid' is not one of auto, geometry, mesh, shell"),
        (("geometry", "my model", "1", "90"), "cannot name a job"),
    ],
)
def test_options_without_meaning(record: Recorder, designs: dict[str, Path], arguments: tuple, message: str) -> None:
    assert message in refused(record(dialog(str(designs["held"] / "design.json"), *arguments)))


def test_what_a_design_cannot_be(record: Recorder, designs: dict[str, Path]) -> None:
    coupon, bowed = (str(designs[name] / "design.json") for name in ("coupon", "rectangular_1"))
    assert "is a strip, not a dome" in refused(record(dialog(coupon, "shell")))
    # The user insists on geometry where the mesh is recommended.
    assert "starts bowed" in refused(record(dialog(bowed, "geometry"), replies=["NO"]))
    assert "error" not in record(dialog(bowed, "geometry"), replies=["YES"]).actions[0]


def test_decks_that_are_missing_or_of_another_design(
    record: Recorder, designs: dict[str, Path], tmp_path: Path
) -> None:
    folder = tmp_path / "copy"
    shutil.copytree(designs["held"], folder)
    shutil.copy(designs["centred"] / "abaqus" / "voxel_solid.inp", folder / "abaqus" / "voxel_solid.inp")
    assert "belongs to another design" in refused(record(dialog(str(folder / "design.json"), "mesh")))
    (folder / "abaqus" / "voxel_solid.inp").unlink()
    line = refused(record(dialog(str(folder / "design.json"), "mesh")))
    assert "does not exist" in line and "decks.write" in line


def test_the_size_is_estimated_and_the_user_asked(record: Recorder, designs: dict[str, Path]) -> None:
    path = str(designs["hemisphere"] / "design.json")
    run = record(dialog(path, "geometry"), replies=["YES"])
    (question,) = [of for name, of in run.calls if name == "abaqus.getWarningReply"]
    assert "67000 voxels would need 323 cuts" in question["message"] and question["buttons"] == ["YES", "NO"]
    assert run.actions[0]["result"] == "hemisphere-mesh"
    insisted = record(dialog(path, "geometry"), replies=["NO"])
    assert insisted.actions[0]["result"] == "hemisphere-geometry"
    auto = record(dialog(path, "auto"), dialog(str(designs["held"] / "design.json"), "auto"))
    assert [action["result"] for action in auto.actions] == ["hemisphere-mesh", "held-geometry"]


def test_the_boxes_of_the_kernel(record: Recorder, designs: dict[str, Path]) -> None:
    path = str(designs["held"] / "design.json")
    asked = {"do": "dialog", "call": "ask_build"}
    run = record(asked, asked, replies=[[path, "geometry", "", "2", "80"], [None] * 5])
    assert run.actions[0]["result"] == "held-geometry" and run.actions[1]["result"] == ""


def test_the_script_says_what_is_wrong_and_ends_with_2(
    record: Recorder, designs: dict[str, Path], tmp_path: Path
) -> None:
    script = str(SCRIPTS / "build_model.py")
    good, bad = str(designs["held"] / "design.json"), str(tmp_path / "none.json")
    run = record(
        {"do": "script", "script": script, "arguments": [good, "--kind", "geometry", "--save", "x.cae"]},
        {"do": "script", "script": script, "arguments": [good, "--estimate"]},
        {"do": "script", "script": script, "arguments": [bad]},
    )
    assert [action["result"] for action in run.actions] == [0, 0, 2]
    assert f"Voxelastica: {bad} cannot be read" in run.out
    assert re.search(r"geometry: \d+ cells, \d+ cuts", run.out)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can become another user")
def test_a_folder_without_rights(
    table: Path, designs: dict[str, Path], tmp_path_factory: pytest.TempPathFactory
) -> None:
    """As a user who may neither read the design nor write beside it."""
    python, setpriv = shutil.which("python3", path="/usr/bin:/usr/local/bin"), shutil.which("setpriv")
    if not python or not setpriv:
        pytest.skip("no python3 or setpriv that another user can run")
    folder = Path(subprocess.check_output(["mktemp", "-d"], text=True).strip())
    try:
        shutil.copytree(SCRIPTS, folder / "scripts")
        shutil.copytree(Path(__file__).parent, folder / "tests", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(table, folder / "table.json")
        secret = folder / "secret"
        secret.mkdir(mode=0o700)
        shutil.copy(designs["held"] / "design.json", secret / "design.json")
        plan = {
            "scripts": str(folder / "scripts"),
            "actions": [dialog(str(secret / "design.json"), "geometry")],
        }
        (folder / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
        out = folder / "out"
        out.mkdir()
        os.chmod(folder, 0o755)
        os.chmod(out, 0o777)
        command = [setpriv, "--reuid=65534", "--clear-groups", python, "-B", folder / "tests" / "run_fake.py"]
        command += [folder / "table.json", folder / "plan.json", out / "out.json"]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        assert f"Voxelastica: {secret / 'design.json'} cannot be read: Permission denied" in done.stdout
        (action,) = json.loads((out / "out.json").read_text(encoding="utf-8"))["actions"]
        assert "error" not in action and action["before"] == action["after"]
    finally:
        shutil.rmtree(folder)
