#!/bin/sh
# Exit codes that scripts go by, which of two options counts, and where a run goes that nobody told where.
. "$(dirname "$0")/library.sh"
mkdir beam
cantilever >beam/case.yaml

# The last of two options counts; folders are named after the case's, files after themselves
expect "two times --out" 0 "$talus" run beam/case.yaml --out one --out two --quiet
[ ! -e one ] && [ -s two/history.csv ] || fail "$name: it went to the first"
young=materials.rubber.young
expect "two times --set" 0 "$talus" run beam/case.yaml --out set --quiet --set $young=1e9 --set $young=180e6
says set/case.yaml "young: 1.8e+08"
expect "a folder's case" 0 "$talus" run beam/case.yaml --quiet
[ -s runs/beam/history.csv ] && [ ! -e runs/case ] || fail "$name: no runs/beam"
cp beam/case.yaml other.yaml
expect "a file's case" 0 "$talus" run other.yaml --quiet
[ -s runs/other/history.csv ] || fail "$name: no runs/other"

# check: mistakes in the case, in its mesh, in its regions
expect "check" 0 "$talus" check beam/case.yaml
expect "check of a wrong value" 2 "$talus" check beam/case.yaml --set materials.rubber.young=-1
expect "check of a body outside" 2 "$talus" check beam/case.yaml --set 'bodies[0].shape.box.min=[20, 0]' \
  --set 'bodies[0].shape.box.max=[28, 1]'
expect "check of a wrong boundary" 2 "$talus" check beam/case.yaml --set 'boundary[0].on={boundary: lefd}'
expect "check of two cases" 2 "$talus" check beam/case.yaml other.yaml
expect "one format, twice" 2 "$talus" plot nowhere --animate --format gif --out film.gif
lacks err.txt "is the format"
expect "two formats" 2 "$talus" plot nowhere --animate --format mp4 --out film.gif
says err.txt "the ending of 'film.gif' is the format"
expect "plot of two runs" 2 "$talus" plot two set three

# reference TIP [SETTING]: the beam's tip must be TIP
reference() {
  cat >beam/reference.yaml <<END
title: A beam
studies:
  tip:
    title: The tip
    measure: tip
    sweep: {name: cell size, symbol: h, unit: m, set: {grid.size: \$h}}
    series: {mpm: {set: {method: mpm$2}}}
    tolerance: 1e-6
    source: this program
    rows: [{at: 0.5, reference: $1}]
END
}
tip=$(tail -n 1 two/history.csv | cut -d, -f3)
reference "$tip"
expect "verify" 0 "$talus" verify beam --out right
expect "a run that is right" 0 "$talus" verify beam --run two
cp -r two older && sed '/^basis:/,/^  cell/d' two/case.yaml >older/case.yaml
expect "a run of a program that did not write its basis" 0 "$talus" verify beam --run older
reference -0.5
expect "verify what is off" 3 "$talus" verify beam --out off
expect "a run that is off" 3 "$talus" verify beam --run two
expect "a run of another case" 2 "$talus" verify beam --run set
reference "$tip" ", newton.max_iterations: 1, analysis.smallest: 0.6"
expect "verify what gives up" 1 "$talus" verify beam --out gave-up
reference "$tip" ", newton.max_iteration: 1"
expect "verify a wrong key" 2 "$talus" verify beam --out wrong

# Every value that a resumed run shall change is looked at, not the first alone
expect "a run to resume" 1 "$talus" run beam/case.yaml --out cut --quiet --set analysis.steps=2 \
  --set newton.max_iterations=1
expect "resume with another material" 2 "$talus" run --resume cut --quiet --set newton.max_iterations=20 \
  --set $young=1e6
says err.txt "a resumed run cannot change materials.rubber.young"
expect "resume with the material first" 2 "$talus" run --resume cut --quiet --set $young=1e6 \
  --set newton.max_iterations=20
expect "resume with a case" 2 "$talus" run beam/case.yaml --resume cut

# A run directory whose case was changed by hand is another run, whatever was changed of what is computed.
expect "a run with checkpoints" 0 "$talus" run beam/case.yaml --out kept --quiet --set analysis.steps=4 \
  --set checkpoint.steps=2
cp kept/case.yaml kept.yaml
for change in 's/-9.81/-9.8/' 's/young: .*/young: 9.1e7/' 's/density: .*/density: 1001/' \
  's/poisson: .*/poisson: 0.1/' 's/step: .*/step: 0.2/' \
  's/points_per_cell: 4/points_per_cell: 9/' 's/method: mpm/method: fem/'; do
  sed "$change" kept.yaml >kept/case.yaml
  cmp -s kept.yaml kept/case.yaml && fail "'$change' changes nothing"
  expect "resume after $change" 2 "$talus" run --resume kept --quiet
  says err.txt "it is of another case than the case.yaml beside it"
done

finish
