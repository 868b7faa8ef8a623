#!/usr/bin/python3
"""How much the denoised frames of an animation flicker where its camera and a surface rest.
Usage: script/bench flicker MODEL [--animate T0:T1] [--fps N] [--spp N] [--reference SPP] [--options "..."]
Three series of frames: denoised with the frames before them (--denoise), denoised one by one, and of --reference samples,
denoised one by one. Flicker is the mean absolute difference of display values (sRGB) of a pixel from the frame before, over
the pixels that show the same point in both frames, as their neighbours do. In still parts it is below 0.002 in the
reference. Beyond the reference: the same of the difference's difference from the reference's. relMSE: against the
reference's frame, without the worst 0.1 % of pixels. All are means over the frames that have five before them, and relative
to frames that are denoised one by one. Needs numpy."""
import argparse
import os
import subprocess
import sys
import tempfile

import numpy

VELO = os.environ["VELO"]
BEFORE, STILL = 5, 0.002


def velo(*words):
    done = subprocess.run([VELO] + list(words), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit("flicker: failed: velo %s\n%s" % (" ".join(words), done.stderr))


def read(path):
    """The values of a PFM file, from the top: height x width x channels."""
    with open(path, "rb") as file:
        channels = 3 if file.readline().strip() == b"PF" else 1
        width, height = map(int, file.readline().split())
        file.readline()
        return numpy.frombuffer(file.read(), "<f4").reshape(height, width, channels)[::-1].astype(float)


def display(linear):
    x = numpy.clip(linear, 0, 1)
    return numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * numpy.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def positions(image, folder):
    made = os.path.join(folder, "position.pfm")
    planes = []
    for axis in "XYZ":
        velo("image", "convert", image, made, "--channel", "P." + axis)
        planes.append(read(made))
    return numpy.concatenate(planes, axis=2)


def rests(a, b):
    """True for the pixels that show the same point in both frames, as their neighbours do."""
    same = numpy.abs(a - b).max(axis=2) <= 1e-6 * (1 + numpy.abs(a).max(axis=2))
    around = numpy.pad(same, 1, mode="edge")
    return numpy.lib.stride_tricks.sliding_window_view(around, (3, 3)).all(axis=(2, 3))


def trimmed(image, reference):
    error = numpy.sort(((image - reference) ** 2 / (reference ** 2 + 0.01)).mean(axis=2).ravel())
    return error[:error.size - (error.size + 999) // 1000].mean()


def render(options, folder):
    """The frames of the three series, and the points that the pixels show."""
    path = lambda name: os.path.join(folder, name)
    base = ["render", options.model, "--quiet", "--exposure", "0", "--animate", options.animate, "--fps", options.fps]
    base += options.options.split()
    channels = "error,features"
    velo(*base, "--spp", options.spp, "--channels", channels + ",P", "-o", path("raw%d.exr"), "--denoise", path("steady%d.pfm"))
    velo(*base, "--spp", options.reference, "--channels", channels, "-o", path("many%d.exr"))
    count = sum(name.startswith("many") for name in os.listdir(folder))
    series = {"steady": [], "single": [], "reference": []}
    points = []
    for i in range(count):
        for name, source in (("single", "raw"), ("reference", "many")):
            velo("image", "denoise", path("%s%d.exr" % (source, i)), "-o", path("%s%d.pfm" % (name, i)))
        for name, frames in series.items():
            frames.append(read(path("%s%d.pfm" % (name, i))))
        points.append(positions(path("raw%d.exr" % i), folder))
    return series, points


def measure(series, points):
    """For each series: flicker in still parts, beyond the reference there, of all that rests, and relMSE."""
    shown = {name: [display(frame) for frame in frames] for name, frames in series.items()}
    sums = {name: numpy.zeros(4) for name in series}
    for i in range(BEFORE + 1, len(points)):
        rest = rests(points[i], points[i - 1])
        true = shown["reference"][i] - shown["reference"][i - 1]
        still = rest & (numpy.abs(true).mean(axis=2) < STILL)
        for name, frames in shown.items():
            change = frames[i] - frames[i - 1]
            size, beyond = numpy.abs(change).mean(axis=2), numpy.abs(change - true).mean(axis=2)
            sums[name] += (size[still].mean(), beyond[still].mean(), size[rest].mean(),
                           trimmed(series[name][i], series["reference"][i]))
    return sums


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("model")
    parser.add_argument("--animate", default="0.5:1.5")
    parser.add_argument("--fps", default="24")
    parser.add_argument("--spp", default="8")
    parser.add_argument("--reference", default="256")
    parser.add_argument("--options", default="--ground --resolution 240x135")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        series, points = render(options, folder)
    if len(points) < BEFORE + 2:
        sys.exit("flicker: %d frames are too few; at least %d" % (len(points), BEFORE + 2))
    sums = measure(series, points)
    frames = len(points) - BEFORE - 1
    print("%-10s %12s %10s %10s %10s %10s" % ("", "still", "relative", "beyond", "all", "relMSE"))
    for name, sum_of in sums.items():
        ratio = sum_of / sums["single"]
        print("%-10s %12.6f %10.3f %10.3f %10.3f %10.3f" % (name, sum_of[0] / frames, *ratio))


if __name__ == "__main__":
    main()
