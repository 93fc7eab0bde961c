"""Puts the stand-in's modules where `import abaqus` finds them."""

from __future__ import division

import sys
import types

from . import geometry, gui, odb
from .recorder import Repository, Thing, World


class Module(types.ModuleType):
    """A module that knows its names only."""

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        raise ImportError("%s has no %s" % (self.__name__, name))


def install(table, replies=()):
    """Makes the modules of the scripting interface; returns the world with `mdb`, `messages` and `replies`.

    ``replies`` are what getInputs, getInput and getWarningReply answer, in order.
    """
    world = World(table)
    geometry.install(world)
    odb.install(world)
    world.odbs = {}
    world.replies, world.messages = list(replies), []
    world.mdb = Thing(world, world.class_key("Mdb"), "mdb")
    world.mdb._values["models"] = Repository(world, "mdb.models")
    world.mdb._values["jobs"] = Repository(world, "mdb.jobs")
    model = Thing(world, world.class_key("Model"), "mdb.models['Model-1']")
    world.mdb.models._store("Model-1", model)

    def function(module, name):
        signatures = world.table["modules"][module][name]

        def call(*args, **kwargs):
            bound = world.bind(module, name, signatures, args, kwargs)
            world.record("%s.%s" % (module, name), bound)
            if name in ("getInput", "getInputs", "getWarningReply"):
                return world.replies.pop(0)
            if name == "openOdb":
                if bound["path"] not in world.odbs:
                    raise IOError("%s is no output database" % bound["path"])
                return world.odbs[bound["path"]]
            return None

        return call

    made = {}
    for name in ("abaqus", "abaqusConstants", "mesh", "odbAccess", "abaqusGui"):
        made[name] = sys.modules[name] = Module(name)
    for name, constant in world.constants.items():
        setattr(made["abaqusConstants"], name, constant)
    for name in world.table["modules"]["abaqus"]:
        setattr(made["abaqus"], str(name), function("abaqus", name))
    made["abaqus"].mdb = world.mdb
    for name in world.table["modules"]["odbAccess"]:
        setattr(made["odbAccess"], str(name), function("odbAccess", name))

    def constructor(name):
        key = world.class_key(name)
        signatures = world.member(key, "__init__")[1]

        def make(*args, **kwargs):
            bound = world.bind("mesh" if name == "ElemType" else "odbAccess", name, signatures, args, kwargs)
            world.record(name + ".__init__", bound)
            text = ", ".join("%s=%s" % (k, world.plain(v)) for k, v in sorted(bound.items()))
            return Thing(world, key, "%s(%s)" % (name, text), **bound)

        return make

    gui.install(world, made["abaqusGui"])
    made["mesh"].ElemType = constructor("ElemType")
    made["odbAccess"].HistoryPoint = constructor("HistoryPoint")
    return world
