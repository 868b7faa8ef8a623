"""facing.py: Fresnel and layer weights. velo's textures do not know the angle of view, so these nodes are

* the Fresnel equations of velo's own material, where they mix one lobe with a reflection: paint, glass, panes;
* elsewhere their mean over all directions, by the cosine, with a note."""
import numpy

from . import links

STEPS = 64  # of the mean over directions
MAX_CLEAR_ROUGHNESS = 0.05  # of a reflection that leaves what is behind a transparent shader sharp


def index_of_factor(socket, groups, inputs):
    """The index of refraction whose reflectance is a mix's factor; None: it is something else."""
    source, _ = links.follow(socket, groups)
    if source is None or source.node.type not in ("FRESNEL", "LAYER_WEIGHT"):
        return None
    node = source.node
    if node.type == "FRESNEL":
        return _at_least(inputs.constant(node.inputs["IOR"], source.groups))
    if source.socket.name != "Fresnel":
        return None
    blend = inputs.constant(node.inputs["Blend"], source.groups)
    return _at_least(1 / max(1 - blend, 1e-5)) if isinstance(blend, float) else None


def _at_least(index):
    return min(max(index, 1.0001), 5.0) if isinstance(index, float) else None


def coated(under, over, eta, inputs):
    """The material of a lobe below a reflection that follows the Fresnel equations; None: velo has none for the two."""
    if under is None or over is None or over.kind != "glossy":
        return None
    if under.kind == "clear":
        if not isinstance(over.roughness, float) or over.roughness > MAX_CLEAR_ROUGHNESS:
            inputs.notes.add(inputs.owner, "Fresnel", "a transparent shader below a rough reflection is as rough")
        inputs.notes.add(inputs.owner, "Fresnel", "the inner sides of surfaces reflect as much as the outer ones")
    words = dict(over.words)
    if under.words.keys() != over.words.keys():
        inputs.notes.add(inputs.owner, "Normal", "both parts of the mix have the normal of the reflection")
    common = {"metallic": 0.0, "eta": eta, "roughness": over.roughness, "specular_color": over.color, "name": inputs.owner, **words}
    if under.kind == "diffuse":
        return inputs.scene.add_material("principled", reflectance=under.color, **common)
    if under.kind == "refraction":
        return inputs.scene.add_material("principled", reflectance=under.color, transmission=1.0, thin_walled=inputs.is_open, **common)
    if under.kind == "clear":
        return inputs.scene.add_material("principled", reflectance=under.color, transmission=1.0, thin_walled=True, **common)
    return None


def reflectance(cosine, eta):
    """The Fresnel equations of a dielectric, for cosines of the angle outside (Cycles' fresnel_dielectric_cos)."""
    g = eta * eta - 1 + cosine * cosine
    root = numpy.sqrt(numpy.maximum(g, 0))
    a = (root - cosine) / numpy.maximum(root + cosine, 1e-30)
    b = ((root + cosine) * cosine - 1) / ((root - cosine) * cosine + 1)
    return numpy.where(g > 0, 0.5 * a * a * (1 + b * b), 1.0)


def _mean(function):
    """The mean of a function of the cosine over a hemisphere, by the cosine."""
    cosines = numpy.sqrt((numpy.arange(STEPS) + 0.5) / STEPS)
    return numpy.array([float(function(cosines).mean())])


def _number(e, node, name, groups):
    return float(e.named(node, name, groups).mean())


def fresnel(e, node, output, groups):
    e.note(node, "it is its mean over the directions of view")
    eta = max(_number(e, node, "IOR", groups), 1.0001)
    return _mean(lambda cosine: reflectance(cosine, eta))


def layer_weight(e, node, output, groups):
    e.note(node, "it is its mean over the directions of view")
    blend = min(max(_number(e, node, "Blend", groups), 0.0), 1 - 1e-5)
    if output.name == "Fresnel":
        return _mean(lambda cosine: reflectance(cosine, 1 / max(1 - blend, 1e-5)))
    power = 2 * blend if blend < 0.5 else 0.5 / (1 - blend)
    return _mean(lambda cosine: 1 - cosine**power if blend != 0.5 else 1 - cosine)


def light_path(e, node, output, groups):
    """Cycles asks what a ray is; here all rays are the same, but for the camera's in a world (backdrop.py)."""
    if "is world" in e.fields and output.name == "Is Camera Ray":
        return numpy.array([1.0 if "is camera" in e.fields else 0.0])
    is_view = "is world" not in e.fields  # of a surface: the camera's; of a world: the light's
    known = {"Is Camera Ray": 1.0 if is_view else 0.0, "Ray Length": 1.0}
    e.note(node, "all rays see what %s" % ("the camera sees" if is_view else "lights"))
    return numpy.array([known.get(output.name, 0.0)])


NODES = {"FRESNEL": fresnel, "LAYER_WEIGHT": layer_weight, "LIGHT_PATH": light_path}
