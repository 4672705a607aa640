#!/bin/sh
# A bar of gmm that is drawn out evenly to twice its length: force and energy are those of fem, which are exact, on any
# number of ranks and resumed. With round clouds zigzags of the nodes grow from a stretch of 1.3 on until nothing bears.
# And a plate whose cells grow away from a hole.
. "$(dirname "$0")/library.sh"

cat >case.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 40}
grid: {box: {min: [0, 0], max: [1, 0.5]}, size: 0.125}
bodies: [{name: bar, shape: {box: {min: [0, 0], max: [1, 0.5]}}, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 2000, young: 1e6, poisson: 0.3}}
boundary:
  - {on: {x: 0}, fix: [x]}
  - {name: end, on: {x: 1}, displacement: {x: 1}}
  - {on: {y: 0}, fix: [y]}
measures:
  pull: {reaction: x, of: {boundary: end}}
  elastic: {energy: elastic}
checkpoint: {steps: 20}
END
# as_fem TOLERANCE: pull and energy at the end of the last run are those of fem
as_fem() {
  tail -q -n 1 fem/history.csv run/history.csv |
    awk -F, -v most=$1 'NR == 1 { F = $3; E = $4 }
      END { exit !(F > 0 && ($3 / F - 1) ^ 2 < most ^ 2 && ($4 / E - 1) ^ 2 < most ^ 2) }' ||
    fail "$name: $(tail -n 1 run/history.csv)"
}
draw() {
  name=$1
  shift
  expect "$name, $ranks" 0 on_ranks $ranks "$talus" run case.yaml --out run --force --quiet "$@"
}

# fem needs no small steps, in which clouds might feed on what they have done. Three ranks go half of the way.
expect "fem" 0 "$talus" run case.yaml --out fem --quiet --set method=fem --set analysis.steps=4
ranks=3
mv fem/history.csv all.csv && head -n 4 all.csv >fem/history.csv
draw "half of it, lme" --set analysis.steps=20 --set boundary[1].displacement.x=0.5
as_fem 1e-5
lacks err.txt "drawn out"
mv all.csv fem/history.csv
for ranks in 2 1; do
  draw "lme"
  as_fem 1e-5
  lacks err.txt "drawn out"
done
# on one rank: MUMPS on several works in the order in which messages arrive
rm run/checkpoint_*40.h5 && cp run/history.csv whole.csv
expect "lme, resumed" 0 "$talus" run --resume run --quiet
cmp -s whole.csv run/history.csv || fail "$name: another history"
draw "mls" --set 'basis={mls: {}}'
as_fem 1e-4
# Along both axes: the map of a point is rounded, else clouds feed on their own unevenness (7 % in these steps).
mv case.yaml one.yaml && rm -rf fem
sed 's/max: \[1, 0.5\]/max: [1, 1]/g; /on: {y: 0}/a\  - {on: {y: 1}, displacement: {y: 0.8}}' one.yaml >case.yaml
set -- --set analysis.steps=160 --set boundary[1].displacement.x=0.8
expect "fem, both ways" 0 "$talus" run case.yaml --out fem --quiet --set method=fem "$@" --set analysis.steps=10
draw "lme, both ways" "$@"
as_fem 1e-5
draw "mls, both ways" "$@" --set 'basis={mls: {}}'
as_fem 1e-3
# Sheared by 1.5, where nodes stand nearly as they did: clouds drawn out along the principal axes lost 6 %.
rm -rf fem
sed '/on: {x: 0}/d; s/on: {y: 0}, fix: \[y\]/on: {y: 0}, fix: [x, y]/; s/on: {x: 1}, displacement: {x: 1}/on: {y: 1}, displacement: {x: 1.5, y: 0}/
  s/max: \[1, 0.5\]/max: [2, 1]/g' one.yaml >case.yaml
