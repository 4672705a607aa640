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

# gnuplot is one that keeps what it is told.
mkdir bin
printf '#!/bin/sh\ncat >script.txt\n' >bin/gnuplot
chmod +x bin/gnuplot
for way in "2 0.2 5" "3 0.05 2"; do
  set -- $way
  expect "$1 ranks" 0 on_ranks $1 "$talus" run case.yaml --out ranks --force --quiet --set analysis.end=$2
  [ "$(ls ranks/contact_*.hdf | wc -l)" -eq $3 ] || fail "$name: files of contact"
  expect "$1 ranks, profile" 0 env PATH="$PWD/bin:$PATH" "$talus" plot ranks --profile floor
  [ "$(wc -l <ranks/pictures/profile_floor.csv)" -eq 17 ] || fail "$name: $(wc -l <ranks/pictures/profile_floor.csv) lines"
done

# The weight of 500 kg over 1 m; the block still breathes a little
expect "profile" 0 "$talus" plot whole --profile floor
awk -F, 'NR > 1 {n++; sum += $4; if ($1 < last) bad = 1; last = $1} END {exit bad || n != 16 || sum / n < 4500 || sum / n > 5300}' \
  whole/pictures/profile_floor.csv || fail "$name: $(cat whole/pictures/profile_floor.csv)"
[ -s whole/pictures/profile_floor.png ] || fail "$name: no picture"
# Half of the floor below the body feels nothing: the axis shows all of it.
expect "a step" 0 "$talus" run case.yaml --out step --quiet --set analysis.end=0.05 \
  --set 'bodies[0].shape={union: [{box: {min: [0, 0.75], max: [1, 1]}}, {box: {min: [0.5, 0.25], max: [1, 0.75]}}]}'
PATH="$PWD/bin:$PATH" "$talus" plot step --profile floor >out.txt 2>err.txt
awk '/set xrange/ {found = 1; gsub(/[][]/, ":"); split($0, x, ":"); if (!(x[2] > 0 && x[2] < 0.1 && x[3] > 0.9)) bad = 1} END {exit bad || !found}' script.txt ||
  fail "a step: $(grep xrange script.txt)"
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
# Nor is what an earlier stage has moved.
cat >jumped.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 1, steps: 2}
grid: {box: {min: [0, 0], max: [0.5, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [0.5, 0.5]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: lift, on: {boundary: bottom}, displacement: {y: 0.01}}, {on: {boundary: left}, fix: [x]}]
walls: [{name: lid, shape: {half-space: {point: [0, 0.5], normal: [0, -1]}}, motion: [{displacement: {y: -0.01}}]}]
stages: [{name: one}, {name: two, analysis: {type: dynamic, end: 0.1, step: 0.01}}]
END
expect "a wall has been moved, another one comes and jumps" 0 "$talus" check jumped.yaml --set 'stages[1].walls=[{name: side, shape: {half-space: {point: [0.5, 0], normal: [-1, 0]}}, motion: [{displacement: {x: -0.01}}]}]'
says err.txt "wall 'side' jumps by 0.01 m at the start"
[ "$(grep -c jumps err.txt)" -eq 1 ] || fail "$name: $(cat err.txt)"
# In statics that is meant where nothing came before; later an amplitude that begins with 1 holds nothing, and moves once more.
hold='amplitude: [[0, 1], [1, 1]]'
sed "s/motion: .{displacement: {y: -0.01}/&, $hold/; s/displacement: {y: 0.01}/&, $hold/; s/analysis: {type: dynamic.*/loads: {gravity: [0, 0]}}]/" jumped.yaml >holds.yaml
expect "what statics begin with" 0 "$talus" check holds.yaml
lacks err.txt "jumps"
lid="walls: [{name: lid, shape: {half-space: {point: [0, 0.5], normal: [0, -1]}}, motion: [{displacement: {y: -0.01}, amplitude: [[0, 1], [1, -0.5]]}]}]"
lift="boundary: [{name: lift, on: {boundary: bottom}, displacement: {y: 0.01}, amplitude: [[0, 1], [2, 1]]}]"
expect "a held wall jumps" 0 "$talus" run holds.yaml --out holds --force --quiet --set "stages[1]={name: two, $lid, $lift}"
says err.txt "wall 'lid' jumps by 0.01 m at the start: it begins where its shape is"
says err.txt "what this prescribes jumps by 0.01 m at the start: it counts from where nodes are by now"
# A block squeezed by a millionth of its height bears what its modulus says, E / (1 - nu^2) strain, however small: what
# gaps of a fixed size leave would be a third of it.
cat >squeezed.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, -0.5], max: [2, 1]}, size: 0.0625}
bodies:
  - {name: b, shape: {box: {min: [0, 0.037], max: [0.5, 0.337]}}, points_per_cell: 4, material: m}
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: sym, on: {x: 0}, fix: [x]}]
walls:
  - {name: lo, shape: {half-space: {point: [0, 0.037], normal: [0, 1]}}}
  - {name: hi, shape: {half-space: {point: [0, 0.337], normal: [0, -1]}}, motion: [{displacement: {y: -3e-7}}]}
