# SPDX-License-Identifier: MIT
"""many_dask.py FOLDER OUT: atlases of all surfaces of a folder on a cluster of Dask, here of this machine.

A mesh that fails costs its own line and nothing else."""

import pathlib
import sys

from dask.distributed import Client, LocalCluster, as_completed

from many import make, prepare


def task(path, out):
    prepare(out)
    return make(path, out)


if __name__ == "__main__":
    source, out = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    out.mkdir(exist_ok=True)
    paths = sorted(p for p in source.iterdir() if p.suffix in (".obj", ".off", ".ply", ".stl"))
    # Processes of one thread, which Dask spawns: OpenCL does not survive fork.
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        jobs = {client.submit(task, p, out, pure=False): p for p in paths}
        for job in as_completed(jobs):
            error = job.exception()
            print(f"{jobs[job].name}: {job.result() if error is None else error}")
