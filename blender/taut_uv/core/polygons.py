# SPDX-License-Identifier: MIT
"""How faces are cut into triangles."""

from __future__ import annotations

import numpy as np

from .messages import listed
from .surface import Surface
from .work import Result

#: Area by the square of the longest side, below which a triangle is flat for coordinates of single precision.
_FLAT = 1e-6


def fullness(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Area of triangles by the square of their longest side."""
    sides = np.roll(V[F], -1, 1) - V[F]
    longest = (sides**2).sum(2).max(1)
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
    return area / np.maximum(longest, 1e-300)


def without_flat(V: np.ndarray, vertex: np.ndarray, triangles: np.ndarray, face: np.ndarray) -> np.ndarray:
    """Triangles of corners; quads with a straight corner are cut along their other diagonal where else one of the two
    triangles has no area.

    vertex : of corners; face : of triangles, those of a face behind each other
    """
    full = fullness(V, vertex[triangles])
    pair = np.flatnonzero((face[1:] == face[:-1]))
    count = np.bincount(face)
    pair = pair[(count[face[pair]] == 2) & (np.minimum(full[pair], full[pair + 1]) < _FLAT)]
    made = triangles.copy()
    for t in pair:
        a, b = triangles[t], triangles[t + 1]
        common = [c for c in a if c in b]
        if len(common) != 2:
            continue
        k = next(i for i in range(3) if a[i] not in common)
        p, q, s = a[k], a[(k + 1) % 3], a[(k + 2) % 3]  # p is opposite of the diagonal q s
        r = next(c for c in b if c not in common)
        other = np.array([[p, q, r], [p, r, s]])
        if fullness(V, vertex[other]).min() > min(full[t], full[t + 1]):
            made[[t, t + 1]] = other
    return made


def tell_concave(s: Surface, result: Result) -> None:
    """Notes polygons that are convex in space but not in the map: programs that cut them otherwise read flips there."""
    before = np.empty(s.corners, np.int64)
    before[s.next] = np.arange(s.corners)
    points = s.V[s.vertex]
    turns = np.cross(points - points[before], points[s.next] - points)
    normal = np.zeros((s.faces, 3))
    np.add.at(normal, s.face, np.cross(points, points[s.next]))
    lengths = np.linalg.norm(points[s.next] - points, axis=1)
    size = lengths * lengths[before] * np.linalg.norm(normal, axis=1)[s.face]
    convex = (turns * normal[s.face]).sum(1) > 1e-3 * size
    a, b = result.uv - result.uv[before], result.uv[s.next] - result.uv
    flat_turns = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]

    def everywhere(corners: np.ndarray) -> np.ndarray:
        all_of = np.ones(s.faces, bool)
        np.logical_and.at(all_of, s.face, corners)
        return all_of

    lost = everywhere(convex & result.changed) & ~everywhere(flat_turns > 0) & ~everywhere(flat_turns < 0)
    lost &= np.bincount(s.face, minlength=s.faces) > 3
    if lost.any():
        result.notes.append(
            f"{listed(s, 'face', np.flatnonzero(lost))}: convex, but not in the map; a program that cuts polygons in "
            "another way than Blender may read flips there: triangulate them (Ctrl T)"
        )
