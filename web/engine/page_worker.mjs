// engine/page_worker.mjs: `velo view` in a worker, for a page. The first message is { args, files }; all others are the texts of
// docs/view.md. It answers with texts and frames (ArrayBuffer), and with { error } when it cannot go on.
import { Velo } from './velo.mjs';

const waiting = []; // messages before the program is there
let page = null;
const turn = new MessageChannel(); // messages that have come are read before the next piece of work
let working = false;

function fail(error) {
  page = null;
  self.postMessage({ error: String(error?.message ?? error) });
}

function go() {
  if (working || !page) return;
  working = true;
  turn.port2.postMessage(0);
}

turn.port1.onmessage = () => {
  working = false;
  try {
    if (page?.work()) go();
  } catch (error) {
    fail(error);
  }
};

async function begin({ args, files }) {
  const encoder = new TextEncoder(), bytes = {};
  for (const [path, text] of Object.entries(files)) bytes[path] = encoder.encode(text);
  const velo = await Velo.load();
  page = await velo.page(args, {
    files: bytes,
    onMessage: (text) => self.postMessage(text),
    onFrame: (buffer) => self.postMessage(buffer, [buffer]),
  });
  for (const text of waiting) page.send(text);
  go();
}

self.onmessage = ({ data }) => {
  if (typeof data !== 'string') begin(data).catch(fail);
  else if (!page) waiting.push(data);
  else {
    try {
      page.send(data);
      go();
    } catch (error) {
      fail(error);
    }
  }
};
