# complete.bash SCRIPT WORD...: what bash completes the last word to, one a line, with completion from SCRIPT. Words are
# cut at = and : as readline cuts them.
. "$1"
shift
COMP_WORDS=()
for word; do
  while [[ $word == *[=:]* ]]; do
    head=${word%%[=:]*}
    [[ -z $head ]] || COMP_WORDS+=("$head")
    COMP_WORDS+=("${word:${#head}:1}")
    word=${word:$((${#head} + 1))}
    [[ -n $word ]] || continue 2
  done
  COMP_WORDS+=("$word")
done
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
compopt() { :; } # only within a completion
"$(complete -p talus | sed 's/.*-F \([a-z_]*\).*/\1/')"
printf '%s\n' "${COMPREPLY[@]}"
