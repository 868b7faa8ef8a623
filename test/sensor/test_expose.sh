#!/usr/bin/env bash
# `velo sensor expose`: from a rendered spectrum to numbers and electrons; the mean against the formula; the same bytes
# with any number of threads; brackets; bad input.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1

cat >flat.pbrt <<'SCENE'
Camera "perspective"
Film "rgb" "integer xresolution" 64 "integer yresolution" 48 "string filename" "flat.exr"
Sampler "independent" "integer pixelsamples" 64
WorldBegin
LightSource "infinite" "spectrum L" [300 1 900 1]
SCENE
check render "$VELO" render flat.pbrt --spectrum 47 --filter box --channels error --quiet
check expose "$VELO" sensor expose flat.exr --radiance 1e-4 --exposure-time 0.02 --f-number 2 --seed 3 -o raw.png -o e.exr
check info "$VELO" image info raw.png
expect_text sixteen_bits '16-bit integer'
check mean python3 - <<'PYTHON'
import math, subprocess, os, zlib, struct
data = open("raw.png", "rb").read()
at, pixels = 8, b""
while at < len(data):
    length, kind = struct.unpack(">I4s", data[at:at + 8])
    pixels += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
    at += 12 + length
raw = zlib.decompress(pixels)
rows, previous = [], bytearray(128)
for y in range(48):
    kind, line = raw[129 * y], bytearray(raw[129 * y + 1:129 * (y + 1)])
    for i in range(128):
        a = line[i - 2] if i >= 2 else 0
        b, c = previous[i], previous[i - 2] if i >= 2 else 0
        p = a + b - c
        paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
    rows += struct.unpack(">64H", line)
    previous = line
h, c = 6.62607015e-34, 299792458.0
energy = math.pi * 1e-4 / (4 * 2 * 2) * (5e-6) ** 2 * 0.02   # per nm
expected = energy * 1e-9 * (830 ** 2 - 360 ** 2) / 2 / (h * c)
mean = sum(rows) / len(rows)
variance = sum((v - mean) ** 2 for v in rows) / (len(rows) - 1)
print(expected, mean, variance)
assert abs(mean / expected - 1) < 0.003 + 5 / math.sqrt(expected * len(rows))
assert abs(variance / expected - 1) < 0.1
PYTHON
check one_thread "$VELO" sensor expose flat.exr --radiance 1e-4 --exposure-time 0.02 --f-number 2 --seed 3 -o one.png -t 1
same any_threads raw.png one.png
check other_seed "$VELO" sensor expose flat.exr --radiance 1e-4 --exposure-time 0.02 --f-number 2 --seed 4 -o four.png
if cmp -s raw.png four.png; then fail seeds_differ; else pass seeds_differ; fi
check whole "$VELO" sensor expose flat.exr --sensor ideal_rggb --radiance 1e-4 --focal-length 4 -o whole.exr
check crop "$VELO" render flat.pbrt --spectrum 47 --filter box --channels error --crop 21,11,50,40 -o part.exr --quiet
check expose_crop "$VELO" sensor expose part.exr --sensor ideal_rggb --radiance 1e-4 --focal-length 4 -o part_e.exr
check crop_of_whole "$VELO" image convert whole.exr whole_part.exr --crop 21,11,50,40
check blurred "$VELO" render flat.pbrt --spectrum 47 --spp 64 -o blurred.exr --quiet
check expose_blurred "$VELO" sensor expose blurred.exr -o blurred_e.exr
expect_text filter 'render it with --filter box'
check few "$VELO" render flat.pbrt --spectrum 47 --filter box --spp 8 -o few.exr --quiet
check expose_few "$VELO" sensor expose few.exr -o few_e.exr
expect_text empty_buckets 'the image has 8 samples per pixel for 47 buckets'
check tif "$VELO" sensor expose flat.exr --radiance 1e-4 --exposure-time 0.02 --f-number 2 --seed 3 -o raw.tif -o same.tiff
same tif_and_tiff raw.tif same.tiff
check tif_has_the_numbers python3 - <<'END'
import struct, zlib
png, tif = open("raw.png", "rb").read(), open("raw.tif", "rb").read()
at, packed = 8, b""
while at < len(png):
    size, kind = struct.unpack(">I4s", png[at:at + 8])
    if kind == b"IHDR": width, height = struct.unpack(">II", png[at + 8:at + 16])
    if kind == b"IDAT": packed += png[at + 8:at + 8 + size]
    at += size + 12
