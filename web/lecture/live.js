// web/lecture/live.js: velo as the renderer of the lecture's figures: one scene at a time, shown in the figure that is
// live, with the view from outside beside it.
import { connect, engineName } from "../connection.js";
import { parseFrame } from "../frame.js";
import { Outside } from "../outside.js";
import { Overlay } from "../overlay.js";
import { Screen } from "../screen.js";
import { sha256 } from "../sha256.js";
import { attachDrag } from "./drag.js";

const WORDS = {
  en: {
    steered: "another page steers",
    away: "velo has ended or cannot be reached; trying again",
    image: "Click: a pixel's ray. Drag: turn round lookat. Shift: sideways. Ctrl: look round. Arrow keys turn; after Enter they move a pixel",
    outside: "Drag the eye: e. Drag the view plane: d. Drag elsewhere: turn. Ctrl and wheel: nearer, farther",
    status: (s) => `${s.spp} of ${s.target} samples per pixel`,
    engine: { server: "Rendered by velo view.", browser: "Rendered by velo in this page (WebAssembly)." },
    hash: (hash) => `SHA-256 of the image: ${hash}`,
    printed: (why) => `The figures stay as printed: ${why}.`,
    lost: "The browser took away what draws the image: the figure is the printed one until it comes back.",
    reasons: { webgl: "this browser has no WebGL2", wasm: "this browser has no WebAssembly with vector instructions", memory: "the browser has too little memory" },
  },
  it: {
    steered: "la camera è controllata da un'altra pagina",
    away: "velo è terminato o non è raggiungibile; nuovo tentativo",
    image: "Clic: il raggio di un pixel. Trascinando si gira attorno a lookat; con Maiusc ci si sposta di lato, con Ctrl si ruota lo sguardo. Le frecce fanno girare; dopo Invio spostano il pixel",
    outside: "Trascinate l'osservatore: cambia e. Il view plane: cambia d. Altrove: gira la vista. Ctrl e rotella: più vicino, più lontano",
    status: (s) => `${s.spp} di ${s.target} campioni per pixel`,
    engine: { server: "Immagini calcolate da velo view.", browser: "Immagini calcolate da velo in questa pagina (WebAssembly)." },
    hash: (hash) => `SHA-256 dell'immagine: ${hash}`,
    printed: (why) => `Le figure restano quelle stampate: ${why}.`,
    lost: "Il browser ha sottratto alla pagina la risorsa grafica che disegna l'immagine: finché non la restituisce, la figura è quella stampata.",
    reasons: { webgl: "questo browser non ha WebGL2", wasm: "questo browser non ha WebAssembly con istruzioni vettoriali", memory: "la memoria del browser non basta" },
  },
};
const PLAIN = ["eye", "lookat", "up", "d", "zoom", "s", "roll", "near", "far", "exposure_time"];

// The camera of a figure, of velo's camera. What it does not have is absent.
export function figureCamera(c) {
  const camera = { kind: c.kind, width: c.width, height: c.height };
  for (const name of ["eye", "lookat", "up", "zoom", "s", "roll", "near", "exposure_time"]) camera[name] = c[name];
  camera.far = c.far ?? Infinity;
  if (c.kind === "perspective") camera.d = c.d;
  if (["perspective", "panini", "stereographic"].includes(c.kind)) camera.fov = c.fov_horizontal;
  if (c.kind === "panini") camera.panini = c.shape[0];
  return camera;
}

// Why the engine cannot render: a kind of WORDS.reasons, or the message itself.
const REASONS = [[/WebGL2/, "webgl"], [/WebAssembly|unpack/, "wasm"], [/memory/i, "memory"]];

// The fields of velo's camera that change between two cameras of a figure.
export function changedFields(before, after) {
  const set = {}, differs = (name) => String(before[name]) !== String(after[name]);
  for (const name of PLAIN) if (name in after && differs(name)) set[name] = Number.isFinite(after[name]) || Array.isArray(after[name]) ? after[name] : null;
  if ("fov" in after && differs("fov")) Object.assign(set, { fov: after.fov, fov_axis: "horizontal" });
  if ("panini" in after && differs("panini")) set.shape = [after.panini];
  return set;
}

