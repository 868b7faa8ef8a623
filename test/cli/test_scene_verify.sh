#!/usr/bin/env bash
# velo scene verify: quiet on a scene on which the tracers agree, exit 1 where moved copies do not; the same bytes for any number
# of threads; JSON; what is not compared is said.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1

head='LookAt 0 -4 1.5  0 0 0.4  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
WorldBegin
AttributeBegin AreaLightSource "diffuse" "rgb L" [9 8 7]
Translate -1 -1 2.5 ReverseOrientation Shape "disk" "float radius" 0.5 AttributeEnd
Translate 0 0 0.1'
body='Shape "bilinearmesh" "point3 P" [-2 -2 0 2 -2 0 -2 2 0 2 2 0]
AttributeBegin Material "diffuse" "rgb reflectance" [.7 .3 .2] Translate 0 0 .6
Shape "sphere" "float radius" 0.5 AttributeEnd'
unset VELO_REFERENCE
verify() { "$VELO" scene verify "$@" --rays 0.4; }
line() { if grep -q "$2" <<<"$out"; then pass "$1"; else fail "$1 (no '$2')"; fi; }
reference=$VELO_BINARY_DIR/bin/velo-reference

printf '%s\n' "$head" "$body" >plain.pbrt
check agrees verify plain.pbrt --threads 2
for run in reference bidirectional lightpath randomwalk 'merging .*not judged' 'volpath, shifted' 'volpath, turned' 'volpath, scaled' \
  'bidirectional, moved'; do
  if grep -q "^$run" <<<"$out"; then pass "row_of_$run"; else fail "row_of_$run"; fi
done
expect_text says_so '0 of 8 comparisons differ beyond chance'
cp .out two
check one_thread verify plain.pbrt --threads 1
if cmp -s .out two; then pass same_bytes; else fail same_bytes; fi
check other_seed verify plain.pbrt --seed 5
if cmp -s .out two; then fail seed_counts; else pass seed_counts; fi
check json verify plain.pbrt --json
if "$VELO" scene verify plain.pbrt --rays 0.4 --json | python3 -c '
import json, sys
d = json.load(sys.stdin)
assert d["differ"] == 0 and len(d["runs"]) == 9 and d["reference_not_compared"] == "" and d["replicates"] == 32
assert {r["run"] for r in d["runs"] if not r["judged"]} == {"merging"}
assert all(abs(c["mean"] / c["against"] - 1) < .1 for r in d["runs"] for c in r["image"])'; then
  pass json_content
else
  fail json_content
fi

# Fog that begins at a wall on the way of camera paths and not on that of light paths (docs/tracers.md): the tracers with
# light paths do not render it, and are not compared.
{
  printf '%s\n' "$head" 'MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [.5 .5 .5] "rgb sigma_a" [.2 .2 .2]'
  echo 'MediumInterface "" "fog"'
  printf '%s\n' "$body"
} >fog.pbrt
check fog verify fog.pbrt
expect_text fog_says_so 'bidirectional is not compared: it does not support media that do not fit together'

# A triangle so far away that floats cannot hold its corners: moved copies of the scene differ.
cat >far.pbrt <<'END'
LookAt 300000 299999.8 0.1  300000 300000 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
WorldBegin
LightSource "infinite" "rgb L" [.4 .5 .6]
Translate 300000 300000 0
Material "diffuse" "rgb reflectance" [.9 .1 .1]
Shape "trianglemesh" "point3 P" [-.041 -.033 0 .043 -.037 0 .013 .049 .01]
END
expect_code 1 disagrees verify far.pbrt
expect_text names_it 'volpath, turned, '
expect_text row_says_so 'DIFFERS'
expect_code 1 disagrees_json verify far.pbrt --json
expect_text json_says_so '"differs": true'

# Mirrors: no light paths alone, and between tracers no small lights.
printf '%s\n' "$head" 'LightSource "point" "point3 from" [1 -1 2]' 'Material "conductor" "float roughness" 0' "$body" >mirror.pbrt
check mirror verify mirror.pbrt
expect_text mirror_lightpath 'lightpath and randomwalk are not compared: smooth surfaces'
expect_text mirror_small_lights 'only light paths find them through smooth surfaces'
if grep -q '^lightpath  ' <<<"$out"; then fail mirror_has_no_lightpath; else pass mirror_has_no_lightpath; fi

# Brushed metal on a triangle whose texture coordinates span no area: its tangent turns with it.
cat >tangent.pbrt <<'END'
LookAt 0 -4 1.5  0 0 0.4  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
WorldBegin
LightSource "distant" "point3 from" [.4 -.7 1] "rgb L" [3 3 3]
Material "conductor" "float uroughness" .03 "float vroughness" .5
Shape "trianglemesh" "point3 P" [-2 -2 0 2 -2 0 0 3 .5] "point2 uv" [0 0 1 1 2 2]
END
check tangent verify tangent.pbrt

