"""Prints the scene library.pbrt: a reading desk by lamplight, seen through a double Gauss lens (all.py).
The unit is a metre."""
import math
import random

from solids import attribute, box, grid, instance, lathe, number, patch

HEAD = """# A reading desk by lamplight, through a real lens: the ten surfaces of a double Gauss of 50 mm at f/2.8. Points of light out of
# focus become discs, cut by the barrel towards the corners. Written by make/library.py.
Scale -1 1 1
LookAt 0.62 1.36 1.5   0.03 1.02 -0.5   0 1 0
Camera "realistic" "string lensfile" "../cameras/lenses/double_gauss_50mm.dat" "float aperturediameter" 17 "float focusdistance" 1.62
Sampler "zsobol" "integer pixelsamples" 1024
Integrator "path" "integer maxdepth" 12 "bool regularize" true
Film "rgb" "float maxcomponentvalue" 40 "string filename" "library.exr" "integer xresolution" 1600 "integer yresolution" 900 "float diagonal" 43
WorldBegin
LightSource "infinite" "rgb L" [0.075 0.092 0.15]

Texture "grain" "float" "wrinkled" "integer octaves" 5
Texture "oak" "spectrum" "mix" "rgb tex1" [0.20 0.095 0.042] "rgb tex2" [0.11 0.048 0.02] "texture amount" "grain"
MakeNamedMaterial "oak" "string type" "coateddiffuse" "texture reflectance" "oak" "float roughness" 0.18
MakeNamedMaterial "paper" "string type" "diffuse" "rgb reflectance" [0.68 0.62 0.50]
MakeNamedMaterial "page" "string type" "diffuse" "rgb reflectance" [0.74 0.70 0.60]
MakeNamedMaterial "wall" "string type" "diffuse" "rgb reflectance" [0.25 0.20 0.15]
MakeNamedMaterial "brass" "string type" "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k" "float roughness" 0.12
MakeNamedMaterial "shade" "string type" "diffusetransmission" "rgb reflectance" [0.32 0.46 0.34] "rgb transmittance" [0.006 0.06 0.02]
MakeNamedMaterial "sea" "string type" "coateddiffuse" "rgb reflectance" [0.08 0.16 0.20] "float roughness" 0.1
MakeNamedMaterial "ink" "string type" "diffuse" "rgb reflectance" [0.10 0.085 0.07]
MakeNamedMaterial "felt" "string type" "diffuse" "rgb reflectance" [0.035 0.08 0.05]
"""

COLORS = ["0.20 0.035 0.025", "0.045 0.08 0.05", "0.03 0.045 0.10", "0.22 0.13 0.06", "0.12 0.07 0.04", "0.30 0.24 0.15", "0.07 0.03 0.05",
          "0.26 0.09 0.03", "0.04 0.07 0.08", "0.16 0.05 0.05"]


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def unit_book(color: int, gilt: bool) -> str:
    """A book of size 1 in the box from (0, 0, -1) to (1, 1, 0), its back to the front: pages, two covers and a rounded back."""
    text = attribute(box((0.1, 0.025, -0.98), (0.9, 0.975, -0.03)), material("paper"))
    count = 6
    points = [(0.5 - 0.5 * math.cos(math.pi * i / count), -0.04 + 0.055 * math.sin(math.pi * i / count)) for i in range(count + 1)]
    back = "".join(patch((x0, 0, z0), (x1, 0, z1), (x0, 1, z0), (x1, 1, z1)) for (x0, z0), (x1, z1) in zip(points, points[1:]))
    text += attribute(box((0, 0, -1), (0.1, 1, -0.03)) + box((0.9, 0, -1), (1, 1, -0.03)) + back, f'NamedMaterial "cover {color}"')
    if gilt:
        bands = ""
        for low in (0.12, 0.18, 0.74, 0.9):
            bands += "".join(patch((x0, low, z0 + 0.004), (x1, low, z1 + 0.004), (x0, low + 0.018, z0 + 0.004), (x1, low + 0.018, z1 + 0.004))
                             for (x0, z0), (x1, z1) in zip(points, points[1:]))
        text += attribute(bands, material("brass"))
    return f'ObjectBegin "book {color} {int(gilt)}"\n{text}ObjectEnd\n'


