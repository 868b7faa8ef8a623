# The commands of the README: exit codes pass through, names are relative to where one is, a second call starts at once.
. "$VELO_SOURCE_DIR/test/harness.sh"
render=$VELO_SOURCE_DIR/script/render
if [ "$VELO_BINARY_DIR" != "$VELO_SOURCE_DIR/build/release" ]; then
  skip script "only for build/release"
  exit 77
fi

# All built, for what follows is about calls that find it so.
check "builds" "$VELO_SOURCE_DIR/script/build" release velo_app

mkdir "$work/elsewhere"
cd "$work/elsewhere" || exit 1
cat >small.pbrt <<'END'
LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 12 "string filename" "small.exr"
Sampler "zsobol" "integer pixelsamples" 1
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Shape "sphere"
END
check "renders from any folder" "$render" small.pbrt --quiet -o here.png
check "says nothing of its own" test -z "$out$err"
check "the image is where it was asked for" test -s here.png
expect_code 4 "a missing scene is velo's 4" "$render" none.pbrt
expect_code 2 "a wrong option is velo's 2" "$render" small.pbrt --no-such-option
expect_code 0 "help passes" "$render" --help

# All that is built from is noticed: sources, the pages and the lecture in the program, the Python package.
noticed() { # FILE [TARGET]
  touch "$VELO_SOURCE_DIR/$1"
  run "$VELO_SOURCE_DIR/script/build" release ${2:+"$2"}
  if [ "$code" = 0 ] && [[ $err == *"building release"* ]]; then pass "a change of $1 is built"; else fail "a change of $1 is built"; show "$1"; fi
}
for file in web/README.md docs/lezione.md scenes/lecture/pinhole.pbrt; do noticed $file velo_app; done
noticed python/velo/dataset/files.py

# What stands before velo costs less than 0.3 s once all is built (median of five).
times=
for _ in 1 2 3 4 5; do
  start=$(date +%s%N)
  "$VELO_SOURCE_DIR/script/build" release velo_app
  times="$times $((($(date +%s%N) - start) / 1000000))"
done
# shellcheck disable=SC2086
median=$(printf '%s\n' $times | sort -n | sed -n 3p)
check "a second call starts at once ($median ms)" test "$median" -lt 300

check "bootstrap lists packages" env -u VELO_EMBREE "$VELO_SOURCE_DIR/script/bootstrap" --list test
expect_text "with the build's" libembree-dev
expect_text "and the tests'" libcmocka-dev
check "bootstrap lists packages without Embree" env VELO_EMBREE=OFF "$VELO_SOURCE_DIR/script/bootstrap" --list test
expect_text "with OpenEXR's" libopenexr-dev
check "and not Embree's" test "${out#*embree}" = "$out"
check "and those for building for aarch64" "$VELO_SOURCE_DIR/script/bootstrap" --list cross
expect_text "a cross compiler" gcc-aarch64-linux-gnu
expect_code 2 "an unknown set is refused" "$VELO_SOURCE_DIR/script/bootstrap" nonsense
check "a second bootstrap is silent" "$VELO_SOURCE_DIR/script/bootstrap" test
check "and has nothing to say" test -z "$out$err"
expect_code 2 "bench lists its names" "$VELO_SOURCE_DIR/script/bench"
expect_text "limit among them" limit
expect_code 2 "an unknown benchmark is refused" "$VELO_SOURCE_DIR/script/bench" nonsense
finish
