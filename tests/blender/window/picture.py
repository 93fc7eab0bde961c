"""Runs in a Blender with windows: works as a user does, takes pictures of the panel, checks that jobs leave Blender free.

usage: blender ANY.blend --python picture.py -- ZIP FOLDER work|panels
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

NAME = "bl_ext.user_default.voxelastica"
ARCHIVE, FOLDER, WHAT = sys.argv[sys.argv.index("--") + 1 :]
OPENED: list[tuple[type, type]] = []
FOUND: dict[str, Any] = {"blender": bpy.app.version_string}


def module(name: str) -> Any:
    """A module of the add-on."""
    return sys.modules[f"{NAME}.{name}"]


def view() -> tuple[Any, Any]:
    """The window and its largest 3D view."""
    window = bpy.context.window_manager.windows[0]
    areas = [area for area in window.screen.areas if area.type == "VIEW_3D"]
    return window, max(areas, key=lambda area: area.width * area.height)


def inside(work: Callable[[], Any]) -> Any:
    """Does something as if it was started from the 3D view."""
    window, area = view()
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        return work()


def picture(name: str) -> None:
    """The whole screen."""
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=2)
    subprocess.run(["import", "-window", "root", f"{FOLDER}/{name}.png"], check=True)
    subprocess.run(["convert", f"{FOLDER}/{name}.png", "-quality", "80", f"{FOLDER}/{name}.jpg"], check=True)


def sidebar() -> None:
    """Opens the add-on's tab; the sidebar must have been drawn before."""
    _, area = view()
    for region in area.regions:
        if region.type == "UI":
            region.active_panel_category = "Voxelastica"


def open_all() -> None:
    """Opens every sub-panel; a user clicks on them. Panels of another name have no closed state yet."""
    panels = [made for made in module("ui.panels").CLASSES if hasattr(made, "bl_parent_id")]
    for made in reversed(panels):
        bpy.utils.unregister_class(made)
    for made in panels:
        own = {"bl_options": set(), "bl_idname": f"{made.__name__}_open"}
        if made.bl_parent_id != "VOXELASTICA_PT_main":
            own["bl_parent_id"] = f"{made.bl_parent_id}_open"
        opened = type(f"{made.__name__}_open", (made,), own)
        bpy.utils.register_class(opened)
        OPENED.append((opened, made))


def close_all() -> None:
    """Puts the panels back as they were."""
    for opened, _ in reversed(OPENED):
        bpy.utils.unregister_class(opened)
    for _, made in OPENED:
        bpy.utils.register_class(made)


def frame() -> None:
    """The shown flower in the middle of the view, without its outline."""
    _, area = view()
    module("ui.making").frame(area.spaces.active.region_3d, bpy.data.objects["Hemisphere"])
    for chosen in bpy.context.selected_objects:
        chosen.select_set(False)


