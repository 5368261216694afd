# SPDX-License-Identifier: MIT
"""Check, undo, jobs that are stopped, time limits, and what operators say."""

import time
import types

import bmesh
import bpy
import judge
import numpy as np
import pytest
import taut_uv
from scenes import choose, corners_of, flat, hill, made, mode, primitive, select, tube, tube_seams, uv_of
from taut_uv import operators, running, scene
from taut_uv.core import library
from taut_uv.core.atlas import atlas
from taut_uv.core.check import overlapping_faces
from taut_uv.core.surface import from_polygons
from taut_uv.core.unwrap import unwrap
from taut_uv.core.work import Task


def sheets(count, n=6):
    """Separate sheets in one mesh."""
    one = hill(n, 0.5)
    V = np.array([v.co[:] for v in one.data.vertices])
    F = np.array([p.vertices[:] for p in one.data.polygons])
    bpy.data.objects.remove(one)
    return made(
        "Sheets",
        np.concatenate([V + [3 * k, 0, 0] for k in range(count)]),
        np.concatenate([F + k * len(V) for k in range(count)]),
    )


def start(command, **options):
    reader = scene.Reader(scene.objects(bpy.context), new_map=True)
    return reader, Task(running.module(), command, reader.surface, **options)


def wait(until, seconds=20):
    end = time.monotonic() + seconds
    while not until():
        assert time.monotonic() < end
        time.sleep(0.0005)


def test_a_job_that_is_stopped_keeps_what_is_done():
    ob = sheets(150)
    before = np.float32(uv_of(ob))
    reader, task = start(unwrap)
    wait(lambda: task.note.startswith("island ") and int(task.note.split()[1]) > 20)
    task.stop()
    result = task.result(20)
    scene.write(reader, result)
    r = judge.Read(ob)
    done = np.array([result.changed[p].all() for p in r.polygons])
    assert not result.complete and 20 * 36 <= done.sum() < len(done) and done.sum() % 36 == 0
    untouched = np.concatenate([r.polygons[p] for p in np.flatnonzero(~done)])
    assert (uv_of(ob)[untouched] == before[untouched]).all()
    some = np.isin(r.of, np.flatnonzero(done))
    assert (judge.signs(r.tri()[some]) > 0).all()
    assert r.uv[np.concatenate([r.polygons[p] for p in np.flatnonzero(done)])].max() <= 1


def test_an_atlas_that_is_stopped_has_charts_without_flips_and_overlaps():
    ob = primitive("ico_sphere", "Ball", subdivisions=7)
    for v in ob.data.vertices:
        v.co *= 1 + 0.1 * np.sin(9 * v.co.x) * np.cos(7 * v.co.y)
    reader, task = start(atlas, prefer="packing")
    wait(lambda: task.usable or task.done)
    early = not task.done
    task.stop()
    result = task.result(60)
    if result.changed.any():
        scene.write(reader, result)
        r = judge.Read(ob)
        assert (judge.signs(r.tri()) > 0).all()
    assert result.complete != early


@pytest.mark.parametrize("limit", [0.01, 0.3])
def test_a_time_limit_keeps_what_is_done(limit):
    ob = sheets(300)
    before = uv_of(ob).copy()
    began = time.monotonic()
    answer = bpy.ops.taut.unwrap(time_limit=limit)
    assert time.monotonic() - began < limit + 10
    uv = uv_of(ob)
    changed = (uv != before).any(1)
    r = judge.Read(ob)
    done = np.array([changed[p].any() for p in r.polygons])
    assert done.sum() < len(done) and (answer == {"FINISHED"}) == (done.sum() > 0)
    assert (judge.signs(r.tri()[np.isin(r.of, np.flatnonzero(done))]) > 0).all()


def test_a_time_limit_of_an_atlas_gives_a_valid_one():
    ob = primitive("ico_sphere", "Ball", subdivisions=6)
    bpy.ops.taut.atlas(time_limit=0.05)
    r = judge.Read(ob)
    assert (judge.signs(r.tri()) > 0).all() and r.uv.min() >= 0 and r.uv.max() <= 1


