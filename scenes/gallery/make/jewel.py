"""Prints the scene jewel.pbrt: cut stones on slate (all.py). The brilliant has a radius of 1."""
import math
import random

from solids import attribute, flat, lathe, mesh, number, numbers

HEAD = """# Brilliants and coloured stones on slate: glass whose index depends on the wavelength, so that white light leaves in colours.
# Written by make/jewel.py.
Scale -1 1 1
LookAt 0.4 4.1 7.2   0.0 0.5 0   0 1 0
Camera "perspective" "float fov" 23 "float lensradius" 0.05 "float focaldistance" 7.5
Sampler "zsobol" "integer pixelsamples" 1024
Integrator "volpath" "integer maxdepth" 24 "bool regularize" true
Film "rgb" "float maxcomponentvalue" 20 "string filename" "jewel.exr" "integer xresolution" 1600 "integer yresolution" 900
WorldBegin
LightSource "infinite" "rgb L" [0.10 0.115 0.15]
%(lamps)s
MakeNamedMaterial "slate" "string type" "coateddiffuse" "rgb reflectance" [0.022 0.023 0.028] "float roughness" 0.32
MakeNamedMaterial "diamond" "string type" "dielectric" "spectrum eta" [380 2.464 420 2.449 460 2.438 500 2.430 550 2.423 600 2.416 650 2.411 700 2.406 780 2.401]
MakeNamedMaterial "ruby" "string type" "dielectric" "spectrum eta" [380 1.79 500 1.774 600 1.766 780 1.76]
MakeNamedMaterial "sapphire" "string type" "dielectric" "spectrum eta" [380 1.79 500 1.774 600 1.766 780 1.76]
MakeNamedMaterial "emerald" "string type" "dielectric" "spectrum eta" [380 1.60 500 1.585 600 1.578 780 1.572]
MakeNamedMedium "red inside" "string type" "homogeneous" "rgb sigma_a" [0.05 3.2 2.2] "rgb sigma_s" [0 0 0]
MakeNamedMedium "blue inside" "string type" "homogeneous" "rgb sigma_a" [2.8 1.5 0.12] "rgb sigma_s" [0 0 0]
MakeNamedMedium "green inside" "string type" "homogeneous" "rgb sigma_a" [2.6 0.18 1.7] "rgb sigma_s" [0 0 0]

"""


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def brilliant() -> str:
    """The round brilliant after Tolkowsky, of radius 1, its culet at y = 0: table .53, crown 34.5 degrees, pavilion 40.75
    degrees, girdle .03 high. Facets are planes; each polygon is where a plane meets its neighbours."""
    pavilion, crown, table, girdle = math.radians(40.75), math.radians(34.5), 0.53, 0.03
    low = math.tan(pavilion)
    high = low + girdle
    top = high + (1.0 - table) * math.tan(crown)
    ring = lambda r, y, turn, n=8: [(r * math.cos(2 * math.pi * (i + turn) / n), y, r * math.sin(2 * math.pi * (i + turn) / n)) for i in range(n)]
    inner = ring(table / math.cos(math.pi / 8), top, 0.5)          # corners of the table
    middle = ring(0.5 * (1 + table) * 1.03, high + 0.5 * (1 - table) * math.tan(crown) * 1.0, 0.0)   # tips of the star facets
    upper, lower = ring(1.0, high, 0.0, 16), ring(1.0, low, 0.0, 16)
    deep = ring(0.24, 0.24 * low, 0.5)                           # where the lower halves end
    faces = [[inner[i] for i in range(8)][::-1]]
    for i in range(8):
        j = (i + 1) % 8
        before = (i + 7) % 8
        faces.append([inner[before], inner[i], middle[i]])          # star
        faces.append([inner[i], middle[j], upper[2 * i + 1]])       # half of a kite
        faces.append([inner[i], upper[2 * i + 1], middle[i]])
        faces.append([middle[i], upper[2 * i + 1], upper[2 * i]])   # upper halves
        faces.append([middle[j], upper[(2 * i + 2) % 16], upper[2 * i + 1]])
        faces.append([lower[2 * i], lower[2 * i + 1], deep[i]])     # lower halves
        faces.append([lower[2 * i + 1], lower[(2 * i + 2) % 16], deep[i]])
        faces.append([deep[before], lower[2 * i], deep[i]])
        faces.append([(0.0, 0.0, 0.0), deep[before], deep[i]])
    for i in range(16):
        j = (i + 1) % 16
        faces.append([upper[i], upper[j], lower[j], lower[i]])
    points, triangles = [], []
    centre = (0.0, 0.5 * top, 0.0)
    for face in faces:
        for k in range(1, len(face) - 1):
            a, b, c = face[0], face[k], face[k + 1]
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            away = sum(n[i] * (a[i] - centre[i]) for i in range(3)) > 0.0
            first = len(points)
            points += [a, b, c] if away else [a, c, b]
            triangles.append((first, first + 1, first + 2))
    return mesh(points, triangles)


