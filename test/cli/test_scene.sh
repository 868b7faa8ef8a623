#!/usr/bin/env bash
# velo scene check and scene info: each kind of finding with a small wrong scene, its place, the exit codes; right scenes
# give none.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
repository=$VELO_SOURCE_DIR
cd "$work" || exit 1

# scene FILE LINES...: line 1 is the camera, 2 the light, 3 WorldBegin, the given ones begin at 4.
scene() {
  local file=$1
  shift
  printf '%s\n' 'LookAt 0 0 -9  0 0 0  0 1 0 Camera "perspective"' 'Sampler "zsobol"' 'WorldBegin' "$@" \
    'LightSource "infinite"' >"$file"
}

# finds CODE NAME PATTERN FILE [options]: exit code, and one line of the answer matches.
finds() {
  local wanted=$1 name=$2 pattern=$3
  shift 3
  run "$VELO" scene check "$@"
  if [ "$code" != "$wanted" ]; then
    fail "$name (exit code $code, not $wanted)"
    show "velo scene check $*"
  elif ! printf '%s\n' "$out" | grep -q -E "$pattern"; then
    fail "$name (no line matches $pattern)"
    show "velo scene check $*"
  else
    pass "$name"
  fi
}
clean() {
  local name=$1
  shift
  finds 0 "$name" '^nothing found$' "$@"
}

# Nothing but what rough coats lose, as pbrt's.
sound() {
  local name=$1
  shift
  finds 0 "$name" '^nothing found$|^0 errors, 0 warnings, 1 note$' "$@"
  printf '%s\n' "$out" | grep -v -E '^nothing found$|^0 errors|\[rough-coat\]$' | grep -q . && fail "$name (another note)"
}

cube='"point3 P" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]'
outward='[0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 7 6 3 6 2  0 4 7 0 7 3  1 2 6 1 6 5]'
lid='[0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 7 6 3 6 2  0 4 7 0 7 3]'
top='[1 2 6 1 6 5]'
glass='Material "dielectric"'

# ---- right scenes ----------------------------------------------------------------------------------------------------
scene right.pbrt "$glass" "Shape \"trianglemesh\" $cube \"integer indices\" $outward" \
  'Translate 3 0 0 Shape "sphere"'
clean right_scene right.pbrt
scene mirrored.pbrt "$glass" 'Scale -1 1 1' "Shape \"trianglemesh\" $cube \"integer indices\" $outward"
clean a_mirrored_body_is_not_inverted mirrored.pbrt
scene two.pbrt "$glass" "Shape \"trianglemesh\" $cube \"integer indices\" $lid" \
  "Shape \"trianglemesh\" \"point3 P\" [1 -1 -1 1 1 -1 1 -1 1 1 1 1] \"integer indices\" [0 1 3 0 3 2]"
clean shapes_may_close_a_body_together two.pbrt
scene hollow.pbrt "$glass" "Shape \"trianglemesh\" $cube \"integer indices\" $outward" \
  'AttributeBegin Scale 0.5 0.5 0.5 ReverseOrientation' "Shape \"trianglemesh\" $cube \"integer indices\" $outward" \
  'AttributeEnd'
clean a_bubble_is_not_inverted hollow.pbrt
# A crate whose lid is moved by less than anyone sees.
scene hair.pbrt "$glass" "Shape \"trianglemesh\" $cube \"integer indices\" $lid" \
  "Shape \"trianglemesh\" \"point3 P\" [1.000001 -1 -1 1.000001 1 -1 1.000001 -1 1 1.000001 1 1] \"integer indices\" [0 1 3 0 3 2]"
clean a_hair_does_not_open_a_body hair.pbrt

# ---- one mistake each ------------------------------------------------------------------------------------------------
printf 'P5 1 1 255 x' >there.pgm
scene missing.pbrt 'Texture "a" "spectrum" "imagemap" "string filename" "their.pgm"' \
  'Shape "plymesh" "string filename" "none.ply"' 'Include "nowhere.pbrt"' \
  'Material "diffuse" "texture reflectance" "a"' 'Shape "sphere"'
finds 4 missing_texture 'missing\.pbrt:4:[0-9]+: error: .*their\.pgm.*there\.pgm.*\[missing-file\]' missing.pbrt
finds 4 missing_mesh_too 'missing\.pbrt:5:[0-9]+: error: .*none\.ply.*\[missing-file\]' missing.pbrt
finds 4 missing_include_too 'missing\.pbrt:6:[0-9]+: error: .*nowhere\.pbrt.*\[missing-file\]' missing.pbrt
finds 4 three_and_no_more '^3 errors, 0 warnings, 0 notes' missing.pbrt
finds 4 missing_scene 'none\.pbrt: error: no such file' none.pbrt

