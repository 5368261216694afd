# SPDX-License-Identifier: MIT
"""Meshes of the scene as arrays, and results back into them: in object mode and in edit mode."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np

from .core.messages import Trouble
from .core.polygons import without_flat
from .core.surface import Surface, joined
from .core.work import Result


def _get(collection, name: str, kind, *shape) -> np.ndarray:
    values = np.empty(len(collection) * int(np.prod(shape or (1,))), dtype=kind)
    collection.foreach_get(name, values)
    return values.reshape(len(collection), *shape)


def objects(context) -> list:
    """Selected meshes, or those that are edited; of objects with one mesh in common the first."""
    found = context.objects_in_mode if context.mode == "EDIT_MESH" else context.selected_objects
    meshes, seen = [], set()
    for ob in found:
        if ob.type == "MESH" and ob.data.name not in seen and (ob.mode == "EDIT" or len(ob.data.polygons)):
            seen.add(ob.data.name)
            meshes.append(ob)
    if not meshes:
        raise Trouble("no mesh with faces is selected; select one")
    return meshes


def by_uv_selection(context) -> bool:
    """Whether a selection is that of the UV editor, which has one of its own."""
    space = context.space_data
    return (
        context.mode == "EDIT_MESH"
        and space is not None
        and space.type == "IMAGE_EDITOR"
        and not context.tool_settings.use_uv_select_sync
    )


class Reader:
    """The surface of some objects, and what of it is selected."""

    def __init__(self, obs: list, *, new_map: bool = False, uv_selection: bool = False, weights: str = "") -> None:
        self.names = [ob.name for ob in obs]
        self._uv_selection = uv_selection
        parts, grabbed, known = [], [], False
        for ob in obs:
            if ob.mode == "EDIT":
                ob.update_from_editmode()
            layer = ob.data.uv_layers.active
            if layer is None:
                if not new_map:
                    raise Trouble(f"{ob.name}: no UV map; Unwrap it, or make an Atlas")
                layer = ob.data.uv_layers.new(name="UVMap")
                if layer is None:
                    raise Trouble(f"{ob.name}: has eight UV maps, but none of them is active; click one in Object Data")
            group = ob.vertex_groups.get(weights) if weights else None
            known |= group is not None
            surface, corners = self._read(ob, layer, group)
            parts.append(surface)
            grabbed.append(corners)
        if weights and not known:
            raise Trouble(f'no selected object has a vertex group "{weights}"; paint one, or clear Weights')
        self.surface = joined(parts)
        self.grabbed = np.concatenate(grabbed)

    def _read(self, ob, layer, group) -> tuple[Surface, np.ndarray]:
        mesh = ob.data
        mesh.calc_loop_triangles()
        vertex = _get(mesh.loops, "vertex_index", np.int32).astype(np.int64)
        start = _get(mesh.polygons, "loop_start", np.int32).astype(np.int64)
        total = _get(mesh.polygons, "loop_total", np.int32).astype(np.int64)
        face = np.repeat(np.arange(len(start)), total)
        following = np.arange(len(vertex)) + 1
        following[start + total - 1] = start
        matrix = np.array(ob.matrix_world, dtype=np.float64)
        V = _get(mesh.vertices, "co", np.float32, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        visible = ~_get(mesh.polygons, "hide", bool)
        edit = ob.mode == "EDIT"
        chosen = visible & (_get(mesh.polygons, "select", bool) if edit else True)
        line = _get(mesh.edges, "select", bool)
        edge = _get(mesh.loops, "edge_index", np.int32).astype(np.int64)
        grabbed = _get(mesh.vertices, "select", bool)[vertex] & visible[face]
        if edit:
            uv, pinned, picked, along = _edited_map(ob, len(vertex))
        else:
            uv, pinned = _get(layer.uv, "vector", np.float32, 2), _flags(layer.pin, len(vertex))
        if self._uv_selection and edit:
            picked, along = picked & chosen[face], along & chosen[face]
            all_picked = np.ones(len(start), bool)
            np.logical_and.at(all_picked, face, picked)
            chosen, grabbed = chosen & all_picked, picked
            line = np.zeros(len(mesh.edges), bool)
            line[edge[along]] = True
        weight = np.ones(len(V)) if group is None else _painted(mesh, group.index)
        triangles = _get(mesh.loop_triangles, "loops", np.int32, 3).astype(np.int64)
        triangle_face = _get(mesh.loop_triangles, "polygon_index", np.int32).astype(np.int64)
        surface = Surface(
            V=V,
            vertex=vertex,
            face=face,
            edge=edge,
            next=following,
            triangles=without_flat(V, vertex, triangles, triangle_face),
            drawn=triangles,
            triangle_face=triangle_face,
            edges=_get(mesh.edges, "vertices", np.int32, 2).astype(np.int64),
            seam=_get(mesh.edges, "use_seam", bool),
            uv=uv.astype(np.float64),
            pinned=pinned,
            chosen=chosen,
            line=line,
            weight=weight,
            names=[ob.name],
        )
        return surface, grabbed

    def unchanged(self) -> bool:
        """Whether the objects are there, with as many elements as they had."""
        s = self.surface
        for k, name in enumerate(self.names):
            ob = bpy.data.objects.get(name)
            if ob is None or ob.data.uv_layers.active is None:
                return False
            if ob.mode == "EDIT":
                ob.update_from_editmode()
            if (
                len(ob.data.loops) != s.first_corner[k + 1] - s.first_corner[k]
                or len(ob.data.edges) != s.first_edge[k + 1] - s.first_edge[k]
            ):
                return False
        return True


def _flags(collection, count: int) -> np.ndarray:
    """Flags of a collection that is empty where none is set."""
    return _get(collection, "value", bool) if len(collection) == count else np.zeros(count, bool)


def _edited_map(ob, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Of a mesh that is edited: coordinates, pins, and the UV editor's selection of corners and of edges from them."""
    edited = EditedMap(ob)
    loops, layer = edited.corners, edited.layer
    uv, flags = np.empty((count, 2), np.float32), np.zeros((3, count), bool)
    own = count > 0 and hasattr(loops[0], "uv_select_vert")  # from Blender 5.0 on
    for i, loop in enumerate(loops):
        at = loop[layer]
        uv[i] = at.uv
        picked = (loop.uv_select_vert, loop.uv_select_edge) if own else (at.select, at.select_edge)
        flags[:, i] = at.pin_uv, *picked
    return uv, flags[0], flags[1], flags[2]


