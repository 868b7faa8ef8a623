#!/usr/bin/env bash
# web/lecture: the lecture's pages as HTML, sliders, and formulas with numbers. Needs node.
. "$(dirname "$0")/../harness.sh"
command -v node >/dev/null 2>&1 || {
  skip page "needs node"
  exit 77
}
cp "$VELO_SOURCE_DIR"/web/lecture/*.js "$work"
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

cd "$work" || exit 1
node test_page.js "$VELO_SOURCE_DIR/docs"
