// The camera from outside: the scene, rendered small, and over it eye, view plane, pyramid and axes. Dragging the eye
// moves e, dragging the view plane moves d, dragging elsewhere turns the view.
import { add, cross, dot, length, scale, sub, unit } from "./vec.js";
import { orbit, takePose } from "./steer.js";
import { byId, make } from "./dom.js";

const fov = 40 * Math.PI / 180; // vertical; as apps/velo/view/engine_outside.c
const looks = { eye: ["#f5a623", 3], window: ["#f5a623", 2], grid: ["#f5a62366", 0.6], volume: ["#fff", 1], near: ["#7fd1ff", 1.4],
  far: ["#7fd1ff", 1.4], distance: ["#f5a623", 1.2], focus: ["#ff7ad1", 1.2], projector: ["#9cff7a", 1.4], axes: ["#e5484d", 2], film: ["#f5a623", 1],
  path: ["#ffd24a", 1.8], leaves: ["#9fb4c8", 1.2, [2, 4]], light: ["#fff3b0", 1.1, [5, 3]], occluded: ["#c0566a", 0.8, [2, 3]] };

const basis = ["#ff8a80", "#7fe09a", "#8fb4ff"]; // u, v, w: the same on the lecture's page

// Of the cameras of a trajectory.
const strings = { volume: ["#8fd3c7", 0.7], window: ["#8fd3c7", 1], eye: ["#8fd3c7", 4], path: ["#8fd3c799", 1.4] };
const eyeOf = m => [m[3], m[7], m[11]];

export class Outside {
  // stage: the element that it is in; button: shows and hides it; null: none.
  constructor(app, stage = byId("stage"), button = byId("outside-toggle")) {
    this.app = app;
    this.canvas = make("canvas", { title: "Drag the eye: e. Drag the view plane: d. Drag elsewhere: turn. Click a camera of the trajectory: go there. Wheel: nearer, farther" });
    this.box = make("div", { id: "outside" }, this.canvas);
    this.box.hidden = true;
    this.string = { poses: [], lines: [] };
    stage.append(this.box);
    this.button = button;
    if (button) button.onclick = () => this.toggle();
    for (const [name, action] of [["pointerdown", "down"], ["pointermove", "move"], ["pointerup", "up"], ["wheel", "wheel"]])
      this.box.addEventListener(name, event => { event.stopPropagation(); this[action](event); }, { passive: false });
    this.box.addEventListener("dblclick", event => event.stopPropagation());
  }

  open() { if (this.box.hidden) this.toggle(); }
  toggle() {
    if (!this.app.camera()) return;
    this.box.hidden = !this.box.hidden;
    this.button?.setAttribute("aria-pressed", String(!this.box.hidden));
    this.drawing = null; // it is not of the present camera
    if (!this.box.hidden) this.app.ask({ type: "cameras" }, answer => { this.begin(answer); });
  }

  // The cameras of --trajectory are known: the pane begins with a view of all.
  begin(answer) {
    this.string = answer.poses ? answer : { poses: [], lines: [] };
    this.pose ??= this.start();
    this.outline();
    this.render();
  }

