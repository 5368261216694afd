#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scenes.py TAUT FOLDER: `taut atlas` of scenes of glTF: the scales of nodes, instances, densities by name. What it writes is read
and measured by code of the test."""
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys

import shapes

TAUT, FOLDER = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
FORMATS = {5120: ("b", 127), 5121: ("B", 255), 5122: ("h", 32767), 5123: ("H", 65535), 5125: ("I", 1), 5126: ("f", 1)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def run(*words, code=0):
    done = subprocess.run([str(TAUT), *map(str, words)], cwd=FOLDER, capture_output=True, text=True, timeout=120)
    assert done.returncode == code, (words, done.returncode, done.stdout, done.stderr)
    return done.stdout if code == 0 else done.stderr


def atlas(name, *options, out="out.glb"):
    """What --stats says."""
    run("atlas", name, "-o", out, "--quiet", "--stats", "s.json", *options)
    told = json.loads((FOLDER / "s.json").read_text())
    assert told["flipped"] == told["overlaps"] == 0
    return told


# Models

def cube(n=2):
    """Points and triangles of the surface of [0, 1]^3, n^2 squares a side."""
    return shapes.cube(n, lambda p: tuple(c / n for c in p))


def flat(rows):
    return [x for row in rows for x in (row if isinstance(row, (tuple, list)) else [row])]


class Model:
    """Makes a document piece by piece."""

    def __init__(self, **members):
        self.document = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "meshes": [], **members}
        self.bytes = b""

    def array(self, rows, component=5126, kind="VEC3", **members):
        numbers = flat(rows)
        if component in (5121, 5123) and kind == "VEC3":  # rows begin at multiples of four bytes
            stride = 4 if component == 5121 else 8
            data = b"".join(struct.pack("<3" + FORMATS[component][0], *row).ljust(stride, b"\0") for row in rows)
            view = {"byteStride": stride}
        else:
            data, view = struct.pack("<%d%s" % (len(numbers), FORMATS[component][0]), *numbers), {}
        self.bytes += bytes(-len(self.bytes) % 4)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **view})
        self.document["accessors"].append({"bufferView": len(self.document["bufferViews"]) - 1, "componentType": component,
                                           "type": kind, "count": len(numbers) // WIDTHS[kind], **members})
        self.bytes += data
        return len(self.document["accessors"]) - 1

    def mesh(self, points, triangles, component=5126, name=None, attributes=None, **members):
        low, high = [min(p[k] for p in points) for k in range(3)], [max(p[k] for p in points) for k in range(3)]
        position = self.array(points, component, min=low, max=high)
        primitive = {"attributes": {"POSITION": position, **(attributes or {})},
                     "indices": self.array(triangles, 5123, "SCALAR"), **members}
        self.document["meshes"].append({"primitives": [primitive], **({"name": name} if name else {})})
        return len(self.document["meshes"]) - 1

    def write(self, name, nodes, roots=None, **members):
        below = {c for n in nodes for c in n.get("children", [])}
        roots = [i for i in range(len(nodes)) if i not in below] if roots is None else roots
        document = {**self.document, "scene": 0, "scenes": [{"nodes": roots}], "nodes": nodes,
                    "buffers": [{"byteLength": len(self.bytes)}], **members}
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        data = self.bytes + bytes(-len(self.bytes) % 4)
        (FOLDER / name).write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) +
                                    struct.pack("<II", len(text), 0x4E4F534A) + text +
                                    struct.pack("<II", len(data), 0x004E4942) + data)


def two_cubes():
    model = Model()
    for name in ("small", "large"):
        model.mesh(*cube(), name=name)
    return model


# What comes back

def product(a, b):
    """Of two matrices of four columns."""
    return [[sum(a[k][r] * b[c][k] for k in range(4)) for r in range(4)] for c in range(4)]


def matrix(node):
    if "matrix" in node:
        return [node["matrix"][4 * c:4 * c + 4] for c in range(4)]
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    s, t = node.get("scale", (1, 1, 1)), node.get("translation", (0, 0, 0))
    turn = [[1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
            [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
            [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)]]
    return [[s[c] * e for e in turn[c]] + [0] for c in range(3)] + [[*t, 1]]


def read(name):
    """The document and a function that gives the rows of an accessor."""
    data = (FOLDER / name).read_bytes()
    size = struct.unpack("<I", data[12:16])[0]
    document, rest = json.loads(data[20:20 + size]), data[28 + size:]

    def rows(number):
        a = document["accessors"][number]
        view, (letter, most), n = document["bufferViews"][a["bufferView"]], FORMATS[a["componentType"]], WIDTHS[a["type"]]
        stride, at = view.get("byteStride", struct.calcsize("<%d%s" % (n, letter))), view.get("byteOffset", 0) + a.get("byteOffset", 0)
        found = [struct.unpack_from("<%d%s" % (n, letter), rest, at + i * stride) for i in range(a["count"])]
        return [tuple(c / most for c in r) for r in found] if a.get("normalized") else found

    return document, rows


def drawn(name, texcoord="TEXCOORD_0"):
    """For each node that draws a mesh: number, and points in the scene and texture coordinates of its triangles."""
    document, rows = read(name)
    nodes, found = document["nodes"], []

    def go(n, above):
        place = product(above, matrix(nodes[n]))
        for p in document["meshes"][nodes[n]["mesh"]]["primitives"] if "mesh" in nodes[n] else []:
            points, uv = rows(p["attributes"]["POSITION"]), rows(p["attributes"][texcoord])
            index = flat(rows(p["indices"]))
            placed = [[sum(place[k][r] * (*x, 1)[k] for k in range(4)) for r in range(3)] for x in points]
            corners = [index[i:i + 3] for i in range(0, len(index), 3)]
            found.append((n, [[placed[v] for v in c] for c in corners], [[uv[v] for v in c] for c in corners]))
        for child in nodes[n].get("children", []):
            go(child, place)

    for root in document["scenes"][0]["nodes"]:
        go(root, [[float(r == c) for r in range(4)] for c in range(4)])
    return found


def area3(a, b, c):
    u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    return math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2


def area2(a, b, c):
    return abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2


def densities(name, resolution):
    """Of each drawing node, least and largest texels a unit of the scene, by areas of triangles."""
    result = {}
    for node, points, uv in drawn(name):
        ratios = [resolution * math.sqrt(area2(*t) / area3(*p)) for p, t in zip(points, uv)]
        low, high = result.get(node, (math.inf, 0))
        result[node] = min(low, *ratios), max(high, *ratios)
    return result


def require_densities(name, resolution, wanted):
    found = densities(name, resolution)
    assert found.keys() == wanted.keys(), (found, wanted)
    for node, (low, high) in found.items():
        assert abs(low / wanted[node] - 1) < 1e-3 and abs(high / wanted[node] - 1) < 1e-3, (node, low, high, wanted)


# Scales of nodes

PAGE = ("--texels-per-unit", 16, "--resolution", 512, "--max-distortion", 4.000001)  # sides are charts, or unfold


def test_density_is_that_of_the_scene():
    two_cubes().write("two.glb", [{"mesh": 0}, {"mesh": 1, "scale": [10, 10, 10]}])
    told = atlas("two.glb", *PAGE)
    require_densities("out.glb", 512, {0: 16, 1: 16})
    assert any("scale meshes by 1 to 10" in n for n in told["notes"]), told["notes"]
    assert abs(told["distortion"] - 4) < 1e-6 and told["density_spread"] < 1e-4
    told = atlas("two.glb", *PAGE, "--density-in", "file")
    require_densities("out.glb", 512, {0: 16, 1: 1.6})
    assert not any("scale meshes" in n for n in told["notes"]), told["notes"]
    # Of one joined file the points are those of the meshes.
    run("atlas", "two.glb", "two.glb", "-o", "joined.obj", "--quiet", *PAGE)
    points = [line.split()[1:] for line in (FOLDER / "joined.obj").read_text().splitlines() if line.startswith("v ")]
    assert max(float(x) for p in points for x in p) == 1


def test_parents_and_matrices_count():
    turn = [math.sin(0.3), 0, 0, math.cos(0.3)]
    nodes = [{"children": [1], "scale": [4, 4, 4], "rotation": turn, "translation": [7, 8, 9]},
             {"children": [2], "matrix": [0, 0.5, 0, 0, -0.5, 0, 0, 0, 0, 0, 0.5, 0, 1, 2, 3, 1]},
             {"mesh": 0, "rotation": turn}, {"children": [4], "scale": [0.25] * 3}, {"mesh": 1}]
    two_cubes().write("chain.glb", nodes)
    atlas("chain.glb", *PAGE)
    require_densities("out.glb", 512, {2: 16, 4: 16})


def test_shapes_are_those_of_the_scene():
    """A box of sides 1, 2 and 4, and one that shears: charts are as they are drawn."""
    nodes = [{"mesh": 0, "scale": [1, 2, 4]}, {"mesh": 1, "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]
    two_cubes().write("shapes.glb", nodes)
    told = atlas("shapes.glb", *PAGE)
    require_densities("out.glb", 512, {0: 16, 1: 16})
    assert abs(told["distortion"] - 4) < 1e-6


def test_quantized_meshes_count_as_what_they_stand_for():
    model = Model(extensionsUsed=["KHR_mesh_quantization"])
    points, triangles = cube()
    for most in (4096, 512):
        model.mesh([[round(c * most) for c in p] for p in points], triangles, 5123)
    model.write("quantized.glb", [{"mesh": 0, "scale": [1 / 4096] * 3}, {"mesh": 1, "scale": [1 / 512] * 3}])
    told = atlas("quantized.glb", "--resolution", 512, "--max-distortion", 4.000001)
    (low, high), (low2, high2) = densities("out.glb", 512).values()
    assert max(high, high2) / min(low, low2) < 1.001 and abs(told["distortion"] - 4) < 1e-6


def test_a_skin_places_its_mesh():
    """As quantized models have it: the scale is in the inverse bind matrices, and the node's own does not count."""
    model = Model(extensionsUsed=["KHR_mesh_quantization"])
    points, triangles = cube()
    count = len(points)
    skinned = {"JOINTS_0": model.array([(0, 0, 0, 0)] * count, 5121, "VEC4"),
               "WEIGHTS_0": model.array([(1, 0, 0, 0)] * count, 5126, "VEC4")}
    model.mesh([[round(c * 256) for c in p] for p in points], triangles, 5123, attributes=skinned)
    model.mesh(points, triangles)
    inverse = model.array([[1 / 256 if i % 5 == 0 and i < 15 else float(i == 15) for i in range(16)]], 5126, "MAT4")
    model.write("skinned.glb", [{"mesh": 0, "skin": 0, "scale": [50, 50, 50]}, {"mesh": 1}, {"scale": [3, 3, 3]}],
                skins=[{"joints": [2], "inverseBindMatrices": inverse}])
    atlas("skinned.glb", *PAGE)
    found = densities("out.glb", 512)
    assert abs(found[1][0] / 16 - 1) < 1e-3 and abs(found[0][0] * 50 * 256 / 3 / 16 - 1) < 1e-3, found  # 3 / 256, not 50


