# SPDX-License-Identifier: MIT
"""Ablation: what each strategy of the library is worth. docs/explanation/strategies.md has its table.

    python3 bench/ablation [--quick] [--data DIR] [--pins DIR] [--models data.tar.gz] [--only NAME,...] [--table]

Copies the tree to build/ablation, puts a switch at each strategy (strategies.py), builds the program there, and runs the
corpora (corpora.py): as it is, and with each strategy switched off on those cases that come to it; no other result can
differ. A case counts as another answer if its exit code, or its energy by more than 0.1 %, is another one. Times are
seconds of the processor in user mode, as machines may be shared; that of the whole is of its second run, since the first
compiles kernels. Results are kept in build/ablation/results.json and not measured again; --fresh begins anew.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Lock

import corpora
import strategies

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build/ablation"


def build():
    """A tree with switches, and the program of it."""
    source = WORK / "source"
    program = source / "build/release/bin/taut"
    if program.exists():
        return program
    shutil.rmtree(source, ignore_errors=True)
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, files.split("\0")):
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, source / name)
    strategies.patch(source / "include/taut/impl")
    subprocess.run(["cmake", "--preset", "release"], cwd=source, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["ninja", "-j2", "-C", source / "build/release", "taut_program"], check=True)
    return program


class Runs:
    """Runs cases, and keeps what came of them by case and by what was switched off."""

    def __init__(self, program, limit, file):
        self.program, self.limit, self.file, self.lock = program, limit, file, Lock()
        self.all = json.loads(file.read_text()) if file.exists() else {}
        self.count = 0

    def key(self, case, off, again=0):
        return f"{case.name}|{','.join(off)}" + (f"|{again}" if again else "")

    def run(self, case, off=(), again=0):
        key = self.key(case, off, again)
        if key in self.all:
            return self.all[key]
        with self.lock:
            self.count += 1
            folder = WORK / f"runs/{self.count}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        reached = folder / "reached"
        environment = {**os.environ, "TAUT_WITHOUT": ",".join(off), "TAUT_REACHED": str(reached),
                       "POCL_CACHE_DIR": str(WORK / "kernels")}
        command = [self.program, *case.command, "-o", folder / case.output, "--stats", folder / "stats.json", "--quiet",
                   "--time-limit", str(self.limit)]
        with open(folder / "log", "w") as log:
            child = subprocess.Popen(list(map(str, command)), env=environment, stdout=log, stderr=log)
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        stats = json.loads((folder / "stats.json").read_text()) if (folder / "stats.json").exists() else {}
        energy = stats.get("energy", stats.get("mean_distortion"))
        result = {"code": child.returncode, "seconds": usage.ru_utime, "energy": energy, "stage": stats.get("stage"), "least": stats.get("min_relative_det"),
                  "seam": stats.get("seam_length"), "charts": stats.get("charts") if isinstance(stats.get("charts"), int) else None,
                  "reached": reached.read_text().split("\n")[:-1] if reached.exists() else []}
        with self.lock:
            self.all[key] = result
            self.file.write_text(json.dumps(self.all))
        shutil.rmtree(folder)
        return result


def good(r):
    return r["code"] in (0, 7)


def differs(before, now):
    """How the answer differs: lost, found, worse, better (energy), thinner (a smallest element below half), or None."""
    if before["code"] != now["code"]:
        return "lost" if good(before) else "found" if good(now) else None
    if before["energy"] and now["energy"] and abs(now["energy"] - before["energy"]) > 1e-3 * abs(before["energy"]):
        return "worse" if now["energy"] > before["energy"] else "better"
    if (before.get("least") or 0) > 0 and now.get("least") is not None and now["least"] < 0.5 * before["least"]:
        return "thinner"
    return None


def row(name, off, cases, runs):
    """A line of the table of one strategy."""
    met, before, now, kinds, names = 0, 0.0, 0.0, {}, {}
    slower = 0
    for case in cases:
        key = runs.key(case, off)
        whole = runs.all.get(runs.key(case, (), 1))  # the first run may have compiled kernels
        if key not in runs.all or not whole:
            continue
        met += 1
        kind = differs(whole, runs.all[key])
        if kind:
            kinds[kind] = kinds.get(kind, 0) + 1
            names.setdefault(kind, []).append(case.name)
        if good(runs.all[key]) == good(whole):
            before += whole["seconds"]
            now += runs.all[key]["seconds"]
            slower += runs.all[key]["seconds"] > 1.1 * whole["seconds"] + 0.05
    return {"name": name, "cases": met, "answers": kinds, "names": names, "before": before, "now": now,
            "slower": slower, "ratio": now / before if before else None}


def table(rows):
    lines = ["| strategy | cases | lost | found | energy worse, better | thinner | time without it | slower cases |",
             "|---|---|---|---|---|---|---|---|"]
    for r in rows:
        a = r["answers"]
        time = f"{r['ratio']:.2f} of {r['before']:.1f} s" if r["ratio"] else "-"
        lines.append(f"| {r['name']} | {r['cases']} | {a.get('lost', 0)} | {a.get('found', 0)} | "
                     f"{a.get('worse', 0)}, {a.get('better', 0)} | {a.get('thinner', 0)} | {time} | {r['slower']} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="some cases of each kind")
    parser.add_argument("--data", type=Path, help="folder with untangle2d/, untangle3d/ and surfaces/")
    parser.add_argument("--pins", type=Path, help="folder with MESH.*.csv of surfaces in --data")
    parser.add_argument("--models", type=Path, help="data.tar.gz of Debian's libcgal-demo",
                        default=Path("/usr/share/doc/libcgal-demo/data.tar.gz"))
    parser.add_argument("--only", help="names of strategies, with commas; 'none': measure as it is alone")
    parser.add_argument("--together", help="names of strategies to take out at once, with commas")
    parser.add_argument("--corpus", help="beginnings of names of cases, with commas")
    parser.add_argument("--limit", type=float, default=40, help="seconds a case")
    parser.add_argument("--most", type=int, default=40, help="cases a strategy, taken evenly from those that come to it")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--table", action="store_true", help="print the table of what was measured")
    parser.add_argument("--fresh", action="store_true")
    arguments = parser.parse_args()
    if arguments.fresh:
        shutil.rmtree(WORK, ignore_errors=True)
    made = WORK / "cases"
    made.mkdir(parents=True, exist_ok=True)
    runs = Runs(build(), arguments.limit, WORK / "results.json")
    archive = arguments.models if arguments.models.exists() else None
    cases = corpora.public(arguments.data, arguments.pins, archive, made) + corpora.generated(made)
    if arguments.data:
        meshes = [arguments.data / f"surfaces/{n}.obj" for n in ("planck1", "camel_b", "lucy_6k", "gargoyle_10k")]
        cases += corpora.moved_pins(lambda case: free_map(runs, case, made), meshes, made)
    if arguments.quick:
        cases = [c for c in cases if c.quick]
    if arguments.corpus:
        cases = [c for c in cases if c.name.startswith(tuple(arguments.corpus.split(",")))]
    wanted = [(s.name, (s.name,)) for s in strategies.STRATEGIES if not arguments.only or s.name in arguments.only.split(",")]
    if arguments.together:
        names = tuple(arguments.together.split(","))
        wanted = [(" + ".join(names), names)]
    if not arguments.table:
        measure(runs, cases, wanted, arguments.most, arguments.jobs)
    rows = [row(name, off, cases, runs) for name, off in wanted]
    print(table(rows))
    for r in rows:
        for kind, names in r["names"].items():
            print(f"{r['name']}: {kind}: {' '.join(names)}")


def free_map(runs, case, made):
    """The output of a case that other cases are made of."""
    out = made / case.output
    if not out.exists():
        subprocess.run(list(map(str, [runs.program, *case.command, "-o", out, "--quiet"])), check=True)
    return out


def measure(runs, cases, wanted, most, jobs):
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda c: runs.run(c), cases))
        list(pool.map(lambda c: runs.run(c, (), 1), cases))
        todo = []
        for _, off in wanted:
            met = [c for c in cases if set(off) & set(runs.all[runs.key(c, ())]["reached"])]
            step = max(1.0, len(met) / most)
            todo += [(met[int(i * step)], off) for i in range(min(len(met), most))]
        print(f"{len(cases)} cases, {len(todo)} runs without a strategy", file=sys.stderr)
        list(pool.map(lambda t: runs.run(*t), todo))


if __name__ == "__main__":
    main()
