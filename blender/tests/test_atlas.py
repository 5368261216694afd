# SPDX-License-Identifier: MIT
"""Atlases of one and of several objects."""

import bpy
import judge
import numpy as np
import pytest
from scenes import choose, flat, hill, made, pin, pin_corners, primitive, tube, tube_seams, uv_of
from taut_uv import running, scene
from taut_uv.core.atlas import atlas
from taut_uv.core.unwrap import unwrap


def three():
    """A torus, a monkey and a tube of different sizes."""
    ring = primitive("torus", "Ring", major_segments=24, minor_segments=12)
    monkey = primitive("monkey", "Suzanne")
    monkey.scale = (2, 2, 2)
    pipe = tube(name="Pipe")
    bpy.context.view_layer.update()
    choose(ring, monkey, pipe)
    return ring, monkey, pipe


def test_several_objects_share_a_square_at_one_density_and_seams_are_marked():
    obs = three()
    assert bpy.ops.taut.atlas(padding=4.0, resolution=512) == {"FINISHED"}
    reads = [judge.Read(ob) for ob in obs]
    for r in reads:
        assert judge.flips(r) == 0 and judge.mirrored(r) == 0
        assert r.uv.min() > 0 and r.uv.max() < 1
        assert judge.torn(r) == r.seams and r.seams
    assert not judge.overlaps(*reads)
    means = [np.sqrt(np.median(judge.densities(r) ** 2)) for r in reads]
    assert max(means) / min(means) < 1.1


def test_udim_tiles_are_all_used_and_no_chart_leaves_its_tile():
    obs = primitive("torus", "Ring", major_segments=24, minor_segments=12), tube(name="Pipe")
    choose(*obs)
    bpy.ops.taut.atlas(tiles=2, prefer="packing")
    tiles = set()
    for r in map(judge.Read, obs):
        part = judge.islands(r)
        for k in set(part):
            uv = r.uv[np.concatenate([r.polygons[p] for p in np.flatnonzero(part == k)])]
            assert (np.floor(uv.min(0)) == np.floor(uv.max(0))).all()
            tiles.add(tuple(np.floor(uv.mean(0)).astype(int)))
        assert judge.flips(r) == 0
    assert tiles == {(0, 0), (1, 0)} and not judge.overlaps(*map(judge.Read, obs))


@pytest.mark.parametrize("density", [10.0, 45.0])
def test_texel_density_is_met_with_as_many_tiles_as_it_takes(density):
    """For the last one the tube has to be divided: no tile has room for it."""
    ring, pipe = primitive("torus", "Ring", major_segments=16, minor_segments=8), tube(name="Pipe")
    choose(ring, pipe)
    bpy.ops.taut.atlas(density=density, resolution=128)
    reads = [judge.Read(ring), judge.Read(pipe)]
    area = flat_area = 0
    for r in reads:
        F = r.vertex[r.triangles]
        area += np.linalg.norm(np.cross(r.V[F[:, 1]] - r.V[F[:, 0]], r.V[F[:, 2]] - r.V[F[:, 0]]), axis=1).sum() / 2
        flat_area += np.abs(judge._areas(r.tri())).sum()
        assert judge.flips(r) == 0 and judge.torn(r) == r.seams
    assert np.isclose(np.sqrt(flat_area / area) * 128, density, rtol=1e-3)
    assert not judge.overlaps(*reads)
    tiles = {tuple(t) for r in reads for t in np.floor(r.uv).astype(int)}
    assert (len(tiles) > 1) == (density > 20) and len(tiles) < 30
    corners = []
    for r in reads:
        part = judge.islands(r)
        for k in set(part):
            corners.append(r.uv[np.concatenate([r.polygons[p] for p in np.flatnonzero(part == k)])])
            assert (np.floor(corners[-1].min(0)) == np.floor(corners[-1].max(0))).all()
    for i, a in enumerate(corners):
        for b in corners[:i]:
            assert np.linalg.norm(a[:, None] - b[None], axis=2).min() > 2 / 128 - 1e-5


def test_symmetric_charts_are_mirror_images():
    ob = primitive("uv_sphere", "Ball", segments=16, ring_count=10)
    assert bpy.ops.taut.atlas(symmetric=True) == {"FINISHED"}
    r = judge.Read(ob)
    assert judge.flips(r) == 0 and not judge.overlaps(r)
    part = judge.islands(r)
    shapes = []
    for k in set(part):
        uv = r.uv[np.concatenate([r.polygons[p] for p in np.flatnonzero(part == k)])]
        shapes.append(np.sort(np.linalg.norm(uv - uv.mean(0), axis=1)))
    assert len(shapes) % 2 == 0
    left = list(range(len(shapes)))
    while left:  # each has a partner whose distances are the same
        a = left.pop()
        b = next(
            (b for b in left if len(shapes[a]) == len(shapes[b]) and np.allclose(shapes[a], shapes[b], atol=1e-4)), None
        )
        assert b is not None
        left.remove(b)


def test_a_mesh_without_symmetry_is_an_error_that_names_vertices():
    ob = hill(8)
    ob.data.vertices[12].co.z += 0.3
    with pytest.raises(RuntimeError, match="Hill: vert.*no mirror image; correct the mesh"):
        bpy.ops.taut.atlas(symmetric=True)


