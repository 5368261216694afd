#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""oracle.py PROGRAM FOLDER: meshio writes meshes in each format, PROGRAM (change_points) reads them and writes them with
other coordinates, and meshio reads back. What the program reads must be what meshio wrote, and of what it writes all but
the coordinates must be the same to meshio. Code 77: there is no meshio."""
import os
import shutil
import subprocess
import sys

try:
    import meshio
    import numpy as np
except ImportError:
    print("skipped: no python3-meshio; scripts/setup installs it")
    sys.exit(77)

program, folder = sys.argv[1:]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
generator = np.random.default_rng(7)

NAMES = {"vertex": "vertex", "line": "line", "triangle": "triangle", "quad": "quad", "tetra": "tetrahedron",
         "pyramid": "pyramid", "wedge": "wedge", "hexahedron": "hexahedron"}
DIMENSIONS = {"vertex": 0, "line": 1, "triangle": 2, "quad": 2, "tetra": 3, "pyramid": 3, "wedge": 3, "hexahedron": 3}


def tetrahedra(cells=3):
    """A grid of cubes, each split into six tetrahedra, and the triangles of one side; points shaken."""
    n = cells + 1
    points = np.array([[x, y, z] for z in range(n) for y in range(n) for x in range(n)], dtype=float)
    at = lambda x, y, z: x + n * (y + n * z)
    tets, side = [], []
    for z in range(cells):
        for y in range(cells):
            for x in range(cells):
                for path in ((1, 2, 4), (2, 4, 1), (4, 1, 2), (2, 1, 4), (1, 4, 2), (4, 2, 1)):
                    corner, steps = [(0, 0, 0)], np.zeros(3, int)
                    for bit in path:
                        steps[{1: 0, 2: 1, 4: 2}[bit]] = 1
                        corner.append(tuple(steps))
                    tet = [at(x + i, y + j, z + k) for i, j, k in corner]
                    a, b, c, d = points[tet]
                    if np.dot(np.cross(b - a, c - a), d - a) < 0:
                        tet[2], tet[3] = tet[3], tet[2]
                    tets.append(tet)
                if z == 0:
                    side += [[at(x, y, 0), at(x, y + 1, 0), at(x + 1, y, 0)],
                             [at(x + 1, y, 0), at(x, y + 1, 0), at(x + 1, y + 1, 0)]]
    points += 0.1 * generator.random(points.shape)
    return points, [("triangle", np.array(side)), ("tetra", np.array(tets))]


def mixed():
    """A hexahedron with a wedge on a side, a pyramid on top and a tetrahedron beside it; corners as gmsh has them."""
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1],
                       [2, 0.5, 0], [2, 0.5, 1], [0.5, 0.5, 2], [1.5, 0.5, 2]], dtype=float)
    return points, [("hexahedron", np.array([[0, 1, 2, 3, 4, 5, 6, 7]])), ("wedge", np.array([[1, 8, 2, 5, 9, 6]])),
                    ("pyramid", np.array([[4, 5, 6, 7, 10]])), ("tetra", np.array([[5, 9, 6, 11]]))]


def planar():
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.375]], dtype=float)
    return points, [("triangle", np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]))]


def tags_of(cells, names):
    """The number of each cell's group, of one name a dimension and kind of values."""
    return {name: [1 + np.arange(len(c)) % 3 + 10 * DIMENSIONS[kind] for kind, c in cells] for name in names}


def same(a, b, what):
    if not (np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b):
        raise AssertionError(f"{what}: {str(a)[:400]}\nand {str(b)[:400]}")


def same_data(a, b, what):
    same(sorted(a), sorted(b), what)
    for name in a:
        for x, y in zip(a[name], b[name]):
            same(np.asarray(x), np.asarray(y), f"{what} {name}")


def run(name):
    source = os.path.join(folder, name)
    target = os.path.join(folder, "changed-" + name)
    text = os.path.join(folder, name + ".txt")
    subprocess.run([program, source, target, text], check=True)
    return source, target, open(text, encoding="utf-8").read().split("\n")


