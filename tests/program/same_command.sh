#!/bin/sh
# Ranks of one mpiexec that were started with different words: an error within seconds, not a wait for ever.
. "$(dirname "$0")/library.sh"
block | sed 's/end: 0.4/end: 0.02/' >block.yaml
cantilever >beam.yaml

# different NAME SAID FIRST : SECOND, each a line of words.
different() {
  name=$1
  timeout 60 mpiexec --oversubscribe -n 1 "$talus" $3 : -n 2 "$talus" $4 >out.txt 2>err.txt </dev/null
  code=$?
  [ "$code" -eq 2 ] || fail "$name: exit code $code"
  says err.txt "error: rank 0 was started as 'talus $3' and rank 1 as 'talus $4'" "all ranks of one mpiexec work on the same run"
  [ "$(grep -c 'was started as' err.txt)" -eq 1 ] || fail "$name: it is not said once"
  $2
}
nothing() { [ ! -e a ] && [ ! -e b ] || fail "$name: a run began"; }
different "two cases" nothing "run block.yaml --out a" "run beam.yaml --out b"
different "two commands" nothing "run block.yaml --out a" "check block.yaml"
different "two settings" nothing "run block.yaml --out a" "run block.yaml --out a --set analysis.end=0.1"
different "two solvers" nothing "run block.yaml --out a" "run block.yaml --out a -ksp_type gmres"
expect "the same words" 0 mpiexec --oversubscribe -n 1 "$talus" run block.yaml --out a --quiet : -n 2 "$talus" run block.yaml --out a --quiet

finish
