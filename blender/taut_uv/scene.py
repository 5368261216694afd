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
from .reading import EditedMap, digest, edited_map, flags, get, painted


def objects(context) -> list:
    """Selected meshes, or those that are edited; of objects with one mesh in common the first."""
    found = context.objects_in_mode if context.mode == "EDIT_MESH" else context.selected_objects
    meshes, seen = [], set()
    for ob in found:
        if ob.type == "MESH" and ob.data not in seen and (ob.mode == "EDIT" or len(ob.data.polygons)):
            seen.add(ob.data)
            meshes.append(ob)
    if not meshes:
        raise Trouble("no mesh with faces is selected; select one")
    return meshes


def named(name: str):
    """The object of this file with that name, or None; those of other files that are linked may have the same."""
    return bpy.data.objects.get((name, None))


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
        self._uv_selection, self._weights = uv_selection, weights
        parts, grabbed, known = [], [], False
        for ob in obs:
            if ob.library is not None or ob.data.library is not None:
                what = "is linked from another file; make it local (Object > Relations), or deselect it"
                raise Trouble(f"{ob.name}: {what}")
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
        self._digests = [digest(ob, weights) for ob in obs]

    def _read(self, ob, layer, group) -> tuple[Surface, np.ndarray]:
        mesh = ob.data
        mesh.calc_loop_triangles()
        vertex = get(mesh.loops, "vertex_index", np.int32).astype(np.int64)
        start = get(mesh.polygons, "loop_start", np.int32).astype(np.int64)
        total = get(mesh.polygons, "loop_total", np.int32).astype(np.int64)
        face = np.repeat(np.arange(len(start)), total)
        following = np.arange(len(vertex)) + 1
        following[start + total - 1] = start
        matrix = np.array(ob.matrix_world, dtype=np.float64)
        V = get(mesh.vertices, "co", np.float32, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        visible = ~get(mesh.polygons, "hide", bool)
        edit = ob.mode == "EDIT"
        chosen = visible & (get(mesh.polygons, "select", bool) if edit else True)
        line = get(mesh.edges, "select", bool)
        edge = get(mesh.loops, "edge_index", np.int32).astype(np.int64)
        grabbed = get(mesh.vertices, "select", bool)[vertex] & visible[face]
        if edit:
            uv, pinned, picked, along = edited_map(ob, len(vertex))
        else:
            uv, pinned = get(layer.uv, "vector", np.float32, 2), flags(layer.pin, len(vertex))
        if self._uv_selection and edit:
            picked, along = picked & chosen[face], along & chosen[face]
            all_picked = np.ones(len(start), bool)
            np.logical_and.at(all_picked, face, picked)
            chosen, grabbed = chosen & all_picked, picked
            line = np.zeros(len(mesh.edges), bool)
            line[edge[along]] = True
        weight = np.ones(len(V)) if group is None else painted(mesh, group.index)
        triangles = get(mesh.loop_triangles, "loops", np.int32, 3).astype(np.int64)
        triangle_face = get(mesh.loop_triangles, "polygon_index", np.int32).astype(np.int64)
        surface = Surface(
            V=V,
            vertex=vertex,
            face=face,
            edge=edge,
            next=following,
            triangles=without_flat(V, vertex, triangles, triangle_face),
            drawn=triangles,
            triangle_face=triangle_face,
            edges=get(mesh.edges, "vertices", np.int32, 2).astype(np.int64),
            seam=get(mesh.edges, "use_seam", bool),
            uv=uv.astype(np.float64),
            pinned=pinned,
            chosen=chosen,
            line=line,
            weight=weight,
            names=[ob.name],
        )
        return surface, grabbed

    def unchanged(self) -> bool:
        """Whether the objects are there, and all that was read of them, but for what is selected, is as it was."""
        obs = [named(name) for name in self.names]
        return all(ob is not None and ob.type == "MESH" and digest(ob, self._weights) == before
                   for ob, before in zip(obs, self._digests))


def write(reader: Reader, result: Result) -> bool:
    """Writes coordinates that changed, seams and selections. Objects that are no longer as they were read are left
    alone, all of them: False."""
    if not reader.unchanged():
        return False
    s = reader.surface
    for k, name in enumerate(reader.names):
        ob = named(name)
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
    return True


def write_map(mesh, corners, uv) -> None:
    """Writes coordinates of some corners of a mesh in object mode.

    By its attribute: undo does not see what is written to `layer.uv` all at once (Blender 4.5).
    """
    data = mesh.attributes[mesh.uv_layers.active.name].data
    whole = get(data, "vector", np.float32, 2)
    whole[corners] = uv
    data.foreach_set("vector", whole.reshape(-1))
    mesh.update()


def _write_mesh(mesh, uv, changed, seam) -> None:
    if len(changed):
        write_map(mesh, changed, uv[changed])
    if seam is not None:
        mesh.edges.foreach_set("use_seam", np.ascontiguousarray(seam))
    mesh.update()


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
    vertex, edge = get(mesh.loops, "vertex_index", np.int32), get(mesh.loops, "edge_index", np.int32)
    total = get(mesh.polygons, "loop_total", np.int32)
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
