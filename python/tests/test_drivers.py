# SPDX-License-Identifier: MIT
"""Drivers that came by pip."""

from __future__ import annotations

import os
import pathlib
import re
import subprocess
import sys

import pytest

import taut
from taut import _drivers


def driver():
    """A driver of this machine, by its path or name."""
    for icd in sorted(pathlib.Path("/etc/OpenCL/vendors").glob("*.icd")):
        return icd.read_text().strip()
    pytest.skip("drivers are not registered in /etc/OpenCL/vendors")


def test_a_driver_by_pip_is_found_where_the_system_has_none(tmp_path):
    package = tmp_path / "site" / "pocl_binary_distribution"
    (package / ".libs").mkdir(parents=True)
    (package / "__init__.py").write_text("")
    (package / ".libs" / "some.icd").write_text(driver() + "\n")
    code = f"""
import pathlib, sys
sys.path.append({str(tmp_path / "site")!r})
import taut, taut._drivers
taut._drivers._SYSTEM = pathlib.Path({str(tmp_path / "none")!r})
print(taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).certified)
import os
print(os.environ["OCL_ICD_VENDORS"] != "")
"""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("OCL_ICD")}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120,
                          env={**environment, "PYTHONPATH": str(pathlib.Path(taut.__file__).parents[1])})
    assert done.stdout.split() == ["True", "True"], done.stderr


def test_libraries_beside_their_file_are_named_by_their_path(tmp_path, monkeypatch):
    package = tmp_path / "pyopencl"
    (package / ".libs").mkdir(parents=True)
    (package / ".libs" / "own.icd").write_text("libown.so\n")
    (package / ".libs" / "libown.so").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(_drivers, "_PACKAGES", ("pyopencl",))
    assert _drivers.drivers_by_pip() == [str(package / ".libs" / "libown.so")]


def test_what_the_user_has_set_stays(monkeypatch):
    monkeypatch.setenv("OCL_ICD_VENDORS", "/mine")
    monkeypatch.setattr(_drivers, "_SYSTEM", pathlib.Path("/nowhere"))
    _drivers.announce()
    assert os.environ["OCL_ICD_VENDORS"] == "/mine" and "OCL_ICD_FILENAMES" not in os.environ


def test_wheels_have_the_version_of_the_headers():
    tomllib = pytest.importorskip("tomllib")
    version_of = pytest.importorskip("packaging.version").Version
    root = pathlib.Path(__file__).resolve().parents[2]
    provider = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["scikit-build"]["metadata"]["version"]
    header = (root / provider["input"]).read_text()
    stated = re.search(r'TAUT_VERSION_STRING "([^"]+)"', header)[1]
    found = re.search(provider["regex"], header)
    assert found and version_of(found["value"]) == version_of(stated) == version_of(taut.__version__)