measures: {force: {wall_force: y, of: {wall: lo}}}
output: {fields: [stress]}
END
for way in "mpm 1e-4 1" "mpm 1e-6 2" "fem 1e-6 1"; do
  set -- $way
  box='{min: [0, -0.5], max: [2, 1]}'
  [ $1 = mpm ] || box='{min: [0, 0.037], max: [0.5, 0.337]}'
  expect "squeezed by $2, $1 on $3" 0 on_ranks $3 "$talus" run squeezed.yaml --out squeezed --force --quiet --set method=$1 --set "grid={box: $box, size: [0.0625, 0.06]}" \
    --set "walls[1].motion[0].displacement.y=$(awk "BEGIN {print -0.3 * $2}")"
  awk -F, -v e=$2 'END {exact = 0.5 * e * 1e6 / 0.91; exit !($3 > 0.997 * exact && $3 < 1.003 * exact)}' squeezed/history.csv || fail "$name: $(tail -n 1 squeezed/history.csv)"
done

# A block that is bonded to a wall anywhere in its cells and swings gains no energy, in short steps above all; and where
# nothing is loaded no load works.
cat >swings.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.05, step: 0.00025}
grid: {box: {min: [0.4, -0.6], max: [1.9, 0.65]}, size: 0.0625}
bodies:
  - {name: b, shape: {box: {min: [1.055, -0.113], max: [1.305, 0.137]}}, points_per_cell: 4, material: m, velocity: [0, 0.5]}
