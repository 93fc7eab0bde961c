"""Builds the model of a deck from its blocks and reports what cannot be understood on the way."""

from __future__ import annotations

import json
from array import array
from collections.abc import Iterable

from .blocks import Block, Problem, label
from .elements import CALCULIX, TYPES
from .model import Deck, ElementBlock, Instance, Material, Scope, Set, Step

NOT_NUMERIC = bytes(c for c in range(256) if c not in b",\n")
NAMED = {
    "SECTION CONTROLS": "controls",
    "SURFACE INTERACTION": "interaction",
    "FILTER": "filter",
    "TIME POINTS": "time points",
    "DISTRIBUTION": "distribution",
    "DISTRIBUTION TABLE": "table",
}
CHUNK = 1 << 22


def chunks(data: bytes) -> Iterable[bytes]:
    """Whole lines, some megabytes at a time, so that conversion does not hold all numbers as objects at once."""
    start = 0
    while start < len(data):
        stop = data.find(b"\n", start + CHUNK)
        stop = len(data) if stop < 0 else stop
        yield data[start:stop].strip()
        start = stop + 1


def numbers(data: bytes, code: str) -> array:
    """All numbers of some data lines. JSON's reader is the fastest that Python ships, where it takes the spelling."""
    flat = data.replace(b"\n", b",")
    try:
        return array(code, json.loads(b"[" + flat + b"]"))
    except (ValueError, TypeError):
        return array(code, map(int if code == "q" else float, flat.split(b",")))


