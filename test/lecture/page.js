// test/lecture/page.js DOCS: tests of web/lecture/*.js, run by test_page.sh in a folder with copies of them. Reads the
// output of `velo camera unproject` for the rays of the formulas from rays.csv, if there: r,c,ox,oy,oz,dx,dy,dz,valid.
import assert from "node:assert/strict";
import fs from "node:fs";
import { basis, formula, formulaNames, primaryRay, vanishingPoint } from "./formulas.js";
import { markdownToHtml, parseMark } from "./markdown.js";
import { parseSliders, positionOf, sliderValue, valueAt, withSlider } from "./sliders.js";

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
test("subscripts", () => assert.equal(html("> x_v = h_res `x_v` to_be"), "<blockquote><p>x<sub>v</sub> = h<sub>res</sub> <code>x_v</code> to_be</p></blockquote>"));
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
test("formula_mark", () => assert.equal(html("<!-- formula: fov -->\n> a"), `<blockquote class="formula" data-formula="fov"><p>a</p></blockquote>`));
test("unknown_marks_are_errors", () => {
  assert.throws(() => html("<!-- note: a -->\n"));
  assert.throws(() => parseMark("scene=a inside=1"));
  assert.throws(() => html("<!-- live: scene=s/c.pbrt -->\n| x |\n| --- |\n| ![1](i/a.jpg) |"));
});

for (const [name, text] of Object.entries(pages)) {
  const page = markdownToHtml(text);
  const plain = page.replace(/<pre.*?<\/pre>|<code>.*?<\/code>/gs, "");
  test(`${name}_leaves_no_markdown`, () => {
    for (const sign of ["**", "](", "![", "`", "<!--", "| ", "\u0000", "&lt;"]) assert.ok(!plain.includes(sign), `'${sign}' is left`);
    assert.equal(count(plain, /^#/gm), 0);
  });
  test(`${name}_is_well_formed`, () => {
    const open = [];
    for (const [, slash, tag] of page.matchAll(/<(\/?)([a-z0-9]+)[^>]*>/g)) {
      if (tag === "img") continue;
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
    const ids = [...page.matchAll(/ id="([^"]*)"/g)].map((m) => m[1]);
    const targets = [...page.matchAll(/href="#([^"]*)"/g)].map((m) => m[1]);
    assert.ok(targets.length >= 10);
    for (const target of targets) assert.ok(ids.includes(target), target);
  });
  test(`${name}_names_known_formulas_and_sliders`, () => {
    const names = [...page.matchAll(/data-formulas?="([^"]*)"/g)].flatMap((m) => m[1].split(","));
    assert.ok(names.length > 20);
    for (const formulaName of names) assert.ok(formulaNames.includes(formulaName), formulaName);
    for (const [, sliders] of page.matchAll(/data-sliders="([^"]*)"/g)) assert.ok(parseSliders(sliders).length > 0);
  });
}
test("both_pages_have_the_same_parts", () => {
  const parts = (text) => [...markdownToHtml(text).matchAll(/<(h\d|p|figure[^>]*|table|blockquote[^>]*|pre[^>]*|ul|ol|button[^>]*)>/g)].map((m) => m[1].replace(/ id=.*/, ""));
  assert.deepEqual(parts(pages.lezione), parts(pages.lecture));
});

test("slider_positions", () => {
  const [d, e, choice] = parseSliders("d:100..2000,e:-5..5.5,projection");
  assert.ok(d.logarithmic && !e.logarithmic && choice.min === undefined);
  for (const slider of [d, e]) {
    assert.equal(valueAt(slider, 0), slider.min);
    near([valueAt(slider, 1)], [slider.max], 1e-9);
    for (const x of [0, 0.25, 1]) near([positionOf(slider, valueAt(slider, x))], [x], 1e-12);
  }
  assert.equal(positionOf(d, 5000), 1);
  for (const wrong of ["d:1", "d:1..x", "d 1..2", "d:1..2:3"]) assert.throws(() => parseSliders(wrong), wrong);
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
  assert.equal(formula("ellipse", { eye: [0, 0, 2] }, "it"), "θ = 52,4°, 1 / cos θ = 1,64");
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
