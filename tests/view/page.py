# SPDX-License-Identifier: MIT
"""page.py TAUT FOLDER: `taut view` as a person with a browser meets it; screenshots stay in FOLDER. 77: no Chromium."""
import os
import shutil
import sys
import time

from browser import Browser, focused, legible, names, toolbar
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

        # A texture of the user's, on both sides and in the plane of the map.
        b.evaluate("""(async () => {
          const c = new OffscreenCanvas(8, 8), g = c.getContext('2d');
          g.fillStyle = '#00ff00'; g.fillRect(0, 0, 8, 8);
          await taut.takeImage(new File([await c.convertToBlob()], 'mine.png', { type: 'image/png' }));
          globalThis.taken = true;
        })(), 0""")
        b.wait("globalThis.taken")
        assert b.evaluate("document.getElementById('texture').getAttribute('aria-pressed')") == "true"
        assert b.evaluate("taut.panes().map((p) => p.material.uniforms.textured.value)") == [1, 1]
        uv = b.evaluate("Array.from(taut.right.geometry.getAttribute('flatUv').array)")
        assert min(uv) > -1e-6 and abs(max(uv) - 1) < 1e-5
        b.screenshot(f"{folder}/texture-{'dark' if dark else 'light'}.png")
        click(b, "texture")
        b.wait("taut.panes().every((p) => p.material.uniforms.textured.value === 0)")
        names(b)
        legible(b)

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

        # Where pictures take long those of a motion have fewer pixels and no edges, and the last one has all.
        value = "taut.left.geometry.getAttribute('value').version"
        b.wait("taut.right.wires.visible")
        b.evaluate("taut.right.isLate = true")
        whole = b.evaluate(f"[taut.right.canvas.width, {value}]")
        b.evaluate(f"taut.pin({v}, taut.position({v}).map((x) => 1.01 * x))")
        b.wait(f"taut.right.canvas.width < {whole[0]} && !taut.right.wires.visible")
        at_rest(b)
        b.wait(f"taut.right.canvas.width === {whole[0]} && taut.right.wires.visible")
        b.wait(f"{value} > {whole[1]}")
        click(b, "undo")
        b.wait("!document.getElementById('redo').disabled && !taut.state.working")

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


def keyboard():
    """All without a pointer: tools, a pin that is moved, undo until there is nothing to undo, and the views."""
    with Program(program, f"{folder}/dome.obj") as p, Browser(chromium) as b:
        b.open(p.url)
        b.wait("window.taut && taut.state && taut.frames.length > 0")
        at_rest(b)
        assert toolbar(b)[:3] == ["Drag", "Region", "Line"]
        b.key("ArrowRight")
        assert b.evaluate("taut.tool") == "drag"  # arrow keys alone choose nothing
        b.key(" ")
        b.wait("taut.tool === 'region'")
        b.key("d")
        v, _ = pick(b, 0.5, 0.5)
        b.evaluate(f"taut.pin({v}, taut.position({v}))")
        b.wait("taut.state.pins.size === 1")
        at_rest(b)
        names(b)

        # In the bar arrow keys leave the pin alone; on the map they move it.
        x = b.evaluate(f"taut.state.pins.get({v}).x")
        b.key("ArrowUp")
        b.key("ArrowLeft")
        assert focused(b) == "Drag"
        b.evaluate("document.getElementById('map').focus()")
        b.key("ArrowUp")
        b.wait(f"taut.state.pins.get({v}).x[1] > {x[1]}")
        at_rest(b)
        assert b.evaluate(f"taut.state.pins.get({v}).x[0]") == x[0]

        # A button that is switched off hands the focus on.
        b.evaluate("document.getElementById('undo').focus()")
        while b.evaluate("taut.state.canUndo"):
            b.evaluate("taut.frames.length = 0")
            b.key(" ")
            at_rest(b)
        b.wait("document.getElementById('undo').disabled")
        assert focused(b) == "redo", focused(b)
        toolbar(b)

        # A pointer leaves the focus where it is.
        b.evaluate("document.getElementById('map').focus()")
        x, y = b.evaluate("(() => { const r = document.getElementById('relax').getBoundingClientRect(); return [r.x + 5, r.y + 5]; })()")
        b.drag((x, y), (x, y), steps=1)
        assert focused(b) == "map", focused(b)

        at = "[taut.left, taut.right].map((p) => [p.camera.zoom, ...p.camera.position.toArray()])"
        model, flat = b.evaluate(at)
        b.key(".")
        turned, still = b.evaluate(at)
        assert turned != model and still == flat, (model, turned, flat, still)
        b.key("PageUp")
        near, zoomed = b.evaluate(at)
        assert near == turned and zoomed[0] > flat[0]  # the one that has the focus
        assert not b.errors(), b.errors()


def fingers():
    """One moves a vertex; two zoom and turn the view, also where the first one has hit a vertex."""
    with Program(program, f"{folder}/dome.obj") as p, Browser(chromium) as b:
        b.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
        b.open(p.url)
        b.wait("window.taut && taut.state && taut.frames.length > 0")
        at_rest(b)
        v, at = pick(b, 0.5, 0.5)
        b.touch("touchStart", at)
        for k in range(1, 9):
            b.touch("touchMove", (at[0] + 4 * k, at[1]))
            time.sleep(0.02)
        b.touch("touchEnd")
        b.wait(f"taut.state.pins.size === 1 && taut.state.pins.has({v}) && taut.state.held && !taut.state.working")
        assert shown(b)[1] == 0

        def view(pane):
            return b.evaluate(f"[taut.{pane}.camera.zoom, ...taut.{pane}.camera.position.toArray()]")

        before, held = view("right"), shown(b)[2:]
        _, on = pick(b, 0.4, 0.6)
        b.two_fingers([on, (on[0] + 60, on[1])], [(on[0] - 40, on[1]), (on[0] + 120, on[1])])
        b.wait(f"taut.right.camera.zoom > {1.3 * before[0]}")
        at_rest(b)
        assert shown(b)[2:] == held  # no vertex went along
        x, y = b.evaluate("(() => { const r = taut.left.canvas.getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 2]; })()")
        before = view("left")
        b.two_fingers([(x - 30, y), (x + 30, y)], [(x - 20, y + 80), (x + 120, y + 80)])
        b.wait(f"taut.left.camera.zoom > {1.2 * before[0]}")
        after = view("left")
        assert max(abs(p - q) for p, q in zip(before[1:], after[1:])) > 0.1, "not turned"
        assert not b.errors(), b.errors()


