// The camera's back: the sensor and its exposure, the histogram of the numbers it gives, and what a meter says. Shutter and ISO speed expose
// the light that is there anew; f-number and focus are the lens's, whose light is rendered.
import { make, metric, row, short } from "./dom.js";

const colours = { R: "#e5484d", G: "#46a758", B: "#3e7bfa", C: "#22b8cf", M: "#d6409f", Y: "#d9a514", W: "#8b8d91" };
const percent = share => `${share > 0 && share < 0.001 ? "< 0.1" : (100 * share).toFixed(1)} %`;
const seconds = t => !Number.isFinite(t) ? "–" : t > 0 && t < 0.3 ? `1/${short(1 / t, 2)} s` : `${short(t, 2)} s`;

// The number of a text: "1/60", "0.5"; NaN: none.
function read(text) {
  const [, over, below] = text.trim().replace(",", ".").match(/^([^/]+?)\s*(?:\/\s*([^/]+))?$/) || [];
  return over === undefined ? NaN : Number(over) / (below === undefined ? 1 : Number(below));
}

export class Sensor {
  constructor(root, app) {
    this.app = app;
    this.root = root;
    root.hidden = true; // until velo has sensors
    const select = (id, name) => make("select", { id, onchange: event => this.set({ [name]: event.target.value }) });
    const button = (id, textContent, title, onclick) => make("button", { id, textContent, title, onclick });
    this.on = button("sensor-on", "As the camera sees it", "the image is what a sensor makes of the light: it is rendered with a spectrum", () => this.toggle());
    this.preset = select("sensor-preset", "preset");
    this.white = select("sensor-white", "white");
    this.time = this.dial("exposure_time", "shutter s", -13, 6, t => t < 0.3 ? `1/${short(1 / t, 3)}` : short(t, 3));
    this.iso = this.dial("iso", "ISO", Math.log2(50), Math.log2(102400), v => short(v, 5));
    this.aperture = this.lens("f_number", "f-number", "of the lens: the light is rendered anew");
    this.focus = this.lens("focus_distance", "focus at", "depth of the plane in focus: the light is rendered anew");
    this.meter = button("sensor-meter", "Meter", "the shutter at which the mean is 18 % of the range", () => this.set({ exposure_time: null }));
    this.again = button("sensor-again", "Another frame", "the same exposure with other noise", () => this.set({ frame: this.now.frame + 1 }));
    this.histogram = make("canvas", { id: "numbers", width: 256, height: 72, title: "histogram of the raw numbers behind each filter" });
    this.list = make("dl", { class: "values" });
    this.hint = make("div", { class: "hint" });
    this.why = make("div", { class: "why", role: "status" });
    root.append(make("div", { class: "buttons" }, this.on), row(make("label", { textContent: "sensor", htmlFor: "sensor-preset" }), this.preset),
      this.time.row, this.iso.row, this.aperture.row, this.focus.row, row(make("label", { textContent: "white", htmlFor: "sensor-white" }), this.white), this.why,
      make("div", { class: "buttons" }, this.meter, this.again), this.histogram, this.list, this.hint);
    this.white.title = "what becomes white: daylight (D65), incandescent light (A), the mean of the image (auto)";
  }

  // A number with a slider in thirds of a stop; from, to: powers of two.
  dial(name, label, from, to, format) {
    const id = `sensor-${name}`, input = make("input", { type: "text", id, inputMode: "decimal", autocomplete: "off", class: "narrow" });
    const slider = make("input", { type: "range", min: Math.floor(3 * from), max: Math.ceil(3 * to), step: 1 });
    slider.setAttribute("aria-label", `${label} in thirds of a stop`);
    input.onchange = () => this.typed(input, value => this.set({ [name]: value }));
    slider.oninput = () => this.set({ [name]: Number((2 ** (slider.value / 3)).toPrecision(4)) });
    return { input, slider, format, row: row(make("label", { textContent: label, htmlFor: id }), input, slider) };
  }
  lens(name, label, title) {
    const id = `sensor-${name}`, input = make("input", { type: "text", id, inputMode: "decimal", autocomplete: "off", title });
    input.onchange = () => this.typed(input, value => this.app.edit({ [name]: value }, this.app.next()));
    return { name, input, row: row(make("label", { textContent: label, htmlFor: id, title }), input) };
  }

  typed(input, send) {
    const value = read(input.value);
    this.why.textContent = Number.isFinite(value) ? "" : "not a number";
    if (Number.isFinite(value)) send(value);
  }
  set(set) {
    this.why.textContent = "";
    this.app.connection.send({ type: "sensor", change: ++this.app.change, set });
  }
  toggle() { this.app.settings({ channel: this.isOn ? "image" : "camera", change: ++this.app.change }); }
  get isOn() { return this.app.display.channels[this.app.state?.channel] === "camera"; }

