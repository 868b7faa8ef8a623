#!/usr/bin/env bash
# Every example: it runs on a small copy of the examples' scene, and its image is what it says: the bytes of `velo render` where
# it computes the same, else its mean within stated bounds. Each picture beside an example has less than 100 KB.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
examples=$VELO_SOURCE_DIR/examples
cd "$work" || exit 1
sed -e 's/\[360\]/[60]/; s/\[240\]/[40]/; s/pixelsamples" \[32\]/pixelsamples" [8]/' "$examples/corner.pbrt" >corner.pbrt
"$VELO" render corner.pbrt --quiet -o whole.pfm || exit 1

# example NAME: NAME.pfm
example() {
  expect_code 0 "$1" "$VELO_BINARY_DIR/bin/example_$1" corner.pbrt "$1.pfm"
  [ -s "$1.pfm" ] || fail "$1: no image"
}
# mean NAME A B LOW HIGH: B's mean divided by A's
mean() {
  run "$VELO" image diff "$2" "$3"
  if printf '%s\n' "$out" | awk -v low="$4" -v high="$5" '$1 == "meanratio" {m = $2; found = 1} END {exit !(found && m > low && m < high)}'; then
    pass "$1"
  else
    fail "$1"
    show "the difference"
  fi
}
size() { [ "$(sed -n 2p "$2" | head -1)" = "$3" ] && pass "$1" || fail "$1: $(sed -n 2p "$2" | head -1)"; }

for name in film_halves viewer_loop allocator; do
  example $name
  [ $name = allocator ] && expect_text "allocator: nothing is left" " 0 blocks are left"
  check "$name: the bytes of velo render" cmp whole.pfm $name.pfm
done
example own_camera
size "own_camera" own_camera.pfm "60 40"
mean "own_camera: another view" whole.pfm own_camera.pfm 0.2 0.95
example own_sampler
mean "own_sampler: the mean of velo's" whole.pfm own_sampler.pfm 0.97 1.03
example own_tracer
"$VELO" render corner.pbrt --quiet --spp 64 --max-depth 2 -o two.pfm
mean "own_tracer: the mean of path with two bounces" two.pfm own_tracer.pfm 0.95 1.05
example edit_render
size "edit_render: two images" edit_render.pfm "120 40"
example stereo
size "stereo: two images" stereo.pfm "120 40"
example depth_points
check "depth_points: a point for each pixel" grep -q "element vertex 2400" depth_points.pfm.ply
check "depth_points: points in the room" awk 'NR > 7 && ($2 < -0.01 || $2 > 3.5) && n++ > 300 {exit 1}' depth_points.pfm.ply
example thousand_frames
size "thousand_frames: a sheet" thousand_frames.pfm "384 160"
expect_code 0 "build_world" "$VELO_BINARY_DIR/bin/example_build_world" build_world.png
expect_code 0 "render_file" "$VELO_BINARY_DIR/bin/example_render_file" corner.pbrt render_file.pfm
check "render_file: the bytes of velo render" cmp whole.pfm render_file.pfm
expect_code 2 "an example without arguments" "$VELO_BINARY_DIR/bin/example_stereo"
expect_code 1 "an example without its scene" "$VELO_BINARY_DIR/bin/example_stereo" missing.pbrt a.pfm

if PYTHONPATH=$VELO_BINARY_DIR/python /usr/bin/python3 -c 'import numpy, velo' 2>/dev/null; then
  for name in own_camera own_sampler own_tracer; do
    expect_code 0 "$name.py" env PYTHONPATH="$VELO_BINARY_DIR/python" /usr/bin/python3 "$examples/python/$name.py" corner.pbrt "python_$name.pfm"
    mean "$name.py: the mean of $name" $name.pfm python_$name.pfm 0.97 1.03
  done
else
  skip "the examples in Python" "no module velo for Python with numpy"
fi

# The functions that docs/own-code.md shows, in the programs of the examples, compiled as a stranger would, without a warning.
# shown KIND FUNCTION: shown_KIND.c, the example own_KIND with the function (and what stands with it) of the page
shown() {
  awk -v start="static void $2(" '/^```c/ {text = ""; inside = 1; next}
    /^```/ {if (inside && index(text, start)) {printf "%s", text; exit} inside = 0}
    inside {text = text $0 "\n"}' "$VELO_SOURCE_DIR/docs/own-code.md" >function.c
  sed '/^static /,$d' "$examples/own_$1.c" | { printf '#include <math.h>\n'; cat; } >"shown_$1.c"
  cat function.c >>"shown_$1.c"
  sed -n '/^\/\* Of a call that fails/,$p' "$examples/own_$1.c" | sed "s/radiance_of/$2/; /static const vlOwnCamera/d; s/&fisheye/\&pinhole/; /right_angle/d" \
    >>"shown_$1.c"
  check "docs: $2 is compiled" "${CC:-cc}" -std=c17 -O1 -Wall -Wextra -Werror "-I$VELO_SOURCE_DIR/include" "shown_$1.c" \
    "-L$VELO_BINARY_DIR/lib" -lvelo -lm "-Wl,-rpath,$VELO_BINARY_DIR/lib" -o "shown_$1"
}
if command -v "${CC:-cc}" >/dev/null && ! nm -D "$VELO_BINARY_DIR/lib/libvelo.so" | grep -q '__[at]san_init\|__ubsan'; then
  shown camera rays_of
  check "docs: the camera renders" ./shown_camera corner.pbrt shown_camera.pfm
  shown tracer occlusion
  check "docs: the tracer renders" ./shown_tracer corner.pbrt shown_tracer.pfm
  "$VELO" render corner.pbrt --quiet --spp 64 --tracer ambientocclusion -o occlusion.pfm
  mean "docs: the tracer's mean is that of velo's" occlusion.pfm shown_tracer.pfm 0.97 1.03
else
  skip "the functions of docs/own-code.md" "no compiler, or a library with a sanitizer"
fi

for source in "$examples"/*.c; do
  name=$(basename "$source" .c)
  [ "$name" = lecture ] && continue # the lecture's program has pictures of its own
  picture=$examples/$name.jpg
  check "$name: a picture beside it" test -s "$picture"
  check "$name: of less than 100 KB" test "$(stat -c %s "$picture" 2>/dev/null || echo 1000000)" -lt 100000
  check "$name: its command in its head" grep -q "build/release/bin/example_$name " "$source"
done
finish
