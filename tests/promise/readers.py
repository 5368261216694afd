# SPDX-License-Identifier: MIT
"""Files of strangers: what can be read is read, what is replaced anyway is no obstacle, what names say stays, and memory
and time are in proportion to the bytes."""
import os
import resource
import struct

from exact import area2, exact
from program import main

N = 6
POINTS = [(i, j, (i * j) % 3 / 8) for j in range(N + 1) for i in range(N + 1)]
FACES = [f for j in range(N) for i in range(N) for a in [j * (N + 1) + i]
         for f in ((a, a + 1, a + N + 2), (a, a + N + 2, a + N + 1))]


def obj(points=POINTS, faces=FACES, before="", between="", after=""):
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    return (before + "\n".join(lines) + "\n" + between
            + "\n".join("f " + " ".join(c if isinstance(c, str) else str(c + 1) for c in f) for f in faces) + "\n" + after)


def read_obj(text):
    """Positions, texture coordinates, and the corners of faces as (v, vt) from 0, None: no vt. A line is a line."""
    v, vt, faces = [], [], []
    for line in text.decode().split("\n"):
        words = line.split()
        if words[:1] == ["v"]:
            v.append(tuple(words[1:4]))
        if words[:1] == ["vt"]:
            vt.append(exact(words[1:3]))
        if words[:1] == ["f"]:
            corners = [c.split("/") for c in words[1:]]
            faces.append([(int(c[0]) - 1, int(c[1]) - 1 if len(c) > 1 and c[1] else None) for c in corners])
    return v, vt, faces


def mapped(text):
    """How many faces are mapped; all of those must be positive."""
    _, vt, faces = read_obj(text)
    count = 0
    for face in faces:
        if any(t is None for _, t in face):
            continue
        assert area2(*(vt[t] for _, t in face)) > 0, face
        count += 1
    return count


def names_with_backslash(run):
    """A name ends with its line, so that the next one is what it says."""
    names = "mtllib a\\\no b\\\ng c\\ d\\\ns 1\\\nusemtl LIB\\Paint\\Matte\\\n"
    text = run.write("in.obj", obj(before=names, between=names))
    run("check", "in.obj")
    for command in (("unwrap",), ("atlas",), ("atlas", "--repair")):
        run(command[0], "in.obj", "-o", "out.obj", *command[1:])
        out = run.read("out.obj")
        assert mapped(out) == len(FACES)
        v, _, faces = read_obj(out)
        assert [tuple(map(float, p)) for p in v] == [tuple(map(float, p)) for p in POINTS], "no vertex is lost"
        assert [tuple(c[0] for c in f) for f in faces] == FACES
        assert out.decode().count(names) == 2
    # What has numbers goes on.
    run.write("joined.obj", obj().replace("v 1 0", "v 1 \\\n0", 1).replace("f 1 ", "f \\\n1 ", 1))
    run("unwrap", "joined.obj", "-o", "out.obj")


def old_texture_coordinates(run):
    """What a run replaces is no obstacle; where it is used it is named."""
    vts = "".join(f"vt {x / N} {y / N}\n" for x, y, _ in POINTS)
    with_vt = [[f"{c + 1}/{c + 1}" for c in f] for f in FACES]
    beyond = [*with_vt[:-1], [f"{c + 1}/999" for c in FACES[-1]]]
    files = {"nan.obj": obj(between=vts + "vt nan nan\n", faces=with_vt), "ind.obj": obj(between="vt 0 -1.#IND\n" + vts, faces=with_vt),
             "beyond.obj": obj(between=vts, faces=beyond),
             "inf.ply": "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
                        "property float s\nproperty float t\nelement face %d\nproperty list uchar int vertex_indices\n"
                        "end_header\n" % (len(POINTS), len(FACES))
                        + "".join("%g %g %g %s 0\n" % (*p, "inf" if k == 7 else k) for k, p in enumerate(POINTS))
                        + "".join("3 %d %d %d\n" % f for f in FACES)}
    run.write("pins.txt", "0 1\n")
    for name, text in files.items():
        run.write(name, text)
        for command in (("unwrap",), ("atlas",), ("atlas", "--repair")):
            told = run(command[0], name, "-o", "out.obj", *command[1:])
            assert mapped(run.read("out.obj")) == len(FACES), name
            assert "texture coordinates of the file are not used: " + name + ", line" in told.stdout + told.stderr, told
        for used in (("unwrap", "-o", "no.obj", "--start", "uv"), ("atlas", "-o", "no.obj", "--charts", "keep"),
                     ("atlas", "-o", "no.obj", "--keep-seams"), ("atlas", "-o", "no.obj", "--keep-charts", "pins.txt"), ("eval",)):
            refused = run(used[0], name, *used[1:], code=4)
            assert name + ", line" in refused.stderr and "texture coordinate" in refused.stderr, refused.stderr
            assert not os.path.exists(run.file("no.obj"))


