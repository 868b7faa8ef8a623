#!/usr/bin/python3
"""Objects of every family are removed: what still uses one is named, its place is another one's, the bits are those of a scene that
never had it, and a thousand removals take no memory."""
import os
import resource

import cases
from cases import case, raises

numpy = cases.need("numpy")
import velo

SANITIZED = "san" in os.environ.get("LD_PRELOAD", "")
TEXELS = numpy.linspace(0, 1, 8 * 8 * 3).reshape(8, 8, 3).astype("float32")


def begin():
    """A floor and a camera."""
    scene = velo.Scene()
    scene.add_plane((0, 0, 0), (0, 1, 0), 4, 4, material=scene.add_material("diffuse", reflectance=0.6, name="grey"), name="floor")
    scene.add_light("infinite", color=(1, 1, 1))
    scene.camera = velo.Camera(32, 24, eye=(0, 1.5, 2.5), lookat=(0, 0.3, 0), fov=0.9)
    return scene


def furnish(scene, number=0):
    """One object of every family that uses others: their handles."""
    bricks = scene.add_texture("image", image=0.1 + 0.1 * (number % 8) * TEXELS, name="bricks")
    twice = scene.add_texture("scale", spectrum_a=bricks, amount=0.5, name="twice")
    paint = scene.add_material("principled", reflectance=twice, roughness=0.3, name="paint")
    mixed = scene.add_material("mix", materials=(scene.find("materials", "grey"), paint), name="mixed")
    fog = scene.add_medium("homogeneous", sigma_s=velo.sampled([400, 700], [0.1, 0.2]), name="fog")
    glow = scene.add_emission(radiance=velo.sampled([400, 700], [1, 2 + number % 3]))
    lamp = scene.add_light("point", position=(0.5, 1, 0.5), scale=3)
    group = scene.add_group("table")
    block = scene.add_box((-0.2, 0, -0.2), (0.2, 0.4, 0.2), material=mixed, group=group, name="block")
    panel = scene.add_disk((0, 1.2, -0.5), 0.2, (0, -1, 0), emission=glow, name="panel")
    ball = scene.add_sphere((-0.7, 0.3, 0.3), 0.3, material=scene.find("materials", "grey"), outside=fog, name="ball")
    place = scene.add_instance(group, pose=numpy.eye(4))
    return dict(bricks=bricks, twice=twice, paint=paint, mixed=mixed, fog=fog, glow=glow, lamp=lamp, group=group, block=block,
                panel=panel, ball=ball, place=place)


ORDER = ("place", "group", "ball", "panel", "lamp", "glow", "fog", "mixed", "paint", "twice", "bricks")


def clear(scene, things):
    for name in ORDER:
        scene.remove(things[name])


def bits(scene):
    image = scene.render(spp=2, max_depth=3, channels=["Z", "id.object", "id.instance", "id.material"])
    return b"".join(numpy.ascontiguousarray(image[name]).tobytes() for name in image.channels)


@case
def who_still_uses_it_is_named():
    scene = begin()
    things = furnish(scene)
    whole = bits(scene)
    for name, user in (("bricks", 'texture "twice" uses it'), ("twice", 'material "paint" uses it'), ("paint", 'material "mixed" uses it'),
                       ("mixed", 'shape "block" uses it'), ("fog", 'shape "ball" uses it'), ("glow", 'shape "panel" uses it'),
                       ("group", "instance number 1 uses it")):
        with raises(velo.SceneError, "cannot be removed, " + user):
            scene.remove(things[name])
    with raises(velo.SceneError, 'material "mixed" and 2 others use it'):
        scene.remove(scene.find("materials", "grey"))
    assert bits(scene) == whole


@case
def what_was_removed_leaves_nothing():
    scene, never = begin(), begin()
    before, info = scene.context.memory, scene.info
    things = furnish(scene)
    clear(scene, things)
    assert scene.info == info == never.info, (scene.info, info)
    for family in ("textures", "materials", "media", "emission", "lights", "shapes", "groups", "instances"):
        assert len(scene.handles(family)) == len(never.handles(family)), family
    assert bits(scene) == bits(never)
    for name, handle in things.items():
        for use in (lambda: scene.remove(handle), lambda: scene.get(handle), lambda: handle.name):
            with raises(velo.UsageError, "was removed"):
                use()
    with raises(velo.UsageError, "the material was removed"):
        scene.add_sphere((0, 0, 0), 1, material=things["paint"])
    with raises(velo.UsageError, "the texture was removed"):
        scene.add_material("diffuse", reflectance=things["bricks"])
    with raises(velo.UsageError, "the group was removed"):
        scene.add_instance(things["group"], pose=numpy.eye(4))


@case
def places_are_taken_again():
    scene, other = begin(), begin()
    old = furnish(scene)
    clear(scene, old)
    again, first = furnish(scene, 2), furnish(other, 2)
    for name in again:
        assert again[name].index == first[name].index == old[name].index and again[name] != old[name], name
        assert again[name].name == first[name].name and again[name].kind == first[name].kind, name
        with raises(velo.UsageError, "was removed"):
            scene.remove(old[name])
    assert bits(scene) == bits(other)
    clear(scene, again)
    color = scene.add_texture("constant", spectrum=False)  # a place of a colour texture, now one of floats
    assert color.index == old["bricks"].index


