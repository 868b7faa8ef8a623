#!/usr/bin/env bash
# The image of a model without further options: 8 samples, denoised; each condition that turns this off; the same bytes
# for any number of threads; the command that the last line names; the text in the file.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

# A slab and a lamp; with a camera or without.
python3 - <<'END'
import json, struct
corners = [(x, y, z) for x in (-1, 1) for y in (0, 1) for z in (-0.5, 0.5)]
faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
data = b"".join(struct.pack("<3f", *c) for c in corners) + b"".join(struct.pack("<3H", *f) for f in faces)
open("slab.bin", "wb").write(data)
g = {"asset": {"version": "2.0"}, "scene": 0, "buffers": [{"byteLength": len(data), "uri": "slab.bin"}],
     "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
     "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
                   {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
     "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
     "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}
json.dump(g, open("slab.gltf", "w"))
g["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.6, "aspectRatio": 1.5, "znear": 0.1}}]
g["nodes"].append({"camera": 0, "translation": [0, 0.5, 5]})
g["scenes"][0]["nodes"].append(1)
json.dump(g, open("own_camera.gltf", "w"))
END
size="--resolution 48x32"

# ---- the rule ----
# shellcheck disable=SC2086
check plain_run "$VELO" render slab.gltf $size -o first.png
expect_text says "8 spp, denoised, in"
expect_text names_command "without denoising: velo render slab.gltf -o first.png --resolution 48x32 --plain"
# shellcheck disable=SC2086
check usual "$VELO" render slab.gltf $size --spp 64 -o usual.png
# shellcheck disable=SC2086
check copy "$VELO" render slab.gltf $size --spp 8 -o raw.png --denoise copy.png
# The same pixels as those of --denoise.
pixels() { "$VELO" image diff "$2" "$3" --threshold maxabs=0 >/dev/null 2>&1 && pass "$1" || fail "$1"; }
pixels pixels_of_denoise copy.png first.png
for t in 1 2 3; do
  # shellcheck disable=SC2086
  check "threads_$t" "$VELO" render slab.gltf $size -t $t --quiet -o t.png -o t.jpg -o t.tga
  same "bytes_$t" t.png first.png
done
for suffix in png jpg tga; do
  grep -aq "8 samples per pixel, denoised by velo" t.$suffix && pass "text_$suffix" || fail "text_$suffix"
  check "reads_$suffix" "$VELO" image info t.$suffix
done
check default_name "$VELO" render slab.gltf --resolution 24x16 --quiet
grep -aq "denoised by velo" slab.png && pass default_name_denoised || fail default_name_denoised
check json "$VELO" render slab.gltf --resolution 24x16 --log-json -o json.png
expect_text json_says '"denoised": true, "plain": "velo render slab.gltf -o json.png --resolution 24x16 --log-json --plain"'

# ---- the command in the last line runs as it stands ----
mkdir "it's a"
cp slab.gltf slab.bin "it's a"
check quoted "$VELO" render "it's a/slab.gltf" --resolution 48x32 --exposure -0.5 -o 'a $b.png'
line=$(printf '%s\n' "$err" | sed -n 's/.*; without denoising: //p')
cp 'a $b.png' denoised.png
check runs_as_written env PATH="$(dirname "$VELO"):$PATH" bash -c "$line"
expect_text has_usual_samples "64 spp in"
check usual_exposed "$VELO" render "it's a/slab.gltf" --resolution 48x32 --exposure -0.5 --spp 64 -o usual_exposed.png
same is_plain 'a $b.png' usual_exposed.png

# ---- what turns it off ----
# sampling NAME TEXT OPTIONS...: the sampling that --dry-run tells.
sampling() {
  local name=$1 text=$2
  shift 2
  check "$name" "$VELO" render "$@" --resolution 48x32 --dry-run
  expect_text "${name}_samples" "sampling  $text, sampler"
}
sampling rule "8 spp, denoised" slab.gltf -o a.png
for option in "-o b.jpg" "-o b.tga" "-t 1" --ground --no-ground "--framing front" "--up z" "--walls keep" "--environment sky" \
  "--environment-rotation 20" "--environment-strength 2" "--view agx" "--exposure 1" "--turn 20" --strict "--max-memory 1G" \
  "--accelerator bvh" --quiet --verbose; do
  # shellcheck disable=SC2086
  sampling "with_${option//[^a-z]/_}" "8 spp, denoised" slab.gltf -o a.png $option
done
for option in --plain "-o b.exr" "-o b.hdr" "-o b.pfm" "--denoise c.png" "--film f.film" "--channels Z -o b.exr" \
  --transparent "--crop 0,0,8,8" "--cropwindow 0,.5,0,.5" "--seed 1" "--sampler halton" "--filter box" "--filter-samples own" \
  "--tracer path" "--max-depth 3" "--color rgb" "--sensor canon_eos_5d" "--regularize on" "--light-sampler power" \
  "--bits fast" "--half" "--no-receipt" "--time 99" "--lens-radius .1" "--focus-distance 2" "--stereo off-axis --convergence 3 -o b%v.png" "--spectrum 4 -o b.exr"; do
  name=off_${option//[^a-z]/_}
  # shellcheck disable=SC2086
  check "$name" "$VELO" render slab.gltf -o a%v.png $option --resolution 48x32 --dry-run
  case "$out" in
    *denoised* | *" 8 spp"*) fail "${name}_samples" ;;
    *"sampling  64 spp"* | *"sampling  65536 spp"*) pass "${name}_samples" ;;
    *) fail "${name}_samples"; show "$name" ;;
  esac
done
sampling spp "8 spp" slab.gltf -o a.png --spp 8
sampling noise "65536 spp" slab.gltf -o a.png --noise 2%
sampling default_exr "64 spp" slab.gltf --half
sampling turntable "64 spp" slab.gltf --turntable 2 -o 't%d.png'
sampling lit_only "8 spp, denoised" own_camera.gltf -o a.png
sampling nothing_added "64 spp" own_camera.gltf -o a.png --environment none
write_scene room.pbrt
sampling scene "4 spp" room.pbrt -o a.png
# shellcheck disable=SC2086
check by_name "$VELO" render slab.gltf $size --plain -o by_name.png
same as_before by_name.png usual.png
grep -aq denoised by_name.png && fail no_text || pass no_text

# A receipt holds its samples: it repeats as before.
check receipt "$VELO" render slab.gltf --resolution 24x16 --quiet -o receipt.exr
check again "$VELO" render --again receipt.exr -o again.exr -o again.png
same again_same receipt.exr again.exr
grep -aq denoised again.png && fail again_plain || pass again_plain

# The options that say what velo has chosen ask for no other quality: the receipt's command without its --spp and its .exr makes
# the first image, byte for byte.
for m in "slab.gltf" "slab.gltf --ground" "slab.gltf --no-ground" "slab.gltf --environment evening" "own_camera.gltf"; do
  name=chosen_${m//[ .]/_}
  read -r -a words <<<"$m"
  check "$name" "$VELO" render "${words[@]}" --resolution 24x16 --quiet -o chosen.exr
  check "${name}_first" "$VELO" render "${words[@]}" --resolution 24x16 -o chosen.png
  "$VELO" image info chosen.exr >chosen.txt
  words=()
  while read -r word; do
    words+=("$word")
  done < <(sed -n 's/^  command  *velo render //p' chosen.txt | sed 's/ -o [^ ]*//; s/ --spp [^ ]*//' | tr ' ' '\n')
  check "${name}_said" "$VELO" render "${words[@]}" -o said.png
  expect_text "${name}_is_denoised" "8 spp, denoised, in"
  same "${name}_same" chosen.png said.png
done
finish