def unused_vertices(run):
    """Vertices that no face names are ignored, wherever they are and whatever their coordinates, and stay in the file."""
    for extra in (("9", "9", "9"), ("nan", "1e300", "inf")):
        for at in (0, 20, len(POINTS)):
            points = [*POINTS[:at], extra, extra, *POINTS[at:]]
            faces = [tuple(v + 2 * (v >= at) for v in f) for f in FACES]
            run.write("in.obj", obj(points, faces))
            told = run("check", "in.obj")
            assert f"2 vertices ({at}, {at + 1}) without a triangle: ignored" in told.stdout, told.stdout
            run.write("pins.csv", f"{at},0,0\n")
            refused = run("unwrap", "in.obj", "-o", "no.obj", "--pins", "pins.csv", code=4)
            assert f"({at})" in refused.stderr, refused.stderr
            for command in ("unwrap", "atlas"):
                told = run(command, "in.obj", "-o", "out.obj")
                assert f"({at}, {at + 1})" in told.stdout + told.stderr, told
                out = run.read("out.obj")
                v, _, written = read_obj(out)
                assert len(v) == len(points) and [tuple(c[0] for c in f) for f in written] == faces
                assert mapped(out) == len(FACES)
                run("eval", "out.obj")


def unused_in_any_format(run):
    """The same of other formats and commands, and of vertices that carry more than a place."""
    extra, at = [(9.0, 9.0, 9.0), (-7.0, 0.5, 3.0)], 20
    points = [*POINTS[:at], *extra, *POINTS[at:]]
    faces = [tuple(v + 2 * (v >= at) for v in f) for f in FACES]
    words = "(20, 21)"

    # OBJ with texture coordinates and normals, some of them of nobody, too
    carried = "".join(f"vt {x / N} {y / N}\nvn 0 0 1\n" for x, y, _ in points)
    run.write("in.obj", obj(points, [[f"{c + 1}/{c + 1}/{c + 1}" for c in f] for f in faces], between=carried))
    # PLY, binary, whose vertices and faces have more
    head = ("ply\nformat binary_little_endian 1.0\ncomment made by hand\nelement vertex %d\nproperty float quality\n"
            "property double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty uchar green\n"
            "property uchar blue\nproperty list uchar short more\nelement face %d\nproperty uchar flags\n"
            "property list uchar int vertex_indices\nend_header\n") % (len(points), len(faces))
    run.write("in.ply", head.encode() + b"".join(struct.pack("<fdddBBBBhh", 0.5, *p, 1, 2, 3, 2, 7, 8) for p in points)
              + b"".join(struct.pack("<BBiii", 9, 3, *f) for f in faces))
    run.write("in.off", "OFF\n%d %d 0\n" % (len(points), len(faces)) + "".join("%r %r %r\n" % tuple(map(float, p)) for p in points)
              + "".join("3 %d %d %d\n" % f for f in faces))
    for name in ("in.obj", "in.ply", "in.off"):
        assert words in run("check", name).stdout
        run("eval", name, code=0 if name == "in.obj" else 4)
        for command in (("unwrap",), ("unwrap", "--cut"), ("atlas",), ("atlas", "--repair"), ("atlas", "--weld", "1e-6")):
            told = run(command[0], name, "-o", "out.obj", *command[1:])
            assert words in told.stdout + told.stderr, told
            out = run.read("out.obj")
            v, _, written = read_obj(out)
            assert len(v) == len(points) and [tuple(c[0] for c in f) for f in written] == faces
            assert [tuple(map(float, p)) for p in v] == [tuple(map(float, p)) for p in points]
            assert mapped(out) == len(FACES)
            run("eval", "out.obj")
        # a surface in space
        run.write("pins.csv", "".join(f"{v},{points[v][0]},{points[v][1]},{points[v][2] + lift}\n" for v, lift in ((0, 0), (N, 0), (len(points) - 1, 1))))
        told = run("deform", name, "-o", "moved.obj", "--pins", "pins.csv")
        assert words in told.stdout + told.stderr, told
        v, _, written = read_obj(run.read("moved.obj"))
        assert [tuple(c[0] for c in f) for f in written] == faces
        assert [tuple(map(float, p)) for p in v[at:at + 2]] == extra, v[at:at + 2]
        run.write("bad.csv", f"{at},0,0,0\n0,0,0,0\n")
        refused = run("deform", name, "-o", "no.obj", "--pins", "bad.csv", code=4)
        assert f"({at})" in refused.stderr or f"vertex {at}" in refused.stderr, refused.stderr

    # glTF: points that no index names
    import json
    data = b"".join(struct.pack("<fff", *p) for p in points) + b"".join(struct.pack("<HHH", *f) for f in faces)
    low, high = ([f(p[k] for p in points) for k in range(3)] for f in (min, max))
    size = 12 * len(points)
    document = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(data), "uri": "in.bin"}],
                "bufferViews": [{"buffer": 0, "byteLength": size}, {"buffer": 0, "byteOffset": size, "byteLength": len(data) - size}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", "min": low, "max": high},
                              {"bufferView": 1, "componentType": 5123, "count": 3 * len(faces), "type": "SCALAR"}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "nodes": [{"mesh": 0}],
                "scenes": [{"nodes": [0]}], "scene": 0}
    run.write("in.bin", data)
    run.write("in.gltf", json.dumps(document))
    for more in ((), ("--repair",)):
        stats = run.stats("atlas", "in.gltf", "-o", "out.glb", *more)
        assert stats["surfaces"][0]["mapped"] == len(FACES)

    # paste: in the source and in the target
    for source, target in (("in.obj", "whole.obj"), ("whole.obj", "in.obj"), ("in.obj", "in.ply")):
        run.write("whole.obj", obj())
        middle = {name: next(i for i, p in enumerate(POINTS if name == "whole.obj" else points) if p[:2] == (3, 3)) for name in (source, target)}
        told = run("paste", "--source", source, "--at", middle[source], "--radius", 1.5, "--target", target, "--onto", middle[target],
            "--scale", 0.8, "-o", "pasted.obj")
        assert words in told.stdout, told.stdout


