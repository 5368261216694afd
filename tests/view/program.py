# SPDX-License-Identifier: MIT
"""program.py TAUT FOLDER: `taut view` as a page and as a stranger meets it."""
import math
import os
import signal
import socket
import struct
import subprocess
import sys
import time
import tempfile

from client import Program, align, focus, keep, move, places, pose, redo, relax, release, save, undo


def dome(path, n=24):
    """A round dome as OBJ: n x n squares, bent."""
    with open(path, "w") as f:
        for j in range(n + 1):
            for i in range(n + 1):
                x, y = i / n, j / n
                f.write(f"v {x} {y} {0.6 * math.sin(3 * x) * math.sin(3 * y)}\n")
        for j in range(n):
            for i in range(n):
                a = 1 + j * (n + 1) + i
                f.write(f"f {a} {a + 1} {a + n + 2}\nf {a} {a + n + 2} {a + n + 1}\n")
    return n


def bar(path, n=(6, 2, 2), far=0):
    """A bar of tetrahedra as MEDIT, so far from the origin."""
    index = lambda i, j, k: 1 + i + (n[0] + 1) * (j + (n[1] + 1) * k)
    points = [(i, j, k) for k in range(n[2] + 1) for j in range(n[1] + 1) for i in range(n[0] + 1)]
    cells = []
    for k in range(n[2]):
        for j in range(n[1]):
            for i in range(n[0]):
                for a, b in ((0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)):
                    corner = [i, j, k]
                    way = [tuple(corner)]
                    for axis in (a, b, 3 - a - b):
                        corner[axis] += 1
                        way.append(tuple(corner))
                    if (a, b) in ((1, 0), (0, 2), (2, 1)):
                        way[2], way[3] = way[3], way[2]
                    cells.append([index(*c) for c in way])
    with open(path, "w") as f:
        f.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}\n")
        f.writelines(f"{x + far} {y + far} {z + far} 0\n" for x, y, z in points)
        f.write(f"Tetrahedra\n{len(cells)}\n")
        f.writelines(f"{a} {b} {c} {d} 0\n" for a, b, c, d in cells)
        f.write("End\n")


def at(state, v, d=2):
    return [x + o for x, o in zip(state["positions"][d * v:d * v + d], state["origin"])]


def near(a, b, tolerance=1e-6):
    return all(abs(x - y) <= tolerance for x, y in zip(a, b, strict=True))


