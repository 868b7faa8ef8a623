#!/usr/bin/python3
"""The reference renderer against velo, and against closed forms: two programs that share only the description of the scene.
Images are compared by z of the whole image and of blocks of 8 x 8 pixels, from the standard errors of both."""
import base64
import json
import os
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../python"))
import cases  # noqa: E402
from cases import SOURCE, VELO, WORK, case  # noqa: E402

numpy = cases.need("numpy")
import velo  # noqa: E402

REFERENCE = os.path.join(cases.BINARY, "bin/velo-reference")
CORE = os.path.join(SOURCE, "scenes/reference/core.pbrt")
if not os.path.exists(REFERENCE):
    cases.skip_all("velo-reference is not built")

HEAD = """LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 16 "string filename" "x.exr"
PixelFilter "box"
Integrator "volpath" "integer maxdepth" 50
"""


def run(*command):
    return subprocess.run(command, capture_output=True, text=True)


def colors(image, prefix=""):
    return numpy.stack([numpy.asarray(image[prefix + c], dtype=float) for c in "RGB"], -1)


def render(scene, name, spp, *options):
    """Mean and standard error of each pixel and channel, by the reference renderer."""
    path = os.path.join(WORK, name)
    result = run(REFERENCE, scene, "-o", path, "--spp", str(spp), *options)
    assert result.returncode == 0 and not result.stderr, result.stderr
    image = velo.read_image(path)
    return colors(image), colors(image, "error.")


def render_velo(scene, name, spp, *options):
    path = os.path.join(WORK, name)
    result = run(VELO, "render", scene, "-o", path, "--spp", str(spp), "--filter-samples", "own", "--sampler", "independent",
                 "--tracer", "volpath", "--channels", "error", "--quiet", *options)
    assert result.returncode == 0, result.stderr
    image = velo.read_image(path)
    return colors(image), colors(image, "error.")


def worst_z(a, b):
    """The largest |z| of the whole image and of blocks of 8 x 8."""
    difference, variance = a[0] - b[0], a[1] ** 2 + b[1] ** 2
    parts = [(slice(None), slice(None))]
    parts += [(slice(y, y + 8), slice(x, x + 8)) for y in range(0, difference.shape[0], 8)
              for x in range(0, difference.shape[1], 8)]
    return max(abs(difference[p].sum((0, 1)) / numpy.sqrt(variance[p].sum((0, 1)))).max() for p in parts)


