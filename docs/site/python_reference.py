# SPDX-License-Identifier: MIT
"""Pages of the Python reference: a page a public module, with the signature and docstring of each of its names. Used by
scripts/site.

    python_reference.py FOLDER | --check

writes the pages into a folder that is not there, or --check none; the exit code is 1 if a public name has no docstring."""

import ast
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python/taut"
MODULES = ("energies", "errors", "trimesh", "pyvista", "meshio", "grids", "cortex", "patterns", "compat/xatlas")


def parsed(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def exported():
    """{name: (module it is from, name there)} of `taut.__all__`."""
    tree = parsed(PACKAGE / "__init__.py")
    names = next(ast.literal_eval(n.value) for n in tree.body
                 if isinstance(n, ast.Assign) and n.targets[0].id == "__all__")
    origin = {a.asname or a.name: (n.module, a.name)
              for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and n.level for a in n.names}
    return {name: origin.get(name, (None, name)) for name in names}


def signature(node, name=None):
    """As it is called: a function without its body; self is left out."""
    if isinstance(node, ast.ClassDef):
        made = next((n for n in node.body if isinstance(n, ast.FunctionDef) and n.name == "__init__"), None)
        bases = ", ".join(ast.unparse(b) for b in node.bases)
        return f"class {node.name}" + (f"({bases})" if bases else "") + (f"\n{signature(made, node.name)}" if made else "")
    text = ast.unparse(node.args)
    text = re.sub(r"^(self|cls)(, |$)", "", text)
    returns = f" -> {ast.unparse(node.returns)}" if node.returns and name is None else ""
    whole = f"{name or node.name}({text}){returns}"
    if len(whole) > 100:
        arguments, depth, parts = "", 0, []
        for c in text:
            depth += (c in "([{") - (c in ")]}")
            if c == "," and depth == 0:
                parts.append(arguments.strip() + ",")
                arguments = ""
            else:
                arguments += c
        whole = f"{name or node.name}(\n" + "".join(f"    {p}\n" for p in [*parts, arguments.strip()]) + f"){returns}"
    return whole


def is_public(name):
    return not name.startswith("_")


def sections(doc):
    """[(heading, lines)] of a docstring in numpydoc's form; the first has no heading."""
    lines, found, i = doc.split("\n"), [("", [])], 0
    while i < len(lines):
        if i + 1 < len(lines) and lines[i].strip() and re.fullmatch(r"-{3,}", lines[i + 1].strip()):
            found.append((lines[i].strip(), []))
            i += 2
        else:
            found[-1][1].append(lines[i])
            i += 1
    return found


def plain(lines):
    """Sentences, and examples as code."""
    out, code = [], False
    for line in lines:
        begins = line.lstrip().startswith(">>>")
        if begins and not code:
            out += ["", "```pycon"]
            code = True
        elif code and not line.strip():
            out += ["```"]
            code = False
        out.append(line if code else re.sub(r"(?<!\\)([<>_*])(?=[^`]*(?:`[^`]*`[^`]*)*$)", r"\\\1", line.strip()))
    return out + (["```"] if code else [])


def listed(lines):
    """Arguments and their meanings as a list."""
    out = []
    for line in lines:
        if line and not line.startswith(" "):
            name, _, kind = line.partition(" : ")
            out.append(f"* `{name.strip()}`" + (f": *{kind.strip().replace('*', '')}*" if kind else "") + "  ")
        elif line.strip():
            out.append("  " + plain([line])[0])
    return out


def written(doc):
    out = []
    for heading, lines in sections(doc):
        if heading:
            out += ["", f"**{heading}**", ""]
        tabled = heading in ("Parameters", "Attributes", "Returns", "Raises", "Methods", "Yields")
        out += listed(lines) if tabled else plain(lines)
    return "\n".join(out).strip() + "\n"


def entry(node, where, faults, level="##"):
    """A function or class, with the methods and properties of the latter."""
    doc = ast.get_docstring(node)
    if not doc:
        faults.append(f"{where}.{node.name} has no docstring")
    text = f"{level} {node.name}\n\n```python\n{signature(node)}\n```\n\n{written(doc or '')}\n"
    if isinstance(node, ast.ClassDef):
        for part in node.body:
            if isinstance(part, ast.FunctionDef) and is_public(part.name) and ast.get_docstring(part):
                text += entry(part, f"{where}.{node.name}", faults, level + "#")
    return text


def definitions(tree):
    """Top-level functions and classes by name; of overloads the last."""
    return {n.name: n for n in tree.body if isinstance(n, (ast.FunctionDef, ast.ClassDef))}


def write(folder):
    """Writes the pages, and returns their names. Raises ValueError for public names without a docstring."""
    folder.mkdir(parents=True)
    faults, trees = [], {}
    page = "# taut\n\n" + written(ast.get_docstring(parsed(PACKAGE / "__init__.py"))) + "\n"
    for name, (module, original) in exported().items():
        if module is None or module == "errors":
            continue
        if module not in trees:
            trees[module] = definitions(parsed(PACKAGE / f"{module.replace('.', '/')}.py"))
        node = trees[module].get(original)
        if node is not None:
            page += entry(node, "taut", faults)
    (folder / "taut.md").write_text(page, encoding="utf-8")
    pages = ["taut"]
    for module in MODULES:
        tree, dotted = parsed(PACKAGE / f"{module}.py"), "taut." + module.replace("/", ".")
        page = f"# {dotted}\n\n{written(ast.get_docstring(tree))}\n"
        for name, node in definitions(tree).items():
            if is_public(name):
                page += entry(node, dotted, faults)
        pages.append(dotted.removeprefix("taut."))
        (folder / f"{pages[-1]}.md").write_text(page, encoding="utf-8")
    if faults:
        raise ValueError("\n".join(faults))
    return pages


if __name__ == "__main__":
    try:
        if sys.argv[1] == "--check":
            with tempfile.TemporaryDirectory() as folder:
                write(pathlib.Path(folder) / "pages")
        else:
            write(pathlib.Path(sys.argv[1]))
    except ValueError as e:
        sys.exit(str(e))
