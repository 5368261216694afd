# SPDX-License-Identifier: MIT
"""VTU in all encodings that VTK, ParaView, PyVista and meshio write: the output has the encoding of its input, other
arrays bit for bit, and the points that the same mesh as text gets. Damaged arrays are named."""
import base64
import lzma
import re
import struct
import zlib
from itertools import permutations, product

from program import main

SIDE = 3
NAMES = {"zlib": "vtkZLibDataCompressor", "lzma": "vtkLZMADataCompressor", "lz4": "vtkLZ4DataCompressor"}
LETTERS = {"Int8": "b", "UInt8": "B", "Int16": "h", "UInt16": "H", "Int32": "i", "UInt32": "I", "Int64": "q",
           "UInt64": "Q", "Float32": "f", "Float64": "d"}


def lz4_literals(data):
    """A block of LZ4 that is one run of literals."""
    n, more = len(data), b""
    if n >= 15:
        more = b"\xff" * ((n - 15) // 255) + bytes([(n - 15) % 255])
    return bytes([min(n, 15) << 4]) + more + data


def lz4_unpacked(block):
    out, at = bytearray(), 0
    while at < len(block):
        token, at = block[at], at + 1

        def length(n):
            nonlocal at
            while n >= 15:
                n, at = n + block[at], at + 1
                if block[at - 1] != 255:
                    break
            return n
        n = length(token >> 4)
        out += block[at:at + n]
        at += n
        if at == len(block):
            break
        back, at = block[at] | block[at + 1] << 8, at + 2
        for _ in range(length(token & 15) + 4):
            out.append(out[-back])
    return bytes(out)


PACK = {"zlib": zlib.compress, "lzma": lzma.compress, "lz4": lz4_literals}
UNPACK = {"zlib": zlib.decompress, "lzma": lzma.decompress, "lz4": lz4_unpacked}


class Code:
    def __init__(self, place="inline", base=True, pack=None, wide=False, big=False, block=200, apart=False):
        self.place, self.base, self.pack, self.wide, self.big, self.block = place, base, pack, wide, big, block
        self.apart = apart  # the header of an uncompressed array in base64 by itself
        self.order = ">" if big else "<"

    def words(self, *numbers):
        return struct.pack(self.order + ("Q" if self.wide else "I") * len(numbers), *numbers)

    def text(self, data):
        """The code of an array."""
        b64 = base64.b64encode if self.base else bytes
        if not self.pack:
            head = self.words(len(data))
            return b64(head) + b64(data) if self.apart else b64(head + data)
        blocks = [data[k:k + self.block] for k in range(0, len(data), self.block)]
        packed = [PACK[self.pack](b) for b in blocks]
        return b64(self.words(len(blocks), self.block, len(data) % self.block, *map(len, packed))) + b64(b"".join(packed))

    def data(self, text):
        """The array that a code begins with."""
        word, letter = (8, "Q") if self.wide else (4, "I")

        def taken(n):
            nonlocal text
            length = (n + 2) // 3 * 4 if self.base else n
            part, text = text[:length], text[length:]
            return base64.b64decode(part, validate=True) if self.base else part
        if not self.pack:
            if self.apart:
                return taken(struct.unpack(self.order + letter, taken(word))[0])
            head = base64.b64decode(text[:12])[:word] if self.base else text[:word]
            n = struct.unpack(self.order + letter, head)[0]
            return taken(word + n)[word:]
        head = base64.b64decode(text[:12])[:word] if self.base else text[:word]
        n = struct.unpack(self.order + letter, head)[0]
        _, block, last, *sizes = struct.unpack(self.order + letter * (3 + n), taken(word * (3 + n)))
        packed, out = taken(sum(sizes)), []
        for size in sizes:
            out.append(UNPACK[self.pack](packed[:size]))
            packed = packed[size:]
        assert all(len(b) == block for b in out[:-1]) and len(out[-1]) == (last or block)
        return b"".join(out)


def cube():
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
            cells.append(cell)
    return [tuple(x / 4 for x in p) for p in number], cells


POINTS, CELLS = cube()
PINS = "".join(f"{v},{x + (0.25 if z else 0)!r},{y!r},{z!r}\n" for v, (x, y, z) in enumerate(POINTS) if z in (0, SIDE / 4))


def arrays(real="Float64", integers=("Int64", "Int32", "UInt8")):
    return [("PointData", "vec", "Float32", 3, [k / 7 for k in range(3 * len(POINTS))]),
            ("PointData", "side", "Int16", 1, [k % 2 for k in range(len(POINTS))]),
            ("Points", "Points", real, 3, [x for p in POINTS for x in p]),
            ("Cells", "connectivity", integers[0], 1, [v for c in CELLS for v in c]),
            ("Cells", "offsets", integers[1], 1, [4 * k + 4 for k in range(len(CELLS))]),
            ("Cells", "types", integers[2], 1, [10] * len(CELLS)),
            ("CellData", "part", "Int32", 1, [k % 3 for k in range(len(CELLS))])]


def vtu(code, made=None, change=lambda name, text: text):
    """A file. code: None for text. change(name, code): what the file has for the code of an array."""
    head = b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0"'
    if code:
        head += f' byte_order="{"BigEndian" if code.big else "LittleEndian"}"'.encode()
        head += f' header_type="{"UInt64" if code.wide else "UInt32"}"'.encode()
        head += f' compressor="{NAMES[code.pack]}"'.encode() if code.pack else b""
    out, appended = head + b">\n<UnstructuredGrid>\n", b""
    out += b'<Piece NumberOfPoints="%d" NumberOfCells="%d">\n' % (len(POINTS), len(CELLS))
    for section, name, kind, components, values in made or arrays():
        tag = f'<{section}>\n<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '.encode()
        if not code:
            out += tag + b'format="ascii">' + " ".join(map(repr, values)).encode() + b"</DataArray>"
        else:
            data = struct.pack(code.order + LETTERS[kind] * len(values), *values)
            text = change(name, code.text(data))
            if code.place == "inline":
                out += tag + b'format="binary">\n   ' + text + b"\n</DataArray>"
            else:
                out += tag + b'format="appended" offset="%d"  />' % len(appended)
                appended += text
        out += f"\n</{section}>\n".encode()
    out += b"</Piece>\n</UnstructuredGrid>\n"
    if code and code.place == "appended":
        out += b'<AppendedData encoding="%s">\n _%s\n</AppendedData>\n' % (b"base64" if code.base else b"raw", appended)
    return out + b"</VTKFile>\n"


def read(content, code):
    """Bytes of the arrays by name, and what the file is besides these and their offsets."""
    found, rest = {}, content
    start = content.find(b"_", content.find(b"<AppendedData")) + 1 if b"<AppendedData" in content else None
    head = content[:start] if start else content
    for tag in re.finditer(rb'<DataArray [^>]*Name="([^"]*)"[^>]*>', head):
        name = tag.group(1).decode()
        if start:
            offset = int(re.search(rb'offset="(\d+)"', tag.group()).group(1))
            found[name] = code.data(content[start + offset:])
        else:
            found[name] = code.data(content[tag.end():content.find(b"<", tag.end())].strip())
    if start:
        rest = re.sub(rb'offset="\d+"', b"", head)
    else:
        rest = re.sub(rb'(format="binary">\s*)[^<\s]+', rb"\1", content)
    return found, rest


CODES = [Code("inline"), Code("inline", apart=True), Code("inline", wide=True, apart=True), Code("appended"),
         Code("appended", base=False, wide=True, big=True)]
CODES += [Code(place, base, pack, wide, big, block) for pack in NAMES for place, base, wide, big, block in
          (("inline", True, False, False, 200), ("inline", True, True, True, 32768), ("appended", True, True, False, 7 * 8),
           ("appended", False, False, True, 100), ("appended", False, True, False, 1536))]


def check_code(run, code, made, command, options, wanted):
    name = f"{vars(code)}, {command}"
    content = vtu(code, made)
    run.write("in.vtu", content)
    run(command, "in.vtu", "-o", "out.vtu", *options)
    before, rest = read(content, code)
    after, rest_after = read(run.read("out.vtu"), code)
    assert rest == rest_after, f"{name}: what is no array"
    for key, data in before.items():
        assert (after[key] == data) == (key != "Points"), f"{name}: {key}"
    letter = LETTERS[made[2][2]]
    n = 3 * len(POINTS)
    points = struct.unpack(code.order + letter * n, after["Points"])
    assert points == struct.unpack("<" + letter * n, struct.pack("<" + letter * n, *wanted)), f"{name}: other points"


def all_encodings(run):
    """Every encoding, and every type of numbers."""
    run.write("pins.csv", PINS)
    deform, smooth = ("deform", ("--pins", "pins.csv")), ("smooth", ())
    for real in ("Float64", "Float32"):
        types = [("Int64", "Int32", "UInt8"), ("UInt8", "Int16", "Int8"), ("UInt32", "UInt64", "Int64"), ("Int32", "UInt16", "UInt32")]
        run.write("text.vtu", vtu(None, arrays(real)))
        run("deform", "text.vtu", "-o", "out.vtu", *deform[1])
        text = re.search(rb'Name="Points"[^>]*>([^<]*)<', run.read("out.vtu")).group(1)
        for k, code in enumerate(CODES):
            check_code(run, code, arrays(real, types[k % 4]), *deform, list(map(float, text.split())))
            told = run("check", "in.vtu").stdout
            assert "162 tetrahedra" in told, told


def damaged(run):
    """What is wrong is named with the line of the array, and nothing is written."""
    zlib_inline = Code("inline", True, "zlib")

    def refused(content, *words):
        run.write("bad.vtu", content)
        told = run("smooth", "bad.vtu", "-o", "no.vtu", code=3).stderr
        assert all(w in told for w in ("bad.vtu, line ", *words)), f"{words}: {told}"

    def with_points(change):
        return lambda name, text: change(text) if name == "Points" else text
    for code in (Code(), zlib_inline, Code(pack="lzma"), Code(pack="lz4")):
        for cut in (3, 4, 50, 400):  # the = at the end may be missing
            refused(vtu(code, change=with_points(lambda t: t[:-cut])), "array 'Points'")
            refused(vtu(code, change=with_points(lambda t: t[:cut])), "array 'Points'")
        refused(vtu(code, change=with_points(lambda t: t + b"AAAA")), "array 'Points'")
        refused(vtu(code, change=with_points(lambda t: t[:40] + b"!" + t[41:])), "array 'Points'", "base64")
        refused(vtu(code, change=lambda name, t: t[:-8] if name == "connectivity" else t), "array 'connectivity'")
    raw = struct.pack("<" + "d" * 3 * len(POINTS), *(x for p in POINTS for x in p))
    for head in ((2 ** 32 - 1, 200, 0), (3, 2 ** 31, 0), (8, 200, 201), (8, 0, 0), (0, 0, 0), (1, 1, 1)):
        text = base64.b64encode(struct.pack("<III", *head)) + base64.b64encode(zlib.compress(raw))
        refused(vtu(zlib_inline, change=with_points(lambda t: text)), "array 'Points'")
    broken = zlib.compress(raw[:-8])
    for sent, block in ((zlib.compress(raw), len(raw) - 8), (broken, len(raw)), (zlib.compress(raw)[:-9] + b"x" * 9, len(raw)),
                        (zlib.compress(bytes(10 ** 7)), len(raw))):
        text = base64.b64encode(struct.pack("<IIII", 1, block, 0, len(sent))) + base64.b64encode(sent)
        refused(vtu(zlib_inline, change=with_points(lambda t: text)), "array 'Points'")
    bomb = zlib.compress(bytes(24 * 10 ** 7))
    text = base64.b64encode(struct.pack("<IIII", 1, 24 * 10 ** 7, 0, len(bomb))) + base64.b64encode(bomb)
    refused(vtu(zlib_inline, change=with_points(lambda t: text)).replace(b'NumberOfPoints="64"', b'NumberOfPoints="10000000"'))
    good = vtu(zlib_inline)
    refused(good.replace(b"vtkZLib", b"vtkBrotli"), "vtkBrotliDataCompressor", "save the mesh uncompressed")
    refused(good.replace(b'"UInt32" compressor', b'"Int7" compressor'), "header_type 'Int7'")
    refused(good.replace(b"LittleEndian", b"MiddleEndian"), "byte_order 'MiddleEndian'")
    refused(good.replace(b'NumberOfPoints="64"', b'NumberOfPoints="63"'), "1536 bytes for 63 points")


def meshio_files(run):
    """Files as meshio writes them, which reads what is written of them."""
    try:
        import meshio
    except ImportError:
        print("no meshio: left out")
        return
    run.write("pins.csv", PINS)
    for compression in (None, "zlib", "lzma"):
        for header in ("UInt32", "UInt64"):
            mesh = meshio.Mesh(POINTS, [("tetra", CELLS)], point_data={"t": [p[0] for p in POINTS]},
                               cell_data={"part": [[k % 3 for k in range(len(CELLS))]]})
            meshio.vtu.write(run.file("in.vtu"), mesh, binary=True, compression=compression, header_type=header)
            run("deform", "in.vtu", "-o", "out.vtu", "--pins", "pins.csv")
            a, b = meshio.read(run.file("in.vtu")), meshio.read(run.file("out.vtu"))
            assert (a.cells[0].data == b.cells[0].data).all() and (a.point_data["t"] == b.point_data["t"]).all()
            assert (a.cell_data["part"][0] == b.cell_data["part"][0]).all()
            assert (a.points[:, 0] + 0.25 * (a.points[:, 2] > 0.7))[-1] == b.points[-1, 0]


if __name__ == "__main__":
    main(all_encodings, damaged, meshio_files)
