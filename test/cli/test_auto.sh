#!/usr/bin/env bash
# --tracer auto: a race chooses the tracer; the same for threads, crops and parts; receipts and films name the result.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

# A lamp in a tube that is open above: light from the lamps finds the room.
cat >named.pbrt <<'SCENE'
LookAt 0 1 3.5  0 0.8 0  0 1 0
Camera "perspective" "float fov" [60]
Film "rgb" "integer xresolution" [128] "integer yresolution" [96]
Sampler "zsobol" "integer pixelsamples" [64]
Integrator "volpath" "integer maxdepth" [4]
WorldBegin
Material "diffuse" "rgb reflectance" [0.7 0.6 0.5]
Shape "bilinearmesh" "point3 P" [-4 0 -4  4 0 -4  -4 0 4  4 0 4]
Shape "bilinearmesh" "point3 P" [-4 3 -4  4 3 -4  -4 3 4  4 3 4]
Shape "bilinearmesh" "point3 P" [-4 0 -2  4 0 -2  -4 3 -2  4 3 -2]
AttributeBegin
  Rotate -90 1 0 0
  Shape "cylinder" "float radius" [0.4] "float zmin" [0.3] "float zmax" [1.2]
AttributeEnd
AttributeBegin
  Translate 0 0.8 0
  AreaLightSource "diffuse" "rgb L" [60 60 50]
  Shape "sphere" "float radius" [0.15]
AttributeEnd
SCENE
grep -v '^Integrator' named.pbrt >scene.pbrt
tile="--crop 32,32,64,64"
render() { "$VELO" render "$@"; }

# shellcheck disable=SC2086 # words of $tile are options
{
  check auto render named.pbrt --tracer auto $tile -t 1 -o auto.exr -o auto.pfm
  expect_text auto_is_reported 'auto: bidirectional'
  check threads render named.pbrt --tracer auto $tile -t 3 -o threads.pfm
  same threads_do_not_matter auto.pfm threads.pfm
  check instruction_set env VELO_ISA=base "$VELO" render named.pbrt --tracer auto $tile -o base.pfm
  same instruction_set_does_not_matter auto.pfm base.pfm
  check seed render named.pbrt --tracer auto --crop 0,0,1,1 --seed 5 -o seed.exr
  run "$VELO" image info auto.exr
  expect_text header_names_it 'bidirectional'
  check again render --again auto.exr -o again.exr
  same again_is_the_same auto.exr again.exr
  case "$err" in *auto:*) fail again_needs_no_race ;; *) pass again_needs_no_race ;; esac

  # The default of scenes that name no tracer, from 32 samples on.
  check default render scene.pbrt $tile --max-depth 4 -t 2 -o default.pfm
  expect_text default_is_auto 'auto: bidirectional'
  race=$(grep auto: <<<"$err")
  check longer render scene.pbrt --crop 0,0,1,1 --max-depth 4 --spp 100 -o longer.pfm
  expect_text a_longer_render_has_the_same_race "$race"
  check few render scene.pbrt --crop 0,0,1,1 --spp 31 -o few.pfm
  case "$err" in *auto:*) fail few_samples_have_no_race ;; *) pass few_samples_have_no_race ;; esac
  check own render named.pbrt --crop 0,0,1,1 -o own.pfm
  case "$err" in *auto:*) fail a_named_tracer_stays ;; *) pass a_named_tracer_stays ;; esac
  same default_is_the_same auto.pfm default.pfm
}

# A scene that names a tracer that looks past its media keeps it: the others would show another scene.
sed -e 's/"volpath"/"path"/' -e '/^WorldBegin/a MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [1 1 1]' \
  -e '/^  Rotate -90/i MediumInterface "fog" ""' named.pbrt >fog.pbrt
check past_media render fog.pbrt --tracer auto --crop 0,0,1,1 -o fog.exr -o fog.pfm
expect_text past_media_is_told 'auto: path (no race'
check past_media_by_name render fog.pbrt --crop 0,0,1,1 -o path.pfm
same past_media_is_the_scenes_own fog.pfm path.pfm
run "$VELO" image info fog.exr
out=$(grep velo.tracer <<<"$out" | tr -s ' ')
expect_text past_media_in_the_header 'velo.tracer path'
check past_nothing render named.pbrt --tracer auto --spp 4 --crop 0,0,1,1 -o little.pfm
expect_text without_race_it_is_volpath 'auto: volpath (no race'

