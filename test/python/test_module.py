#!/usr/bin/python3
"""The Python module: renders, errors, progress, fork, threads."""
import copy
import os
import pickle
import subprocess
import sys
import threading
import time

import cases
from cases import case, raises, warned, work

numpy = cases.need("numpy")
import velo

scene = velo.load(cases.PINHOLE)


@case
def jacobians() -> None:
    camera = velo.Camera(64, 48, eye=(0.3, 1, 3), lookat=(0, 0, 0), distortion="radial", distortion_coefficients=[-0.1])
    points = numpy.array([[0.1, 0.2, 0.3], [0.0, 0.0, 9.0]])
    seen, jacobian = camera.project(points, jacobian=True)
    assert numpy.array_equal(seen.pixels, camera.project(points).pixels)
    assert jacobian.values.shape == (2, 2, len(velo.camera.JACOBIAN_COLUMNS)) and list(jacobian.valid) == [True, False]
    assert not jacobian.values[1].any()
    for column in range(3):
        step = numpy.eye(3)[column] * 1e-5
        difference = (camera.project(points[:1] + step).pixels - camera.project(points[:1] - step).pixels) / 2e-5
        assert numpy.allclose(jacobian.values[0, :, column], difference[0], rtol=1e-6, atol=1e-6)
    rays, jacobian = camera.unproject([[20.0, 30.0]], jacobian=True)
    assert jacobian.values.shape == (1, 6, len(velo.camera.JACOBIAN_COLUMNS)) and rays.valid.all()
    assert numpy.allclose(rays.directions @ jacobian.values[0, 3:], 0, atol=1e-12)  # a unit vector stays one
    own = velo.Camera(64, 48, stereo_mode="omnidirectional", projection="equirectangular").eyes()[0]
    with raises(velo.UnsupportedError, "omnidirectional stereo"):
        own.project(points, jacobian=True)


@case
def a_render_is_a_numpy_array():
    image = scene.render(spp=2, resolution=(64, 48), channels=["Z", "N", "id.object"])
    pixels = numpy.asarray(image)
    assert pixels.shape == (48, 64, 4) and pixels.dtype == numpy.float32
    assert 0.05 < pixels[..., :3].mean() < 1
    assert image["Z"].shape == (48, 64) and image["N"].shape == (48, 64, 3)
    assert image["id.object"].dtype == numpy.uint32 and image["id.object"].max() > 1
    hit = numpy.isfinite(image["Z"])
    assert numpy.allclose(numpy.linalg.norm(image["N"][hit], axis=1), 1, atol=1e-5)


@case
def changed_cameras_keep_their_motion_and_roll():
    first = numpy.eye(4)
    first[:3, 3] = 1, 2, 3
    last = first + [[0, 0, 0, 1], [0] * 4, [0] * 4, [0] * 4]
    points, path = [[0.1, 0.2, 9.0]], work("moving.json")
    size = {"width": 40, "height": 30, "shutter_close": 1}
    for camera in (velo.Camera(world_from_camera=first, world_from_camera_close=last, **size), velo.Camera(world_from_camera=first, roll=0.3, **size),
                   velo.Camera(eye=(1, 2, 3), lookat=(1, 2, 4), up=(0, -1, 0), world_from_camera_close=last, **size),
                   velo.Camera(eye=(1, 2, 3), lookat=(1, 2, 4), eye_close=(1.5, 2, 3), roll_close=0.2, **size),
                   velo.Camera(world_from_camera=first, roll=0.3, roll_close=0.5, **size)):
        assert numpy.array_equal(camera.replace(exposure_time=2.0).project(points).pixels, camera.project(points).pixels)
        for changed in (camera, camera.resize(80, 60), camera.coarse(2), camera.move(last), camera.at(0.5)):
            pixels = changed.project(points).pixels
            changed.write(path)
            for other in (velo.read_camera(path), changed.replace(exposure_time=2.0), pickle.loads(pickle.dumps(changed))):
                assert numpy.allclose(other.project(points).pixels, pixels, rtol=0, atol=1e-9), (camera, other.project(points).pixels, pixels)
    with raises(velo.Error):
        velo.Camera(40, 30, world_from_camera=first, eye_close=(1, 1, 1))


