# Real scenes against converged images of another renderer, by the measure beside those images
# (../shared/references): the mean of the whole image and of 8 x 8 blocks at 64 samples, nothing that is not finite.
. "$VELO_SOURCE_DIR/test/harness.sh"
need_shared references/scenes.txt
need_shared scenes/pbrt
if ! /usr/bin/python3 -c 'import OpenImageIO' 2>/dev/null; then
  skip references "python3-openimageio is not installed (script/bootstrap judges)"
  finish
fi

# Those that velo understands in full; the others of the list need media or caustics.
for wanted in cornell-box veach-mis coffee material-testball killeroo-gold teapot killeroo-simple pbrt-cornell-box; do
  line=$(grep "^$wanted|" "$shared/references/scenes.txt")
  IFS='|' read -r name file resolution mean_tolerance block_tolerance <<<"$line"
  run "$VELO" render "$shared/scenes/pbrt/$file" --resolution "$resolution" --spp 64 --quiet -o "$work/$name.exr"
  if [ "$code" != 0 ]; then
    fail "$name renders"
    show "velo render $file"
    continue
  fi
  run /usr/bin/python3 "$shared/references/compare.py" "$work/$name.exr" "$shared/references/$name.exr" --json
  cp "$work/.out" "$work/$name.json"
  if verdict=$(/usr/bin/python3 - "$work/$name.json" "$mean_tolerance" "$block_tolerance" <<'END'
import json
import sys

result = json.load(open(sys.argv[1]))
mean, block, bad = result["mean_ratio"], result["block_mean"], result["not_finite"]
print("mean ratio %.4f (+- %s), block error %.4f (%s), not finite %d" % (mean, sys.argv[2], block, sys.argv[3], bad))
sys.exit(0 if abs(mean - 1) <= float(sys.argv[2]) and block <= float(sys.argv[3]) and bad == 0 else 1)
END
  ); then pass "$name: $verdict"; else fail "$name: $verdict"; fi
done
finish
