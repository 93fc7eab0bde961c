# SPDX-License-Identifier: MIT OR Apache-2.0
"""Reads a design: a design file, a ``design.json`` or the folder that holds one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from .library import voxelastica
from .settings import MacroError

SCHEMA = "voxelastica/design/1"

#: Largest file that is read, bytes; a design.json has some hundred thousand.
LARGEST = 256 << 20


def load(path: str) -> Any:
    """The design of a file or folder. Raises :class:`MacroError` or the package's error, both naming the file."""
    file = Path(path).expanduser()
    if file.is_dir():
        if not (file / "design.json").is_file():
            raise MacroError(f"{file}: there is no design.json in this folder; run voxelastica design first")
        file = file / "design.json"
    if not file.is_file():
        raise MacroError(f"{file}: there is no such file")
    if file.suffix.lower() == ".json":
        _check_json(file)
    return voxelastica().Design.from_file(file)


def _check_json(file: Path) -> None:
    """Refuses what is no design before the library says so less plainly."""
    if file.stat().st_size > LARGEST:
        raise MacroError(f"{file}: this file holds more than {LARGEST >> 20} MB, which no design does")
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except UnicodeDecodeError as error:
        raise MacroError(f"{file}: this is not text in UTF-8 ({error.reason} at byte {error.start})") from None
    except json.JSONDecodeError as error:
        raise MacroError(
            f"{file}:{error.lineno}: this is not whole JSON ({error.msg}); the file may be cut short, design it again"
        ) from None
    if not isinstance(document, dict):
        raise MacroError(f"{file}: this is JSON, but no design")
    schema = document.get("schema", SCHEMA)
    if schema != SCHEMA:
        raise MacroError(f'{file}: schema = "{schema}": this macro reads "{SCHEMA}"; design it with this version')


def variant(design: Any, table: str, values: dict[str, Any]) -> Any:
    """The same design with one table of its input replaced: for decks or files that it did not ask for."""
    return type(design).from_dict({**design.input, table: values})


def write_deck(design: Any, model: str, folder: Path) -> Path:
    """Writes the CalculiX deck of a strip, ``"graded"`` or ``"voxel"``, into a folder and returns its path."""
    kind = f"{model}_solid"
    decks = {**design.input.get("decks", {}), "write": [kind], "solvers": ["calculix"]}
    paths = variant(design, "decks", decks).write(folder, [kind])
    found = [path for path in paths if path.parent.name == "calculix" and path.stem == kind]
    if not found:
        raise MacroError(f"{design.name}: the library wrote no CalculiX deck of the {model} strip", 1)
    return found[0]
