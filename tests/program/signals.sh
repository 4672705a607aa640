#!/bin/sh
# signals.sh TALUS RANKS: SIGINT and SIGTERM in mid-run. The step is finished, state and history are whole, exit code 1.
. "$(dirname "$0")/library.sh"
ranks=$2
block | sed 's/end: 0.4/end: 1000/' >block.yaml

# Until the history has rows: the run is in its steps then.
wait_for_rows() {
  for i in $(seq 400); do
    [ -s run/history.csv ] && [ "$(wc -l <run/history.csv)" -gt 5 ] && return
    sleep 0.05
  done
  fail "$name: the run does not start"
}

# interrupted SIGNAL WHOM: `job` (mpiexec, or the program itself on one rank) or one `rank`.
interrupted() {
  name="SIG$1 to $2"
  rm -rf run
  if [ "$ranks" -eq 1 ]; then "$talus" run block.yaml --out run --quiet >out.txt 2>err.txt </dev/null &
  else mpiexec --oversubscribe -n "$ranks" "$talus" run block.yaml --out run --quiet >out.txt 2>err.txt </dev/null &
  fi
  job=$!
  wait_for_rows
  if [ "$2" = rank ]; then kill -"$1" "$(pgrep -P "$job" | tail -n 1)"; else kill -"$1" "$job"; fi
  wait "$job"
  code=$?
  [ "$code" -eq 1 ] || fail "$name: exit code $code"
  says err.txt "the run was interrupted by a signal, after step" "is kept in run"
  [ "$(grep -c 'was interrupted' err.txt)" -eq 1 ] || fail "$name: it is not said once"
  step=$(sed -n 's/^interrupted = by a signal, after step //p' run/log.txt)
  [ "$(tail -n 1 run/history.csv | cut -d, -f2)" = "$step" ] || fail "$name: the last row is not of step '$step'"
  time=$(tail -n 1 run/history.csv | cut -d, -f1)
  grep '"name"' run/points.hdf.series | tail -n 1 | grep -q -F "\"time\": $time}" || fail "$name: the last state is not of t = $time"
  [ -s run/timings.txt ] || fail "$name: no timings"
}

interrupted INT job
interrupted TERM job
if [ "$ranks" -gt 1 ]; then interrupted TERM rank; fi
expect "plot of what is there" 0 "$talus" plot run
finish
