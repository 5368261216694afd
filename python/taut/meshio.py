# SPDX-License-Identifier: MIT
"""Meshes of meshio: points move, all else stays."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from . import _volumes

#: Cells by their names, with the names that taut knows.
_KINDS = {"vertex": "vertex", "line": "line", "triangle": "triangle", "quad": "quad", "tetra": "tetrahedron",
          "pyramid": "pyramid", "wedge": "wedge", "hexahedron": "hexahedron"}


def _parts(mesh: Any, options: dict[str, Any]) -> Any:
    return _volumes.of_mesh(mesh.points, [(str(block.type), block.data) for block in mesh.cells], _KINDS, options)


def cells(mesh: Any) -> list[Any]:
    """The cells of the highest dimension, an array a block. Raises `ParameterError` where there are none, or others."""
    blocks: list[Any] = _parts(mesh, {})[1]
    return blocks


def _moved(mesh: Any, x: Any) -> Any:
    made = copy.copy(mesh)
    points = np.array(mesh.points, dtype=np.float64)
    points[:, : x.shape[1]] = x
    made.points = points
    return made


def deform(mesh: Any, b: Any, bc: Any, **options: Any) -> Any:
    """A copy of a `meshio.Mesh` whose vertices `b` come to `bc`; see `taut.deform`. Of a mesh in a plane z = const
    places have two numbers, or three, the last one z."""
    V, C, given = _parts(mesh, {"b": b, "bc": bc, **options})
    return _moved(mesh, _volumes.deform(V, C, **given).x)


def smooth(mesh: Any, **options: Any) -> Any:
    """A copy with better shaped cells; see `taut.smooth`."""
    V, C, given = _parts(mesh, options)
    return _moved(mesh, _volumes.smooth(V, C, **given).x)


def untangle(mesh: Any, b: Any = None, **options: Any) -> Any:
    """A copy without inverted cells; see `taut.untangle`."""
    V, C, given = _parts(mesh, {"b": b, **options})
    return _moved(mesh, _volumes.untangle(V, C, **given).x)
