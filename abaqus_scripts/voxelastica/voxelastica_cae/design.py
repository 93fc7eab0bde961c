"""Reads a design.json: numbers as the builders need them, checked."""

from __future__ import division

import io
import json
import os

from . import SCHEMA, VoxelasticaError

try:
    _TEXT = (unicode,)  # noqa: F821  # pyright: ignore[reportUndefinedVariable]  Python 2
except NameError:
    _TEXT = ()

#: What a design must hold for a model to be built from it.
_NEEDED = ("design", "summary", "phases", "profile", "slices", "voxels", "graded_material", "morph_step")


def _plain(value):
    """The same value with native strings: Python 2's json gives unicode, which ABAQUS does not take everywhere."""
    if isinstance(value, dict):
        return dict((_plain(key), _plain(item)) for key, item in value.items())
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if isinstance(value, _TEXT):
        return value.encode("utf-8")
    return value


class Motion(object):
    """One prescribed motion: its amplitude's name, the value at the end (mm or rad) and the course over time."""

    def __init__(self, document):
        self.amplitude = document["amplitude"]
        self.value = float(document["value"])
        self.course = tuple((float(time), float(share)) for time, share in document["course"])

    @property
    def moves(self):
        """Whether anything moves; otherwise the degree of freedom is held."""
        return bool(self.course)


class Design(object):
    """A design as written by `voxelastica design`; lengths in mm, moduli in MPa, densities in tonne/mm^3.

    ``folder`` is where the file lies, which is also where its decks are.
    """

    def __init__(self, document, path):
        self.path = path
        self.folder = os.path.dirname(os.path.abspath(path))
        self.document = document
        given, strips = document["design"], document["design"]["strips"]
        self.name = given["name"]
        self.sha256 = document["provenance"]["design_sha256"]
        self.length = float(strips["length_mm"])
        self.thickness = float(strips["thickness_mm"])
        self.flower = given["target"]["kind"] != "strip"
        self.count = int(strips["count"]) if self.flower else 1
        self.hub_radius = float(strips["hub_radius_mm"]) if self.flower else 0.0
        self.decks = given["decks"]
        self.phases = document["phases"]
        self.rows = document["graded_material"]["rows"]
        self.profile = document["profile"]
        voxels = document["voxels"]
        self.edge = float(voxels["size_mm"])
        self.layers = int(voxels["layers"])
        self.half_widths = [int(n) for n in document["slices"]["half_width_voxels"]]
        self.slices = len(self.half_widths)
        self.counts = dict(document["summary"]["voxels"])
        self.voxels = int(document["summary"]["voxels_per_spoke"])
        self._digits = voxels["phases"]
        step = document["morph_step"]
        self.increments = step["increments"]
        self.description = step["description"]
        self.initial_bow = float(step["initial_bow_mm"])
        self.rim_travel = Motion(step["rim_travel"])
        self.rim_rotation = Motion(step["rim_rotation"])
        self.hub_rotation = Motion(step["hub_rotation"])
        self.hub_height = Motion(step["hub_height"]) if step["hub_height"] else None

    @property
    def motions(self):
        """The motions that need an amplitude."""
        every = (self.rim_travel, self.rim_rotation, self.hub_rotation, self.hub_height)
        return [motion for motion in every if motion is not None and motion.moves]

    @property
    def expression(self):
        """Modulus in MPa over X, mm from the rim along the spoke's own axis."""
        field = self.document.get("modulus_field")
        if not field:
            raise VoxelasticaError("%s has no modulus_field: a flower of shells needs one" % self.path)
        return field["expression"]

    def phase_of(self, slice_, layer, across):
        """Phase of a voxel, from 0, softest first; `across` counts from the most negative y."""
        width = 2 * self.half_widths[slice_]
        return int(self._digits[slice_][layer * width + across])

    @property
    def listed(self):
        """Whether the design lists the phase of every voxel; very large ones do not."""
        return self._digits is not None

    def present(self):
        """The phases of which there are voxels, softest first."""
        return [phase for phase in self.phases if self.counts.get(phase["label"], 0) > 0]

    def elements_per_edge(self):
        """Elements along a voxel's edge, and whether doubled so that there are nodes on the mid-plane."""
        wanted = int(self.decks["elements_per_voxel_edge"])
        doubled = (self.layers * wanted) % 2 == 1
        return (2 * wanted if doubled else wanted), doubled

    def deck(self, kind):
        """Path of one of the design's ABAQUS decks, which must exist."""
        path = os.path.join(self.folder, "abaqus", kind + ".inp")
        if not os.path.isfile(path):
            raise VoxelasticaError(
                "%s does not exist: run voxelastica design again with %s in decks.write and abaqus in decks.solvers"
                % (path, kind)
            )
        return path

    def _check(self):
        fits = len(self._digits or []) in (0, self.slices) and all(
            len(digits) == 2 * half * self.layers for digits, half in zip(self._digits or [], self.half_widths)
        )
        if not fits or self.slices < 2:
            raise VoxelasticaError("%s: its voxels do not fit its slices; run voxelastica design again" % self.path)


def read(path):
    """Reads a design.json.

    Raises VoxelasticaError where the file cannot be read, is cut off, is of another schema or lacks what is needed.
    """
    try:
        with io.open(path, encoding="utf-8") as file_:
            text = file_.read()
    except (IOError, OSError) as error:
        raise VoxelasticaError("%s cannot be read: %s" % (path, error.strerror or error))
    except ValueError:
        raise VoxelasticaError("%s is not a text file: choose the design.json of a design's folder" % path)
    try:
        document = _plain(json.loads(text))
    except ValueError as error:
        raise VoxelasticaError("%s is not whole: %s; run voxelastica design again" % (path, error))
    schema = document.get("schema") if isinstance(document, dict) else None
    if schema != SCHEMA:
        raise VoxelasticaError(
            "%s: schema = %r, this plug-in reads %r: use the plug-in of the version that wrote the file"
            % (path, schema, SCHEMA)
        )
    missing = [key for key in _NEEDED if key not in document]
    if missing:
        raise VoxelasticaError(
            "%s lacks %s: it was written by an older version; run voxelastica design again" % (path, ", ".join(missing))
        )
    try:
        design = Design(document, path)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise VoxelasticaError(
            "%s is damaged (%s: %s); run voxelastica design again" % (path, type(error).__name__, error)
        )
    design._check()
    return design
