// Numbers of gestures: the edits of one gesture are one step of undo. next(): a gesture begins. burst(kind): one goes on, such as the
// turns of a wheel, until they pause or another gesture begins. end(): what goes on is over, and its further edits have no effect:
// an undo in the midst of a drag stays.
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

  end() { this.last = this.next(); }
  isOver(number) { return number > 0 && number <= this.last; }
}
