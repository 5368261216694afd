# SPDX-License-Identifier: MIT
"""An interactive session: a vertex is dragged; each frame is injective."""

import numpy as np

import taut

n = 20
x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
V = np.c_[x.ravel(), y.ravel(), (x * x + y * y).ravel()]
i = np.arange(n * n)
a = i // n * (n + 1) + i % n
F = np.r_[np.c_[a, a + 1, a + n + 2], np.c_[a, a + n + 2, a + n + 1]]

# [drag]
with taut.Session(V, F) as session:
    first = session.solve().x
    session.pin(0, first[0]).pin(len(V) - 1, first[-1])
    held = len(V) // 2
    for k in range(1, 31):
        frame = session.pin(held, first[held] + [0.3 * k / 30, 0]).solve(time=0.015)
        # Here it would be drawn. frame.distance says how far the pin is ahead.
    rest = session.solve()  # until it has converged
# [drag]
print(f"E {rest.energy:.3f}, {'converged' if rest.converged else 'stopped'}, pins {'exact' if rest.pins_held else 'moved'}")
