# SPDX-License-Identifier: MIT
"""Files of meshes as other programs write and read them: by their specifications, not by code of the program.

A kind of volume file writes `files(points, cells, dimension)`, contents by extension, and reads points
and cells with `read(contents)`. Cells are tetrahedra, or triangles of the plane. `rounding`: to what it can hold;
`ambiguous`: text of single precision, whose digits some programs read as doubles."""
import re
import struct


def single(x):
    """The float that is nearest to a number, as a float of Python."""
    return struct.unpack("<f", struct.pack("<f", x))[0]


def same(x):
    return x


def numbers(text, kind=float):
    return [kind(word) for word in text.split()]


def rows(values, n):
    return [tuple(values[i:i + n]) for i in range(0, len(values), n)]


def rounded(points, rounding):
    return [tuple(rounding(x) for x in p) for p in points]


def in_space(points):
    return [(*p, 0.0)[:3] for p in points]


def lines(values):
    return "".join(" ".join(repr(x) for x in row) + "\n" for row in values)


class Medit:
    extension, rounding, ambiguous = ".mesh", staticmethod(same), False

    def files(self, points, cells, dimension):
        name = "Tetrahedra" if dimension == 3 else "Triangles"
        return {".mesh": (f"MeshVersionFormatted 2\nDimension {dimension}\nVertices\n{len(points)}\n"
                          + lines((*p, 0) for p in points) + f"{name}\n{len(cells)}\n"
                          + lines((*(v + 1 for v in c), 1) for c in cells) + "End\n").encode()}

    def read(self, contents):
        words = contents[".mesh"].decode().split()
        dimension = int(words[words.index("Dimension") + 1])

        def section(name, width):
            at = words.index(name)
            n = int(words[at + 1])
            return rows(words[at + 2:at + 2 + n * width], width)
        points = [tuple(map(float, row[:dimension])) for row in section("Vertices", dimension + 1)]
        name = "Tetrahedra" if dimension == 3 else "Triangles"
        return points, [tuple(int(v) - 1 for v in row[:-1]) for row in section(name, dimension + 2)]


class Su2:
    extension, rounding, ambiguous = ".su2", staticmethod(same), False

    def files(self, points, cells, dimension):
        kind = 10 if dimension == 3 else 5
        return {".su2": (f"NDIME= {dimension}\nNELEM= {len(cells)}\n" + lines((kind, *c, i) for i, c in enumerate(cells))
                         + f"NPOIN= {len(points)}\n" + lines((*p, i) for i, p in enumerate(points))
                         + "NMARK= 0\n").encode()}

    def read(self, contents):
        text = contents[".su2"].decode().splitlines()
        dimension = int(text[0].split("=")[1])

        def section(name):
            at = next(i for i, line in enumerate(text) if line.startswith(name))
            return text[at + 1:at + 1 + int(text[at].split("=")[1])]
        return ([tuple(map(float, line.split()[:dimension])) for line in section("NPOIN")],
                [tuple(map(int, line.split()[1:dimension + 2])) for line in section("NELEM")])


class Tetgen:
    extension, rounding, ambiguous = ".node", staticmethod(same), False

    def files(self, points, cells, dimension):
        return {".node": (f"{len(points)} {dimension} 0 0\n" + lines((i, *p) for i, p in enumerate(points))).encode(),
                ".ele": (f"{len(cells)} {dimension + 1} 0\n" + lines((i, *c) for i, c in enumerate(cells))).encode()}

    def read(self, contents):
        node, ele = (contents[e].decode().splitlines() for e in (".node", ".ele"))
        return ([tuple(map(float, line.split()[1:])) for line in node[1:]],
                [tuple(map(int, line.split()[1:])) for line in ele[1:]])


