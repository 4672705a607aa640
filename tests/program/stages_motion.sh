#!/bin/sh
# What a stage takes over of loads and motion: pressures that go on where the surface now is, the spin of what flies, walls
# with mass that statics or a reset bring to rest, what comes late, and stresses of what ages.
. "$(dirname "$0")/library.sh"

# A column under a constant pressure, pressed through several cells in the first stage: nothing is out of balance later.
cat >pressed.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 4}
grid: {box: {min: [0, 0], max: [0.5, 1.25]}, size: 0.125}
bodies: [{name: column, shape: {box: {min: [0, 0], max: [0.5, 0.97]}}, points_per_cell: 4, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0}}
boundary:
  - {name: floor, on: {y: 0}, fix: [y]}
  - {name: left, on: {x: 0}, fix: [x]}
  - {name: right, on: {x: 0.5}, fix: [x]}
loads: {pressures: [{on: {body: column, y: 0.97}, value: 5e4, amplitude: [[0, 0], [1, 1]]}]}
measures: {stress: {stress: yy, of: {tracer: [0.25, 0.5]}}, reaction: {reaction: y, of: {boundary: floor}}}
stages:
  - name: pressed
  - {name: goes-on, analysis: {type: static, steps: 2}}
  - {name: still, analysis: {type: static, steps: 2}}
END
expect "pressures go on, on 2" 0 on_ranks 2 "$talus" run pressed.yaml --out pressed --quiet
awk -F, 'NR > 1 && $3 > 1 { n += 1; if (!($4 > -50005 && $4 < -49995 && $5 > 24999.9 && $5 < 25000.1)) { bad = 1; print } }
  END { exit bad || n < 4 }' pressed/history.csv >out.txt || { fail "$name: the pressure is another"; head -n 3 out.txt; }

# A square that flies and turns keeps its spin when explicit steps take it from implicit ones.
cat >turns.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.02, step: 2e-3, transfer: consistent}
grid: {box: {min: [-0.5, -0.5], max: [4, 1.5]}, size: 0.125}
bodies:
  - {name: square, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: rubber, velocity: [15, 0], spin: 3, spin_centre: [0.5, 0.5]}
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
measures: {spin: {spin: z, of: {body: square}}}
stages:
  - name: implicit
  - {name: explicit, analysis: {type: explicit, end: 0.15, step: 2e-3, transfer: consistent}}
END
expect "stages of dynamics say who follows" 0 "$talus" check turns.yaml
says out.txt "stabilisation: follow = 0.02; a case of dynamics without stages has 0 unless it says so"
expect "a spin goes on" 0 "$talus" run turns.yaml --out turns --quiet
awk -F, 'END { exit !($3 == 2 && $4 > 2.99 && $4 < 3.01) }' turns/history.csv || fail "$name: $(tail -n 1 turns/history.csv)"

# Momentum is impulse from the first step of a stage on whose nodes follow others than before: of none in explicit steps
# (895 of 135,070 N were missing), of more with another transfer.
cat >slides.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: explicit, end: 0.02, step: 0.01}
grid: {box: {min: [-1, -0.5], max: [1.5, 1.5]}, size: 0.25}
bodies: [{name: block, shape: {box: {min: [-0.45, 0], max: [0.53, 0.98]}}, material: rubber, velocity: [3, -3]}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls: [{name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction: 0.2}]
loads: {gravity: [0, -10]}
measures: {mx: {momentum: x}, my: {momentum: y}, fx: {wall_force: x, of: {wall: floor}}, fy: {wall_force: y, of: {wall: floor}}}
stages:
  - name: lands
  - {name: slides, analysis: {type: dynamic, end: 0.01, step: 0.005, transfer: thesis}}
END
ranks=2
for case in explicit 'dynamic, scheme: newmark, transfer: consistent'; do
  expect "from $case, on $ranks" 0 on_ranks $ranks "$talus" run slides.yaml --out slides --force --quiet \
    --set "analysis={type: $case, end: 0.02, step: 0.01}"
  awk -F, 'NR > 1 && $3 == 2 { n += 1; dt = $1 - t; x = ($4 - mx) / dt - $6; y = ($5 - my) / dt - $7 + 9604; if (x * x + y * y > 1e-4) { bad = 1; print x, y } }
    { t = $1; mx = $4; my = $5 } END { exit bad || n != 2 }' slides/history.csv >out.txt || fail "$name: $(head -n 1 out.txt) N are missing"
  ranks=1
done

# A wall with mass that falls stands still in statics, and goes on from rest.
cat >falls.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.005, step: 1e-3}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies: [{name: block, shape: {box: {min: [0, 0], max: [1, 1]}}, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: floor, on: {y: 0}, fix: [x, y]}]
loads: {gravity: [0, -10]}
walls: [{name: plate, shape: {box: {min: [0, 1], max: [1, 1.5]}}, contact: frictionless, mass: {density: 2000, velocity: [0, -1], free: [y]}}]
measures: {speed: {wall_velocity: y, of: {wall: plate}}, force: {wall_force: y, of: {wall: plate}}}
stages:
  - name: falls
  - {name: rests, analysis: {type: static, steps: 2}}
  - {name: waits, analysis: {type: dynamic, end: 0.002, step: 1e-3}}
END
expect "a wall with mass comes to rest, on 2" 0 on_ranks 2 "$talus" run falls.yaml --out falls --quiet
awk -F, 'NR > 1 && $3 == 1 { fell = $4 } NR > 1 && $3 == 2 && $4 != 0 { bad = 1 }
  NR > 1 && $3 == 3 { n += 1; if ($4 * $4 > 1e-12 || $5 < -10001 || $5 > -9999) bad = 1 }
  END { exit bad || n != 2 || fell > -0.1 }' falls/history.csv || fail "$name"
expect "and is reset" 0 "$talus" run falls.yaml --out falls --force --quiet --set 'stages[1]={name: reset, reset: [velocity], analysis: {type: dynamic, end: 0.001, step: 1e-3}}' --set 'loads={gravity: [0, 0]}'
awk -F, '$3 == 2 { exit !($4 * $4 < 0.0025) }' falls/history.csv || fail "$name: $(grep ',2,' falls/history.csv)"

expect "and has no velocity in a static stage that comes first" 0 "$talus" run falls.yaml --out falls --force --quiet --set 'stages[0]={name: stands, analysis: {type: static, steps: 2}}'
awk -F, 'NR > 1 && ($4 * $4 > 1e-12 || $5 < -10001 && $3 == 3) { bad = 1 } END { exit bad || $3 != 3 }' falls/history.csv || fail "$name: $(cat falls/history.csv)"

# Walls with mass that a stage gives anew. One that was not there begins as the stage says; one that was there stays where
# it is and goes on, but for what is said in other numbers; a reset stops it; drawn elsewhere it begins there; and energy
# is accounted for, whatever its mass is now. Of a wall of 10 kg that flies with 1 m/s and 1 rad/s.
cat >anew.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 1, step: 0.25}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 0.5]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.2}}
boundary: [{on: {y: 0}, fix: [x, y]}]
walls: [{name: w, shape: {circle: {centre: [0.5, 3], radius: 0.2}}, mass: {mass: 10, velocity: [1, 0], spin: 1}}]
measures:
  px: {wall_position: x, of: {wall: w}}
  py: {wall_position: y, of: {wall: w}}
  vx: {wall_velocity: x, of: {wall: w}}
  vy: {wall_velocity: y, of: {wall: w}}
  spin: {wall_spin: z, of: {wall: w}}
  angle: {wall_angle: z, of: {wall: w}}
  ek: {energy: kinetic}
  balance: {energy: balance}
stages:
  - {name: flies}
  - {name: anew, walls: [WALL]}