@case
def eyes_of_stereo_cameras_can_be_changed_and_written():
    points, path = [[10.0, 20.0, -50.0]], work("eye.json")
    place = {"eye": (0, 100, 500), "lookat": (0, 0, 0), "interocular": 6.0}
    for keywords in (dict(stereo="off-axis", convergence=100.0, fov=1.0), dict(stereo="toe-in", convergence=100.0, fov=1.0),
                     dict(stereo="omnidirectional", projection="equirectangular")):
        for eye in velo.Camera(60, 40, **place, **keywords).eyes():
            pixels = eye.project(points).pixels
            assert numpy.allclose(eye.replace(exposure_time=2.0).project(points).pixels, pixels, rtol=0, atol=1e-9), keywords
            if keywords["stereo"] == "omnidirectional":
                with raises(velo.Error):
                    eye.write(path)
                continue
            eye.write(path)
            assert numpy.allclose(velo.read_camera(path).project(points).pixels, pixels, rtol=0, atol=1e-9), keywords


@case
def resized_cameras_keep_their_lens():
    points, cameras = [[0.3, 1.0, -5], [0, 1.5, -3]], os.path.join(cases.SCENES, "cameras")
    for name in ("lens_blades", "lens_tilt", "optics_single", "vignetting", "lens_anamorphic"):
        camera = velo.load(os.path.join(cameras, name + ".pbrt")).camera
        for changed in (camera.resize(48, 32), camera.coarse(2)):
            again = changed.replace(exposure_time=2.0)
            assert numpy.array_equal(again.project(points).pixels, changed.project(points).pixels), name


@case
def cameras_and_images_are_pickled_and_copied():
    random = numpy.random.default_rng(7)
    points, pixels = random.normal(size=(50, 3)) * 3, random.uniform(0, 48, size=(50, 2))
    for keywords in (dict(fov=1.0), dict(K=[[50, 0.5, 31], [0, 52, 25], [0, 0, 1]], distortion="opencv", distortion_coefficients=[0.1, 0.01, 0, 0]),
                     dict(projection="equidistant", fov=3.0, lens_radius=0.1, focus_distance=3), dict(shutter=[(0, 0), (0.5, 1), (1, 0)]),
                     dict(eye=(0, 0, 5), eye_close=(1, 0, 5), readout=0.5)):
        camera = velo.Camera(64, 48, **keywords)
        for other in (pickle.loads(pickle.dumps(camera)), copy.copy(camera), copy.deepcopy(camera)):
            assert numpy.array_equal(other.world_from_camera, camera.world_from_camera)
            assert all(numpy.array_equal(a, b) for a, b in zip(other.project(points), camera.project(points)))
            assert all(numpy.array_equal(a, b) for a, b in zip(other.unproject(pixels), camera.unproject(pixels)))
    image = scene.render(spp=1, resolution=(16, 12), channels=["Z", "N", "id.object"])
    eight_bits = image.view()
    for first in (image, eight_bits):
        for other in (pickle.loads(pickle.dumps(first)), copy.copy(first), copy.deepcopy(first)):
            assert other.channels == first.channels
            assert all(numpy.array_equal(other[name], first[name], equal_nan=True) and other[name].dtype == first[name].dtype for name in first.channels)
    other = copy.copy(image)
    numpy.asarray(other)[0, 0] = 9
    assert numpy.asarray(image)[0, 0, 0] != 9


@case
def images_are_indexed_as_arrays():
    image = scene.render(spp=1, resolution=(16, 12))
    assert numpy.array_equal(image[..., 0], image["R"]) and image[2:5, :, :3].shape == (3, 16, 3)


@case
def points_keep_their_shape():
    camera = scene.camera
    points = numpy.random.default_rng(3).normal(size=(4, 5, 3))
    many, flat = camera.project(points), camera.project(points.reshape(-1, 3))
    assert many.pixels.shape == (4, 5, 2) and many.z.shape == many.valid.shape == (4, 5)
    assert numpy.array_equal(many.pixels.reshape(-1, 2), flat.pixels)
    rays = camera.unproject(numpy.full((4, 5, 2), 10.0))
    assert rays.origins.shape == rays.directions.shape == (4, 5, 3) and rays.valid.shape == (4, 5)
    assert camera.project(numpy.zeros((0, 3))).pixels.shape == (0, 2)


@case
def other_names_are_told():
    for call, words in ((lambda: scene.render(spp=1, resolution=(8, 8), channels=["depth"]), "is called Z"),
                        (lambda: scene.render(spp=1, resolution=(8, 8))["Base_Color"], "is called albedo"),
                        (lambda: scene.ground_truth(["normal"], resolution=(8, 8)), "is called N"),
                        (lambda: scene.render(width=8), "resolution=")):
        with raises(velo.UsageError, words):
            call()


