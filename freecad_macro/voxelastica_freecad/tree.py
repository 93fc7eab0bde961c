# SPDX-License-Identifier: MIT OR Apache-2.0
"""Helpers for the document's tree, the same with and without a window."""

from __future__ import annotations

from typing import Any

import FreeCAD as App

Vector = App.Vector


class Tree:
    """Adds named objects to a document, below one group.

    :ivar document: the document
    :ivar root: the group
    """

    def __init__(self, document: Any, name: str) -> None:
        self.document = document
        self.root = document.addObject("App::DocumentObjectGroup", "Voxelastica")
        self.root.Label = name

    def group(self, name: str) -> Any:
        """A group below the root."""
        group = self.document.addObject("App::DocumentObjectGroup", name)
        group.Label = name
        self.root.addObject(group)
        return group

    def add(self, kind: str, name: str, group: Any) -> Any:
        """An object of a kind, below a group."""
        made = self.document.addObject(kind, name)
        made.Label = name
        group.addObject(made)
        return made


def show(item: Any, *, visible: bool = True, **looks: Any) -> None:
    """Sets visibility and looks; without a window only what the document itself keeps."""
    item.Visibility = visible
    view = getattr(item, "ViewObject", None)
    if view is None:
        return
    view.Visibility = visible
    for name, value in looks.items():
        if hasattr(view, name):
            setattr(view, name, value)
    if looks and hasattr(view, "ShapeAppearance"):
        # FreeCAD 1.0 shines by default, which drowns the colours.
        dull = list(view.ShapeAppearance)
        for material in dull:
            material.SpecularColor, material.Shininess = (0.05, 0.05, 0.05), 0.1
        view.ShapeAppearance = tuple(dull)


def note(item: Any, name: str, value: Any, text: str, kind: str = "App::PropertyString") -> None:
    """Adds a property of Voxelastica's own to an object."""
    item.addProperty(kind, name, "Voxelastica", text)
    setattr(item, name, value)
