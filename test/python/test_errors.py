#!/usr/bin/python3
"""After an error of any method a scene is as it was: bad calls in the midst of good ones leave an image with the same bytes, and take
no memory."""
import cases
from cases import attempt, case, limited, raises, report, work

numpy = cases.need("numpy")
import velo

import test_hostile
from test_hostile import ANYTHING, CALLS, FACES, OBJ, QUAD, REFUSED, quad_scene, slots

cases.cases.clear()  # those of test_hostile are its own

NAN = float("nan")


def image_of(scene):
    image = scene.render(spp=1, resolution=(8, 8), channels=["Z", "id.object", "id.instance"])
    return b"".join(numpy.ascontiguousarray(image[name]).tobytes() for name in ("R", "G", "B", "Z", "id.object", "id.instance"))


def grow(scene):
    """Good calls, after which more of the scene's content shows."""
    red = scene.add_material("diffuse", reflectance=(0.7, 0.1, 0.1), name="red")
    scene.add_sphere((0.5, 0.5, 0.2), 0.3, material=red)
    group = scene.load_group(OBJ, "corner").group
    scene.add_instance(group, [[0.5, 0, 0, -0.4], [0, 0.5, 0, 0.4], [0, 0, 0.5, 0.3], [0, 0, 0, 1]])
    return image_of(scene)


EXPECTED = image_of(quad_scene())
GROWN = grow(quad_scene())


@case
@limited
def every_argument_of_every_method():
    """All wrong values on one scene. A call that accepts a value may change the scene: the next one begins anew."""
    problems, refused, checked = [], 0, 0
    for call in CALLS:
        if call.make is not quad_scene or call.name == "Scene.close":
            continue
        scene, trouble = quad_scene(), []
        before = scene.info
        call.make = lambda: scene
        for name, kind in slots(call):
            for label, value in {**ANYTHING, **REFUSED[kind]}.items():
                if name == "progress" and callable(value):
                    continue
                result = attempt(call.run, **{name: value})
                if result is not None:
                    refused += 1
                    trouble.append("%s=%s" % (name, label))
                    if scene.info != before:
                        problems.append("%s(%s): %s" % (call.name, trouble[-1], scene.info))
                        scene, trouble = quad_scene(), []
                else:
                    scene, trouble = quad_scene(), []
            if trouble:
                checked += 1
                if image_of(scene) != EXPECTED:
                    problems.append("%s(%s) changes the image" % (call.name, name))
        call.make = quad_scene
        if trouble and grow(scene) != GROWN:
            problems.append("%s changes what is added after it" % call.name)
    print("  %d refused calls, %d images" % (refused, checked))
    assert refused > 1000 and checked > 50
    report(problems)


def broken_files():
    """Files whose errors come late, and the exceptions."""
    with open(work("late.pbrt"), "w") as file:
        file.write('Film "rgb" "integer xresolution" 77 "integer yresolution" 55\nCamera "perspective" "float fov" 10\nWorldBegin\n'
                   'LightSource "point"\nMaterial "diffuse"\nShape "sphere"\nObjectBegin "a"\nShape "sphere"\nObjectEnd\n'
                   'ObjectInstance "a"\nMakeNamedMedium "m" "string type" "homogeneous"\nTexture "t" "spectrum" "constant"\n'
                   'Shape "sphere" "float radius" -1\n')
    with open(work("late.obj"), "w") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n")
    with open(work("empty.obj"), "w") as file:
        file.write("v 0 0 0\n")
    return work("late.pbrt"), work("late.obj"), work("empty.obj"), work("nowhere.gltf")


