# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of a form as a design, and back.

A form's values are a flat dictionary: key of the design file to number, text or list; ``None`` where a field is left out.
``materials.custom`` holds a list of dictionaries, ``materials.phases`` a list of names.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

from .parameters import Field

LISTS = ("materials.phases", "materials.custom", "target.meridian")


def single(value: float) -> float:
    """A value as Blender keeps it, in single precision."""
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")


def shortest(value: float) -> float:
    """The shortest decimal number that single precision cannot tell from a value: 0.7 for 0.699999988."""
    for digits in range(1, 10):
        number = float(f"{value:.{digits}g}")
        if single(number) == single(value):
            return number
    return value


def restored(value: float, exact: float | None) -> float:
    """The number that a value in single precision stands for: the exact one that was put in, or the shortest."""
    if exact is not None and single(exact) == single(value):
        return exact
    return shortest(value)


def assemble(values: Mapping[str, Any], known: Mapping[str, Field]) -> dict[str, Any]:
    """The design of a form's values: only keys that apply to its kind of target, tables nested as in the design file."""
    kind = values["target.kind"]
    design: dict[str, Any] = {}
    for key, value in values.items():
        if value is None or (key in known and not known[key].applies(kind)):
            continue
        if key == "target.meridian" and kind not in ("points", "mesh"):
            continue
        # A file that is named but replaced by its meridian is not read.
        if key == "target.file" and (not value or kind == "mesh"):
            continue
        if key == "thrust.choice" and values.get("thrust.hub") == "held":
            continue
        if key == "materials.custom" and not value:
            continue
        if key == "name" and not value:
            continue
        table, _, name = key.rpartition(".")
        (design.setdefault(table, {}) if table else design)[name] = value
    fabrication = design.get("fabrication", {})
    if all(value == known[f"fabrication.{name}"].default for name, value in fabrication.items()):
        design.pop("fabrication", None)
    return design


def flatten(design: Mapping[str, Any], known: Mapping[str, Field]) -> dict[str, Any]:
    """A form's values of a design, defaults where it is silent."""
    values: dict[str, Any] = {}
    for key, field in known.items():
        if field.table == "materials.custom":
            continue
        place = design.get(field.table, {}) if field.table else design
        values[key] = place.get(field.name, field.default)
    for key in LISTS:
        table, _, name = key.rpartition(".")
        values[key] = design.get(table, {}).get(name)
    return values


def canonical(design: Mapping[str, Any]) -> str:
    """A design as text, the same for equal designs."""
    return json.dumps(design, sort_keys=True)


def mechanics(design: Mapping[str, Any]) -> str:
    """What of a design its mechanics depend on: not its name, nor which files are written."""
    return canonical({key: value for key, value in design.items() if key not in ("name", "decks", "fabrication")})
