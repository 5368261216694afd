#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""program.py TAUT FOLDER: `taut bake` as its users meet it. Its results are judged by other code than its own."""
import json
import math
import shutil
import struct
import subprocess
import zlib

from support import *  # noqa: F403


def test_obj():
    mesh = band()
    write_obj("old.obj", *mesh)
    run("atlas", "old.obj", "-o", "new.obj", "--quiet")
    old, new = read_obj_corners("old.obj"), read_obj_corners("new.obj")
    for bits in (8, 16):
        (FOLDER / "in.png").write_bytes(png(256, 96, 3, colour, bits))
        run("bake", "old.obj", "new.obj", "--texture", "in.png", "-o", "out.png", "--resolution", 256, "--quiet",
            "--difference", "difference.png", "--stats", "stats.json")
        before, after = Image((FOLDER / "in.png").read_bytes()), Image((FOLDER / "out.png").read_bytes())
        assert (after.width, after.height, after.bits, after.channels) == (256, 256, bits, 3)
        d = largest_difference(before, old, after, new)
        assert d < 0.08, d  # steepest by 5 per unit of u; a texel of the atlas is 1 / 50 of u or so
        told = json.loads((FOLDER / "stats.json").read_text())["textures"][0]
        assert told["largest_difference"] < 0.1 and told["rms_difference"] < 0.01, told
        shown = Image((FOLDER / "difference.png").read_bytes())
        assert (shown.width, shown.height, shown.channels) == (256, 96, 1)
        assert max(max(row) for row in shown.rows) / 255 <= 8 * told["largest_difference"] * 1.5 + 0.01
    # And back again.
    run("bake", "new.obj", "old.obj", "--texture", "out.png", "-o", "back.png", "--resolution", "256x96", "--quiet")
    d = largest_difference(before, old, Image((FOLDER / "back.png").read_bytes()), old)
    assert d < 0.1, d


def test_labels():
    (FOLDER / "labels.png").write_bytes(png(64, 64, 1, lambda u, v: [int(5 * u) * 50 / 255]))
    run("bake", "old.obj", "new.obj", "--texture", "labels.png", "-o", "labels2.png", "--content", "data", "--filter",
        "nearest", "--quiet")
    values = {x for row in Image((FOLDER / "labels2.png").read_bytes()).rows for x in row}
    assert values == {0, 50, 100, 150, 200}, values
    assert "labels have no mean" in run("bake", "old.obj", "new.obj", "--texture", "labels.png", "-o", "x.png", "--filter",
                                   "nearest", "--samples", 2, code=2)


