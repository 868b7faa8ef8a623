#!/usr/bin/env bash
# --filter-samples shared: the same bytes for any threads, crops, parts and stops; the same mean as own samples, with
# less noise; what the program says of it.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
render="$VELO render --quiet"
shared="--resolution 130x70 --filter-samples shared"

check whole $render scene.pbrt $shared --spp 8 -o a.pfm --film a.film
for threads in 1 5; do
  $render scene.pbrt $shared --spp 8 -t $threads -o b.pfm
  same "threads $threads" a.pfm b.pfm
done
for i in 1 2 3; do
  $render scene.pbrt $shared --spp 8 --shard $i/3 --shard-by tiles --film t$i.film
  $render scene.pbrt $shared --spp 8 --shard $i/3 --film s$i.film
done
for by in t s; do
  check "merge $by" "$VELO" film merge ${by}3.film ${by}1.film ${by}2.film -o m.film
  "$VELO" film develop m.film -o m.pfm
  same "shards $by" a.pfm m.pfm
done
$render scene.pbrt $shared --spp 3 --film c.film
check continue $render --continue c.film --spp 8 -o c.pfm
same continued a.pfm c.pfm

# A crop window has the pixels of the whole image, with the border that it needs.
cat >crop.py <<'END'
import struct, sys

def read(path):
    with open(path, "rb") as f:
        f.readline()
        w, h = map(int, f.readline().split())
        f.readline()
        v = struct.unpack("<%df" % (3 * w * h), f.read())
    return w, h, [v[3 * w * (h - 1 - y):3 * w * (h - y)] for y in range(h)]

w, h, whole = read("a.pfm")
x0, y0, x1, y1 = map(int, sys.argv[2:])
cw, ch, crop = read(sys.argv[1])
assert (cw, ch) == (x1 - x0, y1 - y0)
for y in range(ch):
    assert crop[y] == whole[y0 + y][3 * x0:3 * x1], y
END
for crop in 0,0,1,1 37,11,70,33 129,69,130,70 5,0,130,70; do
  $render scene.pbrt $shared --spp 8 --crop $crop -o crop.pfm
  check "crop $crop" python3 crop.py crop.pfm ${crop//,/ }
done

# Noise and mean, by filter: variance of own over shared samples between the bounds, means within 5 standard errors.
cat >noise.py <<'END'
import math, struct, subprocess, sys

velo, low, high, *options = sys.argv[1:]

def image(kind, seed):
    subprocess.run([velo, "render", "scene.pbrt", "--quiet", "--spp", "16", "--filter-samples", kind, "--seed", str(seed),
                    "-o", "n.pfm", *options], check=True)
    with open("n.pfm", "rb") as f:
        f.readline()
        w, h = map(int, f.readline().split())
        f.readline()
        return struct.unpack("<%df" % (3 * w * h), f.read())

SEEDS = 6
variance, mean, error = {}, {}, {}
for kind in ("own", "shared"):
    images = [image(kind, s + 1) for s in range(SEEDS)]
    n = len(images[0])
    means = [sum(p) / SEEDS for p in zip(*images)]
    each = sorted(sum((im[i] - means[i]) ** 2 for im in images) / (means[i] ** 2 + 0.01) for i in range(n))
    variance[kind] = sum(each[:n * 99 // 100])
    totals = [sum(im) / n for im in images]
    mean[kind] = sum(totals) / SEEDS
    error[kind] = math.sqrt(sum((t - mean[kind]) ** 2 for t in totals) / (SEEDS - 1) / SEEDS)
gain = variance["own"] / variance["shared"]
apart = abs(mean["own"] - mean["shared"]) / math.hypot(error["own"], error["shared"])
print("gain %.3f, means %.5f and %.5f, %.2f standard errors apart" % (gain, mean["own"], mean["shared"], apart))
assert float(low) < gain < float(high) and apart < 5, gain
END
if is_plain_build; then
  # 2.9 for unrelated samples (docs/filters.md); light points that are drawn with the film points add to it.
  check "less noise: gaussian" python3 noise.py "$VELO" 2.0 4.0 --filter gaussian
  check "less noise: triangle" python3 noise.py "$VELO" 6 14 --filter triangle
  check "less noise: bidirectional" python3 noise.py "$VELO" 1.5 3.2 --filter gaussian --tracer bidirectional --light-paths 1000
  check "as before: mitchell" python3 noise.py "$VELO" 0.9999 1.0001 --filter mitchell
  check "as before: box of a pixel" python3 noise.py "$VELO" 0.9999 1.0001 --filter box
else
  skip noise "statistics of the release build"
fi

# A constant image stays constant, up to its edges.
sed 's/^WorldBegin/WorldBegin\nLightSource "infinite" "rgb L" [1 1 1]\n#/; /^LightSource "infinite" "rgb L" \[0.2/,$d' scene.pbrt >sky.pbrt
$render sky.pbrt $shared --color rgb --spp 2 -o sky.pfm
check constant python3 -c '
import struct
data = open("sky.pfm", "rb").read()
v = struct.unpack("<%df" % (3 * 130 * 70), data[-12 * 130 * 70:])
assert max(v) - min(v) < 1e-6 and abs(v[0] - v[1]) < 1e-6 and v[0] > 0.5, (min(v), max(v))'

check noise $render scene.pbrt $shared --noise 4% --spp 64 -o n1.exr -t 1
$render scene.pbrt $shared --noise 4% --spp 64 -o n2.exr -t 3
same "adaptive, threads" n1.exr n2.exr
check reported "$VELO" render scene.pbrt --filter-samples own --dry-run
expect_text reported_words "of own samples"
check header "$VELO" image info n1.exr
expect_text header_words "velo.filterSamples"
$render scene.pbrt --resolution 130x70 --spp 8 -o default.pfm
same "the default" a.pfm default.pfm
expect_code 2 name "$VELO" render scene.pbrt --filter-samples some
expect_line name_words "own"
finish
