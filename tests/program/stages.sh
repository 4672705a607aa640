#!/bin/sh
# Stages: one after another from the state of the one before, whatever a stage changes; resumed from within any of them, on one to three
# ranks; from the state of another run; and what is refused, by its name.
compare="$(cd "$(dirname "$0")" && pwd)/compare.awk"
. "$(dirname "$0")/library.sh"

# A column: weight, the top dug away in two steps, fill of another law placed beside it, its factor of safety, and its end.
cat >column.yaml <<'END'
kinematics: plane-strain
method: mpm
formulation: mixed
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [4, 3]}, size: 0.5}
bodies:
  - {name: column, shape: {box: {min: [0, 0], max: [1, 2]}}, material: soil}
  - {name: top, shape: {box: {min: [0, 2], max: [1, 2.5]}}, material: soil}
materials:
  soil: {law: mohr-coulomb, density: 2000, young: 5e6, poisson: 0.3, friction_angle: 30, cohesion: 3e4, dilatancy_angle: 1}
  gravel: {law: neo-hookean, density: 1800, young: 4e6, poisson: 0.25}
boundary:
  - {name: floor, on: {y: 0}, fix: [x, y]}
  - {name: left, on: {x: 0}, fix: [x]}
  - {name: prop, on: {x: 1, y: [0.9, 1.1]}, fix: [x]}
loads: {gravity: [0, -9.81]}
measures:
  front: {extent: {max: x}}
  settle: {displacement: y, of: {tracer: [0.6, 1.9]}}
  balance: {energy: balance}
  weight: {reaction: y, of: {boundary: floor}}
  F: {factor_of_safety: upper}
  mass: {mass: total}
output: {fields: [displacement, stress], history: {steps: 1}}
checkpoint: {steps: 1, keep: 99}
stages:
  - name: weight
  - {name: dig, bodies: [{name: top, absent: true}], boundary: [{name: prop, absent: true}], reset: [displacement]}
  - name: fill
    materials: {loose: {law: mohr-coulomb, density: 1500, young: 5e6, poisson: 0.3, friction_angle: 25, cohesion: 1e4}}
    bodies:
      - {name: column, material: gravel}
      - {name: fill, shape: {box: {min: [1, 0], max: [2, 0.5]}}, material: loose}
  - name: stronger
    bodies: [{name: column, material: soil}]
    loads: {gravity: [0, -12]}
  - {name: safety, analysis: {type: factor-of-safety, reduction: {tolerance: 0.05, step: 0.5}}}
  - name: end
    analysis: {type: dynamic, end: 0.006, step: 0.002}
    strength: {beyond_failure: 1.5}
END

# forget DIR STEP: as if the run had died just before the first checkpoint after this step.
forget() {
  rm -f "$1/timings.txt"
  for file in "$1"/checkpoint_*.h5; do
    [ "$(basename "$file" .h5 | sed 's/checkpoint_0*//')" -le "$2" ] || rm "$file"
  done
}

same_bits() {
  for file in $(cd "$2" && ls history.csv *.hdf *.hdf.series); do
    cmp -s "$2/$file" "$3/$file" || fail "$1: $file differs"
  done
}

# same_answer NAME A B: but for round-off, which is all that the account of energies is.
same_answer() {
  for run in "$2" "$3"; do awk -F, -v OFS=, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "balance") b = k } { $b = 0; print }' "$run/history.csv" >"$run.short"; done
  awk -f "$compare" "$2.short" "$3.short" >difference.txt || { fail "$1: differs"; head -n 5 difference.txt; }
}

# last STAGE COLUMN DIR: the last value of a stage
last() { awk -F, -v s="$1" -v k="$2" '$3 == s { v = $k } END { print v }' "$3/history.csv"; }

for method in mpm fem; do
  for ranks in 1 2; do
    expect "$method on $ranks" 0 on_ranks $ranks "$talus" run column.yaml --out $method$ranks --set method=$method
    says $method$ranks/log.txt "stage = 1 of 6 (weight)" "stage = 2 of 6 (dig) from t = 1 s" "out of balance = " "released over = 1 s" \
      "factor of safety = " "stage = 6 of 6 (end)"
    same_answer "$name" ${method}1 $method$ranks
  done
  steps=$(awk -F, 'END { print $2 }' ${method}1/history.csv)
  # in the stage that digs and in the one that fills, or in the last one; and there on other ranks, on three for few steps
  for step in $([ $method = mpm ] && echo 3 5 || echo $((steps - 1))); do
    rm -rf cut && cp -r ${method}1 cut && forget cut "$step"
    expect "$method resumed at $step" 0 "$talus" run --resume cut --quiet
    same_bits "$name" ${method}1 cut
  done
  rm -rf cut && cp -r ${method}2 cut
  if [ $method = mpm ]; then forget cut $((steps - 1)) && ranks=3; else forget cut 5 && ranks=1; fi
  expect "$method from 2 ranks to $ranks" 0 on_ranks $ranks "$talus" run --resume cut --quiet
  same_answer "$name" ${method}1 cut
  name="$method, the floor bears all that is there"
  # fill beside a column that has bulged has less room in cells of fem
  awk -F, -v bulged=$([ $method = fem ] && echo 0.01 || echo 1e-9) 'function off(x, y, by) { return x > y * (1 + by) || x < y * (1 - by) }
    { w[$3] = $7; m[$3] = $9 }
    END { exit off(m[1], 5000, 1e-9) || off(m[2], 4000, 1e-9) || off(m[3], 4350, bulged) || off(m[4], 4750, bulged) ||
      off(w[1], m[1] * 9.81, 1e-6) || off(w[2], m[2] * 9.81, 1e-6) || off(w[3], m[3] * 9.81, 1e-6) || off(w[4], m[4] * 12, 1e-6) }' ${method}1/history.csv ||
    fail "$name: $(cut -d, -f3,7,9 ${method}1/history.csv)"
  name="$method, the account of energies closes"
  awk -F, 'NR > 1 && $6 * $6 > 1e-16 { exit 1 }' ${method}1/history.csv || fail "$name"
  name="$method, dug: the rest rises from there"
  awk -v s="$(last 2 5 ${method}1)" 'BEGIN { exit !(s > 0) }' || fail "$name: $(last 2 5 ${method}1)"
