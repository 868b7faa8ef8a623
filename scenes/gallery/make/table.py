"""Prints the scene table.pbrt: a set table by a window (all.py).
The unit is a decimetre."""
import math
import random

from solids import attribute, box, grid, lathe, mesh, number, patch

HEAD = """# A set table by a window in the morning: a carafe and tumblers with water, lemons in a bowl, linen, a branch of olive.
# Glass, water and air meet in three kinds of surfaces, each with the ratio of its two indices. Written by make/table.py.
Scale -1 1 1
LookAt 0.6 4.6 14.5   -0.1 1.15 0   0 1 0
Camera "perspective" "float fov" 25 "float lensradius" 0.11 "float focaldistance" 14.6
Sampler "zsobol" "integer pixelsamples" 512
Integrator "path" "integer maxdepth" 20 "bool regularize" true
Film "rgb" "float maxcomponentvalue" 8 "string filename" "table.exr" "integer xresolution" 1600 "integer yresolution" 900
WorldBegin
# the sky, through the window
LightSource "infinite" "rgb L" [6.5 8 10.5] "point3 portal" [-9 0.6 4.4  -9 0.6 -5.6  -9 13 -5.6  -9 13 4.4]
AttributeBegin # the sun
  AreaLightSource "diffuse" "rgb L" [30000 23500 16000]
  Translate -720 420 250
  Shape "sphere" "float radius" 9
AttributeEnd
Texture "grain" "float" "wrinkled" "integer octaves" 6
Texture "wood" "spectrum" "mix" "rgb tex1" [0.40 0.235 0.125] "rgb tex2" [0.25 0.135 0.07] "texture amount" "grain"
MakeNamedMaterial "wall" "string type" "diffuse" "rgb reflectance" [0.50 0.52 0.47]
MakeNamedMaterial "frame" "string type" "coateddiffuse" "rgb reflectance" [0.70 0.69 0.66] "float roughness" 0.3
MakeNamedMaterial "wood" "string type" "coateddiffuse" "texture reflectance" "wood" "float roughness" 0.22
MakeNamedMaterial "linen" "string type" "diffusetransmission" "rgb reflectance" [0.58 0.55 0.49] "rgb transmittance" [0.16 0.15 0.13]
MakeNamedMaterial "porcelain" "string type" "coateddiffuse" "rgb reflectance" [0.78 0.77 0.73] "float roughness" 0.03
MakeNamedMaterial "blue" "string type" "coateddiffuse" "rgb reflectance" [0.05 0.12 0.30] "float roughness" 0.05
MakeNamedMaterial "lemon" "string type" "coateddiffuse" "rgb reflectance" [0.83 0.58 0.035] "float roughness" 0.22
MakeNamedMaterial "leaf" "string type" "diffusetransmission" "rgb reflectance" [0.16 0.22 0.10] "rgb transmittance" [0.10 0.15 0.04]
MakeNamedMaterial "bark" "string type" "diffuse" "rgb reflectance" [0.14 0.10 0.07]
MakeNamedMaterial "glass" "string type" "dielectric" "float eta" 1.5
MakeNamedMaterial "glass in water" "string type" "dielectric" "float eta" 1.128
MakeNamedMaterial "water" "string type" "dielectric" "float eta" 1.333

"""


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def smooth(corners: list[tuple[float, float]], steps: int = 6) -> list[tuple[float, float]]:
    """A curve through the corners (Catmull and Rom)."""
    points = []
    padded = [corners[0]] + corners + [corners[-1]]
    for p0, p1, p2, p3 in zip(padded, padded[1:], padded[2:], padded[3:]):
        for k in range(steps):
            t = k / steps
            points.append(tuple(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t ** 3)
                                for a, b, c, d in zip(p0, p1, p2, p3)))
    return points + [corners[-1]]


def vessel(outer: list[tuple[float, float]], inner: list[tuple[float, float]], level: float, *before: str) -> str:
    """Glass with water up to a level. outer runs from the axis below to the rim, inner from the axis to the rim."""
    rim = [(0.5 * (outer[-1][0] + inner[-1][0]), max(outer[-1][1], inner[-1][1]) + 0.02)]
    dry = [p for p in inner if p[1] > level]
    wet = [p for p in inner if p[1] <= level]
    a, b = wet[-1], dry[0]
    edge = (a[0] + (b[0] - a[0]) * (level - a[1]) / (b[1] - a[1]), level)
    text = attribute(lathe(outer + rim + dry[::-1] + [edge], 56), *before, material("glass"))
    text += attribute(lathe([edge] + wet[::-1], 56), *before, material("glass in water"))
    # the water climbs a little at the wall
    top = [(0.0, level - 0.03)] + [(edge[0] * s, level - 0.03 + 0.03 * s ** 14) for s in (0.5, 0.8, 0.9, 0.96, 1.0)]
    return text + attribute(lathe(top[::-1], 56), *before, material("water"))


