"""Designs."""

from __future__ import annotations

import ctypes as c
import json
import os
import tempfile
from array import array
from collections.abc import Iterable, Mapping
from enum import IntEnum
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from ._call import Handle, Progress, Watcher, address, call, encoded, make, text, view
from ._geometry import Flower, Mesh, MorphPath, Strip, strip_number
from ._library import LIBRARY, Array
from ._library import Voxels as _Voxels

try:
    import numpy
except ImportError:
    numpy = None  # type: ignore[assignment]

#: Kinds of outputs and their bits, in the order in which they are written.
OUTPUTS = {
    "graded_shell": 1,
    "graded_solid": 2,
    "voxel_solid": 4,
    "voxel_shell": 8,
    "tables": 16,
    "report": 32,
    "design": 64,
    "fabrication": 128,
}

#: Kinds of files to make a design and their bits, in the order in which they are written.
FABRICATION = {
    "stl": 1,
    "3mf": 2,
    "print_stack": 4,
    "gcvf": 8,
    "dxf": 16,
    "svg": 32,
    "assembly": 64,
    "gltf": 128,
}

_MODELS = {"voxel": 0, "graded": 1}
_FLOWS = {"heat": 0, "current": 1}
_SHAPES = {"flat": 0, "morphed": 1}
_REGIMES = {"steady": 0, "transient": 1, "both": 2}


class _Profile(IntEnum):
    S = 0
    INCLINATION = 1
    X = 2
    Z = 3
    RHO = 4
    WIDTH = 5
    MODULUS_RATIO = 6
    MODULUS = 7
    RIGID_FRACTION = 8


class Profile:
    """The profile of a spoke: one value a station, evenly spaced, rim first. Views into the design; nothing is copied."""

    def __init__(self, design: Handle) -> None:
        self._design = design

    def _column(self, column: _Profile) -> Any:
        lent = Array()
        call("design_profile", self._design.number, column, c.byref(lent))
        return view(lent, "d", self._design)

    @property
    def s_mm(self) -> Any:
        """Arc length from the rim, mm."""
        return self._column(_Profile.S)

    @property
    def inclination(self) -> Any:
        """Inclination, rad."""
        return self._column(_Profile.INCLINATION)

    @property
    def x_mm(self) -> Any:
        """Horizontal distance from the rim, mm."""
        return self._column(_Profile.X)

    @property
    def z_mm(self) -> Any:
        """Height above the rim, mm."""
        return self._column(_Profile.Z)

    @property
    def rho_mm(self) -> Any:
        """Distance from the dome's axis in the morphed state, mm."""
        return self._column(_Profile.RHO)

    @property
    def width_mm(self) -> Any:
        """Full width, mm."""
        return self._column(_Profile.WIDTH)

    @property
    def modulus_ratio(self) -> Any:
        """Modulus over its largest value."""
        return self._column(_Profile.MODULUS_RATIO)

    @property
    def modulus_mpa(self) -> Any:
        """Modulus, MPa."""
        return self._column(_Profile.MODULUS)

    @property
    def rigid_fraction(self) -> Any:
        """Fraction of the stiffest phase."""
        return self._column(_Profile.RIGID_FRACTION)