def last_digits(run):
    """Corners that differ in the last digit are one with --repair, and a note counts their edges without it."""
    import math
    import random
    dice = random.Random(5)
    n, m = 12, 8
    ring = [[(math.sin(math.pi * j / m) * math.cos(2 * math.pi * i / n), math.sin(math.pi * j / m) * math.sin(2 * math.pi * i / n),
              math.cos(math.pi * j / m)) for i in range(n)] for j in range(m + 1)]
    cells = []
    for j in range(m):
        for i in range(n):
            a, b, c, d = ring[j][i], ring[j + 1][i], ring[j + 1][(i + 1) % n], ring[j][(i + 1) % n]
            cells += ([(a, b, c)] if j < m - 1 else []) + ([(a, c, d)] if j > 0 else [])
            if j == m - 1:
                cells[-1] = (a, ring[m][0], d)

    def text(digits, centre, radius, off):
        def number(x):
            unit = 10.0 ** (math.floor(math.log10(abs(x))) + 1 - digits) if x else 0
            return f"{x + dice.randint(-off, off) * unit:.{digits - 1}e}"
        rows = "".join("facet normal 0 0 0\nouter loop\n" + "".join(
            "vertex " + " ".join(number(radius * x + c) for x, c in zip(p, centre)) + "\n" for p in t) + "endloop\nendfacet\n" for t in cells)
        return "solid a\n" + rows + "endsolid a\n"

    run.write("exact.stl", text(9, (337, 337, 337), 50, 0))
    charts = run.stats("atlas", "exact.stl", "-o", "out.obj", "--repair")["charts"]
    for digits, centre, radius in ((6, (337, 337, 337), 50), (7, (0.01, 0.02, 0.03), 1), (8, (33, -20, 7), 5), (9, (455000, 4123000, 20), 50)):
        run.write("in.stl", text(digits, centre, radius, 1))
        told = run("atlas", "in.stl", "-o", "out.obj", code=(0, 4))  # those that are equal by chance may touch
        edges = int(told.stderr.split(" open edges lie within")[0].split()[-1])
        assert 0.8 * 3 * len(cells) < edges <= 3 * len(cells) and "--weld" in told.stderr, told.stderr
        stats = run.stats("atlas", "in.stl", "-o", "out.obj", "--repair")
        assert abs(stats["charts"] - charts) <= 4, (digits, stats["charts"], charts)
        assert mapped(run.read("out.obj")) == len(cells)
        length = told.stderr.split("--weld ")[1].split()[0]
        assert abs(run.stats("atlas", "in.stl", "-o", "out.obj", "--weld", length)["charts"] - charts) <= 4
        assert run.stats("atlas", "in.stl", "-o", "out.obj", "--weld", 0)["charts"] > len(cells) / 2
        assert "welded" in run("check", "in.stl", code=(0, 4)).stdout
    run("atlas", "in.stl", "-o", "no.obj", "--weld", -1, code=2)


