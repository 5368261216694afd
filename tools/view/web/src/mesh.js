// SPDX-License-Identifier: MIT
// What the page needs to know of a mesh: who is beside whom, and how far.

/** Faces of three corners each, and points of three coordinates. */
export class Mesh {
  constructor(points, faces) {
    this.points = points;
    this.faces = faces;
    this.vertexCount = points.length / 3;
    this.faceCount = faces.length / 3;
    this.#connect();
  }

  distance(a, b) {
    const p = this.points;
    return Math.hypot(p[3 * a] - p[3 * b], p[3 * a + 1] - p[3 * b + 1], p[3 * a + 2] - p[3 * b + 2]);
  }

  /** Calls f(neighbour) for the vertices that share an edge with v. */
  forNeighbours(v, f) {
    for (let i = this.begin[v]; i < this.begin[v + 1]; ++i) f(this.neighbours[i]);
  }

  /** Each edge once, two vertices each. */
  edges() {
    const list = [];
    for (let v = 0; v < this.vertexCount; ++v) this.forNeighbours(v, (w) => { if (v < w) list.push(v, w); });
    return Uint32Array.from(list);
  }

  /** Vertices of a shortest way along edges, ends included; empty where there is none. */
  path(from, to) {
    const before = this.#spread(from, Infinity, to).before;
    if (from !== to && !before.has(to)) return [];
    const way = [to];
    while (way[0] !== from) way.unshift(before.get(way[0]));
    return way;
  }

  /** Faces whose corners are all within a radius, along edges, of a vertex. */
  disk(centre, radius) {
    const near = this.#spread(centre, radius).length;
    const faces = [];
    for (let f = 0; f < this.faceCount; ++f)
      if (near.has(this.faces[3 * f]) && near.has(this.faces[3 * f + 1]) && near.has(this.faces[3 * f + 2])) faces.push(f);
    return faces;
  }

  #connect() {
    const pairs = new Set();
    const n = this.vertexCount;
    for (let f = 0; f < this.faceCount; ++f)
      for (let k = 0; k < 3; ++k) {
        const a = this.faces[3 * f + k], b = this.faces[3 * f + ((k + 1) % 3)];
        pairs.add(Math.min(a, b) * n + Math.max(a, b));
      }
    this.begin = new Uint32Array(n + 1);
    for (const p of pairs) { ++this.begin[Math.floor(p / n) + 1]; ++this.begin[(p % n) + 1]; }
    for (let v = 0; v < n; ++v) this.begin[v + 1] += this.begin[v];
    const next = this.begin.slice();
    this.neighbours = new Uint32Array(2 * pairs.size);
    for (const p of pairs) {
      const a = Math.floor(p / n), b = p % n;
      this.neighbours[next[a]++] = b;
      this.neighbours[next[b]++] = a;
    }
  }

  /** Dijkstra's method with a binary heap. */
  #spread(from, radius, to = -1) {
    const length = new Map([[from, 0]]), before = new Map(), done = new Set();
    const heap = [[0, from]];
    while (heap.length > 0) {
      const [d, v] = pop(heap);
      if (done.has(v)) continue;
      done.add(v);
      if (v === to) break;
      this.forNeighbours(v, (w) => {
        const there = d + this.distance(v, w);
        if (there > radius || there >= (length.get(w) ?? Infinity)) return;
        length.set(w, there);
        before.set(w, v);
        push(heap, [there, w]);
      });
    }
    return { length, before };
  }
}

function push(heap, item) {
  let i = heap.push(item) - 1;
  while (i > 0) {
    const parent = (i - 1) >> 1;
    if (heap[parent][0] <= item[0]) break;
    heap[i] = heap[parent];
    i = parent;
  }
  heap[i] = item;
}

function pop(heap) {
  const top = heap[0], item = heap.pop();
  if (heap.length === 0) return top;
  let i = 0;
  for (;;) {
    let child = 2 * i + 1;
    if (child >= heap.length) break;
    if (child + 1 < heap.length && heap[child + 1][0] < heap[child][0]) ++child;
    if (heap[child][0] >= item[0]) break;
    heap[i] = heap[child];
    i = child;
  }
  heap[i] = item;
  return top;
}

/**
 * The isometric energy of each face, 4 where it keeps its shape: tr(G'^-1 G) + tr(G^-1 G') of the metrics of both.
 * dimension: 2 or 3 coordinates of each of the positions.
 */
export function distortion(mesh, positions, dimension, out) {
  const rest = (mesh.metrics ??= metrics(mesh.faces, mesh.points, 3, new Float32Array(3 * mesh.faceCount)));
  const now = metrics(mesh.faces, positions, dimension, (mesh.scratch ??= new Float32Array(3 * mesh.faceCount)));
  for (let f = 0; f < mesh.faceCount; ++f) {
    const a = rest[3 * f], b = rest[3 * f + 1], c = rest[3 * f + 2];
    const p = now[3 * f], q = now[3 * f + 1], r = now[3 * f + 2];
    const cross = a * r - 2 * b * q + c * p;
    out[f] = cross / (a * c - b * b) + cross / (p * r - q * q);
  }
  return out;
}

/** Of each face e1.e1, e1.e2, e2.e2 of its edges from the first corner. */
function metrics(faces, x, dimension, out) {
  for (let f = 0, n = faces.length / 3; f < n; ++f) {
    const a = dimension * faces[3 * f], b = dimension * faces[3 * f + 1], c = dimension * faces[3 * f + 2];
    let p = 0, q = 0, r = 0;
    for (let k = 0; k < dimension; ++k) {
      const u = x[b + k] - x[a + k], v = x[c + k] - x[a + k];
      p += u * u;
      q += u * v;
      r += v * v;
    }
    out[3 * f] = p;
    out[3 * f + 1] = q;
    out[3 * f + 2] = r;
  }
  return out;
}
