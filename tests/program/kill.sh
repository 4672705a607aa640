#!/bin/sh
# kill.sh TALUS RANKS KILLS [SEED]: a run is killed (SIGKILL) again and again at random moments, also while it writes, and resumed every time.
# In the end it has the same bits as one that nobody touched. On several ranks sometimes one rank is killed, sometimes all.
. "$(dirname "$0")/library.sh"
ranks=$2 kills=$3 seed=${4:-$(od -An -N3 -tu4 /dev/urandom | tr -d ' ')}
echo "seed $seed"
block | sed 's/end: 0.4/end: 0.24/; s/every: 0.1/every: 0.01/' >block.yaml
# A checkpoint at nearly every step: as much of the time as can be is spent on writing.
often="--set checkpoint.steps=2 --set checkpoint.keep=2"

# The random number number $1, 0 to 1.
random() { awk -v seed=$((seed + $1)) 'BEGIN { srand(seed); rand(); print rand() }'; }

# start COMMAND...: the program in the background as $job.
start() {
  if [ "$ranks" -eq 1 ]; then "$@" >out.txt 2>err.txt </dev/null &
  else mpiexec --oversubscribe -n "$ranks" "$@" >out.txt 2>err.txt </dev/null &
  fi
  job=$!
}

# Processes of the job that compute.
workers() { if [ "$ranks" -eq 1 ]; then echo "$job"; else pgrep -P "$job"; fi; }

# Kill all or (on several ranks, at odd kills) only one; then everything must be gone in a few seconds by itself.
kill_job() {
  mine=$(workers)
  if [ "$ranks" -gt 1 ] && [ $(($1 % 2)) -eq 1 ]; then
    one=$(echo "$mine" | tail -n 1)
    [ -z "$one" ] || kill -KILL "$one" 2>/dev/null
    wait "$job" 2>/dev/null
    code=$?
    if [ -n "$one" ] && [ $code -ne 0 ]; then
      grep -q 'signal 9\|exited on signal\|lost connection\|not able to complete' err.txt out.txt || fail "kill $1: nothing is said of the rank that died"
      one_rank=$((one_rank + 1))
    fi
  else
    # shellcheck disable=SC2086 # a list of processes
    kill -KILL $mine $job 2>/dev/null
    wait "$job" 2>/dev/null
    code=$?
  fi
  for pid in $mine; do
    for i in $(seq 100); do kill -0 "$pid" 2>/dev/null || break; sleep 0.05; done
    if kill -0 "$pid" 2>/dev/null; then fail "kill $1: process $pid goes on alone"; kill -KILL "$pid"; fi
  done
}

start_time=$(date +%s%N)
expect "whole" 0 on_ranks "$ranks" "$talus" run block.yaml --out whole --quiet $often
span=$((($(date +%s%N) - start_time) / 1000000))

done_runs=0 killed=0 in_write=0 again=0 one_rank=0 n=0
rm -rf run
# Kills may all come before there is anything to resume: one run, at least, comes to its end.
while [ "$killed" -lt "$kills" ] || [ "$done_runs" -eq 0 ] || [ -e run ]; do
  n=$((n + 1))
  [ $n -lt $((20 * kills + 20)) ] || { fail "the run gets nowhere"; break; }
  if [ -s run/case.yaml ] && [ -e run/log.txt ]; then start "$talus" run --resume run --quiet
  else start "$talus" run block.yaml --out run --force --quiet $often; again=$((again + 1))
  fi
  # Mostly soon, so that a run is hit many times; after the last kill it is left alone.
  if [ "$killed" -lt "$kills" ]; then
    sleep "$(awk -v r="$(random $n)" -v t="$span" 'BEGIN { printf "%.3f", 0.001 * t * (0.1 + 0.45 * r) }')"
    kill_job $n
    if ls run/*unfinished >/dev/null 2>&1; then in_write=$((in_write + 1)); fi
  else
    wait "$job"
    code=$?
  fi
  if [ "$code" -ge 128 ] || { [ "$ranks" -gt 1 ] && [ "$code" -ne 0 ]; }; then killed=$((killed + 1)); continue; fi
  # It was quicker than the killer: compare, and begin another one.
  [ "$code" -eq 0 ] || { fail "after $killed kills: exit code $code"; break; }
  done_runs=$((done_runs + 1))
  for file in $(cd whole && ls history.csv *.hdf *.hdf.series); do
    cmp -s whole/$file run/$file || fail "after $killed kills: $file differs"
  done
  [ "$(ls whole/*.hdf | wc -l)" -eq "$(ls run/*.hdf | wc -l)" ] || fail "after $killed kills: the number of states"
  if ls run/*unfinished run/*.damaged >/dev/null 2>&1; then fail "after $killed kills: an unfinished or damaged file"; fi
  rm -rf run
done
echo "$killed kills, $in_write of them in the middle of a file, $one_rank of a single rank; $done_runs runs compared, $again starts from nothing"
[ "$done_runs" -gt 0 ] || fail "no run came to its end"
finish
