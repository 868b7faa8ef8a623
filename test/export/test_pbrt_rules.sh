#!/usr/bin/env bash
# What velo scene convert writes keeps pbrt-v4's rules (tools/check_pbrt), whatever images the scene has: the studio of a model
# without lights, grey images where pbrt wants R, G and B, names that pbrt does not read. The images stay the same.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1
rules=$VELO_SOURCE_DIR/tools/check_pbrt
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n' >model.obj
check studio "$VELO" scene convert model.obj studio.pbrt
check studio_rules "$rules" studio.pbrt

# Images of one channel, of Y and A, and of a name that says nothing, in every place that takes one.
cat >card.pbrt <<'END'
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 4
WorldBegin
LightSource "infinite" "rgb L" [0.2 0.5 0.9]
Translate 0 0 4
Shape "sphere"
END
"$VELO" render card.pbrt -o color.exr --quiet
"$VELO" image convert color.exr grey.exr --channel G
"$VELO" image convert color.exr grey.png --channel G
"$VELO" image convert color.exr color.png
cp color.png picture
/usr/bin/python3 - <<'END'
import struct, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
row = b"\0" + bytes(v for x in range(8) for v in (30 * x, 255 - x))
open("two.png", "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 4, 0, 0, 0)) +
                            chunk(b"IDAT", zlib.compress(row * 8)) + chunk(b"IEND", b""))
END
scene() {
  sed '/WorldBegin/,$d' card.pbrt
  printf 'WorldBegin\nAttributeBegin\n%s\nAttributeEnd\nTranslate 0 0 4\n%s\nShape "sphere"\nShape "disk" "float radius" 3\n' "$1" "$2"
}
scene 'LightSource "infinite" "string filename" "grey.exr"' '' >sky.pbrt
scene 'LightSource "infinite" "string filename" "grey.png" "float illuminance" 2' '' >sky8.pbrt
scene 'LightSource "infinite" "string filename" "picture"' '' >unnamed.pbrt
scene 'LightSource "projection" "string filename" "grey.png" "float scale" 30' '' >beam.pbrt
scene 'LightSource "goniometric" "string filename" "grey.exr"' '' >lamp.pbrt
scene 'Translate 2 1 3 AreaLightSource "diffuse" "string filename" "grey.png" Shape "disk"' '' >area.pbrt
scene 'LightSource "infinite"' 'Material "diffuse" "string normalmap" "grey.png"' >normals.pbrt
scene 'LightSource "infinite"' 'Texture "t" "spectrum" "imagemap" "string filename" "two.png" Material "diffuse" "texture reflectance" "t"' >texture.pbrt
scene 'LightSource "infinite"' 'Texture "t" "spectrum" "imagemap" "string filename" "picture" Material "diffuse" "texture reflectance" "t"' >plain.pbrt
scene 'MakeNamedMedium "c" "string type" "cloud" "float scale" 3' 'LightSource "infinite" MediumInterface "c" "" Material "interface"' >cloud.pbrt
for name in sky sky8 unnamed beam lamp area normals texture plain cloud; do
  check "${name}_converts" "$VELO" scene convert "$name.pbrt" "$name.out.pbrt"
  check "${name}_rules" "$rules" "$name.out.pbrt"
  [ "$name" = normals ] && continue # a grey normal map has no meaning
  "$VELO" render "$name.pbrt" -o a.exr --quiet
  "$VELO" render "$name.out.pbrt" -o b.exr --quiet
  check "${name}_same" "$VELO" image diff a.exr b.exr --threshold maxabs=2e-3
done

# velo's own parameters are no part of pbrt's language.
scene 'LightSource "infinite"' 'Material "coateddiffuse" "bool conserveenergy" true' >own.pbrt
expect_code 3 own_strict "$VELO" scene convert own.pbrt own.out.pbrt --strict
expect_text own_strict_says 'conserveenergy of coateddiffuse: left out'
scene 'LightSource "infinite"' 'Texture "t" "float" "dots" Material "hair" "texture displacement" "t"' >hair.pbrt
check hair "$VELO" scene convert hair.pbrt hair.out.pbrt
expect_text hair_says 'not held: displacement of hair: left out (1)'
check hair_rules "$rules" hair.out.pbrt
scene 'LightSource "infinite"' 'Material "principled" "rgb basecolor" [.8 .2 .1] "float metallic" 1' >metal.pbrt
check metal "$VELO" scene convert metal.pbrt metal.out.pbrt
check metal_rules "$rules" metal.out.pbrt

# A camera that pbrt has not keeps its place.
scene 'LightSource "infinite"' '' | sed 's/^Camera.*/Camera "panini" "float panini" 0.5 "point3 eye" [1 2 -3] "point3 lookat" [0 0 4]/' >wide.pbrt
check wide "$VELO" scene convert wide.pbrt wide.out.pbrt
expect_text wide_says 'pbrt cannot hold this camera'\''s "projection"'
expect_text wide_says_no_more '"projection" (1)'
check wide_rules "$rules" wide.out.pbrt
run "$VELO" scene info wide.out.pbrt
expect_text wide_place 'camera      perspective at (1, 2, -3)'

# Every scene of features/ and the lecture.
for file in "$VELO_SOURCE_DIR"/scenes/features/*.pbrt "$VELO_SOURCE_DIR"/scenes/lecture/*.pbrt "$VELO_SOURCE_DIR"/scenes/gallery/*.pbrt; do
  name=$(basename "$file" .pbrt)
  run "$VELO" scene convert "$file" "of_$name.pbrt"
  if [ "$code" = 0 ]; then check "rules_of_$name" "$rules" "of_$name.pbrt"; else fail "rules_of_$name"; show "scene convert $file"; fi
done
finish
