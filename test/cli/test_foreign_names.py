#!/usr/bin/python3
"""No message repeats more than 12 characters of what stands in a file. In small files of every format each word is
replaced in turn by a long one with control characters around it; no output of velo may hold 13 of its characters, or a
control character. Names of files are excepted: who has to find a missing file needs its name."""
import os
import re
import subprocess
import sys
import tempfile

VELO, SOURCE = os.environ["VELO"], os.environ["VELO_SOURCE_DIR"]
CORPUS = os.path.join(SOURCE, "test/fuzz/corpus")
MARK = "Zq7Xk9WvjH3MplT5rNb8YfGd2SaQeUo4"  # no part of 13 characters stands in any message
WORD = re.compile(rb"[A-Za-z_][\w.:-]*|-?\d[\w.+-]*")
FILE_NAME = re.compile(rb"\.(ply|png|exr|jpe?g|hdr|pfm|tga|bin|pbrt|mtl|spd|bsdf|nvdb|txt|dat|webp|glb)\b", re.I)

PBRT = b'''
Option "seed" 3
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Sampler "halton" "integer pixelsamples" 1
Integrator "path" "integer maxdepth" 2
PixelFilter "box" "float xradius" 0.5
ColorSpace "srgb"
CoordinateSystem "there"
CoordSysTransform "there"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [1 1 1] "string preset" "Skin1"
WorldBegin
Attribute "shape" "float alpha" 1
Texture "grey" "spectrum" "constant" "rgb value" [1 1 1]
Texture "checks" "float" "checkerboard" "texture tex1" "grey" "string mapping" "uv"
MakeNamedMaterial "wall" "string type" "diffuse" "texture reflectance" "grey"
MakeNamedMaterial "two" "string type" "mix" "string materials" ["wall" "wall"]
NamedMaterial "wall"
Material "conductor" "spectrum eta" "metal-Cu-eta" "bool remaproughness" true
MediumInterface "fog" ""
LightSource "point" "rgb I" [1 1 1]
AreaLightSource "diffuse" "blackbody L" 5000
ObjectBegin "thing"
Shape "sphere" "float radius" 1
ObjectEnd
ObjectInstance "thing"
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
'''
OBJ = b"mtllib a.mtl\no thing\ng part\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\ns off\n"
MTL = b"newmtl paint\nKd 0.5 0.5 0.5\nNs 10\nillum 2\nmap_Kd -bm 1 a.png\n"
PLY = (b"ply\nformat ascii 1.0\ncomment thing\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
       b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
CSV = b"# axes opencv\nframe,name,eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z\n0,first,0,0,5,0,0,0\n"
LENS = b"# lens\n35.98738 1.21638 1.54 23.716\n11.69718 9.9957 1 17.996\n"

failures = runs = 0


def variants(data):
    """The data with each word replaced, in turn. Words of binary parts and of names of files stay."""
    for word in WORD.finditer(data):
        start = max(data.rfind(b"\n", 0, word.start()), data.rfind(b'"', 0, word.start())) + 1
        ends = [e for e in (data.find(b"\n", word.end()), data.find(b'"', word.end())) if e >= 0]
        text = data[start:min(ends) if ends else len(data)]
        if not FILE_NAME.search(text):
            yield data[:word.start()] + b"\x1b[7m" + MARK.encode() + b"\x07" + data[word.end():]
            yield data[:word.start()] + MARK.encode() + data[word.end():]


def check(command, name, data):
    global failures, runs
    runs += 1
    done = subprocess.run([VELO, *command], stdin=subprocess.DEVNULL, capture_output=True, timeout=60)
    said = done.stderr.decode(errors="replace")
    parts = [MARK[i:i + 13] for i in range(len(MARK) - 12)]
    bad = [c for c in said if ord(c) < 32 and c != "\n"] or [p for p in parts if p in said]
    if bad or done.returncode not in (0, 2, 3, 4, 5):
        failures += 1
        if failures <= 10:
            print("not ok %s: exit code %d: %s" % (name, done.returncode, said.strip()[:400]))
            if "SAVE" in os.environ:
                open("%s/%d-%s" % (os.environ["SAVE"], failures, name), "wb").write(data)


def try_all(name, data, command, other=(), step=1):
    """command: a function of the file's path. other: files beside it, as pairs of name and data."""
    global failures
    before, count = failures, runs
    for index, changed in enumerate(variants(data)):
        if index % step:
            continue
        for other_name, other_data in other:
            open(other_name, "wb").write(other_data)
        open(name, "wb").write(changed)
        check(command(name), name, changed)
    if runs == count:
        failures += 1
        print("not ok %s: nothing was tried" % name)
    elif failures == before:
        print("ok foreign_names_%s" % name.replace(".", "_"))


def corpus(path):
    return open(os.path.join(CORPUS, path), "rb").read()


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    scene = lambda path: ["render", path, "--resolution", "8x8", "--spp", "1", "-o", "x.exr"]
    doctor = lambda path: ["scene", "check", path]
    camera = lambda path: ["camera", "info", path]
    step = 1 if "EVERY" in os.environ else 6
    try_all("scene.pbrt", PBRT, doctor, step=step)
    try_all("drawn.pbrt", PBRT, scene, step=step)
    try_all("model.obj", OBJ, scene, [("a.mtl", MTL)], step=step)
    try_all("a.mtl", MTL, lambda path: scene("model.obj"), [("model.obj", OBJ)])
    try_all("mesh.ply", PLY, scene)
    try_all("model.gltf", corpus("gltf/all.gltf"), doctor, step=2 * step)
    open("plain.pbrt", "wb").write(b"Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n")
    try_all("way.csv", CSV, lambda path: ["render", "plain.pbrt", "--trajectory", path, "--spp", "1", "-o", "%d.exr"])
    lens_scene = b'Camera "realistic" "string lensfile" "lens.dat"\nWorldBegin\n'
    try_all("lens.dat", LENS, lambda path: doctor("lens.pbrt"), [("lens.pbrt", lens_scene)])
    for name in sorted(os.listdir(os.path.join(CORPUS, "camera_file"))):
        if not name.endswith(".bin"):  # these have no words but names of files
            try_all(name, corpus("camera_file/" + name), camera, step=step)
print("%d runs" % runs)
sys.exit(failures > 0)
