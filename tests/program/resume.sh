#!/bin/sh
# A run that goes on from its checkpoint is the run that was never cut off: the same bits on the same number of ranks, the same answer on
# others. Damaged checkpoints are passed over, and what makes no sense is refused.
compare="$(cd "$(dirname "$0")" && pwd)/compare.awk"
. "$(dirname "$0")/library.sh"
quick_block | sed 's/every: 0.1/every: 0.02/; s/end: 0.2/end: 0.16/' >block.yaml
often="--set checkpoint.steps=30 --set checkpoint.keep=100"

# forget DIR STEP: as if the run had died just before the first checkpoint after this step.
forget() {
  for file in "$1"/checkpoint_*.h5; do
    [ "$(basename "$file" .h5 | sed 's/checkpoint_0*//')" -le "$2" ] || rm "$file"
  done
}

# same_bits NAME A B: all results of two runs.
same_bits() {
  for file in $(cd "$2" && ls history.csv *.hdf *.hdf.series); do
    cmp -s "$2/$file" "$3/$file" || fail "$1: $file differs"
  done
  [ "$(ls "$2"/*.hdf | wc -l)" -eq "$(ls "$3"/*.hdf | wc -l)" ] || fail "$1: more states than there should be"
  if ls "$3"/*unfinished >/dev/null 2>&1; then fail "$1: an unfinished file"; fi
}

# The same bits: dynamics of mpm on 1 and 2 ranks, with states and rows after the checkpoint that are replaced. And on
# another number of ranks: three, which are dear, and one.
for from in 1 2; do
  expect "whole on $from" 0 on_ranks $from "$talus" run block.yaml --out whole$from --quiet $often
  cp -r whole$from cut && forget cut 67
  expect "resumed on $from" 0 on_ranks $from "$talus" run --resume cut --quiet
  says cut/log.txt "resumed = step 60 time = 0.12 ranks = $from"
  same_bits "$name" whole$from cut
  rm -r cut
  to=$((5 - 2 * from))
  cp -r whole$from cut && forget cut 67
  expect "from $from to $to ranks" 0 on_ranks $to "$talus" run --resume cut --quiet
  says cut/log.txt "ranks = $to"
  says cut/version.txt "ranks = $to"
  awk -f "$compare" whole$from/history.csv cut/history.csv >difference.txt || { fail "$name: differs"; head -n 5 difference.txt; }
  rm -r cut
done

# cut_and_resumed TITLE RANKS WHERE OPTION...: case.yaml with a checkpoint at its second step, resumed there on the `same` ranks, on
# `others` or on `both`. MUMPS on several ranks works in the order in which messages arrive: no two runs are the same to the last bit.
cut_and_resumed() {
  title=$1 ranks=$2 where=$3
  shift 3
  expect "$title on $ranks" 0 on_ranks "$ranks" "$talus" run case.yaml --out whole --force --quiet --set checkpoint.steps=2 --set checkpoint.keep=99 "$@"
  cp -r whole cut && forget cut 2 && cp -r cut other
  if [ "$where" != others ]; then
    expect "$title on $ranks, resumed" 0 on_ranks "$ranks" "$talus" run --resume cut --quiet
    if [ "$ranks" -eq 1 ] || ! grep -q MUMPS whole/log.txt; then same_bits "$name" whole cut
    else awk -f "$compare" whole/history.csv cut/history.csv >difference.txt || fail "$name: differs"
    fi
  fi
  if [ "$where" != same ]; then
    expect "$title on $ranks, resumed on $((3 - ranks))" 0 on_ranks $((3 - ranks)) "$talus" run --resume other --quiet
    awk -f "$compare" whole/history.csv other/history.csv >difference.txt || { fail "$name: differs"; head -n 5 difference.txt; }
  fi
  rm -r cut other
}

# Finite elements, whose nodes remember; multigrid; a mesh; loads that are carried, tracers, and a measure with a memory
cantilever | sed 's/size: 0.5/size: 0.25/; s/steps: 1/steps: 5/' >case.yaml
cut_and_resumed "static fem" 1 both --set method=fem
cut_and_resumed "static mpm" 1 same
cut_and_resumed "shared volumes of fem" 1 same --set method=fem --set formulation=mean-dilatation
cut_and_resumed "shared volumes of mpm" 2 others --set formulation=mean-dilatation
cut_and_resumed "multigrid" 3 same --set linear=iterative
cut_and_resumed "dynamic fem" 1 both --set method=fem --set 'analysis={type: dynamic, end: 0.1, step: 0.02}'
cat >case.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: dynamic, step: 2e-3, end: 0.02}
grid: {box: {min: [0, 0, 0], max: [1.6, 0.8, 0.8]}, size: 0.1}
bodies:
  - {name: box, shape: {box: {min: [0.3, 0.2, 0.1], max: [0.7, 0.6, 0.4]}}, points_per_cell: 8, material: rubber,
     velocity: [3, 0, -3], spin: [0, 0, 5], spin_centre: [0.5, 0.4, 0.3]}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0.3}
boundary:
  - {on: {boundary: front}, fix: [z]}
loads:
  gravity: [0, 0, -9.81]
  tractions: [{on: {body: box, z: 0.4}, value: [1000, 0, -300]}]
measures:
  top: {position: z, of: {tracer: [0.5, 0.4, 0.35]}}
  turn: {angular_momentum: z}
  floor: {reaction: z, of: {boundary: 0}}
  rest: {run_out_time: {max: x, speed: 3.2}}
  elastic: {energy: elastic}
output: {every: 0.01, history: {steps: 2}}
END
cut_and_resumed "carried loads in space" 2 both --set newton.residual=1e-12
lacks whole/log.txt MUMPS
# Clouds, whose nodes remember and change their ranks: what is left of the body's fall on the floor, and a bar that is held by multipliers. The fall ends
# before two points come to the edge of all nodes, where clouds grow so steeply that 1e-9 of a place is 1e-3 of a force (at 0.027 s).
cut_and_resumed "a cloud in space" 2 both --set analysis.end=0.016 --set method=gmm --set 'basis={lme: {}}' --set linear=iterative --set newton.residual=1e-12
lacks whole/log.txt MUMPS
cantilever | sed 's/size: 0.5/size: 0.25/; s/steps: 1/steps: 5/' >case.yaml
cut_and_resumed "static gmm" 1 both --set method=gmm --set 'basis={mls: {}}'
plate 3
cut_and_resumed "mesh by gmsh" 1 both

finish
