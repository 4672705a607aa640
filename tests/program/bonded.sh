#!/bin/sh
# Bodies that are bonded along a curve are one body, although points of neither lie on it: a core of one material in a
# ring of another, pressed from outside, against Lame's solution in plane strain.
. "$(dirname "$0")/library.sh"

cat >ring.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1.2, 1.2]}, size: 0.1}
bodies:
  - {name: core, shape: {intersection: [{circle: {centre: [0, 0], radius: 0.5}}, {box: {min: [0, 0], max: [2, 2]}}]}, material: hard}
  - {name: ring, shape: {intersection: [{difference: [{circle: {centre: [0, 0], radius: 1}}, {circle: {centre: [0, 0], radius: 0.5}}]}, {box: {min: [0, 0], max: [2, 2]}}]}, material: soft}
materials:
  hard: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}
  soft: {law: neo-hookean, density: 1000, young: 3e6, poisson: 0.2}
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}]
loads: {pressures: [{on: {body: ring, shape: {difference: [{box: {min: [0.001, 0.001], max: [2, 2]}}, {circle: {centre: [0, 0], radius: 0.75}}]}}, value: 1e4}]}
interfaces: [{name: i, between: [ring, core], contact: bonded}]
measures: {core: {stress: xx, of: {body: core}}}
output: {fields: [displacement], every: end}
END
# Pressure on the core by a pressure on the ring of 2 to 1: u / a of both alike there.
exact=$(awk 'BEGIN {
  E1 = 1e7; n1 = 0.3; E2 = 3e6; n2 = 0.2; p = 1e4; a = 0.5; b = 1
  core = (1 + n1) * (1 - 2 * n1) / E1
  A = (1 + n2) / E2 * ((1 - 2 * n2) * a * a + b * b) / (b * b - a * a)
  B = (1 + n2) / E2 * (2 * (1 - n2)) * b * b / (b * b - a * a)
  print -p * B / (core + A) }')
for ranks in 1 3; do
  expect "a core in a ring, $ranks" 0 on_ranks $ranks "$talus" run ring.yaml --out ring --force --quiet
  awk -F, -v exact=$exact 'END { exit !(($3 / exact - 1) ^ 2 < 0.005 ^ 2) }' ring/history.csv || fail "$name: $(tail -n 1 ring/history.csv), not $exact"
done
finish
