// web/lecture/drawings/frame.js: viewing coordinates u v w, also where they cannot be computed, and the way from a pixel
// (r, c) to its primary ray.
import { add, cross, scale, sub } from "../../vec.js";
import { arrow, box, circle, frameOf, handle, label, line, onPlane, outsideView, polygon, rectangle } from "../svg.js";
import { PINHOLE, getDirection, imageAddress, nearest, renderScene, WORLD } from "../trace.js";

const plus = (a, b) => [a[0] + b[0], a[1] + b[1]];
const BOXES = [box([0, -60, 0], [90, 60, 90]), box([-110, -60, -60], [60, 110, 60]), box([100, -60, -70], [50, 40, 50])];

const uvw = {
  size: [700, 420],
  turns: true,
  state: { pose: "general", eye_x: 220, eye_y: 140, eye_z: 260, lookat_x: 0, lookat_y: 0, lookat_z: 0, up_angle: 0, roll: 0, azimuth: 85, elevation: 18 },
  choices: { pose: ["general", "down"] },
  choose: (s, key, value) => (value === "down" ? { ...s, pose: value, eye_x: 0, eye_y: 300, eye_z: 0, lookat_x: 0, lookat_y: 0, lookat_z: 0, up_angle: 0 } : { ...s, pose: value, eye_x: 220, eye_y: 140, eye_z: 260 }),
  parts(s) {
    const eye = [s.eye_x, s.eye_y, s.eye_z], lookat = [s.lookat_x, s.lookat_y, s.lookat_z], t = (s.up_angle * Math.PI) / 180, up = [Math.sin(t), Math.cos(t), 0];
    return { eye, lookat, up, frame: frameOf(eye, lookat, up, s.roll) };
  },
  draw(s, say) {
    const { eye, lookat, up, frame } = this.parts(s), view = outsideView(s, [70, 60, 90], 0.62, [215, 225]), P = view.project, d = 120;
    let html = BOXES.map((b) => b.edges.map((e) => line(P(b.corners[e.a]), P(b.corners[e.b]), "ink thin")).join("")).join("");
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((axis, i) => { html += arrow(P([0, -60, 0]), P(add([0, -60, 0], scale(axis, 150))), "soft thin") + label(plus(P(add([0, -60, 0], scale(axis, 160))), [0, 4]), "xyz"[i], "soft"); });
    html += line(P(eye), P(lookat), "ray dashed") + arrow(P(eye), P(add(eye, scale(up, 90))), "ink dashed") + label(plus(P(add(eye, scale(up, 96))), [6, 0]), "up", "name");
    if (frame) {
      const corners = [[-72, -54], [72, -54], [72, 54], [-72, 54]].map(([x, y]) => add(add(add(eye, scale(frame.w, -d)), scale(frame.u, x)), scale(frame.v, y)));
      html += polygon(corners.map(P), "plane") + corners.map((c) => line(P(eye), P(c), "volume")).join("");
      for (const name of ["u", "v", "w"]) html += arrow(P(eye), P(add(eye, scale(frame[name], 75))), `axis-${name} thick`) + label(plus(P(add(eye, scale(frame[name], 92))), [0, 5]), name, `axis-${name}-name big`, "middle");
    }
    html += handle("eye", P(eye)) + handle("lookat", P(lookat)) + label(plus(P(eye), [-12, 24]), "e", "name") + label(plus(P(lookat), [10, 22]), "l", "name");
    html += rectangle(440, 60, 250, 187.5, "window") + label([565, 46], say("the image", "l'immagine"), "", "middle");
    if (!frame) {
      const words = Math.hypot(...sub(eye, lookat)) < 1e-9 ? [say("e = l: no view direction", "e = l: manca la direzione"), say("w cannot be computed", "w non si può calcolare")]
        : [say("up is parallel to w:", "up è parallelo a w:"), say("up × w = 0, no u, no v", "up × w = 0: u e v non esistono")];
      return html + label([565, 148], words[0], "name", "middle") + label([565, 172], words[1], "name", "middle");
    }
    const at = (p) => { const q = onPlane(p, eye, frame, d); return q && [565 + (125 / 72) * q[0], 153.75 - (125 / 72) * q[1]]; };
    const lines = BOXES.flatMap((b) => b.edges.map((e) => line(at(b.corners[e.a]), at(b.corners[e.b]), "image"))).join("");
    html += `<clipPath id="uvw-clip"><rect x="440" y="60" width="250" height="187.5"/></clipPath><g clip-path="url(#uvw-clip)">${lines}</g>`;
    html += arrow([440, 270], [500, 270], "axis-u thick") + label([512, 275], "u", "axis-u-name big") + arrow([425, 247], [425, 187], "axis-v thick") + label([420, 178], "v", "axis-v-name big");
    return html + label([565, 300], say("rows are parallel to u, columns to v", "righe parallele a u, colonne a v"), "small", "middle");
  },
  drag(s, name, [dx, dy]) {
    if (!name) return { ...s, azimuth: s.azimuth - 0.4 * dx, elevation: Math.min(85, Math.max(-5, s.elevation + 0.4 * dy)) };
    const view = outsideView(s, [70, 60, 90], 0.62, [215, 225]), step = add(scale(view.right, dx / 0.62), scale(view.up, -dy / 0.62));
    const next = { ...s, pose: "" };
    ["x", "y", "z"].forEach((axis, i) => { next[`${name}_${axis}`] = Number((s[`${name}_${axis}`] + step[i]).toFixed(2)); });
    return next;
  },
  numbers(s, w, say) {
    const { eye, lookat, up, frame } = this.parts(s), arm = sub(eye, lookat), length = Math.hypot(...arm);
    if (length < 1e-9) return [`e − l = ${w.vector(arm, 1)}`, `"${say("w cannot be computed", "w non si può calcolare")}"`];
    const back = scale(arm, 1 / length), side = cross(up, back);
    const lines = [`**w** = (e − l) / ‖e − l‖ = ${w.vector(arm, 1)} / ${w.number(length, 1)} = ${w.vector(back, 3)}`, `up × **w** = ${w.vector(side, 3)}, ‖up × **w**‖ = ${w.number(Math.hypot(...side), 3)}`];
    return frame ? [...lines, `**u** = ${w.vector(frame.u, 3)}`, `**v** = ${w.vector(frame.v, 3)}`] : lines;
  },
};

