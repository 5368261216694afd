# SPDX-License-Identifier: MIT
"""The interface of the package xatlas: `import taut.compat.xatlas as xatlas` is the whole migration.

Names, arguments, shapes and types are those of xatlas 0.0.11. Charts and packing are taut's, so counts differ, and
options that only say how xatlas finds its charts have no effect. Long calls can be interrupted, and an atlas is
certified: no triangle is flipped, no two overlap.

>>> import numpy as np
>>> import taut.compat.xatlas as xatlas
>>> V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
>>> vmapping, indices, uvs = xatlas.parametrize(V, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
>>> vmapping.dtype, indices.shape, uvs.dtype
(dtype('uint32'), (4, 3), dtype('float32'))
"""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .._atlas import atlas as _make
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
    """How charts are packed, in squares of `resolution` texels, 1024 where neither it nor `texels_per_unit` is given."""

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
        }


def _rows(what: str, value: Any, columns: int, dtype: Any, count: int | None = None) -> Any:
    a = np.asarray(value)
    if a.ndim != 2 or a.shape[1] != columns:
        raise ValueError(f"{what} array expected to be Nx{columns}.")
    if count is not None and len(a) != count:
        raise ValueError(
            f"{what} array has invalid number of elements in the first dimension (expected {count}, got {len(a)})"
        )
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
        self._inputs.append(mesh)
        self._made = []

    def generate(
        self, chart_options: ChartOptions | None = None, pack_options: PackOptions | None = None, verbose: bool = False
    ) -> None:
        """Makes the atlas. It can be interrupted: `taut.Interrupted`."""
        if not self._inputs:
            print("Generate: No meshes. Call AddMesh or AddUvMesh first.")
            return
        charts, packing = chart_options or ChartOptions(), pack_options or PackOptions()
        options = {**charts._options(), **packing._options(), "single": True, "progress": verbose or None}
        self._resolution = options["resolution"]
        whole = self._call(charts, options)
        if packing.texels_per_unit > 0 and packing.resolution == 0:
            self._resolution = min(65536, max(8, int(np.ceil(packing.texels_per_unit / self._scale([whole])))))
            whole = self._call(charts, {**options, "resolution": self._resolution})
        self._made = self._parts(whole)
        self._images = [self._draw(whole)] if packing.create_image else []

    def _call(self, charts: ChartOptions, options: dict[str, Any]) -> _Made:
        first = np.cumsum([0] + [len(i.points) for i in self._inputs])
        width = max(i.points.shape[1] for i in self._inputs)
        points = np.concatenate([np.pad(i.points, ((0, 0), (0, width - i.points.shape[1]))) for i in self._inputs])
        faces = np.concatenate([i.faces + f for i, f in zip(self._inputs, first)])
        if all(i.pack_only or (charts.use_input_mesh_uvs and i.uvs is not None) for i in self._inputs):
            uv = np.concatenate([i.uvs for i in self._inputs])
            options = {**options, "charts": "keep", "uv": uv, "repair": False}
            if any(i.materials is not None for i in self._inputs):
                options["parts"] = np.concatenate(
                    [i.materials if i.materials is not None else np.zeros(len(i.faces)) for i in self._inputs]
                ).astype(np.int64)
        return _make(points, faces, **options)

    def _scale(self, parts: list[_Made]) -> float:
        """Lengths in the atlas by lengths of the meshes."""
        flat = sum(float(_areas(m.uv, m.faces).sum()) for m in parts)
        rest = sum(float(_areas(i.points, i.faces).sum()) for i in self._inputs)
        return float(np.sqrt(flat / rest)) if rest > 0 else 1.0

    def _parts(self, whole: _Made) -> list[_Made]:
        from .._atlas import _split

        return _split(whole, [len(i.points) for i in self._inputs], [len(i.faces) for i in self._inputs])

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
        chart = np.zeros(len(made.uv), dtype=np.int64)
        chart[made.faces.reshape(-1)] = np.repeat(self._local(made), 3)
        return np.zeros(len(made.uv), dtype=np.uint32), chart.astype(np.uint32)

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
        return Chart(faces, 0, material=0 if materials is None else int(materials[faces[0]]))

    @property
    def mesh_count(self) -> int:
        return len(self._made)

    @property
    def atlas_count(self) -> int:
        return 1 if self._made else 0

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
        return self._resolution * self._scale(self._made) if self._made else 0.0

    @property
    def utilization(self) -> float:
        return float(self._made[0].utilization) if self._made else 0.0

    def get_utilization(self, atlas_index: int) -> float:
        self._atlas(atlas_index)
        return self.utilization

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

    def _draw(self, whole: _Made) -> Any:
        """Charts in colours of their own: a texel is of the triangle that has its centre."""
        n = self._resolution
        image = np.zeros((n, n, 3), dtype=np.uint8)
        colours = np.random.default_rng(1).integers(64, 256, (whole.charts + 1, 3), dtype=np.uint8)
        for (a, b, c), chart in zip(whole.uv[whole.faces] * n, whole.chart):
            low = np.maximum(np.floor(np.minimum(np.minimum(a, b), c)).astype(int), 0)
            high = np.minimum(np.ceil(np.maximum(np.maximum(a, b), c)).astype(int), n)
            x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
            inside = np.ones(x.shape, dtype=bool)
            for p, q in ((a, b), (b, c), (c, a)):
                inside &= (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) >= 0
            image[low[1] : high[1], low[0] : high[0]][inside] = colours[chart]
        return image


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
    points = _rows("Position", positions, 3, np.float32)
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in points]
    if normals is not None:
        lines += [f"vn {x:.9g} {y:.9g} {z:.9g}" for x, y, z in _rows("Normal", normals, 3, np.float32, len(points))]
    if uvs is not None:
        lines += [f"vt {u:.9g} {v:.9g}" for u, v in _rows("UV", uvs, 2, np.float32, len(points))]
    faces = np.arange(len(points)).reshape(-1, 3) if indices is None else _rows("Index", indices, 3, np.int64)
    form = "{0}/{0}/{0}" if uvs is not None and normals is not None else "{0}/{0}" if uvs is not None \
        else "{0}//{0}" if normals is not None else "{0}"
    lines += ["f " + " ".join(form.format(v + 1) for v in face) for face in faces]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
