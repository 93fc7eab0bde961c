"""The task panel in a real window under Xvfb."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest
from conftest import EXAMPLES

from .conftest import Host

PANEL = Path(__file__).parent / "panel.py"


def test_the_panel_builds_and_tells_mistakes(host: Host, tmp_path: Path) -> None:
    if not shutil.which("xvfb-run"):
        pytest.skip("xvfb-run is not installed: scripts/setup-freecad")
    place = Path("/usr/bin/freecad") if host.chroot is None else host.chroot / "usr/bin/freecad"
    if not os.path.lexists(place):
        pytest.skip(f"{place} is not there: scripts/setup-freecad")
    # Once is enough: it takes a while.
    solves = host.chroot is None and shutil.which("ccx") is not None
    facts = tmp_path / "facts.json"
    result = host.run(
        PANEL,
        window=True,
        VOXELASTICA_FACTS=facts,
        VOXELASTICA_PICTURES=tmp_path,
        PANEL_DESIGN=EXAMPLES / "hemisphere.toml",
        PANEL_SOLVE="1" if solves else "",
    )
    assert result.code == 0, result.out[-3000:] + result.err[-3000:]
    if kept := os.environ.get("VOXELASTICA_PICTURES"):
        # To be looked at.
        for picture in tmp_path.glob("*.png"):
            Path(kept).mkdir(parents=True, exist_ok=True)
            shutil.copy(picture, Path(kept) / f"{host.version}-{picture.name}")
    found = json.loads(facts.read_text(encoding="utf-8"))
    print(host.version, found)
    assert found["title"] == "Voxelastica" and found["solve"]
    assert "9 solids" in found["message"] and "C3D8I" in found["message"] and ".step" in found["message"]
    # Pictures that show something: the shell's ramp of colours, two phases, bands.
    assert found["flower"] > 25 and found["phases"] >= 3 and found["analysis"] > 10
    assert "nowhere.toml" in found["error"] and found["documents"] == 1
    assert "is there already" in found["taken"] and found["objects_after"] == found["objects"]
    if solves:
        assert "solved: largest distance" in found["solved"] and "midline.csv" in found["solved"]
