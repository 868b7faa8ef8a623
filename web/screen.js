// The canvas: shows a frame through WebGL2, whole or zoomed in.
import { fragment, vertex } from "./shaders.js";
import { Pixels } from "./frame.js";

function compile(gl) {
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
  return program;
}

// A texture that takes the tiles of frames.
class Layer {
  constructor(gl) {
    this.gl = gl;
    this.frame = null;
  }

  take(frame, fits) {
    const gl = this.gl, n = frame.channels - 1, half = frame.format === 0;
    const format = [gl.RED, gl.RG, gl.RGB][n], type = half ? gl.HALF_FLOAT : gl.FLOAT;
    const internal = half ? [gl.R16F, gl.RG16F, gl.RGB16F][n] : [gl.R32F, gl.RG32F, gl.RGB32F][n];
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    if (!this.texture || !fits) {
      if (this.texture) gl.deleteTexture(this.texture);
      this.texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, this.texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, internal, frame.columns, frame.rows);
      for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
    }
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    for (const t of frame.tiles) gl.texSubImage2D(gl.TEXTURE_2D, 0, t.x, t.y, t.w, t.h, format, type, t.pixels);
    this.frame = frame;
  }
}

export class Screen {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = this.gl = canvas.getContext("webgl2", { antialias: false, alpha: true, preserveDrawingBuffer: false });
    if (!gl) throw new Error("this browser has no WebGL2");
    this.program = compile(gl);
    this.pixels = new Pixels();
    this.layer = new Layer(gl);      // the present frame
    this.whole = new Layer(gl);      // the last frame of the whole image, behind a rectangle
    this.display = { exposure: 0, view: 0, kind: 0, low: [0, 0, 0], high: [1, 1, 1] };
    this.zoom = 1;                   // 1: the whole image fits
    this.centre = [0.5, 0.5];        // place of the image in the middle of the stage
    this.drawn = 0;
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  get frame() { return this.pixels.frame; }

  take(frame) {
    const fits = this.pixels.fits(frame);
    const isWhole = frame.columns * frame.scale >= frame.width && frame.rows * frame.scale >= frame.height;
    if (!isWhole && this.layer.frame && !fits && !this.cropped) [this.layer, this.whole] = [this.whole, this.layer];
    this.cropped = !isWhole;
    this.layer.take(frame, fits && this.layer.frame !== null);
    this.pixels.take(frame);
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

  drawNow() {
    const gl = this.gl, ratio = window.devicePixelRatio || 1, k = this.factor(), [left, top] = this.origin(), f = this.frame;
    const w = this.canvas.width / 2, h = this.canvas.height / 2;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const place = [left * ratio / w - 1, 1 - top * ratio / h, (left + f.width * k) * ratio / w - 1, 1 - (top + f.height * k) * ratio / h];
    if (this.cropped && this.whole.frame) this.drawLayer(this.whole, place, 1 / (k * ratio), 0.45);
    this.drawLayer(this.layer, place, 1 / (k * ratio), 1);
    this.drawn++;
    this.ondraw?.();
  }

  drawLayer(layer, place, taps, dim) {
    const gl = this.gl, f = layer.frame, d = this.display, p = this.program, at = name => gl.getUniformLocation(p, name);
    if (!f) return;
    gl.useProgram(p);
    gl.bindTexture(gl.TEXTURE_2D, layer.texture);
    gl.uniform4fv(at("place"), place);
    gl.uniform2f(at("size"), f.width, f.height);
    gl.uniform4f(at("window"), f.x0, f.y0, f.scale, 0);
    gl.uniform1f(at("exposure"), 2 ** d.exposure);
    gl.uniform1i(at("view"), d.view);
    gl.uniform1i(at("kind"), f.channel === 0 ? 0 : d.kind);
    gl.uniform3fv(at("low"), d.low);
    gl.uniform3fv(at("high"), d.high);
    gl.uniform1f(at("taps"), Math.abs(taps - 1) < 1e-3 ? 1 : taps);
    gl.uniform1f(at("dim"), dim);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  // The display values of the whole frame, 8-bit RGBA, rows from the top: for a copy, and for tests.
  values() {
    const gl = this.gl, f = this.frame, target = gl.createFramebuffer(), texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, f.width, f.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, f.width, f.height);
    this.drawLayer(this.layer, [-1, -1, 1, 1], 1, 1);
    const bytes = new Uint8Array(4 * f.width * f.height);
    gl.readPixels(0, 0, f.width, f.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(target);
    gl.deleteTexture(texture);
    this.draw();
    return bytes;
  }
}