END
# Of many walls at once, each line of the input has what is said of one at first and anew, its place, velocity, spin and
# angle a second later, and its share of the kinetic energy. Settings.
anew() {
  n=0 first= later= values=
  sed '/: {wall_/d' anew.yaml >anew_walls.yaml
  while IFS='|' read -r before after is; do
    n=$((n + 1))
    first="$first{name: w$n, $before}, " later="$later{name: w$n, $after}, " values="$values $is"
    sed -n "s/^\(  .*\): \({wall_.*\)w}}/\1$n: \2w$n}}/p" anew.yaml >>measures.txt
  done
  sed -i -e '/^measures/r measures.txt' -e "s|^walls:.*|walls: [$first]|; s|WALL|$later|" anew_walls.yaml
  rm measures.txt
  expect "given anew, $*, $ranks" 0 on_ranks $ranks "$talus" run anew_walls.yaml --out anew --force --quiet "$@"
  awk -F, -v is="$values" -v n=$n 'END { split(is, v, " ")
    for (i = 1; i <= n; ++i) {
      for (k = 1; k <= 6; ++k) if (($(6 * i + k - 3) - v[7 * i + k - 7]) ^ 2 > 1e-24) { print "wall", i; exit 1 }
      energy += v[7 * i] }
    exit !(NF == 6 * n + 5 && ($(NF - 1) - energy) ^ 2 < 1e-24 && $NF ^ 2 < 1e-24) }' anew/history.csv >out.txt ||
    fail "$name: $(tail -n 1 anew/history.csv) for $values"
}
here='shape: {circle: {centre: [0.5, 3], radius: 0.2}}' moves='velocity: [1, 0], spin: 1'
flying="$here, mass: {mass: 10, $moves}"
# A table over time of a mass in the same words goes on with its clock: 5 N for a second, which end within a step of the next.
push='force: [5, 0], amplitude: [[0, 1], [1, 1], [1.25, 0]]'
ranks=1
anew <<END
$flying|$flying, friction: 0.2|2.5 3 1 0 1 2 5.1
$flying|$here, mass: {mass: 10, velocity: [0, -0.5], spin: 7}|1.5 2.5 0 -0.5 7 8 6.15
$flying, absent: true|$here, mass: {mass: 10, velocity: [0, -0.5], spin: 7}|0.5 2.5 0 -0.5 7 7 6.15
$flying|$here, mass: {mass: 20, $moves}|2.5 3 1 0 1 2 10.2
$flying|$here, mass: {mass: 20, $moves, centre: [0.5, 3.1]}|2.3618226709324 2.969883132106 0.94596976941319 -0.08414709848079 1 2 9.2193953882637
$flying|shape: {circle: {centre: [0.5, 2], radius: 0.2}}, mass: {mass: 20, $moves}|1.5 2 1 0 1 1 10.2
$flying|$here, mass: {mass: 20}|2.5 3 1 0 1 2 10.2
$flying|$here, mass: {mass: 10, velocity: [0, 0]}|1.5 3 0 0 1 2 0.1
$flying|absent: true|1.5 3 1 0 1 1 0
$here, mass: {mass: 10, $moves, $push}|$here, mass: {mass: 10, $moves, $push}, friction: 0.2|3.3046875 3 1.5625 0 1 2 12.30703125
END
ranks=3
anew --set 'stages[1].reset=[velocity]' <<END
$flying|$flying, friction: 0.2|1.5 3 0 0 0 1 0
$flying|$here, mass: {mass: 10, velocity: [0, -0.5], spin: 1}|1.5 2.5 0 -0.5 0 1 1.25
END
# In statics what a wall with mass bears goes from the old value to the new one, whatever else of it a stage changes; so
# does it where the run is resumed between them.
cat >weighs.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 0.5]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {y: 0}, fix: [x, y]}]
walls: [{name: w, shape: {box: {min: [0, 0.5], max: [1, 0.75]}}, friction: 0.3, mass: {mass: 100, force: [100, -1000], torque: 20}}]
loads: {gravity: [0, -10]}
measures: {fx: {wall_force: x, of: {wall: w}}, fy: {wall_force: y, of: {wall: w}}}
checkpoint: {steps: 1, keep: 99}
stages:
  - {name: presses}
  - {name: rubs, walls: [{name: w, shape: {box: {min: [0, 0.5], max: [1, 0.75]}}, friction: 0.5, mass: {mass: 100, force: [100, -1000], torque: 20}}]}
  - {name: more, walls: [{name: w, shape: {box: {min: [0, 0.5], max: [1, 0.75]}}, friction: 0.5, mass: {mass: 100, force: [200, -2000], torque: 20}}]}
  - {name: heavier, walls: [{name: w, shape: {box: {min: [0, 0.5], max: [1, 0.75]}}, friction: 0.5, mass: {mass: 200, force: [200, -2000], torque: 20}}]}
END
borne() {
  awk -F, 'function part(n, from) { return n < from ? 0 : n > from + 2 ? 1 : (n - from) / 2 }
    NR > 1 { n = NR - 2; x = 100 * (part(n, 0) + part(n, 4)); y = -2000 * part(n, 0) - 1000 * (part(n, 4) + part(n, 6)) }
    NR > 1 && (($4 - x) ^ 2 > 1e-8 || ($5 - y) ^ 2 > 1e-8) { bad = 1; print x, y, $0 } END { exit bad || NR != 10 }' \
    "$1/history.csv" >out.txt || { fail "$name"; head -n 3 out.txt; }
}
ranks=1
for method in fem mpm; do
  expect "what walls bear goes on, $method on $ranks" 0 on_ranks $ranks "$talus" run weighs.yaml --out weighs --force --quiet --set method=$method
  borne weighs
  rm -f weighs/checkpoint_*[678].h5
  expect "and does so resumed, $method" 0 "$talus" run --resume weighs --quiet
  borne weighs
  ranks=2
done

# And one that is gone for good, which a force has pushed by 1.25 m: its work stays, its motion goes.
sed -e '/: {wall_/d' -e 's/^measures:/&\n  came: {energy: external}/' -e 's/spin: 1}/spin: 1, force: [5, 0]}/' -e 's/\[WALL\]/[]/' anew.yaml >anew_wall.yaml
expect "gone for good" 0 "$talus" run anew_wall.yaml --out anew --force --quiet
awk -F, 'END { exit !(($4 - 6.25) ^ 2 < 1e-20 && $5 == 0 && $6 ^ 2 < 1e-24) }' anew/history.csv || fail "$name: $(tail -n 1 anew/history.csv)"

