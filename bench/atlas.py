#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""atlas.py [--taut PROGRAM] [--meshes FOLDER] [--names NAME,...] [--closed N]... [--noisy N]... [--rough N]... [--noise S]
         [--limit S] [--out FOLDER] [-- OPTION...]
Makes atlases with `taut atlas --repair OPTION...`, one run a mesh, and prints a table: what became of each, charts, seams
by the root of the area, mean and worst isometric energy, use of the square, processor seconds of the program, and its
seconds by stage.

--meshes  every OFF, OBJ, PLY and STL file of a folder
--names   of these some, without endings
--closed  a generated closed scan of about N triangles: a ball with bumps of many sizes
--noisy   a generated mesh of about N triangles, a fifth of whose edges have three or more: walls between pieces of a ball
--rough   a ball and a box of about N triangles whose vertices are moved at random, by --noise (0.03) of the size
--limit   seconds after which what there is is taken, and twice that after which a run is ended (60)
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys

import numpy as np


def write_off(path, points, triangles):
    with open(path, "w") as out:
        out.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        np.savetxt(out, points, "%.9g")
        np.savetxt(out, np.column_stack([np.full(len(triangles), 3), triangles]), "%d")


def geodesic_sphere(n):
    """The icosahedron with n^2 triangles a face, on the unit sphere."""
    phi = (1 + 5 ** 0.5) / 2
    corners = np.array([(s, t * phi, 0) for s in (-1, 1) for t in (-1, 1)])
    corners = np.concatenate([np.roll(corners, k, 1) for k in range(3)])
    distance = np.linalg.norm(corners[:, None] - corners[None], axis=2)
    faces = [(i, j, k) for i in range(12) for j in range(i) for k in range(j)
             if max(distance[i, j], distance[j, k], distance[k, i]) < 2.1]
    rows, columns = np.array([(r, c) for r in range(n + 1) for c in range(r + 1)]).T
    index = {(r, c): i for i, (r, c) in enumerate(zip(rows, columns))}
    cells = [(index[r, c], index[r + 1, c], index[r + 1, c + 1]) for r in range(n) for c in range(r + 1)]
    cells += [(index[r, c], index[r + 1, c + 1], index[r, c + 1]) for r in range(n) for c in range(r)]
    cells = np.array(cells)
    points, triangles = [], []
    for i, j, k in faces:
        a, b, c = corners[i], corners[j], corners[k]
        turned = np.dot(np.cross(b - a, c - a), a) < 0
        points.append(a + np.outer(rows / n, b - a) + np.outer(columns / n, c - b))
        triangles.append((cells[:, ::-1] if turned else cells) + len(rows) * len(triangles))
    points = np.concatenate(points)
    points /= np.linalg.norm(points, axis=1)[:, None]
    _, first, welded = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    return points[first], welded.reshape(-1)[np.concatenate(triangles)]


def closed_scan(count, seed=1):
    """A ball with bumps of many sizes, and the noise of a scanner."""
    points, triangles = geodesic_sphere(round((count / 20) ** 0.5))
    rng = np.random.default_rng(seed)
    height = np.zeros(len(points))
    for octave in range(5):
        for _ in range(6):
            wave = rng.normal(size=3) * 2.0 ** (octave + 1)
            height += 0.16 * 0.45 ** octave * np.sin(points @ wave + rng.uniform(0, 2 * np.pi))
    height += rng.normal(scale=0.02 / len(points) ** 0.5, size=len(points))
    return points * (1 + height)[:, None], triangles


