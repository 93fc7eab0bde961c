# SPDX-License-Identifier: GPL-3.0-or-later
"""Property groups of a flower, made from the library's table of parameters."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..logic import inputs, presets
from ..logic.library import api
from ..logic.parameters import Field, fields
from ..logic.surface import CHOICES as COLOURS
from .fields import VOXELASTICA_PG_number, VOXELASTICA_PG_phase, changed, drawn, properties_of, relative_paths

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
_phase_choices: list[tuple[str, str, str]] = []


def known() -> dict[str, Field]:
    """The fields that the property groups were made from."""
    return _fields


def _phase_items(self: Any, _context: Any) -> list[tuple[str, str, str]]:
    # Blender keeps no reference to these strings: they must live on.
    names = [item.material for item in self.materials.phases] if self is not None else []
    _phase_choices[:] = [("0", "All", "All phases")] + [(str(i + 1), name, "") for i, name in enumerate(names)]
    return _phase_choices


def _is_mesh(_self: Any, candidate: bpy.types.Object) -> bool:
    return candidate.type == "MESH" and candidate.voxelastica.part == "NONE"


def _group(name: str, annotations: dict[str, Any], doc: str) -> type:
    made = type(f"VOXELASTICA_PG_{name}", (bpy.types.PropertyGroup,), {"__annotations__": annotations, "__doc__": doc})
    _classes.append(made)
    bpy.utils.register_class(made)
    return made


def _settings(groups: dict[str, type]) -> dict[str, Any]:
    """Annotations of what an object stores."""
    field = _fields["name"]
    own: dict[str, Any] = {table.replace(".", "_"): PointerProperty(type=group) for table, group in groups.items()}
    own |= {
        "part": EnumProperty(name="Part", items=PARTS, options=set()),
        "design_name": StringProperty(name=field.label, description=field.description, update=changed),
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
            update=drawn("mesh_changed"),
        ),
        "morph": FloatProperty(
            name="Morph",
            description="Fraction of the way from flat (0) to closed (1); every state is the true equilibrium",
            min=0.0,
            max=1.0,
            subtype="FACTOR",
            precision=3,
            update=drawn("morph_changed"),
        ),
        "colour_by": EnumProperty(
            name="Colour", description="What colours show", items=COLOURS, update=drawn("look_changed")
        ),
        "show_voxels": BoolProperty(
            name="Voxels", description="Show the voxels that the spokes are made of", update=drawn("look_changed")
        ),
        "voxel_limit": IntProperty(
            name="Voxel Limit",
            description="At most this many voxels are shown: whole spokes, or the first slices of one",
            default=100_000,
            min=1000,
            soft_max=2_000_000,
            max=20_000_000,
            step=10_000,
            update=drawn("look_changed"),
        ),
        "voxel_phase": EnumProperty(
            name="Show Phase",
            description="Whose voxels are shown; a hidden phase lets you look inside",
            items=_phase_items,
            update=drawn("look_changed"),
        ),
        "voxels_note": StringProperty(name="Voxels Shown"),
        "show_target": BoolProperty(
            name="Target", description="Show the target as a wire", default=True, update=drawn("look_changed")
        ),
        "show_legend": BoolProperty(
            name="Legend", description="Show what the colours mean", default=True, update=drawn("look_changed")
        ),
        "along": IntProperty(
            name="Quads Along",
            description="Quads along a spoke",
            default=200,
            min=8,
            max=2000,
            update=drawn("look_changed"),
        ),
        "across": IntProperty(
            name="Quads Across",
            description="Quads across a spoke",
            default=16,
            min=2,
            max=200,
            step=2,
            update=drawn("look_changed"),
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
        "refine_iterations": IntProperty(
            name="Corrections", description="Corrections at most", default=4, min=1, max=20
        ),
        "refinement": StringProperty(description="What finite elements corrected, as JSON"),
        "refine_note": StringProperty(name="Refinement"),
        "conduct_flow": EnumProperty(
            name="Flow",
            description="What flows from the rim to the hub",
            items=[("heat", "Heat", "From a warm rim"), ("current", "Current", "Into the rim")],
        ),
        "conduct_shape": EnumProperty(
            name="Shape",
            description="In which shape it flows",
            items=[("flat", "Flat", "As printed"), ("morphed", "Closed", "At the end of the morph")],
        ),
        "conduct_regime": EnumProperty(
            name="Regime",
            description="What of it is computed",
            items=[("steady", "Steady", "The state in the long run"), ("both", "In Time", "The way there as well")],
        ),
        "conduction": StringProperty(description="How a spoke conducts, as JSON"),
        "conduct_note": StringProperty(name="Conduction"),
        "show_midline": BoolProperty(
            name="Solver's Mid-Line",
            description="Lay the solver's mid-line over the target",
            default=True,
            update=drawn("look_changed"),
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
            own = properties_of(field, start.get(key, field.default))
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
