// test/lecture/page.js DOCS: tests of web/lecture/*.js, run by test_page.sh in a folder with copies of them. Reads the
// output of `velo camera unproject` for the rays of the formulas from rays.csv, if there: r,c,ox,oy,oz,dx,dy,dz,valid.
import assert from "node:assert/strict";
import fs from "node:fs";
import { drawings } from "./web/lecture/drawings.js";
import { coverage, runBuild, samplePoints } from "./web/lecture/drawings/loop.js";
import { sphereImage } from "./web/lecture/drawings/plane.js";
import { vanishes } from "./web/lecture/drawings/vanish.js";
import { addressOf, parseHash, readValues } from "./web/lecture/links.js";
import { mathHtml } from "./web/lecture/math.js";
import { frameOf, onPlane } from "./web/lecture/svg.js";
import { PINHOLE, display, getDirection, renderScene, traceRay } from "./web/lecture/trace.js";
import { sayIn } from "./web/lecture/words.js";
import { basis, formula, formulaNames, primaryRay, vanishingPoint, writer } from "./web/lecture/formulas.js";
import { markdownToHtml, parseDrawn, parseMark } from "./web/lecture/markdown.js";
import { parseSliders, positionOf, sliderValue, valueAt, withSlider } from "./web/lecture/sliders.js";

let failed = 0;

function test(name, run) {
  try {
    run();
    console.log(`ok ${name}`);
  } catch (error) {
    console.log(`not ok ${name}\n  ${String(error.message).replace(/\n/g, "\n  ")}`);
    failed++;
  }
}

const html = (text, options) => markdownToHtml(text, options).trimEnd();
const docs = process.argv[2];
const pages = Object.fromEntries(["lecture", "lezione"].map((name) => [name, fs.readFileSync(`${docs}/${name}.md`, "utf8")]));
const count = (text, regex) => [...text.matchAll(regex)].length;
const near = (a, b, limit) => a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) <= limit, `${a} is not ${b}`));

test("headings", () => assert.equal(html("## 4. È d'*arte*: `a_b`"), `<h2 id="4-è-darte-a_b">4. È d'<em>arte</em>: <code>a_b</code></h2>`));
test("paragraphs", () => assert.equal(html("a\nb\n\nc"), "<p>a b</p>\n<p>c</p>"));
test("emphasis", () => assert.equal(html("*a* **b** *c d* **e**."), "<p><em>a</em> <strong>b</strong> <em>c d</em> <strong>e</strong>.</p>"));
test("code_holds_no_markdown", () => assert.equal(html("`*a* [b](c) <d>`"), "<p><code>*a* [b](c) &lt;d&gt;</code></p>"));
test("links", () => assert.equal(html("[`a`](b.md#c) [d](e)", { link: (t) => "/x/" + t }),
  `<p><a href="/x/b.md#c"><code>a</code></a> <a href="/x/e">d</a></p>`));
