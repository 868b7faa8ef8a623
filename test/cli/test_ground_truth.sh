#!/usr/bin/env bash
# Cryptomatte, modes, flow, boxes, standard errors through the program; and `velo image check` notices what is changed.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
write_scene a.pbrt
sed 's/^LookAt.*/LookAt 0.8 1.4 3.7  0.1 0.6 0  0.1 1 0/' a.pbrt >b.pbrt
list=all,crypto,error
check render_a "$VELO" render a.pbrt -o a.exr --channels $list --flow-camera b.pbrt --boxes --quiet
check render_b "$VELO" render b.pbrt -o b.exr --channels $list --flow-camera-before a.pbrt --quiet
check plain "$VELO" render a.pbrt -o plain.exr --quiet
check image_is_untouched "$VELO" image diff plain.exr a.exr --threshold differing=0
check a_agrees "$VELO" image check a.exr --flow b.exr
check b_agrees "$VELO" image check b.exr --flow-before a.exr
for mode in nearest coverage; do
  check "render_$mode" "$VELO" render a.pbrt -o $mode.exr --channels all,crypto --channels-mode $mode --quiet --crop 3,5,60,44
  check "${mode}_agrees" "$VELO" image check $mode.exr
done
check render_threads "$VELO" render a.pbrt -o again.exr --channels $list --flow-camera b.pbrt --boxes --quiet -t 3
same same_bytes a.exr again.exr
check render_ranks "$VELO" render a.pbrt -o ranks.exr --channels crypto.object --crypto-ranks 2 --quiet
check ranks_agree "$VELO" image check ranks.exr

# Each channel that something else depends on: a change of a part in 100000 is found.
mutate=$VELO_BINARY_DIR/bin/helper_mutate
if [ -x "$mutate" ]; then
  for channel in Z distance.Y P.X P.Y P.Z N.Y Ng.Y ray.X ray.Z film.X id.object.Y id.material.Y samples.Y forward.U \
    forward.V forward.hidden.Y CryptoObject00.R CryptoObject00.G CryptoMaterial00.R CryptoMaterial00.G A; do
    check "change_$channel" "$mutate" a.exr changed.exr "$channel" 1.00001
    expect_code 1 "notices_$channel" "$VELO" image check changed.exr --flow b.exr
  done
  check "change_nothing" "$mutate" a.exr changed.exr Z 1
  check "nothing_changed" "$VELO" image check changed.exr --flow b.exr
else
  skip mutations "helper_mutate is not built"
fi

cat >boxes.py <<'CODE'
import json

ids = json.load(open("a.exr.ids.json"))
for o in ids["objects"].values():
    x, y, w, h = o["box"]
    X, Y, W, H = o["amodal_box"]
    assert X <= x and Y <= y and x + w <= X + W and y + h <= Y + H, o
    assert 0 <= o["occluded"] < 1 and o["pixels"] <= o["amodal_pixels"] <= W * H, o
    assert all(a <= b for a, b in zip(o["box3d"]["low"], o["box3d"]["high"])), o
    if "outline_box" in o:
        u, v, a, b = o["outline_box"]
        assert max(u, 0) - 0.5 <= X + 1e-6 and X + W <= min(u + a, 64) + 0.5, o
assert sum(o["pixels"] for o in ids["objects"].values()) <= 64 * 48
CODE
check boxes python3 boxes.py

# Without another camera: flow over the shutter's time, seen when --channels-time says. The sphere goes 0.5 to the right.
cat >moving.pbrt <<'END'
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float shutteropen" 0 "float shutterclose" 1
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
TransformTimes 0 1
WorldBegin
AttributeBegin
ActiveTransform EndTime
Translate 0.5 0 0
ActiveTransform All
Shape "sphere" "float radius" 0.5
AttributeEnd
END
for moment in open middle close 0.25; do
  check "shutter_flow_$moment" "$VELO" render moving.pbrt --spp 1 --quiet --channels Z,P,N,ray,distance,id.object,forward,backward \
    --channels-time "$moment" -o moving.exr
  check "shutter_flow_${moment}_check" "$VELO" image check moving.exr
  "$VELO" image convert moving.exr forward.pfm --channel forward.U && "$VELO" image convert moving.exr backward.pfm --channel backward.U
  check "shutter_flow_${moment}_is" python3 -c '
import array, sys
share = {"open": 0, "middle": 0.5, "close": 1}.get(sys.argv[1], 0.25)
for name, wanted in (("forward.pfm", 3.28 * (1 - share)), ("backward.pfm", -3.28 * share)):
    data = open(name, "rb").read().split(b"\n", 3)[3]
    moved = [v for v in array.array("f", data) if abs(v) > 0.1]
    got = sum(moved) / len(moved) if moved else 0
    assert abs(got - wanted) < 0.05, (name, got, wanted)' "$moment"
done
# A moving object's flow to another camera, whose exposure is later: it cannot be checked, and the pixels are counted.
sed 's/shutteropen" 0 "float shutterclose" 1/shutteropen" 1 "float shutterclose" 2/' moving.pbrt >later.pbrt
check moving_flow "$VELO" render moving.pbrt --spp 1 --quiet --channels P,distance,id.object,id.instance,forward --channels-time open -o from.exr --flow-camera later.pbrt
check later_image "$VELO" render later.pbrt --spp 1 --quiet --channels distance,id.object,id.instance -o to.exr
expect_code 1 moving_flow_is_not_checked "$VELO" image check from.exr --flow to.exr
expect_text moving_pixels 'leads elsewhere than in a world at rest'
expect_code 2 channels_time_word "$VELO" render a.pbrt -o no.exr --channels Z --channels-time opn
expect_text says_how 'row, open, middle, close or seconds'
expect_code 2 odd_ranks "$VELO" render a.pbrt -o no.exr --channels crypto --crypto-ranks 5
expect_code 2 unknown_mode "$VELO" render a.pbrt -o no.exr --channels all --channels-mode neares
expect_text near_mode 'nearest'
expect_code 3 no_flow_in_file "$VELO" image check plain.exr --flow b.exr
check nothing_written test ! -e no.exr
# Points that are far aside of the other camera but hardly before it: a rounding of P moves their pixel far. With P alone,
# pixels without a surface are those whose P is zero.
lecture=$VELO_SOURCE_DIR/scenes/lecture
for pair in 150_100 200_150; do
  "$VELO" render "$lecture/eye_${pair#*_}.pbrt" --channels distance,P --spp 1 --quiet -o to.exr
  for channels in forward,P,Z,distance forward,P; do
    "$VELO" render "$lecture/eye_${pair%_*}.pbrt" --channels $channels --spp 1 --quiet -o from.exr \
      --flow-camera "$lecture/eye_${pair#*_}.pbrt"
    check "flow_near_the_other_eye_${pair}_$channels" "$VELO" image check from.exr --flow to.exr
  done
done
finish
