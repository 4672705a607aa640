#!/bin/bash
# run-tests.sh BUILD JOBS [CTEST ARGUMENT...]: runs the tests; the last line is `N passed, N failed`, kept in
# BUILD/test-summary.txt too. A test that could not run has failed; one that says it cannot run here is skipped.
set -u
build=$1 jobs=$2
shift 2
log=$build/test-log.txt summary=$build/test-summary.txt
rm -f "$summary"

# What tests write goes into memory where there is room for it and programs may lie there: a run waits for the disk at every
# file that it keeps, and cores are idle meanwhile.
if [ -z "${TMPDIR:-}" ] && [ "$(df --output=avail /dev/shm 2>/dev/null | tail -n 1)" -gt 2000000 ] 2>/dev/null &&
  memory=$(mktemp -d /dev/shm/talus.XXXXXX); then
  trap 'rm -rf "$memory"' EXIT
  if cp "$(type -P true)" "$memory/true" && "$memory/true" 2>/dev/null; then export TMPDIR=$memory; fi
fi

ctest --test-dir "$build" --parallel "$jobs" --output-on-failure --no-tests=error "$@" 2>&1 | tee "$log"
status=${PIPESTATUS[0]}

read -r failed total < <(sed -n 's/.*tests passed, \([0-9]*\) tests failed out of \([0-9]*\).*/\1 \2/p' "$log" | tail -n 1)
skipped=$(grep -c '^[[:space:]]*[0-9]* - .* (Skipped)$' "$log")
disabled=$(grep -c '^[[:space:]]*[0-9]* - .* (Disabled)$' "$log")
if [ -z "${total:-}" ]; then
  failed=0 total=0
  [ "$status" -ne 0 ] || status=1
fi
[ $((skipped + disabled)) -eq 0 ] || echo "$skipped skipped, $disabled disabled"
echo "$((total - failed - skipped)) passed, $failed failed" | tee "$summary"
exit "$status"
