# SPDX-License-Identifier: GPL-3.0-or-later
"""The morph on the timeline: operators."""

from __future__ import annotations

import bpy
from bpy.props import FloatProperty, IntProperty

from . import animation, flower
from .common import has_flower


class VOXELASTICA_OT_animate(bpy.types.Operator):
    """Key the morph on the timeline, as shape keys of true states that any renderer and exporter understands"""

    bl_idname = "voxelastica.animate"
    bl_label = "Animate Voxelastica Morph"
    bl_options = {"REGISTER", "UNDO"}

    first: IntProperty(name="Flat at Frame", default=1)
    last: IntProperty(name="Closed at Frame", default=60)
    percent: FloatProperty(
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
    VOXELASTICA_OT_animate,
    VOXELASTICA_OT_unanimate,
)
