// The canvas: develops frames into 8-bit pixels and lays them on the page, whole or zoomed in, through WebGL2.
import { develop, lay, vertex } from "./shaders.js";
import { Pixels } from "./frame.js";
import { Plain, developed } from "./plain.js";

function compile(gl, fragment) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  const places = {};
  return { program, at: name => places[name] ??= gl.getUniformLocation(program, name) };
}

function texture(gl, internal, width, height) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texStorage2D(gl.TEXTURE_2D, 1, internal, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  return made;
}

// A frame on the graphics processor: its values, which tiles replace in part, and its developed pixels.
class Layer {
  constructor(gl) {
    this.gl = gl;
    this.frame = null;
    this.stale = true;
  }

  take(frame, fits) {
    const gl = this.gl, n = frame.channels - 1, half = frame.format === 0;
    const format = [gl.RED, gl.RG, gl.RGB][n], type = half ? gl.HALF_FLOAT : gl.FLOAT;
    const internal = half ? [gl.R16F, gl.RG16F, gl.RGB16F][n] : [gl.R32F, gl.RG32F, gl.RGB32F][n];
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    if (!this.values || !fits) {
      if (this.values) gl.deleteTexture(this.values), gl.deleteTexture(this.shown), gl.deleteFramebuffer(this.target);
      this.values = texture(gl, internal, frame.columns, frame.rows);
      this.shown = texture(gl, gl.RGBA8, frame.columns, frame.rows);
      this.target = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.shown, 0);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }
    gl.bindTexture(gl.TEXTURE_2D, this.values);
    for (const t of frame.tiles) gl.texSubImage2D(gl.TEXTURE_2D, 0, t.x, t.y, t.w, t.h, format, type, t.pixels);
    this.frame = frame;
    this.stale = true;
  }

  develop(program, display) {
    const gl = this.gl;
    if (!this.stale) return;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.viewport(0, 0, this.frame.columns, this.frame.rows);
    gl.useProgram(program.program);
    gl.bindTexture(gl.TEXTURE_2D, this.values);
    gl.uniform4f(program.at("place"), -1, -1, 1, 1);
    gl.uniform1f(program.at("exposure"), 2 ** display.exposure);
    gl.uniform3fv(program.at("low"), display.low);
    gl.uniform3fv(program.at("high"), display.high);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.stale = false;
  }
}

