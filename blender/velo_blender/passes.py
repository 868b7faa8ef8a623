"""passes.py: velo's images as Blender's passes. Blender's rows run from the bottom."""
from typing import Any, NamedTuple

import numpy

from . import cryptomatte, indices, settings

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
STRIP = 32768  # pixels that are laid into Blender's result at once
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


def wanted(view_layer):
    """velo's channels for the passes that are switched on for a view layer."""
    names = []
    for name, _, _ in wanted_of(view_layer):
        of_pass = cryptomatte.CHANNELS[name[:-2]] if cryptomatte.is_matte(name) else CHANNELS[name]
        names += [channel for channel in of_pass if channel not in names]
    return names


class Rows:
    """Some rows of velo's image, from the top: an image of height rows whose channels are arrays by their names. top: its first row."""

    def __init__(self, image, top, bottom):
        self._image, self.top, self._rows = image, top, slice(top, bottom)

    def __contains__(self, name):
        return name in self._image

    def __getitem__(self, name):
        return numpy.asarray(self._image[name])[self._rows]

    def pixels(self):
        """height x width x 4: R, G, B, A."""
        return numpy.asarray(self._image)[self._rows, :, :4]


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
        self.indices = indices.Indices(export)


class Film:
    """What Combined needs besides velo's image. scene: Blender's; made: export.Export; crop: the window that is rendered, or None."""

    def __init__(self, scene, made, crop):
        self._transparent, self._exposure = scene.render.film_transparent, settings.exposure(scene)
        self._made, self._crop = made, crop

    def combined(self, rows):
        """height x width x 4 of Rows: alpha is 1 everywhere where the film is not transparent."""
        array = numpy.array(rows.pixels())
        if self._made.backdrop is not None:
            left, top = self._crop[:2] if self._crop is not None else (0, 0)
            array = self._made.backdrop.behind(array, self._made.camera, (left, top + rows.top))
        if self._exposure != 1:
            array[..., :3] *= self._exposure
        if not self._transparent:
            array[..., 3] = 1
        return array


def fill(layer, rows, film, made=None):
    """Fills the passes of a layer that is as high as some Rows. film: Film; made: Made; None: Combined alone, the others stay empty."""
    for item in layer.passes:
        if made is not None:
            made.ask()
        if item.name == "Combined":
            write(item, film.combined(rows))
        elif made is not None:
            array = _array(item.name, rows, made)
            if array is not None and array.shape[2] == item.channels:
                write(item, array)


class Target(NamedTuple):
    """Where an image goes in Blender's result: the engine, the names of the layer and the view, the size of the image, pixels."""
    engine: Any
    layer: str
    view: str
    size: tuple

    def put(self, image, film, made=None, ask=None):
        """Lays velo's image into the result in strips, from the top, so that no step takes long: Blender copies all passes of what it
        gets. ask: called between strips, or None. film, made: as of fill."""
        width, height = self.size
        rows = max(1, STRIP // width)
        for top in range(0, height, rows):
            if ask is not None and top > 0:
                ask()
            bottom = min(top + rows, height)
            result = self.engine.begin_result(0, height - bottom, width, bottom - top, layer=self.layer, view=self.view)
            try:
                fill(result.layers[0], Rows(image, top, bottom), film, made)
                self.engine.update_result(result)  # copies it
            finally:
                self.engine.end_result(result, cancel=True, do_merge_results=False)

    def keep(self, image, film):
        """The colours of the whole image at once, without its other passes and without a redraw. After a strip was put."""
        layer = self.engine.get_result().layers[self.layer]
        write(layer.passes.find_by_name("Combined", self.view), film.combined(Rows(image, 0, self.size[1])))


def _array(name, rows, made):
    """height x width x channels of a pass; None: it is not known."""
    if cryptomatte.is_matte(name):
        return made.mattes.layer(name, rows)
    if name.startswith("Denoising"):
        return _denoising(name, rows, made) if "feature.albedo" in rows else None
    channels = CHANNELS.get(name)
    if not channels or any(channel not in rows for channel in channels):
        return None
    if name == "Depth":
        depth = rows["Z"]
        return numpy.where(numpy.isfinite(depth), depth, NOTHING)[..., None]
    if name == "UV":
        uv = rows["uv"]
        return numpy.concatenate([uv, numpy.ones(uv.shape[:2] + (1,), dtype=numpy.float32)], axis=2)
    if name == "Vector":
        return made.vectors.layer(made.export, rows, made.ask) if made.vectors is not None else None
    if name in ("IndexOB", "IndexMA"):
        return made.indices.layer(name, rows)[..., None]
    return rows[channels[0]]


def _denoising(name, rows, made):
    """The means over the image's samples, in the spaces of Cycles: normals in camera space with z forward and y upwards, distances
    from the near plane, 0 where there is nothing."""
    if name == "Denoising Albedo":
        return rows["feature.albedo"]
    camera = made.export.camera
    if name == "Denoising Normal":
        turn = numpy.asarray(camera.world_from_camera, dtype=float)[:3, :3] * (1, -1, 1)
        return rows["feature.N"] @ turn
    depth, distance = rows["Z"], rows["distance"]
    seen = numpy.isfinite(depth) & (depth > 0)
    slant = numpy.where(seen, distance, 1) / numpy.where(seen, depth, 1)
    # Samples that hit nothing count as 0 in the mean of 1 / distance, and in Cycles' mean of distances.
    disparity, covered = rows["feature.disparity"], numpy.clip(rows.pixels()[..., 3], 0, 1)
    hit = (disparity > 0) & (covered > 0)
    mean = numpy.where(hit, covered / numpy.where(hit, disparity, 1), 0)
    return (covered * numpy.maximum(mean - camera.get("near_plane") * slant, 0))[..., None]
