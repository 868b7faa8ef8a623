#!/usr/bin/env bash
# glTF files through the program: an image with no further word, own cameras, surroundings, moments, variants; every
# model of ../shared; the first pass of a large one is soon on disk.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
# A square of four corners that looks towards +z, and goes aside.
cat >square.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
 "nodes": [{"mesh": 0}, {"name": "near", "camera": 0, "translation": [0.5, 0.5, 2]},
           {"name": "far", "camera": 0, "translation": [0.5, 0.5, 20]}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 1, "znear": 0.1}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}],
 "animations": [{"samplers": [{"input": 1, "output": 2}],
                 "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
               {"bufferView": 0, "byteOffset": 16, "componentType": 5126, "count": 2, "type": "SCALAR",
                "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 0, "byteOffset": 12}}},
               {"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3",
                "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 4},
                 {"buffer": 0, "byteOffset": 52, "byteLength": 12}],
 "buffers": [{"byteLength": 64, "uri": "my%20data.bin"}]}
END
python3 -c '
import struct
open("my data.bin", "wb").write(struct.pack("<12f", 0,0,0, 1,0,0, 0,1,0, 1,1,0) + bytes([1,0,0,0]) + struct.pack("<3f", 9,0,0))'
sed 's/"camera": 0, //g' square.gltf >plain.gltf

check plain "$VELO" render plain.gltf --resolution 32x24 --spp 2 -o plain.exr
expect_text plain_tells 'no camera in the file: eye ('
check near "$VELO" render square.gltf --camera near --spp 2 --environment white -o near.exr --quiet
check by_number "$VELO" render square.gltf --camera 0 --spp 2 --environment white -o number.exr --quiet
check by_number_same "$VELO" image diff near.exr number.exr --threshold differing=0
check far "$VELO" render square.gltf --camera far --resolution 32x32 --spp 2 --environment none -o far.exr --quiet
# Names of the file reach the ids' description, Cryptomatte and `scene info`.
sed 's/{"mesh": 0}/{"mesh": 0, "name": "Sheet"}/' square.gltf >named.gltf
check named "$VELO" render named.gltf --resolution 16x16 --spp 1 --channels id.object,crypto.object -o named.exr --quiet
check named_ids python3 -c '
import json
o = json.load(open("named.exr.ids.json"))["objects"]["1"]
assert o["name"] == "Sheet" and o["path"] == "Sheet" and o["place"] == "nodes[0].meshes[0].primitives[0]", o
assert "line" not in o, o'
check named_matte "$VELO" image info named.exr
expect_text named_manifest '"Sheet":"'
check named_scene "$VELO" scene info named.gltf
expect_text named_info '1    Sheet  (nodes[0].meshes[0].primitives[0])'
expect_text named_cameras 'cameras     2: 0 near, 1 far'
check named_scene_json "$VELO" scene info named.gltf --json
expect_text named_json '"shape": [{"id": 1, "name": "Sheet"'
# What no scene uses does not stop a render; `scene check` warns of it.
sed 's/"meshes": \[/"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 4}}}], &/' square.gltf >unused.gltf
check unused_renders "$VELO" render unused.gltf --resolution 8x8 --spp 1 -o unused.exr --quiet
expect_code 1 unused_warns "$VELO" scene check unused.gltf
expect_text unused_says 'no scene uses it, but: materials[0].pbrMetallicRoughness.baseColorTexture'
expect_text unused_code 'UNUSED_OBJECT'
expect_code 3 no_such_camera "$VELO" render square.gltf --camera back
expect_text no_such_camera_says 'the scene has no camera "back" (2 are there: near, far)'
expect_code 3 no_such_variant "$VELO" render square.gltf --variant red
check moved "$VELO" render square.gltf --camera near --at 1 --resolution 32x32 --spp 1 --environment white --channels Z -o moved.exr --quiet
check unmoved "$VELO" render square.gltf --camera near --resolution 32x32 --spp 1 --environment white --channels Z -o unmoved.exr --quiet
expect_code 1 moved_differs "$VELO" image diff moved.exr unmoved.exr --threshold differing=0
# Two moments: what moves is blurred. Scenes by name. Lamps are metered, unless an exposure is said.
check blurred "$VELO" render square.gltf --camera near --at 0:1 --resolution 32x32 --spp 4 --environment white -o blurred.exr --quiet
expect_code 2 shutter_alone "$VELO" render square.gltf --shutter 1
expect_code 2 shutter_backwards "$VELO" render square.gltf --at 2:1
expect_code 2 bad_moment "$VELO" render square.gltf --at noon
check scene_0 "$VELO" render square.gltf --scene 0 --dry-run --quiet
expect_code 3 no_such_scene "$VELO" render square.gltf --scene 1
expect_text no_such_scene_says 'there is no scene "1" (1 are there)'
check metered "$VELO" render plain.gltf --resolution 16x12 --spp 1 --exposure auto -o metered.png
expect_text metered_tells 'EV, as metered'
expect_code 2 bad_exposure "$VELO" render plain.gltf --exposure bright
# A white surface in white surroundings cannot be seen to be brighter than they are; without light all is black.
"$VELO" image convert near.exr near.pfm
"$VELO" image convert far.exr far.pfm
python3 - <<'END' && pass levels || fail levels
import sys
import numpy as np
def read(name):  # rows from the bottom up; the check below is even in that
    head, size, scale, data = open(name, "rb").read().split(b"\n", 3)
    w, h = map(int, size.split())
    return np.frombuffer(data, "<f4" if float(scale) < 0 else ">f4").reshape(h, w, 3)[::-1]
a = read("near.pfm")
f = read("far.pfm")
h = a.shape[0]
inside, outside = a[h * 3 // 8:h * 5 // 8, h * 3 // 8:h * 5 // 8, :3].mean(), a[:h // 16, :, :3].mean()
print(inside, outside, abs(f[:, :, :3]).max())
sys.exit(not (abs(outside - 1) < 0.02 and 0.9 < inside < 1.02 and abs(f[:, :, :3]).max() == 0))
END
# Surroundings from an image: twice as wide as high, or square; turning it by half a turn and the image itself agree.
python3 - <<'END'
import numpy as np
p = np.zeros((32, 64, 3), np.float32)
p[:, :, 0] = np.linspace(0.1, 1, 64)[None, :]
p[:, :, 1] = np.linspace(0.2, 2, 32)[:, None]
for name, q in (("a.pfm", p), ("b.pfm", np.roll(p, 32, axis=1)), ("odd.pfm", p[:, :40])):
    with open(name, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (q.shape[1], q.shape[0]) + q[::-1].astype("<f4").tobytes())
END
check env_a "$VELO" render square.gltf --camera far --resolution 48x48 --spp 8 --environment a.pfm --environment-rotation 180 -o ea.exr --quiet
check env_b "$VELO" render square.gltf --camera far --resolution 48x48 --spp 8 --environment b.pfm -o eb.exr --quiet
check env_same "$VELO" image diff ea.exr eb.exr --threshold mse=0.001
check env_strength "$VELO" render square.gltf --camera far --resolution 48x48 --spp 8 --environment b.pfm --environment-strength 2 -o ec.exr --quiet
expect_code 1 env_stronger "$VELO" image diff eb.exr ec.exr --threshold mse=0.001
expect_code 3 env_odd "$VELO" render square.gltf --environment odd.pfm
expect_text env_odd_says '40 x 32: an image of the surroundings must be twice as wide as high, or square'
expect_code 4 env_missing "$VELO" render square.gltf --environment nowhere.hdr
check ground "$VELO" render plain.gltf --resolution 16x16 --spp 1 --ground --environment sky -o ground.png --quiet
# What velo writes as a glTF camera it takes back without loss.
check camera_out "$VELO" camera convert square.gltf out.gltf --frame near
check camera_in "$VELO" render out.gltf --dry-run --quiet

# ---- models that others made ------------------------------------------------------------------------------------------
if [ ! -d "$shared/scenes/gltf" ]; then
  skip models "needs ../shared/scenes/gltf"
  finish
fi
for file in "$shared"/scenes/gltf/*/*.gl*; do
  check "model_$(basename "$file" | tr ' ' '_')" "$VELO" render "$file" --resolution 16x16 --spp 1 -o model.exr --quiet
done
finish