  lists(message) {
    this.root.hidden = !message.sensors;
    for (const [box, names] of [[this.preset, message.sensors], [this.white, message.whites]])
      box.replaceChildren(...(names || []).map(n => make("option", { value: n, textContent: n })));
  }

  show(state) {
    const { sensor, camera } = state;
    if (!sensor) return;
    this.now = sensor;
    this.preset.value = sensor.preset;
    this.white.value = sensor.white;
    this.on.setAttribute("aria-pressed", String(this.isOn));
    if (this.isOn) this.root.open = true;
    this.meter.setAttribute("aria-pressed", String(sensor.exposure_time === null));
    for (const { name, input } of [this.aperture, this.focus])
      if (input !== document.activeElement) input.value = camera[name] === null ? "" : short(camera[name], 4);
    this.place(this.time, sensor.exposure_time ?? this.last?.exposure_time);
    this.place(this.iso, sensor.iso || this.last?.iso);
  }
  place({ input, slider, format }, value) {
    if (input !== document.activeElement) input.value = value === undefined ? "" : format(value);
    if (slider !== document.activeElement) slider.value = value > 0 ? Math.round(3 * Math.log2(value)) : slider.min;
  }

  enable(on) {
    for (const { input, slider } of [this.time, this.iso, this.aperture, this.focus]) for (const e of [input, slider]) if (e) e.disabled = !on;
    for (const e of [this.on, this.preset, this.white, this.meter, this.again]) e.disabled = !on;
  }
  refused(field, why) {
    const own = ["preset", "white", "exposure_time", "iso", "frame"].includes(field);
    if (own) this.why.textContent = why;
    return own;
  }

  // What velo tells of an exposure.
  exposed(e) {
    this.last = e;
    this.exposures = (this.exposures || 0) + 1;
    if (this.now) {
      if (this.now.exposure_time === null) this.place(this.time, e.exposure_time);
      this.place(this.iso, e.iso);
    }
    if (e.lens_f_number === null) this.aperture.input.placeholder = `${short(e.f_number, 3)}, pinhole`;
    const rows = e.filters.map(f => [f.name, `mean ${short(f.mean, 4)}, clipped ${percent(f.clipped)}`]);
    rows.push(["numbers", `${e.bits} bits, black ${e.black}, saturation ${e.white}`], ["full wells", percent(e.full)],
      ["EV set", e.ev === null ? "–" : short(e.ev, 3)],
      ["EV metered", e.metered_ev === null ? "–" : `${short(e.metered_ev, 3)}, mean ${short(e.luminance, 3)} cd/m²`],
      ["suggested", e.suggested_iso === null ? "no light" : `ISO ${e.suggested_iso < 1e4 ? short(e.suggested_iso, 2) : metric(e.suggested_iso)} or ${seconds(e.suggested_time)}`]);
    this.list.replaceChildren(...rows.flatMap(r => [make("dt", { textContent: r[0] }), make("dd", { textContent: r[1] })]));
    const words = [];
    if (e.film_noise > 0.01) words.push(`In ${percent(e.film_noise)} of the pixels the render's own noise is above a tenth of the photon noise: more samples.`);
    if (e.lens_f_number === null) words.push(`The lens has no opening: all is sharp, and f/${short(e.f_number, 3)} counts for the light only.`);
    else if (e.lens_f_number !== e.f_number)
      words.push(`The lens has f/${short(e.lens_f_number, 3)} if a scene unit is a metre, beyond the sensor's 0.5 to 1000: f/${short(e.f_number, 3)} counts for the light.`);
    words.push(`The spectrum has ${e.buckets} buckets.`);
    this.hint.textContent = words.join(" ");
    this.draw(e);
  }

  // The numbers from 0 to the converter's greatest; counts as square roots; lines at the black level and at saturation.
  draw(e) {
    const { width, height } = this.histogram, g = this.histogram.getContext("2d"), most = Math.max(1, ...e.filters.flatMap(f => f.bins));
    g.clearRect(0, 0, width, height);
    g.fillStyle = getComputedStyle(this.histogram).color;
    for (const level of [e.black, e.white]) g.fillRect(Math.min(width - 1, Math.floor(width * level / 2 ** e.bits)), 0, 1, height);
    for (const f of e.filters) {
      const step = width / f.bins.length;
      g.strokeStyle = colours[f.name] || "#8b8d91";
      g.lineWidth = 1.5;
      g.beginPath();
      f.bins.forEach((n, i) => g.lineTo((i + 0.5) * step, height - 1 - (height - 3) * Math.sqrt(n / most)));
      g.stroke();
    }
  }
}
