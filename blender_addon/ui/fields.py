# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender properties of the library's fields: type, range, unit and tooltip come from its table."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import contextmanager
from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    StringProperty,
)

from ..logic.library import api
from ..logic.parameters import Field, title

#: Where sliders end when dragged; what may be typed is the table's.
_SLIDERS = {"mm": (0.1, 500.0, 100), "MPa": (0.1, 10000.0, 100), "deg": (-180.0, 180.0, 100)}
INT_MOST = 2**31 - 1
_FLOAT_MOST = 3.4e38
#: Item of an optional choice that leaves the key out.
AUTOMATIC = "automatic"

_quiet = 0


@contextmanager
def quiet():
    """Properties may be set inside without the preview following each."""
    global _quiet
    _quiet += 1
    try:
        yield
    finally:
        _quiet -= 1


def changed(self: Any, _context: Any) -> None:
    """Has the design computed anew."""
    if not _quiet:
        from . import preview  # The preview needs these properties.

        preview.design_changed(self.id_data)


def drawn(what: str) -> Callable[[Any, Any], None]:
    """What has the preview follow, by one of its functions."""

    def follow(self: Any, _context: Any) -> None:
        if not _quiet:
            from . import preview

            getattr(preview, what)(self.id_data)

    return follow


def _materials(self: Any, _context: Any, _text: str) -> list[tuple[str, str]]:
    custom = [(item.name, "custom") for item in self.id_data.voxelastica.materials.custom]
    hidden = {name for name, _ in custom}
    listed = [(m["name"], f"{m['modulus_mpa']:g} MPa") for m in api().materials() if m["name"] not in hidden]
    return custom + listed


def relative_paths() -> set[str]:
    """What says that a path may start with //, in versions of Blender that want to be told."""
    known_flag = "is_path_supports_blend_relative" in bpy.types.Property.bl_rna.properties
    return {"PATH_SUPPORTS_BLEND_RELATIVE"} if known_flag else set()


def _number(field: Field, start: Any) -> Any:
    low, high, step = _SLIDERS.get(field.unit, (0.0, 1.0, 1) if field.most and field.most <= 1 else (-1e3, 1e3, 10))
    least = -_FLOAT_MOST if field.least is None else field.least
    most = _FLOAT_MOST if field.most is None else field.most
    if field.exclusive:
        least = max(1e-6, least * (1 + 1e-6))
    if start is None:
        start = min(max(10.0 if field.unit in ("mm", "MPa") else 0.0, least), most)
    return FloatProperty(
        name=field.label,
        description=field.description,
        default=start,
        min=least,
        max=most,
        soft_min=max(low, least),
        soft_max=min(high, most),
        step=step,
        precision=3,
        update=changed,
    )


def _vector(field: Field, start: Any, make: Any, size: int) -> Any:
    least = field.least if field.type == "integers" else 0.0
    return make(
        name=field.label,
        description=field.description,
        size=size,
        default=start or [max(1, int(least or 1))] * size,
        min=int(least) if field.type == "integers" else least,
        update=changed,
    )


def _choices(field: Field) -> list[tuple[str, str, str]]:
    return [(choice, title(choice), field.description) for choice in field.choices]


def properties_of(field: Field, start: Any) -> dict[str, Any]:
    """The Blender properties of one key, by name."""
    common = {"name": field.label, "description": field.description, "update": changed}
    made: dict[str, Any] = {}
    if field.optional and field.type not in ("text", "path", "choice"):
        made[f"use_{field.name}"] = BoolProperty(
            name=f"Set {field.label}", description=f"{field.description}. Without it, the default", update=changed
        )
    match field.type:
        case "number":
            made[field.name] = _number(field, start)
        case "integer":
            least, most = int(field.least or 0), min(int(field.most or INT_MOST), INT_MOST)
            made[field.name] = IntProperty(
                default=int(least if start is None else start), min=least, max=most, soft_max=min(most, 64), **common
            )
        case "choice" | "choice-or-vector":
            items = _choices(field)
            if field.optional:
                items.insert(0, (AUTOMATIC, "Automatic", "Leave the choice to the library"))
                start = start or AUTOMATIC
            made[field.name] = EnumProperty(items=items, default=start or field.choices[0], **common)
        case "choices":
            made[field.name] = EnumProperty(
                items=_choices(field), default=set(start or ()), options={"ENUM_FLAG"}, **common
            )
        case "path":
            made[field.name] = StringProperty(
                default=start or "", subtype="FILE_PATH", options=relative_paths(), **common
            )
        case "text":
            made[field.name] = StringProperty(default=start or "", **common)
        case "integers":
            made[field.name] = _vector(field, start, IntVectorProperty, field.count)
        case "numbers" if field.count:
            made[field.name] = _vector(field, start, FloatVectorProperty, field.count)
        case "numbers":
            made[field.name] = CollectionProperty(
                type=VOXELASTICA_PG_number, name=field.label, description=field.description
            )
        case _:
            raise TypeError(f"{field.key}: the panel knows no fields of type {field.type!r}")
    return made


class VOXELASTICA_PG_number(bpy.types.PropertyGroup):
    """One of a list of numbers."""

    value: FloatProperty(name="Value", precision=3, step=100, update=changed)


class VOXELASTICA_PG_phase(bpy.types.PropertyGroup):
    """One of the phases."""

    material: StringProperty(
        name="Material",
        description="A material of the library, or one of the custom materials",
        search=_materials,
        update=changed,
    )