def _painted(mesh, index: int) -> np.ndarray:
    weight = np.zeros(len(mesh.vertices))
    for v in mesh.vertices:
        for g in v.groups:
            if g.group == index:
                weight[v.index] = g.weight
    return weight


def write(reader: Reader, result: Result) -> None:
    """Writes coordinates that changed, seams and selections."""
    s = reader.surface
    for k, name in enumerate(reader.names):
        ob = bpy.data.objects[name]
        corners = slice(s.first_corner[k], s.first_corner[k + 1])
        edges = slice(s.first_edge[k], s.first_edge[k + 1])
        faces = slice(s.first_face[k], s.first_face[k + 1])
        changed = np.flatnonzero(result.changed[corners])
        seam = None
        if result.seam is not None:
            seam = np.flatnonzero(result.seam[edges] != s.seam[edges])
        if ob.mode == "EDIT":
            _write_edited(ob, result.uv[corners], changed, result.seam[edges] if seam is not None else None, seam)
            if result.selected is not None:
                select_edited(ob, result.selected[faces])
        else:
            _write_mesh(ob.data, result.uv[corners], changed, result.seam[edges] if seam is not None else None)
            if result.selected is not None:
                _select(ob.data, result.selected[faces])


def write_map(mesh, corners, uv) -> None:
    """Writes coordinates of some corners of a mesh in object mode.

    By its attribute: undo does not see what is written to `layer.uv` all at once (Blender 4.5).
    """
    data = mesh.attributes[mesh.uv_layers.active.name].data
    whole = _get(data, "vector", np.float32, 2)
    whole[corners] = uv
    data.foreach_set("vector", whole.reshape(-1))
    mesh.update()


def _write_mesh(mesh, uv, changed, seam) -> None:
    if len(changed):
        write_map(mesh, changed, uv[changed])
    if seam is not None:
        mesh.edges.foreach_set("use_seam", np.ascontiguousarray(seam))
    mesh.update()


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


def _write_edited(ob, uv, changed, seam, changed_edges) -> None:
    bm = bmesh.from_edit_mesh(ob.data)
    if len(changed):
        EditedMap(ob).write(changed.tolist(), uv[changed])
    if seam is not None:
        bm.edges.ensure_lookup_table()
        for e in changed_edges.tolist():
            bm.edges[e].seam = bool(seam[e])
    bmesh.update_edit_mesh(ob.data, loop_triangles=False, destructive=False)


def select_edited(ob, faces: np.ndarray) -> None:
    bm = bmesh.from_edit_mesh(ob.data)
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    bm.select_mode = {"FACE"}
    for face, on in zip(bm.faces, faces.tolist()):
        face.select_set(False)
    for face, on in zip(bm.faces, faces.tolist()):
        if on and not face.hide:
            face.select_set(True)
    bm.select_flush_mode()
    bmesh.update_edit_mesh(ob.data, loop_triangles=False, destructive=False)


def _select(mesh, faces: np.ndarray) -> None:
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    vertex, edge = _get(mesh.loops, "vertex_index", np.int32), _get(mesh.loops, "edge_index", np.int32)
    total = _get(mesh.polygons, "loop_total", np.int32)
    of_corner = np.repeat(faces, total)
    vertices, edges = np.zeros(len(mesh.vertices), bool), np.zeros(len(mesh.edges), bool)
    vertices[vertex[of_corner]] = True
    edges[edge[of_corner]] = True
    # As new attributes: foreach_set("select") ends Blender 5.0 where all elements of a mesh are selected.
    for kind, domain, values in (("vert", "POINT", vertices), ("edge", "EDGE", edges), ("poly", "FACE", faces)):
        name = f".select_{kind}"
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        attribute = mesh.attributes.new(name, "BOOLEAN", domain)
        attribute.data.foreach_set("value", np.ascontiguousarray(values))
    mesh.update()
