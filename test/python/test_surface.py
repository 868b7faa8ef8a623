#!/usr/bin/python3
"""The Python module: scenes from arrays, cameras, films, image files, and the kinds of velo/schema.h."""
import math
import os

import cases
from cases import case, raises, warned, work

numpy = cases.need("numpy")
import velo

QUAD = numpy.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=numpy.float32)
FACES = numpy.array([[0, 1, 2], [0, 2, 3]], dtype=numpy.uint32)
UVS = [[0, 0], [1, 0], [1, 1], [0, 1]]


def camera(width=40, height=40, **keywords):
    keywords.setdefault("fov", math.radians(40))
    return velo.Camera(width, height, eye=(0, 0, 3), lookat=(0, 0, 0), **keywords)


def quad_scene(**material):
    scene = velo.Scene()
    scene.add_mesh(QUAD, FACES, uvs=UVS, name="quad", material=scene.add_material("diffuse", **material))
    scene.add_light("infinite", color=(1, 1, 1))
    scene.camera = camera()
    return scene


@case
def a_scene_from_arrays_has_known_radiance():
    """A diffuse surface of reflectance rho in white light of radiance 1 has radiance rho."""
    image = quad_scene(reflectance=(0.2, 0.5, 0.8)).render(spp=64, color="rgb")
    middle = numpy.asarray(image)[15:25, 15:25, :3].mean((0, 1))
    assert numpy.allclose(middle, (0.2, 0.5, 0.8), rtol=0.01), middle


def lit_through(alphas, **keywords):
    """A floor that the camera sees, lit by a lamp behind it through cards with these alphas, of one sample."""
    scene = velo.Scene()
    scene.add_mesh(8 * QUAD, FACES, material=scene.add_material("diffuse", reflectance=0.5))
    for number, alpha in enumerate(alphas):
        card = QUAD * (4, 4, 1) + (0, 0, 5 + number)
        scene.add_shape("triangles", positions=card.astype(numpy.float32), indices=FACES, alpha=alpha, material=scene.add_material("diffuse"))
    scene.add_light("distant", from_=(0, 0, 1), to=(0, 0, 0), color=(1, 1, 1))
    scene.camera = camera()
    return numpy.asarray(scene.render(spp=1, color="rgb", max_depth=1, **keywords))[..., :3].astype(float)


@case
def a_small_sun_in_a_large_sky_has_no_noise():
    """Texels of an image of up to 2048 x 2048 are chosen exactly: the light of a disk of 12 texels is that of its middle, in each sample. Of larger
    images blocks of texels are chosen, and the mean is the same."""
    for side, noise in ((2048, 1e-3), (2050, 1.0)):
        v, u = numpy.mgrid[0:side, 0:side] + 0.5 - side / 2
        disk = (u**2 + v**2 < 6**2).astype(numpy.float32)
        scene = velo.Scene()
        scene.add_mesh(8 * QUAD, FACES, material=scene.add_material("diffuse", reflectance=0.5))
        scene.add_light("infinite", image=velo.Image(disk[..., None].repeat(3, axis=2), encoding="linear"), scale=1e4)
        scene.camera = camera()
        image = numpy.asarray(scene.render(spp=1, color="rgb", max_depth=1))[..., :3].astype(float)
        expected = 0.5 / math.pi * 1e4 * disk.sum() * 4 * math.pi / side**2
        assert abs(image.mean() / expected - 1) < (1e-3 if noise < 1 else 0.02), (side, image.mean() / expected)
        assert image.std() < noise * image.mean(), (side, image.std() / image.mean())


