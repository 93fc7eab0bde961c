"""C and C++ programs, built by CMake with warnings as errors, under AddressSanitizer and UBSan."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import EXAMPLES

from .conftest import PACKAGE, ROOT, cmake, tool

HEMISPHERE = EXAMPLES / "hemisphere.toml"


def ran(*command: object, **environment: str) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        check=False,
        capture_output=True,
        text=True,
        timeout=1200,
        env={**os.environ, "RUST_BACKTRACE": "0", **environment},
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("program", ["surface_c", "surface_cpp"])
def test_the_whole_surface_and_each_error_under_sanitizers(programs: Path, tmp_path: Path, program: str) -> None:
    said = ran(programs / program, HEMISPHERE, tmp_path / "out")
    assert int(said.split()[0]) > 30


def test_examples_print_the_same_widths(cmake_package: Path, tmp_path: Path) -> None:
    cmake("-S", ROOT / "ffi" / "examples", "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={cmake_package}")
    cmake("--build", tmp_path)
    said = [ran(tmp_path / "hemisphere_c"), ran(tmp_path / "hemisphere_cpp")]
    said.append(ran(sys.executable, ROOT / "ffi" / "examples" / "hemisphere.py", PYTHONPATH=str(PACKAGE)))
    assert said[0] == said[1] == said[2]
    assert said[0].splitlines()[0] == "s =   0.0 mm  width = 61.024 mm"


def test_every_way_writes_the_same_bytes(programs: Path, examples: dict[str, Path], tmp_path: Path) -> None:
    import voxelastica

    wanted = {file.relative_to(examples["hemisphere"]): file for file in examples["hemisphere"].rglob("*.*")}
    assert any(name.suffix == ".inp" for name in wanted)
    ran(programs / "write_c", HEMISPHERE, tmp_path / "c")
    ran(programs / "surface_cpp", HEMISPHERE, tmp_path / "other", VOXELASTICA_WRITE=str(tmp_path / "cpp"))
    voxelastica.Design.from_file(HEMISPHERE).write(tmp_path / "python")
    for way in ("c", "cpp", "python"):
        for name, file in wanted.items():
            assert (tmp_path / way / name).read_bytes() == file.read_bytes(), f"{way}: {name}"


def test_the_c_program_under_valgrind(cmake_package: Path, tmp_path: Path) -> None:
    valgrind = tool("valgrind")
    source = ROOT / "ffi" / "tests" / "programs"
    cmake("-S", source, "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={cmake_package}", "-DSANITIZE=OFF")
    cmake("--build", tmp_path, "--target", "surface_c")
    # An optimised library has branches on values that do not matter, which memcheck takes for uninitialised ones; the Rust
    # tests run under it with that check on.
    # Threads take turns: without, the one that spins keeps the only running place and the others wait for minutes.
    options = [
        "--fair-sched=try",
        "--undef-value-errors=no",
        "--error-exitcode=9",
        "--leak-check=full",
        "--errors-for-leak-kinds=definite",
        "-q",
    ]
    ran(valgrind, *options, tmp_path / "surface_c", HEMISPHERE, tmp_path / "out")
