# SPDX-License-Identifier: MIT
"""Arrays in and out."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import bowl_of
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import taut

V, F = bowl_of(6)
EXPECTED = taut.distortion(V, F, V[:, :2])

floats = st.sampled_from([np.float64, np.float32, ">f8", "<f4", np.longdouble])
ints = st.sampled_from([np.int64, np.int32, np.uint32, np.uint64, np.int16, np.uint16, np.uint8, ">i4", np.float64])


def laid_out(a: np.ndarray, layout: str) -> object:
    """The same numbers in another layout of memory."""
    if layout == "C":
        return np.ascontiguousarray(a)
    if layout == "F":
        return np.asfortranarray(a)
    if layout == "every second row":
        wide = np.zeros((2 * len(a), a.shape[1]), a.dtype)
        wide[::2] = a
        return wide[::2]
    if layout == "part of a record":
        wide = np.zeros((len(a), a.shape[1] + 3), a.dtype)
        wide[:, 2 : 2 + a.shape[1]] = a
        return wide[:, 2 : 2 + a.shape[1]]
    if layout == "backwards":
        return np.ascontiguousarray(a[::-1])[::-1]
    if layout == "read only":
        b = a.copy()
        b.flags.writeable = False
        return b
    return a.tolist()


layouts = st.sampled_from(["C", "F", "every second row", "part of a record", "backwards", "read only", "list"])


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(floats, ints, layouts, layouts)
def test_numbers_of_any_type_and_layout_are_the_same(real, integer, points, cells):
    v, f = laid_out(V.astype(real), points), laid_out(F.astype(integer), cells)
    found = taut.distortion(v, f, np.asarray(v, dtype=np.float64)[:, :2])
    assert np.allclose(found, EXPECTED, rtol=1e-3)
    assert found.dtype == np.float64 and found.flags.c_contiguous and found.flags.owndata is not None


def test_results_are_float64_and_int64_in_C_order_and_writable(torus):
    made = taut.atlas(*torus)
    for a, kind in ((made.uv, np.float64), (made.vmapping, np.int64), (made.faces, np.int64), (made.chart, np.int64)):
        assert a.dtype == kind and a.flags.c_contiguous and a.flags.writeable


def test_results_outlive_the_call():
    x = [taut.distortion(V, F, V[:, :2]) for _ in range(50)]
    assert all(np.array_equal(a, EXPECTED) for a in x)


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda V, F: (V[:, :1], F), ["V", "(289, 1)", "(n, 2)"]),
        (lambda V, F: (V.ravel(), F), ["V", "(867,)"]),
        (lambda V, F: (V, F[:, :2]), ["F", "(n, 3)"]),
        (lambda V, F: (np.where(np.arange(len(V))[:, None] == 7, np.nan, V), F), ["V", "row 7", "nan"]),
        (lambda V, F: (np.where(np.arange(len(V))[:, None] == 9, np.inf, V), F), ["V", "row 9", "inf"]),
        (lambda V, F: (V, np.where(F == 40, 4000, F)), ["F", "4000", "0 to 288", "row"]),
        (lambda V, F: (V, np.where(F == 40, -1, F)), ["F", "-1", "row"]),
        (lambda V, F: (V, F + 0.5), ["F", "row 0", "no index"]),
        (lambda V, F: ([["a", "b", "c"]], F), ["V", "no numbers"]),
        (lambda V, F: (V, [[1, 2], [3]]), ["F"]),
    ],
)
def test_what_is_wrong_with_an_array_is_named(bowl, change, words):
    with pytest.raises(taut.ParameterError) as e:
        taut.unwrap(*change(*bowl))
    assert all(w in str(e.value) for w in words), str(e.value)
    assert e.value.field == words[0]
    assert isinstance(e.value, ValueError)


def test_certificates_are_exact_and_complete():
    x = V[:, :2].copy()
    assert taut.certify(F, x)
    x[24] += [0.9, 0.9]
    flipped = taut.certify(F, x).flipped
    dets = np.linalg.det(np.stack([x[F[:, 1]] - x[F[:, 0]], x[F[:, 2]] - x[F[:, 0]]], 1))
    assert flipped.tolist() == np.flatnonzero(dets <= 0).tolist() and len(flipped)


def test_quality_is_one_of_a_flat_surface():
    flat = np.c_[V[:, :2], np.zeros(len(V))]
    q = taut.quality(flat, F, V[:, :2])
    assert q["isometric"]["measure"] == pytest.approx(4) and q["flips"] and q["area_ratio"]["max"] == pytest.approx(1)


def test_what_is_masked_is_not_read(bowl):
    V, F = bowl
    masked = np.ma.masked_array(V, mask=np.zeros(V.shape, bool))
    assert taut.distortion(masked, F, V[:, :2]).shape == (len(F),)
    masked[3, 1] = np.ma.masked
    with pytest.raises(taut.ParameterError, match="V: row 3 is masked") as e:
        taut.unwrap(masked, F)
    with pytest.raises(taut.ParameterError, match="V: row 3 is masked"):
        taut.unwrap(list(masked), F)
    assert e.value.ids == [3]
    triangles = np.ma.masked_array(F, mask=np.zeros(F.shape, bool))
    triangles[5] = np.ma.masked
    with pytest.raises(taut.ParameterError, match="F: row 5 is masked"):
        taut.unwrap(V, triangles)
    # Of pins it is a coordinate that is free, as NaN is.
    places = np.ma.masked_array([[0.5, 0.25]], mask=[[False, True]])
    assert taut.unwrap(V, F, b=[0], bc=places).uv[0, 0] == 0.5


@pytest.mark.parametrize("V, F", [([], []), (np.zeros((0, 3)), np.zeros((0, 3), int)), ([[0, 0, 0]], [])])
def test_an_empty_mesh_is_one_without_triangles(V, F):
    for call in (taut.unwrap, taut.atlas, taut.repair, taut.Session, taut.deform, taut.smooth):
        with pytest.raises(taut.MeshError, match="at least one") as e:
            call(V, F)
        assert e.value.fault == "empty"
    assert taut.certify(np.zeros((0, 3), int), np.zeros((0, 2)))


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda V, F: (V, F.astype(bool)), ["F", "flags"]),
        (lambda V, F: (V, np.where(F == 40, 2**32 + 40, F)), ["F", "4294967336", "0 to 288"]),
        (lambda V, F: (V, [[0, 1, 2**70]]), ["F", str(2**70), "0 to 288"]),
        (lambda V, F: (V, [[0, 1, 2], [0, 1]]), ["F", "row 1 has 2 numbers"]),
        (lambda V, F: (V, np.c_[F, F[:, 0]]), ["F", "split quads"]),
        (lambda V, F: (V.T, F), ["V", "transposed"]),
        (lambda V, F: (None, F), ["V", "None"]),
        (lambda V, F: (V + 0j, F), ["V", "complex"]),
        (lambda V, F: (V.astype(np.longdouble) * np.longdouble("1e4000"), F), ["V", "inf"]),
    ],
)
@pytest.mark.filterwarnings("error")
def test_surprises_of_arrays_are_told(bowl, change, words):
    with pytest.raises(taut.ParameterError) as e:
        taut.unwrap(*change(*bowl))
    assert all(w in str(e.value) for w in words), str(e.value)
    assert e.value.field == words[0]


def test_a_map_of_too_few_rows_is_named(bowl):
    V, F = bowl
    for call in (taut.distortion, taut.quality):
        with pytest.raises(taut.ParameterError, match="x: has 288 rows, but must have 289"):
            call(V, F, V[:-1, :2])


@pytest.mark.parametrize("size", [1e-320, 1e-200, 1e200, 1e300])
def test_sizes_near_the_ends_of_doubles_are_mapped(bowl, size):
    V, F = bowl
    assert taut.unwrap(V * size, F).certified


def test_columns_of_packed_records_are_read(bowl):
    V, F = bowl
    points = np.zeros(len(V), dtype=[("flag", "u1"), ("place", "f8", 3)])
    cells = np.zeros(len(F), dtype=[("v", "i4", 3), ("tag", "u2")])
    points["place"], cells["v"] = V, F
    assert points["place"].strides == (25, 8) and cells["v"].strides == (14, 4)
    wanted = taut.unwrap(V, F).uv
    assert (taut.unwrap(points["place"], cells["v"]).uv == wanted).all()
    assert taut.certify(cells["v"], wanted) and (taut.quality(points["place"], F, wanted)["flips"].elements == len(F))