def unit_square(run):
    """A square boundary comes to lie on the unit square, corners bit for bit; a circle within."""
    run.write("in.obj", obj())
    for shape in ("square", "circle"):
        run("unwrap", "in.obj", "-o", "out.obj", "--boundary", shape, "--placement", "unit-square")
        out = run.read("out.obj")
        _, vt, _ = read_obj(out)
        assert mapped(out) == len(FACES)
        assert all(0 <= x <= 1 for p in vt for x in p)
        if shape == "square":
            assert {(0, 0), (0, 1), (1, 0), (1, 1)} <= {tuple(p) for p in vt}


def left_out(run):
    """--repair goes on at what it can leave out, and counts it."""
    bad = [*POINTS, ("-1.#IND", "0", "0"), ("1", "1.#QNAN", "0"), ("1.#INF00", "0", "0"), ("0", "-1.#INF", "1")]
    extra = [(len(POINTS) + k, k, k + 1) for k in range(4)] + [(3, 4), (5,)]
    faces = [*FACES[:9], *extra, *FACES[9:]]
    off = "OFF\n%d %d 0\n" % (len(bad), len(faces)) + "".join("%s %s %s\n" % tuple(p) for p in bad)
    ply = ("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\nelement face %d\n"
           "property list uchar int vertex_indices\nend_header\n" % (len(bad), len(faces))
           + "".join("%s %s %s\n" % tuple(p) for p in bad))
    rows = "".join(" ".join(map(str, (len(f), *f))) + "\n" for f in faces)
    for name, text in (("in.obj", obj(bad, faces)), ("in.off", off + rows), ("in.ply", ply + rows)):
        run.write(name, text)
        run("atlas", name, "-o", "no.obj", code=(3, 4))
        stats = run.stats("atlas", name, "-o", "out.obj", "--repair")
        assert mapped(run.read("out.obj")) == len(FACES), name
        counts = {r["fault"]: r["count"] for r in stats["surfaces"][0]["repairs"]}
        assert counts["non_finite"] == 4 and counts["repeated_vertex"] == 2, (name, counts)


