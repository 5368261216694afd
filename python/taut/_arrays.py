# SPDX-License-Identifier: MIT
"""Arrays of users, looked at before they go to the library: what is wrong names the argument, the row and the value."""

from __future__ import annotations

from typing import Any, Union

import numpy as np
import numpy.typing as npt

from .errors import ParameterError

Array = npt.NDArray[Any]
Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
ArrayLike = Union[npt.ArrayLike, None]

_READ = "fiu"  # kinds of numbers that the library reads where they lie


def _numbers(name: str, value: Any) -> Array:
    try:
        a = np.asarray(value)
        if a.dtype.kind == "c":
            raise TypeError("complex ones")
        if a.dtype.kind not in _READ + "b" or not a.dtype.isnative or a.dtype.itemsize not in (1, 2, 4, 8):
            a = a.astype(np.float64)
        elif a.dtype.kind == "f" and a.dtype.itemsize == 2:
            a = a.astype(np.float32)
    except (TypeError, ValueError) as e:
        raise ParameterError(f"{name}: these are no numbers: {e}", field=name) from None
    return a


def array(name: str, value: Any) -> Floats:
    """Doubles of any shape."""
    return _numbers(name, value).astype(np.float64, copy=False)


def _first(bad: Array) -> tuple[int, ...]:
    return tuple(int(i) for i in np.argwhere(bad)[0])


def _shape(name: str, a: Array, columns: tuple[int, ...]) -> None:
    if a.ndim != 2 or a.shape[1] not in columns:
        words = " or ".join(f"(n, {c})" for c in columns)
        raise ParameterError(f"{name}: has the shape {a.shape}, but must be {words}", field=name)


def points(name: str, value: Any, columns: tuple[int, ...] = (3,), *, rows: int | None = None, nan: bool = False) -> Array:
    """Coordinates, a point a row. Raises `ParameterError` for another shape and for what is not finite."""
    a = _numbers(name, value)
    _shape(name, a, columns)
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


def indices(name: str, value: Any, columns: tuple[int, ...], count: int) -> Array:
    """Vertex numbers, a cell a row. Raises `ParameterError` for what is out of range."""
    a = _numbers(name, value)
    _shape(name, a, columns)
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


def _in_range(name: str, a: Array, count: int) -> Array:
    if a.dtype.kind == "f":
        if a.size and not (np.isfinite(a).all() and (a == np.floor(a)).all()):
            bad = _first(~(a == np.floor(a)) | ~np.isfinite(a))
            raise ParameterError(f"{name}: row {bad[0]} has {a[bad]}, which is no index", field=name, ids=[bad[0]])
        a = a.astype(np.int64)
    if a.dtype.kind == "b":
        a = a.astype(np.int64)
    if a.size and (int(a.min()) < 0 or int(a.max()) >= count):
        bad = _first((a < 0) | (a >= count))
        raise ParameterError(
            f"{name}: row {bad[0]} names {a[bad]}, but numbers go from 0 to {count - 1}", field=name, ids=[bad[0]]
        )
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
