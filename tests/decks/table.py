"""The keyword tables, and the checks that need one block and its neighbours: spelling, values, place, data lines."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from .blocks import Block, Param, Problem

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10: pytest itself brings tomli there
    import tomli as tomllib

FILES = {"abaqus": ("abaqus_keywords.toml", "abaqus_history.toml"), "calculix": ("calculix_keywords.toml",)}
OPENS = {"PART": "part", "ASSEMBLY": "assembly", "INSTANCE": "instance", "STEP": "step"}
BULK = {"NODE", "ELEMENT", "INITIAL CONDITIONS"}  # their data are read by the model, in bulk


@dataclass(frozen=True)
class Spec:
    """One keyword of a table; see the head of abaqus_keywords.toml."""

    source: str
    kind: tuple[str, ...]
    level: tuple[str, ...]
    params: dict[str, str | list[str]] = field(default_factory=dict)
    required: tuple[str, ...] = ()
    one_of: tuple = ()
    exclusive: tuple = ()
    within: tuple[str, ...] = ()
    then: tuple[str, ...] = ()
    data: str = "any"
    lines: tuple[int, int] | None = None
    items: tuple[int, int] | None = None
    numeric: bool = False

    @property
    def accepted(self) -> bool:
        return self.source != "not found"


@dataclass(frozen=True)
class Dialect:
    """A solver's rules: its keywords and the limits of its lines."""

    name: str
    keywords: dict[str, Spec]
    line_length: int
    item_length: int
    parts: bool


@lru_cache
def dialect(name: str) -> Dialect:
    """Reads the table of a solver, "abaqus" or "calculix"."""
    raw: dict = {}
    for file in FILES[name]:
        raw |= tomllib.loads((Path(__file__).parent / file).read_text("utf-8"))
    limits = raw.pop("_dialect")
    return Dialect(name, {keyword: Spec(**columns) for keyword, columns in raw.items()}, **limits)


def numeric(text: str) -> bool:
    try:
        float(text.upper().replace("D", "E"))
    except ValueError:
        return False
    return True


def name_fault(value: str, quoted: bool, rules: Dialect) -> str | None:
    """What is wrong with a name that a keyword line defines, or None.

    ABAQUS drops blanks from unquoted names, so a name with a blank would silently be another name.
    """
    if not value:
        return "the name is empty"
    if len(value) > 80:
        return f"the name {value[:20]}... has {len(value)} characters, at most 80 are allowed"
    if value.startswith("__") and value.endswith("__"):
        return f"names like {value} are reserved for ABAQUS itself"
    if quoted and rules.parts:
        return None
    if quoted:
        return f"CalculiX knows no quoted names ({value})"
    if any(c.isspace() for c in value):
        return f"the name {value} holds a blank: quote it"
    if rules.parts and not value[0].isalpha():
        return f"the name {value} must start with a letter"
    if rules.parts and "." in value:
        return f"the name {value} holds a period, which separates instance and name"
    return None


def keyword_line(block: Block, rules: Dialect) -> Iterator[str]:
    """Problems of the keyword line alone."""
    spec = rules.keywords.get(block.keyword)
    if spec is None or not spec.accepted:
        known = [k for k, s in rules.keywords.items() if s.accepted]
        near = [k for k in known if block.keyword and k.startswith(block.keyword)] or difflib.get_close_matches(
            block.keyword, known, 1
        )
        yield "unknown keyword" + (f"; *{near[0]} is meant?" if near else "")
        return
    yield from block.oddities
    for key, param in block.params.items():
        kind = spec.params.get(key)
        if kind is None:
            near = [k for k in spec.params if k.startswith(key)] or difflib.get_close_matches(key, spec.params, 1)
            yield f"unknown parameter {key}" + (f"; {near[0]} is meant?" if near else "")
        else:
            yield from _value(key, param, kind, rules)
    for key in spec.required:
        if key not in block.params:
            yield f"required parameter {key} is missing"
    for group in spec.one_of:
        if not any(key in block.params for key in group):
            yield "one of these parameters is required: " + ", ".join(group)
    for group in spec.exclusive:
        found = [key for key in group if key in block.params]
        if len(found) > 1:
            yield "these parameters exclude each other: " + ", ".join(found)