def test_the_largest_of_several_nodes_counts():
    nodes = [{"mesh": 0, "scale": [2, 2, 2]}, {"mesh": 0, "scale": [5, 5, 5]}, {"mesh": 1}, {"mesh": 1, "scale": [99, 99, 99]}]
    two_cubes().write("several.glb", nodes, roots=[0, 1, 2])  # the last one is in no scene
    told = atlas("several.glb", *PAGE)
    require_densities("out.glb", 512, {0: 40, 1: 16, 2: 16})
    assert any("the largest counts: 1 mesh (0)" in n for n in told["notes"]), told["notes"]


def test_meshes_of_the_same_triangles_count_as_one():
    model = Model(materials=[{"name": "red"}, {"name": "blue"}])
    model.mesh(*cube(), name="first", material=0)
    model.document["meshes"].append({"name": "second", "primitives": [{**model.document["meshes"][0]["primitives"][0], "material": 1}]})
    model.mesh(*cube(), name="other")
    model.write("same.glb", [{"mesh": 0}, {"mesh": 1, "scale": [5, 5, 5], "name": "top"}, {"mesh": 2}])
    told = atlas("same.glb", *PAGE)
    require_densities("out.glb", 512, {0: 80, 1: 16, 2: 16})
    assert any("the largest counts: 1 mesh (0)" in n for n in told["notes"]), told["notes"]
    assert any("1 mesh is drawn by several nodes, 2 times" in n for n in told["notes"]), told["notes"]
    for name in ("first", "second", "top", "red", "blue"):
        atlas("same.glb", *PAGE, "--density", name + "=0.5")
        require_densities("out.glb", 512, {0: 40, 1: 8, 2: 16})
    # A second part of the first mesh, which the second one does not draw, is not of its name.
    second = model.mesh([(x + 3, y, z) for x, y, z in cube()[0]], cube()[1])
    model.document["meshes"][0]["primitives"].append(model.document["meshes"].pop(second)["primitives"][0])
    model.write("same.glb", [{"mesh": 0}, {"mesh": 1, "name": "top"}, {"mesh": 2}])
    for name in ("second", "top"):
        atlas("same.glb", *PAGE, "--density", name + "=0.5")
        found = densities("out.glb", 512)
        assert [round(x, 1) for x in (*found[0], *found[1])] == [8, 16, 8, 8], found
    model.document["meshes"][0]["primitives"].pop()
    model.write("same.glb", [{"mesh": 1, "scale": [5, 5, 5]}, {"mesh": 2}])
    atlas("same.glb", *PAGE)
    require_densities("out.glb", 512, {0: 16, 1: 16})


