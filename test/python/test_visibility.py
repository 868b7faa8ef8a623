#!/usr/bin/python3
"""Shapes that are hidden from the camera, and backdrops: what camera rays and other rays see of them."""
import cases
from cases import case

numpy = cases.need("numpy")
import velo

SIZE = (16, 16)
EYE = {"eye": (0, -4, 0), "lookat": (0, 0, 0), "fov": 0.7}


def scene_of(hidden=False, backdrop=False, fog=False, behind=True, kind="triangles"):
    """A red emitting sheet before a green one; with fog, in a thin medium."""
    scene = velo.Scene()
    words = {"hidden_from_camera": hidden, "backdrop": backdrop}
    red, green = (scene.add_emission(radiance=color, two_sided=True) for color in ((1, 0, 0), (0, 1, 0)))
    black = scene.add_material("diffuse", reflectance=(0, 0, 0))
    if kind == "sphere":
        scene.add_sphere((0, 0, 0), 1.0, emission=red, material=black, **words)
    else:
        scene.add_plane((0, 0, 0), (0, -1, 0), 9, 9, emission=red, material=black, **words)
    if behind:
        scene.add_plane((0, 2, 0), (0, -1, 0), 9, 9, emission=green, material=black)
    if fog:
        medium = scene.add_medium("homogeneous", sigma_a=(1e-4, 1e-4, 1e-4), sigma_s=(1e-4, 1e-4, 1e-4))
        scene.add_box((-1, -2, -1), (1, -1.5, 1), inside=medium, material=scene.add_material("interface"))
    return scene


def image_of(scene, **words):
    return numpy.asarray(scene.render(camera=velo.Camera(*SIZE, **EYE), **{"spp": 4, "color": "rgb", "tracer": "volpath", **words}))


@case
def the_camera_sees_what_is_behind():
    for fog in (False, True):
        for kind in ("triangles", "sphere"):
            for tracer in ("path", "volpath") if not fog else ("volpath",):
                seen = image_of(scene_of(fog=fog, kind=kind), tracer=tracer)[8, 8]
                hidden = image_of(scene_of(True, fog=fog, kind=kind), tracer=tracer)[8, 8]
                assert seen[0] > 0.9 and seen[1] < 0.01, (fog, kind, seen)
                assert hidden[0] < 0.01 and hidden[1] > 0.9, (fog, kind, tracer, hidden)


@case
def many_layers_are_passed():
    scene = scene_of(True)
    for i in range(20):
        scene.add_plane((0, -1 - i / 10, 0), (0, -1, 0), 9, 9, hidden_from_camera=i % 2 == 0, alpha=1.0 if i % 2 == 0 else 0.0)
    assert image_of(scene)[8, 8][1] > 0.9


@case
def alpha_and_channels_are_those_of_what_is_seen():
    scene = scene_of(True, behind=False)
    assert image_of(scene, transparent=True)[8, 8][3] == 0
    image = scene_of(True).render(camera=velo.Camera(*SIZE, **EYE), spp=1, channels=["Z"])
    assert abs(float(numpy.asarray(image["Z"])[8, 8]) - 6) < 0.1


@case
def other_rays_meet_it():
    """A lamp lights through the hole, but for the shadow of a hidden sheet; a mirror shows the sheet."""
    scene = velo.Scene()
    scene.add_plane((0, 2, 0), (0, -1, 0), 30, 30, material=scene.add_material("conductor", roughness=0.0))
    red = scene.add_emission(radiance=(1, 0, 0), two_sided=True)
    scene.add_plane((0, 0, 0), (0, -1, 0), 3, 3, emission=red, material=scene.add_material("diffuse", reflectance=(0, 0, 0)), hidden_from_camera=True)
    assert image_of(scene)[8, 8][0] > 0.3
    lit = []
    for there in (False, True):
        scene = velo.Scene()
        scene.add_plane((0, 2, 0), (0, -1, 0), 30, 30, material=scene.add_material("diffuse", reflectance=(0.5, 0.5, 0.5)))
        scene.add_light("point", position=(0, -1, 0), scale=10.0)
        if there:
            scene.add_plane((0, 0, 0), (0, -1, 0), 1, 1, hidden_from_camera=True)
        lit.append(image_of(scene)[8, 8][1])
    assert lit[0] > 0.1 and lit[1] < 0.01 * lit[0], lit


@case
def a_backdrop_is_a_hole_in_transparent_films():
    for fog in (False, True):
        image = image_of(scene_of(backdrop=True, fog=fog), transparent=True)[8, 8]
        assert (image == 0).all(), (fog, image)
        assert image_of(scene_of(backdrop=True, fog=fog))[8, 8][0] > 0.9


@case
def volpath_takes_the_place_of_tracers_with_light_paths():
    for tracer in ("bidirectional", "merging", "lightpath"):
        assert (image_of(scene_of(True), tracer=tracer) == image_of(scene_of(True))).all(), tracer


@case
def a_scene_keeps_it():
    scene = scene_of(True)
    shape = scene.handles("shapes")[0]
    assert scene.get(shape)["hidden_from_camera"] is True


if __name__ == "__main__":
    cases.main()
