# SPDX-License-Identifier: GPL-3.0-or-later
"""Exporting and verifying: the work that runs beside Blender, and what is said of it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .inputs import mechanics
from .job import Progress


def destination(folder: str, name: str, saved: bool) -> Path:
    """The folder of a design's files.

    :param folder: where the design's own folder is made, made absolute by the host
    :raises ValueError: a folder beside a .blend file that was never saved, or none
    """
    if not folder:
        raise ValueError("Choose a folder to export to.")
    if folder.startswith("//") and not saved:
        raise ValueError("Save the .blend file first, or choose a folder: // is the folder of the .blend file.")
    return Path(folder) / name


def exported(design: Any, folder: Path, progress: Progress) -> list[Path]:
    """Writes everything that a design asks for: as the command line does."""
    return design.write(folder, progress=progress)


def export_note(files: Sequence[Path], folder: Path) -> str:
    """What was written."""
    size = sum(file.stat().st_size for file in files if file.is_file())
    return f"{len(files)} files, {size / 1e6:.1f} MB, in {folder}"


def verified(design: Any, model: str, solver: str, ccx: str, progress: Progress) -> dict[str, Any]:
    """Solves a design's strip; what an object stores of it."""
    if solver == "ccx":
        found = design.verify_ccx(model, ccx=ccx, progress=progress)
    else:
        found = design.verify(model, progress=progress)
    summary = design.summary
    keys = ("max_error_percent", "rms_error_percent", "max_shape_error_percent", "predicted_error_percent", "seconds")
    record = {key: found.get(key) for key in (*keys, "midline_mm", "solver", "model", "warnings")}
    record |= {
        "rim_radius_mm": summary["rim_radius_mm"],
        "spokes": design.spokes,
        "mechanics": mechanics(design.input),
    }
    return record


def verify_notes(record: dict[str, Any], design: dict[str, Any]) -> list[str]:
    """What a solver found, line by line; the last lines are warnings."""
    solver = record["solver"]
    name = "Built-in solver" if solver["name"] == "embedded" else f"{solver['name']} {solver['version']}"
    notes = [
        f"{record['max_error_percent']:.3f} % of the length off the target at most",
        f"{record['rms_error_percent']:.3f} % rms, {record['max_shape_error_percent']:.3f} % as a shape",
        f"{name}, {record['model']} model, {record['seconds']:.1f} s",
    ]
    if record["mechanics"] != mechanics(design):
        notes.append("The design was changed since: verify again.")
    return notes + list(record.get("warnings") or ())