materials: {m: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
walls: [{name: w, shape: {box: {min: [0.613, -0.413], max: [1.055, 0.437]}}, contact: bonded}]
measures: {all: {energy: mechanical}, balance: {energy: balance}, loads: {energy: external}}
output: {fields: [stress]}
END
for basis in gimp bspline cell; do
  for at in 1.055 1.075; do
    expect "bonded at $at, $basis" 0 "$talus" run swings.yaml --out swings --force --quiet --set "basis={$basis: {}}" --set "walls[0].shape.box.max=[$at, 0.437]" \
      --set "bodies[0].shape.box.min=[$at, -0.113]" --set "bodies[0].shape.box.max=[$(awk "BEGIN {print $at + 0.25}"), 0.137]"
    awk -F, 'NR == 2 {first = $3} NR > 1 && ($3 > 1.001 * first || $4 * $4 > 1e-12 || $5 * $5 > 1e-24) {bad = 1} END {exit bad || $3 < 0.7 * first}' swings/history.csv || fail "$name: $(tail -n 1 swings/history.csv)"
  done
done
# What a turning wall gives by its torque is what angular momentum gains.
sed 's/contact: bonded/&, motion: [{rotation: {centre: [0.2, 0.1], rate: 4}, amplitude: [[0, 0], [0.1, 1]]}]/; s/end: 0.05, step: 0.00025/end: 0.1, step: 0.002/; s/, velocity: .0, 0.5.//
  s/^measures.*/measures: {torque: {wall_torque: z, of: {wall: w}}, gained: {angular_momentum: z}}/; s/^grid.*/grid: {box: {min: [-1.6, -1.6], max: [1.9, 1.9]}, size: 0.0625}/' swings.yaml >turns.yaml
expect "turns" 0 on_ranks 2 "$talus" run turns.yaml --out turns --force --quiet
awk -F, 'NR == 2 { t = $1 } NR > 2 { sum += $3 * ($1 - t); t = $1; off = sum - $4 } END { exit !($4 > 5 && off * off < 1e-14 * $4 * $4) }' turns/history.csv || fail "$name: $(tail -n 1 turns/history.csv)"

# Grains that run out over a wall that rubs, or lets nothing slide, in explicit steps of the largest size: points that come
# to nodes of next to no mass are not thrown up.
cat >runs_out.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {cell: {}}
analysis: {type: explicit, end: 0.5, step: 2.5e-3}
grid: {box: {min: [0, -0.025], max: [1.2, 0.8]}, size: 0.0125}
bodies:
  - {name: grains, shape: {box: {min: [0, 0], max: [0.2, 0.3]}}, points_per_cell: 4, material: grains}
materials:
  grains: {law: mohr-coulomb, density: 1600, young: 1e6, poisson: 0.3, friction_angle: 30, dilatancy_angle: 1, cohesion: 0}
boundary: [{name: axis, on: {boundary: left}, fix: [x]}]
walls: [{name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction: 0.577}]
loads: {gravity: [0, -9.81]}
measures: {transfer: {energy: transfer}, friction: {energy: friction}, came: {energy: external}, mass: {mass: total}}
output: {fields: [displacement]}
END
for way in "rubs 2" "sticks 1"; do
  set -- $way
  law=friction
  [ $1 = rubs ] || law=stick
  expect "runs out, $way" 0 on_ranks $2 "$talus" run runs_out.yaml --out runs_out --force --quiet --set "walls[0]={name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, contact: $law$([ $law = stick ] || echo ', friction: 0.577')}"
  awk -F, -v most=$([ $law = stick ] && echo 0.05 || echo 0.02) 'NR > 1 { if ($3 < -0.002 * 60 || $3 > most * $5 + 0.1 || $4 < -0.005 * 60) bad = 1 } END { exit bad || $6 < 95.999 || $6 > 96.001 }' runs_out/history.csv ||
    fail "$name: $(tail -n 1 runs_out/history.csv)"
done
# A block that is held below and bonded above, at rest or going along with its wall: nothing pushes, in any basis, and
# where nodes are held that no material reaches.
cat >at_rest.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {gimp: {}}
analysis: {type: dynamic, end: 0.01, step: 1e-3}
grid: {box: {min: [0, 0], max: [0.3, 0.5]}, size: 0.05}
bodies:
  - {name: block, shape: {box: {min: [0, 0], max: [0.2, 0.4]}}, material: soft, velocity: [0.5, 0]}
materials:
  soft: {law: neo-hookean, density: 100, young: 1e6, poisson: 0}
boundary: [{name: bottom, on: {y: 0}, fix: [y]}]
walls: [{name: top, shape: {half-space: {point: [0, 0.4], normal: [0, -1]}}, contact: bonded, motion: [{velocity: {x: 0.5}}]}]
measures: {bottom: {reaction: y, of: {boundary: bottom}}, top: {wall_force: y, of: {wall: top}}, external: {energy: external}, transfer: {energy: transfer}}
END
for way in "gimp 2" "bspline 1" "cell 1"; do
  set -- $way
  expect "at rest, $way" 0 on_ranks $2 "$talus" run at_rest.yaml --out at_rest --force --quiet --set "basis={$1: {}}"
  awk -F, 'NR > 1 { for (k = 3; k <= 6; ++k) if ($k > 1e-4 || $k < -1e-4) exit 1 }' at_rest/history.csv || fail "$name: $(tail -n 1 at_rest/history.csv)"
done
# A sample between two platens slides on all that holds it: its place is known by symmetry alone, and half of it, which
# is held in the middle, bears half. Where friction cannot hold it at all, the message says what goes where.
cat >platens.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 1, step: 0.25}
grid: {box: {min: [-2, -1], max: [2, 2]}, size: 0.25}
bodies:
  - {name: sample, shape: {box: {min: [-1, 0], max: [1, 1]}}, material: soft}
