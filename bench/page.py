#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""page.py TAUT MESH [SECONDS [PINS]]: pictures a second of the page of `taut view` in a headless Chromium, while PINS vertices (1) are led along
circles of a twentieth of the map: those that the browser shows, and those with another state. Milliseconds between the latter: median, 95 %, most.
Load of the machine at the end. PINS is 16 at most: each is a message a picture, and the program takes 1000 a second."""
import os
import pathlib
import shutil
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "view"))
from browser import Browser  # noqa: E402
from client import Program  # noqa: E402

DRAG = """new Promise((done) => {
  const x = taut.state.positions, n = taut.mesh.vertexCount, chosen = [];
  for (let k = 1; k <= %(pins)d; ++k) chosen.push(Math.floor((k * n) / (%(pins)d + 1)));
  let low = Infinity, high = -Infinity;
  for (let v = 0; v < n; ++v) { low = Math.min(low, x[2 * v]); high = Math.max(high, x[2 * v]); }
  const radius = (high - low) / 20, start = performance.now(), pictures = [], states = [];
  const at = chosen.map((v) => [x[2 * v], x[2 * v + 1]]);
  let last = taut.state;
  const step = (now) => {
    pictures.push(now);
    if (taut.state !== last) { last = taut.state; states.push(now); }
    const a = ((now - start) / 2000) * Math.PI;
    chosen.forEach((v, k) => taut.pin(v, [at[k][0] + radius * Math.sin(a), at[k][1] + radius * (1 - Math.cos(a)), 0]));
    if (now - start < 1000 * %(seconds)f) requestAnimationFrame(step);
    else done([pictures, states]);
  };
  requestAnimationFrame(step);
})"""


def main():
    program, mesh = sys.argv[1:3]
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 10
    pins = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    if not 1 <= pins <= 16:
        sys.exit("PINS: 1 to 16")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    with Program(program, mesh) as p, Browser(chromium) as b:
        b.open(p.url)
        b.wait("window.taut && taut.state && taut.frames.length > 0 && !taut.state.working")
        pictures, states = b.evaluate(DRAG % {"pins": pins, "seconds": seconds})
        gaps = sorted(b - a for a, b in zip(states, states[1:]))
        print(f"{pathlib.Path(mesh).name}, {pins} pins: {len(pictures) / seconds:.1f} pictures a second, {len(states) / seconds:.1f} with another state; "
              f"median {statistics.median(gaps):.0f}, 95 % {gaps[int(0.95 * len(gaps))]:.0f}, most {gaps[-1]:.0f} ms between these; "
              f"{b.evaluate('taut.state.flipped')} flipped; load {os.getloadavg()[0]:.1f}")


main()
