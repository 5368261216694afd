# SPDX-License-Identifier: MIT
"""Interfaces of other packages, on taut."""
