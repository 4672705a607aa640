#!/bin/sh
# Rows and states come at the times that the case asks for, neither a step late nor twice nor from a step of nothing
# that round-off asks for: in one go, and after a resumption between two of them.
. "$(dirname "$0")/library.sh"

# slider STEP EVERY HISTORY: a block that slides for 1.2 s; nothing acts on it.
slider() {
  cat <<END
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, step: $1, end: 1.2}
grid: {box: {min: [0, 0], max: [3, 1]}, size: 0.5}
bodies:
  - {name: block, shape: {box: {min: [0, 0], max: [1, 0.5]}}, points_per_cell: 4, material: rubber, velocity: [1, 0]}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
measures:
  place: {extent: {max: x}, of: {body: block}}
output: {every: $2, history: $3}
END
}

# multiples NAME DIR EVERY HISTORY: rows at multiples of HISTORY, states at those of EVERY, up to 1.2 s; each once.
multiples() {
  awk -F , -v every="$4" 'NR > 1 && ($1 - (NR - 2) * every > 1e-9 || (NR - 2) * every - $1 > 1e-9) {bad = 1}
    END {exit bad || NR - 2 != int(1.2 / every + 0.5)}' "$2/history.csv" ||
    fail "$1: rows at $(cut -d, -f1 "$2/history.csv" | tr '\n' ' ')"
  sed -n 's/.*"name": "\([^"]*\)".*"time": \([^ }]*\).*/\2/p' "$2/points.hdf.series" >times.txt
  awk -v every="$3" '{if ($1 - (NR - 1) * every > 1e-9 || (NR - 1) * every - $1 > 1e-9) bad = 1}
    END {exit bad || NR - 1 != int(1.2 / every + 0.5)}' times.txt || fail "$1: states at $(tr '\n' ' ' <times.txt)"
}

for step in 0.02 0.03 0.04 0.1; do
  slider $step 0.2 0.1 >case.yaml
  expect "steps of $step" 0 "$talus" run case.yaml --out run --force --quiet
  multiples "$name" run 0.2 0.1
done

# As many steps as there must be: none is a sliver that rounding left over
slider 0.01 0.2 0.1 >case.yaml
expect "no slivers" 0 "$talus" run case.yaml --out whole --quiet --set checkpoint.steps=7 --set checkpoint.keep=100
steps=$(tail -n 1 whole/history.csv | cut -d, -f2)
[ "$steps" = 120 ] || fail "$name: $steps steps, not 120"
multiples "$name" whole 0.2 0.1

# Resumed between two rows, at a row, at a state
for last in 63 70 98; do
  cp -r whole cut
  for file in cut/checkpoint_*.h5; do
    [ "$(basename "$file" .h5 | sed 's/checkpoint_0*//')" -le $last ] || rm "$file"
  done
  expect "resumed at step $last" 0 "$talus" run --resume cut --quiet
  multiples "$name" cut 0.2 0.1
  cmp -s whole/history.csv cut/history.csv || fail "$name: another history"
  [ "$(ls whole/*.hdf | wc -l)" -eq "$(ls cut/*.hdf | wc -l)" ] || fail "$name: $(ls cut/*.hdf | wc -l) states"
  rm -r cut
done

# Resumed where nothing is left to do, whatever is said then: no row and no state comes twice
cp -r whole again
name="resumed at the end"
"$talus" run --resume again --quiet >out.txt 2>err.txt
multiples "$name" again 0.2 0.1
cmp -s whole/history.csv again/history.csv || fail "$name: another history"
[ "$(ls whole/*.hdf | wc -l)" -eq "$(ls again/*.hdf | wc -l)" ] || fail "$name: $(ls again/*.hdf | wc -l) states"

# Rows and states by steps
slider 0.05 '{steps: 6}' '{steps: 4}' >case.yaml
expect "by steps" 0 "$talus" run case.yaml --out steps --quiet
[ "$(cut -d, -f2 steps/history.csv | tr '\n' ' ')" = 'step 0 4 8 12 16 20 24 ' ] || fail "$name: rows"
[ "$(grep -c '"name"' steps/points.hdf.series)" -eq 5 ] || fail "$name: states"

