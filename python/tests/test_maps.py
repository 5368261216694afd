# SPDX-License-Identifier: MIT
"""Maps of surfaces to the plane."""

from __future__ import annotations

import numpy as np
import pytest

import taut


def test_a_map_is_certified_and_in_the_users_order(bowl):
    V, F = bowl
    uv, report = taut.unwrap(V, F)
    assert uv.shape == (len(V), 2) and taut.certify(F, uv)
    assert report["stop"] in ("gradient", "decrement", "settled") and report["stages"]
    assert np.isfinite(taut.distortion(V, F, uv)).all()


def test_pins_hold_bit_for_bit_and_nan_leaves_a_coordinate_free(bowl):
    V, F = bowl
    first = taut.unwrap(V, F).uv
    bc = np.array([first[3] + 0.1, [first[100, 0], np.nan]])
    made = taut.unwrap(V, F, b=[3, 100], bc=bc)
    assert (made.uv[3] == bc[0]).all() and made.uv[100, 0] == bc[1, 0] and made.certified


def test_springs_pull(bowl):
    V, F = bowl
    first = taut.unwrap(V, F, b=[0], bc=[[0, 0]]).uv
    there = first[288] + [0.5, 0.0]
    pulled = taut.unwrap(V, F, b=[0], bc=[[0, 0]], springs=([288], [there], 100.0)).uv
    assert np.linalg.norm(pulled[288] - there) < 0.1


def test_maps_that_cannot_be_come_with_a_proof():
    V, F = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    with pytest.raises(taut.Infeasible) as e:
        taut.unwrap(V, F, b=[0, 1, 2], bc=[[0, 0], [0, 1], [1, 0]])
    assert e.value.ids == [0] and "pinned" in e.value.proof
    assert isinstance(e.value, taut.NoMap)


def test_what_is_no_disk_is_refused_or_cut(torus):
    V, F = torus
    with pytest.raises(taut.MeshError) as e:
        taut.unwrap(V, F)
    assert e.value.fault == "closed_surface"
    made = taut.unwrap(V, F, cut=True)
    assert made.vmapping is not None and (made.vmapping[made.faces] == F).all()
    assert taut.certify(made.faces, made.uv) and len(made.uv) > len(V)


def test_pins_of_a_surface_that_is_cut_are_of_its_vertices(torus):
    V, F = torus
    free = taut.unwrap(V, F, cut=True)
    once = [v for v in range(len(V)) if (free.vmapping == v).sum() == 1]
    made = taut.unwrap(V, F, cut=True, b=once[:1], bc=[[5.0, 6.0]])
    assert made.uv[made.vmapping == once[0]].tolist() == [[5.0, 6.0]]
    seam = next(v for v in range(len(V)) if (free.vmapping == v).sum() > 1)
    with pytest.raises(taut.ConstraintError) as e:
        taut.unwrap(V, F, cut=True, b=[seam], bc=[[0, 0]])
    assert e.value.ids == [seam]


def test_boundaries_placements_and_limits(bowl):
    V, F = bowl
    square = taut.unwrap(V, F, boundary="square", placement="unit_square").uv
    assert square.min() == 0 and square.max() == 1
    assert taut.unwrap(V, F, iterations=1).iterations <= 1
    assert taut.unwrap(V, F, tolerance=1e-9).energy <= taut.unwrap(V, F).energy
    assert taut.unwrap(V, F, initial=square, no_overlap=True).certified


def test_words_that_are_none_are_listed(bowl):
    with pytest.raises(taut.ParameterError, match="free, circle, square") as e:
        taut.unwrap(*bowl, boundary="round")
    assert e.value.field == "boundary"
    with pytest.raises(taut.ParameterError, match="isometric, shape"):
        taut.unwrap(*bowl, energy="symmetric_dirichlet")
    with pytest.raises(taut.ParameterError, match="tolerance"):
        taut.unwrap(*bowl, tolerance="small")


def test_constraints_that_contradict_name_their_vertices(bowl):
    with pytest.raises(taut.ConstraintError) as e:
        taut.unwrap(*bowl, b=[5, 5], bc=[[0, 0], [1, 1]])
    assert e.value.ids == [5] and e.value.fault == "contradictory"
    with pytest.raises(taut.ParameterError, match="bc: has 1 rows, but must have 2"):
        taut.unwrap(*bowl, b=[5, 6], bc=[[0, 0]])


def test_the_same_call_gives_the_same_map(bowl):
    assert np.array_equal(taut.unwrap(*bowl).uv, taut.unwrap(*bowl).uv)


def test_progress_is_told_and_may_end_a_call(large_bowl):
    told = []
    taut.unwrap(*large_bowl, progress=told.append, tolerance=1e-9)
    assert told and told[-1].stage == "map" and told[-1].seconds > 0
    made = taut.unwrap(*large_bowl, tolerance=1e-12, progress=lambda p: not p.usable)
    assert made.certified


def test_what_progress_raises_comes_out(large_bowl):
    def fail(p):
        raise ZeroDivisionError("here")

    with pytest.raises(ZeroDivisionError, match="here"):
        taut.unwrap(*large_bowl, progress=fail)
    assert taut.unwrap(*large_bowl, iterations=1).certified


def test_a_time_limit_gives_the_best_map_or_says_that_there_is_none(large_bowl):
    try:
        assert taut.unwrap(*large_bowl, time_limit=0.3).certified
    except taut.NoMap as e:
        assert e.fault == "stopped"


def rough_quads(n):
    """Hills of n by n quads, rough enough that a map of their triangles makes some concave: vertices, quads."""
    y, x = np.divmod(np.arange((n + 1) ** 2), n + 1)
    z = 4 * np.sin(0.9 * x + 0.3 * y) * np.cos(1.1 * y) + 0.9 * ((x * 7 + y * 5) % 3)
    j, i = np.divmod(np.arange(n * n), n)
    a = j * (n + 1) + i
    return np.column_stack([x, y, z]).astype(float), np.column_stack([a, a + 1, a + n + 2, a + n + 1])


def turns(x, quads):
    """The cross product at each corner of quads in space or in the plane."""
    corners = x[quads]
    a, b = corners - np.roll(corners, 1, 1), np.roll(corners, -1, 1) - corners
    return np.cross(a, b) if x.shape[1] == 3 else a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def test_polygons_that_are_convex_in_space_are_so_in_the_map():
    V, quads = rough_quads(12)
    F = quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    polygons = np.repeat(np.arange(len(quads)), 2)
    normals = turns(V, quads)
    total = normals.sum(1, keepdims=True)
    convex = ((normals * total).sum(2) > 1e-6 * (total**2).sum(2)).all(1)
    assert convex.sum() > 100

    def concave(uv):
        return np.flatnonzero(convex & ~(turns(uv, quads) > 0).all(1))

    assert len(concave(taut.unwrap(V, F).uv)) > 0  # else there is nothing to see
    made = taut.unwrap(V, F, polygons=polygons)
    assert made.certified and len(concave(made.uv)) == 0 and taut.certify(F, made.uv)
    pinned = taut.unwrap(V, F, polygons=polygons, b=[30, 100], bc=made.uv[[30, 100]])
    assert (pinned.uv[[30, 100]] == made.uv[[30, 100]]).all() and len(concave(pinned.uv)) == 0

    with pytest.raises(ValueError):
        taut.unwrap(V, F, polygons=polygons[:-1])
