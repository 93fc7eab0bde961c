# SPDX-License-Identifier: GPL-3.0-or-later
"""Voxelastica in Blender: flat flowers of graded stiffness that morph into domes.

`logic` is what needs no Blender, `ui` what does; the mechanics are in the library behind the package `voxelastica`.
"""

from __future__ import annotations


def _modules():
    from .ui import animating, changing, making, panels, preset_menu, results

    return making, changing, animating, results, preset_menu, panels


def register() -> None:
    """Called by Blender when the add-on is switched on. Where the library does not load, the panel says why."""
    import bpy

    from .logic import library
    from .ui import jobs, panels, preferences, preset_menu, properties

    preferences.register()
    if not library.load():
        bpy.utils.register_class(panels.VOXELASTICA_PT_main)
        return
    properties.register()
    for module in _modules():
        for made in module.CLASSES:
            bpy.utils.register_class(made)
    for menu, entry in preset_menu.MENUS:
        menu.append(entry)
    jobs.register()


def unregister() -> None:
    """Called by Blender when the add-on is switched off: ends what runs and takes everything away."""
    import bpy

    from .logic import designs
    from .ui import jobs, panels, preferences, preset_menu, properties

    if properties.known():
        jobs.unregister()
        for menu, entry in preset_menu.MENUS:
            menu.remove(entry)
        for module in reversed(_modules()):
            for made in reversed(module.CLASSES):
                bpy.utils.unregister_class(made)
        properties.unregister()
        designs.forget()
    else:
        bpy.utils.unregister_class(panels.VOXELASTICA_PT_main)
    preferences.unregister()
