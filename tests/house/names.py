# SPDX-License-Identifier: MIT
"""names.py ROOT [--rows]: the public names of the headers are those of docs/reference/names.md and have docstrings.

Public is what a header declares in taut, taut::io, taut::energy or taut::solve; the rest is in the impl of one of them.
The page has a section for each header of include/taut. Each name stands in one section, of a header that brings it,
with a meaning. A docstring starts with a noun phrase or a verb in the third person, never with What, Whether, Who, How, ...
--rows prints the rows of names that the page lacks, with the first sentence of their comments."""
import collections
import pathlib
import re
import sys

PUBLIC = ("taut", "taut::io", "taut::energy", "taut::solve")
root = pathlib.Path(sys.argv[1])
include = root / "include/taut"
QUESTION = re.compile(r"(?:What|Whether|Who|Whose|Whom|How|Of|Where|When|Which|Why)\b")
QUIET = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)+'", re.S)
DECLARED = re.compile(r"(?:^|\s)(?:class|struct|enum class|enum|concept|using|namespace)\s+(?:\[\[\w+\]\]\s+)?(\w+)")


def blank(text):
    """The same text without comments and strings, of the same length."""
    return QUIET.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def closing(text, brace):
    depth = 0
    for m in re.finditer(r"[{}]", text[brace:]):
        depth += 1 if m.group() == "{" else -1
        if depth == 0:
            return brace + m.start()
    raise SystemExit("unbalanced braces")


def statements(code, begin, end):
    """(from, to, head) of what is declared between two places: head is the text before a body or a semicolon."""
    at = begin
    while at < end:
        parentheses, m = 0, None
        for m in re.compile(r"[(){;]|^#[^\n]*$", re.M).finditer(code, at, end):
            parentheses += {"(": 1, ")": -1}.get(m.group(), 0)
            if parentheses == 0 and m.group() not in "()":
                break
        else:
            return
        if m.group()[0] == "#":
            at = m.end()
            continue
        stop = m.end()
        if m.group() == "{":
            stop = closing(code, m.start()) + 1
            rest = re.compile(r"\s*[\w, ]*;").match(code, stop)
            if rest:
                stop = rest.end()
        yield at, stop, code[at:m.start()]
        at = stop


def without_templates(head):
    while re.search(r"<[^<>]*>", head):
        head = re.sub(r"<[^<>]*>", "", head)
    clause = re.search(r"\brequires\s*(\(|!?[\w:]+)", head)
    while clause:
        end = clause.end()
        depth = 1 if clause.group(1) == "(" else 0
        while depth and end < len(head):
            depth += {"(": 1, ")": -1}.get(head[end], 0)
            end += 1
        head = head[:clause.start()] + head[end:]
        clause = re.search(r"\brequires\s*(\(|!?[\w:]+)", head)
    return head


def name_of(head):
    flat = without_templates(head)
    if "operator" in flat or "static_assert" in flat or re.search(r"\b(friend|extern)\b", flat):
        return None
    before = flat.split("(")[0]
    if "concept" in before or "using" in before or "namespace" in before:
        return DECLARED.search(" " + before).group(1)
    kind = re.search(r"(?:^|\s)(?:class|struct|enum class|enum)\s+(\w+)\s*(?:final\s*)?(?::[^:]|$)", flat.strip() + "\n")
    if kind and "(" not in flat.split(kind.group(1))[0]:
        return kind.group(1)
    if "->" in flat and "auto" not in flat:
        return None  # a deduction guide
    called = re.search(r"\b(?!requires\b|noexcept\b|decltype\b|template\b)(\w+)\s*\(", flat)
    if called and flat[:called.start()].endswith("::"):
        return None  # a member, defined out of its class
    words = [called.group(1)] if called else re.findall(r"[\w:]+", before.split("=")[0])
    if not words or "::" in words[-1]:
        return None
    return words[-1]


def declared(text):
    """{(namespace, name): comments of its declarations} of one header."""
    code, found = blank(text), {}
    for m in re.finditer(r"^namespace ([\w:]+)\n\{", code, re.M):
        space = m.group(1)
        inner = space in PUBLIC
        if not inner and not re.fullmatch(r"taut(::(io|energy|solve))?::impl(::\w+)?", space):
            raise SystemExit(f"namespace {space} is neither public nor impl")
        if not inner:
            continue
        end = closing(code, m.end() - 1)
        for begin, stop, head in statements(code, m.end(), end):
            nested = re.match(r"\s*namespace (\w+)\s*$", head)
            if nested:
                raise SystemExit(f"namespace {nested.group(1)} within {space}: name it in one piece")
            name = name_of(head)
            if name:
                lines = re.findall(r"^[ \t]*///[ \t]?([^\n]*)", text[begin:begin + len(head)], re.M)
                found.setdefault((space, name), []).append(" ".join(lines).strip())
    return found


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
