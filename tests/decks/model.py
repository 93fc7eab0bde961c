"""What a deck says: nodes, elements, sets, instances, materials and conditions, with names resolved.

A node or element is referred to as ``(instance, number)``; the instance is None in flat decks and for nodes that belong
to the assembly itself. Inside a part, plain numbers do.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from .blocks import Block, Problem, label
from .elements import TYPES

Ref = tuple[str | None, int]
Point = tuple[float, float, float]


@dataclass
class ElementBlock:
    """Elements of one *ELEMENT keyword; ``table`` holds number, node, node, ... for each."""

    type: str
    line: int
    table: array

    @property
    def width(self) -> int:
        return 1 + (TYPES[self.type].nodes if self.type in TYPES else 0)

    def ids(self) -> array:
        return self.table[:: self.width]

    def rows(self, wanted: set[int] | None = None) -> Iterator[tuple[int, array]]:
        for i in range(0, len(self.table), self.width):
            if wanted is None or self.table[i] in wanted:
                yield self.table[i], self.table[i + 1 : i + self.width]

    def nodes(self, wanted: set[int] | None = None) -> set[int]:
        """Nodes of the elements in ``wanted`` (None: of all). Columns at a time, as whole blocks are the usual case."""
        found: set[int] = set()
        if wanted is None or wanted.issuperset(self.ids()):
            for column in range(1, self.width):
                found.update(self.table[column :: self.width])
        else:
            for _, nodes in self.rows(wanted):
                found.update(nodes)
        return found


@dataclass
class Set:
    """Members of a node or element set in the order the solver keeps them (sorted, unless UNSORTED or CalculiX)."""

    line: int
    unsorted: bool
    members: list = field(default_factory=list)

    def add(self, new: Iterable) -> None:
        if self.unsorted:
            seen = set(self.members)
            self.members += [m for m in new if not (m in seen or seen.add(m))]
        else:
            merged = {*self.members, *new}
            try:
                self.members = sorted(merged)
            except TypeError:  # nodes of the assembly beside those of instances
                self.members = sorted(merged, key=_order)


def _order(member: int | Ref) -> tuple[str, int]:
    return ("", member) if isinstance(member, int) else (member[0] or "", member[1])


@dataclass
class Scope:
    """What owns nodes and names: a part, the assembly, or a flat deck as a whole (``kind`` "flat")."""

    name: str
    kind: str
    coordinates: list[array] = field(default_factory=list)  # number, x, y, z, number, ...
    node_ids: set[int] = field(default_factory=set)
    elements: list[ElementBlock] = field(default_factory=list)
    element_ids: set[int] = field(default_factory=set)
    nsets: dict[str, Set] = field(default_factory=dict)
    elsets: dict[str, Set] = field(default_factory=dict)
    surfaces: dict[str, Block] = field(default_factory=dict)
    orientations: dict[str, Block] = field(default_factory=dict)
    sections: list[Block] = field(default_factory=list)
    transforms: list[Block] = field(default_factory=list)
    _points: dict[int, Point] | None = None

    def points(self) -> dict[int, Point]:
        """Coordinates as written, by node number."""
        if self._points is None:
            self._points = {}
            for table in self.coordinates:
                columns = [table[i::4] for i in range(4)]
                self._points.update((int(n), (x, y, z)) for n, x, y, z in zip(*columns, strict=True))
        return self._points

    def element_nodes(self, wanted: set[int]) -> set[int]:
        found: set[int] = set()
        for block in self.elements:
            found |= block.nodes(wanted)
        return found


@dataclass
class Instance:
    """A placed part: translated first, then turned about the axis a-b."""

    name: str
    part: Scope
    line: int
    translation: Point = (0.0, 0.0, 0.0)
    rotation: tuple[float, ...] | None = None

    def place(self, point: Point) -> Point:
        p = tuple(c + t for c, t in zip(point, self.translation, strict=True))
        return rotate(p, self.rotation) if self.rotation else p


def rotate(p: Point, rotation: tuple[float, ...]) -> Point:
    """Turns a point about the axis from a to b by an angle in degrees (right-handed): Rodrigues' formula."""
    a, b, angle = rotation[0:3], rotation[3:6], math.radians(rotation[6])
    length = math.dist(a, b)
    k = tuple((bi - ai) / length for ai, bi in zip(a, b, strict=True))
    v = tuple(pi - ai for pi, ai in zip(p, a, strict=True))
    cross = (k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0])
    dot = sum(ki * vi for ki, vi in zip(k, v, strict=True))
    cos, sin = math.cos(angle), math.sin(angle)
    return tuple(ai + vi * cos + ci * sin + ki * dot * (1 - cos) for ai, vi, ci, ki in zip(a, v, cross, k, strict=True))


@dataclass
class Material:
    """A material and the blocks below it."""

    block: Block
    options: dict[str, Block] = field(default_factory=dict)

    @property
    def fields(self) -> int:
        """How many field variables the elasticity depends on."""
        elastic = self.options.get("ELASTIC")
        text = elastic.get("DEPENDENCIES") if elastic else None
        return int(text) if text and text.isdigit() else 0

    @property
    def all_fields(self) -> int:
        """How many field variables any of its options depends on."""
        counts = [block.get("DEPENDENCIES") or "0" for block in self.options.values()]
        return max((int(c) for c in counts if c.isdigit()), default=0)

    @property
    def needs_temperature(self) -> bool:
        """Whether the elasticity varies with temperature, so that nodes need one."""
        elastic = self.options.get("HYPERELASTIC") or self.options.get("ELASTIC")
        return bool(elastic) and not self.fields and sum(1 for _ in elastic.rows()) > 1


