# SPDX-License-Identifier: MIT
"""OpenCL drivers that came by pip are told to the loader of drivers, where the system has none."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import shutil
from pathlib import Path

_SYSTEM = Path("/etc/OpenCL/vendors")
_INTEL = ("intel-opencl-rt", "libintelocl.so")
_PACKAGES = ("pocl_binary_distribution", "pyopencl")

#: Where the compiler inside PoCL looks for the library that it links kernels with.
_LIBGCC = ("usr/lib/gcc/*/*/libgcc.a", "usr/lib64/gcc/*/*/libgcc.a", "usr/lib32/gcc/*/*/libgcc.a")

#: Why drivers of pip are left out, where they are.
left_out = ""

REMEDY = (
    "install an OpenCL driver: `pip install taut[opencl]` (any x86-64 CPU), `apt install pocl-opencl-icd`, "
    "or `conda install -c conda-forge pocl`"
)


def remedy() -> str:
    """What to install where there is no device."""
    return left_out or REMEDY


def _has_drivers(vendors: str | None) -> bool:
    """Whether the loader finds drivers there; None: where it looks without being told."""
    place = Path(vendors) if vendors else _SYSTEM
    return any(place.glob("*.icd")) if place.is_dir() or not vendors else True


def _can_link(root: Path = Path("/")) -> bool:
    """Whether PoCL as pip has it can link kernels: it ends the program where it cannot."""
    return shutil.which("ld") is not None and any(any(root.glob(pattern)) for pattern in _LIBGCC)


def _runtime_of_intel() -> list[str]:
    """Intel's runtime for CPUs, which wheels put beside the interpreter's libraries, outside of any package."""
    distribution, library = _INTEL
    try:
        files = importlib.metadata.files(distribution) or []
    except importlib.metadata.PackageNotFoundError:
        return []
    found = [os.path.realpath(file.locate()) for file in files if file.name == library]
    return [path for path in found if os.path.exists(path)]


def _drivers_of_packages() -> list[str]:
    """Libraries of drivers inside packages that are installed beside this one: PoCL."""
    found: list[str] = []
    for package in _PACKAGES:
        spec = importlib.util.find_spec(package)
        for place in (spec.submodule_search_locations or []) if spec else []:
            for icd in sorted(Path(place).rglob("*.icd")):
                name = icd.read_text().strip()
                beside = icd.parent / name
                found.append(str(beside) if beside.exists() else name)
    return found


def drivers_by_pip() -> list[str]:
    """Libraries of drivers that pip has brought: of one kind, as two do not go well together in a process."""
    global left_out
    if libraries := _runtime_of_intel():
        return libraries
    if (libraries := _drivers_of_packages()) and not _can_link():
        left_out = (
            "PoCL as pip has it needs the linker `ld` and libgcc: `apt install gcc`, or take another OpenCL driver: "
            "`pip install taut[opencl]`, `apt install pocl-opencl-icd`, or `conda install -c conda-forge pocl`"
        )
        return []
    return libraries


def announce() -> None:
    """Sets what loaders read, unless the user has named drivers or the system has some, which go first.

    A folder of the user's without drivers hides those of the system, and not these.
    """
    if os.environ.get("OCL_ICD_FILENAMES") or _has_drivers(os.environ.get("OCL_ICD_VENDORS")):
        return
    if libraries := drivers_by_pip():
        # One loader takes a list, another one library by its path; neither looks into a folder that others may write.
        os.environ["OCL_ICD_FILENAMES"] = os.environ["OCL_ICD_VENDORS"] = libraries[0]
