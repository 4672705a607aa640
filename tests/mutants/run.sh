#!/bin/bash
# run.sh [--list | --check | --continue] SOURCE: seeds one fault after another and sees whether a test fails.
#
# A fault is a patch, tests/mutants/<room>/<name>.patch. Its first line says what it breaks; a line "Equal: ..." says
# why no test can notice, and then it is tried only when it is named. Each is put into a copy of the sources in BUILD
# (build-mutants), in which all rooms are one shared library, so that one source is compiled and one library linked. Then
# tests run until one fails twice: those of the room, then those of the rooms that know it, cheap ones and those of one
# rank first. Their cost comes from a first round without a fault, in which all must pass.
#
#   --list      what there is      --check  does each patch fit, has it a header, does it change few lines?
#   --continue  keep the results that are there
#   ROOM=solve, MUTANT=name: only those     WORKERS=2: as many copies side by side
#   ASK=0.95: the share that must be caught     MOST=5: only tests that take no longer than this, s: a first look
set -u
mode=run resume=
while [[ ${1:-} == --* ]]; do
  case $1 in
    --list | --check) mode=${1#--} ;;
    --continue) resume=1 ;;
    *) sed -n 2,14p "$0" >&2; exit 2 ;;
  esac
  shift
done
source=$(cd "${1:?the root of the sources}" && pwd) || exit 2
build=${BUILD:-$source/build-mutants} workers=${WORKERS:-1} ask=${ASK:-0.95}
mapfile -t mutants < <(cd "$source/tests/mutants" && find . -name '*.patch' | sed 's,^\./,,; s,\.patch$,,' | sort |
  awk -F / -v room="${ROOM:-}" -v name="${MUTANT:-}" '(room == "" || $1 == room) && (name == "" || $2 == name)')
