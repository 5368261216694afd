# SPDX-License-Identifier: MIT
"""What the calls return."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ._arrays import Floats, Ints
from .errors import Infeasible, NoMap


def _require_energy(d: dict[str, Any], best: Any) -> None:
    """Raises `NoMap` where an energy is no number of a shape without inverted elements, so that nothing was minimised."""
    if np.isnan(d.get("energy", 0.0)):
        raise NoMap("energy: is nan for a shape without inverted elements, so nothing was minimised; "
                    "give one that is finite there", field="energy", fault="not_finite", notes=d.get("notes", ()), best=best)


@dataclass(frozen=True)
class Certificate:
    """Whether a map is locally injective, in exact arithmetic. True where it is.

    Attributes
    ----------
    flipped : (k,) int64
        Elements that are turned over, flat or not finite.
    branch_points : (k,) int64
        Inner vertices that a map to the plane winds around more than once; in space, both ends of inner edges.
    elements : int
        How many were looked at.
    min_det, max_det : float
        Smallest and largest determinant of the edges of an element.
    """

    flipped: Ints
    branch_points: Ints
    elements: int
    min_det: float
    max_det: float

    def __bool__(self) -> bool:
        return len(self.flipped) == 0 and len(self.branch_points) == 0

    @staticmethod
    def of(d: dict[str, Any]) -> Certificate:
        return Certificate(d["flipped"], d["branch_points"], d["elements"], d["min_det"], d["max_det"])


@dataclass(frozen=True, eq=False)
class Map:
    """A map, one point a vertex in the user's order. Unpacks as `x, report`.

    Attributes
    ----------
    x : (n, d) float64
        The points; `uv` is the same.
    certified : bool
        No element is flipped and nothing winds twice, in exact arithmetic. Maps that calls return are; those of
        exceptions (`best`) may not be.
    converged : bool
        Whether the energy is at a minimum, rather than at a limit.
    energy : float
        Mean over the elements.
    stop : str
        Why it ended.
    seconds : float
    iterations : int
    stages : list of dict
        What was done, in its order in time.
    notes : list of str
        What the library decided on its own.
    vmapping : (n,) int64 or None
        Of a surface that was cut open: the user's vertex of each point. `faces` are its triangles.
    cells, points, cell_origins : arrays or None
        Of a mesh that was refined: its cells, its points at rest, and the cell that each is a part of.
    pins_held : bool
        Whether all pins are at their places, bit for bit.
    report : dict
        All that is known of the run.
    """

    x: Floats = field(repr=False)
    certified: bool
    converged: bool
    energy: float
    stop: str
    seconds: float
    iterations: int
    pins_held: bool
    stages: list[dict[str, Any]] = field(repr=False)
    notes: list[str] = field(repr=False)
    report: dict[str, Any] = field(repr=False)
    vmapping: Ints | None = field(default=None, repr=False)
    faces: Ints | None = field(default=None, repr=False)
    cells: Ints | None = field(default=None, repr=False)
    points: Floats | None = field(default=None, repr=False)
    cell_origins: Ints | None = field(default=None, repr=False)

    @property
    def uv(self) -> Floats:
        return self.x

    def __iter__(self) -> Iterator[Any]:
        return iter((self.x, self.report))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        return np.array(self.x, dtype=dtype) if copy or dtype is not None else self.x

    @staticmethod
    def of(d: dict[str, Any]) -> Map:
        """A result of the library. Raises `NoMap` where it is none."""
        x = d.pop("x")
        valid = d["outcome"] == "valid"
        made = Map(
            x=x,
            certified=valid and len(x) > 0,
            converged=bool(d.get("converged", False)),
            energy=float(d.get("energy", np.nan)),
            stop=d.get("stop", ""),
            seconds=float(d.get("seconds", 0.0)),
            iterations=int(d.get("iterations", 0)),
            pins_held=bool(d.get("pins_held", valid)),
            stages=d.get("stages", []),
            notes=d.get("notes", []),
            report=d,
            vmapping=d.pop("vmapping", None),
            faces=d.pop("faces", None),
            cells=d.pop("C", None),
            points=d.pop("V", None),
            cell_origins=d.pop("cell_origins", None),
        )
        if valid:
            _require_energy(d, made)
            return made
        kind = Infeasible if d["outcome"] == "infeasible" else NoMap
        raise kind(
            d["reason"] or d["outcome"],
            ids=d["ids"],
            fault=d["outcome"],
            notes=made.notes,
            best=made if len(x) else None,
        )


@dataclass(frozen=True, eq=False)
class Atlas:
    """An atlas of a surface. Unpacks as `vmapping, faces, uv`, as that of xatlas does.

    Attributes
    ----------
    vmapping : (N,) int64
        The user's vertex of each vertex of the atlas.
    faces : (m, 3) int64
        The user's triangles, in their order, as vertices of the atlas.
    uv : (N, 2) float64
        Texture coordinates; tile t is the unit square at (t % 10, t // 10).
    chart, tile : (m,) int64
        Of each triangle. -1: repair left it out; it then lies in the point (0, 0).
    charts : int
    distortion : float
        Area mean of the isometric energy at one common scale; 4 is none.
    utilization : float
        Area of the triangles by that of the tiles.
    seam_length : float
        Of the edges inside of the surface that were cut, in its units.
    complete : bool
        False: a limit ended it; it is valid all the same.
    repairs, notes : list of str
        What was mended, and what the library decided on its own.
    report : dict
    """

    vmapping: Ints = field(repr=False)
    faces: Ints = field(repr=False)
    uv: Floats = field(repr=False)
    chart: Ints = field(repr=False)
    tile: Ints = field(repr=False)
    charts: int
    distortion: float
    utilization: float
    seam_length: float
    complete: bool
    seconds: float
    repairs: list[str] = field(repr=False)
    notes: list[str] = field(repr=False)
    report: dict[str, Any] = field(repr=False)

    @property
    def corner_uv(self) -> Floats:
        """Texture coordinates by corner, (m, 3, 2)."""
        return self.uv[self.faces]

    def __iter__(self) -> Iterator[Any]:
        return iter((self.vmapping, self.faces, self.uv))

    @staticmethod
    def of(d: dict[str, Any]) -> Atlas:
        report = d["report"]
        chart = d["chart"]
        tiles = np.append(report["chart_tiles"], -1)
        made = Atlas(
            vmapping=d["vmapping"],
            faces=d["faces"],
            uv=d["uv"],
            chart=chart,
            tile=tiles[chart],
            charts=len(report["chart_tiles"]),
            distortion=report["distortion"],
            utilization=report["utilization"],
            seam_length=report["seam_length"],
            complete=report["complete"],
            seconds=report["seconds"],
            repairs=d["repairs"],
            notes=report["notes"],
            report=report,
        )
        if report["reason"]:
            raise NoMap(report["reason"], notes=made.notes, best=made)
        return made


@dataclass(frozen=True, eq=False)
class Repaired:
    """A surface made of raw triangles. Unpacks as `V, F`.

    Attributes
    ----------
    V, F : (n, 3) float64, (m, 3) int64
        An oriented manifold.
    vmap, fmap : (n,) and (m,) int64
        The vertex and the triangle of the input that each is.
    turned : (k,) int64
        Triangles that were turned over.
    notes : list of str
        What was mended, in sentences.
    findings : dict of str to (k,) int64
        The same by kind, with what each is about, in the numbers of the input.
    """

    V: Floats = field(repr=False)
    F: Ints = field(repr=False)
    vmap: Ints = field(repr=False)
    fmap: Ints = field(repr=False)
    turned: Ints = field(repr=False)
    notes: list[str]
    findings: dict[str, Ints] = field(repr=False)

    def __iter__(self) -> Iterator[Any]:
        return iter((self.V, self.F))


@dataclass(frozen=True, eq=False)
class Packed:
    """Charts packed into tiles. Unpacks as `uv, tile`.

    Attributes
    ----------
    uv : (n, 2) float64
        The points at their places; tile t is the unit square at (t % 10, t // 10).
    chart, tile : (m,) int64
        Of each triangle.
    scale : float
        By which lengths were multiplied, before densities.
    utilization : float
        Area of the triangles that were packed by that of the tiles.
    complete : bool
        False: a limit ended it; the layout is valid and could be denser.
    """

    uv: Floats = field(repr=False)
    chart: Ints = field(repr=False)
    tile: Ints = field(repr=False)
    scale: float
    utilization: float
    complete: bool

    def __iter__(self) -> Iterator[Any]:
        return iter((self.uv, self.tile))


@dataclass(frozen=True, eq=False)
class Pasted:
    """A feature pasted on a surface. Unpacks as `V, F`.

    Attributes
    ----------
    V, F : (n, 3) float64, (m, 3) int64
        The result: triangles of the target that are left, those of the gap from `first_gap` on, those of the feature
        from `first_feature` on.
    vmapping : (n,) int64
        The vertex of the target that each vertex was; -1: it is of the feature.
    report : dict
    """

    V: Floats = field(repr=False)
    F: Ints = field(repr=False)
    vmapping: Ints = field(repr=False)
    first_gap: int
    first_feature: int
    report: dict[str, Any] = field(repr=False)

    def __iter__(self) -> Iterator[Any]:
        return iter((self.V, self.F))


@dataclass(frozen=True, eq=False)
class Frame:
    """What a call of `Session.solve` came to.

    Attributes
    ----------
    x : (n, d) float64
        The points, to be read only. Injective and certified, whatever the budget was.
    pins_held : bool
        Whether all pins are at their places, bit for bit.
    farthest, distance : int, float
        The vertex that is farthest from its pin, and how far; -1 and 0 where all are there.
    converged : bool
    energy : float
    steps : int
    seconds : float
    reason : str
        Why pins cannot be reached; empty where they can.
    report : dict
    """

    x: Floats = field(repr=False)
    pins_held: bool
    farthest: int
    distance: float
    converged: bool
    energy: float
    steps: int
    seconds: float
    reason: str
    report: dict[str, Any] = field(repr=False)

    @property
    def uv(self) -> Floats:
        return self.x

    @staticmethod
    def of(d: dict[str, Any]) -> Frame:
        # The memory of the library, which nobody can make writable again.
        x = np.asarray(memoryview(d.pop("x")).toreadonly())
        if d["outcome"] != "valid":
            kind = Infeasible if d["outcome"] == "infeasible" else NoMap
            raise kind(d["reason"] or d["outcome"], ids=d["ids"], fault=d["outcome"], notes=d["notes"])
        _require_energy(d, None)
        return Frame(
            x=x,
            pins_held=d["pins_held"],
            farthest=d["farthest"],
            distance=d["distance"],
            converged=d["converged"],
            energy=d["energy"],
            steps=d["iterations"],
            seconds=d["seconds"],
            reason=d["reason"],
            report=d,
        )


@dataclass(frozen=True)
class Device:
    """The host, or an OpenCL device of this machine; `refusal` says why it cannot serve, or is empty."""

    name: str
    vendor: str
    platform: str
    driver: str
    kind: str
    double_precision: bool
    compute_units: int
    memory: int
    refusal: str
