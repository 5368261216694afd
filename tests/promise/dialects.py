# SPDX-License-Identifier: MIT
"""dialects.py PROGRAM FOLDER [CASE...] [--count=N] [--seed=N]
The same mesh as other programs would spell it: line ends, blanks, comments, orders, letter case, encodings, counts, spellings of
numbers. Each spelling must be read as the same mesh, or be refused by name where the format has no such thing.

Each format is tried with each of its habits alone, then with N random sets of them."""
import json
import random
import sys

from program import main

OPTIONS = {"count": 6, "seed": 1}
for word in [w for w in sys.argv if w.startswith("--")]:
    name, _, value = word[2:].partition("=")
    OPTIONS[name] = int(value)
    sys.argv.remove(word)

# A hexahedron with a wedge on a side, a pyramid on top and a tetrahedron beside it, in VTK's order, and a triangle and a quad of
# their boundary; coordinates that every spelling can hold.
POINTS = [(0, 0, 0), (1.25, 0, 0), (1, 1, 0), (0, 1, 0.125), (0, 0, 1), (1, 0, 1), (1, 1.5, 1), (0, 1, 1),
          (2, 0.5, 0), (2, 0.5, 1), (0.5, 0.5, 2), (1.5, 0.5, 2)]
CELLS = [("hexahedron", (0, 1, 2, 3, 4, 5, 6, 7)), ("wedge", (1, 2, 8, 5, 6, 9)), ("pyramid", (4, 5, 6, 7, 10)),
         ("tetrahedron", (5, 9, 6, 11)), ("triangle", (4, 5, 10)), ("quad", (0, 1, 2, 3))]
LABELS = [1, 1, 2, 3, 5, 6]  # of the cells
TETRAHEDRA = [(0, 1, 3, 4), (1, 2, 3, 6), (1, 6, 4, 5), (3, 4, 6, 7), (1, 3, 4, 6), (5, 9, 6, 11)]
SIDE = 4  # of a surface
SURFACE = [(i / 4, j / 4, (i * j) % 3 / 8) for j in range(SIDE + 1) for i in range(SIDE + 1)]
FACES = [f for j in range(SIDE) for i in range(SIDE) for a in [j * (SIDE + 1) + i]
         for f in ((a, a + 1, a + SIDE + 2), (a, a + SIDE + 2, a + SIDE + 1))]
COUNTER_CLOCKWISE_WEDGE = (0, 2, 1, 3, 5, 4)  # of formats whose wedges have their triangles the other way around

EVERYWHERE = ["crlf", "cr", "mixed ends", "no end", "many ends", "indent", "trailing blanks", "tabs", "byte order mark",
              "fortran", "exponents", "plus", "bare points", "long numbers", "real integers"]