// ---- pixel (r, c) and its ray ----
const H = 16, V = 12, S = 25;
const LEFT = [20, 60, 320, 240];
let picture = null; // the image of the slide's camera for a d, kept

function pictureOf(d) {
  if (picture?.d !== d) picture = { d, address: imageAddress(renderScene({ ...PINHOLE, d }, { h_res: H, v_res: V, s: S, n: 2 }), H, V) };
  return picture.address;
}

const pixel = {
  size: [860, 420],
  turns: true,
  state: { r: 7, c: 9, p_x: 0.5, p_y: 0.5, d: 400, azimuth: 74, elevation: 10 },
  ray(s) {
    const frame = frameOf(PINHOLE.eye, PINHOLE.lookat, PINHOLE.up), x = S * (s.c - H / 2 + s.p_x), y = S * (s.r - V / 2 + s.p_y);
    const d = getDirection(frame, s.d, [x, y]);
    return { frame, x, y, d, hit: nearest(PINHOLE.eye, d) };
  },
  draw(s, say) {
    const { frame, x, y, d, hit } = this.ray(s), k = LEFT[2] / H, eye = PINHOLE.eye, view = outsideView(s, [120, 150, 200], 0.4, [610, 215]), P = view.project;
    let html = `<image x="${LEFT[0]}" y="${LEFT[1]}" width="${LEFT[2]}" height="${LEFT[3]}" preserveAspectRatio="none" class="pixels" href="${pictureOf(s.d)}"/>`;
    const left = LEFT[0] + k * s.c, bottom = LEFT[1] + LEFT[3] - k * s.r;
    html += rectangle(...LEFT, "window") + rectangle(left, bottom - k, k, k, "picked") + circle([left + k * s.p_x, bottom - k * s.p_y], 3.5, "dot");
    html += label([LEFT[0], 48], say("click a pixel", "un clic sceglie il pixel"), "name") + label([left + k / 2, 318], `c = ${s.c}`, "name", "middle") + label([346, bottom - k / 2 + 5], `r = ${s.r}`, "name");
    html += arrow([LEFT[0] - 9, 300], [LEFT[0] - 9, 250], "axis-v") + arrow([LEFT[0], 330], [LEFT[0] + 50, 330], "axis-u");
    // from outside
    const on = (a, b) => add(add(add(eye, scale(frame.w, -s.d)), scale(frame.u, a)), scale(frame.v, b)), spot = on(x, y);
    for (const { centre, radius, color } of WORLD.filter((o) => o.radius).sort((a, b) => view.depth(a.centre) - view.depth(b.centre)))
      html += `<circle class="own" fill="rgb(${color.map((v) => Math.round(255 * v ** (1 / 2.2)))})" cx="${P(centre)[0].toFixed(1)}" cy="${P(centre)[1].toFixed(1)}" r="${(0.4 * radius).toFixed(1)}"/>`;
    const far = hit.object ? hit.t : 1400, end = add(eye, scale(d, far));
    for (let i = 0; i <= H; i++) html += line(P(on(S * (i - H / 2), (-S * V) / 2)), P(on(S * (i - H / 2), (S * V) / 2)), "grid");
    for (let i = 0; i <= V; i++) html += line(P(on((-S * H) / 2, S * (i - V / 2))), P(on((S * H) / 2, S * (i - V / 2))), "grid");
    const square = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([a, b]) => P(on(S * (s.c + a - H / 2), S * (s.r + b - V / 2))));
    html += polygon(square, "picked") + line(P(eye), P(end), "ray thick") + circle(P(spot), 4, "dot") + (hit.object ? circle(P(end), 5, "hit") : "");
    for (const name of ["u", "v", "w"]) html += arrow(P(eye), P(add(eye, scale(frame[name], 110))), `axis-${name}`) + label(plus(P(add(eye, scale(frame[name], 135))), [0, 5]), name, `axis-${name}-name big`, "middle");
    return html + circle(P(eye), 5, "dot") + label(plus(P(eye), [-6, 24]), "e", "name", "end");
  },
  click(s, [x, y]) {
    const c = Math.floor(((x - LEFT[0]) / LEFT[2]) * H), r = Math.floor(((LEFT[1] + LEFT[3] - y) / LEFT[3]) * V);
    return c >= 0 && c < H && r >= 0 && r < V ? { ...s, r, c } : s;
  },
  drag(s, name, [dx, dy], at) {
    return at[0] < 360 ? this.click(s, at) : { ...s, azimuth: s.azimuth - 0.4 * dx, elevation: Math.min(85, Math.max(-5, s.elevation + 0.4 * dy)) };
  },
  numbers(s, w, say) {
    const { x, y, d, hit, frame } = this.ray(s), sum = add(add(scale(frame.u, x), scale(frame.v, y)), scale(frame.w, -s.d));
    const term = (value) => (value < 0 ? " − " : " + ") + w.number(Math.abs(value));
    return [`x_v = s (c − h_res / 2 + p_x) = ${S} (${s.c} − ${H} / 2 + ${w.number(s.p_x)}) = ${w.number(x, 2)}`, `y_v = s (r − v_res / 2 + p_y) = ${S} (${s.r} − ${V} / 2 + ${w.number(s.p_y)}) = ${w.number(y, 2)}`,
            `**d** = ${w.number(x, 2)} **u**${term(y)} **v**${term(-s.d)} **w** = ${w.vector(sum, 1)}`, `**d** / ‖**d**‖ = ${w.vector(d, 4)}`, hit.object ? `t = ${w.number(hit.t, 1)}` : `"${say("the ray hits nothing", "il raggio non incontra nulla")}"`];
  },
};

export const frameDrawings = { uvw, pixel };
