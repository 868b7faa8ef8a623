// The paths of a picked pixel: traced again by velo, listed vertex by vertex, and as lines for the view from outside.
import { add, length, scale, sub } from "./vec.js";
import { make, row, short } from "./dom.js";

const ends = { absorbed: "absorbed", roulette: "ended by Russian roulette", depth: "ended: the largest number of bounces" };
const percent = share => `${Number((100 * share).toPrecision(3))} %`;
const colour = rgb => rgb.map(v => short(v, 3)).join(" ");
const called = o => o.name ? `${o.name} (${o.type})` : `${o.type || "object"} ${o.id}`;
// How light was found, as docs/tracers.md says it.
const light = c => c.event === "medium" ? "emission of the medium"
  : `${{ sampled: "sampled light", hit: "met light", sky: "left to light" }[c.event]} ${c.light} (${c.light_type})`;

export class Paths {
  constructor(root, app) {
    this.app = app;
    this.root = root;
    this.samples = make("select", { id: "path-samples", onchange: () => this.ask() });
    for (const [value, text] of [["16", "16"], ["256", "256"], ["4096", "4096"], ["all", "all of the image"]])
      this.samples.append(make("option", { value, textContent: text }));
    this.order = make("select", { id: "path-order", onchange: () => this.ask() },
      make("option", { value: "share", textContent: "largest share first" }), make("option", { value: "sample", textContent: "by sample" }));
    this.report = make("div", { class: "hint", role: "status" });
    this.list = make("div", { id: "path-list" });
    this.outside = make("button", { id: "path-outside", textContent: "Show them from outside", onclick: () => app.outside.open() });
    this.box = make("div", { hidden: true }, make("h3", { textContent: "Paths" }),
      row(make("label", { textContent: "samples", htmlFor: "path-samples" }), this.samples),
      row(make("label", { textContent: "order", htmlFor: "path-order" }), this.order),
      make("div", { class: "buttons" }, this.outside), this.report, this.list);
    root.append(this.box);
    this.lines = [];
  }

  // The paths of another pixel.
  pick(x, y) { this.pixel = [x, y]; this.box.hidden = false; this.ask(); }

  ask() {
    if (!this.pixel) return;
    const [x, y] = this.pixel, all = Math.max(1, Math.min(65536, this.app.spp || 1));
    const samples = this.samples.value === "all" ? all : Number(this.samples.value), asked = this.asked = {};
    this.report.textContent = "tracing";
    this.app.ask({ type: "paths", x, y, samples, show: 16, by_sample: this.order.value === "sample" }, answer => {
      if (asked === this.asked) this.show(answer);
    });
  }

  // The camera or the scene changed: these are no longer the paths of the image.
  stale() {
    if (!this.answer) return;
    this.clear("The camera moved: click again.");
  }

  clear(text) {
    this.answer = null;
    this.lines = [];
    this.report.textContent = text;
    this.list.replaceChildren();
    this.app.outside.draw();
  }

  show(answer) {
    if (answer.type !== "paths") return this.clear(answer.message);
    this.answer = answer;
    this.chosen = 0;
    this.report.textContent = this.summary(answer);
    this.list.replaceChildren(...answer.paths.map((path, i) => this.entry(path, i)));
    this.onpaths?.(answer);
    this.trace();
  }

  // Where the pixel's value is from; the largest path of a firefly is named.
  summary(answer) {
    const n = answer.samples, largest = answer.paths.reduce((a, b) => b.share > (a?.share ?? -1) ? b : a, null);
    const around = answer.counted === n ? "" : ` (${answer.counted} with those of the pixels around)`;
    let text = `${n} sample${n > 1 ? "s" : ""}${around} by ${answer.tracer}: mean ${colour(answer.mean)}.`;
    if (answer.dropped) text += ` ${answer.dropped} not finite.`;
    const best = largest?.contributions.reduce((a, b) => Math.hypot(...b.rgb) > Math.hypot(...(a?.rgb || [0])) ? b : a, null);
    if (!best || largest.share < 4 / answer.counted) return text;
    const v = largest.vertices[best.vertex], where = v.object ? ` at ${called(v.object)}` : "";
    return `${text} Sample ${this.name(largest)} brings ${percent(largest.share)}: ${light(best)}${best.object ? `, ${called(best.object)},` : ""}${where},`
      + ` vertex ${best.vertex}, weight ${short(best.weight, 3)}${best.bsdf_pdf !== undefined ? `, densities ${short(best.light_pdf, 3)} and ${short(best.bsdf_pdf, 3)}` : ""}.`;
  }

  // The number of a path's sample, with its pixel if that is a neighbour of the pixel asked for.
  name(path) {
    const [x, y] = path.pixel, own = x === this.answer.pixel[0] && y === this.answer.pixel[1];
    return own ? path.sample : `${path.sample} of pixel ${x},${y}`;
  }

