"""The command line, called and read."""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
EXAMPLES = ROOT / "examples"
PAPER = EXAMPLES / "paper"
RESULTS = ROOT / "out" / "paper"
BINARY = ROOT / "target" / "release" / "voxelastica"


class Program:
    """Runs commands once a page: the same design is computed once, whoever asks for it."""

    def __init__(self, keep: bool) -> None:
        """With `keep`, results of an earlier run are taken."""
        self._keep = keep
        self._made: set[Path] = set()

    def version(self) -> str:
        """Version of the program."""
        return self.call("--version").strip()

    def call(self, *arguments: object) -> str:
        """What a command prints; ends the run where it fails."""
        command = [str(BINARY), *[str(a) for a in arguments]]
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stderr}")
        return done.stdout

    def once(self, result: Path, *arguments: object) -> Path:
        """A command that leaves a file, run unless that was done before."""
        if result not in self._made and not (self._keep and result.exists()):
            self.call(*arguments)
        self._made.add(result)
        return result

    def design(self, file: Path, name: str | None = None, *more: object) -> Path:
        """The folder of a design."""
        folder = RESULTS / (name or file.stem)
        self.once(folder / "design.json", "design", file, "-o", folder, *more)
        return folder

    def verify(self, folder: Path, model: str) -> dict:
        """`verification.json` of a model; copies are kept, since the next one overwrites it."""
        kept = folder / f"verification_{model}.json"
        if kept not in self._made and not (self._keep and kept.exists()):
            self.call("verify", folder, "--model", model)
            kept.write_text((folder / "verification.json").read_text())
            picture = folder / "verification.svg"
            (folder / f"verification_{model}.svg").write_text(picture.read_text())
        self._made.add(kept)
        return json.loads(kept.read_text())


def summary(folder: Path) -> dict:
    """The summary of a design."""
    return json.loads((folder / "design.json").read_text())["summary"]


def table(path: Path) -> list[dict[str, str]]:
    """Rows of a CSV file; comment lines are left out."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def figure(folder: Path, title: str) -> str:
    """A picture of a report as an SVG file of its own."""
    report = (folder / "report.html").read_text()
    for part in re.findall(r"<figure>.*?</figure>", report, re.S):
        if f"</span> {title}</h2>" in part:
            pictures = [svg for svg in re.findall(r"<svg.*?</svg>", part, re.S) if "legend" not in svg[:200]]
            return max(pictures, key=len)
    raise SystemExit(f"{folder}/report.html has no figure '{title}'")
