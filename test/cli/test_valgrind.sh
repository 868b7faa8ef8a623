#!/usr/bin/env bash
# A small render under valgrind: images and a film are written, the film is continued, merged and developed; a scene
# with a mistake is refused. No read of uninitialised or freed memory, no leak.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1
if ! command -v valgrind >/dev/null; then
  skip "valgrind" "valgrind is not installed (script/bootstrap judges)"
  finish
fi
if readelf -s "$VELO" 2>/dev/null | grep -qE '__(asan|tsan)_init'; then
  skip "valgrind" "the program has a sanitizer"
  finish
fi

cat >scene.pbrt <<'END'
LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" 0.02 "float focaldistance" 5
Film "rgb" "integer xresolution" 16 "integer yresolution" 12
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.4 0.5]
AttributeBegin
  AreaLightSource "diffuse" "blackbody L" 4500 "float scale" 4
  Translate 0 3 0
  Rotate 90 1 0 0
  Shape "disk"
AttributeEnd
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [0.7 0.6 0.5] "rgb tex2" [0.1 0.2 0.3]
AttributeBegin
  Material "diffuse" "texture reflectance" "checks"
  Shape "trianglemesh" "point3 P" [-4 -1 4  4 -1 4  4 -1 -4  -4 -1 -4] "integer indices" [0 1 2 0 2 3]
AttributeEnd
Material "dielectric"
Shape "sphere" "float radius" 0.7
END
sed 's/Shape "disk"/Shape "disc"/' scene.pbrt >wrong.pbrt

# clean CODE NAME COMMAND...: the program ends with that code, and valgrind has nothing to report (it would end with 99).
clean() {
  local wanted=$1 name=$2
  shift 2
  expect_code "$wanted" "$name" valgrind --quiet --error-exitcode=99 --leak-check=full --show-leak-kinds=definite,indirect \
    --errors-for-leak-kinds=definite,indirect "$VELO" "$@"
}

clean 0 "a render writes images and a film" render scene.pbrt --quiet --spp 2 -t 2 --channels error,Z --film a.film -o a.exr -o a.png
clean 0 "the film is continued" render --quiet --continue a.film --spp 3 -t 2 -o b.exr
"$VELO" render scene.pbrt --quiet --spp 3 --channels error,Z -o whole.exr
same() { cmp -s "$2" "$3" && pass "$1" || fail "$1"; }
clean 0 "a film is merged" film merge a.film a.film -o merged.film
clean 0 "a film is developed" film develop merged.film -o developed.png
clean 3 "a scene with a mistake is refused" render wrong.pbrt --quiet -o wrong.exr
same "the continued image is the straight one" b.exr whole.exr
finish
