"""Prints parts/orangery.pbrt: a hall with arched windows in which orange trees stand in mist, the world of orangery.pbrt
(all.py). The unit is a metre; the hall runs along -z, its windows are on the left."""
import math
import random

from solids import attribute, box, circle, instance, lathe, leaves, patch, prism

LEFT, RIGHT = -4.0, 4.2
NEAR, FAR = 8.0, -22.0
HIGH = 5.2
BAY = 3.6
BAYS = 8
RADIUS = 0.95     # of the windows' arches
SILL = 0.55
SPRING = 3.45
THICK = 0.5
OPEN = (3, 4, 6)  # windows whose shutters are open

HEAD = """# An orangery in the morning: the sun comes through arched windows on the left and shows in the mist, which is a homogeneous
# medium in which everything stands, the camera too. Cool light comes from the sky and from a lantern along the ridge of
# the ceiling. Written by make/orangery.py.
LightSource "infinite" "rgb L" [0.8 1.35 2.1]
LightSource "distant" "point3 from" [-8 4.2 -3.2] "point3 to" [0 0 0] "rgb L" [80 46 20]
AttributeBegin # where the mist ends: in the middle of walls, floor and ceiling
  MediumInterface "mist" ""
  Material "interface"
  Shape "trianglemesh" "integer indices" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 5]
    "point3 P" [-4.3 -0.1 -22.1  4.3 -0.1 -22.1  -4.3 5.3 -22.1  4.3 5.3 -22.1  -4.3 -0.1 8.1  4.3 -0.1 8.1  -4.3 5.3 8.1  4.3 5.3 8.1]
AttributeEnd
MediumInterface "mist" "mist"

Texture "tiles" "spectrum" "checkerboard" "float uscale" 10 "float vscale" 36 "rgb tex1" [0.40 0.36 0.31] "rgb tex2" [0.10 0.13 0.14]
MakeNamedMaterial "wall" "string type" "diffuse" "rgb reflectance" [0.34 0.40 0.41]
MakeNamedMaterial "teal" "string type" "diffuse" "rgb reflectance" [0.20 0.34 0.36]
MakeNamedMaterial "stone" "string type" "diffuse" "rgb reflectance" [0.50 0.48 0.44]
MakeNamedMaterial "floor" "string type" "coateddiffuse" "texture reflectance" "tiles" "float roughness" 0.1
MakeNamedMaterial "iron" "string type" "diffuse" "rgb reflectance" [0.05 0.07 0.07]
MakeNamedMaterial "clay" "string type" "diffuse" "rgb reflectance" [0.46 0.17 0.08]
MakeNamedMaterial "earth" "string type" "diffuse" "rgb reflectance" [0.06 0.04 0.03]
MakeNamedMaterial "bark" "string type" "diffuse" "rgb reflectance" [0.14 0.09 0.06]
MakeNamedMaterial "leaf" "string type" "diffusetransmission" "rgb reflectance" [0.05 0.13 0.04] "rgb transmittance" [0.12 0.22 0.03]
MakeNamedMaterial "orange" "string type" "coateddiffuse" "rgb reflectance" [0.95 0.44 0.05] "float roughness" 0.3

"""

POT = [(0.0, 0.0), (0.30, 0.0), (0.33, 0.06), (0.38, 0.5), (0.44, 0.52), (0.45, 0.64), (0.41, 0.65), (0.39, 0.58), (0.0, 0.58)]
PLINTH = [(0.0, 0.0), (0.95, 0.0), (0.95, 0.12), (0.82, 0.14), (0.82, 0.26), (0.0, 0.26)]


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def opening(radius: float, low: float, spring: float, wide: float) -> str:
    """A wall, wide by HIGH, with an arched opening that begins at the height low; in the plane z = 0 of its own."""
    count = 20
    text = box((-wide, 0, -0.5 * THICK), (-radius, HIGH, 0.5 * THICK)) + box((radius, 0, -0.5 * THICK), (wide, HIGH, 0.5 * THICK))
    if low > 0.0:
        text += box((-radius, 0, -0.5 * THICK), (radius, low, 0.5 * THICK))
    arc = [(radius * math.cos(math.pi * i / count), spring + radius * math.sin(math.pi * i / count)) for i in range(count + 1)]
    for (x0, y0), (x1, y1) in zip(arc, arc[1:]):
        text += prism([(x0, y0), (x0, HIGH), (x1, HIGH), (x1, y1)], -0.5 * THICK, 0.5 * THICK)
    return text


def shutter(radius: float, low: float, spring: float) -> str:
    """Closed wooden shutters in an opening."""
    count = 20
    arc = [(radius * math.cos(math.pi * i / count), spring + radius * math.sin(math.pi * i / count)) for i in range(count + 1)]
    return prism([(-radius, low), (radius, low)] + arc, -0.03, 0.03)


def bars(radius: float, low: float, spring: float) -> str:
    text = ""
    for x in (-0.5 * radius, 0.0, 0.5 * radius):
        top = spring + math.sqrt(radius * radius - x * x)
        text += box((x - 0.025, low, -0.03), (x + 0.025, top, 0.03))
    for k in range(6):
        y = low + (spring - low) * k / 5
        text += box((-radius, y - 0.02, -0.025), (radius, y + 0.02, 0.025))
    ring = prism(circle(0.52 * radius, 40, 0, spring), -0.025, 0.025, holes=(circle(0.47 * radius, 40, 0, spring),))
    return text + ring


