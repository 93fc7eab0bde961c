"""What the tests of the Blender add-on share: the built zip, and Blender itself as a Python module."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
INSIDE = Path(__file__).resolve().parent / "inside"
VERSIONS = ("5.0", "4.2")

_report: list[str] = []


def python_of(version: str) -> Path:
    """The environment of a version of Blender; a missing one is a counted skip."""
    found = ROOT / f".venv-blender-{version}" / "bin" / "python"
    if not found.exists():
        pytest.skip(f"Blender {version} is not installed: scripts/setup-blender")
    return found


@pytest.fixture(scope="session")
def addon_zip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The extension, built and validated by Blender's own tool, with this machine's library."""
    if not any((ROOT / f".venv-blender-{version}").exists() for version in VERSIONS):
        pytest.skip("no Blender is installed whose tool builds extensions: scripts/setup-blender")
    folder = tmp_path_factory.mktemp("extension")
    command = [sys.executable, ROOT / "scripts" / "build-blender-addon", "--local", "-o", folder]
    built = subprocess.run(command, check=False, capture_output=True, text=True, timeout=600)
    assert built.returncode == 0, built.stderr
    assert "Success parsing TOML" in built.stderr
    return Path(built.stdout.strip().splitlines()[-1])


@pytest.fixture(params=VERSIONS)
def blender(request: pytest.FixtureRequest, addon_zip: Path, tmp_path: Path) -> Callable[..., str]:
    """Runs a script of ``inside`` in a version of Blender, with settings of its own and the extension installed."""
    version = request.param
    python = python_of(version)

    def run(script: str, *arguments: object, prefix: tuple[str, ...] = (), **environment: str) -> str:
        resources = tmp_path / "resources"
        resources.mkdir(exist_ok=True)
        own = {"BLENDER_USER_RESOURCES": str(resources), "ADDON_ZIP": str(addon_zip), "PYTHONPATH": "", **environment}
        # The extension finds its own library, not one that other tests name.
        inherited = {key: value for key, value in os.environ.items() if key != "VOXELASTICA_LIBRARY"}
        command = [*prefix, str(python), str(INSIDE / script), *map(str, arguments)]
        done = subprocess.run(
            command,
            check=False,
            capture_output=True,
            text=True,
            timeout=900,
            cwd=tmp_path,
            env={**inherited, **own},
            stdin=subprocess.DEVNULL,
        )
        said = done.stdout + done.stderr
        assert done.returncode == 0, said
        assert "Traceback" not in said, said
        assert "\nDONE" in "\n" + done.stdout, said
        for line in re.findall(r"^REPORT (.*)$", done.stdout, re.MULTILINE):
            _report.append(f"Blender {version}: {line}")
        print(said)
        return said

    return run


@pytest.fixture
def disks(tmp_path: Path) -> Iterator[tuple[Path, Path]]:
    """A read-only file system and a very small one; root is needed to mount them."""
    places = (tmp_path / "read-only", tmp_path / "full")
    mounted = []
    try:
        for place, options in zip(places, ("ro", "size=300k"), strict=True):
            place.mkdir()
            mount = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(place)]
            if shutil.which("mount") is None or subprocess.run(mount, check=False, capture_output=True).returncode:
                pytest.skip("a file system cannot be mounted here")
            mounted.append(place)
        yield places
    finally:
        for place in mounted:
            subprocess.run(["umount", str(place)], check=False)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Prints the figures that the tests measured."""
    if _report:
        terminalreporter.section("the Blender add-on's figures")
        for line in _report:
            terminalreporter.write_line(line)