def emerald_cut(wide: float, deep: float) -> str:
    """A step cut: an octagon in steps above and below."""
    rings = [(0.28, 0.0), (0.7, 0.42), (1.0, 0.68), (1.0, 0.72), (0.86, 0.86), (0.68, 0.97)]
    def outline(scale: float, y: float):
        w, d, cut = wide * scale, deep * scale, 0.3 * min(wide, deep) * scale
        return [(w, y, d - cut), (w - cut, y, d), (cut - w, y, d), (-w, y, d - cut), (-w, y, cut - d), (cut - w, y, -d), (w - cut, y, -d), (w, y, cut - d)]
    rows = [outline(s, y) for s, y in rings]
    points, triangles = [], []
    def add(a, b, c):
        first = len(points)
        points.extend([a, b, c])
        triangles.append((first, first + 1, first + 2))
    for low, high in zip(rows, rows[1:]):
        for i in range(8):
            j = (i + 1) % 8
            add(low[i], high[i], low[j])
            add(low[j], high[i], high[j])
    for k in range(1, 7):
        add(rows[0][0], rows[0][k], rows[0][k + 1])
        add(rows[-1][0], rows[-1][k + 1], rows[-1][k])
    return mesh(points, triangles)


def lamp(x: float, y: float, z: float, radius: float, color: str) -> str:
    return attribute(f'Shape "sphere" "float radius" {number(radius)}\n', f'AreaLightSource "diffuse" "rgb L" [{color}]',
                     f"Translate {number(x)} {number(y)} {number(z)}")


def main() -> None:
    rule = random.Random(11)
    lamps = ""
    for i in range(34):
        a = rule.uniform(0.0, 2.0 * math.pi)
        up = rule.uniform(0.35, 1.45)
        far = 11.0
        c = rule.choice(["900 800 680", "800 840 900", "1000 640 380", "700 780 930"])
        lamps += lamp(far * math.cos(up) * math.cos(a), far * math.sin(up), far * math.cos(up) * math.sin(a), 0.16, c)
    lamps += attribute('Shape "bilinearmesh" "point3 P" [-5 7 -7  3 7 -7  -5 10 -2  3 10 -2]\n', 'AreaLightSource "diffuse" "rgb L" [17 17.5 19]',
                       "ReverseOrientation")
    lamps += attribute('Shape "bilinearmesh" "point3 P" [6 1 -3  6 1 3  5 6 -3  5 6 3]\n', 'AreaLightSource "diffuse" "rgb L" [9 8.2 7]')
    text = HEAD % {"lamps": lamps}
    text += attribute('Shape "bilinearmesh" "point3 P" [-30 0 30  30 0 30  -30 0 -30  30 0 -30]\n', material("slate"))
    text += f'ObjectBegin "brilliant"\n{attribute(brilliant(), material("diamond"))}ObjectEnd\n'
    text += attribute('ObjectInstance "brilliant"\n', "Translate 0 0.004 -0.5", "Rotate 14 0 1 0", "Rotate 40.75 1 0 0")
    for k in range(16):
        a, r, s = rule.uniform(0, 360), rule.uniform(1.5, 4.4), rule.uniform(0.1, 0.3)
        x, z = r * math.cos(math.radians(a)), r * math.sin(math.radians(a)) - 0.4
        text += attribute('ObjectInstance "brilliant"\n', f"Translate {number(x)} 0.004 {number(z)}", f"Scale {number(s)} {number(s)} {number(s)}",
                          f"Rotate {number(rule.uniform(0, 360))} 0 1 0", "Rotate 40.75 1 0 0", f"Rotate {45 * k} 0 1 0")
    for name, inside, x, z, turn, size, shape in (
            ("ruby", "red inside", -1.9, 0.35, 330, 0.62, brilliant()), ("sapphire", "blue inside", 1.75, -0.85, -20, 0.72, emerald_cut(1.0, 0.78)),
            ("emerald", "green inside", -1.25, -1.9, 65, 0.66, emerald_cut(1.05, 0.75)), ("sapphire", "blue inside", 1.5, 1.25, 115, 0.34, brilliant()),
            ("ruby", "red inside", 2.9, 0.3, 200, 0.3, brilliant())):
        lean = "Rotate 40.75 1 0 0" if shape == brilliant() else "Rotate 0 0 0 1"
        text += attribute(shape, f'MediumInterface "{inside}" ""', material(name), f"Translate {x} 0.006 {z}", f"Scale {size} {size} {size}",
                          f"Rotate {turn} 0 1 0", lean)
    print(text, end="")


main()
