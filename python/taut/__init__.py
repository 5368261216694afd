# SPDX-License-Identifier: MIT
"""Maps of triangle and tetrahedral meshes that never fold, with low distortion, on GPUs and processors.

>>> import numpy as np, taut
>>> V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
>>> uv, report = taut.unwrap(V, [[0, 1, 2], [0, 2, 3]])
>>> uv.shape
(4, 2)
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from . import energies
from ._atlas import atlas
from ._bake import bake
from ._evaluator import Evaluator
from ._files import Mesh, devices, read, write
from ._jobs import Job, start
from ._maps import certify, distortion, quality, unwrap
from ._packing import pack
from ._paste import paste
from ._repair import repair
from ._results import Atlas, Certificate, Device, Frame, Map, Packed, Pasted, Repaired
from ._session import Session
from ._trace import Element, Energy, check_gradient, energy, where
from ._volumes import deform, shell, smooth, untangle
from .errors import (
    Cancelled,
    ConstraintError,
    DeviceError,
    FileError,
    Infeasible,
    Interrupted,
    MeshError,
    NoMap,
    ParameterError,
    TautError,
    TraceError,
)

__all__ = [
    "Atlas", "Cancelled", "Certificate", "ConstraintError", "Device", "DeviceError", "Element", "Energy", "Evaluator",
    "FileError", "Frame", "Infeasible", "Interrupted", "Job", "Map", "Mesh", "MeshError", "NoMap", "ParameterError",
    "Packed", "Pasted", "Repaired", "Session", "TautError", "TraceError", "atlas", "bake", "certify", "check_gradient", "deform",
    "devices", "distortion", "energies", "energy", "pack", "paste", "quality", "read", "repair", "shell", "smooth", "start",
    "untangle", "unwrap", "where", "write",
]


# Modules that import other packages: loaded when they are used first.
_OTHER_PACKAGES = {"compat", "cortex", "grids", "meshio", "patterns", "pyvista", "trimesh"}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from ._native import native

        return native().version
    if name in _OTHER_PACKAGES:
        return import_module(f"{__name__}.{name}")
    raise AttributeError(f"module 'taut' has no attribute {name!r}")
