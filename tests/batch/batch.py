# SPDX-License-Identifier: MIT
"""batch.py CASE TAUT FOLDER: `taut batch` and jobs that go wrong in every way, in an emptied FOLDER."""
import hashlib
import json
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
import time


def sheet(path, n, lift=0.3):
    """A wavy sheet of 2 n^2 triangles as OBJ."""
    with open(path, "w") as f:
        for j in range(n + 1):
            f.writelines(f"v {i / n} {j / n} {lift * math.sin(7 * i / n) * math.cos(5 * j / n)}\n" for i in range(n + 1))
        for j in range(n):
            for a in range(1 + j * (n + 1), 1 + j * (n + 1) + n):
                f.write(f"f {a} {a + 1} {a + n + 2}\nf {a} {a + n + 2} {a + n + 1}\n")


def sha256(path):
    with open(path, "rb") as f:
        return hashlib.sha256(f.read()).hexdigest()


def manifest(jobs, path="jobs.jsonl"):
    with open(path, "w") as f:
        f.writelines(json.dumps(one) + "\n" for one in jobs)
    return path


def command(*options, jobs="jobs.jsonl", out="results.jsonl"):
    return [taut, "batch", "--manifest", jobs, "--output", out, "--cache", caches, *options]


def batch(*options, code=0, **names):
    """What a run printed; it ended with `code`."""
    run = subprocess.run(command(*options, **names), capture_output=True, text=True, timeout=300)
    assert run.returncode == code, (run.returncode, run.stdout, run.stderr)
    return run.stdout + run.stderr


def lines(path="results.jsonl"):
    with open(path) as f:
        text = f.read()
    assert text == "" or text.endswith("\n"), text[-200:]
    return [json.loads(line) for line in text.splitlines()]


def results(path="results.jsonl"):
    """By id, and each id once."""
    all = lines(path)
    assert len({one["id"] for one in all}) == len(all), [one["id"] for one in all]
    return {one["id"]: one for one in all}


def until(holds, seconds=300):
    end = time.monotonic() + seconds
    while not (value := holds()):
        assert time.monotonic() < end, "still not so"
        time.sleep(0.01)
    return value


def children(process):
    try:
        with open(f"/proc/{process}/task/{process}/children") as f:
            return [int(one) for one in f.read().split()]
    except FileNotFoundError:
        return []


def at_work_on(process, name):
    """Those children that name a file."""
    def names(one):
        try:
            with open(f"/proc/{one}/cmdline", "rb") as f:
                return name in f.read()
        except (FileNotFoundError, ProcessLookupError):
            return False  # it has just ended
    return [one for one in children(process) if names(one)]


def alive(process):
    try:
        with open(f"/proc/{process}/stat") as f:
            return f.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


def answers():
    sheet("a.obj", 8)
    manifest([
        {"id": "map", "args": ["unwrap", "a.obj", "-o", "a.flat.obj", "--stats", "a.json", "--quiet"]},
        {"id": "printed stats", "args": ["unwrap", "a.obj", "-o", "b.flat.obj", "--stats", "-"]},
        {"id": "no output", "args": ["check", "a.obj"]},
        {"id": "wrong usage", "args": ["unwrap", "a.obj", "--energy", "warm"]},
        {"id": "no input", "args": ["unwrap", "none.obj", "-o", "none.flat.obj"], "time_limit": 60}])
    said = batch(code=10)
    assert "5 jobs: 5 done, 2 of them failed" in said, said
    r = results()
    one = r["map"]
    assert (one["code"], one["outcome"]) == (0, "valid") and "error" not in one and "printed" not in one
    assert one["args"][:2] == ["unwrap", "a.obj"] and one["seconds"] > 0 and one["cpu_seconds"] > 0
    assert 1 << 20 < one["peak_memory"] < 1 << 34
    assert one["inputs"] == {"a.obj": sha256("a.obj")}
    assert one["outputs"] == {"a.flat.obj": sha256("a.flat.obj"), "a.json": sha256("a.json")}
    with open("a.json") as f:
        assert one["stats"] == json.load(f)
    assert r["printed stats"]["stats"]["input"] == "a.obj" and set(r["printed stats"]["outputs"]) == {"b.flat.obj"}
    assert "nothing wrong" in r["no output"]["printed"] and r["no output"]["outputs"] == {}
    assert (r["wrong usage"]["code"], r["wrong usage"]["outcome"]) == (2, "usage") and "warm" in r["wrong usage"]["error"]
    assert (r["no input"]["code"], r["no input"]["outcome"]) == (3, "unreadable_input")
    assert r["no input"]["inputs"] == {"none.obj": None} and "No such file" in r["no input"]["error"]

    # Without a file the results are what is printed.
    run = subprocess.run([taut, "batch", "--manifest", "-", "--cache", caches], capture_output=True, text=True,
                         input='\n{"id": "x", "args": ["check", "a.obj"]}\n\n')
    assert run.returncode == 0 and json.loads(run.stdout)["id"] == "x" and "1 job: 1 done" in run.stderr, run


