// web/lecture/drawings/space.js: projection and projectors, the window moved and turned, the frustum: in space, seen from
// outside, with the image beside.
import { add, dot, scale, sub } from "../../vec.js";
import { arrow, box, handle, label, line, onPlane, outsideView, polygon, rectangle } from "../svg.js";

const IDENTITY = { u: [1, 0, 0], v: [0, 1, 0], w: [0, 0, 1] };
const around = (state, [dx, dy]) => ({ ...state, azimuth: state.azimuth - 0.4 * dx, elevation: Math.min(85, Math.max(-5, state.elevation + 0.4 * dy)) });

// A house with its gable at a point: [corner, corner] pairs, and its corners.
function house([x, y, z]) {
  const a = 45, h = 70, deep = 80;
  const front = [[-a, -h - 40], [a, -h - 40], [a, -40], [0, 0], [-a, -40]].map(([p, q]) => [x + p, y + q, z]);
  const corners = [...front, ...front.map(([p, q, r]) => [p, q, r - deep])];
  const edges = [0, 1, 2, 3, 4].flatMap((i) => [[i, (i + 1) % 5], [i + 5, ((i + 1) % 5) + 5], [i, i + 5]]);
  return { corners, edges };
}

// The image of edges in a frame on the page: place(p) is a point of the view plane.
function picture(frame, half, edges, corners, place, kind = "ink thin") {
  const [x, y, width, height] = frame, k = width / (2 * half);
  const at = (p) => p && [x + width / 2 + k * p[0], y + height / 2 - k * p[1]];
  const id = `clip${Math.round(x)}-${Math.round(y)}`;
  const lines = edges.map(([i, j]) => {
    const [a, b] = [at(place(corners[i])), at(place(corners[j]))];
    return a && b ? line(a, b, kind) : "";
  });
  return { html: `<clipPath id="${id}"><rect x="${x}" y="${y}" width="${width}" height="${height}"/></clipPath>${rectangle(x, y, width, height, "window")}` +
    `<g clip-path="url(#${id})">${lines.join("")}</g>`, at };
}

const minus = (write, x) => (x < 0 ? `(${write.number(x)})` : write.number(x));

const projection = {
  size: [640, 400],
  turns: true,
  state: { kind: "perspective", e: 300, d: 150, x: 60, y: 70, z: -60, azimuth: 62, elevation: 18 },
  choices: { kind: ["perspective", "orthographic"] },
  plane: (s) => s.e - s.d,
  image(s, p) {
    if (s.kind === "orthographic") return [p[0], p[1]];
    return onPlane(p, [0, 0, s.e], IDENTITY, s.d);
  },
  draw(s, say) {
    const view = outsideView(s, [0, 0, 110], 0.78, [215, 215]), P = view.project, flat = this.plane(s);
    const { corners, edges } = house([s.x, s.y, s.z]), eye = [0, 0, s.e], window = [[-100, -75], [100, -75], [100, 75], [-100, 75]];
    const image = (p) => { const q = this.image(s, p); return q && [q[0], q[1], flat]; };
    const from = (p) => (s.kind === "perspective" ? eye : [p[0], p[1], s.e]);
    const top = [s.x, s.y, s.z], shadow = image(top);
    let html = arrow(P([0, 0, s.e + 40]), P([0, 0, -120]), "soft thin") + label(add2(P([0, 0, s.e + 40]), [6, 4]), "z", "soft");
    html += edges.map(([i, j]) => line(P(corners[i]), P(corners[j]), "ink")).join("");
    html += polygon(window.map(([x, y]) => P([x, y, flat])), "plane");
    html += corners.slice(0, 5).filter((_, i) => i !== 3).map((p) => line(P(p), P(from(p)), "ray thin")).join("");
    html += line(P(top), P(from(top)), "ray");
    html += edges.map(([i, j]) => line(P(image(corners[i])), P(image(corners[j])), "image")).join("");
    html += label(add2(P([100, 75, flat]), [4, -6]), say("view plane", "view plane"), "plane-name");
    if (s.kind === "perspective") html += handle("eye", P(eye)) + label(add2(P(eye), [-4, 26]), "e", "name", "middle");
    html += handle("plane", P([0, -75, flat])) + handle("P", P(top));
    html += label(add2(P(top), [12, -8]), "P", "name") + label(add2(P(shadow), [8, -8]), "P′", "name");
    const inset = picture([430, 40, 200, 150], 100, edges, corners, (p) => this.image(s, p), "image");
    html += inset.html + label([530, 28], say("the image", "l'immagine"), "", "middle");
    const point = inset.at(this.image(s, top));
    return html + `<circle class="dot" cx="${point[0]}" cy="${point[1]}" r="4"/>` + label([point[0] + 7, point[1] - 6], "P′", "name");
  },
  drag(s, name, [dx, dy]) {
    const view = outsideView(s, [0, 0, 110], 0.78, [215, 215]);
    if (name === "eye") { // the plane stays where it is
      const step = view.move([0, 0, 1], [dx, dy]);
      return { ...s, e: s.e + step, d: s.d + step };
    }
    if (name === "plane") return { ...s, d: s.d - view.move([0, 0, 1], [dx, dy]) };
    if (name === "P") {
      const step = add(scale(view.right, dx / 0.78), scale(view.up, -dy / 0.78));
      return { ...s, x: s.x + step[0], y: s.y + step[1], z: s.z + step[2] };
    }
    return around(s, [dx, dy]);
  },
  numbers(s, w) {
    const [x, y] = this.image(s, [s.x, s.y, s.z]), point = `P = ${w.vector([s.x, s.y, s.z])}`;
    if (s.kind === "orthographic") return [point, `x′ = x = ${w.number(x)}`, `y′ = y = ${w.number(y)}`];
    const one = (name, value, result) => `${name}′ = d ${name} / (e − z) = ${w.number(s.d)} · ${minus(w, value)} / (${w.number(s.e)} − ${minus(w, s.z)}) = ${w.number(result)}`;
    return [point, one("x", s.x, x), one("y", s.y, y)];
  },
};

