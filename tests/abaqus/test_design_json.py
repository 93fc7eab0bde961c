"""What design.json says for hosts that build the model themselves, against the deck of the same design."""

from __future__ import annotations

from pathlib import Path

import pytest

from conftest import design, read_json
from decks.keywords import parse_deck

from .conftest import small


@pytest.mark.parametrize("name", ["held", "centred", "odd", "through"])
def test_the_listed_phases_are_those_of_the_decks_elements(designs: dict[str, Path], name: str) -> None:
    """Every element's centre lies in a voxel of its phase."""
    document = read_json(designs[name] / "design.json")
    deck = parse_deck(designs[name] / "abaqus" / "voxel_solid.inp")
    voxels, halves = document["voxels"], document["slices"]["half_width_voxels"]
    edge, layers, thickness = voxels["size_mm"], voxels["layers"], document["design"]["strips"]["thickness_mm"]
    (part,) = deck.parts.values()
    points = part.points()
    of_phase = {phase["label"]: str(k) for k, phase in enumerate(document["phases"])}
    phase_of = {}
    for label, digit in of_phase.items():
        found = part.elsets.get(f"PHASE-{label}")
        phase_of.update((number, digit) for number in (found.members if found else ()))
    seen = 0
    for block in part.elements:
        for number, nodes in block.rows():
            x, y, z = (sum(points[n][a] for n in nodes) / len(nodes) for a in range(3))
            i, layer = int(x // edge), int((z + thickness / 2) // edge)
            across = int(y // edge) + halves[i]
            assert voxels["phases"][i][layer * 2 * halves[i] + across] == phase_of[number], (x, y, z)
            seen += 1
    assert seen == sum(2 * half for half in halves) * layers * 8
    digits = "".join(voxels["phases"])
    assert {label: digits.count(digit) for label, digit in of_phase.items()} == document["summary"]["voxels"]


def test_phases_are_named_as_the_decks_name_them(tmp_path: Path) -> None:
    """A label that begins with a digit is no name of a material."""
    custom = '[[materials.custom]]\nname = "9 %"\nmodulus_mpa = 12.6\npoisson = 0.4\n'
    text = small(phases='"FLX9070", "9 %"') + custom
    folder = design(text, tmp_path, "digits")
    document = read_json(folder / "design.json")
    deck = parse_deck(folder / "abaqus" / "voxel_solid.inp")
    assert [phase["material"] for phase in document["phases"]] == ["FLX9070", f"M_{document['phases'][1]['label']}"]
    assert set(deck.materials) == {phase["material"] for phase in document["phases"]}


def test_very_many_voxels_are_not_listed(tmp_path: Path) -> None:
    text = small().replace("size_mm = 1.0", "size_mm = 0.1").replace('solvers = ["abaqus"]', "write = []")
    document = read_json(design(text, tmp_path, "fine") / "design.json")
    assert document["summary"]["voxels_per_spoke"] > 1 << 20
    assert document["voxels"]["phases"] is None and document["voxels"]["layers"] == 20


def test_a_strip_that_is_stretched_has_a_step_too(designs: dict[str, Path]) -> None:
    step = read_json(designs["coupon"] / "design.json")["morph_step"]
    assert step["rim_travel"]["value"] == pytest.approx(-0.4) and step["hub_height"]["value"] == 0
    assert read_json(designs["rectangular_1"] / "design.json")["morph_step"]["initial_bow_mm"] == pytest.approx(0.2)
