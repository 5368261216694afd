# SPDX-License-Identifier: MIT
"""What `taut atlas` promises of glTF that it writes, as another reader of glTF sees it."""
import base64
import json
import math
import os
import struct
from fractions import Fraction

from exact import area2, overlaps
from program import main

FORMATS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
MOST = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}


class Model:
    """A .glb file, or a .gltf with the .bin beside it."""

    def __init__(self, t, name):
        data = t.read(name)
        self.bin = b""
        if data[:4] == b"glTF":
            assert struct.unpack("<I", data[8:12])[0] == len(data), "the length of the GLB"
            at, chunks = 12, []
            while at < len(data):
                size, kind = struct.unpack("<I4s", data[at:at + 8])
                chunks.append((kind, data[at + 8:at + 8 + size]))
                at += 8 + size
            self.json = json.loads(chunks[0][1])
            self.bin = chunks[1][1] if len(chunks) > 1 else b""
            self.more = chunks[2:]
        else:
            self.json = json.loads(data)
            self.bin = t.read(self.json["buffers"][0]["uri"])

    def elements(self, i):
        """The bytes of each element of an accessor, and its numbers as other programs count them."""
        a = self.json["accessors"][i]
        view = self.json["bufferViews"][a["bufferView"]]
        shape = "<" + COUNTS[a["type"]] * FORMATS[a["componentType"]]
        size = struct.calcsize(shape)
        begin = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        stride = view.get("byteStride", size)
        raw = [self.bin[begin + k * stride:begin + k * stride + size] for k in range(a["count"])]
        scale = MOST[a["componentType"]] if a.get("normalized") else 1
        return raw, [tuple(Fraction(x) / scale for x in struct.unpack(shape, e)) for e in raw]

    def triangles(self):
        """(mesh, primitive, {attribute: bytes at three corners}, {attribute: numbers}) of each triangle."""
        for m, mesh in enumerate(self.json["meshes"]):
            for n, p in enumerate(mesh["primitives"]):
                if p.get("mode", 4) != 4:
                    continue
                attributes = {key: self.elements(a) for key, a in p["attributes"].items()}
                count = len(attributes["POSITION"][0])
                drawn = [int(x[0]) for x in self.elements(p["indices"])[1]] if "indices" in p else range(count)
                for i in range(0, len(drawn), 3):
                    corners = drawn[i:i + 3]
                    yield (m, n, {key: tuple(raw[v] for v in corners) for key, (raw, _) in attributes.items()},
                           {key: tuple(numbers[v] for v in corners) for key, (_, numbers) in attributes.items()})

    def upwards(self, name="TEXCOORD_0"):
        """The triangles of the map, with -v of glTF, which runs downwards, as v."""
        return [tuple((u, -v) for u, v in numbers[name]) for _, _, _, numbers in self.triangles()]


