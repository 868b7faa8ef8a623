// web/lecture/main.js: the page of velo view --lecture: the lecture in one of its languages, with velo as the renderer.
import { Live } from "./live.js";
import { decoded } from "./links.js";
import { openLecture } from "./page.js";
import { attachScroll } from "./scroll.js";

const byId = (id) => document.getElementById(id);
const OTHER = { en: ["it", "Italiano"], it: ["en", "English"] };

const live = new Live((text) => { byId("status").textContent = text; }, (text) => { byId("engine").textContent = text; });
let lecture = null;

// The heading that is being read, as its number and its place on the screen: both languages have the same headings.
function readingPlace() {
  const headings = [...document.querySelectorAll("#page > :is(h1, h2, h3)")];
  const index = Math.max(0, headings.findLastIndex((h) => h.getBoundingClientRect().top < innerHeight / 3));
  return { index, top: headings[index]?.getBoundingClientRect().top ?? 0 };
}

async function open(language, place) {
  lecture?.close();
  const root = Object.assign(document.createElement("main"), { id: "page", className: "lecture" });
  byId("page").replaceWith(root);
  live.use(language);
  lecture = await openLecture(root, { docs: "docs/", language, start: (...a) => live.start(...a), show: (...a) => live.show(...a), stop: (...a) => live.stop(...a) });
  live.figures = lecture.figures;
  attachScroll(root);
  document.documentElement.lang = language;
  document.title = root.querySelector("h1").textContent;
  const [other, name] = OTHER[language];
  Object.assign(byId("language"), { textContent: name, lang: other, hreflang: other, href: `?language=${other}` });
  await Promise.all([...root.querySelectorAll("img")].map((image) => image.decode().catch(() => 0)));
  const heading = place && root.querySelectorAll(":scope > :is(h1, h2, h3)")[place.index];
  if (heading) scrollBy(0, heading.getBoundingClientRect().top - place.top);
  else if (!lecture.follow() && location.hash) document.getElementById(decoded(location.hash.slice(1)))?.scrollIntoView();
}

function choose(language) {
  history.replaceState(null, "", `?language=${language}`);
  return open(language, readingPlace());
}

// The link in the bar and the link of the text itself lead to the other language.
document.addEventListener("click", (event) => {
  const language = event.target.closest?.("a[hreflang]")?.hreflang;
  if (!language || event.ctrlKey || event.metaKey || event.shiftKey) return;
  event.preventDefault();
  choose(language);
});

const asked = new URLSearchParams(location.search).get("language");
open(OTHER[asked] ? asked : document.documentElement.lang).catch((error) => { byId("status").textContent = error.message; });
window.velo = { live, choose, get lecture() { return lecture; } }; // for tests
