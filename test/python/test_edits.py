#!/usr/bin/python3
"""Scenes that live: shapes that are reshaped, replaced and removed. The bits are those of a scene that is made anew, and a thousand
edits take no memory."""
import os
import resource

import cases
from cases import case, raises

numpy = cases.need("numpy")
import velo

SANITIZED = "san" in os.environ.get("LD_PRELOAD", "")

def sheet(n, phase):
    """A waving mesh of 2 n^2 triangles: positions, normals, uvs, faces."""
    u, v = numpy.meshgrid(numpy.linspace(0, 1, n + 1), numpy.linspace(0, 1, n + 1))
    y = 0.1 * numpy.sin(9 * u + phase)
    points = numpy.stack([2 * u - 1, y, 2 * v - 1], 2).reshape(-1, 3).astype("float32")
    normals = numpy.stack([-0.45 * numpy.cos(9 * u + phase), 0 * u + 1, 0 * u], 2).reshape(-1, 3).astype("float32")
    i = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
    faces = numpy.concatenate([numpy.stack([i, i + 1, i + n + 2], 1), numpy.stack([i, i + n + 2, i + n + 1], 1)])
    return points, normals, numpy.stack([u + 0.1 * phase, v], 2).reshape(-1, 2).astype("float32"), faces.astype("uint32")


def begin():
    scene = velo.Scene()
    checks = scene.add_texture("checkerboard", su=8, sv=8, spectrum_a=(0.8, 0.2, 0.1), spectrum_b=(0.1, 0.3, 0.6))
    scene.add_material("diffuse", reflectance=checks, name="checks")
    scene.add_material("conductor", roughness=0.2, name="metal")
    scene.add_light("infinite", color=(1, 1, 1))
    scene.add_emission(radiance=(4, 3, 2))
    scene.camera = velo.Camera(48, 36, eye=(0, 1.5, 2.5), lookat=(0, 0, 0), fov=0.8)
    return scene


def bits(scene, spp=2):
    image = scene.render(spp=spp, max_depth=3, channels=["Z", "N", "uv", "id.object", "id.instance"])
    return b"".join(numpy.ascontiguousarray(image[name]).tobytes() for name in image.channels)


def build(phase, size=12, ball="sphere", in_group=0.0):
    """A scene as it should be after edits: its sheet, its ball, and an instance of a sheet of its own."""
    scene = begin()
    points, normals, uvs, faces = sheet(size, phase)
    scene.add_mesh(points, faces, normals=normals, uvs=uvs, material=scene.find("materials", "checks"), name="sheet")
    place = [[1, 0, 0, 0.3], [0, 1, 0, 0.5], [0, 0, 1, 0.2], [0, 0, 0, 1]]
    if ball == "sphere":
        scene.add_shape("sphere", radius=0.3, z_min=-0.3, z_max=0.3, transform=place, name="ball",
                        material=scene.find("materials", "metal"))
    else:
        scene.add_shape("disk", radius=0.4, transform=place, name="ball", material=scene.find("materials", "metal"))
    group = scene.add_group("flags")
    points, normals, uvs, faces = sheet(6, in_group)
    scene.add_mesh(0.3 * points, faces, normals=normals, group=group, name="flag")
    scene.add_instance(group, [[1, 0, 0, -0.5], [0, 1, 0, 0.6], [0, 0, 1, 0], [0, 0, 0, 1]])
    return scene


@case
def reshaped_meshes_have_the_bits_of_new_ones():
    scene = build(0)
    assert bits(scene) == bits(build(0))
    sheets, flag = scene.find("shapes", "sheet"), scene.find("shapes", "flag")
    for phase in (1, 2):
        points, normals, uvs, _ = sheet(12, phase)
        scene.set(sheets, positions=points, normals=normals, uvs=uvs)
        points, normals, _, _ = sheet(6, phase)
        scene.set(flag, positions=0.3 * points, normals=normals)
        assert bits(scene) == bits(build(phase, in_group=phase)), phase
    assert sheets.name == "sheet" and numpy.array_equal(scene.mesh(sheets).positions, sheet(12, 2)[0])


