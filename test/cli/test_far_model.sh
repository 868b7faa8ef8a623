#!/usr/bin/env bash
# Models in the coordinates of a survey: their images are those of the same models at the origin.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
python3 - <<'END'
import json, math, struct
n, v, f = 24, [], []
for r in range(n + 1):  # a bumpy ball, of which single precision leaves nothing far away
    for c in range(n):
        t, p = math.pi * (r + 0.5) / (n + 1), 2 * math.pi * c / n
        s = 0.5 + 0.05 * math.sin(5 * t) * math.cos(4 * p)
        v.append((s * math.sin(t) * math.cos(p), s * math.cos(t), s * math.sin(t) * math.sin(p)))
for r in range(n):
    for c in range(n):
        a, b = r * n + c, r * n + (c + 1) % n
        f += [(a, b, a + n), (b, b + n, a + n)]
def write(name, o):
    at = ["%.6f %.6f %.6f" % tuple(x + y for x, y in zip(p, o)) for p in v]
    with open(name + ".obj", "w") as out:
        out.write("".join("v %s\n" % p for p in at) + "".join("f %d %d %d\n" % tuple(i + 1 for i in t) for t in f))
    rows = "".join(p + "\n" for p in at) + "".join("3 %d %d %d\n" % t for t in f)
    with open(name + ".off", "w") as out:
        out.write("OFF\n%d %d 0\n%s" % (len(v), len(f), rows))
    head = ("ply\nformat %s 1.0\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\n"
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n")
    with open(name + "_text.ply", "w") as out:
        out.write(head % ("ascii", len(v), len(f)) + rows)
    with open(name + ".ply", "wb") as out:
        out.write((head % ("binary_little_endian", len(v), len(f))).encode())
        out.write(b"".join(struct.pack("<3d", *(round(x + y, 6) for x, y in zip(p, o))) for p in v))
        out.write(b"".join(struct.pack("<B3i", 3, *t) for t in f))
    with open(name + ".stl", "w") as out:
        out.write("solid ball\n")
        for t in f:
            out.write("facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n" % "".join("vertex %s\n" % at[i] for i in t))
        out.write("endsolid\n")
    data = b"".join(struct.pack("<3f", *p) for p in v) + b"".join(struct.pack("<3I", *t) for t in f)
    json.dump({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "translation": o}],
               "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
               "buffers": [{"byteLength": len(data), "uri": "ball.bin"}],
               "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 12 * len(v)},
                               {"buffer": 0, "byteOffset": 12 * len(v), "byteLength": 12 * len(f)}],
               "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(v), "type": "VEC3"},
                             {"bufferView": 1, "componentType": 5125, "count": 3 * len(f), "type": "SCALAR"}]},
              open(name + ".gltf", "w"))
    open("ball.bin", "wb").write(data)
write("near", (0, 0, 0))
write("far", (500000.25, 200.5, 5400000.75))
END
expect_absent() {
  case "$out$err" in
    *"$2"*) fail "$1 ('$2' is in the output)" ;;
    *) pass "$1" ;;
  esac
}
# Equal images: $1 name, $2 and $3 files.
equal() {
  check "$1" "$VELO" image diff "$2" "$3" --threshold flip=0.02
}
small="--resolution 96x72"
for file in .obj .off _text.ply .ply .stl .gltf; do
  check "near$file" "$VELO" render near$file $small -o near.png
  expect_absent "near${file}_stays" 'rendered about'
  check "far$file" "$VELO" render far$file $small -o far.png
  expect_text "far${file}_says" 'from the origin: it is rendered about (500000, '
  equal "same$file" near.png far.png
done
check turned_near "$VELO" render near.obj $small --turn 40 -o near.png --quiet
check turned_far "$VELO" render far.obj $small --turn 40 -o far.png --quiet
equal turned_same near.png far.png
for name in near far; do
  check film_$name "$VELO" render $name.obj --resolution 32x24 --turntable 3 -o $name%d.png --quiet
done
equal film_same near2.png far2.png
# Data keep the file's coordinates, and a note says what that costs.
check data "$VELO" render far.obj --resolution 16x12 --spp 1 --channels P -o far.exr
expect_text data_says 'its positions are rounded to about 0.3'
check positions "$VELO" image info far.exr
grep -q 'worldFromCamera .* 54000' <<<"$out" && pass data_stays || fail data_stays
# The scene has the file's coordinates, to the last of their digits.
check converted "$VELO" scene convert far.obj far.pbrt
grep -q '5400001' far.pbrt && pass converted_place || fail converted_place
finish
