# SPDX-License-Identifier: MIT
"""Atlas: charts of several objects, made, flattened and packed together."""

from __future__ import annotations

import numpy as np

from .islands import islands_of
from .layout import Layout
from .messages import Trouble, about_faces, about_vertices
from .placing import CUT_FLAT
from .plane import in_single, orientation
from .polygons import tell_concave
from .surface import Surface
from .unwrap import torn_edges
from .work import Clock, Result, untold


def atlas(
    taut,
    s: Surface,
    *,
    prefer: str = "seams",
    charts: str = "auto",
    keep_seams: bool = False,
    symmetric: bool = False,
    max_distortion: float = 0,
    padding: float = 2,
    resolution: int = 1024,
    tiles: int = 1,
    rotate: bool = True,
    density: float = 0,
    weighted: bool = False,
    mark_seams: bool = True,
    time_limit: float = 0,
    tell=untold,
) -> Result:
    """One atlas of the chosen faces of all objects.

    prefer : "seams", "packing" or "one", as taut.atlas()
    charts : "auto" or "keep": those between the seams that are there
    keep_seams : these are seams of new charts, too
    symmetric : charts are mirror images of each other
    density : texels per unit of the scene; as many tiles as that takes. 0: charts fill `tiles`
    weighted : charts get as many texels as their vertices are painted
    mark_seams : seams become those of the atlas

    Islands of pinned corners stay as they are.
    """
    clock, result = Clock(time_limit), Result.of(s)
    some = np.flatnonzero(s.chosen[s.triangle_face])
    if len(some) == 0:
        raise Trouble("no face is selected; select some, or all")
    if 0 < max_distortion <= 4:
        raise Trouble(f"Max Distortion is {max_distortion:.4g}, but must be above 4, which is none; 0: the usual one")
    if charts == "keep":
        unused = {"Prefer": prefer != "seams", "Keep Seams": keep_seams, "Symmetric": symmetric}
        prefer, symmetric = "seams", False
        unused["Max Distortion"], max_distortion = max_distortion > 0, 0
        result.notes += [f"{name} has no effect on charts that are kept" for name, given in unused.items() if given]
    pinned = pinned_triangles(s, some)
    made = _made(
        taut,
        s,
        result,
        some,
        pinned,
        clock,
        prefer=prefer,
        charts=charts,
        keep_seams=keep_seams,
        symmetric=symmetric,
        max_distortion=max_distortion,
        padding=padding,
        resolution=resolution,
        tiles=tiles,
        rotate=rotate,
    )
    if made is None:
        result.complete = False
        return result
    layout = Layout(taut, s, made, some, pinned, clock, padding, resolution, max(tiles, 1), rotate)
    tell("packing")
    if weighted:
        layout.repack(np.maximum(s.weight[s.vertex[s.triangles[some]]].mean(1), 0.05))
    if density > 0:
        layout.to_density(density)
    place = write_atlas(s, result, made, layout, some)
    tell_concave(s, result)
    if mark_seams:
        inside = np.zeros(len(s.edges), bool)
        inside[s.edge[s.chosen[s.face]]] = True
        result.seam = np.where(inside, torn_edges(s, place), s.seam)
    result.complete = result.complete and made.complete
    result.notes += layout.notes + made.repairs + made.notes
    result.numbers.update(
        charts=layout.charts(),
        tiles=len(np.unique(layout.tile[made.chart >= 0])),
        density=layout.scale() * resolution,
        distortion=made.distortion,
    )
    return result


def pinned_triangles(s: Surface, some: np.ndarray) -> np.ndarray:
    """Triangles of islands, as they lie, that have a pinned corner."""
    stays = np.zeros(s.faces, bool)
    if s.pinned.any():
        for island in islands_of(s, by_uv=True):
            stays[island.faces] = s.pinned[island.corners].any()
    return stays[s.triangle_face[some]]


def _made(taut, s, result, some, pinned, clock, *, charts, keep_seams, symmetric, max_distortion, **options):
    """The atlas of the triangles; None where it was stopped before there was one."""
    corners = s.triangles[some]
    F = s.vertex[corners]
    given = dict(polygons=s.triangle_face[some], single=True, symmetric=symmetric, time_limit=clock.left, **options)
    if charts == "keep":
        given["charts"] = "keep"
        known = np.ptp(s.uv[corners].reshape(-1, 2), axis=0).min() > 0
        if pinned.any() or known and _fits(s, some):
            given["uv"] = s.uv[corners]
    if (charts == "keep" or keep_seams) and s.seam.any():
        given["seams"] = s.edges[s.seam]
    if max_distortion > 4:
        given["max_distortion"] = max_distortion
    if pinned.all():
        raise Trouble("all islands are pinned; clear some pins (Alt P)")
    if pinned.any():
        given.update(pinned=pinned, uv=s.uv[corners])
    used = np.unique(F)
    given["bodies"] = np.searchsorted(s.first_vertex, used, side="right")  # copies at one place are no duplicates
    number = np.zeros(len(s.V), np.int64)
    number[used] = np.arange(len(used))
    if "seams" in given:
        known = np.isin(given["seams"], used).all(1)
        given["seams"] = number[given["seams"][known]]
    try:
        return taut.atlas(s.V[used], number[F], **given)
    except taut.Cancelled as e:
        return e.best
    except taut.NoMap as e:
        raise Trouble(f"no atlas was made: {e}") from e
    except taut.TautError as e:
        raise _explained(e, s, some, used) from e


