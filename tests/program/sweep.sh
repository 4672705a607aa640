#!/bin/sh
# Sweeps: members in processes of their own, one table, pictures; what is done is kept, what was cut off goes on, mistakes have their place.
. "$(dirname "$0")/library.sh"
cantilever >case.yaml

# A product: the rows of the table are the runs by hand
expect "a product" 0 "$talus" sweep case.yaml --over materials.rubber.young=60e6:90e6:30e6 --over grid.size=0.5,0.25 --measure tip --band 'measured=-0.7:-0.6' --measure weight --out s
says out.txt "4 members" "4 of 4" "table: s/sweep.csv"
[ "$(head -n 1 s/sweep.csv)" = "materials.rubber.young [Pa],grid.size [m],tip [m],weight [N],steps,iterations,halvings,seconds,ended,directory" ] || fail "$name: header"
[ "$(grep -c ',done,' s/sweep.csv)" -eq 4 ] || fail "$name: not all are done"
if command -v gnuplot >/dev/null; then [ -s s/tip.png ] && [ -s s/weight.png ] || fail "$name: no pictures"; fi
expect "by hand" 0 "$talus" run case.yaml --set materials.rubber.young=90e6 --set grid.size=0.5 --out hand --quiet
cmp -s hand/history.csv 's/young=90000000,size=0.5/history.csv' || fail "$name: another history"
tip=$(tail -n 1 hand/history.csv | cut -d, -f3)
grep -q "^90000000,0.5,$tip," s/sweep.csv || fail "$name: the table does not say $tip"

# Again: nothing is run; a changed case is in the way, unless by force; a foreign table stays
expect "again" 0 "$talus" sweep case.yaml --over materials.rubber.young=60e6:90e6:30e6 --over grid.size=0.5,0.25 --out s
says out.txt "4 done before"
expect "more values" 0 "$talus" sweep case.yaml --over materials.rubber.young=60e6:120e6:30e6 --over grid.size=0.5,0.25 --out s
says out.txt "6 members, 4 done before"
expect "another case" 2 "$talus" sweep case.yaml --over materials.rubber.young=60000000 --over grid.size=0.5 --set materials.rubber.density=900 --out s
says err.txt "holds a run of another case" "--force"
expect "by force" 0 "$talus" sweep case.yaml --over materials.rubber.young=60000000 --over grid.size=0.5 --set materials.rubber.density=900 --out s --force
mkdir foreign && echo mine >foreign/sweep.csv
expect "a foreign table" 2 "$talus" sweep case.yaml --over grid.size=0.5 --out foreign
says err.txt "that talus has not written"
[ "$(cat foreign/sweep.csv)" = mine ] || fail "$name: it is gone"

expect "compare members" 0 "$talus" compare s/young=60000000,size=0.5 s/young=90000000,size=0.5 --out compared
says out.txt " young=60000000 " " young=90000000"
expect "compare more members" 0 "$talus" compare s/young=60000000,size=0.5 s/young=60000000,size=0.25 s/young=90000000,size=0.5 --out compared
says out.txt " young=60000000,size=0.5 " " young=60000000,size=0.25 " " young=90000000,size=0.5"

# Pairs, words, members that give up
expect "pairs" 0 "$talus" sweep case.yaml --over grid.size=0.5,0.25 --along materials.rubber.young=60e6,90e6 --measure tip --out pairs
[ "$(wc -l <pairs/sweep.csv)" -eq 3 ] || fail "$name: not two members"
expect "words" 0 "$talus" sweep case.yaml --over method=mpm,fem --out words
says out.txt "no picture: the values of method are no numbers"
expect "words of one directory" 0 "$talus" sweep case.yaml --over 'title=a b,a_b,a/b' --measure tip --out alike
[ -s 'alike/title=a_b/history.csv' ] && [ -s 'alike/title=a_b-2/history.csv' ] && [ "$(grep -c ',done,' alike/sweep.csv)" -eq 3 ] || fail "$name: not three runs"
expect "one gives up" 1 "$talus" sweep case.yaml --over loads.gravity=[0,-9.81],[0,-98100] --measure tip --out up
says out.txt "gave up: the run gave up: "
says err.txt "1 of 2 members did not come to their end"
says up/sweep.csv ",done," ",gave up,"

