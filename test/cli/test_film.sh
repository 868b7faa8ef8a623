#!/usr/bin/env bash
# The film as a file: a render is stopped, killed, continued, split and merged, and gives the very bytes of the straight
# one. Files that do not belong together, and damaged ones, are refused in one line.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
render="$VELO render --quiet"
small="--resolution 70x40"

# identical NAME COMMAND...: the command succeeds and a.exr and b.exr are the same.
identical() {
  local name=$1
  shift
  if "$@" >identical.txt 2>&1 && cmp -s a.exr b.exr; then pass "$name"; else fail "$name"; sed 's/^/  | /' identical.txt; fi
}

# Continued: every tracer, with error sums, with spectra, a sampler with cells; another number of threads.
for tracer in path volpath bidirectional merging sppm lightpath randomwalk raycast ambientocclusion; do
  for more in "" "--channels error,Z" "--spectrum 4" "--sampler stratified --sequence 8"; do
    rm -f a.exr b.exr f.film
    $render scene.pbrt $small --tracer $tracer $more --spp 12 -o a.exr
    $render scene.pbrt $small --tracer $tracer $more --spp 5 --film f.film -t 1
    identical "continued: $tracer $more" $render --continue f.film --spp 12 -o b.exr -t 3
  done
done
$render scene.pbrt $small --stereo parallel --spp 6 -o a.exr
$render scene.pbrt $small --stereo parallel --spp 2 --film eye_%v.film
identical "continued: two eyes" $render --continue eye_%v.film --spp 6 -o b.exr
expect_code 4 "a name that ends with a percent sign" $render --continue eye% part%v.film
expect_text "the name is that of the option alone" "cannot read eye%:"
$render scene.pbrt $small --spp 5 -o a.exr --channels Z,N,id.object
$render scene.pbrt $small --spp 5 --film f.film --overwrite
identical "channels of a complete film" $render --continue f.film -o b.exr --channels Z,N,id.object
$render scene.pbrt $small --spp 4 --film f.film --overwrite -o own.exr
rm own.exr
$render --continue f.film --spp 6
$render scene.pbrt $small --spp 6 -o whole.exr
same "outputs are those of the film" own.exr whole.exr
rm -f asked.exr
$render scene.pbrt $small --film f.film --overwrite
[ ! -e asked.exr ] && pass "a film without -o writes no image" || fail "a film without -o writes no image"
$render scene.pbrt $small --time 0.3 --film f.film --overwrite -o a.exr
spp=$("$VELO" film info f.film | sed -n 's/^ *samples *0:\([0-9]*\) .*/\1/p')
identical "--time is the --spp that it reached" $render scene.pbrt $small --spp "$spp" -o b.exr

