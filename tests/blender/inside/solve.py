"""Verification and export beside Blender: results, cancelling, the overlay, and ccx where it is there."""

from __future__ import annotations

import json
import shutil
import time

import bpy
import host
import numpy as np

host.install()
jobs, results = host.module("ui.jobs"), host.module("logic.results")
bpy.context.scene.unit_settings.scale_length = 0.001
root = host.new()
settings = root.voxelastica
settings.strips.length_mm, settings.strips.hub_radius_mm = 40.0, 4.0
settings.voxels.size_mm = 1.0
settings.decks.write, settings.decks.solvers = {"graded_solid", "voxel_solid"}, {"calculix"}
assert settings.problem == ""

assert bpy.ops.voxelastica.verify() == {"FINISHED"}, settings.verify_note
record = json.loads(settings.verification)
direct = host.design(root).verify("voxel")
assert record["max_error_percent"] == direct["max_error_percent"] < 2
notes = results.verify_notes(record, host.design(root).input)
assert f"{direct['max_error_percent']:.3f} %" in notes[0] and "Built-in solver" in notes[2], notes
assert not any("changed" in note for note in notes)
# The overlay lies over the target: every spoke has its line, as far off as the error says.
rings = (host.points(host.part(root, "MIDLINE"))).reshape(8, len(record["midline_mm"]), 6, 3)
points = rings[0].mean(axis=1)
profile = host.design(root).profile
true = np.stack(
    [np.interp(np.array(record["midline_mm"])[:, 0], profile.s_mm, c) for c in (profile.rho_mm, profile.z_mm)]
)
off = float(np.hypot(points[:, 0] - true[0], points[:, 2] - true[1]).max())
assert abs(100 * off / 40 - record["max_error_percent"]) < 0.02, (off, record["max_error_percent"])
# Names and files do not make a result stale; the mechanics do.
settings.design_name = "another"
settings.decks.style = "flat"
assert not any("changed" in note for note in results.verify_notes(record, host.design(root).input))
settings.strips.count = 9
assert any("changed" in note for note in results.verify_notes(record, host.design(root).input))
settings.show_midline = False
assert host.part(root, "MIDLINE") is None
settings.show_midline = True
settings.strips.count = 8

# In a window jobs run beside Blender: the main thread stays free, progress is told, cancelling works.
settings.strips.length_mm, settings.strips.hub_radius_mm, settings.voxels.size_mm = 60.0, 6.0, 0.5
design = host.design(root)
ended = []


def finish(found: bpy.types.Object, job: object) -> None:
    """What happens at the end of a job."""
    ended.append((found.name, job))


job = host.module("logic.job").Job("test", lambda progress: results.verified(design, "voxel", "embedded", "", progress))
jobs._jobs[root.session_uid] = (job, finish)
assert jobs.running(root) is job and not bpy.ops.voxelastica.verify.poll() and bpy.ops.voxelastica.cancel.poll()
turns, start = 0, time.monotonic()
while not job.finished and (job.share < 0.02 or turns < 20) and time.monotonic() - start < 120:
    settings.morph = (turns % 10) / 10
    assert jobs.look() is not None or job.finished
    turns += 1
    time.sleep(0.01)
host.report(f"while the solver ran the morph was moved {turns} times in {time.monotonic() - start:.1f} s")
assert bpy.ops.voxelastica.cancel() == {"FINISHED"}
assert job.wait(120)
assert jobs.look() is None and ended == [(root.name, job)], ended
# On a very fast machine the solver may have ended before it was cancelled.
assert job.cancelled and (job.error is None or job.error.code == job.error.CANCELLED), job.error
assert jobs.running(root) is None

# A flower that is gone when its job ends is no error.
gone = host.new()
job = host.module("logic.job").Job("test", lambda progress: 1)
jobs._jobs[gone.session_uid] = (job, finish)
bpy.data.objects.remove(gone)
job.wait()
jobs.look()
assert len(ended) == 1

# Cancelled export leaves nothing behind.
target = host.scratch() / "cancelled"
stop = host.module("logic.job").Job("test", lambda progress: results.exported(design, target, lambda a, b: False))
stop.wait()
assert stop.error.code == 130 and not target.exists()

# CalculiX.
bpy.context.view_layer.objects.active = root
if shutil.which("ccx"):
    settings.strips.length_mm, settings.strips.hub_radius_mm, settings.voxels.size_mm = 40.0, 4.0, 1.0
    settings.decks.calculix_graded_elements = (24, 4, 2)
    settings.verify_solver, settings.verify_model = "ccx", "graded"
    assert bpy.ops.voxelastica.verify() == {"FINISHED"}, settings.verify_note
    record = json.loads(settings.verification)
    assert record["solver"]["name"] == "CalculiX" and record["max_error_percent"] < 1, record["max_error_percent"]
    host.report(f"CalculiX from Blender: {record['max_error_percent']:.3f} % in {record['seconds']:.1f} s")
    settings.decks.solvers = {"abaqus"}
    host.refused(bpy.ops.voxelastica.verify, "decks.solvers")
    settings.decks.solvers = {"calculix"}
    settings.decks.write = {"voxel_solid"}
    host.refused(bpy.ops.voxelastica.verify, "decks.write")
else:
    host.report("CalculiX is not installed: not verified with it")

# Switching the add-on off ends what runs.
job = host.module("logic.job").Job(
    "test", lambda progress: [time.sleep(0.01) for _ in iter(lambda: progress(1, 2), False)]
)
jobs._jobs[root.session_uid] = (job, finish)
bpy.ops.preferences.addon_disable(module=host.NAME)
assert job.finished and job.cancelled
host.done()
