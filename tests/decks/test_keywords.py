"""The checker itself: good decks pass, and every kind of mistake is found where it is made."""

from __future__ import annotations

import re
import shutil
import subprocess
import time
from pathlib import Path

import pytest

from .keywords import check_deck, parse_deck
from .table import dialect

GOOD = Path(__file__).parent / "good"
DIALECTS = {
    "parts_shell": "abaqus",
    "parts_current": "abaqus",
    "flat_shell": "abaqus",
    "calculix_solid": "calculix",
    "calculix_heat": "calculix",
}


def text(name: str) -> str:
    return (GOOD / f"{name}.inp").read_text("ascii")


@pytest.mark.parametrize("name", DIALECTS)
def test_good_decks_pass(name: str) -> None:
    assert check_deck(GOOD / f"{name}.inp", DIALECTS[name]) == []
    assert check_deck(text(name), DIALECTS[name]) == []
    assert check_deck(text(name).replace("\n", "\r\n"), DIALECTS[name]) == []


# Deck, what is replaced (once), by what, keyword of the problem, part of its message.
MISTAKES = [
    # spelling, parameters, values
    ("parts_shell", "*KINEMATIC\n", "*KINEMATICS\n", "KINEMATICS", "unknown keyword; *KINEMATIC"),
    ("parts_shell", "*SHELL SECTION", "*SHELL SECT", "SHELL SECT", "unknown keyword; *SHELL SECTION"),
    ("parts_shell", "*DENSITY\n", "*BULK VISCOSITY\n", "BULK VISCOSITY", "unknown keyword"),
    ("parts_shell", ", REF NODE=RP-HUB-1", "", "COUPLING", "required parameter REF NODE is missing"),
    ("parts_shell", "SURFACE=SPOKE-1.HUB-EDGE", "SURF=SPOKE-1.HUB-EDGE", "COUPLING", "unknown parameter SURF; SURFACE"),
    ("parts_shell", ", TIE NSET=SPOKE-2.RIM", "", "RIGID BODY", "one of these parameters is required"),
    ("parts_shell", "HOURGLASS=ENHANCED", "HOURGLASS=ENHANCE", "SECTION CONTROLS", "is not one of"),
    ("parts_shell", "TYPE=R\n", "TYPE=Q\n", "TRANSFORM", "TYPE=Q is not one of"),
    ("parts_shell", "DEPENDENCIES=1", "DEPENDENCIES", "ELASTIC", "needs a value"),
    ("parts_shell", "INC=1000", "INC=many", "STEP", "not a whole number"),
    ("parts_shell", "NUMBER INTERVAL=20", "NUMBER INTERVAL=20, FREQUENCY=1", "OUTPUT", "exclude each other"),
    ("parts_shell", "*OUTPUT, FIELD", "*OUTPUT, FIELD, HISTORY", "OUTPUT", "exclude each other"),
    ("parts_shell", "NAME=RAMP-X,", "NAME=RAMP-X, NAME=RAMP,", "AMPLITUDE", "given twice"),
    # lines and names
    ("parts_shell", "** PARTS", "** " + "P" * 254, "", "more than 256 characters"),
    ("parts_shell", "Two strips", "Zwei Streifen, weiß", "", "7-bit ASCII"),
    ("parts_shell", 'NAME="stiff hub"', "NAME=stiff hub", "MATERIAL", "quote it"),
    ("parts_shell", 'MATERIAL="stiff hub"', "MATERIAL=stiff hub", "SHELL SECTION", "quote it"),
    ("parts_shell", "NSET=RIM-1\n", "NSET=RIM.1\n", "NSET", "holds a period"),
    ("parts_shell", "NSET=RIM-1\n", "NSET=1-RIM\n", "NSET", "start with a letter"),
    ("parts_shell", "NSET=RIM-1\n", "NSET=" + "R" * 81 + "\n", "NSET", "81 characters"),
    ("parts_shell", "NSET=RIM-1\n", "NSET=__RIM__\n", "NSET", "reserved"),
    ("parts_shell", "*HEADING", "1, 2, 3\n*HEADING", "", "before the first keyword"),
    # place
    ("parts_shell", "*END PART\n*PART, NAME=PLATE", "*STATIC\n*END PART\n*PART, NAME=PLATE", "STATIC",
     "outside a step"),
    ("parts_shell", "*END ASSEMBLY\n", "*CLOAD\nRP-HUB, 3, 1.0\n*END ASSEMBLY\n", "CLOAD", "history data"),
    ("parts_shell", "*RESTART, WRITE", "*TRANSFORM, NSET=RP-HUB\n1., 0., 0., 0., 1., 0.\n*RESTART, WRITE",
     "TRANSFORM", "inside a step"),
    ("parts_shell", "*SECTION CONTROLS,", "*NODE\n9, 0., 0., 0.\n*SECTION CONTROLS,", "NODE", "stands at model level"),
    ("parts_shell", "*END ASSEMBLY\n", "*MATERIAL, NAME=A\n*ELASTIC\n1., .3\n*END ASSEMBLY\n", "MATERIAL",
     "stands at assembly level"),
    ("parts_shell", "*END ASSEMBLY\n", "", "ASSEMBLY", "never closed"),
    ("parts_shell", "*END INSTANCE\n*INSTANCE, NAME=CENTRE", "*INSTANCE, NAME=CENTRE", "INSTANCE",
     "stands at instance level"),
    ("parts_shell", "*END STEP\n", "*END STEP\n*AMPLITUDE, NAME=B\n0., 0., 1., 1.\n", "AMPLITUDE",
     "after the first step"),
    ("parts_shell", "*END STEP\n", "", "STEP", "never closed"),
    ("parts_shell", "*DISTRIBUTING, COUPLING=STRUCTURAL\n1, 6\n", "", "COUPLING", "must be followed at once"),
    ("parts_shell", "*STATIC\n0.05, 1.0, 1E-6, 0.05\n", "", "STEP", "has no procedure"),
    ("parts_shell", "*OUTPUT, FIELD, NUMBER INTERVAL=20\n", "", "NODE OUTPUT", "belongs below *OUTPUT"),
    # names that must resolve
    ("parts_shell", "SPOKE-2.ALL", "SPOKE-2.NONE", "INITIAL CONDITIONS", "SPOKE-2.NONE is not defined"),
    ("parts_shell", "RP-HUBS, 1, 2", "RP-HUBZ, 1, 2", "BOUNDARY", "RP-HUBZ is not defined"),
    ("parts_shell", "SPOKE-2.MIDLINE", "SPOKE-3.MIDLINE", "NSET", "SPOKE-3.MIDLINE is not defined before"),
    ("parts_shell", "PART=PLATE", "PART=PLAT", "INSTANCE", "part PLAT is not defined"),
    ("parts_shell", "MATERIAL=GRADED", "MATERIAL=GRADE", "SHELL SECTION", "material GRADE is not defined"),
    ("parts_shell", "CONTROLS=ENHANCED", "CONTROLS=NOWHERE", "SHELL SECTION", "controls NOWHERE is not defined"),
    ("parts_shell", "SURFACE=SPOKE-1.RIM-EDGE", "SURFACE=SPOKE-1.EDGE", "COUPLING",
     "surface SPOKE-1.EDGE is not defined"),
    ("parts_shell", "ORIENTATION=AXES-2", "ORIENTATION=AXES-3", "COUPLING", "orientation AXES-3 is not defined"),
    ("parts_shell", "AMPLITUDE=RAMP-X\n", "AMPLITUDE=RAMP-Y\n", "BOUNDARY", "amplitude RAMP-Y is not defined"),
    ("parts_shell", "REF NODE=RP-HUB-1", "REF NODE=RP-HUBS", "COUPLING", "has 2 nodes"),
    ("parts_shell", "RIM-ELEMENTS, E2", "RIM-ELEMENTS, S2", "SURFACE", "S4R has no face S2"),
    ("parts_shell", "*NODE OUTPUT, NSET=RP-HUB\n", "*NODE OUTPUT\n", "NODE OUTPUT", "needs NSET"),
    ("flat_shell", "*OUTPUT, HISTORY, TIME INTERVAL=0.01", "*OUTPUT, FIELD", "ENERGY OUTPUT", "*OUTPUT, HISTORY"),
    # mesh and sets
    ("parts_shell", "4, 5, 8, 9, 6", "4, 5, 8, 9", "ELEMENT", "3 nodes, S4R has 4"),
    ("parts_shell", "4, 5, 8, 9, 6", "4, 5, 8, 9, 66", "ELEMENT", "such as 66"),
    ("parts_shell", "4, 5, 8, 9, 6", "3, 5, 8, 9, 6", "ELEMENT", "element number is used twice"),
    ("parts_shell", "9, 30.0, 2.0, 0.0", "8, 30.0, 2.0, 0.0", "NODE", "node number is used twice"),
    ("parts_shell", "9, 30.0, 2.0, 0.0", "9, 30.0, 2.0, 0.o", "NODE", "not a number"),
    ("parts_shell", "TYPE=S4R, ELSET=STRIP", "TYPE=S4Q, ELSET=STRIP", "ELEMENT", "unknown element type S4Q"),
    ("parts_shell", "*ELSET, ELSET=RIM-ELEMENTS\n3, 4", "*ELSET, ELSET=RIM-ELEMENTS\n" + "3, " * 16 + "4", "ELSET",
     "17 entries"),
    ("parts_shell", "7, 9, 1", "7, 9, 3", "NSET", "no whole number of steps"),
    ("parts_shell", "*ELSET, ELSET=RIM-ELEMENTS\n3, 4", "*ELSET, ELSET=RIM-ELEMENTS\n3, 40", "ELSET", "such as 40"),
    ("parts_shell", "NSET=ALL, ELSET=STRIP", "NSET=ALL, ELSET=STRIP, UNSORTED", "NSET", "exclude each other"),
    # sections, materials, fields
    ("parts_shell", "*SHELL SECTION, ELSET=STRIP", "*SHELL SECTION, ELSET=RIM-ELEMENTS", "ELEMENT",
     "2 S4R elements in part SPOKE have no"),
    ("flat_shell", "*SHELL SECTION, ELSET=PHASE-FLX9070", "*SHELL SECTION, ELSET=STRIP", "SHELL SECTION",
     "already have a section"),
    ("flat_shell", "*RIGID BODY, REF NODE=RP-INDENTER, ELSET=INDENTER\n", "", "ELEMENT", "have no *RIGID BODY"),
    ("parts_shell", "2.0, 5", "2.0, 4", "SHELL SECTION", "odd number"),
    ("parts_shell", "2.0, 5", "0.0, 5", "SHELL SECTION", "not a positive number"),
    ("parts_shell", "*ELASTIC\n12.6, 0.3\n", "*DENSITY\n1E-9\n", "MATERIAL", "has no *ELASTIC"),
    ("parts_shell", "12.6, 0.3, , 12.6", "12.6, 0.3, 12.6", "ELASTIC", "these are needed"),
    ("parts_shell", "12.6, 0.3, , 12.6", "12.6, 0.3, , 2.6", "ELASTIC", "must ascend"),
    ("parts_shell", "12.6, 0.3, , 12.6", "12.6, 0.5, , 12.6", "ELASTIC", "Poisson's ratio"),
    ("parts_shell", "SPOKE-1.5, 6.0\n", "", "SHELL SECTION", "1 nodes have no initial field 1: SPOKE-1.5"),
    ("parts_shell", "VARIABLE=1", "VARIABLE=2", "SHELL SECTION", "9 nodes have no initial field 1"),
    ("parts_shell", "SPOKE-1.5, 6.0", "SPOKE-1.5", "INITIAL CONDITIONS", "no number"),
    ("parts_shell", "SPOKE-1.5, 6.0", "SPOKE-1.55, 6.0", "INITIAL CONDITIONS", "no such nodes: SPOKE-1.55"),
    ("flat_shell", "*DENSITY\n1.41E-9\n", "", "MATERIAL", "has no *DENSITY"),
    # constraints
    ("parts_shell", "TIE NSET=CENTRE.PLATE", "TIE NSET=SPOKE-1.HUB", "RIGID BODY", "3 nodes already follow *COUPLING"),
    ("parts_shell", "SURFACE=SPOKE-2.HUB-EDGE", "SURFACE=SPOKE-1.HUB-EDGE", "COUPLING", "already follow *COUPLING"),
    ("parts_shell", "RP-HUBS, 3, 1.0, RP-HUB, 3, -1.0", "RP-HUBS, 3, 1.0, RP-HUB, 3", "EQUATION", "an equation is"),
    ("parts_shell", "RP-HUBS, 3, 1.0, RP-HUB, 3, -1.0", "RP-HUBS, 3, 1.0, RIM-1, 3, -1.0", "EQUATION",
     "different sizes"),
    ("parts_shell", "RP-HUBS, 3, 1.0, RP-HUB, 3, -1.0", "RP-HUBS, 1, 1.0, RP-HUB, 3, -1.0", "EQUATION",
     "is prescribed too"),
    ("parts_shell", "*END ASSEMBLY\n", "*EQUATION\n2\nRP-HUB, 3, 1., RP-HUB-1, 3, -1.\n*END ASSEMBLY\n", "EQUATION",
     "was eliminated"),
    # conditions
    ("parts_shell", "0.5, 0.45, 0.75, 0.7", "0.5, 0.45, 0.45, 0.7", "AMPLITUDE", "times must ascend"),
    ("parts_shell", "0.0, 0.0, 0.25, 0.2, 0.5, 0.45, 0.75, 0.7", "0.0, 0.0, 0.25, 0.2", "AMPLITUDE",
     "each but the last holds four"),
    ("parts_shell", "RP-HUB, 4, 6\n** STEPS", "RP-HUB, 4, 6, 0.1\n** STEPS", "BOUNDARY", "only zero values"),
    ("parts_shell", "RP-HUBS, 4, 6", "RP-HUBS, 4, 7", "BOUNDARY", "no degree of freedom"),
    ("parts_shell", "RP-HUBS, 4, 6", "RP-HUBS, 6, 4", "BOUNDARY", "is below the first"),
    ("parts_shell", "0.05, 1.0, 1E-6, 0.05", "2.0, 1.0, 1E-6, 0.05", "STATIC", "exceeds the step"),
    ("parts_shell", "-1.0, 0.0, 0.0, 0.0, -1.0, 0.0\n*ORIENT", "-1.0, 0.0, 0.0, -1.0, 0.0, 0.0\n*ORIENT",
     "TRANSFORM", "no local system"),
    ("flat_shell", "AMPLITUDE=PUSH, ", "", "BOUNDARY", "ignored by ABAQUS/Explicit"),
    ("flat_shell", "TYPE=DISPLACEMENT\nRP-INDENTER, 1, 2", "TYPE=DISPLACEMENT\nRP-INDENTER, PINNED", "BOUNDARY",
     "model data only"),
    # contact and names
    ("flat_shell", "TOP, TOOL", "TOP, FLOOR", "CONTACT PAIR", "surface FLOOR is not defined"),
    ("flat_shell", "*BOUNDARY\nRP-RIM", "*CONTACT PAIR, INTERACTION=SLIDE\nTOP, TOOL\n*BOUNDARY\nRP-RIM",
     "CONTACT PAIR",
     "belongs into a step"),
    ("flat_shell", "INTERACTION=SLIDE", "INTERACTION=GLIDE", "CONTACT PAIR", "interaction GLIDE is not defined"),
    ("parts_shell", "NSET=RIM-1\n", "NSET=SPOKE-1_RIM\n", "NSET", "ABAQUS's own name"),
    # CalculiX
    ("calculix_solid", "ROT NODE=102", "ROTATION NODE=102", "RIGID BODY", "unknown parameter ROTATION NODE; ROT NODE"),
    ("calculix_solid", "*RIGID BODY, NSET=HUB", "*RIGID BODY, TIE NSET=HUB", "RIGID BODY", "one of these parameters"),
    ("calculix_solid", "TYPE=TEMPERATURE", "TYPE=FIELD, VARIABLE=1", "INITIAL CONDITIONS", "is not one of"),
    ("calculix_solid", "6, 6.2\n", "", "SOLID SECTION", "1 nodes have no initial temperature: 6"),
    ("calculix_solid", "TYPE=C3D8I", "TYPE=C3D8H", "ELEMENT", "unknown element type"),
    ("calculix_solid", "*HEADING", "*PART, NAME=A\n*HEADING", "PART", "unknown keyword"),
    ("calculix_solid", "REF NODE=103", "REF NODE=RP-HUB", "RIGID BODY", "not a whole number"),
    ("calculix_solid", "1, 1, 5, 6, 2, 4, 8, 7, 3", "1, 1, 5, 6, 2, 4, 8, 7", "ELEMENT", "7 nodes, C3D8I has 8"),
    # heat and current
    ("calculix_heat", "*SPECIFIC HEAT\n1.1e9\n", "", "MATERIAL", "has no *SPECIFIC HEAT"),
    ("calculix_heat", "*CONDUCTIVITY\n0.3155", "*CONDUCTIVITY\n0", "CONDUCTIVITY", "not a positive number"),
    ("calculix_heat", "DELTMX=2", "DELTMX=2, STEADY STATE", "HEAT TRANSFER", "exclude each other"),
    ("calculix_heat", "AMPLITUDE=JUMP\n", "AMPLITUDE=LEAP\n", "BOUNDARY", "amplitude LEAP is not defined"),
    ("calculix_heat", "NSET=MIDLINE, TIME POINTS=PICTURES", "NSET=MIDLINE, TIME POINTS=P", "NODE PRINT",
     "time points P is not defined"),
    ("calculix_heat", "RIM,11,11,", "RIM,10,10,", "BOUNDARY", "no degree of freedom"),
    ("parts_current", "RIM-FACE,CS", "RIM-SIDE,CS", "DSECURRENT", "surface RIM-SIDE is not defined"),
    ("parts_current", "*ELECTRICAL CONDUCTIVITY\n1e-13\n", "", "MATERIAL", "has no *ELECTRICAL CONDUCTIVITY"),
    ("parts_current", "HUB,9,9,0", "RIM-OTHERS,9,9,0", "EQUATION", "is prescribed too"),
    ("parts_current", "TYPE=DC3D8E", "TYPE=DC3D8F", "ELEMENT", "unknown element type"),
    ("parts_current", "RIM-ELEMENTS,S6", "RIM-ELEMENTS,E6", "SURFACE", "has no face E6"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "old", "new", "keyword", "message"), MISTAKES, ids=lambda v: str(v)[:30])
