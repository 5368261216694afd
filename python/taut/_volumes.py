# SPDX-License-Identifier: MIT
"""Volumes, meshes of the plane and shells: deformed, smoothed, untangled."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from . import _arrays, _options
from ._arrays import Array, ArrayLike
from ._call import ProgressLike, call
from ._native import native
from ._results import Map
from ._trace import EnergyLike
from .errors import MeshError, ParameterError


#: Dimensions of kinds of cells.
_DIMENSIONS = {"vertex": 0, "line": 1, "triangle": 2, "quad": 2, "tetrahedron": 3, "pyramid": 3, "wedge": 3, "hexahedron": 3}


def of_mesh(
    points: Any, blocks: Iterable[tuple[str, Any]], known: Mapping[str, str], options: Mapping[str, Any]
) -> tuple[Any, list[Array], dict[str, Any]]:
    """What calls take of a mesh of another package: points, its cells of the highest dimension, an array a block, and
    options. Of a mesh in a plane z = const points and places have two numbers.

    blocks : what the package calls each kind, and its cells; known : what such kinds are called here

    Raises
    ------
    ParameterError
        Where there are none but points and lines, or any of another kind: they would be left out of the certificate,
        and points of theirs that no other cell has would stay where they are.
    """
    own = []
    for kind, rows in blocks:
        if kind not in known:
            raise ParameterError(
                f"mesh: has {len(rows)} cells of the kind {kind}, which are not known; take them out, or turn them into "
                f"{', '.join(known)}", field="mesh",
            )
        own.append((_DIMENSIONS[known[kind]], np.asarray(rows)))
    dimension = max((d for d, rows in own if len(rows)), default=0)
    if dimension < 2:
        words = ", ".join(name for name, kind in known.items() if _DIMENSIONS[kind] > 1)
        raise ParameterError(f"mesh: has no cells with an inside: {words}", field="mesh")
    cells = [rows for d, rows in own if d == dimension and len(rows)]
    if dimension == 3 or np.shape(points)[1:] != (3,):
        return points, cells, dict(options)
    V, z = _plane_of(_arrays.points("points", points))
    return V, cells, _in_plane(options, z)


def _plane_of(points: Array, name: str = "V") -> tuple[Array, float]:
    """Points without z, and their z. Raises `ParameterError` where it is not the same for all."""
    z = float(points[0, 2]) if len(points) else 0.0
    if (points[:, 2] != z).any():
        raise ParameterError(
            f"{name}: triangles and quads that do not lie in a plane z = const; a surface in space is a shell (taut.shell)",
            field=name,
        )
    return points[:, :2], z


def _in_plane(options: Mapping[str, Any], z: float | None) -> dict[str, Any]:
    """Options of a mesh in a plane: of places with three numbers the last one, which must be z or NaN, is left out."""

    def flat(name: str, rows: Any) -> Any:
        if z is None or len(_arrays.shape(rows)) != 2 or _arrays.shape(rows)[1] != 3:
            return rows
        places = _arrays.points(name, rows, nan=True)
        off = np.flatnonzero((places[:, 2] != z) & ~np.isnan(places[:, 2]))
        if len(off):
            raise ParameterError(f"{name}: row {off[0]} has z = {places[off[0], 2]}, but the mesh lies in the plane "
                                 f"z = {z}", field=name, ids=off[:1])
        return places[:, :2]

    made = {name: flat(name, rows) if name in ("bc", "rest", "initial") else rows for name, rows in options.items()}
    springs = made.get("springs")
    if isinstance(springs, (tuple, list)) and len(springs) == 3:
        made["springs"] = (springs[0], flat("springs", springs[1]), springs[2])
    return made


def _is_table(rows: Any) -> bool:
    """Whether these are rows of numbers, not one row."""
    shape = getattr(rows, "shape", None)
    if shape is not None:
        return len(shape) == 2
    return isinstance(rows, (list, tuple)) and bool(rows) and hasattr(rows[0], "__len__")


def _blocks(V: Any, C: Any, name: str = "V") -> tuple[Array, list[Array], int, float | None]:
    """Points, cells by kind, the dimension, that of the points, or 2 for triangles in a plane z = const, and that z."""
    points = _arrays.points(name, V, (2, 3))
    given = C if isinstance(C, (list, tuple)) and len(C) and _is_table(C[0]) else [C]
    blocks = [np.ascontiguousarray(_arrays.indices("C", c, (3, 4, 5, 6, 8), len(points))) for c in given]
    if not any(len(c) for c in blocks):
        raise MeshError("the mesh has no cells; give it at least one", fault="empty")
    if points.shape[1] == 2:
        return points, blocks, 2, None
    if not all(c.shape[1] == 3 for c in blocks):
        return points, blocks, 3, None
    points, z = _plane_of(points, name)
    return points, blocks, 2, z


def deform(
    V: ArrayLike,
    C: Any,
    b: ArrayLike = None,
    bc: ArrayLike = None,
    *,
    springs: Any = None,
    slides: Any = None,
    rest: ArrayLike = None,
    initial: ArrayLike = None,
    shapes: str = "rest",
    energy: EnergyLike = "isometric",
    weights: ArrayLike = None,
    attributes: ArrayLike = None,
    directions: ArrayLike = None,
    parameters: ArrayLike = (),
    refine: bool = False,
    precision: str = "auto",
    tolerance: float | None = None,
    iterations: int | None = None,
    time_limit: float | None = None,
    progress: ProgressLike = None,
    device: Any = None,
) -> Map:
    """Deform a volume, or a mesh of the plane, so that pins come to their places, bit for bit, and nothing is inverted.

    Parameters
    ----------
    V : (n, 3) or (n, 2) array-like
        Vertices; two columns, or triangles of one z: a mesh of the plane, whose places may have two numbers or three.
    C : (m, 3 | 4 | 5 | 6 | 8) array-like of int, or a list of such arrays
        Triangles, quads (two columns in V) or tetrahedra, pyramids, wedges, hexahedra; corners in VTK's order.
    b, bc : (k,) and (k, d) array-like
        Pins; a coordinate that is NaN is free.
    springs : (vertices, places, weights), optional
    slides : (vertices, normals), optional
        Vertices that may move across these normals only: in a plane, or along a line of the plane.
    rest : (n, 3) array-like, optional
        The shape at rest, if it is not V.
    initial : (n, d) array-like, optional
        The shape to begin with, if it is not V.
    shapes : {"rest", "regular"}
        What elements are wanted to look like.
    refine : bool
        Whether elements that pins make impossible are split; the result then has `cells` and `points`.
    energy, weights, attributes, directions, parameters, precision, tolerance, iterations, time_limit, progress, device
        As in `unwrap`.

    Returns
    -------
    Map
        Certified: no element is inverted.

    Raises
    ------
    Infeasible
        Where no shape can exist under these pins.
    NoMap
        Where pins could not be brought to their places; `best` is the valid shape that came nearest.

    Examples
    --------
    >>> import numpy as np, taut
    >>> V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    >>> taut.deform(V, [[0, 1, 2, 3]], [0, 1], [[0, 0, 0], [2, 0, 0]]).x[1]
    array([2., 0., 0.])
    """
    points, blocks, dim, z = _blocks(V, C)
    cells = sum(len(c) for c in blocks)
    given = _in_plane({"bc": bc, "springs": springs, "initial": initial, "rest": rest}, z)
    options = {
        **_options.pins(b, given["bc"], given["springs"], len(points), dim),
        **_options.energies(energy, dim, cells, weights, attributes, directions, parameters),
        **_options.limits(tolerance, iterations, time_limit, precision),
        "shapes": shapes,
        "refine": refine,
        "device": _options.device(device),
    }
    if slides is not None:
        try:
            vertices, across = slides
        except (TypeError, ValueError):
            raise ParameterError("slides: must be two: vertices, normals", field="slides") from None
        options["slide_b"] = _arrays.ids("slides", vertices, len(points))
        normals = _arrays.points("slides", across, (dim,), rows=len(options["slide_b"]))
        zero = np.flatnonzero(~normals.any(1))
        if len(zero):
            raise ParameterError(f"slides: row {zero[0]} has a normal of zeros", field="slides", ids=zero[:1])
        options["slide_normals"] = normals
    if rest is not None:
        options["rest"] = _arrays.points("rest", given["rest"], (2, 3), rows=len(points))
    if initial is not None:
        options["initial"] = _arrays.points("initial", given["initial"], (dim,), rows=len(points))
    return call(getattr(native(), f"deform{dim}"), points, blocks, options, progress=progress, make=Map.of)


def _on_cells(name: str, points: Any, blocks: Any, options: dict[str, Any], ids: dict[str, Any], rest: Any, progress: Any) -> Map:
    """The call of that name; ids: vertices by the argument that names them."""
    for argument, given in ids.items():
        if given is not None:
            options[argument] = _arrays.ids(argument, given, len(points))
    if rest is not None:
        options["rest"] = _arrays.points("rest", rest, (2, 3), rows=len(points))
    return call(getattr(native(), name), points, blocks, options, progress=progress, make=Map.of)


def smooth(
    V: ArrayLike,
    C: Any,
    *,
    boundary: str = "sliding",
    fixed: ArrayLike = None,
    shapes: str = "regular",
    rest: ArrayLike = None,
    worst_exponent: int = 2,
    precision: str = "auto",
    tolerance: float | None = None,
    iterations: int | None = None,
    time_limit: float | None = None,
    progress: ProgressLike = None,
    device: Any = None,
) -> Map:
    """Move vertices to where elements are best shaped, without inverting one.

    Parameters
    ----------
    V, C
        As in `deform`.
    boundary : {"sliding", "fixed", "free"}
        What the boundary may do: move in its own flat parts, nothing, all.
    fixed : (k,) array-like of int, or (n,) of bool, optional
        Vertices that stay.
    shapes, rest
        What elements are wanted to look like: regular, or as in `rest`.
    worst_exponent : int
        1 to 8: larger ones put the worst elements first.

    Returns
    -------
    Map
        `report["before"]` and `report["after"]` have the shapes of the elements.

    Examples
    --------
    >>> import taut
    >>> square = [[0, 0], [2, 0], [2, 2], [0, 2], [0.3, 0.4]]
    >>> taut.smooth(square, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]).x[4].round(3).tolist()
    [1.0, 1.0]
    """
    if rest is not None and shapes == "regular":
        raise ParameterError('rest: has no effect with shapes="regular"; give shapes="rest"', field="rest")
    points, blocks, dim, z = _blocks(V, C)
    options = {
        **_options.limits(tolerance, iterations, time_limit, precision),
        "boundary": boundary,
        "shapes": shapes,
        "worst_exponent": worst_exponent,
        "device": _options.device(device),
    }
    rest = _in_plane({"rest": rest}, z)["rest"]
    return _on_cells(f"smooth{dim}", points, blocks, options, {"fixed": fixed}, rest, progress)


def untangle(
    X: ArrayLike,
    C: Any,
    b: ArrayLike = None,
    *,
    rest: ArrayLike = None,
    refine: bool = False,
    rounds: int | None = None,
    stages: list[str] | None = None,
    time_limit: float | None = None,
    progress: ProgressLike = None,
    device: Any = None,
) -> Map:
    """Move what is not held until no element is inverted.

    Parameters
    ----------
    X : (n, d) array-like
        Positions, in any state.
    C : as in `deform`
    b : (k,) array-like of int, or (n,) of bool, optional
        Vertices that stay where X has them, bit for bit.
    rest : (n, 2 or 3) array-like, optional
        The shape that is distorted as little as possible; without it elements are wanted regular.
    refine : bool
        Whether elements that are in the way are split.

    Raises
    ------
    Infeasible
        With the proof that no map exists.
    NoMap
        Where none was found; `best` has the fewest inverted elements, `ids` are these.

    Examples
    --------
    >>> import taut
    >>> square = [[0, 0], [2, 0], [2, 2], [0, 2], [9, 9]]  # the last one lies outside
    >>> C = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    >>> taut.certify(C, square).flipped.tolist(), bool(taut.certify(C, taut.untangle(square, C, [0, 1, 2, 3]).x))
    ([1, 2], True)
    """
    points, blocks, dim, z = _blocks(X, C, "X")
    options: dict[str, Any] = {
        "refine": refine,
        "rounds": rounds,
        "stages": stages,
        "time_limit": time_limit,
        "device": _options.device(device),
    }
    rest = _in_plane({"rest": rest}, z)["rest"]
    return _on_cells(f"untangle{dim}", points, blocks, options, {"b": b}, rest, progress)


def shell(
    V: ArrayLike,
    F: ArrayLike,
    b: ArrayLike = None,
    bc: ArrayLike = None,
    *,
    springs: Any = None,
    thickness: float | None = None,
    initial: ArrayLike = None,
    precision: str = "auto",
    tolerance: float | None = None,
    iterations: int | None = None,
    time_limit: float | None = None,
    progress: ProgressLike = None,
    device: Any = None,
) -> Map:
    """Deform a surface in space as a thin shell that bends and stretches, so that pins come to their places.

    Parameters
    ----------
    V, F : (n, 3) and (m, 3) array-like
        The surface at rest.
    b, bc, springs
        As in `deform`, in space.
    thickness : float, optional
        In the lengths of the surface; the mean edge if it is not given. How much bending costs against stretching.
    initial : (n, 3) array-like, optional
        The shape to begin with.

    Returns
    -------
    Map
        No triangle has collapsed; the surface may pass through itself.

    Examples
    --------
    >>> import numpy as np, taut
    >>> V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    >>> taut.shell(V, [[0, 1, 2], [0, 2, 3]], [0, 1, 2], V[:3], thickness=0.1).x.round(3).tolist()[3]
    [0.0, 1.0, 0.0]
    """
    points, faces = _options.surface(V, F, planar=False)
    options = {
        **_options.pins(b, bc, springs, len(points), 3),
        **_options.limits(tolerance, iterations, time_limit, precision),
        "thickness": thickness,
        "device": _options.device(device),
    }
    if initial is not None:
        options["initial"] = _arrays.points("initial", initial, (3,), rows=len(points))
    return call(native().shell, points, faces, options, progress=progress, make=Map.of)
