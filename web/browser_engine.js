// velo in this page, in WebAssembly, behind the interface of connection.js. The page's <html> has the command in data-command,
// such as "view --lecture --quiet", and in data-files the address of a JSON object of its files, text by absolute path.
export class Connection {
  constructor(handlers) {
    this.handlers = handlers;
    const { command, files } = document.documentElement.dataset;
    this.worker = new Worker(new URL("engine/page_worker.mjs", import.meta.url), { type: "module" });
    this.worker.onmessage = ({ data }) => this.receive(data);
    this.worker.onerror = (event) => this.end(event.message || "the worker ended");
    this.begin(command.split(" "), files).catch((error) => this.end(error.message));
  }

  async begin(args, address) {
    const answer = await fetch(address);
    if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
    this.worker.postMessage({ args, files: await answer.json() });
    this.handlers.state(true);
  }

  receive(data) {
    if (typeof data === "string") this.handlers.text(JSON.parse(data));
    else if (data instanceof ArrayBuffer) this.handlers.frame(data);
    else this.end(data.error);
  }

  end(reason) {
    this.worker.terminate();
    this.handlers.state(false, reason);
  }

  send(message) {
    this.worker.postMessage(JSON.stringify(message));
  }
}
