// The camera panel: all spellings of the camera. The one that it keeps is open, the others are folded and say their main number. Labels
// are dragged, numbers typed, sliders moved; what velo refuses is shown beside the field in velo's words.
import { make, row, short } from "./dom.js";
import { groups } from "./fields.js";

export class Panel {
  // app: edit(set, gesture), next(): the number of a new gesture
  constructor(root, app) {
    this.app = app;
    this.measured = new Map();
    this.fields = new Map();
    this.start = {};
    this.folds = new Map();
    for (const group of groups) {
      const brief = make("span", { class: "brief" }), title = make("summary", {}, make("span", { textContent: group.title }), brief);
      const fold = make("details", { class: "group" }, title);
      for (const field of group.fields) fold.append(...this.makeField(field, group));
      fold.ontoggle = () => this.fitAll();
      this.folds.set(group, { fold, brief });
      root.append(fold);
    }
    new ResizeObserver(() => this.fitAll()).observe(root);
  }

  // At first the pose is open, the spelling that the camera has, and what is not as usual; later the spelling that becomes the
  // camera's opens, and the one before closes.
  unfold(camera, first) {
    for (const [group, { fold, brief }] of this.folds) {
      const own = group.spelling === camera.spelled;
      if (group.spelling) {
        if (first || camera.spelled !== this.spelled) fold.open = own;
      } else if (first) fold.open = !group.brief || Boolean(group.unusual?.(camera));
      brief.textContent = group.brief ? group.brief(camera) : "";
      fold.classList.toggle("current", own);
    }
    this.spelled = camera.spelled;
  }

  makeField(field, group) {
    const entry = { field, group, inputs: [], why: make("div", { class: "why" }) };
    const id = `field-${field.name}`, label = make("label", { textContent: field.label, title: field.title || "", htmlFor: id });
    if (field.choices || field.list) {
      const select = make("select", { id });
      entry.choose = names => select.replaceChildren(...names.map(n => make("option", { value: n, textContent: n })));
      entry.choose(field.choices || []);
      select.onchange = () => this.app.edit({ [field.name]: select.value }, this.app.next());
      entry.inputs.push(select);
    } else {
      for (let i = 0; i < (field.count || 1); i++) {
        const input = make("input", { type: "text", id: i ? "" : id, inputMode: "decimal", autocomplete: "off", spellcheck: false });
        if (field.count) input.setAttribute("aria-label", `${field.label} ${i + 1}`);
        input.onchange = () => this.typed(entry);
        input.onfocus = () => { if (input.value === input.shown) input.value = input.shown = input.whole; };
        input.onblur = () => { if (input.value === input.shown) this.fit(input); };
        input.onkeydown = event => this.nudge(event, entry, i);
        entry.inputs.push(input);
      }
      if (!field.count && !field.text) this.scrub(label, entry);
    }
    entry.row = row(label, ...entry.inputs);
    entry.row.classList.toggle("several", entry.inputs.length > 1);
    this.fields.set(field.name, entry);
    if (field.slide) this.addSlider(entry);
    return [entry.row, entry.why];
  }

