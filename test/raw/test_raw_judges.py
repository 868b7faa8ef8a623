#!/usr/bin/python3
"""DNG files of velo in the hands of other programs: dcraw, LibRaw's, RawTherapee, darktable and exiftool, where they are installed; and
velo's development against theirs."""
import functools
import os
import shutil
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../python"))
import cases
from cases import WORK, case, work

numpy = cases.need("numpy")
import velo

WIDTH, HEIGHT, PATCH = 160, 64, 32
BLACK, WHITE = 256, 16000
NM = numpy.arange(360, 831)


def sensitivities():
    """Three bells that overlap, in no relation to the observer's curves."""
    return numpy.array([height * numpy.exp(-((NM - middle) / width) ** 2)
                        for middle, width, height in ((600, 45, 0.9), (535, 50, 1.0), (455, 35, 0.8))])


def chart(pattern, scale=1):
    """Patches of different colours, exact to the last number, as a raw image. scale: of its size."""
    letters = "RGB"
    rows = pattern.split("/")
    raw = velo.Raw(numpy.zeros((scale * HEIGHT, scale * WIDTH), "uint16"), pattern=pattern, bits=14, black=BLACK, white=WHITE, camera="Chart",
                   exposure_time=1 / 250, f_number=4.0, focal_length=0.035, iso=200, gain=0.5, read_noise=3.0)
    raw.match_color(sensitivities())
    colors = numpy.array([[0.05, 0.05, 0.05], [0.4, 0.4, 0.4], [0.5, 0.35, 0.25], [0.2, 0.4, 0.3], [0.25, 0.3, 0.45],
                          [0.8, 0.8, 0.8], [0.1, 0.12, 0.09], [0.5, 0.5, 0.3], [0.3, 0.4, 0.4], [0.45, 0.35, 0.42]])
    numbers = raw.numbers
    for y in range(scale * HEIGHT):
        for x in range(scale * WIDTH):
            k = letters.index(rows[y % len(rows)][x % len(rows[0])])
            patch = y // (scale * PATCH) * (WIDTH // PATCH) + x // (scale * PATCH)
            numbers[y, x] = round(BLACK + colors[patch, k] * raw.neutral[k] * (WHITE - BLACK))
    return raw, colors


def run(*command):
    done = subprocess.run(command, cwd=WORK, capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, (command, done.stderr)
    return done.stdout


def read_tiff(path):
    """A TIFF file of 16-bit values, uncompressed."""
    with open(path, "rb") as file:
        data = file.read()
    order = "<" if data[:2] == b"II" else ">"
    at, = struct.unpack_from(order + "I", data, 4)
    tags = {}
    for i in range(struct.unpack_from(order + "H", data, at)[0]):
        tag, kind, count, value = struct.unpack_from(order + "HHII", data, at + 2 + 12 * i)
        letter = {3: "H", 4: "I"}.get(kind)
        if letter:
            place = at + 10 + 12 * i if count * struct.calcsize(letter) <= 4 else value
            tags[tag] = struct.unpack_from(f"{order}{count}{letter}", data, place)
    (width,), (height,), (samples,) = tags[256], tags[257], tags[277]
    strips = b"".join(data[start:start + size] for start, size in zip(tags[273], tags[279]))
    return numpy.frombuffer(strips, order + "u2", width * height * samples).reshape(height, width, samples)


def middles(image):
    """The mean of each patch's inner pixels."""
    return numpy.array([image[y + 8:y + 24, x + 8:x + 24].mean((0, 1)) for y in range(0, HEIGHT, PATCH)
                        for x in range(0, WIDTH, PATCH)])


def wants(*programs):
    """A case that is skipped where a program is missing, and everywhere where velo lacks libtiff."""
    def decorate(function):
        @case
        @functools.wraps(function)
        def checked():
            for program in programs:
                if not shutil.which(program):
                    raise cases.Skip(f"needs {program}")
            if not has_tiff():
                raise cases.Skip("needs a velo with libtiff")
            function()
        return checked
    return decorate


def has_tiff():
    try:
        velo.Raw(numpy.zeros((2, 2), "uint16")).write(work("tiff.dng"))
    except velo.UnsupportedError:
        return False
    return True


@wants("dcraw")
def dcraw_reads_the_numbers():
    for pattern in ("RG/GB", "BG/GR", "GR/BG", "GB/RG"):
        raw, _ = chart(pattern)
        raw.write(work("chart.dng"))
        run("dcraw", "-D", "-4", "-T", "chart.dng")
        assert (read_tiff(work("chart.tiff"))[..., 0] == raw.numbers).all(), pattern


@wants("dcraw")
def dcraw_gives_the_patches_back():
    for pattern in ("RG/GB", "GB/RG"):
        raw, colors = chart(pattern)
        raw.write(work("chart.dng"))
        run("dcraw", "-4", "-T", "-w", "-q", "0", "-o", "0", "chart.dng")
        worst = abs(middles(read_tiff(work("chart.tiff")) / 65535) - colors).max()
        assert worst < 1e-3, worst


@wants("dcraw")
def dcraw_develops_as_velo():
    raw, _ = chart("RG/GB")
    raw.write(work("chart.dng"))
    run("dcraw", "-4", "-T", "-w", "-q", "0", "-o", "1", "chart.dng")
    theirs = middles(read_tiff(work("chart.tiff")) / 65535)
    own = middles(numpy.asarray(raw.develop("color")))
    worst = abs(theirs - numpy.clip(own, 0, 1)).max()
    assert worst < 1e-3, worst


@wants("dcraw_emu")
def libraw_develops_as_velo():
    raw, _ = chart("BG/GR")
    raw.write(work("chart.dng"))
    subprocess.run(["dcraw_emu", "-4", "-T", "-w", "-q", "0", "-o", "1", "-W", "-c", "0", "chart.dng"], cwd=WORK, check=True,
                   capture_output=True)
    theirs = middles(read_tiff(work("chart.dng.tiff")) / 65535)
    own = middles(numpy.asarray(raw.develop("color")))
    worst = abs(theirs - numpy.clip(own, 0, 1)).max()
    assert worst < 1e-3, worst


def compare_large(pattern, develop, border=0):
    """Patches that a program develops, against velo's. develop(input, output) writes linear values from 0 to 1; border: pixels that it cuts."""
    raw, _ = chart(pattern, 4)
    raw.write(work("large.dng"))
    theirs = numpy.zeros((4 * HEIGHT, 4 * WIDTH, 3))
    linear = develop("large.dng", "large.tif")
    theirs[border:border + linear.shape[0], border:border + linear.shape[1]] = linear
    own = numpy.clip(numpy.asarray(raw.develop("color")), 0, 1)
    worst = abs(middles(theirs[::4, ::4]) - middles(own[::4, ::4])).max()
    assert worst < 1e-3, (pattern, worst)


def run_in_home(*command):
    """For programs that write settings: their home is the test's folder."""
    subprocess.run(command, cwd=WORK, check=True, capture_output=True, env={**os.environ, "HOME": WORK})


@wants("rawtherapee-cli")
def rawtherapee_develops_as_velo():
    with open(work("linear.pp3"), "w") as file:
        file.write("[Version]\nVersion=349\n[Exposure]\nAuto=false\nHistogramMatching=false\nCurve=0;\nCurve2=0;\n"
                   "[HLRecovery]\nEnabled=false\n[White Balance]\nSetting=Camera\n[Color Management]\nInputProfile=(embedded)\n"
                   "ToneCurve=false\nApplyLookTable=false\nWorkingProfile=sRGB\nOutputProfile=RTv4_sRGB\n"
                   "[Sharpening]\nEnabled=false\n[RAW Bayer]\nCcSteps=0\n")

    def develop(source, result):
        run_in_home("rawtherapee-cli", "-q", "-o", work(result), "-p", work("linear.pp3"), "-t", "-b16", "-Y", "-c", work(source))
        value = read_tiff(work(result)) / 65535
        return numpy.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)

    for pattern in ("RG/GB", "BG/GR", "GR/BG", "GB/RG"):
        compare_large(pattern, develop, 4)


