"""Prints the scene watch.pbrt: the movement of a watch (all.py).
The unit is a millimetre; the movement lies in the plane of x and y, z is up."""
import math

from solids import attribute, circle, lathe, mesh, number, numbers, prism

HEAD = """# The movement of a watch, seen through a macro lens: gears and bridges of steel and gilded brass, rubies, blued
# screws, a balance wheel with its spring. Written by make/watch.py.
Scale -1 1 1
LookAt -4.2 -19 17   0.2 -0.7 0.4   0 0 1
Camera "perspective" "float fov" 31 "float lensradius" 0.26 "float focaldistance" 23.4
Sampler "zsobol" "integer pixelsamples" 256
Integrator "path" "integer maxdepth" 14 "bool regularize" true
Film "rgb" "float maxcomponentvalue" 12 "string filename" "watch.exr" "integer xresolution" 1600 "integer yresolution" 900
WorldBegin
LightSource "infinite" "rgb L" [0.05 0.055 0.065]
AttributeBegin # a large soft box behind, from the left
  AreaLightSource "diffuse" "rgb L" [3.6 3.5 3.3]
  Shape "bilinearmesh" "point3 P" [-30 12 16  -6 30 16  -22 4 34  2 22 34]
  ReverseOrientation
AttributeEnd
AttributeBegin # a warm strip from the right
  AreaLightSource "diffuse" "rgb L" [9 5.6 2.8]
  Shape "bilinearmesh" "point3 P" [26 -8 6  28 6 6  24 -8 18  26 6 18]
  ReverseOrientation
AttributeEnd
AttributeBegin # a dim one above
  AreaLightSource "diffuse" "rgb L" [1.6 1.7 1.9]
  Shape "bilinearmesh" "point3 P" [-14 -14 40  14 -14 40  -14 10 40  14 10 40]
  ReverseOrientation
AttributeEnd

MakeNamedMaterial "plate" "string type" "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k" "float roughness" 0.05
MakeNamedMaterial "brass" "string type" "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k" "float roughness" 0.02
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.02
MakeNamedMaterial "steel" "string type" "conductor" "rgb reflectance" [0.42 0.43 0.46] "float roughness" 0.02
MakeNamedMaterial "polished" "string type" "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k" "float roughness" 0.004
MakeNamedMaterial "blued" "string type" "conductor" "rgb reflectance" [0.05 0.11 0.42] "float roughness" 0.02
MakeNamedMaterial "ruby" "string type" "coateddiffuse" "rgb reflectance" [0.62 0.015 0.06] "float roughness" 0.02
MakeNamedMaterial "dark" "string type" "diffuse" "rgb reflectance" [0.015 0.015 0.018]

"""


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def at(x: float, y: float, z: float = 0.0, turn: float = 0.0) -> str:
    return f"Translate {number(x)} {number(y)} {number(z)}" + (f"\nRotate {number(turn)} 0 0 1" if turn else "")


def teeth(radius: float, count: int, depth: float) -> list[tuple[float, float]]:
    outline = []
    for i in range(count):
        for share, r in ((0.0, radius - depth), (0.2, radius - depth), (0.36, radius - 0.3 * depth), (0.44, radius),
                         (0.58, radius), (0.66, radius - 0.3 * depth), (0.82, radius - depth)):
            angle = 2.0 * math.pi * (i + share) / count
            outline.append((r * math.cos(angle), r * math.sin(angle)))
    return outline


def turned(profile: list[tuple[float, float]]) -> str:
    """A lathe around z instead of y."""
    return "Rotate 90 1 0 0\n" + lathe(profile, 48)


def disc(radius: float, low: float, high: float, bevel: float = 0.04) -> str:
    return turned([(0.0, low), (radius, low), (radius, high - bevel), (radius - bevel, high), (0.0, high)])


def bar(x0: float, y0: float, x1: float, y1: float, wide: float, low: float, high: float, end: float = 1.0) -> str:
    length = math.hypot(x1 - x0, y1 - y0)
    nx, ny = -(y1 - y0) / length * 0.5 * wide, (x1 - x0) / length * 0.5 * wide
    return prism([(x0 + nx, y0 + ny), (x0 - nx, y0 - ny), (x1 - nx * end, y1 - ny * end), (x1 + nx * end, y1 + ny * end)], low, high)


