// web/lecture/drawings/plane.js: figures in a plane that contains the eye: field of view, size and depth, the object that
// turns, the retina, the film behind the hole.
import { arc, arrow, circle, handle, label, line, polygon, rectangle } from "../svg.js";

const DEGREES = 180 / Math.PI;
const eyeMark = (at) => `<circle class="dot" cx="${at[0]}" cy="${at[1]}" r="5"/>` + label([at[0] - 10, at[1] + 24], "e", "name", "middle");

// ---- the field of view: from the side ----
const fieldOfView = {
  size: [640, 380],
  state: { d: 400, v_res: 300, s: 1 },
  tangent: (s) => (s.v_res * s.s) / 2 / s.d,
  draw(s, say) {
    const eye = [50, 190], k = 0.55, x = eye[0] + k * s.d, h = (k * s.v_res * s.s) / 2, t = this.tangent(s), a = Math.atan(t), far = 580;
    let html = polygon([eye, [eye[0] + far, 190 - t * far], [eye[0] + far, 190 + t * far]], "inside");
    html += line(eye, [eye[0] + far, 190 - t * far], "volume") + line(eye, [eye[0] + far, 190 + t * far], "volume") + line(eye, [630, 190], "soft dashed");
    html += line([x, 190 - h], [x, 190 + h], "plane thick") + arc(eye, 55, -a, a, "arc") + label([eye[0] + 62, 184], "fov", "name");
    for (const [y, size] of [[90, 26], [170, 34], [262, 22], [330, 26]]) {
      const seen = Math.abs(y - 190) + 0 < t * (520 - eye[0]);
      html += rectangle(520 - size / 2, y - size / 2, size, size, seen ? "object" : "soft dashed");
    }
    html += line([eye[0], 362], [x, 362], "soft thin") + label([(eye[0] + x) / 2, 376], "d", "name", "middle");
    html += label([x + 8, 190 - h + 2], "v_res s", "name") + handle("plane", [x, 190]) + handle("edge", [x, 190 - h]);
    return html + eyeMark(eye) + label([628, 20], say("seen: within the two lines", "visibile: ciò che sta fra le due rette"), "small", "end");
  },
  drag(s, name, [dx, dy]) {
    if (name === "plane") return { ...s, d: s.d + dx / 0.55 };
    return name === "edge" ? { ...s, s: s.s - (2 * dy) / 0.55 / s.v_res } : null;
  },
  numbers(s, w) {
    const t = this.tangent(s);
    return [`tan(fov / 2) = (v_res s / 2) / d = (${w.number(s.v_res)} · ${w.number(s.s)} / 2) / ${w.number(s.d)} = ${w.number(t)}`, `fov = ${w.number(2 * Math.atan(t) * DEGREES, 2)}°`];
  },
};

// ---- size and real size: d/z ----
const size = {
  size: [640, 340],
  state: { d: 200, z: 400, zoom: 1 },
  draw(s, say) {
    const eye = [40, 170], k = 0.62, x = eye[0] + k * s.d, X = eye[0] + k * s.z, h = 80, image = (h * s.d) / s.z;
    let html = line(eye, [630, 170], "soft thin");
    const reach = Math.max(x, X) - eye[0], slope = h / (k * s.z);
    html += line(eye, [eye[0] + reach, 170 - slope * reach], "ray") + line([x, 30], [x, 310], "plane");
    html += line([X, 170], [X, 170 - h], "object-line thick") + line([x, 170], [x, 170 - image], "image thick");
    html += handle("plane", [x, 300]) + handle("object", [X, 170 - h]);
    html += label([X + 8, 164 - h / 2], say("object", "oggetto"), "") + label([x + 8, 164 - image], say("image", "immagine"), "image-name");
    html += line([eye[0], 196], [X, 196], "soft thin") + label([X - 8, 212], "z", "name", "end") + line([eye[0], 226], [x, 226], "soft thin") + label([x - 8, 242], "d", "name", "end");
    const ratio = s.d / s.z, word = Math.abs(ratio - 1) < 0.005 ? say("as large as the object", "grande quanto l'oggetto") : ratio < 1 ? say("smaller than the object", "più piccola dell'oggetto") : say("larger than the object", "più grande dell'oggetto");
    return html + eyeMark(eye) + label([628, 330], word, "name", "end");
  },
  drag(s, name, [dx]) {
    if (name === "plane") return { ...s, d: s.d + dx / 0.62 };
    return name === "object" ? { ...s, z: s.z + dx / 0.62 } : null;
  },
  numbers: (s, w) => [`d / z = ${w.number(s.d)} / ${w.number(s.z)} = ${w.number(s.d / s.z, 3)}`,
    `zoom · d / z = ${w.number(s.zoom)} · ${w.number(s.d / s.z, 3)} = ${w.number((s.zoom * s.d) / s.z, 3)}`],
};