materials:
  soft: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction: 0.01}
  - {name: press, shape: {half-space: {point: [0, 1], normal: [0, -1]}}, friction: 0.01, motion: [{displacement: {y: -0.01}}]}
measures: {bears: {wall_force: y, of: {wall: press}}}
END
half="bodies[0].shape.box.min=[0, 0]"
for way in "mpm 2" "fem 1"; do
  set -- $way
  expect "half between platens, $way" 0 "$talus" run platens.yaml --out half --force --quiet --set method=$1 --set "$half" \
    --set 'boundary=[{on: {x: 0}, fix: [x]}]'
  expect "between platens, $way" 0 on_ranks $2 "$talus" run platens.yaml --out whole --force --quiet --set method=$1
  [ "$(sed -n '$s/,.*//p' whole/history.csv),$(tail -n 1 whole/history.csv | cut -d, -f2)" = 1,4 ] || fail "$name: $(tail -n 1 whole/history.csv)"
  awk -v a="$(tail -n 1 whole/history.csv | cut -d, -f3)" -v b="$(tail -n 1 half/history.csv | cut -d, -f3)" \
    'BEGIN { d = a / (2 * b) - 1; exit !(a < -12000 && d < 1e-7 && d > -1e-7) }' || fail "$name: $(tail -n 1 whole/history.csv half/history.csv)"
done
expect "smooth platens" 2 "$talus" check platens.yaml --set walls[0].friction=0 --set walls[1].friction=0
says err.txt "nothing holds 'sample' in x" "if its loads are in balance: analysis: {unheld: hold}"
expect "all but smooth" 0 "$talus" run platens.yaml --out smooth --force --quiet --set walls[0].friction=1e-5 --set walls[1].friction=1e-5
expect "beyond friction" 1 "$talus" run platens.yaml --out beyond --force --quiet --set 'loads={gravity: [9.81, 0]}'
says err.txt "Friction may be overcome: 'sample' slides at"
# Statics: a rough wall carries what rests on it, two that grip a block lift it, in as many steps as are asked for; and
# a wall that passes under what is held rubs at the limit of friction.
cat >carried.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 1, step: 0.1}
grid: {box: {min: [-0.2, -0.2], max: [0.6, 0.6]}, size: 0.05}
bodies:
  - {name: block, shape: {box: {min: [0, 0], max: [0.2, 0.2]}}, material: soft}
materials:
  soft: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0}
walls:
  - {name: belt, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction: 0.5, motion: [{displacement: {x: 0.1}, amplitude: [[0, 0], [0.5, 0], [1, 1]]}]}
loads: {gravity: [0, -10], gravity_amplitude: [[0, 0], [0.5, 1]]}
measures: {rubs: {wall_force: x, of: {wall: belt}}, bears: {wall_force: y, of: {wall: belt}}, way: {displacement: x, of: {tracer: [0.1, 0.1]}}}
END
for way in "mpm 3" "fem 1" "gmm 1"; do
  set -- $way
  expect "carried, $way" 0 on_ranks $2 "$talus" run carried.yaml --out carried --force --quiet --set method=$1
  awk -F, 'END { exit !($2 == 10 && $3 < 0.01 && $3 > -0.01 && $4 > 399.99 && $4 < 400.01 && $5 > 0.09999 && $5 < 0.10001) }' carried/history.csv ||
    fail "$name: $(tail -n 1 carried/history.csv)"
done
expect "held, and passed" 0 "$talus" run carried.yaml --out carried --force --quiet --set 'boundary=[{on: {x: 0.2}, fix: [x]}]'
awk -F, 'END { exit !($2 == 10 && $3 > 199 && $3 < 201 && $4 > 399.9 && $4 < 400.1 && $5 < 0.001 && $5 > -0.001) }' carried/history.csv ||
  fail "$name: $(tail -n 1 carried/history.csv)"
