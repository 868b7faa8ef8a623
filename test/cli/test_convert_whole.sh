#!/usr/bin/env bash
# scene convert and scene upgrade are all or nothing: whichever call fails, and after kill -9 at any of them, the scene that was there is
# whole with its files, or the new one is. Files that the new scene does not use do not stay.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
library=$work/interpose.so
if ! grep -q '^CMAKE_BUILD_TYPE:.*=Release$' "$VELO_BINARY_DIR/CMakeCache.txt" ||
  ! cc -shared -fPIC -O1 -o "$library" "$VELO_SOURCE_DIR/tools/faults/interpose.c" -ldl 2>/dev/null; then
  skip faults "needs a release build and a C compiler: calls are made to fail"
  exit 77
fi

write_scene plain.pbrt
"$VELO" render plain.pbrt -o wood.png --quiet --spp 1
"$VELO" render plain.pbrt -o stone.png --quiet --spp 1 --resolution 32x32
textured() {
  sed 's/^Texture "checks" .*/Texture "checks" "spectrum" "imagemap" "string filename" "'"$1"'"/; /^  "rgb tex1"/d' plain.pbrt
}
textured wood.png >one.pbrt
textured stone.png | sed 's/Translate 0.7 0.5 0/Translate 0.6 0.5 0/' >two.pbrt

# The same of pbrt-v3: each has a map, an included file, and one that this includes.
mkdir v3 v3/parts
for k in one two; do
  cat >v3/$k.pbrt <<'SCENE'
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
Film "image" "integer xresolution" [ 16 ] "integer yresolution" [ 12 ]
WorldBegin
LightSource "infinite" "string mapname" "sky.png"
Include "parts/outer.pbrt"
WorldEnd
SCENE
done
printf 'Material "matte" "rgb Kd" [ .8 .2 .1 ]\nInclude "inner.pbrt"\n' >v3/parts/outer.pbrt
printf 'Material "mirror" "rgb Kr" [ .8 .8 .8 ]\nShape "sphere"\n' >v3/parts/inner.pbrt
cp v3/parts/inner.pbrt v3/inner.pbrt
cp wood.png v3/sky.png
cp -r v3 other_v3
sed -i 's/40/50/' other_v3/two.pbrt
sed -i 's/.8 .2 .1/.1 .2 .8/' other_v3/parts/outer.pbrt
sed -i 's/.8 .8 .8/.5 .5 .5/' other_v3/parts/inner.pbrt other_v3/inner.pbrt
cp stone.png other_v3/sky.png

# make KIND one|two FILE: the command of the kind.
make() {
  case $1-$2 in
    upgrade-one) set -- scene upgrade --quiet v3/one.pbrt "$3" ;;
    upgrade-two) set -- scene upgrade --quiet other_v3/two.pbrt "$3" ;;
    *) set -- scene convert "$2.pbrt" "$3" ;;
  esac
  "${interposed[@]}" "$VELO" "$@"
}

# The scene file and the bytes of all files that it names, as one text.
contents() {
  cat "$1"
  grep -o '"[^"]*\.\(bin\|png\|jpg\|exr\|ply\|pbrt\)"' "$1" | tr -d '"' | while read -r file; do
    printf '%s\n' "$file"
    case $file in
      *.pbrt) contents "$(dirname "$1")/$file" || printf 'missing\n' ;;
      *) cat "$(dirname "$1")/$file" || printf 'missing\n' ;;
    esac
  done
}
digest() { contents "$1" 2>/dev/null | LC_ALL=C sed 's/\(room\|outer\|inner\|sky\|stone\)[-a-z0-9]*\.\(bin\|png\|ply\|exr\|pbrt\)/FILE/g' | md5sum; }
names() { (cd "$1" && find . | LC_ALL=C sort); }

