# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D view's sidebar."""

from __future__ import annotations

import json
import textwrap
from typing import Any

import bpy

from ..logic import designs, library, results
from ..logic.parameters import Field
from . import animation, flower, jobs, preview, properties


def _lines(context: bpy.types.Context, text: str, indent: int) -> list[str]:
    """A text in lines that fit the sidebar."""
    scale = context.preferences.system.ui_scale
    width = context.region.width / scale if context.region else 260
    return textwrap.wrap(text, max(18, int((width - indent) / 6.1)))


def say(
    layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "NONE", alert: bool = False
) -> None:
    """A message in a box, wrapped to the sidebar's width."""
    box = layout.box().column(align=True)
    box.alert = alert
    for i, line in enumerate(_lines(context, text, 90 if icon != "NONE" else 65)):
        box.label(text=line, icon=icon if i == 0 else "BLANK1" if icon != "NONE" else "NONE")


def tell(layout: bpy.types.UILayout, context: bpy.types.Context, *texts: str) -> None:
    """Figures below the fields they follow from, wrapped."""
    column = layout.column(align=True)
    column.scale_y = 0.85
    for text in texts:
        for i, line in enumerate(_lines(context, text, 38)):
            column.label(text=line if i == 0 else f"    {line}")


def put(layout: bpy.types.UILayout, group: Any, field: Field) -> None:
    """A field: numbers with their names inside, choices beside or below theirs."""
    name = field.name
    if field.type == "choices":
        layout.label(text=f"{field.label}:")
        grid = layout.grid_flow(columns=2, even_columns=True, align=True)
        grid.use_property_split = False
        for choice in field.choices:
            grid.prop_enum(group, name, choice)
        return
    if hasattr(group, f"use_{name}"):
        box = layout.row()
        box.use_property_split = False
        box.prop(group, f"use_{name}", text=field.label)
        if getattr(group, f"use_{name}"):
            row = layout.row(align=True)
            row.use_property_split = False
            row.prop(group, name, text="")
        return
    number = field.type in ("number", "integer", "integers", "numbers")
    if len(field.label) > (30 if number else 12) or field.type in ("integers", "numbers"):
        layout.label(text=f"{field.label}:")
        row = layout.row(align=True)
        row.use_property_split = False
        row.prop(group, name, text="")
    elif number:
        row = layout.row()
        row.use_property_split = False
        row.prop(group, name)
    else:
        layout.prop(group, name)


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Voxelastica"


class VOXELASTICA_PT_main(_Panel, bpy.types.Panel):
    """Which flower, and what is wrong with it."""

    bl_idname = "VOXELASTICA_PT_main"
    bl_label = "Voxelastica"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if library.problem():
            say(layout, context, library.problem(), "ERROR", alert=True)
            return
        root = flower.shown(context)
        layout.menu("VOXELASTICA_MT_new", text="New Flower", icon="ADD")
        if root is None:
            say(layout, context, "Make a flower, or select one, to see its design here.", "INFO")
            return
        settings = flower.settings(root)
        row = layout.row(align=True)
        row.prop(root, "name", text="", icon="MESH_CIRCLE")
        row.menu("VOXELASTICA_MT_presets", text="", icon="PRESET")
        row.operator("voxelastica.update", text="", icon="FILE_REFRESH")
        row.operator("voxelastica.remove", text="", icon="TRASH")
        if settings.problem:
            say(layout, context, settings.problem, "ERROR", alert=True)
            if settings.design:
                tell(layout, context, "The preview is the last design that could be made.")
        if settings.hint:
            say(layout, context, settings.hint, "INFO")


class _Child(_Panel):
    bl_parent_id = "VOXELASTICA_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return not library.problem() and flower.shown(context) is not None

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        root = flower.shown(context)
        self.show(layout, context, root, flower.settings(root))


def _stored(settings: Any) -> dict[str, Any]:
    return designs.parsed(settings.design)


