"""How fast the preview follows: figures for the report, nothing is asserted about time."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import bpy
import host

host.install()
root = host.new()
settings = root.voxelastica


def measured(what: str, change: Callable[[int], None], limit: int, times: int = 15) -> None:
    """Milliseconds from a slider to the mesh that is ready to be drawn; processor time tells on a busy machine."""
    found, busy = [], []
    for i in range(times):
        start, worked = time.perf_counter(), time.process_time()
        change(i)
        bpy.context.evaluated_depsgraph_get().update()
        found.append(1000 * (time.perf_counter() - start))
        busy.append(1000 * (time.process_time() - worked))
    assert settings.problem == "", settings.problem
    middle, worked = statistics.median(found), statistics.median(busy)
    host.report(
        f"{what}: {min(found):.1f} ms at best, {middle:.1f} in the middle, {worked:.1f} of the processor; wanted {limit}"
    )


assert len(root.data.polygons) == 8 * 200 * 16


def morph(i: int) -> None:
    """Drags the morph."""
    settings.morph = (i + 1) / 16


def aspect(i: int) -> None:
    """Drags the dome's shape."""
    settings.target.aspect_ratio = 0.8 + 0.02 * i


measured("morph, 8 spokes of 200 x 16 quads", morph, 33)
measured("aspect ratio, the same", aspect, 33)
settings.colour_by = "curvature"
measured("morph coloured by curvature", morph, 33)
settings.colour_by = "modulus"
settings.target.aspect_ratio = 1.0
settings.show_voxels = True
assert settings.voxels_note.startswith("67,000 of"), settings.voxels_note
measured("morph, 67 000 voxels shown", morph, 500)
measured("seed, 67 000 voxels shown", lambda i: setattr(settings.voxels, "seed", i + 2), 500, 8)
measured("aspect ratio, about 67 000 voxels shown", aspect, 500, 8)
host.done()
