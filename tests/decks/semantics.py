"""What must hold across a deck: names resolve, elements have sections, nodes have values, constraints agree."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from .blocks import Block, Problem, label
from .elements import TYPES
from .model import Deck, Ref, Scope
from .table import numeric

Reference = tuple[Block, str, str, Scope]  # block, kind of thing, its name, where it is named
BUILT_IN = {"ANTIALIASING"}  # a filter that needs no definition
LOCAL = {"surface": "surfaces", "orientation": "orientations"}


def problem(block: Block, message: str, line: int | None = None) -> Problem:
    return Problem(block.line if line is None else line, block.keyword, message)


def some(values: Iterable, count: int) -> str:
    """The beginning of a list, for messages about many nodes or elements."""
    shown = [v if isinstance(v, int) else ".".join(str(x) for x in v if x is not None) for v in sorted(values, key=str)]
    return ", ".join(map(str, shown[:count])) + (", ..." if len(shown) > count else "")


def references(deck: Deck, wanted: list[Reference]) -> Iterator[Problem]:
    """Everything a keyword line names must be defined somewhere in the deck."""
    for block, kind, name, scope in wanted:
        if kind in ("nset", "node"):
            found = deck.refs(name, "nsets", scope)
            if found is None:
                yield problem(block, f"node set {name} is not defined" if not name.isdigit() else f"no node {name}")
            elif kind == "node" and len(found) != 1:
                yield problem(block, f"node set {name} has {len(found)} nodes, one is needed")
        elif kind == "elset":
            if deck.refs(name, "elsets", scope) is None:
                yield problem(block, f"element set {name} is not defined")
        elif kind in LOCAL:
            owner, _, local = deck.split(name, scope)
            if owner is None or local not in getattr(owner, LOCAL[kind]):
                yield problem(block, f"{kind} {name} is not defined")
        elif kind in ("material", "amplitude"):
            if name not in getattr(deck, kind + "s"):
                yield problem(block, f"{kind} {name} is not defined")
        elif kind not in ("part", "instance") and name not in BUILT_IN and name not in deck.named.get(kind, {}):
            yield problem(block, f"{kind} {name} is not defined")


def data_references(deck: Deck) -> Iterator[Problem]:
    """Names in data lines: nodes of loads, surfaces of ties and contact, sets that surfaces are made of."""
    for block in [b for step in deck.steps for b in step.blocks] + deck.boundaries:
        if block.keyword in ("BOUNDARY", "CLOAD", "TEMPERATURE", "FIELD"):
            yield from _rows(deck, block, "nsets", "node set", deck.root, 1)
        elif block.keyword == "DLOAD":
            yield from _rows(deck, block, "elsets", "element set", deck.root, 1)
        elif block.keyword == "DSECURRENT":
            for line, items in block.rows():
                owner, _, local = deck.split(label(items[0]), deck.root)
                if owner is None or local not in owner.surfaces:
                    yield problem(block, f"surface {items[0]} is not defined", line)
    for scope in deck.scopes():
        for block in scope.surfaces.values():
            if block.get("TYPE") == "NODE":
                yield from _rows(deck, block, "nsets", "node set", scope, 1)
            elif block.get("TYPE") in (None, "ELEMENT") and not (block.has("COMBINE") or block.has("CROP")):
                yield from _rows(deck, block, "elsets", "element set", scope, 1)
                yield from _faces(deck, block, scope)
    pairs = [(block, scope) for block, scope in deck.constraints if block.keyword == "TIE"]
    for block, scope in pairs + [(block, deck.root) for block, _ in deck.contacts]:
        for line, items in block.rows():
            for name in items[:2]:
                owner, _, local = deck.split(label(name), scope)
                if name and (owner is None or local not in owner.surfaces):
                    yield problem(block, f"surface {name} is not defined", line)


def contacts(deck: Deck) -> Iterator[Problem]:
    """Contact pairs are model data in ABAQUS/Standard and history data in ABAQUS/Explicit; properties exist."""
    explicit = any(step.explicit for step in deck.steps)
    for block, in_step in deck.contacts:
        if block.keyword == "CONTACT PAIR" and deck.dialect == "abaqus":
            if explicit != in_step:
                where = "a step, for ABAQUS/Explicit" if explicit else "the model data, for ABAQUS/Standard"
                yield problem(block, f"belongs into {where}")
            if not explicit and not block.has("INTERACTION"):
                yield problem(block, "required parameter INTERACTION is missing")
        if block.keyword == "CONTACT PROPERTY ASSIGNMENT":
            for line, items in block.rows():
                if items[2:] and label(items[2]) not in deck.named.get("interaction", {}):
                    yield problem(block, f"interaction {items[2]} is not defined", line)


def joined_names(deck: Deck) -> Iterator[Problem]:
    """ABAQUS itself calls the sets of an instance INSTANCE_SET, so no set of the assembly may bear such a name."""
    for kind in ("nsets", "elsets"):
        for name, found in getattr(deck.root, kind).items():
            for instance in deck.instances.values():
                if name.startswith(instance.name + "_") and name[len(instance.name) + 1 :] in getattr(
                    instance.part, kind
                ):
                    yield Problem(
                        found.line, kind[:-1].upper(), f"{name} is ABAQUS's own name for a set of {instance.name}"
                    )


def _rows(deck: Deck, block: Block, kind: str, thing: str, scope: Scope, count: int) -> Iterator[Problem]:
    for line, items in block.rows():
        for name in items[:count]:
            if name and deck.refs(label(name), kind, scope) is None:
                yield problem(block, f"{thing} {name} is not defined", line)


def _faces(deck: Deck, block: Block, scope: Scope) -> Iterator[Problem]:
    for line, items in block.rows():
        face = items[1].upper() if len(items) > 1 else ""
        members = deck.refs(label(items[0]), "elsets", scope) or []
        for at in {at for at, _ in members} if face else ():
            owner, wanted = (scope if at is None else deck.owner(at)), {n for a, n in members if a == at}
            for element_block in owner.elements:
                kind = TYPES.get(element_block.type)
                if kind and face not in kind.faces and wanted.intersection(element_block.ids()):
                    yield problem(block, f"{element_block.type} has no face {face}", line)


def sections(deck: Deck) -> Iterator[Problem]:
    """Every element has exactly one section of its kind (rigid elements: a rigid body)."""
    for scope in deck.scopes():
        if scope.kind == "assembly":
            continue
        covered: dict[str, set[int]] = defaultdict(set)
        for block in scope.sections:
            found = scope.elsets.get(block.get("ELSET") or "")
            members = set(found.members) if found else set()
            twice = members & (covered["SOLID SECTION"] | covered["SHELL SECTION"])
            if twice:
                yield problem(block, f"{len(twice)} elements already have a section: {some(twice, 3)}")
            covered[block.keyword] |= members
            if block.keyword == "SHELL SECTION":
                yield from _shell(block)
        for block, at in deck.constraints:
            if block.keyword == "RIGID BODY" and block.has("ELSET"):
                for instance, number in deck.refs(block.get("ELSET") or "", "elsets", at) or ():
                    if at is scope or deck.owner(instance) is scope:
                        covered["RIGID BODY"].add(number)
        for element_block in scope.elements:
            kind = TYPES.get(element_block.type)
            ids = set(element_block.ids())
            lacking = ids - covered[kind.section] if kind else set()
            if lacking:
                where = f" in part {scope.name}" if scope.name else ""
                message = (
                    f"{len(lacking)} {element_block.type} elements{where} have no *{kind.section}: {some(lacking, 3)}"
                )
                yield Problem(element_block.line, "ELEMENT", message)


def _shell(block: Block) -> Iterator[Problem]:
    if block.has("COMPOSITE") or block.has("NODAL THICKNESS") or block.has("SHELL THICKNESS"):
        return
    rows = list(block.rows())
    if len(rows) != 1:
        yield problem(block, "one data line is needed: thickness, number of integration points")
        return
    line, items = rows[0]
    if not numeric(items[0]) or float(items[0]) <= 0:
        yield problem(block, f"the thickness {items[0]} is not a positive number", line)
    points = items[1] if len(items) > 1 else ""
    simpson = points and block.get("SECTION INTEGRATION") != "GAUSS"
    if simpson and (not points.isdigit() or int(points) < 3 or int(points) % 2 == 0):
        yield problem(block, f"{points} integration points: Simpson's rule takes an odd number from three on", line)


def initial_values(deck: Deck) -> Iterator[Problem]:
    """Nodes of materials that depend on a field or on temperature have an initial value: the solver assumes 0."""
    given: dict[str, dict[str | None, set[int]]] = defaultdict(lambda: defaultdict(set))
    for block in deck.initial:
        kind = block.get("TYPE")
        if kind in ("FIELD", "TEMPERATURE") and not (block.has("FILE") or block.has("INPUT") or block.has("USER")):
            key = f"FIELD {block.get('VARIABLE') or 1}" if kind == "FIELD" else kind
            yield from _given(deck, block, given[key])
    for scope in deck.scopes():
        for block in scope.sections:
            material = deck.materials.get(block.get("MATERIAL") or "")
            found = scope.elsets.get(block.get("ELSET") or "")
            keys = [f"FIELD {n + 1}" for n in range(material.all_fields)] if material else []
            keys += ["TEMPERATURE"] if material and material.needs_temperature else []
            nodes = scope.element_nodes(set(found.members)) if found and keys else set()
            for key in keys:
                for instance in deck.instances_of(scope):
                    missing = nodes - given[key][instance]
                    if missing:
                        shown = some([(instance, n) for n in missing], 3)
                        yield problem(block, f"{len(missing)} nodes have no initial {key.lower()}: {shown}")


def _given(deck: Deck, block: Block, found: dict[str | None, set[int]]) -> Iterator[Problem]:
    names: set[str] = set()
    flat = block.numbers().replace(b"\n", b",").split(b",")
    plain = block.data.count(b",") == block.data.strip().count(b"\n") + 1
    try:  # number, value in every line
        numbers = set(map(int, flat[::2])) if plain else set()
        plain = plain and len(list(map(float, flat[1::2]))) == len(flat[::2])
    except ValueError:
        plain = False
    if plain:
        found[None] |= numbers
    for offset, raw in () if plain else enumerate(block.data.split(b"\n")):
        if not raw.strip() or raw.lstrip().startswith(b"**"):
            continue
        name, _, value = raw.partition(b",")
        name = name.strip()
        if name.isdigit():
            found[None].add(int(name))
        else:
            head, dot, tail = name.rpartition(b".")
            if dot and tail.isdigit():
                found[head.decode("latin-1").upper()].add(int(tail))
            else:
                names.add(label(name.decode("latin-1")))
        try:
            float(value.split(b",", 1)[0])
        except ValueError:
            yield problem(block, f"no number in {raw.decode('latin-1')!r}", block.data_line + offset)
    for name in names:
        refs = deck.refs(name)
        if refs is None:
            yield problem(block, f"node set {name} is not defined")
        for instance, number in refs or ():
            found[instance].add(number)
    for instance, numbers in found.items():
        owner = deck.owner(instance)
        unknown = numbers - owner.node_ids if owner else numbers
        if unknown:
            yield problem(block, f"no such nodes: {some([(instance, n) for n in unknown], 3)}")


def expand(deck: Deck, refs: Iterable[Ref], scope: Scope) -> set[Ref]:
    """Nodes named inside a part stand for those of all its instances."""
    if scope is deck.root:
        return set(refs)
    return {(instance, n) for instance in deck.instances_of(scope) for _, n in refs}


def dependent_nodes(deck: Deck, block: Block, scope: Scope) -> set[Ref]:
    """Nodes whose motion a coupling or a rigid body prescribes."""
    nodes: set[Ref] = set()
    if block.keyword == "COUPLING":
        nodes |= deck.surface_nodes(block.get("SURFACE") or "", scope)
    elif block.keyword == "RIGID BODY":
        for key in ("TIE NSET", "PIN NSET", "NSET"):
            nodes |= set(deck.refs(block.get(key) or "", "nsets", scope) or ())
        if block.has("ELSET"):
            members = deck.refs(block.get("ELSET") or "", "elsets", scope) or []
            for at in {at for at, _ in members}:
                owner = scope if at is None else deck.owner(at)
                nodes |= {(at, n) for n in owner.element_nodes({n for a, n in members if a == at})}
    return nodes - set(deck.refs(block.get("REF NODE") or "", "nsets", scope) or ())


def constraints(deck: Deck) -> Iterator[Problem]:
    """A node follows one rigid body or coupling only, and an equation's first term is free of other conditions."""
    owner: dict[Ref, Block] = {}
    for block, scope in deck.constraints:
        nodes = expand(deck, dependent_nodes(deck, block, scope), scope)
        if block.keyword in ("COUPLING", "RIGID BODY") and not nodes and not block.has("ANALYTICAL SURFACE"):
            yield problem(block, "constrains no node")
        twice = {ref for ref in nodes if ref in owner}
        if twice:
            first = owner[next(iter(twice))]
            message = f"{len(twice)} nodes already follow *{first.keyword} of line {first.line}: {some(twice, 3)}"
            yield problem(block, message)
        owner.update(dict.fromkeys(nodes, block))
    fixed = _prescribed(deck)
    gone: dict[tuple[Ref, int], int] = {}
    explicit = any(step.explicit for step in deck.steps)
    for block, scope in deck.constraints:
        if block.keyword != "EQUATION":
            continue
        for line, terms in equations(block):
            yield from _terms(deck, block, scope, line, terms)
            sets = [(expand(deck, deck.refs(n, "nsets", scope) or (), scope), dof, value) for n, dof, value in terms]
            for refs, dof, _ in sets:
                used = {ref for ref in refs if (ref, dof) in gone}
                if used and not explicit:
                    yield problem(block, f"dof {dof} of {some(used, 1)} was eliminated by an earlier equation", line)
            for ref in sets[0][0] if sets and not explicit else ():
                gone[ref, sets[0][1]] = line
                if (ref, sets[0][1]) in fixed:
                    yield problem(
                        block, f"the first term, dof {sets[0][1]} of {some([ref], 1)}, is prescribed too", line
                    )
                if ref in owner:
                    yield problem(
                        block, f"the first term's node {some([ref], 1)} follows a rigid body or coupling", line
                    )


