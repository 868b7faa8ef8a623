#!/usr/bin/env bash
# No output of any command is a file that the command has read, by whatever name; no two outputs are the same file. All
# of it is found before anything is rendered.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

write_scene plain.pbrt
"$VELO" render plain.pbrt -o wood.png --quiet --spp 1
sed 's/^Texture "checks" .*/Texture "checks" "spectrum" "imagemap" "string filename" "wood.png"/; /^  "rgb tex1"/d' plain.pbrt >scene.pbrt
sed 's/"asked.exr"/"wood.png"/' scene.pbrt >asks.pbrt
sed 's/wood/name.part/' scene.pbrt >part.pbrt
sed 's/wood.png/name.exr.ids.json/' scene.pbrt >described.pbrt
cp wood.png name.part.png
cp wood.png name.exr.ids.json
printf 'Include "scene.pbrt"\n' >outer.pbrt
"$VELO" render plain.pbrt -o sky.exr --quiet --spp 1 --resolution 32x32 --channels error,features
"$VELO" render plain.pbrt -o noise.exr --quiet --spp 4 --channels error,features
"$VELO" render plain.pbrt --film old.film --quiet --spp 4
"$VELO" camera convert plain.pbrt camera.json
printf '0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n' >poses.txt
ln wood.png hard.png
ln -s wood.png soft.png
mkdir folder
ln -s .. folder/up
md5sum -- *.* >.sums
long="--spp 16777216 --quiet"

# kept NAME COMMAND...: exit code 2, one line that names an input, and every file is as it was.
kept() {
  local name=$1
  shift
  run timeout 60 "$@"
  if [ "$code" = 2 ] && [[ $err == *"an input of this command"* || $err == *"would be overwritten"* || $err == *"is not replaced"* ]] &&
    [ "$(printf '%s\n' "$err" | wc -l)" = 1 ] && md5sum --quiet -c .sums >/dev/null 2>&1; then
    pass "$name"
  else
    fail "$name (wanted exit code 2 and unchanged files)"
    show "$*"
  fi
}
kept film_on_the_scene "$VELO" render scene.pbrt --film scene.pbrt $long
kept film_on_an_included_scene "$VELO" render outer.pbrt --film scene.pbrt $long
kept film_on_a_texture "$VELO" render scene.pbrt --film wood.png $long
kept film_on_a_camera "$VELO" render scene.pbrt --camera camera.json --film camera.json $long
kept image_on_a_texture "$VELO" render scene.pbrt -o wood.png $long
kept image_on_a_hard_link "$VELO" render scene.pbrt -o hard.png $long
kept image_on_a_soft_link "$VELO" render scene.pbrt -o soft.png $long
kept image_by_another_spelling "$VELO" render scene.pbrt -o folder/up/./wood.png $long
kept image_that_the_scene_names "$VELO" render asks.pbrt $long
kept progress_image "$VELO" render part.pbrt -o name.png $long
kept ids "$VELO" render described.pbrt -o name.exr --channels id.object $long
kept environment "$VELO" render plain.pbrt --environment sky.exr -o sky.exr $long
kept denoised_image "$VELO" render scene.pbrt -o z.exr --denoise wood.png $long
kept again "$VELO" render --again noise.exr -o noise.exr
kept image_on_the_continued_film "$VELO" render --continue old.film -o z.exr --film sky.exr --environment sky.exr --spp 16777216
kept trajectory "$VELO" render scene.pbrt --trajectory poses.txt --frames 0 -o 'w%n.png' -o 'wood.png' $long
kept dry_run "$VELO" render scene.pbrt -o wood.png --dry-run
kept view "$VELO" view scene.pbrt --film wood.png --no-open
kept image_convert "$VELO" image convert wood.png soft.png
kept image_denoise "$VELO" image denoise noise.exr -o noise.exr
kept image_diff "$VELO" image diff wood.png wood.png -o hard.png
kept camera_convert "$VELO" camera convert camera.json ./camera.json
kept camera_draw "$VELO" camera draw scene.pbrt -o wood.png
kept camera_vanishing "$VELO" camera vanishing plain.pbrt --overlay wood.png -o wood.png
kept scene_convert "$VELO" scene convert scene.pbrt folder/up/scene.pbrt
kept scene_upgrade "$VELO" scene upgrade scene.pbrt folder/up/scene.pbrt

# twice NAME COMMAND...: two outputs are one file.
twice() {
  local name=$1
  shift
  run timeout 60 "$@"
  if [ "$code" = 2 ] && [[ $err == *"same file"* || $err == *twice* ]]; then pass "$name"; else fail "$name"; show "$*"; fi
}
twice two_spellings "$VELO" render plain.pbrt -o new.exr -o folder/../new.exr $long
twice image_and_progress_image "$VELO" render plain.pbrt -o new.exr -o new.part.exr $long
twice image_and_film "$VELO" render plain.pbrt -o new.exr --film ./new.exr $long
twice image_and_denoised "$VELO" render plain.pbrt -o new.exr --denoise ./new.exr $long
ln -s new.exr later.exr
twice dangling_link "$VELO" render plain.pbrt -o new.exr -o later.exr $long
twice frames "$VELO" render plain.pbrt --trajectory poses.txt -o 'f%d.exr' -o 'folder/up/f%d.exr' $long

# What stays allowed: a film is continued and merged in place, files that were not read are replaced.
check continued "$VELO" render --continue old.film --spp 8 --quiet
check merged "$VELO" film merge old.film old.film -o old.film
check replaced "$VELO" render plain.pbrt -o wood.png --spp 1 --quiet
check both_to_a_device "$VELO" render plain.pbrt --film /dev/null --spp 1 --quiet
finish