# Statics of which steps are halved: they come back to the thirty times that were asked for, and the peak is one of them
cat >peak.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, end: 3, steps: 30}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}]
materials: {m: {law: mohr-coulomb, density: 1000, young: 5e7, poisson: 0.25, friction_angle: 35, cohesion: 2e4, dilatancy_angle: 0}}
formulation: displacement
boundary:
  - {on: {x: 0}, fix: [x]}
  - {on: {y: 0}, fix: [y]}
  - {name: t, on: {y: 1}, displacement: {y: 0.01}, amplitude: [[0, 0], [1, 1], [2, -1]]}
measures: {R: {reaction: y, of: {boundary: t}}}
output: {every: end}
END
# On one rank with a checkpoint of every step, to go on from below.
for ranks in 2 1; do
  expect "a peak on $ranks" 0 on_ranks $ranks "$talus" run peak.yaml --out peak --force --quiet --set checkpoint.steps=$((ranks * ranks)) --set checkpoint.keep=99
  lacks peak/log.txt "halvings = 0"
  awk -F, 'NR > 1 { k = int($1 * 10 + 0.5); if (($1 * 10 - k) ^ 2 < 1e-16) { if (k != before + (NR > 2)) exit 1; before = k } } END { exit before != 30 }' \
    peak/history.csv || fail "$name: $(cut -d, -f1 peak/history.csv | tr '\n' ' ')"
done
# So do those that end where an output is due.
expect "a peak beside outputs" 0 "$talus" run peak.yaml --out beside --force --quiet --set materials.m.cohesion=1e9 --set output.every=0.35
awk -F, 'NR > 1 { k = int($1 * 10 + 0.5); n += ($1 * 10 - k) ^ 2 < 1e-16 } END { exit n != 31 || NR < 36 }' beside/history.csv ||
  fail "$name: $(cut -d, -f1 beside/history.csv | tr '\n' ' ')"
cp -r peak cut
ls cut/checkpoint_*.h5 | sed -n '9,$p' | xargs rm
rm cut/timings.txt
expect "a peak, resumed" 0 "$talus" run --resume cut --quiet
cmp -s peak/history.csv cut/history.csv || fail "$name: another history"

# Steps that may grow go over no pulse: the free square has all of its impulse, 1 kN for 0.1 s, whatever rests before.
cat >pulse.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 1, step: 0.01, largest: 0.4}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
loads: {tractions: [{on: {x: 1}, value: [1000, 0], amplitude: [[0, 0], [0.5, 0], [0.53, 1], [0.6, 1], [0.63, 0]]}]}
measures: {p: {momentum: x}}
output: {every: end}
END
for ranks in 3 1; do
  expect "a pulse on $ranks" 0 on_ranks $ranks "$talus" run pulse.yaml --out pulse --force --quiet --set checkpoint.steps=$((ranks * ranks)) --set checkpoint.keep=99
  lacks err.txt warning
  awk -F, 'END { exit ($3 - 100) ^ 2 > 1e-8 || $2 > 25 }' pulse/history.csv || fail "$name: $(tail -n 1 pulse/history.csv)"
done
cp -r pulse pulse_cut
ls pulse_cut/checkpoint_*.h5 | sed -n '9,$p' | xargs rm
rm pulse_cut/timings.txt
expect "a pulse, resumed" 0 "$talus" run --resume pulse_cut --quiet
cmp -s pulse/history.csv pulse_cut/history.csv || fail "$name: another history"
# A formula of t may turn anywhere: no step over it is longer than `step`; names that only have a t in them are none of t
expect "a pulse by a formula" 0 "$talus" run pulse.yaml --out formula --quiet \
  --set 'loads.tractions[0]={on: {x: 1}, value: [1000, 0], factor: "max(0, 1 - abs(t - 0.55) / 0.1)"}'
