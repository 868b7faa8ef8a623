#!/usr/bin/env bash
# Ctrl-C, kill, a dropped connection: the whole passes are written to NAME.part.EXT, the exit code says what happened,
# an earlier image stays.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt

# A shell script's background jobs ignore SIGINT: give it back.
start() {
  env --default-signal=INT,HUP,TERM,USR1,USR2 "$VELO" "$@" &
  process=$!
}
samples_of() {
  "$VELO" image info --json "$1" | python3 -c 'import json, sys; print(json.load(sys.stdin)["attributes"]["samplesPerPixel"])'
}

# stopped SIGNAL CODE: a render without end, stopped after its first image is there.
stopped() {
  local name=$1 wanted=$2 spp
  rm -f stop.part.exr
  printf old >stop.exr
  start render scene.pbrt -o stop.exr --spp 16777216 2>stop.txt
  if ! wait_for stop.part.exr; then
    kill -KILL $process
    fail "$name (no image after 30 s)"
    return
  fi
  sleep 0.3
  kill -"$name" $process
  wait $process 2>/dev/null
  code=$?
  out=
  err=$(cat stop.txt)
  [ "$code" = "$wanted" ] && pass "${name}_exit_code" || { fail "${name}_exit_code ($code, not $wanted)"; show stop; }
  expect_text "${name}_says_where" stop.part.exr
  spp=$(samples_of stop.part.exr)
  [ "${spp:-0}" -ge 1 ] && pass "${name}_writes_whole_passes" || fail "${name}_writes_whole_passes"
  [ "$(cat stop.exr)" = old ] && pass "${name}_keeps_the_earlier_image" || fail "${name}_keeps_the_earlier_image"
}
stopped INT 130
stopped TERM 143
stopped HUP 129
stopped XCPU 152
stopped USR1 138
stopped USR2 140

# What was rendered until then is what a render of that many samples gives, bit for bit.
start render scene.pbrt -o part.exr -o part.pfm --spp 16777216 --quiet
wait_for part.part.pfm
sleep 0.2
kill -INT $process
wait $process
"$VELO" render scene.pbrt -o whole.pfm --spp "$(samples_of part.part.exr)" --quiet
same stopped_image_is_the_whole_one part.part.pfm whole.pfm
[ ! -e part.exr ] && pass stopped_render_is_not_finished || fail stopped_render_is_not_finished

# A finished render takes the place of both.
check finished "$VELO" render scene.pbrt -o stop.exr --quiet
[ "$(samples_of stop.exr)" = 4 ] && pass finished_replaces || fail finished_replaces
[ ! -e stop.part.exr ] && pass finished_removes_the_part || fail finished_removes_the_part

# A dropped connection sends several signals at once; they count as one, and nothing is lost.
start render scene.pbrt -o several.exr --spp 16777216 --quiet
wait_for several.part.exr
for _ in 1 2 3 4 5 6 7 8; do kill -HUP $process 2>/dev/null; kill -TERM $process 2>/dev/null; done
wait $process
code=$?
[ "$code" = 129 ] || [ "$code" = 143 ] && pass several_signals || fail "several_signals ($code)"
check several_signals_image "$VELO" image info several.part.exr

# What was ignored at the start stays ignored: nohup.
for name in HUP INT TERM; do
  rm -f nohup.part.exr
  env --ignore-signal=$name "$VELO" render scene.pbrt -o nohup.exr --sampler sobol --spp 16777216 --quiet &
  process=$!
  wait_for nohup.part.exr
  kill -$name $process
  sleep 0.5
  kill -0 $process 2>/dev/null && pass "ignored_${name}_stays_ignored" || fail "ignored_${name}_stays_ignored"
  kill -KILL $process
  wait $process 2>/dev/null
done

# Ground truth that is not done is given up by a signal; the image is kept without it.
start render scene.pbrt -o truth.exr --channels crypto,Z --resolution 512x384 --spp 16777216 2>truth.txt
wait_for truth.part.exr
kill -INT $process
wait $process
[ $? = 130 ] && pass stopped_with_channels || fail stopped_with_channels
check stopped_with_channels_image "$VELO" image info truth.part.exr

# Paths from the lights can be interrupted, too: a pass of them takes long here.
start render scene.pbrt -o light.exr --tracer bidirectional --light-paths 16777216 --resolution 16x12 --spp 65536 --quiet
sleep 1.5
begin=$(date +%s%N)
kill -TERM $process
wait $process
code=$?
took=$((($(date +%s%N) - begin) / 1000000))
[ "$code" = 143 ] && [ "$took" -lt 3000 ] && pass light_paths_stop || fail "light_paths_stop (exit code $code, $took ms)"

# Two eyes of one image: what there is of them is kept.
start render scene.pbrt --stereo parallel -o eyes.exr --spp 16777216 --resolution 16x12 --quiet
sleep 1.5
kill -INT $process
wait $process
[ $? = 130 ] && pass stereo_stopped || fail stereo_stopped
check stereo_stopped_image "$VELO" image info eyes.part.exr
[ ! -e eyes.exr ] && pass stereo_not_finished || fail stereo_not_finished

# Before anything is rendered: a pipe that nobody writes into.
mkfifo pipe.pbrt
start render pipe.pbrt -o none.exr 2>pipe.txt
sleep 0.5
kill -INT $process
wait $process
[ $? = 130 ] && pass nothing_rendered_exit_code || fail nothing_rendered_exit_code
[ "$(grep -c '' pipe.txt)" = 1 ] && pass nothing_rendered_is_one_line || fail nothing_rendered_is_one_line
grep -q 'nothing is written' pipe.txt && pass nothing_rendered_is_said || fail nothing_rendered_is_said
[ -z "$(ls none* 2>/dev/null)" ] && pass nothing_rendered_nothing_written || fail nothing_rendered_nothing_written

# A process that is killed leaves nothing, and what an earlier one left is removed; but not what is being written.
printf x >.velo-1-0.tmp
printf x >.velo-1-1.tmp
flock .velo-1-1.tmp sleep 4 &
sleeper=$!
sleep 0.2
start render scene.pbrt -o killed.exr --spp 16777216 --quiet
wait_for killed.part.exr
kill -KILL $process
wait $process 2>/dev/null
[ ! -e .velo-1-0.tmp ] && pass leftovers_removed || fail leftovers_removed
[ -e .velo-1-1.tmp ] && pass locked_stays || fail locked_stays
wait $sleeper
rm -f .velo-1-1.tmp
check after_kill "$VELO" render scene.pbrt -o killed.exr --quiet
[ -z "$(find . -name '*.tmp')" ] && pass no_temporary_files || fail "no_temporary_files ($(find . -name '*.tmp'))"
finish
