"""The panel in a real window; a Blender with windows and extensions is needed (scripts/setup-blender-window)."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_the_panel_in_a_window(addon_zip: Path, tmp_path: Path) -> None:
    root = Path(os.environ.get("VOXELASTICA_BLENDER_WINDOW", ROOT / ".blender-window"))
    if not (root / "usr" / "bin" / "blender").exists():
        pytest.skip("no Blender with windows is installed: scripts/setup-blender-window")
    if os.geteuid() != 0:
        pytest.skip("a window is opened in a chroot, which needs root")
    command = [ROOT / "tests" / "blender" / "window" / "run", addon_zip, tmp_path, root]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=900)
    said = done.stdout + done.stderr
    for what, names in (
        ("work", ("empty", "panel", "problem", "verified", "voxels", "mesh")),
        ("panels", ("all_1", "all_2", "running", "results")),
    ):
        assert (tmp_path / f"found_{what}.json").exists(), said
        found = json.loads((tmp_path / f"found_{what}.json").read_text(encoding="utf-8"))
        assert "error" not in found, found["error"]
        assert found["done"], found
        for name in names:
            assert (tmp_path / f"{name}.png").stat().st_size > 20_000, name
