"""How large a model will be, and which way to build it."""

from __future__ import division

from . import cells

#: Cells up to which CAE partitions in reasonable time; every cut visits every cell, so the time grows with the square.
MOST_CELLS = 20000


def geometry(design):
    """Cells, cuts and questions of the strip as geometry."""
    cuts = design.slices + design.layers + 2 * max(design.half_widths) - 3
    return {"cells": design.voxels, "cuts": cuts, "questions": cells.planes(design)}


def mesh(design):
    """Elements and nodes of the strip as a mesh; the nodes within a few percent."""
    per_edge, _ = design.elements_per_edge()
    elements = design.voxels * per_edge**3
    sections = sum(2 * half * per_edge + 1 for half in design.half_widths) * per_edge
    return {"elements": elements, "nodes": sections * (design.layers * per_edge + 1)}


def recommend(design):
    """The way recommended for the strip, "geometry" or "mesh", and why."""
    size, elements = geometry(design), mesh(design)["elements"]
    if not design.listed:
        return "mesh", "%d voxels are too many to be listed one by one" % design.voxels
    if design.initial_bow:
        return "mesh", "the strip starts bowed, which flat geometry has not"
    if size["cells"] > MOST_CELLS:
        why = "%d voxels would need %d cuts through up to as many cells; the mesh of %d elements is imported at once"
        return "mesh", why % (size["cells"], size["cuts"], elements)
    return "geometry", "%d voxels and %d cuts are few enough to partition" % (size["cells"], size["cuts"])
