// web/lecture/figures.js: sliders, views and formulas of the lecture's live figures. What renders is given by the caller:
//
//   start(figure, scene)          the figure is live from now on, or shows another view: gives a promise of the scene's
//                                 camera { eye, lookat, up, d, zoom, s, roll, width, height, near, far, ... }
//   show(figure, scene, camera)   the camera has changed: render it
//   stop(figure)                  the figure is live no longer
//
// One figure is live at a time: the one that was clicked last, while it is in sight; else the one nearest to the middle.
import { formula } from "./formulas.js";
import { parseSliders, positionOf, sliderValue, valueAt, withSlider } from "./sliders.js";

const STEPS = 1000;
const CALM = 120; // milliseconds without scrolling after which a figure becomes live
const WORDS = {
  en: { reset: "Reset", sliders: "camera", failed: "no live image", outside: "the camera from outside" },
  it: { reset: "Ripristina", sliders: "camera", failed: "nessuna immagine dal vivo", outside: "la camera dall'esterno" },
};

function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

// Three significant digits are what a slider can set.
const rounded = (value) => Number(value.toPrecision(Math.abs(value) >= 1000 ? 4 : 3));

function short(value, language) {
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "–";
  const text = String(rounded(value)).replace("-", "−");
  return language === "it" ? text.replace(".", ",") : text;
}

// One row: name, slider, value. change(value) is called while it moves; update(camera) sets it.
function sliderRow(slider, language, change) {
  const input = make("input", { type: "range", min: 0, max: STEPS, step: 1 });
  const output = make("output");
  const row = make("label", { className: "slider" }, make("span", { textContent: slider.name.replace("_", " ") }), input, output);
  row.dataset.slider = slider.name;
  const write = (value) => {
    output.textContent = short(value, language);
    input.setAttribute("aria-valuetext", output.textContent);
  };
  input.addEventListener("input", () => {
    const value = rounded(valueAt(slider, input.value / STEPS));
    write(value);
    change(value);
  });
  const update = (camera) => {
    const value = sliderValue(camera, slider.name);
    row.hidden = value === undefined; // such as d, where the view's projection has none
    if (row.hidden || input.matches(":active")) return; // it is held
    input.value = Math.round(STEPS * positionOf(slider, value));
    write(value);
  };
  return { row, update };
}

class Figure {
  constructor(element, options) {
    this.element = element;
    this.options = options;
    this.views = [];
    this.scene = element.dataset.scene;
    this.folder = this.scene.replace(/[^/]*$/, "");
    this.camera = null;
    this.first = null;
    this.seen = false;
    const { language } = options, words = WORDS[language];
    this.rows = parseSliders(element.dataset.sliders ?? "").filter((slider) => slider.min !== undefined)
      .map((slider) => sliderRow(slider, language, (value) => this.set(withSlider(this.camera, slider.name, value), false)));
    this.formulas = (element.dataset.formulas ?? "").split(",").filter(Boolean)
      .map((name) => ({ name, line: make("p", { className: "numbers" }) }));
    const reset = make("button", { type: "button", className: "reset", textContent: words.reset });
    reset.addEventListener("click", () => this.first && this.set(this.first, true));
    this.panel = make("div", { className: this.rows.length > 5 ? "controls many" : "controls", hidden: true }, ...this.rows.map((r) => r.row), reset, ...this.formulas.map((f) => f.line));
    this.panel.setAttribute("role", "group");
    this.panel.setAttribute("aria-label", words.sliders);
    this.error = make("p", { className: "error", hidden: true });
    this.error.setAttribute("role", "status");
    const image = element.querySelector("img"), outside = make("div", { className: "pane outside" });
    outside.setAttribute("aria-label", words.outside);
    outside.setAttribute("role", "group");
    this.image = make("div", { className: "pane image" }, image);
    element.prepend(make("div", { className: "panes" }, this.image, ...(element.dataset.outside ? [outside] : [])));
    element.append(this.panel, this.error);
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
    } catch (error) {
      if (scene === this.scene && this.seen) this.complain(`${WORDS[this.options.language].failed}: ${error.message}`);
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
    for (const { name, line } of this.formulas) line.textContent = formula(name, camera, this.options.language);
    if (camera.d !== undefined) this.options.changed(camera);
    if (render) this.options.show(this.element, this.scene, camera);
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

// All live figures below root. The formulas of the text show the numbers of the figure that changed last.
export function attachFigures(root, options) {
  const quotes = [...root.querySelectorAll("blockquote.formula")].map((quote) => {
    const line = make("p", { className: "numbers", hidden: true });
    quote.append(line);
    return { line, name: quote.dataset.formula };
  });
  const changed = (camera) => {
    for (const { line, name } of quotes) {
      line.textContent = formula(name, camera, options.language);
      line.hidden = false;
    }
  };
  const figures = [];
  for (const element of root.querySelectorAll("figure.live, button.view")) {
    const figure = figures.at(-1);
    if (element.matches("figure")) {
      figures.push(new Figure(element, { language: "en", ...options, changed }));
    } else if (figure) {
      figure.views.push(element);
      element.addEventListener("click", () => figure.start(`${figure.folder}${element.dataset.view}.pbrt`, false));
    }
  }
  return { figures, close: chooseLive(figures) };
}
