#!/bin/sh
# Bodies of gmm that meet at interfaces, as the nodes of a box and of meshes have them: held nodes below a thin body and
# bodies behind it do not reach through it, nor do clouds across slots and gaps; rings, and a core that is held in one.
. "$(dirname "$0")/library.sh"

# A block slides on a base of one cell, whose lower nodes are held, without friction: the impulse of its weight.
cat >thin.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: dynamic, end: 0.1, step: 1e-2}
grid: {box: {min: [0, 0], max: [1.5, 0.75]}, size: 0.125}
bodies:
  - {name: block, shape: {box: {min: [0.5, 0.125], max: [1, 0.5]}}, material: rubber}
  - {name: base, shape: {box: {min: [0.25, 0], max: [1.25, 0.125]}}, material: rubber}
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0.3}}
boundary: [{name: floor, on: {boundary: bottom}, fix: [x, y]}]
interfaces: [{name: joint, between: [block, base], contact: frictionless}]
loads: {gravity: [3, -9], gravity_amplitude: [[0, 0], [0.1, 1]]}
measures: {along: {momentum: x, of: {body: block}}}
output: {fields: [displacement], every: end}
END
# along KILOGRAMS: of the block that slides, in the last run
along() {
  awk -F, -v m=$1 'END { exit !(($3 / (m * 3 * 0.05) - 1) ^ 2 < 1e-6 ^ 2) }' run/history.csv ||
    fail "$name: $(tail -n 1 run/history.csv)"
}
for way in "lme 1" "mls 2"; do
  set -- $way
  expect "a thin base, $way" 0 on_ranks $2 "$talus" run thin.yaml --out run --force --quiet --set "basis={$1: {}}"
  along 187.5
done

# A plate of one cell between a block and the base, which have one field: clouds do not reach through the plate.
plate='bodies=[{name: block, shape: {box: {min: [0.5, 0.25], max: [1, 0.5]}}, material: rubber},
  {name: plate, shape: {box: {min: [0.25, 0.125], max: [1.25, 0.25]}}, material: rubber},
  {name: base, shape: {box: {min: [0, 0], max: [1.5, 0.125]}}, material: rubber}]'
upper='{name: upper, between: [block, plate], contact: frictionless}, {name: lower, between: [plate, base], contact: stick}'
ranks=2
for far in "" ", {name: far, between: [block, base]}"; do
  turn
  expect "a plate between$far, $ranks" 0 on_ranks $ranks "$talus" run thin.yaml --out run --force --quiet --set "$plate" \
    --set "interfaces=[$upper$far]"
  [ ! -s err.txt ] || fail "$name: it warns"
  along 125
done