cat >walls.txt <<'END'
walls=[{name: left, shape: {half-space: {point: [0, 0], normal: [1, 0]}}, friction: 0.5, motion: [{displacement: {x: 0.0005}, amplitude: [[0, 0], [0.5, 1]]}, {displacement: {y: 0.1}, amplitude: [[0, 0], [0.5, 0], [1, 1]]}]}, {name: belt, shape: {half-space: {point: [0.2, 0], normal: [-1, 0]}}, friction: 0.5, motion: [{displacement: {x: -0.0005}, amplitude: [[0, 0], [0.5, 1]]}, {displacement: {y: 0.1}, amplitude: [[0, 0], [0.5, 0], [1, 1]]}]}]
END
expect "gripped and lifted" 0 "$talus" run carried.yaml --out carried --force --quiet --set "$(cat walls.txt)" --set 'measures.way={displacement: y, of: {tracer: [0.1, 0.1]}}'
awk -F, 'END { exit !($2 == 10 && $4 > 199.9 && $4 < 200.1 && $5 > 0.0998 && $5 < 0.1) }' carried/history.csv || fail "$name: $(tail -n 1 carried/history.csv)"
# A wall with mass that falls through another one, or out of the grid: no wall stops a wall, and that is said.
cat >falls.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.6, step: 0.02}
grid: {box: {min: [-1, -1], max: [4, 3]}, size: 0.5}
bodies: [{name: ground, shape: {box: {min: [2, -1], max: [4, 0]}}, material: soft}]
materials: {soft: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {boundary: bottom}, fix: [x, y]}, {on: {boundary: right}, fix: [x]}]
walls:
  - {name: floor, shape: {half-space: {point: [0, -0.5], normal: [0, 1]}}, bodies: [ground], from: 100}
  - {name: stone, shape: {box: {min: [0, 1], max: [1, 2]}}, mass: {density: 2000}}
loads: {gravity: [0, -10]}
measures: {height: {wall_position: y, of: {wall: stone}}}
END
sed 's/, from: 100//; s/max: \[4, 3\]/max: [4, 3]/; s/min: \[2, -1\], max: \[4, 0\]/min: [2, -0.5], max: [4, 0]/' falls.yaml >through.yaml
expect "through a wall" 0 "$talus" run through.yaml --out falls --force --quiet --set analysis.end=0.68
says err.txt "at the end wall 'stone' stands in wall 'floor': walls meet material, and not each other"
expect "out of the grid" 0 "$talus" run falls.yaml --out falls --force --quiet --set analysis.end=0.8
says err.txt "at the end the centre of wall 'stone' is outside of the grid"
expect "still in the air" 0 "$talus" run falls.yaml --out falls --force --quiet --set analysis.end=0.2
! grep -q "stands in wall\|outside of the grid" err.txt || fail "$name: $(cat err.txt)"
# A wall at the edge of the grid is what holds there; numbers in other units are told of.
sed 's/^grid.*/grid: {box: {min: [0, -0.01], max: [1.2, 0.8]}, size: 0.01}/; s/^boundary.*//; s/^walls: \[/&{name: back, shape: {half-space: {point: [0, 0], normal: [1, 0]}}}, /' runs_out.yaml >units.yaml
expect "a wall at the edge" 0 "$talus" check units.yaml
! grep -q "fills the grid" err.txt || fail "$name: $(cat err.txt)"
! grep -q "stiffness bears" err.txt || fail "$name: $(cat err.txt)"
expect "no wall there, radians, degrees" 0 "$talus" check units.yaml --set 'walls[0].shape.half-space.point=[-0.02, 0]' \
  --set materials.grains.friction_angle=0.5236 --set materials.grains.dilatancy_angle=0 --set walls[1].friction=30
