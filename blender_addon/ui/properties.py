# SPDX-License-Identifier: GPL-3.0-or-later
"""Property groups, made from the library's table of parameters."""

from __future__ import annotations

import json
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
    PointerProperty,
    StringProperty,
)

from ..logic import inputs, presets
from ..logic.library import api
from ..logic.parameters import Field, fields, title
from ..logic.surface import CHOICES as COLOURS

#: Where sliders end when dragged; what may be typed is the table's.
_SLIDERS = {"mm": (0.1, 500.0, 100), "MPa": (0.1, 10000.0, 100), "deg": (-180.0, 180.0, 100)}
_HEMISPHERE_DEG = (-90.0, 90.0)
_INT_MOST = 2**31 - 1
_FLOAT_MOST = 3.4e38
#: Item of an optional choice that leaves the key out.
AUTOMATIC = "automatic"

PARTS = (
    ("NONE", "None", "Not made by Voxelastica"),
    ("SPOKES", "Spokes", "The spokes; this object holds the design"),
    ("HUB", "Hub", ""),
    ("TARGET", "Target", ""),
    ("VOXELS", "Voxels", ""),
    ("LEGEND", "Legend", ""),
    ("LABELS", "Labels", ""),
    ("MIDLINE", "Solver's Mid-Line", ""),
)

_classes: list[type] = []
_fields: dict[str, Field] = {}
_quiet = 0
_phase_choices: list[tuple[str, str, str]] = []


@contextmanager
def quiet():
    """Properties may be set inside without the preview following each."""
    global _quiet
    _quiet += 1
    try:
        yield
    finally:
        _quiet -= 1


def known() -> dict[str, Field]:
    """The fields that the property groups were made from."""
    return _fields


def _changed(self: Any, _context: Any) -> None:
    if not _quiet:
        from . import preview  # The preview needs these properties.

        preview.design_changed(self.id_data)


def _drawn(what: str) -> Callable[[Any, Any], None]:
    def changed(self: Any, _context: Any) -> None:
        if not _quiet:
            from . import preview

            getattr(preview, what)(self.id_data)

    return changed


def _materials(self: Any, _context: Any, _text: str) -> list[tuple[str, str]]:
    custom = [(item.name, "custom") for item in self.id_data.voxelastica.materials.custom]
    hidden = {name for name, _ in custom}
    listed = [(m["name"], f"{m['modulus_mpa']:g} MPa") for m in api().materials() if m["name"] not in hidden]
    return custom + listed


def _phase_items(self: Any, _context: Any) -> list[tuple[str, str, str]]:
    # Blender keeps no reference to these strings: they must live on.
    names = [item.material for item in self.materials.phases] if self is not None else []
    _phase_choices[:] = [("0", "All", "All phases")] + [(str(i + 1), name, "") for i, name in enumerate(names)]
    return _phase_choices


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
        update=_changed,
    )


def _vector(field: Field, start: Any, make: Any, size: int) -> Any:
    least = field.least if field.type == "integers" else 0.0
    return make(
        name=field.label,
        description=field.description,
        size=size,
        default=start or [max(1, int(least or 1))] * size,
        min=int(least) if field.type == "integers" else least,
        update=_changed,
    )


def _choices(field: Field) -> list[tuple[str, str, str]]:
    return [(choice, title(choice), field.description) for choice in field.choices]


def _property(field: Field, start: Any) -> dict[str, Any]:
    """The Blender properties of one key, by name."""
    common = {"name": field.label, "description": field.description, "update": _changed}
    made: dict[str, Any] = {}
    if field.optional and field.type not in ("text", "path", "choice"):
        made[f"use_{field.name}"] = BoolProperty(
            name=f"Set {field.label}", description=f"{field.description}. Without it, the default", update=_changed
        )
    match field.type:
        case "number":
            made[field.name] = _number(field, start)
        case "integer":
            least, most = int(field.least or 0), min(int(field.most or _INT_MOST), _INT_MOST)
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

    value: FloatProperty(name="Value", precision=3, step=100, update=_changed)


