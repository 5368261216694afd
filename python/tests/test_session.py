# SPDX-License-Identifier: MIT
"""Interactive sessions."""

from __future__ import annotations

import gc
import os
import resource

import numpy as np
import pytest

import taut


def test_a_pin_is_dragged_and_each_frame_is_injective(bowl):
    V, F = bowl
    with taut.Session(V, F) as s:
        first = s.solve().x
        s.pin(0, first[0]).pin(288, first[288])
        for k in range(1, 6):
            frame = s.pin(144, first[144] + [0.02 * k, 0]).solve(time=0.015)
            assert taut.certify(F, frame.x)
        frame = s.solve()
        assert frame.pins_held and (frame.x[144] == first[144] + [0.1, 0]).all() and frame.converged
        assert sorted(s.pins.tolist()) == [0, 144, 288]


def test_frames_are_read_only_views_and_stay(bowl):
    with taut.Session(*bowl) as s:
        frame = s.solve()
        before = frame.x.copy()
        with pytest.raises(ValueError):
            frame.x[0] = 0
        s.pin(3, frame.x[3] + 0.2).solve()
    assert (frame.x == before).all() and s.x is not frame.x
    with pytest.raises(taut.ParameterError, match="closed"):
        s.solve()


def test_snapshots_are_gone_back_to(bowl):
    with taut.Session(*bowl) as s:
        first = s.solve()
        s.pin(0, first.x[0])
        at = s.snapshot()
        s.pin(5, first.x[5] + 0.3).solve()
        s.restore(at)
        assert s.pins.tolist() == [0] and s.x is first.x
        assert np.allclose(s.solve().x, first.x, atol=1e-3)


def test_single_coordinates_springs_moves_and_releases(bowl):
    with taut.Session(*bowl) as s:
        first = s.solve().x
        s.pin(7, [0.25, np.nan]).pin_v(8, 0.5).spring(9, first[9], 1.0)
        s.move([20, 21], lambda x: x + 0.01)
        frame = s.solve()
        assert frame.x[7, 0] == 0.25 and frame.x[8, 1] == 0.5 and (frame.x[20] == first[20] + 0.01).all()
        s.release([20, 21])
        assert s.pins.tolist() == [7, 8]
        s.release()
        assert len(s.pins) == 0


def test_volumes_planes_and_shells(bar, bowl):
    V, C = bar
    with taut.Session(V, C) as s:
        s.move(np.flatnonzero(V[:, 2] == 0), V[V[:, 2] == 0])
        frame = s.pin(len(V) - 1, V[-1] + [0.3, 0, 0]).solve()
        assert frame.x.shape == V.shape and frame.pins_held and taut.certify(C, frame.x)
    V, F = bowl
    with taut.Session(V, F, kind="shell", thickness=0.1) as s:
        s.move([0, 16], V[[0, 16]])
        assert s.pin(288, V[288] + [0, 0, 0.2]).solve().pins_held
    with taut.Session(V[:, :2], F, kind="plane") as s:
        assert s.pin(0, V[0, :2] - 0.1).pin(288, V[288, :2]).solve().pins_held


def test_wrong_pins_change_nothing(bowl):
    with taut.Session(*bowl) as s:
        x = s.solve().x
        for wrong in (lambda: s.pin(10**6, [0, 0]), lambda: s.pin(0, [0, 0, 0]), lambda: s.pin(0, [np.inf, 0]),
                      lambda: s.move([1, 2], [[0, 0]]), lambda: s.spring(0, [0, 0], -1)):
            with pytest.raises(taut.TautError):
                wrong()
        assert len(s.pins) == 0 and np.allclose(s.solve().x, x)
    with pytest.raises(taut.ParameterError, match="map, plane, volume, shell"):
        taut.Session(*bowl, kind="surface")


def test_memory_does_not_grow_with_sessions(bowl):
    def peak_after(sessions):
        for _ in range(sessions):
            with taut.Session(*bowl) as s:
                s.pin(0, s.solve().x[0]).solve(steps=1)
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = peak_after(10)
    assert peak_after(190 if os.environ.get("TAUT_LONG_TESTS") else 40) - before < 8192  # KiB


def test_a_session_goes_on_from_a_map_that_is_given(bowl):
    V, F = bowl
    given = taut.unwrap(V, F).x @ np.array([[0.6, 0.8], [-0.8, 0.6]]) + [3, 4]
    held = [0, 16, 288]
    with taut.Session(V, F, initial=given, b=held, bc=given[held]) as s:
        frame = s.solve()
        assert frame.pins_held and np.allclose(frame.x, given, atol=1e-3)
    with pytest.raises(taut.ParameterError, match="initial"):
        taut.Session(V, F, initial=given[:-1])


def test_arguments_of_pins_are_named(bowl):
    V, F = bowl
    with taut.Session(V, F) as s:
        with pytest.raises(taut.ParameterError, match="v: is an array.*move"):
            s.pin([1, 2], [[0, 0], [1, 1]])
        with pytest.raises(taut.ParameterError, match=r"x: has the shape \(3,\), but must be \(2,\)"):
            s.pin(1, [0, 0, 0])
        with pytest.raises(taut.ParameterError, match="v: row 0 names -1"):
            s.pin(-1, [0, 0])
        assert s.pins.tolist() == []


def test_steps_beyond_all_bounds_and_arguments_without_effect(bowl):
    V, F = bowl
    with taut.Session(V, F) as s:
        assert s.solve(steps=10**12).converged
    for field, given in [("thickness", {"thickness": 0.1}), ("initial", {"kind": "shell", "initial": V}),
                         ("energy", {"kind": "shell", "energy": "shape"}),
                         ("weights", {"kind": "shell", "weights": np.ones(len(F))})]:
        with pytest.raises(taut.ParameterError) as e:
            taut.Session(V, F, **given)
        assert e.value.field == field
