#!/usr/bin/env bash
# Many images of one world: trajectories, rigs, stereo. Each frame equals the image of its camera rendered alone. File
# names; two views in one OpenEXR file, read by OpenImageIO; errors; interruptions.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt

# ---- a trajectory ----------------------------------------------------------------------------------------------------
cat >transforms.json <<'END'
{"w": 32, "h": 24, "fl_x": 30, "k1": 0.02, "frames": [
 {"file_path": "images/a.png", "transform_matrix": [[1,0,0,0],[0,1,0,1],[0,0,1,4],[0,0,0,1]]},
 {"file_path": "images/b.png", "transform_matrix": [[1,0,0,0.5],[0,1,0,1],[0,0,1,4],[0,0,0,1]]},
 {"file_path": "images/c.png", "w": 40, "transform_matrix": [[0,0,1,4],[0,1,0,1],[-1,0,0,0],[0,0,0,1]]}]}
END
check trajectory "$VELO" render scene.pbrt --trajectory transforms.json -o 'frame_%04d.exr' -o '%n_%d.png' --channels Z,id.object
for i in 0 1 2; do
  name=$(echo abc | cut -c $((i + 1)))
  check "frame_$i" "$VELO" render scene.pbrt --camera transforms.json --frame "$i" -o "one_$i.exr" --channels Z,id.object --quiet
  check "frame_${i}_same" "$VELO" image diff "one_$i.exr" "frame_000$i.exr" --threshold differing=0
  check "frame_${i}_ids" test -s "frame_000$i.exr.ids.json"
  check "frame_${i}_named" test -s "${name}_$i.png"
done
run "$VELO" image info --json frame_0002.exr
expect_text frame_header_name 'images/c.png'
check frame_by_name "$VELO" render scene.pbrt --camera transforms.json --frame images/b.png -o named.exr --channels Z,id.object --quiet
check frame_by_name_same "$VELO" image diff named.exr one_1.exr --threshold differing=0
mkdir part
check some_frames "$VELO" render scene.pbrt --trajectory transforms.json --frames 0-2:2 -o 'part/%d.exr' --quiet
check some_frames_are test "$(ls part | tr '\n' ' ')" = '0.exr 2.exr '
mkdir kept
check shard_of_frames "$VELO" render scene.pbrt --trajectory transforms.json --shard 1/2 -o 'kept/%d.exr' --quiet
check shard_of_frames_are test "$(ls kept | tr '\n' ' ')" = '0.exr 2.exr '
printf kept >kept/0.exr
check skip_existing "$VELO" render scene.pbrt --trajectory transforms.json --skip-existing -o 'kept/%d.exr'
expect_text skip_existing_says '2 frames exist and were left out'
check skip_existing_are test "$(cat kept/0.exr)" = kept -a "$(ls kept | tr '\n' ' ')" = '0.exr 1.exr 2.exr '
check skip_existing_none "$VELO" render scene.pbrt --trajectory transforms.json --skip-existing -o 'kept/%d.exr' --quiet
check skip_existing_each "$VELO" render scene.pbrt --trajectory transforms.json --skip-existing -o 'kept/%d.exr' -o 'kept/%d.png' --quiet
check skip_existing_needs_all test "$(head -c 4 kept/0.exr | tr -d '\0')" != kept -a -s kept/0.png
expect_code 2 skip_existing_alone "$VELO" render scene.pbrt --skip-existing -o a.exr
expect_code 2 shard_metered "$VELO" render scene.pbrt --trajectory transforms.json --shard 1/2 -o 'm_%d.png' --exposure auto
expect_text shard_metered_says 'the first frame would set the exposure: with --shard give --exposure EV'
check shard_metered_exr "$VELO" render scene.pbrt --trajectory transforms.json --shard 1/2 -o 'm_%d.exr' --exposure auto --quiet
check threads_do_not_matter "$VELO" render scene.pbrt --trajectory transforms.json -o 'again_%04d.exr' --channels Z,id.object --quiet -t 1
same threads_same_bytes again_0001.exr frame_0001.exr
check no_left_overs test -z "$(ls | grep tmp)"

# Poses without a camera use the scene's camera, with its crop and samples.
printf 'name,eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z\np,0,1.2,4,0,0.6,0\nq,1,1,4,0,0.6,0\n' >poses.csv
check poses "$VELO" render scene.pbrt --trajectory poses.csv -o '%n.exr' --quiet --spp 3 --crop 5,5,40,30
run "$VELO" image info q.exr
expect_text poses_cropped '35 x 25'
check folders_are_made "$VELO" render scene.pbrt --trajectory poses.csv -o 'made_%n/image.exr' --quiet
check folder_made test -s made_q/image.exr

# ---- a rig -----------------------------------------------------------------------------------------------------------
cat >rig.yaml <<'END'
cam0:
  camera_model: pinhole
  intrinsics: [30, 30, 15.5, 11.5]
  distortion_model: none
  resolution: [32, 24]
