"""Writes measured.pbrt, the scene of docs/materials.md, and its two measured files into the current folder.
Usage: measured.py HELPER, where HELPER is the program helper_measured (script/build release makes it)."""
import subprocess
import sys

ROUND, BRUSHED = (0.25, 0.25), (0.08, 0.35)  # roughness along u and v
ETA, K, GROWTH = 0.9, 1.2, 3  # at 400 nm; both grow linearly, by the factor 1 + GROWTH at 700 nm

HEAD = """# From the left: a measured file of a metal, the metal itself, a measured file of it brushed, the brushed metal itself.
Film "rgb" "integer xresolution" 720 "integer yresolution" 200 "string filename" "measured.exr"
Sampler "zsobol" "integer pixelsamples" 128
Integrator "path" "integer maxdepth" 5
Scale -1 1 1
LookAt 0 2 13  0 0.93 0  0 1 0
Camera "perspective" "float fov" 10.4
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.32 0.36]
AttributeBegin # key light, left above
  AreaLightSource "diffuse" "rgb L" [14 13 11.5]
  Shape "bilinearmesh" "point3 P" [-6 6.2 3  -2 7.2 1.5  -6 4 5  -2 5 3.5]
AttributeEnd
AttributeBegin # strip, right
  AreaLightSource "diffuse" "rgb L" [7 8 9.5]
  ReverseOrientation
  Shape "bilinearmesh" "point3 P" [6 0.5 3  6 0.5 1.5  6 4.5 3  6 4.5 1.5]
AttributeEnd
AttributeBegin
  Material "diffuse" "rgb reflectance" [0.2 0.21 0.23]
  Shape "bilinearmesh" "point3 P" [-20 0 8  20 0 8  -20 0 -12  20 0 -12]
AttributeEnd
"""
BALL = """AttributeBegin
  Material {material}
  Translate {x} 0.9 0
  Rotate -90 1 0 0
  Shape "sphere" "float radius" 0.9
AttributeEnd
"""
METAL = '"conductor" "spectrum eta" [400 {0} 700 {1}] "spectrum k" [400 {2} 700 {3}] "float uroughness" {4} "float vroughness" {5} "bool remaproughness" false'


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    materials = []
    for name, (u, v) in (("round.bsdf", ROUND), ("brushed.bsdf", BRUSHED)):
        subprocess.run([sys.argv[1], name, *map(str, (u, v, ETA, K, GROWTH))], check=True)
        materials.append(f'"measured" "string filename" "{name}"')
        materials.append(METAL.format(ETA, ETA * (1 + GROWTH), K, K * (1 + GROWTH), u, v))
    with open("measured.pbrt", "w", encoding="ascii") as scene:
        scene.write(HEAD)
        for i, material in enumerate(materials):
            scene.write(BALL.format(material=material, x=2.1 * i - 3.15))


main()
