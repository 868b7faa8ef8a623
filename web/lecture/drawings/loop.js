// web/lecture/drawings/loop.js: World::render_perspective, pixel by pixel, also with the errors of the slide; the view plane
// with its resolution, pixel size and samples; the samples of one pixel; World::build, edited and run.
import { make } from "../../dom.js";
import { add, scale, unit } from "../../vec.js";
import { circle, frameOf, label, line, polygon, rectangle } from "../svg.js";
import { PINHOLE, WORLD, display, imageAddress, renderScene, traceRay } from "../trace.js";

const image = (frame, address) => `<image x="${frame[0]}" y="${frame[1]}" width="${frame[2]}" height="${frame[3]}" preserveAspectRatio="none" class="pixels" href="${address}"/>`;

// ---- World::render_perspective ----
const H = 16, V = 12, S = 25, E = 500, D = 500, ZW = 100;
const CODE = ["void World::render_perspective(void) const {", "    RGBColor      pixel_color;", "    Ray           ray;", "", "    open.window(hres, vres);", "    ray.o = Point3D(0.0, 0.0, eye);", "",
  "    for (int r = 0; r < vres; r++)           // up", "        for (int c = 0; c COLUMNS hres; c++) {    // across",
  "            ray.d = Point3D(s * (c - hres / 2.0 + 0.5), s * (r - vres / 2.0 + 0.5), THIRD);", "", "            ray.d.normalize();",
  "            pixel_color = tracer_ptr->trace_ray(ray);", "            display_pixel(r, c, pixel_color);", "        }", "}"];
const columnsOf = (s) => (s.columns === "<=" ? H + 1 : H);

// The ray and the colour of the pixel with a number; rows from below.
function stepOf(s, index) {
  const columns = columnsOf(s), r = Math.floor(index / columns), c = index % columns;
  const d = [S * (c - H / 2 + 0.5), S * (r - V / 2 + 0.5), s.third === "zw" ? ZW : -D];
  return { r, c, d, color: display(traceRay([0, 0, E], unit(d))) };
}

function codeOf(s) {
  return CODE.map((text) => text.replace("COLUMNS", s.columns).replace("THIRD", s.third === "zw" ? "zw" : "-d"));
}

const loop = {
  size: [590, 420],
  buttons: ["step", "row", "play", "again"],
  state: { columns: "<", third: "-d", pixel: 75, play: 0 },
  choices: { columns: ["<", "<="], third: ["-d", "zw"] },
  press(s, name) {
    const last = columnsOf(s) * V - 1;
    if (name === "again") return { ...s, pixel: 0, play: 0 };
    if (name === "row") return { ...s, pixel: Math.min(last, (Math.floor(s.pixel / columnsOf(s)) + 1) * columnsOf(s)), play: 0 };
    if (name === "step") return { ...s, pixel: Math.min(last, s.pixel + 1), play: 0 };
    return s.pixel >= last ? { ...s, play: 0 } : { ...s, pixel: s.pixel + 1, play: 1 };
  },
  draw(s, say) {
    const k = 28, x0 = 80, y0 = 30 + k * V;
    let html = rectangle(x0, 30, k * H, k * V, "window");
    const cells = [];
    for (let i = 0; i <= Math.min(s.pixel, columnsOf(s) * V - 1); i++) {
      const { r, c, color } = stepOf(s, i), outside = c >= H;
      cells.push(`<rect x="${x0 + k * c}" y="${y0 - k * (r + 1)}" width="${k}" height="${k}" fill="rgb(${color})" class="own${outside ? " wrong" : ""}"/>`);
      if (outside) cells.push(line([x0 + k * c, y0 - k * r], [x0 + k * (c + 1), y0 - k * (r + 1)], "wrong-line"));
    }
    html += cells.join("");
    const { r, c } = stepOf(s, Math.min(s.pixel, columnsOf(s) * V - 1));
    html += rectangle(x0 + k * c, y0 - k * (r + 1), k, k, "picked") + label([x0 + k * (c + 0.5), y0 + 22], `c = ${c}`, "name", "middle") + label([x0 - 8, y0 - k * (r + 0.5) + 5], `r = ${r}`, "name", "end");
    html += label([x0 + (k * H) / 2, 18], say("the window: rows from below", "la finestra: righe dal basso"), "small", "middle");
    return html + (s.columns === "<=" ? label([584, y0 + 42], say("column hres lies outside the window", "la colonna hres è fuori dalla finestra"), "name", "end") : "");
  },
  numbers(s, w) {
    const { r, c, d, color } = stepOf(s, Math.min(s.pixel, columnsOf(s) * V - 1)), third = s.third === "zw" ? "zw" : "−d";
    return [`**o** = (0${w.separator}0${w.separator}${E})`, `d_x = s (c − h_res / 2 + 0${w.point}5) = ${S} (${c} − ${H} / 2 + 0${w.point}5) = ${w.number(d[0], 1)}`,
            `d_y = s (r − v_res / 2 + 0${w.point}5) = ${S} (${r} − ${V} / 2 + 0${w.point}5) = ${w.number(d[1], 1)}`, `d_z = ${third} = ${w.number(d[2])}`,
            `**d** / ‖**d**‖ = ${w.vector(unit(d), 4)}`, `RGB = ${w.vector(color)}`];
  },
  below: true,
  extra() {
    const element = make("pre", { class: "code", tabIndex: 0 });
    element.setAttribute("aria-label", "World::render_perspective");
    return { element, show(state) {
      element.replaceChildren(...codeOf(state).map((text, i) => {
        const row = make("span", { textContent: `${text}\n` });
        if (i === 9 || i === 13) row.className = "current";
        if ((i === 8 && state.columns === "<=") || (i === 9 && state.third === "zw")) row.classList.add("wrong");
        return row;
      }));
    } };
  },
};

