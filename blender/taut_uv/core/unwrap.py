# SPDX-License-Identifier: MIT
"""Unwrap: islands between seams are laid flat; pinned corners keep their coordinates, bit for bit."""

from __future__ import annotations

import numpy as np

from .islands import Island, islands_of, sides_of_edges
from .messages import Trouble, about_faces, about_vertices, explained
from .placing import pack_islands, write_island
from .plane import areas, mirrored, rigid_fit
from .polygons import tell_concave
from .surface import Surface
from .work import Clock, Result, untold

#: Faults of islands that a cut can mend.
_CUT = ("closed_surface", "handles", "several_boundaries")


def unwrap(
    taut,
    s: Surface,
    *,
    energy: str = "isometric",
    no_overlap: bool = False,
    cut: bool = False,
    weighted: bool = False,
    pack: bool = True,
    rotate: bool = True,
    padding: float = 2,
    resolution: int = 1024,
    time_limit: float = 0,
    tell=untold,
) -> Result:
    """Lay the islands of the chosen faces flat.

    Islands with pinned corners lie as these say; the others are packed into the unit square, around them. An island
    that is no disk is reported, or cut where it has to be. weighted: triangles count as their vertices are painted. A
    stop or a time limit leaves the islands that are done.
    """
    clock, result = Clock(time_limit), Result.of(s)
    islands = islands_of(s)
    if not islands:
        raise Trouble("no face is selected; select some, or all")
    if not (pack or rotate):
        result.notes.append("Rotate has no effect without Pack")
    placed, loose = [], []
    for k, island in enumerate(islands):
        tell(f"island {k + 1} of {len(islands)}")
        if clock.over:
            result.complete = False
            break
        try:
            pins = pins_of(s, island)
            parts, complete = _map(taut, s, island, pins, energy, no_overlap, cut, weighted, clock)
        except Trouble as e:
            result.problems.append(e.problem)
            continue
        except (taut.Cancelled, taut.TautError) as e:
            if not isinstance(e, taut.Cancelled) and getattr(e, "fault", None) != "stopped":
                result.problems.append(explained(e, s, island))
                continue
            parts, complete = [], False
        (placed if len(pins[0]) else loose).extend(parts)
        if not complete:
            result.complete = False
            break
    _place(taut, s, result, placed, loose, pack, (padding, resolution, rotate), clock)
    tell_concave(s, result)
    result.numbers["islands"] = len(placed) + len(loose)
    return result


def pins_of(s: Surface, island: Island) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of an island with a pinned corner, and where."""
    pinned = s.pinned[island.corners]
    corners, local = island.corners[pinned], island.local[pinned]
    b, first = np.unique(local, return_index=True)
    bc = s.uv[corners[first]]
    place = np.zeros((len(island.V), 2))
    place[b] = bc
    apart = (s.uv[corners] != place[local]).any(1)
    if apart.any():
        raise Trouble(
            about_vertices(
                s,
                s.vertex[corners[apart]],
                "pinned to two places on one side of the seams; weld its UVs, clear a pin, or mark a seam",
            )
        )
    if not np.isfinite(bc).all():
        raise Trouble(
            about_vertices(
                s, s.vertex[corners[~np.isfinite(s.uv[corners]).all(1)]], "a pin that is no number; clear it"
            )
        )
    return b, bc


def triangle_weights(s: Surface, island: Island) -> np.ndarray:
    """Painted weights of an island's triangles: how much each counts, never quite nothing."""
    return np.maximum(s.weight[s.vertex[s.triangles[island.triangles]]].mean(1), 1e-3)


def _map(taut, s, island, pins, energy, no_overlap, cut, weighted, clock):
    """The island, or the parts that it was cut into, each with its map and pins; whether these are done."""
    weights = triangle_weights(s, island) if weighted else None
    common = dict(energy=energy, weights=weights, holes=True, polygons=s.triangle_face[island.triangles])
    pinned = len(pins[0]) > 0
    try:
        free = taut.unwrap(island.V, island.F, no_overlap=no_overlap and not pinned, time_limit=clock.left, **common)
    except taut.MeshError as e:
        if not cut or e.fault not in _CUT:
            raise
        if pinned:
            what = "an island with pins that is no disk; mark seams that make it one"
            raise Trouble(about_faces(s, island.faces, what)) from e
        return _cut(taut, s, island, clock), True
    except taut.Cancelled as e:
        if e.best is None or pinned:
            raise
        return [(island, e.best.x, pins)], False
    if not pinned:
        return [(island, free.x, pins)], free.stop != "time"
    try:
        made, mirror = _pinned(taut, s, island, free.x, pins, no_overlap, clock, common)
    except taut.Cancelled as e:
        if e.best is None or not e.best.pins_held or (e.best.x[pins[0]] != pins[1]).any():
            raise
        made, mirror = e.best, False
    return [(island, mirrored(made.x) if mirror else made.x, pins)], made.stop != "time"


