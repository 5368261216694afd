# SPDX-License-Identifier: MIT
"""Meshes that other programs write and read, and what of them must be as it was: for other_programs.py."""
import importlib.util
import itertools
import os
import subprocess
import sys
import unittest

try:
    import numpy as np
except ImportError:
    np = None  # another Python may have it

MODULES = {"meshio": "meshio", "vtk": "vtkmodules", "gmsh": "gmsh", "trimesh": "trimesh", "pygltflib": "pygltflib"}
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def go_to_python():
    """Goes on in the Python that has most of what is asked for."""
    wanted = [MODULES[c] for c in sys.argv[3:] if c in MODULES] or list(MODULES.values())
    if "TAUT_READERS_CHOSEN" in os.environ:
        return
    os.environ["TAUT_READERS_CHOSEN"] = "1"
    have = "import importlib.util as u, sys; print(sum(u.find_spec(m) is not None for m in sys.argv[1:]))"

    def count(python):
        run = subprocess.run([python, "-c", have, *wanted], capture_output=True, text=True)
        return int(run.stdout) if run.returncode == 0 else -1
    pythons = [p for p in (sys.executable, os.path.join(ROOT, "build/readers/bin/python3"), "/usr/bin/python3") if os.path.exists(p)]
    best = max(pythons, key=count)
    if best != sys.executable:
        os.execv(best, [best, "-B", *sys.argv])


def needs(module):
    if np is None or importlib.util.find_spec(module) is None:
        raise unittest.SkipTest(f"no {module}; scripts/setup --with-readers installs it")


def same(a, b, say):
    """Throws where two things, of lists, tables and arrays, are not the same, bit for bit."""
    if isinstance(a, dict) and isinstance(b, dict):
        assert list(a) == list(b), f"{say}: {list(a)}, then {list(b)}"
        for key in a:
            same(a[key], b[key], f"{say}: {key}")
    elif isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        assert len(a) == len(b), f"{say}: {len(a)} items, then {len(b)}"
        for k, (x, y) in enumerate(zip(a, b)):
            same(x, y, f"{say} {k}")
    elif isinstance(a, np.ndarray):
        equal = a.dtype == b.dtype and a.shape == b.shape and np.array_equal(a, b)
        assert equal, f"{say}: {a.dtype} {a.ravel()[:12]}, then {b.dtype} {b.ravel()[:12]}"
    else:
        assert a == b, f"{say}: {a!r}, then {b!r}"


# Volumes

# Eight cubes: two columns of hexahedra, one of them under a pyramid, and one of wedges under two tetrahedra. In VTK's order.
GRID = list(itertools.product(range(3), repeat=3))
PLACES = [(*p,) if p != (1, 1, 1) else (1.25, 1, 1.25) for p in GRID] + [(0.5, 0.5, 3), (1.5, 0.5, 3)]


def mixed():
    number = {p: i for i, p in enumerate(GRID)}
    cells = []  # kind, corners, label
    for x, y, z in itertools.product(range(2), repeat=3):
        low, high = ([number[x + i, y + j, z + k] for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))] for k in (0, 1))
        if (x, y) == (1, 0):
            for i, j, k in ((0, 2, 1), (0, 3, 2)):
                cells.append(("wedge", (low[i], low[j], low[k], high[i], high[j], high[k]), 2))
                if z == 1:
                    cells.append(("tetra", (high[i], high[k], high[j], len(GRID) + 1), 3))
                else:
                    cells.append(("triangle", (low[i], low[j], low[k]), 5))
        else:
            cells.append(("hexahedron", (*low, *high), 1))
            if z == 0:
                cells.append(("quad", tuple(reversed(low)), 6))
            elif (x, y) == (0, 0):
                cells.append(("pyramid", (*high, len(GRID)), 3))
    kinds = ["triangle", "quad", "tetra", "pyramid", "wedge", "hexahedron"]
    return PLACES, sorted(cells, key=lambda c: kinds.index(c[0]))


