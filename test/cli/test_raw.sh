# velo raw info and develop: what is printed, every step's image, exit codes, and files that are none.
. "$VELO_SOURCE_DIR/test/harness.sh"
cd "$work" || exit 1
case "$("$VELO" --version)" in
  *libtiff*) ;;
  *)
    cp "$VELO_SOURCE_DIR/test/fuzz/corpus/raw/bayer.dng" a.dng
    expect_code 3 "a velo without libtiff says so" "$VELO" raw info a.dng
    expect_text "and what it lacks" "this build has no DNG: it was made without libtiff"
    skip "$(basename "$0")" "needs a velo with libtiff"
    finish
    exit
    ;;
esac
cp "$VELO_SOURCE_DIR"/test/fuzz/corpus/raw/*.dng .

check info "$VELO" raw info bayer.dng
for text in "9 x 6" "RG/GB" "64 65 66 67" "4000" "Sample 1" "0.005 s" "0.05 m" "2.5 electrons" "0.25 numbers per electron"; do
  expect_text "info has $text" "$text"
done
check info_json "$VELO" raw info --json quad.dng
expect_text "JSON has the pattern" '"pattern": "RRGG/RRGG/GGBB/GGBB"'
expect_text "single precision has its own digits" '"exposure_time": 0.005,'
check "JSON is JSON" sh -c '"$0" raw info --json rgbw.dng | python3 -m json.tool' "$VELO"

for step in black white demosaic color tone; do
  check "develop to $step" "$VELO" raw develop bayer.dng -o $step.exr --stop-at $step
  check "develop to $step again" "$VELO" raw develop bayer.dng -o again.exr -o $step.png --stop-at $step
  check "$step has the same bytes" cmp $step.exr again.exr
done
check channels "$VELO" image info demosaic.exr
expect_text "the colours are channels" "R G B"
check mosaic "$VELO" image info black.exr
expect_text "the mosaic is one channel" "1: Y"
check sixteen "$VELO" image info tone.png
expect_text "tone has 16 bits" "16-bit integer, sRGB"
check mono "$VELO" raw develop mono.dng -o mono.png
check rgbw "$VELO" raw develop rgbw.dng -o rgbw.exr --stop-at demosaic
check rgbw_info "$VELO" image info rgbw.exr
expect_text "a white pixel is a colour" "R G B W"
check exposed "$VELO" raw develop bayer.dng -o exposed.png --exposure 1
check "exposure changes the image" sh -c '! cmp -s exposed.png tone.png'

expect_code 2 "no output" "$VELO" raw develop bayer.dng
expect_text "is asked for" "-o"
expect_code 2 "no such step" "$VELO" raw develop bayer.dng -o a.png --stop-at colour
expect_text "the nearest is named" "color"
expect_code 2 "an exposure that is none" "$VELO" raw develop bayer.dng -o a.png --exposure nan
expect_code 2 "an unknown format" "$VELO" raw develop bayer.dng -o a.gif
cp bayer.dng in.png
expect_code 2 "the input is not overwritten" "$VELO" raw develop in.png -o in.png
expect_code 2 "which raw command" "$VELO" raw
expect_text "is told" "develop"
expect_code 2 "a file without a command" "$VELO" bayer.dng
expect_text "info is meant" "velo raw info bayer.dng"
expect_code 4 "a missing file" "$VELO" raw info none.dng
expect_code 5 "a folder that is not there" "$VELO" raw develop bayer.dng -o none/a.png
echo "no picture" >text.dng
head -c 300 bayer.dng >short.dng
: >empty.dng
for file in text short empty; do
  expect_code 3 "$file.dng is refused" "$VELO" raw info $file.dng
  check "$file.dng: one line" test "$(printf '%s\n' "$err" | wc -l)" = 1
done
expect_code 3 "an image is no raw file" "$VELO" raw develop tone.png -o b.png
finish
