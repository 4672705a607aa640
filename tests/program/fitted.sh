#!/bin/sh
# Bodies that are drawn as touching along a curve begin free of stress, whichever is named first, however stiff they are
# and however little acts: a ring in a ring, 1 to 1.5 and 1.5 to 2 m, of steel pressed by 1 Pa, against Lame's solution.
. "$(dirname "$0")/library.sh"

cat >rings.yaml <<'DONE'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [2.5, 2.5]}, size: 0.1}
bodies:
  - {name: in, shape: {difference: [{intersection: [{circle: {centre: [0, 0], radius: 1.5}}, {box: {min: [0, 0], max: [3, 3]}}]}, {circle: {centre: [0, 0], radius: 1}}]}, material: hard}
  - {name: out, shape: {difference: [{intersection: [{circle: {centre: [0, 0], radius: 2}}, {box: {min: [0, 0], max: [3, 3]}}]}, {circle: {centre: [0, 0], radius: 1.5}}]}, material: soft}
materials:
  hard: {law: neo-hookean, density: 1000, young: 2e11, poisson: 0.3}
  soft: {law: neo-hookean, density: 1000, young: 2e11, poisson: 0.2}
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}]
loads: {pressures: [{on: {body: out, shape: {difference: [{circle: {centre: [0, 0], radius: 2.3}}, {circle: {centre: [0, 0], radius: 1.7}}]}}, value: 1}]}
interfaces: [{name: i, between: [out, in], contact: frictionless}]
measures: {J: {interface_force: x, of: {interface: i}}, uo: {displacement: x, of: {tracer: [2, 0]}}}
output: {fields: [displacement], every: end, history: {steps: 1}}
DONE
# lame INNER OUTER: the interface's force by a pressure of 1 Pa, 1.5 m of a quarter.
lame() {
  awk -v E1=$1 -v E2=$2 'BEGIN {
    n1 = 0.3; n2 = 0.2; a = 1; b = 1.5; c = 2
    inner = (1 + n1) / E1 * ((1 - 2 * n1) * b * b + a * a) * b / (b * b - a * a)
    A = (1 + n2) / E2 * ((1 - 2 * n2) * b * b + c * c) * b / (c * c - b * b)
    B = (1 + n2) / E2 * 2 * (1 - n2) * b * c * c / (c * c - b * b)
    print 1.5 * B / (inner + A) }'
}
# force WANTED WITHIN: of the interface in the last run, of which a share more or less
force() {
  awk -F, -v f=$1 -v off=$2 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /^J /) c = k; next }
    { J = $c < 0 ? -$c : $c; w = f * (NR - 2) / 2; if ((J - w) ^ 2 > (off * w + 1e-4 * (f == 0)) ^ 2) bad = 1 } END { exit bad || NR != 4 }' run/history.csv ||
    fail "$name: $(tail -n 1 run/history.csv), not $1"
}
like=$(lame 2e11 2e11) within=$(lame 1e6 1e8)
for order in 'out, in' 'in, out'; do
  [ "$order" = 'out, in' ] && ways="gimp:3 cell:1" moduli=2 || ways="gimp:1 bspline:1" moduli=1
  for way in $ways; do
    basis=${way%:*}
    expect "$order, $basis" 0 on_ranks ${way#*:} "$talus" run rings.yaml --out run --force --quiet --set "interfaces[0].between=[$order]" --set "basis={$basis: {}}"
    force "$like" 0.005
  done
  expect "$order, of two moduli" 0 on_ranks $moduli "$talus" run rings.yaml --out run --force --quiet --set "interfaces[0].between=[$order]" \
    --set materials.hard.young=1e6 --set materials.soft.young=1e8
  force "$within" 0.005
  # 5e-16 of the modulus presses what touches: 1e-4 N
  [ "$order" = 'out, in' ] && other='{type: dynamic, end: 2e-5, step: 1e-5}' || other='{type: explicit, end: 4e-5, step: 2e-5}'
  for analysis in '{type: static, steps: 2}' "$other"; do
    expect "$order, no load, $analysis" 0 "$talus" run rings.yaml --out run --force --quiet --set "interfaces[0].between=[$order]" \
      --set "analysis=$analysis" --set loads.pressures[0].value=0
    force 0 1
  done
done
expect "with finer cells" 0 "$talus" run rings.yaml --out run --force --quiet --set grid.size=0.05
force "$like" 0.001
for law in bonded 'friction, friction: 0.3'; do
  expect "$law" 0 "$talus" run rings.yaml --out run --force --quiet --set "interfaces=[{name: i, between: [out, in], contact: $law}]"
  force "$like" 0.005
done

# In a ring that has been pressed before the other one comes.
expect "in a stage" 0 "$talus" run rings.yaml --out run --force --quiet --set "bodies[0].absent=true" --set loads.pressures[0].value=1000 --set \
  "stages=[{name: one}, {name: two, bodies: [{name: in, absent: false}], loads: {pressures: [{on: {body: out, shape: {difference: [{circle: {centre: [0, 0], radius: 2.3}}, {circle: {centre: [0, 0], radius: 1.7}}]}}, value: 1001}]}}]"
awk -F, -v f="$like" 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k ~ /^J /) c = k } END { exit !(($c / f - 1) ^ 2 < 0.005 ^ 2) }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv), not $like"

# In meshes, whose surfaces are known to their cells.
cat >rings.geo <<'DONE'
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1.5, 0, 0}; Point(8) = {0, 1.5, 0}; Point(9) = {0, 1, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 8}; Line(3) = {8, 9}; Circle(4) = {9, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(4) = {1.5, 0, 0}; Point(5) = {2, 0, 0}; Point(6) = {0, 2, 0}; Point(7) = {0, 1.5, 0};
Line(5) = {4, 5}; Circle(6) = {5, 1, 6}; Line(7) = {6, 7}; Circle(8) = {7, 1, 4};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Physical Surface("in") = {1}; Physical Surface("out") = {2}; Physical Curve("outside") = {6};
Mesh.CharacteristicLengthMin = 0.1; Mesh.CharacteristicLengthMax = 0.1;
DONE
for method in fem gmm; do
  for order in 'out, in' 'in, out'; do
    for load in 1 0; do
      case $method$order$load in femin*0 | gmmout*0) continue ;; esac
      expect "$method, $order, $load Pa" 0 "$talus" run rings.yaml --out run --force --quiet --set method=$method --set 'grid={mesh: rings.geo}' \
        --set 'bodies=[{name: in, region: in, points_per_cell: 3, material: hard}, {name: out, region: out, points_per_cell: 3, material: soft}]' \
        --set "loads={pressures: [{on: {boundary: outside}, value: $load}]}" --set "interfaces[0].between=[$order]"
      force "$(awk -v f="$like" -v p=$load 'BEGIN { print f * p }')" 0.005
    done
  done
done
finish