class Text:
    """A text in some habits. `comment`: what starts one."""

    def __init__(self, dice, habits, comment=None):
        self.dice, self.habits, self.comment, self.out = dice, set(habits), comment, []

    def has(self, habit):
        return habit in self.habits

    def real(self, x):
        x = float(x)
        if self.has("fortran"):
            return f"{x:.6E}".replace("E", self.dice.choice("Dd"))
        if self.has("exponents"):
            return self.dice.choice([f"{x:.6e}", f"{x:.6E}", f"{x * 1000:.6f}e-3", f"{x / 10:.7f}E1", f"{x:.6e}".replace("e+0", "e")])
        if self.has("plus") and x >= 0:
            return f"+{x!r}"
        if self.has("bare points"):
            return repr(x).removesuffix("0") if x == int(x) else repr(x).removeprefix("0")
        if self.has("long numbers"):
            return f"{x:.40f}"
        if self.has("real integers"):
            return repr(int(x)) if x == int(x) else repr(x)
        return repr(x)

    def word(self, x):
        return self.real(x) if isinstance(x, float) else str(x)

    def key(self, word):
        """A keyword."""
        return word.lower() if self.has("small letters") else word.upper() if self.has("capitals") else word

    def row(self, *values, free=True):
        """A line of words. free: comments and empty lines may stand before it, and a comment behind."""
        gap = "\t" if self.has("tabs") else "   " if self.has("indent") else " "
        line = gap.join(self.word(v) for v in values)
        if free and self.has("blank lines") and self.dice.random() < 0.4:
            self.out += [self.dice.choice(["", "  ", "\t"])]
        if free and self.has("comments") and self.comment and self.dice.random() < 0.4:
            self.out += [f"{self.comment} a comment 1 2 3"]
        if free and self.has("comments behind") and self.comment and self.dice.random() < 0.4:
            line += f" {self.comment} 7 of them"
        if self.has("indent"):
            line = self.dice.choice(["  ", "\t"]) + line
        if self.has("trailing blanks") and not line.endswith("\\"):
            line += self.dice.choice([" ", "\t", "   "])
        self.out.append(line)

    def bytes(self):
        ends = ["\r\n"] if self.has("crlf") else ["\r"] if self.has("cr") else ["\n"]
        if self.has("mixed ends"):
            ends = ["\r\n", "\n"]
        text = "".join(line + self.dice.choice(ends) for line in self.out)
        if self.has("no end"):
            text = text.rstrip("\r\n")
        if self.has("many ends"):
            text += 3 * ends[0]
        head = b"\xef\xbb\xbf" if self.has("byte order mark") else b""
        return head + text.encode("latin-1" if self.has("latin names") else "utf-8")


def floats(p):
    return [float(x) for x in p]


def turned(kind, corners):
    """The corners of a cell in the order of MEDIT and gmsh."""
    return [corners[i] for i in COUNTER_CLOCKWISE_WEDGE] if kind == "wedge" else list(corners)


def medit(t):
    def section(word, items):
        t.row(t.key(word), len(items)) if t.has("counts beside") else (t.row(t.key(word)), t.row(len(items)))
        for item in items:
            t.row(*item)
    version = 1 if t.has("version 1") else 3 if t.has("version 3") else 2
    t.row(t.key("MeshVersionFormatted"), version) if not t.has("counts below") else (t.row(t.key("MeshVersionFormatted")), t.row(version))
    t.row(t.key("Dimension"), 3) if not t.has("counts below") else (t.row(t.key("Dimension")), t.row(3))
    names = {"hexahedron": "Hexahedra", "wedge": "Prisms", "pyramid": "Pyramids", "tetrahedron": "Tetrahedra",
             "triangle": "Triangles", "quad": "Quadrilaterals"}
    sections = [("Vertices", [(*floats(p), 0) for p in POINTS])]
    for kind, name in names.items():
        if t.has("other names"):
            name = {"Hexahedra": "Hexaedra", "Prisms": "Pentahedra"}.get(name, name)
        sections.append((name, [(*(v + 1 for v in turned(k, c)), label) for (k, c), label in zip(CELLS, LABELS) if k == kind]))
    if t.has("other sections"):
        sections += [("Normals", [floats((0, 0, 1))]), ("NormalAtVertices", [(1, 1)]), ("RequiredTriangles", [(1,)]), ("Ridges", [])]
    if t.has("zero counts"):
        sections += [("Edges", []), ("Corners", [])]
    if t.has("order of sections"):
        t.dice.shuffle(sections)
    for name, items in sections:
        section(name, items)
    if not t.has("no End"):
        t.row(t.key("End"))
    if t.has("text behind"):
        t.row("Vertices"), t.row("nonsense")
    return {".mesh": t.bytes()}


