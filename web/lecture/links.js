// web/lecture/links.js: a link to a figure with the values of its sliders: "#eye_150?view=eye_100&d=300". The hash names the
// figure; what it gives is set, within the sliders' ranges. A figure's button makes such a link.
import { make } from "../dom.js";
import { sliderValue, withSlider } from "./sliders.js";
import { words } from "./words.js";

// A part of an address as text; what is no proper code stays as it is.
export function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

const short = (value) => String(Number(Number(value).toPrecision(6)));

// Of a hash: { name, values }, null if it leads to no figure.
export function parseHash(hash) {
  const [name, query] = decoded(hash.replace(/^#/, "")).split("?");
  return name ? { name, values: Object.fromEntries(new URLSearchParams(query ?? "")) } : null;
}

// The values as state of a figure, those that sliders and choices have; complaints: one sentence for each that is not so.
export function readValues(figure, values, language) {
  const set = {}, complaints = [], it = language === "it";
  for (const [name, text] of Object.entries(values)) {
    const row = figure.rows.find((r) => r.slider.name === name), choice = figure.drawing?.choices?.[name];
    if (name === "view" || name === "page") continue;
    if (choice) {
      if (choice.includes(text)) set[name] = text;
      else complaints.push(it ? `Il collegamento ha ${name} = ${text}, che non esiste.` : `The link has ${name} = ${text}, which does not exist.`);
      continue;
    }
    const value = Number(text);
    if (!row || text.trim() === "" || !Number.isFinite(value)) {
      complaints.push(it ? `Il collegamento ha ${name} = ${text}, che questa figura non ha.` : `The link has ${name} = ${text}, which this figure does not have.`);
      continue;
    }
    const { min, max } = row.slider;
    set[name] = Math.min(Math.max(value, min), max);
    if (set[name] !== value) complaints.push(it ? `Il collegamento ha ${name} = ${text}: qui va da ${min} a ${max}.` : `The link has ${name} = ${text}: here it goes from ${min} to ${max}.`);
  }
  return { set, complaints };
}

export function addressOf(figure) {
  const query = new URLSearchParams();
  const view = figure.views.find((button) => button.getAttribute("aria-pressed") === "true");
  if (view) query.set("view", view.dataset.view);
  for (const name of Object.keys(figure.drawing?.choices ?? {})) if (figure.state[name]) query.set(name, figure.state[name]);
  if (figure.camera) for (const { slider, row } of figure.rows) if (!row.hidden) query.set(slider.name, short(sliderValue(figure.camera, slider.name)));
  return `#${figure.name}${[...query].length ? `?${query}` : ""}`;
}

export function attachLinks(root, { figures, drawn }, language) {
  const all = [...figures, ...drawn], w = words(language);
  for (const figure of all) {
    figure.element.id = figure.name;
    const said = make("output", { class: "copied" });
    const button = make("button", { type: "button", class: "link", textContent: w.link, onclick: () => {
      const hash = addressOf(figure);
      history.replaceState(null, "", hash);
      navigator.clipboard?.writeText(location.href).then(() => { said.textContent = w.copied; }, () => 0);
      setTimeout(() => { said.textContent = ""; }, 2500);
    } });
    figure.bar = make("div", { class: "figure-bar" }, button, said);
    figure.element.append(figure.bar);
  }

  const apply = (figure, values) => {
    const { set, complaints } = readValues(figure, values, language);
    figure.element.querySelector(".complaint")?.remove(); // of the link before; messages of the engine have a line of their own
    if (complaints.length) figure.element.append(make("p", { class: "error complaint", role: "status", textContent: complaints.join(" ") }));
    if (figure.drawing) {
      figure.set({ ...figure.drawing.state, ...set }, true);
      return;
    }
    const ready = () => {
      let camera = figure.camera;
      for (const [name, value] of Object.entries(set)) if (sliderValue(camera, name) !== undefined) camera = withSlider(camera, name, value);
      figure.set(camera, true);
    };
    const view = figure.views.find((button) => button.dataset.view === values.view);
    const scene = view ? `${figure.folder}${view.dataset.view}.pbrt` : figure.scene;
    if (figure.seen && figure.scene === scene && figure.camera) return ready();
    figure.onready = ready;
    if (view) figure.scene = scene;
    if (figure.seen) figure.start(scene, false);
  };

  // Goes to the figure of the address; false: it names none.
  const follow = () => {
    const place = parseHash(location.hash), figure = place && all.find((f) => f.name === place.name);
    if (!figure) return false;
    figure.element.scrollIntoView({ block: "center" });
    if (Object.keys(place.values).length) apply(figure, place.values);
    return true;
  };
  const click = (event) => { // also where the address is the same as before
    const link = event.target.closest?.("a[href^='#']");
    if (!link || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const place = parseHash(link.getAttribute("href"));
    if (!all.some((f) => f.name === place?.name)) return;
    event.preventDefault();
    history.pushState(null, "", link.getAttribute("href"));
    follow();
  };
  root.addEventListener("click", click);
  addEventListener("popstate", follow);
  return { follow, close() { removeEventListener("popstate", follow); } };
}
