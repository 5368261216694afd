# SPDX-License-Identifier: MIT
"""partitioned.py CASE TAUT_MPI TAUT MPIEXEC FOLDER: taut-mpi on meshes in pieces, of other cells, and of the plane."""
import base64
import filecmp
import os
import shutil
import struct

import program
from piece_files import foam, foam_case, foam_zones, mixed_bar, points_of_foam, points_of_vtu, pvtu, vtu
from program import bar, fails, killed_at, listed, near, run, serial, stats, stats_of_check, stretched


def pins_of(points):
    with open("pins.csv", "w") as f:
        for v, p in enumerate(points):
            if p[2] in (0, 4):
                f.write("%d,%.17g,%.17g,%.17g\n" % (v, *(p if p[2] == 0 else stretched(p))))


def expect_moved(points, pieces, x_of, energy, found=None):
    """Pins are met, points that pieces share are one, and the energy is that of the whole mesh."""
    near(stats("s.json")["energy"], energy, 9)
    found = {} if found is None else found
    for k, own in enumerate(pieces):
        for v, x in zip(own, x_of(k), strict=True):
            assert found.setdefault(v, x) == x, (v, x)
            if points[v][2] in (0, 4):
                assert x == tuple(stretched(points[v]) if points[v][2] == 4 else points[v]), (v, x)
    return found


def whole_energy(points, cells):
    vtu("whole.vtu", points, cells)
    run("deform", "whole.vtu", "--pins", "pins.csv", "-o", "moved.vtu", "--stats", "whole.json")
    return stats("whole.json")["energy"]


def case_pieces():
    b = bar(3)
    pins_of(b.points)
    energy = whole_energy(b.points, b.cells)
    for count, processes, ids in ((5, 1, True), (2, 3, True), (3, 2, False)):
        pieces = pvtu(f"in{count}.pvtu", b.points, b.cells, count, ids, empty=count == 5)
        if ids:  # vertices have the order of the global ids
            pins = ("--pins", "pins.csv")
        else:
            order = []
            for own in pieces:
                order += [v for v in own if v not in order]
            with open("own.csv", "w") as f:
                for k, v in enumerate(order):
                    p = b.points[v]
                    if p[2] in (0, 4):
                        f.write("%d,%.17g,%.17g,%.17g\n" % (k, *(p if p[2] == 0 else stretched(p))))
            pins = ("--pins", "own.csv")
        shutil.rmtree("out", ignore_errors=True)  # more pieces than the last output has
        run("deform", f"in{count}.pvtu", *pins, "-o", "out.pvtu", "--stats", "s.json", processes=processes)
        assert stats("s.json")["format"] == "PVTU"
        expect_moved(b.points, pieces, lambda k: points_of_vtu(f"out/piece_{k}.vtu"), energy)
        for k in range(count):  # all else is as it was
            with open(f"in{count}/piece_{k}.vtu") as f, open(f"out/piece_{k}.vtu") as g:
                old, new = f.read(), g.read()
            assert old.split("</Points>")[1] == new.split("</Points>")[1]
            assert old.split("<Points>")[0] == new.split("<Points>")[0]
        found = stats_of_check("out.pvtu")
        assert found["valid"] and found["elements"] == len(b.cells), found
    with open("out.pvtu") as f:
        assert 'Source="out/piece_2.vtu"' in f.read()
    # Groups of arrays, over all pieces.
    run("deform", "in3.pvtu", "--fix", "region:0", "--fix", "region:1", "-o", "same.pvtu", "--stats", "s.json")
    assert stats("s.json")["pins"] == len(b.points)
    assert all(filecmp.cmp(f"in3/piece_{k}.vtu", f"same/piece_{k}.vtu", shallow=False) for k in range(3))
    run("smooth", "in3.pvtu", "-o", "smooth.pvtu", "--stats", "s.json")
    assert stats("s.json")["quality"]["mean_ratio"]["mean"] > stats("s.json")["quality_start"]["mean_ratio"]["mean"]
    # A checkpoint is in pieces, too; it is left out of the way once the result is there.
    task = ("deform", "in3.pvtu", "--fix", "region:0", "-o", "again.pvtu", "--stats", "s.json", "--checkpoint")
    os.rename("same", "same.taut-1")
    with open("same.pvtu") as f:
        index = f.read()
    with open("same.pvtu", "w") as f:
        f.write(index.replace('"same/', '"same.taut-1/'))
    run(*task, "same.pvtu")
    assert not os.path.exists("same.pvtu") and not os.path.exists("same.taut-1"), os.listdir(".")
    # Pieces that no run has written as a checkpoint stay: those of the input, or of another result.
    shutil.copy("in3.pvtu", "copy.pvtu")
    shutil.copytree("in3", "other")
    with open("in3.pvtu") as f, open("other.pvtu", "w") as g:
        g.write(f.read().replace("in3/", "other/"))
    for name, folder in (("copy.pvtu", "in3"), ("other.pvtu", "other")):
        run(*task, name)
        assert not os.path.exists(name) and len(os.listdir(folder)) == 3, os.listdir(".")
    # What is wrong, one message says, and nothing is left.
    fails("deform", "in3.pvtu", "--fix", "region:0", "-o", "in3.pvtu", code=2, word="in3.pvtu")
    fails("deform", "in3.pvtu", "--fix", "region:0", "-o", "out.vtu", code=2, word=".pvtu")
    os.remove("in3/piece_2.vtu")
    fails("deform", "in3.pvtu", "--fix", "region:0", "-o", "x.pvtu", code=3, word="piece_2.vtu")
    assert not os.path.exists("x")