done

# Clouds keep their nodes and take other materials, loads, motions and analyses
cat >cloud.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 2, end: 2}
grid: {box: {min: [0, 0], max: [2, 3]}, size: 0.25}
bodies:
  - {name: column, shape: {box: {min: [0, 0], max: [1, 2]}}, material: soil}
  - {name: top, shape: {box: {min: [0, 2], max: [1, 2.5]}}, material: soil}
materials:
  soil: {law: neo-hookean, density: 2000, young: 5e6, poisson: 0.3}
boundary:
  - {name: floor, on: {y: 0}, fix: [x, y]}
  - {name: left, on: {x: 0}, fix: [x]}
loads: {gravity: [0, -9.81]}
measures:
  settle: {displacement: y, of: {tracer: [0.6, 1.9]}}
  balance: {energy: balance}
  weight: {reaction: y, of: {boundary: floor}}
output: {fields: [displacement, stress], history: {steps: 1}}
checkpoint: {steps: 1, keep: 99}
stages:
  - name: weight
  - name: same
  - {name: stiffer, materials: {soil: {young: 1e7}}}
  - {name: heavier, loads: {gravity: [0, -12]}, reset: [displacement]}
  - {name: sheared, boundary: [{name: floor, on: {y: 0}, displacement: {x: 0.01, y: 0}}, {name: left, on: {x: 0}, displacement: {x: 0.01}}]}
  - {name: shaken, analysis: {type: dynamic, end: 0.04, step: 0.01}, loads: {gravity: [1, -12]}}
END
for basis in lme mls; do
  for ranks in 1 2 3; do
    [ $basis$ranks = lme3 ] || [ $ranks = 1 ] || continue
    expect "$basis on $ranks" 0 on_ranks $ranks "$talus" run cloud.yaml --out $basis$ranks --set "basis={$basis: {}}"
    says $basis$ranks/log.txt "stage = 6 of 6 (shaken)" "out of balance = " "released over = 2 s"
    same_answer "$name" ${basis}1 $basis$ranks
  done
  rm -rf cut && cp -r ${basis}1 cut && forget cut 7
  expect "$basis resumed" 0 "$talus" run --resume cut --quiet
  same_bits "$name" ${basis}1 cut
  name="$basis, the floor bears what is there, and energies close"
  awk -F, 'function off(x, y) { return x > y * (1 + 1e-6) || x < y * (1 - 1e-6) }
    NR > 1 { w[$3] = $6; b[$3] = $5 } $3 == 4 && $4 * $4 > 4e-6 { exit 1 }
    END { if (off(w[1], 49050) || off(w[2], 49050) || off(w[3], 49050) || off(w[4], 60000) || off(w[5], 60000)) exit 1
      for (s in b) if (b[s] * b[s] > 1e-16) exit 1 }' ${basis}1/history.csv || fail "$name"
done
rm -rf cut && cp -r lme3 cut && forget cut 7
expect "clouds from three ranks to two" 0 on_ranks 2 "$talus" run --resume cut --quiet
same_answer "$name" lme1 cut
sed '/^stages:/,$d; /^  settle:/d' cloud.yaml >clouds-later.yaml
expect "clouds from another run" 0 on_ranks 2 "$talus" run clouds-later.yaml --out later-cloud --set initial.run=lme3 --set initial.stage=same
says later-cloud/log.txt "initial = " "/lme3"
awk '/out of balance/ { if ($5 > 0.02 * 49050) exit 1 }' later-cloud/log.txt || fail "$name: $(grep balance later-cloud/log.txt)"
sed '/^stages:/,$d' cloud.yaml >clouds-traced.yaml
expect "a tracer of clouds from another run" 2 "$talus" run clouds-traced.yaml --out traced-cloud --set initial.run=lme3 --set initial.stage=same
says err.txt "tracers of method gmm begin where the body does" "make it a stage of that run, or leave the measure out"

# From a stage of another run: with fem, whose nodes keep their places, nothing is out of balance where nothing has changed
sed '/^stages:/,$d' column.yaml | sed 's/name: top/name: top, absent: true/; s/name: prop/name: prop, absent: true/; /^  F:/d' >later.yaml
for ranks in 1 2; do
  expect "from a stage on $ranks" 0 on_ranks $ranks "$talus" run later.yaml --out later$ranks --set method=fem --set initial.run=fem2 --set initial.stage=dig
  says later$ranks/log.txt "initial = " "/fem2"
  awk '/out of balance/ { if ($5 > 1e-3) exit 1 }' later$ranks/log.txt || fail "$name: $(grep balance later$ranks/log.txt)"
  same_answer "$name" later1 later$ranks
done
rm -rf cut && cp -r later1 cut && forget cut 1
expect "resumed" 0 "$talus" run --resume cut --quiet
same_bits "$name" later1 cut

