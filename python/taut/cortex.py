# SPDX-License-Identifier: MIT
"""Cortical surfaces: GIFTI and FreeSurfer files, and flat maps of patches that were cut. Needs nibabel."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ._maps import unwrap
from .errors import FileError, ParameterError

_PATCH = np.dtype([("vertex", ">i4"), ("x", ">f4", 3)])


def read_surface(path: Any) -> tuple[Any, Any]:
    """Vertices and triangles of a GIFTI file (.gii), or of a FreeSurfer one (lh.smoothwm, lh.inflated, ...)."""
    import nibabel

    name = os.fspath(path)
    if name.endswith(".gii"):
        points, faces = nibabel.load(name).agg_data(("pointset", "triangle"))
    else:
        points, faces = nibabel.freesurfer.read_geometry(name)[:2]
    return np.asarray(points, dtype=np.float64), np.asarray(faces, dtype=np.int64)


def read_patch(path: Any) -> tuple[Any, Any, Any]:
    """A patch of FreeSurfer: its vertices, numbers of the whole surface; their places; whether each is on its border."""
    data = open(path, "rb").read()
    head = np.frombuffer(data[:8], dtype=">i4")
    if len(data) < 8 or head[0] != -1 or len(data) < 8 + head[1] * _PATCH.itemsize:
        raise FileError(f"{os.fspath(path)}: is no patch of FreeSurfer", path=os.fspath(path))
    rows = np.frombuffer(data, dtype=_PATCH, count=int(head[1]), offset=8)
    vertex = rows["vertex"].astype(np.int64)
    return np.abs(vertex) - 1, rows["x"].astype(np.float64), vertex < 0


def write_patch(path: Any, vertices: Any, places: Any, border: Any = None) -> None:
    """Writes a patch; places of two numbers get z = 0."""
    v = np.asarray(vertices, dtype=np.int64) + 1
    x = np.asarray(places, dtype=np.float64)
    rows = np.zeros(len(v), dtype=_PATCH)
    rows["vertex"] = v if border is None else np.where(border, -v, v)
    rows["x"][:, : x.shape[1]] = x
    with open(path, "wb") as file:
        file.write(np.array([-1, len(v)], dtype=">i4").tobytes() + rows.tobytes())


def cut_out(F: Any, vertices: Any) -> tuple[Any, Any]:
    """The triangles between vertices of a patch, and the vertices that they have: the largest part that is a surface."""
    from ._repair import repair

    faces = np.asarray(F, dtype=np.int64)
    inside = np.zeros(int(faces.max()) + 1, dtype=bool)
    inside[np.asarray(vertices)] = True
    kept = faces[inside[faces].all(1)]
    if len(kept) == 0:
        raise ParameterError("vertices: no triangle has all its corners among them", field="vertices")
    # Parts are told by the smallest vertex that can be reached.
    label = np.arange(len(inside))
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
        Of `taut.unwrap`.

    Returns
    -------
    vertices, uv : (k',) int64 and (k', 2) float64
        Vertices of the surface and where they lie, in its units: for `write_patch`.
    """
    faces, vertices = cut_out(F, patch)
    made = unwrap(np.asarray(V, dtype=np.float64)[vertices], faces, **{"holes": True, **options})
    return vertices, made.uv