def case_pieces_of_others():
    """Nothing is read through a .pvtu from outside of its folder, and no file of somebody else is replaced or removed."""
    b = bar(2)
    pvtu("in.pvtu", b.points, b.cells, 3)
    with open("in.pvtu") as f:
        index = f.read()
    os.mkdir("sub")
    for name, folder in (("sub/up.pvtu", "../in/"), ("abs.pvtu", os.path.abspath("in") + "/")):
        with open(name, "w") as f:
            f.write(index.replace("in/", folder))
        fails("deform", name, "--fix", "region:0", "-o", "x.pvtu", code=3, word="outside of its folder")
    # Nor by a link.
    shutil.copytree("in", "linked")
    os.rename("linked/piece_1.vtu", "sub/secret.vtu")
    os.symlink("../sub/secret.vtu", "linked/piece_1.vtu")
    with open("linked.pvtu", "w") as f:
        f.write(index.replace("in/", "linked/"))
    run("check", "linked.pvtu")  # a link within the folder of the .pvtu
    os.makedirs("deep")
    os.rename("linked", "deep/linked")
    os.rename("linked.pvtu", "deep/linked.pvtu")
    os.rename("sub", "deep.sub")
    os.remove("deep/linked/piece_1.vtu")
    os.symlink("../../deep.sub/secret.vtu", "deep/linked/piece_1.vtu")
    fails("deform", "deep/linked.pvtu", "--fix", "region:0", "-o", "x.pvtu", code=3, word="a link out of its folder")
    # A folder that no .pvtu of the name has named is another one's.
    os.mkdir("out")
    with open("out/piece_1.vtu", "w") as f:
        f.write("mine")
    task = ("deform", "in.pvtu", "--fix", "region:0", "--checkpoint", "so-far.pvtu", "-o")
    fails(*task, "out.pvtu", code=2, word="out/piece_1.vtu")
    with open("out/piece_1.vtu") as f:
        assert f.read() == "mine"
    # Files of one name in several folders, and names with characters of XML's own.
    shutil.copytree("in", "R&D")
    os.makedirs("R&D/a")
    os.rename("R&D/piece_1.vtu", "R&D/a/piece_0.vtu")
    os.rename("R&D/piece_2.vtu", "R&D/a/1-piece_0.vtu")
    with open("in.pvtu", "w") as f:
        f.write(index.replace("in/", "R&amp;D/").replace("piece_1", "a/piece_0").replace("piece_2", "a/1-piece_0"))
    os.makedirs("so-far.taut-0")
    with open("so-far.taut-0/notes.txt", "w") as f:
        f.write("mine")
    run(*task, "B&O.pvtu")
    assert len(os.listdir("B&O")) == 3 and os.listdir("so-far.taut-0") == ["notes.txt"], os.listdir("B&O")
    with open("B&O.pvtu") as f:
        assert f.read().count('Source="B&amp;O/') == 3
    assert stats_of_check("B&O.pvtu")["elements"] == len(b.cells)
    run(*task, "B&O.pvtu")  # it replaces its own
    # Nor one that the output there does not name, in its own folder.
    with open("out.mine", "w") as f:
        f.write("mine")
    shutil.copy("in.pvtu", "in2.pvtu")
    os.rename("R&D/a/1-piece_0.vtu", "R&D/a/last.vtu")
    with open("in2.pvtu") as f:
        text = f.read()
    with open("in2.pvtu", "w") as f:
        f.write(text.replace("1-piece_0", "last"))
    os.rename("out.mine", "B&O/last.vtu")
    fails("deform", "in2.pvtu", "--fix", "region:0", "-o", "B&O.pvtu", code=2, word="B&O/last.vtu")
    with open("B&O/last.vtu") as f:
        assert f.read() == "mine"
    # Line ends in names of pieces and arrays separate no names: a checkpoint removes its own pieces alone.
    os.mkdir("lines")
    for k in range(3):
        with open(f"in/piece_{k}.vtu") as f, open(f"lines/part\nmine{k}.vtu", "w") as g:
            g.write(f.read().replace('Name="region"', 'Name="re\ngion"'))
        with open(f"mine{k}.vtu", "w") as f:
            f.write("mine")
    with open("lines.pvtu", "w") as f:
        f.write(index.replace("in/piece_", "lines/part\nmine"))
    run("deform", "lines.pvtu", "--fix", "re\ngion:0", "--checkpoint", "so-far.pvtu", "-o", "lines.out.pvtu", "--stats",
        "s.json")
    assert stats("s.json")["pins"] > 0 and len(os.listdir("lines.out")) == 3, os.listdir("lines.out")
    assert all(os.path.exists(f"mine{k}.vtu") for k in range(3)), os.listdir(".")
    run("smooth", "lines.pvtu", "-o", "lines.out.pvtu")
    fails("deform", "lines.pvtu", "--fix", "x", "-o", "x.pvtu", code=4, word="lines.pvtu: no group 'x'")
    # A pin that single precision cannot hold.
    points = base64.b64encode(struct.pack("<I12f", 48, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)).decode()
    arrays = "".join(f'<DataArray type="Int32" Name="{name}" format="ascii">{values}</DataArray>' for name, values in
                     (("connectivity", "0 1 2 3"), ("offsets", "4"), ("types", "10")))
    with open("single.vtu", "w") as f:
        f.write('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid><Piece '
                'NumberOfPoints="4" NumberOfCells="1"><Points><DataArray type="Float32" NumberOfComponents="3" '
                f'format="binary">{points}</DataArray></Points><Cells>{arrays}</Cells></Piece></UnstructuredGrid>'
                "</VTKFile>")
    with open("single.pvtu", "w") as f:
        f.write('<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid><Piece Source="single.vtu"/></PUnstructuredGrid>'
                "</VTKFile>")
    with open("far.csv", "w") as f:
        f.write("0,1e39,0,0\n")
    fails("deform", "single.pvtu", "--pins", "far.csv", "-o", "x.pvtu", code=4, word="single precision of the file")


