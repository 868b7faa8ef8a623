#!/usr/bin/env bash
# Every feature scene is understood without a warning and gives an image that is lit; its textures are what its script
# makes.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1

for scene in "$VELO_SOURCE_DIR"/scenes/features/*.pbrt; do
  name=$(basename "$scene" .pbrt)
  run "$VELO" render "$scene" --resolution 96x54 --spp 4 --quiet -o "$name.exr"
  if [ "$code" = 0 ] && [ -z "$err" ]; then pass "$name"; else fail "$name"; show "velo render $scene"; fi
  run "$VELO" image diff "$name.exr" "$name.exr"
  if [ "$code" = 0 ] && [[ $out == *meanratio*1* ]] && [[ $out != *nan* ]]; then pass "${name}_is_lit"; else fail "${name}_is_lit"; show "image diff $name.exr"; fi
done

if command -v python3 >/dev/null; then
  mkdir textures
  check textures_are_made python3 "$VELO_SOURCE_DIR/scenes/features/make_textures.py"
  for made in textures/*; do
    run "$VELO" image diff "$made" "$VELO_SOURCE_DIR/scenes/features/$made" # by pixels: packing may differ
    if awk '$1 == "maxabs" { found = 1; if ($2 > 0.001) exit 1 } END { exit !found }' "$work/.out"; then pass "$made"; else fail "$made"; show "image diff $made"; fi
  done
else
  skip textures "no python3"
fi
finish
