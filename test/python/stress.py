#!/usr/bin/python3
"""Stress of the Python module, for tools/check_python: many renders in one process, threads, exceptions in callbacks, changes of
scenes, Ctrl-C at random moments. Usage: stress.py [--renders N] [--seconds S] [--seed N]. Prints lines ok NAME, not ok NAME."""
import argparse
import gc
import os
import random
import signal
import sys
import threading
import time

import cases
from cases import case, work

numpy = cases.need("numpy")
import velo

parser = argparse.ArgumentParser()
parser.add_argument("--renders", type=int, default=100)
parser.add_argument("--seconds", type=float, default=5)
parser.add_argument("--seed", type=int, default=1)
options = parser.parse_args()
del sys.argv[1:]

QUAD = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=numpy.float32)
FACES = [[0, 1, 2], [0, 2, 3]]


class Planned(Exception):
    """Raised by callbacks."""


def resident():
    with open("/proc/self/status") as file:
        return int(next(line for line in file if line.startswith("VmRSS")).split()[1]) / 1024


def small_scene(draw):
    scene = velo.Scene()
    material = scene.add_material("diffuse", reflectance=scene.add_texture("image", image=numpy.full((4, 4, 3), draw.random(), "float32")))
    group = scene.add_group("quad")
    scene.add_mesh(QUAD, FACES, group=group, material=material)
    scene.add_instance(group, numpy.eye(4))
    scene.add_light("infinite", color=(1, 1, 1))
    scene.camera = velo.Camera(24, 18, eye=(0, 0, 3), lookat=(0, 0, 0), fov=0.8)
    return scene


def callback(draw):
    """At random: goes on, ends the call, raises, uses velo."""
    def called(state):
        number = draw.random()
        if number < 0.1:
            raise Planned("planned")
        if number < 0.2:
            return False
        if number < 0.3:
            velo.Camera(8, 8, fov=0.5).project([[0, 0, -1]])
        if number < 0.35:
            small_scene(draw).render(spp=1, resolution=(4, 4))
        return True
    return called


def change(scene, draw):
    instances = scene.handles("instances")
    item = draw.choice(instances) if instances else None
    light, material = scene.handles("lights")[0], scene.handles("materials")[0]
    action = draw.randrange(8)
    if action == 0 and item:
        scene.set(item, transform=numpy.diag([1, 1, 1, 1]) + numpy.eye(4, k=3) * draw.random())
    elif action == 1 and item:
        scene.show(item, draw.random() < 0.5)
    elif action == 2 and item:
        scene.remove(item)
    elif action == 3:
        scene.add_instance(scene.handles("groups")[0], numpy.eye(4))
    elif action == 4:
        scene.set(light, scale=draw.random())
    elif action == 5:
        scene.set(material, draw.choice(["diffuse", "principled"]), reflectance=(draw.random(), 0.5, 0.5))
    elif action == 6:
        scene.set(scene.handles("textures")[0], image=numpy.full((2, 2, 3), draw.random(), "float32"))
    else:
        scene.set(light, image=numpy.full((4, 4, 3), draw.random(), "float32"))


def one(scene, draw):
    """A random call."""
    action = draw.randrange(9)
    size = (draw.randrange(1, 40), draw.randrange(1, 30))
    if action == 0:
        velo.load(cases.PINHOLE, progress=callback(draw)).world(progress=callback(draw))
    elif action == 1:
        scene.render(spp=draw.choice([1, 2, 64]), resolution=size, progress=callback(draw), channels=["Z", "id.instance"])
    elif action == 2:
        scene.ground_truth(["Z", "N", "albedo", "id.object"], resolution=size)
    elif action == 3:
        scene.boxes(resolution=size)
    elif action == 4:
        for image in scene.passes(spp=2, resolution=size, coarse=(4,)):
            image["R"].sum()
    elif action == 5:
        change(scene, draw)
    elif action == 6:
        image = scene.render(spp=1, resolution=size)
        path = work("stress%d.exr" % threading.get_ident())
        image.write(path)
        velo.read_image(path).compare(image)
    elif action == 7:
        scene.world(previous=small_scene(draw).world())
    else:
        try:
            scene.render(spp="x")
        except velo.UsageError:
            pass


EXPECTED = (Planned, velo.CancelledError, velo.UsageError)


@case
def memory_does_not_grow_with_renders():
    draw = random.Random(options.seed)
    scene = small_scene(draw)
    scenes = [scene]

    def renders(count):
        for number in range(count):
            if number % 50 == 49:
                scenes[0] = small_scene(draw)
            image = scenes[0].render(spp=1, resolution=(24, 18), seed=number, channels=["Z"], progress=lambda state: None)
            image["Z"].sum()
            scenes[0].set(scenes[0].handles("instances")[0], transform=numpy.eye(4))
        scenes[0] = small_scene(draw)
        gc.collect()

    renders(100)
    held, size = velo.default_context().memory, resident()
    renders(options.renders)
    grown = resident() - size
    print("  %d renders: %+d bytes held, %+.1f MB resident" % (options.renders, velo.default_context().memory - held, grown))
    assert velo.default_context().memory == held
    # The address sanitizer keeps freed memory for a while.
    assert grown < (64 if "asan" in os.environ.get("LD_PRELOAD", "") else 4), grown


@case
def threads_callbacks_and_changes():
    """Each thread with a scene of its own, and all with a shared one."""
    shared, failures, counts = small_scene(random.Random(0)), [], [0]
    end = time.monotonic() + options.seconds

    def run(number):
        draw = random.Random(options.seed * 1000 + number)
        own = small_scene(draw)
        while time.monotonic() < end:
            try:
                one(draw.choice([own, own, shared]), draw)
                counts[0] += 1
            except EXPECTED:
                pass
            except velo.SceneError:  # the shared scene, after an error of another thread
                own = small_scene(draw)
            except BaseException as error:
                failures.append(repr(error))
                return

    threads = [threading.Thread(target=run, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print("  %d calls" % counts[0])
    assert not failures and counts[0] > 5, failures


@case
def ctrl_c_at_random_moments():
    draw, end = random.Random(options.seed), time.monotonic() + options.seconds
    ended, hits, calls = threading.Event(), [0], [0]
    signals = random.Random(options.seed + 1)

    def interrupt():
        while not ended.wait(signals.random() * 0.05):
            os.kill(os.getpid(), signal.SIGINT)

    armed = [False]

    def handler(*unused):
        # Once for each pass of the loop below: an exception in its handlers would end it.
        if armed[0]:
            armed[0] = False
            raise KeyboardInterrupt

    previous = signal.signal(signal.SIGINT, handler)
    scene = small_scene(draw)
    thread = threading.Thread(target=interrupt)
    thread.start()
    while time.monotonic() < end:
        try:
            try:
                armed[0] = True
                one(scene, draw)
                calls[0] += 1
            except EXPECTED:
                pass
            except velo.Error:
                scene = small_scene(draw)
            finally:
                armed[0] = False
        except KeyboardInterrupt:
            hits[0] += 1
    ended.set()
    thread.join()
    signal.signal(signal.SIGINT, previous)
    print("  %d calls done, %d interrupted" % (calls[0], hits[0]))
    assert hits[0] > 3
    image = small_scene(draw).render(spp=1)
    assert numpy.isfinite(numpy.asarray(image)).all()


if __name__ == "__main__":
    cases.main()
