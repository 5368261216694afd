# SPDX-License-Identifier: MIT
"""Surfaces made of triangles as files have them."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arrays
from ._arrays import ArrayLike
from ._call import named
from ._native import native
from ._results import Repaired


def repair(V: ArrayLike, F: ArrayLike, *, weld: float | bool = False, polygons: ArrayLike = None) -> Repaired:
    """Make an oriented manifold of raw triangles. What is wrong with a part is mended there; all else stays.

    Parameters
    ----------
    V, F : (n, 3) and (m, 3) array-like
        Coordinates may be NaN and indices out of range: such triangles are left out.
    weld : float or bool
        Ends of open edges at most so far apart are one place; True: as far as rounding parts them.
    polygons : (m,) array-like of int, optional
        The polygon of each triangle; triangles of one stay together.

    Examples
    --------
    >>> import taut
    >>> r = taut.repair([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 1]])
    >>> r.F.tolist(), r.notes
    ([[0, 1, 2]], ['1 triangle (1) naming a vertex twice; left out'])
    """
    points = _arrays._shape("V", _arrays._numbers("V", V, nan=True), (3,))
    faces = _arrays._shape("F", _arrays._numbers("F", F), (3,))
    flag = isinstance(weld, (bool, np.bool_))
    options: dict[str, Any] = {"usual_weld": flag and bool(weld)}
    if not flag:
        options["weld"] = _arrays.number("weld", weld)
    if polygons is not None:
        options["polygons"] = _arrays.labels("polygons", polygons, len(faces))
    with named({"weld_tolerance": "weld"}):
        return Repaired(**native().repair(points, faces, options))
