"""Finds and loads the native library, and declares every function of it.

This is the only place with ctypes declarations; a test holds each of them against ``voxelastica.h``.
"""

from __future__ import annotations

import ctypes as c
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ABI_VERSION = 3

_NAMES = {"win32": "voxelastica.dll", "darwin": "libvoxelastica.dylib"}


class Array(c.Structure):
    """Numbers that a handle lends: first value, rows, columns, bytes from row to row."""

    _fields_ = [("data", c.c_void_p), ("rows", c.c_size_t), ("columns", c.c_size_t), ("stride", c.c_size_t)]


class Voxels(c.Structure):
    """``voxelastica_voxels``."""

    _fields_ = [
        ("size_mm", c.c_double),
        ("slices", c.c_size_t),
        ("layers", c.c_size_t),
        ("phase_count", c.c_size_t),
        ("phases", Array),
        ("offsets", Array),
        ("half_widths", Array),
    ]


class Material(c.Structure):
    """``voxelastica_material``."""

    _fields_ = [
        ("name", c.c_char_p),
        ("modulus_mpa", c.c_double),
        ("poisson", c.c_double),
        ("density_kg_m3", c.c_double),
        ("conductivity_w_mk", c.c_double),
        ("specific_heat_j_kgk", c.c_double),
        ("electrical_conductivity_s_m", c.c_double),
        ("relative_permittivity", c.c_double),
        ("max_strain", c.c_double),
    ]


class Parameter(c.Structure):
    """``voxelastica_parameter``."""

    _fields_ = [
        ("key", c.c_char_p),
        ("range", c.c_char_p),
        ("unit", c.c_char_p),
        ("default_value", c.c_char_p),
        ("targets", c.c_char_p),
        ("description", c.c_char_p),
        ("required", c.c_bool),
    ]


#: ``bool progress(void *user, uint64_t done, uint64_t total)``
PROGRESS = c.CFUNCTYPE(c.c_bool, c.c_void_p, c.c_uint64, c.c_uint64)

_HANDLE = c.c_void_p
_OUT_HANDLE = c.POINTER(c.c_void_p)
_ERROR = c.POINTER(c.c_void_p)
_TEXT = [c.c_char_p, c.c_size_t]
_ARRAY = [_HANDLE, c.POINTER(Array), _ERROR]
_COLUMN = [_HANDLE, c.c_int32, c.POINTER(Array), _ERROR]
_TO_TEXT = [_HANDLE, _OUT_HANDLE, _ERROR]
_FREE = (c.c_int32, [_HANDLE])
_PROGRESS = [PROGRESS, c.c_void_p]
# Buffers are passed by their addresses, whatever they hold.
_BUFFER = [c.c_void_p, c.c_size_t]

