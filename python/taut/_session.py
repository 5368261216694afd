# SPDX-License-Identifier: MIT
"""Interactive sessions."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import TracebackType
from typing import Any

import numpy as np

from . import _arrays, _options
from ._arrays import Array, ArrayLike, Floats
from ._call import ProgressLike, conclude, control, named, shown
from ._native import native
from ._results import Frame
from ._trace import EnergyLike
from .errors import ParameterError

_KINDS = {"map": ("MapSession", 2), "plane": ("MapSession", 2), "volume": ("VolumeSession", 3), "shell": ("ShellSession", 3)}


class Session:
    """A map, or a shape, that stays open: pins come, move and go, and each call of `solve` goes on from the last map.

    Parameters
    ----------
    V, C : array-like
        A surface, or a volume of tetrahedra.
    kind : {"map", "plane", "volume", "shell"}, optional
        A map of a surface to the plane, a mesh of the plane that deforms, a volume, a surface in space. Without it:
        "volume" for tetrahedra, else "map".
    b, bc, springs, energy, weights, attributes, directions, parameters
        As in `unwrap`.
    initial : (n, 2) or (n, 3) array-like, optional
        The map, or the shape, to begin with: not of a shell.
    thickness : float, optional
        Of a shell.
    time_limit : float, optional
        Of the first map.

    Examples
    --------
    >>> import numpy as np, taut
    >>> V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
    >>> with taut.Session(V, [[0, 1, 2], [0, 2, 3]]) as s:
    ...     first = s.solve()
    ...     frame = s.pin(0, first.x[0]).pin(2, first.x[2] + 0.1).solve(time=0.015)
    >>> bool((frame.x[2] == first.x[2] + 0.1).all())
    True
    """

    def __init__(
        self,
        V: ArrayLike,
        C: ArrayLike,
        *,
        kind: str | None = None,
        energy: EnergyLike = "isometric",
        b: ArrayLike = None,
        bc: ArrayLike = None,
        springs: Any = None,
        initial: ArrayLike = None,
        weights: ArrayLike = None,
        attributes: ArrayLike = None,
        directions: ArrayLike = None,
        parameters: ArrayLike = (),
        thickness: float | None = None,
        precision: str = "auto",
        time_limit: float | None = None,
        device: Any = None,
    ) -> None:
        shape = _arrays.shape(C)
        corners = shape[1] if len(shape) == 2 else 0
        if kind is None:
            kind = "volume" if corners == 4 else "map"
        if not isinstance(kind, str) or kind not in _KINDS:
            raise ParameterError(f"kind: is {kind!r}, but must be one of {', '.join(_KINDS)}", field="kind")
        name, self.dim = _KINDS[kind]
        shell = kind == "shell"
        unused: dict[str, Any] = {"thickness": None if shell else thickness}
        if shell:
            unused |= {"initial": initial, "weights": weights, "attributes": attributes, "directions": directions,
                       "energy": None if isinstance(energy, str) and energy == "isometric" else energy,
                       "parameters": None if _arrays.shape(parameters) == (0,) else parameters}
        for name_of, value in unused.items():
            if value is not None:
                raise ParameterError(f'{name_of}: has no effect with kind="{kind}"', field=name_of)
        points = _arrays.points("V", V, (2, 3) if self.dim == 2 else (3,))
        cells = _arrays.indices("C", C, (4,) if kind == "volume" else (3,), len(points))
        options = {
            **_options.pins(b, bc, springs, len(points), self.dim),
            "precision": precision,
            "time_limit": time_limit,
            "thickness": thickness,
            "planar": kind == "plane",
            "device": _options.device(device),
        }
        if not shell:
            options.update(
                _options.energies(energy, self.dim, len(cells), weights, attributes, directions, parameters)
            )
            if initial is not None:
                options["initial"] = _arrays.points("initial", initial, (self.dim,), rows=len(points))
        self._count = len(points)
        self._frame: Frame | None = None
        with named({}):
            self._open: Any = getattr(native(), name)(points, cells, options)

    def __enter__(self) -> Session:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Lets go of the device. Frames stay."""
        self._open = None

    @property
    def _session(self) -> Any:
        if self._open is None:
            raise ParameterError("the session is closed; open another one", field="session")
        return self._open

    @property
    def x(self) -> Any:
        """The points of the last frame, to be read only; None before there was one."""
        return None if self._frame is None else self._frame.x

    @property
    def frame(self) -> Frame | None:
        """The last frame."""
        return self._frame

    @property
    def pins(self) -> Array:
        """The vertices that are pinned."""
        pinned: Array = self._session.pins()
        return pinned

    def _vertex(self, v: int) -> int:
        if _arrays.shape(v):
            raise ParameterError("v: is an array, but must be one vertex; move() takes several", field="v")
        return _arrays.vertex("v", v, self._count)

    def _place(self, x: ArrayLike, nan: bool = False) -> Floats:
        """Coordinates of one vertex."""
        place = _arrays.array("x", x)
        if place.shape not in ((self.dim,), (1, self.dim)):
            raise ParameterError(f"x: has the shape {place.shape}, but must be ({self.dim},)", field="x")
        rows = place.reshape(1, -1)
        row: Floats = (_arrays.pins if nan else _arrays.points)("x", rows, (self.dim,))[0]
        return row

    def pin(self, v: int, x: ArrayLike) -> Session:
        """Pins a vertex to a place, or moves its pin there; a coordinate that is NaN is left as it is."""
        vertex = self._vertex(v)
        place = self._place(x, nan=True)
        if np.isnan(place).any():
            for k in np.flatnonzero(~np.isnan(place)):
                self._session.pin_coordinate(vertex, int(k), float(place[k]))
        else:
            self._session.pin(vertex, place)
        return self

    def pin_u(self, v: int, u: float) -> Session:
        """Pins the first coordinate of a vertex alone."""
        self._session.pin_coordinate(self._vertex(v), 0, _arrays.number("u", u))
        return self

    def pin_v(self, v: int, value: float) -> Session:
        """Pins the second coordinate of a vertex alone."""
        self._session.pin_coordinate(self._vertex(v), 1, _arrays.number("value", value))
        return self

    def move(self, vs: ArrayLike, xs: ArrayLike | Callable[[Any], Any]) -> Session:
        """Pins vertices to one place each, or to where a function takes their places in the last map."""
        vertices = _arrays.ids("vs", vs, self._count)
        if callable(xs):
            if self._frame is None:
                raise ParameterError("xs: there is no map yet that a function could move; call solve() first", field="xs")
            xs = xs(self._frame.x[vertices])
        self._session.move(vertices, _arrays.points("xs", xs, (self.dim,), rows=len(vertices)))
        return self

    def spring(self, v: int, x: ArrayLike, weight: float) -> Session:
        """Draws a vertex to a place, instead of another spring that it has."""
        vertex = self._vertex(v)
        place = self._place(x)
        self._session.spring(vertex, place, _arrays.number("weight", weight))
        return self

    def release(self, vs: ArrayLike = None) -> Session:
        """Takes back pins and springs of vertices; without an argument, all."""
        if vs is None:
            self._session.release_all()
        else:
            for v in _arrays.ids("vs", vs if _arrays.shape(vs) else [vs], self._count):
                self._session.release(int(v))
        return self

    def snapshot(self) -> Any:
        """Pins, springs and map of now, for `restore`."""
        return self._session.snapshot(), self._frame

    def restore(self, snapshot: Any) -> Session:
        """Goes back to a snapshot of this session."""
        if not isinstance(snapshot, tuple) or len(snapshot) != 2:
            raise ParameterError(f"snapshot: is {snapshot!r}, but must be what snapshot() returned", field="snapshot")
        try:
            self._session.restore(snapshot[0])
        except TypeError:
            raise ParameterError("snapshot: is none that snapshot() returned", field="snapshot") from None
        self._frame = snapshot[1]
        return self

    def solve(self, *, time: float | None = None, steps: int | None = None, progress: ProgressLike = None) -> Frame:
        """Goes on for so many seconds or steps, at least a step; without them until it has converged.

        progress : callable or True, optional
            As in `unwrap`.

        Raises
        ------
        NoMap, Infeasible
            Where there is no map at all. Pins that cannot be reached are told by the frame.
        Interrupted
            At Ctrl-C; `best` is the frame of then.
        """
        def make(d: dict[str, Any]) -> Frame:
            self._frame = Frame.of(d)
            return self._frame

        seconds = math.inf if time is None else _arrays.number("time", time)
        most = 0 if steps is None else _arrays.whole("steps", steps, 1, cap=True)
        with shown(progress) as line:
            told = self._session.solve(seconds, most, line, control())
        return conclude(told, make)
