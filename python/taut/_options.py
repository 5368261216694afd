# SPDX-License-Identifier: MIT
"""Arguments that several calls have, as options of the library."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arrays
from ._trace import BuiltinEnergy, as_energy
from .errors import ParameterError


def device(value: Any) -> str | None:
    return None if value is None else str(getattr(value, "name", value))


def surface(V: Any, F: Any, *, names: tuple[str, str] = ("V", "F"), planar: bool = True) -> tuple[Any, Any]:
    """Points and triangles, looked at."""
    points = _arrays.points(names[0], V, (2, 3) if planar else (3,))
    return points, _arrays.indices(names[1], F, (3,), len(points))


def pair(name: str, mesh: Any, *, planar: bool = True) -> tuple[Any, Any]:
    """Points and triangles of a surface that is one argument."""
    try:
        V, F = mesh
    except (TypeError, ValueError):
        raise ParameterError(f"{name}: must be a pair, (V, F)", field=name) from None
    return surface(V, F, names=(f"V of {name}", f"F of {name}"), planar=planar)


def pins(b: Any, bc: Any, springs: Any, count: int, dim: int) -> dict[str, Any]:
    """Pins and springs; a coordinate that is NaN is free."""
    options: dict[str, Any] = {}
    if (b is None) != (bc is None):
        raise ParameterError("b and bc: give both, or none of them", field="bc" if bc is None else "b")
    if b is not None:
        options["b"] = _arrays.ids("b", b, count)
        options["bc"] = _arrays.pins("bc", bc, (dim,), rows=len(options["b"]))
    if springs is not None:
        try:
            vertices, places, weights = springs
        except (TypeError, ValueError):
            raise ParameterError("springs: must be three: vertices, places, weights", field="springs") from None
        options["spring_b"] = _arrays.ids("springs", vertices, count)
        options["spring_bc"] = _arrays.points("springs", places, (dim,), rows=len(options["spring_b"]))
        options["spring_w"] = _arrays.numbers("springs", weights, len(options["spring_b"]))
        none = np.flatnonzero(options["spring_w"] == 0)
        if len(none):
            raise ParameterError(f"springs: row {none[0]} has the weight 0, and no effect", field="springs", ids=none[:1])
    return options


def energies(
    energy: Any, dim: int, cells: int, weights: Any, attributes: Any, directions: Any, parameters: Any
) -> dict[str, Any]:
    """An energy and the numbers that it reads."""
    options: dict[str, Any] = {"energy": as_energy(energy).native(dim)}
    if weights is not None:
        options["weights"] = _arrays.numbers("weights", weights, cells)
    if attributes is not None:
        options["attributes"] = _arrays.numbers("attributes", attributes, cells, columns=True)
    numbers = np.atleast_1d(_arrays.array("parameters", parameters))
    if isinstance(as_energy(energy), BuiltinEnergy):
        given = (("attributes", attributes), ("directions", directions), ("parameters", numbers if numbers.size else None))
        for name, value in given:
            if value is not None:
                raise ParameterError(f"{name}: has no effect, as no energy of taut's own reads them", field=name)
    if directions is not None:
        options["directions"] = _arrays.points("directions", directions, (2, 3), rows=cells)
    if numbers.size:
        options["parameters"] = _arrays.numbers("parameters", numbers)
    return options


def limits(tolerance: Any, iterations: Any, time_limit: Any, precision: str) -> dict[str, Any]:
    return {"tolerance": tolerance, "iterations": iterations, "time_limit": time_limit, "precision": precision}
