#!/usr/bin/env bash
# Videos of animations, turntables and trajectories: what is refused before anything is rendered; failures of ffmpeg, by a
# program of that name; and the videos of the real one, where it is installed.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
cat >box.obj <<'END'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v .5 .5 1
f 1 2 3 4
f 1 2 5
f 2 3 5
END
printf 'name,eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z\np,0,1.2,4,0,0.6,0\nq,1,1,4,0,0.6,0\n' >poses.csv
options="--resolution 33x25 --spp 1 --exposure 0 --tracer path"
real=$(command -v ffmpeg || true)

# A program in place of ffmpeg: $FAKE says what it does; it writes its words to a file and the input to the output.
mkdir fake
cat >fake/ffmpeg <<'END'
#!/bin/sh
printf '%s\n' "$@" >words
for output; do :; done
case $FAKE in
  early) printf '\n[mp4 @ 0x1] it fails \033[2Jearly\nmore\n' >&2; exit 3 ;;
  late) cat >/dev/null; echo 'No space left on device' >&2; exit 1 ;;
  silent) cat >/dev/null; exit 4 ;;
  killed) kill -9 $$ ;;
  nothing) cat >/dev/null ;;
  closed) exec <&-; sleep 0.2 ;;
  waits) echo $$ >waiting; exec sleep 100 ;;
  pipe) trap - PIPE; yes | head -n 1 >/dev/null; cat >"${output#file:}" ;;
  *) cat >"${output#file:}" ;;
esac
END
chmod +x fake/ffmpeg
path=$PATH
with_fake() { FAKE=$1 PATH=$work/fake:$path run "$VELO" render "${@:2}"; }
left() { ls -A | grep -c '^\.velo-'; }

# ---- refused, with nothing rendered ----------------------------------------------------------------------------------
PATH=$work/fake:$PATH
expect_code 2 one_image "$VELO" render box.obj -o v.mp4
expect_text one_image_says 'output "v.mp4": a video goes with --animate, --turntable or --trajectory'
expect_code 2 sandbox "$VELO" render box.obj --turntable 3 -o v.mp4 --sandbox .
expect_line sandbox_says 'starts no other program, and ffmpeg makes the video; render the frames: -o v_%04d.png'
expect_code 2 alpha "$VELO" render box.obj --turntable 3 -o v.mp4 --transparent
expect_code 2 part "$VELO" render scene.pbrt --trajectory poses.csv --shard 1/2 -o v.mp4
expect_code 2 stereo "$VELO" render scene.pbrt --trajectory poses.csv --stereo parallel -o v.mp4
expect_code 2 pattern "$VELO" render box.obj --turntable 3 -o v%04d.mp4
expect_text pattern_says 'a video is one file'
expect_code 2 standard_output "$VELO" render box.obj --turntable 3 -o -.mp4
expect_code 2 same_file "$VELO" render box.obj --turntable 3 -o v.mp4 -o ./v.mp4
expect_code 2 fast_gif "$VELO" render box.obj --turntable 3 -o v.gif --fps 60
expect_code 5 no_folder "$VELO" render box.obj --turntable 3 -o none/v.mp4
mkdir v.gif
expect_code 5 a_folder "$VELO" render box.obj --turntable 3 -o v.gif
rmdir v.gif
expect_code 4 missing env PATH=/var/empty "$VELO" render box.obj --turntable 3 -o "$work/v.mp4"
PATH=$path
expect_line missing_says "ffmpeg is not installed, and it makes the video; render the frames: -o $work/v_%04d.png"
check nothing_rendered test -z "$(ls | grep '^v')"
run "$VELO" render box.obj --turntable 3 --fps 12 $options -o f%d.png --dry-run
expect_text fps_needs_a_video '--fps has no effect: it goes with --animate, or with a video'
PATH=$work/fake:$path check dry_run "$VELO" render box.obj --turntable 3 --fps 12 $options -o v.mp4 --dry-run
check dry_run_writes_nothing test -z "$(ls | grep '^v')"
case $err in *'no effect'*) fail fps_of_a_video ;; *) pass fps_of_a_video ;; esac