  entry(path, index) {
    const head = `sample ${this.name(path)}: ${percent(path.share)}, ${path.vertices.length} ${path.vertices.length === 1 ? "vertex" : "vertices"}`;
    const box = make("details", { class: "path" }, make("summary", { textContent: head }));
    box.open = index === 0;
    box.addEventListener("toggle", () => {
      if (box.open && box.childElementCount === 1) box.append(this.table(path));
      if (box.open) { this.chosen = index; this.trace(); }
    });
    if (box.open) box.append(this.table(path));
    return box;
  }

  table(path) {
    const cells = (tag, ...texts) => texts.map(text => make(tag, { textContent: text }));
    const body = make("tbody", {});
    path.vertices.forEach((v, i) => {
      body.append(make("tr", { title: this.details(v) }, ...cells("td", i, this.met(v), this.lobe(v), v.pdf !== undefined && v.bsdf ? short(v.pdf, 3) : "",
        v.throughput.slice(0, 3).map(t => short(t, 2)).join(" "))));
      for (const c of path.contributions.filter(c => c.vertex === i)) {
        const text = `${light(c)}${c.object ? `, ${called(c.object)}` : ""}: ${c.occluded ? "occluded" : `adds ${colour(c.rgb)}`}`;
        const more = c.light_pdf === undefined ? "" : `, pdf light ${short(c.light_pdf, 3)}, bsdf ${short(c.bsdf_pdf, 3)}, weight ${short(c.weight, 3)}`;
        body.append(make("tr", { class: "light" }, make("td"), make("td", { colSpan: 4, textContent: text + (c.occluded ? "" : more) })));
      }
      if (ends[v.fate]) body.append(make("tr", { class: "light" }, make("td"), make("td", { colSpan: 4, textContent: ends[v.fate] })));
    });
    const about = [`rgb ${colour(path.rgb)}`, path.lambda ? `wavelengths ${path.lambda.map(l => short(l, 4)).join(" ")} nm` : "",
      path.camera_weight !== 1 ? `lens ${short(path.camera_weight, 3)}` : ""].filter(Boolean).join("; ");
    return make("div", { class: "scroll" }, make("div", { class: "hint", textContent: about }),
      make("table", { class: "vertices" }, make("thead", {}, make("tr", {}, ...cells("th", "", "met", "scattered by", "pdf", "throughput"))), body));
  }

  met(v) {
    if (v.event === "nothing") return "nothing";
    if (v.event === "medium") return `medium ${v.medium}`;
    return `${v.event === "exit" ? "leaves " : ""}${called(v.object)}${v.material ? `, ${called(v.material)}` : ""}`;
  }
  lobe(v) {
    if (!v.bsdf || v.pdf === undefined) return "";
    const way = v.event === "medium" ? "" : v.transmission ? ", transmitted" : ", reflected";
    return `${v.bsdf}${v.specular ? ", specular" : ""}${way}`;
  }
  details(v) {
    const rows = [["position", v.position], ["normal", v.normal], ["shading normal", v.shading], ["uv", v.uv], ["reflectance", v.reflectance],
      ["texture", v.texture], ["image", v.image], ["factor", v.factor], ["survives with", v.survival < 1 ? v.survival : null]];
    return rows.filter(r => r[1]).map(([name, value]) => `${name} ${Array.isArray(value) ? value.map(x => short(x, 4)).join(" ") : value}`).join("\n");
  }

  // The texture and the image that the pixel shows, of the first path that met this object.
  textureOf(object) {
    for (const path of this.answer?.paths || []) {
      const v = path.vertices[0];
      if (v?.object?.id === object.id) return v.texture ? `${v.texture}${v.image ? ` ${v.image.split("/").pop()}` : ""}` : "none";
    }
    return "";
  }

  // Lines for the view from outside: [kind, path is chosen, from, to].
  trace() {
    this.lines = [];
    const far = 0.3 * length(sub(this.app.camera().lookat, this.app.camera().eye)) || 1;
    const ordered = (this.answer?.paths || []).map((path, i) => [path, i === this.chosen]).sort((a, b) => a[1] - b[1]);
    for (const [path, chosen] of ordered) {
      let from = path.origin;
      for (const v of path.vertices) {
        const to = v.position || add(from, scale(v.arrival, far));
        this.lines.push([v.position ? "path" : "leaves", chosen, from, to]);
        from = to;
      }
      for (const c of path.contributions) {
        const at = path.vertices[c.vertex].position;
        if (c.event !== "sampled" || !at) continue;
        const to = c.point || add(at, scale(c.direction, far));
        this.lines.push([c.occluded ? "occluded" : "light", chosen, at, to]);
      }
    }
    this.app.outside.draw();
  }
}
