// web/lecture/listing.js: lines of a source file, shown in a dialog when a link to them is followed.
import { escapeHtml } from "./markdown.js";

const WORDS = { en: { close: "Close", whole: "The whole file", part: "Only these lines" },
                it: { close: "Chiudi", whole: "Il file intero", part: "Solo queste righe" } };

// "../examples/lecture.c#L10-L20" gives { path, first, last }; without lines { path }; null: no such link.
export function parseLines(href) {
  const match = href.match(/^(?:\.\.\/)*([^#]*)(?:#L(\d+)(?:-L(\d+))?)?$/);
  if (!match) return null;
  return match[2] ? { path: match[1], first: Number(match[2]), last: Number(match[3] ?? match[2]) } : { path: match[1] };
}

// The lines from first to last, or, if whole, all lines with those marked.
export function listingHtml(text, { first = 1, last = Infinity }, whole = false) {
  const lines = text.replace(/\n$/, "").split("\n");
  const row = (line, i) => {
    const number = i + 1, inside = number >= first && number <= last;
    if (!whole && !inside) return "";
    const mark = whole && inside && last < Infinity ? " marked" : "";
    return `<span class="line${mark}"><span class="number">${number}</span>${escapeHtml(line)}\n</span>`;
  };
  return `<pre class="listing"><code>${lines.map(row).join("")}</code></pre>`;
}

// Links below root to files that read(path) gives (a promise of text) open a dialog.
export function attachListings(root, read, language = "en") {
  const dialog = document.createElement("dialog"), words = WORDS[language];
  dialog.className = "listing";
  root.append(dialog);
  const show = (text, place, whole) => {
    const other = place.first ? `<button type="button" class="whole">${escapeHtml(whole ? words.part : words.whole)}</button> ` : "";
    dialog.innerHTML = `<h2>${escapeHtml(place.path)}</h2>${listingHtml(text, place, whole)}` +
      `<form method="dialog">${other}<button class="close">${escapeHtml(words.close)}</button></form>`;
    dialog.querySelector(".whole")?.addEventListener("click", () => show(text, place, !whole));
    if (!dialog.open) dialog.showModal();
    dialog.querySelector(".marked")?.scrollIntoView({ block: "center" });
    dialog.querySelector(".close").focus({ preventScroll: true });
  };
  dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); }); // beside it
  root.addEventListener("click", async (event) => {
    const link = event.target.closest?.("a[data-source]");
    const place = link && parseLines(link.dataset.source);
    if (!place) return;
    event.preventDefault();
    try {
      show(await read(place.path), place, !place.first);
    } catch (error) {
      show(error.message, { path: place.path }, true);
    }
  });
}