# ---- what ffmpeg gets ------------------------------------------------------------------------------------------------
with_fake good box.obj --turntable 3 --frames 1-2 --fps 12.5 $options -o v.mp4 -o f%02d.png
check good test "$code" = 0
cat f01.png f02.png >both
same frames_in_order both v.mp4
check frames_given_stay test "$(ls | grep -c png)" = 2
check file_protocol grep -q '^file:.*\.velo-[0-9]*-0\.tmp$' words
check rate test "$(grep -A1 -x -e -framerate words | tail -n 1)" = 12.5
with_fake good box.obj --turntable 3 --frames 1-2 --fps 12.5 $options -o v.mp4
same own_frames_the_same both v.mp4
expect_text said '2 frames of 33 x 25 in'
expect_text said_where 'wrote v.mp4, 0.16 s at 12.5 frames per second'
check two_lines test "$(printf '%s\n' "$err" | grep -c '')" = 2
check own_frames_go test -z "$(ls | grep part)"
with_fake good scene.pbrt --trajectory poses.csv $options -o v.mp4
check trajectory test "$code$(ls | grep -c part)" = 00
ln -s v.mp4 link.mp4
chmod 600 v.mp4
with_fake good box.obj --turntable 3 --frames 1-2 $options -o link.mp4 -o f%02d.png
check link_followed test "$code$(stat -c %a v.mp4)" = 0600 -a -L link.mp4
same link_target both v.mp4
with_fake good box.obj --turntable 1 $options -o '-v $(touch shell).mp4' -o ./-f%d.png
check no_shell test "$code" = 0 -a -s './-v $(touch shell).mp4' -a ! -e shell
rm ./-*
with_fake good box.obj --turntable 2 --log-json $options -o v.mp4
check json python3 -c 'import json, sys
last = json.loads(sys.argv[1].splitlines()[-1])
sys.exit(last != {"event": "video", "file": "v.mp4", "frames": 2, "fps": 24, "width": 33, "height": 25})' "$err"
cat >transforms.json <<'END'
{"w": 32, "h": 24, "fl_x": 30, "frames": [
 {"file_path": "a.png", "transform_matrix": [[1,0,0,0],[0,1,0,1],[0,0,1,4],[0,0,0,1]]},
 {"file_path": "c.png", "w": 40, "transform_matrix": [[0,0,1,4],[0,1,0,1],[-1,0,0,0],[0,0,0,1]]}]}
END
printf before >v.mp4
with_fake good scene.pbrt --trajectory transforms.json -o v.mp4 --quiet
expect_line sizes_differ 'v.part_0001.png: has 40 x 24 pixels, the first frame 32 x 24; the frames are in v.part_%04d.png'
check sizes_differ_code test "$code$(cat v.mp4)" = 5before
rm v.part*

# ---- failures: exit code 5, one line, the video of before, the frames -------------------------------------------------
fails() {
  with_fake "$1" box.obj --turntable 3 $options -o v.mp4 --skip-existing --quiet
  expect_line "$1" "$2"
  check "$1_keeps" test "$code$(cat v.mp4)$(left)" = 5before0 -a "$(ls | grep -c 'v.part_000..png')" = 3
}
fails early 'v.mp4 is not written: ffmpeg: it fails ?[2Jearly; the frames are in v.part_%04d.png'
fails late 'v.mp4 is not written: ffmpeg: No space left on device; the frames'
fails silent 'ffmpeg: it ended with exit code 4; the frames'
fails killed 'ffmpeg: it was ended by signal 9; the frames'
fails nothing 'ffmpeg: it wrote nothing; the frames'
printf broken >v.part_0001.png
with_fake good box.obj --turntable 3 $options -o v.mp4 --skip-existing --quiet
expect_line broken_frame 'v.part_0001.png: is no .png file'
rm v.part_0001.png
with_fake good box.obj --turntable 3 $options -o v.mp4 --skip-existing
check goes_on test "$code$(ls | grep -c part)" = 00
printf before >v.mp4
# The reader ends while velo writes: frames that are longer than a pipe holds.
for i in 0 1 2; do
  { head -c 24 f01.png; head -c 300000 /dev/zero; } >long$i.png
