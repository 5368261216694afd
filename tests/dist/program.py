# SPDX-License-Identifier: MIT
"""program.py CASE TAUT_MPI TAUT MPIEXEC FOLDER: taut-mpi as a user meets it, under mpirun, in an emptied FOLDER."""
import json
import math
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import time


class bar:
    """A bar of n x n x 4n cubes of six tetrahedra, jittered inside: 1 x 1 x 4."""

    def __init__(self, n):
        r = random.Random(1)
        self.points, self.cells, self.end, self.start = [], [], [], []
        for k in range(4 * n + 1):
            for j in range(n + 1):
                for i in range(n + 1):
                    p = [i / n, j / n, k / n]
                    for c in range(3):
                        if 0 < p[c] < (4 if c == 2 else 1):
                            p[c] += r.uniform(-0.15, 0.15) / n
                    if k == 0:
                        self.start.append(len(self.points))
                    if k == 4 * n:
                        self.end.append(len(self.points))
                    self.points.append(p)

        def at(i, j, k):
            return (k * (n + 1) + j) * (n + 1) + i

        for k in range(4 * n):
            for j in range(n):
                for i in range(n):
                    for o, order in enumerate([(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]):
                        p = [i, j, k]
                        t = [at(*p)]
                        for axis in order:
                            p[axis] += 1
                            t.append(at(*p))
                        if o >= 3:
                            t[1], t[2] = t[2], t[1]
                        self.cells.append(t)

    def medit(self, path):
        with open(path, "w") as f:
            ref = {v: 1 for v in self.start} | {v: 2 for v in self.end}
            f.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(self.points)}\n")
            f.writelines("%.17g %.17g %.17g %d\n" % (*p, ref.get(v, 0)) for v, p in enumerate(self.points))
            f.write(f"Tetrahedra\n{len(self.cells)}\n")
            f.writelines("%d %d %d %d 0\n" % tuple(v + 1 for v in t) for t in self.cells)
            f.write("End\n")

    def faces(self, vertices):
        """Triangles whose corners are all among these."""
        wanted = set(vertices)
        for t in self.cells:
            inside = [v for v in t if v in wanted]
            if len(inside) == 3:
                yield inside

    def su2(self, path):
        with open(path, "w") as f:
            f.write(f"NDIME= 3\nNELEM= {len(self.cells)}\n")
            f.writelines("10 %d %d %d %d %d\n" % (*t, k) for k, t in enumerate(self.cells))
            f.write(f"NPOIN= {len(self.points)}\n")
            f.writelines("%.17g %.17g %.17g %d\n" % (*p, k) for k, p in enumerate(self.points))
            f.write("NMARK= 2\n")
            for name, group in (("start", self.start), ("end", self.end)):
                faces = list(self.faces(group))
                f.write(f"MARKER_TAG= {name}\nMARKER_ELEMS= {len(faces)}\n")
                f.writelines("5 %d %d %d\n" % tuple(face) for face in faces)

    def vtu(self, path):
        with open(path, "w") as f:
            f.write('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>\n')
            f.write(f'<Piece NumberOfPoints="{len(self.points)}" NumberOfCells="{len(self.cells)}">\n')
            f.write('<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">\n')
            f.writelines("%.17g %.17g %.17g\n" % tuple(p) for p in self.points)
            f.write('</DataArray></Points><Cells><DataArray type="Int32" Name="connectivity" format="ascii">\n')
            f.writelines("%d %d %d %d\n" % tuple(t) for t in self.cells)
            f.write('</DataArray><DataArray type="Int32" Name="offsets" format="ascii">\n')
            f.writelines("%d\n" % (4 * k + 4) for k in range(len(self.cells)))
            f.write('</DataArray><DataArray type="UInt8" Name="types" format="ascii">\n')
            f.writelines("10\n" for _ in self.cells)
            f.write("</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n")

    def gmsh(self, path):
        with open(path, "w") as f:
            f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(self.points)}\n")
            f.writelines("%d %.17g %.17g %.17g\n" % (k + 1, *p) for k, p in enumerate(self.points))
            f.write(f"$EndNodes\n$Elements\n{len(self.cells)}\n")
            f.writelines("%d 4 2 1 1 %d %d %d %d\n" % (k + 1, *(v + 1 for v in t)) for k, t in enumerate(self.cells))
            f.write("$EndElements\n")

    def tetgen(self, name):
        with open(name + ".node", "w") as f:
            f.write(f"{len(self.points)} 3 0 0\n")
            f.writelines("%d %.17g %.17g %.17g\n" % (v, *p) for v, p in enumerate(self.points))
        with open(name + ".ele", "w") as f:
            f.write(f"{len(self.cells)} 4 0\n")
            f.writelines("%d %d %d %d %d\n" % (k, *t) for k, t in enumerate(self.cells))

    def pins(self, path, where):
        with open(path, "w") as f:
            f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, *self.points[v]) for v in self.start)
            f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, *where(self.points[v])) for v in self.end)