cam1:
  camera_model: pinhole
  intrinsics: [40, 40, 19.5, 14.5]
  distortion_model: radtan
  distortion_coeffs: [-0.1, 0, 0, 0]
  resolution: [40, 30]
  T_cn_cnm1:
  - [1, 0, 0, -0.3]
  - [0, 1, 0, 0]
  - [0, 0, 1, 0]
  - [0, 0, 0, 1]
END
printf '0 0 1 4 1 0 0 0\n1 0.2 1 4 1 0 0 0\n' >tum.txt # y and z turned over: looking along -z
check rig "$VELO" render scene.pbrt --trajectory tum.txt --rig rig.yaml -o 'rig_%d_%c.exr' --quiet
check rig_files test "$(ls rig_*_*.exr | tr '\n' ' ')" = 'rig_0_cam0.exr rig_0_cam1.exr rig_1_cam0.exr rig_1_cam1.exr '

# ---- parts of a model's trajectory: all are exposed by its first frame -----------------------------------------------
# A lamp before a wall, and behind it a wall that is far away and dark.
python3 - <<'END'
import base64, json, struct
def quad(z, side):
    p = [(-2, -2, z), (2, -2, z), (2, 2, z), (-2, 2, z)]
    return p if side > 0 else [p[1], p[0], p[3], p[2]]
points = quad(-5, 1) + quad(8, -1)
data = b"".join(struct.pack("<3f", *p) for p in points) + struct.pack("<6H", 0, 1, 2, 0, 2, 3) * 2
def mesh(k):
    return {"primitives": [{"attributes": {"POSITION": k}, "indices": 2}]}
