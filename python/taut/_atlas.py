# SPDX-License-Identifier: MIT
"""Atlases of surfaces."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, overload

import numpy as np

from . import _arrays, _options
from ._arrays import ArrayLike
from ._call import ProgressLike, call
from ._native import native
from ._results import Atlas
from .errors import ParameterError


def _corner_uv(name: str, value: Any, faces: Any, vertices: int) -> Any:
    """Texture coordinates as three rows a triangle: given by corner, (m, 3, 2), or by vertex, (n, 2)."""
    a = _arrays.array(name, value)
    if a.ndim == 3 and a.shape == (len(faces), 3, 2):
        return _arrays.points(name, a.reshape(-1, 2), (2,))
    if a.ndim == 2 and a.shape == (vertices, 2):
        return _arrays.points(name, a, (2,))[np.asarray(faces, dtype=np.int64).reshape(-1)]
    raise ParameterError(
        f"{name}: has the shape {a.shape}, but must be ({len(faces)}, 3, 2) or ({vertices}, 2)", field=name
    )


#: Numbers of `prefer="packing"` that few have a reason to set; and the mesh that each vertex is of, which repair parts.
_TUNING = ("least_fill", "cut_rounds", "unite_rounds", "bodies")


#: Names of the library that are others here.
_NAMES = {"weights": "seam_weights", "initial": "uv", "corner_uv": "uv"}


@overload
def atlas(V: ArrayLike, F: ArrayLike, **options: Any) -> Atlas: ...
@overload
def atlas(V: list[tuple[Any, Any]], F: None = ..., **options: Any) -> list[Atlas]: ...


def atlas(
    V: Any,
    F: Any = None,
    *,
    polygons: ArrayLike = None,
    uv: ArrayLike = None,
    charts: str = "auto",
    prefer: str = "seams",
    seams: ArrayLike = None,
    seam_weights: ArrayLike = None,
    parts: ArrayLike = None,
    pinned: ArrayLike = None,
    symmetric: bool = False,
    hide_seams: float = 0,
    crease_angle: float = 180,
    max_distortion: float | None = None,
    mean_distortion: float | None = None,
    max_stretch: float | None = None,
    resolution: int = 1024,
    padding: float = 2,
    tiles: int = 1,
    aspect: float = 1,
    texels_per_unit: float | None = None,
    max_resolution: int | None = None,
    align: int = 1,
    stack: bool = False,
    rotate: bool = True,
    densities: ArrayLike = None,
    repair: bool = True,
    weld: bool = False,
    single: bool = False,
    time_limit: float | None = None,
    progress: ProgressLike = None,
    device: Any = None,
    **more: Any,
) -> Any:
    """Cut any surface into charts, flatten and pack them, and certify that nothing is flipped or overlaps.

    Parameters
    ----------
    V, F : (n, 3) and (m, 3) array-like
        A surface, closed or not, of any number of parts; with `repair` any triangles. Or V alone, a list of such
        pairs: they get one atlas, and a list is returned.
    polygons : (m,) array-like of int, optional
        The polygon of each triangle; seams keep off their diagonals.
    uv : (m, 3, 2) or (n, 2) array-like, optional
        Texture coordinates of before, for `charts="keep"` and `pinned`.
    charts : {"auto", "keep", "pack"}
        Charts are made, or are what `seams` and `parts` part; these are flattened from `uv`, if given, and packed, or
        packed as they lie in `uv`.
    prefer : {"seams", "packing", "one"}
        Few charts along short seams; more charts that fill squares well; or one chart a component, where it can be.
    seams : (k, 2) array-like of int, optional
        Edges that are seams in any case.
    seam_weights : (k, 3) array-like, optional
        Two vertices of an edge, and a factor of its length, 0.001 to 1000: where seams cost more, or less.
    parts : (m,) array-like of int, optional
        Labels; a seam leads between triangles of different ones.
    pinned : (m,) array-like of bool, optional
        Triangles that stay at `uv`.
    symmetric : bool
        Charts are mirror images of each other.
    hide_seams, crease_angle : float
        How much seams avoid what is seen from outside, 0 to 1; edges bent by more than this, in degrees, are liked.
    max_distortion, mean_distortion : float, optional
        Bounds of the isometric energy of a chart and of the whole, above 4.
    max_stretch : float, optional
        The bound of the whole in other words: its L2 stretch (Sander et al. 2001), above 1; 1.02: texels are 2 % too
        coarse in the mean. Instead of the two bounds before; see `report["stretch_l2"]`.
    resolution, padding, tiles, rotate, densities
        Texels along a tile; least distance of charts in texels; how many tiles; whether charts are turned; a factor of
        the lengths of its chart for each triangle.
    aspect, texels_per_unit, max_resolution, align
        Height of a tile by its width, a power of two (`uv` fill the unit square all the same); a given density, with as
        many of `tiles` as that takes, or with the resolution doubled up to a bound; side of the blocks of texels that
        one chart has alone.
    stack : bool
        Whether charts that are copies in space lie on each other.
    repair : bool
        Whether triangles are made a surface first (`taut.repair`); what that leaves out lies in one point.
    weld : bool
        Whether repair joins vertices that rounding has parted.
    single : bool
        Whether the certificate is of coordinates as float32 holds them.
    time_limit, progress, device
        As in `unwrap`.

    Returns
    -------
    Atlas, or a list of them
        Unpacks as `vmapping, faces, uv`.

    Examples
    --------
    >>> import numpy as np, taut
    >>> V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    >>> vmapping, faces, uv = taut.atlas(V, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> bool((V[vmapping][faces] == V[[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]]).all())
    True
    """
    for name in more:
        if name not in _TUNING:
            raise TypeError(f"atlas() got an unexpected keyword argument {name!r}")
    if F is None:
        alone = {"polygons": polygons, "uv": uv, "seams": seams, "seam_weights": seam_weights, "parts": parts,
                 "pinned": pinned, "densities": densities, "charts": None if charts == "auto" else charts}
        for name, value in alone.items():
            if value is not None:
                raise ParameterError(f"{name}: is of one surface; give V and F of that, several put together", field=name)
        return _several(V, prefer=prefer, resolution=resolution, padding=padding, tiles=tiles, aspect=aspect,
                        texels_per_unit=texels_per_unit, max_resolution=max_resolution, align=align, stack=stack,
                        symmetric=symmetric, hide_seams=hide_seams, crease_angle=crease_angle,
                        rotate=rotate, repair=repair, max_distortion=max_distortion,
                        mean_distortion=mean_distortion, max_stretch=max_stretch, weld=weld, single=single,
                        time_limit=time_limit, progress=progress, device=device, **more)
    points = _arrays.points("V", V, (2, 3), nan=True) if repair else _arrays.points("V", V, (2, 3))
    faces = _arrays.indices("F", F, (3,), len(points))
    m = len(faces)
    _require_fitting(charts, uv, pinned, resolution)
    made = {"prefer": prefer if prefer != "seams" else None, "symmetric": symmetric or None,
            "hide_seams": hide_seams or None, "crease_angle": crease_angle if crease_angle != 180 else None,
            "seam_weights": seam_weights, "max_distortion": max_distortion, "mean_distortion": mean_distortion,
            "max_stretch": max_stretch}
    if charts in ("keep", "pack"):
        _refuse(made, f'charts="{charts}" makes no charts')
    elif pinned is None:
        _refuse({"uv": uv}, 'charts="auto" makes new ones; give `pinned`, or other `charts`')
    if prefer != "packing":
        _refuse(more, 'they tune prefer="packing"')
    if not repair:
        _refuse({"weld": weld or None}, "repair=False welds nothing")
    options: dict[str, Any] = {
        "charts": charts,
        "prefer": prefer,
        "symmetric": symmetric,
        "hide_seams": hide_seams,
        "crease_angle": crease_angle,
        "max_distortion": max_distortion,
        "mean_distortion": _mean_bound(max_distortion, mean_distortion, max_stretch),
        "resolution": resolution,
        "padding": padding,
        "tiles": tiles,
        "aspect": aspect,
        "texels_per_unit": texels_per_unit,
        "max_resolution": max_resolution,
        "align": align,
        "stack": stack,
        "rotate": rotate,
        "repair": repair,
        "weld": weld,
        "single": single,
        "time_limit": time_limit,
        "device": _options.device(device),
        **more,
    }
    if polygons is not None:
        options["polygons"] = _arrays.labels("polygons", polygons, m)
    if parts is not None:
        options["parts"] = np.unique(_arrays.labels("parts", parts, m, least=None), return_inverse=True)[1].reshape(-1)
    if seams is not None:
        options["seams"] = _arrays.indices("seams", seams, (2,), len(points))
        _require_edges("seams", options["seams"], faces, len(points))
    if seam_weights is not None:
        options["weighted_edges"], options["edge_weights"] = _weighted_edges(seam_weights, faces, len(points))
    if uv is not None:
        options["corner_uv"] = _corner_uv("uv", uv, faces, len(points))
    if pinned is not None:
        options["pinned"] = _arrays.numbers("pinned", pinned, m)
    if densities is not None:
        options["densities"] = _arrays.numbers("densities", densities, m)
    return call(native().atlas, points, faces, options, progress=progress, make=Atlas.of, names=_NAMES)


def _refuse(given: dict[str, Any], why: str) -> None:
    """Raises `ParameterError` for arguments that would have no effect."""
    for name, value in given.items():
        if value is not None and name != "bodies":
            raise ParameterError(f"{name}: has no effect, as {why}", field=name)


def _require_fitting(charts: str, uv: Any, pinned: Any, resolution: Any) -> None:
    """Raises `ParameterError` for arguments that do not fit together."""
    if charts == "pack" and uv is None:
        raise ParameterError('uv: is not given, but charts="pack" packs charts as they lie in it', field="uv")
    if pinned is not None and uv is None:
        raise ParameterError("uv: is not given, but `pinned` triangles stay where it has them", field="uv")
    if isinstance(resolution, (tuple, list, np.ndarray)) and np.ndim(resolution):
        raise ParameterError(
            f"resolution: is {resolution}, but must be one number, the texels along the width of a tile; `aspect` is "
            "its height by its width",
            field="resolution",
        )


def _mean_bound(max_distortion: Any, mean_distortion: Any, max_stretch: Any) -> Any:
    """The bound of the mean distortion, given as such or as a stretch.

    At the scale that keeps the area the mean of s1^2 + s2^2 is 2 at least, so that twice the square of the stretch is
    at most the energy less 2.
    """
    if max_stretch is None:
        return mean_distortion
    if max_distortion is not None or mean_distortion is not None:
        raise ParameterError(
            "max_stretch: is a bound of the mean distortion; leave out max_distortion and mean_distortion",
            field="max_stretch",
        )
    max_stretch = _arrays.number("max_stretch", max_stretch)
    if not 1 < max_stretch < np.inf:
        raise ParameterError(
            f"max_stretch: is {max_stretch}, but must be above 1, that of no stretch", field="max_stretch"
        )
    return 2 + 2 * max_stretch * max_stretch


def _weighted_edges(rows: Any, faces: Any, vertices: int) -> tuple[Any, Any]:
    """Edges and the factors of their lengths. Raises `ParameterError` for what is no edge."""
    name = "seam_weights"
    rows = _arrays.points(name, rows, (3,))
    edges = _arrays.indices(name, rows[:, :2], (2,), vertices)
    factors = rows[:, 2].astype(np.float64)
    bad = np.flatnonzero(~((factors >= 1e-3) & (factors <= 1e3)))
    if len(bad):
        raise ParameterError(
            f"{name}: row {bad[0]} has the factor {factors[bad[0]]:g}, but they go from 0.001 to 1000",
            field=name, ids=[bad[0]],
        )
    _require_edges(name, edges, faces, vertices)
    return edges, factors


def _require_edges(name: str, edges: Any, faces: Any, vertices: int) -> None:
    """Raises `ParameterError` for two vertices that no edge joins."""
    F = np.asarray(faces, dtype=np.int64)
    known = np.sort(np.stack([F, np.roll(F, -1, 1)], 2).reshape(-1, 2), 1)
    a = np.sort(edges.astype(np.int64), 1)
    missing = np.flatnonzero(~np.isin(a[:, 0] * vertices + a[:, 1], known[:, 0] * vertices + known[:, 1]))
    if len(missing):
        i, j = edges[missing[0]]
        raise ParameterError(
            f"{name}: row {missing[0]} names the vertices {i} and {j}, which no edge joins", field=name, ids=[i, j]
        )


def _several(meshes: Any, **options: Any) -> list[Atlas]:
    """One atlas of several surfaces, and the part of each in it."""
    if isinstance(meshes, np.ndarray) or not np.iterable(meshes):
        raise ParameterError("F: is not given; without it V must be a list of pairs, (V, F)", field="F")
    pairs = [_options.pair(f"mesh {k}", mesh) for k, mesh in enumerate(meshes)]
    if not pairs:
        return []
    first = np.cumsum([0] + [len(V) for V, _ in pairs])
    whole = atlas(
        np.concatenate([np.asarray(V, dtype=np.float64) for V, _ in pairs]),
        np.concatenate([np.asarray(F, dtype=np.int64) + f for (_, F), f in zip(pairs, first)]),
        bodies=np.repeat(np.arange(len(pairs)), [len(V) for V, _ in pairs]),
        **options,
    )
    return _split(whole, [len(V) for V, _ in pairs], [len(F) for _, F in pairs])


def _split(whole: Atlas, vertices: list[int], triangles: list[int]) -> list[Atlas]:
    """The parts of an atlas of several surfaces that were put together, with so many vertices and triangles each."""
    first, start = np.cumsum([0] + vertices), np.cumsum([0] + triangles)
    made = []
    for k in range(len(vertices)):
        faces = whole.faces[start[k] : start[k + 1]]
        used, inverse = np.unique(faces, return_inverse=True)
        made.append(
            replace(
                whole,
                vmapping=whole.vmapping[used] - first[k],
                faces=inverse.reshape(faces.shape).astype(np.int64),
                uv=whole.uv[used],
                chart=whole.chart[start[k] : start[k + 1]],
                tile=whole.tile[start[k] : start[k + 1]],
            )
        )
    return made
