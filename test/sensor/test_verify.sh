#!/usr/bin/env bash
# `velo sensor verify`: sensors give their parameters back; too few pixels do not, and the exit code says so; the plot;
# the folder of frames is not written over.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1

cat >noisy.yaml <<'YAML'
preset: generic_rggb
dsnu: 4 e-
prnu: 2 %
crosstalk: [[0, 0.02, 0], [0.02, 0.92, 0.02], [0, 0.02, 0]]
YAML
gzip -c noisy.yaml >packed.yaml # by its content
check packed "$VELO" sensor verify packed.yaml
check noisy "$VELO" sensor verify noisy.yaml --plot plot.svg
for row in gain efficiency saturation 'dark noise' 'dark current' DSNU PRNU 'linearity error' 'MTF error'; do
  case "$out" in *"$row, "*|*"$row to "*) pass "row_${row// /_}" ;; *) fail "row_${row// /_}" ;; esac
done
check plot grep -q '<circle' plot.svg
check gain_of_iso "$VELO" sensor verify noisy.yaml --iso 400
case "$out" in *"gain, DN/e-  "*" 1.05263 "*) pass iso_400 ;; *) fail iso_400 ;; esac
printf 'full_well: 1 e-\nbits: 1 bits\n' >tiny.yaml
expect_code 1 tiny "$VELO" sensor verify tiny.yaml --size 16 --stack 3
check ideal "$VELO" sensor verify ideal --size 256
case "$out" in *"dark noise, e-           the noise of dark frames is below the converter's steps"*) pass ideal_dark ;; *) fail ideal_dark ;; esac
expect_code 1 few_pixels "$VELO" sensor verify generic_mono --size 16 --stack 3
case "$out" in *WRONG*) pass few_pixels_says ;; *) fail few_pixels_says ;; esac
run "$VELO" sensor verify generic_mono --size 64 --stack 3 -t 1 --frames one
run "$VELO" sensor verify generic_mono --size 64 --stack 3 -t 3 --frames three
same any_threads one/frame_0100.png three/frame_0100.png
same any_threads_descriptor one/EMVA1288_Data.txt three/EMVA1288_Data.txt
expect_code 5 not_over "$VELO" sensor verify generic_mono --size 64 --stack 3 --frames one
expect_text not_over_says 'needs a new or an empty folder'
mkdir -p torn/frame_0002.png
expect_code 5 frame_in_the_way "$VELO" sensor verify generic_mono --size 64 --stack 3 --frames torn
check named_are_there grep -q frame_0001.png torn/EMVA1288_Data.txt
expect_code 1 not_there_not_named grep frame_0002.png torn/EMVA1288_Data.txt
expect_code 2 no_preset "$VELO" sensor verify generic_mon
finish
