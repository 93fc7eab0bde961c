"""Results of a morph: the mid-line in order and the reactions by increment, as CSV and JSON; force over depth of a press.

The mid-line is what `voxelastica compare` takes: s_mm,x_mm,z_mm from the rim, x toward the hub, z up, both from where the
rim is at the end. Reactions are in the spoke's axes: 1 inward, 2 across, 3 up, N and N mm.
"""

from __future__ import division

import io
import json
import math
import os

from odbAccess import openOdb

from . import VoxelasticaError, design as designs, indentation
from .messages import say

TYPE_CHECKING = False
if TYPE_CHECKING:  # type comments only: ABAQUS has no such modules
    from typing import Any  # novm

    from abaqus.Odb.Odb import Odb
    from abaqus.Odb.OdbFrame import OdbFrame
    from abaqus.Odb.OdbMeshNode import OdbMeshNode
    from abaqus.Odb.OdbStep import OdbStep

#: Name of the results' form.
SCHEMA = "voxelastica/cae-results/1"
_FORCES = ("RF1", "RF2", "RF3", "RM1", "RM2", "RM3")


def extract(path, design_path="", folder="", spoke=1):
    # type: (str, str, str, int) -> dict[str, str]
    """Reads an output database and writes the results beside it or into a folder; returns their paths by kind."""
    design = designs.read(design_path) if design_path else None
    if not os.path.isfile(path):
        raise VoxelasticaError("%s does not exist: run the job first" % path)
    try:
        odb = openOdb(path=path, readOnly=True)
    except Exception as error:
        raise VoxelasticaError("%s cannot be opened: %s" % (path, error))
    try:
        results = read(odb, spoke)
    finally:
        odb.close()
    results["schema"], results["odb"] = SCHEMA, os.path.basename(path)
    results["design_sha256"] = design.sha256 if design else None
    stem = os.path.splitext(os.path.basename(path))[0]
    target = os.path.join(folder or os.path.dirname(os.path.abspath(path)), stem)
    texts = {
        "midline": (target + "_midline.csv", table(("s_mm", "x_mm", "z_mm"), results["midline_mm"])),
        "reactions": (target + "_reactions.csv", table(*reaction_rows(results["reactions"]))),
        "results": (target + "_results.json", json.dumps(results, indent=1, sort_keys=True) + "\n"),
    }
    if "force_displacement" in results:
        rows = results["force_displacement"]["rows"]
        texts["force_displacement"] = (target + "_force_displacement.csv", table(indentation.HEADER, rows))
    for name in sorted(texts):
        _write(*texts[name])
    points, increments = len(results["midline_mm"]), len(results["reactions"][0]["time"])
    say("Voxelastica: %d points of the mid-line, %d increments; written %s_*" % (points, increments, target))
    return dict((name, texts[name][0]) for name in texts)


def read(odb, spoke):
    # type: (Odb, int) -> dict[str, Any]
    """Mid-line and reactions of the morph, or else of the last step, of an open database; the curve of a press."""
    if not odb.steps.keys():
        raise VoxelasticaError("the database has no step: the job stopped before its analysis began")
    pressed = indentation.is_pressed(odb)
    name = indentation.MORPH if pressed else list(odb.steps.keys())[-1]
    step = odb.steps[name]
    if not len(step.frames):
        raise VoxelasticaError("step %s has no frame yet: the job has not converged or still runs" % name)
    suffix = "" if "MIDLINE" in odb.rootAssembly.nodeSets.keys() else "-%d" % spoke
    nodes = _nodes(odb, "MIDLINE" + suffix)
    frame = step.frames[len(step.frames) - 1]
    line, inward = midline(nodes, _displacements(odb, frame, "MIDLINE" + suffix))
    # The rim's motion shows which axes a spoke's history is in; its hub end does not move sideways at all.
    rim = _reactions(odb, step, "RP-RIM" + suffix, inward)
    reactions = [rim, _reactions(odb, step, "RP-HUB" + suffix, inward, rim["axes_in_database"])]
    if suffix and "RP-HUB" in odb.rootAssembly.nodeSets.keys():
        reactions.append(_reactions(odb, step, "RP-HUB", (1.0, 0.0), "global"))
    found = {"midline_mm": line, "reactions": reactions, "step": name, "time": frame.frameValue, "spoke": spoke}
    if pressed:
        found["force_displacement"] = indentation.force_displacement(odb, lambda of, at: _history(odb, of, at))
    return found


