// Mouse, touch and keyboard on the stage, for the tool that is chosen.
import * as steer from "./steer.js";

export const tools = [
  { name: "orbit", label: "Orbit", key: "1", title: "drag turns the camera round lookat; Shift or the right button: pan; Ctrl: look round; wheel: nearer, farther (1)" },
  { name: "look", label: "Look", key: "2", title: "drag looks round from where the camera is (2)" },
  { name: "inspect", label: "Inspect", key: "3", title: "the wheel magnifies, drag moves the image, a click picks a pixel (3)" },
  { name: "turn", label: "Turn", key: "4", title: "click a point: the camera turns round it (4)" },
  { name: "focus", label: "Focus", key: "5", title: "click a point: the lens focuses on it (5)" },
  { name: "crop", label: "Crop", key: "6", title: "drag a rectangle: only it is rendered; a click: the whole image (6)" },
];

export class Pointer {
  // app: camera(), edit(set, gesture), next(), pick(x, y, kind), crop(rectangle), hover(x, y), screen, tool
  constructor(stage, app) {
    this.stage = stage;
    this.app = app;
    this.points = new Map();
    stage.addEventListener("pointerdown", event => this.down(event));
    stage.addEventListener("pointermove", event => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) stage.addEventListener(name, event => this.up(event));
    stage.addEventListener("pointerleave", () => app.hover(-1, -1));
    stage.addEventListener("contextmenu", event => event.preventDefault());
    stage.addEventListener("wheel", event => this.wheel(event), { passive: false });
    stage.addEventListener("dblclick", event => { if (event.target.id === "screen") this.pick(event, "turn"); });
  }