@case
def displaced_meshes_live_through_builds():
    """The same world is built again and again, with a material edited between: the image that displaces the mesh is kept."""
    scene = begin()
    points, _, uvs, faces = sheet(2, 0)
    heights = 0.1 * numpy.random.default_rng(1).random((5, 5), dtype=numpy.float32)
    scene.add_mesh(points, faces, uvs=uvs, displacement=scene.add_texture("image", image=heights, spectrum=False), edge_length=0.2,
                   material=scene.find("materials", "metal"))
    first = bits(scene)
    for number in range(4):
        scene.set(scene.find("materials", "checks"), reflectance=(0.1 * number, 0.2, 0.3))
        assert bits(scene) == first, number


@case
def positions_alone_keep_the_rest():
    scene, points = build(0), sheet(12, 3)[0]
    scene.set(scene.find("shapes", "sheet"), positions=points)
    other = begin()
    _, normals, uvs, faces = sheet(12, 0)
    other.add_mesh(points, faces, normals=normals, uvs=uvs, material=other.find("materials", "checks"))
    for handle in scene.handles("shapes")[1:]:
        scene.hide(handle)
    assert bits(scene) == bits(other)
    scene.set(scene.find("shapes", "sheet"), normals=None)
    other = begin()
    other.add_mesh(points, faces, uvs=uvs, material=other.find("materials", "checks"))
    assert bits(scene) == bits(other)


@case
def shapes_are_replaced():
    scene = build(0)
    points, normals, uvs, faces = sheet(5, 1)
    scene.set(scene.find("shapes", "sheet"), positions=points, normals=normals, uvs=uvs, indices=faces)  # another topology
    assert bits(scene) == bits(build(1, size=5))
    ball = scene.find("shapes", "ball")
    scene.set(ball, "disk", radius=0.4)
    assert bits(scene) == bits(build(1, size=5, ball="disk")) and ball.kind == "disk" and ball.name == "ball"
    scene.set(ball, "sphere", radius=0.3, z_min=-0.3, z_max=0.3)
    assert bits(scene) == bits(build(1, size=5))
    scene.set(ball, emission=scene.handles("emission")[0], radius=0.2, z_min=-0.2, z_max=0.2)
    assert scene.world().info["lights"] == 2


@case
def another_kind_keeps_what_a_shape_is_part_of():
    def begun():
        scene = begin()
        haze = [scene.add_medium("homogeneous", sigma_a=(a, a, a), sigma_s=(0, 0, 0)) for a in (0.5, 2)]
        place = [[1, 0, 0, 0.3], [0, 1, 0, 0.5], [0, 0, 1, 0.2], [0, 0, 0, 1]]
        return scene, {"transform": place, "inside": haze[0], "outside": haze[1], "emission": scene.handles("emission")[0],
                       "material": scene.add_material("interface")}

    scene, words = begun()
    ball = scene.add_shape("disk", radius=0.4, **words)
    scene.set(ball, "sphere", radius=0.4, z_min=-0.4, z_max=0.4)
    for word in ("inside", "outside", "emission", "material"):
        assert scene.get(ball, word).index == words[word].index, word
    other, words = begun()
    other.add_shape("sphere", radius=0.4, z_min=-0.4, z_max=0.4, **words)
    assert bits(scene) == bits(other)


@case
def removed_shapes_are_gone():
    scene = build(0)
    sheets, ball, flag = (scene.find("shapes", name) for name in ("sheet", "ball", "flag"))
    whole = bits(scene)
    info = scene.info
    scene.remove(ball)
    hidden = build(0)
    hidden.hide(hidden.find("shapes", "ball"))
    assert bits(scene) == bits(hidden) and scene.info["shapes"] == info["shapes"] - 1
    assert [handle.name for handle in scene.handles("shapes")] == ["sheet", "flag"]
    for use in (lambda: scene.set(ball, radius=1), lambda: scene.hide(ball), lambda: scene.remove(ball), lambda: ball.name,
                lambda: ball.kind, lambda: scene.mesh(ball)):
        with raises(velo.UsageError, "the shape was removed"):
            use()
    place = [[1, 0, 0, 0.3], [0, 1, 0, 0.5], [0, 0, 1, 0.2], [0, 0, 0, 1]]
    again = scene.add_shape("sphere", radius=0.3, z_min=-0.3, z_max=0.3, transform=place, name="ball",
                            material=scene.find("materials", "metal"))
    assert again.index == ball.index and again != ball and bits(scene) == whole
    with raises(velo.UsageError, "the shape was removed"):
        scene.remove(ball)  # its place is another shape's
    for handle in (again, flag, sheets):
        scene.remove(handle)
    assert scene.info["shapes"] == 0 and scene.handles("shapes") == []
    with raises(velo.UsageError, "none is known"):
        scene.find("shapes", "ball")