def check(name, key=None, names=None):
    """key: the cell data that the groups are made of; names: of the groups, by kind of cell, to which a tag is added
    where they end in a colon."""
    source, target, lines = run(name)
    before, after = meshio.read(source), meshio.read(target)

    points = np.zeros((len(before.points), 3))
    points[:, :before.points.shape[1]] = before.points
    read = [line.split() for line in lines]
    single = before.points.dtype == np.float32 or before.points.dtype == np.dtype(">f4")
    found = np.array([[float(x) for x in r[1:]] for r in read if r and r[0] == "point"])
    same(points, found.astype(np.float32) if single else found, name + ": points")

    cells = [[NAMES[block.type]] + [int(v) for v in c] for block in before.cells for c in block.data]
    mine = [[r[1]] + [int(v) for v in r[2:]] for r in read if r and r[0] == "cell"]
    for c in cells:
        if c[0] == "wedge": # meshio has them as gmsh does; in SU2 it writes them so, too, and they are read turned over
            c[1:] = [c[1], c[3], c[2], c[4], c[6], c[5]]
    if name.endswith(".su2"): # meshio sorts by kind
        cells.sort()
        mine.sort()
    same(cells, mine, name + ": cells")

    if key:
        groups = {}
        for block, tags in zip(before.cells, before.cell_data[key]):
            for c, tag in zip(block.data, tags):
                group = names[block.type] + (str(tag) if names[block.type].endswith(":") else "")
                groups.setdefault(group, set()).update(int(v) for v in c)
        mine = {r[1]: [int(v) for v in r[3:]] for r in read if r and r[0] == "group"}
        for group, vertices in groups.items():
            same(sorted(vertices), mine.get(group), name + ": group " + group)

    for x, y in zip(before.cells, after.cells):
        same(x.type, y.type, name + ": kinds")
        same(x.data, y.data, name + ": cells")
    same(len(before.cells), len(after.cells), name + ": blocks")
    same_data(before.cell_data, after.cell_data, name + ": cell data")
    same_data(before.point_data, after.point_data, name + ": point data")
    same(sorted(before.field_data), sorted(after.field_data), name + ": names")
    for group in before.field_data:
        same(before.field_data[group], after.field_data[group], name + ": names")

    expected = found.copy()
    x, y, z = found[::2].T
    planar_file = before.points.shape[1] == 2
    expected[::2] = np.stack([2 * x + y, y - 3 * x, z] if planar_file else [2 * x + y, y - 3 * z, z + 0.5], 1)
    expected = expected[:, :after.points.shape[1]]
    same(expected.astype(after.points.dtype), after.points, name + ": changed points")
    print(name, len(points), "points", len(cells), "cells")


def write(name, mesh, **options):
    meshio.write(os.path.join(folder, name), mesh, **options)


def appended(name, points, cells, order, header):
    """A VTU file with raw appended data, which meshio reads but does not write."""
    byte = ">" if order == "BigEndian" else "<"
    numbers = [10, 12, 13, 14, 5]
    kinds = ["tetra", "hexahedron", "wedge", "pyramid", "triangle"]
    vtk_order = {"wedge": [0, 2, 1, 3, 5, 4]}
    corners = [c[vtk_order.get(kind, list(range(len(c))))] for kind, block in cells for c in block]
    types = [numbers[kinds.index(kind)] for kind, block in cells for c in block]
    arrays = [("Points", "Float64", 'NumberOfComponents="3" ', points.ravel().astype("f8")),
              ("connectivity", "Int64", "", np.concatenate(corners).astype("i8")),
              ("offsets", "Int64", "", np.cumsum([len(c) for c in corners]).astype("i8")),
              ("types", "UInt8", "", np.array(types, "u1")),
              ("part", "Int32", "", (1 + np.arange(len(types)) % 2).astype("i4"))]
    data, tags = b"", {}
    for array, kind, more, values in arrays:
        raw = values.astype(values.dtype.newbyteorder(byte)).tobytes()
        tags[array] = f'<DataArray type="{kind}" Name="{array}" {more}format="appended" offset="{len(data)}"/>\n'
        data += np.array(len(raw), byte + ("u8" if header == "UInt64" else "u4")).tobytes() + raw
    text = (f'<VTKFile type="UnstructuredGrid" version="1.0" byte_order="{order}" header_type="{header}">\n'
            f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(types)}">\n'
            f'<Points>{tags["Points"]}</Points>\n<Cells>{tags["connectivity"]}{tags["offsets"]}{tags["types"]}</Cells>\n'
            f'<CellData>{tags["part"]}</CellData></Piece></UnstructuredGrid>\n<AppendedData encoding="raw">\n_')
    with open(os.path.join(folder, name), "wb") as out:
        out.write(text.encode() + data + b"\n</AppendedData>\n</VTKFile>\n")