done
with_fake closed box.obj --turntable 3 $options -o v.mp4 -o long%d.png --skip-existing --quiet
expect_line broken_pipe 'ffmpeg: it ended with exit code 0 before it had all frames; the frames are in long%d.png'
check broken_pipe_keeps test "$code$(cat v.mp4)$(left)" = 5before0
# A disk that is full: the limit of the size of files, which the frames are below.
with_limit() { (ulimit -f 14 && trap '' XFSZ && exec "$@"); }
if [ -n "$real" ]; then
  run with_limit "$VELO" render box.obj --turntable 24 --resolution 80x60 --spp 1 --exposure 0 -o v.gif
  expect_text full_disk_says 'v.gif is not written: ffmpeg: '
  check full_disk test "$code" = 5 -a ! -e v.gif -a "$(left)" = 0 -a "$(ls | grep -c 'v.part_00...png')" = 24
  rm v.part*
fi
# Signals: while ffmpeg runs, and while the frames are rendered.
FAKE=waits PATH=$work/fake:$path "$VELO" render box.obj --turntable 3 $options -o v.mp4 2>interrupted &
child=$!
wait_for waiting
kill -TERM $child
wait $child
code=$? err=$(cat interrupted)
expect_text interrupted_says 'v.mp4 is not written; the frames so far are in v.part_%04d.png, and the same command with --skip-existing goes on'
check interrupted test "$code$(cat v.mp4)$(left)" = 143before0 -a "$(ls | grep -c 'v.part_000..png')" = 3
expect_code 1 ffmpeg_ended kill -0 "$(cat waiting)"
rm v.part*
FAKE=good PATH=$work/fake:$path "$VELO" render box.obj --turntable 9999 --resolution 33x25 --spp 1 -o v.mp4 2>interrupted &
child=$!
wait_for v.part_0002.png
kill -TERM $child
wait $child
check interrupted_frames test "$?$(cat v.mp4)" = 143before -a -s v.part_0001.png
rm v.part*

# ---- the real ffmpeg -------------------------------------------------------------------------------------------------
if [ -z "$real" ]; then
  skip ffmpeg "ffmpeg is not installed (script/bootstrap judges)"
  finish
fi
options="--resolution 33x25 --spp 16 --exposure 0 --tracer path" # a video loses grain
check mp4_and_gif "$VELO" render box.obj --turntable 5 --fps 10 $options -o v.mp4 -o v.gif -o f%d.png
check mp4_type test "$(head -c 8 v.mp4 | tail -c 4)" = ftyp
check gif_type test "$(head -c 6 v.gif)" = GIF89a
check decoded ffmpeg -loglevel error -i v.mp4 m%d.png
check decoded_gif ffmpeg -loglevel error -i v.gif -fps_mode passthrough g%d.png
check all_frames test "$(ls m?.png g?.png | wc -l)" = 10
# Even sizes: the last row and column twice. The colours are those of the frames.
run "$VELO" image info m1.png
expect_text even_size '34 x 26'
for i in 1 5; do
  "$VELO" image convert "m$i.png" cut.png --crop 0,0,33,25 >/dev/null 2>&1
  check "colours_of_frame_$i" "$VELO" image diff "f$((i - 1)).png" cut.png --threshold mse=0.0004
  check "colours_of_gif_$i" "$VELO" image diff "f$((i - 1)).png" "g$i.png" --threshold mse=0.0004
done
finish
