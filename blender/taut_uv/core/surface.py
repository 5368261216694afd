# SPDX-License-Identifier: MIT
"""Polygon meshes with texture coordinates as arrays, of one object or of several joined."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import numpy as np


@dataclass
class Surface:
    """Meshes of one or several objects, one behind the other.

    A corner is a vertex of a face (Blender's loop). n vertices, c corners, f faces, m triangles, e edges.

    Attributes
    ----------
    V : (n, 3) float64
        Vertices, in lengths of the scene.
    vertex, face, edge, next : (c,) int64
        Of each corner: its vertex, its face, the edge that leads to the next corner, and that corner.
    triangles : (m, 3) int64
        Corners of the triangles that faces are cut into; triangle_face, (m,), says of which face each is. drawn,
        (m, 3): those that Blender cuts faces into, which may be others of the same face.
    edges : (e, 2) int64
        Ends of edges; seam, (e,), marks seams.
    uv : (c, 2) float64
        Texture coordinates, numbers of single precision.
    pinned : (c,) bool
        Corners whose coordinates stay.
    chosen : (f,) bool
        Faces that a command is for.
    line : (e,) bool
        Edges that a command is for.
    weight : (n,) float64
        Painted weights, 0 to 1; 1 where nothing is painted.
    names : list of str
        Of objects; first_vertex, first_corner, first_face, first_edge: where each begins, and the end.
    """

    V: np.ndarray
    vertex: np.ndarray
    face: np.ndarray
    edge: np.ndarray
    next: np.ndarray
    triangles: np.ndarray
    triangle_face: np.ndarray
    edges: np.ndarray
    seam: np.ndarray
    uv: np.ndarray
    pinned: np.ndarray
    chosen: np.ndarray
    line: np.ndarray
    weight: np.ndarray
    drawn: np.ndarray = None
    names: list[str] = field(default_factory=lambda: ["mesh"])
    first_vertex: np.ndarray = None
    first_corner: np.ndarray = None
    first_face: np.ndarray = None
    first_edge: np.ndarray = None

    def __post_init__(self):
        if self.drawn is None:
            self.drawn = self.triangles
        for name, count in (
            ("vertex", len(self.V)),
            ("corner", len(self.vertex)),
            ("face", len(self.chosen)),
            ("edge", len(self.edges)),
        ):
            if getattr(self, f"first_{name}") is None:
                setattr(self, f"first_{name}", np.array([0, count]))

    @property
    def corners(self) -> int:
        return len(self.vertex)

    @property
    def faces(self) -> int:
        return len(self.chosen)

    def named(self, kind: str, ids) -> list[tuple[str, list[int]]]:
        """Elements as Blender numbers them: pairs of the name of an object and numbers in it. kind: "vertex", "face",
        "edge" or "corner"."""
        first = getattr(self, f"first_{kind}")
        ids = np.unique(np.asarray(ids, dtype=np.int64))
        of = np.searchsorted(first, ids, side="right") - 1
        return [(self.names[k], (ids[of == k] - first[k]).tolist()) for k in np.unique(of)]

    def copy(self) -> "Surface":
        """With arrays of its own, for a job that runs while the scene goes on."""
        return Surface(
            **{f.name: (lambda a: a.copy() if hasattr(a, "copy") else a)(getattr(self, f.name)) for f in fields(self)}
        )


_SHIFTED = {
    "vertex": "vertex",
    "face": "face",
    "edge": "edge",
    "next": "corner",
    "triangles": "corner",
    "drawn": "corner",
    "triangle_face": "face",
    "edges": "vertex",
}


def joined(surfaces: list[Surface]) -> Surface:
    """Several objects as one surface."""
    if len(surfaces) == 1:
        return surfaces[0]
    counts = {
        "vertex": [len(s.V) for s in surfaces],
        "corner": [s.corners for s in surfaces],
        "face": [s.faces for s in surfaces],
        "edge": [len(s.edges) for s in surfaces],
    }
    first = {kind: np.cumsum([0] + n) for kind, n in counts.items()}
    arrays = {}
    for f in fields(Surface):
        if f.name == "names" or f.name.startswith("first_"):
            continue
        parts = [getattr(s, f.name) for s in surfaces]
        if f.name in _SHIFTED:
            parts = [p + o for p, o in zip(parts, first[_SHIFTED[f.name]])]
        arrays[f.name] = np.concatenate(parts)
    return Surface(
        **arrays, names=[n for s in surfaces for n in s.names], **{f"first_{kind}": at for kind, at in first.items()}
    )


def from_polygons(V, polygons, **given) -> Surface:
    """A surface of lists of vertices, faces cut into fans: for tests and scripts that have no Blender."""
    V = np.asarray(V, dtype=np.float64)
    sizes = np.array([len(p) for p in polygons], dtype=np.int64)
    start = np.r_[0, np.cumsum(sizes)]
    vertex = np.array([v for p in polygons for v in p], dtype=np.int64)
    face = np.repeat(np.arange(len(polygons)), sizes)
    following = np.arange(len(vertex)) + 1
    following[start[1:] - 1] = start[:-1]
    edges, edge = np.unique(np.sort(np.c_[vertex, vertex[following]], 1), axis=0, return_inverse=True)
    fans = [[(start[i], start[i] + k, start[i] + k + 1) for k in range(1, n - 1)] for i, n in enumerate(sizes)]
    c = len(vertex)
    arrays = dict(
        V=V,
        vertex=vertex,
        face=face,
        edge=edge.reshape(-1),
        next=following,
        triangles=np.array([t for fan in fans for t in fan], dtype=np.int64).reshape(-1, 3),
        triangle_face=np.repeat(np.arange(len(polygons)), sizes - 2),
        edges=edges,
        seam=np.zeros(len(edges), bool),
        uv=np.zeros((c, 2)),
        pinned=np.zeros(c, bool),
        chosen=np.ones(len(polygons), bool),
        line=np.zeros(len(edges), bool),
        weight=np.ones(len(V)),
    )
    return Surface(**{**arrays, **given})