# What falls has the way of gravity alone, to the last digits, in whatever stage that begins: one from rest, and one in which it grows.
cat >drop.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.04, step: 0.02}
grid: {box: {min: [0, -4], max: [2, 2]}, size: 0.25}
bodies: [{name: block, shape: {box: {min: [0.5, 0.5], max: [1.5, 1.5]}}, points_per_cell: 4, material: rubber, velocity: [0, 1]}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
measures: {way: {displacement: y, of: {tracer: [1, 1]}}}
stages:
  - name: flies
  - {name: falls, reset: [displacement, velocity], analysis: {end: 0.1}, loads: {gravity: [0, -10]}}
  - {name: faster, analysis: {end: 0.1}, loads: {gravity: [0, -20]}}
END
for scheme in "method=mpm" "basis={gimp: {}}" "analysis.transfer=thesis" "method=fem"; do
  turn 11
  expect "a jump of gravity, $scheme on $ranks" 0 on_ranks $ranks "$talus" run drop.yaml --out drop --force --quiet --set "$scheme"
  awk -F, 'function off(a, b) { return (a - b) * (a - b) > 1e-18 } $3 == 2 { fell = $4 } $3 == 3 { way = $4 }
    END { exit off(fell, -0.05) || off(way, -0.25) }' drop/history.csv || fail "$name: $(tail -n 1 drop/history.csv)"
done

# What begins, ends or lets go with a stage of dynamics acts from its start on, in full: Newmark's first step lacked half a step of it, momentum for good.
cat >jumps.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.1, step: 0.02}
grid: {box: {min: [-1, -3], max: [3, 1]}, size: 0.5}
bodies: [{name: block, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
measures: {px: {momentum: x}, py: {momentum: y}, transfer: {energy: transfer}}
END
# jumps NAME VARIANT MOMENTUM: of the last step, to 1e-7 of what it should be.
jumps() {
  turn 11
  expect "$1 ends, $2 on $ranks" 0 on_ranks $ranks "$talus" run $1.yaml --out $1 --force --quiet --set "$2"
  awk -F, -v want="$3" -v k="$4" 'END { exit !(($k - want)^2 < (1e-7 * want)^2 && NR > 10) }' $1/history.csv ||
    fail "$name: $(tail -n 1 $1/history.csv)"
}
(cat jumps.yaml && echo 'loads: {tractions: [{on: {body: block, x: 0}, value: [1000, 0]}]}
stages: [{name: pushed}, {name: flies, analysis: {end: 0.1}, loads: {tractions: []}}]') >traction.yaml
sed 's/fem/mpm/; s/step: 0.02/&, transfer: thesis/' traction.yaml >points.yaml
sed 's/fem/gmm/; s/min: \[-1, -3\], max: \[3, 1\]/min: [0, 0], max: [1, 1]/; s/size: 0.5/size: 0.25/' traction.yaml >cloud.yaml
jumps traction method=fem 100 4
jumps traction analysis.bossak=-0.1 100 4
jumps points method=mpm 100 4
jumps cloud method=gmm 100 4
(cat jumps.yaml && echo 'loads: {gravity: [0, -10]}
walls: [{name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, contact: frictionless}]
stages: [{name: rests}, {name: falls, analysis: {end: 0.1}, walls: [{name: floor, absent: true}]}]') | sed 's/points_per_cell: 4/&, k0: 0/' >wall.yaml
jumps wall method=fem -1000 5
sed 's/^walls.*/boundary: [{name: floor, on: {y: 0}, fix: [y]}]/; s/walls:/boundary:/' wall.yaml >held.yaml
jumps held method=fem -1000 5
(sed 's/points_per_cell: 4/&, velocity: [1, 0]/' jumps.yaml && echo 'stages: [{name: flies}, {name: damped, analysis: {damping: 5, end: 0.1}}]') >damping.yaml
jumps damping method=fem 606.277611645633 4 # 1000 (0.95/1.05)^5

# What the boundary gives goes on from what it had to give at once: its impulses are the change of momentum.
(cat jumps.yaml && echo 'loads: {tractions: [{on: {body: block, y: 1}, value: [0, -5e5]}]}
boundary: [{name: floor, on: {y: 0}, fix: [x, y]}]
stages: [{name: pressed}, {name: springs, analysis: {end: 0.02}, loads: {tractions: []}}]') | sed 's/transfer}}/transfer}, f: {reaction: y, of: {boundary: floor}}}/' >springs.yaml
expect "a load ends above a floor" 0 "$talus" run springs.yaml --out springs --force --quiet
awk -F, '$3 == 1 { p = $5; lost = $6 } $3 == 2 { exit !(($5 - p - 0.02 * $7)^2 < 1e-10 && ($6 - lost)^2 < 1e-6) }' springs/history.csv ||
  fail "$name: $(tail -n 2 springs/history.csv)"

# A body that comes in a mesh brings its velocity, meets what is there as it comes, and falls from its first step on.
(sed 's/points_per_cell: 4/&, velocity: [0, -2]/' jumps.yaml && echo 'loads: {gravity: [0, -10]}
stages: [{name: falls}, {name: comes, analysis: {end: 0.1}, bodies: [{name: above, absent: false}]}]') | sed 's/max: \[3, 1\]/max: [3, 5]/
s/^bodies: \[\(.*\)\]$/bodies:\n  - \1\n  - {name: above, shape: {box: {min: [0, 3], max: [1, 4]}}, points_per_cell: 4, material: rubber, absent: true, velocity: [0, -2], spin: 1, spin_centre: [0.5, 3.5]}/
s/transfer}}/transfer}, pu: {momentum: y, of: {body: above}}, spin: {spin: z, of: {body: above}}}/' >comes.yaml
sed 's/min: \[0, 3\], max: \[1, 4\]/min: [0, 1], max: [1, 2]/; s/, spin: 1, spin_centre: .0.5, 3.5.//' comes.yaml >onto.yaml
expect "a body comes with its velocity" 0 "$talus" run comes.yaml --out comes --quiet
awk -F, 'END { exit !(($5 + 7000)^2 < 1e-6 && ($7 + 3000)^2 < 1e-6 && ($8 - 1)^2 < 1e-4) }' comes/history.csv || fail "$name: $(tail -n 1 comes/history.csv)"
expect "and onto another one, on 2" 0 on_ranks 2 "$talus" run onto.yaml --out onto --quiet
# 1000 kg with 3 m/s, 1250 kg with 2 m/s in cells that the fall has stretched, and 0.02 s of their weight
awk -F, '$3 == 2 && !first { first = $5 } END { exit !((first + 5950)^2 < 1e-6 && $6 > 0) }' onto/history.csv || fail "$name: $(tail -n 5 onto/history.csv)"

# Nor do points that come bring half a step of what acts on them: alone, beside nodes of another body, two at once as
# gravity doubles.
sed 's/method: fem/method: mpm/; s/step: 0.02/&, transfer: thesis/' comes.yaml >falling.yaml
sed 's/method: fem/method: mpm/; s/step: 0.02/&, transfer: thesis/' onto.yaml >beside.yaml
sed 's/^  - {name: above.*/&\n  - {name: left, shape: {box: {min: [-1, 3], max: [-0.5, 4]}}, material: rubber, absent: true}/
  s/{name: above, absent: false}/&, {name: left, absent: false}/; s/name: comes,/& loads: {gravity: [0, -20]},/; s/min: \[-1, -3\]/min: [-2, -3]/' falling.yaml >both.yaml
jumps falling analysis.bossak=-0.1 -7000 5
jumps falling 'basis={cell: {}}' -3000 7
jumps beside method=mpm -7000 5
jumps both method=mpm -10000 5

# What the state before the first step was like is so in later stages, too, and in a run that is resumed in one of them.
cat >given.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [6, 3]}, size: 0.5}
bodies:
  - {name: ground, shape: {polygon: [[0, 0], [6, 0], [6, 2], [3, 2], [3, 3], [0, 3]]}, material: soil, k0: 0.5}
  - {name: cut, shape: {box: {min: [3, 2], max: [4, 3]}}, material: soil, k0: 0.5}
materials:
  soil: {law: mohr-coulomb, density: 2000, young: 2e7, poisson: 0.3, friction_angle: 30, cohesion: 5e3, dilatancy_angle: 5}
boundary: [{on: {y: 0}, fix: [x, y]}, {on: {x: 0}, fix: [x]}, {on: {x: 6}, fix: [x]}]
loads: {gravity: [0, -10]}
measures: {moved: {initial: moved}, lacked: {initial: lacked}, beyond: {initial: beyond}, left: {initial: left}}
checkpoint: {steps: 1, keep: 9}
stages: [{name: rest}, {name: dig, bodies: [{name: cut, absent: true}]}, {name: wait}]
END
for ranks in 1 2; do
  expect "the given state on $ranks" 0 on_ranks $ranks "$talus" run given.yaml --out given$ranks
  awk -F, 'NR == 2 { first = $4 $5 $6 $7; moved = $4 } NR > 1 && $4 $5 $6 $7 != first { exit 1 } END { exit !(moved > 1e-5 && NR > 6) }' given$ranks/history.csv ||
    fail "$name: $(cut -d, -f3- given$ranks/history.csv)"
done
cp given1/history.csv whole.csv
rm given1/timings.txt given1/checkpoint_*5.h5 given1/checkpoint_*6.h5
expect "the given state, resumed" 0 "$talus" run --resume given1 --quiet
cmp -s whole.csv given1/history.csv || fail "$name: $(cut -d, -f3- given1/history.csv)"

