// engine/worker.mjs: runs commands of velo in a worker, for engine/workers.mjs. A message {id, args, options, read} is answered
// by {id, write: [path, bytes]} for each file written, and in the end by {id, result} or {id, error}.
import { Velo } from './velo.mjs';

const velo = Velo.load();
velo.catch(() => {}); // reported by the first command

self.onmessage = async ({ data: { id, args, options, read } }) => {
  try {
    const onWrite = (path, bytes) => self.postMessage({ id, write: [path, bytes] });
    const result = await (await velo).run(args, { ...options, onWrite });
    const files = {};
    for (const path of read) {
      try {
        files[path] = result.read(path);
      } catch {} // it was not written; the code says why
    }
    self.postMessage({ id, result: { code: result.code, output: result.output, errors: result.errors, files } });
  } catch (error) {
    self.postMessage({ id, error: String(error?.message ?? error) });
  }
};