@case
def removed_instances_are_gone():
    scene = build(0)
    first = scene.handles("instances")[0]
    pose = scene.transform(first)
    whole = bits(scene)
    scene.remove(first)
    again = scene.add_instance(scene.handles("groups")[0], pose=pose)
    assert again.index == first.index and again != first and bits(scene) == whole and scene.handles("instances") == [again]
    for use in (lambda: scene.set(first, pose=pose), lambda: scene.hide(first), lambda: scene.remove(first), lambda: scene.transform(first),
                lambda: scene.get(first)):
        with raises(velo.UsageError, "the instance was removed"):
            use()


@case
def saved_scenes_have_no_removed_shapes():
    for suffix in ("gltf", "pbrt"):
        scene = build(0)
        scene.remove(scene.find("shapes", "ball"))
        path = cases.work("removed." + suffix)
        scene.save(path)
        assert velo.load(path).info["triangles"] == scene.info["triangles"], suffix
        assert velo.load(path).info["shapes"] == 2, suffix


@case
def wrong_changes_leave_the_shape():
    scene = build(0)
    whole, sheets = bits(scene), scene.find("shapes", "sheet")
    points, normals, uvs, faces = sheet(5, 1)
    nan = points.copy()
    nan[3, 1] = numpy.nan
    for call, text in ((lambda: scene.set(sheets, positions=points), "normals: it has 169 elements, 36 are needed now"),
                       (lambda: scene.set(sheets, positions=points, normals=normals, uvs=None), "there are only 36"),
                       (lambda: scene.set(sheets, normals=normals), "normals: 169 elements are needed, it has 36"),
                       (lambda: scene.set(sheets, positions=nan), "finite"),
                       (lambda: scene.set(sheets, positions=None), "positions"),
                       (lambda: scene.set(sheets, indices=faces + 1000), "there are only 169"),
                       (lambda: scene.set(sheets, transform=numpy.zeros((4, 4))), "singular"),
                       (lambda: scene.set(sheets, "sphere", radius=-1), "radius"),
                       (lambda: scene.set(sheets, "triangles"), "no vertices"),
                       (lambda: scene.set(sheets, "pyramid"), "pyramid"),
                       (lambda: scene.set(sheets, points=points), "points")):
        with raises(velo.Error, text):
            call()
    assert bits(scene) == whole


