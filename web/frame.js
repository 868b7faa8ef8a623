// Frames as velo sends them (docs/view.md): a header, then tiles. Keeps the pixels of the frame that is shown.
import { fromHalf } from "./half.js";

const names = ["type", "serial", "change", "width", "height", "x0", "y0", "scale", "columns", "rows", "format",
  "channels", "channel", "spp", "tileCount", "denoised"];

// The header and the tiles; the tiles' pixels are views of the buffer.
export function parseFrame(buffer) {
  const header = new Uint32Array(buffer, 0, 16), frame = { tiles: [] };
  names.forEach((name, i) => { frame[name] = header[i]; });
  const Kind = frame.format === 0 ? Uint16Array : Float32Array;
  let at = 64;
  for (let i = 0; i < frame.tileCount; i++) {
    const [x, y, w, h] = new Uint16Array(buffer, at, 4), count = w * h * frame.channels;
    frame.tiles.push({ x, y, w, h, pixels: new Kind(buffer, at + 8, count) });
    at += 8 + Math.ceil(count * Kind.BYTES_PER_ELEMENT / 4) * 4;
  }
  return frame;
}

// The pixels of a frame, kept up to date by tiles.
export class Pixels {
  // Whether the frame has the form of the pixels that are kept.
  fits(frame) {
    const f = this.frame;
    return f && ["width", "height", "x0", "y0", "scale", "columns", "rows", "format", "channels", "channel"]
      .every(name => f[name] === frame[name]);
  }

  take(frame) {
    if (!this.fits(frame)) {
      const Kind = frame.format === 0 ? Uint16Array : Float32Array;
      this.data = new Kind(frame.columns * frame.rows * frame.channels);
    }
    this.frame = frame;
    for (const t of frame.tiles) {
      if (t.w === frame.columns && t.h === frame.rows) { this.data.set(t.pixels); continue; }
      const n = t.w * frame.channels;
      for (let y = 0; y < t.h; y++)
        this.data.set(t.pixels.subarray(y * n, (y + 1) * n), ((t.y + y) * frame.columns + t.x) * frame.channels);
    }
  }

  // The numbers of a pixel of the image; null outside the frame.
  at(x, y) {
    const f = this.frame;
    if (!f || x < 0 || y < 0) return null;
    const i = Math.floor((x - f.x0) / f.scale), j = Math.floor((y - f.y0) / f.scale);
    if (i < 0 || j < 0 || i >= f.columns || j >= f.rows || x >= f.width || y >= f.height) return null;
    const start = (j * f.columns + i) * f.channels, values = [];
    for (let c = 0; c < f.channels; c++) {
      const v = this.data[start + c];
      values.push(f.format === 0 ? fromHalf[v] : v);
    }
    return values;
  }
}