def test_instances_of_an_extension_have_scales():
    model = two_cubes()
    attributes = {"SCALE": model.array([(2, 2, 2), (8, 8, 8)]), "TRANSLATION": model.array([(0, 0, 0), (50, 0, 0)])}
    model.write("gpu.glb", [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}, {"mesh": 1}],
                extensionsUsed=["EXT_mesh_gpu_instancing"])
    told = atlas("gpu.glb", *PAGE)
    require_densities("out.glb", 512, {0: 128, 1: 16})  # the node itself has no scale
    assert any("the largest counts: 1 mesh (0)" in n for n in told["notes"]), told["notes"]


def test_odd_places_do_no_harm():
    far, mirrored = {"mesh": 0, "translation": [1e15, 0, 0], "scale": [2, 2, 2]}, {"mesh": 1, "scale": [-1, 1, 1]}
    two_cubes().write("odd.glb", [far, mirrored])
    told = atlas("odd.glb", *PAGE, "--hide-seams", "strong")
    document, rows = read("out.glb")
    for number, density in ((0, 32), (1, 16)):
        p = document["meshes"][number]["primitives"][0]
        points, uv, index = rows(p["attributes"]["POSITION"]), rows(p["attributes"]["TEXCOORD_0"]), flat(rows(p["indices"]))
        for i in range(0, len(index), 3):
            c = index[i:i + 3]
            found = 512 * math.sqrt(area2(*(uv[v] for v in c)) / area3(*(points[v] for v in c)))
            assert abs(found / density - 1) < 1e-3, (number, found)
    two_cubes().write("odd.glb", [{"mesh": 0, "scale": [1, 1, 0]}, {"mesh": 1, "scale": [0, 0, 0]}])
    told = atlas("odd.glb", *PAGE)
    for what in ("scaled alike in all directions instead: 1 mesh (0)", "left as the file has them: 1 mesh (1)"):
        assert any(what in n for n in told["notes"]), told["notes"]
    two_cubes().write("odd.glb", [{"mesh": 0, "children": [0]}, {"mesh": 1}])
    atlas("odd.glb", *PAGE, "--density-in", "file")


