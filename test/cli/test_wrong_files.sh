#!/usr/bin/env bash
# Wrong files: each gives one clear line with its place and the right exit code, at once and in little memory.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

# wrong CODE NAME PATTERN FILE: exit code, one line on stderr that matches the extended regular expression, no image,
# less than a second and 300 megabytes.
wrong() {
  local wanted=$1 name=$2 pattern=$3 file=$4 problem=
  run_measured "$VELO" render "$file" -o wrong.exr --quiet
  [ "$code" = "$wanted" ] || problem="exit code $code, not $wanted"
  [ "$(printf '%s\n' "$err" | wc -l)" = 1 ] || problem="not one line"
  printf '%s\n' "$err" | grep -q -E "^velo: $pattern" || problem="${problem:-the line does not match $pattern}"
  [ ! -e wrong.exr ] || problem="wrote an image"
  if is_plain_build; then
    [ "$milliseconds" -lt 1000 ] || problem="$milliseconds ms"
    [ "$kilobytes" -lt 300000 ] || problem="$kilobytes KB"
  fi
  rm -f wrong.exr
  if [ -z "$problem" ]; then pass "$name"; else fail "$name ($problem)"; show "velo render $file"; fi
}

# scene FILE LINES...: line 1 is the camera, line 2 WorldBegin, the given ones begin at 3.
scene() {
  local file=$1
  shift
  printf '%s\n' 'Camera "perspective"' 'WorldBegin' "$@" >"$file"
}
sphere='Shape "sphere"'

wrong 4 missing_scene 'no such file: none\.pbrt' none.pbrt
scene near.pbrt "$sphere"
wrong 4 missing_scene_near_name '.*did you mean "near\.pbrt"' naer.pbrt
wrong 5 scene_is_a_folder '.*is a folder' .
mkdir folder.pbrt
wrong 5 scene_is_a_folder_by_name '.*is a folder' folder.pbrt

scene texture.pbrt 'Texture "t" "spectrum" "imagemap" "string filename" "none.png"' \
  'Material "diffuse" "texture reflectance" "t"' "$sphere"
wrong 4 missing_texture 'texture\.pbrt:3:[0-9]+: .*none\.png' texture.pbrt
printf 'not an image' >broken.png
scene broken_texture.pbrt 'Texture "t" "spectrum" "imagemap" "string filename" "broken.png"' \
  'Material "diffuse" "texture reflectance" "t"' "$sphere"
wrong 3 broken_texture '.*broken\.png' broken_texture.pbrt
scene include.pbrt 'Include "nowhere.pbrt"'
wrong 4 missing_include 'include\.pbrt:3:[0-9]+: .*nowhere\.pbrt' include.pbrt
scene ply.pbrt 'Shape "plymesh" "string filename" "none.ply"'
wrong 4 missing_ply 'ply\.pbrt:3:[0-9]+: .*none\.ply' ply.pbrt

scene material.pbrt "$sphere" 'Material "difuse"'
wrong 3 unknown_material 'material\.pbrt:4:[0-9]+: .*difuse.*"diffuse"' material.pbrt
scene named_material.pbrt 'MakeNamedMaterial "walls" "string type" "diffuse"' 'NamedMaterial "wals"' "$sphere"
wrong 3 unknown_named_material 'named_material\.pbrt:4:[0-9]+: .*wals.*"walls"' named_material.pbrt
scene parameter.pbrt '' 'Material "diffuse" "rgb reflectence" [0.5 0.5 0.5]' "$sphere"
wrong 3 misspelt_parameter 'parameter\.pbrt:4:[0-9]+: .*reflectence.*"reflectance"' parameter.pbrt
scene directive.pbrt 'Matrial "diffuse"'
wrong 3 misspelt_directive 'directive\.pbrt:3:1: .*Matrial.*"?Material"?' directive.pbrt
scene string.pbrt 'Material "diffuse' "$sphere"
wrong 3 unclosed_string 'string\.pbrt:3:10: ' string.pbrt
scene list.pbrt 'Shape "sphere" "float radius" [ 1 2'
wrong 3 unclosed_list 'list\.pbrt:[34]:[0-9]+: ' list.pbrt
scene count.pbrt 'Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1] "integer indices" [0 1 2]'
wrong 3 incomplete_point 'count\.pbrt:3:[0-9]+: ' count.pbrt
scene index.pbrt 'Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] "integer indices" [0 1 3]'
wrong 3 index_out_of_range 'index\.pbrt:3:[0-9]+: ' index.pbrt
scene end.pbrt 'AttributeBegin' "$sphere"
wrong 3 attribute_left_open 'end\.pbrt:[0-9]+:[0-9]+: ' end.pbrt