def gmsh(version):
    types = {"hexahedron": 5, "wedge": 6, "pyramid": 7, "tetrahedron": 4, "triangle": 2, "quad": 3}

    def file(t):
        def names():
            t.row("$PhysicalNames", free=False)
            name = "Körper ß" if t.has("latin names") else "body"
            t.row(2, free=False), t.row(3, 1, f'"{name}"', free=False), t.row(2, 5, '"side of it"', free=False)
            t.row("$EndPhysicalNames", free=False)

        def nodes():
            t.row("$Nodes")
            n = len(POINTS)
            if version == "2.2":
                t.row(n, free=False)
                for i, p in ordered(list(enumerate(POINTS))):
                    t.row(number(i), *floats(p), free=False)
            else:
                t.row(2, n, number(0), number(n - 1), free=False)
                for block in (range(4), range(4, n)):
                    parametric = t.has("parametric") and block[0] == 0
                    t.row(2 if block[0] == 0 else 3, 1, int(parametric), len(block), free=False)
                    for i in block:
                        t.row(number(i), free=False)
                    for i in block:
                        t.row(*floats(POINTS[i]), *([0.5, 0.25] if parametric else []), free=False)
            t.row("$EndNodes", free=False)

        def elements():
            t.row("$Elements")
            m = len(CELLS)
            if version == "2.2":
                t.row(m, free=False)
                for e, ((kind, c), label) in ordered(list(enumerate(zip(CELLS, LABELS)))):
                    tags = [label, label, 1, 1] if t.has("partition tags") else [label, label]
                    t.row(number(e), types[kind], len(tags), *tags, *(number(v) for v in turned(kind, c)), free=False)
            else:
                t.row(m, m, number(0), number(m - 1), free=False)
                for e, ((kind, c), label) in enumerate(zip(CELLS, LABELS)):
                    t.row(2 if kind in ("triangle", "quad") else 3, label, types[kind], 1, free=False)
                    t.row(number(e), *(number(v) for v in turned(kind, c)), free=False)
            t.row("$EndElements", free=False)

        def entities():
            t.row("$Entities", free=False), t.row(0, 0, 3, 3, free=False)
            for tag, group in ((1, 7), (5, 5), (6, 6)):
                t.row(tag, *floats((0, 0, 0, 2, 2, 2)), 1, group, 0, free=False)
            for tag in (1, 2, 3):
                t.row(tag, *floats((0, 0, 0, 2, 2, 2)), 1, tag, 0, free=False)
            t.row("$EndEntities", free=False)

        def number(i):
            return 3 * i + 100 if t.has("gaps") else i + 1

        def ordered(items):
            if t.has("order of items"):
                t.dice.shuffle(items)
            return items

        t.row("$MeshFormat", free=False), t.row(version if not t.has("short version") else version[0], 0, 8, free=False)
        t.row("$EndMeshFormat", free=False)
        parts = [names] + ([entities] if version == "4.1" else []) + [nodes, elements]
        if t.has("order of sections"):
            t.dice.shuffle(parts)
        if t.has("other sections"):
            t.row("$Comments", free=False), t.row("any text, even $ signs", free=False), t.row("$EndComments", free=False)
        for part in parts:
            part()
        if t.has("other sections"):
            t.row("$NodeData", free=False), t.row(1, free=False), t.row('"a view"', free=False), t.row(1, free=False), t.row(0.0, free=False)
            t.row(3, free=False), t.row(0, free=False), t.row(1, free=False), t.row(0, free=False), t.row("$EndNodeData", free=False)
        return {".msh": t.bytes()}
    return file


