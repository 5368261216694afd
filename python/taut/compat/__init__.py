# SPDX-License-Identifier: MIT
"""Interfaces of other packages, on taut."""

from . import xatlas

__all__ = ["xatlas"]
