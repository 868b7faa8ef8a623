#!/usr/bin/env bash
# The bits of images: each scene of scenes/ by its own tracer, those of scenes/features by all tracers, some in RGB.
# hashes.txt holds a line for each: hash of the .pfm, scene, options. Each set of hot kernels and of Embree that the
# machine has must give the same. `test/golden/test_hashes.sh --update` writes hashes.txt anew: a change of hashes is a
# change of images and needs an entry in CHANGELOG.md, section Pixels.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$VELO_SOURCE_DIR" || exit 1
golden=test/golden/hashes.txt
size="--resolution 48x36 --spp 2 --threads 1 --quiet"

list() {
  local scene tracer
  for scene in scenes/*/*.pbrt; do
    grep -q '^ *Camera' "$scene" || continue # a part of others
    echo "$scene"
  done
  for scene in scenes/features/*.pbrt; do
    for tracer in path volpath bidirectional merging sppm lightpath randomwalk raycast ambientocclusion; do
      echo "$scene --tracer $tracer"
    done
    echo "$scene --color rgb"
  done
  echo "scenes/features/media.pbrt --tracer merging --color rgb"
  echo "scenes/features/two_way.pbrt --tracer bidirectional --color rgb"
}

# Hashes of all lines of the list, with the options given, on stdout.
hashes() {
  local line
  while read -r line; do
    rm -f "$work/image.pfm"
    # shellcheck disable=SC2086 # words of a line are options
    "$VELO" render $line $size "$@" -o "$work/image.pfm" 2>"$work/.err" </dev/null || { head -n 1 "$work/.err" >&2; }
    if [ -f "$work/image.pfm" ]; then
      printf '%s %s\n' "$(sha256sum "$work/image.pfm" | cut -c 1-16)" "$line"
    else
      printf 'none %s\n' "$line"
    fi
  done
}

if [ "${1-}" = --update ]; then
  list | hashes >"$work/new.txt" && cp "$work/new.txt" "$golden"
  git diff --stat -- "$golden"
  exit
fi

# against NAME: all lines of the file $work/NAME.txt are in the golden ones.
against() {
  if grep -vxFf "$golden" "$work/$1.txt" >"$work/wrong.txt"; then
    fail "$1"
    sed 's/^/  | /' "$work/wrong.txt" | head -n 20
  else
    pass "$1"
  fi
}

list | sort >"$work/list.txt"
if cut -d ' ' -f 2- "$golden" | sort | cmp -s - "$work/list.txt"; then
  pass every_scene_and_tracer_has_a_hash
else
  fail every_scene_and_tracer_has_a_hash
fi
list | hashes >"$work/all.txt"
against all

# The rest: one scene in three for each set, all kinds of shapes, cameras and tracers among them.
list | awk 'NR % 3 == 1' >"$work/some.txt"
for isa in v2 v3 v4; do
  if ! "$VELO" render scenes/features/shapes.pbrt --dry-run --quiet --isa $isa >"$work/.out" 2>&1; then
    skip "isa_$isa" "this machine does not have it"
    continue
  fi
  VELO_ISA=$isa hashes <"$work/some.txt" >"$work/isa_$isa.txt"
  against "isa_$isa"
done
for set in sse4.2 avx; do
  if ! VELO_EMBREE=$set "$VELO" render scenes/features/shapes.pbrt --accelerator embree --dry-run --quiet >"$work/.out" 2>&1; then
    skip "embree_$set" "this machine does not have it"
    continue
  fi
  VELO_EMBREE=$set hashes <"$work/some.txt" >"$work/embree_$set.txt"
  against "embree_$set"
done
hashes --accelerator bvh <"$work/some.txt" >"$work/bvh.txt"
against bvh

# It can fail: another seed.
head -n 1 "$work/list.txt" | hashes --seed 1 >"$work/seed.txt"
if grep -qxFf "$golden" "$work/seed.txt"; then fail another_seed_is_another_image; else pass another_seed_is_another_image; fi
finish
