// Compares the image with one that was kept, or with a file: a wipe, or the difference.
import { make, row } from "./dom.js";

export class Compare {
  constructor(root, app) {
    this.app = app;
    this.canvas = make("canvas", { id: "other" });
    this.canvas.hidden = true;
    app.screen.canvas.after(this.canvas);
    const file = make("input", { type: "file", accept: "image/png,image/jpeg,image/webp", onchange: () => this.load(file.files[0]) });
    file.hidden = true;
    this.mode = make("select", { id: "compare-mode", onchange: () => this.draw() });
    for (const name of ["off", "wipe", "difference"]) this.mode.append(make("option", { value: name, textContent: name }));
    this.edge = make("input", { type: "range", min: 0, max: 1, step: "any", value: 0.5, oninput: () => this.draw() });
    this.edge.setAttribute("aria-label", "place of the wipe");
    this.gain = make("input", { type: "range", min: 0, max: 5, step: 0.1, value: 2, oninput: () => this.draw() });
    this.gain.setAttribute("aria-label", "gain of the difference");
    this.number = make("div", { class: "hint" });
    root.append(make("div", { class: "buttons" },
      make("button", { id: "keep", textContent: "Keep this image", onclick: () => this.keep() }),
      make("button", { textContent: "Open a file", onclick: () => file.click() }), file),
    row(make("label", { textContent: "compare", htmlFor: "compare-mode" }), this.mode),
    row(make("span", { textContent: "edge" }), this.edge), row(make("span", { textContent: "gain" }), this.gain), this.number);
  }

  // Keeps the image as it is shown now.
  keep() {
    const f = this.app.screen.frame;
    if (!f) return;
    this.other = new ImageData(new Uint8ClampedArray(this.app.screen.values()), f.columns, f.rows);
    if (this.mode.value === "off") this.mode.value = "wipe";
    this.draw();
  }

  async load(file) {
    if (!file) return;
    const bitmap = await createImageBitmap(file), c = new OffscreenCanvas(bitmap.width, bitmap.height), g = c.getContext("2d");
    g.drawImage(bitmap, 0, 0);
    this.other = g.getImageData(0, 0, bitmap.width, bitmap.height);
    if (this.mode.value === "off") this.mode.value = "wipe";
    this.draw();
  }

  // The second canvas lies over the first, at the same place.
  draw() {
    const on = this.other && this.mode.value !== "off" && this.app.screen.frame;
    this.canvas.hidden = !on;
    if (!on) { this.number.textContent = ""; return; }
    const f = this.app.screen.frame, k = this.app.screen.factor(), [left, top] = this.app.screen.origin();
    const { width, height } = this.other;
    this.canvas.width = width;
    this.canvas.height = height;
    Object.assign(this.canvas.style, { position: "absolute", left: `${left}px`, top: `${top}px`, width: `${f.width * k}px`,
      height: `${f.height * k}px`, pointerEvents: "none", imageRendering: k > 1.5 ? "pixelated" : "auto" });
    const g = this.canvas.getContext("2d");
    if (this.mode.value === "wipe") {
      g.putImageData(this.other, 0, 0);
      const edge = this.edge.value * width;
      g.clearRect(edge, 0, width - edge, height);
      g.fillStyle = "#fff";
      g.fillRect(edge, 0, Math.max(1, width / 600), height);
      this.number.textContent = "left: the kept image; right: the present one";
    } else this.difference(g, f, width, height);
  }

  difference(g, f, width, height) {
    if (width !== f.columns || height !== f.rows) {
      this.number.textContent = `the kept image has ${width} x ${height} pixels, this one ${f.columns} x ${f.rows}`;
      return;
    }
    const now = this.app.screen.values(), result = new ImageData(width, height), gain = 2 ** this.gain.value;
    let sum = 0, most = 0;
    for (let i = 0; i < now.length; i += 4) {
      for (let c = 0; c < 3; c++) {
        const d = Math.abs(now[i + c] - this.other.data[i + c]);
        sum += d, most = Math.max(most, d);
        result.data[i + c] = d * gain;
      }
      result.data[i + 3] = 255;
    }
    g.putImageData(result, 0, 0);
    this.number.textContent = `mean difference ${(sum / (0.75 * now.length)).toPrecision(3)} of 255, greatest ${most}`;
  }

  frame() {
    clearTimeout(this.timer);
    if (this.other && this.mode.value === "difference") this.timer = setTimeout(() => this.draw(), 200);
    else if (this.other && this.mode.value === "wipe") this.draw();
  }
}
