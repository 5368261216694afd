# SPDX-License-Identifier: MIT
"""Pages of the C++ reference: a page a public header, with the declaration and comment of each name that
docs/reference/names.md has for it. Used by scripts/site.

    cpp_reference.py FOLDER

writes the pages into a folder that is not there; the exit code is 1 if a name has no declaration."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/house"))

from declarations import PUBLIC, blank, closing, name_of, statements  # noqa: E402

TYPE = re.compile(r"^\s*(?:template\s*<.*>\s*)?(?:requires[^\n]*\s*)?(?:class|struct|enum|concept|using|namespace)\b", re.S)


def signature(head):
    """A function without its body and its list of initial values."""
    return re.sub(r"(\)[^():]*?)\s:\s(?!:).*$", r"\1", head.rstrip(), flags=re.S).rstrip() + ";"


def without_bodies(text, code, begin, stop):
    """A class as its users see it: functions without bodies, nothing that is private."""
    brace = code.find("{", begin, stop)
    if brace < 0 or re.match(r"\s*(?:\[\[\w+\]\]\s*)?enum", code[begin:]):
        return text[begin:stop].strip()
    end = closing(code, brace)
    hidden = re.search(r"^(?:private|protected):", code[brace:end], re.M)
    last = brace + hidden.start() if hidden else end
    parts = []
    for b, e, head in statements(code, brace + 1, last):
        whole = text[b:e]
        is_function = "(" in head and code[e - 1] == "}" and not TYPE.match(head)
        parts.append(signature(text[b:b + len(head)]) if is_function else whole.rstrip())
    return text[begin:brace].strip() + "\n{" + "".join(parts) + "\n};"


def parted(text):
    """The comment above a declaration, and the declaration."""
    comment, rest = [], []
    for line in text.strip("\n").split("\n"):
        stripped = line.strip()
        if not rest and stripped.startswith("//"):
            if stripped.startswith("///"):
                comment.append(stripped[3:].removeprefix(" "))
        elif stripped or rest:
            rest.append(line)
    return comment, "\n".join(rest).strip()


def declarations(text, spaces=PUBLIC):
    """[(name, comment, declaration)] of some namespaces of a header."""
    code, found = blank(text), []
    for m in re.finditer(r"^namespace ([\w:]+)\n\{", code, re.M):
        if m.group(1) not in spaces:
            continue
        space = (m.group(1) + "::").removeprefix("taut::")
        for begin, stop, head in statements(code, m.end(), closing(code, m.end() - 1)):
            name = name_of(head)
            if not name:
                continue
            lead = len(head) - len(head.lstrip())  # comments are blank in head
            comment, own = parted(text[begin:begin + len(head)])
            start = begin + lead
            if TYPE.match(head):
                shown = without_bodies(text, code, start, stop)
            elif code[stop - 1] == "}":
                shown = signature(own)
            else:
                shown = text[start:stop].strip()
            if re.fullmatch(r"(?:template\s*<[^>]*>\s*)?(?:class|struct|enum class|enum)\s+[\w:\s]+;", shown):
                continue  # only named before
            if re.search(rf"\b{name}\s*(?:<[^<>]*>)?\s*::", head.split("(")[0]):
                continue  # a member that is defined outside of its class
            found.append((space + name, comment, shown))
    return found


def parts_of(name, shown, inner, told):
    """Plain types of impl that a public declaration names, parts of options and results, and theirs: programs need not
    name them, but see what they hold. told: those that the page has already."""
    space = name.rpartition("::")[0]
    found = []
    for outer, word in re.findall(r"((?:\w+::)*)impl::(\w+)", shown):
        for at in (outer.removeprefix("taut::") + "impl::" + word, (space + "::" if space else "") + "impl::" + word):
            if at in inner and at not in told and not word.endswith("tuning"):
                told.add(at)
                found.append(at)
                found += parts_of(at.replace("impl::", ""), re.sub(r"\b(?<!::)(?=\w+\s+\w+[;=])", "impl::", inner[at][1]),
                                  inner, told)
    return found


def prose(comment):
    """A comment in Markdown; what would be markup in it stays as it is, and indented lines are code."""
    lines = []
    for line in comment:
        mark = r"([\\*_\[\]<>$#])" if "`" not in line else "(<)"
        lines.append(line if line.startswith("    ") else re.sub(mark, r"\\\1", line))
    return "\n".join(lines)


def write(folder):
    """The pages, in the order of docs/reference/names.md; their names."""
    include = ROOT / "include/taut"
    every, inner = {}, {}
    for path in sorted(include.rglob("*.hpp")):
        if "kernels" not in path.parts:
            for name, comment, shown in declarations(path.read_text(encoding="utf-8")):
                every.setdefault(name, []).append((comment, shown))
            for name, comment, shown in declarations(path.read_text(encoding="utf-8"), {f"{space}::impl" for space in PUBLIC}):
                if comment and re.match(r"(?:template\s*<[^{]*>\s*)?(?:struct|enum class)\s+\w+\s*\{", shown):
                    inner[name] = (comment, shown)
    folder.mkdir(parents=True)
    pages = []
    listed = (ROOT / "docs/reference/names.md").read_text(encoding="utf-8")
    for section in re.split(r"^## ", listed, flags=re.M)[1:]:
        header = re.match(r"`taut/(\w+)\.hpp`", section)
        if not header:
            continue
        about = section.split("\n", 1)[1].split("\n|", 1)[0].strip()
        out, told = [f"# taut/{header[1]}.hpp", "", about, ""], set()
        for name, meaning in re.findall(r"^\| `([\w:]+)` \| (.*?) \|$", section, re.M):
            out += [f"## `{name}`", ""]
            said = " ".join(every[name][0][0]).lower() if name in every else ""
            if not said.startswith(meaning.lower().replace("\\|", "|")):
                out += [meaning[:1].upper() + meaning[1:] + ".", ""]
            for comment, shown in every.get(name, []):
                out += [prose(comment), "", "```cpp", shown, "```", ""]
                for part in parts_of(name, shown, inner, told):
                    out += [prose(inner[part][0]), "", "```cpp", inner[part][1], "```", ""]
        (folder / f"{header[1]}.md").write_text("\n".join(out), encoding="utf-8")
        pages.append(header[1])
    return pages


def main():
    folder = pathlib.Path(sys.argv[1])
    pages = write(folder)
    bare = [f"{page}: {section.splitlines()[0]} has no declaration" for page in pages
            for section in re.split(r"^## ", (folder / f"{page}.md").read_text(encoding="utf-8"), flags=re.M)[1:]
            if "```cpp" not in section]
    print("\n".join(bare) or f"{len(pages)} pages")
    return 1 if bare else 0


if __name__ == "__main__":
    sys.exit(main())
