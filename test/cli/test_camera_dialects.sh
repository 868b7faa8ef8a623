#!/usr/bin/env bash
# velo camera convert through every dialect, images and scenes as cameras, and wrong files: exit codes, one clear line.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

cat >cam.json <<'JSON'
{"velo_camera": 1, "name": "left", "width": 640, "height": 480, "fx": 500, "fy": 500, "cx": 330, "cy": 236,
 "eye": [1, 2, 5], "lookat": [0, 0.5, 0], "up": [0, 1, 0]}
JSON
printf '0,0,0\n1,0.5,-1\n-2,1,0.25\n' >points.csv
"$VELO" camera project --camera cam.json points.csv >wanted.csv
cat >near.py <<'CODE'
import sys
a, b = ([[float(v) for v in line.split(",")] for line in open(f).read().split()[1:]] for f in sys.argv[1:3])
assert len(a) == len(b) == 3 and all(abs(x - y) < float(sys.argv[3]) for p, q in zip(a, b) for x, y in zip(p, q)), (a, b)
CODE
# lands NAME CAMERA ERROR: the points fall through that camera to where wanted.csv says.
lands() {
  "$VELO" camera project --camera "$2" points.csv >lands.csv 2>err
  check "$1" python3 near.py wanted.csv lands.csv "$3"
}
for to in velo:json opencv:yaml mitsuba:xml usd:usda opengl:json vulkan:json d3d:json nerf:json blender:json pbrt:pbrt; do
  name=${to%%:*} file=out_${to%%:*}.${to##*:}
  check "convert_$name" "$VELO" camera convert cam.json "$file" --to "$name"
  # pbrt's parameters are single precision
  lands "lands_$name" "$file" "$([ "$name" = pbrt ] && echo 1e-3 || echo 1e-9)"
  check "back_$name" "$VELO" camera convert "$file" back.yaml --to opencv
done
expect_code 3 gltf_refuses "$VELO" camera convert cam.json cam.gltf
expect_line gltf_refuses_words 'gltf cannot hold this camera'"'"'s "cx"'
check gltf_drops "$VELO" camera convert cam.json cam.gltf --drop cx --drop cy
"$VELO" camera project --camera cam.gltf points.csv >gltf.csv
check gltf_extras cmp wanted.csv gltf.csv
python3 - <<'CODE'
import json
g = json.load(open("cam.gltf"))
del g["cameras"][0]["extras"]
json.dump(g, open("plain.gltf", "w"))
CODE
check gltf_size "$VELO" camera info plain.gltf
expect_text gltf_size_words 'names no image size; 960 x 720 is taken'

# An image's header, and a scene's camera with a window of its own.
write_scene scene.pbrt
check render "$VELO" render scene.pbrt --spp 1 --quiet -o a.exr
check exr_info "$VELO" camera info a.exr
expect_text exr_info_words "a.exr (exr)"
# pbrt's LookAt makes a left-handed world: to OpenCV it is seen in a mirror
expect_code 3 exr_mirror "$VELO" camera convert a.exr a.yaml --to opencv
expect_line exr_mirror_words 'opencv cannot hold this camera'"'"'s "mirror"'
check exr_convert "$VELO" camera convert a.exr a.yaml --to opencv --drop mirror
"$VELO" camera project --camera scene.pbrt points.csv >wanted.csv
lands exr_lands a.exr 1e-9
check exr_render "$VELO" render scene.pbrt --camera a.exr --spp 1 --quiet -o b.exr
check exr_render_same "$VELO" image diff a.exr b.exr --threshold mse=1e-12
expect_code 3 exr_write "$VELO" camera convert cam.json c.exr --to exr
expect_line exr_write_words 'written with its image'
{ echo Scale -1 1 1; sed 's/"float fov" \[40\]/"float screenwindow" [-0.5 1.1 -0.4 0.8]/' scene.pbrt; } >window.pbrt
check window_convert "$VELO" camera convert window.pbrt window.yaml --to opencv
"$VELO" camera project --camera window.pbrt points.csv >wanted.csv
lands window_lands window.yaml 1e-9
# fov 90 degrees: the window is that of the plane at distance 1; OpenCV's first pixel is centred at (0, 0)
check window_axis python3 -c '
import re
text = open("window.yaml").read()
m = [float(v) for v in re.search(r"camera_matrix.*?data: \[(.*?)\]", text, re.S)[1].split(",")]
for got, wanted in ((m[0], 64 / 1.6), (m[4], 48 / 1.2), (m[2], 20 - 0.5), (m[5], 32 - 0.5)):
    assert abs(got - wanted) < 1e-5, (got, wanted)'

# An independent reader: a point times worldToNDC is where velo projects it.
if command -v oiiotool >/dev/null; then
  oiiotool --info -v a.exr >oiio.txt
  "$VELO" camera project --camera scene.pbrt points.csv >wanted.csv
  cat >ndc.py <<'CODE'
import re
text = open("oiio.txt").read()
m = [float(v) for v in re.search(r"worldtoscreen: (.*)|worldToNDC: (.*)", text, re.I).group(0).split(":")[1].replace(",", " ").split()]
for point, line in zip(open("points.csv"), open("wanted.csv").read().split()[1:]):
    p, (u, v, *_) = [float(x) for x in point.split(",")] + [1], [float(x) for x in line.split(",")]
    q = [sum(p[r] * m[4 * r + c] for r in range(4)) for c in range(4)]
    x, y = q[0] / q[3], q[1] / q[3]
    assert abs(x * 64 - u) < 0.01 and abs(y * 48 - v) < 0.01, (x * 64, y * 48, u, v)
CODE
  check oiio_ndc python3 ndc.py
else
  skip oiio_ndc "oiiotool is not installed"
fi

# wrong NAME FILE WORDS TEXT: a file of that text (as printf has it) is refused in one line with those words.
wrong() {
  # shellcheck disable=SC2059
  printf "$4" >"$2"
  expect_code 3 "$1" "$VELO" camera info "$2"
  expect_line "$1_words" "$3"
}
wrong xml_entities bad.xml 'bad.xml:1:1: a document type' '<!DOCTYPE a [<!ENTITY b "c">]><scene>&b;</scene>'
wrong xml_type bad.xml 'bad.xml:2:1: mitsuba: unknown sensor "perspectiv"; the nearest is "perspective"' \
  '<scene>\n<sensor type="perspectiv"/></scene>'
wrong json_cut bad.gltf 'bad.gltf:1:' '{"asset": {}, "nodes": ['
wrong usd_huge bad.usda 'no finite number' '#usda 1.0\ndef Camera "a" {\n float focalLength = 1e999\n}\n'
wrong velo_huge bad.json 'too far apart' \
  '{"velo_camera": 1, "width": 4, "height": 3, "eye": [1e308, 0, 0], "lookat": [-1e308, 0, 0]}'
wrong velo_zero bad.json '"fx" must be a number above 0; it is 0' '{"velo_camera": 1, "width": 4, "height": 3, "fx": 0}'
wrong bad_image bad.exr 'bad.exr' 'x'
expect_code 4 missing "$VELO" camera info none.usda
expect_code 4 missing_image "$VELO" camera info none.exr
expect_code 3 wrong_dialect "$VELO" camera convert out_usd.usda x.yaml --from mitsuba
expect_line wrong_dialect_words 'usd, not of mitsuba'
finish
