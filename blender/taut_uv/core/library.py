# SPDX-License-Identifier: MIT
"""The package taut, which computes."""

from __future__ import annotations

import importlib
import sys


class Missing(RuntimeError):
    """The package taut is not there, or does not load; the message says what to do."""


def taut(folder: str = ""):
    """The package. folder: a place to look for it first, that of a build or of `pip install --target`."""
    if folder and folder not in sys.path:
        sys.path.insert(0, folder)
    try:
        return importlib.import_module("taut")
    except ImportError as e:
        version = f"{sys.version_info.major}.{sys.version_info.minor}"
        raise Missing(
            f"the Python package taut cannot be loaded ({e}); install the zip that contains it, or name the folder of "
            f"a taut for Python {version} in the preferences of the add-on"
        ) from e
