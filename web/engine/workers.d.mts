import type { Files } from './velo.mjs';

export interface WorkerResult {
  /** velo's exit code, its output and its messages, as in velo.d.mts */
  code: number;
  output: string;
  errors: string;
  /** the files of `read` that were written */
  files: Files;
}

export interface RenderOptions {
  /** path of the scene among the files */
  scene: string;
  files: Files;
  spp: number;
  /** further options of velo render, such as ["--resolution", "640x360"] */
  args?: string[];
  /** paths of the images; the suffix chooses the format; default /image.png */
  outputs?: string[];
  /** MB per worker */
  memory?: number;
  /** after each round: the outputs, with `spp` samples per pixel so far */
  onImage?: (files: Files, spp: number) => void;
}

/** What this browser lacks for workers, as a sentence for its user; null: nothing. */
export function lacksWorkers(): string | null;

export class VeloWorkers {
  /** count: default all processors */
  constructor(count?: number, url?: string | URL);
  readonly count: number;
  run(
    index: number,
    args: string[],
    options?: { files?: Files; folder?: string; memory?: number; read?: string[]; onWrite?: (path: string, bytes: Uint8Array) => void },
  ): Promise<WorkerResult>;
  /** The result holds the outputs and /all.film, with the bytes of a single render. */
  render(options: RenderOptions): Promise<WorkerResult>;
  /** Ends all workers, also those that render. */
  close(): void;
}
