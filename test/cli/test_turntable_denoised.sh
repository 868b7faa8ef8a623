#!/usr/bin/env bash
# Denoised frames of a turntable: each uses the five before it, so that what is left of the noise flickers less. The bits
# depend neither on the division of the frames nor on the number of threads.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
# All views are the same from all sides: what differs is noise.
write_round_scene round.pbrt
turn="--turntable 12 --quiet"
check all "$VELO" render round.pbrt $turn -t 2 -o f%02d.pfm --denoise c%02d.pfm
check all_frames test "$(ls f*.pfm c*.pfm | wc -l)" = 24
check raw "$VELO" render round.pbrt $turn --frames 5 -o r%02d.pfm
check raw_same cmp f05.pfm r05.pfm
check part "$VELO" render round.pbrt $turn --frames 0-9:9 -t 1 -o p%02d.pfm --denoise d%02d.pfm
check part_same cmp d09.pfm c09.pfm
check part_first_same cmp d00.pfm c00.pfm
check part_raw_same cmp p09.pfm f09.pfm
check part_alone test "$(ls p*.pfm d*.pfm | wc -l)" = 4
cp c07.pfm kept.pfm
rm c07.pfm
check skip "$VELO" render round.pbrt $turn -o f%02d.pfm --denoise c%02d.pfm --skip-existing
check skip_same cmp c07.pfm kept.pfm
check steps "$VELO" render round.pbrt --turntable 72 --quiet --frames 6-7 -o s%02d.pfm --denoise s%02d-clean.pfm
for n in 06 07; do
  check one_$n "$VELO" render round.pbrt --turn $((5 * 10#$n)) --quiet --channels error,features -o e$n.exr
  check one_clean_$n "$VELO" image denoise e$n.exr -o n$n.pfm
done
check flickers_less below "$(mse s06-clean.pfm s07-clean.pfm)" "$(mse n06.pfm n07.pfm)" 0.25
check reference "$VELO" render round.pbrt --spp 1024 --quiet -o reference.pfm
check nearer below "$(mse s07-clean.pfm reference.pfm)" "$(mse n07.pfm reference.pfm)" 1
# Nothing leaks into the black around.
check black python3 - <<'END'
import struct
data = open("s07-clean.pfm", "rb").read()[-96 * 72 * 12:]
row = struct.unpack("<288f", data[70 * 96 * 12:71 * 96 * 12])
assert max(row) == 0, max(row)
END
check display "$VELO" render round.pbrt --turntable 3 --quiet --exposure auto -o f%02d.png --denoise c%02d.png
check two "$VELO" render round.pbrt --turntable 1 --quiet -o one%d.pfm --denoise only%d.pfm
check dry "$VELO" render round.pbrt --turntable 12 --dry-run -o f%02d.pfm --denoise c%02d.pfm
expect_code 2 no_number "$VELO" render round.pbrt $turn -o f%02d.pfm --denoise c.pfm
expect_text no_number_says "--denoise \"c.pfm\": put %04d, the frame's number, into the name"
expect_code 2 same_name "$VELO" render round.pbrt $turn -o f%02d.pfm --denoise f%02d.pfm
expect_code 2 oidn "$VELO" render round.pbrt $turn -o f%02d.pfm --denoise c%02d.pfm --denoiser oidn
expect_text oidn_says "velo's own denoiser"
finish