def test_nodes_that_are_none_are_refused():
    def fault(nodes, **members):
        two_cubes().write("bad.glb", nodes, **members)
        return run("atlas", "bad.glb", "-o", "x.glb", code=3)

    assert "nodes 1 is below itself" in fault([{"mesh": 0}, {"children": [2]}, {"children": [1]}], roots=[0])
    assert "nodes 2 is a child of two nodes" in fault([{"children": [2]}, {"children": [2]}, {"mesh": 0}])
    assert "nodes 0 has a scale that is not 3 numbers" in fault([{"mesh": 0, "scale": [1, 2]}])
    assert "nodes 0 has a matrix that is not 16 numbers" in fault([{"mesh": 0, "matrix": ["1"] * 16}])
    for rotation in ([0, 0, 0, 0], [1e200, 0, 0, 1]):
        assert "a rotation that is no unit quaternion" in fault([{"mesh": 0, "rotation": rotation}])
    assert "meshes 7 is named" in fault([{"mesh": 7}])
    assert "nodes 9 is named" in fault([{"mesh": 0, "children": [9]}], roots=[0])
    (FOLDER / "cube.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert "--density-in needs glTF" in run("atlas", "cube.obj", "-o", "x.obj", "--density-in", "file", code=2)


# Instances

def require_apart(name, texcoord="TEXCOORD_0", samples=512):
    """No sample of a grid is covered twice by what the nodes draw."""
    owner = {}
    for node, _, uv in drawn(name, texcoord):
        for t, (a, b, c) in enumerate(uv):
            low, high = [[f(p[d] for p in (a, b, c)) * samples for d in (0, 1)] for f in (min, max)]
            for i in range(math.floor(low[0]), math.ceil(high[0]) + 1):
                for j in range(math.floor(low[1]), math.ceil(high[1]) + 1):
                    p = ((i + 0.37) / samples, (j + 0.61) / samples)
                    sides = [(v[0] - u[0]) * (p[1] - u[1]) - (v[1] - u[1]) * (p[0] - u[0]) for u, v in ((a, b), (b, c), (c, a))]
                    if min(sides) > 0 or max(sides) < 0:
                        assert owner.setdefault((i, j), (node, t)) == (node, t), (owner[i, j], node, t)
    return owner


def chairs():
    """Three nodes that draw one mesh of two materials, one of them mirrored and one below another; and a table."""
    model = Model(materials=[{"name": "wood"}, {"name": "cushion"}], extras={"by": "a test"})
    points, triangles = cube(3)
    attributes = {"NORMAL": model.array([(0, 0, 1)] * len(points)), "_WEAR": model.array([i / 99 for i in range(len(points))], kind="SCALAR"),
                  "TEXCOORD_0": model.array([(x, y) for x, y, _ in points], kind="VEC2", name="picture")}
    m = model.mesh(points, triangles[:60], name="chair", attributes=attributes, material=0, extras={"part": 1})
    primitive = model.document["meshes"][m]["primitives"]
    primitive.append({"attributes": dict(primitive[0]["attributes"]), "material": 1,
                      "indices": model.array(triangles[60:], 5123, "SCALAR")})
    model.document["meshes"][m]["extras"] = {"sat on": True}
    points, triangles = cube(1)
    model.mesh(points, triangles, name="table", attributes={"TEXCOORD_0": model.array([(0, 0)] * 8, kind="VEC2")})
    nodes = [{"mesh": 0, "name": "left"}, {"mesh": 1, "translation": [0, 4, 0], "children": [2]},
             {"mesh": 0, "name": "right", "scale": [-1, 1, 1]}, {"mesh": 0, "name": "back", "translation": [5, 5, 5]}]
    model.write("chairs.glb", nodes)


def test_shared_instances_are_told():
    chairs()
    told = atlas("chairs.glb", *PAGE, "--texcoord-set", 1)
    assert any(n.startswith("1 mesh is drawn by several nodes, 3 times in all") for n in told["notes"]), told["notes"]
    assert len(read("out.glb")[0]["meshes"]) == 2


def test_instances_lie_apart():
    chairs()
    told = atlas("chairs.glb", *PAGE, "--texcoord-set", 1, "--instances", "apart")
    assert "2 meshes were added, so that each node draws its own" in told["notes"], told["notes"]
    require_apart("out.glb", "TEXCOORD_1")
    before, after = drawn("chairs.glb"), drawn("out.glb")
    assert [(n, points, uv) for n, points, uv in after] == before  # in their order, with the picture where it was
    (old, _), (new, _) = read("chairs.glb"), read("out.glb")
    assert new["meshes"][1]["name"] == "table" and new["extras"] == old["extras"] and new["materials"] == old["materials"]
    drawing = [n["mesh"] for n in new["nodes"]]
    assert sorted(drawing) == [0, 1, 2, 3] and drawing[0] == 0 and drawing[1] == 1
    copies = [new["meshes"][drawing[n]] for n in (0, 2, 3)]
    maps = set()
    for mesh in copies:
        assert mesh["name"] == "chair" and mesh["extras"] == {"sat on": True} and mesh["primitives"][0]["extras"] == {"part": 1}
        assert [p["material"] for p in mesh["primitives"]] == [0, 1]
        own = {p["attributes"].pop("TEXCOORD_1") for p in mesh["primitives"]}
        assert len(own) == 1 and not own & maps
        maps |= own
    assert copies[0] == copies[1] == copies[2]  # all else is shared: accessors, too
    views = {a["bufferView"] for a in new["accessors"]}
    assert len(views) == len(new["accessors"]) == len(old["accessors"]) + 4 and views == set(range(len(new["bufferViews"])))
    # What is read again has the places that were written.
    told = atlas("out.glb", *PAGE[:4], "--texcoord-set", 1, "--charts", "pack", "--instances", "apart", out="again.glb")
    assert not any("added" in n for n in told["notes"])
    require_apart("again.glb", "TEXCOORD_1")
    told = atlas("out.glb", *PAGE, "--texcoord-set", 1, out="again.glb")
    assert any("4 primitives draw the triangles of others with other texture coordinates" in n for n in told["notes"]), told["notes"]


def test_instances_have_lengths_and_names_of_their_own():
    chairs()
    told = atlas("chairs.glb", *PAGE, "--instances", "apart", "--density", "right=2", "--density", "chair=1.5")
    require_apart("out.glb")
    found = densities("out.glb", 512)
    for node, wanted in ((0, 24), (1, 16), (2, 48), (3, 24)):
        assert all(abs(x / wanted - 1) < 1e-3 for x in found[node]), (node, found)
    two_cubes().write("sizes.glb", [{"mesh": 0, "scale": [k, k, k]} for k in (1, 2, 4)])
    told = atlas("sizes.glb", *PAGE, "--instances", "apart")
    require_densities("out.glb", 512, {0: 16, 1: 16, 2: 16})
    require_apart("out.glb")
    assert not any("largest counts" in n for n in told["notes"])


def test_meshes_of_the_same_triangles_lie_apart():
    """Instances of other materials are meshes that share accessors; twice in one mesh, triangles are drawn twice at one place."""
    model = Model(materials=[{"name": "red"}, {"name": "blue"}])
    model.mesh(*cube(), material=0)
    primitive = model.document["meshes"][0]["primitives"][0]
    model.document["meshes"][0]["primitives"].append({**primitive, "material": 1})
    model.document["meshes"].append({"primitives": [{**primitive, "material": 1}]})
    model.write("shared.glb", [{"mesh": 0}, {"mesh": 1}])
    atlas("shared.glb", *PAGE, "--instances", "apart")
    document, _ = read("out.glb")
    (first, second), (third,) = ([p["attributes"]["TEXCOORD_0"] for p in m["primitives"]] for m in document["meshes"])
    assert first == second != third
    found = [uv for _, _, uv in drawn("out.glb")]
    assert found[0] == found[1] and not {tuple(map(tuple, t)) for t in found[0]} & {tuple(map(tuple, t)) for t in found[2]}


def test_strips_and_small_indices_lie_apart():
    """Indices of bytes grow where seams need more vertices than these can say, once for all copies."""
    model = Model()
    n, m = 15, 16  # a tube
    points = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), j / 4) for j in range(m + 1) for i in range(n)]
    rows = [[j * n + i % n + d * n for i in range(n + 1) for d in (1, 0)] for j in range(m)]
    strip = [v for row in rows for v in ([row[0]] + row + [row[-1]])]
    model.mesh(points, [0], name="tube")
    model.document["meshes"][0]["primitives"][0].update(mode=5, indices=model.array(strip, 5121, "SCALAR"))
    model.write("strip.glb", [{"mesh": 0}, {"mesh": 0, "translation": [3, 0, 0]}])
    # Triangles at the ends of rows have no area.
    told = atlas("strip.glb", "--resolution", 256, "--instances", "apart", "--prefer", "packing", "--repair")
    require_apart("out.glb", samples=256)
    document, rows = read("out.glb")
    first, second = ({**m["primitives"][0]} for m in document["meshes"])
    assert first["indices"] == second["indices"] and first["attributes"]["POSITION"] == second["attributes"]["POSITION"]
    assert first["mode"] == 4 and document["accessors"][first["indices"]]["componentType"] == 5123


