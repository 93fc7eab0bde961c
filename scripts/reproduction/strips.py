"""Clamped rectangular strips."""

from __future__ import annotations

import json

from .page import Picture, Section, percent, read
from .program import EXAMPLES, Program


def section(program: Program) -> Section:
    """The three strips, shortened by 60 %."""
    rows, pictures = [], []
    for ratio in ("0.5", "1", "2"):
        folder = program.design(EXAMPLES / f"rectangular_{ratio}.toml")
        middle = json.loads((folder / "design.json").read_text())["predicted_midline_mm"]
        apex = max(point[2] for point in middle)
        graded, voxel = program.verify(folder, "graded"), program.verify(folder, "voxel")
        height = {name: max(p[2] for p in v["midline_mm"]) for name, v in (("graded", graded), ("voxel", voxel))}
        rows.append(
            [
                ratio,
                f"{apex:.3f}",
                f"{height['graded']:.3f}",
                f"{height['voxel']:.3f}",
                percent(graded["max_error_percent"]),
                percent(voxel["max_error_percent"]),
            ]
        )
        pictures.append(
            Picture(f"strip_{ratio}", read(folder / "verification_voxel.svg"), f"Clamped strip, E_R = {ratio}")
        )
    return Section(
        title="Clamped rectangular strips",
        stated="strips of 40 × 12 mm whose modulus runs linearly to E_R = 0.5, 1 and 2 times that of the ends in the middle, "
        "clamped and shortened by 60 %: elastica, graded and discretised finite elements. No numbers are stated.",
        model="examples/rectangular_*.toml: elastica of variable stiffness, the graded strip and the voxels (0.5 mm, random) by the finite elements "
        "inside (neo-Hookean law: the faces are strained by more than a tenth).",
        header=[
            "E_R",
            "apex, elastica, mm",
            "graded, mm",
            "voxels, mm",
            "graded, off the elastica",
            "voxels, off the elastica",
        ],
        rows=rows,
        difference="shares of L = 40 mm. The elastica keeps its length and knows no shear; at 60 % the strip's thickness (a twentieth of its length) shows.",
        pictures=pictures,
    )
