"""`optimise`: the best design under limits, what it writes, and what it refuses."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from conftest import read_json, run

BASE = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 60.0
hub_radius_mm = 6.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
[decks]
write = []
[fabrication]
scope = "flower"
"""

VARIABLES = """
[[variables]]
key = "strips.count"
from = 6
to = 9
[[variables]]
key = "strips.hub_radius_mm"
from = 3.0
to = 20.0
"""


def optimise(folder: Path, text: str, *options: object):
    (folder / "base.toml").write_text(BASE, encoding="utf-8")
    file = folder / "best.toml"
    file.write_text(f'base = "base.toml"\n{text}{VARIABLES}', encoding="utf-8")
    return run("optimise", file, "-o", folder / "out", *options)


def test_the_optimum_is_a_design_and_says_what_binds(program: Path, tmp_path: Path) -> None:
    limits = 'maximise = "rigidity_n_mm"\nevaluations = 60\n[limits]\nprinter_volume_mm = [150, 150, 100]\n'
    result = optimise(tmp_path, limits)
    assert result.code == 0, result.err
    assert "limit     printer_volume_mm" in result.out and "binds: 5 % more of it gives" in result.out
    record = read_json(tmp_path / "out" / "optimise.json")
    assert record["schema"] == "voxelastica/optimise/1" and record["evaluations"] <= 60
    best = record["best"]
    bound = next(limit for limit in best["limits"] if limit["limit"] == "printer_volume_mm")
    assert bound["binds"] and bound["value"] <= bound["most"] and bound["gain_if_relaxed"] > 0
    with (tmp_path / "out" / "evaluations.csv").open(newline="", encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == record["evaluations"]
    kept = [float(row["rigidity_n_mm"]) for row in rows if not row["refused"]]
    assert len(kept) == record["feasible"] and max(kept) == pytest.approx(best["objective"], rel=1e-9)
    assert any("limits.printer_volume_mm" in row["refused"] for row in rows)
    # What `design` and `indent` make of it is what was promised.
    folder = tmp_path / "design"
    assert run("design", tmp_path / "out" / "optimum.toml", "-o", folder).code == 0
    assert read_json(folder / "design.json")["design"]["strips"]["count"] == best["values"]["strips.count"]
    assert run("indent", folder).code == 0
    found = read_json(folder / "indentation" / "elastica_flat.json")
    # The search goes no deeper than the thickness, with steps of its own.
    assert found["rigidity_n_mm"] == pytest.approx(best["figures"]["rigidity_n_mm"], rel=0.01)
    # Again, on one thread: the same.
    before = (tmp_path / "out" / "evaluations.csv").read_bytes()
    assert optimise(tmp_path, limits, "--threads", 1).code == 0
    assert (tmp_path / "out" / "evaluations.csv").read_bytes() == before


def test_no_design_keeps_the_limits(program: Path, tmp_path: Path) -> None:
    result = optimise(tmp_path, 'maximise = "rigidity_n_mm"\nevaluations = 20\n[limits]\nlargest_strain = 1e-6\n')
    assert result.code == 3
    assert "no design keeps all limits" in result.err and "20 designs: limits.largest_strain" in result.err
    assert not (tmp_path / "out" / "optimum.toml").exists()
    assert read_json(tmp_path / "out" / "optimise.json")["best"] is None


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('maximise = "beauty"\n', "beauty"),
        ('maximise = "printability"\nevaluations = 1\n', "best.toml:3: evaluations = 1"),
        ('maximise = "printability"\n[limits]\nhub_force_n = 0\n', "limits.hub_force_n = 0"),
        ('maximise = "printability"\n[[variables]]\nkey = "strips.cuont"\nfrom = 1\nto = 2\n', "strips.count"),
    ],
)
def test_bad_files_are_refused(program: Path, tmp_path: Path, text: str, words: str) -> None:
    result = optimise(tmp_path, text)
    assert result.code == 2 and words in result.err, result.err
    assert not (tmp_path / "out").exists()


def test_a_base_that_is_not_there(program: Path, tmp_path: Path) -> None:
    file = tmp_path / "best.toml"
    file.write_text(f'base = "none.toml"\nmaximise = "printability"\n{VARIABLES}', encoding="utf-8")
    result = run("optimise", file)
    assert result.code == 2 and "none.toml" in result.err
