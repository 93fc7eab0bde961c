"""The page: sections of text, tables and pictures."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from .program import ROOT

PAGE = ROOT / "docs" / "reproduction.md"
PICTURES = ROOT / "docs" / "images" / "paper"
HEAD = """\
# The paper beside us

What Kansara, Liu, He and Tan, *Inverse design and additive manufacturing of shape-morphing structures based on functionally graded
composites*, J. Mech. Phys. Solids 180 (2023) 105382, states, what {version} computes, from which model, and why the two differ
where they do. `scripts/reproduce` computes everything again and writes this page; the inputs are in
[examples/paper](../examples/paper) and beside it.

The paper gives most results as curves. Here stands what it states in words and numbers, by subject; curves are not read off. The page was
made from a summary of the paper, its first page and its published scripts: numbers that stand in its figures alone are missing.
"""


@dataclass
class Picture:
    """An SVG file beside the page."""

    name: str
    svg: str
    caption: str


@dataclass
class Section:
    """A part of the page."""

    title: str
    stated: str
    header: list[str]
    rows: list[list[str]]
    model: str
    difference: str
    pictures: list[Picture] = field(default_factory=list)
    more: str = ""

    def text(self) -> str:
        """As Markdown."""
        lines = [f"## {self.title}", "", f"**The paper:** {self.stated}", "", f"**Here:** {self.model}", ""]
        if self.rows:
            lines += [row(self.header), row(["---"] * len(self.header)), *[row(r) for r in self.rows], ""]
        lines += [f"**Difference:** {self.difference}", ""]
        if self.more:
            lines += [self.more.strip(), ""]
        for picture in self.pictures:
            lines += [f"![{picture.caption}](images/paper/{picture.name}.svg)", "", f"*{picture.caption}*", ""]
        return "\n".join(lines)


def row(cells: list[str]) -> str:
    """A line of a table."""
    return "| " + " | ".join(cells) + " |"


def text(sections: list[Section], version: str) -> str:
    """The page."""
    return "\n".join([HEAD.format(version=version), *[s.text() for s in sections]]).rstrip() + "\n"


def write(sections: list[Section], content: str) -> None:
    """Writes the page and its pictures; pictures that are no longer shown go."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    shown = {f"{p.name}.svg": p.svg for s in sections for p in s.pictures}
    for old in PICTURES.glob("*.svg"):
        if old.name not in shown:
            old.unlink()
    for name, svg in shown.items():
        (PICTURES / name).write_text(standing_alone(svg))
    PAGE.write_text(content)


def standing_alone(svg: str) -> str:
    """An SVG that a browser shows by itself, on white."""
    if "xmlns=" not in svg[:300]:
        svg = svg.replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"', 1)
        svg = re.sub(r"(<svg[^>]*>)", r'\1<rect width="100%" height="100%" fill="#fff"/>', svg, count=1)
    return svg if svg.endswith("\n") else svg + "\n"


def read(path: Path) -> str:
    """A picture that the program wrote."""
    return path.read_text()


def number(value: float, digits: int = 3) -> str:
    """A figure with so many digits."""
    return f"{value:.{digits}g}" if value else "0"


def percent(value: float) -> str:
    """A share of the length."""
    return f"{value:.3f} %"
