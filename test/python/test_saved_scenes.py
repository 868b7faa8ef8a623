#!/usr/bin/python3
"""Written scenes, glTF and pbrt: whatever an image texture of a material, of coverage or of a lamp has (factor, inversion, channel,
threshold, map, curve and so on), and what else one of the formats lacks, the scene that is read from the written file gives the
same image, or the writer says what it loses. The file keeps the rules of its format."""
import cases
from cases import broken_rules, case, work

numpy = cases.need("numpy")
import velo

CORNERS = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=numpy.float32)
FACES = numpy.array([[0, 1, 2], [0, 2, 3]])
UVS = (CORNERS[:, :2] + 1) / 2
CAMERA = {"eye": (0.3, -0.4, 3), "lookat": (0, 0, 0), "fov": 0.6}

# What differs from a texture that glTF has. A map is seen by its own texels alone where it is wrapped.
CHANGES = {"nothing": {}, "scale": {"scale": 0.5}, "invert": {"invert": True}, "tint": {"tint": (0.3, 0.5, 0.7, 0.9)}, "bias": {"bias": 0.1},
           **{f"channel {i}": {"channel": i} for i in range(4)}, "cutoff": {"cutoff": 0.5}, "su": {"su": 2.0}, "dv": {"dv": 0.3},
           "clamp": {"wrap": "clamp", "su": 2.0}, "black": {"wrap": "black", "su": 2.0}, "wrap_t": {"wrap_t_given": True, "wrap_t": "clamp", "sv": 2.0},
           "point": {"filter": "point"}, "linear": {"encoding_given": True, "encoding": "linear"},
           "gamma": {"encoding_given": True, "encoding": "gamma", "gamma": 1.5}, "spherical": {"mapping": "spherical"}, "planar": {"mapping": "planar"}}
BASE = {"metallic": 0.2, "roughness": 0.4, "specular": 0.7, "clearcoat": 0.5, "clearcoat_roughness": 0.3}
# Of each input: its channel in glTF (None: a colour) and what else shows it.
INPUTS = {"reflectance": (None, {"metallic": 0.0}), "sheen_color": (None, {"sheen_roughness": 0.5}), "transmission": (0, {}), "specular": (3, {}),
          "clearcoat_roughness": (1, {"clearcoat": 1.0}), "iridescence_thickness": (1, {"iridescence": 1.0, "metallic": 1.0}),
          "anisotropy": (2, {"metallic": 1.0})}


def write_images():
    numbers = numpy.random.default_rng(3)
    for name in ("a.png", "b.png"):
        texels = numbers.uniform(0.15, 0.85, (8, 8, 4))
        texels[..., 3] = numbers.choice([0.2, 0.6, 1.0], (8, 8))
        velo.Image((texels * 255).astype(numpy.uint8)).write(work(name))
    velo.Image((texels[..., :3] * 255).astype(numpy.uint8)).write(work("c.png"))


def image(scene, number=None, name="a.png", **change):
    """number: the channel of a float texture; None: a colour."""
    words = {"path": work(name), "spectrum": number is None}
    if number is not None:
        words.update(channel=number, encoding_given=True, encoding="linear")
    return scene.add_texture("image", **{**words, **change})


def render(scene):
    return numpy.asarray(scene.render(camera=velo.Camera(16, 16, **CAMERA), spp=16, color="rgb", tracer="path", max_depth=3))


def compare(name, words_of, file="a.gltf"):
    """words_of: from a scene, the keywords of a square. Returns whether the writer lost something."""
    scene = velo.Scene()
    scene.add_light("infinite")
    scene.add_light("point", position=(1, 1, 3), scale=20.0)
    scene.add_mesh(CORNERS, FACES, uvs=UVS, **words_of(scene))
    lost = scene.save(work(file))
    assert not broken_rules(work(file)), f"{name}: {broken_rules(work(file))}"
    before, after = render(scene), render(velo.load(work(file)))
    difference = abs(before - after).mean() / before.mean()
    assert lost or difference < 0.02, f"{name}: {difference:.3f} of the light differs, and nothing is said to be lost"
    return bool(lost)