# Onto another grid: points of mpm go, whatever the cells and the ranks; the weight is there, and nothing moves by more than 1.2 % of what it had settled,
# which is what cells of other sizes and formulations differ by (0.8, 1.1, 0.6 %)
sed '/^stages:/,$d; /^  F:/d; /^formulation:/d; s/^analysis.*/&\ninitial: {run: mpm2, stage: dig}/; s/name: top/name: top, absent: true/; s/name: prop/name: prop, absent: true/' column.yaml >onto.yaml
for grid in .size=0.25 '={box: {min: [-0.4, 0], max: [4, 3.2]}, size: 0.4}' .size=1; do
  expect "onto grid$grid" 0 "$talus" run onto.yaml --out onto1 --set "grid$grid" --set 'loads.gravity_amplitude=[[0, 1]]' --force
  awk -F, -v s="$(last 1 5 mpm1)" 'NR == 1 { for (k = 1; k <= NF; ++k) { sub(" .*", "", $k); c[$k] = k } next } { w = $c["weight"]; u = $c["settle"] }
    END { if (w > 39240.1 || w < 39239.9 || u * u > 1.44e-4 * s * s) { print w, u, s; exit 1 } }' onto1/history.csv >bad.txt || fail "$name: $(cat bad.txt)"
done
expect "onto grid$grid on 3" 0 on_ranks 3 "$talus" run onto.yaml --out onto3 --set "grid$grid" --set 'loads.gravity_amplitude=[[0, 1]]'
same_answer "$name" onto1 onto3

# Tracers in a run from another one: of mpm the material that is there now (beside it: none), of fem what was there undeformed. A column of
# 1 m that is pressed by 30 kPa, nu = 0, is l long with (l - 1/l) E / 2 = -30 kPa: 0.7440 m
cat >press.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 4}
grid: {box: {min: [0, 0], max: [0.25, 1]}, size: 0.125}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [0.25, 1]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1000, poisson: 0, young: 1e5}}
boundary: [{on: {y: 0}, fix: [y]}, {on: {x: 0}, fix: [x]}, {on: {x: 0.25}, fix: [x]}]
loads: {tractions: [{name: T, on: {body: b, y: 1}, value: [0, -3e4]}]}
measures: {place: {position: y, of: {tracer: [0.125, 0.7]}}}
output: {every: end}
END
awk '/^analysis/ { print "initial: {run: press}" } { print }' press.yaml | sed 's/value: .*}/value: [0, -3e4], amplitude: [[0, 1], [1, 0]]}]}/' >let.yaml
for method in mpm fem; do
  [ $method = mpm ] && ranks=2 || ranks=1
  expect "pressed, $method" 0 "$talus" run press.yaml --out press --force --quiet --set method=$method
  expect "a tracer from there, $method on $ranks" 0 on_ranks $ranks "$talus" run let.yaml --out let --force --quiet --set method=$method
  awk -F, -v fem=$([ $method = fem ] && echo 1 || echo 0) 'NR == 1 { next } { y[NR] = $3 } END { l = sqrt(0.09 + 1) - 0.3
    first = fem ? 0.7 * l : 0.7; last = fem ? 0.7 : 0.7 / l; exit !((y[2] - first) ^ 2 < 1e-6 && (y[NR] - last) ^ 2 < (fem ? 1e-12 : 1e-4)) }' let/history.csv ||
    fail "$name: $(cut -d, -f3 let/history.csv | tr '\n' ' ')"
  expect "beside the material, $method" $([ $method = fem ] && echo 0 || echo 2) "$talus" run let.yaml --out let --force --quiet --set method=$method \
    --set measures.place.of.tracer[1]=1
  [ $method = fem ] || says err.txt "no material carries the tracer: where it begins none is left"
done
rm -r let press

# Constants that change with time: a block yields between floor and plate while its strength falls, what stands beside it becomes heavier and softer
cat >ageing.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 2, steps: 2}
grid: {box: {min: [0, 0], max: [4, 3]}, size: 0.5}
bodies:
  - {name: block, shape: {box: {min: [0, 0], max: [1, 1]}}, material: soil}
  - {name: column, shape: {box: {min: [2, 0], max: [3, 2]}}, material: fill}
materials:
  soil: {law: mohr-coulomb, density: 1e-3, young: 1e9, poisson: 0.3, friction_angle: 30, cohesion: 1e4, dilatancy_angle: 15}
  fill: {law: neo-hookean, density: 1600, young: 1e8, poisson: 0.3}
boundary:
  - {name: under, on: {x: [0, 1], y: 0}, fix: [y]}
  - {name: left, on: {x: 0}, fix: [x]}
  - {name: plate, on: {x: [0, 1], y: 1}, displacement: {y: -1e-4}}
  - {name: floor, on: {x: [2, 3], y: 0}, fix: [x, y]}
  - {name: sides, on: {x: 2}, fix: [x]}
  - {name: far, on: {x: 3}, fix: [x]}
loads: {gravity: [0, -10]}
measures:
  strength: {reaction: y, of: {boundary: under}}
  weight: {reaction: y, of: {boundary: floor}}
  settle: {displacement: y, of: {tracer: [2.5, 1.9]}}
  balance: {energy: balance}
output: {fields: [displacement, stress]}
checkpoint: {steps: 1, keep: 99}
stages:
  - name: press
  - name: change
    analysis: {end: 4, steps: 4}
    materials:
      soil: {amplitude: {cohesion: [[0, 1], [2, 0.25]], friction_angle: [[2, 1], [4, 0.5]]}}
      fill: {amplitude: {density: [[0, 1], [2, 1.25]], young: [[2, 1], [4, 0.5]]}}
  - {name: rest, analysis: {end: 1, steps: 1}}
