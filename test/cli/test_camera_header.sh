#!/usr/bin/env bash
# The EXR header's camera, as OpenEXR defines it: row vectors, left-handed camera space, NDC from the upper left corner; and in velo's
# own attributes with every model of a calibrated lens, from which the image is checked.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1
# Eye (0, 0, 5) looking along -z, 40 x 20 pixels, f = d / pixelsize = 10 pixels.
cat >scene.pbrt <<'SCENE'
Camera "pinhole" "point3 eye" [0 0 5] "point3 lookat" [0 0 0] "vector3 up" [0 1 0] "float d" [10] "float pixelsize" [1]
Film "rgb" "integer xresolution" [40] "integer yresolution" [20]
Sampler "independent" "integer pixelsamples" [1]
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Shape "sphere"
SCENE
check render "$VELO" render scene.pbrt -o a.exr --quiet
check render_larger "$VELO" render scene.pbrt -o b.exr --quiet --resolution 80x40
check render_crop "$VELO" render scene.pbrt -o c.exr --quiet --crop 4,2,20,10
for name in a b c; do "$VELO" image info --json $name.exr >$name.json; done
cat >header.py <<'CODE'
import json

def project(m, p):
    return [sum(v * m[4 * row + column] for row, v in enumerate((*p, 1))) for column in range(4)]

def near(got, wanted, what, tolerance=1e-5):
    assert all(abs(g - w) < tolerance for g, w in zip(got, wanted)), (what, got, wanted)

for name in "abc":
    a = json.load(open(name + ".json"))["attributes"]
    for point, camera in (((0, 0, 5), (0, 0, 0)), ((1, 2, 0), (1, 2, 5)), ((-3, 1, -5), (-3, 1, 10))):
        near(project(a["worldToCamera"], point), (*camera, 1), name + " worldToCamera")
        if camera[2]:
            q = project(a["worldToNDC"], point)
            x, y = 20 + 10 * camera[0] / camera[2], 10 - 10 * camera[1] / camera[2]
            near((q[0] / q[3], q[1] / q[3]), (x / 40, y / 20), name + " worldToNDC")
    near([a["pinholeFocalLength"] / a["sensorOverallDimensions"][0]], [10 / 40], "focal length")
    assert a["software"].startswith("velo "), a["software"]
    near(a["chromaticities"], (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290), "chromaticities", 1e-4)
CODE
check header python3 header.py
# Each model of COLMAP by its parameters, of an image of 40 x 30 pixels.
while read -r model parameters; do
  mkdir -p "$model"
  echo "1 $model 40 30 $parameters" >"$model/cameras.txt"
  check "render_$model" "$VELO" render scene.pbrt --camera "$model/cameras.txt" --channels Z,P -o lens.exr --quiet
  check "check_$model" "$VELO" image check lens.exr
done <<'MODELS'
PINHOLE 30 31 20 15
RADIAL 30 20 15 -0.02 0.001
FULL_OPENCV 30 31 20 15 -0.02 0.001 0.001 0.002 0.01 0.001 0.002 0.001
OPENCV_FISHEYE 30 31 20 15 0.01 -0.001 0.001 0.0002
FOV 30 31 20 15 0.6
THIN_PRISM_FISHEYE 30 31 20 15 0.01 -0.001 0.001 0.0002 0.001 0.0001 0.001 -0.001
DIVISION 30 31 20 15 -0.1
EUCM 30 31 20 15 0.6 1.1
RAD_TAN_THIN_PRISM_FISHEYE 30 31 20 15 0.1 -0.02 0.003 0.001 -0.0002 0.00001 0.001 -0.002 0.0005 0.0001 -0.0003 0.0002
MODELS
finish
