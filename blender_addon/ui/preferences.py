# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty

from .fields import relative_paths

PACKAGE = __package__.rpartition(".")[0]


class VOXELASTICA_AP_preferences(bpy.types.AddonPreferences):
    """What holds for all files."""

    bl_idname = PACKAGE

    ccx: StringProperty(
        name="CalculiX",
        description="The program ccx: a path, or a name that is looked up where programs are. Needed for Verify with CalculiX only",
        default="ccx",
        subtype="FILE_PATH",
    )
    folder: StringProperty(
        name="Default Folder",
        description="Where new flowers are exported to; // is the folder of the .blend file",
        default="//",
        subtype="DIR_PATH",
        options=relative_paths(),
    )
    voxel_limit: IntProperty(
        name="Voxel Limit",
        description="Voxels that new flowers show at most",
        default=100_000,
        min=1000,
        max=20_000_000,
    )
    show_colours: BoolProperty(
        name="Colours in Solid Views",
        description="A new flower switches the 3D view it is made in to show colours of attributes, and frames itself",
        default=True,
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("ccx", "folder", "voxel_limit", "show_colours"):
            layout.prop(self, name)


def preferences(context: bpy.types.Context) -> Any:
    """The add-on's preferences."""
    return context.preferences.addons[PACKAGE].preferences


def register() -> None:
    """Registers the preferences."""
    bpy.utils.register_class(VOXELASTICA_AP_preferences)


def unregister() -> None:
    """Takes them away."""
    bpy.utils.unregister_class(VOXELASTICA_AP_preferences)
