# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: designs that come with the add-on, and the user's own."""

from __future__ import annotations

import bpy
from bpy.props import StringProperty

from ..logic import designs, library, presets
from . import common, flower, form, preview


def name_of(preset: str) -> str:
    """A preset as the menu shows it."""
    return preset.replace("_", " ").capitalize() if preset in presets.bundled() else preset


class VOXELASTICA_OT_preset_apply(bpy.types.Operator):
    """Put a preset into the shown flower"""

    bl_idname = "voxelastica.preset_apply"
    bl_label = "Apply Voxelastica Preset"
    bl_options = {"REGISTER", "UNDO"}

    preset: StringProperty(name="Preset", search=lambda self, context, text: list(common.preset_files()))

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return common.has_flower(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        files = common.preset_files()
        try:
            if self.preset not in files:
                raise ValueError(f"There is no preset {self.preset!r}; there are {', '.join(files)}")
            design = presets.read(files[self.preset])
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        root = flower.shown(context)
        form.assign(root.voxelastica, {"name": root.voxelastica.design_name} | design)
        preview.design_changed(root)
        if root.voxelastica.problem:
            self.report({"WARNING"}, root.voxelastica.problem)
        return {"FINISHED"}


class VOXELASTICA_OT_preset_save(bpy.types.Operator):
    """Keep the shown flower's design as a preset for all files"""

    bl_idname = "voxelastica.preset_save"
    bl_label = "Save Voxelastica Preset"

    name: StringProperty(name="Name", default="My flower")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not common.has_flower(cls, context):
            return False
        if not flower.shown(context).voxelastica.design:
            cls.poll_message_set("There is no design to keep yet: see the message in the panel")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        design = designs.parsed(flower.shown(context).voxelastica.design) | {"name": self.name}
        try:
            if self.name in presets.bundled():
                raise ValueError(f"{self.name!r} is a preset of the add-on: choose another name")
            presets.save(common.preset_folder(create=True), self.name, design)
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Saved the preset {self.name}")
        return {"FINISHED"}


class VOXELASTICA_OT_preset_remove(bpy.types.Operator):
    """Remove a preset that was saved"""

    bl_idname = "voxelastica.preset_remove"
    bl_label = "Remove Voxelastica Preset"

    preset: StringProperty(
        name="Preset", search=lambda self, context, text: list(presets.saved(common.preset_folder()))
    )

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        if not presets.saved(common.preset_folder()):
            cls.poll_message_set("No preset was saved")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, _context: bpy.types.Context) -> set[str]:
        try:
            presets.remove(common.preset_folder(), self.preset)
        except (KeyError, OSError) as error:
            self.report({"ERROR"}, f"The preset {self.preset!r} could not be removed: {error}")
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_MT_presets(bpy.types.Menu):
    """Designs to start from"""

    bl_idname = "VOXELASTICA_MT_presets"
    bl_label = "Presets"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "EXEC_DEFAULT"
        mine = presets.saved(common.preset_folder())
        for preset in presets.bundled() | mine:
            layout.operator("voxelastica.preset_apply", text=name_of(preset)).preset = preset
        layout.separator()
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator("voxelastica.preset_save", text="Save Preset...", icon="ADD")
        layout.operator("voxelastica.preset_remove", text="Remove Preset...", icon="REMOVE")


class VOXELASTICA_MT_new(bpy.types.Menu):
    """Make a flower at the 3D cursor"""

    bl_idname = "VOXELASTICA_MT_new"
    bl_label = "New Flower"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        for preset in common.preset_files():
            layout.operator("voxelastica.new", text=name_of(preset), icon="MESH_CIRCLE").preset = preset
        layout.separator()
        layout.operator("voxelastica.from_mesh", text="From Active Mesh", icon="MESH_UVSPHERE")
        layout.operator("voxelastica.import_design", text="From Design File...", icon="FILE_FOLDER")


def _add_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    if not library.problem():
        self.layout.menu(VOXELASTICA_MT_new.bl_idname, text="Voxelastica Flower", icon="MESH_CIRCLE")


def _import_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.operator("voxelastica.import_design", text="Voxelastica Design (.toml, .json)")


CLASSES = (
    VOXELASTICA_OT_preset_apply,
    VOXELASTICA_OT_preset_save,
    VOXELASTICA_OT_preset_remove,
    VOXELASTICA_MT_presets,
    VOXELASTICA_MT_new,
)
MENUS = ((bpy.types.VIEW3D_MT_mesh_add, _add_menu), (bpy.types.TOPBAR_MT_file_import, _import_menu))
