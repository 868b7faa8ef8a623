// The list of keys.
import { make } from "./dom.js";
import { keys } from "./pointer.js";

export function addHelp(root) {
  const list = make("dl", { class: "values" });
  for (const [key, text] of keys) list.append(make("dt", {}, make("kbd", { textContent: key })), make("dd", { textContent: text }));
  root.append(list);
}
