"""Every ctypes declaration is that of the header."""

from __future__ import annotations

import ctypes as c
import re
from pathlib import Path

from .conftest import ROOT

HEADER = (ROOT / "ffi" / "include" / "voxelastica.h").read_text(encoding="utf-8")
CODE = re.sub(r"//[^\n]*|/\*.*?\*/", "", HEADER, flags=re.S)

PLAIN = {
    "bool": c.c_bool,
    "double": c.c_double,
    "int32_t": c.c_int32,
    "uint32_t": c.c_uint32,
    "size_t": c.c_size_t,
    "voxelastica_status": c.c_int32,
}
HANDLES = {"error", "text", "input", "design", "mesh", "flower", "path"}


def structures() -> dict[str, list[tuple[str, str]]]:
    found = re.findall(r"typedef struct (\w+)? ?\{(.*?)\} (\w+);", CODE, flags=re.S)
    members = re.compile(r"([\w ]+?[\s*]+)(\w+);")
    return {name: [(kind.strip(), member) for kind, member in members.findall(body)] for _, body, name in found}


def functions() -> dict[str, tuple[str, list[str]]]:
    found = re.findall(r"^(\w[\w ]*?[\s*]+)voxelastica_(\w+)\(([^;]*)\);", CODE, flags=re.M | re.S)
    split = {}
    for result, name, arguments in found:
        kinds = [re.sub(r"\w+$", "", " ".join(argument.split())).strip() for argument in arguments.split(",")]
        split[name] = (result.strip(), [] if arguments.strip() == "void" else kinds)
    return split


def expected(kind: str, package: object) -> list[object]:
    """What a C type may be declared as."""
    bare = " ".join(kind.replace("const", " ").replace("struct", " ").split())
    if bare in PLAIN:
        return [PLAIN[bare]]
    if bare == "voxelastica_progress":
        return [package.PROGRESS]
    base, stars = bare.rstrip("* "), bare.count("*")
    short = base.removeprefix("voxelastica_")
    if short in HANDLES:
        return [c.c_void_p] if stars == 1 else [c.POINTER(c.c_void_p)]
    if base == "char" and stars == 1:
        return [c.c_char_p, c.c_void_p]
    if base == "void" and stars == 1:
        return [c.c_void_p]
    if short.startswith("array_"):
        return [c.POINTER(package.Array)]
    if short in ("voxels", "material", "parameter"):
        return [c.POINTER(getattr(package, short.capitalize()))]
    if base in ("float", "double", "size_t") and stars == 1:
        return [c.c_void_p, c.POINTER({"float": c.c_float, "double": c.c_double, "size_t": c.c_size_t}[base])]
    raise AssertionError(f"an unknown type in the header: {kind}")


def test_every_function_is_declared_as_in_the_header() -> None:
    from voxelastica import _library

    header = functions()
    assert len(header) > 60
    assert set(header) == set(_library.DECLARATIONS)
    for name, (result, arguments) in header.items():
        declared_result, declared = _library.DECLARATIONS[name]
        assert declared_result in expected(result, _library), name
        assert len(declared) == len(arguments), name
        for kind, declaration in zip(arguments, declared, strict=True):
            assert declaration in expected(kind, _library), f"{name}: {kind}"


def test_every_structure_is_laid_out_as_in_the_header() -> None:
    from voxelastica import _library

    header = structures()
    ours = {"voxels": _library.Voxels, "material": _library.Material, "parameter": _library.Parameter}
    ours |= dict.fromkeys(("array_f64", "array_u32", "array_size", "array_u8"), _library.Array)
    for name, structure in ours.items():
        members = header[f"voxelastica_{name}"]
        assert [member for _, member in members] == [field[0] for field in structure._fields_], name
        for (kind, member), field in zip(members, structure._fields_, strict=True):
            if member == "data":
                allowed: list[object] = [c.c_void_p]
            elif "voxelastica_array" in kind:
                allowed = [_library.Array]
            else:
                allowed = expected(kind, _library)
            assert field[1] in allowed, f"{name}.{member}: {kind}"


def test_constants_are_those_of_the_header() -> None:
    from voxelastica import FABRICATION, OUTPUTS, VoxelasticaError, _library

    def constant(name: str) -> int:
        return int(re.search(rf"VOXELASTICA_{name}(?: =)? (\d+)", CODE)[1])

    assert constant("ABI_VERSION") == _library.ABI_VERSION
    for name, bit in OUTPUTS.items():
        assert constant(f"OUTPUT_{name.upper()}") == bit
    assert constant("OUTPUT_ALL") == sum(OUTPUTS.values())
    for name, bit in FABRICATION.items():
        assert constant("FABRICATION_" + {"3mf": "THREE_MF"}.get(name, name.upper())) == bit
    codes = dict(re.findall(r"VOXELASTICA_STATUS_(\w+) = (\d+)", CODE))
    assert codes.pop("OK") == "0"
    assert {name: int(code) for name, code in codes.items()} == {
        name: value for name, value in vars(VoxelasticaError).items() if name.isupper()
    }


def test_ctypes_is_used_in_the_package_only() -> None:
    folders = ["blender_addon", "freecad_macro", "abaqus_scripts", "scripts"]
    for folder in folders:
        for file in Path(ROOT / folder).rglob("*.py"):
            assert "ctypes" not in file.read_text(encoding="utf-8"), f"{file} talks to the library on its own"
