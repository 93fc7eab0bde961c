# SPDX-License-Identifier: GPL-3.0-or-later
"""Export and verification: operators that run beside Blender."""

from __future__ import annotations

import json
import shutil

import bpy
from bpy.props import StringProperty

from ..logic import results
from ..logic.job import Job
from ..logic.messages import said
from . import flower, jobs, preview
from .common import has_flower
from .preferences import preferences


def _idle(cls: type, context: bpy.types.Context) -> bool:
    if not has_flower(cls, context):
        return False
    root = flower.shown(context)
    job = jobs.running(root)
    if job:
        cls.poll_message_set(f"{job.name} is still running: wait for it, or cancel it")
        return False
    if root.voxelastica.problem or flower.prepared(root) is None:
        cls.poll_message_set("The design as set cannot be made: see the message at the top of the panel")
        return False
    return True


def _failed(job: Job, what: str) -> str:
    """What is said of a job that ended badly; empty where it did not."""
    if job.error is None:
        return ""
    if job.cancelled:
        return f"{what} was cancelled"
    return f"{what} failed: {said(job.error)}"


class VOXELASTICA_OT_export(bpy.types.Operator):
    """Write the design's decks, print files, tables and report into a folder of its own"""

    bl_idname = "voxelastica.export"
    bl_label = "Export Voxelastica Design"

    folder: StringProperty(
        name="Folder",
        description="Where the design's own folder is made; empty: the flower's",
        subtype="DIR_PATH",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _idle(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        settings = root.voxelastica
        chosen = self.folder or settings.folder or preferences(context).folder
        saved = bool(bpy.data.filepath)
        try:
            name = settings.design_name or "flower"
            folder = results.destination(bpy.path.abspath(chosen) if saved else chosen, name, saved)
        except ValueError as error:
            settings.export_note = str(error)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        design = flower.prepared(root).design

        def finish(root: bpy.types.Object, job: Job) -> None:
            note = _failed(job, "Export") or results.export_note(job.result, folder)
            root.voxelastica.export_note = note

        settings.export_note = ""
        job = jobs.start(root, "Export", lambda progress: results.exported(design, folder, progress), finish)
        if job.finished and job.error:
            self.report({"ERROR"}, settings.export_note)
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_OT_verify(bpy.types.Operator):
    """Let a solver morph a spoke, compare its mid-line with the target and lay it over the flower"""

    bl_idname = "voxelastica.verify"
    bl_label = "Verify Voxelastica Design"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _idle(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        settings = root.voxelastica
        ccx = preferences(context).ccx or "ccx"
        ccx = bpy.path.abspath(ccx) if ccx.startswith("//") else ccx
        if settings.verify_solver == "ccx" and not shutil.which(ccx):
            settings.verify_note = (
                f"CalculiX was not found as {ccx!r}: install it and set its path in the add-on's preferences, "
                "or use the built-in solver."
            )
            self.report({"ERROR"}, settings.verify_note)
            return {"CANCELLED"}
        design, model, solver = flower.prepared(root).design, settings.verify_model, settings.verify_solver

        def finish(root: bpy.types.Object, job: Job) -> None:
            stored = root.voxelastica
            stored.verify_note = _failed(job, "Verification")
            if not stored.verify_note:
                stored.verification = json.dumps(job.result)
                preview.look_changed(root)

        settings.verify_note = ""
        job = jobs.start(
            root, "Verification", lambda progress: results.verified(design, model, solver, ccx, progress), finish
        )
        if job.finished and job.error:
            self.report({"ERROR"}, settings.verify_note)
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_OT_refine(bpy.types.Operator):
    """Let the finite elements correct the modulus until the voxels take the shape; every preview and export is then the corrected design"""

    bl_idname = "voxelastica.refine"
    bl_label = "Refine Voxelastica Design"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _idle(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        settings = root.voxelastica
        design, iterations = flower.prepared(root).design, settings.refine_iterations

        def finish(root: bpy.types.Object, job: Job) -> None:
            stored = root.voxelastica
            stored.refine_note = _failed(job, "Refinement")
            if not stored.refine_note:
                stored.refinement = json.dumps(job.result)
                preview.design_changed(root)

        settings.refine_note = ""
        job = jobs.start(root, "Refinement", lambda progress: results.refined(design, iterations, progress), finish)
        if job.finished and job.error:
            self.report({"ERROR"}, settings.refine_note)
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_OT_unrefine(bpy.types.Operator):
    """Take the correction off again"""

    bl_idname = "voxelastica.unrefine"
    bl_label = "Drop the Correction of the Voxelastica Design"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not _idle(cls, context):
            return False
        if not flower.shown(context).voxelastica.refinement:
            cls.poll_message_set("The design is not corrected")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        root.voxelastica.refinement = ""
        preview.design_changed(root)
        return {"FINISHED"}


class VOXELASTICA_OT_conduct(bpy.types.Operator):
    """Let heat or current through a spoke's voxels: effective conductivity and, in time, the critical time"""

    bl_idname = "voxelastica.conduct"
    bl_label = "Conduct through Voxelastica Design"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _idle(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        root = flower.shown(context)
        settings = root.voxelastica
        design = flower.prepared(root).design
        flow, regime, shape = settings.conduct_flow, settings.conduct_regime, settings.conduct_shape

        def finish(root: bpy.types.Object, job: Job) -> None:
            stored = root.voxelastica
            stored.conduct_note = _failed(job, "Conduction")
            if not stored.conduct_note:
                stored.conduction = json.dumps(job.result)

        settings.conduct_note = ""
        job = jobs.start(
            root, "Conduction", lambda progress: results.conducted(design, flow, regime, shape, progress), finish
        )
        if job.finished and job.error:
            self.report({"ERROR"}, settings.conduct_note)
            return {"CANCELLED"}
        return {"FINISHED"}


class VOXELASTICA_OT_cancel(bpy.types.Operator):
    """Cancel what runs for this flower; nothing half-written stays"""

    bl_idname = "voxelastica.cancel"
    bl_label = "Cancel Voxelastica Job"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        root = flower.shown(context)
        if root is None or jobs.running(root) is None:
            cls.poll_message_set("Nothing is running for this flower")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        jobs.running(flower.shown(context)).cancel()
        return {"FINISHED"}


CLASSES = (
    VOXELASTICA_OT_export,
    VOXELASTICA_OT_verify,
    VOXELASTICA_OT_refine,
    VOXELASTICA_OT_unrefine,
    VOXELASTICA_OT_conduct,
    VOXELASTICA_OT_cancel,
)