def test_many_instances():
    two_cubes().write("many.glb", [{"mesh": 0, "translation": [2 * k, 0, 0]} for k in range(300)])
    atlas("many.glb", "--resolution", 2048, "--instances", "apart", "--prefer", "packing")
    require_apart("out.glb", samples=1024)
    assert len(read("out.glb")[0]["meshes"]) == 301


def test_instances_that_cannot_lie_apart_are_refused():
    model = two_cubes()
    attributes = {"TRANSLATION": model.array([(0, 0, 0), (50, 0, 0)])}
    model.write("gpu.glb", [{"mesh": 0}, {"mesh": 1, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}])
    fault = run("atlas", "gpu.glb", "-o", "x.glb", "--instances", "apart", code=4)
    assert "node 1 draws mesh 1 2 times by EXT_mesh_gpu_instancing" in fault and "write a node for each" in fault
    assert any("2 times in all" in n for n in atlas("gpu.glb")["notes"])
    run("atlas", "cube.obj", "-o", "x.obj", "--instances", "apart", code=2)
    assert "leave out one" in run("atlas", "gpu.glb", "-o", "x.glb", "--instances", "apart", "--stack", "similar", code=2)
    assert "give -o once" in run("atlas", "gpu.glb", "gpu.glb", "-o", "x.obj", "--instances", "apart", code=2)