def stretched(p):
    return (p[0], p[1], 1.5 * p[2])


def command(*arguments, processes=2):
    return [mpiexec, "-n", str(processes), taut_mpi, *arguments]


def run(*arguments, code=0, processes=2):
    """What was printed, by place; it ended with `code`."""
    done = subprocess.run(command(*arguments, processes=processes), capture_output=True, text=True, timeout=200)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    return done.stdout, done.stderr


def fails(*arguments, code, word, processes=2):
    """It fails with one message that says `word`, and writes nothing."""
    before = sorted(os.listdir("."))
    out, err = run(*arguments, code=code, processes=processes)
    messages = [line for line in err.splitlines() if line.startswith("taut-mpi: error:")]
    assert len(messages) == 1 and word in messages[0], err
    assert out == "", out
    assert sorted(os.listdir(".")) == before, os.listdir(".")


def serial(*arguments):
    done = subprocess.run([taut, *arguments], capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, (done.stdout, done.stderr)
    return done.stdout


def stats(path):
    with open(path) as f:
        return json.load(f)


def near(a, b, digits):
    assert abs(a - b) <= 10.0**-digits * abs(b), (a, b)


def points_of(path):
    """Of a MEDIT file."""
    with open(path) as f:
        lines = f.read().split("\n")
    first = lines.index("Vertices") + 2
    return [tuple(map(float, line.split()[:3])) for line in lines[first:first + int(lines[first - 1])]]


def case_deform():
    b = bar(4)
    b.medit("bar.mesh")
    b.pins("pins.csv", stretched)
    serial("deform", "bar.mesh", "--pins", "pins.csv", "-o", "one.mesh", "--stats", "one.json")
    one = stats("one.json")
    for processes in (1, 2, 3):
        out, err = run("deform", "bar.mesh", "--pins", "pins.csv", "-o", "all.mesh", "--stats", "all.json",
                       processes=processes)
        assert err == "", err
        assert "converged" in out and out.count("energy") == 1, out
        found = stats("all.json")
        near(found["energy"], one["energy"], 8)  # the serial one computes in float
        assert abs(found["iterations"] - one["iterations"]) <= 1
        assert found["inverted"] == 0 and found["pins_held"] and found["converged"]
        assert len(found["processes"]) == processes
        assert sum(p["vertices"] for p in found["processes"]) == len(b.points)
        for p in found["processes"]:
            assert p["peak_memory_bytes"] > 0 and p["seconds"]["setup"] > 0
            assert processes == 1 or p["sent"]["solve"]["messages"] > 0
        x = points_of("all.mesh")
        assert all(x[v] == tuple(b.points[v]) for v in b.start)
        assert all(x[v] == stretched(b.points[v]) for v in b.end)
        serial("check", "all.mesh")
    run("check", "all.mesh")
    assert stats_of_check("all.mesh")["valid"]
    run("deform", "bar.mesh", "--pins", "pins.csv", "-o", "quiet.mesh", "--quiet", "--preconditioner", "gamg",
        "--energy", "neo-hookean")
    run("deform", "bar.mesh", "--pins", "pins.csv", "-o", "own.mesh", "--petsc", "-pc_type gamg", "--stats", "own.json")
    near(stats("own.json")["energy"], one["energy"], 8)


def stats_of_check(path, code=0):
    return json.loads(run("check", path, "--json", code=code)[0])


def case_formats():
    b = bar(3)
    b.su2("bar.su2")
    b.medit("bar.mesh")
    b.vtu("bar.vtu")
    b.gmsh("bar.msh")
    b.pins("pins.csv", stretched)
    with open("end.csv", "w") as f:
        f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, *stretched(b.points[v])) for v in b.end)
    energies = []
    for name in ("bar.mesh", "bar.vtu", "bar.msh", "bar.su2"):
        out = "out" + os.path.splitext(name)[1]
        run("deform", name, "--pins", "pins.csv", "-o", out, "--stats", "s.json")
        energies.append(stats("s.json")["energy"])
        serial("check", out)
    # Groups of a file, by name, by a file of places, and by a motion.
    for move in ("end=end.csv", "end:translate:0,0,2"):
        run("deform", "bar.su2", "--fix", "start", "--move", move, "-o", "group.su2", "--stats", "s.json")
        energies.append(stats("s.json")["energy"])
    with open("bar.su2") as f, open("group.su2") as g:
        assert f.read().split("NMARK=")[1] == g.read().split("NMARK=")[1]  # the markers are the same text
    for e in energies:
        near(e, energies[0], 9)
    # A shape that is no longer that at rest.
    run("deform", "out.mesh", "--rest", "bar.mesh", "--pins", "pins.csv", "-o", "rest.mesh", "--stats", "s.json")
    near(stats("s.json")["energy"], energies[0], 8)