// ---- the errors of the slides: the same loop, as it is printed there ----
const errors = { ...loop, state: { ...loop.state, columns: "<=", third: "zw", pixel: 90 } };

// ---- the view plane: h_res, v_res, s, samples, exposure_time ----
const viewPlane = {
  size: [560, 420],
  state: { h_res: 40, v_res: 30, s: 10, n: 1, exposure_time: 1, zoom: 1 },
  draw(s, say) {
    const k = Math.min(520 / (s.h_res * s.s), 370 / (s.v_res * s.s), 1.2), width = k * s.h_res * s.s, height = k * s.v_res * s.s, frame = [280 - width / 2, 205 - height / 2, width, height];
    const pixels = renderScene({ ...PINHOLE, zoom: s.zoom, exposure: s.exposure_time }, { h_res: s.h_res, v_res: s.v_res, s: s.s, n: s.n });
    let html = image(frame, imageAddress(pixels, s.h_res, s.v_res)) + rectangle(...frame, "window");
    html += label([280, 412], `${say("window", "finestra")} ${Math.round(s.h_res * s.s)} × ${Math.round(s.v_res * s.s)}`, "name", "middle");
    return html;
  },
  numbers: (s, w) => [`h_res s = ${s.h_res} · ${w.number(s.s)} = ${w.number(s.h_res * s.s)}`, `v_res s = ${s.v_res} · ${w.number(s.s)} = ${w.number(s.v_res * s.s)}`,
    `num_samples = n² = ${s.n * s.n}`, `h_res v_res num_samples = ${s.h_res} · ${s.v_res} · ${s.n * s.n} = ${s.h_res * s.v_res * s.n * s.n}`,
    `s / zoom = ${w.number(s.s)} / ${w.number(s.zoom)} = ${w.number(s.s / s.zoom)}`],
};

// ---- the samples of one pixel, which an edge crosses ----
function random(seed) { // the generator of Park and Miller
  let state = seed;
  return () => (state = (16807 * state) % 2147483647) / 2147483647;
}

export function samplePoints({ sampler, n }) {
  const next = random(4711), points = [];
  for (let j = 0; j < n * n; j++) {
    const x = j % n, y = Math.floor(j / n);
    if (sampler === "regular") points.push([(x + 0.5) / n, (y + 0.5) / n]);
    else if (sampler === "random") points.push([next(), next()]);
    else points.push([(x + next()) / n, (y + next()) / n]);
  }
  return points;
}

