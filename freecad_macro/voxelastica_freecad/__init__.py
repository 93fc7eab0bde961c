# SPDX-License-Identifier: MIT OR Apache-2.0
"""Voxelastica's designs in FreeCAD: :mod:`core` builds them, :mod:`gui` asks what to build.

Mechanics and numbers come from the ``voxelastica`` package; this package only turns them into objects of a document.
"""

__version__ = "0.1.0"
