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
    this.#tables[space] ??= await fetchPacked(new URL(`rgb_${space}.bin.gz`, this.#base));
  }

  async run(args, options = {}) {
    for (;;) {
      try {
        return await this.#once(args, options);
      } catch (error) {
        if (typeof error?.rgbTable !== 'number' || this.#tables[error.rgbTable]) throw error;
        await this.#table(error.rgbTable); // the scene needs it: again, with it
      }
    }
  }

  async #once(args, { files = {}, mount = {}, folder = '/', onWrite, onText, memory = 4096 }) {
    const text = ['', ''];
    const print = (stream) => (line) => {
      text[stream] += line + '\n';
      onText?.(line, stream === 1);
    };
    const pages = Math.max(1024, Math.min(65536, Math.floor(memory * 16))); // of 64 KB
    const instance = await this.#create({
      thisProgram: 'velo',
      rgbTables: this.#tables,
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
