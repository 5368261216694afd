// SPDX-License-Identifier: MIT
// Pictures of numbers.
import { plain } from './table.js';

const make = (parent, name, attributes = {}, text = '') => {
  const one = parent.appendChild(document.createElementNS('http://www.w3.org/2000/svg', name));
  for (const [key, value] of Object.entries(attributes)) one.setAttribute(key, value);
  if (text) one.textContent = text;
  return one;
};

/** The colours of the panes, over the colour of the surface. */
const heat = (energy) => {
  const t = Math.min(1, Math.log(Math.max(energy / 4 - 1, 1e-3) / 1e-3) / Math.log(4000));
  const warm = t < 0.35 ? 0 : Math.min(1, (t - 0.35) / 0.65), amount = Math.min(1, t / 0.35);
  const mix = (a, b) => Math.round(255 * (a + (b - a) * warm));
  return `color-mix(in srgb, rgb(${mix(0.96, 0.8)} ${mix(0.8, 0.16)} ${mix(0.35, 0.18)}) ${Math.round(100 * amount)}%, var(--surface))`;
};

/** Parts of the area by energy, by the logarithm of energy / 4 - 1. over(from, to): a bar is pointed at; leave(): no longer. */
export function drawHistogram(place, { least, most, parts }, over, leave) {
  const width = 460, height = 170, left = 44, bottom = 36, steps = parts.length - 2; // between the first, below, and the last, beyond
  const svg = make(place, 'svg', { viewBox: `0 0 ${width} ${height + bottom}`, role: 'group', 'aria-label': 'Parts of the area by energy' });
  const step = (width - left) / (steps + 4), highest = Math.max(...parts, 1e-12);
  const energy = (k) => 4 * (1 + least * (most / least) ** (k / steps));
  const x = (k) => left + (k === 0 ? 0 : k <= steps ? k + 1 : steps + 3) * step;
  for (const part of [0, 0.5, 1]) {
    const y = height * (1 - part * 0.94);
    make(svg, 'line', { x1: left, x2: width, y1: y, y2: y, class: 'axis' });
    make(svg, 'text', { x: left - 4, y: y + 4, 'text-anchor': 'end' }, `${Number((100 * part * highest).toPrecision(2))} %`);
  }
  parts.forEach((part, k) => {
    const from = k === 0 ? 4 : energy(k - 1), to = k > steps ? Infinity : energy(k), tall = part > 0 ? Math.max(1, (part / highest) * height * 0.94) : 0;
    const bar = make(svg, 'rect', {
      x: x(k), y: height - tall, width: step - 1, height: tall, tabindex: part > 0 ? 0 : -1, role: 'img',
      'aria-label': `energy ${plain(from)} ${k <= steps ? `to ${plain(to)}` : 'or more'}: ${plain(100 * part)} % of the area`,
    });
    bar.style.fill = heat(k === 0 ? 4 : Math.sqrt((from - 4) * (Math.min(to, 1000) - 4)) + 4);
    make(bar, 'title', {}, bar.getAttribute('aria-label'));
    const begin = k === 0 ? 0 : from; // what rounding has below 4
    for (const event of ['pointerenter', 'focus']) bar.addEventListener(event, () => over(begin, to));
    for (const event of ['pointerleave', 'blur']) bar.addEventListener(event, leave);
  });
  for (const tick of [4.001, 4.01, 4.1, 4.4, 5, 8, 20]) {
    const at = (Math.log((tick / 4 - 1) / least) / Math.log(most / least)) * steps;
    if (at >= 0 && at <= steps) make(svg, 'text', { x: left + (at + 2) * step, y: height + 15, 'text-anchor': 'middle' }, `${tick}`);
  }
  make(svg, 'text', { x: left, y: height + 15 }, '4');
  make(svg, 'text', { x: width, y: height + 15, 'text-anchor': 'end' }, `≥ ${plain(energy(steps))}`);
  make(svg, 'text', { x: (left + width) / 2, y: height + 31, 'text-anchor': 'middle' }, 'isometric energy, by the logarithm of its excess over 4');
}

/** Seconds of stages as bars, and the energy after each as a line where there are several. */
export function drawStages(section, place, stages) {
  const body = section.querySelector('tbody'), longest = Math.max(...stages.map((s) => s.seconds), 1e-12);
  for (const s of stages) {
    const row = body.appendChild(document.createElement('tr'));
    const cell = (text, name = '') => {
      const one = row.appendChild(document.createElement('td'));
      one.className = name;
      one.textContent = text;
      return one;
    };
    cell(s.name);
    cell(plain(s.seconds));
    cell('', 'bar').appendChild(document.createElement('div')).style.width = `${(100 * s.seconds) / longest}%`;
    cell(plain(s.energy));
  }
  const known = stages.filter((s) => s.energy !== null);
  if (known.length < 2) return;
  const width = 460, height = 110, left = 40, bottom = 18, last = known.length - 1;
  const svg = make(place, 'svg', { viewBox: `0 0 ${width} ${height + bottom}`, role: 'img', 'aria-label': 'Energy after each stage' });
  const low = Math.min(...known.map((s) => s.energy)), high = Math.max(...known.map((s) => s.energy));
  const x = (k) => left + 30 + ((width - left - 60) * k) / last;
  const y = (e) => 10 + (height - 20) * (high > low ? (high - e) / (high - low) : 0.5);
  for (const e of high > low ? [low, high] : [low]) {
    make(svg, 'line', { x1: left, x2: width, y1: y(e), y2: y(e), class: 'axis' });
    make(svg, 'text', { x: left - 4, y: y(e) + 4, 'text-anchor': 'end' }, plain(e));
  }
  make(svg, 'polyline', { points: known.map((s, k) => `${x(k)},${y(s.energy)}`).join(' ') });
  known.forEach((s, k) => {
    make(make(svg, 'circle', { cx: x(k), cy: y(s.energy), r: 4 }), 'title', {}, `${s.name}: ${plain(s.energy)}`);
    make(svg, 'text', { x: x(k), y: height + 12, 'text-anchor': 'middle' }, s.name);
  });
}