// ---- property 2: the object turns; from above, and its image ----
const turning = {
  size: [640, 380],
  state: { angle: 30, z: 500, d: 500 },
  // x of both edges in the image, and half of their heights: the right edge comes nearer.
  edges({ angle, z, d }) {
    const a = angle / DEGREES, near = z - 50 * Math.sin(a), far = z + 50 * Math.sin(a), c = 50 * Math.cos(a);
    return { left: (-d * c) / far, right: (d * c) / near, low: (d * 50) / far, high: (d * 50) / near };
  },
  draw(s, say) {
    const eye = [170, 350], k = 0.52, a = s.angle / DEGREES, y = 350 - k * s.z, c = [170, y], half = 50, e = this.edges(s);
    const p = [c[0] + half * Math.cos(a), c[1] + half * Math.sin(a) * k / k], q = [c[0] - half * Math.cos(a), c[1] - half * Math.sin(a)];
    const top = 350 - k * Math.min(s.d, 560), flat = (end) => { const t = (top - 350) / (end[1] - 350); return [170 + t * (end[0] - 170), top]; };
    let html = line([20, top], [320, top], "plane") + line(eye, p, "ray thin") + line(eye, q, "ray thin");
    if (top < Math.max(p[1], q[1])) html += line(p, flat(p), "ray thin dashed") + line(q, flat(q), "ray thin dashed");
    html += line(flat(q), flat(p), "image thick") + line(q, p, "object-line thick") + handle("side", p) + label([p[0] + 14, p[1] - 4], `${Math.round(s.angle)}°`, "name");
    html += label([24, top - 6], "view plane", "plane-name") + eyeMark(eye) + label([170, 20], say("from above", "dall'alto"), "", "middle");
    const m = [490, 190], f = 1.1, g = (x, v) => [m[0] + f * x, m[1] - f * v];
    html += rectangle(350, 60, 280, 260, "window") + label([490, 46], say("the image", "l'immagine"), "", "middle");
    return html + polygon([g(e.left, -e.low), g(e.right, -e.high), g(e.right, e.high), g(e.left, e.low)], "object");
  },
  drag(s, name, _, [x, y]) {
    if (name !== "side") return null;
    const a = Math.atan2(y - (350 - 0.52 * s.z), x - 170) * DEGREES;
    return { ...s, angle: Math.min(90, Math.max(0, a)) };
  },
  numbers(s, w) {
    const e = this.edges(s), a = `${w.number(s.angle)}°`, f = w.number(s.d);
    return [`x_l = −${f} · 50 cos ${a} / (${w.number(s.z)} + 50 sin ${a}) = ${w.number(e.left, 2)}`, `x_r = ${f} · 50 cos ${a} / (${w.number(s.z)} − 50 sin ${a}) = ${w.number(e.right, 2)}`,
            `x_r − x_l = ${w.number(e.right - e.left, 2)}`];
  },
};

// ---- the view plane and the retina ----
// A sphere at angle theta whose radius is seen under alpha: its image on the plane at distance d is an ellipse with the axes
// below; on a sphere about the eye it is a circle.
export function sphereImage({ theta, alpha }) {
  const t = theta / DEGREES, a = alpha / DEGREES, c = Math.cos(t) ** 2 - Math.sin(a) ** 2;
  const long = (Math.sin(a) * Math.cos(a)) / c, wide = Math.sin(a) / Math.sqrt(c);
  return { long, wide, ratio: long / wide, middle: (Math.sin(t) * Math.cos(t)) / c };
}

