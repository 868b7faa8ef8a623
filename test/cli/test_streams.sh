#!/usr/bin/env bash
# Pipes, sockets and the standard output get the same bytes as files do. Nobody at the other end is no reason to hang:
# a signal ends velo in every state. Names that cannot be written are refused before the render.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
. "$VELO_SOURCE_DIR/test/cli/common.sh"
cd "$work" || exit 1
write_scene scene.pbrt
render="$VELO render scene.pbrt --spp 2 --quiet --no-receipt"

check files $render -o a.exr -o a.png -o a.jpg -o a.hdr -o a.pfm -o a.tga
check film $VELO render scene.pbrt --spp 2 --quiet --film a.film
for suffix in exr png jpg hdr pfm tga; do
  $render -o "-.$suffix" | cat >"stdout.$suffix"
  same "stdout_$suffix" "a.$suffix" "stdout.$suffix"
  mkfifo "fifo.$suffix"
  cat "fifo.$suffix" >"read.$suffix" &
  check "fifo_$suffix" timeout 60 $render -o "fifo.$suffix"
  wait $!
  same "fifo_${suffix}_bytes" "a.$suffix" "read.$suffix"
done
$render -o - | cat >dash.exr
same dash_is_exr a.exr dash.exr
$render -o - >redirected.exr
same stdout_that_is_a_file a.exr redirected.exr
"$VELO" image convert a.png -.tga | cat >convert.tga
"$VELO" image convert a.png expected.tga
same image_convert expected.tga convert.tga
"$VELO" render scene.pbrt --spp 2 --quiet --film - | cat >stdout.film
check stdout_film "$VELO" film develop stdout.film -o develop.exr
"$VELO" film develop a.film -o expected.exr
"$VELO" image diff expected.exr develop.exr --threshold differing=0 >/dev/null && pass stdout_film_pixels || fail stdout_film_pixels
"$VELO" film develop a.film -o - | cat >develop.exr
same film_develop expected.exr develop.exr
"$VELO" film merge a.film -o - | cat >merge.film
same film_merge a.film merge.film

python3 - socket.exr received.exr <<'PY' &
import socket, sys
s = socket.socket(socket.AF_UNIX)
s.bind(sys.argv[1])
s.listen(1)
c, _ = s.accept()
with open(sys.argv[2], "wb") as f:
    while (data := c.recv(65536)):
        f.write(data)
PY
for _ in $(seq 100); do [ -S socket.exr ] && break; sleep 0.1; done
check socket timeout 60 $render -o socket.exr
wait $!
same socket_bytes a.exr received.exr
expect_code 5 socket_without_a_program timeout 60 $render -o socket.exr

# A reader that leaves early.
run bash -c 'set -o pipefail; '"$VELO"' render scene.pbrt --resolution 512x512 --spp 1 --quiet -o - | head -c 100 >/dev/null'
[ "$code" = 5 ] && pass cut_stream || { fail "cut_stream ($code)"; show cut; }
expect_text cut_stream_is_told 'Broken pipe'

# ends NAME: the render of $process ends within some seconds of SIGTERM.
ends() {
  local i
  kill -TERM "$process"
  for i in $(seq 100); do
    kill -0 "$process" 2>/dev/null || break
    sleep 0.1
  done
  if kill -0 "$process" 2>/dev/null; then
    fail "$1 (still runs)"
    kill -9 "$process"
  else
    pass "$1"
  fi
  wait "$process" 2>/dev/null
}
mkfifo alone.exr alone.film unread.exr messages
$render -o alone.exr 2>/dev/null &
process=$!
sleep 1
ends fifo_without_reader
$VELO render scene.pbrt --spp 2 --quiet --film alone.film 2>/dev/null &
process=$!
sleep 1
ends film_fifo_without_reader
sleep 60 <unread.exr &
sleeper=$!
$render --resolution 512x512 -o unread.exr 2>/dev/null &
process=$!
sleep 2
ends fifo_that_is_not_read
kill $sleeper
sleep 60 <messages &
sleeper=$!
env --default-signal=TERM "$VELO" render scene.pbrt --spp 16777216 -o long.exr --log-json 2>messages &
process=$!
python3 -c '
import fcntl, os
fd = os.open("messages", os.O_WRONLY | os.O_NONBLOCK)
try:
    while True: os.write(fd, b"x" * 4096)
except BlockingIOError: pass'
sleep 2
ends messages_that_nobody_reads
kill $sleeper
$render -o alone.exr 2>/dev/null &
process=$!
sleep 0.5
cat alone.exr >late.exr
wait $process
same reader_that_comes_late a.exr late.exr

# refused CODE NAME TEXT COMMAND...: one line, before the render: 2^24 samples would take hours.
refused() {
  local wanted=$1 name=$2 text=$3
  shift 3
  run timeout 60 "$@"
  if [ "$code" = "$wanted" ] && [ "$(printf '%s\n' "$err" | wc -l)" = 1 ] && [[ $err == *"$text"* ]]; then
    pass "$name"
  else
    fail "$name (wanted exit code $wanted and: $text)"
    show "$*"
  fi
}
long="$VELO render scene.pbrt --spp 16777216 --quiet"
ln -s loop.exr loop.exr
ln -s loop.film loop.film
ln -s none/there.exr astray.exr
name=$(printf 'n%.0s' $(seq 300))
path=$(printf 'p/%.0s' $(seq 3000))
refused 5 loop 'symbolic links' $long -o loop.exr
refused 5 film_loop 'symbolic links' $long --film loop.film
refused 5 denoised_loop 'symbolic links' $long -o new.exr --denoise loop.exr
refused 5 link_to_no_folder 'No such file' $long -o astray.exr
refused 5 long_name 'name too long' $long -o "$name.exr"
refused 5 long_film 'name too long' $long --film "$name"
refused 5 long_path 'too long' $long -o "${path}a.exr"
refused 5 film_in_no_folder 'No such file' $long --film none/a.film
refused 5 film_is_a_folder 'Is a directory' $long --film .
refused 2 stdout_twice 'twice' $long -o - -o -.png
refused 2 stdout_for_image_and_film 'twice' $long -o - --film -
refused 2 text_and_image 'standard output' "$VELO" image diff a.png a.png -o -.png
[ ! -e new.exr ] && pass nothing_was_rendered || fail nothing_was_rendered
finish