def vtk(version):
    types = {"hexahedron": 12, "wedge": 13, "pyramid": 14, "tetrahedron": 10, "triangle": 5, "quad": 9}

    def file(t):
        t.row(f"# vtk DataFile Version {version}", free=False)
        t.row("Körper" if t.has("latin names") else "" if t.has("no title") else "a title: POINTS 3", free=False)
        t.row(t.key("ASCII"), free=False), t.row(t.key("DATASET"), t.key("UNSTRUCTURED_GRID"))

        def metadata():
            if t.has("metadata"):
                t.row("METADATA"), t.row("INFORMATION 1", free=False), t.row("NAME L2_NORM_RANGE LOCATION vtkDataArray", free=False)
                t.row("DATA 2 0 1", free=False), t.out.append("")

        def values(items, width):
            width = 1 if t.has("one a line") else 9 if t.has("nine a line") else width
            for k in range(0, len(items), width):
                t.row(*items[k:k + width], free=False)

        def points():
            t.row(t.key("POINTS"), len(POINTS), t.key("double"))
            values([float(x) for p in POINTS for x in p], 3), metadata()

        def cells():
            if version == "5.1":
                t.row(t.key("CELLS"), len(CELLS) + 1, sum(len(c) for _, c in CELLS)), t.row(t.key("OFFSETS"), "vtktypeint64", free=False)
                values([sum(len(c) for _, c in CELLS[:k]) for k in range(len(CELLS) + 1)], 9)
                t.row(t.key("CONNECTIVITY"), "vtktypeint64", free=False), values([v for _, c in CELLS for v in c], 8)
            else:
                t.row(t.key("CELLS"), len(CELLS), sum(len(c) + 1 for _, c in CELLS))
                for _, c in CELLS:
                    t.row(len(c), *c, free=False)

        def kinds():
            t.row(t.key("CELL_TYPES"), len(CELLS)), values([types[k] for k, _ in CELLS], 1)

        parts = [points, cells, kinds]
        if t.has("order of sections"):
            t.dice.shuffle(parts)
        if t.has("field before"):
            t.row(t.key("FIELD"), "FieldData", 2), t.row("TIME", 1, 1, "double"), t.row(0.5), t.row("CYCLE", 1, 1, "int"), t.row(3)
        if t.has("strings"):
            t.row(t.key("FIELD"), "FieldData", 2), t.row("names", 1, 2, "string"), t.row("two%20words", free=False), t.row(free=False)
            t.row("flags", 1, 3, "bit"), t.row(1, 0, 1)
        for part in parts:
            part()
        t.row(t.key("CELL_DATA"), len(CELLS))
        if t.has("field"):
            t.row(t.key("FIELD"), "FieldData", 1), t.row("part", 1, len(CELLS), "int", free=False), values(LABELS, 6), metadata()
        else:
            t.row(t.key("SCALARS"), "part", t.key("int"), *([] if t.has("no components") else [1])), t.row(t.key("LOOKUP_TABLE"), "default", free=False)
            values(LABELS, 6)
        return {".vtk": t.bytes()}
    return file


def tetgen(t):
    base = 0 if t.has("from 0") else 1
    if t.has("short counts"):
        t.row(len(POINTS), 3)
    else:
        t.row(len(POINTS), 3, 1 if t.has("attributes") else 0, 0 if t.has("no markers") else 1)
    for i, p in enumerate(POINTS):
        t.row(i + base, *floats(p), *([0.75] if t.has("attributes") and not t.has("short counts") else []),
              *([] if t.has("no markers") or t.has("short counts") else [0.0 if t.has("real markers") else 0]))
    node = t.bytes()
    t.out = []
    t.row(len(TETRAHEDRA), 4, *([] if t.has("no labels") else [1]))
    for i, c in enumerate(TETRAHEDRA):
        t.row(i + base, *(v + base for v in c), *([] if t.has("no labels") else [float(1 + i % 2) if t.has("real markers") else 1 + i % 2]))
    ele = t.bytes()
    t.out = []
    t.row(1, 1), t.row(base, base, 1 + base, 3 + base, -1 if t.has("negative markers") else 4)
    return {".node": node, ".ele": ele, ".face": t.bytes()}


