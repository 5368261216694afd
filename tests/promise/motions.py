# SPDX-License-Identifier: MIT
"""What `taut deform --move` promises of large motions: a rotor comes to its place by as many turns as it is asked to, and
the mesh around it is wound as often; where the mesh cannot follow, the error says how far it came, and there is no file.
Gaps of one cell open, and valves close."""
import itertools
import math
import os

from program import main
from volumes import Mesh, read_points, split

AROUND = 16


def ring(kind, outwards, high):
    """Cells between two circles, or two cylinders `high` cells high. Vertices have the reference 1 on the inner one, 2 on
    the outer one, and are in columns of one angle and height, from inside outwards."""
    planar = kind in ("triangle", "quad")
    levels = 1 if planar else high + 1
    angles = [2 * math.pi * i / AROUND for i in range(AROUND)]
    points = [((1 + j) * math.cos(a), (1 + j) * math.sin(a), float(k))[:2 if planar else 3]
              for k in range(levels) for a in angles for j in range(outwards + 1)]
    at = lambda i, j, k: (k * AROUND + i % AROUND) * (outwards + 1) + j
    cells = []
    for i in range(AROUND):
        for j in range(outwards):
            around = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            if planar:
                cells.append(("quad", [at(*c, 0) for c in around]))
            cells += [("hexahedron", [at(*c, k) for c in around] + [at(*c, k + 1) for c in around])
                      for k in range(0 if planar else high)]
    mesh = Mesh(points, cells)
    return mesh if kind in ("quad", "hexahedron") else split(mesh, kind)


def text_of(mesh, outwards):
    lines = mesh.medit().splitlines()
    first = lines.index("Vertices " + str(len(mesh.points))) + 1
    for v in range(len(mesh.points)):
        j = v % (outwards + 1)
        lines[first + v] = lines[first + v][:-1] + ("1" if j == 0 else "2" if j == outwards else "0")
    return "\n".join(lines) + "\n"


def wound(points, outwards):
    """The degrees that each column winds by from the outer circle to the inner one."""
    found = []
    for first in range(0, len(points), outwards + 1):
        angles = [math.atan2(*reversed(p[:2])) for p in points[first:first + outwards + 1]]
        steps = [(a - b + math.pi) % (2 * math.pi) - math.pi for a, b in zip(angles, angles[1:])]
        assert max(map(abs, steps)) < 0.9 * math.pi, "the mesh is too coarse to tell"
        found.append(math.degrees(sum(steps)))
    return found


