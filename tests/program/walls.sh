#!/bin/sh
# Cases with walls leave their walls and what touches them beside the states: from the start to the end, after a
# resumption too, on 1, 2 and 3 ranks; and the pressure along a wall becomes a table.
. "$(dirname "$0")/library.sh"

cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, step: 0.01, end: 0.2, damping: 20}
grid: {box: {min: [0, 0], max: [2, 1]}, size: 0.125}
bodies:
  - {name: block, shape: {box: {min: [0.5, 0.25], max: [1.5, 0.75]}}, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0.25], normal: [0, 1]}}, friction: 0.5}
  - {name: gate, shape: {box: {min: [1.7, 0.25], max: [1.8, 1]}}, until: 0.125}
loads: {gravity: [0, -9.81]}
measures:
  pressure: {contact: pressure, of: {wall: floor}}
  force: {wall_force: y, of: {wall: floor}}
output: {every: 0.05}
END

expect "whole" 0 "$talus" run case.yaml --out whole --quiet --set checkpoint.steps=7 --set checkpoint.keep=100
for kind in points walls contact; do
  [ "$(ls whole/${kind}_*.hdf | wc -l)" -eq 5 ] || fail "$name: $(ls whole/${kind}_*.hdf | wc -l) files of $kind"
  [ "$(grep -c '"time"' whole/$kind.hdf.series)" -eq 5 ] || fail "$name: another series of $kind"
done
awk -F, '$1 > 0.1249 && $1 < 0.1251 {found = 1} END {exit !found}' whole/history.csv || fail "$name: no step ends at 0.125 s"

cp -r whole cut
rm cut/checkpoint_0000000[12]*.h5 cut/timings.txt
expect "resumed" 0 "$talus" run --resume cut --quiet
cmp -s whole/history.csv cut/history.csv || fail "$name: another history"
for kind in walls contact; do
  for file in whole/${kind}_*.hdf; do
    cmp -s "$file" "cut/$(basename "$file")" || fail "$name: $(basename "$file") differs"
  done
  cmp -s whole/$kind.hdf.series cut/$kind.hdf.series || fail "$name: another series of $kind"
done

# A run that is complete goes on with nothing: what touched its walls at the end stays
expect "at its end" 0 "$talus" run case.yaml --out ended --quiet --set output.every=end
cp -r ended again
expect "complete" 0 "$talus" run --resume again --quiet
for file in ended/*.hdf ended/contact.hdf.series; do
  cmp -s "$file" "again/$(basename "$file")" || fail "$name: $(basename "$file") differs"
done

for ranks in 2 3; do
  expect "$ranks ranks" 0 on_ranks $ranks "$talus" run case.yaml --out ranks --force --quiet
  [ "$(ls ranks/contact_*.hdf | wc -l)" -eq 5 ] || fail "$name: files of contact"
  expect "$ranks ranks, profile" 0 "$talus" plot ranks --profile floor
  [ "$(wc -l <ranks/pictures/profile_floor.csv)" -eq 17 ] || fail "$name: $(wc -l <ranks/pictures/profile_floor.csv) lines"
done

# The weight of 500 kg over 1 m; the block still breathes a little
expect "profile" 0 "$talus" plot whole --profile floor
awk -F, 'NR > 1 {n++; sum += $4; if ($1 < last) bad = 1; last = $1} END {exit bad || n != 16 || sum / n < 4500 || sum / n > 5300}' \
  whole/pictures/profile_floor.csv || fail "$name: $(cat whole/pictures/profile_floor.csv)"
[ -s whole/pictures/profile_floor.png ] || fail "$name: no picture"
expect "no such wall" 2 "$talus" plot whole --profile flor
says err.txt "the run 'whole' has no wall 'flor'" "did you mean 'floor'?"
expect "nothing touches" 2 "$talus" plot whole --profile gate
says err.txt "nothing touches the wall 'gate'"
expect "without" 0 "$talus" run case.yaml --out without --quiet --set output.walls=false
[ ! -e without/walls.hdf.series ] && [ ! -e without/contact.hdf.series ] || fail "$name: files of walls"
expect "no profile" 2 "$talus" plot without --profile floor
says err.txt "no contact.hdf.series"

# With pressures as unknowns the account of a body on a wall closes, in one step and in several.
cat >pressed.yaml <<'END'
kinematics: plane-strain
method: fem
formulation: mixed
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.25}
bodies: [{name: block, shape: {box: {min: [0, 0], max: [1, 1]}}, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls: [{name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, contact: bonded}]
loads: {gravity: [0, -10]}
measures: {transfer: {energy: transfer}, balance: {energy: balance}}
END
for steps in 1 3; do
  expect "mixed on a wall, $steps" 0 "$talus" run pressed.yaml --out pressed --force --quiet --set analysis.steps=$steps
  awk -F, 'END { exit !($3 * $3 < 1e-4 && $4 * $4 < 1e-20) }' pressed/history.csv || fail "$name: $(tail -n 1 pressed/history.csv)"
done

# A wall that jumps at the start is told of, one that starts to move is not.
sed 's/^formulation.*//; s/^method: fem/method: mpm/; s/^analysis.*/analysis: {type: explicit, end: 0.1, step: 1e-3}/
  s/contact: bonded/motion: [{displacement: {y: 0.1}}]/; s/^grid.*/grid: {box: {min: [-1, -1], max: [2, 2]}, size: 0.25}/' pressed.yaml >jumps.yaml
expect "a wall jumps" 0 "$talus" check jumps.yaml
says err.txt "wall 'floor' jumps by 0.1 m at the start"
expect "a wall starts" 0 "$talus" check jumps.yaml --set 'walls[0].motion[0].amplitude=[[0, 0], [0.1, 1]]'
! grep -q jumps err.txt || fail "$name: $(cat err.txt)"
finish
