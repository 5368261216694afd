# SPDX-License-Identifier: MIT
"""conflicts.py TAUT FOLDER: no job of a batch writes a file of another one: nothing is run, in any part. In an emptied FOLDER."""
import json
import os
import shutil
import subprocess
import sys

taut, folder = os.path.abspath(sys.argv[1]), sys.argv[2]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
for name in ("made.obj", "tile.1001.png"):
    with open(name, "w"):
        pass
with open("a.obj", "w") as f:
    f.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
os.symlink("new.obj", "link.obj")  # leads nowhere yet
os.symlink(".", "here")
os.link("made.obj", "hard.obj")


def batch(jobs, *options):
    with open("jobs.jsonl", "w") as f:
        f.writelines(json.dumps({"id": id, "args": args}) + "\n" for id, args in jobs.items())
    return subprocess.run([taut, "batch", "--manifest", "jobs.jsonl", "--output", "results.jsonl", "--cache", "cache", *options],
                          capture_output=True, text=True, timeout=100)


def unwrap(out, *more):
    return ["unwrap", "a.obj", "-o", out, *more]


def bake(out):
    return ["bake", "old.obj", "new.obj", "--texture", "x.png", "-o", out]


for first, second, says in (
        (unwrap("new.obj"), unwrap("new.obj"), "job b would write new.obj, which job a writes, too; name another file"),
        (unwrap("new.obj"), unwrap("./here/new.obj"), "job b would write ./here/new.obj, which job a writes, too, as new.obj; "),
        (unwrap("new.obj"), unwrap("link.obj"), "link.obj"),
        (unwrap("made.obj"), unwrap("hard.obj"), "hard.obj"),
        (unwrap("1.obj", "--stats", "s.json"), unwrap("2.obj", "--stats", "s.json"), "write s.json, which job"),
        (unwrap("new.obj"), ["check", "link.obj"], "job a would write new.obj, which job b reads, as link.obj; name another file"),
        (["check", "made.obj"], unwrap("made.obj"), "job b would write made.obj, which job a reads; "),
        (bake("new.1004.png"), bake("new.<UDIM>.png"), "new.<UDIM>.png"),
        (bake("tile.1001.png"), bake("tile.<UDIM>.png"), "tile.1001.png"),
        (["atlas", "a.obj", "-o", "x.gltf"], ["atlas", "a.obj", "-o", "y.obj", "--stats", "x.bin"], "x.bin"),
        (unwrap("new.obj", "--stats", "/dev/stderr"), unwrap("new.obj", "--stats", "/dev/stderr"), "new.obj")):
    jobs = {"b": second, "c": unwrap("c.obj"), "a": first}
    for part in ((), ("--shard", "1/3"), ("--resume",)):
        run = batch(jobs, *part)
        assert run.returncode == 2, (says, run)
        assert all(one in run.stderr for one in ("jobs.jsonl: job ", "job a ", "job b ", says)), (says, run.stderr)
        assert not os.path.exists("results.jsonl") and not os.path.exists("c.obj"), says

# The batch itself reads the manifest and writes results: by whatever name, and of standard streams, too.
os.symlink("jobs.jsonl", "to-jobs.json")
os.symlink("results.jsonl", "to-results.json")
os.mkdir("cache")
os.symlink("cache", "to-cache")
for args, says in ((unwrap("1.obj", "--stats", "results.jsonl"), "job a would write results.jsonl, which the batch itself writes, too; "),
                   (unwrap("1.obj", "--stats", "here/results.jsonl"), "results.jsonl, which the batch itself writes, too, as results.jsonl; "),
                   (unwrap("1.obj", "--stats", "to-results.json"), "to-results.json"),
                   (unwrap("1.obj", "--stats", "jobs.jsonl"), "job a would write jobs.jsonl, which the batch itself reads; "),
                   (unwrap("1.obj", "--stats", "to-jobs.json"), "to-jobs.json"),
                   (unwrap("1.obj", "--stats", "to-cache/0.lock"), "compiled kernels"),
                   (["check", "to-results.json"], "job a would read to-results.json, which the batch itself writes, as results.jsonl; ")):
    run = batch({"b": unwrap("c.obj"), "a": args})
    assert run.returncode == 2 and says in run.stderr, (says, run.stderr)
    assert not os.path.exists("results.jsonl") and not os.path.exists("c.obj"), says
with open("jobs.jsonl", "w") as f:
    f.write(json.dumps({"id": "a", "args": unwrap("1.obj", "--stats", "log.txt")}) + "\n")
with open("log.txt", "w") as log:
    run = subprocess.run([taut, "batch", "--manifest", "jobs.jsonl", "--cache", "cache"], stdout=log, stderr=subprocess.PIPE, text=True)
assert run.returncode == 2 and "log.txt, which the batch itself writes, too, as /dev/stdout" in run.stderr, run

# Of jobs that come one by one, each is looked at before it is run.
jobs = [{"id": "a", "args": unwrap("1.obj", "--stats", "to-results.json")}, {"id": "b", "args": ["unwrap", "none.obj", "-o", "/dev/null"]},
        {"id": "c", "args": unwrap("1.obj", "--stats", "jobs.jsonl")}]
with open("jobs.jsonl", "w") as f:
    f.writelines(json.dumps(one) + "\n" for one in jobs)
with open("jobs.jsonl") as f:
    before = f.read()
    f.seek(0)
    run = subprocess.run([taut, "batch", "--stdin", "--output", "results.jsonl", "--cache", "cache"], stdin=f, capture_output=True, text=True)
assert run.returncode == 10 and "3 jobs: 3 done, 3 of them failed" in run.stdout, run
with open("results.jsonl") as f:
    results = {one["id"]: one for one in map(json.loads, f)}
assert [results[k]["code"] for k in "abc"] == [2, 3, 2] and "to-results.json" in results["a"]["error"], results
with open("jobs.jsonl") as f:
    assert "the batch itself reads" in results["c"]["error"] and f.read() == before, results
os.remove("results.jsonl")

# What is read by many, /dev/null and a surface that a job replaces are no conflicts.
run = batch({"a": ["unwrap", "none.obj", "-o", "/dev/null"], "b": ["unwrap", "none.obj", "-o", "/dev/null"], "c": ["unwrap", "other.obj", "-o", "other.obj"]})
assert run.returncode == 10 and "3 jobs: 3 done, 3 of them failed" in run.stdout, run
print("batch: conflicts: all as it should be")
