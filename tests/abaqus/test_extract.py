"""The extraction: from a database to the mid-line that `voxelastica compare` takes and the reactions by increment.

The databases are the stand-in's; their displacements are those that the finite elements inside Voxelastica found.
"""

from __future__ import annotations

import ast
import csv
import json
import math
from pathlib import Path

import pytest

from conftest import read_json, run

from .recording import SCRIPTS, Recorder

H, V, M = -0.21, 0.05, 3.5


@pytest.fixture(scope="module")
def morphed(designs: dict[str, Path]) -> dict:
    """Design and verified mid-line of a small hemisphere."""
    result = run("verify", designs["centred"])
    assert result.code == 0, result.err
    found = read_json(designs["centred"] / "verification.json")
    return {"folder": designs["centred"], "midline": found["midline_mm"], "sha": found["design_sha256"]}


def database(midline: list, spoke: int | None = None, count: int = 8, axes: str = "local", **more: object) -> dict:
    """A database of a strip (`spoke` None) or of spoke i of a flower whose hub is at the origin, hub radius 4 mm."""
    length = midline[-1][0]
    azimuth = 2 * math.pi * ((spoke or 1) - 1) / count
    inward = (1.0, 0.0) if spoke is None else (-math.cos(azimuth), -math.sin(azimuth))
    start = (0.0, 0.0) if spoke is None else tuple(-c * (4.0 + length) for c in inward)
    travel = length - midline[-1][1]

    def place(x: float) -> list[float]:
        return [start[0] + x * inward[0], start[1] + x * inward[1], 0.0]

    nodes, moved = [], {}
    for label, (s, x, z) in enumerate(midline, 1):
        nodes.append([label, place(s)])
        dx = travel + x - s
        moved[label] = [dx * inward[0], dx * inward[1], z]
    suffix = "" if spoke is None else f"-{spoke}"
    rim, hub = [1, place(0.0)], [2, place(length)]
    sets = {f"MIDLINE{suffix}": nodes, f"RP-RIM{suffix}": [rim], f"RP-HUB{suffix}": [hub], "RIM": [rim]}
    history = []
    for (label, at), sign, u in ((rim, 1, travel), (hub, -1, 0.0)):
        force, motion = [sign * H, 0.0, -sign * V], [u, 0.0, 0.0]
        moment = [0.0, sign * M, 0.0]
        if axes == "global":
            turn = [
                lambda v: v[0] * inward[0] - v[1] * inward[1],
                lambda v: v[0] * inward[1] + v[1] * inward[0],
                lambda v: v[2],
            ]
            force, motion, moment = ([t(v) for t in turn] for v in (force, motion, moment))
        names = dict(
            zip(("RF1", "RF2", "RF3", "RM1", "RM2", "RM3", "U1", "U2", "U3"), force + moment + motion, strict=True)
        )
        outputs = {name: [[0.0, 0.0], [0.5, value / 2], [1.0, value]] for name, value in names.items()}
        history.append({"label": label, "coordinates": at, "outputs": outputs})
    if spoke is not None:
        # The hub's own point, and a node of an instance with the same label as the rim's point.
        sets["RP-HUB"] = [[3, [0.0, 0.0, 0.0]]]
        zeros = {name: [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]] for name in ("RF1", "RF2", "RM1", "RM2", "RM3")}
        zeros["RF3"] = [[0.0, 0.0], [0.5, 0.0], [1.0, count * V]]
        history.append({"label": 3, "coordinates": [0.0, 0.0, 0.0], "outputs": zeros})
        history.append({"label": 1, "coordinates": [1.0, 2.0, 0.0], "outputs": {n: [[1.0, 99.0]] for n in zeros}})
    return {"sets": sets, "displacements": moved, "history": history, "time": 1.0, **more}


def extract(record: Recorder, folder: Path, data: dict | None, *arguments: object):
    """Runs the extraction on a database that lies in `folder`."""
    path = folder / "job.odb"
    path.write_bytes(b"")
    action = {"do": "dialog", "call": "extract_results", "arguments": [str(path), *arguments]}
    databases = {str(path): data} if data else {}
    return record({"do": "extract", "databases": databases, "arguments": ["none.odb"]}, action)


