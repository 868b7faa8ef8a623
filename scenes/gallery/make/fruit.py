"""Prints parts/fruit.pbrt: grapes in a bowl of lacquer, peaches with their fuzz, pearls, a vase and velvet, the world of
fruit.pbrt (all.py). The unit is a decimetre; the eye is on the side of +z."""
import math
import random

from solids import attribute, grid, lathe, number, patch

HEAD = """# Fruit as painters laid it out: grapes that light enters, peaches with hairs, a bowl of red lacquer, pearls and a vase
# with thin films, velvet. A soft box on the left, a cool one behind on the right. Written by make/fruit.py.
LightSource "infinite" "rgb L" [0.035 0.04 0.05]
AttributeBegin # key light, left
  AreaLightSource "diffuse" "rgb L" [40 33 25]
  ReverseOrientation
  Shape "bilinearmesh" "point3 P" [-6.6 5.8 3.4  -4.4 7.0 0.6  -6.0 3.1 2.6  -3.8 4.3 -0.2]
AttributeEnd
AttributeBegin # rim light, behind on the right
  AreaLightSource "diffuse" "rgb L" [23 31 43]
  Shape "bilinearmesh" "point3 P" [5.5 5.4 -3.9  7.7 5.4 -1.3  5.5 2.2 -3.9  7.7 2.2 -1.3]
AttributeEnd

Texture "blotches" "float" "fbm" "integer octaves" 3
Texture "grain" "float" "fbm" "integer octaves" 7
Texture "skin" "spectrum" "mix" "rgb tex1" [0.86 0.46 0.14] "rgb tex2" [0.66 0.07 0.05] "texture amount" "blotches"
Texture "plaster" "spectrum" "mix" "rgb tex1" [0.19 0.15 0.12] "rgb tex2" [0.09 0.072 0.062] "texture amount" "grain"
MakeNamedMaterial "wall" "string type" "diffuse" "texture reflectance" "plaster"
MakeNamedMaterial "velvet" "string type" "principled" "rgb basecolor" [0.012 0.045 0.11] "float roughness" 0.9
  "rgb sheencolor" [0.30 0.55 0.95] "float sheenroughness" 0.3
MakeNamedMaterial "lacquer" "string type" "principled" "rgb basecolor" [0.62 0.018 0.014] "float metallic" 0.2 "float roughness" 0.42
  "float clearcoat" 1 "float clearcoatroughness" 0.03
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.15
MakeNamedMaterial "green grape" "string type" "subsurface" "rgb reflectance" [0.46 0.52 0.20] "rgb mfp" [0.11 0.12 0.04]
  "float roughness" 0.16 "float eta" 1.4
MakeNamedMaterial "dark grape" "string type" "subsurface" "rgb reflectance" [0.20 0.04 0.10] "rgb mfp" [0.05 0.015 0.02]
  "float roughness" 0.28 "float eta" 1.4
MakeNamedMaterial "peach" "string type" "diffuse" "texture reflectance" "skin"
MakeNamedMaterial "fuzz" "string type" "hair" "rgb color" [0.93 0.84 0.72] "float beta_m" 0.4 "float beta_n" 0.4
MakeNamedMaterial "pearl" "string type" "principled" "rgb basecolor" [0.80 0.76 0.72] "float metallic" 0.35 "float roughness" 0.16
  "float iridescence" 1 "float iridescenceeta" 1.5 "float iridescencethickness" 340
MakeNamedMaterial "oil on steel" "string type" "principled" "rgb basecolor" [0.62 0.60 0.58] "float metallic" 1 "float roughness" 0.2
  "float iridescence" 1 "float iridescenceeta" 1.7 "float iridescencethickness" 300

"""

BOWL = [(0.0, 0.06), (0.50, 0.06), (0.50, 0.0), (0.58, 0.0), (0.60, 0.05), (0.52, 0.16), (0.56, 0.20), (0.86, 0.34), (1.10, 0.58), (1.22, 0.86),
        (1.23, 0.89), (1.19, 0.89), (1.06, 0.62), (0.82, 0.40), (0.50, 0.27), (0.0, 0.24)]
RIM = [(1.235, 0.885), (1.24, 0.905), (1.21, 0.92), (1.185, 0.905), (1.19, 0.885)]


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def cloth(x: float, z: float) -> float:
    """The height of the velvet: flat where things stand, in folds on the right and in front, up a wall behind."""
    far = max(0.0, x - 1.3) + max(0.0, -x - 2.6) + 0.8 * max(0.0, z - 1.5)
    part = min(far / 1.2, 1.0)
    part = part * part * (3.0 - 2.0 * part)
    fold = math.sin(2.3 * x - 1.1 * z + 0.9 * math.sin(0.8 * z + 0.5 * x)) + 0.6 * math.sin(3.9 * x + 1.7 * z + 1.3 * math.sin(1.1 * x))
    return 0.13 * part * (fold + 1.6)


