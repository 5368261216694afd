# SPDX-License-Identifier: MIT
"""What `taut atlas` and `taut unwrap` write of surfaces, judged by exact arithmetic: no triangle turned over, none over
another, polygons convex where they are convex in space, flat faces with holes as they are."""
import json
import math
import os
import random
import struct
import subprocess

import exact
from program import main


# ---------------------------------------------------------------- files

def obj(points, faces, texcoords=None):
    """Text of an OBJ file; faces name vertices from 0."""
    text = "".join("v %r %r %r\n" % tuple(map(float, p)) for p in points)
    return text + "".join("f " + " ".join(str(v + 1) for v in f) + "\n" for f in faces)


def read_obj(text):
    """Points, faces and, by corner of these, coordinates in the map (None: none)."""
    points, coords, faces, maps = [], [], [], []
    for line in text.splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            points.append(tuple(map(float, rest[:3])))
        elif word == "vt":
            coords.append((float(rest[0]), float(rest[1])))
        elif word == "f":
            corners = [c.split("/") for c in rest]
            faces.append([int(c[0]) - 1 for c in corners])
            maps.append([coords[int(c[1]) - 1] if len(c) > 1 and c[1] else None for c in corners])
    return points, faces, maps


def read_glb(data):
    """The triangles of all primitives, and by corner of these their coordinates in the map, v upwards."""
    length = struct.unpack("<I", data[12:16])[0]
    document = json.loads(data[20:20 + length])
    buffer = data[20 + length + 8:]
    types = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}

    def values(number, width):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        kind = types[accessor["componentType"]]
        step = view.get("byteStride", width * struct.calcsize(kind))
        return [struct.unpack_from("<%d%s" % (width, kind), buffer, begin + step * i)
                for i in range(accessor["count"])]

    faces, maps = [], []
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            uv = values(primitive["attributes"]["TEXCOORD_0"], 2)
            count = document["accessors"][primitive["attributes"]["POSITION"]]["count"]
            order = [i[0] for i in values(primitive["indices"], 1)] if "indices" in primitive else range(count)
            for k in range(0, len(order), 3):
                faces.append(list(order[k:k + 3]))
                maps.append([uv[i] for i in order[k:k + 3]])
    return faces, maps


# ---------------------------------------------------------------- the judge

SHIFT = 1100


