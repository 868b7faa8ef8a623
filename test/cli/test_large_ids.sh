#!/usr/bin/env bash
# Integer channels are floats in files where all numbers are below 2^24, and integers where one is not: no number is
# rounded. The largest number that is soon reached is that of the samples of one pixel.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
cat >pixel.pbrt <<'END'
Camera "perspective"
Film "rgb" "integer xresolution" 1 "integer yresolution" 1
WorldBegin
LightSource "infinite"
END
# counts NAME SAMPLES TYPE
counts() {
  local name=$1 samples=$2 type=$3
  run "$VELO" render pixel.pbrt --tracer raycast --sampler independent --filter box --channels samples --spp "$samples" -t 1 -o "$name.exr"
  case "$err" in *"ids of 2^24 and more"*) local noted=integer ;; *) local noted=float ;; esac
  [ "$code" = 0 ] && [ "$noted" = "$type" ] && pass "${name}_note" || { fail "${name}_note"; show render; }
  run "$VELO" image info "$name.exr" --json
  [[ $out == *"\"32-bit float\", \"32-bit $type\"]"* || ($type == float && $out != *integer*) ]] && pass "${name}_type" || { fail "${name}_type"; show info; }
  "$VELO" image convert "$name.exr" "$name.pfm" --channel samples.Y >/dev/null 2>&1
  [ "$(tail -c 4 "$name.pfm" | od -A n -t f4 | tr -d ' ')" = "$samples" ] && pass "${name}_value" || fail "${name}_value"
}
counts few 12345 float
is_plain_build && counts many 16777216 integer
finish