// The part of the unit square below the line y = height + slope (x − 1/2): exact, by cutting the square.
export function coverage({ height, slope }) {
  const square = [[0, 0], [1, 0], [1, 1], [0, 1]], side = ([x, y]) => y - height - slope * (x - 0.5), kept = [];
  square.forEach((p, i) => {
    const q = square[(i + 1) % 4], a = side(p), b = side(q);
    if (a <= 0) kept.push(p);
    if (a < 0 !== b < 0 && a !== b) kept.push(add([...p, 0], scale([q[0] - p[0], q[1] - p[1], 0], a / (a - b))));
  });
  let area = 0;
  kept.forEach((p, i) => { const q = kept[(i + 1) % kept.length]; area += (p[0] * q[1] - q[0] * p[1]) / 2; });
  return { area: Math.abs(area), kept };
}

const samples = {
  size: [560, 420],
  state: { sampler: "regular", n: 3, height: 0.45, slope: 0.6 },
  choices: { sampler: ["regular", "random", "jittered"] },
  inside: (s, [x, y]) => y <= s.height + s.slope * (x - 0.5),
  draw(s, say) {
    const at = ([x, y]) => [30 + 340 * x, 380 - 340 * y], { kept } = coverage(s), points = samplePoints(s);
    let html = rectangle(30, 40, 340, 340, "window") + (kept.length > 2 ? polygon(kept.map(at), "object") : "");
    for (let i = 1; i < s.n && s.sampler !== "random"; i++) html += line(at([i / s.n, 0]), at([i / s.n, 1]), "grid") + line(at([0, i / s.n]), at([1, i / s.n]), "grid");
    html += points.map((p) => circle(at(p), this.inside(s, p) ? 6 : 5, this.inside(s, p) ? "sample in" : "sample")).join("");
    const L = points.filter((p) => this.inside(s, p)).length / points.length, grey = (value) => Math.round(255 * value ** (1 / 2.2));
    for (const [y, value, text] of [[80, L, say("the pixel's colour", "colore del pixel")], [230, coverage(s).area, say("exact", "esatto")]])
      html += `<rect x="410" y="${y}" width="110" height="110" fill="rgb(${grey(value)},${grey(value)},${grey(value)})" class="own framed"/>` + label([465, y - 8], text, "", "middle");
    return html + label([200, 26], say("one pixel; filled: the ray hits the object", "un pixel; punti pieni: il raggio colpisce l'oggetto"), "small", "middle");
  },
  numbers(s, w) {
    const points = samplePoints(s), k = points.filter((p) => this.inside(s, p)).length, { area } = coverage(s);
    return [`num_samples = n² = ${points.length}`, `L = ${k} / ${points.length} = ${w.number(k / points.length)}`, `A = ${w.number(area)}`, `L − A = ${w.number(k / points.length - area)}`];
  },
};

// ---- World::build ----
const BUILD = `void World::build(void) {
    Pinhole* pinhole_ptr = new Pinhole();

    pinhole_ptr->set_eye(300, 400, 500);
    pinhole_ptr->set_lookat(0, 0, -50);
    pinhole_ptr->set_viewdistance(400);
    pinhole_ptr->compute_uvw();

    set_camera(pinhole_ptr);
};
`;
const METHODS = { set_eye: 3, set_lookat: 3, set_up: 3, set_viewdistance: 1, set_zoom: 1, set_roll: 1, set_exposure_time: 1, compute_uvw: 0, set_camera: 0, add_sphere: 7 };