class VOXELASTICA_PT_target(_Child, bpy.types.Panel):
    """The dome."""

    bl_label = "Target"
    bl_order = 1
    bl_options = set()

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        target = settings.target
        layout.prop(target, "kind", text="")
        if target.kind == "hemi-ellipsoid":
            put(layout, target, properties.known()["target.aspect_ratio"])
        elif target.kind == "inclination-polynomial":
            self._coefficients(layout, context, target)
        elif target.kind == "points":
            layout.prop(target, "file")
        else:
            layout.prop(settings, "target_object")
            layout.prop(target, "axis")
            row = layout.row(align=True)
            row.operator("voxelastica.use_mesh", text="Take from Mesh", icon="FILE_REFRESH")
            row.operator("voxelastica.keep_size", text="Keep Its Size")
            if settings.meridian_note and settings.meridian_kind == "mesh":
                tell(layout, context, settings.meridian_note)
        self._size(layout, context, root, settings)

    def _coefficients(self, layout: Any, context: bpy.types.Context, target: Any) -> None:
        numbers = target.coefficients_deg
        row = layout.row()
        row.label(text=f"{properties.known()['target.coefficients_deg'].label}:")
        for sign in (True, False):
            part = row.row()
            part.enabled = len(numbers) < 21 if sign else len(numbers) > 1
            change = part.operator("voxelastica.list", text="", icon="ADD" if sign else "REMOVE")
            change.what, change.add = "coefficients", sign
        tell(layout, context, "xi runs from the rim (0) to the hub (1)")
        column = layout.column(align=True)
        column.use_property_split = False
        for i, item in enumerate(numbers):
            power = len(numbers) - 1 - i
            column.prop(item, "value", text=f"xi^{power}" if power > 1 else ("xi", "1")[power == 0])

    def _size(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        found = flower.prepared(root)
        if found is None or settings.problem:
            return
        summary, strips = found.design.summary, found.input["strips"]
        unit = flower.unit_mm(context.scene)
        across = 2 * (strips["hub_radius_mm"] + strips["length_mm"])
        notes = [
            f"Flat: {across:.4g} mm across ({across / unit:.3g} units)",
            f"Closed: {2 * summary['rim_radius_mm']:.4g} mm across, {summary['height_mm']:.4g} mm high",
        ]
        scale = preview.scale_of_mesh(settings, found)
        if scale is not None:
            notes.append(f"Scale: {scale:.4g} of the mesh")
        tell(layout, context, *notes)


class VOXELASTICA_PT_spokes(_Child, bpy.types.Panel):
    """Number and size of the spokes."""

    bl_label = "Spokes"
    bl_order = 2
    bl_options = set()

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        column = layout.column(align=True)
        for field in properties.known().values():
            if field.table == "strips":
                put(column, settings.strips, field)


class VOXELASTICA_PT_thrust(_Child, bpy.types.Panel):
    """What holds the dome."""

    bl_label = "Thrust"
    bl_order = 3
    bl_options = set()

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        layout.prop(settings.thrust, "hub")
        row = layout.row()
        row.active = settings.thrust.hub == "free"
        row.prop(settings.thrust, "choice")
        found = flower.prepared(root)
        if found is None:
            return
        summary = found.design.summary
        per, total = summary["thrust"]["per_spoke"], summary["thrust"]["total"]

        def force(values: Any, key: str, ways: tuple[str, str]) -> str:
            """A range from narrow spokes (a beam) to wide ones (plane strain), and its sense."""
            low, high = values["beam"][key], values["plane_strain"][key]
            if low == high == 0:
                return "none"
            return f"{abs(low):.3g} to {abs(high):.3g} N {ways[low < 0]}"

        tell(
            layout,
            context,
            f"On the hub: {force(total, 'vertical_n', ('up', 'down'))}",
            f"At each seat: {force(per, 'horizontal_n', ('inward', 'outward'))}",
            f"Contrast: {summary['contrast']:.3g}; the phases reach {summary['contrast_reach']:.3g}",
        )


class VOXELASTICA_PT_materials(_Child, bpy.types.Panel):
    """The phases."""

    bl_label = "Materials"
    bl_order = 4

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        materials = settings.materials
        phases = materials.phases
        names = ("Softest", "Stiffest") if len(phases) == 2 else ("Softest", "Between", "Stiffest")
        for item, name in zip(phases, names, strict=False):
            layout.prop(item, "material", text=name)
        row = layout.row(align=True)
        for sign, text in ((True, "Third Phase"), (False, "Third Phase")):
            if sign == (len(phases) < 3):
                change = row.operator("voxelastica.list", text=text, icon="ADD" if sign else "REMOVE")
                change.what, change.add = "phases", sign
        if len(phases) > 2:
            put(layout, materials, properties.known()["materials.intermediate_fraction"])
        for i, item in enumerate(materials.custom):
            box = layout.box()
            row = box.row()
            row.prop(item, "name", text="")
            change = row.operator("voxelastica.list", text="", icon="X")
            change.what, change.add, change.index = "materials", False, i
            for field in properties.known().values():
                if field.table == "materials.custom" and field.name != "name":
                    put(box, item, field)
        change = layout.operator("voxelastica.list", text="Custom Material", icon="ADD")
        change.what, change.add = "materials", True


class VOXELASTICA_PT_voxels(_Child, bpy.types.Panel):
    """How the modulus is realised."""

    bl_label = "Voxels"
    bl_order = 5
    bl_options = set()

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        for field in properties.known().values():
            if field.table == "voxels":
                put(layout, settings.voxels, field)
        found = flower.prepared(root)
        if found is not None:
            summary = found.design.summary
            tell(layout, context, f"{summary['voxels_per_spoke']:,} voxels a spoke")
            if summary.get("predicted_error_percent") is not None:
                tell(layout, context, f"Predicted error: {summary['predicted_error_percent']:.2g} % of the length")


class VOXELASTICA_PT_preview(_Child, bpy.types.Panel):
    """What is shown."""

    bl_label = "Preview"
    bl_order = 6
    bl_options = set()

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        layout.prop(settings, "morph", slider=True)
        layout.prop(settings, "colour_by")
        space = context.space_data
        if space.shading.type == "SOLID" and space.shading.color_type != "VERTEX":
            layout.operator("voxelastica.show_colours", text="Show Colours in This View", icon="COLOR")
        column = layout.column(heading="Show")
        column.prop(settings, "show_target")
        column.prop(settings, "show_legend")
        column.prop(settings, "show_voxels")
        if settings.show_voxels:
            row = layout.row()
            row.use_property_split = False
            row.prop(settings, "voxel_limit")
            layout.prop(settings, "voxel_phase")
            if settings.voxels_note:
                tell(layout, context, settings.voxels_note)
        column = layout.column(align=True)
        column.use_property_split = False
        column.prop(settings, "along")
        column.prop(settings, "across")
        if settings.states:
            say(layout, context, f"Animated: {settings.animation_note}")
            layout.operator("voxelastica.unanimate", text="Remove Animation", icon="X")
        else:
            if animation.is_keyed(root):
                say(layout, context, "The morph has keyframes that nothing follows yet: press Animate.", "ERROR")
            layout.operator("voxelastica.animate", text="Animate...", icon="RENDER_ANIMATION")


def _running(layout: Any, root: bpy.types.Object, name: str) -> bool:
    """The progress of a job with its cancel button; whether there is one."""
    job = jobs.running(root)
    if job is None or job.name != name:
        return False
    row = layout.row(align=True)
    text = "Cancelling" if job.cancelled else f"{100 * job.share:.0f} %, {job.seconds:.0f} s"
    row.progress(factor=job.share, text=text)
    row.operator("voxelastica.cancel", text="", icon="X")
    return True


class VOXELASTICA_PT_export(_Child, bpy.types.Panel):
    """Decks and print files."""

    bl_label = "Export"
    bl_order = 7

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        layout.prop(settings, "design_name")
        layout.prop(settings, "folder")
        if not _running(layout, root, "Export"):
            layout.operator("voxelastica.export", text="Export", icon="EXPORT")
        if settings.export_note:
            say(layout, context, settings.export_note)


class _Kinds(_Child):
    bl_parent_id = "VOXELASTICA_PT_export"
    table = ""

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        root = flower.shown(context)
        chosen = getattr(flower.settings(root), self.table).write
        self.layout.label(text=f"{len(chosen)} kinds" if len(chosen) != 1 else "1 kind")

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        for field in properties.known().values():
            if field.table == self.table and (field.name != "pitch_um" or settings.fabrication.printer == "custom"):
                put(layout, getattr(settings, self.table), field)


class VOXELASTICA_PT_decks(_Kinds, bpy.types.Panel):
    """Decks of solvers."""

    bl_label = "Decks"
    bl_order = 1
    table = "decks"


class VOXELASTICA_PT_fabrication(_Kinds, bpy.types.Panel):
    """Files to print and show."""

    bl_label = "Print Files and glTF"
    bl_order = 2
    table = "fabrication"


class VOXELASTICA_PT_verify(_Child, bpy.types.Panel):
    """What a solver says."""

    bl_label = "Verify"
    bl_order = 8

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        layout.prop(settings, "verify_solver")
        layout.prop(settings, "verify_model")
        if not _running(layout, root, "Verification"):
            layout.operator("voxelastica.verify", text="Verify", icon="CHECKMARK")
        if settings.verify_note:
            say(layout, context, settings.verify_note, "ERROR")
        if settings.verification:
            record = json.loads(settings.verification)
            tell(layout, context, *results.verify_notes(record, _stored(settings)))
            layout.prop(settings, "show_midline")


class VOXELASTICA_PT_refine(_Child, bpy.types.Panel):
    """Designs corrected by what their voxels do."""

    bl_label = "Refine"
    bl_order = 9

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        layout.prop(settings, "refine_iterations")
        if not _running(layout, root, "Refinement"):
            row = layout.row(align=True)
            row.operator("voxelastica.refine", text="Refine", icon="MOD_SMOOTH")
            if settings.refinement:
                row.operator("voxelastica.unrefine", text="", icon="X")
        if settings.refine_note:
            say(layout, context, settings.refine_note, "ERROR")
        if settings.refinement:
            tell(layout, context, *results.refine_notes(json.loads(settings.refinement), _stored(settings)))


class VOXELASTICA_PT_conduct(_Child, bpy.types.Panel):
    """Heat and current."""

    bl_label = "Conduct"
    bl_order = 10

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        layout.prop(settings, "conduct_flow")
        layout.prop(settings, "conduct_shape")
        layout.prop(settings, "conduct_regime")
        if not _running(layout, root, "Conduction"):
            layout.operator("voxelastica.conduct", text="Conduct", icon="LIGHT_SUN")
        if settings.conduct_note:
            say(layout, context, settings.conduct_note, "ERROR")
        if settings.conduction:
            tell(layout, context, *results.conduct_notes(json.loads(settings.conduction), _stored(settings)))


CLASSES = (
    VOXELASTICA_PT_main,
    VOXELASTICA_PT_target,
    VOXELASTICA_PT_spokes,
    VOXELASTICA_PT_thrust,
    VOXELASTICA_PT_materials,
    VOXELASTICA_PT_voxels,
    VOXELASTICA_PT_preview,
    VOXELASTICA_PT_export,
    VOXELASTICA_PT_decks,
    VOXELASTICA_PT_fabrication,
    VOXELASTICA_PT_verify,
    VOXELASTICA_PT_refine,
    VOXELASTICA_PT_conduct,
)