def scene(name, text):
    path = os.path.join(WORK, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(HEAD + text)
    return path


@case
def all_of_the_core_agrees_with_velo():
    size = ("--resolution", "32x24")
    mine, own = render_velo(CORE, "velo.exr", 512, *size), render(CORE, "reference.exr", 256, *size)
    z = worst_z(mine, own)
    assert z < 4.5, "z = %.1f; 39 parts, beyond 4.5 by chance once in 4000 runs" % z
    z = worst_z((1.05 * mine[0], mine[1]), own)
    assert z > 4.5, "a difference of 5 %% would not be seen: z = %.1f" % z


@case
def rgb_agrees_with_velo():
    size = ("--resolution", "32x24", "--color", "rgb", "--max-depth", "3")
    z = worst_z(render_velo(CORE, "velo_rgb.exr", 256, *size), render(CORE, "reference_rgb.exr", 128, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def curves_and_hair_agree_with_velo():
    path, size = os.path.join(SOURCE, "scenes/reference/curves.pbrt"), ("--resolution", "32x24")
    mine, own = render_velo(path, "velo_curves.exr", 512, *size), render(path, "curves.exr", 256, *size)
    z = worst_z(mine, own)
    assert z < 4.5, "z = %.1f" % z


@case
def coated_and_thin_materials_agree_with_velo():
    path, size = os.path.join(SOURCE, "scenes/reference/materials.pbrt"), ("--resolution", "32x24")
    z = worst_z(render_velo(path, "velo_materials.exr", 512, *size), render(path, "materials.exr", 256, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def haze_between_a_smooth_coat_and_a_smooth_metal_agrees_with_velo():
    """Both mirrors are deltas: only a path that knows all their reflections leads from the haze to a light."""
    path = scene("haze.pbrt", 'WorldBegin\nLightSource "infinite" "rgb L" [ .4 .5 .7 ]\n'
                 'LightSource "distant" "point3 from" [ 1 1 -2 ] "point3 to" [ 0 0 0 ] "rgb L" [ 2 1.8 1.5 ]\n'
                 'Material "coatedconductor" "float interface.roughness" 0 "float conductor.roughness" 0 "float thickness" .3 '
                 '"rgb albedo" [ .8 .6 .3 ] "rgb reflectance" [ .9 .6 .3 ]\nShape "sphere" "float radius" .8\n')
    options = ("--max-depth", "2")
    z = worst_z(render_velo(path, "velo_haze.exr", 256, *options), render(path, "haze.exr", 256, *options))
    assert z < 4.5, "z = %.1f" % z


@case
def principled_materials_agree_with_velo():
    path, size = os.path.join(SOURCE, "scenes/reference/principled.pbrt"), ("--resolution", "32x24")
    z = worst_z(render_velo(path, "velo_principled.exr", 1024, *size), render(path, "principled.exr", 512, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def principled_sheets_agree_with_velo():
    """One behind the other, so that light that goes through both has the product of their colours by channel of RGB."""
    text = ('WorldBegin\nLightSource "infinite" "rgb L" [ .5 .6 .4 ]\nLightSource "distant" "point3 from" [ 1 2 -3 ] "point3 to" [ 0 0 0 ] "rgb L" [ 2 1 1 ]\n'
            'LightSource "point" "point3 from" [ .3 .2 1 ] "rgb I" [ 1 2 3 ]\n'
            'Material "principled" "rgb basecolor" [ .9 .6 .3 ] "float metallic" .2 "float roughness" .5 "float transmission" .8 "bool thinwalled" true '
            '"float clearcoat" .5 "float clearcoatroughness" .4\nRotate 20 1 0 0\nShape "disk" "float radius" .9\nReverseOrientation\n'
            'Translate 0 .9 .2\nShape "disk" "float radius" .5\n')
    path = scene("sheet.pbrt", text)
    for color in ("rgb", "spectral"):
        z = worst_z(render_velo(path, "velo_sheet.exr", 2048, "--color", color), render(path, "sheet.exr", 1024, "--color", color))
        assert z < 4.5, "%s: z = %.1f" % (color, z)


def write_gltf(path, texture):
    """Two boards with a normal map; texture coordinates of the second one are mirrored."""
    positions = [(-1.1, -.5, 0), (-.1, -.5, 0), (-.1, .5, .2), (-1.1, .5, 0), (.1, -.5, 0), (1.1, -.5, 0), (1.1, .5, .2), (.1, .5, 0)]
    uvs = [(0, 1), (.4, 1), (.4, .6), (0, .6), (.4, 1), (0, 1), (0, .6), (.4, .6)]
    data = b"".join(struct.pack("<3f", *p) for p in positions) + struct.pack("<3f", 0, 0, 1) * 8
    data += b"".join(struct.pack("<2f", *p) for p in uvs) + struct.pack("<12H", 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7)
    views = [{"buffer": 0, "byteOffset": o, "byteLength": n} for o, n in ((0, 96), (96, 96), (192, 64), (256, 24))]
    kinds = [("VEC3", 8, 5126), ("VEC3", 8, 5126), ("VEC2", 8, 5126), ("SCALAR", 12, 5123)]
    file = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 400, "color": [1, .9, .7]}]}},
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]},
                  {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [.8, 1.5, 1.2]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": .6, "aspectRatio": 1.333, "znear": .1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [.8, .5, .3, 1], "metallicFactor": .3, "roughnessFactor": .5},
                       "normalTexture": {"index": 0, "scale": .8}, "doubleSided": True}],
        "textures": [{"source": 0}], "images": [{"uri": texture}],
        "accessors": [{"bufferView": i, "componentType": c, "count": n, "type": t, **({"min": [-1.1, -.5, 0], "max": [1.1, .5, .2]} if i == 0 else {})} for i, (t, n, c) in enumerate(kinds)],
        "bufferViews": views, "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    }
    with open(path, "w", encoding="utf-8") as out:
        out.write(json.dumps(file))