def tetrahedra():
    """A cube of 3 x 3 x 3 points as tetrahedra in two halves, and the triangles of its bottom."""
    number = {p: i for i, p in enumerate(GRID)}
    cells = []
    for corner in itertools.product(range(2), repeat=3):
        for way in itertools.permutations(range(3)):
            at, cell = list(corner), [number[corner]]
            for axis in way:
                at[axis] += 1
                cell.append(number[tuple(at)])
            if sum(way[a] > way[b] for a in range(3) for b in range(a + 1, 3)) % 2:
                cell[2], cell[3] = cell[3], cell[2]
            cells.append(("tetra", tuple(cell), 1 + corner[0]))
    bottom = [("triangle", tuple(f), 5) for _, c, _ in cells for f in itertools.combinations(c, 3)
              if all(GRID[v][2] == 0 for v in f)]
    return PLACES[:27], bottom + cells


def plane():
    points = [(x, y, 0) for x in range(4) for y in range(4)]
    points[5] = (1.25, 1, 0)
    cells = [("triangle", t, 1 + x // 2) for x in range(3) for y in range(3) for a in [4 * x + y] for t in ((a, a + 4, a + 5), (a, a + 5, a + 1))]
    return points, cells


def su2(points, cells, dimension=3):
    """An SU2 file whose markers are labels of the boundary."""
    types = {"line": 3, "triangle": 5, "quad": 9, "tetra": 10, "pyramid": 14, "wedge": 13, "hexahedron": 12}
    small = ("line",) if dimension == 2 else ("triangle", "quad")
    inner, outer = ([c for c in cells if (c[0] in small) == of] for of in (False, True))
    lines = [f"NDIME= {dimension}", f"NELEM= {len(inner)}"] + [" ".join(map(str, (types[k], *c, i))) for i, (k, c, _) in enumerate(inner)]
    lines += [f"NPOIN= {len(points)}"] + [" ".join(map(repr, (*map(float, p[:dimension]), i))) for i, p in enumerate(points)]
    labels = sorted({c[2] for c in outer})
    lines.append(f"NMARK= {len(labels)}")
    for label in labels:
        faces = [c for c in outer if c[2] == label]
        lines += [f"MARKER_TAG= {label}", f"MARKER_ELEMS= {len(faces)}"] + [" ".join(map(str, (types[k], *c))) for k, c, _ in faces]
    return "\n".join(lines) + "\n"


def round_trip(taut, name, contents, commands=("deform", "smooth")):
    """contents(path): points, and all else that a program reads."""
    before, others = contents(taut.file(name))
    axis = 2 if np.ptp(before[:, 2]) > 0 else 1
    held = {v: before[v] + [0.25 * (before[v][axis] > before[:, axis].min()), 0, 0] for v in range(len(before))
            if before[v][axis] in (before[:, axis].min(), before[:, axis].max())}
    taut.write("pins.csv", "".join(f"{v},{x!r},{y!r}" + (f",{z!r}\n" if axis == 2 else "\n")
                                   for v, p in held.items() for x, y, z in [map(float, p)]))
    for command in commands:
        out = f"{command}-{name}"
        taut(command, name, "-o", out, *(["--pins", "pins.csv"] if command == "deform" else []))
        after, others_after = contents(taut.file(out))
        assert len(after) == len(before) and np.isfinite(after).all(), f"{out}: {len(after)} points of {len(before)}"
        assert not np.array_equal(before, after), f"{out}: no point was moved"
        assert command != "deform" or all(np.array_equal(after[v], p) for v, p in held.items()), f"{out}: pins"
        same(others, others_after, out)


def blocks_of(cells, order):
    """Cells of one kind after the other: kind, corners, labels."""
    return [(kind, np.array([[c[i] for i in order.get(kind, range(len(c)))] for _, c, _ in items]), np.array([l for _, _, l in items]))
            for kind, group in itertools.groupby(cells, key=lambda c: c[0]) for items in [list(group)]]


def patch():
    """A wavy patch whose coordinates are floats: points, triangles. STL's order: points as triangles first name them."""
    n = 5
    points = [(i / 4, j / 4, (i * j) % 3 / 8) for j in range(n) for i in range(n)]
    faces = [f for j in range(n - 1) for i in range(n - 1) for a in [j * n + i] for f in ((a, a + 1, a + n + 1), (a, a + n + 1, a + n))]
    return points, faces
