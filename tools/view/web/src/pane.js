// SPDX-License-Identifier: MIT
// One canvas with a mesh: flat, seen from above, or in space, seen from anywhere. Drawn only when something changed. Where
// a picture takes long, as without a GPU, those of a motion have fewer pixels and no edges; the one at rest has all.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, LinearSRGBColorSpace, LineBasicMaterial, LineSegments, Mesh as Drawn, MOUSE,
  NoColorSpace, OrthographicCamera, Points, PointsMaterial, RepeatWrapping, Scene, ShaderMaterial, Spherical, Texture, TOUCH, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

const vertexShader = `
  attribute vec2 flatUv;
  attribute float value;
  attribute float chosen;
  attribute float label;
  varying vec3 seen;
  varying vec2 st;
  varying float v;
  varying float c;
  varying float l;
  void main() {
    vec4 p = modelViewMatrix * vec4(position, 1.0);
    seen = p.xyz;
    st = flatUv;
    v = value;
    c = chosen;
    l = label;
    gl_Position = projectionMatrix * p;
  }`;

// From the surface's own colour at 4, where shape is kept, over yellow to red, by the logarithm of energy / 4 - 1; a colour
// for each label; or an image.
const fragmentShader = `
  uniform vec3 base;
  uniform float checks;
  uniform float shade;
  uniform float heat;
  uniform float labels;
  uniform float textured;
  uniform sampler2D image;
  varying vec3 seen;
  varying vec2 st;
  varying float v;
  varying float c;
  varying float l;
  void main() {
    float t = clamp(log(max(v / 4.0 - 1.0, 1e-3) / 1e-3) / log(4000.0), 0.0, 1.0);
    vec3 warm = mix(vec3(0.96, 0.80, 0.35), vec3(0.80, 0.16, 0.18), smoothstep(0.35, 1.0, t));
    vec3 colour = mix(base, warm, heat * smoothstep(0.0, 0.35, t));
    vec3 own = 0.66 + 0.24 * cos(6.2832 * (fract(0.618034 * l) + vec3(0.0, 0.67, 0.33)));
    if (labels > 0.0 && l > -0.5) colour = own;
    if (textured > 0.0) {
      vec4 texel = texture2D(image, st);
      colour = mix(base, texel.rgb, texel.a);
    }
    vec2 square = floor(st * checks);
    if (checks > 0.0 && mod(square.x + square.y, 2.0) > 0.5) colour *= 0.80;
    colour = mix(colour, vec3(0.25, 0.48, 0.95), 0.55 * c);
    vec3 n = normalize(cross(dFdx(seen), dFdy(seen)));
    colour *= mix(1.0, 0.45 + 0.55 * abs(n.z), shade);
    gl_FragColor = vec4(colour, 1.0);
  }`;

const late = 40; // milliseconds that a whole picture takes
export const rest = 500; // milliseconds without another picture

/** Where processors draw, antialiasing by the context costs several times a picture, also in motion; more pixels do it at rest. */
const drawnBySoftware = (() => {
  const gl = document.createElement('canvas').getContext('webgl2');
  const name = gl ? String(gl.getParameter(gl.getExtension('WEBGL_debug_renderer_info')?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER)) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
})();

export class Pane {
  frame = []; // points that belong to all of it, beside the mesh
  edges = false; // are drawn
  isLate = false; // a whole picture takes long
  #waiting = false; // for the turn of a picture
  #drawing = false; // until a picture is there
  #whole = false; // the next one has all
  #timer = 0;

