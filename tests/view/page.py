# SPDX-License-Identifier: MIT
"""page.py TAUT FOLDER: `taut view` as a person with a browser meets it; screenshots stay in FOLDER. 77: no Chromium."""
import os
import shutil
import sys
import time

from browser import Browser
from client import Program
from program import dome

chromium = shutil.which("chromium") or shutil.which("chromium-browser")
if not chromium:
    print("skipped: there is no chromium (scripts/setup --with-browser)")
    sys.exit(77)
program, folder = sys.argv[1], os.path.abspath(sys.argv[2])
os.makedirs(folder, exist_ok=True)

NEAR = """(fx, fy) => {
  const pane = taut.right, r = pane.canvas.getBoundingClientRect();
  let best = -1, least = Infinity, at;
  for (let v = 0; v < taut.mesh.vertexCount; ++v) {
    const [x, y] = pane.toScreen(v), d = Math.hypot(x - fx * r.width, y - fy * r.height);
    if (d < least) { least = d; best = v; at = [x + r.left, y + r.top]; }
  }
  return [best, ...at];
}"""


def pick(b, fx, fy):
    """A vertex of the map near a place of its canvas, and where that is on the page."""
    v, x, y = b.evaluate(f"({NEAR})({fx}, {fy})")
    return v, (x, y)


def at_rest(b):
    b.wait("!taut.state.working && taut.frames.length > 0")


def click(b, button):
    b.evaluate(f"document.getElementById('{button}').click()")


def shown(b):
    return b.evaluate("[taut.state.energy, taut.state.flipped, taut.state.pins.size, taut.state.held, Array.from(taut.state.positions)]")


def visit(dark):
    with Program(program, f"{folder}/dome.obj") as p, Browser(chromium, dark=dark) as b:
        b.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=folder)
        b.open(p.url)
        b.wait("window.taut && taut.state && taut.frames.length > 0")
        at_rest(b)
        energy, flipped, pins, _, first = shown(b)
        assert flipped == 0 and pins == 0

        # Two pins: one is put, one is dragged.
        held, at = pick(b, 0.3, 0.5)
        b.drag(at, at, steps=1)
        b.wait("taut.state.pins.size === 1")
        v, at = pick(b, 0.6, 0.5)
        goal = (at[0] + 60, at[1] + 50)
        b.drag(at, goal, steps=20, pen=dark)
        there = f"""(() => {{
          const r = taut.right.canvas.getBoundingClientRect(), p = taut.right.toScreen({v});
          return Math.hypot(p[0] + r.left - {goal[0]}, p[1] + r.top - {goal[1]});
        }})()"""
        b.wait(f"{there} < 0.5 && taut.state.held && !taut.state.working")
        after, flipped, pins, _, _ = shown(b)
        assert flipped == 0 and pins == 2 and after > energy
        b.screenshot(f"{folder}/drag-{'dark' if dark else 'light'}.png")

        # By keyboard: the current pin, then back by undo.
        moved = b.evaluate(f"taut.state.pins.get({v}).x[0]")
        b.key("ArrowRight")
        b.wait(f"taut.state.pins.get({v}).x[0] > {moved}")
        at_rest(b)
        click(b, "undo")
        b.wait("taut.state.canRedo")
        click(b, "undo")
        b.wait("taut.state.pins.size === 1")
        click(b, "undo")
        b.wait("taut.state.pins.size === 0")
        assert shown(b)[4] == first
        click(b, "redo")
        b.wait("taut.state.pins.size === 1")

        # A region that alone may move.
        b.key("s")
        centre, at = pick(b, 0.6, 0.5)
        b.drag(at, (at[0] + 80, at[1]), steps=4)
        assert b.evaluate("taut.region.size") > 10
        click(b, "focus")
        b.key("d")
        before = shown(b)[4]
        b.drag(at, (at[0] + 20, at[1] + 20), steps=8)
        b.wait(f"taut.state.pins.has({centre}) && taut.state.held && !taut.state.working")
        b.screenshot(f"{folder}/region-{'dark' if dark else 'light'}.png")
        outside = b.evaluate("(() => { const o = new Set(); for (let f = 0; f < taut.mesh.faceCount; ++f) if (!taut.region.has(f))"
                             " for (let k = 0; k < 3; ++k) o.add(taut.mesh.faces[3 * f + k]); return [...o]; })()")
        now = shown(b)[4]
        assert all(now[2 * o:2 * o + 2] == before[2 * o:2 * o + 2] for o in outside)
        click(b, "focus")

        # A line of one height.
        b.key("l")
        for f in (0.35, 0.65):
            _, at = pick(b, f, 0.35)
            b.drag(at, at, steps=1)
        line = b.evaluate("taut.line")
        assert len(line) > 3
        click(b, "straight-v")
        b.wait(f"taut.state.pins.size >= {len(line)} && taut.state.held && !taut.state.working")
        now = shown(b)[4]
        assert len({now[2 * o + 1] for o in line}) == 1 and shown(b)[1] == 0

        for button, name in (("save", "dome-flat.obj"), ("save-pins", "pins.csv")):
            click(b, button)
            end = time.monotonic() + 20
            while not os.path.exists(f"{folder}/{name}") and time.monotonic() < end:
                time.sleep(0.05)
            assert os.path.getsize(f"{folder}/{name}") > 0
            os.remove(f"{folder}/{name}")
        assert not b.errors(), b.errors()

    with Program(program, f"{folder}/dome.obj") as p, Browser(chromium) as b:
        b.open(p.url[:-1] + ("0" if p.url[-1] != "0" else "1"))
        b.wait("document.getElementById('note')?.textContent.includes('not connected')")


dome(f"{folder}/dome.obj")
visit(dark=False)
visit(dark=True)
print("page: all as it should be")
