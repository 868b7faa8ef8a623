// How the image is shown: exposure, view transform, which channel, false colours and their legend, histogram.
import { byId, make, row, short } from "./dom.js";
import { fromHalf } from "./half.js";
import { flowColour, viridis } from "./plain.js";

// What can be shown: its words, its kind (shaders.js), and its unit if it has one. velo says which of them it has.
const shown = {
  image: { label: "image", kind: 0 },
  Z: { label: "depth", kind: 1 },
  distance: { label: "distance", kind: 1 },
  P: { label: "position", kind: 3 },
  N: { label: "normals", kind: 2 },
  Ng: { label: "geometric normals", kind: 2 },
  uv: { label: "uv", kind: 4 },
  albedo: { label: "albedo", kind: 5 },
  ray: { label: "ray directions", kind: 2 },
  "id.object": { label: "objects", kind: 6 },
  "id.material": { label: "materials", kind: 6 },
  "id.instance": { label: "instances", kind: 6 },
  "id.primitive": { label: "faces", kind: 6 },
  error: { label: "standard error", kind: 8 },
  forward: { label: "flow", kind: 7 },
  luminance: { label: "luminance", kind: 9, unit: "cd/m²" },
  illuminance: { label: "illuminance", kind: 9, unit: "lx" },
  camera: { label: "as the camera sees it", kind: 5 }, // no ground truth: sensor.js
};
const camera = 64; // its number in states and frames

// The number with the fewest digits that is the same single-precision float: 0.33 for 0.33000001311302185.
function plain(value) {
  for (let digits = 1; digits < 10; digits++)
    if (Math.fround(Number(value.toPrecision(digits))) === Math.fround(value)) return Number(value.toPrecision(digits));
  return value;
}

export class Display {
  constructor(root, app) {
    this.app = app;
    this.channels = ["image"];
    this.ev = 0; // the exposure; the slider shows it as far as it reaches
    this.channel = make("select", { id: "channel", onchange: () => app.settings({ channel: this.channel.value }) });
    this.exposure = make("input", { type: "range", id: "exposure", min: -8, max: 8, step: "any", oninput: () => this.set(Math.round(20 * this.exposure.value) / 20) });
    this.number = make("input", { type: "text", size: 5, inputMode: "decimal", onchange: () => this.type() });
    this.number.setAttribute("aria-label", "exposure in stops");
    this.view = make("select", { id: "view", onchange: () => this.set(this.ev) });
    for (const [i, name] of ["standard", "neutral", "agx", "raw"].entries()) this.view.append(make("option", { value: i, textContent: name }));
    this.spp = make("input", { type: "text", id: "spp", inputMode: "numeric", onchange: () => app.settings({ spp: Math.max(1, Math.round(Number(this.spp.value)) || 1) }) });
    this.histogram = make("canvas", { id: "histogram", width: 256, height: 64, title: "histogram of the display values" });
    this.mark = make("button", { id: "mark", textContent: "Flow to this view", title: "flow leads from each later view to this one; at first to the scene's",
      onclick: () => app.settings({ mark: true, change: ++app.change }) });
    const label = (text, id) => make("label", { textContent: text, htmlFor: id });
    this.number.style.width = "58px";
    this.number.style.flex = "none";
    root.append(row(label("show", "channel"), this.channel), row(label("exposure EV", "exposure"), this.exposure, this.number),
      row(label("view", "view"), this.view), row(label("samples", "spp"), this.spp), make("div", { class: "buttons" }, this.mark), this.histogram);
  }

  lists(message) {
    this.channels = ["image", ...message.channels];
    if (message.sensors) this.channels[camera] = "camera";
    this.channel.replaceChildren(...this.channels.filter(c => shown[c]).map(c => make("option", { value: c, textContent: shown[c].label })));
  }