  /** flat: seen from above, moved but not turned. afterDraw is called when a picture is done. */
  constructor(canvas, { flat, afterDraw = () => {} }) {
    this.canvas = canvas;
    this.afterDraw = afterDraw;
    this.renderer = new WebGLRenderer({ canvas, antialias: !drawnBySoftware, alpha: true });
    this.renderer.setPixelRatio(this.#pixels(false));
    this.scene = new Scene();
    this.camera = new OrthographicCamera(-1, 1, 1, -1, -100, 100);
    this.camera.position.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.setFlat(flat);
    this.controls.addEventListener('change', () => this.draw());
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
  }

  /** Seen from above, moved by the pointer; or turned by it. Two fingers zoom, too. */
  setFlat(flat) {
    this.flat = flat;
    this.controls.enableRotate = !flat;
    this.controls.mouseButtons.LEFT = flat ? MOUSE.PAN : MOUSE.ROTATE;
    this.controls.touches = flat ? { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN } : { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_ROTATE };
  }

  setMesh(mesh) {
    this.mesh = mesh;
    const corners = 3 * mesh.faceCount;
    this.geometry = new BufferGeometry();
    for (const [name, size] of [['position', 3], ['flatUv', 2], ['value', 1], ['chosen', 1], ['label', 1]])
      this.geometry.setAttribute(name, new BufferAttribute(new Float32Array(size * corners), size));
    this.material = new ShaderMaterial({
      vertexShader, fragmentShader, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      uniforms: { base: { value: new Color() }, checks: { value: 0 }, shade: { value: this.flat ? 0 : 1 }, heat: { value: 1 }, labels: { value: 0 }, textured: { value: 0 }, image: { value: null } },
    });
    const surface = new Drawn(this.geometry, this.material);
    this.vertices = new Float32Array(3 * mesh.vertexCount);
    const shared = new BufferAttribute(this.vertices, 3);
    const wires = new BufferGeometry();
    wires.setAttribute('position', shared);
    wires.setIndex(new BufferAttribute(mesh.edges(), 1));
    this.wires = new LineSegments(wires, new LineBasicMaterial({ transparent: true, opacity: drawnBySoftware ? 0.7 : 0.35 }));
    this.edges = this.flat && mesh.faceCount < 30000;
    this.isLate = false; // until it is known
    this.marks = new Points(new BufferGeometry(), new PointsMaterial({ size: 9, sizeAttenuation: false, vertexColors: true, depthTest: false }));
    this.marks.renderOrder = 1;
    this.scene.clear();
    this.scene.add(surface, this.wires, this.marks);
    surface.frustumCulled = this.wires.frustumCulled = this.marks.frustumCulled = false;
    this.applyTheme();
  }

  /** Colours of the page's style. */
  applyTheme() {
    const style = getComputedStyle(document.documentElement);
    this.material?.uniforms.base.value.setStyle(style.getPropertyValue('--surface').trim(), LinearSRGBColorSpace); // as it stands
    this.wires?.material.color.set(style.getPropertyValue('--wire').trim());
    this.draw();
  }

  /** x: two or three coordinates a vertex. */
  setPositions(x, dimension) {
    const position = this.geometry.getAttribute('position');
    for (let v = 0; v < this.mesh.vertexCount; ++v)
      for (let k = 0; k < 3; ++k) this.vertices[3 * v + k] = k < dimension ? x[dimension * v + k] : 0;
    scatter(this.mesh.faces, this.vertices, 3, position.array);
    position.needsUpdate = this.wires.geometry.getAttribute('position').needsUpdate = true;
    this.draw();
  }

  /** Flat coordinates for the checkerboard; faces: whose corners have them, if not those of the mesh. */
  setUv(x, checks, faces = this.mesh.faces) {
    const uv = this.geometry.getAttribute('flatUv');
    scatter(faces, x, 2, uv.array);
    uv.needsUpdate = true;
    this.material.uniforms.checks.value = checks;
    this.draw();
  }

  /** An image for `textured`, repeated beyond the unit square; its top row is at v = 1. bitmap: with the bottom row first. */
  setImage(bitmap) {
    const { image } = this.material.uniforms;
    image.value?.dispose();
    image.value = Object.assign(new Texture(bitmap), {
      flipY: false, wrapS: RepeatWrapping, wrapT: RepeatWrapping, colorSpace: NoColorSpace, anisotropy: this.renderer.capabilities.getMaxAnisotropy(), needsUpdate: true,
    });
    this.draw();
  }

  /** One number a face. */
  setFaces(name, values) {
    const attribute = this.geometry.getAttribute(name);
    for (let f = 0; f < values.length; ++f) attribute.array.fill(values[f], 3 * f, 3 * f + 3);
    attribute.needsUpdate = true;
    this.draw();
  }

  /** marks: [{vertex, colour}]. */
  setMarks(marks) {
    const x = new Float32Array(3 * marks.length), colours = new Float32Array(3 * marks.length);
    const colour = new Color();
    marks.forEach((m, i) => {
      x.set(this.vertices.subarray(3 * m.vertex, 3 * m.vertex + 3), 3 * i);
      colour.set(m.colour).toArray(colours, 3 * i);
    });
    this.marks.geometry.dispose();
    this.marks.geometry = new BufferGeometry();
    this.marks.geometry.setAttribute('position', new BufferAttribute(x, 3));
    this.marks.geometry.setAttribute('color', new BufferAttribute(colours, 3));
    this.draw();
  }

  /** Shows all of it, or some vertices alone, seen from a direction. */
  fit(vertices = null, from = new Vector3(0, 0, 1)) {
    const low = new Vector3(Infinity, Infinity, Infinity), high = low.clone().negate(), p = new Vector3();
    const take = (v) => {
      p.fromArray(this.vertices, 3 * v);
      if (!Number.isFinite(p.x)) return;
      low.min(p);
      high.max(p);
    };
    if (vertices) for (const v of vertices) take(v);
    else {
      for (let v = 0; v < this.mesh.vertexCount; ++v) take(v);
      for (const corner of this.frame) { low.min(corner); high.max(corner); }
    }
    if (!(low.x <= high.x)) return;
    const extent = Math.max(high.distanceTo(low), 1e-12);
    if (!vertices) this.extent = extent;
    this.size = this.flat ? [high.x - low.x, high.y - low.y] : [extent, extent];
    const middle = low.add(high).multiplyScalar(0.5);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(from, this.extent);
    this.camera.near = -10 * this.extent;
    this.camera.far = 10 * this.extent;
    this.camera.zoom = 1;
    this.camera.up.set(0, 1, 0);
    this.#resize();
    this.controls.update();
  }

  /** Turns around what is seen, in radians. */
  turn(azimuth, polar) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const at = new Spherical().setFromVector3(offset);
    at.theta += azimuth;
    at.phi += polar;
    this.camera.position.copy(this.controls.target).add(offset.setFromSpherical(at.makeSafe()));
    this.controls.update();
    this.draw();
  }

