// The page: joins the connection, the image, the camera and the panels.
import { connect, engineName } from "./connection.js";
import { parseFrame } from "./frame.js";
import { Screen } from "./screen.js";
import { Pointer, keepsKey, keyAction, tools } from "./pointer.js";
import { Crosshair } from "./crosshair.js";
import { pivot } from "./steer.js";
import { Panel } from "./panel.js";
import { Display } from "./display.js";
import { Sensor } from "./sensor.js";
import { Inspector } from "./inspect.js";
import { Overlay } from "./overlay.js";
import { Compare } from "./compare.js";
import { Save } from "./save.js";
import { Outside } from "./outside.js";
import { Paths } from "./paths.js";
import { makeTimeline } from "./timeline.js";
import { byId, make, metric, short } from "./dom.js";
import { addHelp } from "./help.js";
import { Gestures } from "./gestures.js";
import { dress } from "./icons.js";

const app = {
  tool: "orbit", change: 0, state: null, local: null, waiting: new Map(), nextId: 1, gestures: new Gestures(), sent: [],

  // The camera as the page has it: velo's last answer and the edits on their way (`sent`, then `queued`).
  camera: () => app.local,

  // Edits the camera. Several edits within one frame of the screen are sent as one.
  edit(set, gesture = 0) {
    if (!app.local || !app.steers || !Object.keys(set).length || app.gestures.isOver(gesture)) return;
    Object.assign(app.local, set);
    if (app.queued && app.queued.gesture !== gesture) app.flush();
    app.queued = { set: { ...app.queued?.set, ...set }, gesture };
    app.timer ??= requestAnimationFrame(app.flush);
  },
  flush() {
    cancelAnimationFrame(app.timer);
    app.timer = null;
    if (!app.queued) return;
    app.sent.push({ change: ++app.change, set: app.queued.set });
    app.connection.send({ type: "camera", change: app.change, gesture: app.queued.gesture, set: app.queued.set });
    app.queued = null;
  },

  // Sends a question; the answer calls back.
  ask(message, answer) {
    const id = app.nextId++;
    if (!app.connected) return void setTimeout(() => answer({ type: "refused", id, message: "velo cannot be reached" }));
    app.waiting.set(id, answer);
    app.connection.send({ ...message, id });
  },

  // A step of the history comes after the edits that were made before it, and ends a drag.
  step(type) {
    app.flush();
    app.gestures.end();
    timeline.end();
    app.connection.send({ type, change: ++app.change });
  },
  undo: () => app.step("undo"),
  redo: () => app.step("redo"),
  reset: () => app.step("reset"),
  pause: () => app.connection.send({ type: "settings", paused: !app.state.paused }),
  denoise: () => app.settings({ denoise: !app.state.denoise }),
  settings: message => app.connection.send({ type: "settings", ...message }),
  wholeImage: () => { screen.zoom = 1; screen.centre = [0.5, 0.5]; screen.draw(); screen.onplace?.(); },
  crop: rectangle => app.settings({ crop: rectangle, change: ++app.change }),
  seeOutside: () => outside.toggle(),
  escape: () => { byId("notice").hidden = true; if (app.cropped) app.crop(null); },
  expose: step => display.expose(step),
  next: () => app.gestures.next(),

  choose(name) {
    app.tool = name;
    byId("stage").dataset.tool = name;
    for (const button of byId("tools").children) button.setAttribute("aria-pressed", String(button.dataset.tool === name));
  },

  pick(x, y, kind) {
    if (kind === "focus") {
      app.focused = ++app.change;
      return app.connection.send({ type: "focus", x, y, change: app.change });
    }
    app.ask({ type: "pick", x, y }, answer => {
      if (answer.type !== "picked") return;
      inspector.picked(answer);
      paths.pick(x, y);
      outside.point = answer.object.id ? answer.P : null;
      outside.state();
      if (kind === "turn" && answer.object.id) app.edit(pivot(app.local, answer.P), app.next());
    });
  },
  hover: (x, y) => inspector.hover(x, y),
  band: rectangle => overlay.band(rectangle),
  cross: pixel => overlay.cross(pixel),
  notice(text, calm = false) {
    const box = byId("notice");
    byId("notice-text").textContent = text;
    box.hidden = !text;
    box.classList.toggle("calm", calm);
    clearTimeout(app.noticeTimer);
    if (calm) app.noticeTimer = setTimeout(() => { box.hidden = true; }, 6000);
  },
};

