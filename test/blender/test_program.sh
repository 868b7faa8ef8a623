#!/usr/bin/env bash
# `velo render scene.blend`: what is refused before Blender starts; failures of Blender, by a program of that name; and the
# images of the real one, where it is installed.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1
here=$VELO_SOURCE_DIR/test/blender
path=$PATH

# A program in place of Blender: $FAKE says what it does; it writes its words to a file.
mkdir fake
cat >fake/blender <<'END'
#!/bin/bash
printf '%s\n' "$@" >words
scene() { printf 'scene\t3.4.1\t1\t3\t1\n' >&3; }
texts() { for ((i = 0; i < $1; i++)); do IFS= read -r -d '' text || exit 0; done; }
case $FAKE in
  early) echo 'No such library' >&2; exit 3 ;;
  killed) kill -9 $$ ;;
  refuses) printf 'error\t3\tthe scene has no\033 camera\n' >&3 ;;
  writes_nothing) scene; texts 2; echo 'it fails' >&2 ;;
  no_code) printf 'error\t77\tstrange\n' >&3 ;;
  endless) for ((i = 0; i < 5000; i++)); do printf 'xxxxxxxxxxxxxxxxxxxx' >&3; done ;;
  waits) scene; echo $$ >waiting; exec sleep 100 ;;
  *) scene
    while texts 2; do
      echo image >"$text"
      printf 'progress\t0.5\ndone\t33\t25\t4\n' >&3
    done ;;
esac
END
chmod +x fake/blender
echo BLENDER >scene.blend
left() { ls -A | grep -c '^\.velo-'; }
with_fake() { FAKE=$1 PATH=$work/fake:$path run "$VELO" render "${@:2}"; }

# ---- refused, before Blender starts ----------------------------------------------------------------------------------
PATH=$work/fake:$PATH
expect_code 2 sandbox "$VELO" render scene.blend --sandbox .
expect_text sandbox_says 'scene.blend: --sandbox starts no other program, and Blender reads .blend files'
for option in '--film f.film' '--tracer path' '--channels Z' '--trajectory p.csv' '--animate 0:1' '--time 3s' '--exposure 1' '--dry-run'; do
  expect_code 2 "refused ${option%% *}" "$VELO" render scene.blend $option
  expect_text "refused ${option%% *} by name" "scene.blend: Blender renders it, and ${option%% *} cannot be passed on"
done
expect_code 2 pfm "$VELO" render scene.blend -o a.pfm
expect_code 2 standard_output "$VELO" render scene.blend -o -.exr
expect_code 2 frame_alone "$VELO" render scene.blend --frame 2
expect_text frame_alone_says 'is --frames N'
expect_code 2 several "$VELO" render scene.blend --frames 1-2 -o a.png
expect_code 2 pattern "$VELO" render scene.blend -o a_%n.png
expect_code 2 noise "$VELO" render scene.blend --noise 90% -o a.png
expect_code 4 no_scene "$VELO" render none.blend -o a.png
expect_code 5 no_folder "$VELO" render scene.blend -o none/a.png
check nothing_started test ! -e words
cp scene.blend scene.png.blend
ln -s scene.blend image.png
expect_code 2 replaces_the_scene "$VELO" render scene.blend -o image.png
rm image.png
PATH=$path
expect_code 4 missing env PATH=/var/empty "$VELO" render scene.blend
expect_text missing_says 'scene.blend: Blender is not installed, and it reads .blend files'

