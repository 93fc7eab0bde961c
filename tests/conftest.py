"""What the tests share: the program, designs made from the examples, and the solver where there is one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "examples"
PROGRAM = Path(os.environ.get("VOXELASTICA", ROOT / "target" / "release" / "voxelastica"))


@dataclass
class Result:
    """A finished run of the program."""

    code: int
    out: str
    err: str


def run(*arguments: object, cwd: Path | None = None, prefix: tuple[str, ...] = (), timeout: float = 1200) -> Result:
    """Runs the program and returns what it said."""
    command = [*prefix, str(PROGRAM), *map(str, arguments)]
    done = subprocess.run(
        command, check=False, cwd=cwd, capture_output=True, text=True, timeout=timeout, stdin=subprocess.DEVNULL
    )
    return Result(done.returncode, done.stdout, done.stderr)


def design(text: str, folder: Path, name: str = "test", *options: str) -> Path:
    """Writes a design file and designs it; returns the folder."""
    file = folder / f"{name}.toml"
    file.write_text(text, encoding="utf-8")
    out = folder / f"out-{name}"
    result = run("design", file, "-o", out, *options)
    assert result.code == 0, result.err
    return out


def read_json(path: Path) -> dict:
    """Reads a JSON file."""
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def program() -> Path:
    """The program, built by scripts/test."""
    assert PROGRAM.exists(), f"{PROGRAM} is not built; run cargo build --release"
    return PROGRAM


@pytest.fixture(scope="session")
def ccx() -> str:
    """The solver; a missing one is a counted skip."""
    found = shutil.which("ccx")
    if not found:
        pytest.skip("ccx (CalculiX) is not installed")
    return found


@pytest.fixture(scope="session")
def examples(program: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Every example, designed once; name to folder."""
    root = tmp_path_factory.mktemp("examples")
    made = {}
    for file in sorted(EXAMPLES.glob("*.toml")):
        result = run("design", file, "-o", root / file.stem)
        assert result.code == 0, f"{file.name}: {result.err}"
        made[file.stem] = root / file.stem
    return made
