"""materials.py: Blender's materials as velo's: the tree of closures becomes a material, a coverage and an emission."""
import math

from . import closures, displace, facing, glow, links, volumes
from .closures import Closure
from .evaluate import Unsupported


class Surface:
    """What a shape needs: material (handle), alpha (number, texture or None), emission (handle or None), color_attribute (name of
    its vertex colours, or None), atlas (atlas.Atlas of what is baked by triangles, or None), tangent (the axis about which tangents
    run, or None)."""

    def __init__(self, material, alpha, emission, inputs):
        self.material, self.alpha, self.emission = material, alpha, emission
        self.color_attribute, self.atlas, self.tangent = inputs.color_attribute, inputs.atlas, inputs.tangent


def convert(material, inputs):
    """The surface of a Blender material (None: Cycles' default, a diffuse 0.8). inputs: textures.Inputs."""
    if material is None:
        return _finish(Closure(material=closures.diffuse(inputs, (0.8, 0.8, 0.8), {})), inputs)
    if not material.use_nodes or material.node_tree is None:
        return _finish(_without_nodes(material, inputs), inputs)
    output = links.output_node(material.node_tree, "OUTPUT_MATERIAL")
    if not all(link.is_valid for link in material.node_tree.links):
        inputs.notes.add(inputs.owner, "", "a link closes a circle of nodes, or does not fit; it is ignored, as in Cycles")
    if output is None:
        inputs.notes.add(inputs.owner, "", "it has no output node and is black")
        return _finish(Closure(), inputs)
    try:
        inputs.relief = displace.relief(material, inputs) if displace.is_bumped(material) else None
        closure = _closure(output.inputs["Surface"], (), inputs, 0)
    except links.Cyclic as error:
        inputs.notes.add(inputs.owner, "", "%s; it is black" % error)
        closure = Closure()
    if volumes.is_alone(material):
        return Surface(inputs.scene.add_material("interface", name=inputs.owner), None, None, inputs)
    return _finish(closure, inputs)


def _without_nodes(material, inputs):
    color = tuple(material.diffuse_color)[:3]
    return Closure(material=closures.diffuse(inputs, color, {}))


def _finish(closure, inputs):
    handle = closure.material
    if handle is None:
        handle = inputs.scene.add_material("diffuse", reflectance=(0, 0, 0), name=inputs.owner)
    emission = glow.emission(closure.emission, inputs)
    return Surface(handle, closure.coverage, emission, inputs)


def _closure(socket, groups, inputs, depth):
    """The closure that feeds a shader socket; nothing: black."""
    if depth > links.MAX_SHADERS:
        raise links.Cyclic(links.TOO_DEEP)
    source, _ = links.follow(socket, groups)
    if source is None:
        return Closure()
    node = source.node
    if node.type == "MIX_SHADER":
        eta = facing.index_of_factor(node.inputs[0], source.groups, inputs)
        if eta is not None:
            lobes = [_closure(node.inputs[i], source.groups, inputs, depth + 1) for i in (1, 2)]
            made = facing.coated(lobes[0].lobe, lobes[1].lobe, eta, inputs)
            if made is not None:
                return Closure(material=made)
        factor = inputs.share(node.inputs[0], source.groups)
        if factor == 0.0 or factor == 1.0:
            return _closure(node.inputs[1 + int(factor)], source.groups, inputs, depth + 1)
        first, second = (_closure(node.inputs[i], source.groups, inputs, depth + 1) for i in (1, 2))
        return _mix(factor, first, second, node, source.groups, inputs)
    if node.type == "ADD_SHADER":
        first, second = (_closure(node.inputs[i], source.groups, inputs, depth + 1) for i in (0, 1))
        return _add(first, second, node, inputs)
    function = closures.CLOSURES.get(node.type)
    if function is None:
        has_color = node.inputs.get("Color") is not None
        inputs.notes.add(inputs.owner, node.name, "velo has no such shader (%s); it is %s" % (node.bl_label, "diffuse" if has_color else "black"))
        return Closure(closures.diffuse(inputs, inputs.albedo(node.inputs["Color"], source.groups), {})) if has_color else Closure()
    try:
        return function(inputs, node, source.groups)
    except Unsupported as error:
        inputs.notes.add(inputs.owner, error.node.name, "%s; the shader is black" % error.text)
        return Closure()


def _mix(factor, first, second, node, groups, inputs):
    """(1 - factor) first + factor second."""
    if first.is_clear and second.is_clear:
        return first
    if first.is_clear:
        return _thinned(second, factor, node, inputs)
    if second.is_clear:
        return _thinned(first, closures.one_minus(inputs, factor), node, inputs)
    emission = glow.mixed(first.emission, second.emission, factor, node.inputs[0], groups)
    parts = factor, first.coverage if first.coverage is not None else 1.0, second.coverage if second.coverage is not None else 1.0
    if all(isinstance(part, float) for part in parts):
        return _mix_of_numbers(*parts, first, second, emission, inputs)
    material = _mixed_material(factor, first.material, second.material, inputs)
    coverage = first.coverage
    if first.coverage is not None or second.coverage is not None:
        coverage = closures.mixed_coverage(inputs, factor, first.coverage, second.coverage)
        if first.coverage is not second.coverage:
            inputs.notes.add(inputs.owner, node.name, "two transparent shaders are mixed with a mean transparency")
    return Closure(material, emission, coverage)


def _mix_of_numbers(factor, first_part, second_part, first, second, emission, inputs):
    """A mix of two surfaces of which parts are there: the parts are in proportion to what is there of each."""
    shares = (1 - factor) * first_part, factor * second_part
    total = sum(shares)
    material = _mixed_material(shares[1] / total if total > 0 else factor, first.material, second.material, inputs)
    return Closure(material, emission, None if total >= 1 else total)


def _mixed_material(factor, first, second, inputs):
    if first is None and second is None:
        return None
    black = None
    if first is None or second is None:
        black = inputs.scene.add_material("diffuse", reflectance=(0, 0, 0))
    return inputs.scene.add_material("mix", materials=[first or black, second or black], amount=factor, name=inputs.owner)


def _thinned(closure, share, node, inputs):
    coverage = share if closure.coverage is None else closures.product(inputs, share, closure.coverage)
    return Closure(closure.material, closure.emission, coverage)


def _add(first, second, node, inputs):
    if first.is_clear or second.is_clear:
        inputs.notes.add(inputs.owner, node.name, "a sum with a transparent shader is only the other one")
        return second if first.is_clear else first
    emission = first.emission + second.emission
    if first.material is None or second.material is None:
        return Closure(first.material or second.material, emission, first.coverage or second.coverage)
    inputs.notes.add(inputs.owner, node.name, "velo cannot add two reflections; their mean is rendered")
    return Closure(_mixed_material(0.5, first.material, second.material, inputs), emission, first.coverage or second.coverage)


def is_number(value):
    return isinstance(value, (int, float)) and math.isfinite(value)