END
for method in mpm fem; do
  for ranks in 1 2; do
    [ $method$ranks != fem2 ] || continue
    expect "constants change, $method on $ranks" 0 on_ranks $ranks "$talus" run ageing.yaml --out ageing_$method$ranks --set method=$method
    same_answer "$name" ageing_${method}1 ageing_$method$ranks
  done
  rm -rf cut && cp -r ageing_${method}1 cut && forget cut 4
  expect "constants change, $method resumed" 0 "$talus" run --resume cut --quiet
  same_bits "$name" ageing_${method}1 cut
  name="constants change, $method: 2 c (tan phi + sqrt(1 + tan^2 phi)), the weight, and what it had settled stays"
  awk -F, 'function bears(c, phi) { return 2 * c * (1 + sin(phi)) / cos(phi) } function off(x, y) { return x > y * (1 + 2e-4) || x < y * (1 - 2e-4) }
    BEGIN { d = atan2(0, -1) / 180 }
    NR > 3 { t = $1 - 2; fall = t < 0 ? 0 : t > 2 ? 2 : t; turn = t < 2 ? 0 : t > 4 ? 2 : t - 2 }
    NR > 3 && (off($4, bears(1e4 * (1 - 0.375 * fall), d * 30 * (1 - 0.25 * turn))) || off($5, 32000 * (1 + 0.125 * fall)) || $7 * $7 > 1e-20) { print; bad = 1 }
    $1 == 4 { settled = $6 } $1 > 4 && off(-$6, -settled) { print; bad = 1 } END { exit bad }' ageing_${method}1/history.csv >bad.txt || { fail "$name"; head -n 3 bad.txt; }
done

# Measures, walls and output that come and go: one history, cells empty where a measure is not there
cat >measures.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [2, 3]}, size: 0.5}
bodies:
  - {name: column, shape: {box: {min: [0, 0], max: [1, 2]}}, material: soil}
  - {name: top, shape: {box: {min: [0, 2], max: [1, 2.5]}}, material: soil}
materials:
  soil: {law: mohr-coulomb, density: 2000, young: 5e6, poisson: 0.3, friction_angle: 30, cohesion: 3e4, dilatancy_angle: 1}
boundary:
  - {name: floor, on: {y: 0}, fix: [x, y]}
  - {name: left, on: {x: 0}, fix: [x]}
walls:
  - {name: prop, shape: {box: {min: [1, 0], max: [1.5, 3]}}}
loads: {gravity: [0, -9.81]}
measures:
  settle: {displacement: y, of: {tracer: [0.6, 1.9]}}
  always: {displacement: y, of: {tracer: [0.4, 1.1]}}
  prop: {wall_force: x, of: {wall: prop}}
output: {fields: [displacement, stress], every: {steps: 1}, history: {steps: 1}, grid: false}
checkpoint: {steps: 1, keep: 99}
stages:
  - name: weight
  - name: dig
    bodies: [{name: top, absent: true}]
    measures:
      settle: {absent: true}
      weight: {reaction: y, of: {boundary: floor}}
      rises: {displacement: y, of: {tracer: [0.4, 1.1]}}
      rate: {displacement: y, of: {tracer: [0.6, 1.9]}, rate: {window: 0.5}}
    output: {grid: true}
  - name: free
    walls: [{name: prop, absent: true}, {name: hood, shape: {box: {min: [0, 2.2], max: [1, 2.6]}}}]
    output: {grid: false, fields: [displacement]}
    measures:
      settle: {displacement: y, of: {tracer: [0.6, 1.9]}}
      prop: {absent: true}
      hood: {wall_force: y, of: {wall: hood}}
END
for method in mpm fem; do
  for ranks in 1 2; do
    [ $method$ranks != mpm2 ] || continue
    expect "measures change, $method on $ranks" 0 on_ranks $ranks "$talus" run measures.yaml --out measures_$method$ranks --set method=$method
    same_answer "$name" measures_${method}1 measures_$method$ranks
  done
  for step in $([ $method = mpm ] && echo 3 5 || echo 4); do
    rm -rf cut && cp -r measures_${method}1 cut && forget cut $step
    expect "measures change, $method resumed at $step" 0 "$talus" run --resume cut --quiet
    same_bits "$name" measures_${method}1 cut
  done
  name="measures change, $method: what begins counts from there, what ends leaves cells empty"
  awk -F, -v off=$([ $method = fem ] && echo 1e-9 || echo 5e-3) 'NR == 1 { for (k = 1; k <= NF; ++k) { sub(" .*", "", $k); c[$k] = k } next }
    { stage = $c["stage"]; if (stage == 1) before = $c["always"]; moved = $c["always"] - before - $c["rises"] }
    stage == 1 && ($c["rises"] != "" || $c["settle"] == "" || $c["hood"] != "") { print; bad = 1 }
    stage == 2 && ($c["settle"] != "" || $c["rises"] == "" || moved * moved > off * off * before * before) { print; bad = 1 }
    stage == 3 && ($c["prop"] != "" || $c["settle"] == "" || $c["hood"] == "" || moved * moved > off * off * before * before) { print; bad = 1 }
    END { exit bad }' measures_${method}1/history.csv >bad.txt || { fail "$name"; head -n 3 bad.txt; }
  name="measures change, $method: the grid is written in one stage alone"
  [ "$(ls measures_${method}1/grid_*.hdf | wc -l)" -lt "$(ls measures_${method}1/points_*.hdf | wc -l)" ] || fail "$name"
done
expect "a history with empty cells is drawn" 0 "$talus" plot measures_mpm1 --y rises --x always

