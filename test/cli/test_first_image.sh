#!/usr/bin/env bash
# The image of a model without further options: lamps of any strength, closed rooms, a PNG by default, transparency.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
expect_absent() {
  case "$out$err" in
    *"$2"*) fail "$1 ('$2' is in the output)" ;;
    *) pass "$1" ;;
  esac
}
python3 - <<'END'
import json, struct
def box(a, b, inward=False):
    v = [tuple((b if i >> k & 1 else a)[k] for k in range(3)) for i in range(8)]
    t = [(4,5,7),(4,7,6),(1,0,2),(1,2,3),(5,1,3),(5,3,7),(0,4,6),(0,6,2),(6,7,3),(6,3,2),(0,1,5),(0,5,4)]
    return v, [x[::-1] for x in t] if inward else t
def write(path, parts, light=None, glass=False, eye=None):
    data, views, accessors, meshes, materials, nodes = b"", [], [], [], [], []
    for (v, t), color, two in parts:
        for values, kind, name in ((v, "f", "VEC3"), (t, "I", "SCALAR")):
            part = b"".join(struct.pack("<3" + kind, *x) for x in values)
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
            accessors.append({"bufferView": len(views) - 1, "componentType": 5126 if kind == "f" else 5125,
                              "count": len(values) * (1 if kind == "f" else 3), "type": name})
            data += part
        k = len(meshes)
        meshes.append({"primitives": [{"attributes": {"POSITION": 2 * k}, "indices": 2 * k + 1, "material": k}]})
        materials.append({"doubleSided": two, "pbrMetallicRoughness": {
            "baseColorFactor": color[:3] + [1], "metallicFactor": 0, "roughnessFactor": 0 if glass else 0.6}})
        if len(color) > 3: materials[-1]["emissiveFactor"] = color[3][:3]
        if len(color) > 3 and len(color[3]) > 3:
            materials[-1]["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": color[3][3]}}
        if glass: materials[-1]["extensions"] = {"KHR_materials_transmission": {"transmissionFactor": 1}}
        nodes.append({"mesh": k})
    g = {"asset": {"version": "2.0"}, "scene": 0, "buffers": [{"byteLength": len(data)}], "bufferViews": views,
         "accessors": accessors, "meshes": meshes, "materials": materials}
    if glass: g["extensionsUsed"] = ["KHR_materials_transmission"]
    if eye:
        g["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.9, "aspectRatio": 1.5, "znear": 0.01}}]
        nodes.append({"camera": 0, "translation": eye})
    if light:
        g["extensionsUsed"] = ["KHR_lights_punctual"]
        g["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
        nodes.append({"translation": [0.5, 3, 2], "rotation": [-0.45, 0.25, 0.12, 0.85],
                      "extensions": {"KHR_lights_punctual": {"light": 0}}})
    g["nodes"], g["scenes"] = nodes, [{"nodes": list(range(len(nodes)))}]
    text = json.dumps(g).encode()
    text += b" " * (-len(text) % 4)
    open(path, "wb").write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) +
                           struct.pack("<I4s", len(text), b"JSON") + text +
                           struct.pack("<I4s", len(data), b"BIN\0") + data)
black = (box((-1, 0, -1), (1, 2, 1)), [0, 0, 0, [1, 1, 1, 1000]], True)
write("lantern.glb", [black])
write("ember.glb", [(black[0], [0, 0, 0, [0.05, 0.01, 0]], True)])
write("away.glb", [black], eye=[0, 1, -9])
navy = [0.01, 0.015, 0.08]
sofa = [(box((-1, 0.2, -0.4), (1, 0.5, 0.4)), navy, True), (box((-1, 0.5, -0.4), (1, 1, -0.2)), navy, True)]
white = [(box((-1, 0, -1), (1, 2, 1)), [0.8, 0.8, 0.8], True)]
write("plain.glb", sofa)
chalk = [0.95, 0.95, 0.95]
write("snow.glb", [(box((-40, -1, -40), (40, 0, 40)), chalk, True), (box((-1, 0, -1), (1, 1, 1)), chalk, True)])
write("slope.glb", [(box((-40, -1, -40), (40, 0, 40)), navy, True), (box((-1, 0, -1), (1, 1, 1)), chalk, True)])
write("white.glb", white)
for name, kind, strength in (("sun", "directional", 6830), ("noon", "directional", 100000), ("dim", "point", 0.1)):
    write(name + ".glb", sofa, {"type": kind, "intensity": strength})