# Densities by name

def test_a_mesh_a_node_a_material_gets_more_texels():
    model = Model(materials=[{"name": "skin"}, {"name": "cloth=blue"}])
    for name, material in (("hero", 0), ("crowd", 1), ("", 0)):
        model.mesh(*cube(), name=name, material=material)
    model.write("named.glb", [{"mesh": 0}, {"mesh": 1, "scale": [3, 3, 3], "name": "back row"}, {"mesh": 2, "name": "dog"}])
    atlas("named.glb", *PAGE, "--density", "hero=2")
    require_densities("out.glb", 512, {0: 32, 1: 16, 2: 16})
    atlas("named.glb", *PAGE, "--density", "skin=0.5", "--density", "dog=3", "--density", "cloth=blue=2")
    require_densities("out.glb", 512, {0: 8, 1: 32, 2: 24})  # the dog is of skin, too
    atlas("named.glb", *PAGE, "--density", "back row=0.25", "--density-in", "file")
    require_densities("out.glb", 512, {0: 16, 1: 4 / 3, 2: 16})
    told = atlas("named.glb", "--density", "hero=2", "--resolution", 512, "--max-distortion", 4.000001)
    (hero, _), (crowd, _), (dog, _) = densities("out.glb", 512).values()
    assert abs(hero / dog - 2) < 2e-3 and abs(crowd / dog - 1) < 1e-3
    fault = run("atlas", "named.glb", "-o", "x.glb", "--density", "heros=2", code=4)
    for name in ("hero", "crowd", "back row", "dog", "skin", "cloth=blue"):
        assert f"'{name}'" in fault, fault
    for wrong in ("hero", "=2", "hero=", "hero=0", "hero=-1", "hero=nan", "hero=inf", "hero=2x", "hero=1e4", "hero=1e-4"):
        assert "such as face=2" in run("atlas", "named.glb", "-o", "x.glb", "--density", wrong, code=2), wrong
    assert "twice" in run("atlas", "named.glb", "-o", "x.glb", "--density", "hero=2", "--density", "hero=3", code=2)


