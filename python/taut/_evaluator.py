# SPDX-License-Identifier: MIT
"""Energy, gradient and Hessian of maps as numbers, for solvers of your own."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arrays, _options
from ._arrays import ArrayLike, Floats
from ._call import named
from ._native import native
from ._trace import EnergyLike


class Evaluator:
    """f(x) = sum over elements of w E(S(x)) / sum of w, and its derivatives, calculated on the device.

    Parameters
    ----------
    V, C : array-like
        Triangles or tetrahedra at rest.
    energy, weights, attributes, directions, parameters, device
        As in `unwrap`.
    weighting : {"area", "volume", "uniform"}
        Whether elements count by their rest measure, or all the same.
    precision : {"fp64", "mixed", "fp32"}

    Examples
    --------
    >>> import taut
    >>> V = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> f = taut.Evaluator(V, [[0, 1, 2]])
    >>> f.value([[0, 0], [2, 0], [0, 1]])
    6.25
    >>> f.max_step([[0, 0], [2, 0], [0, 1]], [[0, 0], [-1, 0], [0, 0]])
    2.0
    """

    def __init__(
        self,
        V: ArrayLike,
        C: ArrayLike,
        energy: EnergyLike = "isometric",
        *,
        weighting: str = "area",
        weights: ArrayLike = None,
        attributes: ArrayLike = None,
        directions: ArrayLike = None,
        parameters: ArrayLike = (),
        precision: str = "fp64",
        device: Any = None,
    ) -> None:
        points = _arrays.points("V", V, (2, 3))
        cells = _arrays.indices("C", C, (3, 4), len(points))
        self.dim = cells.shape[1] - 1
        self._count = len(points)
        options = {
            **_options.energies(energy, self.dim, len(cells), weights, attributes, directions, parameters),
            "weighting": weighting,
            "precision": precision,
            "device": _options.device(device),
        }
        with named({}):
            self._evaluator: Any = getattr(native(), f"Evaluator{self.dim}")(points, cells, options)

    def _points(self, name: str, x: Any) -> Any:
        return _arrays.points(name, x, (self.dim,), rows=self._count)

    def value(self, x: ArrayLike) -> float:
        """f(x); infinite where the energy is a barrier and an element is not positive."""
        return float(self._evaluator.value(self._points("x", x)))

    def gradient(self, x: ArrayLike) -> Floats:
        """df/dx, one row a vertex."""
        return self.value_gradient(x)[1]

    def value_gradient(self, x: ArrayLike) -> tuple[float, Floats]:
        """Both at once."""
        value, gradient = self._evaluator.value_gradient(self._points("x", x))
        return float(value), gradient

    def hessian(self, x: ArrayLike, *, projected: bool = False) -> Any:
        """The second derivatives as a `scipy.sparse.bsr_matrix`, unknowns numbered as `x.ravel()`.

        projected : whether the Hessian of each element is projected to its positive semi-definite part.
        """
        from scipy.sparse import bsr_matrix

        offsets, columns, numbers = self._evaluator.hessian(self._points("x", x), bool(projected))
        d = self.dim
        n = d * self._count
        return bsr_matrix((np.reshape(numbers, (-1, d, d)), columns, offsets), shape=(n, n))

    def max_step(self, x: ArrayLike, dx: ArrayLike) -> float:
        """The largest a for which no element has flipped anywhere between x and x + a dx."""
        return float(self._evaluator.max_step(self._points("x", x), self._points("dx", dx)))
