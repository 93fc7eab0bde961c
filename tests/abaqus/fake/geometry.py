"""How the stand-in's parts behave: solids cut into boxes, planar shells, and the questions asked of them.

Only what the scripts need, and exact in it: what lies inside a bounding box, how many cells a mask picks. Indices are
shuffled, so that no script can rely on their order.
"""

from __future__ import division

import bisect
import math

from .recorder import Repository, Sequence, Thing

CLASSES = {
    "cells": "CellArray",
    "faces": "FaceArray",
    "edges": "EdgeArray",
    "nodes": "MeshNodeArray",
    "elements": "MeshElementArray",
}


class Entity(object):
    """A cell, face, edge, node or element: its index and the corners of its bounding box."""

    __slots__ = ("index", "low", "high", "kind", "number")

    def __init__(self, kind, low, high, index=0):
        self.kind, self.low, self.high, self.index = kind, low, high, index
        self.number = None

    def _plain(self):
        return "%s %d" % (self.kind, self.index)

    def inside(self, box):
        low, high = box
        return all(a >= b for a, b in zip(self.low, low)) and all(a <= b for a, b in zip(self.high, high))


def shuffled(count):
    """A fixed permutation of 0 to count - 1."""
    step = 7919
    while count > 1 and _gcd(step, count) > 1:
        step += 2
    return [(3 + i * step) % count for i in range(count)]


def _gcd(a, b):
    while b:
        a, b = b, a % b
    return a


class Solid(object):
    """A stepped outline extruded and cut by planes."""

    def __init__(self, lines, depth):
        self.depth, self.cuts = depth, [set(), set(), set()]
        steps = [(min(a[0], b[0]), max(a[0], b[0]), a[1]) for a, b in lines if a[1] == b[1] and a[1] > 0]
        if any(a[0] != b[0] and a[1] != b[1] for a, b in lines):
            raise ValueError("the outline has a slanted line")
        lower = [(min(a[0], b[0]), max(a[0], b[0]), -a[1]) for a, b in lines if a[1] == b[1] and a[1] < 0]
        ends = sorted(lines)
        starts, stops = sorted(a for a, _ in ends), sorted(b for _, b in ends)
        if starts != stops or sorted(steps) != sorted(lower):
            raise ValueError("the outline is not closed or not symmetric")
        self.steps, self.seed, self.meshed = sorted(steps), None, False
        self._cells = None

    def cut(self, axis, at):
        self.cuts[axis].add(at)
        self._cells = None

    def half_width(self, low, high):
        found = [y for a, b, y in self.steps if a - 1e-9 <= low and high <= b + 1e-9]
        if len(found) != 1:
            raise ValueError("between x = %g and %g the solid is no box" % (low, high))
        return found[0]

    def _build(self):
        if self._cells is not None:
            return
        x = sorted(set([self.steps[0][0], self.steps[-1][1]]) | self.cuts[0])
        z = sorted(set([0.0, self.depth]) | self.cuts[2])
        widest = max(step[2] for step in self.steps)
        y = sorted(set([-widest, widest]) | self.cuts[1])
        self.axes, self._cells = [x, y, z], {}
        halves = [self.half_width(a, b) for a, b in zip(x, x[1:])]
        keys = []
        for i, half in enumerate(halves):
            for j in range(len(y) - 1):
                if y[j] >= -half - 1e-9 and y[j + 1] <= half + 1e-9:
                    keys += [(i, j, k) for k in range(len(z) - 1)]
                elif min(y[j + 1], half) - max(y[j], -half) > 1e-9:
                    raise ValueError("a column at y = %g is not cut at the outline" % half)
        for key, index in zip(keys, shuffled(len(keys))):
            low = tuple(self.axes[a][key[a]] for a in range(3))
            high = tuple(self.axes[a][key[a] + 1] for a in range(3))
            self._cells[key] = Entity("cell", low, high, index)
        self.by_index = dict((cell.index, cell) for cell in self._cells.values())

    def all(self, kind):
        if kind == "cells":
            self._build()
            return sorted(self._cells.values(), key=lambda cell: cell.index)
        raise ValueError("the fake does not list all %s of a solid" % kind)

    def inside(self, kind, box):
        self._build()
        spans, points = [], []
        for a in range(3):
            axis, low, high = self.axes[a], box[0][a], box[1][a]
            first, last = bisect.bisect_left(axis, low), bisect.bisect_right(axis, high)
            points.append(range(first, last))
            spans.append(range(first, max(first, last - 1)))
        if kind == "cells":
            found = [self._cells.get((i, j, k)) for i in spans[0] for j in spans[1] for k in spans[2]]
            return sorted((cell for cell in found if cell), key=lambda cell: cell.index)
        if kind == "faces":
            return self._lower(spans, points, 2, kind)
        if kind == "edges":
            return self._lower(spans, points, 1, kind)
        return self._nodes(box)

    def _lower(self, spans, points, free, kind):
        """Faces (two free axes) or edges (one) inside the ranges that bound a cell."""
        found = []
        for mask in ((0, 1), (0, 2), (1, 2)) if free == 2 else ((0,), (1,), (2,)):
            ranges = [spans[a] if a in mask else points[a] for a in range(3)]
            for i in ranges[0]:
                for j in ranges[1]:
                    for k in ranges[2]:
                        at = (i, j, k)
                        beside = [()]
                        for a in range(3):
                            here = (at[a],) if a in mask else (at[a] - 1, at[a])
                            beside = [key + (c,) for key in beside for c in here]
                        if any(key in self._cells for key in beside):
                            low = tuple(self.axes[a][at[a]] for a in range(3))
                            high = tuple(self.axes[a][at[a] + (1 if a in mask else 0)] for a in range(3))
                            found.append(Entity(kind[:-1], low, high, len(found)))
        return found

    def _nodes(self, box):
        if not self.meshed:
            return []
        ticks = []
        for a in range(3):
            axis, found = self.axes[a], []
            for low, high in zip(axis, axis[1:]):
                parts = max(1, int(math.floor((high - low) / self.seed + 0.5)))
                found += [low + (high - low) * p / parts for p in range(parts)]
            ticks.append([v for v in found + [axis[-1]] if box[0][a] <= v <= box[1][a]])
        return [
            Entity("node", p, p, n)
            for n, p in enumerate((x, y, z) for x in ticks[0] for y in ticks[1] for z in ticks[2])
        ]

    def count(self):
        """Number of elements; one cell stands for all."""
        self._build()
        each = 0
        for cell in list(self._cells.values())[:1]:
            each = 1
            for a in range(3):
                each *= max(1, int(math.floor((cell.high[a] - cell.low[a]) / self.seed + 0.5)))
        return each * len(self._cells) if self.meshed else 0