MEDIT = {"triangle": "triangles:", "tetra": "tetrahedra:", "hexahedron": "hexahedra:", "wedge": "prisms:",
         "pyramid": "pyramids:"}
GMSH = {kind: f"physical:{dimension}:" for kind, dimension in DIMENSIONS.items()}
VTK = dict.fromkeys(NAMES, "part:")

for shape, make in (("tets", tetrahedra), ("mixed", mixed)):
    points, cells = make()
    write(shape + ".mesh", meshio.Mesh(points, cells, cell_data=tags_of(cells, ["medit:ref"])))
    check(shape + ".mesh", "medit:ref", MEDIT)
    write(shape + "-single.mesh", meshio.Mesh(points.astype(np.float32), cells))
    check(shape + "-single.mesh")

    tags = tags_of(cells, ["gmsh:physical", "gmsh:geometrical"])
    for binary in (False, True):
        kind = "binary" if binary else "text"
        write(f"{shape}-22-{kind}.msh", meshio.Mesh(points, cells, cell_data=tags), file_format="gmsh22", binary=binary)
        check(f"{shape}-22-{kind}.msh", "gmsh:physical", GMSH)
        dim_tags = np.zeros((len(points), 2), int)
        dim_tags[:, 0] = 3
        dim_tags[:, 1] = 31
        blocks = [("tetra", cells[-1][1])]
        mesh = meshio.Mesh(points, blocks, point_data={"gmsh:dim_tags": dim_tags},
                           cell_data={"gmsh:physical": [np.full(len(blocks[0][1]), 4)],
                                      "gmsh:geometrical": [np.full(len(blocks[0][1]), 31)]},
                           field_data={"body": np.array([4, 3])})
        write(f"{shape}-41-{kind}.msh", mesh, file_format="gmsh", binary=binary)
        check(f"{shape}-41-{kind}.msh", "gmsh:physical", {"tetra": "body"})

        data = tags_of(cells, ["part"])
        for version in ("4.2", "5.1"):
            for real in (np.float64, np.float32):
                name = f"{shape}-{version}-{kind}-{np.dtype(real).name}.vtk"
                mesh = meshio.Mesh(points.astype(real), cells, cell_data=data,
                                   point_data={"side": np.arange(len(points)) % 2, "height": points[:, 2]})
                write(name, mesh, file_format="vtk42" if version == "4.2" else "vtk51", binary=binary)
                check(name, "part", VTK)
    write(shape + ".vtu", meshio.Mesh(points, cells, cell_data=data), binary=False)
    check(shape + ".vtu", "part", VTK)
    for order in ("LittleEndian", "BigEndian"):
        for header in ("UInt32", "UInt64"):
            appended(f"{shape}-{order}-{header}.vtu", points, cells, order, header)
            check(f"{shape}-{order}-{header}.vtu", "part", VTK)
    write(shape + ".su2", meshio.Mesh(points, cells[-1:] if shape == "tets" else cells))
    check(shape + ".su2")

points, cells = tetrahedra()
write("tets.node", meshio.Mesh(points, cells[-1:], cell_data={"tetgen:ref": tags_of(cells[-1:], ["r"])["r"]}))
check("tets.node", "tetgen:ref", {"tetra": "tetrahedra:"})
points, cells = planar()
write("planar.su2", meshio.Mesh(points, cells))
check("planar.su2")
write("planar.mesh", meshio.Mesh(points, cells))
check("planar.mesh")
