#!/usr/bin/env bash
# How files are replaced: only by finished renders, through links, with their permissions, under the longest names; what
# a full disk or a folder that vanishes does to them.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt

# ---- names, links, permissions -------------------------------------------------------------------------------------
mkdir there
ln -s there/target.exr link.exr
check dangling_link "$VELO" render scene.pbrt -o link.exr --quiet
[ -L link.exr ] && [ -s there/target.exr ] && pass dangling_link_is_followed || fail dangling_link_is_followed
printf old >there/target.exr
chmod 640 there/target.exr
check link "$VELO" render scene.pbrt -o link.exr --quiet
[ -L link.exr ] && [ "$(stat -c %a there/target.exr)" = 640 ] && [ "$(stat -c %s there/target.exr)" -gt 3 ] && pass link_is_followed || fail link_is_followed
cp there/target.exr copy.exr
check convert_link "$VELO" image convert copy.exr link.exr
[ -L link.exr ] && pass convert_follows_links || fail convert_follows_links
ln -s loop.exr loop.exr
run "$VELO" render scene.pbrt -o loop.exr --quiet
[ "$code" = 5 ] && pass link_to_itself || { fail link_to_itself; show loop; }

long=$(printf 'n%.0s' $(seq 251))
check longest_name "$VELO" render scene.pbrt -o "$long.exr" --channels Z,id.object --quiet
[ -s "$long.exr" ] && pass longest_name_is_there || fail longest_name_is_there
[ "$(ls | grep -c 'n\.ids\.json$\|exr\.ids\.json$\|ids\.json$')" = 1 ] && pass longest_name_of_ids || fail "longest_name_of_ids ($(ls | grep json))"
run "$VELO" render scene.pbrt -o "n$long.exr" --quiet --spp 16777216
[ "$code" = 5 ] && [[ $err == *"File name too long"* ]] && pass too_long_a_name || { fail too_long_a_name; show long; }
env --default-signal=INT "$VELO" render scene.pbrt -o "$long.exr" --spp 16777216 --quiet &
process=$!
for _ in $(seq 300); do ls | grep -q 'n\.part\.exr$' && break; sleep 0.1; done
kill -INT $process
wait $process
ls | grep -q 'n\.part\.exr$' && pass longest_name_of_a_part || fail longest_name_of_a_part

# Root may write any file, but not without this capability.
unprivileged=
if [ "$(id -u)" = 0 ]; then unprivileged="setpriv --bounding-set=-dac_override"; fi
printf old >fixed.exr
chmod 444 fixed.exr
# shellcheck disable=SC2086
expect_code 5 read_only_file $unprivileged "$VELO" render scene.pbrt -o fixed.exr --quiet --spp 16777216
[ "$(cat fixed.exr)" = old ] && pass read_only_file_stays || fail read_only_file_stays

# The second progress image is written after ten seconds. A stopped program lets time pass and needs no processor.
stand_still() {
  kill -STOP $process
  sleep "$1"
  kill -CONT $process
}

# ---- a folder that vanishes ------------------------------------------------------------------------------------------
mkdir gone
"$VELO" render scene.pbrt -o gone/a.exr -o stays.exr --time 12s --threads 1 2>gone.txt &
process=$!
wait_for gone/a.part.exr
rm -r gone
stand_still 9
wait $process
code=$?
out=
err=$(cat gone.txt)
[ "$code" = 5 ] && pass vanished_folder || { fail "vanished_folder ($code)"; show gone; }
expect_text vanished_folder_is_noticed 'progress image: cannot write gone/a.part.exr'
[ -s stays.exr ] && pass the_other_output_goes_on || fail the_other_output_goes_on

# ---- a disk that is full for a moment --------------------------------------------------------------------------------
if [ "$(id -u)" = 0 ] && mkdir small && mount -t tmpfs -o size=200k none small 2>/dev/null; then
  printf old >small/a.exr
  dd if=/dev/zero of=small/fill bs=1k count=190 2>/dev/null
  "$VELO" render scene.pbrt -o small/a.exr --time 12s --threads 1 2>full.txt &
  process=$!
  sleep 2
  rm small/fill
  stand_still 8
  wait_for small/a.part.exr && pass later_writes_go_on || { fail later_writes_go_on; cat full.txt; }
  wait $process
  [ $? = 0 ] && [ "$(stat -c %s small/a.exr)" -gt 3 ] && pass full_for_a_moment || { fail full_for_a_moment; cat full.txt; }
  [ "$(ls -A small)" = a.exr ] && pass nothing_else_left || fail "nothing_else_left ($(ls -A small))"
  printf old >small/a.exr
  dd if=/dev/zero of=small/fill bs=1k count=190 2>/dev/null
  run "$VELO" render scene.pbrt -o small/a.exr --quiet
  [ "$code" = 5 ] && [ "$(cat small/a.exr)" = old ] && pass full_disk_leaves_the_earlier_file || fail full_disk_leaves_the_earlier_file
  umount small
else
  skip full_for_a_moment "needs the right to mount"
fi

# ---- a closed stdout -------------------------------------------------------------------------------------------------
"$VELO" render scene.pbrt -o a.png --quiet
closed() {
  local name=$1
  shift
  run bash -c 'exec "$0" "$@" >&-' "$VELO" "$@"
  [ "$code" = 5 ] && pass "closed_$name" || { fail "closed_$name ($code)"; show "$*"; }
}
closed help help render
closed overview help
closed version --version
closed image_info image info a.png
closed image_info_json image info a.png --json
closed image_diff image diff a.png a.png
closed scene_info scene info scene.pbrt
closed scene_check scene check scene.pbrt
closed camera_info camera info scene.pbrt
closed dry_run render scene.pbrt --dry-run
run bash -c 'exec "$0" render scene.pbrt -o b.png --quiet >&-' "$VELO"
[ "$code" = 0 ] && pass closed_but_not_needed || { fail closed_but_not_needed; show render; }
finish
