"""Rigidity and energy over the aspect ratio."""

from __future__ import annotations

from .page import Picture, Section, number, read
from .program import EXAMPLES, RESULTS, Program, table


def section(program: Program) -> Section:
    """Hemi-ellipsoids with their true tangent."""
    folder = RESULTS / "aspect_ratio"
    program.once(folder / "results.csv", "sweep", EXAMPLES / "sweeps" / "aspect_ratio.toml", "-o", folder)
    all_rows = [r for r in table(folder / "results.csv") if r["strips.count"] == "8"]
    value = {float(r["target.aspect_ratio"]): r for r in all_rows}
    rows = [
        [
            f"{ratio:g}",
            f"{float(r['contrast']):.3f}",
            number(float(r["tangent_n_mm"])),
            number(float(r["rigidity_n_mm"])),
            number(float(r["specific_energy_nmm_mm3"])),
            f"{float(r['contact_depth_mm']):g}",
        ]
        for ratio, r in value.items()
        if abs(ratio / 0.25 - round(ratio / 0.25)) < 1e-9 or ratio in (0.9, 1.1)
    ]

    def least(key: str) -> float:
        return min(value, key=lambda ratio: float(value[ratio][key]))

    return Section(
        title="Rigidity and energy over the aspect ratio",
        stated="rigidity and specific energy of hemi-ellipsoids are not monotonic over a/b and smallest near a/b = 1.",
        model="examples/sweeps/aspect_ratio.toml: 31 ratios from 0.5 to 2, N = 8 shown, elastica with the indenter, `K` in N/mm and ψ in N mm/mm³ for one spoke.",
        header=["a/b", "contrast", "tangent", "K", "ψ", "first contact, mm"],
        rows=rows,
        difference=f"confirmed between 0.5 and about 1.6, with the least K at a/b = {least('rigidity_n_mm'):g} and the least ψ at "
        f"{least('specific_energy_nmm_mm3'):g}. Beyond, both fall again: the stiffest place moves from the ends into the spoke, and the ends, limited by the "
        "stiffest phase, grow softer. The published domes for a/b ≠ 1 are others than these (errata).",
        pictures=[
            Picture(
                "rigidity",
                read(folder / "plots" / "rigidity_n_mm_over_target_aspect_ratio.svg"),
                "K over a/b for 6, 8 and 12 spokes",
            ),
            Picture(
                "specific_energy",
                read(folder / "plots" / "specific_energy_nmm_mm3_over_target_aspect_ratio.svg"),
                "ψ over a/b for 6, 8 and 12 spokes",
            ),
        ],
    )
