"""textures.py: what feeds a material's sockets, as velo's inputs: numbers, colours, image textures, vertex colours; what velo has no
texture for is baked to an image over the uv map that it depends on."""
import numpy
import velo

from . import atlas, evaluate, geometry, images, links, node_values, report, tiles

BAKED_AT_ONCE = 16384  # points, some milliseconds for each node
LOWEST_INDEX, HIGHEST_INDEX = 1.0001, 5.0  # of refraction
WRAPS = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black", "MIRROR": "mirror"}


def affine_of_mapping(node, evaluator, groups):
    """(s, t) from (u, v) by a mapping node, 2 x 3; None: it is none in the plane."""
    corners = numpy.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])

    class Ready:
        """An evaluator whose vector is given."""

        def named(self, inner, name, inner_groups):
            return corners if name == "Vector" else evaluator.named(inner, name, inner_groups)

    try:
        origin, along, up = node_values.mapping(Ready(), node, None, groups)
    except evaluate.Unsupported:
        return None
    return numpy.stack((along - origin, up - origin, origin), axis=1)[:2]


class Inputs:
    """velo's inputs for one material on meshes with the same uv maps.

    scene: velo.Scene. owner: the material's name. uv_names: the mesh's maps, set 0 is render_uv. bounds: {name: (low, high)} of the
    mesh's uvs. cache: {key: handle}, shared by all materials. bake_size: pixels of baked images. known: fields for evaluate.Evaluator
    that are the same on the whole object (object_info.fields)."""

    def __init__(self, scene, notes, owner, maps, cache, bake_size, corners=None, known=None, cancelled=None, is_open=False):
        self.is_open = is_open  # whether the surface is open: glass is a thin pane there
        self.known = known or {}
        self._cancelled = cancelled or (lambda: False)  # whether the user has ended the export
        self.tangent = None  # the axis about which tangents run, where the material has a direction; None: along u
        self.relief = None  # a float texture, the height of the material's displacement where it is rendered as a bump
        self.corners = corners  # atlas.Corners of the mesh; None: nothing can be baked by its triangles
        self.atlas = None  # the layout of what is baked by triangles; None: nothing is
        self.highest = cache.setdefault("highest", {})  # {id of a handle of a colour texture: (its largest value, the handle)}
        self.scene, self.notes, self.owner, self.maps, self.cache, self.bake_size = scene, notes, owner, maps, cache, bake_size
        self.color_attribute = None  # the name of the vertex colours that are used; None: none

    # ---- numbers and colours

    def constant(self, socket, groups=()):
        return evaluate.constant(socket, groups, self.known, self._note)

    def _note(self, node, text):
        self.notes.add(self.owner, node.name, text)

    def color(self, socket, groups=()):
        """A colour: three numbers or a colour texture."""
        value = self.constant(socket, groups)
        if value is None:
            return self._texture(socket, groups, True)
        value = (value,) * 3 if isinstance(value, float) else value
        return tuple(max(0.0, x) for x in value)

    def albedo(self, socket, groups=()):
        """As color, for what reflects, scatters or lets light pass, which velo limits to 1."""
        value = self.color(socket, groups)
        highest = max(value) if isinstance(value, tuple) else self.highest.get(id(value), (0.0, None))[0]
        most = 1 + 1e-6 if isinstance(value, tuple) else 1 + 1e-3  # of images, whose numbers are rounded
        if highest > most:
            self.notes.add(self.owner, socket.node.name, "%s has values above 1, up to %.3g; they are 1" % (socket.name, highest))
        return tuple(min(x, 1.0) for x in value) if isinstance(value, tuple) else value

    def share(self, socket, groups=()):
        """As number, from 0 to 1, as Cycles limits it."""
        value = self.number(socket, groups)
        return min(max(value, 0.0), 1.0) if isinstance(value, float) else value

    def index(self, socket, groups=()):
        """An index of refraction, a number that velo can have."""
        value = self.constant(socket, groups)
        if not isinstance(value, float):
            self.notes.add(self.owner, socket.node.name, "an index of refraction that varies is 1.45")
            return 1.45
        limited = min(max(value, LOWEST_INDEX), HIGHEST_INDEX)
        if abs(limited - value) > 1e-3:
            self.notes.add(self.owner, socket.node.name, "an index of refraction of %.4g is %.4g" % (value, limited))
        return limited

    def number(self, socket, groups=()):
        """A number or a float texture."""
        value = self.constant(socket, groups)
        if value is None:
            return self._texture(socket, groups, False)
        return value if isinstance(value, float) else float(sum(value) / 3)

    def _texture(self, socket, groups, spectrum):
        source, _ = links.follow(socket, groups)
        try:
            handle = self._direct(source, spectrum)
            if handle is not None:
                return handle
            return self.baked(lambda e: e.input(socket, groups), source.node, spectrum)
        except evaluate.Unsupported as error:
            self.notes.add(self.owner, error.node.name, "%s; %s has its own value" % (error.text, socket.name))
        default = evaluate.default_of(socket)
        return tuple(float(x) for x in evaluate.as_vector(default)[0]) if spectrum else float(evaluate.as_value(default)[0])

    # ---- textures that velo has

    def _direct(self, source, spectrum):
        """velo's own texture for a node, None: there is none."""
        node = source.node
        if node.type in ("VERTEX_COLOR", "ATTRIBUTE"):
            return self._vertex_color(source, spectrum)
        if node.type != "TEX_IMAGE" or node.projection != "FLAT":
            return None
        place = self._place(node, source.groups)
        if place is None:
            return None
        channel = 3 if source.socket.name == "Alpha" else -1
        return self.image(node, place, spectrum, channel)

    def _vertex_color(self, source, spectrum):
        node = source.node
        name = node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name
        if node.type == "ATTRIBUTE" and (node.attribute_type != "GEOMETRY" or name in self.maps.names):
            return None
        if not self.maps.has_color(name):
            return None
        if self.color_attribute not in (None, name):
            return None  # velo's triangles have one; a second one is baked
        self.color_attribute = name
        channel = 3 if source.socket.name == "Alpha" else -1
        words = {} if spectrum else {"channel": channel}
        return self.scene.add_texture("vertex_color", spectrum=spectrum, **words)

    def _place(self, node, groups):
        """(uv set, 2 x 3 from uv) of an image node; None: it is not placed by one uv map and a plane mapping."""
        matrix = numpy.array([[1.0, 0, 0], [0, 1, 0]])
        source, _ = links.follow(node.inputs["Vector"], groups)
        evaluator = evaluate.Evaluator({}, evaluate._no_textures)
        if source is not None and source.node.type == "MAPPING":
            mapping = source
            inner = affine_of_mapping(mapping.node, evaluator, mapping.groups)
            source, socket = links.follow(mapping.node.inputs["Vector"], mapping.groups)
            if inner is None or source is None:
                return None
            matrix = inner
        number = 0 if source is None else self._uv_set(source)
        return None if number is None else (number, matrix)

    def _uv_set(self, source):
        node = source.node
        if node.type == "TEX_COORD" and source.socket.name == "UV":
            return self.maps.number("")
        if node.type == "UVMAP":
            return self.maps.number(node.uv_map)
        if node.type == "ATTRIBUTE" and node.attribute_name in self.maps.names:
            return self.maps.number(node.attribute_name)
        return None

    def normals(self, socket, groups, strength):
        """An image texture of a normal map, whose normals a strength draws towards the surface's own; None: it cannot be evaluated."""
        source, _ = links.follow(socket, groups)
        node = source.node
        try:
            place = self._place(node, source.groups) if node.type == "TEX_IMAGE" and node.projection == "FLAT" else None
            if place is not None:
                return self.image(node, place, True, -1, strength)
            return self.baked(lambda e: weakened(evaluate.as_vector(e.input(socket, groups)), strength), node, True)
        except evaluate.Unsupported as error:
            self.notes.add(self.owner, error.node.name, "%s; the surface's own normal is taken" % error.text)
            return None

    def image(self, node, place, spectrum, channel, strength=1.0):
        """velo's texture of an image node. strength: of normals, for weakened."""
        why = images.problem(node.image)
        if why is not None:
            raise evaluate.Unsupported(node, why)
        if node.interpolation in ("Cubic", "Smart"):
            self.notes.add(self.owner, node.name, "cubic interpolation is linear")
        array = self.texels(node)
        number, matrix = place
        matrix = self._tiled(node, matrix)
        key = ("image", node.image.name_full, spectrum, channel, number, tuple(matrix.ravel()), node.extension, node.interpolation,
               is_multiplied(node), strength)
        if key not in self.cache:
            words = {} if spectrum else {"channel": channel}
            wrap = "black" if node.image.source == "TILED" else WRAPS[node.extension]
            array = array if strength == 1.0 else weakened(array[..., :3], strength)
            if channel == 3:  # alone: beyond a clipped image alpha is 0, too
                array, words = array[..., 3:], {"channel": 0}
            self.cache[key] = self._add(array, spectrum, number, matrix, wrap=wrap,
                                        filter="point" if node.interpolation == "Closest" else "bilinear", **words)
        return self.cache[key]

    def texels(self, node):
        """The pixels of an image node as Cycles sees them, height x width x 4, linear; kept."""
        key = ("pixels", node.image.name_full, is_multiplied(node))
        if key not in self.cache:
            array = images.pixels(node.image, self.notes) if node.image.source != "TILED" else self._joined(node).texels
            if is_multiplied(node):
                array[..., :3] *= array[..., 3:]
            self.cache[key] = array
        return self.cache[key]

    def _joined(self, node):
        """The tiles.Joined of an image node; kept."""
        key = ("tiles", node.image.name_full)
        if key not in self.cache:
            self.cache[key] = tiles.join(node.image, self.notes)
        if self.cache[key] is None:
            raise evaluate.Unsupported(node, "none of the image's tiles can be read")
        return self.cache[key]

    def _tiled(self, node, matrix):
        """(s, t) in the joined tiles from what is (s, t) in a plain image, 2 x 3."""
        if node.image.source != "TILED":
            return matrix
        outer = self._joined(node).matrix()
        return outer[:, :2] @ matrix + numpy.concatenate([numpy.zeros((2, 2)), outer[:, 2:]], axis=1)

    def _add(self, array, spectrum, number, matrix, **words):
        image = velo.Image(numpy.ascontiguousarray(array[..., :3] if spectrum else array), encoding="linear")
        handle = self.scene.add_texture("image", spectrum=spectrum, image=image, uv_set=number,
                                        st_from_uv=[float(x) for x in numpy.ravel(matrix)], **words)
        if spectrum:
            self.highest[id(handle)] = float(array[..., :3].max()), handle
        return handle

    # ---- baking

    def plain_evaluator(self):
        """An evaluator that knows what is the same on the whole object."""
        return evaluate.Evaluator(self.known, evaluate._no_textures, self._note)

    def baked(self, value, node, spectrum):
        """An image texture of a value, a function (evaluate.Evaluator) -> n or n x 3, over the box of the mesh's uvs or, where it depends
        on more, by triangles. node: which is named where it cannot be."""
        try:
            number, (low, high) = self._only_map(value, node)
        except evaluate.Unsupported:
            if self.corners is None:
                raise
            return self._baked_by_triangles(value, node, spectrum)
        size = high - low
        side = self.bake_size
        v, u = numpy.meshgrid(high[1] - (numpy.arange(side) + 0.5) / side * size[1], low[0] + (numpy.arange(side) + 0.5) / side * size[0],
                              indexing="ij")
        values = self._in_parts(side * side, {"uv": numpy.stack((u.ravel(), v.ravel()), axis=1)}, lambda part: self._values(value, part["uv"]))
        array = evaluate.as_vector(values) if spectrum else evaluate.as_value(values)[:, None]
        array = numpy.broadcast_to(array, (side * side, array.shape[1])).reshape(side, side, -1).astype(numpy.float32)
        matrix = numpy.array([[1 / size[0], 0, -low[0] / size[0]], [0, 1 / size[1], -low[1] / size[1]]])
        words = {} if spectrum else {"channel": 0}
        return self._add(numpy.maximum(array, 0) if spectrum else array, spectrum, number, matrix, wrap="clamp", filter="bilinear", **words)

    def _baked_by_triangles(self, value, node, spectrum):
        layout = self.atlas or atlas.Atlas(len(self.corners.triangles), self.bake_size)
        if not layout.fits:
            raise evaluate.Unsupported(node, "the mesh has too many triangles to bake it")
        fields = {name: layout.points(values) for name, values in self.corners.fields().items()}
        count = len(layout.corner) * layout.block**2
        values = self._in_parts(count, fields, lambda part: value(evaluate.Evaluator({**part, **self.known}, self.look_up, self._note)))
        array = evaluate.as_vector(values) if spectrum else evaluate.as_value(values)[:, None]
        image = layout.image(numpy.broadcast_to(array, (count, array.shape[1])).astype(numpy.float32))
        self.atlas = layout
        number = min(len(self.maps.names), 3)
        words = {} if spectrum else {"channel": 0}
        plain = numpy.array([[1.0, 0, 0], [0, 1, 0]])
        handle = self._add(numpy.maximum(image, 0) if spectrum else image, spectrum, number, plain, wrap="clamp", filter="bilinear", **words)
        if spectrum:  # the texels beyond a triangle's edge may be higher than its own
            self.highest[id(handle)] = float(layout.inner(numpy.broadcast_to(array, (count, 3))).max(initial=0.0)), handle
        return handle

    def _in_parts(self, count, fields, value):
        """The values of a function of fields, {name: count x n}, part by part; report.Cancelled where the user ends the export."""
        parts = []
        for start in range(0, count, BAKED_AT_ONCE):
            if self._cancelled():
                raise report.Cancelled()
            stop = min(start + BAKED_AT_ONCE, count)
            part = value({name: array[start:stop] for name, array in fields.items()})
            parts.append(numpy.broadcast_to(part, (stop - start,) + part.shape[1:]))
        return numpy.concatenate(parts)

    def _only_map(self, value, node):
        """The uv map that a value depends on and the box of its uvs: each map is tried, with points in the middle."""
        last = None
        for number, name in enumerate(self.maps.names[:4]):
            try:
                self._values(value, numpy.full((2, 2), 0.5), only=name)
                return number, self.maps.bounds[name]
            except evaluate.Unsupported as error:
                last = error
        if last is None:
            raise evaluate.Unsupported(node, "it varies, and the mesh has no uv map to bake it over")
        raise last

    def _values(self, value, uv, only=None):
        fields = dict(self.known)
        for name in [only] if only is not None else self.maps.names[:4]:
            fields["uv:" + name] = uv
            if name == self.maps.names[0]:
                fields["uv:"] = uv
        return value(evaluate.Evaluator(fields, self.look_up, self._note))

    def look_up(self, node):
        """The texels of an image node, for evaluate.Evaluator."""
        why = images.problem(node.image)
        if why is not None:
            raise evaluate.Unsupported(node, why)
        closest = node.interpolation == "Closest"
        if node.image.source == "TILED":
            return images.Texels(self.texels(node), "CLIP", closest, self._joined(node).matrix())
        return images.Texels(self.texels(node), getattr(node, "extension", "REPEAT"), closest)


