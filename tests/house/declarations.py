# SPDX-License-Identifier: MIT
"""What a header declares, read without a compiler: for names.py and the site's reference (docs/site/cpp_reference.py)."""
import re

PUBLIC = ("taut", "taut::io", "taut::energy", "taut::solve", "taut::dist")
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
        if not inner and not re.fullmatch(r"taut(::(io|energy|solve|dist))?::impl(::\w+)?", space):
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