def su2(t):
    types = {"hexahedron": 12, "wedge": 13, "pyramid": 14, "tetrahedron": 10, "triangle": 5, "quad": 9}
    volume = [(k, c) for k, c in CELLS if types[k] >= 10]

    def key(name, *values):
        if t.has("blanks around signs"):
            t.row(f"{t.key(name)} = ", *values)
        elif t.has("no blanks around signs"):
            t.row(f"{t.key(name)}={values[0]}", *values[1:])
        else:
            t.row(f"{t.key(name)}=", *values)

    def last(i):
        return [] if t.has("no numbers behind") else [i]

    def elements():
        key("NELEM", len(volume))
        for i, (k, c) in enumerate(volume):
            t.row(types[k], *c, *last(i))

    def points():
        key("NPOIN", len(POINTS), *([len(POINTS)] if t.has("two counts") else []))
        for i, p in enumerate(POINTS):
            t.row(*floats(p), *last(i))

    def markers():
        key("NMARK", 2)
        for tag, (k, c) in zip(("lower side" if t.has("blank in a name") else "lower", "UPPER"), CELLS[4:]):
            key("MARKER_TAG", tag), key("MARKER_ELEMS", 1)
            t.row(types[k], *c, *(last(0) if t.has("numbers of faces") else []))

    parts = [lambda: key("NDIME", 3), elements, points, markers]
    if t.has("order of sections"):
        t.dice.shuffle(parts)
    for part in parts:
        part()
    return {".su2": t.bytes()}


def vtu(t):
    types = {"hexahedron": 12, "wedge": 13, "pyramid": 14, "tetrahedron": 10, "triangle": 5, "quad": 9}
    quote = "'" if t.has("single quotes") else '"'

    def tag(name, close="", **attributes):
        items = list(attributes.items())
        if t.has("order of attributes"):
            t.dice.shuffle(items)
        gap = "\n   " if t.has("attributes a line") else " "
        t.row(f"<{name}" + "".join(f"{gap}{k}{' = ' if t.has('blanks around signs') else '='}{quote}{v}{quote}" for k, v in items)
              + f"{close}>", free=False)
        if t.has("comments"):
            t.row("<!-- a > comment -->", free=False)

    def array(kind, name, items, **more):
        t.row(f"<DataArray type={quote}{kind}{quote} Name={quote}{name}{quote}" + "".join(f" {k}={quote}{v}{quote}" for k, v in more.items())
              + f" format={quote}ascii{quote}>", free=False)
        width = 1 if t.has("one a line") else 7
        for k in range(0, len(items), width):
            t.row(*items[k:k + width], free=False)
        t.row("</DataArray>", free=False)

    if not t.has("no declaration"):
        t.row(f"<?xml version={quote}1.0{quote}?>", free=False)
    tag("VTKFile", type="UnstructuredGrid", version="0.1", byte_order="LittleEndian")
    tag("UnstructuredGrid")
    tag("Piece", NumberOfPoints=len(POINTS), NumberOfCells=len(CELLS))

    def points():
        tag("Points"), array("Float64", "Points", [float(x) for p in POINTS for x in p], NumberOfComponents=3), tag("/Points")

    def cells():
        tag("Cells"), array("Int32" if t.has("short integers") else "Int64", "connectivity", [v for _, c in CELLS for v in c])
        array("Int64", "offsets", [sum(len(c) for _, c in CELLS[:k + 1]) for k in range(len(CELLS))])
        array("Int32" if t.has("short integers") else "UInt8", "types", [types[k] for k, _ in CELLS]), tag("/Cells")

    def data():
        tag("CellData", Scalars="part"), array("Int32", "part", LABELS), tag("/CellData")
        if t.has("empty data"):
            tag("PointData"), tag("/PointData")

    parts = [points, cells, data]
    if t.has("order of sections"):
        t.dice.shuffle(parts)
    for part in parts:
        part()
    for name in ("Piece", "UnstructuredGrid", "VTKFile"):
        tag("/" + name)
    return {".vtu": t.bytes()}


