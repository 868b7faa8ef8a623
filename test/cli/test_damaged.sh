#!/usr/bin/env bash
# More than a hundred damaged scenes and meshes, made by seeded mutation from right ones: each that is refused is refused
# with one line that names a file, the right exit code, soon, and in little memory; none crashes or hangs. What the
# doctor says of the same file ends the same way.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene whole.pbrt
plain=0
is_plain_build && plain=1

damage() {
  python3 - "$VELO" "$1" "$plain" <<'SCRIPT'
import os, random, re, resource, struct, subprocess, sys

velo, kind, plain = sys.argv[1], sys.argv[2], sys.argv[3] == "1"
draw = random.Random({"scene": 20, "text_mesh": 21, "binary_mesh": 22}[kind])


def mesh(text):
    n = 6
    points = [(x / n, y / n, 0.1 * ((x * y) % 3), 0, 0, 1, x / n, y / n) for y in range(n + 1) for x in range(n + 1)]
    faces = [(k, k + 1, k + n + 2) for k in range(n * (n + 1)) if k % (n + 1) < n]
    faces += [(k, k + n + 2, k + n + 1) for k in range(n * (n + 1)) if k % (n + 1) < n]
    head = "ply\nformat %s 1.0\nelement vertex %d\n" % ("ascii" if text else "binary_little_endian", len(points))
    head += "".join("property float %s\n" % p for p in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    head += "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % len(faces)
    if text:
        rows = [" ".join("%g" % v for v in p) for p in points] + ["3 %d %d %d" % f for f in faces]
        return (head + "\n".join(rows) + "\n").encode()
    return head.encode() + b"".join(struct.pack("<8f", *p) for p in points) + b"".join(struct.pack("<B3i", 3, *f) for f in faces)


WORDS = [b"-1", b"nan", b"1e999", b"4294967296", b"\"", b"[", b"]", b"\0", b"#", b"Include \"damaged.pbrt\"", b"WorldBegin",
         b"AttributeEnd", b"\"float x\" [", b"ObjectBegin \"a\"", b"99999999999999999999", b"\xff\xfe", b"element vertex 2000000000\n"]


def damage(data, i):
    data = bytearray(data)
    way = i % 6
    if way == 0:  # cut off
        return bytes(data[: draw.randrange(len(data))])
    if way == 1:  # bits
        for _ in range(draw.randrange(1, 12)):
            data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    elif way == 2:  # a piece is lost
        at = draw.randrange(len(data))
        del data[at : at + draw.randrange(1, 60)]
    elif way == 3:  # a word comes in
        at = draw.randrange(len(data))
        data[at:at] = b" " + draw.choice(WORDS) + b" "
    elif way == 4:  # a number becomes another
        spans = [m.span() for m in re.finditer(rb"[0-9]+", bytes(data))]
        a, b = draw.choice(spans)
        data[a:b] = draw.choice(WORDS)
    else:  # a piece comes twice
        at = draw.randrange(len(data))
        data[at:at] = data[at : at + draw.randrange(1, 200)]
    return bytes(data)


def limits():
    if plain:  # a sanitizer reserves terabytes
        resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))


def call(*words):
    try:
        r = subprocess.run([velo, *words], stdin=subprocess.DEVNULL, capture_output=True, timeout=20 if plain else 120, preexec_fn=limits)
    except subprocess.TimeoutExpired:
        return None, ""
    return r.returncode, r.stderr.decode("utf-8", "replace") + ("" if words[0] == "render" else r.stdout.decode("utf-8", "replace"))


original = open("whole.pbrt", "rb").read() if kind == "scene" else mesh(kind == "text_mesh")
wrong, refused, made = 0, 0, 0
while refused < 40 and made < 240:
    data = damage(original, made)
    made += 1
    if kind == "scene":
        open("damaged.pbrt", "wb").write(data)
    else:
        open("damaged.ply", "wb").write(data)
        open("damaged.pbrt", "w").write('Camera "perspective"\nWorldBegin\nLightSource "infinite"\nShape "plymesh" "string filename" "damaged.ply"\n')
    code, text = call("render", "damaged.pbrt", "--quiet", "--spp", "1", "--resolution", "8x8", "-o", "damaged.exr")
    lines = [l for l in text.splitlines() if not l.startswith("velo: warning: ")]
    said = "damaged." in text or "whole" in text
    bad = code not in (0, 3, 4, 5) or (code != 0 and (len(lines) != 1 or not said)) or (code == 0 and lines)
    if code == 3 and kind == "scene" and "no WorldBegin" not in text and not re.search(r"damaged\.pbrt:[0-9]+:[0-9]+: ", text):
        bad = True
    refused += code != 0
    if made % 5 == 0 and not bad:
        answer, text = call("scene", "check", "damaged.pbrt", "--json")
        if answer not in (0, 1, 3, 4, 5) or (code in (3, 4, 5)) != (answer in (3, 4, 5)):
            bad, lines = True, ["scene check: exit code %s, render %s" % (answer, code), text]
    if bad:
        wrong += 1
        print("number %d of %s: exit code %s: %s" % (made, kind, code, " | ".join(lines)[:300]))
        os.rename("damaged.pbrt", "wrong_%s_%d.pbrt" % (kind, made))
print("%s: %d made, %d refused, %d wrong" % (kind, made, refused, wrong))
sys.exit(0 if wrong == 0 and refused >= 40 else 1)
SCRIPT
}
for kind in scene text_mesh binary_mesh; do
  check "damaged_$kind" damage "$kind"
  printf '%s\n' "$out"
done
finish
