#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""corpus.py [--taut PROGRAM] [--limit S] [--jobs N] [--atlas] FOLDER...
Tries `taut check` on every surface, volume and problem below the folders, and `taut atlas --repair` on models of glTF. One
line a file: format, outcome, seconds, peak memory, file and the last message; then how often each outcome came.

Outcomes are what the exit code says; `late` beyond the limit, `crash` where a signal ended the program.
--atlas: surfaces, too, get an atlas
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

SURFACES = {".obj", ".off", ".ply", ".stl"}
MODELS = {".gltf", ".glb"}
VOLUMES = {".mesh", ".meshb", ".msh", ".vtk", ".vtu", ".node", ".su2", ".prob"}
OUTCOMES = {0: "good", 2: "usage", 3: "unreadable", 4: "unsuitable", 5: "no device", 6: "no map", 7: "infeasible",
            8: "time limit", 9: "device failure"}


def arguments(path, atlas, folder):
    """The call for a file, and where its result goes."""
    kind = path.suffix.lower()
    if kind in MODELS or atlas and kind in SURFACES:
        return ["atlas", path, "-o", folder / ("out.glb" if kind in MODELS else "out.obj"), "--repair", "--quiet"]
    return ["check", path]


def last_message(out, error):
    lines = [line.strip() for line in (error + "\n" + out).splitlines()]
    told = [line for line in lines if line.startswith(("taut: error", "error"))] or [line for line in lines if line]
    return " ".join(told[0].split()).removeprefix("taut: error: ") if told else ""


def try_file(taut, path, limit, atlas):
    with tempfile.TemporaryDirectory() as folder:
        call = [str(x) for x in (taut, *arguments(path, atlas, pathlib.Path(folder)))]
        begin = time.monotonic()
        with open(pathlib.Path(folder) / "out", "w+", errors="replace") as out, \
                open(pathlib.Path(folder) / "error", "w+", errors="replace") as error:
            child = subprocess.Popen(call, stdin=subprocess.DEVNULL, stdout=out, stderr=error)
            late = False
            while True:
                done, status, usage = os.wait4(child.pid, os.WNOHANG)
                if done:
                    break
                if time.monotonic() - begin > limit and not late:
                    late = True
                    child.kill()
                time.sleep(0.005)
            child.returncode = code = os.waitstatus_to_exitcode(status)
            out.seek(0)
            error.seek(0)
            message = last_message(out.read(), error.read())
    outcome = "late" if late else f"crash {signal.Signals(-code).name}" if code < 0 else OUTCOMES.get(code, f"code {code}")
    return (path.suffix.lower()[1:], outcome, f"{time.monotonic() - begin:.2f}", f"{usage.ru_maxrss // 1024}", str(path),
            "" if outcome == "good" else message[:300])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--taut", default=root / "build/release/bin/taut", type=pathlib.Path)
    parser.add_argument("--limit", default=60.0, type=float, help="seconds a file")
    parser.add_argument("--jobs", default=1, type=int)
    parser.add_argument("--atlas", action="store_true")
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    files = sorted(p for folder in options.folders for p in folder.rglob("*")
                   if p.is_file() and p.suffix.lower() in SURFACES | MODELS | VOLUMES)
    print("format\toutcome\tseconds\tMiB\tfile\tmessage")
    counts = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for row in pool.map(lambda p: try_file(options.taut, p, options.limit, options.atlas), files):
            print("\t".join(row), flush=True)
            counts[row[1]] += 1
    print(f"# {len(files)} files: " + ", ".join(f"{n} {outcome}" for outcome, n in counts.most_common()), file=sys.stderr)


if __name__ == "__main__":
    main()
