#!/usr/bin/python3
"""Writes a classroom of 500,000 triangles: a room with windows, lamps, and desks with smooth busts on them. Usage:
classroom.py FOLDER. The scene is FOLDER/classroom.pbrt. It is slow in the ways interiors are: light comes through
windows and from many lamps, and paths are long."""
import array
import math
import os
import sys

COLUMNS, ROWS = 5, 5
RINGS, SIDES = 100, 100  # of a bust: 2 * RINGS * SIDES triangles

HEAD = """LookAt 0.6 1.7 8.4  0.2 1.0 0  0 1 0
Camera "perspective" "float fov" 55
Film "rgb" "integer xresolution" 1280 "integer yresolution" 720
Sampler "zsobol" "integer pixelsamples" 64
Integrator "volpath" "integer maxdepth" 12
WorldBegin
AttributeBegin
  Rotate -90 1 0 0
  LightSource "infinite" "rgb L" [2.2 2.6 3.2]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.72 0.70 0.66]
"""


def box(low, high):
    """A box of 12 triangles."""
    (a, b, c), (d, e, f) = low, high
    points = [(x, y, z) for z in (c, f) for y in (b, e) for x in (a, d)]
    faces = [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5]
    return ('Shape "trianglemesh" "point3 P" [%s] "integer indices" [%s]\n' %
            (" ".join(f"{v:g}" for p in points for v in p), " ".join(map(str, faces))))


def bust(path, seed):
    """A closed surface with folds, as a binary PLY file."""
    floats, ints = array.array("f"), []
    for i in range(RINGS + 1):
        t = math.pi * i / RINGS
        for k in range(SIDES):
            p = 2 * math.pi * k / SIDES
            r = 0.16 + 0.02 * math.sin(5 * p + seed) * math.sin(3 * t) + 0.006 * math.sin(23 * t + 11 * p + seed)
            floats.extend((r * math.sin(t) * math.cos(p), 0.19 - 1.2 * r * math.cos(t), r * math.sin(t) * math.sin(p)))
    for i in range(RINGS):
        for k in range(SIDES):
            a, b = i * SIDES + k, i * SIDES + (k + 1) % SIDES
            ints += [(a, a + SIDES, b), (b, a + SIDES, b + SIDES)]
    with open(path, "wb") as out:
        out.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(floats) // 3}\nproperty float x\nproperty float y\n"
                  f"property float z\nelement face {len(ints)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        out.write(floats.tobytes())
        out.write(b"".join(b"\x03" + array.array("i", face).tobytes() for face in ints))
    return len(ints)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder, count = sys.argv[1], 0
    os.makedirs(folder, exist_ok=True)
    scene = [HEAD]
    scene += [box((-5, -0.1, -5), (5, 0, 9)), box((-5, 3.2, -5), (5, 3.3, 9)), box((-5, 0, -5.1), (5, 3.2, -5)),
              box((-5, 0, 9), (5, 3.2, 9.1)), box((5, 0, -5), (5.1, 3.2, 9))]
    for z in range(-5, 9, 2):  # the wall of the windows: pillars, and what is below and above
        scene.append(box((-5.2, 0, z), (-5, 3.2, z + 0.7)))
    scene += [box((-5.2, 0, -5), (-5, 0.9, 9)), box((-5.2, 2.7, -5), (-5, 3.2, 9))]
    for x in (-2.5, 0, 2.5):
        for z in (-3, 0, 3, 6):
            scene.append('AttributeBegin\nAreaLightSource "diffuse" "rgb L" [6 5.4 4.6]\n' +
                         box((x - 0.6, 3.05, z - 0.08), (x + 0.6, 3.1, z + 0.08)) + "AttributeEnd\n")
    for i in range(COLUMNS):
        for k in range(ROWS):
            x, z, seed = 1.8 * (i - (COLUMNS - 1) / 2), 1.9 * k - 3.2, COLUMNS * k + i
            name = f"bust{seed}.ply"
            count += bust(os.path.join(folder, name), seed)
            kind = ('"coateddiffuse" "float roughness" 0.1', '"diffuse"')[seed % 2]
            scene.append('Material "diffuse" "rgb reflectance" [0.42 0.27 0.15]\n')
            scene.append(box((x - 0.65, 0.70, z - 0.4), (x + 0.65, 0.74, z + 0.4)))
            for dx in (-0.6, 0.56):
                scene.append(box((x + dx, 0, z - 0.35), (x + dx + 0.04, 0.70, z + 0.35)))
            scene.append(f'AttributeBegin\nMaterial {kind} "rgb reflectance" [{0.3 + 0.02 * seed:g} 0.5 {0.8 - 0.02 * seed:g}]\n'
                         f'Translate {x:g} 0.74 {z:g}\nShape "plymesh" "string filename" "{name}"\nAttributeEnd\n')
    with open(os.path.join(folder, "classroom.pbrt"), "w") as out:
        out.write("".join(scene))
    print(f"{os.path.join(folder, 'classroom.pbrt')}: {count} triangles of busts")


main()