def shelf(rule: random.Random, wide: float, rows: int) -> str:
    """A case of shelves, its front at z = 0, books in it."""
    high, deep = 0.34, 0.3
    text = box((-0.04, 0, -deep), (0, rows * high + 0.1, 0.03)) + box((wide, 0, -deep), (wide + 0.04, rows * high + 0.1, 0.03))
    text += box((-0.06, rows * high + 0.04, -deep), (wide + 0.06, rows * high + 0.1, 0.05)) + box((0, 0, -deep), (wide, rows * high + 0.1, -deep + 0.015))
    text += "".join(box((0, r * high, -deep), (wide, r * high + 0.024, 0.012)) for r in range(rows + 1))
    text = attribute(text, material("oak"))
    for r in range(rows):
        x = 0.012
        while x < wide - 0.06:
            if rule.random() < 0.05:
                x += rule.uniform(0.03, 0.14)
                continue
            color, gilt, tall = rule.randrange(len(COLORS)), rule.random() < 0.55, rule.uniform(0.19, 0.29)
            for _ in range(rule.choice((1, 1, 1, 2, 3, 5))):
                thick = rule.uniform(0.022, 0.055)
                if x + thick > wide - 0.01:
                    x = wide
                    break
                text += instance(f"book {color} {int(gilt)}",
                                 f"Translate {number(x)} {number(r * high + 0.024)} {number(-0.03 - rule.uniform(0, 0.02))}",
                                 f"Scale {number(thick)} {number(tall)} {number(rule.uniform(0.14, 0.19))}")
                x += thick + 0.0015
    return text


def lamp() -> str:
    """A banker's lamp: foot, stem, a shade of green glass along x, a long bulb in it."""
    text = attribute(lathe([(0.0, 0.0), (0.085, 0.0), (0.085, 0.012), (0.07, 0.02), (0.03, 0.028), (0.014, 0.045), (0.009, 0.07), (0.009, 0.33),
                            (0.016, 0.335), (0.016, 0.35), (0.0, 0.355)], 40), material("brass"))
    def half(radius: float):
        return lambda s, t: (0.26 * (s - 0.5), 0.31 + radius * math.sin(math.pi * (0.02 + 0.96 * t)) * 0.95, radius * math.cos(math.pi * (0.02 + 0.96 * t)))
    text += attribute(grid(half(0.075), 2, 28), material("shade"))
    for x in (-0.132, 0.13):
        text += attribute(box((x, 0.306, -0.076), (x + 0.003, 0.316, 0.076)), material("brass"))
    text += attribute('Translate 0 0.345 0\nRotate 90 0 1 0\nShape "cylinder" "float radius" 0.011 "float zmin" -0.085 "float zmax" 0.085\n',
                      'AreaLightSource "diffuse" "rgb L" [2500 1430 600]')
    return text


def open_book() -> str:
    def pages(side: int):
        return lambda s, t: (side * (0.003 + 0.145 * s), 0.012 + 0.026 * math.sin(math.pi * min(1.0, 0.12 + 0.95 * s)) * (1 - 0.35 * s), 0.21 * (0.5 - t))
    text = ""
    for side in (-1, 1):
        text += attribute(grid(pages(side), 24, 2), material("page"))
        lines = ""
        for row in range(19):
            z = -0.085 + 0.0092 * row
            points = [pages(side)(s, 0.5) for s in (0.14, 0.32, 0.5, 0.68, 0.86 if row % 6 != 5 else 0.5)]
            for a, b in zip(points, points[1:]):
                x0, x1 = a[0], b[0]
                lines += patch((x0, a[1] + 0.0006, z), (x1, b[1] + 0.0006, z), (x0, a[1] + 0.0006, z - 0.0026), (x1, b[1] + 0.0006, z - 0.0026))
        text += attribute(lines, material("ink"))
    return text + attribute(box((-0.155, 0, -0.112), (0.155, 0.006, 0.112)), 'NamedMaterial "cover 0"')


