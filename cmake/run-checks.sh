#!/bin/bash
# run-checks.sh BUILD: what a change must pass besides the tests: the format, the site of the documentation, clang-tidy on
# what changed, that the benchmarks build, the fast tests under sanitizers. The last line is `N passed, N failed`, kept in
# BUILD/check-summary.txt too.
set -u
build=$1 passed=0 failed=0
mkdir -p "$build"
rm -f "$build/check-summary.txt" "$build-sanitize/test-summary.txt"

# count NAME STATUS SECONDS [PASSED FAILED]
count() {
  passed=$((passed + ${4:-($2 == 0)})) failed=$((failed + ${5:-($2 != 0)}))
  echo "$1: $([ "$2" -eq 0 ] && echo good || echo FAILED), $3 s"
}

# Of the 900 s of .ci/run, the seconds that are spent; elsewhere none.
spent() {
  now=$(date +%s)
  echo $((now - ${CHECK_STARTED:-$now}))
}

# What would not end in time is left out, and clang-tidy looks at as many sources as it can.
for check in format-check docs 'tidy CHANGED=1'; do
  SECONDS=0
  tools=${check%%[- ]*}
  left=$((860 - $(spent)))
  if [ "$tools" != format ] && [ "$left" -lt 45 ]; then
    echo "make $check: left out, $(spent) s are spent"
    continue
  fi
  if ! cmake/debian-packages.sh "$tools"; then
    echo "make $check: its tools cannot be installed here, nothing looked at"
    continue
  fi
  make $check BUILD="$build" TIDY_SECONDS=$((left < 60 ? left : 60))
  count "make $check" $? $SECONDS
done

if [ "$(spent)" -lt 840 ]; then
  SECONDS=0
  cmake --build "$build" --target bench >/dev/null
  count 'benchmarks build' $? $SECONDS
fi

if [ "$(spent)" -gt 500 ]; then # these take 300 to 400
  echo "make test-sanitize FAST=1: left out, $(spent) s are spent"
else
  SECONDS=0
  make test-sanitize FAST=1 BUILD="$build"
  status=$? numbers=
  [ ! -f "$build-sanitize/test-summary.txt" ] || numbers=$(tr -dc '0-9 ' <"$build-sanitize/test-summary.txt")
  count 'make test-sanitize FAST=1' $status $SECONDS $numbers
fi

echo "$passed passed, $failed failed" | tee "$build/check-summary.txt"
[ "$failed" -eq 0 ]
