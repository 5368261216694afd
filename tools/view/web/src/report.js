// SPDX-License-Identifier: MIT
// The report of an atlas: model and atlas linked, and what is to be known of both.
import { drawHistogram, drawStages } from './charts.js';
import { ChartTable, plain } from './table.js';

const { BufferAttribute, BufferGeometry, GreaterDepth, LineBasicMaterial, LineSegments, Mesh, Pane, Vector3 } = scene;

const element = (id) => document.getElementById(id);

const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
const keys = { d: 'heat', c: 'charts', k: 'checks', t: 'texture' };

class Report {
  selected = -1; // chart
  hovered = -1; // face

  constructor(data) {
    this.data = data;
    const flat = new Float32Array(bytes(data.places)), places = new Float32Array((flat.length / 2) * 3);
    for (let i = 0; i < flat.length / 2; ++i) places.set([flat[2 * i], flat[2 * i + 1]], 3 * i);
    this.flat = flat;
    this.model = new Mesh(new Float32Array(bytes(data.points)), new Uint32Array(bytes(data.cells)));
    this.atlas = new Mesh(places, new Uint32Array(bytes(data.images)));
    this.origins = new Int32Array(bytes(data.origins));
    this.chart = new Int32Array(bytes(data.charts));
    this.energy = new Float32Array(bytes(data.energies));
    this.chosen = new Float32Array(this.chart.length);
    this.#write();
    this.table = new ChartTable(element('charts'), data.columns, (c) => this.select(c, true));
    const inside = (from, to) => this.choose((f) => this.chart[f] >= 0 && this.energy[f] >= from && this.energy[f] < to);
    drawHistogram(element('histogram'), data.histogram, inside, () => this.choose());
    drawStages(element('stages'), element('convergence'), data.stages);
    try {
      this.panes = [this.#pane('model', this.model, false), this.#pane('atlas', this.atlas, true)];
      this.#drawLines();
    } catch (e) {
      this.panes = [];
      for (const section of document.querySelectorAll('main section')) {
        section.className = 'missing';
        section.textContent = 'This browser does not draw in 3D (WebGL).';
      }
    }
    this.#listen();
    this.colour('heat');
  }

  #write() {
    const { title, numbers, repairs, command, triangles } = this.data;
    document.title = `${title} - atlas`;
    element('title').textContent = title;
    for (const [name, value] of numbers) {
      const one = element('numbers').appendChild(document.createElement('div'));
      one.appendChild(document.createElement('dt')).textContent = name;
      one.appendChild(document.createElement('dd')).textContent = value;
    }
    const list = element('repairs').querySelector('ul');
    for (const text of repairs.length > 0 ? repairs : ['Nothing had to be mended.']) list.appendChild(document.createElement('li')).textContent = text;
    element('command').querySelector('pre').textContent = command;
    const shown = this.chart.length;
    element('simplified').hidden = shown === triangles;
    element('simplified').textContent = `The views show ${plain(shown)} of ${plain(triangles)} triangles, whose vertices were moved together; ` +
      'numbers, table and histogram are of all of them.';
  }