# A block that is bonded to another one slides off when a stage lets it: g (sin a - mu cos a)
cat >slide.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.1, step: 0.02}
grid: {box: {min: [0, 0], max: [4, 1.5]}, size: 0.25}
bodies:
  - {name: base, shape: {box: {min: [0, 0], max: [4, 0.5]}}, material: rubber}
  - {name: block, shape: {box: {min: [1, 0.5], max: [2, 1]}}, material: rubber}
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0.3}}
interfaces: [{name: joint, between: [block, base], contact: bonded}]
boundary: [{name: floor, on: {y: 0}, fix: [x, y]}]
loads: {gravity: [3.355217, -9.218385], gravity_amplitude: [[0, 0], [0.1, 1]]} # tilted by 20 degrees
measures: {pull: {interface_force: x, of: {interface: joint}}, speed: {velocity: x, of: {tracer: [1.5, 0.75]}}}
checkpoint: {steps: 1, keep: 99}
stages:
  - name: bonded
  - {name: slides, interfaces: [{name: joint, between: [block, base], contact: friction, friction: 0.2}], analysis: {end: 0.1}}
END
for ranks in 1 2; do
  expect "an interface changes, on $ranks" 0 on_ranks $ranks "$talus" run slide.yaml --out slide$ranks
  same_answer "$name" slide1 slide$ranks
done
expect "bodies of an interface by their names" 0 "$talus" plot slide2 --field body --time last --size 200x150 # each point tells its body without being asked
rm -rf cut && cp -r slide1 cut && forget cut 7
expect "an interface changes, resumed" 0 "$talus" run --resume cut --quiet
same_bits "$name" slide1 cut
expect "an interface of gmm changes" 0 "$talus" run slide.yaml --out gmm-slide1 --set method=gmm
awk -F, 'END { exit !(($5 / (0.1 * 9.81 * (0.3420201 - 0.2 * 0.9396926)) - 1) ^ 2 < 0.01 ^ 2) }' gmm-slide1/history.csv ||
  fail "$name: $(tail -n 1 gmm-slide1/history.csv)"
rm -rf cut && cp -r gmm-slide1 cut && forget cut 7
expect "an interface of gmm changes, resumed" 0 "$talus" run --resume cut --quiet
same_bits "$name" gmm-slide1 cut

# What has come to rest on a wall by statics stays at rest in dynamics, whatever the step: to 1e-6 of its settlement
cat >rests.yaml <<'END'
title: A block that rests on a wall
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 4}
grid: {box: {min: [0, 0.25], max: [1, 1.25]}, size: 0.25}
bodies: [{name: block, shape: {box: {min: [0, 0.25], max: [1, 1.25]}}, material: soil}]
materials:
  soil: {law: mohr-coulomb, density: 2000, young: 1e6, poisson: 0.3, friction_angle: 30, dilatancy_angle: 0, cohesion: 5e3}
boundary: [{name: left, on: {boundary: left}, fix: [x]}]
walls: [{name: floor, shape: {half-space: {point: [0, 0.25], normal: [0, 1]}}, contact: stick}]
loads: {gravity: [0, -9.81], gravity_amplitude: [[0, 0], [0.5, 1]]}
measures:
  top: {displacement: y, of: {tracer: [0.8, 1.2]}}
  force: {wall_force: y, of: {wall: floor}}
output: {fields: [displacement], every: end}
stages:
  - {name: stands}
  - {name: waits, analysis: {type: dynamic, end: 0.1, step: 0.02}}
END
for way in "fem 0.002 0.02" "mpm 0.02 0.1"; do
  set -- $way
  expect "rest on a wall, $way" 0 "$talus" run rests.yaml --out rests --force --quiet --set method=$1 --set stages[1].analysis.step=$2 --set stages[1].analysis.end=$3 \
    --set 'grid.box={min: [0, 0], max: [2, 1.5]}' --set 'basis={cell: {}}' --set analysis.steps=8
  awk -F, 'NR > 1 && $3 == 1 {top = $4; force = $5}
    NR > 1 && $3 == 2 {n += 1; d = ($4 - top) / top; f = ($5 - force) / force; if (d * d > 1e-12 || f * f > 1e-12) bad = 1}
    END {exit !(n > 4 && !bad && force > 19619 && force < 19621)}' rests/history.csv || fail "$name: it jerks"
done
# With smooth functions, off the grid's lines: what holds nodes that points hardly reach must be remembered (solve/forces/rest.c).
for step in 0.02 0.002; do
  # ten steps at most: who jerks does so at once
  expect "rest with gimp, $step" 0 "$talus" run rests.yaml --out rests --force --quiet --set method=mpm --set stages[1].analysis.step=$step --set stages[1].analysis.end=$([ $step = 0.02 ] && echo 0.1 || echo 0.02) \
    --set 'grid={box: {min: [0, 0], max: [2, 1.6]}, size: 0.2}' --set 'basis={gimp: {}}' --set analysis.steps=8 --set 'checkpoint={steps: 1, keep: 99}'
  awk -F, 'NR > 1 && $3 == 1 {top = $4; force = $5}
    NR > 1 && $3 == 2 {n += 1; d = ($4 - top) / top; f = ($5 - force) / force; if (d * d > 1e-16 || f * f > 1e-14) bad = 1}
    END {exit !(n > 4 && !bad && force > 19619 && force < 19621)}' rests/history.csv || fail "$name: it jerks"
done
rm -rf cut && cp -r rests cut && forget cut 7
expect "rest with gimp, resumed" 0 "$talus" run --resume cut --quiet
same_bits "$name" rests cut
# With sides by a twentieth of a cell beyond the lines of the grid, whose nodes follow others (method/extend).
expect "rest with nodes that follow" 0 "$talus" run rests.yaml --out rests --force --quiet --set method=mpm \
  --set 'grid={box: {min: [0, 0], max: [2, 1.6]}, size: 0.2}' --set 'basis={gimp: {}}' --set analysis.steps=8 --set 'bodies[0].shape.box.max=[1.01, 1.22]'