# ---- what Blender does -----------------------------------------------------------------------------------------------
fails() { # NAME CODE TEXT
  echo before >a.png
  with_fake "$1" scene.blend -o a.png
  expect_text "$1 says" "$3"
  check "$1" test "$code" = "$2"
  check "$1 keeps the image before" grep -q before a.png
  check "$1 leaves nothing" test "$(left)" = 0
}
fails early 5 'scene.blend: Blender did not render it: it ended with exit code 3; No such library'
fails killed 5 'it was ended by signal 9'
fails refuses 3 'scene.blend: the scene has no? camera'
fails writes_nothing 5 'it ended with exit code 0; it fails'
fails no_code 1 'strange'
fails endless 5 'Blender did not render it'
rm a.png
with_fake good scene.blend --spp 5 --seed 3 --resolution 33x25 --crop 1,2,3,4 --noise 1% --max-depth 3 --threads 2 -o a.png
expect_text good_says "scene.blend is rendered by Blender 3.4.1 ($work/fake/blender) with velo's add-on"
check good test "$code" = 0
check good_image grep -q image a.png
for word in spp=5 seed=3 resolution=33,25 crop=1,2,3,4 noise=0.01 max-depth=3 threads=2 .png --disable-autoexec; do
  check "passes $word" grep -qxe "$word" words
done
with_fake good scene.blend -o f_%02d.png
check all_frames test "$code $(echo f_*)" = '0 f_01.png f_02.png f_03.png'
rm f_02.png
with_fake good scene.blend -o f_%02d.png --skip-existing --log-json
expect_text skips '"frames": 3, "written": 1'
with_fake good scene.blend
check default_name test "$code $(ls scene.png)" = '0 scene.png'
FAKE=waits PATH=$work/fake:$path "$VELO" render scene.blend -o b.png 2>waits.err &
velo=$!
for ((i = 0; i < 200; i++)); do [ -s waiting ] && break || sleep 0.05; done
kill -TERM $velo
wait $velo
check interrupted test $? = 143
sleep 0.1
expect_code 1 blender_ended kill -0 "$(cat waiting)"
check interrupted_leaves_nothing test "$(left)" = 0 -a ! -e b.png

# ---- the real Blender ------------------------------------------------------------------------------------------------
reason=$(PYTHONPATH=$here python3 -c 'import run_inside; print(run_inside.why_not() or "")')
if [ -n "$reason" ]; then
  skip real "$reason"
  finish
fi
cat >make.py <<'END'
import sys, bpy
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = 64, 48
scene.frame_end = 2
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1] + "/real.blend")
scene.camera = None
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1] + "/blind.blend")
END
blender -b --factory-startup -P make.py -- "$work" >/dev/null 2>&1
check real "$VELO" render real.blend --spp 2 -o r.png -o r.exr -o s.exr -o r.hdr -o r.jpg -o r.tga
for name in r.png r.exr s.exr r.hdr r.jpg r.tga; do
  run "$VELO" image info $name
  expect_text "size of $name" '64 x 48'
done
check crop "$VELO" render real.blend --spp 2 --crop 10,20,41,45 -o c.exr
run "$VELO" image info c.exr
expect_text crop_size '31 x 25'
check frames "$VELO" render real.blend --spp 1 --resolution 32x24 -o r%d.png
check frames_there test -e r1.png -a -e r2.png
expect_code 3 no_camera "$VELO" render blind.blend -o a.png
expect_text no_camera_says 'blind.blend: Cannot render, no camera'
printf '{"version": 1, "width": 40, "height": 30, "fx": 50, "fy": 50, "cx": 20, "cy": 15}' >lens.json
run "$VELO" camera info lens.json
if [ "$code" = 0 ]; then
  check camera "$VELO" render blind.blend --camera lens.json --spp 1 -o lens.png
  run "$VELO" image info lens.png
  expect_text camera_size '40 x 30'
fi
expect_code 4 no_camera_file "$VELO" render real.blend --camera none.json -o a.png
expect_code 3 no_blend "$VELO" render scene.blend -o a.png
expect_text no_blend_says 'Blender cannot open it'
expect_code 2 too_many "$VELO" render real.blend --spp 70000 -o a.png
expect_text too_many_says '--spp: velo in Blender does not take 70000'
expect_code 2 crop_outside "$VELO" render real.blend --crop 0,0,65,48 -o a.png
finish
