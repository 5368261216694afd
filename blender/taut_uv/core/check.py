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
    result = Result.of(s)
    result.selected = np.zeros(s.faces, bool)
    found, mirrored = flipped_faces(s)
    if flips:
        result.selected[found] = True
        result.numbers["flipped"] = len(found)
    if mirrored:
        result.notes.append(f"{mirrored} mirrored {'island' if mirrored == 1 else 'islands'}")
    if overlaps:
        pairs = overlapping_faces(s)
        result.selected[pairs.reshape(-1)] = True
        result.numbers["overlapping"] = len(np.unique(pairs))
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
    """Pairs of faces whose triangles have an area in common in the plane."""
    triangles = np.flatnonzero(s.chosen[s.triangle_face])
    t = s.uv[s.triangles[triangles]]
    good = np.isfinite(t).all((1, 2))
    triangles, t = triangles[good], t[good]
    turned = orientation(t.reshape(-1, 2), np.arange(3 * len(t)).reshape(-1, 3))
    t[turned < 0] = t[turned < 0][:, ::-1]
    solid = turned != 0
    triangles, t = triangles[solid], t[solid]
    if len(t) == 0:
        return np.zeros((0, 2), np.int64)
    a, b = candidate_pairs(t)
    hit = np.zeros(len(a), bool)
    for i in range(0, len(a), 1 << 20):
        hit[i : i + (1 << 20)] = _have_area_in_common(t[a[i : i + (1 << 20)]], t[b[i : i + (1 << 20)]])
    faces = np.sort(np.c_[s.triangle_face[triangles[a[hit]]], s.triangle_face[triangles[b[hit]]]], 1)
    return np.unique(faces[faces[:, 0] != faces[:, 1]], axis=0)


def candidate_pairs(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of triangles whose boxes meet, each once: by sorting along u in rows of boxes of like height."""
    low, high = t.min(1), t.max(1)
    n = len(t)
    size = np.maximum(np.median(high - low), 1e-12) * 2
    # Cells of a grid that boxes cover; a pair is of the cell with the lower corner of its common box.
    first, last = np.floor(low / size).astype(np.int64), np.floor(high / size).astype(np.int64)
    span = last - first + 1
    if span.prod(1).sum() > 64 * n + 10**6:  # few large ones among many small
        size = np.maximum(np.percentile(high - low, 99), 1e-12)
        first, last = np.floor(low / size).astype(np.int64), np.floor(high / size).astype(np.int64)
        span = last - first + 1
    count = span.prod(1)
    of = np.repeat(np.arange(n), count)
    k = np.arange(len(of)) - np.repeat(np.r_[0, np.cumsum(count)[:-1]], count)
    cell = first[of] + np.c_[k % span[of, 0], k // span[of, 0]]
    order = np.lexsort((cell[:, 1], cell[:, 0]))
    of, cell = of[order], cell[order]
    start = np.flatnonzero(np.r_[True, (cell[1:] != cell[:-1]).any(1)])
    length = np.diff(np.r_[start, len(of)])
    end = np.repeat(start + length, length)
    later = end - np.arange(len(of)) - 1
    i = np.repeat(np.arange(len(of)), later)
    j = i + 1 + np.arange(len(i)) - np.repeat(np.r_[0, np.cumsum(later)[:-1]], later)
    a, b, at = of[i], of[j], cell[i]
    own = (np.maximum(first[a], first[b]) == at).all(1)
    a, b = a[own], b[own]
    meet = (low[a] < high[b]).all(1) & (low[b] < high[a]).all(1)
    return a[meet], b[meet]


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