scene self.pbrt 'Include "self.pbrt"'
wrong 3 includes_itself '.*self\.pbrt:3:[0-9]+: ' self.pbrt
scene one.pbrt 'Include "two.pbrt"'
printf 'Include "one.pbrt"\n' >two.pbrt
wrong 3 include_in_a_circle '.*(one|two)\.pbrt:[0-9]+:[0-9]+: ' one.pbrt
scene import_self.pbrt 'Import "import_self.pbrt"'
wrong 3 imports_itself '.*import_self\.pbrt:3:[0-9]+: ' import_self.pbrt

printf 'ply\nformat binary_little_endian 1.0\nelement vertex 2147483648\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n' >huge.ply
scene huge.pbrt 'Shape "plymesh" "string filename" "huge.ply"'
wrong 3 ply_promises_two_billion_vertices '.*huge\.p(ly|brt)' huge.pbrt
sed 's/binary_little_endian/ascii/' huge.ply >huge_ascii.ply
scene huge_ascii.pbrt 'Shape "plymesh" "string filename" "huge_ascii.ply"'
wrong 3 ascii_ply_promises_two_billion_vertices '.*huge_ascii\.p(ly|brt)' huge_ascii.pbrt
sed 's/element vertex 2147483648/element vertex 3/; s/element face 1/element face 4000000000/' huge_ascii.ply >faces.ply
printf '0 0 0\n1 0 0\n0 1 0\n' >>faces.ply
scene faces.pbrt 'Shape "plymesh" "string filename" "faces.ply"'
wrong 3 ply_promises_four_billion_faces '.*faces\.p(ly|brt)' faces.pbrt

{
  printf 'ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n'
  printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\300\177\0\0\0\0\0\0\0\0\0\0\200\077\0\0\0\0'
  printf '\003\0\0\0\0\001\0\0\0\002\0\0\0'
} >nan.ply
scene nan.pbrt 'Shape "plymesh" "string filename" "nan.ply"'
wrong 3 nan_vertex_in_ply '.*nan\.p(ly|brt)' nan.pbrt
scene nan_text.pbrt 'Shape "trianglemesh" "point3 P" [0 0 0  1 nan 0  0 1 0] "integer indices" [0 1 2]'
wrong 3 nan_vertex 'nan_text\.pbrt:3:[0-9]+: ' nan_text.pbrt
scene overflow.pbrt 'Shape "trianglemesh" "point3 P" [0 0 0  1 1e999 0  0 1 0] "integer indices" [0 1 2]'
wrong 3 infinite_vertex 'overflow\.pbrt:3:[0-9]+: ' overflow.pbrt

