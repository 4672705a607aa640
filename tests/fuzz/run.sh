#!/bin/sh
# run.sh BUILD SECONDS: each fuzzer for so long, from the corpus beside this file. New inputs stay in BUILD; a crash, a leak or an input that takes
# over a second of processor time (or sleeps for ten minutes) ends it with the input's name. The number of executions is printed.
set -eu
build=$1 seconds=$2
corpus=$(cd "$(dirname "$0")" && pwd)/corpus
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 LSAN_OPTIONS=suppressions=$(dirname "$corpus")/../../cmake/lsan.supp:print_suppressions=0
status=0
for name in case mesh geo checkpoint; do
  mkdir -p "$build/found/$name"
  log=$build/fuzz-$name.txt
  "$build/fuzz_$name" -max_total_time="$seconds" -timeout=600 -rss_limit_mb=2048 -max_len=8192 -print_final_stats=1 -close_fd_mask=1 \
    -artifact_prefix="$build/found-$name-" "$build/found/$name" "$corpus/$name" >"$log" 2>&1 || { status=1; tail -n 40 "$log"; }
  echo "$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1) executions, $(ls "$build/found/$name" | wc -l) inputs found"
done
exit $status