export class Live {
  // tell(text): a line about the image. foot(text): which engine made it, and the hash of its pixels when it is done.
  constructor(tell, foot = () => {}) {
    this.tell = tell;
    this.foot = foot;
    this.words = WORDS.en;
    this.figures = [];    // those of figures.js
    this.element = null;  // the figure that is live
    this.change = Math.floor(Date.now() / 1000); // the number of the last change, which velo gives back; no page before had it
    this.gesture = 1;
    this.signed = this.hash = null; // the finished frame, and the SHA-256 of its pixels
    this.waiting = new Map();
    this.nextId = 1;
    this.canvas = Object.assign(document.createElement("canvas"), { className: "screen", hidden: true });
    this.svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.svg.id = "overlay";
    document.body.append(this.canvas, this.svg);
    this.connection = { send() {} }; // before the engine is there
    try {
      this.screen = new Screen(this.canvas);
    } catch (error) {
      this.end(error.message);
      return;
    }
    this.screen.onlost = () => this.lose(true);
    this.screen.onrestored = () => this.lose(false);
    this.overlay = new Overlay(document.createElement("div"), this);
    attachDrag(this.canvas, this);
    this.screen.onplace = () => this.overlay.draw();
    this.display = { ev: 0 };
    addEventListener("wheel", (event) => { // over the view from outside it scrolls the page
      if (!event.ctrlKey && event.target.closest?.(".pane.outside")) event.stopPropagation();
    }, { capture: true, passive: true });
    connect({
      text: (message) => this.receive(message),
      frame: (buffer) => this.receiveFrame(buffer),
      state: (connected, reason) => this.connected(connected, reason),
    }).then((connection) => { this.connection = connection; }, (error) => this.connected(false, error.message));
  }

  use(language) {
    this.leave();
    this.words = WORDS[language];
    if (this.why) this.end(this.why);
    this.sign();
    this.canvas.title = this.words.image;
    this.canvas.setAttribute("aria-label", this.words.image);
  }

  // ---- for figures.js ----

  start(element, scene) {
    if (this.broken) return Promise.reject(new Error(this.reason));
    this.leave();
    this.element = element;
    this.scene = scene;
    this.state = null;
    if (this.steers === false) return this.look();
    element.querySelector(".pane.image").append(this.canvas, this.svg);
    return new Promise((resolve, reject) => {
      this.pending = { change: ++this.change, resolve, reject };
      this.first = this.change;
      this.connection.send({ type: "scene", name: scene, change: this.change });
    });
  }

  show(element, scene, camera) {
    if (element !== this.element || !this.state) return;
    if (this.steers === false) return this.follow(this.state);
    this.wanted = camera;
    this.timer ??= requestAnimationFrame(() => this.flush());
  }

  stop(element) {
    if (element !== this.element) return;
    this.leave();
    this.connection.send({ type: "settings", paused: true });
  }

  // ---- what the view from outside and the overlays need ----

  camera() { return this.local; }

  // A gesture begins: its edits are one step of undo.
  next() { return ++this.gesture; }

  edit(set) {
    const figure = this.figures.find((f) => f.element === this.element);
    if (!figure?.camera || !this.steers) return;
    Object.assign(this.local, set);
    figure.set({ ...figure.camera, ...set }, true);
  }

  // The pixel at a place of the image: its ray in the formulas, its projector in the view from outside.
  pick(x, y) {
    const { width, height } = this.local, column = Math.floor(x), row = Math.floor(y), figure = this.figures.find((f) => f.element === this.element);
    if (!figure || column < 0 || row < 0 || column >= width || row >= height) return;
    figure.pick(height - 1 - row, column);
    const box = [column, row, column + 1, row + 1], grow = Math.max(0, 3 / this.screen.factor() - 0.5);
    this.overlay.band([box[0] - grow, box[1] - grow, box[2] + grow, box[3] + grow]);
    this.ask({ type: "pick", x: column + 0.5, y: row + 0.5 }, (answer) => {
      if (!this.outside || answer.type !== "picked") return;
      this.outside.point = answer.object?.id ? answer.P : null;
      this.outside.outline();
    });
  }

