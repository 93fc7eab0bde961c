"""Three phases."""

from __future__ import annotations

from .page import Picture, Section, percent
from .program import EXAMPLES, Program, figure, summary


def section(program: Program) -> Section:
    """The hemisphere of three resins."""
    folder = program.design(EXAMPLES / "three_phases.toml")
    facts = summary(folder)
    voxel = program.verify(folder, "voxel")
    total = sum(facts["voxels"].values())
    shares = ", ".join(f"{name} {100 * n / total:.1f} %" for name, n in facts["voxels"].items())
    return Section(
        title="Three phases",
        stated="a hemisphere whose middle phase keeps a fraction of 0.2 along the strip, from three resins.",
        model=f"examples/three_phases.toml; a middle resin of 6.5 MPa is ours. Shares of the volume: {shares}.",
        header=["contrast", "predicted, of L", "voxels, of L"],
        rows=[
            [
                f"{facts['contrast']:.3f}",
                percent(facts["predicted_error_percent"]),
                percent(voxel["max_error_percent"]),
            ]
        ],
        difference="none to be seen. Where a fraction would turn negative the middle one is reduced there, and the report says so.",
        pictures=[Picture("three_phases", figure(folder, "Voxels"), "Voxels of three phases")],
    )
