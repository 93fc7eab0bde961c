"""Solves the points of a batch with ABAQUS and writes what `voxelastica sweep --record` takes, one JSON object a line.

Of every point: `voxelastica design`, the deck through ABAQUS, `extract_results.py` in ABAQUS's Python, `voxelastica compare`. A point
that fails is a line with its reason. Finished points are kept and not solved again.
"""

from __future__ import annotations

import argparse
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

INFEASIBLE = 3
EXTRACT = Path(__file__).resolve().parents[2] / "abaqus_scripts" / "voxelastica" / "extract_results.py"
FIGURES = ("max_error_percent", "rms_error_percent")


class Failure(Exception):
    """A point that could not be solved, with the reason."""


def run(command: list[str], folder: Path, what: str) -> int:
    """Runs a command in a folder with its output in a log; returns its code."""
    with (folder / "point.log").open("a", encoding="utf-8") as log:
        log.write(f"$ {shlex.join(command)}\n")
        log.flush()
        try:
            return subprocess.run(command, cwd=folder, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
        except OSError as error:
            raise Failure(f"{what} cannot be started: {error.strerror}: {command[0]}") from error


def last_line(folder: Path) -> str:
    """The last line of the log that says something."""
    lines = [line.strip() for line in (folder / "point.log").read_text("utf-8", "replace").splitlines()]
    said = [line for line in lines if line and not line.startswith("$ ")]
    return said[-1][:200] if said else "it said nothing"


def solve(design: Path, folder: Path, options: argparse.Namespace) -> dict[str, float]:
    """The figures of one design; nothing where it is infeasible, which the sweep finds out itself."""
    folder.mkdir(parents=True, exist_ok=True)
    code = run([options.program, "design", str(design), "-o", str(folder)], folder, "voxelastica")
    if code == INFEASIBLE:
        return {}
    if code:
        raise Failure(f"design ended with code {code}: {last_line(folder)}")
    deck = folder / "abaqus" / f"{options.deck}.inp"
    if not deck.is_file():
        raise Failure(f"the design writes no {deck.name}; let decks.write of the base design name {options.deck}")
    abaqus = shlex.split(options.abaqus)
    job = [*abaqus, "job=point", f"input={deck}", f"cpus={options.cpus}", "interactive", "ask_delete=OFF"]
    for command, what in (
        (job, "abaqus"),
        (
            [*abaqus, "python", str(EXTRACT), "--", "point.odb", "--design", str(folder / "design.json")],
            "the extraction",
        ),
        ([options.program, "compare", str(folder), "--result", str(folder / "point_midline.csv")], "compare"),
    ):
        code = run(command, folder, what)
        if code:
            raise Failure(f"{what} ended with code {code}: {last_line(folder)}")
    found = json.loads((folder / "comparison.json").read_text("utf-8"))
    return {name: float(found[name]) for name in FIGURES}


def line_of(point: int, design: Path, options: argparse.Namespace) -> str:
    """The line of one point, kept beside it once it is solved."""
    folder = options.output / "workflow" / "points" / str(point)
    kept = folder / "line.json"
    same = folder / "design_input.json"
    if kept.is_file() and same.is_file() and same.read_bytes() == design.read_bytes():
        return kept.read_text("utf-8")
    try:
        line = json.dumps({"point": point, "outputs": solve(design, folder, options)})
    except (Failure, OSError, ValueError, KeyError) as error:
        # A later run tries it again.
        return json.dumps({"point": point, "failure": re.sub(r"\s+", " ", str(error))})
    same.write_bytes(design.read_bytes())
    kept.write_text(line, encoding="utf-8")
    return line


def main() -> int:
    """Solves a batch."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("program", "batch", "abaqus", "deck"):
        parser.add_argument(f"--{name}", required=True)
    for name in ("sweep", "output", "results"):
        parser.add_argument(f"--{name}", required=True, type=lambda text: Path(text).resolve())
    parser.add_argument("--cpus", type=int, default=1)
    options = parser.parse_args()
    designs = options.output / "workflow" / "designs" / options.batch.replace("/", "of")
    command = [options.program, "--quiet", "sweep", str(options.sweep), "-o", str(designs), "--designs"]
    subprocess.run([*command, "--batch", options.batch], check=True)
    index, count = map(int, options.batch.split("/"))
    files = {int(path.stem.split("_")[1]): path for path in designs.glob("designs/point_*.json")}
    lines = [line_of(point, files[point], options) for point in sorted(files)]
    print(
        f"batch {index} of {count}: {len(lines)} points, {sum('failure' in line for line in lines)} failed", flush=True
    )
    part = options.results.with_suffix(".part")
    part.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    part.replace(options.results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
