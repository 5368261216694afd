# SPDX-License-Identifier: MIT
"""Surfaces as grids of rows and columns with holes, as those of unrolled papyri."""

from __future__ import annotations

import io
import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from . import _arrays
from ._files import write_bytes
from ._maps import at_scale, certify, unwrap
from .errors import FileError, ParameterError

_NAMES = ("x", "y", "z")

#: How far steps may be from what the scale of meta.json says.
_LIKE = 1.1


def read(folder: Any) -> Any:
    """A grid, (rows, columns, 3), from a folder with x.tif, y.tif, z.tif; NaN where there is no point.

    Without z.tif it is of the plane, (rows, columns, 2). There is no point where all numbers are -1, or one is not
    finite. Warns where the `scale` of meta.json, points by units along columns and rows, is not that of the points.
    Needs tifffile.
    """
    import tifffile

    folder = _arrays.path("folder", folder)
    layers: list[Any] = []
    for name in _NAMES:
        path = Path(folder) / f"{name}.tif"
        if not path.exists():
            if name == "z":
                break
            raise FileError(f"{path}: No such file; a grid is x.tif, y.tif and z.tif", path=str(path))
        try:
            layer = _arrays.array(name, tifffile.imread(path))
        except Exception as e:  # of any kind, as broken files raise them
            raise FileError(f"{path}: is no image of numbers: {e}", path=str(path)) from None
        if layer.ndim != 2 or layer.shape != (layers or [layer])[0].shape:
            raise FileError(
                f"{path}: has the shape {layer.shape}, but must have rows and columns, as many as x.tif; it may be of "
                "another grid", path=str(path),
            )
        layers.append(layer)
    grid = np.stack(layers, axis=-1)
    grid[~np.isfinite(grid).all(-1) | (grid == -1).all(-1)] = np.nan
    _compare(Path(folder) / "meta.json", grid)
    return grid


def write(folder: Any, grid: Any, *, like: Any = None) -> None:
    """A grid of 2 or 3 numbers a point as files of float32, -1 where there is no point, as where it is masked. Needs
    tifffile.

    meta.json gets the `scale` and `bbox` of the points; all else in it stays as it is in the folder, or in `like`,
    another one. A map of the plane is refused where float32 would turn over what is positive: `flatten` makes none.
    """
    import tifffile

    g = _arrays.array("grid", grid, nan=True)
    if g.ndim != 3 or g.shape[2] not in (2, 3):
        raise ParameterError(f"grid: has the shape {g.shape}, but must be (rows, columns, 2 or 3)", field="grid")
    place = Path(_arrays.path("folder", folder))
    like = None if like is None else _arrays.path("like", like)
    if g.shape[2] == 2 and (place / "z.tif").exists():
        raise FileError(f"{place / 'z.tif'}: is of another grid, and this one has no z; remove it, or choose another "
                        "folder", path=str(place / "z.tif"))
    with np.errstate(over="ignore"):
        values = g.astype(np.float32)
    there: Any = np.isfinite(g).all(-1)
    for what, bad in (("numbers beyond single precision", ~np.isfinite(values).all(-1)),
                      ("-1 in all numbers, which the files have where there is no point", (values == -1).all(-1))):
        if (there & bad).any():
            r, c = np.argwhere(there & bad)[0]
            raise ParameterError(f"grid: row {r}, column {c} has {what}; move or scale the grid", field="grid")
    if g.shape[2] == 2:
        _require_positive(g, values, there)
    if like is not None and not Path(like).is_dir():
        raise FileError(f"{like}: is no folder; `like` is one with a grid", path=str(like))
    meta = _meta(Path(like) if like is not None else place)
    if like is None and not meta and g.shape[2] == 3:
        meta = {"format": "tifxyz", "type": "seg", "uuid": place.resolve().name}
    known = g[there]
    meta["scale"] = [float(1 / s) if s > 0 else 1.0 for s in steps(np.where(there[..., None], g, np.nan))]
    meta["bbox"] = [known.min(0).tolist(), known.max(0).tolist()] if len(known) else []
    values[~there] = -1
    files: dict[Any, bytes] = {}
    for k in range(g.shape[2]):
        image = io.BytesIO()
        tifffile.imwrite(image, np.ascontiguousarray(values[..., k]))
        files[place / f"{_NAMES[k]}.tif"] = image.getvalue()
    files[place / "meta.json"] = (json.dumps(meta, indent=1) + "\n").encode()
    try:
        place.mkdir(parents=True, exist_ok=True)
    except OSError as e:
        raise FileError(f"{place}: {e.strerror}; name a folder", path=str(place)) from None
    write_bytes(files)


