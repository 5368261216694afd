# SPDX-License-Identifier: MIT
"""Charts of the plane, packed into tiles."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arrays
from ._arrays import Array, ArrayLike, Ints
from ._call import ProgressLike, call
from ._native import native
from ._results import Packed
from .errors import ParameterError


def _charts(F: Array, count: int) -> Ints:
    """The connected part that each triangle is of; parts are numbered by their first triangles."""
    label = np.arange(count)
    while True:
        low = label[F].min(1)
        new = label.copy()
        np.minimum.at(new, F.reshape(-1), np.repeat(low, 3))
        new = new[new]
        if (new == label).all():
            break
        label = new
    return np.unique(label[F[:, 0]], return_inverse=True)[1].reshape(-1).astype(np.int64)


def _walls(uv: Array, F: Array, chart: Ints, triangles: Ints, tiles: int) -> tuple[Ints, Array, Ints]:
    """Open edges of charts that stay: tile and two ends in it of each, and the tile of each triangle."""
    F, chart = F[triangles], np.unique(chart[triangles], return_inverse=True)[1].reshape(-1)
    low, high = np.full((chart.max() + 1, 2), np.inf), np.full((chart.max() + 1, 2), -np.inf)
    corners = uv[F]
    np.minimum.at(low, chart, corners.min(1))
    np.maximum.at(high, chart, corners.max(1))
    square = np.floor((low + high) / 2)
    number = (10 * square[:, 1] + square[:, 0]).astype(np.int64)
    inside = (square[:, 0] >= 0) & (square[:, 0] < 10) & (square[:, 1] >= 0) & (number < tiles)
    inside &= (low >= square).all(1) & (high <= square + 1).all(1)
    if not inside.all():
        t = int(triangles[np.flatnonzero(~inside[chart])[0]])
        raise ParameterError(f"fixed: the chart of triangle {t} leaves its tile; move it there, or do not fix it",
                             field="fixed", ids=[t])
    ends = np.stack([F, np.roll(F, -1, 1)], 2).reshape(-1, 2)
    _, inverse, times = np.unique(np.sort(ends, 1), axis=0, return_inverse=True, return_counts=True)
    open_edges = np.flatnonzero(times[inverse.reshape(-1)] == 1)
    of = chart[open_edges // 3]
    return number[of], (uv[ends[open_edges]] - square[of][:, None]).reshape(-1, 2), number[chart]


def pack(
    uv: ArrayLike,
    F: ArrayLike,
    *,
    fixed: ArrayLike = None,
    resolution: int = 1024,
    padding: float = 2,
    tiles: int = 1,
    rotate: bool = True,
    densities: ArrayLike = None,
    time_limit: float | None = None,
    progress: ProgressLike = None,
) -> Packed:
    """Pack charts of the plane into tiles: all at one scale, rotated and translated, never mirrored.

    Parameters
    ----------
    uv, F : (n, 2) and (m, 3) array-like
        Points and triangles; those that share vertices are a chart. What they are like does not matter: a chart that
        is folded keeps others from all that it covers.
    fixed : (m,) array-like of bool, optional
        Triangles whose charts stay where they are, each within a tile. The others keep their distance from them.
    resolution, padding, tiles, rotate
        Texels along a tile; least distance of charts in texels; how many tiles; whether charts are turned.
    densities : (m,) array-like, optional
        Factors of lengths of triangles; that of a chart is the mean of its own. Refused where all charts are fixed.
    time_limit, progress
        As in `unwrap`; the best layout so far is returned.

    Returns
    -------
    Packed
        Unpacks as `uv, tile`.

    Examples
    --------
    >>> import taut
    >>> uv, tile = taut.pack([[0, 0], [9, 0], [0, 9], [5, 5], [9, 5], [5, 9]], [[0, 1, 2], [3, 4, 5]])
    >>> bool((uv > 0).all() and (uv < 1).all()), tile.tolist()
    (True, [0, 0])
    """
    points = np.asarray(_arrays.points("uv", uv, (2,)), dtype=np.float64)
    faces = np.asarray(_arrays.indices("F", F, (3,), len(points)), dtype=np.int64)
    m, tiles = len(faces), _arrays.whole("tiles", tiles, 1)
    chart = _charts(faces, len(points)) if m else np.zeros(0, np.int64)
    stays = np.zeros(m, bool) if fixed is None else np.asarray(_arrays.numbers("fixed", fixed, m)) != 0
    stays = np.isin(chart, chart[stays])
    made_uv, tile = points.copy(), np.zeros(m, np.int64)
    options: dict[str, Any] = {
        "resolution": resolution,
        "padding": padding,
        "tiles": tiles,
        "rotate": rotate,
        "time_limit": time_limit,
        "rounding": max(1e-6, 4 * float(np.spacing(np.float32(max(min(tiles, 10), -(-tiles // 10)))))),
    }
    if stays.any():
        found = _walls(points, faces, chart, np.flatnonzero(stays), tiles)
        options["wall_tiles"], options["wall_ends"], tile[stays] = found
    if stays.any() and stays.all() and densities is not None:
        raise ParameterError("densities: have no effect, as all charts are fixed; leave them out, or fix fewer",
                             field="densities")
    moved = np.flatnonzero(~stays)
    moved = moved[np.argsort(chart[moved], kind="stable")]
    own = np.unique(chart[moved], return_inverse=True)[1].reshape(-1)
    first_cell = np.r_[0, np.cumsum(np.bincount(own))]
    of_vertex = np.full(len(points), -1)
    of_vertex[faces[moved]] = own[:, None]
    vertices = np.flatnonzero(of_vertex >= 0)
    vertices = vertices[np.argsort(of_vertex[vertices], kind="stable")]
    first_vertex = np.r_[0, np.cumsum(np.bincount(of_vertex[vertices]))]
    number = np.full(len(points), -1)
    number[vertices] = np.arange(len(vertices))
    if densities is not None:
        factors = np.asarray(_arrays.numbers("densities", densities, m), dtype=np.float64)[moved]
        options["densities"] = np.bincount(own, factors) / np.bincount(own)

    moving = points[vertices]
    size = np.frexp(np.abs(moving).max(initial=0))[1]
    power = 0 if abs(size) < 300 else -int(size)  # areas of others are no doubles

    def make(d: dict[str, Any]) -> Packed:
        if not len(moved):
            return Packed(made_uv, chart, tile, 1.0, 0.0, True)
        places = d["tile"]
        shift = np.c_[places % 10 - places, places // 10]  # rows of ten tiles
        made_uv[vertices] = d["uv"] + shift[of_vertex[vertices]]
        tile[moved] = places[own]
        return Packed(made_uv, chart, tile, float(np.ldexp(d["scale"], power)), d["utilization"], d["complete"])

    return call(native().pack, np.ldexp(moving, power), number[faces[moved]], first_cell, first_vertex, options,
                progress=progress, make=make)
