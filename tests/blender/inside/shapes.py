"""What the preview shows is the design: equilibrium, parts, colours, voxels, animation."""

from __future__ import annotations

import json

import bpy
import host
import numpy as np

host.install()
scene = bpy.context.scene


def colours(target: bpy.types.Object) -> np.ndarray:
    """Colours of a mesh, linear RGBA."""
    layer = target.data.color_attributes["Voxelastica"]
    found = np.empty(4 * len(layer.data), dtype=np.float32)
    layer.data.foreach_get("color", found)
    return found.reshape(-1, 4)


for preset in ("hemisphere", "nose_cone", "roof", "trumpet"):
    host.empty()
    root = host.new(preset)
    settings, design = root.voxelastica, host.design(root)
    spokes, length = design.spokes, design.input["strips"]["length_mm"]
    # A unit is a metre: mm become thousandths; in a scene in mm they stay.
    for unit in (1.0, 0.001):
        scene.unit_settings.scale_length = unit
        assert bpy.ops.voxelastica.update() == {"FINISHED"}
        for fraction in (0.0, 0.3, 0.5, 1.0):
            settings.morph = fraction
            grid = host.points(root).reshape(spokes, 201, 17, 3) * 1000 * unit
            true = design.mesh(settings.morph, spoke=1, along=200, across=16).positions.reshape(201, 17, 3)
            assert np.abs(grid[1] - true).max() < 1e-4 * length
            # The hub belongs where the spokes end: its corners are theirs.
            hub = host.points(host.part(root, "HUB")) * 1000 * unit
            ends = grid[:, -1, [0, -1]].reshape(-1, 3)
            for corner in hub:
                assert np.linalg.norm(ends - corner, axis=1).min() < 1e-4 * length, (preset, fraction)
    # Closed: neighbours' edges are one line, nowhere open and nowhere crossing.
    settings.morph = 1.0
    grid = host.points(root).reshape(spokes, 201, 17, 3)

    def apart(points: np.ndarray) -> float:
        """Largest distance of a spoke's edge from its neighbour's."""
        return float(np.linalg.norm(points[:, :, -1] - np.roll(points[:, :, 0], -1, axis=0), axis=2).max())

    gap = apart(grid)
    host.report(f"{preset}: largest gap between closed neighbours {100 * gap / length:.1e} % of the length")
    assert gap < 1e-5 * length, gap
    # A blend of the end states is not the true path: the morph is no blend.
    settings.morph = 0.5
    half = host.points(root)
    settings.morph = 0.0
    flat = host.points(root)
    assert apart(flat.reshape(spokes, 201, 17, 3)) > 0.05 * length
    settings.morph = 1.0
    assert np.abs(0.5 * (flat + host.points(root)) - half).max() > 0.02 * length

    # Colours: the legend's ends are the surface's.
    for by in ("modulus", "rigid_fraction", "curvature", "phase"):
        settings.colour_by = by
        body = host.part(root, "LABELS").data.body.splitlines()
        found = colours(root)
        uniform = (preset, by) == ("hemisphere", "curvature")  # A circle's curvature is one figure.
        assert uniform or len(np.unique(found, axis=0)) > (1 if by == "phase" else 20), (preset, by)
        legend = colours(host.part(root, "LEGEND"))
        used = {tuple(row) for row in np.round(legend, 4)}
        if by == "modulus":
            moduli = np.asarray(design.profile.modulus_mpa)
            assert body[0] == "modulus, MPa" and float(body[1]) == np.float64(f"{moduli.max():.3g}"), body
            layer = colours(root).reshape(spokes, 201, 17, 4)[0, :, 8]
            stiffest = layer[np.argmax(np.interp(np.linspace(0, length, 201), design.profile.s_mm, moduli))]
            top = legend[np.argmax(host.points(host.part(root, "LEGEND"))[:, 1])]
            assert np.abs(stiffest - top).max() < 0.02, (stiffest, top)
        if by == "phase":
            assert body[1:] == list(reversed(design.phases))
            assert {tuple(row) for row in np.round(np.unique(found, axis=0), 4)} <= used
    settings.colour_by = "modulus"

