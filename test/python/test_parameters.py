#!/usr/bin/python3
"""Every parameter of every kind of material, texture, light, medium, emission and shape that Python can set arrives in the
scene: its value is in the .pbrt file that is written, under the name that its row (velo/schema.h) gives it there, and the file
that is read and written again is the same. Names and types are those of the rows, as the program prints them. What is written
keeps the rules of its format."""
import json
import re
import subprocess

import cases
from cases import VELO, broken_rules, case, report, work

numpy = cases.need("numpy")
import velo

FAMILIES = ("materials", "textures", "lights", "media", "emission", "shapes")
PNG = velo.Image(numpy.full((8, 8, 3), 0.25, dtype=numpy.float32))
PNG.write(work("a.pfm"))
CELLS = numpy.linspace(0.1, 0.9, 8).reshape(2, 2, 2)
COLORS = numpy.linspace(0.1, 0.9, 24).reshape(2, 2, 2, 3)
BOX = {"low": (-1, -1, -1), "high": (1, 1, 1)}
QUAD = [[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0.2]]

# What a kind cannot do without; and what a parameter needs to count.
BASES = {("media", "grid"): {"density": CELLS, **BOX}, ("media", "rgb_grid"): {"rgb_a": COLORS, **BOX},
         ("textures", "image"): {"path": work("a.pfm")}, ("lights", "goniometric"): {"path": work("a.pfm")},
         ("lights", "projection"): {"path": work("a.pfm")}, ("shapes", "sphere"): {"z_min": -0.2, "z_max": 0.2}, ("shapes", "triangles"): {"positions": QUAD[:3], "indices": [[0, 1, 2]]},
         ("shapes", "bilinear"): {"positions": QUAD, "indices": [[0, 1, 2, 3]]}, 
         ("shapes", "curves"): {"positions": QUAD, "widths": [0.1, 0.2]}}
# What a parameter needs to count.
NEEDS = {"wrap_t": {"wrap_t_given": True}, "wrap_t_given": {"wrap_t": "black"}, "encoding": {"encoding_given": True},
         "gamma": {"encoding_given": True, "encoding": "gamma"}, "planar_v1": {"mapping": "planar"}, "planar_v2": {"mapping": "planar"}, "mfp": {"from_reflectance": True},
         "z_min": {"radius": 2.0, "z_max": 2.0}, "z_max": {"radius": 2.0, "z_min": -2.0}, "inner_radius": {"radius": 2.0},
         "clearcoat_roughness": {"clearcoat": 0.5}, "sheen_roughness": {"sheen_color": (0.5, 0.5, 0.5)}, "iridescence_ior": {"iridescence": 0.5},
         "iridescence_thickness": {"iridescence": 0.5}, "anisotropy_rotation": {"anisotropy": 0.5},
         "diffuse_transmission_color": {"diffuse_transmission": 0.5}, "thin_walled": {"transmission": 1.0}, "space": {"path": work("a.pfm")},
         "dispersion": {"transmission": 1.0, "thin_walled": False}}
# Values of parameters whose rows do not name them.
GIVEN = {("hair", "color"): ["reflectance"], ("image", "encoding"): ["sRGB"], ("image", "gamma"): [1.75], ("image", "wrap_t"): ["black", "clamp"],
         ("image", "space"): ["rec2020"], ("infinite", "space"): ["rec2020"], ("goniometric", "space"): ["rec2020"],
         ("projection", "space"): ["rec2020"], **{(kind, "low"): [(-2, -2.5, -3)] for kind in ("grid", "rgb_grid", "cloud")},
         **{(kind, "high"): [(2, 2.5, 3)] for kind in ("grid", "rgb_grid", "cloud")}}
# A cloud's scale is part of its coefficients in files. Only a coat over a diffuse base can conserve energy.
OTHERWISE = (("cloud", "scale"), ("coated_conductor", "conserve_energy"))

# Of files and arrays of numbers, which the tests of scenes from arrays have.
ARRAYS = "path image data data_size lamp_data lamp_size measured grid temperature_grid density emission_scales temperature rgb_a rgb_s rgb_emission nx ny nz " \
         "positions indices normals tangents uvs tangent_signs more_uvs colors positions_close normals_close times widths centers radii " \
         "displacement edge_length normal_map normal normal_scale clearcoat_normal clearcoat_normal_scale texture alpha portal texture_from_world st_from_uv materials".split()


def tables(family):
    """Of each kind, by its name in files: the rows by their description: name, type, default, range."""
    text = subprocess.run([VELO, "scene", "kinds", family], stdout=subprocess.PIPE, text=True, check=True).stdout
    kinds, rows = {}, {}
    for line in text.splitlines():
        head = re.match(r"\*\*`(\w+)`\*\*", line)
        if head:
            rows = kinds[head.group(1)] = {}
        row = re.match(r"\| `([\w.]+)` \| (.*?) \| (.*?) \| (.*?) ?\| (.*) \|$", line)
        if row:
            rows[row.group(5)] = row.groups()[:4]
    return kinds


def rows_of(family, kind, printed):
    """The rows of a kind, whose name in files may differ; then those of all kinds of the family."""
    for name, rows in printed.items():
        if name == kind.replace("_", ""):
            return rows
    return {text: row for rows in printed.values() for text, row in rows.items()}


