#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""program.py TAUT FOLDER: `taut atlas` as its users meet it. Its results are judged by other code than its own."""
import json
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

import shapes

TAUT, FOLDER = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])


# Meshes

def ball(n, radius=1.0, bumps=0.0):
    """A closed surface: a cube with n^2 squares a face, blown up, with bumps."""
    def place(p):
        x = [math.tan((2 * c / n - 1) * math.pi / 4) for c in p]
        length = math.sqrt(sum(c * c for c in x))
        x = [c / length for c in x]
        r = radius * (1 + bumps * math.sin(5 * x[0] + 1) * math.sin(4 * x[1]) * math.cos(6 * x[2]))
        return [r * c for c in x]

    return shapes.cube(n, place)


def torus(n, m, R=2.0, r=0.7):
    points = [[(R + r * math.cos(2 * math.pi * j / m)) * math.cos(2 * math.pi * i / n),
               (R + r * math.cos(2 * math.pi * j / m)) * math.sin(2 * math.pi * i / n),
               r * math.sin(2 * math.pi * j / m)] for i in range(n) for j in range(m)]
    triangles = []
    for i in range(n):
        for j in range(m):
            a, b, c, d = i * m + j, (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m
            triangles += [[a, b, c], [a, c, d]]
    return points, triangles


def obj(points, faces):
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points) + \
           "".join("f " + " ".join(str(v + 1) for v in f) + "\n" for f in faces)


def write(name, points, faces):
    pathlib.Path(name).write_text(obj(points, faces))


# What comes back

def read(name):
    points, uv, faces, texcoords = [], [], [], []
    for line in pathlib.Path(name).read_text().splitlines():
        word = line.split()
        if word and word[0] == "v":
            points.append([float(x) for x in word[1:4]])
        elif word and word[0] == "vt":
            uv.append((float(word[1]), float(word[2])))
        elif word and word[0] == "f":
            corners = [c.split("/") for c in word[1:]]
            faces.append([int(c[0]) - 1 for c in corners])
            texcoords.append([int(c[1]) - 1 if len(c) > 1 and c[1] else None for c in corners])
    return points, uv, faces, texcoords


def seams_of(name):
    """The edges of triangles, smaller vertex first, whose two sides lie in different places."""
    _, uv, faces, texcoords = read(name)
    sides = {}
    for f, t in zip(faces, texcoords):
        for k in range(3):
            sides.setdefault(tuple(sorted((f[k], f[k - 1]))), []).append({uv[t[k]], uv[t[k - 1]]})
    return {edge for edge, places in sides.items() if len(places) == 2 and places[0] != places[1]}


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def judge(name, points, faces, dropped=(), samples=512, tiles=1):
    """The file has these vertices and faces in their order, none flipped, no sample of a grid covered twice."""
    got, uv, got_faces, texcoords = read(name)
    assert got == points and got_faces == faces, f"{name}: vertices or faces have changed"
    count = {}
    for f, corners in enumerate(texcoords):
        if f in dropped:
            assert all(c is None for c in corners), f"{name}: face {f} was left out and has vt"
            continue
        t = [uv[c] for c in corners]
        for k in range(1, len(t) - 1):
            a, b, c = t[0], t[k], t[k + 1]
            assert cross(a, b, c) > 0, f"{name}: face {f} is flipped"
            low = [min(p[d] for p in (a, b, c)) for d in (0, 1)]
            high = [max(p[d] for p in (a, b, c)) for d in (0, 1)]
            assert low[0] >= 0 and low[1] >= 0 and high[0] <= tiles and high[1] <= 1, f"{name}: outside of the square"
            for i in range(math.floor(low[0] * samples), math.ceil(high[0] * samples) + 1):
                for j in range(math.floor(low[1] * samples), math.ceil(high[1] * samples) + 1):
                    p = ((i + 0.37) / samples, (j + 0.61) / samples)
                    if cross(a, b, p) > 0 and cross(b, c, p) > 0 and cross(c, a, p) > 0:
                        assert (i, j) not in count, f"{name}: faces {count[i, j]} and {f} overlap"
                        count[i, j] = f
    return len(count) / samples ** 2


