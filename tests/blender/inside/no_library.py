"""On a platform without the library the panel says why, and designs in files are not lost."""

from __future__ import annotations

import os
import sys

import bpy
import host

stage, path = sys.argv[1], sys.argv[2]
if stage == "without":
    os.environ["VOXELASTICA_LIBRARY"] = "/nowhere/libvoxelastica.so"
host.install()


class Layout:
    """Records what a panel says; a stand-in for the layout that only a window has."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def box(self) -> Layout:
        return self

    def column(self, **_: object) -> Layout:
        return self

    def label(self, text: str = "", **_: object) -> None:
        self.said.append(text)


if stage == "with":
    root = host.new("trumpet")
    bpy.ops.wm.save_as_mainfile(filepath=path)
elif stage == "without":
    library = host.module("logic.library")
    assert "/nowhere/libvoxelastica.so" in library.problem() and "platform" in library.problem()
    assert not hasattr(bpy.types.Object, "voxelastica")
    panel = host.module("ui.panels").VOXELASTICA_PT_main
    assert panel.is_registered
    layout = Layout()
    panel.draw(type("Panel", (), {"layout": layout})(), bpy.context)
    assert "Voxelastica's library did not load here" in " ".join(layout.said), layout.said
    bpy.ops.wm.open_mainfile(filepath=path)
    bpy.data.objects["Trumpet"].location.x = 5.0
    bpy.ops.wm.save_mainfile()
    bpy.ops.preferences.addon_disable(module=host.NAME)
else:
    bpy.ops.wm.open_mainfile(filepath=path)
    root = bpy.data.objects["Trumpet"]
    assert root.location.x == 5.0 and root.voxelastica.part == "SPOKES"
    assert host.design(root).input["thrust"]["hub"] == "held"
    root.voxelastica.strips.count = 9
    assert root.voxelastica.problem == "" and len(root.data.vertices) == 9 * 201 * 17
host.done()
