# SPDX-License-Identifier: MIT
"""Grids with holes, cortical patches, patterns for cutting."""

from __future__ import annotations

import json
import warnings

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
    for wrong in (None, made[0], [made], "pieces"):
        with pytest.raises(taut.ParameterError, match="made: .*patterns.pieces"):
            patterns.write_dxf(tmp_path / "none.dxf", wrong)
    with pytest.raises(taut.ParameterError, match="path: is None"):
        patterns.write_dxf(None, made)
    ezdxf = pytest.importorskip("ezdxf")
    patterns.write_dxf(tmp_path / "pattern.dxf", made, gap="20")
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


def whole_numbers(n, m):
    """A grid of points from -2 on, in which -1 is a number like others."""
    r, c = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    return np.stack([c - 2.0, r - 2.0, 0.0 * r - 1], -1)


def test_all_points_of_a_grid_come_back(tmp_path):
    pytest.importorskip("tifffile")
    from taut import grids

    grid = whole_numbers(6, 5)
    grid[1, 1, 2] = 7  # it would be (-1, -1, -1)
    grid[5, 4] = np.nan
    grids.write(tmp_path / "g", grid)
    assert np.array_equal(grids.read(tmp_path / "g"), grid, equal_nan=True)
    with pytest.raises(taut.ParameterError, match="row 1, column 1 has -1 in all numbers"):
        grids.write(tmp_path / "g", whole_numbers(6, 5))
    with pytest.raises(taut.FileError, match="z.tif.*another grid"):
        grids.write(tmp_path / "g", grid[..., :2] * 2)
    assert np.array_equal(grids.read(tmp_path / "g"), grid, equal_nan=True)
    grids.write(tmp_path / "flat", grid[..., :2] * 2)
    assert np.array_equal(grids.read(tmp_path / "flat"), grid[..., :2] * 2, equal_nan=True)
    grids.write(tmp_path / "h", grid[:4])
    (tmp_path / "h" / "z.tif").rename(tmp_path / "g" / "z.tif")
    with pytest.raises(taut.FileError, match="z.tif.*another grid"):
        grids.read(tmp_path / "g")
    with pytest.raises(taut.ParameterError, match="shape"):
        grids.write(tmp_path / "g", grid[..., 0])


