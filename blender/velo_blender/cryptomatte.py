"""cryptomatte.py: velo's Cryptomattes (specification 1.2, Psyop) as those of Blender: by object, material and asset, the object at the
top of the chain of parents. velo has mattes of instances, of shapes and of its own materials, which may share a name of Blender."""
import json

import numpy

#: Start of the passes' names -> switch of the view layer.
KINDS = {"CryptoObject": "use_pass_cryptomatte_object", "CryptoMaterial": "use_pass_cryptomatte_material",
         "CryptoAsset": "use_pass_cryptomatte_asset"}
#: Start of the passes' names -> velo's channels.
CHANNELS = {"CryptoObject": ["crypto.instance", "crypto.object"], "CryptoAsset": ["crypto.instance", "crypto.object"],
            "CryptoMaterial": ["crypto.material"]}
RANKS = 6  # that velo's channels have


def levels(view_layer):
    """The number of passes of each kind; each has two ranks."""
    return (view_layer.pass_cryptomatte_depth + 1) // 2


def pass_names(view_layer):
    """The names of all passes that are switched on."""
    return ["%s%02d" % (kind, level) for kind, switch in KINDS.items() if getattr(view_layer, switch) for level in range(levels(view_layer))]


def hash_of(name):
    """MurmurHash3_x86_32 of a name, seed 0 (Appleby, public domain)."""
    data, mask = name.encode("utf-8", "surrogateescape"), 0xffffffff

    def rotate(x, bits):
        return (x << bits | x >> (32 - bits)) & mask

    def mixed(k):
        return rotate(k * 0xcc9e2d51 & mask, 15) * 0x1b873593 & mask
    h, whole = 0, len(data) // 4 * 4
    for at in range(0, whole, 4):
        h = (rotate(h ^ mixed(int.from_bytes(data[at:at + 4], "little")), 13) * 5 + 0xe6546b64) & mask
    h ^= mixed(int.from_bytes(data[whole:], "little"))
    h ^= len(data)
    h = (h ^ h >> 16) * 0x85ebca6b & mask
    h = (h ^ h >> 13) * 0xc2b2ae35 & mask
    return h ^ h >> 16


def as_float(value):
    """The float of a hash, as Blender makes it (uint32_to_float32 with an exponent from 1 to 254)."""
    exponent = min(max(value >> 23 & 255, 1), 254)
    return numpy.array(value & 0x807fffff | exponent << 23, dtype=numpy.uint32).view(numpy.float32)


class _Table:
    """Which of Blender's names velo's ids of one kind have."""

    def __init__(self, image, channel, ids, names):
        """channel: CryptoInstance, ...; ids: velo's World.ids; names: of Blender, by id - 1; None: not in the matte."""
        manifest = _manifest(image, channel)
        known = {}
        for entry, name in zip(ids, names):
            text = manifest.get(entry["name"] if entry["name"] and not entry["shared_name"] else
                                "%s.%d" % (entry["name"] or entry["type"], entry["id"]))
            if text is not None and name is not None:
                known[int(text, 16)] = name
        self.names = sorted(set(known.values()))
        number = {name: k for k, name in enumerate(self.names, 1)}
        self._bits = numpy.array(sorted(known), dtype=numpy.uint32)
        self._numbers = numpy.array([number[known[int(bits)]] for bits in self._bits], dtype=numpy.int64)

    def numbers(self, values):
        """The numbers of names, from 1, of a channel of ids; 0: none."""
        bits = numpy.ascontiguousarray(values, dtype=numpy.float32).view(numpy.uint32)
        if len(self._bits) == 0:
            return numpy.zeros(bits.shape, dtype=numpy.int64)
        at = numpy.minimum(numpy.searchsorted(self._bits, bits), len(self._bits) - 1)
        return numpy.where(self._bits[at] == bits, self._numbers[at], 0)


def _manifest(image, channel):
    attributes = image.attributes
    for key, value in attributes.items():
        if key.startswith("cryptomatte/") and key.endswith("/name") and value == channel:
            return json.loads(attributes[key[:-len("name")] + "manifest"])
    return {}


