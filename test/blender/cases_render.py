"""Cases of test_render.py: light, materials and passes agree with Cycles; bad input is reported."""
import math
import time
import tracemalloc

import bpy
import numpy

from inside import (add_object, agrees, ball, case, channel, colors, lamp, material, new_scene, notes, plane, refused, render)

GRAY = (0.8, 0.6, 0.4)


def room(**words):
    """A floor and a ball, both diffuse."""
    scene = new_scene(**words)
    plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    ball(material("ShaderNodeBsdfDiffuse", Color=(0.2, 0.5, 0.8))[0])
    return scene


@case
def lights_have_the_units_of_cycles():
    for kind, words in (("POINT", {"energy": 500, "color": (1, 0.5, 0.2)}), ("SUN", {"energy": 3}),
                        ("SPOT", {"energy": 800, "spot_size": 0.9, "spot_blend": 0.4, "shadow_soft_size": 0}),
                        ("SPOT", {"energy": 800, "spot_size": 2.6, "spot_blend": 0.1, "shadow_soft_size": 0}),
                        ("AREA", {"energy": 300, "size": 1.5}), ("AREA", {"energy": 300, "shape": "ELLIPSE", "size": 1.5, "size_y": 0.5})):
        scene = room()
        lamp(scene, kind, **words)
        agrees(scene, 0.01)


@case
def a_wide_sun_has_soft_shadows():
    scene = room()
    lamp(scene, "SUN", 3, angle=0.4)
    agrees(scene, 0.01)
    other, mine = (colors(render(scene, engine)) for engine in ("CYCLES", "VELO"))
    assert abs(other - mine).mean() < 0.02 * other.mean(), abs(other - mine).mean() / other.mean()


