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
    a = np.asarray(value)
    if a.ndim == 3 and a.shape == (len(faces), 3, 2):
        return _arrays.points(name, a.reshape(-1, 2), (2,))
    if a.ndim == 2 and a.shape == (vertices, 2):
        return _arrays.points(name, a, (2,))[np.asarray(faces, dtype=np.int64).reshape(-1)]
    raise ParameterError(
        f"{name}: has the shape {a.shape}, but must be ({len(faces)}, 3, 2) or ({vertices}, 2)", field=name
    )


#: Numbers of `prefer="packing"` that few have a reason to set.
_TUNING = ("least_fill", "cut_rounds", "unite_rounds")


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
    parts: ArrayLike = None,
    pinned: ArrayLike = None,
    symmetric: bool = False,
    hide_seams: float = 0,
    crease_angle: float = 180,
    max_distortion: float | None = None,
    mean_distortion: float | None = None,
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
    resolution, padding, tiles, rotate, densities
        Texels along a tile; least distance of charts in texels; how many tiles; whether charts are turned; a factor of
        lengths for each chart.
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
        return _several(V, prefer=prefer, resolution=resolution, padding=padding, tiles=tiles, aspect=aspect,
                        texels_per_unit=texels_per_unit, max_resolution=max_resolution, align=align, stack=stack,
                        hide_seams=hide_seams, crease_angle=crease_angle,
                        rotate=rotate, repair=repair, max_distortion=max_distortion,
                        mean_distortion=mean_distortion, weld=weld, single=single,
                        time_limit=time_limit, progress=progress, device=device, **more)
    points = _arrays.points("V", V, (2, 3), nan=True) if repair else _arrays.points("V", V, (2, 3))
    faces = _arrays.indices("F", F, (3,), len(points))
    m = len(faces)
    options: dict[str, Any] = {
        "charts": charts,
        "prefer": prefer,
        "symmetric": symmetric,
        "hide_seams": hide_seams,
        "crease_angle": crease_angle,
        "max_distortion": max_distortion,
        "mean_distortion": mean_distortion,
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
        options["polygons"] = _arrays.numbers("polygons", polygons, m)
    if parts is not None:
        options["parts"] = _arrays.numbers("parts", parts, m)
    if seams is not None:
        options["seams"] = _arrays.indices("seams", seams, (2,), len(points))
    if uv is not None:
        options["corner_uv"] = _corner_uv("uv", uv, faces, len(points))
    if pinned is not None:
        options["pinned"] = _arrays.numbers("pinned", pinned, m)
    if densities is not None:
        options["densities"] = _arrays.numbers("densities", densities)
    return call(native().atlas, points, faces, options, progress=progress, make=Atlas.of)


def _several(meshes: Any, **options: Any) -> list[Atlas]:
    """One atlas of several surfaces, and the part of each in it."""
    pairs = [_options.surface(*mesh, names=(f"V of mesh {k}", f"F of mesh {k}")) for k, mesh in enumerate(meshes)]
    if not pairs:
        return []
    first = np.cumsum([0] + [len(V) for V, _ in pairs])
    whole = atlas(
        np.concatenate([np.asarray(V, dtype=np.float64) for V, _ in pairs]),
        np.concatenate([np.asarray(F, dtype=np.int64) + f for (_, F), f in zip(pairs, first)]),
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