def case_ranges():
    """All processes read and write; the file is the same text with other coordinates."""
    b = bar(3)
    b.su2("bar.su2")
    b.medit("bar.mesh")
    with open("end.csv", "w") as f:
        f.write("vertex,x,y,z\n")
        f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, *stretched(b.points[v])) for v in b.end)
    energies = []
    for name, fixed, moved in (("bar.su2", "start", "end"), ("bar.mesh", "vertices:1", "vertices:2")):
        for processes in (1, 3):
            out = "out" + os.path.splitext(name)[1]
            run("deform", name, "--fix", fixed, "--move", moved + "=end.csv", "-o", out, "--stats", "s.json",
                processes=processes)
            s = stats("s.json")
            assert s["read"] == "by ranges", s["read"]
            assert s["pins"] == len(b.start) + len(b.end) and s["quality"]["worst_ids"] is not None
            energies.append(s["energy"])
            with open(name) as f, open(out) as g:
                for old, new in zip(f.read().split("\n"), g.read().split("\n"), strict=True):
                    assert old == new or len(old.split()) == 4, (old, new)
            serial("check", out)
    for e in energies:
        near(e, energies[0], 9)
    # What moves nothing changes nothing, bit for bit.
    with open("all.csv", "w") as f:
        f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, *p) for v, p in enumerate(b.points))
    run("deform", "bar.su2", "--pins", "all.csv", "-o", "same.su2")
    with open("bar.su2") as f, open("same.su2") as g:
        assert f.read() == g.read()
    # Faults of places, found at the process that has the vertex.
    fails("deform", "bar.su2", "--move", "start=end.csv", "-o", "x.su2", code=4, word="is not in group start")
    fails("deform", "bar.su2", "--fix", "end", "--move", "end:translate:0,0,1", "-o", "x.su2", code=4,
          word="two places")
    fails("deform", "bar.su2", "--move", "end:fly:1", "-o", "x.su2", code=2, word="GROUP=FILE.csv")
    with open("bad.csv", "w") as f:
        f.write("1,2,3\n" + "4,x,5,6\n")
    fails("deform", "bar.su2", "--pins", "bad.csv", "-o", "x.su2", code=3, word="bad.csv, line 1")


