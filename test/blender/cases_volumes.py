"""Cases of test_volumes.py: what lies below surfaces agrees with Cycles."""
import os

import bpy
import numpy

from inside import FOLDER, Missing, add, agrees, ball, case, colors, lamp, material, new_scene, notes, plane, render


def filled(surface, kind, **values):
    """A ball with a volume before a floor: (scene, tree, volume's node). surface: a shader's kind, None: no surface."""
    scene = new_scene(world=(0.5, 0.5, 0.6))
    scene.cycles.volume_bounces = 8
    plane(material("ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6))[0])
    made, node = material(surface or "ShaderNodeBsdfDiffuse")
    tree = made.node_tree
    output = next(known for known in tree.nodes if known.type == "OUTPUT_MATERIAL")
    if surface is None:
        tree.nodes.remove(node)
    else:
        node.distribution = "SHARP"
    volume = add(tree, kind, output.inputs["Volume"], **values)
    ball(made, (0, 0, 1.2), 1.2)
    return scene, tree, volume


@case
def fog_and_tinted_glass():
    for surface, kind, values in ((None, "ShaderNodeVolumePrincipled", {"Color": (0.6, 0.7, 0.9, 1), "Density": 1.0}),
                                  (None, "ShaderNodeVolumeScatter", {"Color": (0.9, 0.6, 0.4, 1), "Density": 0.7, "Anisotropy": 0.5}),
                                  ("ShaderNodeBsdfGlass", "ShaderNodeVolumeAbsorption", {"Color": (0.9, 0.4, 0.2, 1), "Density": 0.8})):
        scene, _, _ = filled(surface, kind, **values)
        if surface is None:
            lamp(scene, "AREA", 200, size=2)
        agrees(scene, 0.01)
        assert not notes(scene), notes(scene)


@case
def a_density_of_noise():
    scene, tree, volume = filled(None, "ShaderNodeVolumePrincipled", Color=(0.8, 0.8, 0.8, 1))
    noise = add(tree, "ShaderNodeTexNoise", Scale=1.5, Detail=0.0)
    steep = tree.nodes.new("ShaderNodeMath")
    steep.operation, steep.inputs[1].default_value, steep.inputs[2].default_value = "MULTIPLY_ADD", 12.0, -5.0
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Object"], noise.inputs["Vector"])
    tree.links.new(noise.outputs[0], steep.inputs[0])
    tree.links.new(steep.outputs[0], volume.inputs["Density"])
    agrees(scene, 0.02)
    assert not notes(scene), notes(scene)


@case
def a_volume_that_glows():
    scene, _, _ = filled(None, "ShaderNodeVolumePrincipled", Color=(0.2, 0.2, 0.2, 1), Density=1.0, Emission_Strength=0.5,
                         Emission_Color=(1.0, 0.5, 0.1, 1))
    agrees(scene, 0.02)


@case
def light_scatters_below_surfaces():
    for kind, values in (("ShaderNodeBsdfPrincipled", {"Subsurface": 1.0, "Subsurface_Radius": (0.1, 0.05, 0.03)}),
                         ("ShaderNodeSubsurfaceScattering", {"Scale": 0.05, "Color": (0.8, 0.5, 0.3)})):
        scene = new_scene(world=(1, 1, 1))
        made, node = material(kind, **values)
        if kind.endswith("Principled"):
            node.inputs["Base Color"].default_value = node.inputs["Subsurface Color"].default_value = (0.8, 0.5, 0.3, 1)
        ball(made, (0, 0, 0.5), 1.7)
        agrees(scene, 0.05)
        assert not notes(scene), notes(scene)


@case
def volumes_that_velo_has_not_are_listed():
    scene, tree, volume = filled(None, "ShaderNodeVolumePrincipled")
    tree.links.new(add(tree, "ShaderNodeHairInfo").outputs["Random"], volume.inputs["Density"])
    render(scene)
    assert any("volume is not rendered" in line for line in notes(scene)), notes(scene)
    scene = new_scene(world=(1, 1, 1))
    item = bpy.data.objects.new("cloud", bpy.data.volumes.new("cloud"))
    scene.collection.objects.link(item)
    assert colors(render(scene)).min() > 0.9
    assert any("the volume is not rendered" in line for line in notes(scene)), notes(scene)


def cloud(path, render_space="OBJECT", scale=(1, 1, 1), **values):
    """A volume object of an OpenVDB file in the light of a lamp, and nothing else: (scene, object)."""
    scene = new_scene(samples=200)
    scene.cycles.volume_bounces = 8
    scene.cycles.volume_step_rate = 0.2
    made, _ = material("ShaderNodeBsdfDiffuse")
    tree = made.node_tree
    output = next(known for known in tree.nodes if known.type == "OUTPUT_MATERIAL")
    tree.nodes.remove(next(known for known in tree.nodes if known.type != "OUTPUT_MATERIAL"))
    add(tree, "ShaderNodeVolumePrincipled", output.inputs["Volume"], **values)
    data = bpy.data.volumes.new("cloud")
    data.filepath, data.render.space = path, render_space
    item = bpy.data.objects.new("cloud", data)
    scene.collection.objects.link(item)
    data.materials.append(made)
    item.location, item.scale, item.rotation_euler = (0.2, 0, 1.2), scale, (0.2, 0.1, 0.5)
    lamp(scene, "AREA", 800, size=2)
    return scene, item


def openvdb():
    """The Python module that writes OpenVDB files."""
    try:
        import pyopenvdb
    except ImportError as error:
        raise Missing("the Python module pyopenvdb is not installed (script/bootstrap blender)") from error
    return pyopenvdb


def write_grid(name="density", ijk=(-16, -12, -8)):
    """An OpenVDB file of 32 x 24 x 16 voxels of 0.06, dense on one side."""
    pyopenvdb = openvdb()
    x, y, z = numpy.meshgrid(numpy.linspace(-1, 1, 32), numpy.linspace(-1, 1, 24), numpy.linspace(-1, 1, 16), indexing="ij")
    values = numpy.maximum(0, 1.2 - x * x - y * y - z * z) * (2 + x)
    grid = pyopenvdb.FloatGrid()
    grid.copyFromArray(values.astype("float32"), ijk=ijk)
    grid.name, grid.transform = name, pyopenvdb.createLinearTransform(0.06)
    path = os.path.join(FOLDER, "cloud.vdb")
    pyopenvdb.write(path, grids=[grid])
    return path


@case
def files_of_openvdb():
    path = write_grid()
    for space, scale, density in (("OBJECT", (1, 1, 1), 1.0), ("OBJECT", (1.3, 1.3, 1.3), 4.0), ("WORLD", (1.0, 1.2, 1.4), 2.0)):
        scene, _ = cloud(path, space, scale, Color=(0.6, 0.7, 0.9, 1), Density=density)
        mine, other = colors(render(scene)), colors(render(scene, "CYCLES"))
        assert not notes(scene), notes(scene)
        assert (abs(mine.mean(axis=(0, 1)) / other.mean(axis=(0, 1)) - 1) < 0.03).all(), (space, scale, mine.mean(), other.mean())
        blocks = [image.reshape(8, 6, 8, 6, 3).mean(axis=(1, 3, 4)) for image in (mine, other)]  # the light and dark sides, without the noise
        difference = abs(blocks[0] - blocks[1]).mean() / blocks[1].mean()
        assert difference < 0.04, (space, scale, difference)


def write_fire(odd=False, step=0.06):
    """An OpenVDB file of smoke whose colour and temperature vary: grids density, color and temperature. odd: a voxel of the temperature is
    NaN. step: size of the voxels of the temperature."""
    pyopenvdb = openvdb()
    x, y, z = numpy.meshgrid(numpy.linspace(-1, 1, 32), numpy.linspace(-1, 1, 24), numpy.linspace(-1, 1, 16), indexing="ij")
    ball = numpy.maximum(0, 1.2 - x * x - y * y - z * z)
    heat = numpy.where(ball > 0, 1 + 0.3 * x + 0.2 * z, 0)
    grids = []
    for name, values in (("density", ball * 2), ("color", numpy.stack((0.5 + 0.4 * x, 0.5 + 0 * y, 0.5 - 0.4 * z), axis=3)), ("temperature", heat)):
        grid = pyopenvdb.Vec3SGrid() if name == "color" else pyopenvdb.FloatGrid()
        grid.copyFromArray(values.astype("float32"), ijk=(-16, -12, -8))
        if odd and name == "temperature":
            grid.fill((0, 0, 0), (0, 0, 0), float("nan"))
        grid.name, grid.transform = name, pyopenvdb.createLinearTransform(step if name == "temperature" else 0.06)
        grids.append(grid)
    path = os.path.join(FOLDER, "fire.vdb")
    pyopenvdb.write(path, grids=grids)
    return path


@case
def grids_of_colors_and_temperatures():
    for scale, values, share in ((1, {"Color_Attribute": "color", "Color": (0.9, 0.8, 1, 1)}, 0.02),
                                 (1.3, {"Color_Attribute": "color", "Absorption_Color": (0.2, 0.3, 0.1, 1)}, 0.02),
                                 (1, {"Blackbody_Intensity": 1.0, "Temperature": 1500.0}, 0.04),
                                 (1.3, {"Blackbody_Intensity": 0.7, "Temperature": 2000.0, "Blackbody_Tint": (1, 0.8, 0.9, 1),
                                        "Color_Attribute": "color"}, 0.04)):
        scene, _ = cloud(write_fire(), scale=(scale,) * 3, **{"Density": 2.0, **values})
        agrees(scene, share)
        assert not notes(scene), notes(scene)


@case
def grids_of_temperatures_that_are_left_out_are_listed():
    for words, line in (({"odd": True}, "1 of its numbers are NaN or infinite; they are 0"),
                        ({"step": 0.07}, "its voxels are not those of the density; it is left out")):
        scene, _ = cloud(write_fire(**words), Blackbody_Intensity=1.0)
        scene.velo.samples = 4
        assert numpy.isfinite(colors(render(scene))).all()
        assert notes(scene) == ["cloud, grid temperature of fire.vdb: " + line], notes(scene)
    scene, _ = cloud(write_fire(), Temperature_Attribute="density", Color_Attribute="temperature", Blackbody_Intensity=1.0)
    scene.velo.samples = 4
    render(scene)
    assert notes(scene) == ["cloud, grid temperature of fire.vdb: it has no grid temperature of colours; it is left out"], notes(scene)


@case
def a_volume_of_one_temperature():
    for kelvin, density in ((1500.0, 1.0), (3000.0, 0.0)):
        scene, _, _ = filled(None, "ShaderNodeVolumePrincipled", Density=density, Blackbody_Intensity=1.0, Temperature=kelvin)
        agrees(scene, 0.02)
        assert not notes(scene), notes(scene)


@case
def files_of_openvdb_in_the_fog_of_the_world():
    scene, _ = cloud(write_grid(), Color=(0.6, 0.7, 0.9, 1), Density=4.0)
    tree = scene.world.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    add(tree, "ShaderNodeVolumePrincipled", output.inputs["Volume"], Color=(0.9, 0.7, 0.5, 1), Density=0.05)
    agrees(scene, 0.03)
    assert not notes(scene), notes(scene)


@case
def files_of_openvdb_that_are_not_rendered_are_listed():
    garbage = os.path.join(FOLDER, "garbage.vdb")
    with open(garbage, "wb") as file:
        file.write(b" BDV" + bytes(range(200)))
    paths = {garbage: "garbage.vdb", "": "", os.path.join(FOLDER, "missing.vdb"): "missing.vdb"}
    for path, name in paths.items():
        scene, _ = cloud(path)
        render(scene)
        start = "cloud, grid density of %s: " % name if name else "cloud, grid density: "
        assert any(line.startswith(start) and line.endswith("the volume is not rendered") for line in notes(scene)), (path, notes(scene))


@case
def grids_of_openvdb_that_are_not_rendered_are_listed():
    scene, item = cloud(write_grid("smoke"))
    render(scene)
    assert "cloud, grid density of cloud.vdb: it has no grid density of numbers; the volume is not rendered" in notes(scene), notes(scene)
    scene, item = cloud(write_grid())
    tree = item.data.materials[0].node_tree
    volume = next(node for node in tree.nodes if node.type == "PRINCIPLED_VOLUME")
    add(tree, "ShaderNodeTexNoise", volume.inputs["Density"])
    render(scene)
    assert any("cloud, Principled Volume" in line for line in notes(scene)), notes(scene)


def write_voxels(*voxels):
    """An OpenVDB file of a grid density with a few voxels, (place, value) each."""
    pyopenvdb = openvdb()
    grid = pyopenvdb.FloatGrid()
    for place, value in voxels:
        grid.fill(place, place, value)
    grid.name = "density"
    path = os.path.join(FOLDER, "odd.vdb")
    pyopenvdb.write(path, grids=[grid])
    return path


@case
def voxels_that_are_left_out_are_listed():
    line = "cloud, grid density of odd.vdb: %s"
    nothing = line % "it has no value above 0; the volume is not rendered"
    odd = line % "2 of its voxels are NaN or infinite; they are 0"
    too_dense = line % "it is too dense; the volume is not rendered"
    for values, wanted in (((-1.0, -2.0), [nothing]), ((0.0, 0.0), [nothing]), ((float("nan"), float("inf"), 1.0), [odd]),
                           ((float("nan"), float("-inf"), -1.0), [odd, nothing]), ((-1.0, 2.0), []), ((1.0, 3e38), [too_dense])):
        scene, _ = cloud(write_voxels(*(((k, 0, 0), value) for k, value in enumerate(values))))
        scene.velo.samples = 4
        image = colors(render(scene))
        assert numpy.isfinite(image).all() and notes(scene) == wanted, (values, notes(scene))


@case
def grids_without_numbers_are_read():
    """Values that are no numbers or negative are 0; an empty grid and one of too many voxels are listed."""
    from velo_blender import openvdb_files
    data = bpy.data.volumes.new("odd")

    def read(*voxels):
        data.filepath = write_voxels(*voxels)
        data.grids.unload()
        return openvdb_files.read(data, "density")

    values = float("nan"), float("inf"), -1.0, 2.0
    grid = read(*(((5, 6, 7 + k), value) for k, value in enumerate(values)))
    assert grid.values.shape == (6, 3, 3) and grid.values[4, 1, 1] == 2 and grid.values.sum() == 2 and grid.odd == 2
    assert grid.low == (4, 5, 6) and grid.high == (7, 8, 12)
    for voxels, text in (((), "empty"), ((((0, 0, 0), 1.0), ((9000, 9000, 9000), 1.0)), "too many")):
        try:
            read(*voxels)
        except openvdb_files.Unread as error:
            assert text in str(error), error
            continue
        raise AssertionError("it was read")
