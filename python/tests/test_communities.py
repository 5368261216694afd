# SPDX-License-Identifier: MIT
"""Grids with holes, cortical patches, patterns for cutting."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import bowl_of, torus_of

import taut


def test_a_grid_with_holes_is_flattened_and_keeps_them(tmp_path):
    from taut import grids

    rows, columns = 30, 40
    r, c = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    angle = c / 12
    grid = np.stack([12 * np.cos(angle), 12 * np.sin(angle), r.astype(float)], -1)  # a part of a roll
    grid[10:14, 15:20] = np.nan
    grid[0, 0] = grid[25, 39] = np.nan
    flat = grids.flatten(grid)
    there = np.isfinite(flat).all(-1)
    assert not there[10:14, 15:20].any() and there.sum() > 0.95 * np.isfinite(grid).all(-1).sum()
    both = there[:, 1:] & there[:, :-1]
    along = np.linalg.norm(np.diff(flat, axis=1), axis=-1)[both]
    assert np.allclose(along, np.linalg.norm(np.diff(grid, axis=1), axis=-1)[both], rtol=1e-3)
    with pytest.raises(taut.ParameterError):
        grids.flatten(np.full((5, 5, 3), np.nan))
    pytest.importorskip("tifffile")
    grids.write(tmp_path / "roll", grid)
    assert np.allclose(grids.read(tmp_path / "roll"), grid, atol=1e-5, equal_nan=True)
    with pytest.raises(taut.FileError, match="x.tif"):
        grids.read(tmp_path / "nowhere")


def test_parts_of_grids_that_touch_in_a_point_are_left_out():
    from taut import grids

    grid = np.stack([*np.meshgrid(np.arange(9.0), np.arange(9.0), indexing="ij"), np.zeros((9, 9))], -1)
    grid[4, :4] = grid[:4, 4] = np.nan
    assert np.isfinite(grids.flatten(grid)).any()


def test_a_cortical_patch_is_cut_out_and_flattened(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    from taut import cortex

    V, F = torus_of(40, 20)
    nibabel.freesurfer.write_geometry(str(tmp_path / "lh.white"), V, F)
    read_V, read_F = cortex.read_surface(tmp_path / "lh.white")
    assert np.allclose(read_V, V, atol=1e-5) and (read_F == F).all()
    image = nibabel.gifti.GiftiImage(darrays=[
        nibabel.gifti.GiftiDataArray(V.astype(np.float32), intent="NIFTI_INTENT_POINTSET"),
        nibabel.gifti.GiftiDataArray(F.astype(np.int32), intent="NIFTI_INTENT_TRIANGLE")])
    nibabel.save(image, str(tmp_path / "lh.surf.gii"))
    assert np.allclose(cortex.read_surface(tmp_path / "lh.surf.gii")[0], V, atol=1e-5)

    half = np.flatnonzero(V[:, 0] > 0.5)
    cortex.write_patch(tmp_path / "cut.patch.3d", half, V[half])
    patch, places, border = cortex.read_patch(tmp_path / "cut.patch.3d")
    assert (patch == half).all() and np.allclose(places, V[half], atol=1e-5) and not border.any()
    part = np.flatnonzero((V[:, 0] > 0.5) & (V[:, 2] > -0.2))
    vertices, uv = cortex.flatten(V, F, part)
    assert set(vertices) <= set(part) and len(vertices) > 0.9 * len(part)
    cortex.write_patch(tmp_path / "flat.patch", vertices, uv)
    assert np.allclose(cortex.read_patch(tmp_path / "flat.patch")[1][:, :2], uv, atol=1e-4)
    with pytest.raises(taut.FileError):
        cortex.read_patch(tmp_path / "lh.white")


def test_pieces_of_a_pattern_have_seams_of_one_length(tmp_path):
    from taut import patterns

    V, F = bowl_of(12)
    V = 100 * V  # mm
    line = np.flatnonzero(V[:, 0] == 0)
    seams = np.c_[line[:-1], line[1:]]
    made = patterns.pieces(V, F, seams)
    assert len(made) == 2 and sorted(len(p.faces) for p in made) == [len(F) // 2] * 2
    lengths = [p.seam_lengths() for p in made]
    assert lengths[0].keys() == lengths[1].keys() == {1}
    on_surface = np.linalg.norm(np.diff(V[line], axis=0), axis=1).sum()
    for piece in lengths:
        assert piece[1] == pytest.approx(on_surface, rel=0.1)
    ezdxf = pytest.importorskip("ezdxf")
    patterns.write_dxf(tmp_path / "pattern.dxf", made)
    drawing = ezdxf.readfile(tmp_path / "pattern.dxf")
    layers = [e.dxf.layer for e in drawing.modelspace()]
    assert drawing.units == 4 and layers.count("OUTLINE") == 2 and layers.count("NOTCH") == layers.count("SEAM") == 2


def test_the_grain_line_is_seen_by_an_energy():
    from taut import energies, patterns

    @taut.energy
    def along(s):
        warp = s.S @ s.direction
        return energies.isometric(s) + 20 * (warp @ warp - 1) ** 2

    V, F = bowl_of(8)
    grain = np.tile([1.0, 0, 0], (len(F), 1))
    line = np.flatnonzero(V[:, 0] == 0)
    made = patterns.pieces(V, F, np.c_[line[:-1], line[1:]], grain=grain, energy=along)
    assert len(made) == 2