@wants("darktable-cli")
def darktable_develops_as_velo():
    def develop(source, result):
        for name in (result, source + ".xmp"):
            if os.path.exists(work(name)):
                os.remove(work(name))
        run_in_home("darktable-cli", source, result, "--icc-type", "LIN_REC709", "--apply-custom-presets", "false", "--core",
                    "--configdir", work("darktable"), "--conf", "plugins/imageio/format/tiff/bpp=16",
                    "--conf", "plugins/imageio/format/tiff/compress=0", "--conf", "plugins/darkroom/workflow=none",
                    "--conf", "plugins/darkroom/chromatic-adaptation=legacy")
        return read_tiff(work(result)) / 65535

    for pattern in ("RG/GB", "BG/GR", "GR/BG", "GB/RG"):
        compare_large(pattern, develop)


@wants("raw-identify")
def libraw_identifies_it():
    chart("GR/BG")[0].write(work("chart.dng"))
    text = run("raw-identify", "-v", "chart.dng")
    for wanted in ("velo Chart", "DNG Version: 1.4.0.0", "ISO speed: 200", "Shutter: 1/250.0", "Aperture: f/4.0",
                   "Focal length: 35.0 mm", "Raw colors: 3", "black: 256", "DNG Illuminant 1: Illuminant A"):
        assert wanted in text, (wanted, text)


@wants("simple_dcraw")
def simple_dcraw_opens_every_pattern():
    for i, pattern in enumerate(("RG/GB", "RRGG/RRGG/GGBB/GGBB", "W")):
        raw = velo.Raw(numpy.full((64, 64), 700, "uint16"), pattern=pattern)
        raw.write(work(f"open{i}.dng"))
        subprocess.run(["simple_dcraw", "-T", f"open{i}.dng"], cwd=WORK, check=True, capture_output=True)
        assert os.path.exists(work(f"open{i}.dng.tiff")), pattern


@wants("exiftool")
def exiftool_has_no_warning():
    for pattern in ("RG/GB", "RRGG/RRGG/GGBB/GGBB", "W"):
        raw = velo.Raw(numpy.full((64, 64), 700, "uint16"), pattern=pattern, exposure_time=1 / 3, f_number=2.8, gain=0.1)
        raw.write(work("plain.dng"))
        assert "Validate" in run("exiftool", "-validate", "-warning", "-error", "-a", "plain.dng")
        assert run("exiftool", "-s3", "-validate", "plain.dng").strip() == "OK", pattern
    chart("RG/GB")[0].write(work("chart.dng"))
    assert run("exiftool", "-s3", "-validate", "chart.dng").strip() == "OK"
    noise = [float(word) for word in run("exiftool", "-s3", "-NoiseProfile", "chart.dng").split()]
    span = WHITE - BLACK
    assert numpy.allclose(noise, [0.5 / span, (1.5 ** 2 + 1 / 12) / span ** 2] * 3, rtol=1e-9, atol=0), noise
    values = run("exiftool", "-s3", "-n", "-ExposureTime", "-FNumber", "-ISO", "-FocalLength", "-CFAPattern2", "chart.dng").split("\n")
    assert [float(v) for v in values[:4]] == [0.004, 4, 200, 35], values


if __name__ == "__main__":
    cases.main()
