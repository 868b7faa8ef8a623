#!/usr/bin/env bash
# velo camera vanishing: what it prints, what it draws, the camera back from its points, wrong calls.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
lecture=$VELO_SOURCE_DIR/scenes/lecture
check one "$VELO" camera vanishing "$lecture/perspective_one_point.pbrt"
expect_text one_kind "one-point perspective"
expect_text one_point "z             240 180"
check two "$VELO" camera vanishing "$lecture/perspective_two_point.pbrt"
expect_text two_kind "two-point perspective"
check three "$VELO" camera vanishing "$lecture/perspective_three_point.pbrt" --json
expect_text three_kind '"kind": "three-point perspective"'
printf '%s' "$out" >three.json
# There and back: the printed points give the scene's camera.
cat >back.py <<'CODE'
import json, subprocess, sys
velo, scene = sys.argv[1:3]
v = json.load(open("three.json"))["vanishing_points"]
ask = lambda *a: json.loads(subprocess.run([velo, "camera", *a], capture_output=True, text=True, check=True).stdout)
points = [",".join("%.17g" % n for n in v[a]["pixel"]) for a in "xyz"]
axes = "".join(("-" if v[a]["end"] == "negative" else "") + a for a in "xyz")
camera = ask("vanishing", "--from", *points, "--size", "480x360", "--axes", axes, "--json", "-o", "back.yaml")
truth = ask("info", "--json", scene)
assert abs(camera["focal"] - truth["fx"]) < 1e-9 * truth["fx"], camera
assert abs(camera["cx"] - 240) < 1e-9 * truth["fx"] and abs(camera["cy"] - 180) < 1e-9 * truth["fx"], camera
for i in range(12):
    if i % 4 != 3:
        assert abs(camera["world_from_camera"][i] - truth["world_from_camera"][i]) < 1e-9, i
CODE
check there_and_back python3 back.py "$VELO" "$lecture/perspective_three_point.pbrt"
check writes_a_camera "$VELO" camera info back.yaml
check two_points "$VELO" camera vanishing --from -100,200 900,200 --size 640x480 --principal 320,200
expect_text two_points_focal "focal length  493.558507170122"

# Drawings: red where lines to x run, nothing else is touched.
check render "$VELO" render "$lecture/perspective_two_point.pbrt" --resolution 240x180 --spp 1 --quiet -o a.png
check overlay "$VELO" camera vanishing "$lecture/perspective_two_point.pbrt" --overlay a.png -o b.png --lines 6
check nothing "$VELO" camera vanishing "$lecture/perspective_two_point.pbrt" --overlay a.png -o c.png --lines 0 --up 0,0,1
check cut "$VELO" image convert a.png e.png --crop 0,0,240,160
check grid "$VELO" camera vanishing "$VELO_SOURCE_DIR/scenes/cameras/equidistant.pbrt" --overlay e.png -o d.png --grid 1
cat >drawn.py <<'CODE'
import numpy, OpenImageIO as oiio
a, b = (oiio.ImageBuf(f).get_pixels(oiio.FLOAT)[:, :, :3] for f in ("a.png", "b.png"))
changed = numpy.abs(a - b).max(axis=2) > 0.02
share = changed.mean()
assert 0.03 < share < 0.6, share
row = b[90]  # the horizon, level through the middle: yellow
assert (row[:, 0] > 0.7).all() and (row[:, 0] - row[:, 2]).mean() > 0.3, row
assert not changed[5:8].all()
CODE
if /usr/bin/python3 -c 'import OpenImageIO' 2>/dev/null; then check drawn /usr/bin/python3 drawn.py; else skip drawn "no OpenImageIO"; fi

expect_code 2 no_output "$VELO" camera vanishing "$lecture/pinhole.pbrt" --overlay a.png
expect_code 2 exr_output "$VELO" camera vanishing "$lecture/pinhole.pbrt" --overlay a.png -o b.exr
expect_code 3 other_shape "$VELO" camera vanishing "$lecture/pinhole.pbrt" --overlay e.png -o b.png
expect_line other_shape_words "another shape"
expect_code 3 acute "$VELO" camera vanishing --from 900,200 800,200 --size 640x480
expect_line acute_words "less than 90 degrees apart"
expect_code 3 line "$VELO" camera vanishing --from -900,200 800,200 100,200 --size 640x480
expect_line line_words "on one line"
expect_code 2 one_point "$VELO" camera vanishing --from 900,200 --size 640x480
expect_code 2 no_size "$VELO" camera vanishing --from 900,200 -5,7
expect_code 2 no_number "$VELO" camera vanishing --from 900,nan -5,7 --size 640x480
expect_code 2 same_axes "$VELO" camera vanishing --from 900,1 -5,7 --size 640x480 --axes q
expect_code 4 missing "$VELO" camera vanishing none.yaml
finish
