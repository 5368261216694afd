# SPDX-License-Identifier: MIT
"""Unwrap, as artists call it."""

import bpy
import judge
import numpy as np
import pytest
from scenes import (
    choose,
    corners_of,
    flat,
    hill,
    made,
    mode,
    pin,
    pin_corners,
    primitive,
    select,
    tube,
    tube_seams,
    uv_of,
)

PINNED = {0: (0.1, 0.1), 16: (0.87, 0.13), 288: (0.9, 0.95), 272: (0.2, 0.8), 150: (0.55, 0.5)}


@pytest.mark.parametrize("edited", [False, True])
def test_pins_hold_bit_for_bit_and_nothing_folds(edited):
    ob = hill()
    places = np.array(list(PINNED.values()), np.float32)
    pin(ob, PINNED, places)
    if edited:
        select(ob, faces=range(len(ob.data.polygons)))
    assert bpy.ops.taut.unwrap() == {"FINISHED"}
    if edited:
        mode("OBJECT")
    uv = uv_of(ob)
    for place, v in zip(places, PINNED):
        assert (uv[corners_of(ob, [v])] == place).all()
    r = judge.Read(ob)
    assert judge.flips(r) == 0 and judge.mirrored(r) == 0 and len(set(judge.islands(r))) == 1


def test_pins_in_mirror_image_make_a_mirrored_island():
    ob = hill()
    places = np.array(list(PINNED.values()), np.float32) * np.float32([-1, 1])
    pin(ob, PINNED, places)
    bpy.ops.taut.unwrap(pack=False)
    r = judge.Read(ob)
    assert judge.flips(r) == 0 and judge.mirrored(r) == 1
    for place, v in zip(places, PINNED):
        assert (uv_of(ob)[corners_of(ob, [v])] == place).all()


def test_one_pin_sets_the_place_and_two_the_size():
    ob = hill()
    flat(ob)
    pin(ob, [144], [(0.25, 0.75)])
    bpy.ops.taut.unwrap()
    assert (uv_of(ob)[corners_of(ob, [144])] == np.float32([0.25, 0.75])).all() and judge.flips(judge.Read(ob)) == 0
    pin(ob, [0], [(0.2, 0.7)])
    bpy.ops.taut.unwrap()
    r = judge.Read(ob)
    assert judge.flips(r) == 0 and np.ptp(r.uv, axis=0).max() < 0.2 and judge.energy(r) < 4.3


def test_islands_between_seams_with_ngons_are_packed_without_overlaps():
    ob = tube()
    tube_seams(ob)
    assert bpy.ops.taut.unwrap(padding=8.0, resolution=512) == {"FINISHED"}
    r = judge.Read(ob)
    part = judge.islands(r)
    assert len(set(part)) == 3 and judge.torn(r) <= r.seams
    assert judge.flips(r) == 0 and not judge.overlaps(r)
    assert r.uv.min() >= 8 / 512 - 1e-6 and r.uv.max() <= 1 - 8 / 512 + 1e-6
    assert judge.energy(r) < 4.0001  # a tube and its caps can be laid flat
    boxes = [r.uv[np.concatenate([r.polygons[p] for p in np.flatnonzero(part == k)])] for k in set(part)]
    for i, a in enumerate(boxes):
        for b in boxes[:i]:
            assert np.linalg.norm(a[:, None] - b[None], axis=2).min() >= 8 / 512 - 1e-6


def test_islands_without_pins_keep_off_those_with_pins():
    ob = tube()
    tube_seams(ob)
    bpy.ops.taut.unwrap()
    cap = np.array(list(ob.data.polygons[96].loop_indices))
    angle = 2 * np.pi * np.arange(len(cap)) / len(cap)
    uv = uv_of(ob).copy()
    uv[cap] = np.c_[0.3 + 0.2 * np.cos(angle), 0.3 - 0.2 * np.sin(angle)]
    uv_of(ob, uv)
    pin_corners(ob, cap)
    before = uv_of(ob)[cap].copy()
    assert bpy.ops.taut.unwrap() == {"FINISHED"}
    r = judge.Read(ob)
    assert (uv_of(ob)[cap] == before).all()
    assert judge.flips(r) == 0 and not judge.overlaps(r) and r.uv.min() >= 0 and r.uv.max() <= 1


def test_a_closed_mesh_is_reported_with_a_remedy_and_nothing_changes():
    ob = primitive("uv_sphere", "Ball", segments=16, ring_count=8)
    before = uv_of(ob).copy()
    with pytest.raises(RuntimeError, match=r"Ball: faces 0, 1.*closed island.*mark seams, use Atlas"):
        bpy.ops.taut.unwrap()
    assert (uv_of(ob) == before).all()


