# SPDX-License-Identifier: MIT
"""The page of results: a table for each mesh, and two plots."""

import math
import pathlib
import shlex

COLUMNS = ["peer", "s", "processor s", "MB", "charts", "seam", "E", "flips", "overlap", "use"]
VOLUME_COLUMNS = ["peer", "s", "processor s", "MB", "E", "inverted", "smallest det", "pins"]


def number(value, digits=3):
    if value is None:
        return ""
    if isinstance(value, float) and not math.isfinite(value):
        return "∞"
    return f"{value:.{digits}g}" if value < 1000 else f"{value:,.0f}"


def row_of(r, columns):
    if "error" in r:
        return f"| {r['peer']} | {r['error'].replace('|', '/')} |" + " |" * (len(columns) - 2)
    flips = f"**{r['flips']}**" if r["flips"] else "0"
    start = f"| {r['peer']} | {number(r['seconds'])} | {number(r['processor'])} | {r['megabytes']:.0f} | "
    if r["kind"] == "volume":
        return f"{start}{number(r['energy'], 5)} | {flips} | {number(r['smallest'])} | {number(r['pins'], 2)} |"
    overlap = "0" if r["overlap"] == 0 else f"**{100 * r['overlap']:.2g} %**"
    return f"{start}{r['charts']} | {number(r['seam'])} | {number(r['energy'], 5)} | {flips} | {overlap} | {100 * r['use']:.0f} % |"


def interrupts(rows):
    lines = []
    for r in rows:
        if "interrupt" in r and "error" not in r:
            s = r["interrupt"]
            words = "had to be killed after 10 s" if s is None else "had ended before" if s != s else f"{s:.2g} s"
            lines.append(f"| {r['peer']} | {r['mesh']} | {r['seconds']:.3g} | {words} |")
    return lines


INK = {"light": "#000000", "dark": "#e2e6ee"}
GROUND = {"light": "#ffffff", "dark": "#16191f"}
COLORS = {"light": ["#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22", "#17becf"],
          "dark": ["#4fa3e0", "#ff9d45", "#53c653", "#ff6b6b", "#b491e0", "#c48b7f", "#f29ddb", "#a8a8a8", "#d4d54a", "#45d3e6"]}


def pictures(name, words):
    """A plot of each theme, of which a reader sees one."""
    return "".join(f"![{words}{', dark' * (theme == 'dark')}](../images/{name}-{theme}.svg#gh-{theme}-mode-only)\n" for theme in INK)


def plots(images, name, *what):
    for theme in INK:
        plot(images / f"{name}-{theme}.svg", theme, *what)


def plot(path, theme, rows, kind, x, y, labels):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"svg.hashsalt": "taut", "font.size": 9})
    plt.rcParams.update(dict.fromkeys(["text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color"], INK[theme]))
    plt.rcParams.update(dict.fromkeys(["figure.facecolor", "axes.facecolor", "legend.facecolor"], GROUND[theme]))
    figure, axes = plt.subplots(figsize=(7, 4.2))
    good = [r for r in rows if r["kind"] == kind and "error" not in r and r[y] is not None and math.isfinite(r[y])]
    for n, peer in enumerate(dict.fromkeys(r["peer"] for r in good)):
        mine = [r for r in good if r["peer"] == peer]
        axes.plot([r[x] for r in mine], [r[y] for r in mine], "o" if peer.startswith("taut") else "x", label=peer,
                  color=COLORS[theme][n % 10])
    axes.set(xscale="log", yscale="log", xlabel=labels[0], ylabel=labels[1])
    axes.grid(True, which="both", alpha=0.2)
    axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


HEADS = {
    "atlas": "## Atlases of closed surfaces\n\n" + pictures("peers-seams", "Seam length over processor seconds") + "\n",
    "disk": "## Maps of disks\n\n" + pictures("peers-distortion", "Distortion over processor seconds") + "\n",
    "volume": """## Volumes

A bar of cubes of six tetrahedra each, whose ends are pinned, one of them turned by 90 and 150 degrees. *E*: the mean of |S|² |S⁻¹|² / 9, 1 for
similarities; each peer minimises an energy of its own. *smallest det*: of all tetrahedra. *pins*: the farthest from its place; the bar is 1 wide.

""",
}


