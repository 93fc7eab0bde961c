"""A stand-in for abaqusGui: classes that can be derived from, as strict as the kernel's."""

from __future__ import division

import zlib


#: What ABAQUS's own reference has and the stubs have not.
FORGOTTEN = {"SEL_COMMAND": 1}


class Widget(object):
    """Base of all: what the class does not have cannot be read or called."""

    def __getattr__(self, name):
        world, key = type(self)._world, type(self)._key
        if name.startswith("__"):
            raise AttributeError(name)
        found = world.member(key, name)
        if found is None:
            raise AttributeError("%s has no %s" % (type(self).__name__, name))
        what = found[1]

        def call(*args, **kwargs):
            bound = world.bind(type(self).__name__, name, what, args, kwargs)
            world.record("%s.%s" % (type(self).__name__, name), bound)
            classes = [world.gui[k] for k in what[0]["returns"] if k in world.gui]
            return object.__new__(classes[0]) if classes else None

        return call

    def _plain(self):
        return "<%s>" % type(self).__name__


def install(world, module):
    """Puts every class and function of the stubs into the module; returns what is registered as menu buttons."""
    world.gui = {}

    def derive(name, key):
        found = world.member(key, "__init__")

        def init(self, *args, **kwargs):
            if found is not None:
                bound = world.bind(name, "__init__", found[1], args, kwargs)
                world.record(name + ".__init__", bound)

        members = {"__init__": init, "_world": world, "_key": key}
        for of in world.lineage(key):
            for number in world.table["classes"][of]["attributes"]:
                members.setdefault(str(number), zlib.crc32(number.encode("ascii")) & 0x7FFFFFFF)
        made = type(str(name), (Widget,), members)
        world.gui[key] = made
        return made

    def function(name, signatures):
        def call(*args, **kwargs):
            bound = world.bind("abaqusGui", name, signatures, args, kwargs)
            world.record("abaqusGui." + name, bound)
            classes = [world.gui[k] for k in signatures[0]["returns"] if k in world.gui]
            return object.__new__(classes[0]) if classes else None

        return call

    for name, key in sorted(world.table["gui"].items()):
        if key:
            setattr(module, str(name), derive(name, key))
    for name, key in FORGOTTEN.items():
        setattr(module, name, key)
    for name, key in world.table["gui"].items():
        if key is None and name not in world.table["modules"]["abaqusGui"]:
            setattr(module, str(name), zlib.crc32(name.encode("ascii")) & 0x7FFFFFFF)
    for name, signatures in world.table["modules"]["abaqusGui"].items():
        setattr(module, str(name), function(name, signatures))
