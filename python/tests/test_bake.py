# SPDX-License-Identifier: MIT
"""Textures for a new atlas."""

from __future__ import annotations

import numpy as np
import pytest

import taut


def test_a_texture_moves_with_its_atlas(torus):
    V, F = torus
    old, new = taut.atlas(V, F).corner_uv, taut.atlas(V, F, prefer="packing").corner_uv
    image = np.linspace(0, 1, 96 * 64 * 3).reshape(96, 64, 3)
    made = taut.bake(image, old, new, size=(128, 80))
    assert made.shape == (80, 128, 3)
    assert image.min() - 1e-6 <= made.min() and made.max() <= image.max() + 1e-6
    same = taut.bake(image, old, old, gutter=0)
    inside = same[..., 2] != 0
    assert inside.mean() > 0.3 and np.abs(same - image)[inside].mean() < 0.02


def test_labels_stay_labels(torus):
    V, F = torus
    a = taut.atlas(V, F)
    image = np.arange(64 * 64).reshape(64, 64) % 7
    made = taut.bake(image, a.corner_uv, a.corner_uv[..., ::-1], filter="nearest")
    assert made.shape == (64, 64) and set(np.unique(made)) <= set(range(7))


def test_what_does_not_fit_is_refused(torus):
    V, F = torus
    uv = taut.atlas(V, F).corner_uv
    for arguments in ((np.zeros(4), uv, uv), (np.zeros((4, 4)), uv[:, :2], uv), (np.zeros((4, 4, 5)), uv, uv),
                      (np.zeros((4, 4)), uv[:-1], uv)):
        with pytest.raises(taut.ParameterError):
            taut.bake(*arguments)
    with pytest.raises(taut.ParameterError):
        taut.bake(np.zeros((4, 4)), uv, uv, filter="cubic")
    with pytest.raises(taut.ParameterError, match="size: is 0 x 5"):
        taut.bake(np.zeros((4, 4)), uv, uv, size=(0, 5))
    with pytest.raises(taut.ParameterError, match="new_uv: has"):
        taut.bake(np.zeros((4, 4)), uv, uv[:-1])


def test_errors_name_arguments_of_python(torus):
    V, F = torus
    uv = taut.atlas(V, F).corner_uv
    image = np.zeros((4, 4))
    for arguments, options, field in (
        ((np.zeros((4, 4, 5)), uv, uv), {}, "image"),
        ((np.zeros((0, 4)), uv, uv), {}, "image"),
        ((image, uv, uv), dict(size=100000), "size"),
        ((image, uv, uv), dict(size="large"), "size"),
        ((image, uv, uv), dict(samples=0), "samples"),
        ((image, uv, uv), dict(gutter=-1), "gutter"),
        ((image, uv, uv), dict(wrap="fold"), "wrap"),
        ((image, uv, uv[:-1]), {}, "new_uv"),
    ):
        with pytest.raises(taut.ParameterError) as caught:
            taut.bake(*arguments, **options)
        assert caught.value.field == field and str(caught.value).startswith(f"{field}: "), str(caught.value)


@pytest.mark.parametrize(("field", "value"), [
    ("image", "x"), ("image", [[1, 2], [3]]), ("image", np.zeros((2, 2), complex)), ("image", np.full((2, 2), 1e300)),
    ("image", [[object()]]), ("image", np.zeros((0, 4))), ("old_uv", None), ("new_uv", "a"), ("size", float("nan")),
    ("size", 2.5), ("size", "12"), ("size", (1 << 40, 1)), ("samples", None), ("samples", 1.5), ("samples", 2**70),
    ("samples", float("nan")), ("gutter", "a"), ("gutter", [1]), ("gutter", -1)])
def test_what_no_argument_can_be_is_named(field, value):
    uv = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    arguments = {"image": np.zeros((3, 4)), "old_uv": uv, "new_uv": uv, field: value}
    with pytest.raises(taut.ParameterError, match=rf"^{field}\b") as e:
        taut.bake(**arguments)
    assert e.value.field == field


def test_places_that_floats_do_not_tell_apart_are_refused():
    uv = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    assert np.isfinite(taut.bake(np.zeros((3, 4)), uv * 1e6, uv)).all()
    for large in (1e8, 1e39, 1e300):
        with pytest.raises(taut.ParameterError, match="^old_uv: triangle 0 reaches over"):
            taut.bake(np.zeros((3, 4)), uv * large, uv)
    assert np.isfinite(taut.bake(np.zeros((3, 4)), uv + 2.0**50, uv)).all()  # far away, but not large
