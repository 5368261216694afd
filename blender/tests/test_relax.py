# SPDX-License-Identifier: MIT
"""Relax and Straighten: a part moves, the rest stays bit for bit."""

import bmesh
import bpy
import judge
import numpy as np
import pytest
from scenes import corners_of, flat, hill, mode, pin, primitive, select, tube, tube_seams, uv_of
from taut_uv import scene


def inner_faces(ob, radius):
    return [p.index for p in ob.data.polygons if max(abs(p.center.x), abs(p.center.y)) < radius]


def held_vertices(ob, faces):
    """Vertices of faces that are not among these."""
    return {v for p in ob.data.polygons if p.index not in set(faces) for v in p.vertices}


@pytest.mark.parametrize("axis", ["both", "u", "v"])
def test_selected_faces_relax_and_all_others_stay_bit_for_bit(axis):
    ob = hill(16, 1.0)
    before = flat(ob).copy()
    energy = judge.energy(judge.Read(ob))
    faces = inner_faces(ob, 0.8)
    select(ob, faces=faces)
    assert bpy.ops.taut.relax(axis=axis) == {"FINISHED"}
    mode("OBJECT")
    uv, r = uv_of(ob), judge.Read(ob)
    held = corners_of(ob, held_vertices(ob, faces))
    assert (uv[held] == before[held]).all()
    free = np.setdiff1d(np.arange(len(uv)), held)
    assert ((uv != before)[free].any(0) == {"both": [1, 1], "u": [1, 0], "v": [0, 1]}[axis]).all()
    assert judge.flips(r) == 0 and judge.energy(r) < energy - 0.01


def test_pins_stay_and_the_border_if_asked():
    ob = hill(12, 1.0)
    before = flat(ob).copy()
    pin(ob, [40, 41])
    bpy.ops.taut.relax(hold_border=True)
    border = [v.index for v in ob.data.vertices if max(abs(v.co.x), abs(v.co.y)) > 0.999]
    held = corners_of(ob, [40, 41] + border)
    assert (uv_of(ob)[held] == before[held]).all() and (uv_of(ob) != before).any()
    assert judge.flips(judge.Read(ob)) == 0


def test_an_island_as_a_whole_keeps_its_place_and_size():
    ob = hill(12, 1.0)
    before = flat(ob, 0.1, 3.0).copy()
    bpy.ops.taut.relax()
    after, r = uv_of(ob), judge.Read(ob)
    assert np.abs(after.mean(0) - before.mean(0)).max() < 0.01 and judge.flips(r) == 0
    bpy.ops.taut.unwrap()
    assert judge.energy(r) < 1.001 * judge.energy(judge.Read(ob))
    assert 0.8 < np.ptp(after) / np.ptp(before) < 1.3


def test_flips_in_the_selection_are_undone_while_the_rest_stays():
    ob = hill(16, 0.3)
    flat(ob)
    uv = uv_of(ob).copy()
    own = corners_of(ob, [144])
    uv[own] += np.float32([0.13, 0.04])
    before = uv_of(ob, uv).copy()
    assert judge.flips(judge.Read(ob)) > 0
    faces = inner_faces(ob, 0.55)
    select(ob, faces=faces)
    bpy.ops.taut.relax()
    mode("OBJECT")
    held = corners_of(ob, held_vertices(ob, faces))
    assert judge.flips(judge.Read(ob)) == 0 and (uv_of(ob)[held] == before[held]).all()


def test_a_mirrored_island_stays_mirrored():
    ob = hill(12, 1.0)
    uv = flat(ob).copy()
    uv_of(ob, uv * np.float32([-1, 1]))
    select(ob, faces=inner_faces(ob, 0.7))
    bpy.ops.taut.relax(axis="v")
    mode("OBJECT")
    r = judge.Read(ob)
    assert judge.mirrored(r) == 1 and judge.flips(r) == 0 and (uv_of(ob)[:, 0] == -uv[:, 0]).all()


def test_nothing_that_could_move_is_an_error_with_a_remedy():
    ob = hill(8)
    flat(ob)
    select(ob, faces=[20])
    with pytest.raises(RuntimeError, match="all corners of the selected faces are held.*select more faces"):
        bpy.ops.taut.relax()
    mode("OBJECT")
    ob.data.uv_layers.remove(ob.data.uv_layers.active)
    with pytest.raises(RuntimeError, match="Hill: no UV map; Unwrap it"):
        bpy.ops.taut.relax()


def row(ob, y):
    """Edges along x in the middle part of a hill."""
    co = [v.co for v in ob.data.vertices]
    return [e.index for e in ob.data.edges if all(abs(co[v].y - y) < 1e-4 and abs(co[v].x) < 0.8 for v in e.vertices)]


