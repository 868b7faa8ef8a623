// The timeline below the image: the time of what moves, and the cameras of --trajectory. Scrub, play, loop; motion blur.
import { byId, make } from "./dom.js";
import { dress } from "./icons.js";
import { takePose } from "./steer.js";

const frameRate = 24; // of the cameras of a trajectory, as images a second; and of the shutter that blurs: half of 1/24 s

// One row: `from` and `to` are the ends of its slider, `places` the decimal places of its values; `go(value)` has a value shown and is called again only when that has happened.
class Track {
  constructor(root, name, title, { whole = false, rate, label, go }) {
    Object.assign(this, { label, go, rate, whole, value: 0, from: 0, to: 0 });
    this.slider = make("input", { type: "range", value: 0, "aria-label": title, id: `${name}-at` });
    this.slider.oninput = () => { this.stop(); this.show(Number(this.slider.value)); };
    this.player = make("button", { id: `${name}-play`, onclick: () => this.play() });
    dress(this.player, "play", "Play", title);
    this.looper = make("button", { id: `${name}-loop`, onclick: () => this.looper.setAttribute("aria-pressed", String(!this.loops)) });
    this.looper.setAttribute("aria-pressed", "true");
    dress(this.looper, "loop", "Loop", "begins again at the end");
    this.text = make("output", { id: `${name}-text` });
    this.row = make("div", { class: "track", hidden: true }, this.player, this.looper, this.slider, this.text);
    root.append(this.row);
  }

  get loops() { return this.looper.getAttribute("aria-pressed") === "true"; }

  // What velo says: the present value (null: none), and the ends. None moves the slider while values are on their way.
  set(value, from, to) {
    Object.assign(this, { from, to });
    this.row.hidden = !(to > from);
    this.places = this.whole ? 0 : Math.max(3, Math.ceil(3 - Math.log10(to - from || 1)));
    Object.assign(this.slider, { min: from, max: to, step: 10 ** -this.places });
    if (!this.pending && !this.playing) this.move(value ?? this.value);
  }
  move(value) {
    this.value = value;
    this.slider.value = value;
    this.text.textContent = this.label(value, this.to, this.places);
  }

  // Has a value shown; while one is on its way, the newest waits.
  show(value) {
    this.move(value);
    if (this.pending) { this.next = value; return; }
    this.pending = true;
    this.go(value);
  }
  // The value that was sent last is seen.
  seen() {
    this.pending = false;
    if (this.playing) return void this.step();
    const next = this.next;
    this.next = undefined;
    if (next !== undefined) this.show(next);
  }

  play() {
    if (this.playing) return this.stop();
    this.playing = { at: performance.now(), from: this.value >= this.to ? this.from : this.value };
    this.player.setAttribute("aria-pressed", "true");
    this.next = undefined;
    if (!this.pending) this.step();
  }
  stop() {
    this.playing = null;
    this.player.setAttribute("aria-pressed", "false");
  }
  end() {
    this.stop();
    this.next = undefined;
  }
  // The value of this moment: images that take longer are left out, so that the speed is right.
  step() {
    let value = this.playing.from + this.rate * (performance.now() - this.playing.at) / 1000;
    if (value > this.to && this.loops) {
      value = this.from + (value - this.from) % (this.to - this.from);
      this.playing = { at: performance.now(), from: value };
    } else if (value > this.to) {
      value = this.to;
      this.stop();
    }
    this.show(this.whole ? Math.floor(value) : Number(value.toFixed(this.places)));
  }
  enable(on) {
    for (const control of [this.slider, this.player, this.looper]) control.disabled = !on;
    if (!on) { this.stop(); this.pending = false; this.next = undefined; }
  }
}

export class Timeline {
  constructor(root, app) {
    this.app = app;
    this.root = root;
    this.motion = new Track(root, "time", "time of what moves", { rate: 1,
      label: (t, to, places) => `${t.toFixed(places - 1)} of ${to.toFixed(places - 1)} s`, go: at => this.time(at) });
    this.blur = make("button", { id: "blur", onclick: () => this.toggle() });
    dress(this.blur, "blur", "Blur", "motion blur: the shutter is open for a while, or for an instant");
    this.motion.row.insertBefore(this.blur, this.motion.slider);
    this.trajectory = new Track(root, "pose", "camera of the trajectory", { whole: true, rate: frameRate,
      label: (i, to) => `camera ${i + 1} of ${to + 1}`, go: i => this.pose(i) });
    for (const event of ["pointerdown", "keydown"]) root.addEventListener(event, () => { this.gesture = null; }, true); // each is a step of undo
  }

  state(state) {
    const { from, seconds, at, shutter } = state.time;
    this.shutter = shutter;
    this.open = shutter || this.open || 0.5 / frameRate;
    this.blur.setAttribute("aria-pressed", String(shutter > 0));
    this.motion.set(at, from, from + seconds);
    this.trajectory.set(null, 0, Math.max(0, state.poses - 1));
    this.root.hidden = this.motion.row.hidden && this.trajectory.row.hidden;
    if (state.poses && !this.poses) this.load();
  }
  // The cameras of the trajectory: they are asked for once, and again when the scene was loaded anew.
  load() {
    this.poses = [];
    this.app.ask({ type: "cameras" }, answer => { this.poses = answer.poses || []; });
  }
  loaded() { if (this.app.state?.poses) this.load(); }

  // Whether a step of the history ended what goes on.
  isOver() { return this.app.gestures.isOver(this.gesture ??= this.app.next()); }
  end() {
    for (const track of [this.motion, this.trajectory]) track.end();
  }

  time(at, shutter = this.shutter) {
    if (this.isOver()) { this.motion.pending = false; return; }
    this.sent = ++this.app.change;
    this.app.connection.send({ type: "time", at, shutter, gesture: this.gesture, change: this.sent });
  }
  toggle() {
    this.motion.stop();
    this.motion.pending = true;
    this.time(this.motion.value, this.shutter > 0 ? 0 : this.open);
  }
  pose(i) {
    if (this.isOver() || !this.poses[i]) { this.trajectory.pending = false; return; }
    this.app.edit(takePose(this.app.camera(), this.poses[i]), this.gesture);
    this.app.flush();
    this.moved = this.app.change;
  }

  frame(frame) {
    if (this.sent && frame.change >= this.sent) { this.sent = 0; this.motion.seen(); }
    if (this.moved && frame.change >= this.moved) { this.moved = 0; this.trajectory.seen(); }
  }
  // A time cannot be shown, or an edit of the camera was refused.
  refused() {
    if (!this.sent && !this.moved) return;
    this.sent = this.moved = 0;
    for (const track of [this.motion, this.trajectory]) {
      track.stop();
      track.pending = false;
    }
  }
  enable(on) {
    this.motion.enable(on);
    this.trajectory.enable(on);
    this.blur.disabled = !on;
    if (!on) this.sent = this.moved = 0;
  }
}

export const makeTimeline = app => new Timeline(byId("timeline"), app);
