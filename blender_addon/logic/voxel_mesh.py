# SPDX-License-Identifier: GPL-3.0-or-later
"""The voxels of a spoke as one mesh of the faces that can be seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

#: Of every face of a cube: where its neighbour is and its corners, (slice, layer, across), counter-clockwise from outside.
#: Slices go towards the hub, against the spoke's own x axis.
_FACES = (
    ((-1, 0, 0), ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0))),
    ((1, 0, 0), ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1))),
    ((0, -1, 0), ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1))),
    ((0, 1, 0), ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0))),
    ((0, 0, -1), ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0))),
    ((0, 0, 1), ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))),
)


@dataclass(frozen=True)
class Exposed:
    """Faces of one spoke's voxels that no shown neighbour covers."""

    #: Lattice points: slice edge from the rim, layer edge from the lower face, place across from the mid-line; (n, 3).
    points: np.ndarray
    #: Four points a face; (m, 4).
    quads: np.ndarray
    #: Phase of every face.
    phases: np.ndarray
    #: Voxel edge, mm.
    size_mm: float
    #: Slices and layers of the whole spoke.
    slices: int
    layers: int
    #: Voxels shown.
    count: int


def slices_within(offsets: Any, limit: int) -> int:
    """How many whole slices, from the rim on, hold at most ``limit`` voxels."""
    return int(np.searchsorted(np.asarray(offsets), limit, side="right")) - 1


def exposed(voxels: Any, slices: int, phase: int = -1) -> Exposed:
    """The visible faces of the first slices of a spoke's voxels (``voxelastica.Voxels``), of one phase or (-1) of all."""
    half = np.asarray(voxels.half_widths)[:slices].astype(np.int64)
    offsets = np.asarray(voxels.offsets).astype(np.int64)
    phases = np.asarray(voxels.phases)
    layers, widest = voxels.layers, int(half.max(initial=1))
    grid = np.full((slices + 2, layers + 2, 2 * widest + 2), -1, dtype=np.int8)
    for i, h in enumerate(half):
        block = phases[offsets[i] : offsets[i + 1]].reshape(layers, 2 * h)
        grid[i + 1, 1:-1, 1 + widest - h : 1 + widest + h] = block
    shown = grid >= 0 if phase < 0 else grid == phase
    shape = (slices + 1, layers + 1, 2 * widest + 1)
    corners, kinds = [], []
    core = (slice(1, -1),) * 3
    for offset, around in _FACES:
        beside = tuple(slice(1 + d, n - 1 + d) for d, n in zip(offset, grid.shape, strict=True))
        at = np.nonzero(shown[core] & ~shown[beside])
        cells = np.stack(at, axis=1)
        four = cells[:, None, :] + np.array(around)[None]
        corners.append((four[..., 0] * shape[1] + four[..., 1]) * shape[2] + four[..., 2])
        kinds.append(grid[core][at])
    flat = np.concatenate(corners)
    used = np.zeros(shape[0] * shape[1] * shape[2], dtype=bool)
    used[flat.ravel()] = True
    numbers = np.cumsum(used) - 1
    points = np.stack(np.unravel_index(np.nonzero(used)[0], shape), axis=1).astype(np.float64)
    points[:, 2] -= widest
    return Exposed(
        points=points,
        quads=numbers[flat].astype(np.int32),
        phases=np.concatenate(kinds),
        size_mm=voxels.size_mm,
        slices=voxels.slices,
        layers=layers,
        count=int(np.count_nonzero(shown)),
    )


def placed(faces: Exposed, design: Any, fraction: float, spoke: int) -> np.ndarray:
    """Where the points of a spoke's voxels are at a fraction of the morph, mm; (n, 3).

    Cross-sections stay plane and normal to the mid-surface, which is the smooth design's equilibrium.
    """
    mesh = design.mesh(fraction, spoke=spoke, along=faces.slices, across=2)
    rows = np.asarray(mesh.positions).reshape(-1, 3, 3)
    normals = np.asarray(mesh.normals).reshape(-1, 3, 3)[:, 1]
    across = rows[:, 2] - rows[:, 0]
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    row = faces.points[:, 0].astype(np.int64)
    up = (faces.points[:, 1] - 0.5 * faces.layers) * faces.size_mm
    aside = faces.points[:, 2] * faces.size_mm
    return rows[row, 1] + aside[:, None] * across[row] + up[:, None] * normals[row]