awk -F, 'NR > 1 && $3 == 1 {top = $4; force = $5}
  NR > 1 && $3 == 2 {n += 1; d = ($4 - top) / top; f = ($5 - force) / force; if (d * d > 1e-16 || f * f > 1e-14) bad = 1}
  END {exit !(n > 4 && !bad && force > 19221 && force < 19222)}' rests/history.csv || fail "$name: it jerks"
# A wall that comes where a boundary lets go bears at once what that bore, in statics and in dynamics, and holds by friction what that lets it.
sed -e 's/^boundary: \[/&{name: base, on: {y: 0.25}, fix: [y]}, /' -e 's/contact: stick}/contact: friction, friction: 0.3, absent: true}/' \
  -e 's/waits, .*/swaps, boundary: [{name: base, absent: true}, {name: left, absent: true}], walls: [{name: floor, absent: false}]}/' rests.yaml >swaps.yaml
swap() { # name, what the force may be off by, options
  what=$1 off=$2 && shift 2
  expect "a wall for a boundary, $what on $ranks" 0 on_ranks $ranks "$talus" run swaps.yaml --out swaps --force --quiet "$@"
  awk -F, -v off=$off 'NR > 1 && $3 == 2 {n += 1; f = $5 / 19620 - 1; if (f * f > off * off) bad = 1} END {exit !(n > 3 && !bad)}' swaps/history.csv ||
    fail "$name: $(grep -m 1 '^[^,]*,[^,]*,2,' swaps/history.csv)"
}
side='loads.tractions=[{name: side, on: {body: block, x: 1}, value: [-5000, 0], amplitude: [[0, 0], [0.25, 1], [1, 1]]}]'
ranks=1
swap fem 1e-6 "--set=stages[1].$side"
set -- --set method=mpm --set 'grid.box={min: [0, 0], max: [2, 1.5]}' --set 'basis={cell: {}}' --set analysis.steps=8
ranks=2
swap mpm 1e-6 "$@"
ranks=1
swap dynamics 1e-3 "$@" --set 'stages[1].analysis={type: dynamic, end: 0.1, step: 0.02}' --set 'stages[1].boundary=[{name: base, absent: true}]'
# And a footing of 600 kg upon it, a wall with mass.
sed 's/contact: stick}\]/contact: stick}, {name: footing, shape: {box: {min: [0.2, 1.25], max: [0.8, 1.5]}}, friction: 0.5, mass: {mass: 600, free: [y]}}]/
  s/^output/  speed: {wall_velocity: y, of: {wall: footing}}\n&/' rests.yaml >footing.yaml
for way in "fem 0.02 0.1" "mpm 0.002 0.02"; do
  set -- $way
  expect "a footing that rests, $way" 0 "$talus" run footing.yaml --out footing --force --quiet --set method=$1 --set stages[1].analysis.step=$2 --set stages[1].analysis.end=$3 \
    --set 'grid.box={min: [0, 0], max: [2, 2]}' --set 'basis={cell: {}}' --set analysis.steps=8
  awk -F, 'NR > 1 && $3 == 1 {force = $5} NR > 1 && $3 == 2 {n += 1; if ($6 * $6 > 1e-14) bad = 1}
    END {exit !(n > 4 && !bad && force > 25505 && force < 25507)}' footing/history.csv || fail "$name: it jerks"
done

# Stress that carries the weight, and dynamics after it: resumed from within any stage.
cat >carried.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.25}
bodies:
  - {name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m, k0: 0.5}
materials:
  m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}
boundary:
  - {name: floor, on: {y: 0}, fix: [x, y]}
  - {name: left, on: {x: 0}, fix: [x]}
  - {name: right, on: {x: 1}, fix: [x]}
loads: {gravity: [0, -9]}
measures: {weight: {reaction: y, of: {boundary: floor}}, top: {displacement: y, of: {tracer: [0.4, 0.9]}}, balance: {energy: balance}}
output: {fields: [displacement, stress], history: {steps: 1}}
checkpoint: {steps: 1, keep: 99}
stages:
  - name: rests
  - {name: shaken, analysis: {type: dynamic, end: 0.03, step: 0.01}}
  - {name: heavier, analysis: {type: static, steps: 2}, loads: {gravity: [0, -12]}}
END
expect "weight that is carried" 0 "$talus" run carried.yaml --out carried --quiet
for step in 1 2 4 5 6; do
  rm -rf cut && cp -r carried cut && forget cut "$step"
  expect "weight that is carried, resumed at $step" 0 "$talus" run --resume cut --quiet
  same_bits "$name" carried cut
done
# and between ranks in the middle stage
expect "weight that is carried on 2" 0 on_ranks 2 "$talus" run carried.yaml --out carried2 --quiet
same_answer "$name" carried carried2
forget carried2 3
expect "weight that is carried, from 2 ranks to 3" 0 on_ranks 3 "$talus" run --resume carried2 --quiet
same_answer "$name" carried carried2

# What is refused: refused NAME TEXT OPTION...
refused() {
  title=$1 text=$2
  shift 2
  expect "$title" 2 "$talus" check "$@"
  says err.txt "$text"
}
refused "a body that is not there, and what a body began with" "there is no 'tpo' in bodies" column.yaml --set 'stages[1].bodies[0].name=tpo' \
  --set 'stages[1].bodies[1]={name: column, k0: 3, velocity: [1, 0], shape: {box: {min: [0, 0], max: [1, 1]}}}'
says err.txt "did you mean 'top'?" "'column' is there already, and its \`k0\` is what it began with" \
  "'column' is there already, and its \`velocity\` is what it began with" "all else is of bodies that come" "\`shape\` is what it began with"