# A law that has no state without stress begins with the stresses of another run, which need not be given once more; a body that comes needs its own
cat >clay.yaml <<'END'
kinematics: plane-strain
method: fem
formulation: mean-dilatation
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [2, 3]}, size: 0.5}
bodies:
  - {name: clay, shape: {box: {min: [0, 0], max: [2, 2]}}, material: clay, k0: 0.6}
materials: {clay: {law: modified-cam-clay, density: 2000, lambda: 0.1, kappa: 0.02, critical_stress_ratio: 1, specific_volume: 2, shear_modulus: 1e6, ocr: 2}}
boundary: [{on: {y: 0}, fix: [x, y]}, {on: {x: 0}, fix: [x]}, {on: {x: 2}, fix: [x]}]
loads: {gravity: [0, -10]}
measures: {weight: {reaction: y, of: {boundary: 0}}, stress: {stress: yy}}
END
sed 's/, k0: 0.6//; s/^analysis.*/&\ninitial: {run: clay}/' clay.yaml >later.yaml
ranks=2
for method in fem mpm; do
  expect "clay, $method" 0 "$talus" run clay.yaml --out clay --force --set method=$method
  expect "clay from another run, $method on $ranks" 0 on_ranks $ranks "$talus" run later.yaml --out later --force --set method=$method
  awk -F, 'NR > 2 && ($3 > 80001 || $3 < 79999 || $4 > -19999 || $4 < -20001) { exit 1 }' later/history.csv || fail "$name: $(cat later/history.csv)"
  ranks=1
done
sed 's/^  - {name: clay.*/&\n  - {name: more, shape: {box: {min: [0, 2], max: [2, 2.5]}}, material: clay}/' later.yaml >more.yaml
# Overconsolidated clay that is pulled out of 100 kPa bears a tension along y
sed -e 's/k0: 0.6/stress: {xx: -1e5, yy: -1e5, zz: -1e5}/; s/ocr: 2/ocr: 20/; s/^loads.*/loads: {pressures: [{on: {body: clay, x: 2}, value: 1e5, amplitude: [[0, 1], [1, 1]]}]}/' -e 's/^kinematics.*/kinematics: axisymmetric/' \
  -e 's/^boundary.*/boundary: [{on: {y: 0}, fix: [y]}, {on: {x: 0}, fix: [x]}, {on: {y: 2}, displacement: {y: 0.12}}]/' -e 's/^analysis.*/analysis: {type: static, steps: 10}/' clay.yaml >pulled.yaml
turn 11
expect "clay that is pulled on $ranks" 0 on_ranks $ranks "$talus" run pulled.yaml --out pulled --force
says err.txt "100 % of 'clay' is pulled at the end"
expect "clay that is pressed" 0 "$talus" run pulled.yaml --out pulled --force --set 'boundary[2].displacement.y=-0.12'
lacks err.txt "is pulled"
expect "clay that comes" 2 "$talus" run more.yaml --out more --set method=mpm
says err.txt "'more' is of modified-cam-clay, which has no state without stress"

# What bears its weight by another law becomes clay in a stage, with the stress that it has; clay that comes needs its own.
sed 's/material: clay, k0: 0.6/material: rock, k0: 0.6/; s/^materials: {/&rock: {law: neo-hookean, density: 2000, young: 1e8, poisson: 0.3}, /' clay.yaml >placed.yaml
cat >>placed.yaml <<'END'
stages:
  - name: placed
  - {name: clay, bodies: [{name: clay, material: clay}]}
END
for method in fem mpm; do
  expect "clay in a stage, $method" 0 "$talus" run placed.yaml --out placed --force --set method=$method
  awk -F, 'NR > 2 && ($4 > 80001 || $4 < 79999 || $5 > -19999 || $5 < -20001) { exit 1 }' placed/history.csv || fail "$name: $(cat placed/history.csv)"
done
# How clay begins is no number that could change while it is there.
expect "clay that has been pressed by more, in a stage" 2 "$talus" check clay.yaml --set 'stages=[{name: a}, {name: b, materials: {clay: {ocr: 3}}}]'
says err.txt "ocr says how points begin, and those of 'clay' have a state: it would change nothing"
expect "with time" 2 "$talus" check clay.yaml --set 'materials.clay.amplitude={ocr: [[0, 1], [1, 2]]}'
says err.txt "ocr says how points of the law modified-cam-clay begin, and cannot change with time"
expect "clay that comes in a stage" 2 "$talus" check placed.yaml --set 'stages[1].bodies[1]={name: more, shape: {box: {min: [0, 2], max: [2, 2.5]}}, material: clay}'
says err.txt "'more' is of modified-cam-clay, which has no state without stress"

# What is named at the top and comes with a stage moves from that stage on, wherever its words stand: by 0.01 of a column
# without Poisson's ratio, mu (l - 1 / l) = -100505 N. It comes, goes and comes back.
cat >late.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.25}
bodies: [{name: column, shape: {box: {min: [0, 0], max: [1, 1]}}, material: soft}]
materials: {soft: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0}}
boundary:
  - {name: bottom, on: {boundary: bottom}, fix: [y]}
  - {name: left, on: {boundary: left}, fix: [x]}
  - {name: top, on: {boundary: top}, displacement: {y: -0.01}, absent: true}
walls: [{name: press, shape: {box: {min: [-1, 1], max: [2, 2]}}, motion: [{velocity: {y: -0.01}}], absent: true}]
measures: {top: {reaction: y, of: {boundary: top}}, press: {wall_force: y, of: {wall: press}}, force: {formula: top + press}}
stages:
  - {name: nothing}
  - {name: nothing-else}
  - {name: comes, boundary: [{name: top, absent: false}]}
  - {name: goes, boundary: [{name: top, absent: true}]}
  - {name: comes-again, boundary: [{name: top, absent: false}]}
END
bears() { # the force at the ends of stages 3 and 5
  awk -F, '$2 == 3 || $2 == 5 { n += 1; if (!($6 > -100510 && $6 < -100450)) bad = 1 } END { exit bad || n != 2 }' late/history.csv ||
    fail "$name: $(cat late/history.csv)"
}
expect "a side that comes" 0 "$talus" run late.yaml --out late --quiet
bears
sed 's/boundary: \[{name: top/walls: [{name: press/' late.yaml >late_wall.yaml
for way in "fem 3" "mpm 1"; do
  set -- $way
  expect "a wall that comes, $1 on $2" 0 on_ranks $2 "$talus" run late_wall.yaml --out late --force --quiet --set method=$1
  bears
done
# Stresses stay when elastic constants change, by a stage or by an amplitude, whatever the law: a loaded square stays where it is
cat >ages.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 4}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}
bodies: [{name: square, shape: {box: {min: [0, 0], max: [1, 1]}}, material: metal}]
materials: {metal: {law: j2, density: 1, young: 1e7, poisson: 0.3, yield_stress: 1e9}}
boundary: [{on: {boundary: bottom}, fix: [y]}, {on: {boundary: left}, fix: [x]}]
loads: {tractions: [{on: {boundary: top}, value: [0, -1e4], amplitude: [[0, 0], [0.25, 1]]}]}
measures: {u: {displacement: y, of: {tracer: [0.5, 1]}}, across: {stress: zz}}
END
hard='{name: hard, materials: {metal: {young: 2e7}}}, {name: dense, materials: {metal: {poisson: 0.45}}}'
for law in j2 j2-log neo-hookean-split; do
  metal="{law: $law, density: 1, young: 1e7, poisson: 0.3$([ $law = neo-hookean-split ] || echo ', yield_stress: 1e9')}"
  # in stages that change them and one in which they change, and in a case without stages
  for way in "stages=[{name: soft}, $hard, {name: softer, materials: {metal: {amplitude: {young: [[0, 1], [0.5, 0.5]]}}}}]" \
    "materials.metal.amplitude={young: [[0.25, 1], [0.5, 2]]}"; do
    [ $law = j2 ] || [ "${way%%=*}" = stages ] || continue
    expect "$law ages, ${way%%=*}" 0 "$talus" run ages.yaml --out ages --force --quiet --set "materials.metal=$metal" --set "$way"
    awk -F, -v from=$(head -n 1 ages/history.csv | awk -F, '{ print NF - 1 }') 'NR > 2 { u = $from; s = $NF; if (u > -9.085e-4 || u < -9.095e-4 || s > -2995 || s < -3005) { print; bad = 1 } } END { exit bad || NR < 5 }' ages/history.csv ||
      fail "$name: $(cat ages/history.csv)"
  done
