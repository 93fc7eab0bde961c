"""Voxelastica in ABAQUS/CAE: builds models from a design.json and reads their results.

One source for Python 2.7 (ABAQUS up to 2023) and Python 3.10 (from 2024 on); nothing beyond the standard library and
ABAQUS's own modules. All numbers come from the design; the mechanics is in the Voxelastica library that wrote it.
"""

SCHEMA = "voxelastica/design/1"


class VoxelasticaError(Exception):
    """What the user can put right; its text says what is wrong and what would help."""
