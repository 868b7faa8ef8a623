#!/usr/bin/env bash
# velo scene upgrade: the program's output and codes; upgraded scenes render to what the same pbrt-v4 scenes render to.
. "$(dirname "${BASH_SOURCE[0]}")/../harness.sh"
cd "$work" || exit 1
mkdir -p old new

# old FILE MATERIAL-LINES: a pbrt-v3 scene of two spheres over a floor.
old_scene() {
  cat >"old/$1" <<SCENE
LookAt 0 2 6  0 .5 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
Film "image" "integer xresolution" [ 48 ] "integer yresolution" [ 32 ] "string filename" "$1.exr"
Sampler "lowdiscrepancy" "integer pixelsamples" 16
PixelFilter "box"
Integrator "path"
WorldBegin
  LightSource "infinite" "color L" [ .4 .5 .6 ] "integer nsamples" 4
  LightSource "distant" "point from" [ 2 5 3 ] "color L" [ 1 1 1 ] "color scale" [ 2 2 2 ]
  TransformBegin
    Translate -1 .5 0
    $2
    Shape "sphere" "float radius" [ .9 ]
  TransformEnd
  Material "matte" "color Kd" [ .5 .5 .5 ]
  Shape "trianglemesh" "point P" [ -9 -.4 -9  9 -.4 -9  9 -.4 9  -9 -.4 9 ] "integer indices" [ 0 1 2 0 2 3 ]
    "float uv" [ 0 0 1 0 1 1 0 1 ]
WorldEnd
SCENE
}

# new_scene FILE MATERIAL-LINES: the same by hand.
new_scene() {
  cat >"new/$1" <<SCENE
LookAt 0 2 6  0 .5 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" [ 48 ] "integer yresolution" [ 32 ]
Sampler "paddedsobol" "integer pixelsamples" 16
PixelFilter "box"
Integrator "path"
WorldBegin
  LightSource "infinite" "rgb L" [ .4 .5 .6 ]
  LightSource "distant" "point3 from" [ 2 5 3 ] "rgb L" [ 1 1 1 ] "float scale" 2
  AttributeBegin
    Translate -1 .5 0
    $2
    Shape "sphere" "float radius" [ .9 ]
  AttributeEnd
  Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
  Shape "trianglemesh" "point3 P" [ -9 -.4 -9  9 -.4 -9  9 -.4 9  -9 -.4 9 ] "integer indices" [ 0 1 2 0 2 3 ]
    "point2 uv" [ 0 0 1 0 1 1 0 1 ]
SCENE
}

# same NAME OLD-MATERIAL NEW-MATERIAL: both scenes give the same bytes.
same() {
  old_scene "$1.pbrt" "$2"
  new_scene "$1-hand.pbrt" "$3"
  check "$1_upgrades" "$VELO" scene upgrade "old/$1.pbrt" "new/$1.pbrt" --quiet
  rm -f a.pfm b.pfm
  "$VELO" render "new/$1.pbrt" -o a.pfm --quiet --threads 1 && "$VELO" render "new/$1-hand.pbrt" -o b.pfm --quiet --threads 1
  check "$1_same_image" cmp a.pfm b.pfm
}

same matte 'Material "matte" "color Kd" [ .8 .2 .1 ]' 'Material "diffuse" "rgb reflectance" [ .8 .2 .1 ]'
same plastic 'Material "plastic" "color Kd" [ .8 .2 .1 ] "float roughness" [ .05 ]' \
  'Material "coateddiffuse" "rgb reflectance" [ .8 .2 .1 ] "float roughness" [ .05 ]'
same metal 'Material "metal" "spectrum eta" "spds/Al.eta.spd" "spectrum k" "spds/Al.k.spd"' \
  'Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k" "float roughness" .01'
