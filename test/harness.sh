# test/harness.sh: source it from a test script (bash). Each case prints one line, `ok NAME`, `not ok NAME` or
# `skip NAME: why`, which tools/run_tests counts. End the script with `finish`.
#   . "$VELO_SOURCE_DIR/test/harness.sh"
#   check "NAME" COMMAND...                exit code 0
#   expect_code CODE "NAME" COMMAND...     that exit code; output kept in $out and $err (texts)
#   expect_text "NAME" TEXT                $out or $err of the last command contains TEXT
#   need_shared PATH                       skips the whole script where ../shared/PATH is not there; sets $shared
# $work is a folder of the script's own, $VELO the program.
VELO_SOURCE_DIR=${VELO_SOURCE_DIR:-$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)}
VELO=${VELO:-$VELO_SOURCE_DIR/build/release/bin/velo}
VELO_BINARY_DIR=${VELO_BINARY_DIR:-$VELO_SOURCE_DIR/build/release}
shared=${VELO_SHARED_DIR-$VELO_SOURCE_DIR/../shared}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
out=
err=
code=0

pass() { printf 'ok %s\n' "$1"; }
fail() {
  printf 'not ok %s\n' "$1"
  failures=$((failures + 1))
}
skip() { printf 'skip %s: %s\n' "$1" "$2"; }

# Runs a command, keeps exit code and output. Never fails.
run() {
  code=0
  "$@" >"$work/.out" 2>"$work/.err" </dev/null || code=$?
  out=$(tr -d '\0' <"$work/.out")
  err=$(tr -d '\0' <"$work/.err")
}

show() { printf '  command: %s\n  exit code: %s\n' "$1" "$code"; printf '%s\n' "$out" "$err" | sed '/^$/d; s/^/  | /' | tail -n 20; }

expect_code() {
  local wanted=$1 name=$2
  shift 2
  run "$@"
  if [ "$code" = "$wanted" ]; then pass "$name"; else fail "$name (exit code $code, not $wanted)"; show "$*"; fi
}

check() {
  local name=$1
  shift
  expect_code 0 "$name" "$@"
}

expect_text() {
  case "$out
$err" in
    *"$2"*) pass "$1" ;;
    *) fail "$1 (no '$2' in the output)"; show "the last one" ;;
  esac
}

need_shared() {
  if [ -z "$shared" ] || [ ! -e "$shared/$1" ]; then
    skip "$(basename "$0")" "needs ../shared/$1"
    exit 77
  fi
}

finish() {
  [ "$failures" -eq 0 ] || exit 1
  exit 0
}
