# SPDX-License-Identifier: MIT
"""Packing of charts."""

from __future__ import annotations

import numpy as np
import pytest

import taut


def squares(n: int, size: float = 1.0):
    """n separate squares of two triangles, each in its place."""
    uv, F = [], []
    for k in range(n):
        uv += [[3.0 * k, 0], [3.0 * k + size, 0], [3.0 * k + size, size], [3.0 * k, size]]
        F += [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]
    return np.array(uv), np.array(F)


def boxes(made, F):
    corners = made.uv[F]
    return [(corners[made.chart == c].reshape(-1, 2).min(0), corners[made.chart == c].reshape(-1, 2).max(0))
            for c in range(made.chart.max() + 1)]


def distance(a, b):
    return np.linalg.norm(np.maximum(np.maximum(a[0] - b[1], b[0] - a[1]), 0))


def test_charts_keep_their_shape_and_their_distance():
    uv, F = squares(5)
    made = taut.pack(uv, F, resolution=256, padding=4, rotate=False)
    assert made.chart.tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4] and made.complete
    assert made.uv.min() >= 4 / 256 - 1e-9 and made.uv.max() <= 1 - 4 / 256 + 1e-9
    sides = made.uv[F[:, 1]] - made.uv[F[:, 0]]
    assert np.allclose(np.linalg.norm(sides[::2], axis=1), made.scale)
    found = boxes(made, F)
    for i in range(5):
        for j in range(i):
            assert distance(found[i], found[j]) >= 4 / 256 - 1e-9


def test_what_is_fixed_stays_and_others_keep_off_it():
    uv, F = squares(3, 0.4)
    fixed = np.array([True, False, False, False, False, False])
    made = taut.pack(uv, F, fixed=fixed, resolution=256, rotate=False)
    assert (made.uv[:4] == uv[:4]).all()
    first, *others = boxes(made, F)
    assert all(distance(first, other) >= 2 / 256 - 1e-9 for other in others)
    with pytest.raises(taut.ParameterError, match="triangle 2 leaves its tile") as wrong:
        taut.pack(uv + [0.8, 0], F, fixed=[0, 0, 1, 0, 0, 0])
    assert wrong.value.ids == [2]


def test_tiles_lie_in_rows_of_ten_and_densities_scale_charts():
    uv, F = squares(12)
    made = taut.pack(uv, F, tiles=12)
    assert sorted(set(made.tile.tolist())) == list(range(12))
    for t in range(12):
        corners = made.uv[F[made.tile == t]].reshape(-1, 2) - [t % 10, t // 10]
        assert corners.min() >= 0 and corners.max() <= 1
    uv, F = squares(2)
    made = taut.pack(uv, F, densities=[1, 1, 2, 2])
    length = np.linalg.norm(made.uv[F[:, 1]] - made.uv[F[:, 0]], axis=1)
    assert np.isclose(length[2], 2 * length[0])


def test_all_fixed_and_none_at_all():
    uv, F = squares(1, 0.5)
    assert (taut.pack(uv, F, fixed=[1, 0]).uv == uv).all()
    for name, value in (("resolution", -1), ("resolution", "large"), ("padding", np.nan), ("rotate", "no"),
                        ("time_limit", -1), ("densities", [1, 2])):
        with pytest.raises(taut.ParameterError, match=name):
            taut.pack(uv, F, fixed=True, **{name: value})
    assert taut.pack(np.zeros((0, 2)), np.zeros((0, 3), int)).uv.shape == (0, 2)


@pytest.mark.parametrize("size", [1e-300, 1e300])
def test_sizes_near_the_ends_of_doubles_are_packed(size):
    uv, F = np.array([[0, 0], [1, 0], [0, 1], [5, 5], [6, 5], [5, 6.0]]), [[0, 1, 2], [3, 4, 5]]
    made, plain = taut.pack(uv * size, F), taut.pack(uv, F)
    assert made.utilization == pytest.approx(plain.utilization, rel=0.05) and taut.certify(F, made.uv)
    assert made.scale * size == pytest.approx(plain.scale, rel=0.05)
