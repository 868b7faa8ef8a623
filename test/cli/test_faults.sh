#!/usr/bin/env bash
# A few rounds of tools/check_faults: signals, full disks, calls, allocations and threads that fail. More of them by hand.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
if ! is_release=$(grep -c '^CMAKE_BUILD_TYPE:.*=Release$' "$VELO_BINARY_DIR/CMakeCache.txt") || [ "$is_release" = 0 ]; then
  skip faults "sanitizers replace the calls that it makes fail"
  exit 77
fi
rounds() { check "$1" "$VELO_SOURCE_DIR/tools/check_faults" --velo "$VELO" --rounds "$2" --only "$3" --seed 3; }
rounds signals 4 signal
rounds full_disks 4 space
rounds failing_calls 12 call
rounds refused_memory 12 memory
rounds refused_threads 2 threads
rounds interrupts 12 interrupt
rounds few_files 4 files
rounds limits 4 limit
rounds vanished_folders 3 folder
rounds closed_output 4 stdout
rounds killed_films 2 kill
rounds films_that_several_want 8 owner
films() { check "film_$1" "$VELO_SOURCE_DIR/tools/check_faults" --velo "$VELO" --rounds "$2" --only "$1" --seed 5 --output film; }
films signal 3
films space 3
films call 6
films memory 10
films folder 3

# A signal right after each call that opens, locks, names or removes a file: no lock and no temporary file stays.
interrupts() { check "$1" "$VELO_SOURCE_DIR/tools/check_faults" --velo "$VELO" --every-interrupt --output "$2"; }
interrupts every_interrupt_of_a_merge 'film merge part_1'
interrupts every_interrupt_of_a_film 'scene.pbrt --film out.film --checkpoint'

# An error that OpenEXR reports while it writes: its lock is held then. Each allocation of the writer fails once.
if library=$work/interpose.so && cc -shared -fPIC -O1 -o "$library" "$VELO_SOURCE_DIR/tools/faults/interpose.c" -ldl 2>/dev/null; then
  cd "$work" || exit 1
  printf 'Film "rgb" "integer xresolution" 8 "integer yresolution" 8\nWorldBegin\nLightSource "infinite"\n' >s.pbrt
  "$VELO" render s.pbrt --spp 1 --quiet -o s.exr
  VELO_FAULT=memory:0:12 VELO_FAULT_COUNT=$work/count LD_PRELOAD=$library "$VELO" image convert s.exr t.exr
  problem=
  for ((k = 1; k <= $(cat count); k++)); do
    code=0
    VELO_FAULT=memory:$k:12 LD_PRELOAD=$library timeout 20 "$VELO" image convert s.exr t.exr 2>err.txt || code=$?
    case "$code" in 0 | 1) ;; *) problem="allocation $k: exit code $code: $(cat err.txt)" ;; esac
    [ "$code" = 0 ] || grep -q '^velo: ' err.txt || problem="allocation $k: no line"
  done
  if [ -z "$problem" ]; then pass every_allocation_of_convert; else fail "every_allocation_of_convert ($problem)"; fi
else
  skip every_allocation_of_convert "no compiler"
fi
finish
