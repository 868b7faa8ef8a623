// engine/workers.mjs: velo in web workers. Each worker renders samples of its own; the films merge exactly, so that the image
// has the bytes of a single render. No shared memory: the page needs no special headers.

// What this browser lacks for workers, as lacks() of velo.mjs: those without workers of modules do not read the option.
export function lacksWorkers() {
  let read = false;
  const options = {
    get type() {
      read = true;
      return 'module';
    },
  };
  if (typeof Worker === 'function') new Worker('data:text/javascript,', options).terminate();
  return read ? null : 'This browser has no workers of modules; use Firefox 114, Chrome 80, Safari 15 or newer.';
}

export class VeloWorkers {
  #workers = [];
  #waiting = new Map();
  #next = 0;

  constructor(count = navigator.hardwareConcurrency ?? 1, url = new URL('worker.mjs', import.meta.url)) {
    for (let i = 0; i < count; i++) {
      const worker = new Worker(url, { type: 'module' });
      worker.onmessage = ({ data }) => this.#answer(data);
      worker.onerror = (event) => this.#fail(worker, event.message || 'the worker ended');
      this.#workers.push(worker);
    }
  }

  get count() {
    return this.#workers.length;
  }

  #answer({ id, write, result, error }) {
    const call = this.#waiting.get(id);
    if (!call) return;
    if (write) return call.onWrite?.(...write);
    this.#waiting.delete(id);
    if (error !== undefined) call.reject(new Error(error));
    else call.resolve(result);
  }

  #fail(worker, message) {
    for (const [id, call] of this.#waiting)
      if (call.worker === worker) {
        this.#waiting.delete(id);
        call.reject(new Error(message));
      }
  }

  // A command in worker `index`; read: paths of files that the result shall hold.
  run(index, args, { read = [], onWrite, ...options } = {}) {
    const id = this.#next++;
    const worker = this.#workers[index];
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject, onWrite, worker });
      worker.postMessage({ id, args, options, read });
    });
  }

  // Renders a scene in rounds: 1 sample per worker, then twice as many each time. onImage gets the outputs after each round.
  async render({ scene, files, spp, args = [], outputs = ['/image.png'], memory, onImage }) {
    const names = outputs.flatMap((name) => ['-o', name]);
    let film = null;
    let done = 0;
    while (done < spp) {
      const end = Math.min(spp, done === 0 ? this.count : 3 * done);
      const size = Math.ceil((end - done) / this.count);
      const parts = [];
      for (let from = done, i = 0; from < end; from += size, i++) {
        const range = `${from}:${Math.min(from + size, end)}`;
        const all = ['render', scene, ...args, '--spp', String(spp), '--samples', range, '--film', '/part.film', '--quiet', '--threads', '1'];
        parts.push(this.run(i, all, { files, memory, read: ['/part.film'] }));
      }
      const films = film ? { '/0.film': film } : {};
      for (const [i, part] of (await Promise.all(parts)).entries()) {
        if (part.code !== 0) return part;
        films[`/${i + 1}.film`] = part.files['/part.film'];
      }
      const merged = await this.run(0, ['film', 'merge', ...Object.keys(films), '-o', '/all.film'], { files: films, read: ['/all.film'] });
      if (merged.code !== 0) return merged;
      film = merged.files['/all.film'];
      done = end;
      const image = await this.run(0, ['film', 'develop', '/all.film', ...names], { files: { '/all.film': film }, read: outputs });
      if (image.code !== 0) return image;
      onImage?.(image.files, done);
      if (done === spp) return { ...image, files: { ...image.files, '/all.film': film } };
    }
    return { code: 2, output: '', errors: 'velo: error: no samples', files: {} };
  }

  close() {
    for (const worker of this.#workers) {
      worker.terminate();
      this.#fail(worker, 'closed');
    }
  }
}