def test_mistakes_are_found(name: str, old: str, new: str, keyword: str, message: str) -> None:
    deck = text(name)
    assert old in deck, "the mistake no longer fits the deck"
    found = check_deck(deck.replace(old, new, 1), DIALECTS[name])
    assert any(p.keyword == keyword and message in p.message for p in found), "\n".join(map(str, found))


def test_problems_name_the_line() -> None:
    deck = text("parts_shell")
    line = deck[: deck.index("4, 5, 8, 9, 6")].count("\n") + 1
    (found,) = check_deck(deck.replace("4, 5, 8, 9, 6", "4, 5, 8, 9, 6, 7"))
    assert (found.line, found.keyword) == (line, "ELEMENT")


def test_a_keyword_line_may_go_on() -> None:
    deck = text("parts_shell").replace("REF NODE=RP-HUB-1, ", "REF NODE=RP-HUB-1,\n")
    assert check_deck(deck) == []
    assert [p.line for p in check_deck(deck.replace("RP-HUBS, 1, 2", "NONE, 1, 2"))] == [
        deck[: deck.index("RP-HUBS, 1, 2")].count("\n") + 1
    ]


def test_elements_with_many_nodes_go_on_in_a_second_line() -> None:
    nodes = "".join(f"{i}, {i}.0, 0.0, {i * i}.0\n" for i in range(1, 21))
    ids = [str(i) for i in range(1, 21)]
    deck = (
        f"*NODE\n{nodes}*ELEMENT, TYPE=C3D20, ELSET=A\n1, {', '.join(ids[:15])},\n{', '.join(ids[15:])}\n"
        "*SOLID SECTION, ELSET=A, MATERIAL=M\n*MATERIAL, NAME=M\n*ELASTIC\n1., .3\n*STEP\n*STATIC\n*END STEP\n"
    )
    assert check_deck(deck) == []
    assert any("18 nodes" in p.message for p in check_deck(deck.replace("18, 19, 20\n*SOL", "18\n*SOL")))