def steps() -> Iterator[float]:
    """What is done, and how long Blender goes on in between, s."""
    bpy.ops.extensions.package_install_files(filepath=ARCHIVE, repo="user_default", enable_on_install=True)
    window, area = view()
    # Everything but the view would only take room.
    for other in list(window.screen.areas):
        if other.type in ("OUTLINER", "PROPERTIES", "DOPESHEET_EDITOR"):
            with bpy.context.temp_override(window=window, area=other):
                bpy.ops.screen.area_close()
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)
    yield 1.0  # Closed areas are gone only after the window was drawn.
    view()[1].spaces.active.show_region_ui = True
    yield 1.5
    sidebar()
    if WHAT == "work":
        picture("empty")
    inside(lambda: bpy.ops.voxelastica.new(preset="hemisphere"))
    root = bpy.data.objects["Hemisphere"]
    root.voxelastica.morph = 0.5
    frame()
    yield 1.5
    sidebar()
    _, area = view()
    assert area.spaces.active.shading.color_type == "VERTEX"
    yield 1.0
    if WHAT == "work":
        picture("panel")
    if WHAT == "panels":
        open_all()
        for i, (kind, hub) in enumerate((("hemi-ellipsoid", "free"), ("inclination-polynomial", "held"))):
            root.voxelastica.target.kind = kind
            root.voxelastica.thrust.hub = hub
            root.voxelastica.show_voxels = True
            if i:
                bpy.ops.voxelastica.list(what="materials", add=True)
            yield 1.0
            sidebar()
            picture(f"all_{i + 1}")
        root.voxelastica.show_voxels = False
        root.voxelastica.strips.length_mm, root.voxelastica.strips.hub_radius_mm = 60.0, 6.0
        assert inside(lambda: bpy.ops.voxelastica.verify()) == {"FINISHED"}
        yield 1.0
        picture("running")
        while module("ui.jobs").running(root) is not None:
            yield 0.2
        root.voxelastica.folder = FOLDER
        root.voxelastica.decks.write = {"graded_solid"}
        assert inside(lambda: bpy.ops.voxelastica.export()) == {"FINISHED"}
        while module("ui.jobs").running(root) is not None:
            yield 0.2
        yield 1.0
        picture("results")
        close_all()
        FOUND["done"] = True
        return
    # A message in place of a preview.
    assert root.voxelastica.problem == ""
    root.voxelastica.strips.thickness_mm = 2.3
    yield 1.0
    picture("problem")
    root.voxelastica.strips.thickness_mm = 2.0
    # A job runs beside Blender: timers go on, the preview follows, the result arrives by itself.
    jobs = module("ui.jobs")
    root.voxelastica.strips.length_mm, root.voxelastica.strips.hub_radius_mm = 60.0, 6.0
    assert inside(lambda: bpy.ops.voxelastica.verify()) == {"FINISHED"}
    start, turns, taken = time.monotonic(), 0, False
    while jobs.running(root) is not None and time.monotonic() - start < 400:
        root.voxelastica.morph = (turns % 20) / 20
        turns += 1
        if not taken and time.monotonic() - start > 1.0:
            picture("verifying")
            taken = True
        yield 0.1
    FOUND["turns"], FOUND["seconds"] = turns, time.monotonic() - start
    assert root.voxelastica.verification, root.voxelastica.verify_note
    FOUND["error_percent"] = json.loads(root.voxelastica.verification)["max_error_percent"]
    root.voxelastica.morph = 0.6
    frame()
    yield 1.0
    picture("verified")
    # Undo in a window takes back a change, mesh and all, and the result of the job stays.
    inside(lambda: bpy.ops.ed.undo_push(message="before"))
    root.voxelastica.strips.count = 5
    inside(lambda: bpy.ops.ed.undo_push(message="after"))
    inside(lambda: bpy.ops.ed.undo())
    root = bpy.data.objects["Hemisphere"]
    assert root.voxelastica.strips.count == 8 and len(root.data.vertices) == 8 * 201 * 17
    assert root.voxelastica.verification
    # Voxels.
    root.voxelastica.show_voxels = True
    root.voxelastica.show_midline = False
    yield 1.5
    picture("voxels")
    # A modelled dome as the target.
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)
    inside(lambda: bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=0.08, location=(-0.2, 0, 0)))
    dome = inside(lambda: bpy.context.object)
    dome.scale.z = 0.6
    bpy.context.view_layer.update()
    inside(lambda: bpy.ops.voxelastica.from_mesh())
    made = bpy.data.objects[f"{dome.name} flower"]
    assert made.voxelastica.problem == "", made.voxelastica.problem
    made.voxelastica.morph = 0.8
    for chosen in bpy.context.selected_objects:
        chosen.select_set(False)
    yield 1.0
    picture("mesh")
    FOUND["done"] = True


def main() -> None:
    """Takes one step after the other by a timer, then ends Blender."""
    running = steps()

    def turn() -> float | None:
        try:
            return next(running)
        except StopIteration:
            pass
        except BaseException:  # noqa: BLE001 - the test reads it
            FOUND["error"] = traceback.format_exc()
        Path(FOLDER, f"found_{WHAT}.json").write_text(json.dumps(FOUND), encoding="utf-8")
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(turn, first_interval=2.0)


main()
