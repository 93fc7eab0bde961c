"""Element types: how many nodes, which section, which nodes make up a face (numbered from 1, as the solvers do)."""

from __future__ import annotations

from dataclasses import dataclass

HEX_FACES = {
    "S1": (1, 2, 3, 4),
    "S2": (5, 8, 7, 6),
    "S3": (1, 5, 6, 2),
    "S4": (2, 6, 7, 3),
    "S5": (3, 7, 8, 4),
    "S6": (4, 8, 5, 1),
}
HEX20_FACES = {
    "S1": (1, 2, 3, 4, 9, 10, 11, 12),
    "S2": (5, 8, 7, 6, 16, 15, 14, 13),
    "S3": (1, 5, 6, 2, 17, 13, 18, 9),
    "S4": (2, 6, 7, 3, 18, 14, 19, 10),
    "S5": (3, 7, 8, 4, 19, 15, 20, 11),
    "S6": (4, 8, 5, 1, 20, 16, 17, 12),
}
WEDGE_FACES = {"S1": (1, 2, 3), "S2": (4, 6, 5), "S3": (1, 4, 5, 2), "S4": (2, 5, 6, 3), "S5": (3, 6, 4, 1)}
TET_FACES = {"S1": (1, 2, 3), "S2": (1, 4, 2), "S3": (2, 4, 3), "S4": (3, 4, 1)}
QUAD_FACES = {s: (1, 2, 3, 4) for s in ("SPOS", "SNEG")} | {"E1": (1, 2), "E2": (2, 3), "E3": (3, 4), "E4": (4, 1)}
TRI_FACES = {s: (1, 2, 3) for s in ("SPOS", "SNEG")} | {"E1": (1, 2), "E2": (2, 3), "E3": (3, 1)}


@dataclass(frozen=True)
class ElementType:
    """``section``: the keyword that gives the element its properties; rigid elements need a *RIGID BODY instead."""

    nodes: int
    section: str
    faces: dict[str, tuple[int, ...]]


_SHAPES = [
    (
        ("C3D8", "C3D8R", "C3D8I", "C3D8H", "C3D8RH", "C3D8IH", "C3D8T", "C3D8RT", "DC3D8", "DC3D8E"),
        8,
        "SOLID SECTION",
        HEX_FACES,
    ),
    (("C3D20", "C3D20R", "C3D20H", "C3D20RH"), 20, "SOLID SECTION", HEX20_FACES),
    (("C3D6", "C3D6H"), 6, "SOLID SECTION", WEDGE_FACES),
    (("C3D4", "C3D4H"), 4, "SOLID SECTION", TET_FACES),
    (("C3D10", "C3D10M", "C3D10HS", "C3D10I"), 10, "SOLID SECTION", TET_FACES),
    (("S4", "S4R", "S4RS", "S4R5"), 4, "SHELL SECTION", QUAD_FACES),
    (("S3", "S3R", "S3RS", "STRI3"), 3, "SHELL SECTION", TRI_FACES),
    (("S8R", "S8R5"), 8, "SHELL SECTION", QUAD_FACES),
    (("R3D4",), 4, "RIGID BODY", QUAD_FACES),
    (("R3D3",), 3, "RIGID BODY", TRI_FACES),
]
TYPES = {name: ElementType(n, section, faces) for names, n, section, faces in _SHAPES for name in names}
CALCULIX = {"DC3D8", "C3D8", "C3D8R", "C3D8I", "C3D20", "C3D20R", "C3D6", "C3D4", "C3D10", "S4", "S4R", "S3", "S8R"}
