#!/bin/sh
# A column that is pressed by 1.36 times what it bears: what finds it straight says what that is worth, and a force
# aside with short steps bends it.
. "$(dirname "$0")/library.sh"

cat >column.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 10}
grid: {box: {min: [0, 0], max: [0.1, 2]}, counts: [4, 80]}
bodies: [{name: column, shape: {box: {min: [0, 0], max: [0.1, 2]}}, points_per_cell: 4, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e9, poisson: 0}}
formulation: mean-dilatation
boundary: [{on: {boundary: bottom}, fix: [x, y]}]
loads:
  points: [{at: [0.05, 2], force: [10, 0]}]
  tractions: [{name: weight, on: {boundary: top}, value: [0, -7e5]}]
measures: {aside: {displacement: x, of: {tracer: [0.05, 1.99]}}}
END

for ranks in 1 2 3; do
  expect "straight on $ranks" 0 on_ranks $ranks "$talus" run column.yaml --out straight$ranks
  says err.txt "from t = 0.75 s the equilibrium that was found is one in which nothing stays" "negative in 1 way,"
done
expect "bent" 0 "$talus" run column.yaml --out bent --set analysis.steps=40 --set 'loads.points[0].force=[1000, 0]'
! grep -q 'nothing stays' err.txt || fail "tells of what has bent"
awk -F, 'END { exit !($3 > 1.4 && $3 < 1.6) }' bent/history.csv || fail "does not bend as the elastica does"
expect "below" 0 "$talus" run column.yaml --out below --set 'loads.tractions[0].value=[0, -4.5e5]'
! grep -q 'nothing stays' err.txt || fail "tells of what stands"
# Multipliers of what holds a cloud by mls make pivots negative that mean nothing, and so does what slides between walls.
expect "a cloud" 0 "$talus" run column.yaml --out cloud --set method=gmm --set 'basis={mls: {}}' --set formulation=displacement \
  --set 'grid={box: {min: [0, 0], max: [1, 1]}, counts: [4, 4]}' --set 'bodies[0].shape={box: {min: [0, 0], max: [1, 1]}}' \
  --set loads.points=null --set 'measures.aside.of.tracer=[0.5, 0.5]'
! grep -q 'nothing stays' err.txt || fail "tells of a cloud that stands"
# Who stays where it should not is told of until the end, though nothing changes any more.
expect "held" 0 "$talus" run column.yaml --out held --set 'loads.tractions[0].amplitude=[[0, 0], [0.8, 1], [1, 1]]'
says err.txt "from t = " "nothing stays"
finish