scene several.pbrt 'Material "difuse"' 'Shape "sphere" "float radios" 2' 'Shape "spere"' 'NamedMaterial "wals"' \
  'Shape "sphere"' 'MediumInterface "fog" ""' 'Shape "sphere"' 'ObjectInstance "car"' \
  'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 nan 0] "integer indices" [0 1 2]'
finds 3 mistake_1 ':4:[0-9]+: error: .*unknown material "difuse".*"diffuse"' several.pbrt
finds 3 mistake_2 ':5:[0-9]+: error: .*radios.*"radius".*\[wrong\]' several.pbrt
finds 3 mistake_3 ':6:[0-9]+: error: .*spere.*"sphere".*\[wrong\]' several.pbrt
finds 3 mistake_4 ':7:[0-9]+: error: there is no material "wals"' several.pbrt
finds 3 mistake_5 ':9:[0-9]+: error: there is no medium "fog"|:10:[0-9]+: error: there is no medium "fog"' several.pbrt
finds 3 mistake_6 ':11:[0-9]+: error: there is no object "car"' several.pbrt
finds 3 not_a_number ':12:[0-9]+: error: .*nan' several.pbrt
scene syntax.pbrt 'Shape "sphere" "float radius" [1 "'
finds 3 syntax 'syntax\.pbrt:4:34: error: unclosed string' syntax.pbrt
printf 'Shape "sphere"\nShape "sphere"\n' >fragment.pbrt
finds 3 a_fragment_is_one_error '^1 error, ' fragment.pbrt
finds 3 and_ends_the_reading 'note: nothing after this line was looked at' fragment.pbrt

scene unused.pbrt 'Texture "t" "spectrum" "constant" "rgb value" [1 0 0]' 'MakeNamedMaterial "m" "string type" "diffuse"' \
  'ObjectBegin "o" Shape "sphere" ObjectEnd' 'MakeNamedMedium "fog" "string type" "homogeneous"' \
  'AttributeBegin AreaLightSource "diffuse" AttributeEnd' 'Material "diffuse" Material "conductor"' 'Shape "sphere"'
finds 1 unused_texture 'unused\.pbrt:4:1: warning: texture "t" is not used \[unused\]' unused.pbrt
finds 1 unused_material ':5:1: warning: material "m" is not used' unused.pbrt
finds 1 unused_object ':6:[0-9]+: warning: object "o" is placed nowhere' unused.pbrt
finds 1 unused_medium ':7:1: warning: nothing lies in medium "fog"' unused.pbrt
finds 1 unused_area_light ':8:[0-9]+: warning: no shape emits light' unused.pbrt
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 5\n1 0 5\n0 1 5\n3 0 1 2\n' >face.ply
scene displaced.pbrt 'Texture "bumps" "float" "constant" "float value" 0.1' \
  'Shape "plymesh" "string filename" "face.ply" "texture displacement" "bumps"'
sound a_displacement_is_a_use displaced.pbrt
finds 1 material_of_nothing ':9:1: note: no shape takes this material \[replaced\]' unused.pbrt
printf 'Camera "perspective"\nCamera "orthographic"\nFilm "rgb"\nWorldBegin\nLightSource "infinite"\n' >twice.pbrt
finds 1 said_twice 'twice\.pbrt:2:1: warning: Camera a second time: this one counts \[overwritten\]' twice.pbrt
scene again.pbrt 'Texture "t" "float" "constant"' 'Texture "t" "float" "constant"'
finds 3 named_twice ':5:1: error: float texture "t" is made a second time' again.pbrt

