// web/lecture/figures.js: sliders, views and formulas of the lecture's live figures. What renders is given by the caller:
//
//   start(figure, scene)          the figure is live from now on, or shows another view: gives a promise of the scene's
//                                 camera { eye, lookat, up, d, zoom, s, roll, width, height, near, far, ... }
//   show(figure, scene, camera)   the camera has changed: render it
//   stop(figure)                  the figure is live no longer
//
// One figure is live at a time: the one that was clicked last, while it is in sight; else the one nearest to the middle.
import { make } from "../dom.js";
import { Drawn } from "./drawn.js";
import { formula } from "./formulas.js";
import { showMath } from "./math.js";
import { parseSliders, sliderRow, withSlider } from "./sliders.js";
import { words } from "./words.js";

const CALM = 120; // milliseconds without scrolling after which a figure becomes live

class Figure {
  constructor(element, options) {
    this.element = element;
    this.options = options;
    this.views = [];
    this.scene = element.dataset.scene;
    this.folder = this.scene.replace(/[^/]*$/, "");
    this.name = this.scene.slice(this.folder.length).replace(/\.pbrt$/, "");
    this.camera = null;
    this.first = null;
    this.seen = false;
    this.pixel = {}; // the clicked pixel { r, c }, of the formulas
    const { language } = options, w = words(language);
    this.rows = parseSliders(element.dataset.sliders ?? "")
      .map((slider) => sliderRow(slider, language, (value) => this.set(withSlider(this.camera, slider.name, value), false)));
    this.formulas = (element.dataset.formulas ?? "").split(",").filter(Boolean).map((name) => ({ name, line: make("p", { class: "numbers" }) }));
    const reset = make("button", { type: "button", class: "reset", textContent: w.reset, onclick: () => this.first && this.set(this.first, true) });
    this.panel = make("div", { class: "controls", hidden: true }, ...this.rows.map((r) => r.row), make("div", { class: "buttons" }, reset),
      make("div", { class: "formulas" }, ...this.formulas.map((f) => f.line)));
    this.panel.setAttribute("role", "group");
    this.panel.setAttribute("aria-label", w.sliders);
    this.error = make("p", { class: "error", hidden: true });
    this.error.setAttribute("role", "status");
    const outside = make("div", { class: "pane outside", role: "group" });
    outside.setAttribute("aria-label", w.outside);
    this.image = make("div", { class: "pane image" }, element.querySelector("img"));
    element.prepend(make("div", { class: "panes" }, this.image, ...(element.dataset.outside ? [outside] : []), this.panel), this.error);
  }

  // The figure becomes live, or shows another view. keep: a scene that was there before keeps its camera.
  async start(scene = this.scene, keep = true) {
    this.scene = scene;
    this.seen = true;
    for (const view of this.views)
      view.setAttribute("aria-pressed", String(scene === `${this.folder}${view.dataset.view}.pbrt`));
    try {
      const camera = await this.options.start(this.element, scene);
      if (scene !== this.scene || !this.seen) return; // another view was chosen meanwhile
      const again = keep && this.loaded === scene;
      this.first = camera;
      this.loaded = scene;
      this.panel.hidden = false;
      this.complain("");
      this.set(again ? this.camera : camera, true, again);
      this.onready?.();
      this.onready = null;
    } catch (error) {
      if (scene === this.scene && this.seen) this.complain(`${words(this.options.language).failed}: ${error.message}`);
    }
  }

  stop() {
    if (!this.seen) return;
    this.seen = false;
    this.options.stop?.(this.element);
  }

  // A line below the figure; empty: none.
  complain(text) {
    this.error.textContent = text;
    this.error.hidden = !text;
  }

  set(camera, moveSliders, render = true) {
    this.camera = camera;
    if (moveSliders) for (const { update } of this.rows) update(camera);
    for (const { name, line } of this.formulas) showMath(line, formula(name, { ...camera, ...this.pixel }, this.options.language));
    if (camera.d !== undefined) this.options.changed({ ...camera, ...this.pixel });
    this.onchange?.();
    if (render) this.options.show(this.element, this.scene, camera);
  }

  // The formulas are those of this pixel from now on: r counts from below.
  pick(r, c) {
    this.pixel = { r, c };
    if (this.camera) this.set(this.camera, false, false);
  }

  // The renderer's numbers are those of `camera`.
  follow(camera) {
    if (this.camera) this.set(camera, true, false);
  }
}

const box = (element) => element.getBoundingClientRect();
const inSight = (element) => box(element).bottom > 0 && box(element).top < innerHeight;

// Chooses the figure that is live. Returns a function that ends that.
function chooseLive(figures) {
  let live = null, held = null, timer = null;
  const distance = ({ image }) => Math.abs((box(image).top + box(image).bottom - innerHeight) / 2);
  const choose = () => {
    if (held && ![held.element, ...held.views].some(inSight)) held = null;
    const next = held ?? figures.filter((f) => inSight(f.element)).sort((a, b) => distance(a) - distance(b))[0] ?? null;
    if (next === live && (!live || live.seen)) return;
    live?.stop();
    live = next;
    live?.start();
  };
  const later = () => {
    clearTimeout(timer);
    timer = setTimeout(choose, CALM);
  };
  const hold = ({ target }) => {
    const figure = figures.find((f) => [f.element, ...f.views].some((element) => element.contains(target)));
    if (!figure) return;
    held = figure;
    choose();
  };
  const observer = new IntersectionObserver(later); // figures also come and go without scrolling
  for (const figure of figures) observer.observe(figure.element);
  const listeners = [["scroll", later], ["resize", later], ["pointerdown", hold], ["focusin", hold]];
  for (const [name, action] of listeners) addEventListener(name, action, { passive: true });
  return () => {
    observer.disconnect();
    clearTimeout(timer);
    for (const [name, action] of listeners) removeEventListener(name, action);
    live?.stop();
  };
}

// All figures below root. The formulas of the text show the numbers of the figure that changed last.
export function attachFigures(root, options) {
  const quotes = [...root.querySelectorAll("blockquote.formula")].map((quote) => {
    const line = make("p", { class: "numbers", hidden: true });
    quote.append(line);
    return { line, name: quote.dataset.formula };
  });
  const changed = (camera) => {
    for (const { line, name } of quotes) {
      showMath(line, formula(name, camera, options.language));
      line.hidden = false;
    }
  };
  const figures = [], drawn = [];
  for (const element of root.querySelectorAll("figure.live, figure.drawn, button.view")) {
    const figure = figures.at(-1);
    if (element.matches("figure.drawn")) {
      drawn.push(new Drawn(element, options));
    } else if (element.matches("figure")) {
      figures.push(new Figure(element, { language: "en", ...options, changed }));
    } else if (figure) {
      figure.views.push(element);
      element.addEventListener("click", () => figure.start(`${figure.folder}${element.dataset.view}.pbrt`, false));
    }
  }
  return { figures, drawn, close: chooseLive(figures) };
}