def noisy(count, seed=1, side=3, labels=8):
    """The walls between labelled voxels of a ball, each once and facing anywhere, with vertices moved at random."""
    n = max(4, round((count / 1.167) ** (1 / 3)))
    rng = np.random.default_rng(seed)
    i = np.arange(n)
    g = (i - (n - 1) / 2) / (n / 2)
    inside = g[:, None, None] ** 2 + g[None, :, None] ** 2 + g[None, None, :] ** 2 < 0.8
    coarse = rng.integers(1, labels + 1, (n // side + 2,) * 3)
    at = [(i.reshape([-1 if a == k else 1 for a in range(3)]) + rng.integers(0, 2, (n,) * 3)) // side for k in range(3)]
    label = np.pad(np.where(inside, coarse[tuple(at)], 0), 1)
    size = n + 3
    triangles = []
    for axis in range(3):
        low, high = label.take(range(n + 1), axis), label.take(range(1, n + 2), axis)
        voxel = np.argwhere(low != high)
        e, f = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        voxel[:, axis] += 1
        a, b, c, d = ((p[:, 0] * size + p[:, 1]) * size + p[:, 2] for p in (voxel, voxel + e, voxel + e + f, voxel + f))
        turned = rng.random(len(voxel)) < 0.5
        for t in (np.stack([a, b, c], 1), np.stack([a, c, d], 1)):
            t[turned] = t[turned][:, ::-1]
            triangles.append(t)
    used, triangles = np.unique(np.concatenate(triangles), return_inverse=True)
    points = np.stack([used // size ** 2, used // size % size, used % size], 1) + 0.25 * (rng.random((len(used), 3)) - 0.5)
    return points, triangles.reshape(-1, 3)


def cube(count):
    """The unit cube, its sides divided into squares."""
    n = round((count / 12) ** 0.5)
    i, j = np.divmod(np.arange(n * n), n)
    triangles, points = [], []
    for axis in range(3):
        for side in 0, n:
            corners = []
            for x, y in (0, 0), (1, 0), (1, 1), (0, 1):
                p = np.full((n * n, 3), side)
                p[:, (axis + 1) % 3], p[:, (axis + 2) % 3] = i + x, j + y
                points.append(p)
                corners.append(np.arange(n * n) + n * n * (len(points) - 1))
            a, b, c, d = corners if side else corners[::-1]
            triangles += [np.stack([a, b, c], 1), np.stack([a, c, d], 1)]
    points, index = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return points / n, index.reshape(-1)[np.concatenate(triangles)]


def rough(points, part, seed=1):
    size = np.max(np.ptp(points, axis=0))
    return points + np.random.default_rng(seed).normal(scale=part * size, size=points.shape)


def crowded(triangles):
    """The part of the edges that has three or more triangles."""
    edges = np.sort(np.concatenate([triangles[:, k] for k in ([0, 1], [1, 2], [2, 0])]), 1)
    return np.mean(np.unique(edges, axis=0, return_counts=True)[1] > 2)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--taut", default=pathlib.Path(__file__).parent.parent / "build/release/bin/taut")
    parser.add_argument("--meshes", type=pathlib.Path)
    parser.add_argument("--closed", type=int, action="append", default=[])
    parser.add_argument("--noisy", type=int, action="append", default=[])
    parser.add_argument("--rough", type=int, action="append", default=[])
    parser.add_argument("--noise", type=float, default=0.03)
    parser.add_argument("--names", default="")
    parser.add_argument("--limit", type=float, default=60)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("build/bench-atlas"))
    parser.add_argument("options", nargs="*")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)

    meshes = []
    def rough_ball(count):
        points, triangles = geodesic_sphere(round((count / 20) ** 0.5))
        return rough(points, given.noise), triangles

    def rough_box(count):
        points, triangles = cube(count)
        return rough(points, given.noise), triangles

    for kind, make, sizes in (("closed", closed_scan, given.closed), ("noisy", noisy, given.noisy),
                              ("ball", rough_ball, given.rough), ("box", rough_box, given.rough)):
        for count in sizes:
            points, triangles = make(count)
            meshes.append(given.out / f"{kind}-{count}.off")
            write_off(meshes[-1], points, triangles)
            print(f"{meshes[-1].name}: {len(triangles)} triangles, {100 * crowded(triangles):.1f} % of edges crowded")
    if given.meshes:
        names = [n for n in given.names.split(",") if n]
        meshes += sorted(p for p in given.meshes.iterdir() if p.suffix.lower() in (".off", ".obj", ".ply", ".stl") and
                         (not names or p.stem in names))

    print("mesh | triangles | charts | seam | mean | worst | use | flipped | overlaps | CPU s | total s | device | charts | "
          "flatten | pack | certify\n--- | " + "---: | " * 14 + "---:")
    ended = {}
    for mesh in meshes:
        name = given.out / mesh.name
        stats = pathlib.Path(f"{name}.json")
        stats.unlink(missing_ok=True)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            code = subprocess.run([given.taut, "atlas", mesh, "-o", f"{name}.obj", "--repair", "--quiet", "--stats", stats,
                                   "--time-limit", str(given.limit), *given.options], timeout=2 * given.limit,
                                  stderr=subprocess.PIPE).returncode
        except subprocess.TimeoutExpired:
            code = "none, as it was ended"
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        ended[code] = ended.get(code, 0) + 1
        row = [mesh.stem, f"code {code}"]
        if stats.exists():
            s = json.loads(stats.read_text())
            t = s["seconds"]
            cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            row = [mesh.stem, sum(f["faces"] for f in s["surfaces"]), s["charts"], f'{s["relative_seam"]:.2f}',
                   f'{s["distortion"]:.4f}', f'{s["worst_distortion"]:.3f}', f'{100 * s["utilization"]:.0f} %',
                   s["flipped"], s["overlaps"], f"{cpu:.2f}"]
            row += [f"{t[k]:.2f}" for k in ("total", "device", "charts", "flatten", "pack", "certify")]
        print(" | ".join(map(str, row)), flush=True)
    print(f"{len(meshes)} meshes: " + ", ".join(f"{n} ended with code {code}" for code, n in ended.items()))


if __name__ == "__main__":
    sys.exit(main())