class Voxels:
    """The voxels of one flat spoke: slices from rim to hub, layers from the lower face up, voxels across the width.

    Slice ``i`` is ``2 * half_widths[i]`` voxels wide; its voxel ``(layer, across)`` stands at
    ``phases[offsets[i] + layer * 2 * half_widths[i] + across]``, ``across = 0`` at the most negative y.
    """

    def __init__(self, design: Handle) -> None:
        self._design = design
        lent = _Voxels()
        call("design_voxels", design.number, c.byref(lent))
        #: Voxel edge, mm.
        self.size_mm: float = lent.size_mm
        #: Number of slices.
        self.slices: int = lent.slices
        #: Number of layers.
        self.layers: int = lent.layers
        #: Phase of every voxel, from 0, softest first.
        self.phases = view(lent.phases, "B", design)
        #: Where every slice begins, and the total.
        self.offsets = view(lent.offsets, "N", design)
        #: Half-width of every slice in voxels.
        self.half_widths = view(lent.half_widths, "N", design)

    def count(self, phase: int) -> int:
        """Number of voxels of a phase in one spoke."""
        count = c.c_size_t()
        call("design_phase_voxels", self._design.number, _index(phase), c.byref(count))
        return count.value

    def centres(self, phase: int) -> Any:
        """Centres of a phase's voxels in the flat spoke, ``x, y, z`` a row in mm: x from the rim, z from the mid-plane."""
        values = 3 * self.count(phase)
        buffer: Any = numpy.empty(values) if numpy is not None else array("d", bytes(8 * values))
        place = address(buffer, "d", values, "centres") if values else (None, 0)
        call("design_phase_centres", self._design.number, phase, *place)
        if numpy is not None:
            return buffer.reshape(-1, 3)
        return memoryview(buffer).cast("B").cast("d", (values // 3, 3)) if values else memoryview(buffer)


def _index(value: int) -> int:
    if value < 0:
        raise IndexError(f"{value} is not an index")
    return value


class Design:
    """A computed design.

    >>> design = Design.from_file("examples/hemisphere.toml")
    >>> print(f"contrast {design.contrast:.3f}, {design.spokes} spokes")
    contrast 2.316, 8 spokes
    >>> widest = max(design.profile.width_mm)
    >>> half_way = design.mesh(fraction=0.5).positions

    Designs are immutable, and several threads may read one at once.
    """

    def __init__(self, source: Handle, *, allow_large: bool = False, progress: Progress | None = None) -> None:
        self._input = source
        with Watcher(progress) as callback:
            self._handle = make("design", "design_compute", source.number, allow_large, callback, None)

    @classmethod
    def from_toml(cls, toml: str, *, file: str = "", folder: str | os.PathLike[str] = "", **options: Any) -> Design:
        """Computes the design of a TOML text. ``file`` names it in errors; paths in it are relative to ``folder``.

        Further options of all ways to make a design: ``allow_large`` (more than 200 million voxels) and ``progress``, a
        function of ``done`` and ``total`` that may return ``False`` to cancel.
        """
        return cls(_parse("toml", toml, file, folder, options.get("progress")), **options)

    @classmethod
    def from_json(cls, text: str, *, file: str = "", folder: str | os.PathLike[str] = "", **options: Any) -> Design:
        """Computes the design of a JSON text with the TOML's keys, or of a whole ``design.json``."""
        return cls(_parse("json", text, file, folder, options.get("progress")), **options)

    @classmethod
    def from_dict(cls, keys: Mapping[str, Any], *, folder: str | os.PathLike[str] = "", **options: Any) -> Design:
        """Computes the design of a dictionary with the TOML's keys."""
        return cls.from_json(json.dumps(keys), folder=folder, **options)

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], **options: Any) -> Design:
        """Computes the design of a file: ``.json`` as JSON, anything else as TOML."""
        with Watcher(options.get("progress")) as callback:
            source = make("input", "input_read", *encoded(os.fspath(path)), callback, None)
        return cls(source, **options)

    @cached_property
    def input(self) -> dict[str, Any]:
        """The design's input with all defaults filled in."""
        return json.loads(text("input_json", self._input.number))

    @property
    def hash(self) -> str:
        """SHA-256 of the design, as in the header of every file it writes."""
        return text("input_hash", self._input.number)

    @property
    def name(self) -> str:
        """Name of the design."""
        return self.input["name"]

    @cached_property
    def summary(self) -> dict[str, Any]:
        """The figures that sum the design up, as in ``design.json``."""
        return json.loads(text("design_summary", self._handle.number))

    def figure(self, name: str) -> float:
        """One figure of the summary by its dotted name, such as ``thrust.total.beam.horizontal_n``; NaN where the design
        has none."""
        value = c.c_double()
        call("design_figure", self._handle.number, *encoded(name), c.byref(value))
        return value.value

    @property
    def contrast(self) -> float:
        """Largest over smallest designed modulus."""
        return self.summary["contrast"]

    @property
    def spokes(self) -> int:
        """Number of spokes; 1 for a rectangular strip."""
        return LIBRARY.voxelastica_design_spokes(self._handle.number)

    @property
    def phases(self) -> list[str]:
        """Names of the phases, softest first."""
        count = LIBRARY.voxelastica_design_phases(self._handle.number)
        return [text("design_phase_name", self._handle.number, i) for i in range(count)]

    @property
    def warnings(self) -> list[str]:
        """What the design's user should know."""
        count = LIBRARY.voxelastica_design_warnings(self._handle.number)
        return [LIBRARY.voxelastica_design_warning(self._handle.number, i).decode() for i in range(count)]

    @property
    def profile(self) -> Profile:
        """The profile of a spoke."""
        return Profile(self._handle)

    @property
    def outline(self) -> Any:
        """Outline of the flat spoke, ``x, y`` a row in mm: up one edge and back along the other."""
        lent = Array()
        call("design_outline", self._handle.number, c.byref(lent))
        return view(lent, "d", self._handle)

    @property
    def slices(self) -> dict[str, Any]:
        """The table of voxel slices, one value a slice, rim first."""
        names = ("s_mm", "modulus_target_mpa", "modulus_mpa", "stiffness_target_nmm2", "stiffness_nmm2")
        columns = {}
        for column, name in enumerate((*names, "neutral_offset_mm")):
            lent = Array()
            call("design_slices", self._handle.number, column, c.byref(lent))
            columns[name] = view(lent, "d", self._handle)
        return columns

    @property
    def voxels(self) -> Voxels:
        """The voxels of one spoke."""
        return Voxels(self._handle)

    def mesh(
        self, fraction: float = 0.0, *, spoke: int = 0, along: int = 100, across: int = 8, strip: Strip = "graded"
    ) -> Mesh:
        """The surface of one spoke at a fraction of the morph: 0 is flat, 1 closed. ``strip`` is ``"graded"`` for the
        smooth design or ``"voxel"`` for the predicted shape of the voxelised one."""
        numbers = (_index(spoke), _index(along), _index(across))
        return Mesh(make("mesh", "mesh_new", self._handle.number, strip_number(strip), fraction, *numbers))

    def flower(self, *, along: int = 200, across: int = 16, strip: Strip = "graded") -> Flower:
        """The surfaces of all spokes, prepared for animation."""
        numbers = (strip_number(strip), _index(along), _index(across))
        return Flower(make("flower", "flower_new", self._handle.number, *numbers))

    def hub(self, fraction: float = 0.0, *, strip: Strip = "graded") -> list[tuple[float, float, float]]:
        """Corners of the hub at a fraction of the morph, counter-clockwise; empty for a rectangular strip."""
        count = 0 if self.input["target"]["kind"] == "strip" else self.spokes
        corners = (c.c_double * (3 * count))()
        place = c.addressof(corners) if count else None
        call("design_hub", self._handle.number, strip_number(strip), fraction, place, 3 * count)
        return [(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]) for i in range(count)]

    def path(self, points: int = 41, *, strip: Strip = "graded", progress: Progress | None = None) -> MorphPath:
        """Forces, moments and the hub's place at evenly spaced fractions of the morph."""
        with Watcher(progress) as callback:
            arguments = (self._handle.number, strip_number(strip), _index(points), callback, None)
            return MorphPath(make("path", "path_new", *arguments))

    def write(
        self,
        folder: str | os.PathLike[str],
        kinds: Iterable[str] | None = None,
        *,
        allow_large: bool = False,
        progress: Progress | None = None,
    ) -> list[Path]:
        """Writes outputs into a folder and returns their paths. ``kinds`` are keys of :data:`OUTPUTS`; by default all.

        Either all files get their names or none. ``progress`` is told bytes and may return ``False`` to cancel.
        """
        bits = _bits(OUTPUTS if kinds is None else kinds, OUTPUTS, "outputs")
        place = encoded(os.fspath(folder))
        with Watcher(progress) as callback:
            files = text("design_write", self._handle.number, *place, bits, allow_large, callback, None)
        return [Path(folder) / file for file in json.loads(files)]

    def verify(
        self, model: Literal["voxel", "graded"] = "voxel", *, progress: Progress | None = None
    ) -> dict[str, Any]:
        """Solves one spoke with the finite elements inside the library: what ``verification.json`` holds, with the errors,
        the reactions, the strains and the mid-line. Nothing is read or written; ``progress`` is told thousandths."""
        number = _choice(model, _MODELS, "model")
        with Watcher(progress) as callback:
            return json.loads(text("design_verify", self._handle.number, number, callback, None))

    def verify_ccx(
        self,
        model: Literal["voxel", "graded"] = "graded",
        *,
        ccx: str | os.PathLike[str] = "ccx",
        progress: Progress | None = None,
    ) -> dict[str, Any]:
        """Solves one spoke with CalculiX, in a folder that is removed again: what ``verification.json`` holds. ``ccx`` is
        the program, a path or a name that is looked up. The design must have the model's deck (``decks.write``) for
        CalculiX (``decks.solvers``); ``progress`` is told the deck's bytes, then thousandths."""
        number = _choice(model, _MODELS, "model")
        with tempfile.TemporaryDirectory(prefix="voxelastica-") as folder, Watcher(progress) as callback:
            arguments = (number, *encoded(os.fspath(ccx)), *encoded(folder), callback, None)
            return json.loads(text("design_verify_ccx", self._handle.number, *arguments))

    def refine(self, iterations: int = 4, *, allow_large: bool = False, progress: Progress | None = None) -> Design:
        """The design corrected by what its voxels really do, at most ``iterations`` times: the best one found. Its
        ``summary["refinement"]`` has the error before and after."""
        with Watcher(progress) as callback:
            arguments = (self._handle.number, _index(iterations), allow_large, callback, None)
            refined = make("design", "design_refine", *arguments)
        design = object.__new__(type(self))
        design._handle = refined
        design._input = make("input", "design_input", refined.number)
        return design

    def conduct(
        self,
        flow: Literal["heat", "current"] = "heat",
        *,
        regime: Literal["steady", "transient", "both"] = "steady",
        model: Literal["voxel", "graded"] = "voxel",
        shape: Literal["flat", "morphed"] = "flat",
        progress: Progress | None = None,
    ) -> dict[str, Any]:
        """Heat or current through one spoke: a case of ``conduct.json``. Temperatures, currents, times and thresholds are
        those of the design's table ``conduction``; what rests on assumed material values says so."""
        case = (
            _choice(flow, _FLOWS, "flow"),
            _choice(model, _MODELS, "model"),
            _choice(shape, _SHAPES, "shape"),
            _choice(regime, _REGIMES, "regime"),
        )
        with Watcher(progress) as callback:
            return json.loads(text("design_conduct", self._handle.number, *case, callback, None))

    def fabricate(
        self,
        folder: str | os.PathLike[str],
        kinds: Iterable[str] = (),
        *,
        allow_large: bool = False,
        progress: Progress | None = None,
    ) -> list[Path]:
        """Writes files to make the design into the folder of the design and returns their paths. ``kinds`` are keys of
        :data:`FABRICATION`; none stands for those that the design asks for, or where it asks for none, all."""
        bits = _bits(kinds, FABRICATION, "files to make a design")
        place = encoded(os.fspath(folder))
        with Watcher(progress) as callback:
            files = text("design_fabricate", self._handle.number, *place, bits, allow_large, callback, None)
        return [Path(folder) / file for file in json.loads(files)]

    def to_json(self) -> str:
        """The whole result: what ``design.json`` holds, but for its list of files."""
        return text("design_json", self._handle.number)

    def __repr__(self) -> str:
        return f"<Design {self.name!r}: {self.spokes} x {self.input['strips']['length_mm']} mm>"