def gear(radius: float, count: int, high: float, spokes: int, kind: str) -> str:
    depth = 2.2 * math.pi * radius / count * 0.36
    rim = teeth(radius, count, depth)
    inside = [(math.cos(a) * 0.8 * radius, math.sin(a) * 0.8 * radius) for a in (math.atan2(y, x) for x, y in rim)]
    text = attribute(prism(rim, 0.0, high, holes=(inside,)), material(kind))
    hub = 0.26 * radius
    for i in range(spokes):
        a = 2.0 * math.pi * i / spokes
        c, s = math.cos(a), math.sin(a)
        text += attribute(bar(0.6 * hub * c, 0.6 * hub * s, 0.83 * radius * c, 0.83 * radius * s, 0.2 * radius, 0.02, high - 0.02, 0.6),
                          material(kind))
    text += attribute(disc(hub, -0.02, high + 0.05), material(kind))
    text += attribute(disc(0.09 * radius + 0.05, -0.5, high + 0.75), material("polished"))
    pinion = prism(teeth(0.17 * radius + 0.16, 10, 0.14), high + 0.04, high + 0.5)
    return text + attribute(pinion, material("polished"))


def jewel(x: float, y: float, z: float, size: float = 0.42) -> str:
    setting = turned([(size * 1.75, -0.2), (size * 1.75, 0.03), (size * 1.6, 0.07), (size * 1.28, 0.0), (size * 1.22, -0.06)])
    stone = turned([(size * 1.22, -0.05), (size * 1.02, 0.06), (size * 0.5, 0.0), (size * 0.24, -0.09), (size * 0.2, -0.3)])
    return (attribute(setting, at(x, y, z), material("gold")) + attribute(stone, at(x, y, z), material("ruby")) +
            attribute(disc(size * 0.17, -0.3, 0.0, 0.02), at(x, y, z), material("polished")))


def screw(x: float, y: float, z: float, size: float, turn: float) -> str:
    """A head with a slot: two halves."""
    text = ""
    count = 20
    for side in (0.0, 180.0):
        half = [(size * math.cos(a), size * math.sin(a)) for a in
                (math.asin(0.13) + (math.pi - 2.0 * math.asin(0.13)) * i / count for i in range(count + 1))]
        text += attribute(prism(half, 0.0, 0.3), at(x, y, z, turn + side), material("blued"))
    return text + attribute(disc(size * 0.98, -0.05, 0.16, 0.01), at(x, y, z), material("blued"))


def bridge(points: list[tuple[float, float]], radius: float, low: float, high: float) -> str:
    """A plate around a row of points: the union of discs and bars, all of one height."""
    text = "".join(attribute(disc(radius, low, high, 0.12), at(x, y), material("steel")) for x, y in points)
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        text += attribute(bar(x0, y0, x1, y1, 1.72 * radius, low, high - 0.002), material("steel"))
    return text


def spiral(turns: float, inner: float, outer: float, high: float, thick: float) -> str:
    """The balance's spring: a band of the given height."""
    count = int(turns * 64)
    points, triangles = [], []
    for i in range(count + 1):
        a = 2.0 * math.pi * turns * i / count
        r = inner + (outer - inner) * i / count
        for dr in (-0.5 * thick, 0.5 * thick):
            for z in (0.0, high):
                points.append(((r + dr) * math.cos(a), (r + dr) * math.sin(a), z))
        if i:
            k = 4 * i
            for a0, b0 in ((0, 1), (1, 3), (3, 2), (2, 0)):
                triangles += [(k - 4 + a0, k - 4 + b0, k + b0), (k - 4 + a0, k + b0, k + a0)]
    return mesh(points, triangles)


