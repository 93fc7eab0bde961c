"""What the menus call, in CAE's kernel: questions by CAE's own boxes, answers in the message area.

Nothing here lets an exception of wrong input through: it becomes a line in the message area.
"""

from __future__ import division

import os

from abaqus import getInputs, getWarningReply, mdb
from abaqusConstants import NO, YES

from . import VoxelasticaError, design as designs, estimate
from .build import KINDS, Options, build
from .messages import refuse

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any  # novm

_FIELDS = (
    ("Design (design.json):", ""),
    ("Kind (%s):" % ", ".join(KINDS), "auto"),
    ("Model (empty: the design's name):", ""),
    ("Cores:", "1"),
    ("Memory, percent:", "90"),
)


def ask_build():
    # type: () -> str
    """Asks for the design and what to build; returns the model's name, empty where nothing was built."""
    label = "Builds a model from a Voxelastica design"
    answers = getInputs(fields=_FIELDS, label=label, dialogTitle="Voxelastica")  # type: Any
    if answers is None or answers[0] is None:
        return ""
    path, kind, model, cores, memory = [(answer or "").strip() for answer in answers]
    return build_model(path, kind or "auto", model, cores or "1", memory or "90")


def build_model(design, kind="auto", model="", cores="1", memory="90"):
    # type: (str, str, str, int | str, int | str) -> str
    """Builds a model; where the partitioned strip would be very large, asks first. Returns its name or nothing."""
    try:
        options = Options(kind=kind, model=model, cores=_whole("cores", cores), memory=_whole("memory", memory))
        if kind == "geometry":
            options.kind = _confirmed(design)
        return build(design, options)
    except VoxelasticaError as error:
        refuse(error)
        return ""


def _confirmed(path):
    # type: (str) -> str
    """The kind that the user wants once told what is recommended."""
    kind, why = estimate.recommend(designs.read(path))
    if kind == "geometry":
        return kind
    reply = getWarningReply(
        message="Voxelastica recommends the mesh: %s. Import the mesh instead?" % why,
        buttons=(YES, NO),  # pyright: ignore[reportArgumentType]  the stub says str
    )  # type: Any
    return "mesh" if reply == YES else "geometry"


def _whole(name, text):
    # type: (str, int | str) -> int
    try:
        return int(text)
    except ValueError:
        raise VoxelasticaError("%s = %r is not a whole number" % (name, text))


def ask_extract():
    # type: () -> None
    """Asks for a database and extracts its results."""
    jobs = list(mdb.jobs.keys())
    fields = (
        ("Output database:", os.path.join(os.getcwd(), jobs[-1] + ".odb") if jobs else ""),
        ("Design (may be empty):", ""),
        ("Folder (empty: that of the database):", ""),
        ("Spoke:", "1"),
    )
    label = "Extracts the morphed mid-line and the reactions"
    answers = getInputs(fields=fields, label=label, dialogTitle="Voxelastica")  # type: Any
    if answers is None or answers[0] is None:
        return
    path, design, folder, spoke = [(answer or "").strip() for answer in answers]
    extract_results(path, design, folder, spoke or "1")


def extract_results(odb, design="", folder="", spoke="1"):
    # type: (str, str, str, int | str) -> None
    """Extracts the results of a database; wrong input becomes a message."""
    from .extract import extract

    try:
        extract(odb, design, folder, _whole("spoke", spoke))
    except VoxelasticaError as error:
        refuse(error)
