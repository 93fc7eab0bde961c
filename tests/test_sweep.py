"""`sweep`: points, journals, the table, and what it survives."""

from __future__ import annotations

import csv
import json
import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pyarrow.parquet
import pytest
from conftest import EXAMPLES, PROGRAM, run

AXES = """
[[axes]]
key = "target.aspect_ratio"
from = 0.5
to = 2.0
count = {count}
[[axes]]
key = "materials.phases"
values = [["FLX9070", "FLX9095"], ["FLX9095", "TangoBlack"], ["TangoBlack", "VeroClear"]]
"""


def sweep(folder: Path, text: str, name: str = "sweep") -> Path:
    """A sweep file over the hemisphere with coarse voxels."""
    base = (EXAMPLES / "hemisphere.toml").read_text(encoding="utf-8").replace("size_mm = 0.5", "size_mm = 1.0")
    (folder / "base.toml").write_text(base, encoding="utf-8")
    file = folder / f"{name}.toml"
    file.write_text(f'base = "base.toml"\n{text}', encoding="utf-8")
    return file


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def test_a_grid_has_every_combination_and_says_why_a_point_is_missing_figures(program: Path, tmp_path: Path) -> None:
    file = sweep(tmp_path, 'model = "elastica"\n' + AXES.format(count=4))
    out = tmp_path / "out"
    result = run("sweep", file, "-o", out)
    assert result.code == 0, result.err
    table = rows(out / "results.csv")
    assert [int(row["point"]) for row in table] == list(range(12))
    assert [float(row["target.aspect_ratio"]) for row in table[::3]] == pytest.approx([0.5, 1.0, 1.5, 2.0])
    # The stiffer phase first is no order that a design accepts.
    assert [row["status"] for row in table] == ["ok", "infeasible", "ok"] * 4
    assert all("softest" in row["reason"] and not row["rigidity_n_mm"] for row in table[1::3])
    # The point is the design's own answer.
    folder = tmp_path / "design"
    assert run("design", tmp_path / "base.toml", "-o", folder).code == 0
    assert run("indent", folder).code == 0
    record = json.loads((folder / "indentation" / "elastica_flat.json").read_text())
    for name in ("rigidity_n_mm", "tangent_n_mm", "specific_energy_nmm_mm3", "work_nmm"):
        assert float(table[3][name]) == pytest.approx(record[name], rel=1e-9)
    # The other table is the same.
    parquet = pyarrow.parquet.read_table(out / "results.parquet")
    assert parquet.column_names == list(table[0])
    for name in parquet.column_names:
        for ours, theirs in zip(parquet[name].to_pylist(), (row[name] for row in table), strict=True):
            if isinstance(ours, (int, float)):
                assert float(theirs) == pytest.approx(ours, rel=1e-9)
            else:
                assert (ours or "") == theirs
    assert list(out.glob("plots/*.svg"))
    described = json.loads((out / "sweep.json").read_text())
    assert described["status"] == {"ok": 8, "infeasible": 4, "failed": 0, "missing": 0}


def test_batches_and_one_run_give_the_same_bytes(program: Path, tmp_path: Path) -> None:
    file = sweep(tmp_path, 'model = "elastica"\noutputs = ["rigidity_n_mm"]\n' + AXES.format(count=5))
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    assert run("sweep", file, "-o", whole, "--threads", 1).code == 0
    for i in (3, 1):
        assert run("sweep", file, "-o", parts, "--batch", f"{i}/3").code == 0
    early = run("sweep", file, "-o", parts, "--gather")
    assert early.code == 2
    assert "5 of 15 points are missing, the first ones [1, 4, 7, 10, 13]" in early.err
    plan = json.loads(run("sweep", file, "-o", parts, "--plan").out)
    assert (plan["points"], plan["done"], plan["model"]) == (15, 10, "elastica")
    assert run("sweep", file, "-o", parts, "--gather", "--partial").code == 0
    assert sum(row["status"] == "missing" for row in rows(parts / "results.csv")) == 5
    assert run("sweep", file, "-o", parts, "--batch", "2/3").code == 0
    assert run("sweep", file, "-o", parts, "--gather").code == 0
    for name in ("results.csv", "results.parquet", "sweep.json"):
        assert (whole / name).read_bytes() == (parts / name).read_bytes()


