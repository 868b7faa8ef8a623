#!/usr/bin/env bash
# From a scene to a raw file and back: `velo sensor expose` writes a DNG file with the sensor's levels, noise and colour;
# `velo raw develop` finds a white scene white, in the light that the file names and in no other.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1
case "$("$VELO" --version)" in
  *libtiff*) ;;
  *)
    skip "$(basename "$0")" "needs a velo with libtiff"
    finish
    exit
    ;;
esac

for light in D65 A; do
  cat >flat.pbrt <<SCENE
Camera "perspective"
Film "rgb" "integer xresolution" 64 "integer yresolution" 48 "string filename" "flat.exr"
Sampler "independent" "integer pixelsamples" 256
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-$light"
SCENE
  check "$light: render" "$VELO" render flat.pbrt --spectrum 94 --filter box --quiet -o $light.exr
done
expose() { # light, white, name
  check "$3: expose" "$VELO" sensor expose $1.exr --sensor generic_rggb --radiance 1e-3 --exposure-time 0.02 --f-number 2 --iso 100 \
    --focal-length 2000 --white stdillum-$2 -o $3.dng -o $3.png
  check "$3: develop" "$VELO" raw develop $3.dng -o $3.pfm --stop-at color
}
expose D65 D65 day
expose A A bulb
expose A D65 wrong

check info "$VELO" raw info --json day.dng
for text in '"pattern": "RG/GB"' '"exposure_time": 0.02' '"f_number": 2' '"iso": 100' '"focal_length": 2' '"bits": 14' '"white": 16301'; do
  expect_text "the file has $text" "$text"
done
# 4 e- of read noise, in quadrature with .3 dark electrons or so
check "levels and noise" python3 - <<PYTHON
import json, subprocess
raw = json.loads(subprocess.run(["$VELO", "raw", "info", "--json", "day.dng"], capture_output=True, text=True, check=True).stdout)
assert set(raw["black"]) == {512}, raw
assert abs(raw["gain"] - 1 / 3.8) < 1e-6, raw
assert 2 < raw["read_noise"] < 8, raw
PYTHON
means() { # of R, G, B of a PFM file
  python3 - "$1" <<'PYTHON'
import struct, sys
data = open(sys.argv[1], "rb").read()
kind, size, scale, rest = data.split(b"\n", 3)
values = struct.unpack("<%df" % (len(rest) // 4), rest)
print(*("%.6f" % (sum(values[k::3]) / (len(values) / 3)) for k in range(3)))
PYTHON
}
neutral() { python3 -c 'import sys; v = [float(x) for x in sys.argv[1:]]; sys.exit(max(v) / min(v) > 1.02)' $(means "$1"); }
check "day: white is white" neutral day.pfm
check "bulb: white is white" neutral bulb.pfm
if neutral wrong.pfm; then fail "a bulb is yellow in a file that calls daylight white"; else pass "a bulb is yellow in a file that calls daylight white"; fi

check again "$VELO" sensor expose D65.exr --sensor generic_rggb --radiance 1e-3 --exposure-time 0.02 --f-number 2 --iso 100 \
  --focal-length 2000 --white stdillum-D65 -t 1 -o again.dng
check "the same bytes with one thread" cmp day.dng again.dng
expect_code 2 "an unknown white" "$VELO" sensor expose D65.exr --white stdillum-D66 -o a.dng
expect_text "the nearest is named" "stdillum-D60"
finish
