// web/lecture/scroll.js: what is wider than its box scrolls, also by the keyboard: such boxes can be focused.
export function attachScroll(root) {
  const update = (box) => {
    if (box.scrollWidth > box.clientWidth || box.scrollHeight > box.clientHeight) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
  };
  const observer = new ResizeObserver((entries) => entries.forEach(({ target }) => update(target)));
  for (const box of root.querySelectorAll("pre, table")) observer.observe(box);
}
