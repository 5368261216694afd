# SPDX-License-Identifier: MIT
"""Cut and paste."""

from __future__ import annotations

from typing import Any

from . import _arrays, _options
from ._arrays import ArrayLike
from ._call import ProgressLike, call
from ._native import native
from ._results import Pasted
from .errors import ParameterError


def paste(
    target: Any,
    source: Any,
    onto: int,
    *,
    at: int | None = None,
    radius: float | None = None,
    faces: ArrayLike = None,
    turn: float = 0.0,
    scale: float = 1.0,
    shift: ArrayLike = None,
    softness: float = 0.0,
    reach: float = 1.8,
    unfold: bool = True,
    time_limit: float | None = None,
    progress: ProgressLike = None,
    device: Any = None,
) -> Pasted:
    """Paste a part of one surface on another one.

    Parameters
    ----------
    target, source : (V, F)
        Two surfaces.
    onto : int
        The vertex of the target that the feature comes to lie on.
    at, radius : int, float
        The feature: what lies within so far of this vertex of the source, along the surface.
    faces : (k,) array-like of int, or (m,) of bool
        Or these triangles of the source, one disk.
    turn, scale, shift, softness
        Radians about the normal; a factor; a displacement; 0: the feature keeps its shape, 1: its rim lies on the
        target, between: between.
    reach : float
        Radius of the part of the target that makes room, by that of the rim.
    unfold : bool
        Whether another softness is taken where triangles fold back.

    Returns
    -------
    Pasted
        Unpacks as `V, F`.

    Examples
    --------
    >>> import numpy as np, taut
    >>> x, y = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9)))
    >>> a = np.array([9 * i + j for i in range(8) for j in range(8)])
    >>> F = np.r_[np.c_[a, a + 1, a + 10], np.c_[a, a + 10, a + 9]]
    >>> flat, hill = np.c_[x, y, 0 * x], np.c_[x, y, np.exp(-9 * (x * x + y * y))]
    >>> V, _ = taut.paste((flat, F), (hill, F), 40, at=40, radius=1.0)
    >>> bool(V[:, 2].max() > 0.5)
    True
    """
    V, F = _options.pair("target", target, planar=False)
    source_V, source_F = _options.pair("source", source, planar=False)
    options: dict[str, Any] = {
        "onto": _arrays.vertex("onto", onto, len(V)),
        "turn": turn,
        "scale": scale,
        "softness": softness,
        "reach": reach,
        "unfold": unfold,
        "time_limit": time_limit,
        "device": _options.device(device),
    }
    if shift is not None:
        options["shift"] = _arrays.numbers("shift", shift, 3)
    if faces is not None:
        if at is not None or radius is not None:
            raise ParameterError("faces: are given, and at, radius have no effect then; leave one out", field="faces")
        options["faces"] = _arrays.ids("faces", faces, len(source_F))
    elif at is not None and radius is not None:
        options["at"] = _arrays.vertex("at", at, len(source_V))
        options["radius"] = _arrays.number("radius", radius)
    else:
        raise ParameterError("faces: give them, or a vertex and a radius (at, radius)", field="faces")

    def make(d: dict[str, Any]) -> Pasted:
        taken = {name: d.pop(name) for name in ("V", "F", "vmapping", "first_gap", "first_feature")}
        return Pasted(**taken, report=d)

    return call(native().paste, V, F, source_V, source_F, options, progress=progress, make=make)
