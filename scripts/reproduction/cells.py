"""Unit cells of voxels against the rule of mixtures."""

from __future__ import annotations

from .page import Picture, Section, read
from .program import RESULTS, Program, table


def section(program: Program) -> Section:
    """All layouts of the 3 x 3 x 1 cell for both pairs of the paper."""
    rows, pictures = [], []
    for soft, rigid in [("FLX9070", "FLX9095"), ("TangoBlack", "VeroClear")]:
        folder = RESULTS / f"cells_{soft}"
        program.once(folder / "unit_cells.csv", "micromechanics", "--phases", soft, rigid, "-o", folder)
        layouts = table(folder / "unit_cells.csv")

        def departures(axis: str, layouts: list[dict[str, str]] = layouts) -> list[float]:
            return [100.0 * (float(r[f"e{axis}_mpa"]) / float(r["voigt_mpa"]) - 1.0) for r in layouts]

        outside = sum(
            not (1 - 1e-9) * float(r["reuss_mpa"]) <= float(r[f"e{axis}_mpa"]) <= (1 + 1e-9) * float(r["voigt_mpa"])
            for r in layouts
            for axis in "xyz"
        )
        along, through = departures("x") + departures("y"), departures("z")
        rows.append(
            [
                f"{soft}, {rigid}",
                str(len(layouts)),
                f"{max(map(abs, through)):.1e} %",
                f"{sum(along) / len(along):.1f} %",
                f"{min(along):.1f} %",
                str(outside),
            ]
        )
        pictures += [
            Picture(
                f"cells_{soft.lower()}",
                read(folder / "unit_cells_modulus.svg"),
                f"Moduli of all layouts, {soft} and {rigid}",
            ),
        ]
    return Section(
        title="Unit cells and the rule of mixtures",
        stated="all 512 layouts of a 3 × 3 × 1 cell in finite elements; the longitudinal modulus follows Voigt's rule of mixtures, "
        "the transverse ones lie between Reuss and Voigt.",
        model="`voxelastica micromechanics`, 2 × 2 × 2 enhanced bricks a voxel, loaded faces sliding, sides free. Through the cell (z, where "
        "phases run from face to face) the modulus is Voigt's; in its plane it is not.",
        header=[
            "phases",
            "layouts",
            "largest departure from Voigt, z",
            "mean, x and y",
            "least, x and y",
            "outside the bounds",
        ],
        rows=rows,
        difference="none in direction and bounds. A slice of a strip is such a cell seen along z, one voxel long; a random strip is a row of "
        "*different* slices, whose phases do not run along it, and bends softer than Voigt says "
        "([micromechanics.md](micromechanics.md)). That is why voxel-resolved shapes below miss by more than the prediction, and what "
        '`match = "calibrated"` and `--refine` are for.',
        pictures=pictures,
    )
