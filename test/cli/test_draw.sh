#!/usr/bin/env bash
# velo camera draw: drawings have their size and colours, options change what is drawn, wrong calls.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
small="--size 240x160 --spp 2"
check whole "$VELO" camera draw scene.pbrt -o whole.png $small
check same_again "$VELO" camera draw scene.pbrt -o again.png $small
same same_bytes whole.png again.png
check sheet "$VELO" camera draw scene.pbrt -o sheet.png $small --no-scene
check film "$VELO" camera draw scene.pbrt -o film.png $small --no-scene --parts eye,film,volume,projector
check frustum "$VELO" camera draw scene.pbrt -o frustum.png $small --no-scene --near 1 --far 6
check only_eye "$VELO" camera draw scene.pbrt -o eye.png $small --no-scene --parts eye --zoom 0.5
check points "$VELO" camera draw scene.pbrt -o points.png $small --no-scene --point 0,0.5,0 --point 1,1,1 --plane 1.5 --grid 4
for scene in equidistant equirectangular opencv lens_tilt optics_single; do
  check "$scene" "$VELO" camera draw "$VELO_SOURCE_DIR/scenes/cameras/$scene.pbrt" -o "$scene.jpg" $small --no-scene
done
printf '0 0 1 4 0 0 0 1\n1 0.5 1 4 0 0 0 1\n2 1 1 4 0 0 0 1\n' >way.tum
check trajectory "$VELO" camera draw scene.pbrt -o way.png $small --trajectory way.tum
cat >drawn.py <<'CODE'
import numpy, OpenImageIO as oiio
def image(name):
    b = oiio.ImageBuf(name)
    assert (b.spec().width, b.spec().height) == (240, 160), name
    return b.get_pixels(oiio.FLOAT)[:, :, :3]
def share(p, color):  # of the pixels of about that colour
    return (numpy.abs(p - numpy.array(color) / 255).max(axis=2) < 0.25).mean()
orange, blue, green, red = (225, 95, 0), (20, 70, 170), (10, 120, 60), (200, 30, 30)
sheet, frustum, eye, film = image("sheet.png"), image("frustum.png"), image("eye.png"), image("film.png")
assert (sheet == 1).all(axis=2).mean() > 0.4
for color in (orange, blue, red): assert share(sheet, color) > 0.001, color
assert share(frustum, green) > 2 * share(sheet, green), (share(frustum, green), share(sheet, green))
assert share(film, blue) < 0.0005 and share(film, orange) > 0.001
assert 0.0002 < (eye != 1).any(axis=2).mean() < 0.02
assert numpy.abs(image("whole.png") - sheet).mean() > 0.05
assert (image("points.png") != sheet).any()
assert share(image("way.png"), orange) > 0.001
CODE
if /usr/bin/python3 -c 'import OpenImageIO' 2>/dev/null; then check drawn /usr/bin/python3 drawn.py; else skip drawn "no OpenImageIO"; fi

expect_code 2 no_output "$VELO" camera draw scene.pbrt
expect_line no_output_words "-o FILE"
expect_code 2 exr "$VELO" camera draw scene.pbrt -o a.exr
expect_code 2 point "$VELO" camera draw scene.pbrt -o a.png --point 1,2
expect_line point_words "x,y,z"
expect_code 2 from "$VELO" camera draw scene.pbrt -o a.png --from 10,95
expect_code 2 part "$VELO" camera draw scene.pbrt -o a.png --parts windw
expect_line part_words 'did you mean "window"'
expect_code 2 planes "$VELO" camera draw scene.pbrt -o a.png --near 3 --far 2
expect_code 4 missing "$VELO" camera draw none.pbrt -o a.png
expect_code 5 folder "$VELO" camera draw scene.pbrt -o none/a.png --no-scene
finish