def _pinned(taut, s, island, free, pins, no_overlap, clock, common):
    """The map with pins: at the size, the place and on the side where they fit best; and whether that is mirrored."""
    b, bc = pins
    mirror = False
    if len(b) == 1:
        scale = _old_scale(s, island)
        start = (free - free[b[0]]) * scale + bc[0]
    else:
        R, shift, error = rigid_fit(free[b], bc, scaled=True)
        Rm, shift_m, error_m = rigid_fit(free[b], mirrored(bc), scaled=True)
        mirror = len(b) > 2 and error_m < 0.25 * error
        if mirror:
            R, shift, bc = Rm, shift_m, mirrored(bc)
        scale, start = float(np.hypot(*R[:, 0])), free @ R.T + shift
    if not scale > 0 or not np.isfinite(scale) or np.ptp(bc, axis=0).max() == 0 < len(b) - 1:
        raise Trouble(about_vertices(s, island.vertices[b], "pins that all lie in one point; move them apart"))
    made = taut.unwrap(
        island.V * scale, island.F, b=b, bc=bc, initial=start, no_overlap=no_overlap, time_limit=clock.left, **common
    )
    return made, mirror


def _old_scale(s: Surface, island: Island) -> float:
    """Lengths in the plane by lengths in space, as the island lies now; or such that it would fill the unit square."""
    old = island.of_corners(s.uv)
    flat = (
        np.abs(np.cross(old[island.F[:, 1]] - old[island.F[:, 0]], old[island.F[:, 2]] - old[island.F[:, 0]])).sum() / 2
    )
    size = areas(island.V, island.F).sum()
    return float(np.sqrt((flat if np.isfinite(flat) and flat > 0 else 0.5) / size))


def _cut(taut, s, island, clock):
    """The parts of an island that is no disk: one where it can be, as Atlas makes them; between polygons alone."""
    made = taut.atlas(
        island.V, island.F, prefer="one", polygons=s.triangle_face[island.triangles], time_limit=clock.left
    )
    if not made.complete:
        raise taut.NoMap("the time was over before it was cut", fault="stopped")
    return parts_of_atlas(s, island, made)


def parts_of_atlas(s: Surface, island: Island, made) -> list[tuple[Island, np.ndarray, tuple]]:
    """The charts of an atlas of an island, as islands with their maps."""
    parts = []
    none = (np.zeros(0, np.int64), np.zeros((0, 2)))
    for chart in range(made.charts):
        own = np.flatnonzero(made.chart == chart)
        used, F = np.unique(made.faces[own], return_inverse=True)
        F = F.reshape(-1, 3)
        triangles = island.triangles[own]
        corners, at = np.unique(s.triangles[triangles].reshape(-1), return_index=True)
        local = F.reshape(-1)[at]
        first = np.zeros(len(used), np.int64)
        first[local] = corners
        parts.append(
            (
                Island(
                    corners,
                    local,
                    s.vertex[first],
                    first,
                    s.V[s.vertex[first]],
                    F,
                    triangles,
                    np.unique(s.triangle_face[triangles]),
                ),
                made.uv[used],
                none,
            )
        )
    return parts


def _place(taut, s, result, placed, loose, pack, packing, clock):
    """Packs what no pin holds, rounds all, and writes it."""
    if loose and pack:
        loose = pack_islands(taut, result, placed, loose, *packing, clock)
    for island, x, (b, bc) in placed + loose:
        fixed = np.zeros(x.shape, bool)
        fixed[b] = True
        problem = write_island(s, result, island, x, fixed)
        if problem:
            result.problems.append(problem)
    if any(len(i.faces) for i, _, _ in placed + loose) and result.seam is None:
        result.seam = _with_cuts(s, placed + loose)


def _with_cuts(s: Surface, parts) -> np.ndarray | None:
    """Marks of seams, with those where an island was cut; None where none was."""
    place = np.full(s.corners, -1)
    count = 0
    for island, _, _ in parts:
        place[island.corners] = island.local + count
        count += len(island.V)
    new = torn_edges(s, place) & ~s.seam
    return (s.seam | new) if new.any() else None


def torn_edges(s: Surface, place: np.ndarray) -> np.ndarray:
    """Edges whose two faces have different vertices in the plane there. place : of corners; -1: of none."""
    torn = np.zeros(len(s.edges), bool)
    pairs, _ = sides_of_edges(s, np.ones(s.faces, bool))
    a, b = pairs[:, 0], pairs[:, 1]
    opposite = s.vertex[a] == s.vertex[s.next[b]]
    start, end = np.where(opposite, s.next[b], b), np.where(opposite, b, s.next[b])
    apart = (place[a] != place[start]) | (place[s.next[a]] != place[end])
    known = (place[a] >= 0) & (place[start] >= 0)
    torn[s.edge[a[apart & known]]] = True
    return torn