@case
def unknown_fields_of_a_camera_file_are_warnings():
    frame = '"frames": [{"transform_matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]}]}'
    with open(work("unread.json"), "w", encoding="utf-8") as file:
        file.write('{"w": 64, "h": 48, "fl_x": 50,\n"gain": 2, ' + frame)
    with warned() as found:
        assert velo.read_camera(work("unread.json")).resolution == (64, 48)
    assert len(found) == 1 and 'line 2: 1 fields are not understood and without effect: "gain"' in str(found[0].message)


@case
def a_pbrt_camera_is_read_again():
    camera = velo.Camera(64, 48, fov=0.7, eye=(1, 2, 3), lookat=(0, 0, 0))
    camera.write(work("camera.pbrt"))
    back = velo.read_camera(work("camera.pbrt"))
    assert back.resolution == (64, 48) and numpy.allclose(back.world_from_camera, camera.world_from_camera, atol=1e-12)
    assert numpy.allclose(back.K, camera.K, rtol=1e-12)
    assert velo.read_camera(work("camera.pbrt"), width=32, height=24).resolution == (32, 24)


@case
def an_array_shares_the_image_and_keeps_it_alive():
    image = scene.render(spp=1, resolution=(32, 24))
    pixels = numpy.asarray(image)
    pixels[3, 5] = (1, 2, 3, 1)
    assert tuple(image["G"][3, 5:6]) == (2,)
    with raises(BufferError):
        image.close()
    del image
    assert tuple(pixels[3, 5]) == (1, 2, 3, 1)


@case
def the_header_is_that_of_the_program_but_for_the_receipt():
    channels, program, own = ["Z", "N", "id.object", "crypto.object"], work("header.exr"), work("header_own.exr")
    subprocess.run([cases.VELO, "render", cases.PINHOLE, "--spp", "2", "--resolution", "32x24", "--channels", ",".join(channels),
                    "-o", program], check=True, capture_output=True)
    image = scene.render(spp=2, resolution=(32, 24), channels=channels)
    image.write(own)
    wanted, found = velo.read_image(program), velo.read_image(own)
    header = wanted.attributes
    assert header.pop("velo.receipt") and len(header) > 30 and header == found.attributes
    assert wanted.channels == found.channels and numpy.array_equal(numpy.asarray(wanted), numpy.asarray(found), equal_nan=True)
    assert numpy.array_equal(velo.read_image(own, ["id.object"])["id.object"], image["id.object"])
    truth = work("truth_own.exr")
    scene.ground_truth(["Z", "id.object"], resolution=(32, 24)).write(truth)
    for path in (own, truth):
        subprocess.run([cases.VELO, "image", "check", path], check=True, capture_output=True)


@case
def the_header_has_the_camera_that_was_given():
    lenses = [{"projection": "eucm", "shape": (0.6, 1.1)}, {"projection": "double_sphere", "shape": (-0.2, 0.6)}]
    for distortion, count in (("opencv", 5), ("radial", 2), ("thin_prism", 8), ("rad_tan_thin_prism", 12)):
        lenses.append({"distortion": distortion, "distortion_coefficients": [0.01 * 0.5 ** k for k in range(count)]})
    path = work("given.exr")
    for lens in lenses:
        camera = velo.Camera(40, 30, fx=30, fy=31, cx=20.5, cy=15, eye=(0, 0, 50), lookat=(0, 0, 0), **lens)
        scene.render(camera=camera, spp=1, channels=["Z", "P", "ray"], crop=(3, 4, 33, 30)).write(path)
        subprocess.run([cases.VELO, "image", "check", path], check=True, capture_output=True)


