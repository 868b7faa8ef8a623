#!/usr/bin/env bash
# velo render --denoise and velo image denoise: the image itself is unchanged, both make the same copy, wrong uses are
# refused, Open Image Denoise is called as its C interface says (by a library that stands in for it).
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

write_scene room.pbrt
same() { # NAME FILE FILE: the same pixels
  run "$VELO" image diff "$2" "$3" --json
  if printf '%s' "$out" | python3 -c 'import json, sys; assert json.load(sys.stdin)["differing"] == 0'; then pass "$1"; else
    fail "$1"
    show diff
  fi
}

check render "$VELO" render room.pbrt --spp 8 -o plain.exr
check denoise "$VELO" render room.pbrt --spp 8 -o raw.exr --denoise clean.exr
expect_text says_both "raw.exr, clean.exr"
same raw_unchanged plain.exr raw.exr
check channels "$VELO" render room.pbrt --spp 8 --channels error,features -o all.exr
same image_unchanged plain.exr all.exr
check command "$VELO" image denoise all.exr -o later.exr -o later.png -t 1
same both_ways_the_same clean.exr later.exr
check header "$VELO" image info clean.exr
expect_text names_denoiser "velo.denoiser"
check less_error "$VELO" render room.pbrt --spp 512 -o reference.exr
check own "$VELO" render room.pbrt --spp 8 --filter-samples own -o own.exr --denoise own_clean.exr
if python3 - "$VELO" <<'PY'; then pass nearer; else fail nearer; fi
import json, subprocess, sys
def error(name):
    return json.loads(subprocess.run([sys.argv[1], "image", "diff", name, "reference.exr", "--json"], capture_output=True).stdout)["relmse"]
clean, raw, own, own_clean = (error(name + ".exr") for name in ("clean", "raw", "own", "own_clean"))
assert own_clean < own / 2 and clean < own_clean and clean < raw, (clean, raw, own, own_clean)
PY
check crop "$VELO" render room.pbrt --spp 4 --crop 8,4,40,30 -o crop.png --denoise crop_clean.png

