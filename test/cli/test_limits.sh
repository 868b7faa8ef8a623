#!/usr/bin/env bash
# What a scene may not do to who renders it: take all memory, hang, read files elsewhere, print what they hold. And what
# it costs to know: memory is reckoned before the render, --time is kept, headers are read alone.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
V=$VELO

# refused CODE NAME TEXT COMMAND...: exit code, one line with TEXT.
refused() {
  local wanted=$1 name=$2 text=$3
  shift 3
  run timeout 20 "$@"
  if [ "$code" = "$wanted" ] && [ "$(printf '%s\n' "$err" | wc -l)" = 1 ] && [[ $err == "velo: "*"$text"* ]]; then
    pass "$name"
  else
    fail "$name (wanted exit code $wanted and one line with: $text)"
    show "$*"
  fi
}

# ---- memory ----------------------------------------------------------------------------------------------------------
long="--spp 16777216 --quiet -o a.exr"
refused 1 too_large_for_the_limit 'film 132 MB' "$V" render scene.pbrt --resolution 1000x1000 --max-memory 100M $long
refused 1 limit_in_other_units 'film 132 MB' "$V" render scene.pbrt --resolution 1000x1000 --max-memory 100MiB $long
refused 1 truth_is_reckoned 'ground truth' "$V" render scene.pbrt --resolution 300x300 --channels all,crypto --max-memory 30M $long
refused 1 second_render_is_reckoned 'ground truth 1' "$V" render scene.pbrt --resolution 1000x1000 --channels illuminance --max-memory 100M $long
refused 1 trajectory_is_reckoned 'out of memory: this needs' "$V" render scene.pbrt --stereo parallel --resolution 1000x1000 --max-memory 100M $long
refused 1 too_large_for_the_process 'the process may have' bash -c "ulimit -v 500000; exec \"\$0\" \"\$@\"" "$V" render scene.pbrt -t 2 --resolution 2000x2000 $long
refused 1 building_is_limited '--max-memory allows' "$V" render scene.pbrt --max-memory 1k $long
refused 2 size_that_is_none 'must be a size' "$V" render scene.pbrt --max-memory 12parsecs
check inside_the_limit "$V" render scene.pbrt --max-memory 200M --quiet -o a.exr
run "$V" render scene.pbrt --resolution 600x600 --spp 2 --channels all --log-json -o a.exr
if printf '%s\n' "$err" | python3 -c '
import json, sys
lines = [json.loads(line) for line in sys.stdin]
plan = next(line for line in lines if line["event"] == "memory")
result = lines[-1]
assert plan["film"] > 40e6 and plan["total"] == result["memory_needed"], plan
assert 0.4 * result["memory_peak"] < result["memory_needed"] < 2.5 * result["memory_peak"], result'; then pass memory_in_json; else fail memory_in_json; show json; fi
run "$V" render scene.pbrt --spp 1 -v -o a.exr
expect_text memory_in_notes 'memory: '
expect_text peak_in_notes 'at most, '

# Whatever the process may have, it ends with an image or with one line.
wrong=
for kilobytes in 90000 150000 180000 205000 210000 220000 250000 300000; do
  run bash -c "ulimit -v $kilobytes; exec \"\$0\" \"\$@\"" "$V" render scene.pbrt --resolution 300x300 --spp 1 --quiet -o limit.exr
  [ "$code" = 0 ] || { [ "$code" = 1 ] && [ "$(printf '%s\n' "$err" | wc -l)" = 1 ]; } || wrong="$wrong $kilobytes:$code"
done
[ -z "$wrong" ] && pass limits_of_the_process || fail "limits_of_the_process ($wrong)"
[ -z "$(find . -name '*.tmp')" ] && pass no_temporary_files || fail no_temporary_files

