# SPDX-License-Identifier: MIT
"""Arrays of users, looked at before they go to the library: what is wrong names the argument, the row and the value."""

from __future__ import annotations

import os
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from .errors import ParameterError

Array = npt.NDArray[Any]
Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
ArrayLike = Union[npt.ArrayLike, None]

_READ = "fiu"  # kinds of numbers that the library reads where they lie


def _numbers(name: str, value: Any, *, nan: bool = False) -> Array:
    """An array of numbers that the library reads, with NaN for what is masked if that may be."""
    try:
        if isinstance(value, (list, tuple)) and any(isinstance(row, np.ma.MaskedArray) for row in value):
            value = np.ma.array(value)
        if np.ma.is_masked(value):
            if not nan:
                bad = _first(np.ma.getmaskarray(value))
                where = f"row {bad[0]}" if bad else "the value"
                raise ParameterError(f"{name}: {where} is masked; fill it in, or leave it out", field=name, ids=bad[:1])
            value = value.astype(np.float64).filled(np.nan)
        a = np.asarray(value)
        if a.dtype.kind in "cmM":
            raise TypeError(f"they are of the type {a.dtype}")
        if a.dtype.kind not in _READ + "b" or not a.dtype.isnative or a.dtype.itemsize not in (1, 2, 4, 8):
            with np.errstate(over="ignore"):  # is said of the row, as of other infinite numbers
                a = a.astype(np.float64)
        elif a.dtype.kind == "f" and a.dtype.itemsize == 2:
            a = a.astype(np.float32)
        if any(step % a.itemsize for step in a.strides):  # of records, whose columns lie anywhere
            a = a.copy()
    except (TypeError, ValueError, OverflowError) as e:
        if isinstance(e, ParameterError):
            raise
        raise ParameterError(f"{name}: {_no_numbers(value, e)}", field=name) from None
    if value is None:
        raise ParameterError(f"{name}: is None, but must be an array of numbers", field=name)
    return a


def _no_numbers(value: Any, error: Exception) -> str:
    """Why an argument is no array of numbers."""
    if isinstance(value, (str, os.PathLike)):
        return f"is {str(value)!r}, which is no array; taut.read() reads files"
    if "inhomogeneous" in str(error):
        sizes = [len(row) if hasattr(row, "__len__") else 0 for row in value]
        other = next((k for k, size in enumerate(sizes) if size != sizes[0]), None)
        if other is not None:
            return f"row {other} has {sizes[other]} numbers, and row 0 has {sizes[0]}; all rows must have as many"
    return f"these are no numbers: {error}"


def shape(value: Any) -> tuple[int, ...]:
    """The shape of an array, or of lists as one; () of what is none, as of rows of several lengths."""
    try:
        return np.shape(value)
    except (TypeError, ValueError):
        return ()


def path(name: str, value: Any) -> str:
    """The name of a file. Raises `ParameterError` for what is none, or would be another file's."""
    try:
        text = os.fsdecode(value)
        text.encode()
    except TypeError:
        raise ParameterError(f"{name}: is {value!r}, but must be the name of a file", field=name) from None
    except UnicodeError:
        raise ParameterError(f"{name}: is {value!r}, which is no UTF-8; rename the file or its folder", field=name) from None
    if "\0" in text:
        raise ParameterError(f"{name}: is {text!r}, but no name of a file has the character 0", field=name)
    return text


def array(name: str, value: Any, *, nan: bool = False) -> Floats:
    """Doubles of any shape, with NaN for what is masked if that may be."""
    return _numbers(name, value, nan=nan).astype(np.float64, copy=False)


def _first(bad: Array) -> tuple[int, ...]:
    return tuple(int(i) for i in np.argwhere(bad)[0])


def _shape(name: str, a: Array, columns: tuple[int, ...]) -> Array:
    """The array, looked at; an empty one of one dimension, as of an empty list, has no rows."""
    if a.shape == (0,):
        return a.reshape(0, columns[0])
    if a.ndim == 2 and a.shape[1] in columns:
        return a
    words = " or ".join(f"(n, {c})" for c in columns)
    remedy = ""
    if a.ndim == 2 and a.shape[0] in columns:
        remedy = "; it may be transposed"
    elif a.ndim == 1:
        remedy = "; reshape it to one row each"
    elif a.ndim == 2 and columns == (3,) and a.shape[1] == 4 and a.dtype.kind in "iu":
        remedy = "; split quads into triangles"
    raise ParameterError(f"{name}: has the shape {a.shape}, but must be {words}{remedy}", field=name)


def points(name: str, value: Any, columns: tuple[int, ...] = (3,), *, rows: int | None = None, nan: bool = False) -> Array:
    """Coordinates, a point a row. Raises `ParameterError` for another shape and for what is not finite."""
    a = _shape(name, _numbers(name, value, nan=nan), columns)
    if rows is not None and a.shape[0] != rows:
        raise ParameterError(f"{name}: has {a.shape[0]} rows, but must have {rows}", field=name)
    if a.dtype.kind == "f":
        bad = ~np.isfinite(a)
        if nan:
            bad &= ~np.isnan(a)
        if bad.any():
            r, c = _first(bad)
            raise ParameterError(f"{name}: row {r} has {a[r, c]} in column {c}", field=name, ids=[r])
    return a