def case_pieces_checkpoint():
    """Whenever a run is killed, its checkpoint has pieces of one time."""
    b = bar(6)
    pieces = pvtu("in.pvtu", b.points, b.cells, 5)
    b.pins("pins.csv", lambda p: (p[0], p[1], 0.4 * p[2]))  # it buckles, which takes many steps
    task = ("deform", "in.pvtu", "--pins", "pins.csv", "-o", "out.pvtu", "--stats", "s.json", "--checkpoint",
            "so-far.pvtu", "--checkpoint-interval", "1")
    if not killed_at(task, "so-far.pvtu"):  # a fast machine was done before the first checkpoint
        for name in ("out", "out.pvtu"):
            os.rename(name, name.replace("out", "so-far.taut-0"))
        with open("so-far.taut-0.pvtu") as f, open("so-far.pvtu", "w") as g:
            g.write(f.read().replace("out/", "so-far.taut-0/"))
    with open("so-far.pvtu") as f:
        named = f.read().split('Source="')[1].split("/")[0]
    assert named in ("so-far.taut-0", "so-far.taut-1"), named
    found = {}
    for k, own in enumerate(pieces):
        for v, x in zip(own, points_of_vtu(f"{named}/piece_{k}.vtu"), strict=True):
            assert found.setdefault(v, x) == x, (v, x)
    assert stats_of_check("so-far.pvtu")["valid"]
    # One that was killed while it wrote the next has left part of that, which is not read; the rest is removed.
    other = "so-far.taut-1" if named.endswith("0") else "so-far.taut-0"
    shutil.rmtree(other, ignore_errors=True)
    shutil.copytree("in", other)
    os.remove(other + "/piece_3.vtu")
    assert stats_of_check("so-far.pvtu")["valid"]
    run(*task, "--time-limit", "0.01", code=8, processes=3)
    for k in range(5):  # no time for more: the result is the checkpoint
        assert points_of_vtu(f"out/piece_{k}.vtu") == points_of_vtu(f"{named}/piece_{k}.vtu")
    run(*task, processes=3)
    assert stats("s.json")["converged"] and stats("s.json")["pins_held"]
    assert sorted(os.listdir(".")) == ["in", "in.pvtu", "out", "out.pvtu", "pins.csv", "s.json"], os.listdir(".")


