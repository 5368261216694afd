# SPDX-License-Identifier: MIT
"""Energies written in Python."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import taut
from taut import energies


@taut.energy
def symmetric_dirichlet(s):
    return s.S.norm2() * (1 + 1 / s.J**2)


@taut.energy
def mips(s):
    return s.S.norm2() / (2 * s.J)


@taut.energy
def cloth(s):
    warp = s.S @ s.direction
    stretch = warp @ warp - 1
    return energies.isometric(s) + s.parameter(0) * s.attribute(0) * stretch * stretch


@pytest.fixture(scope="module")
def bent(bowl):
    """A map that is distorted everywhere."""
    V, F = bowl
    return np.c_[V[:, 0] + 0.2 * V[:, 1] ** 2, 0.7 * V[:, 1] + 0.1 * V[:, 0]]


@pytest.mark.parametrize("mine, theirs", [(symmetric_dirichlet, "isometric"), (mips, "shape")])
def test_values_and_derivatives_are_those_of_the_library_to_the_last_bit(bowl, bent, mine, theirs):
    f, g = taut.Evaluator(*bowl, mine), taut.Evaluator(*bowl, theirs)
    assert f.value(bent) == g.value(bent)
    assert np.array_equal(f.gradient(bent), g.gradient(bent))
    S = [[1.25, 0.5], [-0.25, 0.75]]
    assert mine.value(S) == taut.energies.isometric.value(S) if theirs == "isometric" else True


def test_maps_of_both_are_the_same_bit_for_bit(bowl):
    assert np.array_equal(taut.unwrap(*bowl, energy=symmetric_dirichlet).uv, taut.unwrap(*bowl).uv)


def test_derivatives_are_right(bowl, bent):
    rng = np.random.default_rng(0)
    direction = rng.standard_normal(bent.shape)
    for energy in (symmetric_dirichlet, mips, 0.5 * energies.shape + energies.area, energies.neo_hookean(0.4)):
        f = taut.Evaluator(*bowl, energy)
        slope = (f.value(bent + 1e-6 * direction) - f.value(bent - 1e-6 * direction)) / 2e-6
        assert slope == pytest.approx((f.gradient(bent) * direction).sum(), rel=1e-6)


def test_hessians_are_sparse_matrices_of_scipy(bowl, bent):
    pytest.importorskip("scipy")
    f = taut.Evaluator(*bowl, symmetric_dirichlet)
    H = f.hessian(bent)
    d = np.random.default_rng(2).standard_normal(bent.shape)
    change = (f.gradient(bent + 1e-6 * d) - f.gradient(bent - 1e-6 * d)) / 2e-6
    assert np.allclose(H @ d.ravel(), change.ravel(), rtol=1e-4, atol=1e-6)
    projected = f.hessian(bent, projected=True)
    assert d.ravel() @ (projected @ d.ravel()) >= 0 and H.blocksize == (2, 2)


def test_the_largest_step_is_the_first_flip(bowl, bent):
    f = taut.Evaluator(*bowl)
    d = np.zeros_like(bent)
    d[144] = [1.0, 0.0]
    a = f.max_step(bent, d)
    assert taut.certify(bowl[1], bent + 0.999 * a * d) and not taut.certify(bowl[1], bent + 1.001 * a * d)
    assert f.value(bent + 1.001 * a * d) == np.inf


def test_attributes_directions_and_parameters(bowl):
    V, F = bowl
    attributes, directions = np.linspace(0.5, 2, len(F)), np.tile([1.0, 0, 0], (len(F), 1))
    maps = [taut.unwrap(V, F, energy=cloth, attributes=attributes, directions=directions, parameters=[p]) for p in (0, 1)]
    assert maps[0].energy < maps[1].energy and all(m.certified for m in maps)
    with pytest.raises(taut.ParameterError, match="parameters"):
        taut.unwrap(V, F, energy=cloth, attributes=attributes, directions=directions)
    with pytest.raises(taut.ParameterError, match="attributes: has 3 rows"):
        taut.unwrap(V, F, energy=cloth, attributes=[1, 2, 3], parameters=[1])


def test_volumes_have_energies_of_their_own(bar):
    @taut.energy
    def own(s):
        return s.S.norm2() / (3 * np.cbrt(s.J) ** 2) * (s.J + 1 / s.J)

    V, C = bar
    ends = np.flatnonzero((V[:, 2] == 0) | (V[:, 2] == V[:, 2].max()))
    assert taut.deform(V, C, ends, V[ends] * [1, 1, 1.2], energy=own).certified
    assert taut.check_gradient(own, dim=3) == []


def test_numpy_answers_for_traced_values():
    @taut.energy
    def many(s):
        a = np.sqrt(s.S.norm2()) + np.exp(-s.J) + np.log(s.J) ** 2 + np.minimum(s.J, 1) + np.maximum(2.0, s.J)
        b = np.float64(2) * s.J + s.J / np.float64(4) + (np.float32(1) - s.J) ** 2 + np.abs(s.J) + np.square(s.J)
        c = (s.S.T @ s.S).trace() + s.S.inverse().norm2() + s.S.det() + np.sqrt(s.S * s.S + 1.0).norm2()
        return a + b + c + np.sin(s.J) + np.cos(s.J) + np.tan(s.J / 9) + np.arctan(s.J) + np.floor(s.J)

    S = np.array([[1.25, 0.5], [-0.25, 0.75]])
    J = np.linalg.det(S)
    a = np.linalg.norm(S) + np.exp(-J) + np.log(J) ** 2 + min(J, 1) + max(2, J)
    b = 2 * J + J / 4 + (1 - J) ** 2 + J + J * J
    c = (S * S).sum() + (np.linalg.inv(S) ** 2).sum() + J + (S * S + 1).sum()
    expected = a + b + c + np.sin(J) + np.cos(J) + np.tan(J / 9) + np.arctan(J) + np.floor(J)
    assert many.value(S) == pytest.approx(expected)


def test_choices_are_where_and_truth_is_refused():
    @taut.energy
    def rigid(s):
        away = s.S.norm2() - 2 * np.sqrt(s.S.norm2() + 2 * s.J) + 2
        return away + taut.where((s.J < 1) & ~(s.J < -1), s.J - 1 - np.log(s.J), 0)

    assert rigid.value([[1, 0], [0, 1]]) == pytest.approx(0) and taut.check_gradient(rigid) == []

    for wrong in (lambda s: s.J if s.J > 0 else 0, lambda s: s.J and 1, lambda s: np.where(s.J > 0, s.J, 0),
                  lambda s: 1 if 0 < s.J < 2 else s.J):
        with pytest.raises(taut.TraceError, match="taut.where"):
            taut.Energy(wrong).value(np.eye(2))


def test_what_cannot_be_traced_is_said():
    import math

    with pytest.raises(taut.TraceError, match="numpy"):
        taut.Energy(lambda s: math.sqrt(s.J)).value(np.eye(2))
    with pytest.raises(taut.TraceError, match="arcsin"):
        taut.Energy(lambda s: np.arcsin(s.J)).value(np.eye(2))
    with pytest.raises(ZeroDivisionError):
        taut.Energy(lambda s: s.J / 0 + 1 // 0).value(np.eye(2))
    kept = []
    taut.Energy(lambda s: kept.append(s.J) or s.J).value(np.eye(2))
    with pytest.raises(taut.TraceError):
        kept[0] + 1


def test_energies_that_are_no_numbers_are_refused(bowl):
    V, F = bowl
    for wrong, name in ((lambda e: float("nan") * e, "factor: is nan"), (lambda e: e * np.inf, "factor: is inf"),
                        (lambda e: e / 0, "divisor: is 0"), (lambda e: e / "two", "divisor: is 'two'")):
        with pytest.raises(taut.ParameterError, match=name):
            wrong(energies.isometric)

    @taut.energy
    def nowhere(s):
        return s.S.norm2() + np.log(s.J - 1e6)

    flat, square = V[:, :2], [0, 1]
    for call in (lambda: taut.unwrap(V, F, energy=nowhere), lambda: taut.Session(V, F, energy=nowhere).solve(),
                 lambda: taut.deform(flat, F, square, flat[square], energy=nowhere)):
        with pytest.raises(taut.NoMap, match="energy: .*nan") as none:
            call()
        assert none.value.field == "energy" and none.value.fault == "not_finite"


def test_check_gradient_finds_what_is_wrong(bowl):
    assert any("barrier" in f for f in taut.check_gradient(taut.Energy(lambda s: s.S.norm2())))
    assert any("corner" in f for f in taut.check_gradient(taut.Energy(lambda s: s.S[0, 0] ** 2, barrier=False)))
    assert taut.check_gradient(cloth, attributes=[1.0], parameters=[1.0], directions=True) != []
    assert taut.check_gradient("isometric") == []


def test_energies_are_pickled():
    for e in (symmetric_dirichlet, energies.isometric, 0.5 * energies.shape + energies.area * energies.shape_power(3),
              2 * symmetric_dirichlet):
        assert pickle.loads(pickle.dumps(e)).value([[2, 0], [0, 1]]) == e.value([[2, 0], [0, 1]])


def test_numbers_in_energies_that_are_constants(bowl):
    assert taut.unwrap(*bowl, energy=lambda s: 3 * energies.isometric(s) / 3 + 0).certified
    assert taut.Energy(lambda s: 5, barrier=False).value(np.eye(2)) == 5