done

# Weight of two layers of different density, over the whole and over each: no stress is off it
cat >layers.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1, 3]}, size: 0.25}
bodies:
  - {name: low, shape: {box: {min: [0, 0], max: [1, 1]}}, material: heavy, k0: 0.5}
  - {name: high, shape: {box: {min: [0, 1], max: [1, 2]}}, material: light, k0: 0.5}
materials:
  heavy: {law: mohr-coulomb, density: 2000, young: 1e7, poisson: 0.3, friction_angle: 30, cohesion: 1e3}
  light: {law: mohr-coulomb, density: 1500, young: 1e7, poisson: 0.3, friction_angle: 30, cohesion: 1e3}
boundary: [{on: {boundary: bottom}, fix: [y]}, {on: {boundary: left}, fix: [x]}, {on: {boundary: right}, fix: [x]}]
loads: {gravity: [0, -10]}
measures: {all: {overburden: largest}, low: {overburden: largest, of: {body: low}}, high: {overburden: largest, of: {body: high}}}
END
expect "layers on 2" 0 on_ranks 2 "$talus" run layers.yaml --out layers --quiet
awk -F, 'END { for (k = 3; k <= 5; ++k) if (!($k < 1e-9)) exit 1 }' layers/history.csv || fail "$name: $(tail -n 1 layers/history.csv)"
# A body without a shape would weigh nothing there
cat >ground.geo <<'END'
Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {1, 1, 0, 1}; Point(4) = {0, 1, 0, 1};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Physical Surface("ground") = {1};
END
expect "a layer without a shape" 2 "$talus" run layers.yaml --out layers --force --quiet --set 'bodies[1]={name: high, mesh: ground.geo, material: light, points_per_cell: 3}'
says err.txt "the weight of level layers is that of their shapes, and 'high' has none"
# What moves, and when: statics have no motion, and what comes with a stage brings its own into the accounts.
cat >comes.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 0.01, steps: 1}
grid: {box: {min: [0, 0], max: [1, 3]}, size: 0.25}
bodies:
  - {name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: e}
  - {name: c, shape: {box: {min: [0, 2], max: [1, 2.5]}}, material: e, velocity: [0, -1], absent: true}
materials: {e: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}}
boundary:
  - {name: bottom, on: {boundary: bottom}, fix: [x, y]}
  - {name: left, on: {boundary: left}, fix: [x]}
  - {name: right, on: {boundary: right}, fix: [x]}
walls:
  - {name: ball, shape: {box: {min: [-0.5, 1.25], max: [1.5, 1.75]}}, mass: {mass: 100, velocity: [0, -1], free: [y]}, absent: true}
stages:
  - {name: one}
  - {name: two, analysis: {type: dynamic, end: 0.01, step: 1e-3}, walls: [{name: ball, absent: false}], bodies: [{name: c, absent: false}]}
measures: {ek: {energy: kinetic}, balance: {energy: balance}}
output: {fields: [displacement], every: end}
END
# 250 J of a body and 50 of a wall, from a stage of statics and from one of dynamics.
ranks=1
for first in static dynamic; do
  expect "comes after $first, $ranks" 0 on_ranks $ranks "$talus" run comes.yaml --out comes --force --quiet --set "analysis={type: $first, end: 0.01, step: 0.01}"
  ! grep -q "no effect here" err.txt || fail "$name: $(cat err.txt)"
  awk -F, 'END { exit !(($4 - 300) ^ 2 < 1e-8 && $5 * $5 < 1e-16) }' comes/history.csv || fail "$name: $(tail -n 1 comes/history.csv)"
  ranks=2
done
expect "moves in statics" 0 "$talus" run comes.yaml --out comes --force --quiet --set 'bodies[0].velocity=[0, -1]'
says err.txt "bodies[0].velocity has no effect here: statics has no inertia"
awk -F, 'NR == 2 { first = $4 } END { exit !(first == 0 && ($4 - 300) ^ 2 < 1e-8 && $5 * $5 < 1e-16) }' comes/history.csv || fail "$name: $(cat comes/history.csv)"
# An equilibrium minds no wall with mass that comes later.
expect "a wall that comes after an equilibrium" 0 "$talus" check comes.yaml --set 'bodies[0].k0=0.5' --set 'loads={gravity: [0, -10]}'
expect "and bodies that come and move" 0 "$talus" check comes.yaml --set initial.equilibrium=direct --set 'loads={gravity: [0, -10]}'
expect "a wall that is there" 2 "$talus" check comes.yaml --set 'bodies[0].k0=0.5' --set 'loads={gravity: [0, -10]}' --set 'walls[0].absent=false'
says err.txt "comes.yaml:$(grep -n 'mass:' comes.yaml | cut -d: -f1):" "error: an initial equilibrium knows nothing of walls with mass, as 'ball' is" "until then"

