"""Designs a hemisphere and prints the widths of its spokes."""

import sys

from voxelastica import Design, VoxelasticaError

TOML = """
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 100.0
hub_radius_mm = 10.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 0.5
"""

try:
    profile = Design.from_toml(TOML, file="hemisphere").profile
except VoxelasticaError as error:
    sys.exit(f"error: {error}")
for s, width in list(zip(profile.s_mm, profile.width_mm))[::100]:
    print(f"s = {s:5.1f} mm  width = {width:6.3f} mm")
