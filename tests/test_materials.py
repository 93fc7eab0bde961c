"""`materials fit`: from tensile curves to a material that a design takes."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from conftest import ROOT, design, read_json, run

CURVES = [ROOT / "examples" / "materials" / f"resin_{i}.csv" for i in (1, 2, 3)]
#: What the example's curves were made from.
MODULI, YIELDS = (1010.0, 955.0, 1042.0), (21.5, 20.4, 22.1)
FIT = ("materials", "fit", "--name", "my resin", "--poisson", 0.35)

DOME = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 40.0
hub_radius_mm = 4.0
thickness_mm = 2.0
[materials]
phases = ["soft resin", "my resin"]
[voxels]
size_mm = 1.0
[decks]
write = []
[[materials.custom]]
name = "soft resin"
modulus_mpa = 250.0
poisson = 0.35
modulus_scatter_percent = 8.0
"""


def test_a_fitted_material_designs_a_dome_and_bounds_its_strains(program: Path, tmp_path: Path) -> None:
    tomllib = pytest.importorskip("tomllib")
    result = run(*FIT, *CURVES)
    assert result.code == 0, result.err
    (material,) = tomllib.loads(result.out)["materials"]["custom"]
    mean = sum(MODULI) / 3
    deviation = (sum((e - mean) ** 2 for e in MODULI) / 2) ** 0.5
    assert material["modulus_mpa"] == pytest.approx(mean, rel=0.03)
    assert material["modulus_scatter_percent"] == pytest.approx(100 * deviation / mean, rel=0.15)
    assert material["yield_strength_mpa"] == pytest.approx(sum(YIELDS) / 3, rel=0.03)
    assert material["name"] == "my resin" and material["poisson"] == 0.35
    assert "1 rows after it left out" in result.err

    folder = design(DOME + result.out, tmp_path)
    assert run("indent", folder, "--depth", 4).code == 0
    record = read_json(folder / "indentation" / "elastica_flat.json")
    assert record["modulus_band_from"] == "modulus_scatter_percent"
    assert material["modulus_scatter_percent"] < record["modulus_band_percent"] < 8.0
    strain = record["largest_strain"][0]
    assert strain["yield_strain"] == material["yield_strain"]
    assert any("yield_strain" in text for text in record["warnings"]) == (strain["strain"] > strain["yield_strain"])
    # What the design file says wins.
    assert run("indent", folder, "--modulus-band", 5).code == 0
    record = read_json(folder / "indentation" / "elastica_flat.json")
    assert (record["modulus_band_percent"], record["modulus_band_from"]) == (5.0, "modulus_band_percent")


def test_force_and_extension_with_the_specimens_size(program: Path, tmp_path: Path) -> None:
    rows = "".join(f"{0.05 * i},{0.02 * i}\n" for i in range(200))
    table = tmp_path / "raw.csv"
    table.write_text("Extension [mm],Load (kN)\n" + rows, encoding="utf-8")
    sizes = ("--gauge-length-mm", 50, "--area-mm2", 40)
    made = tmp_path / "resin.toml"
    result = run(*FIT, table, *sizes, "-o", made)
    # 0.02 kN over 40 mm^2 a strain of 0.001.
    assert result.code == 0 and "modulus_mpa = 500.0" in made.read_text("utf-8"), result.err
    assert "yield" not in made.read_text("utf-8")
    for missing, key in ((sizes[:2], "area_mm2"), (sizes[2:], "gauge_length_mm")):
        result = run(*FIT, table, *missing)
        assert result.code == 2 and key in result.err and result.out == ""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "this file is empty"),
        ("0,0\n1,1\n", "does not name the columns"),
        ("strain,stress_mpa\n0,0\n0.1,x\n", "t.csv:3: stress_mpa = x: this is not a number"),
        ("strain,stress_mpa\n0,0\n0.1,1\n0.05,2\n0.2,3\n", "t.csv:4: strain = 0.05: the strain falls"),
        ("strain,load_n\n0,0\n", "area_mm2"),
    ],
)
def test_bad_tables_are_refused(program: Path, tmp_path: Path, text: str, words: str) -> None:
    table = tmp_path / "t.csv"
    table.write_text(text, encoding="utf-8")
    made = tmp_path / "made.toml"
    result = run(*FIT, table, "-o", made)
    assert result.code == 2 and words in result.err, result.err
    assert not made.exists()


def test_what_is_missing_and_what_cannot_be_written(program: Path, tmp_path: Path) -> None:
    result = run(*FIT, tmp_path / "none.csv")
    assert result.code == 2 and "none.csv" in result.err
    result = run(*FIT, *CURVES, "-o", tmp_path / "no" / "where.toml")
    assert result.code == 5 and "where.toml" in result.err
    assert os.listdir(tmp_path) == []
    assert "FLX9095" in run("materials").out
