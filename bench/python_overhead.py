#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What calls from Python cost: seconds of maps, atlases and frames of sessions; the rate of another thread during a solve; memory over
many sessions; how soon Ctrl-C ends a call. PYTHONPATH=build/release/python bench/python_overhead.py"""

import gc
import os
import pathlib
import resource
import signal
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


def counting(work):
    """How many times a second a thread of Python counts while `work` runs."""
    stop, count = threading.Event(), [0]

    def run():
        while not stop.is_set():
            for _ in range(1000):
                count[0] += 1

    thread = threading.Thread(target=run)
    thread.start()
    start = time.perf_counter()
    work()
    rate = count[0] / (time.perf_counter() - start)
    stop.set()
    thread.join()
    return rate


def rates():
    V, F = bowl_of(250)
    os.environ.setdefault("TAUT_THREADS", "1")
    alone = counting(lambda: time.sleep(2))

    def solve():
        end = time.monotonic() + 2
        while time.monotonic() < end:
            taut.unwrap(V, F, tolerance=1e-9)

    def burn():  # as busy, without Python: a process that takes as many processors
        import subprocess
        code = "import time\nend = time.monotonic() + 2\nwhile time.monotonic() < end: pass"
        children = [subprocess.Popen([sys.executable, "-c", code]) for _ in range(os.cpu_count() or 1)]
        for child in children:
            child.wait()

    during, beside = counting(solve), counting(burn)
    return f"{during / alone:.2f} of the rate alone; {beside / alone:.2f} beside as many busy processes as processors"


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


if __name__ == "__main__":
    V, F = bowl_of(106)
    print(f"map of {len(F)} triangles:", times(lambda: taut.unwrap(V, F), 15))
    V1, F1 = bowl_of(224)
    print(f"atlas of {len(F1)} triangles, repair=False:", times(lambda: taut.atlas(V1, F1, repair=False), 3))
    print(f"atlas of {len(F1)} triangles:", times(lambda: taut.atlas(V1, F1), 3))
    print("frame of a session, one step:", frames())
    print("counting thread:", rates())
    print("sessions:", sessions())
    print("Ctrl-C:", interruptions())