def _value(key: str, param: Param, kind: str | list[str], rules: Dialect) -> Iterator[str]:
    if isinstance(kind, list):
        value = " ".join((param.value or "").upper().split())
        if value not in kind:
            yield f"{key}={value} is not one of " + ", ".join(v or "(no value)" for v in kind)
    elif kind == "flag":
        if param.value is not None:
            yield f"parameter {key} takes no value"
    elif kind == "any?":
        return
    elif not param.value:
        yield f"parameter {key} needs a value"
    elif kind == "int":
        if not param.value.lstrip("+-").isdigit():
            yield f"{key}={param.value} is not a whole number"
    elif kind == "float":
        if not numeric(param.value):
            yield f"{key}={param.value} is not a number"
    elif kind == "label":
        fault = name_fault(param.value, param.quoted, rules)
        if fault:
            yield fault
    elif kind != "any" and not param.quoted and any(c.isspace() for c in param.value):
        yield f"the name {param.value} holds a blank: quote it"


def data_lines(block: Block, rules: Dialect) -> Iterator[Problem]:
    """Problems of the data lines that the table can express."""
    spec = rules.keywords[block.keyword]
    if spec.data == "some" and not block.data.strip() and not (block.has("INPUT") or block.has("FILE")):
        yield Problem(block.line, block.keyword, "data lines are missing")
    if block.keyword in BULK or not (spec.items or spec.lines or spec.numeric or spec.data == "none"):
        return
    if block.keyword in ("NSET", "ELSET") and not _too_long(block.data):
        return
    count = 0
    for line, items in block.rows():
        count += 1
        if spec.items and not spec.items[0] <= len(items) <= spec.items[1]:
            limit = f"at least {spec.items[0]}" if len(items) < spec.items[0] else f"at most {spec.items[1]}"
            yield Problem(line, block.keyword, f"{len(items)} entries in a data line, {limit} are allowed")
        bad = [item for item in items if item and not numeric(item)] if spec.numeric else []
        if bad:
            yield Problem(line, block.keyword, f"{bad[0]} is not a number")
    if spec.data == "none" and count:
        yield Problem(block.data_line, block.keyword, "takes no data lines")
    if spec.lines and not spec.lines[0] <= count <= spec.lines[1]:
        yield Problem(block.line, block.keyword, f"{count} data lines, {spec.lines[0]} to {spec.lines[1]} are allowed")


def _too_long(data: bytes) -> bool:
    """Whether any line may hold more than 16 entries: counted on the commas alone, which is fast for long sets."""
    commas = data.translate(None, bytes(c for c in range(256) if c not in b",\n"))
    return b"," * 16 in commas


class Placement:
    """Follows nesting: parts, instances, assembly and steps, groups of keywords, model data before history data."""

    def __init__(self, rules: Dialect, in_parts: bool):
        self.rules, self.in_parts = rules, in_parts
        self.stack: list[tuple[str, Block]] = []
        self.group: str | None = None
        self.previous: Block | None = None
        self.steps = 0

    def check(self, block: Block) -> Iterator[Problem]:
        def bad(message: str, at: Block = block) -> Problem:
            return Problem(at.line, at.keyword, message)

        spec = self.rules.keywords.get(block.keyword)
        if spec is None:
            return
        before, self.previous = self.previous, block
        then = self.rules.keywords[before.keyword].then if before and before.keyword in self.rules.keywords else ()
        if then and block.keyword not in then:
            yield bad("must be followed at once by *" + " or *".join(then), before)
        if spec.within and self.group not in spec.within:
            yield bad("belongs below *" + " or *".join(spec.within))
        if not spec.within:
            self.group = block.keyword
        here = self.stack[-1][0] if self.stack else "model"
        if here == "step" and "history" not in spec.kind:
            yield bad("is model data and stands inside a step")
        elif here != "step" and block.keyword != "STEP" and "model" not in spec.kind:
            yield bad("is history data and stands outside a step")
        elif here not in spec.level and (self.in_parts or not {"part", "instance", "assembly"} & set(spec.level)):
            yield bad(f"stands at {here} level, allowed: " + ", ".join(spec.level))
        elif self.steps and here == "model" and block.keyword != "STEP":
            yield bad("stands after the first step, where only steps are allowed")
        yield from self._nest(block, bad)

    def _nest(self, block: Block, bad) -> Iterator[Problem]:
        if block.keyword in OPENS:
            self.steps += block.keyword == "STEP"
            self.stack.append((OPENS[block.keyword], block))
        elif block.keyword.startswith("END "):
            if self.stack and self.stack[-1][0] == block.keyword[4:].lower():
                self.stack.pop()
            else:
                yield bad("closes nothing that is open")

    def finish(self) -> Iterator[Problem]:
        for _, block in self.stack:
            yield Problem(block.line, block.keyword, f"is never closed by *END {block.keyword}")
        spec = self.rules.keywords.get(self.previous.keyword) if self.previous else None
        if spec and spec.then:
            yield Problem(
                self.previous.line, self.previous.keyword, "must be followed at once by *" + " or *".join(spec.then)
            )
        if not self.steps:
            yield Problem(1, "STEP", "the deck has no step")
