#!/usr/bin/env bash
# Adaptive sampling, --noise: the same bytes for any threads, parts, stops and crops along blocks; what cannot go
# together is refused.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
render="$VELO render --quiet"
small="--resolution 130x70"
noise="$small --noise 2%"

check whole $render scene.pbrt $noise -o a.exr --film a.film --channels samples,error,Z
# The noisiest blocks have at least three times the samples of the cleanest, and all counts are of the schedule.
counts=$("$VELO" film info a.film | sed -n 's/^ *samples *0:\([0-9]*\) .*/\1/p' | sort -nu | tr '\n' ' ')
echo "samples: $counts"
least=${counts%% *} most=$(printf '%s' "$counts" | tr ' ' '\n' | tail -n 1)
check adapts test "$least" -ge 9 -a "$((3 * least))" -le "$most"
for count in $counts; do
  part=$count # 8 to 15 times a power of two
  while [ "$part" -gt 15 ] && [ $((part % 2)) = 0 ]; do part=$((part / 2)); done
  if [ "$part" -ge 8 ] && [ "$part" -le 15 ]; then pass "end at $count"; else fail "end at $count"; fi
done
# The channel `samples` has the numbers of the film's blocks.
"$VELO" image convert a.exr samples.pfm --channel samples.Y
cat >blocks.py <<'END'
import re, struct, subprocess, sys
velo, film, pfm = sys.argv[1:]
with open(pfm, "rb") as file:
    kind, width, height = file.readline(), *map(int, file.readline().split())
    file.readline()
    values = struct.unpack("<%df" % (width * height), file.read())
text = subprocess.run([velo, "film", "info", film], stdout=subprocess.PIPE, text=True, check=True).stdout
seen = 0
for line in text.splitlines():
    found = re.match(r" *samples *0:(\d+) of \d+, pixels (\d+),(\d+),(\d+),(\d+)", line)
    if found:
        count, x0, y0, x1, y1 = map(int, found.groups())
        for y in range(y0, y1):
            assert set(values[(height - 1 - y) * width + x0:(height - 1 - y) * width + x1]) == {count}, line
        seen += (x1 - x0) * (y1 - y0)
assert seen == width * height, seen
END
check "samples channel" python3 blocks.py "$VELO" a.film samples.pfm
check "image check" "$VELO" image check a.exr

for threads in 1 5; do
  $render scene.pbrt $noise -t $threads -o b.exr --channels samples,error,Z
  same "threads $threads" a.exr b.exr
done
for i in 1 2 3; do $render scene.pbrt $noise --shard $i/3 --shard-by tiles --film t$i.film --channels samples,error,Z; done
check merge "$VELO" film merge t3.film t1.film t2.film -o m.film
$render scene.pbrt $noise --film whole.film --channels samples,error,Z
same "shards by tiles" m.film whole.film
# what is missing: a command that goes on until the threshold
mkdir bin
ln -s "$VELO" bin/velo
"$VELO" film merge t3.film t1.film -o gap.film
check missing "$VELO" film info --missing gap.film
printf '%s\n' "$out" >missing.sh
PATH=$PWD/bin:$PATH sh missing.sh 2>missing.txt
"$VELO" film develop gap.film -o gap.pfm
"$VELO" film develop whole.film -o whole.pfm
same "what is missing is rendered by the command that info prints" gap.pfm whole.pfm
# stopped between two comparisons, and at a number at which some blocks are compared and others end by the last one
for spp in 8 9 11 12 14 16 20 24 30 32; do
  $render scene.pbrt $noise --spp $spp --film s.film --overwrite --channels samples,error,Z
  $render --continue s.film --spp 65536 -o b.exr
  same "continued from $spp" a.exr b.exr
