# SPDX-License-Identifier: MIT
"""outputs.py PROGRAM FOLDER: what a run writes beside its outputs, and reads beside its inputs, is treated as these are:
nothing is overwritten that nobody named, and a batch knows it."""
import base64
import hashlib
import itertools
import json
import os
import re
import struct

from program import main

# A cube of six tetrahedra, and the same a little larger.
CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CELLS = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def tetgen(t, name, size=1.0, faces=False):
    t.write(f"{name}.node", f"{len(CORNERS)} 3 0 0\n" + "".join(
        f"{i} {' '.join(str(size * c) for c in p)}\n" for i, p in enumerate(CORNERS)))
    t.write(f"{name}.ele", f"{len(CELLS)} 4 0\n" + "".join(f"{i} {' '.join(map(str, c))}\n" for i, c in enumerate(CELLS)))
    if faces:
        t.write(f"{name}.face", "2 1\n0 0 1 3 7\n1 0 3 2 7\n")


def triangles(n, lift):
    points = [(i / n, j / n, lift * (i * i - j) / n) for j in range(n + 1) for i in range(n + 1)]
    cells = []
    for j in range(n):
        for a in range(j * (n + 1), j * (n + 1) + n):
            cells += [(a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1)]
    return points, cells


def obj(t, name, n=3, lift=0.2):
    points, cells = triangles(n, lift)
    t.write(name, "".join(f"v {x} {y} {z}\n" for x, y, z in points) +
            "".join("f " + " ".join(str(v + 1) for v in c) + "\n" for c in cells))