python3 - <<'PY'
import struct, zlib
def png(name, width, height):
    row = b"\0" + bytes((width + 7) // 8)
    pack = zlib.compressobj(9)
    data = b"".join(pack.compress(row) for _ in range(height)) + pack.flush()
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(name, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0)) + chunk(b"IDAT", data) + chunk(b"IEND", b""))
png("bomb.png", 30000, 20000)
png("wide.png", 3000, 2000)
PY
texture() {
  printf '%s\n' 'Camera "perspective"' 'WorldBegin' "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"$1\"" \
    'Material "diffuse" "texture reflectance" "t"' 'Shape "sphere"'
}
texture bomb.png >bomb.pbrt
refused 3 pixel_budget '30000x20000 pixels, more than' "$V" render bomb.pbrt $long
texture wide.png >wide.pbrt
refused 3 own_pixel_budget '3000x2000 pixels, more than the 5000000' "$V" render wide.pbrt --max-texture-pixels 5000000 $long
check within_the_budget "$V" render wide.pbrt --max-texture-pixels 6000000 --spp 1 --resolution 8x8 --quiet -o a.exr
run_measured "$V" image info bomb.png
[ "$code" = 0 ] && [[ $out == *"30000 x 20000"* ]] && pass header_alone || { fail header_alone; show info; }
if is_plain_build; then
  [ "$kilobytes" -lt 40000 ] && pass header_alone_in_little_memory || fail "header_alone_in_little_memory ($kilobytes KB)"
fi
for suffix in exr png jpg hdr pfm tga; do
  "$V" render scene.pbrt --spp 1 --quiet -o "format.$suffix"
  run "$V" image info "format.$suffix"
  [[ $out == *"64 x 48"* ]] && pass "header_of_$suffix" || { fail "header_of_$suffix"; show info; }
done

run bash -c '"$0" image info <(cat format.exr)' "$V"
[[ $out == *"64 x 48"* ]] && pass header_of_a_pipe || { fail header_of_a_pipe; show info; }

# ---- files that never end --------------------------------------------------------------------------------------------
mkfifo pipe
python3 -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket")'
ln -s /dev/zero device
for kind in pipe socket device; do
  texture $kind >named.pbrt
  refused 5 "texture_is_a_$kind" "is a $kind" "$V" render named.pbrt $long
  printf '%s\n' 'Camera "perspective"' 'WorldBegin' "Shape \"plymesh\" \"string filename\" \"$kind\"" >named.pbrt
  refused 5 "mesh_is_a_$kind" "is a $kind" "$V" render named.pbrt $long
  printf '%s\n' 'Camera "perspective"' 'WorldBegin' "Include \"$kind\"" >named.pbrt
  refused 5 "include_is_a_$kind" "named.pbrt:3:9: cannot read $kind: is a $kind" "$V" render named.pbrt $long
  printf '{"asset":{"version":"2.0"},"buffers":[{"uri":"%s","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0}' $kind >named.gltf
  refused 5 "buffer_is_a_$kind" "is a $kind" "$V" render named.gltf $long
done
mkfifo given.pbrt
cat scene.pbrt >given.pbrt &
run "$V" render given.pbrt --spp 1 --quiet -o given.exr
[ "$code" = 0 ] && [ -s given.exr ] && pass a_pipe_that_is_given_is_read || { fail a_pipe_that_is_given_is_read; show pipe; }

# ---- a sandbox -------------------------------------------------------------------------------------------------------
mkdir box elsewhere
cp wide.png box/in.png
cp wide.png elsewhere/out.png
ln -s ../elsewhere/out.png box/link.png
ln -s ../box/in.png elsewhere/back.png
ln -s box/in.png back.png
cd box || exit 1
small="--spp 1 --resolution 8x8 --quiet -o ../a.exr"
for name in in.png ../elsewhere/out.png link.png "$work/elsewhere/out.png" ../back.png; do texture "$name" >"$(basename "$name").pbrt"; done
check sandbox_inside "$V" render in.png.pbrt --sandbox . $small
check sandbox_link_that_leads_inside "$V" render back.png.pbrt --sandbox . $small
refused 5 sandbox_outside 'outside of the sandbox' "$V" render out.png.pbrt --sandbox . $small
refused 5 sandbox_link 'outside of the sandbox' "$V" render link.png.pbrt --sandbox . $small
check sandbox_two_folders "$V" render out.png.pbrt --sandbox . --sandbox ../elsewhere $small
check no_sandbox "$V" render link.png.pbrt $small
printf '%s\n' 'Camera "perspective"' 'WorldBegin' 'Include "/etc/passwd"' >include.pbrt
refused 5 sandbox_include 'outside of the sandbox' "$V" render include.pbrt --sandbox . $small

