# SPDX-License-Identifier: MIT
"""Volumes, meshes of the plane, shells, cut and paste."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import bowl_of

import taut


def test_a_bar_is_twisted_without_inverting_a_cell(bar):
    V, C = bar
    ends = np.flatnonzero((V[:, 2] == 0) | (V[:, 2] == V[:, 2].max()))
    bc = V[ends].copy()
    top = bc[:, 2] > 0
    bc[top, :2] = 2 - bc[top, :2]
    x, report = taut.deform(V, C, ends, bc)
    assert (x[ends] == bc).all() and taut.certify(C, x) and report["pins_held"]


def test_hexahedra_are_deformed_by_their_corners():
    V = np.array([[x, y, z] for z in (0, 1, 2) for y in (0, 1) for x in (0, 1)], float)
    H = np.array([[0, 1, 3, 2, 4, 5, 7, 6], [4, 5, 7, 6, 8, 9, 11, 10]])
    made = taut.deform(V, H, [0, 1, 2, 3, 8, 9, 10, 11], np.r_[V[:4], V[8:] + [0.3, 0, 0.5]])
    assert made.certified and made.pins_held
    both = taut.smooth(V, [H[:1], np.array([[4, 5, 7, 6, 8]])], boundary="free")
    assert both.certified


def test_a_mesh_of_the_plane_has_two_coordinates():
    V, F = bowl_of(8)
    V[:, 2] = 0
    edge = np.flatnonzero(np.abs(V[:, :2]).max(1) == 1)
    bc = V[edge, :2] * [1.5, 0.8]
    for v in (V, V[:, :2]):
        assert taut.deform(v, F, edge, bc).x.shape == (len(V), 2)
    V[0, 2] = 1
    with pytest.raises(taut.ParameterError, match="shell"):
        taut.deform(V, F, edge, bc)


def test_smoothing_betters_shapes_and_keeps_what_is_fixed(bar):
    V, C = bar
    rng = np.random.default_rng(1)
    inside = np.flatnonzero(((V > V.min(0)) & (V < V.max(0))).all(1))
    bent = V.copy()
    bent[inside] += rng.uniform(-0.2, 0.2, (len(inside), 3))
    made = taut.smooth(bent, C, fixed=inside[:1])
    assert (made.x[inside[0]] == bent[inside[0]]).all()
    assert made.report["after"]["worst_mean_ratio"] > made.report["before"]["worst_mean_ratio"]


def test_a_shape_goes_back_to_the_one_at_rest(bar):
    V, C = bar
    inside = ((V > V.min(0)) & (V < V.max(0))).all(1)
    bent = V.copy()
    bent[inside] += np.random.default_rng(1).uniform(-0.2, 0.2, (inside.sum(), 3))
    rim = np.flatnonzero(~inside)
    assert np.allclose(taut.deform(bent, C, rim, V[rim], rest=V, tolerance=1e-9).x, V, atol=1e-6)
    again = taut.smooth(bent, C, boundary="fixed", shapes="rest", rest=V, tolerance=1e-9)
    assert np.allclose(again.x, V, atol=1e-4)
    with pytest.raises(taut.ParameterError, match="rest"):
        taut.deform(bent, C, rim, V[rim], rest=V[1:])


def test_untangling_ends_with_a_map_or_a_proof(bar):
    V, C = bar
    edge = ((V == V.min(0)) | (V == V.max(0))).any(1)
    X = V.copy()
    X[~edge] = X[~edge][::-1]
    assert not taut.certify(C, X)
    made = taut.untangle(X, C, edge, rest=V, time_limit=20)
    assert taut.certify(C, made.x) and (made.x[edge] == X[edge]).all()
    with pytest.raises(taut.Infeasible) as e:
        taut.untangle([[0, 0], [0, 1], [1, 0]], [[0, 1, 2]], [0, 1, 2])
    assert e.value.ids == [0] and e.value.proof


def test_pins_that_fold_cells_are_reached_where_cells_may_be_split():
    V, F = bowl_of(2)
    V[:, 2] = 0
    edge = np.flatnonzero(np.abs(V[:, :2]).max(1) == 1)
    bc = V[edge, :2].copy()
    corner = np.flatnonzero((V[edge, :2] == [-1, 1]).all(1))[0]  # both its edges are on the boundary
    bc[corner] = [0.2, -0.2]
    with pytest.raises(taut.NoMap):
        taut.deform(V, F, edge, bc, time_limit=5)
    try:
        made = taut.deform(V, F, edge, bc, refine=True, time_limit=5)
        assert taut.certify(made.cells, made.x) and len(made.cell_origins) == len(made.cells)
    except taut.NoMap as e:
        assert e.reason


def test_a_shell_bends(bowl):
    V, F = bowl
    low = np.flatnonzero(V[:, 0] == -1)
    high = np.flatnonzero(V[:, 0] == 1)
    b = np.r_[low, high]
    bc = np.r_[V[low], V[high] + [0, 0, 0.5]]
    made = taut.shell(V, F, b, bc, thickness=0.05)
    assert (made.x[b] == bc).all() and made.certified
    with pytest.raises(taut.ParameterError, match=r"bc: has the shape"):
        taut.shell(V, F, b, bc[:, :2])


def test_a_feature_is_pasted(bowl):
    V, F = bowl
    middle = int(np.argmin((V**2).sum(1)))
    made = taut.paste((V, F), (V, F), middle, at=middle, radius=0.5, scale=0.5)
    new_V, new_F = made
    assert new_F.max() < len(new_V) and made.report["manifold"]
    kept = made.vmapping >= 0
    assert (made.vmapping[kept] < len(V)).all() and kept.sum() < len(V)
    with pytest.raises(taut.ParameterError, match="radius"):
        taut.paste((V, F), (V, F), middle)


def test_what_a_cell_cannot_be_is_said(bar):
    V, C = bar
    with pytest.raises(taut.ParameterError) as e:
        taut.deform(V, np.c_[C, C, C], [0], [[0, 0, 0]])
    assert e.value.field == "C"
    with pytest.raises(taut.ParameterError, match="give both"):
        taut.deform(V, C, [0])