def grid(columns):
    """A flat strip of quads of side 1, one to the right of the other, and the lines of OBJ before some of them."""
    lines = ["v %d %d 0" % (x, y) for x in range(len(columns) + 1) for y in (0, 1)]
    for k, before in enumerate(columns):
        lines += [*before, "f %d %d %d %d" % (2 * k + 1, 2 * k + 3, 2 * k + 4, 2 * k + 2)]
    return "\n".join(lines) + "\n"


def obj_densities(name, resolution=512):
    """Texels a unit of each face, in their order, by its first side."""
    rows = {"v": [], "vt": [], "f": []}
    for line in (FOLDER / name).read_text().splitlines():
        w = line.split()
        if w and w[0] in rows:
            rows[w[0]].append(w[1:])
    found = []
    for f in rows["f"]:
        (a, t), (b, u) = ([int(i) - 1 for i in corner.split("/")[:2]] for corner in f[:2])
        found.append(round(resolution * math.dist([float(x) for x in rows["vt"][t]], [float(x) for x in rows["vt"][u]]) /
                           math.dist([float(x) for x in rows["v"][a]], [float(x) for x in rows["v"][b]]), 2))
    return found


def test_groups_objects_and_materials_of_obj():
    (FOLDER / "strip.obj").write_text(grid([[], ["o box"], ["g left  top "], ["usemtl wood"], ["g two words"], ["o ball", "g"]]))

    def found(*given):
        atlas("strip.obj", *PAGE, *[w for text in given for w in ("--density", text)], out="strip.out.obj")
        return obj_densities("strip.out.obj")

    assert found("box=2") == [16, 32, 32, 32, 32, 16], found("box=2")
    assert found("left=2") == found("top=2") == found("left  top=2") == [16, 16, 32, 32, 16, 16]
    assert found("two words=2") == [16, 16, 16, 16, 32, 16]
    assert found("wood=2", "ball=2") == [16, 16, 16, 32, 32, 64]
    fault = run("atlas", "strip.obj", "-o", "x.obj", "--density", "roof=2", code=4)
    assert all(f"'{name}'" in fault for name in ("box", "ball", "left", "top", "wood", "two words")), fault
    # Charts of the file are parted where the density changes, and polygons are whole.
    assert found() == [16] * 6
    told = atlas("strip.out.obj", *PAGE[:4], "--charts", "pack", "--density", "wood=2", out="strip.pack.obj")
    assert told["charts"] == 2
    assert obj_densities("strip.pack.obj") == [16, 16, 16, 32, 32, 32]
    (FOLDER / "plain.obj").write_text(grid([[], []]))
    assert "it names none" in run("atlas", "plain.obj", "-o", "x.obj", "--density", "roof=2", code=4)


