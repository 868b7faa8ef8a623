// engine/velo.mjs: runs the program velo, compiled to WebAssembly, in browsers (best in a worker, engine/worker.mjs) and in
// node. Each command has an instance of its own, with files in memory. Types: velo.d.mts. docs/web.md says how to use it.

const inNode = typeof process === 'object' && !!process.versions?.node;

async function fetchBytes(url) {
  if (url.protocol === 'file:') return new Uint8Array(await (await import('node:fs/promises')).readFile(url));
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url.href}: ${response.status} ${response.statusText}`);
  return new Uint8Array(await response.arrayBuffer());
}

async function fetchPacked(url) {
  const bytes = await fetchBytes(url);
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return bytes; // the server has unpacked it
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The words of 32 bits that tools/pack_rgb_table has packed, as bytes. steps: words from one entry to the next, and entries,
// along x, y and z.
function unpackTable(bytes) {
  const steps = [[3, 40], [3 * 40, 40], [3 * 40 * 40, 48]];
  const count = bytes.length / 4;
  const words = new Uint32Array(count);
  for (let i = 0; i < count; i++)
    words[i] = bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24);
  for (const [step, size] of steps)
    for (let i = step; i < count; i++) if (Math.floor(i / step) % size) words[i] += words[i - step];
  return new Uint8Array(words.buffer);
}

// A module with one function that has an instruction on vectors.
const vectors = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];

export function lacks() {
  if (typeof WebAssembly !== 'object') return 'This browser has no WebAssembly; use a current Firefox, Chrome, Edge or Safari.';
  if (!WebAssembly.validate(new Uint8Array(vectors)))
    return "This browser's WebAssembly has no vector instructions (SIMD); use Firefox 89, Chrome 91, Safari 16.4 or newer.";
  if (typeof DecompressionStream !== 'function')
    return 'This browser cannot unpack .gz files; use Firefox 113, Chrome 80, Safari 16.4 or newer.';
  return null;
}

// Memory that may grow up to so many pages of 64 KB; fewer where the browser does not reserve as many addresses.
function makeMemory(pages) {
  for (let maximum = pages; ; maximum = Math.max(1024, maximum >> 1)) {
    try {
      return new WebAssembly.Memory({ initial: 1024, maximum });
    } catch {
      if (maximum === 1024) throw new Error('the browser gives no memory');
    }
  }
}

export class Velo {
  #base;
  #module;
  #create;
  #tables = {};

  // base: URL of the folder that holds program.js, program.wasm.gz and rgb_N.bin.gz.
  static async load(base = new URL('.', import.meta.url)) {
    const missing = lacks();
    if (missing) throw new Error(missing);
    const velo = new Velo();
    velo.#base = new URL(base);
    const [bytes, program] = await Promise.all([
      fetchPacked(new URL('program.wasm.gz', velo.#base)),
      import(new URL('program.js', velo.#base).href),
      velo.#table(0),
    ]);
    velo.#create = globalThis.createVelo ?? program.default;
    velo.#module = await WebAssembly.compile(bytes);
    return velo;
  }

  async #table(space) {
    this.#tables[space] ??= unpackTable(await fetchPacked(new URL(`rgb_${space}.bin.gz`, this.#base)));
  }

  // Does something that may need a table: then it is fetched, and it is done again.
  async #withTables(action) {
    for (;;) {
      try {
        return await action();
      } catch (error) {
        if (typeof error?.rgbTable !== 'number' || this.#tables[error.rgbTable]) throw error;
        await this.#table(error.rgbTable);
      }
    }
  }

  run(args, options = {}) {
    return this.#withTables(() => this.#once(args, options));
  }

  // An instance of the program, with its files; page: see page_calls.js.
  async #instance({ files = {}, mount = {}, folder = '/', memory = 4096 }, print, page) {
    const pages = Math.max(1024, Math.min(65536, Math.floor(memory * 16))); // of 64 KB
    const instance = await this.#create({
      thisProgram: 'velo',
      rgbTables: this.#tables,
      page,
      wasmMemory: makeMemory(pages),
      print: print(0),
      printErr: print(1),
      quit: (status, end) => {
        throw end;
      },
      instantiateWasm: (imports, done) => {
        WebAssembly.instantiate(this.#module, imports).then(done);
        return {};
      },
    });
    const fs = instance.FS;
    for (const [path, target] of Object.entries(mount)) {
      fs.mkdirTree(path);
      fs.mount(instance.NODEFS, { root: target }, path);
    }
    for (const [path, bytes] of Object.entries(files)) {
      const slash = path.lastIndexOf('/');
      if (slash > 0) fs.mkdirTree(path.slice(0, slash));
      fs.writeFile(path, bytes);
    }
    fs.mkdirTree(folder);
    fs.chdir(folder);
    return instance;
  }

  // `velo view` with the page as its server: args as on the command line, options as for run, and onMessage(text), onFrame(buffer).
  // Gives { send(text), work() }: work does a piece of work and tells whether there may be more. docs/view.md has the messages.
  async page(args, { onMessage, onFrame, onText, ...options }) {
    const page = { onText: onMessage, onFrame, message: '' };
    let instance, code, errors;
    const print = (stream) => (line) => {
      if (stream) errors += line + '\n';
      onText?.(line, stream === 1);
    };
    await this.#withTables(async () => {
      errors = '';
      instance = await this.#instance(options, print, page);
      try {
        code = instance.callMain(args) ?? 0;
      } catch (error) {
        if (error?.name !== 'ExitStatus') throw error;
        code = error.status;
      }
    });
    if (code) throw new Error(errors.trim().split('\n').at(-1));
    const send = (text) => {
      page.message = text;
      instance._velo_page_message();
    };
    return { send, work: () => instance._velo_page_work() !== 0 };
  }

  async #once(args, options) {
    const { onWrite, onText } = options;
    const text = ['', ''];
    const print = (stream) => (line) => {
      text[stream] += line + '\n';
      onText?.(line, stream === 1);
    };
    const instance = await this.#instance(options, print);
    const fs = instance.FS;
    if (onWrite) {
      const rename = fs.rename.bind(fs);
      fs.rename = (from, to) => {
        rename(from, to);
        onWrite(to, fs.readFile(to)); // velo writes a temporary file, then renames it
      };
    }
    let code;
    try {
      code = instance.callMain(args);
    } catch (error) {
      if (error?.name === 'ExitStatus') code = error.status;
      else if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) {
        code = 1;
        print(1)(`velo: error: the program ended: ${error.message}`);
      } else throw error;
    } finally {
      if (inNode) process.exitCode = undefined; // emscripten sets it
    }
    return { code, output: text[0], errors: text[1], read: (path) => fs.readFile(path) };
  }
}

// A PFM file's size and samples, rows from the top down as in every other format; three or one channels.
export function pixelsOfPfm(bytes) {
  const lines = [];
  let at = 0;
  while (lines.length < 3) {
    const end = bytes.indexOf(10, at);
    lines.push(String.fromCharCode(...bytes.subarray(at, end)));
    at = end + 1;
  }
  const [width, height] = lines[1].split(' ').map(Number);
  const channels = lines[0] === 'PF' ? 3 : 1;
  const view = new DataView(bytes.buffer, bytes.byteOffset + at);
  const little = Number(lines[2]) < 0;
  const row = width * channels;
  const data = new Float32Array(row * height);
  for (let y = 0; y < height; y++)
    for (let i = 0; i < row; i++) data[y * row + i] = view.getFloat32(4 * ((height - 1 - y) * row + i), little);
  return { width, height, channels, data };
}
