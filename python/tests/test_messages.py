# SPDX-License-Identifier: MIT
"""What calls say of arguments that cannot be right: the argument by its name in Python, in one sentence."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import bowl_of

import taut

V, F = bowl_of(4)
RAGGED = [[0, 1, 2], [0, 1]]
TETRAHEDRON = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]], [[0, 1, 2, 3]]


@pytest.mark.parametrize(
    "call, field, words",
    [
        (lambda: taut.unwrap("surface.obj", F), "V", ["taut.read()"]),
        (lambda: taut.unwrap(V, F, parameters="a"), "parameters", ["'a'"]),
        (lambda: taut.unwrap(V, F, tolerance=-1), "tolerance", ["[0, 1)"]),
        (lambda: taut.unwrap(V, F, iterations=-3), "iterations", ["negative"]),
        (lambda: taut.unwrap(V, F, time_limit=float("nan")), "time_limit", ["nan"]),
        (lambda: taut.unwrap(V, F, weights=-np.ones(len(F))), "weights", ["cell 0", "positive"]),
        (lambda: taut.Evaluator(V, F, weights=-np.ones(len(F))), "weights", ["cell 0", "positive"]),
        (lambda: taut.atlas(V, F, time_limit=-1), "time_limit", ["-1"]),
        (lambda: taut.atlas(V, F, seams=[[0, 1], [0, 24]]), "seams", ["row 1", "0 and 24", "no edge"]),
        (lambda: taut.atlas(V), "F", ["is not given", "pairs"]),
        (lambda: taut.atlas([(V, F), V]), "mesh 1", ["pair"]),
        (lambda: taut.deform(*TETRAHEDRON, slides=([1], [[0, 0, 0]])), "slides", ["row 0", "zeros"]),
        (lambda: taut.paste(V, (V, F), 0, at=0, radius=1), "target", ["pair"]),
        (lambda: taut.paste((V, F), (V, F), [1, 2], at=0, radius=1), "onto", ["(2,)", "one vertex"]),
        (lambda: taut.paste((V, F), (V, F), 1, at=0, radius="wide"), "radius", ["'wide'"]),
        (lambda: taut.repair(V, F, weld=-1), "weld", ["0 or more"]),
        (lambda: taut.repair(V, F, weld="x"), "weld", ["'x'", "number"]),
        (lambda: taut.start(3), "function", ["3"]),
        (lambda: taut.Session(V, F).solve(steps=2.5), "steps", ["2.5", "whole"]),
        (lambda: taut.Session(V, F).solve(steps=-1), "steps", ["-1"]),
        (lambda: taut.Session(V, F).solve(time="x"), "time", ["'x'"]),
        (lambda: taut.Session(V, F).solve(progress=3), "progress", ["3"]),
        (lambda: taut.Session(V, F).pin_u(0, "x"), "u", ["'x'"]),
        (lambda: taut.Session(V, F).spring(0, [0, 0], None), "weight", ["None"]),
        (lambda: taut.Session(V, F).restore(3), "snapshot", ["3"]),
        (lambda: taut.Session(V, F, kind=np.zeros(2)), "kind", ["volume"]),
        (lambda: taut.Session(V, RAGGED), "C", ["row 1 has 2"]),
        (lambda: taut.Session(V, F).release(RAGGED), "vs", ["no numbers"]),
        (lambda: taut.Session(V, F).pin(RAGGED, [0, 0]), "v", ["row 1 has 2"]),
        (lambda: taut.Session(V, F, kind="shell", parameters=RAGGED), "parameters", ["no effect"]),
        (lambda: taut.certify(RAGGED, V), "C", ["row 1 has 2"]),
        (lambda: taut.atlas(V, F, uv=RAGGED, charts="pack"), "uv", ["row 1 has 2"]),
        (lambda: taut.paste((V, F), (V, F), RAGGED, at=0, radius=1), "onto", ["row 1 has 2"]),
        (lambda: taut.paste((V, F), (V, F), 1, at=np.ma.masked, radius=1), "at", ["masked"]),
        (lambda: taut.paste((V, F), (V, F), 1, at=0, radius=np.ma.masked), "radius", ["number"]),
        (lambda: taut.pack(V[:, :2], F, tiles=np.ma.masked), "tiles", ["whole number"]),
        (lambda: taut.untangle(np.full((4, 3), np.nan), [[0, 1, 2, 3]]), "X", ["row 0", "nan"]),
        (lambda: taut.untangle(V, F), "X", ["taut.shell"]),
        (lambda: taut.deform(V[:, :2], [{}]), "C", ["no numbers"]),
        (lambda: taut.deform(V[:, :2], F, energy=lambda: 0), "energy", ["one argument"]),
        (lambda: taut.deform([[0, 0, 1], [1, 0, 1], [0, 1, 1]], [[0, 1, 2]], initial=RAGGED), "initial", ["row 1 has 2"]),
        (lambda: taut.energies.isometric.value(np.eye(2), parameters=RAGGED), "parameters", ["row 1 has 2"]),
        (lambda: taut.check_gradient("shape", attributes=RAGGED), "attributes", ["row 1 has 2"]),
    ],
)
def test_the_argument_is_named_as_python_has_it(call, field, words):
    with pytest.raises(taut.ParameterError) as e:
        call()
    assert e.value.field == field and str(e.value).startswith(f"{field}: ")
    assert all(word in str(e.value) for word in words), str(e.value)


@pytest.mark.parametrize("made, told", [(lambda s: None, "None"), (lambda s: "1", "a str"), (lambda s: s.J > 1, "a SymBool"),
                                        (lambda s: s.S, "an array of the shape .2, 2."), (lambda s: True, "a bool")])
def test_an_energy_without_a_value_is_told(made, told):
    with pytest.raises(taut.TraceError, match=f"returns {told}; return a value"):
        taut.unwrap(V, F, energy=made)


def test_surfaces_that_are_no_disk_get_the_option_that_helps(torus):
    with pytest.raises(taut.MeshError, match="cut=True.*taut.atlas") as e:
        taut.unwrap(*torus)
    assert e.value.fault == "closed_surface"
    tube = torus[1][np.arange(576) % 288 < 240]  # open at both ends
    with pytest.raises(taut.MeshError, match="holes=True"):
        taut.unwrap(torus[0], tube)


def test_frames_cannot_be_made_writable():
    frame = taut.Session(V, F).solve()
    with pytest.raises(ValueError):
        frame.x.setflags(write=True)
    assert frame.x.dtype == np.float64 and frame.x.flags.c_contiguous and not frame.x.flags.owndata


def test_a_session_shows_a_line(capsys):
    assert taut.Session(V, F).solve(progress=True).converged
    assert capsys.readouterr().err.endswith("\r\x1b[K")
