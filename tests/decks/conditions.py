"""Materials, amplitudes, boundary conditions, steps and output requests: the numbers in their data lines."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from .blocks import Block, Problem
from .model import Deck, Material, Step
from .semantics import problem
from .table import numeric

TYPES_OF_SUPPORT = {"XSYMM", "YSYMM", "ZSYMM", "XASYMM", "YASYMM", "ZASYMM", "ENCASTRE", "PINNED"}


THERMAL = {"HEAT TRANSFER", "COUPLED THERMAL-ELECTRICAL"}


def materials(deck: Deck) -> Iterator[Problem]:
    """Every material is elastic, with sane constants in tables that ascend; explicit steps need densities.

    Where nothing but heat and current is solved for, it conducts instead.
    """
    procedures = {step.procedure.keyword for step in deck.steps if step.procedure}
    if procedures and procedures <= THERMAL:
        yield from _conducting(deck, procedures)
        return
    explicit = any(step.explicit for step in deck.steps)
    for material in deck.materials.values():
        if "HYPERELASTIC" in material.options:
            yield from _hyperelastic(material)
        elif "ELASTIC" not in material.options:
            yield problem(material.block, "has no *ELASTIC")
        else:
            yield from _elastic(material)
        if explicit and "DENSITY" not in material.options:
            yield problem(material.block, "has no *DENSITY, which *DYNAMIC, EXPLICIT needs")


def _conducting(deck: Deck, procedures: set[str]) -> Iterator[Problem]:
    """Conductivities are positive; transient heat needs densities and specific heats."""
    needed = ["CONDUCTIVITY"]
    if "COUPLED THERMAL-ELECTRICAL" in procedures:
        needed.append("ELECTRICAL CONDUCTIVITY")
    if any(step.procedure and not step.procedure.has("STEADY STATE") for step in deck.steps):
        needed += ["DENSITY", "SPECIFIC HEAT"]
    for material in deck.materials.values():
        for option in needed:
            block = material.options.get(option)
            if block is None:
                yield problem(material.block, f"has no *{option}")
                continue
            for line, items in block.rows():
                if not numeric(items[0]) or float(items[0]) <= 0:
                    yield problem(block, f"{items[0]} is not a positive number", line)


def _elastic(material: Material) -> Iterator[Problem]:
    block = material.options["ELASTIC"]
    if block.get("TYPE") not in (None, "ISOTROPIC", "ISO") or material.fields > 5:
        return
    last = None
    rows = list(block.rows())
    for line, items in rows:
        wanted = (3 + material.fields,) if material.fields else ((2, 3) if len(rows) == 1 else (3,))
        if len(items) not in wanted:
            names = "modulus, Poisson's ratio, temperature" + ", field" * material.fields
            yield problem(block, f"{len(items)} entries, these are needed: {names}", line)
            continue
        if not numeric(items[0]) or float(items[0]) <= 0:
            yield problem(block, f"the modulus {items[0]} is not a positive number", line)
        if not numeric(items[1]) or not -1 < float(items[1]) < 0.5:
            yield problem(block, f"Poisson's ratio {items[1]} is not between -1 and 0.5", line)
        if material.fields == 1 or (not material.fields and len(rows) > 1):
            value = items[-1]
            if not numeric(value):
                yield problem(block, "the field's value is missing" if material.fields else "no temperature", line)
            elif last is not None and float(value) <= last:
                yield problem(block, f"the table must ascend, {value} follows {last}", line)
            last = float(value) if numeric(value) else last


def _hyperelastic(material: Material) -> Iterator[Problem]:
    """A neo-Hookean table: C10, D1 and, where it has several rows, a temperature that ascends."""
    block = material.options["HYPERELASTIC"]
    rows = list(block.rows())
    for line, items in rows:
        if len(items) != (2 if len(rows) == 1 else 3) and len(items) != 3:
            yield problem(block, f"{len(items)} entries, these are needed: C10, D1, temperature", line)
        elif not all(map(numeric, items)) or float(items[0]) <= 0 or float(items[1]) <= 0:
            yield problem(block, f"C10 and D1 must be positive numbers, not {items[0]} and {items[1]}", line)
    temperatures = [float(items[2]) for _, items in rows if len(items) == 3 and numeric(items[2])]
    if any(b <= a for a, b in itertools.pairwise(temperatures)):
        yield problem(block, "the table must ascend")


def amplitudes(deck: Deck) -> Iterator[Problem]:
    """Times of a table ascend; ABAQUS wants one pair a line, or four in every line but the last."""
    for block in deck.amplitudes.values():
        if block.get("DEFINITION") not in (None, "TABULAR", "SMOOTH STEP") or block.has("INPUT") or block.has("USER"):
            continue
        rows = [(line, items) for line, items in block.rows() if all(map(numeric, items))]
        sizes = [len(items) for _, items in rows]
        if any(size % 2 for size in sizes):
            yield problem(block, "times and values come in pairs", next(ln for ln, items in rows if len(items) % 2))
            continue
        if deck.dialect == "abaqus" and set(sizes) != {2} and any(size != 8 for size in sizes[:-1]):
            yield problem(block, "each line holds one pair, or each but the last holds four")
        times = [(line, float(t)) for line, items in rows for t in items[::2]]
        if len(times) < 2:
            yield problem(block, "fewer than two pairs")
        for (_, before), (line, after) in itertools.pairwise(times):
            if after <= before:
                yield problem(block, f"times must ascend, {after} follows {before}", line)


def boundaries(deck: Deck) -> Iterator[Problem]:
    """Degrees of freedom exist; model data fix only; an explicit step needs an amplitude for every displacement."""
    for block in deck.boundaries:
        if block.params and deck.dialect == "abaqus":
            yield problem(block, "takes no parameters in the model data")
        for line, items in block.rows():
            yield from _dofs(block, line, items, in_step=False)
    for step in deck.steps:
        for block in step.blocks:
            if block.keyword == "CLOAD":
                for line, items in block.rows():
                    yield from _dofs(block, line, [items[0], *items[1:2]], in_step=True)
            if block.keyword != "BOUNDARY":
                continue
            for line, items in block.rows():
                yield from _dofs(block, line, items, in_step=True)
                moves = len(items) > 3 and numeric(items[3]) and float(items[3]) != 0
                jump = step.explicit and not block.has("AMPLITUDE") and block.get("TYPE") in (None, "DISPLACEMENT")
                if moves and jump:
                    yield problem(block, "a displacement without an amplitude is ignored by ABAQUS/Explicit", line)


def _dofs(block: Block, line: int, items: list[str], in_step: bool) -> Iterator[Problem]:
    if len(items) > 1 and items[1].upper() in TYPES_OF_SUPPORT:
        if in_step:
            yield problem(block, f"{items[1]} may be used in the model data only", line)
        return
    dofs = [item for item in items[1:3] if item]
    if not dofs or not all(item.isdigit() and (1 <= int(item) <= 6 or item in ("8", "9", "11")) for item in dofs):
        yield problem(block, f"no degree of freedom: {', '.join(items[1:3])}", line)
    elif int(dofs[-1]) < int(dofs[0]):
        yield problem(block, f"the last degree of freedom, {dofs[-1]}, is below the first, {dofs[0]}", line)
    if len(items) > 3 and not numeric(items[3]):
        yield problem(block, f"{items[3]} is not a number", line)
    elif len(items) > 3 and not in_step and float(items[3]) != 0:
        yield problem(block, "only zero values may be prescribed in the model data", line)


def transforms(deck: Deck) -> Iterator[Problem]:
    """The points of a local system span a plane (TYPE=R) or an axis."""
    for scope in deck.scopes():
        for block in scope.transforms:
            for line, items in block.rows():
                if len(items) != 6 or not all(map(numeric, items)):
                    continue
                a, b = [float(v) for v in items[:3]], [float(v) for v in items[3:]]
                cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
                if (block.get("TYPE") in (None, "R") and not any(cross)) or a == b:
                    yield problem(block, "the two points give no local system", line)
        for block in scope.orientations.values():
            rows = list(block.rows())
            if block.get("DEFINITION") not in (None, "COORDINATES") or block.get("SYSTEM") == "USER":
                continue
            if not rows or len(rows[0][1]) not in (6, 9) or not all(map(numeric, rows[0][1])):
                yield problem(block, "the first data line gives points a and b, six numbers (and an origin, nine)")


def steps(deck: Deck) -> Iterator[Problem]:
    """A step has one procedure with a sensible data line, and its history output names sets."""
    seen: set[str] = set()
    for step in deck.steps:
        name = step.block.get("NAME")
        if name in seen:
            yield problem(step.block, f"{name} is defined twice")
        seen |= {name} if name else set()
        if step.procedure is None:
            yield problem(step.block, "has no procedure, such as *STATIC")
        elif step.procedure.keyword in THERMAL | {"STATIC"}:
            yield from _increments(step.procedure)
        yield from _output(step)


def _increments(block: Block) -> Iterator[Problem]:
    for line, items in list(block.rows())[:1]:
        if not all(numeric(item) for item in items if item):
            yield problem(block, "not a number", line)
            continue
        first, total, least, most = ([float(i) if i else None for i in items] + [None] * 4)[:4]
        if first is not None and total is not None and first > total:
            yield problem(block, f"the first increment, {first}, exceeds the step, {total}", line)
        if block.has("RIKS"):
            continue
        if first is not None and least is not None and least > first:
            yield problem(block, f"the least increment, {least}, exceeds the first, {first}", line)
        if first is not None and most is not None and most < first:
            yield problem(block, f"the largest increment, {most}, is below the first, {first}", line)


def _output(step: Step) -> Iterator[Problem]:
    history = False
    for block in step.blocks:
        if block.keyword == "OUTPUT":
            history = block.has("HISTORY")
        elif block.keyword == "NODE OUTPUT" and history and not (block.has("NSET") or block.has("TRACER SET")):
            yield problem(block, "history output of nodes needs NSET")
        elif block.keyword == "ELEMENT OUTPUT" and history and not (block.has("ELSET") or block.has("TRACER SET")):
            yield problem(block, "history output of elements needs ELSET")
        elif block.keyword == "ENERGY OUTPUT" and not history:
            yield problem(block, "belongs below *OUTPUT, HISTORY")
        if block.keyword in ("NODE OUTPUT", "ELEMENT OUTPUT") and not block.has("VARIABLE") and not block.data.strip():
            yield problem(block, "names no variable")


CHECKS = (materials, amplitudes, boundaries, transforms, steps)
