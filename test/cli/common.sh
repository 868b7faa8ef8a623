# test/cli/common.sh: sourced by the tests of the program after test/harness.sh: small scenes and measured runs.

# A scene with a bit of everything that touches the pixels: $1 file, the rest goes in before WorldBegin.
write_scene() {
  local file=$1
  shift
  {
    cat <<'SCENE'
LookAt 0 1.2 4  0 0.6 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [64] "integer yresolution" [48] "string filename" "asked.exr"
Sampler "zsobol" "integer pixelsamples" [4]
Integrator "path" "integer maxdepth" [4]
SCENE
    printf '%s\n' "$@"
    cat <<'SCENE'
WorldBegin
LightSource "infinite" "rgb L" [0.2 0.25 0.3]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [8 7 6]
  Shape "trianglemesh" "point3 P" [-0.6 2.4 -0.6  0.6 2.4 -0.6  0.6 2.4 0.6  -0.6 2.4 0.6]
    "integer indices" [0 1 2  0 2 3]
AttributeEnd
Texture "checks" "spectrum" "checkerboard" "float uscale" [8] "float vscale" [8]
  "rgb tex1" [0.7 0.7 0.6] "rgb tex2" [0.2 0.1 0.1]
Material "diffuse" "texture reflectance" "checks"
Shape "bilinearmesh" "point3 P" [-3 0 -3  3 0 -3  -3 0 3  3 0 3]
AttributeBegin
  Translate -0.7 0.5 0
  Material "dielectric" "float eta" [1.5]
  Shape "sphere" "float radius" [0.5]
AttributeEnd
AttributeBegin
  Translate 0.7 0.5 0
  Material "conductor" "float roughness" [0.2]
  Shape "sphere" "float radius" [0.5]
AttributeEnd
SCENE
  } >"$file"
}

# Runs a command as `run` does; also leaves $seconds (thousandths: $milliseconds) and $kilobytes, the largest memory.
run_measured() {
  run python3 -c '
import resource, subprocess, sys, time
start = time.monotonic()
code = subprocess.call(sys.argv[2:])
with open(sys.argv[1], "w") as f:
    f.write("%d %d" % ((time.monotonic() - start) * 1000, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss))
sys.exit(code if code >= 0 else 128 - code)' "$work/.measure" "$@"
  read -r milliseconds kilobytes <"$work/.measure"
}

# Builds with sanitizers or without optimisation are slow and large: limits are for what people run.
is_plain_build() {
  grep -q '^CMAKE_BUILD_TYPE:.*=Release$' "$VELO_BINARY_DIR/CMakeCache.txt" 2>/dev/null
}

# expect_line NAME TEXT: the last command said one line on stderr beside its notes, with TEXT in it.
expect_line() {
  expect_text "$1" "$2"
  if [ "$(printf '%s\n' "$err" | grep -c -v '^velo: note: ')" = 1 ]; then pass "$1_one_line"; else fail "$1_one_line"; show "the last one"; fi
}

# same NAME A B: equal bytes.
same() {
  if cmp -s "$2" "$3"; then pass "$1"; else fail "$1 ($(cmp "$2" "$3" 2>&1))"; fi
}

# Waits until a file is there (at most 30 s).
wait_for() {
  local i
  for i in $(seq 300); do
    [ -s "$1" ] && return 0
    sleep 0.1
  done
  return 1
}

# A ball on a disk under a lamp, the same from all sides: what differs between views is noise. $1: file.
write_round_scene() {
  cat >"$1" <<'SCENE'
LookAt 0 2.2 5  0 0.4 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 96 "integer yresolution" 72
Sampler "zsobol" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 4
WorldBegin
AttributeBegin
  Translate 0 3 0
  AreaLightSource "diffuse" "rgb L" [14 12 10]
  Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
  Rotate -90 1 0 0
  Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
  Shape "disk" "float radius" 6
AttributeEnd
AttributeBegin
  Material "diffuse" "rgb reflectance" [0.2 0.4 0.6]
  Translate 0 0.7 0
  Shape "sphere" "float radius" 0.7
AttributeEnd
SCENE
}

# The mean squared difference of two images.
mse() {
  "$VELO" image diff "$1" "$2" | sed -n 's/^mse *//p'
}

# Whether $1 is below $3 times $2; prints $1 / $2.
below() {
  python3 -c "import sys; a, b, k = map(float, sys.argv[1:]); print(a / b); sys.exit(not a < k * b)" "$@"
}