for kind in gltf pbrt upgrade; do
  suffix=${kind/upgrade/pbrt} interposed=()
  mkdir "first_$kind" "second_$kind" "$kind"
  make $kind one "first_$kind/room.$suffix" 2>/dev/null
  make $kind two "second_$kind/room.$suffix" 2>/dev/null
  first=$(digest "first_$kind/room.$suffix") second=$(digest "second_$kind/room.$suffix")
  [ "$first" != "$second" ] && pass "${kind}_differ" || fail "${kind}_differ"
  good=1 failed=0
  for call in rename write sync open link; do
    for k in 1 2 3 4 5 6 7 8; do
      rm -rf "$kind"
      cp -r "first_$kind" "$kind"
      names "$kind" >.before
      interposed=(env LD_PRELOAD="$library" VELO_FAULT="$call:$k:5")
      run make $kind two "$kind/room.$suffix"
      now=$(digest "$kind/room.$suffix")
      if [ "$code" = 0 ]; then
        [ "$now" = "$second" ] || { good=0; echo "  $call $k: exit code 0, another scene"; }
      else
        failed=$((failed + 1))
        [ "$now" = "$first" ] || { good=0; echo "  $call $k: exit code $code, the earlier scene is not whole"; }
        names "$kind" | cmp -s - .before || { good=0; echo "  $call $k: left $(names "$kind" | tr '\n' ' ')"; }
      fi
    done
  done
  [ "$good" = 1 ] && pass "${kind}_is_all_or_nothing" || fail "${kind}_is_all_or_nothing"
  [ "$failed" -gt 5 ] && pass "${kind}_faults_were_met" || fail "${kind}_faults_were_met ($failed)"

  interposed=()
  # The same scene again changes no name; another one, and back, leaves no files behind.
  rm -rf "$kind"
  cp -r "first_$kind" "$kind"
  check "${kind}_again" make $kind one "$kind/room.$suffix"
  diff -r "first_$kind" "$kind" >/dev/null && pass "${kind}_again_is_the_same" || fail "${kind}_again_is_the_same"
  count=$(names "$kind" | wc -l)
  for scene in two one two; do make $kind $scene "$kind/room.$suffix" 2>/dev/null; done
  [ "$(digest "$kind/room.$suffix")" = "$second" ] && pass "${kind}_replaced" || fail "${kind}_replaced"
  [ "$(names "$kind" | wc -l)" = "$count" ] && pass "${kind}_leaves_nothing" || fail "${kind}_leaves_nothing ($(names "$kind" | tr '\n' ' '))"
done

# A stranger's file of that name stays.
mkdir strange
printf 'mine' >strange/room.bin
check stranger "$VELO" scene convert one.pbrt strange/room.gltf
[ "$(cat strange/room.bin)" = mine ] && grep -q '"room-2.bin"' strange/room.gltf && pass strangers_file_stays || fail strangers_file_stays

# Killed while it replaces: the earlier scene or the new one is whole.
cat >stop.c <<'C'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
int rename(const char *from, const char *to) {
  static int calls;
  int (*next)(const char *, const char *);
  *(void **)&next = dlsym(RTLD_NEXT, "rename");
  if (++calls == atoi(getenv("STOP_AT"))) raise(SIGKILL);
  return next(from, to);
}
C
cc -shared -fPIC -o stop.so stop.c -ldl
for kind in gltf upgrade; do
  good=1 suffix=${kind/upgrade/pbrt}
  for k in 1 2 3 4 5; do
    rm -rf $kind
    cp -r first_$kind $kind
    interposed=(env LD_PRELOAD="$work/stop.so" STOP_AT="$k")
    run make $kind two $kind/room.$suffix
    now=$(digest $kind/room.$suffix)
    [ "$now" = "$(digest first_$kind/room.$suffix)" ] || [ "$now" = "$(digest second_$kind/room.$suffix)" ] || { good=0; echo "  killed at rename $k"; }
  done
  [ "$good" = 1 ] && pass ${kind}_killed || fail ${kind}_killed
done
finish
