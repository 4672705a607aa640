#!/bin/sh
# Statics, explicit dynamics and statics again: a block on a wall that rubs: who stands goes on standing, on one to three ranks;
# and what a load pulls at once in space makes no energy.
. "$(dirname "$0")/library.sh"

cat >block.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {cell: {}}
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [2.5, 2.5]}, size: 0.25}
bodies:
  - {name: block, shape: {box: {min: [0.5, 0.5], max: [1.5, 1.5]}}, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0.5], normal: [0, 1]}}, contact: friction, friction: 0.5}
loads: {gravity: [0, -9.81]}
measures:
  top: {displacement: y, of: {tracer: [1.1, 1.4]}}
  push: {wall_force: y, of: {wall: floor}}
  kinetic: {energy: kinetic}
  balance: {energy: balance}
output: {fields: [displacement], history: {steps: 1}}
stages:
  - name: weight
  - {name: stands, analysis: {type: explicit, end: 0.2, step: 0.02}}
  - {name: again, analysis: {type: static, steps: 1}}
END

for ranks in 1 3; do
  expect "on $ranks" 0 on_ranks $ranks "$talus" run block.yaml --out on$ranks
done
# The floor goes on bearing the weight, 9810 N, within 1 %; the top stays within 2 % of its way of 4.2 mm.
awk -F, 'NR == 3 { top = $4 } NR > 3 && ($5 < 9710 || $5 > 9910 || $6 > 0.003 || $4 / top < 0.98 || $4 / top > 1.02) { bad = 1; print }
  END { exit bad || NR != 14 }' on1/history.csv >out.txt || fail "does not stand"
awk -F, '{ print $1, $4, $5 }' on1/history.csv >one.txt
awk -F, '{ print $1, $4, $5 }' on3/history.csv | paste -d ' ' one.txt - |
  awk 'NR > 1 { d = $2 - $5; f = $3 - $6; if (d * d > 1e-16 || f * f > 1e-2) exit 1 }' || fail "on 3 ranks otherwise"

# Springs that become stiffer or softer from stage to stage go on with the force that they had: nothing leaps by the 1.8 mm
# that material is deep in soft ones (it was 10 mm and twice the weight).
sed 's/  - {name: again.*/  - {name: stiff, analysis: {end: 0.2, contact_stiffness: 17}}\n  - {name: soft, analysis: {end: 0.2, contact_stiffness: 1}}/' block.yaml >stiffer.yaml
expect "stiffer and softer" 0 "$talus" run stiffer.yaml --out stiffer
awk -F, 'NR == 3 { top = $4 } NR > 3 && ($5 < 9710 || $5 > 9910 || $6 > 0.005 || $4 / top < 0.96 || $4 / top > 1.04) { bad = 1; print }
  END { exit bad || NR < 20 }' stiffer/history.csv >out.txt || fail "$name: does not stand"

# On another body, and bonded to a wall that it hangs from: what bears it does so through all stages.
sed -e 's/^bodies:/&\n  - {name: base, shape: {box: {min: [0.25, 0], max: [1.75, 0.5]}}, points_per_cell: 4, material: rubber}/' \
  -e 's/^walls:/boundary: [{name: ground, on: {y: 0}, fix: [x, y]}]\ninterfaces:/' -e 's/wall_force: y, of: {wall: floor}/interface_force: y, of: {interface: floor}/' \
  -e 's/shape: {half-space: .*, contact/between: [block, base], contact/' block.yaml >pair.yaml
sed -e 's/contact: friction, friction: 0.5/contact: bonded/' -e 's/gravity: \[0, -9.81\]/gravity: [0, 9.81]/' block.yaml >hangs.yaml
for case in pair hangs; do
  expect "$case" 0 "$talus" run $case.yaml --out $case
  # The force stays within 1 %, the top within one of its way.
  awk -F, 'NR == 3 { top = $4; push = $5 } NR > 3 && ($5 / push < 0.99 || $5 / push > 1.01 || $4 / top < 0.99 || $4 / top > 1.01) { bad = 1; print }
    END { exit bad || push * push < 9800 * 9800 || NR != 14 }' $case/history.csv >out.txt || fail "$case is let go"
done

# What presses on walls sinks in, and the run says so where that is much.
expect "explicit of 1e7" 0 "$talus" run block.yaml --out of1e7 --set stages=null --set materials.rubber.young=1e7 \
  --set 'analysis={type: explicit, end: 0.4, step: 0.02, damping: 20}'
