"""A folder that cannot be written to, and a disk that is full: a message, and nothing is left or lost."""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import host

read_only, full = map(Path, sys.argv[1:])
host.install()
root = host.new()
settings = root.voxelastica
stored = settings.design
for folder, word in ((read_only, "cannot be written"), (full, "MB are free")):
    said = host.refused(bpy.ops.voxelastica.export, "Export failed", str(folder), folder=str(folder))
    assert word in said and " -o" not in said and "--" not in said, said
    assert settings.export_note.startswith("Export failed")
    assert list(folder.iterdir()) == [], list(folder.iterdir())
assert settings.design == stored and settings.problem == ""
# The design is still there to be exported elsewhere.
settings.decks.write = {"graded_solid"}
assert bpy.ops.voxelastica.export(folder=str(host.scratch())) == {"FINISHED"}
host.done()
