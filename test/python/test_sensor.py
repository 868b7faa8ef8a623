#!/usr/bin/python3
"""velo.Sensor: exposures of a spectrum; numbers by keywords; errors by name; and the frames of `velo sensor verify`, whose
gain is computed here again from the files that EMVA's program reads."""
import math
import os
import subprocess
import tempfile

import cases
from cases import VELO, case, raises

numpy = cases.need("numpy")
import velo

PIXELS = numpy.full((64, 80, 2), 2.0, dtype=numpy.float32)


def image():
    return velo.Image(PIXELS, ["S0.450nm", "S0.550nm"], encoding="linear")


def expose(**more):
    sensor = velo.Sensor("ideal", pixel=3, black_level=100)
    return sensor.expose(image(), exposure_time=0.02, f_number=2.0, radiance=1e-4, seed=5, **more)


@case
def mean_and_variance_are_those_of_the_photons():
    exposure = expose()
    numbers = numpy.asarray(exposure.numbers).astype(float)[..., 0] - 100
    energy = math.pi * 2e-4 / 16 * 9e-12 * 0.02
    expected = energy * 1e-9 * (600**2 - 400**2) / 2 / (6.62607015e-34 * 299792458.0)
    assert abs(numbers.mean() - expected) < 5 * math.sqrt(expected / numbers.size)
    assert abs(numbers.var() / expected - 1) < 5 * math.sqrt(2 / numbers.size)
    assert numpy.asarray(exposure.numbers).dtype == numpy.uint16
    assert abs(float(numpy.asarray(exposure.electrons).astype(float).mean()) - numbers.mean()) < 1e-3
    assert exposure.film_noise is None and exposure.full == 0


@case
def frames_repeat_and_differ():
    first, again, other = (numpy.asarray(e.numbers) for e in (expose(), expose(), expose(frame=1)))
    assert (first == again).all()
    assert (first != other).any()


@case
def crops_are_parts_of_the_whole():
    """Mosaic, noise and falloff: those of the pixels in the whole image."""
    scene = velo.Scene()
    scene.camera = velo.Camera(40, 30, fov=0.8)
    scene.add_light("infinite", color=(50, 50, 50))
    sensor = velo.Sensor("generic_rggb", row_noise=2, column_noise=2, dsnu=3)
    frames = []
    for crop in (None, (7, 5, 30, 22)):
        scene.render(crop=crop, spp=4, buckets=8, filter="box")
        frames.append(sensor.expose(scene.film.spectrum(), focal_length=0.1))
    whole, part = frames
    assert (numpy.asarray(part.numbers) == numpy.asarray(whole.numbers)[5:22, 7:30]).all()
    assert part.raw().pattern == "BG/GR" and whole.raw().pattern == "RG/GB"


@case
def numbers_and_presets():
    assert velo.Sensor("ideal", pixel=3).numbers["pixel"] == 3
    assert velo.Sensor().numbers["pattern"] == "W"
    assert velo.Sensor("generic_rggb", pattern="bggr").numbers["pattern"] == "BG/GR"
    assert "RG/GB" in repr(velo.Sensor("generic_rggb"))
    assert {"ideal", "generic_mono", "canon_eos_5d"} <= set(velo.sensor_presets())


@case
def sensor_files():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "own.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write("bits: 8 bits\nread_noise: 3 e-\n")
        assert velo.Sensor(path).numbers["bits"] == 8
        with open(path, "w", encoding="utf-8") as file:
            file.write("read_noise: 3 e-\nbits: 18 bits\n")
        with raises(velo.SceneError, ":2:7: bits must be a whole number from 1 to 16"):
            velo.Sensor(path)
    with raises(velo.MissingFileError):
        velo.Sensor("none.yaml")


@case
def wrong_values_are_refused():
    with raises(velo.UsageError, 'the nearest is "generic_mono"'):
        velo.Sensor("generic_mon")
    with raises(velo.UsageError, "read_noise"):
        velo.Sensor("ideal", read_nose=3)
    with raises(velo.UsageError, "full_well must be"):
        velo.Sensor("ideal", full_well=0)
    with raises(velo.UsageError, "read_noise must be"):
        velo.Sensor("ideal", read_noise=math.nan)
    with raises(velo.UsageError, "pattern"):
        velo.Sensor("ideal", pattern=3)
    with raises(velo.UsageError, "sensor"):
        velo.Sensor(3)
    with raises(velo.UsageError, "exposure_time must be"):
        velo.Sensor().expose(image(), exposure_time=-1)
    with raises(velo.UsageError, "exposure_time"):
        velo.Sensor().expose(image(), exposure_tim=1)
    with raises(velo.UsageError, "image"):
        velo.Sensor().expose(PIXELS)
    with raises(velo.UsageError, "no spectrum"):
        velo.Sensor().expose(velo.Image(PIXELS[..., :1].copy(), ["Y"], encoding="linear"))


def read_descriptor(folder):
    """What EMVA's parser reads: [(kind, time in ns, photons, [file])]."""
    series, head = [], {}
    with open(os.path.join(folder, "EMVA1288_Data.txt"), encoding="ascii") as file:
        for line in file:
            words = line.split()
            if words[0] in "bd":
                series.append((words[0], float(words[1]), float(words[2]) if words[0] == "b" else 0.0, []))
            elif words[0] == "i":
                series[-1][3].append(os.path.join(folder, words[1]))
            else:
                head[words[0]] = words[1:]
    return head, series


def pair(files):
    a, b = (numpy.asarray(velo.read_image(name)).astype(float) for name in files)
    return (a.mean() + b.mean()) / 2, (((a - b) ** 2).mean() - (a.mean() - b.mean()) ** 2) / 2


@case
def the_folder_gives_gain_and_efficiency_back():
    with tempfile.TemporaryDirectory() as parent:
        folder = os.path.join(parent, "emva")
        run = subprocess.run([VELO, "sensor", "verify", "generic_mono", "--size", "96", "--stack", "3", "--frames", folder],
                             stdout=subprocess.PIPE, text=True, check=False)
        assert "gain, DN/e-" in run.stdout
        head, series = read_descriptor(folder)
        assert head["n"] == ["12", "96", "96"] and head["v"] == ["3.1"]
        dark = {time: files for kind, time, _, files in series if kind == "d" and len(files) == 2}
        stacks = [s for s in series if len(s[3]) == 3]
        assert [s[0] for s in stacks] == ["b", "d"] and stacks[0][1] == stacks[1][1]
        x, y, photons = [], [], []
        for kind, time, light, files in series:
            if kind == "b" and len(files) == 2 and len(x) < 30:
                mean, variance = pair(files)
                mean_dark, variance_dark = pair(dark[time])
                x.append(mean - mean_dark)
                y.append(variance - variance_dark)
                photons.append(light)
        x, y, photons = map(numpy.array, (x, y, photons))
        gain = (x * y).sum() / (x * x).sum()
        assert abs(gain * 2.6 - 1) < 0.02, gain
        responsivity = (x * photons).sum() / (photons * photons).sum()
        assert abs(responsivity / gain / (0.65 * 0.95) - 1) < 0.02


if __name__ == "__main__":
    cases.main()