def equations(block: Block) -> Iterator[tuple[int, list[tuple[str, int, float]]]]:
    """Line and terms (node or set, dof, coefficient) of each equation; a malformed one has no terms."""
    rows = list(block.rows())
    while rows:
        line, items = rows.pop(0)
        count = int(items[0]) if len(items) == 1 and items[0].isdigit() else 0
        flat: list[str] = []
        while count and len(flat) < 3 * count and rows:
            flat += rows.pop(0)[1]
        triples = [flat[i : i + 3] for i in range(0, len(flat), 3)]
        good = len(flat) == 3 * count and all(t[1].isdigit() and numeric(t[2]) for t in triples)
        yield line, [(label(t[0]), int(t[1]), float(t[2])) for t in triples] if good else []


def _terms(deck: Deck, block: Block, scope: Scope, line: int, terms: list) -> Iterator[Problem]:
    if len(terms) < 2:
        yield problem(block, "an equation is: number of terms; then node or set, dof, coefficient for each", line)
        return
    sizes = []
    for name, dof, _ in terms:
        refs = deck.refs(name, "nsets", scope)
        if refs is None:
            yield problem(block, f"node set {name} is not defined", line)
        sizes.append(len(refs or ()))
        if not 1 <= dof <= 6 and dof not in (8, 9, 11):
            yield problem(block, f"dof {dof} does not exist", line)
    if any(size not in (1, sizes[0]) for size in sizes):
        yield problem(block, f"the node sets of one equation have different sizes: {sizes}", line)
    if terms[0][2] == 0:
        yield problem(block, "the first coefficient is zero", line)


def _prescribed(deck: Deck) -> set[tuple[Ref, int]]:
    found = set()
    for block in deck.boundaries + [b for step in deck.steps for b in step.blocks if b.keyword == "BOUNDARY"]:
        for _, items in block.rows():
            if len(items) > 1 and items[1].isdigit():
                last = int(items[2]) if len(items) > 2 and items[2].isdigit() else int(items[1])
                for ref in deck.refs(label(items[0])) or ():
                    found.update((ref, dof) for dof in range(int(items[1]), last + 1))
    return found


CHECKS = (data_references, contacts, joined_names, sections, initial_values, constraints)
