#!/usr/bin/python3
"""Cameras and samplers of one's own in Python (velo/own.py): the bits of velo's where they compute the same; exceptions, NaN,
wrong shapes; names."""
import math
import threading
import time

import cases
from cases import case, raises, warned, work

numpy = cases.need("numpy")
import velo  # noqa: E402

WIDTH, HEIGHT, FOCAL = 64, 48, 70.0


def scene():
    return velo.load(cases.PINHOLE)


def pinhole_rays(points):
    return numpy.stack((points.x - points.width / 2, points.y - points.height / 2, numpy.full(len(points.x), FOCAL)), axis=1)


def pinhole_pixels(points, width, height):
    film = numpy.full((len(points), 2), numpy.nan)
    ahead = points[:, 2] > 0
    film[ahead] = points[ahead, :2] / points[ahead, 2:] * FOCAL + (width / 2, height / 2)
    return film


PINHOLE = velo.OwnCamera(pinhole_rays, name="pinhole", pixels=pinhole_pixels)


def both_cameras(it):
    theirs = it.camera.resize(WIDTH, HEIGHT).replace(fx=FOCAL, fy=FOCAL)
    return theirs, theirs.replace(own=PINHOLE)


@case
def a_camera_has_the_bits_of_velos():
    it = scene()
    theirs, own = both_cameras(it)
    assert own.projection == "own"
    images = [numpy.asarray(it.render(camera=camera, spp=2)) for camera in (theirs, own)]
    assert numpy.array_equal(*images)
    depths = [it.ground_truth(["Z"], camera=camera)["Z"] for camera in (theirs, own)]
    assert numpy.allclose(*depths, rtol=1e-6)
    points = numpy.array([[0, 0, 0], [10, 20, -30.0]])
    assert numpy.allclose(theirs.project(points).pixels, own.project(points).pixels)
    pixels = numpy.array([[0.5, 0.5], [30, 20]])
    assert numpy.allclose(theirs.unproject(pixels).directions, own.unproject(pixels).directions)


@case
def a_camera_takes_the_place_of_the_scenes():
    it = scene()
    image = it.render(camera=PINHOLE, resolution=(WIDTH, HEIGHT), spp=1)
    same = it.render(camera=it.camera.resize(WIDTH, HEIGHT).replace(own=PINHOLE), spp=1)
    assert numpy.array_equal(numpy.asarray(image), numpy.asarray(same))
    assert len(it.boxes(camera=PINHOLE, resolution=(WIDTH, HEIGHT))["object"]) > 0
    assert [image.width for image in it.passes(camera=PINHOLE, resolution=(WIDTH, HEIGHT), spp=2, coarse=(4,))][-1] == WIDTH


def one_in(fail):
    """A camera that fails in its fifth call."""
    count = [0]

    def rays(points):
        count[0] += 1
        return fail(points) if count[0] == 5 else pinhole_rays(points)
    return velo.OwnCamera(rays, name="fails")


@case
def exceptions_end_the_render():
    it = scene()

    def divide(points):
        return 1 / 0

    for fail, kind in ((divide, ZeroDivisionError), (lambda points: numpy.zeros((3, 3)), velo.UsageError),
                       (lambda points: (1, 2, 3, 4), velo.UsageError), (lambda points: "text", ValueError)):
        start = time.time()
        with raises(kind):
            it.render(camera=one_in(fail), resolution=(640, 480), spp=4096)
        assert time.time() - start < 20
    always = velo.OwnCamera(divide, name="always")
    with raises(ZeroDivisionError):
        it.camera.replace(own=always)
    with raises(ZeroDivisionError):
        it.render(sampler=velo.OwnSampler(lambda samples: 1 / 0, name="fails"), resolution=(32, 32), spp=1)
    assert it.render(camera=PINHOLE, resolution=(WIDTH, HEIGHT), spp=1).width == WIDTH


@case
def project_raises_what_the_function_raises():
    broken = velo.OwnCamera(pinhole_rays, name="broken", pixels=lambda points, width, height: {}["x"])
    camera = scene().camera.replace(own=broken)
    with raises(KeyError):
        camera.project([[0, 0, -5.0]])
    assert not scene().camera.replace(own=velo.OwnCamera(pinhole_rays, name="one way")).project([[0, 0, -5.0]]).valid[0]


@case
def rays_may_have_origins_and_weights():
    it = scene()

    def half(points):
        d = pinhole_rays(points)
        return d, numpy.zeros_like(d), numpy.full(len(d), 0.5)
    camera = both_cameras(it)[1]
    whole = numpy.asarray(it.render(camera=camera, spp=1))
    dim = numpy.asarray(it.render(camera=camera.replace(own=velo.OwnCamera(half, name="half")), spp=1))
    assert numpy.allclose(dim[..., :3], whole[..., :3] / 2, atol=1e-6)


def hashed(samples):
    keys = [samples.x.astype("i8"), samples.y.astype("i8"), samples.index.astype("i8"), samples.dimension, samples.seed]
    h = numpy.zeros(len(samples.x), "u8")
    for key in keys:
        h = (h ^ numpy.asarray(key).astype("u8")) * numpy.uint64(0x9e3779b97f4a7c15)
        h ^= h >> numpy.uint64(29)
    pair = numpy.stack((h >> numpy.uint64(40), (h >> numpy.uint64(12)) & numpy.uint64(0xffffff)), axis=1) * 2.0**-24
    return pair[:, :samples.dimensions]