printf '%s\n' 'LookAt 1 2 3  1 2 3  0 1 0' 'Camera "perspective"' 'WorldBegin' "$sphere" >eye.pbrt
wrong 3 eye_is_lookat 'eye\.pbrt:1:1: ' eye.pbrt
printf '%s\n' '' 'Camera "pinhole" "point3 eye" [1 2 3] "point3 lookat" [1 2 3]' 'WorldBegin' "$sphere" >pinhole.pbrt
wrong 3 pinhole_eye_is_lookat 'pinhole\.pbrt:2:[0-9]+: ' pinhole.pbrt
printf '%s\n' 'Camera "perspective" "float fov" [200]' 'WorldBegin' "$sphere" >fov.pbrt
wrong 3 fov_too_wide 'fov\.pbrt:1:[0-9]+: ' fov.pbrt
printf '%s\n' 'Film "rgb" "integer xresolution" [0]' 'Camera "perspective"' 'WorldBegin' "$sphere" >film.pbrt
wrong 3 film_of_no_pixels 'film\.pbrt:1:[0-9]+: ' film.pbrt
printf '\037\213\010\0broken' >broken.pbrt.gz
wrong 3 broken_gzip '.*broken\.pbrt\.gz' broken.pbrt.gz
head -c 4096 /dev/urandom >noise.pbrt
wrong 3 noise '.*noise\.pbrt:[0-9]+:[0-9]+: ' noise.pbrt
# A warning a line, thousands of them: a hundred are enough.
{ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n'; for i in $(seq 3000); do printf 'usemtl m%d\nf 1 2 3\n' "$i"; done; } >warnings.obj
run "$VELO" render warnings.obj --quiet --spp 1 --resolution 8x8 -o warnings.exr
check warnings_end test "$(printf '%s\n' "$err" | wc -l)" = 101
printf '%s\n' 'format unknown' >scene.obj2
wrong 3 unknown_suffix '.*scene\.obj2' scene.obj2

# A Git LFS pointer stands for a file that is not there; an image of that name stays.
pointer='version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n'
for name in pointer.glb pointer.obj pointer.ply pointer.pbrt pointer.png; do printf "$pointer" >"$name"; done
for name in glb obj ply pbrt; do wrong 4 "lfs_$name" ".*pointer\\.$name is a Git LFS pointer" "pointer.$name"; done
scene lfs_image.pbrt 'LightSource "infinite" "string filename" "pointer.png"' "$sphere"
wrong 4 lfs_image '.*pointer\.png is a Git LFS pointer' lfs_image.pbrt
expect_code 4 lfs_info "$VELO" image info pointer.png
echo old >kept.png
expect_code 4 lfs_keeps "$VELO" render pointer.glb -o kept.png
check lfs_kept test "$(cat kept.png)" = old
# Files that have nothing to draw.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' >vertices.obj
wrong 3 obj_without_faces '.*vertices\.obj: it has no faces, points \(p\) or lines \(l\)' vertices.obj
printf 'solid a\nendsolid a\n' >empty.stl
wrong 3 stl_without_faces '.*empty\.stl: it has no faces' empty.stl
# What other programs write: it is read.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2\nusemtl a\nl 1/1 2/1 -1\nl 2 3\n' >marks.obj
check marks "$VELO" render marks.obj --spp 1 --resolution 16x16 -o marks.exr
expect_text marks_say 'note: marks.obj: its points and lines are balls and tubes'
check marks_shapes sh -c '"$0" scene info marks.obj | grep -q "2: 1 sphere, 1 curve"' "$VELO"
for end in '1 0 0' '0 1 0' '0 0 1' '1 2 3'; do # a single line, also one that leads to the camera
  printf 'v 0 0 0\nv %s\nl 1 2\n' "$end" >line.obj
  check "line_to_${end// /_}" "$VELO" render line.obj --spp 1 --resolution 16x16 -o line.exr
  read -r -a at <<<"$(printf '%s' "$err" | sed -n 's/.*: eye (\([^)]*\)).*/\1/p' | tr -d ,) $end"
  check "its_end_is_not_the_camera_${end// /_}" awk "BEGIN {exit !(sqrt((${at[0]} - ${at[3]})^2 + (${at[1]} - ${at[4]})^2 + (${at[2]} - ${at[5]})^2) > 0.5)}"
done
printf 'v 0 0 0\nv 1 0 0\np 4\n' >marks_bad.obj
wrong 3 marks_bad '.*marks_bad\.obj:3:[0-9]+: "4" is none of the 2 vertices' marks_bad.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\no caf\303\251\nf 1 2 3\n' >plain.obj
for form in UTF-16 UTF-16BE UTF-16LE UTF-8; do
  /usr/bin/python3 - "$form" <<'PY'
import sys
text = open("plain.obj", encoding="utf-8").read()
mark = "" if sys.argv[1] == "UTF-16" else "\ufeff"
open("coded.obj", "wb").write((mark + text).encode(sys.argv[1]))
PY
  check "obj_$form" sh -c '"$0" scene info coded.obj | sed "s/coded/plain/; s/read in .*//" >coded.txt &&
    "$0" scene info plain.obj | sed "s/read in .*//" | cmp - coded.txt' "$VELO"
done
printf 'ply\nformat ascii 1.0\nCreated by Blender3D 2.48 - www.blender.org, source file: a.blend\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >blender.ply
check old_blender "$VELO" render blender.ply --spp 1 --resolution 16x16 -o blender.exr --quiet
sed 's/^Created by/Made by/' blender.ply >word.ply
wrong 3 unknown_word '.*word\.ply:3:1: PLY: unknown word "Made"' word.ply
for name in KHR_materials_scatter KHR_materials_retroreflection; do
  printf '{"asset": {"version": "2.0"}, "extensionsUsed": ["%s"], "scenes": [{"nodes": []}]}' $name >extension.gltf
  run "$VELO" scene info extension.gltf
  expect_text "names_$name" "$name"
done

# What the caller wrote is shown whole, up to 200 characters; text from a file is cut.
name=a_name_that_is_longer_than_twelve_characters
long=$(printf 'x%.0s' $(seq 201))
printf '{"asset": {"version": "2.0"}, "scenes": [{"name": "%s", "nodes": []}]}' $name >named.gltf
run "$VELO" render named.gltf --scene $name.
expect_text whole_scene_name "there is no scene \"$name.\" (1 are there: a_name_that_…)"
run "$VELO" render named.gltf --scene "$long"
expect_text long_scene_name "\"${long:1}…\" (1 are there"
printf '%%YAML:1.0\n---\ncam0:\n  camera_model: pinhole\n  intrinsics: [9, 9, 4, 4]\n  resolution: [8, 8]\n' >chain.yaml
scene whole.pbrt "$sphere"
run "$VELO" render whole.pbrt --camera chain.yaml --frame "$long"
expect_text long_frame_name "there is no camera \"${long:1}…\""
scene colmap.pbrt "$sphere"
sed -i "1s/.*/Camera \"colmap\" \"string model\" \"$name\"/" colmap.pbrt
wrong 3 cut_model_name '.*unknown COLMAP camera model "a_name_that_…"' colmap.pbrt
run "$VELO" render whole.pbrt --max-memory 1K
if [ "$code" = 1 ] && [[ $err == *'out of memory; --max-memory allows 1.0 kB' ]]; then pass nothing_held; else fail nothing_held; show memory; fi

# Pixels that are no numbers: counted where they colour surfaces, refused where they shine.
{ printf 'PF\n2 1\n-1.0\n'; printf '\0\0\300\177%.0s' 1 2 3; printf '\0\0\0\077%.0s' 1 2 3; } >nan.pfm
scene nan.pbrt 'LightSource "infinite"' 'Texture "t" "spectrum" "imagemap" "string filename" "nan.pfm"' \
  'Material "diffuse" "texture reflectance" "t"' "$sphere"
check nan_texels "$VELO" render nan.pbrt --spp 1 --resolution 16x16 -o nan.exr --quiet
expect_text nan_texels_are_told 'velo: warning: nan.pbrt:4:1: nan.pfm: pixels that are not finite: 1, the first one (0, 0);'
scene nan_lamp.pbrt 'AreaLightSource "diffuse" "string filename" "nan.pfm"' "$sphere"
wrong 3 nan_lamp '.*nan\.pfm: pixel \(0, 0\) is not finite' nan_lamp.pbrt

# What is not there yet: an error with its place, or a warning.
scene medium.pbrt 'Shape "heightfield" "integer nu" 3' "$sphere"
wrong 3 not_there_yet 'medium\.pbrt:3:[0-9]+: .*heightfield' medium.pbrt
check permissive "$VELO" render medium.pbrt --permissive --spp 1 --resolution 16x16 -o permissive.exr
expect_text permissive_warns "velo: warning: medium.pbrt:3:"
finish
