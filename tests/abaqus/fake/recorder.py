"""A strict stand-in for the ABAQUS scripting interface that records every call.

Names, signatures and constants come from the table that stubs.py makes from abqpy's stubs: an unknown method, attribute,
keyword or constant, a wrong number of arguments, a constant that an argument does not take or a value of the wrong type
raises. Python 2.7 and 3.
"""

from __future__ import division, print_function

import io
import json

try:
    _STRING = (unicode,)
except NameError:
    _STRING = ()

#: Where the stubs are at fault: what ABAQUS's own reference says differs.
OPTIONAL = {("DatumCsysByThreePoints", "line1"), ("DatumCsysByThreePoints", "line2")}
UNTYPED = {
    ("ExpressionField", "localCsys"),
    ("DisplacementBC", "localCsys"),
    ("setSweepPath", "region"),
    ("Temperature", "magnitudes"),
    ("getWarningReply", "buttons"),
    ("ElemType", "elemCode"),
}
BASES = {"abaqus.Model.Model:Model": ["abaqus.Field.FieldModel:FieldModel"]}
#: Members that every repository has.
REPOSITORY = ("keys", "values", "items", "changeKey")


class Strict(AttributeError):
    """Something that the interface does not have."""


class Constant(object):
    """A symbolic constant; the same name is the same object."""

    def __init__(self, name):
        self.name = name

    def __repr__(self):
        return self.name


class World(object):
    """The table, the constants, the calls so far and how objects behave."""

    def __init__(self, path):
        with io.open(path, encoding="utf-8") as file_:
            self.table = json.load(file_)
        for key, bases in BASES.items():
            self.table["classes"][key]["bases"] += bases
        self.constants = dict((str(name), Constant(str(name))) for name in self.table["constants"])
        self.calls, self.behaviours, self.count = [], {}, {}
        self._members = {}

    def constant(self, name):
        return self.constants[name]

    def class_key(self, name):
        """Key of the class of this name; the shortest where there are several."""
        return min((k for k, c in self.table["classes"].items() if c["name"] == name), key=lambda k: (len(k), k))

    def lineage(self, key):
        """The class and its bases, nearest first."""
        found, waiting = [], [key]
        while waiting:
            here = waiting.pop(0)
            if here in found or here not in self.table["classes"]:
                continue
            found.append(here)
            waiting += self.table["classes"][here]["bases"]
        return found

    def member(self, key, name):
        """("method", signatures) or ("attribute", type) of a class, or None."""
        if (key, name) not in self._members:
            self._members[key, name] = self._member(key, name)
        return self._members[key, name]

    def _member(self, key, name):
        for here in self.lineage(key):
            of = self.table["classes"][here]
            if name in of["methods"]:
                return "method", of["methods"][name]
            if name in of["attributes"]:
                return "attribute", of["attributes"][name]
        return None

    def record(self, path, arguments):
        self.calls.append([path, dict((name, self.plain(value)) for name, value in arguments.items())])
        name = path.rsplit(".", 1)[-1]
        self.count[name] = self.count.get(name, 0) + 1

    def plain(self, value):
        """A value as JSON, the same in every version of Python."""
        if hasattr(value, "_plain"):
            return value._plain()
        if isinstance(value, Constant):
            return value.name
        if isinstance(value, (list, tuple)):
            return [self.plain(item) for item in value]
        if isinstance(value, float):
            return repr(value)
        if callable(value):
            return "function " + value.__name__
        return value

    # Signatures

    def bind(self, where, name, signatures, args, kwargs):
        """Arguments by name after the first signature that fits; raises TypeError where none does."""
        problems = []
        for signature in signatures:
            try:
                return self._bind(where, name, signature, args, kwargs)
            except TypeError as error:
                problems.append(str(error))
        raise TypeError("; or ".join(sorted(set(problems))))

    def _bind(self, where, name, signature, args, kwargs):
        params = [p for p in signature["params"] if not p["keyword_only"]]
        if len(args) > len(params) and not signature["more"]:
            raise TypeError("%s.%s takes %d arguments, not %d" % (where, name, len(params), len(args)))
        bound = dict((p["name"], value) for p, value in zip(params, args))
        if len(args) > len(params):
            bound["*"] = tuple(args[len(params) :])
        known = dict((p["name"], p) for p in signature["params"])
        for key, value in kwargs.items():
            if key not in known and (known or not signature["any"]):
                raise TypeError("%s.%s has no argument %s" % (where, name, key))
            if key in bound:
                raise TypeError("%s.%s: %s is given twice" % (where, name, key))
            bound[key] = value
        for p in signature["params"]:
            if p["name"] not in bound and not p["optional"] and (name, p["name"]) not in OPTIONAL:
                raise TypeError("%s.%s: %s is missing" % (where, name, p["name"]))
        for key, value in bound.items():
            if key in known:
                self._check(where, name, known[key], value)
        return bound

    def _check(self, where, name, param, value):
        kind, text = param["type"], "%s.%s: %s = %r" % (where, name, param["name"], value)
        if isinstance(value, _STRING):
            raise TypeError(text + " is unicode, which ABAQUS does not take everywhere")
        if (name, param["name"]) in UNTYPED or value is None and param["optional"]:
            return
        if isinstance(value, Constant):
            wanted = param["literal"]
            if (
                wanted is not None
                and value.name not in wanted
                and not ("Boolean" in kind and value.name in ("ON", "OFF"))
            ):
                raise TypeError(text + " is not one of " + ", ".join(wanted))
            if wanted is None and kind in ("str", "float", "int"):
                raise TypeError("%s is not of type %s" % (text, kind))
        elif param["literal"] is not None and kind.startswith("Literal") or kind == "SymbolicConstant":
            raise TypeError(text + " is not a constant")
        elif kind == "str" and not isinstance(value, str):
            raise TypeError(text + " is not a string")
        elif kind == "int" and (not isinstance(value, int) or isinstance(value, bool)):
            raise TypeError(text + " is not a whole number")
        elif kind == "float" and (not isinstance(value, (int, float)) or isinstance(value, bool)):
            raise TypeError(text + " is not a number")
        elif kind == "Boolean" and not isinstance(value, bool):
            raise TypeError(text + " is neither ON nor OFF")
        elif kind.startswith(("Sequence[", "tuple")) and (isinstance(value, str) or not hasattr(value, "__len__")):
            raise TypeError(text + " is not a sequence")


