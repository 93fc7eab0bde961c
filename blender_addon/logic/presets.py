# SPDX-License-Identifier: GPL-3.0-or-later
"""Design files that come with the add-on, and those that a user saved."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

ADDON = Path(__file__).resolve().parent.parent
#: What a new flower starts from.
FIRST = "hemisphere"


def bundled() -> dict[str, Path]:
    """Design files that come with the add-on, by name; in the sources they are the project's examples."""
    folder = ADDON / "presets"
    if not folder.is_dir():
        folder = ADDON.parent / "examples"
    names = (FIRST, "nose_cone", "roof", "trumpet")
    return {name: folder / f"{name}.toml" for name in names if (folder / f"{name}.toml").is_file()}


def saved(folder: str | Path | None) -> dict[str, Path]:
    """Designs that the user saved as presets, by name."""
    if not folder or not Path(folder).is_dir():
        return {}
    return {path.stem: path for path in sorted(Path(folder).glob("*.json"))}


def read(path: Path) -> dict[str, Any]:
    """The keys of a design file, TOML or JSON; paths in it become absolute.

    :raises OSError: a file that cannot be read
    :raises ValueError: a file that is neither
    """
    text = path.read_text(encoding="utf-8")
    try:
        design = json.loads(text) if path.suffix.lower() == ".json" else tomllib.loads(text)
    except (json.JSONDecodeError, tomllib.TOMLDecodeError) as error:
        raise ValueError(f"{path}: {error}") from None
    if isinstance(design, dict):
        design = design.get("design", design) if "schema" in design else design
    if not isinstance(design, dict):
        raise ValueError(f"{path}: this is no design: a table with target, strips, materials and voxels is needed")
    target = design.get("target")
    if isinstance(target, dict) and isinstance(target.get("file"), str):
        target["file"] = str((path.parent / target["file"]).resolve())
    return design


def save(folder: Path, name: str, design: dict[str, Any]) -> Path:
    """Saves a design as a preset and returns its file.

    :raises ValueError: a name that is no file name
    """
    if not re.fullmatch(r"[\w][\w .()+-]*", name):
        raise ValueError(f"{name!r} is no name for a preset: use letters, digits, spaces, dots and dashes")
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.json"
    scratch = path.with_suffix(".part")
    scratch.write_text(json.dumps(design, indent=2), encoding="utf-8")
    scratch.replace(path)
    return path


def remove(folder: Path, name: str) -> None:
    """Removes a preset that the user saved."""
    saved(folder)[name].unlink()
