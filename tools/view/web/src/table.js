// SPDX-License-Identifier: MIT
// The charts in numbers, in any order.

/** A number as people read it; a dash for what is not known. */
export const plain = (x) => {
  if (x === null || !Number.isFinite(x)) return '–';
  return Number.isInteger(x) ? x.toLocaleString('en') : Number(x.toPrecision(4)).toLocaleString('en', { maximumFractionDigits: 6 });
};

/** The colour that the panes have for a chart. */
const colourOf = (c) => {
  const hue = (0.618034 * c) % 1;
  const part = (shift) => Math.round(255 * (0.66 + 0.24 * Math.cos(2 * Math.PI * (hue + shift))));
  return `rgb(${part(0)} ${part(0.67)} ${part(0.33)})`;
};

const most = 500; // rows at first, and more each time that more are asked for

export class ChartTable {
  #rows = new Map(); // by chart, as they are needed
  #order = []; // charts
  #shown = most;
  #body;
  #more;
  #columns;
  #pick;

  /** pick(c): a row was chosen. */
  constructor(section, columns, pick) {
    this.#columns = [{ name: 'chart', values: Array.from(columns[0].values, (_, c) => c) }, ...columns];
    this.#pick = pick;
    this.#body = section.querySelector('tbody');
    const head = section.querySelector('thead tr');
    this.#columns.forEach((column, k) => {
      const cell = head.appendChild(document.createElement('th'));
      cell.scope = 'col';
      const button = cell.appendChild(document.createElement('button'));
      button.textContent = column.name === 'area' ? 'area %' : column.name;
      button.onclick = () => this.sort(k, cell.getAttribute('aria-sort') === 'descending' ? 1 : -1);
    });
    this.#more = section.appendChild(document.createElement('button'));
    this.#more.className = 'more';
    this.#more.onclick = () => { this.#shown += most; this.#fill(); };
    this.#body.onclick = (e) => this.#take(e.target.closest('tr'));
    this.#body.onkeydown = (e) => this.#move(e);
    this.sort(Math.max(0, this.#columns.findIndex((column) => column.name === 'area')), -1);
  }

  /** By a column; 1: the smallest first, -1: the largest. What is not known comes last. */
  sort(k, direction) {
    const { values } = this.#columns[k];
    this.#order = Array.from(values.keys()).sort((a, b) => {
      if (values[a] === values[b]) return a - b;
      if (values[a] === null) return 1;
      if (values[b] === null) return -1;
      return direction * (values[a] - values[b]);
    });
    this.#body.parentElement.querySelectorAll('th').forEach((cell, i) => {
      if (i === k) cell.setAttribute('aria-sort', direction > 0 ? 'ascending' : 'descending');
      else cell.removeAttribute('aria-sort');
    });
    this.#shown = most;
    this.#fill();
  }

  /** Marks the row of a chart, or none for -1. */
  mark(c, scrolled) {
    const before = this.#body.querySelector('[aria-selected="true"]');
    before?.setAttribute('aria-selected', 'false');
    if (c < 0) return;
    const row = this.#row(c);
    if (!row.isConnected) this.#body.prepend(row);
    for (const other of this.#body.querySelectorAll('[tabindex="0"]')) other.tabIndex = -1;
    row.tabIndex = 0;
    row.setAttribute('aria-selected', 'true');
    if (!scrolled) return;
    const box = this.#body.closest('.scroll'); // not the page
    box.scrollTop = row.offsetTop - box.clientHeight / 2;
  }

  #fill() {
    this.#body.replaceChildren(...this.#order.slice(0, this.#shown).map((c) => this.#row(c)));
    for (const row of this.#rows.values()) row.tabIndex = -1;
    const reached = this.#body.querySelector('[aria-selected="true"]') ?? this.#body.firstElementChild;
    if (reached) reached.tabIndex = 0;
    this.#more.hidden = this.#order.length <= this.#shown;
    this.#more.textContent = `More (${plain(Math.min(this.#shown, this.#order.length))} of ${plain(this.#order.length)} are listed)`;
  }

  #row(c) {
    if (this.#rows.has(c)) return this.#rows.get(c);
    const row = document.createElement('tr');
    row.dataset.chart = c;
    this.#columns.forEach((column, k) => {
      const cell = row.appendChild(document.createElement('td'));
      if (k === 0) {
        const swatch = cell.appendChild(document.createElement('span'));
        swatch.className = 'swatch';
        swatch.style.background = colourOf(c);
      }
      cell.append(plain(column.values[c]));
    });
    row.tabIndex = -1;
    row.setAttribute('aria-selected', 'false');
    this.#rows.set(c, row);
    return row;
  }

  describe(c) {
    return this.#columns.slice(1, 5).map((column) => `${column.name} ${plain(column.values[c])}${column.name === 'area' ? ' %' : ''}`).join(', ');
  }

  #take(row) {
    if (!row) return;
    row.focus();
    this.#pick(Number(row.dataset.chart));
  }

  #move(e) {
    const row = e.target.closest('tr');
    const to = {
      ArrowDown: row.nextElementSibling, ArrowUp: row.previousElementSibling, Home: this.#body.firstElementChild, End: this.#body.lastElementChild,
      Enter: row, ' ': row,
    }[e.key];
    if (!to) return;
    e.preventDefault();
    this.#take(to);
  }
}
