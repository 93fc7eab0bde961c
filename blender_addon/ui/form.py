# SPDX-License-Identifier: GPL-3.0-or-later
"""Between the form that a flower's properties are and the keys of a design file."""

from __future__ import annotations

import json
from typing import Any

import bpy

from ..logic import inputs
from ..logic.parameters import Field
from .fields import AUTOMATIC, INT_MOST, quiet
from .properties import known

_HEMISPHERE_DEG = (-90.0, 90.0)


def _value(group: Any, field: Field, exact: dict[str, float]) -> Any:
    """The value of a key; None where it is left out."""
    if field.optional and not getattr(group, f"use_{field.name}", True):
        return None
    value = getattr(group, field.name)
    match field.type:
        case "number":
            return inputs.restored(value, exact.get(field.key))
        case "integer":
            precise = exact.get(field.key)
            return precise if precise is not None and min(precise, INT_MOST) == value else value
        case "numbers" if field.count:
            return [inputs.shortest(x) for x in value]
        case "numbers":
            return [inputs.restored(item.value, exact.get(f"{field.key}.{i}")) for i, item in enumerate(value)]
        case "integers":
            return list(value)
        case "choices":
            return [choice for choice in field.choices if choice in value]
        case "choice":
            return None if value == AUTOMATIC else value
        case "path":
            return bpy.path.abspath(value) if value else None
    return value


def values(settings: Any) -> dict[str, Any]:
    """The form's values, see :mod:`..logic.inputs`."""
    exact = json.loads(settings.exact or "{}")
    found: dict[str, Any] = {}
    for key, field in known().items():
        if key == "name":
            found[key] = settings.design_name
        elif field.table != "materials.custom":
            found[key] = _value(getattr(settings, field.table), field, exact)
    found["materials.phases"] = [item.material for item in settings.materials.phases]
    found["materials.custom"] = [
        {
            field.name: value
            for field in known().values()
            if field.table == "materials.custom" and (value := _value(item, field, {})) is not None
        }
        for item in settings.materials.custom
    ]
    if settings.meridian and settings.meridian_kind == settings.target.kind:
        found["target.meridian"] = json.loads(settings.meridian)
    return found


def _set(group: Any, field: Field, value: Any, exact: dict[str, float]) -> None:
    if field.optional and hasattr(group, f"use_{field.name}"):
        setattr(group, f"use_{field.name}", value is not None)
    if value is None:
        if field.type == "choice":
            setattr(group, field.name, AUTOMATIC)
        return
    match field.type:
        case "number" | "integer":
            exact[field.key] = value
            setattr(group, field.name, min(value, INT_MOST) if field.type == "integer" else value)
        case "numbers" if not field.count:
            numbers = getattr(group, field.name)
            numbers.clear()
            for i, number in enumerate(value):
                numbers.add().value = number
                exact[f"{field.key}.{i}"] = number
        case "choices":
            setattr(group, field.name, set(value))
        case "choice-or-vector":
            setattr(group, field.name, value if isinstance(value, str) else "auto")
        case _:
            setattr(group, field.name, value)


def assign(settings: Any, design: dict[str, Any]) -> None:
    """Puts a design into the form; the preview does not follow until it is told to."""
    exact: dict[str, float] = {}
    found = inputs.flatten(design, known())
    with quiet():
        for key, field in known().items():
            if key == "name":
                settings.design_name = found[key] or ""
            elif field.table != "materials.custom":
                _set(getattr(settings, field.table), field, found[key], exact)
        if not settings.target.coefficients_deg:  # A hemisphere, for when the kind is changed to a polynomial.
            for value in _HEMISPHERE_DEG:
                settings.target.coefficients_deg.add().value = value
        settings.materials.phases.clear()
        for name in found["materials.phases"] or ():
            settings.materials.phases.add().material = name
        settings.materials.custom.clear()
        for material in found["materials.custom"] or ():
            item = settings.materials.custom.add()
            for field in known().values():
                if field.table == "materials.custom":
                    _set(item, field, material.get(field.name), {})
        meridian = found["target.meridian"]
        settings.meridian = json.dumps(meridian) if meridian else ""
        settings.meridian_kind = found["target.kind"] if meridian else ""
        settings.meridian_axis = settings.target.axis
        settings.exact = json.dumps(exact)