class Shell(object):
    """A planar shell of an outline, perhaps cut along y = 0."""

    def __init__(self, curves):
        self.curves = [Entity("edge", *_bounds(points)) for points in curves]
        for curve, points in zip(self.curves, curves):
            curve.number = None
        self.points, self.halved, self.meshed = curves, False, False
        self.seed = None
        self._index()

    def _index(self):
        for curve, index in zip(self.curves, shuffled(len(self.curves))):
            curve.index = index
        count = 2 if self.halved else 1
        low, high = _bounds([p for c in self.points for p in c])
        self.faces = [Entity("face", low, high, i) for i in range(count)]

    def halve(self):
        """Cuts what crosses y = 0 and adds the cut."""
        found, ends = [], []
        for curve, points in zip(self.curves, self.points):
            if curve.low[1] < -1e-9 and curve.high[1] > 1e-9:
                if len(points) != 2:
                    raise ValueError("a spline crosses the mid-line")
                x = points[0][0]
                ends.append(x)
                found += [Entity("edge", *_bounds([(x, 0.0), point])) for point in points]
            else:
                found.append(curve)
        low, high = min(ends), max(ends)
        found.append(Entity("edge", (low, 0.0, 0.0), (high, 0.0, 0.0)))
        self.curves, self.halved = found, True
        self._index()

    def all(self, kind):
        if kind == "elements":
            return self._elements()
        return sorted({"edges": self.curves, "faces": self.faces}.get(kind, []), key=lambda e: e.index)

    def count(self):
        return len(self._elements())

    def inside(self, kind, box):
        return [entity for entity in self.all(kind) if entity.inside(box)]

    def _elements(self):
        """Rows of elements from the seeds, evenly spaced along x; none before the mesh."""
        if not self.meshed:
            return []
        if getattr(self, "ignored", False):
            return [Entity("element", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))]
        along = [e.number for e in self.curves if e.high[0] - e.low[0] > 1e-9]
        across = [e.number for e in self.curves if e.high[0] - e.low[0] <= 1e-9]
        if (
            not self.halved
            or len(set(along)) != 1
            or len(across) != 4
            or len(set(across)) != 1
            or None in along + across
        ):
            return [Entity("element", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))]
        low, high = _bounds([p for c in self.points for p in c])
        rows, columns = along[0], 2 * across[0]
        found = []
        for i in range(rows):
            x = [low[0] + (high[0] - low[0]) * (i + d) / rows for d in (0, 1)]
            found += [Entity("element", (x[0], 0.0, 0.0), (x[1], 0.0, 0.0), len(found) + j) for j in range(columns)]
        return found