def obj(t):
    corner = [lambda v: f"{v + 1}"]
    if t.has("back from here"):
        corner = [lambda v: str(v - len(SURFACE))]
    if t.has("normals"):
        corner = [lambda v: f"{v + 1}//{1 + v % 2}"]
    if t.has("texture"):
        corner = [lambda v: f"{v + 1}/{v + 1}"]
    if t.has("normals") and t.has("texture"):
        corner = [lambda v: f"{v + 1}/{v + 1}/1"]

    def points():
        for p in SURFACE:
            if t.has("joined lines"):
                t.row("v", *floats(p[:2]), "\\", free=False), t.row(float(p[2]), free=False)
            else:
                t.row("v", *floats(p), *([1.0] if t.has("weights") else []), *([0.5, 0.25, 1.0] if t.has("colours") and not t.has("weights") else []))

    def others():
        if t.has("texture"):
            for i, p in enumerate(SURFACE):
                t.row("vt", *floats(p[:2]), *([0.0] if i % 2 else []))
        if t.has("normals"):
            t.row("vn", *floats((0, 0, 1))), t.row("vn", *floats((0, 1, 0)))

    def faces():
        for k, f in enumerate(FACES):
            if t.has("names") and k % 5 == 0:
                t.row(t.dice.choice(["g", "o", "usemtl", "s"]), "Fläche" if t.has("latin names") else "7")
            t.row("fo" if t.has("old faces") else "f", *(corner[0](v) for v in f))
            if t.has("lines and points") and k % 4 == 0:
                t.row("l", corner[0](f[0]).split("/")[0], corner[0](f[1]).split("/")[0]), t.row("p", corner[0](f[0]).split("/")[0])

    if t.has("names"):
        t.row("mtllib", "Körper.mtl" if t.has("latin names") else "a b.mtl")
    parts = [points, others, faces]
    if t.has("order of sections") and not t.has("back from here"):
        t.dice.shuffle(parts)
    for part in parts:
        part()
    if t.has("unknown statements"):
        t.row("cstype", "rat", "bspline"), t.row("bevel", "on"), t.row("shadow_obj", "x"), t.row("call", "other.obj")
    return {".obj": t.bytes()}


def off(t):
    kind = ("ST" if t.has("texture") else "") + ("C" if t.has("colours") else "") + ("N" if t.has("normals") else "") + "OFF"
    counts = [len(SURFACE), len(FACES)] + ([] if t.has("no count of edges") else [0])
    if t.has("no header") and kind == "OFF":
        t.row(*counts)
    elif t.has("counts beside"):
        t.row(t.key(kind), *counts)
    else:
        t.row(t.key(kind)), t.row(*counts)
    for p in SURFACE:
        extra = ([0.0, 0.0, 1.0] if t.has("normals") else []) + ([255, 0, 0, 255] if t.has("colours") else []) + ([0.5, 0.5] if t.has("texture") else [])
        t.row(*floats(p), *extra)
    for f in FACES:
        t.row(3, *f, *([] if not t.has("colours of faces") else t.dice.choice([[1.0, 0.5, 0.25], [255, 0, 0, 255], [3]])))
    return {".off": t.bytes()}


