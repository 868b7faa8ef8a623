// web/lecture/page.js: the lecture as a page: fetches a page's Markdown and fills an element with it.
import { attachFigures } from "./figures.js";
import { attachListings } from "./listing.js";
import { attachLinks } from "./links.js";
import { markdownToHtml } from "./markdown.js";
import { attachPresenter } from "./present.js";

const PAGES = { en: "lecture.md", it: "lezione.md" };

// Links lead to the page itself, to its other language, or to a file beside docs/, whose lines are shown. What else a link
// names (a folder, another page of docs/) is not here: its path is text.
function settleLinks(root) {
  for (const link of root.querySelectorAll("a")) {
    const target = link.getAttribute("href"), file = target.match(/^\.\.\/(.*\.[a-z]+)(#.*)?$/);
    const language = Object.keys(PAGES).find((name) => PAGES[name] === target);
    if (target.startsWith("#")) continue; // also links to a figure: "#projection?e=200"
    if (language) {
      Object.assign(link, { href: `?language=${language}`, hreflang: language });
    } else if (file) {
      link.dataset.source = target;
      link.title = file[1];
    } else {
      const path = target.startsWith("../") ? target.slice(3) : `docs/${target}`;
      const place = document.createElement("span");
      place.className = "place";
      place.append(...link.childNodes);
      if (!place.textContent.includes(path.replace(/^.*\//, ""))) place.append(` (${path})`);
      link.replaceWith(place);
    }
  }
}

// root is the element to fill. options: language "en" or "it"; docs, the address of the folder docs/ (with a slash), beside
// which the files lie that the pages link to; start, show, stop as in figures.js.
export async function openLecture(root, options) {
  const { docs, language = "en" } = options;
  const get = async (address) => {
    const answer = await fetch(address);
    if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
    return answer.text();
  };
  const text = await get(docs + PAGES[language]);
  root.lang = language;
  const page = document.createElement("template"); // its images are not fetched: drawn figures need none
  page.innerHTML = markdownToHtml(text, { image: (source) => docs + source });
  for (const image of page.content.querySelectorAll("figure.drawn img")) {
    image.closest("figure").dataset.alt = image.alt;
    image.remove();
  }
  page.content.querySelector("figure")?.classList.add("first");
  root.replaceChildren(page.content);
  settleLinks(root);
  attachListings(root, (path) => get(`${docs}../${path}`), language);
  const lecture = attachFigures(root, { ...options, language });
  const links = attachLinks(root, lecture, language), presenter = attachPresenter(root, lecture, language);
  return { ...lecture, presenter, follow: links.follow, stop: lecture.close, close() {
    links.close();
    presenter.close();
    lecture.close();
  } };
}