refused "a key that stages do not know, two stages of one name" "key 'grid' of stages[1] is not known" column.yaml --set 'stages[1].grid={}' --set 'stages[1].name=weight'
says err.txt "the name 'weight' is taken by stages[0]"
refused "a measure that is not there" "there is no 'setle' in measures that the stage could change" measures.yaml --set 'stages[1].measures={setle: {absent: true}}'
says err.txt "did you mean 'settle'?"
refused "another unit in one column" "'settle' was a number in 'm' in the stages before, and would be one in 'N'" measures.yaml --set 'stages[2].measures.settle={reaction: y, of: {boundary: floor}}'
refused "a tracer in a body that comes later" "no material carries the tracer" column.yaml --set 'bodies[1]={name: top, absent: true, shape: {box: {min: [3, 0], max: [4, 1]}}, material: soil}' --set 'measures.later={displacement: y, of: {tracer: [3.6, 0.3]}}'
says err.txt "in stage 'weight', where bodies that are absent carry nothing"
refused "a condition on what is gone" "there is no 'settle' in measures (stage 'dig')" measures.yaml --set 'stages[1].analysis={until: [{measure: settle, below: -1}]}'
refused "an interface that is gone" "the interface 'joint' between 'block' and 'base' is gone" slide.yaml --set 'stages[1].interfaces=[]' --set 'measures={}'
says err.txt "\`contact: bonded\` holds bodies together"
refused "a mistake in a stage" "(stage 'fill')" column.yaml --set 'stages[2].materials.loose.young=-1'
refused "a load on what is gone" "the load acts on 'top', which is not there (stage 'dig')" column.yaml --set 'loads.tractions=[{on: {body: top}, value: [0, -1]}]' \
  --set 'stages[1].strength={beyond_failure: 1}'
says err.txt "no search for a factor of safety comes before"
refused "no strength to divide" "has no strength that could be divided" column.yaml --set 'stages[3].bodies=[{name: column, material: gravel}]'
refused "a constant that is none" "the material 'soil' has no 'cohesoin' that could change with time (stage 'change')" ageing.yaml \
  --set 'stages[1].materials.soil.amplitude={cohesoin: [[0, 1]]}' --set 'stages[1].materials.fill.amplitude.density=[[0, 1], [1, 0]]'
says err.txt "did you mean 'cohesion'?" "density must be positive"
refused "a constant out of its range" "the dilatancy angle must not be larger than the friction angle" ageing.yaml --set 'stages[1].materials.soil.amplitude.friction_angle=[[0, 1], [1, 0.4]]'
says err.txt "so it is at t = 2 s, with its amplitudes"
refused "another mesh" "the grid of the case is not the one of the run, whose nodes carry the state of fem" later.yaml --set initial.run=fem1 --set method=fem --set grid.size=0.25
says err.txt "later.yaml:" "or let both be runs of mpm, whose points go onto any grid"
refused "cells too small" "farther than the cells are wide (0.125 m)" onto.yaml --set grid.size=0.125
refused "another method" "the state is one of method mpm, and cannot go on with fem" later.yaml --set initial.run=mpm1 --set method=fem
refused "no such stage" "has no stage 'did'" later.yaml --set initial.run=mpm1 --set initial.stage=did
says err.txt "did you mean 'dig'?"
refused "no run" "there is no run in" later.yaml --set initial.run=nowhere
refused "bodies of clouds" "'top' is gone: bodies of method gmm neither come nor go" cloud.yaml --set 'stages[1].bodies=[{name: top, absent: true}]' \
  --set 'stages[1].boundary=[{name: left, absent: true}]' --set 'stages[1].measures={later: {displacement: y, of: {tracer: [0.6, 1.9]}}}'
says err.txt "nodes of method gmm are held or free for good" "tracers of method gmm begin where the body does"
expect "other nodes of clouds" 1 "$talus" run cloud.yaml --out bad --quiet --set 'stages[1].boundary=[{name: left, on: {x: 0, y: [0, 1]}, fix: [x]}]'
says err.txt "nodes of method gmm are held or free for good, and these are others than before"
# A body that comes to stand on another one, which has settled by a hair since both were drawn: it stands there.
cat >comes.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [-0.5, 0], max: [3.5, 1.5]}, size: 0.125}
bodies:
  - {name: low, shape: {box: {min: [0, 0], max: [3, 0.5]}}, material: m}
  - {name: up, shape: {box: {min: [0.5, 0.5], max: [1.5, 1]}}, material: m, absent: true}
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
boundary: [{name: floor, on: {boundary: bottom}, fix: [x, y]}]
interfaces: [{name: i, between: [up, low], friction: 0.5}]
loads: {gravity: [0, -10]}
measures: {floor: {reaction: y, of: {boundary: floor}}, joint: {interface_force: y, of: {interface: i}}, area: {interface: area, of: {interface: i}}}
stages:
  - {name: one}
  - {name: two, bodies: [{name: up, absent: false}]}
END
for set in basis=null 'basis={cell: {}}' method=fem interfaces[0].contact=bonded materials.m.young=1e6; do
  own=grid.size=0.125
  [ "$set" != method=fem ] || own='grid.box={min: [0, 0], max: [3, 1]}'
  law=interfaces[0].name=i
  [ "$set" != interfaces[0].contact=bonded ] || law=interfaces[0].friction=null
  expect "comes to stand, $set" 0 "$talus" run comes.yaml --set "$set" --set "$own" --set "$law" --out comes --force --quiet
  awk -F, 'END { exit !(($4 - 20000) ^ 2 < 1 && ($5 - 5000) ^ 2 < 1 && $6 > 0.99 && $6 < 1.02) }' comes/history.csv || fail "$name: $(tail -n 1 comes/history.csv)"
