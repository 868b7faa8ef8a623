"""Prints the scene arches.pbrt: a portico in late sun (all.py)."""
import math
import random

from solids import (attribute, box, circle, grid, instance, lathe, leaves, patch, prism)

BAYS = 12
BAY = 4.0        # from column to column
HALF = 2.0       # half the width of the portico
RADIUS = 1.72    # of the arches
SPRING = 2.9     # where they spring
TOP = 5.6
THICK = 0.56     # of the wall with the arches

HEAD = """# A portico in late sun, one-point perspective: the eye's height is the horizon, all edges along the portico meet in one
# point. Written by make/arches.py.
Scale -1 1 1
LookAt 0.35 1.55 0.6   -0.25 1.8 -20   0 1 0
Camera "perspective" "float fov" 46
Sampler "zsobol" "integer pixelsamples" 128
Film "rgb" "string filename" "arches.exr" "integer xresolution" 1600 "integer yresolution" 900
WorldBegin
LightSource "infinite" "rgb L" [0.30 0.42 0.66]
# the sun: half a degree wide, as seen from here
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [150000 112000 68000]
  Translate -700 390 -600
  Shape "sphere" "float radius" 4.6
AttributeEnd

Texture "plaster grain" "float" "fbm" "integer octaves" 6
Texture "plaster" "spectrum" "mix" "rgb tex1" [0.74 0.55 0.36] "rgb tex2" [0.62 0.43 0.26] "texture amount" "plaster grain"
Texture "tiles" "spectrum" "checkerboard" "float uscale" 6 "float vscale" 72 "rgb tex1" [0.50 0.44 0.37] "rgb tex2" [0.22 0.12 0.09]
MakeNamedMaterial "plaster" "string type" "diffuse" "texture reflectance" "plaster"
MakeNamedMaterial "vault" "string type" "diffuse" "rgb reflectance" [0.80 0.74 0.64]
MakeNamedMaterial "stone" "string type" "diffuse" "rgb reflectance" [0.64 0.58 0.50]
MakeNamedMaterial "floor" "string type" "coateddiffuse" "texture reflectance" "tiles" "float roughness" 0.14
MakeNamedMaterial "paving" "string type" "diffuse" "rgb reflectance" [0.42 0.39 0.35]
MakeNamedMaterial "wood" "string type" "coateddiffuse" "rgb reflectance" [0.10 0.05 0.028] "float roughness" 0.3
MakeNamedMaterial "iron" "string type" "conductor" "rgb reflectance" [0.08 0.08 0.085] "float roughness" 0.4
MakeNamedMaterial "clay" "string type" "diffuse" "rgb reflectance" [0.48 0.20 0.11]
MakeNamedMaterial "leaf" "string type" "diffusetransmission" "rgb reflectance" [0.09 0.16 0.04] "rgb transmittance" [0.10 0.16 0.03]
MakeNamedMaterial "far house" "string type" "diffuse" "rgb reflectance" [0.60 0.38 0.26]
MakeNamedMaterial "roof" "string type" "diffuse" "rgb reflectance" [0.40 0.17 0.10]
MakeNamedMaterial "dark" "string type" "diffuse" "rgb reflectance" [0.05 0.05 0.055]

"""


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def vault(s: float, t: float) -> tuple[float, float, float]:
    """A groin vault: the higher of two barrels that cross."""
    x, z = (2.0 * s - 1.0) * HALF, (2.0 * t - 1.0) * HALF
    ends = HALF - 0.02
    rise = max(math.sqrt(max(ends * ends - x * x, 0.0)), math.sqrt(max(ends * ends - z * z, 0.0)))
    return (x, SPRING + 0.06 + 0.94 * rise, z)


def arch(depth: float) -> str:
    """The wall above two columns with an arch in it, in the plane z = 0 of its own, depth thick."""
    count = 24
    opening = [(RADIUS * math.cos(math.pi * i / count), SPRING + RADIUS * math.sin(math.pi * i / count))
               for i in range(count + 1)]
    edge = []
    for x, y in opening:
        k = min(HALF / abs(x) if x else math.inf, (TOP - SPRING) / (y - SPRING) if y > SPRING else math.inf)
        edge.append((x * k, SPRING + (y - SPRING) * k))
    parts = ""
    for i in range(count):
        piece = [opening[i], edge[i], edge[i + 1], opening[i + 1]]
        corner = (math.copysign(HALF, edge[i][0]), TOP)
        if edge[i][1] < TOP - 1e-9 < edge[i + 1][1] or edge[i + 1][1] < TOP - 1e-9 < edge[i][1]:
            piece = [opening[i], edge[i], corner, edge[i + 1], opening[i + 1]]
        parts += prism(piece, -0.5 * depth, 0.5 * depth)
    return parts


COLUMN = [(0.34, 0.0), (0.34, 0.12), (0.30, 0.14), (0.33, 0.19), (0.30, 0.25), (0.245, 0.28), (0.235, 0.6), (0.205, 2.42),
          (0.235, 2.44), (0.235, 2.49), (0.205, 2.51), (0.22, 2.56), (0.30, 2.68), (0.30, 2.72)]
POT = [(0.0, 0.0), (0.2, 0.0), (0.27, 0.4), (0.31, 0.41), (0.31, 0.48), (0.27, 0.48), (0.25, 0.42), (0.0, 0.42)]