  ask(message, answer) {
    const id = this.nextId++;
    this.waiting.set(id, answer);
    this.connection.send({ ...message, id });
  }

  // ---- the figure ----

  // The figure keeps its last image, and its view from outside as it is.
  leave() {
    cancelAnimationFrame(this.timer);
    this.timer = null;
    this.pending = null;
    if (this.broken) return;
    if (this.element && this.screen.frame && !this.canvas.hidden) {
      const pane = this.element.querySelector(".pane.image");
      const still = Object.assign(document.createElement("canvas"), { className: "still", width: this.canvas.width, height: this.canvas.height });
      this.screen.drawNow(); // the canvas keeps what is drawn until the browser shows the next frame
      still.getContext("2d").drawImage(this.canvas, 0, 0);
      pane.querySelector(".still")?.remove();
      pane.append(still);
    }
    this.canvas.hidden = true;
    this.overlay.on.clear();
    this.overlay.rectangle = null;
    this.overlay.draw();
    this.outside = this.element = this.state = null;
  }

  // velo has the scene.
  begin(state) {
    const { element } = this, pane = element.querySelector(".pane.outside");
    this.sent = figureCamera(state.camera);
    this.display.ev = state.exposure;
    Object.assign(this.screen.display, { exposure: state.exposure, view: state.view, kind: 0 });
    this.screen.redevelop();
    if (element.dataset.overlay === "vanishing") for (const name of ["vanishing", "horizon"]) this.overlay.toggle(name, true);
    if (pane) this.openOutside(pane, state.camera);
    return this.sent;
  }

  // From so far that the pane's width has room for the eye and for lookat, or for what the middle of the image shows, if
  // that is farther.
  openOutside(pane, camera) {
    pane.replaceChildren();
    const outside = this.outside = new Outside(this, pane, null), box = pane.getBoundingClientRect();
    outside.canvas.title = this.words.outside;
    this.ask({ type: "pick", x: camera.width / 2, y: camera.height / 2 }, ({ distance }) => {
      if (outside !== this.outside) return;
      const arm = camera.lookat.map((x, i) => x - camera.eye[i]), depth = distance?.[0] ?? 0;
      const k = Math.max(1, 0.6 * depth / Math.hypot(...arm)) * Math.max(1, 1.7 * box.height / box.width);
      const pose = outside.start();
      outside.pose = { ...pose, eye: pose.lookat.map((x, i) => x + k * (pose.eye[i] - x)) };
      outside.toggle();
    });
  }

  flush() {
    this.timer = null;
    const set = changedFields(this.sent, this.wanted);
    if (!Object.keys(set).length) return;
    this.sent = this.wanted;
    this.connection.send({ type: "camera", change: ++this.change, gesture: this.gesture, set });
  }

  complain(text) {
    const figure = this.figures.find((f) => f.element === this.element);
    figure?.complain(text);
  }

  // ---- messages of velo ----

  receive(message) {
    if (message.type === "state") this.receiveState(message);
    else if (message.type === "refused") this.refused(message);
    else if (message.type === "error" || message.type === "warning") this.complain(this.explain(message.message));
    else if (message.type === "status") this.receiveStatus(message);
    else if (message.type === "role") this.receiveRole(message);
    else if (message.id) this.answered(message);
  }

  receiveStatus(status) {
    this.target = status.target;
    this.tell(this.words.status(status));
    this.sign();
  }

  // Which engine renders, with the hash of the image's pixels (half floats; red, green and blue; rows from the top) when it has
  // all its samples.
  sign() {
    if (this.broken) return this.foot("");
    const { frame, pixels } = this.screen;
    const done = frame && frame.spp > 0 && frame.spp === this.target ? frame : null;
    if (done !== this.signed) {
      this.signed = done;
      this.hash = done && sha256(new Uint8Array(pixels.data.buffer, pixels.data.byteOffset, pixels.data.byteLength));
    }
    const words = this.words;
    this.foot(words.engine[engineName()] + (this.hash ? " " + words.hash(this.hash) : ""));
  }

