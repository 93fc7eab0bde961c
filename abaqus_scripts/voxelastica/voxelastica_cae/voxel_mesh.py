"""One spoke as a mesh: the design's voxel deck imported with its sets, for sizes where partitioning is hopeless."""

from __future__ import division

import io

from . import VoxelasticaError
from .messages import say

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from abaqus.Mdb.Mdb import Mdb
    from abaqus.Model.Model import Model

    from .design import Design


def checked_deck(design):
    # type: (Design) -> str
    """Path of the design's voxel deck; raises VoxelasticaError where it is missing or of another design."""
    path = design.deck("voxel_solid")
    try:
        with io.open(path, encoding="utf-8") as file_:
            heading = file_.read(2000)
    except (IOError, OSError) as error:
        raise VoxelasticaError("%s cannot be read: %s" % (path, error.strerror or error))
    if design.sha256 not in heading:
        raise VoxelasticaError("%s belongs to another design; run voxelastica design again" % path)
    return path


def build(mdb, design, name):
    # type: (Mdb, Design, str) -> Model
    """Imports abaqus/voxel_solid.inp as a new model and checks its sets against the design; returns the model.

    Sections, constraints, step and outputs are the deck's. `name` must not be a model yet.
    """
    path = checked_deck(design)
    mdb.ModelFromInputFile(name=name, inputFileName=path)
    model = mdb.models[name]
    per_edge, _ = design.elements_per_edge()
    if not model.parts.keys():
        raise VoxelasticaError("CAE found no part in %s" % path)
    part = model.parts[list(model.parts.keys())[0]]
    for phase in design.present():
        set_name, wanted = "PHASE-" + phase["label"], design.counts[phase["label"]] * per_edge**3
        if set_name not in part.sets.keys():
            raise VoxelasticaError("CAE did not import the set %s of %s" % (set_name, path))
        count = len(part.sets[set_name].elements)
        if count != wanted:
            raise VoxelasticaError(
                "%s has %d elements, the design %d: %s belongs to another design; run voxelastica design again"
                % (set_name, count, wanted, path)
            )
    say("Voxelastica: imported %d elements" % len(part.elements))
    return model