def rows(path: Path) -> list[dict[str, float]]:
    with path.open(encoding="ascii", newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


@pytest.mark.parametrize(("spoke", "axes"), [(None, "local"), (1, "local"), (1, "global"), (3, "global"), (6, "local")])
def test_the_midline_comes_back(record: Recorder, morphed: dict, tmp_path: Path, spoke: int | None, axes: str) -> None:
    data = database(morphed["midline"], spoke, axes=axes)
    run = extract(record, tmp_path, data, str(morphed["folder"] / "design.json"), "", str(spoke or 1))
    assert "written" in run.out, run.out
    text = (tmp_path / "job_midline.csv").read_text(encoding="ascii")
    assert text.startswith("s_mm,x_mm,z_mm\n")
    found = rows(tmp_path / "job_midline.csv")
    assert len(found) == len(morphed["midline"])
    for row, (s, x, z) in zip(found, morphed["midline"], strict=True):
        # The deformed rim, not the flat one, is the origin.
        at = (s, x - morphed["midline"][0][1], z - morphed["midline"][0][2])
        assert tuple(row.values()) == pytest.approx(at, abs=1e-7)
    reactions = rows(tmp_path / "job_reactions.csv")
    assert [row["time"] for row in reactions] == [0.0, 0.5, 1.0]
    suffix = "" if spoke is None else f"_{spoke}"
    last = reactions[-1]
    assert last[f"rp_rim{suffix}_rf1_n"] == pytest.approx(H) and last[f"rp_hub{suffix}_rf1_n"] == pytest.approx(-H)
    assert last[f"rp_rim{suffix}_rf3_n"] == pytest.approx(-V)
    assert last[f"rp_rim{suffix}_rm2_nmm"] == pytest.approx(M)
    assert last[f"rp_rim{suffix}_rf2_n"] == pytest.approx(0, abs=1e-12)
    if spoke is not None:
        assert last["rp_hub_rf3_n"] == pytest.approx(8 * V)
    results = json.loads((tmp_path / "job_results.json").read_text(encoding="ascii"))
    assert results["schema"] == "voxelastica/cae-results/1" and results["design_sha256"] == morphed["sha"]
    assert len(results["midline_mm"]) == len(found) and len(results["reactions"]) == (2 if spoke is None else 3)
    if spoke is not None:
        assert results["reactions"][0]["axes_in_database"] == axes


def pressed(midline: list) -> dict:
    """A flower pressed by 10 mm: RF3 falls by 2 N, the strain energy grows by 11 N mm."""
    data = database(midline, 3)
    hub = next(of for of in data["history"] if of["label"] == 3)
    hub["outputs"]["U3"] = [[0.0, 0.0], [0.5, 12.0], [1.0, 25.0]]
    last = hub["outputs"]["RF3"][-1][1]
    outputs = {
        "U3": [[0.0, 25.0], [0.5, 20.0], [1.0, 15.0]],
        "RF3": [[0.0, last], [0.5, last - 1.2], [1.0, last - 2.0]],
    }
    energy = {"outputs": {"ALLSE": [[0.0, 40.0], [0.5, 44.0], [1.0, 51.0]]}}
    data["history"].append({"outputs": {"ALLSE": [[0.0, 0.0], [1.0, 40.0]]}})
    data["press"] = [{"label": 3, "coordinates": [0.0, 0.0, 0.0], "outputs": outputs}, energy]
    data["sets"].update({f"RP-HUB-{i}": [[9 + i, [0.0, 0.0, 1.0]]] for i in range(1, 9) if i != 3})
    return data


def test_a_pressed_dome_gives_force_over_depth(record: Recorder, morphed: dict, tmp_path: Path) -> None:
    run = extract(record, tmp_path, pressed(morphed["midline"]), "", "", "3")
    assert "written" in run.out, run.out
    found = rows(tmp_path / "job_force_displacement.csv")
    assert [row["depth_mm"] for row in found] == pytest.approx([0, 5, 10])
    assert [row["force_n"] for row in found] == pytest.approx([0, 1.2, 2.0])
    assert [row["force_per_spoke_n"] for row in found] == pytest.approx([0, 0.15, 0.25])
    assert [row["strain_energy_nmm"] for row in found] == pytest.approx([0, 4, 11])
    # The mid-line is still that of the morph.
    results = json.loads((tmp_path / "job_results.json").read_text(encoding="ascii"))
    assert results["step"] == "MORPH" and results["force_displacement"]["spokes"] == 8


def test_a_press_that_lacks_its_history(record: Recorder, morphed: dict, tmp_path: Path) -> None:
    data = pressed(morphed["midline"])
    del data["press"][0]["outputs"]["U3"]
    run = extract(record, tmp_path, data, "", "", "3")
    assert "step PRESS has no history of U3 at RP-HUB" in run.out
    assert [path.name for path in tmp_path.iterdir()] == ["job.odb"]


def test_both_pythons_write_the_same(record: Recorder, record27: Recorder, morphed: dict, tmp_path: Path) -> None:
    texts = []
    for i, recorder in enumerate((record, record27)):
        folder = tmp_path / str(i)
        folder.mkdir()
        extract(recorder, folder, database(morphed["midline"], 3), "", "", "3")
        texts.append([(folder / f"job_{name}").read_bytes() for name in ("midline.csv", "reactions.csv")])
    assert texts[0] == texts[1]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"sets": {"ALL": [[1, [0, 0, 0]]]}}, "no node set MIDLINE"),
        ({"steps": False}, "has no step"),
        ({"frames": 0}, "no frame yet"),
        ({"displacements": {1: [0, 0, 0]}}, "has no displacement"),
        ({"history": []}, "no history of RF at RP-RIM"),
    ],
)
def test_a_database_that_lacks_something(
    record: Recorder, morphed: dict, tmp_path: Path, change: dict, message: str
) -> None:
    run = extract(record, tmp_path, {**database(morphed["midline"]), **change})
    assert message in run.out and "error" not in run.actions[-1], run.actions[-1]
    assert [path.name for path in tmp_path.iterdir()] == ["job.odb"]