# Shards by samples and by tiles, in any order and grouping, one of them twice: the film of the single run.
$render scene.pbrt $small --spp 11 --film whole.film
for i in 1 2 3; do $render scene.pbrt $small --spp 11 --shard $i/3 --film s$i.film; done
for i in 1 2 3 4; do $render scene.pbrt $small --spp 11 --shard $i/4 --shard-by tiles --film t$i.film -t 1; done
"$VELO" film merge s3.film s1.film s2.film s1.film -o m.film
same "shards by samples" m.film whole.film
"$VELO" film merge t2.film t4.film -o m.film && "$VELO" film merge t1.film m.film t3.film -o m.film
same "shards by tiles" m.film whole.film
"$VELO" film merge whole.film m.film s1.film t2.film -o m2.film
same "merged again" m2.film whole.film
for i in $(seq 201); do ln -s s$((i % 3 + 1)).film many$i.film; done
"$VELO" film merge many*.film -o m.film
same "more files than are open at once" m.film whole.film
[ ! -e m.film.merge ] && pass "no file is left over" || fail "no file is left over"
"$VELO" film develop m.film -o d.pfm
$render scene.pbrt $small --spp 11 -o e.pfm
same "developed" d.pfm e.pfm
# The header of a developed image is that of the render's own: camera, lens, motion, settings, receipt.
# developed NAME WORDS...: the same attributes; the same file, if the film has no sums that the image has not.
developed() {
  local name=$1
  shift
  rm -f a.exr b.exr
  $render "$@" --film developed.film --overwrite -o a.exr
  "$VELO" film develop developed.film -o b.exr
  "$VELO" image info a.exr | sed '1d; /^channels/d' >a.txt
  "$VELO" image info b.exr | sed '1d; /^channels/d' >b.txt
  grep -q velo.worldFromCamera a.txt || : >a.txt
  same "header of $name" a.txt b.txt
}
developed scene scene.pbrt $small --spp 3
same "file of scene" a.exr b.exr
developed crop scene.pbrt $small --spp 3 --crop 20,10,60,30 --spectrum 4 --exposure 2
same "file of crop" a.exr b.exr
developed lens "$VELO_SOURCE_DIR/scenes/features/lens.pbrt" $small --spp 2
developed motion "$VELO_SOURCE_DIR/scenes/features/motion.pbrt" $small --spp 2 --channels-time close --focus-pixel 20,20 --lens-radius 0.1
developed "noise" scene.pbrt $small --noise 10%
developed errors scene.pbrt $small --spp 3 --channels error
same "file of errors" a.exr b.exr
developed "errors and spectrum" scene.pbrt $small --spp 3 --channels error --spectrum 4
same "file of errors and spectrum" a.exr b.exr
developed channels scene.pbrt $small --spp 3 --channels Z,N --channels-mode nearest
# ground truth of the image alone is not the film's
$render scene.pbrt $small --spp 2 --film later.film -o a.exr
$render --continue later.film --spp 3 --channels Z -o a.exr
"$VELO" film develop later.film -o b.exr
"$VELO" image info a.exr >a.txt
"$VELO" image info b.exr >b.txt
if grep -q velo.channels a.txt && ! grep -q velo.channels b.txt; then pass "channels of the image alone"; else fail "channels of the image alone"; fi
$render scene.pbrt $small --stereo parallel --spp 3 --film side_%v.film -o side_%v.exr --channels error
"$VELO" film develop side_right.film -o b.exr
same "file of an eye" side_right.exr b.exr
"$VELO" film develop t1.film -o b.exr
"$VELO" image info b.exr >part.txt
check "a part's header has its own window" grep -q 'dataWindow *0 0 31 ' part.txt
check "a part's header has the camera" grep -q velo.worldFromCamera part.txt
mkdir bin
ln -s "$VELO" bin/velo
"$VELO" film merge s3.film t1.film -o gap.film
"$VELO" film info --missing gap.film >missing.sh
PATH=$PWD/bin:$PATH sh missing.sh 2>missing.txt
same "what is missing is rendered by the commands that info prints" gap.film whole.film
check "a complete film misses nothing" test -z "$("$VELO" film info --missing whole.film)"

# Killed at any moment: the last checkpoint is there, whole, and the continued image is the straight one's.
$render scene.pbrt $small --spp 150 -o a.exr
for round in 1 2 3 4 5 6; do
  rm -f k.film b.exr
  "$VELO" render scene.pbrt $small --spp 150 --film k.film --checkpoint 0.01 --quiet 2>/dev/null &
  process=$!
  wait_for k.film
  sleep "0.0$((RANDOM % 9))$((RANDOM % 10))"
  kill -KILL $process 2>/dev/null
  wait $process 2>/dev/null
  if "$VELO" film info --check k.film >info.txt 2>&1; then pass "killed $round: the film is whole"; else fail "killed $round: the film is whole"; fi
  identical "killed $round: continued" $render --continue k.film -o b.exr -t $((round % 3 + 1))
done
for signal in INT TERM HUP USR1 USR2; do
  rm -f k.film
  env --default-signal=INT,HUP,TERM "$VELO" render scene.pbrt $small --spp 100000 --film k.film --quiet 2>/dev/null &
  process=$!
  sleep 1
  kill -$signal $process
  wait $process
  code=$?
  [ $code = $((128 + $(kill -l $signal))) ] && pass "$signal: exit code" || fail "$signal: exit code ($code)"
  check "$signal: the film is written" "$VELO" film info --check k.film
done

