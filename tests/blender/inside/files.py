"""Several designs in one file; undo, save, reload; re-running replaces what it made and touches nothing else."""

from __future__ import annotations

import bpy
import host
import numpy as np

host.install()
bpy.context.preferences.edit.use_global_undo = True


def everything() -> dict[str, object]:
    """What stands in the file, but for flowers and their parts."""
    return {
        "objects": sorted(o.name for o in bpy.data.objects if o.voxelastica.part == "NONE"),
        "meshes": sorted(
            m.name
            for m in bpy.data.meshes
            if "spokes" not in m.name and not any(word in m.name for word in ("hub", "target", "legend", "voxels"))
        ),
        "unit": bpy.context.scene.unit_settings.scale_length,
        "frame": bpy.context.scene.frame_current,
        "cube": tuple(host.points(bpy.data.objects["Cube"]).ravel()),
    }


bpy.ops.mesh.primitive_cube_add() if "Cube" not in bpy.data.objects else None
bpy.data.objects["Cube"].name = "Cube"
others = everything()
bpy.ops.ed.undo_push(message="start")

# Undo takes back what a slider did, design and mesh together.
first = host.new()
bpy.ops.ed.undo_push(message="new")
flat, stored = host.points(first), first.voxelastica.design
first.voxelastica.morph = 1.0
first.voxelastica.strips.count = 6
first.voxelastica.show_voxels = True
bpy.ops.ed.undo_push(message="changed")
assert bpy.ops.ed.undo() == {"FINISHED"}
first = bpy.data.objects["Hemisphere"]
assert first.voxelastica.morph == 0 and first.voxelastica.strips.count == 8
assert np.array_equal(host.points(first), flat) and first.voxelastica.design == stored
assert host.part(first, "VOXELS") is None
bpy.ops.ed.redo()
first = bpy.data.objects["Hemisphere"]
assert first.voxelastica.strips.count == 6 and len(first.data.vertices) == 6 * 201 * 17
assert len(host.part(first, "VOXELS").data.vertices) > 10_000
bpy.ops.ed.undo()
bpy.ops.ed.undo()
assert "Hemisphere" not in bpy.data.objects and everything() == others

# Two designs, each with its own parts; re-running makes nothing twice.
first, second = host.new("hemisphere"), host.new("trumpet")
for root in (first, second):
    root.voxelastica.show_voxels = True
    names = sorted(child.name for child in root.children)
    count = (len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.curves), len(bpy.data.materials))
    bpy.context.view_layer.objects.active = root
    assert bpy.ops.voxelastica.update() == {"FINISHED"}
    root.voxelastica.strips.count += 1
    root.voxelastica.strips.count -= 1
    assert sorted(child.name for child in root.children) == names
    assert count == (len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.curves), len(bpy.data.materials))
assert everything() == others
assert host.design(first).spokes == 8 and host.design(second).input["thrust"]["hub"] == "held"
moved = (1.0, 2.0, 3.0)
second.location = moved
first.voxelastica.morph = 0.5
first.voxelastica.colour_by = "curvature"

# A meridian that came from a file is kept with the object.
csv = host.scratch() / "meridian.csv"
angles = np.linspace(0, np.pi / 2, 60)
csv.write_text("rho,z\n" + "\n".join(f"{50 * np.cos(a):.9g},{30 * np.sin(a):.9g}" for a in angles))
third = host.new("hemisphere")
third.name = "From points"
with host.module("ui.fields").quiet():
    third.voxelastica.target.file = str(csv)
third.voxelastica.target.kind = "points"
assert third.voxelastica.problem == "", third.voxelastica.problem

# Save and load.
before = {
    root.name: (host.points(root), root.voxelastica.design, root.voxelastica.morph, host.design(root).hash)
    for root in (first, second, third)
}
path = host.scratch() / "three flowers.blend"
bpy.ops.wm.save_as_mainfile(filepath=str(path))
csv.unlink()
bpy.ops.wm.read_homefile()
assert "Hemisphere" not in bpy.data.objects
host.module("logic.designs").forget()
bpy.ops.wm.open_mainfile(filepath=str(path))
for name, (points, stored, morph, hash_) in before.items():
    root = bpy.data.objects[name]
    assert np.array_equal(host.points(root), points) and root.voxelastica.design == stored
    assert root.voxelastica.morph == morph and host.design(root).hash == hash_
assert tuple(bpy.data.objects["Trumpet"].location) == moved
third = bpy.data.objects["From points"]
third.voxelastica.strips.count = 10
assert third.voxelastica.problem == "" and "not there any more" in third.voxelastica.hint, third.voxelastica.hint
first = bpy.data.objects["Hemisphere"]
first.voxelastica.morph = 1.0
assert abs(host.points(first)[:, 2].max() * 1000 - host.design(first).summary["height_mm"]) < 1e-3

# Beside the .blend file.
bpy.context.view_layer.objects.active = first
first.voxelastica.decks.write = {"graded_solid"}
first.voxelastica.folder = "//results"
assert bpy.ops.voxelastica.export() == {"FINISHED"}, first.voxelastica.export_note
assert (host.scratch() / "results" / "hemisphere" / "design.json").is_file(), first.voxelastica.export_note

# A design.json is a design file.
assert bpy.ops.voxelastica.import_design(filepath=str(host.scratch() / "results" / "hemisphere" / "design.json")) == {
    "FINISHED"
}
assert host.design(bpy.context.object).hash == host.design(first).hash

# A duplicate and a linked duplicate go their own ways.
for linked in (False, True):
    first.select_set(True)
    for other in bpy.context.selected_objects:
        other.select_set(other == first)
    bpy.context.view_layer.objects.active = first
    bpy.ops.object.duplicate(linked=linked)
    copy = bpy.context.object
    assert copy != first and copy.voxelastica.design == first.voxelastica.design
    before = host.points(first)
    copy.voxelastica.strips.count = 5
    assert len(copy.data.vertices) == 5 * 201 * 17 and np.array_equal(host.points(first), before)
    assert host.part(copy, "HUB") is not None

# Deleting a flower takes its parts and their data, and nothing else.
bpy.context.view_layer.objects.active = copy
meshes = len(bpy.data.meshes)
left = {o.name for o in bpy.data.objects} - {copy.name} - {child.name for child in copy.children}
assert bpy.ops.voxelastica.remove() == {"FINISHED"}
assert {o.name for o in bpy.data.objects} == left and len(bpy.data.meshes) < meshes

# Presets of the user.
bpy.context.view_layer.objects.active = third
assert bpy.ops.voxelastica.preset_save(name="my points") == {"FINISHED"}
host.refused(bpy.ops.voxelastica.preset_save, "preset of the add-on", name="roof")
host.refused(bpy.ops.voxelastica.preset_save, "no name", name="../escape")
fourth = host.new("my points")
assert fourth.voxelastica.problem == "", fourth.voxelastica.problem
assert host.design(fourth).input["strips"]["count"] == 10 and host.design(fourth).input["target"]["kind"] == "points"
assert bpy.ops.voxelastica.preset_remove(preset="my points") == {"FINISHED"}
host.refused(bpy.ops.voxelastica.new, "my points", preset="my points")
host.done()