def test_parsed_decks_have_global_coordinates() -> None:
    deck = parse_deck(GOOD / "parts_shell.inp")
    assert not deck.problems
    assert deck.nset("MIDLINE-2") == [("SPOKE-2", 8), ("SPOKE-2", 5), ("SPOKE-2", 2)]
    assert [tuple(round(c, 12) for c in p) for p in deck.points("MIDLINE-2")] == [(-30, 0, 0), (-20, 0, 0), (-10, 0, 0)]
    assert deck.points("MIDLINE-1")[0] == (30, 0, 0)
    assert deck.nset("spoke-1.rim") == [("SPOKE-1", n) for n in (7, 8, 9)]
    assert deck.elset("SLICE-1") == [("SPOKE-1", 1), ("SPOKE-1", 2)]
    assert deck.points("RP-RIM-2") == [(-30, 0, 0)]
    assert len(list(deck.elements())) == 9
    assert deck.surface_nodes("SPOKE-1.RIM-EDGE") == {("SPOKE-1", n) for n in (7, 8, 9)}
    assert deck.materials["GRADED"].fields == 1
    assert deck.steps[0].procedure.keyword == "STATIC"


def test_sets_are_sorted_unless_told_otherwise() -> None:
    nodes = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 2., 0., 0.\n"
    order = {"": [1, 3], ", UNSORTED": [3, 1]}
    for option, expected in order.items():
        deck = parse_deck(nodes + f"*NSET, NSET=A{option}\n3, 1, 3\n")
        assert [n for _, n in deck.nset("A")] == expected
    assert [n for _, n in parse_deck(nodes + "*NSET, NSET=A\n3, 1\n", "calculix").nset("A")] == [3, 1]


