# SPDX-License-Identifier: GPL-3.0-or-later
"""Exporting and verifying: the work that runs beside Blender, and what is said of it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .inputs import mechanics
from .job import Progress
from .library import api


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


def refined(design: Any, iterations: int, progress: Progress) -> dict[str, Any]:
    """Corrects a design by what its voxels really do; what an object stores of it."""
    plain = uncorrected(design)
    found = plain.refine(iterations, progress=progress)
    summary = found.summary["refinement"]
    return {"mechanics": mechanics(plain.input), "refine": found.input["refine"], **summary}


def uncorrected(design: Any) -> Any:
    """A design without a correction."""
    keys = {key: value for key, value in design.input.items() if key != "refine"}
    return api().Design.from_dict(keys) if "refine" in design.input else design


def corrected(keys: dict[str, Any], plain: dict[str, Any], stored: str) -> dict[str, Any] | None:
    """A form's design with the correction that an object stores; None where that was found for another design.

    :param plain: the design's input without it, defaults filled in
    """
    record = json.loads(stored) if stored else {}
    return {**keys, "refine": record["refine"]} if record.get("mechanics") == mechanics(plain) else None


def refine_notes(record: dict[str, Any], design: dict[str, Any]) -> list[str]:
    """What a refinement brought, line by line."""
    notes = [
        f"{record['error_before_percent']:.3f} % of the length off the target before",
        f"{record['error_after_percent']:.3f} % after {record['solutions']} solutions",
    ]
    if "refine" not in design:
        notes.append("The design was changed since and is not corrected: refine again.")
    return notes


def conducted(design: Any, flow: str, regime: str, shape: str, progress: Progress) -> dict[str, Any]:
    """Heat or current through a spoke's voxels; what an object stores of it."""
    case = design.conduct(flow, regime=regime, shape=shape, progress=progress)
    record = {"flow": flow, "shape": shape, "mechanics": mechanics(design.input), "notes": case["notes"]}
    steady = case["steady"]
    record |= {key: steady[key] for key in ("effective_conductivity", "series_bound", "parallel_bound")}
    if "transient" in case:
        transient = case["transient"]
        record["critical_time_s"] = transient["critical_times_s"][-1]
        record["by_time"] = transient["effective_conductivities"][-1]
    record["assumed"] = [f"{a['property']} of {a['material']}" for a in case["assumptions"]]
    return record


def conduct_notes(record: dict[str, Any], design: dict[str, Any]) -> list[str]:
    """How a spoke conducts, line by line."""
    unit = "W/(m K)" if record["flow"] == "heat" else "S/m"
    notes = [
        f"{record['effective_conductivity']:.4g} {unit} by steady {record['flow']}, {record['shape']}",
        f"between {record['series_bound']:.4g} in series and {record['parallel_bound']:.4g} in parallel",
    ]
    if record.get("critical_time_s") is not None:
        notes.append(f"critical time {record['critical_time_s']:.4g} s: {record['by_time']:.4g} {unit}")
    if record["assumed"]:
        notes.append(f"Assumed, not measured: {', '.join(record['assumed'])}.")
    if record["mechanics"] != mechanics(design):
        notes.append("The design was changed since: compute again.")
    return notes + list(record["notes"])


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
