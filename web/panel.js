// The camera panel: all spellings at once. Labels are dragged, numbers typed, sliders moved; what velo refuses is shown
// beside the field in velo's words.
import { make, row, short } from "./dom.js";
import { groups } from "./fields.js";

export class Panel {
  // edit(set, gesture); lists: choices of velo by name
  constructor(root, edit) {
    this.edit = edit;
    this.fields = new Map();
    this.gesture = 2e6;
    this.start = {};
    for (const group of groups) {
      const title = make("h3", { textContent: group.title });
      root.append(title);
      for (const field of group.fields) root.append(...this.makeField(field, group));
    }
  }

  makeField(field, group) {
    const entry = { field, group, inputs: [], why: make("div", { class: "why" }) };
    const id = `field-${field.name}`, label = make("label", { textContent: field.label, title: field.title || "", htmlFor: id });
    if (field.choices || field.list) {
      const select = make("select", { id });
      entry.choose = names => select.replaceChildren(...names.map(n => make("option", { value: n, textContent: n })));
      entry.choose(field.choices || []);
      select.onchange = () => this.edit({ [field.name]: select.value }, ++this.gesture);
      entry.inputs.push(select);
    } else {
      for (let i = 0; i < (field.count || 1); i++) {
        const input = make("input", { type: "text", id: i ? "" : id, inputMode: "decimal", autocomplete: "off", spellcheck: false });
        if (field.count) input.setAttribute("aria-label", `${field.label} ${i + 1}`);
        input.onchange = () => this.typed(entry);
        input.onkeydown = event => this.nudge(event, entry, i);
        entry.inputs.push(input);
      }
      if (!field.count && !field.text) this.scrub(label, entry);
    }
    entry.row = row(label, ...entry.inputs);
    this.fields.set(field.name, entry);
    if (field.slide) this.addSlider(entry);
    return [entry.row, entry.why];
  }

  addSlider(entry) {
    const slider = make("input", { type: "range", min: 0, max: 1, step: "any" });
    slider.setAttribute("aria-label", entry.field.label);
    slider.onpointerdown = () => { this.gesture++; this.sliding = entry; };
    slider.oninput = () => this.edit({ [entry.field.name]: this.sliderValue(entry, Number(slider.value)) }, this.gesture);
    slider.onchange = () => { this.sliding = null; this.gesture++; };
    entry.slider = slider;
    entry.inputs[0].classList.add("narrow");
    entry.inputs[0].after(slider);
  }

  // The range of a slider: linear, or octaves about the first value.
  sliderRange(entry) {
    const { slide } = entry.field, start = this.start[entry.field.name] || 1;
    if (slide.octaves) return [Math.log(start) - slide.octaves * Math.LN2, Math.log(start) + slide.octaves * Math.LN2];
    return slide.relative ? [slide.from, slide.to * (this.size || 1) * 0.1] : [slide.from, slide.to];
  }
  sliderValue(entry, t) {
    const [a, b] = this.sliderRange(entry), v = a + t * (b - a);
    return Number((entry.field.slide.octaves ? Math.exp(v) : v).toPrecision(4));
  }
  placeSlider(entry, value) {
    const [a, b] = this.sliderRange(entry), v = entry.field.slide.octaves ? Math.log(value) : value;
    entry.slider.value = Math.max(0, Math.min(1, (v - a) / (b - a)));
    entry.slider.disabled = value === null;
  }

  // A label that is dragged changes its number: by its own size, or by degrees.
  scrub(label, entry) {
    label.classList.add("scrub");
    label.onpointerdown = event => {
      const from = this.camera?.[entry.field.name];
      if (typeof from !== "number") return;
      label.setPointerCapture(event.pointerId);
      this.gesture++;
      const x = event.clientX, angle = entry.field.label.includes("°");
      const additive = angle || ["cx", "cy", "skew", "near"].includes(entry.field.name);
      label.onpointermove = move => {
        const n = move.clientX - x, value = additive || from === 0 ? from + n * (angle ? 0.25 : from === 0 ? 0.005 : 1) : from * Math.exp(0.006 * n);
        if (n) this.edit({ [entry.field.name]: Number(value.toPrecision(6)) }, this.gesture);
      };
      label.onpointerup = label.onpointercancel = () => { label.onpointermove = null; this.gesture++; };
    };
  }

  // Reads the inputs of a field and sends them.
  typed(entry) {
    const read = text => {
      const plain = text.trim().replace("−", "-").replace(",", ".");
      return plain === "" || plain === "∞" ? null : Number(plain);
    };
    let value;
    if (entry.field.text) value = entry.inputs[0].value.split(/[\s,;]+/).filter(Boolean).map(Number);
    else if (entry.field.count) value = entry.inputs.map(i => read(i.value)).filter(v => v !== null);
    else value = read(entry.inputs[0].value);
    if ([value].flat().some(Number.isNaN)) { entry.why.textContent = "not a number"; return; }
    entry.why.textContent = "";
    this.edit({ [entry.field.name]: value }, ++this.gesture);
  }

  nudge(event, entry, i) {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    const now = Number(entry.inputs[i].value);
    if (Number.isNaN(now) || entry.field.text) return;
    event.preventDefault();
    const step = (event.shiftKey ? 0.1 : 0.01) * (Math.abs(now) || 1), sign = event.key === "ArrowUp" ? 1 : -1;
    entry.inputs[i].value = short(now + sign * step);
    this.typed(entry);
  }

  lists(message) {
    for (const entry of this.fields.values()) if (entry.field.list) entry.choose(message[entry.field.list]);
  }

  // Shows a camera. An input that is being typed into keeps its text.
  show(camera, size) {
    if (!this.camera) for (const name of ["d", "zoom", "s", "focus_distance"]) this.start[name] = camera[name];
    this.camera = camera;
    this.size = size;
    for (const [name, entry] of this.fields) {
      const value = camera[name], values = entry.field.text ? [value.map(v => short(v, 9)).join(" ")] : [value].flat();
      entry.inputs.forEach((input, i) => {
        if (input === document.activeElement && input.type === "text" && !this.applied) return;
        input.value = typeof values[i] === "string" ? values[i] : values[i] === null && name === "far" ? "∞" : short(values[i], 8);
      });
      entry.row.classList.toggle("current", entry.group.spelling === camera.spelled);
      if (entry.slider && this.sliding !== entry) this.placeSlider(entry, value);
    }
  }

  accepted() { for (const entry of this.fields.values()) entry.why.textContent = ""; }
  refused(field, why) {
    const entry = this.fields.get(field);
    if (entry) entry.why.textContent = why;
    return Boolean(entry);
  }
  enable(on) {
    for (const entry of this.fields.values()) for (const input of [...entry.inputs, entry.slider]) if (input) input.disabled = !on;
  }
}
