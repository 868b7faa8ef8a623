// web/lecture/page.js: the lecture as a page: fetches a page's Markdown and fills an element with it.
import { attachFigures } from "./figures.js";
import { attachListings } from "./listing.js";
import { markdownToHtml } from "./markdown.js";

const PAGES = { en: "lecture.md", it: "lezione.md" };

// root is the element to fill. options: language "en" or "it"; docs, the address of the folder docs/ (with a slash);
// start, show, stop as in figures.js; sources, a list of the files, from the root of the tree, that lie beside docs/ and
// whose lines can be shown.
export async function openLecture(root, options) {
  const { docs, language = "en", sources = ["examples/lecture.c"] } = options;
  const get = async (address) => {
    const answer = await fetch(address);
    if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
    return answer.text();
  };
  const text = await get(docs + PAGES[language]);
  root.lang = language;
  root.innerHTML = markdownToHtml(text, { image: (source) => docs + source, link: (target) => (target.startsWith("#") ? target : docs + target) });
  for (const link of root.querySelectorAll("a")) {
    const target = link.getAttribute("href").slice(docs.length);
    if (target.includes("#L")) link.dataset.source = target;
  }
  attachListings(root, (path) => (sources.includes(path) ? get(`${docs}../${path}`) : undefined), language === "it" ? "Chiudi" : "Close");
  return attachFigures(root, { ...options, language });
}