#: Name without the prefix: result and arguments. Status codes are ``int32_t``.
DECLARATIONS: dict[str, tuple[Any, list[Any]]] = {
    "version": (c.c_char_p, []),
    "abi_version": (c.c_uint32, []),
    "live_objects": (c.c_size_t, []),
    "error_code": (c.c_int32, [_HANDLE]),
    "error_message": (c.c_char_p, [_HANDLE]),
    "error_key": (c.c_char_p, [_HANDLE]),
    "error_value": (c.c_char_p, [_HANDLE]),
    "error_file": (c.c_char_p, [_HANDLE]),
    "error_line": (c.c_size_t, [_HANDLE]),
    "error_free": _FREE,
    "text_data": (c.c_void_p, [_HANDLE]),
    "text_length": (c.c_size_t, [_HANDLE]),
    "text_free": _FREE,
    "input_parse_toml": (c.c_int32, [*_TEXT, *_TEXT, *_TEXT, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "input_parse_json": (c.c_int32, [*_TEXT, *_TEXT, *_TEXT, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "input_read": (c.c_int32, [*_TEXT, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "input_validate": (c.c_int32, [_HANDLE, _ERROR]),
    "input_json": (c.c_int32, _TO_TEXT),
    "input_hash": (c.c_int32, _TO_TEXT),
    "input_free": _FREE,
    "design_compute": (c.c_int32, [_HANDLE, c.c_bool, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "design_summary": (c.c_int32, _TO_TEXT),
    "design_figure": (c.c_int32, [_HANDLE, *_TEXT, c.POINTER(c.c_double), _ERROR]),
    "design_json": (c.c_int32, _TO_TEXT),
    "design_spokes": (c.c_size_t, [_HANDLE]),
    "design_warnings": (c.c_size_t, [_HANDLE]),
    "design_warning": (c.c_char_p, [_HANDLE, c.c_size_t]),
    "design_profile": (c.c_int32, _COLUMN),
    "design_outline": (c.c_int32, _ARRAY),
    "design_slices": (c.c_int32, _COLUMN),
    "design_voxels": (c.c_int32, [_HANDLE, c.POINTER(Voxels), _ERROR]),
    "design_phases": (c.c_size_t, [_HANDLE]),
    "design_phase_name": (c.c_int32, [_HANDLE, c.c_size_t, _OUT_HANDLE, _ERROR]),
    "design_phase_voxels": (c.c_int32, [_HANDLE, c.c_size_t, c.POINTER(c.c_size_t), _ERROR]),
    "design_phase_centres": (c.c_int32, [_HANDLE, c.c_size_t, *_BUFFER, _ERROR]),
    "design_hub": (c.c_int32, [_HANDLE, c.c_int32, c.c_double, *_BUFFER, _ERROR]),
    "design_write": (c.c_int32, [_HANDLE, *_TEXT, c.c_uint32, c.c_bool, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "design_verify": (c.c_int32, [_HANDLE, c.c_int32, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "design_verify_ccx": (c.c_int32, [_HANDLE, c.c_int32, *_TEXT, *_TEXT, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "design_refine": (c.c_int32, [_HANDLE, c.c_size_t, c.c_bool, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "design_input": (c.c_int32, [_HANDLE, _OUT_HANDLE, _ERROR]),
    "design_conduct": (
        c.c_int32,
        [_HANDLE, c.c_int32, c.c_int32, c.c_int32, c.c_int32, *_PROGRESS, _OUT_HANDLE, _ERROR],
    ),
    "design_fabricate": (c.c_int32, [_HANDLE, *_TEXT, c.c_uint32, c.c_bool, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "design_free": _FREE,
    "mesh_new": (
        c.c_int32,
        [_HANDLE, c.c_int32, c.c_double, c.c_size_t, c.c_size_t, c.c_size_t, _OUT_HANDLE, _ERROR],
    ),
    "mesh_positions": (c.c_int32, _ARRAY),
    "mesh_normals": (c.c_int32, _ARRAY),
    "mesh_modulus": (c.c_int32, _ARRAY),
    "mesh_quads": (c.c_int32, _ARRAY),
    "mesh_free": _FREE,
    "flower_new": (c.c_int32, [_HANDLE, c.c_int32, c.c_size_t, c.c_size_t, _OUT_HANDLE, _ERROR]),
    "flower_vertices": (c.c_size_t, [_HANDLE]),
    "flower_quads": (c.c_int32, _ARRAY),
    "flower_modulus": (c.c_int32, _ARRAY),
    "flower_fill_f32": (c.c_int32, [_HANDLE, c.c_double, *_BUFFER, *_BUFFER, _ERROR]),
    "flower_fill_f64": (c.c_int32, [_HANDLE, c.c_double, *_BUFFER, *_BUFFER, _ERROR]),
    "flower_free": _FREE,
    "path_new": (c.c_int32, [_HANDLE, c.c_int32, c.c_size_t, *_PROGRESS, _OUT_HANDLE, _ERROR]),
    "path_column": (c.c_int32, _COLUMN),
    "path_free": _FREE,
    "materials_count": (c.c_size_t, []),
    "materials_get": (c.c_int32, [c.c_size_t, c.POINTER(Material), _ERROR]),
    "materials_json": (c.c_int32, [_OUT_HANDLE, _ERROR]),
    "parameters_count": (c.c_size_t, []),
    "parameters_get": (c.c_int32, [c.c_size_t, c.POINTER(Parameter), _ERROR]),
    "parameters_json": (c.c_int32, [_OUT_HANDLE, _ERROR]),
    "parameters_schema": (c.c_int32, [_OUT_HANDLE, _ERROR]),
}


def _candidates() -> Iterator[Path]:
    """Where the library may be: where it is said to be, in the package, in a build of the sources."""
    name = _NAMES.get(sys.platform, "libvoxelastica.so")
    if stated := os.environ.get("VOXELASTICA_LIBRARY"):
        yield Path(stated)
        return
    here = Path(__file__).resolve().parent
    yield here / name
    root = here.parents[min(2, len(here.parents) - 1)]
    if (root / "Cargo.toml").is_file():
        for profile in ("release", "debug"):
            yield root / "target" / profile / name


def _load() -> c.CDLL:
    candidates = list(_candidates())
    found = next((path for path in candidates if path.is_file()), None)
    if found is None:
        places = ", ".join(map(str, candidates))
        raise ImportError(
            f"the native library of voxelastica is in none of {places}; "
            "install the wheel, run cargo build --release -p voxelastica-ffi, or set VOXELASTICA_LIBRARY"
        )
    library = c.CDLL(str(found))
    try:
        for name, (result, arguments) in DECLARATIONS.items():
            function = getattr(library, f"voxelastica_{name}")
            function.restype = result
            function.argtypes = arguments
    except AttributeError as error:
        raise ImportError(f"{found} is not the library that this package is for: {error}") from None
    version = library.voxelastica_abi_version()
    if version != ABI_VERSION:
        raise ImportError(f"{found} has interface version {version}, this package needs {ABI_VERSION}")
    library.path = found  # type: ignore[attr-defined]
    return library


LIBRARY = _load()
