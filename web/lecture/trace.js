// web/lecture/trace.js: the slides' program in JavaScript, as examples/lecture.c has it: World with its spheres and a plane,
// RayCast::trace_ray, the pinhole camera. It makes the small images of the drawn figures.
import { add, dot, scale, sub, unit } from "../vec.js";
import { frameOf } from "./svg.js";

export const WORLD = [
  { centre: [-20, 0, -70], radius: 100, color: [0.62, 0.2, 0.11] },
  { centre: [125, -40, 45], radius: 60, color: [0.04, 0.11, 0.32] },
  { centre: [5, -58, 100], radius: 42, color: [0.8, 0.6, 0.2] },
  { centre: [88, -78, 148], radius: 22, color: [0.68, 0.46, 0.06] },
  { centre: [-82, -72, 112], radius: 28, color: [0.1, 0.32, 0.2] },
  { height: -100, side: 100, color: [0.58, 0.56, 0.52] },
];

// The camera of the slide World::build, with a window of 400 x 300.
export const PINHOLE = { eye: [300, 400, 500], lookat: [0, 0, -50], up: [0, 1, 0], d: 400, zoom: 1, roll: 0, exposure: 1 };

function hitSphere({ centre, radius }, o, d) {
  const oc = sub(o, centre), b = dot(oc, d), disc = b * b - dot(oc, oc) + radius * radius;
  if (disc < 0) return Infinity;
  const t = -b - Math.sqrt(disc) > 1e-9 ? -b - Math.sqrt(disc) : -b + Math.sqrt(disc);
  return t > 1e-9 ? t : Infinity;
}

function hitPlane({ height }, o, d) {
  const t = (height - o[1]) / d[1];
  return t > 1e-9 ? t : Infinity;
}

// The nearest hit of a ray: { t, object }; object null: there is none.
export function nearest(o, d, world = WORLD) {
  let best = { t: Infinity, object: null };
  for (const object of world) {
    const t = (object.radius ? hitSphere : hitPlane)(object, o, d);
    if (t < best.t) best = { t, object };
  }
  return best;
}

// RayCast::trace_ray: the colour of the first object times the cosine between ray and normal.
export function traceRay(o, d, world = WORLD) {
  const { t, object } = nearest(o, d, world);
  if (!object) return [0, 0, 0];
  const p = add(o, scale(d, t));
  if (object.radius) return scale(object.color, Math.abs(dot(unit(sub(p, object.centre)), d)));
  const odd = (Math.floor(p[0] / object.side) + Math.floor(p[2] / object.side)) % 2 !== 0;
  return scale(object.color, Math.abs(d[1]) * (odd ? 0.8 : 1));
}

// 8-bit display values, as World::display_pixel writes them.
export const display = (color) => color.map((x) => Math.floor(255 * Math.min(1, Math.max(0, x)) ** (1 / 2.2) + 0.5));

// Pinhole::get_direction.
export function getDirection({ u, v, w }, d, [x, y]) {
  return unit(add(add(scale(u, x), scale(v, y)), scale(w, -d)));
}

// Pinhole::render_scene: 8-bit values, row 0 below, as an array of h_res x v_res colours; n x n samples for each pixel.
export function renderScene(camera, { h_res, v_res, s, n = 1 }, world = WORLD) {
  const frame = frameOf(camera.eye, camera.lookat, camera.up, camera.roll), size = s / camera.zoom, pixels = [];
  for (let r = 0; r < v_res; r++)
    for (let c = 0; c < h_res; c++) {
      let L = [0, 0, 0];
      for (let j = 0; j < n * n && frame; j++) {
        const x = size * (c - 0.5 * h_res + ((j % n) + 0.5) / n), y = size * (r - 0.5 * v_res + (Math.floor(j / n) + 0.5) / n);
        L = add(L, traceRay(camera.eye, getDirection(frame, camera.d, [x, y]), world));
      }
      pixels.push(display(scale(L, camera.exposure / (n * n))));
    }
  return pixels;
}

// An image, row 0 below, as the address of a BMP (which counts its rows from below, too).
export function imageAddress(pixels, width, height) {
  const stride = Math.ceil((3 * width) / 4) * 4, bytes = new Uint8Array(54 + stride * height), view = new DataView(bytes.buffer);
  bytes.set([0x42, 0x4d]);
  for (const [at, value] of [[2, bytes.length], [10, 54], [14, 40], [18, width], [22, height], [26, 0x180001]]) view.setUint32(at, value, true);
  pixels.forEach(([r, g, b], i) => bytes.set([b, g, r], 54 + stride * Math.floor(i / width) + 3 * (i % width)));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return `data:image/bmp;base64,${btoa(text)}`;
}
