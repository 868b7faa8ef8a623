"""Cases of test_passes.py: Vector, Cryptomatte and denoising data agree with Cycles' passes, vertices that move with Cycles' blur."""
import json
import os

import bpy
import numpy

from inside import FOLDER, add_object, ball, case, channel, colors, lamp, material, new_scene, notes, plane, render

DIFFUSE = "ShaderNodeBsdfDiffuse"


def stack(image, name, letters):
    """height x width x letters."""
    return numpy.stack([channel(image, "%s.%s" % (name, letter)) for letter in letters], axis=2)


def animate(item, places):
    """Moves an object through places at frames 1, 2, ..., in straight lines."""
    for frame, place in enumerate(places, 1):
        item.location = place
        item.keyframe_insert("location", frame=frame)
    straighten(item)


def straighten(item):
    for curve in item.animation_data.action.fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def growing_ball(frames=(1, 3), by=1.0):
    """A ball whose upper half moves aside by a shape key."""
    item = ball(material(DIFFUSE, Color=(0.8, 0.3, 0.2))[0])
    item.shape_key_add(name="basis")
    key = item.shape_key_add(name="aside")
    for point in key.data:
        if point.co.z > 0:
            point.co.x += by * point.co.z
    for frame, value in zip(frames, (0.0, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    straighten(item.data.shape_keys)
    return item


def edges(image):
    """Whether a pixel and its neighbours show one object, height x width, by the pass IndexOB."""
    ids = channel(image, "IndexOB.X")
    same = numpy.ones(ids.shape, dtype=bool)
    for axis in (0, 1):
        for step in (-1, 1):
            same &= numpy.roll(ids, step, axis) == ids
    return ~same


def vector_scene():
    scene = new_scene(world=(1, 1, 1), samples=1)
    scene.view_layers[0].use_pass_vector = scene.view_layers[0].use_pass_object_index = True
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01  # through the pixels' centres
    return scene


def same_vectors(scene):
    scene.frame_set(2)
    other, mine = render(scene, "CYCLES"), render(scene)
    inner = ~edges(other) & ~edges(mine)
    expected, got = (stack(image, "Vector", "XYZW")[inner] for image in (other, mine))
    error = abs(expected - got)
    assert abs(expected).max() > 0.5 and numpy.percentile(error, 99) < 0.02, (abs(expected).max(), numpy.percentile(error, 99))


@case
def vectors_of_objects_and_parents():
    scene = vector_scene()
    parent = add_object(scene, "parent", None)
    item = ball(material(DIFFUSE)[0])
    item.parent, item.pass_index = parent, 1
    animate(parent, ((-1, 0, 0), (0, 0, 0.2), (0.5, 0, 0.3)))
    ball(material(DIFFUSE)[0], (0, 4, 2)).pass_index = 2
    same_vectors(scene)


@case
def vectors_of_cameras():
    scene = vector_scene()
    plane(material(DIFFUSE)[0]).pass_index = 1
    animate(scene.camera, ((-1, -6, 3), (0, -6, 3), (0.5, -5.5, 3)))
    same_vectors(scene)


@case
def vectors_of_vertices():
    scene = vector_scene()
    growing_ball().pass_index = 1
    same_vectors(scene)


@case
def vectors_of_instances():
    scene = vector_scene()
    item = ball(material(DIFFUSE)[0], (0, 0, 0), 0.5)
    item.pass_index = 1
    group = bpy.data.collections.new("group")
    group.objects.link(item)
    scene.collection.objects.unlink(item)
    for x in (-1, 1):
        place = add_object(scene, "place", None)
        place.instance_type, place.instance_collection = "COLLECTION", group
        animate(place, ((x, 0, 1), (x + 0.3, 0, 1), (x + 0.5, 0, 1.4)))
    same_vectors(scene)


@case
def mattes_are_those_of_cycles():
    scene = new_scene(world=(1, 1, 1), samples=64)
    layer = scene.view_layers[0]
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = layer.use_pass_cryptomatte_asset = True
    scene.cycles.pixel_filter_type = "GAUSSIAN"
    plane(material(DIFFUSE)[0])
    first, second = ball(material(DIFFUSE)[0], (-0.5, 0, 1)), ball(material(DIFFUSE)[0], (0.6, 0, 1))
    first.name, second.name, second.data.materials[0].name = "Größe.001", "x" * 60, "rot"
    second.parent = first
    bpy.context.view_layer.update()
    second.matrix_parent_inverse = first.matrix_world.inverted()
    # two materials on one object
    second.data.materials.append(bpy.data.materials["rot"].copy())
    for face in second.data.polygons[:300]:
        face.material_index = 1
    other, mine = render(scene, "CYCLES"), render(scene)
    for kind in ("Object", "Material", "Asset"):
        expected, got = ({key.split("/")[2]: value for key, value in image.attributes.items()
                          if key.startswith("cryptomatte/" + start)} for image in (other, mine)
                         for start in [next(key.split("/")[1] for key, value in image.attributes.items() if value == "ViewLayer.Crypto" + kind)])
        assert {name: expected[name] for name in ("name", "hash", "conversion")} == {name: got[name] for name in ("name", "hash", "conversion")}
        names = json.loads(got["manifest"])
        assert names and names.items() <= json.loads(expected["manifest"]).items(), (names, expected["manifest"])
        ids, found = (stack(image, "Crypto%s00" % kind, "rg") for image in (other, mine))
        same = ids[..., 0].astype(numpy.float32).view(numpy.uint32) == found[..., 0].astype(numpy.float32).view(numpy.uint32)
        assert same.mean() > 0.96 and abs(ids[..., 1] - found[..., 1])[same].mean() < 0.02, (kind, same.mean())
    assert len(json.loads(got["manifest"])) == 2  # the plane and the parent


@case
def denoising_data_are_those_of_cycles():
    scene = new_scene(world=(1, 1, 1), samples=16)
    layer = scene.view_layers[0]
    layer.cycles.denoising_store_passes = layer.velo.denoising_data = layer.use_pass_object_index = True
    plane(material(DIFFUSE)[0]).pass_index = 1
    ball(material(DIFFUSE, Color=(0.8, 0.3, 0.2))[0]).pass_index = 2
    other, mine = render(scene, "CYCLES"), render(scene)
    inner = ~edges(other) & (channel(other, "IndexOB.X") > 0)
    inner[:8] = False  # the horizon
    for name, letters, most in (("Albedo", "RGB", 0.001), ("Normal", "XYZ", 0.05), ("Depth", "Z", 0.05)):
        error = abs(stack(other, "Denoising " + name, letters) - stack(mine, "Denoising " + name, letters))[inner]
        assert numpy.percentile(error, 98) < most, (name, numpy.percentile(error, 98))


@case
def passes_of_regions():
    scene = vector_scene()
    layer = scene.view_layers[0]
    layer.use_pass_cryptomatte_object = layer.velo.denoising_data = True
    growing_ball().pass_index = 1
    scene.frame_set(2)
    whole = render(scene)
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x, scene.render.border_min_y, scene.render.border_max_y = 0.25, 0.75, 0.5, 1.0
    part = render(scene)
    for name in ("Vector.X", "Vector.W", "CryptoObject00.g", "Denoising Depth.Z"):
        assert abs(channel(part, name) - channel(whole, name)[:24, 12:36]).max() < 1e-4, name


@case
def vertices_blur_as_in_cycles():
    for shutter in (1.0, 2.0):
        scene = new_scene(world=(1, 1, 1))
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, shutter
        growing_ball((4, 6), 1.5)
        scene.frame_set(5)
        other, mine = colors(render(scene, "CYCLES")), colors(render(scene))
        error = abs(other - mine).mean()
        assert error < 0.006, (shutter, error)
        assert not notes(scene), notes(scene)
        scene.render.use_motion_blur = False
        sharp = abs(colors(render(scene)) - mine).mean()
        assert sharp > 1.5 * error, (shutter, sharp, error)


@case
def all_that_moves_blurs_as_in_cycles():
    scene = new_scene(world=(1, 1, 1))
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    item = growing_ball((1, 3), 1.5)
    animate(item, ((0, 0, 0.5), (0, 0, 1), (0, 0, 1.5)))
    animate(scene.camera, ((-0.5, -6, 3), (0, -6, 3), (0.5, -6, 3)))
    scene.frame_set(2)
    other, mine = colors(render(scene, "CYCLES")), colors(render(scene))
    assert abs(other - mine).mean() < 0.006, abs(other - mine).mean()


@case
def meshes_whose_triangles_change_are_at_rest():
    scene = new_scene(world=(1, 1, 1), samples=1)
    scene.render.use_motion_blur = scene.view_layers[0].use_pass_vector = True
    item = growing_ball()
    change = item.modifiers.new("cut", "DECIMATE")
    change.ratio = 0.2
    change.keyframe_insert("ratio", frame=1)
    change.ratio = 1.0
    change.keyframe_insert("ratio", frame=3)
    scene.frame_set(2)
    assert numpy.isfinite(colors(render(scene))).all()


def changing_scene(change):
    """Frames 1 to 3 of a scene with a floor, a ball that moves, and one more change: a function of the scene and the frame."""
    scene = new_scene(world=(0.5, 0.5, 0.5), samples=4)
    plane(material(DIFFUSE)[0])
    item = ball(material(DIFFUSE, Color=(0.8, 0.3, 0.2))[0])
    other = ball(material(DIFFUSE, Color=(0.2, 0.3, 0.8))[0], (1.5, 1, 1))
    lamp(scene, "AREA", 100, size=1.0)
    animate(item, ((-1, 0, 1), (0, 0, 1), (1, 0, 1.3)))
    for frame in (1, 2, 3):
        for owner, name, value in change(scene, item, other, frame):
            path, _, member = name.rpartition(".")
            setattr(owner.path_resolve(path) if path else owner, member, value)
            owner.keyframe_insert(name, frame=frame)
    return scene


CHANGES = (
    lambda scene, item, other, frame: (),
    lambda scene, item, other, frame: ((scene.camera, "location", (0.2 * frame, -6, 3)),),
    lambda scene, item, other, frame: ((scene.camera.data, "lens", 30 + 5 * frame),),
    lambda scene, item, other, frame: ((other, "hide_render", frame == 2),),
    lambda scene, item, other, frame: ((bpy.data.lights[0], "energy", 100.0 * frame),),
    lambda scene, item, other, frame: ((other, "scale", (1, 1, 0.5 * frame)),),
    lambda scene, item, other, frame: ((other.data.materials[0].node_tree, 'nodes["Diffuse BSDF"].inputs[0].default_value', (0.3 * frame, 0.2, 0.2, 1)),),
    lambda scene, item, other, frame: ((scene.world.node_tree, 'nodes["Background"].inputs[1].default_value', 0.5 * frame),),
)


def frames_of(scene, keep):
    """The colours of the animation's frames. keep: with Blender's persistent data."""
    import velo
    scene.render.use_persistent_data, scene.frame_end = keep, 3
    scene.render.filepath = os.path.join(FOLDER, "frame_")
    bpy.ops.render.render(animation=True)
    return numpy.stack([colors(velo.read_image(scene.render.filepath + "%04d.exr" % frame)) for frame in (1, 2, 3)])


@case
def frames_share_what_does_not_change():
    for number, change in enumerate(CHANGES):
        images = [frames_of(changing_scene(change), keep) for keep in (False, True)]
        assert abs(images[0] - images[1]).max() < 1e-4, (number, abs(images[0] - images[1]).max(axis=(1, 2, 3)))
        assert abs(images[1][0] - images[1][2]).max() > 0.05, number


@case
def frames_that_only_move_are_not_read_again():
    from velo_blender import export
    scene = changing_scene(CHANGES[0])
    made, original = [], export.Export.__init__

    def counted(self, *words, **more):
        made.append(1)
        original(self, *words, **more)
    export.Export.__init__ = counted
    try:
        frames_of(scene, True)
    finally:
        export.Export.__init__ = original
    assert len(made) == 1, len(made)
