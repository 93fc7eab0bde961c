# SPDX-License-Identifier: GPL-3.0-or-later
"""The library's table of parameters as fields of a form."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

#: Tables of the design file that the panel shows; the rest keeps its defaults.
TABLES = ("", "target", "strips", "thrust", "materials", "materials.custom", "voxels", "decks", "fabrication")
#: Keys that the panel handles itself or never shows.
_SPECIAL = {"target.meridian", "materials.phases"}
#: Words that title case would spoil.
_SPELLING = {
    "gltf": "glTF",
    "stl": "STL",
    "3mf": "3MF",
    "three_mf": "3MF",
    "gcvf": "GCVF",
    "dxf": "DXF",
    "svg": "SVG",
    "abaqus": "ABAQUS",
    "calculix": "CalculiX",
}


@dataclass(frozen=True)
class Field:
    """One key of the design file."""

    key: str
    type: str
    label: str
    description: str
    unit: str
    default: Any
    required: bool
    targets: tuple[str, ...]
    choices: tuple[str, ...] = ()
    least: float | None = None
    most: float | None = None
    exclusive: bool = False
    count: int = 0

    @property
    def table(self) -> str:
        """The table that holds the key; empty at the top level."""
        return self.key.rpartition(".")[0]

    @property
    def name(self) -> str:
        """The key within its table."""
        return self.key.rpartition(".")[2]

    @property
    def optional(self) -> bool:
        """Whether the key may be left out and has no default that stands for that."""
        return not self.required and self.default is None

    def applies(self, kind: str) -> bool:
        """Whether the key belongs to a kind of target."""
        return not self.targets or kind in self.targets


def title(word: str) -> str:
    """A key or choice as a person reads it: ``voxel_solid`` as *Voxel Solid*."""
    if any(letter.isupper() for letter in word):
        return word
    for plain, spelt in _SPELLING.items():
        word = re.sub(rf"(?<![a-z0-9]){plain}(?![a-z0-9])", spelt, word)
    words = (part if any(map(str.isupper, part)) else part[0].upper() + part[1:] for part in re.split("[_ ]+", word))
    return re.sub("-([a-z])", lambda letter: f"-{letter[1].upper()}", " ".join(words))


def label(name: str, unit: str | None) -> str:
    """Name of a field with its unit: ``hub_radius_mm`` in mm as *Hub Radius (mm)*."""
    words = name.split("_")
    if unit:
        bare = re.sub(r"[^a-z0-9]", "", unit.lower())
        for start in range(len(words) - 1, 0, -1):
            if "".join(words[start:]) == bare:
                words = words[:start]
                break
    text = title("_".join(words))
    return f"{text} ({unit})" if unit else text


def fields(table: Iterable[Mapping[str, Any]]) -> dict[str, Field]:
    """Fields by key, in the design file's order, made from ``voxelastica.parameters()``."""
    made = {}
    for row in table:
        key = row["key"]
        if key.rpartition(".")[0] not in TABLES or key in _SPECIAL or row["type"] == "recorded":
            continue
        if row["targets"] == ["strip"]:
            continue
        choices = tuple(choice for choice in row.get("choices", ()) if not (key == "target.kind" and choice == "strip"))
        made[key] = Field(
            key=key,
            type=row["type"],
            label=label(key.rpartition(".")[2], row["unit"]),
            description=row["description"].rstrip("."),
            unit=row["unit"] or "",
            default=None if row["default"] is None else json.loads(row["default"]),
            required=row["required"],
            targets=tuple(row["targets"]),
            choices=choices,
            least=row.get("least"),
            most=row.get("most"),
            exclusive=bool(row.get("exclusive")),
            count=row.get("count") or (row["most"] if row.get("most") == row.get("least") is not None else 0),
        )
    return made
