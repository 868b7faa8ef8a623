// web/lecture/markdown.js: the Markdown of docs/lecture.md and docs/lezione.md as HTML, and no more Markdown than that:
// headings, paragraphs, lists, tables, indented code, quotes (formulas), emphasis, code, links, images, folds (<details>), and the
// marks of docs/view-lecture.md. A live mark makes a <figure class="live">, a drawn mark a <figure class="drawn">, a formula
// mark a <blockquote class="formula">.
import { mathHtml } from "./math.js";

const LIVE_WORDS = ["scene", "sliders", "views", "formulas", "outside", "overlay"];
const FOLD = /^(?:<details><summary>([^<]*)<\/summary>|<\/details>)$/;
const COMMAND = /^(script|build)\/|^velo /;

export function escapeHtml(text) {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");
}

// The id of a heading, as the Markdown's own links write it.
export function slug(heading) {
  return heading.toLowerCase().replace(/[^\p{L}\p{N}_\- ]/gu, "").replace(/ /g, "-");
}

// "images/lecture/eye_200.jpg" and "scenes/lecture/eye_200.pbrt" have the same name: eye_200.
export function nameOf(path) {
  return path.replace(/^.*\//, "").replace(/\.\w+$/, "");
}

// One line of text: code first, since nothing inside it is Markdown; then images and links; then emphasis.
function inline(text, page) {
  const kept = [];
  const keep = (html) => `\u0000${kept.push(html) - 1}\u0000`;
  let html = text.replace(/`([^`]+)`/g, (_, code) => keep(`<code>${escapeHtml(code)}</code>`));
  html = html.replace(/!\[([^\]]*)\]\(([^)]*)\)/g, (_, alt, source) => keep(image(alt, source, page)));
  html = html.replace(/\[([^\]]*)\]\(([^)]*)\)/g, (_, label, target) =>
    keep(`<a href="${escapeHtml(page.link(target))}">`) + label + keep("</a>"));
  html = escapeHtml(html)
    .replace(/\*\*([^*]+)\*\*/g, "<strong>$1</strong>")
    .replace(/\*([^*]+)\*/g, "<em>$1</em>")
    .replace(/(?<![\p{L}\p{N}_])([\p{L}])_([\p{L}\p{N}]+)(?![\p{L}\p{N}_])/gu, "$1<sub>$2</sub>"); // x_v, h_res
  while (html.includes("\u0000")) html = html.replace(/\u0000(\d+)\u0000/g, (_, i) => kept[i]);
  return html;
}

function image(alt, source, page) {
  const tag = `<img src="${escapeHtml(page.image(source))}" alt="${escapeHtml(alt)}">`;
  const name = nameOf(source);
  return page.views.includes(name) ? `<button class="view" type="button" data-view="${name}">${tag}</button>` : tag;
}

// The attributes of a live mark: { scene, sliders, ... }, only those that it gives.
export function parseMark(text) {
  const values = {};
  for (const word of text.split(/\s+/)) {
    const at = word.indexOf("=");
    const name = at < 0 ? word : word.slice(0, at);
    if (!LIVE_WORDS.includes(name)) throw new Error(`unknown word '${word}' in a live mark`);
    values[name] = word.slice(at + 1);
  }
  return values;
}

// A drawn mark: a name, and sliders.
export function parseDrawn(text) {
  const [name, ...words] = text.split(/\s+/), sliders = words.find((word) => word.startsWith("sliders="));
  if (!/^\w+$/.test(name) || words.some((word) => word !== sliders)) throw new Error(`'${text}' is not NAME sliders=...`);
  return { name, sliders: sliders?.slice("sliders=".length) ?? "" };
}

function drawnFigure({ name, sliders }, alt, source, page) {
  return `<figure class="drawn" data-drawn="${escapeHtml(name)}" data-sliders="${escapeHtml(sliders)}">${image(alt, source, page)}` +
    `<figcaption>${inline(alt, { ...page, views: [] })}</figcaption></figure>`;
}

// The figure of a table has no caption of its own: the table has the views' captions.
function figure(mark, alt, source, page, caption = `<figcaption>${inline(alt, { ...page, views: [] })}</figcaption>`) {
  const data = LIVE_WORDS.filter((word) => word in mark).map((word) => ` data-${word}="${escapeHtml(mark[word])}"`);
  page.views = [];
  const tag = image(alt, source, page);
  page.views = mark.views ? mark.views.split(",") : [];
  return `<figure class="live"${data.join("")}>${tag}${caption}</figure>`;
}

function cells(line) {
  return line.replace(/^\||\|\s*$/g, "").split("|").map((cell) => cell.trim());
}

function table(lines, page) {
  const row = (line, tag) => `<tr>${cells(line).map((cell) => `<${tag}>${inline(cell, page)}</${tag}>`).join("")}</tr>`;
  const body = lines.slice(2).map((line) => row(line, "td"));
  return `<table><thead>${row(lines[0], "th")}</thead><tbody>${body.join("")}</tbody></table>`;
}

// The image of a table that a live mark's scene makes: [whole, alt, source].
function imageOfScene(lines, scene) {
  for (const match of lines.join("\n").matchAll(/!\[([^\]]*)\]\(([^)]*)\)/g))
    if (nameOf(match[2]) === nameOf(scene)) return match;
  throw new Error(`no image of ${scene} in its table`);
}

function list(lines, page) {
  const tag = /^\d/.test(lines[0]) ? "ol" : "ul";
  const items = [];
  for (const line of lines) {
    const start = line.match(/^(?:-|\d+\.) (.*)$/);
    if (start) items.push(start[1]);
    else items[items.length - 1] += " " + line.trim();
  }
  return `<${tag}>${items.map((item) => `<li>${inline(item, page)}</li>`).join("")}</${tag}>`;
}

function code(lines) {
  const kind = COMMAND.test(lines[0].trim()) ? ' class="command"' : "";
  return `<pre${kind}><code>${escapeHtml(lines.map((line) => line.slice(4)).join("\n"))}</code></pre>`;
}

// The kinds of block, in the order in which they are tried: the first line, and how many lines follow.
const BLOCKS = [
  { first: /^<!-- .* -->$/, next: null },
  { first: /^#{1,6} /, next: null },
  { first: /^ {4}/, next: /^ {4}/ },
  { first: /^\|/, next: /^\|/ },
  { first: /^> /, next: /^> / },
  { first: /^(-|\d+\.) /, next: /^(-|\d+\.) |^ +\S/ },
  { first: /^!\[[^\]]*\]\([^)]*\)$/, next: null },
  { first: FOLD, next: null },
  { first: /\S/, next: /\S/ },
];

function block(kind, lines, mark, page) {
  const first = lines[0];
  if (kind === 1) {
    const [, marks, heading] = first.match(/^(#+) (.*)$/);
    page.views = [];
    return `<h${marks.length} id="${slug(heading)}">${inline(heading, page)}</h${marks.length}>`;
  }
  if (kind === 2) return code(lines);
  if (kind === 3) {
    if (!mark.live) return table(lines, page);
    const [, alt, source] = imageOfScene(lines, mark.live.scene);
    return figure(mark.live, alt, source, page, "") + "\n" + table(lines, page);
  }
  if (kind === 4) {
    const formula = mark.formula ? ` class="formula" data-formula="${escapeHtml(mark.formula)}"` : "";
    const text = lines.map((line) => line.slice(2)).join(" ");
    return `<blockquote${formula}><p>${mathHtml(text)}</p></blockquote>`;
  }
  if (kind === 5) return list(lines, page);
  if (kind === 6 && mark.live) {
    const [, alt, source] = first.match(/^!\[([^\]]*)\]\(([^)]*)\)$/);
    return figure(mark.live, alt, source, page);
  }
  if (kind === 6 && mark.drawn) {
    const [, alt, source] = first.match(/^!\[([^\]]*)\]\(([^)]*)\)$/);
    return drawnFigure(mark.drawn, alt, source, page);
  }
  if (kind === 7) {
    const title = first.match(FOLD)[1];
    return title === undefined ? "</details>" : `<details><summary>${inline(title, page)}</summary>`;
  }
  return `<p>${inline(lines.join(" "), page)}</p>`;
}

// options.link and options.image map the targets of links and images, for example to the server's paths.
export function markdownToHtml(text, options = {}) {
  const page = { link: options.link ?? ((target) => target), image: options.image ?? ((source) => source), views: [] };
  const lines = text.split("\n");
  const html = [];
  let mark = {};
  for (let i = 0; i < lines.length;) {
    if (!lines[i].trim()) {
      i++;
      continue;
    }
    const kind = BLOCKS.findIndex((b) => b.first.test(lines[i]));
    let end = i + 1;
    while (BLOCKS[kind].next && end < lines.length && BLOCKS[kind].next.test(lines[end])) end++;
    if (kind === 0) {
      const [, name, value] = lines[i].match(/^<!-- (\w+): (.*) -->$/) ?? [];
      if (name === "live") mark = { live: parseMark(value) };
      else if (name === "drawn") mark = { drawn: parseDrawn(value) };
      else if (name === "formula") mark = { formula: value };
      else throw new Error(`unknown mark: ${lines[i]}`);
    } else {
      html.push(block(kind, lines.slice(i, end), mark, page));
      mark = {};
    }
    i = end;
  }
  return html.join("\n") + "\n";
}
