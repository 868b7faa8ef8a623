"""tools/damage/sources.py: right files of every kind, to be damaged: the tree's own, those of ../shared where it is there, and
some made here. A source is (name, files by relative name, the file to damage, its form, the file the program is given)."""
import gzip
import os
import re
import struct
import zlib

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHARED = os.path.join(os.path.dirname(ROOT), "shared", "scenes")
CORPUS = os.path.join(ROOT, "test", "fuzz", "corpus")


def read(path):
    with open(path, "rb") as f:
        return f.read()


def names(folder, pattern):
    return sorted(n for n in os.listdir(folder) if re.search(pattern, n)) if os.path.isdir(folder) else []


def tree(folder):
    """A folder's files as relative name -> path, to be linked."""
    found = {}
    for where, _, files in os.walk(folder):
        for name in files:
            path = os.path.join(where, name)
            found[os.path.relpath(path, folder)] = path
    return found


HEAD = 'LookAt 0.3 0.2 4  0 0 0  0 1 0\nCamera "perspective" "float fov" 45\nWorldBegin\nLightSource "infinite" "rgb L" [1 1 1]\n'


# What no scene of the tree's shows.
MORE = b"""Option "string rendercoordsys" "world"
Film "spectral" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ] "integer nbuckets" [ 8 ] "float lambdamin" [ 400 ] "float lambdamax" [ 700 ]
Integrator "volpath" "integer maxdepth" [ 5 ] "bool regularize" true
LookAt 0.3 0.2 4  0 0 0  0 1 0
Camera "perspective" "float fov" 45
WorldBegin
LightSource "infinite" "string filename" "sky.pfm" "point3 portal" [ -1 -1 2  1 -1 2  1 1 2  -1 1 2 ]
Material "measured" "string filename" "m.bsdf"
Shape "sphere" "float radius" 0.5
Material "subsurface" "string name" "Skin1" "float scale" 10
AttributeBegin Translate 1 0 0 Shape "sphere" "float radius" 0.4 AttributeEnd
Material "subsurface" "rgb reflectance" [ 0.6 0.4 0.3 ] "rgb mfp" [ 0.1 0.05 0.03 ] "float eta" 1.4
AttributeBegin Translate -1 0 0 Shape "sphere" "float radius" 0.4 AttributeEnd
Material "subsurface" "rgb sigma_a" [ 0.1 0.2 0.3 ] "rgb sigma_s" [ 5 4 3 ] "float g" 0.2 "float roughness" 0.2
AttributeBegin Translate 0 1 0 Shape "sphere" "float radius" 0.4 AttributeEnd
"""


def scenes():
    for folder in ("features", "cameras", "lecture"):
        files = tree(os.path.join(ROOT, "scenes", folder))
        for name in names(os.path.join(ROOT, "scenes", folder), r"\.pbrt$"):
            yield folder + "_" + name, files, name, "scene", name
    for name in names(os.path.join(CORPUS, "scene"), r"\.pbrt$"):
        yield "corpus_" + name, {name: os.path.join(CORPUS, "scene", name)}, name, "scene", name
    for folder in names(os.path.join(SHARED, "pbrt"), r"^[a-z0-9-]+$"):
        files = tree(os.path.join(SHARED, "pbrt", folder))
        # what a sanitizer takes long to read: only some scenes of a large folder
        for name in names(os.path.join(SHARED, "pbrt", folder), r"\.pbrt$"):
            if "environment" not in name:
                yield folder + "_" + name, files, name, "scene", name
    sky = os.path.join(ROOT, "scenes", "features", "textures", "sky.pfm")
    yield "more", {"more.pbrt": MORE, "sky.pfm": sky, "m.bsdf": measured()}, "more.pbrt", "scene", "more.pbrt"
    yield "packed", {"packed.pbrt.gz": gzip.compress(read(os.path.join(CORPUS, "scene", "everything.pbrt")), mtime=0)}, \
        "packed.pbrt.gz", "packed", "packed.pbrt.gz"


