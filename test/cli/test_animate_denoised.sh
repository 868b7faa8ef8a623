#!/usr/bin/env bash
# Denoised frames of an animated model: each uses up to five before it, along the flow of a world that has both moments.
# The bits depend neither on the division of the frames nor on the number of threads.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
# A square with a pattern, which fills the image, passes before a wall; the camera moves, too.
python3 - <<'END'
import base64, json, struct
corners = struct.pack("<12f", -1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0)
times = struct.pack("<2f", 0, 2)
square = struct.pack("<6f", -1, 0.5, 0, 3, 0.5, 0)
eye = struct.pack("<6f", -0.4, 0.8, 4, 0.4, 0.8, 4)
grid = [(i, j) for j in range(25) for i in range(25)]
points = b"".join(struct.pack("<3f", i / 12 - 1, j / 12 - 1, 0) for i, j in grid)
shades = b"".join(struct.pack("<3f", *[0.8 if (i + j) % 2 else 0.2] * 3) for i, j in grid)
faces = [k + d for j in range(24) for k in range(25 * j, 25 * j + 24) for d in (0, 1, 25, 1, 26, 25)]
data = corners + times + square + eye + points + shades + struct.pack("<3456H", *faces)
paths = [{"sampler": k, "target": {"node": 1 + k, "path": "translation"}} for k in range(2)]
samplers = [{"input": 1, "output": 2 + k} for k in range(2)]
def colored(r, g, b):
    return {"doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1], "metallicFactor": 0, "roughnessFactor": 1}}
def accessor(offset, count, kind, **more):
    return {"bufferView": 0, "byteOffset": offset, "componentType": 5126, "count": count, "type": kind, **more}
json.dump({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"mesh": 0, "translation": [0, 0, -2], "scale": [5, 5, 1]},
              {"mesh": 1, "scale": [2.5, 2.5, 1]}, {"camera": 0}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5, "material": 0}]},
               {"primitives": [{"attributes": {"POSITION": 4, "COLOR_0": 5}, "indices": 6, "material": 1}]}],
    "materials": [colored(0.6, 0.5, 0.4), colored(1, 0.9, 0.8)],
    "animations": [{"channels": paths, "samplers": samplers}],
    "accessors": [accessor(0, 4, "VEC3", min=[-1, -1, 0], max=[1, 1, 0]), accessor(48, 2, "SCALAR", min=[0], max=[2]),
                  accessor(56, 2, "VEC3"), accessor(80, 2, "VEC3"),
                  accessor(104, 625, "VEC3", min=[-1, -1, 0], max=[1, 1, 0]), accessor(7604, 625, "VEC3"),
                  {"bufferView": 0, "byteOffset": 15104, "componentType": 5123, "count": 3456, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
    "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]},
    open("walk.gltf", "w"))
END
size="--no-ground --resolution 96x72 --quiet --spp"
walk="--animate 0.4:0.82 --fps 16.666666666666668 $size 2"
check all "$VELO" render walk.gltf $walk -t 2 -o f%d.pfm --denoise c%d.pfm
check all_frames test "$(ls f*.pfm c*.pfm | wc -l)" = 14
check raw "$VELO" render walk.gltf $walk --frames 5 -o r%d.pfm
same raw_same f5.pfm r5.pfm
check part "$VELO" render walk.gltf $walk --frames 0-6:3 -t 1 -o p%d.pfm --denoise d%d.pfm
for n in 0 3 6; do
  same "part_${n}_same" d$n.pfm c$n.pfm
  same "part_raw_${n}_same" p$n.pfm f$n.pfm
done
cp c6.pfm kept.pfm
rm c6.pfm
check skip "$VELO" render walk.gltf $walk -o f%d.pfm --denoise c%d.pfm --skip-existing
same skip_same c6.pfm kept.pfm

check features "$VELO" render walk.gltf --at 0.76 $size 2 -o e6.exr --channels error,features
check one "$VELO" image denoise e6.exr -o n6.pfm
check truth "$VELO" render walk.gltf --at 0.76 $size 1024 -o t6.pfm
check nearer below "$(mse c6.pfm t6.pfm)" "$(mse n6.pfm t6.pfm)" 0.8
check shutter "$VELO" render walk.gltf $walk --frames 2 --shutter 0.05 -o s%d.pfm --denoise sc%d.pfm
expect_code 2 oidn "$VELO" render walk.gltf $walk -o f%d.pfm --denoise c%d.pfm --denoiser oidn
expect_text oidn_says "--animate goes with velo's own denoiser"
finish