def far_pins(run):
    """Pins that are too far apart are named, by check and by what would use them."""
    run.write("in.obj", obj())
    last = len(POINTS) - 1
    run.write("tiny.obj", obj([tuple(1e-200 * x for x in p) for p in POINTS]))
    run.write("far.csv", f"0,1e308,0\n{last},-1e308,0\n")
    run.write("near.csv", f"0,8e307,0\n{last},-8e307,0\n")
    corners = (0, N, last, last - N)
    run.write("square.csv", "".join(f"{v},{x}1.2e308,{y}1.2e308\n" for v, x, y in zip(corners, "-++-", "--++")).replace("+", ""))
    for mesh, pins in (("in.obj", "far.csv"), ("in.obj", "square.csv"), ("tiny.obj", "far.csv"), ("tiny.obj", "near.csv")):
        checked = run("check", mesh, "--pins", pins, code=4)
        assert "(0" in checked.stdout + checked.stderr or "vertex 0" in checked.stdout + checked.stderr, checked.stdout
        refused = run("unwrap", mesh, "-o", "no.obj", "--pins", pins, code=4)
        assert "far" in refused.stderr and "vert" in refused.stderr, refused.stderr
    run("check", "in.obj", "--pins", "near.csv")
    run("unwrap", "in.obj", "-o", "out.obj", "--pins", "near.csv", code=(0, 6))


def digits_of_ply(run):
    """What a PLY file declares `float` is read by its digits in text, and as the float that it is in binary."""
    values = [(0.1, 0.2, 0.3), (16777217.2, 0.0, 1.30000001), (1.1, 1e-46, 0.0)]
    head = "ply\nformat %s 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" \
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    run.write("text.ply", head % "ascii" + "".join("%r %r %r\n" % v for v in values) + "3 0 1 2\n")
    run.write("binary.ply", (head % "binary_little_endian").encode() + b"".join(struct.pack("<3f", *v) for v in values)
              + struct.pack("<B3i", 3, 0, 1, 2))
    for name, expected in (("text", values), ("binary", [struct.unpack("<3f", struct.pack("<3f", *v)) for v in values])):
        run("atlas", name + ".ply", "-o", name + ".obj")
        points = read_obj(run.read(name + ".obj"))[0]
        assert [tuple(map(float, p)) for p in points] == expected, points