def resident():
    """Bytes of this process in memory."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def held_by(scene, edit):
    """Bytes of the context and of the process after the edit 0 and a render."""
    edit(scene, 0)
    scene.render(spp=1, resolution=(16, 12), max_depth=1)
    return scene.context.memory, resident()


def check_flat(edit, rounds):
    """Edits, each rendered; the first tenth fills caches. Then the process grows by less than 1 MB: pages that the C library has
    touched for the first time. 300 bytes for each thread that builds were .3 MB for 1000 edits, and a second heap 6.5 MB."""
    scene = build(0)
    for number in range(rounds):
        if number == rounds // 10:
            before = held_by(scene, edit)
        edit(scene, number)
        scene.render(spp=1, resolution=(16, 12), max_depth=1)
    after = held_by(scene, edit)
    print("  %s: %d edits, %+d bytes held, %+.2f MB resident" % (
        edit.__name__, rounds, after[0] - before[0], (after[1] - before[1]) / 1e6))
    other = build(0)
    edit(other, 0)
    assert bits(scene) == bits(other), edit.__name__
    assert after[0] <= before[0] and (after[1] - before[1] < 1e6 or SANITIZED), edit.__name__


def reshape(scene, number):
    points, normals, uvs, _ = sheet(12, number % 7)
    scene.set(scene.find("shapes", "sheet"), positions=points, normals=normals, uvs=uvs)


def replace(scene, number):
    points, normals, uvs, faces = sheet(12 - number % 5, 0)
    scene.set(scene.find("shapes", "sheet"), positions=points, normals=normals, uvs=uvs, indices=faces)
    if number % 2:
        scene.set(scene.find("shapes", "ball"), "disk", radius=0.4)
    else:
        scene.set(scene.find("shapes", "ball"), "sphere", radius=0.3, z_min=-0.3, z_max=0.3)


def remove_and_add(scene, number):
    for name in ("sheet", "flag"):
        scene.remove(scene.find("shapes", name))
    points, normals, uvs, faces = sheet(12 - number % 3, 0)
    scene.add_mesh(points, faces, normals=normals, uvs=uvs, material=scene.find("materials", "checks"), name="sheet")
    points, normals, _, faces = sheet(6, number % 4)
    scene.add_mesh(0.3 * points, faces, normals=normals, group=scene.handles("groups")[0], name="flag")


def fly(scene, number):
    for handle in scene.handles("instances"):
        scene.remove(handle)
    group = scene.handles("groups")[0]
    at = numpy.eye(4)
    at[:3, 3] = -0.5, 0.6 + 0.01 * (number % 5), 0
    scene.add_instance(group, pose=at)
    scene.add_instance(group, pose=[at, at + 0], times=[0, 1])


def repaint(scene, number):
    scene.set(scene.handles("textures")[0], spectrum_a=(0.1 * (number % 9), 0.2, 0.3))
    scene.set(scene.find("materials", "metal"), roughness=0.1 + 0.05 * (number % 9))
    scene.set(scene.handles("lights")[0], color=(1, 0.1 * (number % 9), 1))
    scene.set(scene.handles("instances")[0], transform=[[1, 0, 0, -0.5], [0, 1, 0, 0.6 + 0.01 * (number % 3)], [0, 0, 1, 0], [0, 0, 0, 1]])


@case
def a_thousand_edits_take_no_memory():
    for edit in (reshape, replace, remove_and_add, fly, repaint):
        check_flat(edit, 100 if SANITIZED else 1000)


@case
def the_medium_of_the_camera():
    """Light that comes from 2 away is attenuated as the medium says, and by nothing without it."""
    scene = velo.Scene()
    glow = scene.add_emission(radiance=(1, 1, 1), scale=1.0)
    scene.add_plane((0, 0, -2), (0, 0, 1), 9, 9, emission=glow)
    scene.camera = velo.Camera(4, 4, eye=(0, 0, 0), lookat=(0, 0, -1), fov=0.01)

    def seen():
        return float(numpy.asarray(scene.render(spp=4, tracer="volpath", color="rgb"))[..., :3].mean())

    fog = scene.add_medium("homogeneous", sigma_a=0.5, sigma_s=0.0)
    assert scene.camera_medium is None and abs(seen() - 1) < 1e-4, seen()
    scene.camera_medium = fog
    assert scene.camera_medium == fog and abs(seen() - numpy.exp(-1)) < 1e-4, seen()
    scene.set(fog, sigma_a=1.0)
    assert abs(seen() - numpy.exp(-2)) < 1e-4, seen()
    with raises(velo.Error):
        scene.remove(fog)
    for wrong in (glow, 1, "fog", velo.Scene().add_medium("homogeneous")):
        with raises(velo.UsageError, "camera_medium"):
            scene.camera_medium = wrong
    assert scene.camera_medium == fog
    scene.camera_medium = None
    assert scene.camera_medium is None and abs(seen() - 1) < 1e-4, seen()
    scene.remove(fog)
    with raises(velo.UsageError):
        scene.camera_medium = fog


if __name__ == "__main__":
    cases.main()