# What there is outside changes neither message nor exit code: a file, none, a folder, a link or a folder on the way.
# told FILE: exit code and message for it, with NAME for the name.
told() {
  run "$V" "${@:2}" --sandbox .
  printf '%s %s' "$code" "${err//"$1"/NAME}" | grep -v 'the system confines velo'
}
wanted=
for name in ../elsewhere/out.png ../elsewhere/otu.png ../elsewhere ../nowhere/out.png ../elsewhere/../back.png \
  ../nowhere/../back.png ../elsewhere/back.png ../elsewhere/none.png /etc/passwd /etc/nothing /nothing/nothing; do
  texture "$name" >outside.pbrt
  printf '%s\n' 'Camera "perspective"' 'WorldBegin' "Include \"$name\"" >included.pbrt
  printf '%s\n' "mtllib outside.mtl" "v 0 0 0" "v 1 0 0" "v 0 1 0" "vt 0 0" "usemtl a" "f 1/1 2/1 3/1" >outside.obj
  printf '%s\n' "newmtl a" "map_Kd $name" >outside.mtl
  printf '{"asset":{"version":"2.0"},"images":[{"uri":"%s"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"buffers":[{"uri":"%s","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0}' "$name" data:application/octet-stream\;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA >outside.gltf
  now=
  for file in outside.pbrt included.pbrt outside.obj outside.gltf; do
    now+="$file: $(told "$name" render $file $small)"$'\n'
    now+="$file: $(told "$name" scene check $file)"$'\n'
  done
  [ -n "$wanted" ] || wanted=$now
  [ "$now" = "$wanted" ] && pass "sandbox_tells_nothing_of_$name" || { fail "sandbox_tells_nothing_of_$name"; diff <(echo "$wanted") <(echo "$now"); }
done
[[ $wanted == "outside.pbrt: 5 "*"NAME: it lies outside of the sandbox"* ]] && pass sandbox_says_outside || { fail sandbox_says_outside; echo "$wanted"; }
# A scene outside the sandbox may name files in it by a relative path.
texture ../box/in.png >../elsewhere/scene.pbrt
check sandbox_of_a_scene_outside "$V" render ../elsewhere/scene.pbrt --sandbox . $small
texture ../elsewhere/out.png >../elsewhere/scene.pbrt
refused 5 sandbox_does_not_hold_its_folder 'outside of the sandbox' "$V" render ../elsewhere/scene.pbrt --sandbox . $small
texture ni.png >missing.pbrt
refused 4 sandbox_missing_inside '"in.png"' "$V" render missing.pbrt --sandbox . $small
refused 4 sandbox_that_is_none 'no such folder' "$V" render in.png.pbrt --sandbox nowhere $small
for command in 'scene check' 'scene info'; do
  run "$V" $command include.pbrt --sandbox .
  [ "$code" = 5 ] && pass "sandbox_$command" || { fail "sandbox_$command"; show "$command"; }
done
run "$V" scene convert link.png.pbrt ../converted.gltf --sandbox .
[ "$code" = 5 ] && [[ $err == *'outside of the sandbox'* ]] && pass sandbox_convert || { fail sandbox_convert; show convert; }
check sandbox_convert_elsewhere "$V" scene convert in.png.pbrt ../converted.pbrt --sandbox .
check sandbox_convert_to_gltf "$V" scene convert ../scene.pbrt ../converted.gltf --sandbox .

# The operating system confines the program, too (test/base/test_confine.c); what a render needs works.
small="--spp 1 --resolution 8x8"
confined='the system confines velo'
run "$V" render in.png.pbrt --sandbox . $small -o ../confined.exr
[ "$code" = 0 ] && [[ $err == *"--sandbox: "* ]] && pass sandbox_says_how || { fail sandbox_says_how; show confined; }
if [[ $err == *"$confined"* ]]; then
  mkfifo hold.pbrt
  "$V" render hold.pbrt --sandbox . $small --quiet -o ../held.exr &
  child=$!
  confined_child() { grep -q '^Seccomp:[[:space:]]*2' /proc/$child/status && grep -q '^NoNewPrivs:[[:space:]]*1' /proc/$child/status; }
  for _ in $(seq 100); do confined_child && break || sleep 0.05; done
  confined_child && pass sandbox_of_the_system || fail sandbox_of_the_system
  timeout 20 cp in.png.pbrt hold.pbrt
  wait $child && pass sandbox_reads_a_pipe || fail sandbox_reads_a_pipe
else
  skip sandbox_of_the_system "this system has neither Landlock nor seccomp"
