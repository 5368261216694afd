# SPDX-License-Identifier: MIT
"""Accessors of PyVista: `mesh.taut.unwrap()` after `import taut.pyvista`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista

from . import _volumes
from ._atlas import atlas as _atlas
from ._maps import distortion as _distortion
from ._maps import square
from ._maps import unwrap as _unwrap
from .errors import ParameterError


#: Cells by their names, with the names that taut knows.
_KINDS = {"VERTEX": "vertex", "POLY_VERTEX": "vertex", "LINE": "line", "POLY_LINE": "line", "TRIANGLE": "triangle",
          "QUAD": "quad", "TETRA": "tetrahedron", "PYRAMID": "pyramid", "WEDGE": "wedge", "HEXAHEDRON": "hexahedron"}


def _single(options: Any) -> Any:
    """Options of a map whose numbers are float32, as meshes have them."""
    if not options.get("single", True):
        raise ParameterError("single: must be True, as texture coordinates of meshes are float32", field="single")
    return {**options, "single": True}


class Surface:
    """What taut does with a `pyvista.PolyData`. Polygons become triangles, whose data are theirs."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def _triangles(self) -> tuple[Any, Any]:
        """The mesh with triangles alone, and these. Raises `ParameterError` for cells that are no polygons."""
        mesh = self._mesh
        if mesh.n_verts or mesh.n_lines or mesh.n_strips:
            raise ParameterError(
                f"mesh: has {mesh.n_verts} vertices, {mesh.n_lines} lines and {mesh.n_strips} strips that are cells; "
                "leave polygons alone", field="mesh",
            )
        mesh = mesh if mesh.is_all_triangles else mesh.triangulate()
        return mesh, np.asarray(mesh.regular_faces)

    @staticmethod
    def _textured(mesh: Any, vmapping: Any, faces: Any, uv: Any) -> Any:
        made = pyvista.PolyData.from_regular_faces(np.asarray(mesh.points)[vmapping], faces)
        for name in mesh.point_data.keys():
            made.point_data[name] = np.asarray(mesh.point_data[name])[vmapping]
        for name in mesh.cell_data.keys():
            made.cell_data[name] = np.asarray(mesh.cell_data[name])
        for name in mesh.field_data.keys():
            made.field_data[name] = mesh.field_data[name]
        made.active_texture_coordinates = np.asarray(uv, dtype=np.float32)
        return made

    def unwrap(self, **options: Any) -> Any:
        """A copy with texture coordinates, one chart, certified as the float32 that they are; see `taut.unwrap`."""
        mesh, faces = self._triangles()
        flat = _unwrap(mesh.points, faces, **_single({**square(options), "cut": True, **options}))
        if flat.faces is None or flat.vmapping is None:
            return self._textured(mesh, np.arange(mesh.n_points), faces, flat.uv)
        return self._textured(mesh, flat.vmapping, flat.faces, flat.uv)

    def flatten(self, **options: Any) -> Any:
        """The surface in the plane, with an array "distortion"; see `taut.unwrap`."""
        mesh, faces = self._triangles()
        flat = _unwrap(mesh.points, faces, **_single(options))
        whole = flat.faces is None or flat.vmapping is None
        vmapping, faces = (np.arange(mesh.n_points), faces) if whole else (flat.vmapping, flat.faces)
        made = self._textured(mesh, vmapping, faces, flat.uv)
        made.points = np.pad(flat.uv, ((0, 0), (0, 1)))
        made.cell_data["distortion"] = _distortion(np.asarray(mesh.points)[vmapping], faces, flat.uv)
        return made

    def atlas(self, **options: Any) -> Any:
        """A copy with texture coordinates, certified as the float32 that they are, and an array "chart"; see
        `taut.atlas`."""
        mesh, faces = self._triangles()
        made = _atlas(mesh.points, faces, **_single(options))
        textured = self._textured(mesh, *made)
        textured.cell_data["chart"] = made.chart
        return textured

    def bend(self, b: Any, bc: Any, **options: Any) -> Any:
        """A copy that is bent as a thin shell; see `taut.shell`."""
        _, faces = self._triangles()
        made = self._mesh.copy()
        made.points = _volumes.shell(self._mesh.points, faces, b, bc, **options).x
        return made


class Volume:
    """What taut does with a `pyvista.UnstructuredGrid`."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def _moved(self, function: Any, options: dict[str, Any]) -> Any:
        mesh = self._mesh
        kinds = [int(kind) for kind in np.unique(mesh.celltypes)]
        blocks = []
        for kind in kinds:
            name = pyvista.CellType(kind).name
            known = name in _KINDS and name != "POLY_VERTEX" and name != "POLY_LINE"
            blocks.append((name, mesh.cells_dict[kind] if known else np.flatnonzero(mesh.celltypes == kind)))
        V, C, given = _volumes.of_mesh(mesh.points, blocks, _KINDS, options)
        x = function(V, C, **given).x
        made = mesh.copy()
        made.points = np.array(mesh.points, dtype=np.float64)
        made.points[:, : x.shape[1]] = x
        return made

    def deform(self, b: Any, bc: Any, **options: Any) -> Any:
        """A copy whose points `b` come to `bc`; see `taut.deform`."""
        return self._moved(_volumes.deform, {"b": b, "bc": bc, **options})

    def smooth(self, **options: Any) -> Any:
        """A copy with better shaped cells; see `taut.smooth`."""
        return self._moved(_volumes.smooth, options)

    def untangle(self, b: Any = None, **options: Any) -> Any:
        """A copy without inverted cells; see `taut.untangle`."""
        return self._moved(_volumes.untangle, {"b": b, **options})


pyvista.register_dataset_accessor("taut", pyvista.PolyData)(Surface)
pyvista.register_dataset_accessor("taut", pyvista.UnstructuredGrid)(Volume)