# Parts of an image, merged; a part that is continued.
part() { "$VELO" render named.pbrt --tracer auto --crop 40,40,56,56 "$@"; }
check whole part --film whole.film -t 2
check first_part part --samples 0:20 --film a.film
check second_part part --samples 20:64 --film b.film
check merge "$VELO" film merge a.film b.film -o merged.film
same merged_is_the_whole merged.film whole.film
check continued render --continue a.film --samples 0:64 --film continued.film
case "$err" in *auto:*) fail continue_needs_no_race ;; *) pass continue_needs_no_race ;; esac
check develop "$VELO" film develop continued.film -o continued.pfm
check develop_whole "$VELO" film develop whole.film -o whole.pfm
same continued_is_the_whole continued.pfm whole.pfm

# The number of light paths of the bidirectional tracer.
check bidirectional render named.pbrt --tracer bidirectional --crop 0,0,1,1 --log-json -o b.exr
expect_text light_paths_are_raced '"event": "tracer"'
check each_trial_is_listed python3 -c 'import json, sys
event = next(event for event in map(json.loads, sys.argv[1].splitlines()) if event["event"] == "tracer")
names = [(trial["tracer"], trial.get("light_paths")) for trial in event["trials"]]
assert len(names) > 2 and len(set(names)) == len(names), names' "$err"
check as_many render named.pbrt --tracer bidirectional --light-paths 500 --crop 0,0,1,1 --log-json -o b.exr
case "$err" in *'"event": "tracer"'*) fail given_light_paths_stay ;; *) pass given_light_paths_stay ;; esac
check no_paths render named.pbrt --tracer bidirectional --light-paths 0 --spp 4 --crop 40,40,56,56 -o none.pfm
check volpath render named.pbrt --tracer volpath --spp 4 --crop 40,40,56,56 -o volpath.pfm
same no_light_paths_is_volpath none.pfm volpath.pfm

# Several images have the race of the first one, whatever part of them is rendered. The poses stand beside the lamp, not
# at the scene's camera.
cat >poses.json <<'POSES'
{"w": 128, "h": 96, "fl_x": 80, "frames": [
  {"file_path": "a", "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 1], [0, 0, 1, 3], [0, 0, 0, 1]]},
  {"file_path": "b", "transform_matrix": [[1, 0, 0, 0.4], [0, 1, 0, 1.2], [0, 0, 1, 3], [0, 0, 0, 1]]}
]}
POSES
several() { "$VELO" render named.pbrt --tracer auto --trajectory poses.json --crop 60,40,68,48 "$@"; }
check frames several -o all-%d.exr -o all-%d.pfm
race=$(grep auto: <<<"$err")
expect_text frames_have_a_race 'auto: bidirectional'
check last_frame several --frames 1 -o last-%d.pfm
expect_text a_part_has_the_same_race "$race"
same a_part_has_the_tracer_of_all all-1.pfm last-1.pfm
check again_frame render --again all-1.exr -o again-%d.exr
case "$err" in *auto:*) fail again_of_a_frame_needs_no_race ;; *) pass again_of_a_frame_needs_no_race ;; esac
same again_of_a_frame_is_the_same all-1.exr again-1.exr
for eye in left right; do
  check "eye_$eye" render named.pbrt --tracer auto --stereo parallel --interocular 0.1 --eye $eye --crop 60,40,68,48 -o $eye-one.pfm
  races+=("$(grep auto: <<<"$err")")
done
check eyes render named.pbrt --tracer auto --stereo parallel --interocular 0.1 --crop 60,40,68,48 -o %v.pfm
expect_text eyes_have_a_race 'auto: bidirectional'
races+=("$(grep auto: <<<"$err")")
if [ "${races[0]}" = "${races[1]}" ] && [ "${races[0]}" = "${races[2]}" ]; then pass eyes_have_one_race; else fail eyes_have_one_race "${races[*]}"; fi
same an_eye_has_the_tracer_of_both left.pfm left-one.pfm

expect_code 2 continue_auto render --continue a.film --tracer auto
expect_line continue_auto_says 'own tracer'
expect_code 2 light_paths_auto render named.pbrt --tracer auto --light-paths 5 -o x.exr
expect_line light_paths_auto_says 'light-paths'
expect_code 2 light_paths_view_auto "$VELO" view named.pbrt --tracer auto --light-paths 5 --no-open
expect_line light_paths_view_auto_says 'light-paths'
check small render named.pbrt --tracer auto --spp 1 --resolution 16x16 -o small.exr
expect_text small_says 'no race'

finish