const screen = app.screen = new Screen(byId("screen"), true);
const slowly = "The processor draws the image, which takes longer.";
if (!screen.gl) app.notice(`This browser has no WebGL2. ${slowly}`, true);
screen.onlost = () => app.notice(`The browser took the graphics processor away. ${slowly}`, true);
screen.onrestored = () => app.notice("");
const panel = new Panel(byId("camera"), app);
const display = app.display = new Display(byId("display"), app);
const sensor = app.sensor = new Sensor(byId("sensor"), app);
const overlay = new Overlay(byId("overlays"), app);
const compare = new Compare(byId("compare"), app);
app.save = new Save(byId("save"), app);
byId("save").hidden = engineName() === "browser"; // it has no folder to save into
byId("denoise").hidden = engineName() === "browser";
const outside = app.outside = new Outside(app);
screen.onplace = () => { overlay.draw(); compare.draw(); };
const inspector = new Inspector(byId("pixel"), app);
const paths = app.paths = new Paths(byId("pixel"), app);
const timeline = app.timeline = makeTimeline(app);
paths.onpaths = () => inspector.texture(paths);
new Pointer(byId("stage"), app);
const crosshair = new Crosshair(byId("stage"), app);

// ---- messages of velo ----

function expect() {
  app.local = Object.assign(structuredClone(app.state.camera), ...app.sent.map(edit => edit.set), app.queued?.set);
}

function showState(state) {
  const first = !app.state;
  app.state = state;
  app.change = Math.max(app.change, state.change);
  app.sent = app.sent.filter(edit => edit.change > state.change);
  expect();
  const size = Math.hypot(...[0, 1, 2].map(i => state.bounds[i + 3] - state.bounds[i]));
  panel.accepted();
  panel.show(app.local, size);
  display.show(state, first);
  sensor.show(state);
  timeline.state(state);
  byId("scene").textContent = state.scene.split("/").pop();
  document.title = `${state.scene.split("/").pop()} – velo`;
  enable();
  byId("pause").setAttribute("aria-pressed", String(state.paused));
  byId("denoise").setAttribute("aria-pressed", String(state.denoise));
  const c = state.crop;
  app.cropped = c[0] > 0 || c[1] > 0 || c[2] < state.camera.width || c[3] < state.camera.height;
  if (app.focused === state.change) tellFocus(state.camera);
  overlay.state(state);
  outside.state();
  const camera = JSON.stringify(state.camera);
  if (camera !== app.lastCamera) paths.stale();
  app.lastCamera = camera;
}

// What changes things is off where this page may not, or cannot; so are tools that move the camera.
function enable() {
  const on = Boolean(app.steers && app.connected && app.state);
  panel.enable(on);
  display.enable(on);
  sensor.enable(on);
  timeline.enable(on);
  byId("undo").disabled = !on || !app.state.can_undo;
  byId("redo").disabled = !on || !app.state.can_redo;
  for (const control of [byId("reset"), byId("pause"), byId("denoise"), ...byId("save").querySelectorAll("button, select")]) control.disabled = !on;
  for (const button of byId("tools").children) button.disabled = !on && button.dataset.tool !== "inspect";
  if (!on && app.tool !== "inspect") {
    app.toolBefore = app.tool;
    app.choose("inspect");
  } else if (on && app.toolBefore) {
    app.choose(app.toolBefore);
    app.toolBefore = null;
  }
  tellRole();
}

// Who steers, as long as that is not this page alone.
function tellRole() {
  const others = app.pages - 1, box = byId("role");
  const text = !app.connected ? "no connection" : app.steers ? (others > 0 ? `you steer, ${others} look${others > 1 ? "" : "s"} on` : "")
    : app.steering ? "another page steers" : app.steers === false ? "looks on" : "";
  box.hidden = !text;
  byId("role-text").textContent = text;
  box.classList.toggle("off", !app.steers || !app.connected);
  byId("take-over").hidden = !(app.connected && app.steering && !app.steers);
}

// The tool Focus has found a distance.
function tellFocus(c) {
  app.focused = 0;
  const at = `Focus at ${short(c.focus_distance, 4)}.`;
  if (c.lens_radius > 0 || c.optics) return app.notice(at, true);
  app.notice(`${at} The lens has no opening, so that all is sharp: give it a radius or an f-number under Camera, Lens.`, true);
}

function showStatus(s) {
  app.spp = s.spp;
  const error = s.error === null ? "" : `  ·  error ${(100 * s.error).toPrecision(2)} %`;
  const speed = s.paths_per_second ? `  ·  ${metric(s.paths_per_second)}paths/s` : "";
  const tracer = s.racing ? "  ·  comparing tracers" : s.next_tracer ? `  ·  auto: ${s.next_tracer} is next` : s.raced ? `  ·  auto: ${s.tracer}` : "";
  const busy = s.racing || s.next_tracer;
  const end = s.spp >= s.target && !busy ? "  ·  done" : s.paused ? "  ·  paused" : speed;
  byId("status").textContent = `${s.spp} of ${s.target} spp${tracer}${end}${error}`;
  byId("progress").firstElementChild.style.width = `${100 * s.spp / s.target}%`;
}

