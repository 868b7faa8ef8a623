// Buttons as icons. Their word is shown under the pointer and with the focus, on touch screens beneath the icon.
const NS = "http://www.w3.org/2000/svg";

// In a square of 24, lines of width 2.
const paths = {
  undo: "M9 14 4 9l5-5M4 9h10a6 6 0 0 1 0 12h-3",
  redo: "m15 14 5-5-5-5M20 9H10a6 6 0 0 0 0 12h3",
  reset: "m3 11 9-8 9 8M5 9.5V21h14V9.5",
  pause: "M8 5v14M16 5v14",
  denoise: "M10 4 8.3 9.3 3 11l5.3 1.7L10 18l1.7-5.3L17 11l-5.3-1.7zM19 15v6M16 18h6",
  outside: "M3 12 11 7v10zM11 7l10-4v18l-10-4",
  panel: "M3 4h18v16H3zM15 4v16",
  orbit: "M9.5 12a2.5 2.5 0 1 0 5 0 2.5 2.5 0 1 0-5 0M17 16c2.5-.9 4-2.3 4-4 0-2.8-4-5-9-5s-9 2.2-9 5 4 5 9 5m-3-3 3 3-3 3",
  look: "M2 12c3-5 6.5-7 10-7s7 2 10 7c-3 5-6.5 7-10 7s-7-2-10-7M9 12a3 3 0 1 0 6 0 3 3 0 1 0-6 0",
  inspect: "M4 10.5a6.5 6.5 0 1 0 13 0 6.5 6.5 0 1 0-13 0M15.5 15.5 21 21",
  turn: "M20 12a8 8 0 1 1-3-6.2M20 3v5h-5M11 12a1 1 0 1 0 2 0 1 1 0 1 0-2 0",
  focus: "M4 8V4h4M16 4h4v4M20 16v4h-4M8 20H4v-4M9 12a3 3 0 1 0 6 0 3 3 0 1 0-6 0",
  crop: "M6 2v16h16M2 6h16v16",
  play: "M7 4v16l13-8z",
  loop: "m17 2 4 4-4 4M3 11V9a3 3 0 0 1 3-3h15M7 22l-4-4 4-4M21 13v2a3 3 0 0 1-3 3H3",
  blur: "M14 12a4 4 0 1 0 8 0 4 4 0 1 0-8 0M2 8h9M5 12h6M2 16h9",
};

export function icon(name) {
  const svg = document.createElementNS(NS, "svg"), path = document.createElementNS(NS, "path");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  path.setAttribute("d", paths[name]);
  svg.append(path);
  return svg;
}

// Gives a button an icon. word: its name; more: what it does, and its key.
export function dress(button, name, word, more = "") {
  const label = Object.assign(document.createElement("span"), { className: "word", textContent: word });
  const tip = Object.assign(document.createElement("span"), { className: "tip", textContent: more ? `${word}: ${more}` : word });
  tip.setAttribute("aria-hidden", "true");
  button.classList.add("icon");
  button.replaceChildren(icon(name), label, tip);
  button.setAttribute("aria-label", word);
  if (more) button.setAttribute("aria-description", more);
}