# Rough glass: uniform directions hardly ever meet its lobes.
printf '%s\n' "$head" 'Material "dielectric" "float roughness" .2' "$body" >glass.pbrt
check glass verify glass.pbrt
if grep -q '^randomwalk' <<<"$out"; then fail glass_has_no_randomwalk; else pass glass_has_no_randomwalk; fi

# In a large world hardly any light path from the sky meets what the camera sees.
check far_sky "$VELO" scene verify "$VELO_SOURCE_DIR/scenes/lecture/example_1.pbrt" --rays 0.5 --resolution 16x16
expect_text far_sky_says_so 'light paths from far away about'

# A tracer that volpath replaces is not compared with volpath.
printf '%s\n' "$head" 'Material "subsurface"' "$body" >solid.pbrt
check subsurface verify solid.pbrt
expect_text subsurface_says_so 'bidirectional is not compared'
if grep -q '^bidirectional' <<<"$(grep -v 'not compared' <<<"$out")"; then fail subsurface_left_out; else pass subsurface_left_out; fi

# Light of a medium: light paths start at lights only.
{
  printf '%s\n' "$head" 'MakeNamedMedium "fire" "string type" "homogeneous" "rgb sigma_s" [.2 .2 .2] "rgb sigma_a" [.2 .2 .2]'
  printf '%s\n' '"rgb Le" [1 .5 .2]' "$body" 'AttributeBegin Material "interface" MediumInterface "fire" "" Translate 1 0 .6'
  echo 'Shape "sphere" "float radius" 0.4 AttributeEnd'
} >fire.pbrt
check fire verify fire.pbrt
expect_text fire_says_so 'lightpath is not compared: it does not support light from media'

# A reference renderer that is wrong: it renders another reflectance.
cat >wrong.sh <<END
#!/bin/sh
scene=\$1
shift
sed 's/\.7 \.3 \.2/.5 .3 .2/' "\$scene" >"\$PWD/wrong_\$\$.pbrt"
"$reference" "\$PWD/wrong_\$\$.pbrt" "\$@"
END
chmod +x wrong.sh
expect_code 1 wrong_reference verify plain.pbrt --reference ./wrong.sh
line wrong_reference_row '^reference .*DIFFERS'
line wrong_reference_only '^1 of 8 comparisons differ'
line wrong_reference_cell 'reference, material [0-9]*, red: '
VELO_REFERENCE=$PWD/wrong.sh expect_code 1 reference_of_the_environment verify plain.pbrt

# One that refuses the scene, fails, is ended, writes no image, is not there; and --sandbox.
check refused verify solid.pbrt
line refused_says_so '^reference  *not compared: .*solid.pbrt:[0-9:]* material "subsurface" is not part of the reference renderer'
printf 'IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 180\n0\n9 9\n' >lamp.ies
printf '%s\n' "$head" 'AttributeBegin Translate 1 -.5 1.5 LightSource "goniometric" "string filename" "lamp.ies" AttributeEnd' "$body" >lamp.pbrt
check lamp verify lamp.pbrt
line lamp_says_so '^reference  *not compared: .*lamp.pbrt:[0-9:]* a lamp file is not part of the reference renderer'
line lamp_agrees '^0 of [0-9]* comparisons differ'
program() {
  printf '#!/bin/sh\n%s\n' "$1" >program.sh
  chmod +x program.sh
  verify plain.pbrt --reference ./program.sh
}
expect_code 5 failing_reference program 'echo "the disk is full" >&2; exit 5'
expect_text failing_reference_says_why 'reference renderer ./program.sh: the disk is full'
expect_code 5 killed_reference program 'kill -9 $$'
expect_text killed_reference_says_why 'ended by signal 9'
expect_code 5 no_image_of_the_reference program 'exit 0'
expect_text no_image_says_so 'its image cannot be read'
expect_code 4 no_reference verify plain.pbrt --reference ./none.sh
check sandbox verify plain.pbrt --sandbox . --reference ./wrong.sh
line sandbox_says_so '^reference  *not compared: --sandbox allows no other programs'

expect_code 2 no_rays verify plain.pbrt --rays 0
expect_code 2 large_image verify plain.pbrt --resolution 4097x16
expect_code 4 no_file verify none.pbrt
echo 'WorldBegin Shape "spere"' >wrong.pbrt
expect_code 3 wrong_scene verify wrong.pbrt
finish
