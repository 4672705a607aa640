#!/bin/bash
# tidy.sh BUILD JOBS [SECONDS]: clang-tidy over all sources; with SECONDS over those alone that differ from origin's main
# (else the last tag, else the last commit), as many as that time allows. Silent if there is nothing to say.
set -u
build=$1 jobs=$2 seconds=${3:-}

# The sources that changed; a header counts as the first source that includes it.
changed_sources() {
  local head base='' candidate
  head=$(git rev-parse -q --verify HEAD 2>/dev/null) || return 1
  for candidate in origin/main "$(git describe --tags --abbrev=0 2>/dev/null)" HEAD~1; do
    base=$(git merge-base HEAD "${candidate:-nowhere}" 2>/dev/null) && [ "$base" != "$head" ] && break
    base=
  done
  [ -n "$base" ] || return 1
  git diff --name-only --diff-filter=d "$base" -- 'src/*.[ch]' | while read -r file; do
    case $file in
      *.c) echo "$file" ;;
      *) grep -rlF --include='*.c' "\"${file#src/}\"" src | head -n 1 ;;
    esac
  done | sort -u
}

if [ -n "$seconds" ]; then
  sources=$(changed_sources) || { echo "clang-tidy: no earlier commit to compare with, nothing looked at"; exit 0; }
else
  sources=$(find src -name '*.c' | sort)
fi
[ -n "$sources" ] || exit 0

# clang takes no headers that gcc has compiled.
mkdir -p "$build/tidy"
sed -E 's/ -Winvalid-pch -include [^ ]+//' "$build/compile_commands.json" >"$build/tidy/compile_commands.json"

export build until=$(($(date +%s) + ${seconds:-86400})) late=$build/tidy-late.txt
: >"$late"
xargs -P "$jobs" -n 1 sh -c '[ "$(date +%s)" -lt "$until" ] || { echo "$0" >>"$late"; exit 0; }
  exec clang-tidy -p "$build/tidy" --quiet --warnings-as-errors="*" "$0"' <<<"$sources" 2>"$build/tidy-log.txt"
status=$?
[ ! -s "$late" ] || echo "clang-tidy: $(wc -l <"$late") of $(wc -l <<<"$sources") sources left when $seconds s were over; make tidy looks at all"
exit $status