  /** Moves by parts of what is seen. */
  pan(x, y) {
    const c = this.camera, step = new Vector3();
    step.addScaledVector(new Vector3().setFromMatrixColumn(c.matrix, 0), (x * (c.right - c.left)) / c.zoom);
    step.addScaledVector(new Vector3().setFromMatrixColumn(c.matrix, 1), (y * (c.top - c.bottom)) / c.zoom);
    c.position.add(step);
    this.controls.target.add(step);
    this.controls.update();
    this.draw();
  }

  zoom(factor) {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Where a vertex is on the page, in pixels of the canvas. */
  toScreen(v) {
    const p = new Vector3().fromArray(this.vertices, 3 * v).project(this.camera);
    return [((p.x + 1) / 2) * this.canvas.clientWidth, ((1 - p.y) / 2) * this.canvas.clientHeight];
  }

  /** The point under a pixel, on the plane through a vertex that faces the camera. */
  toModel(pixel, v) {
    const p = new Vector3().fromArray(this.vertices, 3 * v).project(this.camera);
    p.x = (2 * pixel[0]) / this.canvas.clientWidth - 1;
    p.y = 1 - (2 * pixel[1]) / this.canvas.clientHeight;
    p.unproject(this.camera);
    return [p.x, p.y, p.z];
  }

  /** The vertex within reach (pixels) that is nearest to a pixel, in space that of the face under it; -1: none. */
  vertexAt(pixel, reach, among = null) {
    let best = -1, least = reach;
    const consider = (v) => {
      const [x, y] = this.toScreen(v);
      const d = Math.hypot(x - pixel[0], y - pixel[1]);
      if (d < least) { least = d; best = v; }
    };
    if (among) { for (const v of among) consider(v); return best; }
    if (this.flat) { for (let v = 0; v < this.mesh.vertexCount; ++v) consider(v); return best; }
    const f = this.faceAt(pixel);
    least = Infinity;
    if (f >= 0) for (let k = 0; k < 3; ++k) consider(this.mesh.faces[3 * f + k]);
    return best;
  }

  /** The face under a pixel, the nearest to the camera; -1: none. */
  faceAt(pixel) {
    const m = this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse).elements;
    const x = (2 * pixel[0]) / this.canvas.clientWidth - 1, y = 1 - (2 * pixel[1]) / this.canvas.clientHeight;
    const v = this.vertices, faces = this.mesh.faces;
    let best = -1, nearest = Infinity;
    const corner = (i, k) => {
      const a = 3 * faces[i];
      return m[k] * v[a] + m[4 + k] * v[a + 1] + m[8 + k] * v[a + 2] + m[12 + k];
    };
    for (let f = 0; f < this.mesh.faceCount; ++f) {
      const ax = corner(3 * f, 0) - x, bx = corner(3 * f + 1, 0) - x, cx = corner(3 * f + 2, 0) - x;
      if ((ax > 0 && bx > 0 && cx > 0) || (ax < 0 && bx < 0 && cx < 0)) continue;
      const ay = corner(3 * f, 1) - y, by = corner(3 * f + 1, 1) - y, cy = corner(3 * f + 2, 1) - y;
      const a = bx * cy - by * cx, b = cx * ay - cy * ax, c = ax * by - ay * bx, sum = a + b + c;
      if (!((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0)) || sum === 0) continue;
      const z = (a * corner(3 * f, 2) + b * corner(3 * f + 1, 2) + c * corner(3 * f + 2, 2)) / sum;
      if (z < nearest) { nearest = z; best = f; }
    }
    return best;
  }

