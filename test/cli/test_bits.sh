#!/usr/bin/env bash
# Portable bits: each instruction set of Embree that `portable` allows gives the same image in difficult cases: coplanar
# surfaces, edges, instances, motion, curves, quadrics, shadows. A very small or large scene gives the image of size 1.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1

# Sheets of the same plane, cut into triangles in other ways and of other colours; a fan of edges that meet in a point;
# the same sheets again in an instance, in a moving one, and with alpha.
python3 - >scene.pbrt <<'END'
import math
def sheet(n, shift):
    p, index = [], []
    for i in range(n + 1):
        for j in range(n + 1):
            x, z = 2.0 * i / n - 1 + shift, 2.0 * j / n - 1
            p += [x, 0.25 * x + 0.125 * z, z]
    for i in range(n):
        for j in range(n):
            a = i * (n + 1) + j
            index += [a, a + 1, a + n + 2, a, a + n + 2, a + n + 1]
    return 'Shape "trianglemesh" "point3 P" [%s] "integer indices" [%s]' % (
        " ".join("%.9g" % x for x in p), " ".join(map(str, index)))
def fan(n):
    p, index = [0, 0.5, 0], []
    for i in range(n):
        a = 2 * math.pi * i / n
        p += [math.cos(a), 0.1 * (i % 3), math.sin(a)]
        index += [0, 1 + i, 1 + (i + 1) % n]
    return 'Shape "trianglemesh" "point3 P" [%s] "integer indices" [%s]' % (
        " ".join("%.9g" % x for x in p), " ".join(map(str, index)))
def sheets(colors):
    for n, color in zip((3, 5, 7), colors):
        print('Material "diffuse" "rgb reflectance" [%s]' % color)
        print(sheet(n, 0.0625 * (n - 3)))
print('''LookAt 0.3 2.5 5  0 0.2 0  0 1 0
Camera "perspective" "float fov" [45] "float shutteropen" [0] "float shutterclose" [1]
Film "rgb" "integer xresolution" [160] "integer yresolution" [120]
Sampler "zsobol" "integer pixelsamples" [4]
WorldBegin
LightSource "distant" "point3 from" [1 3 2] "rgb L" [2 2 2]
LightSource "infinite" "rgb L" [0.3 0.3 0.4]
Texture "holes" "float" "checkerboard" "float uscale" [9] "float vscale" [9] "float tex1" [1] "float tex2" [0.5]
ObjectBegin "sheets"''')
sheets(("0.8 0.2 0.2", "0.2 0.8 0.2", "0.2 0.2 0.8"))
print('Shape "curve" "point3 P" [-1 0.4 0  -0.4 1 0.2  0.4 0.2 -0.2  1 0.6 0] "float width" [0.05]\nObjectEnd')
sheets(("0.9 0.5 0.1", "0.1 0.9 0.5", "0.5 0.1 0.9"))
print('AttributeBegin\nTranslate -1.5 0.6 1\nRotate 31 1 2 3\nScale 0.7 0.9 0.8\nObjectInstance "sheets"\nAttributeEnd')
print('AttributeBegin\nActiveTransform EndTime\nTranslate 0.2 0.3 0\nRotate 20 0 1 0\nActiveTransform All')
print('Translate 1.5 0.9 0.5\nScale 0.6 0.6 0.6\nObjectInstance "sheets"\nAttributeEnd')
print('AttributeBegin\nTranslate 0 1.2 -1\nScale 1.5 1 1.5\n' + fan(17) + '\n' + fan(23) + '\nAttributeEnd')
print('AttributeBegin\nTranslate 0.2 0.05 0.1\nMaterial "diffuse" "rgb reflectance" [1 1 0]')
print(sheet(4, 0).replace('"trianglemesh"', '"trianglemesh" "texture alpha" "holes"') + '\nAttributeEnd')
for x in (0, 0.4, 0.8):
    print('AttributeBegin\nTranslate %g 0.5 1.5\nShape "sphere" "float radius" [0.3]' % x)
    print('Shape "sphere" "float radius" [0.3]\nShape "disk" "float radius" [0.5]\nShape "disk" "float radius" [0.4]\nAttributeEnd')
END

has_embree=false
"$VELO" render scene.pbrt --accelerator embree --dry-run --quiet >out.txt 2>&1 && has_embree=true
sets=
for set in sse4.2 avx avx2 avx512; do
  $has_embree || break
  VELO_EMBREE=$set "$VELO" render scene.pbrt --bits fast --dry-run --quiet >out.txt 2>&1 && sets="$sets $set"
done
render() { "$VELO" render scene.pbrt --quiet "$@"; }
for tracer in path bidirectional merging raycast; do
  check "$tracer" render --tracer $tracer -t 1 -o one.pfm
  for set in sse4.2 avx; do
    case "$sets " in *" $set "*) ;; *) skip "${tracer}_$set" "this machine does not have it" && continue ;; esac
    VELO_EMBREE=$set check "${tracer}_${set}_renders" render --tracer $tracer -t 2 --isa base -o set.pfm
    same "${tracer}_$set" one.pfm set.pfm
  done
done
# velo's own tree gives the same image; Embree's packets and the order of rays do not matter, either.
for tracer in path bidirectional merging raycast; do
  check "${tracer}_embree" render --tracer $tracer -t 1 -o one.pfm
  for isa in base v3; do
    run "$VELO" render scene.pbrt --quiet --tracer $tracer -t 2 --isa $isa --accelerator bvh -o tree.pfm
    [ "$code" = 0 ] || { skip "${tracer}_bvh_$isa" "this machine does not have it" && continue; }
    same "${tracer}_bvh_$isa" one.pfm tree.pfm
  done
