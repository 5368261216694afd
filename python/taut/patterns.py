# SPDX-License-Identifier: MIT
"""Patterns for cutting: a surface in millimetres becomes flat pieces, written as DXF. Needs ezdxf to write."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ._atlas import atlas
from ._maps import unwrap
from ._trace import EnergyLike


@dataclass
class Piece:
    """A flat piece.

    Attributes
    ----------
    outline : (k, 2) float64
        Its boundary, counter-clockwise, in mm; `holes` are further loops.
    seams : list of (int, list of int)
        The number of a seam, and the points of the outline along it. A number that two pieces have, or one twice, is
        sewn together.
    faces : triangles of the surface. uv : their corners in the plane, (m, 3, 2).
    """

    outline: Any
    holes: list[Any]
    faces: Any
    uv: Any
    seams: list[tuple[int, list[int]]] = field(default_factory=list)

    def seam_lengths(self) -> dict[int, float]:
        """Length of each seam on this piece, in mm."""
        lengths: dict[int, float] = {}
        for number, points in self.seams:
            x = self.outline[points]
            lengths[number] = lengths.get(number, 0.0) + float(np.linalg.norm(np.diff(x, axis=0), axis=1).sum())
        return lengths


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


def pieces(V: Any, F: Any, seams: Any = None, *, grain: Any = None, energy: EnergyLike = "isometric", **options: Any) -> list[Piece]:
    """The pieces that seams part a surface into, flattened at its own scale.

    Parameters
    ----------
    V, F : a surface, in mm
    seams : (k, 2) array-like of int, optional
        Edges to cut; without them charts are made.
    grain : (m, 3) array-like, optional
        The direction of the grain line on each triangle, which an energy with `s.direction` sees.
    options
        Of `taut.unwrap`.
    """
    V, F = np.asarray(V, dtype=np.float64), np.asarray(F, dtype=np.int64)
    cut = atlas(V, F, seams=seams, charts="auto" if seams is None else "keep", repair=False)
    made: list[tuple[Piece, Any]] = []
    number_of: dict[tuple[int, ...], int] = {}
    for chart in range(cut.charts):
        own = np.flatnonzero(cut.chart == chart)
        used, local = np.unique(cut.faces[own], return_inverse=True)
        local = local.reshape(-1, 3)
        vertex = cut.vmapping[used]
        flat = unwrap(V[vertex], local, energy=energy, directions=None if grain is None else np.asarray(grain)[own],
                      **{"holes": True, **options}).uv
        loops = sorted(_loops(local), key=lambda loop: -np.abs(_area(flat[loop])))
        piece = Piece(flat[loops[0]], [flat[loop] for loop in loops[1:]], own, flat[local])
        made.append((piece, vertex[loops[0]]))
    owner: dict[tuple[int, int], list[int]] = {}  # which pieces an edge is of
    for k, (piece, around) in enumerate(made):
        for a, b in zip(around, np.roll(around, -1)):
            owner.setdefault((min(a, b), max(a, b)), []).append(k)
    for k, (piece, around) in enumerate(made):
        n, last = len(around), None
        for i in range(n):
            a, b = around[i], around[(i + 1) % n]
            sewn = owner[min(a, b), max(a, b)]
            pair = tuple(sorted(sewn)) if len(sewn) == 2 else None
            if pair is None:
                last = None
                continue
            number = number_of.setdefault(pair, len(number_of) + 1)
            if last == number:
                piece.seams[-1][1].append((i + 1) % n)
            else:
                piece.seams.append((number, [i, (i + 1) % n]))
            last = number
    return [piece for piece, _ in made]


def _area(loop: Any) -> float:
    x, y = loop[:, 0], loop[:, 1]
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def write_dxf(path: Any, made: list[Piece], *, gap: float = 20.0, notch: float = 4.0) -> None:
    """Pieces side by side, in mm: layers OUTLINE, SEAM (numbers and lengths), NOTCH (amid each seam), GRAIN (upwards)."""
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
            x = piece.outline[points] + shift
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
    drawing.saveas(path)
