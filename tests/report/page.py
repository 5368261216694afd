# SPDX-License-Identifier: MIT
"""page.py MAKE_REPORT FOLDER: the report of an atlas as a person with a browser meets it; screenshots stay in FOLDER. 77: no Chromium."""
import os
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "view"))
from browser import Browser, legible, names  # noqa: E402

chromium = shutil.which("chromium") or shutil.which("chromium-browser")
if not chromium:
    print("skipped: there is no chromium (scripts/setup --with-browser)")
    sys.exit(77)
make, folder = sys.argv[1], os.path.abspath(sys.argv[2])
os.makedirs(folder, exist_ok=True)

MIDDLE = """(pane, f) => {
  const r = pane.canvas.getBoundingClientRect(), c = Array.from(pane.mesh.faces.subarray(3 * f, 3 * f + 3), (v) => pane.toScreen(v));
  return [r.left + (c[0][0] + c[1][0] + c[2][0]) / 3, r.top + (c[0][1] + c[1][1] + c[2][1]) / 3];
}"""


def page(name, *numbers):
    path = f"{folder}/{name}.html"
    with open(path, "wb") as f:
        subprocess.run([make, *map(str, numbers)], stdout=f, check=True)
    return path


def hover(b, x, y):
    b.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, buttons=0)


def middle(b, pane, face):
    """Where a face is on the page, in pane 0 (model) or 1 (atlas)."""
    return b.evaluate(f"({MIDDLE})(report.panes[{pane}], {face})")


def ready(b, path):
    b.open(f"file://{path}")
    b.wait("window.report && report.panes.length === 2")


def chosen(b):
    return b.evaluate("Array.from(report.chosen).map((x, f) => [f, x]).filter(([, x]) => x > 0)")


def texture(b, dark):
    """A texture of the user's is on both sides: red below v = 1/2, green above."""
    b.evaluate("""(async () => {
      const c = new OffscreenCanvas(8, 8), g = c.getContext('2d');
      for (const [y, colour] of [[0, '#00ff00'], [4, '#ff0000']]) { g.fillStyle = colour; g.fillRect(0, y, 8, 4); }
      await report.take(new File([await c.convertToBlob()], 'mine.png', { type: 'image/png' }));
      globalThis.taken = true;
    })(), 0""")
    b.wait("globalThis.taken")
    assert b.evaluate("document.querySelector('[data-colours=texture]').getAttribute('aria-checked')") == "true"
    assert "mine.png: 8 x 8 texels" in b.evaluate("document.getElementById('told').textContent")
    b.screenshot(f"{folder}/texture-{'dark' if dark else 'light'}.png")
    colour = """(k, f) => {
      const pane = report.panes[k], gl = pane.renderer.getContext(), r = pane.canvas.getBoundingClientRect(), texel = new Uint8Array(4);
      pane.renderer.render(pane.scene, pane.camera);
      const [x, y] = (%s)(pane, f), s = pane.renderer.getPixelRatio();
      gl.readPixels(Math.round((x - r.left) * s), Math.round((r.bottom - y) * s), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, texel);
      const v = [0, 1, 2].map((i) => report.flat[2 * report.atlas.faces[3 * f + i] + 1]);
      return [v, Array.from(texel)];
    }""" % MIDDLE
    seen = set()
    b.evaluate("report.hovered = -1, report.choose()")  # no marks
    for f in range(0, 12 * 12 * 12, 7):
        v, texel = b.evaluate(f"({colour})(1, {f})")
        if max(v) < 0.45 or min(v) > 0.55:
            assert (texel[0] > texel[1]) == (max(v) < 0.45), (f, v, texel)
            seen.add(max(v) < 0.45)
    assert seen == {True, False}
    front = b.evaluate("(() => { const p = report.panes[0], r = p.canvas.getBoundingClientRect(); return p.faceAt([r.width / 2 - 40, r.height / 2 - 30]); })()")
    v, texel = b.evaluate(f"({colour})(0, {front})")
    assert max(v) > 0.45 and min(v) < 0.55 or (texel[0] > texel[1]) == (max(v) < 0.45), (v, texel)
    b.key("d")


