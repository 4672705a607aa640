#!/bin/sh
# What is no equilibrium is never an answer: what the program says, and how it ends.
. "$(dirname "$0")/library.sh"

# Nothing holds the beam: refused before the first step, by check as well.
for method in mpm fem gmm; do
  cantilever | sed "s/^method: .*/method: $method/; /^boundary/,/wall/d" >case.yaml
  for command in run check; do
    expect "$method, $command: nothing held" 2 "$talus" "$command" case.yaml
    says err.txt "case.yaml:" "nothing holds 'beam' in x and y: a static analysis has no answer" "analysis: {type: dynamic}"
  done
done

# A linear solver that returns what it was given: typed on the command line, where everything of PETSc's may be.
cantilever >case.yaml
expect "useless solver" 1 "$talus" run case.yaml --out useless -ksp_type gmres -pc_type jacobi -ksp_rtol 1
says err.txt "increments vanished and the residual did not" "the linear solver does nothing"
[ "$(wc -l <useless/history.csv)" -eq 2 ] || fail "useless solver: steps were accepted"