@case
def inputs_have_lower_places():
    scene = begin()
    first, second = (scene.add_texture("constant", name=name) for name in ("first", "second"))
    scene.remove(first)
    third = scene.add_texture("scale", spectrum_a=second, name="third")
    assert third.index > second.index  # the free place is below its input
    assert scene.add_texture("constant").index == first.index


@case
def lights_that_were_removed_give_no_light():
    scene = begin()
    for handle in scene.handles("lights"):
        scene.remove(handle)
    assert not numpy.asarray(scene.render(spp=1))[..., :3].any() and scene.world().info["lights"] == 0
    for suffix in ("gltf", "pbrt"):
        path = cases.work("removed." + suffix)
        scene.save(path)
        other = velo.Scene()
        other.load(path)
        assert other.info["lights"] == 0 and other.info["materials"] == scene.info["materials"], suffix


@case
def groups_take_their_shapes_with_them():
    scene, never = begin(), begin()
    group = scene.add_group("pile")
    for x in range(5):
        scene.add_sphere((0.2 * x, 0.2, 0), 0.2, group=group)
    scene.remove(group)
    assert scene.info["shapes"] == 1 and bits(scene) == bits(never)
    again = scene.add_group("other")
    assert again.index == group.index and again.name is None
    scene.add_sphere((0, 0.3, 0), 0.2, group=again)
    scene.add_instance(again, pose=numpy.eye(4))
    assert scene.world().ids("instance")[0]["name"] == "other"


def write_model(path):
    """A box with a texture, as a file."""
    scene = velo.Scene()
    bricks = scene.add_texture("image", image=TEXELS)
    paint = scene.add_material("principled", reflectance=bricks, roughness=0.3, metallic=0.0, name="paint")
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], uvs=[[0, 0], [1, 0], [0, 1]], material=paint)
    scene.save(path)


@case
def models_are_removed_with_what_their_files_brought():
    path = cases.work("model.glb")
    write_model(path)
    context = velo.Context(threads=1)
    scene = velo.Scene(context=context)
    grey = scene.add_material("diffuse", name="grey")
    scene.add_light("infinite", color=1)
    scene.camera = velo.Camera(16, 12, eye=(0, 0, 3), lookat=(0, 0, 0))
    info, whole = scene.info, bits(scene)
    model = scene.load_group(path)
    assert {handle.family for handle in model.handles} == {"groups", "materials", "textures"} and grey not in model.handles
    place = scene.add_instance(model.group, pose=numpy.eye(4))
    shown = bits(scene)
    with raises(velo.SceneError, "instance number 1 uses it"):
        scene.remove(model)
    assert bits(scene) == shown != whole
    scene.remove(place)
    scene.remove(model)
    assert scene.info == info and bits(scene) == whole
    with raises(velo.UsageError, "the group was removed"):
        scene.remove(model)
    rounds = 40 if SANITIZED else 400
    for number in range(rounds):
        model = scene.load_group(path)
        place = scene.add_instance(model.group, pose=numpy.eye(4))
        if number in (rounds // 4, rounds - 1):
            assert bits(scene) == shown
        scene.remove(place)
        scene.remove(model)
        if number == rounds // 4:
            scene.world()
            before = context.memory
    scene.world()
    print("  %d models, %+d bytes held" % (rounds, context.memory - before))
    # The bytes of the file are freed when it is read, those of its images with their last texture; a
    # load leaves some names.
    assert scene.info == info and context.memory < before + rounds * 256, (context.memory, before)
    assert max(handle.index for handle in scene.load_group(path).handles if handle.family != "groups") == 2  # the arrays do not grow
    scene = velo.Scene(context=context)
    kept = scene.load_group(path)
    ball = scene.add_sphere((0, 0, 0), 1, material=next(handle for handle in kept.handles if handle.family == "materials"))
    scene.remove(kept)
    assert scene.get(ball, "material").name == "paint"  # what the ball uses stays, with its texture
    assert scene.info["textures"] == 1


@case
def a_thousand_removals_take_no_memory():
    scene, rounds = begin(), 60 if SANITIZED else 1000
    for number in range(rounds):
        things = furnish(scene, number)
        if number == rounds // 10:
            scene.render(spp=1, resolution=(16, 12), max_depth=1)
            before = scene.context.memory
        if number % 4 == 0:
            scene.render(spp=1, resolution=(16, 12), max_depth=1)
        if number < rounds - 1:
            clear(scene, things)
    scene.render(spp=1, resolution=(16, 12), max_depth=1)
    other = begin()
    furnish(other, rounds - 1)
    assert bits(scene) == bits(other)
    other.close()
    scene.render(spp=1, resolution=(16, 12), max_depth=1)
    print("  %d removals, %+d bytes held" % (rounds, scene.context.memory - before))
    assert scene.context.memory <= before + 4096, (scene.context.memory, before)


if __name__ == "__main__":
    cases.main()
