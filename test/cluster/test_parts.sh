#!/usr/bin/env bash
# cluster/shard, cluster/merge and cluster/parallel/velo-render without a cluster: parts in any order, attempts that
# are killed or stopped and go on, damaged attempts, frames. Each image has the bytes of a single render. (Slurm itself:
# test/cluster/check_slurm.)
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
export VELO
shard=$VELO_SOURCE_DIR/cluster/shard merge=$VELO_SOURCE_DIR/cluster/merge
parallel=$VELO_SOURCE_DIR/cluster/parallel/velo-render
write_scene scene.pbrt
size=(--resolution 80x70)
check straight "$VELO" render scene.pbrt "${size[@]}" --spp 7 --quiet -o one.exr --channels error

# attempts FOLDER [PATTERN]: the films there.
attempts() { find "$1" -name "${2:-*.try-*.film}"; }

# ---- parts and merge -------------------------------------------------------------------------------------------------
for by in samples tiles; do
  mkdir "$by"
  for i in 3 1 2; do check "${by}_$i" "$shard" "$by" $i 3 --by $by -- scene.pbrt "${size[@]}" --spp 7 --quiet --channels error; done
  check "${by}_merge" "$merge" "$by" 3 -o $by.exr -- scene.pbrt "${size[@]}" --spp 7 --quiet --channels error
  same "${by}_same_bytes" $by.exr one.exr
  check "${by}_parts_removed" test -z "$(attempts "$by" '*.film')"
done
mkdir gap
check gap_part "$shard" gap 2 2 -- scene.pbrt --spp 2 --quiet
expect_code 4 gap "$merge" gap 2 -o gap.exr -- scene.pbrt --spp 2
expect_text gap_names 'part 1 of 2 is missing'
expect_code 2 wrong_part "$shard" gap 3 2 -- scene.pbrt
expect_code 2 too_few "$shard" gap
for script in "$shard" "$merge" "$parallel" "$VELO_SOURCE_DIR/cluster/slurm/velo-render"; do
  check "help_$(basename "$(dirname "$script")")" "$script" --help
  expect_text "help_text" usage:
done

# ---- stopped and killed ----------------------------------------------------------------------------------------------
# Until an attempt has a film: then the signal.
mkdir stopped
again=("$shard" stopped) rest=(-- scene.pbrt --resolution 320x240 --spp 64 -t 1 --checkpoint 0.1s --quiet)
# stop SIGNAL: begins part 1, sends the signal to all its processes' group after a new film is there; sets code.
stop() {
  local before i
  before=$(attempts stopped | wc -l)
  setsid "${again[@]}" 1 2 "${rest[@]}" >log 2>&1 &
  local pid=$!
  for i in $(seq 600); do
    [ "$(attempts stopped | wc -l)" -gt "$before" ] && break
    sleep 0.05
  done
  kill "-$1" "$2$pid"
  wait "$pid"
  code=$?
}
stop TERM ''
check stopped_143 test "$code" = 143
check stopped_film test "$(attempts stopped | wc -l)" = 1
stop KILL - 2>/dev/null
check killed_137 test "$code" = 137
first=$(attempts stopped | head -n 1)
printf x | dd of="$first" bs=1 seek=40 conv=notrunc status=none
check goes_on "${again[@]}" 1 2 "${rest[@]}"
expect_text goes_on_says 'goes on with'
check attempts_removed test -z "$(attempts stopped)"
check second_part "${again[@]}" 2 2 "${rest[@]}"
check stopped_merge "$merge" stopped 2 -o stopped.exr -- scene.pbrt --resolution 320x240 --spp 64 --quiet
check stopped_straight "$VELO" render scene.pbrt --resolution 320x240 --spp 64 --quiet -o stopped_one.exr
same stopped_same_bytes stopped.exr stopped_one.exr
mkdir failing
expect_code 4 failing "$shard" failing 1 2 -- nowhere.pbrt
expect_code 4 failing_again "$shard" failing 1 2 -- nowhere.pbrt
check failures_counted test "$(wc -l <failing/part-1.failures)" = 2

