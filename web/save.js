// Saves the image and the camera beside the scene's terminal, and copies the command that makes this very image.
import { make, row } from "./dom.js";

const suffixes = { opencv: "yaml", ros: "yaml", kalibr: "yaml", colmap: "txt", gltf: "gltf", mitsuba: "xml", usd: "usda",
  pbrt: "pbrt", euroc: "yaml", camodocal: "yaml", orbslam: "yaml", okvis: "yaml", svo: "yaml", kitti: "txt",
  metashape: "xml", meshroom: "sfm", visp: "xml" };
const formats = ["png", "exr", "jpg", "hdr", "pfm", "tga", "dng"];

export class Save {
  constructor(root, app) {
    this.app = app;
    this.format = make("select", { id: "format" }, ...formats.map(f => make("option", { value: f, textContent: `.${f}` })));
    this.dialect = make("select", { id: "dialect" });
    this.report = make("div", { class: "hint", role: "status" });
    this.command = make("code", { class: "command" });
    this.command.hidden = true;
    this.verdict = make("div", { id: "verdict", class: "hint", role: "status" });
    const button = (id, text, action) => make("button", { id, textContent: text, onclick: action });
    root.append(row(make("label", { textContent: "image", htmlFor: "format" }), this.format, button("save-image", "Save image", () => this.image())),
      row(make("label", { textContent: "camera", htmlFor: "dialect" }), this.dialect, button("save-camera", "Save camera", () => this.camera())),
      make("div", { class: "buttons" }, button("copy-command", "Copy command", () => this.copy()),
        this.verifier = button("verify-command", "Verify", () => this.verify())),
      this.report, this.command, this.verdict);
    this.verifier.title = "runs the copied command in the background and compares its image with the page's, byte by byte";
    app.onlists = lists => this.dialect.replaceChildren(...lists.dialects.map(d => make("option", { value: d, textContent: d })));
  }

  get look() { return { exposure: this.app.display.ev, view: this.app.display.viewName }; }
  get stem() { return this.app.state.scene.split("/").pop().replace(/\.[^.]*$/, ""); }

  answered(answer) {
    this.report.textContent = answer.type === "saved" ? `written: ${answer.file}, in the folder where velo view was started` : answer.message;
    this.report.classList.toggle("why", answer.type !== "saved");
  }
  image() {
    this.app.ask({ type: "save", what: "image", name: `${this.stem}.${this.format.value}`, ...this.look }, a => this.answered(a));
  }
  camera() {
    const dialect = this.dialect.value, name = dialect === "nerf" ? "transforms.json" : `${this.stem}-camera.${suffixes[dialect] || "json"}`;
    this.app.ask({ type: "save", what: "camera", name, dialect }, a => this.answered(a));
  }
  copy(then = () => {}) {
    this.app.ask({ type: "command", ...this.look }, answer => {
      if (answer.type !== "command") return this.answered(answer);
      this.command.textContent = answer.command;
      this.command.hidden = false;
      this.copied = answer.image;
      this.tell("");
      this.report.textContent = `the camera is in ${answer.file}; the command makes the ${answer.spp} samples that are shown`;
      this.report.classList.remove("why");
      navigator.clipboard?.writeText(answer.command).catch(() => {});
      then();
    });
  }

  tell(text, wrong = false) {
    this.verdict.textContent = text;
    this.verdict.classList.toggle("why", wrong);
  }
  // The command that is shown is run; a second click ends it.
  verify() {
    if (this.verifying) return this.app.connection.send({ type: "verify", end: true });
    if (this.command.hidden) return this.copy(() => this.verify());
    const image = this.copied;
    this.run(true);
    this.tell("the command runs …");
    this.app.ask({ type: "verify" }, answer => {
      this.run(false);
      const same = answer.type === "verified" && answer.same;
      this.tell(same ? `${image}: same bytes ✓ SHA-256 ${answer.sha256}` : answer.type === "verified" ? `${image}: ${answer.message}` : answer.message, !same);
    });
  }
  run(on) {
    this.verifying = on;
    this.verifier.textContent = on ? "Stop" : "Verify";
  }
}
