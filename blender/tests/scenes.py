# SPDX-License-Identifier: MIT
"""Scenes made by script."""

import math

import bpy
import numpy as np


def made(name, V, faces):
    """A mesh object, alone selected and active."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(map(float, v)) for v in V], [], [tuple(map(int, f)) for f in faces])
    mesh.update()
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    choose(ob)
    return ob


def choose(*obs):
    """Selects these objects, and no other."""
    for ob in bpy.context.view_layer.objects:
        ob.select_set(ob in obs)
    bpy.context.view_layer.objects.active = obs[0]


def hill(n=16, height=0.6, name="Hill"):
    """A grid of n by n quads with two bumps."""
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    z = height * (np.exp(-6 * ((x - 0.3) ** 2 + (y - 0.2) ** 2)) - np.exp(-5 * ((x + 0.4) ** 2 + (y + 0.3) ** 2)))
    i = np.arange(n * n)
    a = i // n * (n + 1) + i % n
    return made(name, np.c_[x.ravel(), y.ravel(), z.ravel()], np.c_[a, a + 1, a + n + 2, a + n + 1])


def tube(sides=16, rings=6, caps=True, name="Tube"):
    """A cylinder of quads with n-gons as caps."""
    V = [
        (math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides), 2 * r / rings)
        for r in range(rings + 1)
        for k in range(sides)
    ]
    F = [
        (r * sides + k, r * sides + (k + 1) % sides, (r + 1) * sides + (k + 1) % sides, (r + 1) * sides + k)
        for r in range(rings)
        for k in range(sides)
    ]
    if caps:
        F += [tuple(range(sides))[::-1], tuple(rings * sides + k for k in range(sides))]
    return made(name, V, F)


def primitive(kind, name, **options):
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**options)
    ob = bpy.context.object
    ob.name = ob.data.name = name
    for layer in list(ob.data.uv_layers):
        ob.data.uv_layers.remove(layer)
    choose(ob)
    return ob


def seams(ob, wanted):
    """Marks as seams the edges whose two ends, as coordinates, pass."""
    for e in ob.data.edges:
        a, b = (np.array(ob.data.vertices[v].co) for v in e.vertices)
        e.use_seam = bool(wanted(a, b))


def tube_seams(ob, top=2.0):
    """A seam along a tube of radius 1, and around its caps."""
    along = lambda p: abs(p[1]) < 1e-5 and p[0] > 0
    seams(ob, lambda a, b: along(a) and along(b) or a[2] == b[2] and a[2] in (0, top))


def uv_of(ob, values=None):
    """Coordinates of all corners, read or written."""
    if ob.data.uv_layers.active is None:
        ob.data.uv_layers.new(name="UVMap")
    layer = ob.data.uv_layers.active.uv
    if values is not None:
        data = ob.data.attributes[ob.data.uv_layers.active.name].data
        data.foreach_set("vector", np.asarray(values, np.float32).reshape(-1))
        ob.data.update()
    uv = np.empty(2 * len(layer), np.float32)
    layer.foreach_get("vector", uv)
    return uv.reshape(-1, 2)


def flat(ob, scale=0.4, shift=0.5):
    """A UV map by projection along z."""
    co = np.array([ob.data.vertices[loop.vertex_index].co[:2] for loop in ob.data.loops])
    return uv_of(ob, co * scale + shift)


def pin(ob, vertices, places=None):
    """Pins all corners of vertices, at places or where they are."""
    uv_of(ob)
    layer = ob.data.uv_layers.active
    for k, v in enumerate(vertices):
        own = corners_of(ob, [v]).tolist()
        pin_corners(ob, own)
        for c in own if places is not None else []:
            layer.uv[c].vector = places[k]


def pin_corners(ob, corners):
    name = f".pn.{ob.data.uv_layers.active.name}"
    pins = ob.data.attributes.get(name) or ob.data.attributes.new(name, "BOOLEAN", "CORNER")
    for c in corners:
        pins.data[int(c)].value = True


def corners_of(ob, vertices):
    return np.array([loop.index for loop in ob.data.loops if loop.vertex_index in set(vertices)])


def mode(name):
    bpy.ops.object.mode_set(mode=name)


def select(ob, faces=None, edges=None, vertices=None):
    """Selects elements of a mesh in object mode, and nothing else, then enters edit mode."""
    if ob.mode == "EDIT":
        mode("OBJECT")
    mesh = ob.data
    n = (len(mesh.vertices), len(mesh.edges), len(mesh.polygons))
    on = [np.zeros(k, bool) for k in n]
    kind = (vertices is not None, edges is not None, faces is not None)
    for collection, flags, ids in zip((mesh.vertices, mesh.edges, mesh.polygons), on, (vertices, edges, faces)):
        if ids is not None:
            flags[np.asarray(ids, dtype=int)] = True
    if faces is not None:
        on[0][[v for f in np.flatnonzero(on[2]) for v in mesh.polygons[f].vertices]] = True
    if edges is not None:
        on[0][[v for e in np.flatnonzero(on[1]) for v in mesh.edges[e].vertices]] = True
    for part, domain, flags in zip(("vert", "edge", "poly"), ("POINT", "EDGE", "FACE"), on):
        name = f".select_{part}"
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        attribute = mesh.attributes.new(name, "BOOLEAN", domain)
        attribute.data.foreach_set("value", flags)
    bpy.context.tool_settings.mesh_select_mode = kind
    mesh.update()
    mode("EDIT")
