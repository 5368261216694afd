# SPDX-License-Identifier: MIT
"""The page of results: a table for each mesh, and two plots."""

import math
import pathlib

COLUMNS = ["peer", "s", "MB", "charts", "seam", "E", "flips", "overlap", "use"]


def number(value, digits=3):
    if value is None:
        return ""
    if isinstance(value, float) and not math.isfinite(value):
        return "∞"
    return f"{value:.{digits}g}" if value < 1000 else f"{value:,.0f}"


def row_of(r):
    if "error" in r:
        return f"| {r['peer']} | {r['error'].replace('|', '/')} | | | | | | | |"
    flips = f"**{r['flips']}**" if r["flips"] else "0"
    overlap = "0" if r["overlap"] == 0 else f"**{100 * r['overlap']:.2g} %**"
    return (f"| {r['peer']} | {number(r['seconds'])} | {r['megabytes']:.0f} | {r['charts']} | {number(r['seam'])} | "
            f"{number(r['energy'], 5)} | {flips} | {overlap} | {100 * r['use']:.0f} % |")


def interrupts(rows):
    lines = []
    for r in rows:
        if "interrupt" in r and "error" not in r:
            s = r["interrupt"]
            words = "had to be killed after 10 s" if s is None else "had ended before" if s != s else f"{s:.2g} s"
            lines.append(f"| {r['peer']} | {r['mesh']} | {r['seconds']:.3g} | {words} |")
    return lines


def plot(path, rows, kind, x, y, labels):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"svg.hashsalt": "taut", "font.size": 9})
    figure, axes = plt.subplots(figsize=(7, 4.2))
    good = [r for r in rows if r["kind"] == kind and "error" not in r and r[y] is not None and math.isfinite(r[y])]
    for n, peer in enumerate(dict.fromkeys(r["peer"] for r in good)):
        mine = [r for r in good if r["peer"] == peer]
        axes.plot([r[x] for r in mine], [r[y] for r in mine], "o" if peer.startswith("taut") else "x", label=peer,
                  color=f"C{n % 10}")
    axes.set(xscale="log", yscale="log", xlabel=labels[0], ylabel=labels[1])
    axes.grid(True, which="both", alpha=0.2)
    axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def write(path, rows, command, machine, cores):
    path = pathlib.Path(path)
    images = path.resolve().parents[1] / "images"
    plot(images / "peers-seams.svg", rows, "atlas", "seconds", "seam", ("seconds", "seam length / sqrt(area)"))
    plot(images / "peers-distortion.svg", rows, "disk", "seconds", "energy", ("seconds", "mean symmetric Dirichlet energy"))
    versions = {r["peer"].split()[0]: r["version"] for r in rows if "version" in r}
    text = f"""# Comparison with other packages

`{' '.join(['bench/peers.py', *command[1:]])}` made this page, in one run on {cores} cores of {machine}. Each row is one process; seconds are those of the
call, once, with its kernels compiled before where there are any; MB is the peak of the process. What is made is judged by `bench/peers/judge.py`, in which no package has a part. Meshes are of Debian's
`libcgal-demo`. A peer that leaves another mesh is judged on that one. All run with their defaults; numbers of flips or overlaps other than 0 are bold.

* *seam*: length of the edges that are cut, by the root of the area. *E*: area mean of |S|² (1 + 1/det²) at one common scale, 4 without distortion.
* *flips*: triangles turned over within their chart. *overlap*: the part of what is covered that is covered twice, of 2048² points; less than a few 0.001 % may be rounding.
* *use*: area of the charts by that of the square around them.

Versions: {', '.join(f'{k} {v}' for k, v in sorted(versions.items()))}.

## Atlases of closed surfaces

![Seam length over seconds](../images/peers-seams.svg)

"""
    for kind in ("atlas", "disk"):
        if kind == "disk":
            text += """## Maps of disks

![Distortion over seconds](../images/peers-distortion.svg)

"""
        for mesh in dict.fromkeys(r["mesh"] for r in rows if r["kind"] == kind):
            mine = [r for r in rows if r["kind"] == kind and r["mesh"] == mesh]
            text += f"### {mesh}, {mine[0]['triangles']:,} triangles\n\n| " + " | ".join(COLUMNS) + " |\n"
            text += "|" + "---|" * len(COLUMNS) + "\n" + "\n".join(row_of(r) for r in mine) + "\n\n"
    lines = interrupts(rows)
    if lines:
        text += """## Ctrl-C

Seconds from a Ctrl-C in the middle of the call to the end of the process.

| peer | mesh | seconds of the call | ended after |
|---|---|---|---|
""" + "\n".join(lines) + "\n"
    path.write_text(text)