# ---- frames ----------------------------------------------------------------------------------------------------------
printf 'name,eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z\n' >poses.csv
for i in 0 1 2 3 4; do printf 'p%d,0.%d,1.2,4,0,0.6,0\n' $i $i >>poses.csv; done
mkdir plain moved many
check frames_straight "$VELO" render scene.pbrt --trajectory poses.csv --spp 2 --quiet -o plain/%04d.exr -o plain/%n/i.png --channels id.object
mkdir -p frames/frames/0 frames/frames/1
pattern=(-o frames/frames/0/%04d.exr -o frames/frames/1/%n/i.png)
words=(scene.pbrt --trajectory poses.csv --spp 2 --quiet --channels id.object)
check frames_1 "$shard" frames 1 2 "${pattern[@]}" -- "${words[@]}"
check frames_2 "$shard" frames 2 2 "${pattern[@]}" -- "${words[@]}"
check frames_merge "$merge" frames 2 -o moved/%04d.exr -o moved/%n/i.png -- "${words[@]}"
check frames_same diff -r plain moved

# ---- GNU parallel ----------------------------------------------------------------------------------------------------
if ! parallel --version 2>/dev/null | grep -q '^GNU parallel'; then
  skip parallel 'needs GNU parallel (script/bootstrap cluster)'
  finish
fi
words=(scene.pbrt "${size[@]}" --spp 7 --quiet --channels error)
check parallel "$parallel" --parts 3 --jobs 2 "${words[@]}" -o "an image.exr"
same parallel_same_bytes "an image.exr" one.exr
check parallel_tiles "$parallel" --parts 3 --by tiles "${words[@]}" -o tiled.exr --film kept.film
same parallel_tiles_same_bytes tiled.exr one.exr
check parallel_film_same "$VELO" render "${words[@]}" --film straight.film -o tiled.exr
same parallel_film_same_bytes kept.film straight.film
expect_code 2 parallel_film_there "$parallel" --parts 3 "${words[@]}" --film kept.film
expect_text parallel_film_there_says 'kept.film is there already'
same parallel_film_stays kept.film straight.film
check parallel_film_overwritten "$parallel" --parts 2 "${words[@]}" --film kept.film --overwrite --seed 3
check parallel_film_other "$VELO" render "${words[@]}" --film other.film --seed 3
same parallel_film_other_bytes kept.film other.film
check parallel_frames "$parallel" --parts 2 scene.pbrt --trajectory poses.csv --spp 2 --quiet -o many/%04d.exr
# Hosts: an ssh that runs its command here; one host is dead, its parts are tried on the other.
mkdir bin
cat >bin/ssh <<'END'
#!/bin/sh
while case $1 in -o) shift ;; -*) ;; *) false ;; esac; do shift; done
host=$1
shift
export SHELL=/bin/sh # sshd sets it; GNU parallel relies on it
echo "$host" >>"$HOSTS"
[ "$host" != dead ] || exit 255
[ "$1" != -- ] || shift
exec sh -c "$*"
END
chmod +x bin/ssh
export HOSTS=$work/hosts
check parallel_hosts env "PATH=$work/bin:$PATH" "$parallel" --parts 3 --hosts 1/dead,1/other "${words[@]}" -o remote.exr
same parallel_hosts_same_bytes remote.exr one.exr
check parallel_hosts_both test "$(sort -u hosts | tr '\n' ' ')" = 'dead other '
expect_code 1 parallel_fails "$parallel" --parts 2 nowhere.pbrt -o no.exr
expect_text parallel_says 'no such file: nowhere.pbrt'
expect_code 2 parallel_usage "$parallel" --parts none scene.pbrt -o no.exr
expect_code 3 parallel_folder "$parallel" --parts 3 --folder no.exr.parts scene.pbrt -o no.exr
expect_code 2 parallel_time "$parallel" scene.pbrt --time 5s -o no.exr
finish
