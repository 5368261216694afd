#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""released_names.py ROOT [--write]: no public name of the last release has vanished in silence.

tests/house/released-names.txt has the version of that release and its names, each with the header that brings it. A
name that docs/reference/names.md has there no more needs a line under "Removed" of a later version in CHANGELOG.md
that says it as `name`. --write: makes the list of what the page has now, for a release."""

import pathlib
import re
import sys


def listed(page):
    """["taut/mesh.hpp mesh", ...] of docs/reference/names.md."""
    names = set()
    for section in re.split(r"^## ", page, flags=re.M)[1:]:
        header = re.match(r"`(taut/\w+\.hpp)`", section)
        if header:
            names |= {f"{header[1]} {name}" for name in re.findall(r"^\| `([\w:]+)`", section, re.M)}
    return names


def removed(changelog, version):
    """What the lines under "Removed" of versions after the given one say in `marks`."""
    said = set()
    for section in re.split(r"^## ", changelog, flags=re.M)[1:]:
        if re.match(rf"\[?{re.escape(version)}\]?\b", section):
            return said
        for part in re.split(r"^### ", section, flags=re.M)[1:]:
            if part.startswith("Removed"):
                said |= set(re.findall(r"`(?:taut::)?([\w:]+)`", part))
    raise SystemExit(f"CHANGELOG.md has no section {version}, of tests/house/released-names.txt")


def main():
    root = pathlib.Path(sys.argv[1])
    file = root / "tests/house/released-names.txt"
    now = listed((root / "docs/reference/names.md").read_text(encoding="utf-8"))
    if "--write" in sys.argv:
        header = (root / "include/taut/version.hpp").read_text(encoding="utf-8")
        version = re.search(r'TAUT_VERSION_STRING "([^"]+)"', header)[1]
        file.write_text("\n".join([f"# {version}", *sorted(now)]) + "\n", encoding="utf-8")
        return 0
    first, *before = file.read_text(encoding="utf-8").splitlines()
    said = removed((root / "CHANGELOG.md").read_text(encoding="utf-8"), first.removeprefix("# "))
    bare = {name.split()[1]: name.split()[0] for name in now}
    faults = []
    for name in sorted(set(before) - now):
        header, word = name.split()
        if word in said:
            continue
        moved = f", now in {bare[word]}" if word in bare else ""
        faults.append(f"{word}: was in {header}{moved}; a public name goes with a line under \"Removed\" in CHANGELOG.md")
    print("\n".join(faults) or f"{len(before)} names of {first.removeprefix('# ')}: all are here, or said to be removed")
    return 1 if faults else 0


sys.exit(main())