MESHES = ['Shape "plymesh" "string filename" "%s"\n',
          'Material "conductor"\nShape "plymesh" "string filename" "%s" "float alpha" 0.7\nObjectBegin "o" Shape "plymesh" "string filename" "%s"'
          ' ObjectEnd\nObjectInstance "o"\n',
          'Texture "d" "float" "wrinkled" "float roughness" 0.4\nAreaLightSource "diffuse" "rgb L" [2 2 2]\n'
          'Shape "plymesh" "string filename" "%s" "texture displacement" "d" "float edgelength" 0.2\n']


def meshes():
    found = [(n, read(os.path.join(CORPUS, "ply", n))) for n in names(os.path.join(CORPUS, "ply"), r"\.ply$")]
    found.append(("tetrahedron.ply", read(os.path.join(ROOT, "scenes", "features", "tetrahedron.ply"))))
    for folder in names(os.path.join(SHARED, "pbrt"), r"^[a-z0-9-]+$"):
        models = os.path.join(SHARED, "pbrt", folder, "models")
        small = [n for n in names(models, r"\.ply$") if os.path.getsize(os.path.join(models, n)) < 30000]
        found += [("%s_%s" % (folder, n), read(os.path.join(models, n))) for n in small[:4]]
    for name, data in found:
        for i, text in enumerate(MESHES):
            yield "%s_%d" % (name, i), {"mesh.ply": data, "scene.pbrt": (HEAD + text.replace("%s", "mesh.ply")).encode()}, \
                "mesh.ply", "ply", "scene.pbrt"
        yield name + ".gz", {"mesh.ply.gz": gzip.compress(data, mtime=0),
                             "scene.pbrt": (HEAD + MESHES[0].replace("%s", "mesh.ply.gz")).encode()}, "mesh.ply.gz", "packed", "scene.pbrt"
        yield name + "_alone", {"mesh.ply": data}, "mesh.ply", "ply", "mesh.ply"


SURFACE = 'Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n'
IMAGES = ['Texture "t" "spectrum" "imagemap" "string filename" "%s"\nMaterial "diffuse" "texture reflectance" "t"\n' + SURFACE,
            'Texture "t" "float" "imagemap" "string filename" "%s"\n' + SURFACE.strip() + ' "texture alpha" "t"\n',
            'LightSource "infinite" "string filename" "%s"\n' + SURFACE,
            'LightSource "goniometric" "string filename" "%s"\n' + SURFACE,
            'LightSource "projection" "string filename" "%s"\n' + SURFACE,
            'Material "diffuse" "string normalmap" "%s"\n' + SURFACE,
            'AreaLightSource "diffuse" "string filename" "%s"\n' + SURFACE]


def images():
    folder = os.path.join(CORPUS, "image")
    found = [(n, os.path.join(folder, n)) for n in names(folder, ".")]
    own = os.path.join(ROOT, "scenes", "features", "textures")
    found += [(n, os.path.join(own, n)) for n in names(own, ".")]
    for name in ("pbrt-killeroos/textures/lines.png", "dining-room/textures/Teacup.tga"):
        if os.path.isfile(os.path.join(SHARED, "pbrt", name)):
            found.append((os.path.basename(name), os.path.join(SHARED, "pbrt", name)))
    for name, path in found:
        for i, text in enumerate(IMAGES):
            yield "%s_%d" % (name, i), {name: path, "scene.pbrt": (HEAD + text.replace("%s", name)).encode()}, name, "image", "scene.pbrt"