# A metered exposure is one for both: of a model with a lamp, and of --exposure auto.
cat >lamp.gltf <<'GLTF'
{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"], "scene": 0, "scenes": [{"nodes": [0, 1]}],
 "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 90}]}},
 "nodes": [{"mesh": 0}, {"rotation": [-0.3, 0.2, 0, 0.93], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
GLTF
for exposure in "" "--exposure auto"; do
  # shellcheck disable=SC2086
  check "metered$exposure" "$VELO" render lamp.gltf --resolution 32x32 --spp 8 $exposure -o raw.png --denoise clean.png
  check "metered_once$exposure" test "$(grep -c 'exposed by' "$work/.err")" = 1
  run "$VELO" image diff raw.png clean.png --json
  if printf '%s' "$out" | python3 -c 'import json, sys; assert 0.98 < json.load(sys.stdin)["meanratio"] < 1.02'; then pass "same_exposure$exposure"; else
    fail "same_exposure$exposure"
    show diff
  fi
done

# Stopped while it denoises: the image is there, no denoised copy is, and none is said to be. A signal before denoising has
# begun only ends the render. Larger images take longer to denoise, so a loaded machine meets one of these times.
for try in "400 .01" "800 .03" "1600 .2" "3200 .5" "6400 1.5"; do
  rm -f stopped.exr stopped_clean.exr
  "$VELO" render room.pbrt -t 1 --resolution ${try% *}x300 --spp 2 -o stopped.exr --denoise stopped_clean.exr >said 2>&1 &
  process=$!
  while [ ! -e stopped.exr ] && kill -0 $process 2>/dev/null; do :; done
  sleep "${try#* }"
  kill -TERM $process 2>/dev/null
  wait $process
  code=$?
  [ -e stopped_clean.exr ] || break
done
check stopped_code test "$code" = 143
check stopped_has_the_image test -s stopped.exr
check stopped_no_copy test ! -e stopped_clean.exr
check stopped_says sh -c 'grep -q "wrote stopped.exr" said && ! grep -q "wrote.*stopped_clean" said && grep -q "before stopped_clean.exr was done" said'

expect_code 2 one_sample "$VELO" render room.pbrt --spp 1 -o a.exr --denoise b.exr
expect_code 2 same_file "$VELO" render room.pbrt --spp 4 -o a.exr --denoise a.exr
expect_code 2 many "$VELO" render room.pbrt --spp 4 -o a.exr --denoise b.exr --stereo parallel
expect_code 2 no_denoise "$VELO" render room.pbrt --spp 4 -o a.exr --denoiser velo
expect_code 2 suffix "$VELO" render room.pbrt --spp 4 -o a.exr --denoise b.jpx
expect_code 2 nowhere "$VELO" image denoise all.exr
expect_code 3 no_errors "$VELO" image denoise plain.exr -o a.exr
expect_text asks_for_errors "channels error"
expect_code 4 no_oidn "$VELO" render room.pbrt --spp 4 -o early.exr --denoise b.exr --denoiser oidn --denoiser-library ./none.so
if [ -e early.exr ]; then fail oidn_before_render; else pass oidn_before_render; fi

# Stands in for Open Image Denoise, version 2: doubles the colour where all is as it must be.
cat >oidn.c <<'C'
#include <stdbool.h>
#include <stddef.h>
#include <string.h>
static struct { float *color, *output, *albedo, *normal; size_t width, height; bool hdr; int commits; } f;
void *oidnNewDevice(int type) { return type == 0 ? &f : NULL; }
void oidnCommitDevice(void *d) { (void)d; f.commits++; }
void oidnReleaseDevice(void *d) { (void)d; }
int oidnGetDeviceError(void *d, const char **message) {
  (void)d;
  *message = "the parameters are wrong";
  return !(f.commits == 2 && f.hdr && f.color && f.output && (!f.albedo) == (!f.normal));
}
void oidnSetDeviceInt(void *d, const char *name, int value) { (void)d, (void)name, (void)value; }
void *oidnNewFilter(void *d, const char *type) { (void)d; return strcmp(type, "RT") == 0 ? &f : NULL; }
void oidnSetSharedFilterImage(void *p, const char *name, void *data, int format, size_t width, size_t height, size_t offset,
                              size_t pixel, size_t row) {
  (void)p;
  if (format != 3 || offset || pixel || row) return;
  f.width = width, f.height = height;
  if (!strcmp(name, "color")) f.color = data;
  if (!strcmp(name, "output")) f.output = data;
  if (!strcmp(name, "albedo")) f.albedo = data;
  if (!strcmp(name, "normal")) f.normal = data;
}
void oidnSetFilterBool(void *p, const char *name, bool value) { (void)p; if (!strcmp(name, "hdr")) f.hdr = value; }
void oidnCommitFilter(void *p) { (void)p; f.commits++; }
void oidnExecuteFilter(void *p) {
  (void)p;
  for (size_t i = 0; i < 3 * f.width * f.height; i++) f.output[i] = 2 * f.color[i];
}
void oidnReleaseFilter(void *p) { (void)p; }
C
if "${CC:-cc}" -shared -fPIC -o stub.so oidn.c && "${CC:-cc}" -shared -fPIC -DoidnExecuteFilter=other -o old.so oidn.c; then
  check oidn "$VELO" image denoise all.exr -o doubled.exr --denoiser oidn --denoiser-library ./stub.so
  run "$VELO" image diff all.exr doubled.exr --json
  if printf '%s' "$out" | python3 -c '
import json, sys
ratio = json.load(sys.stdin)["meanratio"]
assert abs(ratio - 2) < 1e-4 or abs(ratio - 0.5) < 1e-4, ratio'; then pass oidn_result; else fail oidn_result; show diff; fi
  check oidn_render "$VELO" render room.pbrt --spp 2 -o raw2.exr --denoise doubled2.exr --denoiser oidn --denoiser-library ./stub.so
  expect_code 3 oidn_lacks "$VELO" image denoise all.exr -o a.exr --denoiser oidn --denoiser-library ./old.so
  expect_text oidn_lacks_says "oidnExecuteFilter"
fi
finish
