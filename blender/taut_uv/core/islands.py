# SPDX-License-Identifier: MIT
"""Islands: parts of a surface whose faces hang together across edges that are not cut."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .surface import Surface


@dataclass
class Island:
    """A part of a surface, with vertices of its own: one for each place of a vertex in the plane.

    Attributes
    ----------
    corners : (k,) int64
        Corners of the surface; local, (k,), is the island's vertex of each.
    vertices : (n,) int64
        The surface's vertex of each of the island's; first, (n,), is a corner of each.
    V, F : (n, 3) float64, (m, 3) int64
        Points in space, and triangles.
    triangles, faces : int64
        Triangles and faces of the surface.
    """

    corners: np.ndarray
    local: np.ndarray
    vertices: np.ndarray
    first: np.ndarray
    V: np.ndarray
    F: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray

    def of_corners(self, values: np.ndarray) -> np.ndarray:
        """Values of the surface's corners by the island's vertex, such as texture coordinates."""
        return values[self.first]

    def drawn_otherwise(self, s: Surface) -> tuple[np.ndarray, np.ndarray]:
        """Triangles that Blender cuts faces into and the island has not, of the island's vertices, and their faces."""
        other = self.triangles[(s.drawn[self.triangles] != s.triangles[self.triangles]).any(1)]
        local = np.zeros(s.corners, np.int64)
        local[self.corners] = self.local
        return local[s.drawn[other]], s.triangle_face[other]

    def any_corner(self, flags: np.ndarray) -> np.ndarray:
        """Which vertices of the island have a corner that is marked."""
        marked = np.zeros(len(self.V), bool)
        marked[self.local[flags[self.corners]]] = True
        return marked


def roots(count: int, pairs: np.ndarray) -> np.ndarray:
    """The smallest number of the part that each of `count` things is of, where pairs hang together."""
    label = np.arange(count)
    a, b = pairs[:, 0], pairs[:, 1]
    while True:
        low = np.minimum(label[a], label[b])
        new = label.copy()
        # The roots are lowered, too, so that long chains take few rounds.
        for at in (a, b, label[a], label[b]):
            np.minimum.at(new, at, low)
        new = new[new]
        if (new == label).all():
            return label
        label = new


def sides_of_edges(s: Surface, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of corners with an edge in common that just two of the marked faces have; and corners whose edges three
    or more have."""
    used = np.flatnonzero(faces[s.face])
    order = used[np.argsort(s.edge[used], kind="stable")]
    _, start, times = np.unique(s.edge[order], return_index=True, return_counts=True)
    two = start[times == 2]
    many = np.repeat(times > 2, times)
    return np.c_[order[two], order[two + 1]], order[many]


def joined_corners(s: Surface, faces: np.ndarray, by_uv: bool) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of corners that are one vertex of an island, and pairs of corners whose faces hang together.

    by_uv : islands are parted where coordinates differ, as they lie in the editor; else at seams.
    """
    pairs, _ = sides_of_edges(s, faces)
    a, b = pairs[:, 0], pairs[:, 1]
    opposite = s.vertex[a] == s.vertex[s.next[b]]  # else the two faces are oriented differently
    start, end = np.where(opposite, s.next[b], b), np.where(opposite, b, s.next[b])
    if by_uv:
        joins = (s.uv[a] == s.uv[start]).all(1) & (s.uv[s.next[a]] == s.uv[end]).all(1)
    else:
        joins = ~s.seam[s.edge[a]]
    a, b, start, end = a[joins], b[joins], start[joins], end[joins]
    return np.concatenate([np.c_[a, start], np.c_[s.next[a], end]]), np.c_[a, b]


def islands_of(s: Surface, faces: np.ndarray | None = None, *, by_uv: bool = False) -> list[Island]:
    """The islands of the marked faces (all that are chosen), in the order of their first faces."""
    faces = s.chosen if faces is None else faces
    same, neighbours = joined_corners(s, faces, by_uv)
    place = roots(s.corners, same)
    part = roots(s.faces, s.face[neighbours])
    used = np.flatnonzero(faces[s.face])
    order = used[np.argsort(part[s.face[used]], kind="stable")]
    bounds = np.r_[np.flatnonzero(np.diff(part[s.face[order]], prepend=-1)), len(order)]
    some = np.flatnonzero(faces[s.triangle_face])
    of_triangle = part[s.triangle_face[some]]
    triangle_order = some[np.argsort(of_triangle, kind="stable")]
    sorted_parts = part[s.triangle_face[triangle_order]]
    number = np.zeros(s.corners, dtype=np.int64)
    found = []
    for i, j in zip(bounds[:-1], bounds[1:]):
        corners = order[i:j]
        root = part[s.face[corners[0]]]
        triangles = triangle_order[np.searchsorted(sorted_parts, root) : np.searchsorted(sorted_parts, root, "right")]
        _, first, local = np.unique(place[corners], return_index=True, return_inverse=True)
        first, local = corners[first], local.reshape(-1)
        number[corners] = local
        found.append(
            Island(
                corners,
                local,
                s.vertex[first],
                first,
                s.V[s.vertex[first]],
                number[s.triangles[triangles]],
                triangles,
                np.unique(s.face[corners]),
            )
        )
    return found
