"""Builds a model from a design.json: the one entry for menus and scripts."""

from __future__ import division

from abaqus import mdb
from abaqusConstants import GIGA_BYTES, MEGA_BYTES, PERCENTAGE

from . import VoxelasticaError, design as designs, estimate, shell_flower, undo, voxel_mesh, voxel_strip
from .messages import say

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any  # novm

#: What can be built: the voxel strip partitioned or imported, the flower of shells; "auto" is the strip as recommended.
KINDS = ("auto", "geometry", "mesh", "shell")
_UNITS = {"percent": PERCENTAGE, "mb": MEGA_BYTES, "gb": GIGA_BYTES}


class Options(object):
    """What the user chose.

    ``kind``: one of KINDS. ``model``: the model's name; empty: the design's and the kind. ``job``: the job's name; empty:
    the model's. ``cores``; ``memory`` with ``memory_unit`` "percent", "mb" or "gb". ``mesh``: generate the mesh.
    ``find``: how cells are found, see cells.py. ``write_input``: write the job's input file.
    """

    def __init__(self, **values):
        self.kind, self.model, self.job = "auto", "", ""
        self.cores, self.memory, self.memory_unit = 1, 90, "percent"
        self.mesh, self.find, self.write_input = True, "auto", False
        for name, value in values.items():
            if not hasattr(self, name):
                raise TypeError("no option " + name)
            setattr(self, name, value)

    def check(self):
        """Raises VoxelasticaError where an option has no meaning."""
        if self.kind not in KINDS:
            raise VoxelasticaError("kind = %r is not one of %s" % (self.kind, ", ".join(KINDS)))
        if self.memory_unit not in _UNITS:
            raise VoxelasticaError("memory unit %r is not one of percent, mb, gb" % self.memory_unit)
        most = 100 if self.memory_unit == "percent" else None
        if self.memory < 1 or (most and self.memory > most):
            raise VoxelasticaError("memory = %d %s makes no sense" % (self.memory, self.memory_unit))
        if self.cores < 1:
            raise VoxelasticaError("cores = %d: at least one is needed" % self.cores)


def label(text):
    """A name that CAE takes for models and jobs: letters, digits, `-` and `_`, at most 38 characters."""
    safe = "".join(c if c.isalnum() and ord(c) < 128 or c in "-_" else "_" for c in text)
    return (safe if safe[:1].isalpha() else "V_" + safe)[:38]


def build(path, options):
    """Builds what the options ask for; returns the model's name.

    Raises VoxelasticaError with the database as it was before.
    """
    options.check()
    design = designs.read(path)
    kind, why = options.kind, ""
    if kind == "auto":
        kind, why = estimate.recommend(design)
        say("Voxelastica: %s, because %s" % (kind, why))
    name = options.model or label("%s-%s" % (design.name, kind))
    job = options.job or name
    _refuse_names(design, kind, name, job)
    known = list(mdb.models.keys())
    snapshot = undo.Snapshot(mdb.models[name]) if name in known else None
    try:
        if kind == "mesh":
            voxel_mesh.build(mdb, design, name)
        else:
            model = mdb.models[name] if name in known else mdb.Model(name=name)
            if kind == "geometry":
                voxel_strip.build(model, design, options.mesh, options.find)
            else:
                shell_flower.build(model, design, options.mesh)
        _job(design, name, job, options)
    except Exception:
        if job in mdb.jobs.keys():
            del mdb.jobs[job]
        if snapshot:
            snapshot.restore()
        elif name in mdb.models.keys():
            del mdb.models[name]
        raise
    say("Voxelastica: model %s and job %s are ready (%s)" % (name, job, kind))
    return name


def _refuse_names(design, kind, name, job):
    """Raises VoxelasticaError before anything is made where it would meet what exists, or cannot be made at all."""
    if kind != "mesh" and kind != "geometry" and not design.flower:
        raise VoxelasticaError("%s is a strip, not a dome: it has no flower of shells" % design.name)
    if kind == "geometry":
        voxel_strip.check(design)
    elif kind == "mesh":
        voxel_mesh.checked_deck(design)
    else:
        design.expression  # noqa: B018  raises where there is none
    if label(job) != job:
        raise VoxelasticaError("%r cannot name a job: use letters, digits, - and _" % job)
    if job in mdb.jobs.keys():
        raise VoxelasticaError("there is a job %s already: choose another name or delete it" % job)
    if name not in mdb.models.keys():
        return
    if kind == "mesh":
        raise VoxelasticaError("there is a model %s already: a mesh is imported as a model of its own" % name)
    wanted = (voxel_strip if kind == "geometry" else shell_flower).names(design)
    found = undo.existing(mdb.models[name], wanted)
    if found:
        raise VoxelasticaError(
            "the model %s has these already: %s; choose another model or rename them"
            % (name, ", ".join("%s %s" % pair for pair in found[:5]) + (" ..." if len(found) > 5 else ""))
        )


def _job(design, model, name, options):
    """The job with the user's cores and memory."""
    unit = _UNITS[options.memory_unit]  # type: Any
    job = mdb.Job(
        name=name,
        model=model,
        description="Voxelastica %s, design %s" % (design.name, design.sha256[:12]),
        numCpus=options.cores,
        numDomains=options.cores,
        memory=options.memory,
        memoryUnits=unit,
    )
    if options.write_input:
        try:
            job.writeInput()
        except Exception as error:
            raise VoxelasticaError("the input file of job %s was not written: %s" % (name, error))