def _bits(kinds: Iterable[str], known: Mapping[str, int], what: str) -> int:
    chosen = list(kinds)
    unknown = [kind for kind in chosen if kind not in known]
    if unknown:
        raise ValueError(f"there are no {what} {unknown}; known are {list(known)}")
    bits = 0
    for kind in chosen:
        bits |= known[kind]
    return bits


def _choice(word: str, known: Mapping[str, int], name: str) -> int:
    try:
        return known[word]
    except KeyError:
        raise ValueError(f"{name} must be one of {list(known)}, not {word!r}") from None


def _parse(
    kind: str, source: str, file: str, folder: str | os.PathLike[str], progress: Progress | None = None
) -> Handle:
    texts = (*encoded(source), *encoded(file), *encoded(os.fspath(folder)))
    with Watcher(progress) as callback:
        return make("input", f"input_parse_{kind}", *texts, callback, None)


def complete(
    keys: Mapping[str, Any], *, folder: str | os.PathLike[str] = "", progress: Progress | None = None
) -> dict[str, Any]:
    """A dictionary with the TOML's keys, checked, with all defaults filled in and the meridian taken from the file it names,
    without computing the design: it may be infeasible. Paths are relative to ``folder``."""
    source = _parse("json", json.dumps(keys), "", folder, progress)
    return json.loads(text("input_json", source.number))
