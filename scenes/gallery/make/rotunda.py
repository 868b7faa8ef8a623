"""Prints parts/rotunda.pbrt: a round hall under a coffered dome, lit by the sun through its eye (all.py).
The unit is a metre."""
import math

from solids import attribute, box, circle, grid, instance, lathe, prism

RADIUS = 9.0     # of the hall
DRUM = 7.6       # height at which the dome begins
EYE = 1.7        # radius of the opening
SECTORS = 24
ROWS = 5

HEAD = """# A round hall with a coffered dome, lit by the sun through its eye: the world of fisheye.pbrt and panorama.pbrt. Written by
# make/rotunda.py.
LightSource "infinite" "rgb L" [6 8 11] "point3 portal" [%(portal)s]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [7000000 5900000 4500000]
  Translate 260 745 610
  Shape "sphere" "float radius" 4.6
AttributeEnd

Texture "tiles" "spectrum" "checkerboard" "float uscale" 14 "float vscale" 14 "rgb tex1" [0.62 0.58 0.51] "rgb tex2" [0.30 0.13 0.10]
MakeNamedMaterial "dome" "string type" "diffuse" "rgb reflectance" [0.78 0.73 0.65]
MakeNamedMaterial "wall" "string type" "diffuse" "rgb reflectance" [0.66 0.52 0.38]
MakeNamedMaterial "marble" "string type" "coateddiffuse" "rgb reflectance" [0.70 0.62 0.52] "float roughness" 0.2
MakeNamedMaterial "red marble" "string type" "coateddiffuse" "rgb reflectance" [0.34 0.12 0.09] "float roughness" 0.15
MakeNamedMaterial "green marble" "string type" "coateddiffuse" "rgb reflectance" [0.09 0.17 0.12] "float roughness" 0.15
MakeNamedMaterial "floor" "string type" "coateddiffuse" "texture reflectance" "tiles" "float roughness" 0.12
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.12
MakeNamedMaterial "copper" "string type" "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" 0.16
MakeNamedMaterial "silver" "string type" "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k" "float roughness" 0.06

"""

COLUMN = [(0.52, 0.0), (0.52, 0.16), (0.46, 0.18), (0.5, 0.27), (0.46, 0.36), (0.4, 0.4), (0.385, 0.9), (0.34, 4.9), (0.385, 4.93),
          (0.385, 5.0), (0.34, 5.03), (0.37, 5.15), (0.52, 5.5), (0.54, 5.5), (0.54, 5.65)]
CORNICE = [(RADIUS, 5.65), (RADIUS - 1.35, 5.65), (RADIUS - 1.35, 6.0), (RADIUS - 1.4, 6.02), (RADIUS - 1.4, 6.4), (RADIUS - 1.62, 6.62),
           (RADIUS - 1.62, 6.78), (RADIUS - 0.7, 6.86), (RADIUS - 0.7, DRUM - 0.35), (RADIUS - 0.95, DRUM - 0.1), (RADIUS - 0.95, DRUM)]
PEDESTAL = [(0.0, 1.2), (0.42, 1.2), (0.42, 1.1), (0.34, 1.05), (0.34, 0.2), (0.44, 0.14), (0.44, 0.0)]


def material(name: str) -> str:
    return f'NamedMaterial "{name}"'


def coffers(s: float, t: float) -> tuple[float, float, float]:
    """A sector of the dome: five coffers above each other, each with three steps inwards."""
    inner = RADIUS - 0.95
    top = math.acos(EYE / inner)
    row = t * (ROWS + 1.2)
    depth = 0.0
    if row < ROWS:
        across, up = abs(2.0 * s - 1.0), abs(2.0 * (row - math.floor(row)) - 1.0)
        edge = max(across, up)
        for k, limit in enumerate((0.8, 0.62, 0.44)):
            depth += 0.13 * min(max((limit - edge) / 0.035, 0.0), 1.0)
        depth *= 1.0 - 0.1 * math.floor(row)
    # rows get lower towards the eye, as their widths do
    angle = top * (1.0 - (1.0 - t) ** 1.35)
    radius = inner + depth
    turn = 2.0 * math.pi * (s - 0.5) / SECTORS
    return (radius * math.cos(angle) * math.cos(turn), DRUM + radius * math.sin(angle), radius * math.cos(angle) * math.sin(turn))


