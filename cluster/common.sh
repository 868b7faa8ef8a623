# cluster/common.sh: sourced by the scripts of cluster/ (bash): messages, and the words of a `velo render` command
# line that are for its parts, for its end, or for neither.
# shellcheck shell=bash disable=SC2034,SC2154
program=$(basename "$0")

say() { printf '%s: %s\n' "$program" "$*" >&2; }

# die CODE MESSAGE: exit codes are velo's: 2 usage, 3 scene, 4 missing file, 5 I/O, 1 other.
die() {
  local code=$1
  shift
  say "$*"
  exit "$code"
}

# The comment at the top of the script is its help.
usage() { sed -n '2,/^[^#]/ { s/^# \{0,1\}//p }' "$0"; }

# The program, by an absolute path: parts run in other places.
find_velo() {
  local name=${1:-${VELO:-}} built
  built=$root/build/release/bin/velo
  if [ -z "$name" ] && [ -x "$built" ]; then name=$built; fi
  VELO=$(command -v "${name:-velo}") || die 4 "no such program: ${name:-velo}; give --velo FILE"
  VELO=$(realpath "$VELO")
  export VELO
}

# is_count TEXT: a number from 1 on.
is_count() { case $1 in '' | *[!0-9]* | 0*) return 1 ;; *) [ ${#1} -le 9 ] ;; esac; }

# split_words WORD...: sets words (for every part), outputs, film, overwrite, frames (1: a trajectory; its parts are frames).
split_words() {
  words=() outputs=() film='' overwrite=() frames=0
  while [ $# -gt 0 ]; do
    local word=$1 value='' own=1 # own: its value is the next word
    case $word in
      --*=*) value=${word#*=} own=0 word=${word%%=*} ;;
      -o?*) value=${word#-o} own=0 word=-o ;;
      *) value=${2-} ;;
    esac
    case $word in
      -o | --output | --film)
        if [ -z "$value" ]; then die 2 "$word needs a value"; fi
        if [ "$word" = --film ]; then film=$value; else outputs+=("$value"); fi
        shift $((1 + own))
        continue
        ;;
      --overwrite)
        overwrite=(--overwrite) # for the film; the parts have films of their own
        shift
        continue
        ;;
      --trajectory) frames=1 ;;
      --time) die 2 "--time: parts must know their samples; give --spp, and the time to the cluster" ;;
      --denoise) die 2 "--denoise: denoise the image when it is done: velo image denoise" ;;
      --shard | --shard-by | --samples | --tiles | --continue | --again | --dry-run | --skip-existing)
        die 2 "$word: velo-render gives it to the parts itself, or it has no parts" ;;
    esac
    words+=("$1")
    shift
  done
  if [ ${#words[@]} -eq 0 ]; then die 2 "which scene? --help lists the options"; fi
  if [ ${#outputs[@]} -eq 0 ] && [ -z "$film" ]; then die 2 "give the name of the image with -o, or of the film with --film"; fi
  if [ "$frames" = 1 ] && [ -n "$film" ]; then die 2 "--film is of one image; a trajectory's parts are frames"; fi
  local output
  for output in "${outputs[@]}" ${film:+"$film"}; do
    output=${output%%%*} # up to the first field of a pattern
    case $output in */*) output=${output%/*}/ ;; *) output=./ ;; esac
    if [ ! -d "$output" ]; then die 5 "no such folder: $output"; fi
  done
}

# is_done I: whether part I is in the folder.
is_done() { [ -f "$folder/part-$1.film" ] || [ -f "$folder/part-$1.done" ]; }

# Makes the folder of the parts, or goes on with it. Sets missing: the parts that are not done. A film that is there
# before anything is rendered is refused here: cluster/merge would refuse it at the end, unless it is of the same render.
open_folder() {
  folder=$(realpath -m "$folder")
  if [ -n "$film" ] && [ -s "$film" ] && [ ! -f "$folder/plan" ] && [ ${#overwrite[@]} -eq 0 ]; then
    die 2 "--film: $film is there already; --overwrite replaces it"
  fi
  case $folder in *%*) die 2 "--folder \"$folder\": must have no %" ;; esac
  mkdir -p "$folder/log" || die 5 "cannot make the folder $folder"
  local plan
  plan=$(printf '%s\n' "$count" "$by" "$PWD" "$(printf '%q ' "${words[@]}")" "$(cksum "${words[0]}" 2>/dev/null)")
  if [ -f "$folder/plan" ] && [ "$(cat "$folder/plan")" != "$plan" ]; then
    die 3 "$folder has parts of another render or another number of them: remove it, or give another --folder"
  fi
  if ! printf '%s\n' "$plan" >"$folder/plan"; then die 5 "cannot write $folder/plan"; fi
  rm -f "$folder/finished"
  missing=()
  local i
  for ((i = 1; i <= count; i++)); do
    rm -f "$folder/part-$i.failures"
    is_done "$i" || missing+=("$i")
  done
}

# The last thing that velo or the part's script said.
last_words() { grep -E '^(velo|shard): ' "$folder/log/part-$1.log" 2>/dev/null | tail -n 1; }

# What cluster/merge is told of the outputs (images), and where the parts of a trajectory put theirs (added to shard):
# output number I below FOLDER/frames/I, with what its name has from the first field's folder on.
arrange_outputs() {
  local i output place
  for i in "${!outputs[@]}"; do
    output=${outputs[$i]}
    images+=(-o "$output")
    [ "$frames" = 1 ] || continue
    mkdir -p "$folder/frames/$i" || die 5 "cannot make the folder $folder/frames/$i"
    place=${output%%%*}
    case $place in */*) place=${place%/*}/ ;; *) place='' ;; esac
    shard+=(-o "$folder/frames/$i/${output#"$place"}")
  done
  if [ -n "$film" ]; then images+=(--film "$film" "${overwrite[@]}"); fi
}