@case
def a_normal_map_of_a_gltf_file_agrees_with_velo():
    path = os.path.join(WORK, "normals.gltf")
    write_gltf(path, os.path.relpath(os.path.join(SOURCE, "scenes/features/textures/bricks_normal.png"), WORK))
    size = ("--resolution", "32x24")
    z = worst_z(render_velo(path, "velo_normals.exr", 1024, *size), render(path, "normals.exr", 512, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def procedural_textures_bumps_and_normal_maps_agree_with_velo():
    path, size = os.path.join(SOURCE, "scenes/reference/textures.pbrt"), ("--resolution", "32x24")
    z = worst_z(render_velo(path, "velo_textures.exr", 1024, *size), render(path, "textures.exr", 512, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def media_on_grids_and_clouds_agree_with_velo():
    path, size = os.path.join(SOURCE, "scenes/reference/media.pbrt"), ("--resolution", "32x24")
    z = worst_z(render_velo(path, "velo_media.exr", 512, *size), render(path, "media.exr", 256, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def a_cloud_goes_on_above_its_height():
    """Above y = 1 the factor of its noise is negative, so there is fog where the noise is negative."""
    path = scene("cloud.pbrt", 'WorldBegin\nLightSource "infinite" "rgb L" [ 1 1 1 ]\nTranslate 0 -1.7 0\nMakeNamedMedium "cloud" "string type" '
                 '"cloud" "point3 p0" [ -1 1 -1 ] "point3 p1" [ 1 2.4 1 ] "rgb sigma_a" [ 3 3 3 ] "rgb sigma_s" [ 0 0 0 ] "float frequency" 2\n'
                 'MediumInterface "cloud" ""\nMaterial "interface"\nTranslate 0 1.7 0\nShape "sphere" "float radius" .9\n')
    mine, own = render_velo(path, "velo_cloud.exr", 256, "--color", "rgb"), render(path, "cloud.exr", 256, "--color", "rgb")
    assert own[0].min() < 0.8, own[0].min()
    z = worst_z(mine, own)
    assert z < 4.5, "z = %.1f" % z


@case
def lights_that_show_images_and_a_portal_agree_with_velo():
    path, size = os.path.join(SOURCE, "scenes/reference/lights.pbrt"), ("--resolution", "32x24")
    z = worst_z(render_velo(path, "velo_lights.exr", 1024, *size), render(path, "lights.exr", 1024, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def moving_things_and_a_rolling_shutter_agree_with_velo():
    path, size = os.path.join(SOURCE, "scenes/reference/motion.pbrt"), ("--resolution", "32x24")
    z = worst_z(render_velo(path, "velo_motion.exr", 1024, *size), render(path, "motion.exr", 512, *size))
    assert z < 4.5, "z = %.1f" % z


@case
def every_direction_of_a_rolling_shutter_agrees_with_velo():
    for direction in ("down", "up", "left", "right"):
        path = os.path.join(WORK, "shutter.pbrt")
        with open(path, "w", encoding="utf-8") as file:
            file.write('Camera "pinhole" "point3 eye" [ 0 0 -3 ] "point3 lookat" [ 0 0 0 ] "float shutterclose" .3 "float readout" .7 '
                       '"float shutterpoints" [ 0 .2  .4 1  1 0 ] "string readoutdirection" "' + direction + '"\n' + HEAD[HEAD.index("Film"):] +
                       'WorldBegin\nLightSource "infinite" "rgb L" [ 1 .8 .6 ]\nActiveTransform EndTime\nTranslate .3 .4 0\nRotate 70 0 0 1\n'
                       'ActiveTransform All\nScale 1 .3 1\nShape "disk" "float radius" .9\n')
        options = ("--color", "rgb", "--max-depth", "1")
        z = worst_z(render_velo(path, "velo_shutter.exr", 512, *options), render(path, "shutter.exr", 512, *options))
        assert z < 4.5, "%s: z = %.1f" % (direction, z)


@case
def projections_and_distortions_agree_with_velo():
    eye = ' "point3 eye" [ .2 1 -1 ] "point3 lookat" [ 0 .9 0 ] "vector3 up" [ 0 1 0 ]\n'
    rest = HEAD[HEAD.index("Film"):] + ("WorldBegin\n"
        'LightSource "infinite" "rgb L" [ 0.4 0.45 0.5 ]\nLightSource "point" "point3 from" [ 1 3 -1 ] "rgb I" [ 6 5 4 ]\n'
        'Texture "board" "spectrum" "checkerboard" "rgb tex1" [ 0.6 0.15 0.1 ] "rgb tex2" [ 0.15 0.2 0.65 ] "float uscale" 9 "float vscale" 7\n'
        'Material "diffuse" "texture reflectance" "board"\n'
        'Shape "bilinearmesh" "point3 P" [ -3 0 -4  3 0 -4  -3 0 4  3 0 4 ]\nShape "bilinearmesh" "point3 P" [ -3 0 4  3 0 4  -3 3 3  3 2 4 ]\n')
    for camera in ('"fisheye" "string mapping" "stereographic" "float fov" 200', '"fisheye" "string mapping" "orthographic" "float fov" 150',
                   '"equirectangular"', '"cylindrical" "float fov" 200', '"panini" "float panini" 1.2 "float fov" 150',
                   '"fov" "float omega" 0.9 "float fov" 120', '"division" "float lambda" -0.2 "float fov" 120',
                   '"unified" "float xi" 0.8 "float fov" 120', '"eucm" "float alpha" 0.6 "float beta" 1.1 "float fov" 120',
                   '"doublesphere" "float xi" -0.2 "float alpha" 0.6 "float fov" 120',
                   '"opencv" "float fx" 10 "float fy" 11 "float cx" 7 "float cy" 8 "float skew" 1 "float coefficients" '
                   "[ -0.1 0.02 0.01 -0.008 0.003 0.02 0.01 0.001 0.002 0.001 -0.003 0.002 0.05 -0.04 ]",
                   '"opencvfisheye" "float fx" 6 "float fy" 6 "float cx" 8 "float cy" 8 "float coefficients" [ 0.05 -0.02 0.003 -0.0005 ]'):
        path = scene("camera.pbrt", "")
        with open(path, "w", encoding="utf-8") as file:
            file.write("Camera " + camera + eye + rest)
        options = ("--color", "rgb", "--max-depth", "1")
        z = worst_z(render_velo(path, "velo_camera.exr", 256, *options), render(path, "camera.exr", 256, *options))
        assert z < 4.8, "%s: z = %.1f" % (camera, z)


@case
def tubes_seen_obliquely_agree_with_velo():
    """The normals of a tube turn about its axis, also where the ray is not perpendicular to that."""
    path = scene("tube.pbrt", 'WorldBegin\nLightSource "distant" "point3 from" [ 1 .5 -1 ] "point3 to" [ 0 0 0 ] "rgb L" [ 2 2 2 ]\n'
                 'Shape "curve" "string type" "cylinder" "point3 P" [ -.2 -.6 -.8 -.1 -.2 -.3 .1 .2 .3 .2 .6 .8 ] '
                 '"float width" .3\n')
    mine, own = render_velo(path, "velo_tube.exr", 1024, "--color", "rgb"), render(path, "tube.exr", 1024, "--color", "rgb")
    z = worst_z(mine, own)
    assert z < 4.5, "z = %.1f" % z


@case
def a_scene_of_the_lecture_agrees_with_velo():
    """Clear coats, the sky twice, a lamp."""
    path, size = os.path.join(SOURCE, "scenes/lecture/example_1.pbrt"), ("--resolution", "32x24", "--max-depth", "3")
    z = worst_z(render_velo(path, "lecture.exr", 128, *size),
                render(path, "lecture_reference.exr", 128, "--tracer", "volpath", *size))
    assert z < 4.5, "z = %.1f" % z


@case
def vertex_normals_are_blended_with_their_lengths():
    """Lengths of vertex normals are weights, also those that a transform of the shape or of its instance makes."""
    mesh = ('Shape "trianglemesh" "point3 P" [ -.8 -.5 0  .9 -.6 .1  0 .9 -.2 ] "integer indices" [ 0 1 2 ] '
            '"normal N" [ -.6 -.6 3  .03 -.02 .1  0 .4 1 ]\n')
    squeeze = "Rotate 168 0.37 1 -0.84\nScale 0.5 1.2 2\n"
    light = ('WorldBegin\nLightSource "distant" "point3 from" [ 1 2 -3 ] "point3 to" [ 0 0 0 ] "rgb L" [ 3 3 3 ]\n'
             'LightSource "distant" "point3 from" [ -3 2 1 ] "point3 to" [ 0 0 0 ] "rgb L" [ 1 2 3 ]\n')
    for name, text in (("plain", squeeze + mesh), ("instance", 'ObjectBegin "m"\n' + mesh + "ObjectEnd\n" + squeeze +
                                                   'ObjectInstance "m"\n')):
        path = scene("normals_%s.pbrt" % name, light + text)
        z = worst_z(render_velo(path, "velo_normals.exr", 256), render(path, "normals.exr", 256))
        assert z < 4.5, "%s: z = %.1f" % (name, z)


@case
def alpha_textures_of_instances_are_placed_in_the_world():
    """As other textures: where the instance is, not where its object was defined."""
    texture = ('Texture "a" "float" "checkerboard" "float tex1" 1 "float tex2" 0 "string mapping" "planar" '
               '"vector3 v1" [ 1.3 .4 .1 ] "vector3 v2" [ -.2 1.7 .4 ]\n')
    light = 'WorldBegin\nLightSource "infinite" "rgb L" [ 1 .8 .6 ]\n' + texture
    place = "Translate .3 .2 .1 Rotate 50 1 2 3 Scale -1 1.2 .9\n"
    for name, shape in (("sphere", 'Shape "sphere" "float radius" .7 "texture alpha" "a"\n'),
                        ("mesh", 'Shape "trianglemesh" "point3 P" [ -.9 -.7 0  .9 -.6 .1  0 .9 -.2 ] "texture alpha" "a"\n')):
        text = 'ObjectBegin "m"\n' + shape + "ObjectEnd\n" + place + 'ObjectInstance "m"\n'
        path, direct = scene("alpha_%s.pbrt" % name, light + text), scene("alpha_%s_direct.pbrt" % name, light + place + shape)
        mine = render_velo(path, "velo_alpha.exr", 64)
        for other in (render_velo(direct, "velo_direct.exr", 64, "--seed", "1"), render(path, "alpha.exr", 64)):
            z = worst_z(mine, other)
            assert z < 4.5, "%s: z = %.1f" % (name, z)


@case
def sides_under_mirroring_transforms_agree_with_velo():
    """Glass of index 2 seen from outside, over a lamp, is 1/4 as bright, else 4 times: which side is out is as in pbrt, for each
    kind of shape, mirrored or not, in an instance or not, turned by ReverseOrientation or not."""
    shapes = (("quadric", 'Shape "disk" "float radius" 5\n'),
              ("patch", 'Shape "bilinearmesh" "point3 P" [ -5 -5 0  5 -5 0  -5 5 0  5 5 .1 ]\n'),
              ("triangles", 'Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  0 9 0 ]\n'),
              ("normals", 'Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  0 9 0 ] "normal N" [ 0 0 -1 0 0 -1 0 0 -1 ]\n'))
    lamp = 'AttributeBegin Translate 0 0 1 AreaLightSource "diffuse" "bool twosided" true Shape "disk" "float radius" 5 AttributeEnd\n'
    sides = set()
    for name, shape in shapes:
        for mirror in ("", "Scale -1 1 1 "):
            for place in ("", "Scale 1 -1 1 "):
                for turn in ("", "ReverseOrientation "):
                    text = turn + 'Material "dielectric" "float eta" 2\n' + shape
                    text = 'ObjectBegin "o" AttributeBegin ' + mirror + text + "AttributeEnd ObjectEnd\n" + place + 'ObjectInstance "o"\n'
                    path = scene("sides.pbrt", "WorldBegin\n" + lamp + "AttributeBegin " + text + "AttributeEnd\n")
                    options = ("--color", "rgb", "--resolution", "2x2")
                    means = [draw(path, "sides.exr", 64, *options)[0].mean() for draw in (render_velo, render)]
                    sides.add((name, bool(mirror), bool(place), bool(turn), means[0] > 1))
                    assert 0.5 < means[0] / means[1] < 2, (name, mirror, place, turn, means)
    out = [s[:4] for s in sides if s[4]]
    assert len(out) == 16, "half of the 32 are seen from inside: %s" % out


@case
def a_white_furnace_is_white():
    for name, material in (("diffuse", '"diffuse" "rgb reflectance" [ 1 1 1 ]'),
                           ("principled", '"principled" "rgb basecolor" [ 1 1 1 ] "float metallic" .4 "float roughness" .7'),
                           ("glass", '"dielectric" "float eta" 1.5 "float roughness" 0')):
        path = scene(name + ".pbrt", 'WorldBegin\nLightSource "infinite" "rgb L" [ 1 1 1 ]\nMaterial ' + material +
                     '\nShape "sphere" "float radius" 0.8\n')
        mean, error = render(path, name + ".exr", 64, "--color", "rgb")
        z = worst_z((mean, error), (numpy.ones_like(mean), numpy.full_like(mean, 1e-4)))
        assert z < 4.5 and abs(mean.mean() - 1) < 0.01, (name, z, mean.mean())


@case
def a_point_light_over_a_diffuse_plane_has_its_closed_form():
    """Radiance = reflectance / pi * I cos / d^2, at the middle of the image: 0.5 / pi * 8 / 4."""
    path = scene("point.pbrt", 'WorldBegin\nLightSource "point" "rgb I" [ 8 8 8 ] "point3 from" [ 0 0 -2 ]\n'
                 'Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]\nShape "disk" "float radius" 0.02\n')
    mean, _ = render(path, "point.exr", 16, "--color", "rgb", "--max-depth", "1", "--resolution", "401x401")
    assert abs(mean[200, 200] - 0.5 / numpy.pi * 2).max() < 1e-4, mean[200, 200]


@case
def a_sphere_of_fog_absorbs_by_beers_law():
    path = scene("fog.pbrt", 'WorldBegin\nLightSource "infinite" "rgb L" [ 1 1 1 ]\n'
                 'MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 0.5 0.25 ] "rgb sigma_s" [ 0 0 0 ]\n'
                 'MediumInterface "fog" ""\nMaterial "interface"\nShape "sphere" "float radius" 0.5\n')
    mean, _ = render(path, "fog.exr", 16, "--color", "rgb", "--resolution", "401x401")
    assert abs(mean[200, 200] - numpy.exp([-1, -0.5, -0.25])).max() < 1e-4, mean[200, 200]


@case
def what_it_does_not_have_is_refused_by_name():
    for text, words in (('Material "subsurface"\nShape "sphere"\n', 'material "subsurface" is not part of'),
                        ('Material "principled" "float transmission" .5 "bool thinwalled" false\nShape "sphere"\n', "a principled solid that transmits light is not part of")):
        path = scene("refused.pbrt", "WorldBegin\n" + text)
        result = run(REFERENCE, path, "-o", os.path.join(WORK, "refused.exr"), "--spp", "1")
        assert result.returncode == 3 and words in result.stderr, (result.returncode, result.stderr)
        assert ":7:" in result.stderr or "refused.pbrt" in result.stderr, result.stderr
    with open(os.path.join(WORK, "wide.pbrt"), "w", encoding="utf-8") as file:
        file.write('ColorSpace "rec2020"\n' + HEAD + 'WorldBegin LightSource "infinite"\n')
    image = os.path.join(WORK, "wide.exr")
    assert run(VELO, "render", os.path.join(WORK, "wide.pbrt"), "-o", image, "--spp", "1", "--quiet").returncode == 0
    named = '"string filename" "wide.exr"\n'
    grid = ('ColorSpace "rec2020" MakeNamedMedium "m" "string type" "rgbgrid" "rgb sigma_a" [1 1 1] "rgb sigma_s" [1 1 1] '
            '"integer nx" 1 "integer ny" 1 "integer nz" 1\n')
    for text, words in (('LightSource "infinite" ' + named, "an image in another colour space than sRGB"),
                        ('LightSource "projection" ' + named, "an image in another colour space than sRGB"),
                        ('Texture "t" "spectrum" "imagemap" ' + named, "an image in another colour space than sRGB"),
                        ('AreaLightSource "diffuse" %sShape "sphere"\n' % named, "an image in another colour space than sRGB"),
                        (grid, "this colour space in RGB")):
        result = run(REFERENCE, scene("refused.pbrt", "WorldBegin\n" + text), "-o", os.path.join(WORK, "refused.exr"), "--spp", "1",
                     "--color", "rgb")
        assert result.returncode == 3 and words in result.stderr, (text, result.returncode, result.stderr)
    assert run(REFERENCE, "no.pbrt", "-o", "x.exr").returncode == 4
    assert run(REFERENCE, CORE).returncode == 2
    assert run(REFERENCE, CORE, "-o", "x.exr", "--spp", "0").returncode == 2


if __name__ == "__main__":
    cases.main()
