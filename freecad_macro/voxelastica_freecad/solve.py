# SPDX-License-Identifier: MIT OR Apache-2.0
"""Solves an analysis that :mod:`analysis` made, with CalculiX through FreeCAD's own tools."""

from __future__ import annotations

import math
import os
import shutil
from pathlib import Path
from typing import Any

import FreeCAD as App

from .deck import Deck, Material
from .settings import MacroError

#: Name of the solver's files.
JOB = "spoke"


def materials(analysis: Any) -> list[Material]:
    """The document's materials, as edited there."""
    made = []
    for item in analysis.Group:
        if not hasattr(item, "ElementSet"):
            continue
        values = item.Material

        def number(key: str, unit: str, values: Any = values, label: str = item.Label) -> float:
            try:
                quantity = App.Units.Quantity(values[key])
                return float(quantity.getValueAs(unit)) if unit else float(quantity.Value)
            except (KeyError, ValueError, ArithmeticError) as error:
                raise MacroError(f"{label}: {key} = {values.get(key, '')}: {error}") from None

        made.append(
            Material(
                item.ElementSet,
                item.ElementSet,
                number("YoungsModulus", "MPa"),
                number("PoissonRatio", ""),
                number("Density", "kg/m^3"),
                list(item.Elements),
            )
        )
    return made


def write_input(analysis: Any, folder: str) -> Path:
    """Writes the solver's input: the deck with the document's materials."""
    deck = Deck.read(analysis.Deck)
    text = "\n".join(line for b in deck.blocks for line in b.lines) + "\n"
    if not analysis.KeepField:
        text = deck.with_materials(materials(analysis))
    path = Path(folder) / f"{JOB}.inp"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise MacroError(f"{path}: this cannot be written: {error.strerror}", 5) from None
    return path


def solve(analysis: Any, folder: str, ccx: str = "") -> dict[str, Any]:
    """Runs CalculiX in a folder, reads the results into the analysis and compares the mid-line with the target.

    Returns ``max_error_percent`` of the length, ``midline`` (rows of ``s, x, z`` in mm, seen from the rim), ``file`` (the
    same as CSV, for ``voxelastica compare``) and ``results``.
    """
    from femtools import ccxtools

    solver = next(item for item in analysis.Group if item.TypeId == "Fem::FemSolverObjectPython")
    path = write_input(analysis, folder)
    for ending in (".frd", ".dat", ".sta"):
        # What an earlier run left behind is no result of this one.
        path.with_suffix(ending).unlink(missing_ok=True)
    solver.WorkingDir = str(path.parent)
    tools = ccxtools.FemToolsCcx(analysis, solver)
    tools.purge_results()
    tools.update_objects()
    tools.setup_working_dir(str(path.parent))
    tools.inp_file_name = str(path)
    if ccx:
        # FreeCAD's own settings would come first.
        found = shutil.which(ccx)
        tools.ccx_binary, tools.ccx_binary_present = found or ccx, found is not None
    else:
        tools.setup_ccx()
    if not tools.ccx_binary_present:
        raise MacroError("CalculiX (ccx) is not found; set its path in FreeCAD's FEM preferences or VOXELASTICA_CCX", 4)
    code = tools.start_ccx()
    if code or "*ERROR" in (tools.ccx_stdout or ""):
        last = "; ".join(line.strip() for line in (tools.ccx_stdout or "").splitlines() if line.strip())[-400:]
        raise MacroError(f"{path}: CalculiX ended with code {code}: {last}", 4)
    tools.load_results()
    reached = _reached(path.with_suffix(".sta"))
    if reached < 1.0 - 1e-6:
        raise MacroError(f"{path}: CalculiX stopped at {100 * reached:.1f} % of the morph", 4)
    # One object an increment that was written, in their order.
    results = [item for item in analysis.Group if item.isDerivedFrom("Fem::FemResultObject")]
    if not results:
        raise MacroError(f"{path}: FreeCAD read no result of CalculiX", 4)
    return {**_compared(analysis, results[-1], path), "results": results}


def _reached(path: Path) -> float:
    """Share of the step that converged, by CalculiX's own table."""
    try:
        rows = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
        return max((float(row[4]) for row in rows if len(row) == 7 and row[0].isdigit()), default=0.0)
    except (OSError, ValueError):
        return 0.0


def _compared(analysis: Any, result: Any, path: Path) -> dict[str, Any]:
    deck = Deck.read(analysis.Deck)
    nodes = deck.nodes()
    moved = dict(zip(result.NodeNumbers, result.DisplacementVectors))
    line = deck.node_set("MIDLINE")
    origin = nodes[line[0]][0] + moved[line[0]].x
    target, length = analysis.Target, analysis.StripLength.Value
    midline, worst = [], 0.0
    for node in line:
        s, _, z = nodes[node]
        x, z = s + moved[node].x - origin, z + moved[node].z
        midline.append((s, x, z))
        at = min(max(s / length, 0.0), 1.0) * (len(target) - 1)
        i = min(int(at), len(target) - 2)
        wanted = target[i] + (target[i + 1] - target[i]) * (at - i)
        worst = max(worst, math.hypot(x - wanted.x, z - wanted.z))
    file = path.with_name("midline.csv")
    rows = (f"{s:.6f},{x:.6f},{z:.6f}" for s, x, z in midline)
    file.write_text(os.linesep.join(["s_mm,x_mm,z_mm", *rows, ""]), encoding="utf-8", newline="")
    return {"max_error_percent": 100.0 * worst / length, "midline": midline, "file": str(file)}
