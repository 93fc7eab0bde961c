"""Voxelastica: flat, graded flowers that morph into domes.

>>> from voxelastica import Design
>>> design = Design.from_toml('''
... [target]
... kind = "hemi-ellipsoid"
... [strips]
... count = 8
... length_mm = 100.0
... hub_radius_mm = 10.0
... thickness_mm = 2.0
... [materials]
... phases = ["FLX9070", "FLX9095"]
... [voxels]
... size_mm = 0.5
... ''')
>>> print(f"{design.spokes} spokes, {design.profile.width_mm[0]:.2f} mm wide, {design.summary['height_mm']:.2f} mm high")
8 spokes, 61.02 mm wide, 63.66 mm high
>>> flower = design.flower(along=200, across=16)
>>> positions = flower.buffer()
>>> flower.fill(0.5, positions)          # all spokes, half-way
>>> files = design.write("out", ["voxel_solid"])  # doctest: +SKIP

Lengths are in mm, forces in N, moduli in MPa, angles in rad. Errors are :class:`VoxelasticaError` and read as on the
command line. Arrays are read-only views into the native library: numpy arrays where numpy is installed, else memoryviews;
they keep what they belong to alive.
"""

from ._call import Progress, VoxelasticaError
from ._design import FABRICATION, OUTPUTS, Design, Profile, Voxels, complete
from ._geometry import Flower, Mesh, MorphPath, Strip
from ._library import LIBRARY as _LIBRARY
from ._lists import materials, parameters, schema

__version__: str = _LIBRARY.voxelastica_version().decode()

__all__ = [
    "FABRICATION",
    "OUTPUTS",
    "Design",
    "Flower",
    "Mesh",
    "MorphPath",
    "Profile",
    "Progress",
    "Strip",
    "VoxelasticaError",
    "Voxels",
    "__version__",
    "complete",
    "materials",
    "parameters",
    "schema",
]
