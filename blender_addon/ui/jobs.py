# SPDX-License-Identifier: GPL-3.0-or-later
"""Background jobs of flowers: started here, watched by a timer, ended on Blender's own thread."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..logic.job import Job, Progress
from . import flower

#: Seconds between two looks at the jobs.
_INTERVAL = 0.1

#: Session number of a flower's object to its job and what is done at its end.
_jobs: dict[int, tuple[Job, Callable[[bpy.types.Object, Job], None]]] = {}


def start(
    root: bpy.types.Object,
    name: str,
    work: Callable[[Progress], Any],
    finish: Callable[[bpy.types.Object, Job], None],
) -> Job:
    """Starts work for a flower; ``finish(root, job)`` runs on Blender's thread once it ends. Without windows it is waited for."""
    job = Job(name, work)
    _jobs[root.session_uid] = (job, finish)
    if bpy.app.background:
        job.wait()
        look()
    elif not bpy.app.timers.is_registered(look):
        bpy.app.timers.register(look, first_interval=_INTERVAL)
    return job


def running(root: bpy.types.Object) -> Job | None:
    """The job of a flower, if it has one."""
    found = _jobs.get(root.session_uid)
    return found[0] if found else None


def look() -> float | None:
    """Ends the jobs that are done and has the panels drawn again; when to look again."""
    for number, (job, finish) in list(_jobs.items()):
        if not job.finished:
            continue
        del _jobs[number]
        root = next((candidate for candidate in bpy.data.objects if candidate.session_uid == number), None)
        if root is not None and flower.is_flower(root):
            finish(root, job)
            _push_undo(job.name)
    _redraw()
    return _INTERVAL if _jobs else None


def _push_undo(message: str) -> None:
    """A step in the history of what a job changed; a timer need not have a window, which the step wants."""
    for window in () if bpy.app.background else bpy.context.window_manager.windows:
        with bpy.context.temp_override(window=window):
            bpy.ops.ed.undo_push(message=message)
        return


def _redraw() -> None:
    for manager in bpy.data.window_managers:
        for window in manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    area.tag_redraw()


def end_all() -> None:
    """Cancels all jobs and waits for them."""
    for job, _ in _jobs.values():
        job.cancel()
    for job, _ in _jobs.values():
        job.wait(60.0)
    _jobs.clear()


@persistent
def _before_load(*_: Any) -> None:
    for job, _finish in _jobs.values():
        job.cancel()
    _jobs.clear()


def register() -> None:
    """Has jobs end when another file is opened."""
    bpy.app.handlers.load_pre.append(_before_load)


def unregister() -> None:
    """Ends all jobs."""
    end_all()
    if bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)
    if _before_load in bpy.app.handlers.load_pre:
        bpy.app.handlers.load_pre.remove(_before_load)