json.dump({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}], "extensionsUsed": ["KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 5000}]}},
    "nodes": [{"mesh": 0}, {"mesh": 1}, {"translation": [0, 0, -3], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "meshes": [mesh(0), mesh(1)],
    "accessors": [{"bufferView": 0, "byteOffset": 48 * k, "componentType": 5126, "count": 4, "type": "VEC3",
                   "min": [-2, -2, (-5, 8)[k]], "max": [2, 2, (-5, 8)[k]]} for k in range(2)] +
                 [{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 24}],
    "buffers": [{"byteLength": 120, "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}, open("two.gltf", "w"))
json.dump({"camera_model": "OPENCV", "w": 32, "h": 24, "fl_x": 30, "fl_y": 30, "cx": 16, "cy": 12, "frames": [
    {"file_path": "a", "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]},
    {"file_path": "b", "transform_matrix": [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]}]}, open("turn.json", "w"))
END
check model_frames "$VELO" render two.gltf --trajectory turn.json -o 'model_%d.png' --spp 4 --quiet
check model_part "$VELO" render two.gltf --trajectory turn.json -o 'part_%d.png' --spp 4 --frames 1 --quiet
same model_part_is_the_same model_1.png part_1.png
check model_shard "$VELO" render two.gltf --trajectory turn.json -o 'shard_%d.png' --spp 4 --shard 2/2 --quiet
same model_shard_is_the_same model_1.png shard_1.png

# ---- stereo ----------------------------------------------------------------------------------------------------------
check stereo "$VELO" render scene.pbrt --stereo off-axis --interocular 0.2 --convergence 4 -o both.exr -o 'eye_%v.exr' -o '%v.png' --channels Z,N --quiet
check two_stereo_files "$VELO" render scene.pbrt --stereo parallel -o two.exr -o three.exr --channels id.object --quiet
same two_stereo_files_same_bytes two.exr three.exr
check both_have_ids test -s two.exr.ids.json -a -s three.exr.ids.json
check stereo_half "$VELO" render scene.pbrt --stereo parallel -o half.exr --half --quiet
check stereo_trajectory "$VELO" render scene.pbrt --trajectory poses.csv --stereo toe-in --convergence 4 -o 'stereo_%d.exr' --quiet
check one_eye "$VELO" render scene.pbrt --stereo off-axis --interocular 0.2 --convergence 4 --eye right -o right.exr --channels Z,N --quiet
check one_eye_same "$VELO" image diff right.exr eye_right.exr --threshold differing=0
expect_code 1 eyes_differ "$VELO" image diff eye_left.exr eye_right.exr --threshold differing=0
check ground_truth "$VELO" render scene.pbrt --stereo toe-in --interocular 0.2 --convergence 4 -o 'ground_truth_%v.exr' --channels all --quiet
check eyes_agree "$VELO" image check ground_truth_left.exr
sed 's/^Camera.*/Camera "equirectangular" "point3 eye" [0 1 2.5] "point3 lookat" [0 1 0]/; /^LookAt/d' scene.pbrt >round.pbrt
check panorama "$VELO" render round.pbrt --stereo ods -o 'ods_%v.exr' --channels all --quiet
check panorama_agrees "$VELO" image check ods_left.exr
check panorama_agrees_right "$VELO" image check ods_right.exr
if /usr/bin/python3 -c 'import OpenImageIO' 2>/dev/null; then
  cat >views.py <<'END'
import OpenImageIO as oiio
import numpy as np


def read(name):
    file = oiio.ImageInput.open(name)
    return file.spec(), file.read_image("float")


spec, both = read("both.exr")
left, right = read("eye_left.exr"), read("eye_right.exr")
names, single = list(spec.channelnames), list(left[0].channelnames)
views = spec.getattribute("multiView")
assert list(views) == ["left", "right"], views
assert set(names) == {"R", "G", "B", "A", "right.R", "right.G", "right.B", "right.A", "Z", "right.Z", "N.left.X",
                      "N.left.Y", "N.left.Z", "N.right.X", "N.right.Y", "N.right.Z"}, names
for plain in "RGBA":
    assert np.array_equal(both[..., names.index(plain)], left[1][..., single.index(plain)]), plain
    assert np.array_equal(both[..., names.index("right." + plain)], right[1][..., single.index(plain)]), plain
assert np.array_equal(both[..., names.index("right.Z")], right[1][..., single.index("Z")])
attribute = {a.name: a.value for a in spec.extra_attribs}
shift = attribute["right.velo.cx"] - attribute["velo.cx"]
assert abs(shift - attribute["velo.fx"] * 0.2 / 4) < 1e-9, shift
half, track = read("half.exr")[0], read("stereo_1.exr")[0]
assert "right.R" in half.channelnames and str(half.format) == "half", half.format
assert "right.R" in track.channelnames
assert right[0].getattribute("view") == "right" or right[0].getattribute("oiio:subimagename") == "right"
END
  check openimageio /usr/bin/python3 views.py
else
  skip openimageio "OpenImageIO's Python module is not installed"
fi

# ---- errors --------- -------------------------------------------------------------------------------------------------
expect_code 2 no_output "$VELO" render scene.pbrt --trajectory poses.csv
expect_text no_output_told "give the files' name with -o"
expect_code 2 twice "$VELO" render scene.pbrt --trajectory poses.csv -o same.exr
expect_text twice_told 'two of the 2 frames would be "same.exr"'
check twice_nothing test ! -e same.exr
expect_code 2 twice_rig "$VELO" render scene.pbrt --trajectory tum.txt --rig rig.yaml -o 'x_%d.exr'
expect_code 2 unknown_sign "$VELO" render scene.pbrt --trajectory poses.csv -o 'x_%5q.exr'
expect_text unknown_sign_told '"%5q" is not known'
expect_code 2 range "$VELO" render scene.pbrt --trajectory poses.csv --frames 1-5 -o 'x_%d.exr'
expect_text range_told 'the trajectory has 2 frames, numbered from 0'
expect_code 2 range_wrong "$VELO" render scene.pbrt --trajectory poses.csv --frames 5-1 -o 'x_%d.exr'
expect_code 2 rig_alone "$VELO" render scene.pbrt --rig rig.yaml -o x.exr
expect_code 3 rig_of_poses "$VELO" render scene.pbrt --trajectory tum.txt --rig poses.csv -o 'x_%d_%c.exr'
expect_code 2 frame_alone "$VELO" render scene.pbrt --frame 3 -o x.exr
expect_code 3 no_such_frame "$VELO" render scene.pbrt --camera transforms.json --frame 7 -o x.exr
expect_code 2 stereo_png "$VELO" render scene.pbrt --stereo parallel -o x.png
expect_text stereo_png_told 'only .exr holds both eyes'
expect_code 2 stereo_alone "$VELO" render scene.pbrt --interocular 0.1 -o x.exr
expect_code 3 stereo_screen "$VELO" render scene.pbrt --stereo off-axis -o x.exr
expect_text stereo_screen_told 'scene.pbrt:2:1: camera: off-axis stereo needs the distance where the eyes converge'
printf 'tx,ty,tz,qx,qy,qz,qw\n0,0,0,0,0,0,1\n0,nan,0,0,0,0,1\n' >bad.csv
expect_code 3 bad_pose "$VELO" render scene.pbrt --trajectory bad.csv -o 'x_%d.exr'
expect_text bad_pose_told 'bad.csv:3:1: frame 1: "ty" is "nan"'
expect_code 4 no_trajectory "$VELO" render scene.pbrt --trajectory no.csv -o 'x_%d.exr'
check nothing_written test -z "$(ls x* 2>/dev/null)"

# A frame that cannot be written (its target is a folder) does not stop the others.
mkdir hole_0.exr
expect_code 5 hole "$VELO" render scene.pbrt --trajectory poses.csv -o 'hole_%d.exr'
check others_written test -s hole_1.exr

# Interrupted: files that were written stay whole, the others are missing, the exit code is not 0.
python3 -c '
print("eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z")
for i in range(5000): print(f"{i / 5000},1,4,0,0.6,0")' >long.csv
mkdir long
"$VELO" render scene.pbrt --trajectory long.csv -o 'long/%d.exr' --quiet &
pid=$!
for _ in $(seq 100); do
  [ "$(ls long | wc -l)" -gt 5 ] && break
  sleep 0.1
done
kill -TERM "$pid"
wait "$pid"
code=$?
check interrupted_code test "$code" = 143
check interrupted_some test "$(ls long | wc -l)" -gt 4 -a "$(ls long | wc -l)" -lt 5000
check interrupted_whole test -z "$(ls long | grep tmp)"
check interrupted_readable "$VELO" image info long/3.exr
finish