const retina = {
  size: [640, 470],
  state: { theta: 40, alpha: 10 },
  draw(s, say) {
    const eye = [40, 420], d = 130, far = 230, e = sphereImage(s), t = s.theta / DEGREES, a = s.alpha / DEGREES;
    const at = (angle, r) => [eye[0] + r * Math.cos(angle), eye[1] - r * Math.sin(angle)], onPlane = (angle) => [eye[0] + d, eye[1] - d * Math.tan(angle)];
    let html = line([eye[0] + d, 0], [eye[0] + d, 465], "plane") + arc(eye, d, -0.33, 1.45, "arc thick retina") + line(eye, [630, 420], "soft dashed");
    const others = s.theta > 2 ? [0] : [];
    for (const angle of [...others, t]) {
      const marked = angle === t, kind = marked ? "object" : "object faint", r = far * Math.sin(a);
      html += circle(at(angle, far), r, kind) + line(eye, at(angle + a, far), marked ? "ray thin" : "soft thin") + line(eye, at(angle - a, far), marked ? "ray thin" : "soft thin");
      html += line(onPlane(angle - a), onPlane(angle + a), "image thick") + arc(eye, d, angle - a, angle + a, "onretina");
    }
    html += arc(eye, 60, 0, t, "arc") + label([eye[0] + 66, eye[1] - 12], "θ", "name") + handle("sphere", at(t, far));
    html += label([eye[0] + d + 8, 460], say("flat view plane", "view plane piano"), "plane-name") + label([eye[0] + 10, 268], say("retina", "retina"), "retina-name");
    html += rectangle(440, 60, 180, 180, "window") + label([530, 48], say("image on the plane", "immagine sul piano"), "", "middle");
    const k = 80 / Math.max(e.long, e.wide, 0.3);
    html += `<ellipse class="image" cx="530" cy="150" rx="${(k * e.wide).toFixed(1)}" ry="${(k * e.long).toFixed(1)}"/>`;
    return html + label([530, 262], say("on the retina: a circle", "sulla retina: un cerchio"), "small", "middle") + eyeMark(eye);
  },
  drag(s, name, _, [x, y]) {
    return name === "sphere" ? { ...s, theta: Math.min(60, Math.max(0, Math.atan2(420 - y, x - 40) * DEGREES)) } : null;
  },
  numbers(s, w) {
    const e = sphereImage(s);
    return [`a / b = cos α / √(cos² θ − sin² α) = ${w.number(e.ratio, 3)}`, `a = ${w.number(e.long, 3)} d   b = ${w.number(e.wide, 3)} d`, `1 / cos θ = ${w.number(1 / Math.cos(s.theta / DEGREES), 3)}`];
  },
};

// ---- the film behind the hole ----
const film = {
  size: [640, 360],
  state: { d: 130, z: 260, hole: 0 },
  draw(s, say) {
    const hole = [270, 180], h = 90, X = hole[0] + s.z, x = hole[0] - s.d, image = (h * s.d) / s.z, front = hole[0] + s.d;
    let html = line([20, 180], [630, 180], "soft dashed") + line([hole[0], 20], [hole[0], 180 - s.hole / 2 - 3], "ink thick") + line([hole[0], 183 + s.hole / 2], [hole[0], 340], "ink thick");
    html += rectangle(x - 10, 30, hole[0] - x + 10, 300, "box");
    html += arrow([X, 180], [X, 180 - h], "object-line thick") + label([X + 8, 176 - h], say("object", "oggetto"));
    for (const side of s.hole > 0 ? [-1, 1] : [0]) {
      const through = 180 + (side * s.hole) / 2, end = through + ((through - (180 - h)) * s.d) / s.z, base = through + ((through - 180) * s.d) / s.z;
      html += line([X, 180 - h], [x, end], "ray") + line([X, 180], [x, base], "ray thin");
    }
    const blur = s.hole * (1 + s.d / s.z);
    html += line([x, 40], [x, 320], "plane thick") + arrow([x, 180], [x, 180 + image], "image thick");
    if (s.hole > 0) html += line([x, 180 + image - blur / 2], [x, 180 + image + blur / 2], "image faint thick");
    html += line([front, 60], [front, 300], "plane dashed") + arrow([front, 180], [front, 180 - image], "image thick");
    html += handle("film", [x, 320]) + handle("object", [X, 180 - h]);
    html += label([x, 352], say("film: upside down", "pellicola: capovolta"), "plane-name", "middle") + label([front + 6, 318], say("view plane: upright", "view plane: diritta"), "plane-name");
    return html + label([hole[0], 14], say("the hole is e", "il foro è e"), "name", "middle");
  },
  drag(s, name, [dx]) {
    if (name === "film") return { ...s, d: s.d - dx };
    return name === "object" ? { ...s, z: s.z + dx } : null;
  },
  numbers: (s, w, say) => [`y_${say("film", "pellicola")} = −90 d / z = −90 · ${w.number(s.d)} / ${w.number(s.z)} = ${w.number((-90 * s.d) / s.z, 1)}`, `y_${say("plane", "piano")} = 90 d / z = ${w.number((90 * s.d) / s.z, 1)}`,
    `b = h (1 + d / z) = ${w.number(s.hole)} (1 + ${w.number(s.d / s.z, 3)}) = ${w.number(s.hole * (1 + s.d / s.z), 2)}`],
};

export const planeDrawings = { field_of_view: fieldOfView, size, turning, retina, film };
