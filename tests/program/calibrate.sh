#!/bin/sh
# Calibrations with known answers: two constants from two settlements, what is not determined, what cannot be, mistakes.
. "$(dirname "$0")/library.sh"
cat >oedometer.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies:
  - {name: block, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
boundary:
  - {name: floor, on: {boundary: bottom}, fix: [y]}
  - {name: left, on: {boundary: left}, fix: [x]}
  - {name: right, on: {boundary: right}, fix: [x]}
loads:
  tractions: [{on: {boundary: top}, value: [0, -100]}]
measures:
  top: {displacement: y, of: {tracer: [0.5, 1]}}
  floor: {reaction: y, of: {boundary: floor}}
END
sed '/name: right/d' oedometer.yaml >free.yaml

# Small strains: p H (1 + nu) (1 - 2 nu) / (E (1 - nu)) and p H (1 - nu^2) / E, for E = 1 MPa and nu = 0.3: 74.2857 and 91 micrometres
cat >block.yaml <<'END'
title: A block of rubber
parameters:
  E: {range: [0.5e6, 2e6], unit: Pa}
  nu: {range: [0.1, 0.45], label: Poisson's ratio}
set: {materials.rubber.young: $E, materials.rubber.poisson: $nu}
instruments:
  oedometer: {case: oedometer.yaml, measures: [{measure: top, times: -1e6, unit: um, target: 74.2857, uncertainty: 0.7}]}
  free: {case: free.yaml, measures: [{measure: top, times: -1e6, unit: um, target: 91, uncertainty: 0.9}]}
points: 10
rounds: 1
END
expect "two constants" 0 "$talus" calibrate block.yaml --out c
says out.txt "The run at the best point meets all targets" "report: c/report.md" "go together in it"
awk -F, 'NR > 1 {if ($1 < 0.96e6 || $1 > 1.04e6 || $2 < 0.27 || $2 > 0.33) bad = 1; if ($1 > 0.995e6 && $1 < 1.005e6 && $2 > 0.297 && $2 < 0.303) near = 1}
  END {exit bad || !near}' c/region.csv || fail "$name: the region is not about 1 MPa and 0.3"
[ "$(grep -c ',done$' c/runs.csv)" -eq "$(($(wc -l <c/runs.csv) - 1))" ] || fail "$name: not all are done"
if command -v gnuplot >/dev/null; then [ -s c/E-nu.png ] || fail "$name: no picture"; fi
sed 1d c/report.md >report.md
runs=$(find c -name history.csv -newer block.yaml | wc -l)
touch now
expect "again" 0 "$talus" calibrate block.yaml --out c
says out.txt "20 runs, 20 done before"
sed 1d c/report.md | cmp -s - report.md || fail "$name: another report"
[ "$(find c -name history.csv -newer now | wc -l)" -eq 0 ] || fail "$name: something was run again"
[ "$runs" -ge 20 ] || fail "$name: $runs runs"

# The force on the floor says nothing of the stiffness
cat >force.yaml <<'END'
title: A force
parameters: {E: {range: [0.5e6, 2e6], unit: Pa}, p: {range: [-300, -50], unit: Pa}}
set: {materials.rubber.young: $E}
instruments:
  free: {case: free.yaml, set: {"loads.tractions[0].value": "[0, $p]"}, measures: [{measure: floor, target: 120, uncertainty: 2}]}
points: 6
rounds: 0
END
sed -i 's/"\[0, $p\]"/[0, $p]/' force.yaml
expect "one is not determined" 0 "$talus" calibrate force.yaml --out f
grep -q "^| E | .* Pa | 500000 to 2e+06 | not determined |" f/report.md || fail "$name: E"
awk -F'[| ]+' '$2 == "p" && $3 > -122.5 && $3 < -121.5 && $5 > -118.5 && $5 < -117.5 {found = 1} END {exit !found}' f/report.md || fail "$name: p"
sed -i 's/target: 120/target: 500/' force.yaml
expect "none meets it" 3 "$talus" calibrate force.yaml --out f
says out.txt "There is no region"

# Out of reach: the nearest point is the softest that is looked at, with its own prediction, however far the target is
cat >far.yaml <<'END'
title: Out of reach
parameters: {E: {range: [0.5e6, 2e6], unit: Pa}}
set: {materials.rubber.young: $E}
instruments:
  free: {case: free.yaml, measures: [{measure: top, times: -1e6, unit: um, target: 600, uncertainty: 0.7}]}
points: 5
rounds: 2
batch: 2
END
expect "out of reach" 3 "$talus" calibrate far.yaml --out far
says out.txt "There is no region" "Nearest point: E = 500000 Pa"
grep -q "^| free top | 600 +- 0.7 | 18[12]" far/report.md || fail "$name: $(cat far/report.md)"

# Over two decades, by the logarithm: 91 +- 0.9 um in 0.990 to 1.010 MPa. And a range that is narrow beside its numbers: as many digits as tell them apart
sed -e 's/^title.*/title: Wide/' -e 's/\[0.5e6, 2e6\]/[0.05e6, 10e6]/' -e 's/target: 600, uncertainty: 0.7/target: 91, uncertainty: 0.9/' far.yaml >wide.yaml
expect "two decades" 0 "$talus" calibrate wide.yaml --out wide
awk -F'[| ]+' '$2 == "E" && $3 > 0.988e6 && $3 < 0.992e6 && $5 > 1.008e6 && $5 < 1.012e6 {found = 1} END {exit !found}' wide/report.md || fail "$name: $(cat wide/report.md)"
says out.txt "| 50000 to 1e+07, by the logarithm |" "of the points tried lie in it"
cat >narrow.yaml <<'END'
title: Narrow
parameters: {p: {range: [1000.0, 1000.2], unit: Pa}}
instruments:
  free: {case: free.yaml, set: {"loads.tractions[0].value": [0, $p]}, measures: [{measure: floor, target: -1000.123, uncertainty: 0.01}]}
points: 5
rounds: 0
END
expect "a narrow range" 0 "$talus" calibrate narrow.yaml --out narrow
says out.txt "| p | 1000.113 to 1000.133 Pa | 1000 to 1000.2 |" "| -1000.123 +- 0.01 | -1000.123 +- " " -1000.123 N |"
awk -F, 'NR > 1 && !seen[$1]++ {++n} END {exit n < 600}' narrow/region.csv || fail "$name: points of the region are the same"

# Regions that are narrow beside their range: 91.03 +- 0.03 um in 0.99926 to 0.99992 MPa, and 4.95 +- 0.3 um by 5.1 to 5.8 Pa, which is no end of the range
sed -e 's/^title.*/title: Thin/' -e 's/target: 600, uncertainty: 0.7/target: 91.03, uncertainty: 0.03/' -e 's/points: 5/points: 6/' far.yaml >thin.yaml
expect "a thin region" 0 "$talus" calibrate thin.yaml --out thin
says out.txt "The run at the best point meets all targets"
grep -q "^Best point: E = 999[4-7][0-9]0 Pa" thin/report.md || fail "$name: $(cat thin/report.md)"
cat >beside.yaml <<'END'
title: Beside the end
parameters: {p: {range: [-1000, -0.1], unit: Pa}}
instruments:
  free: {case: free.yaml, set: {"loads.tractions[0].value": [0, $p]}, measures: [{measure: top, times: -1e6, unit: um, target: 4.95, uncertainty: 0.3}]}
points: 5
rounds: 0
END
expect "beside the end of the range" 0 "$talus" calibrate beside.yaml --out beside
says out.txt "The run at the best point meets all targets"
! grep -q "not bounded" out.txt || fail "$name: $(cat out.txt)"

# A wave from five runs: what is predicted is not what is found, and that is said
sed 's/^  floor:.*/&\n  wave: {formula: sin(0.3 * floor)}/' free.yaml >wave-case.yaml
cat >wave.yaml <<'END'
title: A wave
parameters: {p: {range: [-103, -60], unit: Pa}}
instruments:
  free: {case: wave-case.yaml, set: {"loads.tractions[0].value": [0, $p]}, measures: [{measure: wave, target: 0.5, uncertainty: 1e-7}]}
points: 5
rounds: 0
END
expect "not confirmed" 3 "$talus" calibrate wave.yaml --out wave
says out.txt "What the predictions allow is not confirmed"

expect "not run" 0 "$talus" calibrate block.yaml --out dry --dry
says out.txt "10 sets of parameters, 20 runs, 0 done before"
[ ! -e dry ] || fail "$name: something was written"

# Mistakes
mistake() {
  message=$1
  shift
  sed "$@" block.yaml >bad.yaml
  expect "$message" 2 "$talus" calibrate bad.yaml --out bad
  says err.txt "$message"
}
mistake "the parameter nu changes nothing" -e 's/, materials.rubber.poisson: $nu//'
mistake "bad.yaml:5:31: error: there is no parameter 'mu'" -e 's/young: $E/young: $mu/'
mistake "key 'instrument' of the file is not known" -e 's/^instruments/instrument/'
mistake "did you mean 'young'?" -e 's/rubber.young/rubber.yung/'
mistake "bad.yaml:7:3: error: the case of oedometer/E=500000,nu=0.1 cannot be run" -e 's/rubber.young/rubber.yung/'
mistake "has no measure 'tip'" -e 's/measure: top/measure: tip/'
mistake "is empty" -e 's/\[0.1, 0.45\]/0.3/'
mistake "there is no such file" -e 's/oedometer.yaml/eodometer.yaml/'
mkdir foreign && echo mine >foreign/region.csv
expect "a foreign table" 2 "$talus" calibrate block.yaml --out foreign
says err.txt "that talus has not written"
expect "no file" 2 "$talus" calibrate nothing.yaml
says err.txt "nothing.yaml: error: there is no such file"
finish
