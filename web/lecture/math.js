// web/lecture/math.js: a line of formula as text, "f = zoom · d / s = 400", as MathML. Fractions are set upright, x_v has
// an index, **u** or a single u, v, w after numbers is a vector in its colour. Numbers are <mn>, so that the page can mark
// those that have changed.
//
// Words in quotation marks are text.
//
// Grammar: a line is sums between relations (= ≈ < > ≤ ≥ : , ;); a sum is products between + and −; a product is factors,
// with · or × or nothing between them; / makes a fraction of all factors before it in the product, and of the one after it.

import { updateScroll } from "./scroll.js";

const FUNCTIONS = ["cos", "sin", "tan", "atan", "acos", "√"];
const RELATIONS = ["=", "≈", "<", ">", "≤", "≥", ":", ",", ";", "→", "≠"];
const CLOSING = { "(": ")", "‖": "‖", "|": "|" };
const TOKEN = /"([^"]*)"|(\*\*[^*]+\*\*)|(\d+(?:[.,]\d+)?(?:e[−-]?\d+)?[°%]?)|([\p{L}](?:[\p{L}]|\d(?!\p{L}))*[′']*(?:_[\p{L}\p{N}]+)?[²³]?[′']*)|(\s{3,})|(\s+)|([\s\S])/gu;

const escape = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
const row = (parts) => (parts.length === 1 ? parts[0] : `<mrow>${parts.join("")}</mrow>`);

function tokens(text) {
  const list = [];
  for (const [, words, bold, number, name, gap, space, sign] of text.matchAll(TOKEN)) {
    if (words !== undefined) list.push({ kind: "text", text: words });
    else if (bold) list.push({ kind: "name", text: bold.slice(2, -2), vector: true });
    else if (number) list.push({ kind: "number", text: number });
    else if (name) list.push({ kind: "name", text: name });
    else if (gap) list.push({ kind: "gap", text: gap });
    else if (!space) list.push({ kind: "sign", text: sign });
  }
  return list;
}

function identifier({ text, vector }) {
  const [, base, index, power, prime] = text.match(/^([^_²³′']+)(?:_([^²³′']+))?([²³]?)([′']*)$/) ?? [null, text, "", "", ""];
  if (!vector && base.length > 4 && !index) return `<mtext>${escape(text)}</mtext>`;
  const kind = vector || (!index && "uvw".includes(base)) ? ` class="vector${"uvw".includes(base) ? ` axis-${base}` : ""}"` : "";
  let html = `<mi${kind}>${escape(base)}</mi>`;
  if (prime) html = `<msup>${html}<mo>′</mo></msup>`;
  if (index) html = `<msub>${html}<mi>${escape(index)}</mi></msub>`;
  return power ? `<msup>${html}<mn class="power">${power === "²" ? 2 : 3}</mn></msup>` : html;
}

class Parser {
  constructor(text) {
    this.list = tokens(text);
    this.at = 0;
  }
  get next() { return this.list[this.at]; }
  is(...signs) { return this.next?.kind === "sign" && signs.includes(this.next.text); }

  // The parts between relations; closing: the sign at which this ends.
  line(closing) {
    const parts = [[]];
    while (this.next && !(closing && this.is(closing))) {
      if (this.next.kind === "gap") {
        this.at++;
        parts.push([], []); // the empty one marks the gap
      } else if (this.is(...RELATIONS)) {
        const sign = this.list[this.at++].text;
        if (!closing && "=≈<>≤≥≠→".includes(sign)) parts.push([]);
        parts.at(-1).push(`<mo>${escape(sign)}</mo>`);
        if (!closing && ",:;".includes(sign)) parts.push([]);
      } else {
        parts.at(-1).push(this.sum(closing));
      }
    }
    return parts;
  }

  sum(closing) {
    const parts = [];
    while (this.next && this.next.kind !== "gap" && !this.is(...RELATIONS) && !(closing && this.is(closing))) {
      if (this.is("+", "−", "-", "±")) parts.push(`<mo>${this.list[this.at++].text}</mo>`);
      else if (this.is(".", ")", "/", "·", "×", "∞", "–", "…")) parts.push(`<mo>${this.list[this.at++].text}</mo>`); // alone
      else parts.push(this.product(closing));
    }
    return row(parts);
  }

  product(closing) {
    let parts = [];
    for (;;) {
      const bare = this.factor(closing);
      if (bare === null) break;
      parts.push(bare);
      if (this.is("/") && this.at + 1 < this.list.length) {
        this.at++;
        const below = this.factor(closing) ?? { html: "" };
        parts = [{ html: `<mfrac>${parts.length === 1 ? parts[0].inner ?? parts[0].html : row(parts.map((p) => p.html))}${below.inner ?? below.html}</mfrac>` }];
      }
      while (this.is("/")) { // a / b / c
        this.at++;
        const below = this.factor(closing) ?? { html: "" };
        parts = [{ html: `<mfrac>${row(parts.map((p) => p.html))}${below.inner ?? below.html}</mfrac>` }];
      }
      if (this.is("·", "×")) parts.push({ html: `<mo>${this.list[this.at++].text}</mo>` });
    }
    return row(parts.map((p) => p.html));
  }

  // { html, inner }: inner without its parentheses; null: there is none.
  factor(closing) {
    const token = this.next;
    if (!token || token.kind === "gap" || (closing && this.is(closing))) return null;
    if (token.kind === "number") {
      this.at++;
      return { html: `<mn>${escape(token.text)}</mn>` };
    }
    if (token.kind === "text") {
      this.at++;
      return { html: `<mtext>${escape(token.text)}</mtext>` };
    }
    if (token.kind === "name") {
      this.at++;
      const name = identifier(token);
      if (!FUNCTIONS.includes(token.text.replace("²", ""))) return { html: name };
      return { html: row([name, this.is("(") ? "" : '<mspace width="0.17em"/>', this.factor(closing)?.html ?? ""]) };
    }
    if (token.text === "√") {
      this.at++;
      const under = this.factor(closing);
      return { html: `<msqrt>${under?.inner ?? under?.html ?? ""}</msqrt>` };
    }
    const end = CLOSING[token.text];
    if (end) {
      this.at++;
      const inner = row(this.line(end).filter((part) => part.length).map(row));
      this.at++; // the closing sign
      return { html: `<mrow><mo>${token.text}</mo>${inner}<mo>${end}</mo></mrow>`, inner: end === ")" && !/<mo>[,;]/.test(inner) ? inner : undefined };
    }
    return null;
  }
}

// HTML of a line: one <math> for each part between relations, so that a narrow page can break the line there; what is
// between wide gaps stays together where there is room.
export function mathHtml(text) {
  const groups = [[]];
  for (const part of new Parser(text).line()) {
    if (part.length) groups.at(-1).push(`<math displaystyle="true">${row(part)}</math>`);
    else if (groups.at(-1).length) groups.push([]);
  }
  return groups.filter((group) => group.length).map((group) => `<span class="group">${group.join(" ")}</span>`).join(" ");
}

// Puts a line into an element and marks the numbers that differ from those it had. The text itself is data-text.
export function showMath(element, text) {
  if (element.dataset.text === text) return;
  const before = [...element.querySelectorAll("mn")].map((n) => n.textContent), known = element.dataset.text !== undefined;
  element.dataset.text = text;
  element.innerHTML = mathHtml(text);
  updateScroll(element);
  if (!known) return;
  const numbers = [...element.querySelectorAll("mn")];
  if (numbers.length === before.length) numbers.forEach((n, i) => n.classList.toggle("changed", n.textContent !== before[i]));
}