done
# continued without more samples: the comparison at this number is not repeated, its means are those of these samples
$render scene.pbrt $noise --spp 16 --film s.film --overwrite
cp s.film t.film
check "no more samples" $render --continue s.film --spp 16
same "no more samples leave the film" s.film t.film
# another exposure has comparisons of its own
$render scene.pbrt $noise --film s.film --overwrite
before=$("$VELO" film info s.film | sed -n 's/^ *samples *0:\([0-9]*\) .*/\1/p' | sort -n | tail -n 1)
check "another exposure" $render --continue s.film --exposure 3 --spp 65536 -o b.exr
after=$("$VELO" film info s.film | sed -n 's/^ *samples *0:\([0-9]*\) .*/\1/p' | sort -n | tail -n 1)
check "a brighter view needs more samples" test "$after" -gt "$before"
# a lower threshold goes on with the film of a higher one
$render scene.pbrt $small --noise 1.5% -o finer.exr
$render scene.pbrt $noise --film s.film --overwrite
check finer $render --continue s.film --noise 1.5% --spp 65536 -o b.exr
same "a lower threshold" finer.exr b.exr
# The same film ended by its --spp: a threshold on the command line of --continue is reached, unless an --spp there limits.
$render scene.pbrt $small --noise 5% --spp 16 --time 10m --film s.film --overwrite
check "an spp of the film does not limit" $VELO render --continue s.film --noise 1.5% -o b.exr
expect_text "an spp of the film: below" 'all blocks are below the noise of 1.5 %'
same "an spp of the film: the image" finer.exr b.exr
$render scene.pbrt $small --noise 5% --spp 16 --film s.film --overwrite
check "an spp of this command limits" $VELO render --continue s.film --noise 1.5% --spp 24 -o b.exr
expect_text "an spp of this command: above" 'blocks are still above the noise of 1.5 %'
check "the command repeated with a lower threshold" $render scene.pbrt $small --noise 1.5% --film s.film -o b.exr
same "the command repeated: the image" finer.exr b.exr
# a crop along blocks has the pixels of the whole
"$VELO" image convert a.exr part.pfm --crop 32,32,96,64
$render scene.pbrt $noise --crop 32,32,96,64 -o crop.pfm
same "crop along blocks" part.pfm crop.pfm
$render scene.pbrt $noise -o plain.exr
check again $render --again plain.exr -o again.exr
same "again" plain.exr again.exr
check developed "$VELO" film develop a.film -o d.pfm
$render scene.pbrt $noise -o e.pfm
same "developed as rendered" d.pfm e.pfm
for tracer in bidirectional merging; do
  $render scene.pbrt $noise --spp 48 --tracer $tracer -o b.exr -t 1
  $render scene.pbrt $noise --spp 48 --tracer $tracer -o c.exr -t 3
  same "$tracer" b.exr c.exr
done
# --time ends before the threshold; the image is that of the samples it reached
$render scene.pbrt $small --noise 0.01% --time 0.5 -o b.exr --film time.film
reached=$("$VELO" film info time.film | sed -n 's/^ *samples *0:\([0-9]*\) .*/\1/p' | sort -n | tail -n 1)
$render scene.pbrt $small --noise 0.01% --spp "$reached" -o c.exr
same "--time" b.exr c.exr

expect_code 2 bad $VELO render scene.pbrt --noise much
expect_line bad 'must be a part of white'
expect_code 2 negative $VELO render scene.pbrt --noise -1%
expect_code 2 samples $VELO render scene.pbrt --noise 1% --samples 0:4 --film f.film
expect_line samples 'shard-by tiles'
expect_code 2 shard $VELO render scene.pbrt --noise 1% --shard 1/2 --film f.film
expect_line shard 'shard-by tiles'
expect_code 2 meter $VELO render scene.pbrt --noise 1% --exposure auto -o a.png
expect_line meter 'give --exposure EV'
run $VELO render scene.pbrt $small --noise 0.01% --spp 16 -o b.exr
expect_text still 'blocks are still above the noise of 0.01 %'
finish
