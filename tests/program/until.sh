#!/bin/sh
# Runs that end when something has happened: events are counted in a table, a resumed run has the same bits and does not run on.
. "$(dirname "$0")/library.sh"
# A block of rubber falls 2 cm onto a floor and bounces: fast, slow at the floor, fast upwards, slow at the top, ...
cat >bounce.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 1, step: 2e-3, until: [{measure: bounces, count: 3}, {measure: low, above: 1e9}]}
grid: {box: {min: [0, 0], max: [0.4, 0.4]}, size: 0.05}
bodies:
  - {name: block, shape: {box: {min: [0.1, 0.05], max: [0.3, 0.25]}}, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}
boundary:
  - {on: {boundary: bottom}, fix: [x, y]}
loads: {gravity: [0, -10]}
measures:
  kinetic: {energy: kinetic}
  bounces: {avalanches: {kinetic: 2, calm: 0.002}}
  low: {mass: total, in: {box: {min: [0, 0], max: [0.4, 0.1]}}}
  sinks: {mass: total, in: {box: {min: [0, 0], max: [0.4, 0.1]}}, rate: {window: 0.02}}
output: {every: 0.1}
END

# And resumed anywhere: the same bits, the same end
for ranks in 1 2; do
  expect "so many events on $ranks" 0 on_ranks $ranks "$talus" run bounce.yaml --out whole --force --set checkpoint.steps=20 --set checkpoint.keep=99
  says whole/log.txt "event = bounces 3: start = " "ended = bounces came to 3, at t = " "mean of 3 events of bounces: " "left <= "
  says whole/timings.txt "outcome = done" "ended = bounces came to 3"
  [ "$(wc -l <whole/events.csv)" -eq 4 ] || fail "$name: not three events"
  says whole/events.csv "measure,event,start [s],end [s],surface before [deg]" "bounces,3,"
  awk -F, 'NR > 1 && !($4 > $3 && $11 > 2 && $9 >= 0) { exit 1 }' whole/events.csv || fail "$name: events make no sense"
  awk -F, 'END { exit !($1 < 0.9 && $4 == 3) }' whole/history.csv || fail "$name: it ran on"
  cp -r whole cut
  ls cut/checkpoint_*.h5 | sed -n '3,$p' | xargs rm
  rm cut/timings.txt
  expect "resumed on $ranks" 0 on_ranks $ranks "$talus" run --resume cut --quiet
  for file in events.csv history.csv; do cmp -s whole/$file cut/$file || fail "$name: $file differs"; done
  rm -r cut
done

# What has ended has ended, until other conditions let it go on
expect "resumed at its end" 0 "$talus" run --resume whole
says err.txt "bounces came to 3: there is nothing left to do"
expect "and without conditions" 0 "$talus" run --resume whole --quiet --set 'analysis.until=[]' --set analysis.end=0.9
awk -F, 'END { exit !($1 == 0.9 && $4 > 3) }' whole/history.csv || fail "$name: it did not go on"

# Energy that has to fall first, and to stay
expect "at rest" 0 "$talus" run bounce.yaml --out rest --quiet --set analysis.damping=30 --set 'analysis.until=[{measure: kinetic, below: 1e-3, for: 0.03}]'
says rest/log.txt "ended = kinetic fell below 0.001 J for 0.03 s, at t = "
awk -F, 'NR > 1 { if ($3 >= 1e-3) last = $1; t = $1 } END { exit !(t - last > 0.03 - 1e-9 && t - last < 0.0361 && t < 0.9) }' rest/history.csv ||
  fail "$name: not 0.03 s"

# Statics: until the foot carries so much
sed -e 's/analysis: .*/analysis: {type: static, steps: 10, until: [{measure: weight, above: 210}]}/' -e 's/bounces: .*/weight: {reaction: y, of: {boundary: 0}}/' \
  -e 's/min: \[0.1, 0.05\]/min: [0.1, 0]/' bounce.yaml >static.yaml
expect "statics on 3" 0 on_ranks 3 "$talus" run static.yaml --out static --quiet
says static/log.txt "ended = weight rose above 210 N, at t = 0.5" # of 500 N at t = 1

# A step that goes past `after` may cross the value anywhere; what is above it before does not
for time in 0.45 0.55; do
  expect "after $time" 0 "$talus" run static.yaml --out after$time --quiet --set "analysis.until=[{measure: weight, above: 210, after: $time}]"
done
says after0.45/log.txt "ended = weight rose above 210 N, at t = 0.5"
lacks after0.55/log.txt "ended = "
finish