says err.txt "'grains' fills the grid to its edge towards -x"
says err.txt "an angle of friction of 0.5236 degrees holds next to nothing" "0.5236 radians are 30"
says err.txt "a coefficient of friction of 30 is an angle of 88.1 degrees" "an angle is \`friction_angle\`, in degrees"
sed '/^walls/s/friction: [0-9.]*/friction_angle: 0.262/' units.yaml >radians.yaml
expect "radians of a wall, millimetres" 0 "$talus" check radians.yaml --set 'loads.gravity=[0, -9810]' --set materials.grains.young=8e5
says err.txt "an angle of friction of 0.262 degrees holds next to nothing" "0.262 radians are 15.01"
says err.txt "the weight of 'grains' is 4.3" "gravity in m/s2"
expect "kPa" 0 "$talus" check units.yaml --set materials.grains.density=1.6e-9
says err.txt "waves would run at" "densities are in kg/m3"
# --- far from the origin, as on a map ---
# A block that walls hold, tilted and pushed, near the origin and at 5e5, 5e6 m: the same to what places are rounded by.
far() {
  cat <<END
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 4}
grid: {box: {min: [$(($1 - 2)), $(($2 - 2))], max: [$(($1 + 3)), $(($2 + 3))]}, size: 0.125}
bodies: [{name: b, shape: {box: {min: [$1, $2], max: [$(($1 + 1)), $(($2 + 1))]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 2000, young: 1e7, poisson: 0.2}}
loads: {gravity: [-1, -10]}
walls:
  - {name: floor, shape: {half-space: {point: [$1, $2], normal: [0, 1]}}, friction: 0.3}
  - {name: push, shape: {half-space: {point: [$1, $2], normal: [1, 0]}}, motion: [{displacement: {x: 0.01}}]}
measures: {d: {displacement: y, of: {tracer: [$1.5, $(($2 + 1))]}}, low: {wall_force: y, of: {wall: floor}}, push: {wall_force: x, of: {wall: push}}}
END
}
far 0 0 >near.yaml
far 500000 5000000 >far.yaml
for case in near far; do expect "$case" 0 "$talus" run $case.yaml --out $case --quiet; done
paste -d , near/history.csv far/history.csv |
  awk -F, 'NR > 1 { d = $3 - $8; f = $4 - $9; g = $5 - $10; if (d * d > 1e-14 || f * f > 1e-4 || g * g > 1e-2) exit 1 } END { exit NR != 6 || $4 < 19999 || $5 < 7990 }' ||
  fail "far from the origin otherwise: $(tail -n 1 near/history.csv) and $(tail -n 1 far/history.csv)"

# A terrain with posts 2 m apart, as finely as maps have them: single precision knows such places to half a metre.
awk 'BEGIN { print "ncols 21\nnrows 21\nxllcorner 499980\nyllcorner 4999980\ncellsize 2"; for (i = 0; i < 21; ++i) { for (k = 0; k < 21; ++k) printf "100.25 "; print "" } }' >ter.asc
cat >terrain.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [500000, 5000000, 100], max: [500004, 5000002, 101.5]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [500002, 5000000.5, 100.25], max: [500003.25, 5000001.5, 100.75]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.2}}
walls: [{name: t, shape: {terrain: {file: ter.asc}}, friction: 0.05}]
loads: {gravity: [0, 0, -10]}
measures: {borne: {wall_force: z, of: {wall: t}}}
END
expect "a terrain on a map" 0 "$talus" run terrain.yaml --out terrain --quiet
awk -F, 'END { exit !(($3 - 6250) ^ 2 < 1e-4) }' terrain/history.csv || fail "$name: $(tail -n 1 terrain/history.csv)"

# Beside its last posts nothing bears: posts at 0, 1 and 2 m of a file whose corner is at -0.5.
awk 'BEGIN { print "ncols 3\nnrows 4\nxllcorner -0.5\nyllcorner -0.5\ncellsize 1"; for (i = 0; i < 4; ++i) print "0.5 0.5 0.5" }' >ter.asc
sed 's/min: \[500000, 5000000, 100\], max: \[500004, 5000002, 101.5\]/min: [0, 0, 0], max: [4, 2, 1.5]/
  s/min: \[500002, 5000000.5, 100.25\], max: \[500003.25, 5000001.5, 100.75\]/min: [0.5, 0.5, 0.5], max: [1.5, 1.5, 1]/' terrain.yaml >ends.yaml
expect "terrain that ends in the grid" 0 "$talus" check ends.yaml
says err.txt "the posts of terrain 't' end within the grid from (0, 0) to (2, 3) m, that reaches from (0, 0) to (4, 2) m" "half a cell within"
expect "one that does not" 0 "$talus" check ends.yaml --set 'grid.box.max=[2, 2, 1.5]'
lacks err.txt "end within the grid"