def test_translation_comes_before_rotation() -> None:
    deck = parse_deck(
        "*PART, NAME=P\n*NODE\n1, 1., 0., 0.\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n1., 0., 0.\n"
        "0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n*END ASSEMBLY\n"
    )
    assert deck.point(("I", 1)) == pytest.approx((0, 2, 0))


def test_tables_are_complete() -> None:
    for name in ("abaqus", "calculix"):
        for keyword, spec in dialect(name).keywords.items():
            assert keyword == keyword.upper()
            assert spec.source in {"key", "ccx", "not found"} or re.fullmatch(r"usb \d+\.\d+\.\d+", spec.source)
            assert set(spec.kind) <= {"model", "history"}
            assert set(spec.level) <= {"part", "instance", "assembly", "model", "step"}
            named = {*spec.required, *(p for group in (*spec.one_of, *spec.exclusive) for p in group)}
            assert named <= set(spec.params), keyword
            assert {*spec.within, *spec.then} <= set(dialect(name).keywords), keyword


def test_temperature_tables_need_temperatures() -> None:
    """The other way to give a modulus field, which both solvers know."""
    deck = text("parts_shell").replace("*ELASTIC, DEPENDENCIES=1", "*ELASTIC").replace(", , ", ", ")
    assert any("initial temperature" in p.message for p in check_deck(deck))
    assert check_deck(deck.replace("TYPE=FIELD, VARIABLE=1", "TYPE=TEMPERATURE")) == []


