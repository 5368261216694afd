# SPDX-License-Identifier: MIT
"""What the tests of `taut bake` have in common: images, surfaces and models, written and read by other code than its own."""
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import zlib

TAUT, FOLDER = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])


# Images: rows from the top, a tuple a pixel

def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png(width, height, channels, pixel, bits=8):
    """pixel(u, v): numbers from 0 to 1, v upwards."""
    most, form = (255, "B") if bits == 8 else (65535, ">H")
    raw = b"".join(b"\0" + b"".join(struct.pack(form, round(most * x)) for i in range(width)
                                    for x in pixel((i + 0.5) / width, 1 - (j + 0.5) / height)) for j in range(height))
    head = struct.pack(">IIBBBBB", width, height, bits, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")


class Image:
    def __init__(self, data):
        assert data[:8] == b"\x89PNG\r\n\x1a\n"
        at, packed = 8, b""
        while at < len(data):
            size, name = struct.unpack(">I", data[at:at + 4])[0], data[at + 4:at + 8]
            content = data[at + 8:at + 8 + size]
            assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(name + content)
            if name == b"IHDR":
                self.width, self.height, self.bits, form = struct.unpack(">IIBB", content[:10])
            packed += content if name == b"IDAT" else b""
            at += 12 + size
        self.channels = {0: 1, 4: 2, 2: 3, 6: 4}[form]
        step, raw = self.channels * self.bits // 8, zlib.decompress(packed)
        row, above, self.rows = step * self.width, bytes(step * self.width), []
        for j in range(self.height):
            kind, line = raw[j * (row + 1)], bytearray(raw[j * (row + 1) + 1:(j + 1) * (row + 1)])
            for k in range(row):
                a, b, c = line[k - step] if k >= step else 0, above[k], above[k - step] if k >= step else 0
                p = a + b - c
                near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                line[k] = line[k] + (0, a, b, (a + b) // 2, near)[kind] & 255
            self.rows.append(bytes(line))
            above = self.rows[-1]

    def at(self, i, j):
        """Texel from the lower left, numbers from 0 to 1."""
        row = self.rows[self.height - 1 - j % self.height]
        size, i = self.channels, i % self.width
        if self.bits == 8:
            return [x / 255 for x in row[size * i:size * (i + 1)]]
        return [x / 65535 for x in struct.unpack(">%dH" % size, row[2 * size * i:2 * size * (i + 1)])]

    def sample(self, u, v):
        x, y = u * self.width - 0.5, v * self.height - 0.5
        i, j = math.floor(x), math.floor(y)
        s, t = x - i, y - j
        parts = [(self.at(i, j), (1 - s) * (1 - t)), (self.at(i + 1, j), s * (1 - t)),
                 (self.at(i, j + 1), (1 - s) * t), (self.at(i + 1, j + 1), s * t)]
        return [sum(w * p[k] for p, w in parts) for k in range(self.channels)]


# A surface: a band around an axis with uv once around it, so that the texture goes on across its seam

def band(n=24, m=8):
    points, uv, faces, uv_faces = [], [], [], []
    for j in range(m + 1):
        for i in range(n + 1):
            a, h = 2 * math.pi * i / n, j / m
            if i < n:
                r = 1 + 0.2 * math.sin(2 * math.pi * h)
                points.append((r * math.cos(a), r * math.sin(a), 2 * h))
            uv.append((i / n, 0.02 + 0.96 * h))
    for j in range(m):
        for i in range(n):
            p = [(j + b) * n + (i + a) % n for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            t = [(j + b) * (n + 1) + i + a for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            faces += [[p[0], p[1], p[2]], [p[0], p[2], p[3]]]
            uv_faces += [[t[0], t[1], t[2]], [t[0], t[2], t[3]]]
    return points, uv, faces, uv_faces


def write_obj(name, points, uv, faces, uv_faces):
    lines = ["v %.9g %.9g %.9g" % p for p in points] + ["vt %.9g %.9g" % t for t in uv]
    lines += ["f " + " ".join("%d/%d" % (a + 1, b + 1) for a, b in zip(f, t)) for f, t in zip(faces, uv_faces)]
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def read_obj_corners(name):
    uv, corners = [], []
    for line in (FOLDER / name).read_text().splitlines():
        words = line.split()
        if words[:1] == ["vt"]:
            uv.append((float(words[1]), float(words[2])))
        if words[:1] == ["f"]:
            corners.append([uv[int(w.split("/")[1]) - 1] for w in words[1:]])
    return corners


def run(*words, code=0):
    done = subprocess.run([str(TAUT), *map(str, words)], cwd=FOLDER, capture_output=True, text=True, timeout=120)
    assert done.returncode == code, (words, done.returncode, done.stdout, done.stderr)
    return done.stdout if code == 0 else done.stderr


def seen(image, corners, t, w):
    return image.sample(*(sum(w[k] * corners[t][k][i] for k in range(3)) for i in (0, 1)))


def places(corners, count=600):
    dice = random.Random(5)
    for _ in range(count):
        a, b = sorted((dice.random(), dice.random()))
        yield dice.randrange(len(corners)), (a, b - a, 1 - b)


def largest_difference(a, from_corners, b, to_corners):
    return max(abs(x - y) for t, w in places(from_corners)
               for x, y in zip(seen(a, from_corners, t, w), seen(b, to_corners, t, w)))


def colour(u, v):
    return (0.5 + 0.4 * math.sin(2 * math.pi * 2 * u), 0.5 + 0.4 * math.cos(5 * v), 0.5 + 0.3 * math.sin(2 * math.pi * u + 4 * v))


# glTF

def glb(document, binary):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body


class Model:
    def __init__(self, data):
        size = struct.unpack("<I", data[12:16])[0]
        self.document, self.binary = json.loads(data[20:20 + size]), data[28 + size:]

    def view(self, n):
        v = self.document["bufferViews"][n]
        return self.binary[v.get("byteOffset", 0):][:v["byteLength"]]

    def numbers(self, n):
        a = self.document["accessors"][n]
        form, size = {5126: ("f", 4), 5125: ("I", 4), 5123: ("H", 2)}[a["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[a["type"]]
        flat = struct.unpack("<%d%s" % (width * a["count"], form), self.view(a["bufferView"])[:size * width * a["count"]])
        return [flat[i:i + width] for i in range(0, len(flat), width)]

    def corners(self, primitive, name="TEXCOORD_0"):
        p = self.document["meshes"][0]["primitives"][primitive]
        uv = [(u, 1 - v) for u, v in self.numbers(p["attributes"][name])]
        index = [i[0] for i in self.numbers(p["indices"])]
        return [[uv[i] for i in index[t:t + 3]] for t in range(0, len(index), 3)]

    def image(self, n):
        return Image(self.view(self.document["images"][n]["bufferView"]))


def exr(width, height, channels, kind="f", window=None, tiled=0, kind_of_part=None):
    """An EXR file without compression; channels: {name: number of i, j}, j from the top."""
    code = {"I": 0, "e": 1, "f": 2}[kind]
    names = sorted(channels)
    attribute = lambda name, of, data: name.encode() + b"\0" + of.encode() + b"\0" + struct.pack("<i", len(data)) + data
    box = struct.pack("<4i", *(window or (0, 0, width - 1, height - 1)))
    listed = b"".join(n.encode() + b"\0" + struct.pack("<iB3xii", code, 0, 1, 1) for n in names) + b"\0"
    head = struct.pack("<ii", 20000630, 2 | (0x200 if tiled else 0)) + attribute("channels", "chlist", listed)
    head += attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", box)
    head += attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) + attribute("screenWindowCenter", "v2f", bytes(8))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    head += attribute("tiles", "tiledesc", struct.pack("<IIB", tiled, tiled, 0)) if tiled else b""
    head += attribute("type", "string", kind_of_part) if kind_of_part else b""
    row = lambda j, i0, i1: b"".join(struct.pack("<" + kind, channels[n](i, j)) for n in names for i in range(i0, i1))
    if tiled:
        blocks = []
        for y in range(0, height, tiled):
            for x in range(0, width, tiled):
                data = b"".join(row(j, x, min(width, x + tiled)) for j in range(y, min(height, y + tiled)))
                blocks.append(struct.pack("<5i", x // tiled, y // tiled, 0, 0, len(data)) + data)
    else:
        blocks = [struct.pack("<ii", j, len(row(j, 0, width))) + row(j, 0, width) for j in range(height)]
    at, offsets = len(head) + 1 + 8 * len(blocks), b""
    for block in blocks:
        offsets += struct.pack("<Q", at)
        at += len(block)
    return head + b"\0" + offsets + b"".join(blocks)