class Thing(object):
    """An object of the interface: what its class does not have cannot be read, called or set."""

    def __init__(self, world, key, path, **values):
        self.__dict__.update(_world=world, _key=key, _path=path, _values=values)
        setup = world.behaviours.get((world.table["classes"][key]["name"], "__init__"))
        if setup:
            setup(self)

    @property
    def _name(self):
        return self._world.table["classes"][self._key]["name"]

    def _plain(self):
        return self._path

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        world = self._world
        found = world.member(self._key, name)
        if found is None:
            raise Strict("%s (%s) has no %s" % (self._path, self._name, name))
        kind, what = found
        if kind == "method":
            return lambda *args, **kwargs: self._call(name, what, args, kwargs)
        if name in self._values:
            return self._values[name]
        for owner in world.lineage(self._key):
            made = world.behaviours.get((world.table["classes"][owner]["name"], "." + name))
            if made:
                return made(self)
        value = self._default(name, what)
        self._values[name] = value
        return value

    def __setattr__(self, name, value):
        raise Strict("%s.%s is set; the interface has methods for that" % (self._path, name))

    def _default(self, name, what):
        """An empty repository or a new object, by the attribute's type."""
        path = self._path + "." + name
        if what["type"].startswith("dict["):
            return Repository(self._world, path)
        if what["classes"]:
            return Thing(self._world, what["classes"][0], path)
        raise Strict("the fake has no value for %s" % path)

    def _call(self, name, signatures, args, kwargs):
        world = self._world
        path = "%s.%s" % (self._path, name)
        bound = world.bind(self._path, name, signatures, args, kwargs)
        world.record(path, bound)
        result = None
        stored = signatures[0]["stored"]
        if stored:
            repository = getattr(self, stored[0])
            result = Thing(world, stored[1], "%s['%s']" % (repository._path, bound["name"]), **bound)
            repository._store(bound["name"], result)
        elif signatures[0]["returns"]:
            key = signatures[0]["returns"][0]
            result = Thing(world, key, path + "()", **bound)
        for owner in world.lineage(self._key):
            does = world.behaviours.get((world.table["classes"][owner]["name"], name))
            if does:
                return does(self, result, **bound)
        return result


class Repository(object):
    """A repository: objects come in by methods of its owner and go by `del`."""

    def __init__(self, world, path, keys=(), make=None):
        self._world, self._path, self._items = world, path, []
        self._gone = None

    def _plain(self):
        return self._path

    def _store(self, key, value):
        self._items = [pair for pair in self._items if pair[0] != key] + [(key, value)]

    def __getitem__(self, key):
        for have, value in self._items:
            if have == key:
                return value
        raise KeyError("%s has no %r" % (self._path, key))

    def __delitem__(self, key):
        value = self[key]
        self._world.record(self._path + ".__delitem__", {"key": key})
        self._items = [pair for pair in self._items if pair[0] != key]
        if self._gone:
            self._gone(key, value)

    def __setitem__(self, key, value):
        raise Strict("%s takes objects by its owner's methods only" % self._path)

    def keys(self):
        return [key for key, _ in self._items]

    def values(self):
        return [value for _, value in self._items]

    def items(self):
        return list(self._items)

    def __getattr__(self, name):
        raise Strict("repository %s has no %s" % (self._path, name))


class Sequence(Thing):
    """Geometry or mesh objects in the order of their indices; `_source` gives them when they are asked for."""

    def __init__(self, world, class_name, path, source, whole=False):
        Thing.__init__(self, world, world.class_key(class_name), path)
        self.__dict__.update(_source=source, _list=None, _whole=whole, _class_name=class_name)

    def _objects(self):
        if self._list is None:
            self.__dict__["_list"] = list(self._source() if callable(self._source) else self._source)
        return self._list

    def _plain(self):
        if self._whole:
            return self._path
        objects, digest = self._objects(), 0
        for item in objects:
            digest = (digest * 31 + item.index + 1) % 1000000007
        return "%s[%d objects, %d]" % (self._class_name, len(objects), digest)

    def _of(self, objects):
        return Sequence(self._world, self._class_name, self._path, sorted(objects, key=lambda item: item.index))

    def __len__(self):
        counted = self.__dict__.get("_count")
        return counted() if counted else len(self._objects())

    def __iter__(self):
        return iter(self._objects())

    def __getitem__(self, at):
        found = self._objects()[at]
        return self._of(found) if isinstance(at, slice) else found

    def __add__(self, other):
        if self._class_name != other._class_name:
            raise TypeError("%s + %s" % (self._class_name, other._class_name))
        have = set(item.index for item in self)
        return self._of(list(self) + [item for item in other if item.index not in have])
