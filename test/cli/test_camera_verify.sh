#!/usr/bin/env bash
# velo camera verify: images and equations agree for all kinds of cameras; cameras that differ are told apart.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1

# opencv FILE FX CX K1 [MORE]
opencv() {
  cat >"$1" <<YAML
image_width: 320
image_height: 240
camera_matrix: [[$2, 0, $3], [0, 255, 119.5], [0, 0, 1]]
distortion_coefficients: [$4]
$5
YAML
}

# verify NAME CAMERA [OPTIONS]: few poses, few samples, so that the threshold is the noise's.
verify() {
  local name=$1 camera=$2
  shift 2
  check "$name" "$VELO" camera verify --camera "$camera" --poses 4 --spp 64 --threshold 0.12 "$@"
  [ "$code" = 0 ] || printf '%s\n' "$out"
}

pose='rvec: [0.1, -0.4, 0.3]
tvec: [1, 2, 3]'
opencv cam.yaml 250 159.5 "-0.28, 0.07, 0.001, -0.002, 0.01" "$pose"
verify pinhole cam.yaml
expect_text pinhole_passed "passed: no corner is off"
opencv tilted.yaml 250 159.5 "-0.2, 0.07, 1e-3, -2e-3, 0.01, 0.02, -0.01, 0.003, 1e-3, -5e-4, 2e-3, 3e-4, 0.03, -0.02"
verify fourteen tilted.yaml
opencv fisheye.yaml 110 159.5 "0.03, -0.02, 0.004, -0.0003" "distortion_model: fisheye"
verify fisheye fisheye.yaml
verify charuco cam.yaml --target charuco
expect_text charuco_read " 0 wrong"
for model in unified eucm double_sphere division panini equirectangular cube cylindrical equal_area equidistant equisolid stereographic fov orthographic_fisheye \
  vignetting moving rolling lens_tilt; do
  verify "$model" "$VELO_SOURCE_DIR/scenes/cameras/$model.pbrt"
done

film='Film "rgb" "integer xresolution" 240 "integer yresolution"'
echo "Camera \"cube\" \"string layout\" \"cross\" ${film/240/640} 480 WorldBegin" >cross.pbrt
verify cross cross.pbrt
echo "Camera \"pinhole\" \"float fov\" 80 \"float exposuretime\" .001 $film 160 WorldBegin" >dark.pbrt
verify dark dark.pbrt

# Another camera: half a pixel, another focal length, another pose.
opencv half.yaml 250 160 "-0.28, 0.07, 0.001, -0.002, 0.01" "$pose"
few="--poses 2 --spp 36"
# shellcheck disable=SC2086
expect_code 1 half_a_pixel "$VELO" camera verify --camera half.yaml --against cam.yaml $few
expect_text half_a_pixel_named "half a pixel"
opencv longer.yaml 250.5 159.5 "-0.28, 0.07, 0.001, -0.002, 0.01" "$pose"
# shellcheck disable=SC2086
expect_code 1 focal_length "$VELO" camera verify --camera longer.yaml --against cam.yaml $few --threshold 0.12
check convert "$VELO" camera convert cam.yaml cam.json
verify converted cam.json --against cam.yaml
opencv unposed.yaml 250 159.5 "-0.28, 0.07, 0.001, -0.002, 0.01"
# shellcheck disable=SC2086
expect_code 1 pose "$VELO" camera verify --camera cam.yaml --against unposed.yaml $few
verify ignore_pose cam.yaml --against unposed.yaml --ignore-pose

check json sh -c '"$0" camera verify --camera cam.yaml --poses 2 --spp 64 --threshold 0.2 --json | python3 -m json.tool' "$VELO"
expect_text json_passed '"passed": true'
check keep "$VELO" camera verify --camera cam.yaml --poses 2 --spp 64 --threshold 0.2 --keep kept
expect_code 0 kept_images test -s kept/pose_001.png
expect_code 0 kept_corners grep -q '^1,[1-9],' kept/corners.csv

# A camera through which no board can be seen: a fold right at the axis.
opencv blind.yaml 250 159.5 "-4000, 0, 0, 0, 0"
expect_code 1 blind "$VELO" camera verify --camera blind.yaml $few
expect_text blind_words "FAILED: the camera sees nothing"
expect_code 2 no_camera "$VELO" camera verify
expect_code 2 lone_option "$VELO" camera verify --camera cam.yaml --ignore-pose
expect_code 4 missing "$VELO" camera verify --camera nothing.yaml
expect_code 5 no_folder "$VELO" camera verify --camera cam.yaml --keep no/folder
finish
