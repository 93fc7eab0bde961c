"""What the tests of the native library share: the library, its CMake package and the programs built with it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / "target" / "release" / "libvoxelastica.so"
PACKAGE = ROOT / "ffi" / "python"

os.environ.setdefault("VOXELASTICA_LIBRARY", str(LIBRARY))
sys.path.insert(0, str(PACKAGE))


def tool(name: str) -> str:
    """A program of the environment or the system; a missing one is a counted skip."""
    beside = Path(sys.executable).parent / name
    found = str(beside) if beside.exists() else shutil.which(name)
    if not found:
        pytest.skip(f"{name} is not installed")
    return found


def cmake(*arguments: object) -> None:
    """Runs cmake and shows what it said if it fails."""
    done = subprocess.run(
        [tool("cmake"), *map(str, arguments)], check=False, capture_output=True, text=True, timeout=1200
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="session")
def cmake_package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The installed CMake package."""
    tool("c++")
    root = tmp_path_factory.mktemp("cmake")
    # As scripts/test builds it: nothing is compiled a second time.
    packages = "-DVOXELASTICA_PACKAGES=--workspace;--lib;--bins;--tests"
    cmake("-S", ROOT / "ffi" / "cmake", "-B", root / "build", packages)
    cmake("--build", root / "build")
    cmake("--install", root / "build", "--prefix", root / "package")
    return root / "package"


@pytest.fixture(scope="session")
def programs(cmake_package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The test programs, built with warnings as errors and with both sanitizers."""
    build = tmp_path_factory.mktemp("programs")
    cmake("-S", ROOT / "ffi" / "tests" / "programs", "-B", build, f"-DCMAKE_PREFIX_PATH={cmake_package}")
    cmake("--build", build)
    return build