def pasting(n):
    """A feature is placed, moved, turned, scaled, kept, put again, undone and saved."""
    file, onto = f"{folder}/dome.obj", (n // 2) * (n + 1) + n // 2
    options = ("--source", file, "--at", str(onto), "--radius", "0.3", "--onto", str(onto), "--scale", "0.5")
    with Program(program, file, *options) as p, Browser(chromium) as b:
        b.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=folder)
        b.open(p.url)
        b.wait("window.taut && taut.state && taut.frames.length > 0")
        positions = "Array.from(taut.state.positions)"
        first = b.evaluate(positions)

        def near(x, y):
            """A vertex of the surface near a place, and where it is on the page."""
            b.wait("taut.state")
            return b.evaluate(f"""(() => {{
              const p = taut.state.positions, r = taut.right.canvas.getBoundingClientRect();
              let best = 0, least = Infinity;
              for (let v = 0; 3 * v < p.length; ++v) {{
                const d = Math.hypot(p[3 * v] - {x}, p[3 * v + 1] - {y});
                if (d < least) {{ least = d; best = v; }}
              }}
              const s = taut.right.toScreen(best);
              return [s[0] + r.left, s[1] + r.top];
            }})()""")

        def middle():
            """Of the feature."""
            b.wait("taut.state")  # a new model comes with none
            return b.evaluate("""(() => {
              const s = [0, 0];
              if (!taut.state) return [9, 9];
              let n = 0;
              for (let c = 3 * taut.model.feature; c < taut.mesh.faces.length; ++c, ++n)
                for (let k = 0; k < 2; ++k) s[k] += taut.state.positions[3 * taut.mesh.faces[c] + k];
              return [s[0] / n, s[1] / n];
            })()""")

        def moved_from(place):
            """Where the feature is once it is elsewhere."""
            end = time.monotonic() + 60
            while max(abs(p - q) for p, q in zip(middle(), place)) < 0.01 and time.monotonic() < end:
                time.sleep(0.05)
            return middle()

        def grows(ids, check):
            for i in ids:
                b.evaluate("taut.frames.length = 0")
                click(b, i)
                b.wait("taut.frames.length > 0")
            assert b.evaluate(check), check

        grows(["turn-left", "turn-left"], "taut.state.pose.turn > 0.17")
        grows(["larger"], "taut.state.pose.scale > 0.52")
        b.evaluate("(() => { const s = document.getElementById('softness'); s.value = 1; s.oninput(); })()")
        b.wait("taut.state.pose.softness === 1")
        assert b.evaluate(positions) != first

        # By keyboard: to the right and back, and not from the bar.
        assert toolbar(b)[:2] == ["turn-left", "turn-right"]
        names(b)
        b.evaluate("document.getElementById('map').focus()")
        before = middle()
        b.key("ArrowRight", modifiers=8)
        b.wait("taut.state === null || taut.state.canUndo")
        right = moved_from(before)
        assert right[0] > before[0] + 0.02 and abs(right[1] - before[1]) < 0.05, (before, right)
        b.key("ArrowLeft", modifiers=8)
        left = moved_from(right)
        assert left[0] < right[0] - 0.02, (right, left)

        start, goal = middle(), (0.32, 0.32)
        b.drag(near(*start), near(*goal))
        end = time.monotonic() + 60
        while sum((p - q) ** 2 for p, q in zip(middle(), goal)) > 0.01 and time.monotonic() < end:
            time.sleep(0.05)
        assert sum((p - q) ** 2 for p, q in zip(middle(), goal)) < 0.01, "the feature did not go where it was put"
        b.screenshot(f"{folder}/paste.png")

        faces = b.evaluate("taut.mesh.faceCount")
        click(b, "keep")
        b.wait("taut.model.feature > taut.mesh.faceCount")
        x, y = near(0.7, 0.7)
        for count in (1, 2):
            for kind in ("mousePressed", "mouseReleased"):
                b.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=count)
        b.wait(f"taut.model.feature < taut.mesh.faceCount && taut.mesh.faceCount > {faces}")
        b.wait("taut.state")
        click(b, "save")
        saved, end = f"{folder}/dome-pasted.obj", time.monotonic() + 20
        while not os.path.exists(saved) and time.monotonic() < end:
            time.sleep(0.05)
        assert open(saved).read().count("\nf ") == b.evaluate("taut.mesh.faceCount")
        os.remove(saved)
        for _ in range(20):
            b.wait("taut.state")
            if not b.evaluate("taut.state.canUndo"):
                break
            b.evaluate("taut.frames.length = 0")
            click(b, "undo")
            b.wait("taut.state && taut.frames.length > 0")
        b.wait("taut.state && !taut.state.canUndo")
        assert b.evaluate(positions) == first
        assert not b.errors(), b.errors()


side = dome(f"{folder}/dome.obj")
visit(dark=False)
visit(dark=True)
keyboard()
fingers()
pasting(side)
print("page: all as it should be")