@case
def the_pixels_are_those_of_the_program():
    path = work("program.exr")
    subprocess.run([cases.VELO, "render", cases.PINHOLE, "--spp", "3", "--resolution", "80x60", "-o", path], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    read = velo.read_image(path, ["R", "G", "B"])
    mine = scene.render(spp=3, resolution=(80, 60))
    assert numpy.array_equal(numpy.asarray(read), numpy.asarray(mine)[..., :3])


@case
def errors_have_place_and_code():
    path = work("wrong.pbrt")
    with open(path, "w") as file:
        file.write('Film "rgb"\n  "integer xresolution" [ 64 ]\nWorldBegin\n  Shape "spere"\n')
    try:
        velo.load(path)
        assert False
    except velo.SceneError as error:
        assert error.file == path and error.line == 4 and error.column and error.code == 3, vars(error)
        assert "sphere" in error.message and str(error).startswith("%s:4:" % path)
    with raises(velo.MissingFileError, "nowhere.pbrt") as _:
        velo.load(work("nowhere.pbrt"))
    with raises(FileNotFoundError):
        velo.load(work("nowhere.pbrt"))
    with raises(velo.OutputError, "nofolder"):
        scene.render(spp=1, resolution=(8, 8)).write(work("nofolder/a.png"))
    assert velo.OutputError.code == 5 and velo.MissingFileError.code == 4 and velo.UsageError.code == 2


@case
def unknown_keywords_have_the_nearest_names():
    with raises(velo.UsageError, '"ssp"', "spp"):
        scene.render(ssp=3)
    with raises(velo.UsageError, "max_depth"):
        scene.render(maxx_depth=3)
    with raises(velo.UsageError, 'did you mean "path"?'):
        scene.render(tracer="pth")
    with raises(velo.UsageError, "unknown channel \"depht\""):
        scene.render(spp=1, resolution=(8, 8), channels=["depht"])
    with raises(velo.UsageError, "spp must be a whole number"):
        scene.render(spp=1.5)


@case
def progress_is_reported_and_can_end_a_render():
    seen = []

    def callback(progress):
        seen.append(progress)
        return not (progress.pass_done and progress.spp >= 2)

    image = scene.render(spp=64, resolution=(64, 48), progress=callback)
    assert scene.film.spp == seen[-1].spp == 2 and seen[-1].spp_total == 64
    assert numpy.array_equal(numpy.asarray(image), numpy.asarray(scene.render(spp=2, resolution=(64, 48))))


@case
def an_exception_in_a_callback_ends_the_render():
    class Mine(Exception):
        pass

    def callback(progress):
        raise Mine("here")

    with raises(Mine, "here"):
        scene.render(spp=64, resolution=(64, 48), progress=callback)
    scene.render(spp=1, resolution=(64, 48))


@case
def an_exception_in_a_callback_ends_denoising():
    class Mine(Exception):
        pass

    seen = []

    def callback(progress):
        if seen and seen[-1].pass_done:
            assert not progress.pass_done and progress.spp == 1
            raise Mine("here")
        seen.append(progress)

    with raises(Mine, "here"):
        scene.render(spp=1, resolution=(640, 480), denoise=True, progress=callback)
    assert scene.film.spp == 1


@case
def a_callback_is_asked_while_channels_are_joined_for_denoising():
    """It can end the render before the denoiser begins; channels that the denoiser does not read change nothing, and all are computed once."""
    from velo import _velo
    joins, asked, computed, unset, channels = [], [], [], velo.Image._unset, _velo.channels

    def watched(image, names):
        joins.append(len(asked))
        return unset(image, names)

    def counted(*words):
        computed.extend(words[4])
        return channels(*words)

    velo.Image._unset, _velo.channels = watched, counted
    try:
        image = scene.render(spp=2, resolution=(64, 320), denoise=True, channels=["Z", "crypto.object", "N"], progress=asked.append)
    finally:
        _velo.channels = channels
        del velo.Image._unset
    assert len(joins) == 1 and len(asked) - joins[0] >= 320 // 32, (joins, len(asked))
    assert sorted(computed) == ["N", "Z", "crypto.object", "error", "features"], computed
    plain = scene.render(spp=2, resolution=(64, 320), denoise=True)
    assert numpy.asarray(image).tobytes() == numpy.asarray(plain).tobytes()


@case
def a_callback_after_a_pass_may_read_the_film():
    images = []

    def callback(progress):
        if progress.pass_done:
            images.append(numpy.array(scene.film.image()))
            with raises(velo.UsageError):
                scene.render(spp=1, film=scene.film)

    scene.render(spp=4, resolution=(64, 48), progress=callback)
    assert len(images) == 3 and numpy.array_equal(images[1], numpy.asarray(scene.render(spp=2, resolution=(64, 48))))


@case
def a_callback_inside_a_pass_may_use_velo_but_not_the_film():
    seen = []

    def callback(progress):
        if progress.pass_done:
            return True
        with raises(velo.UsageError, "pass_done"):
            scene.film.image()
        with raises(velo.UsageError, "using this object"):
            scene.render(spp=1, film=scene.film)
        other = velo.load(cases.PINHOLE)
        seen.append(numpy.array(other.render(spp=1, resolution=(32, 24))))
        return False

    scene.render(spp=4096, resolution=(640, 480), progress=callback)
    assert len(seen) == 1 and numpy.array_equal(seen[0], numpy.asarray(scene.render(spp=1, resolution=(32, 24))))


@case
def passes_yield_images_so_far():
    for sampler in ("sobol", "stratified"):
        images = list(scene.passes(spp=5, resolution=(48, 36), sampler=sampler))
        assert len(images) == 4
        last = numpy.asarray(scene.render(spp=5, resolution=(48, 36), sampler=sampler))
        assert numpy.array_equal(numpy.asarray(images[-1]), last), sampler


@case
def fork_raises_a_clear_error_and_new_objects_work():
    """In a process of its own, whose time is limited: a lock that nobody holds after fork() would wait for ever."""
    script = work("fork.py")
    with open(script, "w") as file:
        file.write("import os, sys, numpy, velo\n"
                   "scene = velo.load(%r)\n"
                   "before = numpy.array(scene.render(spp=2, resolution=(48, 36)))\n"
                   "child = os.fork()\n"
                   "if child == 0:\n"
                   "    try:\n"
                   "        scene.render(spp=1)\n"
                   "    except velo.ForkError as error:\n"
                   "        assert 'fork' in str(error)\n"
                   "    else:\n"
                   "        os._exit(3)\n"
                   "    again = velo.load(%r)\n"
                   "    after = numpy.array(again.render(spp=2, resolution=(48, 36)))\n"
                   "    os._exit(0 if numpy.array_equal(before, after) else 4)\n"
                   "assert os.waitpid(child, 0)[1] == 0\n"
                   "import multiprocessing\n"
                   "def one(seed):\n"
                   "    return float(numpy.asarray(velo.load(%r).render(spp=1, seed=seed, resolution=(32, 24))).mean())\n"
                   "with multiprocessing.get_context('fork').Pool(2) as pool:\n"
                   "    means = pool.map(one, range(4))\n"
                   "assert len(set(means)) == 4, means\n" % (cases.PINHOLE, cases.PINHOLE, cases.PINHOLE))
    run = subprocess.run([sys.executable, script], timeout=60, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert run.returncode == 0, run.stdout.decode()


@case
def threads_may_render_at_once():
    images = {}

    def work_in_thread(number):
        own = velo.load(cases.PINHOLE)
        images[number] = numpy.array(own.render(spp=3, resolution=(48, 36)))

    threads = [threading.Thread(target=work_in_thread, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(images) == 4 and all(numpy.array_equal(images[0], image) for image in images.values())


@case
def the_interpreter_runs_during_a_render():
    count = [0]
    done = threading.Event()

    def counting():
        while not done.is_set():
            count[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counting)
    thread.start()
    scene.render(spp=32, resolution=(160, 120))
    done.set()
    thread.join()
    assert count[0] > 20, count


@case
def objects_are_context_managers():
    with velo.load(cases.PINHOLE) as own:
        with own.render(spp=1, resolution=(16, 12)) as image:
            assert image.width == 16
        with raises(velo.UsageError, "closed"):
            image.write(work("closed.png"))
    with raises(velo.UsageError, "closed"):
        own.render(spp=1)


@case
def a_notebook_shows_a_png():
    data = scene.render(spp=1, resolution=(32, 24))._repr_png_()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"


@case
def memory_does_not_grow():
    def resident():
        with open("/proc/self/status") as file:
            return int(next(line for line in file if line.startswith("VmRSS")).split()[1]) / 1024

    count = int(os.environ.get("VELO_PYTHON_RENDERS", "60"))
    context = velo.default_context()

    def one(seed):
        own = velo.load(cases.PINHOLE)
        image = own.render(spp=1, seed=seed, resolution=(32, 24), channels=["Z", "id.object"],
                           progress=lambda progress: None)
        image["Z"].sum(), image._repr_png_() if seed % 10 == 0 else None
        try:
            own.render(sppp=1)
        except velo.UsageError:
            pass

    for seed in range(20):
        one(seed)
    held, handles, grown = context.memory, len(os.listdir("/proc/self/fd")), []
    while len(grown) < 3 and (not grown or grown[-1] >= 6):  # a leak grows each time; malloc's own blocks do not
        size = resident()
        for seed in range(count):
            one(seed)
        grown.append(resident() - size)
        print("  %d renders: %+d bytes held, %+.1f MB resident" % (count, context.memory - held, grown[-1]))
    assert context.memory == held
    assert grown[-1] < 6, grown
    assert len(os.listdir("/proc/self/fd")) == handles


if __name__ == "__main__":
    cases.main()