done
# Two cells on three ranks, one of which has no nodes: a load that the second stage leaves out acts no more.
cat >drop.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static}
grid: {box: {min: [0, 0], max: [1, 2]}, size: 1}
bodies: [{name: l, shape: {box: {min: [0, 0], max: [1, 2]}}, material: a}]
materials: {a: {law: neo-hookean, density: 2000, young: 1e9, poisson: 0.3}}
boundary: [{name: base, on: {boundary: bottom}, fix: [x, y]}]
loads: {tractions: [{name: p, on: {body: l, y: 2}, value: [0, -1.5e4]}, {name: q, on: {body: l, y: 2}, value: [0, -2e4]}]}
measures: {R: {reaction: y, of: {boundary: base}}}
stages:
  - {name: both}
  - {name: one, loads: {tractions: [{name: q, on: {body: l, y: 2}, value: [0, -2e4]}]}}
END
expect "a load is left out" 0 on_ranks 3 timeout 60 "$talus" run drop.yaml --out drop --quiet
awk -F, 'END { exit !(($4 - 20000) ^ 2 < 1e-4) }' drop/history.csv || fail "$name: $(tail -n 1 drop/history.csv)"

# Windows count from the stage that brings their measure, and may lie in a later one.
cat >window.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 10}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: r}]
materials: {r: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: base, on: {boundary: bottom}, fix: [x, y]}]
loads: {tractions: [{name: t, on: {body: b, y: 1}, value: [0, -1000], amplitude: [[0, 0], [2, 2]]}]}
measures: {later: {reaction: y, of: {boundary: base}, mean: {window: [1.2, 1.8]}}}
stages:
  - {name: first}
  - {name: second, measures: {own: {reaction: y, of: {boundary: base}, mean: {window: [0.2, 0.8]}}}}
END
expect "windows" 0 "$talus" run window.yaml --out window --force --quiet
awk -F, 'END { exit !(($4 - 1500) ^ 2 < 1e-6 && ($5 - 1500) ^ 2 < 1e-6) }' window/history.csv || fail "$name: $(tail -n 1 window/history.csv)"
expect "a window when all is over" 2 "$talus" check window.yaml --set 'measures.later.mean.window=[2, 3]'
says err.txt "the window of 'later' begins when the run is over, 2 s after the stage began (stage 'first')"

# A complete run goes on to a later end of its last stage, as if it had been asked for at once; what says how stages are solved changes, too.
cat >longer.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [2, 2]}, size: 0.5}
bodies: [{name: b, shape: {box: {min: [0.5, 0], max: [1.5, 1]}}, material: r}]
materials: {r: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: base, on: {y: 0}, fix: [x, y]}]
loads: {gravity: [0, -9.81]}
measures: {tip: {displacement: x, of: {tracer: [1, 1]}}}
output: {fields: [displacement], history: {steps: 1}}
stages:
  - {name: weight}
  - {name: pull, analysis: {type: dynamic, end: 0.01, step: 0.005}, loads: {gravity: [2, -9.81]}}
  - {name: swing, analysis: {type: dynamic, end: 0.01, step: 0.005}, loads: {gravity: [0, -9.81]}}
END
expect "three stages" 0 "$talus" run longer.yaml --out short --quiet
expect "three stages, the last one longer" 0 "$talus" run longer.yaml --out long --quiet --set stages[2].analysis.end=0.02
expect "complete with its stages" 0 "$talus" run --resume short --quiet
says err.txt "is complete at t = 1.02 s: there is nothing left to do" "--set stages[2].analysis.end=..."
expect "a stage goes on" 0 "$talus" run --resume short --quiet --set stages[2].analysis.end=0.02
same_bits "$name" long short
expect "an earlier stage's end" 2 "$talus" run --resume short --quiet --set stages[1].analysis.end=0.02
says err.txt "stage 'pull' cannot get another end: those behind it begin there" "--set stages[2].analysis.end=..."
expect "an end that is over" 2 "$talus" run --resume short --quiet --set stages[2].analysis.end=0.01
says err.txt "has come to t = 1.03 s already, later than the end = 1.02 s"
expect "another tolerance" 0 "$talus" run --resume short --quiet --set stages[2].analysis.end=0.03 --set stages[2].newton.residual=1e-10
expect "other loads" 2 "$talus" run --resume short --quiet --set stages[2].loads.gravity=[0,0]
says err.txt "a resumed run cannot change stages[2].loads.gravity" "newton, linear, parallel, petsc" "analysis.until"

# A body that a stage brings is in no wall that stood before (it was squeezed out of it, without a word)
cat >amid.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, -0.5], max: [3, 2]}, size: 0.125}
bodies:
  - {name: first, shape: {box: {min: [0.25, 0], max: [1.25, 0.5]}}, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction: 0.5}
loads: {gravity: [0, -9.81]}
stages:
  - name: one
  - name: two
    bodies:
      - {name: second, shape: {box: {min: [1.75, -0.25], max: [2.25, 0.5]}}, points_per_cell: 4, material: rubber}
END
ranks=2
for method in mpm fem; do
  expect "a body amid a wall, $method, $ranks" 1 on_ranks $ranks "$talus" run amid.yaml --out amid --force --quiet --set method=$method
  says err.txt "wall 'floor' goes through a body at the start of the stage: the point at (" "m inside it (stage 'two')" \
    "amid.yaml:10:5: "
  ranks=3
done
sed 's/-0.25\], max: \[2.25/0], max: [2.25/' amid.yaml >beside.yaml
expect "a body on a wall" 0 "$talus" run beside.yaml --out amid --force --quiet

finish