def test_voxels_resolved_do_not_depend_on_the_number_of_cores(program: Path, tmp_path: Path) -> None:
    small = '[[axes]]\nkey = "strips.length_mm"\nvalues = [20.0]\n[[axes]]\nkey = "voxels.seed"\nvalues = [1, 2, 3]\n'
    file = sweep(tmp_path, f'model = "voxel"\n{small}')
    for threads in (1, 2):
        assert run("sweep", file, "-o", tmp_path / str(threads), "--threads", threads).code == 0
    one, two = ((tmp_path / str(n) / "results.csv").read_bytes() for n in (1, 2))
    assert one == two
    assert all(float(row["max_error_percent"]) > 0.0 for row in rows(tmp_path / "1" / "results.csv"))


def test_a_run_killed_ten_times_ends_with_the_same_table(program: Path, tmp_path: Path) -> None:
    axes = '[[axes]]\nkey = "target.aspect_ratio"\nfrom = 0.5\nto = 2.0\n[[axes]]\nkey = "strips.count"\nfrom = 5\nto = 12\n'
    text = 'model = "elastica"\n[sample]\nmethod = "latin-hypercube"\npoints = 400\nseed = 3\n' + axes
    file = sweep(tmp_path, text)
    undisturbed, killed = tmp_path / "undisturbed", tmp_path / "killed"
    assert run("sweep", file, "-o", undisturbed).code == 0
    dice = random.Random(1)
    journal = killed / "journal" / "batch-1-of-1.jsonl"
    kills = 0
    for _ in range(40):
        process = subprocess.Popen([PROGRAM, "sweep", file, "-o", killed], stdout=subprocess.DEVNULL)
        # Killed once some more of the journal is written, wherever that is.
        before = journal.stat().st_size if journal.exists() else 0
        goal = before + dice.randrange(20, 6000)
        while process.poll() is None and not (journal.exists() and journal.stat().st_size >= goal):
            time.sleep(0.001)
        if process.poll() is None:
            process.send_signal(signal.SIGKILL)
            kills += 1
        process.wait()
        if kills == 10:
            break
    assert kills == 10, "the sweep was over before it was killed ten times"
    half = journal.read_bytes().count(b"\n")
    last = run("sweep", file, "-o", killed)
    assert last.code == 0, last.err
    for name in ("results.csv", "results.parquet"):
        assert (undisturbed / name).read_bytes() == (killed / name).read_bytes()
    # No point was computed again that a whole line had kept.
    lines = [json.loads(line) for line in journal.read_bytes().splitlines()[1:] if line.endswith(b"}}")]
    assert len(lines) <= 400 + 10
    assert half > 10


def test_results_of_another_solver_are_taken_in(program: Path, tmp_path: Path) -> None:
    axes = '[[axes]]\nkey = "strips.count"\nvalues = [6, 8]\n'
    file = sweep(tmp_path, 'model = "external"\noutputs = ["contrast", "max_error_percent"]\n' + axes)
    out = tmp_path / "out"
    results = tmp_path / "results.jsonl"
    results.write_text('{"point": 1, "outputs": {"max_error_percent": 0.25}}\n{"point": 0, "failure": "no licence"}\n')
    assert run("sweep", file, "-o", out, "--record", results).code == 0
    assert run("sweep", file, "-o", out, "--gather").code == 0
    first, second = rows(out / "results.csv")
    assert (first["status"], first["reason"]) == ("failed", "no licence")
    assert (second["status"], second["max_error_percent"]) == ("ok", "0.25")
    assert float(second["contrast"]) > 1.0
    # A later answer replaces a failure.
    results.write_text('{"point": 0, "outputs": {"max_error_percent": 0.5}}\n')
    assert run("sweep", file, "-o", out, "--record", results).code == 0
    assert run("sweep", file, "-o", out, "--gather").code == 0
    assert rows(out / "results.csv")[0]["max_error_percent"] == "0.5"
    results.write_text('{"point": 7, "outputs": {"max_error_percent": 0.5}}\n')
    wrong = run("sweep", file, "-o", out, "--record", results)
    assert wrong.code == 2
    assert "results.jsonl: line 1: point 7 of 2" in wrong.err


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            '[[axes]]\nkey = "target.aspect_rato"\nvalues = [1.0]\n',
            ["sweep.toml:3", "aspect_rato", "target.aspect_ratio"],
        ),
        (
            '[[axes]]\nkey = "target.aspect_ratio"\nfrom = 1.0\nto = 1.0\ncount = 3\n',
            ["sweep.toml:5", "axes.0.to", "empty"],
        ),
        ('[[axes]]\nkey = "target.aspect_ratio"\nfrom = 1.0\nto = 2.0\n', ["count"]),
        ('[[axes]]\nkey = "target.aspect_ratio"\nvalues = []\n', ["needs a value"]),
        ('[[axes]]\nkey = "target.aspect_ratio"\nvalues = [-1.0]\n', ["-1", "target.aspect_ratio"]),
        ('[[axes]]\nkey = "target.file"\nvalues = ["a.obj"]\n', ["does not apply"]),
        ('model = "magic"\n[[axes]]\nkey = "strips.count"\nvalues = [6]\n', ["magic"]),
        (
            'outputs = ["contrst"]\n[[axes]]\nkey = "strips.count"\nvalues = [6]\n',
            ["sweep.toml:2", "contrst", "contrast"],
        ),
        ('outputs = ["rigidity_n_mm"]\n[[axes]]\nkey = "strips.count"\nvalues = [6]\n', ["no such figure"]),
        ("axis = 3\naxes = []\n", ["axis", "axes"]),
        (
            '[[axes]]\nkey = "strips.count"\nvalues = [6]\n[[plots]]\nx = "a"\ny = "contrast"\n',
            ["plots.0.x", "no such column"],
        ),
    ],
)
def test_a_wrong_sweep_names_file_key_and_value(program: Path, tmp_path: Path, text: str, says: list[str]) -> None:
    result = run("sweep", sweep(tmp_path, text), "-o", tmp_path / "out")
    assert result.code == 2, result.err
    for part in ["sweep.toml", *says]:
        assert part in result.err
    assert not (tmp_path / "out").exists()


