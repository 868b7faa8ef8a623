#!/usr/bin/env bash
# The library's shortest path (examples/render_file.c, the lines of docs/embedding.md) and `velo render` give the same bytes:
# what a scene's file says about its image reaches both. Every scene of scenes/, cut to a window and 2 samples by its own
# file; then one that says everything.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
by_library=$VELO_BINARY_DIR/bin/example_render_file
cd "$work" || exit 1
cp -r "$VELO_SOURCE_DIR/scenes" scenes
find scenes -name '*.pbrt' -exec sed -i -E \
  -e 's/^( *Film "rgb")/\1 "float cropwindow" [0.4 0.55 0.35 0.6]/' \
  -e 's/("integer pixelsamples" *\[? *)[0-9]+/\12/' {} +

# both NAME SCENE
both() {
  rm -f a.pfm b.pfm
  run "$by_library" "$2" a.pfm
  [ "$code" = 0 ] || { fail "$1_by_library"; show "$2"; return; }
  run "$VELO" render "$2" --quiet -o b.pfm
  [ "$code" = 0 ] || { fail "$1_by_program"; show "$2"; return; }
  same "$1" a.pfm b.pfm
}

count=0
for scene in $(grep -rl --include='*.pbrt' '^WorldBegin' scenes | sort); do
  both "$scene" "$scene"
  count=$((count + 1))
done
check "all scenes were found" test "$count" -gt 60

# Each of these changes the image, and comes from another of the scene's defs.
write_scene everything.pbrt
sed -i -e 's/^Film "rgb"/Film "rgb" "float whitebalance" 3200 "float maxcomponentvalue" 0.7 "float iso" 230 "integer pixelbounds" [3 60 5 41]/' \
  -e 's/^Sampler .*/Sampler "stratified" "integer xsamples" 2 "integer ysamples" 2 "integer seed" 7\nPixelFilter "mitchell"/' \
  -e 's/^Camera "perspective"/Camera "perspective" "float shutterclose" 0.6/' \
  -e 's/^Integrator .*/Integrator "volpath" "integer maxdepth" 7 "string lightsampler" "power" "bool regularize" true/' everything.pbrt
both everything everything.pbrt
for change in 's/"float whitebalance" 3200//' 's/"float maxcomponentvalue" 0.7//' 's/"float iso" 230//' \
  's/\[3 60 5 41\]/[3 60 5 42]/' 's/"integer seed" 7//' 's/"mitchell"/"box"/' 's/"float shutterclose" 0.6//' \
  's/"integer maxdepth" 7/"integer maxdepth" 1/' 's/"string lightsampler" "power"//' 's/"bool regularize" true//'; do
  sed "$change" everything.pbrt >changed.pbrt
  "$by_library" everything.pbrt a.pfm && "$by_library" changed.pbrt b.pfm
  if cmp -s a.pfm b.pfm; then fail "it counts: $change"; else pass "it counts: $change"; fi
done

# A glTF file whose camera only velo's extras hold, with its size.
write_scene lens.pbrt
sed -i 's/^Camera "perspective"/Camera "perspective" "float lensradius" 0.1 "float focaldistance" 4/' lens.pbrt
run "$VELO" scene convert lens.pbrt lens.gltf
check "the lens is in the extras" grep -q '"velo"' lens.gltf
both "a glTF file with a lens" lens.gltf
run "$VELO" image info --json a.pfm
expect_text "the size of the extras" '"width": 64, "height": 48'

# docs/embedding.md shows these calls.
awk '/^## The shortest program/ { on = 1 } on && /^```c$/ { code = 1; next } code && /^```$/ { exit } code' "$VELO_SOURCE_DIR/docs/embedding.md" >readme.c
check "docs/embedding.md has the lines" test "$(grep -c 'vl_' readme.c)" -ge 8
squeeze() { tr -s ' \n' ' '; }
example=$(sed -e 's/ = NULL;/;/' -e 's/if (result == VL_OK) //; s/result = //; s/vlResult //' -e 's,/\*.*\*/,,' "$VELO_SOURCE_DIR/examples/render_file.c" | squeeze)
calls=$(sed -E -e 's,//.*,,; s,/\*.*\*/,,' -e 's/"room.pbrt"/path/; s/"room.exr"/result_path/; s/&error/error/' \
  -e 's/^vl(Scene|World|Camera|Film|Image) \*?[a-z]+; +//' readme.c | grep -oE 'vl_[a-z_]+\(.*\);')
while read -r call; do
  case $example in
    *"$call"*) pass "docs/embedding.md: ${call%%(*}" ;;
    *) fail "docs/embedding.md: $call is not in examples/render_file.c" ;;
  esac
done <<<"$calls"
finish