def whole(x):
    """A double as a whole number of the smallest one, so that sums and products are exact and quick."""
    n, d = x.as_integer_ratio()
    return n * ((1 << SHIFT) // d)


def place(p, downwards=False):
    """A point of a map. Of glTF, whose v goes down, that is the mirror image."""
    return (whole(p[0]), -whole(p[1]) if downwards else whole(p[1]))


def judge(triangles, downwards=False):
    """Numbers of triangles that are not positive, and pairs of triangles that overlap."""
    placed = [[place(p, downwards) for p in t] for t in triangles]
    flipped = [i for i, t in enumerate(placed) if exact.area2(*t) <= 0]
    return flipped, exact.overlaps(placed)


def turns(polygon):
    n = len(polygon)
    return [exact.area2(polygon[k], polygon[(k + 1) % n], polygon[(k + 2) % n]) for k in range(n)]


def require_valid(triangles, downwards=False):
    flipped, pairs = judge(triangles, downwards)
    assert not flipped, f"{len(flipped)} triangles turned over: {flipped[:5]}"
    assert not pairs, f"{len(pairs)} pairs overlap: {pairs[:5]}"


def sub(p, q):
    return [a - b for a, b in zip(p, q)]


def dot(p, q):
    return sum(a * b for a, b in zip(p, q))


def cross(p, q):
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def convex_in_space(points, face):
    """Whether a face is convex as it is seen along its normal, with corners that are not nearly straight."""
    corners = [points[v] for v in face]
    n, normal = len(face), [0, 0, 0]
    for k in range(1, n - 1):
        normal = [a + b for a, b in zip(normal, cross(sub(corners[k], corners[0]), sub(corners[k + 1], corners[0])))]
    for k in range(n):
        a, b = sub(corners[(k + 1) % n], corners[k]), sub(corners[(k + 2) % n], corners[(k + 1) % n])
        if dot(cross(a, b), normal) <= 2e-6 * math.sqrt(dot(a, a) * dot(b, b) * dot(normal, normal)):
            return False
    return True


def concave(points, faces, maps):
    """Faces of more than three corners that are convex in space and not in the map."""
    return [f for f, (face, uv) in enumerate(zip(faces, maps))
            if len(face) > 3 and len(set(face)) == len(face) and convex_in_space(points, face)
            and min(turns([place(p) for p in uv])) <= 0]


# ---------------------------------------------------------------- surfaces

def grid(n, m, height, lift=0.0):
    """n times m quads over the plane."""
    points = [(i, j, height(i, j) + lift) for j in range(m + 1) for i in range(n + 1)]
    faces = [[j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i]
             for j in range(m) for i in range(n)]
    return points, faces


def triangulated(faces):
    return [t for f in faces for t in ([f[0], f[1], f[2]], [f[0], f[2], f[3]])]


def joined(*parts):
    points, faces = [], []
    for some, own in parts:
        faces += [[v + len(points) for v in f] for f in own]
        points += some
    return points, faces


def turned(points, angle, axis=(2 / 7, 3 / 7, 6 / 7)):
    c, s = math.cos(angle), math.sin(angle)
    return [tuple(c * a + s * b + (1 - c) * dot(axis, p) * x
                  for a, b, x in zip(p, cross(axis, p), axis)) for p in points]


def ring(n, gap, radius=1.0, width=0.3):
    """A flat ring of n quads, cut, whose ends are `gap` apart."""
    points = []
    for k in range(n + 1):
        a = (2 * math.pi - gap / radius) * k / n
        points += [(r * math.cos(a), r * math.sin(a), 0.0) for r in (radius, radius + width)]
    return points, triangulated([[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2] for k in range(n)])


def fan_of_needles(n, length, thickness):
    """Triangles around a line, each `thickness` high."""
    points = [(0.0, 0.0, 0.0)]
    for k in range(n + 1):
        points.append((length, k * thickness, 0.0))
    return points, [[0, k, k + 1] for k in range(1, n + 1)]


def needles(n, length, thickness):
    """A stack of strips, each `thickness` high."""
    points = [(x, k * thickness, 0.0) for k in range(n + 1) for x in (0.0, length)]
    return points, triangulated([[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2] for k in range(n)])


def small_cap(size, where, n=6):
    points, faces = grid(n, n, lambda i, j: 0.1 * math.sin(i) * j)
    return [tuple(size * x + w for x, w in zip(p, where)) for p in points], triangulated(faces)


def scene():
    """A large face, rings that nearly close, needles, and parts a billion times smaller."""
    large = [(x, y, -5.0) for x, y in ((0, 0), (7, 0.3), (7.2, 6), (0.1, 6.4))], [[0, 1, 2], [0, 2, 3]]
    parts = [large]
    for k, gap in enumerate((1e-9, 1e-8, 1e-7, 1e-12)):
        points, faces = ring(24 + 8 * k, gap, radius=0.5 + 0.1 * k)
        parts.append((turned([(x, y, z + 3 * k) for x, y, z in points], 0.7 * k), faces))
    for k, thin in enumerate((1e-6, 1e-8, 1e-9, 1e-10)):
        points, faces = needles(9, 2.0, thin)
        parts.append((turned([(x, y, z + 20 + k) for x, y, z in points], 0.3 + k), faces))
        points, faces = fan_of_needles(7, 1.5, thin)
        parts.append((turned([(x, y, z + 30 + k) for x, y, z in points], 1.1 * k), faces))
    for k, size in enumerate((1e-6, 1e-8, 1e-10)):
        parts.append(small_cap(size, (40.0 + k, 0.0, 0.0)))
    return joined(*parts)


# ---------------------------------------------------------------- the cases

def rounding_is_settled(taut):
    """What rounding to floats turns over or makes meet is mended, whatever the angle of the charts."""
    points, faces = scene()
    taut.write("scene.obj", obj(points, faces))
    for options in ([], ["--no-rotation"], ["--resolution", "8192"], ["--udim", "15", "--padding", "0"]):
        stats = taut.stats("atlas", "scene.obj", "-o", "scene.glb", *options)
        assert stats["flipped"] == 0 and stats["overlaps"] == 0
        mapped = read_glb(taut.read("scene.glb"))[1]
        assert len(mapped) == len(faces)
        require_valid(mapped, downwards=True)
        taut.stats("atlas", "scene.obj", "-o", "scene.out.obj", *options)
        require_valid(read_obj(taut.read("scene.out.obj").decode())[2])


def doublets(taut):
    """Quads around a vertex of two faces, repeated vertices, bent quads and polygons: none ends a run."""
    points, faces = grid(5, 5, lambda i, j: 0.4 * math.sin(i * 1.3) * math.cos(0.6 * j))
    for number, quad in enumerate((7, 12, 18)):
        a, b, c, d = faces[quad]
        v = len(points)
        points.append(tuple(sum(points[k][x] for k in (a, b, c, d)) / 4 + (0.5 * number if x == 2 else 0.03)
                            for x in range(3)))
        if number == 1:
            faces[quad:quad + 1] = [[b, c, d, v], [b, v, d, a]]
        else:
            faces[quad:quad + 1] = [[a, b, c, v], [a, v, c, d]]
    faces[0] = [faces[0][0], faces[0][1], faces[0][1], faces[0][2], faces[0][3], faces[0][0]]
    points[28] = (points[28][0], points[28][1], 4.0)  # quads bent by more than a right angle
    text = obj(points, faces)
    taut.write("doublets.obj", text)
    for command in (["atlas"], ["atlas", "--repair"], ["unwrap"]):
        taut(command[0], "doublets.obj", "-o", "out.obj", *command[1:])
        _, written, maps = read_obj(taut.read("out.obj").decode())
        assert written == faces
        assert all(p is not None for uv in maps for p in uv)
        taut("eval", "out.obj")


def forced_diagonals(taut):
    """A concave polygon is cut along its one inner diagonal even where that is an edge of another face."""
    dart = [(0, 1, 0), (-1, -1, 0), (0, -0.5, 0), (1, -1, 0)]
    leaf = obj(dart, [(0, 1, 2, 3), (0, 2, 1), (0, 3, 2)])
    taut.write("leaf.obj", leaf)
    taut("atlas", "leaf.obj", "-o", "out.obj", code=4)
    fin = obj(dart + [(0, 0, 1)], [(0, 1, 2, 3), (0, 2, 4)])
    taut.write("fin.obj", fin)
    taut("atlas", "fin.obj", "-o", "out.obj", "--repair")
    _, faces, maps = read_obj(taut.read("out.obj").decode())
    distances = lambda face: [math.dist(face[i], face[j]) for i in range(4) for j in range(i)]
    ratios = [a / b for a, b in zip(distances(maps[0]), distances([p[:2] for p in dart]))]
    assert max(ratios) < min(ratios) * (1 + 1e-6), ratios  # it comes out as it is
    require_valid([[maps[0][k] for k in t] for t in ((0, 1, 2), (0, 2, 3))])


def parted_polygons(taut):
    """A polygon of which repair leaves pieces apart has no place in the map, and is told."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 0), (-1, -1, 0), (3, 0, 0), (4, 0, 0), (3, 1, 0)]
    taut.write("eight.obj", obj(points, [(0, 1, 2, 0, 3, 4), (5, 6, 7)]))
    run = taut("atlas", "eight.obj", "-o", "out.obj", "--repair")
    _, faces, maps = read_obj(taut.read("out.obj").decode())
    assert [None in m for m in maps] == [True, False], maps
    assert "1 face (0) of which repair has left pieces apart" in run.stderr, run.stderr


def what_repair_turns_is_told(taut):
    """A triangle that repair turns over stays as the file has it: its image is mirrored, and the run says so. Reasons
    have the numbers of the file."""
    points, faces = grid(6, 6, lambda i, j: 0.3 * math.sin(i))
    faces = triangulated(faces)
    faces[31] = faces[31][::-1]
    taut.write("turned.obj", obj(points, faces))
    for name in ("out.obj", "out.glb"):
        run = taut("atlas", "turned.obj", "-o", name, "--repair")
        assert "1 triangle (31) turned over by --repair" in run.stderr, run.stderr
    assert json.loads(taut("eval", "out.obj", "--json").stdout)["flipped"] == 1
    taut.write("folded.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 1 0.2\n"
               "f 1/1 1/1 2/2\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
    error = taut("atlas", "folded.obj", "-o", "x.obj", "--repair", "--charts", "pack", code=6).stderr
    assert "the chart of triangle 0 is folded" in error and "as the files number triangles: 1" in error, error


def what_has_no_place_is_left_out(taut):
    """eval judges the faces that have a place in the map, and names the others."""
    points, faces = grid(3, 3, lambda i, j: 0.0)
    lines = ["vt %r %r" % (p[0] / 4, p[1] / 4) for p in points]
    lines += ["f " + " ".join(f"{v + 1}/{v + 1}" if k != 4 else str(v + 1) for v in f) for k, f in enumerate(faces)]
    taut.write("some.obj", obj(points, []) + "\n".join(lines) + "\n")
    run = taut("eval", "some.obj", "--json")
    said = json.loads(run.stdout)
    assert said["left_out"] == 2 and said["flipped"] == 0 and said["faces"] == 16, said
    assert "2 triangles (8, 9) without texture coordinates: left out" in taut("eval", "some.obj").stderr


def crossing_slits(taut):
    """A polygon whose slits cross at a corner is no surface: --repair leaves it out and says so, and maps the rest."""
    flat, face = slit(circle(20, 4, 0, 0), [circle(6, 0.5, 2 * math.cos(a), 2 * math.sin(a), True) for a in (1, 3.1, 5.2)])
    points = [(x, y, 0.0) for x, y in flat] + [(9, 0, 0), (10, 0, 0), (9, 1, 0)]
    n = len(flat)
    taut.write("crossing.obj", obj(points, [face, [n, n + 1, n + 2]]))
    taut("atlas", "crossing.obj", "-o", "out.obj", code=4)
    run = taut("atlas", "crossing.obj", "-o", "out.obj", "--repair")
    _, faces, maps = read_obj(taut.read("out.obj").decode())
    assert [None in m for m in maps] == [True, False] and "1 face (0) of which repair has left pieces apart" in run.stderr, run.stderr


def slit(outer, holes):
    """One face of an outline and holes, which it runs into along slits from its first corner."""
    points, face = list(outer), list(range(len(outer)))
    for hole in holes:
        first = len(points)
        points += hole
        face += [0] + [first + k % len(hole) for k in range(len(hole) + 1)]
    return points, face


def circle(n, radius, x, y, clockwise=False):
    sign = -1 if clockwise else 1
    return [(x + radius * math.cos(sign * 2 * math.pi * k / n), y + radius * math.sin(sign * 2 * math.pi * k / n))
            for k in range(n)]


def faces_with_holes(taut):
    """Flat faces whose outline runs in to holes along slits come out as they are, from every format."""
    cases = [slit([(0, 0), (4, 0), (4, 4), (0, 4)], [[(1, 1), (1, 3), (3, 3), (3, 1)]]),
             slit([(0, 0), (9, 0), (9, 2), (0, 2)], [[(0.5, 0.5), (0.6, 1.8), (8, 1.5)]]),
             slit(circle(40, 3, 0, 0), [[(x + 1, y) for x, y in circle(60, 0.4, 0, y, True)] for y in (-1.2, 0, 1.2)])]
    for flat, face in cases:
        count = len(flat)
        points = turned([(x, y, 0.0) for x, y in flat], 1.0) + turned([(flat[0][0], flat[0][1], -2.0),
                                                                      (flat[1][0], flat[1][1], -2.0)], 1.0)
        faces = [face, [0, count, count + 1, 1]]
        corners = "".join("%r %r %r\n" % p for p in points)
        lists = "".join(" ".join(map(str, [len(f)] + f)) + "\n" for f in faces)
        taut.write("slit.obj", obj(points, faces))
        taut.write("slit.off", f"OFF\n{len(points)} 2 0\n" + corners + lists)
        taut.write("slit.ply", "ply\nformat ascii 1.0\nelement vertex %d\nproperty double x\nproperty double y\n"
                   "property double z\nelement face 2\nproperty list int int vertex_indices\nend_header\n"
                   % len(points) + corners + lists)
        for name in ("slit.obj", "slit.off", "slit.ply"):
            for command in (["atlas"], ["atlas", "--repair"], ["unwrap", "--holes"]):
                taut(command[0], name, "-o", "out.obj", *command[1:])
                _, written, maps = read_obj(taut.read("out.obj").decode())
                assert written == faces, (name, written)
                uv, scale = maps[0], []
                for k in range(len(face)):
                    a, b = face[k], face[(k + 1) % len(face)]
                    scale.append(math.dist(uv[k], uv[(k + 1) % len(face)]) / math.dist(points[a], points[b]))
                assert max(scale) < 1.0001 * min(scale), (name, command, min(scale), max(scale))
                area = abs(sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(uv, uv[1:] + uv[:1]))) / 2
                inside = abs(sum(p[0] * q[1] - p[1] * q[0] for p, q in
                                 zip([flat[v] for v in face], [flat[v] for v in face[1:] + face[:1]]))) / 2
                assert abs(area / inside - scale[0] ** 2) < 1e-3 * scale[0] ** 2


def polygons_stay_convex(taut):
    """Quads that are convex in space are so in the map, in whichever way they are cut; what is not is counted."""
    lot = random.Random(5)
    for n, rough in ((12, 2.5), (26, 2.1)):
        points, faces = grid(n, n, lambda i, j: rough * lot.random())
        points = [(x + 0.3 * lot.uniform(-1, 1), y + 0.3 * lot.uniform(-1, 1), z) for x, y, z in points]
        taut.write("rough.obj", obj(points, faces))
        for command in (["atlas"], ["unwrap"], ["atlas", "--max-distortion", "8"]):
            stats = taut.stats(command[0], "rough.obj", "-o", "out.obj", *command[1:])
            text = taut.read("out.obj").decode()
            found = concave(*read_obj(text))
            assert len(found) == stats["concave_polygons"], (command, len(found), stats["concave_polygons"])
            assert not found, (command, len(found))
            said = json.loads(taut("eval", "out.obj", "--json").stdout)
            assert said["concave_polygons"] == len(found) and said["flipped"] == 0


def pinned_charts_hold(taut):
    """The coordinates of pinned charts are those of the file, text for text."""
    points, faces = grid(9, 9, lambda i, j: 2 * math.sin(i) * math.cos(0.7 * j))
    taut.write("in.obj", obj(points, faces))
    taut("atlas", "in.obj", "-o", "first.obj", "--max-distortion", "4.01")
    _, _, before = read_obj(taut.read("first.obj").decode())
    taut.write("pin.txt", "0\n40\n")
    taut("atlas", "first.obj", "-o", "second.obj", "--keep-charts", "pin.txt")
    _, _, after = read_obj(taut.read("second.obj").decode())
    assert all([repr(x) for x in p] == [repr(x) for x in q]
               for f in (0, 40) for p, q in zip(before[f], after[f]))
    require_valid([[uv[0], uv[k], uv[k + 1]] for uv in after for k in (1, 2) if min(turns([place(p) for p in uv])) > 0])


if __name__ == "__main__":
    main(rounding_is_settled, doublets, forced_diagonals, parted_polygons, what_repair_turns_is_told, what_has_no_place_is_left_out, crossing_slits, faces_with_holes, polygons_stay_convex, pinned_charts_hold)
