# SPDX-License-Identifier: MIT
"""Energies of the library. They are added and multiplied: `energies.shape + 0.3 * energies.area`.

Examples
--------
>>> from taut import energies
>>> mixed = 0.8 * energies.isometric + 0.2 * energies.shape_power(3)
>>> round(mixed.value([[1, 0], [0, 1]]), 9)
3.4
"""

from __future__ import annotations

from . import _arrays
from ._trace import BuiltinEnergy
from .errors import ParameterError

#: Minimal at rotations: |S|^2 (1 + 1 / J^2) of triangles, the symmetric Dirichlet energy; shape * area of tetrahedra.
isometric = BuiltinEnergy("isometric")

#: Blind to scale: |S|^2 / (d J^(2/d)), 1 at similarities.
shape = BuiltinEnergy("shape")

#: Blind to shape: J + 1 / J, 2 where the measure stays.
area = BuiltinEnergy("area")


def shape_power(power: int = 2) -> BuiltinEnergy:
    """The shape energy to a power: the larger it is, the more the worst elements count."""
    return BuiltinEnergy("shape_power", _arrays.number("power", power))


def neo_hookean(poisson: float = 0.3) -> BuiltinEnergy:
    """A compressible neo-Hookean solid of Young's modulus 1 and this Poisson ratio, in (-1, 0.5)."""
    ratio = _arrays.number("poisson", poisson)
    if not -1 < ratio < 0.5:
        raise ParameterError(f"poisson: is {poisson}, but must be above -1 and below 0.5", field="poisson")
    return BuiltinEnergy("neo_hookean", ratio)


__all__ = ["area", "isometric", "neo_hookean", "shape", "shape_power"]
