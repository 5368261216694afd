# SPDX-License-Identifier: MIT
"""picture.py OUT.png: a monkey with a checkerboard, and its UV map, by Blender's Conformal and by taut's Unwrap, along
the same seams; rendered by Cycles, with TAUT_THEME=dark on a dark ground. For Blender as a Python module, with the
package taut on PYTHONPATH."""

import math
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "tests")]

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import taut_uv  # noqa: E402
from judge import Read  # noqa: E402
from scenes import made, primitive, uv_of  # noqa: E402


def monkey(name):
    """A fine one, with the seams of an atlas."""
    ob = primitive("monkey", name)
    more = ob.modifiers.new("more", "SUBSURF")
    more.levels = 3
    bpy.ops.object.modifier_apply(modifier="more")
    bpy.ops.taut.atlas()
    return ob


def checkered(name, size):
    """A material with squares of UV maps, so many along a unit."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    coordinates, checker = nodes.new("ShaderNodeTexCoord"), nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = size
    checker.inputs["Color1"].default_value = (0.85, 0.82, 0.75, 1)
    checker.inputs["Color2"].default_value = (0.08, 0.2, 0.4, 1)
    links.new(coordinates.outputs["UV"], checker.inputs["Vector"])
    links.new(checker.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.8
    return material


def flat(ob, name):
    """The UV map of an object as a mesh of the plane that stands upright, with the same map."""
    r = Read(ob)
    corners = [(u, 0.0, v) for u, v in r.uv]
    sheet = made(name, corners, r.polygons)
    uv_of(sheet, r.uv[np.concatenate(r.polygons)])
    return sheet


def column(x, name, unwrap):
    """An object and its map below it."""
    ob = monkey(name)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    unwrap()
    bpy.ops.object.mode_set(mode="OBJECT")
    r = Read(ob)
    F = r.vertex[r.triangles]
    area = np.linalg.norm(np.cross(r.V[F[:, 1]] - r.V[F[:, 0]], r.V[F[:, 2]] - r.V[F[:, 0]]), axis=1).sum()
    t = r.tri()
    a, b = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    density = math.sqrt(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / area)
    material = checkered(name, 11 / density)
    sheet = flat(ob, name + " map")
    for o in (ob, sheet):
        o.data.materials.clear()
        o.data.materials.append(material)
    for p in ob.data.polygons:
        p.use_smooth = True
    ob.location, ob.rotation_euler = (x, 0, 1.3), (0.1, 0, 0.5)
    sheet.location, sheet.scale = (x - 1.2, 0, -2.5), (2.4, 2.4, 2.4)


def light_and_camera():
    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 5.6
    camera.location, camera.rotation_euler = (0, -10, -0.05), (math.pi / 2, 0, 0)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 2.5, (0.9, 0.2, -0.4)
    for o in (camera, sun):
        scene.collection.objects.link(o)
    scene.camera = camera
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.7
    scene.world = world
    if os.environ.get("TAUT_THEME") == "dark":
        darken(world.node_tree)


def darken(tree):
    """The light stays; the camera sees a dark world."""
    nodes, links = tree.nodes, tree.links
    kinds = ("ShaderNodeBackground", "ShaderNodeMixShader", "ShaderNodeLightPath")
    dark, mix, path = (nodes.new(kind) for kind in kinds)
    dark.inputs["Color"].default_value = (0.008, 0.0097, 0.0137, 1)  # linear; (22, 25, 31) in sRGB
    links.new(path.outputs["Is Camera Ray"], mix.inputs["Fac"])
    links.new(nodes["Background"].outputs["Background"], mix.inputs[1])
    links.new(dark.outputs["Background"], mix.inputs[2])
    links.new(mix.outputs["Shader"], nodes["World Output"].inputs["Surface"])


def main():
    taut_uv.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    column(-1.4, "Conformal", lambda: bpy.ops.uv.unwrap(method="CONFORMAL"))
    column(1.4, "taut", lambda: bpy.ops.taut.unwrap(no_overlap=True))
    light_and_camera()
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    bpy.context.scene.cycles.samples, bpy.context.scene.cycles.device = 24, "CPU"
    bpy.context.scene.cycles.use_denoising = True
    bpy.context.scene.view_settings.view_transform = "Standard"
    render.film_transparent = False
    render.resolution_x, render.resolution_y, render.resolution_percentage = 720, 711, 100
    render.image_settings.file_format, render.image_settings.compression = "PNG", 100
    render.filepath = str(pathlib.Path(sys.argv[1]).resolve())
    bpy.ops.render.render(write_still=True)


main()
os._exit(0)  # Blender as a module may wait for its threads for ever when it ends