def case_foam():
    b = bar(3)
    pins_of(b.points)
    energy = whole_energy(b.points, b.cells)

    def patch(corners):
        return "floor" if all(p[2] == 0 for p in corners) else "roof" if all(p[2] == 4 for p in corners) else "walls"

    for name, count, binary, processes in (("text", 3, False, 2), ("bytes", 2, True, 3), ("many", 4, True, 1)):
        pieces = foam_case(name, b.points, b.cells, count, patch, binary)
        run("deform", name, "--pins", "pins.csv", "-o", name + "-moved", "--stats", "s.json", processes=processes)
        assert stats("s.json")["format"] == "OpenFOAM"
        expect_moved(b.points, pieces, lambda k: points_of_foam(f"{name}-moved/processor{k}/constant/polyMesh"), energy)
        for k in range(count):
            here, there = (f"{c}/processor{k}/constant/polyMesh" for c in (name, name + "-moved"))
            assert sorted(os.listdir(here)) == sorted(os.listdir(there))
            for file in os.listdir(here):
                assert (file == "points") != filecmp.cmp(f"{here}/{file}", f"{there}/{file}", shallow=False), file
    # Patches are groups.
    run("deform", "bytes", "--fix", "floor", "--move", "roof:translate:0,0,2", "-o", "group", "--stats", "s.json")
    near(stats("s.json")["energy"], energy, 9)
    assert stats_of_check("group")["elements"] == len(b.cells)
    # So are zones, as text and in binary, of pieces that have part of them or none.
    most = {"cell": 8, "face": 6, "point": 2}
    for name, binary, together in (("text", False, [list(most)]), ("bytes", True, [[zone] for zone in most])):
        for zones in together:
            fixed = []
            for zone in zones:
                fixed += ["--fix", f"{zone}Zone:low", "--fix", zone + "Zone:none"]
                for k in range(2):
                    foam_zones(f"{name}/processor{k}/constant/polyMesh", zone, {"low": [0, 2], "none": []}, binary)
            run("deform", name, *fixed, "-o", f"{name}-{zones[-1]}", "--stats", "s.json")
            assert max(most[z] for z in zones) < stats("s.json")["pins"] or zones == ["point"], stats("s.json")["pins"]
            assert 2 <= stats("s.json")["pins"] <= 2 * sum(most[z] for z in zones), stats("s.json")["pins"]
        for file in os.listdir(f"{name}/processor1/constant/polyMesh"):
            here, there = (f"{c}/processor1/constant/polyMesh/{file}" for c in (name, name + "-point"))
            assert file == "points" or filecmp.cmp(here, there, shallow=False), file
    foam_zones("many/processor3/constant/polyMesh", "cell", {"far": [10**6]}, True)
    fails("deform", "many", "--fix", "floor", "-o", "x", code=3, word="a zone names item 1000000")
    # The output is a new folder, with a slash behind its name or without.
    run("deform", "bytes", "--fix", "floor", "-o", "slash/")
    assert sorted(os.listdir("slash")) == ["processor0", "processor1"]
    fails("deform", "bytes", "--fix", "floor", "-o", "slash", code=2, word="is there already")
    # Nothing is written into the input.
    for place in ("bytes/out", "bytes/processor0/constant/polyMesh/out"):
        fails("deform", "bytes", "--fix", "floor", "-o", place, code=2, word="lies in the input")
        fails("deform", "bytes", "--fix", "floor", "-o", "x", "--stats", place + ".json", code=2, word="lies in the input")
        fails("deform", "bytes", "--fix", "floor", "-o", "x", "--checkpoint", place, code=2, word="in each other")
    # Nothing is read through a link out of the case, and what is no file is not waited for.
    with open("id_rsa", "w") as f:
        f.write("secret")
    for link in ("bytes/processor1/constant/polyMesh/more", "bytes/processor0/constant/polyMesh/sub/more"):
        os.makedirs(os.path.dirname(link), exist_ok=True)
        for target in (os.path.abspath("id_rsa"), "nowhere"):
            os.symlink(target, link)
            fails("deform", "bytes", "--fix", "floor", "-o", "x", code=3, word="is a link out of the case")
            os.remove(link)
    mesh = "bytes/processor1/constant/polyMesh"
    for place in ("bytes/processor1", mesh, mesh + "/points"):
        os.rename(place, "elsewhere")
        os.symlink(os.path.abspath("elsewhere"), place)
        fails("deform", "bytes", "--fix", "floor", "-o", "x", code=3, word="is a link out of the case")
        os.remove(place)
        os.rename("elsewhere", place)
    os.mkfifo(mesh + "/pipe")
    fails("deform", "bytes", "--fix", "floor", "-o", "x", code=3, word="is no file")
    os.remove(mesh + "/pipe")
    os.symlink("points", mesh + "/same")  # within it
    run("deform", "bytes", "--fix", "floor", "-o", "within")
    # One that is not decomposed; one without numbers of points, which are joined where they are.
    foam("one/constant/polyMesh", b.points, b.cells, lambda around: patch([b.points[v] for v in around]))
    run("deform", "one", "--pins", "pins.csv", "-o", "one-moved", "--stats", "s.json", processes=3)
    near(stats("s.json")["energy"], energy, 9)
    foam_case("plain", b.points, b.cells, 2, patch, numbers=False)
    run("deform", "plain", "--fix", "floor", "--move", "roof:translate:0,0,2", "-o", "plain-moved", "--stats", "s.json")
    near(stats("s.json")["energy"], energy, 9)
    # Pieces in one file, polyhedra, what is compressed, and what is no case are refused by name.
    os.makedirs("empty")
    fails("deform", "empty", "-o", "x", code=3, word="no case of OpenFOAM")
    os.makedirs("empty/processors2/constant/polyMesh")
    fails("deform", "empty", "-o", "x", code=3, word="-fileHandler uncollated")
    os.rename("plain/processor1", "plain/processor7")
    fails("deform", "plain", "-o", "x", code=3, word="processor0 to processor7")
    os.rename("one/constant/polyMesh/owner", "one/constant/polyMesh/owner.gz")
    fails("deform", "one", "-o", "x", code=3, word="gunzip")
    path = "text/processor1/constant/polyMesh/faces"
    with open(path) as f:
        text = f.read()
    cut = text.index("\n3(") + 1
    with open(path, "w") as f:
        f.write(text[:cut] + "5(0 1 2 3 4" + text[text.index(")", cut):])
    fails("deform", "text", "-o", "x", code=3, word="split polyhedra")


