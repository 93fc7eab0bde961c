"""Heat and current."""

from __future__ import annotations

import json

from .page import Picture, Section, number, read
from .program import EXAMPLES, Program

CASES = [
    "strip_soft",
    "strip_rigid",
    *[
        f"strip_{ratio}_{pattern}"
        for ratio in ("0.5", "2")
        for pattern in ("random", "centred", "split", "through_thickness")
    ],
    *[f"hemisphere_{pattern}" for pattern in ("random", "centred", "split", "through_thickness")],
]


def section(program: Program) -> Section:
    """Steady and transient heat, steady current, of the paper's strips and spokes."""
    rows, pictures = [], []
    for name in CASES:
        folder = program.design(EXAMPLES / "conduction" / f"{name}.toml")
        ashby = ["--ashby"] if name == "strip_0.5_random" else []
        program.once(folder / "conduct.json", "conduct", folder, "--no-vtu", *ashby)
        cases = {c["problem"]: c for c in json.loads((folder / "conduct.json").read_text())["cases"]}
        heat, current = cases["heat"], cases["current"]
        critical = heat["transient"]["critical_times_s"][-1]
        by_time = heat["transient"]["effective_conductivities"][-1]
        potential = current["transient"]["critical_times_s"][0]
        rows.append(
            [
                name.replace("_", " "),
                number(critical, 4),
                number(by_time, 4),
                number(heat["steady"]["effective_conductivity"], 4),
                number(current["steady"]["effective_conductivity"], 3),
                f"{1e3 * potential:.3g}" if potential is not None else "not within the run",
            ]
        )
        if name == "strip_0.5_random":
            pictures += [
                Picture(
                    "heat_fields",
                    read(folder / "conduction" / "heat_voxel_flat_fields.svg"),
                    "Temperature after 100, 1000, 2000 s and in the long run",
                ),
                Picture(
                    "heat_history", read(folder / "conduction" / "heat_voxel_flat_history.svg"), "Temperature over time"
                ),
                Picture(
                    "current_fields",
                    read(folder / "conduction" / "current_voxel_flat_fields.svg"),
                    "Potential after 0.1, 1 and 2 ms and in the long run",
                ),
                Picture(
                    "ashby_thermal",
                    read(folder / "conduction" / "ashby_thermal.svg"),
                    "Modulus against thermal conductivity",
                ),
            ]
    return Section(
        title="Heat and current",
        stated="strips of 40 × 12 mm and the spoke of a 40 mm hemisphere from PI + 15 % graphite and PLA + 30 % carbon fibre, rim at 393.15 K, start at "
        "316.15 K; fields after 100, 1000 and 2000 s; critical times to 99.9 % and from them effective conductivities; 1 A at the rim, fields after 0.1, 1 "
        "and 2 ms, a plateau to 0.1 %; an Ashby chart of modulus against conductivity. Specific heats and permittivities are not given.",
        model="examples/conduction: voxels of 0.5 mm, flat, `voxelastica conduct`; 99.9 % of the *rise*. Specific heats and permittivities are assumptions, and "
        "times scale with them ([conduction.md](conduction.md#values-that-are-assumed)).",
        header=[
            "case",
            "critical time, s",
            "k by time, W/(m K)",
            "k by flow, W/(m K)",
            "σ by flow, S/m",
            "plateau of the potential, ms",
        ],
        rows=rows,
        difference="times cannot be compared without the paper's specific heats. By time and by flow differ where the strip is graded along its length: steady "
        "flow weighs all resistances alike, the time at the far end those near the rim more. The current is decided by one question: whether the conducting "
        "polyimide reaches through. Where it does not, the potential climbs for the 29 000 years in which the other phase relaxes.",
        pictures=pictures,
    )
