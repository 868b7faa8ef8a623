/** Files by absolute path. */
export type Files = Record<string, Uint8Array>;

export interface RunOptions {
  /** files that are there before the command begins */
  files?: Files;
  /** node only: folders of the machine, by the path at which the command sees them */
  mount?: Record<string, string>;
  /** the folder in which the command runs; default "/" */
  folder?: string;
  /** called with each file that is written whole: images, films, also those of a finished pass */
  onWrite?: (path: string, bytes: Uint8Array) => void;
  /** called with each line of text; error: it is a message and no output */
  onText?: (line: string, error: boolean) => void;
  /** MB that the command may use, at most 4096 (default); what needs more ends with velo's error "out of memory" */
  memory?: number;
}

export interface PageOptions extends Omit<RunOptions, 'onWrite'> {
  /** called with each message of docs/view.md, one JSON object */
  onMessage: (text: string) => void;
  /** called with each frame */
  onFrame: (bytes: ArrayBuffer) => void;
}

export interface Page {
  /** A message of docs/view.md, one JSON object. */
  send(text: string): void;
  /** Does a piece of work, such as a pass of the image. Returns whether there may be more before the next message. */
  work(): boolean;
}

export interface Result {
  /** velo's exit code: docs/conventions.md */
  code: number;
  /** all lines of its output */
  output: string;
  /** all its messages */
  errors: string;
  /** reads a file that the command wrote */
  read(path: string): Uint8Array;
}

/** What this browser lacks, as a sentence for its user; null: nothing. */
export function lacks(): string | null;

export class Velo {
  private constructor();
  /** Fetches and compiles the engine. base: the folder of program.js; default: that of this file. */
  static load(base?: string | URL): Promise<Velo>;
  /** Runs a command, such as ["render", "/room.pbrt", "-o", "/room.png"], in an instance of its own. It takes this thread
   * until it ends. */
  run(args: string[], options?: RunOptions): Promise<Result>;
  /** Begins `velo view` with the page as its server, such as ["view", "/room.pbrt"]. It runs when work() is called. */
  page(args: string[], options: PageOptions): Promise<Page>;
}

/** The samples of a .pfm file: rows from the top down, `channels` values per pixel. */
export function pixelsOfPfm(bytes: Uint8Array): { width: number; height: number; channels: 1 | 3; data: Float32Array };