def carafe() -> str:
    outer = smooth([(0.0, 0.0), (0.72, 0.0), (0.92, 0.12), (1.0, 0.6), (0.96, 1.2), (0.62, 1.95), (0.42, 2.5), (0.44, 2.9), (0.56, 3.25)], 7)
    inner = smooth([(0.0, 0.16), (0.7, 0.18), (0.86, 0.3), (0.93, 0.62), (0.89, 1.17), (0.56, 1.92), (0.36, 2.5), (0.385, 2.9), (0.51, 3.24)], 7)
    return vessel(outer, inner, 1.62, "Translate -1.35 0.004 -0.4")


def tumbler(x: float, z: float, level: float) -> str:
    outer = [(0.0, 0.0), (0.44, 0.0), (0.47, 0.04), (0.57, 1.3)]
    inner = [(0.0, 0.13), (0.38, 0.14), (0.42, 0.19), (0.44, 0.4), (0.47, 0.7), (0.5, 1.0), (0.525, 1.29)]
    return vessel(outer, inner, level, f"Translate {x} 0.004 {z}")


def lemon(x: float, y: float, z: float, turn: float, lean: float) -> str:
    profile = smooth([(0.0, -0.56), (0.06, -0.55), (0.1, -0.48), (0.3, -0.33), (0.39, -0.02), (0.32, 0.29), (0.13, 0.44), (0.08, 0.52), (0.0, 0.54)], 4)
    return attribute(lathe(profile, 40), f"Translate {x} {y} {z}", f"Rotate {turn} 0 1 0", f"Rotate {lean} 0 0 1", material("lemon"))


def linen(s: float, t: float) -> tuple[float, float, float]:
    """A cloth with soft folds; its far end hangs over the table's edge."""
    x, z = 3.0 * (s - 0.5), 5.2 * (t - 0.5)
    fold = 0.07 * math.sin(5.1 * x + 0.7 * z) + 0.05 * math.sin(2.3 * x - 1.7 * z + 1.0) + 0.03 * math.sin(7.0 * z + 2.0 * x)
    y = 0.025 + 0.55 * max(fold + 0.03, 0.0)
    over = z - 1.45
    if over > 0.0:
        bend = min(over / 0.25, 1.0) * math.pi / 2.0
        y -= 0.16 * (1.0 - math.cos(bend)) + max(over - 0.25, 0.0)
        z = 1.45 + 0.16 * math.sin(bend) + 0.12 * max(fold, 0.0) * min(over, 1.0)
    return (x, y, z)


def branch(rule: random.Random) -> str:
    """Twigs with pairs of narrow leaves."""
    stems, points, indices = "", [], []
    for _ in range(6):
        lean, turn, length = rule.uniform(0.25, 0.95), rule.uniform(0, 2 * math.pi), rule.uniform(2.3, 3.5)
        way = []
        for k in range(13):
            t = k / 12
            bend = lean * (0.3 + t * 1.1)
            way.append((length * t * math.sin(bend) * math.cos(turn), 0.3 + length * t * math.cos(bend), length * t * math.sin(bend) * math.sin(turn)))
        for a, b in zip(way, way[1:]):
            third = [tuple(p + (q - p) * f for p, q in zip(a, b)) for f in (0, 1 / 3, 2 / 3, 1)]
            text = " ".join(number(v) for p in third for v in p)
            stems += f'Shape "curve" "string type" "cylinder" "point3 P" [{text}] "float width" 0.045\n'
        for k in range(5, 13):
            for side in (0.0, math.pi):
                p = way[k]
                a = turn + k * 1.6 + side
                along = (math.cos(a) * 0.9, rule.uniform(-0.2, 0.7), math.sin(a) * 0.75)
                size = rule.uniform(0.45, 0.75)
                along = [size * v / math.sqrt(sum(w * w for w in along)) for v in along]
                across = [-0.13 * math.sin(a), rule.uniform(-0.03, 0.03), 0.13 * math.cos(a)]
                first = len(points)
                for f, w in ((0.0, 0.12), (0.3, 0.8), (0.62, 0.85), (1.0, 0.05)):
                    for sign in (-1, 1):
                        drop = -0.12 * f * f
                        points.append(tuple(p[i] + f * along[i] + sign * w * across[i] + (drop if i == 1 else 0.0) for i in range(3)))
                for r in range(3):
                    b = first + 2 * r
                    indices += [(b, b + 1, b + 3), (b, b + 3, b + 2)]
    return stems, mesh(points, indices)


