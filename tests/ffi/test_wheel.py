"""The wheel: holds the library, loads in a fresh environment, needs no newer glibc than its tag says."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from .conftest import ROOT, tool


@pytest.mark.skipif(not os.environ.get("VOXELASTICA_LONG"), reason="builds the library again; with scripts/test --long")
def test_the_wheel_loads_in_a_fresh_environment(tmp_path: Path) -> None:
    tool("cargo-zigbuild")
    done = subprocess.run(
        [sys.executable, ROOT / "scripts" / "wheel", tmp_path], check=False, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    wheel = Path(done.stdout.split()[-1])
    assert wheel.name.endswith("-py3-none-manylinux_2_17_x86_64.whl")
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {"voxelastica/libvoxelastica.so", "voxelastica/py.typed", "voxelastica/__init__.py"} <= names
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    python = tmp_path / "venv" / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-index", wheel], check=True)
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("VOXELASTICA", "PYTHONPATH"))}
    said = subprocess.run(
        [python, "-c", "import voxelastica as v; print(v.__version__, v._LIBRARY.path)"],
        check=True,
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=environment,
    ).stdout
    assert str(tmp_path / "venv") in said