expect "fem, sheared" 0 "$talus" run case.yaml --out fem --quiet --set method=fem --set analysis.steps=10
draw "lme, sheared" --set analysis.steps=80
as_fem 3e-2
rm -rf fem && mv one.yaml case.yaml
# six functions want more nodes: 8 % with clouds of two spacings, and more in shorter steps
expect "fem, less" 0 "$talus" run case.yaml --out fem --quiet --set method=fem --set analysis.steps=4 --set boundary[1].displacement.x=0.3
draw "quadratic mls" --set 'basis={mls: {order: quadratic}}' --set boundary[1].displacement.x=0.3
as_fem 1e-3
says err.txt "100 % of the material is drawn out by more than a fifth, among functions so wide"
draw "a cubic spline" --set 'basis={mls: {weight: cubic-spline}}' --set boundary[1].displacement.x=0.3
as_fem 1e-3
ranks=3
draw "wide lme" --set 'basis={lme: {gamma: 0.6}}' --set analysis.steps=4
says err.txt "100 % of the material is drawn out by more than a fifth, among functions so wide"

# In space, where all nodes of a cloud drawn out are more than are looked at one by one.
sed 's/plane-strain/3d/; s/steps: 40/steps: 15/; s/0.125/0.25/
  s/min: \[0, 0\], max: \[1, 0.5\]/min: [0, 0, 0], max: [1, 0.5, 0.5]/g
  s/x: 1}}/x: 1.4}}/; /on: {y: 0}/a\  - {on: {z: 0}, fix: [z]}' case.yaml >space.yaml
rm -rf fem && mv space.yaml case.yaml
expect "fem in space" 0 "$talus" run case.yaml --out fem --quiet --set method=fem --set analysis.steps=5
ranks=2
draw "lme in space"
as_fem 1e-5

# Cells from 0.02 to 0.2 m: clouds of one size held too few nodes where these are far apart, "nothing resists".
cat >plate.geo <<'END'
Point(1)={0,0,0};Point(2)={1,0,0};Point(3)={0.7071067811865476,0.7071067811865476,0};Point(4)={0,1,0};Point(5)={3,0,0};Point(6)={3,3,0};Point(7)={0,3,0};
Circle(1)={2,1,3};Circle(2)={3,1,4};Line(3)={5,6};Line(4)={6,7};Line(5)={2,5};Line(6)={3,6};Line(7)={4,7};
Curve Loop(1)={5,3,-6,-1};Curve Loop(2)={6,4,-7,-2};Plane Surface(1)={1};Plane Surface(2)={2};
Transfinite Curve{1:4}=25;Transfinite Curve{5:7}=25 Using Progression 1.1;Transfinite Surface{1,2};Recombine Surface{1,2};
Physical Surface("plate")={1,2};Physical Curve("right")={3};
END
gmsh -2 plate.geo -o plate.msh -format msh41 >out.txt 2>&1 || fail "plate.geo: no mesh" # once: it starts slowly
cat >plate.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 1}
grid: {mesh: plate.msh}
bodies: [{name: plate, region: plate, points_per_cell: 4, material: steel}]
materials: {steel: {law: neo-hookean, density: 8000, young: 1e9, poisson: 0.3}}
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}]
loads: {tractions: [{on: {boundary: right}, value: [1e3, 0]}]}
measures: {side: {displacement: x, of: {tracer: [1, 0]}}, top: {displacement: y, of: {tracer: [0, 1]}}, stress: {stress: xx, of: {tracer: [0, 1.2]}}}
END
expect "plate, fem" 0 "$talus" run plate.yaml --out fem --force --quiet --set method=fem
plate_as_fem() {
  tail -q -n 1 fem/history.csv run/history.csv |
    awk -F, 'NR == 1 { for (k = 3; k <= 5; ++k) F[k] = $k }
      END { for (k = 3; k <= 5; ++k) bad += ($k / F[k] - 1) ^ 2 > 0.01 ^ 2; exit bad || NR < 2 }' ||
    fail "$name: $(tail -n 1 run/history.csv)"
}
expect "plate, lme" 0 on_ranks 2 "$talus" run plate.yaml --out run --force --quiet
plate_as_fem
expect "plate, mls" 0 "$talus" run plate.yaml --out run --force --quiet --set 'basis={mls: {}}'
plate_as_fem
# What cannot come apart lacks no cohesion.
expect "plate, small clouds" 1 "$talus" run plate.yaml --out run --force --quiet --set 'basis={lme: {radius: 0.5, max_radius: 0.5}}' \
  --set loads=null --set 'boundary=[{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}, {on: {boundary: right}, displacement: {x: 1e-6}}]'
says err.txt "nothing resists at" "points see too few nodes there"
lacks err.txt "cohesion"
finish
