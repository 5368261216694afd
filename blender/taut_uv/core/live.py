# SPDX-License-Identifier: MIT
"""Live: UV vertices are dragged, and their islands follow in interactive sessions of taut."""

from __future__ import annotations

import numpy as np

from .islands import Island, islands_of
from .messages import Trouble, about_faces, explained
from .plane import in_single, mirrored, orientation, signed_areas
from .relax import island_scales
from .surface import Surface


class _Held:
    """An island that is open in a session."""

    def __init__(self, taut, s: Surface, island: Island, grabbed: np.ndarray, scale: float) -> None:
        self._taut, self._surface = taut, s
        self.island, self.grabbed = island, np.flatnonzero(grabbed)
        self.before = self._shown = island.of_corners(s.uv)
        if not scale > 0 or not np.isfinite(self.before).all():
            raise Trouble(about_faces(s, island.faces, "UVs without an area; unwrap them first"))
        self._mirror = signed_areas(self.before, island.F).sum() < 0
        x = mirrored(self.before) if self._mirror else self.before
        wrong = orientation(x, island.F) <= 0
        if wrong.any():
            raise Trouble(
                about_faces(
                    s,
                    s.triangle_face[island.triangles[wrong]],
                    "flipped UVs, which Live cannot drag; Relax or Unwrap them first",
                )
            )
        pinned = np.setdiff1d(np.flatnonzero(island.any_corner(s.pinned)), self.grabbed)
        if len(pinned) == 0:  # else a dragged vertex would take the whole island with it
            away = np.linalg.norm(x - x[self.grabbed].mean(0), axis=1)
            pinned = np.setdiff1d([int(away.argmax())], self.grabbed)
        self.pinned = pinned
        self.x = x
        self._start = x[self.grabbed].copy()
        try:
            self._session = taut.Session(island.V * scale, island.F, initial=x, b=pinned, bc=x[pinned])
            self._session.move(self.grabbed, self._start)
            self.x = self._session.solve(steps=1).x
        except taut.TautError as e:
            raise Trouble(explained(e, s, island)) from e

    def frame(self, shift: np.ndarray, seconds: float | None) -> tuple[float, str]:
        """Moves what is grabbed to where it began, plus a shift, and goes on for so long. How far it is from there, and
        why, where it cannot get there."""
        step = shift * [-1, 1] if self._mirror else shift
        target = (self._start + step).astype(np.float32).astype(np.float64)
        reason = ""
        try:
            self._session.move(self.grabbed, target)
            made = self._session.solve(time=seconds)
            self.x, reason = made.x, made.reason
        except self._taut.NoMap as e:  # the last map stays
            reason = explained(e, self._surface, self.island).message
        return float(np.linalg.norm(self.x[self.grabbed] - target, axis=1).max()), reason

    def rounded(self) -> np.ndarray:
        """The map as single precision holds it; the last one that it held where rounding would flatten a triangle."""
        fixed = np.zeros(self.x.shape, bool)
        fixed[self.pinned] = True
        y, flat = in_single(self.x, self.island.F, fixed)
        self.coarse = len(flat) > 0
        if not self.coarse:
            self._shown = mirrored(y) if self._mirror else y
        return self._shown

    def behind(self, shift: np.ndarray) -> float:
        """How far what is shown of what is grabbed is from there."""
        return float(np.linalg.norm(self._shown[self.grabbed] - self.before[self.grabbed] - shift, axis=1).max())

    def close(self) -> None:
        self._session.close()


class Drag:
    """Grabbed corners that follow the mouse, and islands that follow these. No frame has a flipped triangle.

    Attributes
    ----------
    corners : (k,) int64
        Corners of the islands that take part.
    distance : float
        How far what is grabbed is behind the mouse after the last frame; it comes nearer with each.
    """

    def __init__(self, taut, s: Surface, grabbed: np.ndarray) -> None:
        """grabbed : (c,) bool, corners that are dragged. Pinned corners stay; where an island has none, the vertex that
        is farthest from what is grabbed."""
        self._surface = s
        sizes = island_scales(s)
        islands = [i for i in islands_of(s, np.ones(s.faces, bool), by_uv=True) if grabbed[i.corners].any()]
        if not islands:
            raise Trouble("no UV vertex is selected; select those to be dragged")
        self._held = [_Held(taut, s, i, i.any_corner(grabbed), sizes[i.faces[0]]) for i in islands]
        self.corners = np.concatenate([h.island.corners for h in self._held])
        self.distance, self.reason = 0.0, ""

    def frame(self, shift, seconds: float | None = 0.012) -> np.ndarray:
        """What one frame does: (k, 2) coordinates of `corners`, for a mouse that is at `shift` from where it began.
        seconds : for all islands together; None: until they have converged"""
        shift = np.asarray(shift, dtype=np.float64)
        share = None if seconds is None else seconds / len(self._held)
        self.distance, self.reason = 0.0, ""
        for held in self._held:
            distance, reason = held.frame(shift, share)
            self.distance, self.reason = max(self.distance, distance), self.reason or reason
        shown = self.coordinates()
        for held in self._held:
            if held.coarse:
                self.distance = max(self.distance, held.behind(shift))
                self.reason = self.reason or "too small for the numbers of UV maps; scale the island up"
        return shown

    def finish(self, shift, seconds: float = 2.0) -> np.ndarray:
        """The last frame, with more time."""
        return self.frame(shift, seconds)

    def coordinates(self) -> np.ndarray:
        return np.concatenate([h.rounded()[h.island.local] for h in self._held])

    def before(self) -> np.ndarray:
        """The coordinates of the beginning, bit for bit."""
        return self._surface.uv[self.corners]

    def close(self) -> None:
        for held in self._held:
            held.close()
