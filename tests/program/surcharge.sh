#!/bin/sh
# Loads that begin in a stage, on a fill that comes with it or on what has been there: what stands below bears all.
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
  - {name: beside, loads: {tractions: [{on: {body: ground, y: 2, x: [2, 4]}, value: [0, -2e4]}]}}
END

# 160 kN of ground, 40 of fill, 100 and 160 on it; then 40 on the ground alone.
bears() {
  awk -F, '$3 == 2 { n = 300 } $3 == 3 { n = 300 } $3 == 4 { n = 360 } $3 == 5 { n = 240 } { last[$3] = $4 / 1e3 - n }
    END { for (k = 2; k <= 5; ++k) if (last[k] > 0.05 || last[k] < -0.05) exit 1 }' "$1/history.csv" || fail "$1 bears something else"
}
for way in "mpm 3" "fem 2"; do
  set -- $way
  expect "$1 on $2" 0 on_ranks $2 "$talus" run fill.yaml --out $1 --set method=$1
  bears $1
done

# Cut off in any stage and resumed: the same bits.
sed 's/^output:/checkpoint: {steps: 1, keep: 20}\n&/' fill.yaml >kept.yaml
expect "with checkpoints" 0 "$talus" run kept.yaml --out kept
bears kept
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

# --- a column under its weight, then q = 100 kPa on it, then a point force of 3 kN, then a pressure of 50 kPa for q ---
cat >column.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static}
grid: {box: {min: [0, 0], max: [1, 4]}, size: 0.5}
bodies: [{name: column, shape: {box: {min: [0, 0], max: [1, 2]}}, points_per_cell: 4, material: soil}]
materials: {soil: {law: neo-hookean, density: 2000, young: 1e9, poisson: 0.25}}
boundary:
  - {name: base, on: {boundary: bottom}, fix: [y]}
  - {on: {boundary: left}, fix: [x]}
  - {on: {boundary: right}, fix: [x]}
loads: {gravity: [0, -10]}
measures: {base: {reaction: y, of: {boundary: base}}, top: {displacement: y, of: {tracer: [0.5, 2]}}}
output: {history: {steps: 1}}
stages:
  - {name: weight}
  - {name: surcharge, loads: {tractions: [{on: {body: column, y: 2}, value: [0, -1e5]}]}}
  - {name: point, loads: {points: [{at: [0.5, 1.5], force: [0, -3e3]}]}}
  - {name: pressure, loads: {tractions: [], pressures: [{on: {body: column, y: 2}, value: 5e4}]}}
END
# M = 1.2 E: q h / M = 166.7 um, but for what a strain of 1e-4 changes. To round-off what the same load has by hand.
by_hand='{on: {body: column, y: 2}, value: [0, -1e5], amplitude: [[0, 0], [1, 0], [2, 1], [3, 1], [3.001, 0]]}'
for how in "1 mpm" "2 fem" "1 gmm --set basis={lme:{}} --set grid.cell=triangle --set bodies[0].points_per_cell=3"; do
  set -- $how
  ranks=$1
  shift
  expect "a surcharge, $how" 0 on_ranks $ranks "$talus" run column.yaml --out late --force --set method="$@"
  awk -F, '{ base[$3] = $4; top[$3] = $5 } END { s = (top[1] - top[2]) / 1e-4 * 0.6
    exit !(base[2] - 14e4 < 1e-3 && 14e4 - base[2] < 1e-3 && base[3] - 14.3e4 < 1e-3 && 14.3e4 - base[3] < 1e-3 &&
      base[4] - 9.3e4 < 1e-2 && 9.3e4 - base[4] < 1e-2 && s > 0.998 && s < 1.002) }' late/history.csv ||
    fail "$name: $(cat late/history.csv)"
done
expect "by hand" 0 "$talus" run column.yaml --out hand --set "stages=[{name: weight, loads: {tractions: [$by_hand]}}, {name: more}]"
expect "by itself" 0 "$talus" run column.yaml --out itself --set 'stages[2]={name: end}' --set 'stages[3]={name: end too}'
awk -F, 'NR == FNR { u[$1] = $5; next } $1 == 2 { d = u[2] / $5 - 1; exit !(d < 1e-9 && d > -1e-9) }' \
  itself/history.csv hand/history.csv || fail "otherwise by hand"

# --- a bar that turns freely, 2 rad/s, is pressed at its end after 0.8 s for 0.1 s: the momentum is that of p along its
# normal, which has turned from 1.6 to 1.8; a traction of 300 Pa gives 30 kg m/s along x, wherever the bar looks ---
cat >bar.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.8, step: 0.02}
grid: {box: {min: [-3, -3], max: [3, 3]}, size: 0.5}
bodies: [{name: bar, shape: {box: {min: [-1, -0.5], max: [1, 0.5]}}, points_per_cell: 4, material: rubber, spin: 2}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0.2}}
measures: {x: {momentum: x}, y: {momentum: y}}
output: {history: end}
stages:
  - {name: turns}
  - name: pushed
    analysis: {end: 0.1}
    loads: {tractions: [{on: {body: bar, x: 1}, value: [300, 0]}], pressures: [{on: {body: bar, x: -1}, value: 1e3}]}
END
expect "a bar" 0 "$talus" run bar.yaml --out bar
awk -F, 'END { x = $4 - 30 - 500 * (sin(1.8) - sin(1.6)); y = $5 - 500 * (cos(1.6) - cos(1.8))
  exit !(x * x + y * y < 0.05) }' \
  bar/history.csv || fail "$name: $(tail -n 1 bar/history.csv)"

# Not where the case does not tell which surface it is; and what is not there bears nothing.
expect "a side" 2 "$talus" check fill.yaml --set 'stages[2].loads={pressures: [{on: {boundary: top}, value: 1}]}'
says err.txt "bodies come or go with this stage, and the case does not tell whether a load of stage 3 acts on them (stage 'fill')"
expect "too early" 2 "$talus" check fill.yaml --set 'loads.tractions=[{on: {body: fill, y: 3}, value: [0, -1]}]'
says err.txt "the load acts on 'fill', which is not there" "give it in the stage that brings 'fill'"
finish
