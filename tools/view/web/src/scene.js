// SPDX-License-Identifier: MIT
// What the page of `taut view` and reports share, three.js above all: one script, `scene` to both.
export { BufferAttribute, BufferGeometry, GreaterDepth, LineBasicMaterial, LineSegments, Vector3 } from 'three';
export * from './mesh.js';
export * from './pane.js';
