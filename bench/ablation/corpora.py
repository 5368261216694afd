# SPDX-License-Identifier: MIT
"""The cases of the ablation: public problems where their folders are given, and generated ones."""

import math
import random
import tarfile
from pathlib import Path


class Case:
    """A call of the program. command: without the output and the options that all calls have."""

    def __init__(self, name, command, output, quick=False):
        self.name, self.command, self.output, self.quick = name, [str(c) for c in command], output, quick


def sampled(cases, every):
    """Marks every so many cases for the quick mode."""
    for i, case in enumerate(cases):
        case.quick = i % every == every // 2
    return cases


# --- public ones


def problems(folder):
    return sampled([Case(f"{folder.name}/{f.stem}", ["untangle", f], "out.txt") for f in sorted(folder.glob("*.prob"))], 6)


def surfaces(folder):
    return sampled([Case(f"surfaces/{f.stem}", ["unwrap", f, "--holes"], "out.obj") for f in sorted(folder.glob("*.obj"))], 4)


def pinned(folder, meshes):
    return sampled([Case(f"pins/{f.stem}", ["unwrap", meshes / (f.name.split(".")[0] + ".obj"), "--pins", f], "out.obj")
                    for f in sorted(folder.glob("*.csv"))], 4)


def models(archive, work):
    """Surfaces of libcgal-demo that are neither tiny nor large: cut open, and as atlases."""
    there = work / "models"
    if not there.exists():
        with tarfile.open(archive) as tar:
            members = [m for m in tar.getmembers() if m.name.startswith("data/meshes/") and m.name.endswith(".off")]
            for m in members:
                m.name = Path(m.name).name
            tar.extractall(there, members)
    chosen = [f for f in sorted(there.glob("*.off")) if 9_000 < f.stat().st_size < 450_000]
    cut = sampled([Case(f"models/{f.stem}", ["unwrap", f, "--cut"], "out.obj") for f in chosen], 9)
    atlases = sampled([Case(f"atlas/{f.stem}", ["atlas", f], "out.obj") for f in chosen[::3] if f.stat().st_size < 300_000], 5)
    return cut + atlases


def public(data, pins, archive, work):
    cases = []
    if data:
        cases += problems(data / "untangle2d") + problems(data / "untangle3d") + surfaces(data / "surfaces")
        if pins:
            cases += pinned(pins, data / "surfaces")
    if archive:
        cases += models(archive, work)
    return cases


# --- generated ones


def square(n, rng, jitter=0.3):
    """Points in [-1, 1]^2, triangles with random diagonals, and the vertices of the rim in turn."""
    def at(x, y):
        return y * (n + 1) + x
    points, cells = [], []
    for y in range(n + 1):
        for x in range(n + 1):
            inner = 0 < x < n and 0 < y < n
            dx, dy = ((rng.random() - 0.5) * jitter for _ in "xy") if inner else (0, 0)
            points.append((2 * (x + dx) / n - 1, 2 * (y + dy) / n - 1))
    for y in range(n):
        for x in range(n):
            a, b, c, d = at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)
            corner = (x in (0, n - 1)) and (y in (0, n - 1))  # has an inner edge, or its triangle would be on the rim alone
            rising = (x == 0) == (y == 0) if corner else rng.random() < 0.5
            cells += [(a, b, c), (a, c, d)] if rising else [(a, b, d), (b, c, d)]
    rim = [at(x, 0) for x in range(n)] + [at(n, y) for y in range(n)]
    rim += [at(x, n) for x in range(n, 0, -1)] + [at(0, y) for y in range(n, 0, -1)]
    return points, cells, rim


