# SPDX-License-Identifier: GPL-3.0-or-later
"""Computed designs, kept by their text so that undo, reload and copies find them again."""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Callable
from functools import cached_property
from typing import Any

from . import inputs, voxel_mesh
from .library import api

#: Designs that are kept; computing one again takes milliseconds.
_KEPT = 12


class Prepared:
    """A design and what the preview needs of it, made when it is first asked for."""

    def __init__(self, design: Any) -> None:
        self.design = design
        self._made: dict[Any, Any] = {}

    @cached_property
    def input(self) -> dict[str, Any]:
        """The design's input, defaults filled in."""
        return self.design.input

    @cached_property
    def text(self) -> str:
        """The input as text: what is stored with an object."""
        return inputs.canonical(self.input)

    def once(self, key: Any, make: Callable[[], Any]) -> Any:
        """What ``make`` returned when this key was first asked for."""
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]

    def flower(self, along: int, across: int) -> Any:
        """The surfaces of all spokes."""
        return self.once(("flower", along, across), lambda: self.design.flower(along=along, across=across))

    def exposed(self, slices: int, phase: int) -> voxel_mesh.Exposed:
        """Faces of one spoke's voxels that can be seen."""
        return self.once(("voxels", slices, phase), lambda: voxel_mesh.exposed(self.design.voxels, slices, phase))


_designs: OrderedDict[str, Prepared] = OrderedDict()


def computed(keys: dict[str, Any], folder: str = "") -> Prepared:
    """The design of a dictionary with the design file's keys.

    :raises VoxelasticaError: wrong input or an infeasible design
    """
    if "file" in keys["target"]:  # The file may have changed meanwhile.
        return _keep(Prepared(api().Design.from_dict(keys, folder=folder)))
    text = inputs.canonical(keys)
    return _kept(text) or _keep(Prepared(api().Design.from_json(text)), text)


def stored(text: str) -> Prepared:
    """The design of a text that an object stores.

    :raises VoxelasticaError: a text of another version that the library does not take
    """
    return _kept(text) or _keep(Prepared(api().Design.from_json(text)), text)


def forget() -> None:
    """Lets all designs go."""
    _designs.clear()


def _kept(text: str) -> Prepared | None:
    if text in _designs:
        _designs.move_to_end(text)
    return _designs.get(text)


def _keep(prepared: Prepared, *texts: str) -> Prepared:
    for text in (prepared.text, *texts):
        _designs[text] = prepared
        _designs.move_to_end(text)
    while len(_designs) > 2 * _KEPT:
        _designs.popitem(last=False)
    return prepared


def parsed(text: str) -> dict[str, Any]:
    """The input that an object stores; empty where it stores none."""
    return json.loads(text) if text else {}
