"""volumes.py: volumes of meshes as velo's media: homogeneous ones, and those whose density varies as a grid over the object's box; volumes
of OpenVDB files.

Coefficients are per unit of length of the world, as in Cycles (kernel/svm/closure.h): scattering colour * density, absorption
(1 - colour) * density."""
from typing import Any, NamedTuple

import numpy

from . import evaluate, heat, links, openvdb_files

CELLS = 64  # along a side of a grid of densities
MAX_RICH = 1 << 22  # voxels of grids of colours and temperatures
DENSEST = 1e30  # coefficients per unit of length
LUMINANCE_OF_ONE = 106.856895  # of a spectrum that is 1: the integral of the eye's sensitivity, nm; velo's RGB grids emit by it


class Volume(NamedTuple):
    """Coefficients for a density of 1; density: a number, or None where it varies and density_socket and groups say how."""
    absorption: Any
    scattering: Any
    emission: Any
    g: float
    density: Any
    socket: Any = None
    groups: tuple = ()
    tint: Any = 1.0  # factor on 1 - the colour, of the absorption
    density_of_color: float = 1.0  # factor on the coefficients since they were those of the colour


def medium(material, inputs, box, matrix, fog=None):
    """velo's medium inside of a material's surface; None: it has no volume, or none that velo has (noted). box: (low, high) of the mesh in
    the object's space; matrix: world from object; fog: the world's Volume, which is there, too."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return None
    output = links.output_node(material.node_tree, "OUTPUT_MATERIAL")
    if output is None or not output.inputs["Volume"].is_linked:
        return None

    def made():
        volume = _volume(output.inputs["Volume"], (), inputs, 0)
        return _add(volume, inputs, box, matrix, fog) if volume is not None else None

    return _noted(inputs, made)


def of_socket(socket, inputs):
    """The Volume of a socket; None: it has none, or none that velo has (noted)."""
    return _noted(inputs, lambda: _volume(socket, (), inputs, 0))


def with_density_1(volume):
    """The same Volume, of a density that does not vary, with a density of 1."""
    return _scaled(volume, volume.density)._replace(density=1.0)


def add_homogeneous(volume, inputs):
    """velo's medium of a Volume whose density does not vary; None: there is nothing in it."""
    words = _words(volume, inputs, volume.density, 1e-6)
    return None if words is None else inputs.scene.add_medium("homogeneous", **words)


def _noted(inputs, function):
    """What a function returns; None, with a line in the list, where it raises what velo does not have."""
    try:
        return function()
    except evaluate.Unsupported as error:
        inputs.notes.add(inputs.owner, error.node.name, "%s; the volume is not rendered" % error.text)
    except links.Cyclic as error:
        inputs.notes.add(inputs.owner, "Volume", "%s; it is not rendered" % error)
    return None


def add_file(data, material, inputs, matrix, fog=None):
    """velo's medium of a volume object: (handle, world from voxels, openvdb_files.Grid); None: it has none (noted). data: the evaluated
    object's; matrix: world from object; fog: the world's Volume, which is there, too. As in Cycles, a density for the object's space is
    that of the length of its diagonal."""
    shader = _noted(inputs, lambda: _shader_of_file(data, material, inputs))
    if shader is None:
        return None
    volume, name, more = shader
    grid = _grid_of_file(data, name, inputs)
    if grid is None:
        return None
    scale = numpy.linalg.norm(matrix[:3, :3] @ numpy.full(3, 3 ** -0.5)) if data.render.space == "OBJECT" else 1.0
    words = _words(volume, inputs, volume.density / max(scale, 1e-30))
    if words is None and more is None:
        return None
    if words is not None and not max(words["sigma_a"] + words["sigma_s"]) * float(grid.values.max()) < DENSEST:
        inputs.notes.add(inputs.owner, openvdb_files.label(data, name), "it is too dense; the volume is not rendered")
        return None
    pose = matrix @ grid.matrix
    if more is not None:
        more = more._replace(strength=1 / max(scale, 1e-30))
        found = _add_rich(_scaled(volume, volume.density * more.strength), grid, more, data, inputs, pose, fog)
        if found is not None or words is None:
            return found
    if fog is not None:
        wide = {"low": tuple(x - 1 for x in grid.low), "high": tuple(x + 1 for x in grid.high), "pose": pose}  # velo's grids fall to 0 there
        values = numpy.pad(grid.values, 1)
        return _add_in_fog(_scaled(volume, volume.density / max(scale, 1e-30)), fog, inputs, values, **wide), pose, grid
    return inputs.scene.add_medium("grid", density=grid.values, low=grid.low, high=grid.high, pose=pose, **words), pose, grid


