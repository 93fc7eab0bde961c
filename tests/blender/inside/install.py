"""The zip installs, and switching it off leaves nothing behind."""

from __future__ import annotations

import gc

import bpy
import host


def footprint() -> dict[str, object]:
    """What an add-on could leave behind."""
    gc.collect()
    classes = set()
    for base in (
        bpy.types.Panel,
        bpy.types.Operator,
        bpy.types.Menu,
        bpy.types.PropertyGroup,
        bpy.types.AddonPreferences,
    ):
        classes |= {
            f"{base.__name__} {made.__name__}"
            for made in base.__subclasses__()
            if getattr(made, "is_registered", False)
        }
    handlers = {
        name: len(found) for name in dir(bpy.app.handlers) if isinstance(found := getattr(bpy.app.handlers, name), list)
    }
    return {
        "classes": {name for name in classes if "voxelastica" in name.lower()},
        "handlers": handlers,
        "object": {name for name in bpy.types.Object.bl_rna.properties.keys() if "voxelastica" in name},
        "scene": {name for name in bpy.types.Scene.bl_rna.properties.keys() if "voxelastica" in name},
        "operators": dir(bpy.ops.voxelastica) if "voxelastica" in dir(bpy.ops) else [],
        "menus": [
            len(menu._dyn_ui_initialize()) for menu in (bpy.types.VIEW3D_MT_mesh_add, bpy.types.TOPBAR_MT_file_import)
        ],
    }


before = footprint()
host.install()
assert host.module("logic.library").problem() == ""
assert bpy.context.preferences.addons[host.NAME].preferences.ccx == "ccx"
during = footprint()
assert during != before and len(during["classes"]) > 20, during
for turn in range(3):
    root = host.new()
    assert len(root.data.vertices) == 8 * 201 * 17
    bpy.ops.preferences.addon_disable(module=host.NAME)
    assert host.NAME not in bpy.context.preferences.addons
    assert footprint() == before, (turn, footprint(), before)
    # What was made stays the user's.
    assert root.name in bpy.data.objects
    bpy.ops.preferences.addon_enable(module=host.NAME)
    assert bpy.data.objects[root.name].voxelastica.strips.count == 8

# Every operator and panel says what it is.
for name in dir(bpy.ops.voxelastica):
    kind = getattr(bpy.ops.voxelastica, name).get_rna_type()
    assert kind.name and kind.description, name
    assert kind.name != name, name
    for property in kind.properties:
        if property.identifier not in ("rna_type", "filter_glob") and not property.is_hidden:
            assert property.name, (name, property.identifier)
host.done()