  place(event) {
    const box = this.app.screen.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  down(event) {
    if (event.target.closest("button")) return;
    this.stage.focus({ preventScroll: true });
    this.stage.setPointerCapture(event.pointerId);
    if (!this.points.size) this.gesture = this.app.next();
    this.points.set(event.pointerId, { at: this.place(event), start: this.place(event), moved: false });
    this.stage.classList.add("dragging");
    event.preventDefault();
  }

  move(event) {
    const point = this.points.get(event.pointerId), at = this.place(event);
    if (!point) { this.app.hover(...this.app.screen.frame ? this.app.screen.toImage(...at) : [-1, -1]); return; }
    const dx = at[0] - point.at[0], dy = at[1] - point.at[1];
    if (!point.moved && Math.hypot(at[0] - point.start[0], at[1] - point.start[1]) < 4) return;
    point.moved = true;
    const before = [...this.points.values()].map(p => p.at);
    point.at = at;
    if (!this.app.screen.frame) return;
    if (this.points.size === 2) this.pinch(before, [...this.points.values()].map(p => p.at));
    else if (this.points.size === 1) this.drag(event, point, dx, dy);
  }

  drag(event, point, dx, dy) {
    const c = this.app.camera(), tool = this.app.tool, k = this.app.screen.factor();
    if (tool === "inspect") return this.app.screen.shift(dx, dy);
    if (tool === "crop") return this.app.band(this.rectangle(point.start, point.at));
    const pan = event.shiftKey || event.buttons & 6, around = event.ctrlKey || event.metaKey || tool === "look";
    const angle = Math.PI / this.stage.clientHeight;
    this.app.edit(pan ? steer.pan(c, dx / k, dy / k) : around ? steer.look(c, -dx / c.fx / k, -dy / c.fy / k)
      : steer.orbit(c, dx * angle, dy * angle), this.gesture);
  }

  // Two fingers: nearer or farther, pan, roll.
  pinch(before, after) {
    const span = p => Math.hypot(p[1][0] - p[0][0], p[1][1] - p[0][1]), k = this.app.screen.factor();
    const turn = p => Math.atan2(p[1][1] - p[0][1], p[1][0] - p[0][0]);
    const mid = p => [(p[0][0] + p[1][0]) / 2, (p[0][1] + p[1][1]) / 2];
    const [a, b] = [mid(before), mid(after)], ratio = span(after) / Math.max(1, span(before));
    if (this.app.tool === "inspect") {
      this.app.screen.shift(b[0] - a[0], b[1] - a[1]);
      return this.app.screen.zoomBy(ratio, ...b);
    }
    this.app.edit(steer.pan(this.app.camera(), (b[0] - a[0]) / k, (b[1] - a[1]) / k), this.gesture);
    this.app.edit(steer.dolly(this.app.camera(), 1 / ratio), this.gesture);
    const degrees = (turn(after) - turn(before)) * 180 / Math.PI;
    if (Math.abs(degrees) < 90) this.app.edit(steer.roll(this.app.camera(), -degrees), this.gesture);
  }

  up(event) {
    const point = this.points.get(event.pointerId);
    this.points.delete(event.pointerId);
    if (!this.points.size) this.stage.classList.remove("dragging");
    if (!point || event.type === "pointercancel") return;
    if (this.app.tool === "crop") {
      this.app.band(null);
      return this.app.crop(point.moved ? this.rectangle(point.start, point.at) : null);
    }
    if (!point.moved && event.button === 0) this.pick(event, this.app.tool);
  }

  pick(event, kind) {
    if (!this.app.screen.frame) return;
    const [x, y] = this.app.screen.toImage(...this.place(event)), f = this.app.screen.frame;
    if (x >= 0 && y >= 0 && x < f.width && y < f.height) this.app.pick(x, y, kind);
  }

  // Whole pixels of the image between two places of the page.
  rectangle(a, b) {
    const f = this.app.screen.frame, p = this.app.screen.toImage(...a), q = this.app.screen.toImage(...b);
    const clamp = (v, most) => Math.max(0, Math.min(most, v));
    return [clamp(Math.floor(Math.min(p[0], q[0])), f.width - 1), clamp(Math.floor(Math.min(p[1], q[1])), f.height - 1),
      clamp(Math.ceil(Math.max(p[0], q[0])), f.width), clamp(Math.ceil(Math.max(p[1], q[1])), f.height)];
  }

  wheel(event) {
    event.preventDefault();
    if (!this.app.screen.frame) return;
    const step = event.deltaMode === 1 ? 33 * event.deltaY : event.deltaY, factor = Math.exp(0.0012 * step);
    if (event.ctrlKey || this.app.tool === "inspect") return this.app.screen.zoomBy(1 / factor ** 1.6, ...this.place(event));
    this.app.edit(steer.dolly(this.app.camera(), factor), this.points.size ? this.gesture : this.app.gestures.burst("wheel", 400));
  }
}

export const keys = [
  ["Arrows", "orbit; with Shift: look round"], ["W A S D", "fly forward, left, back, right"], ["Q E", "fly down, up"],
  ["+ −", "nearer, farther"], [", .", "roll"], ["Z, Shift+Z", "undo, redo"], ["Home", "the scene's camera"],
  ["P", "pause"], ["N", "denoised or as sampled"], ["Enter", "pick a pixel: arrows, by 10 with Shift; Enter; Esc"], ["O", "the camera from outside"], ["1 … 6", "tools"], ["0", "the whole image"], ["[ ]", "exposure"], ["Esc", "no rectangle, no message"],
];

// Whether the element that has the focus needs a key itself.
export function keepsKey(element, key) {
  if (element.closest("input[type=range]")) return /^(Arrow|Home|End|Page)/.test(key);
  if (element.closest("button, summary, a, input[type=checkbox], input[type=file]")) return key === "Enter" || key === " ";
  return Boolean(element.closest("input, select, textarea"));
}

// What a key does on the page; null: nothing.
export function keyAction(event, app) {
  const c = app.camera(), step = 0.06, tool = tools.find(t => t.key === event.key);
  const turn = event.shiftKey ? steer.look : steer.orbit, sign = event.shiftKey ? 1 : -1;
  const moves = {
    ArrowLeft: () => turn(c, sign * step, 0), ArrowRight: () => turn(c, -sign * step, 0),
    ArrowUp: () => turn(c, 0, sign * step), ArrowDown: () => turn(c, 0, -sign * step),
    w: () => steer.fly(c, 0, 0, step), s: () => steer.fly(c, 0, 0, -step), a: () => steer.fly(c, -step, 0, 0),
    d: () => steer.fly(c, step, 0, 0), q: () => steer.fly(c, 0, -step, 0), e: () => steer.fly(c, 0, step, 0),
    "+": () => steer.dolly(c, 0.93), "=": () => steer.dolly(c, 0.93), "-": () => steer.dolly(c, 1 / 0.93),
    ",": () => steer.roll(c, -2), ".": () => steer.roll(c, 2),
  };
  const commands = {
    o: app.seeOutside, z: app.undo, Z: app.redo, Home: app.reset, p: app.pause, n: app.denoise, 0: app.wholeImage, Escape: app.escape,
    "[": () => app.expose(-0.25), "]": () => app.expose(0.25),
  };
  if (event.ctrlKey || event.metaKey || event.altKey) return null;
  if (tool) return () => app.choose(tool.name);
  if (moves[event.key]) return () => app.edit(moves[event.key](), app.gestures.burst("keys", 600));
  return commands[event.key] || null;
}