def globe() -> str:
    text = attribute(lathe([(0.0, 0.0), (0.08, 0.0), (0.08, 0.015), (0.02, 0.03), (0.012, 0.06), (0.012, 0.085), (0.0, 0.09)], 32), material("oak"))
    text += attribute('Translate 0 0.2 0\nShape "sphere" "float radius" 0.11\n', material("sea"))
    ring = lathe([(0.118, -0.004), (0.126, -0.004), (0.126, 0.004), (0.118, 0.004), (0.118, -0.004)], 64)
    return text + attribute(ring, "Translate 0 0.2 0", "Rotate 66 1 0 0", material("brass"))


def main() -> None:
    rule = random.Random(19)
    text = HEAD
    for i, color in enumerate(COLORS):
        text += f'MakeNamedMaterial "cover {i}" "string type" "coateddiffuse" "rgb reflectance" [{color}] "float roughness" 0.25\n'
        text += unit_book(i, False) + unit_book(i, True)
    for i in range(4):
        text += attribute(shelf(rule, 1.1, 7), f"Translate {number(-2.9 + 1.2 * i)} 0 -1.7")
    for i in range(2):
        text += attribute(shelf(rule, 1.1, 7), f"Translate -2.0 0 {number(0.9 - 1.2 * i)}", "Rotate 90 0 1 0")
    text += attribute(patch((-6, 0, 4), (6, 0, 4), (-6, 0, -3), (6, 0, -3)), material("oak"))
    text += attribute(patch((-6, 0, -2.05), (6, 0, -2.05), (-6, 4, -2.05), (6, 4, -2.05)), material("wall"))
    # the desk
    text += attribute(box((-0.95, 0.74, -0.75), (0.95, 0.78, 0.25)), material("oak"))
    text += attribute(box((-0.4, 0.78, -0.33), (0.32, 0.782, 0.16)), material("felt"))
    text += attribute(lamp(), "Translate -0.06 0.78 -0.48", "Rotate 8 0 1 0")
    text += attribute(open_book(), "Translate -0.03 0.782 -0.1", "Rotate 12 0 1 0")
    text += attribute(globe(), "Translate -0.62 0.78 -0.45")
    y = 0.78
    for wide, deep, high, color, turn in ((0.2, 0.27, 0.045, 7, 12), (0.18, 0.25, 0.032, 2, 25), (0.19, 0.26, 0.05, 1, 5), (0.15, 0.21, 0.025, 9, 40)):
        block = attribute(box((-0.5 * wide, 0.004, -0.5 * deep), (0.5 * wide - 0.004, high - 0.004, 0.5 * deep)), material("paper"))
        block += attribute(box((-0.5 * wide, 0, -0.5 * deep - 0.003), (0.5 * wide, 0.004, 0.5 * deep + 0.003)) +
                           box((-0.5 * wide, high - 0.004, -0.5 * deep - 0.003), (0.5 * wide, high, 0.5 * deep + 0.003)) +
                           box((0.5 * wide - 0.004, 0, -0.5 * deep - 0.003), (0.5 * wide + 0.002, high, 0.5 * deep + 0.003)), f'NamedMaterial "cover {color}"')
        text += attribute(block, f"Translate 0.5 {number(y)} -0.42", f"Rotate {turn + 90} 0 1 0")
        y += high
    # candles on the shelves' edge, far out of focus
    for i in range(14):
        x, z, h = rule.uniform(-2.7, 1.9), -1.63, rule.choice((0.34, 0.68, 1.02, 1.36, 1.7, 2.04))
        text += attribute(f'Translate {number(x)} {number(h + 0.05)} {z}\nShape "sphere" "float radius" 0.008\n',
                          'AreaLightSource "diffuse" "rgb L" [2300 1050 340]')
    print(text, end="")


main()