def visit(dark):
    n = 12
    path = page("sphere", n, 60000, 1)
    with Browser(chromium, size=(1280, 1000), dark=dark) as b:
        ready(b, path)
        faces = 12 * n * n
        assert b.evaluate("[report.chart.length, report.model.vertexCount, report.atlas.vertexCount]") == \
            [faces + 2, 6 * n * n + 2 + 6, 6 * (n + 1) ** 2 + 6]
        assert b.evaluate("document.title").startswith("sphere </script>") and b.evaluate("document.getElementById('simplified').hidden")
        assert "out <b>.obj" in b.evaluate("document.querySelector('#command pre').textContent")
        assert b.evaluate("document.querySelector('#repairs li').textContent").startswith("1 triangle (12)")
        shown = b.evaluate("Array.from(document.querySelectorAll('#numbers div'), (d) => d.textContent)")
        assert "charts7" in shown and "overlaps0" in shown, shown

        # A face in one view is the same in the other.
        front = b.evaluate("(() => { const p = report.panes[0], r = p.canvas.getBoundingClientRect(); return p.faceAt([r.width / 2 - 40, r.height / 2 - 30]); })()")
        assert front >= 0
        hover(b, *middle(b, 0, front))
        b.wait(f"report.hovered === {front}")
        assert f"triangle {front}," in b.evaluate("document.getElementById('told').textContent")
        other = 12 * n * n // 3 + 5
        hover(b, *middle(b, 1, other))
        b.wait(f"report.hovered === {other}")
        marked = dict(chosen(b))
        chart = b.evaluate(f"report.chart[{other}]")
        assert marked[other] == max(marked.values()) and len(marked) == 2 * n * n
        assert all(b.evaluate(f"report.chart[{f}]") == chart for f in list(marked)[:5])
        b.screenshot(f"{folder}/hover-{'dark' if dark else 'light'}.png")

        # A click selects, and the table shows which.
        x, y = middle(b, 1, other)
        b.drag((x, y), (x, y), steps=1)
        b.wait(f"report.selected === {chart}")
        selected = "document.querySelector('#charts [aria-selected=\"true\"]')"
        assert b.evaluate(f"{selected}.dataset.chart") == str(chart)

        # The table sorts, and a row frames its chart in both views.
        order = "Array.from(document.querySelectorAll('#charts tbody tr'), (r) => Number(r.dataset.chart))"
        assert b.evaluate(order)[-1] == 6, "the smallest area comes last"
        click = lambda k: b.evaluate(f"document.querySelectorAll('#charts th button')[{k}].click()")
        click(0)
        assert b.evaluate(order) == [6, 5, 4, 3, 2, 1, 0]
        click(0)
        assert b.evaluate(order) == [0, 1, 2, 3, 4, 5, 6]
        click(5)  # iterations, of which chart 6 has none
        assert b.evaluate(order) == [5, 4, 3, 2, 1, 0, 6]
        assert b.evaluate("document.querySelectorAll('#charts th')[5].getAttribute('aria-sort')") == "descending"
        whole = b.evaluate("report.panes[1].camera.right - report.panes[1].camera.left")
        b.evaluate("document.querySelector('#charts tr[data-chart=\"6\"]').click()")
        b.wait("report.selected === 6")
        assert b.evaluate("report.panes[1].camera.right - report.panes[1].camera.left") < 0.4 * whole
        last = b.evaluate("report.chart.indexOf(6)")
        for pane in (0, 1):
            x, y = middle(b, pane, last)
            r = b.evaluate(f"(() => {{ const r = report.panes[{pane}].canvas.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]; }})()")
            assert r[0] < x < r[2] and r[1] < y < r[3], (pane, x, y, r)

        # By keyboard: the next row, the views, the colours, and back.
        b.evaluate("document.querySelector('#charts tr[data-chart=\"6\"]').focus()")
        b.key("ArrowUp")
        b.wait("report.selected === 0")
        b.evaluate("report.panes[0].canvas.focus()")
        before = b.evaluate("report.panes[0].camera.position.toArray()")
        b.key("ArrowRight")
        assert b.evaluate("report.panes[0].camera.position.toArray()") != before
        b.evaluate("report.panes[1].canvas.focus()")
        before = b.evaluate("[report.panes[1].camera.zoom, report.panes[1].camera.position.x]")
        b.key("+")
        b.key("ArrowLeft")
        after = b.evaluate("[report.panes[1].camera.zoom, report.panes[1].camera.position.x]")
        assert after[0] > before[0] and after[1] < before[1]
        for key, colours in (("c", "charts"), ("k", "checks"), ("d", "heat")):
            b.key(key)
            assert b.evaluate(f"document.querySelector('[data-colours={colours}]').getAttribute('aria-checked')") == "true"
            if key != "d":
                b.evaluate("report.showAll()")
                b.screenshot(f"{folder}/{colours}-{'dark' if dark else 'light'}.png")
        b.key("Escape")
        b.wait("report.selected === -1")
        texture(b, dark)
        names(b)
        legible(b)

        # The histogram is of all area, and a bar shows its faces.
        parts = b.evaluate("report.data.histogram.parts")
        assert abs(sum(parts) - 1) < 1e-9
        k = max(range(len(parts)), key=parts.__getitem__)
        b.evaluate(f"document.querySelectorAll('#histogram rect')[{k}].focus()")
        least, most = b.evaluate("[report.data.histogram.least, report.data.histogram.most]")
        bound = lambda i: 4 * (1 + least * (most / least) ** (i / 40))
        low, high = 0 if k == 0 else bound(k - 1), bound(k) if k <= 40 else float("inf")
        energies = b.evaluate("Array.from(report.energy)")
        expected = [f for f, e in enumerate(energies) if e is not None and low <= e < high]
        assert [f for f, _ in chosen(b)] == expected and expected
        b.evaluate("document.querySelector('#parts').scrollIntoView()")
        b.screenshot(f"{folder}/parts-{'dark' if dark else 'light'}.png")
        assert not b.errors(), b.errors()
        assert b.evaluate("performance.getEntriesByType('resource').length") == 0, "a report needs nothing but itself"


