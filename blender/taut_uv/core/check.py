# SPDX-License-Identifier: MIT
"""Check: flipped and overlapping faces of a UV map."""

from __future__ import annotations

import numpy as np

from .islands import islands_of
from .messages import Trouble
from .plane import areas, orientation, signed_areas
from .surface import Surface
from .work import Result, untold


def check(taut, s: Surface, *, flips: bool = True, overlaps: bool = True, time_limit: float = 0, tell=untold) -> Result:
    """Select faces that are flipped within their islands, and faces that overlap others. Nothing else changes.

    An island that is mirrored as a whole has no flips; a note counts such islands.
    """
    if not s.chosen.any():
        raise Trouble("no face is selected; select those to be looked at, or all")
    if not (flips or overlaps):
        raise Trouble("there is nothing to look for; turn on Flipped, Overlapping, or both")
    result = Result.of(s)
    result.selected = np.zeros(s.faces, bool)
    found, mirrored = flipped_faces(s)
    if flips:
        result.selected[found] = True
        result.numbers["flipped"] = len(found)
    if mirrored:
        result.notes.append(f"{mirrored} mirrored {'island' if mirrored == 1 else 'islands'}")
    if overlaps:
        found = overlapping_faces(s)
        result.selected[found] = True
        result.numbers["overlapping"] = len(found)
    return result


def flipped_faces(s: Surface) -> tuple[np.ndarray, int]:
    """Faces with a triangle that runs against its island, or is flat in the plane alone; how many islands mirror."""
    bad, mirrored = [], 0
    for island in islands_of(s, by_uv=True):
        x = s.uv[s.triangles[island.triangles]].reshape(-1, 2)
        F = np.arange(len(x)).reshape(-1, 3)
        sign = orientation(x, F)
        solid = areas(island.V, island.F) > 0
        size = np.abs(signed_areas(x, F))
        mirror = np.nansum(sign * np.where(np.isfinite(size), size, 0)) < 0
        mirrored += bool(mirror)
        wrong = (-sign if mirror else sign) <= 0
        bad.append(s.triangle_face[island.triangles[wrong & solid]])
    return np.unique(np.concatenate(bad)), mirrored


def overlapping_faces(s: Surface) -> np.ndarray:
    """Faces with a triangle that has an area in common with one of another face in the plane."""
    triangles = np.flatnonzero(s.chosen[s.triangle_face])
    t = s.uv[s.triangles[triangles]]
    good = np.isfinite(t).all((1, 2))
    triangles, t = triangles[good], t[good]
    turned = orientation(t.reshape(-1, 2), np.arange(3 * len(t)).reshape(-1, 3))
    t[turned < 0] = t[turned < 0][:, ::-1]
    solid = turned != 0
    t, face = t[solid], s.triangle_face[triangles[solid]]
    found = np.zeros(s.faces, bool)
    for a, b in candidate_pairs(t, face, found):
        hit = _have_area_in_common(t[a], t[b])
        found[face[a[hit]]] = found[face[b[hit]]] = True
    return np.flatnonzero(found)


#: Pairs that are looked at together.
_TOGETHER = 1 << 19


def candidate_pairs(t: np.ndarray, face: np.ndarray, found: np.ndarray):
    """Pairs of triangles of different faces whose boxes meet, some at a time: all but those of two faces that are found
    by then. So faces that all lie on each other take no more than those that lie apart.

    found : (f,) bool, which the caller sets
    """
    low, high = t.min(1), t.max(1)
    level = np.frexp((high - low).max(1))[1]  # boxes are smaller than squares of a side of 2^level: 4 of these, at most
    for at in np.unique(level):
        many, few = _squares(low, high, level <= at, at), _squares(low, high, level == at, at)
        for own, others in _joined(many, few, face, found):
            apart = (face[own] != face[others]) & ~(found[face[own]] & found[face[others]])
            own, others = own[apart], others[apart]
            meet = (low[own] < high[others]).all(1) & (low[others] < high[own]).all(1)
            yield own[meet], others[meet]


def _squares(low: np.ndarray, high: np.ndarray, some: np.ndarray, level: int) -> tuple[np.ndarray, np.ndarray]:
    """The squares of a grid that boxes meet, each as a complex number, in order, and the triangle of each box."""
    triangle = np.flatnonzero(some)
    first, last = (np.floor(np.ldexp(corner[triangle], -level)) for corner in (low, high))
    sides = [(i, j) for i in (0, 1) for j in (0, 1)]
    squares = [np.where(i, last[:, 0], first[:, 0]) + 1j * np.where(j, last[:, 1], first[:, 1]) for i, j in sides]
    new = [((first[:, 0] < last[:, 0]) | (i == 0)) & ((first[:, 1] < last[:, 1]) | (j == 0)) for i, j in sides]
    square, of = np.concatenate([a[k] for a, k in zip(squares, new)]), np.concatenate([triangle[k] for k in new])
    order = np.argsort(square, kind="stable")
    return square[order], of[order]


def _joined(many, few, face: np.ndarray, found: np.ndarray):
    """Pairs of triangles with a square in common: some of each where there are many, which find most that lie on each
    other; then those of triangles that are not found."""
    (square, own), (other_square, other) = many, few
    begin, end = (np.searchsorted(other_square, square, side) for side in ("left", "right"))
    crowded = end - begin > 64
    for k in range(8):
        there = np.flatnonzero(crowded & ~found[face[own]])
        for i in range(0, len(there), _TOGETHER):
            yield own[there[i : i + _TOGETHER]], other[begin[there[i : i + _TOGETHER]] + k]
    left = ~found[face[own]]
    yield from _expanded(own[left], begin[left], end[left], other)
    left = ~found[face[other]]
    begin, end = (np.searchsorted(square, other_square[left], side) for side in ("left", "right"))
    yield from _expanded(other[left], begin, end, own)


def _expanded(own: np.ndarray, begin: np.ndarray, end: np.ndarray, other: np.ndarray):
    """Each of `own` with others from begin to end."""
    after = np.cumsum(end - begin)
    total = int(after[-1]) if len(after) else 0
    for i in range(0, total, _TOGETHER):
        pair = np.arange(i, min(i + _TOGETHER, total))
        of = np.searchsorted(after, pair, "right")
        yield own[of], other[end[of] - (after[of] - pair)]


def _have_area_in_common(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Whether counter-clockwise triangles overlap: no side of either has the other one on its outer side.

    A side that is common, or that is only touched, parts. Signs within rounding count as touching.
    """
    hit = np.ones(len(p), bool)
    for one, other in ((p, q), (q, p)):
        for k in range(3):
            a, d = one[:, k], one[:, (k + 1) % 3] - one[:, k]
            e = other - a[:, None]
            left, right = d[:, None, 0] * e[:, :, 1], d[:, None, 1] * e[:, :, 0]
            outside = left - right <= 1e-13 * (np.abs(left) + np.abs(right))
            hit &= ~outside.all(1)
    return hit