@case
def shadow_rays_carry_what_surfaces_with_an_alpha_let_pass():
    """Exactly, not as a mean over many rays, and in the same bits with both accelerators."""
    free = lit_through(())
    for alphas, passes in (((0.5,), 0.5), ((0.5, 0.25, 0.9), 0.0375), ((0.0, 1e-3), 0.999), ((0.3, 1.0), 0), ((0.999999,) * 9, 0)):
        image = lit_through(alphas)
        assert numpy.allclose(image, passes * free, rtol=1e-5, atol=1e-7), (alphas, (image / free).min(), (image / free).max())
        assert numpy.array_equal(image, lit_through(alphas, accelerator="bvh")), alphas


@case
def arrays_of_any_type_and_layout_do():
    reference = numpy.array(quad_scene(reflectance=0.5).render(spp=1))
    variants = [(QUAD.astype("float64"), FACES.astype("int64")), (QUAD.tolist(), FACES.tolist()),
                (numpy.asfortranarray(QUAD), FACES[:, ::-1][:, ::-1]),
                (memoryview(QUAD), memoryview(FACES)), (tuple(map(tuple, QUAD)), FACES.astype("uint8"))]
    for positions, indices in variants:
        scene = velo.Scene()
        scene.add_mesh(positions, indices, uvs=UVS, name="quad", material=scene.add_material("diffuse", reflectance=0.5))
        scene.add_light("infinite", color=(1, 1, 1))
        scene.camera = camera()
        assert numpy.array_equal(numpy.asarray(scene.render(spp=1)), reference)


@case
def wrong_arrays_are_usage_errors():
    scene = velo.Scene()
    for positions, indices, text in ((QUAD, [[0, 1]], "indices: 3 numbers per face"), ([[0, 0]], FACES, "positions: 3 numbers"),
                                     (QUAD, [[0, 1, -1]], "not an index"), (QUAD, [[0, 1, 1.5]], "not an index"),
                                     ("abc", FACES, "must be numbers"), ([[0, 0, 0], [0, 0]], FACES, "differ in length"),
                                     (numpy.array([["a"]]), FACES, "positions")):
        with raises(velo.UsageError, text):
            scene.add_mesh(positions, indices)
    with raises(velo.UsageError, "uvs: 4 elements are needed, it has 3"):
        scene.add_mesh(QUAD, FACES, uvs=UVS[:3])
    scene.add_mesh(QUAD, FACES)  # the scene is still whole
    with raises(velo.SceneError, "vertex 9"):
        scene.add_mesh(QUAD, [[0, 1, 9]])


@case
def textures_from_arrays():
    texels = numpy.zeros((2, 2, 3), dtype=numpy.float32)
    texels[0, 0], texels[0, 1], texels[1, 0], texels[1, 1] = (0.9, 0, 0), (0, 0.9, 0), (0, 0, 0.9), (0.9, 0.9, 0)
    scene = velo.Scene()
    texture = scene.add_texture("image", image=texels, filter="point", wrap="clamp")
    scene.add_mesh(QUAD, FACES, uvs=UVS, material=scene.add_material("diffuse", reflectance=texture))
    scene.add_light("infinite", color=(1, 1, 1))
    scene.camera = camera()
    albedo = scene.ground_truth(["albedo"])["albedo"]
    assert numpy.allclose(albedo[12, 12], (0.9, 0, 0), atol=0.02) and numpy.allclose(albedo[28, 28], (0.9, 0.9, 0), atol=0.02)
    other = velo.Scene()
    with raises(velo.UsageError, "part of another scene"):
        other.add_material("diffuse", reflectance=texture)
    with raises(velo.UsageError, "not of its textures"):
        scene.add_material("diffuse", reflectance=scene.add_material("diffuse"))


