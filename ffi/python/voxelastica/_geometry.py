"""Surfaces of spokes and the path of the morph."""

from __future__ import annotations

import ctypes as c
from array import array
from typing import Any, Literal

from ._call import Handle, address, call, view
from ._library import LIBRARY, Array

try:
    import numpy
except ImportError:
    numpy = None  # type: ignore[assignment]

Strip = Literal["graded", "voxel"]


def strip_number(strip: Strip) -> int:
    """The number of a strip in the native interface."""
    if strip not in ("graded", "voxel"):
        raise ValueError(f'strip = "{strip}": it must be "graded" or "voxel"')
    return int(strip == "voxel")


class _Lender:
    def __init__(self, kind: str, handle: Handle) -> None:
        self._kind = kind
        self._handle = handle

    def _lent(self, name: str, letter: str) -> Any:
        lent = Array()
        call(f"{self._kind}_{name}", self._handle.number, c.byref(lent))
        return view(lent, letter, self._handle)


class Mesh(_Lender):
    """The surface of one spoke as quads, rim first, from one edge to the other."""

    def __init__(self, handle: Handle) -> None:
        super().__init__("mesh", handle)

    @property
    def positions(self) -> Any:
        """Vertices, ``x, y, z`` a row in mm."""
        return self._lent("positions", "d")

    @property
    def normals(self) -> Any:
        """Unit normals, one a vertex."""
        return self._lent("normals", "d")

    @property
    def modulus_mpa(self) -> Any:
        """Designed modulus, one a vertex."""
        return self._lent("modulus", "d")

    @property
    def quads(self) -> Any:
        """Four vertices a row, counter-clockwise seen from where the normals point."""
        return self._lent("quads", "I")


class Flower(_Lender):
    """The surfaces of all spokes, for animation: quads and modulus stay, vertices are filled in at any fraction.

    >>> flower = design.flower(along=200, across=16)
    >>> positions = flower.buffer()
    >>> for frame in range(100):
    ...     flower.fill(frame / 99, positions)
    """

    def __init__(self, handle: Handle) -> None:
        super().__init__("flower", handle)
        #: Number of vertices of all spokes.
        self.vertices: int = LIBRARY.voxelastica_flower_vertices(handle.number)

    @property
    def quads(self) -> Any:
        """Four vertices a row, counter-clockwise seen from where the normals point."""
        return self._lent("quads", "I")

    @property
    def modulus_mpa(self) -> Any:
        """Designed modulus, one a vertex."""
        return self._lent("modulus", "d")

    def buffer(self, typecode: Literal["f", "d"] = "f") -> Any:
        """A buffer for :meth:`fill`: a numpy array of shape ``(vertices, 3)`` where numpy is there, else an
        ``array.array``."""
        if numpy is not None:
            return numpy.zeros((self.vertices, 3), dtype=typecode)
        return array(typecode, bytes(3 * self.vertices * (4 if typecode == "f" else 8)))

    def fill(self, fraction: float, positions: Any, normals: Any = None) -> None:
        """Writes vertices (and normals) at a fraction of the morph into writable buffers of ``float`` or ``double``, of
        three values a vertex."""
        letter = "d" if memoryview(positions).itemsize == 8 else "f"
        length = 3 * self.vertices
        place = address(positions, letter, length, "positions")
        other = (None, 0) if normals is None else address(normals, letter, length, "normals")
        name = "flower_fill_f64" if letter == "d" else "flower_fill_f32"
        call(name, self._handle.number, fraction, *place, *other)


class MorphPath:
    """Forces and moments of one spoke in beam bending, and the hub's place, from flat to closed."""

    def __init__(self, handle: Handle) -> None:
        self._handle = handle

    def _column(self, column: int) -> Any:
        lent = Array()
        call("path_column", self._handle.number, column, c.byref(lent))
        return view(lent, "d", self._handle)

    @property
    def fraction(self) -> Any:
        """Fraction of the morph."""
        return self._column(0)

    @property
    def horizontal_n(self) -> Any:
        """Horizontal force, N; positive when the seat pushes the rim inward."""
        return self._column(1)

    @property
    def vertical_n(self) -> Any:
        """Vertical force, N; positive when the hub is pushed up."""
        return self._column(2)

    @property
    def rim_moment_nmm(self) -> Any:
        """Moment at the rim, N mm."""
        return self._column(3)

    @property
    def hub_moment_nmm(self) -> Any:
        """Moment at the hub, N mm."""
        return self._column(4)

    @property
    def span_mm(self) -> Any:
        """Horizontal distance of the hub from the rim, mm."""
        return self._column(5)

    @property
    def height_mm(self) -> Any:
        """Height of the hub above the rim, mm."""
        return self._column(6)
