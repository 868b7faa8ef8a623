// Numbers of gestures: the edits of one gesture are one step of undo. next(): a gesture begins. burst(kind): one goes on, such as the
// turns of a wheel, until they pause or another gesture begins.
export class Gestures {
  constructor() {
    this.number = Math.floor(Math.random() * 2 ** 30); // a page that takes over goes on with no gesture of the one before
  }

  next() {
    clearTimeout(this.timer);
    this.kind = null;
    return ++this.number;
  }

  burst(kind, milliseconds) {
    const number = this.kind === kind ? this.number : this.next();
    this.kind = kind;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { this.kind = null; }, milliseconds);
    return number;
  }
}
