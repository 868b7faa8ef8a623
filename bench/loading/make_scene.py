#!/usr/bin/env python3
"""A large scene for measuring how fast scenes load: 800 binary PLY files (positions, normals, uv) of 3.5 million
triangles in all, 86 materials.  usage: make_scene.py FOLDER [files] [triangles]"""
import math
import os
import struct
import sys
from array import array


def write_ply(path, seed, n):
    """A bumpy sheet rolled to a tube: n x n quads, two triangles each."""
    rows = []
    for j in range(n + 1):
        for i in range(n + 1):
            u, v = i / n, j / n
            a, r = 2 * math.pi * u, 0.4 + 0.05 * math.sin(7 * v + seed) * math.cos(9 * u)
            rows += [r * math.cos(a), v, r * math.sin(a), math.cos(a), 0.0, math.sin(a), u, v]
    faces = bytearray()
    for j in range(n):
        for i in range(n):
            k = j * (n + 1) + i
            faces += struct.pack("<B3iB3i", 3, k, k + 1, k + n + 2, 3, k, k + n + 2, k + n + 1)
    with open(path, "wb") as f:
        f.write(
            (
                "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % ((n + 1) ** 2)
                + "".join("property float %s\n" % p for p in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
                + "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (2 * n * n)
            ).encode()
        )
        f.write(array("f", rows).tobytes())
        f.write(faces)


def main():
    folder = sys.argv[1]
    files = int(sys.argv[2]) if len(sys.argv) > 2 else 800
    triangles = int(sys.argv[3]) if len(sys.argv) > 3 else 3500000
    n = round(math.sqrt(triangles / files / 2))
    os.makedirs(os.path.join(folder, "models"), exist_ok=True)
    with open(os.path.join(folder, "scene.pbrt"), "w") as f:
        f.write('LookAt 15 20 -30  15 0 14  0 1 0\nCamera "perspective" "float fov" 50\n')
        f.write('Film "rgb" "integer xresolution" 640 "integer yresolution" 360\nSampler "zsobol" "integer pixelsamples" 1\n')
        f.write('WorldBegin\nLightSource "infinite"\n')
        for m in range(86):
            f.write('MakeNamedMaterial "m%d" "string type" "diffuse" "rgb reflectance" [%.3f 0.5 0.4]\n' % (m, m / 90))
        for k in range(files):
            name = "models/mesh%04d.ply" % k
            write_ply(os.path.join(folder, name), k, n)
            f.write(
                'AttributeBegin NamedMaterial "m%d" Translate %d 0 %d Shape "plymesh" "string filename" "%s" AttributeEnd\n'
                % (k % 86, k % 32, k // 32, name)
            )


main()
