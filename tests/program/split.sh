#!/bin/sh
# Points that are split (`basis: {gimp: {split: ...}}`) by the whole program: the same answer on 1, 2 and 3 ranks, the same bits after a
# resume, nothing lost on a floor of nodes and on a wall that rubs, and what is refused.
compare="$(cd "$(dirname "$0")" && pwd)/compare.awk"
. "$(dirname "$0")/library.sh"

# A tall column of wet grains that slumps: its foot is stretched to more than twice its width.
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {gimp: {split: 0.55}}
analysis: {type: dynamic, step: 4e-3, end: 0.3}
grid: {box: {min: [0, -0.02], max: [0.4, 0.28]}, size: 0.02, cell: quadrilateral}
bodies:
  - {name: column, shape: {box: {min: [0, 0], max: [0.08, 0.24]}}, points_per_cell: 9, material: grains}
materials:
  grains: {law: mohr-coulomb, density: 2000, young: 1e6, poisson: 0.3, friction_angle: 20, cohesion: 50}
boundary:
  - {on: {boundary: left}, fix: [x]}
  - {on: {y: [-0.02, 0]}, fix: [x, y]}
loads: {gravity: [0, -9.81]}
measures:
  mass: {mass: total, of: {body: column}}
  front: {extent: {max: x, beyond: 0.01}, of: {body: column}}
  height: {extent: {max: y}, of: {body: column}}
  kinetic: {energy: kinetic}
  balance: {energy: balance}
output: {fields: [displacement, velocity, id], every: 0.1}
checkpoint: {steps: 25, keep: 99}
newton: {residual: 1e-11}
END

# last COLUMN DIR: its number in the last row of the history.
last() {
  awk -F, -v name="$1" 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ "^" name) c = k } END { print $c }' "$2/history.csv"
}

# whole DIR: the mass of 0.08 m x 0.24 m x 2000 kg/m3 is there, and all energy is accounted for.
whole() {
  awk -v m="$(last mass "$1")" 'BEGIN { d = m / 38.4 - 1; exit !(d < 1e-12 && d > -1e-12) }' || fail "$name: mass $(last mass "$1")"
  awk -v b="$(last balance "$1")" 'BEGIN { exit !(b < 1e-6 && b > -1e-6) }' || fail "$name: balance $(last balance "$1")"
}

points() { sed -n 's/^points = \([0-9]*\) at the end.*/\1/p' "$1/log.txt"; }

for ranks in 1 2 3; do
  expect "a column on $ranks" 0 on_ranks $ranks "$talus" run case.yaml --out run$ranks --quiet
  whole run$ranks
  [ "$(points run$ranks)" -gt 550 ] || fail "$name: $(points run$ranks) points of 432"
  [ "$(points run$ranks)" -eq "$(points run1)" ] || fail "$name: $(points run$ranks) points, $(points run1) on one rank"
  [ $ranks != 2 ] || continue
  cp -r run$ranks cut && rm cut/checkpoint_*75.h5
  expect "resumed on $ranks" 0 on_ranks $ranks "$talus" run --resume cut --quiet
  says cut/log.txt "resumed = step 50"
  for file in history.csv points_000003.hdf; do cmp -s run$ranks/$file cut/$file || fail "$name: $file differs"; done
  rm -r cut
done


# On a wall
sed 's/^  - {on: {y: .*/walls:\n  - {name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction: 0.3}/' case.yaml >wall.yaml
expect "on a wall" 0 on_ranks 2 "$talus" run wall.yaml --out wall --quiet
whole wall
[ "$(points wall)" -gt 500 ] || fail "$name: $(points wall) points"

# What is refused, and what is warned of
expect "too fine" 2 "$talus" check case.yaml --set basis.gimp.split=0.1
says err.txt "points are split at 0.2 cells at the least, or never (0)"
expect "too coarse" 2 "$talus" check case.yaml --set basis.gimp.split=1.5
expect "explicit" 2 "$talus" check case.yaml --set analysis.type=explicit
says err.txt 'does not take points that are split'
expect "four points" 0 "$talus" check case.yaml --set 'bodies[0].points_per_cell=4' --set basis.gimp.split=0.4
says err.txt "points stand 0.5 cells apart at the start already"
expect "another basis" 2 "$talus" check case.yaml --set 'basis={bspline: {split: 0.5}}'
finish
