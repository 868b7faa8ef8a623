// web/lecture/formulas.js: the lecture's formulas with a camera's numbers put in.
//
// A camera is { eye, lookat, up, d, zoom, s, roll, width, height } as in docs/lecture.md, and { r, c, px, py }, the point
// of a pixel: r counts rows from the bottom. Members that are not given have the defaults below.

import { cross, dot } from "../vec.js";

const DEFAULTS = { eye: [0, 0, 500], lookat: [0, 0, 0], up: [0, 1, 0], d: 500, zoom: 1, s: 1, roll: 0, width: 400, height: 400,
                   px: 0.5, py: 0.5, direction: [-1, 0.75, -5] };
const DEPTHS = [250, 0, -500, -1500]; // the disks of scenes/lecture/property_1.pbrt
const OUTERMOST = 2.6, RADIUS = 0.6; // x of the outermost spheres of the middle row in scenes/lecture/objects/spheres.pbrt
const DEGREES = 180 / Math.PI;

const times = (k, a) => a.map((x) => k * x);
const plus = (...vectors) => vectors.reduce((a, b) => a.map((x, k) => x + b[k]));
const normalize = (a) => times(1 / Math.hypot(...a), a);

// The lecture's viewing coordinates, as Camera_compute_uvw of examples/lecture.c computes them.
export function basis(camera) {
  const w = normalize(plus(camera.eye, times(-1, camera.lookat)));
  const u = normalize(cross(camera.up, w)), v = cross(w, u);
  const a = camera.roll / DEGREES;
  return { u: plus(times(Math.cos(a), u), times(-Math.sin(a), v)), v: plus(times(Math.sin(a), u), times(Math.cos(a), v)), w };
}

// The point (x_v, y_v) of the view plane under the camera's pixel.
export function viewPoint(camera) {
  const s = camera.s / camera.zoom;
  return [s * (camera.c - camera.width / 2 + camera.px), s * (camera.r - camera.height / 2 + camera.py)];
}

// The direction of the primary ray through that point.
export function primaryRay(camera) {
  const [x, y] = viewPoint(camera), { u, v, w } = basis(camera);
  return normalize(plus(times(x, u), times(y, v), times(-camera.d, w)));
}

// The image of the point at infinity of a direction, relative to the image's centre, y up; null: parallel to the view plane.
export function vanishingPoint(camera, direction) {
  const { u, v, w } = basis(camera);
  const depth = -dot(direction, w), f = (camera.zoom * camera.d) / camera.s;
  if (Math.abs(depth) < 1e-9 * Math.hypot(...direction)) return null;
  return [(f * dot(direction, u)) / depth, (f * dot(direction, v)) / depth];
}

// Numbers with at most four digits behind the point, in the language's form.
export function writer(language) {
  const number = (x, digits = 4) => {
    const text = Number(x.toFixed(digits)).toString().replace("-", "−");
    return (text === "−0" ? "0" : text).replace(".", language === "it" ? "," : ".");
  };
  const separator = language === "it" ? "; " : ", ";
  const vector = (a, digits = 4) => `(${a.map((x) => number(x, digits)).join(separator)})`;
  return { number, vector, separator, point: language === "it" ? "," : "." };
}

const FORMULAS = {
  f: (k, { number }) => `f = zoom · d / s = ${number(k.zoom)} · ${number(k.d)} / ${number(k.s)} = ${number((k.zoom * k.d) / k.s)}`,

  fov: (k, { number }) => {
    const s = k.s / k.zoom, tangent = (k.height * s) / 2 / k.d;
    return `tan(fov / 2) = (${number(k.height)} · ${number(s)} / 2) / ${number(k.d)} = ${number(tangent)}, ` +
      `fov = ${number(2 * Math.atan(tangent) * DEGREES, 2)}°`;
  },

  size: (k, { number }) => {
    const f = (k.zoom * k.d) / k.s;
    const one = (z) => `${number(f)} / ${number(k.eye[2] - z)} = ${number(f / (k.eye[2] - z), 3)}`;
    return "f / z: " + DEPTHS.filter((z) => z < k.eye[2]).map(one).join("   ");
  },

  vanishing: (k, { number, vector }) => {
    const point = vanishingPoint(k, k.direction), { u, v, w } = basis(k);
    const along = [dot(k.direction, u), dot(k.direction, v)];
    if (!point) return `v_z = 0`;
    return `(x, y) = f (v_x, v_y) / v_z = ${number((k.zoom * k.d) / k.s)} ${vector(along)} / ${number(-dot(k.direction, w))} = ${vector(point, 2)}`;
  },

  principal: (k, { vector }) => "xyz".split("").map((axis, i) => {
    const point = vanishingPoint(k, [0, 1, 2].map((j) => (i === j ? 1 : 0)));
    return `${axis}: ${point ? vector([k.width / 2 + point[0], k.height / 2 - point[1]], 1) : "∞"}`;
  }).join("   "),

  // A sphere whose radius is seen under alpha, at the angle theta from the view direction: the ratio of the axes of its image.
  ellipse: (k, { number }) => {
    const theta = Math.atan(OUTERMOST / k.eye[2]), sine = RADIUS / Math.hypot(OUTERMOST, k.eye[2]), alpha = Math.asin(sine);
    const ratio = Math.cos(alpha) / Math.sqrt(Math.cos(theta) ** 2 - sine ** 2);
    return `θ = ${number(theta * DEGREES, 1)}°, α = ${number(alpha * DEGREES, 1)}°, cos α / √(cos² θ − sin² α) = ${number(ratio, 2)}`;
  },

  dolly: (k, { number }) => {
    const f = (k.zoom * k.d) / k.s, ratio = f / (k.eye[2] - 1);
    return `d / (e − 1) = ${number(f)} / ${number(k.eye[2] - 1)} = ${number(ratio, 1)}, 2 d / (e − 1) = ${number(2 * ratio, 0)}`;
  },

  uvw: (k, { vector }) => Object.entries(basis(k)).map(([name, a]) => `${name} = ${vector(a)}`).join("   "),

  origin: (k, { vector }) => `o = ${vector([0, 0, k.eye[2]])}`,

  axis: (k, { vector }) => {
    const d = [...viewPoint({ ...k, px: 0.5, py: 0.5 }), -k.d];
    return `d = ${vector(d)}, |d| = 1: ${vector(normalize(d))}`;
  },

  point: (k, { number }) => {
    const [x, y] = viewPoint(k), s = number(k.s / k.zoom);
    return `x_v = ${s} (${number(k.c)} − ${number(k.width)}/2 + ${number(k.px)}) = ${number(x)}   ` +
      `y_v = ${s} (${number(k.r)} − ${number(k.height)}/2 + ${number(k.py)}) = ${number(y)}`;
  },

  ray: (k, { number, vector }) => {
    const [x, y] = viewPoint(k), d = primaryRay(k);
    const term = (value) => (value < 0 ? " − " : " + ") + number(Math.abs(value));
    return `d = ${number(x)} u${term(y)} v${term(-k.d)} w, |d| = 1: ${vector(d)}`;
  },
};

export const formulaNames = Object.keys(FORMULAS);

// One line of text; language "it" writes decimal commas.
export function formula(name, camera, language = "en") {
  const k = { ...DEFAULTS, ...camera };
  k.r ??= Math.floor(k.height / 2);
  k.c ??= Math.floor(k.width / 2);
  return FORMULAS[name](k, writer(language));
}
