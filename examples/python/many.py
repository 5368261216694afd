# SPDX-License-Identifier: MIT
"""many.py FOLDER OUT: atlases of all surfaces of a folder, several at a time, in processes of their own.

A mesh that fails costs its own line and nothing else."""

import concurrent.futures
import multiprocessing
import os
import pathlib
import sys

import taut


def make(path, folder):
    mesh = taut.read(path)
    made = taut.atlas(*mesh, time_limit=600)
    taut.write(pathlib.Path(folder) / (pathlib.Path(path).stem + ".obj"), like=mesh, uv=made)
    return f"{made.charts} charts, {made.seconds:.1f} s"


def prepare(folder, slot=None):
    """Each process has kernels of its own: PoCL's cache is not safe between processes that start cold."""
    os.environ["POCL_CACHE_DIR"] = str(pathlib.Path(folder) / f"kernels-{os.getpid()}")
    os.makedirs(os.environ["POCL_CACHE_DIR"], exist_ok=True)


if __name__ == "__main__":
    source, out = map(pathlib.Path, sys.argv[1:3])
    out.mkdir(exist_ok=True)
    paths = sorted(p for p in source.iterdir() if p.suffix in (".obj", ".off", ".ply", ".stl"))
    spawn = multiprocessing.get_context("spawn")  # OpenCL does not survive fork
    with concurrent.futures.ProcessPoolExecutor(2, spawn, prepare, (out,)) as pool:
        jobs = {pool.submit(make, p, out): p for p in paths}
        for job in concurrent.futures.as_completed(jobs):
            error = job.exception()
            print(f"{jobs[job].name}: {job.result() if error is None else error}")
