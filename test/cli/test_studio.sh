#!/usr/bin/env bash
# The studios; the ground of models with a camera of their own; scenes that their own surfaces light.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
# write_model FILE EYE_X EYE_Y EYE_Z PITCH EMISSION: two squares on top of each other, the upper one with that emission
# strength, and a camera that looks along -z, turned down by PITCH degrees; PITCH none: no camera.
write_model() {
  python3 - "$@" <<'END'
import base64, json, math, struct, sys
path, eye, pitch, strength = sys.argv[1], [float(x) for x in sys.argv[2:5]], sys.argv[5], float(sys.argv[6])
data = struct.pack("<12f", -1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0, 1)
nodes = [{"mesh": 0}, {"mesh": 1, "translation": [0, 2, 0], "rotation": [1, 0, 0, 0]}]
scene = {"asset": {"version": "2.0"}, "scene": 0, "nodes": nodes,
  "extensionsUsed": ["KHR_materials_emissive_strength"],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5, "material": m}]} for m in (0, 1)],
  "materials": [{"doubleSided": True}, {"doubleSided": True, "emissiveFactor": [1, 1, 1],
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 0, 1]}],
  "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
  "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
if pitch != "none":
    half = -math.radians(float(pitch)) / 2
    nodes.append({"camera": 0, "translation": eye, "rotation": [math.sin(half), 0, 0, math.cos(half)]})
    scene["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}]
scene["scenes"] = [{"nodes": list(range(len(nodes)))}]
json.dump(scene, open(path, "w"))
END
}
options="--resolution 48x36 --spp 4 --tracer path -v"
has_ground() { grep -q 'ground: under the model' <<<"$err"; }
has_studio() { grep -q 'light: the studio' <<<"$err"; }

# ---- the ground ------------------------------------------------------------------------------------------------------
write_model above.gltf 0 3 7 20 0.5
write_model below.gltf 0 -3 7 -20 0.5
write_model inside.gltf 0 1 0 20 0.5
run "$VELO" render above.gltf $options -o above.exr
if has_ground; then pass ground_of_own_camera; else fail ground_of_own_camera; show render; fi
for other in below inside; do
  run "$VELO" render $other.gltf $options -o $other.exr
  if has_ground; then fail "no_ground_$other"; else pass "no_ground_$other"; fi
done
run "$VELO" render above.gltf $options -o truth.exr --channels Z
if has_ground; then fail no_ground_in_ground_truth; else pass no_ground_in_ground_truth; fi
run "$VELO" render above.gltf $options -o none.exr --no-ground
if has_ground; then fail no_ground_asked; else pass no_ground_asked; fi
case $err in *'no effect'*) fail no_ground_has_effect ;; *) pass no_ground_has_effect ;; esac
expect_code 1 ground_is_seen "$VELO" image diff above.exr none.exr --threshold differing=0
printf '{"width": 48, "height": 36, "fov": 40, "eye": [0, 3, 7], "lookat": [0, 0, 0]}' >other.json
run "$VELO" render above.gltf $options -o camera.exr --camera other.json
if [ "$code" = 0 ] && has_ground; then fail no_ground_of_other_cameras; else pass no_ground_of_other_cameras; fi
check again "$VELO" render --again above.exr -o again.exr --quiet
same again_same above.exr again.exr

# ---- light of the scene's own ----------------------------------------------------------------------------------------
run "$VELO" render above.gltf $options -o display.exr
if has_studio; then pass display_gets_a_studio; else fail display_gets_a_studio; fi
write_model lamp.gltf 0 3 7 20 20
run "$VELO" render lamp.gltf $options -o lamp.exr
if has_studio || has_ground; then fail lamp_gets_none; else pass lamp_gets_none; fi
check none_the_same "$VELO" render lamp.gltf $options -o asked.exr --environment none
check none_is_the_same "$VELO" image diff lamp.exr asked.exr --threshold differing=0
write_model model.gltf 0 0 0 none 20
run "$VELO" render model.gltf $options -o model.exr
if has_studio; then pass model_gets_a_studio; else fail model_gets_a_studio; fi

# ---- the three -------------------------------------------------------------------------------------------------------
for name in studio window evening; do
  check "$name" "$VELO" render above.gltf --resolution 48x36 --spp 4 -o $name.exr --environment $name --quiet
  check "again_$name" "$VELO" render --again $name.exr -o again.exr --quiet
  same "again_${name}_same" $name.exr again.exr
done
expect_code 1 differ_1 "$VELO" image diff studio.exr window.exr --threshold differing=0
expect_code 1 differ_2 "$VELO" image diff window.exr evening.exr --threshold differing=0
expect_code 4 unknown "$VELO" render above.gltf --environment windov -o unknown.exr
finish
