#!/usr/bin/env bash
# Receipts: an image's header says what made it, --again makes the same bytes again or names what has changed.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
mkdir -p room/parts
cp "$VELO_SOURCE_DIR/scenes/features/textures/leaf.png" room/parts/leaf.png
cp "$VELO_SOURCE_DIR/scenes/features/tetrahedron.ply" room/parts/
{
  sed '/^WorldBegin/q' scene.pbrt
  echo 'LightSource "infinite" "rgb L" [1 1 1]'
  echo 'Texture "leaf" "spectrum" "imagemap" "string filename" "parts/leaf.png"'
  echo 'Material "diffuse" "texture reflectance" "leaf"'
  echo 'Include "parts/more.pbrt"'
} >room/room.pbrt
echo 'Shape "plymesh" "string filename" "tetrahedron.ply"' >room/parts/more.pbrt
render() { "$VELO" render "$@" --quiet; }
again() { "$VELO" render --again "$@" --quiet; }

# The header names the files with the digests of their contents, and nothing that differs between equal runs.
render room/room.pbrt --spp 2 -o one.exr -t 1
render room/room.pbrt -o two.exr -t 3 --isa base --spp 2 --verbose >/dev/null 2>&1 || render room/room.pbrt -o two.exr -t 3 --spp 2
same equal_runs_have_equal_receipts one.exr two.exr
run "$VELO" image info --json one.exr
if printf '%s' "$out" | python3 -c '
import json, sys
a = json.loads(json.load(sys.stdin)["attributes"]["velo.receipt"])
assert a["velo_receipt"] == 1 and a["scene"] == "room/room.pbrt", a
assert [f["path"] for f in a["files"]] == ["parts/leaf.png", "parts/more.pbrt", "parts/tetrahedron.ply", "room.pbrt"], a["files"]
assert a["command"] == ["velo", "render", "room/room.pbrt", "--spp", "2"], a["command"]
assert a["samples"] == a["render"]["spp"] == 2 and a["film"]["width"] == 64, a'; then
  pass header_holds_the_receipt
else
  fail header_holds_the_receipt
  show info
