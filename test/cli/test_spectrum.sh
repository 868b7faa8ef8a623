#!/usr/bin/env bash
# Spectra through the program: pbrt's spectral film, --spectrum, what the file holds, what cannot be.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1

cat >spectral.pbrt <<'SCENE'
Camera "perspective"
Film "spectral" "integer xresolution" 12 "integer yresolution" 8 "string filename" "asked.exr"
  "integer nbuckets" 5 "float lambdamin" 400 "float lambdamax" 700
Sampler "independent" "integer pixelsamples" 32
WorldBegin
LightSource "infinite" "spectrum L" [300 1 900 1]
SCENE
sed 's/Film "spectral"/Film "rgb"/; s/"integer nbuckets".*//' spectral.pbrt >plain.pbrt

check render "$VELO" render spectral.pbrt --quiet
check info "$VELO" image info asked.exr
expect_text channels '9: R G B A S0.430,000nm S0.490,000nm S0.550,000nm S0.610,000nm S0.670,000nm'
expect_text layout 'spectralLayoutVersion     1.0'
expect_text units 'emissiveUnits             W.m^-2.sr^-1'
check by_option "$VELO" render plain.pbrt -o option.exr --spectrum 5:400:700 --quiet
check same_pixels "$VELO" image diff asked.exr option.exr --threshold differing=0
check left_out "$VELO" render spectral.pbrt -o none.exr --spectrum 0 --quiet
check none_info "$VELO" image info none.exr
expect_text none_channels '4: R G B A'
check other_format "$VELO" render spectral.pbrt -o image.png --quiet
expect_text other_format_warns 'warning: spectrum: image.png cannot hold it, only .exr can'
check with_channels "$VELO" render spectral.pbrt -o both.exr --channels Z --half --quiet
check with_channels_info "$VELO" image info both.exr
expect_text both '10: '
expect_text both_spectrum ' S0.430,000nm'
expect_code 2 no_rgb "$VELO" render spectral.pbrt -o no.exr --color rgb
expect_text no_rgb_says 'color rgb: the film of spectral.pbrt is in wavelengths; --spectrum 0 leaves them out'
expect_code 2 no_rgb_given "$VELO" render plain.pbrt -o no.exr --color rgb --spectrum 5
expect_text no_rgb_given_says 'color rgb: there is no spectrum then'
expect_code 2 bad_number "$VELO" render plain.pbrt -o no.exr --spectrum 5:300:700
expect_code 2 bad_words "$VELO" render plain.pbrt -o no.exr --spectrum many
check nothing_written test ! -e no.exr

# What varies with the wavelength and cannot here.
for material in 'Material "coateddiffuse"' 'MakeNamedMaterial "pot" "string type" "coateddiffuse"'; do
  { cat plain.pbrt; printf '%s "spectrum eta" "glass-BK7"\n' "$material"; } >coat.pbrt
  printf 'Shape "disk"\n' >>coat.pbrt
  check coat "$VELO" render coat.pbrt -o coat.exr --spp 1 --quiet
  expect_text coat_says "warning: coat.pbrt:$(grep -n glass-BK7 coat.pbrt | cut -d: -f1):1: "
done
expect_text coat_name 'material "pot": dispersion of this kind is not supported'
finish