rows, step = zlib.decompress(packed), 2 * width + 1
def row(y, before):
    line, kind = bytearray(rows[y * step + 1:(y + 1) * step]), rows[y * step]
    for i in range(len(line)):  # the filters of PNG, 2 bytes per pixel
        a, b, c = line[i - 2] if i > 1 else 0, before[i], before[i - 2] if i > 1 else 0
        p = a + b - c
        paeth = min((a, b, c), key=lambda v: (abs(p - v), (a, b, c).index(v)))
        line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
    return line
before, numbers = bytes(2 * width), b""
for y in range(height):
    before = row(y, before)
    numbers += struct.pack("<%dH" % width, *struct.unpack(">%dH" % width, before))
assert tif[:4] == b"II*\0" and numbers in tif
END

check compare "$VELO" image diff part_e.exr whole_part.exr
expect_text crop_is_the_whole_s_part 'differing  0'
check bracket "$VELO" sensor expose flat.exr --sensor generic_rggb --radiance 1e-3 --bracket=-4,0,9 -o b_%d.png
expect_text saturated 'frame 2: 100.00 % of the pixels have a full well'
check three_frames test -s b_0.png -a -s b_1.png -a -s b_2.png
check dim "$VELO" sensor expose flat.exr --radiance 1e3 -o dim.png
expect_text film_noise "the image's own noise is above a tenth of the photon noise"

cat >bad.yaml <<'YAML'
preset: generic_mono
full_well: 0 e-
YAML
expect_code 3 full_well "$VELO" sensor expose flat.exr --sensor bad.yaml -o no.png
expect_text full_well_says 'bad.yaml:2:12: full_well must be a number from 1 to 1000000000; it is 0 e-'
expect_code 2 no_preset "$VELO" sensor expose flat.exr --sensor generic_mon -o no.png
expect_text no_preset_says 'the nearest is "generic_mono"'
expect_code 4 no_file "$VELO" sensor expose flat.exr --sensor none.yaml -o no.png
expect_code 2 negative "$VELO" sensor expose flat.exr --exposure-time=-1 -o no.png
expect_text negative_says 'exposure-time must be'
expect_code 2 suffix "$VELO" sensor expose flat.exr -o no.jpg
expect_code 2 names "$VELO" sensor expose flat.exr --bracket 0,1 -o no.png
expect_code 2 bracket_words "$VELO" sensor expose flat.exr --bracket many -o no_%d.png
check plain "$VELO" render flat.pbrt --spp 1 -o plain.exr --quiet
expect_code 3 no_spectrum "$VELO" sensor expose plain.exr -o no.png
expect_text no_spectrum_says 'plain.exr: the image has no spectrum'
check nothing_written test ! -e no.png

silent() { # NAME: the last command did not speak of a shutter
  case "$err" in *shutter*) fail "$1" ;; *) pass "$1" ;; esac
}
# The exposure of an image with motion is that of its shutter.
{
  printf 'ActiveTransform EndTime\nTranslate .1 0 0\nActiveTransform All\n'
  sed 's/^Camera "perspective"/& "float shutteropen" 0 "float shutterclose" 0.02/' flat.pbrt
} >moving.pbrt
check moving "$VELO" render moving.pbrt --spectrum 4 --spp 1 -o moving.exr --quiet
check moving_expose "$VELO" sensor expose moving.exr --exposure-time 0.1 -o moving.png
expect_text moving_says 'camera moves, and its shutter is open for 0.02 s; the sensor is exposed for 0.1 s: --exposure-time 0.02 has'
check moving_alike "$VELO" sensor expose moving.exr --exposure-time 0.02 -o moving.png
silent moving_is_silent
sed 's/^Camera "perspective"/Camera "pinhole" "float shutterclose" 0.02 "float readout" 0.03/' flat.pbrt >rolling.pbrt
check rolling "$VELO" render rolling.pbrt --spectrum 4 --spp 1 -o rolling.exr --quiet
check rolling_expose "$VELO" sensor expose rolling.exr --exposure-time 0.1 -o rolling.png
expect_text rolling_says 'camera has a rolling shutter, and its shutter is open for 0.02 s'
check still_expose "$VELO" sensor expose flat.exr --exposure-time 0.1 -o still.png
silent still_is_silent
finish
