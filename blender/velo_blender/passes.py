"""passes.py: velo's images as Blender's passes. Blender's rows run from the bottom."""
import numpy

from . import cryptomatte, settings

#: Switch of the view layer -> (pass, channels' letters, type of the compositor's socket).
SWITCHES = {"use_pass_z": ("Depth", "Z", "VALUE"), "use_pass_normal": ("Normal", "XYZ", "VECTOR"),
            "use_pass_position": ("Position", "XYZ", "VECTOR"), "use_pass_uv": ("UV", "UVA", "VECTOR"),
            "use_pass_vector": ("Vector", "XYZW", "VECTOR"),
            "use_pass_object_index": ("IndexOB", "X", "VALUE"), "use_pass_material_index": ("IndexMA", "X", "VALUE")}
#: Passes of the switch "denoising data", under the names that Cycles gives them.
DENOISING = (("Denoising Normal", "XYZ", "VECTOR"), ("Denoising Albedo", "RGB", "COLOR"), ("Denoising Depth", "Z", "VALUE"))
#: Blender's pass -> velo's channels.
CHANNELS = {"Depth": ["Z"], "Normal": ["N"], "Position": ["P"], "UV": ["uv"], "IndexOB": ["id.instance", "id.object"],
            "IndexMA": ["id.material"], "Vector": ["P", "Z", "id.instance", "id.object", "id.primitive"],
            "Denoising Normal": ["features"], "Denoising Albedo": ["features"], "Denoising Depth": ["features", "Z", "distance"]}
NOTHING = 1e10  # Blender's depth where there is no surface


def wanted_of(view_layer):
    """(name, letters, type) of all passes that are switched on for a view layer, without Combined."""
    found = [words for switch, words in SWITCHES.items() if getattr(view_layer, switch)]
    if view_layer.velo.denoising_data:
        found += DENOISING
    return found + [(name, "rgba", "COLOR") for name in cryptomatte.pass_names(view_layer)]


def register(engine, scene, view_layer):
    """Tells Blender which passes a view layer has."""
    engine.register_pass(scene, view_layer, "Combined", 4, "RGBA", "COLOR")
    for name, letters, kind in wanted_of(view_layer):
        engine.register_pass(scene, view_layer, name, len(letters), letters, kind)


def add(engine, view_layer):
    """Adds the passes that Blender itself does not add, before a result is begun."""
    own = {words[0] for words in SWITCHES.values()}
    for name, letters, _ in wanted_of(view_layer):
        if name not in own:
            engine.add_pass(name, len(letters), letters, layer=view_layer.name)


def wanted(layer):
    """velo's channels for the passes that a layer of the result has."""
    names = []
    for item in layer.passes:
        of_pass = cryptomatte.CHANNELS[item.name[:-2]] if cryptomatte.is_matte(item.name) else CHANNELS.get(item.name, [])
        names += [name for name in of_pass if name not in names]
    return names


def write(item, array):
    """Sets the pixels of a pass: height x width x channels, rows from the top."""
    array = numpy.ascontiguousarray(array[::-1], dtype=numpy.float32)
    item.rect.foreach_set(array.reshape(-1, array.shape[2]))


class Made:
    """What passes need besides the image. export: export.Export; vectors: vectors.Vectors or None. ask: called between steps of some
    milliseconds; its exception ends what calls it."""

    def __init__(self, export, image, vectors, ask):
        self.export, self.vectors, self.ask = export, vectors, ask
        self.mattes = cryptomatte.Mattes(export, image, ask)


class Film:
    """What Combined needs besides velo's image. scene: Blender's; made: export.Export; crop: the window that is rendered, or None."""

    def __init__(self, scene, made, crop):
        self._transparent, self._exposure = scene.render.film_transparent, settings.exposure(scene)
        self._made, self._crop = made, crop
        self._rows = None  # of the last image, in Blender's order: new memory of this size costs more than what is computed

    def combined(self, image):
        """height x width x 4, valid until the next call: alpha is 1 everywhere where the film is not transparent."""
        pixels = numpy.asarray(image)[..., :4]
        if self._rows is None or self._rows.shape != pixels.shape:
            self._rows = numpy.empty(pixels.shape, dtype=numpy.float32)
        array = self._rows[::-1]
        array[:] = pixels
        if self._made.backdrop is not None:
            array[:] = self._made.backdrop.behind(array, self._made.camera, self._crop)
        if self._exposure != 1:
            array[..., :3] *= self._exposure
        if not self._transparent:
            array[..., 3] = 1
        return array


def fill(layer, image, film, made=None):
    """Fills the layer's passes from velo's image. film: Film; made: what is known of the scene; None: passes that need it stay empty."""
    for item in layer.passes:
        if made is not None:
            made.ask()
        array = film.combined(image) if item.name == "Combined" else _array(item.name, image, made)
        if array is not None and array.shape[2] == item.channels:
            write(item, array)


def _array(name, image, made):
    """height x width x channels of a pass; None: it is not known."""
    if cryptomatte.is_matte(name):
        return made.mattes.layer(name) if made is not None else None
    if name.startswith("Denoising"):
        return _denoising(name, image, made) if made is not None and "feature.albedo" in image else None
    channels = CHANNELS.get(name)
    if not channels or any(channel not in image for channel in channels):
        return None
    if name == "Depth":
        depth = numpy.asarray(image["Z"])
        return numpy.where(numpy.isfinite(depth), depth, NOTHING)[..., None]
    if name == "UV":
        uv = numpy.asarray(image["uv"])
        return numpy.concatenate([uv, numpy.ones(uv.shape[:2] + (1,), dtype=numpy.float32)], axis=2)
    if name == "Vector":
        return made.vectors.layer(made.export, image, made.ask) if made is not None and made.vectors is not None else None
    if name in ("IndexOB", "IndexMA"):
        return None if made is None else made.export.indices(name, image)[..., None]
    return numpy.asarray(image[channels[0]])


def _denoising(name, image, made):
    """The means over the image's samples, in the spaces of Cycles: normals in camera space with z forward and y upwards, distances
    from the near plane, 0 where there is nothing."""
    if name == "Denoising Albedo":
        return numpy.asarray(image["feature.albedo"])
    camera = made.export.camera
    if name == "Denoising Normal":
        turn = numpy.asarray(camera.world_from_camera, dtype=float)[:3, :3] * (1, -1, 1)
        return numpy.asarray(image["feature.N"]) @ turn
    depth, distance = numpy.asarray(image["Z"]), numpy.asarray(image["distance"])
    seen = numpy.isfinite(depth) & (depth > 0)
    slant = numpy.where(seen, distance, 1) / numpy.where(seen, depth, 1)
    # Samples that hit nothing count as 0 in the mean of 1 / distance, and in Cycles' mean of distances.
    disparity, covered = numpy.asarray(image["feature.disparity"]), numpy.clip(numpy.asarray(image)[..., 3], 0, 1)
    hit = (disparity > 0) & (covered > 0)
    mean = numpy.where(hit, covered / numpy.where(hit, disparity, 1), 0)
    return (covered * numpy.maximum(mean - camera.get("near_plane") * slant, 0))[..., None]
