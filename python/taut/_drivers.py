# SPDX-License-Identifier: MIT
"""OpenCL drivers that came by pip are told to the loader of drivers, beside those of the system."""

from __future__ import annotations

import glob
import importlib.util
import os
import tempfile
from pathlib import Path

_SYSTEM = Path("/etc/OpenCL/vendors")


def _pip_icds() -> list[Path]:
    """Files that name drivers, of packages that are installed beside this one."""
    found: list[Path] = []
    for package, pattern in (("pocl_binary_distribution", "**/*.icd"), ("pyopencl", ".libs/*.icd")):
        spec = importlib.util.find_spec(package)
        for folder in (spec.submodule_search_locations or []) if spec else []:
            found += [Path(p) for p in glob.glob(str(Path(folder) / pattern), recursive=True, include_hidden=True)] \
                if _has_hidden() else [Path(p) for p in glob.glob(str(Path(folder) / pattern), recursive=True)]
    return found


def _has_hidden() -> bool:
    import sys

    return sys.version_info >= (3, 11)


def announce() -> None:
    """Sets what loaders read, unless the user has.

    A driver by pip is used where the system has none: two drivers of one kind in a process do not go well together.
    """
    if os.environ.get("OCL_ICD_VENDORS") or os.environ.get("OCL_ICD_FILENAMES"):
        return
    if any(_SYSTEM.glob("*.icd")):
        return
    icds = _pip_icds()
    if not icds:
        return
    libraries = [text for icd in icds for text in icd.read_text().split()]
    os.environ["OCL_ICD_FILENAMES"] = os.pathsep.join(libraries)
    # Another loader takes a folder.
    folder = Path(tempfile.mkdtemp(prefix="taut-icd-"))
    for k, library in enumerate(libraries):
        (folder / f"{k}.icd").write_text(library + "\n")
    os.environ["OCL_ICD_VENDORS"] = str(folder)
