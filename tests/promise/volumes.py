# SPDX-License-Identifier: MIT
"""What `taut deform`, `smooth` and `untangle` promise of volume files: cells positive and without overlap as the file has
them, pins where the file can hold them, cells in the wrong order told or turned, interfaces kept."""
import itertools
import json
import math
import os
import random
import struct
import sys
from fractions import Fraction

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "view"))  # client

from exact import area2, exact, volume6
from program import main

# Corners in VTK's order, and what each order of the other hand is.
KINDS = {"triangle": (5, 3), "quad": (9, 4), "tetrahedron": (10, 4), "pyramid": (14, 5), "wedge": (13, 6),
         "hexahedron": (12, 8)}
MIRRORED = {"triangle": (0, 2, 1), "quad": (0, 3, 2, 1), "tetrahedron": (0, 2, 1, 3), "pyramid": (0, 3, 2, 1, 4),
            "wedge": (0, 2, 1, 3, 5, 4), "hexahedron": (0, 3, 2, 1, 4, 7, 6, 5)}
CORNERS = {"tetrahedron": [(0, 1, 2, 3)],
           "pyramid": [(0, 1, 3, 4), (1, 2, 0, 4), (2, 3, 1, 4), (3, 0, 2, 4)],
           "wedge": [(0, 2, 1, 3), (1, 0, 2, 4), (2, 1, 0, 5), (3, 4, 5, 0), (4, 5, 3, 1), (5, 3, 4, 2)],
           "hexahedron": [(0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (5, 4, 6, 1),
                          (6, 5, 7, 2), (7, 6, 4, 3)],
           "triangle": [(0, 1, 2)], "quad": [(0, 1, 3), (1, 2, 0), (2, 3, 1), (3, 0, 2)]}
FACES = {"tetrahedron": [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)],
         "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
         "wedge": [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
         "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}


class Mesh:
    """Points, and cells as pairs of a kind and its corners in VTK's order."""

    def __init__(self, points, cells):
        self.points, self.cells = [tuple(p) for p in points], [(k, tuple(c)) for k, c in cells]

    def planar(self):
        return all(k in ("triangle", "quad") for k, _ in self.cells)

    def vtk(self, kind="double", binary=True):
        """The text of a legacy file."""
        flat = [x for p in self.points for x in (*p, 0.0)[:3]]
        numbers = [n for _, c in self.cells for n in (len(c), *c)]
        types = [KINDS[k][0] for k, _ in self.cells]
        head = f"# vtk DataFile Version 3.0\nmesh\n{'BINARY' if binary else 'ASCII'}\nDATASET UNSTRUCTURED_GRID\n"
        parts = [(f"POINTS {len(self.points)} {kind}", flat, "f" if kind == "float" else "d"),
                 (f"CELLS {len(self.cells)} {len(numbers)}", numbers, "i"),
                 (f"CELL_TYPES {len(types)}", types, "i")]
        out = head.encode()
        for line, values, code in parts:
            body = struct.pack(f">{len(values)}{code}", *values) if binary else " ".join(map(repr, values)).encode()
            out += line.encode() + b"\n" + body + b"\n"
        return out

    def medit(self, references=None, turned=()):
        """The text of a MEDIT file; its wedges have their triangles the other way around."""
        sections = {"triangle": "Triangles", "quad": "Quadrilaterals", "tetrahedron": "Tetrahedra",
                    "pyramid": "Pyramids", "wedge": "Prisms", "hexahedron": "Hexahedra"}
        d = 2 if self.planar() else 3
        lines = [f"MeshVersionFormatted 2\nDimension {d}\nVertices {len(self.points)}"]
        lines += [" ".join(map(repr, (*p, 0.0)[:d])) + " 0" for p in self.points]
        for kind, name in sections.items():
            chosen = [i for i, (k, _) in enumerate(self.cells) if k == kind]
            if chosen:
                lines.append(f"{name}\n{len(chosen)}")
            for i in chosen:
                corners = self.cells[i][1]
                if (kind == "wedge") != (i in turned):
                    corners = [corners[j] for j in MIRRORED[kind]]
                lines.append(" ".join(str(v + 1) for v in corners) + f" {references[i] if references else 0}")
        return "\n".join(lines) + "\nEnd\n"

    def moved(self, to):
        return Mesh([to(*p) for p in self.points], self.cells)

    def not_positive(self, points):
        """Cells with a corner that is not positive, exactly."""
        x = [exact(p) for p in points]
        bad = []
        for i, (kind, corners) in enumerate(self.cells):
            for t in CORNERS[kind]:
                at = [x[corners[j]] for j in t]
                if (area2(*at) if len(t) == 3 else volume6(*at)) <= 0:
                    bad.append(i)
                    break
        return bad

    def measure(self, points):
        """The sum of the measures of the cells, each taken as positive; quads of space are bilinear."""
        x = [exact(p) for p in points]
        total = Fraction(0)
        for kind, corners in self.cells:
            at = [x[v] for v in corners]
            if kind in ("triangle", "quad"):
                total += abs(sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(at, at[1:] + at[:1]))) / 2
                continue
            cell, o = Fraction(0), at[0]
            for face in FACES[kind]:
                f = [at[k] for k in face]
                cuts = [[f]] if len(f) == 3 else [[[f[0], f[1], f[2]], [f[0], f[2], f[3]]],
                                                  [[f[0], f[1], f[3]], [f[1], f[2], f[3]]]]
                cell += sum(volume6(*t, o) for cut in cuts for t in cut) / len(cuts)
            total += abs(cell) / 6
        return total


def grid(n, sizes=(1, 1, 1)):
    """Points of a grid of cubes by their places, and the place of a number."""
    places = list(itertools.product(*(range(m + 1) for m in n)))
    number = {p: i for i, p in enumerate(places)}
    return [tuple(s * c / m for s, c, m in zip(sizes, p, n)) for p in places], number


def hexahedra(n, sizes=(1, 1, 1)):
    points, at = grid(n, sizes)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    return Mesh(points, [("hexahedron", [at[tuple(a + b for a, b in zip(c, d))] for d in corners])
                         for c in itertools.product(*map(range, n))])


def split(mesh, kind):
    """Hexahedra as wedges, tetrahedra or pyramids around a new point; quads as triangles."""
    points, cells = list(mesh.points), []
    for _, c in mesh.cells:
        if kind == "tetrahedron":
            for a, b in itertools.permutations((0, 1, 2), 2):  # Kuhn: a path from corner 0 to corner 6
                place = [0, 0, 0]
                path = [0]
                for axis in (a, b, 3 - a - b):
                    place[axis] = 1
                    path.append([0, 1, 3, 2, 4, 5, 7, 6][place[0] + 2 * place[1] + 4 * place[2]])
                t = [c[k] for k in path]
                if volume6(*(exact(points[v]) for v in t)) < 0:
                    t[1], t[2] = t[2], t[1]
                cells.append(("tetrahedron", t))
        elif kind == "wedge":
            cells.append(("wedge", [c[0], c[2], c[1], c[4], c[6], c[5]]))
            cells.append(("wedge", [c[0], c[3], c[2], c[4], c[7], c[6]]))
        elif kind == "pyramid":
            points.append(tuple(sum(points[v][k] for v in c) / 8 for k in range(3)))
            for face in FACES["hexahedron"]:
                cells.append(("pyramid", [c[k] for k in reversed(face)] + [len(points) - 1]))
        else:
            cells += [("triangle", (c[0], c[1], c[2])), ("triangle", (c[0], c[2], c[3]))]
    return Mesh(points, cells)


def quads(n, m):
    points = [(i / n, j / m) for j in range(m + 1) for i in range(n + 1)]
    at = lambda i, j: j * (n + 1) + i
    return Mesh(points, [("quad", (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
                         for j in range(m) for i in range(n)])


def mesh_of(kind):
    if kind in ("quad", "triangle"):
        return quads(4, 4) if kind == "quad" else split(quads(4, 4), "triangle")
    return hexahedra((2, 2, 2)) if kind == "hexahedron" else split(hexahedra((2, 2, 2)), kind)


def jittered(mesh, seed, by):
    """Inner points of a unit cube or square moved at random."""
    dice = random.Random(seed)
    inside = lambda p: all(0 < x < 1 for x in p)
    return Mesh([tuple(x + dice.uniform(-by, by) for x in p) if inside(p) else p for p in mesh.points], mesh.cells)


def read_points(program, name):
    """The coordinates as they are in a file, and in what they are written: floats of binary, words of text."""
    data = program.read(name)
    if data.startswith(b"MeshVersion"):
        words = data.split()
        d, at = int(words[words.index(b"Dimension") + 1]), words.index(b"Vertices")
        n = int(words[at + 1])
        return [tuple(float(w) for w in words[at + 2 + (d + 1) * i:at + 2 + (d + 1) * i + d]) for i in range(n)]
    if data.startswith(b"NDIME"):
        lines = data.decode().splitlines()
        at = next(i for i, line in enumerate(lines) if line.startswith("NPOIN"))
        d, n = int(lines[0].split("=")[1]), int(lines[at].split("=")[1])
        return [tuple(map(float, line.split()[:d])) for line in lines[at + 1:at + 1 + n]]
    if data.startswith(b"$MeshFormat"):
        lines = data.decode().splitlines()
        at = lines.index("$Nodes")
        return [tuple(map(float, line.split()[1:])) for line in lines[at + 2:at + 2 + int(lines[at + 1])]]
    at = data.index(b"POINTS ")
    end = data.index(b"\n", at)
    _, n, kind = data[at:end].split()
    if b"BINARY" in data[:200]:
        code, size = ("f", 4) if kind == b"float" else ("d", 8)
        flat = struct.unpack(f">{3 * int(n)}{code}", data[end + 1:end + 1 + 3 * size * int(n)])
    else:
        flat = [float(w) for w in data[end:].split()[:3 * int(n)]]
    return [tuple(flat[3 * i:3 * i + 3]) for i in range(int(n))]


def single(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def pins_of(points):
    return "".join(f"{v},{','.join(map(repr, p))}\n" for v, p in points.items())


def twisted_pins(mesh, degrees, low, high):
    """One end of a bar along x stays, the other one turns about its axis."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    middle = [sum(p[k] for p in mesh.points) / len(mesh.points) for k in range(3)]
    pins = {}
    for v, (x, y, z) in enumerate(mesh.points):
        if x == low:
            pins[v] = (x, y, z)
        elif x == high:
            a, b = y - middle[1], z - middle[2]
            pins[v] = (x, middle[1] + c * a - s * b, middle[2] + s * a + c * b)
    return pins


def single_precision(taut):
    """A bar far from the origin, whose cells are few units of the last digit large."""
    told = {"mended": 0, "refused": 0, "infeasible": 0, "as it is": 0}
    far = 2**20
    for size, kind, binary in itertools.product((0.2, 0.3), ("tetrahedron", "hexahedron", "wedge"), (True, False)):
        bar = hexahedra((6, 3, 3), (6 * size, 3 * size, 3 * size))
        bar = (bar if kind == "hexahedron" else split(bar, kind)).moved(lambda *p: tuple(single(x + far) for x in p))
        taut.write("bar.vtk", bar.vtk("float", binary))
        taut.write("pins.csv", pins_of(twisted_pins(bar, 40, far, single(far + 6 * size))))
        for command in ("deform", "untangle", "smooth"):
            given = () if command == "smooth" else ("--pins", "pins.csv")
            if os.path.exists(taut.file("out.vtk")):
                os.remove(taut.file("out.vtk"))
            run = taut(command, "bar.vtk", "-o", "out.vtk", *given, "--stats", "stats.json", code=(0, 6, 7))
            if run.returncode:
                assert not os.path.exists(taut.file("out.vtk")), run.stderr
                assert run.returncode == 7 or "single precision" in run.stderr, run.stderr
                told["refused" if run.returncode == 6 else "infeasible"] += 1
                continue
            told["mended" if "units of the last digit" in run.stderr else "as it is"] += 1
            points = read_points(taut, "out.vtk")
            for read in (points, [tuple(map(single, p)) for p in points]):
                assert bar.not_positive(read) == [], (size, kind, binary, command, bar.not_positive(read))
            stats = json.load(open(taut.file("stats.json")))
            assert stats["inverted"] == 0, stats
            assert "nothing wrong" in taut("check", "out.vtk").stdout
    assert told["mended"] > 0 and told["refused"] < 6, told


def pins_in_single_precision(taut):
    cube = split(hexahedra((3, 3, 3)), "tetrahedron")
    taut.write("cube.vtk", cube.vtk("float"))
    pins = {0: (0.1, 0.1, 0.1), 63: (1.0, 1.0, 1.1)}
    taut.write("pins.csv", pins_of(pins))
    for command in ("deform", "untangle"):
        run = taut(command, "cube.vtk", "-o", "out.vtk", "--pins", "pins.csv", "--stats", "stats.json")
        points = read_points(taut, "out.vtk")
        for v, p in pins.items():
            assert points[v] == tuple(map(single, p)), (command, points[v])
        assert "2 pins (0, 63) are rounded to the single precision of the file" in run.stderr, run.stderr
        stats = json.load(open(taut.file("stats.json")))
        largest = max(abs(single(x) - x) for p in pins.values() for x in p)
        assert stats["pin_rounding"] == largest, (stats["pin_rounding"], largest)
        if command == "deform":
            assert stats["pins_held"] and stats["distance"] == 0, stats
    taut.write("far.csv", "0,1e39,0,0\n")
    for command in ("deform", "untangle"):
        error = taut(command, "cube.vtk", "-o", "far.vtk", "--pins", "far.csv", code=4).stderr
        assert "the pin of vertex 0: 1e+39 is beyond the single precision" in error, error
    # Pins that rounding makes one: both commands say why there is no mesh.
    taut.write("near.csv", pins_of({0: (0.1, 0.1, 0.1), 1: (0.1 + 1e-12, 0.1, 0.1)}))
    for command in ("deform", "untangle"):
        error = taut(command, "cube.vtk", "-o", "near.vtk", "--pins", "near.csv", code=7).stderr
        assert "2 pins (0, 1) are rounded to the single precision of the file" in error, error
    # A text holds all digits.
    taut.write("text.vtk", cube.vtk("float", False))
    assert taut.stats("deform", "text.vtk", "-o", "out.vtk", "--pins", "pins.csv")["pin_rounding"] == 0
    points = read_points(taut, "out.vtk")
    assert all(points[v] == p for v, p in pins.items()), points


def page_saves(taut):
    """Save of `taut view` gives what is certified, in the precision of the file."""
    from client import Program, places, read, save
    for far in (0, 2**20):
        bar = split(hexahedra((6, 3, 3), (0.75, 0.375, 0.375)), "tetrahedron").moved(lambda *p: tuple(single(x + far) for x in p))
        name = taut.file(taut.write("bar.vtk", bar.vtk("float")))
        end, place = len(bar.points) - 1, tuple(far + x for x in (0.875, 0.625, 0.375))
        with Program(taut.path, name) as page:
            s = page.socket()
            s.message("model")
            s.rest()
            s.send(places(1, [(0, 7, bar.points[0]), (end, 7, place)]))
            while not (len((state := s.rest())["pins"]) == 2 and state["held"]):
                pass
            s.send(save())
            while (answer := read(s.frame()))["kind"] not in ("file", "note"):
                pass
        if answer["kind"] == "note":
            assert "single precision" in answer["text"], answer
            continue
        taut.write("saved.vtk", answer["bytes"])
        points = read_points(taut, "saved.vtk")
        assert bar.not_positive(points) == [], far
        assert points[end] == tuple(map(single, place)), points[end]


def pins_of_untangle(taut):
    """`taut untangle MESH --pins`: what is pinned lies there, what is not may move."""
    cube = split(hexahedra((3, 3, 3)), "tetrahedron")
    taut.write("cube.mesh", cube.medit())
    pins = {v: p for v, p in enumerate(cube.points) if p[0] in (0, 1)}
    moved = {v: (p[0], p[1], p[2] + 0.25) if p[0] == 1 else p for v, p in pins.items()}
    moved[next(v for v, p in enumerate(cube.points) if all(0 < x < 1 for x in p))] = (0.9, 0.5, 0.5)
    taut.write("pins.csv", pins_of(moved))
    stats = taut.stats("untangle", "cube.mesh", "-o", "out.mesh", "--pins", "pins.csv")
    points = read_points(taut, "out.mesh")
    assert stats["outcome"] == "injective" and stats["pinned"] == len(moved), stats
    assert all(points[v] == p for v, p in moved.items())
    assert cube.not_positive(points) == []
    assert any(points[v] != p for v, p in enumerate(cube.points) if v not in moved)


def fan(kinds, turns, height=0):
    """Cells around a vertex of the plane, or an edge of space, that go around it so many times."""
    n = len(kinds)
    points = [(0.0, 0.0)]
    at = lambda r, k: points.append((r * math.cos(0.1 + 2 * math.pi * turns * k / n),
                                     r * math.sin(0.1 + 2 * math.pi * turns * k / n))) or len(points) - 1
    rim = [at(1, k) for k in range(n)]
    cells = []
    for k, kind in enumerate(kinds):
        a, b = rim[k], rim[(k + 1) % n]
        cells.append((kind, (0, a, b) if kind == "triangle" else (0, a, at(1.5, k + 0.5), b)))
    if not height:
        return Mesh(points, cells)
    m, bent = len(points), 0.05
    both = [(x, y, 0.0) for x, y in points] + [(x + bent, y, float(height)) for x, y in points]
    return Mesh(both, [("wedge", (c[0], c[2], c[1], c[0] + m, c[2] + m, c[1] + m)) if k == "triangle"
                       else ("hexahedron", c + tuple(v + m for v in c)) for k, c in cells])


def pyramids_around(n, turns):
    """Pyramids whose bases have the edge 0-1: quads and triangles at it, in turns."""
    points = [(0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    for z, r in ((0.0, 1.0), (1.0, 1.2)):
        points += [(r * math.cos(0.1 + 2 * math.pi * turns * k / n), r * math.sin(0.1 + 2 * math.pi * turns * k / n), z)
                   for k in range(n)]
    cells = []
    for k in range(n):
        i, j = 2 + k, 2 + (k + 1) % n
        cells.append(("pyramid", (0, 1, i + n, i, j) if k % 2 == 0 else (0, j, j + n, 1, i)))
    return Mesh(points, cells)


def winding(taut):
    """What goes around a vertex or an edge twice is told by every command, and written by none."""
    q, t = "quad", "triangle"
    shapes = {"quads": fan([q] * 8, 2), "one_quad": fan([q] + [t] * 14, 2), "mixed": fan([q, t, t] * 4, 2),
              "thrice": fan([q] * 15, 3), "wedges": fan([t] * 10, 2, 1), "hexahedra": fan([q] * 9, 2, 2),
              "both": fan([q, t, t] * 4, 2, 1), "pyramids": pyramids_around(12, 2)}
    for name, mesh in shapes.items():
        once = {"pyramids": pyramids_around(12, 1)}.get(name) or fan(
            [t if k in ("triangle", "wedge") else q for k, _ in mesh.cells], 1, 0 if mesh.planar() else 1)
        for what, code in ((mesh, 4), (once, 0)):
            assert what.not_positive(what.points) == [], name
            for suffix, text in (("vtk", what.vtk()), ("mesh", what.medit())):
                file = taut.write(f"{name}.{suffix}", text)
                out = taut("check", file, code=code).stdout
                assert ("more than once" in out) == (code == 4), (name, out)
                says = taut("eval", file).stdout
                assert ("more than once" in says) == (code == 4), (name, says)
                if suffix == "vtk":
                    for command in ("untangle", "smooth", "deform"):
                        limit = ("--time-limit", "2") if code else ()  # what has no map is not searched for long
                        taut(command, file, "-o", f"out.{suffix}", *limit, code=(6, 7) if code else 0)
                        assert os.path.exists(taut.file(f"out.{suffix}")) == (code == 0), (name, command)
                        for left in (f"out.{suffix}", f"out.{suffix}.invalid"):
                            if os.path.exists(taut.file(left)):
                                os.remove(taut.file(left))


def turned_cells(taut):
    """A cell with its corners in the other order is read turned over, whatever the command and the format; what comes
    out fills the domain once."""
    for kind in MIRRORED:
        mesh = jittered(mesh_of(kind), 3, 0.05)
        n = len(mesh.cells)
        for command, turned in ("smooth", [5 % n]), ("untangle", list(range(n))), ("deform", list(range(0, n, 2))):
            as_vtk = Mesh(mesh.points, [(k, [c[j] for j in MIRRORED[k]] if i in turned else c)
                                        for i, (k, c) in enumerate(mesh.cells)])
            for suffix, text in (("vtk", as_vtk.vtk()), ("mesh", mesh.medit(turned=turned))):
                file = taut.write(f"{kind}.{suffix}", text)
                check = json.loads(taut("check", file, "--json").stdout)
                assert check["turned_ids"] == turned and check["inverted"] == 0, (kind, turned, check)
                run = taut(command, file, "-o", f"out.{suffix}")
                assert "in the other order" in run.stderr, (kind, command, run.stderr)
                points = read_points(taut, f"out.{suffix}")
                assert mesh.not_positive(points) == [] and mesh.measure(points) == 1, (kind, turned, command)
                assert json.loads(taut("check", f"out.{suffix}", "--json").stdout)["turned_ids"] == turned
                assert "in the other order" in taut("eval", file).stderr


def tangled_is_not_turned(taut):
    """Inverted cells whose neighbours agree with them are for untangling, also beside cells that are turned."""
    for kind in MIRRORED:
        mesh = mesh_of(kind)
        inside = [v for v, p in enumerate(mesh.points) if all(0 < x < 1 for x in p)]
        points = list(mesh.points)
        points[inside[0]] = tuple(1.3 for _ in points[0])
        for turned in ([], [1]):
            bad = Mesh(points, [(k, [c[j] for j in MIRRORED[k]] if i in turned else c)
                                for i, (k, c) in enumerate(mesh.cells)])
            taut.write("bad.vtk", bad.vtk())
            check = json.loads(taut("check", "bad.vtk", "--json", code=4).stdout)
            assert check["turned_ids"] == turned and check["inverted"] > 0, (kind, check)
            taut("untangle", "bad.vtk", "-o", "out.vtk")
            found = read_points(taut, "out.vtk")
            assert mesh.not_positive(found) == [] and mesh.measure(found) == 1, kind


def what_no_turning_mends(taut):
    """Copies of cells, three on a side, a strip with one side: refused by every command before anything is solved."""
    quad = quads(3, 3)
    hexes = hexahedra((2, 1, 1))
    n = len(hexes.points)
    strip = [(math.cos(2 * math.pi * k / 9), math.sin(2 * math.pi * k / 9)) for k in range(9)]
    moebius = Mesh([(r * x, r * y) for r in (1, 2) for x, y in strip],
                   [("quad", (k, k + 1, k + 10, k + 9)) for k in range(8)] + [("quad", (8, 9, 0, 17))])
    shapes = {"copy": (Mesh(quad.points, quad.cells + [quad.cells[4]]), "three or more"),
              "alone": (Mesh(quad.points, [quad.cells[0]] * 2), "same corners"),
              "third": (Mesh(hexes.points + [(0.5, -1.0, 0.5)],
                             hexes.cells + [("pyramid", (*hexes.cells[0][1][1:3], *hexes.cells[0][1][6:4:-1], n))]),
                        "three or more"),
              "moebius": (moebius, "oriented differently")}
    for name, (mesh, why) in shapes.items():
        file = taut.write(f"{name}.vtk", mesh.vtk())
        for command in ("check", "eval", "untangle", "smooth", "deform"):
            output = () if command in ("check", "eval") else ("-o", "out.vtk")
            run = taut(command, file, *output, code=4)
            assert why in run.stdout + run.stderr, (name, command, run.stdout, run.stderr)


def problems(taut):
    """A problem has the order of corners that it states: cells that clash are told by every command."""
    mesh = split(quads(3, 3), "triangle")
    for turned in ([], [4]):
        cells = [c if i not in turned else (c[0], c[2], c[1]) for i, (_, c) in enumerate(mesh.cells)]
        rows = [f"{len(mesh.points)} 2"] + [f"{x!r} {y!r}" for x, y in mesh.points]
        rim = [v for v, p in enumerate(mesh.points) if not all(0 < x < 1 for x in p)]
        rows = rows + rows + [f"{len(cells)} 3"] + [" ".join(map(str, c)) for c in cells]
        taut.write("in.prob", "\n".join(rows + [str(len(rim))] + list(map(str, rim))) + "\n")
        for command in ("check", "eval", "untangle", "deform"):
            output = () if command in ("check", "eval") else ("-o", "out.prob")
            run = taut(command, "in.prob", *output, code=4 if turned else 0)
            assert not turned or "oriented differently" in run.stdout + run.stderr, (command, run.stdout, run.stderr)


def su2(mesh, markers, turned=()):
    """The text of a planar mesh; markers: the edges of each by name."""
    cells = [[c[j] for j in MIRRORED[k]] if i in turned else c for i, (k, c) in enumerate(mesh.cells)]
    lines = ["NDIME= 2", f"NELEM= {len(cells)}"] + [f"5 {' '.join(map(str, c))} {i}" for i, c in enumerate(cells)]
    lines += [f"NPOIN= {len(mesh.points)}"] + [f"{x!r} {y!r} {i}" for i, (x, y) in enumerate(mesh.points)]
    lines.append(f"NMARK= {len(markers)}")
    for name, edges in markers.items():
        lines += [f"MARKER_TAG= {name}", f"MARKER_ELEMS= {len(edges)}"] + [f"3 {a} {b}" for a, b in edges]
    return "\n".join(lines) + "\n"


def zones_of_su2(taut):
    """One zone is read and written, by all commands; nothing else of the file changes, whatever it is called."""
    names = {"lower": "hold", "upper": "push"}

    def zone(number, n, at, turned=()):
        mesh = split(quads(n, n), "triangle").moved(lambda x, y: (x + at, y))
        row = n * (n + 1)
        markers = {names["lower"]: [(i, i + 1) for i in range(n)],
                   names["upper"]: [(row + i, row + i + 1) for i in range(n)]}
        text = f"IZONE= {number}\n" + su2(mesh, markers, turned)
        return mesh, text + f"FFD_NBOX= 1\nFFD_TAG= BOX{number}\nFFD_CORNER_POINTS= 4\n0.0 0.0\n1.0 0.0\n1.0 1.0\n0.0 1.0\n"

    for order in ((1, 2), (2, 1), (1, 2, 3), (3, 1, 2)):
        zones = [zone(number, 2 + number, 10 * k, {0} if k else ()) for k, number in enumerate(order)]
        head = f"% several\nNZONE= {len(order)}\n"
        taut.write("in.su2", head + "".join(text for _, text in zones))
        count = f"{len(order)} zones"
        for command in ("check", "eval", "deform", "smooth", "untangle"):
            output = () if command in ("check", "eval") else ("-o", "no.su2")
            told = taut(command, "in.su2", *output, code=3)
            assert count in told.stdout + told.stderr and "--zone" in told.stdout + told.stderr, told
            told = taut(command, "in.su2", *output, "--zone", len(order) + 1, code=3)
            assert f"zone {len(order) + 1} of {len(order)}" in told.stdout + told.stderr, told
            taut(command, "in.su2", *output, "--zone", 0, code=2)
            assert not os.path.exists(taut.file("no.su2"))
        for k, number in enumerate(order):
            mesh, text = zones[k]
            chosen = ("--zone", number)
            assert f"{len(mesh.points)} vertices" in taut("check", "in.su2", *chosen).stdout
            assert f"{len(mesh.points)} vertices" in taut("eval", "in.su2", *chosen).stdout
            for command in (("deform", "--fix", "hold", "--move", "push:translate:0,0.25,0"), ("smooth",), ("untangle", "--pins", "p.csv")):
                taut.write("p.csv", "0,%r,%r,0\n" % mesh.points[0])
                taut(command[0], "in.su2", "-o", "out.su2", *command[1:], *chosen)
                out = taut.read("out.su2").decode()
                before = head + "".join(t for _, t in zones[:k])
                after = "".join(t for _, t in zones[k + 1:])
                assert out.startswith(before) and out.endswith(after), "other zones are byte for byte as they were"
                written = out[len(before):len(out) - len(after)]
                lines, old = written.splitlines(), text.splitlines()
                at = next(i for i, line in enumerate(old) if line.startswith("NPOIN"))
                n = len(mesh.points)
                assert len(lines) == len(old) and lines[:at + 1] == old[:at + 1] and lines[at + 1 + n:] == old[at + 1 + n:]
                points = [tuple(map(float, line.split()[:2])) for line in lines[at + 1:at + 1 + n]]
                assert mesh.not_positive(points) == []
                if command[0] == "deform":
                    assert all(abs(points[i][1] - 1.25) < 1e-15 for i in range(n) if mesh.points[i][1] == 1)
                taut("eval", "in.su2", "out.su2", *chosen)
    text = head + "".join(t for _, t in zones)
    for cut in range(0, len(text), 97):
        taut.write("cut.su2", text[:cut])
        taut("check", "cut.su2", "--zone", 1, code=(0, 3, 4))
    taut.write("one.su2", "NZONE= 1\n" + zone(1, 3, 0)[1])
    taut("check", "one.su2")
    taut("check", "one.su2", "--zone", 1)
    taut.write("in.mesh", split(quads(2, 2), "triangle").medit())
    assert "SU2" in taut("smooth", "in.mesh", "-o", "no.mesh", "--zone", 1, code=3).stderr
    taut.write("in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")
    for command in (("check", "in.obj"), ("eval", "in.obj"), ("deform", "in.obj", "-o", "no.obj")):
        assert "SU2" in taut(*command, "--zone", 1, code=2).stderr


def shared_markers_of_su2(taut):
    """A marker of a partition says with whom it exchanges its elements."""
    text = su2(split(quads(3, 3), "triangle"), {"lower": [(0, 1)], "upper": [(12, 13), (13, 14), (14, 15)]})
    for keys in ("MARKER_ELEMS= 1\nSEND_RECV= 1\n", "MARKER_ELEMS= 1\nSEND_RECV= -1\n"):
        for name in ("lower", "SEND_RECEIVE"):
            taut.write("in.su2", text.replace("MARKER_TAG= lower\nMARKER_ELEMS= 1\n3 0 1\n", f"MARKER_TAG= {name}\n{keys}1 3 0\n"))
            taut("check", "in.su2")
            taut("deform", "in.su2", "-o", "out.su2", "--fix", "upper" if name != "lower" else name)


def clockwise_su2(taut):
    """SU2 has no rule for the order of corners, and every corner of a mesh is in two markers."""
    mesh = split(quads(5, 5), "triangle")
    markers = {"lower": [(i, i + 1) for i in range(5)], "upper": [(30 + i, 31 + i) for i in range(5)],
               "right": [(6 * i + 5, 6 * i + 11) for i in range(5)]}
    dice = random.Random(4)
    for turned in (set(range(50)), {i for i in range(50) if dice.random() < 0.5}, {7}):
        text = su2(mesh, markers, turned)
        taut.write("in.su2", text)
        taut("deform", "in.su2", "-o", "out.su2", "--fix", "lower", "--move", "upper:translate:0,0.2,0")
        points = read_points(taut, "out.su2")
        assert mesh.not_positive(points) == []
        assert taut.read("out.su2").decode().splitlines()[:52] == text.splitlines()[:52]
        assert all(math.dist(points[30 + i], (i / 5, 1.2)) < 1e-12 for i in range(6)), points[30:]
    taut.write("in.su2", su2(mesh, markers))
    for off, code in ((6e-18, 0), (-1e-37, 0), (1e-3, 4)):
        taut.write("lower.csv", "".join(f"{i},{i / 5!r},{-0.1 * math.sin(math.pi * i / 5) if i < 5 else off!r},0\n"
                                        for i in range(6)))
        run = taut("deform", "in.su2", "-o", "out.su2", "--fix", "right", "--move", "lower=lower.csv", code=code)
        if code == 0:
            assert "1 vertex (5) in two groups" in run.stderr, run.stderr
            points = read_points(taut, "out.su2")
            assert points[5] == (1, 0) and mesh.not_positive(points) == [], points[5]


def interfaces(taut):
    """Smoothing keeps the faces between materials and inside with a name, and the lines where pieces meet."""
    cube = jittered(split(hexahedra((4, 3, 3)), "tetrahedron"), 11, 0.0)
    dice = random.Random(8)
    shaken = []
    for x, y, z in cube.points:
        d = [dice.uniform(-0.08, 0.08) for _ in range(3)]
        shaken.append((x + d[0] * (0 < x < 1 and x != 0.5), y + d[1] * (0 < y < 1), z + d[2] * (0 < z < 1)))
    mesh = Mesh(shaken, cube.cells)
    middle = [v for v, p in enumerate(cube.points) if p[0] == 0.5]
    rest_of = [v for v, p in enumerate(cube.points) if 0 < p[0] < 1 and p[0] != 0.5]
    material = [1 if sum(cube.points[v][0] for v in c) / 4 < 0.5 else 2 for _, c in cube.cells]
    for name, text in (("two.mesh", mesh.medit(material)), ("one.mesh", mesh.medit())):
        taut.write(name, text)
        run = taut("smooth", name, "-o", "out.mesh")
        points = read_points(taut, "out.mesh")
        assert mesh.not_positive(points) == []
        left = [v for v in middle if points[v][0] != 0.5]
        if name == "two.mesh":
            assert not left, left
            assert "stay on interfaces" in run.stderr, run.stderr
            inner = [v for v in middle if all(0 < x < 1 for x in points[v][1:])]
            assert any(points[v] != mesh.points[v] for v in inner)  # they slide
        else:
            assert left
        assert any(points[v] != mesh.points[v] for v in rest_of)
    data = f"CELL_DATA {len(material)}\nSCALARS material int 1\nLOOKUP_TABLE default\n" + "\n".join(map(str, material))
    taut.write("two.vtk", mesh.vtk(binary=False) + data.encode() + b"\n")
    rows = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(mesh.points))]
    rows += [f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(mesh.points)]
    rows += ["$EndNodes", "$Elements", str(len(mesh.cells))]
    rows += [f"{i + 1} 4 2 {material[i]} 1 {' '.join(str(v + 1) for v in c)}" for i, (_, c) in enumerate(mesh.cells)]
    taut.write("two.msh", "\n".join(rows + ["$EndElements"]) + "\n")
    for name in ("two.vtk", "two.msh"):
        taut("smooth", name, "-o", "out." + name[-3:])
        points = read_points(taut, "out." + name[-3:])
        assert mesh.not_positive(points) == [] and all(points[v][0] == 0.5 for v in middle), name
    taut("smooth", "two.mesh", "-o", "out.mesh", "--interfaces", "free")
    assert any(read_points(taut, "out.mesh")[v][0] != 0.5 for v in middle)
    for boundary in ("free", "fixed"):
        taut("smooth", "two.mesh", "-o", "out.mesh", "--boundary", boundary)
        points = read_points(taut, "out.mesh")
        assert all(points[v][0] == 0.5 for v in middle), boundary
    # A named line inside a planar mesh stays straight, and its free end where it is; a slanted one too.
    square = quads(6, 6)
    slanted = Mesh([(x + dice.uniform(-0.05, 0.05) * (0 < x < 1 and 0 < y < 1 and abs(y - x) > 1e-9),
                     y + dice.uniform(-0.05, 0.05) * (0 < x < 1 and 0 < y < 1 and abs(y - x) > 1e-9))
                    for x, y in square.points], split(square, "triangle").cells)
    line = [i * 8 for i in range(5)]  # from a corner along the diagonal
    text = slanted.medit()[:-4] + f"Edges\n{len(line) - 1}\n" + "".join(
        f"{a + 1} {b + 1} 7\n" for a, b in zip(line, line[1:])) + "End\n"
    taut.write("line.mesh", text)
    taut("smooth", "line.mesh", "-o", "out.mesh")
    points = read_points(taut, "out.mesh")
    assert all(abs(points[v][0] - points[v][1]) < 1e-6 for v in line), [points[v] for v in line]
    assert points[line[-1]] == slanted.points[line[-1]]


def any_size(taut):
    """Shapes have no size: smoothing a mesh of any size is smoothing it."""
    for kind in ("tetrahedron", "hexahedron", "quad"):
        mesh = jittered(mesh_of(kind), 5, 0.1)
        best = None
        for exponent in (0, 332, -332, -365, 660, -660):  # of two: 1e100, 1e-100, 1e-110, ..
            scaled = mesh.moved(lambda *p: tuple(math.ldexp(x, exponent) for x in p))
            taut.write("in.mesh", scaled.medit())
            taut("smooth", "in.mesh", "-o", "out.mesh")
            points = read_points(taut, "out.mesh")
            assert mesh.not_positive(points) == [], exponent
            back = [tuple(math.ldexp(x, -exponent) for x in p) for p in points]
            best = best or back
            assert all(math.dist(p, q) < 1e-6 for p, q in zip(back, best)), (kind, exponent)


def interfaces_of_any_kind(taut):
    """Named lines with copies, few cells a region, and warped faces: interfaces all the same."""
    square = split(quads(4, 2), "triangle")
    moved = Mesh([(x + 0.1 * (x == 0.25 and y == 0.5), y - 0.05 * (x == y == 0.5)) for x, y in square.points],
                 square.cells)
    edges = "".join(f"{a} {b} {label}\n" for a, b in ((3, 8), (8, 13)) for label in (0, 7))
    taut.write("copies.mesh", moved.medit()[:-4] + "Edges\n4\n" + edges + "End\n")
    taut("smooth", "copies.mesh", "-o", "out.mesh")
    assert all(read_points(taut, "out.mesh")[v][0] == 0.5 for v in (2, 7, 12))

    columns = quads(3, 3)
    shaken = Mesh([(x + 0.05 * (0.3 < x < 0.4), y + 0.04 * (0 < y < 1 and 0.6 < x < 0.7)) for x, y in columns.points],
                  columns.cells)
    labels = [1 + c % 3 for c in range(9)]
    taut.write("few.vtk", shaken.vtk(binary=False) + b"CELL_DATA 9\nSCALARS material int 1\nLOOKUP_TABLE default\n"
               + "\n".join(map(str, labels)).encode() + b"\n")
    taut("smooth", "few.vtk", "-o", "out.vtk")
    points = read_points(taut, "out.vtk")
    assert all(points[v][0] == shaken.points[v][0] for v in range(16) if v % 4 in (1, 2))

    cubes = hexahedra((2, 2, 2))
    middle = next(v for v, p in enumerate(cubes.points) if p == (0.5, 0.5, 0.5))
    warped = Mesh([(0.58, 0.56, 0.48) if v == middle else p for v, p in enumerate(cubes.points)], cubes.cells)
    material = [1 if sum(cubes.points[v][0] for v in c) / 8 < 0.5 else 2 for _, c in cubes.cells]
    taut.write("warped.mesh", warped.medit(material))
    taut("smooth", "warped.mesh", "-o", "out.mesh")
    points = read_points(taut, "out.mesh")
    assert all(points[v] == warped.points[v] for v, p in enumerate(cubes.points) if p[0] == 0.5), points


def long_axes(taut):
    """A rotation has an axis, of whatever length."""
    cube = split(hexahedra((1, 1, 1)), "tetrahedron")
    sides = [[v + 1 for v in c] for c in ([k for k, p in enumerate(cube.points) if p[0] == 0],)]
    text = cube.medit()[:-4] + f"RequiredVertices\n{len(sides[0])}\n" + "\n".join(map(str, sides[0])) + "\nEnd\n"
    taut.write("in.mesh", text)
    wanted = None
    for length in ("1", "1e300", "1e-170"):
        taut("deform", "in.mesh", "-o", "out.mesh", "--move", f"required_vertices:rotate:{length},0,0,30")
        points = read_points(taut, "out.mesh")
        wanted = wanted or points
        assert all(math.dist(p, q) < 1e-9 for p, q in zip(points, wanted)), length


def beside_the_boundary(taut):
    """Where single precision of the device sees no area, smoothing goes on in double."""
    square = split(quads(2, 2), "triangle")
    taut.write("in.mesh", Mesh([(1e-15 if p == (0.5, 0.5) else p[0], p[1]) for p in square.points], square.cells).medit())
    taut("smooth", "in.mesh", "-o", "out.mesh")
    assert read_points(taut, "out.mesh")[4][0] > 0.1
    taut("check", "out.mesh")


def flat_within_rounding(taut):
    """Cells of nearly no volume are found, and told by their exact signs: inverted, flat, or positive."""
    mesh = split(hexahedra((6, 6, 6), (6 / 32, 6 / 32, 6 / 32)), "tetrahedron")
    of_face = {}
    for i, (_, c) in enumerate(mesh.cells):
        for face in itertools.combinations(c, 3):
            of_face.setdefault(frozenset(face), []).append(i)
    points, cells, thin, used = list(mesh.points), list(mesh.cells), {}, set()
    for face, of in sorted(of_face.items(), key=lambda item: sorted(item[0])):
        heights = {points[v][2] for v in face}
        if len(of) < 2 or heights != {5 / 32} or set(of) & used or len(thin) == 6:
            continue
        cell = cells[of[0]][1]
        apex = next(v for v in cell if v not in face)
        side = 1 if points[apex][2] > 5 / 32 else -1
        # A point almost on the face: the cell behind becomes three, and one between of nearly no volume.
        sign = (1, -1, 0)[len(thin) % 3]
        points.append((*(sum(points[v][k] for v in face) / 3 for k in (0, 1)), 5 / 32 + sign * side * 2.0**-55))
        at = lambda old: ("tetrahedron", [len(points) - 1 if v == old else v for v in cell])
        cells[of[0]] = at(apex)
        cells += [at(v) for v in face]
        thin[of[0]] = sign
        used.update(of)
    made = Mesh(points, cells)
    volume = {i: volume6(*(exact(points[v]) for v in cells[i][1])) / 6 for i in thin}
    assert len(thin) == 6 and all(abs(v) < 1e-20 and (v > 0) - (v < 0) == thin[i] for i, v in volume.items()), volume
    bad = sorted(i for i, sign in thin.items() if sign <= 0)
    assert made.not_positive(points) == bad
    told = json.loads(taut("check", taut.write("thin.vtk", made.vtk()), "--json", code=4).stdout)
    of = lambda sign: sorted(i for i in thin if thin[i] == sign)
    assert told["inverted"] == len(bad) and told["inverted_ids"] == of(-1), told
    assert told["degenerate_ids"] == sorted(of(0) + of(1)), told
    found = {f["message"].split(") ")[1].split(",")[0].split(";")[0]: (f["severity"], f["ids"]) for f in told["findings"]}
    assert found == {"inverted": ("error", of(-1)), "flat": ("error", of(0)), "positive": ("warning", of(1))}, found


if __name__ == "__main__":
    main(single_precision, pins_in_single_precision, page_saves, pins_of_untangle, winding, turned_cells, tangled_is_not_turned,
         what_no_turning_mends, problems, clockwise_su2, zones_of_su2, shared_markers_of_su2, interfaces, interfaces_of_any_kind, long_axes, beside_the_boundary, any_size, flat_within_rounding)