def window() -> str:
    """The left wall with an opening of six panes."""
    wall = box((-9.4, -9, 4.4), (-8.6, 22, 30)) + box((-9.4, -9, -30), (-8.6, 22, -5.6))
    wall += box((-9.4, -9, -5.6), (-8.6, 0.6, 4.4)) + box((-9.4, 13, -5.6), (-8.6, 22, 4.4))
    bars = "".join(box((-9.2, 0.6, z - 0.13), (-8.9, 13, z + 0.13)) for z in (-2.2, 1.0))
    bars += "".join(box((-9.2, y - 0.1, -5.6), (-8.9, y + 0.1, 4.4)) for y in (4.7, 8.8))
    bars += box((-9.2, 0.6, -5.6), (-8.4, 0.75, 4.4)) + box((-9.2, 0.6, 4.2), (-8.8, 13, 4.4)) + box((-9.2, 0.6, -5.6), (-8.8, 13, -5.4))
    return attribute(wall, material("wall")) + attribute(bars, material("frame"))


def main() -> None:
    text = HEAD + window()
    text += attribute(patch((-9, -9, -7), (20, -9, -7), (-9, 22, -7), (20, 22, -7)), material("wall"))
    for a, b, c, d in (((20, -9, -7), (20, -9, 30), (20, 22, -7), (20, 22, 30)), ((-9, -9, 30), (20, -9, 30), (-9, 22, 30), (20, 22, 30)),
                       ((-9, 22, -7), (20, 22, -7), (-9, 22, 30), (20, 22, 30)), ((-9, -9, -7), (20, -9, -7), (-9, -9, 30), (20, -9, 30))):
        text += attribute(patch(a, b, c, d), material("wall"))
    text += attribute(box((-7.5, -0.5, -4.2), (7.5, 0.0, 3.6)), material("wood"))
    text += carafe() + tumbler(0.35, 0.7, 0.85) + tumbler(1.75, -0.75, 0.6)
    bowl = smooth([(0.0, 0.08), (0.5, 0.0), (0.55, 0.1), (1.0, 0.35), (1.42, 0.86), (1.47, 1.0), (1.4, 0.99), (1.33, 0.86), (0.92, 0.44), (0.4, 0.22), (0.0, 0.18)], 5)
    text += attribute(lathe(bowl, 60), "Translate 3.45 0.004 -0.3", material("porcelain"))
    for x, y, z, turn, lean in ((3.1, 0.78, -0.55, 30, 82), (3.85, 0.8, -0.6, 110, 78), (3.45, 0.82, 0.2, 200, 84), (3.5, 1.33, -0.3, 75, 70),
                                (1.35, 0.4, 1.75, 160, 88)):
        text += lemon(x, y, z, turn, lean)
    text += attribute(grid(linen, 44, 70), "Translate -3.9 0 1.2", "Rotate 9 0 1 0", material("linen"))
    plate = smooth([(0.0, 0.05), (0.85, 0.04), (0.95, 0.1), (1.5, 0.22), (1.52, 0.26), (1.46, 0.27), (0.98, 0.16), (0.85, 0.11), (0.0, 0.11)], 5)
    text += attribute(lathe(plate, 60), "Translate -3.9 0.09 1.1", material("porcelain"))
    text += attribute(lathe([(1.3, 0.232), (1.38, 0.25)], 60), "Translate -3.9 0.095 1.1", material("blue"))
    vase = smooth([(0.0, 0.02), (0.5, 0.0), (0.75, 0.35), (0.8, 0.75), (0.5, 1.4), (0.3, 1.8), (0.34, 2.1), (0.3, 2.1), (0.26, 1.8), (0.4, 1.4), (0.0, 0.4)], 5)
    text += attribute(lathe(vase, 64), "Translate 0.6 0.004 -2.6", material("blue"))
    stems, leaves = branch(random.Random(5))
    text += attribute(stems, "Translate 0.6 1.4 -2.6", material("bark")) + attribute(leaves, "Translate 0.6 1.4 -2.6", material("leaf"))
    print(text, end="")


main()
