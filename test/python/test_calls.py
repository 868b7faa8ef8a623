#!/usr/bin/python3
"""Long calls of the Python module: Ctrl-C, progress, changes of a scene, worlds that share parts, coarse images."""
import os
import signal
import subprocess
import sys
import threading
import time

import cases
from cases import case, raises, work

numpy = cases.need("numpy")
import velo

IDENTITY = numpy.eye(4)
SANITIZED = "san" in os.environ.get("LD_PRELOAD", "")


def at(x, y=0.0, z=0.0):
    matrix = numpy.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def terrain(n):
    """A mesh of 2 n^2 triangles."""
    x, z = numpy.meshgrid(numpy.linspace(-1, 1, n + 1), numpy.linspace(-1, 1, n + 1))
    points = numpy.stack([x, 0.1 * numpy.sin(9 * x) * numpy.cos(7 * z), z], 2).reshape(-1, 3).astype("float32")
    i = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
    return points, numpy.concatenate([numpy.stack([i, i + 1, i + n + 2], 1), numpy.stack([i, i + n + 2, i + n + 1], 1)])


def big_scene(n):
    scene = velo.Scene()
    scene.add_mesh(*terrain(n), name="terrain")
    scene.add_light("infinite", color=(1, 1, 1))
    scene.camera = velo.Camera(64, 48, eye=(0, 2, 3), lookat=(0, 0, 0), fov=0.8)
    return scene


# ---- Ctrl-C ---------------------------------------------------------------------------------------------------------

def interrupted(call, waits):
    """Seconds from the signal to the exception, for signals after these times; None: the call was done before. Processor
    time where it is less: other processes do not count."""
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    delays = []
    try:
        for wait in waits:
            times, done = [], threading.Event()

            def kill():
                if not done.wait(wait):
                    times.append((time.monotonic(), time.process_time()))
                    os.kill(os.getpid(), signal.SIGINT)

            thread = threading.Thread(target=kill)
            thread.start()
            try:
                call()
                done.set()
                thread.join()
                delays.append(None)
            except KeyboardInterrupt:
                delays.append(min(time.monotonic() - times[0][0], time.process_time() - times[0][1]))
            thread.join()
    finally:
        signal.signal(signal.SIGINT, previous)
    return delays


def check_delays(delays):
    delays = [delay for delay in delays if delay is not None]
    print("  delays: %s s" % " ".join("%.3f" % delay for delay in delays))
    assert delays and max(delays) < (0.5 if SANITIZED else 0.1), delays


@case
def ctrl_c_ends_a_render_and_keeps_the_film():
    scene = velo.load(cases.PINHOLE)
    check_delays(interrupted(lambda: scene.render(spp=1000000, resolution=(64, 48)), (0.5, 0.63, 0.76)))
    assert scene.film.spp >= 1 and numpy.isfinite(numpy.asarray(scene.film.image())).all()


@case
def ctrl_c_ends_a_load():
    path = work("long.obj")
    if not os.path.exists(path):
        points, faces = terrain(500)
        with open(path, "w") as file:
            file.write("".join("v %g %g %g\n" % tuple(point) for point in points.tolist()))
            file.write("".join("f %d %d %d\n" % tuple(face) for face in (faces + 1).tolist()))
    start = time.monotonic()
    velo.load(path)
    whole = time.monotonic() - start
    delays = interrupted(lambda: velo.load(path), (0.3 * whole, 0.5 * whole, 0.2 * whole))
    check_delays(delays)
    assert velo.load(path).info["triangles"] == 500000


@case
def ctrl_c_ends_a_build():
    scene = big_scene(500)
    start = time.monotonic()
    scene.world()
    whole = time.monotonic() - start

    def build():
        scene.world(color="rgb" if scene._world[0][0] == "spectral" else "spectral")

    delays = interrupted(build, (0.3 * whole, 0.5 * whole, 0.2 * whole))
    check_delays(delays)
    assert scene.world(color="rgb").info["triangles"] == 500000


@case
def ctrl_c_ends_ground_truth():
    scene = velo.load(cases.PINHOLE)
    scene.world()
    check_delays(interrupted(lambda: [scene.ground_truth(["Z"], resolution=(1000, 750)) for _ in range(1000)], (0.2, 0.3)))


