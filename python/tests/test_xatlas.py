# SPDX-License-Identifier: MIT
"""The interface of xatlas."""

from __future__ import annotations

import inspect

import numpy as np
import pytest
from conftest import bowl_of

import taut
import taut.compat.xatlas as mine


def test_results_have_the_types_of_xatlas(torus):
    V, F = torus
    vmapping, indices, uvs = mine.parametrize(V.astype(np.float32), F.astype(np.uint32), np.zeros_like(V))
    assert (vmapping.dtype, indices.dtype, uvs.dtype) == (np.uint32, np.uint32, np.float32)
    assert (vmapping[indices] == F).all() and uvs.min() >= 0 and uvs.max() <= 1
    assert taut.certify(indices, uvs)


def test_names_and_defaults_are_those_of_xatlas():
    theirs = pytest.importorskip("xatlas")
    for name in ("Atlas", "Chart", "ChartOptions", "PackOptions", "ChartType"):
        wanted = {n for n in dir(getattr(theirs, name)) if not n.startswith("_")} - {"name", "value"}
        fields = set(getattr(getattr(mine, name), "__dataclass_fields__", {}))
        assert wanted <= {n for n in dir(getattr(mine, name))} | fields, name
    for name in ("ChartOptions", "PackOptions"):
        ours, other = getattr(mine, name)(), getattr(theirs, name)()
        for field in vars(ours):
            assert getattr(ours, field) == pytest.approx(getattr(other, field)), field
    assert list(inspect.signature(mine.parametrize).parameters) == ["positions", "indices", "normals", "uvs"]
    assert list(inspect.signature(mine.export).parameters) == ["path", "positions", "indices", "uvs", "normals"]


def test_an_atlas_of_several_meshes(torus, bowl):
    atlas = mine.Atlas()
    atlas.add_mesh(*torus)
    atlas.add_mesh(*bowl)
    packing = mine.PackOptions()
    packing.resolution, packing.padding, packing.create_image = 256, 2, True
    atlas.generate(mine.ChartOptions(), packing)
    assert len(atlas) == atlas.mesh_count == 2 and atlas.atlas_count == 1 and atlas.width == atlas.height == 256
    assert atlas.chart_count == sum(atlas.get_mesh_chart_count(k) for k in range(2))
    assert 0 < atlas.utilization <= 1 and atlas.get_utilization(0) == atlas.utilization and atlas.texels_per_unit > 0
    for k, (V, F) in enumerate((torus, bowl)):
        vmapping, indices, uvs = atlas[k]
        assert (vmapping[indices] == F).all()
        atlases, charts = atlas.get_mesh_vertex_assignment(k)
        assert len(atlases) == len(charts) == len(vmapping) and charts.max() + 1 == atlas.get_mesh_chart_count(k)
        faces = np.concatenate([atlas.get_mesh_chart(k, c).faces for c in range(atlas.get_mesh_chart_count(k))])
        assert sorted(faces.tolist()) == list(range(len(F)))
    image = atlas.chart_image
    assert image.shape == (256, 256, 3) and image.dtype == np.uint8
    assert (image.any(2).mean()) == pytest.approx(atlas.utilization, abs=0.05)


def test_charts_that_are_there_are_only_packed():
    V, F = bowl_of(6)
    uv = V[:, :2]
    other = np.r_[F, F + len(V)]
    atlas = mine.Atlas()
    atlas.add_uv_mesh(np.r_[uv, uv * 2], other)
    atlas.generate()
    assert atlas.chart_count == 2
    vmapping, indices, uvs = atlas[0]
    lengths = [np.linalg.norm(uvs[indices[k, 0]].astype(float) - uvs[indices[k, 1]]) for k in (0, len(F))]
    assert lengths[1] == pytest.approx(2 * lengths[0], rel=1e-4)


def test_texels_per_unit_give_the_resolution(torus):
    atlas = mine.Atlas()
    atlas.add_mesh(*torus)
    options = mine.PackOptions()
    options.texels_per_unit = 20.0
    atlas.generate(pack_options=options)
    assert atlas.texels_per_unit == pytest.approx(20, rel=0.15)


def test_errors_are_those_of_xatlas(torus):
    V, F = torus
    atlas = mine.Atlas()
    for arguments, words in [
        ((np.zeros(1), F), "Nx3"), ((np.zeros((1, 1)), F), "Nx3"), ((V, np.zeros(1)), "Nx3"),
        ((V, np.zeros((1, 1))), "Nx3"), ((V, F, np.zeros((1, 3))), "first dimension"),
        ((V, F, V, np.zeros((1, 1))), "Nx2"), ((V, F, V, np.zeros((1, 2))), "first dimension"),
    ]:
        with pytest.raises(ValueError, match=words):
            atlas.add_mesh(*arguments)
    with pytest.raises(RuntimeError, match="out of range"):
        atlas.add_mesh(V[:1], F)
    with pytest.raises(IndexError, match="out of bounds"):
        atlas.get_mesh(0)
    atlas.add_mesh(V, F)
    atlas.generate()
    for wrong in (lambda: atlas[1], lambda: atlas.get_mesh_chart(0, 10**6), lambda: atlas.get_utilization(3)):
        with pytest.raises(IndexError, match="out of bounds"):
            wrong()
    with pytest.raises(RuntimeError, match="image"):
        atlas.chart_image