def _ranks(rows, channel, table, ask):
    """[(numbers of names, coverages)] of all ranks that velo has, each height x width, of passes.Rows. ask: as of passes.Made."""
    ranks = []
    for level in range(RANKS // 2):
        values = rows["%s%02d" % (channel, level)]
        for first in (0, 2):
            ask()
            ranks.append((table.numbers(values[..., first]), numpy.array(values[..., first + 1])))
    return ranks


def _merge(ranks, count):
    """Two arrays of count x height x width: hashes' numbers and their coverages, each name once, the largest coverage first."""
    numbers = numpy.stack([rank[0] for rank in ranks])
    covered = numpy.where(numbers > 0, numpy.stack([rank[1] for rank in ranks]), 0)
    for later in range(1, len(ranks)):
        for earlier in range(later):
            same = (numbers[later] == numbers[earlier]) & (numbers[later] > 0)
            covered[earlier] += numpy.where(same, covered[later], 0)
            covered[later] = numpy.where(same, 0, covered[later])
            numbers[later] = numpy.where(same, 0, numbers[later])
    order = numpy.argsort(-covered, axis=0, kind="stable")[:count]
    return numpy.take_along_axis(numbers, order, axis=0), numpy.take_along_axis(covered, order, axis=0)


class _Kind:
    """A Cryptomatte. names: all that may be seen; values: their hashes as floats, behind a 0; channels: [(velo's channel, its table,
    the place in values of each of the table's numbers)]."""

    def __init__(self, tables):
        self.names = sorted({name for _, table in tables for name in table.names})
        number = {name: k for k, name in enumerate(self.names, 1)}
        self.values = numpy.array([0] + [as_float(hash_of(name)) for name in self.names], dtype=numpy.float32)
        self.channels = [(channel, table, numpy.array([0] + [number[name] for name in table.names])) for channel, table in tables]


class Mattes:
    """The Cryptomattes of an image. export: export.Export; ask: as of passes.Made."""

    def __init__(self, export, image, ask):
        self._export, self._image, self._ask = export, image, ask
        self._kinds = {}
        self._merged = None, None  # of the last rows: (kind, rows), (hashes, coverages)

    def _tables(self, kind):
        """[(channel, table)] of a kind."""
        world, export = self._export.scene.world(), self._export
        if kind == "CryptoMaterial":
            ids = world.ids("material")
            return [("CryptoMaterial", _Table(self._image, "CryptoMaterial", ids, [entry["name"] for entry in ids]))]
        pick = (lambda placed: placed.asset) if kind == "CryptoAsset" else (lambda placed: placed.name)
        return [(channel, _Table(self._image, channel, world.ids(ids), [None if placed is None else pick(placed) for placed in owners]))
                for channel, ids, owners in (("CryptoInstance", "instance", export.instances), ("CryptoObject", "object", export.shapes))]

    def _kind(self, kind):
        if kind not in self._kinds:
            self._kinds[kind] = _Kind(self._tables(kind))
        return self._kinds[kind]

    def _merge_rows(self, kind, rows):
        """Hashes and coverages of all ranks, each ranks x height x width."""
        known = self._kind(kind)
        ranks = []
        for channel, table, places in known.channels:
            ranks += [(places[numbers], covered) for numbers, covered in _ranks(rows, channel, table, self._ask)]
        self._ask()
        numbers, covered = _merge(ranks, RANKS)
        self._ask()
        return known.values[numbers], covered

    def layer(self, name, rows):
        """height x width x 4: the pass of a name such as CryptoObject01, of passes.Rows."""
        kind, level = name[:-2], int(name[-2:])
        if self._merged[0] != (kind, rows):
            self._merged = (kind, rows), self._merge_rows(kind, rows)
        values, covered = self._merged[1]
        result = numpy.zeros(values.shape[1:] + (4,), dtype=numpy.float32)
        for k in range(2):
            if 2 * level + k < len(values):
                result[..., 2 * k], result[..., 2 * k + 1] = values[2 * level + k], covered[2 * level + k]
        return result

    def fields(self, layer_name):
        """The fields of the file's header, as Blender names them: {field: value}."""
        result = {}
        for kind in self._kinds:
            name = "%s.%s" % (layer_name, kind)
            start = "cryptomatte/%s/" % ("%08x" % hash_of(name))[:7]
            manifest = {known: "%08x" % hash_of(known) for known in self._kinds[kind].names}
            result.update({start + "name": name, start + "hash": "MurmurHash3_32", start + "conversion": "uint32_to_float32",
                           start + "manifest": json.dumps(manifest, separators=(",", ":"), ensure_ascii=False)})
        return result


def is_matte(name):
    """Whether a pass is one of a Cryptomatte."""
    return name[:-2] in KINDS and name[-2:].isdigit()
