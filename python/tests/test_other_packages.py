# SPDX-License-Identifier: MIT
"""Meshes of other packages."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import taut


def test_modules_are_there_without_an_import_of_their_own():
    words = "import sys, taut; assert 'taut.grids' not in sys.modules; print(taut.compat.xatlas.parametrize, taut.grids)"
    subprocess.run([sys.executable, "-c", words], check=True)


def test_meshes_of_trimesh(torus, bowl):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(*torus, process=False)
    made = taut.trimesh.unwrap(mesh)
    assert made.visual.uv.shape == (len(made.vertices), 2) and len(made.faces) == len(mesh.faces)
    assert np.allclose(made.triangles, mesh.triangles)
    one = taut.trimesh.unwrap(trimesh.Trimesh(*bowl, process=False), one_chart=True)
    assert len(one.vertices) == len(bowl[0]) and one.visual.uv.max() <= 1


def test_meshes_of_meshio(bar):
    meshio = pytest.importorskip("meshio")
    V, C = bar
    mesh = meshio.Mesh(V, [("tetra", C)], cell_data={"k": [np.arange(len(C))]})
    low = np.flatnonzero(V[:, 2] == 0)
    made = taut.meshio.deform(mesh, np.r_[low, len(V) - 1], np.r_[V[low], [V[-1] + [0.5, 0, 0]]])
    assert (made.points[-1] == V[-1] + [0.5, 0, 0]).all() and made.cell_data["k"] is mesh.cell_data["k"]
    assert (mesh.points == V).all() and taut.certify(C, made.points)
    assert taut.certify(C, taut.meshio.smooth(mesh).points)
    with pytest.raises(taut.ParameterError, match="tetra"):
        taut.meshio.smooth(meshio.Mesh(V, [("line", [[0, 1]])]))


def test_meshes_of_pyvista(torus, bowl, bar):
    pyvista = pytest.importorskip("pyvista")
    import taut.pyvista  # noqa: F401

    mesh = pyvista.PolyData.from_regular_faces(*torus)
    mesh.point_data["height"] = torus[0][:, 2]
    made = mesh.taut.atlas()
    assert made.active_texture_coordinates.shape == (made.n_points, 2) and "chart" in made.cell_data
    assert np.allclose(made.point_data["height"], made.points[:, 2])
    disk = pyvista.PolyData.from_regular_faces(*bowl)
    flat = disk.taut.flatten()
    assert np.allclose(flat.points[:, 2], 0) and np.isfinite(flat.cell_data["distortion"]).all()
    assert disk.taut.unwrap().n_points == disk.n_points
    V, C = bar
    grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: C}, V)
    assert taut.certify(C, grid.taut.smooth().points)
