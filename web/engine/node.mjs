// engine/node.mjs: the program velo in node: node build/wasm/web/node.mjs render scene.pbrt -o image.png. It sees the machine's
// files. VELO_MEMORY: the MB that it may use.
import { readdirSync } from 'node:fs';
import { Velo } from './velo.mjs';

// Each folder of the root, but for those that the instance has of its own.
const mount = {};
for (const entry of readdirSync('/', { withFileTypes: true }))
  if (entry.isDirectory() && !['dev', 'proc', 'sys'].includes(entry.name)) mount['/' + entry.name] = '/' + entry.name;
const memory = Number(process.env.VELO_MEMORY ?? 4096);
const onText = (line, error) => (error ? process.stderr : process.stdout).write(line + '\n');
const result = await (await Velo.load()).run(process.argv.slice(2), { mount, memory, folder: process.cwd(), onText });
process.exitCode = result.code;
