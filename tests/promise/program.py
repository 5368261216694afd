# SPDX-License-Identifier: MIT
"""The program under test: NAME.py PROGRAM FOLDER [CASE...] calls main() with the functions of the test."""
import json
import os
import shutil
import subprocess
import sys
import unittest


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = os.path.abspath(path), folder

    def __call__(self, *arguments, code=0, timeout=600):
        """Runs the program in the folder; its exit code must be `code` (one, or one of several)."""
        command = [self.path, *(str(a) for a in arguments)]
        run = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=timeout,
                             stdin=subprocess.DEVNULL)
        wanted = code if isinstance(code, tuple) else (code,)
        assert run.returncode in wanted, (f"exit code {run.returncode}, not {code}: taut {' '.join(command[1:])}\n"
                                          f"{run.stdout}{run.stderr}")
        return run

    def stats(self, *arguments, code=0):
        """The --stats of a run."""
        self(*arguments, "--stats", "stats.json", code=code)
        with open(self.file("stats.json")) as f:
            return json.load(f)

    def file(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.file(name), "wb" if isinstance(content, bytes) else "w") as f:
            f.write(content)
        return name

    def read(self, name):
        with open(self.file(name), "rb") as f:
            return f.read()


def main(*cases):
    """Runs the cases, functions of a Program, each in an emptied folder of its own; all of them, then fails if one did, and
    ends with 77 if all were skipped."""
    os.environ.pop("TAUT_DEVICE", None)
    path, root, *chosen = sys.argv[1:]
    failed, passed, skipped = [], [], []
    for case in cases:
        if chosen and case.__name__ not in chosen:
            continue
        folder = os.path.join(root, case.__name__)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        try:
            case(Program(path, folder))
            print(f"passed: {case.__name__}", flush=True)
            passed.append(case.__name__)
        except unittest.SkipTest as why:
            print(f"skipped: {case.__name__}: {why}", flush=True)
            skipped.append(case.__name__)
        except Exception as problem:  # the others shall run, too
            print(f"FAILED: {case.__name__}: {type(problem).__name__}: {problem}", flush=True)
            failed.append(case.__name__)
    sys.exit(1 if failed else 77 if skipped and not passed else 0)
