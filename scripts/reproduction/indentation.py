"""The hemisphere under load."""

from __future__ import annotations

import json

from .page import Picture, Section, number, read
from .program import PAPER, Program

CALCULIX = {("hub", 10.0): 0.167, ("flat", 1.0): 0.0286, ("flat", 5.0): 0.119, ("flat", 10.0): 0.243}


def force(record: dict, depth: float) -> float:
    """Force at a depth, linear between points."""
    points = [(p["depth_mm"], p["force_n"]) for p in record["curve"]]
    for (a, f), (b, g) in zip(points, points[1:], strict=False):
        if b >= depth - 1e-9:
            return f + (depth - a) / (b - a) * (g - f)
    raise SystemExit(f"the curve ends before {depth} mm")


def section(program: Program) -> Section:
    """Force over depth with and without the indenter, in both limits of bending."""
    folder = program.design(PAPER / "hemisphere.toml")
    peak = max(json.loads((folder / "design.json").read_text())["profile"]["modulus_mpa"])
    rows, first = [], {}
    for indenter in ("hub", "flat"):
        found = {}
        for bending in ("plane-strain", "beam"):
            program.call("indent", folder, "--indenter", indenter, "--bending", bending)
            found[bending] = json.loads((folder / "indentation" / f"elastica_{indenter}.json").read_text())
        first[indenter] = found["beam"]
        program.call("indent", folder, "--model", "graded", "--ignore-neighbours", "--indenter", indenter)
        found["graded"] = json.loads((folder / "indentation" / f"graded_{indenter}.json").read_text())
        for depth in (1.0, 5.0, 10.0):
            limits = ("beam", "plane-strain", "graded")
            beam, plate, graded = (force(found[b], depth) * 12.6 / peak for b in limits)
            solid = CALCULIX.get((indenter, depth))
            what = "hub alone" if indenter == "hub" else "with the indenter"
            rows.append(
                [what, f"{depth:g}", number(beam), number(plate), number(graded), number(solid) if solid else "-"]
            )
    record = first["flat"]
    return Section(
        title="The hemisphere under load",
        stated="a flat indenter of 50 mm presses the dome down by 10 mm, with a band of ±10 % of the moduli and a loading "
        "rate of 0.1 1/s. Curves only. The authors see neighbouring spokes whose voxels were rounded outward overlap and "
        "stiffen the dome.",
        model="`voxelastica indent examples/paper/hemisphere`, one spoke, the graded strip as an elastica and as a solid, the indenter as unilateral contact, no neighbours. Forces "
        f"in N, scaled to a largest modulus of 12.6 MPa (this design's is {peak:.2f}: whole voxels leave a little less). CalculiX: a trial with a solid strip, "
        f"60 × 6 × 2 C3D8I. K = {number(record['rigidity_n_mm'])} N/mm over the thickness and {number(record['tangent_n_mm'])} N/mm at no depth, "
        f"W = {number(record['work_nmm'])} N mm, ψ = {number(record['specific_energy_nmm_mm3'])} N mm/mm³, as the design stands.",
        header=["", "depth, mm", "beam", "plane strain", "graded solid", "CalculiX"],
        rows=rows,
        difference="solids lie between the limits of bending. The paper defines its rigidity as the slope for depths up to the thickness; the "
        "tangent is a tenth larger, so say which is meant. Rounded edges do stiffen the dome: with voxels of 1 mm and the neighbours in the way K is "
        "five times that of the spoke alone, rounded inward one and a half times "
        "([indentation.md](indentation.md#do-rounded-voxel-edges-stiffen-the-dome)).",
        pictures=[
            Picture(
                "indentation", read(folder / "indentation" / "curves.svg"), "Force over depth, with the band of ±10 %"
            )
        ],
    )