# Bonds that a stage brings hold all that touches as it begins, whatever the last digits of gaps: a block that slid on a
# wall, or on another block, without weight (it slid on, or was held by a part of its foot, by one stage or another).
cat >bonds.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, step: 0.00390625}
grid: {box: {min: [1, 0.5], max: [2, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [1, 0.5], max: [2, 1]}}, points_per_cell: 4, material: m, velocity: [3, 0]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls: [{name: w, shape: {half-space: {point: [0, 0.5], normal: [0, 1]}}}]
measures: {area: {contact: area, of: {wall: w}}, px: {momentum: x, of: {body: b}}}
output: {history: {steps: 1}}
stages:
  - {name: slides}
  - {name: held, analysis: {end: 0.00390625}, walls: [{name: w, shape: {half-space: {point: [0, 0.5], normal: [0, 1]}}, contact: bonded}]}
END
sed -e '/^walls/d' -e '/^stages/,$d' -e 's/^grid.*/grid: {box: {min: [1, 0], max: [2, 1]}, size: 0.25}/' \
  -e '/^bodies/s/]$/, {name: l, shape: {box: {min: [1, 0], max: [2, 0.5]}}, points_per_cell: 4, material: m}]/' \
  -e 's/contact: area, of: {wall: w}/interface: area, of: {interface: w}/' bonds.yaml >bonds_bodies.yaml
cat >>bonds_bodies.yaml <<'END'
boundary: [{on: {y: 0}, fix: [x, y]}]
interfaces: [{name: w, between: [b, l]}]
stages:
  - {name: slides}
  - {name: held, analysis: {end: 0.00390625}, interfaces: [{name: w, between: [b, l], contact: bonded}]}
END
# After so many steps, which case, on how many ranks; its settings. Of 1 m of foot a step and those before have taken
# 3/256 m each past the end of the other block.
bonded() {
  at=$1 file=$2 ranks=$3
  shift 3
  expect "bonds after $at steps, $file, $ranks, $*" 0 on_ranks "$ranks" "$talus" run "$file.yaml" --out bonds --force --quiet "$@"
  awk -F, -v at="$at" -v past="$([ "$file" = bonds ] && echo 0 || echo 0.01171875)" '
    $3 == 2 && !n++ && (($4 - 1 + at * past) ^ 2 > 0.015 ^ 2 || !($5 < 1480)) { exit 1 } END { if (!n) exit 1 }' bonds/history.csv ||
    fail "$name: $(awk -F, '$3 == 2' bonds/history.csv | head -n 1)"
}
box='grid.box={min: [0, 0], max: [4, 2]}'
for at in 8 17; do
  end="end: $(awk -v at=$at 'BEGIN { printf "%.8f", at / 256 }'), step: 0.00390625"
  for file in bonds bonds_bodies; do
    # one case on two ranks after few steps, the other after many
    bonded $at $file $([ $file$at != bonds8 ] && [ $file$at != bonds_bodies17 ] && echo 1 || echo 2) --set "analysis={type: dynamic, $end}"
    bonded $at $file 1 --set method=gmm --set "analysis={type: dynamic, $end}"
    bonded $at $file 1 --set method=mpm --set "$box" --set "analysis={type: dynamic, scheme: newmark, transfer: thesis, $end}"
  done
  bonded $at bonds 1 --set method=mpm --set "$box" --set "analysis={type: explicit, $end}"
done
# What is within 1e-4 of a cell is held and what is farther is not, by a wall that comes, too.
for absent in false true; do
  for wall in 0.499985:1 0.49996:0; do
    expect "bonds at ${wall%:*}, absent before: $absent" 0 "$talus" run bonds.yaml --out bonds --force --quiet --set "walls[0].absent=$absent" \
      --set 'analysis={type: dynamic, end: 0.015625, step: 0.00390625}' \
      --set "stages[1].walls=[{name: w, absent: false, shape: {half-space: {point: [0, ${wall%:*}], normal: [0, 1]}}, contact: bonded}]"
    awk -F, -v area="${wall#*:}" '$3 == 2 && !n++ && ($4 - area) ^ 2 > 1e-6 { exit 1 } END { if (!n) exit 1 }' bonds/history.csv ||
      fail "$name: $(awk -F, '$3 == 2' bonds/history.csv | head -n 1)"
  done
done
# Bonded walls hold what a stage brings to them, too, though something else has been bonded there before: it is held on all
# of its foot, and goes on as if all had begun then (without a word it fell, or slid on as if nothing were there).
cat >lands.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.015625, step: 0.00390625}
grid: {box: {min: [1, 0.5], max: [3.5, 1]}, size: 0.25}
bodies:
  - {name: s, shape: {box: {min: [3, 0.5], max: [3.5, 1]}}, points_per_cell: 4, material: m}
  - {name: b, shape: {box: {min: [1, 0.5], max: [2, 1]}}, points_per_cell: 4, material: m, velocity: [3, 2]}
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls: [{name: w, shape: {half-space: {point: [0, 0.5], normal: [0, 1]}}, contact: bonded}]
measures: {area: {contact: area, of: {wall: w}}, px: {momentum: x, of: {body: b}}, py: {momentum: y, of: {body: b}}, f: {wall_force: y, of: {wall: w}}}
output: {history: {steps: 1}}
END
sed 's/, velocity: \[3, 2\]/&, absent: true/' lands.yaml >lands_late.yaml
echo 'stages: [{name: one}, {name: two, bodies: [{name: b, absent: false}]}]' >>lands_late.yaml
# How far from one another, kg m/s; ranks; its settings.
lands() {
  near=$1 ranks=$2
  shift 2
  expect "what begins on a bonded wall, $ranks, $*" 0 on_ranks "$ranks" "$talus" run lands.yaml --out lands --force --quiet "$@"
  expect "what comes to it, $ranks, $*" 0 on_ranks "$ranks" "$talus" run lands_late.yaml --out late --force --quiet "$@"
  awk -F, -v near="$near" 'NR > 1 && FNR == NR { x[$2] = $(NF - 2); y[$2] = $(NF - 1) }
    NR > FNR && $3 == 2 { n += 1; if (($4 - 1.5) ^ 2 > 0.015 ^ 2 || ($5 - x[$2 - 4]) ^ 2 + ($6 - y[$2 - 4]) ^ 2 > near ^ 2) bad = 1 }
    END { exit bad || n != 4 }' lands/history.csv late/history.csv ||
    fail "$name: $(cut -d, -f3- lands/history.csv late/history.csv | tr '\n' ' ')"
}
lands 1e-5 2
lands 1e-5 1 --set method=mpm --set "$box"
lands 1e-5 1 --set method=mpm --set "$box" --set 'analysis={type: dynamic, end: 0.015625, step: 0.00390625, transfer: thesis}' --set 'stabilisation={follow: 0.02, curvature: 0.1}'
lands 1e-5 1 --set method=mpm --set "$box" --set 'analysis={type: explicit, end: 0.015625, step: 0.00390625}'
for method in fem mpm; do
  expect "and in statics it hangs, $method" 0 "$talus" run lands_late.yaml --out late --force --quiet --set method=$method --set "$box" \
    --set 'analysis={type: static, steps: 1}' --set 'stages[1].loads={gravity: [0, 10]}'
  awk -F, 'END { exit !(($7 + 7500) ^ 2 < 1e-4) }' late/history.csv || fail "$name: $(cat late/history.csv)"
done
# Nothing touches the wall before: it waits for what comes, unless that comes beside it.
expect "a bonded wall that waits" 0 "$talus" run lands_late.yaml --out late --force --set 'walls[0].bodies=[b]'
lacks err.txt "nothing touches"
expect "and what comes beside it" 0 "$talus" run lands_late.yaml --out late --force --set 'walls[0].bodies=[b]' --set 'walls[0].shape.half-space.point=[0, 0.4]'
says err.txt "nothing touches wall 'w' at the start of the stage"

# By the midpoint rule, too, what a stage brings to a wall, moving, takes over the wall's velocity, as what is there from
# the start: it rang for ever, 9541, 0, 2031, 15186, 0, 12319 N for 22455, 1880, 2922, 3785, 4468, 4889.
cat >rings.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.003, step: 0.001}
grid: {box: {min: [-0.25, -0.25], max: [2.15, 1.15]}, size: 0.1}
stabilisation: {follow: 0.02, curvature: 0.1}
bodies:
  - {name: a, shape: {box: {min: [1.5, 0], max: [1.8, 0.3]}}, material: m}
  - {name: b, shape: {box: {min: [0.3, 0.3], max: [0.8, 0.6]}}, material: m, velocity: [0, -1]}
materials: {m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
walls: [{name: w, shape: {half-space: {point: [0, 0.3], normal: [0, 1]}}, bodies: [b]}]
measures: {f: {wall_force: y, of: {wall: w}}}
output: {history: {steps: 1}}
END
sed 's/, velocity: \[0, -1\]/&, absent: true/' rings.yaml >rings_late.yaml
echo 'stages: [{name: one}, {name: two, bodies: [{name: b, absent: false}]}]' >>rings_late.yaml
ranks=1
for basis in gimp bspline; do
  for file in rings rings_late; do
    expect "$file, $basis on $ranks" 0 on_ranks $ranks "$talus" run $file.yaml --out $file --force --quiet --set "basis={$basis: {}}"
  done
  awk -F, 'NR > 1 && FNR == NR { f[$2] = $NF } NR > FNR && $3 == 2 { n += 1; if (($NF / f[$2 - 3] - 1) ^ 2 > 1e-11) bad = 1 } END { exit bad || n != 3 }' \
    rings/history.csv rings_late/history.csv || fail "$name: $(cat rings/history.csv rings_late/history.csv)"
  ranks=2
done

# So does what a reset has brought to rest before a wall that goes on: a bar that a plate pushes, whose wave is 39.5 N.
cat >rests.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.004, step: 0.001}
grid: {box: {min: [-0.5, -0.25], max: [2.5, 0.5]}, size: 0.125}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [2, 0.125]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}}
walls: [{name: w, shape: {half-space: {point: [0, 0], normal: [1, 0]}}, motion: [{velocity: {x: 0.01}}]}]
measures: {f: {wall_force: x, of: {wall: w}}}
output: {history: {steps: 1}}
stages: [{name: one}, {name: two, reset: [velocity], analysis: {type: dynamic, end: 0.012, step: 0.001}}]
END
expect "what begins anew before a plate" 0 "$talus" run rests.yaml --out rests --force --quiet
awk -F, 'NR > 13 && ($NF < 38 || $NF > 42) { bad = 1 } END { exit bad || NR != 18 }' rests/history.csv || fail "$name: $(cat rests/history.csv)"

