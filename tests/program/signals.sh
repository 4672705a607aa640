#!/bin/sh
# signals.sh TALUS RANKS: signals that ask a run to end, in mid-run. State and history are whole, there is a checkpoint, exit code 1.
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
  [ "$(ls run/checkpoint_*.h5 | wc -l)" -eq 1 ] || fail "$name: no checkpoint"
}

interrupted INT job
interrupted TERM job
# Of these mpiexec passes on what batch systems send; the others come to the ranks themselves.
if [ "$ranks" -gt 1 ]; then
  for signal in TERM XCPU USR1; do interrupted $signal rank; done
  interrupted USR1 job
  interrupted USR2 job
else
  for signal in HUP QUIT USR1 USR2 XCPU; do interrupted $signal job; done

  # A limit of processor time: SIGXCPU at the soft one, and again every second; the run is done well before the hard one.
  name="ulimit -t" && rm -rf run
  (ulimit -S -t 2; ulimit -H -t 60; "$talus" run block.yaml --out run --quiet >out.txt 2>err.txt </dev/null)
  code=$?
  [ "$code" -eq 1 ] || fail "$name: exit code $code"
  says err.txt "the run was interrupted by a signal, after step"

  # nohup: a SIGHUP that was ignored at the start stays so
  name="nohup" && rm -rf run
  nohup "$talus" run block.yaml --out run --quiet >out.txt 2>err.txt </dev/null &
  job=$!
  wait_for_rows
  kill -HUP "$job"
  sleep 0.3
  kill -0 "$job" || fail "$name: SIGHUP ended the run"
  kill -TERM "$job"
  wait "$job"
  [ $? -eq 1 ] || fail "$name: exit code"
fi
expect "plot of what is there" 0 "$talus" plot run --size 320x240
finish