@pytest.mark.parametrize("spacing", ["free", "length"])
def test_a_row_becomes_straight_and_its_island_follows(spacing):
    ob = hill(16, 1.0)
    bpy.ops.taut.unwrap(pack=False)
    angle = 0.3  # askew, so that no axis is met by chance
    uv_of(ob, uv_of(ob) @ np.float32([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]))
    edges = row(ob, 0.125)
    select(ob, edges=edges)
    assert bpy.ops.taut.straighten(spacing=spacing) == {"FINISHED"}
    mode("OBJECT")
    vertices = sorted({v for e in edges for v in ob.data.edges[e].vertices}, key=lambda v: ob.data.vertices[v].co.x)
    uv = uv_of(ob)[[corners_of(ob, [v])[0] for v in vertices]]
    assert len(set(uv[:, 1])) == 1 and (np.diff(uv[:, 0]) > 0).all()
    r = judge.Read(ob)
    assert judge.flips(r) == 0 and judge.energy(r) < 5
    if spacing == "length":
        length = np.linalg.norm(np.diff([ob.data.vertices[v].co for v in vertices], axis=0), axis=1)
        assert np.allclose(np.diff(uv[:, 0]) / np.diff(uv[:, 0]).sum(), length / length.sum(), atol=1e-5)


def test_a_line_upright_and_a_pin_that_says_where():
    ob = hill(12, 0.8)
    flat(ob)
    bpy.ops.taut.relax()
    co = [v.co for v in ob.data.vertices]
    edges = [e.index for e in ob.data.edges if all(abs(co[v].x) < 1e-4 for v in e.vertices)]
    pin(ob, [6 + 13 * 4], [(0.51, 0.37)])
    select(ob, edges=edges)
    bpy.ops.taut.straighten(axis="v")
    mode("OBJECT")
    line = corners_of(ob, {v for e in edges for v in ob.data.edges[e].vertices})
    assert (uv_of(ob)[line, 0] == np.float32(0.51)).all() and judge.flips(judge.Read(ob)) == 0
    assert (uv_of(ob)[corners_of(ob, [6 + 13 * 4])] == np.float32([0.51, 0.37])).all()


def test_a_loop_around_a_tube_is_straight_after_unwrapping_along_its_seam():
    ob = tube()
    tube_seams(ob)
    bpy.ops.taut.unwrap()
    co = [v.co for v in ob.data.vertices]
    edges = [e.index for e in ob.data.edges if all(abs(co[v].z - 2 * 3 / 6) < 1e-4 for v in e.vertices)]
    select(ob, edges=edges)
    bpy.ops.taut.straighten(axis="u")
    mode("OBJECT")
    line = corners_of(ob, {v for e in edges for v in ob.data.edges[e].vertices})
    assert len(set(uv_of(ob)[line, 1])) == 1 and judge.flips(judge.Read(ob)) == 0


def test_a_closed_loop_and_a_branch_are_errors_with_remedies():
    ob = hill(12)
    flat(ob)
    co = [v.co for v in ob.data.vertices]
    ring = [
        e.index for e in ob.data.edges if all(abs(max(abs(co[v].x), abs(co[v].y)) - 0.5) < 1e-4 for v in e.vertices)
    ]
    select(ob, edges=ring)
    with pytest.raises(RuntimeError, match="Hill: vertices .*closed loop.*deselect an edge, or mark a seam"):
        bpy.ops.taut.straighten()
    cross = [e.index for e in ob.data.edges if all(abs(co[v].x) < 1e-4 or abs(co[v].y) < 1e-4 for v in e.vertices)]
    select(ob, edges=cross)
    with pytest.raises(RuntimeError, match="Hill: vertex 84: selected edges branch here"):
        bpy.ops.taut.straighten()
    select(ob, edges=[])
    with pytest.raises(RuntimeError, match="no edge is selected"):
        bpy.ops.taut.straighten()


def test_other_islands_and_objects_stay():
    ob = primitive("cube", "Box")
    bpy.ops.taut.atlas(prefer="packing")
    before = uv_of(ob).copy()
    select(ob, faces=[0, 1])
    try:
        bpy.ops.taut.relax()
    except RuntimeError:
        pass
    mode("OBJECT")
    own = [c for f in (0, 1) for c in ob.data.polygons[f].loop_indices]
    rest = np.setdiff1d(np.arange(24), own)
    assert (uv_of(ob)[rest] == before[rest]).all()


def test_a_selection_of_the_uv_editor_is_taken_where_it_is_asked_for():
    ob = hill(4)
    flat(ob)
    select(ob, faces=range(16))
    bm = bmesh.from_edit_mesh(ob.data)
    layer = bm.loops.layers.uv.verify()
    bm.faces.ensure_lookup_table()
    for face in bm.faces:
        for loop in face.loops:
            picked = loop if hasattr(loop, "uv_select_vert") else loop[layer]
            names = ("uv_select_vert", "uv_select_edge") if picked is loop else ("select", "select_edge")
            for name in names:
                setattr(picked, name, face.index in (5, 6))
    bmesh.update_edit_mesh(ob.data)
    reader = scene.Reader([ob], uv_selection=True)
    assert np.flatnonzero(reader.surface.chosen).tolist() == [5, 6]
    assert set(reader.surface.face[reader.grabbed]) == {5, 6}
    edges = {tuple(sorted(reader.surface.edges[e])) for e in np.flatnonzero(reader.surface.line)}
    sides = lambda f: {tuple(sorted(k)) for k in ob.data.polygons[f].edge_keys}
    assert edges == sides(5) | sides(6)
    assert np.flatnonzero(scene.Reader([ob]).surface.chosen).tolist() == list(range(16))
