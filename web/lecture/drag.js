// web/lecture/drag.js: dragging a live image turns the camera round lookat, as on the page of velo view; with Ctrl or
// Shift it looks round or moves sideways. A click picks a pixel. Arrow keys turn, too; after Enter they move the picked pixel,
// by 10 with Shift, until Enter or Escape. The wheel and vertical strokes of a finger scroll.
import * as steer from "../steer.js";

const ARROWS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

// live: state, null while velo loads; camera(), edit(set), next() before a gesture, screen.factor().
export function attachDrag(canvas, live) {
  let last = null, moved = 0, picked = null; // picked: the pixel that arrow keys move
  canvas.tabIndex = 0;
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !live.state) return;
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    last = event;
    moved = 0;
    live.next();
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (last?.pointerId !== event.pointerId || !live.state) return;
    const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
    const c = live.camera(), k = live.screen.factor(), angle = Math.PI / canvas.clientHeight;
    last = event;
    moved += Math.abs(dx) + Math.abs(dy);
    if (moved < 3) return;
    live.edit(event.shiftKey ? steer.pan(c, dx / k, dy / k) : event.ctrlKey ? steer.look(c, -dx / c.fx / k, -dy / c.fy / k)
      : steer.orbit(c, dx * angle, dy * angle));
  });
  canvas.addEventListener("pointerup", (event) => {
    const box = canvas.getBoundingClientRect();
    if (last && moved < 3 && live.state) live.pick(...live.screen.toImage(event.clientX - box.left, event.clientY - box.top));
    last = null;
  });
  canvas.addEventListener("pointercancel", () => { last = null; });
  canvas.addEventListener("blur", () => { picked = null; });
  canvas.addEventListener("keydown", (event) => {
    const way = ARROWS[event.key];
    if (!live.state || event.ctrlKey || event.altKey || event.metaKey) return;
    const { width, height } = live.camera();
    if (event.key === "Enter" || (event.key === "Escape" && picked)) {
      picked = picked ? null : [Math.floor(width / 2), Math.floor(height / 2)];
      if (picked) live.pick(...picked);
      event.preventDefault();
      event.stopPropagation();
      return;
    }
    if (!way) return;
    if (picked) {
      const step = event.shiftKey ? 10 : 1;
      picked = [Math.min(width - 1, Math.max(0, picked[0] - step * way[0])), Math.min(height - 1, Math.max(0, picked[1] - step * way[1]))];
      live.pick(...picked);
    } else live.edit((event.shiftKey ? steer.look : steer.orbit)(live.camera(), 0.06 * way[0], 0.06 * way[1]));
    event.preventDefault();
  });
}