def test_files_of_several_have_densities():
    (FOLDER / "a.obj").write_text(grid([[]]))
    (FOLDER / "sub").mkdir()
    (FOLDER / "sub" / "b.obj").write_text(grid([[], []]))
    for name in ("b.obj", "sub/b.obj"):
        run("atlas", "a.obj", "sub/b.obj", "-o", "a.out.obj", "-o", "b.out.obj", "--quiet", *PAGE, "--density", name + "=2")
        assert obj_densities("a.out.obj") == [16] and obj_densities("b.out.obj") == [32, 32]
    run("atlas", "a.obj", "sub/b.obj", "-o", "ab.obj", "--quiet", *PAGE, "--density", "a.obj=0.5")
    assert sorted(obj_densities("ab.obj")) == [8, 8, 16, 16, 16, 16]  # as triangles
    fault = run("atlas", "a.obj", "sub/b.obj", "-o", "x.obj", "--density", "c.obj=2", code=4)
    assert "'a.obj', 'sub/b.obj'" in fault, fault
    run("atlas", "a.obj", "-o", "x.obj", "--density", "a.obj=2", code=4)  # alone it has nothing to be denser than


def test_copies_of_another_density_lie_apart():
    text = "".join("v %g %g %g\n" % (x + 9 * k, y, z) for k in range(3) for x, y, z in ((0, 0, 0), (3, 0, 0), (0, 2, 0), (0, 0, 1)))
    text += "".join("g part%d\n" % k + "".join("f %d %d %d\n" % tuple(4 * k + i for i in f) for f in
                                               ((1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4))) for k in range(3))
    (FOLDER / "copies.obj").write_text(text)
    stack = atlas("copies.obj", *PAGE, "--stack", "similar", out="copies.out.obj")["stacked"]
    told = atlas("copies.obj", *PAGE, "--stack", "similar", "--density", "part2=2", out="copies.out.obj")
    assert told["stacked"] == stack / 2, (told["stacked"], stack)
    assert obj_densities("copies.out.obj") == [16] * 8 + [32] * 4


shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir(parents=True)
for name, test in list(globals().items()):
    if name.startswith("test_"):
        test()
        print("passed:", name[5:])
shutil.rmtree(FOLDER)