@case
def every_kind_can_be_added_and_takes_its_rows_names():
    scene = velo.Scene()
    for kind, words in velo.kinds("materials").items():
        if kind in ("mix", "measured"):
            continue
        handle = scene.add_material(kind, name=kind)
        assert handle.family == "materials"
        for word in words:
            if word in ("roughness", "metallic", "clearcoat", "thickness", "u_roughness", "beta_m"):
                scene.add_material(kind, **{word: 0.5})
    pair = [scene.add_material("diffuse"), scene.add_material("dielectric", eta=1.5)]
    scene.add_material("mix", materials=pair, amount=0.3)
    scene.add_material("conductor", eta="metal-Au-eta", k="metal-Au-k", roughness=0.2)
    for kind in velo.kinds("textures"):
        if kind != "image":
            scene.add_texture(kind)
    noise = scene.add_texture("fbm", octaves=4, spectrum=False)
    scene.add_material("principled", basecolor=(0.5, 0.1, 0.1), roughness=noise)
    for kind in ("point", "spot", "distant", "infinite"):
        scene.add_light(kind, scale=2)
    scene.add_light("spot", from_=(0, 3, 0), to=(0, 0, 0), cone_angle=0.4, color=velo.blackbody(3000), power=40)
    fog = scene.add_medium("homogeneous", sigma_s=0.1, g=0.5)
    scene.add_medium("grid", density=numpy.ones((2, 3, 4)), low=(0, 0, 0), high=(1, 1, 1))
    lamp = scene.add_emission(radiance=velo.blackbody(5000), scale=4)
    scene.add_shape("disk", radius=0.3, emission=lamp, transform=numpy.eye(4))
    scene.add_shape("cylinder", radius=0.1, z_min=0, z_max=1, inside=fog)
    scene.add_shape("sphere", centers=[[0, 0, 0], [1, 0, 0]], radii=[0.1, 0.2])
    group = scene.add_group("pair")
    scene.add_sphere((0, 0, 0), 0.2, group=group)
    scene.add_instance(group, numpy.eye(4))
    scene.add_instance(group, [numpy.eye(4), numpy.diag([2, 2, 2, 1])], times=[0, 1])
    assert scene.info["instances"] == 2 and scene.info["emissive_shapes"] == 1
    with raises(velo.UsageError, "keyword of this material", "reflectance"):
        scene.add_material("diffuse", reflectanc=0.3)
    with raises(velo.UsageError, "material must be one of", 'did you mean "diffuse"'):
        scene.add_material("difuse")


@case
def spectra_in_every_form():
    for spectrum in (0.5, (0.5, 0.5, 0.5), velo.rgb(0.5, 0.5, 0.5), velo.sampled([300, 900], [0.5, 0.5])):
        image = quad_scene(reflectance=spectrum).render(spp=16)
        assert abs(numpy.asarray(image)[15:25, 15:25, 1].mean() - 0.5) < 0.02, spectrum
    assert "metal-Au-eta" in velo.spectrum_names()
    with raises(velo.SceneError, "metal-Ag-eta"):
        quad_scene(reflectance=0.5).add_material("conductor", eta="metal-Ag-etta", k="metal-Ag-k")


@case
def the_world_is_built_again_when_the_scene_changes():
    scene = quad_scene(reflectance=0.5)
    before = numpy.array(scene.ground_truth(["Z"])["Z"])
    scene.add_sphere((0, 0, 1), 0.3)
    after = scene.ground_truth(["Z"])["Z"]
    assert after[20, 20] < before[20, 20] - 0.5
    assert scene.world() is scene.world() and scene.world().info["primitives"] == 3
    assert [entry["name"] for entry in scene.world().ids("object")][0] == "quad"