def bad_calls(scene):
    """Calls that the library's own checks refuse."""
    white, group = scene.handles("materials")[0], scene.handles("groups")[0]
    constant = scene.handles("textures")[0] if scene.handles("textures") else None
    mirrored = [numpy.eye(4), numpy.diag([-1.0, 1, 1, 1])]
    yield lambda: scene.add_mesh(QUAD * numpy.array([1, NAN, 1], dtype="float32"), FACES, name="lost", material=white)
    yield lambda: scene.add_mesh(QUAD, FACES + 2, group=group)
    yield lambda: scene.add_mesh(QUAD, FACES, transform=numpy.zeros((4, 4)))
    yield lambda: scene.add_mesh(QUAD, FACES, positions_close=QUAD, times=(1, 0))
    yield lambda: scene.add_sphere((0, 0, 0), -1)
    yield lambda: scene.add_shape("sphere", radius=1, z_min=1, z_max=-1)
    yield lambda: scene.add_shape("sphere", centers=[[0, 0, 0]], radii=[-1])
    yield lambda: scene.add_material("diffuse", reflectance="no-such-spectrum", name="lost")
    yield lambda: scene.add_material("mix", materials=[white, None])
    yield lambda: scene.add_material("conductor", eta=velo.sampled([500, 400], [1, 2]))
    yield lambda: scene.add_texture("image")
    yield lambda: scene.add_texture("checkerboard", spectrum_a=(0.5, -1, 0), spectrum_b=(1, 1, 1))
    yield lambda: scene.add_light("spot", **{"from": (0, 0, 0), "to": (0, 0, 0)})
    yield lambda: scene.add_light("projection")
    yield lambda: scene.add_light("infinite", image=QUAD[None], portal=[[0, 0, 0]] * 4)
    yield lambda: scene.add_emission(power=-1.0)
    yield lambda: scene.add_medium("grid", density=[[[NAN]]])
    yield lambda: scene.add_instance(group, numpy.full((4, 4), NAN))
    yield lambda: scene.add_instance(group, mirrored, times=[0, 1])
    yield lambda: scene.add_instance(group, [numpy.eye(4)] * 2, times=[1, 0])
    for path in broken_files():
        yield lambda path=path: scene.load(path)
        yield lambda path=path: scene.load_group(path)
    yield lambda: scene.load(OBJ, progress=lambda step: False)
    yield lambda: scene.load_group(OBJ, progress=lambda step: False)
    yield lambda: scene.complete(environment=work("nowhere.exr"))
    yield lambda: scene.set(white, reflectance="no-such-spectrum")
    yield lambda: scene.set(scene.handles("lights")[0], image=QUAD[None], portal=[[0, 0, 0]] * 4)
    yield lambda: scene.render(spp=1, tracer="nothing")
    yield lambda: scene.render(spp=1, channels=["nothing"])


@case
@limited
def calls_that_the_library_refuses():
    scene = quad_scene()
    kept = scene.render(spp=2).parts and scene.film
    info, size = scene.info, scene.camera.resolution
    problems = []
    for number, call in enumerate(bad_calls(scene)):
        result = attempt(call)
        if not isinstance(result, velo.Error):
            problems.append("call %d: %s" % (number, result))
        if scene.info != info or scene.camera.resolution != size:
            problems.append("call %d leaves %s, %s (%s)" % (number, scene.info, scene.camera.resolution, result))
        if scene.film is not kept:
            problems.append("call %d replaces the film" % number)
    report(problems)
    assert image_of(scene) == EXPECTED
    for _ in bad_calls(scene):
        pass
    assert grow(scene) == GROWN


@case
def a_callback_that_raises():
    def fail(step):
        raise ZeroDivisionError("mine")

    scene = quad_scene()
    for call in (scene.load, scene.load_group):
        with raises(ZeroDivisionError, "mine"):
            call(OBJ, progress=fail)
    assert grow(scene) == GROWN


@case
def refused_calls_take_no_memory():
    scene = quad_scene()
    big = numpy.zeros((200000, 3), dtype="float32")
    faces = numpy.array([[0, 1, 2]])
    context = scene.context

    def refuse():
        for _ in range(20):
            with raises(velo.SceneError, "there are only"):
                scene.add_mesh(big, faces + 200000)
            with raises(velo.SceneError, "no-such"):
                scene.add_material("diffuse", reflectance="no-such", name="x" * 1000)
            with raises(velo.Error):
                scene.load(work("late.pbrt"))

    broken_files()
    refuse()
    before = context.memory
    refuse()
    assert context.memory == before, (context.memory, before)
    assert grow(scene) == GROWN


if __name__ == "__main__":
    cases.main()