@case
def inputs():
    kept = 0
    for word, (channel, more) in INPUTS.items():
        for name, change in CHANGES.items():
            def words_of(scene):
                values = {**BASE, **more, word: image(scene, channel, **change)}
                return {"material": scene.add_material("principled", **values)}
            kept += not compare(f"{word}, {name}", words_of)
    assert kept > 60, kept


@case
def metallic_and_roughness_of_one_image():
    for changed in ("metallic", "roughness", "both"):
        for name, change in CHANGES.items():
            def words_of(scene):
                values = {word: image(scene, channel, **(change if changed in (word, "both") else {}))
                          for word, channel in (("metallic", 2), ("roughness", 1))}
                return {"material": scene.add_material("principled", **{**BASE, **values})}
            lost = compare(f"metallic and roughness, {name} of {changed}", words_of)
            assert not lost or name not in ("nothing", "scale", "tint"), (changed, name)


@case
def normal_maps():
    for word in ("normal", "clearcoat_normal"):
        for name, change in CHANGES.items():
            def words_of(scene):
                texture = image(scene, **{"encoding_given": True, "encoding": "linear", **change})
                return {"material": scene.add_material("principled", **{**BASE, "roughness": 0.3, word: texture})}
            compare(f"{word}, {name}", words_of)


@case
def tangents_of_vertices():
    """Those of maps of normals: u leans, and v is on either side of it."""
    for file, kind in (("a.gltf", "principled"), ("a.pbrt", "diffuse")):
        for signs in (None, (1, 1, 1, 1), (-1, -1, -1, -1), (1, -1, -1, 1)):
            def words_of(scene):
                texels = numpy.empty((2, 2, 3), dtype=numpy.uint8)
                texels[...] = (190, 150, 220)
                velo.Image(texels).write(work("tilted.png"))
                if kind == "principled":
                    normal = image(scene, name="tilted.png", encoding_given=True, encoding="linear")
                    material = scene.add_material("principled", **{**BASE, "normal": normal})
                else:
                    material = scene.add_material("diffuse", normal_map=work("tilted.png"))
                words = {"material": material, "tangents": [[0.6, 0.8, 0]] * 4, "normals": [[0, 0, 1]] * 4}
                return words if signs is None else {**words, "tangent_signs": signs}
            compare(f"{file}, signs {signs}", words_of, file)


@case
def coverage():
    """It is the base colour's alpha in glTF."""
    for name, change in CHANGES.items():
        for base in ("a.png", "b.png", None):
            def words_of(scene):
                values = {"metallic": 0.0, "roughness": 0.5}
                if base:
                    values["reflectance"] = image(scene, name=base)
                return {"material": scene.add_material("principled", **values), "alpha": image(scene, 3, **change)}
            lost = compare(f"coverage, {name}, base {base}", words_of)
            assert lost or base == "a.png", name
            assert not lost or base != "a.png" or name not in ("nothing", "scale", "tint", "cutoff"), name


@case
def emission():
    for name, change in CHANGES.items():
        def words_of(scene):
            light = scene.add_emission(texture=image(scene, **change), two_sided=True)
            return {"material": scene.add_material("diffuse"), "emission": light}
        compare(f"emission, {name}", words_of)


@case
def pbrt():
    materials = [("diffuse", "reflectance", None), ("conductor", "reflectance", None), ("diffuse_transmission", "transmittance", None),
                 ("coated_diffuse", "thickness", 1), ("dielectric", "u_roughness", 1), ("diffuse", "displacement", 1)]
    kept = 0
    for name, change in CHANGES.items():
        def lamp_of(scene):
            light = scene.add_emission(texture=image(scene, **change), two_sided=True)
            return {"material": scene.add_material("diffuse"), "emission": light}
        def covered(scene):
            return {"material": scene.add_material("diffuse"), "alpha": image(scene, -1, **change)}
        kept += not compare(f"lamp, {name}", lamp_of, "a.pbrt")
        kept += not compare(f"coverage, {name}", covered, "a.pbrt")
        for kind, word, number in materials:
            def words_of(scene):
                return {"material": scene.add_material(kind, **{word: image(scene, number, **change)})}
            kept += not compare(f"{kind}, {word}, {name}", words_of, "a.pbrt")
    assert kept > 120, kept


