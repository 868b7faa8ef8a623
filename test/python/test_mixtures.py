#!/usr/bin/python3
"""Random scenes (mixtures.py): the tracers agree, and the accelerator, the number of threads a continued film and
renders between edits change no bit, and what a saved scene loses is counted. test_mixtures.py FIRST COUNT compares the tracers in others than those of CI."""
import sys

import cases
from cases import case

numpy = cases.need("numpy")
import velo

import mixtures

SEEDS, BLOCK = 16, 8
#: At most this many standard errors between two tracers: in a block of pixels, of which a scene has 36 numbers, and in the image. Of
#: 400 scenes with the same means none comes near, noise with rare bright samples included.
MAX_BLOCK, MAX_IMAGE = 6.0, 4.5
SCENES = range(122, 130)


def squares(image):
    """The means of squares of 8 x 8 pixels, rows x columns x 3."""
    colors = numpy.asarray(image)[..., :3].astype(float)
    return colors.reshape(mixtures.HEIGHT // BLOCK, BLOCK, mixtures.WIDTH // BLOCK, BLOCK, 3).mean(axis=(1, 3))


def images(mixture, tracer, spp):
    return numpy.array([squares(mixture.scene.render(tracer=tracer, spp=spp, seed=seed, max_depth=mixture.depth, sampler="independent",
                                                     filter="box", share_samples=False)) for seed in range(1, SEEDS + 1)])


def errors_between(one, other):
    """The difference of two sets of images in standard errors."""
    noise = numpy.sqrt((one.var(axis=0, ddof=1) + other.var(axis=0, ddof=1)) / SEEDS)
    return numpy.abs(one.mean(axis=0) - other.mean(axis=0)) / numpy.maximum(noise, 1e-12)


def tracers_of(mixture):
    """The unbiased tracers that find all light of a mixture, beside volpath."""
    if mixture.smooth and mixture.pointed:
        return []
    return ["bidirectional"] if mixture.smooth else ["bidirectional", "lightpath"]


def differences(number):
    mixture = mixtures.Mixture(number)
    found = []
    one = images(mixture, "volpath", 96)
    for tracer in tracers_of(mixture):
        other = images(mixture, tracer, 32)
        blocks = errors_between(one, other).max()
        image = errors_between(one.mean(axis=(1, 2)), other.mean(axis=(1, 2))).max()
        if blocks > MAX_BLOCK or image > MAX_IMAGE or not numpy.isfinite(other).all():
            found.append("mixture %d: volpath %.5g, %s %.5g: %.1f and %.1f standard errors; %s"
                         % (number, one.mean(), tracer, other.mean(), blocks, image, "; ".join(mixture.parts)))
    return found


@case
def tracers_agree():
    found = [line for number in SCENES for line in differences(number)]
    assert not found, "\n".join(found)


@case
def bits_are_the_same():
    for number in SCENES:
        mixture = mixtures.Mixture(number)
        for tracer in ("volpath", "bidirectional"):
            words = {"tracer": tracer, "max_depth": mixture.depth, "seed": number}
            first = numpy.asarray(mixture.scene.render(spp=3, **words)).tobytes()
            for threads, accelerator in ((1, "bvh"), (3, "embree")):
                velo.set_threads(threads)
                again = numpy.asarray(mixture.scene.render(spp=3, accelerator=accelerator, **words)).tobytes()
                assert again == first, (number, tracer, threads, accelerator)
            mixture.scene.render(spp=1, **words)
            whole = numpy.asarray(mixture.scene.render(spp=3, film=mixture.scene.film, **words)).tobytes()
            assert whole == first, (number, tracer, "continued")


def edited(number, renders_between):
    """The bits of a mixture after edits."""
    mixture = mixtures.Mixture(number)

    def bits():
        image = mixture.scene.render(spp=2, seed=number, max_depth=mixture.depth, tracer=("volpath", "bidirectional")[number % 2],
                                     channels=["Z", "N", "albedo", "id.object", "id.material", "id.instance"])
        return numpy.asarray(image).tobytes() + b"".join(numpy.asarray(image[name]).tobytes() for name in image.channels)

    for _ in range(8):
        if renders_between:
            bits()
        for _ in range(2):
            mixture.edit()
    return bits()


@case
def edits_leave_no_trace():
    """A world shares with the one before it what has not changed."""
    for number in range(200, 216):
        assert edited(number, True) == edited(number, False), number


@case
def what_saving_loses_is_counted():
    whole = 0
    for number in (*SCENES, 4, 28, 89):
        mixture = mixtures.Mixture(number)
        path = cases.work("mixture.pbrt")
        lost = mixture.scene.save(path)
        assert "the camera: left out" not in lost, (number, lost)
        light = "light of surfaces that only part media (material interface): left out"
        assert (light in lost) == any("passed" in part for part in mixture.parts), (number, lost)
        if lost:
            continue
        whole += 1
        one = images(mixture, "volpath", 24)
        mixture.scene = velo.load(path)
        other = images(mixture, "volpath", 24)
        assert errors_between(one, other).max() < MAX_BLOCK, (number, mixture.parts)
    assert whole >= 3


if len(sys.argv) == 3:
    first, count = int(sys.argv[1]), int(sys.argv[2])
    lines = [line for number in range(first, first + count) for line in differences(number)]
    print("\n".join(lines) or "no differences in %d mixtures" % count)
    sys.exit(1 if lines else 0)
cases.main()