! grep -q "of a cell deep" err.txt || fail "tells of a hundredth of a per cent"
# A stage that is not explicit takes surfaces where they are, and what gives way goes on to do so.
expect "explicit, then statics" 0 "$talus" run block.yaml --out follows --set materials.rubber.young=1e5 \
  --set 'analysis={type: explicit, end: 0.4, step: 0.02, damping: 20}' --set 'stages=[{name: falls}, {name: rests, analysis: {type: static, steps: 1, damping: 0}}]'
says err.txt "of a cell deep in wall 'floor'" "in the stages that follow, too"
# By more than half a layer of points, too: points stand in the floor, beyond a line, in the other body, and stay there in
# the stages that follow (the weight of a body at rest became 3 to 40 times itself, and its top moved by 8 mm).
sed -e 's/contact: friction, friction: 0.5/contact: frictionless/' -e '/^stages:/,$d' -e 's/young: 1e6/young: 2e4/' block.yaml >deep.yaml
cat >>deep.yaml <<'END'
stages:
  - {name: falls, analysis: {type: explicit, end: 1.2, step: 0.02, damping: 12}}
  - {name: moves, analysis: {type: dynamic, end: 0.05, step: 0.005, damping: 0}}
END
sed -e 's/cell: {}/gimp: {}/' -e 's/half-space: {point: \[0, 0.5\], normal: \[0, 1\]}/line: [[0.25, 0.5], [1.75, 0.5]]/' deep.yaml >line.yaml
sed -e 's/frictionless/friction, friction: 0.5/' -e 's/  - {name: moves.*/  - {name: rests, analysis: {type: static, steps: 2, damping: 0}}/' deep.yaml >statics.yaml
sed -e 's/^bodies:/&\n  - {name: base, shape: {box: {min: [0.25, 0], max: [1.75, 0.5]}}, points_per_cell: 4, material: hard}/' \
  -e 's/^materials:/&\n  hard: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}/' \
  -e 's/^walls:/boundary: [{name: ground, on: {y: 0}, fix: [x, y]}]\ninterfaces:/' -e 's/wall_force: y, of: {wall: floor}/interface_force: y, of: {interface: floor}/' \
  -e 's/shape: {half-space: .*, contact/between: [block, base], contact/' deep.yaml >bodies.yaml
for case in deep line statics bodies; do
  expect "$case" 0 "$talus" run $case.yaml --out $case
  awk -F, '$3 == 1 { top = $4; push = $5 } $3 == 2 { ++n; if ($5 / push < 0.95 || $5 / push > 1.05 || $4 / top < 0.995 || $4 / top > 1.005 || $6 > 1) { bad = 1; print } }
    END { exit bad || push < 9500 || push > 10100 || n < 2 }' $case/history.csv >out.txt || fail "$case: what has sunk in is thrown out"
done
# A bar of two by two cells in space, pulled at its end at once: it swings between 0 and twice the static way, and loses
# some energy between points and grid, but makes none.
cat >pulled.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: explicit, end: 0.004, step: 2.5e-5}
grid: {box: {min: [0, -0.1, -0.1], max: [0.6, 0.25, 0.25]}, size: 0.05}
bodies: [{name: bar, shape: {box: {min: [0, 0, 0], max: [0.5, 0.1, 0.1]}}, points_per_cell: 8, material: stiff}]
materials: {stiff: {law: neo-hookean, density: 1000, young: 1e9, poisson: 0}}
boundary: [{on: {x: 0}, fix: [x, y, z]}]
loads: {tractions: [{on: {body: bar, x: 0.5}, value: [1e4, 0, 0]}]}
measures: {end: {displacement: x, of: {tracer: [0.5, 0.05, 0.05]}}, transfer: {energy: transfer}}
END
for way in "0 2" "0.005 1"; do
  set -- $way
  box="bodies[0].shape.box={min: [0, $1, $1], max: [0.5, $(awk -v a=$1 'BEGIN { print a + 0.1 }'), $(awk -v a=$1 'BEGIN { print a + 0.1 }')]}"
  expect "pulled, $1 off the lines, on $2" 0 on_ranks $2 "$talus" run pulled.yaml --out pulled --force --quiet --set "$box"
  awk -F, 'NR > 1 { if ($3 > most) most = $3; if ($4 < -2e-6) bad = 1 } END { exit bad || most < 0.95e-5 || most > 1.05e-5 }' pulled/history.csv ||
    fail "$name: $(tail -n 1 pulled/history.csv)"
done
finish