const add2 = (a, b) => a && [a[0] + b[0], a[1] + b[1]];

// The window's centre, axes and distance. It is turned about the vertical through its centre.
function windowOf(s) {
  const t = (s.turn * Math.PI) / 180, eye = [0, 0, 300], centre = [s.shift_x, s.shift_y, 150];
  const u = [Math.cos(t), 0, -Math.sin(t)], v = [0, 1, 0], w = [Math.sin(t), 0, Math.cos(t)];
  const arm = sub(eye, centre), d = dot(arm, w);
  const foot = [dot(arm, u), dot(arm, v)]; // the foot of the perpendicular from the eye, from the window's centre
  return { eye, centre, u, v, w, d, foot, angle: (Math.acos(Math.min(1, d / Math.hypot(...arm))) * 180) / Math.PI };
}

const windows = {
  size: [640, 400],
  turns: true,
  state: { kind: "perspective", shift_x: 0, shift_y: 0, turn: 0, azimuth: 62, elevation: 22 },
  choices: { kind: ["perspective", "orthographic"] },
  objects: [box([-70, -75, -40], [70, 90, 70]), box([60, -75, -120], [60, 140, 60]), box([40, -75, 30], [40, 40, 40])],
  corner: ({ centre, u, v }, x, y) => add(centre, add(scale(u, x), scale(v, y))),
  draw(s, say) {
    const view = outsideView(s, [0, 0, 80], 0.72, [215, 215]), P = view.project, win = windowOf(s);
    const corners = [[-80, -60], [80, -60], [80, 60], [-80, 60]].map(([x, y]) => this.corner(win, x, y));
    const parallel = s.kind === "orthographic", sides = [0, 1, 2, 3];
    const towards = (c) => (parallel ? scale(win.w, -1) : scale(sub(c, win.eye), 1 / 150));
    const far = corners.map((c) => add(c, scale(towards(c), 260)));
    let html = this.objects.map((b) => b.edges.map((e) => line(P(b.corners[e.a]), P(b.corners[e.b]), "ink thin")).join("")).join("");
    html += sides.map((i) => line(P(parallel ? add(corners[i], scale(win.w, 100)) : win.eye), P(far[i]), "volume") + line(P(far[i]), P(far[(i + 1) % 4]), "volume")).join("");
    html += polygon(corners.map(P), "plane");
    const foot = this.corner(win, ...win.foot);
    if (!parallel) {
      html += line(P(win.eye), P(foot), "ray dashed") + label(add2(P(foot), [8, 14]), say("foot of the perpendicular", "piede della perpendicolare"), "small");
      html += arrow(P(win.eye), P(win.centre), "axis-w") + handle("eye", P(win.eye)).replace('class="handle"', 'class="still"').replace(' data-handle="eye"', "") + label(add2(P(win.eye), [0, 26]), "e", "name", "middle");
    }
    html += handle("centre", P(win.centre)) + handle("side", P(this.corner(win, 80, 0)));
    const flat = (p) => { const q = sub(p, win.centre); return [dot(q, win.u), dot(q, win.v)]; };
    const place = (p) => {
      const q = onPlane(p, win.eye, win, win.d);
      return q && [q[0] + win.foot[0], q[1] + win.foot[1]];
    };
    const all = this.objects.flatMap((b, k) => b.edges.map((e) => [8 * k + e.a, 8 * k + e.b])), points = this.objects.flatMap((b) => b.corners);
    html += label([530, 16], say("perspective", "prospettica"), "", "middle") + picture([430, 24, 200, 150], 80, all, points, place).html;
    html += label([530, 232], say("orthographic", "ortografica"), "", "middle") + picture([430, 240, 200, 150], 80, all, points, flat).html;
    return html + label([530, 194], win.angle < 0.01 ? say("symmetric", "simmetrica") : say("not symmetric", "non simmetrica"), "name", "middle");
  },
  drag(s, name, step) {
    const view = outsideView(s, [0, 0, 80], 0.72, [215, 215]);
    if (name === "centre") return { ...s, shift_x: s.shift_x + view.move([1, 0, 0], [step[0], 0]), shift_y: s.shift_y + view.move([0, 1, 0], [0, step[1]]) };
    if (name === "side") return { ...s, turn: s.turn + 0.6 * step[0] };
    return around(s, step);
  },
  numbers(s, w, say) {
    const win = windowOf(s);
    if (s.kind === "orthographic") return [`"${say("projectors", "proiettori")}": ${w.vector(scale(win.w, -1), 3)}`];
    return [`(x_0, y_0) = ${w.vector(win.foot, 1)}`, `cos α = **w** · (e − m) / ‖e − m‖ = ${w.number(win.d, 1)} / ${w.number(Math.hypot(...sub(win.eye, win.centre)), 1)} = ${w.number(Math.cos((win.angle * Math.PI) / 180))}`,
            `α = ${w.number(win.angle, 1)}°`];
  },
};

