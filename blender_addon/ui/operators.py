# SPDX-License-Identifier: GPL-3.0-or-later
"""Making flowers and setting them up."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper
from mathutils import Vector

from ..logic import library, presets
from . import animation, flower, jobs, preview, properties
from .preferences import PACKAGE, preferences


def preset_folder(create: bool = False) -> Path:
    """Where the user's presets are kept."""
    return Path(bpy.utils.extension_path_user(PACKAGE, path="presets", create=create))


def preset_files() -> dict[str, Path]:
    """All presets by name: those that come with the add-on, then the user's."""
    return presets.bundled() | presets.saved(preset_folder())


def ready(cls: Any) -> bool:
    """Whether the library is there; else says so."""
    if library.problem():
        cls.poll_message_set("Voxelastica's library did not load; the panel says why")
        return False
    return True


def has_flower(cls: Any, context: bpy.types.Context) -> bool:
    """Whether there is a flower to work on; else says so."""
    if not ready(cls):
        return False
    root = flower.shown(context)
    if root is None:
        cls.poll_message_set("Select a flower, or make one with New Flower")
        return False
    if root.library or root.override_library:
        cls.poll_message_set("This flower is linked from another file: make it local first")
        return False
    if root.mode == "EDIT":
        cls.poll_message_set("Leave Edit Mode first")
        return False
    return True


def make(context: bpy.types.Context, design: dict[str, Any], name: str) -> bpy.types.Object:
    """A new flower at the 3D cursor, with a design."""
    root = bpy.data.objects.new(name, bpy.data.meshes.new(f"{name} spokes"))
    context.collection.objects.link(root)
    root.location = context.scene.cursor.location
    settings = root.voxelastica
    settings.part = "SPOKES"
    own = preferences(context)
    with properties.quiet():
        settings.folder = own.folder
        settings.voxel_limit = own.voxel_limit
    properties.assign(settings, design | {"name": design.get("name") or name})
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
        with properties.quiet():
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
            with properties.quiet():
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
        with properties.quiet():
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


class VOXELASTICA_OT_import(bpy.types.Operator, ImportHelper):
    """Make a flower from a design file: TOML, or the design.json of an earlier result"""

    bl_idname = "voxelastica.import_design"
    bl_label = "Import Voxelastica Design"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.toml;*.json", options={"HIDDEN"})

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
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
            with properties.quiet():
                settings.target.file = str((path.parent / design["target"]["file"]).resolve())
        preview.design_changed(root)
        _show(context, root)
        if settings.problem:
            self.report({"WARNING"}, settings.problem)
        return {"FINISHED"}


class VOXELASTICA_OT_animate(bpy.types.Operator):
    """Key the morph on the timeline, as shape keys of true states that any renderer and exporter understands"""

    bl_idname = "voxelastica.animate"
    bl_label = "Animate Voxelastica Morph"
    bl_options = {"REGISTER", "UNDO"}

    first: IntProperty(name="Flat at Frame", default=1)
    last: IntProperty(name="Closed at Frame", default=60)
    percent: bpy.props.FloatProperty(
        name="Tolerance (%)",
        description="Largest distance from the true path between two states, percent of the length",
        default=0.25,
        min=0.01,
        max=0.5,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not has_flower(cls, context):
            return False
        if not flower.shown(context).voxelastica.design:
            cls.poll_message_set("There is no design to animate yet: see the message in the panel")
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self.first, self.last = context.scene.frame_start, min(context.scene.frame_end, context.scene.frame_start + 59)
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        if self.last <= self.first:
            self.report({"ERROR"}, f"The flower closes at frame {self.last}, not after it is flat at {self.first}")
            return {"CANCELLED"}
        try:
            animation.animate(flower.shown(context), self.first, self.last, self.percent)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_OT_unanimate(bpy.types.Operator):
    """Remove the shape keys and the morph's keyframes; the flower follows the slider alone again"""

    bl_idname = "voxelastica.unanimate"
    bl_label = "Remove Voxelastica Animation"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not has_flower(cls, context):
            return False
        if not flower.shown(context).voxelastica.states:
            cls.poll_message_set("The flower is not animated")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        animation.clear(flower.shown(context))
        return {"FINISHED"}


CLASSES = (
    VOXELASTICA_OT_new,
    VOXELASTICA_OT_from_mesh,
    VOXELASTICA_OT_use_mesh,
    VOXELASTICA_OT_keep_size,
    VOXELASTICA_OT_update,
    VOXELASTICA_OT_remove,
    VOXELASTICA_OT_show_colours,
    VOXELASTICA_OT_list,
    VOXELASTICA_OT_import,
    VOXELASTICA_OT_animate,
    VOXELASTICA_OT_unanimate,
)
