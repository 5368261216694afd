# SPDX-License-Identifier: MIT
"""Drivers that came by pip."""

from __future__ import annotations

import importlib.metadata
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import pytest

import taut
from taut import _drivers


def driver():
    """A driver of this machine, by its path or name."""
    for icd in sorted(pathlib.Path("/etc/OpenCL/vendors").glob("*.icd")):
        return icd.read_text().strip()
    pytest.skip("drivers are not registered in /etc/OpenCL/vendors")


CALLS = """
import sys, taut
from taut import _drivers
_drivers._INTEL = (sys.argv[1], "libintelocl.so")
print(taut.certify([[0, 1, 2]], [[0, 0], [1, 0], [0, 1]]).elements)
opencl = [d for d in taut.devices() if d.kind != "host"]
if opencl:
    print(taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], device=opencl[0].name).certified, opencl[0].driver)
else:
    print(_drivers.left_out)
"""


def start(tmp_path, *packages, before=(), intel="not-installed", **environment):
    """Calls where the system's drivers are hidden, and those of packages can be found. intel: its distribution."""
    (tmp_path / "empty").mkdir(exist_ok=True)
    path = os.pathsep.join([str(pathlib.Path(taut.__file__).parents[1]), *map(str, packages)])
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("OCL_ICD", "TAUT_DEVICE"))}
    return subprocess.Popen([*before, sys.executable, "-c", CALLS, intel], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True,
                            env={**kept, "PYTHONPATH": path, "OCL_ICD_VENDORS": str(tmp_path / "empty"), **environment})


def end(process):
    """What calls have said."""
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    if "older than this processor" in out:
        pytest.skip("PoCL as pip has it does not know this processor")
    return out.splitlines()


def said(*where, **more):
    return end(start(*where, **more))


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
    count, sentence = said(tmp_path, package_with(tmp_path, driver()), PATH=str(tmp_path))
    assert count == "1"
    assert all(words in sentence for words in ("`ld`", "apt install gcc", "conda install"))


def hidden_system():
    """A command by which another one does not see the system's drivers even where it looks for them, if that may be."""
    hide = "mount -t tmpfs none /etc/OpenCL && unset OCL_ICD_VENDORS && exec \"$@\""
    apart = ["unshare", "--mount", "--map-root-user", "sh", "-c", hide, "sh"]
    return apart if subprocess.run([*apart, "true"], capture_output=True, check=False).returncode == 0 else []


def test_the_driver_of_the_extra_serves_alone_and_compiles_once(tmp_path):
    """Intel's runtime for CPUs, in two processes at a time, and in a third that compiles nothing."""
    try:
        version = importlib.metadata.version("intel-opencl-rt")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("intel-opencl-rt is not installed")
    programs = tmp_path / "programs"
    more = {"before": hidden_system(), "intel": "intel-opencl-rt", "TAUT_CACHE_DIR": str(programs)}
    kept = lambda: {(file.name, file.stat().st_ino) for file in programs.iterdir()}
    for count, found in [end(process) for process in [start(tmp_path, **more), start(tmp_path, **more)]]:
        assert count == "1" and found.startswith(f"True {version[:4]}.")
    first = kept()
    assert first and said(tmp_path, **more)[1].startswith("True ") and kept() == first


def test_intels_runtime_is_found_where_its_wheel_has_put_it_and_goes_first(tmp_path, monkeypatch):
    site = tmp_path / "lib" / "python3" / "site-packages"
    record = site / "intel_opencl_rt-1.dist-info" / "RECORD"
    record.parent.mkdir(parents=True)
    record.write_text("../../libintelocl.so,,\n../../cl.cfg,,\nintel_opencl_rt-1.dist-info/RECORD,,\n")
    (record.parent / "METADATA").write_text("Metadata-Version: 2.1\nName: intel-opencl-rt\nVersion: 1\n")
    monkeypatch.syspath_prepend(str(site))
    monkeypatch.setattr(_drivers, "_drivers_of_packages", lambda: ["pocl.so"])
    monkeypatch.setattr(_drivers, "_can_link", lambda: True)
    assert _drivers.drivers_by_pip() == ["pocl.so"]
    (tmp_path / "lib" / "libintelocl.so").write_text("")
    assert _drivers.drivers_by_pip() == [str(tmp_path / "lib" / "libintelocl.so")]


def test_pocl_as_pip_has_it_serves_alone(tmp_path):
    site = pathlib.Path(pytest.importorskip("pocl_binary_distribution").__file__).parents[1]
    (tmp_path / "site").mkdir()
    for name in ("pocl_binary_distribution", "pyopencl"):
        (tmp_path / "site" / name).symlink_to(site / name)
    (tmp_path / "cache").mkdir()
    count, found = said(tmp_path, tmp_path / "site", before=hidden_system(), POCL_CACHE_DIR=str(tmp_path / "cache"))
    assert count == "1" and found == "True 3.0-rc2"


def test_drivers_are_named_by_their_paths_and_in_no_folder(tmp_path, monkeypatch):
    """Anyone may write into the folder of temporary files, and could name a driver of his own there."""
    for name in ("TMPDIR", "TEMP", "TMP"):
        monkeypatch.setenv(name, str(tmp_path))
    for name in ("OCL_ICD_FILENAMES", "OCL_ICD_VENDORS"):
        monkeypatch.setenv(name, "")
    monkeypatch.setattr(tempfile, "tempdir", None)
    monkeypatch.setattr(_drivers, "_SYSTEM", tmp_path / "nowhere")
    monkeypatch.setattr(_drivers, "drivers_by_pip", lambda: ["/opt/one.so", "/opt/other.so"])
    _drivers.announce()
    assert os.environ["OCL_ICD_FILENAMES"] == os.environ["OCL_ICD_VENDORS"] == "/opt/one.so"
    assert not list(tmp_path.iterdir())


def test_libraries_beside_their_file_are_named_by_their_path(tmp_path, monkeypatch):
    package = tmp_path / "own_driver"
    (package / ".libs").mkdir(parents=True)
    (package / ".libs" / "own.icd").write_text("libown.so\n")
    (package / ".libs" / "libown.so").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(_drivers, "_PACKAGES", ("own_driver",))
    assert _drivers._drivers_of_packages() == [str(package / ".libs" / "libown.so")]


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