@case
def a_handler_of_its_own_does_not_end_a_render():
    seen = []
    previous = signal.signal(signal.SIGINT, lambda *arguments: seen.append(time.monotonic()))
    try:
        scene = velo.load(cases.PINHOLE)
        timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        start = time.monotonic()
        scene.render(spp=4096, resolution=(640, 480), time_limit=0.6)
        assert len(seen) == 1 and seen[0] - start < 0.5 and time.monotonic() - start > 0.5
        timer.join()
    finally:
        signal.signal(signal.SIGINT, previous)


@case
def the_interpreter_ends_while_threads_render():
    script = work("end.py")
    with open(script, "w") as file:
        file.write("import threading, time, velo\n"
                   "scene = velo.load(%r)\n"
                   "def work():\n"
                   "    while True:\n"
                   "        scene.film and None\n"
                   "        velo.load(%r).render(spp=100000, resolution=(64, 48), progress=lambda progress: True)\n"
                   "for _ in range(3):\n"
                   "    threading.Thread(target=work, daemon=True).start()\n"
                   "time.sleep(0.5)\n" % (cases.PINHOLE, cases.PINHOLE))
    run = subprocess.run([sys.executable, script], timeout=60, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert run.returncode == 0, (run.returncode, run.stdout[-2000:])


@case
def fork_in_a_callback_ends_the_childs_call():
    scene = velo.load(cases.PINHOLE)
    children = []

    def callback(progress):
        if not children:
            children.append(os.fork())
        return True

    try:
        scene.render(spp=4, resolution=(64, 48), progress=callback)
    except velo.ForkError:
        os._exit(0 if children == [0] else 3)
    except BaseException:
        os._exit(4)
    if children == [0]:
        os._exit(5)
    assert os.waitpid(children[0], 0)[1] == 0


# ---- progress -------------------------------------------------------------------------------------------------------

@case
def loads_and_builds_report_their_steps():
    path, steps = work("steps.obj"), []
    points, faces = terrain(400)
    with open(path, "w") as file:
        file.write("".join("v %g %g %g\n" % tuple(point) for point in points.tolist()))
        file.write("".join("f %d %d %d\n" % tuple(face) for face in (faces + 1).tolist()))
    scene = velo.load(path, progress=steps.append)
    assert steps and all(step.name == "reading" and 0 <= step.fraction <= 1 for step in steps), steps
    built = []
    big_scene(600).world(progress=built.append)
    assert built and {step.name for step in built} <= {"reading", "images", "shapes", "lights", "accelerator"}, built
    with raises(velo.CancelledError):
        velo.load(path, progress=lambda step: False)
    with raises(velo.CancelledError):
        big_scene(600).world(progress=lambda step: False)

    class Mine(Exception):
        pass

    def fails(step):
        raise Mine("here")

    with raises(Mine, "here"):
        velo.load(path, progress=fails)
    with raises(velo.UsageError, "callable"):
        scene.world(progress=3, color="rgb")


# ---- changes --------------------------------------------------------------------------------------------------------

def room():
    """A floor with two boxes of one group."""
    scene = velo.Scene()
    paint = scene.add_material("diffuse", reflectance=(0.5, 0.5, 0.5), name="paint")
    scene.add_mesh([[-3, 0, -3], [3, 0, -3], [3, 0, 3], [-3, 0, 3]], [[0, 2, 1], [0, 3, 2]], name="floor", material=paint)
    group = scene.add_group("box")
    scene.add_sphere((0, 0.3, 0), 0.3, group=group, material=scene.add_material("diffuse", reflectance=0.8, name="white"))
    scene.add_light("infinite", color=(1, 1, 1))
    scene.add_light("point", from_=(0, 3, 0), power=100)
    scene.camera = velo.Camera(48, 36, eye=(0, 2, 4), lookat=(0, 0.2, 0), fov=0.7)
    return scene, group


def look(scene):
    image = scene.render(spp=2, channels=["Z", "id.instance", "albedo"])
    return numpy.concatenate([numpy.asarray(image).ravel(), image["Z"].ravel(), image["albedo"].ravel()]), image["id.instance"]


@case
def instances_are_moved_hidden_shown_added_and_removed():
    scene, group = room()
    first, second = scene.add_instance(group, at(-0.8)), scene.add_instance(group, at(0.8))
    assert first.family == "instances" and scene.handles("instances") == [first, second] and first != second
    assert set(numpy.unique(look(scene)[1])) == {0, 1, 2}
    scene.hide(first)
    assert set(numpy.unique(look(scene)[1])) == {0, 1}
    scene.show(first)
    scene.set(first, transform=at(-0.4, 0.5))
    assert numpy.array_equal(scene.transform(first), at(-0.4, 0.5))
    third = scene.add_instance(group, at(0, 0, -1))
    scene.remove(second)
    assert scene.handles("instances") == [first, third]
    with raises(velo.UsageError, "instance"):
        scene.show(second)
    mine = look(scene)[0]
    other, group = room()
    other.add_instance(group, at(-0.4, 0.5))
    other.add_instance(group, at(0, 0, -1))
    assert numpy.array_equal(mine, look(other)[0])


@case
def materials_textures_lights_and_shapes_change():
    scene, group = room()
    scene.add_instance(group, at(0))
    before = look(scene)[0]
    paint = scene.find("materials", "paint")
    assert paint.kind == "diffuse" and paint.name == "paint"
    floor = scene.find("shapes", "floor")
    sky, lamp = scene.handles("lights")
    assert (sky.kind, lamp.kind) == ("infinite", "point") and sky.name is None
    seen = [before]

    def differs():
        seen.append(look(scene)[0])
        return not any(numpy.array_equal(seen[-1], old) for old in seen[:-1])

    scene.set(paint, reflectance=(0.9, 0.1, 0.1))
    assert differs()
    texture = scene.add_texture("image", image=numpy.full((2, 2, 3), 200, dtype=numpy.uint8))
    scene.set(paint, "principled", reflectance=texture, roughness=0.3)
    assert paint.kind == "principled" and differs()
    scene.set(texture, image=numpy.full((2, 2, 3), 20, dtype=numpy.uint8))
    assert differs()
    scene.set(texture, "checkerboard", su=4, sv=4)
    assert differs()
    scene.set(lamp, power=300, from_=(1, 2, 0))
    assert differs()
    scene.set(sky, scale=0.3)
    assert differs()
    scene.set(sky, image=numpy.ones((8, 8, 3), dtype=numpy.float32))
    assert differs()
    scene.hide(lamp)
    assert differs()
    scene.set(floor, material=scene.find("materials", "white"))
    assert differs()
    scene.set(floor, emission=scene.add_emission(radiance=(0.1, 0.2, 0.3)))
    assert differs()
    scene.hide(floor)
    assert differs()
    for handle, keywords, text in ((paint, dict(roughnes=1), "roughness"), (floor, dict(radius=1), "radius"),
                                   (group, dict(name="x"), "groups cannot be changed"), (sky, dict(medium=paint), "media")):
        with raises(velo.UsageError, text):
            scene.set(handle, **keywords)
    with raises(velo.UsageError, "another scene"):
        velo.Scene().hide(floor)
    with raises(velo.UsageError, "not materials"):
        scene.hide(paint)
    with raises(velo.UsageError, 'did you mean "paint"'):
        scene.find("materials", "pain")
    with raises(velo.UsageError, "transform", "nan"):
        scene.set(scene.handles("instances")[0], transform=numpy.full((4, 4), numpy.nan))
    scene.render(spp=1)  # the scene is still whole


@case
def a_changed_scene_has_the_bits_of_a_new_one():
    scene, group = room()
    scene.add_instance(group, at(0))
    look(scene)
    scene.set(scene.find("materials", "paint"), reflectance=(0.2, 0.4, 0.6))
    scene.set(scene.handles("lights")[1], power=50)
    other, group = room()
    other.add_instance(group, at(0))
    other.set(other.find("materials", "paint"), reflectance=(0.2, 0.4, 0.6))
    other.set(other.handles("lights")[1], power=50)
    assert numpy.array_equal(look(scene)[0], look(other)[0])


@case
def worlds_share_what_has_not_changed():
    def fresh():
        scene = velo.Scene()
        group = scene.add_group("terrain")
        scene.add_mesh(*terrain(300), group=group)
        scene.add_light("infinite", color=(1, 1, 1))
        scene.camera = velo.Camera(64, 48, eye=(0, 2, 3), lookat=(0, 0, 0), fov=0.8)
        return scene, group

    def seconds(call):
        """Processor time."""
        start = time.process_time()
        call()
        return time.process_time() - start

    scene, group = fresh()
    item = scene.add_instance(group, at(0))
    first = seconds(scene.world)
    image = numpy.array(scene.render(spp=1))
    held = scene.context.memory
    scene.set(item, transform=at(0.5))
    again = seconds(scene.world)
    other, group = fresh()
    other.add_instance(group, at(0))
    shared = seconds(lambda: other.world(previous=scene.world()))
    assert numpy.array_equal(image, numpy.asarray(other.render(spp=1)))
    print("  build %.3f s, moved %.3f s, another scene %.3f s" % (first, again, shared))
    assert again < 0.3 * first and shared < 0.7 * first
    assert scene.context.memory - held < 40e6  # the other scene's own arrays; the worlds share theirs
    scene.close()  # the other world keeps what it shares
    assert numpy.array_equal(image, numpy.asarray(other.render(spp=1)))
    with raises(velo.UsageError, "closed"):
        world = other.world()
        world.close()
        room()[0].world(previous=world)


# ---- coarse images --------------------------------------------------------------------------------------------------

@case
def coarse_images_come_first():
    scene = velo.load(cases.PINHOLE)
    images = list(scene.passes(spp=2, resolution=(100, 75), coarse=(8, 4, 2), channels=["Z"]))
    assert [(image.width, image.height) for image in images] == [(13, 10), (25, 19), (50, 38), (100, 75), (100, 75)]
    assert numpy.array_equal(numpy.asarray(images[-1]), numpy.asarray(scene.render(spp=2, resolution=(100, 75), channels=["Z"])))
    depth, small = images[-1]["Z"], images[1]["Z"]
    near = numpy.isfinite(small[2:-2, 2:-2])
    # Pixel (x, y) covers the pixels from (4 x, 4 y) on, so its centre is a corner of four of them.
    mean = sum(depth[a::4, b::4][:18, :25] for a in (1, 2) for b in (1, 2)) / 4
    error = numpy.abs(mean[2:17, 2:-2] - small[2:17, 2:-2])[near[:15]]
    assert numpy.median(error / small[2:17, 2:-2][near[:15]]) < 0.01
    camera = scene.camera.resize(100, 75)
    k = camera.coarse(4).K
    assert numpy.allclose(k[:2], camera.K[:2] / 4) and camera.coarse(4).resolution == (25, 19)
    with raises(velo.UsageError, "1 to 64"):
        camera.coarse(0)


# ---- the choice of a tracer -----------------------------------------------------------------------------------------

@case
def auto_is_the_tracer_that_wins_the_race():
    scene = velo.load(os.path.join(os.path.dirname(cases.PINHOLE), "..", "features", "two_way.pbrt"))
    size, crop = (216, 160), (80, 64, 96, 80)
    chosen, trials = scene.choose_tracer(spp=32, resolution=size)
    assert chosen["tracer"] == "bidirectional" and len(trials) >= 3 and trials[0]["work"] == 1, (chosen, trials)
    assert min(trial["work"] for trial in trials) < 0.85
    assert scene.choose_tracer(spp=32, resolution=size, seed=7) == (chosen, trials)
    keywords = dict(spp=32, resolution=size, crop=crop)
    auto = numpy.asarray(scene.render(tracer="auto", **keywords))
    assert numpy.array_equal(auto, numpy.asarray(scene.render(**chosen, **keywords)))
    assert not numpy.array_equal(auto, numpy.asarray(scene.render(tracer="path", **keywords)))
    assert scene.choose_tracer(spp=1, resolution=(16, 16)) == ({"tracer": "volpath", "light_paths": 0xffffffff}, [])
    with raises(velo.UsageError, "has samples"):
        scene.render(tracer="auto", film=scene.film, spp=64, resolution=size)


if __name__ == "__main__":
    cases.main()