class VOXELASTICA_PG_phase(bpy.types.PropertyGroup):
    """One of the phases."""

    material: StringProperty(
        name="Material",
        description="A material of the library, or one of the custom materials",
        search=_materials,
        update=_changed,
    )


def _group(name: str, annotations: dict[str, Any], doc: str) -> type:
    made = type(f"VOXELASTICA_PG_{name}", (bpy.types.PropertyGroup,), {"__annotations__": annotations, "__doc__": doc})
    _classes.append(made)
    bpy.utils.register_class(made)
    return made


def relative_paths() -> set[str]:
    """What says that a path may start with //, in versions of Blender that want to be told."""
    known_flag = "is_path_supports_blend_relative" in bpy.types.Property.bl_rna.properties
    return {"PATH_SUPPORTS_BLEND_RELATIVE"} if known_flag else set()


def _is_mesh(_self: Any, candidate: bpy.types.Object) -> bool:
    return candidate.type == "MESH" and candidate.voxelastica.part == "NONE"


def _settings(groups: dict[str, type]) -> dict[str, Any]:
    """Annotations of what an object stores."""
    field = _fields["name"]
    own: dict[str, Any] = {table.replace(".", "_"): PointerProperty(type=group) for table, group in groups.items()}
    own |= {
        "part": EnumProperty(name="Part", items=PARTS, options=set()),
        "design_name": StringProperty(name=field.label, description=field.description, update=_changed),
        "design": StringProperty(name="Design", description="The last design that could be computed, as JSON"),
        "exact": StringProperty(description="Numbers as they were read, where a property cannot hold all their digits"),
        "problem": StringProperty(name="Problem", description="Why the design as set could not be computed"),
        "hint": StringProperty(name="Hint", description="What the design's user should know"),
        "meridian": StringProperty(description="Meridian of the mesh, [rho, z] in mm, as JSON"),
        "meridian_kind": StringProperty(description="The kind of target that the meridian was taken for"),
        "meridian_axis": StringProperty(description="The axis that the meridian was taken about"),
        "shown": StringProperty(description="What the mesh was last made for"),
        "meridian_note": StringProperty(name="Meridian", description="Where the meridian came from"),
        "target_object": PointerProperty(
            name="Mesh",
            description="The mesh whose outer meridian is the target, with its modifiers and scale",
            type=bpy.types.Object,
            poll=_is_mesh,
            update=_drawn("mesh_changed"),
        ),
        "morph": FloatProperty(
            name="Morph",
            description="Fraction of the way from flat (0) to closed (1); every state is the true equilibrium",
            min=0.0,
            max=1.0,
            subtype="FACTOR",
            precision=3,
            update=_drawn("morph_changed"),
        ),
        "colour_by": EnumProperty(
            name="Colour", description="What colours show", items=COLOURS, update=_drawn("look_changed")
        ),
        "show_voxels": BoolProperty(
            name="Voxels", description="Show the voxels that the spokes are made of", update=_drawn("look_changed")
        ),
        "voxel_limit": IntProperty(
            name="Voxel Limit",
            description="At most this many voxels are shown: whole spokes, or the first slices of one",
            default=100_000,
            min=1000,
            soft_max=2_000_000,
            max=20_000_000,
            step=10_000,
            update=_drawn("look_changed"),
        ),
        "voxel_phase": EnumProperty(
            name="Show Phase",
            description="Whose voxels are shown; a hidden phase lets you look inside",
            items=_phase_items,
            update=_drawn("look_changed"),
        ),
        "voxels_note": StringProperty(name="Voxels Shown"),
        "show_target": BoolProperty(
            name="Target", description="Show the target as a wire", default=True, update=_drawn("look_changed")
        ),
        "show_legend": BoolProperty(
            name="Legend", description="Show what the colours mean", default=True, update=_drawn("look_changed")
        ),
        "along": IntProperty(
            name="Quads Along",
            description="Quads along a spoke",
            default=200,
            min=8,
            max=2000,
            update=_drawn("look_changed"),
        ),
        "across": IntProperty(
            name="Quads Across",
            description="Quads across a spoke",
            default=16,
            min=2,
            max=200,
            step=2,
            update=_drawn("look_changed"),
        ),
        "states": IntProperty(name="States", description="Shape keys that the animation blends; 0: not animated"),
        "animation_note": StringProperty(name="Animation"),
        "folder": StringProperty(
            name="Folder",
            description="Where the design's own folder is made; // is the folder of the .blend file",
            subtype="DIR_PATH",
            options=relative_paths(),
        ),
        "export_note": StringProperty(name="Export"),
        "verify_model": EnumProperty(
            name="Model",
            description="Which strip is solved",
            items=[
                ("voxel", "Voxels", "Every voxel its phase: what will be printed"),
                ("graded", "Graded", "Smooth width and modulus: what was designed"),
            ],
        ),
        "verify_solver": EnumProperty(
            name="Solver",
            description="Which solver is used",
            items=[
                ("embedded", "Built In", "The finite elements inside the library"),
                ("ccx", "CalculiX", "The program ccx, whose path the add-on's preferences hold"),
            ],
        ),
        "verification": StringProperty(description="What the solver found, as JSON"),
        "verify_note": StringProperty(name="Verification"),
        "show_midline": BoolProperty(
            name="Solver's Mid-Line",
            description="Lay the solver's mid-line over the target",
            default=True,
            update=_drawn("look_changed"),
        ),
    }
    return own


