// Drawings over the image: the rectangle of a crop, axes and vanishing points, horizon, ground grid, boxes of objects.
import { byId, make, short } from "./dom.js";

const NS = "http://www.w3.org/2000/svg";
const colours = ["#e5484d", "#46a758", "#3e7bfa"];
const choices = [["axes", "axes at lookat"], ["vanishing", "vanishing points"], ["horizon", "horizon"],
  ["grid", "ground grid"], ["distortion", "distortion field"], ["boxes", "boxes and names"], ["centre", "principal point"]];

function element(tag, properties, text) {
  const e = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(properties)) e.setAttribute(name, value);
  if (text !== undefined) e.textContent = text;
  return e;
}

export class Overlay {
  constructor(root, app) {
    this.app = app;
    this.svg = byId("overlay");
    this.on = new Set();
    for (const [name, label] of choices) {
      const box = make("input", { type: "checkbox", id: `overlay-${name}`, onchange: () => this.toggle(name, box.checked) });
      root.append(make("div", { class: "check" }, box, make("label", { textContent: label, htmlFor: box.id })));
    }
  }

  toggle(name, on) {
    if (on) this.on.add(name); else this.on.delete(name);
    this.ask();
    this.draw();
  }

  // The camera changed: what velo computes is asked for again. Boxes need a pass over the scene: they wait until the
  // changes pause.
  state(state) {
    this.camera = state.camera;
    this.bounds = state.bounds;
    if (this.straight) this.answer = null;
    else if (this.answer) this.answer.boxes = null;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.ask(), 150);
    if (!this.straight) this.ask(false);
    this.draw();
  }
  ask(boxes = true) {
    if (![...this.on].some(name => name !== "centre")) return;
    if (this.asked) { this.again = true; return; }
    this.asked = true;
    const message = { type: "overlay", boxes: boxes && this.on.has("boxes"), curves: !this.straight, field: this.on.has("distortion") };
    this.app.ask(message, answer => {
      this.asked = false;
      if (answer.type === "overlay") { this.answer = answer; this.draw(); }
      if (this.again) { this.again = false; this.ask(); }
    });
  }

  band(rectangle) { this.rectangle = rectangle; this.draw(); }
  cross(pixel) { this.crossAt = pixel; this.draw(); }

  draw() {
    this.svg.replaceChildren();
    if (!this.app.screen.frame || !this.camera) return;
    if (this.rectangle) this.box(this.rectangle, { stroke: "#fff", "stroke-width": 1.5, "stroke-dasharray": "5 4", fill: "#fff2" });
    for (const name of this.on) this[name]?.();
    if (this.crossAt) this.drawCross(...this.crossAt);
  }

  box(b, style) {
    const [x, y] = this.app.screen.toPage(b[0], b[1]), [u, v] = this.app.screen.toPage(b[2], b[3]);
    this.svg.append(element("rect", { x, y, width: Math.max(0, u - x), height: Math.max(0, v - y), fill: "none", ...style }));
  }
  // Round a pixel, in two colours, so that it is seen on every image.
  drawCross(x, y) {
    const [left, top] = this.app.screen.toPage(x + 0.5, y + 0.5), gap = Math.max(4, this.app.screen.factor() / 2 + 2);
    for (const [stroke, width] of [["#000", 4], ["#fff", 1.6]])
      for (const [u, v] of [[1, 0], [-1, 0], [0, 1], [0, -1]])
        this.svg.append(element("line", { class: "cross", x1: left + gap * u, y1: top + gap * v, x2: left + (gap + 11) * u, y2: top + (gap + 11) * v, stroke, "stroke-width": width }));
  }
  line(a, b, style) {
    const [x1, y1] = this.app.screen.toPage(...a), [x2, y2] = this.app.screen.toPage(...b);
    this.svg.append(element("line", { x1, y1, x2, y2, "stroke-width": 1.5, ...style }));
  }
  label(at, text) {
    const [x, y] = this.app.screen.toPage(...at);
    for (const style of [{ stroke: "#000b", "stroke-width": 4, fill: "none" }, { fill: "#fff" }])
      this.svg.append(element("text", { x: x + 5, y: y - 4, "font-size": 12, "font-family": "system-ui", ...style }, text));
  }

  // The pixel of a point, for straight projections without distortion; null behind the camera.
  project(p) {
    const c = this.camera, m = c.camera_from_world;
    const q = [0, 1, 2].map(i => m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3]);
    const w = c.projection === "orthographic" ? 1 : q[2];
    if (w <= 1e-6) return null;
    return [c.fx * q[0] / w + c.skew * q[1] / w + c.cx, c.fy * q[1] / w + c.cy];
  }
  get straight() {
    return ["perspective", "orthographic"].includes(this.camera.projection) && this.camera.distortion === "none";
  }
  // A segment in space, in parts so that only what is behind the camera is missing.
  segment(a, b, style) {
    const mix = t => [0, 1, 2].map(i => a[i] + t * (b[i] - a[i])), n = 24;
    for (let i = 0, last = this.project(a); i < n; i++) {
      const next = this.project(mix((i + 1) / n));
      if (last && next && Math.abs(next[0]) + Math.abs(next[1]) < 1e6) this.line(last, next, style);
      last = next;
    }
  }

  get size() { return Math.hypot(...[0, 1, 2].map(i => Math.min(1e4, this.bounds[i + 3] - this.bounds[i]))); }

  // Curves that velo computed: names and the points of each.
  curves(list, style) {
    for (const [name, ...points] of list || []) {
      const place = points.map((v, i) => i % 2 ? this.app.screen.toPage(points[i - 1], v) : null).filter(Boolean);
      this.svg.append(element("polyline", { points: place.map(p => p.map(v => v.toFixed(1)).join(",")).join(" "), fill: "none", "stroke-width": 1.5, ...style(name) }));
    }
  }
  axisStyle(name) { return { stroke: colours["xyz".indexOf(name)] }; }

  axes() {
    if (!this.straight) {
      const list = this.answer?.curves?.axes || [];
      this.curves(list, name => ({ ...this.axisStyle(name), "stroke-width": 2 }));
      for (const curve of list) this.label(curve.slice(-2), curve[0]);
      return;
    }
    const o = this.camera.lookat, n = 0.25 * Math.hypot(...[0, 1, 2].map(i => o[i] - this.camera.eye[i]));
    for (let i = 0; i < 3; i++) {
      const end = o.map((v, k) => v + (k === i ? n : 0)), at = this.project(end);
      this.segment(o, end, { stroke: colours[i], "stroke-width": 2 });
      if (at) this.label(at, "xyz"[i], colours[i]);
    }
  }

  grid() {
    if (!this.straight) return this.curves(this.answer?.curves?.grid, name => ({ stroke: "#fff8", "stroke-width": name === "middle" ? 1.4 : 0.8 }));
    const up = this.camera.up.map(Math.abs), k = up.indexOf(Math.max(...up)), [i, j] = [0, 1, 2].filter(n => n !== k);
    const reach = Math.hypot(...[0, 1, 2].map(n => this.camera.lookat[n] - this.camera.eye[n])) * 2;
    const step = 10 ** Math.round(Math.log10(reach / 12)), level = this.bounds[this.camera.up[k] > 0 ? k : k + 3];
    const snap = v => Math.round(v / step) * step, n = 12;
    for (let t = -n; t <= n; t++) {
      for (const [a, b] of [[i, j], [j, i]]) {
        const p = [0, 0, 0], q = [0, 0, 0];
        p[k] = q[k] = Math.abs(level) < 1e6 ? level : 0;
        p[a] = q[a] = snap(this.camera.lookat[a]) + t * step;
        p[b] = snap(this.camera.lookat[b]) - n * step, q[b] = snap(this.camera.lookat[b]) + n * step;
        this.segment(p, q, { stroke: "#fff8", "stroke-width": t ? 0.8 : 1.4 });
      }
    }
  }

  vanishing() {
    if (!this.straight) this.curves(this.answer?.curves?.vanishing, name => ({ ...this.axisStyle(name), "stroke-width": 0.8, "stroke-dasharray": "3 4" }));
    const f = this.app.screen.frame, centre = [f.width / 2, f.height / 2];
    (this.answer?.vanishing || []).forEach((p, i) => {
      if (p.kind !== "finite") return;
      const at = [p.x, p.y], [x, y] = this.app.screen.toPage(...at);
      this.svg.append(element("circle", { cx: x, cy: y, r: 5, fill: colours[i], stroke: "#fff" }));
      if (this.straight) for (const from of [[0, 0], [f.width, 0], [0, f.height], [f.width, f.height], centre])
        this.line(from, at, { stroke: colours[i], "stroke-width": 1, "stroke-dasharray": ["12 3", "6 4", "2 4"][i] });
      this.label(at, "xyz"[i], colours[i]);
    });
  }

  horizon() {
    if (!this.straight) return this.curves(this.answer?.curves?.horizon, () => ({ stroke: "#f5a623" }));
    const h = this.answer?.horizon, f = this.app.screen.frame;
    if (!h || Math.abs(h[1]) < 1e-9 && Math.abs(h[0]) < 1e-9) return;
    const at = Math.abs(h[1]) > Math.abs(h[0]) ? x => [x, -(h[0] * x + h[2]) / h[1]] : y => [-(h[1] * y + h[2]) / h[0], y];
    this.line(at(-9 * f.width), at(10 * f.width), { stroke: "#f5a623" });
  }

  // From where a pinhole would show a point to where the lens shows it.
  distortion() {
    const field = this.answer?.field;
    if (!field) return;
    const f = this.app.screen.frame, most = this.answer.greatest;
    for (const [x0, y0, x, y] of field) {
      const share = Math.hypot(x - x0, y - y0) / (most || 1), stroke = `hsl(${240 - 240 * Math.min(1, share)} 90% 60%)`;
      this.line([x0, y0], [x, y], { stroke, "stroke-width": 1.2 });
      const [cx, cy] = this.app.screen.toPage(x, y);
      this.svg.append(element("circle", { cx, cy, r: 1.8, fill: stroke }));
    }
    this.label([0.02 * f.width, 0.97 * f.height], `distortion: up to ${short(most, 3)} pixels, blue to red; dots: where the lens shows a point`);
  }

  boxes() {
    for (const { box, name, id } of this.answer?.boxes || []) {
      const colour = `hsl(${id * 137 % 360} 80% 65%)`;
      this.box(box, { stroke: colour });
      this.label([box[0], box[1] + 14 / this.app.screen.factor()], name || `${id}`, colour);
    }
  }

  centre() {
    const { cx, cy } = this.camera, k = 8 / this.app.screen.factor();
    this.line([cx - k, cy], [cx + k, cy], { stroke: "#fff" });
    this.line([cx, cy - k], [cx, cy + k], { stroke: "#fff" });
    this.label([cx, cy], "cx, cy", "#fff");
  }
}