fi
run "$V" render in.png.pbrt --sandbox . $small --quiet -o ../confined.exr
[ "$code" = 0 ] && [ -z "$err" ] && pass sandbox_is_quiet || { fail sandbox_is_quiet; show quiet; }
check sandbox_film "$V" render in.png.pbrt --sandbox . $small --film ../confined.film -o ../confined.png
check sandbox_continue "$V" render --continue ../confined.film --sandbox . --spp 2
check sandbox_again "$V" render --again ../confined.exr --sandbox . -o ../again.exr
check sandbox_default_output "$V" render in.png.pbrt --sandbox . $small
check sandbox_stdout "$V" render in.png.pbrt --sandbox . $small -o -.png
check sandbox_denoise "$V" render in.png.pbrt --sandbox . $small --spp 4 -o ../confined.exr --denoise ../elsewhere/clean.exr
check sandbox_frames "$V" render in.png.pbrt --sandbox . $small --turntable 2 -o ../elsewhere/turn_%02d.exr
check sandbox_camera "$V" render in.png.pbrt --sandbox . $small --camera ../scene.pbrt --environment ../a.exr -o ../confined.exr
cd ..

# ---- what messages repeat of files -----------------------------------------------------------------------------------
secret=correcthorsebatterystaple
printf '%s\n' "$secret more" >secret.txt
silent() {
  run "$V" render "$2" $long
  [ "$code" = 3 ] && [[ $err != *correcthorseb* ]] && pass "$1" || { fail "$1"; show "$2"; }
}
printf '%s\n' 'Camera "perspective"' 'WorldBegin' 'Include "secret.txt"' >echo.pbrt
silent include_is_not_repeated echo.pbrt
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n%s\n' "$secret" >echo.ply
silent ply_is_not_repeated echo.ply
printf 'ply\n%s\n' "$secret" >head.ply
silent ply_header_is_not_repeated head.ply
printf 'v %s 0 0\n' "$secret" >echo.obj
silent obj_is_not_repeated echo.obj
printf '{%s' "$secret" >echo.gltf
silent json_is_not_repeated echo.gltf

# ---- places and reasons ----------------------------------------------------------------------------------------------
sed 's/"integer xresolution" \[64\]/"integer xresolution" [70000]/' scene.pbrt >wide_film.pbrt
refused 3 wide_film 'wide_film.pbrt:3:' "$V" render wide_film.pbrt --quiet
refused 3 wide_film_dry 'wide_film.pbrt:3:' "$V" render wide_film.pbrt --dry-run
run "$V" scene check wide_film.pbrt
[ "$code" = 3 ] && pass wide_film_checked || fail wide_film_checked
for what in "render scene.pbrt -o a.exr" "render --again a.exr -o b.exr" "render --continue a.film" "image info a.exr" "image denoise a.exr -o b.exr" "camera verify --camera a.json" "scene info scene.pbrt" "film info a.film"; do
  refused 2 "unknown_isa_of_${what//[!a-z]/_}" 'VELO_ISA must be' env VELO_ISA=foo "$V" $what
done
refused 2 too_wide_for_jpeg '65500' "$V" render scene.pbrt --resolution 65536x1 --dry-run -o a.jpg
"$V" render scene.pbrt --spp 1 --quiet --channels Z -o depth.exr
"$V" image convert depth.exr z.exr --channel Z
run "$V" image convert z.exr z.png
[ "$code" = 0 ] && pass image_of_one_channel || { fail image_of_one_channel; show convert; }

# ---- time ------------------------------------------------------------------------------------------------------------
# The best of three: a busy machine may be late once.
kept() {
  local name=$1 best=
  shift
  for _ in 1 2 3; do
    run_measured "$V" render scene.pbrt --resolution 640x480 --time 3s --quiet -o time.exr "$@"
    [ "$code" = 0 ] && [ "$milliseconds" -gt 2700 ] && [ "$milliseconds" -lt 3300 ] && best=yes && break
  done
  [ -n "$best" ] && pass "$name" || fail "$name ($milliseconds ms of 3000)"
}
if is_plain_build; then
  kept time_is_kept
  kept time_is_kept_both_ways --tracer bidirectional --threads 1
