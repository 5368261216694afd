# SPDX-License-Identifier: MIT
"""Every kind of file that the program writes: read, solved, written, read back by code of the test and judged exactly.
What `taut check` and `taut eval` say of an output is what the run said of it, and both are true."""
import json
import math
from itertools import permutations, product

from exact import area2, exact, overlaps, volume6
from formats import VOLUMES, obj, off, ply, read_obj, single, stl
from program import main

SIDE = 3


def cube():
    """A cube of 162 tetrahedra around 8 vertices inside: points by place, cells."""
    number = {p: i for i, p in enumerate(product(range(SIDE + 1), repeat=3))}
    cells = []
    for corner in product(range(SIDE), repeat=3):
        for way in permutations(range(3)):
            at, cell = list(corner), [number[corner]]
            for axis in way:
                at[axis] += 1
                cell.append(number[tuple(at)])
            if sum(way[a] > way[b] for a in range(3) for b in range(a + 1, 3)) % 2:
                cell[2], cell[3] = cell[3], cell[2]
            cells.append(tuple(cell))
    return list(number), cells


def square():
    """A square of 18 triangles of the plane."""
    number = {p: i for i, p in enumerate(product(range(SIDE + 1), repeat=2))}
    cells = []
    for i, j in product(range(SIDE), repeat=2):
        a, b, c, d = (number[p] for p in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
        cells += [(a, b, c), (a, c, d)]
    return list(number), cells


def away(place):
    """Where a vertex lies: coordinates that no float has, so that rounding moves them."""
    return tuple(100 + x / 10 for x in place)


def tangled(places):
    """The places with two vertices inside at each other's place."""
    inside = [i for i, p in enumerate(places) if all(0 < x < SIDE for x in p)]
    swapped = list(places)
    swapped[inside[0]], swapped[inside[-1]] = places[inside[-1]], places[inside[0]]
    return swapped


def near(a, b, tolerance=1e-9):
    return abs(a - b) <= tolerance * max(abs(a), abs(b))


def check_output(taut, kind, name, command, mesh, dimension, options, pins, rest):
    """Runs a command on a file of a kind and holds what it wrote against what it, `check` and `eval` say."""
    points, cells = mesh
    say = f"{name}, {command}"
    for extension, content in kind.files(points, cells, dimension).items():
        taut.write("in" + extension, content)
    for extension, content in kind.files(rest, cells, dimension).items():
        taut.write("rest" + extension, content)
    source, output = "in" + kind.extension, "out" + kind.extension
    stats = taut.stats(command, source, "-o", output, *options)

    extensions = kind.files(points, cells, dimension)
    x, read_cells = kind.read({e: taut.read("out" + e) for e in extensions})
    assert read_cells == cells, f"{say}: other cells"
    x = [p[:dimension] for p in x]
    assert all(math.isfinite(c) for p in x for c in p)
    at = [exact(p) for p in x]
    measure = area2 if dimension == 2 else volume6
    flipped = [i for i, c in enumerate(cells) if measure(*(at[v] for v in c)) <= 0]
    assert not flipped, f"{say}: cells {flipped} are not positive in the file"
    for v, to in pins.items():
        assert x[v] == tuple(kind.rounding(c) for c in to), f"{say}: pin {v} is at {x[v]}, not {to}"

    assert stats["inverted"] == 0, say
    checked = json.loads(taut("check", output, "--json").stdout)
    assert checked["inverted"] == 0 and checked["vertices"] == len(points), say
    measured = json.loads(taut("eval", "rest" + kind.extension, output, "--json").stdout)
    assert measured["inverted"] == 0, say
    for quality in ("mean_ratio", "scaled_jacobian"):
        told = stats["quality"][quality]["worst"]
        for other in (checked["quality"], measured["shapes"]):
            assert near(told, other[quality]["worst"], 1e-3 if kind.ambiguous else 1e-9), f"{say}: {quality} {told}, and {other[quality]['worst']} of the file"
    if command == "deform":
        assert stats["pins_held"] is True and all(x[v] == to for v, to in pins.items()), say
        assert near(stats["energy"], measured["quality"]["isometric"]["by_volume" if dimension == 3 else "by_area"], 1e-5)


def pin_file(taut, pins):
    taut.write("pins.csv", "".join(",".join(map(repr, (v, *to))) + "\n" for v, to in pins.items()))


def commands(taut, kinds, mesh, dimension):
    places, cells = mesh
    rest = [away(p) for p in places]
    # Powers of two: what every kind of file can hold.
    pins = {0: tuple(100.0 for _ in range(dimension)),
            len(places) - 1: tuple(100.5 if k == 0 else 100.25 for k in range(dimension))}
    pin_file(taut, pins)
    for name, kind in kinds.items():
        check_output(taut, kind, name, "deform", (rest, cells), dimension, ["--pins", "pins.csv"], pins, rest)
        boundary = {i: rest[i] for i, p in enumerate(places) if not all(0 < x < SIDE for x in p)}
        knotted = [away(p) for p in tangled(places)]
        check_output(taut, kind, name, "untangle", (knotted, cells), dimension, [], boundary, rest)
        check_output(taut, kind, name, "smooth", (knotted, cells), dimension, ["--boundary", "fixed"], boundary, rest)


def volumes(taut):
    """Tetrahedra, in every kind of file."""
    commands(taut, VOLUMES, cube(), 3)


def plane_meshes(taut):
    """Triangles of the plane."""
    chosen = ("medit", "su2", "gmsh 2.2 text", "gmsh 4.1 binary", "vtk binary float", "vtu raw Float32", "vtu text Float64")
    commands(taut, {name: VOLUMES[name] for name in chosen}, square(), 2)


def dome():
    n = 6
    points = [(i / 8, j / 8, single(0.3 * math.sin(i / 2) * math.cos(j / 3))) for j in range(n + 1) for i in range(n + 1)]
    faces = []
    for j, i in product(range(n), repeat=2):
        a, b, c, d = j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i
        faces += [(a, b, c), (a, c, d)]
    return points, faces


def surface_files(points, faces):
    return {"in.obj": obj(points, faces), "in.off": off(points, faces), "text.ply": ply(points, faces),
            "little.ply": ply(points, faces, "binary_little_endian", "float"),
            "big.ply": ply(points, faces, "binary_big_endian", "double"),
            "text.stl": stl(points, faces, False), "binary.stl": stl(points, faces, True)}


def numbered(points, faces):
    """As STL has it: vertices in the order in which faces name them."""
    order = list(dict.fromkeys(v for f in faces for v in f))
    new = {v: i for i, v in enumerate(order)}
    return [points[v] for v in order], [tuple(new[v] for v in f) for f in faces]


def triangles_of(taut, name):
    """Texture coordinates of the corners of every triangle of an OBJ file, exactly; and what was read."""
    points, coordinates, faces = read_obj(taut.read(name))
    at = [exact(p) for p in coordinates]
    assert all(t is not None for f in faces for _, t in f), f"{name}: a corner without texture coordinates"
    return [tuple(at[t] for _, t in f) for f in faces], points, coordinates, faces


def unwrap(taut):
    """Surfaces of every kind, written as OBJ with pins and springs."""
    points, faces = numbered(*dome())
    pins = {0: (0.1, 0.2), 20: (0.55, 0.3), len(points) - 1: (0.9, 0.8)}
    pin_file(taut, pins)
    for name, content in surface_files(points, faces).items():
        taut.write(name, content)
        stats = taut.stats("unwrap", name, "-o", "out.obj", "--pins", "pins.csv")
        triangles, p, uv, f = triangles_of(taut, "out.obj")
        assert p == points and [tuple(v for v, _ in corners) for corners in f] == faces, f"{name}: another surface"
        flipped = [i for i, t in enumerate(triangles) if area2(*t) <= 0]
        assert not flipped and stats["flipped"] == 0 and stats["branch_points"] == 0, f"{name}: {flipped} flipped"
        for corners in f:
            for v, t in corners:
                assert v not in pins or uv[t] == pins[v], f"{name}: pin {v} is at {uv[t]}"
        measured = json.loads(taut("eval", "out.obj", "--json").stdout)
        for key in ("flipped", "branch_points", "min_det", "max_det"):
            assert near(stats[key], measured[key]), f"{name}: {key} {stats[key]}, and {measured[key]} of the file"
        assert near(stats["energy"], measured["quality"]["isometric"]["by_area"]), name
        taut("check", "out.obj")


def box():
    """The surface of a box: 6 sides of 18 triangles."""
    points, faces = {}, []
    number = lambda p: points.setdefault(p, len(points))
    for axis, side in product(range(3), (0, SIDE)):
        for i, j in product(range(SIDE), repeat=2):
            quad = []
            for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                p = [0, 0, 0]
                p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, a, b
                quad.append(number(tuple(x / 8 for x in p)))
            quad = quad if side else quad[::-1]
            faces += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    return list(points), faces


def atlas(taut):
    """A closed surface of every kind, written as OBJ: in the square, positive and without overlap."""
    points, faces = numbered(*box())
    for name, content in surface_files(points, faces).items():
        taut.write(name, content)
        stats = taut.stats("atlas", name, "-o", "out.obj")
        triangles, p, _, f = triangles_of(taut, "out.obj")
        assert p == points and [tuple(v for v, _ in corners) for corners in f] == faces, f"{name}: another surface"
        assert all(0 <= x <= 1 for t in triangles for q in t for x in q), f"{name}: outside of the square"
        flipped, crossing = [i for i, t in enumerate(triangles) if area2(*t) <= 0], overlaps(triangles)
        assert not flipped and not crossing, f"{name}: {flipped} flipped, {crossing} overlap"
        assert stats["flipped"] == stats["overlaps"] == stats["branch_points"] == 0, name
        # Charts cover the square with their insides: what is used of it is the sum of the areas.
        assert near(stats["utilization"], float(sum(area2(*t) for t in triangles) / 2), 1e-9), name
        measured = json.loads(taut("eval", "out.obj", "--json").stdout)
        assert measured["flipped"] == 0 and measured["branch_points"] == 0, name
        taut("check", "out.obj", code=(0, 4))  # closed, so that `unwrap` would have to cut it


def problems(taut):
    """A problem of the plane and one of space, and their maps as text."""
    for (places, cells), dimension in ((square(), 2), (cube(), 3)):
        rest, initial = [away(p) for p in places], [away(p) for p in tangled(places)]
        held = [i for i, p in enumerate(places) if not all(0 < x < SIDE for x in p)]

        def problem(x):
            rows = lambda values: f"{len(values)} {len(values[0])}\n" + "".join(
                " ".join(map(repr, v)) + "\n" for v in values)
            return rows(rest) + rows(x) + rows(cells) + f"{len(held)}\n" + "".join(f"{v}\n" for v in held)
        taut.write("in.prob", problem(initial))
        stats = taut.stats("untangle", "in.prob", "-o", "out.txt")
        x = [tuple(map(float, line.split())) for line in taut.read("out.txt").decode().splitlines()]
        assert len(x) == len(places) and all(x[v] == initial[v] for v in held)
        at = [exact(p) for p in x]
        measure = area2 if dimension == 2 else volume6
        assert all(measure(*(at[v] for v in c)) > 0 for c in cells)
        assert stats["outcome"] == "injective" and stats["inverted"] == 0
        taut.write("again.prob", problem(x))
        assert json.loads(taut("check", "again.prob", "--json").stdout)["inverted"] == 0
        measured = json.loads(taut("eval", "again.prob", "--json").stdout)
        assert measured["flipped" if "flipped" in measured else "inverted"] == 0


if __name__ == "__main__":
    main(volumes, plane_meshes, unwrap, atlas, problems)
