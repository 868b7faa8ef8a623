#!/usr/bin/env bash
# Ground truth beside the image: names, types, the file of ids, the proof that it agrees; what is refused.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
check render "$VELO" render scene.pbrt -o all.exr --channels all --quiet
check render_plain "$VELO" render scene.pbrt -o plain.exr --quiet
check image_is_untouched "$VELO" image diff plain.exr all.exr --threshold differing=0
check agrees "$VELO" image check all.exr
check agrees_tighter "$VELO" image check all.exr --threshold 3e-7
expect_code 1 too_tight "$VELO" image check all.exr --threshold 1e-12
expect_code 3 nothing_to_check "$VELO" image check plain.exr
check render_crop_half "$VELO" render scene.pbrt -o crop.exr --channels all --quiet --crop 9,5,50,40 --half -t 1
check crop_agrees "$VELO" image check crop.exr
check render_few "$VELO" render scene.pbrt -o few.exr --channels Z,P --quiet
check few_agree "$VELO" image check few.exr
# An attribute of a known name but of another type is no text.
sed 's/velo\.filter\x00string/velo.filter\x00double/' all.exr >typed.exr
check typed_differs bash -c '! cmp -s all.exr typed.exr'
check typed_agrees "$VELO" image check typed.exr
check few_have_no_ids test ! -e few.exr.ids.json
check render_again "$VELO" render scene.pbrt -o again.exr --channels all --quiet -t 3
same same_bytes all.exr again.exr
sed 's/Camera "perspective".*/Camera "orthographic" "float screenwindow" [-2 2 -1.5 1.5]/' scene.pbrt >flat.pbrt
check render_orthographic "$VELO" render flat.pbrt -o flat.exr --channels all --quiet
check orthographic_agrees "$VELO" image check flat.exr

# Every projection and lens, cropped too: the header alone is enough to know the camera.
for file in "$VELO_SOURCE_DIR"/scenes/cameras/*.pbrt; do
  [ -e "$file" ] && grep -q '^Camera' "$file" || continue
  name=$(basename "$file" .pbrt)
  check "render_$name" "$VELO" render "$file" -o lens.exr --channels all --quiet --spp 1 --max-depth 0 --resolution 96x72 --crop 7,3,90,70
  check "${name}_agrees" "$VELO" image check lens.exr
done


# Illuminance: the same bytes for any threads,.
for threads in 1 3; do
  check "illuminance_$threads" "$VELO" render scene.pbrt -o "lux$threads.exr" --channels illuminance --quiet --spp 2 -t "$threads"
done
check illuminance_threads cmp lux1.exr lux3.exr
check illuminance_there bash -c '"$VELO" image info lux1.exr | grep -q illuminance.Y'

expect_code 2 unknown_name "$VELO" render scene.pbrt -o no.exr --channels Z,albdo
expect_text nearest_name 'unknown name "albdo"; did you mean "albedo"?'
check nothing_written test ! -e no.exr
expect_code 2 empty_name "$VELO" render scene.pbrt -o no.exr --channels ''
check other_formats_go_on "$VELO" render scene.pbrt -o image.png --channels Z --quiet
expect_text other_formats_warn 'warning: --channels: image.png cannot hold them'

"$VELO" image info --json all.exr >all.json
"$VELO" image info --json crop.exr >crop.json
cat >layout.py <<'CODE'
import json

for name in ("all", "crop"):
    info = json.load(open(name + ".json"))
    types = dict(zip(info["channels"], info.get("types") or [info["type"]] * len(info["channels"])))
    assert len(types) == 30, types
    for channel, kind in types.items():
        if channel.startswith("id.") or channel.startswith("samples"):
            assert channel.endswith(".Y"), channel
        half = name == "crop" and len(channel) == 1 and channel != "Z"
        assert kind == ("16-bit float" if half else "32-bit float"), (name, channel, kind)
ids = json.load(open("all.exr.ids.json"))
assert ids["image"] == "all.exr"
kinds = sorted(o["type"] for o in ids["objects"].values())
assert kinds == ["bilinear", "sphere", "sphere"], kinds
lines = open("scene.pbrt").read().splitlines()
for o in ids["objects"].values():
    assert o["file"] == "scene.pbrt"
    assert lines[o["line"] - 1][o["column"] - 1:].startswith("Shape"), o
    assert str(o["material"]) in ids["materials"], o
assert sorted(m["type"] for m in ids["materials"].values()) == ["conductor", "dielectric", "diffuse"]
CODE
check types_and_ids python3 layout.py

# An independent reader finds the same, and P times worldToNDC is the pixel.
if command -v oiiotool >/dev/null; then
  oiiotool --info -v all.exr >oiio.txt 2>&1
  check oiio_types grep -q 'float openexr' oiio.txt
  check oiio_names grep -q 'id.object.Y' oiio.txt
  # An integer beside floats would be shown as a share of 2^32.
  oiiotool all.exr --ch id.object.Y --printstats >ids.txt
  check oiio_shows_ids grep -Eq 'Max: [1-9]' ids.txt
  oiiotool all.exr --ch Z,P.X,P.Y,P.Z -o zp.exr
  oiiotool --info --dumpdata zp.exr >dump.txt # 9 decimals
  cat >ndc.py <<'CODE'
import json, math, re

m = json.load(open("all.json"))["attributes"]["worldToNDC"]
hits = 0
for line in open("dump.txt"):
    found = re.match(r"\s*Pixel \((\d+), (\d+)\): (.*)", line)
    if not found:
        continue
    x, y, (z, *p) = int(found[1]), int(found[2]), [float(v) for v in found[3].split()[:4]]
    if math.isinf(z):
        continue
    hits += 1
    q = [sum(v * m[4 * row + column] for row, v in enumerate((*p, 1))) for column in range(4)]
    assert abs(q[0] / q[3] * 64 - (x + 0.5)) < 1e-4 and abs(q[1] / q[3] * 48 - (y + 0.5)) < 1e-4, (x, y, p, q)
    assert abs(q[3] - z) < 1e-5, (q[3], z)
assert hits > 1000, hits
CODE
  check oiio_ndc python3 ndc.py
else
  skip oiio "oiiotool is not installed"
fi
finish