def areas(model, positions):
    f = model["faces"]
    for i in range(0, len(f), 3):
        (ax, ay), (bx, by), (cx, cy) = (positions[2 * v:2 * v + 2] for v in f[i:i + 3])
        yield (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def a_page(path, n):
    with Program(program, path) as p:
        s = p.socket()
        model = s.message("model")
        assert (model["dimension"], model["shows"], model["name"]) == (2, 1, "dome.obj")
        assert len(model["points"]) == 3 * (n + 1) ** 2 and len(model["faces"]) == 6 * n * n
        first = s.message("state")
        assert first["converged"] and first["writer"] and not first["pins"] and not first["can_undo"]
        middle = (n + 1) ** 2 // 2
        x, y = at(first, middle)

        for k in range(1, 11):  # one drag
            s.send(places(7, [(middle, 3, (x + 0.02 * k, y, 0))]))
            shown = s.message("state")
            assert shown["flipped"] == 0 and min(areas(model, shown["positions"])) > 0
        corner = 0
        s.send(places(8, [(corner, 3, (*at(first, corner), 0))]))
        s.send(places(9, [(middle, 3, (x + 0.1, y + 0.1, 0))]))
        while True:
            rest = s.rest()
            if rest["held"] and rest["pins"].get(middle, (0, [0, 0]))[1][:2] == [x + 0.1, y + 0.1]:
                break
        assert near(at(rest, middle), (x + 0.1, y + 0.1)) and near(at(rest, corner), at(first, corner)), rest
        assert rest["energy"] > first["energy"] and min(areas(model, rest["positions"])) > 0

        s.send(undo())  # of the second drag of the middle
        s.send(undo())  # of the pin at the corner
        s.send(undo())  # of the first drag, all ten of its messages
        while True:
            back = s.rest()
            if not back["pins"]:
                break
        assert back["positions"] == first["positions"] and back["energy"] == first["energy"] and not back["can_undo"]
        s.send(redo())
        while not (state := s.rest())["pins"]:
            pass
        assert list(state["pins"]) == [middle]
        s.send(release(10, [middle]))
        while s.rest()["pins"]:
            pass

        # What is outside of a focus stays where it is.
        inside = [f for f in range(2 * n * n) if n // 4 <= (f // 2) % n < 3 * n // 4 and n // 4 <= f // 2 // n < 3 * n // 4]
        s.send(focus(11, inside))
        s.send(places(12, [(middle, 3, (x + 0.05, y - 0.05, 0))]))
        while not ((state := s.rest())["pins"] and state["held"]):
            pass
        s.send(release(13, [middle]))
        s.send(relax(14))
        while (focused := s.rest())["pins"] or not focused["converged"]:
            pass
        s.send(relax(15, afresh=True))
        while (afresh := s.rest())["number"] <= focused["number"] or not afresh["converged"]:
            pass
        border = [v for v in range((n + 1) ** 2) if v % (n + 1) < n // 4 or v // (n + 1) < n // 4]
        assert all(near(at(focused, v), at(state, v), 1e-6) and near(at(afresh, v), at(state, v), 1e-6) for v in border)
        assert abs(afresh["energy"] - focused["energy"]) < 1e-4 * focused["energy"]
        s.send(focus(16, []))

        line = [(n // 2) * (n + 1) + i for i in range(n + 1)]
        s.send(align(17, 1, line))
        while not (len((state := s.rest())["pins"]) == len(line) and state["held"]):
            pass
        heights = {at(state, v)[1] for v in line}
        assert len(heights) == 1 and all(held == 2 for held, _ in state["pins"].values()), heights

        s.send(save())
        file = s.message("file")
        assert file["name"] == "dome-flat.obj" and file["bytes"].count(b"\nvt ") + file["bytes"].startswith(b"vt ") == (n + 1) ** 2

        # Wishes that cannot be granted are answered, and nothing changes.
        s.send(places(18, [(10 ** 6, 3, (0, 0, 0))]))
        assert "1000000" in s.message("note")["text"]
        s.send(focus(19, [10 ** 6]))
        assert "face 1000000" in s.message("note")["text"]
        s.send(align(20, 2, line))
        assert "coordinate" in s.message("note")["text"]

        # A second page looks on until the first one goes.
        other = p.socket()
        assert other.message("model")["name"] == "dome.obj" and not other.message("state")["writer"]
        other.send(places(21, [(middle, 3, (0, 0, 0))]))
        assert "another page" in other.message("note")["text"]
        s.close()
        while not other.message("state")["writer"]:
            pass
        other.close()


def shell(path, n):
    with Program(program, path, "--shell") as p:
        s = p.socket()
        model = s.message("model")
        assert model["dimension"] == 3 and model["shows"] == 0
        first = s.message("state")
        corners = [0, n, n * (n + 1), (n + 1) ** 2 - 1]
        s.send(places(1, [(v, 7, at(first, v, 3)) for v in corners[:3]]))
        x, y, z = at(first, corners[3], 3)
        s.send(places(2, [(corners[3], 7, (x, y, z + 0.3))]))
        while not (len((state := s.rest())["pins"]) == 4 and state["held"]):
            pass
        assert near(at(state, corners[3], 3), (x, y, z + 0.3)) and state["flipped"] == 0
        s.send(save())
        file = s.message("file")
        assert file["name"] == "dome-moved.obj" and file["bytes"].count(b"v ") == (n + 1) ** 2


def without_effect(surface, volume):
    """Options that would have no effect are refused."""
    feature = ("--source", surface, "--at", "0", "--radius", "1", "--onto", "0")
    for option, *arguments in (("--zone", surface, "--zone", "1"), ("--zone", volume, "--format", "obj", "--zone", "1"),
                               ("--holes", volume, "--holes"), ("--holes", surface, "--shell", "--holes"),
                               ("--holes", surface, "--holes", *feature), ("--shell", surface, "--shell", *feature),
                               ("--pins", surface, "--pins", surface, *feature)):
        run = subprocess.run([program, "view", "--no-browser", *arguments], capture_output=True, text=True, timeout=60)
        assert run.returncode == 2 and f"taut: error: {option} is" in run.stderr, (arguments, run)


def strangers(path):
    with Program(program, path) as p:
        here = f"http://127.0.0.1:{p.port}"
        assert p.request()[0] == 200
        status, head, text = p.request("/page.js")
        assert status == 200 and len(text) > 10000 and "nosniff" in head and "frame-ancestors 'none'" in head
        assert p.request(method="HEAD")[2] == b""
        assert p.request("/page.css", origin=here)[0] == 200
        assert len(p.request("/scene.js", origin=here)[2]) > 100000
        assert p.request(host=f"localhost:{p.port}")[0] == 200
        for rude in ({"host": "evil.example"}, {"host": f"evil.example:{p.port}"}, {"host": "127.0.0.1"}, {"origin": "http://evil.example"},
                     {"origin": "null"}, {"origin": f"http://localhost:{p.port}"}, {"target": "/live", "host": "evil.example"}):
            assert p.request(**rude)[0] == 403, rude
        for second in ("evil.example", f"127.0.0.1:{p.port}"):
            assert p.request(extra=(f"Host: {second}",))[0] in (400, 403), second
        assert p.request("/../etc/passwd")[0] == 404 and p.request("/live")[0] == 404
        assert p.request(method="POST", extra=("Content-Length: 0",))[0] == 405
        assert p.request(extra=("Content-Length: 100000",), body=b"x" * 1000)[0] == 413
        assert p.request(extra=("X: " + "x" * 20000,))[0] == 413
        for rude in ({"host": "evil.example"}, {"origin": "http://evil.example"}, {"origin": ""}, {"token": ""}, {"token": "0" * 64},
                     {"token": p.token[:-1]}, {"token": p.token + "0"}, {"target": "/"}, {"host": f"localhost:{p.port}", "origin": here}):
            assert p.socket(**rude) == 403, rude
        assert not isinstance(p.socket(host=f"localhost:{p.port}"), int)

        s = p.socket()
        s.message("state")
        for nonsense in (b"", b"\x00", b"\x63abcdefgh", places(1, [])[:-1], places(1, []) + b"x", struct.pack("<BII", 1, 1, 2 ** 32 - 1),
                         places(1, [(1, 3, (math.nan, 0, 0))]), places(1, [(1, 9, (0, 0, 0))]), struct.pack("<BIIi", 2, 1, 1, -1)):
            s.send(nonsense)
            assert s.message("note")["text"], nonsense
        s.send(b"text", opcode=1)
        assert "binary" in s.message("note")["text"]
        try:
            for _ in range(200):
                s.send(b"\x00")
                s.message("note")
            raise AssertionError("nonsense for ever")
        except (EOFError, ConnectionError):
            s.close()

        s = p.socket()
        s.message("state")
        try:
            s.send(b"", length=1 << 40)
            s.message("note")
            raise AssertionError("an endless frame")
        except (EOFError, ConnectionError):
            s.close()

        # A page that does not read gets no more than it was promised, and others are served.
        deaf = p.socket()
        for k in range(500):
            deaf.send(places(k, [(5, 3, (0.001 * k, 0, 0))]))
        assert p.request()[0] == 200
        idle = [p.socket() for _ in range(14)]
        for i in idle:
            i.close()
        deaf.close()
        time.sleep(0.5)
        assert p.request()[0] == 200 and p.process.poll() is None

        # At rest nothing is done: the next state is that of the next wish.
        s = p.socket()
        while not (state := s.message("state"))["writer"] or state["working"]:
            pass
        for _ in range(50):
            assert p.request()[0] == 200
        s.send(redo())  # there is nothing to redo
        assert s.message("state")["number"] == state["number"] + 1


def idle(path):
    """Other users of the machine reach the port. Who has the address is served all the same."""
    with Program(program, path) as p:
        s = p.socket()
        s.message("state")
        idlers = []
        for k in range(200):
            idlers.append(socket.create_connection(("127.0.0.1", p.port), timeout=20))
            idlers[-1].sendall(b"GET / HTTP/1.1\r\n" if k % 2 else b"")
        assert p.request()[0] == 200 and p.request("/page.js")[0] == 200
        other = p.socket()
        assert not isinstance(other, int) and other.message("model")
        s.send(redo())
        assert s.message("state")
        # The oldest had to go, the latest is waited for.
        try:
            assert idlers[0].recv(1) == b""
        except ConnectionError:
            pass
        idlers.append(socket.create_connection(("127.0.0.1", p.port), timeout=20))
        idlers[-1].sendall(b"GET / HTTP/1.1\r\n")
        assert p.request()[0] == 200
        idlers[-1].sendall(f"Host: 127.0.0.1:{p.port}\r\n\r\n".encode())
        assert idlers[-1].recv(12) == b"HTTP/1.1 200"
        # With the token there are many pages, but not without end.
        pages = [p.socket() for _ in range(14)]
        assert not any(isinstance(page, int) for page in pages) and p.socket() == 503
        pages.pop().close()
        until(lambda: not isinstance(p.socket(), int))


def until(holds, seconds=300):
    end = time.monotonic() + seconds
    while not (value := holds()):
        assert time.monotonic() < end, "still not so"
        time.sleep(0.01)
    return value


def opened(path):
    """The browser gets the name of a file, which this user alone can read, and nothing else of the program."""
    scripts = tempfile.mkdtemp(dir=folder)
    told = f"{scripts}/told"
    with open(f"{scripts}/xdg-open", "w") as f:
        f.write(f"""#!/bin/sh
{{ printf '%s\\n' "$#" "$1"; stat -c %a "$1" "$(dirname "$1")"; ls -l "/proc/$$/fd" | grep -c 'socket:'; grep SigBlk /proc/self/status; cat "$1"; }} >{told}.new 2>&1
mv {told}.new {told}
""")
    os.chmod(f"{scripts}/xdg-open", 0o755)
    environment = os.environ | {"PATH": f"{scripts}:{os.environ['PATH']}"}
    with Program(program, path, browser=environment) as p:
        until(lambda: os.path.exists(told))
        with open(told) as f:
            count, file, mode, folder_mode, files, blocked, *content = f.read().split("\n")
        assert count == "1" and p.token not in file and (mode, folder_mode) == ("600", "700"), (count, file, mode, folder_mode)
        assert files == "0", f"{files} sockets of the program"
        assert int(blocked.split()[1], 16) == 0, blocked
        assert p.url in "\n".join(content)
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{process}/cmdline", "rb") as f:
                    assert p.token.encode() not in f.read(), process
            except OSError:
                pass  # it is over
        # Who has ended is waited for.
        until(lambda: not open(f"/proc/{p.process.pid}/task/{p.process.pid}/children").read().split())
        assert os.path.exists(file) and not isinstance(p.socket(), int)
        p.process.send_signal(signal.SIGINT)
        assert p.process.wait(timeout=300) in (0, 130) and not os.path.exists(os.path.dirname(file))
    for sent in ((signal.SIGHUP,), (signal.SIGQUIT,), (signal.SIGTERM, signal.SIGTERM)):
        os.remove(told)
        with Program(program, path, browser=environment) as p:
            until(lambda: os.path.exists(told))
            with open(told) as f:
                file = f.read().split("\n")[1]
            for name in sent:
                p.process.send_signal(name)
            assert p.process.wait(timeout=300) in (0, 143) and not os.path.exists(os.path.dirname(file)), sent


def far_away(path):
    """What lies far from the origin is shown and pinned as what lies near: floats alone would be 8 apart there."""
    far = 1e8
    bar(path, far=far)
    with Program(program, path) as p:
        s = p.socket()
        model = s.message("model")
        assert sorted(set(model["points"][::3])) == list(range(7))
        first = s.message("state")
        end = len(model["points"]) // 3 - 1
        assert near(at(first, end, 3), (far + 6, far + 2, far + 2))
        s.send(places(1, [(0, 7, at(first, 0, 3)), (end, 7, (far + 6.5, far + 2, far + 2))]))
        while not (len((state := s.rest())["pins"]) == 2 and state["held"]):
            pass
        assert near(at(state, end, 3), (far + 6.5, far + 2, far + 2)) and near(at(state, 0, 3), (far, far, far))


def volume(path):
    with Program(program, path) as p:
        s = p.socket()
        model = s.message("model")
        assert model["dimension"] == 3 and model["shows"] == 0
        state = s.message("state")
        last = len(model["points"]) // 3 - 1
        s.send(places(1, [(0, 7, (0, 0, 0)), (last, 7, (6.5, 2.5, 2))]))
        while not (len((state := s.rest())["pins"]) == 2 and state["held"]):
            pass
        assert near(at(state, last, 3), (6.5, 2.5, 2)) and state["flipped"] == 0
        s.send(save())
        file = s.message("file")
        assert file["name"] == "bar.mesh" and b"\n6.5 2.5 2 0\n" in file["bytes"], file["bytes"][-400:]


def manifold(cells):
    """Whether no edge is run through twice in one direction, and how many have one side."""
    edges = set()
    for i in range(0, len(cells), 3):
        f = cells[i:i + 3]
        for e in ((f[0], f[1]), (f[1], f[2]), (f[2], f[0])):
            assert e not in edges, e
            edges.add(e)
    return sum((b, a) not in edges for a, b in edges)


def pasting(path, n):
    onto = (n // 2) * (n + 1) + n // 2
    with Program(program, path, "--source", path, "--at", str(onto), "--radius", "0.3", "--onto", str(onto), "--scale", "0.5") as p:
        s = p.socket()
        model = s.message("model")
        assert model["dimension"] == 3 and model["shows"] == 2 and model["feature"] < len(model["faces"]) // 3
        rim = manifold(model["faces"])
        assert rim == 4 * n
        first = s.message("state")
        assert first["pose"] == (0, 0.5, 0) and first["positions"] == model["points"]

        s.send(pose(1, turn=0.2, scale=0.5, softness=0.5))
        turned = s.rest()
        assert turned["pose"] == (0.2, 0.5, 0.5) and len(turned["positions"]) == len(first["positions"]) != first["positions"]
        s.send(pose(1, turn=2.0, scale=0.5))  # attached anew
        assert manifold(s.message("model")["faces"]) == rim
        turned = s.message("state")
        away = next(v for v in range(len(turned["positions"]) // 3) if near(at(turned, v, 3)[:2], (0.25, 0.25), 0.05))
        s.send(pose(2, onto=away, turn=0.5, scale=0.4))
        moved = s.message("model")
        assert manifold(moved["faces"]) == rim
        s.rest()

        # Along the surface, by more than an edge and by less; not beyond its border.
        def middle(model):
            rim = model["faces"][3 * model["feature"]:]
            return [sum(model["points"][3 * v + k] for v in rim) / len(rim) for k in (0, 1)]

        beside = moved
        for by in ((0.1, 0, 0), (0, 1e-3, 0)):
            s.send(move(2, by))
            before, beside = middle(beside), s.message("model")
            assert manifold(beside["faces"]) == rim
            there = [q - p for p, q in zip(before, middle(beside))]
            assert there[0 if by[0] else 1] > 0.5 / n and abs(there[1 if by[0] else 0]) < 1.5 / n, (by, there)
            s.rest()
        s.send(move(2, (-5, 0, 0)))
        note = s.message("note")["text"]
        assert "choose another vertex" in note, note
        s.send(pose(2, onto=next(v for v in range(len(beside["points"]) // 3) if near(beside["points"][3 * v:3 * v + 2], (0.25, 0.75), 0.05)),
                    turn=0.5, scale=0.4))
        moved = s.message("model")
        s.rest()
        s.send(keep(3))
        kept = s.message("model")
        assert kept["faces"] == moved["faces"] and kept["feature"] == 2 ** 32 - 1
        s.rest()
        s.send(pose(4, turn=1.0))
        assert "not placed" in s.message("note")["text"]
        s.send(move(4, (0.3, -0.05, 0)))  # from where it was
        again = s.message("model")
        assert again["feature"] < len(again["faces"]) // 3 and middle(again)[0] > middle(moved)[0] + 0.1
        s.rest()
        s.send(undo())
        assert s.message("model")["faces"] == kept["faces"]
        s.rest()
        far = next(v for v in range(len(kept["points"]) // 3) if near(kept["points"][3 * v:3 * v + 2], (0.7, 0.7), 0.05))
        s.send(pose(5, onto=far, scale=0.4))
        twice = s.message("model")
        assert manifold(twice["faces"]) == rim and len(twice["points"]) > len(kept["points"])
        s.rest()
        s.send(save())
        file = s.message("file")
        assert file["name"] == "dome-pasted.obj" and file["bytes"].count(b"\nf ") == len(twice["faces"]) // 3
        for _ in range(4):  # the refused wish was none
            s.send(undo())
        while True:
            back = s.message("state")
            if not back["can_undo"]:
                break
        assert back["positions"] == first["positions"] and back["pose"] == first["pose"]
        s.send(places(6, [(1, 7, (0, 0, 0))]))
        assert "no pins" in s.message("note")["text"]


def tessellated(path, n):
    """The feature as about so many triangles, whatever it has, with the same rim: also where it is put anew."""
    onto = (n // 2) * (n + 1) + n // 2
    options = ("--source", path, "--at", str(onto), "--radius", "0.3", "--onto", str(onto), "--scale", "0.5", "--triangles")
    counts = []
    for wanted in (200, 2000):
        with Program(program, path, *options, str(wanted)) as p:
            s = p.socket()
            model = s.message("model")
            assert manifold(model["faces"]) == 4 * n
            counts.append(len(model["faces"]) // 3 - model["feature"])
            first = s.message("state")
            s.send(pose(1, turn=0.1, scale=0.5, softness=0.5))
            turned = s.rest()
            assert len(turned["positions"]) == len(first["positions"]) and turned["positions"] != first["positions"]
            s.send(pose(1, turn=2.0, scale=0.5))
            again = s.message("model")
            assert manifold(again["faces"]) == 4 * n
            assert abs((len(again["faces"]) // 3 - again["feature"]) / counts[-1] - 1) < 0.3
    assert 100 < counts[0] < 400 < 1000 < counts[1] < 4000, counts


def no_surface(path, n):
    """A result that `taut paste` does not write is not saved or kept either, and the page is told why."""
    pinched = path.replace("dome.obj", "pinched.obj")  # a triangle touches the surface at a vertex, far from the feature
    last = (n + 1) ** 2
    with open(path) as f, open(pinched, "w") as out:
        out.write(f.read() + f"v 0 0 1\nv 0 -1 1\nf {n + 6} {last + 1} {last + 2}\n")
    onto = (n // 2) * (n + 1) + n // 2
    with Program(program, pinched, "--source", path, "--at", str(onto), "--radius", "0.3", "--onto", str(onto), "--scale", "0.5") as p:
        s = p.socket()
        state = s.message("state")
        for wish in (save(), keep(2)):
            s.send(wish)
            text = s.message("note")["text"]
            assert "not manifold" in text and "fan" in text, text
        s.send(redo())
        after = s.message("state")
        assert after["positions"] == state["positions"] and not after["can_undo"]


def in_the_way(path, n):
    """Two pins that exchange their places cannot: the page comes to rest all the same, and soon."""
    with Program(program, path) as p:
        s = p.socket()
        s.message("model")
        state = s.message("state")
        middle = (n + 1) * (n // 2) + n // 2
        for a, b in ((middle, middle + 2), (middle + 6, middle + 7)):
            s.send(places(a, [(a, 3, (*at(state, b), 0)), (b, 3, (*at(state, a), 0))]))
            states = 1
            while (state := s.message("state"))["working"] or a not in state["pins"]:
                states += 1
                assert states < 120, "it goes on and on"
            assert state["flipped"] == 0


if __name__ == "__main__":
    program, folder = sys.argv[1], tempfile.mkdtemp(dir=sys.argv[2])
    n = dome(f"{folder}/dome.obj")
    bar(f"{folder}/bar.mesh")
    a_page(f"{folder}/dome.obj", n)
    in_the_way(f"{folder}/dome.obj", n)
    strangers(f"{folder}/dome.obj")
    idle(f"{folder}/dome.obj")
    opened(f"{folder}/dome.obj")
    volume(f"{folder}/bar.mesh")
    far_away(f"{folder}/far.mesh")
    pasting(f"{folder}/dome.obj", n)
    tessellated(f"{folder}/dome.obj", n)
    no_surface(f"{folder}/dome.obj", n)
    shell(f"{folder}/dome.obj", n)
    without_effect(f"{folder}/dome.obj", f"{folder}/bar.mesh")
    print("view: all as it should be")
