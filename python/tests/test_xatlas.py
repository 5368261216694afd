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