def write_problem(path, rest, initial, cells, fixed):
    lines = [f"{len(rest)} {len(rest[0])}"] + [" ".join(map(repr, map(float, p))) for p in rest]
    lines += [f"{len(initial)} {len(initial[0])}"] + [" ".join(map(repr, map(float, p))) for p in initial]
    lines += [f"{len(cells)} {len(cells[0])}"] + [" ".join(map(str, c)) for c in cells]
    lines += [str(len(fixed))] + [str(v) for v in sorted(fixed)]
    path.write_text("\n".join(lines) + "\n")


def on_polygon(corners, count):
    """Points in turn along a polygon."""
    sides = list(zip(corners, corners[1:] + corners[:1]))
    lengths = [math.dist(a, b) for a, b in sides]
    total, result = sum(lengths), []
    for i in range(count):
        s = total * i / count
        for (a, b), length in zip(sides, lengths):
            if s <= length:
                result.append(tuple(a[k] + (b[k] - a[k]) * s / length for k in (0, 1)))
                break
            s -= length
    return result


def star(rng):
    n = rng.randrange(5, 12)
    angles = [2 * math.pi * (i + 0.6 * rng.random()) / n for i in range(n)]
    return [(r * math.cos(a), r * math.sin(a)) for a, r in ((a, rng.uniform(0.25, 1)) for a in angles)]


def comb(rng):
    teeth, depth = rng.randrange(2, 6), rng.uniform(0.5, 0.9)
    top = []
    for i in range(teeth):
        x = 1 - 2 * i / teeth
        low = 1 - 2 * depth
        top += [(x, 1), (x - 1 / teeth, 1)]
        if i + 1 < teeth:
            top += [(x - 1 / teeth, low), (x - 2 / teeth, low)]
    return [(-1, -1), (1, -1)] + top


def swirl(p, turn):
    r = math.hypot(*p)
    a = turn * max(0.0, 1 - r) ** 2
    return (p[0] * math.cos(a) - p[1] * math.sin(a), p[0] * math.sin(a) + p[1] * math.cos(a))


