#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What calls from Python cost: seconds of maps, atlases and frames of sessions; the rate of another thread during a solve; memory over
many sessions; how soon Ctrl-C ends a call. PYTHONPATH=build/release/python bench/python_overhead.py [PART ...], where parts are maps, atlases,
frames, counting, sessions, interrupts."""

import gc
import os
import pathlib
import resource
import signal
import subprocess
import sys
import threading
import time

import numpy as np

import taut

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python" / "tests"))
from conftest import bowl_of  # noqa: E402


def times(function, count):
    function()
    seconds = []
    for _ in range(count):
        start = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - start)
    return f"median {np.median(seconds):.4f} s, least {min(seconds):.4f} s"


def frames():
    V, F = bowl_of(106)
    seconds = []
    with taut.Session(V, F) as s:
        x = s.solve().x
        s.pin(0, x[0]).pin(len(V) - 1, x[-1]).solve()
        for k in range(1, 61):
            start = time.perf_counter()
            s.pin(5600, x[5600] + [0.001 * k, 0]).solve(steps=1)
            seconds.append(time.perf_counter() - start)
    return f"median {np.median(seconds):.5f} s, least {min(seconds):.5f} s"


def scheduled(thread):
    """Seconds that a thread of this process was on a processor, and that it waited for one."""
    return [int(x) / 1e9 for x in open(f"/proc/self/task/{thread}/schedstat").read().split()[:2]]


def counting(work):
    """How a thread of Python counts while `work` runs: times a second, and the parts of the time on a processor, waiting for one,
    and neither, which is that in which the interpreter's lock keeps it."""
    stop, count = threading.Event(), [0]

    def run():
        while not stop.is_set():
            for _ in range(1000):
                count[0] += 1

    thread = threading.Thread(target=run)
    thread.start()
    time.sleep(0.1)
    begin, start, before = count[0], time.perf_counter(), scheduled(thread.native_id)
    work()
    seconds, after = time.perf_counter() - start, scheduled(thread.native_id)
    rate = (count[0] - begin) / seconds
    stop.set()
    thread.join()
    on, waiting = ((b - a) / seconds for a, b in zip(before, after))
    return rate, on, waiting, max(0.0, 1 - on - waiting)


SOLVES = """
import sys, time
sys.path.insert(0, {tests!r})
from conftest import bowl_of
import taut
V, F = bowl_of(250)
taut.unwrap(V, F, tolerance=1e-9)
print(flush=True)
end = time.monotonic() + 60
while time.monotonic() < end: taut.unwrap(V, F, tolerance=1e-9)
"""


def beside(code, count=1):
    """A thread counts for four seconds beside processes that run Python code, once each has written a line."""
    children = [subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) for _ in range(count)]
    for child in children:
        child.stdout.readline()
    result = counting(lambda: time.sleep(4))
    for child in children:
        child.kill()
        child.wait()
        child.stdout.close()
    return result


def rates():
    V, F = bowl_of(250)
    taut.unwrap(V, F, tolerance=1e-9)
    alone = counting(lambda: time.sleep(2))

    def solve():
        end = time.monotonic() + 4
        while time.monotonic() < end:
            taut.unwrap(V, F, tolerance=1e-9)

    tests = str(pathlib.Path(__file__).resolve().parents[1] / "python" / "tests")
    rows = {
        "a solve in this process": counting(solve),
        "the same solve in another process": beside(SOLVES.format(tests=tests)),
        "one busy process": beside("print(flush=True)\nwhile True: pass"),
        "as many busy processes as processors": beside("print(flush=True)\nwhile True: pass", os.cpu_count() or 1),
    }
    return "".join(
        f"\n  beside {name}: {rate / alone[0]:.2f} of the rate alone; {waiting:.2f} of the time waiting for a processor, "
        f"{lock:.3f} for the interpreter's lock" for name, (rate, _, waiting, lock) in rows.items())


def sessions():
    V, F = bowl_of(16)

    def some(count):
        for _ in range(count):
            with taut.Session(V, F) as s:
                s.pin(0, s.solve().x[0]).solve(steps=1)
        gc.collect()
        return int(open("/proc/self/statm").read().split()[1]) * resource.getpagesize() / 1e6

    return " -> ".join(f"{some(k):.1f}" for k in (20, 90, 90)) + " MB after 20, 110 and 200"


def interruptions():
    V, F = bowl_of(250)
    late, best = [], 0
    for moment in np.linspace(0.001, 0.4, 50):
        timer = threading.Timer(moment, os.kill, (os.getpid(), signal.SIGINT))
        start = time.monotonic()
        timer.start()
        try:
            while True:
                taut.unwrap(V, F, tolerance=1e-14)
        except KeyboardInterrupt as e:
            late.append(time.monotonic() - start - moment)
            best += getattr(e, "best", None) is not None
        timer.join()
    assert taut.unwrap(*bowl_of(8)).certified
    return f"50 of 50 ended, median {np.median(late):.3f} s, latest {max(late):.3f} s after the signal, {best} with a map"


def maps():
    V, F = bowl_of(106)
    return f"{len(F)} triangles, " + times(lambda: taut.unwrap(V, F), 15)


def atlases():
    V, F = bowl_of(224)
    checked, repaired = (times(lambda: taut.atlas(V, F, repair=r), 3) for r in (False, True))
    return f"{len(F)} triangles, repair=False, {checked}; with repair, {repaired}"


PARTS = {"maps": maps, "atlases": atlases, "frames": frames, "counting": rates, "sessions": sessions, "interrupts": interruptions}

if __name__ == "__main__":
    for part in sys.argv[1:] or PARTS:
        print(f"{part}: {PARTS[part]()}", flush=True)
