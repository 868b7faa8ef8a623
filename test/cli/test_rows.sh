#!/usr/bin/env bash
# Ground truth of rolling shutters through the program: it follows the image's edge, and `velo image check` notices ground truth
# that is not of the rows' times.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
cat >edge.pbrt <<'END'
Camera "pinhole" "point3 eye" [-0.05 0 0] "point3 lookat" [-0.05 0 -1] "point3 eyeclose" [0.05 0 0] "point3 lookatclose" [0.05 0 -1]
  "float fov" 45 "float readout" 0.02 "float shutteropen" 0 "float shutterclose" 0
Film "rgb" "integer xresolution" 96 "integer yresolution" 72
WorldBegin
LightSource "infinite"
AttributeBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [0 -5 -2 5 -5 -2 5 5 -2 0 5 -2] "integer indices" [0 1 2 0 2 3]
AttributeEnd
END
check render "$VELO" render edge.pbrt --channels all -o edge.exr --quiet --spp 64 --filter box
check agrees "$VELO" image check edge.exr
check ids "$VELO" image convert edge.exr ids.pfm --channel id.object.Y
check colors "$VELO" image convert edge.exr colors.pfm --channel R
check edge_of_ids_is_that_of_colors python3 -c '
import array
def rows(name):
    data = array.array("f", open(name, "rb").read().split(b"\n", 3)[3])
    return [data[96 * y:96 * y + 96] for y in range(72)][::-1]
edges = []
for ids, colors in zip(rows("ids.pfm"), rows("colors.pfm")):
    edges.append((96 - sum(ids), 96 - sum(2 * (1 - c) for c in colors)))
assert max(abs(a - b) for a, b in edges) < 0.8 and abs(sum(a - b for a, b in edges)) < 3.6, edges
assert edges[0][0] == 50 and edges[71][0] == 46, edges'
check render_threads "$VELO" render edge.pbrt --channels all -o threads.exr --quiet --spp 64 --filter box -t 3
same same_bytes edge.exr threads.exr
check render_row "$VELO" render edge.pbrt --channels all -o row.exr --quiet --spp 1 --channels-time row
for file in edge row; do
  check "${file}_places" "$VELO" image convert $file.exr $file.pfm --channel P.X
done
same row_is_the_default edge.pfm row.pfm
for direction in up right left; do
  sed "s/\"float readout\"/\"string readoutdirection\" \"$direction\" \"float readout\"/" edge.pbrt >$direction.pbrt
  for mode in centre nearest coverage; do
    check "render_${direction}_$mode" "$VELO" render $direction.pbrt --channels all,crypto -o out.exr --quiet --spp 4 \
      --channels-mode $mode --crop 5,7,90,61
    check "agrees_${direction}_$mode" "$VELO" image check out.exr
  done
done
check render_middle "$VELO" render edge.pbrt --channels all -o middle.exr --quiet --spp 4 --channels-time middle
check middle_agrees "$VELO" image check middle.exr
expect_text says_so 'of one time'
expect_code 1 rows_of_another_time python3 -c '
import subprocess, sys
data = open("middle.exr", "rb").read()
at = data.index(b"velo.channelsTime\0string\0") # a file that says row, and one that does not say
for name, new in (("row", data.replace(b"velo.channelsTime\0string\0\x03\0\0\0one", b"velo.channelsTime\0string\0\x03\0\0\0row")),
                  ("unsaid", data.replace(b"velo.channelsTime\0", b"velo.channelsTimf\0"))):
    assert new != data
    open(name + ".exr", "wb").write(new)
    run = subprocess.run([sys.argv[1], "image", "check", name + ".exr"], capture_output=True, text=True)
    if run.returncode != 1 or ("rows: " if name == "unsaid" else "ray: ") not in run.stderr:
        sys.exit(2)
sys.exit(1)' "$VELO"
finish
