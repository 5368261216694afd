# SPDX-License-Identifier: MIT
"""Meshes that several tests use."""

from __future__ import annotations

import numpy as np
import pytest


def bowl_of(n: int) -> tuple[np.ndarray, np.ndarray]:
    """A bowl of n by n squares, a disk."""
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    V = np.c_[x.ravel(), y.ravel(), (x * x + y * y).ravel()]
    i = np.arange(n * n)
    a = i // n * (n + 1) + i % n
    F = np.stack([np.c_[a, a + 1, a + n + 2], np.c_[a, a + n + 2, a + n + 1]], 1).reshape(-1, 3)
    return V, F


def torus_of(n: int, m: int) -> tuple[np.ndarray, np.ndarray]:
    """A closed surface with a handle."""
    i, j = np.divmod(np.arange(n * m), m)
    u, v = 2 * np.pi * i / n, 2 * np.pi * j / m
    V = np.c_[(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)]
    a, b = i * m + j, (i + 1) % n * m + j
    c, d = i * m + (j + 1) % m, (i + 1) % n * m + (j + 1) % m
    return V, np.concatenate([np.c_[a, b, d], np.c_[a, d, c]])


def bar_of(n: int, length: int) -> tuple[np.ndarray, np.ndarray]:
    """A bar of n by n by length cubes, each of six tetrahedra."""
    z, y, x = np.meshgrid(np.arange(length + 1), np.arange(n + 1), np.arange(n + 1), indexing="ij")
    V = np.c_[x.ravel(), y.ravel(), z.ravel()].astype(float)
    k = n + 1
    corner = lambda dx, dy, dz: dx + k * dy + k * k * dz
    first = [a + k * b + k * k * c for c in range(length) for b in range(n) for a in range(n)]
    ways = [(0, 1, 3), (0, 2, 6), (0, 4, 5), (0, 5, 1), (0, 3, 2), (0, 6, 4)]
    bits = [corner(w & 1, w >> 1 & 1, w >> 2 & 1) for w in range(8)]
    C = [[f + bits[p], f + bits[q], f + bits[r], f + bits[7]] for f in first for p, q, r in ways]
    return V, np.array(C)


@pytest.fixture(scope="session")
def bowl() -> tuple[np.ndarray, np.ndarray]:
    return bowl_of(16)


@pytest.fixture(scope="session")
def large_bowl() -> tuple[np.ndarray, np.ndarray]:
    return bowl_of(250)


@pytest.fixture(scope="session")
def torus() -> tuple[np.ndarray, np.ndarray]:
    return torus_of(24, 12)


@pytest.fixture(scope="session")
def bar() -> tuple[np.ndarray, np.ndarray]:
    return bar_of(2, 6)