# Voxels: counted, limited, in place, of one phase.
host.empty()
scene.unit_settings.scale_length = 0.001
root = host.new()
settings, design = root.voxelastica, host.design(root)
settings.show_voxels = True
assert settings.voxels_note == "67,000 of 536,000 voxels shown: 1 of 8 spokes", settings.voxels_note
voxels = host.part(root, "VOXELS")
points = host.points(voxels)
assert abs(points[:, 0].max() - 110) < 1e-4 and abs(points[:, 0].min() - 10) < 1e-4
assert abs(points[:, 2].max() - 1) < 1e-5 and abs(points[:, 2].min() + 1) < 1e-5
# Faces look outward: the volume inside is the voxels'.
mesh = voxels.data
mesh.calc_loop_triangles()
corners = np.array([tuple(t.vertices) for t in mesh.loop_triangles])
a, b, c = (points[corners[:, i]] for i in range(3))
volume = float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)
assert abs(volume / design.summary["volume_mm3"]["spoke_voxels"] - 1) < 1e-4, volume
settings.morph = 1.0
line = design.mesh(1.0, spoke=0, along=200, across=2).positions.reshape(201, 3, 3)[:, 1]
nearest = min(np.linalg.norm(host.points(voxels) - line[0], axis=1))
assert nearest < 2.0 and host.points(voxels)[:, 2].max() < design.summary["height_mm"] + 1.5
settings.voxel_phase = "2"
rigid = design.voxels.count(1)
assert settings.voxels_note.startswith(f"{rigid:,} of"), settings.voxels_note
settings.voxel_phase = "0"
settings.voxel_limit = 10_000
assert "the first 20 of 200 slices of spoke 1" in settings.voxels_note, settings.voxels_note
settings.voxel_limit = 200_000
assert "2 of 8 spokes" in settings.voxels_note
settings.show_voxels = False
assert host.part(root, "VOXELS") is None

# Animation: drivers blend true states; everywhere on the timeline within half a percent of the true path.
settings.show_voxels = True
settings.voxel_limit = 100_000
settings.morph = 0.0
assert bpy.ops.voxelastica.animate(first=1, last=41, percent=0.25) == {"FINISHED"}
assert settings.states >= 2 and "states" in settings.animation_note
for child in (root, host.part(root, "HUB"), host.part(root, "VOXELS")):
    assert len(child.data.shape_keys.key_blocks) == settings.states + 1
worst = 0.0
for frame in range(1, 42):
    scene.frame_set(frame)
    fraction = root.evaluated_get(bpy.context.evaluated_depsgraph_get()).voxelastica.morph
    flower = design.flower(along=200, across=16)
    true = flower.buffer()
    flower.fill(fraction, true)
    worst = max(worst, float(np.linalg.norm(host.points(root, evaluated=True) - true, axis=1).max()))
    hub = np.array(design.hub(fraction))
    assert np.abs(host.points(host.part(root, "HUB"), evaluated=True) - hub).max() < 0.25
assert fraction == 1.0
host.report(f"animated with {settings.states + 1} states: at most {worst:.3f} % of the length off the true path")
assert 0.01 < worst < 0.5, worst
# The slider drives the same keys, a changed design makes them anew.
settings.strips.count = 7
assert len(root.data.shape_keys.key_blocks) == settings.states + 1 and len(root.data.vertices) == 7 * 201 * 17
scene.frame_set(41)
shown = host.points(root, evaluated=True)
assert abs(shown[:, 2].max() - host.design(root).summary["height_mm"]) < 1e-3
host.refused(bpy.ops.voxelastica.animate, "not after", first=10, last=10)
assert bpy.ops.voxelastica.unanimate() == {"FINISHED"}
assert root.data.shape_keys is None and settings.states == 0
assert not host.module("ui.animation").is_keyed(root)
settings.morph = 1.0
assert abs(host.points(root)[:, 2].max() - host.design(root).summary["height_mm"]) < 1e-3

# glTF: flat and closed, with the library's own numbers.
settings.fabrication.write = {"gltf"}
settings.decks.write = set()
assert bpy.ops.voxelastica.export(folder=str(host.scratch())) == {"FINISHED"}, settings.export_note
folder = host.scratch() / settings.design_name / "fabrication"
assert (folder / "flat.glb").stat().st_size > 10_000 and (folder / "morphed.glb").stat().st_size > 10_000
assert json.loads((folder.parent / "design.json").read_text())["design"]["strips"]["count"] == 7
bpy.ops.import_scene.gltf(filepath=str(folder / "morphed.glb"))
assert any(o.type == "MESH" for o in bpy.context.selected_objects)
host.done()
