#!/usr/bin/python3
"""Arrays as textures: every type of numbers, ranges, and what is refused. Values are read from the albedo of a wall."""
import cases
from cases import case, raises

numpy = cases.need("numpy")
import velo


def shown(color=True, **keywords):
    """The albedo of a wall with a texture of one value."""
    scene = velo.Scene()
    texture = scene.add_texture("image", spectrum=color, **keywords)
    if not color:
        texture = scene.add_texture("mix", spectrum_a=(0, 0, 0), spectrum_b=(1, 1, 1), amount=texture)
    scene.add_mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]],
                   material=scene.add_material("diffuse", reflectance=texture))
    scene.add_light("infinite")
    scene.camera = velo.Camera(4, 4, eye=(0, 0, 1), lookat=(0, 0, 0), fov=0.5)
    return float(numpy.asarray(scene.ground_truth(["albedo"], color="rgb")["albedo"])[1, 1, 0])


@case
def a_mesh_has_several_sets_of_uvs():
    halves = numpy.zeros((1, 2, 3), dtype="float32")
    halves[0, 1] = 0.5
    for number, expected in ((0, 0.0), (1, 0.5), (2, 0.0), (3, 0.5)):
        scene = velo.Scene()
        texture = scene.add_texture("image", image=halves, filter="point", uv_set=number)
        sets = [numpy.full((3, 2), place, dtype="float32") for place in (0.25, 0.75, 0.25, 0.75)]
        scene.add_mesh([[-1, -1, 0], [3, -1, 0], [-1, 3, 0]], [[0, 1, 2]], uvs=sets[0], uvs_1=sets[1], uvs_2=sets[2], uvs_3=sets[3],
                       material=scene.add_material("diffuse", reflectance=texture))
        scene.add_light("infinite")
        scene.camera = velo.Camera(4, 4, eye=(0, 0, 1), lookat=(0, 0, 0), fov=0.5)
        seen = scene.ground_truth(["albedo"], color="rgb")["albedo"]
        assert near(float(numpy.asarray(seen)[1, 1, 0]), expected), number
    with raises(velo.UsageError, "uvs_1: 3 elements"):
        velo.Scene().add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], uvs_1=[[0, 0]])


def full(value, kind):
    return numpy.full((2, 2, 3), value, dtype=kind)


def near(value, expected, tolerance=2e-3):
    return abs(value - expected) < tolerance


@case
def types_have_their_range():
    assert near(shown(image=full(128, "uint8")), 0.2158)  # sRGB
    assert near(shown(image=full(128, "uint8"), encoding="linear"), 128 / 255)
    assert near(shown(image=full(32768, "uint16")), 0.5)
    for kind in ("float16", "float32", "float64", "longdouble", ">f4", ">f8"):
        assert near(shown(image=full(0.25, kind)), 0.25), kind
    assert near(shown(image=full(16384, ">u2")), 0.25)
    assert near(shown(image=full(True, "bool")), 1)


@case
def ranges_say_what_0_and_1_are():
    for kind in ("uint8", "int8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float16", "float32", "float64", ">i4"):
        assert near(shown(image=full(64, kind), range=(0, 128)), 0.5), kind
    assert near(shown(image=full(-5.0, "float32"), range=(-10, 10)), 0.25)
    assert near(shown(image=full(0.25, "float32"), range=(0, 1)), 0.25)
    assert near(shown(image=full(64.0, "float32"), scale=1 / 128), 0.5)


@case
def numbers_without_a_range_are_refused():
    for image, text in ((full(128.0, "float32"), "from 128.0 to 128.0, a colour texture holds 0 to 1: give range="),
                        (full(-0.5, "float64"), "from -0.5 to -0.5"), (full(1.0, "float16") * 2, "2.0"),
                        (full(128, "int64"), "only uint8 and uint16"), (full(1, "uint32"), "range=(low, high)"),
                        (full(numpy.nan, "float32"), "finite"), (full(numpy.inf, "float32"), "finite"),
                        (full(1, "complex64"), "image"), ("text", "image"), (None, "image"), (5, "image"),
                        (numpy.zeros((0, 2, 3), "float32"), "rows")):
        with raises(velo.UsageError, text):
            shown(image=image)
    for limits, text in (((1, 0), "low below high"), ((0, 0), "low below high"), ((0,), "range"), ("ab", "range"), (5, "range"),
                         ((0, numpy.nan), "range"), ((0, numpy.inf), "range"), ((None, 1), "range")):
        with raises(velo.UsageError, text):
            shown(image=full(1, "uint8"), range=limits)
    with raises(velo.UsageError, "a velo.Image has its own numbers"):
        shown(image=velo.Image(full(1, "uint8")), range=(0, 1))
    with raises(velo.UsageError, "no image"):
        velo.Scene().add_texture("checkerboard", range=(0, 1))


@case
def float_textures_hold_any_number():
    """Roughness, heights, factors: only colours are bounded."""
    scene = velo.Scene()
    for value in (-3.0, 0.5, 128.0):
        heights = scene.add_texture("image", spectrum=False, image=full(value, "float32"))
        assert float(numpy.asarray(scene.get(heights, "image"))[0, 0, 0]) == value
    assert near(shown(False, image=full(0.25, "float32")), 0.25)
    with raises(velo.UsageError, "finite"):
        scene.add_texture("image", spectrum=False, image=full(numpy.nan, "float32"))
    with raises(velo.UsageError, "only uint8 and uint16"):
        scene.add_texture("image", spectrum=False, image=full(3, "int64"))


@case
def changed_textures_obey_the_same_rules():
    scene = velo.Scene()
    texture = scene.add_texture("image", image=full(0.5, "float32"))
    with raises(velo.UsageError, "from 128.0"):
        scene.set(texture, image=full(128.0, "float32"))
    scene.set(texture, image=full(64, "int64"), range=(0, 256))
    assert float(numpy.asarray(scene.get(texture, "image"))[0, 0, 0]) == 0.25
    assert "range" not in scene.get(texture)


if __name__ == "__main__":
    cases.main()
