# SPDX-License-Identifier: MIT
"""Cells whose corners a file has in the other order: what is split, and what a second file says of the shape at rest."""
import json
import os

from exact import area2, exact, volume6
from formats import Gmsh, Medit, Su2, Vtk, Vtu
from program import main

# Four tetrahedra around an edge: with two vertices beyond it there is no map without splitting that.
OCTAHEDRON = [(0, 1, 2, 3), (0, 1, 3, 4), (0, 1, 4, 5), (0, 1, 5, 2)]
PINS = "0,0,0,-1\n1,0,0,1\n2,-0.2,-1,0\n3,-0.2,1,0\n4,-1,1,0\n5,-1,-1,0\n"


def octahedron(x):
    return [tuple(map(float, p)) for p in ((0, 0, -1), (0, 0, 1), (x, -1, 0), (x, 1, 0), (-1, 1, 0), (-1, -1, 0))]


def mirrored(cell):
    return (cell[0], cell[2], cell[1], *cell[3:])


def with_turned(cells, turned):
    return [mirrored(c) if i in turned else c for i, c in enumerate(cells)]


def signs(points, cells):
    """Of each cell as the file has it, exactly: 1, 0 or -1."""
    x = [exact(p) for p in points]
    values = [area2(*(x[v][:2] for v in c)) if len(c) == 3 else volume6(*(x[v] for v in c)) for c in cells]
    return [(v > 0) - (v < 0) for v in values]


def write(taut, kind, name, points, cells):
    for extension, content in kind.files(points, cells, len(cells[0]) - 1).items():
        taut.write(name + extension, content)
    return name + kind.extension


def read(taut, kind, name):
    return kind.read({kind.extension: taut.read(name + kind.extension)})


def parts_keep_the_order(taut):
    """What a cell is split into has its order; the note of the run and `taut check` name the same parts."""
    taut.write("pins.csv", PINS)
    for kind in Medit(), Gmsh("2.2", False), Vtk("double", False), Vtu("Float64", False):
        e = kind.extension
        for turned in [], [0, 1, 2, 3], [1]:
            flat = write(taut, kind, "flat", octahedron(1), with_turned(OCTAHEDRON, turned))
            folded = write(taut, kind, "folded", octahedron(-0.2), with_turned(OCTAHEDRON, turned))
            for run in (["deform", flat, "--pins", "pins.csv"], ["untangle", folded, "--rest", flat]):
                told = taut(*run, "-o", "out" + e, "--refine", "--refined-map", "parts.csv").stderr
                assert ("in the other order" in told) == (turned != []), (run, turned, told)
                points, cells = read(taut, kind, "out")
                of = [int(line.split(",")[1]) for line in taut.read("parts.csv").decode().split()[1:]]
                wanted = [-1 if of[i] in turned else 1 for i in range(len(cells))]
                assert len(cells) == 8 and signs(points, cells) == wanted, (kind, turned, run, signs(points, cells))
                check = json.loads(taut("check", "out" + e, "--json").stdout)
                assert check["inverted"] == 0 and check["turned_ids"] == [i for i, s in enumerate(wanted) if s < 0]


def shape_at_rest_decides(taut):
    """Which order of corners is right, the shape at rest says, whatever each file makes of itself. What comes out is
    written in the order of the main file and is positive as the shape at rest has it; a mirror image is no map of it."""
    taut.write("pins.csv", PINS.replace("-0.2", "0.5"))
    reversed_, rotated = [tuple(reversed(c[:3])) + c[3:] for c in OCTAHEDRON], [c[1:3] + c[:1] + c[3:] for c in OCTAHEDRON]
    for kind in Medit(), Su2(), Vtk("double", False):
        e = kind.extension
        for own in OCTAHEDRON, with_turned(OCTAHEDRON, range(4)), with_turned(OCTAHEDRON, [2]), reversed_, rotated:
            for other in OCTAHEDRON, with_turned(OCTAHEDRON, range(4)), with_turned(OCTAHEDRON, [0]), rotated:
                mesh, rest = write(taut, kind, "in", octahedron(0.7), own), write(taut, kind, "rest", octahedron(1), other)
                wanted = signs(octahedron(1), own)
                for run in ["deform", mesh, "--pins", "pins.csv"], ["untangle", mesh]:
                    told = taut(*run, "--rest", rest, "-o", "out" + e).stderr
                    points, cells = read(taut, kind, "out")
                    assert cells == own and signs(points, cells) == wanted, (kind, run, own, other)
                    assert ("in the other order" in told) == (-1 in wanted), (kind, run, own, other, told)
                assert json.loads(taut("eval", rest, "out" + e, "--json").stdout)["inverted"] == 0
                mirror = write(taut, kind, "mirror", [(-p[0], *p[1:]) for p in octahedron(1)], own)
                assert json.loads(taut("eval", rest, mirror, "--json").stdout)["inverted"] == 4
                taut.write("mirror.csv", "".join(f"{v},{-p[0]},{p[1]},{p[2]}\n" for v, p in enumerate(octahedron(1))))
                for run in ["untangle", mirror], ["deform", rest]:
                    code = taut(*run, "--rest", rest, "--pins", "mirror.csv", "-o", "late" + e, code=(6, 7))
                assert not os.path.exists(taut.file("late" + e)), code
    other = write(taut, Medit(), "other", octahedron(1), [(0, 1, 2, 3), (0, 1, 3, 4), (0, 1, 4, 5), (0, 1, 2, 4)])
    assert "other cells" in taut("untangle", "in.mesh", "--rest", other, "-o", "late.mesh", code=4).stderr


if __name__ == "__main__":
    main(parts_keep_the_order, shape_at_rest_decides)
