# The long checks that run by hand: parts and records of tools/check_tracers, options of script/nightly, one line from
# tools/check_reference_mutations where what it needs is not built.
. "$VELO_SOURCE_DIR/test/harness.sh"
cd "$work" || exit 1
tools=$VELO_SOURCE_DIR/tools

room='LookAt 0 -4 1.5  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 8
WorldBegin
LightSource "infinite" "rgb L" [.4 .5 .6]
'
printf '%s Shape "sphere"\n' "$room" >ball.pbrt
printf '%s Shape "disk"\n' "$room" >disk.pbrt
tracers() { "$tools/check_tracers" --program "$VELO" --rays .1 --threads 1 "$@"; }
check "the first part" tracers ball.pbrt disk.pbrt --part 1/2 --record one.jsonl
expect_text "is the first scene" "ball.pbrt: "
check "the second part" tracers ball.pbrt disk.pbrt --part 2/2 --record two.jsonl
expect_text "is the second scene" "disk.pbrt: "
check "records together" "$tools/check_tracers" --summary one.jsonl two.jsonl
expect_text "count both" "check_tracers: 2 scenes, 0 differ; 2 compared with the reference renderer"
check "what agreed" tracers ball.pbrt disk.pbrt --record one.jsonl
if [[ $out != *"ball.pbrt: "* && $out == *"disk.pbrt: "*"check_tracers: 2 scenes"* ]]; then pass "is not run again"; else fail "is not run again"; show tracers; fi
printf '%s Shape "cylinder"\n' "$room" >ball.pbrt
check "a scene of another text" tracers ball.pbrt --record one.jsonl
expect_text "is run" "ball.pbrt: "
expect_code 1 "a part that is none" tracers ball.pbrt --part 3/2
expect_text "is refused" "--part takes K/N"

expect_code 2 "nightly: an unknown option" "$VELO_SOURCE_DIR/script/nightly" --ray 3
expect_text "shows the known ones" "--rays"

expect_code 1 "mutations without a build" env VELO_BINARY_DIR="$work/none" /usr/bin/python3 "$tools/check_reference_mutations"
if [ "$(wc -l <"$work/.err")" = 1 ] && [[ $err == "check_reference_mutations: "* ]]; then pass "one line"; else fail "one line"; show mutations; fi
mkdir -p none/python/velo # as after a build of the program alone
expect_code 1 "mutations without the module" env VELO_BINARY_DIR="$work/none" /usr/bin/python3 "$tools/check_reference_mutations"
if [ "$(wc -l <"$work/.err")" = 1 ] && [[ $err == "check_reference_mutations: "* ]]; then pass "one line, too"; else fail "one line, too"; show mutations; fi
finish
