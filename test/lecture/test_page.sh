#!/usr/bin/env bash
# web/lecture: the lecture's pages as HTML, sliders, and formulas with numbers. Needs node.
. "$(dirname "$0")/../harness.sh"
command -v node >/dev/null 2>&1 || {
  skip page "needs node"
  exit 77
}
cp -r "$VELO_SOURCE_DIR/web" "$work"
cp "$VELO_SOURCE_DIR/test/lecture/page.js" "$work/test_page.js"
echo '{ "type": "module" }' >"$work/package.json"

# The rays of some pixels; the lecture's r counts upwards.
sed 's/"float roll" 0/"float roll" 30/; s/"float zoom" 1/"float zoom" 2/; s/^Include.*//' \
  "$VELO_SOURCE_DIR/scenes/lecture/pinhole.pbrt" >"$work/camera.pbrt"
pixels='0,0 479,639 17,300 240,320 400,2'
for pixel in $pixels; do
  r=${pixel%,*} c=${pixel#*,}
  echo "$c.5,$((479 - r)).5"
done >"$work/pixels.csv"
if [ -x "$VELO" ]; then
  "$VELO" camera unproject --camera "$work/camera.pbrt" "$work/pixels.csv" | tail -n +2 >"$work/velo.csv"
  tr ' ' '\n' <<<"$pixels" | paste -d, - "$work/velo.csv" >"$work/rays.csv"
fi

"$VELO_SOURCE_DIR/tools/lecture_figures" --check >"$work/figures.txt" && pass figures_are_drawn || fail figures_are_drawn "$(cat "$work/figures.txt")"
# The slides' program, in C: its image is that of the drawn figures.
if "${CC:-cc}" -std=c17 -O1 "$VELO_SOURCE_DIR/examples/lecture.c" -lm -o "$work/slides" 2>/dev/null; then
  "$work/slides" size=40x30 s=10 n=1 >"$work/lecture.ppm"
fi

cd "$work" || exit 1
node test_page.js "$VELO_SOURCE_DIR/docs" || failures=1
exit "$((failures > 0))"
