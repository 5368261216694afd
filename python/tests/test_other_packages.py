# SPDX-License-Identifier: MIT
"""Meshes of other packages."""

from __future__ import annotations

import functools
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


def tetrahedron_and_another():
    """A tetrahedron, and beside it a cell of second order that shares three corners."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
    q = [1, 2, 3, 4]
    ends = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    middles = np.array([(corners[q[a]] + corners[q[b]]) / 2 for a, b in ends])
    return np.concatenate([corners, middles]), [[0, 1, 2, 3]], [q + list(range(5, 11))]


PINS = ([0, 1, 2, 3], [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]])


def refuses(kind, deform, smooth, untangle):
    """Whether cells of that kind are refused by all calls."""
    for call in (lambda: deform(*PINS), smooth, untangle):
        with pytest.raises(taut.ParameterError, match=f"cells of the kind {kind}, which are not known"):
            call()


def test_cells_of_meshio_that_are_not_known_are_refused_and_not_left_out():
    meshio = pytest.importorskip("meshio")
    V, one, other = tetrahedron_and_another()
    polyhedron = [[np.array(f) for f in ([1, 2, 3], [1, 2, 4], [2, 3, 4], [1, 3, 4])]]
    for kind, cells in [("tetra10", other), ("polyhedron4", polyhedron), ("line3", [[0, 1, 5]]), ("polygon", [[0, 1, 2]])]:
        for blocks in ([("tetra", one), (kind, cells)], [(kind, cells), ("tetra", one)], [(kind, cells)]):
            m = meshio.Mesh(V, blocks)
            refuses(kind, *(functools.partial(getattr(taut.meshio, n), m) for n in ("deform", "smooth", "untangle")))


def test_cells_of_pyvista_that_are_not_known_are_refused_and_not_left_out():
    pyvista = pytest.importorskip("pyvista")
    import taut.pyvista as wrapper

    V, one, other = tetrahedron_and_another()
    for kind, m in [("QUADRATIC_TETRA", pyvista.UnstructuredGrid({10: np.array(one), 24: np.array(other)}, V)),
                    ("VOXEL", pyvista.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid())]:
        volume = wrapper.Volume(m)
        refuses(kind, volume.deform, volume.smooth, volume.untangle)
    with pytest.raises(taut.ParameterError, match="1 lines"):
        wrapper.Surface(pyvista.PolyData(V, lines=[2, 0, 1], faces=[3, 0, 1, 2])).atlas()


@pytest.mark.parametrize("z", [0.0, 5.0, -0.3])
@pytest.mark.parametrize("kind", ["triangle", "quad"])
def test_meshes_of_the_plane_lie_at_any_z(kind, z):
    meshio, pyvista = pytest.importorskip("meshio"), pytest.importorskip("pyvista")
    import taut.pyvista as _  # noqa: F401

    x, y = np.meshgrid(np.arange(4.0), np.arange(4.0))
    V = np.c_[x.ravel(), y.ravel(), np.full(16, z)]
    a = np.array([4 * j + i for j in range(3) for i in range(3)])
    quads = np.c_[a, a + 1, a + 5, a + 4]
    C = quads if kind == "quad" else np.r_[quads[:, :3], quads[:, [0, 2, 3]]]
    rim = [v for v in range(16) if v not in (5, 6, 9, 10)]
    moved = V[rim] + [0.2, 0, 0] * (V[rim, 1:2] > 1)
    messy = V + np.where(np.isin(np.arange(16), rim), 0, 0.3)[:, None] * [1, 0.5, 0]
    grid = pyvista.UnstructuredGrid({pyvista.CellType.QUAD if kind == "quad" else pyvista.CellType.TRIANGLE: C}, messy)
    for places in (moved, moved[:, :2]):
        for made in (taut.meshio.deform(meshio.Mesh(messy, [(kind, C)]), rim, places).points,
                     grid.taut.deform(rim, places).points):
            assert (made[rim] == moved).all() and (made[:, 2] == z).all()
            assert taut.certify(C[:, :3], made[:, :2]) and taut.certify(np.roll(C, 2, 1)[:, :3], made[:, :2])
    for made in (taut.meshio.smooth(meshio.Mesh(messy, [(kind, C)])).points, grid.taut.smooth().points,
                 taut.meshio.untangle(meshio.Mesh(messy, [(kind, C)]), rim).points, grid.taut.untangle(rim).points):
        assert (made[:, 2] == z).all() and taut.certify(C[:, :3], made[:, :2])
    with pytest.raises(taut.ParameterError, match="bc: row 1 has z = 7.0, but the mesh lies in the plane"):
        taut.meshio.deform(meshio.Mesh(V, [(kind, C)]), rim[:2], [V[0], [1, 0, 7]])
    with pytest.raises(taut.ParameterError, match="shell"):
        taut.meshio.smooth(meshio.Mesh(V + np.c_[0 * V[:, :2], x.ravel()], [(kind, C)]))


def test_textures_of_pyvista_are_certified_as_they_are_stored_and_keep_data():
    pyvista = pytest.importorskip("pyvista")
    import taut.pyvista as _  # noqa: F401

    y, n = np.array([0, 1, 2, 2 + 2e-9, 3, 4]), 6
    V = np.array([(i, h, 0.2 * np.sin(i)) for h in y for i in range(n)])
    a = np.array([n * j + i for j in range(5) for i in range(n - 1)])
    F = np.r_[np.c_[a, a + 1, a + n + 1], np.c_[a, a + n + 1, a + n]]
    mesh = pyvista.PolyData.from_regular_faces(V, F)
    for made in (mesh.taut.unwrap(), mesh.taut.atlas(), mesh.taut.unwrap(b=[0, 5], bc=[[0.1, 0.1], [0.7, 0.1]])):
        uv = np.asarray(made.active_texture_coordinates)
        assert uv.dtype == np.float32 and taut.certify(made.regular_faces, uv)
    plate = pyvista.Plane(i_resolution=3, j_resolution=2)
    plate.cell_data["id"] = np.arange(6)
    for made in (plate.taut.unwrap(), plate.taut.atlas(), plate.taut.flatten()):
        assert sorted(made.cell_data["id"]) == sorted([*range(6)] * 2)
        middle = made.points[made.regular_faces].mean(1) if made.n_points and "distortion" not in made.cell_data else None
        if middle is not None:
            near = np.linalg.norm(middle[:, None] - plate.cell_centers().points, axis=-1).argmin(1)
            assert (near == made.cell_data["id"]).all()
