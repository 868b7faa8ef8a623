// web/lecture/drawn.js: figures that need only geometry: SVG, drawn from exact formulas, with sliders beside it and points
// that are dragged on the drawing itself. A drawing (drawings.js) is
//
//   size      [width, height] of the drawing
//   state     its numbers at the start
//   choices   { name: values }, of which one is chosen by a row of buttons
//   draw(state, say)            text of SVG; say(en, it) chooses a label; parts with data-handle are dragged
//   numbers(state, write)       lines of formulas; write as in formulas.js
//   drag(state, handle, [dx, dy], [x, y])   the state after a drag of a handle, "" for the drawing itself
//   click(state, [x, y])        the state after a click
//   press(state, name)          the state after a button of `buttons`; "play" is pressed again and again until play is 0
//   extra(figure)               more elements beside the drawing
import { make } from "../dom.js";
import { drawings } from "./drawings.js";
import { writer } from "./formulas.js";
import { showMath } from "./math.js";
import { parseSliders, sliderRow } from "./sliders.js";
import { choiceNames, sayIn, words } from "./words.js";

// The drawing of a state as SVG in itself, for pages without scripts (tools/lecture_figures).
export function drawingSvg(name, language, style) {
  const drawing = drawings[name], [width, height] = drawing.size;
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" class="drawing">` +
    `<style>${style}</style><rect class="paper" width="${width}" height="${height}"/>${drawing.draw(drawing.state, sayIn(language))}</svg>\n`;
}

export class Drawn {
  constructor(element, { language = "en" } = {}) {
    this.element = element;
    this.language = language;
    this.name = element.dataset.drawn;
    this.drawing = drawings[this.name];
    this.state = { ...this.drawing.state };
    this.views = [];
    this.write = writer(language);
    const { size: [width, height], choices = {}, buttons = [] } = this.drawing, w = words(language);
    this.svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    for (const [key, value] of [["viewBox", `0 0 ${width} ${height}`], ["class", width > 800 ? "drawing wide" : "drawing"], ["role", "img"], ["aria-label", element.dataset.alt]])
      this.svg.setAttribute(key, value);
    this.image = make("div", { class: "pane drawing" }, this.svg);
    this.rows = parseSliders(element.dataset.sliders ?? "").map((slider) =>
      sliderRow(slider, language, (value) => this.set({ ...this.state, [slider.name]: value }, false)));
    this.choices = Object.entries(choices).map(([key, values]) => this.choiceRow(key, values));
    this.buttons = buttons.map((key) => make("button", { type: "button", textContent: w[key], onclick: () => this.press(key) }));
    this.lines = [];
    this.numbers = make("div", { class: "formulas" });
    const reset = make("button", { type: "button", class: "reset", textContent: w.reset, onclick: () => this.set({ ...this.drawing.state }, true) });
    this.panel = make("div", { class: "controls" }, ...this.choices.map((c) => c.row), ...this.rows.map((r) => r.row),
      make("div", { class: "buttons" }, ...this.buttons, reset), this.numbers);
    this.panel.setAttribute("role", "group");
    this.panel.setAttribute("aria-label", w.sliders);
    element.prepend(make("div", { class: "panes" }, this.image, this.panel));
    this.extra = this.drawing.extra?.(this);
    if (this.extra) (this.drawing.below ? this.image : this.panel).append(this.extra.element);
    this.listen();
    this.set(this.state, true);
  }

  get camera() { return this.state; }

  choiceRow(key, values) {
    const names = choiceNames(this.language), buttons = values.map((value) => make("button", { type: "button", textContent: names[value] ?? value,
      onclick: () => this.set(this.drawing.choose?.(this.state, key, value) ?? { ...this.state, [key]: value }, true) }));
    const row = make("div", { class: "choice", role: "group" }, ...buttons);
    row.setAttribute("aria-label", names[key] ?? key);
    row.dataset.choice = key;
    const update = (state) => buttons.forEach((button, i) => {
      button.dataset.value = values[i];
      button.setAttribute("aria-pressed", String(state[key] === values[i]));
    });
    return { row, update };
  }

  set(state, moveSliders = true) {
    this.state = state;
    if (moveSliders) for (const { update } of this.rows) update(state);
    for (const { update } of this.choices) update(state);
    this.svg.innerHTML = this.drawing.draw(state, sayIn(this.language));
    const lines = this.drawing.numbers?.(state, this.write, sayIn(this.language)) ?? [];
    while (this.numbers.children.length > lines.length) this.numbers.lastChild.remove();
    while (this.numbers.children.length < lines.length) this.numbers.append(make("p", { class: "numbers" }));
    lines.forEach((line, i) => showMath(this.numbers.children[i], line));
    this.extra?.show(state);
    this.onchange?.();
  }

  press(key) {
    clearTimeout(this.timer);
    const { press } = this.drawing;
    this.set(press(this.state, key), true);
    if (!this.state.play) return;
    const again = () => {
      this.set(press(this.state, "play"), true);
      if (this.state.play && this.element.isConnected) this.timer = setTimeout(again, 40);
    };
    this.timer = setTimeout(again, 40);
  }

  // From the pointer to the drawing's units.
  place(event) {
    const box = this.svg.getBoundingClientRect(), [width, height] = this.drawing.size;
    const k = Math.min(box.width / width, box.height / height);
    return [(event.clientX - box.left - (box.width - k * width) / 2) / k, (event.clientY - box.top - (box.height - k * height) / 2) / k];
  }

  listen() {
    let held = null, last = null, moved = 0;
    this.svg.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      held = event.target.closest("[data-handle]")?.dataset.handle ?? "";
      if (held === "" && !this.drawing.turns && !this.drawing.click) return void (held = null);
      last = this.place(event);
      moved = 0;
      this.svg.setPointerCapture(event.pointerId);
      if (held || this.drawing.turns) event.preventDefault();
    });
    this.svg.addEventListener("pointermove", (event) => {
      if (held === null) return;
      const at = this.place(event), step = [at[0] - last[0], at[1] - last[1]];
      moved += Math.abs(step[0]) + Math.abs(step[1]);
      last = at;
      const next = this.drawing.drag?.(this.state, held, step, at);
      if (next) this.set(this.within(next), true);
    });
    const end = () => {
      if (held !== null && moved < 3 && this.drawing.click) this.set(this.drawing.click(this.state, last), true);
      held = null;
    };
    this.svg.addEventListener("pointerup", end);
    this.svg.addEventListener("pointercancel", () => { held = null; });
  }

  // What a slider sets stays in its range, also when it is dragged on the drawing.
  within(state) {
    const kept = { ...state };
    for (const { slider } of this.rows) {
      if (!(slider.name in kept)) continue;
      const value = Math.min(Math.max(kept[slider.name], slider.min), slider.max);
      kept[slider.name] = slider.step ? Math.round(value / slider.step) * slider.step : Number(value.toPrecision(3));
    }
    return kept;
  }

  // As of the live figures; nothing has to be rendered.
  start() {}
  stop() { clearTimeout(this.timer); }
}
