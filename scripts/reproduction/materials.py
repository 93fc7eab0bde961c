"""The materials' table."""

from __future__ import annotations

from .page import Section
from .program import PAPER, Program, table


def section(program: Program) -> Section:
    """Every value of the paper's tables against the library's."""
    listed = {}
    for line in program.call("materials").splitlines()[1:]:
        name, *values = line[:26].strip(), *line[26:].split()
        listed[name] = values
    rows, wrong = [], []
    for stated in table(PAPER / "materials.csv"):
        values = [stated[key] for key in ("modulus_mpa", "poisson", "density_kg_m3", "conductivity_w_mk", "sigma_s_m")]
        ours = listed.get(stated["name"], ["-"] * 5)
        for value, own in zip(values, ours, strict=True):
            same = own == "-" if not value else own != "-" and float(value) == float(own)
            if not same:
                wrong.append(stated["name"])
        rows.append([stated["name"], *[value or "-" for value in values]])
    same = "none: the library has these values" if not wrong else f"**the library differs for {', '.join(wrong)}**"
    return Section(
        title="Materials",
        stated="moduli and densities of four printed resins and two filled thermoplastics, and the conductivities of the latter; "
        "Poisson's ratio 0.3 throughout. The body of the text swaps FLX9070 and FLX9095; its "
        "appendix has them right.",
        model="`voxelastica materials`.",
        header=["name", "E, MPa", "ν", "density, kg/m³", "k, W/(m K)", "σ, S/m"],
        rows=rows,
        difference=f"{same}. FLX9070 is the softer one here, as in the appendix. Specific heats and permittivities, which the "
        "paper needs for its transients and does not give, are assumptions: [conduction.md](conduction.md#values-that-are-assumed).",
    )
