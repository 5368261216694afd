# SPDX-License-Identifier: MIT
"""Maps of surfaces to the plane, and what any map is like."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _arrays, _options
from ._arrays import ArrayLike, Floats
from ._call import ProgressLike, call
from ._native import native
from ._results import Certificate, Map
from ._trace import EnergyLike
from .errors import MeshError, ParameterError


#: What else there is for surfaces that are no disk.
_REMEDIES = {
    "closed_surface": "cut=True does, and taut.atlas takes any surface",
    "handles": "cut=True does, and taut.atlas takes any surface",
    "several_components": "taut.atlas takes any surface",
    "several_boundaries": "holes=True takes it as it is",
}


def unwrap(
    V: ArrayLike,
    F: ArrayLike,
    *,
    b: ArrayLike = None,
    bc: ArrayLike = None,
    springs: Any = None,
    energy: EnergyLike = "isometric",
    boundary: str = "free",
    no_overlap: bool = False,
    holes: bool = False,
    cut: bool = False,
    initial: ArrayLike = None,
    polygons: ArrayLike = None,
    weights: ArrayLike = None,
    attributes: ArrayLike = None,
    directions: ArrayLike = None,
    parameters: ArrayLike = (),
    placement: str = "upright",
    single: bool = False,
    precision: str = "auto",
    tolerance: float | None = None,
    iterations: int | None = None,
    time_limit: float | None = None,
    progress: ProgressLike = None,
    device: Any = None,
) -> Map:
    """Map a surface to the plane with little distortion and without flipping a triangle.

    Parameters
    ----------
    V : (n, 3) or (n, 2) array-like
        Vertices.
    F : (m, 3) array-like of int
        Triangles, oriented, one disk (but see `holes` and `cut`).
    b, bc : (k,) and (k, 2) array-like, optional
        Pins: vertex b[i] comes to lie at bc[i], bit for bit. A coordinate that is NaN is free.
    springs : (vertices, places, weights), optional
        Weight * |x - place|^2 is added to the energy; one weight may stand for all.
    energy : str, Energy or callable
        What is minimised: "isometric", "shape", "area", or an energy of your own (`taut.energy`).
    boundary : {"free", "circle", "square"}
        What becomes of the boundary; not with `initial`, which has one.
    no_overlap : bool
        Whether the boundary must not cross itself.
    holes : bool
        Whether more than one boundary loop is taken.
    cut : bool
        Whether a surface that is no disk is cut open along a short seam. The result then has `vmapping` and `faces`.
    initial : (n, 2) array-like, optional
        A map to start from.
    polygons : (m,) array-like of int, optional
        The polygon of each triangle: those that are convex in space become convex in the map, so that their triangles
        are positive along any diagonals. `report["concave"]` has those for which pins or a fixed boundary prevent it.
    weights, attributes, directions : (m,), (m, k) and (m, 3) array-like, optional
        Of triangles: how much each counts, numbers that the energy reads, a direction that it may see.
    parameters : (k,) array-like
        Numbers that the energy reads, of all triangles.
    placement : {"upright", "unit_square", "as_solved"}
        Where a map comes to lie that nothing holds.
    single : bool
        Whether the map is one of numbers that float32 holds, certified as these; pins are rounded to them.
    precision : {"auto", "fp64", "mixed", "fp32"}
    tolerance, iterations, time_limit : optional
        Relative gradient, Newton's steps and seconds at which it ends.
    progress : callable or True, optional
        Called with a `Progress`, at most ten times a second; an answer of False ends the call with the best map. True
        shows a line.
    device : int or str, optional
        Number of an OpenCL device or a part of its name.

    Returns
    -------
    Map
        Certified: no triangle is flipped, and the map winds once around every inner vertex.

    Raises
    ------
    MeshError, ConstraintError, ParameterError, DeviceError
    Infeasible
        Where no map can exist under these pins.
    NoMap
        Where none was found.
    Interrupted
        At Ctrl-C; `best` is the best map by then.

    Examples
    --------
    >>> import numpy as np, taut
    >>> V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
    >>> uv, report = taut.unwrap(V, [[0, 1, 2], [0, 2, 3]])
    >>> uv.shape
    (4, 2)
    """
    points, faces = _options.surface(V, F)
    n, m = len(points), len(faces)
    options = {
        **_options.pins(b, bc, springs, n, 2),
        **_options.energies(energy, 2, m, weights, attributes, directions, parameters),
        **_options.limits(tolerance, iterations, time_limit, precision),
        "boundary": boundary,
        "placement": placement,
        "no_overlap": no_overlap,
        "holes": holes,
        "cut": cut,
        "single": single,
        "device": _options.device(device),
    }
    if single and "bc" in options:
        with np.errstate(over="ignore"):  # is said of the vertex
            options["bc"] = options["bc"].astype(np.float32)
    if placement == "unit_square" and (b is not None or springs is not None):
        what = "pins hold" if b is not None else "springs draw"
        raise ParameterError(f'placement: "unit_square" has no effect on a map that {what}', field="placement")
    if initial is not None:
        if boundary in ("circle", "square"):
            raise ParameterError(f'boundary: "{boundary}" has no effect on a boundary that `initial` has; leave one out',
                                 field="boundary")
        options["initial"] = _arrays.points("initial", initial, (2,), rows=n)
    if polygons is not None:
        options["polygons"] = _arrays.labels("polygons", polygons, m)
    try:
        return call(native().unwrap, points, faces, options, progress=progress, make=Map.of)
    except MeshError as e:
        if e.fault in _REMEDIES:
            e.args = (f"{e}; {_REMEDIES[e.fault]}",)
        raise


def square(options: Mapping[str, Any]) -> dict[str, Any]:
    """The placement of a texture: the unit square, unless pins or springs say where it lies."""
    held = options.get("b") is not None or options.get("springs") is not None
    return {} if held else {"placement": "unit_square"}


def at_scale(options: Mapping[str, Any], of: str, **own: bool) -> dict[str, Any]:
    """Options of `unwrap` for maps with one place for each vertex, at the scale of the surface.

    of : what has such a map, for messages; own : what else it has
    """
    for name, value in {"cut": False, **own}.items():
        if isinstance(options.get(name), (bool, np.bool_)) and options[name] != value:
            why = "vertices have one place each; cut the surface before" if name == "cut" else "that is how they are made"
            raise ParameterError(f"{name}: must be {value} for {of}, as {why}", field=name)
    if isinstance(options.get("placement"), str) and options["placement"] == "unit_square":
        raise ParameterError(f'placement: must not be "unit_square" for {of}, which keep the lengths of the surface',
                             field="placement")
    return {"holes": True, **own, **{name: value for name, value in options.items() if value is not None}}


def _map_of(C: Any, x: Any, V: Any = None) -> tuple[Any, Any, int, Any]:
    """Cells, where the map has vertices, the dimension, and vertices at rest if these are given, too."""
    shape = _arrays.shape(C)
    if len(shape) != 2 or shape[1] not in (3, 4):
        shape = _arrays.array("C", C).shape  # rows of several lengths are told as such
        raise ParameterError(f"C: has the shape {shape}, but must be (m, 3) or (m, 4)", field="C")
    dim = shape[1] - 1
    rest = None if V is None else _arrays.points("V", V, (2, 3) if dim == 2 else (3,))
    points = _arrays.points("x", x, (dim,), rows=None if rest is None else len(rest))
    return _arrays.indices("C", C, (dim + 1,), len(points)), points, dim, rest


def _given(name: str, value: Any) -> Any:
    if value is None:
        raise ParameterError(f"{name}: is None, but must be an array of numbers", field=name)
    return value


def certify(C: ArrayLike, x: ArrayLike) -> Certificate:
    """Count flipped elements and branch points of a map in exact arithmetic.

    Parameters
    ----------
    C : (m, 3) or (m, 4) array-like of int
        Triangles or tetrahedra.
    x : (n, 2) or (n, 3) array-like
        The map, of any making. Floats are certified as the numbers that they are.

    Examples
    --------
    >>> import taut
    >>> bool(taut.certify([[0, 1, 2]], [[0, 0], [1, 0], [0, 1]]))
    True
    >>> taut.certify([[0, 2, 1]], [[0, 0], [1, 0], [0, 1]]).flipped.tolist()
    [0]
    """
    cells, points, dim, _ = _map_of(C, x)
    return Certificate.of(getattr(native(), f"certify{dim}")(cells, points))


def distortion(V: ArrayLike, C: ArrayLike, x: ArrayLike) -> Floats:
    """Isometric distortion of every element of a map: 4 (triangles) or 2 (tetrahedra) where nothing is distorted,
    infinite where an element is flipped.

    Examples
    --------
    >>> import taut
    >>> taut.distortion([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [[0, 0], [2, 0], [0, 1]])
    array([6.25])
    """
    cells, points, dim, rest = _map_of(C, x, _given("V", V))
    values: Floats = getattr(native(), f"distortion{dim}")(rest, cells, points)
    return values


def quality(V: ArrayLike, C: ArrayLike, x: ArrayLike) -> dict[str, Any]:
    """Energies, stretch, angles and areas of a map, and what folds.

    Returns
    -------
    dict
        "isometric", "shape", "area": means, "uniform" and by "measure"; "stretch_l2", "stretch_linf", "area_ratio":
        "min", "max", "rms"; "stretch_l2_total"; "angular"; "scale"; "flips".

    Examples
    --------
    >>> import taut
    >>> q = taut.quality([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [[0, 0], [2, 0], [0, 1]])
    >>> q["isometric"]["measure"], bool(q["flips"])
    (6.25, True)
    """
    cells, points, dim, rest = _map_of(C, x, _given("V", V))
    found: dict[str, Any] = getattr(native(), f"quality{dim}")(rest, cells, points)
    found["flips"] = Certificate.of(found["flips"])
    return found
