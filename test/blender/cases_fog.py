"""Cases of test_fog.py: the world's volume and cameras inside of volumes agree with Cycles."""
import bpy
import numpy

from inside import add, ball, case, colors, lamp, material, new_scene, notes, plane, render


def diffuse_scene(world, samples=150, bounces=2):
    """A floor and a ball, diffuse. bounces: of Cycles, in volumes; lamps in thick fog are noisy beyond."""
    scene = new_scene(world=world, samples=samples)
    scene.cycles.volume_bounces = bounces
    plane(material("ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6))[0])
    ball(material("ShaderNodeBsdfDiffuse", Color=(0.7, 0.4, 0.3))[0], (0, 0, 1), 1)
    return scene


def foggy(density, world=(0, 0, 0), kind="ShaderNodeVolumePrincipled", **values):
    """That scene in a fog: (scene, tree of the world, node of the volume)."""
    scene = diffuse_scene(world)
    tree = scene.world.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    return scene, tree, add(tree, kind, output.inputs["Volume"], Density=density, **{"Color": (0.8, 0.7, 0.6, 1), **values})


def volume_material(**values):
    """A material of a Principled Volume alone: (material, tree, node)."""
    made, node = material("ShaderNodeBsdfDiffuse")
    tree = made.node_tree
    tree.nodes.remove(node)
    output = next(known for known in tree.nodes if known.type == "OUTPUT_MATERIAL")
    return made, tree, add(tree, "ShaderNodeVolumePrincipled", output.inputs["Volume"], **values)


def full_of_fog(world, size=30.0, **values):
    """That scene in a cube of fog: (scene, the cube)."""
    scene = diffuse_scene(world)
    scene.objects["Plane"].scale = (0.4, 0.4, 1)
    bpy.ops.mesh.primitive_cube_add(size=size, location=(0, 0, 0))
    item = bpy.context.object
    item.name = "fog"
    item.data.materials.append(volume_material(**{"Color": (0.8, 0.7, 0.6, 1), "Density": 0.15, **values})[0])
    return scene, item


def agrees(scene, share=0.02, blocks=0.04):
    """Means of the image, and of 8 x 8 blocks in the mean, agree with Cycles."""
    cycles, mine = colors(render(scene, "CYCLES")), colors(render(scene))
    of_cycles, of_mine = cycles.mean(axis=(0, 1)), mine.mean(axis=(0, 1))
    assert (abs(of_mine / of_cycles - 1) < share).all(), "Cycles %s, velo %s" % (of_cycles, of_mine)
    parts = [image.reshape(8, 6, 8, 6, 3).mean(axis=(1, 3)) for image in (cycles, mine)]
    difference = abs(parts[0] - parts[1]).mean() / parts[0].mean()
    assert difference < blocks, difference


@case
def lamps_in_the_fog_of_the_world():
    for density, kind, energy, values in ((0.03, "POINT", 300, {"shadow_soft_size": 0.0}), (0.15, "POINT", 300, {"shadow_soft_size": 0.0}),
                                          (0.03, "SPOT", 600, {"shadow_soft_size": 0.0}), (0.03, "AREA", 300, {"size": 1.0}),
                                          (0.15, "AREA", 300, {"size": 1.0}), (0.3, "AREA", 300, {"size": 1.0, "shape": "DISK"})):
        scene, _, _ = foggy(density)
        lamp(scene, kind, energy, **values)
        agrees(scene, blocks=0.06)
        assert not notes(scene), notes(scene)


@case
def fog_that_only_absorbs_or_scatters_forward():
    for kind, values in (("ShaderNodeVolumeAbsorption", {"Color": (0.9, 0.5, 0.2, 1)}), ("ShaderNodeVolumeScatter", {"Anisotropy": 0.6})):
        scene, _, _ = foggy(0.1, kind=kind, **values)
        lamp(scene, "AREA", 300, size=1.0)
        agrees(scene)
        assert not notes(scene), notes(scene)


@case
def endless_fog_hides_suns_and_the_background():
    """As in Cycles. Those of a cube of fog shine into it."""
    for world, sun in (((0.5, 0.6, 0.7), False), ((0, 0, 0), True)):
        scene, _, _ = foggy(0.03, world)
        if sun:
            lamp(scene, "SUN", 3, angle=0.1)
        assert max(colors(render(scene, engine)).max() for engine in ("CYCLES", "VELO")) < 1e-6
        assert not notes(scene), notes(scene)
        scene, _ = full_of_fog(world)
        if sun:
            lamp(scene, "SUN", 3, angle=0.1)
        agrees(scene)
        assert not notes(scene), notes(scene)


@case
def volumes_in_the_fog_of_the_world():
    """There Cycles has the sum of both: a cloud of one density, then one whose density varies."""
    scene, _, _ = foggy(0.1)
    lamp(scene, "AREA", 300, size=1.0)
    made, tree, volume = volume_material(Color=(0.8, 0.3, 0.2, 1), Density=1.0)
    ball(made, (1.5, -1, 1), 1)
    agrees(scene)
    noise = add(tree, "ShaderNodeTexNoise", Scale=1.5, Detail=0.0)
    steep = add(tree, "ShaderNodeMath", volume.inputs["Density"], operation="MULTIPLY_ADD")
    steep.inputs[1].default_value, steep.inputs[2].default_value = 12.0, -5.0
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Object"], noise.inputs["Vector"])
    tree.links.new(noise.outputs[0], steep.inputs[0])
    agrees(scene)
    assert not notes(scene), notes(scene)


def lit_once(scene, place, radius, power, extinction, scattering, turned):
    """The mean radiance of fog that scatters the light of a lamp once, by sums over rays, steps and points of the lamp: a sphere that
    emits outwards, or, turned, a disk that faces each point."""
    from velo_blender import export
    camera = export.camera_of(bpy.context.evaluated_depsgraph_get(), (48, 48))
    x, y = numpy.meshgrid(numpy.arange(8) * 6 + 3.0, numpy.arange(8) * 6 + 3.0)
    rays = camera.unproject(numpy.stack((x.ravel(), y.ravel()), axis=1))
    along = numpy.asarray(rays.directions, dtype=float)
    along = along / numpy.linalg.norm(along, axis=1, keepdims=True)
    forward = numpy.array(camera.world_from_camera, dtype=float)[:3, 2]
    start = numpy.asarray(rays.origins, dtype=float) + along * (scene.camera.data.clip_start / (along @ forward))[:, None]
    number = numpy.arange(400) + 0.5
    z, turn = 1 - number / 200, number * numpy.pi * (3 - 5 ** 0.5)
    normals = numpy.stack((numpy.sqrt(1 - z * z) * numpy.cos(turn), numpy.sqrt(1 - z * z) * numpy.sin(turn), z), axis=1)
    total, step = 0.0, 0.1
    for t in numpy.arange(0.5 * step, 40, step):
        if turned:
            distance = numpy.linalg.norm(start + t * along - place, axis=1)[:, None]
            length = numpy.sqrt(distance**2 + radius**2 * (numpy.arange(32) + 0.5) / 32)
            cosine, share = distance / length, 1 / 32
        else:
            way = (start + t * along)[:, None] - (place + radius * normals)
            length = numpy.linalg.norm(way, axis=2)
            cosine, share = numpy.maximum((way * normals).sum(axis=2), 0) / length, 4 / 400
        light = (cosine / length**2 * numpy.exp(-extinction * length)).sum(axis=1) * share * power / (4 * numpy.pi)
        total += (light * numpy.exp(-extinction * t)).mean() * step * scattering / (4 * numpy.pi)
    return total


@case
def a_lamp_with_a_radius_in_thick_fog():
    """velo's is a sphere. Cycles 3.4 turns a disk to each point, which loses the light that its fog would scatter close to it."""
    scene, _, _ = foggy(0.3, Color=(0.8, 0.8, 0.8, 1))
    for name in ("Plane", "Sphere"):
        bpy.data.objects.remove(scene.objects[name])
    scene.cycles.max_bounces = scene.cycles.volume_bounces = 0
    place = (2, -2, 4)
    lamp(scene, "POINT", 300, place, shadow_soft_size=0.3)
    for engine, turned in (("VELO", False), ("CYCLES", True)):
        mean, expected = colors(render(scene, engine)).mean(), lit_once(scene, place, 0.3, 300, 0.3, 0.24, turned)
        assert abs(mean / expected - 1) < 0.01, (engine, mean, expected)


@case
def cameras_inside_of_volumes():
    """A cube of fog about the camera, also a mirrored one and one that glows; the camera outside of it; the fog of a lamp nearby."""
    for energy, size, scale, values in ((0, 30, 1, {}), (300, 30, -1, {}), (0, 30, 1, {"Emission Strength": 0.05, "Emission Color": (1, 0.5, 0.1, 1)}),
                                        (0, 4, 1, {"Density": 0.5})):
        scene, item = full_of_fog((0.5, 0.5, 0.6), size, **values)
        item.scale = (scale, 1, 1)
        if energy:
            lamp(scene, "POINT", energy, shadow_soft_size=0.0)
        agrees(scene)
        assert not notes(scene), notes(scene)


@case
def the_medium_follows_the_camera():
    """Of the same scene in velo: inside of a cube that absorbs, then outside of it, then beside a cavity whose faces look inwards."""
    from velo_blender import export
    scene, item = full_of_fog((1, 1, 1), 4.0)
    graph = bpy.context.evaluated_depsgraph_get()
    made = export.Export(graph, (8, 8))
    assert made.scene.camera_medium is None
    for height, inside in ((1.9, True), (2.1, False), (-1.9, True), (-2.1, False)):
        pose = numpy.eye(4)
        pose[:3, 3] = 0.0, 0.0, height
        made.immerse(made.camera.move(pose))
        assert (made.scene.camera_medium is not None) == inside, height
    item.data.flip_normals()
    made = export.Export(bpy.context.evaluated_depsgraph_get(), (8, 8))
    made.immerse(made.camera.move(numpy.eye(4)))
    assert made.scene.camera_medium is None


@case
def fogs_that_velo_has_not_are_listed():
    scene, tree, volume = foggy(0.1)
    noise = add(tree, "ShaderNodeTexNoise", volume.inputs["Density"])
    lamp(scene, "AREA", 300, size=1.0)
    render(scene)
    assert notes(scene) == ["world, Volume: its density varies; the world's volume is not rendered"], notes(scene)
    tree.nodes.remove(noise)
    tree.links.new(add(tree, "ShaderNodeHairInfo").outputs["Random"], volume.inputs["Anisotropy"])
    render(scene)
    assert len(notes(scene)) == 1 and notes(scene)[0].endswith("its anisotropy varies; the volume is not rendered"), notes(scene)
    scene, _, _ = foggy(3e38)
    render(scene)
    assert notes(scene) == ["world, Volume: it is too dense; the world's volume is not rendered"], notes(scene)
    scene, tree, _ = foggy(0.0)
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    add(tree, "ShaderNodeEmission", output.inputs["Volume"])
    render(scene)
    assert notes(scene) == ["world, Volume: its emission has no end; the world's volume is not rendered"], notes(scene)
    scene, _, _ = foggy(float("nan"))
    assert numpy.isfinite(colors(render(scene))).all()
    assert any("Density is no finite number" in line for line in notes(scene)), notes(scene)
    scene, _, _ = foggy(0.1, Blackbody_Intensity=1.0, Temperature=1e30)
    image = colors(render(scene))
    assert numpy.isfinite(image).all() and image.mean() > 1e3, image.mean()
    scene, _, _ = foggy(0.1, (0.5, 0.5, 0.5), "ShaderNodeVolumeScatter", Color=(0.8, 0, 0, 1))
    render(scene)
    assert notes(scene) == ["world, Volume: it lets suns and the background pass in the colours that it does not weaken"], notes(scene)


@case
def volumes_that_overlap_are_listed():
    scene, _ = full_of_fog((0.5, 0.5, 0.5))
    bpy.ops.mesh.primitive_cube_add(size=25, location=(0, 0, 0))
    bpy.context.object.name = "second"
    bpy.context.object.data.materials.append(volume_material()[0])
    render(scene)
    assert sorted(notes(scene)) == ["fog, Volume: the camera is in that of second, too, and sees that one alone",
                                    "second, Volume: where it overlaps that of fog, one of them is rendered"], notes(scene)