  show(state, first) {
    if (first) {
      this.view.value = state.view;
      this.set(plain(state.exposure));
    }
    this.channel.value = this.channels[state.channel] || "image";
    for (const input of [this.exposure, this.number, this.view]) input.disabled = state.channel === camera; // the sensor has its own
    if (document.activeElement !== this.spp) this.spp.value = state.spp;
  }

  enable(on) {
    for (const input of [this.channel, this.spp, this.mark]) input.disabled = !on;
  }

  expose(step) { this.set(this.ev + step); }

  isCamera(frame) { return frame.channel === camera; }

  type() {
    const value = Number(this.number.value.trim().replace("−", "-").replace(",", "."));
    this.set(this.number.value.trim() && Number.isFinite(value) ? value : this.ev);
  }

  get viewName() { return this.view.selectedOptions[0].textContent; }

  set(ev = this.ev) {
    this.ev = Math.max(-64, Math.min(64, ev)); // the range of velo's setting
    this.exposure.value = this.ev;
    this.number.value = short(this.ev, 6);
    Object.assign(this.app.screen.display, { exposure: this.ev, view: Number(this.view.value) });
    this.app.screen.redevelop();
    this.count();
  }

  // Before a frame is drawn: the kind of its values and their range.
  frame(frame) {
    const name = this.channels[frame.channel] || "image", d = this.app.screen.display;
    d.kind = shown[name]?.kind || 0;
    this.unit = shown[name]?.unit || "";
    if (frame.tileCount === 1 && frame.tiles[0].w === frame.columns && frame.tiles[0].h === frame.rows) this.range(frame, name);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.count(), 150);
  }

  range(frame, name) {
    const d = this.app.screen.display, n = frame.channels, data = frame.tiles[0].pixels;
    d.low = [0, 0, 0];
    d.high = [1, 1, 1];
    if (d.kind === 3) {
      const b = this.app.state.bounds;
      d.low = b.slice(0, 3);
      d.high = b.slice(3);
    } else if (d.kind === 9) {
      [d.low, d.high] = logRange(data, n);
    } else if ([1, 7, 8].includes(d.kind)) {
      const values = [];
      for (let i = 0; i < data.length; i += n * Math.max(1, Math.floor(data.length / n / 20000))) {
        const v = d.kind === 7 ? Math.hypot(data[i], data[i + 1]) : d.kind === 8 ? Math.max(data[i], data[i + 1], data[i + 2]) : data[i];
        if (Number.isFinite(v)) values.push(v);
      }
      values.sort((a, b) => a - b);
      const at = share => values[Math.min(values.length - 1, Math.floor(share * values.length))] ?? 0;
      d.low = [d.kind === 7 ? 0 : at(0.005), 0, 0];
      d.high = [Math.max(at(0.995), d.low[0] + (d.kind === 7 ? 1e-3 : 1e-9)), 1, 1];
    }
    this.legend(name, d);
  }

  legend(name, d) {
    const box = byId("legend"), text = {
      2: "x, y, z from −1 to 1 are red, green, blue from 0 to 1", 3: "x, y, z within the scene's bounds are red, green, blue",
      4: "the fractions of u and v are red and green", 6: "a colour for each number" }[d.kind];
    box.hidden = d.kind === 0 || d.kind === 5;
    if (box.hidden) return;
    const { label, unit } = shown[name] || { label: name };
    box.replaceChildren(make("strong", { textContent: unit ? `${label}, ${unit}` : label }));
    if (text) { box.append(make("div", { class: "hint", textContent: text })); return; }
    if (d.kind === 7) {
      box.append(wheel(), make("div", { class: "hint", textContent: `rim: ${short(d.high[0], 3)} pixels; dark: hidden or outside in the other view` }));
      return;
    }
    const bar = make("canvas", { width: 128, height: 1 }), context = bar.getContext("2d");
    for (let x = 0; x < 128; x++) { context.fillStyle = `rgb(${viridis(x / 127).map(v => Math.round(255 * v))})`; context.fillRect(x, 0, 1, 1); }
    if (d.kind === 9) box.append(bar, scale(d.low[0], d.high[0]));
    else box.append(bar, make("div", { class: "ends" }, make("span", { textContent: short(d.low[0], 4) }), make("span", { textContent: short(d.high[0], 4) })));
  }

  // Histogram of the display values (standard view) of the image, on a scale of stops.
  count() {
    const { frame, data } = this.app.screen.pixels, canvas = this.histogram, g = canvas.getContext("2d");
    g.clearRect(0, 0, 256, 64);
    if (!frame || frame.format !== 0) return;
    const bins = [new Float32Array(256), new Float32Array(256), new Float32Array(256)], gain = this.isCamera(frame) ? 1 : 2 ** this.ev;
    const step = 3 * Math.max(1, Math.floor(data.length / 3 / 40000));
    for (let i = 0; i < data.length; i += step)
      for (let c = 0; c < 3; c++) {
        const v = Math.max(0, Math.min(1, fromHalf[data[i + c]] * gain));
        bins[c][Math.min(255, Math.floor(256 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055)))]++;
      }
    const most = Math.max(...bins.map(b => Math.max(...b.subarray(1, 255)))) || 1;
    g.globalCompositeOperation = matchMedia("(prefers-color-scheme: dark)").matches ? "lighter" : "multiply";
    bins.forEach((bin, c) => {
      g.fillStyle = g.globalCompositeOperation === "lighter" ? ["#b33", "#3a3", "#46c"][c] : ["#f99", "#9d9", "#9bf"][c];
      for (let x = 0; x < 256; x++) { const h = 62 * Math.min(1, Math.sqrt(bin[x] / most)); g.fillRect(x, 64 - h, 1, h); }
    });
  }
}