# Interrupted members go on to the same bits; members do not outlive the sweep
block | sed 's/end: 0.4/end: 1.2/' >block.yaml
sweep_block() { "$talus" sweep block.yaml --over materials.rubber.young=2e5,3e5 --measure low:min --measure corner:mean:0:0.2 --jobs 2 --out b; }
wait_for_rows() {
  for i in $(seq 400); do
    [ -s b/young=3e5/history.csv ] && [ "$(wc -l <b/young=3e5/history.csv)" -gt 20 ] && return
    sleep 0.05
  done
  fail "$name: the members do not start"
}
name="Ctrl-C"
"$talus" sweep block.yaml --over materials.rubber.young=2e5,3e5 --measure low:min --jobs 2 --out b >out.txt 2>err.txt </dev/null &
sweep=$!
wait_for_rows
expect "two in one place" 2 "$talus" sweep block.yaml --over materials.rubber.young=2e5,3e5 --out b
says err.txt "another sweep is at work"
name="Ctrl-C"
kill -INT "$sweep"
wait "$sweep"
[ $? -eq 1 ] || fail "$name: exit code"
says b/sweep.csv ",interrupted,"
ls b/young=3e5/checkpoint_*.h5 >/dev/null || fail "$name: no checkpoint"
name="killed"
sweep_block >out.txt 2>err.txt </dev/null &
for i in $(seq 400); do # as soon as they run: on a quick machine they are soon done
  pgrep -f -- "--resume b/young" >/dev/null && break
  sleep 0.02
done
sweep=$(pgrep -P $! 2>/dev/null || echo $!)
kill -KILL $sweep 2>/dev/null
wait 2>/dev/null
for i in $(seq 100); do
  pgrep -f -- "--resume b/young" >/dev/null || break
  sleep 0.1
done
if pgrep -f -- "--resume b/young" >/dev/null; then fail "$name: members go on without the sweep"; fi
name="killed at first"
"$talus" sweep block.yaml --over materials.rubber.young=2e5,3e5 --set analysis.end=1000 --measure low --jobs 2 --out k >out.txt 2>err.txt </dev/null &
sweep=$!
for i in $(seq 400); do
  [ "$(cat k/young=2e5/history.csv 2>/dev/null | wc -l)" -gt 50 ] && [ "$(cat k/young=3e5/history.csv 2>/dev/null | wc -l)" -gt 50 ] && break
  sleep 0.05
done
kill -KILL "$sweep"
wait 2>/dev/null
for i in $(seq 100); do
  pgrep -f -- "--out k/young" >/dev/null || break
  sleep 0.1
done
ls k/young=2e5/checkpoint_*.h5 k/young=3e5/checkpoint_*.h5 >/dev/null || fail "$name: a member without a checkpoint"
expect "goes on" 0 sweep_block
says out.txt "to go on from their checkpoints"
expect "in one go" 0 "$talus" run block.yaml --set materials.rubber.young=3e5 --out whole --quiet
cmp -s whole/history.csv b/young=3e5/history.csv || fail "$name: not the same bits"
low=$(tail -n +2 whole/history.csv | cut -d, -f4 | sort -g | head -n 1)
grep -q "^3e5,$low," b/sweep.csv || fail "$name: the least is $low"

# Several windows of one measure have them in their names, and a measure that is alone has none
expect "windows" 0 "$talus" sweep case.yaml --over grid.size=0.5,0.25 --measure tip:mean:0:0.5 --measure tip:mean:0.5:1 --measure tip:max:0.5:1 --out windows
says windows/sweep.csv "grid.size [m],tip mean 0 to 0.5 s [m],tip mean 0.5 to 1 s [m],tip max [m],steps"
# One step: a line from 0 at 0 s to the tip's value T at 1 s, so T / 4, 3 T / 4, and T / 2 as largest (T < 0)
awk -F, 'function off(a, b) {return (a - b) ^ 2 > 1e-20 * b ^ 2} NR > 1 && (off($2, $4 / 2) || off($3, 1.5 * $4)) {bad = 1} END {exit bad}' windows/sweep.csv || fail "$name: $(cat windows/sweep.csv)"
expect "a window beyond the end" 0 "$talus" sweep case.yaml --over grid.size=0.5 --measure tip:mean:0.5:2 --out beyond
says err.txt "warning: 'tip mean' of size=0.5: its window, 0.5 to 2 s, reaches beyond the history: taken from 0.5 to 1 s alone"
expect "a slope of one row" 1 "$talus" sweep case.yaml --over grid.size=0.5,0.25 --measure tip:slope:0.5:1 --out slope
says err.txt "error: 'tip slope' of size=0.5 (and 1 more): a slope needs two rows of the history, and from 0.5 to 1 s there is less"
if command -v gnuplot >/dev/null; then
  for picture in tip-mean-0-to-0.5-s tip-mean-0.5-to-1-s tip-max; do [ -s windows/$picture.png ] || fail "$name: no $picture.png"; done