says err.txt "analysis.largest has no effect here: the \`factor\` of a load is a formula of t"
awk -F, 'END { exit ($3 - 100) ^ 2 > 1e-8 || $2 != 100 }' formula/history.csv || fail "$name: $(tail -n 1 formula/history.csv)"
expect "a pulse over places" 0 "$talus" run pulse.yaml --out places --quiet --set 'loads.tractions[0].factor="sqrt(1) + tan(0 * y)"'
lacks err.txt warning
awk -F, 'END { exit ($3 - 100) ^ 2 > 1e-8 || $2 > 25 }' places/history.csv || fail "$name: $(tail -n 1 places/history.csv)"
# So do they with factors on a material, and with the peak of a load of statics.
expect "a softer square" 0 "$talus" run pulse.yaml --out soft --quiet --set 'materials.m.amplitude={young: [[0, 1], [0.7, 1], [0.8, 0.5], [0.804, 0.52], [0.808, 0.5]]}'
awk -F, '{ n += ($1 - 0.7) ^ 2 < 1e-16; m += ($1 - 0.8) ^ 2 < 1e-16 } END { exit n != 1 || m != 1 }' soft/history.csv ||
  fail "$name: $(cut -d, -f1 soft/history.csv | tr '\n' ' ')"
awk -F, 'NR > 2 && $1 - t < 0.00999 { exit 1 } { t = $1 }' soft/history.csv || fail "$name: a step shorter than asked for"
expect "a peak in long steps" 0 "$talus" run peak.yaml --out long --quiet --set materials.m.cohesion=1e9 --set analysis.largest=2
awk -F, '{ n += ($1 - 1) ^ 2 < 1e-16; m += ($1 - 2) ^ 2 < 1e-16 } END { exit n != 1 || m != 1 || NR > 12 }' long/history.csv ||
  fail "$name: $(cut -d, -f1 long/history.csv | tr '\n' ' ')"
# Where steps may grow those of `step` end at peaks of places, too: there lay two within one, of which the first was within its ends
expect "two peaks" 0 "$talus" run peak.yaml --out met --quiet --set materials.m.cohesion=1e9 --set analysis.largest=0.2 \
  --set 'boundary[2].amplitude=[[0, 0], [1, 0], [1.01, 0.5], [1.02, -0.5], [1.05, 1], [3, 1]]'
lacks err.txt "and back within"
awk -F, '{ n += ($1 - 1.01) ^ 2 < 1e-16; m += ($1 - 1.02) ^ 2 < 1e-16 } END { exit n != 1 || m != 1 || NR > 40 }' met/history.csv ||
  fail "$name: $(cut -d, -f1 met/history.csv | tr '\n' ' ')"

# The last of so many equal steps ends at the end: ten tenths sum up to 0.9999999999999999
for steps in 10 49; do
  expect "the end of $steps steps" 0 "$talus" run peak.yaml --out equal --force --quiet --set materials.m.cohesion=1e9 --set analysis.end=1 --set analysis.steps=$steps --set output.every=2
  [ "$(tail -n 1 equal/history.csv | cut -d, -f1)" = 1 ] || fail "$name: $(tail -n 1 equal/history.csv)"