@pytest.mark.parametrize("name, options", [("unwrap", {}), ("atlas", {}), ("relax", {"axis": "u"})])
def test_undo_and_redo(name, options):
    ob = hill(10, 0.6)
    ob.data.edges[5].use_seam = True
    before, marked = flat(ob).copy(), judge.Read(ob).seams
    bpy.ops.ed.undo_push(message="before")
    getattr(bpy.ops.taut, name)("EXEC_DEFAULT", True, **options)
    after, seams = uv_of(bpy.data.objects["Hill"]).copy(), judge.Read(bpy.data.objects["Hill"]).seams
    assert (after != before).any()
    bpy.ops.ed.undo()
    assert (uv_of(bpy.data.objects["Hill"]) == before).all() and judge.Read(bpy.data.objects["Hill"]).seams == marked
    bpy.ops.ed.redo()
    assert (uv_of(bpy.data.objects["Hill"]) == after).all() and judge.Read(bpy.data.objects["Hill"]).seams == seams
    for c in operators.CLASSES[:5]:
        assert {"REGISTER", "UNDO"} <= c.bl_options


def test_check_selects_what_is_flipped_and_what_overlaps_and_changes_nothing_else():
    ob = hill(12, 0.4)
    uv = flat(ob).copy()
    uv[corners_of(ob, [84])] += np.float32([0.09, 0])  # beyond its neighbour
    before = uv_of(ob, uv).copy()
    r = judge.Read(ob)
    flipped = set(r.of[judge.signs(r.tri()) <= 0].tolist())
    over = {p for pair in judge.overlaps(r) for _, p in pair}
    assert flipped and over
    bpy.ops.taut.check(overlaps=False)
    assert set(np.flatnonzero(judge.Read(ob).selected)) == flipped
    bpy.ops.taut.check(flips=False)
    assert set(np.flatnonzero(judge.Read(ob).selected)) == over
    select(ob, faces=range(144))
    bpy.ops.taut.check()
    mode("OBJECT")
    assert set(np.flatnonzero(judge.Read(ob).selected)) == flipped | over and (uv_of(ob) == before).all()


def test_check_sees_overlaps_of_islands_and_of_objects_and_none_of_neighbours():
    one, other = tube(name="One"), hill(6, name="Two")
    tube_seams(one)
    choose(one, other)
    bpy.ops.taut.unwrap()
    bpy.ops.taut.check()
    assert not judge.Read(one).selected.any() and not judge.Read(other).selected.any()
    uv_of(other, uv_of(other) * 0 + uv_of(one)[0] + flat(other, 0.05, 0.0))
    bpy.ops.taut.check()
    expected = judge.overlaps(judge.Read(one), judge.Read(other))
    got = {(k, p) for k, ob in enumerate((one, other)) for p in np.flatnonzero(judge.Read(ob).selected)}
    assert got == {e for pair in expected for e in pair} and len(got) > 1


def test_check_of_many_random_triangles_agrees_with_exact_arithmetic():
    rng = np.random.default_rng(1)
    n = 150
    V = rng.random((3 * n, 3))
    ob = made("Confetti", V, np.arange(3 * n).reshape(n, 3))
    at = np.repeat(rng.random((n, 2)), 3, 0) + 0.08 * rng.random((3 * n, 2))
    uv_of(ob, np.round(at * 64) / 64)  # many touch in points and along sides
    r = judge.Read(ob)
    solid = judge.signs(r.tri()) != 0
    bpy.ops.taut.check(flips=False)
    over = {p for pair in judge.overlaps(r) for _, p in pair if solid[p]}
    assert set(np.flatnonzero(judge.Read(ob).selected)) == over


