#!/usr/bin/env bash
# The tracers by their names; the options of the two-way tracers; messages.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

write_scene scene.pbrt
render() { "$VELO" render scene.pbrt --resolution 32x24 --spp 3 --quiet "$@"; }

for tracer in path volpath bidirectional merging sppm lightpath randomwalk raycast ambientocclusion; do
  check "$tracer" render --tracer $tracer --threads 1 -o $tracer.exr
  check "${tracer}_two_threads" render --tracer $tracer --threads 2 -o two.exr
  check "${tracer}_is_its_own" "$VELO" image diff $tracer.exr two.exr --threshold maxabs=0
done
run cmp -s path.exr bidirectional.exr
if [ "$code" = 1 ]; then pass bidirectional_is_another; else fail bidirectional_is_another; fi

# A rendered crop has the pixels of the whole image, also those that light paths contribute to.
for tracer in bidirectional merging; do
  check "${tracer}_crop" render --tracer $tracer --crop 5,4,20,17 -o crop.pfm
  check "${tracer}_cut" "$VELO" image convert $tracer.exr cut.pfm --crop 5,4,20,17
  same "${tracer}_crop_is_a_cut" crop.pfm cut.pfm
done

# The options of the two-way tracers.
check light_paths render --tracer bidirectional --light-paths 3000 -o many.exr
run cmp -s many.exr bidirectional.exr
if [ "$code" = 1 ]; then pass light_paths_count; else fail light_paths_count; fi
check no_light_paths render --tracer bidirectional --light-paths 0 -o none.exr
check merge_radius render --tracer merging --merge-radius 0.2 -o wide.exr
run cmp -s wide.exr merging.exr
if [ "$code" = 1 ]; then pass merge_radius_counts; else fail merge_radius_counts; fi
run "$VELO" image info wide.exr
expect_text radius_in_header 'velo.mergeRadius'

expect_code 2 unknown_tracer render --tracer bidirektional -o x.exr
expect_line unknown_tracer_near 'bidirectional'
expect_code 2 radius_zero render --tracer merging --merge-radius 0 -o x.exr
expect_line radius_zero_says 'merge-radius'
expect_code 2 radius_below_zero render --tracer merging --merge-radius -1 -o x.exr
expect_code 2 radius_no_number render --tracer merging --merge-radius wide -o x.exr
expect_line radius_no_number_says 'merge-radius'
expect_code 2 paths_below_zero render --tracer merging --light-paths -1 -o x.exr
expect_code 2 paths_too_many render --tracer merging --light-paths 1000000000 -o x.exr
expect_line paths_too_many_says 'light-paths'
if [ -e x.exr ]; then fail no_image_of_errors; else pass no_image_of_errors; fi

# pbrt's integrators: a note names the tracer that renders them; radius and number of photons are read.
integrator() { sed "s/^Integrator.*/Integrator $1/" scene.pbrt >asked.pbrt; }
asked() { "$VELO" render asked.pbrt --resolution 32x24 --spp 3 "$@"; }
for pair in bdpt:bidirectional mlt:bidirectional sppm:merging; do
  integrator "\"${pair%%:*}\" \"integer maxdepth\" [4]"
  check "${pair%%:*}" asked -o asked.exr
  expect_text "${pair%%:*}_note" "rendered by velo's ${pair##*:} tracer"
done
check sppm_is_sppm "$VELO" image diff asked.exr sppm.exr --threshold maxabs=0
integrator '"sppm" "integer maxdepth" [4] "float radius" [0.2] "integer photonsperiteration" [3000]'
check sppm_radius asked -o a.exr
check same_by_options render --tracer sppm --merge-radius 0.2 --light-paths 3000 -o b.exr
check sppm_radius_is_the_option "$VELO" image diff a.exr b.exr --threshold maxabs=0
integrator '"sppm" "float radius" [0]'
expect_code 3 sppm_radius_zero asked --quiet -o x.exr
expect_line sppm_radius_zero_says 'asked.pbrt:5'
integrator '"bdpt" "float radious" [1]'
expect_code 3 unknown_parameter asked --quiet -o x.exr
expect_line unknown_parameter_near '"radius"'

finish
