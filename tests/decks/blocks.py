"""Cuts a deck into keyword blocks without touching the numbers in it.

A deck of a million elements is almost only data lines. Keyword lines are found by their stars in the (memory-mapped)
bytes, and data stay byte slices until somebody asks for them: that is what keeps checking fast.
"""

from __future__ import annotations

import mmap
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

STRUCTURE = re.compile(rb"[ \t]*\*[ \t]*(part|assembly)\b", re.IGNORECASE)
COMMENT_LINE = re.compile(rb"^[ \t]*\*\*[^\n]*\n?", re.MULTILINE)


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong: the line (1 is the first), the keyword whose block it is in, and what is wrong."""

    line: int
    keyword: str
    message: str

    def __str__(self) -> str:
        return f"line {self.line}: *{self.keyword}: {self.message}"


@dataclass(frozen=True)
class Param:
    """A parameter's value; ``value`` is None for a bare word. Unquoted text is not case sensitive, quoted text is."""

    value: str | None
    quoted: bool = False


@dataclass
class Block:
    """A keyword line and the data lines below it."""

    line: int
    keyword: str
    params: dict[str, Param]
    data: bytes
    data_line: int
    oddities: list[str] = field(default_factory=list)

    def get(self, key: str) -> str | None:
        """The value of a parameter as a name to compare: unquoted text in capitals; None where absent or bare."""
        param = self.params.get(key)
        return name_of(param) if param and param.value is not None else None

    def has(self, key: str) -> bool:
        return key in self.params

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """Line number and entries of each data line. Entries are stripped; one trailing comma adds no entry."""
        for offset, raw in enumerate(self.data.decode("latin-1").split("\n")):
            text = raw.strip()
            if not text or text.startswith("**"):
                continue
            items = [item.strip() for item in split_commas(text)]
            if len(items) > 1 and not items[-1]:
                items.pop()
            yield self.data_line + offset, items

    def numbers(self) -> bytes:
        """The data without comment lines, blanks around it or carriage returns: ready for bulk conversion."""
        data = self.data.replace(b"\r", b"") if b"\r" in self.data else self.data
        return (COMMENT_LINE.sub(b"", data) if b"**" in data else data).strip()


def name_of(param: Param) -> str:
    return param.value or "" if param.quoted else (param.value or "").upper()


def label(text: str) -> str:
    """A name in a data line: the same convention as a parameter's value."""
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] == '"' else text.upper()


def split_commas(text: str) -> list[str]:
    """Splits at commas that are not inside double quotes."""
    if '"' not in text:
        return text.split(",")
    return re.findall(r'(?:^|(?<=,))((?:"[^"]*"|[^,"])*)(?=,|$)', text)


def buffer(source: Path | str | bytes) -> bytes | mmap.mmap:
    """Bytes of a deck: a path (a Path, or a string without line breaks that names a file) or the text itself."""
    if isinstance(source, bytes):
        return source
    if isinstance(source, Path) or ("\n" not in source and Path(source).is_file()):
        path = Path(source)
        if path.stat().st_size == 0:
            return b""
        with path.open("rb") as stream:
            return mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
    return source.encode("utf-8")


def keyword_lines(data: bytes | mmap.mmap) -> Iterator[tuple[int, int]]:
    """Begin and end of every keyword line. Stars are rare: looking for them is faster than looking at lines."""
    at = data.find(b"*")
    while at >= 0:
        start = data.rfind(b"\n", 0, at) + 1
        end = data.find(b"\n", at)
        end = len(data) if end < 0 else end
        if data[at + 1 : at + 2] != b"*" and not data[start:at].strip():
            yield start, end
        at = data.find(b"*", end)


def in_parts(data: bytes | mmap.mmap) -> bool:
    """Whether a deck is organised in parts and an assembly."""
    return any(STRUCTURE.match(data[start:end]) for start, end in keyword_lines(data))


def blocks(data: bytes | mmap.mmap) -> Iterator[Block]:
    """The deck's blocks in order. What stands before the first keyword is returned as a block with an empty keyword."""
    line, position, pending = 1, 0, None
    for start, end in keyword_lines(data):
        body = data[position:start]
        if pending is not None:
            yield _block(*pending, body)
        elif body.strip():
            yield Block(1, "", {}, body, 1)
        line += body.count(b"\n")
        text, head_line = data[start:end], line
        while text.rstrip().endswith(b",") and end < len(data):
            # A keyword line that ends with a comma goes on in the next line.
            stop = data.find(b"\n", end + 1)
            stop = len(data) if stop < 0 else stop
            text += data[end:stop]
            end = stop
        line += text.count(b"\n") + 1
        position = min(end + 1, len(data))
        pending = (head_line, text, line)
    body = data[position:]
    if pending is not None:
        yield _block(*pending, body)
    elif body.strip():
        yield Block(1, "", {}, body, 1)


def _block(line: int, text: bytes, data_line: int, data: bytes) -> Block:
    parts = split_commas(re.sub(r"\s*\n\s*", "", text.decode("latin-1")).strip()[1:])
    block = Block(line, " ".join(parts[0].upper().split()), {}, data, data_line)
    for part in parts[1:]:
        key, _, value = part.partition("=")
        key, value = " ".join(key.upper().split()), value.strip()
        if not key:
            block.oddities.append("empty parameter (two commas, or one at the end)")
            continue
        if key in block.params:
            block.oddities.append(f"parameter {key} is given twice")
        quoted = len(value) > 1 and value[0] == value[-1] == '"'
        if '"' in value[1:-1] or (not quoted and '"' in value):
            block.oddities.append(f"unbalanced quotation marks in {key}={value}")
        block.params[key] = Param((value[1:-1] if quoted else value) if "=" in part else None, quoted)
    return block
