// commands.mjs FOLDER < LIST: runs commands of velo in node, one after another. LIST is a JSON list of {args, read, memory}; FOLDER
// is the machine's folder in which they run. Prints a JSON line for each: {code, errors, hashes}, with a hash for each file of `read`.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { Velo } from '../../build/wasm/web/velo.mjs';

const folder = process.argv[2];
const velo = await Velo.load();
for (const { args, read = [], memory } of JSON.parse(readFileSync(0, 'utf8'))) {
  const result = await velo.run(args, { mount: { '/host': '/' }, folder: '/host' + folder, memory });
  const hashes = read.map((path) => {
    try {
      return createHash('sha256').update(result.read(path)).digest('hex').slice(0, 16);
    } catch {
      return null;
    }
  });
  process.stdout.write(JSON.stringify({ code: result.code, errors: result.errors, output: result.output, hashes }) + '\n');
}