# A slot of one cell, whose prongs are pulled apart, and pressed together, and a cavity: fem's way, within what fem is off
# with four cells across a prong.
cat >slot.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [8, 2.25]}, size: 0.25}
bodies:
  - {name: b, shape: {difference: [{box: {min: [0, 0], max: [8, 2.25]}}, {box: {min: [1, 1], max: [9, 1.25]}}]}, material: m}
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {x: 0}, fix: [x, y]}]
loads: {points: [{at: [8, 2.25], force: [0, 300]}, {at: [8, 0], force: [0, -300]}]}
measures: {uy: {displacement: y, of: {tracer: [8, 2.25]}}}
END
cat >cavity.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [6, 3]}, size: 0.25}
bodies:
  - {name: b, shape: {difference: [{box: {min: [0, 0], max: [6, 3]}}, {box: {min: [2, 1.25], max: [4, 1.5]}}]}, material: m}
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {y: 0}, fix: [x, y]}]
loads: {gravity: [0, -10]}
measures: {roof: {displacement: y, of: {tracer: [3, 1.5]}}}
END
# near CASE "BASIS:RANKS..." [options]: its measure beside that of fem
near() {
  file=$1.yaml ways=$2
  shift 2
  expect "$file $* by fem" 0 "$talus" run $file --out fem --force --quiet --set method=fem "$@"
  for way in $ways; do
    basis=${way%:*} ranks=${way#*:}
    expect "$file $* $basis on $ranks" 0 on_ranks $ranks "$talus" run $file --out run --force --quiet --set "basis={$basis: {}}" "$@"
    [ ! -s err.txt ] || fail "$name: it warns"
    awk -F, -v is="$(tail -n 1 fem/history.csv | cut -d, -f3)" 'END { exit !(($3 / is - 1) ^ 2 < 0.04 ^ 2) }' run/history.csv ||
      fail "$name: $(tail -n 1 fem/history.csv run/history.csv)"
  done
}
near slot mls:2
near slot lme:1 --set loads.points[0].force=[0,-60] --set loads.points[1].force=[0,60]
near cavity "lme:3 mls:1"

# Bodies without an interface do not feel each other as they pass, and a run in which they meet tells it.
cat >pass.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: dynamic, end: 0.9, step: 0.02}
grid: {box: {min: [0, 0], max: [6, 3]}, size: 0.25}
bodies:
  - {name: a, shape: {box: {min: [1, 0], max: [2, 1]}}, material: m, velocity: [3, 0]}
  - {name: b, shape: {box: {min: [3, 1.25], max: [4, 2.25]}}, material: m}
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
measures: {va: {momentum: x, of: {body: a}}, vb: {momentum: x, of: {body: b}}}
END
expect "bodies that pass" 0 on_ranks 2 "$talus" run pass.yaml --out run --force --quiet
[ ! -s err.txt ] || fail "$name: it warns"
awk -F, 'END { exit !(($3 / 3000 - 1) ^ 2 < 1e-20 && $4 ^ 2 < 1e-20) }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
for ranks in 1 3; do
  expect "bodies that meet, $ranks" 0 on_ranks $ranks "$talus" run pass.yaml --out run --force --quiet \
    --set 'bodies[1].shape={box: {min: [3, 0], max: [4, 1]}}' --set analysis.end=0.5
  says err.txt "s on parts that no material joins are in each other, first at (2.9" "m in 'a': clouds of gmm do not reach from one to the other"
done

# A cylinder on another one bears its weight, pi 0.75^2 0.5 1000 9.81 N, on a circle of 0.75 m.
cat >rings.yaml <<'END'
kinematics: axisymmetric
method: gmm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [2, 1.25]}, size: 0.125}
bodies:
  - {name: upper, shape: {box: {min: [0, 0.5], max: [0.75, 1]}}, material: rubber}
  - {name: lower, shape: {box: {min: [0, 0], max: [1.5, 0.5]}}, material: rubber}
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
boundary: [{name: floor, on: {boundary: bottom}, fix: [x, y]}]
interfaces: [{name: joint, between: [upper, lower], contact: friction, friction: 0.3}]
loads: {gravity: [0, -9.81]}
measures: {push: {interface_force: y, of: {interface: joint}}, area: {interface: area, of: {interface: joint}}}
output: {fields: [displacement], every: end}
END
expect "cylinders" 0 on_ranks 2 "$talus" run rings.yaml --out run --force --quiet
[ ! -s err.txt ] || fail "$name: it warns"
awk -F, 'END { exit !(($3 / 8667.850480795 - 1) ^ 2 < 1e-8 ^ 2 && ($4 / 1.767145868 - 1) ^ 2 < 1e-3 ^ 2) }' run/history.csv ||
  fail "$name: $(tail -n 1 run/history.csv)"

