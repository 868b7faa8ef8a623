// web/site/search.js: the search of the documentation: sections that have all words; those with words in the heading come first.
const words = document.getElementById("words"), found = document.getElementById("found"), hits = document.getElementById("hits");
const MOST = 30, AROUND = 70;
let sections = null;

const fold = (text) => text.toLowerCase().normalize("NFD").replace(/\p{M}/gu, "");

async function load() {
  sections ??= fetch("search.json").then((answer) => {
    if (!answer.ok) throw new Error(`search.json: ${answer.status}`);
    return answer.json();
  }).then((list) => list.map(([address, heading, text]) => ({ address, heading, text, head: fold(heading), body: fold(text) })));
  return sections;
}

function excerpt({ text, body }, terms) {
  const at = Math.max(0, Math.min(...terms.map((term) => body.indexOf(term)).filter((i) => i >= 0)) - AROUND);
  return Number.isFinite(at) ? (at ? "… " : "") + text.slice(at, at + 3 * AROUND) + " …" : "";
}

async function search() {
  const terms = fold(words.value).split(/\s+/).filter((term) => term.length > 1);
  const list = terms.length ? await load() : [];
  const score = (s) => terms.reduce((sum, term) => sum + (s.head.includes(term) ? 10 : 0) + Math.min(5, s.body.split(term).length - 1), 0);
  const all = list.filter((s) => terms.every((term) => s.head.includes(term) || s.body.includes(term))).sort((a, b) => score(b) - score(a));
  found.textContent = terms.length ? `${all.length} ${all.length === 1 ? "section" : "sections"}` + (all.length > MOST ? `, the first ${MOST}:` : "") : "";
  hits.replaceChildren(...all.slice(0, MOST).map((s) => {
    const item = document.createElement("li"), link = document.createElement("a"), line = document.createElement("p");
    Object.assign(link, { href: s.address, textContent: s.heading });
    line.textContent = excerpt(s, terms);
    item.append(link, line);
    return item;
  }));
}

words.disabled = false;
found.textContent = "";
const tell = (error) => { found.textContent = `The search does not work: ${error.message}.`; };
words.addEventListener("input", () => search().catch(tell));
document.getElementById("search").addEventListener("submit", (event) => { event.preventDefault(); search().catch(tell); });