def gltf(t, name, data, n=3, lift=0.2):
    """A document with its buffer in the file `data`, or in itself."""
    points, cells = triangles(n, lift)
    place = b"".join(struct.pack("<3f", *p) for p in points)
    index = b"".join(struct.pack("<3H", *c) for c in cells)
    uri = data
    if data is None:
        uri = "data:application/octet-stream;base64," + base64.b64encode(place + index).decode()
    else:
        t.write(data, place + index)
    columns = list(zip(*points))
    t.write(name, json.dumps({
        "asset": {"version": "2.0"}, "buffers": [{"byteLength": len(place) + len(index), "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": len(place)}, {"buffer": 0, "byteOffset": len(place), "byteLength": len(index)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                       "min": [min(c) for c in columns], "max": [max(c) for c in columns]},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(cells), "type": "SCALAR"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}))


def state(t):
    """The files of a folder, with their contents."""
    return {name: t.read(name) for name in os.listdir(t.folder) if os.path.isfile(t.file(name))}


def refused(t, *arguments, says):
    """The run ends before it has changed anything, and says so."""
    before = state(t)
    said = t(*arguments, code=2).stderr
    assert all(word in said for word in says), said
    assert state(t) == before, set(state(t).items()) ^ set(before.items())


def tetgen_is_three_files(t):
    tetgen(t, "a")
    tetgen(t, "b", 1.5)
    t.write("pins.csv", "0,0,0,0\n")
    for name in ("b.ele", "b.node", "b.face", "./b.ele"):
        refused(t, "deform", "a.node", "--rest", "b.node", "-o", name, says=["would overwrite", "the shape at rest"])
        refused(t, "untangle", "a.ele", "--rest", "b.ele", "-o", name, says=["would overwrite", "the shape at rest"])
    for name in ("a.ele", "a.node", "a.face"):
        refused(t, "smooth", "a.node", "-o", name, says=["would overwrite", "the input"])
    os.symlink("b.node", t.file("link.json"))
    refused(t, "deform", "a.node", "--rest", "b.ele", "-o", "c.node", "--stats", "link.json", says=["would overwrite", "b.node"])

    # A face file of another mesh would be read with what is written.
    t.write("new.face", "1 1\n0 0 1 2 7\n")
    for name in ("new.node", "new.ele"):
        refused(t, "deform", "a.node", "--pins", "pins.csv", "-o", name, says=["new.face", "another mesh"])
    # Nor are other parts replaced where the mesh itself is not there.
    t.write("part.ele", "1 4 0\n0 0 1 2 3\n")
    refused(t, "deform", "a.node", "--pins", "pins.csv", "-o", "part.node", says=["part.ele", "is there already"])
    t.write("nodes.node", "1 3 0 0\n0 0 0 0\n")
    refused(t, "deform", "a.node", "--pins", "pins.csv", "-o", "nodes.ele", says=["nodes.node", "is there already"])

    # A mesh is replaced as a whole.
    tetgen(t, "faced", faces=True)
    for _ in range(2):
        t("deform", "faced.node", "--pins", "pins.csv", "-o", "whole.node", "--quiet")
    assert t.read("whole.face") == t.read("faced.face") and t.read("whole.ele") == t.read("faced.ele")
    t("deform", "a.node", "--pins", "pins.csv", "-o", "plain.ele", "--quiet")
    assert not os.path.exists(t.file("plain.face"))


def gltf_has_its_data_beside_it(t):
    gltf(t, "a.gltf", "a.bin")
    gltf(t, "b.gltf", "c.bin", lift=0.5)
    obj(t, "g.obj")
    refused(t, "atlas", "a.gltf", "b.gltf", "-o", "c.gltf", "-o", "d.gltf", says=["c.bin", "the input", "b.gltf"])
    refused(t, "atlas", "b.gltf", "-o", "c.gltf", says=["c.bin", "would overwrite"])
    refused(t, "atlas", "g.obj", "--seams", "a.bin", "-o", "a.gltf", says=["a.bin", "the file of seams"])
    refused(t, "atlas", "g.obj", "a.gltf", "-o", "a.gltf", "-o", "e.gltf", says=["a.gltf", "would overwrite the input"])
    t.write("scene.bin", b"precious")
    refused(t, "atlas", "g.obj", "-o", "scene.gltf", says=["scene.bin", "is there already", "another name"])
    refused(t, "atlas", "a.gltf", "-o", "scene.gltf", says=["scene.bin", "is there already"])
    t.write("scene.gltf", '{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 8, "uri": "other.bin"}]}')
    refused(t, "atlas", "g.obj", "-o", "scene.gltf", says=["scene.bin", "is there already"])
    refused(t, "atlas", "g.obj", "-o", "x.gltf", "--stats", "x.json", "--report", "x.html", "--picture", "x.bin", says=["must end in"])

    # What has its data in itself writes no other file.
    gltf(t, "self.gltf", None)
    os.remove(t.file("scene.gltf"))
    t("atlas", "self.gltf", "-o", "scene.gltf", "--quiet")
    assert t.read("scene.bin") == b"precious"

    # A document is replaced with its own data, in place as well.
    for _ in range(2):
        t("atlas", "g.obj", "-o", "fresh.gltf", "--quiet")
    t("atlas", "a.gltf", "-o", "a.gltf", "--quiet")
    named = json.loads(t.read("a.gltf"))["buffers"]
    assert [b["uri"] for b in named] == ["a.bin"] and len(t.read("a.bin")) == named[0]["byteLength"]


def each_option_says_what_its_files_are(t):
    """The types of options that name no file are known, and each other one is an input, which a batch lists, or an output, whose
    folder has to be there."""
    no_files = r"GROUP|NAME|PLANE|DEGREES|BYTES|FOLDER|i/N|[VRSNDTHBP]|PX|MS|0\.\.1|1\.2\.\.|1\.\.8|8\.\.8192|(?!FILE|OUT)[^|.]+(\|[^|]+)+"
    required = {"unwrap": ["in.obj", "-o", "o.obj"], "atlas": ["in.obj", "-o", "o.obj"],
                "bake": ["in.obj", "in.obj", "--texture", "in.obj", "-o", "o.png"], "untangle": ["in.mesh", "-o", "o.mesh"],
                "deform": ["in.mesh", "-o", "o.mesh"], "smooth": ["in.mesh", "-o", "o.mesh"],
                "paste": ["--source", "in.obj", "--target", "in.obj", "--onto", "0", "--at", "0", "--radius", "1", "-o", "o.obj"],
                "check": ["in.obj"], "eval": ["in.mesh"], "view": None, "batch": None, "devices": []}
    commands = re.findall(r"^  ([a-z]+) ", t("--help").stdout.split("Subcommands:")[1], re.M)
    assert set(commands) == set(required), commands
    jobs, found = [], 0
    for command in commands:
        help = t(command, "--help").stdout
        options = re.findall(r"^  (?:-\w,)?(--[\w-]+|[A-Z]+) ([^\s=:]+)", help, re.M)
        assert len(options) > 1 or command == "devices", help
        for name, kind in options:
            if re.fullmatch(no_files, kind):
                continue
            assert re.match(r"FILE|OUT|MOVE", kind), f"{command} {name} {kind}: a file or not?"
            if required[command] is None or name in required[command] or name in ("IN", "OLD", "NEW", "MESH", "PROBLEM", "--output"):
                continue  # named in each run
            found += 1
            # FILE.png|.svg, FILE, MOVE
            probe = f"{command}{found}" + (re.match(r"(?:FILE|OUT)(\.\w+)", kind) or [0, ".exr" if name == "--map" else ".txt"])[1]
            value = [name, f"group={probe}" if kind == "MOVE" else probe] if name.startswith("-") else [probe]
            extra = ["--refine"] if name == "--refined-map" else []
            own = [re.sub(r"^o\.", f"o{found}.", word) for word in required[command]]  # jobs share no output
            jobs.append({"id": probe, "args": [command, *own, *value, *extra]})
    t.write("jobs.jsonl", "".join(json.dumps(job) + "\n" for job in jobs))
    t("batch", "--manifest", "jobs.jsonl", "--output", "results.jsonl", "--quiet", code=10)
    read = written = 0
    for line in t.read("results.jsonl").decode().splitlines():
        result = json.loads(line)
        if result["id"] in result["inputs"]:
            read += 1
            continue
        arguments = [a.replace(result["id"], "missing/" + result["id"]) for a in result["args"]]
        assert "there is no folder missing" in t(*arguments, code=2).stderr, result
        written += 1
    assert read >= 8 and written >= 12, (read, written)


def a_batch_knows_all_files(t):
    """A job is done again if anything has changed that it has read, or if anything is gone that it has written."""
    tetgen(t, "a", faces=True)
    tetgen(t, "r", 1.25)
    gltf(t, "t.gltf", "t%20a.bin")
    os.rename(t.file("t%20a.bin"), t.file("t a.bin"))
    obj(t, "s.obj", 6)
    obj(t, "big.obj", 12)
    t.write("moves.csv", "0,0,0,0\n1,1.1,0,0\n3,1,1,0\n2,0,1,0\n")
    t.write("pins.csv", "6,0,1,1\n")
    t.write("seams.txt", "")
    t.write("flat.mesh", "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\nTriangles\n2\n1 2 3 1\n1 3 4 1\nEnd\n")
    jobs = {
        "tetgen": (["deform", "a.node", "--pins", "pins.csv", "--move", "faces:7=moves.csv", "-o", "b.ele", "--stats", "b.json"],
                   ["a.node", "a.ele", "a.face", "pins.csv", "moves.csv"], ["b.node", "b.ele", "b.face", "b.json"]),
        "rest": (["untangle", "r.ele", "--rest", "a.node", "-o", "u.node"],
                 ["r.node", "r.ele", "a.node", "a.ele", "a.face"], ["u.node", "u.ele"]),
        "gltf": (["atlas", "t.gltf", "-o", "o.gltf", "--report", "o.html"],
                 ["t.gltf", "t a.bin"], ["o.gltf", "o.bin", "o.html"]),
        "obj": (["atlas", "s.obj", "--seams", "seams.txt", "-o", "n.gltf"], ["s.obj", "seams.txt"], ["n.gltf", "n.bin"]),
        "paste": (["paste", "--source", "s.obj", "--target", "big.obj", "--at", "24", "--radius", "0.3", "--onto", "84", "--scale", "0.5",
                   "-o", "p.obj", "--map", "p.exr", "--resolution", "16"], ["s.obj", "big.obj"], ["p.obj", "p.exr"]),
        "refine": (["deform", "flat.mesh", "-o", "f.mesh", "--refine", "--refined-map", "f.csv"], ["flat.mesh"], ["f.mesh", "f.csv"])}
    t.write("jobs.jsonl", "".join(json.dumps({"id": id, "args": [*job[0], "--quiet"] if job[0][0] != "paste" else [*job[0], "-q"]}) + "\n"
                                  for id, job in jobs.items()))
    batch = lambda *options: t("batch", "--manifest", "jobs.jsonl", "--output", "results.jsonl", *options).stdout

    before = set(state(t))
    batch()
    results = {r["id"]: r for r in map(json.loads, t.read("results.jsonl").decode().splitlines())}
    digest = lambda name: hashlib.sha256(t.read(name)).hexdigest()
    for id, (_, read, written) in jobs.items():
        assert results[id]["inputs"] == {name: digest(name) for name in read}, results[id]["inputs"]
        assert results[id]["outputs"] == {name: digest(name) for name in written}, results[id]["outputs"]
    made = {name for _, _, written in jobs.values() for name in written}
    assert set(state(t)) - before - made == {"results.jsonl"}, "a file that no result has"
    count = len(jobs)
    assert f"{count} left out" in batch("--resume")

    def again(*ids):
        lines = len(t.read("results.jsonl").splitlines())
        batch("--resume")
        done = [json.loads(line)["id"] for line in t.read("results.jsonl").decode().splitlines()[lines:]]
        assert sorted(done) == sorted(ids), (done, ids)

    # One file of each job at a time, but the mesh that was asked for with all its parts: what is left of it is nobody's.
    for k in range(max(len(job[2]) for job in jobs.values())):
        gone = []
        for id, (arguments, _, written) in jobs.items():
            if k >= len(written):
                continue
            gone.append(id)
            mesh = arguments[arguments.index("-o") + 1]
            parts = {mesh, *(mesh.split(".")[0] + e for e in (".node", ".ele", ".face", ".bin"))} if written[k] == mesh else {written[k]}
            for name in parts & set(written):
                os.remove(t.file(name))
        again(*gone)
    for names in itertools.zip_longest(*(read for _, read, _ in jobs.values())):
        for name in set(filter(None, names)) - {"t a.bin"}:
            t.write(name, t.read(name) + b"\n")
        again(*(id for id, job in jobs.items() if (set(names) - {"t a.bin"}) & set(job[1])))
    data = bytearray(t.read("t a.bin"))
    data[8:12] = struct.pack("<f", 0.125)  # z of the first point
    t.write("t a.bin", bytes(data))
    again("gltf")
    os.remove(t.file("b.face"))
    again("tetgen")
    t.write("r.face", "1 1\n0 0 1 3 7\n")  # the input has a part more
    again("rest")


if __name__ == "__main__":
    main(tetgen_is_three_files, gltf_has_its_data_beside_it, each_option_says_what_its_files_are, a_batch_knows_all_files)