def tree(rule: random.Random, count: int, fruits: int, trunk: float, crown: float) -> str:
    """An orange tree in its pot, whose crown is a ball."""
    middle = 0.58 + trunk + 0.8 * crown
    text = attribute(lathe(POT, 40), material("clay"))
    text += attribute('Shape "disk" "float radius" 0.39 "float height" 0.6\n', "Rotate -90 1 0 0", material("earth"))
    text += attribute(lathe([(0.05, 0.55), (0.035, 0.6 + 0.5 * trunk), (0.04, middle)], 12), material("bark"))
    text += attribute(leaves(rule, count, crown, 0.085), material("leaf"), f"Translate 0 {middle:.3f} 0")
    balls = ""
    for k in range(fruits):
        y = 1.0 - 2.0 * (k + 0.5) / fruits
        angle = k * math.pi * (3.0 - math.sqrt(5.0)) + rule.uniform(-0.4, 0.4)
        far = crown * rule.uniform(0.95, 1.04)
        r = math.sqrt(1.0 - y * y)
        balls += attribute('Shape "sphere" "float radius" 0.064\n',
                           f"Translate {far * r * math.cos(angle):.3f} {middle + far * y:.3f} {far * r * math.sin(angle):.3f}")
    return text + attribute(balls, material("orange"))


def hall() -> str:
    text = attribute(box((LEFT - THICK, -0.3, FAR), (RIGHT + 0.2, 0.0, NEAR)), material("stone"))
    text += attribute(patch((LEFT, 0.002, FAR), (LEFT, 0.002, NEAR), (RIGHT, 0.002, FAR), (RIGHT, 0.002, NEAR)), material("floor"))
    text += attribute(box((RIGHT, 0, FAR), (RIGHT + 0.3, HIGH, NEAR)) + box((LEFT - THICK, 0, NEAR), (RIGHT, HIGH, NEAR + 0.3)),
                      material("wall"))
    text += attribute(box((RIGHT - 0.06, 0, FAR), (RIGHT, 1.1, NEAR)) + box((RIGHT - 0.1, 1.1, FAR), (RIGHT, 1.18, NEAR)),
                      material("teal"))
    # the ceiling, open along its ridge
    text += attribute(box((LEFT - THICK, HIGH, FAR - 0.3), (-0.7, HIGH + 0.3, NEAR)) +
                      box((0.9, HIGH, FAR - 0.3), (RIGHT + 0.3, HIGH + 0.3, NEAR)), material("wall"))
    text += attribute(patch((-0.7, HIGH + 0.3, FAR), (0.9, HIGH + 0.3, FAR), (-0.7, HIGH + 0.3, NEAR), (0.9, HIGH + 0.3, NEAR)),
                      'AreaLightSource "diffuse" "rgb L" [1.3 2.2 3.3]', 'Material "diffuse" "rgb reflectance" [0 0 0]')
    text += attribute(patch((-1, 1.5, NEAR - 0.01), (-1, 4.0, NEAR - 0.01), (3.5, 1.5, NEAR - 0.01), (3.5, 4.0, NEAR - 0.01)),
                      'AreaLightSource "diffuse" "rgb L" [1.2 1.2 1.2]')
    beams, piers = "", ""
    for k in range(BAYS + 1):
        z = NEAR - BAY * k
        beams += box((LEFT, HIGH - 0.3, z - 0.12), (RIGHT, HIGH, z + 0.12))
        piers += box((RIGHT - 0.2, 0, z - 0.25), (RIGHT, HIGH - 0.3, z + 0.25)) + box((LEFT, 0, z - 0.2), (LEFT + 0.12, HIGH - 0.3, z + 0.2))
    text += attribute(beams + piers, material("wall"))
    middle = 0.5 * (LEFT + RIGHT)
    text += attribute(opening(1.25, 0.9, 2.6, 0.5 * (RIGHT - LEFT)), material("wall"), f"Translate {middle:g} 0 {FAR:g}")
    text += attribute(bars(1.25, 0.9, 2.6), material("iron"), f"Translate {middle:g} 0 {FAR:g}")
    return text


def main() -> None:
    rule = random.Random(11)
    text = HEAD
    for name, body in (("window", attribute(opening(RADIUS, SILL, SPRING, 0.5 * BAY), material("wall")) +
                        attribute(bars(RADIUS, SILL, SPRING), material("iron"))),
                       ("tree", tree(rule, 1100, 26, 0.75, 0.55)), ("great tree", tree(rule, 2600, 46, 0.85, 0.86))):
        text += f'ObjectBegin "{name}"\n{body}ObjectEnd\n'
    text += hall()
    for k in range(BAYS):
        z = NEAR - BAY * (k + 0.5)
        place = (f"Translate {LEFT - 0.5 * THICK:g} 0 {z:g}", "Rotate 90 0 1 0")
        text += instance("window", *place)
        if k not in OPEN:
            text += attribute(shutter(RADIUS, SILL, SPRING), *place, material("teal"))
        for side, x in ((0, LEFT + 0.75), (1, RIGHT - 0.75)):
            if k > side:
                text += instance("tree", f"Translate {x:g} 0 {z - 0.5 * BAY:g}", f"Rotate {73 * k + 31 * side} 0 1 0")
    text += attribute(lathe(PLINTH, 64), material("stone"), "Translate -1.1 0 -3.4")
    text += instance("great tree", "Translate -1.1 0.26 -3.4", "Rotate 20 0 1 0")
    for x, z in ((0.75, -3.1), (1.02, -2.75), (0.2, -2.6), (-1.7, -2.9)):
        text += attribute('Shape "sphere" "float radius" 0.064\n', material("orange"), f"Translate {x:g} 0.066 {z:g}")
    print(text, end="")


main()
