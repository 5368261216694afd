#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""documents.py ROOT: pages for users are free of the idioms of a laboratory, and no link within the repository is dead, or
leads to what the site leaves out.

Pages for users are README.md and docs/. Those that are no explanation name public headers alone, no path below impl/.
Links are those of all documents, with their headings, and pages that sources name as docs/FOLDER/PAGE.md. docs/README.md
lists every page."""

import pathlib
import re
import sys

IDIOMS = [
    r"by turns", r"(?:is|are) not kept", r"the version before", r"since then", r"trial programs?\b",
    r"stand-ins?\b", r"\bstays? open", r"\bthe doors\b", r"\bdraft(?:s|ed)?\b", r"pins? (?:is|are) (?:drawn|led)",
    r"next to nothing", r"\bfound and told\b", r"\bno numbers\b", r"\bwhoever laid\b", r"\bsewn along\b",
    r"\bone an? (?:vertex|triangle|corner|point|side|chart|cell|element|line)\b", r"\bwhoever\b", r"\bturned over\b",
    r"\bmend(?:s|ed)?\b", r"\bcomes? to lie\b", r"\bstands? in for\b", r"\blengths of the run\b",
    r"\bwho has stopped\b", r"\bwhat nothing holds\b", r"became [0-9]", r"\bidle cores\b", r"in the same hour",
]
GONE = re.compile(r"TAUT_COMPILED|taut::compiled|TAUT_ON_USE")
SOURCES = ["include", "src", "tools", "tests", "examples", "bench", "scripts", "cmake", "kernels"]


def without_code(text):
    """The text with the same lines, those of code blocks empty."""
    lines, inside = [], False
    for line in text.split("\n"):
        fence = line.lstrip().startswith("```")
        lines.append("" if inside or fence else line)
        inside ^= fence
    return lines


def anchors(page):
    """The names that GitHub gives to the headings of a page."""
    names, seen = set(), {}
    for line in without_code(page.read_text(encoding="utf-8")):
        heading = re.match(r"#{1,6} +(.*)", line)
        if not heading:
            continue
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).strip().lower()
        name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        seen[name] = seen.get(name, -1) + 1
        names.add(f"{name}-{seen[name]}" if seen[name] else name)
    return names


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    documents = [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md"))]
    docs, faults = root / "docs", []

    def fault(page, number, what):
        faults.append(f"{page.relative_to(root)}:{number}: {what}")

    for page in documents:
        internal = page.name == "CHANGELOG.md" or root / "docs" / "explanation" in page.parents
        if not internal:
            for number, line in enumerate(page.read_text(encoding="utf-8").split("\n"), 1):
                if found := re.search(r"\bimpl(?:/|::)[\w/.:]*", line):
                    fault(page, number, f"{found[0]} is internal; name a public header, or say what happens")
        for number, line in enumerate(without_code(page.read_text(encoding="utf-8")), 1):
            if page.name != "CHANGELOG.md":
                if found := GONE.search(line):
                    fault(page, number, f"{found[0]} exists no more")
                for idiom in IDIOMS:
                    if found := re.search(idiom, re.sub(r"`[^`]*`", "", line), re.IGNORECASE):
                        fault(page, number, f'"{found[0]}": say what is, in the terms of the field')
            for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, name = target.partition("#")
                file = (page.parent / path).resolve() if path else page
                if not file.exists():
                    fault(page, number, f"{target}: no such file")
                elif not (docs in file.parents or file == docs or file.parent == root):
                    fault(page, number, f"{target}: no part of the site (scripts/site); name it as code, without a link")
                elif name and file.suffix == ".md" and name not in anchors(file):
                    fault(page, number, f"{target}: no such heading")

    listed = set(re.findall(r"\]\((\w+/[\w-]+\.md)\)", (docs / "README.md").read_text(encoding="utf-8")))
    for page in sorted(docs.glob("*/*.md")):
        if str(page.relative_to(docs)) not in listed:
            fault(page, 1, "is not in docs/README.md")

    files = [file for folder in SOURCES for file in (root / folder).rglob("*") if file.is_file()]
    for file in documents + files:
        if file == pathlib.Path(__file__).resolve() or "node_modules" in file.parts:
            continue
        try:
            text = file.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        for number, line in enumerate(text.split("\n"), 1):
            for name in re.findall(r"\bdocs/[\w/-]+\.md", line):
                if not (root / name).exists():
                    fault(file, number, f"{name}: no such page")

    print("\n".join(faults) or f"{len(documents)} documents")
    return 1 if faults else 0


sys.exit(main())
