#!/usr/bin/env bash
# Ctrl-C and kill: the whole passes are written, the exit code says what happened.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt

# stopped SIGNAL CODE: a render without end, stopped after its first picture is there.
stopped() {
  local name=$1 wanted=$2 process spp
  rm -f stop.exr
  "$VELO" render scene.pbrt -o stop.exr --spp 16777216 2>stop.txt &
  process=$!
  if ! wait_for stop.exr; then
    kill -KILL $process
    fail "$name (no progress picture after 30 s)"
    return
  fi
  sleep 0.3
  kill -"$name" $process
  wait $process
  code=$?
  out=
  err=$(cat stop.txt)
  [ "$code" = "$wanted" ] && pass "${name}_exit_code" || { fail "${name}_exit_code ($code, not $wanted)"; show stop; }
  run "$VELO" image info --json stop.exr
  spp=$(printf '%s' "$out" | python3 -c 'import json, sys; print(json.load(sys.stdin)["attributes"]["samplesPerPixel"])')
  [ "${spp:-0}" -ge 1 ] && pass "${name}_writes_whole_passes" || fail "${name}_writes_whole_passes"
  # What was rendered until then is what a render of that many samples gives, bit for bit. ZSobol' spreads its points for
  # the number of samples asked for, so this is asked of a sampler that does not.
}
stopped INT 130
stopped TERM 143

"$VELO" render scene.pbrt -o part.exr -o part.pfm --sampler sobol --spp 16777216 --quiet &
process=$!
wait_for part.pfm
sleep 0.2
kill -INT $process
wait $process
spp=$("$VELO" image info --json part.exr | python3 -c 'import json, sys; print(json.load(sys.stdin)["attributes"]["samplesPerPixel"])')
"$VELO" render scene.pbrt -o whole.pfm --sampler sobol --spp "$spp" --quiet
same stopped_picture_is_the_whole_one part.pfm whole.pfm

# Before anything is rendered: a pipe that nobody writes into.
mkfifo pipe.pbrt
"$VELO" render pipe.pbrt -o none.exr 2>pipe.txt &
process=$!
sleep 0.5
kill -INT $process
wait $process
[ $? = 130 ] && pass nothing_rendered_exit_code || fail nothing_rendered_exit_code
grep -q 'nothing is written' pipe.txt && pass nothing_rendered_is_said || fail nothing_rendered_is_said
[ ! -e none.exr ] && pass nothing_rendered_nothing_written || fail nothing_rendered_nothing_written

# --time ends a render without end by itself.
start=$(date +%s)
check time_limit "$VELO" render scene.pbrt -o time.exr --time 1s --quiet
[ $(($(date +%s) - start)) -le 20 ] && pass time_limit_in_time || fail time_limit_in_time
finish