def nanovdb(codec):
    """A NanoVDB file of two leaves and two tiles (the layout of version 32), plain or by zlib."""
    grid_at, tree_size, root_at = 672, 64, 736
    upper_at = root_at + 64 + 64
    lower_at = upper_at + 8256 + 32768 * 8
    leaf_at = lower_at + 1088 + 4096 * 8
    size = leaf_at + 2 * 2144
    g = bytearray(size)
    put = lambda at, form, *v: struct.pack_into("<" + form, g, at, *v)
    g[:8], g[40:47] = b"NanoVDB0", b"density"
    put(16, "I", 32 << 21 | 4 << 10), put(32, "Q", size)
    for i in range(3):
        put(384 + 32 * i, "d", 0.1), put(456 + 32 * i, "d", 10.0)
    put(560, "6d", -1, -1, -1, 1, 1, 1), put(632, "II", 2, 1), put(grid_at + 24, "Q", tree_size), put(root_at + 24, "I", 1)
    put(root_at + 64 + 8, "Q", upper_at - root_at), put(upper_at + 32 + 4096, "B", 1)
    put(upper_at + 8256, "Q", lower_at - upper_at), put(upper_at + 8256 + 8 * 1024, "f", 0.7)
    for k in range(2):
        put(lower_at + 32 + 512 + 32 * k, "B", 1)
        put(lower_at + 1088 + 8 * 256 * k, "Q", leaf_at - lower_at + 2144 * k)
        put(leaf_at + 2144 * k + 96, "512f", *[(n % 7) / 7 for n in range(512)])
    head = bytearray(16 + 176 + 8)
    head[:8], head[192:199] = b"NanoVDB0", b"density"
    body = bytes(g)
    if codec:
        body = zlib.compress(body)
        body = struct.pack("<Q", len(body)) + body
    struct.pack_into("<IHHQQ", head, 8, 32 << 21 | 4 << 10, 1, codec, size, len(body))
    struct.pack_into("<I", head, 16 + 136, 8)
    return bytes(head) + body


def measured():
    """A file of the RGL material database, of some smooth reflection: isotropic, four directions, five wavelengths."""
    n, thetas, waves = 8, 4, 5
    wave = lambda count: [1 + 0.5 * ((i * 7) % 11) / 11 for i in range(count)]
    floats = {"phi_i": ([1], [0.0]), "theta_i": ([thetas], [0.0, 0.5, 1.0, 1.5]), "ndf": ([n, n], wave(n * n)), "sigma": ([n, n], wave(n * n)),
              "vndf": ([1, thetas, n, n], wave(thetas * n * n)), "luminance": ([1, thetas, n, n], wave(thetas * n * n)),
              "spectra": ([1, thetas, waves, n, n], wave(thetas * waves * n * n)), "wavelengths": ([waves], [400.0, 475, 550, 625, 700])}
    fields = [(k, 10, shape, struct.pack("<%df" % len(v), *v)) for k, (shape, v) in floats.items()] + [("jacobian", 1, [1], b"\1")]
    at = 18 + sum(2 + len(k) + 2 + 1 + 8 + 8 * len(shape) for k, _, shape, _ in fields)
    head, body = b"tensor_file\0\1\0" + struct.pack("<I", len(fields)), b""
    for name, kind, shape, data in fields:
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", len(shape), kind, at + len(body))
        head += struct.pack("<%dQ" % len(shape), *shape)
        body += data
    return head + body