# What is released bit by bit is what a stage changes: a body in flight goes on falling (it hung in the air, and was let go
# in proportion to time), whatever else comes, goes, or begins to push.
cat >flies.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.02, step: 0.004}
grid: {box: {min: [0, 0], max: [4, 2]}, size: 0.25}
bodies:
  - {name: b, shape: {box: {min: [1, 1], max: [1.5, 1.5]}}, points_per_cell: 4, material: m}
  - {name: s, shape: {box: {min: [3, 0], max: [3.5, 0.5]}}, points_per_cell: 4, material: m}
  - {name: l, shape: {box: {min: [3, 1], max: [3.5, 1.5]}}, points_per_cell: 4, material: m, absent: true}
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {y: 0}, fix: [x, y]}]
loads: {gravity: [0, -10]}
measures: {p: {momentum: y, of: {body: b}}}
output: {history: {steps: 1}}
stages: [{name: one}, {name: two, release: 0.01}]
END
flies() { # its settings
  turn 11
  expect "what flies flies on, on $ranks, $*" 0 on_ranks $ranks "$talus" run flies.yaml --out flies --force --quiet "$@"
  awk -F, 'NR > 1 && ($4 + 2500 * $1) ^ 2 > 1e-8 { bad = 1 } END { exit bad || $3 != 2 }' flies/history.csv || fail "$name: $(cut -d, -f1,3- flies/history.csv)"
}
flies --set 'stages[1].bodies=[{name: s, absent: false}]'
late='stages[1].bodies=[{name: l, absent: false}]'
flies --set "$late"
flies --set "$late" --set method=mpm
flies --set "$late" --set method=mpm --set analysis.transfer=thesis
flies --set "$late" --set method=mpm --set 'analysis={type: explicit, end: 0.02, step: 0.004}'
# Where a body goes inertia is known to those that remember accelerations.
flies --set 'stages[1].bodies=[{name: s, absent: true}]'
flies --set 'stages[1].bodies=[{name: s, absent: true}]' --set method=mpm --set analysis.transfer=thesis

# A body of fem that comes with another run falls from its first step on, though walls stand somewhere.
sed -e '/^stages/d; s/^loads.*//; s/, absent: true//; /name: b/d; s/of: {body: b}/of: {body: s}/' flies.yaml >stood.yaml
sed -e '/^stages/,$d; s/, absent: true//; /name: b/d; s/of: {body: b}/of: {body: l}/' flies.yaml >falls_late.yaml
echo 'initial: {run: stood}' >>falls_late.yaml
for file in stood falls_late; do echo 'walls: [{name: w, shape: {half-space: {point: [0, -1], normal: [0, 1]}}}]' >>$file.yaml; done
sed -i '/name: l,/d' stood.yaml
expect "what stood" 0 "$talus" run stood.yaml --out stood --quiet
expect "what falls beside it, on 2" 0 on_ranks 2 "$talus" run falls_late.yaml --out falls_late --quiet
awk -F, 'NR > 1 && ($3 + 2500 * $1) ^ 2 > 1e-8 { bad = 1 } END { exit bad || NR < 7 }' falls_late/history.csv || fail "$name: $(cut -d, -f1,3- falls_late/history.csv)"