def balance() -> str:
    text = attribute(turned([(3.0, 0.0), (3.5, 0.0), (3.5, 0.42), (3.44, 0.48), (3.06, 0.48), (3.0, 0.42), (3.0, 0.0)]), material("gold"))
    for i in range(3):
        a = 2.0 * math.pi * i / 3 + 0.4
        text += attribute(bar(0, 0, 3.05 * math.cos(a), 3.05 * math.sin(a), 0.5, 0.1, 0.36, 0.7), material("gold"))
    for i in range(12):
        a = 2.0 * math.pi * (i + 0.5) / 12
        head = "Rotate 90 0 1 0\n" + "Rotate -90 1 0 0\n" + lathe([(0.0, -0.1), (0.17, -0.1), (0.17, 0.26), (0.14, 0.3), (0.0, 0.3)], 20)
        text += attribute(head, at(3.45 * math.cos(a), 3.45 * math.sin(a), 0.24, math.degrees(a)), material("polished"))
    text += attribute(disc(0.5, 0.0, 0.6), material("polished"))
    text += attribute(spiral(7.2, 0.45, 2.5, 0.22, 0.035), at(0, 0, 0.72), material("blued"))
    return text


def main() -> None:
    text = HEAD
    text += attribute(f'Shape "bilinearmesh" "point3 P" [{numbers([-200, -200, -3, 200, -200, -3, -200, 200, -3, 200, 200, -3])}]\n', material("dark"))
    text += attribute(disc(13.0, -1.2, 0.0, 0.15), material("plate"))
    text += attribute(turned([(12.4, -1.3), (14.2, -1.3), (14.2, 1.4), (13.9, 1.7), (12.9, 1.7), (12.6, 1.4), (12.6, -1.3)]), material("polished"))
    for i in range(60): # marks of the minutes on the rim
        a = 2.0 * math.pi * i / 60
        long = 12.98 if i % 5 else 12.92
        text += attribute(bar(long * math.cos(a), long * math.sin(a), 13.55 * math.cos(a), 13.55 * math.sin(a), 0.05 if i % 5 else 0.11, 1.69, 1.715),
                          material("dark"))
    for x, y, z, radius, count, spokes, kind, turn in (
            (-5.2, 4.6, 0.35, 5.0, 72, 5, "brass", 3.0), (2.2, 5.6, 0.9, 3.6, 60, 5, "gold", 1.5), (6.9, 1.6, 0.45, 2.9, 48, 4, "brass", 5.0),
            (0.9, 0.2, 0.5, 2.6, 45, 5, "brass", 0.0), (-6.6, -3.4, 0.4, 3.4, 30, 6, "steel", 4.0), (5.6, -6.2, 0.4, 2.4, 15, 4, "polished", 9.0)):
        text += attribute(gear(radius, count, 0.36, spokes, kind), at(x, y, z, turn))
    text += bridge([(-9.6, 7.3), (-5.2, 4.6), (0.4, 9.6)], 1.75, 1.75, 2.5)
    text += bridge([(10.2, 4.6), (6.9, 1.6), (2.2, 5.6)], 1.3, 1.75, 2.3)
    text += bridge([(10.6, -3.6), (5.6, -6.2)], 1.2, 1.5, 2.1)
    for x, y, z, size in ((-5.2, 4.6, 2.5, 0.62), (6.9, 1.6, 2.3, 0.44), (2.2, 5.6, 2.3, 0.44), (5.6, -6.2, 2.1, 0.44), (-10.4, -1.6, 0.02, 0.4),
                          (9.6, -0.9, 0.02, 0.36)):
        text += jewel(x, y, z, size)
    for x, y, z, size, turn in ((-9.6, 7.3, 2.5, 0.8, 30), (0.4, 9.6, 2.5, 0.8, 100), (10.2, 4.6, 2.3, 0.62, 65), (10.6, -3.6, 2.1, 0.62, 10),
                                (-9.9, -6.6, 0.02, 0.6, 140), (2.6, -10.6, 0.02, 0.55, 20)):
        text += screw(x, y, z, size, turn)
    # the balance, its cock above it
    text += attribute(balance(), at(-1.4, -5.4, 1.0))
    text += attribute(bridge([(-9.2, -8.4), (-5.2, -7.0)], 0.95, 2.3, 2.9) + attribute(bar(-5.2, -7.0, -1.4, -5.4, 1.5, 2.3, 2.9, 0.55), material("steel")))
    text += attribute(disc(0.95, 2.3, 2.9, 0.1), at(-1.4, -5.4), material("steel"))
    text += jewel(-1.4, -5.4, 2.92, 0.4) + screw(-9.2, -8.4, 2.9, 0.55, 70)
    print(text, end="")


main()
