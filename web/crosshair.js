// A pixel is picked by keyboard: Enter shows a cross on the image, the arrow keys move it by a pixel, by 10 with Shift, Enter does what a
// click there does with the chosen tool, Escape ends it. For a crop, Enter sets one corner and then the other.
import { byId } from "./dom.js";

const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Crosshair {
  // app: screen, tool, pick(x, y, kind), crop(rectangle), band(rectangle), hover(x, y), cross(pixel)
  constructor(stage, app) {
    this.stage = stage;
    this.app = app;
    this.at = null; // a pixel: column, row; null: there is no cross
    stage.addEventListener("pointerdown", () => this.end());
  }

  // What a key does; null: nothing.
  action(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.app.screen.frame) return null;
    const here = event.target === this.stage || event.target === document.body;
    if (event.key === "Enter" && here) return () => this.at ? this.choose() : this.begin();
    if (!this.at) return null;
    const way = ways[event.key], step = event.shiftKey ? 10 : 1;
    if (way && here) return () => this.move(this.at[0] + step * way[0], this.at[1] + step * way[1]);
    return event.key === "Escape" ? () => this.end() : null;
  }

  begin() {
    const { canvas } = this.app.screen;
    byId("hover").setAttribute("aria-live", "polite");
    this.move(...this.app.screen.toImage(canvas.clientWidth / 2, canvas.clientHeight / 2).map(Math.floor));
  }

  end() {
    if (!this.at) return;
    this.at = this.corner = null;
    byId("hover").setAttribute("aria-live", "off");
    this.app.cross(null);
    this.app.band(null);
    this.app.hover(-1, -1);
  }

  // To a pixel of the image; a part of it that is magnified follows.
  move(x, y) {
    const { screen } = this.app, { width, height } = screen.frame, { clientWidth, clientHeight } = screen.canvas;
    this.at = [Math.max(0, Math.min(width - 1, x)), Math.max(0, Math.min(height - 1, y))];
    const [left, top] = screen.toPage(this.at[0] + 0.5, this.at[1] + 0.5), beyond = (v, most) => Math.min(0, most - v) + Math.max(0, -v);
    if (screen.zoom > 1 && (beyond(left, clientWidth) || beyond(top, clientHeight))) screen.shift(beyond(left, clientWidth), beyond(top, clientHeight));
    this.app.cross(this.at);
    this.app.hover(this.at[0] + 0.5, this.at[1] + 0.5);
    if (this.corner) this.app.band(this.rectangle());
  }

  // The pixels between both corners, with both.
  rectangle() {
    const [a, b] = [this.corner, this.at], [low, high] = [Math.min, Math.max];
    return [low(a[0], b[0]), low(a[1], b[1]), high(a[0], b[0]) + 1, high(a[1], b[1]) + 1];
  }

  choose() {
    const [x, y] = this.at;
    if (this.app.tool !== "crop") return this.app.pick(x + 0.5, y + 0.5, this.app.tool);
    if (!this.corner) {
      this.corner = [x, y];
      return this.app.band(this.rectangle());
    }
    const rectangle = this.rectangle();
    this.end();
    this.app.crop(rectangle);
  }
}