# A core that sticks to a ring of another material, pressed from outside, in a mesh: Lame's solution (program/bonded).
cat >ring.geo <<'END'
Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0, 0.5, 0};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Point(4) = {0.5, 0, 0}; Point(5) = {1, 0, 0}; Point(6) = {0, 1, 0}; Point(7) = {0, 0.5, 0};
Line(4) = {4, 5}; Circle(5) = {5, 1, 6}; Line(6) = {6, 7}; Circle(7) = {7, 1, 4};
Curve Loop(2) = {4, 5, 6, 7}; Plane Surface(2) = {2};
Physical Surface("core") = {1}; Physical Surface("ring") = {2}; Physical Curve("outside") = {5};
Mesh.CharacteristicLengthMin = 0.08; Mesh.CharacteristicLengthMax = 0.08;
END
cat >ring.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 1}
grid: {mesh: ring.geo}
bodies: [{name: core, region: core, points_per_cell: 3, material: hard}, {name: ring, region: ring, points_per_cell: 3, material: soft}]
materials:
  hard: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}
  soft: {law: neo-hookean, density: 1000, young: 3e6, poisson: 0.2}
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}]
loads: {pressures: [{on: {boundary: outside}, value: 1e4}]}
interfaces: [{name: i, between: [ring, core], contact: stick}]
measures: {core: {stress: xx, of: {body: core}}}
output: {fields: [displacement], every: end}
END
expect "a core in a ring" 0 on_ranks 2 "$talus" run ring.yaml --out run --force --quiet
awk -F, 'END { exit !(($3 / -12825.6513 - 1) ^ 2 < 0.005 ^ 2) }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"

# Held nodes that no body of a mesh has are there for each: the first body rests beside them, the other one slides down on
# it and bounces.
cat >stop.geo <<'END'
Point(1) = {0, 0, 0}; Point(2) = {1.5, 0, 0}; Point(3) = {1.5, 0.3, 0}; Point(4) = {0, 0.3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Point(5) = {0.85, 0.3, 0}; Point(6) = {1.35, 0.3, 0}; Point(7) = {1.35, 0.7, 0}; Point(8) = {0.85, 0.7, 0};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Point(11) = {1.75, 0, 0}; Point(12) = {2, 0, 0}; Point(13) = {2, 1, 0}; Point(14) = {1.75, 1, 0};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(3) = {11, 12, 13, 14}; Plane Surface(3) = {3};
Physical Surface("low") = {1}; Physical Surface("top") = {2}; Physical Surface("nothing") = {3};
Physical Curve("floor") = {1}; Physical Curve("stop") = {14};
Mesh.CharacteristicLengthMin = 0.1; Mesh.CharacteristicLengthMax = 0.1;
END
cat >stop.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: dynamic, step: 1e-2, end: 0.4}
grid: {mesh: stop.geo}
bodies: [{name: low, region: low, points_per_cell: 3, material: rubber}, {name: top, region: top, points_per_cell: 3, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
interfaces: [{name: joint, between: [top, low], contact: frictionless}]
boundary: [{name: floor, on: {boundary: floor}, fix: [x, y]}, {name: stop, on: {boundary: stop}, fix: [x, y]}]
loads: {gravity: [4.905, -8.495709]} # 30 degrees
measures: {along: {momentum: x, of: {body: top}}}
output: {fields: [displacement], every: end}
END
expect "a stop" 0 on_ranks 2 "$talus" run stop.yaml --out run --force --quiet
awk -F, '$1 > 0.299 && $1 < 0.301 { fell = $3 } END { exit !((fell / (200 * 4.905 * 0.3) - 1) ^ 2 < 0.001 ^ 2 && $3 < 0) }' run/history.csv ||
  fail "$name: $(tail -n 1 run/history.csv)"

# A face that is held stays so whatever the boundary holds beyond it: nodes that are free there are in no cloud of the face.
cat >face.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 1}
grid: {box: {min: [-1, -0.5], max: [2, 2]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {y: 0, x: [0, 1]}, fix: [x, y]}]
loads: {gravity: [1, 0]}
measures: {u: {displacement: x, of: {tracer: [0.5, 1]}}}
END
expect "a held foot" 0 "$talus" run face.yaml --out alone --force --quiet
for held in '{on: {y: [-0.5, -0.2]}, fix: [y]}' '{on: {x: [-1, 2], y: [-0.5, -0.1]}, fix: [x]}' '{on: {y: 0}, fix: [y]}'; do
  turn
  expect "a foot and $held on $ranks" 0 on_ranks $ranks "$talus" run face.yaml --out more --force --quiet --set "boundary[1]=$held"
  tail -n 1 more/history.csv | awk -F, -v is="$(tail -n 1 alone/history.csv | cut -d, -f3)" '{ exit !(($3 / is - 1) ^ 2 < 1e-16) }' ||
    fail "$name: $(tail -n 1 more/history.csv)"
done

finish
