#!/bin/sh
# Bodies of revolution by the whole program: what is said of them, the same answers on 1, 2 and 3 ranks and after a resume, and the scaling of a
# discharge, which has no length of its own but the orifice's.
compare="$(cd "$(dirname "$0")" && pwd)/compare.awk"
. "$(dirname "$0")/library.sh"

# A ball falls along the axis onto a smooth floor and bounces.
ball() {
  cat <<'END'
kinematics: axisymmetric
method: mpm
analysis: {type: dynamic, step: 4e-3, end: 0.16}
grid: {box: {min: [0, 0], max: [0.6, 0.8]}, size: 0.05}
bodies:
  - {name: ball, shape: {circle: {centre: [0, 0.35], radius: 0.25}}, points_per_cell: 4, material: rubber, velocity: [0, -2]}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0.3}
boundary:
  - {on: {boundary: bottom}, fix: [y]}
loads:
  gravity: [0, -9.81]
  points: [{at: [0.02, 0.52], force: [0, -20]}]
measures:
  top: {position: y, of: {tracer: [0, 0.55]}}
  wide: {extent: {max: x}}
  falls: {momentum: y}
  elastic: {energy: elastic}
  balance: {energy: balance}
  floor: {reaction: y, of: {boundary: 0}}
checkpoint: {steps: 10, keep: 99}
parallel: {imbalance: 1.02}
END
}

ball >case.yaml
cp case.yaml ball.yaml
expect "what check says" 0 "$talus" check case.yaml
says out.txt "full circle: volumes, masses, forces and energies" "axis: 17 nodes at x = 0 are held along x" "boundary[0]: moves 13 nodes"
sed 's/fix: \[y\]/velocity: {x: 1}/' case.yaml >outwards.yaml
expect "a motion away from the axis" 2 "$talus" check outwards.yaml
says err.txt "outwards.yaml:10:5: error: boundary[0] moves the node at (0, 0) along x, but it lies on the axis, which nothing leaves"
sed 's/fix: \[y\]/fix: [x, y]/' case.yaml >rough.yaml
expect "a floor that holds the axis, too" 0 "$talus" check rough.yaml

for ranks in 1 2 3; do
  expect "ball on $ranks" 0 on_ranks $ranks "$talus" run case.yaml --out run$ranks --quiet --set newton.residual=1e-12
  says run$ranks/log.txt "kinematics = axisymmetric: volumes, masses, forces and energies of the full circle"
done
for ranks in 1 2 3; do cut -d, -f1-6,8 run$ranks/history.csv >history$ranks.csv; done # without the balance, which is round-off
for ranks in 2 3; do
  awk -f "$compare" history1.csv history$ranks.csv >difference.txt || { fail "ball: $ranks ranks differ"; head -n 5 difference.txt; }
done
awk -F, 'NR > 1 {hit += $8 > 100; if ($7 > worst) worst = $7; if (-$7 > worst) worst = -$7}
         END {exit !(hit && worst < 1e-9)}' run1/history.csv || fail "the ball did not hit the floor, or energy is missing"
cp -r run2 cut
for step in 30 40; do rm -f cut/checkpoint_*$step.h5; done
expect "ball, resumed" 0 on_ranks 2 "$talus" run --resume cut --quiet
says cut/log.txt "resumed = step 20 time = 0.08 ranks = 2"
for file in $(cd run2 && ls history.csv *.hdf); do cmp -s run2/$file cut/$file || fail "$name: $file differs"; done

# The same in clouds of both bases, in the air: nodes on the axis stay there, whatever their rank.
# Each is resumed, lme on one rank.
for basis in lme mls; do
  flight="--set method=gmm --set basis={$basis:{}} --set analysis.end=0.04 --set analysis.step=2e-3 --set newton.residual=1e-12"
  test $basis = lme && more=3 on=1 || more=2 on=2
  for ranks in 1 $more; do
    expect "$basis on $ranks" 0 on_ranks $ranks "$talus" run ball.yaml --out $basis$ranks --quiet $flight
    cut -d, -f1-5 $basis$ranks/history.csv >history$ranks.csv
  done
  awk -f "$compare" history1.csv history$more.csv >difference.txt || { fail "$basis: $more ranks differ"; head -n 5 difference.txt; }
  rm -rf cut && cp -r $basis$on cut && rm cut/checkpoint_*20.h5
  expect "$basis, resumed" 0 on_ranks $on "$talus" run --resume cut --quiet
  says cut/log.txt "resumed = step 10 time = 0.02 ranks = $on"
  for file in $(cd $basis$on && ls history.csv *.hdf); do cmp -s $basis$on/$file cut/$file || fail "$name: $file differs"; done
done

# Dry grains leave a silo with a flat floor. With all lengths and the stiffness times 4, times are twice as long, and masses 64 times as large: the
# flow grows by 4^(5/2). These are powers of two, so that the digits are the same.
cat >case.yaml <<'END'
kinematics: axisymmetric
method: mpm
analysis: {type: dynamic, step: 5e-4, end: 0.065}
grid: {box: {min: [0, -0.01], max: [0.03, 0.06]}, size: 0.0025, outside: remove}
bodies:
  - {name: grains, shape: {box: {min: [0, 0], max: [0.03, 0.05]}}, points_per_cell: 4, material: sand, k0: 0.5}
materials:
  sand: {law: mohr-coulomb, density: 1500, young: 2e5, poisson: 0.3, friction_angle: 35, dilatancy_angle: 0, cohesion: 0}
boundary:
  - {on: {x: [0.01, 0.03], y: 0}, fix: [x, y]}
  - {on: {x: 0.03}, fix: [x]}
loads: {gravity: [0, -9.81]}
measures:
  mass: {mass: total}
  lowest: {extent: {min: y}}
  falls: {momentum: y}
END
sed 's/step: 5e-4, end: 0.065/step: 1e-3, end: 0.13/; s/-0.01/-0.04/; s/\[0.03, 0.06\]/[0.12, 0.24]/; s/size: 0.0025/size: 0.01/
  s/\[0.03, 0.05\]/[0.12, 0.2]/; s/young: 2e5/young: 8e5/; s/\[0.01, 0.03\]/[0.04, 0.12]/; s/x: 0.03/x: 0.12/' case.yaml >large.yaml
expect "silo" 0 "$talus" run case.yaml --out small --quiet
expect "silo, four times as large" 0 "$talus" run large.yaml --out large --quiet
paste -d, small/history.csv large/history.csv | awk -F, '
  function off(a, b) {return a == b ? 0 : (a > b ? a - b : b - a) / (a > 0 ? a : -a)}
  function see(e) {if (e > worst) worst = e}
  NR > 1 {see(off(2 * $1, $6)); see(off(64 * $3, $8)); see(off(4 * $4, $9)); see(off(128 * $5, $10)); first = first ? first : $3; last = $3}
  END {exit !(NR > 120 && last < 0.99 * first && worst < 1e-9)}' || fail "the flow does not grow by 4^(5/2)"

finish