fi
# A first pass that does not fit is done and reported, also with --quiet. A denoiser gets its two samples.
late() {
  local name=$1 samples=$2
  shift 2
  run "$V" render "$@" --time 0.1s --quiet -o late.exr
  [ "$code" = 0 ] && [[ $err == *"warning: $samples spp and writing it took "*", --time was 0.10 s"* ]] && pass "$name" || { fail "$name"; show late; }
}
late late_is_reported 1 scene.pbrt --resolution 800x600
late late_with_denoise 2 scene.pbrt --resolution 640x480 --denoise clean.exr
check late_film "$V" render scene.pbrt --resolution 800x600 --spp 1 --tracer raycast --quiet --film late.film
late late_continue 1 --continue late.film --spp 1000000

# PNG files of 57 bytes whose chunks promise a gigabyte: the memory is not taken.
python3 - <<'PY'
import struct, zlib
def chunk(kind, data, length=None):
    return struct.pack(">I", len(data) if length is None else length) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
head = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0))
for kind in "eXIf hIST iCCP iTXt pCAL sCAL sPLT tEXt zTXt tRNS PLTE vpAg".split():
    open("huge_%s.png" % kind, "wb").write(head + chunk(kind.encode(), b"abcdefghijkl", 0x3fffffff))
# a text that unpacks to 64 MB, in a file that is whole
bomb = b"name\0\0" + zlib.compress(bytes(64 << 20), 9)
rest = chunk(b"IDAT", zlib.compress(b"\0abc")) + chunk(b"IEND", b"")
open("text.png", "wb").write(head + chunk(b"zTXt", bomb) + rest)
open("profile.png", "wb").write(head + chunk(b"iCCP", bomb) + rest)
PY
worst=0
for file in huge_*.png; do
  run_measured "$V" image info "$file"
  [ "$code" = 3 ] || { fail "$file (exit code $code)"; show "$file"; }
  [ "$kilobytes" -gt "$worst" ] && worst=$kilobytes
done
if is_plain_build; then [ "$worst" -lt 60000 ] && pass chunks_of_a_png || fail "chunks_of_a_png ($worst kB)"; fi
for file in text.png profile.png; do
  run_measured "$V" image info "$file"
  [ "$code" = 0 ] && pass "$file" || { fail "$file"; show "$file"; }
  if is_plain_build; then [ "$kilobytes" -lt 60000 ] && pass "memory_of_$file" || fail "memory_of_$file ($kilobytes kB)"; fi
done

# WebP files whose metadata promise a gigabyte, and one of 46 bytes that promises 2^28 pixels.
python3 - <<'PY'
import struct
def chunk(kind, data, length=None):
    return kind + struct.pack("<I", len(data) if length is None else length) + data
def riff(chunks, length=None):
    return b"RIFF" + struct.pack("<I", 4 + len(chunks) if length is None else length) + b"WEBP" + chunks
extended = chunk(b"VP8X", bytes([0x2c, 0, 0, 0, 1, 0, 0, 1, 0, 0]))
for kind in "ICCP", "EXIF", "XMP ":
    open("huge_%s.webp" % kind.strip(), "wb").write(riff(extended + chunk(kind.encode(), b"abcdefghijkl", 0x3fffffff), 0x7ffffff0))
open("huge_pixels.webp", "wb").write(riff(chunk(b"VP8L", b"\x2f" + struct.pack("<I", 16383 | 16383 << 14) + bytes(20))))
PY
for file in huge_*.webp; do
  run_measured "$V" image convert "$file" webp.png
  [ "$code" = 3 ] && pass "$file" || { fail "$file"; show "$file"; }
  if is_plain_build; then [ "$kilobytes" -lt 60000 ] && pass "memory_of_$file" || fail "memory_of_$file ($kilobytes kB)"; fi
done

# A camera farther away than Embree's largest coordinate sees nothing of the scene, in a medium too.
sed 's/^Camera /MakeNamedMedium "fog" "string type" "homogeneous"\nMediumInterface "" "fog"\nTransform [1 0 0 0  0 1 0 0  0 0 1 0  0 1e20 0 1]\nCamera /' scene.pbrt >far.pbrt
grep -q 1e20 far.pbrt || fail far_camera_scene
for tracer in path volpath bidirectional raycast; do
  check "far_camera_$tracer" timeout 60 "$V" render far.pbrt --tracer $tracer --resolution 16x16 --spp 2 --quiet -o far.exr
done
finish