def tables():
    """What scenes name besides: spectra, lenses, NanoVDB grids."""
    spectrum = b"300 0.1\n400 0.5\n500 0.6\n# half way\n600 0.7\n700 0.2\n900 0.1\n"
    for use in ('Material "diffuse" "spectrum reflectance" "s.spd"\n', 'Material "conductor" "spectrum eta" "s.spd" "spectrum k" "s.spd"\n',
                'LightSource "point" "spectrum I" "s.spd"\n', 'Material "dielectric" "spectrum eta" "s.spd"\n'):
        yield "spectrum", {"s.spd": spectrum, "scene.pbrt": (HEAD + use + 'Shape "sphere"\n').encode()}, "s.spd", "plain", "scene.pbrt"
    cameras = os.path.join(ROOT, "scenes", "cameras")
    for lens in ("single_50mm.dat", "double_gauss_50mm.dat"):
        text = ('Camera "realistic" "string lensfile" "lens.dat" "float aperturediameter" 17 "float focusdistance" 0.63\n'
                'WorldBegin\nLightSource "infinite"\n' + SURFACE)
        yield lens, {"lens.dat": os.path.join(cameras, "lenses", lens), "scene.pbrt": text.encode()}, "lens.dat", "plain", "scene.pbrt"
    medium = (HEAD + 'MakeNamedMedium "m" "string type" "nanovdb" "string filename" "grid.nvdb"\nMediumInterface "m" ""\n'
              'Material "interface"\nShape "sphere"\n').encode()
    yield "measured", {"m.bsdf": measured(), "scene.pbrt": (HEAD + 'Material "measured" "string filename" "m.bsdf"\nShape "sphere"\n').encode()}, \
        "m.bsdf", "bytes", "scene.pbrt"
    for codec in (0, 1):
        yield "nanovdb_%d" % codec, {"grid.nvdb": nanovdb(codec), "scene.pbrt": medium}, "grid.nvdb", "bytes", "scene.pbrt"


def gltf_folders():
    folder = os.path.join(SHARED, "gltf")
    for name in names(folder, "."):
        for file in names(os.path.join(folder, name), r"\.(gltf|glb)$"):
            yield name, os.path.join(folder, name), file


def gltf():
    for name, folder, file in gltf_folders():
        files = {k: v for k, v in tree(folder).items() if not re.search(r"screenshot|\.md$", k)}
        if sum(os.path.getsize(v) for v in files.values()) < 2500000:
            yield name, files, file, "glb" if file.endswith("glb") else "json", file
    for file in names(os.path.join(CORPUS, "gltf"), "."):
        yield file, {file: os.path.join(CORPUS, "gltf", file)}, file, "glb" if file.endswith("glb") else "json", file


def gltf_parts():
    """Buffers and images beside a .gltf."""
    for name, folder, file in gltf_folders():
        files = {k: v for k, v in tree(folder).items() if not re.search(r"screenshot|\.md$", k)}
        for part in sorted(files):
            if not re.search(r"\.(gltf|glb)$", part) and sum(os.path.getsize(v) for v in files.values()) < 2500000:
                yield name + "_" + part, files, part, "bytes" if part.endswith(".bin") else "image", file


OBJ = b"""mtllib m.mtl
o one
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v 0 0 1 0.5 0.6 0.7
vt 0 0
vt 1 0
vt 1 1
vn 0 0 1
g a
s 1
usemtl red
f 1/1/1 2/2/1 3/3/1 4/1/1
f -1 -2 -3
usemtl glass
s off
f 1//1 2//1 5//1
f 1 2 \\
 5
p 1 2
l 1 2 3
"""
MTL = b"""newmtl red
Kd 0.8 0.1 0.1
Ks 0.5 0.5 0.5
Ns 50
Ke 0 0 0
illum 2
map_Kd -s 2 2 1 -o 0.5 0 0 -clamp on letters.png
map_Bump -bm 0.5 letters.png
map_d leaf.png
newmtl glass
Ni 1.5
d 0.2
illum 7
Tf 0.9 1 0.9
Pr 0.2
Pm 0
aniso 0.3
"""


def obj():
    textures = os.path.join(ROOT, "scenes", "features", "textures")
    files = {"m.obj": OBJ, "m.mtl": MTL, "letters.png": os.path.join(textures, "letters.png"), "leaf.png": os.path.join(textures, "leaf.png")}
    yield "obj", files, "m.obj", "plain", "m.obj"
    yield "mtl", files, "m.mtl", "plain", "m.obj"
    yield "packed", {"m.obj.gz": gzip.compress(OBJ, mtime=0), "m.mtl": MTL}, "m.obj.gz", "packed", "m.obj.gz"


def plain_meshes():
    for name in names(os.path.join(CORPUS, "mesh"), "."):
        form = "ply" if name.endswith(".ply") else "bytes" if name == "binary.stl" else "plain"
        yield name, {name: os.path.join(CORPUS, "mesh", name)}, name, form, name