def main() -> None:
    height = DRUM + math.sqrt((RADIUS - 0.95) ** 2 - EYE ** 2)
    portal = [(-EYE, height, -EYE), (EYE, height, -EYE), (EYE, height, EYE), (-EYE, height, EYE)]
    text = HEAD % {"portal": " ".join(f"{v:.3f}" for p in portal for v in p)}
    sector = attribute(grid(coffers, 36, 110), material("dome"))
    column = attribute(lathe(COLUMN[1:], 40) + box((-0.56, 0, -0.56), (0.56, 0.16, 0.56)), material("red marble"))
    text += f'ObjectBegin "sector"\n{sector}ObjectEnd\nObjectBegin "column"\n{column}ObjectEnd\n'
    ring = lathe([(EYE, height), (EYE, height + 0.7), (EYE + 3.0, height + 0.7)], 96)
    text += attribute(ring, material("marble"))
    # outside, so that no light comes through the dome's shell
    text += attribute(lathe([(RADIUS + 0.6, -0.1), (RADIUS + 0.6, DRUM + 4), (EYE + 2.0, height + 0.6)], 64), material("wall"))
    text += attribute(lathe([(RADIUS, 0), (RADIUS, 5.65)], 128), material("wall"))
    text += attribute(lathe(CORNICE, 128), material("marble"))
    text += attribute(lathe([(RADIUS - 0.012, 0.0), (RADIUS - 0.012, 1.0), (RADIUS, 1.08)], 128), material("green marble"))
    for i in range(SECTORS):
        text += instance("sector", f"Rotate {360 / SECTORS * i:g} 0 1 0")
    for i in range(16):
        text += instance("column", f"Rotate {22.5 * i + 11.25:g} 0 1 0", f"Translate {RADIUS - 0.95:g} 0 0")
    for i in range(8):
        kind = ("gold", "copper", "silver")[i % 3]
        place = (f"Rotate {45 * i:g} 0 1 0", f"Translate {RADIUS - 1.0:g} 0 0")
        text += attribute(lathe(PEDESTAL[::-1], 40), *place, material("green marble"))
        text += attribute('Translate 0 1.75 0\nShape "sphere" "float radius" 0.55\n', *place, material(kind))
        niche = prism(circle(1.3, 40, 0, 3.7), 0.0, 0.1, holes=(circle(1.05, 40, 0, 3.7),))
        text += attribute(niche, f"Rotate {45 * i:g} 0 1 0", f"Translate {RADIUS - 0.08:g} 0 0", "Rotate -90 0 1 0", material("marble"))
        pane = 'Shape "disk" "float radius" 1.1\n'
        text += attribute(pane, 'AreaLightSource "diffuse" "rgb L" [9 10.5 13]', f"Rotate {45 * i:g} 0 1 0",
                          f"Translate {RADIUS - 0.06:g} 3.7 0", "Rotate -90 0 1 0")
    text += attribute(box((-RADIUS, -0.1, -RADIUS), (RADIUS, 0.0, RADIUS)), material("floor"))
    for k in range(-4, 5):
        for j in range(-4, 5):
            x, z = 9 / 7 * (2 * k + 0.5), 9 / 7 * (2 * j + 0.5)
            if math.hypot(x, z) < RADIUS - 1.8:
                text += attribute('Shape "disk" "float radius" 0.45 "float height" 0.003\n', f"Translate {x:.4f} 0 {z:.4f}",
                                  "Rotate -90 1 0 0", material("green marble" if (k + j) % 2 else "marble"))
    print(text, end="")


main()
