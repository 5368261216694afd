# SPDX-License-Identifier: MIT
"""many_ray.py FOLDER OUT: atlases of all surfaces of a folder on the machines of a cluster of Ray, or on this one.

A mesh that fails costs its own line and nothing else."""

import os
import pathlib
import sys

import ray

from many import make, prepare


@ray.remote(num_cpus=1, max_retries=1)
def task(path, out):
    prepare(out)  # Ray starts its workers anew, so OpenCL is safe in them
    return make(path, out)


if __name__ == "__main__":
    source, out = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    out.mkdir(exist_ok=True)
    here = str(pathlib.Path(__file__).resolve().parent)
    paths = os.pathsep.join(filter(None, [here, os.environ.get("PYTHONPATH")]))  # the workers import many.py, too
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": {"PYTHONPATH": paths}})
    jobs = {task.remote(p, out): p for p in sorted(source.iterdir()) if p.suffix in (".obj", ".off", ".ply", ".stl")}
    left = list(jobs)
    while left:
        (job,), left = ray.wait(left)
        try:
            print(f"{jobs[job].name}: {ray.get(job)}")
        except ray.exceptions.RayTaskError as e:
            print(f"{jobs[job].name}: {e.cause}")
    ray.shutdown()