def ply(t):
    def points():
        for p in SURFACE:
            named = dict(zip("xyz", floats(p)), red=255, green=0, blue=9, alpha=255, quality=0.5, nx=0.0, ny=0.0, nz=1.0)
            t.row(*(named[c] for c in columns), free=False)

    def faces():
        for f in FACES:
            t.row(*([7] if t.has("extra columns") else []), 3, *f, *([0, 255] if t.has("extra columns") else []), free=False)

    columns = list("xyz") + ["red", "green", "blue", "alpha"] * t.has("colours") + ["quality"] * t.has("extra columns")
    columns += ["nx", "ny", "nz"] * t.has("normals")
    if t.has("order of columns"):
        t.dice.shuffle(columns)
    t.row("ply", free=False), t.row("format ascii 1.0", free=False)
    if t.has("comments"):
        t.row("comment made by ä, element vertex 3", free=False), t.row("obj_info any", free=False), t.row("comment", free=False)
    kinds = ("float64", "uint8", "int32") if t.has("numbered types") else ("double", "uchar", "int")
    parts = ["vertex", "face"]
    if t.has("order of sections"):
        parts.reverse()
    if t.has("other elements"):
        parts.insert(t.dice.randrange(3), "edge")
    for part in parts:
        if part == "vertex":
            t.row("element vertex", len(SURFACE), free=False)
            for c in columns:
                t.row("property", kinds[1] if c in ("red", "green", "blue", "alpha") else kinds[0], c, free=False)
        elif part == "face":
            t.row("element face", len(FACES), free=False)
            if t.has("extra columns"):
                t.row("property", kinds[1], "flags", free=False)
            t.row("property list", "int" if t.has("other types") else kinds[1], "uint" if t.has("other types") else kinds[2],
                  "vertex_index" if t.has("other names") else "vertex_indices", free=False)
            if t.has("extra columns"):
                t.row("property", kinds[1], "a", free=False), t.row("property", kinds[1], "b", free=False)
        else:
            t.row("element edge 2", free=False), t.row("property int vertex1", free=False), t.row("property int vertex2", free=False)
    t.row("end_header", free=False)
    for part in parts:
        points() if part == "vertex" else faces() if part == "face" else (t.row(0, 1, free=False), t.row(1, 2, free=False))
    return {".ply": t.bytes()}


def stl(t):
    solids = [FACES[:9], FACES[9:]] if t.has("several solids") else [FACES]
    for k, faces in enumerate(solids):
        name = [] if t.has("no names") else [f"Körper {k}" if t.has("latin names") else f"part {k}"]
        t.row(t.key("solid"), *name)
        for f in faces:
            t.row(t.key("facet"), *([] if t.has("no normals") else [t.key("normal"), *([t.dice.choice(["nan", "-nan(ind)", "0"])] * 3
                  if t.has("bad normals") else floats((0, 0, 1)))]))
            t.row(t.key("outer"), t.key("loop"))
            for v in f:
                t.row(t.key("vertex"), *floats(SURFACE[v]))
            t.row(t.key("endloop")), t.row(t.key("endfacet"))
        t.row(t.key("endsolid"), *([] if t.has("no names behind") else name))
    return {".stl": t.bytes()}


VOLUMES = {
    "medit": (medit, "#", "comments|comments behind|blank lines|small letters|capitals|counts beside|counts below|version 1|version 3|other names|other sections|"
              "zero counts|order of sections|no End|text behind"),
    "gmsh 2.2": (gmsh("2.2"), "//", "order of sections|order of items|other sections|gaps|short version|partition tags|latin names|comments|blank lines"),
    "gmsh 4.1": (gmsh("4.1"), "//", "order of sections|other sections|gaps|parametric|latin names|comments|blank lines"),
    "vtk 3.0": (vtk("3.0"), None, "small letters|blank lines|no title|metadata|one a line|nine a line|order of sections|field before|strings|field|no components|latin names"),
    "vtk 5.1": (vtk("5.1"), None, "small letters|blank lines|no title|metadata|one a line|nine a line|order of sections|field before|strings|field|no components"),
    "tetgen": (tetgen, "#", "comments|comments behind|blank lines|from 0|short counts|attributes|no markers|real markers|no labels|negative markers"),
    "su2": (su2, "%", "comments|comments behind|blank lines|small letters|blanks around signs|no blanks around signs|no numbers behind|two counts|"
            "numbers of faces|order of sections"),
    "vtu": (vtu, None, "comments|single quotes|order of attributes|attributes a line|blanks around signs|one a line|no declaration|short integers|empty data|"
            "order of sections"),
}
SURFACES = {
    "obj": (obj, "#", "comments|comments behind|blank lines|back from here|normals|texture|joined lines|weights|colours|names|latin names|old faces|"
            "lines and points|order of sections|unknown statements"),
    "off": (off, "#", "comments|comments behind|blank lines|small letters|texture|colours|normals|no count of edges|no header|counts beside|colours of faces"),
    "ply": (ply, None, "comments|extra columns|colours|normals|order of columns|numbered types|order of sections|other elements|other types|other names"),
    "stl": (stl, None, "blank lines|small letters|capitals|several solids|no names|no names behind|no normals|bad normals|latin names"),
}

