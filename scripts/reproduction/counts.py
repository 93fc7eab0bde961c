"""Elements of the paper's meshes."""

from __future__ import annotations

from pathlib import Path

from .page import Section
from .program import PAPER, RESULTS, Program, summary


def elements(deck: Path) -> int:
    """Elements of a deck."""
    count, inside = 0, False
    with deck.open() as lines:
        for line in lines:
            if line.startswith("*"):
                inside = line.upper().startswith("*ELEMENT,")
            elif inside and line.strip():
                count += 1
    return count


def spaced(count: int) -> str:
    """A number with thin groups."""
    return f"{count:,}".replace(",", " ")


def section(program: Program) -> Section:
    """Counts of the three meshes that the paper gives."""
    # Flat decks hold every instance.
    file = RESULTS / "meshes.toml"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text((PAPER / "hemisphere.toml").read_text() + 'style = "flat"\n')
    folder = program.design(file)
    rows = []
    for mesh, kind, stated in [
        ("smooth shell, all spokes and hub", "graded_shell", 16340),
        ("voxel shell, all spokes", "voxel_shell", 133840),
        ("voxel solid, one spoke", "voxel_solid", 221376),
    ]:
        ours = elements(folder / "abaqus" / f"{kind}.inp")
        rows.append([mesh, spaced(stated), spaced(ours), f"{100.0 * (ours / stated - 1.0):+.2f} %"])
    voxels = summary(folder)["voxels_per_spoke"]
    return Section(
        title="Meshes of the hemisphere",
        stated="16 340 shells for the smooth flower, 133 840 shells of 0.5 mm for the discretised one, 221 376 bricks for a discretised solid "
        "strip.",
        model="the decks of examples/paper/hemisphere.toml, flat.",
        header=["mesh", "the paper", "here", "difference"],
        rows=rows,
        difference="the smooth mesh is a matter of choice (`decks.shell_elements`). The shells of 0.5 mm follow from the geometry and agree. The "
        f"solid's count does not: L = 100, t = 2, η = 0.5 give {spaced(voxels)} voxels a spoke and, with 2 × 2 × 2 bricks each, {spaced(8 * voxels)} elements.",
    )
