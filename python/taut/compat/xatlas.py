# SPDX-License-Identifier: MIT
"""The interface of the package xatlas: `import taut.compat.xatlas as xatlas` is the whole migration.

Names, arguments, shapes and types are those of xatlas 0.0.11. Charts and packing are taut's, so counts differ, normals
have no effect, nor options that only say how xatlas finds its charts, of which a warning tells. Long calls can be
interrupted, and an atlas is certified: no triangle is flipped, no two overlap. Where xatlas makes charts smaller that
are larger than a page, taut cuts them.

>>> import numpy as np
>>> import taut.compat.xatlas as xatlas
>>> V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
>>> vmapping, indices, uvs = xatlas.parametrize(V, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
>>> vmapping.dtype, indices.shape, uvs.dtype
(dtype('uint32'), (4, 3), dtype('float32'))
"""

from __future__ import annotations

import enum
import warnings
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from .._atlas import atlas as _make
from .._atlas import _split
from .._files import write_bytes
from .._results import Atlas as _Made

Uints = npt.NDArray[np.uint32]
Singles = npt.NDArray[np.float32]


class ChartType(enum.Enum):
    """How xatlas made a chart; those of taut are all `Piecewise`."""

    Planar = 0
    Ortho = 1
    LSCM = 2
    Piecewise = 3
    Invalid = 4


@dataclass
class Chart:
    """A chart: its faces, where it is, what it is of."""

    faces: Uints
    atlas_index: int
    type: ChartType = ChartType.Piecewise
    material: int = 0


@dataclass
class ChartOptions:
    """How charts are made. `max_cost` above 2 allows for more distortion, and so fewer charts; below, for less."""

    max_chart_area: float = 0.0
    max_boundary_length: float = 0.0
    normal_deviation_weight: float = 2.0
    roundness_weight: float = 0.01
    straightness_weight: float = 6.0
    normal_seam_weight: float = 4.0
    texture_seam_weight: float = 0.5
    max_cost: float = 2.0
    max_iterations: int = 1
    use_input_mesh_uvs: bool = False
    fix_winding: bool = False

    def _options(self) -> dict[str, Any]:
        factor = self.max_cost / 2.0
        if factor == 1.0:
            return {}
        return {"max_distortion": 4 + 0.2 * factor, "mean_distortion": 4 + 0.045 * factor}


@dataclass
class PackOptions:
    """How charts are packed: at `texels_per_unit`, if given, on as many pages of `resolution` texels as that takes, or
    on one of any size; else on one page of `resolution`, or 1024, texels, which they fill. Charts larger than
    `max_chart_size` texels become smaller."""

    max_chart_size: int = 0
    padding: int = 0
    texels_per_unit: float = 0.0
    resolution: int = 0
    bilinear: bool = True
    blockAlign: bool = False
    bruteForce: bool = False
    create_image: bool = False
    rotate_charts_to_axis: bool = True
    rotate_charts: bool = True

    def _options(self) -> dict[str, Any]:
        return {
            "resolution": self.resolution or 1024,
            "padding": self.padding + (1 if self.bilinear else 0),
            "rotate": self.rotate_charts,
            "align": 4 if self.blockAlign else 1,
        }


#: Options that say how xatlas goes about it, and nothing here.
_UNUSED = ("max_chart_area", "max_boundary_length", "normal_deviation_weight", "roundness_weight",
           "straightness_weight", "normal_seam_weight", "texture_seam_weight", "max_iterations", "bruteForce",
           "rotate_charts_to_axis")


def _tell_unused(*given: Any) -> None:
    names = [f.name for g in given for f in fields(g) if f.name in _UNUSED and getattr(g, f.name) != f.default]
    if names:
        warnings.warn(f"{', '.join(names)}: no effect in taut", stacklevel=3)


def _rows(what: str, value: Any, columns: int, dtype: Any, count: int | None = None) -> Any:
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{what} array has masked numbers; fill them in, or leave them out.")
    a = np.asarray(value)
    if a.ndim != 2 or a.shape[1] != columns:
        raise ValueError(f"{what} array expected to be Nx{columns}.")
    if count is not None and len(a) != count:
        raise ValueError(
            f"{what} array has invalid number of elements in the first dimension (expected {count}, got {len(a)})"
        )
    if np.issubdtype(dtype, np.integer) and a.size:
        with np.errstate(invalid="ignore"):
            if a.dtype.kind not in "iuf" or (a != np.floor(a)).any():
                raise ValueError(f"{what} array has numbers that are no indices.")
    elif a.dtype.kind == "c":
        raise ValueError(f"{what} array has complex numbers.")
    return np.ascontiguousarray(a, dtype=dtype)


@dataclass
class _Input:
    points: Any
    faces: Any
    uvs: Any = None
    materials: Any = None
    pack_only: bool = False


