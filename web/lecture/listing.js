// web/lecture/listing.js: lines of a source file, shown in a dialog when a link to them is followed.
import { escapeHtml } from "./markdown.js";

// "../examples/lecture.c#L10-L20" gives { path, first, last }; null: no link to lines.
export function parseLines(href) {
  const match = href.match(/^(?:\.\.\/)*(.*)#L(\d+)(?:-L(\d+))?$/);
  return match && { path: match[1], first: Number(match[2]), last: Number(match[3] ?? match[2]) };
}

export function listingHtml(text, { first, last }) {
  const lines = text.replace(/\n$/, "").split("\n").slice(first - 1, last);
  const row = (line, i) => `<span class="line"><span class="number">${first + i}</span>${escapeHtml(line)}\n</span>`;
  return `<pre class="listing"><code>${lines.map(row).join("")}</code></pre>`;
}

// Links below root to lines of files that read(path) can give (a promise of text; undefined: it has no such file) open a
// dialog; others stay links.
export function attachListings(root, read, close = "Close") {
  const dialog = document.createElement("dialog");
  dialog.className = "listing";
  root.append(dialog);
  root.addEventListener("click", async (event) => {
    const link = event.target.closest?.("a[data-source]");
    const place = link && parseLines(link.dataset.source);
    const text = place && read(place.path);
    if (!text) return;
    event.preventDefault();
    dialog.innerHTML = `<h2>${escapeHtml(place.path)}</h2>${listingHtml(await text, place)}` +
      `<form method="dialog"><button>${escapeHtml(close)}</button></form>`;
    dialog.showModal();
  });
}