class Builder:
    """Makes a .glb file."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "accessors": [], "bufferViews": [], "buffers": [{}]}
        self.bin = b""

    def array(self, elements, component=5126, kind=None, **members):
        kind = kind or ["SCALAR", "VEC2", "VEC3", "VEC4"][len(elements[0]) - 1]
        content = b"".join(struct.pack("<" + COUNTS[kind] * FORMATS[component], *e) for e in elements)
        self.bin += bytes(-len(self.bin) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(content)})
        self.bin += content
        a = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component, "count": len(elements),
             "type": kind, **members}
        if kind == "VEC3":
            a["min"], a["max"] = ([f(e[k] for e in elements) for k in range(3)] for f in (min, max))
        self.json["accessors"].append(a)
        return len(self.json["accessors"]) - 1

    def mesh(self, points, triangles, attributes=None, **node):
        """A mesh of one primitive, and a node that draws it."""
        self.primitive(self.array([tuple(map(float, p)) for p in points]), triangles, attributes)
        self.json["nodes"].append({"mesh": len(self.json["meshes"]) - 1, **node})
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def primitive(self, position, triangles, attributes=None):
        self.json["meshes"].append({"primitives": [{
            "attributes": {"POSITION": position, **(attributes or {})},
            "indices": self.array([(v,) for t in triangles for v in t], 5125)}]})

    def gltf(self, **buffer):
        self.json["buffers"][0].update(byteLength=len(self.bin), **buffer)
        return json.dumps(self.json)

    def glb(self, more=b""):
        text = self.gltf().encode()
        text += b" " * (-len(text) % 4)
        data = self.bin + bytes(-len(self.bin) % 4)
        chunks = (struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(data)) + b"BIN\0" + data + more)
        return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def sheet(n, shift=(0, 0, 0), size=1.0, bend=1.0):
    """n x n quads, bent: points and triangles."""
    points = [(shift[0] + size * i, shift[1] + size * bend * math.sin(i / 2), shift[2] + size * j)
              for i in range(n + 1) for j in range(n + 1)]
    row = n + 1
    triangles = [t for i in range(n) for j in range(n)
                 for t in ((row * i + j, row * i + j + 1, row * i + row + j),
                           (row * i + j + 1, row * i + row + j + 1, row * i + row + j))]
    return points, triangles


def tube(n, m):
    """n around, m along."""
    points = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), 0.5 * j) for j in range(m + 1)
              for i in range(n)]
    triangles = [t for j in range(m) for i in range(n)
                 for t in ((n * j + i, n * j + (i + 1) % n, n * j + n + i),
                           (n * j + (i + 1) % n, n * j + n + (i + 1) % n, n * j + n + i))]
    return points, triangles


def require_map(model, left_out=0):
    """No triangle is flipped, no two overlap, and those without a place lie in one point."""
    triangles = model.upwards()
    points = [t for t in triangles if t[0] == t[1] == t[2]]
    mapped = [t for t in triangles if not t[0] == t[1] == t[2]]
    assert len(points) == left_out, f"{len(points)} triangles in one point, not {left_out}"
    bad = [t for t in mapped if area2(*t) <= 0]
    assert not bad, f"{len(bad)} triangles are flipped or flat"
    pairs = overlaps(mapped)
    assert not pairs, f"{len(pairs)} pairs overlap: {pairs[:5]}"
    return mapped


def require_kept(before, after, name="TEXCOORD_0"):
    """Every attribute of every corner is the same, bit for bit, but for the texture coordinates."""
    old, new = list(before.triangles()), list(after.triangles())
    assert len(old) == len(new)
    for (m, n, a, _), (k, l, b, _) in zip(old, new):
        assert (m, n) == (k, l)
        for key in a:
            assert key == name or a[key] == b[key], f"{key} of a triangle of mesh {m}"


def left_out_triangles_cover_nothing(t):
    points, triangles = tube(12, 5)
    twice = triangles + [triangles[3], triangles[40], (triangles[77][1], triangles[77][0], triangles[77][2])]
    b = Builder()
    b.mesh(points, twice, {"_ID": b.array([(v, 3, 5, 7) for v in range(len(points))], 5121)})
    t.write("dup.glb", b.glb())
    numbers = t.stats("atlas", "dup.glb", "-o", "out.glb", "--repair")
    assert numbers["surfaces"][0]["faces"] - numbers["surfaces"][0]["mapped"] == 3, numbers["surfaces"]
    assert any(note.startswith("3 triangles left out: all corners in one point") for note in numbers["notes"]), numbers
    out = Model(t, "out.glb")
    require_kept(Model(t, "dup.glb"), out)
    require_map(out, left_out=3)
    t.write("dup.obj", "".join("v %r %r %r\n" % p for p in points)
            + "".join("f %d %d %d\n" % tuple(v + 1 for v in f) for f in twice) + "f 1 2 2\n")
    t("atlas", "dup.obj", "-o", "new.glb", "--repair")
    require_map(Model(t, "new.glb"), left_out=4)
    t("atlas", "dup.glb", "-o", "out.gltf", "--repair", "--udim", "12", "--padding", "0")
    require_map(Model(t, "out.gltf"), left_out=3)


def meshes_are_repaired_one_by_one(t):
    points, triangles = sheet(3)
    shifted = [(x + 3, y, z) for x, y, z in points]
    b = Builder()
    b.mesh(points, triangles, translation=[0, 0, 9])
    b.mesh(points, [(a, c, b) for a, b, c in triangles], translation=[50, 0, 0])  # turned over
    b.mesh(points, triangles + triangles[4:6], translation=[0, 50, 0])  # two copies of its own
    b.mesh(shifted, triangles, scale=[-1, 1, 1])  # a rim in common
    b.primitive(0, triangles)  # the positions of the first one, with indices of its own
    t.write("scene.glb", b.glb())
    numbers = t.stats("atlas", "scene.glb", "-o", "out.glb", "--repair")
    out = Model(t, "out.glb")
    require_kept(Model(t, "scene.glb"), out)
    require_map(out, left_out=2)
    kinds = {r["fault"]: r["count"] for r in numbers["surfaces"][0]["repairs"]}
    assert kinds == {"duplicate_cell": 2}, kinds
    assert numbers["charts"] == 5, numbers["charts"]


def mirroring_nodes_change_nothing(t):
    """A node of negative scale turns the winding of what it draws, so that the front of each triangle stays its front; the map
    is in the coordinates of the mesh."""
    points, triangles = tube(9, 3)
    triangles[5] = tuple(reversed(triangles[5]))
    maps = []
    for name, nodes in (("plain", [{}]), ("scale", [{"scale": [-2, 2, 2]}]), ("both", [{}, {"scale": [1, -1, 1]}]),
                        ("matrix", [{"matrix": [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])):
        b = Builder()
        b.mesh(points, triangles, **nodes[0])
        b.json["nodes"] += [{"mesh": 0, **node} for node in nodes[1:]]
        b.json["scenes"][0]["nodes"] = list(range(len(nodes)))
        t.write(name + ".glb", b.glb())
        numbers = t.stats("atlas", name + ".glb", "-o", name + ".out.glb", "--repair")
        assert [r["fault"] for r in numbers["surfaces"][0]["repairs"]] == ["inconsistent_orientation"], numbers["surfaces"]
        out = Model(t, name + ".out.glb")
        require_kept(Model(t, name + ".glb"), out)
        assert out.json["nodes"] == b.json["nodes"]
        maps.append([attributes["TEXCOORD_0"] for _, _, attributes, _ in out.triangles()])
    assert all(m == maps[0] for m in maps)
    assert sum(area2(*x) <= 0 for x in Model(t, "plain.out.glb").upwards()) == 1, "but the one that was turned over"


def in_space(model):
    """The triangles of a new model, through its node."""
    node = model.json["nodes"][0]
    assert set(node) <= {"mesh", "translation", "scale"}
    move = [Fraction(x) for x in node.get("translation", (0, 0, 0))]
    scale = [Fraction(x) for x in node.get("scale", (1, 1, 1))]
    return [tuple(tuple(m + s * x for m, s, x in zip(move, scale, p)) for p in numbers["POSITION"])
            for _, _, _, numbers in model.triangles()]


def has_area(a, b, c):
    u, v = ([q - p for p, q in zip(a, x)] for x in (b, c))
    return any(u[i] * v[j] != u[j] * v[i] for i, j in ((0, 1), (1, 2), (2, 0)))


def new_models_keep_their_shape(t):
    for name, shift, size in (("near", (1, 2, 3), 1.0), ("utm", (500000.1, 5400000.3, 212.7), 0.1),
                              ("utm_fine", (500000.1, 5400000.3, 212.7), 1e-4), ("corner", (-1e7, -1e7, 0), 1e-2),
                              ("far", (0, 1e12, 0), 100.0), ("large", (0, 0, 0), 1e60), ("small", (0, 0, 0), 1e-80),
                              ("huge", (-4e307, 0, 0), 1e307), ("tiny", (0, 0, 0), 1e-300),
                              ("both", (1e50, -1e50, 0), 1e40)):
        points, triangles = sheet(8, shift, size)
        for kind in (name + ".obj", name + ".off"):
            t.write(kind, "".join("v %r %r %r\n" % p for p in points)
                    + "".join("f %d %d %d\n" % tuple(v + 1 for v in f) for f in triangles) if kind.endswith("obj") else
                    f"OFF\n{len(points)} {len(triangles)} 0\n" + "".join("%r %r %r\n" % p for p in points)
                    + "".join("3 %d %d %d\n" % f for f in triangles))
            numbers = t.stats("atlas", kind, "-o", kind + ".glb")
            assert not numbers["notes"], numbers["notes"]
            model = Model(t, kind + ".glb")
            require_map(model)
            extent = max(max(p[k] for p in points) - min(p[k] for p in points) for k in range(3))
            for there, f in zip(in_space(model), triangles):
                here = [tuple(map(Fraction, points[v])) for v in f]
                assert has_area(*there) or not has_area(*here), f"{kind}: no area"
                worst = max(abs(x - y) for p, q in zip(there, here) for x, y in zip(p, q))
                assert worst <= Fraction(1e-6) * Fraction(extent), f"{kind}: {float(worst / Fraction(extent))}"
    # Several surfaces of one atlas lie where they did.
    t("atlas", "utm.obj", "near.obj", "-o", "a.glb", "-o", "b.obj")
    assert in_space(Model(t, "a.glb")) == in_space(Model(t, "utm.obj.glb"))


def what_floats_flatten_is_told(t):
    stray, some = sheet(2, (3e11, 1e11, 0))  # as far away as floats of the sun and the earth
    points, triangles = sheet(6, (500000.1, 5400000.3, 212.7))
    t.write("stray.obj", "".join("v %r %r %r\n" % p for p in stray + points)
            + "".join("f %d %d %d\n" % tuple(v + 1 for v in f) for f in some)
            + "".join("f %d %d %d\n" % tuple(v + 1 + len(stray) for v in f) for f in triangles))
    numbers = t.stats("atlas", "stray.obj", "-o", "out.glb")
    out = Model(t, "out.glb")
    require_map(out)
    flat = [not has_area(*s) for s in in_space(out)]
    assert flat == [True] * len(some) + [False] * len(triangles)  # those that are fewer
    assert any(note.startswith("8 triangles with an area that single precision") for note in numbers["notes"])


def pinned(t, component, values, extra=(), name="in.glb", out="out.glb", **members):
    """Pins a chart with these coordinates, one of two; returns its coordinates before and after, and the model."""
    points, triangles = sheet(2)
    b = Builder()
    half = len(points)
    b.mesh(points + [(x + 9, y, z) for x, y, z in points], triangles + [tuple(v + half for v in f) for f in triangles],
           {"TEXCOORD_0": b.array(values + values, component, "VEC2", **members)})
    t.write(name, b.glb())
    t.write("pins.txt", "0\n")
    t("atlas", name, "-o", out, "--keep-charts", "pins.txt", *extra)
    before, after = Model(t, name), Model(t, out)
    require_kept(before, after)
    require_map(after)
    n = len(triangles)
    return before.upwards()[:n], after.upwards()[:n], after


def square(numbers):
    """3 x 3 texture coordinates, v downwards, that turn no triangle of sheet(2) over: u and v grow with j and i."""
    us, vs = numbers
    return [(us[j], vs[2 - i]) for i in range(3) for j in range(3)]


def pinned_charts_hold_bit_for_bit(t):
    tiny = struct.unpack("<f", struct.pack("<f", 3.703703468e-13))[0]
    for us, vs in (((0.1, 0.2, 0.3), (tiny, 2 * tiny, 0.25)), ((0.0, tiny, 0.5), (0.0, 1e-40, 0.3)),
                   ((1 / 3, 0.5, 0.75), (0.7, 0.8, 1.0)), ((1e-20, 2e-20, 3e-20), (0.1, 0.1 + 2 ** -20, 0.2))):
        before, after, _ = pinned(t, 5126, square((us, vs)), ("--padding", "1"))
        assert before == after, (us, vs)
    # The second row of UDIM, where v of glTF is negative.
    before, after, _ = pinned(t, 5126, square(((0.1, 0.2, 0.3), (-tiny, -0.5 * tiny, -0.25 * tiny))), ("--udim", "11"))
    assert before == after


def pinned_charts_of_fractions_hold(t):
    for component, us, vs in ((5123, (6554, 20000, 23457), (1, 2, 21000)), (5121, (13, 40, 66), (1, 77, 91))):
        before, after, model = pinned(t, component, square((us, vs)), normalized=True)
        assert before == after
        a = model.json["accessors"][model.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]]
        assert a["componentType"] == 5123 and a["normalized"] is True


def what_is_kept_stays(t):
    points, triangles = sheet(4)
    b = Builder()
    b.mesh(points, triangles, {"COLOR_0": b.array([(v, 2 * v, 3, 255) for v in range(len(points))], 5121,
                                                  normalized=True),
                               "NORMAL": b.array([(0.0, 1.0, 0.0)] * len(points)),
                               "TEXCOORD_0": b.array([(0.5, 0.25)] * len(points)),
                               "_W": b.array([(v * 0.1,) for v in range(len(points))])})
    b.json["extras"] = {f"key {i * 7919 % 30011}": i for i in range(30000)}
    more = struct.pack("<I", 8) + b"TESTabcdefgh" + struct.pack("<I", 0) + b"NULL"
    t.write("in.glb", b.glb(more))
    t("atlas", "in.glb", "-o", "out.glb")
    before, after = Model(t, "in.glb"), Model(t, "out.glb")
    require_kept(before, after)
    require_map(after)
    assert after.more == before.more
    assert list(after.json["extras"].items()) == list(before.json["extras"].items())
    t("atlas", "in.glb", "-o", "out.gltf", "--texcoord-set", "1")
    second = Model(t, "out.gltf")
    require_kept(before, second, "TEXCOORD_1")
    assert all(area2(*x) > 0 for x in second.upwards("TEXCOORD_1"))


def document(t, name, uri, more=()):
    """A model whose buffer has this URI, with further buffers."""
    points, triangles = sheet(3)
    b = Builder()
    b.mesh(points, triangles)
    b.gltf(uri=uri)
    for other in more:
        b.json["buffers"].append({"uri": other, "byteLength": 4})
    t.write(name, json.dumps(b.json))
    return b.bin


def nothing_outside_the_folder_is_read(t):
    os.makedirs(t.file("model/sub"))
    data = document(t, "model/x.gltf", "t.bin")
    for name in ("model/t.bin", "model/sub/t.bin"):
        t.write(name, data)
    key = t.file("key.bin")
    t.write("key.bin", data)
    os.symlink("../key.bin", t.file("model/link.bin"))
    os.symlink("..", t.file("model/up"))
    for uri in (key, "../key.bin", "%2e%2e/key.bin", "..%2fkey.bin", "sub/../../key.bin", "sub/%2E%2E/../key.bin",
                "link.bin", "up/key.bin", "..\\key.bin", "//" + key, "file://" + key):
        document(t, "model/x.gltf", uri)
        run = t("atlas", "model/x.gltf", "-o", "out.glb", code=3)
        assert uri[:80] in run.stderr and "beside the document" in run.stderr, run.stderr
        assert not os.path.exists(t.file("out.glb"))
    for uri in ("t.bin", "sub/t.bin", "sub%2Ft.bin"):
        document(t, "model/x.gltf", uri, more=("../key.bin", "/no/such/file"))  # which nothing needs
        t("atlas", "model/x.gltf", "-o", "out.glb")
        model = Model(t, "out.glb")
        assert len(model.json["buffers"]) == 1
        require_map(model)


def no_file_beside_is_lost(t):
    for name in "abc":
        t.write(f"{name}.data", document(t, f"{name}.gltf", f"{name}.data"))
    t.write("p.bin", document(t, "b.gltf", "p.bin"))
    before = {name: t.read(name) for name in os.listdir(t.folder)}

    def refused(*arguments):
        run = t("atlas", *arguments, code=2)
        assert "bin" in run.stderr or "data" in run.stderr, run.stderr
        assert {name: t.read(name) for name in os.listdir(t.folder)} == before

    refused("a.gltf", "b.gltf", "-o", "p.gltf", "-o", "d.gltf")  # p.bin is b's
    refused("b.gltf", "-o", "p.gltf")
    refused("a.gltf", "-o", "b.data.gltf", "--stats", "a.data")
    t.write("p.gltf", document(t, "p.gltf", "p.bin") and t.read("p.gltf"))  # of two documents now
    before["p.gltf"] = t.read("p.gltf")
    refused("a.gltf", "b.gltf", "-o", "p.gltf", "-o", "d.gltf")
    t.write("scene.bin", b"somebody's")
    t.write("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n")
    before = {name: t.read(name) for name in os.listdir(t.folder)}
    refused("s.obj", "-o", "scene.gltf")
    refused("s.obj", "s.obj", "-o", "n.gltf", "-o", "n.GLTF")  # n.bin twice
    t("atlas", "s.obj", "-o", "scene.glb")
    t("atlas", "s.obj", "-o", "new.gltf")
    t("atlas", "a.gltf", "-o", "new.gltf")  # its own
    require_map(Model(t, "new.gltf"))
    t("atlas", "a.gltf", "-o", "a.gltf")
    t("atlas", "a.gltf", "b.gltf", "-o", "a.gltf", "-o", "b.gltf")  # each replaced as a whole
    for name in ("a.gltf", "b.gltf"):
        require_map_apart(Model(t, name))
    assert t.read("scene.bin") == b"somebody's" and t.read("a.data") == before["a.data"]


def require_map_apart(model):
    assert all(area2(*x) > 0 for x in model.upwards())


def small_files_take_little(t):
    points, triangles = sheet(2)
    b = Builder()
    b.mesh(points, triangles)
    for i in range(1000):
        b.json["accessors"].append({"componentType": 5126, "count": 65535, "type": "VEC3"})
        b.json["meshes"][0]["primitives"].append({"attributes": {"POSITION": i + 2}, "indices": 1})
    data = base64.b64encode(b.bin).decode()
    t.write("sparse.gltf", b.gltf(uri="data:;base64," + data))
    run = t("atlas", "sparse.gltf", "-o", "out.glb", code=3, timeout=60)
    assert "give each its own" in run.stderr
    b = Builder()
    b.mesh(points, triangles)
    b.json["extras"] = {format(i, "x"): 0 for i in range(500000)}  # some five megabytes
    b.json["nodes"] += [{"mesh": 0}] * 500000
    t.write("keys.glb", b.glb())
    t("atlas", "keys.glb", "-o", "out.glb", timeout=120)
    assert Model(t, "out.glb").json["extras"] == b.json["extras"]


main(left_out_triangles_cover_nothing, meshes_are_repaired_one_by_one, mirroring_nodes_change_nothing, new_models_keep_their_shape,
     what_floats_flatten_is_told, pinned_charts_hold_bit_for_bit, pinned_charts_of_fractions_hold, what_is_kept_stays,
     nothing_outside_the_folder_is_read, no_file_beside_is_lost, small_files_take_little)