def test_exr():
    (FOLDER / "in.png").write_bytes(png(128, 64, 3, colour, 16))
    done = subprocess.run([str(TAUT), "bake", "old.obj", "old.obj", "--texture", "in.png", "-o", "same.exr", "--content",
                           "data", "--quiet"], cwd=FOLDER, capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        assert "without EXR" in done.stderr, done.stderr
        return
    run("bake", "old.obj", "old.obj", "--texture", "same.exr", "-o", "same.png", "--content", "data", "--quiet")
    a, b = Image((FOLDER / "in.png").read_bytes()), Image((FOLDER / "same.png").read_bytes())
    assert b.bits == 16
    for j in range(8, 56, 5):  # the same atlas: the same texels
        for i in range(2, 126, 7):
            assert max(abs(x - y) for x, y in zip(a.at(i, j), b.at(i, j))) < 2e-4, (i, j, a.at(i, j), b.at(i, j))


def test_tiles():
    """Of UDIM: from several tiles to one and back."""
    run("atlas", "old.obj", "-o", "tiles.obj", "--prefer", "packing", "--max-distortion", 4.005, "--udim", 3, "--resolution", 192, "--quiet")
    (FOLDER / "in.png").write_bytes(png(256, 128, 3, colour))
    run("bake", "old.obj", "tiles.obj", "--texture", "in.png", "-o", "part.<UDIM>.png", "--resolution", 192, "--quiet")
    run("bake", "old.obj", "tiles.obj", "--texture", "in.png", "-o", "first.png", "--resolution", 192)
    old, new = read_obj_corners("old.obj"), read_obj_corners("tiles.obj")
    images = {}
    tile = [int(sum(u for u, _ in t) / 3) for t in new]
    for n in sorted(set(tile)):
        images[n] = Image((FOLDER / f"part.{1001 + n}.png").read_bytes())
    assert len(images) > 1 and (FOLDER / "first.png").read_bytes() == (FOLDER / "part.1001.png").read_bytes()
    before = Image((FOLDER / "in.png").read_bytes())
    for t, w in places(old):
        moved = [(u - tile[t], v) for u, v in new[t]]
        a, b = seen(before, old, t, w), images[tile[t]].sample(*(sum(w[k] * moved[k][i] for k in range(3)) for i in (0, 1)))
        assert max(abs(x - y) for x, y in zip(a, b)) < 0.12, (t, a, b)
    run("bake", "tiles.obj", "old.obj", "--texture", "part.<UDIM>.png", "-o", "joined.png", "--resolution", "256x128", "--quiet",
        "--difference", "d.<UDIM>.png")
    d = largest_difference(before, old, Image((FOLDER / "joined.png").read_bytes()), old)
    assert d < 0.15, d
    assert (FOLDER / "d.1002.png").exists()
    (FOLDER / "part.1002.png").unlink()
    assert "part.1002.png" in run("bake", "tiles.obj", "old.obj", "--texture", "part.<UDIM>.png", "-o", "x.png", code=3)
    assert "<UDIM>" in run("bake", "tiles.obj", "old.obj", "--texture", "part.<UDIM>.png", "-o", "x.png", "--difference",
                           "d.png", code=2)


def test_vertex_colours():
    points, _, faces, _ = band()
    red = [round(255 * (0.5 + 0.4 * math.sin(math.atan2(p[1], p[0])))) for p in points]
    text = "ply\nformat ascii 1.0\nelement vertex %d\n" % len(points)
    text += "".join("property float %s\n" % c for c in "xyz")
    text += "".join("property uchar %s\n" % c for c in ("red", "green", "blue"))
    text += "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(faces)
    text += "".join("%.9g %.9g %.9g %d 9 200\n" % (*p, r) for p, r in zip(points, red))
    text += "".join("3 %d %d %d\n" % tuple(f) for f in faces)
    (FOLDER / "coloured.ply").write_text(text)
    run("bake", "coloured.ply", "new.obj", "--vertex-colours", "-o", "colours.png", "--resolution", 200, "--quiet")
    image, new = Image((FOLDER / "colours.png").read_bytes()), read_obj_corners("new.obj")
    for t, f in enumerate(faces):
        for k in range(3):
            w = [0.98 if n == k else 0.01 for n in range(3)]
            r, g, b = seen(image, new, t, w)
            assert abs(r - red[f[k]] / 255) < 0.06 and abs(g - 9 / 255) < 0.01 and abs(b - 200 / 255) < 0.01
    assert "no colours" in run("bake", "old.obj", "new.obj", "--vertex-colours", "-o", "x.png", code=4)


def make_model():
    """Two materials: one with a colour and a normal map, one whose colour is placed by KHR_texture_transform."""
    points, uv, faces, uv_faces = band()
    vertices = {}
    for f, t in zip(faces, uv_faces):
        for pair in zip(f, t):
            vertices.setdefault(pair, len(vertices))
    index = [vertices[pair] for f, t in zip(faces, uv_faces) for pair in zip(f, t)]
    binary, views, accessors = b"", [], []

    def add(data, members, **accessor):
        nonlocal binary
        binary += b"\0" * (-len(binary) % 4)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data), **members})
        binary += data
        if accessor:
            accessors.append({"bufferView": len(views) - 1, **accessor})
        return len(views) - 1

    flat = [x for p, _ in vertices for x in points[p]]
    lows, highs = ([f(p[k] for p in points) for k in range(3)] for f in (min, max))
    add(struct.pack("<%df" % len(flat), *flat), {}, componentType=5126, count=len(vertices), type="VEC3", min=lows, max=highs)
    flat = [x for _, t in vertices for x in (uv[t][0], 1 - uv[t][1])]
    add(struct.pack("<%df" % len(flat), *flat), {}, componentType=5126, count=len(vertices), type="VEC2")
    flat = [x for p, _ in vertices for x in (-points[p][1] / math.hypot(*points[p][:2]), points[p][0] / math.hypot(*points[p][:2]), 0, 1)]
    add(struct.pack("<%df" % len(flat), *flat), {}, componentType=5126, count=len(vertices), type="VEC4")
    half = len(index) // 2
    for part in (index[:half], index[half:]):
        add(struct.pack("<%dH" % len(part), *part), {}, componentType=5123, count=len(part), type="SCALAR")
    images = [png(128, 64, 3, colour), png(64, 64, 3, lambda u, v: (0.5 + 0.1 * math.sin(2 * math.pi * u), 0.5, 0.98))]
    image_views = [add(image, {}) for image in images]
    (FOLDER / "beside.png").write_bytes(png(128, 64, 3, lambda u, v: colour(u, 1 - v)))
    attributes = {"POSITION": 0, "TEXCOORD_0": 1, "TANGENT": 2}
    placed = {"index": 2, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}}
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": attributes, "indices": 3, "material": 0},
                                           {"attributes": attributes, "indices": 4, "material": 1}]}],
                "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 1}},
                              {"pbrMetallicRoughness": {"baseColorTexture": placed}, "extras": {"kept": 1}}],
                "textures": [{"source": 0}, {"source": 1}, {"source": 2}],
                "images": [{"bufferView": image_views[0], "mimeType": "image/png", "name": "skin"},
                           {"bufferView": image_views[1], "mimeType": "image/png"}, {"uri": "beside.png"}],
                "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    (FOLDER / "model.glb").write_bytes(glb(document, binary))


