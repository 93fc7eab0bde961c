"""What CAE would import of a deck: parts with their element sets, as far as the scripts look."""

from __future__ import division

import io

from .geometry import Entity
from .recorder import Sequence, Thing


def load(world, model, path):
    """Puts the parts of a deck and the element sets in them into a model."""
    part, sets, current = None, {}, None
    with io.open(path, encoding="utf-8") as file_:
        for line in file_:
            if line.startswith("**"):
                continue
            if not line.startswith("*"):
                if current is not None:
                    sets[current] = sets.get(current, 0) + 1
                continue
            words = [word.strip() for word in line[1:].split(",")]
            options = dict(word.split("=", 1) for word in words[1:] if "=" in word)
            current = None
            if words[0] == "PART":
                part = str(options["NAME"])
            elif words[0] == "ELEMENT" and part:
                current = str(options["ELSET"])
            elif words[0] == "END PART":
                break
    made = Thing(world, world.class_key("Part"), "%s.parts['%s']" % (model._path, part))
    model.parts._store(part, made)
    made._values["elements"] = _elements(world, made._path, sum(sets.values()))
    for name, count in sorted(sets.items()):
        path = "%s.sets['%s']" % (made._path, name)
        found = Thing(world, world.class_key("Set"), path, elements=_elements(world, path, count))
        made.sets._store(name, found)


def _elements(world, path, count):
    return Sequence(world, "MeshElementArray", path + ".elements", [Entity("element", (), (), i) for i in range(count)])