  // A message of velo for the reader: too little memory concerns the figure, whose printed image is there.
  explain(message) {
    return /memory/i.test(message) ? this.words.printed(this.words.reasons.memory) : message;
  }

  answered(message) {
    this.waiting.get(message.id)?.(message);
    this.waiting.delete(message.id);
  }

  receiveRole(message) {
    if (this.steers === message.steers) return; // the number of pages changed
    this.steers = message.steers;
    const figure = this.figures.find((f) => f.seen);
    if (figure) figure.start(); // the connection is new, or the page that steered is closed
  }

  receiveState(state) {
    this.latest = state;
    if (this.steers === false) return this.lookAt(state);
    if (!this.element || state.scene !== this.scene || state.change < this.first) return;
    this.state = state;
    this.local = state.camera;
    this.overlay.state(state);
    const { pending } = this;
    if (pending?.change === state.change) {
      this.pending = null;
      pending.resolve(this.begin(state));
    } else if (state.change === this.change) {
      this.complain("");
      this.follow(state);
    }
    this.outside?.state();
  }

  // Another page steers: its image is shown where it is that of this figure's scene.
  look() {
    const state = this.latest;
    if (state?.scene !== this.scene) return Promise.reject(new Error(this.words.steered));
    this.element.querySelector(".pane.image").append(this.canvas, this.svg);
    this.first = state.change;
    this.state = state;
    this.local = state.camera;
    this.overlay.state(state);
    this.canvas.hidden = !(this.shown >= this.first);
    return Promise.resolve(this.begin(state));
  }

  lookAt(state) {
    const figure = this.figures.find((f) => f.element === this.element);
    if (!figure) return;
    if (state.scene !== this.scene) {
      this.canvas.hidden = true;
      this.outside = this.state = null;
      figure.complain(this.words.steered);
    } else if (!this.state) {
      figure.start();
    } else {
      this.state = state;
      this.local = state.camera;
      this.overlay.state(state);
      this.follow(state);
      this.outside?.state();
    }
  }

  // The figure's numbers are those of velo, unless newer ones are on their way.
  follow(state) {
    if (this.timer !== null) return;
    this.sent = figureCamera(state.camera);
    this.figures.find((f) => f.element === this.element)?.follow(this.sent);
  }

  refused(message) {
    if (message.id && this.waiting.has(message.id)) return this.answered(message);
    if (this.pending && message.change === this.pending.change) {
      this.pending.reject(new Error(message.message));
      this.pending = null;
    } else if (message.change === this.change) {
      this.complain(message.message);
      if (this.state) this.follow(this.state);
    }
  }

  receiveFrame(buffer) {
    const frame = parseFrame(buffer);
    this.screen.take(frame); // also one of another scene: the next has only what differs from it
    this.connection.send({ type: "seen", serial: frame.serial });
    if (this.element && this.state && frame.change >= this.first) this.canvas.hidden = Boolean(this.screen.lost);
    this.frames = (this.frames ?? 0) + 1;
    this.shown = frame.change;
    this.sign();
  }

  connected(connected, reason) {
    if (connected) return;
    this.steers = undefined;
    if (engineName() === "browser") this.end(reason);
    else this.tell(reason || this.words.away);
  }

  // Nothing renders any more, since `why`: the printed figures are shown.
  end(why) {
    const kind = REASONS.find(([test]) => test.test(why))?.[1], { words } = this;
    this.why = why;
    this.reason = (kind ? words.reasons[kind] : why).replace(/^velo: (error: )?|\.$/g, "");
    this.broken = words.printed(this.reason);
    this.canvas.hidden = true;
    this.tell(this.broken);
    this.foot("");
    this.pending?.reject(new Error(this.reason));
    this.pending = null;
    const live = this.figures.find((f) => f.element === this.element);
    if (!live) return;
    live.element.querySelector(".still")?.remove();
    live.complain(this.broken);
  }

  // The context of WebGL is lost, or is there again.
  lose(lost) {
    if (!this.element) return;
    this.canvas.hidden = lost || !(this.shown >= this.first);
    if (lost) this.element.querySelector(".still")?.remove();
    this.complain(lost ? this.words.lost : "");
  }
}
