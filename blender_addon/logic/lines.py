# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines beside the spokes: the target as a wire, and the mid-line that a solver found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

_MERIDIAN_POINTS = 100
_RINGS = 8
_RING_POINTS = 96


def _turned(rho: np.ndarray, z: np.ndarray, azimuth: float) -> np.ndarray:
    return np.stack([rho * np.cos(azimuth), rho * np.sin(azimuth), z], axis=1)


def target(design: Any) -> tuple[np.ndarray, np.ndarray]:
    """Points, mm, and edges of the target: a meridian over the middle of every spoke, and rings."""
    profile = design.profile
    picked = np.linspace(0, len(profile.s_mm) - 1, _MERIDIAN_POINTS).astype(int)
    rho, z = np.asarray(profile.rho_mm)[picked], np.asarray(profile.z_mm)[picked]
    points, edges, start = [], [], 0
    for azimuth in np.arange(design.spokes) * (2 * np.pi / design.spokes):
        points.append(_turned(rho, z, azimuth))
        number = np.arange(start, start + len(rho) - 1)
        edges.append(np.stack([number, number + 1], axis=1))
        start += len(rho)
    around = np.arange(_RING_POINTS) * (2 * np.pi / _RING_POINTS)
    for i in np.linspace(0, len(rho) - 1, _RINGS).astype(int):
        points.append(np.stack([rho[i] * np.cos(around), rho[i] * np.sin(around), np.full(_RING_POINTS, z[i])], axis=1))
        number = np.arange(_RING_POINTS)
        edges.append(start + np.stack([number, (number + 1) % _RING_POINTS], axis=1))
        start += _RING_POINTS
    return np.concatenate(points), np.concatenate(edges).astype(np.int32)


def midlines(midline_mm: Sequence[Sequence[float]], rim_radius_mm: float, spokes: int) -> list[np.ndarray]:
    """A solver's mid-line ``[s, x, z]`` seen from the rim, over every spoke of the closed flower, mm."""
    line = np.asarray(midline_mm, dtype=float)
    rho, z = rim_radius_mm - line[:, 1], line[:, 2]
    return [_turned(rho, z, azimuth) for azimuth in np.arange(spokes) * (2 * np.pi / spokes)]


def tube(line: np.ndarray, radius: float, sides: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """Points and quads of a tube around a line that lies in an upright plane through the axis."""
    along = np.gradient(line, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    middle = line[len(line) // 2]
    aside = np.array([-middle[1], middle[0], 0.0]) / np.hypot(middle[0], middle[1])
    up = np.cross(along, aside)
    turns = np.arange(sides) * (2 * np.pi / sides)
    ring = np.cos(turns)[None, :, None] * aside + np.sin(turns)[None, :, None] * up[:, None, :]
    points = line[:, None, :] + radius * ring
    row, place = np.meshgrid(np.arange(len(line) - 1), np.arange(sides), indexing="ij")
    beside = (place + 1) % sides
    corners = (row * sides + place, row * sides + beside, (row + 1) * sides + beside, (row + 1) * sides + place)
    return points.reshape(-1, 3), np.stack(corners, axis=-1).reshape(-1, 4).astype(np.int32)