@case
def roughness_of_one_number():
    """pbrt's materials have less light between their microfacets, and their colours are raised by a mean roughness: an image of one
    number, times a factor, is that number."""
    def written(metallic, roughness_of):
        scene = velo.Scene()
        scene.add_light("infinite")
        material = scene.add_material("principled", reflectance=(0.6, 0.5, 0.4), metallic=metallic, roughness=roughness_of(scene))
        scene.add_mesh(CORNERS, FACES, uvs=UVS, material=material)
        scene.save(work("one.pbrt"))
        return numpy.asarray(render(velo.load(work("one.pbrt")))).mean(axis=(0, 1))

    def image_of_one(scene, **factor):
        texels = numpy.full((4, 4, 3), 0.8, dtype=numpy.float32)
        return scene.add_texture("image", image=texels, spectrum=False, channel=1, **factor)

    for metallic in (0.0, 1.0):
        number = written(metallic, lambda scene: 0.48)
        assert number.min() > 0.1
        for factor in ({"tint": (0.1, 0.6, 0.3, 1)}, {"scale": 0.6}, {"scale": 0.5, "bias": 0.08}):
            assert numpy.allclose(written(metallic, lambda scene: image_of_one(scene, **factor)), number, rtol=2e-3), (metallic, factor)


@case
def what_gltf_has_not():
    plain = {"position": (0.5, 0.5, 2), "to": (0, 0, 0), "cone_angle": 0.4, "scale": 9.0}

    def diffuse(scene, **words):
        return {"material": scene.add_material("diffuse"), **words}

    def fog(scene):
        return scene.add_medium("homogeneous", sigma_a=(0.1, 0.5, 1.0), sigma_s=(0, 0, 0))

    def in_fog(scene):
        scene.camera_medium = fog(scene)
        return diffuse(scene)

    def lit(scene, **words):
        scene.add_light("spot", **{**plain, **words})
        return diffuse(scene)
    assert not compare("a spot without an edge", lambda scene: lit(scene, cone_delta=0.0))
    for angle, lost in ((numpy.pi / 2, False), (2.0, True)):
        assert compare(f"a spot of {angle}", lambda scene: lit(scene, cone_angle=angle, cone_delta=0.0)) == lost
    assert not compare("a spot with glTF's edge", lambda scene: lit(scene, cone_delta=0.3, cone_squared=True))
    assert compare("a spot with pbrt's edge", lambda scene: lit(scene, cone_delta=0.3))
    assert compare("hidden", lambda scene: diffuse(scene, hidden_from_camera=True))
    assert compare("a medium around the camera", in_fog)
    assert compare("a medium outside", lambda scene: diffuse(scene, outside=fog(scene)))
    for name, alpha in (("a.png", True), ("c.png", False)):
        lost = compare(f"coverage .4 over {name}", lambda scene: {"material": scene.add_material("principled", reflectance=image(scene, name=name)),
                                                                 "alpha": 0.4})
        assert lost == alpha, name
    colors = [[1, 1, 1, 1], [1, 1, 1, 1], [1, 1, 1, 0.2], [1, 1, 1, 0.2]]
    for used in (False, True):
        def tinted(scene):
            base = {"reflectance": image(scene, colors=used), "metallic": 0.0}
            return {"material": scene.add_material("principled", **base), "alpha": image(scene, 3, colors=True), "colors": colors}
        assert compare(f"coverage of vertices, their colours used: {used}", tinted) != used
    for both in (False, True):
        def lamp(scene):
            emission = scene.add_emission(radiance=(2, 0.5, 0.1), two_sided=both)
            return diffuse(scene, emission=emission, one_sided=True)
        assert compare(f"one-sided lamp, emits to both sides: {both}", lamp) == both
    for change in (lit, in_fog):
        assert not compare(change.__name__, change, "a.pbrt"), change


@case
def length_of_a_direction():
    """It has no effect, and files hold it without."""
    for length in (1e-3, 1.0, 40.0):
        def words_of(scene):
            texture = scene.add_texture("direction_mix", spectrum_a=0.9, spectrum_b=0.1, direction=(0, 0.6 * length, 0.8 * length))
            return {"material": scene.add_material("diffuse", reflectance=texture)}
        assert not compare(f"length {length}", words_of, "a.pbrt")


