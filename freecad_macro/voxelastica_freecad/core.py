# SPDX-License-Identifier: MIT OR Apache-2.0
"""From a design to a document: the flat flower, the morphed shell, the phases, an analysis, files.

Everything happens in one transaction. Where something goes wrong, the user's document is left as it was.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import FreeCAD as App
import Part

from . import analysis, export, flat, morphed, parameters, phases, solve, source
from .settings import MacroError, Settings
from .tree import Tree, note

Progress = Callable[[str], None]


@dataclass
class Built:
    """What was built: the document, the top group, the parts' own results, files, and figures to tell the user."""

    document: Any
    root: Any
    parts: dict[str, dict[str, Any]] = field(default_factory=dict)
    files: list[Path] = field(default_factory=list)
    solution: dict[str, Any] | None = None


def build(settings: Settings, progress: Progress = lambda text: None) -> Built:
    """Builds a design into a document.

    Raises :class:`MacroError` or the library's error; the document is then as it was before.
    """
    settings.check()
    progress("reading the design")
    design = source.load(settings.design)
    folder = export.require_writable(settings.folder) if settings.export or settings.solve else None
    document, is_new = _document(settings, design)
    name = f"Voxelastica {design.name}"
    before = {item.Name for item in document.Objects}
    undo = document.UndoMode
    document.UndoMode = 1
    document.openTransaction(name)
    try:
        _make_room(document, name, settings.replace)
        tree = Tree(document, name)
        note(tree.root, "DesignHash", design.hash, "SHA-256 of the design")
        built = Built(document, tree.root)
        sheet = parameters.add_sheet(tree, design, "Parameters")
        _build_parts(settings, tree, design, sheet, built, progress)
        document.recompute()
        _write(settings, design, built, folder, progress)
        document.commitTransaction()
    except BaseException:
        document.abortTransaction()
        # Transactions do not cover all that FreeCAD's own tools make.
        for item in [item for item in document.Objects if item.Name not in before]:
            if item.Name in {other.Name for other in document.Objects}:
                document.removeObject(item.Name)
        if is_new:
            App.closeDocument(document.Name)
        else:
            document.UndoMode = undo
        raise
    document.UndoMode = undo
    return built


def _build_parts(settings: Settings, tree: Tree, design: Any, sheet: Any, built: Built, progress: Progress) -> None:
    if "flat" in settings.parts:
        progress("flat flower")
        built.parts["flat"] = flat.build(tree, design, sheet)
    if "morphed" in settings.parts:
        progress("morphed shell")
        built.parts["morphed"] = morphed.build(tree, design, settings.fraction)
    if "phases" in settings.parts:
        progress("phases")
        built.parts["phases"] = phases.build(tree, design, settings.phases)
    if "analysis" in settings.parts:
        progress("analysis")
        built.parts["analysis"] = analysis.build(tree, design, settings.model, settings.bands)
        if settings.solve:
            progress("CalculiX")
            folder = str(Path(settings.folder).expanduser() / "analysis")
            built.solution = solve.solve(built.parts["analysis"]["analysis"], folder, settings.ccx)


def _write(settings: Settings, design: Any, built: Built, folder: Path | None, progress: Progress) -> None:
    if folder is None:
        return
    name = export.file_name(design.name)
    solids = built.parts.get("flat", {}).get("solids", [])
    shells = [item for key in ("shell", "hub") if (item := built.parts.get("morphed", {}).get(key)) is not None]
    for kind in settings.export:
        progress(f"writing {kind}")
        if kind == "step" and solids:
            built.files.append(export.step(folder, f"{name}_flat", solids))
        if kind == "step" and shells:
            built.files.append(export.step(folder, f"{name}_morphed", shells))
        if kind == "stl" and solids:
            built.files.append(export.stl(folder, f"{name}_flat", built.parts["flat"]["flower"]))
        if kind == "fcstd":
            built.files.append(export.save(folder, name, built.document))


def _document(settings: Settings, design: Any) -> tuple[Any, bool]:
    if not settings.document:
        return App.newDocument(export.file_name(design.name)), True
    if settings.document not in App.listDocuments():
        names = ", ".join(App.listDocuments()) or "none"
        raise MacroError(f"VOXELASTICA_DOCUMENT = {settings.document}: there is no such document; open are {names}")
    return App.getDocument(settings.document), False


def _make_room(document: Any, name: str, replace: bool) -> None:
    """Refuses a name that is taken, or removes the earlier tree."""
    taken = document.getObjectsByLabel(name)
    if not taken:
        return
    if not replace or any(not hasattr(item, "DesignHash") for item in taken):
        help_text = "rename or delete it" if replace else "delete it, tick Replace, or set VOXELASTICA_REPLACE = 1"
        raise MacroError(f'{document.Label}: an object named "{name}" is there already; {help_text}')
    for item in taken:
        _remove(document, item)


def _remove(document: Any, item: Any) -> None:
    for child in list(getattr(item, "Group", [])):
        _remove(document, child)
    if document.getObject(item.Name) is not None:
        document.removeObject(item.Name)


def report(built: Built) -> list[str]:
    """What was built, in lines for the user."""
    lines = []
    made = built.parts.get("flat")
    if made:
        volumes = [Part.getShape(solid).Volume for solid in made["solids"]]
        lines.append(f"flat: {len(volumes)} solids, {sum(volumes):.3f} mm3")
    if "morphed" in built.parts:
        shell = built.parts["morphed"]["shell"].Shape
        lines.append(f"morphed: {len(shell.Faces)} faces, {shell.Area:.3f} mm2")
    if "phases" in built.parts:
        lines.append("phases: " + ", ".join(f"{p.Voxels} voxels of {p.Phase}" for p in built.parts["phases"]["phases"]))
    if "analysis" in built.parts:
        made = built.parts["analysis"]
        mesh = made["mesh"].FemMesh
        lines.append(
            f"analysis: {mesh.VolumeCount} {made['mesh'].ElementType} elements, {len(made['materials'])} materials"
        )
    if built.solution:
        lines.append(
            f"solved: largest distance from the target {built.solution['max_error_percent']:.4f} % of the length; "
            f"mid-line in {built.solution['file']}"
        )
    lines += [f"written: {file}" for file in built.files]
    return lines


def explain(error: BaseException) -> tuple[str, int]:
    """What to tell the user about an error, and the exit code without a window."""
    if isinstance(error, MacroError):
        return str(error), error.code
    if isinstance(error, OSError):
        return str(error), 5
    code = getattr(error, "code", None)
    if type(error).__name__ == "VoxelasticaError" and isinstance(code, int):
        return str(error), code if code in (1, 2, 3, 4, 5, 130) else 1
    return "".join(traceback.format_exception(type(error), error, error.__traceback__)), 1


def run_from_environment(environment: Mapping[str, str]) -> int:
    """Builds what the environment variables say, tells it in the report view, and returns an exit code."""
    try:
        built = build(
            Settings.from_environment(environment), lambda text: App.Console.PrintLog(f"Voxelastica: {text}\n")
        )
    except Exception as error:  # noqa: BLE001 - everything is told
        message, code = explain(error)
        App.Console.PrintError(f"Voxelastica: {message}\n")
        return code
    for line in report(built):
        App.Console.PrintMessage(f"Voxelastica: {line}\n")
    return 0
