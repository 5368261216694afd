// SPDX-License-Identifier: MIT
import { listenToKeys } from './keys.js';
import * as messages from './messages.js';
import { rove } from './toolbar.js';

const { Mesh, Pane, distortion, rest } = scene;

const element = (id) => document.getElementById(id);
const accent = { pin: '#e8590c', ahead: '#d6336c', current: '#7048e8', line: '#2f9e44' };
const reach = 14; // pixels from the pointer to a vertex

class Page {
  gesture = 1;
  tool = 'drag';
  region = new Set(); // faces
  line = []; // vertices
  current = -1; // the pin that keys move
  focused = false;
  pose = { turn: 0, scale: 1, softness: 0 };
  frames = []; // times of the last pictures
  #drag = null;
  #leftWaits = false; // has another state to show
  #later = 0; // timer
  #sending = false;

  constructor() {
    this.settle = rove(element('bar'));
    this.right = new Pane(element('map'), { flat: true, afterDraw: () => this.#drawn() });
    this.#connect();
    this.#listenToButtons();
    listenToKeys(this);
    this.#listenToPointer(this.right);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.panes().forEach((p) => p.applyTheme()));
    this.choose('drag');
  }

  panes() { return this.left ? [this.left, this.right] : [this.right]; }

  #connect() {
    const token = location.hash.slice(1);
    this.socket = new WebSocket(`ws://${location.host}/live`, ['taut', `token.${token}`]);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onmessage = (e) => this.#take(messages.read(e.data));
    this.socket.onclose = () => this.note('not connected: the program has ended, or the address is not the one that it printed', true);
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(message);
  }

  note(text, bad = false) {
    element('note').textContent = text;
    element('note').className = bad ? 'bad' : '';
  }

  #take(message) {
    this.moving = false;
    if (message.kind === 'model') this.#open(message);
    else if (message.kind === 'state') this.#show(message);
    else if (message.kind === 'note') this.note(message.text, true);
    else download(message.name, message.bytes);
  }

