// SPDX-License-Identifier: MIT
// A toolbar as WAI-ARIA describes it: one stop of the Tab key, and arrow keys, Home and End go from button to button.

/** Returns a function to call after buttons of the bar were shown, hidden, switched on or off. */
export function rove(bar) {
  const buttons = [...bar.querySelectorAll('button')];
  const usable = (b) => !b.disabled && !b.closest('[hidden]');
  let current = null, inside = false; // what Tab leads to; whether it has the focus
  const choose = (button) => {
    current = button;
    for (const b of buttons) b.tabIndex = b === button ? 0 : -1;
  };
  document.addEventListener('focusin', (e) => {
    inside = bar.contains(e.target);
    if (inside) choose(e.target);
  });
  bar.addEventListener('focusout', () => { inside = false; });
  // A pointer leaves the keyboard where it is: arrow keys still move what they moved.
  bar.addEventListener('mousedown', (e) => e.preventDefault());
  bar.addEventListener('keydown', (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const list = buttons.filter(usable), at = list.indexOf(e.target), last = list.length - 1;
    const to = { ArrowLeft: at > 0 ? at - 1 : last, ArrowRight: at < last ? at + 1 : 0, Home: 0, End: last, ArrowUp: at, ArrowDown: at }[e.key];
    if (at < 0 || to === undefined) return;
    e.preventDefault();
    e.stopPropagation();
    list[to].focus();
  });
  return () => {
    if (current && usable(current)) return;
    const at = buttons.indexOf(current), held = inside; // a button that is switched off loses it
    const next = buttons.slice(at + 1).find(usable) ?? buttons.slice(0, Math.max(at, 0)).findLast(usable);
    if (!next) return;
    choose(next);
    if (held) next.focus();
  };
}
