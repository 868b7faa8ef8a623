// web/lecture/present.js: the presenter's view: one figure fills the window, in big type. The arrow keys and Page Up, Page
// Down go from figure to figure, Escape goes back to the page.
import { make } from "../dom.js";
import { words } from "./words.js";

export function attachPresenter(root, { figures, drawn }, language) {
  const w = words(language), all = [...root.querySelectorAll("figure.live, figure.drawn")].map((element) => [...figures, ...drawn].find((f) => f.element === element));
  const title = make("span", { class: "title" }), number = make("output");
  const bar = make("div", { class: "presenter-bar", role: "toolbar" }, make("button", { type: "button", textContent: "←", "aria-label": w.before, onclick: () => go(-1) }),
    make("button", { type: "button", textContent: "→", "aria-label": w.next, onclick: () => go(1) }), number, title,
    make("button", { type: "button", textContent: w.leave, onclick: () => leave() }));
  bar.setAttribute("aria-label", w.present);
  bar.title = w.keys;
  root.prepend(bar);
  let at = -1;

  const show = (index) => {
    all[at]?.element.classList.remove("presented");
    at = Math.min(Math.max(index, 0), all.length - 1);
    const { element } = all[at];
    let heading = element;
    while (heading && !heading.matches("h2, h1")) heading = heading.previousElementSibling;
    element.classList.add("presented");
    document.body.classList.add("presenting");
    title.textContent = heading?.textContent ?? "";
    number.textContent = w.figure(at + 1, all.length);
    scrollTo(0, 0);
    dispatchEvent(new Event("resize")); // the figure that is seen becomes live
  };
  const go = (step) => show(at + step);
  const leave = () => {
    const { element } = all[at];
    element.classList.remove("presented");
    document.body.classList.remove("presenting");
    at = -1;
    element.scrollIntoView({ block: "center" });
    dispatchEvent(new Event("resize"));
  };
  all.forEach((figure, i) => figure.bar.append(make("button", { type: "button", class: "present", textContent: w.present, onclick: () => show(i) })));

  const STEPS = { ArrowRight: 1, ArrowDown: 1, PageDown: 1, ArrowLeft: -1, ArrowUp: -1, PageUp: -1 };
  const key = (event) => {
    if (at < 0 || event.ctrlKey || event.altKey || event.metaKey || document.querySelector("dialog[open]")) return;
    if (event.key === "Escape") return leave();
    const arrows = event.target.matches?.("input, textarea, select, canvas, pre");
    if (!(event.key in STEPS) || (arrows && event.key.startsWith("Arrow")) || event.target.matches?.("textarea")) return;
    event.preventDefault();
    go(STEPS[event.key]);
  };
  const release = (event) => { if (at >= 0 && event.target.matches?.("input[type=range]")) event.target.blur(); }; // so that the arrow keys turn the pages
  addEventListener("keydown", key);
  addEventListener("pointerup", release);
  return { show, go, leave, get at() { return at; }, close() {
    removeEventListener("keydown", key);
    removeEventListener("pointerup", release);
    document.body.classList.remove("presenting");
  } };
}
