"""Workbench draws a closed dome without holes, in the legend's colours."""

from __future__ import annotations

import bpy
import host
import numpy as np

host.install()
host.empty()
scene = bpy.context.scene
scene.unit_settings.scale_length = 0.001
root = host.new("hemisphere")
settings = root.voxelastica
settings.show_legend = settings.show_target = False
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", 240, 1000
camera.location = (0, 0, 500)
scene.camera = camera
scene.render.engine = "BLENDER_WORKBENCH"
scene.render.resolution_x = scene.render.resolution_y = 480
scene.render.film_transparent = True
scene.render.image_settings.file_format = "PNG"
scene.render.image_settings.color_mode = "RGBA"
scene.view_settings.view_transform = "Standard"
scene.display.shading.light = "FLAT"
scene.display.shading.color_type = "VERTEX"
scene.display.render_aa = "OFF"


def drawn(name: str) -> np.ndarray:
    """Pixels seen from above, (480, 480, 4), sRGB."""
    scene.render.filepath = str(host.scratch() / f"{name}.png")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(480 * 480 * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(480, 480, 4)


centre = (np.arange(480) - 239.5) * 0.5
x, y = np.meshgrid(centre, centre)
azimuth = (np.arctan2(y, x) + np.pi / 8) % (np.pi / 4) - np.pi / 8
across = np.hypot(x, y) * np.cos(azimuth)
settings.morph = 1.0
closed = drawn("closed")
inside = across < 73.6 - 1
assert closed[inside][:, 3].min() == 1.0, "the closed dome has holes"
assert closed[across > 73.7 + 1][:, 3].max() == 0.0, "the closed dome is larger than its rim"
settings.morph = 0.0
flat = drawn("flat")
assert 0.5 < flat[across < 109][:, 3].mean() < 0.9, "the flat flower shows gaps between its spokes"
# The colour of the stiffest place, the rim's, and of the hub.
table = host.module("logic.colours")
column = 458
profile = host.design(root).profile
moduli = np.asarray(profile.modulus_mpa)
there = np.interp(110 - centre[column], profile.s_mm, moduli)
top = table.Scale("", moduli.min(), moduli.max()).colours(np.array([there]))[0, :3]
srgb = np.where(top <= 0.0031308, 12.92 * top, 1.055 * top ** (1 / 2.4) - 0.055)
rim = flat[240, column][:3]
assert np.abs(rim - srgb).max() < 0.03, (rim, srgb)
assert np.abs(flat[240, 240][:3] - 0x8C / 255).max() < 0.03, flat[240, 240]
host.done()
