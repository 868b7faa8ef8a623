// web/lecture/svg.js: the parts of the drawn figures as text of SVG, and the two ways of looking at space that they use:
// a camera of the lecture's, and the view from outside (parallel projectors, so that lengths can be compared).
import { cross, dot, length, sub, unit } from "../vec.js";
import { basis } from "./formulas.js";

const n = (value) => Number(value.toFixed(2));
const attributes = (more) => Object.entries(more).map(([name, value]) => ` ${name}="${value}"`).join("");
const finite = (...points) => points.every((p) => p && p.every((x) => Number.isFinite(x) && Math.abs(x) < 1e6));

export function line(a, b, kind, more = {}) {
  if (!finite(a, b)) return "";
  return `<line class="${kind}" x1="${n(a[0])}" y1="${n(a[1])}" x2="${n(b[0])}" y2="${n(b[1])}"${attributes(more)}/>`;
}

export function polygon(points, kind, open = false) {
  if (!finite(...points)) return "";
  return `<${open ? "polyline" : "polygon"} class="${kind}" points="${points.map((p) => `${n(p[0])},${n(p[1])}`).join(" ")}"/>`;
}

export const circle = (at, radius, kind) => (finite(at) ? `<circle class="${kind}" cx="${n(at[0])}" cy="${n(at[1])}" r="${n(radius)}"/>` : "");

export function rectangle(x, y, width, height, kind) {
  return `<rect class="${kind}" x="${n(x)}" y="${n(y)}" width="${n(width)}" height="${n(height)}"/>`;
}

// anchor: start, middle or end. Names such as "P_r" have an index.
export function label(at, text, kind = "", anchor = "start") {
  if (!finite(at)) return "";
  const html = String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/_(\w+)/g, '<tspan dy="4" font-size="0.75em">$1</tspan><tspan dy="-4">\u200b</tspan>');
  return `<text class="${kind}" x="${n(at[0])}" y="${n(at[1])}" text-anchor="${anchor}">${html}</text>`;
}

// What can be dragged: a disk with a larger one round it for fingers.
export function handle(name, at) {
  if (!finite(at)) return "";
  return `<g class="handle" data-handle="${name}"><circle class="reach" cx="${n(at[0])}" cy="${n(at[1])}" r="20"/>` +
    `<circle cx="${n(at[0])}" cy="${n(at[1])}" r="7"/></g>`;
}

export function arrow(a, b, kind, size = 9) {
  if (!finite(a, b)) return "";
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (length < 1e-6) return "";
  const along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length], back = Math.min(size, length);
  const wing = (side) => [b[0] - back * (along[0] - side * 0.4 * along[1]), b[1] - back * (along[1] + side * 0.4 * along[0])];
  return line(a, b, kind) + polygon([b, wing(1), wing(-1)], `${kind} head`);
}

// An angle at a centre, from one direction to another (radians, counter-clockwise on the page).
export function arc(centre, radius, from, to, kind) {
  const steps = 24, points = [];
  for (let i = 0; i <= steps; i++) {
    const a = from + ((to - from) * i) / steps;
    points.push([centre[0] + radius * Math.cos(a), centre[1] - radius * Math.sin(a)]);
  }
  return polygon(points, kind, true);
}

// Space seen from outside: { azimuth, elevation } in degrees, the middle, and pixels per unit. project(p) is its place,
// move(direction, [dx, dy]) how far a point moves along a direction when the pointer moves on the page.
export function outsideView({ azimuth, elevation }, middle, factor, centre) {
  const a = (azimuth * Math.PI) / 180, e = (elevation * Math.PI) / 180;
  const from = [Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)];
  const right = unit(cross([0, 1, 0], from)), up = cross(from, right);
  const project = (p) => {
    const q = sub(p, middle);
    return [centre[0] + factor * dot(q, right), centre[1] - factor * dot(q, up)];
  };
  const move = (direction, [dx, dy]) => {
    const x = factor * dot(direction, right), y = -factor * dot(direction, up), length = x * x + y * y;
    return length < 1e-3 * factor * factor ? 0 : (dx * x + dy * y) / length;
  };
  return { project, move, right, up, from, depth: (p) => dot(sub(p, middle), from) };
}

// The viewing coordinates: as basis of formulas.js; null: up is parallel to the view direction, or eye is lookat.
export function frameOf(eye, lookat, up, roll = 0) {
  const arm = sub(eye, lookat);
  if (length(arm) < 1e-9 || length(cross(up, unit(arm))) < 1e-6 * length(up)) return null;
  return basis({ eye, lookat, up, roll });
}

// A point on the view plane at distance d, as (x_v, y_v); null: it is not before the eye.
export function onPlane(p, eye, { u, v, w }, d) {
  const q = sub(p, eye), depth = -dot(q, w);
  return depth > 1e-6 ? [(d * dot(q, u)) / depth, (d * dot(q, v)) / depth] : null;
}

// The corners and the twelve edges of a box that stands on y: edges along x first, then y, then z.
export function box([x, y, z], [width, height, depth]) {
  const corner = (i) => [x + (i & 1 ? 0.5 : -0.5) * width, y + (i & 2 ? height : 0), z + (i & 4 ? 0.5 : -0.5) * depth];
  const edges = [0, 1, 2].flatMap((axis) => [0, 1, 2, 3, 4, 5, 6, 7].filter((i) => !(i & (1 << axis))).map((i) => ({ axis, a: i, b: i | (1 << axis) })));
  return { corners: [0, 1, 2, 3, 4, 5, 6, 7].map(corner), edges };
}
