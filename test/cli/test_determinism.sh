#!/usr/bin/env bash
# The same bytes for any number of threads, on each instruction set, twice in a row; a crop holds the whole's pixels.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
render() { "$VELO" render scene.pbrt --quiet "$@"; }

render -t 1 -o one.exr -o one.png || fail reference
for threads in 1 2 3 8; do
  render -t $threads -o many.exr -o many.png || fail "threads_$threads"
  same "threads_${threads}_exr" one.exr many.exr
  same "threads_${threads}_png" one.png many.png
done
for isa in v2 v3 v4; do
  run "$VELO" render scene.pbrt --quiet --isa $isa -o isa.exr -o isa.png
  if [ "$code" = 2 ]; then
    skip "isa_$isa" "this machine does not have it"
    continue
  fi
  same "isa_${isa}_exr" one.exr isa.exr
  same "isa_${isa}_png" one.png isa.png
done

# Each sampler, tracer and colour mode: 1 and 3 threads, narrowest and widest instruction set.
for sampler in independent regular stratified nrooks multijittered hammersley halton sobol zsobol; do
  render --sampler $sampler -t 1 --isa base -o a.pfm && render --sampler $sampler -t 3 -o b.pfm
  same "sampler_$sampler" a.pfm b.pfm
done
for tracer in path raycast ambientocclusion; do
  render --tracer $tracer -t 1 --isa base -o a.pfm && render --tracer $tracer -t 3 -o b.pfm
  same "tracer_$tracer" a.pfm b.pfm
done
render --color rgb -t 1 --isa base -o a.pfm && render --color rgb -t 3 -o b.pfm
same color_rgb a.pfm b.pfm

# Another seed is another image: the tests above can fail.
render --seed 1 -o seed.pfm && render -o whole.pfm
if cmp -s seed.pfm whole.pfm; then fail another_seed; else pass another_seed; fi

# crop NAME OPTION WINDOW: rendered alone, and cut from the whole.
crop() {
  render $2 -o part.pfm -o part.png && "$VELO" image convert one.exr cut.pfm --crop $3 && "$VELO" image convert one.png cut.png --crop $3
  "$VELO" image convert part.pfm part2.pfm && same "$1" part2.pfm cut.pfm
  run "$VELO" image diff part.png cut.png --threshold differing=0
  [ "$code" = 0 ] && pass "$1_png" || { fail "$1_png"; show diff; }
}
crop crop "--crop 5,7,41,30" 5,7,41,30
crop crop_one_pixel "--crop 63,47,64,48" 63,47,64,48
crop crop_other_threads "--crop 16,0,48,48 -t 3" 16,0,48,48
crop cropwindow "--cropwindow 0.25,0.75,0.5,1" 16,24,48,48
run "$VELO" render scene.pbrt --quiet --crop 5,7,41,30 -o part.exr
run "$VELO" image info --json part.exr
if printf '%s' "$out" | python3 -c '
import json, sys
a = json.load(sys.stdin)
assert (a["width"], a["height"]) == (36, 23), a
assert a["attributes"]["dataWindow"] == [5, 7, 40, 29] and a["attributes"]["displayWindow"] == [0, 0, 63, 47], a'; then
  pass crop_knows_its_place
else
  fail crop_knows_its_place
  show info
fi

# The same for scenes that others made: textures, environment light, coats, glass, a large mesh.
for scene in cornell-box/cornell-box veach-mis/veach-mis coffee/coffee material-testball/material-testball pbrt-killeroos/killeroo-gold; do
  name=$(basename "$scene")
  file=$shared/scenes/pbrt/$scene.pbrt
  if [ -z "$shared" ] || [ ! -e "$file" ]; then
    skip "scene_$name" "needs ../shared/scenes"
    continue
  fi
  small="--resolution 64x48 --spp 2 --quiet"
  "$VELO" render "$file" $small -t 1 --isa base -o a.exr && "$VELO" render "$file" $small -t 3 -o b.exr || fail "scene_$name"
  same "scene_$name" a.exr b.exr
  "$VELO" render "$file" $small -t 2 --crop 9,5,50,31 -o part.exr && "$VELO" image convert a.exr cut.exr --crop 9,5,50,31
  run "$VELO" image diff cut.exr part.exr --threshold differing=0
  [ "$code" = 0 ] && pass "scene_${name}_crop" || { fail "scene_${name}_crop"; show diff; }
done

# Nothing in a file tells when, where or by how many it was made.
sleep 1.1
render -t 2 -o later.exr -o later.png -o later.jpg
render -o again.jpg
same later_exr one.exr later.exr
same later_png one.png later.png
same later_jpg later.jpg again.jpg
finish
