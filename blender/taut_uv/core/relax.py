# SPDX-License-Identifier: MIT
"""Relax: chosen faces become less distorted where they lie, while all others stay, bit for bit."""

from __future__ import annotations

import numpy as np

from .islands import Island, islands_of, joined_corners, roots
from .messages import Trouble, about_faces, explained
from .placing import write_island
from .plane import areas, mirrored, rigid_fit, signed_areas
from .polygons import tell_concave
from .surface import Surface
from .unwrap import triangle_weights
from .work import Clock, Result, untold


def relax(
    taut,
    s: Surface,
    *,
    axis: str = "both",
    hold_border: bool = False,
    energy: str = "isometric",
    no_overlap: bool = False,
    weighted: bool = False,
    time_limit: float = 0,
    tell=untold,
) -> Result:
    """Relax the chosen faces within their islands, as they lie in the UV editor.

    Held are all corners of faces that are not chosen, and pinned ones. axis: "both", or "u" or "v", the one coordinate
    that may change. hold_border: open borders of islands stay, too. Lengths are compared at the size of whole islands.
    An island that is chosen as a whole, and has no pins, keeps its place.
    """
    clock, result = Clock(time_limit), Result.of(s)
    if not s.chosen.any():
        raise Trouble("no face is selected; select those that may move")
    everywhere = np.ones(s.faces, bool)
    place = roots(s.corners, joined_corners(s, everywhere, True)[0])
    stays = np.zeros(s.corners, bool)
    stays[place[~s.chosen[s.face]]] = True
    held_corner = stays[place] | _spread(place, s.pinned)
    sizes = island_scales(s)
    moved = 0
    islands = islands_of(s, by_uv=True)
    for k, island in enumerate(islands):
        tell(f"island {k + 1} of {len(islands)}")
        if clock.over:
            result.complete = False
            break
        held = held_corner[island.first]
        if hold_border:
            held |= open_border(s, island)
        if held.all():
            continue
        size = sizes[island.faces[0]]
        given = dict(energy=energy, no_overlap=no_overlap, weighted=weighted)
        done = rewritten(
            taut, s, result, island, lambda: relaxed(taut, s, island, held, axis, size, clock, **given)
        )
        moved += done
        if not result.complete:
            break
    if not moved and not result.problems and result.complete:
        raise Trouble(
            "all corners of the selected faces are held: by faces beside them that are not selected, or by pins; "
            "select more faces, or clear pins (Alt P)"
        )
    tell_concave(s, result)
    result.numbers["islands"] = moved
    return result


def rewritten(taut, s: Surface, result: Result, island: Island, make) -> bool:
    """Writes what make() makes of an island: its map, which coordinates are fixed, whether it ended by itself. What it
    raises is a problem of the result, and a stop leaves it incomplete. Whether there was a map."""
    try:
        x, fixed, complete = make()
    except Trouble as e:
        result.problems.append(e.problem)
        return False
    except (taut.Cancelled, taut.TautError) as e:
        if isinstance(e, taut.Cancelled) or getattr(e, "fault", None) == "stopped":
            result.complete = False
        else:
            result.problems.append(explained(e, s, island))
        return False
    problem = write_island(s, result, island, x, fixed)
    if problem:
        result.problems.append(problem)
    result.complete = result.complete and complete
    return True


def _spread(place: np.ndarray, flags: np.ndarray) -> np.ndarray:
    """Corners at a place with a corner that is marked."""
    marked = np.zeros(len(place), bool)
    marked[place[flags]] = True
    return marked[place]


def island_scales(s: Surface) -> np.ndarray:
    """Of each face: lengths in the plane by lengths in space of its whole island as it lies; 0: it has no area."""
    scale = np.zeros(s.faces)
    for island in islands_of(s, np.ones(s.faces, bool), by_uv=True):
        size, flat = areas(island.V, island.F).sum(), np.abs(signed_areas(island.of_corners(s.uv), island.F)).sum()
        if size > 0 and np.isfinite(flat):
            scale[island.faces] = np.sqrt(flat / size)
    return scale


def open_border(s: Surface, island: Island) -> np.ndarray:
    """Vertices of an island on its border."""
    ends = np.sort(np.stack([island.F, np.roll(island.F, -1, 1)], 2).reshape(-1, 2), 1)
    edges, times = np.unique(ends, axis=0, return_counts=True)
    border = np.zeros(len(island.V), bool)
    border[edges[times == 1]] = True
    return border


def relaxed(
    taut,
    s: Surface,
    island: Island,
    held: np.ndarray,
    axis: str,
    scale: float,
    clock: Clock,
    *,
    energy: str = "isometric",
    no_overlap: bool = False,
    weighted: bool = False,
    pins: tuple | None = None,
):
    """The map of an island from where it lies; which of its coordinates are fixed; whether it ended by itself.

    pins : vertices and places besides those that are held; a coordinate that is NaN is free
    """
    x0 = island.of_corners(s.uv)
    if not np.isfinite(x0).all() or not scale > 0:
        raise Trouble(about_faces(s, island.faces, "UVs without an area; unwrap them first"))
    mirror = signed_areas(x0, island.F).sum() < 0
    if mirror:
        x0 = mirrored(x0)
    fixed = np.repeat(held[:, None], 2, 1)
    target = x0.copy()
    if axis in "uv":
        fixed[:, 1 if axis == "u" else 0] = True
    if pins is not None:
        b, bc = pins[0], mirrored(pins[1]) if mirror else pins[1]
        given = ~np.isnan(bc)
        target[b] = np.where(given, bc, target[b])
        fixed[b] |= given
    b = np.flatnonzero(fixed.any(1))
    bc = np.where(fixed, target, np.nan)[b]
    weights = triangle_weights(s, island) if weighted else None
    made = taut.unwrap(
        island.V * scale,
        island.F,
        b=b if len(b) else None,
        bc=bc if len(b) else None,
        initial=x0,
        energy=energy,
        weights=weights,
        holes=True,
        no_overlap=no_overlap,
        placement="as_solved",
        time_limit=clock.left,
    )
    x = made.x
    if not len(b):
        R, shift, _ = rigid_fit(x, x0)
        x = x @ R.T + shift
    return mirrored(x) if mirror else x, fixed, made.stop != "time"