@dataclass
class Step:
    """A step and the blocks in it."""

    block: Block
    blocks: list[Block] = field(default_factory=list)

    @property
    def procedure(self) -> Block | None:
        names = ("STATIC", "DYNAMIC", "BUCKLE", "FREQUENCY", "HEAT TRANSFER", "COUPLED THERMAL-ELECTRICAL")
        return next((b for b in self.blocks if b.keyword in names), None)

    @property
    def explicit(self) -> bool:
        return bool(self.procedure and self.procedure.has("EXPLICIT"))


@dataclass
class Deck:
    """A parsed deck. ``root`` is the assembly of a deck in parts, or everything in a flat one."""

    root: Scope
    dialect: str = "abaqus"
    parts: dict[str, Scope] = field(default_factory=dict)
    instances: dict[str, Instance] = field(default_factory=dict)
    materials: dict[str, Material] = field(default_factory=dict)
    amplitudes: dict[str, Block] = field(default_factory=dict)
    named: dict[str, dict[str, Block]] = field(default_factory=dict)  # controls, interaction, filter, ... by name
    constraints: list[tuple[Block, Scope]] = field(
        default_factory=list
    )  # couplings, rigid bodies, equations, ties, mpcs
    contacts: list[tuple[Block, bool]] = field(default_factory=list)  # and whether it stands in a step
    initial: list[Block] = field(default_factory=list)
    boundaries: list[Block] = field(default_factory=list)  # those of the model data
    steps: list[Step] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)

    @property
    def flat(self) -> bool:
        return self.root.kind == "flat"

    def scopes(self) -> Iterator[Scope]:
        yield from self.parts.values()
        yield self.root

    def instances_of(self, scope: Scope) -> list[str | None]:
        """Where a scope's nodes end up: its instances; the root stands for itself."""
        return [None] if scope is self.root else [i.name for i in self.instances.values() if i.part is scope]

    def owner(self, instance: str | None) -> Scope | None:
        if instance is None:
            return self.root
        return self.instances[instance].part if instance in self.instances else None

    def split(self, name: str, scope: Scope | None = None) -> tuple[Scope | None, str | None, str]:
        """Scope, instance and local name of ``NAME`` or ``INSTANCE.NAME`` as read from ``scope``."""
        scope = scope or self.root
        instance, dot, local = name.partition(".")
        if dot and scope is self.root and not self.flat:
            return self.owner(instance), instance, local
        return scope, None, name

    def refs(self, name: str, kind: str = "nsets", scope: Scope | None = None) -> list[Ref] | None:
        """Members of a set (``kind`` "nsets" or "elsets") or the one node or element of that number; None: unknown."""
        owner, instance, local = self.split(name, scope)
        if owner is None:
            return None
        if local.isdigit():
            number = int(local)
            known = owner.node_ids if kind == "nsets" else owner.element_ids
            return [(instance, number)] if number in known else None
        found = getattr(owner, kind).get(local)
        return None if found is None else [m if isinstance(m, tuple) else (instance, m) for m in found.members]

    def nset(self, name: str) -> list[Ref]:
        """Nodes of a set, in the solver's order. KeyError where there is none."""
        found = self.refs(name.upper())
        if found is None:
            raise KeyError(name)
        return found

    def elset(self, name: str) -> list[Ref]:
        found = self.refs(name.upper(), "elsets")
        if found is None:
            raise KeyError(name)
        return found

    def point(self, ref: Ref) -> Point:
        """Global coordinates of a node: the part's coordinates moved and turned with the instance."""
        instance, number = ref
        point = self.owner(instance).points()[number]
        return point if instance is None else self.instances[instance].place(point)

    def points(self, name: str) -> list[Point]:
        """Global coordinates of a set's nodes, in the set's order."""
        return [self.point(ref) for ref in self.nset(name)]

    def elements(self) -> Iterator[tuple[str, Ref, list[Ref]]]:
        """Type, element and nodes of every element of the model (of every instance, not of every part)."""
        for scope in self.scopes():
            for instance in self.instances_of(scope):
                for block in scope.elements:
                    for number, nodes in block.rows():
                        yield block.type, (instance, number), [(instance, n) for n in nodes]

    def surface_nodes(self, name: str, scope: Scope | None = None) -> set[Ref]:
        """Nodes of a surface: of its node sets, or of the faces of its elements."""
        owner, instance, local = self.split(name, scope)
        block = owner.surfaces.get(local) if owner else None
        found: set[Ref] = set()
        for _, items in block.rows() if block else ():
            name = label(items[0])
            if block.get("TYPE") == "NODE":
                found.update(self.refs(name, "nsets", owner) or ())
                continue
            face = items[1].upper() if len(items) > 1 else ""
            members = self.refs(name, "elsets", owner) or []
            for at in {at for at, _ in members}:
                scope = owner if at is None else self.owner(at)
                wanted = {n for a, n in members if a == at}
                found.update((at, n) for n in face_nodes(scope, wanted, face))
        return {(instance, n) for _, n in found} if instance else found


def face_nodes(scope: Scope, wanted: set[int], face: str) -> set[int]:
    """Nodes of one face of some elements; of the whole elements where the face has no such name."""
    found: set[int] = set()
    for block in scope.elements:
        picked = TYPES[block.type].faces.get(face) if block.type in TYPES else None
        for _, nodes in block.rows(wanted):
            found.update((nodes[i - 1] for i in picked) if picked else nodes)
    return found
