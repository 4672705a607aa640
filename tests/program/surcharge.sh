#!/bin/sh
# A fill that comes in a stage and bears a load from then on: what stands below bears the weight of both.
. "$(dirname "$0")/library.sh"

cat >fill.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [4, 4]}, size: 0.5}
bodies:
  - {name: ground, shape: {box: {min: [0, 0], max: [4, 2]}}, points_per_cell: 4, material: soil, k0: 0.5}
  - {name: fill, shape: {box: {min: [0, 2], max: [2, 3]}}, points_per_cell: 4, material: soil, absent: true}
materials: {soil: {law: mohr-coulomb, density: 2000, young: 1e9, poisson: 0.3, friction_angle: 30, cohesion: 2e4}}
boundary:
  - {name: base, on: {boundary: bottom}, fix: [x, y]}
  - {name: left, on: {boundary: left}, fix: [x]}
  - {name: right, on: {boundary: right}, fix: [x]}
loads: {gravity: [0, -10]}
measures: {base: {reaction: y, of: {boundary: base}}}
output: {history: {steps: 1}}
stages:
  - name: ground
  - {name: fill, bodies: [{name: fill, absent: false}], loads: {tractions: [{name: traffic, on: {body: fill, y: 3}, value: [0, -5e4], amplitude: [[0, 0], [0.5, 0], [1, 1]]}]}}
  - {name: stands}
  - {name: more, loads: {tractions: [{name: traffic, on: {body: fill, y: 3}, value: [0, -8e4]}]}}
  - {name: unloaded, loads: {tractions: []}}
END

# 160 kN of ground, 40 of fill, 100 and 160 on it.
bears() {
  awk -F, '$3 == 2 { n = 300 } $3 == 3 { n = 300 } $3 == 4 { n = 360 } $3 == 5 { n = 200 } { last[$3] = $4 / 1e3 - n }
    END { for (k = 2; k <= 5; ++k) if (last[k] > 0.05 || last[k] < -0.05) exit 1 }' "$1/history.csv" || fail "$1 bears something else"
}
for method in mpm fem; do
  for ranks in 1 2 3; do
    expect "$method on $ranks" 0 on_ranks $ranks "$talus" run fill.yaml --out $method$ranks --set method=$method
    bears $method$ranks
  done
done

# Cut off in any stage and resumed: the same bits.
sed 's/^output:/checkpoint: {steps: 1, keep: 20}\n&/' fill.yaml >kept.yaml
expect "with checkpoints" 0 "$talus" run kept.yaml --out kept
for step in 3 5 7; do
  cp -r kept cut
  for file in cut/checkpoint_*.h5; do
    number=$(basename "$file" .h5 | sed 's/checkpoint_0*//')
    [ "$number" -le "$step" ] || rm "$file"
  done
  expect "resumed from $step" 0 "$talus" run --resume cut
  tail -n 1 cut/history.csv >one.txt
  tail -n 1 kept/history.csv | cmp -s - one.txt || fail "resumed from $step: $(cat one.txt)"
  rm -rf cut
done

# A point force on what comes, and a factor whose t counts from the stage's start: 60 and 40 kN more.
for method in mpm fem; do
  expect "a point, $method" 0 "$talus" run fill.yaml --out point --force --set method=$method --set analysis.end=1 \
    --set 'stages=[{name: ground}, {name: fill, bodies: [{name: fill, absent: false}], loads: {points: [{at: [1, 2.9], force: [0, -6e4]}], tractions: [{on: {body: fill, y: 3}, value: [0, -2e4], factor: t}]}}]'
  awk -F, 'END { d = $4 / 1e3 - 300; exit !(d > -0.05 && d < 0.05) }' point/history.csv || fail "$name: $(tail -n 1 point/history.csv)"
done

# What begins on a body that has been there has no carriers; and what is not there bears nothing.
expect "too late" 2 "$talus" check fill.yaml --set 'stages[2].loads={tractions: [{on: {body: ground, y: 2}, value: [0, -1]}]}'
says err.txt "can begin only with the undeformed body, in the first stage" "with an amplitude that is 0 until it comes"
expect "too early" 2 "$talus" check fill.yaml --set 'loads.tractions=[{on: {body: fill, y: 3}, value: [0, -1]}]'
says err.txt "the load acts on 'fill', which is not there" "give it in the stage that brings 'fill'"
finish
