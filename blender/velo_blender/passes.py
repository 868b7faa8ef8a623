"""passes.py: velo's images as Blender's passes. Blender's rows run from the bottom."""
import numpy

#: Switch of the view layer -> (pass, channels' letters, type of the compositor's socket).
SWITCHES = {"use_pass_z": ("Depth", "Z", "VALUE"), "use_pass_normal": ("Normal", "XYZ", "VECTOR"),
            "use_pass_position": ("Position", "XYZ", "VECTOR"), "use_pass_uv": ("UV", "UVA", "VECTOR"),
            "use_pass_object_index": ("IndexOB", "X", "VALUE"), "use_pass_material_index": ("IndexMA", "X", "VALUE")}
#: Blender's pass -> velo's channels.
CHANNELS = {"Depth": ["Z"], "Normal": ["N"], "Position": ["P"], "UV": ["uv"], "IndexOB": ["id.instance", "id.object"],
            "IndexMA": ["id.material"], "Vector": []}
NOTHING = 1e10  # Blender's depth where there is no surface


def switches():
    """The names of the switches of a view layer."""
    return list(SWITCHES)


def register(engine, scene, view_layer):
    """Tells Blender which passes a view layer has."""
    engine.register_pass(scene, view_layer, "Combined", 4, "RGBA", "COLOR")
    for switch, (name, letters, kind) in SWITCHES.items():
        if getattr(view_layer, switch):
            engine.register_pass(scene, view_layer, name, len(letters), letters, kind)


def wanted(layer):
    """velo's channels for the passes that a layer of the result has."""
    names = []
    for item in layer.passes:
        names += [name for name in CHANNELS.get(item.name, []) if name not in names]
    return names


def write(item, array):
    """Sets the pixels of a pass: height x width x channels, rows from the top."""
    array = numpy.ascontiguousarray(array[::-1], dtype=numpy.float32)
    item.rect.foreach_set(array.reshape(-1, array.shape[2]))


def fill(layer, image, transparent, export=None):
    """Fills the layer's passes from velo's image. transparent: the background is not there; else alpha is 1 everywhere."""
    for item in layer.passes:
        array = _array(item.name, image, export)
        if item.name == "Combined" and not transparent:
            array = array.copy()
            array[..., 3] = 1
        if array is not None and array.shape[2] == item.channels:
            write(item, array)


def _array(name, image, export):
    """height x width x channels of a pass; None: velo's image has it not."""
    if name == "Combined":
        return numpy.asarray(image)
    channels = CHANNELS.get(name)
    if not channels or any(channel not in image for channel in channels):
        return None
    if name == "Depth":
        depth = numpy.asarray(image["Z"])
        return numpy.where(numpy.isfinite(depth), depth, NOTHING)[..., None]
    if name == "UV":
        uv = numpy.asarray(image["uv"])
        return numpy.concatenate([uv, numpy.ones(uv.shape[:2] + (1,), dtype=numpy.float32)], axis=2)
    if name in ("IndexOB", "IndexMA"):
        return None if export is None else export.indices(name, image)[..., None]
    return numpy.asarray(image[channels[0]])
