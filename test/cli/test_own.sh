#!/usr/bin/env bash
# Images and films that a program's own code has made (docs/own-code.md): the program velo does not make them again, continue
# them or merge them with others, and one line names the code.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1
cat >room.pbrt <<'END'
LookAt 0 1 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 12 "integer yresolution" 8 "string filename" "room.exr"
Sampler "independent" "integer pixelsamples" 2
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Shape "sphere"
END
helper=$VELO_BINARY_DIR/bin/helper_own

# refused NAME CODE TEXT COMMAND...: exit code, one line, which holds the text
refused() {
  local name=$1 code=$2 text=$3
  shift 3
  expect_code "$code" "$name" "$@"
  if [ "$(printf '%s\n' "$err" | wc -l)" = 1 ] && printf '%s' "$err" | grep -qF "$text"; then
    pass "$name: one line that names it"
  else
    fail "$name: $err"
  fi
}

for kind in camera sampler tracer; do
  "$helper" room.pbrt $kind "my $kind" $kind.exr $kind.film || exit 1
  "$helper" room.pbrt $kind "another $kind" other.exr other.film || exit 1
  refused "render --again, $kind" 3 "own $kind \"my $kind\"" "$VELO" render --again $kind.exr -o again.exr --quiet
  check "render --again, $kind: no image" test ! -e again.exr
  refused "a film of another $kind is not merged" 3 "another $kind, was my $kind" \
    "$VELO" film merge $kind.film other.film -o merged.film
  check "a film of another $kind: nothing is written" test ! -e merged.film
  cp $kind.film kept.film
  refused "render --film does not go on, $kind" 2 "my $kind" "$VELO" render room.pbrt --film $kind.film --spp 4 -o more.exr --quiet
  check "render --film, $kind: the film is as before" cmp $kind.film kept.film
  rm -f more.exr
done
finish