def test_no_database_and_none_that_opens(record: Recorder, tmp_path: Path) -> None:
    assert "cannot be opened" in extract(record, tmp_path, None).out
    action = {"do": "dialog", "call": "extract_results", "arguments": [str(tmp_path / "none.odb")]}
    assert "does not exist: run the job first" in record(action).out


def test_a_folder_that_cannot_be_written(record: Recorder, morphed: dict, tmp_path: Path) -> None:
    """A file stands in the folder's place."""
    (tmp_path / "taken").write_text("mine", encoding="ascii")
    run = extract(record, tmp_path, database(morphed["midline"]), "", str(tmp_path / "taken"))
    assert "cannot be written" in run.out and "error" not in run.actions[-1]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["job.odb", "taken"]


def test_earlier_results_are_replaced_whole(record: Recorder, morphed: dict, tmp_path: Path) -> None:
    (tmp_path / "job_midline.csv").write_text("old", encoding="ascii")
    extract(record, tmp_path, database(morphed["midline"]))
    assert len(rows(tmp_path / "job_midline.csv")) == len(morphed["midline"])
    assert not list(tmp_path.glob("*.part"))


def test_the_script(record: Recorder, morphed: dict, tmp_path: Path) -> None:
    path = tmp_path / "job.odb"
    path.write_bytes(b"")
    script = {"do": "script", "script": str(SCRIPTS / "extract_results.py")}
    run = record(
        {"do": "extract", "databases": {str(path): database(morphed["midline"])}, "arguments": [str(path)]},
        {**script, "arguments": [str(path), "--out", str(tmp_path)]},
        {**script, "arguments": [str(path), "--design", str(tmp_path / "none.json")]},
    )
    assert [action["result"] for action in run.actions[1:]] == [0, 2]
    assert "none.json cannot be read" in run.out


def test_the_plug_in_registers_and_sends_what_the_kernel_takes(record: Recorder) -> None:
    """Four buttons; every keyword of a form is an argument of the function that it calls."""

    run = record({"do": "plugin", "script": str(SCRIPTS / "voxelastica_plugin.py")})
    action = run.actions[0]
    assert "error" not in action, action
    calls = action["calls"]
    buttons = [of for path, of in calls if "register" in path]
    assert [of["buttonText"].split("|")[0] for of in buttons] == ["Voxelastica"] * 4
    assert sum(path.endswith("registerKernelMenuButton") for path, _ in calls) == 2
    for of in buttons[:2]:
        # What CAE runs in the kernel before the first call, as text.
        compile(of["kernelInitString"], "init", "exec")
        assert str(SCRIPTS) in of["kernelInitString"]
    text = (SCRIPTS / "voxelastica_cae" / "dialogs.py").read_text(encoding="ascii")
    parameters = {
        node.name: [arg.arg for arg in node.args.args] for node in ast.parse(text).body if hasattr(node, "args")
    }
    command = None
    sent: dict[str, list[str]] = {}
    for path, of in calls:
        if path == "AFXGuiCommand.__init__":
            command = of["method"]
            assert of["objectName"] == "voxelastica_cae.dialogs"
            sent[command] = []
        elif "Keyword.__init__" in path and of["command"]:
            sent[command].append(of["name"])
    assert sent == {name: parameters[name] for name in ("build_model", "extract_results")}
    # A file is picked for the design, the database and its design.
    picked = [of["pathNameTgt"] for path, of in calls if path == "AFXFileSelectorDialog.__init__"]
    assert len(picked) == 3 and sum(path == "abaqusGui.FXMAPFUNC" for path, _ in calls) >= 3
    assert {"ask_build()", "ask_extract()"} == {of["functionName"] for of in buttons[2:]}
    assert {"ask_build", "ask_extract"} <= set(parameters)