// Runs the lines of World::build. Returns { camera, world, error: [line, text] or null }.
export function runBuild(code, say) {
  const p = { eye: [0, 0, 500], lookat: [0, 0, 0], up: [0, 1, 0], d: 500, zoom: 1, roll: 0, exposure: 1 }, world = [...WORLD];
  let frame = null, camera = null;
  const lines = code.split("\n");
  for (let i = 0; i < lines.length; i++) {
    const text = lines[i].replace(/\/\/.*/, "").trim(), fail = (words) => ({ camera: null, world, error: [i + 1, words] });
    if (!text || /^(void World::build\(void\) \{|\};?|\.\.\.|Pinhole\*? ?\*?\w+ = new Pinhole(\(\))?;)$/.test(text)) continue;
    const call = text.match(/^(?:\w+->)?(\w+)\((.*)\);$/);
    if (!call || !(call[1] in METHODS)) return fail(call ? say(`no method ${call[1]}`, `nessun metodo ${call[1]}`) : say("not a call of a method; is the semicolon missing?", "non è la chiamata di un metodo; manca il punto e virgola?"));
    const numbers = call[2].split(",").map((word) => Number(word.trim() || NaN)), count = METHODS[call[1]];
    if (count && (numbers.length !== count || numbers.some(Number.isNaN))) return fail(say(`${call[1]} takes ${count === 1 ? "one number" : `${count} numbers`}`, `${call[1]} richiede ${count === 1 ? "un numero" : `${count} numeri`}`));
    const one = { set_viewdistance: "d", set_zoom: "zoom", set_roll: "roll", set_exposure_time: "exposure" }[call[1]], three = { set_eye: "eye", set_lookat: "lookat", set_up: "up" }[call[1]];
    if (three) p[three] = numbers;
    if (one && one !== "roll" && !(numbers[0] > 0)) return fail(say("the number must be greater than 0", "il numero deve essere maggiore di 0"));
    if (one) p[one] = numbers[0];
    if (call[1] === "add_sphere") {
      if (!(numbers[3] > 0)) return fail(say("the radius must be greater than 0", "il raggio deve essere maggiore di 0"));
      world.push({ centre: numbers.slice(0, 3), radius: numbers[3], color: numbers.slice(4) });
    }
    if (call[1] === "compute_uvw" && !frameOf(p.eye, p.lookat, p.up)) return fail(say("eye - lookat is 0 or parallel to up: no u, v", "eye − lookat è nullo o parallelo a up: u, v non sono definiti"));
    if (call[1] === "compute_uvw") frame = { eye: p.eye, lookat: p.lookat, up: p.up, roll: p.roll };
    if (call[1] === "set_camera") camera = p;
  }
  if (!camera) return { camera: null, world, error: [lines.length, say("set_camera is missing", "manca set_camera")] };
  if (!frame) return { camera: null, world, error: [lines.length, say("compute_uvw is missing: there is no u, v, w", "manca compute_uvw: u, v, w non sono definiti")] };
  return { camera: { ...camera, lookat: add(camera.eye, scale(add(frame.lookat, scale(frame.eye, -1)), 1)), up: frame.up, roll: frame.roll }, world, error: null };
}

const build = {
  size: [520, 400],
  state: { code: BUILD },
  draw(s, say) {
    const { camera, world, error } = runBuild(s.code, say), frame = [20, 10, 480, 360];
    if (error) return rectangle(...frame, "window") + label([260, 180], `${say("line", "riga")} ${error[0]}`, "name", "middle") + label([260, 206], error[1], "name", "middle");
    return image(frame, imageAddress(renderScene(camera, { h_res: 120, v_res: 90, s: 400 / 120, n: 2 }, world), 120, 90)) + rectangle(...frame, "window");
  },
  numbers(s, w, say) {
    const { camera } = runBuild(s.code, say);
    return camera ? [`e = ${w.vector(camera.eye)}`, `d = ${w.number(camera.d)}`] : [];
  },
  extra(figure) {
    const area = make("textarea", { class: "code", rows: 12, spellcheck: false, value: BUILD });
    area.setAttribute("aria-label", "World::build");
    area.addEventListener("input", () => {
      clearTimeout(figure.typing);
      figure.typing = setTimeout(() => figure.set({ ...figure.state, code: area.value }), 200);
    });
    return { element: area, show(state) { if (document.activeElement !== area) area.value = state.code; } };
  },
};

export const loopDrawings = { loop, errors, view_plane: viewPlane, samples, build };
