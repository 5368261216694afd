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
    """
    V, F = _options.surface(*target, names=("V of target", "F of target"), planar=False)
    source_V, source_F = _options.surface(*source, names=("V of source", "F of source"), planar=False)
    options: dict[str, Any] = {
        "onto": int(_arrays.ids("onto", [onto], len(V))[0]),
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
        options["faces"] = _arrays.ids("faces", faces, len(source_F))
    elif at is not None and radius is not None:
        options["at"] = int(_arrays.ids("at", [at], len(source_V))[0])
        options["radius"] = float(radius)
    else:
        raise ParameterError("faces: give them, or a vertex and a radius (at, radius)", field="faces")

    def make(d: dict[str, Any]) -> Pasted:
        taken = {name: d.pop(name) for name in ("V", "F", "vmapping", "first_gap", "first_feature")}
        return Pasted(**taken, report=d)

    return call(native().paste, V, F, source_V, source_F, options, progress=progress, make=make)