export class Screen {
  // plain: without WebGL2 the processor draws; else that is an error.
  constructor(canvas, plain = false) {
    this.canvas = canvas;
    this.plain = plain ? new Plain(canvas) : null;
    this.gl = canvas.getContext("webgl2", { antialias: false, alpha: true, preserveDrawingBuffer: false });
    if (!this.gl && !plain) throw new Error("this browser has no WebGL2");
    this.pixels = new Pixels();
    if (this.gl) this.begin();
    canvas.addEventListener("webglcontextlost", event => {
      event.preventDefault(); // so that it can come back
      this.lost = this.stale = true;
      this.draw();
      this.onlost?.();
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.lost = false;
      this.restore();
      this.onrestored?.();
    });
    this.display = { exposure: 0, view: 0, kind: 0, low: [0, 0, 0], high: [1, 1, 1] };
    this.zoom = 1;                   // 1: the whole image fits
    this.centre = [0.5, 0.5];        // place of the image in the middle of the stage
    this.drawn = 0;
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  begin() {
    const { gl } = this;
    this.programs = new Map();
    this.laying = compile(gl, lay);
    this.layer = new Layer(gl); // the present frame
    this.whole = new Layer(gl); // the last frame of the whole image, behind a rectangle
  }

  // After a loss of the context: the present frame again.
  restore() {
    this.begin();
    const { frame } = this;
    if (!frame) return;
    this.layer.take({ ...frame, tiles: [{ x: 0, y: 0, w: frame.columns, h: frame.rows, pixels: this.pixels.data }] }, false);
    this.draw();
  }

  get frame() { return this.pixels.frame; }
  get hasGL() { return Boolean(this.gl) && !this.lost && !this.gl.isContextLost(); }

  take(frame) {
    const fits = this.pixels.fits(frame);
    const isWhole = frame.columns * frame.scale >= frame.width && frame.rows * frame.scale >= frame.height;
    const { hasGL } = this;
    if (hasGL && !isWhole && this.layer.frame && !fits && !this.cropped) [this.layer, this.whole] = [this.whole, this.layer];
    this.cropped = !isWhole;
    if (hasGL) this.layer.take(frame, fits && this.layer.frame !== null);
    this.pixels.take(frame);
    this.stale = true;
    this.draw();
  }

  resize() {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
    this.canvas.width = Math.max(1, Math.round(box.width * ratio));
    this.canvas.height = Math.max(1, Math.round(box.height * ratio));
    this.draw();
    this.onplace?.();
  }

  // Pixels of the page per pixel of the image.
  factor() {
    const f = this.frame, box = this.canvas.getBoundingClientRect();
    const fit = Math.min(box.width / f.width, box.height / f.height);
    const exact = 1 / (window.devicePixelRatio || 1);
    return this.zoom * (this.zoom === 1 && fit > exact && fit < 1.12 * exact ? exact : fit);
  }

  // Left and top edge of the image in the page, relative to the canvas.
  origin() {
    const f = this.frame, box = this.canvas.getBoundingClientRect(), k = this.factor();
    const ratio = window.devicePixelRatio || 1, snap = v => Math.round(v * ratio) / ratio;
    return [snap(box.width / 2 - this.centre[0] * f.width * k), snap(box.height / 2 - this.centre[1] * f.height * k)];
  }

  // From a place relative to the canvas to image pixels, and back.
  toImage(x, y) {
    const k = this.factor(), [left, top] = this.origin();
    return [(x - left) / k, (y - top) / k];
  }
  toPage(x, y) {
    const k = this.factor(), [left, top] = this.origin();
    return [left + x * k, top + y * k];
  }

  // Zooms by a factor and keeps the place at (x, y) of the canvas.
  zoomBy(factor, x, y) {
    if (!this.frame) return;
    const before = this.toImage(x, y), f = this.frame;
    this.zoom = Math.min(256, Math.max(1, this.zoom * factor));
    const after = this.toImage(x, y);
    this.centre = [this.centre[0] + (before[0] - after[0]) / f.width, this.centre[1] + (before[1] - after[1]) / f.height];
    if (this.zoom === 1) this.centre = [0.5, 0.5];
    this.draw();
    this.onplace?.();
  }
  shift(dx, dy) {
    const k = this.factor();
    this.centre = [this.centre[0] - dx / k / this.frame.width, this.centre[1] - dy / k / this.frame.height];
    this.draw();
    this.onplace?.();
  }

  draw() {
    if (this.pending || !this.frame) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.drawNow(); });
  }

  // The exposure, the view or the range changed: all is developed anew.
  redevelop() {
    this.stale = true;
    if (this.gl) this.layer.stale = this.whole.stale = true;
    this.draw();
  }

  drawNow() {
    if (this.plain) this.plain.canvas.hidden = this.hasGL;
    if (!this.hasGL) return this.plain && this.drawPlain();
    const gl = this.gl, ratio = window.devicePixelRatio || 1, k = this.factor(), [left, top] = this.origin();
    if (this.cropped) this.develop(this.whole);
    this.develop(this.layer);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (this.cropped) this.lay(this.whole, left * ratio, top * ratio, k * ratio, 0.45);
    this.lay(this.layer, left * ratio, top * ratio, k * ratio, 1);
    this.drawn++;
    this.ondraw?.();
  }

  drawPlain() {
    const ratio = window.devicePixelRatio || 1, k = this.factor(), [left, top] = this.origin();
    if (this.stale) this.plain.develop(this.frame, this.cropped, () => this.plainValues());
    this.stale = false;
    this.plain.draw(this.canvas.width, this.canvas.height, left * ratio, top * ratio, k * ratio, this.cropped, this.isSmooth(this.frame, k * ratio));
    this.drawn++;
    this.ondraw?.();
  }

  // How a frame is developed: kind and view of shaders.js.
  look(f) {
    const d = this.display, kind = f.channel === 0 ? 0 : d.kind || 6;
    return [kind, kind === 0 ? d.view : 0];
  }

  plainValues() { return developed(this.frame, this.pixels.data, this.display, ...this.look(this.frame)); }

  // A coarse image and a reduced one are smooth; pixels that are magnified on purpose stay pixels.
  isSmooth(f, k) { return f.format === 0 && (f.scale > 1 || k < 1 || (k < 2 && this.zoom === 1 && k !== 1)); }

  develop(layer) {
    const d = this.display, f = layer.frame;
    if (!f) return;
    const [kind, view] = this.look(f), key = 16 * view + kind;
    if (!this.programs.has(key)) this.programs.set(key, compile(this.gl, develop(view, kind)));
    layer.develop(this.programs.get(key), d);
  }

  // left, top: of the image, k: size of its pixels; all in pixels of the canvas.
  lay(layer, left, top, k, dim) {
    const gl = this.gl, f = layer.frame, w = this.canvas.width / 2, h = this.canvas.height / 2, p = this.laying;
    if (!f) return;
    const x0 = left + f.x0 * k, y0 = top + f.y0 * k, x1 = x0 + f.columns * f.scale * k, y1 = y0 + f.rows * f.scale * k;
    const smooth = this.isSmooth(f, k) ? gl.LINEAR : gl.NEAREST;
    gl.enable(gl.SCISSOR_TEST); // the last pixels of a coarse image reach beyond the image
    gl.scissor(Math.round(left), Math.round(2 * h - top - f.height * k), Math.max(0, Math.round(f.width * k)), Math.max(0, Math.round(f.height * k)));
    gl.useProgram(p.program);
    gl.bindTexture(gl.TEXTURE_2D, layer.shown);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, smooth);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, smooth);
    gl.uniform4f(p.at("place"), x0 / w - 1, 1 - y0 / h, x1 / w - 1, 1 - y1 / h);
    gl.uniform1f(p.at("dim"), dim);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.SCISSOR_TEST);
  }

  // The display values of the frame, 8-bit RGBA, rows from the top: to compare, and for tests.
  values() {
    const gl = this.gl, f = this.frame;
    if (!this.hasGL) return this.plainValues();
    this.develop(this.layer);
    const bytes = new Uint8Array(4 * f.columns * f.rows);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.layer.target);
    gl.readPixels(0, 0, f.columns, f.rows, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return bytes;
  }
}
