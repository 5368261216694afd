# SPDX-License-Identifier: MIT
"""Newton's method of one's own on the energy, gradient and Hessian of the library (needs scipy)."""

import numpy as np
from scipy.sparse import identity
from scipy.sparse.linalg import spsolve

import taut

n = 12
x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
V = np.c_[x.ravel(), y.ravel(), (x * x + y * y).ravel()]
i = np.arange(n * n)
a = i // n * (n + 1) + i % n
F = np.r_[np.c_[a, a + 1, a + n + 2], np.c_[a, a + n + 2, a + n + 1]]

# [newton]
f = taut.Evaluator(V, F)
x = V[:, :2].copy()
for step in range(20):
    value, gradient = f.value_gradient(x)
    H = f.hessian(x, projected=True) + 1e-9 * identity(x.size)  # a free map may shift and turn
    d = spsolve(H.tocsc(), -gradient.ravel()).reshape(x.shape)
    length = min(1.0, 0.9 * f.max_step(x, d))
    while f.value(x + length * d) > value and length > 1e-9:
        length /= 2
    x += length * d
# [newton]
best = taut.unwrap(V, F).energy
print(f"E {f.value(x):.6f}, {'as unwrap has it' if abs(f.value(x) - best) < 1e-6 else f'and unwrap has {best}'}")