const FRUSTUM_BOXES = [[-14, -70], [30, -150], [-60, -240], [80, -340], [-40, -450]].map(([x, z]) => ({ at: [x, 0, z], ...box([x, -25, z], [36, 50, 36]) }));

const frustum = {
  size: [640, 400],
  turns: true,
  state: { near: 100, far: 400, fov: 50, azimuth: 60, elevation: 20 },
  seen(s, [x, y, z]) {
    const t = Math.tan((s.fov * Math.PI) / 360), depth = -z;
    return depth >= s.near && depth <= s.far && Math.abs(y) <= t * depth && Math.abs(x) <= (4 / 3) * t * depth;
  },
  draw(s, say) {
    const view = outsideView(s, [0, 0, -240], 0.62, [310, 210]), P = view.project, t = Math.tan((s.fov * Math.PI) / 360);
    const corners = (depth) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => [(4 / 3) * x * t * depth, y * t * depth, -depth]);
    const near = corners(s.near), far = corners(s.far), beyond = corners(560), eye = [0, 0, 0];
    let html = "";
    for (const b of FRUSTUM_BOXES) {
      const kind = this.seen(s, b.at) ? "ink" : "soft dashed";
      html += b.edges.map((e) => line(P(b.corners[e.a]), P(b.corners[e.b]), kind)).join("");
    }
    for (let i = 0; i < 4; i++)
      html += line(P(eye), P(near[i]), "volume dashed") + line(P(near[i]), P(far[i]), "volume") + line(P(far[i]), P(beyond[i]), "volume dashed");
    html += polygon(near.map(P), "near") + polygon(far.map(P), "far");
    html += arrow(P(eye), P([0, 0, -60]), "axis-w") + handle("near", P([0, -t * s.near, -s.near])) + handle("far", P([0, -t * s.far, -s.far]));
    html += label(add2(P(near[3]), [0, -8]), "near", "near-name", "middle") + label(add2(P(far[3]), [0, -8]), "far", "near-name", "middle");
    return html + label(add2(P(eye), [0, 22]), "e", "name", "middle") + `<circle class="dot" cx="${P(eye)[0]}" cy="${P(eye)[1]}" r="5"/>` +
      label([12, 390], say("solid: seen; dashed: cut away", "linea continua: visibile; tratteggio: escluso"), "small");
  },
  drag(s, name, step) {
    const view = outsideView(s, [0, 0, -240], 0.62, [310, 210]), along = view.move([0, -Math.tan((s.fov * Math.PI) / 360), -1], step);
    if (name === "near") return { ...s, near: Math.min(s.near + along, s.far - 5) };
    if (name === "far") return { ...s, far: Math.max(s.far + along, s.near + 5) };
    return around(s, step);
  },
  numbers(s, w, say) {
    const t = Math.tan((s.fov * Math.PI) / 360), one = (name, z) => `h_${name} = 2 · ${w.number(z)} · tan(${w.number(s.fov)}° / 2) = ${w.number(2 * z * t, 1)}`;
    return [one("near", s.near), one("far", s.far), `"${say("boxes in the frustum", "scatole nel frustum")}": ${FRUSTUM_BOXES.filter((b) => this.seen(s, b.at)).length}`];
  },
};

export const spaceDrawings = { projection, windows, frustum };
