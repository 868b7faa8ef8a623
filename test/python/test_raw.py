#!/usr/bin/python3
"""velo.Raw: attributes, files, development, and wrong values, which are named."""
import copy
import os
import pickle

import cases
from cases import case, raises, work

numpy = cases.need("numpy")
import velo

NUMBERS = (numpy.arange(6 * 8).reshape(6, 8) * 83 % 4096).astype("uint16")


def bells():
    nm = numpy.arange(360, 831)
    return [numpy.exp(-((nm - middle) / 40.0) ** 2) for middle in (600, 540, 450)]


def made(**changes):
    keywords = dict(pattern="GR/BG", black=[60, 61, 62, 63], white=4000, camera="One", exposure_time=0.005, f_number=2.8, focal_length=0.05,
                    iso=400, gain=0.25, read_noise=2.5, baseline_exposure=0.5)
    raw = velo.Raw(NUMBERS, **{**keywords, **changes})
    return raw


def same(a, b):
    return (a.numbers == b.numbers).all() and a._values() == b._values()


def needs_tiff(raw, path):
    try:
        raw.write(path)
    except velo.UnsupportedError:
        raise cases.Skip("needs a velo with libtiff") from None


@case
def attributes_are_those_given():
    raw = velo.Raw(NUMBERS)
    assert (raw.pattern, raw.bits, raw.black, raw.white, raw.camera, raw.iso) == ("RG/GB", 12, 0, 4095, "", 0)
    assert raw.neutral is None and raw.matrices is None and raw.resolution == (8, 6)
    assert raw.numbers.dtype == numpy.uint16 and (raw.numbers == NUMBERS).all()
    raw.numbers[0, 0] = 77
    assert raw.numbers[0, 0] == 77 and NUMBERS[0, 0] == 0
    assert made().black == [60, 61, 62, 63] and made(black=[5] * 4).black == 5
    assert repr(raw) == "<velo.Raw 8 x 6, 12 bits, RG/GB>"


@case
def files_read_back():
    raw = made()
    raw.match_color(bells())
    needs_tiff(raw, work("a.dng"))
    assert same(velo.read_raw(work("a.dng")), raw)
    raw.write(work("b.png"))
    assert (velo.read_image(work("b.png"))["Y"] == NUMBERS).all()
    raw.write(work("c.exr"))
    black = numpy.tile([[60, 61], [62, 63]], (3, 4))
    assert (velo.read_image(work("c.exr"))["Y"] == (NUMBERS - black.astype(float)) * 4).all()
    with raises(velo.SceneError, "b.png"):
        velo.read_raw(work("b.png"))
    with raises(velo.MissingFileError, "none.dng"):
        velo.read_raw(work("none.dng"))


@case
def every_step_is_an_image():
    raw = made()
    black = raw.develop("black")
    levels = numpy.tile([[60, 61], [62, 63]], (3, 4)).astype(float)
    assert numpy.allclose(black["Y"], (NUMBERS - levels) / (4000 - levels), atol=1e-6)
    raw.match_color(bells())
    assert raw.develop("white").channels == ("Y",)
    assert raw.develop("demosaic").channels == raw.develop("color").channels == ("R", "G", "B")
    tone = numpy.asarray(raw.develop(exposure=-1))
    linear = numpy.clip(numpy.asarray(raw.develop("color"), dtype=float) * 2 ** -0.5, 0, 1)
    curve = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert tone.dtype == numpy.uint16 and abs(tone - 65535 * curve).max() <= 0.502


@case
def matrices_and_neutral_can_be_given():
    raw = made()
    raw.match_color(bells(), light=numpy.linspace(1, 2, 471))
    other = made(neutral=raw.neutral, matrices=numpy.array(raw.matrices))
    assert same(other, raw) and len(raw.matrices) == 2 and len(raw.matrices[0]) == 3
    assert max(raw.neutral) == 1


@case
def raws_are_copied_and_pickled():
    raw = made()
    for other in (copy.copy(raw), copy.deepcopy(raw), pickle.loads(pickle.dumps(raw))):
        assert same(other, raw)


@case
def wrong_values_are_named():
    for changes in ({"bits": 0}, {"bits": 17}, {"bits": "many"}, {"white": 70000}, {"white": 5000}, {"black": -1}, {"black": [1, 2, 3]},
                    {"black": [1.5] * 4}, {"black": 4000}, {"camera": "x" * 64}, {"camera": 3}, {"camera": "new\nline"}, {"pattern": "RX"},
                    {"pattern": None}, {"exposure_time": -1}, {"f_number": float("nan")}, {"focal_length": "long"}, {"iso": 1e9},
                    {"gain": float("inf")}, {"read_noise": -1}, {"baseline_exposure": 1e9}, {"neutral": [1, 1]},
                    {"neutral": [1, 0, 1]}, {"matrices": [1, 2, 3]}, {"matrices": "identity"}):
        with raises(velo.UsageError, *changes):
            made(**changes)
    for numbers in (NUMBERS.astype(float), NUMBERS.reshape(6, 4, 2), "numbers", None, NUMBERS[0]):
        with raises(velo.UsageError):
            velo.Raw(numbers)
    raw = made()
    with raises(velo.UsageError, "stop_at", "demosaic"):
        raw.develop("mosaic")
    with raises(velo.UsageError, "exposure"):
        raw.develop("black", exposure=float("nan"))
    with raises(velo.UsageError, "matrices"):
        raw.develop()
    with raises(velo.UsageError, "sensitivities"):
        raw.match_color([1, 2, 3])
    with raises(velo.UsageError, "negative"):
        raw.match_color(-numpy.array(bells()))
    with raises(velo.UsageError, "a.jpg", ".dng"):
        raw.write(work("a.jpg"))
    raw.bits = 0
    with raises(velo.UsageError, "bits"):
        raw.write(work("a.png"))
    raw = made()
    raw.numbers[1, 2] = 9999
    with raises(velo.UsageError, "pixel (2, 1) is 9999"):
        raw.write(work("a.png"))
    assert not os.path.exists(work("a.png"))


if __name__ == "__main__":
    cases.main()