class Builder:
    """Fed with blocks in order; ``deck`` is complete after the last."""

    def __init__(self, dialect: str, in_parts: bool):
        self.deck = Deck(Scope("", "assembly" if in_parts else "flat"), dialect)
        self.scope = self.deck.root
        self.step: Step | None = None
        self.material: Material | None = None
        self.instance: Instance | None = None

    def bad(self, line: int, block: Block, message: str) -> None:
        self.deck.problems.append(Problem(line, block.keyword, message))

    def add(self, block: Block) -> None:
        if self.step is not None and block.keyword not in ("STEP", "END STEP"):
            self.step.blocks.append(block)
        method = getattr(self, "on_" + block.keyword.lower().replace(" ", "_"), None)
        if method:
            method(block)
        elif block.keyword in NAMED:
            self.define(self.deck.named.setdefault(NAMED[block.keyword], {}), block)
        elif self.material is not None and self.step is None:
            self.material.options.setdefault(block.keyword, block)

    def define(self, names: dict, block: Block, value=None, key: str = "NAME") -> None:
        """Enters a name once: the solvers take a second definition as an error."""
        name = block.get(key)
        if not name:
            return
        if name in names:
            self.bad(block.line, block, f"{name} is defined twice")
        names[name] = block if value is None else value

    # Structure

    def on_part(self, block: Block) -> None:
        self.scope = Scope(block.get("NAME") or "", "part")
        self.define(self.deck.parts, block, self.scope)

    def on_end_part(self, _: Block) -> None:
        self.scope = self.deck.root

    def on_assembly(self, block: Block) -> None:
        self.deck.root.name = block.get("NAME") or ""

    def on_instance(self, block: Block) -> None:
        part = self.deck.parts.get(block.get("PART") or "")
        if part is None:
            self.bad(block.line, block, f"part {block.get('PART')} is not defined before this line")
            part = Scope("", "part")
        instance = Instance(block.get("NAME") or "", part, block.line)
        rows = [(line, items) for line, items in block.rows()]
        for (line, items), count in zip(rows, (3, 7), strict=False):
            try:
                values = tuple(float(item) for item in items)
            except ValueError:
                continue
            if len(values) != count:
                self.bad(line, block, f"{len(values)} numbers, {count} are needed")
            elif count == 3:
                instance.translation = values
            elif values[:3] == values[3:6]:
                self.bad(line, block, "the two points of the axis coincide")
            else:
                instance.rotation = values
        self.define(self.deck.instances, block, instance)

    def on_step(self, block: Block) -> None:
        self.material = None
        self.step = Step(block)
        self.deck.steps.append(self.step)

    def on_end_step(self, _: Block) -> None:
        self.step = None

    # Mesh

    def on_node(self, block: Block) -> None:
        new: list[int] = []
        for data in chunks(block.numbers()):
            table = self._nodes(block, data)
            self.scope.coordinates.append(table)
            new += map(int, table[::4])
        distinct = set(new)
        if len(distinct) < len(new) or self.scope.node_ids & distinct:
            self.bad(block.line, block, "a node number is used twice")
        self.scope.node_ids |= distinct
        if new and min(distinct) < 1:
            self.bad(block.line, block, "node numbers start at 1")
        if block.has("NSET"):
            self.collect(self.scope.nsets, block, "NSET", new)

    def _nodes(self, block: Block, data: bytes) -> array:
        commas = data.translate(None, NOT_NUMERIC)
        if commas == (b",,,\n" * (commas.count(b"\n") + 1))[:-1]:
            try:
                return numbers(data, "d")
            except ValueError:
                pass
        table = array("d")
        for line, items in block.rows():
            try:
                values = [float(item or 0) for item in items]
            except ValueError:
                self.bad(line, block, "not a number in a node's line")
                continue
            if not 2 <= len(values) <= 7:
                self.bad(
                    line, block, f"{len(values)} entries: number, three coordinates, three of a normal are allowed"
                )
            table.extend((values + [0.0, 0.0, 0.0])[:4])
        return table

    def on_element(self, block: Block) -> None:
        kind = TYPES.get(block.get("TYPE") or "")
        if kind is None or (self.deck.dialect == "calculix" and block.get("TYPE") not in CALCULIX):
            self.bad(block.line, block, f"unknown element type {block.get('TYPE')}")
            return
        table = array("q")
        for data in chunks(block.numbers()):
            table += self._elements(block, data, kind.nodes)
        element_block = ElementBlock(block.get("TYPE"), block.line, table)
        ids = element_block.ids().tolist()
        distinct = set(ids)
        if len(distinct) < len(ids) or self.scope.element_ids & distinct:
            self.bad(block.line, block, "an element number is used twice")
        self.scope.element_ids |= distinct
        self.scope.elements.append(element_block)
        missing = element_block.nodes() - self.scope.node_ids
        if missing:
            self.bad(
                block.line, block, f"{len(missing)} nodes are not defined before this line, such as {min(missing)}"
            )
        if block.has("ELSET"):
            self.collect(self.scope.elsets, block, "ELSET", ids)

    def _elements(self, block: Block, data: bytes, nodes: int) -> array:
        commas = data.translate(None, NOT_NUMERIC)
        row = b"," * nodes + b"\n"
        if nodes < 16 and commas == (row * (commas.count(b"\n") + 1))[:-1]:
            try:
                return numbers(data, "q")
            except ValueError:
                pass
        table, current = array("q"), []
        for line, text in enumerate(block.data.decode("latin-1").split("\n"), block.data_line):
            text = text.strip()
            if not text or text.startswith("**"):
                continue
            items = [item.strip() for item in text.rstrip(",").split(",")]
            if len(items) > 16:
                self.bad(line, block, f"{len(items)} entries in a data line, at most 16 are allowed")
            try:
                current += map(int, items)
            except ValueError:
                self.bad(line, block, "not a whole number in an element's line")
            if text.endswith(","):
                continue
            if len(current) != nodes + 1:
                self.bad(line, block, f"{len(current) - 1} nodes, {block.get('TYPE')} has {nodes}")
                current = (current + [0] * nodes)[: nodes + 1] if len(current) > nodes else []
            table.extend(current)
            current = []
        if current:
            self.bad(block.line, block, "the last element's line ends with a comma, and no line follows")
        return table

    # Sets

    def collect(self, sets: dict[str, Set], block: Block, key: str, members: Iterable) -> None:
        name = block.get(key)
        if name:
            keep_order = block.has("UNSORTED") or self.deck.dialect == "calculix"
            sets.setdefault(name, Set(block.line, keep_order)).add(members)

    def on_nset(self, block: Block) -> None:
        if block.has("ELSET"):
            found = self.deck.refs(block.get("ELSET") or "", "elsets", self.scope)
            if found is None:
                self.bad(block.line, block, f"element set {block.get('ELSET')} is not defined before this line")
                return
            members: set = set()
            for instance in {at for at, _ in found}:
                owner = self.scope if instance is None else self.deck.owner(instance)
                nodes = owner.element_nodes({n for at, n in found if at == instance})
                members |= nodes if instance is None else {(instance, n) for n in nodes}
            self.collect(self.scope.nsets, block, "NSET", members)
        else:
            self._set(block, "nsets", "NSET")

    def on_elset(self, block: Block) -> None:
        self._set(block, "elsets", "ELSET")

    def _set(self, block: Block, kind: str, key: str) -> None:
        instance = block.get("INSTANCE")
        owner = self.scope if instance is None else self.deck.owner(instance)
        if owner is None:
            self.bad(block.line, block, f"instance {instance} is not defined before this line")
            return
        if instance is not None and self.scope is not self.deck.root:
            self.bad(block.line, block, "INSTANCE is for sets of the assembly only")
        known = owner.node_ids if kind == "nsets" else owner.element_ids
        numbers, members = self._numbers(block, kind, owner, instance)
        unknown = set(numbers) - known
        if unknown:
            thing = "nodes" if kind == "nsets" else "elements"
            self.bad(
                block.line, block, f"{len(unknown)} {thing} are not defined before this line, such as {min(unknown)}"
            )
        members += numbers if instance is None else [(instance, n) for n in numbers]
        self.collect(getattr(self.scope, kind), block, key, members)

    def _numbers(self, block: Block, kind: str, owner: Scope, instance: str | None) -> tuple[list[int], list]:
        """Numbers given directly or by ranges, and members of the sets and qualified labels that are named."""
        if not block.has("GENERATE"):
            try:
                data = block.numbers().replace(b",\n", b"\n").replace(b"\n", b",").rstrip(b", ")
                return list(map(int, data.split(b","))), []
            except ValueError:
                pass
        numbers, members = [], []
        for line, items in block.rows():
            if block.has("GENERATE"):
                try:
                    first, last, step = (*map(int, items), 1)[:3]
                except ValueError:
                    self.bad(line, block, "GENERATE needs first, last and increment")
                    continue
                if step < 1 or (last - first) % step or last < first:
                    self.bad(line, block, f"from {first} to {last} is no whole number of steps of {step}")
                    continue
                numbers += range(first, last + 1, step)
                continue
            for item in items:
                if item.isdigit():
                    numbers.append(int(item))
                    continue
                found = self.deck.refs(label(item), kind, owner)
                if found is None:
                    self.bad(line, block, f"{item} is not defined before this line")
                else:
                    members += [(at or instance, n) if (at or instance) else n for at, n in found]
        return numbers, members

    # Properties and conditions

    def on_surface(self, block: Block) -> None:
        self.define(self.scope.surfaces, block)

    def on_orientation(self, block: Block) -> None:
        self.define(self.scope.orientations, block)

    def on_transform(self, block: Block) -> None:
        self.scope.transforms.append(block)

    def on_solid_section(self, block: Block) -> None:
        self.scope.sections.append(block)

    def on_shell_section(self, block: Block) -> None:
        self.scope.sections.append(block)

    def on_material(self, block: Block) -> None:
        self.material = Material(block)
        self.define(self.deck.materials, block, self.material)

    def on_amplitude(self, block: Block) -> None:
        self.define(self.deck.amplitudes, block)

    def on_initial_conditions(self, block: Block) -> None:
        self.deck.initial.append(block)

    def on_boundary(self, block: Block) -> None:
        if self.step is None:
            self.deck.boundaries.append(block)

    def on_coupling(self, block: Block) -> None:
        self.deck.constraints.append((block, self.scope))

    def on_contact_pair(self, block: Block) -> None:
        self.deck.contacts.append((block, self.step is not None))

    on_contact_inclusions = on_contact_property_assignment = on_contact_pair
    on_rigid_body = on_equation = on_tie = on_mpc = on_kinematic = on_coupling
