# SPDX-License-Identifier: MIT OR Apache-2.0
"""The sheet of a design's figures; solids take their thickness from it."""

from __future__ import annotations

from typing import Any

from .tree import Tree

#: Rows: text, alias, value from input and summary, unit.
_ROWS = (
    ("Spokes", "spokes", lambda i, s, n: n, ""),
    ("Length", "length", lambda i, s, n: i["strips"]["length_mm"], "mm"),
    ("Hub radius", "hub_radius", lambda i, s, n: i["strips"].get("hub_radius_mm"), "mm"),
    ("Thickness", "thickness", lambda i, s, n: i["strips"]["thickness_mm"], "mm"),
    ("Voxel edge", "voxel_edge", lambda i, s, n: i["voxels"]["size_mm"], "mm"),
    ("Contrast of modulus", "contrast", lambda i, s, n: s["contrast"], ""),
    ("Height of the dome", "height", lambda i, s, n: s.get("height_mm"), "mm"),
    ("Radius of the rim", "rim_radius", lambda i, s, n: s.get("rim_radius_mm"), "mm"),
    ("Inclination at the rim", "rim_angle", lambda i, s, n: s.get("rim_angle_deg"), "deg"),
    ("Inclination at the hub", "hub_angle", lambda i, s, n: s.get("hub_angle_deg"), "deg"),
    ("Predicted error, % of the length", "predicted_error", lambda i, s, n: s.get("predicted_error_percent"), ""),
    ("Volume of a spoke", "spoke_volume", lambda i, s, n: s["volume_mm3"]["spoke_smooth"], "mm^3"),
    ("Volume of the hub", "hub_volume", lambda i, s, n: s["volume_mm3"].get("hub"), "mm^3"),
)


def add_sheet(tree: Tree, design: Any, name: str) -> Any:
    """The sheet, below the root."""
    sheet = tree.document.addObject("Spreadsheet::Sheet", name)
    sheet.Label = name
    tree.root.addObject(sheet)
    head = ((f"Voxelastica: {design.name}", ""), ("Design (SHA-256)", design.hash))
    for row, (text, value) in enumerate(head, 1):
        sheet.set(f"A{row}", "'" + text)
        if value:
            sheet.set(f"B{row}", "'" + value)
    row = len(head)
    for text, alias, value, unit in _ROWS:
        number = value(design.input, design.summary, design.spokes)
        if number is None:
            continue
        row += 1
        sheet.set(f"A{row}", "'" + text)
        sheet.set(f"B{row}", f"={number!r}{' ' + unit if unit else ''}")
        sheet.setAlias(f"B{row}", alias)
    if hasattr(sheet, "setColumnWidth"):
        sheet.setColumnWidth("A", 220)
        sheet.setColumnWidth("B", 160)
    tree.document.recompute()
    return sheet
