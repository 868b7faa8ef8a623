#!/usr/bin/env bash
# Options of velo render (and of the commands that have some of them) that have no effect without something else: each is named in a note, and with --strict-options
# refused, where it is missing, and silent where it is there. Every option of the help page is in one of the lists.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
printf 'v -1 0 0\nv 1 0 0\nv 1 1 0.3\nv -1 1 0\nf 1 2 3 4\n' >model.obj
python3 - <<'PYTHON'
import base64, json, struct

data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 1, 0, 0)
names = {"KHR_materials_variants": {"variants": [{"name": "red"}]}}
uses = {"KHR_materials_variants": {"mappings": [{"material": 0, "variants": [0]}]}}
scene = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "cameras": [
        {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
    "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4]}], "materials": [{"name": "red"}],
    "extensionsUsed": list(names), "extensions": names,
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "extensions": uses}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
        {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteOffset": a, "byteLength": n} for a, n in ((0, 36), (36, 8), (44, 24))],
    "buffers": [{"byteLength": len(data),
                 "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                    "samplers": [{"input": 1, "output": 2}]}]}
json.dump(scene, open("model.gltf", "w"))
del scene["animations"]
json.dump(scene, open("still.gltf", "w"))
json.dump({"camera_angle_x": 0.7, "frames": [{"file_path": "a", "transform_matrix": [
    [1, 0, 0, 0], [0, 1, 0, 1], [0, 0, 1, 4], [0, 0, 0, 1]]}]}, open("transforms.json", "w"))
PYTHON
printf 'listed\n' >listed # names of the options below

# without NAME ARGUMENTS...: the option has no effect in this render.
without() {
  local name=$1
  shift
  echo "$name" >>listed
  run "$VELO" render --dry-run "$@"
  if [ "$code" = 0 ] && [[ $err == *"velo: --$name has no effect: "* || $err == *"warning: --$name: "* || $err == *"warning: $name: "* ]]; then pass "$name: note"; else fail "$name: note"; show "$*"; fi
  run "$VELO" render --dry-run --quiet --strict-options "$@"
  if [ "$code" = 2 ] && [[ $err == *"velo: --$name has no effect: "* ]]; then pass "$name: strict"; else fail "$name: strict"; show "$*"; fi
}

# with NAME ARGUMENTS...: it has one.
with() {
  local name=$1
  shift
  echo "$name" >>listed
  run "$VELO" render --dry-run --strict-options "$@"
  if [ "$code" = 0 ] && [[ $err != *'has no effect'* ]]; then pass "$name: silent"; else fail "$name: silent"; show "$*"; fi
}

P=scene.pbrt G=model.gltf O=model.obj S=still.gltf
# the file and what velo adds to it
without scene $P --scene 0
with scene $G --scene 0
without variant $P --variant red
without variant $O --variant red
with variant $G --variant red
sed 's/^WorldBegin/WorldBegin LightSource "infinite"/' $P >sky.pbrt
sed 's/^WorldBegin/WorldBegin LightSource "point"/' $P >point.pbrt
sed 's/^WorldBegin/WorldBegin AttributeBegin AreaLightSource "diffuse" "float power" 9 Shape "sphere" AttributeEnd/' $P >power.pbrt
without scene-unit sky.pbrt --scene-unit cm
with scene-unit point.pbrt --scene-unit cm
with scene-unit power.pbrt --scene-unit cm
without at $P --at 0.5
without at $S --at 0.5
with at $G --at 0.5
without shutter $P --at 0.5 --shutter 0.1
without shutter $S --at 0.5 --shutter 0.1
with shutter $G --at 0.5 --shutter 0.1
without animation $P --animation 0
without animation $G --animation 0
with animation $G --animation 0 --at 0.5
without animate $P --animate 0:1 -o f%d.png
without animate $S --animate 0:1 -o f%d.png
with animate $G --animate 0:1 -o f%d.png
without fps $P --fps 10
without fps $G --turntable 2 --fps 10 -o f%d.png
with fps $G --animate 0:1 --fps 10 -o f%d.png
without up $P --up z
with up $P --up z --turn 20
with up $O --up z
without framing $P --framing front
without framing $G --framing front
with framing $O --framing front
without walls $P --walls keep
with walls $O --walls keep
with walls $P --walls 3,2,4
with walls $P --walls both-sides
with ground-middle $P --ground-middle 0,-1,0
with ground-radius $P --ground-radius 3
without no-ground $P --no-ground
without no-ground $O --no-ground --environment sky
with no-ground $O --no-ground
without environment-rotation $P --environment-rotation 20
with environment-rotation $P --environment-rotation 20 --environment sky
without environment-strength $P --environment-strength 2
with environment-strength $O --environment-strength 2
# the camera
without frame $P --camera scene.pbrt --frame 0
with frame $P --camera transforms.json --frame 0 --size 8x8
without size $P --size 8x8
without size $P --size 8x8 --camera scene.pbrt
with size $P --size 8x8 --camera transforms.json
with size $P --size 8x8 --trajectory transforms.json -o f%d.exr
without focus-pixel $P --focus-pixel 32,40
with focus-pixel $P --focus-pixel 32,40 --lens-radius 0.1
without focus-distance $P --focus-distance 3
with focus-distance $P --focus-distance 3 --lens-radius 0.1
# outputs
without checkpoint $P --checkpoint 5s
with checkpoint $P --checkpoint 5s --film a.film
without view $P --view agx -o a.exr
with view $P --view agx -o a.png
with view $P --view agx -o a.exr --denoise b.png
without exposure $P --exposure 1 -o a.exr
with exposure $P --exposure 1 -o a.exr -o a.jpg
without half $P --half -o a.png
with half $P --half -o a.exr
without no-receipt $P --no-receipt -o a.png
with no-receipt $P --no-receipt -o a.exr
without boxes $P --boxes -o a.png
with boxes $P --boxes -o a.exr
without flow-camera $P --flow-camera scene.pbrt -o a.png
with flow-camera $P --flow-camera scene.pbrt -o a.exr
without flow-camera-before $P --flow-camera-before scene.pbrt -o a.png
with flow-camera-before $P --flow-camera-before scene.pbrt -o a.exr
without channels $P --channels Z -o a.png
with channels $P --channels Z -o a.exr
without spectrum $P --spectrum 4 -o a.png
with spectrum $P --spectrum 4 -o a.exr
without transparent $P --transparent -o a.jpg
with transparent $P --transparent -o a.png
without channels-mode $P --channels-mode nearest
with channels-mode $P --channels-mode nearest --channels Z
without channels-time $P --channels-time open
with channels-time $P --channels-time open --channels Z
without crypto-ranks $P --crypto-ranks 4 --channels Z
with crypto-ranks $P --crypto-ranks 4 --channels crypto
without denoiser-library $P --denoise b.exr --denoiser-library /nowhere/oidn.so
# the tracer
without merge-radius $P --merge-radius 0.1
with merge-radius $P --merge-radius 0.1 --tracer sppm
without light-paths $P --light-paths 100
with light-paths $P --light-paths 100 --tracer bidirectional
without max-depth $P --max-depth 3 --tracer raycast
with max-depth $P --max-depth 3
without light-sampler $P --light-sampler power --tracer ao
with light-sampler $P --light-sampler power
without regularize $P --regularize on --tracer raycast
with regularize $P --regularize on
# those that always have an effect
with output $P -o a.exr
with spp $P --spp 3
with noise $P --noise 2%
with denoise $P --denoise b.exr
with denoiser $P --denoise b.exr --denoiser velo
with time $P --time 1m
with resolution $P --resolution 8x8
with crop $P --crop 0,0,4,4
with cropwindow $P --cropwindow 0,0.5,0,0.5
with film $P --film a.film
with overwrite $P --film a.film --overwrite
with shard $P --film a.film --shard 1/2
with shard-by $P --film a.film --shard 1/2 --shard-by tiles
with samples $P --film a.film --samples 0:1
with tiles $P --film a.film --tiles 0,0,32,32
with camera $P --camera scene.pbrt
with turn $P --turn 20
with environment $P --environment sky
with ground $P --ground
with trajectory $P --trajectory transforms.json --size 8x8 -o f%d.exr
with frames $P --trajectory transforms.json --size 8x8 --frames 0 -o f%d.exr
with skip-existing $P --trajectory transforms.json --size 8x8 --skip-existing -o f%d.exr
with turntable $P --turntable 2 -o f%d.exr
with stereo $P --stereo parallel
with interocular $P --stereo parallel --interocular 0.1
with convergence $P --stereo off-axis --convergence 3
with eye $P --stereo parallel --eye left
with tracer $P --tracer volpath
with sampler $P --sampler halton
with seed $P --seed 3
with sequence $P --sequence 64
with filter $P --filter box
with filter-samples $P --filter-samples own
with color $P --color rgb
with sensor $P --sensor cie1931
with lens-radius $P --lens-radius 0.1
with threads $P -t 1
with isa $P --isa base
with bits $P --bits fast
with accelerator $P --accelerator bvh
with max-memory $P --max-memory 1G
with max-texture-pixels $P --max-texture-pixels 1000
with sandbox $P --sandbox .
with permissive $P --permissive
with strict $P --strict
with strict-options $P
with search-path $P --search-path .
with imitate-pbrt $P --imitate-pbrt
with dry-run $P
with quiet $P --quiet
with verbose $P --verbose
with log-json $P --log-json

# Not run here: they need a film, an image, a display or another camera. None of them needs anything to have an effect.
printf '%s\n' continue again serve plain rig f-number iso seconds >>listed
"$VELO" help render --all | sed -n 's/^  \(   \|-., \)  *--\([a-z-]*\).*/\2/p; s/^  -., --\([a-z-]*\).*/\1/p' | grep -vx help | sort -u >options
missing=$(comm -23 options <(sort -u listed) | tr '\n' ' ')
if [ "$(wc -l <options)" -gt 90 ] && [ -z "$missing" ]; then pass all_options; else fail "all_options (of $(wc -l <options) not listed: $missing)"; fi

# A render says it once and goes on; a strict one ends before it, also where a film is there.
run "$VELO" render $P --spp 1 --resolution 8x8 --variant red --merge-radius 1 -o a.exr
if [ "$code" = 0 ] && [ -s a.exr ] && [ "$(grep -c 'has no effect' <<<"$err")" = 2 ]; then pass a_note_each; else fail a_note_each; show notes; fi
expect_text names_the_file '--variant has no effect: scene.pbrt is not a glTF file'
run "$VELO" render $S --dry-run --at 1
expect_text names_the_lack '--at has no effect: still.gltf has no animations'
run "$VELO" render $G --dry-run --animation 0
expect_text names_what_plays '--animation has no effect: no animation is played (--at, --animate)'
run "$VELO" render $P --spp 1 --resolution 8x8 --variant red --merge-radius 1 -o a.exr
expect_text names_the_tracer '--merge-radius has no effect: path: only merging and sppm merge'
run "$VELO" render $P --spp 1 --resolution 8x8 --merge-radius 1 --up z --strict-options --film b.film -o b.exr
if [ "$code" = 2 ] && [ ! -e b.exr ] && [ ! -e b.film ]; then pass strict_before_the_render; else fail strict_before_the_render; show strict; fi
run "$VELO" render $P --spp 1 --resolution 8x8 --animate 0:0.1 --fps 30 -o f%d.png
if [ "$code" = 0 ] && [ "$(grep -c 'has no effect' <<<"$err")" = 1 ]; then pass an_animation_says_it_once; else fail an_animation_says_it_once; show animate; fi
# --quiet and receipts: no note, and --strict-options does not belong to the image
run "$VELO" render $P --spp 1 --resolution 8x8 --variant red --quiet -o c.exr
if [ "$code" = 0 ] && [ -z "$err" ]; then pass quiet; else fail quiet; show quiet; fi
check strict_render "$VELO" render $P --spp 1 --resolution 8x8 --strict-options -o d.exr
check plain_render "$VELO" render $P --spp 1 --resolution 8x8 -o e.exr
check again "$VELO" render --again d.exr --strict-options -o g.exr
same same_bytes d.exr g.exr

# The other commands that have these options: a note, with --strict-options an error before they do anything.
others() {
  local name=$1 missing=$2
  shift 2
  run timeout 20 "$VELO" "$@" --strict-options
  if [ "$code" = 2 ] && [[ $err == *"velo: --$missing has no effect: "* ]]; then pass "$name: strict"; else fail "$name: strict"; show "$*"; fi
}
others verify frame scene verify $P --rays 0.01 --camera scene.pbrt --frame 0
others paths frame camera paths $P --pixel 1,1 --camera scene.pbrt --frame 0
others paths_of_tracer max-depth camera paths $P --pixel 1,1 --tracer raycast --max-depth 3
others draw frame camera draw $P --camera scene.pbrt --frame 0 -o drawing.png
run "$VELO" camera draw $P --camera scene.pbrt --frame 0 --size 64x48 --spp 2 -o drawing.png
if [ "$code" = 0 ] && [ -s drawing.png ]; then pass draw_note; else fail draw_note; show draw; fi
expect_text draw_says '--frame has no effect'
run "$VELO" view $P --no-open --strict-options --resolution 8x8 --variant red
if [[ $err == *'without libwebsockets'* ]]; then
  skip view "velo was built without libwebsockets"
else
  if [ "$code" = 2 ] && [[ $err == *'velo: --variant has no effect: scene.pbrt is not a glTF file'* ]]; then pass view_strict; else fail view_strict; show view; fi
  others view_of_tracer merge-radius view $P --no-open --tracer volpath --merge-radius 0.1
  others view_at at view $S --no-open --at 0.5
  others view_frame frame view $P --no-open --frame 0
  # what the page can change later has an effect, and so has the tracer of a race
  run timeout 3 "$VELO" view $G --no-open --strict-options --at 0.5 --focus-distance 2 --view agx --exposure 1
  if [ "$code" = 124 ] && [[ $err != *'has no effect'* && $out == http* ]]; then pass view_silent; else fail view_silent; show view; fi
  run timeout 3 "$VELO" view $P --no-open --variant red
  if [[ $out == http* ]]; then pass view_goes_on; else fail view_goes_on; show view; fi
  expect_text view_says '--variant has no effect: scene.pbrt is not a glTF file'
fi

finish
