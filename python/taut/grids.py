# SPDX-License-Identifier: MIT
"""Surfaces as grids of rows and columns with holes, as those of unrolled papyri."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ._maps import unwrap
from .errors import FileError, ParameterError


def read(folder: Any) -> Any:
    """A grid, (rows, columns, 3), from a folder with x.tif, y.tif, z.tif; NaN where there is no point.

    A point is none where one of its numbers is -1 or not finite. Needs tifffile.
    """
    import tifffile

    layers = []
    for name in ("x", "y", "z"):
        path = Path(folder) / f"{name}.tif"
        if not path.exists():
            raise FileError(f"{path}: No such file; a grid is x.tif, y.tif and z.tif", path=str(path))
        layers.append(np.asarray(tifffile.imread(path), dtype=np.float64))
    grid = np.stack(layers, axis=-1)
    grid[~np.isfinite(grid).all(-1) | (grid == -1).any(-1)] = np.nan
    return grid


def write(folder: Any, grid: Any) -> None:
    """A grid of 2 or 3 numbers a point as files of float32, -1 where there is no point. Needs tifffile."""
    import tifffile

    Path(folder).mkdir(parents=True, exist_ok=True)
    values = np.asarray(grid, dtype=np.float32)
    values = np.where(np.isfinite(values).all(-1, keepdims=True), values, np.float32(-1))
    for k, name in enumerate(("x", "y", "z")[: values.shape[-1]]):
        tifffile.imwrite(Path(folder) / f"{name}.tif", np.ascontiguousarray(values[..., k]))


def triangles(grid: Any) -> tuple[Any, Any, Any]:
    """Points, triangles, and the number of each point of the grid, -1 where it is of no triangle.

    Squares with four points are two triangles; of parts that touch in single points, or not at all, the largest stays.
    """
    g = np.asarray(grid, dtype=np.float64)
    if g.ndim != 3 or g.shape[2] != 3:
        raise ParameterError(f"grid: has the shape {g.shape}, but must be (rows, columns, 3)", field="grid")
    there: Any = np.isfinite(g).all(-1)
    square: Any = there[:-1, :-1] & there[1:, :-1] & there[:-1, 1:] & there[1:, 1:]
    square = _largest(square)
    r, c = np.nonzero(square)
    if len(r) == 0:
        raise ParameterError("grid: has no square whose four corners are points", field="grid")
    columns = g.shape[1]
    a = r * columns + c
    cells = np.stack([np.c_[a, a + columns, a + columns + 1], np.c_[a, a + columns + 1, a + 1]], 1).reshape(-1, 3)
    cells = _parted(cells)
    used, faces = np.unique(cells, return_inverse=True)
    number = np.full(g.shape[0] * columns, -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return g.reshape(-1, 3)[used], faces.reshape(-1, 3).astype(np.int64), number.reshape(there.shape)


def _largest(square: Any) -> Any:
    """The largest set of squares that hang together by sides."""
    label = np.where(square, np.arange(square.size).reshape(square.shape), -1)
    while True:
        new = label.copy()
        for axis in (0, 1):
            low, high = [slice(None)] * 2, [slice(None)] * 2
            low[axis], high[axis] = slice(None, -1), slice(1, None)
            a, b = new[tuple(low)], new[tuple(high)]
            both = (a >= 0) & (b >= 0)
            most = np.maximum(a, b)
            np.maximum(a, most, out=a, where=both)
            np.maximum(b, most, out=b, where=both)
        flat = new.reshape(-1)
        flat[flat >= 0] = flat[flat[flat >= 0]]
        if (new == label).all():
            break
        label = new
    roots, counts = np.unique(label[label >= 0], return_counts=True)
    return label == roots[counts.argmax()] if len(roots) else square


def _parted(cells: Any) -> Any:
    """Without triangles at points where others touch them in nothing else, until there are none."""
    while len(cells):
        count = int(cells.max()) + 1
        ends = np.sort(np.stack([cells, np.roll(cells, -1, 1)], 2).reshape(-1, 2), 1)
        edges, uses = np.unique(ends, axis=0, return_counts=True)
        rim = np.bincount(edges[uses == 1].reshape(-1), minlength=count)
        if rim.max() <= 2:
            return cells
        cells = cells[~np.isin(cells, np.flatnonzero(rim > 2)).any(1)]
    return cells


def flatten(grid: Any, **options: Any) -> Any:
    """The map of a grid to the plane, (rows, columns, 2), in its units; NaN where there is no point. Holes stay holes.

    options : of `taut.unwrap`.
    """
    points, faces, number = triangles(grid)
    made = unwrap(points, faces, **{"holes": True, **options})
    flat = np.full((*number.shape, 2), np.nan)
    flat[number >= 0] = made.uv[number[number >= 0]]
    return flat
