#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""view.py TAUT MESH [PINS [FRAMES [SECONDS]]]: times of `taut view` as its page sees them.

One vertex, then PINS of them (300) at once, are led along a circle of a twentieth of the map, one message a frame; milliseconds from a message to the
state that has granted it, all of them, processor time of the program a frame, and memory; the first drag is told, too, but is not in the table at
the end, as what drivers compile late is in it. Then, for SECONDS, one vertex after another, each a gesture of its own: memory once a minute."""
import math
import os
import pathlib
import random
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "view"))
from client import Program, places  # noqa: E402


def drag(s, state, vertices, gesture, frames):
    """Leads vertices around; milliseconds of each frame, and the last state."""
    start = {v: state["positions"][2 * v:2 * v + 2] for v in vertices}
    xs = state["positions"][::2]
    radius = (max(xs) - min(xs)) / 20
    times = []
    for frame in range(1, frames + 1):
        a = 2 * math.pi * frame / frames
        goal = {v: (x + radius * math.sin(a), y + radius * (1 - math.cos(a)), 0.0) for v, (x, y) in start.items()}
        begin = time.perf_counter()
        s.send(places(gesture, [(v, 3, x) for v, x in goal.items()]))
        while True:
            state = s.message("state")
            if all(tuple(state["pins"].get(v, (0, [None, None]))[1][:2]) == goal[v][:2] for v in vertices):
                break
        times.append(1000 * (time.perf_counter() - begin))
        assert state["flipped"] == 0, "a flip"
    while state["working"]:
        state = s.message("state")
    return times, state


def memory(pid):
    return int(next(line for line in open(f"/proc/{pid}/status") if line.startswith("VmRSS")).split()[1]) / 1024


def processor(pid):
    """Seconds of processor time."""
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    program, mesh = sys.argv[1:3]
    pins = int(sys.argv[3]) if len(sys.argv) > 3 else 300
    frames = int(sys.argv[4]) if len(sys.argv) > 4 else 120
    seconds = float(sys.argv[5]) if len(sys.argv) > 5 else 0
    with Program(program, mesh) as p:
        s = p.socket()
        model = s.message("model")
        state = s.message("state")
        count = len(model["points"]) // 3
        print(f"{model['name']}: {len(model['faces']) // 3} triangles, {memory(p.process.pid):.0f} MB")
        random.seed(1)
        one = random.randrange(count)
        many = random.sample(range(count), pins)
        table = []
        for gesture, (name, vertices) in enumerate((("first drag", [one]), ("one pin", [one]), (f"{pins} pins", many), ("one pin beside them", [one]))):
            before = processor(p.process.pid)
            times, state = drag(s, state, vertices, gesture + 1, frames)
            ordered = sorted(times)
            line = (f"{name}: median {statistics.median(times):.1f}, 95 % {ordered[int(0.95 * len(ordered))]:.1f}, most {ordered[-1]:.1f} ms; "
                    f"processor {1000 * (processor(p.process.pid) - before) / frames:.1f} ms a frame, rest included")
            table += [line] if gesture > 0 else []
            print(f"{line}; energy {state['energy']:.6g}, pins {'hold' if state['held'] else 'ahead'}, {memory(p.process.pid):.0f} MB", flush=True)
        start = minute = time.monotonic()
        gesture = messages = 100
        while time.monotonic() < start + seconds:
            gesture += 1
            times, state = drag(s, state, [random.choice(many)], gesture, frames)
            messages += len(times)
            if time.monotonic() > minute:
                minute += 60
                print(f"{time.monotonic() - start:.0f} s: {messages - 100} messages, {memory(p.process.pid):.0f} MB", flush=True)
        print("\n".join([f"\n{model['name']}, {len(model['faces']) // 3} triangles, {frames} frames each, load {os.getloadavg()[0]:.1f}"] + table))


main()
