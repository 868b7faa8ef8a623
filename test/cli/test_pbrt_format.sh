#!/usr/bin/env bash
# A scene with every directive, entity and parameter name of pbrt-v4's file format, and each choice that a file makes
# once only: all load and render, and nothing but what docs/pbrt.md says is told.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
cp "$VELO_SOURCE_DIR"/test/cli/pbrt_format/* .
cp "$VELO_SOURCE_DIR"/scenes/features/tetrahedron.ply .
cp "$VELO_SOURCE_DIR"/scenes/cameras/lenses/double_gauss_50mm.dat lens.dat
cat >image.pbrt <<'SCENE'
Camera "perspective"
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 1
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.7]
SCENE
"$VELO" render image.pbrt -o p.png -o p.jpg -o p.exr -o p.hdr -o p.pfm -o p.tga --quiet
"$VELO" image convert p.exr p16.png --channel R --scale 60000
cp p.exr square.exr
"$VELO_BINARY_DIR/bin/helper_measured" measured.bsdf 0.4 0.4 1.2 3 0

# quiet NAME FILE: renders, and says nothing but lines that hold one of $allowed.
quietly() {
  run "$VELO" render "$2" -o result.exr --quiet
  if [ "$code" != 0 ] || printf '%s\n' "$err" | grep . | grep -qvE "$allowed"; then
    fail "$1"
    show "it"
  else
    pass "$1"
  fi
}

allowed='^$'
quietly whole format.pbrt
check doctor "$VELO" scene info format.pbrt

# A tracer that ignores media or subsurface scattering is reported.
allowed='looks past participating media|renders material "subsurface" as clear glass'
count=0
while IFS= read -r line; do
  kind=${line%% *}
  count=$((count + 1))
  if [ "$kind" = Option ]; then
    name=$(printf '%s' "$line" | cut -d'"' -f2)
    { printf '%s\n' "$line" && grep -v "^Option \"$name\"" format.pbrt; } >variant.pbrt
  else # instead of the first one, with the lines that belong to it
    awk -v kind="$kind" -v line="$line" '
      !done && $1 == kind { print line; done = skip = 1; next }
      skip && /^ / { next }
      { skip = 0; print }' format.pbrt >variant.pbrt
  fi
  quietly "$count: $(printf '%.60s' "$line")" variant.pbrt
done <options.txt

# A measured camera has its own colours, whoever names it; one that nobody knows is an error, permissively cie1931.
sed 's/"string sensor" "cie1931"/"string sensor" "canon_eos_100d"/' format.pbrt >measured.pbrt
check measured "$VELO" render measured.pbrt -o measured.exr --quiet
check sensor_option "$VELO" render format.pbrt --sensor canon_eos_100d -o option.exr --quiet
check sensor_both_ways "$VELO" image diff measured.exr option.exr --threshold differing=0
expect_code 2 sensor_unknown_option "$VELO" render format.pbrt --sensor canon_eos_100e -o no.exr --quiet
expect_text sensor_option_nearest 'did you mean "canon_eos_100d"?'
sed 's/"string sensor" "cie1931"/"string sensor" "canon_eos_100e"/' format.pbrt >sensor.pbrt
expect_code 3 sensor "$VELO" render sensor.pbrt -o no.exr --quiet
expect_text sensor_says 'unknown sensor "canon_eos_10…" (did you mean "canon_eos_100d"?)'
check sensor_permissive "$VELO" render sensor.pbrt -o sensor.exr --permissive --quiet
expect_code 1 measured_differs "$VELO" image diff measured.exr sensor.exr --threshold differing=0
# What velo has not is told by its name.
sed 's/"float whitebalance" 0/"float whitebalance" 6500/' format.pbrt >white.pbrt
check white "$VELO" render white.pbrt -o white.exr --quiet
check as_cie1931_by_daylight "$VELO" image diff sensor.exr white.exr --threshold differing=0
sed 's/"forcediffuse" false/"forcediffuse" true/' format.pbrt >diffuse.pbrt
expect_code 3 forcediffuse "$VELO" render diffuse.pbrt -o no.exr --quiet
expect_text forcediffuse_says 'Option "forcediffuse": velo cannot'
sed 's/"constant" "float value" 0.25/"ptex" "string filename" "a.ptx"/' included.pbrt >ptex.pbrt
sed 's/included.pbrt/ptex.pbrt/' format.pbrt >with_ptex.pbrt
expect_code 3 ptex "$VELO" render with_ptex.pbrt -o no.exr --quiet
expect_text ptex_says 'Ptex files are not supported'
check nothing_written test ! -e no.exr
finish
