# SPDX-License-Identifier: MIT
"""Atlases and repair."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import torus_of

import taut


def signed_areas(uv, faces):
    a, b, c = (uv[faces[:, k]] for k in range(3))
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def test_an_atlas_keeps_triangles_and_lies_in_its_square(torus):
    V, F = torus
    made = taut.atlas(V, F)
    vmapping, faces, uv = made
    assert (vmapping[faces] == F).all()
    assert uv.min() >= 0 and uv.max() <= 1 and (signed_areas(uv, faces) > 0).all()
    assert made.charts == made.chart.max() + 1 and made.corner_uv.shape == (len(F), 3, 2)
    assert made.report["overlaps"] == 0 and made.complete


def test_bounds_change_the_number_of_charts(torus):
    assert taut.atlas(*torus, mean_distortion=4.001, max_distortion=4.01).charts > taut.atlas(*torus).charts


def test_several_meshes_get_one_atlas(torus, bowl):
    pair = taut.atlas([torus, bowl])
    boxes = []
    for made, (V, F) in zip(pair, (torus, bowl)):
        assert (made.vmapping[made.faces] == F).all()
        boxes.append(made.uv)
    assert len({tuple(p) for p in np.concatenate(boxes).round(12).tolist()}) == len(boxes[0]) + len(boxes[1])


def test_triangles_as_they_come_are_mended_and_what_is_left_out_keeps_its_place(torus):
    V, F = torus
    V = np.r_[V, [[np.nan, 0, 0]]]
    bad = np.r_[F, [[0, 0, 1], F[0], [0, 1, len(V) - 1]]]
    bad[5] = bad[5][[0, 2, 1]]
    made = taut.atlas(V, bad)
    assert (made.vmapping[made.faces] == bad).all() and made.repairs
    assert (made.chart[-3:] == -1).all() and (made.tile[-3:] == -1).all() and (made.chart[:-3] >= 0).all()
    assert (made.corner_uv[-3:] == 0).all()
    with pytest.raises(taut.ParameterError):
        taut.atlas(V, bad, repair=False)
    with pytest.raises(taut.MeshError):
        taut.atlas(V[:-1], bad[:-1], repair=False)


def test_seams_parts_and_kept_charts(torus):
    V, F = torus
    parts = (np.arange(len(F)) % len(F) * 4 // len(F)).astype(int)
    made = taut.atlas(V, F, parts=parts)
    for c in range(made.charts):
        assert len(set(parts[made.chart == c])) == 1
    again = taut.atlas(V, F, charts="keep", parts=made.chart, uv=made.corner_uv)
    assert again.charts == made.charts


def test_pinned_triangles_stay_bit_for_bit(torus):
    V, F = torus
    made = taut.atlas(V, F, prefer="packing")
    pinned = made.chart == 0
    again = taut.atlas(V, F, pinned=pinned, uv=made.corner_uv)
    assert (again.corner_uv[pinned] == made.corner_uv[pinned]).all()


def test_the_order_of_progress_is_that_of_stages():
    stages = []
    taut.atlas(*torus_of(80, 40), progress=lambda p: stages.append(p.stage))
    assert set(stages) <= {"charts", "flatten", "pack", "certify", ""}


def test_repair_says_what_it_did():
    V = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [9, 9, 9]]
    r = taut.repair(V, [[0, 1, 2], [0, 3, 2], [7, 1, 2]])
    assert r.F.tolist() == [[0, 1, 2], [0, 2, 3]] and r.vmap.tolist() == [0, 1, 2, 3] and r.fmap.tolist() == [0, 1]
    assert r.turned.tolist() == [1] and set(r.findings) == {
        "index_out_of_range", "unreferenced_vertex", "inconsistent_orientation"}
    with pytest.raises(taut.MeshError) as e:
        taut.repair(V, [[0, 0, 0]])
    assert e.value.notes


def test_options_that_are_wrong_name_their_field(torus):
    with pytest.raises(taut.ParameterError) as e:
        taut.atlas(*torus, padding=-1)
    assert e.value.field == "padding"
    with pytest.raises(taut.ParameterError) as e:
        taut.atlas(*torus, uv=np.zeros((3, 3, 2)))
    assert e.value.field == "uv"


def test_pages_have_given_density_shape_and_blocks(torus):
    V, F = torus
    made = taut.atlas(V, F, resolution=256, aspect=0.5, align=4, texels_per_unit=20, tiles=50, prefer="packing")
    uv, texels = made.uv, np.array([256, 128])
    plane = signed_areas((uv % 1) * texels, made.faces).sum()
    x = V[F]
    space = np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1).sum() / 2
    assert abs(np.sqrt(plane / space) / 20 - 1) < 0.02
    assert made.report["resolution"] == 256 and made.report["tiles"] == int(uv.max()) + 1
    packed = taut.atlas(V, F, uv=made.corner_uv % 1, parts=made.chart, charts="pack")
    assert packed.charts == made.charts


def test_densities_are_factors_of_lengths(torus):
    V, F = torus
    n = len(F)
    both = np.vstack([V, V + [10, 0, 0]]), np.vstack([F, F + len(V)])
    made = taut.atlas(*both, densities=[1] * n + [2] * n)
    area = np.abs(signed_areas(made.corner_uv.reshape(-1, 2), np.arange(6 * n).reshape(-1, 3)))
    assert np.isclose(area[n:].sum(), 4 * area[:n].sum(), rtol=0.05)
    with pytest.raises(taut.ParameterError, match="densities"):
        taut.atlas(*both, densities=[1, 2])


def test_copies_lie_on_each_other(torus):
    V, F = torus
    both = taut.atlas(np.vstack([V, V + [9, 0, 0]]), np.vstack([F, F + len(V)]), stack=True)
    a, b = both.corner_uv[: len(F)], both.corner_uv[len(F) :]
    assert both.report["stacked"] * 2 == both.charts
    assert {tuple(map(tuple, t)) for t in np.sort(a, axis=1)} == {tuple(map(tuple, t)) for t in np.sort(b, axis=1)}


def test_arguments_that_do_not_fit_are_named_as_they_are_in_python(torus):
    V, F = torus
    for wrong, field, says in (
        (dict(hide_seams=2), "hide_seams", "hide_seams: must be 0 to 1"),
        (dict(resolution=(512, 256)), "resolution", "must be one number"),
        (dict(padding="wide"), "padding", "padding: is 'wide', but must be a number"),
        (dict(symmetric="yes"), "symmetric", "must be True or False"),
        (dict(charts="pack"), "uv", 'charts="pack" packs charts as they lie in it'),
        (dict(pinned=np.zeros(len(F), bool)), "uv", "uv: is not given"),
        (dict(max_stretch=1.0), "max_stretch", "above 1"),
        (dict(max_stretch=1.1, mean_distortion=4.5), "max_stretch", "leave out"),
        (dict(seam_weights=[[0, len(V) // 2 + 3, 5.0]]), "seam_weights", "no edge joins"),
        (dict(seam_weights=[[F[0][0], F[0][1], 0]]), "seam_weights", "row 0 has the factor 0"),
    ):
        with pytest.raises(taut.ParameterError) as caught:
            taut.atlas(V, F, **wrong)
        assert caught.value.field == field and says in str(caught.value), str(caught.value)
        assert "parameter" not in str(caught.value)


def test_a_stretch_bounds_the_whole(torus):
    V, F = torus
    made = taut.atlas(V, F, max_stretch=1.01)
    assert 1 <= made.report["stretch_l2"] <= 1.01 and made.report["stretch_linf"] >= made.report["stretch_l2"]
    assert taut.atlas(V, F, max_stretch=1.2).charts <= made.charts


def test_seams_avoid_edges_that_weigh_much(torus):
    V, F = np.asarray(torus[0]), np.asarray(torus[1])
    ends = np.unique(np.sort(np.stack([F, np.roll(F, -1, 1)], 2).reshape(-1, 2), 1), axis=0)
    here = V[ends].mean(1)[:, 0] > 0

    def length_there(made):
        flat = made.vmapping[made.faces]
        sides = np.sort(np.stack([made.faces, np.roll(made.faces, -1, 1)], 2).reshape(-1, 2), 1)
        _, first, count = np.unique(sides, axis=0, return_index=True, return_counts=True)
        cut = np.stack([flat, np.roll(flat, -1, 1)], 2).reshape(-1, 2)[first[count == 1]]
        p = V[cut]
        return np.linalg.norm(p[:, 0] - p[:, 1], axis=1)[p[:, :, 0].mean(1) > 0].sum()

    heavy = taut.atlas(V, F, seam_weights=np.c_[ends, np.where(here, 50.0, 1.0)])
    light = taut.atlas(V, F, seam_weights=np.c_[ends, np.where(here, 1.0, 50.0)])
    assert length_there(heavy) < length_there(light)


def test_copies_at_one_place_are_meshes_of_their_own(bowl):
    V, F = bowl
    made = taut.atlas([(V, F), (V, F), (V + [0, 0, 9], F)])
    areas = [np.abs(np.linalg.det(np.c_[m.corner_uv, np.ones((len(F), 3, 1))])) for m in made]
    assert all((a > 0).all() for a in areas) and (made[0].chart.min() >= 0) and len({m.chart[0] for m in made}) == 3


def test_arguments_of_an_atlas_that_would_have_no_effect_are_refused(bowl):
    V, F = bowl
    uv, m = V[:, :2], len(F)
    for field, given in [("parts", {"parts": np.zeros(m)}), ("polygons", {"polygons": np.zeros(m)}), ("uv", {"uv": uv}),
                         ("densities", {"densities": np.ones(m)}), ("charts", {"charts": "keep"})]:
        with pytest.raises(taut.ParameterError) as e:
            taut.atlas([(V, F)], **given)
        assert e.value.field == field
    for field, given in [("uv", {"uv": uv}), ("weld", {"weld": True, "repair": False}), ("least_fill", {"least_fill": 0.5}),
                         ("prefer", {"charts": "pack", "uv": uv, "prefer": "one"}),
                         ("prefer", {"charts": "keep", "prefer": "packing"}),
                         ("mean_distortion", {"charts": "pack", "uv": uv, "mean_distortion": 4.1}),
                         ("hide_seams", {"charts": "keep", "hide_seams": 1}),
                         ("symmetric", {"charts": "keep", "symmetric": True}),
                         ("parts", {"parts": np.full(m, 0.5)}), ("polygons", {"polygons": np.full(m, 2.0**40)})]:
        with pytest.raises(taut.ParameterError) as e:
            taut.atlas(V, F, **given)
        assert e.value.field == field