@case
def lights_of_images():
    """pbrt's projection and goniometric lights have no position: it is part of their transform."""
    # z of the light goes to (0.3, 0.4, -0.866), and the position to (-0.7, -0.9, 1.7)
    x, z = numpy.array([0.8, -0.6, 0.0]), numpy.array([0.3, 0.4, -0.75**0.5])
    turned = numpy.eye(4)
    turned[:3, :3] = numpy.stack([x, numpy.cross(z, x), z], axis=1)
    position = turned[:3, :3].T @ (-0.7, -0.9, 1.7)
    for kind in ("projection", "goniometric"):
        def words_of(scene):
            scene.add_light(kind, path=work("c.png"), position=position, world_from_light=turned, scale=40.0)
            return {"material": scene.add_material("diffuse")}
        assert not compare(kind, words_of, "a.pbrt"), kind


@case
def spherical_cameras():
    """The whole sphere in a pbrt file is pbrt's spherical camera; a part of it is lost."""
    for projection, size in (("equirectangular", (16, 8)), ("equal_area", (12, 12))):
        for words, lost in (({}, False), ({"cx": 3.0}, True)):
            scene = velo.Scene()
            scene.add_light("point", position=(1, 1, 3), scale=20.0)
            scene.add_mesh(CORNERS, FACES, material=scene.add_material("diffuse"))
            scene.camera = velo.Camera(*size, projection=projection, eye=(0.2, 0.1, 0.5), lookat=(1, 2, 0), up=(0, 1, 1), **words)
            assert bool(scene.save(work("a.pbrt"))) == lost, (projection, words)
            if not lost:
                before, after = (numpy.asarray(one.render(spp=16)) for one in (scene, velo.load(work("a.pbrt"))))
                assert abs(before - after).mean() < 0.02 * before.mean(), projection


def pose(x, y, angle=0.0, size=1.0):
    """Turned by an angle around z, scaled, then moved."""
    c, s = size * numpy.cos(angle), size * numpy.sin(angle)
    return numpy.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, size, 0], [0, 0, 0, 1]])


def from_above(x):
    """The pose of a camera that looks down from a height of 3."""
    return numpy.array([[1.0, 0, 0, x], [0, -1, 0, 0.1], [0, 0, -1, 3], [0, 0, 0, 1]])


@case
def motions():
    """pbrt has one pair of times for all motions, and two poses of each; what has others is lost, and said."""
    halves = [pose(0.4, 0), pose(0, 0.2), pose(-0.4, 0.4)]
    bent = [pose(0.4, 0), pose(0.1, 0.2), pose(-0.4, 0.4)]
    turn = [pose(0, 0), pose(0.3, 0, 1.2, 0.7)]
    for name, times, poses, camera, lost in (("two poses", (0.1, 0.8), turn, None, []), ("on the way", (0.1, 0.45, 0.8), halves, None, []),
                                             ("bent", (0.1, 0.45, 0.8), bent, None, ["motions over more than two poses"]),
                                             ("camera", (0.1, 0.8), turn, (0.1, 0.8), []),
                                             ("two times", (0.1, 0.8), turn, (0.2, 0.8), ["motions at times of their own"])):
        scene = velo.Scene()
        scene.add_light("infinite")
        group = scene.add_group("cards")
        scene.add_mesh(0.4 * CORNERS, FACES, group=group, material=scene.add_material("diffuse"))
        scene.add_instance(group, poses, times)
        moves = {"world_from_camera": from_above(-0.1), "world_from_camera_close": from_above(0.2), "pose_times": camera, "fov": 0.6}
        scene.camera = velo.Camera(24, 16, shutter_open=0.2, shutter_close=0.7, **(moves if camera else CAMERA))
        assert [str(loss).split(":")[0] for loss in scene.save(work("a.pbrt"))] == lost, (name, scene.save(work("a.pbrt")))
        assert not broken_rules(work("a.pbrt")), broken_rules(work("a.pbrt"))
        before, after = (numpy.asarray(one.render(spp=16)) for one in (scene, velo.load(work("a.pbrt"))))
        still = numpy.asarray(scene.render(spp=16, camera=scene.camera.at(0.2)))
        assert abs(before - still).mean() > 0.02 * before.mean(), f"{name}: nothing moves"
        if not lost:
            assert abs(before - after).mean() < 0.001 * before.mean(), name


if __name__ == "__main__":
    write_images()
    cases.main()