@case
def project_and_unproject_are_inverse_for_every_model():
    k = [[300, 0, 160.5], [0, 310, 119.25], [0, 0, 1]]
    models = [dict(K=k), dict(K=k, distortion="opencv", distortion_coefficients=[-0.2, 0.05, 0.001, -0.002]),
              dict(projection="equidistant", K=[[150, 0, 160], [0, 150, 120], [0, 0, 1]], distortion="radial",
                   distortion_coefficients=[0.02, -0.01, 0.003, -0.0004]),
              dict(projection="unified", K=k, shape=[0.8]), dict(projection="double_sphere", K=k, shape=[-0.2, 0.6]),
              dict(projection="eucm", K=k, shape=[0.6, 1.1]), dict(projection="equirectangular"), dict(projection="orthographic"),
              dict(projection="cylindrical"), dict(colmap=("OPENCV", [300, 300, 160, 120, 0.1, 0.01, 0, 0])),
              dict(fov=1.0), dict(focal_mm=35, sensor_width_mm=36), dict(view_distance=400, pixel_size=0.5)]
    generator = numpy.random.default_rng(5)
    for keywords in models:
        cam = velo.Camera(320, 240, eye=(1, 2, 3), lookat=(0, 0.5, 0), **keywords)
        pixels = generator.uniform((20, 20), (300, 220), (500, 2))
        rays = cam.unproject(pixels)
        assert rays.valid.all(), keywords
        back = cam.project(rays.origins + 2.5 * rays.directions)
        assert back.valid.all() and numpy.abs(back.pixels - pixels).max() < 1e-6, keywords
    pose = numpy.array(cam.world_from_camera)
    assert numpy.allclose(pose @ cam.camera_from_world, numpy.eye(4)) and numpy.allclose(pose[:3, 3], (1, 2, 3))
    assert not cam.project([[5, 5, 20]]).valid[0]
    with raises(velo.UsageError, "rows of 3 numbers"):
        cam.project([[1, 2]])


@case
def projection_agrees_with_opencv():
    try:
        import cv2
    except ImportError:
        raise cases.Skip("needs cv2")
    k = numpy.array([[300, 0, 160.5], [0, 310, 119.25], [0, 0, 1]])
    coefficients = [-0.2, 0.05, 0.001, -0.002, 0.01]
    cam = velo.Camera(320, 240, K=k + [[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]], distortion="opencv",
                      distortion_coefficients=coefficients, world_from_camera=numpy.eye(4))
    points = numpy.random.default_rng(2).uniform((-0.4, -0.3, 1), (0.4, 0.3, 2), (1000, 3))
    theirs = cv2.projectPoints(points, numpy.zeros(3), numpy.zeros(3), k, numpy.array(coefficients))[0][:, 0]
    assert numpy.abs(cam.project(points).pixels - 0.5 - theirs).max() < 1e-9


@case
def a_focal_length_replaces_what_gave_it_before():
    plane = velo.Camera(100, 80, view_distance=30)
    film = velo.Camera(100, 80, focal_mm=35, sensor_width_mm=36)
    lens = velo.Camera(100, 80, focal_mm=35, sensor_width_mm=36, f_number=2.8)
    alone = velo.Camera(100, 80, fov=1.0, focal_mm=35, f_number=2.8)  # focal_mm describes the lens only
    screen = velo.Camera(100, 80, screen_min_x=-1, screen_max_x=1, screen_min_y=-0.8, screen_max_y=0.8)
    wide = 50 / numpy.tan(0.5)
    for camera, keywords, fx in ((plane, {"zoom": 2}, 60), (plane.replace(zoom=2), {"pixel_size": 0.5}, 120), (plane, {"fx": 44}, 44),
                                 (film, {"focal_mm": 72}, 200), (film, {"sensor_width_mm": 70}, 50), (film, {"view_distance": 30}, 30),
                                 (lens, {"fov": 1.0, "fov_axis": "horizontal"}, wide), (lens, {"f_number": 4, "fx": 20}, 20),
                                 (alone, {"fx": 70}, 70), (screen, {"screen_max_x": 3}, 25), (screen, {"fx": 20}, 20),
                                 (plane, {"colmap": ("SIMPLE_PINHOLE", [70, 50, 40])}, 70), (film, {"K": numpy.diag((60, 60, 1))}, 60)):
        assert abs(camera.replace(**keywords).K[0, 0] - fx) < 1e-9, (keywords, camera.replace(**keywords).K)
    assert film.replace(fx=20).get("sensor_width_mm") is None and alone.replace(fx=70).get("focal_mm") == 35
    assert lens.replace(fx=20).get("sensor_width_mm") == 36 and lens.replace(fx=20).get("focal_mm") is None  # the lens zooms