done
# What is a mean over a step is that since the row before where rows are few: a row times the time since then is the impulse,
# as that of all steps is, and a sweep's mean of it is that of the run
bounce() {
  cat <<END
kinematics: plane-strain
method: mpm
analysis: {type: $1, end: 0.11, step: 2e-3}
grid: {box: {min: [0, 0], max: [2, 2]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m, velocity: [0, -2]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: side, on: {x: 0}, fix: [x]}]
walls: [{name: floor, shape: {half-space: {point: [0, -0.02], normal: [0, 1]}}}]
measures:
  f: {wall_force: y, of: {wall: floor}}
  side: {reaction: x, of: {boundary: side}}
  both: {formula: 2 * f - side}
  low: {extent: {min: y}}
  mean: {formula: 2 * f - side, mean: {window: [0, 0.11]}}
  ratio: {formula: f / side}
END
}
measured() { grep -E '^(f|side|both|ratio) = ' "$1/log.txt"; }
impulse() { awk -F, -v k="$2" 'NR > 2 {sum += ($1 - t) * $k} {t = $1} END {printf "%.9g\n", sum}' "$1/history.csv"; }
few_rows() {
  expect "$1, rows $2, on $ranks" 0 on_ranks $ranks "$talus" run bounce.yaml --out few --force --quiet --set "output.history=$2" --set checkpoint.steps=5 --set checkpoint.keep=99
  for column in 3 4 5; do
    awk -v a="$(impulse all $column)" -v b="$(impulse few $column)" 'BEGIN {d = a - b; exit !(a * a > 1 && d * d < 1e-14 * a * a)}' ||
      fail "$name: column $column has $(impulse few $column), every step $(impulse all $column)"
  done
  awk -F, 'NR > 2 && $4 != 0 {++n; d = $8 * $4 - $3; if (!(d * d <= 1e-20 * $3 * $3)) bad = 1} END {exit bad || !n}' few/history.csv ||
    fail "$name: a formula is not that of its row"
  [ "$(measured few)" = "$(measured all)" ] || fail "$name: it ends with $(measured few), every step with $(measured all)"
  [ "$(tail -n 1 few/history.csv | cut -d, -f6)" = "$(tail -n 1 all/history.csv | cut -d, -f6)" ] || fail "$name: what is no mean"
  rm -rf cut && cp -r few cut
  ls cut/checkpoint_*.h5 | sed -n '6,$p' | xargs rm
  rm cut/timings.txt
  expect "$1, rows $2, resumed on $ranks" 0 on_ranks $ranks "$talus" run --resume cut --quiet
  cmp -s few/history.csv cut/history.csv || fail "$name: another history"
}
ranks=1
for type in dynamic explicit; do
  bounce $type >bounce.yaml
  expect "$type, every row" 0 on_ranks $ranks "$talus" run bounce.yaml --out all --force --quiet
  if [ $type = dynamic ]; then
    few_rows $type '{steps: 4}'
    # the same solution, whatever rows it has
    expect "$type, few rows beside all" 0 "$talus" compare all few --measure f --measure both --measure ratio --tolerance 1e-12 --out compared
  fi
  few_rows $type end
  ranks=2
done
bounce dynamic >bounce.yaml
expect "means of a sweep" 0 "$talus" sweep bounce.yaml --over 'output.history={steps: 1},end' --measure both:mean --measure mean --measure side --out swept
awk -F, 'NR == 2 {end = $4} NR > 1 {d = $2 - $3; if (!($2 * $2 > 1 && d * d < 1e-20 * $2 * $2) || $4 != end) bad = 1}
  END {exit bad || NR != 3}' swept/sweep.csv || fail "$name: $(cat swept/sweep.csv)"

# What a run ends with is of its last step, whatever mean its last row has; so is what is judged of it.
mkdir judged
cp bounce.yaml judged/case.yaml
cat >judged/reference.yaml <<END
title: What is judged
studies:
  side:
    title: The side
    measure: side
    sweep: {name: step, symbol: dt, unit: s, set: {analysis.step: \$dt}}
    series: {mpm: {}}
    tolerance: 1e-6
    source: every step
    confidence: verified
    rows: [{at: 2e-3, reference: $(sed -n 's/^side = \([^ ]*\).*/\1/p' swept/*1*/log.txt | tail -n 1)}]
END
expect "one row" 0 "$talus" run bounce.yaml --out one_row --set output.history=end
expect "one row judged" 0 "$talus" verify judged --run one_row
expect "until a force" 0 "$talus" run bounce.yaml --out until --set output.history=end --set 'analysis.until=[{measure: f, above: 15000}]'
says err.txt "its row at the end has of 'f' the mean over all steps"
says until/log.txt 'ended = f rose above 15000 N'
awk '/^f = / {last = $3} END {exit !(last > 15000)}' until/log.txt || fail "$name: $(measured until)"

# A state, a row or a wall that vanishes at an odd time changes nothing of what bounces and rubs on a wall: no step is
# much shorter than those beside it, or what that finds at light nodes and walls the next one takes for their motion.
cat >bounce.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.4, step: 2e-3}
grid: {box: {min: [0, 0], max: [3, 2]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0.5, 0.06], max: [1.5, 1.06]}}, points_per_cell: 4, material: r, velocity: [0.5, -1]}]
materials: {r: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction: 0.3}
  - {name: away, shape: {half-space: {point: [2.9, 0], normal: [-1, 0]}}}
