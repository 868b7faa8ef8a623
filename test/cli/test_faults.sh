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

  # The exit code is that of the first file that failed, also if those after it are written.
  problem=
  for k in 1 2 3 4; do
    code=0
    VELO_FAULT=rename:$k:5 LD_PRELOAD=$library "$VELO" render s.pbrt --spp 1 --channels id.object -o a.exr -o b.exr --quiet 2>err.txt || code=$?
    [ "$code" = 5 ] || problem="rename $k: exit code $code"
  done
  if [ -z "$problem" ]; then pass every_failed_file_is_an_error; else fail "every_failed_file_is_an_error ($problem)"; fi

  # What was rendered is in a file, whatever fails after it: ground truth, header, denoised copy, film, one of the outputs.
  # Only where the image itself cannot be made there is none: a few allocations.
  kept() { # NAME CALL ERRNO STEP OPTION...
    local name=$1 call=$2 number=$3 step=$4 k lost=0 late=0 problem= code
    shift 4
    VELO_FAULT=$call:0:$number VELO_FAULT_COUNT=$work/count LD_PRELOAD=$library "$VELO" render s.pbrt -t 1 --quiet "$@" 2>/dev/null
    for ((k = 1; k <= $(cat count); k += step)); do
      rm -f out_* c.exr f_*.film
      code=0
      VELO_FAULT=$call:$k:$number LD_PRELOAD=$library timeout 20 "$VELO" render s.pbrt -t 1 --log-json "$@" 2>err.txt || code=$?
      case "$code" in 0 | 1 | 5) ;; *) problem="$call $k: exit code $code" ;; esac
      if [ "$code" != 0 ] && grep -q '"event": "progress"' err.txt; then
        late=$((late + 1))
        [ -n "$(find . -name 'out_*.exr' -size +0)" ] || lost=$((lost + 1))
      fi
    done
    if [ -z "$problem" ] && [ "$late" -gt 3 ] && [ "$lost" -le 2 ]; then pass "kept_$name"; else fail "kept_$name ($problem; $lost of $late images are lost)"; fi
  }
  kept truth memory 12 9 --spp 1 --channels all -o out_a.exr -o out_b.exr
  kept denoised memory 12 17 --spp 2 --denoise c.exr -o out_a.exr -o out_b.exr
  kept eyes memory 12 17 --spp 1 --stereo parallel --channels id.object -o out_%v.exr
  kept eyes_in_one_file memory 12 13 --spp 1 --stereo parallel --channels id.object -o out_1.exr -o out_2.exr
  kept films write 28 1 --spp 1 --stereo parallel --film f_%v.film -o out_a%v.exr
  kept light_paths memory 12 17 --spp 4 --tracer bidirectional -o out_a.exr -o out_b.exr
else
  skip every_allocation_of_convert "no compiler"
fi
finish