class Gmsh:
    """Vertices and cells are numbered from 1, in order."""
    extension, rounding, ambiguous = ".msh", staticmethod(same), False

    def __init__(self, version, binary):
        self.version, self.binary = version, binary

    def numbers(self, code, *values):
        if self.binary:
            return struct.pack("<" + code, *values)
        return (" ".join(map(repr, values)) + "\n").encode()

    def files(self, points, cells, dimension):
        n, m, kind = len(points), len(cells), 4 if dimension == 3 else 2
        corners = dimension + 1
        end = b"\n" if self.binary else b""
        out = f"$MeshFormat\n{self.version} {int(self.binary)} 8\n".encode()
        out += (struct.pack("<i", 1) + b"\n" if self.binary else b"") + b"$EndMeshFormat\n$Nodes\n"
        points = in_space(points)
        if self.version == "2.2":
            out += f"{n}\n".encode() + b"".join(self.numbers("iddd", i + 1, *p) for i, p in enumerate(points))
            out += end + f"$EndNodes\n$Elements\n{m}\n".encode()
            for i, c in enumerate(cells):
                c = [v + 1 for v in c]
                out += (self.numbers(f"{6 + corners}i", kind, 1, 2, i + 1, 1, 1, *c) if self.binary
                        else self.numbers("", i + 1, kind, 2, 1, 1, *c))
        else:
            out += self.numbers("4Q", 1, n, 1, n) + self.numbers("3iQ", dimension, 1, 0, n)
            out += b"".join(self.numbers("Q", i + 1) for i in range(n))
            out += b"".join(self.numbers("3d", *p) for p in points) + end + b"$EndNodes\n$Elements\n"
            out += self.numbers("4Q", 1, m, 1, m) + self.numbers("3iQ", dimension, 1, kind, m)
            out += b"".join(self.numbers(f"{corners + 1}Q", i + 1, *(v + 1 for v in c)) for i, c in enumerate(cells))
        return {".msh": out + end + b"$EndElements\n"}

    def read(self, contents):
        data = contents[".msh"]
        nodes = data[data.index(b"$Nodes\n") + 7:data.index(b"$EndNodes")]
        elements = data[data.index(b"$Elements\n") + 10:data.index(b"$EndElements")]
        if self.version == "2.2":
            n, _, nodes = nodes.partition(b"\n")
            m, _, elements = elements.partition(b"\n")
            n, m = int(n), int(m)
            if self.binary:
                points = [struct.unpack_from("<iddd", nodes, 28 * i)[1:] for i in range(n)]
                width = (len(elements) - 1) // m
                cells = [struct.unpack_from(f"<{width // 4}i", elements, width * i)[6:] for i in range(m)]
            else:
                points = [tuple(map(float, line.split()[1:])) for line in nodes.splitlines()]
                cells = [tuple(map(int, line.split()[5:])) for line in elements.splitlines()]
        elif self.binary:
            n = struct.unpack_from("<Q", nodes, 8)[0]
            m = struct.unpack_from("<Q", elements, 8)[0]
            points = rows(struct.unpack_from(f"<{3 * n}d", nodes, 52 + 8 * n), 3)
            width = (len(elements) - 1 - 52) // (8 * m)
            cells = [c[1:] for c in rows(struct.unpack_from(f"<{width * m}Q", elements, 52), width)]
        else:
            nodes, elements = nodes.decode().splitlines(), elements.decode().splitlines()
            n = int(nodes[0].split()[1])
            points = [tuple(map(float, line.split())) for line in nodes[2 + n:]]
            cells = [tuple(map(int, line.split()[1:])) for line in elements[2:]]
        return points, [tuple(v - 1 for v in c) for c in cells]


class Vtk:
    """A legacy file of version 3."""
    extension = ".vtk"

    def __init__(self, kind, binary):
        self.kind, self.binary = kind, binary
        self.rounding = single if kind == "float" else same
        self.ambiguous = kind == "float" and not binary

    def block(self, code, values):
        return (struct.pack(f">{len(values)}{code}", *values) if self.binary
                else " ".join(map(repr, values)).encode()) + b"\n"

    def files(self, points, cells, dimension):
        corners = dimension + 1
        out = f"# vtk DataFile Version 3.0\nmesh\n{'BINARY' if self.binary else 'ASCII'}\n".encode()
        out += f"DATASET UNSTRUCTURED_GRID\nPOINTS {len(points)} {self.kind}\n".encode()
        out += self.block(self.kind[0], [x for p in in_space(points) for x in p])
        out += f"CELLS {len(cells)} {len(cells) * (corners + 1)}\n".encode()
        out += self.block("i", [v for c in cells for v in (corners, *c)])
        out += f"CELL_TYPES {len(cells)}\n".encode() + self.block("i", [10 if dimension == 3 else 5] * len(cells))
        return {".vtk": out}

    def read(self, contents):
        data = contents[".vtk"]

        def block(name, code, size):
            found = re.search(rb"^" + name + rb" (\d+) ?(\w*)\n", data, re.M)
            n = int(found[1]) * 3 if name == b"POINTS" else int(found[2])
            if self.binary:
                return struct.unpack_from(f">{n}{code}", data, found.end())
            return numbers(data[found.end():].decode().split("CELL")[0], float if size == 8 or code == "f" else int)
        points = rows(block(b"POINTS", self.kind[0], 4 if self.kind == "float" else 8), 3)
        flat = block(b"CELLS", "i", 4)
        return rounded(points, self.rounding), [c[1:] for c in rows(flat, flat[0] + 1)]


