# SPDX-License-Identifier: MIT
"""Accessors of PyVista: `mesh.taut.unwrap()` after `import taut.pyvista`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista

from . import _volumes
from ._atlas import atlas as _atlas
from ._maps import distortion as _distortion
from ._maps import unwrap as _unwrap


def _triangles(mesh: Any) -> Any:
    return np.asarray(mesh.regular_faces if mesh.is_all_triangles else mesh.triangulate().regular_faces)


class Surface:
    """What taut does with a `pyvista.PolyData`."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def _textured(self, vmapping: Any, faces: Any, uv: Any) -> Any:
        made = pyvista.PolyData.from_regular_faces(np.asarray(self._mesh.points)[vmapping], faces)
        for name in self._mesh.point_data.keys():
            made.point_data[name] = np.asarray(self._mesh.point_data[name])[vmapping]
        if len(faces) == self._mesh.n_cells:
            for name in self._mesh.cell_data.keys():
                made.cell_data[name] = np.asarray(self._mesh.cell_data[name])
        made.active_texture_coordinates = np.asarray(uv, dtype=np.float32)
        return made

    def unwrap(self, **options: Any) -> Any:
        """A copy with texture coordinates, one chart; see `taut.unwrap`."""
        faces = _triangles(self._mesh)
        flat = _unwrap(self._mesh.points, faces, **{"placement": "unit_square", "cut": True, **options})
        if flat.faces is None or flat.vmapping is None:
            return self._textured(np.arange(self._mesh.n_points), faces, flat.uv)
        return self._textured(flat.vmapping, flat.faces, flat.uv)

    def flatten(self, **options: Any) -> Any:
        """The surface in the plane, with an array "distortion"; see `taut.unwrap`."""
        faces = _triangles(self._mesh)
        flat = _unwrap(self._mesh.points, faces, **options)
        made = self._textured(np.arange(self._mesh.n_points), faces, flat.uv)
        made.points = np.pad(flat.uv, ((0, 0), (0, 1)))
        made.cell_data["distortion"] = _distortion(self._mesh.points, faces, flat.uv)
        return made

    def atlas(self, **options: Any) -> Any:
        """A copy with texture coordinates and an array "chart"; see `taut.atlas`."""
        made = _atlas(self._mesh.points, _triangles(self._mesh), **options)
        mesh = self._textured(*made)
        mesh.cell_data["chart"] = made.chart
        return mesh

    def bend(self, b: Any, bc: Any, **options: Any) -> Any:
        """A copy that is bent as a thin shell; see `taut.shell`."""
        mesh = self._mesh.copy()
        mesh.points = _volumes.shell(self._mesh.points, _triangles(self._mesh), b, bc, **options).x
        return mesh


class Volume:
    """What taut does with a `pyvista.UnstructuredGrid`."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def _cells(self) -> list[Any]:
        known = {int(t) for t in (pyvista.CellType.TETRA, pyvista.CellType.PYRAMID, pyvista.CellType.WEDGE,
                                  pyvista.CellType.HEXAHEDRON)}
        return [np.asarray(cells) for kind, cells in self._mesh.cells_dict.items() if int(kind) in known]

    def _moved(self, x: Any) -> Any:
        mesh = self._mesh.copy()
        mesh.points = np.asarray(x)
        return mesh

    def deform(self, b: Any, bc: Any, **options: Any) -> Any:
        """A copy whose points `b` come to `bc`; see `taut.deform`."""
        return self._moved(_volumes.deform(self._mesh.points, self._cells(), b, bc, **options).x)

    def smooth(self, **options: Any) -> Any:
        """A copy with better shaped cells; see `taut.smooth`."""
        return self._moved(_volumes.smooth(self._mesh.points, self._cells(), **options).x)

    def untangle(self, b: Any = None, **options: Any) -> Any:
        """A copy without inverted cells; see `taut.untangle`."""
        return self._moved(_volumes.untangle(self._mesh.points, self._cells(), b, **options).x)


pyvista.register_dataset_accessor("taut", pyvista.PolyData)(Surface)
pyvista.register_dataset_accessor("taut", pyvista.UnstructuredGrid)(Volume)