scene open.pbrt "$glass" "Shape \"trianglemesh\" $cube \"integer indices\" $lid"
finds 1 open_solid 'open\.pbrt:5:1: warning: the solid of the material of line 4 is not closed: 4 edges.*\[open-dielectric\]' open.pbrt
scene closed_by_water.pbrt "$glass" "Shape \"trianglemesh\" $cube \"integer indices\" $lid" 'Material "dielectric" "float eta" 1.1' "Shape \"trianglemesh\" $cube \"integer indices\" $top"
clean closed_by_water closed_by_water.pbrt
scene open_beside.pbrt "$glass" "Shape \"trianglemesh\" $cube \"integer indices\" $lid" 'Material "dielectric" "float eta" 1.1' 'Translate 5 0 0' "Shape \"trianglemesh\" $cube \"integer indices\" $top"
finds 1 open_beside '4 edges.*\[open-dielectric\]' open_beside.pbrt
scene bowl.pbrt "$glass" 'Shape "sphere" "float zmax" 0.5'
finds 1 open_sphere ':5:1: warning: .*not closed.*\[open-dielectric\]' bowl.pbrt
scene inverted.pbrt "$glass" 'ReverseOrientation' "Shape \"trianglemesh\" $cube \"integer indices\" $outward"
finds 1 inverted_solid ':6:1: warning: normals point into the solid.*\[inverted-dielectric\]' inverted.pbrt
scene inner.pbrt "$glass" 'ReverseOrientation' 'Shape "sphere"'
finds 1 inverted_sphere ':6:1: warning: normals point into.*\[inverted-dielectric\]' inner.pbrt
scene mirror_sphere.pbrt "$glass" 'Scale 1 1 -1' 'Shape "sphere"'
finds 1 mirrored_sphere ':6:1: warning: normals point into.*\[inverted-dielectric\]' mirror_sphere.pbrt
scene mirror_reversed.pbrt "$glass" 'Scale 1 1 -1' 'ReverseOrientation' 'Shape "sphere"'
clean mirrored_reversed_sphere mirror_reversed.pbrt
"$VELO" scene convert mirror_sphere.pbrt mirror_sphere.gltf >/dev/null 2>&1
finds 1 mirrored_sphere_as_a_mesh 'normals point into the solid.*\[inverted-dielectric\]' mirror_sphere.gltf
"$VELO" scene convert mirror_reversed.pbrt mirror_reversed.gltf >/dev/null 2>&1
finds 0 mirrored_reversed_sphere_as_a_mesh '^nothing found' mirror_reversed.gltf

fog='MakeNamedMedium "a" "string type" "homogeneous" MakeNamedMedium "b" "string type" "homogeneous" Material "interface"'
scene overlap.pbrt "$fog" 'MediumInterface "a" ""' 'Shape "sphere"' 'Translate 1 0 0 MediumInterface "b" ""' 'Shape "sphere"'
finds 1 media_overlap ':8:1: warning: this solid of medium "b" overlaps.*"a" of line 6.*\[media\]' overlap.pbrt
scene nested.pbrt "$fog" 'MediumInterface "a" ""' 'Shape "sphere" "float radius" 2' 'MediumInterface "b" ""' 'Shape "sphere"'
finds 1 media_nested_wrongly ':8:1: warning: this solid lies in medium "a" \(line 6\), but says that "" is' nested.pbrt
scene nested_right.pbrt "$fog" 'MediumInterface "a" ""' 'Shape "sphere" "float radius" 2' 'MediumInterface "b" "a"' \
  'Shape "sphere"'
clean media_nested_rightly nested_right.pbrt
scene beside.pbrt "$fog" 'MediumInterface "a" ""' "Shape \"trianglemesh\" $cube \"integer indices\" $outward" \
  'Translate 2 0 0 MediumInterface "b" ""' "Shape \"trianglemesh\" $cube \"integer indices\" $outward"
clean media_that_touch beside.pbrt

scene flat.pbrt 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 2 0 0] "integer indices" [0 1 2  0 1 3]'
finds 1 no_area ':4:1: warning: 1 of 2 triangles have no area \(50 %\) \[degenerate\]' flat.pbrt
scene normals.pbrt 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "normal N" [0 0 1 0 0 0 0 0 1] "integer indices" [0 1 2]'
finds 1 no_normal ':4:1: warning: 1 of 3 vertex normals have no length' normals.pbrt

triangle='Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]'
scene uv.pbrt 'Texture "t" "spectrum" "checkerboard"' 'Texture "u" "spectrum" "scale" "texture tex" "t"' \
  'Material "diffuse" "texture reflectance" "u"' "$triangle"
finds 1 no_uv ':7:1: warning: the mesh has no uv, but texture "u".*\[no-uv\]' uv.pbrt
scene planar.pbrt 'Texture "t" "spectrum" "checkerboard" "string mapping" "planar"' \
  'Material "diffuse" "texture reflectance" "t"' "$triangle"
clean planar_textures_need_none planar.pbrt

scene albedo.pbrt 'Texture "t" "spectrum" "constant" "rgb value" [0.5 1.5 0]' 'Material "diffuse" "texture reflectance" "t"' \
  'Shape "sphere"'