def test_faces_that_all_lie_on_each_other_and_sizes_far_apart_take_no_longer():
    n = 60_000
    corner = np.array([[0, 0], [1, 0], [0, 1]])
    s = from_polygons(np.zeros((3 * n, 3)), np.arange(3 * n).reshape(n, 3).tolist(), uv=np.tile(corner, (n, 1)))
    began = time.monotonic()
    assert len(overlapping_faces(s)) == n and time.monotonic() - began < 30
    # Small ones in rows, apart, with large ones beside them.
    at = np.c_[np.arange(n) % 300, np.arange(n) // 300] / 1024
    s.uv = (at[:, None] + corner / 2048).reshape(-1, 2)
    s.uv[-6:-3], s.uv[-3:] = [[9, 9], [1e30, 9], [9, 1e30]], [[-1, -1], [0.9, -1], [-1, 0.9]]
    assert len(overlapping_faces(s)) == 0
    s.uv[-3:] = [[-9, -9], [10.3 / 1024, -9], [10.3 / 1024, 10]]  # over the first ten columns
    expected = np.flatnonzero(np.append(over(s.uv[:-6], s.uv[-3:]), [False, True]))
    assert (overlapping_faces(s) == expected).all() and len(expected) > 2000


def over(small, large):
    """Which triangles of a list overlap one that is counter-clockwise."""
    corners = small.reshape(-1, 3, 2)
    hit = np.ones(len(corners), bool)
    large = np.broadcast_to(large, corners.shape)
    for one, other in ((large, corners), (corners, large)):
        for k in range(3):
            d, e = one[:, (k + 1) % 3] - one[:, k], other - one[:, [k]]
            hit &= (d[:, None, 0] * e[:, :, 1] - d[:, None, 1] * e[:, :, 0] > 0).any(1)
    return hit


class Modal(running.Command):
    """An operator without a window: what Blender would do is written down."""

    bl_label, command = "Unwrap", staticmethod(unwrap)
    makes_map = True

    def __init__(self):
        self.said, self.status = [], []
        wm = types.SimpleNamespace(
            event_timer_add=lambda *a, **k: "timer",
            modal_handler_add=lambda o: None,
            event_timer_remove=lambda t: None,
        )
        self.context = types.SimpleNamespace(
            window="window",
            window_manager=wm,
            workspace=types.SimpleNamespace(status_text_set=self.status.append),
            screen=None,
            mode=bpy.context.mode,
            selected_objects=bpy.context.selected_objects,
            space_data=None,
        )

    def report(self, level, text):
        self.said.append((next(iter(level)), text))

    def event(self, kind):
        return self.modal(self.context, types.SimpleNamespace(type=kind, value="PRESS"))


def test_a_modal_job_shows_progress_and_ends_with_its_result():
    ob = sheets(20)
    op = Modal()
    assert op.launch(op.context) == {"RUNNING_MODAL"} and not Modal.poll(op.context)
    assert op.event("MOUSEMOVE") == {"PASS_THROUGH"}
    end = time.monotonic() + 20
    while (answer := op.event("TIMER")) == {"PASS_THROUGH"} and time.monotonic() < end:
        time.sleep(0.002)
    assert answer == {"FINISHED"} and op.status[-1] is None and any("island" in (t or "") for t in op.status)
    assert judge.flips(judge.Read(ob)) == 0 and Modal.poll(op.context) and op.said[-1][1] == "Unwrap: islands 20"


@pytest.mark.parametrize("by", ["escape", "button"])
def test_escape_and_the_stop_button_keep_what_is_done(by):
    ob = sheets(150)
    before = uv_of(ob).copy()
    op = Modal()
    op.launch(op.context)
    wait(lambda: running.current.note.startswith("island 1"))
    if by == "escape":
        assert op.event("ESC") == {"RUNNING_MODAL"}
    else:
        assert bpy.ops.taut.stop() == {"FINISHED"}
    wait(lambda: running.current.done)
    answer = op.event("TIMER")
    assert ("WARNING", "Unwrap ended early; what is done is kept") in op.said or answer == {"CANCELLED"}
    r = judge.Read(ob)
    changed = (uv_of(ob) != before).any(1)
    done = np.array([changed[p].any() for p in r.polygons])
    assert done.sum() < len(done) and (judge.signs(r.tri()[np.isin(r.of, np.flatnonzero(done))]) > 0).all()


def sort_faces(ob):
    mode("EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.sort_elements(type="RANDOMIZE", elements={"FACE"}, seed=3)
    mode("OBJECT")


def rotate_edges(ob):
    bm = bmesh.new()
    bm.from_mesh(ob.data)
    bmesh.ops.rotate_edges(bm, edges=[e for e in bm.edges if len(e.link_faces) == 2][::7])
    bm.to_mesh(ob.data)
    bm.free()


def add_loose_edge(ob):
    ob.data.vertices.add(1)
    ob.data.edges.add(1)


def pin(ob):
    layer = ob.data.uv_layers.active
    layer.pin[0].value = True
    layer.uv[0].vector = (5, 5)


def paint(ob):
    ob.vertex_groups["Paint"].add([0], 0.5, "REPLACE")


def other_map(ob):
    ob.data.uv_layers.active = ob.data.uv_layers.new(name="Other")


CHANGES = {
    "faces in another order": sort_faces,
    "edges rotated": rotate_edges,
    "an edge more": add_loose_edge,
    "a vertex moved": lambda ob: setattr(ob.data.vertices[3].co, "z", 0.7),
    "a UV pinned and moved": pin,
    "a UV moved": lambda ob: setattr(ob.data.uv_layers.active.uv[7].vector, "x", 9),
    "a seam marked": lambda ob: setattr(ob.data.edges[5], "use_seam", True),
    "a face hidden": lambda ob: setattr(ob.data.polygons[2], "hide", True),
    "weights painted": paint,
    "another map": other_map,
    "stretched": lambda ob: (setattr(ob, "scale", (3, 1, 1)), bpy.context.view_layer.update()),
    "renamed": lambda ob: setattr(ob, "name", "Another"),
}


@pytest.mark.parametrize("command", [unwrap, atlas])
@pytest.mark.parametrize("change", CHANGES)
def test_a_mesh_that_was_changed_meanwhile_is_left_alone(change, command, monkeypatch):
    ob = hill(6, 0.4)
    flat(ob)
    ob.vertex_groups.new(name="Paint").add(range(20), 0.7, "REPLACE")
    op = Modal()
    op.weights = "Paint"
    monkeypatch.setattr(Modal, "command", staticmethod(command))
    op.launch(op.context)
    wait(lambda: running.current.done)
    CHANGES[change](ob)
    before, seams = uv_of(ob).copy(), judge.Read(ob).seams
    assert op.event("TIMER") == {"CANCELLED"} and "changed while the job ran" in op.said[-1][1]
    assert (uv_of(ob) == before).all() and judge.Read(ob).seams == seams


def test_what_does_not_change_a_map_may_change_meanwhile():
    ob = hill(6, 0.4)
    op = Modal()
    op.launch(op.context)
    wait(lambda: running.current.done)
    ob.location, ob.data.polygons[3].select = (1, 2, 3), False
    bpy.context.view_layer.update()
    assert op.event("TIMER") == {"FINISHED"} and judge.flips(judge.Read(ob)) == 0


@pytest.mark.parametrize("way", ["another file", "closed window", "add-on disabled"])
def test_a_job_that_is_dropped_lets_others_begin(way):
    sheets(50)
    op = Modal()
    op.launch(op.context)
    task = running.current
    if way == "another file":
        bpy.ops.wm.read_homefile(use_empty=True)
    elif way == "closed window":
        op.cancel(op.context)
    else:
        taut_uv.unregister()
        taut_uv.register()
    assert task.stopped and running.current is None
    ob = hill(6)
    assert bpy.ops.taut.unwrap.poll() and op.event("TIMER") == {"CANCELLED"}
    assert bpy.ops.taut.unwrap() == {"FINISHED"} and judge.flips(judge.Read(ob)) == 0


def test_linked_meshes_of_one_name_are_several_and_are_left_alone(tmp_path):
    for k in (3, 5):
        ob = hill(k, name="Hill")
        bpy.data.libraries.write(str(tmp_path / f"{k}.blend"), {ob}, fake_user=True)
        bpy.data.objects.remove(ob)
        bpy.data.meshes.remove(bpy.data.meshes["Hill"])
    found = []
    for k in (3, 5):
        with bpy.data.libraries.load(str(tmp_path / f"{k}.blend"), link=True) as (_, into):
            into.objects = ["Hill"]
        found += into.objects
    for ob in found:
        bpy.context.collection.objects.link(ob)
    choose(*found)
    assert sorted(len(ob.data.polygons) for ob in scene.objects(bpy.context)) == [9, 25]
    with pytest.raises(RuntimeError, match="Hill: is linked from another file; make it local"):
        bpy.ops.taut.unwrap()
    for ob in found:
        bpy.data.objects.remove(ob)


def test_a_missing_package_is_an_error_with_a_remedy(monkeypatch):
    def missing(folder=""):
        raise library.Missing("the Python package taut cannot be loaded (...); install the zip that contains it")

    hill(4)
    monkeypatch.setattr(library, "taut", missing)
    with pytest.raises(RuntimeError, match="taut cannot be loaded.*install the zip"):
        bpy.ops.taut.unwrap()


def test_nothing_selected_is_no_crash():
    ob = hill(4)
    ob.select_set(False)
    assert not bpy.ops.taut.unwrap.poll()
    choose(ob)
    select(ob, faces=[])
    with pytest.raises(RuntimeError, match="no face is selected; select some, or all"):
        bpy.ops.taut.unwrap()
    with pytest.raises(RuntimeError, match="no face is selected"):
        bpy.ops.taut.atlas()


def test_several_objects_are_edited_at_once():
    one, other = hill(8, name="One"), hill(6, name="Two")
    choose(one, other)
    mode("EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.taut.atlas()
    mode("OBJECT")
    reads = judge.Read(one), judge.Read(other)
    assert not judge.overlaps(*reads) and all(judge.flips(r) == 0 for r in reads)


def test_hidden_faces_are_left_alone():
    ob = hill(8)
    before = flat(ob).copy()
    for p in ob.data.polygons:
        p.hide = p.index < 8
    bpy.ops.taut.unwrap()
    hidden = [c for p in ob.data.polygons if p.hide for c in p.loop_indices]
    shown = np.setdiff1d(np.arange(len(before)), hidden)
    assert (uv_of(ob)[hidden] == before[hidden]).all() and (uv_of(ob)[shown] != before[shown]).any()
