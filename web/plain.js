// The image without WebGL2, where the browser has none or took it away: developed by the processor as shaders.js says, and laid on a
// canvas of its own.
import { fromHalf } from "./half.js";
import { make } from "./dom.js";

const clamp = v => v > 0 ? v < 1 ? v : 1 : 0; // NaN: 0
const curve = v => v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
const sRGB = v => curve(clamp(v));

export function viridis(t) {
  const k = [[0.2777273, 0.0054073, 0.3340998], [0.1050930, 1.4046135, 1.3845902], [-0.3308618, 0.2148476, 0.0950952],
    [-4.6342305, -5.7991010, -19.3324410], [6.2282699, 14.1799334, 56.6905526], [4.7763850, -13.7451454, -65.3530326],
    [-5.4354559, 4.6458526, 26.3124352]];
  return [0, 1, 2].map(i => clamp(k.reduceRight((sum, row) => sum * t + row[i], 0)));
}

// A hue of full saturation, 0 to 1.
const hue = h => [0, 2, 1].map(i => clamp(Math.abs((h + i / 3) % 1 * 6 - 3) - 1));

// The colour of flow: the direction is the hue, the length up to 1 the saturation.
export function flowColour(x, y, size) {
  const h = size > 0 ? (Math.atan2(y, x) / 2 / Math.PI + 1) % 1 : 0;
  return hue(h).map(v => 1 - size * (1 - v));
}

function neutral(c) {
  const start = 0.8 - 0.04, x = Math.min(...c), offset = x <= 0.08 ? x - x * x / 0.16 : 0.04, d = c.map(v => v - offset), peak = Math.max(...d);
  if (peak <= start) return d.map(sRGB);
  const room = 1 - start, to = 1 - room * room / (peak + room - start), g = 1 / (0.15 * (peak - to) + 1);
  return d.map(v => sRGB(v * (to / peak) * g + to * (1 - g)));
}