// Says which image one sees. While the camera moves it would change all the time: then it waits.
function showSeen(frame) {
  clearTimeout(app.seenTimer);
  const many = frame.spp > 0 ? `, ${frame.spp} spp` : "";
  const text = display.isCamera(frame) ? `seen: the sensor's image${many}` : frame.channel ? "" : `seen: ${["samples", "denoised preview", "earlier image, moved"][frame.denoised]}${many}`;
  app.seenTimer = setTimeout(() => { byId("seen").textContent = text; }, 200);
}

const handlers = {
  state: showState,
  status: showStatus,
  lists: message => { panel.lists(message); display.lists(message); sensor.lists(message); app.lists = message; app.onlists?.(message); },
  role(message) {
    if (app.steers && !message.steers) app.notice("Another page has taken over; this one looks on.", true);
    if (!app.steers && message.steers) app.notice("");
    Object.assign(app, { steers: message.steers, steering: message.steering, pages: message.pages });
    enable();
  },
  refused(message) {
    if (message.id && app.waiting.has(message.id)) return answered(message);
    if (message.change) app.sent = app.sent.filter(edit => edit.change > message.change);
    timeline.refused();
    if (app.state) expect();
    if (!panel.refused(message.field, message.message) && !sensor.refused(message.field, message.message)) app.notice(message.message);
  },
  exposed: message => sensor.exposed(message),
  loading: () => { byId("status").textContent = "a file changed: loading"; },
  loaded() { app.notice("The scene was loaded again.", true); outside.loaded(); timeline.loaded(); paths.stale(); },
  warning: message => app.notice(message.message, true),
  note: message => app.notice(message.message, true),
  error(message) {
    const place = message.file ? `${message.file}${message.line ? `:${message.line}` : ""}${message.column ? `:${message.column}` : ""}\n` : "";
    app.notice(place + message.message);
    timeline.refused();
  },
};

function answered(message) {
  app.waiting.get(message.id)?.(message);
  app.waiting.delete(message.id);
}

// The connection is lost: no answer comes any more, and edits on their way do not arrive.
function forget() {
  const lost = [...app.waiting.values()];
  app.waiting.clear();
  for (const answer of lost) answer({ type: "refused", message: "velo cannot be reached" });
  app.sent = [];
  app.queued = null;
  app.steers = undefined;
}

app.connection = { send() {} }; // before the engine is there
connect({
  text(message) {
    if (handlers[message.type]) handlers[message.type](message);
    else if (message.id) answered(message);
  },
  frame(buffer) {
    const frame = parseFrame(buffer);
    display.frame(frame);
    screen.take(frame);
    showSeen(frame);
    timeline.frame(frame);
    app.connection.send({ type: "seen", serial: frame.serial });
    inspector.frame();
    compare.frame();
    app.frames = (app.frames || 0) + 1;
  },
  state(connected, reason) {
    document.body.classList.toggle("away", !connected);
    app.connected = connected;
    if (!connected) forget();
    enable();
    if (!connected) byId("status").textContent = reason ? `closed: ${reason}` : "velo has ended or cannot be reached; trying again";
    if (!connected && engineName() === "browser") app.notice(`velo does not run in this page: ${reason}`);
  },
}).then(connection => { app.connection = connection; }, error => { byId("status").textContent = error.message; });

// ---- controls ----

for (const tool of tools) {
  const button = make("button", { onclick: () => app.choose(tool.name) });
  dress(button, tool.name, tool.label, tool.title);
  button.dataset.tool = tool.name;
  byId("tools").append(button);
}
app.choose("orbit");
for (const name of ["undo", "redo", "reset", "pause", "denoise"]) byId(name).onclick = app[name];
dress(byId("undo"), "undo", "Undo", "Z");
dress(byId("redo"), "redo", "Redo", "Shift+Z");
dress(byId("reset"), "reset", "Reset", "the scene's camera (Home)");
dress(byId("pause"), "pause", "Pause", "P");
dress(byId("denoise"), "denoise", "Denoise", "the image denoised, or its samples as they are (N); what is saved is never denoised");
dress(byId("outside-toggle"), "outside", "Outside", "the camera from outside (O)");
dress(byId("side-toggle"), "panel", "Panel", "shows or hides it");
byId("take-over").onclick = () => app.connection.send({ type: "steer" });
byId("notice-close").onclick = () => app.notice("");
byId("side-toggle").onclick = () => {
  const side = byId("side");
  side.hidden = !side.hidden;
  byId("side-toggle").setAttribute("aria-expanded", String(!side.hidden));
};
document.addEventListener("keydown", event => {
  if (!app.local || keepsKey(event.target, event.key)) return;
  const action = crosshair.action(event) ?? keyAction(event, app);
  if (!action) return;
  event.preventDefault();
  action();
});
addHelp(byId("help"));
window.velo = app; // for tests
