# SPDX-License-Identifier: MIT
"""Patterns for cutting: a surface in millimetres becomes flat pieces, written as DXF. Needs ezdxf to write."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import _arrays, _options
from ._atlas import atlas
from ._files import write_bytes
from ._maps import at_scale, unwrap
from ._trace import BuiltinEnergy, EnergyLike, as_energy
from .errors import NoMap, ParameterError


@dataclass
class Piece:
    """A flat piece, which does not overlap itself.

    Attributes
    ----------
    outline : (k, 2) float64
        Its boundary, counter-clockwise, in mm; `holes` are further loops.
    seams : list of (int, list of int)
        The number of a seam, and the points along it: of the outline, then of the holes, as `points` has them. A number
        that two pieces have, or one twice, is sewn together. Each seam has a number of its own, and leads from one
        place where seams or borders meet to the next.
    faces : triangles of the surface. uv : their corners in the plane, (m, 3, 2).
    """

    outline: Any
    holes: list[Any]
    faces: Any
    uv: Any
    seams: list[tuple[int, list[int]]] = field(default_factory=list)

    @property
    def points(self) -> Any:
        """The outline and the holes, one behind the other."""
        return np.concatenate([self.outline, *self.holes])

    def seam_lengths(self) -> dict[int, float]:
        """Length of each seam on this piece, in mm; of one that is sewn to itself, the mean of both sides."""
        sides: dict[int, list[float]] = {}
        for number, points in self.seams:
            steps = np.linalg.norm(np.diff(self.points[points], axis=0), axis=1)
            sides.setdefault(number, []).append(float(steps.sum()))
        return {number: sum(lengths) / len(lengths) for number, lengths in sides.items()}


def _loops(faces: Any) -> list[list[int]]:
    ends = np.stack([faces, np.roll(faces, -1, 1)], 2).reshape(-1, 2)
    inside = {(int(a), int(b)) for a, b in ends}
    follow = {a: b for a, b in inside if (b, a) not in inside}
    loops = []
    while follow:
        loop = [next(iter(follow))]
        while loop[-1] in follow:
            loop.append(follow.pop(loop[-1]))
        loops.append(loop[:-1])
    return loops


#: Arguments of `taut.unwrap` that have a row for each triangle, and those that say where vertices go.
_BY_TRIANGLE = ("polygons", "weights", "attributes", "directions")
_BY_VERTEX = ("b", "bc", "springs", "initial")


def pieces(V: Any, F: Any, seams: Any = None, *, grain: Any = None, energy: EnergyLike = "isometric", **options: Any) -> list[Piece]:
    """The pieces that seams part a surface into, flattened at its own scale. None overlaps itself.

    Parameters
    ----------
    V, F : a surface, in mm
    seams : (k, 2) array-like of int, optional
        Edges to cut; without them charts are made.
    grain : (m, 3) array-like, optional
        The direction of the grain line on each triangle, which an energy with `s.direction` sees.
    options
        Of `taut.unwrap`, rows for each triangle of the surface; not pins, springs, `initial`, `cut` and what would change
        lengths.
    """
    V, F = _options.surface(V, F, planar=False)
    V, F = np.asarray(V, dtype=np.float64), np.asarray(F, dtype=np.int64)
    for name in _BY_VERTEX:
        if options.get(name) is not None:
            raise ParameterError(f"{name}: says where vertices of one map go, and these are several", field=name)
    rows: dict[str, Any] = {name: _arrays.numbers(name, options.pop(name), len(F), columns=True)
                            for name in _BY_TRIANGLE if options.get(name) is not None}
    if grain is not None:
        if "directions" in rows:
            raise ParameterError("directions: are the grain; give one of them", field="directions")
        if isinstance(as_energy(energy), BuiltinEnergy):
            raise ParameterError("grain: has no effect, as no energy of taut's own reads it; give one that does",
                                 field="grain")
        rows["directions"] = _arrays.points("grain", grain, (3,), rows=len(F))
    options = at_scale(options, "pieces", no_overlap=True)
    cut = atlas(V, F, seams=seams, charts="auto" if seams is None else "keep", repair=False)
    made: list[Piece] = []
    around: list[list[Any]] = []  # the loops of each piece, in vertices of the surface
    for chart in range(cut.charts):
        own = np.flatnonzero(cut.chart == chart)
        used, local = np.unique(cut.faces[own], return_inverse=True)
        local = local.reshape(-1, 3)
        vertex = cut.vmapping[used]
        try:
            flat = unwrap(V[vertex], local, energy=energy, **{name: values[own] for name, values in rows.items()},
                          **options).uv
        except NoMap as e:
            e.args = (f"piece {chart}, with triangle {own[0]}: {e}; cut it by more seams",)
            raise
        loops = sorted(_loops(local), key=lambda loop: -np.abs(_area(flat[loop])))
        made.append(Piece(flat[loops[0]], [flat[loop] for loop in loops[1:]], own, flat[local]))
        around.append([vertex[loop] for loop in loops])
    number, ends = _numbered(around)
    for piece, loops in zip(made, around):
        first = 0
        for loop in loops:
            piece.seams += [(n, [first + i for i in points]) for n, points in _runs(loop, number, ends)]
            first += len(loop)
    return made


def _edges(loop: Any) -> list[tuple[int, int]]:
    """The edges of a loop, each from the point of its number to the next one, smaller vertex first."""
    return [(min(a, b), max(a, b)) for a, b in zip(loop.tolist(), np.roll(loop, -1).tolist())]


def _numbered(around: list[list[Any]]) -> tuple[dict[tuple[int, int], int], set[int]]:
    """The seam of each edge that is sewn, from 1, and the vertices where seams begin and end.

    A seam is a line of edges between two pieces, or a piece and itself, that no other one and no border meets within. A
    closed one begins anywhere.
    """
    owners: dict[tuple[int, int], list[int]] = {}
    for k, loops in enumerate(around):
        for loop in loops:
            for edge in _edges(loop):
                owners.setdefault(edge, []).append(k)
    at: dict[int, list[tuple[int, int]]] = {}
    for edge in owners:
        for v in edge:
            at.setdefault(v, []).append(edge)
    ends = {v for v, edges in at.items() if len(edges) != 2 or owners[edges[0]] != owners[edges[1]]}
    ends |= {v for edge, own in owners.items() if len(own) < 2 for v in edge}
    number: dict[tuple[int, int], int] = {}
    count = 0
    for start, own in owners.items():
        if len(own) < 2 or start in number:
            continue
        count += 1
        number[start] = count
        for v in start:
            edge = start
            while v not in ends:
                edge = at[v][1] if at[v][0] == edge else at[v][0]
                if edge == start:
                    ends.add(v)
                    break
                number[edge] = count
                v = edge[1] if edge[0] == v else edge[0]
    return number, ends


def _runs(loop: Any, number: dict[tuple[int, int], int], ends: set[int]) -> list[tuple[int, list[int]]]:
    """The seams along a loop, in its order, and the points of each."""
    edges, n = _edges(loop), len(loop)
    begin = next((i for i in range(n) if loop[i] in ends), 0)
    runs: list[tuple[int, list[int]]] = []
    for i in (k % n for k in range(begin, begin + n)):
        seam = number.get(edges[i])
        if seam is None:
            continue
        if loop[i] in ends or not runs:
            runs.append((seam, [i]))
        runs[-1][1].append((i + 1) % n)
    return runs


def _area(loop: Any) -> float:
    x, y = loop[:, 0], loop[:, 1]
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def write_dxf(path: Any, made: list[Piece], *, gap: float = 20.0, notch: float = 4.0) -> None:
    """Pieces side by side, in mm: layers OUTLINE, SEAM (numbers and lengths), NOTCH (amid each seam), GRAIN (upwards).

    made : as `pieces` returns them
    """
    path = _arrays.path("path", path)
    wrong = [made] if not isinstance(made, (list, tuple)) else [item for item in made if not isinstance(item, Piece)]
    if wrong:
        raise ParameterError(f"made: has a {type(wrong[0]).__name__}, but must be a list of pieces, as patterns.pieces() "
                             "returns it", field="made")
    gap, notch = _arrays.number("gap", gap), _arrays.number("notch", notch)
    for name, value in (("gap", gap), ("notch", notch)):
        if not 0 <= value < np.inf:
            raise ParameterError(f"{name}: is {value}, but must not be negative", field=name)
    import ezdxf

    drawing = ezdxf.new("R2010", units=4)  # millimetres
    for name, colour in (("OUTLINE", 7), ("SEAM", 3), ("NOTCH", 1), ("GRAIN", 5)):
        drawing.layers.add(name, color=colour)
    space, left = drawing.modelspace(), 0.0
    for piece in made:
        shift = np.array([left, 0.0]) - piece.outline.min(0)
        for loop in [piece.outline, *piece.holes]:
            space.add_lwpolyline((loop + shift).tolist(), close=True, dxfattribs={"layer": "OUTLINE"})
        for number, points in piece.seams:
            x = piece.points[points] + shift
            steps = np.linalg.norm(np.diff(x, axis=0), axis=1)
            along = np.r_[0, np.cumsum(steps)]
            middle = np.array([np.interp(along[-1] / 2, along, x[:, k]) for k in range(2)])
            k = min(int(np.searchsorted(along, along[-1] / 2, "right")) - 1, len(steps) - 1)
            inward = np.array([x[k, 1] - x[k + 1, 1], x[k + 1, 0] - x[k, 0]]) / max(steps[k], 1e-300)
            space.add_line(middle, middle + notch * inward, dxfattribs={"layer": "NOTCH"})
            space.add_text(f"{number}: {along[-1]:.1f}", height=notch, dxfattribs={"layer": "SEAM"}).set_placement(
                tuple(middle + 2 * notch * inward))
        low, high = piece.outline.min(0) + shift, piece.outline.max(0) + shift
        middle = (low + high) / 2
        space.add_line((middle[0], low[1] + 0.2 * (high - low)[1]), (middle[0], high[1] - 0.2 * (high - low)[1]),
                       dxfattribs={"layer": "GRAIN"})
        left = high[0] + gap
    text = io.StringIO()
    drawing.write(text)
    write_bytes({path: text.getvalue().encode(drawing.output_encoding, "dxfreplace")})
