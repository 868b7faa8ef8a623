"""python3 -m velo.dataset RECIPE -o FOLDER: makes a dataset from a recipe in YAML or JSON (docs/datasets.md)."""
from __future__ import annotations

import argparse
import re
import sys
from typing import Optional, Sequence

import velo
from velo._errors import wrong_value
from velo.dataset.generate import WRITERS, generate
from velo.dataset.recipe import read_recipe


def frame_numbers(text: Optional[str], shard: Optional[str], count: int) -> range:
    """The frames of --frames A-B[:STEP] and --shard I/N."""
    numbers = range(count)
    if text is not None:
        match = re.fullmatch(r"([0-9]{1,9})(?:(?:-|\.\.)([0-9]{1,9}))?(?::([0-9]{1,9}))?", text)
        if not match:
            raise wrong_value("--frames", "A-B, A-B:STEP or A, numbers from 0", text)
        first, last, step = int(match[1]), int(match[2] or match[1]), int(match[3] or 1)
        if first > last or last >= count or step < 1:
            raise wrong_value("--frames", f"numbers from 0 to {count - 1}, the lower one first, with a step from 1", text)
        numbers = range(first, last + 1, step)
    if shard is not None:
        match = re.fullmatch(r"([0-9]{1,9})/([0-9]{1,9})", shard)
        if not match or not 1 <= int(match[1]) <= int(match[2]):
            raise wrong_value("--shard", "I/N with I from 1 to N", shard)
        numbers = numbers[int(match[1]) - 1::int(match[2])]
    return numbers


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m velo.dataset", description=__doc__)
    parser.add_argument("recipe", help="the recipe, YAML or JSON")
    parser.add_argument("-o", "--output", required=True, metavar="FOLDER", help="where the dataset is written")
    parser.add_argument("--writers", default="bop", help="formats, separated by commas: %s (default: bop)" % ", ".join(sorted(WRITERS)))
    parser.add_argument("--frames", metavar="A-B[:STEP]", help="only frames A to B, with STEP every STEP-th; the first is 0")
    parser.add_argument("--shard", metavar="I/N", help="part I of N (I from 1): every N-th of the frames")
    parser.add_argument("--threads", type=int, metavar="N", help="number of worker threads (default: the processors)")
    parser.add_argument("--quiet", action="store_true", help="no line for each frame")
    options = parser.parse_args(arguments)
    try:
        if options.threads is not None:
            velo.set_threads(options.threads)
        recipe = read_recipe(options.recipe)
        frames = frame_numbers(options.frames, options.shard, recipe.frames)
        generate(recipe, options.output, writers=options.writers.split(","), frames=frames,
                 progress=None if options.quiet else lambda number: print(f"frame {number}", flush=True))
    except velo.Error as error:
        print(f"velo.dataset: {error}", file=sys.stderr)
        return error.code
    except MemoryError:
        print("velo.dataset: out of memory", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    except OSError as error:
        print(f"velo.dataset: {error}", file=sys.stderr)
        return 4 if isinstance(error, FileNotFoundError) else 5
    return 0


if __name__ == "__main__":
    sys.exit(main())