def test_ten_million_points_are_estimated_and_refused(program: Path, tmp_path: Path) -> None:
    axes = "".join(
        f'[[axes]]\nkey = "{key}"\nfrom = {low}\nto = {high}\ncount = {count}\n'
        for key, low, high, count in [
            ("target.aspect_ratio", 0.5, 2.0, 10000),
            ("strips.hub_radius_mm", 5.0, 20.0, 1000),
        ]
    )
    result = run("sweep", sweep(tmp_path, axes), "-o", tmp_path / "out")
    assert result.code == 2
    assert "10000000 points take about" in result.err
    assert "--yes" in result.err
    assert not (tmp_path / "out" / "results.csv").exists()


def test_a_journal_of_another_sweep_is_left_alone(program: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    first = sweep(tmp_path, '[[axes]]\nkey = "strips.count"\nvalues = [6, 8]\n')
    assert run("sweep", first, "-o", out).code == 0
    before = (out / "journal" / "batch-1-of-1.jsonl").read_bytes()
    other = sweep(tmp_path, '[[axes]]\nkey = "strips.count"\nvalues = [6, 9]\n', "other")
    result = run("sweep", other, "-o", out)
    assert result.code == 2
    assert "another sweep" in result.err
    assert (out / "journal" / "batch-1-of-1.jsonl").read_bytes() == before


def test_a_full_disk_loses_nothing(program: Path, tmp_path: Path) -> None:
    if os.geteuid() != 0 or not shutil.which("mount"):
        pytest.skip("only root can mount a small disk")
    disk = tmp_path / "disk"
    disk.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)]
    if subprocess.run(command, check=False, capture_output=True).returncode != 0:
        pytest.skip("a tmpfs cannot be mounted here")
    try:
        axes = '[[axes]]\nkey = "target.aspect_ratio"\nfrom = 0.5\nto = 2.0\ncount = 600\n'
        file = sweep(tmp_path, f'model = "design"\n{axes}')
        full = run("sweep", file, "-o", disk / "out")
        assert full.code == 5
        assert "disk is full" in full.err
        kept = (disk / "out" / "journal" / "batch-1-of-1.jsonl").read_bytes().count(b"\n") - 1
        assert kept > 10
        shutil.copytree(disk / "out", tmp_path / "out")
    finally:
        subprocess.run(["umount", str(disk)], check=True)
    result = run("sweep", file, "-o", tmp_path / "out")
    assert result.code == 0, result.err
    known = int(result.out.split(" were known")[0].split("; ")[-1])
    assert known >= kept - 1
    assert sum(row["status"] == "ok" for row in rows(tmp_path / "out" / "results.csv")) == 600