write("glass.glb", white, glass=True)
write("glass_sun.glb", white, {"type": "directional", "intensity": 6830}, True)
write("white_sun.glb", white, {"type": "directional", "intensity": 6830})
ball = (box((-0.3, 0.7, -0.3), (0.3, 1.3, 0.3)), [0.6, 0.05, 0.04], False)
for name, inward, two in (("room", True, False), ("box", False, True)):
    write(name + ".glb", [(box((-2, 0, -2), (2, 2.5, 2), inward), [0.8, 0.78, 0.7], two), ball])
# Rooms with a camera inside: closed; with a ceiling that emits light; without a ceiling. A street under a roof, with a red lamp.
walls = box((-2, 0, -2), (2, 2.5, 2), True)
write("inside.glb", [(walls, [0.8, 0.78, 0.7], False), ball], eye=[0, 1.4, 1.9])
glow = [0.5, 0.5, 0.5, [1, 1, 1]]
write("glow.glb", [(walls, [0.8, 0.78, 0.7], False), ball, (box((-1, 2.4, -1), (1, 2.45, 1)), glow, True)], eye=[0, 1.4, 1.9])
open_top = (walls[0], [t for t in walls[1] if any(walls[0][i][1] < 2 for i in t)])
write("open.glb", [(open_top, [0.8, 0.78, 0.7], True), ball], eye=[0, 1.4, 1.9])
street = [(box((x, 0, z), (x + 4, 6 + z % 3, z + 4)), [0.4, 0.4, 0.45], True) for x in (-6, 2) for z in range(-25, 20, 5)]
red = [0, 0, 0, [1, 0, 0]]
write("city.glb", street + [(box((-30, -1, -30), (30, 20, 30), True), [0.3, 0.5, 0.9], False), (box((1.2, 2, 4), (1.4, 2.2, 4.2)), red, True)],
      eye=[0, 1.5, 15])
# The same with strong signs, which the camera's street has nothing of.
signs = [(box((20, 1, z), (21, 4, z + 2)), red[:3] + [[1, 0.1, 0.1, 100]], True) for z in range(-20, 20, 5)]
back = [(box((9, -1, -30), (9.5, 20, 30)), [0.4, 0.4, 0.45], True)]
write("signs.glb", street + signs + back + [(box((-30, -1, -30), (30, 20, 30), True), [0.3, 0.5, 0.9], False)], eye=[0, 1.5, 15])
END
small="--resolution 64x48 --spp 16"
for m in plain white sun noon dim white_sun room box; do
  check "renders_$m" "$VELO" render $m.glb $small --transparent