def _nodes(odb, name):
    # type: (Odb, str) -> list[OdbMeshNode]
    """Nodes of a set of the assembly, of all instances."""
    sets = odb.rootAssembly.nodeSets
    if name not in sets.keys():
        raise VoxelasticaError(
            "the database has no node set %s but %s: was the job made from a Voxelastica model?"
            % (name, ", ".join(sorted(sets.keys())[:8]) or "none")
        )
    return [node for nodes in sets[name].nodes for node in nodes]  # pyright: ignore[reportGeneralTypeIssues]


def _displacements(odb, frame, name):
    # type: (Odb, OdbFrame, str) -> dict[Any, tuple[float, ...]]
    """Displacement of every node of a set, in the global axes: field output is always in them."""
    if "U" not in frame.fieldOutputs.keys():
        raise VoxelasticaError("the last frame holds no displacements: ask for U as field output")
    part = frame.fieldOutputs["U"].getSubset(region=odb.rootAssembly.nodeSets[name])
    return dict((value.nodeLabel, _data(value)) for value in part.values)  # pyright: ignore[reportOptionalIterable]


def _data(value):
    # type: (Any) -> tuple[float, ...]
    """A field value in the precision in which it was written."""
    double = str(value.precision) == "DOUBLE_PRECISION"
    return tuple(float(v) for v in (value.dataDouble if double else value.data))


def midline(nodes, moved):
    # type: (Any, dict[Any, tuple[float, ...]]) -> tuple[list[list[float]], tuple[float, float]]
    """[s, x, z] from rim to hub, mm, and the unit vector inward.

    Sets do not keep their order, so the nodes are put in order by where they were: a flower's rim is farthest from the
    axis; a strip's lies at x = 0.
    """
    if len(nodes) < 3:
        raise VoxelasticaError("the mid-line has %d nodes: at least 3 are needed" % len(nodes))
    lacking = [node.label for node in nodes if node.label not in moved]
    if lacking:
        raise VoxelasticaError("node %d of the mid-line has no displacement in the last frame" % lacking[0])
    at = sorted(((tuple(float(c) for c in node.coordinates), moved[node.label]) for node in nodes), key=_from_first)
    # Farthest apart along the line: its ends. A strip begins at the origin, a flower's spoke ends near it.
    first, last = at[0][0], at[-1][0]
    near, far = math.hypot(first[0], first[1]), math.hypot(last[0], last[1])
    strip = near < 1e-6 * far
    at.sort(key=lambda pair: math.hypot(pair[0][0], pair[0][1]), reverse=not strip)
    (rim, rim_moved), (hub, _) = at[0], at[-1]
    length = math.hypot(hub[0] - rim[0], hub[1] - rim[1])
    inward = ((hub[0] - rim[0]) / length, (hub[1] - rim[1]) / length)
    start = [rim[k] + rim_moved[k] for k in range(3)]
    line = []
    for point, move in at:
        now = [point[k] + move[k] - start[k] for k in range(3)]
        s = (point[0] - rim[0]) * inward[0] + (point[1] - rim[1]) * inward[1]
        line.append([s, now[0] * inward[0] + now[1] * inward[1], now[2]])
    return line, inward


def _from_first(pair):
    # type: (Any) -> float
    return math.hypot(pair[0][0], pair[0][1])