@case
def cameras_change_and_are_written_in_every_dialect():
    cam = velo.Camera(320, 240, K=[[300, 0, 160], [0, 300, 120], [0, 0, 1]], eye=(1, 2, 3), lookat=(0, 0, 0))
    longer = cam.replace(fov=0.5)
    assert longer.K[0, 0] > 400 and cam.K[0, 0] == 300 and longer.get("fx") is None
    assert cam.resize(640, 480).K[0, 0] == 600
    assert numpy.allclose(cam.move(numpy.eye(4)).world_from_camera, numpy.eye(4))
    left, right = cam.replace(stereo_mode="parallel", interocular=0.1).eyes()
    assert abs(numpy.linalg.norm(left.world_from_camera[:3, 3] - right.world_from_camera[:3, 3]) - 0.1) < 1e-12
    written = 0
    for dialect, name in (("velo", "c.json"), ("opencv", "c.yaml"), ("nerf", "t.json"), ("kalibr", "k.yaml"),
                          ("blender", "b.json"), ("gltf", "c.gltf"), ("opengl", "g.json"), ("mitsuba", "m.xml"),
                          ("bop", "scene_camera.json"), ("open3d", "o.json"), ("gaussians", "cameras.json")):
        path = work(name)
        cam.write(path, dialect=dialect)
        back = velo.read_camera(path, dialect=dialect, width=320, height=240)
        assert numpy.allclose(back.K, cam.K, atol=1e-3) and back.resolution == (320, 240), dialect
        written += 1
    assert written == 11
    assert velo.read_trajectory(work("t.json"))[0].camera.resolution == (320, 240)
    with raises(velo.UsageError, "dialect must be one of", 'did you mean "opencv"'):
        cam.write(work("x"), dialect="opencvv")
    with raises(velo.UsageError, "eye"):
        velo.Camera(10, 10, eye=(0, 0, 0), lookat=(0, 0, 0))


@case
def films_are_written_continued_and_merged():
    scene = quad_scene(reflectance=0.5)
    whole = numpy.array(scene.render(spp=8))
    scene.render(spp=4)
    first = work("first.film")
    scene.film.write(first)
    film = velo.read_film(first)
    assert film.spp == 4 and film.resolution == (40, 40)
    assert numpy.array_equal(numpy.asarray(scene.render(film=film, spp=8)), whole) and film.spp == 8
    second, merged = work("second.film"), work("merged.film")
    scene.render(spp=8, first_sample=4)
    scene.film.write(second)
    velo.merge_films([second, first], merged)
    assert numpy.array_equal(numpy.asarray(velo.read_film(merged).image()), whole)
    assert numpy.array_equal(numpy.asarray(velo.read_film(merged).image(exposure=2)), whole * (2, 2, 2, 1))
    with raises(velo.UsageError, "errors=True"):
        film.errors()
    scene.render(spp=8, errors=True)
    assert numpy.isfinite(numpy.asarray(scene.film.errors())).all()
    scene.film.write(work("errors.film"))
    scene.film.write(work("errors.film"))
    with raises(velo.UsageError, "errors.film: this file is not of this film"):
        film.write(work("errors.film"))
    with raises(velo.SceneError, "errors.film is not replaced"):
        velo.merge_films([first, second], work("errors.film"))
    velo.merge_films([first, second], work("errors.film"), overwrite=True)
    film.write(work("errors.film"), overwrite=True)
    with raises(velo.UsageError, "not of this film"):
        scene.film.write(work("errors.film"))
    with open(first, "r+b") as file:
        file.seek(60)
        file.write(b"\xff" * 40)
    with raises(velo.SceneError, "first.film"):
        velo.read_film(first)


