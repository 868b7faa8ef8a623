// The connection to velo. It comes back by itself when velo or the network does.
export class Connection {
  // handlers: text(message), frame(buffer), state(connected, reason)
  constructor(handlers) {
    this.handlers = handlers;
    this.wait = 250;
    this.open();
  }

  open() {
    const address = new URL("socket", location.href);
    address.protocol = "ws:";
    this.socket = new WebSocket(address, "velo-view");
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => { this.wait = 250; this.handlers.state(true); };
    this.socket.onmessage = event => {
      if (typeof event.data === "string") this.handlers.text(JSON.parse(event.data));
      else this.handlers.frame(event.data);
    };
    this.socket.onclose = event => this.closed(event.reason);
  }

  async closed(reason) {
    this.handlers.state(false, reason);
    if (!reason && await this.refused()) this.handlers.state(false, "velo runs here with another address: open the one that it printed");
    setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(4000, this.wait * 1.6);
  }

  // Whether another velo has the port, with another token.
  async refused() {
    try {
      return (await fetch(location.href, { cache: "no-store" })).status === 403;
    } catch {
      return false; // nobody is there
    }
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
