// The value under the pointer, and what a picked pixel sees.
import { byId, make, short } from "./dom.js";

const numbers = values => (values || []).map(v => short(v, 4)).join("  ");

export class Inspector {
  constructor(root, app) {
    this.app = app;
    this.root = root;
    this.zoomed = make("canvas", { id: "zoomed", width: 15, height: 9, title: "the pixels around the pointer" });
    this.list = make("dl", { class: "values" });
    this.hint = make("div", { class: "hint", textContent: "Click the image: what this pixel sees." });
    root.append(this.zoomed, this.hint, this.list);
    this.x = this.y = -1;
  }

  hover(x, y) {
    this.x = x;
    this.y = y;
    this.frame();
  }

  // The numbers under the pointer, again when a frame came.
  frame() {
    const box = byId("hover"), x = Math.floor(this.x), y = Math.floor(this.y), values = this.app.screen.pixels.at(x, y);
    box.textContent = values ? `${x}, ${y}   ${values.map(v => short(v, 4)).join("  ")}${this.app.display.unit ? ` ${this.app.display.unit}` : ""}${["", "  denoised", "  moved"][this.app.screen.frame.denoised]}` : "";
    if (values && this.root.open) this.magnify(x, y);
  }

  // 15 x 9 pixels around the pointer, in the colours of the screen.
  magnify(x, y) {
    const context = this.zoomed.getContext("2d"), gain = 2 ** this.app.screen.display.exposure;
    for (let j = 0; j < 9; j++)
      for (let i = 0; i < 15; i++) {
        const v = this.app.screen.pixels.at(x + i - 7, y + j - 4);
        const c = [0, 1, 2].map(k => {
          const l = Math.max(0, Math.min(1, (v ? v[Math.min(k, v.length - 1)] : 0) * gain));
          return Math.round(255 * (l <= 0.0031308 ? 12.92 * l : 1.055 * l ** (1 / 2.4) - 0.055));
        });
        context.fillStyle = v ? `rgb(${c})` : "#0000";
        context.clearRect(i, j, 1, 1);
        context.fillRect(i, j, 1, 1);
      }
  }

  picked(p) {
    this.root.open = true;
    const name = o => o.id ? `${o.name || "(no name)"}${o.type ? `, ${o.type}` : ""}` : "nothing";
    const place = o => o.file ? `${o.file.split("/").pop()}:${o.line}` : "";
    const rows = [["pixel", `${p.x}, ${p.y}`], ["object", name(p.object)], ["", place(p.object)], ["material", name(p.material)],
      ["instance", p.instance.id ? name(p.instance) : ""], ["depth z", numbers(p.Z)], ["distance", numbers(p.distance)],
      ["position", numbers(p.P)], ["normal", numbers(p.N)], ["geometric", numbers(p.Ng)], ["uv", numbers(p.uv)],
      ["albedo", numbers(p.albedo)], ["texture", "…"], ["ray", numbers(p.ray)]];
    this.hint.hidden = true;
    this.list.replaceChildren(...rows.filter(r => r[1]).flatMap(r => [make("dt", { textContent: r[0] }), make("dd", { textContent: r[1] })]));
    this.object = p.object;
  }

  // The texture is known once the pixel's paths are.
  texture(paths) {
    const name = [...this.list.children].find(e => e.textContent === "texture");
    if (name) name.nextElementSibling.textContent = this.object.id ? paths.textureOf(this.object) : "";
  }
}
