// web/lecture/figures.js: sliders, views and formulas of the lecture's live figures. What renders is given by the caller:
//
//   start(figure, scene)          a figure has come into view, or another view was chosen: gives a promise of the scene's
//                                 camera { eye, lookat, up, d, zoom, s, roll, width, height, near, far, ... }
//   show(figure, scene, camera)   the camera has changed: render it
//   stop(figure)                  the figure is out of sight
import { formula } from "./formulas.js";
import { parseSliders, positionOf, sliderValue, valueAt, withSlider } from "./sliders.js";

const STEPS = 1000;
const WORDS = {
  en: { reset: "Reset", sliders: "camera", failed: "no live image" },
  it: { reset: "Ripristina", sliders: "camera", failed: "nessuna immagine dal vivo" },
};

function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

// Three significant digits are what a slider can set.
function short(value, language) {
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "–";
  const text = String(Number(value.toPrecision(value >= 1000 ? 4 : 3))).replace("-", "−");
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
    const value = valueAt(slider, input.value / STEPS);
    write(value);
    change(value);
  });
  const update = (camera) => {
    const value = sliderValue(camera, slider.name);
    row.hidden = value === undefined; // such as d, where the view's projection has none
    if (row.hidden) return;
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
    this.panel = make("div", { className: "controls", hidden: true }, ...this.rows.map((r) => r.row), reset, ...this.formulas.map((f) => f.line));
    this.panel.setAttribute("role", "group");
    this.panel.setAttribute("aria-label", words.sliders);
    this.error = make("p", { className: "error", hidden: true });
    element.append(this.panel, this.error);
  }

  // Called by the first click or when the figure comes into view; chosen again, a view starts again.
  async start(scene = this.scene) {
    this.scene = scene;
    this.seen = true;
    for (const view of this.views)
      view.setAttribute("aria-pressed", String(scene === `${this.folder}${view.dataset.view}.pbrt`));
    try {
      const camera = await this.options.start(this.element, scene);
      if (scene !== this.scene || !this.seen) return; // another view was chosen meanwhile
      this.first = camera;
      this.panel.hidden = false;
      this.error.hidden = true;
      this.set(camera, true, false);
    } catch (error) {
      this.error.textContent = `${WORDS[this.options.language].failed}: ${error.message}`;
      this.error.hidden = false;
    }
  }

  stop() {
    if (!this.seen) return;
    this.seen = false;
    this.options.stop?.(this.element);
  }

  set(camera, moveSliders, render = true) {
    this.camera = camera;
    if (moveSliders) for (const { update } of this.rows) update(camera);
    for (const { name, line } of this.formulas) line.textContent = formula(name, camera, this.options.language);
    this.options.changed(camera);
    if (render) this.options.show(this.element, this.scene, camera);
  }
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
  const figures = new Map();
  let last = null;
  for (const element of root.querySelectorAll("figure.live, button.view")) {
    if (element.matches("figure")) {
      last = new Figure(element, { language: "en", ...options, changed });
      figures.set(element, last);
    } else if (last) {
      const figure = last;
      figure.views.push(element);
      element.addEventListener("click", () => figure.start(`${figure.folder}${element.dataset.view}.pbrt`));
    }
  }
  const observer = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const figure = figures.get(target);
      if (isIntersecting && !figure.seen) figure.start();
      else if (!isIntersecting) figure.stop();
    }
  }, { rootMargin: "100px" });
  for (const element of figures.keys()) observer.observe(element);
  return { figures: [...figures.values()], close: () => observer.disconnect() };
}