def turned(p, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (c * p[0] - s * p[1], s * p[0] + c * p[1], *p[2:])


def rotors(taut):
    """Any angle, planar and in space, of simplices and of other cells. In space the mesh would slip over the ends of the
    rotor, so they are held in their planes."""
    cases = (("triangle", 30, 0, (120, 200, 360, 720, -540)), ("quad", 20, 0, (360,)),
             ("tetrahedron", 16, 2, (120, 200, 360, -270)), ("hexahedron", 20, 1, (360,)))
    for kind, outwards, high, angles in cases:
        mesh = ring(kind, outwards, high)
        taut.write("ring.mesh", text_of(mesh, outwards))
        taut.write("ends.csv", "".join(f"{v},,,{p[2]!r}\n" for v, p in enumerate(mesh.points)
                                       if high and 0 < v % (outwards + 1) < outwards and p[2] in (0, high)))
        for degrees in angles:
            told = taut.stats("deform", "ring.mesh", "-o", "out.mesh", "--fix", "vertices:2", "--move",
                              f"vertices:1:rotate:0,0,1,{degrees}", *(("--pins", "ends.csv") if high else ()))
            assert told["outcome"] == "valid" and told["pins_held"] and told["inverted"] == 0, (kind, degrees, told)
            points = read_points(taut, "out.mesh")
            assert mesh.not_positive(points) == [], (kind, degrees)
            for v in range(len(points)):
                if v % (outwards + 1) == 0:
                    assert math.dist(points[v], turned(mesh.points[v], degrees)) < 1e-14, (kind, degrees, v)
                if v % (outwards + 1) == outwards:
                    assert tuple(points[v]) == mesh.points[v], (kind, degrees, v)
            assert all(abs(w - degrees) < 1e-9 for w in wound(points, outwards)), (kind, degrees, wound(points, outwards))


def once(taut):
    """Where cells are solved for again, as they are negative inside, nothing turns a second time."""
    mesh = ring("hexahedron", 4, 1)
    taut.write("ring.mesh", text_of(mesh, 4))
    told = taut.stats("deform", "ring.mesh", "-o", "out.mesh", "--fix", "vertices:2", "--move", "vertices:1:rotate:0,0,1,360")
    assert any("solved again" in note for note in told["notes"]), "another mesh would show it"
    assert told["pins_held"] and told["insides"]["negative"] == 0, told
    assert mesh.not_positive(read_points(taut, "out.mesh")) == []


def too_far(taut):
    """Where cells run out the error says how far the rotor came, and there is no file."""
    for outwards, degrees, least, most in ((3, 3600, 90, 1200), (2, 150, 90, 150)):
        mesh = ring("triangle", outwards, 0)
        taut.write("ring.mesh", text_of(mesh, outwards))
        error = taut("deform", "ring.mesh", "-o", "out.mesh", "--fix", "vertices:2", "--move",
                     f"vertices:1:rotate:0,0,1,{degrees}", code=6).stderr
        assert not os.path.exists(taut.file("out.mesh"))
        said = error[error.index("has turned by ") + len("has turned by "):].split()
        assert least < int(said[0]) < most and said[1:4] == ["of", str(degrees), "degrees;"], error


def around(kind, size, blocks):
    """Unit cells of a box that fill it but for blocks, each a pair of corners. Vertices of block k have the reference k + 1,
    others of the boundary 9."""
    d = len(size)
    inside = lambda p, block, last: all(a <= x < b + last for x, a, b in zip(p, *block))
    number, cells = {}, []
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)] if d == 2 else [(a, b, c) for c in (0, 1)
                                                              for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    for place in itertools.product(*map(range, size)):
        if not any(inside(place, block, 0) for block in blocks):
            at = [tuple(map(sum, zip(place, c))) for c in corners]
            cells.append(("quad" if d == 2 else "hexahedron", [number.setdefault(p, len(number)) for p in at]))
    reference = [next((k + 1 for k, block in enumerate(blocks) if inside(p, block, 1)),
                      9 if any(x in (0, n) for x, n in zip(p, size)) else 0) for p in number]
    mesh = split(Mesh([tuple(map(float, p)) for p in number], cells), kind)
    lines = mesh.medit().splitlines()
    first = lines.index("Vertices " + str(len(mesh.points))) + 1
    for v, r in enumerate(reference):
        lines[first + v] = lines[first + v][:-1] + str(r)
    return mesh, reference, "\n".join(lines) + "\n"


def gaps_and_valves(taut):
    """Two blocks with one layer of cells between go apart by fifty of them; a block comes as near to a wall as a fiftieth of
    their distance."""
    cases = (("triangle", (24, 90), [((8, 10), (16, 14)), ((8, 15), (16, 19))], (0, 49)),
             ("tetrahedron", (8, 8, 78), [((3, 3, 4), (5, 5, 6)), ((3, 3, 7), (5, 5, 9))], (0, 0, 49)),
             ("triangle", (24, 20), [((8, 3), (16, 8))], (0, -2.94)),
             ("tetrahedron", (8, 8, 8), [((3, 3, 2), (5, 5, 4))], (0, 0, -1.96)))
    for kind, size, blocks, by in cases:
        mesh, reference, text = around(kind, size, blocks)
        taut.write("in.mesh", text)
        last, (x, y, z) = len(blocks), (*by, 0)[:3]
        held = [name for k in (9, *range(1, last)) for name in ("--fix", f"vertices:{k}")]
        told = taut.stats("deform", "in.mesh", "-o", "out.mesh", *held, "--move", f"vertices:{last}:translate:{x},{y},{z}")
        assert told["outcome"] == "valid" and told["pins_held"], (kind, by, told)
        points = read_points(taut, "out.mesh")
        assert mesh.not_positive(points) == [], (kind, by)
        for p, q, r in zip(mesh.points, points, reference):
            if r:
                assert math.dist(q, [a + b for a, b in zip(p, by)] if r == last else p) < 1e-12, (kind, by, p, q)


if __name__ == "__main__":
    main(rotors, once, too_far, gaps_and_valves)
