# SPDX-License-Identifier: MIT
"""names.py ROOT [--write]: docs/reference/names.md is the list of the public names of the headers, and these have docstrings.

Public is what a header declares in taut, taut::io, taut::energy, taut::solve or taut::dist; the rest is in the impl of one of them.
The page has a section for each header of include/taut, with the comment at its head, and a row for each name with the
first sentence of its docstring; --write makes it. A name stays in the section of a header that brings it, a new one is
in that of the nearest. Pages for users name no others of taut::io, energy, solve and dist. A docstring starts with a noun
phrase or a verb in the third person, never with What, Whether, Who, How, ..."""
import collections
import pathlib
import re
import sys

from declarations import declared

root = pathlib.Path(sys.argv[1])
include = root / "include/taut"
PAGE = root / "docs/reference/names.md"
QUESTION = re.compile(r"(?:What|Whether|Who|Whose|Whom|How|Of|Where|When|Which|Why)\b")
HEAD = """# Public names

Every name of the library that programs may use, by header, in namespace `taut`; made from the headers by
`python3 tests/house/names.py . --write`. Names in a namespace `impl` change without notice. Options, reports and results have parts that
programs read and set as fields but need not name; the site shows them with the types that have them. How maps are parametrised, run and placed is in
[maps](maps.md).
"""

headers = {str(p.relative_to(include)): p.read_text() for p in sorted(include.rglob("*.hpp")) if "kernels" not in p.parts}
flat = sorted(p for p in headers if "/" not in p and p not in ("taut.hpp", "version.hpp"))
names = {}
for path, text in headers.items():
    try:
        names[path] = declared(text)
    except SystemExit as e:
        sys.exit(f"{path}: {e}")


def reached(path):
    """Headers that one brings, itself included, with the number of includes between."""
    far, queue = {path: 0}, collections.deque([path])
    while queue:
        at = queue.popleft()
        for included in re.findall(r"#include <taut/([\w/]+\.hpp)>", headers[at]):
            if included in headers and included not in far:
                far[included] = far[at] + 1
                queue.append(included)
    return far


def written(space, name):
    return (space + "::" + name).replace("taut::", "", 1)


def sections(page):
    """{header: (its comment, [names])} of the page."""
    found = {}
    for section in re.split(r"^## ", page, flags=re.M)[1:]:
        header = re.match(r"`taut/(\w+\.hpp)`\n+([^|#]*)", section)
        if header:
            found[header[1]] = (header[2].strip(), re.findall(r"^\| `([\w:]+)` \|", section, re.M))
    return found


def about(header, before):
    """The comment at the head of a header; what the page says of one that has none."""
    comment = re.match(r"(?:(?://(?!/)|#)[^\n]*\n|\s*\n)*((?:///[^\n]*\n)+)", headers[header])
    return " ".join(re.findall(r"/// ?([^\n]*)", comment[1])) if comment else before


def meaning(comment):
    """The first sentence of a docstring as a cell of a table, a long one up to its colon."""
    sentence = re.split(r"(?<!\beq)(?<!e\.g)\.(?=\s|$)|:(?=  )", comment)[0].rstrip(" :.")
    if len(sentence) > 120:
        sentence = re.split(r"(?<=.{15}[\w)]):\s", sentence)[0]
    return sentence.replace("\\", "\\\\").replace("|", "\\|")


page = PAGE.read_text()
public = {}
for declarations in names.values():
    for key, comments in declarations.items():
        public[written(*key)] = public.get(written(*key)) or next(filter(None, comments), "")
said = sections(page)
far = {header: reached(header) for header in flat}


def home(name):
    """The header under which a name is listed: that of the page if it still brings it, else the nearest."""
    bring = {header: min(far[header][path] for path in far[header] if name in brought[path])
             for header in flat if any(name in brought[path] for path in far[header])}
    listed = [header for header in bring if name in said.get(header, ("", []))[1]]
    return min(bring, key=lambda header: (header not in listed, bring[header], header), default=None)


brought = {path: {written(*key) for key in declarations} for path, declarations in names.items()}
homes = {name: home(name) for name in public}
out = [HEAD]
for header in [h for h in said if h in flat] + [h for h in flat if h not in said]:
    rows = [f"| `{n}` | {meaning(public[n])} |" for n in sorted(public, key=lambda n: n.split("::")[-1]) if homes[n] == header]
    out.append("\n".join([f"## `taut/{header}`", "", about(header, said.get(header, ("", []))[0]), "",
                          "| name | meaning |", "|---|---|", *rows, ""]))
made = "\n".join(out)
if "--write" in sys.argv:
    PAGE.write_text(made)
    sys.exit()

faults = [f"{n}: no header of include/taut brings it" for n, header in homes.items() if header is None]
OTHERS = {"taut", "headers", "core", "files", "charts", "dist", "eigen", "gltf", "io", "energy", "solve"}  # namespaces, and targets of CMake
for path in [root / "README.md", *sorted(p for f in ("tutorial", "howto", "reference") for p in (root / "docs" / f).glob("*.md"))]:
    text = path.read_text()
    used = re.findall(r"(?<![\w:/])(?:taut::)?((?:io|energy|solve|dist)::\w+)", text)
    used += set(re.findall(r"\btaut::(\w+)\b(?!::)", text)) - OTHERS
    faults += [f"{path.relative_to(root)}: {n} is no public name" for n in sorted(set(used) - set(public))]
for declarations in names.values():
    for key, comments in declarations.items():
        faults += [f'{written(*key)}: a docstring starts with a noun phrase or a verb, not "{comment[:30]} ..."'
                   for comment in comments if QUESTION.match(comment)]
faults += [f"{n}: no docstring" for n, comment in public.items() if not comment]
if page != made:
    new = sorted(set(re.findall(r"^\| `([\w:]+)`", made, re.M)) ^ set(re.findall(r"^\| `([\w:]+)`", page, re.M)))
    faults.append(f"docs/reference/names.md is not what the headers say ({', '.join(new) or 'other words'}): "
                  "python3 tests/house/names.py . --write")
print("\n".join(faults) or f"{len(public)} public names in {len(flat)} headers, as on the page")
sys.exit(1 if faults else 0)