def test_nonsense_is_reported_and_never_raised() -> None:
    for nonsense in (
        "",
        "hello\n",
        "*\n",
        "*NODE\n*NODE\n",
        "*STEP",
        "*ELEMENT, TYPE=S4R\n1,\n",
        "*NSET\n,,\n",
        "*A,=,=\n",
    ):
        assert check_deck(nonsense), nonsense
    deck = text("parts_shell")
    lines = deck.splitlines(keepends=True)
    for skipped in range(len(lines)):
        check_deck("".join(lines[:skipped] + lines[skipped + 1 :]))


def test_large_decks_are_read_fast(tmp_path: Path) -> None:
    n = 100
    node = "".join(f"{i + 1}, {i * 0.25:.6f}, {i % 100 * 0.25:.6f}, {i % 7 * 0.25:.6f}\n" for i in range(n * n * 20))
    cells = "".join(f"{i}, {', '.join(str(i + k) for k in (0, 1, 2, 3, 4, 5, 6, 7))}\n" for i in range(1, n * n * 19))
    deck = tmp_path / "large.inp"
    deck.write_text(
        f"*NODE, NSET=ALL\n{node}*ELEMENT, TYPE=C3D8R, ELSET=E\n{cells}*SOLID SECTION, ELSET=E, MATERIAL=M\n"
        "*MATERIAL, NAME=M\n*ELASTIC, DEPENDENCIES=1\n1., .3, , 1.\n2., .3, , 2.\n"
        "*INITIAL CONDITIONS, TYPE=FIELD\n" + "".join(f"{i + 1}, 1.5\n" for i in range(n * n * 20)) +
        "*STEP\n*STATIC\n*END STEP\n"
    )  # fmt: skip
    start = time.perf_counter()
    assert check_deck(deck) == []
    rate = deck.stat().st_size / 1e6 / (time.perf_counter() - start)
    print(f"{rate:.0f} MB/s")
    assert rate > 5, f"{rate:.1f} MB/s: 20 are wanted on an idle machine"


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
def test_calculix_accepts_the_good_deck(tmp_path: Path) -> None:
    shutil.copy(GOOD / "calculix_solid.inp", tmp_path)
    run = subprocess.run(
        ["ccx", "calculix_solid"], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False
    )
    assert "not recognized" not in run.stdout
    assert "*ERROR" not in run.stdout
    assert "Job finished" in run.stdout