def grapes(rule: random.Random) -> str:
    """Grapes heaped in the bowl and hanging over its rim on the left; no two nearer than a grape is wide."""
    placed = []

    def fill(middle, size, count, near):
        for _ in range(count):
            p = [rule.gauss(0.0, 1.0) for _ in range(3)]
            far = math.sqrt(sum(v * v for v in p)) / rule.uniform(0.0, 1.0) ** (1.0 / 3.0)
            p = [m + s * v / far for m, s, v in zip(middle, size, p)]
            r = rule.uniform(0.155, 0.19)
            inside = math.hypot(p[0], p[2]) < 1.16
            if p[1] - r < (0.30 + 0.45 * (p[0] ** 2 + p[2] ** 2) if inside else 0.0):
                continue
            if not inside and math.hypot(p[0], p[2]) < 1.25 + r and p[1] < 0.92 + 0.4 * r:
                continue
            if all(sum((a - b) ** 2 for a, b in zip(p, q)) > (near * (r + s)) ** 2 for q, s in placed):
                placed.append((p, r))

    fill((0.05, 0.95, 0.0), (0.98, 0.62, 0.98), 9000, 0.90)
    green = list(placed)
    placed_before = len(placed)
    fill((-1.05, 0.72, 0.95), (0.46, 0.66, 0.40), 3000, 0.90)
    fill((-1.35, 0.24, 1.25), (0.62, 0.26, 0.40), 2500, 0.92)
    text = ""
    for name, which in (("green grape", green), ("dark grape", placed[placed_before:])):
        balls = ""
        for p, r in which:
            balls += attribute(f'Shape "sphere" "float radius" {r:.3f}\n', f"Translate {' '.join(number(v) for v in p)}",
                               f"Rotate {rule.uniform(0, 180):.0f} 1 0.3 0.2", "Scale 0.94 1.07 0.94")
        text += attribute(balls, material(name))
    return text


def skin(s: float, t: float) -> tuple[float, float, float]:
    """A peach of radius 1 with its cleft at the angle 0."""
    turn, down = 2.0 * math.pi * s, math.pi * (0.002 + 0.996 * t)
    side = min(s, 1.0 - s) * 2.0 * math.pi
    r = 1.0 - 0.075 * math.exp(-(side / 0.22) ** 2) - 0.16 * math.exp(-(down / 0.33) ** 2) + 0.05 * math.exp(-((math.pi - down) / 0.3) ** 2)
    return (r * math.sin(down) * math.cos(turn), 0.94 * r * math.cos(down), r * math.sin(down) * math.sin(turn))


def peach(rule: random.Random, count: int) -> str:
    text = attribute(grid(skin, 72, 48), "ReverseOrientation", material("peach"))
    hairs = ""
    for k in range(count):
        y = 1.0 - 2.0 * (k + 0.5) / count
        s, t = (k * 0.381966 + rule.uniform(-0.01, 0.01)) % 1.0, math.acos(y) / math.pi
        p = skin(s, t)
        size = math.sqrt(sum(v * v for v in p))
        n = [v / size + rule.uniform(-0.45, 0.45) for v in p]
        long = rule.uniform(0.03, 0.065)
        points = [p[j] + long * n[j] * f for f in (-0.1, 0.3, 0.65, 1.0) for j in range(3)]
        hairs += f'Shape "curve" "point3 P" [{" ".join(f"{v:.3f}" for v in points)}]\n'
    return text + attribute(hairs, material("fuzz"), 'Attribute "shape" "float width0" 0.005 "float width1" 0.002 "string type" "cylinder"')


def pearls() -> str:
    """A string of pearls: over the bowl's rim on the right, down and along the table towards the eye."""
    path = [(0.95, 1.06, 0.62), (1.10, 1.0, 0.86), (1.17, 0.80, 1.0), (1.16, 0.5, 1.08), (1.14, 0.22, 1.16), (1.06, 0.09, 1.36), (0.80, 0.085, 1.62),
            (0.40, 0.085, 1.72), (0.02, 0.085, 1.60), (-0.18, 0.085, 1.36), (-0.02, 0.085, 1.16), (0.30, 0.085, 1.22), (0.52, 0.085, 1.42),
            (0.50, 0.085, 1.98), (0.20, 0.085, 2.2)]
    fine = []
    for k in range(len(path) - 1):
        before, after = path[max(k - 1, 0)], path[min(k + 2, len(path) - 1)]
        for i in range(200):
            f = i / 200
            a, b, c, d = before, path[k], path[k + 1], after
            fine.append([0.5 * (2 * b[j] + (c[j] - a[j]) * f + (2 * a[j] - 5 * b[j] + 4 * c[j] - d[j]) * f * f +
                                (3 * b[j] - a[j] - 3 * c[j] + d[j]) * f * f * f) for j in range(3)])
    text, last = "", None
    for p in fine:
        if last is None or math.dist(p, last) >= 0.166:
            text += attribute('Shape "sphere" "float radius" 0.084\n', f"Translate {' '.join(number(v) for v in p)}")
            last = p
    return attribute(text, material("pearl"))


def main() -> None:
    rule = random.Random(5)
    text = HEAD
    text += attribute(patch((-14, -1, -5), (14, -1, -5), (-14, 9, -5), (14, 9, -5)), material("wall"))
    text += attribute(grid(lambda s, t: (-7 + 14 * s, cloth(-7 + 14 * s, -4.8 + 8.8 * t), -4.8 + 8.8 * t), 150, 100), "ReverseOrientation",
                      material("velvet"))
    text += attribute(attribute(lathe(BOWL, 96), material("lacquer")) + attribute(lathe(RIM, 96), material("gold")), "Translate 0.15 0.01 0")
    text += attribute(grapes(rule) + pearls(), "Translate 0.15 0.01 0")
    text += f'ObjectBegin "peach"\n{peach(rule, 4600)}ObjectEnd\n'
    for x, y, z, size, turn in ((2.0, 0.56, 0.55, 0.56, -70), (2.35, 0.50, -0.62, 0.52, 30), (-2.2, 0.5, 0.75, 0.52, -110)):
        text += attribute('ObjectInstance "peach"\n', f"Translate {x} {y} {z}", f"Rotate {turn} 0 1 0", "Rotate 24 0 0 1", f"Scale {size} {size} {size}")
    text += attribute('Include "vase.pbrt"\n', material("oil on steel"), "Translate -1.7 0.01 -1.1", "Scale 1.08 1.08 1.08")
    print(text, end="")


main()