def _fits(s: Surface, some: np.ndarray) -> bool:
    """Whether the coordinates of now are without flips: a start for charts that are kept."""
    corners = s.triangles[some]
    x = s.uv[corners].reshape(-1, 2)
    return bool((orientation(x, np.arange(len(x)).reshape(-1, 3)) > 0).all())


def _explained(error, s: Surface, some: np.ndarray, used: np.ndarray) -> Trouble:
    fault, ids = getattr(error, "fault", None), np.asarray(getattr(error, "ids", []), np.int64)
    if fault == "not_symmetric":
        what = "no mirror image; correct the mesh (Mesh > Symmetrize), or turn off Symmetric"
        if len(ids):
            return Trouble(about_vertices(s, used[ids], what))
        return Trouble("there is no plane of symmetry; " + what.split("; ")[1])
    if "pinned chart of triangle" in str(error):
        triangle = int(str(error).split("triangle ")[1].split(" ")[0])
        why = str(error).split(f"triangle {triangle} ", 1)[1].split(";")[0]
        if " that of triangle" in why:
            why = "overlaps another pinned one"
        return Trouble(
            about_faces(
                s,
                s.triangle_face[some[[triangle]]],
                f"its pinned island {why}; clear its pins (Alt P), or move it into the tiles",
            )
        )
    return Trouble(str(error))


def write_atlas(s: Surface, result: Result, made, layout: Layout, some: np.ndarray) -> np.ndarray:
    """Writes coordinates by corner; what is wrong with faces is a problem. The atlas's vertex of each corner, or -1."""
    own = made.chart >= 0
    place, divided = places_of_corners(s, made, layout, some)
    other, of = drawn_otherwise(s, place, some, own, divided)
    uv, flat = in_single(layout.uv, np.concatenate([layout.faces[own], other]))
    faces = np.concatenate([s.triangle_face[some[own]], of])
    for these, what in (
        (flat[flat < own.sum()], "too small for the numbers of UV maps; dissolve what is so small"),
        (flat[flat >= own.sum()], CUT_FLAT),
    ):
        if len(these):
            result.problems.append(about_faces(s, faces[these], what))
    if len(divided):
        what = "seams or repairs divide it, and a part of it lies in one point; triangulate it (Ctrl T) and try again"
        result.problems.append(about_faces(s, divided, what))
    touched = place >= 0
    result.uv[touched] = uv[place[touched]]
    result.changed |= touched
    lost = np.setdiff1d(s.triangle_face[some[~own]], divided)
    if len(lost):
        what = "left out of the atlas, as it makes no surface; delete it, or Mesh > Clean Up > Degenerate Dissolve"
        result.problems.append(about_faces(s, lost, what))
    return place


def drawn_otherwise(s: Surface, place: np.ndarray, some: np.ndarray, own: np.ndarray, divided: np.ndarray):
    """Triangles that Blender cuts faces into and the atlas has not, of the atlas's vertices, and their faces; but for
    faces that are divided or left out."""
    there = ~np.isin(s.triangle_face[some], np.r_[divided, s.triangle_face[some[~own]]])
    other = some[there & (s.drawn[some] != s.triangles[some]).any(1)]
    return place[s.drawn[other]], s.triangle_face[other]


def places_of_corners(s: Surface, made, layout: Layout, some: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The atlas's vertex of each corner, and the faces whose triangles do not agree, or are left out in part.

    Of these the largest triangle counts, and those that agree with it; other corners are put at one of its own, so that
    nothing of the face lies over others.
    """
    corners, own = s.triangles[some], made.chart >= 0
    place = np.full(s.corners, -1)
    place[corners[~own].reshape(-1)] = layout.faces[~own].reshape(-1)
    place[corners[own].reshape(-1)] = layout.faces[own].reshape(-1)
    face = s.triangle_face[some]
    wrong = np.unique(face[(place[corners] != layout.faces).any(1) | ~own])
    divided = []
    for f in wrong:
        triangles = np.flatnonzero((face == f) & own)
        if len(triangles) == 0:
            continue
        divided.append(f)
        first = triangles[layout.area[triangles].argmax()]
        known = dict(zip(corners[first].tolist(), layout.faces[first].tolist()))
        for t in triangles:
            if all(known.get(c, v) == v for c, v in zip(corners[t].tolist(), layout.faces[t].tolist())):
                if sum(c in known for c in corners[t].tolist()) >= 2:
                    known.update(zip(corners[t].tolist(), layout.faces[t].tolist()))
        of_face = np.unique(corners[face == f])
        place[of_face] = [known.get(c, layout.faces[first][0]) for c in of_face.tolist()]
    return place, np.array(divided, dtype=np.int64)