def case_foam_checkpoint():
    """A run of a case that is killed goes on from its checkpoint, which is a folder, with other processes."""
    n = 6
    b = bar(n)
    foam_case("case", b.points, b.cells, 3, lambda corners: "floor" if all(p[2] == 0 for p in corners) else "walls")
    b.pins("pins.csv", lambda p: (p[0], p[1], 0.4 * p[2]))  # it buckles, which takes many steps
    task = ("deform", "case", "--pins", "pins.csv", "-o", "out", "--checkpoint", "so-far/", "--checkpoint-interval", "1",
            "--stats", "s.json")
    if killed_at(task, "so-far"):
        assert sorted(os.listdir(".")) == ["case", "pins.csv", "so-far"], os.listdir(".")
    else:  # a fast machine was done before the first checkpoint
        os.rename("out", "so-far")
        listed("so-far")
    left = stats_of_check("so-far")
    assert left["valid"] and left["elements"] == len(b.cells), left
    # Where there is no time for more, the result is the checkpoint, bit for bit, and that stays.
    run(*task, "--time-limit", "0.01", code=8, processes=3)
    for k in range(3):
        left, done, given = (points_of_foam(f"{c}/processor{k}/constant/polyMesh") for c in ("so-far", "out", "case"))
        assert left == done != given
    shutil.rmtree("out")
    run(*task, processes=3)
    again = stats("s.json")
    assert again["converged"] and again["inverted"] == 0 and again["pins_held"], again
    assert sorted(os.listdir(".")) == ["case", "out", "pins.csv", "s.json"], os.listdir(".")
    # Of what is at its end, nothing is left to do.
    os.rename("out", "so-far")
    listed("so-far")
    run(*task)
    assert stats("s.json")["iterations"] <= 1 and not os.path.exists("so-far"), stats("s.json")["iterations"]
    # A result that is no checkpoint, and whatever else lies in one, is the user's.
    os.rename("out", "so-far")
    fails(*task, code=2, word="is of no checkpoint")
    listed("so-far")
    notes = "so-far/processor0/constant/polyMesh/notes.txt"
    for make in (lambda: open(notes, "w").close(), lambda: os.symlink("points", notes), lambda: os.mkdir(notes)):
        make()
        fails(*task, code=2, word="notes.txt is of no checkpoint")
        os.rmdir(notes) if os.path.isdir(notes) else os.remove(notes)
    shutil.rmtree("so-far")
    # It replaces nothing that is no checkpoint.
    for name, word in (("case/", "is also the input"), ("out/", "is also the input or the output"),
                       ("s.json", "is a file")):
        fails(*task[:6], "--checkpoint", name, code=2, word=word)
    os.makedirs("other/constant/polyMesh")
    os.makedirs("other/system")
    fails(*task[:6], "--checkpoint", "other", code=2, word="is of no checkpoint")
    b.medit("bar.mesh")
    fails("deform", "bar.mesh", "-o", "x.mesh", "--checkpoint", "case", code=2, word="is a folder")
    few = 2 * (n + 1) ** 2
    foam_case("so-far", b.points[:few], [c for c in b.cells if max(c) < few], 1, lambda corners: "walls")
    listed("so-far")
    fails(*task, code=4, word="checkpoint of another mesh")


