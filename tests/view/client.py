# SPDX-License-Identifier: MIT
"""A WebSocket client that can also be rude, and the messages of `taut view`."""
import base64
import os
import socket
import struct
import subprocess


class Program:
    """`taut view FILE` at work. Use as a context; port and token are those of the address that it prints."""

    def __init__(self, program, file, *options, browser=None):
        """browser: environment in which the program opens one"""
        quiet = ["--no-browser"] if browser is None else []
        self.process = subprocess.Popen([program, "view", file, *quiet, *options], stdout=subprocess.PIPE, text=True, env=browser)
        self.url = self.process.stdout.readline().strip()
        assert self.url.startswith("http://127.0.0.1:"), self.url
        address, self.token = self.url.split("/#")
        self.port = int(address.rsplit(":", 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def request(self, target="/", method="GET", host=None, origin=None, body=b"", extra=()):
        """Status and text of the answer to one request."""
        lines = [f"{method} {target} HTTP/1.1", f"Host: {host or f'127.0.0.1:{self.port}'}"]
        if origin is not None:
            lines.append(f"Origin: {origin}")
        lines += extra
        with socket.create_connection(("127.0.0.1", self.port), timeout=20) as s:
            s.sendall("\r\n".join([*lines, "", ""]).encode() + body)
            answer = b""
            while chunk := s.recv(1 << 16):
                answer += chunk
        head, _, text = answer.partition(b"\r\n\r\n")
        return int(head.split()[1]), head.decode(), text

    def socket(self, host=None, origin=None, token=None, target="/live"):
        """A WebSocket, or the status that it was refused with."""
        host = host or f"127.0.0.1:{self.port}"
        origin = f"http://{host}" if origin is None else origin
        lines = [f"GET {target} HTTP/1.1", f"Host: {host}", "Upgrade: websocket", "Connection: Upgrade",
                 f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}", "Sec-WebSocket-Version: 13",
                 f"Sec-WebSocket-Protocol: taut, token.{self.token if token is None else token}"]
        if origin:
            lines.append(f"Origin: {origin}")
        s = socket.create_connection(("127.0.0.1", self.port), timeout=30)
        s.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # as browsers do
        s.sendall("\r\n".join([*lines, "", ""]).encode())
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            byte = s.recv(1)
            if not byte:
                break
            head += byte
        status = int(head.split()[1])
        if status != 101:
            s.close()
            return status
        return Socket(s)


class Socket:
    def __init__(self, s):
        self.s = s

    def close(self):
        self.s.close()

    def send(self, payload, opcode=2, length=None):
        """One masked frame; length: what it says of itself, if not the truth."""
        n = len(payload) if length is None else length
        head = bytes([0x80 | opcode])
        head += bytes([0x80 | n]) if n < 126 else bytes([0x80 | 126]) + struct.pack(">H", n) if n < 65536 else bytes([0x80 | 127]) + struct.pack(">Q", n)
        mask = os.urandom(4)
        self.s.sendall(head + mask + bytes(b ^ mask[i & 3] for i, b in enumerate(payload)))

    def _exactly(self, n):
        out = b""
        while len(out) < n:
            chunk = self.s.recv(n - len(out))
            if not chunk:
                raise EOFError
            out += chunk
        return out

    def frame(self):
        """The next message; EOFError when it was closed."""
        while True:
            first, second = self._exactly(2)
            n = second & 127
            if n == 126:
                n = struct.unpack(">H", self._exactly(2))[0]
            elif n == 127:
                n = struct.unpack(">Q", self._exactly(8))[0]
            payload = self._exactly(n)
            opcode = first & 15
            if opcode == 8:
                raise EOFError
            if opcode == 9:
                self.send(payload, 10)
            elif opcode in (1, 2):
                return payload

    def message(self, kind):
        """The next message of a kind; states that come before are said to be drawn."""
        while True:
            m = read(self.frame())
            if m["kind"] == "state":
                self.send(seen(m["number"]))
            if m["kind"] == kind:
                return m

    def rest(self):
        """The first state in which nothing is at work any more and that answers what was sent before."""
        while True:
            m = self.message("state")
            if not m["working"]:
                return m


def places(gesture, pins):
    return struct.pack("<BII", 1, gesture, len(pins)) + b"".join(struct.pack("<IB3d", v, held, *x) for v, held, x in pins)


def ids(kind, gesture, vertices):
    return struct.pack("<BII", kind, gesture, len(vertices)) + struct.pack(f"<{len(vertices)}I", *vertices)


def release(gesture, vertices):
    return ids(2, gesture, vertices)


def focus(gesture, faces):
    return ids(3, gesture, faces)


def relax(gesture, afresh=False):
    return struct.pack("<BIB", 4, gesture, afresh)


def align(gesture, axis, vertices):
    return struct.pack("<BIBI", 5, gesture, axis, len(vertices)) + struct.pack(f"<{len(vertices)}I", *vertices)


def pose(gesture, onto=-1, turn=0.0, scale=1.0, softness=0.0):
    return struct.pack("<BIi3d", 10, gesture, onto, turn, scale, softness)


def move(gesture, by):
    return struct.pack("<BI3d", 12, gesture, *by)


def keep(gesture):
    return struct.pack("<BI", 11, gesture)


def undo():
    return struct.pack("<BI", 6, 0)


def redo():
    return struct.pack("<BI", 7, 0)


def save():
    return struct.pack("<BI", 8, 0)


def seen(number):
    return struct.pack("<BII", 9, 0, number)


def read(b):
    at = 1

    def take(fmt):
        nonlocal at
        values = struct.unpack_from("<" + fmt, b, at)
        at += struct.calcsize("<" + fmt)
        return values if len(values) > 1 else values[0]

    def block():
        nonlocal at
        n = take("I")
        at += n
        return b[at - n:at]

    def many(fmt):
        n = take("I")
        return list(take(f"{n}{fmt}")) if n > 1 else [take(fmt) for _ in range(n)]

    if b[0] == 64:
        return {"kind": "model", "dimension": take("B"), "shows": take("B"), "name": block().decode(), "points": many("f"), "faces": many("I"), "feature": take("I")}
    if b[0] == 65:
        flags = take("B")
        m = {"kind": "state", **{k: bool(flags >> i & 1) for i, k in enumerate(("converged", "held", "working", "can_undo", "can_redo", "writer"))}}
        m["number"], m["flipped"], m["energy"], m["distance"], m["seconds"] = take("IIddd")
        m["pose"] = take("ddd")
        m["pins"] = {}
        for _ in range(take("I")):
            v, held, *x = take("IB3d")
            m["pins"][v] = (held, x)
        m["origin"] = take("ddd")
        m["positions"] = many("f")
        return m
    if b[0] == 66:
        return {"kind": "note", "text": block().decode()}
    return {"kind": "file", "name": block().decode(), "bytes": block()}
