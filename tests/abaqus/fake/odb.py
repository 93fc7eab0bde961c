"""An output database of the stand-in, from plain data."""

from __future__ import division

from .geometry import shuffled
from .recorder import Thing


def database(world, path, data):
    """Makes what openOdb(path) gives.

    ``data``: ``sets`` {name: [[label, [x, y, z]], ...]}, ``displacements`` {label: [u1, u2, u3]}, ``history`` [{label,
    coordinates, outputs {name: [[time, value], ...]}}], ``time``, ``frames`` (0 for none), ``double``, ``press``: the history
    of a second step; a history without a label is the whole model's.
    """

    def thing(kind, where, **values):
        return Thing(world, world.class_key(kind), where, **values)

    def node(label, at):
        return thing("OdbMeshNode", "node %d" % label, label=label, coordinates=tuple(at))

    odb = thing("Odb", "odb")
    sets = odb.rootAssembly.nodeSets
    for name, members in data["sets"].items():
        # A set does not keep its order.
        nodes = [node(*members[i]) for i in shuffled(len(members))]
        sets._store(str(name), thing("OdbSet", "odb.nodeSets['%s']" % name, nodes=(tuple(nodes),)))
    if not data.get("steps", True):
        return odb
    moved = dict((int(label), tuple(u)) for label, u in data["displacements"].items())
    field = thing("FieldOutput", "odb.U")
    field._values["_moved"] = moved
    frame = thing("OdbFrame", "odb.frame", frameValue=data["time"])
    frame.fieldOutputs._store("U", field)
    for name, history in (("MORPH", data["history"]), ("PRESS", data.get("press"))):
        if history is not None:
            step = thing("OdbStep", "odb.steps['%s']" % name, frames=[frame] * data.get("frames", 1))
            odb.steps._store(name, step)
            _store_history(thing, node, step, history)
    return odb


def _store_history(thing, node, step, history):
    for i, of in enumerate(history):
        where = node(of["label"], of["coordinates"]) if "label" in of else None
        point = thing("HistoryPoint", "point %d" % i, node=where)
        region = thing("HistoryRegion", "region %d" % i, point=point)
        for name, pairs in of["outputs"].items():
            pairs = tuple(tuple(pair) for pair in pairs)
            region.historyOutputs._store(str(name), thing("HistoryOutput", name, data=pairs))
        step.historyRegions._store("Node ASSEMBLY.%d" % (i + 1), region)


def install(world):
    """Lets fields be asked for a set's values."""

    def subset(self, result, region):
        precision = world.constant("DOUBLE_PRECISION" if self._values.get("_double") else "SINGLE_PRECISION")
        values = []
        for node in [n for nodes in region.nodes for n in nodes]:
            if node.label in self._values["_moved"]:
                value = Thing(
                    world,
                    world.class_key("FieldValue"),
                    "value",
                    nodeLabel=node.label,
                    data=self._values["_moved"][node.label],
                    precision=precision,
                )
                values.append(value)
        result._values["values"] = values
        return result

    world.behaviours["FieldOutput", "getSubset"] = subset