def case_mixed():
    points, cells = mixed_bar(3)
    pins_of(points)
    vtu("mixed.vtu", points, cells)
    serial("deform", "mixed.vtu", "--pins", "pins.csv", "-o", "one.vtu", "--stats", "one.json", "--tolerance", "1e-9")
    one = stats("one.json")
    for processes in (1, 3):
        run("deform", "mixed.vtu", "--pins", "pins.csv", "-o", "all.vtu", "--stats", "s.json", "--tolerance", "1e-9",
            processes=processes)
        s = stats("s.json")
        near(s["energy"], one["energy"], 8)  # the serial one computes in float
        assert s["element"] == "mixed" and s["inverted"] == 0 and s["insides"]["negative"] == 0, s
        assert s["elements"] == one["elements"] == len(cells)
    serial("check", "all.vtu")
    found = stats_of_check("all.vtu")
    assert found["valid"] and found["insides"] == {"negative": 0, "undecided": 0}, found
    serial("smooth", "mixed.vtu", "-o", "one.vtu", "--interfaces", "free", "--stats", "one.json", "--tolerance", "1e-9")
    run("smooth", "mixed.vtu", "-o", "all.vtu", "--stats", "s.json", "--tolerance", "1e-9")
    near(stats("s.json")["energy"], stats("one.json")["energy"], 7)
    # In pieces, and of OpenFOAM.
    energy = s["energy"]
    pieces = pvtu("in.pvtu", points, cells, 3)
    run("deform", "in.pvtu", "--pins", "pins.csv", "-o", "out.pvtu", "--stats", "s.json", "--tolerance", "1e-9")
    expect_moved(points, pieces, lambda k: points_of_vtu(f"out/piece_{k}.vtu"), energy)
    pieces = foam_case("case", points, cells, 3, lambda corners: "walls", binary=True)
    run("deform", "case", "--pins", "pins.csv", "-o", "moved", "--stats", "s.json", "--tolerance", "1e-9")
    expect_moved(points, pieces, lambda k: points_of_foam(f"moved/processor{k}/constant/polyMesh"), energy)