# --- walls that appear amidst material ---
for type in dynamic explicit; do
  sed -e "s/type: static, steps: 4/type: $type, end: 0.1, step: 0.01/" -e 's/normal: \[1, 0\]}}, motion.*/normal: [1, 0]}}, from: 0.05}/' -e 's/point: \[0, 0\], normal: \[1, 0\]/point: [0.1, 0], normal: [1, 0]/' near.yaml >gate.yaml
  expect "a gate, $type" 1 "$talus" run gate.yaml --out gate-$type --quiet
  says err.txt "the run gave up: wall 'push' comes at t = 0.05 s where material is: the point at (0.0" "m inside it"
  [ "$(tail -n 1 gate-$type/history.csv | cut -d, -f5)" = 0 ] || fail "$name: it pushed"
  # one that stands beside material is none
  expect "beside, $type" 0 "$talus" run gate.yaml --set 'walls[1].shape.half-space.point=[-0.2, 0]' --out beside-$type --quiet
done

# --- a step of statics does not come through a wall that is within its reach ---
cat >leaps.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 2, steps: 20}
grid: {box: {min: [0, 0], max: [2.5, 1.5]}, size: 0.125}
bodies:
  - {name: low, shape: {box: {min: [0, 0], max: [2, 0.5]}}, material: m, points_per_cell: 4}
  - {name: up, shape: {box: {min: [0.5, 0.5], max: [1.5, 1]}}, material: m, points_per_cell: 4}
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
boundary: [{name: floor, on: {boundary: bottom}, fix: [x, y]}]
walls: [{name: push, shape: {box: {min: [0.25, 0.55], max: [0.5, 1]}}, bodies: [up], motion: [{displacement: {x: 0.1}, amplitude: [[0, 0], [1, 0], [2, 1]]}]}]
interfaces: [{name: i, between: [up, low], contact: friction, friction: 0.3}]
loads: {tractions: [{on: {body: up, y: 1}, value: [0, -1e4], amplitude: [[0, 0], [1, 1]]}]}
measures: {push: {wall_force: x, of: {wall: push}}, way: {displacement: x, of: {tracer: [1, 0.75]}}}
END
expect "leaps" 0 "$talus" run leaps.yaml --out leaps --quiet
awk -F, 'NR > 1 && $1 > 1.05 && ($3 < 2997 || $3 > 3003 || ($4 - 0.1 * ($1 - 1)) ^ 2 > 1e-8) { bad = 1 } END { exit bad || ($4 - 0.1) ^ 2 > 1e-8 }' leaps/history.csv || fail "$name: $(cat leaps/history.csv)"

# --- a wall that is pushed against sand on a floor that rubs: Rankine's K of 30 degrees is 3, and the floor is as rough as sand ---
cat >passive.yaml <<'END'
kinematics: plane-strain
method: mpm
formulation: mean-dilatation
analysis: {type: static, steps: 10}
grid: {box: {min: [-0.5, 0], max: [4, 1.5]}, size: 0.125}
bodies: [{name: sand, shape: {box: {min: [0, 0], max: [4, 1]}}, points_per_cell: 4, material: sand, k0: 0.5}]
materials:
  sand: {law: mohr-coulomb, density: 2000, young: 2e7, poisson: 0.3, friction_angle: 30, dilatancy_angle: 0, cohesion: 30}
boundary: [{on: {boundary: right}, fix: [x]}]
walls:
  - {name: floor, friction: 0.577, shape: {half-space: {point: [0, 0], normal: [0, 1]}}}
  - {name: wall, shape: {half-space: {point: [0, 0], normal: [1, 0]}}, motion: [{displacement: {x: 0.02}}]}
loads: {gravity: [0, -10]}
measures: {force: {wall_force: x, of: {wall: wall}}}
END
expect "passive" 0 "$talus" run passive.yaml --out passive --quiet
awk -F, 'END { exit ($3 / 1e4 - 3) ^ 2 > 0.05 ^ 2 }' passive/history.csv || fail "$name: $(tail -n 1 passive/history.csv)"