def run(*arguments, code=0):
    done = subprocess.run([TAUT, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == code, f"taut {arguments}: code {done.returncode}, not {code}\n{done.stdout}{done.stderr}"
    return done


def stats(name):
    s = json.loads(pathlib.Path(name).read_text())
    assert s["schema"] == "taut.atlas/1"
    assert s["flipped"] == s["branch_points"] == s["overlaps"] == 0
    return s


# Cases

def closed_surfaces():
    for name, (points, faces) in {"ball": ball(12, bumps=0.2), "torus": torus(40, 16)}.items():
        write(f"{name}.obj", points, faces)
        told = run("atlas", f"{name}.obj", "-o", f"{name}.out.obj", "--stats", "s.json", "--picture", "p.png",
                   "--render", "r.png").stdout
        assert "certificate" in told and "0 flips, 0 overlaps" in told, told
        s = stats("s.json")
        use = judge(f"{name}.out.obj", points, faces)
        assert abs(use - s["utilization"]) < 0.02, (use, s["utilization"])
        assert s["utilization"] > 0.3 and 4 <= s["distortion"] <= 4.1, (s["utilization"], s["distortion"])
        assert s["charts"] == len(s["chart_table"]) <= 4, s["charts"]
        assert pathlib.Path("s.json").read_text().count('\n    {"triangles": ') == s["charts"], "a chart a line"
        assert sum(c["triangles"] for c in s["chart_table"]) == len(faces)
        assert s["least_distance"] >= s["padding"] * (1 - 1e-9)
        assert pathlib.Path("p.png").stat().st_size > 1000 and pathlib.Path("r.png").stat().st_size > 1000
        again = run("atlas", f"{name}.obj", "-o", "again.obj", "--quiet")
        assert again.stdout == "" and pathlib.Path("again.obj").read_bytes() == \
            pathlib.Path(f"{name}.out.obj").read_bytes(), "not the same twice"
        run("atlas", f"{name}.obj", "-o", "packed.obj", "--prefer", "packing", "--stats", "p.json")
        p = stats("p.json")
        judge("packed.obj", points, faces)
        assert p["utilization"] > 0.4 and 4 <= p["distortion"] <= 4.05 and p["worst_distortion"] <= 4.21
        assert p["seam_length"] > s["seam_length"] and p["charts"] < len(faces) / 10, p["charts"]


def short_seams():
    """Few charts within the bound; a looser one makes no more of them, nor longer seams, beyond a tenth."""
    points, faces = ball(24, bumps=0.3)
    write("bumps.obj", points, faces)
    before = None
    for bound in (4.03, 4.1, 4.3):
        run("atlas", "bumps.obj", "-o", "out.obj", "--mean-distortion", bound, "--stats", "s.json")
        s = stats("s.json")
        judge("out.obj", points, faces)
        assert s["distortion"] <= bound, s["distortion"]
        if before:
            assert s["charts"] <= before["charts"] + 1 and s["seam_length"] < 1.1 * before["seam_length"], bound
        before = s
    run("atlas", "bumps.obj", "-o", "out.obj", "--prefer", "one", "--stats", "s.json")
    assert stats("s.json")["charts"] == 1
    judge("out.obj", points, faces)

    # Given seams stay, and a run on one thread is the same.
    a, b, c = faces[40]
    pathlib.Path("edge.txt").write_text(f"{a} {b}\n{b} {c}\n")
    run("atlas", "bumps.obj", "-o", "out.obj", "--seams", "edge.txt")
    assert {tuple(sorted((a, b))), tuple(sorted((b, c)))} <= seams_of("out.obj")
    one = subprocess.run([TAUT, "atlas", "bumps.obj", "-o", "one.obj", "--seams", "edge.txt"], check=True,
                         capture_output=True, env={**os.environ, "TAUT_THREADS": "1"})
    assert one.returncode == 0 and pathlib.Path("one.obj").read_bytes() == pathlib.Path("out.obj").read_bytes()

    # So is one of a rough surface, whose charts are parted where they lie on themselves.
    rng = random.Random(2)
    points, faces = ball(12)
    write("jagged.obj", [[c + rng.gauss(0, 0.06) for c in p] for p in points], faces)
    made = []
    for threads in "12":
        subprocess.run([TAUT, "atlas", "jagged.obj", "-o", "jagged.uv.obj", "--quiet"], check=True,
                       env={**os.environ, "TAUT_THREADS": threads, "POCL_MAX_PTHREAD_COUNT": threads})
        made.append(pathlib.Path("jagged.uv.obj").read_bytes())
    assert made[0] == made[1]


def parts_holes_and_padding():
    points, faces = ball(8)
    more, others = torus(24, 10)
    both = points + [[x + 5, y, z] for x, y, z in more], faces[2:] + [[v + len(points) for v in f] for f in others]
    write("both.obj", *both)
    run("atlas", "both.obj", "-o", "out.obj", "--padding", 8, "--resolution", 256, "--no-rotation", "--stats", "s.json",
        "--max-distortion", 5)
    s = stats("s.json")
    assert s["least_distance"] >= 8 * (1 - 1e-9) and s["worst_distortion"] <= 5
    judge("out.obj", *both)
    fewer = s["charts"]
    run("atlas", "both.obj", "-o", "out.obj", "--max-distortion", 4.01, "--stats", "s.json", "--udim", 2)
    s = stats("s.json")
    assert s["worst_distortion"] <= 4.01 and s["charts"] > fewer and s["tiles"] == 2
    judge("out.obj", *both, tiles=2)

    # A corner is not cut off one of several bowls for what that happens to gain.
    n = 20
    bowl = [[x, y, 0.7 * ((2 * x / n - 1) ** 2 + (2 * y / n - 1) ** 2) * n] for y in range(n + 1) for x in range(n + 1)]
    halves = [[a, b, c] for y in range(n) for x in range(n) for a in [y * (n + 1) + x]
              for b, c in ((a + 1, a + n + 2), (a + n + 2, a + n + 1))]
    for count in (1, 2, 3):
        points = [[x + 2 * n * k, y, z] for k in range(count) for x, y, z in bowl]
        faces = [[v + k * len(bowl) for v in f] for k in range(count) for f in halves]
        write("bowls.obj", points, faces)
        run("atlas", "bowls.obj", "-o", "out.obj", "--stats", "s.json")
        assert stats("s.json")["charts"] == count, (count, stats("s.json")["charts"])
        judge("out.obj", points, faces)


def repairs():
    points, faces = ball(6)
    broken = points + [[9.0, 9.0, 9.0]], faces + [faces[3], [0, 1, 1]]
    broken[1][5] = broken[1][5][::-1]
    write("broken.obj", *broken)
    done = run("atlas", "broken.obj", "-o", "none.obj", code=4)
    assert "--repair" in done.stderr, done.stderr
    assert not pathlib.Path("none.obj").exists()
    write("flat.obj", [[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    done = run("atlas", "flat.obj", "-o", "none.obj", code=4)
    assert "--repair would leave no triangle" in done.stderr and "repairs it" not in done.stderr, done.stderr
    run("atlas", "broken.obj", "-o", "out.obj", "--repair", "--stats", "s.json")
    s = stats("s.json")
    assert s["surfaces"][0]["mapped"] == len(faces)
    kinds = {r["fault"] for r in s["surfaces"][0]["repairs"]}
    assert {"duplicate_cell", "repeated_vertex", "inconsistent_orientation", "unreferenced_vertex"} <= kinds, kinds
    _, _, got_faces, texcoords = read("out.obj")
    assert got_faces == broken[1]
    assert texcoords[-1] == [None] * 3 and texcoords[-2] == [None] * 3 and None not in texcoords[5]


def kept_charts_and_seams():
    points, faces = ball(8)
    write("ball.obj", points, faces)
    run("atlas", "ball.obj", "-o", "once.obj", "--stats", "s.json")
    first = stats("s.json")
    run("atlas", "once.obj", "-o", "kept.obj", "--charts", "keep", "--stats", "s.json")
    assert stats("s.json")["charts"] == first["charts"]
    judge("kept.obj", points, faces)
    done = run("atlas", "ball.obj", "-o", "x.obj", "--charts", "keep", code=4)
    assert "no texture coordinates" in done.stderr

    # The equator is a seam.
    edges = {tuple(sorted((f[k], f[k - 1]))) for f in faces for k in range(3)}
    equator = [e for e in edges if all(abs(points[v][2]) < 1e-9 for v in e)]
    pathlib.Path("seams").write_text("# equator\n" + "".join(f"{a} {b}\n" for a, b in equator))
    run("atlas", "ball.obj", "-o", "out.obj", "--seams", "seams", "--max-distortion", 8)
    judge("out.obj", points, faces)
    assert equator and set(equator) <= seams_of("out.obj"), "the equator is no seam"
    # So is the border of a material, with texture coordinates and without.
    red = [f for f in faces if sum(points[v][2] for v in f) < 0]
    blue = [f for f in faces if f not in red]
    text = obj(points, red) + "usemtl blue sky\n" + obj([], blue)
    border = {e for e in edges if any(set(e) <= set(f) for f in red) and any(set(e) <= set(f) for f in blue)}
    for source in (text, text.replace("f ", "vt 0.5 0.5\nf ", 1).replace("usemtl", "usemtl red\nusemtl")):
        pathlib.Path("materials.obj").write_text(source)
        run("atlas", "materials.obj", "-o", "out.obj", "--keep-seams", "--max-distortion", 8)
        assert border and border <= seams_of("out.obj"), "a material has no border"
    assert "materials" in run("atlas", "ball.obj", "-o", "x.obj", "--keep-seams", code=4).stderr
    pathlib.Path("seams").write_text("0 399999\n")
    assert "line 1" in run("atlas", "ball.obj", "-o", "x.obj", "--seams", "seams", code=3).stderr
    pathlib.Path("seams").write_text(f"{equator[0][0]} 0\n" if equator[0][0] else f"{equator[0][1]} 1\n")
    assert "have no edge" in run("atlas", "ball.obj", "-o", "x.obj", "--seams", "seams", code=4).stderr


def pinned_charts():
    """Charts that are pinned keep their texture coordinates, others are laid around them."""
    points, faces = ball(12, bumps=0.5)
    write("ball.obj", points, faces)
    run("atlas", "ball.obj", "-o", "once.obj", "--max-distortion", 4.02)
    _, uv, _, texcoords = read("once.obj")
    parent = list(range(len(uv)))

    def root(t):
        while parent[t] != t:
            t = parent[t]
        return t

    for t in texcoords:
        for c in t[1:]:
            parent[root(c)] = root(t[0])
    chart = [root(t[0]) for t in texcoords]
    pinned = {chart[0], chart[-1]}
    assert len(pinned) == 2 and len(set(chart)) > 3
    pathlib.Path("pins").write_text(f"0 # one face of each\n{len(faces) - 1}\n")
    for arguments in (["--charts", "keep"], [], ["--udim", "2"]):
        done = run("atlas", "once.obj", "-o", "out.obj", "--keep-charts", "pins", "--stats", "s.json", *arguments)
        assert "2 charts stay where they were" in done.stderr, done.stderr
        judge("out.obj", points, faces, tiles=2 if arguments == ["--udim", "2"] else 1)
        _, now, _, there = read("out.obj")
        for f, t in enumerate(texcoords):
            if chart[f] in pinned:
                assert [now[c] for c in there[f]] == [uv[c] for c in t], f"face {f} has moved"
        s = stats("s.json")
        assert s["least_distance"] >= 2 * (1 - 1e-6) and s["complete"], s
        seconds = s["seconds"]  # of stages, none of which counts those of another one
        assert sum(seconds.values()) <= 2.001 * seconds["total"], seconds
    # It is refused where they cannot stay, or nothing is left.
    def changed(name, f):
        lines = pathlib.Path("once.obj").read_text().splitlines()
        places = iter(uv)
        pathlib.Path(name).write_text("\n".join(
            "vt {!r} {!r}".format(*f(*next(places))) if line.startswith("vt ") else line for line in lines) + "\n")

    for f, words in ((lambda x, y: (1 - x, y), "mirrored"), (lambda x, y: (x + 0.5, y), "leaves the square"),
                     (lambda x, y: (0.5 + 0.01 * (x % 0.1), 0.5 + 0.01 * y), "")):
        changed("moved.obj", f)
        done = run("atlas", "moved.obj", "-o", "x.obj", "--keep-charts", "pins", code=4)
        assert "pinned chart of triangle" in done.stderr and words in done.stderr, done.stderr
    pathlib.Path("all").write_text(" ".join(map(str, range(len(faces)))))
    assert "--keep-charts all: names a face of every chart" in run("atlas", "once.obj", "-o", "x.obj", "--keep-charts", "all", code=2).stderr
    pathlib.Path("beyond").write_text(f"{len(faces)}")
    assert "is not there" in run("atlas", "once.obj", "-o", "x.obj", "--keep-charts", "beyond", code=4).stderr
    assert "no texture coordinates" in run("atlas", "ball.obj", "-o", "x.obj", "--keep-charts", "pins", code=4).stderr


def symmetric_charts():
    """Charts of a symmetric surface are mirror images: every edge is as long in the atlas as its image."""
    def image(p):
        return (round(-p[0], 9) + 0.0, round(p[1], 9) + 0.0, round(p[2], 9) + 0.0)

    def bear(n): # polygons, with other diagonals than their images
        points, faces = ball(n)
        for p in points:
            r = 1 + 0.3 * math.sin(3 * p[1] + 1) * math.cos(4 * p[2] + 2) * math.cos(5 * p[0])
            p[:] = [r * c for c in p]
        return points, [[a[0], a[1], a[2], b[2]] for a, b in zip(faces[::2], faces[1::2])]

    for n, across in (10, False), (9, True):
        points, faces = bear(n)
        write("bear.obj", points, faces)
        told = run("atlas", "bear.obj", "-o", "out.obj", "--symmetric", "--stats", "s.json").stdout
        assert "symmetry" in told and " of charts" in told, told
        s = stats("s.json")
        symmetry = s["symmetry"]
        assert 2 * symmetry["pairs"] + symmetry["own"] == s["charts"] and symmetry["pairs"] > 0, symmetry
        assert (symmetry["own"] > 0) == across
        assert [abs(x) for x in symmetry["normal"]] == [1, 0, 0] and abs(symmetry["offset"]) < 1e-9
        judge("out.obj", points, faces)
        _, uv, _, texcoords = read("out.obj")
        number = {image(image(p)): v for v, p in enumerate(points)}
        other = [number[image(p)] for p in points]
        length = {}
        for f, t in zip(faces, texcoords):
            for k in range(4):
                length[f[k - 1], f[k]] = math.dist(uv[t[k - 1]], uv[t[k]])
        for f in faces:
            if sorted(f) != sorted(other[v] for v in f):
                for k in range(4):
                    a, b = length[f[k - 1], f[k]], length[other[f[k]], other[f[k - 1]]]
                    assert abs(a - b) < 1e-9, (f, a, b)

    points, faces = bear(10)
    seam = [faces[3][0], faces[3][1]]
    pathlib.Path("seam.txt").write_text(f"{seam[0]} {seam[1]}\n")
    write("bear.obj", points, faces)
    run("atlas", "bear.obj", "-o", "out.obj", "--symmetric", "--seams", "seam.txt")
    points[7][1] += 0.2
    write("bear.obj", points, faces)
    refused = run("atlas", "bear.obj", "-o", "x.obj", "--symmetric", code=4).stderr
    assert "no plane of symmetry" in refused and "(7, " in refused and not pathlib.Path("x.obj").exists(), refused


def polygons_and_several_surfaces():
    points, faces = ball(6)
    quads = [[a[0], a[1], a[2], b[2]] for a, b in zip(faces[::2], faces[1::2])]
    write("quads.obj", points, quads)
    run("atlas", "quads.obj", "-o", "out.obj")
    judge("out.obj", points, quads)
    more = torus(24, 10)
    write("torus.obj", *more)
    run("atlas", "quads.obj", "torus.obj", "-o", "a.obj", "-o", "b.obj", "--stats", "s.json")
    assert len(stats("s.json")["surfaces"]) == 2
    use = judge("a.obj", points, quads) + judge("b.obj", *more)
    assert abs(use - stats("s.json")["utilization"]) < 0.03
    run("atlas", "quads.obj", "torus.obj", "-o", "one.obj")
    both = points + more[0], faces + [[v + len(points) for v in f] for f in more[1]]
    text = pathlib.Path("one.obj").read_text()
    assert "o quads\n" in text and "o torus\n" in text
    got, _, got_faces, _ = read("one.obj")
    assert got == both[0] and len(got_faces) == len(both[1])
    judge("one.obj", both[0], got_faces)

    # Standard input and output.
    with open("quads.obj", encoding="utf-8") as text:
        piped = subprocess.run([TAUT, "atlas", "-", "-o", "-"], stdin=text, capture_output=True, check=True).stdout
    run("atlas", "quads.obj", "-o", "out.obj")
    assert piped == pathlib.Path("out.obj").read_bytes()
    # What is wrong is told with the numbers of the file that it is in.
    write("turned.obj", more[0], [more[1][0][::-1]] + more[1][1:])
    done = run("atlas", "quads.obj", "turned.obj", "-o", "x.obj", code=4)
    assert "turned.obj: " in done.stderr and "(0-" in done.stderr, done.stderr


def copies():
    """Turned copies of a surface are cut alike and lie on each other, whatever the digits, the order of faces, and the
    diagonals along which polygons are cut."""
    def turned(p, k):
        a, b = 0.7 * k, 1.1 * k
        x, y, z = p
        x, y = x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)
        y, z = y * math.cos(b) - z * math.sin(b), y * math.sin(b) + z * math.cos(b)
        return [x + 13 * k, y - 9 * k, z + 3 * k]

    outline = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (0, 2)]
    bracket = [[float(x), float(y), z] for z in (0.0, 0.9) for x, y in outline], \
        [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11]] + [[i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i] for i in range(6)]
    points, faces = torus(12, 8)
    quads = points, [[a[0], a[1], a[2], b[2]] for a, b in zip(faces[::2], faces[1::2])]
    count = 6
    for shape in (bracket, quads):
        for digits in (6, 17):
            points, faces = [], []
            for k in range(count):
                first = len(points)
                points += [[float(f"{c:.{digits}g}") for c in turned(p, k)] for p in shape[0]]
                own = [[first + v for v in f[k % len(f):] + f[:k % len(f)]] for f in shape[1]]
                faces += own[k:] + own[:k] if k % 2 else own
            write("copies.obj", points, faces)
            run("atlas", "copies.obj", "-o", "out.obj", "--stack", "similar", "--stats", "s.json")
            s = stats("s.json")
            assert s["charts"] % count == 0 and s["charts"] - s["stacked"] <= s["charts"] // count, \
                (digits, s["charts"], s["stacked"])
            assert all(cross(*(uv[f[k]] for k in (0, 1, 2))) > 0 for _, uv, _, texcoords in [read("out.obj")]
                       for f in texcoords if len(f) == 4)
    # Corners may be off by a thousandth of the size, 1.8 here, in any direction, or all by a scale.
    dice = random.Random(8)
    near = [[c + dice.uniform(-1, 1) * 8e-4 for c in p] for p in bracket[0]]
    scaled = [[c * 1.0007 for c in p] for p in bracket[0]]
    for other in (near, scaled):
        write("copies.obj", bracket[0] + [turned(p, 1) for p in other], bracket[1] + [[12 + v for v in f] for f in bracket[1]])
        run("atlas", "copies.obj", "-o", "out.obj", "--stack", "similar", "--stats", "s.json")
        s = stats("s.json")
        assert 2 * s["stacked"] == s["charts"], (s["charts"], s["stacked"])
    # What only looks like a copy is none: a bracket whose leg is a hundredth longer.
    other = [[p[0], p[1] + 0.02 * (p[1] > 1.5), p[2]] for p in bracket[0]]
    write("copies.obj", bracket[0] + [turned(p, 1) for p in other], bracket[1] + [[12 + v for v in f] for f in bracket[1]])
    run("atlas", "copies.obj", "-o", "out.obj", "--stack", "similar", "--stats", "s.json")
    s = stats("s.json")
    assert s["stacked"] < s["charts"] // 2, (s["charts"], s["stacked"])


def charts_larger_than_tiles():
    """At a given density charts are cut so that they fit into a tile; a polygon that does not is told."""
    cube = [[float(v >> k & 1) for k in range(3)] for v in range(8)], \
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    long = [[x / 2, y / 2, 0.1 * math.sin(x / 9)] for y in range(3) for x in range(81)], \
        [[81 * y + x, 81 * y + x + 1, 81 * y + x + 82, 81 * y + x + 81] for y in range(2) for x in range(80)]
    for (points, faces), texels in ((cube, 200), (long, 40)):
        write("large.obj", points, faces)
        for more in ([], ["--prefer", "packing"], ["--no-rotation"]):
            told = run("atlas", "large.obj", "-o", "out.obj", "--texels-per-unit", texels, "--resolution", 256, "--stats",
                       "s.json", *more)
            s = stats("s.json")
            assert s["resolution"] == 256 and s["least_distance"] >= 2 * (1 - 1e-9)
            assert "larger than a tile" in told.stderr, told.stderr
            judge("out.obj", points, faces, samples=128, tiles=10)
        assert s["charts"] <= 9, s["charts"]
    write("large.obj", *cube)
    refused = run("atlas", "large.obj", "-o", "x.obj", "--texels-per-unit", 300, "--resolution", 256, code=4).stderr
    assert "polygon" in refused and "higher resolution" in refused, refused


def packing_is_no_worse():
    """Charts that are to fill the square do so as well as those along short seams, also where each side of a body is
    slim or star-shaped."""
    n = 14
    outline = [((1, 0.35)[k % 2] * math.cos(2 * math.pi * k / n), (1, 0.35)[k % 2] * math.sin(2 * math.pi * k / n))
               for k in range(n)]
    points = [[x, y, z] for z in (0.0, 1.0) for x, y in outline]
    faces = [list(range(n))[::-1], list(range(n, 2 * n))] + [[k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
    write("star.obj", points, faces)
    use = {}
    for aim in ("seams", "packing"):
        run("atlas", "star.obj", "-o", "out.obj", "--prefer", aim, "--stats", "s.json")
        use[aim] = stats("s.json")["utilization"]
    assert stats("s.json")["distortion"] <= 4.045 and use["packing"] > use["seams"] - 0.03, use


def polygons_of_any_outline():
    """Letters: flat polygons that are far from convex, and one that is bent."""
    letters = [[(0, 0), (3, 0), (3, 1), (1, 1), (1, 2), (2.5, 2), (2.5, 3), (1, 3), (1, 4), (3, 4), (3, 5), (0, 5)],
               [(0, 0), (1, 0), (1, 3), (2.5, 1.5), (4, 3), (4, 0), (5, 0), (5, 5), (4, 5), (2.5, 3), (1, 5), (0, 5)],
               [(r * math.cos(a / 6), r * math.sin(a / 6)) for r, some in ((3, range(34)), (2, range(33, -1, -1)))
                for a in some]]
    for k, outline in enumerate(letters + letters[2:]):
        n = len(outline)
        points = [[float(x), float(y), z + (0.3 * math.sin(1.7 * x) * math.cos(1.3 * y) if k == 3 else 0.0)]
                  for z in (0.0, 1.0) for x, y in outline]
        faces = [list(range(n))[::-1], list(range(n, 2 * n))]
        faces += [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
        write("letter.obj", points, faces)
        run("atlas", "letter.obj", "-o", "out.obj", "--repair", "--stats", "s.json")
        stats("s.json")
        got, uv, got_faces, texcoords = read("out.obj")
        assert got == points and got_faces == faces
        area = [sum(uv[t[i - 1]][0] * uv[t[i]][1] - uv[t[i]][0] * uv[t[i - 1]][1] for i in range(len(t)))
                for t in texcoords]
        assert min(area) > 0, f"letter {k}: face {area.index(min(area))} is turned over"


def polygons_as_fans():
    """Prisms over a dart: a fan from the first corner covers it if that is the reflex one or the opposite, else not."""
    dart = [(0, 0), (3, 2), (0, 1), (-3, 2)]  # the corner (0, 1) is reflex
    for first in range(4):
        outline = dart[first:] + dart[:first]
        points = [[float(x), float(y), z] for z in (0.0, 1.0) for x, y in outline]
        faces = [[0, 3, 2, 1], [4, 5, 6, 7]] + [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
        write("dart.obj", points, faces)
        whole = first % 2 == 0
        for command in ("atlas", "unwrap"):
            if command == "unwrap":  # without the top it is a disk
                write("dart.obj", points, faces[:1] + faces[2:])
            done = run(command, "dart.obj", "-o", "out.obj", "--stats", "s.json")
            told = json.loads(pathlib.Path("s.json").read_text(encoding="utf-8"))
            told = told if command == "atlas" else told["after"] if "reversed_fans" in told.get("after", {}) else told
            assert ("fan triangulation" in done.stderr + done.stdout) == (not whole)
            _, uv, _, texcoords = read("out.obj")
            over = sum(min(cross(uv[t[0]], uv[t[k]], uv[t[k + 1]]) for k in (1, 2)) <= 0 for t in texcoords)
            assert told["reversed_fans"] == over and not (whole and over), (command, first, over, told["reversed_fans"])
            assert command == "unwrap" or whole or over > 0, over
        done = run("check", "dart.obj")
        assert ("fan triangulation" in done.stderr + done.stdout) == (not whole)
    # Squares of a hill with a corner in the middle of a side: flat triangles of fans in space may turn over in the map.
    n, number, points, faces = 8, {}, [], []

    def vertex(x, y):
        if (x, y) not in number:
            number[x, y] = len(points)
            ends = [(math.floor(x), math.floor(y)), (math.ceil(x), math.ceil(y))]
            ends = [(i, j, 2 * math.sin(0.6 * i) * math.cos(0.5 * j)) for i, j in ends]
            points.append([(a + b) / 2 for a, b in zip(*ends)])
        return number[x, y]

    for i in range(n):
        for j in range(n):
            faces.append([vertex(i, j), vertex(i + 0.5, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i + 0.5, j + 1),
                          vertex(i, j + 1)])
    write("straight.obj", points, faces)
    for command in ("atlas", "unwrap"):
        run(command, "straight.obj", "-o", "out.obj", "--stats", "s.json")
        _, uv, _, texcoords = read("out.obj")
        over = sum(min(cross(uv[t[0]], uv[t[k]], uv[t[k + 1]]) for k in range(1, len(t) - 1)) <= 0 for t in texcoords)
        told = json.loads(pathlib.Path("s.json").read_text(encoding="utf-8"))
        told = told if command == "atlas" else told["after"] if "reversed_fans" in told.get("after", {}) else told
        assert 0 < over == told["reversed_fans"], (command, over, told["reversed_fans"])



def sizes():
    """Texture coordinates do not depend on the size of a surface, even where areas are no numbers any more."""
    points, faces = ball(6)
    uv = []
    for size in (1.0, 2.0 ** 530, 2.0 ** -530):
        big = [[c * size for c in p] for p in points]
        write("sized.obj", big, faces)
        run("atlas", "sized.obj", "-o", "out.obj")
        judge("out.obj", big, faces)
        uv.append(read("out.obj")[1])
    assert uv[1] == uv[2] and len(uv[0]) == len(uv[1])
    write("sized.obj", *ball(12))
    for density in ("1e-300", "1e-16"):
        refused = run("atlas", "sized.obj", "-o", "x.obj", "--texels-per-unit", density, code=4).stderr
        assert "too small for the digits of the file; ask for more texels a unit" in refused, refused
    run("atlas", "sized.obj", "-o", "out.obj", "--texels-per-unit", "0.01")


def wrong_usage():
    points, faces = ball(4)
    write("ball.obj", points, faces)
    for arguments, words in ((["ball.obj"], "--output"), (["ball.obj", "-o", "x.png"], "must end in"),
                             (["ball.obj", "-o", "x.obj", "--max-distortion", "4"], "not above 4"),
                             (["ball.obj", "-o", "x.obj", "--padding", "-1"], "padding"),
                             (["ball.obj", "-o", "x.obj", "--padding", "64", "--resolution", "128"], "--padding 64"),
                             (["ball.obj", "-o", "x.obj", "--padding", "nan"], "no number"),
                             (["ball.obj", "-o", "x.obj", "--texcoord-set", "1"], "--texcoord-set"),
                             (["ball.obj", "-o", "x.glb", "--texcoord-set", "1"], "--texcoord-set"),
                             (["ball.obj", "-o", "x.obj", "--read-texcoord-set", "1"], "--read-texcoord-set"),
                             (["ball.glb", "-o", "x.glb", "--read-texcoord-set", "3"], "nothing is read"),
                             (["ball.obj", "-o", "x.obj", "--texels-per-unit", "9", "--max-resolution", "512"], "--max-resolution 512"),
                             (["ball.obj", "-o", "x.obj", "--charts", "keep", "--keep-seams"], "--keep-seams"),
                             (["ball.obj", "-o", "x.obj", "--charts", "keep", "--max-distortion", "5"], "no bound"),
                             (["ball.obj", "-o", "x.obj", "--charts", "keep", "--symmetric"], "--symmetric"),
                             (["ball.obj", "-o", "x.obj", "--charts", "keep", "--prefer", "one"], "--prefer"),
                             (["ball.obj", "-o", "x.obj", "--prefer", "few"], "few"),
                             (["ball.obj", "-o", "x.obj", "--symmetric", "--stack", "similar"], "mirror images"),
                             (["ball.obj", "-o", "x.obj", "--symmetric", "--seam-weights", "ball.obj"], "--seam-weights"),
                             (["ball.obj", "ball.obj", "-o", "x.glb"], "as .obj"),
                             (["-", "-", "-o", "x.obj"], "standard input"),
                             (["ball.obj", "ball.obj", "ball.obj", "-o", "x.obj", "-o", "y.obj"], "outputs"),
                             (["ball.obj", "ball.obj", "-o", "x.obj", "--keep-charts", "ball.obj"], "--keep-charts"),
                             (["ball.obj", "ball.obj", "-o", "x.obj", "--seams", "ball.obj"], "--seams")):
        assert words in run("atlas", *arguments, code=2).stderr
    assert run("atlas", "none.obj", "-o", "x.obj", code=3).stderr
    pathlib.Path("garbage.obj").write_text("v 0 0\nf 1 2 3\n")
    assert run("atlas", "garbage.obj", "-o", "x.obj", code=3).stderr
    assert not pathlib.Path("x.obj").exists()


def stops():
    """What ends early leaves an atlas behind, at whatever time."""
    points, faces = ball(60, bumps=0.2)
    write("large.obj", points, faces)
    for arguments, wanted in ((["--progress", "json"], "charts"), (["--progress", "json"], "flatten"),
                              (["--progress", "json"], "pack")):
        pathlib.Path("out.obj").unlink(missing_ok=True)
        done = subprocess.Popen([TAUT, "atlas", "large.obj", "-o", "out.obj", *arguments], stderr=subprocess.PIPE,
                                text=True)
        stage = ""
        for line in done.stderr:
            if line.startswith("{"):
                stage = json.loads(line)["phase"]
                if stage == wanted:
                    break
        assert stage == wanted, stage
        os.kill(done.pid, signal.SIGINT)
        done.communicate()
        assert done.returncode in (130, 0) and (wanted == "pack" or done.returncode == 130), done.returncode
        judge("out.obj", points, faces)

    # Rough all over: a box of jagged quads, none of whose charts are large. It takes longer than that.
    rng = random.Random(1)
    points, faces = ball(90)
    points = [[c * (1 + 0.02 * (rng.random() - 0.5)) for c in p] for p in points]
    write("rough.obj", points, faces)
    done = subprocess.run([TAUT, "atlas", "rough.obj", "-o", "rough.out.obj", "--time-limit", "0.8", "--stats", "s.json"],
                          capture_output=True, text=True, check=False)
    if done.returncode == 6: # it was still being read
        assert "time limit" in done.stderr
    else:
        assert done.returncode in (8, 0), done.stderr
        assert stats("s.json")["complete"] == (done.returncode == 0)
        judge("rough.out.obj", points, faces, samples=128)

    # Rougher than its triangles are large: no two of them are seen from one side. There are few charts all the same, also
    # of a surface so large that the padding of small ones fills the page.
    for n, limit in ((24, "0.5"), (132, "2")):
        points, faces = ball(n)
        points = [[c + rng.gauss(0, 0.1) for c in p] for p in points]
        write("spiky.obj", points, faces)
        done = subprocess.run([TAUT, "atlas", "spiky.obj", "-o", "spiky.out.obj", "--time-limit", limit, "--stats", "s.json"],
                              capture_output=True, text=True, check=False)
        assert done.returncode == 8, done.stderr
        told = stats("s.json")
        assert told["charts"] < 1000 and told["distortion"] < 200, (told["charts"], told["distortion"])
        if n < 100:
            judge("spiky.out.obj", points, faces, samples=128)


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    os.chdir(FOLDER)
    for case in (closed_surfaces, short_seams, parts_holes_and_padding, repairs, kept_charts_and_seams, pinned_charts, sizes,
                 symmetric_charts, polygons_and_several_surfaces, copies, charts_larger_than_tiles, packing_is_no_worse,
                 polygons_of_any_outline, polygons_as_fans, wrong_usage, stops):
        begin = time.monotonic()
        case()
        print(f"{case.__name__}: {time.monotonic() - begin:.1f} s", flush=True)


if __name__ == "__main__":
    main()