  #pane(id, mesh, flat) {
    const pane = new Pane(element(id), { flat });
    pane.setMesh(mesh);
    pane.edges = false;
    pane.setPositions(mesh.points, 3);
    pane.setFaces('value', this.energy);
    pane.setFaces('label', this.chart);
    pane.setUv(this.flat, 0, this.atlas.faces);
    pane.fit();
    return pane;
  }

  /** Seams in both panes, and the tiles of the atlas. */
  #drawLines() {
    const count = new Map(), n = this.atlas.vertexCount, { faces } = this.atlas;
    const key = (a, b) => Math.min(a, b) * n + Math.max(a, b);
    const sides = (f) => { for (let i = 0; i < faces.length; ++i) f(i, i % 3 === 2 ? i - 2 : i + 1); };
    sides((i, j) => { const k = key(faces[i], faces[j]); count.set(k, (count.get(k) ?? 0) + 1); });
    const ends = [];
    sides((i, j) => { if (count.get(key(faces[i], faces[j])) === 1) ends.push(i, j); });
    this.lines = this.panes.map((pane) => {
      const shape = new BufferGeometry();
      shape.setAttribute('position', pane.wires.geometry.getAttribute('position'));
      shape.setIndex(ends.map((i) => pane.mesh.faces[i]));
      // What is behind the model is drawn, too, fainter.
      const hidden = { transparent: true, opacity: 0.3, depthFunc: GreaterDepth, depthWrite: false };
      return (pane.flat ? [{}] : [{}, hidden]).map((style) => {
        const lines = new LineSegments(shape, new LineBasicMaterial(style));
        lines.frustumCulled = false;
        pane.scene.add(lines);
        return lines;
      });
    });
    const tiles = new Set(), corners = [];
    for (let i = 0; i < this.flat.length; i += 2)
      if (Number.isFinite(this.flat[i])) tiles.add(`${Math.ceil(this.flat[i] - 1e-6) - 1},${Math.ceil(this.flat[i + 1] - 1e-6) - 1}`);
    for (const tile of tiles) {
      const [x, y] = tile.split(',').map((k) => Math.max(0, Number(k)));
      for (const [a, b] of [[0, 0], [1, 0], [1, 0], [1, 1], [1, 1], [0, 1], [0, 1], [0, 0]]) corners.push(x + a, y + b, 0);
      this.panes[1].frame.push(new Vector3(x, y, 0), new Vector3(x + 1, y + 1, 0));
    }
    const shape = new BufferGeometry();
    shape.setAttribute('position', new BufferAttribute(Float32Array.from(corners), 3));
    this.tiles = new LineSegments(shape, new LineBasicMaterial());
    this.tiles.frustumCulled = false;
    this.panes[1].scene.add(this.tiles);
    this.panes[1].fit();
    this.#applyTheme();
  }

  #applyTheme() {
    const style = getComputedStyle(document.documentElement);
    for (const pane of this.panes) pane.applyTheme();
    for (const lines of this.lines?.flat() ?? []) lines.material.color.set(style.getPropertyValue('--seam').trim());
    this.tiles?.material.color.set(style.getPropertyValue('--quiet').trim());
  }

  /** What colours say: 'heat', 'charts', 'checks', or 'texture', for which an image is asked for where there is none. */
  colour(by) {
    if (by === 'texture' && !this.image) return element('image').click();
    for (const b of document.querySelectorAll('[data-colours]')) {
      b.setAttribute('aria-checked', String(b.dataset.colours === by));
      b.tabIndex = b.dataset.colours === by ? 0 : -1;
    }
    for (const pane of this.panes) {
      const { uniforms } = pane.material;
      uniforms.heat.value = by === 'heat' ? 1 : 0;
      uniforms.labels.value = by === 'charts' ? 1 : 0;
      uniforms.checks.value = by === 'checks' ? 32 : 0;
      uniforms.textured.value = by === 'texture' ? 1 : 0;
      pane.draw();
    }
  }

  /** The user's texture, of a file. */
  async take(file) {
    try {
      this.image = await createImageBitmap(file, { imageOrientation: 'flipY', premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
    } catch (e) {
      element('told').textContent = `${file.name}: no image that this browser reads; give a PNG, JPEG or WebP`;
      return;
    }
    for (const pane of this.panes) pane.setImage(this.image);
    this.colour('texture');
    element('told').textContent = `${file.name}: ${this.image.width} x ${this.image.height} texels`;
  }

  /** Marks faces; without an argument those that hovering and selecting ask for. */
  choose(has = null) {
    const over = this.hovered >= 0 ? this.chart[this.hovered] : -1;
    for (let f = 0; f < this.chosen.length; ++f)
      this.chosen[f] = has ? (has(f) ? 1 : 0)
        : f === this.hovered ? 1.6 : this.chart[f] < 0 ? 0 : this.chart[f] === this.selected ? 0.7 : this.chart[f] === over ? 0.4 : 0;
    for (const pane of this.panes) pane.setFaces('chosen', this.chosen);
  }

  hover(f) {
    if (f === this.hovered) return;
    this.hovered = f;
    this.choose();
    this.#tell();
  }

  #tell() {
    const f = this.hovered, c = f >= 0 ? this.chart[f] : this.selected;
    const face = f >= 0 ? `triangle ${this.origins[f]}, energy ${plain(this.energy[f])}; ` : '';
    const chart = c >= 0 ? `chart ${c}: ${this.table.describe(c)}` : f >= 0 ? 'in no chart' : '';
    element('told').textContent = face + chart;
  }

  /** A chart, or -1 for none; framed: both views show it alone. */
  select(c, framed) {
    this.selected = c;
    this.table.mark(c, !framed);
    this.choose();
    this.#tell();
    if (!framed || c < 0) return;
    const normal = new Vector3(), corner = [0, 1, 2].map(() => new Vector3());
    const faces = [];
    for (let f = 0; f < this.chart.length; ++f) {
      if (this.chart[f] !== c) continue;
      faces.push(f);
      corner.forEach((p, k) => p.fromArray(this.model.points, 3 * this.model.faces[3 * f + k]));
      normal.add(corner[1].sub(corner[0]).cross(corner[2].sub(corner[0])));
    }
    if (normal.length() > 0) normal.normalize();
    else normal.set(0, 0, 1);
    for (const pane of this.panes)
      pane.fit(faces.flatMap((f) => Array.from(pane.mesh.faces.subarray(3 * f, 3 * f + 3))), pane.flat ? undefined : normal);
  }

  showAll() {
    this.select(-1, false);
    for (const pane of this.panes) pane.fit();
  }

  #toggle(id) {
    const on = element(id).getAttribute('aria-pressed') !== 'true';
    element(id).setAttribute('aria-pressed', String(on));
    this.panes.forEach((pane, i) => {
      if (id === 'seams') for (const lines of this.lines[i]) lines.visible = on;
      else pane.edges = on;
      pane.draw();
    });
  }

  #listen() {
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.#applyTheme());
    const radios = [...document.querySelectorAll('[data-colours]')];
    for (const b of radios) {
      b.onclick = () => {
        // Once more: another image.
        if (b.dataset.colours === 'texture' && b.getAttribute('aria-checked') === 'true') element('image').click();
        else this.colour(b.dataset.colours);
      };
    }
    element('image').onchange = (e) => { if (e.target.files[0]) this.take(e.target.files[0]); e.target.value = ''; };
    element('colours').onkeydown = (e) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[e.key];
      if (!step) return;
      e.preventDefault();
      const next = radios[(radios.indexOf(e.target) + step + radios.length) % radios.length];
      next.focus();
      this.colour(next.dataset.colours);
    };
    element('seams').onclick = () => this.#toggle('seams');
    element('edges').onclick = () => this.#toggle('edges');
    element('all').onclick = () => this.showAll();
    element('copy').onclick = () => {
      getSelection().selectAllChildren(element('command').querySelector('pre'));
      if (!document.execCommand('copy')) navigator.clipboard?.writeText(this.data.command);
    };
    addEventListener('keydown', (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      if (keys[e.key]) this.colour(keys[e.key]);
      else if (e.key === 's') this.#toggle('seams');
      else if (e.key === 'w') this.#toggle('edges');
      else if (e.key === 'Escape') this.showAll();
    });
    for (const pane of this.panes) this.#listenToPane(pane);
  }

  #listenToPane(pane) {
    const { canvas } = pane;
    const pixel = (e) => { const r = canvas.getBoundingClientRect(); return [e.clientX - r.left, e.clientY - r.top]; };
    let down = null, waiting = null;
    canvas.addEventListener('pointermove', (e) => {
      if (e.buttons !== 0) return;
      if (!waiting) requestAnimationFrame(() => { this.hover(waiting ? pane.faceAt(waiting) : -1); waiting = null; });
      waiting = pixel(e);
    });
    canvas.addEventListener('pointerleave', () => { waiting = null; this.hover(-1); });
    canvas.addEventListener('pointerdown', (e) => { down = pixel(e); });
    canvas.addEventListener('pointerup', (e) => {
      const at = pixel(e);
      if (!down || e.button !== 0 || Math.hypot(at[0] - down[0], at[1] - down[1]) > 4) return;
      const f = pane.faceAt(at), c = f >= 0 ? this.chart[f] : -1;
      this.select(c === this.selected ? -1 : c, false);
    });
    canvas.addEventListener('keydown', (e) => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
      if (way && pane.flat) pane.pan(0.05 * way[0], 0.05 * way[1]);
      else if (way) pane.turn(0.15 * way[0], -0.15 * way[1]);
      else if (e.key === '+' || e.key === '=') pane.zoom(1.2);
      else if (e.key === '-') pane.zoom(1 / 1.2);
      else return;
      e.preventDefault();
    });
  }
}

globalThis.report = new Report(JSON.parse(element('data').textContent));