def register() -> None:
    """Makes the property groups from the library's table and hangs them on objects."""
    _fields.update(fields(api().parameters()))
    start = inputs.flatten(presets.read(presets.bundled()[presets.FIRST]), _fields)
    for plain in (VOXELASTICA_PG_number, VOXELASTICA_PG_phase):
        _classes.append(plain)
        bpy.utils.register_class(plain)
    tables: dict[str, dict[str, Any]] = {}
    # A custom material starts as the library's first one.
    start |= {f"materials.custom.{name}": value for name, value in api().materials()[0].items() if name != "name"}
    for key, field in _fields.items():
        if field.table:
            own = _property(field, start.get(key, field.default))
            tables.setdefault(field.table, {}).update(own)
    custom = _group("material", tables.pop("materials.custom"), "A custom material.")
    tables["materials"]["custom"] = CollectionProperty(type=custom, name="Custom Materials")
    tables["materials"]["phases"] = CollectionProperty(type=VOXELASTICA_PG_phase, name="Phases")
    groups = {
        table: _group(table, annotations, f"Table `{table}` of the design file.")
        for table, annotations in tables.items()
    }
    settings = _group("flower", _settings(groups), "A flower: its design and how it is shown.")
    bpy.types.Object.voxelastica = PointerProperty(type=settings, name="Voxelastica")
    bpy.types.Scene.voxelastica_shown = StringProperty(
        name="Flower", description="The flower that the panel shows while none is active"
    )


def unregister() -> None:
    """Takes everything away again."""
    for owner, name in ((bpy.types.Object, "voxelastica"), (bpy.types.Scene, "voxelastica_shown")):
        if hasattr(owner, name):
            delattr(owner, name)
    while _classes:
        bpy.utils.unregister_class(_classes.pop())
    _fields.clear()


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
            return precise if precise is not None and min(precise, _INT_MOST) == value else value
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
    for key, field in _fields.items():
        if key == "name":
            found[key] = settings.design_name
        elif field.table != "materials.custom":
            found[key] = _value(getattr(settings, field.table), field, exact)
    found["materials.phases"] = [item.material for item in settings.materials.phases]
    found["materials.custom"] = [
        {
            field.name: value
            for field in _fields.values()
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
            setattr(group, field.name, min(value, _INT_MOST) if field.type == "integer" else value)
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
    found = inputs.flatten(design, _fields)
    with quiet():
        for key, field in _fields.items():
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
            for field in _fields.values():
                if field.table == "materials.custom":
                    _set(item, field, material.get(field.name), {})
        meridian = found["target.meridian"]
        settings.meridian = json.dumps(meridian) if meridian else ""
        settings.meridian_kind = found["target.kind"] if meridian else ""
        settings.meridian_axis = settings.target.axis
        settings.exact = json.dumps(exact)
