// SPDX-License-Identifier: MIT
// What keys do; docs/howto/view.md has the table.
import * as messages from './messages.js';

const click = (id) => () => document.getElementById(id).click();

/** A part of what is seen, ten parts with Shift. */
const step = (e) => (e.shiftKey ? 10 : 1);

const arrows = (f) => ({
  ArrowLeft: (e) => f(0, -1, e), ArrowRight: (e) => f(0, 1, e), ArrowUp: (e) => f(1, 1, e), ArrowDown: (e) => f(1, -1, e),
});

function toggleWires(page) {
  for (const p of page.panes()) {
    p.edges = !p.edges;
    p.draw();
  }
}

function nextPin(page, way) {
  const pins = [...page.state.pins.keys()];
  if (pins.length === 0) return;
  const at = pins.indexOf(page.current);
  page.current = pins[(at + way + pins.length + (at < 0 && way < 0 ? 1 : 0)) % pins.length];
  page.note(`vertex ${page.current}`);
  page.mark();
}

/** The current pin, by a two-hundredth of the map, with Shift a twentieth. */
function nudge(page, axis, sign, e) {
  const pin = page.state.pins.get(page.current);
  if (!pin) return page.note('no current pin: [ and ] go from one to the next');
  const x = pin.x.map((value, k) => ((pin.held >> k) & 1 ? value : page.position(page.current)[k] ?? 0));
  x[axis] += (sign * page.right.extent * step(e)) / 200;
  page.pin(page.current, x);
}

/** Zooms the view that has the focus, or all. */
function zoom(page, e, factor) {
  const panes = page.panes(), focused = panes.filter((p) => p.canvas === e.target);
  for (const p of focused.length > 0 ? focused : panes) p.zoom(factor);
}

/** Turns the view in space. */
function turn(page, angle) {
  for (const p of page.panes()) if (!p.flat) p.turn(angle, 0);
}

export function listenToKeys(page) {
  const all = {
    w: () => toggleWires(page),
    ',': () => turn(page, -0.15), '.': () => turn(page, 0.15),
    PageUp: (e) => zoom(page, e, 1.2), PageDown: (e) => zoom(page, e, 1 / 1.2),
  };
  const pasting = {
    ...all, q: click('turn-left'), e: click('turn-right'), '-': click('smaller'), '+': click('larger'), '=': click('larger'), Enter: click('keep'),
    ...arrows((axis, sign, e) => page.move(...[axis === 0, axis === 1].map((along) => (along ? (sign * step(e)) / 100 : 0)))),
  };
  const mapping = {
    ...all, t: click('texture'),
    d: () => page.choose('drag'), s: () => page.choose('region'), l: () => page.choose('path'), n: () => page.relax(true),
    f: () => page.toggleFocus(), u: () => page.straighten(0), v: () => page.straighten(1), ' ': () => page.relax(),
    Delete: () => page.unpin(), Backspace: () => page.unpin(), Escape: () => { page.region.clear(); page.line = []; page.mark(); },
    '[': () => nextPin(page, -1), ']': () => nextPin(page, 1),
    ...arrows((axis, sign, e) => nudge(page, axis, sign, e)),
  };
  addEventListener('keydown', (e) => {
    if (!page.state) return;
    if (e.ctrlKey || e.metaKey) {
      const key = e.key.toLowerCase();
      if (key === 'z') page.send(e.shiftKey ? messages.redo() : messages.undo());
      else if (key === 'y') page.send(messages.redo());
      else if (key === 's') page.send(messages.save());
      else return;
      return e.preventDefault();
    }
    if ((e.key === ' ' || e.key === 'Enter') && e.target instanceof HTMLButtonElement) return; // presses it
    if (e.target instanceof HTMLInputElement && /^(Arrow|Page|Home|End)/.test(e.key)) return; // moves it
    const f = (page.tool === 'place' ? pasting : mapping)[e.key];
    if (!f) return;
    e.preventDefault();
    f(e);
  });
  addEventListener('keyup', (e) => { if (e.key.startsWith('Arrow')) ++page.gesture; });
}
