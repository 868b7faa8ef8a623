#!/usr/bin/env bash
# Writing images: several at once, names, and every way in which it can fail: never exit code 0 then.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt

check several_outputs "$VELO" render scene.pbrt -o a.exr -o a.png --output a.jpg --output=a.hdr -oa.pfm -o a.tga
expect_text says_what_it_wrote "wrote a.exr, a.png, a.jpg, a.hdr, a.pfm, a.tga"
for suffix in exr png jpg hdr pfm tga; do
  run "$VELO" image info "a.$suffix"
  if [ "$code" = 0 ] && [[ $out == *"64 x 48"* ]]; then pass "reads_back_$suffix"; else fail "reads_back_$suffix"; show "image info a.$suffix"; fi
done
[ -z "$(find . -name '*.tmp')" ] && pass no_temporary_files || fail "no_temporary_files ($(find . -name '*.tmp'))"

check name_from_the_scene "$VELO" render scene.pbrt --quiet --spp 1
[ -s asked.exr ] && pass name_from_the_scene_is_there || fail name_from_the_scene_is_there
sed 's,"asked.exr","/nowhere/at/all/far.png",' scene.pbrt >far.pbrt
check name_from_the_scene_without_its_folder "$VELO" render far.pbrt --quiet --spp 1
[ -s far.png ] && pass only_the_last_part_of_the_name || fail only_the_last_part_of_the_name
sed 's/"string filename" "asked.exr"//' scene.pbrt >plain.pbrt
gzip -c plain.pbrt >packed.pbrt.gz
rm -f ./*.exr
check packed_scene "$VELO" render packed.pbrt.gz --quiet --spp 1
ls ./*.exr >.list 2>/dev/null
[ "$(wc -l <.list)" = 1 ] && pass one_default_image || fail "one_default_image ($(cat .list))"

rm -f dry.exr
check dry_run "$VELO" render scene.pbrt --dry-run -o dry.exr --resolution 128x96 --crop 8,8,24,16 --spp 3
expect_text dry_run_size "128 x 96"
expect_text dry_run_spp "3 spp"
[ ! -e dry.exr ] && pass dry_run_writes_nothing || fail dry_run_writes_nothing

# refused NAME TEXT COMMAND...: exit code 5 and one line.
refused() {
  local name=$1 text=$2
  shift 2
  run "$@"
  if [ "$code" = 5 ] && [ "$(printf '%s\n' "$err" | wc -l)" = 1 ] && [[ $err == "velo: "*"$text"* ]]; then
    pass "$name"
  else
    fail "$name (wanted exit code 5 and one line with: $text)"
    show "$*"
  fi
}
# These are found before the work begins: 2^24 samples would take hours.
long="--spp 16777216 --quiet"
refused missing_folder 'No such file' "$VELO" render scene.pbrt -o none/a.exr $long
refused missing_folder_second_output 'No such file' "$VELO" render scene.pbrt -o fine.exr -o none/a.png $long
[ ! -e fine.exr ] && pass nothing_written_before_the_check || fail nothing_written_before_the_check
refused folder_is_a_file 'Not a directory' "$VELO" render scene.pbrt -o scene.pbrt/a.exr $long
mkdir is_folder.exr
refused output_is_a_folder 'Is a directory' "$VELO" render scene.pbrt -o is_folder.exr $long
refused convert_missing_folder 'No such file' "$VELO" image convert a.png none/b.png

mkdir locked
chmod 555 locked
if [ "$(id -u)" != 0 ]; then
  refused read_only_folder 'Permission denied' "$VELO" render scene.pbrt -o locked/a.exr $long
elif chmod 755 "$work" && setpriv --reuid=65534 --clear-groups "$VELO" --version >/dev/null 2>&1; then
  refused read_only_folder 'Permission denied' setpriv --reuid=65534 --clear-groups "$VELO" render scene.pbrt -o locked/a.exr $long
else
  skip read_only_folder "root may write anywhere, and no other user can run the program"
fi

# Full disks.
ln -s /dev/full full.exr
ln -s /dev/full full.png
run "$VELO" render scene.pbrt -o full.exr --quiet
if [ "$code" = 5 ] && [[ $err == *"No space left"* ]]; then pass full_exr; else fail "full_exr"; show full; fi
run "$VELO" render scene.pbrt -o full.png -o beside.exr --quiet
if [ "$code" = 5 ] && [[ $err == *"No space left"* ]]; then pass full_png; else fail "full_png"; show full; fi
[ -s beside.exr ] && pass the_other_output_is_written || fail the_other_output_is_written
run "$VELO" image convert a.png full.png
[ "$code" = 5 ] && pass convert_to_full_disk || fail "convert_to_full_disk (exit code $code)"
run bash -c 'exec "$0" image info a.png >/dev/full' "$VELO"
[ "$code" = 5 ] && pass stdout_is_full || fail "stdout_is_full (exit code $code)"
# A file may not grow past a kilobyte: like a disk that fills up while writing. The old image must survive.
printf old >limited.exr
run bash -c 'ulimit -f 1; exec "$0" render scene.pbrt -o limited.exr --quiet' "$VELO"
[ "$code" = 5 ] && pass disk_fills_up || { fail "disk_fills_up (exit code $code)"; show limited; }
[ "$(cat limited.exr)" = old ] && pass old_image_survives || fail old_image_survives
[ -z "$(find . -name '*.tmp')" ] && pass no_rest_of_failed_writes || fail no_rest_of_failed_writes
if [ "$(id -u)" = 0 ] && mkdir tiny && mount -t tmpfs -o size=8k none tiny 2>/dev/null; then
  run "$VELO" render scene.pbrt -o tiny/a.exr --quiet --resolution 256x192
  [ "$code" = 5 ] && pass tiny_disk || { fail "tiny_disk (exit code $code)"; show tiny; }
  [ -z "$(ls tiny)" ] && pass tiny_disk_is_clean || fail "tiny_disk_is_clean ($(ls tiny))"
  umount tiny
else
  skip tiny_disk "needs the right to mount"
fi

# The film's colour space does not change what people see, nor does the way through an EXR file.
"$VELO" render scene.pbrt -o srgb.png --quiet
for space in rec2020 dci-p3 aces2065-1; do
  sed "s/^Film/ColorSpace \"$space\"\nFilm/; s/^WorldBegin/ColorSpace \"srgb\"\nWorldBegin/" scene.pbrt >space.pbrt
  check "space_$space" "$VELO" render space.pbrt -o space.png -o space.exr --quiet
  run "$VELO" image diff srgb.png space.png --threshold mse=1e-6 --threshold flip=0.005
  [ "$code" = 0 ] && pass "space_${space}_looks_the_same" || { fail "space_${space}_looks_the_same"; show diff; }
  "$VELO" image convert space.exr converted.png
  same "space_${space}_through_exr" space.png converted.png
done

# Closed standard streams: messages must not end up in images.
bash -c '"$0" render scene.pbrt -o closed.exr <&- >&- 2>&-' "$VELO"
check closed_streams "$VELO" image info closed.exr

# Machines read along.
run "$VELO" render scene.pbrt -o json.exr --log-json --spp 8 --filter-samples own
if printf '%s\n' "$err" | python3 -c '
import json, sys
lines = [json.loads(line) for line in sys.stdin]
assert lines[-1]["event"] == "result" and lines[-1]["status"] == 0 and lines[-1]["spp"] == 8, lines[-1]
assert lines[-1]["files"] == ["json.exr"] and lines[-1]["paths"] == 8 * 64 * 48, lines[-1]
assert any(line["event"] == "progress" for line in lines)'; then pass log_json; else fail log_json; show json; fi
run "$VELO" render none.pbrt --log-json
if [ "$code" = 4 ] && printf '%s' "$err" | python3 -c 'import json, sys; assert json.loads(sys.stdin.read())["status"] == 4'; then
  pass log_json_error
else
  fail log_json_error
  show json
fi
run "$VELO" render scene.pbrt -o quiet.exr --quiet
[ "$code$out$err" = 0 ] && pass quiet || { fail quiet; show quiet; }
finish