  draw() {
    if (!this.mesh) return;
    if (!this.#waiting && !this.#drawing) requestAnimationFrame(() => this.#render());
    this.#waiting = true;
  }

  #render() {
    clearTimeout(this.#timer);
    this.#waiting = false;
    this.#drawing = true;
    const brief = this.isLate && !this.#whole, begin = performance.now(), pixels = this.#pixels(brief);
    this.#whole = false;
    if (this.renderer.getPixelRatio() !== pixels) this.renderer.setPixelRatio(pixels);
    this.wires.visible = this.edges && !brief;
    this.renderer.render(this.scene, this.camera);
    this.#whenDrawn(() => {
      if (brief) this.#timer = setTimeout(() => { this.#whole = true; this.draw(); }, rest);
      else this.isLate = performance.now() - begin > late;
      this.#drawing = false;
      if (this.#waiting) requestAnimationFrame(() => this.#render());
      this.afterDraw();
    });
  }

  /** Of the canvas by those of the page. */
  #pixels(brief) {
    const all = Math.min(devicePixelRatio, 2);
    return brief ? all / 2 : drawnBySoftware ? 2 * all : all;
  }

  #whenDrawn(f) {
    const gl = this.renderer.getContext(), fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      if (fence && !gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) return setTimeout(look, 1);
      gl.deleteSync(fence);
      f();
    };
    setTimeout(look, 0);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    const aspect = width / height, size = this.size ?? [2, 2];
    const h = 0.54 * Math.max(size[1], size[0] / aspect, 1e-12), w = h * aspect;
    Object.assign(this.camera, { left: -w, right: w, top: h, bottom: -h });
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}

function scatter(faces, values, size, out) {
  for (let c = 0; c < faces.length; ++c)
    for (let k = 0; k < size; ++k) out[size * c + k] = values[size * faces[c] + k];
}
