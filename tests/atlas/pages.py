#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pages.py TAUT FOLDER: pages of `taut atlas`: their sizes, density, blocks, tiles, and charts that are packed as they are."""
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys

TAUT, FOLDER = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])


def run(*words, code=0):
    done = subprocess.run([str(TAUT), *map(str, words)], cwd=FOLDER, capture_output=True, text=True, timeout=120)
    assert done.returncode == code, (words, done.returncode, done.stdout, done.stderr)
    return done.stdout if code == 0 else done.stderr


def bumpy(n=20, m=12):
    """A ball with bumps, two materials: below and above."""
    lines, top = ["v 0 0 -1", "v 0 0 1"], []
    for j in range(1, m):
        for i in range(n):
            a, b = 2 * math.pi * i / n, math.pi * (j / m - 0.5)
            r = 1 + 0.1 * math.sin(3 * a)
            lines.append("v %.9f %.9f %.9f" % (r * math.cos(a) * math.cos(b), r * math.sin(a) * math.cos(b), math.sin(b)))
    at = lambda i, j: 3 + (j - 1) * n + i % n
    for half, rows in (("below", range(0, m // 2)), ("above", range(m // 2, m))):
        top.append("usemtl " + half)
        for j in rows:
            for i in range(n):
                a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
                if j == 0:
                    top.append("f 1 %d %d" % (c, d))
                elif j == m - 1:
                    top.append("f 2 %d %d" % (a, b))
                else:
                    top += ["f %d %d %d" % (a, b, c), "f %d %d %d" % (a, c, d)]
    (FOLDER / "ball.obj").write_text("\n".join(lines + top) + "\n")


def read(name):
    """Points, triangles, texture coordinates of corners, materials."""
    points, uv, faces, corners, materials, now = [], [], [], [], [], None
    for line in (FOLDER / name).read_text().splitlines():
        w = line.split()
        if w[:1] == ["v"]:
            points.append(tuple(map(float, w[1:4])))
        elif w[:1] == ["vt"]:
            uv.append(tuple(map(float, w[1:3])))
        elif w[:1] == ["usemtl"]:
            now = w[1]
        elif w[:1] == ["f"]:
            faces.append([int(x.split("/")[0]) - 1 for x in w[1:]])
            corners.append([int(x.split("/")[1]) - 1 for x in w[1:]])
            materials.append(now)
    return points, faces, uv, corners, materials


def area2(a, b, c):
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2


def area3(a, b, c):
    u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    return math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2


def density(name, width, height):
    """Texels of a unit of length, from areas."""
    points, faces, uv, corners, _ = read(name)
    plane = sum(area2(*((uv[t][0] * width, uv[t][1] * height) for t in c)) for c in corners)
    assert all(area2(*(uv[t] for t in c)) > 0 for c in corners)
    return math.sqrt(plane / sum(area3(*(points[v] for v in f)) for f in faces))


def charts_of(corners):
    """Texture coordinates by chart: they share none."""
    root = {}

    def find(x):
        while root.setdefault(x, x) != x:
            x = root[x]
        return x

    for c in corners:
        for t in c[1:]:
            root[find(t)] = find(c[0])
    return [find(c[0]) for c in corners]


def stats():
    return json.loads((FOLDER / "s.json").read_text())


def atlas(*words):
    run("atlas", "ball.obj", "-o", "out.obj", "--quiet", "--stats", "s.json", *words)
    told = stats()
    assert told["flipped"] == told["overlaps"] == 0
    assert told["least_distance"] >= told["padding"] * (1 - 1e-9), told["least_distance"]
    return told


def test_pages_are_wide_or_high():
    for width, height in ((1024, 512), (256, 1024)):
        told = atlas("--resolution", f"{width}x{height}", "--prefer", "packing")
        points, faces, uv, corners, _ = read("out.obj")
        assert max(v for _, v in uv) <= 1 and max(u for u, _ in uv) <= 1
        # Triangles have their shape on a page of texels, not in the square.
        assert told["resolution"] == width and told["distortion"] < 4.1
        ratio = [math.dist((uv[c[0]][0] * width, uv[c[0]][1] * height), (uv[c[1]][0] * width, uv[c[1]][1] * height)) /
                 math.dist(points[f[0]], points[f[1]]) for f, c in zip(faces, corners)]
        assert max(ratio) / min(ratio) < 2, (min(ratio), max(ratio))
    assert "power of two" in run("atlas", "ball.obj", "-o", "x.obj", "--resolution", "1000x700", code=2)
    assert "WIDTHxHEIGHT" in run("atlas", "ball.obj", "-o", "x.obj", "--resolution", "0", code=2)


def test_texels_per_unit():
    told = atlas("--texels-per-unit", 60, "--resolution", 512)
    assert told["tiles"] == 1 and abs(density("out.obj", 512, 512) / 60 - 1) < 0.02
    told = atlas("--texels-per-unit", 200, "--resolution", 512, "--prefer", "packing", "--max-distortion", 4.01)
    assert told["tiles"] > 2
    _, _, uv, corners, _ = read("out.obj")
    assert {int(u) + 10 * int(v) for u, v in uv} == set(range(told["tiles"]))
    assert abs(density("out.obj", 512, 512) / 200 - 1) < 0.02
    told = atlas("--texels-per-unit", 300, "--resolution", 256, "--max-resolution", 8192)
    assert told["tiles"] == 1 and told["resolution"] in (2048, 4096)
    assert abs(density("out.obj", told["resolution"], told["resolution"]) / 300 - 1) < 0.02
    assert "do not fit" in run("atlas", "ball.obj", "-o", "x.obj", "--texels-per-unit", 9000, "--udim", 2, code=4)


def test_blocks_and_mip_maps():
    told = atlas("--align", 4, "--resolution", 256, "--prefer", "packing")
    _, faces, uv, corners, _ = read("out.obj")
    label, low = charts_of(corners), {}
    for k, c in zip(label, corners):
        for t in c:
            x = low.setdefault(k, [9, 9])
            x[:] = [min(p, q) for p, q in zip(x, uv[t])]
    for x in low.values():
        for p in x:
            assert abs(p * 64 - round(p * 64)) < 0.05, p
    assert atlas("--mip-levels", 2)["padding"] == 12
    assert "one of them" in run("atlas", "ball.obj", "-o", "x.obj", "--mip-levels", 2, "--padding", 2, code=2)


def test_charts_below_a_texel_are_told():
    """A blade: its long sides are less than a texel wide, unless the resolution is high."""
    box = [(x, y, z) for z in (0, 0.01) for y in (0, 1) for x in (0, 100)]
    sides = ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6))
    text = ["v %g %g %g" % p for p in box] + ["f %d %d %d\nf %d %d %d" % (a, b, c, a, c, d) for a, b, c, d in sides]
    (FOLDER / "blade.obj").write_text("\n".join(text) + "\n")
    seams = [(a, b) for side in sides for a, b in zip(side, side[1:] + side[:1]) if a < b]
    (FOLDER / "blade.txt").write_text("".join("%d %d\n" % (a - 1, b - 1) for a, b in seams))

    def notes(*options):
        run("atlas", "blade.obj", "-o", "blade.out.obj", "--seams", "blade.txt", "--quiet", "--stats", "blade.json", *options)
        return [n for n in json.loads((FOLDER / "blade.json").read_text())["notes"] if "thinner than a texel" in n]

    assert notes("--resolution", 1024) and notes("--resolution", 1024)[0].startswith("4 charts are"), notes("--resolution", 1024)
    assert notes("--texels-per-unit", 4, "--resolution", 1024) and not notes("--texels-per-unit", 200, "--resolution", 32768)


def test_a_tile_for_each_material():
    told = atlas("--tile-per-material")
    _, _, uv, corners, materials = read("out.obj")
    for name, c in zip(materials, corners):
        assert {int(uv[t][0]) for t in c} == {0 if name == "below" else 1}
    assert told["tiles"] == 2


def test_charts_are_packed_as_they_are():
    atlas("--prefer", "packing")
    _, faces, uv, corners, _ = read("out.obj")
    # Two charts are made smaller and mirrored by hand: packing gives them their size and side.
    label = charts_of(corners)
    some = sorted(set(label))[:2]
    text = (FOLDER / "out.obj").read_text().splitlines()
    moved, number = {t for k, c in zip(label, corners) if k in some for t in c}, -1
    for i, line in enumerate(text):
        if line.startswith("vt "):
            number += 1
            if number in moved:
                u, v = map(float, line.split()[1:3])
                text[i] = "vt %.12g %.12g" % (3 - 0.2 * u, 0.2 * v)
    (FOLDER / "moved.obj").write_text("\n".join(text) + "\n")
    run("atlas", "moved.obj", "-o", "packed.obj", "--charts", "pack", "--quiet", "--stats", "s.json")
    told = stats()
    assert told["flipped"] == 0 and told["charts"] == len(set(label))
    points, faces, after, now, _ = read("packed.obj")
    # Each chart is similar to what it was: one scale.
    for k in set(label):
        ratios = [math.dist(after[n[0]], after[n[1]]) / math.dist(uv[c[0]], uv[c[1]])
                  for n, c, l in zip(now, corners, label) if l == k]
        assert max(ratios) / min(ratios) < 1 + 1e-4, (min(ratios), max(ratios))
    # The same in several files: one atlas.
    run("atlas", "moved.obj", "out.obj", "-o", "a.obj", "-o", "b.obj", "--charts", "pack", "--quiet", "--stats", "s.json")
    assert stats()["charts"] == 2 * told["charts"]
    # A folded chart is refused.
    text[next(i for i, line in enumerate(text) if line.startswith("vt "))] = "vt 7 7"
    (FOLDER / "folded.obj").write_text("\n".join(text) + "\n")
    assert "folded" in run("atlas", "folded.obj", "-o", "x.obj", "--charts", "pack", code=6)


def cut_lengths(name):
    """Length of the seams below and above the middle."""
    points, faces, uv, corners, _ = read(name)
    sides, sums = {}, [0, 0]
    for f, c in zip(faces, corners):
        for k in range(3):
            a, b = (f[k], c[k]), (f[(k + 1) % 3], c[(k + 1) % 3])
            sides.setdefault(tuple(sorted((a[0], b[0]))), []).append(tuple(sorted((a, b))))
    for (a, b), both in sides.items():
        if len(both) == 2 and both[0] != both[1]:
            sums[points[a][2] + points[b][2] > 0] += math.dist(points[a], points[b])
    return sums


def test_seams_are_weighed():
    z = [float(line.split()[3]) for line in (FOLDER / "ball.obj").read_text().splitlines() if line.startswith("v ")]
    (FOLDER / "weights.txt").write_text("# above\n" + "".join("%d, 50\n" % v for v in range(len(z)) if z[v] > 0.05))
    atlas()
    plain = cut_lengths("out.obj")
    atlas("--seam-weights", "weights.txt")
    painted = cut_lengths("out.obj")
    assert painted[1] < plain[1] and painted[1] < painted[0], (plain, painted)
    told = atlas("--hide-seams", "strong", "--crease-angle", 60)
    assert 0 < told["seen_seam"] <= 1
    (FOLDER / "edges.txt").write_text("0 2 0.5\n1 2\n3 4 5 6\n")
    assert "edges.txt, line 3" in run("atlas", "ball.obj", "-o", "x.obj", "--seam-weights", "edges.txt", code=3)
    (FOLDER / "edges.txt").write_text("0 2 0\n")
    assert "0.001" in run("atlas", "ball.obj", "-o", "x.obj", "--seam-weights", "edges.txt", code=3)
    (FOLDER / "edges.txt").write_text("0 99999 2\n")
    assert "whole numbers from 0" in run("atlas", "ball.obj", "-o", "x.obj", "--seam-weights", "edges.txt", code=3)
    (FOLDER / "edges.txt").write_text("0 %d 2\n" % (len(z) - 1))
    assert "have no edge" in run("atlas", "ball.obj", "-o", "x.obj", "--seam-weights", "edges.txt", code=4)
    assert "leave out" in run("atlas", "out.obj", "-o", "x.obj", "--charts", "keep", "--hide-seams", "mild", code=2)


def test_stretch_is_bounded():
    for bound in (1.01, 1.05):
        told = atlas("--max-stretch", bound)
        assert 1 < told["stretch_l2"] <= bound, told["stretch_l2"]
    assert "not above 1" in run("atlas", "ball.obj", "-o", "x.obj", "--max-stretch", 1, code=2)
    assert "leave out" in run("atlas", "ball.obj", "-o", "x.obj", "--max-stretch", 1.1, "--mean-distortion", 4.1, code=2)


def test_copies_lie_on_each_other():
    text = (FOLDER / "ball.obj").read_text().splitlines()
    points = [tuple(map(float, line.split()[1:4])) for line in text if line.startswith("v ")]
    points = [(x + 0.2 * y * z, y + 0.1 * x * x, z) for x, y, z in points]  # no symmetry of its own
    lines, f = [], [line for line in text if line.startswith("f ")]
    # A copy that is turned and moved, and a mirrored one.
    for move in (lambda x, y, z: (x, y, z), lambda x, y, z: (5 - y, x, z + 1), lambda x, y, z: (x, -y, z - 5)):
        lines += ["v %.9f %.9f %.9f" % move(*p) for p in points]
    for k in range(3):
        for line in f:
            c = [str(int(w) + k * len(points)) for w in line.split()[1:]]
            lines.append("f " + " ".join(c if k < 2 else c[::-1]))
    (FOLDER / "three.obj").write_text("\n".join(lines) + "\n")
    run("atlas", "three.obj", "-o", "three.uv.obj", "--prefer", "packing", "--stack", "similar", "--quiet", "--stats", "s.json")
    told = stats()
    assert told["flipped"] == told["overlaps"] == 0
    assert told["charts"] == 3 * told["stacked"], (told["charts"], told["stacked"])
    points, faces, uv, corners, _ = read("three.uv.obj")
    n = len(faces) // 3
    where = [tuple(sorted(uv[t] for t in c)) for c in corners]
    assert set(where[:n]) == set(where[n:2 * n]) and len(set(where[:n])) == n
    assert not set(where[2 * n:]) & set(where[:2 * n])


def glb(name):
    data = (FOLDER / name).read_bytes()
    size = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20:20 + size])


def test_a_second_set_from_the_charts_of_the_first():
    run("atlas", "ball.obj", "-o", "first.glb", "--quiet", "--prefer", "packing", "--stats", "s.json")
    charts = stats()["charts"]
    run("atlas", "first.glb", "-o", "both.glb", "--charts", "pack", "--read-texcoord-set", 0, "--texcoord-set", 1,
        "--mip-levels", 2, "--resolution", 512, "--quiet", "--stats", "s.json")
    assert stats()["charts"] == charts
    attributes = glb("both.glb")["meshes"][0]["primitives"][0]["attributes"]
    assert "TEXCOORD_0" in attributes and "TEXCOORD_1" in attributes


shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir(parents=True)
bumpy()
for name, test in list(globals().items()):
    if name.startswith("test_"):
        test()
        print("passed:", name[5:])