# So does what another run hands over: what falls has the way of gravity from its first step on, what is let go its momentum.
(sed '/^stages/,$d' drop.yaml && echo 'initial: {run: flight}
loads: {gravity: [0, -10]}') | sed 's/end: 0.04/end: 0.1/; s/, velocity: \[0, 1\]//' >goes.yaml
sed '/^stages/,$d' drop.yaml >flight.yaml
for scheme in "method=mpm" "analysis.transfer=thesis" "method=fem"; do
  turn 11
  expect "a run that flies, $scheme" 0 "$talus" run flight.yaml --force --quiet --out flight --set "$scheme"
  expect "one that falls, $scheme on $ranks" 0 on_ranks $ranks "$talus" run goes.yaml --force --quiet --out goes --set "$scheme"
  tail -n 1 goes/history.csv | cut -d, -f3 | awk '{ exit !(($1 - 0.05)^2 < 1e-18) }' || fail "$name: $(tail -n 1 goes/history.csv)"
done
sed '/^stages/d; s/gmm/&/' cloud.yaml >flight.yaml
sed '/^stages/d; s/^loads.*/initial: {run: flight}/' cloud.yaml >goes.yaml
# One whose case was changed since gives no jump, and says so; one of a cloud is refused.
for method in gmm fem; do
  expect "a run that is pushed, $method" 0 "$talus" run flight.yaml --force --quiet --out flight --set method=$method
  expect "one that flies, $method" 0 "$talus" run goes.yaml --force --quiet --out goes --set method=$method
  awk -F, 'END { exit !(($3 - 100)^2 < 1e-10) }' goes/history.csv || fail "$name: $(tail -n 1 goes/history.csv)"
  sed -i 's/^measures:.*/&\n  another: {momentum: y}/' flight/case.yaml
  expect "a run that was changed, $method" $([ $method = fem ] && echo 0 || echo 2) "$talus" run goes.yaml --force --quiet --out goes --set method=$method
  says err.txt "the measures of the case are not those of the run"
done

# What the floor bears in a state that another run hands over is known before the first step, by all methods.
cat >rests.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [2, 2]}, size: 0.25}
bodies: [{name: block, shape: {box: {min: [0.5, 0], max: [1.5, 1]}}, points_per_cell: 4, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
boundary: [{name: floor, on: {boundary: bottom}, fix: [x, y]}]
loads: {gravity: [0, -10]}
measures: {weight: {reaction: y, of: {boundary: floor}}}
END
sed '$a initial: {run: rests}' rests.yaml >goes.yaml
for method in fem gmm mpm; do
  expect "what rests, $method" 0 "$talus" run rests.yaml --force --quiet --out rests --set method=$method
  for next in "{type: static, steps: 2}" "{type: dynamic, step: 0.01, end: 0.02}"; do
    turn 11
    expect "a run out of it, $method, $next on $ranks" 0 on_ranks $ranks "$talus" run goes.yaml --force --quiet --out goes --set method=$method --set "analysis=$next"
    awk -F, 'NR > 1 && ($3 > 10050 || $3 < 9950) { exit 1 }' goes/history.csv || fail "$name: $(cat goes/history.csv)"
  done
done

# So is what a wall bears, and the first step of a run out of dynamics begins with it.
sed '/^boundary/d; /^initial/d; s/^measures.*/walls: [{name: floor, shape: {half-space: {point: [0, 0.25], normal: [0, 1]}}, friction: 0.5}]\nmeasures: {weight: {wall_force: y, of: {wall: floor}}}/; s/min: \[0.5, 0\], max: \[1.5, 1\]/min: [0.5, 0.25], max: [1.5, 1.25]/; s/young: 1e5/young: 1e6/' rests.yaml >stands.yaml
for method in mpm fem gmm; do
  expect "what stands, $method" 0 "$talus" run stands.yaml --force --quiet --out before --set method=$method
  for next in "{type: dynamic, step: 0.01, end: 0.02}" "{type: dynamic, step: 0.01, end: 0.03}"; do
    turn 11
    expect "a run on a wall, $method, $next on $ranks" 0 on_ranks $ranks "$talus" run stands.yaml --force --quiet --out goes --set method=$method --set "analysis=$next" --set initial.run=before
    awk -F, 'NR > 1 && ($3 > 10050 || $3 < 9950) { exit 1 }' goes/history.csv || fail "$name: $(cat goes/history.csv)"
    rm -rf before && mv goes before
  done
done

# Bodies find their state by their names (here that of the block of mpm, run last), and who finds none is told of.
expect "another name" 2 "$talus" run goes.yaml --force --out goes --set bodies[0].name=Block
says err.txt "error: the run of \`initial\` has no body 'Block': nothing of its state would go on" "hint: did you mean 'block'?"
more='bodies[1]={name: more, shape: {box: {min: [0.5, 1], max: [1.5, 1.25]}}, material: rubber}'
expect "one more" 0 "$talus" run goes.yaml --force --out goes --set "$more"
says err.txt "warning: the run of \`initial\` has no body 'more': it begins as it is drawn"
expect "two" 0 "$talus" run rests.yaml --force --quiet --out rests --set "$more"
expect "one less" 0 "$talus" run goes.yaml --force --out goes
says err.txt "warning: 'more' of that run is not among the bodies here: it stays behind"

# What has been dissipated is the account of the run that did it.
for method in mpm fem; do
  for run in rests goes; do
    expect "metal that yields, $run, $method" 0 "$talus" run $run.yaml --force --quiet --out $run --set method=$method --set 'measures={lost: {energy: dissipated}}' \
      --set 'materials.rubber={law: j2, density: 1000, young: 1e6, poisson: 0.3, yield_stress: 3e3, hardening: 1e5}'
  done
  [ "$(tail -n 1 rests/history.csv | awk -F, '{ print ($3 > 10) }')" = 1 ] || fail "$name: nothing yields"
  sed -n 2p goes/history.csv | awk -F, '{ exit !($3 ^ 2 < 1e-12) }' || fail "$name: $(sed -n 2p goes/history.csv)"
done

# Loads that the material carries go on out of another run as they do in a stage.
sed '/^loads/d; /^measures/d' rests.yaml >loaded.yaml
cat >>loaded.yaml <<'END'
stabilisation: {follow: 0.02} # a dynamic case without stages has another one
loads: {tractions: [{on: {body: block, y: 1}, value: [2000, -3000]}], pressures: [{on: {body: block, x: 1.5}, value: 1000}], points: [{at: [0.8, 0.4], force: [100, 0]}]}
measures: {x: {reaction: x, of: {boundary: floor}}, y: {reaction: y, of: {boundary: floor}}}
END
for method in fem gmm mpm; do
  for next in "{type: static, steps: 2}" "{type: dynamic, step: 0.01, end: 0.02}"; do
    turn 11
    expect "more of it in a stage, $method, $next" 0 "$talus" run loaded.yaml --force --quiet --out stage --set method=$method --set "stages=[{name: a}, {name: b, analysis: $next}]"
    expect "out of a run, $method, $next on $ranks" 0 on_ranks $ranks "$talus" run loaded.yaml --force --quiet --out goes --set method=$method --set "analysis=$next" --set 'initial={run: stage, stage: a}'
    for row in 2 4; do
      sed -n ${row}p goes/history.csv | awk -F, -v is="$(sed -n $((row + 2))p stage/history.csv | cut -d, -f4,5)" '{ split(is, a, ","); exit !(($3 / a[1] - 1) ^ 2 < 1e-10 && ($4 / a[2] - 1) ^ 2 < 1e-10) }' ||
        fail "$name: $(cat goes/history.csv stage/history.csv)"
    done
  done
done
expect "another grid" 2 "$talus" run loaded.yaml --force --out goes --set initial.run=stage --set grid.size=0.2
says err.txt "walls, interfaces or loads on bodies it needs the same one"

# What flew is caught by nodes that another run holds: its momentum is what they give and gravity, from the first step on.
cat >flight.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, step: 0.01, end: 0.02, scheme: newmark}
grid: {box: {min: [0, 0], max: [2, 2]}, size: 0.25}
bodies: [{name: block, shape: {box: {min: [0.5, 0.5], max: [1.5, 1]}}, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
loads: {gravity: [0, -10]}
END
sed '$a boundary: [{on: {y: [0.7, 1.01]}, fix: [x, y]}]\ninitial: {run: flight}\nmeasures: {p: {momentum: y}, R: {reaction: y, of: {boundary: 0}}}' flight.yaml >caught.yaml
for method in mpm fem; do
  turn 11
  expect "what flies, $method" 0 "$talus" run flight.yaml --force --quiet --out flight --set method=$method
  expect "and is caught, $method on $ranks" 0 on_ranks $ranks "$talus" run caught.yaml --force --quiet --out caught --set method=$method
  awk -F, 'NR > 2 && ($3 - p - 0.01 * ($4 - 5000)) ^ 2 > 1e-12 { exit 1 } { p = $3 }' caught/history.csv || fail "$name: $(cat caught/history.csv)"
done

# A stage that repeats a table word for word goes on with its clock, and is told; with a further point it begins anew, and
# so it does where the case is read as it was written out.
cat >blows.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.3, step: 0.01}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 1}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
measures: {p: {momentum: y}}
output: {every: end}
stages:
  - {name: one, loads: {gravity: [0, -10], gravity_amplitude: [[0, 0], [0.1, 1], [0.2, 0]]}}
  - {name: two, loads: {gravity: [0, -10], gravity_amplitude: [[0, 0], [0.1, 1], [0.2, 0]]}}
END
expect "a blow that is repeated" 0 "$talus" check blows.yaml
says err.txt "it is word for word that of stage 'one', whose clock goes on: it is over when this stage begins"
says err.txt "by a further point, [0.3, 0]"
sed '$s/, \[0.2, 0\]/&, [0.3, 0]/' blows.yaml >two.yaml
cp two.yaml blows.yaml
for run in first again; do
  expect "two blows, $run" 0 "$talus" run blows.yaml --out $run --force --quiet
  lacks err.txt "word for word"
  awk -F, 'END { exit ($NF + 2000) ^ 2 > 1e-6 }' $run/history.csv || fail "$name: $(tail -n 1 $run/history.csv)"
  cp first/case.yaml blows.yaml
done
# A boundary that a stage brings with an acceleration has from its first step on the forces that it has where a run begins
# with it, whatever the scheme remembers; and one that goes on does not begin anew.
cat >given.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.01, step: 0.001, bossak: -0.3}
grid: {box: {min: [0.2, 0.1], max: [1, 0.5]}, size: 0.1}
bodies: [{name: b, shape: {box: {min: [0.2, 0.1], max: [1, 0.5]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
boundary: [{name: w, on: {x: 0.2}, velocity: {x: 1}, amplitude: [[0, 0], [0.03, 0.3]]}]
measures: {F: {reaction: x, of: {boundary: w}}, K: {energy: kinetic}}
output: {every: end}
END
sed '/^boundary/s/name: w, /&absent: true, /; /^measures/d' given.yaml >brought.yaml
echo "stages: [{name: waits, analysis: {end: 0.005}}, {name: goes, analysis: {end: 0.01}, $(sed -n '/^measures/p' given.yaml), $(sed -n '/^boundary/p' given.yaml)}]" >>brought.yaml
sed '/^boundary/s/absent: true, //; /^boundary/s/x: 1/x: 0/' brought.yaml >told.yaml
of=
for case in 'brought fem -0.3' 'told fem -0.3' 'brought fem -0.1' 'brought fem 0' 'brought mpm -0.3' 'told mpm -0.1'; do
  set -- $case
  turn 11
  [ "$of" = "$2 $3" ] || expect "given, $2 with $3" 0 "$talus" run given.yaml --out given --force --quiet --set method=$2 --set analysis.bossak=$3
  of="$2 $3"
  expect "$case, on $ranks" 0 on_ranks $ranks "$talus" run $1.yaml --out stage --force --quiet --set method=$2 --set analysis.bossak=$3
  awk -F, '$3 == 2 { print $4 "," $5 }' stage/history.csv >is.txt
  sed '1,2d' given/history.csv | cut -d, -f3,4 | paste -d, is.txt - |
    awk -F, '{ n += 1; if (($1 / $3 - 1) ^ 2 > 1e-14 || ($2 / $4 - 1) ^ 2 > 1e-14) exit 1 } END { exit n != 10 }' || fail "$name: $(paste is.txt given/history.csv)"
done

finish
