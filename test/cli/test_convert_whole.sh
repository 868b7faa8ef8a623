#!/usr/bin/env bash
# scene convert is all or nothing: whichever call fails, and after kill -9 at any of them, the scene that was there is
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

# The scene file and the bytes of all files that it names, as one text.
contents() {
  cat "$1"
  grep -o '"[^"]*\.\(bin\|png\|jpg\|exr\|ply\)"' "$1" | tr -d '"' | while read -r file; do
    printf '%s\n' "$file"
    cat "$(dirname "$1")/$file" || printf 'missing\n'
  done
}
digest() { contents "$1" 2>/dev/null | LC_ALL=C sed 's/room[-a-z0-9]*\.\(bin\|png\|ply\|exr\)/FILE/g' | md5sum; }

for suffix in gltf pbrt; do
  mkdir "first_$suffix" "second_$suffix" "$suffix"
  "$VELO" scene convert one.pbrt "first_$suffix/room.$suffix" 2>/dev/null
  "$VELO" scene convert two.pbrt "second_$suffix/room.$suffix" 2>/dev/null
  first=$(digest "first_$suffix/room.$suffix") second=$(digest "second_$suffix/room.$suffix")
  [ "$first" != "$second" ] && pass "${suffix}_differ" || fail "${suffix}_differ"
  good=1 failed=0
  for call in rename write sync open link; do
    for k in 1 2 3 4 5 6 7 8; do
      rm -rf "$suffix"
      cp -r "first_$suffix" "$suffix"
      ls "$suffix" >.before
      run env LD_PRELOAD="$library" VELO_FAULT="$call:$k:5" "$VELO" scene convert two.pbrt "$suffix/room.$suffix"
      now=$(digest "$suffix/room.$suffix")
      if [ "$code" = 0 ]; then
        [ "$now" = "$second" ] || { good=0; echo "  $call $k: exit code 0, another scene"; }
      else
        failed=$((failed + 1))
        [ "$now" = "$first" ] || { good=0; echo "  $call $k: exit code $code, the earlier scene is not whole"; }
        ls "$suffix" | cmp -s - .before || { good=0; echo "  $call $k: left $(ls "$suffix" | tr '\n' ' ')"; }
      fi
    done
  done
  [ "$good" = 1 ] && pass "${suffix}_is_all_or_nothing" || fail "${suffix}_is_all_or_nothing"
  [ "$failed" -gt 5 ] && pass "${suffix}_faults_were_met" || fail "${suffix}_faults_were_met ($failed)"

  # The same scene again changes no name; another one, and back, leaves no files behind.
  rm -rf "$suffix"
  cp -r "first_$suffix" "$suffix"
  check "${suffix}_again" "$VELO" scene convert one.pbrt "$suffix/room.$suffix"
  diff -r "first_$suffix" "$suffix" >/dev/null && pass "${suffix}_again_is_the_same" || fail "${suffix}_again_is_the_same"
  count=$(ls "$suffix" | wc -l)
  for scene in two one two; do "$VELO" scene convert $scene.pbrt "$suffix/room.$suffix" 2>/dev/null; done
  [ "$(digest "$suffix/room.$suffix")" = "$second" ] && pass "${suffix}_replaced" || fail "${suffix}_replaced"
  [ "$(ls "$suffix" | wc -l)" = "$count" ] && pass "${suffix}_leaves_nothing" || fail "${suffix}_leaves_nothing ($(ls "$suffix" | tr '\n' ' '))"
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
good=1
for k in 1 2 3 4; do
  rm -rf gltf
  cp -r first_gltf gltf
  run env LD_PRELOAD="$work/stop.so" STOP_AT="$k" "$VELO" scene convert two.pbrt gltf/room.gltf
  now=$(digest gltf/room.gltf)
  [ "$now" = "$(digest first_gltf/room.gltf)" ] || [ "$now" = "$(digest second_gltf/room.gltf)" ] || { good=0; echo "  killed at rename $k"; }
done
[ "$good" = 1 ] && pass killed || fail killed
finish