@case
def image_files_round_trip():
    generator = numpy.random.default_rng(3)
    colors = generator.random((6, 5, 3), dtype=numpy.float32)
    velo.Image(colors).write(work("c.exr"))
    assert numpy.array_equal(numpy.asarray(velo.read_image(work("c.exr"))), colors)
    bytes_ = generator.integers(0, 256, (6, 5, 3), dtype=numpy.uint8)
    velo.Image(bytes_).write(work("c.png"))
    assert numpy.array_equal(numpy.asarray(velo.read_image(work("c.png"))), bytes_)
    named = velo.Image(colors, ["N.X", "N.Y", "N.Z"])
    assert named["N"].shape == (6, 5, 3) and named["N.Y"].shape == (6, 5) and "N" in named and "Z" not in named
    with raises(velo.UsageError, "no channel 'Q'", "N.X"):
        named["Q"]
    with raises(velo.UsageError, "rows x columns"):
        velo.Image(numpy.zeros(3, dtype=numpy.float32))
    ids = velo.Image(numpy.arange(30, dtype=numpy.uint32).reshape(6, 5), ["id.object"])
    ids.write(work("ids.exr"))
    back = velo.read_image(work("ids.exr"), ["id.object"])
    assert numpy.array_equal(back["id.object"], ids["id.object"])
    with raises(velo.MissingFileError):
        velo.read_image(work("none.png"))
    with open(work("broken.png"), "wb") as file:
        file.write(open(work("c.png"), "rb").read()[:60])
    with raises(velo.SceneError, "broken.png"):
        velo.read_image(work("broken.png"))


@case
def images_are_compared_viewed_and_denoised():
    scene = quad_scene(reflectance=0.5)
    a, b = scene.render(spp=4), scene.render(spp=4, seed=1)
    same, other = a.compare(a), b.compare(a)
    assert same["mse"] == 0 and same["differing"] == 0 and other["mse"] > 0 and other["differing"] > 10
    assert numpy.asarray(b.difference(a)).dtype == numpy.uint8
    seen = numpy.asarray(a.view("agx", exposure=1))
    assert seen.dtype == numpy.uint8 and seen.shape[2] == 3
    clean = scene.render(spp=4, denoise=True, channels=["Z"])
    reference = scene.render(spp=256)
    assert "Z" in clean and "error" not in clean
    assert clean.compare(reference)["mse"] < a.compare(reference)["mse"]
    noisy = scene.render(spp=4, errors=True, channels=["error"])
    numpy.asarray(noisy)[20, 20, :3] = math.nan
    with warned() as notes:
        assert numpy.isfinite(numpy.asarray(noisy.denoise())).all()
    assert len(notes) == 1 and str(notes[0].message).startswith("1 pixels are not finite") and notes[0].filename == __file__, notes


@case
def a_saved_scene_is_the_same():
    scene = quad_scene(reflectance=(0.2, 0.5, 0.8))
    path = work("saved.pbrt")
    losses = scene.save(path)
    assert isinstance(losses, dict)
    again = velo.load(path)
    assert numpy.allclose(again.ground_truth(["Z"])["Z"], scene.ground_truth(["Z"])["Z"])