def _reactions(odb, step, name, inward, axes=""):
    # type: (Odb, OdbStep, str, tuple[float, float], str) -> dict[str, Any]
    """Reactions at a reference point by increment, in the axes of which 1 is `inward`.

    ``axes``: those of the history, "local" or "global"; empty: as the point's motion shows.
    """
    outputs = _history(odb, step, name)
    if not outputs:
        raise VoxelasticaError("the last step has no history of RF at %s" % name)
    lacking = [kind for kind in _FORCES if kind not in outputs.keys()]
    if lacking:
        raise VoxelasticaError("the history at %s lacks %s" % (name, ", ".join(lacking)))
    columns = dict((kind, [float(v) for _, v in _pairs(outputs, kind)]) for kind in _FORCES)  # type: dict[str, list[float]]
    times = [float(t) for t, _ in _pairs(outputs, "RF1")]
    moves = dict((k, [float(v) for _, v in _pairs(outputs, k)]) for k in ("U1", "U2") if k in outputs.keys())  # type: Any
    axes = axes or history_axes(moves, inward)
    if axes == "global":
        for one, two in (("RF1", "RF2"), ("RM1", "RM2")):
            turned = [
                (a * inward[0] + b * inward[1], b * inward[0] - a * inward[1])
                for a, b in zip(columns[one], columns[two])
            ]
            columns[one], columns[two] = [a for a, _ in turned], [b for _, b in turned]
    return {"node_set": name, "time": times, "axes_in_database": axes, "values": columns}


def _history(odb, step, name):
    # type: (Odb, OdbStep, str) -> Any
    """History outputs at a reference point; nothing where there are none."""
    node = _nodes(odb, name)[0]
    outputs = {}  # type: Any
    for key in step.historyRegions.keys():
        region = step.historyRegions[key]
        here = region.point.node
        if here is not None and here.label == node.label and "RF3" in region.historyOutputs.keys():
            # Nodes of the assembly and of instances are numbered on their own: the place tells them apart.
            if _apart(here.coordinates, node.coordinates) < 1e-6:
                outputs = region.historyOutputs
    return outputs


def history_axes(moves, inward):
    # type: (dict[str, list[float]], tuple[float, float]) -> str
    """Whether a history is in the "global" axes or in the spoke's, "local": the node's own motion, which is inward, tells.

    Where the point does not move the history is taken to be in the spoke's axes, as the models ask for.
    """
    if not moves.get("U1") or not moves.get("U2"):
        return "local"
    one, two = moves["U1"][-1], moves["U2"][-1]
    size = math.hypot(one, two)
    if size < 1e-9:
        return "local"
    if abs(one - size) < 1e-4 * size:
        return "local"
    sign = 1.0 if one * inward[0] + two * inward[1] > 0 else -1.0
    along = abs(one - sign * size * inward[0]) + abs(two - sign * size * inward[1])
    return "global" if along < 1e-3 * size else "local"


def _pairs(outputs, kind):
    # type: (Any, str) -> Any
    return outputs[kind].data


def _apart(a, b):
    # type: (Any, Any) -> float
    return math.sqrt(sum((float(p) - float(q)) ** 2 for p, q in zip(a, b)))


def reaction_rows(reactions):
    # type: (list[dict[str, Any]]) -> tuple[list[str], list[list[float]]]
    """Header and rows of the reactions' table: time, then six components of every reference point."""
    header = ["time"]
    for of in reactions:
        label = of["node_set"].lower().replace("-", "_")
        header += ["%s_%s_%s" % (label, k.lower(), "n" if k[1] == "F" else "nmm") for k in _FORCES]
    rows = []
    for i, time in enumerate(reactions[0]["time"]):
        row = [time]
        for of in reactions:
            row += [of["values"][kind][i] if i < len(of["values"][kind]) else float("nan") for kind in _FORCES]
        rows.append(row)
    return header, rows


def table(header, rows):
    # type: (Any, Any) -> str
    """A CSV text."""
    return "\n".join([",".join(header)] + [",".join("%.10g" % value for value in row) for row in rows]) + "\n"


def _write(path, text):
    # type: (str, str) -> None
    """Writes a text under its name only when it is whole."""
    part = path + ".part"
    try:
        with io.open(part, "wb") as file_:
            file_.write(text.encode("utf-8"))
        if os.path.exists(path):
            os.remove(path)  # Python 2 on Windows renames onto nothing that exists.
        os.rename(part, path)
    except (IOError, OSError) as error:
        if os.path.exists(part):
            os.remove(part)
        raise VoxelasticaError("%s cannot be written: %s" % (path, error.strerror or error))
