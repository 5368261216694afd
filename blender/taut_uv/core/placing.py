# SPDX-License-Identifier: MIT
"""Where islands come to lie, and how they are written."""

from __future__ import annotations

import numpy as np

from .islands import Island
from .messages import Problem, about_faces
from .plane import in_single, mirrored, signed_areas
from .surface import Surface
from .work import Clock, Result

#: Of faces that are drawn by triangles without an area, which the map could not make good.
CUT_FLAT = "a straight corner, at which Blender cuts off a triangle without an area; triangulate the face (Ctrl T)"


def pack_islands(taut, result: Result, placed, loose, padding: float, resolution: int, rotate: bool, clock: Clock):
    """Maps of the loose islands, packed into the unit square around those that are placed, where these lie in it."""
    inside = [p for p in placed if (p[1] >= 0).all() and (p[1] <= 1).all()]
    if len(inside) < len(placed):
        result.notes.append(f"pinned islands that leave the unit square ({len(placed) - len(inside)}) are not kept off")
    parts = inside + loose
    first = np.cumsum([0] + [len(x) for _, x, _ in parts])
    uv = np.concatenate([x for _, x, _ in parts])
    F = np.concatenate([i.F + at for (i, _, _), at in zip(parts, first)])
    fixed = np.repeat([True] * len(inside) + [False] * len(loose), [len(i.F) for i, _, _ in parts])
    try:
        made = taut.pack(
            uv, F, fixed=fixed, padding=padding, resolution=resolution, rotate=rotate, time_limit=clock.left
        )
    except taut.Cancelled as e:
        result.complete = False
        if e.best is None:
            return side_by_side(loose)
        made = e.best
    except taut.TautError as e:
        result.notes.append(f"islands are not packed: {e}")
        return side_by_side(loose)
    at = first[len(inside) :]
    return [(island, made.uv[i : i + len(x)], pins) for (island, x, pins), i in zip(loose, at)]


def side_by_side(loose):
    """The islands in a row of the unit square: what is left where there is no time to pack them."""
    sizes = [np.maximum(np.ptp(x, axis=0), 1e-12) for _, x, _ in loose]
    width, height = sum(w for w, _ in sizes), max(h for _, h in sizes)
    scale, at, made = 0.9 / max(width, height), 0.0, []
    gap = 0.1 / (len(loose) + 1)
    for (island, x, pins), (w, _) in zip(loose, sizes):
        at += gap
        made.append((island, (x - x.min(0)) * scale + [at, 0.05], pins))
        at += w * scale
    return made


def write_island(s: Surface, result: Result, island: Island, x: np.ndarray, fixed: np.ndarray) -> Problem | None:
    """Writes the map of an island as single precision holds it. Triangles that this flattens are a problem, and so are
    those of Blender where it cuts a face in another way."""
    other, faces = island.drawn_otherwise(s)
    F = np.concatenate([island.F, other])
    faces = np.concatenate([s.triangle_face[island.triangles], faces])
    if signed_areas(x, island.F).sum() < 0:  # pins may mirror an island
        y, flat = in_single(mirrored(x), F, fixed)
        y = mirrored(y)
    else:
        y, flat = in_single(x, F, fixed)
    result.uv[island.corners] = y[island.local]
    result.changed[island.corners] = True
    if len(flat) == 0:
        return None
    if flat[0] >= len(island.F):
        return about_faces(s, faces[flat], CUT_FLAT)
    return about_faces(
        s, faces[flat], "too small for the numbers of UV maps; scale the island up, or dissolve what is so small"
    )
