"""Patterns of aggregation on the rectangular strip."""

from __future__ import annotations

from .page import Section, number, percent
from .program import EXAMPLES, RESULTS, Program, summary

PATTERNS = ["random", "random-layered", "centred", "split", "through-thickness", "one-edge"]


def section(program: Program) -> Section:
    """Six patterns, two gradings, mechanics."""
    rows = []
    for ratio in ("0.5", "2"):
        source = (EXAMPLES / f"rectangular_{ratio}.toml").read_text()
        for pattern in PATTERNS:
            name = f"pattern_{ratio}_{pattern}"
            file = RESULTS / f"{name}.toml"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(
                source.replace("size_mm = 0.5", f'size_mm = 0.5\npattern = "{pattern}"') + "\n[decks]\nwrite = []\n"
            )
            folder = program.design(file)
            voxel = program.verify(folder, "voxel")
            rows.append(
                [
                    ratio,
                    pattern,
                    percent(summary(folder)["predicted_error_percent"]),
                    percent(voxel["max_error_percent"]),
                    number(voxel["reactions"]["rim_horizontal_n"], 4),
                ]
            )
    return Section(
        title="Patterns of aggregation",
        stated="the strips with the same fractions put together in other ways. No numbers are stated.",
        model="the strips of the last section with the six patterns, every voxel resolved.",
        header=["E_R", "pattern", "predicted, of L", "voxels, of L", "H, N"],
        rows=rows,
        difference="where all layers are alike the shape hardly depends on the pattern. Layers that differ (`through-thickness`) move the neutral axis off the middle and "
        'change the stiffness: the prediction knows it, and `match = "stiffness"` designs for it.',
    )