finds 1 albedo ':4:1: warning: texture "t" reaches 1.5 as the reflectance.*\[albedo\]' albedo.pbrt
printf 'PF\n1 1\n-1\n\0\0\0\100\0\0\0\100\0\0\0\100' >bright.pfm
scene image.pbrt 'Texture "t" "spectrum" "imagemap" "string filename" "bright.pfm"' \
  'Material "diffuse" "texture reflectance" "t"' 'Shape "sphere"'
finds 1 albedo_of_a_image ':4:1: warning: texture "t" reaches 2 ' image.pbrt
clean images_are_not_read --no-images image.pbrt
scene through.pbrt 'Material "diffusetransmission" "rgb reflectance" [0.7 0.7 0.7] "rgb transmittance" [0.7 0.7 0.7]' 'Shape "sphere"'
finds 1 albedo_of_two ':4:1: warning: .*add up to 1.4' through.pbrt
sed 's/"rgb transmittance"/"float scale" 2 &/' through.pbrt >scaled.pbrt
finds 1 albedo_with_its_scale ':4:1: warning: .*reflectance is 1.4' scaled.pbrt
scene milk.pbrt 'Material "subsurface" "rgb reflectance" [0.5 0.5 0.5] "rgb mfp" [1 1 1] "float scale" 10' 'Shape "sphere"'
clean scale_of_lengths_is_no_albedo milk.pbrt
scene files.pbrt 'LightSource "goniometric" "string filename" "none.ies"' 'AreaLightSource "diffuse" "string filename" "none.png"' 'Shape "sphere"' \
  'MakeNamedMedium "m" "string type" "nanovdb" "string filename" "none.nvdb"'
for name in ies png nvdb; do
  finds 4 "missing_$name" "error: .*none\\.$name.*\\[missing-file\\]" files.pbrt
done

scene diver.pbrt "$glass" 'Shape "sphere" "float radius" 20'
finds 1 camera_in_glass ':5:1: warning: the camera stands in the solid.*\[camera-inside\]' diver.pbrt
scene tomb.pbrt 'Scale 20 20 20' "Shape \"trianglemesh\" $cube \"integer indices\" $outward"
finds 1 camera_in_the_dark ':5:1: warning: .*no light is in there' tomb.pbrt
scene room.pbrt 'LightSource "point"' 'Scale 20 20 20' "Shape \"trianglemesh\" $cube \"integer indices\" $outward"
clean a_lit_room room.pbrt
scene placed.pbrt 'ObjectBegin "o"' "$glass Shape \"sphere\"" 'ObjectEnd' 'Translate 0 0 -9 ObjectInstance "o"'
finds 1 camera_in_an_instance ':5:[0-9]+: warning: the camera stands' placed.pbrt

scene dark.pbrt 'LightSource "point" "float scale" 0' 'AreaLightSource "diffuse" "rgb L" [0 0 0]' 'Shape "sphere"'
finds 1 dark_light ':4:1: warning: this light gives no light.*\[dark-light\]' dark.pbrt
finds 1 dark_area_light ':5:1: warning: this area light' dark.pbrt

# A sky behind a window at x = 1, the corners from below, once round and once the other way. The camera is at (0, 0, -9).
sky='LightSource "infinite" "rgb L" [1 1 1] "point3 portal"'
out_there='[1 -2 2  1 2 2  1 2 -2  1 -2 -2]' in_here='[1 -2 -2  1 2 -2  1 2 2  1 -2 2]'
wall='Shape "trianglemesh" "point3 P" [1 -9 -9  1 9 -9  1 9 9] "integer indices" [0 1 2]'
scene portal.pbrt "$sky $out_there" "$wall" 'Translate -2 0 0 Shape "sphere"'
clean a_portal_of_a_room portal.pbrt
scene reversed.pbrt "$sky $in_here" "$wall" 'Translate -2 0 0 Shape "sphere"'
finds 1 a_reversed_portal ':4:1: warning: this light gives no light: the whole scene.*\[dark-light\]' reversed.pbrt
scene placed_in.pbrt "$sky $in_here" 'ObjectBegin "o" Shape "sphere" ObjectEnd' 'Translate -2 0 0 ObjectInstance "o"'
finds 1 a_reversed_portal_of_instances ':4:1: warning: this light gives no light: the whole scene' placed_in.pbrt
scene both.pbrt "$sky $in_here" 'Shape "sphere" "float radius" 3'
finds 1 a_portal_behind_the_camera ':4:1: warning: the camera is on the side' both.pbrt