def large():
    """A model and a table beyond what is drawn: the views are simpler, the numbers are not."""
    n = 130
    path = page("large", n, 20000, 1200)
    assert os.path.getsize(path) < 4_000_000
    with Browser(chromium, size=(1280, 1000)) as b:
        ready(b, path)
        shown = b.evaluate("report.chart.length")
        assert 10000 < shown <= 20000
        note = b.evaluate("document.getElementById('simplified').textContent")
        assert f"{shown:,} of {12 * n * n + 1201:,}" in note, note
        assert b.evaluate("report.data.columns[0].values") == [2 * n * n] * 6 + [1] * 1200
        # The table lists what comes first, more on demand, and what is selected.
        rows = "document.querySelectorAll('#charts tbody tr').length"
        assert b.evaluate(rows) == 500 and "500 of 1,206" in b.evaluate("document.querySelector('.more').textContent")
        b.evaluate("report.select(1205, true)")
        assert b.evaluate("document.querySelector('#charts [aria-selected=\"true\"]').dataset.chart") == "1205" and b.evaluate(rows) == 501
        for many in (1000, 1206):
            b.evaluate("document.querySelector('.more').click()")
            assert b.evaluate(rows) == many
        assert b.evaluate("document.querySelector('.more').hidden")
        b.evaluate("report.showAll()")
        b.key("c")
        b.screenshot(f"{folder}/large.png")
        assert not b.errors(), b.errors()
    with open(path, "rb") as f, open(page("again", n, 20000, 1200), "rb") as again:
        assert f.read() == again.read()


visit(dark=False)
visit(dark=True)
large()
print("report: all as it should be")