same glass 'Material "glass" "float index" 1.4' 'Material "dielectric" "float eta" 1.4'
same mirror 'Material "mirror" "rgb Kr" [ .8 .8 .8 ]' 'Material "conductor" "rgb reflectance" [ .8 .8 .8 ]'
same opacity 'Material "uber" "rgb Ks" [ 0 0 0 ] "rgb opacity" [ 0 0 0 ]' 'Material "interface"'
same mix 'MakeNamedMaterial "a" "string type" "matte" "rgb Kd" [ .9 .1 .1 ] MakeNamedMaterial "b" "string type" "matte"
  "rgb Kd" [ .1 .1 .9 ] Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [ 1 1 1 ]' \
  'Material "diffuse" "rgb reflectance" [ .9 .1 .1 ]'
same translucent 'Material "translucent" "rgb Kd" [ .8 .8 .8 ] "rgb reflect" [ .5 .5 .5 ] "rgb transmit" [ .25 .25 .25 ]' \
  'Material "diffusetransmission" "rgb reflectance" [ .4 .4 .4 ] "rgb transmittance" [ .2 .2 .2 ]'

# What is printed, and the codes.
old_scene lost.pbrt 'Material "fourier" "string bsdffile" "a.bsdf"'
expect_code 3 recognised "$VELO" render old/lost.pbrt
expect_text recognised_text 'this is a pbrt-v3 scene (Film "image"): velo scene upgrade old/lost.pbrt NEW.pbrt'
expect_code 3 checked "$VELO" scene check old/lost.pbrt
expect_text checked_text 'velo scene upgrade'
check listed "$VELO" scene upgrade old/lost.pbrt new/lost.pbrt
expect_code 0 listed "$VELO" scene upgrade old/lost.pbrt new/lost.pbrt
expect_text listed_change $'old/lost.pbrt:3: Film: "image" -> "rgb"\n'
expect_text listed_loss 'old/lost.pbrt:12: lost: fourier has no counterpart'
expect_text listed_sum ', 1 without counterpart'
rm new/lost.pbrt
expect_code 3 strict "$VELO" scene upgrade --strict old/lost.pbrt new/lost.pbrt
check strict_writes_nothing test ! -e new/lost.pbrt
expect_code 2 not_itself "$VELO" scene upgrade old/lost.pbrt old/lost.pbrt
expect_code 4 missing "$VELO" scene upgrade old/none.pbrt new/none.pbrt
expect_code 5 no_folder "$VELO" scene upgrade old/lost.pbrt nowhere/none.pbrt

# Names that are given twice: each block has its own, whatever its kind, also in a file that is included twice.
image() {
  printf '%s\n' 'LookAt 0 0 9  0 0 0  0 1 0' 'Camera "perspective" "float fov" 40' "Film \"$1\" \"integer xresolution\" 48 \"integer yresolution\" 32" \
    'Sampler "sobol" "integer pixelsamples" 8' 'PixelFilter "box"' 'Integrator "path"' WorldBegin 'LightSource "infinite"'
}
cat >old/green.pbrt <<'END'
Texture "t" "color" "constant" "rgb value" [ .1 .9 .1 ]
Texture "t" "float" "constant" "float value" .2
MakeNamedMaterial "m" "string type" "plastic" "texture Kd" "t" "texture roughness" "t"
NamedMaterial "m"
Shape "sphere" "float radius" [ .7 ]
END
{
  image image
  cat <<'END'
AttributeBegin
  Texture "t" "color" "constant" "rgb value" [ .9 .1 .1 ]
  AttributeBegin
    Texture "t" "color" "constant" "rgb value" [ .1 .1 .9 ]
    Material "matte" "texture Kd" "t"
    Translate -2 0 0
    Shape "sphere" "float radius" [ .7 ]
  AttributeEnd
  Material "matte" "texture Kd" "t"
  Shape "sphere" "float radius" [ .7 ]
  MakeNamedMaterial "m" "string type" "matte" "texture Kd" "t"
AttributeEnd
AttributeBegin
  Translate 2 0 0
  Include "green.pbrt"
  Translate 0 2 0
  Include "green.pbrt"
AttributeEnd
ObjectBegin "o"
  Shape "sphere" "float radius" [ .5 ]
ObjectEnd
TransformBegin
  Translate -2 2 0
  ObjectInstance "o"
TransformEnd
ObjectBegin "o"
  Shape "disk" "float radius" [ .5 ]
ObjectEnd
TransformBegin
  Translate 0 2 0
  ObjectInstance "o"
TransformEnd
WorldEnd
END
} >old/twice.pbrt
{
  image rgb
  for ball in 'Translate -2 0 0|Material "diffuse" "rgb reflectance" [ .1 .1 .9 ]|sphere|.7' \
    'Translate 0 0 0|Material "diffuse" "rgb reflectance" [ .9 .1 .1 ]|sphere|.7' \
    'Translate 2 0 0|Material "coateddiffuse" "rgb reflectance" [ .1 .9 .1 ] "float roughness" .2|sphere|.7' \
    'Translate 2 2 0|Material "coateddiffuse" "rgb reflectance" [ .1 .9 .1 ] "float roughness" .2|sphere|.7' \
    'Translate -2 2 0||sphere|.5' 'Translate 0 2 0||disk|.5'; do
    IFS='|' read -r place material shape radius <<<"$ball"
    printf '%s\n' AttributeBegin "$material" "$place" "Shape \"$shape\" \"float radius\" $radius" AttributeEnd
  done
} >new/twice-hand.pbrt
check twice "$VELO" scene upgrade old/twice.pbrt new/twice.pbrt
expect_text twice_says 'Texture: a second "t" -> "t-2"'
check twice_includes sh -c 'grep -q "Include \"green.pbrt\"" new/twice.pbrt && grep -q "Include \"green-2.pbrt\"" new/twice.pbrt'
check twice_rules "$VELO_SOURCE_DIR/tools/check_pbrt" new/twice.pbrt
check twice_a "$VELO" render new/twice.pbrt -o a.exr --quiet
check twice_b "$VELO" render new/twice-hand.pbrt -o b.exr --quiet
check twice_image "$VELO" image diff a.exr b.exr --threshold relmse=0.02