def killed_at(task, checkpoint):
    """Kills one process of a run once its checkpoint is there; returns whether it had not ended before."""
    began = subprocess.Popen(command(*task), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while began.poll() is None and not os.path.exists(checkpoint):
        time.sleep(0.02)
    for process in children(began.pid)[:1]:
        os.kill(int(process), signal.SIGKILL)
    return began.wait(timeout=100) != 0


def listed(folder):
    """Makes a checkpoint of a case: with a list of its files."""
    files = [os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(folder) for name in names]
    with open(folder + "/taut-checkpoint", "w") as f:
        f.write("files of a checkpoint of taut-mpi, which removes them:\n" + "".join(name + "\n" for name in files))


def case_checkpoint():
    b = bar(8)
    b.su2("bar.su2")
    b.pins("pins.csv", lambda p: (p[0], p[1], 0.4 * p[2]))  # it buckles, which takes many steps
    task = ("deform", "bar.su2", "--pins", "pins.csv", "-o", "out.su2", "--checkpoint", "so-far.su2",
            "--checkpoint-interval", "1", "--stats", "s.json")
    if killed_at(task, "so-far.su2"):
        serial("check", "so-far.su2")
        os.remove("so-far.su2")
    # It goes on from what is there, with another number of processes, and removes it.
    b.pins("pins.csv", stretched)
    plain = task[:task.index("--checkpoint")] + ("--stats", "s.json")
    run(*plain)
    steps = stats("s.json")["iterations"]
    os.rename("out.su2", "so-far.su2")
    run(*task, processes=3)
    again = stats("s.json")
    assert again["converged"] and again["iterations"] <= 1 < steps and not os.path.exists("so-far.su2"), again
    with open("so-far.su2", "w") as f:
        f.write("NDIME=3\nNELEM=1\n10 0 1 2 3\nNPOIN=4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n")
    fails(*task, code=4, word="checkpoint of another mesh")
    os.remove("so-far.su2")
    # A smoothing that is killed goes on, too: what is left behind is a mesh that is better than the input.
    smoothing = ("smooth", "bar.su2", "-o", "smooth.su2", "--checkpoint", "smooth-so-far.su2", "--checkpoint-interval",
                 "1", "--tolerance", "1e-10", "--stats", "s.json")
    if killed_at(smoothing, "smooth-so-far.su2"):
        serial("check", "smooth-so-far.su2")
    run(*smoothing)
    serial("check", "smooth.su2")
    straight = stats("s.json")
    assert not os.path.exists("smooth-so-far.su2")
    os.rename("smooth.su2", "smooth-so-far.su2")
    run(*smoothing, processes=3)
    again = stats("s.json")
    assert again["iterations"] <= 2, again["iterations"]
    near(again["energy"], straight["energy"], 9)
    # Nothing stays of TetGen's checkpoints, which are several files.
    few = bar(2)
    few.pins("few.csv", stretched)
    few.tetgen("few")
    few.tetgen("few-so-far")
    run("deform", "few.node", "--pins", "few.csv", "-o", "few-out.node", "--checkpoint", "few-so-far.node")
    assert sorted(n for n in os.listdir(".") if n.startswith("few")) == ["few-out.ele", "few-out.node", "few.csv",
                                                                         "few.ele", "few.node"], os.listdir(".")
    # Files beside a checkpoint that are no part of it are not touched, and a name that says no format is refused.
    for name in ("mine.ele", "mine.face"):
        with open(name, "w") as f:
            f.write("mine\n")
        fails("deform", "few.node", "--pins", "few.csv", "-o", "x.node", "--checkpoint", "mine.node", code=2, word=name)
        os.remove(name)
    for name in ("so-far", "so-far.txt", "so-far.mesh", "-"):
        fails("deform", "bar.su2", "--pins", "pins.csv", "-o", "x.su2", "--checkpoint", name, code=2, word="--checkpoint")
    # Options in the folder in which it is called are not the user's: they name libraries, too.
    with open(".petscrc", "w") as f:
        f.write("-dll_append nowhere.so\n-help\n")
    os.symlink(".petscrc", "petscrc")
    out, _ = run("deform", "few.node", "--pins", "few.csv", "-o", "few-out.node")
    assert "converged" in out and "-dll" not in out, out
    # Options that PETSc has no use for are named.
    _, err = run("deform", "bar.su2", "--pins", "pins.csv", "-o", "o.su2", "--petsc", "-nonsense 3 -pc_type gamg")
    assert "-nonsense" in err and "-pc_type" not in err, err


def case_describe():
    subprocess.run([taut_mpi, "man", "pages"], check=True, timeout=60)
    assert sorted(os.listdir("pages")) == ["taut-mpi-check.1", "taut-mpi-deform.1", "taut-mpi-smooth.1", "taut-mpi.1"]
    with open("pages/taut-mpi-deform.1") as f:
        page = f.read()
    assert "checkpoint" in page and "surface" not in page.split(".SH OPTIONS")[0], page
    for shell, word in (("bash", "complete -F _taut_mpi taut-mpi"), ("zsh", "#compdef taut-mpi"),
                        ("fish", "complete -c taut-mpi -f")):
        text = subprocess.run([taut_mpi, "completion", shell], check=True, capture_output=True, text=True,
                              timeout=60).stdout
        assert word in text and "checkpoint-interval" in text, text
        if shell == "bash":
            subprocess.run(["bash", "-n"], input=text, text=True, check=True)
    if os.path.exists("/dev/full"):
        with open("/dev/full", "w") as full:
            done = subprocess.run([taut_mpi, "--help"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
        assert done.returncode == 2 and "No space left on device" in done.stderr, done


def case_smooth():
    b = bar(3)
    b.medit("bar.mesh")
    out, _ = run("smooth", "bar.mesh", "-o", "smooth.mesh", "--stats", "s.json")
    assert "before" in out
    found = stats("s.json")
    assert found["quality"]["mean_ratio"]["mean"] > found["quality_start"]["mean_ratio"]["mean"]
    x = points_of("smooth.mesh")
    for p, q in zip(b.points, x):
        assert all(a == c for a, c, side in zip(p, q, (1, 1, 4)) if a in (0, side)), (p, q)
    run("smooth", "bar.mesh", "-o", "fixed.mesh", "--boundary", "fixed")


def case_interfaces():
    """Interfaces between regions and labelled faces are kept as by one process, whatever the format."""
    b = bar(2)
    for v, p in enumerate(b.points):
        if v // 9 == 4:
            p[2] = 2.0  # the plane in the middle
        if v < 9 and v % 3 == 1:
            p[0] = 0.5  # a line on one end
    regions = [1 + (max(t) >= 9 * 5) for t in b.cells]
    faces = [(f, 3 if sum(b.points[v][0] for v in f) < 1.5 else 4) for f in b.faces(b.start)]
    cells = [(tuple(t), r) for t, r in zip(b.cells, regions)]
    with open("bar.mesh", "w") as f:
        f.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(b.points)}\n")
        f.writelines("%.17g %.17g %.17g 0\n" % tuple(p) for p in b.points)
        for name, some in (("Tetrahedra", cells), ("Triangles", faces)):
            f.write(f"{name}\n{len(some)}\n")
            f.writelines(" ".join(str(v + 1) for v in c) + f" {r}\n" for c, r in some)
        f.write("End\n")
    with open("bar.msh", "w") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(b.points)}\n")
        f.writelines("%d %.17g %.17g %.17g\n" % (k + 1, *p) for k, p in enumerate(b.points))
        f.write(f"$EndNodes\n$Elements\n{len(cells) + len(faces)}\n")
        for k, (c, r) in enumerate(cells + faces):
            f.write(f"{k + 1} {4 if len(c) == 4 else 2} 2 {r} {r} " + " ".join(str(v + 1) for v in c) + "\n")
        f.write("$EndElements\n")
    for name, rows in (("bar.node", [f"{len(b.points)} 3 0 0"] + ["%d %.17g %.17g %.17g" % (v, *p)
                                                                 for v, p in enumerate(b.points)]),
                       ("bar.ele", [f"{len(cells)} 4 1"] + ["%d %d %d %d %d %d" % (k, *c, r)
                                                            for k, (c, r) in enumerate(cells)]),
                       ("bar.face", [f"{len(faces)} 1"] + ["%d %d %d %d %d" % (k, *c, r)
                                                           for k, (c, r) in enumerate(faces)])):
        with open(name, "w") as f:
            f.write("\n".join(rows) + "\n")
    with open("bar.su2", "w") as f:
        f.write(f"NDIME= 3\nNELEM= {len(cells)}\n")
        f.writelines("10 %d %d %d %d\n" % c for c, _ in cells)
        f.write(f"NPOIN= {len(b.points)}\n")
        f.writelines("%.17g %.17g %.17g\n" % tuple(p) for p in b.points)
        f.write("NMARK= 2\n")
        for label in (3, 4):
            some = [face for face, r in faces if r == label]
            f.write(f"MARKER_TAG= m{label}\nMARKER_ELEMS= {len(some)}\n")
            f.writelines("5 %d %d %d\n" % tuple(face) for face in some)
    data = ("region", [r for _, r in cells + faces])
    all_cells = [c for c, _ in cells + faces]
    vtu_appended("bar.vtu", b.points, all_cells, *data)
    tolerance = ("--tolerance", "1e-8", "--stats", "s.json")

    def kept_notes():
        return [note for note in stats("s.json")["notes"] if "inside stay" in note]

    for k, name in enumerate(("bar.mesh", "bar.msh", "bar.node", "bar.su2", "bar.vtu")):
        out = "out" + os.path.splitext(name)[1]
        serial("smooth", name, "-o", out, *tolerance)
        one, kept = stats("s.json")["energy"], kept_notes()
        assert [note[:21] for note in kept] == ([] if name == "bar.su2" else ["1 vertex inside stays"]), kept  # no regions
        run("smooth", name, "-o", out, *tolerance, processes=2 + k % 2)
        assert kept_notes() == kept, stats("s.json")["notes"]
        assert stats("s.json")["read"] == "by ranges", (name, stats("s.json")["read"])
        near(stats("s.json")["energy"], one, 6)  # the serial one computes in float
        if name == "bar.mesh":
            for p, q, v in zip(b.points, points_of(out), range(len(b.points))):
                assert v // 9 != 4 or q[2] == 2, q
                assert not (v < 9 and v % 3 == 1) or q[0] == 0.5, q
            run("smooth", name, "-o", "free.mesh", "--interfaces", "free", *tolerance)
            assert stats("s.json")["energy"] < one
            assert any(q[2] != 2 for q in points_of("free.mesh")[9 * 4:9 * 5])
    # One that process 0 reads, and one in pieces.
    with open("text.vtk", "w") as f:
        f.write(f"# vtk DataFile Version 3.0\nbar\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(b.points)} double\n")
        f.writelines("%.17g %.17g %.17g\n" % tuple(p) for p in b.points)
        f.write(f"CELLS {len(all_cells)} {sum(len(c) + 1 for c in all_cells)}\n")
        f.writelines(" ".join(map(str, (len(c), *c))) + "\n" for c in all_cells)
        f.write(f"CELL_TYPES {len(all_cells)}\n")
        f.writelines("10\n" if len(c) == 4 else "5\n" for c in all_cells)
        f.write(f"CELL_DATA {len(all_cells)}\nSCALARS region int 1\nLOOKUP_TABLE default\n")
        f.writelines(f"{r}\n" for r in data[1])
    run("smooth", "text.vtk", "-o", "out.vtk", *tolerance)
    near(stats("s.json")["energy"], one, 6)
    for k in range(2):
        mine = [c for c in range(len(all_cells)) if c % 2 == k]
        used = sorted({v for c in mine for v in all_cells[c]})
        vtu_appended(f"piece{k}.vtu", [b.points[v] for v in used],
                     [tuple(used.index(v) for v in all_cells[c]) for c in mine], "region", [data[1][c] for c in mine])
    with open("bar.pvtu", "w") as f:
        f.write('<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid GhostLevel="0"><Piece Source="piece0.vtu"/>'
                '<Piece Source="piece1.vtu"/></PUnstructuredGrid></VTKFile>\n')
    run("smooth", "bar.pvtu", "-o", "out.pvtu", *tolerance)
    near(stats("s.json")["energy"], one, 6)


def vtu_appended(path, points, cells, name, values):
    """A grid with raw appended arrays, and integers of its cells."""
    ends = []
    for c in cells:
        ends.append(len(c) + (ends[-1] if ends else 0))
    arrays = [("Points", "Float64", 3, "points", struct.pack(f"<{3 * len(points)}d", *(x for p in points for x in p)))]
    for key, numbers in (("connectivity", [v for c in cells for v in c]), ("offsets", ends),
                         ("types", [10 if len(c) == 4 else 5 for c in cells])):
        arrays.append(("Cells", "Int64", 1, key, struct.pack(f"<{len(numbers)}q", *numbers)))
    arrays.append(("CellData", "Int64", 1, name, struct.pack(f"<{len(values)}q", *values)))
    text, at, last = "", 0, None
    for section, kind, n, key, data in arrays:
        if section != last:
            text += (f"</{last}>" if last else "") + f"<{section}>"
        text += f'<DataArray type="{kind}" Name="{key}" NumberOfComponents="{n}" format="appended" offset="{at}"/>'
        at, last = at + 8 + len(data), section
    with open(path, "wb") as f:
        f.write(('<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
                 f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">{text}</{last}>'
                 '</Piece></UnstructuredGrid><AppendedData encoding="raw">_').encode())
        for *_, data in arrays:
            f.write(struct.pack("<Q", len(data)) + data)
        f.write(b"</AppendedData></VTKFile>\n")


def case_faults():
    b = bar(2)
    b.medit("bar.mesh")
    b.pins("pins.csv", stretched)
    fails("deform", "none.mesh", "-o", "x.mesh", code=3, word="none.mesh")
    with open("bad.csv", "w") as f:
        f.write("99999,0,0,0\n")
    fails("deform", "bar.mesh", "--pins", "bad.csv", "-o", "x.mesh", code=3, word="99999")
    fails("deform", "bar.mesh", "-o", "nowhere/x.mesh", code=2, word="nowhere")
    fails("deform", "bar.mesh", "-o", "bar.mesh", code=2, word="overwrite")
    fails("deform", "bar.mesh", "-o", "folder/", code=2, word="name a file")
    fails("deform", "bar.mesh", code=2, word="--output")
    fails("unwrap", "bar.mesh", code=2, word="--help")
    fails("deform", "bar.mesh", "-o", "x.mesh", "--refine", code=2, word="--refine")
    fails("deform", "bar.mesh", "--pins", "pins.csv", "-o", "x.mesh", "--petsc", "-pc_type gamg", "--preconditioner",
          "block-jacobi", code=2, word="block diagonal has none")
    fails("deform", "bar.mesh", "--pins", "pins.csv", "-o", "x.mesh", "--petsc", "-pc_type nonsense", code=2,
          word="nonsense")
    fails("deform", "bar.mesh", "--pins", "pins.csv", "-o", "x.mesh", "--petsc", "pc_type gamg", code=2,
          word="'pc_type gamg' begins with no option")
    fails("deform", "bar.mesh", "--fix", "nobody", "-o", "x.mesh", code=4, word="nobody")
    fails("deform", "bar.mesh", "-o", "x.mesh", "--device", "nosuchdevice", code=5, word="nosuchdevice")
    with open("broken.mesh", "w") as f:
        f.write(open("bar.mesh").read()[:1500])
    fails("deform", "broken.mesh", "-o", "x.mesh", code=3, word="broken.mesh")
    b.points[b.end[0] + 40 - len(b.points)] = [5, 5, 5]
    b.medit("folded.mesh")
    fails("deform", "folded.mesh", "--rest", "bar.mesh", "-o", "x.mesh", code=6, word="untangle")
    assert stats_of_check("folded.mesh", code=4)["inverted"] > 0
    with open("inverted.csv", "w") as f:
        f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, -p[0], p[1], p[2]) for v, p in enumerate(b.points))
    fails("deform", "bar.mesh", "--pins", "inverted.csv", "-o", "x.mesh", code=7, word="all vertices pinned")


