#!/bin/sh
# A run directory that is removed, renamed or replaced under a run: an error, and nothing is written into what stands there then.
. "$(dirname "$0")/library.sh"
block | sed 's/end: 0.4/end: 1000/; s/every: 0.1/every: end/' >block.yaml

# vanished NAME RANKS COMMAND: what is done to the directory `run` in mid-run.
vanished() {
  name=$1
  rm -rf run other
  on_ranks "$2" "$talus" run block.yaml --out run --quiet >out.txt 2>err.txt </dev/null &
  job=$!
  for i in $(seq 400); do
    [ -s run/history.csv ] && [ "$(wc -l <run/history.csv)" -gt 5 ] && break
    sleep 0.05
  done
  eval "$3"
  for i in $(seq 400); do kill -0 "$job" 2>/dev/null || break; sleep 0.05; done
  if kill -0 "$job" 2>/dev/null; then
    fail "$name: it goes on"
    kill -KILL "$job"
  fi
  wait "$job"
  code=$?
  [ "$code" -eq 1 ] || fail "$name: exit code $code"
  says err.txt "error: the run directory run was removed, renamed or replaced while the run was at work"
}
vanished "removed" 1 "rm -rf run"
[ ! -e run ] || fail "$name: it came back"
vanished "renamed" 1 "mv run other"
says other/log.txt "error = the run directory run was removed"
vanished "replaced" 2 "mv run other && mkdir run && echo mine >run/notes.txt"
[ "$(ls run)" = notes.txt ] || fail "$name: something was written into it"

finish