def weakened(colors, strength):
    """The colours of a normal map, ... x 3, whose normals n are (0, 0, 1) + strength (n - (0, 0, 1)), as in Cycles."""
    if strength == 1.0:
        return colors
    normals = 2 * colors - 1
    normals = normals / numpy.maximum(numpy.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
    normals = numpy.array([0.0, 0.0, 1.0]) * (1 - strength) + normals * strength
    normals = normals / numpy.maximum(numpy.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
    return (0.5 + 0.5 * normals).astype(numpy.float32)


def is_multiplied(node):
    """Whether colours are multiplied by alpha: Cycles divides by it only where the output Alpha is used."""
    image = node.image
    if image.alpha_mode in ("CHANNEL_PACKED", "NONE") or image.channels < 4 or image.colorspace_settings.name in ("Non-Color", "Raw"):
        return False
    alpha = node.outputs.get("Alpha")
    return alpha is not None and not alpha.is_linked


class Maps:
    """The uv maps of a mesh: names with the rendered one first, the box of each map's uvs; the names of its colour attributes. None: of
    what has none."""

    def __init__(self, mesh):
        if mesh is None:
            self.names, self.bounds, self.colors = [], {}, []
            return
        self.colors = mesh.color_names
        first = [mesh.render_uv] if mesh.render_uv is not None else []
        self.names = first + [name for name in mesh.uv_names if name != mesh.render_uv]
        self.bounds = {name: _box(mesh.uvs[name]) for name in self.names}

    def number(self, name):
        """The set of a map; an empty name is the rendered map. Missing maps are 0 everywhere, as in Cycles: set 0."""
        return self.names.index(name) if name in self.names[:4] else 0

    def has_color(self, name):
        """Whether the mesh has a colour attribute; an empty name is the one that is rendered."""
        return name in self.colors or (not name and bool(self.colors))

    def key(self):
        return tuple(self.colors), tuple((name, tuple(self.bounds[name][0]), tuple(self.bounds[name][1])) for name in self.names)


def _box(uvs):
    """The box of uvs, at least the unit square where they are inside it, else in whole numbers; at most 64 wide."""
    known = numpy.isfinite(uvs)
    finite = uvs if known.all() else uvs[known.all(axis=1)]
    if len(finite) == 0:
        return numpy.zeros(2), numpy.ones(2)
    lowest, highest = geometry.bounds(finite)
    low = numpy.clip(numpy.floor(lowest + 1e-4), -32, 31).astype(float)
    high = numpy.clip(numpy.ceil(highest - 1e-4), low + 1, low + 64).astype(float)
    return low, high