def encodings(run):
    """What is no text that is read is named."""
    for codec in ("utf-16", "utf-16-le", "utf-16-be"):
        for name, text in (("wide.obj", obj()), ("wide.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
                           ("wide.su2", "NDIME= 2\nNPOIN= 0\n")):
            run.write(name, text.encode(codec))
            told = run("check", name, code=3)
            assert "UTF-16; save it as UTF-8" in told.stdout + told.stderr, told
    run.write("binary.off", b"OFF BINARY\n" + struct.pack(">III", 3, 1, 0) + b"\0" * 60)
    told = run("unwrap", "binary.off", "-o", "no.obj", code=3)
    assert "binary OFF is not read; save it as text" in told.stderr


def within(run, bytes_of_memory, *arguments):
    """Runs the program with a limit on what it may have as resident memory when it ends."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    told = run(*arguments, code=(0, 4), timeout=120)
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    assert most <= max(before, bytes_of_memory // 1024), f"{most} kB for {arguments}"
    return told


def counts_times_counts(run):
    """Small files take no gigabytes, and what grows with the square of a count would not end here."""
    million = 1 << 20
    n = 4000
    points = "".join(f"{x} {y} {z}\n" for k in range(n) for x, y, z in
                     ((2 * k, 0, 0), (2 * k + 1, 0, 0), (2 * k, 1, 0), (2 * k, 0, 1)))
    ids = "".join(f"{k + 1}\n" for k in range(4 * n))
    cells = "".join(f"{k + 1} {4 * k + 1} {4 * k + 2} {4 * k + 3} {4 * k + 4}\n" for k in range(n))
    tags = " ".join(map(str, range(1, 40001)))
    run.write("tags.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 40000 " + tags
              + f" 0\n$EndEntities\n$Nodes\n1 {4 * n} 1 {4 * n}\n3 1 0 {4 * n}\n{ids}{points}$EndNodes\n"
              f"$Elements\n1 {n} 1 {n}\n3 1 4 {n}\n{cells}$EndElements\n")
    within(run, 400 * million, "check", "tags.msh")

    count = 50000
    data = struct.pack("<I", 12 * count) + b"".join(struct.pack("<fff", k, k % 2, k % 3) for k in range(count))
    places = {"a": len(data)}
    data += struct.pack("<I", count) + bytes(k % 200 for k in range(count))
    for name, numbers in (("connectivity", struct.pack("<iiii", 0, 1, 2, 5)), ("offsets", struct.pack("<i", 4)), ("types", b"\n")):
        places[name] = len(data)
        data += struct.pack("<I", len(numbers)) + numbers
    array = '<DataArray type="%s" Name="%s" format="appended" offset="%d"/>'
    run.write("shared.vtu", (
        f'<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid><Piece NumberOfPoints="{count}" '
        'NumberOfCells="1"><PointData>' + "".join(array % ("UInt8", f"a{k}", places["a"]) for k in range(2000))
        + '</PointData><Points><DataArray type="Float32" NumberOfComponents="3" format="appended" offset="0"/></Points><Cells>'
        + array % ("Int32", "connectivity", places["connectivity"]) + array % ("Int32", "offsets", places["offsets"])
        + array % ("UInt8", "types", places["types"])
        + '</Cells></Piece></UnstructuredGrid><AppendedData encoding="raw">_').encode() + data + b"</AppendedData></VTKFile>")
    within(run, 400 * million, "check", "shared.vtu")

    many = 400000
    run.write("nan.obj", obj(after="v nan 0 0\n" * many))
    run("check", "nan.obj", code=0, timeout=120)  # no face names them
    run.write("face.off", "OFF\n%d %d 0\n" % (len(POINTS), len(FACES) + many) + "".join("%g %g %g\n" % p for p in POINTS)
              + "".join("3 %d %d %d\n" % f for f in FACES) + "3 0 1 -1\n" * many)
    run("check", "face.off", code=(3, 4), timeout=120)
    run.write("elements.ply", "ply\nformat ascii 1.0\n" + "".join(f"element e{k} 0\n" for k in range(many)) + "end_header\n")
    run("check", "elements.ply", code=(3, 4), timeout=120)
    run.write("in.obj", obj())
    run.write("seams.txt", "0 1\n" * (8 * many))
    run("atlas", "in.obj", "-o", "out.obj", "--seams", "seams.txt", timeout=120)


def what_faces_are_not(run):
    """Lines lose the texture coordinates that are gone; faces of vertices that are not there, or of fewer than three, are
    no faces of OBJ; comments end with their line."""
    run.write("lines.obj", obj(before="vt 0 0\nvt 1 0\nvt 1 1\n" * 99, after="l 1/297 2/296 3/295\nsurf 0 1 0 1 1/2/3 2//4 3\n"))
    for command in ("atlas", "unwrap"):
        run(command, "lines.obj", "-o", "out.obj")
        lines = run.read("out.obj").decode().splitlines()
        assert "l 1 2 3" in lines and "surf 0 1 0 1 1//3 2//4 3" in lines, lines[-3:]
    run.write("faces.off", "OFF\n%d %d 0\n" % (len(POINTS), len(FACES) + 3) + "".join("%g %g %g\n" % p for p in POINTS)
              + "".join("3 %d %d %d\n" % f for f in FACES) + "3 0 1 -1\n2 0 1\n1 0\n")
    run("atlas", "faces.off", "-o", "out.obj", "--repair")
    assert sum(line.startswith("f ") for line in run.read("out.obj").decode().splitlines()) == len(FACES)
    run("eval", "out.obj")
    first, *rest = FACES
    text = obj(faces=[(*map(lambda v: str(v + 1), first), "# c:\\a\\"), *rest])
    run.write("comment.obj", text)
    run("atlas", "comment.obj", "-o", "out.obj")
    assert all(line.split()[1].count("/") == 1 for line in run.read("out.obj").decode().splitlines()
               if line.startswith("f "))


if __name__ == "__main__":
    main(names_with_backslash, what_faces_are_not, old_texture_coordinates, unused_vertices, unused_in_any_format, last_digits, unit_square, left_out, far_pins, digits_of_ply, encodings, counts_times_counts)
