# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D view's sidebar."""

from __future__ import annotations

import json
import textwrap
from typing import Any

import bpy

from ..logic import designs, library, results
from . import animation, flower, jobs, preview, properties


def say(
    layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "NONE", alert: bool = False
) -> None:
    """A message, wrapped to the sidebar's width."""
    scale = context.preferences.system.ui_scale
    width = context.region.width / scale if context.region else 260
    box = layout.box().column(align=True)
    box.alert = alert
    for i, line in enumerate(textwrap.wrap(text, max(20, int((width - 70) / 6.4)))):
        box.label(text=line, icon=icon if i == 0 else "BLANK1" if icon != "NONE" else "NONE")


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
        if settings.problem:
            say(layout, context, settings.problem, "ERROR", alert=True)
            if settings.design:
                layout.label(text="The preview shows the last design that could be made.")
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


def _optional(layout: bpy.types.UILayout, group: Any, name: str) -> None:
    """A field that may be left out, behind its checkbox."""
    if hasattr(group, f"use_{name}"):
        row = layout.row(heading=type(group).bl_rna.properties[name].name)
        row.prop(group, f"use_{name}", text="")
        field = row.row()
        field.active = getattr(group, f"use_{name}")
        field.prop(group, name, text="")
    else:
        layout.prop(group, name)


def _stored(settings: Any) -> dict[str, Any]:
    return designs.parsed(settings.design)


class VOXELASTICA_PT_target(_Child, bpy.types.Panel):
    """The dome."""

    bl_label = "Target"
    bl_order = 1
    bl_options = set()

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        target = settings.target
        layout.prop(target, "kind")
        if target.kind == "hemi-ellipsoid":
            layout.prop(target, "aspect_ratio")
        elif target.kind == "inclination-polynomial":
            self._coefficients(layout, target)
        elif target.kind == "points":
            layout.prop(target, "file")
        else:
            layout.prop(settings, "target_object")
            layout.prop(target, "axis")
            row = layout.row(align=True)
            row.operator("voxelastica.use_mesh", text="Take from Mesh", icon="FILE_REFRESH")
            row.operator("voxelastica.keep_size", text="Keep Its Size")
            if settings.meridian_note and settings.meridian_kind == "mesh":
                say(layout, context, settings.meridian_note)
        self._size(layout, context, settings)

    def _coefficients(self, layout: Any, target: Any) -> None:
        numbers = target.coefficients_deg
        row = layout.row()
        row.label(text=f"{properties.known()['target.coefficients_deg'].label} of xi, from rim (0) to hub (1)")
        for sign in (True, False):
            part = row.row()
            part.enabled = sign and len(numbers) < 21 or not sign and len(numbers) > 1
            change = part.operator("voxelastica.list", text="", icon="ADD" if sign else "REMOVE")
            change.what, change.add = "coefficients", sign
        column = layout.column(align=True)
        for i, item in enumerate(numbers):
            power = len(numbers) - 1 - i
            column.prop(item, "value", text=f"xi^{power}" if power > 1 else ("xi", "1")[power == 0])

    def _size(self, layout: Any, context: bpy.types.Context, settings: Any) -> None:
        design = _stored(settings)
        if not design or settings.problem:
            return
        found = designs.stored(settings.design)
        summary, strips = found.design.summary, design["strips"]
        unit = flower.unit_mm(context.scene)
        across = 2 * (strips["hub_radius_mm"] + strips["length_mm"])
        column = layout.column(align=True)
        column.label(text=f"Flat: {across:.4g} mm across, {across / unit:.3g} units of the scene")
        column.label(text=f"Closed: {2 * summary['rim_radius_mm']:.4g} mm across, {summary['height_mm']:.4g} mm high")
        scale = preview.scale_of_mesh(settings, found)
        if scale is not None:
            column.label(text=f"Scale: {scale:.4g} of the mesh; the length rules it")


class VOXELASTICA_PT_spokes(_Child, bpy.types.Panel):
    """Number and size of the spokes."""

    bl_label = "Spokes"
    bl_order = 2
    bl_options = set()

    def show(self, layout: Any, context: bpy.types.Context, root: bpy.types.Object, settings: Any) -> None:
        column = layout.column()
        for field in properties.known().values():
            if field.table == "strips":
                column.prop(settings.strips, field.name)


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
        if not settings.design:
            return
        summary = designs.stored(settings.design).design.summary
        per, total = summary["thrust"]["per_spoke"], summary["thrust"]["total"]

        def span(values: Any, key: str) -> str:
            low, high = values["beam"][key], values["plane_strain"][key]
            return f"{low:.3g} to {high:.3g} N" if low != high else f"{low:.3g} N"

        column = layout.column(align=True)
        column.label(text=f"Force on the hub: {span(total, 'vertical_n')}")
        column.label(text=f"Thrust at each rim seat: {span(per, 'horizontal_n')}")
        column.label(
            text=f"Contrast: {summary['contrast']:.3g} of {summary['contrast_reach']:.3g} that the phases reach"
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
            layout.prop(materials, "intermediate_fraction")
        for i, item in enumerate(materials.custom):
            box = layout.box()
            row = box.row()
            row.prop(item, "name", text="")
            change = row.operator("voxelastica.list", text="", icon="X")
            change.what, change.add, change.index = "materials", False, i
            for field in properties.known().values():
                if field.table == "materials.custom" and field.name != "name":
                    _optional(box, item, field.name)
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
                _optional(layout, settings.voxels, field.name)
        if settings.design:
            summary = designs.stored(settings.design).design.summary
            column = layout.column(align=True)
            column.label(text=f"{summary['voxels_per_spoke']:,} voxels a spoke")
            if summary.get("predicted_error_percent") is not None:
                column.label(text=f"Predicted: {summary['predicted_error_percent']:.2g} % of the length off the target")


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
            layout.prop(settings, "voxel_limit")
            layout.prop(settings, "voxel_phase")
            if settings.voxels_note:
                say(layout, context, settings.voxels_note)
        column = layout.column(align=True)
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
        for table, heading in (("decks", "Decks"), ("fabrication", "Print Files and glTF")):
            header, body = layout.panel(f"voxelastica_{table}", default_closed=True)
            chosen = getattr(settings, table).write
            header.label(text=f"{heading}: {len(chosen)} kinds" if chosen else f"{heading}: none")
            if body is None:
                continue
            for field in properties.known().values():
                if field.table != table or (field.name == "pitch_um" and settings.fabrication.printer != "custom"):
                    continue
                if field.type == "choices":
                    column = body.column(heading=field.label)
                    column.prop(getattr(settings, table), field.name, expand=False)
                else:
                    _optional(body, getattr(settings, table), field.name)
        if not _running(layout, root, "Export"):
            layout.operator("voxelastica.export", text="Export", icon="EXPORT")
        if settings.export_note:
            say(layout, context, settings.export_note)


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
            for note in results.verify_notes(record, _stored(settings)):
                say(layout, context, note)
            layout.prop(settings, "show_midline")


CLASSES = (
    VOXELASTICA_PT_main,
    VOXELASTICA_PT_target,
    VOXELASTICA_PT_spokes,
    VOXELASTICA_PT_thrust,
    VOXELASTICA_PT_materials,
    VOXELASTICA_PT_voxels,
    VOXELASTICA_PT_preview,
    VOXELASTICA_PT_export,
    VOXELASTICA_PT_verify,
)
