#!/usr/bin/env bash
# The scenes of the gallery: packed ones are those that their programs write, and velo finds nothing wrong in any.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
check "the programs write the packed scenes" python3 "$VELO_SOURCE_DIR/scenes/gallery/make/all.py" --check
for scene in "$VELO_SOURCE_DIR"/scenes/gallery/*.pbrt*; do
  check "scene check $(basename "$scene")" "$VELO" scene check "$scene"
done
check "at most 2 MB" test "$(du -sb "$VELO_SOURCE_DIR/scenes/gallery" | cut -f 1)" -le 2000000
for picture in "$VELO_SOURCE_DIR"/docs/images/gallery/*.jpg; do
  check "at most 400 KB: $(basename "$picture")" test "$(stat -c %s "$picture")" -le 400000
done
finish