fi
expect_code 0 info "$VELO" image info one.exr
expect_text info_command "  command     velo render room/room.pbrt --spp 2"
expect_text info_samples "  samples     2 per pixel"
expect_text info_files "  files       4"
expect_text info_digest "  parts/leaf.png"
# A shell reads the shown command as it was given; a terminal gets no control characters of it.
odd=$(printf "a\\033[31m b'c")
cp -r room "$odd"
render "$odd/room.pbrt" --spp 1 -o odd.exr
run "$VELO" image info odd.exr
case $out in *"$(printf '\033')"*) fail shown_command_is_plain ;; *) pass shown_command_is_plain ;; esac
command=$(printf '%s\n' "$out" | sed -n 's/^  command  *//p')
if (eval "set -- $command"; [ "$3" = "$odd/room.pbrt" ]); then pass shown_command_is_exact; else fail shown_command_is_exact; fi
# The files are in it, too, where the image has the scene's name, and beside images without a header.
mkdir default
cp -r room default/
(cd default && render room/room.pbrt --spp 2)
run "$VELO" image info default/*.exr
expect_text default_name_has_files "  files       4"
render room/room.pbrt --spp 2 -o beside.png -o beside.exr
run "$VELO" image info beside.exr
expect_text beside_png_has_files "  files       4"
render room/room.pbrt --spp 2 -o none.exr --no-receipt
run "$VELO" image info none.exr
case $out in *velo.receipt* | *parts/*) fail no_receipt ;; *) pass no_receipt ;; esac

# repeat NAME OPTIONS...: the image of these options is made again, byte by byte, elsewhere, too.
repeat() {
  local name=$1
  shift
  render "$@" -o "$name.exr" || fail "${name}_rendered"
  again "$name.exr" -o "$name.again.exr" -t 3 || fail "${name}_again"
  same "$name" "$name.exr" "$name.again.exr"
}
repeat plain room/room.pbrt --spp 3
repeat settings scene.pbrt --spp 2 --tracer bidirectional --sampler halton --seed 7 --filter box --max-depth 3 --color rgb
repeat crop scene.pbrt --spp 2 --resolution 80x50 --crop 5,6,40,31
repeat window scene.pbrt --spp 2 --resolution 80x50 --cropwindow 0.1,0.7,0.2,0.9
repeat channels scene.pbrt --spp 2 --channels all,error,crypto --half
repeat spectrum scene.pbrt --spp 2 --spectrum 5:400:700
repeat lens scene.pbrt --spp 2 --lens-radius 0.1 --focus-pixel 20.5,30.25
repeat eyes scene.pbrt --spp 1 --stereo parallel
repeat left scene.pbrt --spp 1 --stereo parallel --eye left
repeat sky room/parts/tetrahedron.ply --spp 2 --resolution 40x30 --environment sky --ground --environment-rotation 40
repeat time_unused scene.pbrt --spp 2 --time 10m
for scene in motion lens; do
  cp -r "$VELO_SOURCE_DIR/scenes/features" . 2>/dev/null
  repeat "feature_$scene" "features/$scene.pbrt" --spp 1 --resolution 40x30
done
mkdir elsewhere && cp -r room elsewhere/moved
if (cd elsewhere && "$VELO" render moved/room.pbrt --again ../plain.exr -o new.exr --quiet); then
  same moved_scene plain.exr elsewhere/new.exr
else
  fail moved_scene
fi
render scene.pbrt --spp 1 --stereo parallel -o 'eye_%v.exr'
again eye_right.exr -o eye.exr
same one_eye_of_two eye_right.exr eye.exr

# The camera of another file is in the receipt.
cat >camera.json <<'JSON'
{"velo_camera": 1, "width": 50, "height": 40, "fov": 0.7, "eye": [0.1, 1.2, 4], "lookat": [0, 0.6, 0],
 "lens_radius": 0.05, "focus_distance": 3.9}
JSON
repeat other_camera scene.pbrt --spp 2 --camera camera.json --resolution 60x44 --crop 1,2,50,40
rm camera.json
again other_camera.exr -o other.exr
same other_camera_without_its_file other_camera.exr other.exr

# Frames: each is made again by itself.
cat >poses.txt <<'TUM'
0 0 0.6 4 1 0 0 0
1 0.1 0.6 4 1 0 0 0
2 0.2 0.6 4 1 0 0 0
TUM
if render scene.pbrt --spp 1 --trajectory poses.txt -o 'frame_%d.exr'; then
  again frame_1.exr -o frame.exr
  same one_frame frame_1.exr frame.exr
else
  fail frames
fi

# A frame's matrix has the roll of the pose: the receipt holds none beside it.
echo '{"velo_camera": 1, "width": 50, "height": 40, "fov": 0.9, "eye": [0, 0, -5], "lookat": [0, 0, 0], "roll": 0.5}' >rolled.json
render scene.pbrt --spp 1 --camera rolled.json --trajectory poses.txt --frames 0-0 -o 'rolled_%d.exr' 2>/dev/null
if grep -aq '"world_from_camera"' rolled_0.exr && ! grep -aq '"roll"' rolled_0.exr; then
  pass matrix_without_roll
else
  fail matrix_without_roll
fi

cp "$VELO_SOURCE_DIR/test/fuzz/corpus/camera_file/kalibr.yaml" chain.yaml
cp "$VELO_SOURCE_DIR/test/fuzz/corpus/camera_file/nerf.json" transforms.json
render scene.pbrt --spp 1 --trajectory transforms.json --frames 0-0 -o 'own_%d.exr' 2>/dev/null
again own_0.exr -o own.exr
same frame_with_its_own_camera own_0.exr own.exr
render scene.pbrt --spp 1 --trajectory poses.txt --rig chain.yaml -o 'rig_%d_%c.exr' 2>/dev/null
again rig_1_cam0.exr -o rig.exr
same rig_of_one_camera rig_1_cam0.exr rig.exr
python3 - <<'PYTHON'
text = open("chain.yaml").read()
at = text.index("cam0:")
open("chain.yaml", "w").write(text + ("" if text.endswith("\n") else "\n") + text[at:].replace("cam0:", "cam1:") +
                             "  T_cn_cnm1: [[1, 0, 0, -0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n")
PYTHON
render scene.pbrt --spp 1 --trajectory poses.txt --rig chain.yaml -o 'rig_%d_%c.exr' 2>/dev/null
expect_code 2 rig_of_two "$VELO" render --again rig_1_cam1.exr -o rig2.exr
expect_text rig_of_two_says "two of the 2 frames would be"

# What has changed is named; nothing is written. Exit code 3, and 4 where the scene is missing.
refuse() { # NAME CODE TEXT COMMAND...
  local name=$1 code=$2 text=$3
  shift 3
  rm -f new.exr
  expect_code "$code" "$name" "$@"
  expect_text "${name}_says" "$text"
  if [ -e new.exr ]; then fail "${name}_writes_nothing"; else pass "${name}_writes_nothing"; fi
}
expect_line_of() { refuse "$1" 3 "$2" "$VELO" render --again plain.exr -o new.exr; }
cp room/parts/leaf.png leaf.png
cp room/parts/../../room/room.pbrt room.pbrt
cp "$VELO_SOURCE_DIR/scenes/features/textures/bricks_height.png" room/parts/leaf.png
expect_line_of texture_changed "velo: plain.exr: the file parts/leaf.png changed"
cp leaf.png room/parts/leaf.png
echo '# a comment' >>room/room.pbrt
expect_line_of scene_changed "velo: plain.exr: the file room.pbrt changed"
sed 's/fov" \[40\]/fov" [50]/' room.pbrt >room/room.pbrt
expect_line_of camera_changed "camera differs: fov is 0.872"
sed 's/maxdepth" \[4\]/maxdepth" [5]/' room.pbrt >room/room.pbrt
expect_line_of settings_changed "render differs: max_depth is 5, was 4"
expect_text settings_changed_in_one_line "the file room.pbrt changed; render differs: max_depth"
cp room.pbrt room/room.pbrt
mv room/parts/leaf.png gone.png
refuse file_missing 4 "leaf.png" "$VELO" render --again plain.exr -o new.exr
mv gone.png room/parts/leaf.png
mv room away
refuse scene_missing 4 "no such file: room/room.pbrt (of the receipt of plain.exr)" "$VELO" render --again plain.exr -o new.exr
mv away room
refuse none 3 "none.exr: there is no receipt" "$VELO" render --again none.exr -o new.exr
refuse other_options 2 "--spp would make another" "$VELO" render --again plain.exr --spp 5 -o new.exr
refuse no_name 2 "give the name of the new image with -o" "$VELO" render --again plain.exr
refuse no_image 4 "gone.exr" "$VELO" render --again gone.exr -o new.exr
refuse neither 2 "too few arguments" "$VELO" render -o new.exr
expect_code 0 dry_run "$VELO" render --again plain.exr --dry-run
if cmp -s plain.exr plain.again.exr; then pass still_the_same; else fail still_the_same; fi

# change FILE EXPRESSION: writes changed.exr with another receipt.
change() {
  python3 - "$1" "$2" <<'PYTHON'
import json, struct, sys
data = open(sys.argv[1], "rb").read()
name = b"velo.receipt\0string\0"
at = data.index(name) + len(name)
size = struct.unpack("<i", data[at:at + 4])[0]
receipt = json.loads(data[at + 4:at + 4 + size])
exec(sys.argv[2])
text = json.dumps(receipt, separators=(",", ":")).encode() if not isinstance(receipt, bytes) else receipt
assert len(text) <= size
text += b" " * (size - len(text))  # the offsets of the pixels stay
open("changed.exr", "wb").write(data[:at + 4] + text + data[at + 4 + size:])
PYTHON
}
change_and_refuse() { # NAME TEXT EXPRESSION
  change plain.exr "$3"
  refuse "$1" 3 "$2" "$VELO" render --again changed.exr -o new.exr
}
change_and_refuse other_sequence "velo's sample sequence is 2, was 9" 'receipt["velo"]["sequence"] = 9'
change_and_refuse part_of_an_image "holds 1 of 3 samples per pixel" 'receipt["samples"] = 1'
change_and_refuse later_format "later version of velo" 'receipt["velo_receipt"] = 2'
change_and_refuse not_json "receipt: line 1" 'receipt = b"{"'
change_and_refuse writes_a_file "has --output, which does not make an image" 'receipt["command"] = ["velo", "render", "-o", "x.exr", "room/room.pbrt"]'
change_and_refuse asks_for_help "cannot be followed: it asks for help" 'receipt["command"] = ["velo", "render", "-h"]'
change_and_refuse unknown_option "changed.exr: unknown option" 'receipt["command"] = ["velo", "render", "--sppp", "3", "a"]'
change_and_refuse no_command "cannot be followed: there is none" 'receipt["command"] = []'
change_and_refuse odd_members "cannot be followed" 'receipt["command"] = 3; receipt["files"] = {}'
change plain.exr 'receipt["velo"]["commit"] = "0"'
expect_code 0 other_commit "$VELO" render --again changed.exr -o new.exr --quiet
expect_text other_commit_says "changed.exr was made by velo"
same other_commit_has_its_own_receipt new.exr plain.exr

finish
