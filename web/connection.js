// The engine that renders what a page shows, behind one small interface. A page names it in <html data-engine>:
//   server   velo view, on this computer or another one (socket.js); the default
//   browser  velo in this page, in WebAssembly (browser_engine.js)
//
//   const engine = await connect({ text(message), frame(buffer), state(connected, reason) });
//   engine.send(message);
//
// Messages and frames are those of docs/view.md, whichever engine it is. state(false, reason): the engine is away.
export const engineName = () => document.documentElement.dataset.engine ?? "server";

const MODULES = { server: "./socket.js", browser: "./browser_engine.js" };

export async function connect(handlers) {
  const { Connection } = await import(MODULES[engineName()]);
  return new Connection(handlers);
}