// The range of a logarithmic scale, as powers of two: without the least and the greatest of the values that are above 0, and at least a factor of 4.
function logRange(data, channels) {
  const values = [];
  for (let i = 0; i < data.length; i += channels * Math.max(1, Math.floor(data.length / channels / 20000)))
    if (data[i] > 0 && Number.isFinite(data[i])) values.push(Math.log2(data[i]));
  values.sort((a, b) => a - b);
  const at = share => values[Math.min(values.length - 1, Math.floor(share * values.length))] ?? 0;
  const low = at(0.005), high = at(0.995), room = Math.max(0, 2 - (high - low)) / 2;
  return [[low - room, 0, 0], [high + room, 1, 1]];
}

// The values below the bar of a logarithmic scale: 1, 2 or 5 times a power of ten where there is room, else powers of ten.
function scale(low, high) {
  const box = make("div", { class: "scale" }), tens = Math.floor(low * Math.log10(2)), last = Math.ceil(high * Math.log10(2));
  const decades = (high - low) * Math.log10(2), step = Math.ceil(decades / 5), parts = decades < 2 ? [1, 2, 5] : [1];
  for (let e = tens; e <= last; e += step)
    for (const part of parts) {
      const value = Number(`${part}e${e}`), t = (Math.log2(value) - low) / (high - low);
      if (t < 0 || t > 1) continue;
      const mark = make("span", { textContent: e < -3 || e > 4 ? `${part}e${e}` : String(value) });
      mark.style.left = `${100 * t}%`;
      box.append(mark);
    }
  return box;
}

// The colours of flow.
function wheel() {
  const n = 64, canvas = make("canvas", { width: n, height: n, class: "wheel" }), g = canvas.getContext("2d"), image = g.createImageData(n, n);
  for (let i = 0; i < n * n; i++) {
    const x = (i % n + 0.5) / n * 2 - 1, y = (Math.floor(i / n) + 0.5) / n * 2 - 1, r = Math.hypot(x, y);
    if (r <= 1) image.data.set([...flowColour(x, y, r).map(v => 255 * v), 255], 4 * i);
  }
  g.putImageData(image, 0, 0);
  return canvas;
}
