#!/usr/bin/env bash
# velo camera project, unproject, info, convert; velo render with camera files. Exit codes, and one clear line for each
# wrong camera.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

# write_opencv FILE FX K1 [MORE]: 640 x 480, the axis through the image's centre.
write_opencv() {
  cat >"$1" <<YAML
%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ $2, 0., 319.5, 0., 500., 239.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ $3, 0., 0., 0., 0. ]
$4
YAML
}

# expect_line NAME TEXT: the last command said one line on stderr, with TEXT in it.
expect_line() {
  expect_text "$1" "$2"
  if [ "$(printf '%s\n' "$err" | wc -l)" = 1 ]; then pass "$1_one_line"; else fail "$1_one_line"; show "the last one"; fi
}

write_opencv cam.yaml 500. 0.
printf 'x,y,z\n0,0,2\n0.4,-0.2,2\n\n# behind\n0,0,-1\n' >points.csv
check project "$VELO" camera project --camera cam.yaml points.csv
if [ "$out" = "u,v,z,valid,inside
320,240,2,1,1
420,190,2,1,1
0,0,0,0,0" ]; then pass project_numbers; else fail project_numbers; show "the last one"; fi
check project_center "$VELO" camera project --camera cam.yaml --pixel-origin center points.csv
expect_text project_center_numbers "419.5,189.5,2,1"
check project_stdin sh -c 'echo 0.4,-0.2,2 | "$0" camera project --camera cam.yaml -' "$VELO"
expect_text project_stdin_numbers "420,190,2,1"
printf '420,190\n' >pixels.csv
check unproject "$VELO" camera unproject --camera cam.yaml pixels.csv
expect_text unproject_numbers "0,0,0,0.195180014589706"

check info "$VELO" camera info cam.yaml
expect_text info_focal "f in pixels   500, 500"
expect_text info_fov "65.2384"
check info_json sh -c '"$0" camera info --json cam.yaml | python3 -m json.tool' "$VELO"
expect_text info_json_size '"width": 640'
# The solid angle of a rectangle, of spheres and of hemispheres: cam.yaml's edges lie 320 and 240 from the axis.
check info_solid_angles python3 - "$VELO" "$VELO_SOURCE_DIR/scenes/cameras" <<'END'
import json, math, subprocess, sys
rectangle = 4 * math.atan(320 * 240 / (500 * math.sqrt(500**2 + 320**2 + 240**2)))
for path, angle, error in [("cam.yaml", rectangle, 1e-5), ("equirectangular", 4 * math.pi, 1e-5), ("equal_area", 4 * math.pi, 1e-5),
                           ("cube", 4 * math.pi, 1e-5), ("equidistant", 2 * math.pi, 1e-4), ("orthographic_fisheye", 2 * math.pi, 2e-3)]:
    if "." not in path:
        path = f"{sys.argv[2]}/{path}.pbrt"
    done = subprocess.run([sys.argv[1], "camera", "info", "--json", path], capture_output=True, check=True)
    got = json.loads(done.stdout)["solid_angle"]
    assert abs(got / angle - 1) < error, (path, got, angle)
END

mkdir -p model
check convert_colmap_folder "$VELO" camera convert cam.yaml model --to colmap
mkdir other_model
check convert_to_a_folder "$VELO" camera convert cam.yaml other_model
same convert_to_a_folder_is_colmap model/cameras.txt other_model/cameras.txt
check convert_to_a_file_of_it "$VELO" camera convert cam.yaml other_model/cameras.txt
expect_code 0 colmap_half_pixel grep -q ' 500 500 320 240' model/cameras.txt
check convert_back "$VELO" camera convert model back.yaml
check project_back "$VELO" camera project --camera back.yaml points.csv
expect_text project_back_numbers "420,190,2,1"
check convert_velo "$VELO" camera convert cam.yaml cam.json
check convert_velo_again "$VELO" camera convert cam.json again.json
same velo_is_exact cam.json again.json
write_opencv posed.yaml 500. 0. 'rvec: [0.1, 0.2, 0.3]
tvec: [1, 2, 3]'
expect_code 3 refuse_pose "$VELO" camera convert posed.yaml ros.yaml --to ros
expect_line refuse_pose_words '"pose"'
check drop_pose "$VELO" camera convert posed.yaml ros.yaml --to ros --drop pose
expect_code 2 drop_unknown "$VELO" camera convert posed.yaml ros2.yaml --to ros --drop pose --drop distorsion
expect_line drop_unknown_words 'no camera has a field "distorsion"; the nearest is "distortion"'
check drop_unknown_writes_nothing test ! -e ros2.yaml
expect_code 2 no_dialect "$VELO" camera convert cam.yaml cam.txt
expect_line no_dialect_words "--to"

write_opencv bad.yaml 0. 0.
expect_code 3 focal_zero "$VELO" camera info bad.yaml
expect_line focal_zero_words "fx must be a number above 0; it is 0"
write_opencv bad.yaml 500. 0. 'rvec: [.nan, 0, 0]
tvec: [0, 0, 0]'
expect_code 3 pose_nan "$VELO" camera info bad.yaml
expect_line pose_nan_words '"rvec"'
write_opencv bad.yaml 500. 0. 'distortion_model: fishey'
expect_code 3 unknown_model "$VELO" camera info bad.yaml
expect_line unknown_model_words 'unknown distortion_model "fishey"; the nearest is "fisheye"'
grep -v image_height cam.yaml >bad.yaml
expect_code 3 missing_field "$VELO" camera info bad.yaml
expect_line missing_field_words '"image_height" is missing'
printf 'sensor:\n  focal: 12\nservices: [web]\n' >bad.yaml
expect_code 3 other_tool "$VELO" camera info bad.yaml
expect_line other_tool_words 'no camera of a known dialect'
write_opencv folds.yaml 500. -2.
check folds "$VELO" camera info folds.yaml
expect_line folds_words 'of the image'
expect_code 4 missing_file "$VELO" camera info nothing.yaml
printf '1,2\n' >two.csv
expect_code 3 two_numbers "$VELO" camera project --camera cam.yaml two.csv
expect_line two_numbers_words 'two.csv:1'
printf '0,0,2\n1,2\n0.4,-0.2,2\n0,0,x\n9,0,1\n' >mixed.csv
expect_code 3 bad_lines "$VELO" camera project --camera cam.yaml mixed.csv
expect_text bad_lines_place 'mixed.csv:2:4: a line must hold 3 finite numbers'
expect_text bad_lines_column 'mixed.csv:4:5:'
if [ "$("$VELO" camera project --camera cam.yaml mixed.csv 2>/dev/null)" = "u,v,z,valid,inside
320,240,2,1,1
0,0,0,0,0
420,190,2,1,1
0,0,0,0,0
4820,240,1,1,0" ]; then pass bad_lines_rest; else fail bad_lines_rest; show "the last one"; fi
expect_code 3 strict_line "$VELO" camera project --strict --camera cam.yaml mixed.csv
expect_line strict_line_words 'mixed.csv:2:4'
printf 'Camera "pinhole" "float shutteropen" 0 "float shutterclose" 0 "float readout" 0.02\nWorldBegin\n' >instant.pbrt
check instant_rows "$VELO" camera info instant.pbrt
printf 'camera_matrix: [500, 0, 319.5, 0, 500, 239.5, 0, 0, 1]\ndistortion_coefficients: [0, 0, 0, 0]\n' >sizeless.yaml
expect_code 3 sizeless "$VELO" camera info sizeless.yaml
expect_line sizeless_words 'has no image size'
check sized "$VELO" camera info --size 640x480 sizeless.yaml
expect_code 2 sized_twice "$VELO" camera info --size 64x48 cam.yaml
printf 'just a text\nof some kind\n' >text.dat
expect_code 3 no_yaml "$VELO" camera info text.dat
expect_line no_yaml_words 'no camera'
expect_code 2 no_camera "$VELO" camera project points.csv
expect_line no_camera_words '--camera'

write_scene scene.pbrt
write_opencv small.yaml 500. 0. 'rvec: [3.14159265358979, 0, 0]
tvec: [0, 0.6, 4]'
check render "$VELO" render scene.pbrt --camera small.yaml --resolution 64x48 --spp 1 --quiet -o a.exr
check render_scene_camera "$VELO" camera info scene.pbrt
expect_text render_scene_camera_size "64 x 48"
expect_code 3 render_bad_camera "$VELO" render scene.pbrt --camera bad.yaml --quiet -o a.exr
check render_dry_run "$VELO" render scene.pbrt --camera cam.yaml --dry-run
expect_text render_dry_run_size "640"
finish