@case
def bounces_are_counted_as_in_cycles():
    for bounces in (0, 1):
        scene = new_scene(bounces=bounces)
        bpy.ops.mesh.primitive_cube_add(size=8, location=(0, -3, 3))
        bpy.context.object.data.materials.append(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
        lamp(scene, "AREA", 300, size=1.5)
        agrees(scene, 0.01)


@case
def bounces_of_one_kind_are_counted_as_in_cycles():
    """In a closed room with glass and a mirror, that each limit makes darker. Its lamp hides nothing behind it."""
    limits = ("diffuse_bounces", "glossy_bounces", "transmission_bounces")
    means = []
    for counts in ((12, 12, 12), (0, 12, 12), (1, 12, 12), (12, 0, 12), (12, 12, 1)):
        scene = new_scene(bounces=12, samples=256)
        for name, count in zip(limits, counts):
            setattr(scene.cycles, name, count)
        bpy.ops.mesh.primitive_cube_add(size=8, location=(0, -3, 3))
        bpy.context.object.data.materials.append(material("ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6))[0])
        ball(material("ShaderNodeBsdfGlass", IOR=1.45)[0], (-1, 0, 1), 0.9)
        ball(material("ShaderNodeBsdfGlossy", Roughness=0.1)[0], (1, 0, 1), 0.9)
        lamp(scene, "AREA", 300, size=1.5)
        agrees(scene, 0.01)
        means.append(colors(render(scene)).mean())
    assert all(mean < 0.98 * means[0] for mean in means[1:]), means


@case
def shaders_that_transmit_and_mix():
    for kind, words in (("ShaderNodeBsdfTranslucent", {"Color": GRAY}), ("ShaderNodeBsdfRefraction", {"IOR": 1.3, "distribution": "SHARP"}),
                        ("ShaderNodeBsdfTransparent", None), ("ShaderNodeBsdfGlossy", None)):
        scene = new_scene(world=(0.5, 0.5, 0.5))
        plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
        made, node = material(kind, **(words or {}))
        if words is None:  # mixed with a diffuse one
            tree = made.node_tree
            mix, other = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfDiffuse")
            tree.links.new(node.outputs[0], mix.inputs[1])
            tree.links.new(other.outputs[0], mix.inputs[2])
            tree.links.new(mix.outputs[0], next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL").inputs[0])
        ball(made)
        agrees(scene, 0.01)


@case
def hair_of_particles():
    for kind, words in (("ShaderNodeBsdfDiffuse", {"Color": (0.7, 0.4, 0.2)}), ("ShaderNodeBsdfHairPrincipled", {"parametrization": "MELANIN"})):
        scene = new_scene(world=(1, 1, 1))
        item = ball(material(kind, **words)[0], (0, 0, 0.7), 0.8)
        with bpy.context.temp_override(object=item):
            bpy.ops.object.particle_system_add()
        options = item.particle_systems[0].settings
        options.type, options.count, options.hair_length, options.root_radius, options.radius_scale = "HAIR", 300, 0.6, 2.0, 0.02
        agrees(scene, 0.01)
        image = colors(render(scene))
        assert image[14:22, :, 0].min() < 0.9 and not notes(scene), notes(scene)


@case
def a_world_of_one_color():
    agrees(room(world=(0.5, 0.6, 0.8)), 0.01)


@case
def metal_and_glass():
    for kind, words in (("ShaderNodeBsdfGlossy", {"Color": (0.9, 0.6, 0.3), "Roughness": 0.3}),
                        ("ShaderNodeBsdfGlass", {"Color": (1, 1, 1), "Roughness": 0.1, "distribution": "GGX"}),
                        ("ShaderNodeBsdfPrincipled", {"Base_Color": GRAY, "Metallic": 1.0, "Roughness": 0.4})):
        scene = room(world=(0.3, 0.3, 0.3))
        ball(material(kind, **words)[0], (-1.5, -1, 1))
        lamp(scene, "AREA", 300, size=1.5)
        agrees(scene)


@case
def principled_without_layers():
    for rough, specular in ((0.1, 0.5), (0.5, 0.0), (0.5, 1.0), (0.9, 0.5)):
        scene = new_scene(world=(1, 1, 1))
        ball(material("ShaderNodeBsdfPrincipled", Base_Color=GRAY, Roughness=rough, Specular=specular)[0], (0, 0, 0.5), 1.7)
        agrees(scene, 0.006)


@case
def principled_is_no_source_of_light():
    """A white plane in a white world, at a slant: 1, where Cycles 3.4 has 1.16."""
    scene = new_scene(world=(1, 1, 1))
    plane(material("ShaderNodeBsdfPrincipled", Base_Color=(1, 1, 1), Roughness=0.5)[0], size=400)
    tilt = math.radians(80)
    scene.camera.location, scene.camera.rotation_euler = (0, -6 * math.sin(tilt), 6 * math.cos(tilt)), (tilt, 0, 0)
    scene.camera.data.lens = 300
    image = colors(render(scene))
    assert abs(image.mean() - 1) < 0.005, image.mean()


@case
def principled_with_layers():
    for layers in ({"Clearcoat": 1.0}, {"Sheen": 1.0}, {"Transmission": 0.6}, {"Metallic": 0.5}):
        scene = new_scene(world=(1, 1, 1))
        ball(material("ShaderNodeBsdfPrincipled", Base_Color=GRAY, Roughness=0.4, **layers)[0], (0, 0, 0.5), 1.7)
        agrees(scene, 0.02)


@case
def surfaces_that_emit():
    scene = new_scene()
    plane(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    ball(material("ShaderNodeEmission", Color=(1, 0.5, 0.2), Strength=3.0)[0])
    agrees(scene, 0.01)


@case
def depth_and_normals_are_those_of_cycles():
    scene = room(world=(1, 1, 1), samples=1)
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = True
    cycles, mine = render(scene, "CYCLES"), render(scene)
    depth, other = channel(mine, "Depth.Z"), channel(cycles, "Depth.Z")
    inner = abs(other - numpy.roll(other, 1, axis=0)) < 0.3
    assert numpy.median(abs(depth - other)[inner]) < 0.05
    assert numpy.median(abs(channel(mine, "Normal.Z") - channel(cycles, "Normal.Z"))) < 0.02


@case
def alpha_is_there_where_the_film_is_transparent():
    scene = new_scene(world=(1, 1, 1))
    ball(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    assert (channel(render(scene), "Combined.A") == 1).all()
    scene.render.film_transparent = True
    alpha = channel(render(scene), "Combined.A")
    other = channel(render(scene, "CYCLES"), "Combined.A")
    assert abs(alpha.mean() - other.mean()) < 0.005, (alpha.mean(), other.mean())


@case
def no_camera_is_one_line():
    scene = room()
    scene.camera = None
    refused(scene, "camera")


@case
def empty_scenes_are_black():
    assert colors(render(new_scene())).max() == 0


@case
def bad_objects_are_left_out():
    scene = room(world=(0.5, 0.5, 0.5))
    wrong = ball(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    wrong.location.x = float("nan")
    flat = ball(material("ShaderNodeBsdfDiffuse", Color=GRAY)[0])
    flat.scale = (0, 0, 0)
    empty = bpy.data.meshes.new("nothing")
    add_object(scene, "nothing", empty)
    lamp(scene, "AREA", 100, size=0.0)
    image = colors(render(scene))
    assert numpy.isfinite(image).all() and image.mean() > 0.1
    lines = "\n".join(notes(scene))
    assert "no number" in lines and "area is 0" in lines, lines


@case
def missing_images_are_listed_and_cycles_of_nodes_end():
    scene = room(world=(0.5, 0.5, 0.5))
    made, node = material("ShaderNodeBsdfDiffuse")
    picture = made.node_tree.nodes.new("ShaderNodeTexImage")
    picture.image = bpy.data.images.new("lost", 4, 4)
    picture.image.source = "FILE"
    picture.image.filepath = "/nowhere/lost.png"
    made.node_tree.links.new(picture.outputs[0], node.inputs[0])
    ball(made, (1, -1, 1))
    other, node = material("ShaderNodeBsdfDiffuse")
    one, two = (other.node_tree.nodes.new("ShaderNodeMixShader") for _ in range(2))
    other.node_tree.links.new(one.outputs[0], two.inputs[1])
    other.node_tree.links.new(two.outputs[0], one.inputs[1])
    output = next(n for n in other.node_tree.nodes if n.type == "OUTPUT_MATERIAL")
    other.node_tree.links.new(one.outputs[0], output.inputs[0])
    ball(other, (-1, -1, 1))
    assert numpy.isfinite(colors(render(scene))).all()
    lines = "\n".join(notes(scene))
    assert "lost.png is missing" in lines, lines


@case
def an_unknown_node_is_listed_by_its_name():
    scene = room(world=(0.5, 0.5, 0.5))
    made, _ = material("ShaderNodeBsdfToon")
    ball(made, (1, -1, 1))
    render(scene)
    assert any("Toon" in line for line in notes(scene)), notes(scene)


@case
def degenerate_cameras_are_one_line():
    for change, text in ((lambda item: setattr(item.data, "ortho_scale", 0.0), "degenerate"),
                         (lambda item: setattr(item, "scale", (0, 0, 0)), "singular"),
                         (lambda item: setattr(item.data, "clip_start", 2000.0), "near plane")):
        scene = room()
        scene.camera.data.type = "ORTHO" if text == "degenerate" else "PERSP"
        change(scene.camera)
        refused(scene, text)


@case
def odd_things_are_rendered():
    scene = room(world=(1, 1, 1), samples=4)
    bpy.ops.object.text_add(location=(0, -1, 1))
    bpy.ops.object.metaball_add(location=(-1, 0, 1))
    many = ball(material("ShaderNodeBsdfDiffuse")[0])
    many.scale = (-1, 1, 1)
    for face in many.data.polygons:
        face.material_index = face.index % 5
    many.data.use_auto_smooth = True
    many.data.normals_split_custom_set([(0, 0, 0)] * len(many.data.loops))
    bare = plane(None, 1.0, (0, 0, 2))
    bare.data.materials.append(None)
    bare.data.uv_layers[0].data[0].uv = (float("nan"), 1e30)
    for kind, name, value in (("ShaderNodeEmission", "Strength", -5.0), ("ShaderNodeBsdfPrincipled", "IOR", 0.0)):
        made, node = material(kind)
        node.inputs[name].default_value = value
        ball(made, (2, 0, 1), 0.3)
    unfinished = bpy.data.materials.new("unfinished")
    unfinished.use_nodes = True
    unfinished.node_tree.nodes.clear()
    ball(unfinished, (2, 1, 1), 0.3)
    lamp(scene, "POINT", 1e30)
    lamp(scene, "SUN", -3.0)
    assert numpy.isfinite(colors(render(scene))).all()
    assert any("unfinished" in line for line in notes(scene)), notes(scene)


@case
def a_render_can_be_ended():
    """Also while it denoises. What the first pass has shown is kept."""
    from velo_blender import engine, passes
    scene = room(size=(320, 240), samples=65536)
    lamp(scene, "AREA", 300, size=1.5)
    kept, filled = engine.VeloRenderEngine.is_stopped, []
    fill = passes.fill
    passes.fill = lambda *words: (filled.append(time.monotonic()), fill(*words))
    engine.VeloRenderEngine.is_stopped = lambda self: bool(filled) and time.monotonic() > filled[0] + 0.1
    try:
        for samples, denoise in ((65536, False), (4, True)):
            filled.clear()
            scene.velo.samples, scene.velo.denoise = samples, denoise
            bpy.ops.render.render()
            assert time.monotonic() - filled[0] < 3, time.monotonic() - filled[0]
    finally:
        engine.VeloRenderEngine.is_stopped, passes.fill = kept, fill


def all_passes(scene):
    """Switches on all passes, denoising data and the denoiser."""
    layer = scene.view_layers[0]
    for name in ("z", "normal", "position", "uv", "vector", "object_index", "material_index", "cryptomatte_object", "cryptomatte_material",
                 "cryptomatte_asset"):
        setattr(layer, "use_pass_" + name, True)
    layer.velo.denoising_data = scene.velo.denoise = True


@case
def steps_between_two_looks_are_short():
    """Whether the user has ended the render is asked often, at 1280 x 720 with all passes and the denoiser: steps of Blender's thread of more
    than .04 s of its CPU time take less than .3 s together. By measurement there are one or two, where the first pass is shown."""
    from velo_blender import engine
    scene = room(size=(1280, 720), samples=2)
    all_passes(scene)
    kept, looks = engine.VeloRenderEngine.is_stopped, []
    engine.VeloRenderEngine.is_stopped = lambda self: bool(looks.append(time.thread_time()))
    try:
        bpy.ops.render.render()
    finally:
        engine.VeloRenderEngine.is_stopped = kept
    looks.append(time.thread_time())
    steps = numpy.diff(looks)
    assert len(looks) > 200 and steps[steps > 0.04].sum() < 0.3, (len(looks), sorted(steps)[-10:])


@case
def the_first_image_is_kept_whole():
    """Where the render is ended while it is shown, in strips."""
    from velo_blender import engine, passes
    scene = room(size=(320, 400), samples=64, world=(1, 1, 1))
    all_passes(scene)
    kept, fill, filled = engine.VeloRenderEngine.is_stopped, passes.fill, []
    keep, whole = passes.Target.keep, []

    def keep_and_look(target, image, film):
        keep(target, image, film)
        item = target.engine.get_result().layers[target.layer].passes.find_by_name("Combined", target.view)
        whole.append(numpy.array(item.rect))
    passes.fill = lambda *words: (filled.append(1), fill(*words))
    passes.Target.keep = keep_and_look
    engine.VeloRenderEngine.is_stopped = lambda self: bool(filled)
    try:
        bpy.ops.render.render()
    finally:
        engine.VeloRenderEngine.is_stopped, passes.fill, passes.Target.keep = kept, fill, keep
    assert len(filled) == 1 and len(whole) == 1, (len(filled), len(whole))
    rows = whole[0].reshape(400, 320, 4)
    assert (rows[..., 3] == 1).all() and rows[..., :3].reshape(400, -1).max(axis=1).min() > 0.1


@case
def a_render_ends_while_passes_are_filled():
    """Before each pass, and inside Vector and Cryptomatte: where it is asked, it ends."""
    from velo_blender import engine, passes
    scene = room(size=(96, 128), samples=1)
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_vector = layer.use_pass_cryptomatte_object = True
    kept, made, asked, last = engine.VeloRenderEngine.is_stopped, passes.Made, [], []

    def is_stopped(_):
        if asked:
            asked[0] += 1
        return bool(asked) and asked[0] == last[0]
    engine.VeloRenderEngine.is_stopped = is_stopped
    passes.Made = lambda *words: (asked.append(0), made(*words))[1]
    try:
        counts = []
        for end in (-1, 1, 9, 20):
            asked.clear()
            last[:] = [end]
            bpy.ops.render.render()
            counts.append(asked[0])
    finally:
        engine.VeloRenderEngine.is_stopped, passes.Made = kept, made
    assert counts[0] > 6 + 8 + 12 and counts[1:] == [1, 9, 20], counts


@case
def suns_and_copies_are_read_without_waste():
    """A sun's image is filled where its disk is, and only materials that ask for it cost an object its random number."""
    from velo_blender import lights, noise

    class Lights:
        """A scene that drops its lights."""

        def add_light(self, kind, **words):
            image = numpy.asarray(words["image"])
            assert kind == "infinite" and image.shape == (2048, 2048, 3) and numpy.count_nonzero(image) < 3000
    tracemalloc.start()
    lights.add_disk(Lights(), numpy.array((0.0, 0, 1)), 0.0046, numpy.array((3.0, 2, 1)))
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 1.5 * 2048 * 2048 * 12, most
    scene = room(samples=1, world=(1, 1, 1))
    add_object(scene, "copy", bpy.data.objects["Sphere"].data, (1, 1, 1))
    kept, hashed = noise.hash_words, []
    noise.hash_words = lambda *words: (hashed.append(words), kept(*words))[1]
    try:
        render(scene)
    finally:
        noise.hash_words = kept
    assert len(hashed) <= 2, len(hashed)  # one for each mesh