fi

# Sweeps by name
cat >sweep.yaml <<'END'
title: Beams
sweeps:
  - name: fig-1.1
    title: How far the tip comes down
    set: {materials.rubber.density: 1100}
    quick: {grid.size: 0.5}
    over:
      - {key: materials.rubber.young, values: 60e6:90e6:10e6, quick: [60e6, 90e6], label: E}
      - key: materials.rubber.poisson
        values: [0, 0.3]
        along: [{key: grid.cell, values: [quadrilateral, quadrilateral]}]
    measures:
      - {measure: tip, take: min, times: -1000, unit: mm, label: sag, bands: [{name: measured, between: [600, 700]}]}
END
expect "by name" 0 "$talus" sweep . --name fig-1.1 --quick --out named
says out.txt "How far the tip comes down: 4 members" "tip min = " " mm"
says named/sweep.csv "tip min [mm]"
expect "not run" 0 "$talus" sweep . --name fig-1.1 --dry
says out.txt "8 members" "young=70000000,poisson=0.3,cell=quadrilateral"
[ ! -e runs ] || fail "$name: something was written"
expect "another name" 2 "$talus" sweep . --name fig-1.2
says err.txt "did you mean 'fig-1.1'"
expect "no name" 2 "$talus" sweep .
says err.txt "--name chooses one" "fig-1.1"
sed -i 's/60e6:90e6:10e6/60e6:90e6:-10e6/' sweep.yaml
expect "a range without an end" 2 "$talus" sweep . --name fig-1.1
says err.txt "sweep.yaml:8:9: error: the range 60e6:90e6:-10e6 does not end"
sed -i 's/label: E/lable: E/' sweep.yaml
expect "a key" 2 "$talus" sweep . --name fig-1.1
says err.txt "did you mean 'label'"
sed -i 's/lable: E/label: E/; s/fig-1.1/..\/..\/away/' sweep.yaml
expect "a name that leads away" 2 "$talus" sweep . --name ../../away
says err.txt "the name of a sweep is that of a folder"

# Mistakes on the command line
mistake() {
  message=$1
  shift
  expect "$message" 2 "$talus" sweep case.yaml "$@"
  says err.txt "$message"
}
mistake "--set materials.rubber.yung=1: error: key 'yung' of materials.rubber is not known" --over materials.rubber.yung=1,2
mistake "did you mean 'young'?" --over materials.rubber.yung=1,2
mistake "--over materials.rubber.young=1:3:-1: error: the range 1:3:-1 does not end" --over materials.rubber.young=1:3:-1
mistake "has more than 10000 values" --over grid.size=0:1:1e-9
mistake "the sweep would have 1e+06 members" --over grid.size=1:1000:1 --over materials.rubber.young=1:1000:1
mistake "the value 2 of grid.size stands there twice" --over grid.size=1,2,2
mistake "grid.size is varied twice" --over grid.size=1,2 --over grid.size=3
mistake "case.yaml has no measure 'tup'" --over grid.size=0.5 --measure tup
mistake "has 3 values, grid.size along which it varies has 2" --over grid.size=0.5,1 --along materials.rubber.young=1,2,3
mistake "this is no NAME=lowest:highest" --over grid.size=0.5 --measure tip --band x=3:1
mistake "there is no --measure before it" --over grid.size=0.5 --band x=1:3
mistake "the window of 'tip' begins at 5 s, when the run is over" --over grid.size=0.5 --measure tip:mean:5:6
mistake "--jobs is a number" --over grid.size=0.5 --jobs many
mistake "--quick is told by a sweep" --over grid.size=0.5 --quick
finish
