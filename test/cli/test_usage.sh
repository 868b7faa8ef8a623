#!/usr/bin/env bash
# The command line: errors (exit code 2) and their messages; help and version.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt

# usage NAME TEXT ARGUMENTS...: exit code 2, one line on stderr that holds TEXT, nothing on stdout.
usage() {
  local name=$1 text=$2
  shift 2
  run "$VELO" "$@"
  if [ "$code" = 2 ] && [ "$(printf '%s\n' "$err" | wc -l)" = 1 ] && [ -z "$out" ] && [[ $err == "velo: "*"$text"* ]]; then
    pass "$name"
  else
    fail "$name (wanted exit code 2 and one line with: $text)"
    show "velo $*"
  fi
}

usage unknown_command 'did you mean "render"?' rendr scene.pbrt
usage unknown_sign '"%é" is not known; there are %d' render scene.pbrt -o 'a%é.exr' --trajectory poses.tum
usage unknown_help 'did you mean "--help"?' --hlep
usage unknown_image_command 'did you mean "diff"?' image dif a b
usage image_without_command 'info, diff, convert' image
usage no_scene 'too few arguments' render
usage two_scenes 'too many: "b"' render scene.pbrt b
usage unknown_option 'did you mean "--spp"?' render scene.pbrt --ssp 4
usage abbreviated_option 'did you mean "--resolution"?' render scene.pbrt --res 10x10
usage unknown_letter 'unknown option "-x"' render scene.pbrt -x
usage option_without_value 'needs a value' render scene.pbrt --spp
usage flag_with_value 'takes no value' render scene.pbrt --quiet=1
usage spp_zero 'from 1 to' render scene.pbrt --spp 0
usage spp_negative 'from 1 to' render scene.pbrt --spp -4
usage spp_with_rest '"12x"' render scene.pbrt --spp 12x
usage spp_fraction '"1.5"' render scene.pbrt --spp 1.5
usage spp_huge 'from 1 to' render scene.pbrt --spp 99999999999999999999
usage file_without_command 'did you mean "velo render Duck.glb"?' Duck.glb
usage film_without_command 'did you mean "velo film info a.film"?' a.film
usage second_word 'did you mean "velo scene convert" or "velo image convert"' convert
usage width 'did you mean "--resolution WxH"?' render scene.pbrt --width 100
usage integrator 'did you mean "--tracer' render scene.pbrt --integrator path
usage spp_empty 'from 1 to' render scene.pbrt --spp=
usage threads_zero 'from 1 to' render scene.pbrt -t 0
usage resolution 'WIDTHxHEIGHT' render scene.pbrt --resolution 64
usage resolution_zero 'WIDTHxHEIGHT' render scene.pbrt --resolution 0x64
usage crop_three_numbers 'x0,y0,x1,y1' render scene.pbrt --crop 1,2,3
usage crop_empty 'x0 < x1' render scene.pbrt --crop 5,5,5,9
usage crop_outside '64 x 48' render scene.pbrt --crop 0,0,65,48
usage cropwindow 'fractions' render scene.pbrt --cropwindow 0,2,0,1
usage crop_twice 'exclude' render scene.pbrt --crop 0,0,4,4 --cropwindow 0,1,0,1
usage time_unit '1h30m' render scene.pbrt --time 5d
usage time_zero 'above 0' render scene.pbrt --time 0
usage exposure '"nan"' render scene.pbrt --exposure nan
usage sampler 'did you mean "sobol"?' render scene.pbrt --sampler sobool
usage sampler_list 'independent, random, regular, stratified' render scene.pbrt --sampler q
usage tracer 'did you mean "raycast"?' render scene.pbrt --tracer raycats
usage view 'standard, neutral, agx, raw' render scene.pbrt --view q
usage isa 'base, v2, v3, v4' render scene.pbrt --isa avx
usage suffix 'did you mean ".exr"?' render scene.pbrt -o a.exrr
usage no_suffix '.exr, .png' render scene.pbrt -o image
usage same_output_twice 'given twice' render scene.pbrt -o a.exr -o a.exr
usage quiet_and_verbose 'exclude' render scene.pbrt --quiet -v
usage threshold 'NAME=VALUE' image diff a.exr b.exr --threshold 3
usage threshold_name 'did you mean "flip"?' image diff a.exr b.exr --threshold flp=3
usage threshold_value 'must be a number' image diff a.exr b.exr --threshold flip=x

expect_code 2 nothing_at_all "$VELO"
check help "$VELO" help
# Every page fits 80 columns and has two examples.
"$VELO" help >pages.txt
wide=$(awk 'length($0) > 80' pages.txt)
for command in render 'scene info' 'scene check' 'scene convert' 'scene upgrade' 'scene kinds' 'image info' 'image diff' 'image convert' 'image check' 'image denoise' 'camera project' \
  'camera unproject' 'camera info' 'camera convert' 'camera verify' 'camera vanishing' 'film info' 'film merge' 'film develop' 'raw info' 'raw develop' 'sensor expose' 'sensor verify' help; do
  run "$VELO" help $command --all
  wide="$wide$(printf '%s\n' "$out" | awk 'length($0) > 80')"
  [ "$code" = 0 ] && [ "$(printf '%s\n' "$out" | sed '1,/^examples:/d' | grep -c '^  velo ')" -ge 2 ] && pass "help_$command" || { fail "help_$command"; show help; }