def malformed():
    sheet("a.obj", 2)
    good = '{"id": "a", "args": ["check", "a.obj"]}\n'
    for text, says in (("{]", "is no JSON"), ("[1]", "is no JSON object"), ('{"args": ["check"]}', "has no id"), ('{"id": "b"}', "has no args"),
                       ('{"id": "b", "args": "check"}', "args is no list"), ('{"id": "b", "args": [1]}', "is no string"),
                       ('{"id": "b", "args": ["check"], "time_limit": -1}', "time_limit is no positive number"),
                       ('{"id": "b", "args": ["check"], "memory_limit": "1G"}', "memory_limit is no positive number"),
                       ('{"id": "b", "args": ["check"], "timelimit": 1}', "has the key timelimit"),
                       ('{"id": "b", "args": ["check"], "time_limit": 1, "time_limit": 2}', "has the key time_limit twice"),
                       ('{"id": "a", "args": ["check"]}', "has the id a of line 1"),
                       ('{"id": "b", "args": ["batch"]}', "is no job"), ('{"id": "b", "args": ["view", "a.obj"]}', "is no job")):
        with open("jobs.jsonl", "w") as f:
            f.write(good + "\n" + text + "\n")
        said = batch(code=3)
        assert f"jobs.jsonl, line 3: " in said and says in said, (text, said)
        assert not os.path.exists("results.jsonl"), "nothing is to be run"
    batch(jobs="none.jsonl", code=3)
    manifest([])
    assert "0 jobs: 0 done" in batch()
    for options in (("--shard", "0/4"), ("--shard", "5/4"), ("--shard", "x"), ("--jobs", "0"), ("--memory-limit", "-5"), ("--memory-limit", "0.5")):
        batch(*options, code=2)
    batch("--resume", out="-", code=2)
    batch(out="jobs.jsonl", code=2)


