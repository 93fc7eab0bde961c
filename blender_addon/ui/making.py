# SPDX-License-Identifier: GPL-3.0-or-later
"""Making and deleting flowers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper
from mathutils import Vector

from ..logic import library, presets
from . import fields, flower, form, jobs, preview
from .common import has_flower, preset_files, ready
from .preferences import preferences


def make(context: bpy.types.Context, design: dict[str, Any], name: str) -> bpy.types.Object:
    """A new flower at the 3D cursor, with a design."""
    root = bpy.data.objects.new(name, bpy.data.meshes.new(f"{name} spokes"))
    context.collection.objects.link(root)
    root.location = context.scene.cursor.location
    settings = root.voxelastica
    settings.part = "SPOKES"
    own = preferences(context)
    with fields.quiet():
        settings.folder = own.folder
        settings.voxel_limit = own.voxel_limit
    form.assign(settings, design | {"name": design.get("name") or name})
    for selected in context.selected_objects:
        selected.select_set(False)
    root.select_set(True)
    context.view_layer.objects.active = root
    context.scene.voxelastica_shown = root.name
    return root


def _show(context: bpy.types.Context, root: bpy.types.Object) -> None:
    """Colours and the whole flower in the view that a flower was made in."""
    if not preferences(context).show_colours or context.space_data is None or context.space_data.type != "VIEW_3D":
        return
    context.space_data.shading.color_type = "VERTEX"
    frame(context.space_data.region_3d, root)


def frame(view: bpy.types.RegionView3D, root: bpy.types.Object) -> None:
    """Moves a view, but for a camera's, so that a flower and its legend are in it, sidebar or not."""
    found = flower.prepared(root)
    if found is None or view.view_perspective == "CAMERA":
        return
    strips = found.input["strips"]
    radius = (strips["hub_radius_mm"] + strips["length_mm"]) / flower.unit_mm(flower.scene_of(root))
    view.view_location = root.matrix_world @ Vector((0.45 * radius, 0.0, 0.15 * radius))
    view.view_distance = 3.2 * radius * max(root.matrix_world.to_scale())


class VOXELASTICA_OT_new(bpy.types.Operator):
    """Make a flower at the 3D cursor, from a preset"""

    bl_idname = "voxelastica.new"
    bl_label = "New Voxelastica Flower"
    bl_options = {"REGISTER", "UNDO"}

    preset: StringProperty(
        name="Preset",
        description="The design to start from",
        default=presets.FIRST,
        search=lambda self, context, text: list(preset_files()),
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave the present mode for Object Mode first")
            return False
        return ready(cls)

    def execute(self, context: bpy.types.Context) -> set[str]:
        files = preset_files()
        if self.preset not in files:
            self.report({"ERROR"}, f"There is no preset {self.preset!r}; there are {', '.join(files)}")
            return {"CANCELLED"}
        try:
            design = presets.read(files[self.preset])
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        root = make(context, {"name": self.preset} | design, self.preset.replace("_", " ").capitalize())
        preview.design_changed(root)
        _show(context, root)
        if root.voxelastica.problem:
            self.report({"WARNING"}, root.voxelastica.problem)
        return {"FINISHED"}


class VOXELASTICA_OT_from_mesh(bpy.types.Operator):
    """Make a flower that morphs into the active mesh, with its modifiers and scale"""

    bl_idname = "voxelastica.from_mesh"
    bl_label = "New Voxelastica Flower from Mesh"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        source = context.object
        if source is None or source.type != "MESH" or source.voxelastica.part != "NONE":
            cls.poll_message_set("Make a mesh active that is a surface of revolution, such as half a UV sphere")
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave the present mode for Object Mode first")
            return False
        return ready(cls)

    def execute(self, context: bpy.types.Context) -> set[str]:
        source = context.object
        root = make(context, presets.read(presets.bundled()[presets.FIRST]), f"{source.name} flower")
        settings = root.voxelastica
        with fields.quiet():
            settings.design_name = bpy.path.clean_name(source.name)
            settings.thrust.choice = "least-contrast"
            settings.target_object = source
        preview.mesh_changed(root)
        if not settings.meridian:
            # Nothing was taken: no empty flower is left behind.
            self.report({"ERROR"}, settings.problem)
            flower.remove(root)
            context.view_layer.objects.active = source
            source.select_set(True)
            return {"CANCELLED"}
        if settings.problem:  # The panel says what would help.
            self.report({"WARNING"}, settings.problem)
        _show(context, root)
        return {"FINISHED"}


class VOXELASTICA_OT_import(bpy.types.Operator, ImportHelper):
    """Make a flower from a design file: TOML, or the design.json of an earlier result"""

    bl_idname = "voxelastica.import_design"
    bl_label = "Import Voxelastica Design"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.toml;*.json", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave the present mode for Object Mode first")
            return False
        return ready(cls)

    def execute(self, context: bpy.types.Context) -> set[str]:
        path = Path(self.filepath)
        try:
            # The library reads it: it checks every key and takes meridians out of files.
            design = library.api().Design.from_file(path).input
        except library.api().VoxelasticaError as error:
            if error.code != error.INFEASIBLE:
                self.report({"ERROR"}, str(error))
                return {"CANCELLED"}
            design = presets.read(path)
        if design["target"]["kind"] == "strip":
            self.report({"ERROR"}, f'{path}: target.kind = "strip": this is a rectangular coupon, not a dome')
            return {"CANCELLED"}
        root = make(context, {"name": path.stem} | design, design.get("name") or path.stem)
        settings = root.voxelastica
        if design["target"]["kind"] == "mesh":
            settings.meridian_note = f"from {design['target'].get('file', path.name)}"
        if design["target"].get("file"):
            with fields.quiet():
                settings.target.file = str((path.parent / design["target"]["file"]).resolve())
        preview.design_changed(root)
        _show(context, root)
        if settings.problem:
            self.report({"WARNING"}, settings.problem)
        return {"FINISHED"}


class VOXELASTICA_OT_remove(bpy.types.Operator):
    """Delete the shown flower with its hub, target, voxels, legend and mid-line"""

    bl_idname = "voxelastica.remove"
    bl_label = "Delete Voxelastica Flower"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not has_flower(cls, context):
            return False
        job = jobs.running(flower.shown(context))
        if job:
            cls.poll_message_set(f"{job.name} is still running: cancel it first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        for child in list(flower.parts(root)):
            flower.remove(child)
        flower.remove(root)
        return {"FINISHED"}


CLASSES = (
    VOXELASTICA_OT_new,
    VOXELASTICA_OT_from_mesh,
    VOXELASTICA_OT_import,
    VOXELASTICA_OT_remove,
)