done
[ -z "$wide" ] && pass help_in_80_columns || fail "help_in_80_columns ($wide)"
expect_code 0 help_render_sections "$VELO" help render --all
expect_text help_render_has_sections 'ground truth beside the image (.exr):'
# At the start of a trajectory no remaining time is printed. The first line about script/render's scene does not name pbrt.
printf 'eye_x,eye_y,eye_z,lookat_x,lookat_y,lookat_z\n0,1.2,4,0,0.6,0\n1,1,4,0,0.6,0\n' >poses.csv
run "$VELO" render scene.pbrt --trajectory poses.csv -o 'pose_%d.exr'
case "$err" in *"0.00 s left"*) fail trajectory_begins ;; *) pass trajectory_begins ;; esac
run "$VELO" render "$VELO_SOURCE_DIR/scenes/lecture/pinhole.pbrt" --spp 1 -o first.png
case "$err" in *pbrt-v4*) fail first_line ;; *) pass first_line ;; esac
# On a narrow terminal the progress line is shortened but keeps the remaining time.
cat >narrow.py <<'PY'
import fcntl, os, pty, struct, sys, termios
try:
    pid, fd = pty.fork()
except OSError as error:
    print("no pseudo-terminal: %s" % error, file=sys.stderr)
    sys.exit(77)
if pid == 0:
    fcntl.ioctl(2, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 50, 0, 0))
    os.environ["TERM"] = "xterm"
    os.execv(sys.argv[1], [sys.argv[1], "render", "scene.pbrt", "--time", "2s", "-o", "narrow.exr"])
text = b""
while True:
    try:
        got = os.read(fd, 4096)
    except OSError:
        break
    if not got:
        break
    text += got
os.waitpid(pid, 0)
lines = [line for line in text.decode().replace("\033[K", "").split("\r") if "%" in line and "spp" in line]
assert lines and any("left" in line for line in lines) and max(map(len, lines)) <= 50, lines
PY
run python3 narrow.py "$VELO"
case $code in
  0) pass narrow_terminal ;;
  77) skip narrow_terminal "$err" ;;
  *) fail narrow_terminal; show narrow ;;
esac
check help_render "$VELO" help render
check help_render_begins_with_an_example grep -q "^  velo render room.pbrt -o room.png" <(printf '%s\n' "$out" | head -3)
check help_render_is_short test "$(printf '%s\n' "$out" | wc -l)" -le 25
check help_render_fits test "$(printf '%s\n' "$out" | wc -L)" -le 80
"$VELO" help render --all >all_options
for option in $(printf '%s\n' "$out" | grep -oE -- '--[a-z]+' | sort -u); do
  [ "$option" = --all ] || grep -qE "^ .*$option( |\$)" all_options || fail "help_render_names $option"
done
check help_render_all "$VELO" help render --all
expect_text help_render_lists_options "--cropwindow"
check render_help "$VELO" render --help
# A reader that has seen enough is no error; a full disk is.
check head bash -c 'set -o pipefail; "$0" help render --all | head -n 1 >/dev/null' "$VELO"
check head_of_info bash -c 'set -o pipefail; "$0" scene kinds materials | head -n 1 >/dev/null' "$VELO"
[ ! -w /dev/full ] || expect_code 5 full_stdout bash -c '"$0" help render --all >/dev/full' "$VELO"
# Threads beyond four for each processor are not started, and the image is the same.
check many_threads "$VELO" render scene.pbrt --spp 1 --threads 1000 -o many.pfm
expect_text many_threads_says '4 for each processor'
check one_thread "$VELO" render scene.pbrt --spp 1 --threads 1 -o one.pfm --quiet
check many_threads_same cmp many.pfm one.pfm
check help_image "$VELO" help image
check help_image_diff "$VELO" help image diff
expect_text help_keeps_the_columns_of_tables "  mse        mean squared error"
check version "$VELO" --version
expect_text version_text "velo 0."

# Every name and alias is accepted.
for name in independent random regular stratified jittered nrooks n-rooks multijittered multi-jittered hammersley halton sobol zsobol; do
  check "sampler_$name" "$VELO" render scene.pbrt --sampler "$name" --spp 1 --quiet -o sampler.pfm
done
for name in box triangle gaussian mitchell lanczos sinc blackmanharris blackman-harris; do
  check "filter_$name" "$VELO" render scene.pbrt --filter "$name" --spp 1 --quiet -o filter.pfm
done
for name in path raycast ambientocclusion ao; do
  check "tracer_$name" "$VELO" render scene.pbrt --tracer "$name" --spp 1 --quiet -o tracer.pfm
done
for name in bvh power uniform; do
  check "light_sampler_$name" "$VELO" render scene.pbrt --light-sampler "$name" --spp 1 --quiet -o light.pfm
done
for name in on off; do
  check "regularize_$name" "$VELO" render scene.pbrt --regularize "$name" --spp 1 --quiet -o "regularize_$name.pfm"
done
# Without the option, the scene's own parameter counts.
sed 's/^Integrator.*//; 1s/^/Integrator "path" "bool regularize" true\n/' scene.pbrt >asked.pbrt
check regularize_asked "$VELO" render asked.pbrt --dry-run
expect_text regularize_asked_is_reported "regularised"
check regularize_declined sh -c '! "$0" render asked.pbrt --dry-run --regularize off | grep regularised' "$VELO"
for name in standard neutral agx raw; do
  check "view_$name" "$VELO" render scene.pbrt --view "$name" --exposure -0.5 --spp 1 --quiet -o view.png
done
check color_rgb "$VELO" render scene.pbrt --color rgb --spp=1 --quiet -o color.exr --half
check options_before_the_scene "$VELO" render -t2 --seed 7 --max-depth 1 --quiet --spp 1 -o before.exr -- scene.pbrt
finish