# What velo would not read is not written, and a file of that name stays.
{ image image; printf 'Shape "sphere" "float radius" "big"\n'; } >old/wrong.pbrt
cp new/twice.pbrt new/wrong.pbrt
cp new/green.pbrt green-before.pbrt
expect_code 3 wrong "$VELO" scene upgrade old/wrong.pbrt new/wrong.pbrt
expect_text wrong_says 'the upgraded scene is wrong here, and nothing is written'
expect_text wrong_place "old/wrong.pbrt:$(grep -n '\"big\"' old/wrong.pbrt | cut -d: -f1):"
check wrong_keeps cmp new/wrong.pbrt new/twice.pbrt
{ image image; printf 'Include "green.pbrt"\nInclude "bad.pbrt"\n'; } >old/wrong.pbrt
printf 'Texture "t" "color" "constant"\nShape "sphere" "float radius" "big"\nMaterial "matte"\n' >old/bad.pbrt
expect_code 3 wrong_include "$VELO" scene upgrade old/wrong.pbrt new/wrong.pbrt
expect_text wrong_include_place 'new/bad.pbrt:2'
check wrong_include_writes_none test ! -e new/bad.pbrt
check wrong_include_keeps cmp new/green.pbrt green-before.pbrt

# Missing images of other formats; files elsewhere.
printf 'newmtl a\nmap_Kd gone.png\n' >t.mtl
printf 'mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n' >t.obj
check done_without "$VELO" render t.obj --spp 1 --resolution 8x8 -o t.exr --quiet
expect_code 4 missing_strict "$VELO" render t.obj --strict --spp 1 --resolution 8x8 -o t.exr
mkdir -p lib
printf 'Shape "sphere"\n' >lib/ball.pbrt
printf 'WorldBegin\nInclude "ball.pbrt"\nLightSource "infinite"\n' >old/search.pbrt
expect_code 4 not_found "$VELO" render old/search.pbrt --spp 1 --resolution 8x8 -o s.exr
check search_path "$VELO" render old/search.pbrt --search-path nowhere --search-path lib --spp 1 --resolution 8x8 -o s.exr --quiet
check search_again "$VELO" render --again s.exr -o again.exr --quiet
check search_same cmp s.exr again.exr
finish