done
# Films of both continue and merge with each other, and the receipt does not name the choice.
check straight render --spp 4 -o straight.exr
check film_embree render --spp 2 --film f.film
check film_bvh "$VELO" render --continue f.film --spp 4 --accelerator bvh -o continued.exr --quiet
same film_of_both straight.exr continued.exr
check first_half render --spp 4 --samples 0:2 --film a.film
check second_half render --spp 4 --samples 2:4 --film b.film --accelerator bvh
check merged "$VELO" film merge a.film b.film -o ab.film
check merged_image "$VELO" film develop ab.film -o merged.exr
same merged_of_both straight.exr merged.exr
check again "$VELO" render --again straight.exr --accelerator bvh -o again.exr --quiet
same again_by_bvh straight.exr again.exr
check receipt_bvh render --spp 2 --accelerator bvh -o bvh.exr
run "$VELO" image info --json bvh.exr
case "$out" in *accelerator*) fail receipt_is_silent ;; *velo*) pass receipt_is_silent ;; *) fail receipt_is_there ;; esac
# With fast bits it does.
check fast_bvh render --bits fast --accelerator bvh -o fast_bvh.exr
run "$VELO" image info --json fast_bvh.exr
expect_text fast_receipt_names_it 'accelerator\":\"bvh\"'
check fast_again "$VELO" render --again fast_bvh.exr -o fast_again.exr --quiet
same fast_bvh_again fast_bvh.exr fast_again.exr
expect_code 2 unknown_accelerator render --accelerator kdtree -o x.exr

# Which rays are in a packet together does not matter.
check whole render -o whole.pfm
check crop render --crop 35,17,118,97 -o part.pfm
check cut "$VELO" image convert whole.pfm cut.pfm --crop 35,17,118,97
same crop_is_a_cut part.pfm cut.pfm

# The scene is hard: without velo's rule the sets differ.
case "$sets " in
  *" avx "*)
    VELO_EMBREE=sse4.2 check fast_sse render --bits fast -o sse.pfm
    VELO_EMBREE=avx check fast_avx render --bits fast -o avx.pfm
    if cmp -s sse.pfm avx.pfm; then fail fast_differs; else pass fast_differs; fi
    ;;
  *) skip fast_differs "this machine has one set" ;;
esac
for set in $sets; do VELO_EMBREE=$set check "fast_$set" render --bits fast -o fast.pfm; done

# The header names the choice. Sets that do not fit it are errors.
check header render -o whole.exr
run "$VELO" image info whole.exr
expect_text header_portable 'portable'
check header_fast_renders render --bits fast -o fast.exr
run "$VELO" image info fast.exr
expect_text header_fast 'velo.bits'
if $has_embree; then
  VELO_EMBREE=avx2 expect_code 3 fused_is_refused render -o x.exr
  expect_line fused_says 'portable bits need'
  VELO_EMBREE=mmx expect_code 3 unknown_set render -o x.exr
  expect_line unknown_set_says 'mmx'
else
  expect_code 3 embree_is_refused render --accelerator embree -o x.exr
  expect_line refusal_says 'use bvh'
fi
expect_code 2 unknown_bits render --bits best -o x.exr

# A ball of SCALE, a power of two: the same image to the last bit.
ball() { # FILE SCALE mesh|instance
  python3 - "$2" "$3" >"$1" <<'END'
import math, sys
s, kind, n, p, index = float(sys.argv[1]), sys.argv[2], 16, [], []
f32 = lambda x: round(x * 65536) / 65536
for i in range(n + 1):
    for j in range(2 * n):
        a, b = math.pi * i / n, math.pi * j / n
        p += [f32(math.sin(a) * math.cos(b)), f32(math.sin(a) * math.sin(b)), f32(math.cos(a))]
for i in range(n):
    for j in range(2 * n):
        a, b = i * 2 * n + j, i * 2 * n + (j + 1) % (2 * n)
        index += [a, b, a + 2 * n, b, b + 2 * n, a + 2 * n]
k = s if kind == "mesh" else 1
shape = 'Shape "trianglemesh" "point3 P" [%s] "integer indices" [%s]' % (
    " ".join("%.17g" % (k * x) for x in p), " ".join(map(str, index)))
print('LookAt %.17g 0 0  0 0 0  0 0 1\nCamera "perspective" "float fov" [50]' % (-4 * s))
print('Film "rgb" "integer xresolution" [32] "integer yresolution" [32]\nSampler "zsobol" "integer pixelsamples" [4]')
print('WorldBegin\nLightSource "infinite" "rgb L" [1 1 1]\nMaterial "diffuse" "rgb reflectance" [0.5 0.4 0.3]')
if kind == "mesh":
    print(shape)
else:
    print('ObjectBegin "ball"\n%s\nObjectEnd\nScale %.17g %.17g %.17g\nObjectInstance "ball"' % (shape, s, s, s))
END
}
for kind in mesh instance; do
  ball ball.pbrt 1 $kind
  check "ball_$kind" "$VELO" render ball.pbrt --quiet -o ball.pfm
  for scale in 9.313225746154785e-10 1073741824 1099511627776; do # 2 to the power of -30, 30, 40
    ball scaled.pbrt $scale $kind
    check "ball_${kind}_$scale" "$VELO" render scaled.pbrt --quiet -o scaled.pfm
    same "ball_${kind}_${scale}_same" ball.pfm scaled.pfm
  done
done
# Outside the range of docs/conventions.md there is a warning.
for kind in mesh instance; do
  ball tiny.pbrt 9.094947017729282e-13 $kind # 2^-40
  check "tiny_$kind" "$VELO" render tiny.pbrt --quiet -o tiny.pfm
  expect_text "tiny_${kind}_warns" 'triangles of about'
done
finish
