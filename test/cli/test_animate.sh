#!/usr/bin/env bash
# Frames of an animated model and of a camera that goes around it: names, number, one camera and one exposure for all,
# receipts, errors.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
python3 - <<'END'
import base64, json, struct
data = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0) + struct.pack("<2f", 0, 2) + struct.pack("<6f", 0, 0, 0, 4, 0, 0)
json.dump({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [0, 2, 0]}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5, "material": 0}]}], "materials": [{"doubleSided": True}],
  "animations": [{"name": "Walk", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}], "samplers": [{"input": 1, "output": 2}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2]},
                {"bufferView": 0, "byteOffset": 56, "componentType": 5126, "count": 2, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
  "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}, open("walk.gltf", "w"))
END
options="--resolution 32x24 --spp 2"
check frames "$VELO" render walk.gltf --animate 0:2 --fps 2 $options -o f%02d.exr -o f%02d.png --exposure auto
log=$err
check frames_all test "$(ls f*.exr f*.png | tr '\n' ' ')" = "f00.exr f00.png f01.exr f01.png f02.exr f02.png f03.exr f03.png "
check one_exposure test "$(printf '%s' "$log" | grep -c 'exposure')" = 1
check one_camera test "$(printf '%s' "$log" | grep 'no camera in the file' | sort -u | wc -l)" = 1
check alone "$VELO" render walk.gltf --at 1.5 $options -o alone.exr --quiet
check frame_same cmp alone.exr f03.exr
expect_code 1 frames_differ "$VELO" image diff f00.exr f03.exr --threshold differing=0
check again "$VELO" render --again f02.exr -o again.exr --quiet
check again_same cmp again.exr f02.exr
rm f01.exr
# The motion of one exposure, in pbrt's language.
check convert_motion "$VELO" scene convert walk.gltf walk.pbrt --at 0.5:1.5
check convert_times grep -q '^TransformTimes 0 1$' walk.pbrt
check convert_end grep -A9 'ActiveTransform EndTime' walk.pbrt
expect_text convert_way 'ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 3 0 0 1]'
expect_code 2 convert_late "$VELO" scene convert walk.gltf walk.pbrt --at 2:1
expect_code 2 convert_word "$VELO" scene convert walk.gltf walk.pbrt --at 1:
check skip "$VELO" render walk.gltf --animate 0:2 --fps 2 $options -o f%02d.exr --skip-existing
check skip_some test "$(printf '%s' "$err" | grep -c 'wrote f01.exr')$(printf '%s' "$err" | grep -c 'wrote')" = 11
check some "$VELO" render walk.gltf --animate 0:2 --fps 2 --frames 1-3:2 $options -o g%02d.exr
check some_are_those cmp f01.exr g01.exr
check some_are_those_too cmp f03.exr g03.exr
check some_number test "$(ls g*.exr | wc -l)" = 2
# A part has the exposure of the whole; so do the frames that --skip-existing left.
check part_exposure "$VELO" render walk.gltf --animate 0:2 --fps 2 --frames 2-3 $options -o h%02d.png --exposure auto
check part_exposure_same cmp h03.png f03.png
rm f02.png
check skip_exposure "$VELO" render walk.gltf --animate 0:2 --fps 2 $options -o f%02d.png --skip-existing --exposure auto
check skip_exposure_same cmp h02.png f02.png
# All frames have the tracer that the first one's race chose, parts of the animation, too.
raced="--resolution 160x120 --spp 64 --tracer auto"
check race "$VELO" render walk.gltf --turntable 3 $raced -o r%d.exr -o r%d.png
check race_once test "$(printf '%s' "$err" | grep -c '^velo: auto:')" = 1
check race_part "$VELO" render walk.gltf --turntable 3 --frames 1-1 $raced -o s%d.exr -o s%d.png
check race_part_once test "$(printf '%s' "$err" | grep -c '^velo: auto:')" = 1
check race_part_same cmp r1.exr s1.exr
check race_part_display_same cmp r1.png s1.png
check race_again "$VELO" render --again s1.exr -o again.exr
check race_again_same cmp r1.exr again.exr
check race_default "$VELO" render walk.gltf --turntable 2 --resolution 160x120 --spp 64 -o d%d.exr
check race_default_once test "$(printf '%s' "$err" | grep -c '^velo: auto:')" = 1
check race_named "$VELO" render walk.gltf --turntable 2 $raced --tracer volpath -o d%d.exr
check race_named_none test "$(printf '%s' "$err" | grep -c '^velo: auto:')" = 0
expect_code 2 too_many "$VELO" render walk.gltf --animate 0:2 --fps 2 --frames 2-4 $options -o g%02d.exr
check turns "$VELO" render walk.gltf --turntable 4 $options -o t%d.exr
check turns_verbose "$VELO" render walk.gltf --turntable 4 $options -o v%d.exr --verbose
check turns_built_once test "$(printf '%s' "$err" | grep -c 'loaded in')" = 1
check turns_all test "$(ls t?.exr | wc -l)" = 4
check turn "$VELO" render walk.gltf --turn 90 $options -o turn.exr --quiet
check turn_same cmp turn.exr t1.exr
check turned_round "$VELO" render walk.gltf --turn 360 $options -o round.exr --quiet
check round_same "$VELO" image diff round.exr t0.exr --threshold differing=0
expect_code 1 turned_differs "$VELO" image diff t0.exr t1.exr --threshold differing=0
expect_code 2 no_name "$VELO" render walk.gltf --animate 0:2
expect_code 2 no_number "$VELO" render walk.gltf --animate 0:2 -o f.png
expect_text no_number_says "put %04d, the frame's number, into the name"
expect_code 2 no_span "$VELO" render walk.gltf --animate 2 -o f%d.png
expect_code 2 with_at "$VELO" render walk.gltf --animate 0:2 --at 1 -o f%d.png
expect_code 2 with_trajectory "$VELO" render walk.gltf --turntable 4 --trajectory t.csv -o f%d.png
expect_code 3 no_animation "$VELO" render walk.gltf --animate 0:1 --animation Run -o f%d.png
expect_text no_animation_says 'there is no animation "Run" (1 are there: Walk)'
finish