class Atlas:
    """Meshes that get one atlas."""

    def __init__(self) -> None:
        self._inputs: list[_Input] = []
        self._made: list[_Made] = []
        self._whole: _Made | None = None
        self._resolution = 0
        self._images: list[Any] = []

    def add_mesh(self, positions: Any, indices: Any, normals: Any = None, uvs: Any = None) -> None:
        points = _rows("Position", positions, 3, np.float64)
        faces = _rows("Index", indices, 3, np.int64)
        if normals is not None:
            _rows("Normal", normals, 3, np.float32, len(points))
        if uvs is not None:
            uvs = _rows("UV", uvs, 2, np.float64, len(points))
        self._add(_Input(points, faces, uvs))

    def add_uv_mesh(self, uvs: Any, indices: Any, face_materials: Any = None) -> None:
        """Charts that are there already, and are only packed: triangles that share vertices, of one material."""
        points = _rows("UV", uvs, 2, np.float64)
        faces = _rows("Index", indices, 3, np.int64)
        materials = None if face_materials is None else np.asarray(face_materials, dtype=np.uint32).reshape(-1)
        if materials is not None and len(materials) != len(faces):
            raise ValueError(
                "Material array has invalid number of elements in the first dimension "
                f"(expected {len(faces)}, got {len(materials)})"
            )
        self._add(_Input(points, faces, points, materials, pack_only=True))

    def _add(self, mesh: _Input) -> None:
        if len(mesh.faces) == 0:
            raise RuntimeError("Adding mesh failed: Invalid index count")
        if mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.points):
            raise RuntimeError("Adding mesh failed: Index out of range")
        if any(other.pack_only != mesh.pack_only for other in self._inputs):
            raise RuntimeError("Adding mesh failed: Meshes and UV meshes cannot be added to the same atlas.")
        self._inputs.append(mesh)
        self._made, self._whole, self._images = [], None, []

    def generate(
        self, chart_options: ChartOptions | None = None, pack_options: PackOptions | None = None, verbose: bool = False
    ) -> None:
        """Makes the atlas. It can be interrupted: `taut.Interrupted`."""
        if not self._inputs:
            print("Generate: No meshes. Call AddMesh or AddUvMesh first.")
            return
        charts, packing = chart_options or ChartOptions(), pack_options or PackOptions()
        _tell_unused(charts, packing)
        options = {**charts._options(), **packing._options(), "single": True, "progress": verbose or None}
        density = packing.texels_per_unit
        if packing.max_chart_size > 0:
            whole = self._within(packing, self._call(charts, options), options)
        else:
            area = sum(float(_areas(i.points, i.faces).sum()) for i in self._inputs)
            pages = self._pages(density, area, packing.resolution, options["padding"]) if density > 0 else {}
            whole = self._call(charts, {**options, **pages})
        self._resolution = whole.report["resolution"]
        self._whole = whole = self._on_pages(whole)
        self._made = _split(whole, [len(i.points) for i in self._inputs], [len(i.faces) for i in self._inputs])
        self._images = [self._draw(whole, k) for k in range(self.atlas_count)] if packing.create_image else []

    @staticmethod
    def _pages(density: float, area: float, resolution: int, padding: int) -> dict[str, Any]:
        """Pages for charts of so much area at a density in texels."""
        if resolution > 0:
            return {"texels_per_unit": density, "tiles": 1000}
        start = int(np.clip(1.25 * density * float(np.sqrt(area)) + 4 * padding, 64, 65536))
        return {"texels_per_unit": density, "resolution": start, "max_resolution": 65536}

    def _call(self, charts: ChartOptions, options: dict[str, Any]) -> _Made:
        """Charts that are given are packed, others are made, each mesh by its own."""
        given = [i.pack_only or charts.use_input_mesh_uvs and i.uvs is not None for i in self._inputs]
        if not any(given):
            points, faces = _joined(self._inputs)
            made: _Made = _make(points, faces, bodies=self._bodies(), **options)
            return made
        corners: list[Any] = []
        parts: list[Any] = []
        for mesh, known in zip(self._inputs, given):
            if known:
                uv = mesh.uvs[mesh.faces]
                of = mesh.materials if mesh.materials is not None else np.zeros(len(mesh.faces))
                turned = np.sign((uv[:, 1, 0] - uv[:, 0, 0]) * (uv[:, 2, 1] - uv[:, 0, 1])
                                 - (uv[:, 1, 1] - uv[:, 0, 1]) * (uv[:, 2, 0] - uv[:, 0, 0]))
                part = np.unique(np.c_[of, turned], axis=0, return_inverse=True)[1].reshape(-1)
            else:
                alone = _make(mesh.points, mesh.faces, **options)
                uv, part = alone.corner_uv, alone.chart
            corners.append(uv)
            parts.append(part + (parts[-1].max() + 1 if parts else 0))
        return self._pack(np.concatenate(corners), np.concatenate(parts), options)

    def _pack(self, uv: Any, parts: Any, options: dict[str, Any]) -> _Made:
        """Charts as they lie in `uv`, packed. Where vertices are in space, what no surface can have is left out."""
        points, faces = _joined(self._inputs)
        made: _Made = _make(points, faces, **{**options, "charts": "pack", "uv": uv, "parts": parts,
                                              "bodies": self._bodies(), "repair": not self._inputs[0].pack_only})
        return made

    def _bodies(self) -> Any:
        return np.repeat(np.arange(len(self._inputs)), [len(i.points) for i in self._inputs])

    def _within(self, packing: PackOptions, whole: _Made, options: dict[str, Any]) -> _Made:
        """The charts of an atlas, of at most so many texels along a side, packed at a density, or at that which it has."""
        known = whole.chart >= 0
        low, high = np.full((whole.charts, 2), np.inf), np.full((whole.charts, 2), -np.inf)
        np.minimum.at(low, whole.chart[known], whole.corner_uv[known].min(1))
        np.maximum.at(high, whole.chart[known], whole.corner_uv[known].max(1))
        scale = self._scale(whole)
        density = packing.texels_per_unit or whole.report["resolution"] * scale
        factor = np.minimum(1, packing.max_chart_size / np.maximum((high - low).max(1) / scale * density, 1e-300))
        factors = np.append(factor, 1.0)[whole.chart]
        a, b, c = np.moveaxis(whole.corner_uv / scale * factors[:, None, None], 1, 0)
        area = 0.5 * float(np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])[known].sum())
        return self._pack(whole.corner_uv, whole.chart, {
            **options, **self._pages(density, area, packing.resolution, options["padding"]),
            "rotate": False, "densities": factors})

    @staticmethod
    def _on_pages(whole: _Made) -> _Made:
        """With coordinates within each page. Exact: they are singles, and pages whole numbers."""
        page = np.zeros(len(whole.uv), dtype=np.int64)
        page[whole.faces.reshape(-1)] = np.repeat(np.maximum(whole.tile, 0), 3)
        return replace(whole, uv=whole.uv - np.c_[page % 10, page // 10])

    def _scale(self, whole: _Made) -> float:
        """Lengths in the atlas by lengths of the meshes."""
        flat = float(_areas(whole.uv, whole.faces).sum())
        rest = sum(float(_areas(i.points, i.faces).sum()) for i in self._inputs)
        return float(np.sqrt(flat / rest)) if rest > 0 else 1.0

    def _mesh(self, mesh_index: int) -> _Made:
        if not 0 <= mesh_index < len(self._made):
            raise IndexError(f"Mesh index {mesh_index} out of bounds for atlas with {len(self._made)} meshes.")
        return self._made[mesh_index]

    def get_mesh(self, mesh_index: int) -> tuple[Uints, Uints, Singles]:
        made = self._mesh(mesh_index)
        return made.vmapping.astype(np.uint32), made.faces.astype(np.uint32), made.uv.astype(np.float32)

    def __getitem__(self, mesh_index: int) -> tuple[Uints, Uints, Singles]:
        return self.get_mesh(mesh_index)

    def __len__(self) -> int:
        return self.mesh_count

    def get_mesh_vertex_assignment(self, mesh_index: int) -> tuple[Uints, Uints]:
        """Atlas and chart of each vertex."""
        made = self._mesh(mesh_index)
        page, chart = np.zeros((2, len(made.uv)), dtype=np.int64)
        page[made.faces.reshape(-1)] = np.repeat(np.maximum(made.tile, 0), 3)
        chart[made.faces.reshape(-1)] = np.repeat(self._local(made), 3)
        return page.astype(np.uint32), chart.astype(np.uint32)

    @staticmethod
    def _local(made: _Made) -> Any:
        """Charts of a mesh, counted from 0."""
        return np.unique(made.chart, return_inverse=True)[1].reshape(-1)

    def get_mesh_chart_count(self, mesh_index: int) -> int:
        return len(np.unique(self._mesh(mesh_index).chart))

    def get_mesh_chart(self, mesh_index: int, chart_index: int) -> Chart:
        made = self._mesh(mesh_index)
        count = self.get_mesh_chart_count(mesh_index)
        if not 0 <= chart_index < count:
            raise IndexError(f"Chart index {chart_index} out of bounds for mesh with {count} charts.")
        faces = np.flatnonzero(self._local(made) == chart_index).astype(np.uint32)
        materials = self._inputs[mesh_index].materials
        return Chart(faces, max(int(made.tile[faces[0]]), 0), material=0 if materials is None else int(materials[faces[0]]))

    @property
    def mesh_count(self) -> int:
        return len(self._made)

    @property
    def atlas_count(self) -> int:
        return int(self._whole.tile.max()) + 1 if self._whole is not None else 0

    @property
    def chart_count(self) -> int:
        return self._made[0].charts if self._made else 0

    @property
    def width(self) -> int:
        return self._resolution if self._made else 0

    @property
    def height(self) -> int:
        return self.width

    @property
    def texels_per_unit(self) -> float:
        return self._resolution * self._scale(self._whole) if self._whole is not None else 0.0

    @property
    def utilization(self) -> float:
        return self.get_utilization(0) if self._made else 0.0

    def get_utilization(self, atlas_index: int) -> float:
        self._atlas(atlas_index)
        assert self._whole is not None
        return float(_areas(self._whole.uv, self._whole.faces[self._whole.tile == atlas_index]).sum())

    @property
    def chart_image(self) -> npt.NDArray[np.uint8]:
        return self.get_chart_image(0)

    def get_chart_image(self, atlas_index: int) -> npt.NDArray[np.uint8]:
        self._atlas(atlas_index)
        if not self._images:
            raise RuntimeError("The atlas does not have an image.")
        image: npt.NDArray[np.uint8] = self._images[atlas_index]
        return image

    def _atlas(self, atlas_index: int) -> None:
        if not 0 <= atlas_index < self.atlas_count:
            raise IndexError(f"Atlas index {atlas_index} out of bounds.")

    def _draw(self, whole: _Made, page: int) -> Any:
        """Charts of a page in colours of their own: a texel is of the triangle that has its centre."""
        n = self._resolution
        image = np.zeros((n, n, 3), dtype=np.uint8)
        colours = np.random.default_rng(1).integers(64, 256, (whole.charts + 1, 3), dtype=np.uint8)
        own = whole.tile == page
        for (a, b, c), chart in zip(whole.uv[whole.faces[own]] * n, whole.chart[own]):
            low = np.maximum(np.floor(np.minimum(np.minimum(a, b), c)).astype(int), 0)
            high = np.minimum(np.ceil(np.maximum(np.maximum(a, b), c)).astype(int), n)
            x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
            inside = np.ones(x.shape, dtype=bool)
            for p, q in ((a, b), (b, c), (c, a)):
                inside &= (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) >= 0
            image[low[1] : high[1], low[0] : high[0]][inside] = colours[chart]
        return image


def _joined(inputs: list[_Input]) -> tuple[Any, Any]:
    """Meshes as one, one behind the other."""
    first = np.cumsum([0] + [len(i.points) for i in inputs])
    points = np.concatenate([np.pad(i.points, ((0, 0), (0, 3 - i.points.shape[1]))) for i in inputs])
    return points, np.concatenate([i.faces + f for i, f in zip(inputs, first)])


def _areas(points: Any, faces: Any) -> Any:
    """Of triangles of points of 2 or 3 coordinates."""
    a, b, c = (np.pad(points, ((0, 0), (0, 3 - points.shape[1])))[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def parametrize(positions: Any, indices: Any, normals: Any = None, uvs: Any = None) -> tuple[Uints, Uints, Singles]:
    """An atlas of a mesh: vertices of the mesh (N), indices (F, 3), texture coordinates (N, 2)."""
    made = Atlas()
    made.add_mesh(positions, indices, normals, uvs)
    made.generate()
    return made.get_mesh(0)


def export(path: Any, positions: Any, indices: Any = None, uvs: Any = None, normals: Any = None) -> None:
    """Writes an OBJ file."""
    with np.errstate(over="ignore"):  # is said of the array
        points = _rows("Position", positions, 3, np.float32)
        vn = None if normals is None else _rows("Normal", normals, 3, np.float32, len(points))
        vt = None if uvs is None else _rows("UV", uvs, 2, np.float32, len(points))
    if not all(np.isfinite(a).all() for a in (points, vn, vt) if a is not None):
        raise ValueError("Positions, normals and UVs must be finite, as float32, too.")
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points]
    if vn is not None:
        lines += [f"vn {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vn]
    if vt is not None:
        lines += [f"vt {u:.9g} {v:.9g}" for u, v in vt]
    faces = np.arange(len(points)).reshape(-1, 3) if indices is None else _rows("Index", indices, 3, np.int64)
    if faces.size and (faces.min() < 0 or faces.max() >= len(points)):
        raise ValueError(f"Index array names {faces.min()} to {faces.max()}, but there are {len(points)} positions.")
    form = "{0}/{0}/{0}" if uvs is not None and normals is not None else "{0}/{0}" if uvs is not None \
        else "{0}//{0}" if normals is not None else "{0}"
    lines += ["f " + " ".join(form.format(v + 1) for v in face) for face in faces]
    write_bytes({path: ("\n".join(lines) + "\n").encode()})
