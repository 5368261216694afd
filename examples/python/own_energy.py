# SPDX-License-Identifier: MIT
"""A cloth whose threads stretch less than they shear: an energy in Python, with directions and a slider."""

import numpy as np

import taut
from taut import energies


# [energy]
@taut.energy
def cloth(s):
    warp = s.S @ s.direction
    stretch = warp @ warp - 1
    return energies.isometric(s) + s.parameter(0) * s.attribute(0) * stretch**2
# [energy]


def bowl(n):
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    i = np.arange(n * n)
    a = i // n * (n + 1) + i % n
    F = np.r_[np.c_[a, a + 1, a + n + 2], np.c_[a, a + n + 2, a + n + 1]]
    return np.c_[x.ravel(), y.ravel(), (x * x + y * y).ravel()], F


V, F = bowl(20)
fabric = np.where(V[F].mean(1)[:, 0] < 0, 1.0, 4.0)
warp = np.tile([1.0, 0.0, 0.0], (len(F), 1))
before = 0.0
for slider in (0.0, 1.0, 2.0):  # kernels are built once
    made = taut.unwrap(V, F, energy=cloth, attributes=fabric, directions=warp, parameters=[slider])
    assert made.energy > before
    before = made.energy
    print(f"slider {slider:g}: E {made.energy:.4f}, {made.iterations} iterations")