def test_model():
    make_model()
    run("atlas", "model.glb", "-o", "cut.glb", "--quiet")
    told = run("bake", "model.glb", "cut.glb", "-o", "baked.glb", "--resolution", 256)
    assert "skin: colour" in told and "normal" in told, told
    old, new = Model((FOLDER / "model.glb").read_bytes()), Model((FOLDER / "baked.glb").read_bytes())
    cut = Model((FOLDER / "cut.glb").read_bytes())
    for part in (0, 1):
        assert new.corners(part) == cut.corners(part)
        assert "TANGENT" not in new.document["meshes"][0]["primitives"][part]["attributes"]
    assert new.document["materials"][1]["extras"] == {"kept": 1}
    assert "extensions" not in new.document["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]
    assert new.image(0).width == new.image(1).height == new.image(2).width == 256
    d = largest_difference(old.image(0), old.corners(0), new.image(0), new.corners(0))
    assert d < 0.08, d
    moved = [[(u + 0.5, v) for u, v in t] for t in old.corners(1)]
    d = largest_difference(Image((FOLDER / "beside.png").read_bytes()), moved, new.image(2), new.corners(1))
    assert d < 0.08, d
    # Into a second set: what shows it says so.
    run("atlas", "model.glb", "-o", "cut1.glb", "--texcoord-set", 1, "--quiet")
    run("bake", "model.glb", "cut1.glb", "-o", "baked1.gltf", "--new-texcoord-set", 1, "--quiet")
    document = json.loads((FOLDER / "baked1.gltf").read_text())
    assert document["materials"][0]["normalTexture"]["texCoord"] == 1
    assert (FOLDER / "baked1.bin").exists()


def test_what_repair_leaves_out():
    """Broken faces have no place in the new atlas; others are baked."""
    text = (FOLDER / "old.obj").read_text().splitlines()
    at = next(i for i, line in enumerate(text) if line.startswith("f "))
    text[at:at] = ["v nan 0 0", "f 1/1 1/1 2/2", "f 1/1 2/2 %d/3" % (sum(line.startswith("v ") for line in text) + 1)]
    (FOLDER / "broken.obj").write_text("\n".join(text) + "\n")
    (FOLDER / "in.png").write_bytes(png(256, 96, 3, colour))
    for new in ("mended.obj", "mended.glb"):
        run("atlas", "broken.obj", "-o", new, "--repair", "--quiet")
        run("bake", "broken.obj", new, "--texture", "in.png", "-o", "out.png", "--quiet", "--stats", "stats.json")
        told = json.loads((FOLDER / "stats.json").read_text())
        assert told["left_out"] == 2 and told["textures"][0]["rms_difference"] < 0.02, told


def test_refusals():
    assert "--texture" in run("bake", "old.obj", "new.obj", "-o", "x.png", code=2)
    assert "name it so" in run("bake", "model.glb", "cut.glb", "-o", "x.png", code=2)
    points, uv, faces, uv_faces = band()
    write_obj("fewer.obj", points, uv, faces[:-1], uv_faces[:-1])
    assert "same faces" in run("bake", "old.obj", "fewer.obj", "--texture", "in.png", "-o", "x.png", code=4)
    write_obj("other.obj", points, uv, faces[::-1], uv_faces[::-1])
    assert "same faces" in run("bake", "old.obj", "other.obj", "--texture", "in.png", "-o", "x.png", code=4)
    assert "PNG, JPEG or EXR" in run("bake", "old.obj", "new.obj", "--texture", "old.obj", "-o", "x.png", code=3)
    (FOLDER / "cut.png").write_bytes((FOLDER / "in.png").read_bytes()[:200])
    run("bake", "old.obj", "new.obj", "--texture", "cut.png", "-o", "x.png", code=3)
    (FOLDER / "bare.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert "no texture coordinates" in run("bake", "bare.obj", "bare.obj", "--texture", "in.png", "-o", "x.png", code=4)
    assert not (FOLDER / "x.png").exists()


def test_names_of_tiles():
    """Files of tiles are inputs and outputs as any others: none is overwritten unless it was named."""
    points, uv, faces, uv_faces = band(12, 4)
    write_obj("two.obj", points, [(2 * u, v) for u, v in uv], faces, uv_faces)
    for tile in (1001, 1002):
        (FOLDER / f"t.{tile}.png").write_bytes(png(16, 16, 3, colour))
    (FOLDER / "whole.png").write_bytes(png(16, 16, 3, colour))
    before = {f.name: f.read_bytes() for f in FOLDER.iterdir()}
    for texture, others, said in (("t.<UDIM>.png", ["-o", "t.1002.png"], "overwrite the texture"),
                                  ("t.1002.png", ["-o", "t.<UDIM>.png"], "overwrite the texture"),
                                  ("t.<UDIM>.png", ["-o", "./t.<UDIM>.png"], "overwrite the texture"),
                                  ("t.<UDIM>.png", ["-o", "u.<UDIM>.png", "--difference", "t.<UDIM>.png"], "overwrite the texture"),
                                  ("whole.png", ["-o", "u.<UDIM>.png", "--difference", "u.1001.png"], "is also the file of"),
                                  ("whole.png", ["-o", "u.1001.png", "--difference", "u.<UDIM>.png"], "is also the file of")):
        assert said in run("bake", "two.obj", "two.obj", "--texture", texture, *others, code=2), (texture, others)
    assert before == {f.name: f.read_bytes() for f in FOLDER.iterdir()}
    for _ in range(2):  # what a run has made it makes again
        run("bake", "two.obj", "two.obj", "--texture", "t.<UDIM>.png", "-o", "u.<UDIM>.png", "--quiet")


def test_batch():
    """A batch knows the files of tiles, and the images of a model."""
    make_model()
    run("atlas", "model.glb", "-o", "cut.glb", "--quiet")
    jobs = {"tiles": ["bake", "two.obj", "two.obj", "--texture", "t.<UDIM>.png", "-o", "v.<UDIM>.png", "--quiet"],
            "model": ["bake", "model.glb", "cut.glb", "-o", "w.glb", "--quiet"]}
    (FOLDER / "jobs.jsonl").write_text("".join(json.dumps({"id": id, "args": args}) + "\n" for id, args in jobs.items()))

    def done():
        lines = (FOLDER / "results.jsonl").read_text().splitlines() if (FOLDER / "results.jsonl").exists() else []
        run("batch", "--manifest", "jobs.jsonl", "--output", "results.jsonl", "--resume", "--quiet")
        return {r["id"]: r for r in map(json.loads, (FOLDER / "results.jsonl").read_text().splitlines()[len(lines):])}

    results = done()
    assert set(results["tiles"]["inputs"]) == {"two.obj", "t.1001.png", "t.1002.png"}, results
    assert set(results["tiles"]["outputs"]) == {"v.1001.png", "v.1002.png"}, results
    assert set(results["model"]["inputs"]) == {"model.glb", "cut.glb", "beside.png"}, results
    assert done() == {}
    (FOLDER / "v.1002.png").unlink()
    assert set(done()) == {"tiles"}
    (FOLDER / "t.1001.png").write_bytes(png(16, 16, 3, lambda u, v: (u, v, 0)))
    assert set(done()) == {"tiles"}
    (FOLDER / "beside.png").write_bytes(png(128, 64, 3, lambda u, v: (u, v, 0)))
    assert set(done()) == {"model"}


def test_options_without_effect():
    obj = ["bake", "old.obj", "new.obj", "--texture", "in.png", "-o", "x.png"]
    for more in (["--green-down"], ["--texcoord-set", 1], ["--new-texcoord-set", 1]):
        assert more[0] in run(*obj, *more, code=2), more
    for more in (["--filter", "bilinear"], ["--wrap", "clamp"]):
        assert "--vertex-colours" in run("bake", "coloured.ply", "new.obj", "--vertex-colours", "-o", "x.png", *more, code=2), more
    model = ["bake", "model.glb", "cut.glb", "-o", "x.glb"]
    for more in (["--content", "data"], ["--wrap", "clamp"], ["--format", "obj"]):
        assert more[0] in run(*model, *more, code=2), more
    assert "<UDIM>" in run("bake", "two.obj", "two.obj", "--texture", "t.<UDIM>.png", "-o", "x.<UDIM>.png", "--wrap", "clamp", code=2)
    one = Model((FOLDER / "model.glb").read_bytes())
    del one.document["materials"][0]["normalTexture"]
    (FOLDER / "plain.glb").write_bytes(glb(one.document, one.binary))
    assert "none of its textures are normals" in run("bake", "plain.glb", "cut.glb", "-o", "x.glb", "--green-down", code=4)


def test_images_of_few_bytes():
    """No memory is taken for pixels that a file cannot have."""
    head = struct.pack(">IIBBBBB", 15000, 10000, 8, 2, 0, 0, 0)
    (FOLDER / "few.png").write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(99)))
                                     + chunk(b"IEND", b""))
    frame = struct.pack(">BHHB", 8, 20000, 20000, 3) + bytes([1, 17, 0, 2, 17, 0, 3, 17, 0])
    (FOLDER / "few.jpg").write_bytes(b"\xff\xd8\xff\xc0" + struct.pack(">H", 2 + len(frame)) + frame + bytes(300))
    for name in ("few.png", "few.jpg"):
        assert "damaged or cut off" in run("bake", "old.obj", "new.obj", "--texture", name, "-o", "x.png", code=3), name
    whole = png(5, 4, 3, lambda u, v: (u, v, 0.5))
    long = whole.index(b"IDAT") - 4  # a chunk that says it has a gigabyte
    (FOLDER / "few.png").write_bytes(whole[:long] + struct.pack(">I", 1 << 30) + whole[long + 4:])
    assert "damaged or cut off" in run("bake", "old.obj", "new.obj", "--texture", "few.png", "-o", "x.png", code=3)
    blank = png(1000, 600, 1, lambda u, v: (0.0,))  # as small as PNG gets
    assert len(blank) < 1000 * 600 / 800
    (FOLDER / "blank.png").write_bytes(blank)
    run("bake", "old.obj", "new.obj", "--texture", "blank.png", "-o", "x.png", "--resolution", "64", "--quiet")