  // From the side, a little above and behind, so that eye and scene are both seen.
  start() {
    const c = this.app.camera(), arm = sub(c.lookat, c.eye), n = length(arm), forward = unit(arm), up = unit(c.up);
    const right = unit(cross(forward, up)), middle = add(c.eye, scale(arm, 0.5));
    const from = unit(add(add(scale(right, 1), scale(up, 0.55)), scale(forward, -0.35)));
    const others = this.string.poses.map(m => length(sub(eyeOf(m), middle))), reach = Math.max(2.1 * n, 2.6 * Math.max(0, ...others));
    return { eye: add(middle, scale(from, reach)), lookat: middle, up, world_from_camera: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0] };
  }

  // The camera changed: its lines are drawn anew.
  state() { if (!this.box.hidden && this.pose) this.outline(); }
  // The scene was loaded again.
  loaded() { if (!this.box.hidden) this.app.ask({ type: "cameras" }, answer => { this.begin(answer); }); }

  outline() {
    if (this.asked) { this.again = true; return; }
    this.asked = true;
    const set = this.point ? { point: this.point } : {}, { d, projection } = this.app.camera();
    if (this.projection === projection && typeof d === "number") set.plane = this.scale * d; // the plane is drawn at d, or in its proportion
    this.app.ask({ type: "outline", set }, answer => {
      this.asked = false;
      if (answer.type === "outline") {
        this.drawing = answer;
        // d of the camera that was drawn: the page's may be ahead of it while it is dragged
        if (set.plane !== answer.plane) this.scale = answer.plane / (answer.d > 0 ? answer.d : d);
        this.projection = projection;
        this.draw();
      }
      if (this.again) { this.again = false; this.outline(); }
    });
  }

  render() {
    if (this.rendering) { this.newer = true; return; }
    this.rendering = true;
    const { eye, lookat, up } = this.pose, size = this.size().map(v => Math.round(0.6 * v)), exposure = this.app.display.ev;
    this.app.ask({ type: "outside", set: { eye, lookat, up }, size, exposure }, answer => {
      this.rendering = false;
      if (answer.type === "outside") {
        const image = new Image();
        image.onload = () => { this.image = image; this.draw(); };
        image.src = `data:image/jpeg;base64,${answer.data}`;
      }
      if (this.newer) { this.newer = false; this.render(); }
    });
  }

  size() { const b = this.box.getBoundingClientRect(); return [Math.max(32, b.width - 2), Math.max(32, b.height - 2)]; }

  axes() {
    const forward = unit(sub(this.pose.lookat, this.pose.eye)), right = unit(cross(forward, this.pose.up));
    return { forward, right, up: cross(right, forward) };
  }

  // The place of a point in the pane, with its depth.
  project(p) {
    const [w, h] = this.size(), a = this.axes(), v = sub(p, this.pose.eye), z = dot(v, a.forward), f = 0.5 * h / Math.tan(fov / 2);
    return [w / 2 + f * dot(v, a.right) / z, h / 2 - f * dot(v, a.up) / z, z];
  }

  // A segment in space, cut at the pane's own eye.
  stroke(g, a, b, [colour, width, dash], alpha = 1) {
    const near = 0.02 * length(sub(this.pose.lookat, this.pose.eye)), forward = this.axes().forward;
    const depth = p => dot(sub(p, this.pose.eye), forward), za = depth(a), zb = depth(b);
    const cut = (p, q, zp, zq) => add(p, scale(sub(q, p), (near - zp) / (zq - zp)));
    if (za < near && zb < near) return;
    if (za < near) a = cut(a, b, za, zb); else if (zb < near) b = cut(b, a, zb, za);
    const [p, q] = [this.project(a), this.project(b)];
    g.strokeStyle = colour;
    g.lineWidth = width;
    g.lineCap = "round";
    g.globalAlpha = alpha;
    g.setLineDash(dash || []);
    g.beginPath();
    g.moveTo(p[0], p[1]);
    g.lineTo(q[0] + (p[0] === q[0] && p[1] === q[1] ? 0.01 : 0), q[1]);
    g.stroke();
    g.globalAlpha = 1;
  }

  // The paths of the picked pixel; the chosen one is stronger.
  drawPaths(g) {
    for (const [kind, chosen, from, to] of this.app.paths?.lines ?? []) {
      const [colour, width, dash] = looks[kind];
      this.stroke(g, from, to, [colour, chosen ? width : 0.6 * width, dash], chosen ? 1 : 0.4);
      if (chosen && kind === "path") this.stroke(g, to, to, [colour, 5]);
    }
    g.setLineDash([]);
  }

  draw() {
    if (this.box.hidden || !this.pose) return;
    const [w, h] = this.size(), g = this.canvas.getContext("2d"), ratio = window.devicePixelRatio || 1, d = this.drawing;
    this.canvas.width = w * ratio;
    this.canvas.height = h * ratio;
    g.scale(ratio, ratio);
    if (this.image) g.drawImage(this.image, 0, 0, w, h);
    g.fillStyle = "#0006";
    g.fillRect(0, 0, w, h);
    let axis = 0; // u, v, w
    for (const [part, ...n] of d?.lines || []) this.stroke(g, n.slice(0, 3), n.slice(3), part === "axes" ? [basis[axis++ % 3], 2.4] : looks[part] || ["#fff", 1]);
    for (const [part, ...n] of this.string.lines || []) this.stroke(g, n.slice(0, 3), n.slice(3), strings[part] || strings.volume);
    this.drawPaths(g);
    g.font = "italic 14px serif";
    for (const [text, ...at] of d?.labels || []) {
      const p = this.project(at);
      if (p[2] <= 0) continue;
      g.strokeStyle = "#000c";
      g.lineWidth = 3;
      g.strokeText(text, p[0] + 6, p[1] - 5);
      g.fillStyle = basis["uvw".indexOf(text)] ?? "#fff", g.fillText(text, p[0] + 6, p[1] - 5);
    }
    this.handles = {};
    if (!d) return;
    const c = this.app.camera(), towards = unit(sub(c.lookat, c.eye));
    this.handles = { eye: c.eye, plane: add(c.eye, scale(towards, d.plane)) };
    for (const at of Object.values(this.handles)) {
      const p = this.project(at);
      g.fillStyle = "#f5a623";
      g.strokeStyle = "#fff";
      g.lineWidth = 1.5;
      g.beginPath();
      g.arc(p[0], p[1], 6, 0, 7);
      g.fill();
      g.stroke();
    }
  }

  place(event) { const b = this.canvas.getBoundingClientRect(); return [event.clientX - b.x, event.clientY - b.y]; }

  down(event) {
    event.preventDefault();
    this.box.setPointerCapture(event.pointerId);
    const at = this.place(event), near = name => {
      const p = this.handles?.[name] && this.project(this.handles[name]);
      return p && Math.hypot(p[0] - at[0], p[1] - at[1]) < 14;
    };
    this.grip = near("eye") ? "eye" : near("plane") ? "plane" : "turn";
    this.moved = false;
    this.last = at;
    this.gesture = this.app.next();
  }

  move(event) {
    if (!this.grip) return;
    const at = this.place(event), dx = at[0] - this.last[0], dy = at[1] - this.last[1], c = this.app.camera();
    const [, h] = this.size(), f = 0.5 * h / Math.tan(fov / 2), a = this.axes();
    this.last = at;
    this.moved ||= Math.hypot(dx, dy) > 2;
    if (this.grip === "turn") {
      Object.assign(this.pose, orbit(this.pose, dx * 0.01, dy * 0.01));
      this.image = null;
      this.draw();
      return this.render();
    }
    if (this.grip === "eye") {
      const k = this.project(c.eye)[2] / f;
      return this.app.edit({ eye: add(c.eye, add(scale(a.right, dx * k), scale(a.up, -dy * k))) }, this.gesture);
    }
    // along the axis: the plane follows the pointer, and d is in its proportion
    const towards = unit(sub(c.lookat, c.eye)), plane = this.handles.plane, p = this.project(plane);
    const q = this.project(add(plane, scale(towards, 0.01 * this.drawing.plane))), n = Math.hypot(q[0] - p[0], q[1] - p[1]) || 1;
    const step = (dx * (q[0] - p[0]) + dy * (q[1] - p[1])) / n / n * 0.01;
    if (typeof c.d === "number") this.app.edit({ d: c.d * Math.max(0.1, 1 + step) }, this.gesture);
  }

  up() {
    if (this.grip === "turn" && !this.moved) this.take();
    this.grip = null;
  }

  // A click on an eye of the trajectory: the camera takes its pose, and looks as far as before.
  take() {
    const near = m => { const p = this.project(eyeOf(m)); return p[2] > 0 ? Math.hypot(p[0] - this.last[0], p[1] - this.last[1]) : Infinity; };
    const m = this.string.poses.reduce((a, b) => near(b) < (a ? near(a) : 12) ? b : a, null);
    if (!m) return;
    this.app.edit(takePose(this.app.camera(), m), this.gesture);
  }

  wheel(event) {
    event.preventDefault();
    const arm = sub(this.pose.eye, this.pose.lookat);
    this.pose.eye = add(this.pose.lookat, scale(arm, Math.exp(0.001 * event.deltaY)));
    this.image = null;
    this.draw();
    this.render();
  }
}
