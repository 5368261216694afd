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


CALLS = """
import taut
print(taut.certify([[0, 1, 2]], [[0, 0], [1, 0], [0, 1]]).elements)
try:
    print(taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).certified, taut.devices()[0].driver)
except taut.DeviceError as e:
    print(str(e).splitlines()[0], e.remedy in str(e), sep="\\n")
"""


def said(tmp_path, *packages, before=(), **environment):
    """What the calls say where the system's drivers are hidden, and those of packages can be found."""
    (tmp_path / "empty").mkdir(exist_ok=True)
    path = os.pathsep.join([str(pathlib.Path(taut.__file__).parents[1]), *map(str, packages)])
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("OCL_ICD", "POCL_CACHE", "TAUT_DEVICE"))}
    done = subprocess.run([*before, sys.executable, "-c", CALLS], capture_output=True, text=True, timeout=120,
                          env={**kept, "PYTHONPATH": path, "POCL_CACHE_DIR": os.environ.get("POCL_CACHE_DIR", ""),
                               "OCL_ICD_VENDORS": str(tmp_path / "empty"), **environment})
    assert done.returncode == 0, done.stderr
    if "older than this processor" in done.stdout:
        pytest.skip("PoCL as pip has it does not know this processor")
    return done.stdout.splitlines()


def package_with(tmp_path, library):
    """A folder with a package that has a driver, as pip lays it out."""
    libraries = tmp_path / "site" / "pocl_binary_distribution" / ".libs"
    libraries.mkdir(parents=True)
    (libraries.parent / "__init__.py").write_text("")
    (libraries / "some.icd").write_text(library + "\n")
    return tmp_path / "site"


def test_a_driver_by_pip_is_found_where_the_system_has_none(tmp_path):
    count, found = said(tmp_path, package_with(tmp_path, driver()))
    assert count == "1" and found.startswith("True ")


def test_a_driver_by_pip_that_could_not_link_is_left_out_in_a_sentence(tmp_path):
    count, sentence, told = said(tmp_path, package_with(tmp_path, driver()), PATH=str(tmp_path))
    assert count == "1" and told == "True"
    assert all(words in sentence for words in ("`ld`", "apt install gcc", "conda install"))


def test_the_driver_of_the_extra_serves_alone(tmp_path):
    """PoCL as pip has it, with the system's drivers out of sight: in a space of names of its own where that may be."""
    site = pathlib.Path(pytest.importorskip("pocl_binary_distribution").__file__).parents[1]
    (tmp_path / "site").mkdir()
    for name in ("pocl_binary_distribution", "pyopencl"):
        (tmp_path / "site" / name).symlink_to(site / name)
    hide = "mount -t tmpfs none /etc/OpenCL && unset OCL_ICD_VENDORS && exec \"$@\""
    apart = ["unshare", "--mount", "--map-root-user", "sh", "-c", hide, "sh"]
    possible = subprocess.run([*apart, "true"], capture_output=True, check=False).returncode == 0
    (tmp_path / "cache").mkdir()
    count, found = said(tmp_path, tmp_path / "site", before=apart if possible else [],
                        POCL_CACHE_DIR=str(tmp_path / "cache"))
    assert count == "1" and found == "True 3.0-rc2"


def test_folders_of_other_drivers_are_others():
    one, two = _drivers._folder_of(["one.so"]), _drivers._folder_of(["one.so", "two.so"])
    assert one == _drivers._folder_of(["one.so"]) != two
    assert [p.read_text() for p in one.glob("*.icd")] == ["one.so\n"] and len(list(two.glob("*.icd"))) == 2


def test_without_a_loader_the_first_call_says_what_to_install():
    e = taut.DeviceError("libOpenCL.so.1: cannot open shared object file: No such file or directory")
    assert "apt install ocl-icd-libopencl1" in e.remedy and e.remedy in str(e).splitlines()[0]


def test_libraries_beside_their_file_are_named_by_their_path(tmp_path, monkeypatch):
    package = tmp_path / "own_driver"
    (package / ".libs").mkdir(parents=True)
    (package / ".libs" / "own.icd").write_text("libown.so\n")
    (package / ".libs" / "libown.so").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(_drivers, "_PACKAGES", ("own_driver",))
    assert _drivers.drivers_by_pip() == [str(package / ".libs" / "libown.so")]


def test_what_the_user_has_set_stays(monkeypatch):
    monkeypatch.setenv("OCL_ICD_VENDORS", "/mine")
    monkeypatch.setattr(_drivers, "_SYSTEM", pathlib.Path("/nowhere"))
    _drivers.announce()
    assert os.environ["OCL_ICD_VENDORS"] == "/mine" and "OCL_ICD_FILENAMES" not in os.environ


def test_a_folder_of_the_user_with_drivers_stays(monkeypatch, tmp_path):
    (tmp_path / "mine.icd").write_text("libmine.so\n")
    monkeypatch.setenv("OCL_ICD_VENDORS", str(tmp_path))
    monkeypatch.setattr(_drivers, "drivers_by_pip", lambda: ["other.so"])
    _drivers.announce()
    assert os.environ["OCL_ICD_VENDORS"] == str(tmp_path) and "OCL_ICD_FILENAMES" not in os.environ


def test_wheels_have_the_version_of_the_headers():
    tomllib = pytest.importorskip("tomllib")
    version_of = pytest.importorskip("packaging.version").Version
    root = pathlib.Path(__file__).resolve().parents[2]
    provider = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["scikit-build"]["metadata"]["version"]
    header = (root / provider["input"]).read_text()
    stated = re.search(r'TAUT_VERSION_STRING "([^"]+)"', header)[1]
    found = re.search(provider["regex"], header)
    assert found and version_of(found["value"]) == version_of(stated) == version_of(taut.__version__)