def objects() -> str:
    column = attribute(lathe(COLUMN, 40) + box((-0.33, 2.72, -0.33), (0.33, 2.9, 0.33)), material("stone"))
    bay = attribute(grid(vault, 40, 40), material("vault"))
    wall = attribute(arch(THICK), material("plaster"), "Rotate 90 0 1 0")
    across = attribute(arch(0.3), material("stone"))
    door = attribute(box((-0.75, 0, -0.05), (0.75, 2.5, 0.05)), material("wood"))
    for x in (-0.55, -0.02, 0.51):
        for y, high in ((0.15, 0.9), (1.05, 2.35)):
            door += attribute(box((x + 0.02 if x < 0 else x - 0.45, y, 0.05), (x + 0.47 if x < 0 else x, high, 0.075)),
                              material("wood")) if x != -0.02 else ""
    frame = (box((-0.95, 0, -0.05), (-0.75, 2.7, 0.12)) + box((0.75, 0, -0.05), (0.95, 2.7, 0.12)) +
             box((-0.95, 2.5, -0.05), (0.95, 2.72, 0.12)) + box((-1.05, 2.72, -0.05), (1.05, 2.82, 0.2)))
    door += attribute(frame, material("stone"))
    bars = "".join(box((x - 0.008, 0, z - 0.008), (x + 0.008, 0.42, z + 0.008)) for x in (-0.13, 0.13) for z in (-0.13, 0.13))
    lantern = attribute(bars + box((-0.15, -0.03, -0.15), (0.15, 0, 0.15)) + box((-0.17, 0.42, -0.17), (0.17, 0.45, 0.17)) +
                        box((-0.008, 0.45, -0.008), (0.008, 1.6, 0.008)), material("iron"))
    lantern += attribute('Translate 0 0.2 0\nShape "sphere" "float radius" 0.07\n',
                         'AreaLightSource "diffuse" "rgb L" [30 17 7]')
    rule = random.Random(4)
    plant = attribute(lathe(POT, 32), material("clay")) + attribute(box((-0.03, 0.4, -0.03), (0.03, 1.0, 0.03)), material("wood"))
    plant += attribute(leaves(rule, 900, 0.42, 0.075), material("leaf"), "Translate 0 1.2 0")
    text = ""
    for name, body in (("column", column), ("bay", bay), ("wall", wall), ("across", across), ("door", door), ("plant", plant)):
        text += f'ObjectBegin "{name}"\n{body}ObjectEnd\n'
    return text, lantern


def house(rule: random.Random, z: float, wide: float, high: float) -> str:
    """A house on the far side of the square, its front to the portico."""
    x = -34.0
    text = attribute(box((x - 10, 0, z), (x, high, z + wide)), material("far house"))
    text += attribute(box((x - 10, high, z - 0.3), (x + 0.5, high + 0.3, z + wide + 0.3)), material("roof"))
    windows = ""
    floors = int(high // 3.2)
    for k in range(int(wide // 2.6)):
        for level in range(floors):
            y = 1.0 + 3.2 * level
            windows += box((x - 0.05, y, z + 0.9 + 2.6 * k), (x + 0.02, y + 1.7, z + 1.9 + 2.6 * k))
    return text + attribute(windows, material("dark"))


def main() -> None:
    text, lantern = objects()
    text = HEAD + text
    for i in range(-1, BAYS):
        z = -BAY * i
        for name, x in (("bay", 0.0), ("wall", -HALF - 0.5 * THICK + 0.28)):
            text += instance(name, f"Translate {x:.3f} 0 {z - 0.5 * BAY:.3f}")
        text += instance("across", f"Translate 0 0 {z:.3f}")
        text += instance("column", f"Translate {-HALF:.3f} 0 {z:.3f}")
        text += attribute(box((HALF - 0.26, 0, z - 0.26), (HALF + 0.1, SPRING, z + 0.26)), material("stone"))
        if i % 2 == 1:
            text += instance("door", f"Translate {HALF:.3f} 0 {z - 0.5 * BAY:.3f}", "Rotate -90 0 1 0")
        elif i > 0:
            text += instance("plant", f"Translate {HALF - 0.5:.3f} 0 {z - 0.5 * BAY:.3f}", f"Rotate {37 * i} 0 1 0")
        if i % 3 == 1:
            text += attribute(lantern, f"Translate 0 3.05 {z - 0.5 * BAY:.3f}")
    end = -BAY * BAYS
    text += attribute(patch((HALF, 0, 8), (HALF, 0, end), (HALF, TOP, 8), (HALF, TOP, end)), material("plaster"))
    text += attribute(patch((-HALF - 0.4, TOP, 8), (HALF, TOP, 8), (-HALF - 0.4, TOP, end), (HALF, TOP, end)), material("stone"))
    text += attribute(patch((-HALF - 0.4, 0, 8), (HALF, 0, 8), (-HALF - 0.4, 0, end), (HALF, 0, end)), material("floor"))
    text += attribute(patch((HALF, 0, end), (-HALF, 0, end), (HALF, TOP, end), (-HALF, TOP, end)), material("plaster"))
    text += attribute(box((-HALF - 0.55, -0.2, end), (-HALF - 0.4, 0.0, 8)), material("stone"))
    text += attribute(patch((-80, -0.17, 40), (-HALF, -0.17, 40), (-80, -0.17, -120), (-HALF, -0.17, -120)), material("paving"))
    rule = random.Random(7)
    z = 20.0
    while z > -110.0:
        wide, high = rule.uniform(9, 16), rule.uniform(7, 10.5)
        z -= wide
        text += house(rule, z, wide - 0.2, high)
    print(text, end="")


main()