# What a format has not, and words of what is said then.
REFUSED = {("gmsh 2.2", "partition tags"): [("partitions", "save it without them")],
           ("su2", "small letters"): [("there is no NDIME=",), ("there is no NPOIN=",)]}
# Habits that change what a mesh has beside points and cells: they are compared among their own.
OTHER_MESHES = {"no markers", "short counts", "attributes", "no labels", "negative markers", "latin names", "parametric", "zero counts"}


def habits_of(name, more, dice):
    known = [h for h in EVERYWHERE + more.split("|")]
    for habit in known:
        yield [habit]
    for _ in range(OPTIONS["count"]):
        yield dice.sample(known, dice.randint(2, 6))


def variants(taut, formats, judge):
    faults = []
    for name, (file, comment, more) in formats.items():
        dice = random.Random(f"{name} {OPTIONS['seed']}")
        wanted = None
        for habits in [[], *habits_of(name, more, dice)]:
            contents = file(Text(dice, habits, comment))
            for extension, content in contents.items():
                taut.write("in" + extension, content)
            source = "in" + next(iter(contents))
            run = taut("check", source, "--json", code=(0, 3, 4))
            say = f"{name}, {', '.join(habits) or 'as it is'}"
            refused = [words for h in habits for words in REFUSED.get((name, h), ())]
            if run.returncode == 3 and refused:
                if not any(all(word in run.stdout for word in words) for words in refused):
                    faults.append(f"{say}: {run.stdout}")
                continue
            found = judge(taut, source, run) if run.returncode != 3 else run.stdout + run.stderr
            if wanted is None:
                assert run.returncode == 0, f"{say}: {found}"
                wanted = found
            if found != wanted and not (isinstance(found, dict) and OTHER_MESHES & set(habits) and
                                        {k: v for k, v in found.items() if k != "groups"} == {k: v for k, v in wanted.items() if k != "groups"}):
                faults.append(f"{say}: {found}" if isinstance(found, str) else
                              f"{say}: " + "; ".join(f"{k}: {found.get(k)}, not {wanted.get(k)}" for k in wanted if found.get(k) != wanted.get(k)))
    assert not faults, f"{len(faults)} spellings\n" + "\n".join(faults)


def volumes(taut):
    """What `taut check` says of cells, groups and shapes."""
    def judge(_, source, run):
        report = json.loads(run.stdout)
        groups = sorted((g["name"], g["vertices"]) for g in report["groups"] if not g["name"].startswith("vertices:"))
        quality = {f"{a} {b}": float(f"{x:.10g}") for a, values in report["quality"].items() if a != "worst_ids" for b, x in values.items()}
        return {"vertices": report["vertices"], "cells": report["cells"], "elements": sorted(report["elements"].items()),
                "inverted": report["inverted"], "components": report["components"], "groups": groups, **quality}
    variants(taut, VOLUMES, judge)


def surfaces(taut):
    """Points and faces of the OBJ that comes out."""
    def judge(run_taut, source, _):
        run = run_taut("unwrap", source, "-o", "out.obj", "--quiet", code=(0, 3, 4))
        if run.returncode != 0:
            return run.stderr
        points, faces = [], []
        for line in run_taut.read("out.obj").replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines():
            words = line.decode("latin-1").removeprefix("\xef\xbb\xbf").split("#")[0].split()
            if words[:1] == ["v"]:
                points.append(tuple(float(w.lower().replace("d", "e")) for w in words[1:4]))
            elif words[:1] in (["f"], ["fo"]):
                faces.append([int(w.split("/")[0]) for w in words[1:]])
        return {"points": points, "faces": [[v - 1 if v > 0 else v + len(points) for v in f] for f in faces]}
    variants(taut, SURFACES, judge)


main(volumes, surfaces)