[ ${#mutants[@]} -gt 0 ] || { echo "there is no such mutant" >&2; exit 2; }

patch_of() { echo "$source/tests/mutants/$1.patch"; }
what_of() { head -n 1 "$(patch_of "$1")"; }
is_equal() { grep -q '^Equal: ' "$(patch_of "$1")"; }
put_in() { patch -p1 -s -f --no-backup-if-mismatch -r - -d "$2" "${@:3}" <"$(patch_of "$1")"; }

# Is each patch what it should be: a line of words, one to three lines changed in a source of its room? One awk for all,
# since hundreds of processes cost more than what they look at.
check_words() {
  (cd "$source/tests/mutants" && awk '
    function end() {
      if (files != 1 || all != 1 || gone > 3 || come > 3 || gone + come == 0)
        print name ": it must change one to three lines of one file in src/" room
    }
    FNR == 1 {
      if (name) end()
      name = FILENAME; sub(/\.patch$/, "", name); room = name; sub(/\/.*/, "", room); files = all = gone = come = 0
      if ($0 !~ /^[A-Z].*[a-z.]$/) print name ": its first line does not say what it breaks"
    }
    /^\+\+\+ / {files += index($2, "b/src/" room "/") == 1; all++; next}
    /^--- / {next}
    /^-/ {gone++}
    /^\+/ {come++}
    END {end()}' "${mutants[@]/%/.patch}")
}

# Does each patch fit?
check_fit() {
  local mutant said
  for mutant in "${mutants[@]}"; do
    said=$(put_in "$mutant" "$source" --dry-run 2>&1) || echo "$mutant: does not fit: ${said##*$'\n'}"
  done
}

if [ $mode = list ]; then
  for mutant in "${mutants[@]}"; do printf '%-40s %s\n' "$mutant" "$(what_of "$mutant")"; done
  exit 0
elif [ $mode = check ]; then
  bad=$(check_words; check_fit)
  [ -z "$bad" ] || { echo "$bad" >&2; exit 1; }
  echo "${#mutants[@]} faults fit"
  exit 0
fi

mkdir -p "$build" && build=$(cd "$build" && pwd) || exit 2
results=$build/results
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OPENBLAS_NUM_THREADS=1
export CCACHE_BASEDIR=$build CCACHE_NOHASHDIR=1
launcher=
! command -v ccache >/dev/null || launcher=-DCMAKE_C_COMPILER_LAUNCHER=ccache

# The sources as they are now: only what differs is copied, and gets a time of its own, so that it alone is built again.
copy_sources() {
  mkdir -p "$1"
  (cd "$source" && git ls-files -co --exclude-standard) | while IFS= read -r file; do
    [ -f "$source/$file" ] || continue
    cmp -s "$source/$file" "$1/$file" || { mkdir -p "$1/$(dirname "$file")" && cp "$source/$file" "$1/$file"; }
  done
  (cd "$1" && find src tests cases include -type f) | while IFS= read -r file; do
    [ -e "$source/$file" ] || rm "$1/$file"
  done
}
prepare() { # the copy of one worker, whole and built
  copy_sources "$1" && cmake -S "$1" -B "$1/build" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release \
    -DTALUS_TEST_SHARED=ON $launcher >"$1/configure.log" && ninja -C "$1/build" talus tests >"$1/build.log"
}
passes() { # test, seconds: a test that hangs has failed
  timeout -k 10 "$2" ctest --test-dir build -R "^$1\$" --no-tests=error >test.log 2>&1 </dev/null
}

# First round: TEST SECONDS of all that pass and have none yet; `kill` ends runs at random moments and is left out.
first_round() {
  cd "$build/1" || exit 2
  for test in $(ctest --test-dir build -N | sed -n 's/^ *Test *#[0-9]*: //p' |
    grep -v -e '^program/kill' -e '^mutants/'); do
    ! grep -q "^$test " "$build/cost.txt" || continue
    local start=$EPOCHREALTIME
    if passes "$test" 1000 || passes "$test" 1000; then
      awk -v t="$test" -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN {printf "%s %.2f\n", t, b - a}' >>"$build/cost.txt"
    else
      echo "$test fails without any fault and counts for nothing"
    fi
  done
}

# Tests and limits in the order for a room: its own, then those of the rooms behind it, which alone know it, the solver's
# first; one rank, then several; cheap, then dear.
order() {
  awk -v room="$1" -v most="${MOST:-1e9}" '
    BEGIN {names = "base case material basis grid points formulation boundary solve method model io run api cli program"
      n = split(names, rooms, " ")
      for (i = 1; i <= n; ++i) place[rooms[i]] = i}
    {test_room = $1; sub("/.*", "", test_room)
     if (test_room in place && place[test_room] < place[room] || $2 > most) next
     own = test_room == room || room == "cli" && test_room == "program"; many = $1 ~ "(_[23]|/ranks|/signals_2)$"
     far = own ? 0 : (test_room == "cli" || test_room == "program") && place[room] <= place["model"] ? 2 : 1
     printf "%d %d %s %s %d\n", far, many, $2, $1, 60 + 20 * $2}' "$build/cost.txt" |
    sort -k 1,1n -k 2,2n -k 3,3n | cut -d ' ' -f 4,5
}

# One fault in the copy here: result on standard output.
try() {
  local mutant=$1 file test limit
  if is_equal "$mutant" && [ -z "${MUTANT:-}" ]; then
    echo equal
    return
  fi
  file=$(sed -n 's,^+++ b/\([^ 	]*\).*,\1,p' "$(patch_of "$mutant")")
  cp "$file" original
  if ! put_in "$mutant" . >patch.log 2>&1; then
    echo "broken does not fit"
  elif ! ninja -C build talus tests >build.log 2>&1; then
    echo "broken does not compile"
  else
    while read -r test limit; do
      passes "$test" "$limit" || passes "$test" "$limit" || break
      test=
    done < <(order "${mutant%%/*}")
    if [ -n "$test" ]; then echo "caught $test"; else echo "survived"; fi
  fi
  cp original "$file"
}

work() { # worker
  cd "$build/$1" || exit 2
  for mutant in "${mutants[@]}"; do
    local result=$results/$mutant
    [ ! -e "$result" ] && mkdir "$result.claim" 2>/dev/null || continue
    local start=$SECONDS
    try "$mutant" >"$result.new" && mv "$result.new" "$result"
    rmdir "$result.claim"
    printf '%-40s %s (%d s)\n' "$mutant" "$(cat "$result")" $((SECONDS - start))
  done
}

main() { # read as a whole before it runs, so that the file may change meanwhile
  [ -n "$resume" ] || rm -f "$build/cost.txt"
  [ -n "$resume" ] || for mutant in "${mutants[@]}"; do rm -f "$results/$mutant"; done
  touch "$build/cost.txt"
  for mutant in "${mutants[@]}"; do mkdir -p "$results/${mutant%/*}"; done
  find "$results" -name '*.claim' -exec rmdir {} +
  for ((w = 1; w <= workers; w++)); do
    prepare "$build/$w" || { echo "the copy $build/$w does not build, see build.log there" >&2; exit 2; }
  done
  first_round
  for ((w = 1; w <= workers; w++)); do work $w & done
  wait

  # Words for each room, then what was not caught, then the share.
  for mutant in "${mutants[@]}"; do
    read -r result by < <(cat "$results/$mutant" 2>/dev/null || echo "broken was not tried")
    [ "$result" != survived ] || ! is_equal "$mutant" || result=equal by=
    printf '%s\t%s\t%s\t%s\t%s\n' "${mutant%%/*}" "$mutant" "$result" "$by" "$(what_of "$mutant")"
  done >"$build/results.txt"
  awk -F '\t' -v ask="$ask" '
    {n[$1]++; count[$1, $3]++; all[$3]++; if ($3 != "caught") rest = rest sprintf("%-9s %s %s: %s\n", $3, $2, $4, $5)}
    END {
      printf "\n%-12s %6s %6s %8s %6s %6s\n", "room", "faults", "caught", "survived", "equal", "broken"
      for (room in n) {
        printf "%-12s %6d %6d %8d %6d %6d\n", room, n[room], count[room, "caught"], count[room, "survived"],
          count[room, "equal"], count[room, "broken"] | "sort"
      }
      close("sort")
      share = NR > all["equal"] ? all["caught"] / (NR - all["equal"]) : 1
      printf "\n%s%d of %d caught (%.1f %%), %d equal, %d broken\n", rest, all["caught"], NR - all["equal"], 100 * share,
        all["equal"], all["broken"]
      exit share < ask || all["broken"] > 0
    }' "$build/results.txt"
}
main
exit
