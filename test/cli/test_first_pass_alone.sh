#!/usr/bin/env bash
# The first pass of the Cornell box is on disk within 0.3 s of the program's start.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
need_shared scenes/pbrt/cornell-box/cornell-box.pbrt
if ! is_plain_build; then
  skip first_pass "only of a build without sanitizers"
  exit 0
fi
cat >"$work/first.py" <<'CODE'
import os, signal, subprocess, sys, time
program, scene, image = sys.argv[1:]
part = image.replace(".png", ".part.png")
best = 99
for attempt in range(5):
    if os.path.exists(part):
        os.remove(part)
    start = time.monotonic()
    process = subprocess.Popen([program, "render", scene, "-o", image, "--spp", "16777216", "--quiet"])
    while not os.path.exists(part) and time.monotonic() - start < 10:
        time.sleep(0.002)
    best = min(best, time.monotonic() - start)
    process.send_signal(signal.SIGINT)
    code = process.wait()
    if code != 130:
        sys.exit("exit code %d" % code)
print("%.3f s" % best)
sys.exit(best > 0.3)
CODE
run python3 "$work/first.py" "$VELO" "$shared/scenes/pbrt/cornell-box/cornell-box.pbrt" "$work/first.png"
[ "$code" = 0 ] && pass "first_pass ($out)" || { fail "first_pass (wanted 0.3 s)"; show first; }
finish
