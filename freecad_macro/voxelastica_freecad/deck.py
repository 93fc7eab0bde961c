# SPDX-License-Identifier: MIT OR Apache-2.0
"""Reads the project's CalculiX decks, and writes them again with other materials."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from .settings import MacroError

#: Keywords that say what the elements are made of.
_MATERIAL = ("SOLID SECTION", "MATERIAL", "ELASTIC", "HYPERELASTIC", "DENSITY")


@dataclass
class Material:
    """A material and its elements: of a set of the deck, or of a set that is made."""

    name: str
    element_set: str
    modulus_mpa: float
    poisson: float
    density_kg_m3: float
    elements: list[int] = field(default_factory=list)


@dataclass
class Block:
    """A keyword with its parameters, and everything up to the next keyword as written."""

    keyword: str
    parameters: dict[str, str]
    lines: list[str]

    def data(self) -> Iterator[list[str]]:
        """The data lines, split."""
        for line in self.lines[1:]:
            if not line.startswith("**") and line.strip():
                yield [cell.strip() for cell in line.split(",")]

    def ids(self) -> list[int]:
        """Node or element numbers of a set."""
        if "GENERATE" in self.parameters:
            numbers: list[int] = []
            for row in self.data():
                first, last, step = (int(cell) for cell in [*row, "1"][:3])
                numbers.extend(range(first, last + 1, step))
            return numbers
        return [int(cell) for row in self.data() for cell in row if cell]


class Deck:
    """A deck of one strip: nodes, hexahedra, sets, boundary values, materials."""

    def __init__(self, text: str, name: str) -> None:
        self.name = name
        self.blocks: list[Block] = []
        for line in text.splitlines():
            if line.startswith("*") and not line.startswith("**"):
                words = [word.strip() for word in line[1:].split(",")]
                pairs = (word.partition("=") for word in words[1:])
                parameters = {key.strip().upper(): value.strip() for key, _, value in pairs}
                self.blocks.append(Block(words[0].upper(), parameters, [line]))
            elif self.blocks:
                self.blocks[-1].lines.append(line)
        if not any(block.keyword == "END STEP" for block in self.blocks):
            raise MacroError(f"{name}: this deck has no *END STEP; it may be cut short", 1)

    @classmethod
    def read(cls, path: str | Path) -> Deck:
        """The deck of a file."""
        try:
            return cls(Path(path).read_text(encoding="utf-8"), str(path))
        except OSError as error:
            raise MacroError(f"{path}: this deck cannot be read: {error.strerror}") from None

    def _all(self, keyword: str) -> Iterator[Block]:
        return (block for block in self.blocks if block.keyword == keyword)

    def nodes(self) -> dict[int, tuple[float, float, float]]:
        """Number to position, mm; reference nodes included."""
        rows = (row for block in self._all("NODE") for row in block.data())
        return {int(row[0]): (float(row[1]), float(row[2]), float(row[3])) for row in rows}

    def elements(self) -> dict[int, list[int]]:
        """Number to the eight nodes of every hexahedron."""
        rows = (row for block in self._all("ELEMENT") for row in block.data())
        return {int(row[0]): [int(cell) for cell in row[1:9]] for row in rows}

    def element_type(self) -> str:
        """Type of the elements, such as ``C3D8I``."""
        return next(self._all("ELEMENT")).parameters["TYPE"]

    def node_set(self, name: str) -> list[int]:
        """Nodes of a set, in its order."""
        for block in self._all("NSET"):
            if block.parameters.get("NSET") == name:
                return block.ids()
        raise MacroError(f"{self.name}: there is no node set {name}", 1)

    def sections(self) -> list[str]:
        """Element sets that have a material."""
        return [block.parameters["ELSET"] for block in self._all("SOLID SECTION")]

    def field(self) -> dict[int, float]:
        """The nodal field that carries the modulus, MPa; empty where every phase has its own material."""
        rows = (row for block in self._all("INITIAL CONDITIONS") for row in block.data())
        return {int(row[0]): float(row[1]) for row in rows}

    def boundary(self) -> dict[tuple[str, int], float]:
        """Values at the end of the step: node set and degree of freedom to mm or rad."""
        values: dict[tuple[str, int], float] = {}
        for block in self._all("BOUNDARY"):
            for row in block.data():
                first, last = int(row[1]), int(row[2]) if len(row) > 2 and row[2] else int(row[1])
                for freedom in range(first, last + 1):
                    values[(row[0], freedom)] = float(row[3]) if len(row) > 3 and row[3] else 0.0
        return values

    def density_kg_m3(self, modulus_mpa: float) -> float:
        """Density at a modulus: of the table over the field."""
        rows = [[float(cell) for cell in row] for block in self._all("DENSITY") for row in block.data()]
        if len(rows) < 2 or len(rows[0]) < 2:
            return 1e12 * rows[0][0] if rows else 0.0
        (low, at), (high, to) = rows[0], rows[-1]
        share = 0.0 if to == at else min(max((modulus_mpa - at) / (to - at), 0.0), 1.0)
        return 1e12 * (low + share * (high - low))

    def is_neo_hooke(self) -> bool:
        """Whether strains are so large that the deck's law is neo-Hooke's instead of Hooke's."""
        return any(True for _ in self._all("HYPERELASTIC"))

    def poisson(self) -> float:
        """Poisson's ratio of the first material."""
        row = [
            float(cell) for cell in next(next(self._all("HYPERELASTIC" if self.is_neo_hooke() else "ELASTIC")).data())
        ]
        # Of neo-Hooke's law the first constant is E / (4 (1 + nu)), the field is E.
        return row[2] / (4.0 * row[0]) - 1.0 if self.is_neo_hooke() else row[1]

    def with_materials(self, materials: list[Material]) -> str:
        """The deck's text with these materials in place of its own, and without the field that carried the modulus."""
        text: list[str] = []
        written = False
        for block in self.blocks:
            temperature = block.keyword == "INITIAL CONDITIONS" and block.parameters.get("TYPE") == "TEMPERATURE"
            if not temperature and block.keyword not in _MATERIAL:
                text += block.lines
            elif not written:
                written = True
                text += _written(materials, self.is_neo_hooke())
        return "\n".join(text) + "\n"


def _written(materials: list[Material], neo_hooke: bool) -> list[str]:
    # CalculiX reads 20 characters a number.
    lines = ["** Materials as in the document."]
    for material in materials:
        if material.elements:
            lines.append(f"*ELSET, ELSET={material.element_set}")
            numbers = [str(number) for number in material.elements]
            lines += [",".join(numbers[i : i + 16]) for i in range(0, len(numbers), 16)]
    for material in materials:
        modulus, poisson = material.modulus_mpa, material.poisson
        lines.append(f"*MATERIAL, NAME={material.name}")
        if neo_hooke:
            constants = modulus / (4.0 * (1.0 + poisson)), 6.0 * (1.0 - 2.0 * poisson) / modulus
            lines += ["*HYPERELASTIC, NEO HOOKE", "{:.10g},{:.10g}".format(*constants)]
        else:
            lines += ["*ELASTIC", f"{modulus:.10g},{poisson:.10g}"]
        lines += [
            "*DENSITY",
            f"{1e-12 * material.density_kg_m3:.10g}",
            f"*SOLID SECTION, ELSET={material.element_set}, MATERIAL={material.name}",
        ]
    return lines