scene coat.pbrt 'Material "coateddiffuse" "float roughness" 0.4 "bool remaproughness" false' 'Shape "sphere"'
finds 0 rough_coat ':4:1: note: the rough coat of .* loses 37 % of the light.*\[rough-coat\]' coat.pbrt
sed 's/0.4/& "bool conserveenergy" true/' coat.pbrt >kept.pbrt
clean rough_coat_conserves kept.pbrt
sed 's/0.4/& "bool conserveenergy" true "rgb albedo" [0.5 0.5 0.5]/' coat.pbrt >walks.pbrt
finds 3 conserving_walks ':4:[0-9]+: error: .*energy is conserved over a diffuse base only' walks.pbrt

# ---- JSON, glTF, what exists -----------------------------------------------------------------------------------------
run "$VELO" scene check --json missing.pbrt
if [ "$code" = 4 ] && printf '%s' "$out" | python3 -c '
import json, sys
d = json.load(sys.stdin)
assert d["status"] == 4 and d["errors"] == 3 and len(d["findings"]) == 3
assert all(f["kind"] == "missing-file" and f["severity"] == "error" and f["line"] > 3 for f in d["findings"])'; then
  pass json
else
  fail json
  show 'velo scene check --json'
fi
run "$VELO" scene info --json unused.pbrt
if [ "$code" = 0 ] && printf '%s' "$out" | python3 -c '
import json, math, sys
d = json.load(sys.stdin)
assert d["shapes"] == 2 and d["textures"] == 1 and d["materials"] == 3 and d["media"] == 1 and d["objects"] == 1
assert d["light_count"] == 1 and d["lights"][0]["kind"] == "infinite" and len(d["unused"]) == 5
assert d["bounds"] == [[-1, -1, -1], [1, 1, 1]]
assert abs(d["lights"][0]["power"] / (4 * math.pi ** 2 * 3) - 1) < 1e-3'; then
  pass info_json
else
  fail info_json
  show 'velo scene info --json'
fi
scene lamp.pbrt 'AreaLightSource "diffuse" "rgb L" [2 2 2]' \
  'Shape "bilinearmesh" "point3 P" [0 0 0 2 0 0 0 3 0 2 3 0]' 'LightSource "point" "rgb I" [3 3 3]'
expect_code 0 info "$VELO" scene info lamp.pbrt
expect_text info_area_light 'area      power 37.699' # pi * 6 * 2
expect_text info_point_light 'point     power 37.699' # 4 pi * 3
expect_code 4 info_missing "$VELO" scene info none.pbrt
expect_text info_missing_words 'no such file'

printf '%s' '{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"name":"paint","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},{"name":"spare"}],
"textures":[{"source":0}],"images":[{"uri":"gone.png"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}' >model.gltf
# velo render does without the image, too
finds 1 gltf_missing_image 'warning: .*gone\.png.*\[missing-file\]' model.gltf
sed 's/gone\.png/there.pgm/' model.gltf >no_uv.gltf
printf '%s\n' 'mtllib gone.mtl' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'f 1 2 3' >model.obj
finds 1 obj_missing_library 'model\.obj:1:1: warning: .*gone\.mtl.*\[missing-file\]' model.obj
finds 1 gltf_no_uv '\[no-uv\]' no_uv.gltf
expect_code 0 gltf_info "$VELO" scene info model.gltf
expect_text gltf_triangles 'triangles   1'

for s in "$repository"/scenes/lecture/*.pbrt "$repository"/scenes/features/*.pbrt; do
  sound "$(basename "$s")" "$s"
done
# What is said about others was looked up: it is so.
scenes=$shared/scenes/pbrt
if [ -n "$shared" ] && [ -d "$scenes" ]; then
  for s in cornell-box/cornell-box veach-mis/veach-mis teapot/teapot dining-room/dining-room \
    volumetric-caustic/volumetric-caustic pbrt-killeroos/killeroo-simple pbrt-cornell-box/cornell-box; do
    sound "shared $s" "$scenes/$s.pbrt"
  done
  finds 1 degenerate_staircase '2327 of 3127 triangles have no area' "$scenes/staircase2/staircase2.pbrt"
  finds 1 unused_testball 'material "RoughMetal" is not used' "$scenes/material-testball/material-testball.pbrt"
else
  skip shared_scenes "needs ../shared/scenes/pbrt"
fi
finish
