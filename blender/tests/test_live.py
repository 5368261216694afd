# SPDX-License-Identifier: MIT
"""Live: frames of a drag, without a window."""

import time
import types

import bpy
import judge
import numpy as np
import pytest
from scenes import corners_of, flat, hill, mode, pin, select, tube, tube_seams, uv_of
from taut_uv import dragging, running, scene
from taut_uv.core.live import Drag


def drag_of(grabbed):
    reader = scene.Reader(scene.objects(bpy.context))
    flags = np.zeros(reader.surface.corners, bool)
    flags[grabbed] = True
    drag = Drag(running.module(), reader.surface, flags)
    return drag, dragging.Canvas(reader, drag)


def test_every_frame_is_drawn_without_flips_and_the_grabbed_vertex_arrives():
    ob = hill(16, 0.5)
    bpy.ops.taut.unwrap()
    pinned = corners_of(ob, [0, 16, 272, 288])
    before = uv_of(ob).copy()
    pin(ob, [0, 16, 272, 288])
    own = corners_of(ob, [144])
    drag, canvas = drag_of(own)
    for k in range(1, 21):
        canvas.draw(drag.frame((0.01 * k, -0.005 * k)))
        r = judge.Read(ob)
        assert judge.flips(r) == 0 and (uv_of(ob)[pinned] == before[pinned]).all()
    canvas.draw(drag.finish((0.2, -0.1)))
    assert drag.distance == 0
    assert (uv_of(ob)[own] == (before[own].astype(float) + [0.2, -0.1]).astype(np.float32)).all()
    canvas.draw(drag.before())
    assert (uv_of(ob) == before).all()
    drag.close()


def test_frames_are_in_time():
    ob = hill(70, 0.5)  # 9,800 triangles
    bpy.ops.taut.unwrap()
    pin(ob, [0, 70])
    drag, canvas = drag_of(corners_of(ob, [71 * 35 + 35]))
    drag.frame((0.001, 0))  # the first one opens the session
    took = []
    for k in range(10):
        start = time.perf_counter()
        canvas.draw(drag.frame((0.002 * k, 0)))
        took.append(time.perf_counter() - start)
    print("median frame", np.median(took))
    assert np.median(took) < 0.25 and judge.flips(judge.Read(ob)) == 0


def test_a_goal_that_would_fold_is_not_reached():
    ob = hill(8, 0.3)
    bpy.ops.taut.unwrap(rotate=False)
    pin(ob, range(9))  # the lower border stays
    drag, canvas = drag_of(corners_of(ob, [13]))  # in the second row, dragged far below it
    canvas.draw(drag.finish((0, -0.8)))
    assert drag.distance > 0.1 and judge.flips(judge.Read(ob)) == 0


def test_the_operator_drags_selected_vertices_in_edit_mode():
    ob = hill(12, 0.5)
    bpy.ops.taut.unwrap()
    pin(ob, [0, 12])
    before = uv_of(ob).copy()
    select(ob, vertices=[84, 85])
    assert bpy.ops.taut.live(shift=(0.05, 0.02)) == {"FINISHED"}
    mode("OBJECT")
    own = corners_of(ob, [84, 85])
    assert (uv_of(ob)[own] == (before[own].astype(float) + np.float32([0.05, 0.02])).astype(np.float32)).all()
    assert judge.flips(judge.Read(ob)) == 0
    assert (uv_of(ob)[corners_of(ob, [0, 12])] == before[corners_of(ob, [0, 12])]).all()


def test_mouse_and_timer_events_move_it_and_escape_restores():
    """The modal part, with events of our own."""
    ob = hill(12, 0.5)
    bpy.ops.taut.unwrap()
    before = uv_of(ob).copy()
    drag, canvas = drag_of(corners_of(ob, [84]))
    view = types.SimpleNamespace(region_to_view=lambda x, y: (x / 1000, y / 1000))
    gone = []
    context = types.SimpleNamespace(
        region=types.SimpleNamespace(view2d=view),
        workspace=types.SimpleNamespace(status_text_set=gone.append),
        window_manager=types.SimpleNamespace(event_timer_remove=gone.append),
    )
    live = dragging.TAUT_OT_live
    me = types.SimpleNamespace(
        _drag=drag,
        _canvas=canvas,
        _from=(0.1, 0.1),
        _timer="timer",
        shift=(0, 0),
        place=live.place,
        leave=lambda c: live.leave(me, c),
        conclude=lambda shift: live.conclude(me, shift),
    )
    event = lambda kind, x=0: types.SimpleNamespace(type=kind, value="PRESS", mouse_region_x=x, mouse_region_y=100)
    assert live.modal(me, context, event("MOUSEMOVE", 150)) == {"RUNNING_MODAL"} and np.allclose(me.shift, (0.05, 0))
    assert live.modal(me, context, event("TIMER")) == {"RUNNING_MODAL"}
    assert (uv_of(ob) != before).any() and judge.flips(judge.Read(ob)) == 0
    assert live.modal(me, context, event("ESC")) == {"CANCELLED"} and "timer" in gone
    assert (uv_of(ob) == before).all()


def test_nothing_selected_and_flipped_islands_are_errors_with_remedies():
    ob = hill(8)
    flat(ob)
    select(ob, vertices=[])
    with pytest.raises(RuntimeError, match="no UV vertex is selected"):
        bpy.ops.taut.live(shift=(0.1, 0))
    mode("OBJECT")
    uv = uv_of(ob).copy()
    uv[corners_of(ob, [40])] += 0.4
    uv_of(ob, uv)
    select(ob, vertices=[10])
    with pytest.raises(RuntimeError, match="Hill: faces? .*flipped UVs.*Relax or Unwrap them first"):
        bpy.ops.taut.live(shift=(0.1, 0))


def test_two_islands_are_dragged_at_once():
    ob = tube()
    tube_seams(ob)
    bpy.ops.taut.unwrap()
    before = uv_of(ob).copy()
    caps = [list(ob.data.polygons[k].loop_indices) for k in (96, 97)]
    grabbed = [caps[0][0], caps[1][0]]
    drag, canvas = drag_of(grabbed)
    canvas.draw(drag.finish((0.004, 0.0)))
    assert (uv_of(ob)[grabbed] == (before[grabbed].astype(float) + [0.004, 0]).astype(np.float32)).all()
    assert judge.flips(judge.Read(ob)) == 0