@case
def a_sampler_gives_the_mean_of_velos():
    it = scene()
    own = velo.OwnSampler(hashed, name="hash")
    means = [[numpy.asarray(it.render(sampler=sampler, resolution=(32, 24), spp=8, seed=seed))[..., :3].mean() for seed in range(8)]
             for sampler in ("independent", own)]
    error = math.hypot(*(numpy.std(mean, ddof=1) / math.sqrt(8) for mean in means))
    assert abs(numpy.mean(means[0]) - numpy.mean(means[1])) < 4 * error < 0.1 * numpy.mean(means[0]), (means, error)


def occlusion(trace, paths):
    hits = trace.hits(paths.rays)
    u, v = trace.numbers().T
    z = 1 - 2 * u
    r = numpy.sqrt(1 - z * z)
    direction = hits.normal + numpy.stack((r * numpy.cos(2 * numpy.pi * v), r * numpy.sin(2 * numpy.pi * v), z), axis=1)
    direction /= numpy.maximum(numpy.linalg.norm(direction, axis=1, keepdims=True), 1e-6)
    return numpy.where(numpy.isfinite(hits.t) & ~trace.occluded(trace.leave(direction)), 1.0, 0.0)


@case
def a_tracer_gives_the_mean_of_velos():
    it = scene()
    own = velo.OwnTracer(occlusion, name="occlusion")
    means = [[numpy.asarray(it.render(tracer=tracer, resolution=(32, 24), spp=8, seed=seed))[..., :3].mean() for seed in range(8)]
             for tracer in ("ambientocclusion", own)]
    error = math.hypot(*(numpy.std(mean, ddof=1) / math.sqrt(8) for mean in means))
    assert abs(numpy.mean(means[0]) - numpy.mean(means[1])) < 4 * error < 0.1 * numpy.mean(means[0]), (means, error)


@case
def a_tracer_asks_during_its_call_only():
    it = scene()
    kept = []

    def keep(trace, paths):
        kept.append((trace, trace.hits(paths.rays)))
        lights, step = trace.lights(), trace.bounce()
        value, pdf = trace.bsdf(lights.direction)
        assert value.shape == (len(paths.x), 4) and pdf.shape == paths.x.shape == step.pdf.shape
        assert paths.white.shape == paths.wavelengths.shape == step.weight.shape
        return numpy.full((len(paths.x), 4), numpy.nan)
    with warned() as notes:
        image = it.render(tracer=velo.OwnTracer(keep, name="keep"), resolution=(16, 16), spp=1, share_samples=False)
    assert not numpy.asarray(image).any()
    assert [note.category for note in notes] == [RuntimeWarning] and notes[0].filename == __file__, notes
    assert str(notes[0].message).startswith("256 samples were not finite"), notes[0].message
    with raises(velo.UsageError, "over"):
        kept[0][0].lights()
    with raises(ZeroDivisionError):
        it.render(tracer=velo.OwnTracer(lambda trace, paths: 1 / 0, name="fails"), resolution=(16, 16), spp=1)
    with raises(velo.UsageError, "radiance"):
        it.render(tracer=velo.OwnTracer(lambda trace, paths: numpy.zeros((2, 2)), name="shape"), resolution=(16, 16), spp=1)


@case
def the_same_bits_for_any_number_of_threads():
    images = []
    for threads in (1, 3):
        it = velo.Scene(context=velo.Context(threads=threads))
        it.load(cases.PINHOLE)
        images.append(numpy.asarray(it.render(camera=PINHOLE, sampler=velo.OwnSampler(hashed, name="hash"),
                                              resolution=(WIDTH, HEIGHT), spp=2)))
    assert numpy.array_equal(*images)


@case
def wrong_numbers_and_names():
    it = scene()
    for value in (-1.0, 2.0, math.nan):
        with warned() as notes:
            image = it.render(sampler=velo.OwnSampler(lambda s: numpy.full((len(s.x), s.dimensions), value), name="wrong"),
                              resolution=(16, 16), spp=1)
        assert numpy.isfinite(numpy.asarray(image)).all()
        assert len(notes) == 1 and "numbers of the sampler were not in [0, 1)" in str(notes[0].message), notes
    for name in ("", "x" * 64, 5):
        with raises(velo.UsageError):
            velo.OwnCamera(pinhole_rays, name=name)
    with raises(velo.UsageError):
        velo.OwnCamera("no function", name="text")
    with raises(velo.UsageError):
        it.render(sampler=PINHOLE, spp=1)
    with raises(velo.UsageError):
        it.camera.replace(own=velo.OwnSampler(hashed, name="hash"))
    with raises(velo.Error):
        it.camera.replace(own=velo.OwnCamera(pinhole_rays, name="a\nb"))


@case
def films_keep_the_name():
    it = scene()
    it.render(camera=PINHOLE, resolution=(WIDTH, HEIGHT), spp=1)
    it.film.write(work("own.film"))
    film = velo.read_film(work("own.film"))
    with raises(velo.UsageError, "pinhole"):
        it.render(camera=velo.OwnCamera(pinhole_rays, name="other"), film=film, spp=2)
    it.render(camera=PINHOLE, film=film, spp=2)


@case
def two_renders_at_once():
    results = []

    def run(fails):
        try:
            results.append(scene().render(camera=one_in(lambda points: 1 / 0) if fails else PINHOLE, resolution=(WIDTH, HEIGHT),
                                          spp=64).width)
        except ZeroDivisionError:
            results.append("error")
    threads = [threading.Thread(target=run, args=(fails,)) for fails in (False, True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(map(str, results)) == [str(WIDTH), "error"], results


if __name__ == "__main__":
    cases.main()