def cameras():
    for name in names(os.path.join(CORPUS, "camera_file"), "."):
        form = "json" if re.search(r"\.(json|gltf)$", name) else "plain"
        name_here = {"colmap.txt": "cameras.txt", "colmap.bin": "cameras.bin"}.get(name, name)
        yield name, {name_here: os.path.join(CORPUS, "camera_file", name)}, name_here, form, name_here


POSES = {
    "poses.csv": b"# axes: opengl\nname,time,tx,ty,tz,qx,qy,qz,qw\na.png,0,0,0,4,0,0,0,1\nb.png,0.5,0.1,0,4,0,0,0,1\nc.png,1,0.2,0,4,0,0.1,0,0.99498743710662\n",
    "look.csv": b"eye_x;eye_y;eye_z;lookat_x;lookat_y;lookat_z;roll\n0;0;4;0;0;0;0\n1;0;4;0;0;0;10\n",
    "tum.txt": b"# timestamp tx ty tz qx qy qz qw\n0.0 0 0 -4 0 0 0 1\n0.1 0 0 -4.1 0 0 0 1\n",
    "kitti.txt": b"1 0 0 0 0 1 0 0 0 0 1 -4\n1 0 0 0.1 0 1 0 0 0 0 1 -4\n",
    "rows.csv": b"m00 m01 m02 m03 m10 m11 m12 m13 m20 m21 m22 m23\n1 0 0 0 0 1 0 0 0 0 1 -4\n",
}
COLMAP_CAMERAS = b"# id model w h ...\n1 OPENCV 640 480 500 500 320 240 0.1 0.01 0 0\n2 SIMPLE_RADIAL 640 480 500 320 240 0.1\n"
COLMAP_IMAGES = b"# two lines each\n1 1 0 0 0 0 0 4 1 a.png\n10 20 -1\n2 0.99 0.1 0 0 0.1 0 4 2 b.png\n\n"


def trajectories():
    scene = (HEAD + 'Shape "sphere"\n').encode()
    for name, data in POSES.items():
        yield name, {name: data, "scene.pbrt": scene}, name, "plain", name
    for name in ("nerf.json", "kalibr.yaml", "nodes.gltf"):
        yield name, {name: os.path.join(CORPUS, "camera_file", name), "scene.pbrt": scene}, name, "plain" if "yaml" in name else "json", name
    for part in ("cameras.txt", "images.txt"):
        yield "colmap_" + part, {"model/cameras.txt": COLMAP_CAMERAS, "model/images.txt": COLMAP_IMAGES, "scene.pbrt": scene}, \
            "model/" + part, "plain", "model"


def receipts(folder):
    """The same, of which the receipt is damaged, with their scene."""
    scene = tree(os.path.join(ROOT, "scenes", "features"))
    for name in names(folder, r"\.exr$"):
        yield name, {**scene, name: os.path.join(folder, name)}, name, "receipt", name


def own_images(folder):
    """Images that velo rendered itself (made in the folder before), with all their headers and channels."""
    for name in names(folder, r"\.exr$"):
        yield name, {name: os.path.join(folder, name)}, name, "bytes", name


FILMS = {"plain.film": ["--spp", "2"], "errors.film": ["--spp", "2", "--channels", "error"],
         "spectrum.film": ["--spp", "2", "--spectrum", "3"], "crop.film": ["--spp", "2", "--crop", "3,1,37,32"],
         "tiles.film": ["--spp", "2", "--shard", "1/2", "--shard-by", "tiles"]}
FILM_SCENE = (HEAD + 'Shape "sphere"\n').encode()


def films(folder):
    """Films that velo rendered itself (FILMS, made in the folder before), with a right one that belongs to them, and their scene."""
    for name in FILMS:
        files = {name: os.path.join(folder, name), "right.film": os.path.join(folder, "right_" + name), "scene.pbrt": FILM_SCENE}
        yield name, files, name, "film", name
