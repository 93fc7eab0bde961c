"""The Blender add-on, installed from its zip into Blender 5.0 and 4.2 LTS; the scripts of ``inside`` run there."""

from __future__ import annotations

import tomllib
import zipfile
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
Blender = Callable[..., str]


def test_the_zip_holds_what_it_says(addon_zip: Path) -> None:
    assert addon_zip.name.endswith("linux_x64.zip")
    with zipfile.ZipFile(addon_zip) as archive:
        names = archive.namelist()
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"] and list(manifest["permissions"]) == ["files"]
    assert manifest["schema_version"] == "1.0.0" and manifest["platforms"] == ["linux-x64"]
    assert sum(name.endswith(".whl") for name in names) == 1 and len(manifest["wheels"]) == 1
    assert sum(name.startswith("presets/") and name.endswith(".toml") for name in names) == 4
    assert not any("__pycache__" in name or name.endswith((".so", ".pyc")) for name in names)
    version = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]
    assert manifest["version"] == version


def test_logic_needs_no_blender_and_nothing_reaches_out() -> None:
    sources = list((ROOT / "blender_addon").rglob("*.py"))
    assert len(sources) > 20
    for source in sources:
        text = source.read_text(encoding="utf-8")
        assert text.startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n"), source
        for word in ("subprocess", "os.system", "urllib", "socket", "requests", "pip", "ctypes", "shell="):
            assert f"import {word}" not in text and f"{word}(" not in text, (source, word)
        if source.parent.name == "logic":
            assert "import bpy" not in text, source


def test_it_installs_and_leaves_nothing_behind(blender: Blender) -> None:
    blender("install.py")


def test_properties_are_the_tables_and_designs_the_command_lines(blender: Blender, program: Path) -> None:
    blender("properties.py", program, ROOT / "examples")


def test_a_modelled_dome_is_a_target(blender: Blender) -> None:
    blender("mesh_target.py")


def test_each_error_is_a_message_and_nothing_is_lost(blender: Blender) -> None:
    blender("errors.py")


def test_designs_live_in_files(blender: Blender) -> None:
    blender("files.py")


def test_the_preview_is_the_design(blender: Blender) -> None:
    blender("shapes.py")


def test_solvers_run_beside_blender(blender: Blender) -> None:
    blender("solve.py")


def test_designs_are_refined_and_conduct(blender: Blender) -> None:
    blender("refine_conduct.py")


def test_speed(blender: Blender) -> None:
    blender("speed.py")


def test_without_the_library(blender: Blender, tmp_path: Path) -> None:
    for stage in ("with", "without", "again"):
        blender("no_library.py", stage, tmp_path / "kept.blend")


def test_disks_that_cannot_be_written_to(blender: Blender, disks: tuple[Path, Path]) -> None:
    blender("disks.py", *disks)


def test_workbench_draws_it(blender: Blender) -> None:
    blender("render.py")
