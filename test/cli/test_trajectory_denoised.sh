#!/usr/bin/env bash
# Denoised frames of a trajectory: each uses up to five before it, so that what is left of the noise flickers less. The
# bits depend neither on the division of the frames nor on the number of threads.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/cli/common.sh"
cd "$work" || exit 1
# The still parts look the same from all sides: what differs there is noise. A ball moves in one second.
write_round_scene round.pbrt
{
  cat round.pbrt
  cat <<'END'
AttributeBegin
  Material "diffuse" "rgb reflectance" [0.7 0.2 0.2]
  ActiveTransform EndTime
  Translate 0 0 0.4
  ActiveTransform All
  Translate 1.2 0.4 0
  Shape "sphere" "float radius" 0.4
AttributeEnd
END
} >moving.pbrt
python3 - <<'END'
import math
columns = "name,eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z"
with open("turn.csv", "w") as turn, open("times.csv", "w") as times:
    print(columns, file=turn)
    print(columns + ",time", file=times)
    for k in range(9):
        a = math.radians(5 * k)
        pose = f"p{k},{5 * math.sin(a):.9f},2.2,{5 * math.cos(a):.9f},0,0.4,0"
        print(pose, file=turn)
        print(f"{pose},{k / 10}", file=times)
END
turn="--trajectory turn.csv --quiet"
check all "$VELO" render round.pbrt $turn -t 2 -o f%d.pfm --denoise c%d.pfm
check all_frames test "$(ls f*.pfm c*.pfm | wc -l)" = 18
check raw "$VELO" render round.pbrt $turn --frames 5 -o r%d.pfm
same raw_same f5.pfm r5.pfm
check part "$VELO" render round.pbrt $turn --frames 0-8:4 -t 1 -o p%d.pfm --denoise d%d.pfm
check part_alone test "$(ls p*.pfm d*.pfm | wc -l)" = 6
for n in 0 4 8; do
  same "part_${n}_same" d$n.pfm c$n.pfm
  same "part_raw_${n}_same" p$n.pfm f$n.pfm
done
check shard "$VELO" render round.pbrt $turn --shard 2/2 -o s%d.pfm --denoise t%d.pfm
same shard_same t7.pfm c7.pfm
cp c7.pfm kept.pfm
rm c7.pfm
check skip "$VELO" render round.pbrt $turn -o f%d.pfm --denoise c%d.pfm --skip-existing
same skip_same c7.pfm kept.pfm

check errors "$VELO" render round.pbrt $turn --frames 6-8 -o e%d.exr --channels error,features
for n in 6 7 8; do
  check "one_$n" "$VELO" image denoise e$n.exr -o n$n.pfm
done
check flickers_less below "$(mse c7.pfm c8.pfm)" "$(mse n7.pfm n8.pfm)" 0.25
check reference "$VELO" render round.pbrt --spp 1024 --quiet -o reference.pfm
check nearer below "$(mse c8.pfm reference.pfm)" "$(mse n8.pfm reference.pfm)" 1

# What moves leaves no trail, nor does its shadow: the image is as near to the truth as one that is denoised by itself.
times="--trajectory times.csv --frames 8 --quiet"
check moving "$VELO" render moving.pbrt $times -o m%d.exr --channels error,features --denoise mc%d.pfm
check moving_one "$VELO" image denoise m8.exr -o mn8.pfm
check moving_truth "$VELO" render moving.pbrt $times --spp 1024 -o mt%d.pfm
check moving_near below "$(mse mc8.pfm mt8.pfm)" "$(mse mn8.pfm mt8.pfm)" 1.1

# Nor do reflections, which stay in place while the surface passes below them.
cat >shiny.pbrt <<'END'
LookAt 0 2.2 5  0 0.6 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 96 "integer yresolution" 72
Sampler "zsobol" "integer pixelsamples" 8
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.35 0.4]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [8 7 6]
  Shape "trianglemesh" "point3 P" [-1 4 -1  1 4 -1  1 4 1  -1 4 1] "integer indices" [0 1 2  0 2 3]
AttributeEnd
Texture "checks" "spectrum" "checkerboard" "float uscale" 12 "float vscale" 12 "rgb tex1" [0.8 0.7 0.6] "rgb tex2" [0.2 0.1 0.1]
Material "diffuse" "texture reflectance" "checks"
Shape "bilinearmesh" "point3 P" [-6 0 -6  6 0 -6  -6 0 6  6 0 6]
AttributeBegin
  Translate 0 0.9 0
  Material "conductor" "float roughness" 0.05
  Shape "sphere" "float radius" 0.9
AttributeEnd
END
shiny="shiny.pbrt --trajectory turn.csv --frames 8 --quiet"
check shiny "$VELO" render $shiny -o g%d.exr --channels error,features --denoise gc%d.pfm
check shiny_one "$VELO" image denoise g8.exr -o gn8.pfm
check shiny_truth "$VELO" render $shiny --spp 512 -o gt%d.pfm
check shiny_near below "$(mse gc8.pfm gt8.pfm)" "$(mse gn8.pfm gt8.pfm)" 1.4

check display "$VELO" render round.pbrt $turn --frames 0-1 --exposure auto -o f%d.png --denoise %n.png
check display_named test -s p1.png
check dry "$VELO" render round.pbrt $turn --dry-run -o f%d.pfm --denoise c%d.pfm
expect_code 2 no_number "$VELO" render round.pbrt $turn -o f%d.pfm --denoise c.pfm
expect_text no_number_says 'two of the 9 frames would be "c.pfm"'
expect_code 2 same_name "$VELO" render round.pbrt $turn -o f%d.pfm --denoise f%d.pfm
expect_code 2 same_file "$VELO" render round.pbrt $turn -o f%d.pfm --denoise f%01d.pfm
expect_code 2 oidn "$VELO" render round.pbrt $turn -o f%d.pfm --denoise c%d.pfm --denoiser oidn
expect_text oidn_says "velo's own denoiser"
expect_code 2 rig "$VELO" render round.pbrt $turn --rig turn.csv -o f%d-%c.pfm --denoise c%d-%c.pfm
expect_code 2 eyes "$VELO" render round.pbrt $turn --stereo parallel -o f%d-%v.pfm --denoise c%d-%v.pfm
expect_code 2 metered "$VELO" render round.pbrt $turn --shard 1/2 --exposure auto -o f%d.pfm --denoise c%d.png
finish