class Rich(NamedTuple):
    """What the other grids of a file are for. color: the name of that by which the colour is multiplied, or empty; temperature: that of
    the temperatures of warmth, a heat.Heat; None: it emits nothing by them. strength: factor on the emission."""
    color: str
    temperature: str
    warmth: Any
    strength: float = 1.0


def _add_rich(volume, grid, more, data, inputs, pose, fog):
    """add_file's result for a grid of densities and those of colours and temperatures, cell by cell; None: there are none (noted)."""
    color = _like(data, more.color, True, grid, inputs) if more.color else None
    warm = _like(data, more.temperature, False, grid, inputs) if more.warmth is not None else None
    if color is None and warm is None:
        return None
    boxes = [known for known in (grid, warm) if known is not None]
    low = tuple(min(known.low[i] for known in boxes) - 1 for i in range(3))
    high = tuple(max(known.high[i] for known in boxes) + 1 for i in range(3))
    if numpy.prod([high[i] - low[i] for i in range(3)]) > MAX_RICH:
        inputs.notes.add(inputs.owner, openvdb_files.name_of(data), "it has too many voxels; grids of colours and temperatures are left out")
        return None
    density = grid.in_box(low, high)[..., None]
    absorption, scattering, emission = (density * part for part in (volume.absorption, volume.scattering, volume.emission))
    if color is not None:
        hue = volume.scattering * color.in_box(low, high)
        scattering = density * hue
        unit = max(volume.density_of_color, 1e-30)
        absorption = density * numpy.maximum(unit - hue, 0) * volume.tint
    if fog is not None:
        absorption, scattering, emission = absorption + fog.absorption, scattering + fog.scattering, emission + fog.emission
    emission = heat.finer(emission)
    if warm is not None:
        emission = emission + more.strength * heat.emission(more.warmth, heat.finer(warm.in_box(low, high)))
    least = max(1e-3, 0.02 / max(numpy.linalg.norm(pose[:3, :3] @ (numpy.array(high) - low)), 1e-30))
    medium = add_colors(inputs, absorption, scattering, emission, volume.g, least, low=low, high=high, pose=pose)
    return medium, pose, grid._replace(low=low, high=high)


def _like(data, name, colors, grid, inputs):
    """The grid of a name, where its voxels are those of another grid; None: it cannot be read, or they are not (noted)."""
    try:
        found = openvdb_files.read(data, name, colors)
        if not numpy.allclose(found.matrix, grid.matrix, rtol=1e-5, atol=1e-12):
            raise openvdb_files.Unread("its voxels are not those of the density")
    except openvdb_files.Unread as error:
        inputs.notes.add(inputs.owner, openvdb_files.label(data, name), "%s; it is left out" % error)
        return None
    if found.odd > 0:
        inputs.notes.add(inputs.owner, openvdb_files.label(data, name), "%d of its numbers are NaN or infinite; they are 0" % found.odd)
    return found


def _grid_of_file(data, name, inputs):
    """The openvdb_files.Grid of a name with a value above 0; None: there is none (noted)."""
    thing = openvdb_files.label(data, name)
    try:
        grid = openvdb_files.read(data, name)
    except openvdb_files.Unread as error:
        inputs.notes.add(inputs.owner, thing, "%s; the volume is not rendered" % error)
        return None
    if grid.odd > 0:
        inputs.notes.add(inputs.owner, thing, "%d of its voxels are NaN or infinite; they are 0" % grid.odd)
    if not grid.values.max() > 0:
        inputs.notes.add(inputs.owner, thing, "it has no value above 0; the volume is not rendered")
        return None
    return grid


def _shader_of_file(data, material, inputs):
    """(Volume, the name of the grid of its density, Rich or None) of a volume object's material; None: it has no volume."""
    if material is None or not material.use_nodes or material.node_tree is None:
        half = numpy.full(3, 0.5)
        return Volume(half, half, numpy.zeros(3), 0.0, 1.0), "density", None
    output = links.output_node(material.node_tree, "OUTPUT_MATERIAL")
    source = None if output is None else links.follow(output.inputs["Volume"])[0]
    if source is None:
        return None
    node = source.node
    if node.type != "PRINCIPLED_VOLUME" or any(socket.is_linked for socket in node.inputs):
        raise evaluate.Unsupported(node, "OpenVDB files have a Principled Volume without links alone")
    color, temperature = (node.inputs[name + " Attribute"].default_value for name in ("Color", "Temperature"))
    warmth = heat.of_node(node, source.groups, inputs) if openvdb_files.has(data, temperature) else None
    volume = _single(node, source.groups, inputs, warmth is None)
    if volume.emission.max() > 0:
        inputs.notes.add(inputs.owner, node.name, "its emission grows with its density")
    color = color if openvdb_files.has(data, color) else ""
    return volume, node.inputs["Density Attribute"].default_value, Rich(color, temperature, warmth) if color or warmth is not None else None


