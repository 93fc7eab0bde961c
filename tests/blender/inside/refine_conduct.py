"""Refinement and conduction beside Blender: results, what makes them stale, cancelling."""

from __future__ import annotations

import json

import bpy
import host

host.install()
results, jobs, Job = host.module("logic.results"), host.module("ui.jobs"), host.module("logic.job").Job
bpy.context.scene.unit_settings.scale_length = 0.001
root = host.new()
settings = root.voxelastica
settings.strips.length_mm, settings.strips.hub_radius_mm, settings.voxels.size_mm = 40.0, 4.0, 1.0
assert settings.problem == ""
plain = host.design(root)
before = plain.verify("voxel")["max_error_percent"]
assert not bpy.ops.voxelastica.unrefine.poll()

# The correction is kept with the flower, and all that is made of it is the corrected design's.
settings.refine_iterations = 3
assert bpy.ops.voxelastica.refine() == {"FINISHED"}, settings.refine_note
record = json.loads(settings.refinement)
assert abs(record["error_before_percent"] / before - 1) < 1e-3, (record, before)
assert record["error_after_percent"] < 0.7 * before, record
design = host.design(root)
assert design.input["refine"]["correction"] == record["refine"]["correction"]
after = design.verify("voxel")["max_error_percent"]
assert abs(record["error_after_percent"] / after - 1) < 1e-3, (record, after)
notes = results.refine_notes(record, design.input)
assert f"{record['error_before_percent']:.3f} %" in notes[0] and len(notes) == 2, notes
# Refining again starts from the plain design.
assert results.uncorrected(design).input == plain.input
# Another design is not corrected; names and files make it no other one.
settings.strips.count = 9
assert "refine" not in host.design(root).input
assert "refine again" in results.refine_notes(record, host.design(root).input)[-1]
settings.strips.count = 8
settings.design_name = "another"
assert "refine" in host.design(root).input
# Cancelled, the flower is as it was.
kept = settings.refinement
job = Job("test", lambda progress: results.refined(plain, 3, lambda done, total: False))
assert job.wait(120) and job.error.code == job.error.CANCELLED
assert settings.refinement == kept
assert bpy.ops.voxelastica.unrefine() == {"FINISHED"}
assert "refine" not in host.design(root).input and settings.refinement == ""

# Elastomers have no conductivity; filled thermoplastics have.
host.refused(bpy.ops.voxelastica.conduct, "conductivity")
assert "conductivity" in settings.conduct_note
settings.materials.phases[1].material = "PLA + 30 % carbon fibre"
settings.materials.phases[0].material = "PI + 15 % graphite"
assert settings.problem == "", settings.problem
settings.conduct_shape, settings.conduct_regime = "morphed", "both"
assert bpy.ops.voxelastica.conduct() == {"FINISHED"}, settings.conduct_note
record = json.loads(settings.conduction)
direct = host.design(root).conduct("heat", regime="both", shape="morphed")
assert record["effective_conductivity"] == direct["steady"]["effective_conductivity"]
assert record["series_bound"] < record["effective_conductivity"] < record["parallel_bound"]
assert record["critical_time_s"] == direct["transient"]["critical_times_s"][-1]
notes = results.conduct_notes(record, host.design(root).input)
assert "W/(m K)" in notes[0] and any("Assumed" in note for note in notes), notes
assert not any("changed" in note for note in notes)
settings.voxels.seed = 7
assert any("changed" in note for note in results.conduct_notes(record, host.design(root).input))
settings.conduct_flow, settings.conduct_regime = "current", "steady"
assert bpy.ops.voxelastica.conduct() == {"FINISHED"}, settings.conduct_note
assert "S/m" in results.conduct_notes(json.loads(settings.conduction), host.design(root).input)[0]
design = host.design(root)
job = Job("test", lambda progress: results.conducted(design, "heat", "both", "flat", lambda done, total: False))
assert job.wait(120) and job.error.code == job.error.CANCELLED
host.done()