def test_charts_between_seams_are_kept():
    ob = tube()
    tube_seams(ob)
    before = {tuple(sorted(e.vertices)) for e in ob.data.edges if e.use_seam}
    bpy.ops.taut.atlas(charts="keep")
    r = judge.Read(ob)
    assert r.seams == before == judge.torn(r) and judge.flips(r) == 0 and not judge.overlaps(r)


def test_seams_that_are_marked_are_seams_of_the_atlas():
    ob = tube()
    tube_seams(ob)
    before = {tuple(sorted(e.vertices)) for e in ob.data.edges if e.use_seam}
    bpy.ops.taut.atlas(keep_seams=True)
    assert before <= judge.torn(judge.Read(ob))
    bpy.ops.taut.atlas(mark_seams=False)
    assert {tuple(sorted(e.vertices)) for e in ob.data.edges if e.use_seam} >= before


def test_pinned_islands_stay_and_others_keep_off_them():
    sheet, ring = hill(8), primitive("torus", "Ring", major_segments=16, minor_segments=8)
    before = flat(sheet, 0.2, 0.3).copy()
    pin(sheet, [0])
    choose(sheet, ring)
    assert bpy.ops.taut.atlas() == {"FINISHED"}
    assert (uv_of(sheet) == before).all()
    reads = judge.Read(sheet), judge.Read(ring)
    assert not judge.overlaps(*reads) and judge.flips(reads[1]) == 0 and judge.densities(reads[1]).min() > 0


def test_a_pinned_island_outside_of_the_tiles_is_named():
    sheet, ring = hill(8), primitive("torus", "Ring", major_segments=16, minor_segments=8)
    flat(sheet, 0.2, 5.0)
    pin_corners(sheet, [0])
    choose(sheet, ring)
    with pytest.raises(RuntimeError, match="Hill: face .*leaves the square; clear its pins"):
        bpy.ops.taut.atlas()


def test_painted_charts_get_more_texels():
    ob = primitive("torus", "Ring", major_segments=24, minor_segments=12)
    group = ob.vertex_groups.new(name="Front")
    front = [v.index for v in ob.data.vertices if v.co.y < 0]
    group.add(front, 1.0, "REPLACE")
    group.add([v.index for v in ob.data.vertices if v.co.y >= 0], 0.25, "REPLACE")
    bpy.ops.taut.atlas(prefer="packing", weights="Front")
    r = judge.Read(ob)
    part = judge.islands(r)
    density = judge.densities(r)
    painted = np.array(
        [
            np.isin(r.vertex[np.concatenate([r.polygons[p] for p in np.flatnonzero(part == k)])], front).mean()
            for k in np.unique(part)
        ]
    )
    assert judge.flips(r) == 0 and not judge.overlaps(r)
    assert density[painted.argmax()] > 1.5 * density[painted.argmin()]


def test_raw_triangles_are_mended_and_what_is_left_out_is_named():
    V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0], [0.5, 0, 0], [2, 0, 0.3]], float)
    ob = made("Scrap", V, [(0, 1, 2), (0, 2, 3), (1, 5, 2), (0, 4, 1)])  # the last is flat
    assert bpy.ops.taut.atlas() == {"FINISHED"}
    r = judge.Read(ob)
    s = judge.signs(r.tri())
    assert (s[:3] > 0).all()


def test_polygons_are_never_divided():
    ob = tube(sides=7)
    bpy.ops.taut.atlas(prefer="packing")
    r = judge.Read(ob)
    for loops in r.polygons:  # the area of a polygon is that of its triangles
        p = r.uv[loops]
        q = np.roll(p, -1, 0)
        own = np.isin(r.triangles, loops).all(1)
        assert np.isclose(
            (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum() / 2, judge._areas(r.tri()[own]).sum(), atol=1e-7
        )
    assert judge.flips(r) == 0


def test_a_face_that_repair_divides_is_named_and_lies_over_no_other():
    """Two quads that have three corners in common: cut alike they have a triangle in common."""
    V = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.2, 1.5, 1.0), (2, 0, 0), (2, 1, 0)]
    ob = made("Fold", V, [(0, 1, 2, 3), (0, 1, 2, 4), (1, 5, 6, 2)])
    bpy.ops.taut.atlas()
    assert not judge.overlaps(judge.Read(ob))


def test_copies_at_one_place_are_objects_of_their_own():
    one, other = hill(6, 0.4, name="One"), hill(6, 0.4, name="Other")
    choose(one, other)
    bpy.ops.taut.atlas()
    reads = judge.Read(one), judge.Read(other)
    assert all((judge.signs(r.tri()) > 0).all() for r in reads) and not judge.overlaps(*reads)


def test_options_without_effect_are_told():
    ob = hill(6, 0.4)
    reader = scene.Reader(scene.objects(bpy.context), new_map=True)
    notes = atlas(running.module(), reader.surface, charts="keep", prefer="one", max_distortion=5).notes
    assert {f"{name} has no effect on charts that are kept" for name in ("Prefer", "Max Distortion")} <= {*notes}
    notes = unwrap(running.module(), reader.surface, pack=False, rotate=False).notes
    assert "Rotate has no effect without Pack" in notes
    for command, given, words in [("atlas", {"max_distortion": 3}, "Max Distortion is 3, but must be above 4"),
                                  ("check", {"flips": False, "overlaps": False}, "nothing to look for")]:
        with pytest.raises(RuntimeError, match=words):
            getattr(bpy.ops.taut, command)(**given)
    assert ob.data.uv_layers.active is not None
