#!/bin/sh
# A column that is pressed by 1.36 times what it bears: what finds it straight says what that is worth, and a force
# aside with short steps bends it. One under half of what it bears, and what points without an extent make of that.
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

cat >swayed.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 10}
grid: {box: {min: [-0.125, 0], max: [0.375, 2.125]}, size: 0.0625, cell: triangle}
bodies: [{name: column, shape: {box: {min: [0, 0], max: [0.25, 2]}}, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.2}}
boundary: [{on: {y: 0}, fix: [x, y]}]
loads: {tractions: [{on: {body: column, y: 2}, value: [2, -1606]}]}
measures: {aside: {displacement: x, of: {tracer: [0.125, 2]}}}
checkpoint: {steps: 5, keep: 100}
END
warned='bodies bear is [0-9.]* % of their stiffness where they bend or sway'

# One of triangles is off by 17 % in ten steps, whatever the number of ranks, and when it goes on, too.
for ranks in 1 2; do
  expect "swayed on $ranks" 0 on_ranks $ranks "$talus" run swayed.yaml --out swayed$ranks
  grep -o "$warned" err.txt >told$ranks.txt || fail "$name: nothing was told"
done
cmp -s told1.txt told2.txt || fail "the number of ranks makes a difference: $(cat told1.txt told2.txt)"
rm swayed1/checkpoint_*10.h5
expect "swayed goes on" 0 "$talus" run --resume swayed1
grep -o "$warned" err.txt | cmp -s - told1.txt || fail "$name: something else is told"
# In substeps as well, of a string.
expect "string" 0 "$talus" run swayed.yaml --out string --set 'analysis={type: explicit, end: 0.2, step: 0.01}' --set loads=null \
  --set 'bodies[0].stress={yy: 2e4}' --set 'bodies[0].velocity=[0.01, 0]' --set 'boundary=[{on: {y: 0}, fix: [x, y]}, {on: {y: 2}, fix: [x, y]}]'
grep -q "$warned" err.txt || fail "$name: nothing was told"
# What loses nothing, or little: one step, functions of other kinds or along their lines, a fifth of the load; and what turns as a whole.
silent() {
  title=$1
  shift
  expect "$title" 0 "$talus" run swayed.yaml --out silent --force "$@"
  ! grep -q "$warned" err.txt || fail "$title: $(grep "$warned" err.txt)"
}
silent "one step" --set analysis.steps=1
silent "fem" --set method=fem
silent "gimp" --set grid.cell=quadrilateral
silent "quadrilaterals" --set grid.cell=quadrilateral --set 'basis={cell: {}}'
silent "a fifth" --set 'loads.tractions[0].value=[2, -320]'
silent "a turn" --set 'analysis={type: dynamic, end: 0.02, step: 0.002}' --set loads=null --set boundary=null \
  --set 'grid.box={min: [-1, -0.5], max: [1.25, 2.5]}' --set 'bodies[0].spin=1' --set 'bodies[0].spin_centre=[0.125, 1]'
finish
