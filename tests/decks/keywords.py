"""Checks a deck against the solver's documentation, and reads it for tests that look inside.

    problems = check_deck(Path("abaqus/graded_shell.inp"))
    deck = parse_deck(text)
    deck.points("MIDLINE-1")

ABAQUS is not free, so this is the nearest thing to its input file processor that every machine can run: the tables
beside this file say which keywords, parameters and values exist and where they may stand, and the other modules check
what the processor or the solver would only notice later, or never (a node without an initial field value silently gets
0). It is stricter than ABAQUS where that helps us: keywords and parameters are spelled out, and names with blanks are
quoted. Files that *INCLUDE names are not followed.
"""

from __future__ import annotations

import mmap
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from . import conditions, semantics
from .blocks import Block, Problem, blocks, buffer, in_parts
from .builder import CHUNK, Builder
from .model import Deck
from .table import Dialect, Placement, data_lines, keyword_line
from .table import dialect as read_table

__all__ = ["Deck", "Problem", "check_deck", "parse_deck"]

REFERENCES = {
    "nset", "elset", "node", "surface", "material", "amplitude", "orientation", "controls", "interaction", "filter",
    "time points", "table", "distribution",
}  # fmt: skip


def check_deck(source: Path | str, dialect: str = "abaqus") -> list[Problem]:
    """All problems of a deck (a path, or the text itself), by line. An empty list: nothing known is wrong.

    ``dialect`` is "abaqus" (default) or "calculix".
    """
    data = buffer(source)
    builder, found = _read(data, read_table(dialect))
    deck = builder.deck
    found += deck.problems
    for check in semantics.CHECKS + conditions.CHECKS:
        found += check(deck)
    return sorted(set(found), key=lambda p: (p.line, p.keyword, p.message))


def parse_deck(source: Path | str, dialect: str = "abaqus") -> Deck:
    """Reads a deck without judging it; what could not be understood is in ``problems`` of the result."""
    data = buffer(source)
    builder = Builder(dialect, in_parts(data))
    for block in blocks(data):
        builder.add(block)
    return builder.deck


def _read(data: bytes | mmap.mmap, rules: Dialect) -> tuple[Builder, list[Problem]]:
    parts = rules.parts and in_parts(data)
    builder, placement = Builder(rules.name, parts), Placement(rules, parts)
    found = list(_lines(data, rules))
    named: list[semantics.Reference] = []
    for block in blocks(data):
        if not block.keyword:
            found += _preamble(block)
            continue
        wrong = [Problem(block.line, block.keyword, message) for message in keyword_line(block, rules)]
        found += wrong
        spec = rules.keywords.get(block.keyword)
        if spec is None or not spec.accepted:
            continue
        found += data_lines(block, rules)
        found += placement.check(block)
        builder.add(block)
        for key in block.params:
            kind = spec.params.get(key)
            name = block.get(key)
            if isinstance(kind, str) and kind in REFERENCES and name:
                named.append((block, kind, name, builder.scope))
    found += placement.finish()
    found += semantics.references(builder.deck, named)
    return builder, found


def _preamble(block: Block) -> Iterator[Problem]:
    for line, _ in block.rows():
        yield Problem(line, "", "data before the first keyword")


def _lines(data: bytes | mmap.mmap, rules: Dialect) -> Iterator[Problem]:
    """Characters and lengths of all lines, on the raw bytes; of foreign characters the first in each stretch."""
    line, start = 1, 0
    long_line = re.compile(rb"^[^\r\n]{%d}" % (rules.line_length + 1), re.MULTILINE)
    while start < len(data):
        stop = data.find(b"\n", start + CHUNK)
        chunk = bytes(data[start : stop + 1 if stop >= 0 else len(data)])
        if not chunk.isascii():
            at = re.search(rb"[\x80-\xff]", chunk).start()
            yield Problem(line + chunk.count(b"\n", 0, at), "", "a character that is not 7-bit ASCII")
        longest = max(map(len, chunk.split(b"\n")))
        for match in long_line.finditer(chunk) if longest > rules.line_length else ():
            at = line + chunk.count(b"\n", 0, match.start())
            yield Problem(at, "", f"the line has more than {rules.line_length} characters")
        line += chunk.count(b"\n")
        start += len(chunk)


def main(arguments: list[str]) -> int:
    """``python -m decks.keywords [--calculix] FILE ...`` prints the problems and returns 1 if there are any."""
    name = "calculix" if "--calculix" in arguments else "abaqus"
    count = 0
    for file in (a for a in arguments if not a.startswith("--")):
        for found in check_deck(Path(file), name):
            print(f"{file}: {found}")
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
