#!/usr/bin/env bash
# pbrt's film "gbuffer": its channels' names, and what they hold of a slanting wall that is known; both spaces; variance.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
write_wall() { # $1 coordinate system: the camera stands at (1, 2, 3) and looks along the world's x, y up
  cat <<SCENE
LookAt 1 2 3  2 2 3  0 1 0
Camera "perspective" "float fov" 40
Film "gbuffer" "integer xresolution" 40 "integer yresolution" 40 "string filename" "wall.exr" "string coordinatesystem" "$1"
Sampler "independent" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.5 0.5]
LightSource "distant" "point3 from" [0 0 0] "point3 to" [1 0 0]
Material "diffuse" "rgb reflectance" [0.3 0.3 0.3]
# x = 5 + 0.5 (z - 3), upright
Shape "bilinearmesh" "point3 P" [0 -8 -7  10 -8 13  0 12 -7  10 12 13]
SCENE
}
write_wall camera >camera.pbrt
write_wall world >world.pbrt
check render "$VELO" render camera.pbrt -o camera.exr --quiet
check render_world "$VELO" render world.pbrt -o world.exr --quiet
check info "$VELO" image info camera.exr
expect_text names 'channels    26: '
cat >names.py <<'CODE'
import json
wanted = """R G B Albedo.R Albedo.G Albedo.B P.X P.Y P.Z dzdx dzdy N.X N.Y N.Z Ns.X Ns.Y Ns.Z u v
Variance.R Variance.G Variance.B RelativeVariance.R RelativeVariance.G RelativeVariance.B A""".split()
have = json.load(open("info.json"))["channels"]
assert sorted(have) == sorted(wanted), have
CODE
"$VELO" image info --json camera.exr >info.json
check all_names python3 names.py
for space in camera world; do
  for channel in P.X P.Y P.Z N.X N.Y N.Z Ns.X dzdx dzdy Albedo.G u v Variance.G RelativeVariance.G G; do
    "$VELO" image convert $space.exr $space.$channel.pfm --channel $channel || fail "convert $channel"
  done
done
cat >wall.py <<'CODE'
import array, math

def read(name):
    with open(name, "rb") as file:
        kind, size, scale = file.readline(), file.readline().split(), float(file.readline())
        values = array.array("f", file.read())
        if scale > 0:
            values.byteswap()
    w, h = int(size[0]), int(size[1])
    return [[values[(h - 1 - y) * w + x] for x in range(w)] for y in range(h)]

def near(a, b, tolerance, what):
    assert abs(a - b) <= tolerance, (what, a, b)

c = {n: read("camera.%s.pfm" % n) for n in
     "P.X P.Y P.Z N.X N.Y N.Z Ns.X dzdx dzdy Albedo.G u v Variance.G RelativeVariance.G G".split()}
w = {n: read("world.%s.pfm" % n) for n in "P.X P.Y P.Z N.X N.Y N.Z dzdx dzdy".split()}
length = math.sqrt(1.25)
half = math.tan(math.radians(20))

def z_at(x):  # camera: right is -z of the world (left-handed); depth = 4 + 0.5 (z - 3) = 4 - 0.5 right
    return 4 / (1 + 0.5 * x)

for y in range(40):
    for x in range(40):
        sx, sy = half * (2 * (x + 0.5) / 40 - 1), half * (1 - 2 * (y + 0.5) / 40)
        depth = z_at(sx)
        near(c["P.Z"][y][x], depth, 1e-4, "depth")
        near(c["P.X"][y][x], sx * depth, 1e-4, "right")
        near(c["P.Y"][y][x], sy * depth, 1e-4, "up")
        near(w["P.X"][y][x], 1 + depth, 1e-4, "world x")
        near(w["P.Y"][y][x], 2 + sy * depth, 1e-4, "world y")
        near(w["P.Z"][y][x], 3 - sx * depth, 1e-4, "world z")
        for name in ("N", "Ns") if x else ("N",):
            near(c[name + ".X"][y][x], -0.5 / length, 1e-5, "normal, right")
        near(c["N.Z"][y][x], -1 / length, 1e-5, "normal, forward")
        near(c["N.Y"][y][x], 0, 1e-5, "normal, up")
        near(w["N.X"][y][x], -1 / length, 1e-5, "normal, world x")
        near(w["N.Z"][y][x], 0.5 / length, 1e-5, "normal, world z")
        step = 2 * half / 40
        sign = 1 if x < 39 else -1
        slope = 0.25 * abs(z_at(sx + sign * step) - depth)  # 16 samples: a quarter
        near(c["dzdx"][y][x], slope, 1e-4, "dzdx")
        near(c["dzdy"][y][x], 0, 1e-4, "dzdy")
        near(c["Albedo.G"][y][x], 0.3, 1e-3, "albedo")
        near(c["u"][y][x], (3 - sx * depth + 7) / 20, 1e-4, "u")
        near(c["v"][y][x], (2 + sy * depth + 8) / 20, 1e-4, "v")
        near(c["RelativeVariance.G"][y][x], c["Variance.G"][y][x] / c["G"][y][x], 1e-5, "relative variance")
mean = sum(map(sum, c["Variance.G"])) / 1600
assert 1e-6 < mean < 1, mean
CODE
check wall python3 wall.py
check channels_instead "$VELO" render camera.pbrt -o instead.exr --channels Z --quiet
check channels_instead_info "$VELO" image info instead.exr
expect_text channels_instead_names 'channels    5: '
check other_format "$VELO" render camera.pbrt -o wall.png --quiet
expect_text other_format_warns 'gbuffer: wall.png cannot hold it, only .exr can'
check convert "$VELO" scene convert world.pbrt again.pbrt
check again "$VELO" render again.pbrt -o again.exr --quiet
check again_same "$VELO" image diff world.exr again.exr --threshold maxabs=1e-4
finish