  #open(model) {
    this.model = model;
    element('name').textContent = model.name;
    document.title = `${model.name} - taut`;
    this.mesh = new Mesh(model.points, model.faces);
    this.values = new Float32Array(this.mesh.faceCount);
    this.region.clear();
    this.line = [];
    const pasting = model.shows === 'paste';
    for (const id of ['feature', 'soft']) element(id).hidden = !pasting;
    for (const id of ['tools', 'mapping', 'save-pins']) element(id).hidden = pasting;
    element('texture').parentElement.hidden = model.shows !== 'map';
    this.image = null;
    element('texture').setAttribute('aria-pressed', 'false');
    if (pasting) this.tool = 'place';
    if (model.shows === 'map') {
      if (!this.left) {
        this.left = new Pane(element('model'), { flat: false });
        this.#listenToPointer(this.left);
      }
      this.left.setMesh(this.mesh);
      this.left.setPositions(model.points, 3);
      this.left.fit();
    } else {
      element('left').parentElement.classList.add('single');
      for (const id of ['straight-u', 'straight-v']) element(id).hidden = model.dimension === 3;
      if (model.dimension === 3) {
        this.right.setFlat(false);
      }
    }
    const moved = pasting ? 'Surface: arrow keys move the feature' : `${model.shows === 'map' ? 'Map' : 'Shape'}: arrow keys move the current pin`;
    element('map').setAttribute('aria-label', `${moved}, ${model.dimension === 3 ? 'comma and full stop turn it, ' : ''}Page Up and Page Down zoom`);
    this.settle();
    this.right.setMesh(this.mesh);
    for (let f = model.feature; f < this.mesh.faceCount; ++f) this.region.add(f);
    this.seenBefore = this.seenBefore === model.name ? this.seenBefore : '';
    this.state = null;
  }

  #show(state) {
    const first = !this.state;
    this.state = state;
    this.right.setPositions(state.positions, this.model.dimension);
    if (first && this.seenBefore !== this.model.name) {
      this.seenBefore = this.model.name;
      this.right.fit();
      this.checks = 24 / this.right.extent;
    }
    if (this.model.shows === 'paste') this.values.fill(4);
    else distortion(this.mesh, state.positions, this.model.dimension, this.values);
    this.right.setFaces('value', this.values);
    if (this.image) this.right.setUv(this.#inImage(), 0);
    // Where pictures take long the other view waits until there is no further state for a while.
    clearTimeout(this.#later);
    if (state.writer && this.#drag?.vertex >= 0) this.#sendDrag();
    if (first) this.mark();
    else this.#markVertices();
    this.#leftWaits = this.right.isLate;
    if (!this.#leftWaits) this.#showOnLeft();
    if (this.model.shows === 'paste') return this.#showPaste(state);
    element('energy').textContent = `energy ${state.energy.toPrecision(8)}`;
    element('flips').textContent = `${state.flipped} flipped`;
    element('flips').className = state.flipped > 0 ? 'bad' : '';
    const ahead = state.held ? '' : `, farthest ${state.distance.toPrecision(3)} ahead`;
    element('pins').textContent = `${state.pins.size} pinned${ahead}`;
    element('time').textContent = state.working ? `${(1000 * state.seconds).toFixed(0)} ms a frame` : state.converged ? 'converged' : 'at rest';
    this.#showHistory(state);
  }

  #showOnLeft() {
    if (!this.left || !this.state) return;
    this.left.setFaces('value', this.values);
    if (this.image) this.left.setUv(this.#inImage(), 0);
    else this.left.setUv(this.state.positions, this.checks);
    this.left.setMarks(this.marks);
  }

  /** The user's texture, of a file, or none; it fills the box of the map as it is now, and stays there. */
  async takeImage(file) {
    try {
      this.image = file && (await createImageBitmap(file, { imageOrientation: 'flipY', premultiplyAlpha: 'none', colorSpaceConversion: 'none' }));
    } catch (e) {
      return this.note(`${file.name}: no image that this browser reads; give a PNG, JPEG or WebP`, true);
    }
    const x = this.state.positions, low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (let i = 0; i < x.length; ++i) {
      low[i % 2] = Math.min(low[i % 2], x[i]);
      high[i % 2] = Math.max(high[i % 2], x[i]);
    }
    this.box = { low, size: Math.max(high[0] - low[0], high[1] - low[1], 1e-12) };
    for (const pane of this.panes()) {
      if (this.image) pane.setImage(this.image);
      pane.material.uniforms.textured.value = this.image ? 1 : 0;
    }
    if (this.image) this.right.setUv(this.#inImage(), 0);
    this.#showOnLeft();
    this.right.draw();
    element('texture').setAttribute('aria-pressed', String(Boolean(this.image)));
  }

  #inImage() {
    const { low, size } = this.box;
    return this.state.positions.map((x, i) => (x - low[i % 2]) / size);
  }

  /** Asks for an image, or takes it away. */
  #texture() {
    if (this.model.shows !== 'map') return;
    if (this.image) this.takeImage(null);
    else element('image').click();
  }

  #showPaste(state) {
    this.pose = { ...state.pose };
    element('softness').value = state.pose.softness;
    element('energy').textContent = `${this.mesh.faceCount} triangles`;
    const { turn, scale, softness } = this.pose;
    element('flips').textContent = `turned ${((180 * turn) / Math.PI).toFixed(0)}°, size ${scale.toPrecision(3)}, softness ${softness}`;
    element('time').textContent = `${(1000 * state.seconds).toFixed(0)} ms`;
    this.#showHistory(state);
  }

  #showHistory(state) {
    element('undo').disabled = !state.writer || !state.canUndo;
    element('redo').disabled = !state.writer || !state.canRedo;
    this.settle();
    if (!state.writer) this.note('another page is open and writes; this one looks on');
    this.#pending = state.number;
  }

  #pending = null;

  /** A picture is done: the program may send the next state. */
  #drawn() {
    if (this.#pending === null) return;
    this.frames.push(performance.now());
    if (this.frames.length > 240) this.frames.shift();
    this.send(messages.seen(this.#pending));
    this.#pending = null;
    if (this.#leftWaits) this.#later = setTimeout(() => this.#showOnLeft(), rest);
  }

  mark() {
    if (!this.state) return;
    this.#markVertices();
    const chosen = new Float32Array(this.mesh.faceCount);
    for (const f of this.region) chosen[f] = 1;
    for (const p of this.panes()) p.setFaces('chosen', chosen);
    this.left?.setMarks(this.marks);
  }

  #markVertices() {
    const marks = (this.marks = []);
    for (const v of this.line) marks.push({ vertex: v, colour: accent.line });
    for (const [v, p] of this.state.pins) {
      const held = p.x.every((x, k) => ((p.held >> k) & 1) === 0 || Math.fround(x - this.state.origin[k]) === this.state.positions[this.model.dimension * v + k]);
      marks.push({ vertex: v, colour: v === this.current ? accent.current : held ? accent.pin : accent.ahead });
    }
    this.right.setMarks(marks);
  }

  choose(tool) {
    this.tool = tool;
    for (const b of document.querySelectorAll('[data-tool]')) b.setAttribute('aria-checked', String(b.dataset.tool === tool));
    if (tool !== 'path') this.line = [];
    this.mark();
  }

  /** A position of a pane as the program has it. */
  #inSpace(x) { return x.map((value, k) => value + this.state.origin[k]); }

  position(v) {
    const d = this.model.dimension;
    return this.#inSpace(Array.from(this.state.positions.subarray(d * v, d * v + d)));
  }

  /** Pins a vertex, all coordinates or those that it is pinned in. */
  pin(v, x) {
    const all = this.model.dimension === 3 ? 7 : 3;
    this.current = v;
    this.send(messages.places(this.gesture, [{ vertex: v, held: all, x }]));
  }

  relax(afresh = false) { this.send(messages.relax(++this.gesture, afresh)); this.note(''); }

  toggleFocus() {
    if (!this.focused && this.region.size === 0) return this.note('choose a region first: the tool Region, then drag from a vertex outwards');
    this.focused = !this.focused;
    element('focus').setAttribute('aria-pressed', String(this.focused));
    this.send(messages.focus(++this.gesture, this.focused ? [...this.region] : []));
  }

  straighten(axis) {
    if (this.line.length < 2) return this.note('click vertices along a line first: the tool Line');
    this.send(messages.align(++this.gesture, axis, [...new Set(this.line)]));
    this.line = [];
  }

  unpin() {
    const pins = this.state.pins;
    let list = pins.has(this.current) ? [this.current] : [];
    if (this.region.size > 0) {
      const inside = new Set();
      for (const f of this.region) for (let k = 0; k < 3; ++k) inside.add(this.mesh.faces[3 * f + k]);
      list = [...pins.keys()].filter((v) => inside.has(v));
    } else if (list.length === 0) list = [...pins.keys()];
    this.current = -1;
    if (list.length > 0) this.send(messages.release(++this.gesture, list));
  }

  /** Turns, scales or softens the feature, or puts it on a vertex. */
  place({ onto = -1, ...change }) {
    Object.assign(this.pose, change);
    this.send(messages.pose(this.gesture, { onto, ...this.pose }));
    this.note('');
  }

  savePins() {
    const axes = this.model.dimension === 3 ? ['x', 'y', 'z'] : ['u', 'v'];
    const rows = [...this.state.pins].map(([v, p]) => [v, ...axes.map((_, k) => ((p.held >> k) & 1 ? p.x[k] : ''))].join(','));
    download('pins.csv', new TextEncoder().encode([['vertex', ...axes].join(','), ...rows, ''].join('\n')));
  }

  #listenToButtons() {
    for (const b of document.querySelectorAll('[data-tool]')) b.onclick = () => this.choose(b.dataset.tool);
    const actions = {
      relax: () => this.relax(), afresh: () => this.relax(true), focus: () => this.toggleFocus(),
      'straight-u': () => this.straighten(0), 'straight-v': () => this.straighten(1), release: () => this.unpin(),
      undo: () => this.send(messages.undo()), redo: () => this.send(messages.redo()),
      'turn-left': () => this.change({ turn: this.pose.turn + Math.PI / 36 }), 'turn-right': () => this.change({ turn: this.pose.turn - Math.PI / 36 }),
      smaller: () => this.change({ scale: this.pose.scale / 1.05 }), larger: () => this.change({ scale: this.pose.scale * 1.05 }),
      keep: () => this.send(messages.keep(++this.gesture)),
      texture: () => this.#texture(), save: () => this.send(messages.save()), 'save-pins': () => this.savePins(),
    };
    element('softness').onpointerdown = () => ++this.gesture;
    element('softness').oninput = () => { if (this.state) this.place({ softness: Number(element('softness').value) }); };
    element('image').onchange = (e) => { if (e.target.files[0]) this.takeImage(e.target.files[0]); e.target.value = ''; };
    for (const [id, f] of Object.entries(actions)) element(id).onclick = () => { if (this.state) f(); };
  }

  /** The feature, by a part of what is seen to the right and upwards. */
  move(x, y) {
    if (this.moving) return; // a key that is held down waits for what it did last
    this.moving = true;
    const { elements } = this.right.camera.matrixWorld, d = this.right.extent;
    this.send(messages.move(++this.gesture, [0, 1, 2].map((k) => d * (x * elements[k] + y * elements[4 + k]))));
    this.note('');
  }

  /** As a gesture of its own. */
  change(pose) {
    ++this.gesture;
    this.place(pose);
  }

  #listenToPointer(pane) {
    const canvas = pane.canvas;
    const pixel = (e) => { const r = canvas.getBoundingClientRect(); return [e.clientX - r.left, e.clientY - r.top]; };
    const movable = () => pane === this.right;
    let first = null; // finger
    canvas.addEventListener('pointerdown', (e) => {
      if (!this.state || e.button !== 0) return;
      if (e.isPrimary) first = e;
      else return this.#yieldTo(pane, first);
      const at = pixel(e);
      let v = movable() ? pane.vertexAt(at, reach, this.state.pins.keys()) : -1;
      if (v < 0) v = pane.vertexAt(at, reach);
      if (v < 0 || (this.tool === 'drag' && !movable())) return; // the view moves
      if (this.tool === 'place') {
        const face = pane.faceAt(at);
        if (e.shiftKey || face >= this.model.feature) { // what is grabbed is the feature
          pane.controls.enabled = false;
          canvas.setPointerCapture(e.pointerId);
          ++this.gesture;
          this.#drag = { pane, placing: true };
        }
        return;
      }
      pane.controls.enabled = false;
      canvas.setPointerCapture(e.pointerId);
      if (this.tool === 'path') {
        this.line.push(...(this.line.length > 0 ? this.mesh.path(this.line.at(-1), v).slice(1) : [v]));
        this.mark();
      } else if (this.tool === 'region') {
        this.#drag = { centre: v, pane, start: at, before: e.shiftKey ? new Set(this.region) : new Set() };
        this.#grow(at);
      } else {
        ++this.gesture;
        this.#drag = { vertex: v, pane, x: null };
        this.current = v;
      }
    }, { capture: true });
    canvas.addEventListener('pointermove', (e) => {
      if (this.#drag?.pane !== pane) return;
      if (this.tool === 'region') return this.#grow(pixel(e));
      if (this.tool === 'place') return;
      this.#drag.x = this.#inSpace(pane.toModel(pixel(e), this.#drag.vertex));
      this.#drag.fresh = true;
      this.#schedule();
    });
    const end = (e) => {
      pane.controls.enabled = true;
      if (this.#drag?.pane !== pane) return;
      if (this.#drag.placing) {
        const v = pane.vertexAt(pixel(e), reach);
        if (v >= 0) this.place({ onto: v });
      } else if (this.tool === 'drag') { // a click pins the vertex where it is
        this.#drag.x = this.#drag.x ? this.#inSpace(pane.toModel(pixel(e), this.#drag.vertex)) : this.position(this.#drag.vertex);
        this.#drag.fresh = true;
        this.#sendDrag();
      }
      this.#drag = null;
      ++this.gesture;
    };
    canvas.addEventListener('pointerup', end);
    canvas.addEventListener('pointercancel', end);
    canvas.addEventListener('dblclick', (e) => { // nowhere yet, or far away
      const v = this.tool === 'place' ? pane.vertexAt(pixel(e), reach) : -1;
      if (v >= 0) this.change({ onto: v });
    });
    canvas.addEventListener('contextmenu', (e) => {
      e.preventDefault();
      const v = movable() ? pane.vertexAt(pixel(e), reach, this.state.pins.keys()) : -1;
      if (v >= 0) this.send(messages.release(++this.gesture, [v]));
    });
  }

  /** A second finger comes: both are the view's, and what the first one did is undone. */
  #yieldTo(pane, first) {
    if (this.#drag?.pane !== pane) return;
    if (this.#drag.sent) this.send(messages.undo());
    this.#drag = null;
    ++this.gesture;
    pane.controls.enabled = true;
    const { pointerId, pointerType, clientX, clientY } = first;
    pane.canvas.dispatchEvent(new PointerEvent('pointerdown', { pointerId, pointerType, clientX, clientY, button: 0, buttons: 1 }));
  }

  /** One message a picture, however fast the pointer reports. */
  #schedule() {
    if (this.#sending) return;
    this.#sending = true;
    requestAnimationFrame(() => { this.#sending = false; this.#sendDrag(); });
  }

  #sendDrag() {
    if (!this.#drag?.fresh) return;
    this.#drag.fresh = false;
    this.#drag.sent = true;
    this.pin(this.#drag.vertex, this.#drag.x);
  }

  /** The disk around where the pointer went down, as far as the pointer has come. */
  #grow(at) {
    const { centre, pane, start, before } = this.#drag;
    const height = pane.camera.top - pane.camera.bottom;
    const radius = (Math.hypot(at[0] - start[0], at[1] - start[1]) * height) / pane.canvas.clientHeight / pane.camera.zoom;
    this.region = new Set(before);
    for (const f of this.mesh.disk(centre, radius)) this.region.add(f);
    this.mark();
  }
}

function download(name, bytes) {
  const a = document.createElement('a');
  a.href = URL.createObjectURL(new Blob([bytes]));
  a.download = name;
  a.click();
  setTimeout(() => URL.revokeObjectURL(a.href), 10000);
}

window.taut = new Page(); // for scripts that drive it
