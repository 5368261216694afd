# SPDX-License-Identifier: MIT
"""OpenCL drivers that came by pip are told to the loader of drivers, where the system has none."""

from __future__ import annotations

import importlib.util
import os
import tempfile
from pathlib import Path

_SYSTEM = Path("/etc/OpenCL/vendors")
_PACKAGES = ("pocl_binary_distribution", "pyopencl")


def drivers_by_pip() -> list[str]:
    """Libraries of drivers in packages that are installed beside this one."""
    found: list[str] = []
    for package in _PACKAGES:
        spec = importlib.util.find_spec(package)
        for place in (spec.submodule_search_locations or []) if spec else []:
            for icd in sorted(Path(place).rglob("*.icd")):
                name = icd.read_text().strip()
                beside = icd.parent / name
                found.append(str(beside) if beside.exists() else name)
    return found


def announce() -> None:
    """Sets what loaders read, unless the user has set it or the system has drivers.

    Two drivers of one kind in a process do not go well together, so those of the system go first.
    """
    if os.environ.get("OCL_ICD_VENDORS") or os.environ.get("OCL_ICD_FILENAMES") or any(_SYSTEM.glob("*.icd")):
        return
    libraries = drivers_by_pip()
    if not libraries:
        return
    # One loader takes a list, another a folder.
    os.environ["OCL_ICD_FILENAMES"] = os.pathsep.join(libraries)
    folder = Path(tempfile.gettempdir()) / f"taut-drivers-{os.getuid() if hasattr(os, 'getuid') else 0}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        if folder.stat().st_uid != os.getuid():
            raise OSError
    except OSError:
        folder = Path(tempfile.mkdtemp(prefix="taut-drivers-"))
    for k, library in enumerate(libraries):
        (folder / f"{k}.icd").write_text(library + "\n")
    os.environ["OCL_ICD_VENDORS"] = str(folder)