@case
def models_are_groups():
    scene = velo.Scene()
    path = work("quad.obj")
    with open(path, "w") as file:
        file.write("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n")
    model = scene.load_group(path)
    assert model.name == "quad" and model.low == (-1, -1, 0) and model.high == (1, 1, 0) and model.shapes == 1
    for x in (-2, 2):
        scene.add_instance(model.group, [[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    scene.camera = camera(fov=2.0)
    ids = scene.ground_truth(["id.instance"])["id.instance"]
    assert set(numpy.unique(ids)) == {0, 1, 2} and [entry["name"] for entry in scene.world().ids("instance")] == ["quad"] * 2


@case
def boxes_and_flow():
    scene = quad_scene(reflectance=0.5)
    boxes = scene.boxes()["object"]
    assert boxes[0]["seen"] == boxes[0]["all"] > 100 and boxes[0]["space"]["high"][0] == 1
    pose = numpy.array(scene.camera.world_from_camera)
    pose[0, 3] += 0.1
    flow = scene.ground_truth(["forward"], forward=scene.camera.move(pose))["forward.U"]
    assert abs(flow[20, 20] + 0.1 * scene.camera.K[0, 0] / 3) < 1e-3
    assert abs(scene.focus(20, 20) - 3) < 1e-4


@case
def warnings_reach_the_log():
    import logging
    messages = []

    class Keep(logging.Handler):
        def emit(self, record):
            messages.append(record.getMessage())

    logging.getLogger("velo").addHandler(Keep())
    path = work("permissive.pbrt")
    with open(path, "w") as file:
        file.write('WorldBegin\nTexture "t" "spectrum" "imagemap" "string filename" "nonsense.png"\nMaterial "diffuse" "texture reflectance" "t"\nShape "sphere"\n')
    velo.load(path, permissive=True).world()
    assert any("nonsense" in message and "permissive.pbrt" in message for message in messages), messages


@case
def nothing_leaks():
    """Python's own memory after many calls of each kind, those that fail too."""
    import gc
    import tracemalloc
    scene = quad_scene(reflectance=0.5)
    scene.render(spp=1)
    cam = camera()

    def fails(call, *arguments, **keywords):
        try:
            call(*arguments, **keywords)
        except velo.Error:
            return
        raise AssertionError("no error")

    calls = [
        lambda: cam.project(QUAD), lambda: cam.unproject([[1, 2]]), lambda: cam.replace(fov=0.3), lambda: cam.K,
        lambda: cam.move(numpy.eye(4)), lambda: cam.replace(stereo_mode="parallel").eyes(),
        lambda: cam.write(work("leak.json"), dialect="velo"), lambda: velo.read_camera(work("leak.json")),
        lambda: velo.read_trajectory(work("leak.json")), lambda: numpy.asarray(velo.Image(QUAD)),
        lambda: velo.Image(QUAD, ["b"])["b"], lambda: scene.render(spp=1, resolution=(4, 4), channels=["Z", "id.object"]),
        lambda: scene.render(spp=2, resolution=(4, 4), progress=lambda progress: True), lambda: scene.boxes(resolution=(4, 4)),
        lambda: list(scene.passes(spp=2, resolution=(4, 4))), lambda: scene.world().ids("object"), lambda: scene.world().info,
        lambda: scene.film.write(work("leak.film")), lambda: velo.read_film(work("leak.film")),
        lambda: velo.Image(QUAD).compare(velo.Image(QUAD)), lambda: velo.Image(QUAD)._repr_png_(), lambda: velo.kinds("materials"),
        lambda: quad_scene(reflectance=velo.sampled([400, 700], [1, 1])), lambda: velo.spectrum_names(),
        lambda: fails(scene.render, sppp=1), lambda: fails(scene.render, spp="a"), lambda: fails(cam.project, [[1]]),
        lambda: fails(scene.add_mesh, QUAD, [[0, 1]]), lambda: fails(velo.Image, numpy.zeros(3)), lambda: fails(velo.load, "none.pbrt"),
        lambda: fails(velo.Camera, 4, 4, fov=9), lambda: fails(velo.Camera, 4, 4, colmap=("NONE", [1])),
        lambda: fails(scene.render, channels=["nothing"]), lambda: fails(scene.add_material, "diffuse", nothing=1),
        lambda: fails(velo.read_film, work("leak.json")),
    ]
    tracemalloc.start()
    for number, call in enumerate(calls):
        for _ in range(5):
            call()
        gc.collect()
        before = tracemalloc.get_traced_memory()[0]
        for _ in range(40):
            call()
        gc.collect()
        grown = tracemalloc.get_traced_memory()[0] - before
        assert grown < 40 * 24, (number, grown)
    tracemalloc.stop()


@case
def a_moved_camera_says_where_it_is():
    camera = velo.Camera(64, 48, eye=(0, 1, 3), lookat=(0, 0, 0), fov=0.8)
    pose = numpy.eye(4)
    pose[:3, :3] = [[0, 0, 1], [0, -1, 0], [1, 0, 0]]  # x right, y down, z forward
    pose[:3, 3] = 1, 2, 3
    for moved in (camera.move(pose), camera.replace(world_from_camera=pose), camera.replace(camera_from_world=numpy.linalg.inv(pose)),
                  velo.Camera(64, 48, world_from_camera=pose), camera.move(pose).at(0.5), camera.move(pose).resize(32, 24)):
        assert numpy.allclose(moved.get("eye"), (1, 2, 3)) and numpy.allclose(moved.get("up"), (0, 1, 0)), moved.get("eye")
        assert numpy.allclose(moved.get("lookat"), (2, 2, 3)) and moved.get("roll") == 0
        again = moved.replace(eye=moved.get("eye"), lookat=moved.get("lookat"), up=moved.get("up"))
        assert numpy.allclose(again.world_from_camera, moved.world_from_camera)
    assert camera.resize(32, 24).get("lookat") == (0, 0, 0) and camera.get("eye") == (0, 1, 3)


@case
def models_take_the_names_that_they_document():
    pixels = [[10, 20], [40, 30]]
    for projection, names, values in (("double_sphere", ("xi", "alpha"), (-0.2, 0.6)), ("eucm", ("alpha", "beta"), (0.6, 1.1)),
                                      ("unified", ("xi",), (0.8,))):
        plain = velo.Camera(64, 48, projection=projection, shape=values, fx=30, fy=30)
        for keywords in (dict(zip(names, values)), dict(reversed(list(zip(names, values))))):
            camera = velo.Camera(64, 48, fx=30, fy=30, **keywords, projection=projection)
            assert [camera.get(name) for name in names] == list(values), projection
            assert numpy.array_equal(camera.unproject(pixels).directions, plain.unproject(pixels).directions), projection
    camera = velo.Camera(64, 48, projection="double_sphere", xi=-0.2, alpha=0.6)
    assert camera.replace(alpha=0.5).get("xi") == -0.2 and camera.replace(alpha=0.5).get("alpha") == 0.5
    for call, text in ((lambda: camera.replace(beta=1), "beta"), (lambda: velo.Camera(8, 8, alpha=0.5), "alpha"),
                       (lambda: velo.Camera(8, 8, projection="unified", xi=-1), "xi must be"), (lambda: camera.get("beta"), "beta"),
                       (lambda: velo.Camera(8, 8, projection="unified", xi=1, alpha=0.5), "alpha")):
        with raises(velo.UsageError, text):
            call()


@case
def pbrt_files_of_cameras_are_read():
    pixels = [[10, 20], [40, 30]]
    for keywords in (dict(fov=0.8), dict(fx=50, fy=50, cx=30, cy=20), dict(fov=0.7, lens_radius=0.1, focus_distance=3),
                     dict(projection="orthographic")):
        camera = velo.Camera(64, 48, eye=(0, 1, 3), lookat=(0, 0, 0), **keywords)
        camera.write(work("camera.pbrt"))
        again = velo.read_camera(work("camera.pbrt"))
        assert again.resolution == (64, 48) and numpy.allclose(again.world_from_camera, camera.world_from_camera, atol=1e-12)
        for name in ("origins", "directions"):
            assert numpy.allclose(getattr(again.unproject(pixels), name), getattr(camera.unproject(pixels), name), atol=1e-9), keywords


if __name__ == "__main__":
    cases.main()
