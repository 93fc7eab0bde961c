# SPDX-License-Identifier: GPL-3.0-or-later
"""Changing a flower beyond what its sliders do."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty

from . import fields, flower, preview
from .common import has_flower


class VOXELASTICA_OT_use_mesh(bpy.types.Operator):
    """Take the target of the shown flower from the active mesh, or take it anew after the mesh was changed"""

    bl_idname = "voxelastica.use_mesh"
    bl_label = "Take Voxelastica Target from Mesh"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not has_flower(cls, context):
            return False
        active = context.object
        chosen = active is not None and active.type == "MESH" and active.voxelastica.part == "NONE"
        if not chosen and flower.shown(context).voxelastica.target_object is None:
            cls.poll_message_set("Make a mesh active, or choose one in the field Mesh")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        root, active = flower.shown(context), context.object
        if active is not None and active.type == "MESH" and active.voxelastica.part == "NONE":
            with fields.quiet():
                root.voxelastica.target_object = active
        preview.mesh_changed(root)
        if root.voxelastica.problem:
            self.report({"ERROR"}, root.voxelastica.problem)
            return {"CANCELLED"}
        self.report({"INFO"}, root.voxelastica.meridian_note)
        return {"FINISHED"}


class VOXELASTICA_OT_keep_size(bpy.types.Operator):
    """Set the length such that the dome is as large as the mesh it was taken from"""

    bl_idname = "voxelastica.keep_size"
    bl_label = "Keep the Mesh's Size"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not has_flower(cls, context):
            return False
        if flower.shown(context).voxelastica.target.kind != "mesh":
            cls.poll_message_set("The target is no mesh: its size is the length's alone")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        settings = root.voxelastica
        # Scale and cut depend on each other; the voxels need a length that they divide.
        for _ in range(20):
            found = flower.prepared(root)
            scale = preview.scale_of_mesh(settings, found) if found else None
            if scale is None or settings.problem:
                break
            edge = settings.voxels.size_mm
            length = max(1, round(settings.strips.length_mm / scale / edge)) * edge
            if abs(length - settings.strips.length_mm) < 0.5 * edge:
                break
            settings.strips.length_mm = length
        if settings.problem:
            self.report({"ERROR"}, settings.problem)
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_OT_update(bpy.types.Operator):
    """Compute the design again and replace everything that was made for it"""

    bl_idname = "voxelastica.update"
    bl_label = "Update Voxelastica Flower"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_flower(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        preview.design_changed(root)
        if root.voxelastica.problem:
            self.report({"ERROR"}, root.voxelastica.problem)
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_OT_list(bpy.types.Operator):
    """Add to or remove from a list of the design"""

    bl_idname = "voxelastica.list"
    bl_label = "Change a List of the Voxelastica Design"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    what: EnumProperty(
        items=[
            ("coefficients", "Coefficients", "Of the inclination's polynomial"),
            ("phases", "Phases", "Two or three"),
            ("materials", "Materials", "Custom materials"),
        ]
    )
    add: BoolProperty(default=True)
    index: IntProperty(default=-1)

    @classmethod
    def description(cls, _context: bpy.types.Context, given: Any) -> str:
        words = {"coefficients": "coefficient", "phases": "phase", "materials": "custom material"}
        return f"{'Add' if given.add else 'Remove'} a {words[given.what]}"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return has_flower(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        settings = root.voxelastica
        numbers = {
            "coefficients": settings.target.coefficients_deg,
            "phases": settings.materials.phases,
            "materials": settings.materials.custom,
        }[self.what]
        with fields.quiet():
            if not self.add:
                numbers.remove(
                    self.index if self.index >= 0 else 0 if self.what == "coefficients" else len(numbers) - 1
                )
            elif self.what == "coefficients":
                numbers.add().value = 0.0
                numbers.move(len(numbers) - 1, 0)  # The highest power comes first.
            elif self.what == "materials":
                item = numbers.add()
                item.name = f"material {len(numbers)}"
            else:
                numbers.add()
        preview.design_changed(root)
        return {"FINISHED"}


class VOXELASTICA_OT_show_colours(bpy.types.Operator):
    """Let this 3D view show the colours of attributes in its solid shading"""

    bl_idname = "voxelastica.show_colours"
    bl_label = "Show Voxelastica Colours in This View"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.space_data is None or context.space_data.type != "VIEW_3D":
            cls.poll_message_set("This works in a 3D view")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        context.space_data.shading.color_type = "VERTEX"
        return {"FINISHED"}


CLASSES = (
    VOXELASTICA_OT_use_mesh,
    VOXELASTICA_OT_keep_size,
    VOXELASTICA_OT_update,
    VOXELASTICA_OT_list,
    VOXELASTICA_OT_show_colours,
)