def case_stops():
    b = bar(8)
    b.medit("bar.mesh")
    # It buckles, which takes many steps.
    b.pins("pins.csv", lambda p: (p[0], p[1], 0.4 * p[2]))
    out, err = run("deform", "bar.mesh", "--pins", "pins.csv", "-o", "late.mesh", "--time-limit", "0.2", code=8)
    serial("check", "late.mesh")
    for name, code in ((signal.SIGTERM, 143), (signal.SIGINT, 130)):
        with open("progress.txt", "w") as told:
            began = subprocess.Popen(command("deform", "bar.mesh", "--pins", "pins.csv", "-o", f"{code}.mesh",
                                             "--progress", "json"), stdout=subprocess.DEVNULL, stderr=told)
        for _ in range(1000):
            with open("progress.txt") as f:
                if '"deform"' in f.read():
                    break
            time.sleep(0.02)
        processes = [int(p) for p in children(began.pid)]
        assert len(processes) == 2, processes
        os.kill(processes[-1], name)  # one of them is asked, all stop
        assert began.wait(timeout=60) == code, (began.returncode, open("progress.txt").read()[-2000:])
        serial("check", f"{code}.mesh")


def children(parent):
    """Processes of taut-mpi that mpiexec has started."""
    found = []
    for name in os.listdir("/proc"):
        if not name.isdigit():
            continue
        try:
            with open(f"/proc/{name}/stat") as f:
                fields = f.read().rsplit(")", 1)[1].split()
            if int(fields[1]) == parent and os.path.basename(os.readlink(f"/proc/{name}/exe")) == "taut-mpi":
                found.append(name)
        except OSError:
            pass
    return found


def case_memory():
    """Too little memory for one process ends all, and nothing is written."""
    b = bar(10)
    b.medit("bar.mesh")
    b.pins("pins.csv", stretched)
    task = [taut_mpi, "deform", "bar.mesh", "--pins", "pins.csv", "-o", "x.mesh"]
    subprocess.run([mpiexec, "-n", "2", *task], check=True, capture_output=True, timeout=200)  # kernels are compiled
    os.remove("x.mesh")
    done = subprocess.run([mpiexec, "-n", "1", *task, ":", "-n", "1", "sh", "-c", 'ulimit -v 200000; exec "$@"', "sh",
                           *task], capture_output=True, text=True, timeout=100)
    assert done.returncode != 0, (done.stdout, done.stderr)
    assert not os.path.exists("x.mesh") and not [n for n in os.listdir(".") if "x.mesh" in n], os.listdir(".")


def main(cases):
    """Runs the case that the command line names, among these."""
    global taut_mpi, taut, mpiexec
    case, taut_mpi, taut, mpiexec, folder = sys.argv[1:]
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    os.chdir(folder)
    cases["case_" + case]()


if __name__ == "__main__":
    main(globals())
