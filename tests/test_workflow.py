"""`workflow/`: the same table on this machine, on a real Slurm with faults, and by a stand-in for ABAQUS."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT, run

SNAKEMAKE = ROOT / ".venv-workflow" / "bin" / "snakemake"
NODES = ("vox1", "vox2")
BASE = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 40.0
hub_radius_mm = 4.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
[decks]
write = [{decks}]
"""

#: Forty points, eight of which the phases do not reach.
SWEEP = """
base = "base.toml"
model = "{model}"
{more}
[[axes]]
key = "target.aspect_ratio"
values = [0.7, 0.9, 1.0, 1.2, 6.0]
[[axes]]
key = "strips.hub_radius_mm"
from = 3.0
to = 9.0
count = 8
"""


@pytest.fixture(scope="session")
def snakemake() -> Path:
    if not SNAKEMAKE.is_file():
        pytest.skip("Snakemake is not there: scripts/setup-slurm installs it")
    return SNAKEMAKE


@pytest.fixture
def slurm() -> Iterator[None]:
    """A Slurm that answers, all nodes of which take jobs before and after."""
    found = shutil.which("sinfo") and subprocess.run(
        ["sinfo", "-h", "-N", "-o", "%N"], capture_output=True, text=True, timeout=30, check=False
    )
    if not found or not set(NODES) <= set(found.stdout.split()):
        pytest.skip("Slurm does not answer with the nodes of scripts/setup-slurm")
    node("resume", *NODES)
    yield
    node("resume", *NODES)


def node(state: str, *names: str) -> None:
    for name in names:
        subprocess.run(
            ["scontrol", "update", f"nodename={name}", f"state={state}", "reason=test"],
            capture_output=True,
            timeout=30,
            check=False,
        )


def write_sweep(folder: Path, model: str = "elastica", more: str = "", decks: str = "") -> Path:
    (folder / "base.toml").write_text(BASE.format(decks=decks), encoding="utf-8")
    sweep = folder / "points.toml"
    sweep.write_text(SWEEP.format(model=model, more=more), encoding="utf-8")
    return sweep


def command(snakemake: Path, folder: Path, profile: str, *config: object) -> list[str]:
    settings = [f"sweep={folder / 'points.toml'}", f"output={folder / 'out'}", *map(str, config)]
    workflow = ROOT / "workflow"
    return [
        str(snakemake),
        "-s",
        str(workflow / "Snakefile"),
        "--profile",
        str(workflow / "profiles" / profile),
        "--nocolor",
        "--config",
        *settings,
    ]


def executed(args: list[str], folder: Path, timeout: float = 300) -> subprocess.CompletedProcess[str]:
    return subprocess.run(args, cwd=folder, capture_output=True, text=True, timeout=timeout, check=False)


def direct(folder: Path) -> Path:
    """The table that one command writes."""
    result = run("sweep", folder / "points.toml", "-o", folder / "direct")
    assert result.code == 0, result.err
    return folder / "direct"


def same_tables(a: Path, b: Path) -> None:
    for name in ("results.csv", "results.parquet"):
        assert (a / name).read_bytes() == (b / name).read_bytes(), name


def test_local_jobs_write_the_table_of_one_command(snakemake: Path, program: Path, tmp_path: Path) -> None:
    write_sweep(tmp_path)
    args = command(snakemake, tmp_path, "local", f"program={program}", "batches=4")
    done = executed(args, tmp_path)
    assert done.returncode == 0, done.stderr[-3000:]
    same_tables(tmp_path / "out", direct(tmp_path))
    text = (tmp_path / "out" / "results.csv").read_text("utf-8")
    assert text.count(",infeasible,") == 8 and text.count(",ok,") == 32
    # There is nothing left to do, and nothing is done.
    before = (tmp_path / "out" / "results.csv").stat().st_mtime_ns
    again = executed(args, tmp_path)
    assert again.returncode == 0 and "Nothing to be done" in again.stderr
    assert (tmp_path / "out" / "results.csv").stat().st_mtime_ns == before
    # A lost table is gathered from the journals, and no point is computed again.
    journals = {path: path.read_bytes() for path in (tmp_path / "out" / "journal").iterdir()}
    (tmp_path / "out" / "results.csv").unlink()
    assert executed(args, tmp_path).returncode == 0
    same_tables(tmp_path / "out", tmp_path / "direct")
    assert {path: path.read_bytes() for path in (tmp_path / "out" / "journal").iterdir()} == journals


def test_a_sweep_on_slurm_outlives_a_drained_node_and_a_job_that_fails_once(
    slurm: None, snakemake: Path, program: Path, tmp_path: Path
) -> None:
    write_sweep(tmp_path)
    flag, wrapper = tmp_path / "failed-once", tmp_path / "wrapper"
    wrapper.write_text(
        "#!/bin/bash\n"
        f'if [[ "$*" == *"--batch 3/10"* && ! -e {flag} ]]; then touch {flag}; echo "made to fail" >&2; exit 9; fi\n'
        '[[ "$*" == *--batch* ]] && sleep 1\n'
        f'exec {program} "$@"\n',
        encoding="utf-8",
    )
    wrapper.chmod(0o755)
    args = command(snakemake, tmp_path, "slurm", f"program={wrapper}", "batches=10", "memory_mb=500")
    args += ["--slurm-init-seconds-before-status-checks", "3"]
    log = tmp_path / "snakemake.log"
    with log.open("w", encoding="utf-8") as out:
        running = subprocess.Popen(args, cwd=tmp_path, stdout=out, stderr=subprocess.STDOUT)
        try:
            finished = tmp_path / "out" / "workflow" / "batch"
            deadline = time.monotonic() + 240
            while running.poll() is None and len(list(finished.glob("*.done"))) < 2 and time.monotonic() < deadline:
                time.sleep(0.2)
            node("drain", "vox1")
            code = running.wait(timeout=480)
        finally:
            running.kill()
    said = log.read_text("utf-8")
    assert code == 0, said[-4000:]
    assert flag.exists() and "Error in rule batch" in said and "3of10" in said, said[-4000:]
    same_tables(tmp_path / "out", direct(tmp_path))


