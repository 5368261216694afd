# SPDX-License-Identifier: MIT
"""Random meshes as modifiers and edits of Blender leave them, and what Unwrap and Atlas make of them.

random_scenes.py [first [last [unwrap|atlas]]]: runs the scenes of these numbers, and prints a line for each that is
judged to be wrong. test_random_scenes.py has some of them.
"""

import os
import pathlib
import sys

import bpy

import bmesh  # a module of bpy: after it  # isort: skip
import judge
import numpy as np
from scenes import hill, primitive, tube

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent)]
import taut_uv  # noqa: E402
from taut_uv import running  # noqa: E402


def _rough(ob, rng):
    """Moves vertices at random, by up to a fifth of their edges."""
    mesh = ob.data
    short = np.full(len(mesh.vertices), np.inf)
    for e in mesh.edges:
        a, b = e.vertices
        short[[a, b]] = np.minimum(short[[a, b]], (mesh.vertices[a].co - mesh.vertices[b].co).length)
    for v, size in zip(mesh.vertices, short):
        if np.isfinite(size):
            v.co += type(v.co)(rng.uniform(-0.2, 0.2, 3) * size)
    mesh.update()


def _modified(ob, kind, **options):
    m = ob.modifiers.new(kind, kind)
    for name, value in options.items():
        setattr(m, name, value)
    bpy.ops.object.modifier_apply(modifier=m.name)


def _edited(ob, change):
    b = bmesh.new()
    b.from_mesh(ob.data)
    change(b)
    b.to_mesh(ob.data)
    b.free()
    ob.data.update()


def _dissolved(ob, rng):
    """N-gons: some edges between faces that nearly lie in a plane are dissolved."""

    def change(b):
        edges = [e for e in b.edges if e.is_manifold and e.calc_face_angle(9) < 0.5]
        some = [e for e in edges if rng.random() < 0.25]
        bmesh.ops.dissolve_edges(b, edges=some, use_verts=bool(rng.integers(2)))

    _edited(ob, change)


def _cut(ob, rng):
    """Seams: a random set of edges that leaves islands of any shape."""
    if rng.integers(2):
        for e in ob.data.edges:
            e.use_seam = bool(rng.random() < 0.1)
    else:
        normals = [p.normal.copy() for p in ob.data.polygons]
        sides = {}
        for p in ob.data.polygons:
            for key in p.edge_keys:
                sides.setdefault(key, []).append(p.index)
        for e in ob.data.edges:
            two = sides.get(e.key, [])
            e.use_seam = len(two) == 2 and normals[two[0]].dot(normals[two[1]]) < 0.7


def scene(seed):
    """The object of a number, alone selected."""
    rng = np.random.default_rng(seed)
    kind = seed % 5
    if kind == 0:
        ob = primitive("monkey", "Monkey")
    elif kind == 1:
        ob = primitive("uv_sphere", "Ball", segments=int(rng.integers(5, 24)), ring_count=int(rng.integers(4, 14)))
    elif kind == 2:
        sizes = dict(major_segments=int(rng.integers(6, 30)), minor_segments=int(rng.integers(4, 12)))
        ob = primitive("torus", "Ring", **sizes)
    elif kind == 3:
        ob = tube(int(rng.integers(5, 20)), int(rng.integers(1, 8)))
    else:
        ob = hill(int(rng.integers(5, 24)), rng.uniform(0.1, 1.0))
    for change in rng.permutation(6)[: rng.integers(1, 4)]:
        if change == 0:
            _rough(ob, rng)
        elif change == 1:
            _modified(ob, "DECIMATE", decimate_type="DISSOLVE", angle_limit=rng.uniform(0.05, 0.6))
        elif change == 2:
            _modified(ob, "DECIMATE", ratio=rng.uniform(0.2, 0.8))
        elif change == 3 and len(ob.data.polygons) < 900:
            _modified(ob, "BEVEL", width=rng.uniform(0.005, 0.08), segments=int(rng.integers(1, 3)))
        elif change == 4:
            _dissolved(ob, rng)
        elif change == 5 and len(ob.data.polygons) < 400:
            _modified(ob, "SUBSURF", levels=1)
    ob.data.validate()
    _cut(ob, rng)
    return ob


def judged(seed, command):
    """What is wrong with a scene after a command: a sentence, or None.

    Islands that the command could not do, and faces that it names, may be anything; so may islands of Unwrap that lie
    over themselves, which is asked for by No Overlap alone.
    """
    ob = scene(seed)
    results = []
    told = running.told

    def remembered(operator, reader, result, what):
        results.append(result)
        return told(operator, reader, result, what)

    running.told = remembered
    try:
        if command == "unwrap":
            done = bpy.ops.taut.unwrap(cut=bool(seed % 2), padding=1)
        else:
            done = bpy.ops.taut.atlas(padding=1)
    except RuntimeError:  # an error that is told is one of Python here
        done = {"CANCELLED"}
    finally:
        running.told = told
    if done != {"FINISHED"}:
        return None
    r, result = judge.Read(ob), results[0]
    judged = np.array([result.changed[loops[0]] for loops in r.polygons])
    judged[[int(f) for p in result.problems for f in p.faces]] = False
    flips = [f for f in judge.flipped_polygons(r) if judged[f]]
    pairs = judge.overlaps(r, apart=judge.islands(r) if command == "unwrap" else None, among=judged)
    pairs = [(f, g) for (_, f), (_, g) in pairs]
    if not flips and not pairs:
        return None
    what = f"{len(flips)} polygons flipped {flips[:3]}, {len(pairs)} pairs overlap {sorted(pairs)[:3]}"
    return f"{command} {seed}: {what}; {[p.message for p in result.problems]}"


def main(first=0, last=100, command=""):
    taut_uv.register()
    wrong = 0
    for seed in range(int(first), int(last)):
        for name in [command] if command else ["unwrap", "atlas"]:
            for collection in (bpy.data.objects, bpy.data.meshes):
                for block in list(collection):
                    collection.remove(block)
            line = judged(seed, name)
            if line:
                wrong += 1
                print(line, flush=True)
    print(f"{wrong} wrong")
    return wrong


if __name__ == "__main__":
    wrong = main(*sys.argv[1:])
    sys.stdout.flush()
    os._exit(bool(wrong))  # Blender's own end of a module may hang
