"""`indent`: a dome under load, its files, and what it refuses."""

from __future__ import annotations

import csv
from pathlib import Path
from xml.etree import ElementTree

import pytest
from conftest import design, read_json, run
from decks.keywords import check_deck

DOME = """
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
write = []
{more}
"""


def test_all_models_press_the_same_dome(program: Path, tmp_path: Path) -> None:
    folder = design(
        DOME.format(more="calculix_graded_elements = [24, 4, 2]\n[indentation]\ndepth_mm = 3.0\nsteps = 12"), tmp_path
    )
    found = {}
    for model in ("elastica", "graded", "voxel"):
        for indenter in ("flat", "hub"):
            result = run("indent", folder, "--model", model, "--indenter", indenter, "--ignore-neighbours")
            assert result.code == 0, result.err
            record = read_json(folder / "indentation" / f"{model}_{indenter}.json")
            assert record["schema"] == "voxelastica/indentation/1"
            assert (record["model"], record["indenter"], record["spokes"]) == (model, indenter, 8)
            assert record["curve"][-1]["depth_mm"] == pytest.approx(3.0)
            with (folder / "indentation" / f"{model}_{indenter}.csv").open(newline="") as lines:
                rows = list(csv.DictReader(lines))
            assert len(rows) == 13
            for row, point in zip(rows, record["curve"], strict=True):
                assert float(row["force_n"]) == pytest.approx(point["force_n"], rel=1e-9, abs=1e-12)
                assert float(row["force_high_n"]) == pytest.approx(1.1 * point["force_n"], rel=1e-9, abs=1e-12)
            found[model, indenter] = record
    # The solids are softer (voxels) or stiffer (plane strain) than beams, but not another thing.
    for indenter in ("flat", "hub"):
        beam = found["elastica", indenter]["rigidity_n_mm"]
        for model, low, high in (("graded", 0.9, 1.1), ("voxel", 0.7, 1.1)):
            ratio = found[model, indenter]["rigidity_n_mm"] / beam
            assert low < ratio < high, (model, indenter, ratio)
    # The picture has every curve of this design, of all runs.
    picture = ElementTree.parse(folder / "indentation" / "curves.svg").getroot()
    texts = {"".join(e.itertext()) for e in picture.iter() if e.tag.endswith("text")}
    assert {f"{model}, {indenter}" for model, indenter in found} <= texts
    # What is the same is written the same.
    before = (folder / "indentation" / "elastica_flat.json").read_bytes()
    assert run("indent", folder).code == 0
    assert (folder / "indentation" / "elastica_flat.json").read_bytes() == before


def test_what_cannot_be_pressed_is_refused(program: Path, tmp_path: Path) -> None:
    folder = design(DOME.format(more=""), tmp_path)
    for options, says in [
        (["--depth", "100"], ["indentation.depth_mm", "100", "height"]),
        (["--depth", "0"], ["indentation.depth_mm", "0"]),
        (["--steps", "1"], ["indentation.steps", "1"]),
    ]:
        result = run("indent", folder, *options)
        assert result.code == 2, result.err
        assert all(part in result.err for part in says), result.err
    assert not (folder / "indentation").exists()
    strip = design(
        '[target]\nkind = "strip"\nwidth_mm = 12.0\nmodulus_ratio = 2.0\nshortening = 0.5\n[strips]\nlength_mm = 40.0\n'
        'thickness_mm = 2.0\n[materials]\nphases = ["FLX9070", "FLX9095"]\n[voxels]\nsize_mm = 1.0\n[decks]\nwrite = []\n',
        tmp_path,
        "strip",
    )
    result = run("indent", strip)
    assert result.code == 2
    assert "target.kind" in result.err
    missing = run("indent", tmp_path / "nothing")
    assert missing.code == 2
    assert "design.json" in missing.err


def test_calculix_presses_the_same_dome(ccx: str, program: Path, tmp_path: Path) -> None:
    more = "calculix_graded_elements = [24, 4, 2]\n[indentation]\ndepth_mm = 2.0\nsteps = 8"
    folder, keep = design(DOME.format(more=more), tmp_path), tmp_path / "kept"
    result = run("indent", folder, "--model", "calculix", "--keep", keep, "--ccx", ccx)
    assert result.code == 0, result.err
    found = read_json(folder / "indentation" / "calculix_flat.json")
    assert run("indent", folder, "--model", "graded", "--ignore-neighbours").code == 0
    inside = read_json(folder / "indentation" / "graded_flat.json")
    assert found["model"] == "calculix" and len(found["curve"]) == 9
    for figure, share in (("rigidity_n_mm", 0.02), ("tangent_n_mm", 0.02), ("volume_mm3", 1e-9)):
        assert found[figure] == pytest.approx(inside[figure], rel=share), figure
    assert found["work_nmm"] == pytest.approx(found["strain_energy_nmm"], rel=0.01)
    assert found["largest_strain"][0]["strain"] == pytest.approx(inside["largest_strain"][0]["strain"], rel=0.05)
    # What was solved is kept, and is the deck that a design file asks for.
    assert (keep / "job.dat").stat().st_size > 0
    assert check_deck(keep / "graded_solid_indentation.inp", dialect="calculix") == []


def test_without_calculix_nothing_is_written(program: Path, tmp_path: Path) -> None:
    folder = design(DOME.format(more=""), tmp_path)
    result = run("indent", folder, "--model", "calculix", "--ccx", tmp_path / "nowhere")
    assert result.code == 4 and "not found" in result.err and "--ccx" in result.err
    result = run("indent", folder, "--model", "calculix", "--depth", 1000)
    assert result.code == 2 and "depth_mm" in result.err
    assert not (folder / "indentation").exists()