def test_without_a_scheduler_it_says_so_and_loses_nothing(snakemake: Path, program: Path, tmp_path: Path) -> None:
    write_sweep(tmp_path)
    assert run("sweep", tmp_path / "points.toml", "-o", tmp_path / "out", "--batch", "1/4").code == 0
    kept = {path: path.read_bytes() for path in (tmp_path / "out" / "journal").iterdir()}
    args = command(snakemake, tmp_path, "slurm", f"program={program}", "batches=4")
    tools = tmp_path / "tools"
    tools.mkdir()
    for path in Path("/usr/bin").iterdir():
        if path.name not in ("sacct", "sacctmgr", "sbatch", "scancel", "scontrol", "sinfo", "squeue", "srun"):
            (tools / path.name).symlink_to(path)
    environment = {**os.environ, "PATH": str(tools)}
    done = subprocess.run(args, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode != 0
    assert "sbatch, squeue, scancel cannot be found" in done.stderr and "Traceback" not in done.stderr
    assert {path: path.read_bytes() for path in kept} == kept
    assert not (tmp_path / "out" / "results.csv").exists()


@pytest.mark.parametrize(
    ("config", "words"),
    [
        (["sweep=none.toml"], "none.toml"),
        (["program=/nowhere/voxelastica"], "program = /nowhere/voxelastica is not there"),
        (["batch_minutes=-1"], "batch_minutes = -1"),
        (["bathces=3"], "bathces is no setting"),
    ],
)
def test_wrong_settings_are_named(
    snakemake: Path, program: Path, tmp_path: Path, config: list[str], words: str
) -> None:
    write_sweep(tmp_path)
    settings = [f"program={program}", *config]
    done = executed(command(snakemake, tmp_path, "local", *settings), tmp_path)
    assert done.returncode != 0 and words in done.stderr, done.stderr[-2000:]
    assert "Traceback" not in done.stderr


ABAQUS = """#!{python}
import json, os, sys, time
from pathlib import Path

tokens, failing = Path("{tokens}"), Path("{failing}")
if sys.argv[1] == "python":
    design = json.loads(Path(sys.argv[sys.argv.index("--design") + 1]).read_text())
    rows = design["predicted_midline_mm"]
    points = zip(rows["s"], rows["x"], rows["z"]) if isinstance(rows, dict) else rows
    text = "s_mm,x_mm,z_mm\\n" + "".join("%r,%r,%r\\n" % tuple(map(float, point)) for point in points)
    Path("point_midline.csv").write_text(text)
    sys.exit(0)
given = dict(argument.split("=") for argument in sys.argv[1:] if "=" in argument)
assert Path(given["input"]).is_file() and given["job"] == "point"
mine = tokens / str(os.getpid())
mine.touch()
time.sleep(0.3)
with (tokens / "seen").open("a") as seen:
    seen.write("%d\\n" % len([path for path in tokens.iterdir() if path.name.isdigit()]))
mine.unlink()
if Path.cwd().name == "5" and failing.exists():
    print("Abaqus Error: no licence")
    sys.exit(1)
Path("point.odb").touch()
"""


def test_abaqus_solves_points_with_its_tokens(snakemake: Path, program: Path, tmp_path: Path) -> None:
    write_sweep(tmp_path, "external", decks='"graded_solid"')
    tokens, failing, abaqus = tmp_path / "tokens", tmp_path / "failing", tmp_path / "abaqus"
    tokens.mkdir()
    failing.touch()
    abaqus.write_text(ABAQUS.format(python=sys.executable, tokens=tokens, failing=failing), encoding="utf-8")
    abaqus.chmod(0o755)
    settings = [f"program={program}", f"abaqus={abaqus}", "abaqus_deck=graded_solid", "batches=4", "tokens_per_job=8"]
    args = [*command(snakemake, tmp_path, "local", *settings), "--cores", "4", "--resources", "abaqus_tokens=20"]
    done = executed(args, tmp_path)
    assert done.returncode == 0, done.stderr[-3000:]
    # Twenty tokens let no more than two jobs of eight work at once.
    assert max(map(int, (tokens / "seen").read_text("ascii").split())) <= 2
    text = (tmp_path / "out" / "results.csv").read_text("utf-8")
    assert text.count(",ok,") == 31 and text.count(",infeasible,") == 8
    assert "abaqus ended with code 1: Abaqus Error: no licence" in text
    header = text.splitlines()[0].split(",")
    row = dict(zip(header, text.splitlines()[1].split(","), strict=True))
    # The stand-in returns what was predicted.
    assert float(row["max_error_percent"]) == pytest.approx(float(row["predicted_error_percent"]), abs=0.02)
    # With a licence the failed point is tried again, the others are kept.
    failing.unlink()
    solved = len((tokens / "seen").read_text("ascii").split())
    done = executed([*args, "-R", "abaqus_batch"], tmp_path)
    assert done.returncode == 0, done.stderr[-3000:]
    assert len((tokens / "seen").read_text("ascii").split()) == solved + 1
    assert (tmp_path / "out" / "results.csv").read_text("utf-8").count(",ok,") == 32
    lines = (tmp_path / "out" / "workflow" / "recorded.jsonl").read_text("utf-8").splitlines()
    assert [json.loads(line)["point"] for line in lines] == list(range(40))