def test_export_writes_what_is_read_back(tmp_path, torus):
    V, F = torus
    vmapping, indices, uvs = mine.parametrize(V, F)
    mine.export(str(tmp_path / "out.obj"), V[vmapping], indices, uvs)
    mesh = taut.read(tmp_path / "out.obj")
    assert np.allclose(mesh.corner_uv, uvs[indices], atol=1e-6) and np.allclose(mesh.V, V[vmapping], atol=1e-6)


def pages_of(atlas):
    """Density, and triangles by page, in texels; all charts must lie within their pages."""
    flat, rest, by_page = 0.0, 0.0, {}
    for k, mesh in enumerate(atlas._inputs):
        vmapping, indices, uvs = atlas[k]
        page = atlas.get_mesh_vertex_assignment(k)[0]
        assert uvs.min() >= 0 and uvs.max() <= 1 and (page[indices] == page[indices[:, :1]]).all()
        assert taut.certify(indices, uvs)
        corners = uvs[indices].astype(float) * [atlas.width, atlas.height]
        flat += mine._areas(corners.reshape(-1, 2), np.arange(3 * len(indices)).reshape(-1, 3)).sum()
        rest += mine._areas(mesh.points, mesh.faces).sum()
        for triangle, p in zip(corners, page[indices[:, 0]]):
            by_page.setdefault(int(p), []).append(triangle)
    return np.sqrt(flat / rest), by_page


@pytest.mark.parametrize("density, resolution, side", [(16.0, 256, 0), (20.0, 100, 0), (16.0, 256, 20)])
def test_a_density_is_kept_on_as_many_pages_as_it_takes(density, resolution, side):
    V, F = bowl_of(6)
    atlas = mine.Atlas()
    for k in range(5):  # copies of one another are no duplicates
        atlas.add_mesh(V * 4 + [0, 0, k // 2], F)
    options = mine.PackOptions()
    options.texels_per_unit, options.resolution, options.max_chart_size = density, resolution, side
    options.create_image = True
    atlas.generate(pack_options=options)
    found, by_page = pages_of(atlas)
    assert atlas.width == atlas.height == resolution and sorted(by_page) == list(range(atlas.atlas_count))
    if side:
        assert found < density and atlas.atlas_count == 1
        for mesh, chart in ((k, c) for k in range(5) for c in range(atlas.get_mesh_chart_count(k))):
            _, indices, uvs = atlas[mesh]
            corners = uvs[indices[atlas.get_mesh_chart(mesh, chart).faces]].reshape(-1, 2) * resolution
            assert np.ptp(corners, axis=0).max() <= side + 0.01
    else:
        assert found == pytest.approx(density, rel=0.01) and found == pytest.approx(atlas.texels_per_unit) and atlas.atlas_count > 1
    for page in by_page:
        image = atlas.get_chart_image(page)
        assert image.any(2).mean() == pytest.approx(atlas.get_utilization(page), abs=0.05)
    with pytest.raises(IndexError):
        atlas.get_chart_image(atlas.atlas_count)
    assert {atlas.get_mesh_chart(k, 0).atlas_index for k in range(5)} <= set(by_page)


@pytest.mark.parametrize("mirror", [False, True])
def test_given_coordinates_are_packed_and_keep_their_shape(mirror):
    V, F = bowl_of(6)
    uv = np.c_[V[:, 0] * (2 + V[:, 0]), V[:, 1]][:, ::-1 if mirror else 1].astype(np.float32)
    charts = mine.ChartOptions()
    charts.use_input_mesh_uvs = True
    atlas = mine.Atlas()
    atlas.add_mesh(V, F, uvs=uv)
    atlas.add_mesh(V + [5, 0, 0], F)  # a mesh without gets its own
    atlas.generate(charts)
    vmapping, indices, uvs = atlas[0]
    assert atlas.chart_count == 2 and (vmapping[indices] == F).all()
    given, made = uv[vmapping].astype(float) @ [1, 1j], uvs.astype(float) @ [1, 1j]
    ways = [np.linalg.lstsq(np.c_[z, np.ones(len(z))], made, rcond=None) for z in (given, given.conj())]
    assert min(np.abs(w[1]).max() for w in ways) < 1e-10
    assert pages_of(atlas)[0] == pytest.approx(atlas.texels_per_unit)


def test_options_without_effect_are_told(bowl):
    atlas = mine.Atlas()
    atlas.add_mesh(*bowl)
    with pytest.warns(UserWarning, match="max_boundary_length, bruteForce: no effect"):
        atlas.generate(mine.ChartOptions(max_boundary_length=3), mine.PackOptions(bruteForce=True))
    with pytest.raises(RuntimeError, match="cannot be added to the same atlas"):
        atlas.add_uv_mesh(bowl[0][:, :2], bowl[1])


def test_numbers_that_are_no_indices_and_what_files_cannot_hold_are_refused(tmp_path):
    V, F = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]])
    masked = np.ma.masked_equal(V, 1)
    for points, faces in ((V, F + 0.5), (V, F > 0), (V, [[0, 1, np.nan]]), (masked, F), (V + 1j, F)):
        with pytest.raises(ValueError, match="array has"):
            mine.parametrize(points, faces)
    for points, faces, uvs in ((V * np.nan, F, None), (V * 1e300, F, None), (V, F, V[:, :2] * np.inf), (V, F + 1, None),
                               (V, F - 1, None), (V, F + 0.5, None)):
        with pytest.raises(ValueError):
            mine.export(tmp_path / "a.obj", points, faces, uvs)
    assert not list(tmp_path.iterdir())
