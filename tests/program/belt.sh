#!/bin/sh
# A belt round a quarter of a drum, pulled until it slides everywhere: Euler and Eytelwein's exp(mu theta), of a belt of thickness t on a
# drum of radius R with mu R / (R + t / 2) for mu.
. "$(dirname "$0")/library.sh"

cat >belt.geo <<'EOF'
R = 1; t = 0.02; l = 0.3;
Point(1) = {R, -l, 0}; Point(2) = {R + t, -l, 0}; Point(3) = {R, 0, 0}; Point(4) = {R + t, 0, 0}; Point(5) = {0, R, 0};
Point(6) = {0, R + t, 0}; Point(7) = {-l, R, 0}; Point(8) = {-l, R + t, 0}; Point(9) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 4}; Line(3) = {4, 3}; Line(4) = {3, 1}; Circle(5) = {4, 9, 6}; Line(6) = {6, 5};
Circle(7) = {5, 9, 3}; Line(8) = {6, 8}; Line(9) = {8, 7}; Line(10) = {7, 5};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Curve Loop(2) = {-3, 5, 6, 7}; Plane Surface(2) = {2};
Curve Loop(3) = {-6, 8, 9, 10}; Plane Surface(3) = {3};
Transfinite Curve{1, 3, 6, 9} = across + 1; Transfinite Curve{2, 4, 8, 10} = 16; Transfinite Curve{5, 7} = 79;
Transfinite Surface{1, 2, 3}; Recombine Surface{1, 2, 3};
Physical Surface("belt") = {1, 2, 3}; Physical Curve("low") = {1}; Physical Curve("high") = {9};
EOF
cat >belt.yaml <<'EOF'
kinematics: plane-strain
method: fem
formulation: mean-dilatation
analysis: {type: static, steps: 20}
grid: {mesh: belt.geo, parameters: {across: 2}}
bodies: [{name: belt, region: belt, points_per_cell: 4, material: r}]
materials: {r: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: held, on: {boundary: low}, fix: [x, y]}]
walls: [{name: drum, shape: {circle: {centre: [0, 0], radius: 1}}, friction: 0.3}]
loads: {tractions: [{on: {boundary: high}, value: [-1000, 0]}]}
measures: {pull: {reaction: y, of: {boundary: held}}}
output: {every: end}
EOF
# 20 N pull at the other end: to 1.5e-3 (0.5; 1e-4 with 0.3), in as many steps as were asked for, or a few more.
for way in "2 0.3 mean-dilatation 1 12" "2 0.15 mean-dilatation 1 5" "2 0.5 displacement 1 10" "1 0.3 mean-dilatation 2 5" "1 0.15 mean-dilatation 3 5"; do
  set -- $way
  expect "a belt, $way" 0 on_ranks $4 "$talus" run belt.yaml --out belt --force --quiet --set grid.parameters.across=$1 --set walls[0].friction=$2 --set formulation=$3 --set analysis.steps=$5
  awk -F, -v mu=$2 -v steps=$5 'END { r = -20 / $3 / exp(mu * atan2(1, 0) / 1.01) - 1; exit !(r * r < 2.25e-6 && NR < steps + 6) }' belt/history.csv || fail "$name: $(tail -n 1 belt/history.csv)"
done
finish