done
check kept "$VELO" render room.glb $small --transparent --walls keep -o kept.png
expect_absent kept_says "hidden"
check closed "$VELO" render room.glb $small -o room.exr
expect_text closed_says 'the model is closed: 6 of its faces, on the camera'
[ -f plain.png ] && [ ! -f plain.exr ] && pass png_by_default || fail png_by_default
check with_channels "$VELO" render plain.glb $small --channels Z --quiet
[ -f plain.exr ] && pass exr_for_channels || fail exr_for_channels
check decisions "$VELO" render sun.glb $small -v -o decisions.png
expect_text decisions_camera 'camera: from the front'
expect_text decisions_light "light: the file's lamps give 6"
expect_text decisions_ground 'ground: under the model'
expect_text decisions_exposure 'exposure: white has'
check switched "$VELO" render sun.glb $small -v --no-ground --framing front --exposure -10 --environment none -o switched.png
expect_text switched_camera 'from the front, as asked'
for word in 'ground:' 'light:' 'exposure:'; do expect_absent "switched_${word%:}" "$word"; done
# A white thing on a white plain is made darker; on a dark one it stays as it is.
check snow "$VELO" render snow.glb $small -o snow.png
expect_text snow_is_darker 'exposed by -'
check slope "$VELO" render slope.glb $small -o slope.png
expect_absent slope_stays 'exposed by'
# What one sees through does not set the exposure, unless there is nothing else and the file has lamps.
check glass "$VELO" render glass.glb $small -o glass.png
expect_absent glass_as_it_is 'exposed by'
check glass_sun "$VELO" render glass_sun.glb $small -o glass_sun.png
expect_text glass_in_the_sun 'exposed by -'
# A model that only emits light is made darker where it is burnt out, and never brighter.
check lantern "$VELO" render lantern.glb $small -o lantern.png
expect_text lantern_darker 'exposed by -10'
check ember "$VELO" render ember.glb $small -o ember.png
expect_absent ember_as_it_is 'exposed by'
expect_absent ember_is_seen 'nothing of the model'
check away "$VELO" render away.glb $small -o away.png
expect_text away_is_told 'nothing of the model is seen'
# A model that encloses its own camera is lit by lamps, if nothing else lights it; the option says so, and repeats it.
for m in inside city signs; do
  check "lit_$m" "$VELO" render $m.glb $small -o $m.png -o $m.exr
  expect_text "lit_${m}_says" 'lamps are added around its camera'
  check "lit_${m}_given" "$VELO" render $m.glb $small --environment lamps -o given.exr --quiet
  same "lit_${m}_same" $m.exr given.exr
  check "lit_${m}_again" "$VELO" render --again $m.exr -o again.exr
  expect_absent "lit_${m}_again_given" 'lamps are added'
  same "lit_${m}_again_same" $m.exr again.exr
done
# The small renders by which light and exposure are chosen have at most a fifth of the rays of the image.
for m in inside city signs; do
  check "rays_$m" "$VELO" render $m.glb --resolution 160x120 -v -o rays.png
  python3 - "$out$err" <<'END' && pass "rays_${m}_few" || fail "rays_${m}_few"
import re, sys
small = [int(n) for n in re.findall(r"pixels, (\d+) rays", sys.argv[1])]
number, unit = re.search(r"([0-9.]+) ([kM]?) ?rays; wrote", sys.argv[1]).groups()
whole = float(number) * {"": 1, "k": 1e3, "M": 1e6}[unit]
print(small, whole)
sys.exit(not (len(small) == 2 and sum(small) <= 0.2 * whole))
END
done
for m in glow open; do
  check "own_light_$m" "$VELO" render $m.glb $small -o $m.png
  expect_absent "own_light_${m}_says" 'lamps are added'
done
check dark "$VELO" render inside.glb $small --environment studio -o dark.png
expect_absent dark_says 'lamps are added'
# A turned camera stands as near as the model asks for, not as its ground does.
# A stray part moves neither it nor what it turns about.
printf 'o box\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n' >alone.obj
{ cat alone.obj; printf 'v 900 0 0\nv 900.01 0 0\nv 900 0.01 0\nf 6 7 8\n'; } >stray.obj
for model in alone stray; do
  check turned_$model "$VELO" render $model.obj --resolution 32x24 --turn 90 --dry-run
  printf '%s' "$err" | grep -o 'eye ([^)]*), lookat ([^)]*)' >$model.eye
