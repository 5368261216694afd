# SPDX-License-Identifier: MIT
"""The programs of examples/python, and the one of the README."""

from __future__ import annotations

import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import bowl_of, torus_of

import taut

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples" / "python"


def write_obj(path, V, F):
    path.write_text("".join(f"v {x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in V)
                    + "".join(f"f {a} {b} {c}\n" for a, b, c in F + 1))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("surfaces")
    write_obj(folder / "bowl.obj", *bowl_of(10))
    write_obj(folder / "torus.obj", *torus_of(16, 8))
    return folder


def last_line(*command):
    package = pathlib.Path(taut.__file__).parents[1]
    done = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, timeout=300,
                          env={**os.environ, "PYTHONPATH": str(package)})
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().splitlines()[-1]


@pytest.mark.parametrize("surface, words", [("bowl", r"one chart, E 4\.\d+, certified"),
                                            ("torus", r"\d+ charts, E 4\.\d+, 0 overlaps")])
def test_unwrap(folder, tmp_path, surface, words):
    assert re.fullmatch(words, last_line(EXAMPLES / "unwrap.py", folder / f"{surface}.obj", tmp_path / "out.obj"))
    assert taut.read(tmp_path / "out.obj").corner_uv is not None


@pytest.mark.parametrize("name, words", [
    ("own_energy", r"slider 2: E \d+\.\d+, \d+ iterations"),
    ("drag", r"E 4\.\d+, converged, pins exact"),
    ("newton", r"E 4\.\d+, as unwrap has it"),
])
def test_programs_without_arguments(name, words):
    if name == "newton":
        pytest.importorskip("scipy")
    assert re.fullmatch(words, last_line(EXAMPLES / f"{name}.py"))


def test_many(folder, tmp_path):
    (folder / "bad.obj").write_text("v 0 0 0\n")
    assert re.match(r"(bowl|torus|bad)\.obj: ", last_line(EXAMPLES / "many.py", folder, tmp_path / "out"))
    assert {p.name for p in (tmp_path / "out").glob("*.obj")} == {"bowl.obj", "torus.obj"}


@pytest.mark.parametrize("name", ["ray", "dask"])
def test_many_on_a_cluster(folder, tmp_path, name):
    pytest.importorskip({"ray": "ray", "dask": "distributed"}[name])
    (folder / "bad.obj").write_text("v 0 0 0\n")
    assert re.match(r"(bowl|torus|bad)\.obj: ", last_line(EXAMPLES / f"many_{name}.py", folder, tmp_path / "out"))
    assert {p.name for p in (tmp_path / "out").glob("*.obj")} == {"bowl.obj", "torus.obj"}


def test_the_program_of_the_readme(folder, tmp_path, monkeypatch):
    text = (ROOT / "README.md").read_text()
    program = re.search(r"```python\n(.*?)```", text, re.S)[1]
    monkeypatch.chdir(tmp_path)
    write_obj(tmp_path / "surface.obj", *bowl_of(10))
    exec(compile(program, "README.md", "exec"), {})
    assert np.isfinite(taut.read("flat.obj").corner_uv).all()