def test_images_beyond_the_memory():
    """What decoding takes has a bound before it begins: a quarter of the memory there is, here of a limit of 4 GiB."""
    frame = struct.pack(">BHHB", 8, 12000, 12000, 3) + bytes([1, 17, 0, 2, 17, 0, 3, 17, 0])
    (FOLDER / "huge.jpg").write_bytes(b"\xff\xd8\xff\xc2" + struct.pack(">H", 2 + len(frame)) + frame + bytes(300000))
    for depth, name in ((8, "huge.png"), (16, "huge16.png")):
        head = struct.pack(">IIBBBBB", 16000, 16000, depth, 2, 0, 0, 0)
        (FOLDER / name).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", bytes(1600000)) + chunk(b"IEND", b""))
    for name, size in (("huge.jpg", "12000 x 12000"), ("huge.png", "16000 x 16000"), ("huge16.png", "16000 x 16000")):
        words = ["bake", "old.obj", "new.obj", "--texture", name, "-o", "x.png"]
        done = subprocess.run(["sh", "-c", 'ulimit -v 4194304; exec "$@"', "sh", str(TAUT), *words], cwd=FOLDER, capture_output=True,
                              text=True, timeout=120)
        assert done.returncode == 3, (name, done)
        assert f"is {size} pixels, which take more than 1024 MiB to decode" in done.stderr and "reduce the image" in done.stderr, done