done
check turned_eye grep -q eye alone.eye
check turned_stray_same cmp alone.eye stray.eye
check turned "$VELO" render white.glb $small --turn 90 --transparent -o turned.png --quiet
expect_code 2 bad_framing "$VELO" render sun.glb --framing above
check jpeg_warns "$VELO" render plain.glb $small --transparent -o plain.jpg
expect_text jpeg_warns_says 'cannot hold alpha'
check shadows "$VELO" render white.glb $small --spp 64 -o shadows.png --quiet
check no_ground "$VELO" render white.glb $small --spp 64 --no-ground -o floating.png --quiet
check up_z "$VELO" render plain.glb $small --up z --quiet -o up_z.png
check premultiplied "$VELO" render white.glb $small --transparent --quiet -o white.exr
"$VELO" image convert white.exr white.pfm >/dev/null
python3 - <<'END' && pass images || fail images
import struct, sys, zlib
def read(name):  # PNG of 8 bits: rows of pixels
    data, at, idat = open(name, "rb").read(), 8, b""
    while at < len(data):
        n, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR": w, h, bits, color = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT": idat += data[at + 8:at + 8 + n]
        at += 12 + n
    k, raw, rows, before = {2: 3, 6: 4}[color], zlib.decompress(idat), [], None
    for y in range(h):
        kind, row = raw[y * (w * k + 1)], bytearray(raw[y * (w * k + 1) + 1:(y + 1) * (w * k + 1)])
        for i in range(len(row)):
            a = row[i - k] if i >= k else 0
            b = before[i] if before else 0
            c = before[i - k] if before and i >= k else 0
            p = a + b - c
            near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + [0, a, b, (a + b) // 2, near][kind]) & 255
        rows.append([tuple(row[i:i + k]) for i in range(0, len(row), k)])
        before = row
    return rows
def model(name):
    pixels = [p for row in read(name) for p in row if p[3] == 255]
    return [sum(p[c] for p in pixels) / len(pixels) for c in range(3)], len(pixels)
bad = []
plain, count = model("plain.png")
everything = [p for row in read("plain.png") for p in row]
if not 0.1 < count / len(everything) < 0.7 or not sum(p[3] == 0 for p in everything) > 0.2 * len(everything):
    bad.append("alpha")
for name in ("sun", "noon", "dim"):  # navy stays navy in any light
    c, _ = model(name + ".png")
    print(name, c, plain)
    if not (c[2] > 1.5 * c[0] and 0.5 * plain[2] < c[2] < 1.6 * plain[2]): bad.append(name)
for name in ("white", "white_sun"):  # and white white
    c, _ = model(name + ".png")
    print(name, c)
    if not 150 < c[1] < 250: bad.append(name)
for name in ("room", "box"):
    c, _ = model(name + ".png")
    print(name, c)
    if not 100 < c[1] < 250: bad.append(name)
c, _ = model("kept.png")
print("kept", c)
if not c[1] < 30: bad.append("kept")  # nothing lights it
for name in ("inside", "city", "signs"):
    pixels = [p for row in read(name + ".png") for p in row]
    mean = sum(sum(p[:3]) for p in pixels) / 3 / len(pixels)
    dark, burnt = (sum(f(p) for p in pixels) / len(pixels) for f in (lambda p: max(p) < 20, lambda p: min(p) > 250))
    print(name, mean, dark, burnt)
    if not (70 < mean < 220 and dark < 0.1 and burnt < 0.1): bad.append(name)
if sum(sum(p) for row in read("dark.png") for p in row): bad.append("dark")
_, count = model("turned.png")
print("turned", count)
if not count > 300: bad.append("turned")  # of 3072 pixels
def darkest(name):  # of the ground beside the box's foot
    row = read(name)[44]
    return min(sum(p) for p in row)
print(darkest("shadows.png"), darkest("floating.png"))
if not darkest("shadows.png") < 0.9 * darkest("floating.png"): bad.append("shadow")
head, size, scale, data = open("white.pfm", "rb").read().split(b"\n", 3)
if any(data[:12]) or not any(data): bad.append("premultiplied")  # the corner is background
print(bad)
sys.exit(len(bad))
END

# What was chosen is in the receipt's command, with numbers that read back as the same bits: the command makes the same image
# and chooses nothing again.
for m in plain sun dim room box "plain --framing front" "plain --up z --environment-rotation 30" "sun --ground" "room --walls keep" \
    "plain --environment sky" "plain --no-ground" "plain --framing 190,20" "plain --ground-radius 1 --environment-rotation 0.3rad"; do
  name=chosen_${m//[ .,]/_}
  read -r -a words <<<"$m"
  check "$name" "$VELO" render "${words[0]}.glb" "${words[@]:1}" --resolution 48x36 --spp 2 --quiet -o first.exr
  "$VELO" image info first.exr >first.txt
  read -r -a words < <(sed -n 's/^  command  *velo render //p' first.txt)
  case "${words[*]}" in
    *'--framing '*,*'--walls '*'--up '*) pass "${name}_is_told" ;;
    *) fail "${name}_is_told" ;;
  esac
  check "${name}_repeats" "$VELO" render "${words[@]}" --strict-options --quiet -o second.exr
  same "${name}_same" first.exr second.exr
  check "${name}_again" "$VELO" render --again first.exr --quiet -o second.exr
  same "${name}_again_same" first.exr second.exr
done
finish