class Vtu:
    def __init__(self, kind, raw):
        self.kind, self.raw = kind, raw
        self.rounding = single if kind == "Float32" else same
        self.ambiguous = kind == "Float32" and not raw
    extension = ".vtu"

    def files(self, points, cells, dimension):
        arrays = {"Points": (self.kind, "f" if self.kind == "Float32" else "d", [x for p in in_space(points) for x in p]),
                  "connectivity": ("Int64", "q", [v for c in cells for v in c]),
                  "offsets": ("Int64", "q", [(dimension + 1) * (i + 1) for i in range(len(cells))]),
                  "types": ("UInt8", "B", [10 if dimension == 3 else 5] * len(cells))}
        appended, tags = b"", {}
        for name, (kind, code, values) in arrays.items():
            head = f'<DataArray type="{kind}" Name="{name}"' + (' NumberOfComponents="3"' if name == "Points" else "")
            if self.raw:
                tags[name] = f'{head} format="appended" offset="{len(appended)}"/>\n'
                body = struct.pack(f"<{len(values)}{code}", *values)
                appended += struct.pack("<I", len(body)) + body
            else:
                tags[name] = f'{head} format="ascii">\n{" ".join(map(repr, values))}\n</DataArray>\n'
        out = ('<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n'
               f'<UnstructuredGrid>\n<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n'
               f'<Points>\n{tags["Points"]}</Points>\n<Cells>\n{tags["connectivity"]}{tags["offsets"]}{tags["types"]}'
               '</Cells>\n</Piece>\n</UnstructuredGrid>\n').encode()
        if self.raw:
            out += b'<AppendedData encoding="raw">\n_' + appended + b"\n</AppendedData>\n"
        return {".vtu": out + b"</VTKFile>\n"}

    def read(self, contents):
        data = contents[".vtu"]

        def array(name, code):
            tag = re.search(rb'<DataArray [^>]*Name="' + name + rb'"[^>]*>', data)
            if not self.raw:
                return numbers(data[tag.end():].split(b"<")[0].decode(), int if code == "q" else float)
            begin = data.index(b"_", data.index(b"<AppendedData")) + 1
            begin += int(re.search(rb'offset="(\d+)"', tag[0])[1])
            size = struct.unpack_from("<I", data, begin)[0]
            return struct.unpack_from(f"<{size // struct.calcsize('<' + code)}{code}", data, begin + 4)
        points = rows(array(b"Points", "f" if self.kind == "Float32" else "d"), 3)
        ends = array(b"offsets", "q")
        return rounded(points, self.rounding), rows(array(b"connectivity", "q"), ends[0])


VOLUMES = {"medit": Medit(), "su2": Su2(), "tetgen": Tetgen(),
           **{f"gmsh {v} {'binary' if b else 'text'}": Gmsh(v, b) for v in ("2.2", "4.1") for b in (False, True)},
           **{f"vtk {'binary' if b else 'text'} {k}": Vtk(k, b) for k in ("float", "double") for b in (False, True)},
           **{f"vtu {'raw' if r else 'text'} {k}": Vtu(k, r) for k in ("Float32", "Float64") for r in (False, True)}}


def obj(points, faces):
    return "".join("v %r %r %r\n" % p for p in points) + "".join("f %d %d %d\n" % tuple(v + 1 for v in f) for f in faces)


def off(points, faces):
    return f"OFF\n{len(points)} {len(faces)} 0\n" + lines(points) + lines((3, *f) for f in faces)


def ply(points, faces, encoding="ascii", kind="double"):
    out = (f"ply\nformat {encoding} 1.0\nelement vertex {len(points)}\n" + "".join(f"property {kind} {c}\n" for c in "xyz")
           + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n").encode()
    if encoding == "ascii":
        return out + (lines(points) + lines((3, *f) for f in faces)).encode()
    order = "<" if encoding == "binary_little_endian" else ">"
    return (out + b"".join(struct.pack(f"{order}3{kind[0]}", *p) for p in points)
            + b"".join(struct.pack(f"{order}B3i", 3, *f) for f in faces))


def stl(points, faces, binary):
    if binary:
        return bytes(80) + struct.pack("<I", len(faces)) + b"".join(
            struct.pack("<12fH", 0, 0, 0, *(x for v in f for x in points[v]), 0) for f in faces)
    return "solid s\n" + "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex %r %r %r\n" % points[v] for v in f)
                                 + "endloop\nendfacet\n" for f in faces) + "endsolid s\n"


def read_obj(text):
    """Points, texture coordinates, and faces as corners (vertex, texture coordinate or none)."""
    points, coordinates, faces = [], [], []
    for line in text.decode().splitlines():
        key, *words = line.split() or [""]
        if key == "v":
            points.append(tuple(map(float, words[:3])))
        elif key == "vt":
            coordinates.append(tuple(map(float, words[:2])))
        elif key == "f":
            corners = [(w.split("/") + [""])[:2] for w in words]
            faces.append([(int(v) - 1, int(t) - 1 if t else None) for v, t in corners])
    return points, coordinates, faces
