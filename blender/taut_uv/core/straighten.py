# SPDX-License-Identifier: MIT
"""Straighten: lines of edges become straight along u or v, and their islands follow without folding."""

from __future__ import annotations

import numpy as np

from .islands import Island, islands_of
from .messages import Trouble, about_vertices, listed
from .relax import island_scales, relaxed, rewritten
from .surface import Surface
from .work import Clock, Result, untold


def straighten(
    taut,
    s: Surface,
    *,
    axis: str = "auto",
    spacing: str = "free",
    energy: str = "isometric",
    no_overlap: bool = False,
    time_limit: float = 0,
    tell=untold,
) -> Result:
    """Straighten the marked edges, line by line, as they lie in the UV editor.

    axis : "u", "v" or "auto"
        Along which axis lines run; auto: the one along which they are longer now.
    spacing : "free" or "length"
        Where vertices lie on their line: where the island is least distorted, or as far apart as in space.
    """
    clock, result = Clock(time_limit), Result.of(s)
    if not s.line.any():
        raise Trouble("no edge is selected; select a row of edges")
    sizes = island_scales(s)
    lines = 0
    for island in islands_of(s, np.ones(s.faces, bool), by_uv=True):
        ends = marked_edges(s, island)
        if len(ends) == 0:
            continue
        tell(f"line {lines + 1}")
        made: list[np.ndarray] = []

        def make():
            paths = paths_of(s, island, ends)
            pins, held = pins_of_paths(s, island, paths, axis, spacing)
            made.extend(paths)
            size = sizes[island.faces[0]]
            return relaxed(
                taut, s, island, held, "both", size, clock, energy=energy, no_overlap=no_overlap, pins=pins
            )

        if rewritten(taut, s, result, island, make):
            lines += len(made)
        if not result.complete:
            break
    result.numbers["lines"] = lines
    return result


def marked_edges(s: Surface, island: Island) -> np.ndarray:
    """The marked edges of an island, as pairs of its vertices."""
    local = np.full(s.corners, -1)
    local[island.corners] = island.local
    some = island.corners[s.line[s.edge[island.corners]]]
    return np.unique(np.sort(np.c_[local[some], local[s.next[some]]], 1), axis=0)


def paths_of(s: Surface, island: Island, ends: np.ndarray) -> list[np.ndarray]:
    """Edges as lines, each a row of vertices. Raises Trouble where they branch or close."""
    vertices, degree = np.unique(ends, return_counts=True)
    if (degree > 2).any():
        raise Trouble(
            about_vertices(
                s, island.vertices[vertices[degree > 2]], "selected edges branch here; select lines that do not meet"
            )
        )
    beside: dict[int, list[int]] = {}
    for a, b in ends.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    left, paths = set(beside), []
    for begin in vertices[degree == 1].tolist():
        if begin not in left:
            continue
        path, before = [begin], -1
        while True:
            left.discard(path[-1])
            onward = [v for v in beside[path[-1]] if v != before]
            if not onward:
                break
            before = path[-1]
            path.append(onward[0])
        paths.append(np.array(path))
    if left:
        raise Trouble(
            f"{listed(s, 'vertex', island.vertices[sorted(left)])}: the selected edges are a closed loop in the "
            "UV map, which cannot be straight; deselect an edge, or mark a seam across it and unwrap"
        )
    return paths


def pins_of_paths(s: Surface, island: Island, paths, axis: str, spacing: str):
    """Pins that make lines straight, and the vertices that are pinned by the user."""
    x, held = island.of_corners(s.uv), island.any_corner(s.pinned)
    b, bc = [], []
    for path in paths:
        p = x[path]
        extent = np.abs(p[-1] - p[0])
        along = {"u": 0, "v": 1}.get(axis, int(extent[1] > extent[0]))
        across = 1 - along
        levels = np.unique(p[held[path], across])
        if len(levels) > 1:
            raise Trouble(
                about_vertices(
                    s,
                    island.vertices[path[held[path]]],
                    "pins beside the straight line; clear all but one (Alt P), or align them",
                )
            )
        place = np.full(p.shape, np.nan)
        place[:, across] = levels[0] if len(levels) else float(np.float32(p[:, across].mean()))
        if spacing == "length":
            place[:, along] = _spaced(island.V[path], p[:, along])
        elif not held.any():  # else it may slide along the line
            place[0, along] = p[0, along]
        place[held[path]] = p[held[path]]
        b.append(path)
        bc.append(place)
    return (np.concatenate(b), np.concatenate(bc)), held


def _spaced(V: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Places between the two ends, as far apart as the points in space, as float32 holds them."""
    at = np.r_[0, np.cumsum(np.linalg.norm(np.diff(V, axis=0), axis=1))]
    at = at / at[-1] if at[-1] > 0 else np.linspace(0, 1, len(at))
    first, last = along[0], along[-1]
    return (first + at * (last - first)).astype(np.float32).astype(np.float64)