# A rough punch whose edges stand just beside points of coarse cells goes all of its steps, however many, to one force.
# It gave up within the first third, the sooner the rougher: the normal of what is all but at an edge turned by a right
# angle within its gap.
cat >edges.yaml <<'END'
kinematics: 3d
method: fem
analysis: {type: static, steps: 5}
grid: {box: {min: [0, 0, 0], max: [1, 1, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {z: 0}, fix: [x, y, z]}]
walls: [{name: w, shape: {box: {min: [0.2, 0.2, 1], max: [2.2, 0.8, 2]}}, friction: 0.3, motion: [{displacement: {z: -0.03}}]}]
measures: {f: {wall_force: z, of: {wall: w}}}
output: {every: end}
END
for way in "friction: 0.3, method=fem" "friction: 0.3, method=gmm" "contact: stick, analysis.steps=20"; do
  case $way in *fem) ranks=2 ;; *) ranks=1 ;; esac
  sed "s/friction: 0.3/${way%%,*}/" edges.yaml >edge.yaml
  expect "edges beside points, $way on $ranks" 0 on_ranks $ranks "$talus" run edge.yaml --out edge --force --set "${way#*, }"
  grep -q 'halvings = 0' out.txt || fail "$name: $(grep halvings out.txt)"
  awk -F, 'END { exit !(NR > 5 && ($NF / -31000 - 1) ^ 2 < 0.02 ^ 2) }' edge/history.csv || fail "$name: $(tail -n 1 edge/history.csv)"
done

# Bodies that come to both sides of a thin wall stick to each other through it: told at the end, though the wall has gone.
cat >sheet.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, step: 0.02, end: 0.4}
grid: {box: {min: [0, 0], max: [2, 0.5]}, size: 0.125}
bodies:
  - {name: left, shape: {box: {min: [0.5, 0.125], max: [0.75, 0.375]}}, material: rubber, velocity: [1, 0]}
  - {name: right, shape: {box: {min: [1.25, 0.125], max: [1.5, 0.375]}}, material: rubber, velocity: [-1, 0]}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}
walls:
  - {name: sheet, shape: {line: [[1, 0], [1, 0.5]]}, until: 0.3}
output: {every: end, history: 0.1}
END
expect "nothing is there at first" 0 "$talus" check sheet.yaml
! grep -q "parts nothing" err.txt || fail "$name: it is told of"
expect "what came" 0 "$talus" run sheet.yaml --out sheet --quiet
says err.txt "wall 'sheet' is thinner than nodes reach and parts nothing (seen at t = 0."
says err.txt "'left' and 'right' on its two sides stick to each other by"

# What springs of explicit dynamics have let into the side that it rests on is on no other side: of a line, a trough. A
# wedge it goes into by more than what such springs stop, and with no energy that nobody has put in (half of what came).
cat >ball.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: explicit, end: 0.16, step: 0.01}
grid: {box: {min: [0, 0], max: [2, 2]}, size: 0.05}
bodies: [{name: ball, shape: {circle: {centre: [1, 1.0], radius: 0.3}}, points_per_cell: 4, material: rubber, velocity: [0, -2]}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 3e5, poisson: 0.3}}
measures: {depth: {contact: penetration, of: {wall: w}}, transfer: {energy: transfer}}
walls: [{name: w, shape: {line: [[0.2, 0.5], [1.8, 0.5]]}}]
output: {every: end, history: {steps: 1}}
END
expect "a ball on a line" 0 "$talus" run ball.yaml --out ball --quiet
! grep -q "parts nothing" err.txt || fail "$name: it is said to be on both sides"
! grep -q "on the way" err.txt || fail "$name: tells of a fifth of a cell"
expect "a ball in a trough" 0 "$talus" run ball.yaml --out trough --quiet --set 'walls=[{name: w, shape: {line: [[0.2, 0.9], [1, 0.5], [1.8, 0.9]]}}]'
! grep -q "parts nothing" err.txt || fail "$name: it is said to be on both sides"
expect "a ball on a wedge" 0 "$talus" run ball.yaml --out wedge --quiet --set grid.size=0.04 --set analysis.end=0.4 \
  --set 'walls=[{name: w, shape: {polygon: [[1, 0.6], [1.4, 0], [0.6, 0]]}}]'
says err.txt "on the way material was" "cells deep in wall 'w'"
awk -F, 'NR > 1 && $4 < -1 { bad = 1; print } END { exit bad || NR < 30 }' wedge/history.csv >out.txt || fail "$name: makes energy"

finish
