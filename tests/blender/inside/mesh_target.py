"""A modelled dome as the target: scaled, rotated, moved, with modifiers, in the scene's unit."""

from __future__ import annotations

import json

import bpy
import host
import numpy as np

host.install()
import voxelastica  # noqa: E402


def off(root: bpy.types.Object, a: float, b: float) -> float:
    """Largest distance of a flower's profile from a true ellipse's, percent of the length."""
    keys = dict(host.design(root).input)
    angles = np.linspace(0, np.pi / 2, 400)
    points = np.stack([a * np.cos(angles), b * np.sin(angles)], axis=1)
    points[-1, 0] = 0.0
    keys["target"] = {"kind": "points", "meridian": points.tolist()}
    true, found = voxelastica.Design.from_dict(keys).profile, host.design(root).profile
    return 100 * float(np.hypot(true.x_mm - found.x_mm, true.z_mm - found.z_mm).max()) / keys["strips"]["length_mm"]


# An ellipsoid's upper half, anywhere and anyhow.
for scale in ((0.08, 0.08, 0.05), (0.06, 0.06, 0.06), (0.05, 0.05, 0.08)):
    host.empty()
    dome = host.dome(scale)
    dome.location, dome.rotation_euler = (3.0, -20.0, 5.0), (0.4, 1.1, -2.0)
    bpy.context.view_layer.update()
    before = host.points(dome).copy()
    assert bpy.ops.voxelastica.from_mesh() == {"FINISHED"}
    root = bpy.context.object
    settings = root.voxelastica
    assert settings.target.kind == "mesh" and settings.problem == "", settings.problem
    assert abs(json.loads(settings.meridian)[0][0] - 1000 * scale[0]) < 0.01 * 1000 * scale[0], settings.meridian_note
    assert np.array_equal(before, host.points(dome))
    found = off(root, scale[0], scale[2])
    ratio = scale[0] / scale[2]
    host.report(
        f"half a UV sphere scaled to a/b = {ratio:g}, rotated and moved: profile {found:.1e} % of the length off"
    )
    assert found < 0.5, found

# The object's own axis, and a mirrored one: still a dome that opens downwards.
for axis in ("z", "auto"):
    settings.target.axis = axis
    assert bpy.ops.voxelastica.use_mesh() == {"FINISHED"}
    assert settings.problem == ""

# A hub that grows is cut from the same meridian.
settings.thrust.hub = "held"
for hub in (2.0, 10.0, 25.0, 0.5):
    settings.strips.hub_radius_mm = hub
    assert settings.problem == "", settings.problem
    assert abs(host.design(root).profile.rho_mm[-1] - hub) < 1e-6

# The length rules the size, the panel shows the scale, and the mesh's own size is one click away.
settings.strips.hub_radius_mm = 5.0
preview, prepared = host.module("ui.preview"), host.module("ui.flower").prepared
before = preview.scale_of_mesh(settings, prepared(root))
settings.strips.length_mm = 200.0
assert preview.scale_of_mesh(settings, prepared(root)) > 1.5 * before
assert bpy.ops.voxelastica.keep_size() == {"FINISHED"}
scale = preview.scale_of_mesh(settings, prepared(root))
assert abs(scale - 1) < 0.01, scale

# Modifiers count: a cone of four sides under a subdivision surface has no faces but those of the modifier.
host.empty()
dome = host.dome((0.05, 0.05, 0.05), segments=24, rings=12)
for vertex in dome.data.vertices:
    vertex.co.z *= 0.5
bend = dome.modifiers.new("Taller", "SIMPLE_DEFORM")
bend.deform_method, bend.deform_axis, bend.factor = "STRETCH", "Z", 0.2
smooth = dome.modifiers.new("Subdivision", "SUBSURF")
smooth.levels = 2
assert bpy.ops.voxelastica.from_mesh() == {"FINISHED"}
root = bpy.context.object
# This one is infeasible standing freely: the message says what would help, and holding the hub shows it.
assert "held" in root.voxelastica.problem and not root.voxelastica.design
root.voxelastica.thrust.hub = "held"
assert root.voxelastica.problem == "" and len(root.data.vertices) == 8 * 201 * 17
with_modifiers = host.design(root).summary["height_mm"] / host.design(root).summary["rim_radius_mm"]
for modifier in list(dome.modifiers):
    modifier.show_viewport = False
bpy.context.view_layer.objects.active = dome
assert bpy.ops.voxelastica.use_mesh() == {"FINISHED"}
without = host.design(root).summary["height_mm"] / host.design(root).summary["rim_radius_mm"]
assert abs(with_modifiers / without - 1) > 0.03, (with_modifiers, without)

# A profile that only a modifier turns into a surface, about the object's own y axis, mirrored and rotated.
host.empty()
angles = np.linspace(0, np.pi / 2, 40)
profile = bpy.data.meshes.new("profile")
profile.from_pydata([(0.05 * np.cos(a), 0.03 * np.sin(a), 0.0) for a in angles], [(i, i + 1) for i in range(39)], [])
lathe = bpy.data.objects.new("lathe", profile)
bpy.context.collection.objects.link(lathe)
screw = lathe.modifiers.new("Screw", "SCREW")
screw.axis, screw.steps, screw.render_steps, screw.use_merge_vertices = "Y", 48, 48, True
lathe.scale, lathe.rotation_euler = (-1, 1, 1), (1.0, 0.3, -0.7)
bpy.context.view_layer.objects.active = lathe
bpy.context.view_layer.update()
assert bpy.ops.voxelastica.from_mesh() == {"FINISHED"}
root = bpy.context.object
for axis in ("y", "auto"):
    root.voxelastica.target.axis = axis
    assert root.voxelastica.problem == "", root.voxelastica.problem
    assert off(root, 5.0, 3.0) < 0.5, off(root, 5.0, 3.0)
root.voxelastica.target.axis = "x"
assert root.voxelastica.problem.startswith("lathe: "), root.voxelastica.problem
root.voxelastica.target.axis = "auto"
assert root.voxelastica.problem == ""

# A parent's uneven scale and a scene in centimetres.
host.empty()
scene = bpy.context.scene
scene.unit_settings.scale_length = 0.01
parent = bpy.data.objects.new("parent", None)
scene.collection.objects.link(parent)
parent.scale = (1, 1, 0.5)
dome = host.dome((6, 6, 6))
dome.parent = parent
bpy.context.view_layer.update()
assert bpy.ops.voxelastica.from_mesh() == {"FINISHED"}
root = bpy.context.object
assert abs(json.loads(root.voxelastica.meridian)[0][0] - 60) < 0.6
assert off(root, 2.0, 1.0) < 0.5
# The flat flower's 110 mm are 11 units of this scene.
assert abs(max(host.points(root)[:, 0]) - 11.0) < 1e-4

# The dome may go: the design keeps its meridian.
bpy.data.objects.remove(dome)
root.voxelastica.strips.count = 12
assert root.voxelastica.problem == "" and len(root.data.vertices) == 12 * 201 * 17
host.done()