const inset = [[0.842479062253094, 0.0784335999999992, 0.0792237451477643], [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
  [0.0423756549057051, 0.0784336, 0.879142973793104]];
const outset = [[1.19687900512017, -0.0980208811401368, -0.0990297440797205], [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
  [-0.0529716355144438, -0.0980434501171241, 1.15107367264116]];
const times = (m, v) => m.map(row => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);

function agx(c) {
  const x = times(inset, c).map(v => clamp((Math.log2(Math.max(v, 1e-30)) + 12.47393) / (4.026069 + 12.47393)));
  const r = x.map(v => ((((((15.5 * v - 40.14) * v + 31.96) * v - 6.868) * v + 0.4298) * v + 0.1191) * v - 0.00232));
  return times(outset, r).map(clamp);
}

const views = [c => c.map(sRGB), c => neutral(c.map(v => Math.max(v, 0))), c => agx(c.map(v => Math.max(v, 0))), c => c.map(clamp)];

// Colours of an id, which is a whole number below 2^24, with the precision of shaders.
function idColour(id) {
  const part = v => { const f = Math.fround(Math.fround(id) * Math.fround(v)); return f - Math.floor(f); };
  const light = 0.95 - 0.3 * part(0.38196601125);
  return id === 0 ? [0.08, 0.08, 0.08] : hue(part(0.61803398875)).map(v => light * (0.4 + 0.6 * v));
}

const nothing = [0.13, 0.13, 0.13], fraction = v => v - Math.floor(v);

// By the kind of shaders.js; low, high: the range that is shown.
const kinds = {
  1: (v, low, high) => Number.isFinite(v[0]) ? viridis(clamp((v[0] - low[0]) / (high[0] - low[0]))) : nothing,
  2: v => v.some(x => x !== 0) ? v.map(x => clamp(0.5 + 0.5 * x)) : nothing,
  3: (v, low, high) => v.some(x => x !== 0) ? v.map((x, i) => clamp((x - low[i]) / Math.max(high[i] - low[i], 1e-9))) : nothing,
  4: v => [fraction(v[0]), fraction(v[1]), 0.25],
  5: v => v.map(sRGB),
  6: v => idColour(v[0]),
  7: (v, low, high) => v[2] === 3 ? nothing
    : flowColour(v[0], v[1], Math.min(Math.hypot(v[0], v[1]) / high[0], 1)).map(x => v[2] === 0 ? x : 0.45 * x),
  9: (v, low, high) => !Number.isFinite(v[0]) ? nothing : v[0] <= 0 ? [0, 0, 0]
    : viridis(clamp((Math.log2(Math.max(v[0], 1e-30)) - low[0]) / (high[0] - low[0]))),
  8: (v, low, high) => kinds[1]([Math.max(...v)], low, high),
};

// The display values of a frame, 8-bit RGBA, rows from the top. data: its values; kind, view: as shaders.js.
export function developed(frame, data, display, kind, view) {
  const { columns, rows, channels } = frame, result = new Uint8ClampedArray(4 * columns * rows), half = frame.format === 0;
  const gain = 2 ** display.exposure, number = i => half ? fromHalf[data[i]] : data[i];
  if (kind === 0 && (view === 0 || view === 3)) { // each value by itself
    const table = new Uint8ClampedArray(65536), one = view === 0 ? sRGB : clamp;
    for (let i = 0; i < 65536; i++) table[i] = 255 * one(fromHalf[i] * gain);
    for (let p = 0, i = 0; p < result.length; p += 4, i += channels) {
      for (let c = 0; c < 3; c++) result[p + c] = table[data[i + c]];
      result[p + 3] = 255;
    }
    return result;
  }
  const colour = kind === 0 ? v => views[view](v.map(x => Number.isNaN(x) ? 0 : Math.max(-1e30, Math.min(1e30, x * gain)))) : v => kinds[kind](v, display.low, display.high);
  for (let p = 0, i = 0; p < result.length; p += 4, i += channels) {
    const v = [0, 1, 2].map(c => c < channels ? number(i + c) : 0); // as a texture of fewer channels gives it
    colour(kind === 0 && v.some(Number.isNaN) ? [0, 0, 0] : v).forEach((x, c) => { result[p + c] = 255 * x; });
    result[p + 3] = 255;
  }
  return result;
}

// The canvas, beside that of WebGL.
export class Plain {
  constructor(beside) {
    this.canvas = make("canvas", { id: "plain", hidden: true });
    beside.after(this.canvas);
    this.now = make("canvas");
    this.whole = make("canvas"); // the last frame of the whole image, behind a rectangle
  }

  // The frame or what develops it changed. bytes(): its display values.
  develop(frame, cropped, bytes) {
    const to = cropped ? this.now : this.whole;
    to.frame = frame;
    to.width = frame.columns;
    to.height = frame.rows;
    to.getContext("2d").putImageData(new ImageData(bytes(), frame.columns, frame.rows), 0, 0);
  }

  // left, top: of the image, k: size of its pixels; all in pixels of the canvas.
  draw(width, height, left, top, k, cropped, smooth) {
    const g = this.canvas.getContext("2d");
    this.canvas.width = width;
    this.canvas.height = height;
    for (const [layer, alpha] of cropped ? [[this.whole, 0.45], [this.now, 1]] : [[this.whole, 1]]) {
      const f = layer.frame;
      if (!f) continue;
      g.save();
      g.beginPath();
      g.rect(left, top, f.width * k, f.height * k); // the last pixels of a coarse image reach beyond the image
      g.clip();
      g.fillStyle = "#000";
      g.fillRect(left + f.x0 * k, top + f.y0 * k, f.columns * f.scale * k, f.rows * f.scale * k);
      g.globalAlpha = alpha;
      g.imageSmoothingEnabled = smooth;
      g.drawImage(layer, left + f.x0 * k, top + f.y0 * k, f.columns * f.scale * k, f.rows * f.scale * k);
      g.restore();
    }
  }
}