def sentences(rows):
    """What the tables say in words: where a peer was better than taut, by each measure, on how many meshes."""
    words = []
    for kind, mine in (("atlas", "taut"), ("disk", "taut unwrap"), ("volume", "taut deform")):
        of_kind = [r for r in rows if r["kind"] == kind and "error" not in r]
        ours = {r["mesh"]: r for r in of_kind if r["peer"] == mine}
        names = {"atlas": {"processor": "less processor time", "seam": "shorter seams", "energy": "less distortion", "use": "a fuller square"},
                 "disk": {"processor": "less processor time", "energy": "less distortion"},
                 "volume": {"processor": "less processor time", "energy": "less distortion"}}[kind]
        for peer in dict.fromkeys(r["peer"] for r in of_kind if not r["peer"].startswith("taut")):
            theirs = [r for r in of_kind if r["peer"] == peer and r["mesh"] in ours]
            better = []
            for key, name in names.items():
                sign = -1 if key == "use" else 1
                count = sum(sign * r[key] < sign * ours[r["mesh"]][key] for r in theirs)
                if count:
                    better.append(f"{name} {count}")
            bad = sum(r["flips"] > 0 or r.get("overlap", 0) > 1e-4 for r in theirs)
            if better:
                words.append(f"| {peer} | {mine} | {len(theirs)} | {', '.join(better)} | {bad or ''} |")
    return words


def busy(rows):
    """A sentence's end on how busy the machine was, by what calls of single threads waited."""
    waits = [r["seconds"] / r["processor"] for r in rows if r.get("processor", 0) > 0.2]
    often = sorted(waits)[len(waits) // 2] if waits else 1
    return f" (as here: the median call took {often:.1f} s a processor second)" if often > 1.2 else ""


def of_runs(rows):
    most = max(r.get("runs", 1) for r in rows)
    return "of one run" if most == 1 else f"the median of up to {most} runs\n(of one, where it takes long)"


def told(words):
    """The arguments, but for where the environment lies."""
    at = words.index("--folder") if "--folder" in words else len(words)
    return words[:at] + words[at + 2:]


def write(path, rows, command, machine, cores):
    path = pathlib.Path(path)
    images = path.resolve().parents[1] / "images"
    plots(images, "peers-seams", rows, "atlas", "processor", "seam", ("processor seconds", "seam length / sqrt(area)"))
    plots(images, "peers-distortion", rows, "disk", "processor", "energy", ("processor seconds", "mean symmetric Dirichlet energy"))
    versions = {r["peer"].split()[0]: r["version"] for r in rows if r.get("version")}
    text = f"""# Comparison with other packages

```sh
{shlex.join(['bench/peers.py', *told(command[1:])])}
```

made this page, in one run on {cores} cores of {machine}. Each run is a process of its own; *s* are seconds of the call, {of_runs(rows)}, with kernels compiled before where there are any; *processor s* are those of all its threads, which say more where others use the machine, too{busy(rows)}. *MB* is the peak of the process. What is made is judged by `bench/peers/judge.py` and `volumes.py`, in which no package has a part.
Meshes are of Debian's `libcgal-demo`. A process ends at its limit of processor seconds, of all threads together. A peer that leaves another mesh is judged on that one. All run with their defaults; numbers of flips or overlaps other than 0 are bold.

* *seam*: length of the edges that are cut, by the root of the area. *E*: area mean of |S|² (1 + 1/det²) at one common scale, 4 without distortion.
* *flips*: triangles flipped within their chart. *overlap*: the part of what is covered that is covered twice, of 2048² points; less than a few 0.001 % may be rounding.
* *use*: area of the charts by that of the square around them.
* *taut*: its default, short seams. *taut for packing*: `prefer="packing"`, more and flatter charts, as most others make.

Versions: {', '.join(f'{k} {v}' for k, v in sorted(versions.items()))}.

## Where others are better

On how many of the meshes that it ends on a peer is better than taut, and on how many it leaves flips, or more than 0.01 % covered twice.

| peer | against | meshes | better | flips or overlaps |
|---|---|---|---|---|
""" + "\n".join(sentences(rows)) + "\n\n"
    for kind in (k for k in HEADS if any(r["kind"] == k for r in rows)):
        text += HEADS[kind]
        columns, cells = (VOLUME_COLUMNS, "tetrahedra") if kind == "volume" else (COLUMNS, "triangles")
        for mesh in dict.fromkeys(r["mesh"] for r in rows if r["kind"] == kind):
            mine = [r for r in rows if r["kind"] == kind and r["mesh"] == mesh]
            text += f"### {mesh}, {mine[0]['size']:,} {cells}\n\n| " + " | ".join(columns) + " |\n"
            text += "|" + "---|" * len(columns) + "\n" + "\n".join(row_of(r, columns) for r in mine) + "\n\n"
    lines = interrupts(rows)
    if lines:
        text += """## Ctrl-C

Seconds from a Ctrl-C in the middle of the call to the end of the process, on the last mesh of each kind, of calls that take more than half a second.
The process of taut waits for the piece of work that is under way; the call itself raises half a second after the signal at the latest.

| peer | mesh | seconds of the call | ended after |
|---|---|---|---|
""" + "\n".join(lines) + "\n"
    path.write_text(text.rstrip("\n") + "\n", encoding="utf-8")
