# Every fuzz target runs over its corpus, test/fuzz/corpus/NAME (and what ../shared has of its kind), and over damaged
# forms of it: no crash, no hang, no memory out of proportion.
. "$VELO_SOURCE_DIR/test/harness.sh"
cd "$VELO_SOURCE_DIR" || exit 1
for source in test/fuzz/fuzz_*.c; do
  [ -e "$source" ] || { skip "fuzz targets" "there are none"; break; }
  name=$(basename "$source" .c)
  corpus=test/fuzz/corpus/${name#fuzz_}
  [ "$name" != fuzz_render ] || corpus=test/fuzz/corpus/scene
  if [ ! -d "$corpus" ]; then
    fail "$name has a corpus ($corpus)"
    continue
  fi
  # 2 GiB of address space beyond what a sanitizer reserves would hide nothing: without one, hold it to that.
  limit=
  if ! grep -q 'fsanitize=' "$VELO_BINARY_DIR/build.ninja"; then limit="ulimit -v 3000000;"; fi
  times=200
  [ "$name" != fuzz_camera_file ] || times=100 # 80 files
  # A hang is CPU time: how long it takes otherwise depends on what else the machine does.
  check "$name over its corpus, damaged $times times each" \
    timeout 1800 bash -c "ulimit -t 120; $limit exec '$VELO_BINARY_DIR/bin/$name' --mutate $times '$corpus'"
done
finish
