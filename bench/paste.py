#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""paste.py TAUT MESHES [FOLDER]: features of real meshes on other ones, as a table.

MESHES is the folder meshes of the Debian package libcgal-demo, unpacked. Each pair is pasted at three softnesses, and once made anew from its map at
softness 0, where the distance is that of Hausdorff, sampled, in texels. FOLDER gets surfaces and pictures."""
import json
import pathlib
import subprocess
import sys
import tempfile

PAIRS = (
    ("mannequin-devil", 571, 6, "bear", 13600, 0.03, 0, "nose of a head on a bear's belly"),
    ("lion-head", 6353, 0.45, "bear", 12546, 0.9, 200, "face of a lion on a bear's face"),
    ("bear", 7860, 0.35, "bunny00", 2192, 0.5, 0, "ear of a bear on a bunny's side"),
)


def paste(program, meshes, folder, pair, name, *options):
    source, at, radius, target, onto, scale, degrees, _ = pair
    stats = folder / f"{name}.json"
    subprocess.run([program, "paste", "-q", "--source", meshes / f"{source}.off", "--at", str(at), "--radius", str(radius),
                    "--target", meshes / f"{target}.off", "--onto", str(onto), "--scale", str(scale), "--rotate", str(degrees),
                    "-o", folder / f"{name}.obj", "--picture", folder / f"{name}.png", "--stats", stats, *options], check=True)
    return json.loads(stats.read_text())


def main():
    program, meshes = sys.argv[1], pathlib.Path(sys.argv[2])
    folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    print("| pair (triangles of feature, target) | softness | angle across the rim, median / most | boundary edges | degenerate | folded | meet anew |")
    print("|---|---|---|---|---|---|---|")
    anew = []
    for k, pair in enumerate(PAIRS):
        for softness in ("0", "0.5", "1"):
            s = paste(program, meshes, folder, pair, f"{k + 1}-{softness}", "--softness", softness)
            first = f"{pair[7]} ({s['feature_triangles']:,}, {s['target_triangles']:,})" if softness == "0" else ""
            print(f"| {first} | {softness} | {s['rim_angle_median']:.1f} / {s['rim_angle_largest']:.0f} | {s['boundary_edges']} | "
                  f"{s['degenerate_triangles']} | {s['folded_edges']} | {s['self_intersections']} |", flush=True)
            assert s["manifold"]
        s = paste(program, meshes, folder, pair, f"{k + 1}-map", "--triangles", "40000")
        anew.append((pair[7], s["feature_triangles"], s["map"]["distance"] / s["map"]["footprint"], s["degenerate_triangles"], s["self_intersections"]))
    print("\n| made anew | triangles | distance, texels | degenerate | meet anew |\n|---|---|---|---|---|")
    for name, triangles, distance, degenerate, meet in anew:
        print(f"| {name} | {triangles:,} | {distance:.2f} | {degenerate} | {meet} |")


main()