test("images", () => assert.equal(html("![a *b*](c.jpg)", { image: (s) => "/y/" + s }), `<p><img src="/y/c.jpg" alt="a *b*"></p>`));
test("subscripts", () => assert.equal(html("x_v = h_res `x_v` to_be"), "<p>x<sub>v</sub> = h<sub>res</sub> <code>x_v</code> to_be</p>"));
test("folds", () => assert.equal(html("<details><summary>a *b*</summary>\n\nc\n\n</details>"), "<details><summary>a <em>b</em></summary>\n<p>c</p>\n</details>"));
test("drawn_figure", () => {
  assert.equal(html("<!-- drawn: size sliders=d:1..2 -->\n![b](i/a.svg)"),
    `<figure class="drawn" data-drawn="size" data-sliders="d:1..2"><img src="i/a.svg" alt="b"><figcaption>b</figcaption></figure>`);
  assert.throws(() => parseDrawn("size views=a"));
  assert.throws(() => parseDrawn("sliders=d:1..2"));
});
const math = (text) => mathHtml(text).replace(/ displaystyle="true"| class="[^"]*"/g, "").replace(/<\/?(mrow|span|math)>/g, "");
test("mathml", () => {
  assert.equal(math("a / b"), "<mfrac><mi>a</mi><mi>b</mi></mfrac>");
  assert.equal(math("1 · 400 / 0,5"), "<mfrac><mn>1</mn><mo>·</mo><mn>400</mn><mn>0,5</mn></mfrac>");
  assert.equal(math("(a + b) / c / d"), "<mfrac><mfrac><mi>a</mi><mo>+</mo><mi>b</mi><mi>c</mi></mfrac><mi>d</mi></mfrac>");
  assert.equal(math("√(cos² θ)"), `<msqrt><msup><mi>cos</mi><mn>2</mn></msup><mspace width="0.17em"/><mi>θ</mi></msqrt>`);
  assert.equal(math("x_v = −3"), "<msub><mi>x</mi><mi>v</mi></msub> <mo>=</mo><mo>−</mo><mn>3</mn>");
  assert.equal(math('"a <b>": 2'), "<mtext>a &lt;b&gt;</mtext><mo>:</mo> <mn>2</mn>");
  assert.ok(mathHtml("**u** = v").includes(`<mi class="vector axis-u">u</mi>`) && !mathHtml("v_res").includes("axis-v"));
  assert.equal(count(mathHtml("a = (1, 2) / 3"), /<mo>\(/g), 1); // a vector keeps its parentheses in a fraction
  for (const text of ["((", "a /", "‖", "√", "= = (", ") + /"]) mathHtml(text); // ends, whatever it is given
});
test("lists", () => assert.equal(html("- a\n  b\n- c\n\n1. d\n   e\n2. f"), "<ul><li>a b</li><li>c</li></ul>\n<ol><li>d e</li><li>f</li></ol>"));
test("tables", () => assert.equal(html("| a | b |\n| --- | --- |\n| *c* |  |"),
  "<table><thead><tr><th>a</th><th>b</th></tr></thead><tbody><tr><td><em>c</em></td><td></td></tr></tbody></table>"));
test("code", () => assert.equal(html("    A \"b\"\n      c < d"), "<pre><code>A &quot;b&quot;\n  c &lt; d</code></pre>"));
test("commands", () => assert.equal(html("    velo render a\n    velo render b"), `<pre class="command"><code>velo render a\nvelo render b</code></pre>`));
test("html_is_text", () => {
  const text = html(`a <script>b</script> [c](d"><i>) ![e"](f"x)`);
  assert.ok(!/<(script|i)\b/.test(text) && !/="[^"]*"[a-z]/.test(text), text);
});
test("live_image", () => assert.equal(html("<!-- live: scene=s/a.pbrt sliders=d:1..2 outside=1 -->\n![b](i/a.jpg)"),
  `<figure class="live" data-scene="s/a.pbrt" data-sliders="d:1..2" data-outside="1"><img src="i/a.jpg" alt="b"><figcaption>b</figcaption></figure>`));
test("live_table", () => {
  const text = html("<!-- live: scene=s/b.pbrt views=a,b -->\n| x | y |\n| --- | --- |\n| ![1](i/a.jpg) | ![2](i/b.jpg) |\n\n![3](i/c.jpg)");
  assert.equal(count(text, /<figure/g), 1);
  assert.ok(text.startsWith(`<figure class="live" data-scene="s/b.pbrt" data-views="a,b"><img src="i/b.jpg" alt="2"></figure>`), text);
  assert.deepEqual([...text.matchAll(/data-view="(\w+)"/g)].map((m) => m[1]), ["a", "b"]);
});
test("formula_mark", () => assert.equal(html("<!-- formula: fov -->\n> a"),
  `<blockquote class="formula" data-formula="fov"><p><span class="group"><math displaystyle="true"><mi>a</mi></math></span></p></blockquote>`));
test("unknown_marks_are_errors", () => {
  assert.throws(() => html("<!-- note: a -->\n"));
  assert.throws(() => parseMark("scene=a inside=1"));
  assert.throws(() => html("<!-- live: scene=s/c.pbrt -->\n| x |\n| --- |\n| ![1](i/a.jpg) |"));
});

for (const [name, text] of Object.entries(pages)) {
  const page = markdownToHtml(text);
  const plain = page.replace(/<pre.*?<\/pre>|<code>.*?<\/code>/gs, "");
  test(`${name}_leaves_no_markdown`, () => {
    for (const sign of ["**", "](", "![", "`", "<!--", "| ", "\u0000", "&lt;details"]) assert.ok(!plain.includes(sign), `'${sign}' is left`);
    assert.equal(count(plain, /^#/gm), 0);
  });
  test(`${name}_is_well_formed`, () => {
    const open = [];
    for (const [, slash, tag] of page.matchAll(/<(\/?)([a-z0-9]+)[^>]*>/g)) {
      if (tag === "img" || tag === "mspace") continue;
      if (slash) assert.equal(open.pop(), tag);
      else open.push(tag);
    }
    assert.deepEqual(open, []);
  });
  test(`${name}_has_all_parts`, () => {
    const marks = [...text.matchAll(/^<!-- live: (.*) -->\n(.)/gm)];
    assert.equal(count(page, /<figure class="live"/g), marks.length);
    assert.equal(count(page, /<img /g), count(text, /!\[/g) + marks.filter((m) => m[2] === "|").length);
    assert.equal(count(page, /<blockquote class="formula"/g), count(text, /<!-- formula:/g));
    assert.equal(count(page, /<h\d /g), count(text, /^#+ /gm));
    const views = marks.flatMap((m) => (parseMark(m[1]).views ?? "").split(",")).filter(Boolean);
    assert.deepEqual([...page.matchAll(/data-view="(\w+)"/g)].map((m) => m[1]), views);
    const commands = [...text.matchAll(/^ {4}((?:script|velo|build).*)$/gm)].map((m) => m[1].replace(">", "&gt;"));
    assert.deepEqual([...page.matchAll(/<pre class="command"><code>(.*?)<\/code>/gs)].flatMap((m) => m[1].split("\n")), commands);
  });
  test(`${name}_anchors_lead_to_headings`, () => {
    const figures = [...page.matchAll(/data-(?:drawn="|scene="[^"]*\/)(\w+)/g)].map((m) => m[1]);
    assert.equal(new Set(figures).size, figures.length);
    const ids = [...page.matchAll(/ id="([^"]*)"/g)].map((m) => m[1]).concat(figures);
    const targets = [...page.matchAll(/href="#([^"?]*)/g)].map((m) => m[1]);
    assert.ok(targets.length >= 30);
    for (const target of targets) assert.ok(ids.includes(target), target);
  });
  test(`${name}_names_known_formulas_and_sliders`, () => {
    const names = [...page.matchAll(/data-formulas?="([^"]*)"/g)].flatMap((m) => m[1].split(","));
    assert.ok(names.length > 20);
    for (const formulaName of names) assert.ok(formulaNames.includes(formulaName), formulaName);
    for (const [, sliders] of page.matchAll(/data-sliders="([^"]+)"/g)) assert.ok(parseSliders(sliders).length > 0);
  });
  test(`${name}_draws_known_figures`, () => {
    const marks = [...text.matchAll(/^<!-- drawn: (.*) -->/gm)].map((m) => parseDrawn(m[1]));
    assert.deepEqual(marks.map((m) => m.name).sort(), Object.keys(drawings).sort());
    for (const mark of marks)
      for (const { name: slider, min, max } of parseSliders(mark.sliders)) {
        const value = drawings[mark.name].state[slider];
        assert.ok(value >= min && value <= max, `${mark.name}: ${slider} = ${value}`);
      }
  });
  test(`${name}_has_a_figure_first_in_every_section`, () => {
    for (const section of text.split(/^#+ .*$/m).slice(1)) assert.match(section.trimStart(), /^<!-- (live|drawn): /);
  });
  test(`${name}_has_exercises_with_answers`, () => {
    const numbers = [...text.matchAll(/^\*\*(?:Exercise|Esercizio) (\d+)\.\*\*/gm)].map((m) => Number(m[1]));
    assert.deepEqual(numbers, numbers.map((_, i) => i + 1));
    assert.ok(numbers.length >= 20);
    assert.equal(count(text, /<summary>(Answer|Soluzione)<\/summary>/g), numbers.length);
    assert.equal(count(text, /\[(?:Check|Verifica)\]\(#/g), numbers.length);
  });
}
test("both_pages_have_the_same_parts", () => {
  const parts = (text) => [...markdownToHtml(text).matchAll(/<(h\d|p|figure[^>]*|table|blockquote[^>]*|pre[^>]*|ul|ol|button[^>]*)>/g)].map((m) => m[1].replace(/ id=.*/, ""));
  assert.deepEqual(parts(pages.lezione), parts(pages.lecture));
});

test("slider_positions", () => {
  const [d, e, choice] = parseSliders("d:100..2000,e:-5..5.5,r:0..11");
  assert.ok(d.logarithmic && !e.logarithmic && choice.step === 1 && d.step === 0);
  for (const slider of [d, e]) {
    assert.equal(valueAt(slider, 0), slider.min);
    near([valueAt(slider, 1)], [slider.max], 1e-9);
    for (const x of [0, 0.25, 1]) near([positionOf(slider, valueAt(slider, x))], [x], 1e-12);
  }
  assert.equal(positionOf(d, 5000), 1);
  for (const wrong of ["d:1", "d:1..x", "d 1..2", "d:1..2:3", "d"]) assert.throws(() => parseSliders(wrong), wrong);
});
test("sliders_change_the_camera", () => {
  const camera = { eye: [1, 2, 30], lookat: [1, 2, 10], d: 5 };
  assert.deepEqual(withSlider(camera, "e", 50), { eye: [1, 2, 50], lookat: [1, 2, 30], d: 5 });
  assert.deepEqual(withSlider(camera, "eye_x", 7), { eye: [7, 2, 30], lookat: [1, 2, 10], d: 5 });
  assert.deepEqual(withSlider(camera, "d", 9), { eye: [1, 2, 30], lookat: [1, 2, 10], d: 9 });
  assert.deepEqual(["e", "lookat_y", "d"].map((name) => sliderValue(camera, name)), [30, 2, 5]);
  assert.deepEqual(camera, { eye: [1, 2, 30], lookat: [1, 2, 10], d: 5 });
});

const pinhole = { eye: [300, 400, 500], lookat: [0, 0, -50], up: [0, 1, 0], d: 400, zoom: 1, s: 0.625, roll: 0, width: 640, height: 480, px: 0.5, py: 0.5 };
test("formulas_hold_the_numbers", () => {
  assert.equal(formula("f", pinhole), "f = zoom · d / s = 1 · 400 / 0.625 = 640");
  assert.equal(formula("fov", pinhole), "tan(fov / 2) = (480 · 0.625 / 2) / 400 = 0.375, fov = 41.11°");
  assert.equal(formula("fov", pinhole, "it"), "tan(fov / 2) = (480 · 0,625 / 2) / 400 = 0,375, fov = 41,11°");
  assert.equal(formula("fov", { ...pinhole, zoom: 2 }), "tan(fov / 2) = (480 · 0.3125 / 2) / 400 = 0.1875, fov = 21.24°");
  assert.equal(formula("origin", pinhole), "o = (0, 0, 500)");
  assert.equal(formula("point", { ...pinhole, r: 0, c: 0 }),
    "x_v = 0.625 (0 − 640/2 + 0.5) = −199.6875   y_v = 0.625 (0 − 480/2 + 0.5) = −149.6875");
  assert.equal(formula("size", { eye: [0, 0, 500], d: 500 }), "f / z: 500 / 250 = 2   500 / 500 = 1   500 / 1000 = 0.5   500 / 2000 = 0.25");
  assert.equal(formula("dolly", { eye: [0, 0, 10], d: 1687 }), "d / (e − 1) = 1687 / 9 = 187.4, 2 d / (e − 1) = 375");
  assert.equal(formula("ellipse", { eye: [0, 0, 2] }, "it"), "θ = 52,4°, α = 10,5°, cos α / √(cos² θ − sin² α) = 1,69");
  assert.equal(formula("ellipse", { eye: [0, 0, 15] }), "θ = 9.8°, α = 2.3°, cos α / √(cos² θ − sin² α) = 1.01");
  for (const name of formulaNames) for (const language of ["en", "it"]) {
    const text = formula(name, {}, language);
    assert.ok(text.length > 5 && !/NaN|undefined|Infinity/.test(text), `${name}: ${text}`);
  }
});
test("vanishing_points_are_the_pages", () => {
  const two = { ...pinhole, eye: [430, 130, 430], lookat: [0, 130, 0], d: 420, s: 1, width: 480, height: 360 };
  assert.equal(formula("principal", two), "x: (−180, 180)   y: ∞   z: (660, 180)");
  near(vanishingPoint({ ...pinhole, eye: [0, 0, 500], lookat: [0, 0, 0], d: 500, s: 1 }, [-1, 0.75, -5]), [-100, 75], 1e-9);
});
test("roll_turns_the_camera_clockwise", () => {
  const { u, v, w } = basis({ eye: [0, 0, 1], lookat: [0, 0, 0], up: [0, 1, 0], roll: 90 });
  near([...u, ...v, ...w], [0, -1, 0, 1, 0, 0, 0, 0, 1], 1e-15);
});

// ---- drawn figures: what they say, computed here in another way ----
const numbersOf = (name, change, language = "en") => {
  const d = drawings[name];
  return d.numbers({ ...d.state, ...change }, writer(language), sayIn(language));
};
const last = (line) => Number(line.split("=").at(-1).replace(/[°)]/g, "").replace("−", "-").replace(",", "."));

test("drawings_draw_every_state", () => { // at both ends of each slider, with each choice, in both languages
  for (const [, mark] of pages.lecture.matchAll(/^<!-- drawn: (.*) -->/gm)) {
    const { name, sliders } = parseDrawn(mark), drawing = drawings[name], states = [drawing.state];
    for (const { name: slider, min, max } of parseSliders(sliders)) states.push({ ...drawing.state, [slider]: min }, { ...drawing.state, [slider]: max });
    for (const [key, values] of Object.entries(drawing.choices ?? {}))
      for (const value of values) states.push(drawing.choose?.(drawing.state, key, value) ?? { ...drawing.state, [key]: value });
    for (const state of states)
      for (const language of ["en", "it"]) {
        const svg = drawing.draw(state, sayIn(language)), text = (drawing.numbers?.(state, writer(language), sayIn(language)) ?? []).join("\n");
        assert.ok(svg.length > 200 && !/NaN|undefined|Infinity/.test(svg + text), `${name}: ${JSON.stringify(state)} ${text}`);
        assert.ok(!/ style=/.test(svg), name); // the server's content security policy
        assert.ok(language === "en" || !/\d\.\d/.test(text), `${name}: ${text}`); // decimal commas
      }
  }
});
test("sphere_images_are_those_of_rays", () => { // edge rays of the sphere, and an ellipse through four of them
  for (const [theta, alpha] of [[0, 10], [40, 10], [60, 5], [52.431, 10.5]]) {
    const t = (theta * Math.PI) / 180, a = (alpha * Math.PI) / 180, { long, wide, middle } = sphereImage({ theta, alpha });
    near([2 * long], [Math.tan(t + a) - Math.tan(t - a)], 1e-12);
    near([middle], [(Math.tan(t + a) + Math.tan(t - a)) / 2], 1e-12);
    // a point of the outline over the middle of the ellipse: its ray touches the sphere
    const ray = [middle, wide, 1], axis = [Math.sin(t), 0, Math.cos(t)], cosine = (ray[0] * axis[0] + ray[2] * axis[2]) / Math.hypot(...ray);
    near([Math.acos(cosine)], [a], 1e-9);
  }
});
test("coverage_is_the_area", () => {
  for (const [height, slope] of [[0.45, 0.6], [0.9, 2], [-0.2, 0.3], [1.2, 0], [0.5, -2]]) {
    let inside = 0;
    for (let i = 0; i < 400; i++) for (let j = 0; j < 400; j++) inside += (j + 0.5) / 400 <= height + slope * ((i + 0.5) / 400 - 0.5);
    near([coverage({ height, slope }).area], [inside / 160000], 3e-3);
  }
});
test("samples_lie_in_their_cells", () => {
  for (const sampler of ["regular", "random", "jittered"]) {
    const points = samplePoints({ sampler, n: 4 });
    assert.equal(points.length, 16);
    for (const p of points) assert.ok(p.every((x) => x >= 0 && x < 1));
    if (sampler !== "random") assert.equal(new Set(points.map((p) => p.map((x) => Math.floor(4 * x)).join())).size, 16);
  }
});
test("answers_of_the_exercises", () => { // as both pages give them
  near(numbersOf("projection", {}).slice(1).map(last), [25, 29.1667], 1e-4);
  near(numbersOf("projection", { z: 150 }).slice(1).map(last), [60, 70], 1e-9);
  assert.deepEqual(numbersOf("windows", { shift_x: 60 }).slice(0, 1).concat(numbersOf("windows", { shift_x: 60 }).at(-1)), ["(x_0, y_0) = (−60, 0)", "α = 21.8°"]);
  assert.ok(numbersOf("frustum", { near: 200, far: 300 }).at(-1).endsWith(": 1"));
  near([last(numbersOf("field_of_view", { d: 200 }).at(-1)), last(numbersOf("field_of_view", {}).at(-1))], [73.74, 41.11], 1e-9);
  near([last(numbersOf("turning", { angle: 60 }).at(-1)), last(numbersOf("turning", { angle: 60.2 }).at(-1))], [50.4, 50], 0.1);
  near(numbersOf("direction", {}).map(last), [-60, 45], 1e-9);
  near(numbersOf("direction", { v_z: -10 }).map(last), [-30, 22.5], 1e-9);
  assert.deepEqual(numbersOf("vanishing", { azimuth: 45, elevation: 0 }), ["x: (−190, 0)", "y: ∞", "z: (190, 0)"]);
  near([last(numbersOf("size", { d: 600 })[0])], [1.5], 1e-9);
  near([last(numbersOf("retina", { theta: 60 })[0])], [2.1], 5e-3);
  near(numbersOf("film", { hole: 10 }).map(last), [-45, 45, 15], 1e-9);
  assert.deepEqual(numbersOf("uvw", { eye_x: 0, eye_y: 300, eye_z: 0, up_angle: 30 }).slice(1), ["up × **w** = (0, 0, 0.5), ‖up × **w**‖ = 0.5", "**u** = (0, 0, 1)", "**v** = (1, 0, 0)"]);
  assert.equal(numbersOf("uvw", { eye_x: 0, eye_y: 300, eye_z: 0 }).length, 2);
  near(numbersOf("pixel", { r: 0, c: 0, p_x: 0, p_y: 0 }).slice(0, 2).map(last), [-200, -150], 1e-9);
  assert.ok(numbersOf("pixel", { r: 6, c: 8, p_x: 0, p_y: 0 })[2].startsWith("**d** = 0 **u** + 0 **v** − 400 **w**"));
  assert.equal(drawings.errors.press({ ...drawings.errors.state, pixel: 300 }, "step").pixel, 203); // 17 · 12
});
test("vanishing_points_are_the_limit_of_lines", () => {
  const eye = [300, 200, 400], frame = frameOf(eye, [0, 50, 0], [0, 1, 0], 20);
  for (const direction of [[1, 0, 0], [0, 1, 0], [-0.2, 0.1, -1]]) {
    const far = onPlane(eye.map((x, i) => x - 50 * (i === 2) + 1e7 * direction[i] * Math.sign(-direction.reduce((s, v, k) => s + v * frame.w[k], 0))), eye, frame, 190);
    near(vanishes(frame, 190, direction), far, 1e-2);
  }
});
test("world_build_runs", () => {
  const say = sayIn("en"), code = drawings.build.state.code, { camera, error } = runBuild(code, say);
  assert.equal(error, null);
  assert.deepEqual([camera.eye, camera.lookat, camera.d], [[300, 400, 500], [0, 0, -50], 400]);
  const changed = (from, to) => runBuild(code.replace(from, to), say).error?.join(": ");
  assert.equal(changed("set_viewdistance(400)", "set_viewdistence(400)"), "6: no method set_viewdistence");
  assert.equal(changed("set_eye(300, 400, 500)", "set_eye(300, 400)"), "4: set_eye takes 3 numbers");
  assert.equal(changed("(400)", "()"), "6: set_viewdistance takes one number");
  assert.match(changed(/.*compute_uvw.*\n/, ""), /compute_uvw is missing/);
  assert.match(changed("set_eye(300, 400, 500)", "set_eye(0, 400, -50)"), /^7: .*parallel to up/);
  assert.match(changed(/.*set_camera.*\n/, ""), /set_camera is missing/);
  assert.match(changed("(400);", "(400)"), /^6: .*semicolon/);
  assert.match(changed("(400)", "(0)"), /greater than 0/);
  assert.equal(runBuild(code.replace("    set_camera", "    add_sphere(0, 0, 0, 10, 1, 0, 0);\n    set_camera"), say).world.length, 7);
});
test("links_to_figures", () => {
  assert.deepEqual(parseHash("#a?d=1&e=-2"), { name: "a", values: { d: "1", e: "-2" } });
  assert.equal(parseHash(""), null);
  const figure = { name: "projection", drawing: drawings.projection, state: { kind: "orthographic", e: 200 }, camera: { kind: "orthographic", e: 200 }, views: [],
    rows: parseSliders("e:100..500").map((slider) => ({ slider, row: {} })) };
  assert.equal(addressOf(figure), "#projection?kind=orthographic&e=200");
  assert.deepEqual(readValues(figure, { e: "300", kind: "perspective" }, "en"), { set: { e: 300, kind: "perspective" }, complaints: [] });
  const { set, complaints } = readValues(figure, { e: "9999", kind: "x", q: "1", f: "NaN" }, "en");
  assert.deepEqual(set, { e: 500 });
  assert.equal(complaints.length, 4);
});
if (fs.existsSync("lecture.ppm"))
  test("images_are_those_of_the_slides_program", () => { // examples/lecture.c size=40x30 s=10 n=1
    const bytes = fs.readFileSync("lecture.ppm"), pixels = bytes.subarray(bytes.length - 3600), mine = renderScene(PINHOLE, { h_res: 40, v_res: 30, s: 10, n: 1 });
    for (let r = 0; r < 30; r++) for (let c = 0; c < 40; c++)
      assert.deepEqual(mine[40 * r + c], [...pixels.subarray(3 * (40 * (29 - r) + c), 3 * (40 * (29 - r) + c) + 3)], `row ${r}, column ${c}`);
    const frame = frameOf(PINHOLE.eye, PINHOLE.lookat, PINHOLE.up);
    assert.deepEqual(display(traceRay(PINHOLE.eye, getDirection(frame, 400, [-195, -145]))), mine[0]);
  });
if (fs.existsSync("rays.csv"))
  test("rays_are_velos", () => {
    const lines = fs.readFileSync("rays.csv", "utf8").trim().split("\n");
    assert.ok(lines.length >= 4);
    for (const line of lines) {
      const [r, c, , , , x, y, z, valid] = line.split(",").map(Number);
      assert.equal(valid, 1);
      near(primaryRay({ ...pinhole, r, c, roll: 30, zoom: 2 }), [x, y, z], 1e-12);
    }
  });

process.exit(failed ? 1 : 0);