def test_cut_where_needed_marks_the_cuts_as_seams():
    ob = primitive("torus", "Ring", major_segments=24, minor_segments=12)
    assert bpy.ops.taut.unwrap(cut=True) == {"FINISHED"}
    r = judge.Read(ob)
    assert r.seams and judge.torn(r) == r.seams and judge.flips(r) == 0 and not judge.overlaps(r)


def test_what_cannot_be_laid_flat_does_not_keep_others_from_it():
    ball, sheet = primitive("ico_sphere", "Ball", subdivisions=2), hill(8)
    choose(sheet, ball)
    before = uv_of(ball).copy()
    assert bpy.ops.taut.unwrap() == {"FINISHED"}
    assert judge.flips(judge.Read(sheet)) == 0 and np.ptp(uv_of(sheet)) > 0.5 and (uv_of(ball) == before).all()


def test_pins_that_admit_no_map_are_an_error_that_names_and_selects_the_face():
    ob = hill(8)
    v = list(ob.data.polygons[20].vertices)
    pin(ob, v[:3], [(0.5, 0.5), (0.5, 0.6), (0.6, 0.5)])  # clockwise
    pin(ob, [0, 8, 72, 80], [(0, 0), (1, 0), (0, 1), (1, 1)])
    before = uv_of(ob).copy()
    select(ob, faces=range(64))
    with pytest.raises(RuntimeError, match=r"Hill: faces? .*20.*no map without folds.*(move|clear)"):
        bpy.ops.taut.unwrap()
    mode("OBJECT")
    assert (uv_of(ob) == before).all() and judge.Read(ob).selected[20]


def test_a_face_without_area_is_named():
    ob = hill(8)
    ob.data.vertices[10].co = ob.data.vertices[11].co
    with pytest.raises(RuntimeError, match=r"Hill: faces? .*no area; Mesh > Clean Up"):
        bpy.ops.taut.unwrap()


@pytest.mark.parametrize("command", ["unwrap", "atlas"])
def test_quads_with_a_straight_corner_are_no_faces_without_area(command):
    V = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 2, 0), (0, -2, 0), (2, -2, 0), (2, 2, 1)]
    ob = made("Joint", V, [(0, 1, 2, 3), (4, 5, 2, 1, 0), (2, 6, 3)])
    assert getattr(bpy.ops.taut, command)() == {"FINISHED"}
    r = judge.Read(ob)
    for loops in r.polygons:
        p, q = r.uv[loops], np.roll(r.uv[loops], -1, 0)
        assert (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum() > 0
    assert len(set(judge.islands(r))) == 1 and not judge.overlaps(r)
    bpy.ops.taut.check()
    assert not judge.Read(ob).selected.any()


def test_pins_that_contradict_each_other_are_named():
    ob = hill(8)
    pin(ob, [40])
    corner = int(corners_of(ob, [40])[0])
    ob.data.uv_layers.active.uv[corner].vector = (0.7, 0.7)
    with pytest.raises(RuntimeError, match=r"Hill: vertex 40: pinned to two places"):
        bpy.ops.taut.unwrap()


def test_painted_faces_are_less_distorted():
    ob = hill(20, 1.2)
    group = ob.vertex_groups.new(name="Face")
    inside = [v.index for v in ob.data.vertices if (v.co.x - 0.3) ** 2 + (v.co.y - 0.2) ** 2 < 0.16]
    group.add(inside, 1.0, "REPLACE")
    some = lambda r: np.isin(r.vertex[r.triangles], inside).all(1)
    bpy.ops.taut.unwrap()
    plain = judge.Read(ob)
    bpy.ops.taut.unwrap(weights="Face")
    painted = judge.Read(ob)
    assert judge.flips(painted) == 0
    assert judge.energy(painted, some(painted)) < judge.energy(plain, some(plain)) - 0.03
    assert judge.energy(painted) > judge.energy(plain)
    with pytest.raises(RuntimeError, match='vertex group "Nose"'):
        bpy.ops.taut.unwrap(weights="Nose")


def test_only_selected_faces_change():
    ob = tube()
    tube_seams(ob)
    bpy.ops.taut.unwrap()
    uv = uv_of(ob) * np.float32(0.5)
    uv_of(ob, uv)
    select(ob, faces=[97])
    bpy.ops.taut.unwrap()
    mode("OBJECT")
    own = list(ob.data.polygons[97].loop_indices)
    same = (uv_of(ob) == uv).all(1)
    assert same[np.setdiff1d(np.arange(len(uv)), own)].all() and not same[own].any()


def test_lengths_are_those_of_the_scene():
    ob = hill(8, 0)
    ob.scale = (3, 1, 1)
    bpy.context.view_layer.update()
    bpy.ops.taut.unwrap(rotate=False)
    assert np.isclose(np.ptp(uv_of(ob), axis=0).max() / np.ptp(uv_of(ob), axis=0).min(), 3, rtol=1e-3)