def test_new_textures_beyond_png():
    """A texture that PNG cannot hold is refused before it is baked."""
    for words, says in ((("--bits", "8"), "3 channels of 8 bits"), (("--bits", "16"), "3 channels of 16 bits")):
        told = run("bake", "old.obj", "new.obj", "--texture", "in.png", "-o", "beyond.png", "--resolution", "32768", *words, code=4)
        assert f"32768 x 32768 texels of {says} are more than the 2 GiB that a PNG holds; give a smaller --resolution" in told, told
    assert not (FOLDER / "beyond.png").exists()


def test_exr_of_others():
    """Files of tiles, of halves and with one channel are read as they are; what cannot be is refused by name."""
    step = lambda i, j: (i + 2 * j) / 32
    (FOLDER / "probe.exr").write_bytes(exr(2, 2, {"Y": step}))
    probe = subprocess.run([str(TAUT), "bake", "old.obj", "old.obj", "--texture", "probe.exr", "-o", "y.png", "--content", "data"],
                           cwd=FOLDER, capture_output=True, text=True, timeout=120)
    if "built without EXR" in probe.stderr or "built without (tinyexr)" in probe.stderr:
        return
    assert probe.returncode == 0, probe.stderr
    colours = {"R": step, "G": lambda i, j: i / 16, "B": lambda i, j: j / 16}
    made = {}
    for name, data in (("float", exr(7, 5, colours)), ("half", exr(7, 5, colours, "e")), ("tiles", exr(7, 5, colours, "f", tiled=4)),
                       ("alpha", exr(7, 5, {**colours, "A": lambda i, j: 1.0})), ("more", exr(7, 5, {**colours, "Z": step})),
                       ("typed", exr(7, 5, colours, kind_of_part=b"scanlineimage")),
                       ("typed tiles", exr(7, 5, colours, tiled=4, kind_of_part=b"tiledimage"))):
        (FOLDER / "t.exr").write_bytes(data)
        run("bake", "old.obj", "old.obj", "--texture", "t.exr", "-o", name + ".png", "--content", "data", "--filter", "nearest",
            "--quiet")
        image = Image((FOLDER / (name + ".png")).read_bytes())
        made[name] = [image.at(i, j)[:3] for j in range(5) for i in range(7)]
    assert all(m == made["float"] for m in made.values())
    whole, tiles = exr(7, 5, colours), exr(7, 5, colours, tiled=4)
    other_tiles = lambda size, said: tiles.replace(struct.pack("<IIB", size, size, 0), said)
    for data, says in ((whole[:-40], "cannot be decoded"), (whole[:60], "is no EXR of one part"),
                       (exr(7, 5, {n: (lambda i, j: 3) for n in "RGB"}, "I"), "whole numbers"),
                       (exr(7, 5, {"X": step, "Y": step}), "no channels R, G, B"),
                       (exr(7, 5, {}), "channels is zero; save"),
                       (exr(7, 5, colours, window=(0, 0, 60000, 60000)), "damaged or cut off"),
                       (exr(7, 5, colours, window=(-2**31, 0, 2**31 - 1, 4)), "pixels; 1 to 65536 are read"),
                       (other_tiles(4, struct.pack("<IIB", 4, 2**30, 0)), "damaged or cut off"),
                       (other_tiles(4, struct.pack("<IIB", 4, 4, 1)), "has several levels"),
                       (other_tiles(4, struct.pack("<IIB", 0, 4, 0)), "has tiles without pixels"),
                       (other_tiles(4, struct.pack("<IIB", 1, 1, 0)), "has tiles outside of the image or the file"),
                       (tiles[:-200], "has tiles outside of the image or the file"),
                       (tiles.replace(b"tiledesc\0" + struct.pack("<i", 9), b"tiledesc\0" + struct.pack("<i", 8)), "no EXR of one part"),
                       *((exr(7, 5, colours, tiled=size, kind_of_part=of), "no EXR of one part")
                         for size, of in ((0, b"tiledimage"), (0, b"deepscanline"), (0, b"x"), (4, b"scanlineimage"))),
                       (exr(7, 5, colours, tiled=4, kind_of_part=b"tiledimage").replace(b"tiles\0", b"other\0"),
                        "no EXR of one part")):
        (FOLDER / "t.exr").write_bytes(data)
        assert says in run("bake", "old.obj", "old.obj", "--texture", "t.exr", "-o", "x.png", code=3), says


def test_places_that_reach_too_far():
    """Texture coordinates whose texels floats do not tell apart are refused with the triangle."""
    points, uv, faces, uv_faces = band()
    write_obj("wide.obj", points, [(1e30 * u, v) for u, v in uv], faces, uv_faces)
    told = run("bake", "wide.obj", "new.obj", "--texture", "in.png", "-o", "x.png", code=4)
    assert "wide.obj: triangle 0 reaches over 2^24 texels" in told, told


shutil.rmtree(FOLDER, ignore_errors=True)
FOLDER.mkdir(parents=True)
for name, test in list(globals().items()):
    if name.startswith("test_"):
        test()
        print("passed:", name[5:])