def _bounds(points):
    x, y = [p[0] for p in points], [p[1] for p in points]
    return (min(x), min(y), 0.0), (max(x), max(y), 0.0)


def _array(owner, kind, geometry, offset=(0.0, 0.0, 0.0), turned=None):
    world = owner._world

    def source():
        return geometry().all(kind)

    array = Sequence(world, CLASSES[kind], "%s.%s" % (owner._path, kind), source, whole=True)
    if kind == "elements":
        array.__dict__["_count"] = lambda: geometry().count()
    array.__dict__.update(_geometry=geometry, _offset=offset, _kind=kind, _turned=turned)
    return array


def install(world):
    """Gives the world its behaviours."""
    does = world.behaviours

    def on(class_name, method):
        def put(function):
            does[class_name, method] = function
            return function

        return put

    # Sketches and parts

    @on("ConstrainedSketch", "Line")
    def line(self, result, point1, point2):
        self._values.setdefault("_curves", []).append([tuple(point1), tuple(point2)])
        return result

    @on("ConstrainedSketch", "Spline")
    def spline(self, result, points, **_):
        self._values.setdefault("_curves", []).append([tuple(p) for p in points])
        return result

    def feature(self, result, name):
        count = self._values["_count"] = self._values.get("_count", 0) + 1
        result._values["id"] = count
        self.features._store(result._values.get("name") or "%s-%d" % (name, count), result)
        return result

    @on("PartFeature", "BaseSolidExtrude")
    def extrude(self, result, sketch, depth):
        self._values["_geometry"] = Solid([(a, b) for a, b in sketch._values["_curves"]], depth)
        return feature(self, result, "Solid extrude")

    @on("PartFeature", "BaseShell")
    def shell(self, result, sketch):
        self._values["_geometry"] = Shell(sketch._values["_curves"])
        return feature(self, result, "Shell planar")

    @on("Feature", "DatumPlaneByPrincipalPlane")
    def datum_plane(self, result, principalPlane, offset):
        feature(self, result, "Datum plane")
        datum = Thing(world, world.class_key("DatumPlane"), "%s.datums[%d]" % (self._path, result.id))
        datum._values["_plane"] = ({"YZPLANE": 0, "XZPLANE": 1, "XYPLANE": 2}[principalPlane.name], offset)
        self.datums._store(result.id, datum)
        return result

    @on("Feature", "DatumCsysByThreePoints")
    def datum_csys(self, result, **values):
        feature(self, result, "Datum csys")
        datum = Thing(world, world.class_key("DatumCsys"), "%s.datums[%d]" % (self._path, result.id))
        datum._values["_axes"] = values
        self.datums._store(result.id, datum)
        return result

    @on("Feature", "DatumCsysByDefault")
    def datum_default(self, result, **_):
        return feature(self, result, "Datum csys")

    @on("Feature", "PartitionCellByDatumPlane")
    def partition_cells(self, result, cells, datumPlane):
        if not cells._whole:
            raise ValueError("the fake cuts all cells only")
        self._values["_geometry"].cut(*datumPlane._values["_plane"])
        return feature(self, result, "Partition cell")

    @on("Feature", "PartitionFaceByDatumPlane")
    def partition_faces(self, result, faces, datumPlane):
        if datumPlane._values["_plane"] != (1, 0.0):
            raise ValueError("the fake cuts shells along y = 0 only")
        self._values["_geometry"].halve()
        return feature(self, result, "Partition face")

    for kind in CLASSES:
        does["PartBase", "." + kind] = lambda self, kind=kind: _array(self, kind, lambda: self._values["_geometry"])
        does["PartInstance", "." + kind] = lambda self, kind=kind: _array(
            self,
            kind,
            lambda: self._values["part"]._values["_geometry"],
            self._values.get("_offset", (0.0, 0.0, 0.0)),
            self._values.get("_turned"),
        )

    # Questions

    def ask(self, result, **box):
        if self._turned:
            raise ValueError("the fake answers before an instance is turned only")
        offset = self._offset
        low = [box[a + "Min"] - o for a, o in zip("xyz", offset)]
        high = [box[a + "Max"] - o for a, o in zip("xyz", offset)]
        found = self._geometry().inside(self._kind, (low, high))
        return Sequence(world, self._class_name, self._path, found)

    def pick(self, result, mask):
        words, at = {}, 0
        text = "".join(mask)
        if not (text.startswith("[#") and text.endswith(" ]")):
            raise ValueError("%r is no mask" % text[:40])
        for word in text[1:-2].split(" "):
            value, _, count = word[1:].partition(":")
            if word[:1] != "#" or int(value, 16) >= 1 << 32:
                raise ValueError("%r is no word of a mask" % word)
            for _ in range(int(count or 1)):
                words[at] = int(value, 16)
                at += 1
        by_index = dict((item.index, item) for item in self._geometry().all(self._kind))
        found = [by_index[32 * at + bit] for at, word in words.items() for bit in range(32) if word >> bit & 1]
        return Sequence(world, self._class_name, self._path, sorted(found, key=lambda item: item.index))

    for name in set(CLASSES.values()):
        does[name, "getByBoundingBox"] = ask
        does[name, "getSequenceFromMask"] = pick

    # Seeds and meshes

    @on("MeshPart", "seedPart")
    def seed_part(self, result, size, **_):
        self._values["_geometry"].seed = size

    @on("MeshPart", "seedEdgeByNumber")
    def seed_edges(self, result, edges, number, **_):
        if not len(edges):
            raise ValueError("no edge to seed")
        for edge in edges:
            edge.number = number

    @on("MeshPart", "setMeshControls")
    def control(self, result, **_):
        return result

    @on("MeshPart", "deleteMesh")
    def delete(self, result, **_):
        self._values["_geometry"].meshed = False

    @on("MeshPart", "generateMesh")
    def generate(self, result, **_):
        self._values["_geometry"].meshed = True

    # Assembly

    @on("RegionPart", "Set")
    def part_set(self, result, **given):
        return named_set(self, result, given)

    @on("RegionAssembly", "Set")
    def assembly_set(self, result, **given):
        return named_set(self, result, given)

    def named_set(self, result, given):
        members = [value for key, value in given.items() if key != "name"]
        if len(members) != 1 or not len(members[0]):
            raise ValueError("the set %s is empty or mixed" % given["name"])
        return result

    @on("AssemblyBase", "Instance")
    def instance(self, result, name, part, **_):
        made = Thing(world, world.class_key("PartInstance"), "%s.instances['%s']" % (self._path, name), part=part)
        self.instances._store(name, made)
        self.features._store(name, made)
        self.features._gone = gone(self)
        return made

    def gone(self):
        def forget(key, value):
            self.instances._items = [pair for pair in self.instances._items if pair[0] != key]

        return forget

    @on("AssemblyBase", "translate")
    def translate(self, result, instanceList, vector):
        for name in instanceList:
            self.instances[name]._values["_offset"] = tuple(vector)

    @on("AssemblyBase", "rotate")
    def rotate(self, result, instanceList, axisPoint, axisDirection, angle):
        if tuple(axisPoint) != (0.0, 0.0, 0.0) or tuple(axisDirection) != (0.0, 0.0, 1.0):
            raise ValueError("the fake turns about the vertical axis only")
        for name in instanceList:
            self.instances[name]._values["_turned"] = angle

    @on("Feature", "ReferencePoint")
    def reference_point(self, result, point):
        feature(self, result, "RP")
        made = Thing(world, world.class_key("ReferencePoint"), "%s.referencePoints[%d]" % (self._path, result.id))
        made._values["_point"] = tuple(point)
        self.referencePoints._store(result.id, made)
        return result

    # Steps bring default requests with the first one

    @on("StepModel", "StaticStep")
    def static(self, result, name, previous, **_):
        if previous not in self.steps.keys():
            raise KeyError("there is no step %s" % previous)
        if len(self.steps.keys()) == 2:
            key = world.class_key("FieldOutputRequest")
            self.fieldOutputRequests._store("F-Output-1", Thing(world, key, "F-Output-1"))
            self.historyOutputRequests._store("H-Output-1", Thing(world, key, "H-Output-1"))
        return result

    @on("ModelBase", ".steps")
    def steps(self):
        made = Repository(world, self._path + ".steps")
        made._store("Initial", Thing(world, world.class_key("InitialStep"), made._path + "['Initial']"))
        self._values["steps"] = made
        return made

    @on("JobMdb", "Job")
    def job(self, result, name, model, **_):
        if model not in self.models.keys():
            raise KeyError("there is no model %s" % model)
        return result

    @on("Mdb", "ModelFromInputFile")
    def imported(self, result, name, inputFileName):
        from . import deck

        model = Thing(world, world.class_key("Model"), "mdb.models['%s']" % name)
        self.models._store(name, model)
        deck.load(world, model, inputFileName)
        return model
