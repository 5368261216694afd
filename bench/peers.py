#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""peers.py [--folder build/peers] [--limit SECONDS] [--total SECONDS] [--repeat N] [--only KINDS] [--program NAME="COMMAND {in} {out}"] [--write PAGE] [MESH ...]

Installs the packages of bench/peers.txt into a virtual environment, runs each on the same meshes in processes of their own,
one after the other, and judges what they make by checks of its own (bench/peers/judge.py), which no package has a part in. A peer that
cannot be installed, fails, is killed at the limit or refuses a mesh is a row, too. The limit is of processor seconds, of all threads of a
process together, so that it means the same on a busy machine; what takes no processor is killed after ten times as long. taut is imported
from PYTHONPATH, by default build/release/python. Figures are of the median of N runs, of one where that takes a tenth of the limit.
--total ends the run: each kind of task gets an equal part of what is left, and what does not come to run is a row. Programs of your own
take part, too: they get a Wavefront file and leave one with texture coordinates. Without meshes: some of Debian's package libcgal-demo,
fetched by apt-get, and bars of tetrahedra whose ends are turned."""

import argparse
import json
import math
import os
import pathlib
import platform
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path.insert(0, str(HERE))

CLOSED = ["cow", "fandisk", "camel", "bear", "armadillo"]
DISKS = ["lion-head", "mannequin-devil"]
BARS = [90, 150]
PATIENCE = 10  # real seconds that a process may take for each second of its limit


def environment(folder):
    """The interpreter of an environment with the peers."""
    python = folder / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "-q", "numpy", "scipy", "matplotlib"], check=True)
    for line in (HERE / "peers.txt").read_text().splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        name = line.split("=")[0]
        have = subprocess.run([str(python), "-m", "pip", "show", "-q", name], capture_output=True)
        if have.returncode != 0:
            subprocess.run([str(python), "-m", "pip", "install", "-q", line], capture_output=True, timeout=1800)
    return python


def demo_meshes(folder, names):
    """Meshes of libcgal-demo."""
    found = {p.stem: p for p in folder.rglob("*.off")}
    if not all(n in found for n in names):
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(["apt-get", "download", "libcgal-demo"], cwd=folder, check=True, capture_output=True)
        for package in folder.glob("libcgal-demo_*.deb"):
            subprocess.run(["dpkg", "-x", package.name, "package"], cwd=folder, check=True)
        for archive in folder.rglob("data.tar.gz"):
            subprocess.run(["tar", "-xzf", str(archive)], cwd=folder, check=True)
        found = {p.stem: p for p in folder.rglob("*.off")}
    return [found[n] for n in names]


def limited(seconds):
    """For a child before it starts: ends it by SIGXCPU after as many processor seconds."""
    return lambda: resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 5))


def run_peer(python, peer, mesh, limit, words=(), interrupt_at=None):
    """What a peer makes of a mesh: a dict with `error`, or with the path of its coordinates."""
    out = pathlib.Path(tempfile.mkdtemp()) / "out.npz"
    command = [str(python), str(HERE / "peers" / "run.py"), peer, str(mesh), str(out), *words]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
                             preexec_fn=limited(limit))
    if interrupt_at is not None:
        return interrupted_after(child, interrupt_at)
    try:
        said, _ = child.communicate(timeout=PATIENCE * limit)
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.communicate()
        return {"error": f"killed after {PATIENCE * limit:g} s"}
    if child.returncode == -signal.SIGXCPU:
        return {"error": f"killed after {limit:g} processor seconds"}
    if child.returncode != 0 or not out.exists():
        words = [line for line in said.strip().splitlines() if line.strip()] or [f"exit code {child.returncode}"]
        if child.returncode < 0:
            words.append(f"ended by signal {-child.returncode}")
        return {"error": words[-1][:160]}
    report = json.loads(pathlib.Path(str(out) + ".json").read_text())
    report["out"] = out
    return report


def interrupted_after(child, moment):
    """Seconds from Ctrl-C in the middle of a call to the end of the process; None: it had to be killed."""
    for line in child.stdout:
        if line.startswith("begin"):
            break
    time.sleep(moment)
    if child.poll() is not None:
        return float("nan")
    start = time.monotonic()
    os.kill(child.pid, signal.SIGINT)
    try:
        child.wait(timeout=10)
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        return None
    return time.monotonic() - start


def machine():
    """The processor, as Linux names it."""
    try:
        text = pathlib.Path("/proc/cpuinfo").read_text()
        return next(line.split(":")[1].strip() for line in text.splitlines() if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.machine()


def repeated(python, peer, mesh, given, words):
    """The median of the runs of a peer by their processor seconds, with the number of these."""
    runs = []
    for _ in range(given.repeat + peer.startswith("taut")):  # taut's first one compiles kernels, and is not counted
        runs.append(run_peer(python, peer, mesh, given.limit, words))
        if "error" in runs[-1] or runs[-1]["processor"] > given.limit / 10 and (len(runs) > 1 or not peer.startswith("taut")):
            break
    runs = runs[1:] if peer.startswith("taut") and len(runs) > 1 else runs
    failed = [r for r in runs if "error" in r]
    if failed:
        return failed[0]
    runs.sort(key=lambda r: r["processor"])
    return {**runs[(len(runs) - 1) // 2], "runs": len(runs)}


def meshes_of(given):
    """Kinds of tasks and their meshes."""
    if given.meshes:
        return {"atlas": given.meshes}
    import numpy
    from peers import volumes

    bars = []
    for degrees in BARS:
        bars.append(given.folder / "meshes" / f"bar-{degrees}.npz")
        numpy.savez(bars[-1], **dict(zip(("V", "T", "b", "bc"), volumes.bar(5, 20, degrees))))
    return {"volume": bars, "disk": demo_meshes(given.folder / "meshes", DISKS), "atlas": demo_meshes(given.folder / "meshes", CLOSED)}


def judged(out, mesh):
    """What the judges say of what a peer left."""
    import numpy
    from peers import judge, volumes

    if mesh.suffix == ".npz":
        task = numpy.load(mesh)
        return volumes.judge(*(task[name] for name in ("V", "T", "b", "bc")), numpy.load(out)["x"])
    return judge.judge(*judge.load(out))


def size_of(mesh):
    import numpy
    from peers import judge

    return len(numpy.load(mesh)["T"]) if mesh.suffix == ".npz" else len(judge.read_off(mesh)[1])


def row_of(python, kind, mesh, peer, words, given, interrupt):
    """What a peer makes of a mesh, judged; with interrupt: and how it takes a Ctrl-C in a call that takes long enough."""
    made = repeated(python, peer, mesh, given, words)
    row = {"kind": kind, "mesh": mesh.stem, "size": size_of(mesh), "peer": peer, **{k: v for k, v in made.items() if k != "out"}}
    if "out" in made:
        row.update(judged(made["out"], mesh))
        shutil.rmtree(made["out"].parent)
    if interrupt and row.get("seconds", 0) > 0.5:
        row["interrupt"] = run_peer(python, peer, mesh, given.limit, words, 0.4 * row["seconds"])
    return row


def measured(python, given):
    """A row for each peer on each mesh."""
    from peers import peers_of

    programs = {name: shlex.split(command) for name, command in (p.split("=", 1) for p in given.program)}
    rows = []
    tasks = {kind: meshes for kind, meshes in meshes_of(given).items() if kind in given.only.split(",")}
    start = time.monotonic()
    for done, (kind, meshes) in enumerate(tasks.items()):
        used = time.monotonic() - start
        end = start + used + (given.total - used) / (len(tasks) - done)
        for mesh in meshes:
            for peer in peers_of(kind) + ([] if kind == "volume" else list(programs)):
                if time.monotonic() < end:
                    rows.append(row_of(python, kind, mesh, peer, programs.get(peer, ()), given, mesh == meshes[-1]))
                else:
                    rows.append({"kind": kind, "mesh": mesh.stem, "size": size_of(mesh), "peer": peer,
                                 "error": f"not run: the {given.total:g} s of all had ended"})
                print(json.dumps(rows[-1], default=str), flush=True)
    return rows


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "peers",
                           help="of the virtual environment, meshes and rows.json (default build/peers)")
    arguments.add_argument("--limit", type=float, default=120, help="processor seconds of a process")
    arguments.add_argument("--total", type=float, default=math.inf, help="seconds of all together")
    arguments.add_argument("--write", type=pathlib.Path, metavar="PAGE", help="the page to make, with its pictures")
    arguments.add_argument("--repeat", type=int, default=3,
                           help="runs of each peer, of which the median is told: by default 3, and 1 of what takes a tenth of the limit")
    arguments.add_argument("--only", default="atlas,disk,volume", metavar="KINDS", help="kinds of tasks: atlas,disk,volume")
    arguments.add_argument("--program", action="append", default=[], metavar='NAME="COMMAND {in} {out}"',
                           help="another peer: a program that reads and writes OBJ files, such as OptCuts")
    arguments.add_argument("meshes", nargs="*", type=pathlib.Path, help="surfaces as OFF, instead of the public ones")
    given = arguments.parse_args()
    os.environ.setdefault("PYTHONPATH", str(ROOT / "build" / "release" / "python"))
    python = environment(given.folder)
    if pathlib.Path(sys.executable).absolute() != python.absolute():  # it has numpy and matplotlib
        os.execv(python, [str(python), *sys.argv])
    from peers import page

    rows = measured(python, given)
    (given.folder / "rows.json").write_text(json.dumps(rows, default=str))
    if given.write:
        page.write(given.write, rows, sys.argv, machine(), os.cpu_count())


if __name__ == "__main__":
    main()
