#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""shown.py TAUT FOLDER: what a model shows stays as it is, whatever a texture is used for. A renderer of the test's own looks
at points of the surface before and after."""
import json
import math
import random
import resource
import shutil
import struct
import zlib

from support import *  # noqa: F403

CLAMP, REPEAT, MIRROR, NEAREST = 33071, 10497, 33648, 9728


# A curved sheet, one primitive a material

def sheet(n=6, scale=1.0):
    points = [(i / n, j / n, 0.3 * math.sin(3 * i / n) * math.cos(2 * j / n)) for j in range(n + 1) for i in range(n + 1)]
    uv = [(scale * i / n, scale * j / n) for j in range(n + 1) for i in range(n + 1)]
    index = []
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            index += [a, a + 1, a + n + 2, a, a + n + 2, a + n + 1]
    return points, uv, index


def picture(u, v):
    return (0.1 + 0.8 * u, 0.1 + 0.8 * v, 0.4)


def model(name, images, materials, edit=lambda document: None, scale=1.0, primitives=1, sets=1, tangents=False):
    points, uv, index = sheet(scale=scale)
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}],
                "materials": materials, "textures": [{"source": n} for n in range(len(images))], "images": [], "accessors": [],
                "bufferViews": []}
    binary = b""

    def view(data):
        nonlocal binary
        binary += b"\0" * (-len(binary) % 4)
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data
        return len(document["bufferViews"]) - 1

    def accessor(form, rows, **members):
        flat = [x for row in rows for x in row]
        document["accessors"].append({"bufferView": view(struct.pack("<%d%s" % (len(flat), form), *flat)), "count": len(rows), **members})
        return len(document["accessors"]) - 1

    for n in range(primitives):
        moved = [(x, y, z + 2 * n) for x, y, z in points]
        lows, highs = ([f(p[k] for p in moved) for k in range(3)] for f in (min, max))
        attributes = {"POSITION": accessor("f", moved, componentType=5126, type="VEC3", min=lows, max=highs)}
        for s in range(sets):
            attributes["TEXCOORD_%d" % s] = accessor("f", uv if s == 0 else [(0.9 * v, u) for u, v in uv], componentType=5126, type="VEC2")
        if tangents:
            attributes["TANGENT"] = accessor("f", [(1, 0, 0, 1)] * len(uv), componentType=5126, type="VEC4")
        document["meshes"][0]["primitives"].append(
            {"attributes": attributes, "material": min(n, len(materials) - 1),
             "indices": accessor("H", [(i,) for i in index], componentType=5123, type="SCALAR")})
    for data in images:
        document["images"].append({"bufferView": view(data), "mimeType": "image/png"})
    document["buffers"] = [{"byteLength": len(binary)}]
    edit(document)
    (FOLDER / name).write_bytes(glb(document, binary))


def at_path(document, path):
    for key in path.split("/"):
        document = document[int(key) if isinstance(document, list) else key]
    return document


BASE = "pbrMetallicRoughness/baseColorTexture"


def wrapped(x, n, how):
    if how == CLAMP:
        return max(0, min(x, n - 1))
    if how == REPEAT:
        return x % n
    r = x % (2 * n)
    return r if r < n else 2 * n - 1 - r


def shown_at(name, primitive, material, path, count=300):
    """What a texture of a material shows at points of a primitive, in rows from v = 0 upwards as the image has them."""
    m = Model((FOLDER / name).read_bytes())
    info = at_path(m.document["materials"][material], path)
    texture = m.document["textures"][info["index"]]
    sampler = m.document["samplers"][texture["sampler"]] if "sampler" in texture else {}
    image, corners = m.image(texture["source"]), m.corners(primitive, "TEXCOORD_%d" % info.get("texCoord", 0))
    ways = [sampler.get(key, REPEAT) for key in ("wrapS", "wrapT")]
    for t, w in places(corners, count):
        u, v = (sum(w[k] * corners[t][k][i] for k in range(3)) for i in (0, 1))
        x, y = u * image.width, (1 - v) * image.height  # from the top

        def texel(i, j):
            return image.at(wrapped(i, image.width, ways[0]), image.height - 1 - wrapped(j, image.height, ways[1]))

        if sampler.get("magFilter") == NEAREST:
            yield texel(math.floor(x), math.floor(y))
            continue
        i, j = math.floor(x - 0.5), math.floor(y - 0.5)
        s, t = x - 0.5 - i, y - 0.5 - j
        parts = (((1 - s) * (1 - t), texel(i, j)), (s * (1 - t), texel(i + 1, j)), ((1 - s) * t, texel(i, j + 1)),
                 (s * t, texel(i + 1, j + 1)))
        yield [sum(w * p[k] for w, p in parts) for k in range(image.channels)]


def off(old, new, primitive=0, material=0, path=BASE):
    """The mean difference of what is shown, of 255."""
    pairs = list(zip(shown_at(old, primitive, material, path), shown_at(new, primitive, material, path)))
    return 255 * sum(abs(x - y) for a, b in pairs for x, y in zip(a[:3], b[:3])) / (3 * len(pairs))


def cut_and_bake(name, resolution=128, code=0):
    run("atlas", name + ".glb", "-o", name + ".cut.glb", "--quiet")
    said = run("bake", name + ".glb", name + ".cut.glb", "-o", name + ".new.glb", "--resolution", resolution, "--stats", "stats.json",
               code=code)
    return json.loads((FOLDER / "stats.json").read_text()) if code == 0 else said


def plain(index=0, **more):
    return {"pbrMetallicRoughness": {"baseColorTexture": {"index": index, **more}}}


def test_second_sets():
    """An image that another set shows, too, stays for that."""
    model("sets.glb", [png(48, 48, 3, picture)], [plain(), plain(texCoord=1)], primitives=2, sets=2)
    told = cut_and_bake("sets")
    assert any("1 texture has another set" in n for n in told["notes"]), told
    for part in (0, 1):
        assert off("sets.glb", "sets.new.glb", part, part) < 3, part
    # One material with both.
    both = {**plain(), "emissiveTexture": {"index": 0, "texCoord": 1}, "emissiveFactor": [1, 1, 1]}
    model("both.glb", [png(48, 48, 3, picture)], [both], sets=2)
    cut_and_bake("both")
    assert off("both.glb", "both.new.glb") < 3 and off("both.glb", "both.new.glb", path="emissiveTexture") < 1e-9


def test_variants():
    def edit(document):
        document["extensionsUsed"] = ["KHR_materials_variants"]
        document["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "a"}, {"name": "b"}]}}
        document["meshes"][0]["primitives"][0]["extensions"] = {"KHR_materials_variants": {
            "mappings": [{"material": 0, "variants": [0]}, {"material": 1, "variants": [1]}]}}

    model("variants.glb", [png(48, 48, 3, picture), png(48, 48, 3, lambda u, v: (v, u, 0.9))], [plain(), plain(1)], edit)
    cut_and_bake("variants")
    for material in (0, 1):
        assert off("variants.glb", "variants.new.glb", 0, material) < 3, material
    # What nothing shows stays, and what it has in common with others becomes two.
    model("hidden.glb", [png(48, 48, 3, picture)], [plain(), plain()])
    told = cut_and_bake("hidden")
    assert any("no primitive has material 1" in n for n in told["notes"]), told
    old, new = (Model((FOLDER / n).read_bytes()) for n in ("hidden.glb", "hidden.new.glb"))
    assert off("hidden.glb", "hidden.new.glb") < 3 and new.image(0).rows == old.image(0).rows


def test_other_formats():
    for name in ("EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif"):
        def edit(document):
            document["textures"][0] = {"source": 0, "extensions": {name: {"source": 1}}}
            document["extensionsUsed"] = [name, "KHR_materials_ior"]

        model("fallback.glb", [png(48, 48, 3, picture), b"no PNG"], [plain()], edit)
        told = cut_and_bake("fallback")
        assert any(name in n and "taken out" in n for n in told["notes"]), told
        document = Model((FOLDER / "fallback.new.glb").read_bytes()).document
        assert document["textures"][0] == {"source": 0} and document["extensionsUsed"] == ["KHR_materials_ior"], document
        assert off("fallback.glb", "fallback.new.glb") < 3


def test_samplers():
    for n, (sampler, scale) in enumerate((({"wrapS": MIRROR, "wrapT": MIRROR}, 2), ({"wrapS": REPEAT, "wrapT": CLAMP}, 2),
                                          ({"wrapS": CLAMP, "wrapT": MIRROR}, 1.7), ({"wrapS": MIRROR, "wrapT": REPEAT}, -2.5),
                                          ({"magFilter": NEAREST}, 1))):
        def edit(document):
            document["samplers"], document["textures"][0]["sampler"] = [sampler], 0

        name = "sampler%d" % n
        blocks = lambda u, v: ((int(4 * u) % 2) * 0.8, (int(4 * v) % 2) * 0.8, 0.2)
        model(name + ".glb", [png(32, 48, 3, blocks if "magFilter" in sampler else picture)], [plain()], edit, scale=scale)
        cut_and_bake(name, 512 if "magFilter" in sampler else 128)
        assert off(name + ".glb", name + ".new.glb") < 8, (sampler, off(name + ".glb", name + ".new.glb"))
        if "magFilter" in sampler:  # no colours between
            image = Model((FOLDER / (name + ".new.glb")).read_bytes()).image(0)
            assert {x for row in image.rows for x in row} <= {0, 51, 204}
    def odd(document):
        document["samplers"], document["textures"][0]["sampler"] = [{"wrapS": 7}], 0

    model("odd.glb", [png(8, 8, 3, picture)], [plain()], odd)
    assert "wrapS" in cut_and_bake("odd", code=3)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.hypot(*a) for x in a]


def direction_of(name, path, angle=0.0):
    """World directions of the grain at points of the sheet, in frames of its triangles."""
    m = Model((FOLDER / name).read_bytes())
    info = at_path(m.document["materials"][0], path)
    image, corners = m.image(m.document["textures"][info["index"]]["source"]), m.corners(0, "TEXCOORD_%d" % info.get("texCoord", 0))
    p = m.document["meshes"][0]["primitives"][0]
    points, index = m.numbers(p["attributes"]["POSITION"]), [i[0] for i in m.numbers(p["indices"])]
    for t, w in places(corners, 150):
        uv, xyz = corners[t], [points[i] for i in index[3 * t:3 * t + 3]]
        x, y = image.sample(*(sum(w[k] * uv[k][i] for k in range(3)) for i in (0, 1)))[:2]
        x, y = 2 * x - 1, 2 * y - 1
        x, y = x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)
        e, f = ([xyz[k][i] - xyz[0][i] for i in range(3)] for k in (1, 2))
        (a, b), (c, d) = ([uv[k][i] - uv[0][i] for i in (0, 1)] for k in (1, 2))
        det = a * d - b * c
        tangent = unit([(d * e[i] - b * f[i]) / det for i in range(3)])
        side = unit(cross(cross(e, f), tangent))  # of the way in which the chart is seen
        yield unit([tangent[i] * x + side[i] * y * (1 if det > 0 else -1) for i in range(3)])


def test_grain():
    """Directions across the surface are turned with the charts; what an atlas would turn alone is refused."""
    path = "extensions/KHR_materials_anisotropy/anisotropyTexture"
    grain = png(32, 32, 3, lambda u, v: (1, 0.5, 0.7))
    for rotation in (0, 0.6):
        shown = {"anisotropyStrength": 1.0, "anisotropyTexture": {"index": 1}, "anisotropyRotation": rotation}
        material = {**plain(), "extensions": {"KHR_materials_anisotropy": shown}}
        model("grain.glb", [png(48, 48, 3, picture), grain], [material])
        run("atlas", "grain.glb", "-o", "grain.cut.glb", "--quiet")
        run("bake", "grain.glb", "grain.cut.glb", "-o", "grain.new.glb", "--resolution", 128, "--quiet")
        new = Model((FOLDER / "grain.new.glb").read_bytes()).document
        assert "anisotropyRotation" not in new["materials"][0]["extensions"]["KHR_materials_anisotropy"]
        cosines = [sum(p * q for p, q in zip(a, b)) for a, b in zip(direction_of("grain.glb", path, rotation), direction_of("grain.new.glb", path))]
        assert min(cosines) > 0.97, (rotation, min(cosines))
    other = {**plain(), "normalTexture": {"index": 1, "texCoord": 1}}
    model("tangents.glb", [png(48, 48, 3, picture), grain], [material, plain(), other], primitives=3, sets=2, tangents=True)
    cut_and_bake("tangents")
    parts = Model((FOLDER / "tangents.new.glb").read_bytes()).document["meshes"][0]["primitives"]
    assert ["TANGENT" in p["attributes"] for p in parts] == [False, False, True]
    for material, said in (({**plain(), "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 1}}}, "without a texture"),
                           ({**plain(), "extensions": {"MSFT_packing_normalRoughnessMetallic": {
                               "normalRoughnessMetallicTexture": {"index": 1}}}}, "normals packed")):
        model("refused.glb", [png(8, 8, 3, picture), grain], [material])
        assert said in cut_and_bake("refused", code=4), said

    def moving(document):
        document["animations"] = [{"channels": [{"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {
            "pointer": "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset"}}}}],
            "samplers": [{"input": 0, "output": 0}]}]

    model("moving.glb", [png(8, 8, 3, picture)], [plain(extensions={"KHR_texture_transform": {"offset": [0.5, 0]}})], moving)
    assert "animation" in cut_and_bake("moving", code=4)


def test_same_triangles():
    """Primitives that draw the same triangles through other texture coordinates show what they did; an image may be shown in many ways."""
    def edit(document):
        first, second = document["meshes"][0]["primitives"]
        second["attributes"]["TEXCOORD_0"] = second["attributes"].pop("TEXCOORD_1")
        second["attributes"]["POSITION"] = first["attributes"]["POSITION"]
        second["indices"] = first["indices"]
        first["attributes"].pop("TEXCOORD_1")

    model("twice.glb", [png(48, 48, 3, picture), png(48, 48, 3, lambda u, v: (v, u, 0.9))], [plain(), plain(1)], edit, primitives=2, sets=2)
    old = Model((FOLDER / "twice.glb").read_bytes())
    assert old.corners(0) != old.corners(1)
    cut_and_bake("twice")
    for part in (0, 1):
        assert off("twice.glb", "twice.new.glb", part, part) < 3, part
    model("divided.glb", [png(8, 8, 3, picture)], [plain()], edit, primitives=2, sets=2)
    assert "two kinds of TEXCOORD_0" in cut_and_bake("divided", code=4)

    dice = random.Random(4)
    noise = [[dice.random() for _ in range(256)] for _ in range(256)]
    image = png(256, 256, 3, lambda u, v: [noise[int(256 * v)][int(256 * u)]] * 3)
    both = {**plain(), "occlusionTexture": {"index": 0}}
    model("ways.glb", [image], [both])
    assert [t["content"] for t in cut_and_bake("ways")["textures"]] == ["colour", "data"]
    model("parts.glb", [image], [plain(extensions={"KHR_texture_transform": {"offset": [n / 8, 0], "scale": [1 / 8, 1]}}) for n in range(8)],
          primitives=8)
    assert len(cut_and_bake("parts")["textures"]) == 1


def test_frames():
    """Tangents of the file count where it has them, beside primitives without, and only with normals."""
    bumps = png(32, 32, 3, lambda u, v: (0.5 + 0.3 * u, 0.5 + 0.3 * v, 0.9))

    def baked(name, normals, beside, tangents=True):
        def edit(document):
            for n, p in enumerate(document["meshes"][0]["primitives"]):
                if normals:
                    p["attributes"]["NORMAL"] = p["attributes"]["POSITION"]
                if n > 0 or not tangents:
                    p["attributes"].pop("TANGENT")
                elif tangents:
                    p["targets"] = [{"TANGENT": p["attributes"]["POSITION"], "POSITION": p["attributes"]["POSITION"]}]

        materials = [{"normalTexture": {"index": 0}}] + [{}] * beside
        model(name + ".glb", [bumps], materials, edit, primitives=1 + beside, tangents=True)
        run("bake", name + ".glb", name + ".glb", "-o", name + ".new.glb", "--quiet")
        new = Model((FOLDER / (name + ".new.glb")).read_bytes())
        assert all("TANGENT" not in t for t in new.document["meshes"][0]["primitives"][0].get("targets", []))
        return new.image(0).rows

    own = baked("own", True, 0)
    assert own == baked("beside", True, 1) and own != baked("none", True, 0, False)
    assert baked("flat", False, 0) == baked("plain", False, 0, False)


def test_others_as_new():
    """A NEW that was not made of OLD, or is malformed, is refused by name."""
    model("first.glb", [png(16, 16, 3, picture)], [plain()])
    run("atlas", "first.glb", "-o", "first.cut.glb", "--quiet")
    whole = Model((FOLDER / "first.cut.glb").read_bytes())

    def replace(path, value):
        document = json.loads(json.dumps(whole.document))
        at = document
        *way, last = path.split("/")
        for key in way:
            at = at[int(key) if isinstance(at, list) else key]
        at[int(last) if isinstance(at, list) else last] = value
        return document

    for path, value, codes in (("materials/0", {"emissiveTexture": {"index": 0}}, (4,)), ("materials/0", 5, (3, 4)),
                               ("materials/0/pbrMetallicRoughness", [], (4,)), (f"materials/0/{BASE}", 7, (4,)),
                               (f"materials/0/{BASE}/index", -1, (4,)), (f"materials/0/{BASE}/index", 3.5, (4,)),
                               (f"materials/0/{BASE}/extensions", [], (3,)), ("textures/0", 5, (3,)), ("textures/0/source", 9, (4,)),
                               ("textures/0/source", "a", (3,)), ("images/0", 5, (3,)), ("images", {}, (3,)), ("images", [], (4,)),
                               ("bufferViews/0/byteOffset", 2**40, (3,)), ("meshes/0/primitives/0/material", None, (3,))):
        (FOLDER / "other.glb").write_bytes(glb(replace(path, value), whole.binary))
        done = subprocess.run([str(TAUT), "bake", "first.glb", "other.glb", "-o", "x.glb"], cwd=FOLDER, capture_output=True, text=True)
        assert done.returncode in codes and "internal" not in done.stderr, (path, value, done.returncode, done.stderr)
        assert "other commands" not in done.stderr, done.stderr
    for material in (plain(extensions=5), {"pbrMetallicRoughness": {"baseColorTexture": {"index": "a"}}}, {"extensions": {"a": 5}, **plain()},
                     plain(extensions={"KHR_texture_transform": 5}), plain(extensions={"KHR_texture_transform": {"offset": [1e308, 1e308], "scale": [1e300, 0]}})):
        model("odd.glb", [png(16, 16, 3, picture)], [material])
        run("atlas", "odd.glb", "-o", "odd.cut.glb", "--quiet")
        done = subprocess.run([str(TAUT), "bake", "odd.glb", "odd.cut.glb", "-o", "x.glb"], cwd=FOLDER, capture_output=True, text=True)
        assert done.returncode in (0, 3, 4) and "internal" not in done.stderr, (material, done.stderr)


def test_palettes():
    """Faces at one place of the old texture have its colour there; with all faces so there is nothing to compare."""
    points, uv, index = sheet()
    (FOLDER / "palette.png").write_bytes(png(16, 16, 3, lambda u, v: (1, 0, 0) if u < 0.5 else (0, 0, 1)))
    faces = [index[t:t + 3] for t in range(0, len(index), 3)]
    for name, blue in (("some", lambda t: t % 4 < 2 and t > 20 or None), ("all", lambda t: t % 4 < 2)):
        lines = ["v %.9g %.9g %.9g" % p for p in points] + ["vt %.9g %.9g" % (0.4 * u, v) for u, v in uv] + ["vt 0.75 0.5", "vt 0.25 0.5"]
        for t, face in enumerate(faces):
            kind = blue(t)
            lines.append("f " + " ".join("%d/%d" % (v + 1, v + 1 if kind is None else len(uv) + (1 if kind else 2)) for v in face))
        (FOLDER / (name + ".obj")).write_text("\n".join(lines) + "\n")
        run("atlas", name + ".obj", "-o", name + ".cut.obj", "--quiet")
        run("bake", name + ".obj", name + ".cut.obj", "--texture", "palette.png", "-o", name + ".png", "--resolution", 256, "--stats", "stats.json")
        told, image = json.loads((FOLDER / "stats.json").read_text()), Image((FOLDER / (name + ".png")).read_bytes())
        assert told["left_out"] == 0 and (name == "some" or any("nothing is compared" in n for n in told["notes"])), told
        for t, corners in enumerate(read_obj_corners(name + ".cut.obj")):
            red, _, blues = image.sample(*(sum(x[i] for x in corners) / 3 for i in (0, 1)))
            assert (blues if blue(t) else red) > 0.9, (name, t, red, blues)


def tiles_obj(name, count, new):
    lines = []
    for n in range(count):
        lines += ["v %d %d 0" % (2 * n + x, y) for x, y in ((0, 0), (1, 0), (0, 1))]
        lines += ["vt %g %g" % ((n % 10 if new else 0) + x, (n // 10 if new else 0) + y) for x, y in ((0.1, 0.1), (0.9, 0.1), (0.1, 0.9))]
        lines.append("f " + " ".join("%d/%d" % (3 * n + k, 3 * n + k) for k in (1, 2, 3)))
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def test_sizes_of_tiles():
    """A tile gets the size of the finest one that its faces come from, and all are compared."""
    tiles_obj("mixed.obj", 2, True)
    dice = random.Random(3)
    noise = [[dice.random() for _ in range(96)] for _ in range(96)]
    (FOLDER / "mixed.1001.png").write_bytes(png(16, 16, 3, picture))
    (FOLDER / "mixed.1002.png").write_bytes(png(96, 96, 3, lambda u, v: [noise[int(96 * v)][int(96 * u)]] * 3))
    run("bake", "mixed.obj", "mixed.obj", "--texture", "mixed.<UDIM>.png", "-o", "mixed2.<UDIM>.png", "--stats", "stats.json", "--quiet")
    images = [Image((FOLDER / ("mixed2.%d.png" % n)).read_bytes()) for n in (1001, 1002)]
    assert [(i.width, i.height) for i in images] == [(16, 16), (96, 96)]
    told = json.loads((FOLDER / "stats.json").read_text())["textures"][0]
    assert told["compared_texels"] > 0.3 * 96 * 96 and told["largest_difference"] < 0.01 and told["texels"] == 16 * 16 + 96 * 96, told
    # Coarser ones are told.
    run("bake", "mixed.obj", "mixed.obj", "--texture", "mixed.<UDIM>.png", "-o", "mixed3.<UDIM>.png", "--resolution", 16, "--stats", "stats.json", "--quiet")
    told = json.loads((FOLDER / "stats.json").read_text())["textures"][0]
    assert told["largest_difference"] > 0.3, told


def test_numbers_that_files_do_not_hold():
    tiles_obj("one.obj", 1, False)
    same = ["bake", "one.obj", "one.obj", "--content", "data", "--stats", "stats.json", "--texture"]
    (FOLDER / "wide.png").write_bytes(png(32, 32, 1, lambda u, v: [0.5 + (int(32 * u) % 2) / 1000], bits=16))
    run(*same, "wide.png", "-o", "narrow.png", "--bits", 8)
    told = json.loads((FOLDER / "stats.json").read_text())["textures"][0]
    assert 0.0005 < told["largest_difference"] < 0.003, told
    (FOLDER / "high.exr").write_bytes(exr(32, 32, {"Y": lambda i, j: -1.0 if i < 9 else math.nan if i == 14 else 0.2 * i}))
    probe = subprocess.run([str(TAUT), *same, "high.exr", "-o", "high.png"], cwd=FOLDER, capture_output=True, text=True)
    if "built without" in probe.stderr:
        return
    told = json.loads((FOLDER / "stats.json").read_text())
    assert any("cut off" in n and "from -1 to" in n for n in told["notes"]) and any("no number" in n for n in told["notes"]), told
    assert told["textures"][0]["largest_difference"] is None and told["textures"][0]["unlike_numbers"] > 0, told
    run(*same, "high.exr", "-o", "high2.exr", "--filter", "nearest", "--quiet")
    told = json.loads((FOLDER / "stats.json").read_text())
    assert not told["notes"] and told["textures"][0]["largest_difference"] < 1e-3, told


def blank(width, height):
    """A palette of one bit with transparency, all one colour: as few bytes as PNG has."""
    packed, row = zlib.compressobj(9), b"\0" * (1 + (width + 7) // 8)
    data = b"".join(packed.compress(row) for _ in range(height)) + packed.flush()
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 1, 3, 0, 0, 0)) + chunk(b"PLTE", bytes([10, 20, 30, 200, 100, 50]))
            + chunk(b"tRNS", b"\xff\x80") + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def test_memory():
    """A large image of few bytes takes the memory of what it is, and images with the same bytes are one."""
    tiles_obj("one.obj", 1, False)
    (FOLDER / "blank.png").write_bytes(blank(6000, 6000))
    run("bake", "one.obj", "one.obj", "--texture", "blank.png", "-o", "small.png", "--resolution", 64, "--quiet")
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    assert most < 400_000, most
    image = Image((FOLDER / "small.png").read_bytes())
    assert image.channels == 4 and [round(255 * x) for x in image.at(20, 20)] == [10, 20, 30, 255]

    def shared(document):
        document["images"] = [dict(document["images"][0]) for _ in range(12)]
        document["textures"] = [{"source": n} for n in range(12)]

    model("shared.glb", [blank(2000, 2000)], [plain(n) for n in range(12)], shared, primitives=12)
    told = cut_and_bake("shared")
    assert len(told["textures"]) == 1, told["textures"]
    for part in (0, 11):
        for shown in shown_at("shared.new.glb", part, part, BASE, 20):
            assert max(abs(255 * x - y) for x, y in zip(shown, (10, 20, 30))) < 1, shown


shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir(parents=True)
for name, test in list(globals().items()):
    if name.startswith("test_"):
        test()
        print("passed:", name[5:], flush=True)
