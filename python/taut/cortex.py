# SPDX-License-Identifier: MIT
"""Cortical surfaces: GIFTI and FreeSurfer files, and flat maps of patches that were cut. Needs nibabel."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arrays
from ._files import write_bytes
from ._maps import at_scale, unwrap
from .errors import FileError, ParameterError

_PATCH = np.dtype([("vertex", ">i4"), ("x", ">f4", 3)])


def read_surface(path: Any) -> tuple[Any, Any]:
    """Vertices and triangles of a GIFTI file (.gii), or of a FreeSurfer one (lh.smoothwm, lh.inflated, ...)."""
    import nibabel

    name = _arrays.path("path", path)
    try:
        if name.endswith(".gii"):
            points, faces = nibabel.load(name).agg_data(("pointset", "triangle"))
        else:
            points, faces = nibabel.freesurfer.read_geometry(name)[:2]
        return np.asarray(points, dtype=np.float64), np.asarray(faces, dtype=np.int64)
    except Exception as e:  # of any kind, as broken files raise them
        raise FileError(f"{name}: cannot be read: {e}", path=name) from None


def read_patch(path: Any) -> tuple[Any, Any, Any]:
    """A patch of FreeSurfer: its vertices, numbers of the whole surface; their places; whether each is on its border."""
    name = _arrays.path("path", path)
    try:
        with open(name, "rb") as file:
            data = file.read()
    except OSError as e:
        raise FileError(f"{name}: {e.strerror}", path=name) from None
    if len(data) < 8:
        raise FileError(f"{name}: is no patch of FreeSurfer", path=name)
    mark, count = (int(n) for n in np.frombuffer(data[:8], dtype=">i4"))
    if mark != -1 or count < 0 or len(data) < 8 + count * _PATCH.itemsize:
        raise FileError(f"{name}: is no patch of FreeSurfer, or cut off", path=name)
    rows = np.frombuffer(data, dtype=_PATCH, count=count, offset=8)
    vertex = rows["vertex"].astype(np.int64)
    if not vertex.all():
        raise FileError(f"{name}: row {np.flatnonzero(vertex == 0)[0]} has the vertex 0; they begin at 1", path=name)
    return np.abs(vertex) - 1, rows["x"].astype(np.float64), vertex < 0


def write_patch(path: Any, vertices: Any, places: Any, border: Any = None) -> None:
    """Writes a patch; places of two numbers get z = 0.

    The file has numbers of single precision: as these the map of `flatten` is certified.
    """
    v = _arrays.ids("vertices", vertices, 2**31 - 1).astype(np.int64) + 1
    x = _arrays.points("places", places, (2, 3), rows=len(v))
    found, times = np.unique(v, return_counts=True)
    if (times > 1).any():
        twice = int(found[times > 1][0]) - 1
        raise ParameterError(f"vertices: name {twice} twice; give each one place", field="vertices", ids=[twice])
    if (np.abs(x) > np.finfo(np.float32).max).any():
        raise ParameterError("places: have numbers beyond single precision; scale them", field="places")
    rows = np.zeros(len(v), dtype=_PATCH)
    rows["vertex"] = v if border is None else np.where(_arrays.numbers("border", border, len(v)) != 0, -v, v)
    rows["x"][:, : x.shape[1]] = x
    write_bytes({path: np.array([-1, len(v)], dtype=">i4").tobytes() + rows.tobytes()})


def cut_out(F: Any, vertices: Any) -> tuple[Any, Any]:
    """The triangles between vertices of a patch, and the vertices that they have: the largest part that is a surface."""
    from ._repair import repair

    faces = _arrays.indices("F", F, (3,), 2**31 - 1).astype(np.int64)
    if len(faces) == 0:
        raise ParameterError("F: has no triangles", field="F")
    kept = faces[np.isin(faces, _arrays.ids("vertices", vertices, 2**31 - 1)).all(1)]
    if len(kept) == 0:
        raise ParameterError("vertices: no triangle has all its corners among them", field="vertices")
    # Parts are told by the smallest vertex that can be reached.
    label = np.arange(int(faces.max()) + 1)
    while True:
        new = label.copy()
        low = label[kept].min(1)
        for k in range(3):
            np.minimum.at(new, kept[:, k], low)
        new = new[new]
        if (new == label).all():
            break
        label = new
    parts, counts = np.unique(label[kept[:, 0]], return_counts=True)
    kept = kept[label[kept[:, 0]] == parts[counts.argmax()]]
    used, local = np.unique(kept, return_inverse=True)
    flat = np.c_[np.arange(len(used)), np.arange(len(used)) ** 2, np.zeros(len(used))].astype(float)
    made = repair(flat, local.reshape(-1, 3))  # parts fans that touch in a vertex
    return made.F, used[made.vmap]


def flatten(V: Any, F: Any, patch: Any, **options: Any) -> tuple[Any, Any]:
    """A flat map of a patch.

    Parameters
    ----------
    V, F : (n, 3) and (m, 3) array-like
        The whole surface, as the white or the smoothed one: lengths are measured on it.
    patch : (k,) array-like of int
        Its vertices that are left after cutting, as `read_patch` has them.
    options
        Of `taut.unwrap`, but for `cut` and what would change lengths.

    Returns
    -------
    vertices, uv : (k',) int64 and (k', 2) float64
        Vertices of the surface and where they lie, in its units: for `write_patch`, in numbers of single precision.
    """
    points = _arrays.points("V", V)
    F = _arrays.indices("F", F, (3,), len(points))
    faces, vertices = cut_out(F, _arrays.ids("patch", patch, len(points)))
    made = unwrap(points[vertices], faces, **at_scale(options, "patches", single=True))
    return vertices, made.uv