def test_the_scale_of_a_grid_is_compared_and_written(tmp_path):
    pytest.importorskip("tifffile")
    from taut import grids

    grid = whole_numbers(6, 5) * [20, 25, 1]
    folder = tmp_path / "g"
    grids.write(folder, grid)
    meta = json.loads((folder / "meta.json").read_text())
    assert meta["scale"] == [0.05, 0.04] and meta["format"] == "tifxyz" and meta["bbox"] == [[-40, -50, -1], [40, 75, -1]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        grids.read(folder)
    (folder / "meta.json").write_text(json.dumps({**meta, "scale": [0.05, 0.5], "uuid": "mine"}))
    with pytest.warns(UserWarning, match=r"meta.json: `scale` says 2 from point to point along a column, but it is 25"):
        grids.read(folder)
    grids.write(tmp_path / "two", grid, like=folder)
    meta = json.loads((tmp_path / "two" / "meta.json").read_text())
    assert meta["scale"] == [0.05, 0.04] and meta["uuid"] == "mine"
    for wrong, words in ((b"{", "cannot be read"), (b"[]", "no object"), (b'{"scale": [1]}', "two positive numbers")):
        (folder / "meta.json").write_bytes(wrong)
        with pytest.raises(taut.FileError, match=words):
            grids.read(folder)


def needle_rows(n=6):
    """A plate with two rows that are far thinner than float32 has digits."""
    y = np.array([0, 1, 2, 2 + 2e-9, 3, 3 + 5e-9, 4])
    return np.stack([*np.meshgrid(y, np.arange(n + 0.0), indexing="ij")][::-1] + [np.zeros((len(y), n))], -1)


def test_flat_grids_and_patches_are_certified_as_the_singles_that_files_have(tmp_path):
    from taut import cortex, grids

    grid = needle_rows()
    V, F, number = grids.triangles(grid)
    assert not taut.certify(F, taut.unwrap(V, F).uv.astype(np.float32)), "is an example"
    flat = grids.flatten(grid)
    assert (flat == flat.astype(np.float32)).all() and taut.certify(F, flat[number >= 0])
    vertices, uv = cortex.flatten(V, F, np.arange(len(V)))
    cortex.write_patch(tmp_path / "flat", vertices, uv)
    read = cortex.read_patch(tmp_path / "flat")
    assert (read[1][:, :2] == uv).all() and taut.certify(F, read[1][np.argsort(read[0]), :2])
    pytest.importorskip("tifffile")
    grids.write(tmp_path / "g", flat)
    assert (grids.read(tmp_path / "g") == flat).all()
    with pytest.raises(taut.ParameterError, match="float32 turns over 20 triangles, as that at row 2, column 0"):
        grids.write(tmp_path / "h", grid[..., :2])
    grids.write(tmp_path / "h", grid[..., 1::-1][::2])  # mirrored, and none thin


def test_broken_patches_are_refused(tmp_path):
    from taut import cortex

    V, F = bowl_of(4)
    head = lambda mark, count: np.array([mark, count], dtype=">i4").tobytes()
    row = np.array([1, 0, 0, 0], dtype=">i4").tobytes()
    for k, data in enumerate([b"", b"\xff" * 7, head(-1, -1) + row, head(-1, -5) + 9 * row, head(-1, 2**28) + row,
                              head(-2, 1) + row, head(-1, 2) + row, head(-1, 1) + head(0, 0) + head(0, 0)]):
        (tmp_path / str(k)).write_bytes(data)
        with pytest.raises(taut.FileError) as e:
            cortex.read_patch(tmp_path / str(k))
        assert e.value.path == str(tmp_path / str(k))
    with pytest.raises(taut.FileError, match="No such file"):
        cortex.read_patch(tmp_path / "nowhere")
    for wrong in ([len(V)], [-1], [0.5]):
        with pytest.raises(taut.ParameterError, match="patch: row 0"):
            cortex.flatten(V, F, wrong)


def helicoid(turns, n=80):
    angle = 2 * np.pi * turns * np.arange(n + 1) / n
    V = np.concatenate([np.stack([r * np.cos(angle), r * np.sin(angle), 10 * angle], 1) for r in (20, 60)])
    a = np.arange(n)
    return V, np.concatenate([np.c_[a, a + n + 1, a + n + 2], np.c_[a, a + n + 2, a + 1]])


def overlaps(piece):
    """Whether triangles of a piece meet beyond their common points, exact by taut.pack's counterpart: edges that cross."""
    outline = piece.outline
    a, b = outline, np.roll(outline, -1, 0)
    side = lambda p, q, r: np.sign((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))
    n = len(outline)
    return any(side(a[i], b[i], a[j]) != side(a[i], b[i], b[j]) and side(a[j], b[j], a[i]) != side(a[j], b[j], b[i])
               for i in range(n) for j in range(i + 2, n) if (j + 1) % n != i)


@pytest.mark.parametrize("turns", [1.5, 2.2])
def test_pieces_do_not_overlap_themselves(turns):
    from taut import patterns

    V, F = helicoid(turns)
    assert overlaps(patterns.Piece(*(lambda uv, rim: (uv[rim], [], F, uv[F]))(
        taut.unwrap(V, F).uv, np.r_[: len(V) // 2, len(V) - 1 : len(V) // 2 - 1 : -1]))), "is an example"
    for piece in patterns.pieces(V, F, [[0, len(V) // 2]]):
        assert not overlaps(piece)


def tube_of(rows, m):
    angle = 2 * np.pi * np.arange(m) / m
    V = np.concatenate([np.stack([30 * np.cos(angle), 30 * np.sin(angle), 0 * angle + 20 * k], 1) for k in range(rows + 1)])
    i = np.arange(rows * m)
    a, b = i, i // m * m + (i + 1) % m
    return V, np.concatenate([np.c_[a, b, b + m], np.c_[a, b + m, a + m]])


def test_each_seam_has_a_number_of_its_own(tmp_path):
    from taut import patterns

    V, F = tube_of(4, 32)
    line = lambda i: [(32 * k + i, 32 * (k + 1) + i) for k in range(4)]
    ring = [(64 + i, 64 + (i + 1) % 32) for i in range(32)]
    for lines, seams, twice in [([line(0), line(10)], 2, 0), ([line(3)], 1, 1), ([line(0), line(10), line(21)], 3, 0),
                                ([ring], 1, 0), ([ring, line(5)], 3, 2)]:
        made = patterns.pieces(V, F, [edge for edges in lines for edge in edges])
        sides = {}
        for piece in made:
            for number, points in piece.seams:
                x = piece.points[points]
                sides.setdefault(number, []).append(float(np.linalg.norm(np.diff(x, axis=0), axis=1).sum()))
        assert sorted(sides) == list(range(1, seams + 1)) and all(len(lengths) == 2 for lengths in sides.values())
        if ring not in lines:  # a tube that is not cut along becomes a ring, whose rims are of other lengths
            assert all(a == pytest.approx(b, rel=0.2) and a == pytest.approx(80, rel=0.1) for a, b in sides.values())
        assert sum(len(p.seams) - len(p.seam_lengths()) for p in made) == twice
    pytest.importorskip("ezdxf")
    patterns.write_dxf(tmp_path / "p.dxf", made)


def test_what_is_said_of_triangles_goes_with_them_and_pins_are_refused():
    from taut import patterns

    V, F = tube_of(4, 12)
    seams = [(12 * k + i, 12 * (k + 1) + i) for k in range(4) for i in (0, 6)]
    plain, heavy = (patterns.pieces(V, F, seams, weights=w) for w in (None, 1 + np.arange(len(F))))
    assert len(heavy) == 2 and all(len(p.faces) == len(q.faces) for p, q in zip(plain, heavy))
    with pytest.raises(taut.ParameterError, match="b: says where vertices"):
        patterns.pieces(V, F, seams, b=[0], bc=[[0, 0]])
    with pytest.raises(taut.ParameterError, match="gap"):
        patterns.write_dxf("nowhere.dxf", plain, gap=-1)


def test_options_that_would_part_vertices_or_change_lengths_are_refused(bowl):
    from taut import cortex, grids, patterns

    V, F = bowl
    rows = np.stack(np.meshgrid(np.arange(6.0), np.arange(7.0), [0.0]), -1)[:, :, 0]
    calls = {
        "pieces": lambda **options: patterns.pieces(V, F, [[0, 1]], **options),
        "grids": lambda **options: grids.flatten(rows, **options),
        "patches": lambda **options: cortex.flatten(V, F, np.arange(len(V)), **options),
    }
    for of, flat in calls.items():
        wrong = {"cut": True, "placement": "unit_square", **({"no_overlap": False} if of == "pieces" else {"single": False})}
        for name, value in wrong.items():
            with pytest.raises(taut.ParameterError, match=f"{name}: must.*{of}") as told:
                flat(**{name: value})
            assert told.value.field == name
        flat(cut=False, placement="as_solved", energy="shape")


def test_masked_points_of_a_grid_are_none_and_no_numbers_are_refused(tmp_path):
    from taut import grids

    rows = np.stack(np.meshgrid(np.arange(6.0), np.arange(7.0), [0.0]), -1)[:, :, 0]
    rows[2, 3] = -9999
    masked = np.ma.masked_equal(rows, -9999)
    assert np.isnan(grids.flatten(masked)[2, 3]).all() and np.isfinite(grids.flatten(masked)).sum() == 2 * (7 * 6 - 1)
    for wrong in (rows + 1j, "grid", None, [[[1, 2, 3]], [[1, 2]]]):
        with pytest.raises(taut.ParameterError, match="grid"):
            grids.flatten(wrong)
    pytest.importorskip("tifffile")
    grids.write(tmp_path / "masked", masked)
    assert np.isnan(grids.read(tmp_path / "masked")[2, 3]).all()
    (tmp_path / "file").write_text("")
    for folder, like in ((tmp_path / "file", None), (tmp_path / "new", tmp_path / "nowhere")):
        with pytest.raises(taut.FileError, match="folder"):
            grids.write(folder, rows, like=like)
    assert not (tmp_path / "new").exists()
