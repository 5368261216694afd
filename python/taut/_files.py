# SPDX-License-Identifier: MIT
"""Files of surfaces, volumes and models."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _arrays, _options
from ._arrays import Array, ArrayLike, Floats, Ints
from ._atlas import _corner_uv
from ._native import native
from ._results import Atlas, Device, Map
from .errors import FileError, ParameterError

PathLike = Union[str, "os.PathLike[str]"]

_SURFACES = (".obj", ".off", ".ply", ".stl")
_MODELS = (".gltf", ".glb")


@dataclass(frozen=True, eq=False)
class Mesh:
    """What a file has. Unpacks as `V, F`, of a volume as `V, C`, where quads lie in a plane V with two columns.

    Attributes
    ----------
    kind : {"surface", "model", "volume"}
    V : (n, 3) float64
    F : (m, 3) int64 or None
        Triangles of a surface or model; polygons are split.
    corner_uv : (m, 3, 2) float64 or None
        Texture coordinates by corner, NaN where there are none.
    polygons : (m,) int64 or None
        The polygon of each triangle, where there are others.
    cells : dict of str to (m, k) int64
        Of a volume: "tetrahedra", "hexahedra", ..., corners in VTK's order.
    groups : dict of str to (k,) int64
        Vertices of what a volume file names.
    notes : list of str
    path : str
    """

    kind: str
    V: Floats = field(repr=False)
    path: str
    F: Ints | None = field(default=None, repr=False)
    corner_uv: Floats | None = field(default=None, repr=False)
    polygons: Ints | None = field(default=None, repr=False)
    materials: Ints | None = field(default=None, repr=False)
    cells: dict[str, Ints] = field(default_factory=dict, repr=False)
    groups: dict[str, Ints] = field(default_factory=dict, repr=False)
    dimension: int = 3
    rest: Floats | None = field(default=None, repr=False)
    notes: list[str] = field(default_factory=list)
    zone: int = 0
    texcoord_set: int = 0

    @property
    def C(self) -> Any:
        """The cells of the highest dimension: an array, or a list of arrays where there are several kinds."""
        names = ("tetrahedra", "pyramids", "wedges", "hexahedra") if self.dimension == 3 else ("triangles", "quads")
        if self.kind != "volume":
            return self.F
        blocks = [self.cells[name] for name in names if name in self.cells]
        return blocks[0] if len(blocks) == 1 else blocks

    def __iter__(self) -> Any:
        flat = "quads" in self.cells and self.dimension == 2 and bool((self.V[:, 2] == self.V[:1, 2]).all())
        return iter((self.V[:, :2] if flat else self.V, self.C))  # with three numbers four corners are tetrahedra


def read(path: PathLike, *, zone: int = 0, texcoord_set: int = 0) -> Mesh:
    """Read a surface (OBJ, OFF, PLY, STL), a model (glTF) or a volume (MEDIT, Gmsh, VTK, VTU, TetGen, SU2).

    Parameters
    ----------
    zone : int
        Of a SU2 file of several, from 1.
    texcoord_set : int
        N of the TEXCOORD_N of a glTF model.

    Raises
    ------
    FileError
        `path` is that of the file.

    Examples
    --------
    >>> import tempfile, taut
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     taut.write(f"{folder}/triangle.obj", V=[[0, 0, 0], [1, 0, 0], [0, 1, 0]], F=[[0, 1, 2]])
    ...     V, F = taut.read(f"{folder}/triangle.obj")
    >>> V.shape, F.tolist()
    ((3, 3), [[0, 1, 2]])
    """
    name = _arrays.path("path", path)
    extension = Path(name).suffix.lower()
    zone, texcoord_set = _arrays.whole("zone", zone), _arrays.whole("texcoord_set", texcoord_set)
    for argument, value, own in (("zone", zone, (".su2",)), ("texcoord_set", texcoord_set, _MODELS)):
        if value and extension not in own:
            raise ParameterError(f"{argument}: is {value}, but only {', '.join(own)} have several", field=argument)
    if extension in _MODELS:
        d = native().read_model(name, texcoord_set)
    elif extension in _SURFACES:
        d = native().read_surface(name)
    else:
        try:
            d = native().read_volume(name, zone)
        except FileError as e:
            if "unknown kind of file" not in str(e):
                raise
            kinds = f"; surfaces are read from {', '.join(_SURFACES)}, models from {', '.join(_MODELS)}, volumes"
            raise FileError(str(e).replace("; volumes", kinds), path=name) from None
        d["cells"] = {k: np.concatenate(v).astype(np.int64) for k, v in d["cells"].items()}
        d.pop("format")
    if d.get("corner_uv") is not None:
        d["corner_uv"] = d["corner_uv"].reshape(-1, 3, 2)
    return Mesh(path=name, zone=zone, texcoord_set=texcoord_set, **d)


def _uv_rows(uv: Any, F: Array, vertices: int) -> Array:
    if isinstance(uv, Atlas):
        uv = uv.corner_uv
    elif isinstance(uv, Map):
        uv = uv.uv[uv.faces] if uv.faces is not None else uv.uv
    a = _arrays.array("uv", uv, nan=len(_arrays.shape(uv)) == 3)
    if a.shape == (len(F), 3, 2):
        return _arrays.points("uv", a.reshape(-1, 2), (2,), nan=True)  # NaN: corners that have none
    rows: Array = _corner_uv("uv", a, F, vertices)
    return rows


def write(
    path: PathLike,
    *,
    like: Mesh | PathLike | None = None,
    V: ArrayLike = None,
    F: ArrayLike = None,
    uv: Any = None,
    x: ArrayLike = None,
) -> None:
    """Write a file like another one, with other texture coordinates or at other places; or arrays as a new file.

    Parameters
    ----------
    path : path
        It appears complete or not at all.
    like : Mesh or path
        The file that it is to be like, which is read again: of OBJ, glTF and volumes every byte stays that need not
        change.
    uv : Atlas, Map, (m, 3, 2) or (n, 2) array-like
        Texture coordinates.
    x : (n, 3) array-like
        Places of vertices.
    V, F : array-like
        Without `like`: a new OBJ file, or with `uv` a new glTF file.

    Examples
    --------
    >>> import tempfile, taut
    >>> V, F, uv = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [[0, 0], [1, 0], [0, 1]]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     taut.write(f"{folder}/triangle.obj", V=V, F=F, uv=uv)
    ...     taut.read(f"{folder}/triangle.obj").corner_uv.tolist()
    [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]
    """
    name = _arrays.path("path", path)
    extension = Path(name).suffix.lower()
    for argument, value, how in (("V", V, "with"), ("F", F, "with"), ("x", x, "without")):
        if value is not None and (like is None) == (how == "without"):
            raise ParameterError(f"{argument}: is given, but has no effect {how} `like`", field=argument)
    if like is None:
        _write_new(name, extension, V, F, uv)
        return
    mesh = like if isinstance(like, Mesh) else read(_arrays.path("like", like))
    if (x is None) == (uv is None):
        raise ParameterError("x and uv: give one of them", field="x")
    _require_extension(path, extension, mesh, uv is not None)
    if mesh.kind == "volume":
        if uv is not None:
            raise ParameterError("uv: volumes have no texture coordinates; give x", field="uv")
        places = _arrays.points("x", x, (2, 3), rows=len(mesh.V))
        native().write_volume_moved(name, mesh.path, places, mesh.zone)
        return
    if x is not None:
        native().write_surface_moved(name, mesh.path, _arrays.points("x", x, (3,), rows=len(mesh.V)))
        return
    assert mesh.F is not None
    rows = _uv_rows(uv, mesh.F, len(mesh.V))
    if mesh.kind == "model":
        native().write_model_uv(name, mesh.path, rows, mesh.texcoord_set)
        return
    native().write_surface_uv(name, mesh.path, rows)
    return


def _require_extension(path: PathLike, extension: str, mesh: Mesh, textured: bool) -> None:
    """Raises `ParameterError` where a name says another format than what is written; volumes and models know theirs."""
    if mesh.kind == "model" and not textured:
        raise ParameterError("x: places of a glTF model stay; give uv", field="x")
    if mesh.kind != "surface":
        return
    own = ".obj" if textured else Path(mesh.path).suffix.lower()
    if extension != own:
        what = "texture coordinates are written as OBJ" if textured else "it is written as the file it is like"
        raise ParameterError(f"path: is {os.fspath(path)!r}, but must end with {own}, as {what}", field="path")


def _write_new(name: str, extension: str, V: Any, F: Any, uv: Any) -> None:
    """Arrays as a new OBJ or glTF file."""
    if extension not in (".obj", *_MODELS):
        raise FileError(f"{name}: new files are .obj, .gltf or .glb", path=name)
    points, faces = _options.surface(V, F, planar=False)
    if extension in _MODELS:
        if uv is None:
            raise ParameterError("uv: is not given, and a new glTF file needs texture coordinates", field="uv")
        native().write_new_model(name, points, faces, _uv_rows(uv, faces, len(points)))
    elif uv is None:
        _write_bare(name, points, faces)
    elif isinstance(uv, Atlas) or isinstance(uv, Map) and uv.faces is not None and uv.vmapping is not None:
        native().write_new_surface(name, np.asarray(points)[uv.vmapping], uv.faces, uv.uv)
    elif len(_arrays.shape(uv)) == 2 or isinstance(uv, Map):
        per_vertex = _arrays.points("uv", getattr(uv, "uv", uv), (2,), rows=len(points))
        native().write_new_surface(name, points, faces, per_vertex)
    else:
        # A vertex for each that has its own coordinates in some triangle.
        corners = np.c_[faces.reshape(-1), _uv_rows(uv, faces, len(points))]
        rows, corner = np.unique(corners, axis=0, return_inverse=True)
        vertices = rows[:, 0].astype(np.int64)
        native().write_new_surface(name, np.asarray(points)[vertices], corner.reshape(-1, 3), rows[:, 1:])


def _write_bare(name: str, points: Array, faces: Array) -> None:
    """An OBJ file without texture coordinates, which reads back bit for bit."""
    lines = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.astype(np.float64).tolist()]
    lines += [f"f {a} {b} {c}\n" for a, b, c in (faces.astype(np.int64) + 1).tolist()]
    write_bytes({name: "".join(lines).encode("ascii")})


def write_bytes(files: Mapping[Any, bytes]) -> None:
    """Files by their paths, which appear together or not at all, as all that the library writes."""
    native().write_files([(_arrays.path("path", path), content) for path, content in files.items()])


def devices() -> list[Device]:
    """What OpenCL offers on this machine, and the host, which is the last one.

    Examples
    --------
    >>> import taut
    >>> any(d.refusal == "" for d in taut.devices())
    True
    """
    return [Device(**d) for d in native().devices()]
