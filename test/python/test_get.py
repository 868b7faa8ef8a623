#!/usr/bin/python3
"""Objects of a scene are read back: what get returns makes the same object again, of every kind, and sets it without a change."""
import cases
from cases import case, raises

numpy = cases.need("numpy")
import velo


def same(a, b):
    """Whether two values that get returns are equal."""
    if isinstance(a, velo.Image):
        return a.encoding == b.encoding and a.channels == b.channels and numpy.array_equal(numpy.asarray(a), numpy.asarray(b))
    if isinstance(a, numpy.ndarray):
        return a.dtype == b.dtype and numpy.array_equal(a, b)
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[name], b[name]) for name in a)
    return a == b


def arrays(seed, *shape):
    return numpy.random.default_rng(seed).random(shape, dtype=numpy.float32)


SHAPES = {
    "triangles": dict(positions=[[0, 0, 0], [1, 0, 0], [0, 1, 0]], indices=[[0, 1, 2]], normals=[[0, 0, 1]] * 3,
                      uvs=[[0, 0], [1, 0], [0, 1]], tangents=[[1, 0, 0]] * 3, tangent_signs=[1, -1, 1], colors=arrays(1, 3, 4),
                      positions_close=[[0, 0, 1], [1, 0, 0], [0, 1, 0]], normals_close=[[0, 0, 1]] * 3, times=(0, 2)),
    "bilinear": dict(positions=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5]], indices=[[0, 1, 2, 3]]),
    "sphere": dict(centers=[[0, 0, 0], [1, 2, 3]], radii=[1, 2]), "disk": dict(radius=2, inner_radius=1), "cylinder": dict(radius=0.5),
    "curves": dict(positions=arrays(2, 4, 3), widths=[[0.1, 0.2]]),
}
LIGHTS = {"goniometric": dict(image=arrays(3, 8, 8)), "projection": dict(image=arrays(4, 8, 8, 3)),
          "infinite": dict(image=arrays(5, 8, 8, 3), portal=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
          "spot": {"color": velo.rgb(1, 0.5, 0.25, space="rec2020"), "scale": 3, "from_": (0, 1, 2)},
          "point": {"color": velo.sampled([400, 500, 700], [1, 2, 0.5], scale=2), "power": 60}}
TEXTURES = {"image": dict(image=arrays(6, 4, 4, 3), wrap="clamp", wrap_t="black", tint=(1, 0.5, 0.25, 1), encoding="linear"),
            "checkerboard": dict(spectrum_a=(0.5, 0.25, 0.125), su=3), "dots": dict(st_from_uv=[[2, 0, 0], [0, 3, 0.5]])}
MEDIA = {"grid": dict(density=arrays(7, 2, 3, 4), transform=numpy.diag([2.0, 2, 2, 1])),
         "rgb_grid": dict(rgb_a=arrays(8, 2, 2, 2, 3), rgb_s=arrays(9, 2, 2, 2, 3)), "nanovdb": dict(path="smoke.nvdb")}


def keywords_of(scene, family, kind):
    if family == "materials":
        if kind == "mix":
            return dict(materials=[scene.add_material("diffuse"), scene.add_material("conductor")])
        if kind == "measured":
            return dict(measured="brdf.bsdf")
        if kind == "principled":
            return dict(reflectance=scene.add_texture("image", image=arrays(1, 2, 2, 3)), roughness=0.25, name="paint")
    if family == "shapes":
        return dict(SHAPES[kind], material=scene.add_material("diffuse"), name="shape", transform=numpy.diag([1.0, 2, 3, 1]))
    return {"lights": LIGHTS, "textures": TEXTURES, "media": MEDIA}.get(family, {}).get(kind, {})


ADD = {"textures": "add_texture", "materials": "add_material", "media": "add_medium", "lights": "add_light", "shapes": "add_shape"}


@case
def every_kind_comes_back():
    count = 0
    for family, add in ADD.items():
        for kind in velo.kinds(family):
            scene = velo.Scene()
            try:
                handle = getattr(scene, add)(kind, **keywords_of(scene, family, kind))
            except velo.SceneError as error:
                raise AssertionError("%s %s: %s" % (family, kind, error))
            values = scene.get(handle)
            again = getattr(scene, add)(handle.kind, **values)
            assert same(scene.get(again), values), (family, kind, values, scene.get(again))
            scene.set(handle, **values)
            assert same(scene.get(handle), values), (family, kind)
            count += 1
    assert count > 40, count


@case
def spectra_of_every_form_come_back():
    scene = velo.Scene()
    given = [velo.rgb(1, 0.5, 0.25, scale=2, space=space) for space in ("srgb", "dci_p3", "rec2020", "aces2065_1")]
    given += [velo.blackbody(3000, scale=0.5), velo.named("stdillum-D65", scale=4)]
    for spectrum in given:
        got = scene.get(scene.add_light("point", color=spectrum))["color"]
        assert got == spectrum, (got, spectrum)


@case
def values_are_those_that_were_given():
    scene = velo.Scene()
    texels = arrays(1, 4, 6, 3)
    image = scene.add_texture("image", image=texels)
    paint = scene.add_material("principled", reflectance=image, roughness=0.25, metallic=0.5, name="paint")
    assert scene.get(paint, "reflectance") == image and scene.get(paint, "roughness") == 0.25 and scene.get(paint)["name"] == "paint"
    assert numpy.array_equal(scene.get(image, "image"), texels)
    scene.get(image, "image")[...][:] = 0  # a copy
    assert numpy.array_equal(scene.get(image, "image"), texels)
    metal = scene.add_material("conductor", eta="metal-Au-eta", k=velo.sampled([400, 700], [2, 3], scale=2))
    assert scene.get(metal, "eta") == velo.named("metal-Au-eta") and scene.get(metal, "k") == velo.sampled((400, 700), (2, 3), scale=2)
    assert "reflectance" not in scene.get(metal)
    lamp = scene.add_light("spot", from_=(0, 1, 2), to=(0, 0, 0), color=velo.blackbody(3000), scale=4)
    values = scene.get(lamp)
    assert values["from"] == (0, 1, 2) and values["color"] == velo.blackbody(3000) and values["scale"] == 4 and values["power"] is None
    glow = scene.add_emission(radiance=(4, 3, 2))
    assert scene.get(glow, "radiance") == velo.rgb(4, 3, 2)
    ball = scene.add_sphere((1, 2, 3), 0.5, material=paint, emission=glow)
    assert scene.get(ball, "radius") == 0.5 and scene.get(ball, "emission") == glow and scene.get(ball, "transform")[:3, 3].tolist() == [1, 2, 3]
    group = scene.add_group("g")
    rests = scene.add_instance(group, numpy.eye(4))
    moves = scene.add_instance(group, [numpy.eye(4), numpy.diag([2.0, 2, 2, 1])], times=[0, 1])
    assert scene.get(rests, "group") == group and scene.get(group) == {} and "times" not in scene.get(rests)
    assert scene.get(moves, "transform").shape == (2, 4, 4) and scene.get(moves, "times").tolist() == [0, 1]
    assert same(scene.get(scene.add_instance(**scene.get(moves))), scene.get(moves))
    with raises(velo.UsageError, "rough", 'did you mean "roughness"'):
        scene.get(paint, "roughnes")
    scene.remove(rests)
    with raises(velo.UsageError, "removed"):
        scene.get(rests)
    with raises(velo.UsageError, "another scene"):
        velo.Scene().get(paint)


@case
def a_lamp_file_in_memory_comes_back():
    lamp = b"TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 180\n0\n5 5\n"
    scene = velo.Scene()
    words = scene.get(scene.add_light("goniometric", lamp_data=lamp, scale=2))
    assert words["lamp_data"] == lamp and words["scale"] == 2, words
    raises(TypeError, "lamp_data", lambda: scene.add_light("goniometric", lamp_data=7))
    raises(ValueError, "both", lambda: scene.add_light("goniometric", lamp_data=lamp, path="a.ies"))


@case
def a_scene_of_a_file_comes_back():
    """All objects of a file made again in a new scene: the same image."""
    scene = velo.load(cases.PINHOLE)
    other, made = velo.Scene(), {}

    def copy(value):
        if isinstance(value, velo.Handle):
            return made[value.family, value.index]
        return tuple(copy(item) for item in value) if isinstance(value, tuple) else value

    for family in ("textures", "media", "materials", "emission", "lights", "groups", "shapes", "instances"):
        for handle in scene.handles(family):
            keywords = {name: copy(value) for name, value in scene.get(handle).items()}
            if family == "groups":
                new = other.add_group(handle.name)
            elif family == "instances":
                new = other.add_instance(**keywords)
            elif family == "emission":
                new = other.add_emission(**keywords)
            else:
                new = getattr(other, ADD[family])(handle.kind, **keywords)
            made[family, handle.index] = new
    other.camera = scene.camera
    a, b = (numpy.asarray(one.render(spp=4, resolution=(64, 48), max_depth=5)) for one in (scene, other))
    assert a.any() and numpy.array_equal(a, b)


@case
def grids_keep_to_their_arrays():
    scene = velo.Scene()
    for keywords, text in ((dict(density=arrays(1, 2, 2, 2), nx=100), "nx: the size of a grid is that of its arrays"),
                           (dict(density=arrays(1, 1, 1, 1), temperature=arrays(1, 2, 2, 2)), "differ in size"),
                           (dict(density=arrays(1, 2, 2, 2), temperature=arrays(1, 1, 1, 1)), "differ in size")):
        with raises(velo.UsageError, text):
            scene.add_medium("grid", **keywords)
    smoke = scene.add_medium("grid", density=arrays(1, 2, 2, 2))
    scene.set(smoke, density=arrays(2, 3, 4, 5))
    assert scene.get(smoke, "density").shape == (3, 4, 5)


if __name__ == "__main__":
    cases.main()
