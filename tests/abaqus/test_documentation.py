"""The figures of the ten-minute check in docs/abaqus.md are those of its design."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT, read_json, run
from decks.keywords import parse_deck

from .recording import SCRIPTS, Recorder

DOCUMENT = ROOT / "docs" / "abaqus.md"


@pytest.fixture(scope="module")
def check(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The design of the check."""
    folder = tmp_path_factory.mktemp("check") / "check"
    result = run("design", ROOT / "abaqus_scripts" / "check.toml", "-o", folder)
    assert result.code == 0, result.err
    return folder


@pytest.fixture(scope="module")
def lines() -> dict[int, str]:
    """Rows of the check's table by number."""
    rows = [line.split("|") for line in DOCUMENT.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    return {int(row[1]): row[3] for row in rows if row[1].strip().isdigit()}


def test_the_model_has_the_documented_size(check: Path, lines: dict[int, str], record: Recorder) -> None:
    document = read_json(check / "design.json")
    deck = parse_deck(check / "abaqus" / "voxel_solid.inp")
    (part,) = deck.parts.values()
    assert (
        f"{document['summary']['volume_mm3']['spoke_voxels']:.1f} mm^3; {len(part.element_ids) // 8} cells" in lines[3]
    )
    assert "{FLX9070} and {FLX9095} cells".format(**document["summary"]["voxels"]) in lines[4]
    elements, nodes = (f"{n:,}".replace(",", " ") for n in (len(part.element_ids), len(part.node_ids)))
    assert f"{elements} C3D8R" in lines[5] and f"{nodes} nodes" in lines[5]
    assert f"U1 = {document['morph_step']['rim_travel']['value']:.4f}" in lines[6]
    assert f"UR2 = {document['morph_step']['rim_rotation']['value']:.4f}" in lines[6]
    assert f"{len(deck.nset('MIDLINE'))} points" in lines[8]
    assert elements in lines[11]
    scope = {"exp": math.exp, "pow": math.pow, "__builtins__": {}}
    modulus = [eval(document["modulus_field"]["expression"], {**scope, "X": s / 10}) for s in range(401)]
    assert f"{modulus[0]:.2f} (rim) through {min(modulus):.2f} to {modulus[-1]:.2f} MPa (hub)" in lines[12]
    # What the message area says.
    built = record.build(check, "geometry")
    assert built.run.out.strip() == "Voxelastica: " + lines[2].split("*")[1] + " (geometry)"
    again = {"do": "dialog", "call": "build_model", "arguments": [str(check / "design.json"), "geometry"]}
    assert lines[14].split("*")[1] in record(again, again).out


def test_the_documented_results_are_those_of_the_finite_elements(check: Path, lines: dict[int, str]) -> None:
    assert run("verify", check).code == 0
    found, text = read_json(check / "verification.json"), DOCUMENT.read_text(encoding="utf-8")
    reactions = found["reactions"]
    for figure in (
        f"{found['max_error_percent']:.3f} % of L, H = {reactions['rim_horizontal_n']:.4f} N",
        f"M(0) = {reactions['rim_moment_nmm']:.2f} N mm, M(L) = {reactions['hub_moment_nmm']:.2f} N mm",
        f"height {found['midline_mm'][-1][2]:.2f} mm",
    ):
        assert figure in " ".join(text.split()), figure
    beam, plane = (
        read_json(check / "design.json")["summary"]["thrust"]["per_spoke"][k] for k in ("beam", "plane_strain")
    )
    assert f"H = {beam['horizontal_n']:.3f} N as a beam, {plane['horizontal_n']:.3f} N in plane strain" in " ".join(
        text.split()
    )
    assert "x = 25.465" in lines[8] and found["midline_mm"][-1][1] == pytest.approx(25.465, abs=5e-4)


def test_the_documented_number_of_calls(record: Recorder, designs: dict[str, Path]) -> None:
    model = record.build(designs["hemisphere"], "geometry")
    text = " ".join(DOCUMENT.read_text(encoding="utf-8").split())
    assert f"{len(model.run.calls):,} calls for the whole model".replace(",", " ") in text
    assert "326 questions for 67 000 voxels" in text


def test_the_estimate_needs_no_cae(check: Path) -> None:
    command = [sys.executable, "-B", SCRIPTS / "build_model.py", check / "design.json", "--estimate"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0] == "geometry: 1344 cells, 63 cuts, 66 questions"
    bad = subprocess.run([*command[:3], "none.json", "--estimate"], check=False, capture_output=True, text=True)
    assert bad.returncode == 2 and "none.json cannot be read" in bad.stdout


def test_every_file_of_the_plug_in_is_described() -> None:
    text = (ROOT / "abaqus_scripts" / "README.md").read_text(encoding="utf-8")
    for path in SCRIPTS.rglob("*.py"):
        assert path.name == "__init__.py" or path.name in text, path.name
