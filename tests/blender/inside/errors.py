"""Each error is a message where a user looks, and nothing is lost."""

from __future__ import annotations

import bpy
import host
import numpy as np

host.install()
root = host.new()
settings = root.voxelastica
good = host.points(root)
stored = settings.design


def wrong(*words: str) -> None:
    """The message holds the words; preview and design are the last good ones."""
    for word in words:
        assert word in settings.problem, (word, settings.problem)
    assert "Traceback" not in settings.problem
    assert settings.design == stored and np.array_equal(host.points(root), good)


def right() -> None:
    """No message any more."""
    assert settings.problem == "", settings.problem


# Wrong input: what would help is said.
settings.strips.thickness_mm = 2.3
wrong("voxels.size_mm", "0.1 mm")
settings.strips.thickness_mm = 2.0
right()
settings.materials.phases[0].material = "no such resin"
wrong("no such resin")
settings.materials.phases[0].material = "FLX9095"
settings.materials.phases[1].material = "FLX9070"
wrong("softest")
settings.materials.phases[0].material = "FLX9070"
settings.materials.phases[1].material = "FLX9095"
right()

# Infeasible: the nose cone standing freely needs more contrast than these resins have.
cone = host.module("logic.presets").read(host.module("logic.presets").bundled()["nose_cone"])
cone.pop("thrust")
host.module("ui.form").assign(settings, {"name": "hemisphere"} | cone)
host.module("ui.preview").design_changed(root)
wrong("contrast", "6.3")
for operator in (bpy.ops.voxelastica.export, bpy.ops.voxelastica.verify):
    assert not operator.poll()
settings.thrust.hub = "held"
right()
assert bpy.ops.voxelastica.preset_apply(preset="hemisphere") == {"FINISHED"}
right()
assert np.allclose(host.points(root), good)

# Targets that are not there.
settings.target.kind = "points"
wrong("CSV")
settings.target.file = "/nowhere/meridian.csv"
wrong("meridian.csv")
settings.target.kind = "mesh"
wrong("Choose a mesh")
settings.target.kind = "hemi-ellipsoid"
right()

# A mesh with no faces, an object that is no mesh, a cube.
mesh = bpy.data.meshes.new("points only")
mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 0, 1)], [], [])
loose = bpy.data.objects.new("points only", mesh)
bpy.context.collection.objects.link(loose)
settings.target_object = loose
wrong("points only", "no faces")
bpy.context.view_layer.objects.active = loose
count = len(bpy.data.objects)
host.refused(bpy.ops.voxelastica.from_mesh, "no faces")
assert len(bpy.data.objects) == count, "a flower without a design was left behind"
bpy.ops.mesh.primitive_cube_add()
host.refused(bpy.ops.voxelastica.from_mesh, "round", "refine the mesh")
bpy.ops.mesh.primitive_monkey_add()
host.refused(bpy.ops.voxelastica.from_mesh)
settings.target_object = None
settings.target.kind = "hemi-ellipsoid"
right()

# Design files that are none.
for name, text, word in (
    ("broken.toml", "[target\n", "broken.toml"),
    ("typo.toml", '[target]\nkind = "hemi-elipsoid"\n', "hemi-ellipsoid"),
    (
        "coupon.toml",
        '[target]\nkind="strip"\nwidth_mm=12.0\nrigid_fraction=0.5\n[strips]\nlength_mm=40.0\nthickness_mm=2.0\n'
        '[materials]\nphases=["FLX9070","FLX9095"]\n[voxels]\nsize_mm=1.0\n',
        "coupon",
    ),
):
    (host.scratch() / name).write_text(text)
    host.refused(bpy.ops.voxelastica.import_design, word, filepath=str(host.scratch() / name))
host.refused(bpy.ops.voxelastica.import_design, "gone.toml", filepath=str(host.scratch() / "gone.toml"))
host.refused(bpy.ops.voxelastica.new, "no preset", preset="no such preset")

# Folders that cannot be written to, and a .blend file that was never saved.
bpy.context.view_layer.objects.active = root
host.refused(bpy.ops.voxelastica.export, "Save the .blend file first")
(host.scratch() / "a file").write_text("in the folder's place")
said = host.refused(bpy.ops.voxelastica.export, "a file", folder=str(host.scratch() / "a file"))
assert "Export failed" in settings.export_note and said

# A missing ccx.
bpy.context.preferences.addons[host.NAME].preferences.ccx = "/nowhere/ccx"
settings.verify_solver = "ccx"
host.refused(bpy.ops.voxelastica.verify, "/nowhere/ccx", "preferences")
assert "/nowhere/ccx" in settings.verify_note
right()

# Edit mode: the mesh is the user's until it is left.
bpy.context.view_layer.objects.active = root
bpy.ops.object.mode_set(mode="EDIT")
assert not bpy.ops.voxelastica.export.poll() and not bpy.ops.voxelastica.new.poll()
settings.strips.count = 6
assert "Edit Mode" in settings.problem
bpy.ops.object.mode_set(mode="OBJECT")
assert bpy.ops.voxelastica.update() == {"FINISHED"}
right()
assert len(root.data.vertices) == 6 * 201 * 17

# Without a flower operators say so.
host.empty()
for name in (
    "remove",
    "update",
    "export",
    "verify",
    "animate",
    "unanimate",
    "cancel",
    "keep_size",
    "use_mesh",
    "preset_apply",
):
    assert not getattr(bpy.ops.voxelastica, name).poll(), name
host.done()
