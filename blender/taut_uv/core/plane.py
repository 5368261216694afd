# SPDX-License-Identifier: MIT
"""Triangles in the plane and in space: areas, orientation, fits, and coordinates of single precision."""

from __future__ import annotations

from fractions import Fraction

import numpy as np


def areas(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Of triangles in space."""
    return np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1) / 2


def signed_areas(x: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Of triangles in the plane, positive where they run counter-clockwise."""
    a, b = x[F[:, 1]] - x[F[:, 0]], x[F[:, 2]] - x[F[:, 0]]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


def orientation(x: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Signs of triangles in the plane, -1, 0 or 1, exact; 0 also where a coordinate is not finite."""
    finite = np.isfinite(x[F]).all((1, 2))
    with np.errstate(all="ignore"):
        a, b = x[F[:, 1]] - x[F[:, 0]], x[F[:, 2]] - x[F[:, 0]]
        left, right = a[:, 0] * b[:, 1], a[:, 1] * b[:, 0]
        det = left - right
        sign = np.sign(det)
        unsure = ~(np.abs(det) > 1e-14 * (np.abs(left) + np.abs(right))) & finite
    for t in np.flatnonzero(unsure):
        p, q, r = ([Fraction(float(c)) for c in x[v]] for v in F[t])
        exact = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        sign[t] = (exact > 0) - (exact < 0)
    sign[~finite] = 0
    return sign.astype(np.int64)


def rigid_fit(x: np.ndarray, y: np.ndarray, weights: np.ndarray | None = None, *, scaled: bool = False):
    """The rotation (and scale) and shift that bring x nearest to y: a matrix, a vector, the mean squared distance."""
    w = np.ones(len(x)) if weights is None else weights
    w = w / w.sum()
    cx, cy = w @ x, w @ y
    p, q = x - cx, y - cy
    c, s = (w * (p * q).sum(1)).sum(), (w * (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])).sum()
    size = np.hypot(c, s)
    spread = (w * (p * p).sum(1)).sum()
    if size <= 0 or spread <= 0:
        R = np.eye(2)
    else:
        R = np.array([[c, -s], [s, c]]) / (spread if scaled else size)
    error = (w * ((p @ R.T - q) ** 2).sum(1)).sum()
    return R, cy - R @ cx, error


def mirrored(x: np.ndarray) -> np.ndarray:
    """The reflection in u: exact, and its own inverse."""
    return x * np.array([-1.0, 1.0])


_RADII = (1, 2, 4, 16, 64, 256)


def in_single(x: np.ndarray, F: np.ndarray, fixed: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Points as float32 holds them, and the triangles that are flat or flipped then.

    Where a triangle is so, its vertices are moved by a few units of these numbers, where that helps: to the nearest
    place at which all areas around them are positive, or else to the one at which the smallest is largest. fixed :
    (n, 2) bool, coordinates that stay.
    """
    fixed = np.zeros(x.shape, bool) if fixed is None else fixed
    y = x.astype(np.float32).astype(np.float64)
    for _ in range(8):
        bad = np.flatnonzero(orientation(y, F) <= 0)
        if len(bad) == 0:
            return y, bad
        moved = False
        for v in np.unique(F[bad]):
            moved |= _improve(y, F, v, fixed[v])
        if not moved:
            break
    return y, np.flatnonzero(orientation(y, F) <= 0)


def _improve(y: np.ndarray, F: np.ndarray, v: int, fixed: np.ndarray) -> bool:
    """Moves a vertex by some units where the smallest area around it grows."""
    star = F[(F == v).any(1)]
    best, place, here = signed_areas(y, star).min(), None, y[v].copy()
    if fixed.all() or best > 0:
        return False
    unit = np.spacing(np.abs(here).astype(np.float32)).astype(np.float64)
    for r in _RADII:
        for step in ((i, j) for i in (-r, 0, r) for j in (-r, 0, r) if (i, j) != (0, 0)):
            y[v] = (here + np.where(fixed, 0, step) * unit).astype(np.float32)
            least = signed_areas(y, star).min()
            if least > best:
                best, place = least, y[v].copy()
        if best > 0:
            break
    y[v] = here if place is None else place
    return place is not None