def poison():
    sheet("a.obj", 8)
    sheet("large.obj", 400)
    os.mkfifo("crash.obj")
    os.mkfifo("endless.obj")
    check = lambda name, **limits: {"id": name, "args": ["check", f"{name}.obj"], **limits}
    manifest([check("crash"), check("endless", time_limit=0.5), check("large", memory_limit=20_000_000), check("a")])
    run = subprocess.Popen(command("--grace", "60", "--jobs", "2"), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    until(lambda: "endless" in results_if_any())
    crashing = at_work_on(run.pid, b"crash.obj")
    os.kill(crashing[0], signal.SIGSEGV)
    said, _ = run.communicate(timeout=300)
    assert run.returncode == 10 and b"4 done, 3 of them failed" in said, said
    r = results()
    assert (r["crash"]["outcome"], r["crash"]["code"], r["crash"]["signal"]) == ("crashed", 139, "SIGSEGV"), r["crash"]
    assert r["crash"]["inputs"] == {"crash.obj": None}
    # Asked to end, a job that has nothing says so.
    assert (r["endless"]["outcome"], r["endless"]["code"]) == ("time_limit", 143) and "nothing was written" in r["endless"]["error"]
    assert (r["large"]["outcome"], r["large"]["code"]) == ("memory_limit", 137) and r["large"]["peak_memory"] > 10_000_000, r["large"]
    assert (r["a"]["outcome"], r["a"]["code"]) == ("valid", 0)

    # One that has a map keeps it. Its kernels are compiled by the one before.
    sheet("endless map.obj", 250)
    unwrap = lambda iterations, out: ["unwrap", "endless map.obj", "-o", out, "--solver", "gd", "--tolerance", "0", "--iterations", str(iterations)]
    manifest([{"id": "first", "args": unwrap(3, "first.obj")}, {"id": "endless map", "args": unwrap(2_000_000_000, "flat.obj"), "time_limit": 5}])
    os.remove("results.jsonl")
    batch("--grace", "60", code=10)
    r = results()["endless map"]
    assert (r["outcome"], r["code"]) == ("time_limit", 143) and r["seconds"] >= 5, r
    assert r["outputs"] == {"flat.obj": sha256("flat.obj")} and sha256("flat.obj") != sha256("first.obj"), r

    # Who does not listen is killed after the grace.
    manifest([check("endless", time_limit=0.5)])
    os.remove("results.jsonl")
    run = subprocess.Popen(command("--grace", "0.3"), stdout=subprocess.DEVNULL)
    os.kill(until(lambda: children(run.pid))[0], signal.SIGSTOP)
    assert run.wait(timeout=300) == 10
    r = results()["endless"]
    assert (r["outcome"], r["signal"]) == ("time_limit", "SIGKILL"), r


def results_if_any():
    return results() if os.path.exists("results.jsonl") else {}


def resume():
    count = 24
    for k in range(count):
        sheet(f"{k}.obj", 3, lift=0.1 + 0.01 * k)
    os.mkfifo("stop.obj")
    job = lambda k: {"id": str(k), "args": ["unwrap", f"{k}.obj", "-o", f"{k}.flat.obj", "--quiet"]}
    all = [job(k) for k in range(count)]
    manifest(all[:8] + [{"id": "stop", "args": ["check", "stop.obj"]}] + all[8:])

    # Killed in the middle, it takes its job along and leaves whole lines.
    run = subprocess.Popen(command(), stdout=subprocess.DEVNULL)
    at_work = until(lambda: at_work_on(run.pid, b"stop.obj"))
    run.kill()
    run.wait()
    until(lambda: not alive(at_work[0]))
    assert set(results()) == {str(k) for k in range(8)}
    with open("results.jsonl", "a") as f:
        f.write('{"id": "9", "code": 0, "ar')  # as a machine that went down would leave it

    # Interrupted, it ends its jobs, which get no line.
    run = subprocess.Popen(command("--resume"), stdout=subprocess.PIPE, text=True)
    until(lambda: at_work_on(run.pid, b"stop.obj"))
    run.send_signal(signal.SIGINT)
    said, _ = run.communicate(timeout=300)
    assert run.returncode == 130 and "8 left out as done before, 17 still to do" in said, said
    assert set(results()) == {str(k) for k in range(8)}

    os.remove("stop.obj")
    sheet("stop.obj", 3)
    assert "25 jobs: 17 done, 8 left out" in batch("--resume")
    assert set(results()) == {str(k) for k in range(count)} | {"stop"}
    assert "25 jobs: 0 done, 25 left out" in batch("--resume")

    # What has changed is done again, and nothing else.
    sheet("3.obj", 4)
    os.remove("5.flat.obj")
    all[7]["args"] += ["--energy", "area"]
    all[9]["time_limit"] = 100  # another limit is the same job
    manifest(all)
    assert "24 jobs: 3 done, 21 left out" in batch("--resume")
    again = [one["id"] for one in lines()[count + 1:]]
    assert sorted(again) == ["3", "5", "7"] and "24 jobs: 0 done" in batch("--resume")

    # A job that replaces its input is not done twice.
    os.remove("results.jsonl")
    manifest([{"id": "in place", "args": ["unwrap", "1.obj", "-o", "1.obj", "--quiet"]}])
    assert "1 done" in batch() and "0 done, 1 left out" in batch("--resume")

    # Failures stand until they are to be tried again.
    manifest([{"id": "missing", "args": ["check", "later.obj"]}])
    batch(code=10)
    assert "1 left out as done before, 1 of these failed" in batch("--resume", code=10)
    batch("--retry", code=10)
    sheet("later.obj", 2)
    assert "1 done" in batch("--resume")


def shards():
    sheet("a.obj", 2)
    manifest([{"id": f"job {k}", "args": ["check", "a.obj"]} for k in range(11)])
    for k in range(1, 5):
        batch("--shard", f"{k}/4", "--jobs", "2", out=f"part{k}.jsonl")
    parts = [results(f"part{k}.jsonl") for k in range(1, 5)]
    assert sorted(len(part) for part in parts) == [2, 3, 3, 3]
    assert sorted(id for part in parts for id in part) == sorted(f"job {k}" for k in range(11))

    # Parts that run at once may share one file, and none of them a cache.
    runs = [subprocess.Popen(command("--shard", f"{k}/4", "--jobs", "2"), stdout=subprocess.DEVNULL) for k in range(1, 5)]
    assert [run.wait(timeout=300) for run in runs] == [0] * 4
    assert len(results()) == 11


def schedulers():
    """--shard auto: what schedulers set says which part it is."""
    sheet("a.obj", 2)
    manifest([{"id": f"job {k}", "args": ["check", "a.obj"]} for k in range(8)])
    known = ("SLURM_", "SGE_", "AWS_BATCH_", "JOB_COMPLETION", "OMPI_COMM", "PMI_")
    clean = {name: value for name, value in os.environ.items() if not name.startswith(known)}

    def ids(code=0, says="", **variables):
        run = subprocess.run(command("--shard", "auto", out="-"), capture_output=True, text=True, timeout=300, env=clean | variables)
        assert run.returncode == code and says in run.stderr, (variables, run.returncode, run.stderr)
        return [json.loads(line)["id"] for line in run.stdout.splitlines()]

    every = lambda first, step: [f"job {k}" for k in range(first, 8, step)]
    array = {"SLURM_ARRAY_TASK_MIN": "10", "SLURM_ARRAY_TASK_STEP": "5", "SLURM_ARRAY_TASK_COUNT": "2"}
    assert ids(SLURM_ARRAY_TASK_ID="15", **array) == every(1, 2)
    # Two tasks of an array with two processes each are four parts.
    found = [ids(SLURM_ARRAY_TASK_ID=task, SLURM_PROCID=process, SLURM_NTASKS="2", **array) for task in ("10", "15") for process in "01"]
    assert found == [every(k, 4) for k in range(4)]
    assert ids(AWS_BATCH_JOB_ARRAY_INDEX="0", AWS_BATCH_JOB_ARRAY_SIZE="3") == every(0, 3)
    assert ids(SGE_TASK_ID="3", SGE_TASK_FIRST="1", SGE_TASK_LAST="4", SGE_TASK_STEPSIZE="1") == every(2, 4)
    assert ids(JOB_COMPLETION_INDEX="2", JOB_COMPLETIONS="5", SGE_TASK_ID="undefined") == every(2, 5)
    assert ids(OMPI_COMM_WORLD_RANK="1", OMPI_COMM_WORLD_SIZE="2") == every(1, 2)
    ids(code=2, says="no scheduler says which part this is")
    ids(code=2, says="JOB_COMPLETION_INDEX is set, but not JOB_COMPLETIONS", JOB_COMPLETION_INDEX="2")
    ids(code=2, says='PMI_RANK is "one"', PMI_RANK="one", PMI_SIZE="2")
    ids(code=2, says="beyond 2 parts", PMI_RANK="2", PMI_SIZE="2")


def stays():
    """--stdin: jobs that come while others run, until the input ends."""
    sheet("a.obj", 2)
    out = [taut, "batch", "--stdin", "--output", "-", "--cache", caches, "--quiet"]
    run = subprocess.Popen(out, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    job = lambda id, **more: json.dumps({"id": id, "args": ["check", "a.obj"]} | more) + "\n"

    def answer(text):
        run.stdin.write(text)
        run.stdin.flush()
        return json.loads(run.stdout.readline())

    assert answer(job("a"))["code"] == 0
    assert answer("\n" + job("b"))["id"] == "b"
    bad = answer("no job\n")
    assert (bad["id"], bad["code"]) == ("", 3) and "standard input, line 4: is no JSON" in bad["error"], bad
    again = answer(job("a"))
    assert again["id"] == "a" and again["code"] == 3 and "earlier job" in again["error"], again
    run.stdin.write(job("c")[:-1])  # without its end
    run.stdin.close()
    assert json.loads(run.stdout.readline())["id"] == "c" and run.wait(timeout=300) == 10
    # An input that ends at once, and one that is interrupted while it waits.
    assert subprocess.run(out, stdin=subprocess.DEVNULL, capture_output=True, timeout=300).returncode == 0
    run = subprocess.Popen(out, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL)
    time.sleep(0.3)
    run.send_signal(signal.SIGINT)
    assert run.wait(timeout=300) == 130
    assert subprocess.run([*out, "--shard", "1/2"], stdin=subprocess.DEVNULL, capture_output=True).returncode == 2


def pipes():
    """Pipes are the job's alone: the batch neither waits at one nor takes what another program writes."""
    sheet("a.obj", 3)
    os.mkfifo("in.pipe.obj")
    os.mkfifo("stats.pipe.json")
    writer = subprocess.Popen(["cp", "a.obj", "in.pipe.obj"])
    reader = subprocess.Popen(["cat", "stats.pipe.json"], stdout=subprocess.PIPE, text=True)
    manifest([{"id": "a", "args": ["unwrap", "in.pipe.obj", "-o", "pipe.flat.obj", "--stats", "stats.pipe.json", "--quiet"]}], "pipes.jsonl")
    run = subprocess.Popen(command(jobs="pipes.jsonl", out="pipes.results"))
    try:
        assert run.wait(timeout=30) == 0 and writer.wait(timeout=10) == 0
    finally:
        for one in (run, writer, reader):
            one.kill()
    assert json.loads(reader.stdout.read())["stop"] == "gradient"
    assert results("pipes.results")["a"]["outputs"].keys() == {"pipe.flat.obj", "stats.pipe.json"}


def much_memory():
    """Limits of memory beyond all numbers are none."""
    sheet("a.obj", 3)
    manifest([{"id": "a", "args": ["check", "a.obj"]}], "much.jsonl")
    for limit in ("1e19", "1e20", "1e300", "inf"):
        batch("--memory-limit", limit, jobs="much.jsonl", out=f"much.{limit}")


def workers():
    """Jobs at once have a cache each, and share the processors."""
    for k in range(3):
        os.mkfifo(f"{k}.obj")
    manifest([{"id": str(k), "args": ["check", f"{k}.obj"]} for k in range(3)])
    environment = {name: value for name, value in os.environ.items() if name not in ("TAUT_THREADS", "POCL_MAX_PTHREAD_COUNT")}
    run = subprocess.Popen(command("--jobs", "3"), stdout=subprocess.DEVNULL, env=environment | {"POCL_CACHE_DIR": "shared"})
    pids = until(lambda: (all := children(run.pid)) if len(children(run.pid)) == 3 else None)
    started = lambda pid: b".obj" in open(f"/proc/{pid}/cmdline", "rb").read()
    until(lambda: all(map(started, pids)))
    of = [dict(one.split("=", 1) for one in open(f"/proc/{pid}/environ").read().split("\0") if "=" in one) for pid in pids]
    assert len({one["POCL_CACHE_DIR"] for one in of}) == 3 and all(one["POCL_CACHE_DIR"].startswith(caches) for one in of)
    share = max(1, len(os.sched_getaffinity(0)) // 3)
    assert {(one["TAUT_THREADS"], one["POCL_MAX_PTHREAD_COUNT"]) for one in of} == {(str(share), str(share))}
    run.terminate()
    assert run.wait(timeout=300) == 143 and not any(map(alive, pids)) and results_if_any() == {}


def parallel():
    """As GNU parallel, and a job of SLURM, would call it."""
    if not shutil.which("parallel"):
        print("skipped: there is no parallel")
        sys.exit(77)
    for k in range(6):
        sheet(f"{k}.obj", 3)
    manifest([{"id": str(k), "args": ["unwrap", f"{k}.obj", "-o", f"{k}.flat.obj", "--quiet"]} for k in range(6)] +
             [{"id": "none", "args": ["check", "none.obj"]}])
    run = subprocess.run(["parallel", "--jobs", "2", taut, "batch", "--manifest", "jobs.jsonl", "--shard", "{}/3", "--resume", "--output", "{}.jsonl",
                          "--cache", caches, ":::", "1", "2", "3"], capture_output=True, text=True, timeout=300)
    assert run.returncode == 1, run  # one part has a failure
    whole = results("1.jsonl") | results("2.jsonl") | results("3.jsonl")
    assert sum(len(results(f"{k}.jsonl")) for k in (1, 2, 3)) == len(whole) == 7
    assert {id for id, one in whole.items() if one["code"] == 0} == {str(k) for k in range(6)}
    assert all(os.path.exists(f"{k}.flat.obj") for k in range(6))

    # One job a line, by parallel itself.
    with open("jobs.jsonl") as f:
        run = subprocess.run(["parallel", "--pipe", "-N1", taut, "batch", "--manifest", "-", "--cache", caches, "--quiet"], stdin=f,
                             capture_output=True, text=True, timeout=300)
    assert run.returncode == 1 and {json.loads(line)["id"] for line in run.stdout.splitlines()} == set(whole), run

    task = {"SLURM_ARRAY_TASK_ID": "2", "SLURM_ARRAY_TASK_COUNT": "3"}
    script = '"$0" batch --manifest jobs.jsonl --shard $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT --output "task $SLURM_ARRAY_TASK_ID.jsonl" --cache "$1"'
    subprocess.run(["sh", "-c", script, taut, caches], env=os.environ | task, stdout=subprocess.DEVNULL, check=True, timeout=300)
    assert set(results("task 2.jsonl")) == set(results("2.jsonl"))


def foreign():
    """A file of results is appended to, and never shortened but by a result that was not finished; others stay as they are."""
    sheet("a.obj", 2)
    jobs = [{"id": "a", "args": ["check", "a.obj"]}]
    manifest(jobs)
    batch()
    with open("results.jsonl", "rb") as f:
        whole = f.read()
    other = whole.replace(b'"a"', b'"b"', 1)
    for text in (b"precious note", b"precious note\n", b"1\n2\n", b"{", b'{"a": 1}', b'{"a": 1}\n', b"[]\n" + whole, b'"id"', b"\x00\x01\x02",
                 b'{"id": "a", "args": ["check", "a.obj"]}\n', b"note\n" + whole, whole + b"note", whole + b"{} {}", whole + b'{"ids'):
        with open("kept.txt", "wb") as f:
            f.write(text)
        for options in ((), ("--resume",)):
            said = batch(*options, out="kept.txt", code=2)
            assert "kept.txt" in said and "another file" in said, (text, said)
            with open("kept.txt", "rb") as f:
                assert f.read() == text
    for text, left, done in ((b"", b"", 1), (b"\n\n", b"\n\n", 1), (whole[:-1], whole, 0), (whole, whole, 0), (other + whole[:-1], other + whole, 0),
                             (other[:-1], other, 1), (other + b"{", other, 1), (other + whole[:-9], other, 1), (whole[:30], b"", 1),
                             (other + b"note\n" + whole[:50], other + b"note\n", 1), (other + b'{"note": 1}', other + b'{"note": 1}\n', 1)):
        with open("results.jsonl", "wb") as f:
            f.write(text)
        assert f"{done} done" in batch("--resume")
        with open("results.jsonl", "rb") as f:
            now = f.read()
        assert now.startswith(left) and now[len(left):].count(b"\n") == done, (text, now)
    manifest([])
    with open("notes", "w") as f:
        f.write("precious note")
    batch(out="notes", code=2)


def descriptors():
    """Where few files may be open, fewer jobs are at work, and none is lost."""
    sheet("a.obj", 2)
    manifest([{"id": str(k), "args": ["check", "a.obj"]} for k in range(24)])
    limited = lambda n: dict(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (n, n)), capture_output=True, text=True, timeout=300)
    run = subprocess.run(command("--jobs", "20"), **limited(40))
    assert run.returncode == 0 and "--jobs 20" in run.stderr and "ulimit -n" in run.stderr, run
    assert {one["code"] for one in results().values()} == {0} and len(results()) == 24
    assert all(one["inputs"]["a.obj"] for one in results().values())
    os.remove("results.jsonl")
    run = subprocess.run(command(), **limited(20))
    assert run.returncode == 0 and len(results()) == 24, run
    run = subprocess.run(command("--jobs", "20"), **limited(14))
    assert run.returncode == 2 and "ulimit -n" in run.stderr and len(results()) == 24, run

    # What the batch has open is no business of its jobs.
    os.mkfifo("wait.obj")
    manifest([{"id": "wait", "args": ["check", "wait.obj"]}])
    with open("a.obj") as extra:
        run = subprocess.Popen(command(), stdout=subprocess.DEVNULL, pass_fds=[extra.fileno()])
        job = until(lambda: at_work_on(run.pid, b"wait.obj"))[0]
        until(lambda: set(os.listdir(f"/proc/{job}/fd")) == {"0", "1", "2"})
        run.terminate()
        assert run.wait(timeout=300) == 143


def private_caches():
    """Compiled kernels are code: they come from a folder that is the user's alone."""
    sheet("a.obj", 2)
    manifest([{"id": "a", "args": ["check", "a.obj"]}])

    def at(folder, code=0):
        run = subprocess.run([taut, "batch", "--manifest", "jobs.jsonl", "--cache", folder], capture_output=True, text=True, timeout=300)
        assert run.returncode == code and (code == 0 or folder in run.stderr and "another folder" in run.stderr), (run.returncode, run.stderr)

    mask = os.umask(0)
    at("new/below")
    os.umask(mask)
    for made in ("new", "new/below", "new/below/0"):
        assert os.stat(made).st_mode & 0o777 == 0o700, made
    assert os.stat("new/below/0.lock").st_mode & 0o777 == 0o600
    os.symlink("new/below", "link")
    at("link", 2)
    at("link/", 2)
    at("link/.", 2)
    for mode in (0o777, 0o1777, 0o770, 0o720, 0o702):
        os.chmod("new/below", mode)
        at("new/below", 2)
        os.chmod("new/below", 0o700)
        os.chmod("new/below/0", mode)
        at("new/below", 2)
        os.chmod("new/below/0", 0o700)
    at("a.obj", 2)
    at("new/below")
    os.remove("new/below/0.lock")
    os.symlink("../../precious", "new/below/0.lock")
    at("new/below", 2)
    assert not os.path.exists("precious")
    os.remove("new/below/0.lock")
    if os.geteuid() == 0:  # who else gives folders away
        os.chown("new/below", 65534, 65534)
        at("new/below", 2)
        os.chown("new/below", 0, 0)
        os.chown("new/below/0", 65534, 65534)
        at("new/below", 2)
        os.chown("new/below/0", 0, 0)
        os.chown("new", 65534, 65534)
        at("new/below", 2)
    # Jobs at work are finished before the batch gives up.
    os.makedirs("two/1")
    os.chmod("two", 0o700)
    os.chmod("two/1", 0o777)
    os.mkfifo("slow.obj")
    manifest([{"id": "slow", "args": ["check", "slow.obj"]}, {"id": "a", "args": ["check", "a.obj"]}, {"id": "b", "args": ["check", "a.obj"]}])
    run = subprocess.Popen([taut, "batch", "--manifest", "jobs.jsonl", "--output", "two.jsonl", "--jobs", "2", "--cache", "two"], stderr=subprocess.PIPE, text=True)
    until(lambda: at_work_on(run.pid, b"slow.obj"))
    with open("slow.obj", "w") as f, open("a.obj") as mesh:
        f.write(mesh.read())
    said = run.communicate(timeout=300)[1]
    assert run.returncode == 2 and "two/1" in said and set(results("two.jsonl")) == {"slow"}, (run.returncode, said)

    # PoCL's own, of a command.
    os.makedirs("pocl", mode=0o777)
    os.chmod("pocl", 0o777)
    run = subprocess.run([taut, "unwrap", "a.obj", "-o", "flat.obj"], capture_output=True, text=True, timeout=300, env=os.environ | {"POCL_CACHE_DIR": "pocl", "TAUT_DEVICE": "pthread"})
    assert run.returncode == 2 and "POCL_CACHE_DIR" in run.stderr or "pthread" not in subprocess.run([taut, "devices"], capture_output=True, text=True).stdout, run


case, taut, folder = sys.argv[1], os.path.abspath(sys.argv[2]), sys.argv[3]
caches = os.path.abspath(f"{folder}/../caches")
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
os.chdir(folder)
{f.__name__: f for f in (answers, malformed, poison, resume, shards, schedulers, stays, pipes, much_memory, workers, parallel, foreign, descriptors, private_caches)}[case]()
print(f"batch: {case}: all as it should be")