  addSlider(entry) {
    const slider = make("input", { type: "range", min: 0, max: 1, step: "any" });
    slider.setAttribute("aria-label", entry.field.label);
    slider.onpointerdown = () => { this.gesture = this.app.next(); this.sliding = entry; };
    slider.oninput = () => {
      const gesture = this.sliding === entry ? this.gesture : this.app.gestures.burst(entry.field.name, 600); // by keys
      this.app.edit({ [entry.field.name]: this.sliderValue(entry, Number(slider.value)) }, gesture);
    };
    slider.onchange = slider.onpointerup = slider.onpointercancel = () => { this.sliding = null; };
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
      const gesture = this.app.next(), x = event.clientX, angle = entry.field.label.includes("°");
      const additive = angle || ["cx", "cy", "skew", "near"].includes(entry.field.name);
      label.onpointermove = move => {
        const n = move.clientX - x, value = additive || from === 0 ? from + n * (angle ? 0.25 : from === 0 ? 0.005 : 1) : from * Math.exp(0.006 * n);
        if (n) this.app.edit({ [entry.field.name]: Number(value.toPrecision(6)) }, gesture);
      };
      label.onpointerup = label.onpointercancel = () => { label.onpointermove = null; };
    };
  }

  // Reads the inputs of a field and sends them; a number that was not typed is sent with all its digits.
  typed(entry, gesture) {
    const read = text => {
      const plain = text.trim().replace("−", "-").replace(",", ".");
      return plain === "" || plain === "∞" ? null : Number(plain);
    };
    let value;
    if (entry.field.text) value = entry.inputs[0].value.split(/[\s,;]+/).filter(Boolean).map(Number);
    else if (entry.field.count) value = entry.inputs.map(i => i.value === i.shown ? i.exact : read(i.value)).filter(v => v !== null);
    else value = read(entry.inputs[0].value);
    if ([value].flat().some(Number.isNaN)) { entry.why.textContent = "not a number"; return; }
    entry.why.textContent = "";
    entry.inputs.forEach((input, i) => {
      if (!entry.field.text && input.value !== input.shown) input.exact = [value].flat()[i] ?? null;
      input.whole = input.shown = input.value;
    });
    this.app.edit({ [entry.field.name]: value }, gesture ?? this.app.next());
  }

  nudge(event, entry, i) {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    const input = entry.inputs[i], now = input.value === input.shown ? input.exact : Number(input.value);
    if (typeof now !== "number" || Number.isNaN(now) || entry.field.text) return;
    event.preventDefault();
    const step = (event.shiftKey ? 0.1 : 0.01) * (Math.abs(now) || 1), sign = event.key === "ArrowUp" ? 1 : -1;
    input.value = short(now + sign * step);
    this.typed(entry, this.app.gestures.burst(`${entry.field.name} ${i}`, 600));
  }

  lists(message) {
    for (const entry of this.fields.values()) if (entry.field.list) entry.choose(message[entry.field.list]);
  }

  // Shows a camera. An input that is being typed into keeps its text.
  show(camera, size) {
    this.unfold(camera, !this.camera);
    if (!this.camera) for (const name of ["d", "zoom", "s", "focus_distance"]) this.start[name] = camera[name];
    this.camera = camera;
    this.size = size;
    for (const [name, entry] of this.fields) {
      const value = camera[name], values = entry.field.text ? [value.map(v => short(v, 9)).join(" ")] : [value].flat();
      const most = entry.field.count === 3 ? Math.max(...values.map(Math.abs)) : 0;
      entry.inputs.forEach((input, i) => {
        if (input === document.activeElement && input.type === "text" && input.value !== input.shown) return;
        input.exact = values[i] ?? null;
        const rounded = Math.abs(values[i]) < 1e-12 * most ? 0 : values[i]; // the rest of a rounding beside other numbers
        input.whole = typeof values[i] === "string" ? values[i] : values[i] === null && name === "far" ? "∞" : short(rounded, 9);
        if (input.type !== "text") input.value = input.whole;
        else if (input === document.activeElement) input.value = input.shown = input.whole;
        else this.fit(input);
      });
      if (entry.slider && this.sliding !== entry) this.placeSlider(entry, value);
    }
  }

  // Shows as many digits as there is room for; all are there with the focus, or under the pointer.
  fit(input) {
    const number = typeof input.exact === "number" ? input.exact : NaN;
    let text = input.whole;
    for (let digits = 8; digits > 2 && Number(text) && Number.isFinite(number) && !this.hasRoom(input, text); digits--) text = short(number, digits);
    input.value = input.shown = text;
    input.title = text === input.whole ? "" : input.whole;
  }
  fitAll() {
    this.measured = new Map();
    for (const { inputs } of this.fields.values())
      for (const input of inputs) if (input.shown !== undefined && input.value === input.shown && input !== document.activeElement) this.fit(input);
  }
  hasRoom(input, text) {
    if (!input.clientWidth) return true; // it is folded
    const kind = input.parentElement.childElementCount * (input.classList.contains("narrow") ? -1 : 1);
    if (!this.measured.has(kind)) {
      const style = getComputedStyle(input), ruler = document.createElement("canvas").getContext("2d");
      ruler.font = `${style.fontSize} ${style.fontFamily}`;
      this.measured.set(kind, { ruler, room: input.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight) });
    }
    const { ruler, room } = this.measured.get(kind);
    return ruler.measureText(text).width <= room;
  }

  accepted() { for (const entry of this.fields.values()) entry.why.textContent = ""; }
  refused(field, why) {
    const entry = this.fields.get(field);
    if (entry) {
      entry.why.textContent = why;
      this.folds.get(entry.group).fold.open = true;
    }
    return Boolean(entry);
  }
  enable(on) {
    for (const entry of this.fields.values()) for (const input of [...entry.inputs, entry.slider]) if (input) input.disabled = !on;
  }
}