def flat_problem(kind, seed):
    rng = random.Random(f"{kind} {seed}")
    n = rng.choice([8, 12, 16, 24] if kind == "hard" else [6, 10, 16, 24, 40, 56])
    points, cells, rim = square(n, rng)
    inner = sorted(set(range(len(points))) - set(rim))
    initial, fixed = list(points), set()
    if kind in ("star", "comb"):
        fixed = set(rim)
        for v, p in zip(rim, on_polygon(star(rng) if kind == "star" else comb(rng), len(rim))):
            initial[v] = p
        if rng.random() < 0.5:
            for v in inner:
                initial[v] = (rng.uniform(-1, 1), rng.uniform(-1, 1))
    elif kind == "swirl":
        pins = rng.sample(inner, max(1, len(inner) // rng.choice([5, 20, 60])))
        fixed = set(rim) | set(pins)
        turn = rng.uniform(0.5, 4)
        for v in pins:
            initial[v] = swirl(points[v], turn)
    elif kind == "handles":  # the rim is free
        fixed = set(rng.sample(range(len(points)), rng.randrange(2, 12)))
        far = rng.uniform(0.1, 1.2)
        for v in fixed:
            initial[v] = tuple(c + far * rng.uniform(-1, 1) for c in points[v])
    elif kind == "hard":  # as handles, more of them and farther: springs jam
        fixed = set(rng.sample(range(len(points)), rng.randrange(6, 22)))
        far = rng.uniform(0.5, 1.5)
        for v in fixed:
            r, a = far * math.sqrt(rng.random()), rng.uniform(0, 2 * math.pi)
            initial[v] = (points[v][0] + r * math.cos(a), points[v][1] + r * math.sin(a))
    elif kind == "collapse":
        fixed = set(rim)
        for v in inner:
            initial[v] = (1e-3 * rng.random(), 1e-3 * rng.random())
    elif kind == "scramble":  # some of the inside is fixed where a solution has it
        fixed = set(rim) | set(rng.sample(inner, len(inner) // 10))
        for v in inner:
            if v not in fixed:
                initial[v] = (rng.uniform(-1, 1), rng.uniform(-1, 1))
    return points, initial, cells, fixed


def bar(nx, ny, nz):
    """Tetrahedra of a bar along x, unit cells, positively oriented."""
    def at(x, y, z):
        return (z * (ny + 1) + y) * (nx + 1) + x
    points = [(x, y, z) for z in range(nz + 1) for y in range(ny + 1) for x in range(nx + 1)]
    cells = []
    steps = [((1, 0, 0), (1, 1, 0)), ((0, 1, 0), (1, 1, 0)), ((0, 1, 0), (0, 1, 1)),
             ((0, 0, 1), (0, 1, 1)), ((0, 0, 1), (1, 0, 1)), ((1, 0, 0), (1, 0, 1))]
    for z in range(nz):
        for y in range(ny):
            for x in range(nx):
                for i, (a, b) in enumerate(steps):
                    t = [at(x, y, z), at(x + a[0], y + a[1], z + a[2]), at(x + b[0], y + b[1], z + b[2]),
                         at(x + 1, y + 1, z + 1)]
                    cells.append((t[0], t[2], t[1], t[3]) if i % 2 else tuple(t))
    return points, cells


def moved(p, middle, kind, amount, length):
    """The place of a point of an end of a bar, whose middle is there."""
    x, y, z = (p[k] - middle[k] for k in range(3))
    a = math.radians(amount) / 2 * (1 if x > 0 else -1)
    c, s = math.cos(a), math.sin(a)
    if kind == "twist":
        y, z = c * y - s * z, s * y + c * z
    elif kind == "bend":
        r = length / (2 * abs(a)) if a else 0
        x, y = ((r * abs(s) if x > 0 else -r * abs(s)) - s * y, r * (1 - c) + c * y)
    elif kind == "scale":
        x *= amount
    elif kind == "shear":
        y += amount * x
    return tuple(m + d for m, d in zip(middle, (x, y, z)))


def volume_cases(work):
    cases = []
    for i, (size, kind, amount) in enumerate([
            ((12, 3, 3), "twist", 90), ((12, 3, 3), "twist", 180), ((12, 3, 3), "bend", 120), ((16, 4, 4), "scale", 0.4),
            ((16, 4, 4), "scale", 2.0), ((16, 4, 4), "shear", 0.8), ((24, 6, 6), "bend", 200), ((24, 6, 6), "twist", 270),
            ((72, 12, 12), "bend", 150), ((72, 12, 12), "twist", 180)]):
        points, cells = bar(*size)
        middle = tuple(s / 2 for s in size)
        ends = [v for v, p in enumerate(points) if p[0] in (0, size[0])]
        targets = {v: moved(points[v], middle, kind, amount, size[0]) for v in ends}
        name = f"{kind}-{amount}-{size[0]}x{size[1]}x{size[2]}"
        mesh = work / f"{name}.mesh"
        lines = ["MeshVersionFormatted 2", "Dimension 3", f"Vertices {len(points)}"] + [f"{x} {y} {z} 0" for x, y, z in points]
        lines += [f"Tetrahedra {len(cells)}"] + [" ".join(str(v + 1) for v in c) + " 0" for c in cells] + ["End"]
        mesh.write_text("\n".join(lines) + "\n")
        pins = work / f"{name}.csv"
        pins.write_text("vertex,x,y,z\n" + "".join(f"{v},{x!r},{y!r},{z!r}\n" for v, (x, y, z) in targets.items()))
        cases.append(Case(f"deform/{name}", ["deform", mesh, "--pins", pins], "out.mesh", i in (1, 3)))
        if len(cells) > 10_000:
            continue
        initial = [targets.get(v, p) for v, p in enumerate(points)]
        problem = work / f"{name}.prob"
        write_problem(problem, points, initial, cells, set(ends))
        cases.append(Case(f"made3d/{name}", ["untangle", problem], "out.txt", i in (0, 2)))
    for seed in range(4):
        rng = random.Random(f"volume {seed}")
        points, cells = bar(*[(5, 5, 5), (8, 4, 4), (10, 10, 10), (14, 7, 7)][seed])
        size = points[-1]
        inside = [v for v, p in enumerate(points) if all(0 < p[k] < size[k] for k in range(3))]
        initial = list(points)
        for v in inside:
            initial[v] = tuple(rng.uniform(0, s) for s in size)
        problem = work / f"scramble{seed}.prob"
        write_problem(problem, points, initial, cells, set(range(len(points))) - set(inside))
        cases.append(Case(f"made3d/scramble{seed}", ["untangle", problem], "out.txt", seed == 0))
    return cases


def limbs(work):
    """Long thin surfaces, whose maps are extreme: tubes that are open at one end, and fingers of a square."""
    cases = []
    for around, along, r in ((12, 120, 1.0), (24, 400, 1.0), (12, 240, 0.5)):
        points = [(r * math.cos(2 * math.pi * (k + j / 2) / around), r * math.sin(2 * math.pi * (k + j / 2) / around),
                   j * 2 * math.pi * r / around) for j in range(along + 1) for k in range(around)]
        faces = []
        for j in range(along):
            for k in range(around):
                a, b, c, d = j * around + k, j * around + (k + 1) % around, (j + 1) * around + k, (j + 1) * around + (k + 1) % around
                faces += [(a, b, c), (b, d, c)]
        tip = len(points)
        points.append((0, 0, (along + 0.5) * 2 * math.pi * r / around))
        faces += [(along * around + k, along * around + (k + 1) % around, tip) for k in range(around)]
        path = work / f"tube{along}.obj"
        path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points) +
                        "".join("f {} {} {}\n".format(*(v + 1 for v in f)) for f in faces))
        cases.append(Case(f"limbs/tube{along}", ["unwrap", path], "out.obj", along == 120))
    return cases


def moved_pins(run, meshes, work):
    """Random vertices of the free map of a surface moved by up to half of its longer side; run(case) returns the output."""
    cases = []
    for mesh in meshes:
        out = run(Case(f"free/{mesh.stem}", ["unwrap", mesh], f"{mesh.stem}.obj"))
        uv = {}
        lines = out.read_text().splitlines()
        vt = [tuple(map(float, line.split()[1:3])) for line in lines if line.startswith("vt ")]
        for line in lines:
            if line.startswith("f "):
                for corner in line.split()[1:]:
                    v, t = corner.split("/")[:2]
                    uv[int(v) - 1] = vt[int(t) - 1]
        side = max(max(p[k] for p in vt) - min(p[k] for p in vt) for k in (0, 1))
        for seed in range(8):
            rng = random.Random(f"{mesh.stem} {seed}")
            count, far = rng.choice([1, 2, 4, 8, 14, 20]), side * rng.choice([0.05, 0.1, 0.2, 0.35, 0.5])
            pins = work / f"{mesh.stem}.{seed}.csv"
            pins.write_text("vertex,u,v\n" + "".join(
                "{},{!r},{!r}\n".format(v, *(c + far * rng.uniform(-1, 1) for c in uv[v])) for v in rng.sample(sorted(uv), count)))
            cases.append(Case(f"moved/{mesh.stem}.{seed}", ["unwrap", mesh, "--pins", pins], "out.obj", seed == 3))
    return cases


def generated(work):
    cases = []
    for kind in ("star", "comb", "swirl", "handles", "hard", "collapse", "scramble"):
        for seed in range(20):
            problem = work / f"{kind}{seed}.prob"
            write_problem(problem, *flat_problem(kind, seed))
            cases.append(Case(f"made2d/{kind}{seed}", ["untangle", problem], "out.txt", seed in (1, 5, 9)))
    return cases + volume_cases(work) + limbs(work)
