# SPDX-License-Identifier: GPL-3.0-or-later
"""The meridian of a mesh that was modelled in the host."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .library import api

#: Hub radii tried, as shares of the length: the meridian is wanted as far towards the axis as the mesh has one.
_SMALLEST = 1e-3
_TRIES = 7
#: Length and thickness of the strip that the meridian is taken with; they do not change it.
_LENGTH = 100.0


@dataclass(frozen=True)
class MeshMeridian:
    """What a mesh gives."""

    #: ``[rho, z]`` from the rim towards the axis, in the mesh's own size, mm.
    meridian: list[list[float]]
    #: Distance of its vertices from a surface of revolution, rms, percent of the rim radius.
    roundness_percent: float

    @property
    def rim_radius_mm(self) -> float:
        """Radius at the rim, mm."""
        return self.meridian[0][0]


def write_stl(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> None:
    """Writes triangles as binary STL; coordinates are taken about their centre, which keeps digits far from the origin."""
    corners = (vertices - vertices.mean(axis=0))[triangles]
    rows = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows["corners"] = corners
    with path.open("wb") as file:
        file.write(b"target of a voxelastica design".ljust(80))
        file.write(np.uint32(len(triangles)).tobytes())
        file.write(rows.tobytes())


def extract(vertices: np.ndarray, triangles: np.ndarray, axis: str, hub_share: float) -> MeshMeridian:
    """The outer meridian of a mesh, vertices in mm.

    :param axis: ``auto``, ``x``, ``y`` or ``z``
    :param hub_share: hub radius over length of the design, where the meridian must end at the latest
    :raises VoxelasticaError: a mesh without faces, or that is no surface of revolution, or that ends outside the hub
    :raises ValueError: a mesh without faces
    """
    if len(triangles) == 0:
        raise ValueError("it has no faces; a target needs a surface, such as the upper half of a UV sphere")
    with tempfile.TemporaryDirectory(prefix="voxelastica-") as folder:
        write_stl(Path(folder) / "target.stl", vertices, triangles)
        try:
            return _taken(folder, axis, _SMALLEST)
        except api().VoxelasticaError as error:
            if error.key != "strips.hub_radius_mm" or hub_share <= _SMALLEST:
                raise
        # The mesh is open at its top: go as near to the axis as it does.
        best, low, high = _taken(folder, axis, hub_share), _SMALLEST, hub_share
        for _ in range(_TRIES):
            middle = (low * high) ** 0.5
            try:
                best, high = _taken(folder, axis, middle), middle
            except api().VoxelasticaError:
                low = middle
        return best


def _taken(folder: str, axis: str, hub_share: float) -> MeshMeridian:
    known = api()
    keys = {
        "target": {"kind": "mesh", "file": "target.stl", "axis": axis},
        "strips": {"count": 8, "length_mm": _LENGTH, "hub_radius_mm": hub_share * _LENGTH, "thickness_mm": 1.0},
        "materials": {"phases": [material["name"] for material in known.materials()[:2]]},
        "voxels": {"size_mm": 1.0},
    }
    target = known.complete(keys, folder=folder)["target"]
    found = target["revolution"]
    meridian = [[rho / found["scale"], z / found["scale"]] for rho, z in target["meridian"]]
    return MeshMeridian(meridian, found["rms_percent"])
