#!/usr/bin/env bash
# velo camera paths: its JSON has the documented fields, its sums are those of the rendered image, the order of the paths,
# the text, wrong calls.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
check json "$VELO" camera paths scene.pbrt --pixel 40,30 --samples 16 --spp 16 --show 200 --json
printf '%s' "$out" >paths.json
check image "$VELO" render scene.pbrt --spp 16 --crop 40,30,41,31 --quiet -o pixel.pfm
cat >look.py <<'CODE'
import json, struct
r = json.load(open("paths.json"))
assert r["pixel"] == [40, 30] and r["tracer"] == "path" and r["samples"] == 16 and r["dropped"] == 0
assert 72 <= r["counted"] == len(r["paths"]) <= 144  # with those of the pixels around
assert sorted(p["sample"] for p in r["paths"] if p["pixel"] == [40, 30]) == list(range(16))
for p in r["paths"]:
    assert all(abs(a - b) <= 1 and 0 <= x - a < 1 for a, b, x in zip(p["pixel"], r["pixel"], p["film"])), (p["pixel"], p["film"])
seen = r["sees"]
assert seen["object"]["id"] == seen["object"]["id"] > 0 and seen["material"]["type"]
for key in ("depth", "distance", "position", "normal", "shading", "uv", "albedo", "primitive"):
    assert key in seen, key
assert [p["share"] for p in r["paths"]] == sorted((p["share"] for p in r["paths"]), reverse=True)
assert abs(sum(p["share"] for p in r["paths"]) - 1) < 1e-6
textures = set()
for p in r["paths"]:
    assert len(p["lambda"]) == 4 and p["vertices"]
    for k in range(4):  # radiance: the sum of the contributions
        s = sum(c["radiance"][k] for c in p["contributions"])
        assert abs(s - p["radiance"][k]) <= 1e-6 * abs(s) + 1e-12
    for c in p["contributions"]:
        assert c["event"] in ("sampled", "hit", "sky", "medium") and 0 <= c["weight"] <= 1.00001
        assert 0 <= c["vertex"] < len(p["vertices"])
    for v in p["vertices"]:
        assert v["event"] in ("surface", "medium", "exit", "nothing")
        assert v["fate"] in ("on", "left", "absorbed", "roulette", "depth")
        textures.add(v.get("texture"))
        if v["fate"] == "on": assert v["pdf"] > 0 and len(v["direction"]) == 3 and v["bsdf"]
assert "checkerboard" in textures, textures
data = open("pixel.pfm", "rb").read()
rgb = struct.unpack("<3f", data[-12:])
for a, b in zip(rgb, r["mean"]):
    assert abs(a - b) <= 1e-6 * abs(b) + 1e-9, (rgb, r["mean"])
CODE
check schema_and_sums python3 look.py
check text "$VELO" camera paths scene.pbrt --pixel 32,44 --samples 2
expect_text text_sees "the centre of the pixel sees object"
expect_text text_lobe "scattered by diffuse, reflected: pdf"
expect_text text_light "light sampled: "
check later "$VELO" camera paths scene.pbrt --pixel 40,30 --first 3 --samples 1 --json
expect_text later_sample '"sample": 3'
check by_sample "$VELO" camera paths scene.pbrt --pixel 40,30 --samples 64 --show 1 --sort sample
expect_text by_sample_first "sample 0:"
check rgb "$VELO" camera paths scene.pbrt --pixel 1,1 --samples 1 --color rgb --tracer volpath --json
expect_text rgb_tracer '"tracer": "volpath"'
check fisheye "$VELO" camera paths "$VELO_SOURCE_DIR/scenes/cameras/equidistant.pbrt" --pixel 0,0 --samples 1
expect_text fisheye_corner "the camera has no ray here"

expect_code 2 no_pixel "$VELO" camera paths scene.pbrt
expect_line no_pixel_words "--pixel x,y"
for wrong in 1 1, ,1 -1,2 1,2,3 1.5,2 99999,1; do expect_code 2 "pixel_$wrong" "$VELO" camera paths scene.pbrt --pixel "$wrong"; done
expect_code 2 outside "$VELO" camera paths scene.pbrt --pixel 64,0
expect_line outside_words "only 64 x 48 pixels"
expect_code 2 tracer "$VELO" camera paths scene.pbrt --pixel 1,1 --tracer sppm
expect_line tracer_words "--tracer path or --tracer volpath"
expect_code 2 none "$VELO" camera paths scene.pbrt --pixel 1,1 --samples 0
expect_code 4 missing "$VELO" camera paths none.pbrt --pixel 1,1
finish
