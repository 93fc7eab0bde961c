# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures on the spokes' surfaces: what colours show."""

from __future__ import annotations

from typing import Any

import numpy as np

from .colours import Scale, scale
from .designs import Prepared

#: What the surface may be coloured by: identifier, name, description.
CHOICES = (
    ("modulus", "Modulus", "Young's modulus that the design asks for, MPa"),
    ("phase", "Phase", "The phase that most voxels of a spot are of; show the voxels to see every one"),
    ("rigid_fraction", "Rigid Fraction", "Share of the stiffest phase in a cross-section"),
    ("curvature", "Curvature", "Curvature of the spokes' mid-line in the state that is shown, 1/mm"),
)


def _rows(prepared: Prepared, along: int, across: int, values: np.ndarray) -> np.ndarray:
    """One value a cross-section as one value a vertex of all spokes."""
    return np.tile(np.repeat(values, across + 1), prepared.design.spokes)


def _stations(prepared: Prepared, along: int, values: Any) -> np.ndarray:
    """Values at a profile's stations as values at the surface's cross-sections."""
    s = np.asarray(prepared.design.profile.s_mm)
    return np.interp(np.linspace(s[0], s[-1], along + 1), s, np.asarray(values))


def curvature(prepared: Prepared, along: int, fraction: float) -> np.ndarray:
    """Curvature of the mid-line at evenly spaced cross-sections, 1/mm; positive where the dome bulges.

    Measured on the shape itself: the inclination's change over two steps of arc length.
    """
    mesh = prepared.design.mesh(fraction, spoke=0, along=2 * along, across=2)
    line = np.asarray(mesh.positions).reshape(-1, 3, 3)[:, 1]
    steps = np.diff(line[:, [0, 2]], axis=0)
    inclination = np.unwrap(np.arctan2(steps[:, 1], -steps[:, 0]))
    length = np.linalg.norm(steps, axis=1)
    inner = -np.diff(inclination) / (0.5 * (length[1:] + length[:-1]))
    found = inner[1::2]
    return np.concatenate([[inner[0]], found, [inner[-1]]])


def prevailing(prepared: Prepared, along: int, across: int) -> np.ndarray:
    """The phase that most voxels beneath a face are of; one value a face of one spoke, rim first."""

    def make() -> np.ndarray:
        voxels = prepared.design.voxels
        half = np.asarray(voxels.half_widths).astype(np.int64)
        offsets = np.asarray(voxels.offsets).astype(np.int64)
        count = len(prepared.design.phases)
        slices = np.repeat(np.arange(voxels.slices), np.diff(offsets))
        width = 2 * half[slices]
        place = (np.arange(len(slices)) - offsets[:-1][slices]) % width
        aside = np.minimum(place * across // width, across - 1)
        phases = np.asarray(voxels.phases).astype(np.int64)
        # A surface finer than the voxels takes the voxel beneath it; a coarser one counts.
        if along <= voxels.slices:
            rows = np.minimum(slices * along // voxels.slices, along - 1)
            counts = np.bincount((rows * across + aside) * count + phases, minlength=along * across * count)
            return counts.reshape(-1, count).argmax(axis=1)
        counts = np.bincount((slices * across + aside) * count + phases, minlength=voxels.slices * across * count)
        by_slice = counts.reshape(voxels.slices, across, count).argmax(axis=2)
        return by_slice[np.arange(along) * voxels.slices // along].ravel()

    return prepared.once(("prevailing", along, across), make)


def figures(prepared: Prepared, by: str, along: int, across: int, fraction: float) -> tuple[np.ndarray, Scale, bool]:
    """What the surface shows: values, their scale, and whether there is one a face (rather than one a vertex)."""
    design = prepared.design
    if by == "phase":
        faces = np.tile(prevailing(prepared, along, across), design.spokes)
        return faces, Scale("phase", names=tuple(design.phases)), True
    if by == "rigid_fraction":
        values = _rows(prepared, along, across, _stations(prepared, along, design.profile.rigid_fraction))
        return values, Scale(f"share of {design.phases[-1]}"), False
    if by == "curvature":
        # The range is the closed state's, so that colours grow with the morph.
        closed = prepared.once(("curvature", along), lambda: curvature(prepared, along, 1.0))
        rows = closed if fraction == 1.0 else curvature(prepared, along, fraction)
        low, high = min(0.0, float(closed.min())), max(0.0, float(closed.max()))
        return _rows(prepared, along, across, rows), scale(low, high, "curvature, 1/mm"), False
    moduli = np.asarray(design.profile.modulus_mpa)
    low, high = float(moduli.min()), float(moduli.max())
    if high - low < 1e-6 * high:  # A uniform strip: no colours out of rounding.
        low = high
    return np.asarray(prepared.flower(along, across).modulus_mpa), Scale("modulus, MPa", low, high), False
