# SPDX-License-Identifier: MIT
"""What meshes of the scene hold, as arrays, and whether it has changed since."""

from __future__ import annotations

import hashlib

import bmesh
import numpy as np


def get(collection, name: str, kind, *shape) -> np.ndarray:
    values = np.empty(len(collection) * int(np.prod(shape or (1,))), dtype=kind)
    collection.foreach_get(name, values)
    return values.reshape(len(collection), *shape)


def flags(collection, count: int) -> np.ndarray:
    """Flags of a collection that is empty where none is set."""
    return get(collection, "value", bool) if len(collection) == count else np.zeros(count, bool)


def edited_map(ob, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Of a mesh that is edited: coordinates, pins, and the UV editor's selection of corners and of edges from them."""
    edited = EditedMap(ob)
    loops, layer = edited.corners, edited.layer
    uv, marks = np.empty((count, 2), np.float32), np.zeros((3, count), bool)
    own = count > 0 and hasattr(loops[0], "uv_select_vert")  # from Blender 5.0 on
    for i, loop in enumerate(loops):
        at = loop[layer]
        uv[i] = at.uv
        picked = (loop.uv_select_vert, loop.uv_select_edge) if own else (at.select, at.select_edge)
        marks[:, i] = at.pin_uv, *picked
    return uv, marks[0], marks[1], marks[2]


def painted(mesh, index: int) -> np.ndarray:
    weight = np.zeros(len(mesh.vertices))
    for v in mesh.vertices:
        for g in v.groups:
            if g.group == index:
                weight[v.index] = g.weight
    return weight


class EditedMap:
    """The UV map of a mesh that is edited: good as long as nothing else edits the mesh."""

    def __init__(self, ob) -> None:
        self._mesh = ob.data
        self._bm = bmesh.from_edit_mesh(ob.data)  # its corners live as long as it does
        self.layer = self._bm.loops.layers.uv.verify()
        self.corners = [loop for face in self._bm.faces for loop in face.loops]

    def write(self, corners, uv) -> None:
        """Writes coordinates of some corners."""
        for i, place in zip(corners, uv.tolist()):
            self.corners[i][self.layer].uv = place
        self.shown()

    def shown(self) -> None:
        bmesh.update_edit_mesh(self._mesh, loop_triangles=False, destructive=False)


def digest(ob, weights: str) -> bytes:
    """What of an object a map depends on: elements and how they hang together, shape in space, seams, hidden faces, the
    active UV map and its pins, and painted weights."""
    mesh = ob.data
    edit = ob.mode == "EDIT"
    if edit:
        ob.update_from_editmode()
    layer = mesh.uv_layers.active
    if layer is None:
        return b""
    scale = np.array(ob.matrix_world, dtype=np.float64)[:3, :3]
    parts = [
        get(mesh.loops, "vertex_index", np.int32),
        get(mesh.loops, "edge_index", np.int32),
        get(mesh.polygons, "loop_start", np.int32),
        get(mesh.polygons, "loop_total", np.int32),
        get(mesh.polygons, "hide", bool),
        get(mesh.edges, "vertices", np.int32, 2),
        get(mesh.edges, "use_seam", bool),
        get(mesh.vertices, "co", np.float32, 3),
        np.float32(scale.T @ scale),  # not where it lies, and how it is turned
    ]
    count = len(mesh.loops)
    parts += edited_map(ob, count)[:2] if edit else (get(layer.uv, "vector", np.float32, 2), flags(layer.pin, count))
    group = ob.vertex_groups.get(weights) if weights else None
    parts += [] if group is None else [painted(mesh, group.index)]
    made = hashlib.sha256(repr((layer.name, [part.shape for part in parts])).encode())
    for part in parts:
        made.update(np.ascontiguousarray(part).tobytes())
    return made.digest()