# refused NAME CODE TEXT COMMAND...: that exit code, one line that has TEXT.
refused() {
  local name=$1 code=$2 text=$3 got
  shift 3
  "$@" >refused.txt 2>&1
  got=$?
  if [ $got = "$code" ] && [ "$(wc -l <refused.txt)" = 1 ] && grep -qF -- "$text" refused.txt; then
    pass "$name"
  else
    fail "$name (exit code $got)"
    sed 's/^/  | /' refused.txt
  fi
}
$render scene.pbrt $small --spp 6 --film f.film --overwrite
refused "other settings" 3 "tracer is volpath, was path" $render --continue f.film --tracer volpath
refused "another seed" 3 "seed" $render --continue f.film --seed 7
refused "another size" 3 "width" $render --continue f.film --resolution 60x40
refused "fewer samples" 2 "0:6" $render --continue f.film --spp 3
cp scene.pbrt changed.pbrt
echo "# changed" >>changed.pbrt
refused "another scene" 3 "changed" $render changed.pbrt --continue f.film
mv scene.pbrt away.pbrt
refused "no scene" 4 "scene.pbrt" $render --continue f.film
mv away.pbrt scene.pbrt
$render scene.pbrt $small --spp 9 --samples 4:9 --film late.film
refused "overlap" 3 "4:6" "$VELO" film merge f.film late.film -o none.film
refused "a part with -o" 2 "-o" $render scene.pbrt --samples 0:1 --film p.film -o p.exr
refused "a part without film" 2 "--film" $render scene.pbrt --shard 1/2
refused "tiles beyond 32 bits" 2 "must lie in the film" $render scene.pbrt $small --film p.film --tiles 0,0,4294967328,32
refused "no such shard" 2 "3/2" $render scene.pbrt --film p.film --shard 3/2
refused "more shards than samples" 2 "more parts than samples per pixel (1)" $render scene.pbrt $small --film p.film --spp 1 --shard 1/2
refused "more shards than tiles" 2 "more parts than tiles of 32 pixels (1)" $render scene.pbrt --film p.film --resolution 32x24 --shard 1/2 --shard-by tiles
refused "no film" 4 "absent.film" $render --continue absent.film
refused "not a film" 3 "not a film file" "$VELO" film info scene.pbrt
refused "no folder" 5 "absent" $render scene.pbrt --film absent/p.film
# A full disk: the earlier film stays.
cp f.film full.film
refused "a full disk" 5 "full.film" bash -c "ulimit -f 40; exec $render scene.pbrt $small --spp 7 --film full.film"
same "a full disk: the earlier film is as it was" full.film f.film
refused "a full disk, merging" 5 "full.film" bash -c "ulimit -f 40; exec '$VELO' film merge whole.film s1.film -o full.film"
same "a full disk, merging: the earlier film is as it was" full.film f.film
chmod 444 full.film
[ -w full.film ] || refused "a film that may not be written" 5 "full.film" $render scene.pbrt $small --spp 7 --film full.film
ls -A | grep -q '^[.]velo-' && fail "no temporary files are left" || pass "no temporary files are left"
head -c 3000 f.film >cut.film
refused "cut" 3 "damaged" "$VELO" film merge cut.film -o none.film
# The receipt in the header is of a later version, or no receipt, with right CRCs.
python3 - <<'SCRIPT'
import struct, zlib
data = open("f.film", "rb").read()
size = struct.unpack_from("<I", data, 12)[0]
header = data[24:24 + size]
no_receipt = header[:header.index(b'"receipt"')] + b'"receipt": "SCALAR"}'
folder = header.replace(b'"scene.pbrt"', b'"."')
long = header.replace(b'"scene.pbrt"', b'"' + b"x" * 70000 + b'"')
for name, text in (("folder.film", folder), ("long.film", long), ("later.film", header.replace(b'"velo_receipt": 1', b'"velo_receipt": 9')), ("scalar.film", no_receipt)):
    head = data[:12] + struct.pack("<II", len(text), zlib.crc32(text))
    open(name, "wb").write(head + struct.pack("<I", zlib.crc32(head)) + text + data[24 + size:])
SCRIPT
refused "a receipt of a later version" 3 "later.film: film file: receipt" "$VELO" film info later.film
refused "no receipt" 3 "scalar.film" "$VELO" film info scalar.film
refused "a folder as scene" 5 "of the film folder.film" $render --continue folder.film
refused "a word of 70000 letters" 3 "long.film: the command in its receipt cannot be followed: a word is too long" $render --continue long.film
refused "a receipt of a later version, merged" 3 "later.film: film file: receipt" "$VELO" film merge f.film later.film -o none.film
[ ! -e none.film ] && pass "no result of a failed merge" || fail "no result of a failed merge"
finish
