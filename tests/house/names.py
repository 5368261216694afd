# SPDX-License-Identifier: MIT
"""names.py ROOT [--rows]: the public names of the headers are those of docs/reference/names.md and have docstrings.

Public is what a header declares in taut, taut::io, taut::energy, taut::solve or taut::dist; the rest is in the impl of one of them.
The page has a section for each header of include/taut. Each name stands in one section, of a header that brings it,
with a meaning; pages for users name no others of taut::io, energy, solve and dist. A docstring starts with a noun phrase or a verb in the third person, never with What, Whether, Who, How, ...
--rows prints the rows of names that the page lacks, with the first sentence of their comments."""
import collections
import pathlib
import re
import sys

from declarations import declared

root = pathlib.Path(sys.argv[1])
include = root / "include/taut"
QUESTION = re.compile(r"(?:What|Whether|Who|Whose|Whom|How|Of|Where|When|Which|Why)\b")

headers = {str(p.relative_to(include)): p.read_text() for p in sorted(include.rglob("*.hpp")) if "kernels" not in p.parts}
names = {}
for path, text in headers.items():
    try:
        names[path] = declared(text)
    except SystemExit as e:
        sys.exit(f"{path}: {e}")


def reached(path, seen):
    for included in re.findall(r"#include <taut/([\w/]+\.hpp)>", headers[path]):
        if included in headers and included not in seen:
            seen.add(included)
            reached(included, seen)
    return seen


def written(space, name):
    return (space + "::" + name).replace("taut::", "", 1)


page = (root / "docs/reference/names.md").read_text()
faults, listed = [], collections.Counter()
for section in re.split(r"^## ", page, flags=re.M)[1:]:
    header = re.match(r"`taut/(\w+\.hpp)`", section)
    if not header or header.group(1) not in headers:
        faults.append(f"section {section.splitlines()[0]}: no such header")
        continue
    brought = {written(*key) for path in reached(header.group(1), {header.group(1)}) for key in names[path]}
    for row, meaning in re.findall(r"^\| `([\w:]+)` \|(.*)\|$", section, re.M):
        listed[row] += 1
        if not meaning.strip():
            faults.append(f"{row}: no meaning on the page")
        if QUESTION.match(meaning.strip().capitalize()):
            faults.append(f"{row}: the page answers no question; name the thing, or say what it does with a verb")
        if row not in brought:
            faults.append(f"{row}: {header.group(1)} does not bring it")
OTHERS = {"taut", "headers", "dist", "eigen", "gltf", "io", "energy", "solve"}  # namespaces, and targets of CMake
for path in [root / "README.md", *sorted(p for f in ("tutorial", "howto", "reference") for p in (root / "docs" / f).glob("*.md"))]:
    text = path.read_text()
    said = re.findall(r"(?<![\w:/])(?:taut::)?((?:io|energy|solve|dist)::\w+)", text)
    said += set(re.findall(r"\btaut::(\w+)\b(?!::)", text)) - OTHERS
    faults += [f"{path.relative_to(root)}: {n} is no public name" for n in sorted(set(said) - set(listed))]
public = {}
for declarations in names.values():
    for key, comments in declarations.items():
        name = written(*key)
        public[name] = public.get(name) or next(filter(None, comments), "")
        faults += [f'{name}: a docstring starts with a noun phrase or a verb, not "{comment[:30]} ..."'
                   for comment in comments if QUESTION.match(comment)]
faults += [f"{n}: no docstring" for n, comment in public.items() if not comment]
faults += [f"{n}: twice on the page" for n, count in listed.items() if count > 1]
faults += [f"{n}: on the page, but in no header" for n in sorted(set(listed) - set(public))]
missing = sorted(set(public) - set(listed))
if "--rows" in sys.argv:
    for n in missing:
        sentence = re.split(r"(?<=[.:])\s", public[n] + " ")[0].rstrip(".: ")
        print(f"| `{n}` | {sentence} |")
    sys.exit()
faults += [f"{n}: public, but not on the page" for n in missing]
flat = sorted(p for p in headers if "/" not in p and p not in ("taut.hpp", "version.hpp"))
faults += [f"taut/{p}: no section on the page" for p in flat if f"## `taut/{p}`" not in page]
print("\n".join(faults) or f"{len(public)} public names in {len(flat)} headers, as on the page")
sys.exit(1 if faults else 0)
