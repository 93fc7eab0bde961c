"""What the tests of the CAE plug-in share: abqpy's stubs, the table made from them, designs and recordings."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import EXAMPLES, ROOT, design, run
from .recording import SCRIPTS, Recorder
from .stubs import Stubs

VENV = Path(os.environ.get("VOXELASTICA_ABAQUS_VENV", ROOT / ".venv-abaqus"))


@pytest.fixture(scope="session")
def tools() -> Path:
    """The folder of programs of the environment with abqpy, pyright and vermin; a missing one is a counted skip."""
    if not (VENV / "bin" / "pyright").exists():
        pytest.skip("abqpy, pyright and vermin are not installed: run scripts/setup-abaqus")
    return VENV / "bin"


@pytest.fixture(scope="session")
def site(tools: Path) -> Path:
    """Where abqpy's stubs are."""
    found = sorted(tools.parent.glob("lib/python3*/site-packages/abaqus/Mdb"))
    assert found, f"{tools.parent} has no abqpy"
    return found[0].parent.parent


@pytest.fixture(scope="session")
def table(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The table of names, signatures and constants, made from abqpy's stubs."""
    path = tmp_path_factory.mktemp("stubs") / "table.json"
    path.write_text(json.dumps(Stubs(site).table()), encoding="utf-8")
    return path


def python27() -> str | None:
    """A Python 2.7, which ABAQUS up to 2023 has inside."""
    candidates = [os.environ.get("VOXELASTICA_PYTHON27"), shutil.which("python2.7")]
    candidates += sorted(map(str, Path.home().glob(".pyenv/versions/2.7*/bin/python2.7")))
    ask = "import sys; sys.exit(sys.version_info[:2] != (2, 7))"
    for found in filter(None, candidates):
        # A launcher without a Python behind it would be found too.
        if subprocess.run([found, "-c", ask], check=False, capture_output=True).returncode == 0:
            return found
    return None


@pytest.fixture(scope="session")
def record(table: Path, tmp_path_factory: pytest.TempPathFactory) -> Recorder:
    """Runs scenarios on the stand-in in this Python."""
    return Recorder(table, sys.executable, tmp_path_factory.mktemp("recordings"), SCRIPTS)


@pytest.fixture(scope="session")
def record27(table: Path, tmp_path_factory: pytest.TempPathFactory) -> Recorder:
    """Runs scenarios on the stand-in in Python 2.7; a missing one is a counted skip."""
    found = python27()
    if not found:
        pytest.skip("no Python 2.7 was found (VOXELASTICA_PYTHON27 names one)")
    return Recorder(table, found, tmp_path_factory.mktemp("recordings27"), SCRIPTS)


SMALL = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 40.0
hub_radius_mm = 4.0
thickness_mm = {thickness}
[thrust]
hub = "{hub}"
choice = "{choice}"
[materials]
phases = [{phases}]
[voxels]
size_mm = 1.0
pattern = "{pattern}"
[decks]
solvers = ["abaqus"]
"""


COUPON = """
[target]
kind = "strip"
width_mm = 12.0
rigid_fraction = 0.5
[strips]
length_mm = 40.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
pattern = "centred"
"""


def small(hub: str = "free", thickness: float = 2.0, pattern: str = "random", phases: str = "") -> str:
    """A small design as text."""
    choice = "least-contrast" if hub == "held" else "equal-ends"
    phases = phases or '"FLX9070", "FLX9095"'
    return SMALL.format(hub=hub, choice=choice, thickness=thickness, pattern=pattern, phases=phases)


@pytest.fixture(scope="session")
def designs(program: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Folders of designs by name: the paper's hemisphere and three more shapes, and small ones that differ in one thing."""
    root = tmp_path_factory.mktemp("cae")
    made = {}
    for name in ("hemisphere", "nose_cone", "three_phases", "rectangular_1"):
        result = run("design", EXAMPLES / f"{name}.toml", "-o", root / name)
        assert result.code == 0, result.err
        made[name] = root / name
    texts = {
        "held": small(hub="held"),
        "odd": small(thickness=3.0),
        "centred": small(pattern="centred"),
        "through": small(pattern="through-thickness"),
        "coupon": COUPON,
    }
    for name, text in texts.items():
        made[name] = design(text, root, name)
    return made
