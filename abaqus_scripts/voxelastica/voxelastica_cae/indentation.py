"""Force over depth of a pressed dome, from the history of the steps MORPH and PRESS.

Depth is how far RP-HUB went down since the morph; the force is what RF3 there has fallen by since. In a flower that is the
force of all spokes, the indenter's included; in a single strip, of one.
"""

from __future__ import division

from . import VoxelasticaError

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from typing import Any  # novm

    from abaqus.Odb.Odb import Odb
    from abaqus.Odb.OdbStep import OdbStep

#: Names of the steps.
MORPH, PRESS = "MORPH", "PRESS"
#: Columns of the table.
HEADER = ("depth_mm", "force_n", "force_per_spoke_n", "strain_energy_nmm")


def is_pressed(odb):
    # type: (Odb) -> bool
    """Whether the dome was pressed after the morph."""
    return MORPH in odb.steps.keys() and PRESS in odb.steps.keys()


def force_displacement(odb, find):
    # type: (Odb, Any) -> dict[str, Any]
    """Spokes of the model and rows of the table, the closed dome first.

    ``find(step, names)``: history outputs at RP-HUB, an empty dictionary where the step has none there.
    """
    names = odb.rootAssembly.nodeSets.keys()
    spokes = max(1, len([name for name in names if name.startswith("RP-HUB-") and name[7:].isdigit()]))
    before, after = (_history(odb.steps[name], name, find) for name in (MORPH, PRESS))
    if not before or not after:
        raise VoxelasticaError("the job has no history of %s yet: it has not converged or still runs" % PRESS)
    start = before[-1]
    rows = [[0.0, 0.0, 0.0, 0.0]]
    # The first value of a step may repeat the last one of the step before.
    for _, height, lift, energy in (row for row in after if row[0] > 0.0):
        force = start[2] - lift
        rows.append([start[1] - height, force, force / spokes, energy - start[3]])
    return {"spokes": spokes, "rows": rows}


def _history(step, name, find):
    # type: (OdbStep, str, Any) -> list[tuple[float, ...]]
    """Time, height, RF3 and strain energy of the whole model; no energy where none was asked for."""
    outputs = find(step, "RP-HUB")
    lacking = [kind for kind in ("U3", "RF3") if kind not in outputs.keys()]
    if lacking:
        raise VoxelasticaError("step %s has no history of %s at RP-HUB" % (name, " and ".join(lacking)))
    heights, forces = outputs["U3"].data, outputs["RF3"].data
    energies = dict((float(t), float(value)) for t, value in _energy(step))
    return [
        (float(t), float(height), float(force), energies.get(float(t), float("nan")))
        for (t, height), (_, force) in zip(heights, forces)
    ]


def _energy(step):
    # type: (OdbStep) -> Any
    for key in step.historyRegions.keys():
        outputs = step.historyRegions[key].historyOutputs
        if "ALLSE" in outputs.keys():
            return outputs["ALLSE"].data
    return ()