def values(row):
    """Values that differ from the default, as Python takes them, and as a file has them."""
    name, kind, default, limits = row if row else ("", "", "", "")
    first = re.match(r"-?[\d.]+", default)
    number = float(first.group()) if first else 0.5
    scale = numpy.pi / 180 if "degrees" in default else 1
    near = [0.5 * number + 0.125, number + 1, 0.25]
    found = []
    if "bool" in kind or not row:
        found += [(default != "true", None), (default == "true", None)]
    if "integer" in kind or not row:
        found += [(int(number) + 1, [int(number) + 1]), (int(number) - 1, [int(number) - 1])]
    if re.search("float|the texture's", kind) or not row:
        found += [(x * scale, [x]) for x in near]
    if "string" in kind:
        found += [(x, None) for x in re.findall(r"\w+", limits)[::-1] if x != default]
    if "spectrum" in kind or not row:
        found += [((0.25, 0.5, 0.125), [0.25, 0.5, 0.125])]
    if re.search("point3|vector3|normal", kind) or not row:
        found += [((1.5, 2.0, -3.0), [1.5, 2.0, -3.0])]
    if not row:
        found += [((0.5, 0.25), [0.5, 0.25]), ((0.5, 0.25, 0.125, 0.75), [0.5, 0.25, 0.125, 0.75])]
    return found


def scene(family, kind, keywords):
    """A scene in which an object of this kind is used."""
    made = velo.Scene()
    plain = made.add_material("diffuse", reflectance=0.5, name="plain")
    if family == "materials":
        if kind == "mix":
            keywords = {"materials": [plain, made.add_material("dielectric", name="other")], **keywords}
        made.add_mesh(QUAD, [[0, 1, 2], [1, 3, 2]], material=made.add_material(kind, name="it", **keywords))
    elif family == "textures":
        spectrum = kind not in ("fbm", "wrinkled", "windy") and "bias" not in keywords and "cutoff" not in keywords and "channel" not in keywords
        spectrum = spectrum and not any(word.startswith("float_") for word in keywords)
        texture = made.add_texture(kind, spectrum=spectrum, **keywords)
        made.add_sphere((0, 0, 0), 0.5, material=made.add_material("diffuse", reflectance=texture) if spectrum else
                        made.add_material("mix", materials=[plain, made.add_material("dielectric")], amount=texture))
    elif family == "lights":
        made.add_light(kind, **keywords)
    elif family == "media":
        made.add_sphere((0, 0, 0), 0.5, material=plain, inside=made.add_medium(kind, **keywords))
    elif family == "emission":
        made.add_sphere((0, 0, 0), 0.5, material=plain, emission=made.add_emission(**keywords))
    else:
        made.add_shape(kind, material=plain, **keywords)
    return made


def file_of(kind):
    """Principled materials are glTF's."""
    return work("s.gltf" if kind == "principled" else "s.pbrt")


def written(made, kind):
    """The text of its file without names that the writer makes, and what is lost."""
    lost = made.save(file_of(kind))
    with open(file_of(kind)) as file:
        if kind == "principled":
            return json.dumps(json.load(file)["materials"]), lost
        return re.sub(r"(texture\d+)-\d+|.*screenwindow.*", r"\1", file.read()), lost  # the window: its last digits


def again(kind):
    made = velo.Scene()
    made.load(file_of(kind))
    return written(made, kind)[0]


def numbers(text, name):
    """The lists of numbers that the file has under this name."""
    found = re.findall(r'" ?\w+ %s" (?:\[([^\]"]*)\]|([-\d.e]+))' % re.escape(name), text.replace('"float', '" float'))
    found += re.findall(r'"\w+ %s" (?:\[([^\]"]*)\]|([-\d.e]+))' % re.escape(name), text)
    return [[float(x) for x in (a or b).split()] for a, b in found]


def same(a, b):
    return len(a) == len(b) and all(abs(x - y) <= 1e-5 * max(1, abs(y)) for x, y in zip(a, b))


def arrive(family, kind, word, row, problems):
    """Whether a value of the parameter arrives: "file", "lost" (the writer says so), or None: no value was taken or changed anything."""
    base = {**BASES.get((family, kind), {}), **NEEDS.get(word, {})}
    plain = written(scene(family, kind, base), kind)
    place = "%s %s: %s" % (family, kind, word)
    for value, expected in [(x, None) for x in GIVEN.get((kind, word), [])] or values(row):
        try:
            text, lost = written(scene(family, kind, {**base, word: value}), kind)
        except velo.Error:
            continue
        problems += ["%s = %r: %s" % (place, value, rule) for rule in broken_rules(file_of(kind))]
        if lost:
            return "lost"
        if text == plain[0]:
            continue
        held = family not in ("materials", "textures", "media", "lights") or '"%s"' % kind.replace("_", "") in text
        if row and expected and held and not any(same(x, expected) for x in numbers(text, row[0])):
            problems.append("%s = %r is not \"%s\" in the file, which has %r" % (place, value, row[0], numbers(text, row[0])))
        try:
            read = again(kind)
            if read != text and word != "direction":  # read, it has the length 1
                problems.append("%s = %r: read and written again, the file differs" % (place, value))
        except velo.Error as error:
            problems.append("%s = %r: the file cannot be read: %s" % (place, value, error))
        return "file"
    return None


@case
def keywords_of_kinds_arrive_in_the_scene():
    problems, counts, silent = [], {"file": 0, "lost": 0}, []
    for family in FAMILIES:
        printed = tables(family)
        for kind, words in velo.kinds(family).items():
            if kind in ("measured", "nanovdb"):  # of files
                continue
            rows = rows_of(family, kind, printed)
            for word, text in words.items():
                if word in ARRAYS or (kind, word) in OTHERWISE:
                    continue
                how = arrive(family, kind, word, rows.get(text), problems)
                if how:
                    counts[how] += 1
                else:
                    silent.append("%s %s: %s" % (family, kind, word))
    print("  %d in files, %d of which the writer says that they are lost; %d not" % (counts["file"], counts["lost"], len(silent)))
    report(problems + silent)


if __name__ == "__main__":
    cases.main()
