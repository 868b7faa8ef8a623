#!/usr/bin/python3
"""What --noise promises and what it costs: of each scene, the share of blocks whose true error is below the threshold,
the samples against a perfect stop, and the bias of the image's mean.
Usage: script/bench noise NAME=FILE[@WxH]... [--noise PERCENT] [--reference SPP] [--seeds N] [--json FILE]
The true error of a block is the root mean square difference of its display values (sRGB) from those of a render of
--reference samples with another seed. A perfect stop renders each block to the first number of samples (8, 12, 16, 24,
...) at which its true error is below the threshold, and at most to half of the reference's. Shares and samples are
means over --seeds seeds. The bias is the mean of the adaptive images of all seeds over the mean of the reference, with a
standard error from the spread of the seeds. It counts the pixels that are below white in the
reference, as their neighbours are: the display does not show the noise of brighter ones, so --noise does not bound it,
and the edges of lamps can have a hundred times the light of all other pixels. Needs numpy."""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

import numpy

VELO = os.environ["VELO"]
BLOCK = 32


def velo(*words):
    done = subprocess.run([VELO] + list(words), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit("noise: failed: velo %s\n%s" % (" ".join(words), done.stderr))
    return done.stdout


def read(path):
    """A linear image from the top."""
    with open(path, "rb") as file:
        file.readline()
        width, height = map(int, file.readline().split())
        file.readline()
        return numpy.frombuffer(file.read(), "<f4").reshape(height, width, 3)[::-1].astype(float)


def display(linear):
    x = numpy.clip(linear, 0, 1)
    return numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * numpy.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def blocks(image, reference):
    """The error of each block, row by row."""
    squares = ((display(image) - display(reference)) ** 2).mean(axis=2)
    height, width = squares.shape
    return numpy.array([[numpy.sqrt(squares[y:y + BLOCK, x:x + BLOCK].mean()) for x in range(0, width, BLOCK)]
                        for y in range(0, height, BLOCK)])


def below_white(reference):
    """True for the pixels that are below white, as all their neighbours are."""
    most = numpy.pad(reference.max(axis=2), 1, mode="edge")
    return numpy.lib.stride_tricks.sliding_window_view(most, (3, 3)).max(axis=(2, 3)) < 1


def samples(film, shape):
    """The number of samples of each block."""
    counts = numpy.zeros(shape)
    for line in velo("film", "info", film).splitlines():
        found = re.match(r" *samples *0:(\d+)(?: of \d+)?(?:, pixels (\d+),(\d+),(\d+),(\d+))?", line)
        if found and found.group(2) is None:
            counts[:] = int(found.group(1))
        elif found:
            n, x0, y0, x1, y1 = map(int, found.groups())
            counts[y0 // BLOCK:-(-y1 // BLOCK), x0 // BLOCK:-(-x1 // BLOCK)] = n
    return counts


def schedule(first, most):
    n = first
    while n <= most:
        yield n
        n = n * 3 // 2 if n & (n - 1) == 0 else n * 4 // 3


def perfect_samples(base, reference, threshold, most, folder):
    """The samples of each block if it stopped as soon as its true error is below the threshold. All blocks are rendered
    to 128 samples, then those that are still above it one by one."""
    film, image = os.path.join(folder, "perfect.film"), os.path.join(folder, "perfect.pfm")
    perfect = numpy.full(blocks(reference, reference).shape, numpy.inf)
    for n in schedule(8, 128):
        velo(*(base + ["--spp", "8", "--overwrite", "--film", film] if n == 8 else
               ["render", "--continue", film, "--quiet", "--spp", str(n)]), "-o", image)
        perfect[(blocks(read(image), reference) < threshold) & numpy.isinf(perfect)] = n
    for row, column in numpy.argwhere(numpy.isinf(perfect)):
        x, y = int(column) * BLOCK, int(row) * BLOCK
        part = reference[y:y + BLOCK, x:x + BLOCK]
        crop = "%d,%d,%d,%d" % (x, y, x + part.shape[1], y + part.shape[0])
        for n in schedule(192, most):
            velo(*(base + ["--spp", "192", "--crop", crop, "--overwrite", "--film", film] if n == 192 else
                   ["render", "--continue", film, "--quiet", "--spp", str(n)]), "-o", image)
            perfect[row, column] = n
            if blocks(read(image), part)[0, 0] < threshold:
                break
    return perfect


def measure(name, scene, size, options, folder):
    threshold = options.noise / 100
    path = lambda end: os.path.join(folder, name + end)
    base = ["render", scene, "--quiet", "--exposure", "0"] + (["--resolution", size] if size else [])
    velo(*base, "--seed", "977", "--spp", str(options.reference), "-o", path("-reference.pfm"))
    reference = read(path("-reference.pfm"))
    counted = below_white(reference)
    means, below, counts, perfect = [], [], [], []
    for seed in range(options.seeds):
        film, image = path("-%d.film" % seed), path("-%d.pfm" % seed)
        velo(*base, "--seed", str(seed), "--noise", "%g%%" % options.noise, "--overwrite", "--film", film, "-o", image)
        means.append(read(image)[counted].mean() / reference[counted].mean())
        errors = blocks(read(image), reference)
        below.append((errors < threshold).mean())
        counts.append(samples(film, errors.shape))
        perfect.append(perfect_samples(base + ["--seed", str(seed)], reference, threshold, options.reference // 2, folder))
    counts, perfect = numpy.array(counts), numpy.array(perfect)
    return {"scene": name, "noise": threshold, "blocks": errors.size * options.seeds,
            "below": float(numpy.mean(below)), "counted": float(counted.mean()),
            "mean_spp": float(counts.mean()), "most_spp": int(counts.max()), "perfect_spp": float(perfect.mean()),
            "over_perfect": float(counts.mean() / perfect.mean()), "mean_ratio": float(numpy.mean(means)),
            "mean_ratio_error": float(numpy.std(means, ddof=1) / len(means) ** 0.5) if len(means) > 1 else None}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", metavar="NAME=FILE[@WxH]")
    parser.add_argument("--noise", type=float, default=2)
    parser.add_argument("--reference", type=int, default=4096)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--json", default=os.path.join(os.environ["VELO_SOURCE_DIR"], "bench/results/noise.json"))
    options = parser.parse_args()
    results = []
    for word in options.scenes:
        found = re.match(r"([^=]+)=(.+?)(?:@(\d+x\d+))?$", word)
        if not found:
            sys.exit("noise: %s: must be NAME=FILE[@WxH]" % word)
        with tempfile.TemporaryDirectory() as folder:
            results.append(measure(*found.groups(), options, folder))
        r = results[-1]
        print("%-20s %d blocks, %.1f %% below %g %%, %.1f spp, perfect %.1f: %.2f, mean %.5f +- %.5f" %
              (r["scene"], r["blocks"], 100 * r["below"], options.noise, r["mean_spp"], r["perfect_spp"], r["over_perfect"],
               r["mean_ratio"], r["mean_ratio_error"] or 0), flush=True)
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main()
