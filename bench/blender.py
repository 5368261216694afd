#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""blender.py [--repeat N] [--write docs/howto/blender.md] [--only WORD]

Runs the add-on's Unwrap and Atlas and Blender's own unwraps on the same objects, with the same seams and pins, in one
process of Blender as a Python module (scripts/setup --with-blender), operators in edit mode, and judges what the meshes
hold afterwards by bench/peers/judge.py, which neither has a part in. The package taut is that of build/release, or of
PYTHONPATH. --write puts the tables into a page, between the lines that name this program."""

import argparse
import json
import math
import os
import pathlib
import statistics
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
PYTHON = ROOT / "build" / "blender-env" / "bin" / "python"
sys.path[:0] = [str(HERE), str(ROOT / "blender"), str(ROOT / "blender" / "tests")]
sys.path.append(str(ROOT / "build" / "release" / "python"))

UNWRAPS = [
    ("Angle Based", "uv.unwrap", {"method": "ANGLE_BASED"}),
    ("Conformal", "uv.unwrap", {"method": "CONFORMAL"}),
    ("Minimum Stretch", "uv.unwrap", {"method": "MINIMUM_STRETCH"}),
    ("taut Unwrap", "taut.unwrap", {}),
    ("taut, No Overlap", "taut.unwrap", {"no_overlap": True}),
]
ATLASES = [
    ("Smart UV Project", "uv.smart_project", {}),
    ("taut Atlas", "taut.atlas", {}),
    ("taut Atlas, Packing", "taut.atlas", {"prefer": "packing"}),
]


def by_atlas(ob):
    """Seams of an atlas: the same for all."""
    import bpy

    bpy.ops.taut.atlas()
    ob.data.uv_layers.remove(ob.data.uv_layers.active)
    return ob


def objects():
    """Pairs of a name and a function that makes the object alone in its scene."""
    import bpy
    import numpy as np
    from scenes import hill, made, pin, primitive, seams

    def ball():
        ob = primitive("uv_sphere", "Ball", segments=128, ring_count=64)
        seams(ob, lambda a, b: abs(a[1]) < 1e-5 > abs(b[1]) and a[0] > -1e-5 and b[0] > -1e-5)
        return ob

    def monkey():
        ob = primitive("monkey", "Suzanne")
        more = ob.modifiers.new("more", "SUBSURF")
        more.levels = 3
        bpy.ops.object.modifier_apply(modifier="more")
        return by_atlas(ob)

    def rock():
        ob = primitive("ico_sphere", "Rock", subdivisions=6)
        for v in ob.data.vertices:
            x, y, z = v.co
            v.co *= 1 + 0.25 * math.sin(5 * x + 1) * math.cos(4 * y) + 0.1 * math.sin(11 * z + 3 * x)
        return by_atlas(ob)

    def ramp():
        n, turns, rings = 400, 1.7, 12
        V = [(r * math.cos(a), r * math.sin(a), 0.3 * a) for i in range(n + 1) for a in [2 * math.pi * turns * i / n]
             for r in np.linspace(1, 1.8, rings + 1)]
        k = rings + 1
        F = [(i * k + j, i * k + j + 1, (i + 1) * k + j + 1, (i + 1) * k + j) for i in range(n) for j in range(rings)]
        return made("Ramp", V, F)

    def pinned():
        ob = hill(100, 0.8)
        k = 101
        pin(ob, [0, 100, k * k - 1, k * k - 101, 50 * k + 50],
            [(0.05, 0.1), (0.95, 0.05), (0.8, 0.95), (0.1, 0.85), (0.6, 0.45)])
        return ob

    return [("hill", lambda: hill(100, 1.0)), ("steep hill", lambda: hill(100, 6.0)), ("hill, 5 pins", pinned),
            ("ball, one seam", ball), ("Suzanne", monkey), ("rock", rock), ("ramp of 1.7 turns", ramp)]


def measured(make, operator, options, repeat):
    """Seconds of an operator, and what the mesh holds afterwards."""
    import bpy
    import numpy as np
    from judge import Read
    from peers import judge
    from scenes import uv_of

    group, name = operator.split(".")
    seconds = []
    for _ in range(repeat):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        ob = make()
        pins = ob.data.attributes.get(".pn.UVMap")
        held = [i for i, p in enumerate(pins.data) if p.value] if pins else []
        before = uv_of(ob)[held].copy()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        start = time.perf_counter()
        try:
            getattr(getattr(bpy.ops, group), name)(**options)
        except RuntimeError as e:
            return {"error": str(e).strip()}
        seconds.append(time.perf_counter() - start)
        bpy.ops.object.mode_set(mode="OBJECT")
    r = Read(ob)
    F = r.vertex[r.triangles]
    row = judge.judge(r.V, F, r.tri().astype(float))
    row.update(seconds=statistics.median(seconds), triangles=len(F),
               pins=float(np.abs(uv_of(ob)[held] - before).max()) if held else None)
    return {k: (float(v) if isinstance(v, np.floating) else v) for k, v in row.items()}


def cell(row):
    """A row's figures as words of a table."""
    if "error" in row:
        return ["", "", "", "", row["error"][:60]]
    energy = f"{row['energy']:.4g}" if row["flips"] == 0 else f"({row['energy']:.4g})"
    return [f"{row['seconds']:.2f}", str(row["flips"]), f"{100 * row['overlap']:.2f} %", energy,
            "" if row["pins"] is None else ("as they were" if row["pins"] == 0 else f"moved by {row['pins']:.0e}")]


def machine():
    """The processor, as Linux names it."""
    text = pathlib.Path("/proc/cpuinfo").read_text()
    return next(line.split(":")[1].strip() for line in text.splitlines() if line.startswith("model name"))


def table(rows, heads):
    lines = ["| object (triangles) | " + " | ".join(heads) + " |", "|---|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(r) + " |" for r in rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--write", type=pathlib.Path)
    parser.add_argument("--only", default="")
    given = parser.parse_args()
    if pathlib.Path(sys.executable).absolute() != PYTHON.absolute():
        os.execv(PYTHON, [str(PYTHON), *sys.argv])
    import bpy
    import taut_uv

    taut_uv.register()
    tables = {}
    closed = ("Suzanne", "rock", "ball, one seam")
    for title, methods, some in (("unwraps", UNWRAPS, None), ("atlases", ATLASES, closed)):
        rows = []
        for name, make in objects():
            if given.only not in name or some and name not in some:
                continue
            for method, operator, options in methods:
                row = measured(make, operator, options, given.repeat)
                print(json.dumps({"object": name, "method": method, **row}), flush=True)
                first = f"{name} ({row['triangles']:,})" if "triangles" in row else name
                own = cell(row)
                if title == "atlases" and "error" not in row:
                    own[-1:] = [str(row["charts"]), f"{row['seam']:.1f}", f"{100 * row['use']:.0f} %"]
                rows.append([first, method, *own])
        heads = ["command", "seconds", "flips", "overlap", "energy"]
        tables[title] = table(rows, heads + (["pins"] if title == "unwraps" else ["charts", "seams", "use"]))
    if given.write:
        text = given.write.read_text(encoding="utf-8")
        for title, made in tables.items():
            begin, end = f"<!-- bench/blender.py {title} -->", f"<!-- end of {title} -->"
            head, rest = text.split(begin)
            text = f"{head}{begin}\n{made}\n{end}{rest.split(end)[1]}"
        given.write.write_text(text, encoding="utf-8")
    print(f"Blender {bpy.app.version_string}, {machine()}, {os.cpu_count()} processors")
    print("\n\n".join(tables.values()))


if __name__ == "__main__":
    main()
