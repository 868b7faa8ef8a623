// Small helpers to make elements.
export const byId = id => document.getElementById(id);

// make("label", { class: "x", textContent: "y", onclick: f }, child, ...)
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === "class") element.className = value;
    else if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

export const row = (label, ...inputs) => make("div", { class: "row" }, label, make("div", { class: "inputs" }, ...inputs));

// A number as people write it: at most `digits` significant ones.
export function short(value, digits = 6) {
  if (value === null || value === undefined) return "";
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "" : value > 0 ? "∞" : "−∞";
  return String(Number(value.toPrecision(digits)));
}

export function metric(value) {
  if (!Number.isFinite(value)) return "–";
  for (const [unit, size] of [["G", 1e9], ["M", 1e6], ["k", 1e3]])
    if (Math.abs(value) >= size) return `${(value / size).toPrecision(3)} ${unit}`;
  return value.toPrecision(3);
}
