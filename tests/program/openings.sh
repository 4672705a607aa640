#!/bin/sh
# `talus check` says where an opening between held boundaries, or an orifice on the axis, is narrower than two cells.
. "$(dirname "$0")/library.sh"

# A silo of ten cells with a hole of one cell in its bottom.
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, step: 1e-3, end: 0.01}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.1, outside: remove}
bodies:
  - {name: sand, shape: {box: {min: [0, 0], max: [1, 0.5]}}, points_per_cell: 4, material: sand}
materials:
  sand: {law: mohr-coulomb, density: 1000, young: 2e5, poisson: 0.3, friction_angle: 30, cohesion: 0}
boundary:
  - {on: {boundary: bottom, x: [0, 0.4]}, fix: [x, y]}
  - {on: {boundary: bottom, x: [0.5, 1]}, fix: [x, y]}
  - {on: {boundary: left}, fix: [x]}
  - {on: {boundary: right}, fix: [x]}
loads: {gravity: [0, -9.81]}
END
for ranks in 1 2 3; do
  expect "a hole of one cell on $ranks" 0 on_ranks $ranks "$talus" check case.yaml
  says err.txt "case.yaml:9:1: warning: the opening of 0.1 m at (0.4, 0) m is narrower than two cells"
  [ "$(grep -c narrower err.txt)" -eq 1 ] || fail "$name: not told once"
done

# No warning.
wide() {
  expect "$1" 0 "$talus" check case.yaml "$@"
  lacks err.txt "narrower than two cells"
}
wide --set 'boundary[1].on.x=[0.6,1]' # two cells
wide --set 'boundary[1].on.x=[0.4,1]' # none

# Turned about the axis, the diameter counts: the mirror image of the edge is the other side.
sed 's/^  - {on: {boundary: bottom, x: \[0.5.*/  - {on: {boundary: top}, fix: [y]}/; s/x: \[0, 0.4\]/x: [0.1, 1]/; s/plane-strain/axisymmetric/' case.yaml >round.yaml
expect "an orifice of two cells" 0 "$talus" check round.yaml
lacks err.txt "narrower than two cells"
# Cells grow outwards: the orifice is narrower than two of those beside it.
expect "an orifice beside larger cells" 0 "$talus" check round.yaml --set 'grid={box: {min: [0, 0], max: [1, 1]}, counts: [10, 10], grading: {x: 5}}' \
  --set 'boundary[0].on={boundary: bottom, x: [0.03, 1]}'
says err.txt "the opening of 0.07" "narrower than two cells"
finish