def is_alone(material):
    """Whether a material is a volume without a surface."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return False
    output = links.output_node(material.node_tree, "OUTPUT_MATERIAL")
    return output is not None and output.inputs["Volume"].is_linked and links.follow(output.inputs["Surface"])[0] is None


def _volume(socket, groups, inputs, depth):
    source, _ = links.follow(socket, groups)
    if source is None:
        return None
    if depth > links.MAX_SHADERS:
        raise links.Cyclic(links.TOO_DEEP)
    node = source.node
    if node.type == "ADD_SHADER":
        return _sum(*(_volume(node.inputs[i], source.groups, inputs, depth + 1) for i in (0, 1)), node)
    if node.type == "MIX_SHADER":
        factor = inputs.constant(node.inputs[0], source.groups)
        if not isinstance(factor, float):
            raise evaluate.Unsupported(node, "volumes are mixed by what varies")
        first, second = (_volume(node.inputs[i], source.groups, inputs, depth + 1) for i in (1, 2))
        return _sum(_scaled(first, 1 - factor), _scaled(second, factor), node)
    if node.type not in ("PRINCIPLED_VOLUME", "VOLUME_SCATTER", "VOLUME_ABSORPTION", "EMISSION"):
        raise evaluate.Unsupported(node, "velo has no such volume (%s)" % node.bl_label)
    return _single(node, source.groups, inputs)


def _single(node, groups, inputs, is_warm=True):
    """The Volume of one node. is_warm: it emits by the temperature of the node, as where no grid has temperatures."""
    def color(name):
        value = inputs.constant(node.inputs[name], groups)
        if value is None:
            raise evaluate.Unsupported(node, "its %s varies" % name.lower())
        return numpy.maximum(numpy.array(value if isinstance(value, tuple) else (value,) * 3), 0)

    def number(name):
        value = inputs.constant(node.inputs[name], groups)
        if not isinstance(value, float):
            raise evaluate.Unsupported(node, "its %s varies" % name.lower())
        return value

    none = numpy.zeros(3)
    if node.type == "EMISSION":
        return Volume(none, none, color("Color") * max(number("Strength"), 0.0), 0.0, 1.0)
    density = inputs.constant(node.inputs["Density"], groups)
    density = max(density, 0.0) if isinstance(density, float) else None
    rest = (density, node.inputs["Density"], groups)
    hue = color("Color")
    if node.type == "VOLUME_ABSORPTION":
        return Volume(numpy.maximum(1 - hue, 0), none, none, 0.0, *rest)
    if node.type == "VOLUME_SCATTER":
        return Volume(none, hue, none, number("Anisotropy"), *rest)
    tint = numpy.maximum(1 - numpy.sqrt(color("Absorption Color")), 0)
    emission = color("Emission Color") * max(number("Emission Strength"), 0.0)
    warmth = heat.of_node(node, groups, inputs) if is_warm else None
    if warmth is not None:
        emission = emission + heat.emission(warmth, 1.0)
    if emission.max() > 0 and density == 0.0:
        return Volume(none, none, emission, 0.0, 1.0)
    if emission.max() > 0 and density != 1.0:
        inputs.notes.add(inputs.owner, node.name, "its emission grows with its density") if density is None else None
        emission = emission / density if density else emission
    return Volume(numpy.maximum(1 - hue, 0) * tint, hue, emission, number("Anisotropy"), *rest, tint)


def _scaled(volume, factor):
    if volume is None:
        return None
    return volume._replace(absorption=volume.absorption * factor, scattering=volume.scattering * factor, emission=volume.emission * factor,
                           density_of_color=volume.density_of_color * factor)


def _sum(first, second, node):
    if first is None or second is None:
        return first or second
    if first.density is None or second.density is None:
        raise evaluate.Unsupported(node, "a sum of volumes of which one varies")
    parts = [(volume.absorption * volume.density, volume.scattering * volume.density, volume.emission * volume.density) for volume in
             (first, second)]
    shares = [part[1].mean() for part in parts]
    g = (first.g * shares[0] + second.g * shares[1]) / max(sum(shares), 1e-30)
    return Volume(parts[0][0] + parts[1][0], parts[0][1] + parts[1][1], parts[0][2] + parts[1][2], g, 1.0)


def _words(volume, inputs, factor, least=1e-3):
    """Keywords of velo's medium, for a factor on the coefficients; None: there is nothing. least: absorption of what glows."""
    absorption, scattering, emission = (part * factor for part in (volume.absorption, volume.scattering, volume.emission))
    words = {"g": min(max(volume.g, -0.99), 0.99), "name": inputs.owner}
    if emission.max() > 0:  # velo's media emit by what they absorb
        absorption = numpy.where(emission > 0, numpy.maximum(absorption, least), absorption)
        color = numpy.where(emission > 0, emission / numpy.maximum(absorption, 1e-30), 0)
        high = min(float(color.max()), 1e30)
        words.update(emission=tuple(min(float(x) / high, 1.0) for x in color), emission_scale=high)
    words.update(sigma_a=tuple(float(x) for x in absorption), sigma_s=tuple(float(x) for x in scattering))
    return words if max(absorption.max(), scattering.max()) > 0 else None


