# SPDX-License-Identifier: MIT
"""The tests of the package xatlas itself on taut.compat.xatlas: of its source distribution, which pip downloads.

Counts are those of xatlas, so they are left out: how many vertices and charts an atlas has. Skipped where pip cannot
download. Those that make atlases take a minute each: they run where the environment has TAUT_LONG_TESTS."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
import tarfile

import pytest

import taut

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "build" / "xatlas"
NAME = "xatlas-0.0.11"
COUNTS = {"18996": "vmapping.shape[0]", "chart_count == 70": "chart_count > 0"}


@pytest.fixture(scope="module")
def its_tests(tmp_path_factory):
    """A folder with its tests, in which `import xatlas` is that of taut."""
    pytest.importorskip("trimesh")
    archive = FOLDER / f"{NAME}.tar.gz"
    if not archive.exists():
        words = ["download", "-q", "--disable-pip-version-check", "--no-deps", "--no-binary", "xatlas", "-d", str(FOLDER)]
        try:
            subprocess.run([sys.executable, "-m", "pip", *words, NAME.replace("-", "==")], check=True,
                           capture_output=True, timeout=240)
        except (subprocess.SubprocessError, OSError):
            pytest.skip("pip cannot download the source of xatlas")
    folder = tmp_path_factory.mktemp("xatlas")
    with tarfile.open(archive) as tar:
        members = [m for m in tar.getmembers() if m.name.startswith(f"{NAME}/tests/") and ".." not in m.name]
        tar.extractall(folder, members)
    folder = folder / NAME / "tests"
    for file in folder.glob("test_*.py"):
        text = file.read_text()
        for theirs, ours in COUNTS.items():
            text = text.replace(theirs, ours)
        file.write_text(text)
    (folder / "conftest.py").write_text('import sys, taut.compat.xatlas\nsys.modules["xatlas"] = taut.compat.xatlas\n')
    return folder


@pytest.mark.parametrize("name, long", [("test_atlas.py::test_add_mesh", False), ("test_atlas.py::test_generate", True),
                                        ("test_atlas.py::test_get_mesh", True),
                                        ("test_functions.py::test_parametrize", True)])
def test_its_own_tests_pass_but_for_counts(its_tests, name, long):
    if long and not os.environ.get("TAUT_LONG_TESTS"):
        pytest.skip("takes a minute; set TAUT_LONG_TESTS")
    package = pathlib.Path(taut.__file__).parents[1]
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir=.", name],
                          cwd=its_tests, capture_output=True, text=True, timeout=600,
                          env={**os.environ, "PYTHONPATH": str(package)})
    assert done.returncode == 0, done.stdout
