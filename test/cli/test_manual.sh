#!/usr/bin/env bash
# Manual pages and completions: made from the tables of the options, without warnings of man and mandoc, accepted by the
# shells; completions of commands, options, values and files.
. "${VELO_SOURCE_DIR:-$(dirname "$0")/../..}/test/harness.sh"
cd "$work" || exit 1

# ---- manual pages ----
mapfile -t commands < <("$VELO" help --commands)
check "--commands lists those of the overview" test "$(printf '%s\n' "${commands[@]}" | sort)" = \
  "$("$VELO" help | sed -n 's/^  \([a-z]\+\( [a-z]\+\)\{0,1\}\)  .*/\1/p; s/^  \(help\) COMMAND .*/\1/p' | sort)"
export SOURCE_DATE_EPOCH=1767225600
"$VELO" help --man >velo.1
missing=
for command in "${commands[@]}"; do
  page=velo-${command// /-}.1
  # shellcheck disable=SC2086
  "$VELO" help --man $command >"$page" || fail "page of $command"
  grep -qx "\.BR velo.*${command//* /} (1)" velo.1 || missing="$missing $command"
  # each option of the help page stands in the manual page
  # shellcheck disable=SC2086
  for option in $("$VELO" help $command --all | grep -oE '^ +(-[a-zA-Z], )?--[a-z0-9-]+' | grep -oE -- '--[a-z0-9-]+'); do
    grep -qF -- "\\fB${option//-/\\-}\\fR" "$page" || missing="$missing $command:$option"
  done
done
check "velo(1) lists each command, and each page each option ($missing)" test -z "$missing"
check "the date is that of SOURCE_DATE_EPOCH" grep -q '^\.TH VELO 1 "2026-01-01" "velo ' velo.1
check "no line of prose is set unchanged by mistake" sh -c "! grep -hA1 '^\.EX' velo-render.1 | grep -q '^ The'"
if command -v mandoc >/dev/null; then
  check "mandoc has no warnings" mandoc -T lint -W warning ./*.1
else
  skip "mandoc has no warnings" "mandoc is not installed"
fi
if command -v man >/dev/null && man --warnings --version >/dev/null 2>&1; then
  warnings=$(for page in *.1; do LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -E UTF-8 -l "$page" 2>&1 >/dev/null; done)
  check "man has no warnings ($warnings)" test -z "$warnings"
else
  skip "man has no warnings" "man is not installed"
fi
expect_code 2 "the page of an unknown command" "$VELO" help --man rendr
expect_text "names the nearest" 'did you mean "render"?'
expect_code 2 "an unknown shell" "$VELO" help --completion tcsh
expect_code 2 "two kinds of output" "$VELO" help --man --completion bash

# ---- bash ----
"$VELO" help --completion bash >velo.bash
check "bash accepts the script" bash -n velo.bash
mkdir -p files/folder
touch "files/a scene.pbrt" files/b.exr files/-x
cat >complete.bash <<'END'
# complete.bash WORDS...: prints the completions of the last word, one per line, sorted
source ../velo.bash
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_velo
printf '%s\n' "${COMPREPLY[@]}" | sort
END
# completes NAME "WANTED..." WORDS...: the completions of the last word are these
completes() {
  local name=$1 wanted=$2
  shift 2
  run bash -c 'cd files && exec bash ../complete.bash "$@"' bash "$@"
  if [ "$out" = "$(printf '%s\n' $wanted)" ]; then pass "bash: $name"; else fail "bash: $name: '$out', not '$wanted'"; fi
}
completes "commands" "camera" velo ca
completes "options of the program" "--help --version" velo --
completes "second words" "check convert denoise diff info" velo image ""
completes "one second word" "denoise diff" velo image d
completes "options" "--tiles --time" velo render scene.pbrt --ti
completes "options of a command of two words" "--threshold" velo image diff --thr
completes "letters" "--help --output --overwrite -h -o" velo film merge a.film -
completes "no option as the value of an option" "" velo film merge -o --o
completes "names of a tracer" "path" velo render --tracer pa
completes "names after =" "zsobol" velo render --sampler = zs
completes "all names after =" "fast portable" velo render --bits =
completes "names that options.c lists" "both-sides hide keep" velo render --walls ""
completes "aliases" "bdpt bidirectional" velo render --tracer b
completes "a number: nothing" "" velo render --spp ""
completes "files of an option" "b.exr" velo render scene.pbrt -o b
completes "folders of an option" "folder" velo render --sandbox ""
completes "files" "b.exr" velo image info b
completes "help: commands" "image" velo help im
completes "help: second words" "develop" velo help film d
completes "help: options" "--man" velo help --m
completes "families" "materials media" velo scene kinds m
completes "an unknown command: nothing that is wrong" "" velo rendr --sp
run bash -c 'cd files && exec bash ../complete.bash "$@"' bash velo render "a "
check "bash: a file with a blank is one word" test "$out" = "a scene.pbrt"

# ---- zsh, fish ----
"$VELO" help --completion zsh >_velo
"$VELO" help --completion fish >velo.fish
if command -v zsh >/dev/null && ! python3 -c 'import os; os.openpty()' 2>/dev/null; then
  skip "zsh" "there is no pseudo-terminal"
elif command -v zsh >/dev/null; then
  check "zsh accepts the script" zsh -n _velo
  # zsh_completes NAME TEXT LINE: an interactive shell that is given the line and Tab twice prints TEXT
  zsh_completes() {
    run env -i PATH="$PATH" TERM=dumb HOME="$work" timeout 60 zsh -f "$work/type.zsh" "$work" "$3"
    case $out in *"$2"*) pass "zsh: $1" ;; *) fail "zsh: $1: no '$2'"; show "$3" ;; esac
  }
  cat >type.zsh <<'END'
zmodload zsh/zpty
zpty shell zsh -f
zpty -w shell "PS1=; fpath=($1 \$fpath); autoload -U compinit; compinit -u -D; setopt noautomenu; cd $1/files; echo rea''dy"
zpty -r shell text '*ready*'
zpty -w -n shell "$2"$'\t'
sleep 1
zpty -w -n shell $'\t'
for ((i = 0; i < 20; i++)) { sleep 0.1; while zpty -r -t shell text; do print -rn -- "$text"; done }
zpty -d shell
END
  zsh_completes "commands" "velo render" "velo rend"
  zsh_completes "options" "--tracer=" "velo render scene.pbrt --trac"
  zsh_completes "names of a tracer" "bidirectional" "velo render --tracer bid"
  zsh_completes "second words" "velo image denoise" "velo image den"
  zsh_completes "families" "materials" "velo scene kinds mat"
  zsh_completes "help texts" "light transport algorithm" "velo render scene.pbrt --tra"
else
  skip "zsh" "zsh is not installed"
fi
if command -v fish >/dev/null; then
  check "fish accepts the script" fish -n velo.fish
  # fish_completes NAME "WANTED..." LINE: the completions of the line
  fish_completes() {
    run env HOME="$work" fish --no-config -c "source velo.fish; cd files; complete -C '$3' | string replace -r '\t.*' ''"
    if [ "$out" = "$(printf '%s\n' $2)" ]; then pass "fish: $1"; else fail "fish: $1: '$out', not '$2'"; fi
  }
  fish_completes "commands" "render" "velo re"
  fish_completes "second words" "denoise diff" "velo image d"
  fish_completes "options" "--tiles --time" "velo render scene.pbrt --ti"
  fish_completes "names of a tracer" "bdpt bidirectional" "velo render --tracer b"
  fish_completes "names after =" "--sampler=zsobol" "velo render --sampler=z"
  fish_completes "a number: nothing" "" "velo render --spp "
  fish_completes "files" "b.exr" "velo image info b"
  fish_completes "families" "materials media" "velo scene kinds m"
else
  skip "fish" "fish is not installed"
fi
finish
