"""The task panel in a real window under Xvfb."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import EXAMPLES, ROOT

from .conftest import MACRO


def test_the_panel_builds_and_tells_mistakes(program: Path, tmp_path: Path) -> None:
    for needed in ("freecad", "xvfb-run"):
        if not shutil.which(needed):
            pytest.skip(f"{needed} is not installed: scripts/setup-freecad")
    facts = tmp_path / "facts.json"
    environment = {
        **os.environ,
        "HOME": str(tmp_path),
        "VOXELASTICA_MACRO": str(MACRO),
        "VOXELASTICA_LIBRARY": str(ROOT / "target" / "release" / "libvoxelastica.so"),
        "VOXELASTICA_FACTS": str(facts),
        "VOXELASTICA_PICTURES": os.environ.get("VOXELASTICA_PICTURES", str(tmp_path)),
        "PANEL_DESIGN": str(EXAMPLES / "hemisphere.toml"),
        "QTWEBENGINE_DISABLE_SANDBOX": "1",
        "LIBGL_ALWAYS_SOFTWARE": "1",
    }
    script = Path(__file__).parent / "panel.py"
    command = ["xvfb-run", "-a", "-s", "-screen 0 1400x950x24", "freecad", str(script)]
    done = subprocess.run(
        command,
        check=False,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=600,
        stdin=subprocess.DEVNULL,
        env=environment,
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    found = json.loads(facts.read_text(encoding="utf-8"))
    print(found)
    assert found["title"] == "Voxelastica" and found["solve"]
    assert "9 solids" in found["message"] and "C3D8I" in found["message"] and ".step" in found["message"]
    # Pictures that show something: the shell's ramp of colours, two phases, bands.
    assert found["flower"] > 25 and found["phases"] >= 3 and found["analysis"] > 10
    assert "nowhere.toml" in found["error"] and found["documents"] == 1
    assert "is there already" in found["taken"] and found["objects_after"] == found["objects"]
