"""The step that morphs: amplitudes, boundary conditions, output requests. The same values as in the decks."""

from __future__ import division

from abaqusConstants import OFF, ON, STEP, UNSET

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from typing import Iterable  # novm

    from abaqus.Datum.Datum import Datum
    from abaqus.Model.Model import Model
    from abaqus.Region.Set import Set

    from .design import Design, Motion

#: Name of the step, as in the decks.
STEP_NAME = "MORPH"

#: What names of output requests start with, and the one of fields.
REQUEST = "VOXELASTICA-"
FIELD_REQUEST = REQUEST + "FIELD"

#: Nodes up to which every fifth increment is kept as a field; beyond, only the last one.
_MANY_NODES = 25000


def step(model, design):
    # type: (Model, Design) -> None
    """The static step with large displacements and its amplitudes; returns nothing.

    Requests that CAE adds to a model's first step by itself are taken out: those of the morph follow.
    """
    for motion in design.motions:
        model.TabularAmplitude(name=motion.amplitude, data=motion.course, timeSpan=STEP)
    before = [list(model.fieldOutputRequests.keys()), list(model.historyOutputRequests.keys())]
    by = design.increments
    model.StaticStep(
        name=STEP_NAME,
        previous="Initial",
        description=design.description,
        timePeriod=1.0,
        nlgeom=ON,
        maxNumInc=int(by["number"]),
        initialInc=float(by["first"]),
        minInc=float(by["least"]),
        maxInc=float(by["most"]),
    )
    for repository, known in zip((model.fieldOutputRequests, model.historyOutputRequests), before):
        for name in list(repository.keys()):
            if name not in known:
                del repository[name]


def _drive(model, name, region, csys, motion, component):
    # type: (Model, str, Set, Datum | None, Motion, str) -> None
    """Moves one component along its amplitude."""
    values = {component: motion.value}
    model.DisplacementBC(
        name=name,
        createStepName=STEP_NAME,
        region=region,
        u1=values.get("u1", UNSET),
        u3=values.get("u3", UNSET),
        ur2=values.get("ur2", UNSET),
        amplitude=motion.amplitude,
        localCsys=csys,  # pyright: ignore[reportArgumentType]  the datum itself, as CAE records it
    )


def _hold(model, name, region, csys, components):
    # type: (Model, str, Set, Datum | None, list[str]) -> None
    """Holds components at zero."""
    values = dict((component, 0.0) for component in components)
    model.DisplacementBC(
        name=name,
        createStepName=STEP_NAME,
        region=region,
        u1=values.get("u1", UNSET),
        u2=values.get("u2", UNSET),
        u3=values.get("u3", UNSET),
        ur1=values.get("ur1", UNSET),
        ur2=values.get("ur2", UNSET),
        ur3=values.get("ur3", UNSET),
        localCsys=csys,  # pyright: ignore[reportArgumentType]  the datum itself, as CAE records it
    )


def rim(model, design, region, suffix="", csys=None):
    # type: (Model, Design, Set, str, Datum | None) -> None
    """Moves a rim's reference point: inward, and about the axis across; all else is held.

    ``csys`` is the spoke's system (1 inward, 2 across, 3 up), None where the model's is that already.
    """
    held = ["u2", "u3", "ur1", "ur3"]
    for motion, component in ((design.rim_travel, "u1"), (design.rim_rotation, "ur2")):
        if motion.moves:
            _drive(model, motion.amplitude + suffix, region, csys, motion, component)
        else:
            held.append(component)
    _hold(model, "RIM-HELD" + suffix, region, csys, sorted(held))


def hub(model, design, region, suffix="", csys=None, height=True):
    # type: (Model, Design, Set, str, Datum | None, bool) -> None
    """Turns a hub end's reference point and, where the hub is held and ``height`` is asked for, raises it."""
    held = ["u1", "u2", "ur1", "ur3"]
    if design.hub_rotation.moves:
        _drive(model, design.hub_rotation.amplitude + suffix, region, csys, design.hub_rotation, "ur2")
    else:
        held.append("ur2")
    if height and design.hub_height is not None:
        if design.hub_height.moves:
            _drive(model, design.hub_height.amplitude + suffix, region, csys, design.hub_height, "u3")
        else:
            held.append("u3")
    _hold(model, "HUB-HELD" + suffix, region, csys, sorted(held))


def middle(model, design, region):
    # type: (Model, Design, Set) -> None
    """Holds the rigid hub of a flower level; it rises freely, or to its height where it is held."""
    if design.hub_height is not None and design.hub_height.moves:
        _drive(model, design.hub_height.amplitude, region, None, design.hub_height, "u3")
        _hold(model, "HUB-HELD", region, None, ["u1", "u2", "ur1", "ur2", "ur3"])
    elif design.hub_height is not None:
        _hold(model, "HUB-HELD", region, None, ["u1", "u2", "u3", "ur1", "ur2", "ur3"])
    else:
        _hold(model, "HUB-HELD", region, None, ["u1", "u2", "ur1", "ur2", "ur3"])


def outputs(model, sets, nodes, midline, references, variables=("S", "LE")):
    # type: (Model, dict[str, Set], int, str, Iterable[str], tuple[str, ...]) -> None
    """Displacements and stresses of the whole model now and then; the mid-line and the reactions in every increment.

    Reactions are asked for in the axes of the reference points' own systems.
    """
    model.FieldOutputRequest(
        name=FIELD_REQUEST,
        createStepName=STEP_NAME,
        variables=("U", "COORD") + tuple(variables),
        frequency=2000 if nodes > _MANY_NODES else 5,
    )
    model.HistoryOutputRequest(
        name=REQUEST + midline,
        createStepName=STEP_NAME,
        region=sets[midline],
        variables=("U1", "U2", "U3", "COOR1", "COOR2", "COOR3"),
        frequency=1,
    )
    components = [kind + axis for kind in ("U", "UR", "RF", "RM") for axis in "123"]
    for name in references:
        model.HistoryOutputRequest(
            name=REQUEST + name,
            createStepName=STEP_NAME,
            region=sets[name],
            variables=tuple(components),
            frequency=1,
            useGlobal=OFF,
        )