def case_ranges():
    """Other cells by ranges in the formats that have them."""
    points, cells = mixed_bar(2)
    pins_of(points)
    names = {8: "Hexahedra", 6: "Prisms", 5: "Pyramids"}
    with open("mixed.mesh", "w") as f:
        f.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}\n")
        f.writelines("%.17g %.17g %.17g 0\n" % tuple(p) for p in points)
        for n, name in names.items():
            some = [[c[v] for v in ((0, 2, 1, 3, 5, 4) if n == 6 else range(n))] for c in cells if len(c) == n]
            f.write(f"{name}\n{len(some)}\n")
            f.writelines(" ".join(str(v + 1) for v in c) + " 0\n" for c in some)
        f.write("End\n")
    with open("mixed.su2", "w") as f:
        f.write(f"NDIME= 3\nNELEM= {len(cells)}\n")
        f.writelines(f"{ {8: 12, 6: 13, 5: 14}[len(c)]} " + " ".join(map(str, c)) + "\n" for c in cells)
        f.write(f"NPOIN= {len(points)}\n")
        f.writelines("%.17g %.17g %.17g\n" % tuple(p) for p in points)
        f.write("NMARK= 0\n")
    with open("mixed.msh", "w") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        f.writelines("%d %.17g %.17g %.17g\n" % (k + 1, *p) for k, p in enumerate(points))
        f.write(f"$EndNodes\n$Elements\n{len(cells)}\n")
        for k, c in enumerate(cells):
            c = [c[v] for v in ((0, 2, 1, 3, 5, 4) if len(c) == 6 else range(len(c)))]
            f.write(f"{k + 1} { {8: 5, 6: 6, 5: 7}[len(c)]} 2 1 1 " + " ".join(str(v + 1) for v in c) + "\n")
        f.write("$EndElements\n")
    energies = []
    for name in ("mixed.su2", "mixed.mesh", "mixed.msh"):
        out = "out" + os.path.splitext(name)[1]
        run("deform", name, "--pins", "pins.csv", "-o", out, "--stats", "s.json", "--tolerance", "1e-9")
        assert stats("s.json")["read"] == "by ranges", stats("s.json")["read"]
        energies.append(stats("s.json")["energy"])
        serial("check", out)
    for e in energies:
        near(e, energies[0], 11)


def case_plane():
    n = 12
    points = [(i / n, j / n) for j in range(n + 1) for i in range(4 * n + 1)]

    def at(i, j):
        return j * (4 * n + 1) + i

    for quads in (False, True):
        with open("plane.su2", "w") as f:
            around = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(n) for i in range(4 * n)]
            cells = [(9, *q) if quads and k % 2 else t for k, q in enumerate(around)
                     for t in ([(9, *q)] if quads and k % 2 else [(5, q[0], q[1], q[2]), (5, q[0], q[2], q[3])])]
            f.write(f"NDIME= 2\nNELEM= {len(cells)}\n")
            f.writelines(" ".join(map(str, c)) + "\n" for c in cells)
            f.write(f"NPOIN= {len(points)}\n")
            f.writelines("%.17g %.17g\n" % p for p in points)
            f.write("NMARK= 0\n")
        with open("plane.csv", "w") as f:
            for v, (x, y) in enumerate(points):
                if x in (0, 4):
                    f.write("%d,%.17g,%.17g\n" % (v, 1.3 * x, y + 0.5 * (x == 4)))
        task = ("deform", "plane.su2", "--pins", "plane.csv", "--stats", "s.json", "--tolerance", "1e-9")
        serial(*task, "-o", "one.su2")
        one = stats("s.json")
        for processes in (1, 3):
            run(*task, "-o", "all.su2", processes=processes)
            s = stats("s.json")
            near(s["energy"], one["energy"], 8)  # the serial one computes in float
            assert s["pins_held"] and s["elements"] == len(cells) and s["element"] == ("mixed" if quads else "triangle")
            serial("check", "all.su2")
        assert stats_of_check("all.su2")["valid"]
    run("smooth", "plane.su2", "-o", "smooth.su2", "--checkpoint", "so-far.su2")


if __name__ == "__main__":
    program.main(globals())
