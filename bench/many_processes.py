#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""many_processes.py [--sizes 8,16,32] [--processes 1,2] [--motions stretch,twist,bend] [--bin build/release/bin] [--folder F]

`taut deform` and `taut-mpi deform` on bars of 24 n^3 tetrahedra, 1 x 1 x 4, jittered inside, whose end is stretched by 1.5,
twisted by 90 degrees, or bent by 90 degrees: a table for docs/explanation/distribution.md. Each run is made twice, and the
second one counts, so that kernels are compiled. Processor seconds are of all processes, waiting in MPI included."""
import argparse
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import time

MOTIONS = ("stretch", "twist", "bend")


def target(motion, x, y, z):
    if motion == "stretch":
        return x, y, 1.5 * z
    if motion == "twist":  # by 90 degrees, about the middle
        return 0.5 - (y - 0.5), 0.5 + (x - 0.5), z
    radius = 8 / math.pi  # of the middle line
    return 0.5 + radius, y, radius - (x - 0.5)


def write_bar(n, path):
    """The bar as MEDIT; the vertices of its ends."""
    r = random.Random(1)
    ends, k_of = [[], []], (n + 1) ** 2
    with open(path, "w") as f:
        f.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{k_of * (4 * n + 1)}\n")
        for k in range(4 * n + 1):
            for j in range(n + 1):
                for i in range(n + 1):
                    p = [i / n, j / n, k / n]
                    for c in range(3):
                        if 0 < p[c] < (4 if c == 2 else 1):
                            p[c] += r.uniform(-0.15, 0.15) / n
                    if k in (0, 4 * n):
                        ends[k > 0].append(((k * (n + 1) + j) * (n + 1) + i, p))
                    f.write("%.17g %.17g %.17g 0\n" % tuple(p))
        f.write(f"Tetrahedra\n{24 * n**3}\n")
        steps = (1, n + 1, k_of)
        for k in range(4 * n):
            for j in range(n):
                for i in range(n):
                    first = (k * (n + 1) + j) * (n + 1) + i + 1
                    for o, (a, b, c) in enumerate(((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2))):
                        t = [first, first + steps[a], first + steps[a] + steps[b], first + sum(steps)]
                        if o >= 3:
                            t[1], t[2] = t[2], t[1]
                        f.write("%d %d %d %d 0\n" % tuple(t))
        f.write("End\n")
    return ends


def run(command, stats, environment):
    """Its report, with wall-clock and processor seconds of all that it started."""
    for _ in range(2):
        before, began = os.times(), time.monotonic()
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}: {done.returncode}\n{done.stderr}")
        now = os.times()
        with open(stats) as f:
            report = json.load(f)
    report["wall"] = time.monotonic() - began
    report["cpu"] = now.children_user + now.children_system - before.children_user - before.children_system
    return report


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--sizes", default="8,16,32")
    options.add_argument("--processes", default="1,2")
    options.add_argument("--motions", default=",".join(MOTIONS))
    options.add_argument("--bin", default="build/release/bin")
    options.add_argument("--folder", default=None)
    o = options.parse_args()
    folder = o.folder or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1",
                       OMPI_MCA_hwloc_base_binding_policy="none", OMPI_MCA_btl_vader_single_copy_mechanism="none",
                       OMP_NUM_THREADS="1")
    print("| bar | tetrahedra | processes | steps | products a step | energy | CPU s | us a tetrahedron | set-up, apply s |"
          " MB a process | sent MB |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for n in map(int, o.sizes.split(",")):
        mesh = f"{folder}/bar{n}.mesh"
        ends = write_bar(n, mesh)
        for motion in o.motions.split(","):
            pins, out, stats = f"{folder}/{motion}{n}.csv", f"{folder}/out.mesh", f"{folder}/stats.json"
            with open(pins, "w") as f:
                f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, *p) for v, p in ends[0])
                f.writelines("%d,%.17g,%.17g,%.17g\n" % (v, *target(motion, *p)) for v, p in ends[1])
            task = ["deform", mesh, "--pins", pins, "-o", out, "--stats", stats, "--quiet"]
            cells = 24 * n**3
            one = run([f"{o.bin}/taut", *task], stats, environment)
            print(f"| {motion} | {cells:,} | `taut` | {one['iterations']} | | {one['energy']:.10f} | {one['cpu']:.2f} | "
                  f"{1e6 * one['cpu'] / cells:.0f} | | {one['peak_memory_bytes'] / 2**20:.0f} | |", flush=True)
            for processes in o.processes.split(","):
                r = run(["mpirun", "-n", processes, f"{o.bin}/taut-mpi", *task], stats, environment)
                each = r["processes"]
                cpu = sum(p["processor_seconds"] for p in each)
                seconds = [sum(p["seconds"][phase] for p in each) for phase in ("setup", "apply")]
                memory = max(p["peak_memory_bytes"] for p in each)
                sent = sum(p["sent"][phase]["bytes"] for p in each for phase in ("distribute", "solve"))
                print(f"| | | {processes} | {r['iterations']} | {r['products'] / max(1, r['iterations']):.1f} | "
                      f"{r['energy']:.10f} | {cpu:.2f} | {1e6 * cpu / cells:.0f} | {seconds[0]:.2f}, {seconds[1]:.2f} | "
                      f"{memory / 2**20:.0f} | {sent / 1e6:.1f} |", flush=True)


if __name__ == "__main__":
    main()
