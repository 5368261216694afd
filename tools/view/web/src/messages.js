// SPDX-License-Identifier: MIT
// The language of page and program: binary messages, little-endian; docs/howto/view.md has the table.

const kinds = { places: 1, release: 2, focus: 3, relax: 4, align: 5, undo: 6, redo: 7, save: 8, seen: 9, pose: 10, keep: 11, move: 12 };

class Writer {
  constructor(kind, gesture, size) {
    this.view = new DataView(new ArrayBuffer(5 + size));
    this.at = 0;
    this.u8(kinds[kind]).u32(gesture);
  }
  u8(x) { this.view.setUint8(this.at, x); this.at += 1; return this; }
  u32(x) { this.view.setUint32(this.at, x, true); this.at += 4; return this; }
  f64(x) { this.view.setFloat64(this.at, x, true); this.at += 8; return this; }
  ids(list) { this.u32(list.length); for (const v of list) this.u32(v); return this; }
  take() { return this.view.buffer; }
}

/** pins: [{vertex, held, x: [x, y, z]}], bit k of held: coordinate k is held. */
export function places(gesture, pins) {
  const out = new Writer('places', gesture, 4 + 29 * pins.length).u32(pins.length);
  for (const p of pins) {
    out.u32(p.vertex).u8(p.held);
    for (let k = 0; k < 3; ++k) out.f64(p.x[k] ?? 0);
  }
  return out.take();
}
export const release = (gesture, vertices) => new Writer('release', gesture, 4 + 4 * vertices.length).ids(vertices).take();
export const focus = (gesture, faces) => new Writer('focus', gesture, 4 + 4 * faces.length).ids(faces).take();
export const relax = (gesture, afresh) => new Writer('relax', gesture, 1).u8(afresh ? 1 : 0).take();
export const align = (gesture, axis, vertices) =>
  new Writer('align', gesture, 5 + 4 * vertices.length).u8(axis).ids(vertices).take();
/** onto: a vertex of what is shown, or -1. */
export const pose = (gesture, p) =>
  new Writer('pose', gesture, 28).u32(p.onto >>> 0).f64(p.turn).f64(p.scale).f64(p.softness).take();
/** by: in the space of the model. */
export const move = (gesture, by) => new Writer('move', gesture, 24).f64(by[0]).f64(by[1]).f64(by[2]).take();
export const keep = (gesture) => new Writer('keep', gesture, 0).take();
export const undo = () => new Writer('undo', 0, 0).take();
export const redo = () => new Writer('redo', 0, 0).take();
export const save = () => new Writer('save', 0, 0).take();
export const seen = (number) => new Writer('seen', 0, 4).u32(number).take();

class Reader {
  constructor(buffer) {
    this.buffer = buffer;
    this.view = new DataView(buffer);
    this.at = 0;
  }
  u8() { return this.view.getUint8(this.at++); }
  u32() { this.at += 4; return this.view.getUint32(this.at - 4, true); }
  f64() { this.at += 8; return this.view.getFloat64(this.at - 8, true); }
  bytes(n) { this.at += n; return this.buffer.slice(this.at - n, this.at); }
  text() { return new TextDecoder().decode(this.bytes(this.u32())); }
  floats() { return new Float32Array(this.bytes(4 * this.u32())); }
  numbers() { return new Uint32Array(this.bytes(4 * this.u32())); }
}

const readers = {
  64: (in_) => ({ kind: 'model', dimension: in_.u8(), shows: ['shape', 'map', 'paste'][in_.u8()], name: in_.text(), points: in_.floats(), faces: in_.numbers(), feature: in_.u32() }),
  65: (in_) => {
    const flags = in_.u8();
    const s = { kind: 'state' };
    ['converged', 'held', 'working', 'canUndo', 'canRedo', 'writer'].forEach((name, k) => { s[name] = ((flags >> k) & 1) === 1; });
    Object.assign(s, { number: in_.u32(), flipped: in_.u32(), energy: in_.f64(), distance: in_.f64(), seconds: in_.f64() });
    s.pose = { turn: in_.f64(), scale: in_.f64(), softness: in_.f64() };
    s.pins = new Map();
    for (let n = in_.u32(); n > 0; --n) s.pins.set(in_.u32(), { held: in_.u8(), x: [in_.f64(), in_.f64(), in_.f64()] });
    s.origin = [in_.f64(), in_.f64(), in_.f64()];
    s.positions = in_.floats();
    return s;
  },
  66: (in_) => ({ kind: 'note', text: in_.text() }),
  67: (in_) => ({ kind: 'file', name: in_.text(), bytes: in_.bytes(in_.u32()) }),
};

/** An object with the kind of message and what it says. */
export function read(buffer) {
  const in_ = new Reader(buffer);
  return readers[in_.u8()](in_);
}
