# SPDX-License-Identifier: MIT
"""Where the charts of an atlas lie: at a texel density that is asked for, on as many tiles as that takes."""

from __future__ import annotations

import numpy as np

from .islands import roots
from .plane import areas, signed_areas
from .surface import Surface
from .work import Clock

_MOST_TILES = 100


def welded(faces: np.ndarray, label: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles whose vertices are parted where labels differ, and the old vertex of each new one."""
    m = len(faces)
    ends = np.sort(np.stack([faces, np.roll(faces, -1, 1)], 2).reshape(-1, 2), 1)
    order = np.lexsort((np.repeat(label, 3), ends[:, 1], ends[:, 0]))
    same = (ends[order[1:]] == ends[order[:-1]]).all(1) & (label[order[1:] // 3] == label[order[:-1] // 3])
    a, b = order[:-1][same], order[1:][same]
    after = lambda side: side // 3 * 3 + (side + 1) % 3
    old = faces.reshape(-1)
    pairs = []
    for p in (a, after(a)):
        q = np.where(old[p] == old[b], b, after(b))
        pairs.append(np.c_[p, q])
    root = roots(3 * m, np.concatenate(pairs))
    kept, new = np.unique(root, return_inverse=True)
    return new.reshape(m, 3), old[kept]


class Layout:
    """The charts of an atlas.

    Attributes
    ----------
    uv, faces : (N, 2) float64, (m, 3) int64
        Points, and the triangles that the atlas was made of.
    tile, area : (m,) int64 and float64
        Of each triangle: its tile, its area in space.
    notes : list of str
    """

    def __init__(
        self,
        taut,
        s: Surface,
        made,
        some: np.ndarray,
        pinned: np.ndarray,
        clock: Clock,
        padding: float,
        resolution: int,
        tiles: int,
        rotate: bool,
    ) -> None:
        self._taut, self._clock = taut, clock
        self._padding, self._resolution, self._tiles, self._rotate = padding, resolution, tiles, rotate
        self.area = areas(s.V, s.vertex[s.triangles[some]])
        self._polygon = s.triangle_face[some]
        self._factors = None
        self._own = made.chart >= 0
        self._moves = self._own & ~pinned
        self.uv, self.faces, self.tile, self.notes = made.uv.copy(), made.faces.copy(), made.tile.copy(), []

    def charts(self) -> int:
        return len(np.unique(self._chart()[self._own]))

    def scale(self) -> float:
        """Lengths in the plane by lengths in space, of what is not pinned."""
        flat = np.abs(signed_areas(self.uv, self.faces))
        return float(np.sqrt(flat[self._moves].sum() / self.area[self._moves].sum()))

    def repack(self, factors: np.ndarray | None = None, padding: float | None = None, tiles: int | None = None) -> None:
        """Packs the charts anew; factors : of lengths of triangles."""
        self._factors = self._factors if factors is None else factors
        self._tiles = tiles or self._tiles
        own = self._own
        packed = self._taut.pack(
            self.uv,
            self.faces[own],
            fixed=~self._moves[own] if (own & ~self._moves).any() else None,
            padding=self._padding if padding is None else padding,
            resolution=self._resolution,
            tiles=self._tiles,
            rotate=self._rotate,
            densities=None if factors is None else factors[own],
            time_limit=self._clock.left,
        )
        self.uv = packed.uv
        self.tile[own] = packed.tile

    def to_density(self, density: float) -> None:
        """Makes the scale what is asked: charts that no tile has room for are divided, and tiles are added."""
        target = density / self._resolution
        room = 1 - 2 * self._padding / self._resolution
        for most in (0.7, 0.6, 0.5, 0.4):
            self._divide(most * room * self.scale() / target)
            wanted = self.area[self._moves].sum() * target**2 / 0.65
            if self.scale() < target:
                self.repack(tiles=int(np.clip(np.ceil(wanted), self._tiles, _MOST_TILES)))
            while self.scale() < target and self._tiles < _MOST_TILES and self._used() == self._tiles:
                more = int(np.ceil(self._tiles * (target / self.scale()) ** 2))
                self.repack(tiles=min(max(more, self._tiles + 1), _MOST_TILES))
            if self.scale() >= target or self._tiles >= _MOST_TILES:
                break
        if self.scale() < target:
            why = "all tiles are full" if self._used() >= _MOST_TILES else "the largest face fills a tile"
            self.notes.append(f"{self.scale() * self._resolution:.4g} texels per unit, as {why}; raise the resolution")
            return
        # Charts are made smaller, and so are the distances between them: they are packed farther apart before.
        before = self.uv, self.tile.copy()
        self.repack(padding=self._padding * self.scale() / target)
        if self.scale() < target:
            self.uv, self.tile = before
        self._shrink(target / self.scale())
        if self._used() > 1:
            self.notes.append(f"{self._used()} tiles hold {density:.4g} texels per unit")

    def _chart(self) -> np.ndarray:
        """A number of the chart of each triangle."""
        pairs = np.concatenate([self.faces[:, [0, 1]], self.faces[:, [0, 2]]])
        return roots(len(self.uv), pairs)[self.faces[:, 0]]

    def _used(self) -> int:
        return len(np.unique(self.tile[self._own]))

    def _shrink(self, factor: float) -> None:
        """Scales what is not pinned about the lower left corner of its tile."""
        ours = self._moves
        moved = np.zeros(len(self.uv), bool)
        corner = np.zeros((len(self.uv), 2))
        moved[self.faces[ours]] = True
        corner[self.faces[ours]] = np.c_[self.tile[ours] % 10, self.tile[ours] // 10][:, None]
        self.uv[moved] = corner[moved] + (self.uv[moved] - corner[moved]) * factor

    def _divide(self, most: float) -> None:
        """Divides charts that are longer, between polygons, across their longest direction. Maps stay as they are."""
        centre = self.uv[self.faces].mean(1)
        count = np.zeros(self._polygon.max() + 1)
        sums = np.zeros((len(count), 2))
        np.add.at(count, self._polygon, 1)
        np.add.at(sums, self._polygon, centre)
        centre = sums[self._polygon] / count[self._polygon][:, None]
        label = self._chart()
        waiting = [own for k in np.unique(label[self._moves]) for own in [np.flatnonzero((label == k) & self._moves)]]
        new = len(self.uv)
        while waiting:
            own = waiting.pop()
            points = self.uv[self.faces[own].reshape(-1)]
            spread = np.linalg.eigh(np.cov((points - points.mean(0)).T))[1][:, 1]
            along = points @ spread
            if np.ptp(along) <= most or len(np.unique(self._polygon[own])) < 2:
                continue
            at = centre[own] @ spread
            far = at > (along.max() + along.min()) / 2
            if far.all() or not far.any():
                continue
            label[own[far]] = new
            new += 1
            waiting += [own[far], own[~far]]
        self.faces, old = welded(self.faces, label)
        self.uv = self.uv[old]
