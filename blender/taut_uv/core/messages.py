# SPDX-License-Identifier: MIT
"""What went wrong, in words of Blender: the object, its faces, vertices and edges, and what to do."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .islands import Island
from .surface import Surface


@dataclass
class Problem:
    """A sentence, and the elements that it is about."""

    message: str
    faces: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    vertices: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))


class Trouble(RuntimeError):
    """A command that cannot do what is asked; `problem` says why."""

    def __init__(self, problem: Problem | str) -> None:
        self.problem = Problem(problem) if isinstance(problem, str) else problem
        super().__init__(self.problem.message)


def listed(s: Surface, kind: str, ids, most: int = 5) -> str:
    """ "Cube: faces 3, 4 and 17 more"."""
    plurals = {"face": "faces", "vertex": "vertices", "edge": "edges"}
    words = []
    for name, numbers in s.named(kind, ids):
        shown = ", ".join(str(i) for i in numbers[:most])
        more = f" and {len(numbers) - most} more" if len(numbers) > most else ""
        words.append(f"{name}: {plurals[kind] if len(numbers) > 1 else kind} {shown}{more}")
    return "; ".join(words)


def about_faces(s: Surface, faces, what: str) -> Problem:
    """A problem of faces: "Cube: face 3: ..."."""
    return Problem(f"{listed(s, 'face', faces)}: {what}", faces=np.unique(np.asarray(faces, dtype=np.int64)))


def about_vertices(s: Surface, vertices, what: str) -> Problem:
    return Problem(f"{listed(s, 'vertex', vertices)}: {what}", vertices=np.unique(np.asarray(vertices, dtype=np.int64)))


_OF_FACES = {
    "degenerate_cell": "no area; Mesh > Clean Up > Degenerate Dissolve, or Merge by Distance",
    "repeated_vertex": "a face that names a vertex twice; Mesh > Clean Up > Degenerate Dissolve",
    "duplicate_cell": "faces that lie on each other with the same vertices; delete one of each pair",
    "inconsistent_orientation": "neighbours that face opposite ways; Mesh > Normals > Recalculate Outside",
    "not_orientable": "a surface with one side; mark a seam across it",
}
_OF_VERTICES = {
    "non_finite": "a coordinate that is no number; set it",
    "non_manifold_facet": "an edge with three or more faces; mark it as a seam, or delete the inner faces",
    "non_manifold_vertex": "parts that touch in one vertex; split it (Mesh > Split, or Rip)",
    "several_boundaries": "an island with several borders; mark a seam that joins them",
}
_OF_ISLANDS = {
    "closed_surface": "a closed island, which cannot be laid flat; mark seams, use Atlas, or check Cut Where Needed",
    "handles": "an island with a handle, which cannot be laid flat; mark a seam along it, use Atlas, or check "
    "Cut Where Needed",
}


def explained(error: Exception, s: Surface, island: Island) -> Problem:
    """What the library says of an island, in numbers of the scene."""
    fault, ids = getattr(error, "fault", None), np.asarray(getattr(error, "ids", []), dtype=np.int64)
    name = type(error).__name__
    faces_of = lambda triangles: s.triangle_face[island.triangles[triangles]]
    if fault in _OF_FACES and len(ids):
        return about_faces(s, faces_of(ids), _OF_FACES[fault])
    if fault in _OF_VERTICES and len(ids):
        return about_vertices(s, island.vertices[ids], _OF_VERTICES[fault])
    if fault in _OF_ISLANDS:
        return about_faces(s, island.faces, _OF_ISLANDS[fault])
    if name == "ConstraintError" and len(ids):
        return about_vertices(s, island.vertices[ids], f"pins that cannot hold: {_after_ids(error)}")
    if name == "Infeasible":
        what = f"these pins admit no map without folds ({_before_ids(error)}); move them, or clear some (Alt P)"
        return _of_either(s, island, ids, str(error), what)
    if name == "NoMap":
        what = (
            f"no map without folds was found ({_before_ids(error)}); clear or move pins, mark a seam, or give more time"
        )
        return about_faces(s, island.faces, what)
    return about_faces(s, island.faces, str(error))


def _of_either(s: Surface, island: Island, ids: np.ndarray, text: str, what: str) -> Problem:
    """A proof names triangles or vertices, as its text says."""
    if len(ids) == 0:
        return about_faces(s, island.faces, what)
    if "triangle" in text.split("(")[0]:
        return about_faces(s, s.triangle_face[island.triangles[ids]], what)
    return about_vertices(s, island.vertices[ids[ids < len(island.vertices)]], what)


def _before_ids(error: Exception) -> str:
    """The finding without the library's own numbers: what stands before the first parenthesis, or all."""
    return str(error).split(";")[0].split(" (")[0] if " (" in str(error) else str(error).split(";")[0]


def _after_ids(error: Exception) -> str:
    text = str(error)
    return text.split(") ", 1)[1] if ") " in text else text
