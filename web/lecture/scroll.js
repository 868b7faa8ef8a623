// web/lecture/scroll.js: what is wider than its box scrolls, also by the keyboard: such boxes can be focused.
export function updateScroll(box) {
  if (box.scrollWidth > box.clientWidth || box.scrollHeight > box.clientHeight) box.tabIndex = 0;
  else box.removeAttribute("tabindex");
}

export function attachScroll(root) {
  const observer = new ResizeObserver((entries) => entries.forEach(({ target }) => updateScroll(target)));
  for (const box of root.querySelectorAll("pre, table, blockquote, .numbers")) observer.observe(box);
}