def steps(grid: Any) -> tuple[float, float]:
    """Usual lengths from a point to the next one along a row and along a column; NaN where there are none."""
    g = _arrays.array("grid", grid, nan=True)
    if g.ndim != 3:
        raise ParameterError(f"grid: has the shape {g.shape}, but must be (rows, columns, 2 or 3)", field="grid")
    found = []
    for axis in (1, 0):
        lengths = np.linalg.norm(np.diff(g, axis=axis), axis=-1)
        lengths = lengths[np.isfinite(lengths)]
        found.append(float(np.median(lengths)) if len(lengths) else float("nan"))
    return found[0], found[1]


def _meta(folder: Path) -> dict[str, Any]:
    """What meta.json of a folder says; nothing where there is none."""
    path = folder / "meta.json"
    if not path.exists():
        return {}
    try:
        meta = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as e:
        raise FileError(f"{path}: cannot be read: {e}", path=str(path)) from None
    if not isinstance(meta, dict):
        raise FileError(f"{path}: is no object of JSON", path=str(path))
    return meta


def _compare(path: Path, grid: Any) -> None:
    """Warns of a scale that is not that of the points."""
    scale = _meta(path.parent).get("scale")
    if scale is None:
        return
    try:
        along = [float(s) for s in scale]
    except (TypeError, ValueError):
        along = []
    if len(along) != 2 or not all(0 < s < np.inf for s in along):
        raise FileError(f"{path}: `scale` is {scale!r}, but must be two positive numbers", path=str(path))
    for s, step, line in zip(along, steps(grid), ("row", "column")):
        if step > 0 and not 1 / _LIKE < s * step < _LIKE:
            warnings.warn(
                f"{path}: `scale` says {1 / s:.6g} from point to point along a {line}, but it is {step:.6g}; the points "
                "are taken as they are", stacklevel=3,
            )


def _require_positive(grid: Any, values: Any, there: Any) -> None:
    """Raises `ParameterError` where triangles are positive in a map, and not in its rounded numbers."""
    cells = _halves(_squares(there))
    if len(cells) == 0:
        return
    flat = np.where(there[..., None], grid, 0.0).reshape(-1, 2)
    rounded = np.where(there[..., None], values, 0.0).reshape(-1, 2)
    turned = certify(cells, flat).flipped
    if 2 * len(turned) > len(cells):  # a mirrored map
        cells = cells[:, ::-1]
        turned = certify(cells, flat).flipped
    lost = np.setdiff1d(certify(cells, rounded).flipped, turned)
    if len(lost):
        r, c = divmod(int(cells[lost[0]].min()), grid.shape[1])
        raise ParameterError(
            f"grid: float32 turns over {len(lost)} triangles, as that at row {r}, column {c}; take the map that "
            "grids.flatten() makes, or scale it", field="grid",
        )


def triangles(grid: Any) -> tuple[Any, Any, Any]:
    """Points, triangles, and the number of each point of the grid, -1 where it is of no triangle.

    Squares with four points are two triangles; of parts that touch in single points, or not at all, the largest stays.
    """
    g = _arrays.array("grid", grid, nan=True)
    if g.ndim != 3 or g.shape[2] != 3:
        raise ParameterError(f"grid: has the shape {g.shape}, but must be (rows, columns, 3)", field="grid")
    there: Any = np.isfinite(g).all(-1)
    square = _largest(_squares(there))
    if not square.any():
        raise ParameterError("grid: has no square whose four corners are points", field="grid")
    cells = _parted(_halves(square))
    used, faces = np.unique(cells, return_inverse=True)
    number = np.full(there.size, -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return g.reshape(-1, 3)[used], faces.reshape(-1, 3).astype(np.int64), number.reshape(there.shape)


def _squares(there: Any) -> Any:
    """Whether each square has its four points."""
    return there[:-1, :-1] & there[1:, :-1] & there[:-1, 1:] & there[1:, 1:]


def _halves(square: Any) -> Any:
    """The triangles of squares."""
    r, c = np.nonzero(square)
    columns = square.shape[1] + 1
    a = r * columns + c
    return np.stack([np.c_[a, a + columns, a + columns + 1], np.c_[a, a + columns + 1, a + 1]], 1).reshape(-1, 3)


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

    Its numbers are those of float32, as `write` has them, and it is certified as these.

    options : of `taut.unwrap`, but for `cut` and what would change lengths.
    """
    points, faces, number = triangles(grid)
    made = unwrap(points, faces, **at_scale(options, "grids", single=True))
    flat = np.full((*number.shape, 2), np.nan)
    flat[number >= 0] = made.uv[number[number >= 0]]
    return flat
