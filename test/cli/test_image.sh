#!/usr/bin/env bash
# velo image info, diff and convert, on images whose values are known.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

# PFM: rows from the bottom, little endian. All pixels of an image of w x h are r g b.
flat() { python3 -c '
import struct, sys
name, w, h, *rgb = sys.argv[1:]
w, h = int(w), int(h)
with open(name, "wb") as f:
    f.write(b"PF\n%d %d\n-1.0\n" % (w, h))
    f.write(struct.pack("<3f", *map(float, rgb)) * (w * h))' "$@"; }
flat a.pfm 16 8 0.5 0.5 0.5
flat b.pfm 16 8 0.6 0.6 0.6
flat small.pfm 8 8 0.5 0.5 0.5
flat nan.pfm 16 8 nan 0.5 0.5

check info "$VELO" image info a.pfm
expect_text info_size "16 x 8"
expect_text info_format "PFM"
run "$VELO" image info a.pfm --json
if printf '%s' "$out" | python3 -c '
import json, sys
a = json.load(sys.stdin)
assert (a["width"], a["height"], a["channels"], a["format"]) == (16, 8, ["R", "G", "B"], "PFM"), a'; then pass info_json; else fail info_json; show info; fi
expect_code 4 info_missing "$VELO" image info none.exr
printf 'nothing' >broken.exr
expect_code 3 info_broken "$VELO" image info broken.exr

run "$VELO" image diff a.pfm b.pfm --json -o heat.png
if printf '%s' "$out" | python3 -c '
import json, math, sys
d = json.load(sys.stdin)
def near(name, value, tolerance=1e-5): assert abs(d[name] - value) <= tolerance * abs(value), (name, d[name], value)
near("mse", 0.01)
near("relmse", 0.01 / (0.25 + 0.01))
near("psnr", 20.0)
near("meanratio", 1.2)
near("maxabs", 0.1)
assert d["differing"] == 128 and d["notfinite"] == 0 and 0 < d["flip"] < 1, d'; then pass diff_values; else fail diff_values; show diff; fi
[ "$code" = 0 ] && pass diff_exit_code || fail diff_exit_code
check heat_is_a_image "$VELO" image info heat.png
expect_text heat_size "16 x 8"
run "$VELO" image diff a.pfm a.pfm --json
if printf '%s' "$out" | python3 -c '
import json, sys
d = json.load(sys.stdin)
assert d["mse"] == 0 and d["flip"] == 0 and d["meanratio"] == 1 and d["differing"] == 0, d'; then pass diff_equal; else fail diff_equal; show diff; fi
check threshold_kept "$VELO" image diff a.pfm b.pfm --threshold mse=0.011 --threshold psnr=19.9 --threshold meanratio=0.21
expect_code 1 threshold_mse "$VELO" image diff a.pfm b.pfm --threshold mse=0.009
expect_text threshold_says_which "mse is 0.01"
expect_code 1 threshold_psnr "$VELO" image diff a.pfm b.pfm --threshold psnr=21
expect_code 1 threshold_meanratio "$VELO" image diff a.pfm b.pfm --threshold meanratio=0.19
expect_code 1 threshold_differing "$VELO" image diff a.pfm b.pfm --threshold differing=0
expect_code 1 threshold_notfinite "$VELO" image diff a.pfm nan.pfm --threshold notfinite=0
expect_code 3 diff_sizes "$VELO" image diff a.pfm small.pfm
expect_code 4 diff_missing "$VELO" image diff a.pfm none.pfm

# Light to display values: sRGB's curve; and the exposure doubles the light.
check convert_png "$VELO" image convert a.pfm a.png
check convert_brighter "$VELO" image convert a.pfm bright.png --exposure 1
check convert_back "$VELO" image convert bright.png bright.pfm
flat one.pfm 16 8 1 1 1
run "$VELO" image diff one.pfm bright.pfm --threshold maxabs=0.004
[ "$code" = 0 ] && pass exposure_doubles || { fail exposure_doubles; show diff; }
for suffix in exr hdr pfm png tga jpg; do
  check "convert_to_$suffix" "$VELO" image convert a.pfm "c.$suffix"
  check "convert_from_$suffix" "$VELO" image convert "c.$suffix" d.pfm
  run "$VELO" image diff a.pfm d.pfm --threshold maxabs=0.006
  [ "$code" = 0 ] && pass "round_trip_$suffix" || { fail "round_trip_$suffix"; show diff; }
done
check convert_half "$VELO" image convert b.pfm half.exr --half
run "$VELO" image info half.exr
expect_text half_type "16-bit float"
check convert_crop "$VELO" image convert a.pfm crop.exr --crop 2,3,10,8
run "$VELO" image info crop.exr
expect_text crop_size "8 x 5"
expect_code 2 crop_outside "$VELO" image convert a.pfm crop.exr --crop 2,3,17,8
expect_code 2 convert_suffix "$VELO" image convert a.pfm a.txt

# Equal colours through eight bits and back keep their values.
check eight_bit_again "$VELO" image convert a.png again.png
run "$VELO" image diff a.png again.png --threshold differing=0
[ "$code" = 0 ] && pass eight_bit_kept || { fail eight_bit_kept; show diff; }
finish