def _add(volume, inputs, box, matrix, fog):
    if volume.density is not None:
        return add_homogeneous(volume if fog is None else _sum(volume, fog, None), inputs)
    words = _words(volume, inputs, 1.0)
    if words is None:
        return None
    low, high, density = _grid(volume, inputs, box, matrix)
    if density.max() <= 0:
        return None
    if fog is not None:
        return _add_in_fog(volume, fog, inputs, density, low=low, high=high, pose=matrix)
    return inputs.scene.add_medium("grid", density=density, low=low, high=high, pose=matrix, **words)


def _add_in_fog(volume, fog, inputs, density, **place):
    """velo's medium of a Volume times the densities of a grid, z x y x x, and the world's Volume. place: keywords of the grid's box."""
    absorption, scattering, emission = (density[..., None] * of_one + of_all for of_one, of_all in
                                        zip((volume.absorption, volume.scattering, volume.emission), (fog.absorption, fog.scattering, fog.emission)))
    shares = volume.scattering.mean() * density.mean(), fog.scattering.mean()
    g = (volume.g * shares[0] + fog.g * shares[1]) / max(sum(shares), 1e-30)
    if abs(volume.g - fog.g) > 1e-6 and min(shares) > 0:
        inputs.notes.add(inputs.owner, "Anisotropy", "in the world's volume it is the mean of both, %.2f" % g)
    return add_colors(inputs, absorption, scattering, heat.finer(emission), g, 1e-3, **place)


def add_colors(inputs, absorption, scattering, emission, g, least, **place):
    """velo's medium of coefficients per unit of length on a grid, z x y x x x 3. emission: on cells of half the size; least: absorption of
    what emits; place: keywords of the grid's box."""
    words = {"rgb_s": scattering.astype(numpy.float32), "g": min(max(g, -0.99), 0.99), "name": inputs.owner, **place}
    if emission.max() > 0:  # velo's media emit by what they absorb
        absorption, factors = heat.by_absorption(absorption, emission, least)
        words.update(rgb_emission=factors.astype(numpy.float32), emission_scale=1 / LUMINANCE_OF_ONE)
    return inputs.scene.add_medium("rgb_grid", rgb_a=absorption.astype(numpy.float32), **words)


def _grid(volume, inputs, box, matrix):
    """(low, high, densities z x y x x) of a box with a cell more on each side, where velo's grids fall to 0."""
    low, high = (numpy.array(corner, dtype=float) for corner in box)
    size = numpy.maximum(high - low, 1e-6)
    cell = size / CELLS
    axes = [low[i] + (numpy.arange(-1, CELLS + 1) + 0.5) * cell[i] for i in range(3)]
    z, y, x = numpy.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    points = numpy.stack((x.ravel(), y.ravel(), z.ravel()), axis=1)
    fields = dict(inputs.known)
    fields.update({"object": points, "generated": (points - low) / size, "world position": points @ matrix[:3, :3].T + matrix[:3, 3]})
    values = evaluate.as_value(evaluate.Evaluator(fields, inputs.look_up).input(volume.socket, volume.groups))
    density = numpy.broadcast_to(numpy.maximum(values, 0), (len(points),)).reshape(z.shape)
    return tuple(low - cell), tuple(high + cell), numpy.ascontiguousarray(density, dtype=numpy.float32)
