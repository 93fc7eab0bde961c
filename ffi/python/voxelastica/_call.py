"""Calls of the native library: errors become exceptions, texts become strings, lent arrays become views."""

from __future__ import annotations

import ctypes as c
import weakref
from collections.abc import Callable
from typing import Any

from ._library import LIBRARY, PROGRESS, Array

try:
    import numpy
except ImportError:  # The package works without it.
    numpy = None  # type: ignore[assignment]

Progress = Callable[[int, int], "bool | None"]

_TYPES = {"d": c.c_double, "I": c.c_uint32, "N": c.c_size_t, "B": c.c_uint8}


class VoxelasticaError(Exception):
    """What went wrong, as the command line says it.

    :ivar code: status code; 1 to 5 and 130 are the command line's exit codes
    :ivar message: the whole message
    :ivar key: dotted key of the design, such as ``voxels.size_mm``, or the name of an argument; may be empty
    :ivar value: the offending value as written; may be empty
    :ivar file: the file; may be empty
    :ivar line: the line in that file; 0 where unknown
    """

    INTERNAL = 1
    INPUT = 2
    INFEASIBLE = 3
    SOLVER = 4
    OUTPUT = 5
    NULL_ARGUMENT = 7
    BAD_HANDLE = 8
    WRONG_LENGTH = 9
    BAD_TEXT = 10
    OUT_OF_RANGE = 11
    CANCELLED = 130

    def __init__(self, code: int, message: str, key: str = "", value: str = "", file: str = "", line: int = 0) -> None:
        super().__init__(message)
        self.code, self.message, self.key, self.value, self.file, self.line = code, message, key, value, file, line

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.code, self.message, self.key, self.value, self.file, self.line)


class Handle:
    """An object of the native library. It is freed when nothing here needs it any more."""

    def __init__(self, kind: str, number: int) -> None:
        self.number = number
        free = getattr(LIBRARY, f"voxelastica_{kind}_free")
        self._freed = weakref.finalize(self, free, number)
        # The process ends anyway.
        self._freed.atexit = False


def _raise(error: c.c_void_p, code: int) -> None:
    """Raises what an error object says, and frees it."""
    if not error.value:
        raise VoxelasticaError(code, f"the native library returned {code} and did not say why")
    try:

        def text(field: str) -> str:
            return (getattr(LIBRARY, f"voxelastica_error_{field}")(error) or b"").decode("utf-8", "replace")

        line = LIBRARY.voxelastica_error_line(error)
        raise VoxelasticaError(code, text("message"), text("key"), text("value"), text("file"), line)
    finally:
        LIBRARY.voxelastica_error_free(error)


def call(name: str, *arguments: Any) -> None:
    """Calls ``voxelastica_<name>``, adding the error's place."""
    error = c.c_void_p()
    code = getattr(LIBRARY, f"voxelastica_{name}")(*arguments, c.byref(error))
    if code:
        _raise(error, code)


def make(kind: str, name: str, *arguments: Any) -> Handle:
    """Calls a function whose output is a handle."""
    number = c.c_void_p()
    call(name, *arguments, c.byref(number))
    return Handle(kind, number.value or 0)


def text(name: str, *arguments: Any) -> str:
    """Calls a function whose output is a text."""
    handle = make("text", name, *arguments)
    length = LIBRARY.voxelastica_text_length(handle.number)
    return c.string_at(LIBRARY.voxelastica_text_data(handle.number), length).decode("utf-8")


def encoded(value: str) -> tuple[bytes, int]:
    """A string as pointer and length."""
    data = value.encode("utf-8", "surrogateescape")
    return data, len(data)


class Watcher:
    """A progress callback as the library calls it; an exception in it cancels the work and is raised afterwards.

    >>> with Watcher(progress) as callback:
    ...     call(..., callback, None, ...)
    """

    def __init__(self, progress: Progress | None) -> None:
        self._progress = progress
        self._raised: BaseException | None = None

    def _tell(self, _user: int | None, done: int, total: int) -> bool:
        try:
            return self._progress(done, total) is not False  # type: ignore[misc]
        except BaseException as error:  # noqa: BLE001 - nothing may pass through C; raised again below
            self._raised = error
            return False

    def __enter__(self) -> Any:
        return PROGRESS(self._tell) if self._progress else PROGRESS()

    def __exit__(self, *_: object) -> None:
        if self._raised is not None:
            raise self._raised


def view(array: Array, letter: str, owner: Handle) -> Any:
    """A lent array as a read-only view that keeps its owner alive: a numpy array where numpy is there, otherwise a
    memoryview. Nothing is copied."""
    kind = _TYPES[letter]
    shape = (array.rows,) if array.columns == 1 else (array.rows, array.columns)
    if array.rows == 0:
        empty = memoryview(bytearray()).cast(letter).toreadonly() if letter != "N" else memoryview((c.c_size_t * 0)())
        return numpy.asarray(empty).reshape(shape) if numpy is not None else empty
    size = c.sizeof(kind)
    step, rest = divmod(array.stride, size)
    if rest:
        raise VoxelasticaError(VoxelasticaError.INTERNAL, f"an array with a stride of {array.stride} bytes")
    # The last row ends with its own columns, not with its stride.
    values = (kind * ((array.rows - 1) * step + array.columns)).from_address(array.data)
    values.owner = owner
    flat = memoryview(values).toreadonly()
    if numpy is not None:
        strides = (array.stride,) if array.columns == 1 else (array.stride, size)
        view = numpy.lib.stride_tricks.as_strided(numpy.asarray(flat), shape, strides, writeable=False)
        return view
    native = {"d": "d", "I": "I", "N": "N", "B": "B"}[letter]
    flat = flat.cast("B").cast(native)
    if array.columns == 1:
        return flat if step == 1 else flat[::step]
    return flat.cast("B").cast(native, shape)


def address(buffer: Any, letter: str, length: int, name: str) -> tuple[int, int]:
    """Address and number of values of a caller's writable, contiguous buffer of one type."""
    try:
        data = memoryview(buffer)
    except TypeError:
        raise TypeError(f"{name} must be a writable buffer, such as a numpy array or an array.array") from None
    if data.readonly or not data.c_contiguous or data.format not in (letter, f"<{letter}"):
        raise TypeError(f"{name} must be writable, contiguous and of type '{letter}', not '{data.format}'")
    count = data.nbytes // data.itemsize
    if count != length:
        problem = f"{name}: this buffer must hold {length} values, not {count}"
        raise VoxelasticaError(VoxelasticaError.WRONG_LENGTH, problem, name, str(count))
    # A ctypes array over the buffer gives its address without copying.
    return c.addressof((c.c_char * data.nbytes).from_buffer(data.cast("B") if data.ndim > 1 else data)), count
