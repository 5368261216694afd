# SPDX-License-Identifier: MIT
"""Meshes of meshio: points move, all else stays."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _volumes
from .errors import ParameterError

_SOLID, _FLAT = ("tetra", "pyramid", "wedge", "hexahedron"), ("triangle", "quad")


def cells(mesh: Any) -> list[Any]:
    """The cells of the highest dimension, an array a block. Raises `ParameterError` where there are none."""
    for kinds in (_SOLID, _FLAT):
        blocks = [np.asarray(block.data) for block in mesh.cells if block.type in kinds]
        if blocks:
            return blocks
    raise ParameterError("mesh: has no cells that are known: " + ", ".join(_SOLID + _FLAT), field="mesh")


def _moved(mesh: Any, x: Any) -> Any:
    import copy

    made = copy.copy(mesh)
    points = np.array(mesh.points, dtype=np.float64)
    points[:, : x.shape[1]] = x
    made.points = points
    return made


def deform(mesh: Any, b: Any, bc: Any, **options: Any) -> Any:
    """A copy of a `meshio.Mesh` whose vertices `b` come to `bc`; see `taut.deform`."""
    return _moved(mesh, _volumes.deform(mesh.points, cells(mesh), b, bc, **options).x)


def smooth(mesh: Any, **options: Any) -> Any:
    """A copy with better shaped cells; see `taut.smooth`."""
    return _moved(mesh, _volumes.smooth(mesh.points, cells(mesh), **options).x)


def untangle(mesh: Any, b: Any = None, **options: Any) -> Any:
    """A copy without inverted cells; see `taut.untangle`."""
    return _moved(mesh, _volumes.untangle(mesh.points, cells(mesh), b, **options).x)