def pins(name: str, value: Any, columns: tuple[int, ...], *, rows: int | None = None) -> Array:
    """Places of pins, a pin a row; NaN leaves a coordinate free, but not all of a row."""
    a = points(name, value, columns, rows=rows, nan=True)
    free = np.flatnonzero(np.isnan(a).all(1)) if a.dtype.kind == "f" else np.zeros(0, int)
    if free.size:
        raise ParameterError(f"{name}: row {free[0]} is NaN, which pins no coordinate; leave it out", field=name,
                             ids=[int(k) for k in free])
    return a


def indices(name: str, value: Any, columns: tuple[int, ...], count: int) -> Array:
    """Vertex numbers, a cell a row. Raises `ParameterError` for what is out of range."""
    a = _shape(name, _numbers(name, value), columns)
    if a.dtype.kind == "b" and a.size:
        raise ParameterError(f"{name}: are flags, but must be vertex numbers", field=name)
    return _in_range(name, a, count)


def ids(name: str, value: Any, count: int) -> Array:
    """Vertex or cell numbers, one dimension; an array of flags gives those that are set."""
    a = _numbers(name, value)
    if a.ndim != 1:
        raise ParameterError(f"{name}: has the shape {a.shape}, but must be (k,)", field=name)
    if a.dtype.kind == "b":
        if len(a) != count:
            raise ParameterError(f"{name}: has {len(a)} flags, but must have {count}", field=name)
        return np.flatnonzero(a)
    return _in_range(name, a, count)


def vertex(name: str, value: Any, count: int) -> int:
    """The number of one vertex."""
    a = _numbers(name, value)
    if a.ndim:
        raise ParameterError(f"{name}: has the shape {a.shape}, but must be one vertex", field=name)
    return int(ids(name, a.reshape(1), count)[0])


def number(name: str, value: Any) -> float:
    """One number, of any value."""
    try:
        if value is np.ma.masked:
            raise ValueError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise ParameterError(f"{name}: is {value!r}, but must be a number", field=name) from None


def whole(name: str, value: Any, least: int = 0, *, cap: bool = False) -> int:
    """One whole number that 32 bits hold, which may be given as a float; cap: larger ones are the largest of these."""
    try:
        n = int(value)
        fits = n == value and n >= least
    except (TypeError, ValueError, OverflowError, np.ma.MaskError):
        fits = False
    if fits and cap:
        n = min(n, 2**31 - 1)
    if not fits or n >= 2**31:
        raise ParameterError(f"{name}: is {value!r}, but must be a whole number, {least} or more", field=name)
    return n


def _in_range(name: str, a: Array, count: int) -> Array:
    if a.dtype.kind == "f":
        broken = ~np.isfinite(a) | (a != np.floor(a))
        if broken.any():
            bad = _first(broken)
            raise ParameterError(f"{name}: row {bad[0]} has {a[bad]}, which is no index", field=name, ids=[bad[0]])
    outside = (a < 0) | (a >= count)
    if outside.any():
        bad = _first(outside)
        numbers = f"numbers go from 0 to {count - 1}" if count else "there are none"
        raise ParameterError(f"{name}: row {bad[0]} names {int(a[bad])}, but {numbers}", field=name, ids=[bad[0]])
    return a.astype(np.int64) if a.dtype.kind in "fb" else a


def labels(name: str, value: Any, rows: int, *, least: int | None = 0) -> Array:
    """Whole numbers, one a row, that only say which rows belong together; least: the smallest that there may be."""
    a = _shape_of_rows(name, _numbers(name, value), rows)
    low, high = (-(2**63), 2**63) if least is None else (least, 2**31)
    with np.errstate(invalid="ignore"):
        bad = ~((a == np.floor(a)) & (a >= low) & (a < high)) if a.dtype.kind == "f" else (a < low) | (a >= high)
    if bad.any():
        r = _first(bad)[0]
        raise ParameterError(f"{name}: row {r} has {a[r]}, but must be a whole number, from {low} to {high - 1}",
                             field=name, ids=[r])
    return a.astype(np.int64)


def _shape_of_rows(name: str, a: Array, rows: int) -> Array:
    if a.ndim != 1:
        raise ParameterError(f"{name}: has the shape {a.shape}, but must be (n,)", field=name)
    if a.shape[0] != rows:
        raise ParameterError(f"{name}: has {a.shape[0]} rows, but must have {rows}", field=name)
    return a


def numbers(name: str, value: Any, rows: int | None = None, *, columns: bool = False) -> Array:
    """Finite numbers, one a row (or with `columns` several)."""
    a = _numbers(name, value)
    if a.ndim == 0 and rows is not None:
        a = np.full(rows, a)
    if a.ndim != 1 and not (columns and a.ndim == 2):
        raise ParameterError(f"{name}: has the shape {a.shape}, but must be (n,)", field=name)
    if rows is not None and a.shape[0] != rows:
        raise ParameterError(f"{name}: has {a.shape[0]} rows, but must have {rows}", field=name)
    if a.dtype.kind == "f" and not np.isfinite(a).all():
        bad = _first(~np.isfinite(a))
        raise ParameterError(f"{name}: row {bad[0]} has {a[bad]}", field=name, ids=[bad[0]])
    return a