loads: {gravity: [0, -9.81]}
measures: {energy: {energy: mechanical}}
output: {every: end}
END
expect "bounce" 0 "$talus" run bounce.yaml --out bounce --quiet
right=$(tail -n 1 bounce/history.csv | cut -d, -f3)
# bounces NAME STEPS SET..: after so many steps it has the same energy, within 1 %
bounces() {
  name=$1 most=$2
  shift 2
  expect "$name" 0 on_ranks $ranks "$talus" run bounce.yaml --out bounced --force --quiet "$@"
  tail -n 1 bounced/history.csv | awk -F , -v right="$right" -v most="$most" \
    '{exit !($2 == most && ($3 / right - 1)^2 < 1e-4)}' || fail "$name: $(tail -n 1 bounced/history.csv), not $right J"
}
ranks=1
bounces "states a little late" 200 --set output.every=0.0500005
ranks=2
bounces "no step of nothing" 200 --set output.history=0.1 --set walls[1].until=0.10000001
expect "two steps for what is left" 0 "$talus" run bounce.yaml --out halves --quiet --set analysis.end=0.1 --set output.history=0.011
awk -F , 'NR > 2 && $2 - last != 6 && $1 < 0.1 {bad = 1} {last = $2} END {exit bad || NR != 12}' halves/history.csv ||
  fail "$name: $(cut -d, -f1,2 halves/history.csv | tr '\n' ' ')"

# Where one must be that short, since walls vanish one after the other, walls press what is too deep no harder for it
cat >column.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.21, step: 2e-3}
grid: {box: {min: [0, -0.0125], max: [0.5, 0.3]}, size: 0.0125, outside: remove}
bodies: [{name: sand, shape: {box: {min: [0, 0], max: [0.1, 0.2]}}, points_per_cell: 4, material: sand, k0: 0.5}]
materials: {sand: {law: mohr-coulomb, density: 1600, young: 1e6, poisson: 0.3, friction_angle: 31, cohesion: 0}}
boundary: [{on: {boundary: left}, fix: [x]}]
walls:
  - {name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction_angle: 31}
  - {name: away, shape: {half-space: {point: [0.5, 0], normal: [-1, 0]}}, until: 0.200001}
  - {name: also, shape: {half-space: {point: [0.5, 0], normal: [-1, 0]}}, until: 0.2}
loads: {gravity: [0, -9.81]}
measures: {transfer: {energy: transfer}, borne: {wall_force: y, of: {wall: floor}}}
output: {every: end}
END
expect "a step of a microsecond" 0 "$talus" run column.yaml --out column --quiet
awk -F , 'NR > 1 && $3 < -0.05 {bad = 1} END {exit bad || $2 != 106}' column/history.csv ||
  fail "$name: $(tail -n 3 column/history.csv | tr '\n' ' ')"

# States that are due just before the run ends, or a wall comes, and rows just beside states, come with these: the last
# force is that of a step
expect "the last of 30 a second" 0 "$talus" run column.yaml --out thirty --quiet --set analysis.end=0.1 --set output.every=0.0333333
awk -F , '{before = last; last = $4} END {exit !($2 == 51 && last / before < 1.05 && last / before > 0.95)}' thirty/history.csv ||
  fail "$name: $(tail -n 3 thirty/history.csv | tr '\n' ' ')"
[ "$(grep -c '"time"' thirty/points.hdf.series)" -eq 4 ] || fail "$name: $(cat thirty/points.hdf.series)"
expect "rows beside states" 0 "$talus" run bounce.yaml --out rows_beside --quiet --set output.every=0.1 --set output.history=0.0200001 \
  --set walls[1].until=0.2000004 --set analysis.end=0.3
[ "$(tail -n 1 rows_beside/history.csv | cut -d, -f2)" -eq 150 ] && [ "$(wc -l <rows_beside/history.csv)" -eq 17 ] ||
  fail "$name: $(cut -d, -f1,2 rows_beside/history.csv | tr '\n' ' ')"

finish
