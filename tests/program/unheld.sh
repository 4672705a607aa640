#!/bin/sh
# Statics of bodies that smooth walls hold in some directions alone: `unheld: hold` sees to the others.
. "$(dirname "$0")/library.sh"

cat >block.yaml <<'EOF'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2, unheld: hold}
grid: {box: {min: [-0.2, -0.2], max: [0.8, 0.8]}, size: 0.1}
bodies: [{name: b, shape: {box: {min: [0.013, 0.017], max: [0.413, 0.317]}}, material: r}]
materials: {r: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0.3}}
walls: [{name: w, shape: {half-space: {point: [0, 0.017], normal: [0, 1]}}, contact: frictionless}]
loads: {gravity: [0, -9.81]}
measures: {fx: {wall_force: x, of: {wall: w}}, fy: {wall_force: y, of: {wall: w}}, tz: {wall_torque: z, of: {wall: w}, about: [0.213, 0.017]}}
output: {every: end}
EOF
# Its weight, in the middle of its foot.
rests() {
  awk -F, 'END { if (($3 ^ 2 > 1e-10) || (($4 - 1177.2) ^ 2 > 1e-10) || $5 ^ 2 > 1e-4) exit 1 }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"
}
for way in "gimp 2" "gimp 3" "cell 1" "bspline 1"; do
  set -- $way
  expect "a block on a smooth floor, $way" 0 on_ranks $2 "$talus" run block.yaml --out o --force --set basis=$1
  says err.txt "nothing holds 'b' in x: held in 1 direction(s) of nodes, which bear nothing"
  rests
done
expect "the same in fem" 0 "$talus" run block.yaml --out o --force --set method=fem --set 'bodies[0].shape={box: {min: [0, 0], max: [0.4, 0.3]}}' --set 'walls[0].shape={half-space: {point: [0, 0], normal: [0, 1]}}' --set 'measures.tz.about=[0.2, 0]'
rests
expect "in space" 0 "$talus" run block.yaml --out o --force --set kinematics=3d \
  --set 'grid={box: {min: [-0.2, -0.2, -0.2], max: [0.8, 0.8, 0.8]}, size: 0.1}' --set 'loads={gravity: [0, -9.81, 0]}' \
  --set 'bodies[0].shape={box: {min: [0.013, 0.017, 0.02], max: [0.413, 0.317, 0.22]}}' \
  --set 'walls[0].shape={half-space: {point: [0, 0.017, 0], normal: [0, 1, 0]}}' --set 'measures={fx: {wall_force: x, of: {wall: w}}, fy: {wall_force: y, of: {wall: w}}, fz: {wall_force: z, of: {wall: w}}}'
says err.txt "nothing holds 'b' in x and z and from turning: held in 3 direction(s) of nodes"
awk -F, 'END { exit !(($3 ^ 2 < 1e-10) && (($4 - 235.44) ^ 2 < 1e-10) && $5 ^ 2 < 1e-10) }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"

# A floor that leans, with the weight towards it: nothing holds the block along it. With any other weight it slides.
cat >lean.awk <<'EOF'
BEGIN { c = cos(0.3); s = sin(0.3); printf "loads={gravity: [%.17g, %.17g]}\n", -9.81 * s, -9.81 * c
  printf "walls[0].shape={half-space: {point: [0, 0], normal: [%.17g, %.17g]}}\n", s, c
  printf "bodies[0].shape={polygon: [[%.17g, %.17g], [%.17g, %.17g], [%.17g, %.17g], [%.17g, %.17g]]}\n", -0.2 * c, 0.2 * s, 0.2 * c, -0.2 * s,
    0.2 * c + 0.3 * s, 0.3 * c - 0.2 * s, -0.2 * c + 0.3 * s, 0.3 * c + 0.2 * s }
EOF
awk -f lean.awk >lean.txt
leaning() {
  "$talus" run block.yaml --out o --force --set "$(sed -n 2p lean.txt)" --set "$(sed -n 3p lean.txt)" --set 'grid.box={min: [-0.5, -0.4], max: [0.5, 0.6]}' "$@"
}
expect "a floor that leans" 0 leaning --set "$(sed -n 1p lean.txt)"
awk -F, 'END { w = sqrt($3 * $3 + $4 * $4); exit !((w - 1177.2) ^ 2 < 1e-2 && ($3 / $4 - sin(0.3) / cos(0.3)) ^ 2 < 1e-12) }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"
expect "a floor on which it slides" 2 leaning
says err.txt "nothing holds 'b'" "N are out of balance"

# Pressed between two smooth plates, without Poisson's ratio: mu (l - 1 / l) a unit of its breadth.
expect "between plates" 0 "$talus" run block.yaml --out o --force --set materials.r.poisson=0 --set 'loads={}' \
  --set 'walls[1]={name: lid, shape: {half-space: {point: [0, 0.317], normal: [0, -1]}}, contact: frictionless, motion: [{displacement: {y: -0.015}}]}'
awk -F, 'END { p = 0.4 * 0.5e8 * (1 / 0.95 - 0.95); exit !(($4 / p - 1) ^ 2 < 1e-7) }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"

# A lid that has left says that nothing holds the block across it any more; along it nothing did.
expect "a lid that leaves" 0 "$talus" run block.yaml --out o --force --set method=fem --set 'loads={}' --set 'bodies[0].shape={box: {min: [0, 0], max: [0.4, 0.3]}}' \
  --set 'walls[0].shape={half-space: {point: [0, 0], normal: [0, 1]}}' \
  --set 'walls[1]={name: lid, shape: {half-space: {point: [0, 0.3], normal: [0, -1]}}, contact: frictionless, motion: [{displacement: {y: -0.015}, amplitude: [[0, 0], [0.5, 1], [1, -0.5]]}]}'
says err.txt "nothing holds 'b' in y any more"

expect "interfaces" 2 "$talus" run block.yaml --out o --force --set 'bodies[1]={name: c, shape: {box: {min: [0.013, 0.317], max: [0.413, 0.417]}}, material: r}' \
  --set 'interfaces=[{name: i, between: [b, c], contact: frictionless}]'
says err.txt "without interfaces and walls with mass"

# A disk in a smooth round wall can turn, whatever it weighs: it did, until its points were inside out, or by 47 degrees.
cat >disk.yaml <<'EOF'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [-1, -1], max: [1, 1]}, size: 0.25}
bodies: [{name: b, shape: {circle: {centre: [0.031, 0.017], radius: 0.5}}, material: r}]
materials: {r: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
walls: [{name: t, shape: {circle: {centre: [0.031, 0.017], radius: 0.5}}, inside: true}]
loads: {gravity: [0, -9.81]}
measures: {fy: {wall_force: y, of: {wall: t}}}
output: {every: end}
EOF
expect "a disk in a round wall" 2 on_ranks 2 "$talus" run disk.yaml --out o --force
says err.txt "nothing holds 'b' from turning in its smooth round walls" "analysis: {unheld: hold}"
expect "a ball in a round wall" 2 "$talus" run disk.yaml --out o --force --set kinematics=3d --set 'grid={box: {min: [-0.75, -0.75, -0.75], max: [0.75, 0.75, 0.75]}, size: 0.25}' \
  --set 'bodies[0].shape={sphere: {centre: [0.031, 0.017, 0.03], radius: 0.5}}' --set 'walls[0].shape={sphere: {centre: [0.031, 0.017, 0.03], radius: 0.5}}' --set 'loads.gravity=[0, -9.81, 0]'
says err.txt "nothing holds 'b' from turning"
# Held from turning: by hand, by friction, by its weight as a pendulum; and what may come to hold it is as it was.
weighs() { awk -F, -v w="$1" 'END { exit !(($3 / w - 1) ^ 2 < 1e-10) }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"; }
expect "held by hand" 0 "$talus" run disk.yaml --out o --force --set analysis.unheld=hold
weighs 7704.7788
expect "held by friction" 0 "$talus" run disk.yaml --out o --force --set 'walls[0].friction=0.01'
weighs 7704.7788
expect "a block in a trough" 0 "$talus" run disk.yaml --out o --force --set 'bodies[0].shape={box: {min: [-0.31, -0.4], max: [0.31, -0.1]}}' \
  --set 'walls[0].shape={circle: {centre: [0, 0], radius: 0.5}}'
weighs 1824.66
expect "a floor below it" 1 "$talus" run disk.yaml --out o --force --set 'walls[1]={name: w, shape: {half-space: {point: [0, -0.7], normal: [0, 1]}}}'
lacks err.txt "nothing holds"

# Pressed all round, off the grid's lines: what parts of its surface leave of a sum that is zero is no push.
cat >ball.yaml <<'EOF'
kinematics: 3d
method: mpm
analysis: {type: static, steps: 2, unheld: hold}
grid: {box: {min: [-0.75, -0.75, -0.75], max: [0.75, 0.75, 0.75]}, size: 0.1875}
bodies: [{name: b, shape: {sphere: {centre: [0.031, 0.017, 0.043], radius: 0.5}}, material: r}]
materials: {r: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
loads: {pressures: [{on: {body: b}, value: 2e4}]}
measures: {p: {stress: xx}}
output: {every: end}
EOF
expect "a ball under pressure" 0 "$talus" run ball.yaml --out o --force
awk -F, 'END { exit !(($3 / -2e4 - 1) ^ 2 < 1e-7) }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"
flat="--set grid.size=[0.25,0.125,0.25] --set loads.pressures[0].value=1e3"
expect "in flat cells" 0 "$talus" run ball.yaml --out o --force $flat
awk -F, 'END { exit !(($3 / -1e3 - 1) ^ 2 < 1e-6) }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"
expect "a pressure that varies may push" 2 "$talus" run ball.yaml --out o --force $flat --set 'loads.pressures[0].factor="1"'
says err.txt "N are out of balance"

# What comes to rest in a stage holds the body in the next one: a floor or a body that it falls onto, one that it is
# lowered onto. Before the run a stage is refused for what nothing could hold wherever the body is, and else as it begins.
cat >fall.yaml <<'EOF'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.5, step: 0.01, damping: 20}
grid: {box: {min: [-1, -0.75], max: [2, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 0.5]}}, material: e}]
materials: {e: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls: [{name: floor, shape: {half-space: {point: [0, -0.001], normal: [0, 1]}}, friction: 0.5}]
loads: {gravity: [0, -10]}
measures: {fy: {wall_force: y, of: {wall: floor}}}
output: {every: end}
stages: [{name: fall}, {name: rest, analysis: {type: static, steps: 2}}]
EOF
bears() {
  awk -F, -v row="$1" -v force="$2" 'NR > 1 { f = $row } END { exit !((f / force - 1) ^ 2 < 1e-12) }' o/history.csv || fail "$name: $(tail -n 1 o/history.csv)"
}
for way in "fem 2" "mpm 1" "gmm 1"; do
  set -- $way
  expect "fallen onto a floor, $way" 0 on_ranks $2 "$talus" run fall.yaml --out o --force --quiet --set method=$1
  bears 4 5000
done
expect "a run in which it falls" 0 "$talus" run fall.yaml --out fallen --force --quiet --set 'stages=[]' --set 'analysis.end=0.4'
expect "on from there" 0 "$talus" run fall.yaml --out o --force --quiet --set 'stages=[]' --set 'analysis={type: static, steps: 2}' --set 'initial={run: fallen}'
bears 3 5000
expect "lowered onto it" 0 "$talus" run fall.yaml --out o --force --quiet --set 'analysis={type: static, steps: 2}' \
  --set 'boundary=[{name: top, on: {y: 0.5, x: [0, 1]}, displacement: {x: 0, y: -0.002}}]' --set 'stages=[{name: lower}, {name: rest, boundary: []}]'
bears 4 5000
expect "fallen onto a body" 0 "$talus" run fall.yaml --out o --force --quiet --set analysis.end=1 --set analysis.damping=10 --set 'walls=[]' --set 'boundary=[{on: {y: -0.75}, fix: [x, y]}]' \
  --set 'bodies=[{name: b, shape: {box: {min: [0, 0], max: [1, 0.5]}}, material: e}, {name: a, shape: {box: {min: [0, -0.75], max: [1, -0.25]}}, material: e}]' \
  --set 'interfaces=[{name: i, between: [b, a], friction: 0.5}]' --set 'measures={fy: {interface_force: y, of: {interface: i}}}'
bears 4 5000
expect "still in the air" 1 "$talus" run fall.yaml --out o --force --quiet --set analysis.end=0.01 --set 'walls[0].shape.half-space.point=[0, -0.3]'
says err.txt "stage 'rest' cannot begin" "nothing holds 'b' in x and y: a static analysis has no answer (stage 'rest')"
[ -s o/stage_01.h5 ] || fail "$name: the state is not kept"
for method in fem mpm; do
  expect "nothing to fall onto, $method" 2 "$talus" run fall.yaml --out none --quiet --set method=$method --set 'walls=[]' --set 'measures={}' --set 'boundary=[{on: {x: -1}, fix: [x]}]'
  says err.txt "nothing holds 'b' in $([ $method = mpm ] || echo "x and ")y: a static analysis has no answer (stage 'rest')"
done
# Held in all by the nodes of `hold`, which a run that is resumed in a later stage needs, too.
expect "held in a stage" 0 "$talus" run fall.yaml --out o --force --quiet --set 'analysis={type: static, steps: 2, unheld: hold}' --set 'walls[0]={name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}}' \
  --set 'stages=[{name: a}, {name: b}]' --set 'checkpoint.steps=1'
rm o/checkpoint_000000004.h5
expect "and resumed there" 0 "$talus" run --resume o
lacks err.txt "any more"
bears 4 5000

# A body on a wall with mass is held by what holds that: the body below, or what guides the wall.
cat >plate.yaml <<'EOF'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 2}
grid: {box: {min: [-0.5, -0.25], max: [1.5, 2]}, size: 0.25}
bodies:
  - {name: below, shape: {box: {min: [0, 0], max: [1, 0.5]}}, material: e}
  - {name: above, shape: {box: {min: [0, 0.75], max: [1, 1.25]}}, material: e}
materials: {e: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{name: foot, on: {y: 0}, fix: [x, y]}]
walls: [{name: plate, shape: {box: {min: [0, 0.5], max: [1, 0.75]}}, contact: bonded, mass: {mass: 100}}]
loads: {gravity: [0, -10]}
measures: {ry: {reaction: y, of: {boundary: foot}}}
output: {every: end}
EOF
for way in "fem 3 contact: bonded" "fem 1 friction: 0.3" "mpm 1 contact: bonded" "mpm 2 friction: 0.3" "gmm 1 contact: bonded" "gmm 1 friction: 0.3"; do
  set -- $way
  expect "on a plate with mass, $way" 0 on_ranks $2 "$talus" run plate.yaml --out o --force --quiet --set method=$1 \
    --set "walls[0]={name: plate, shape: {box: {min: [0, 0.5], max: [1, 0.75]}}, $3 $4, mass: {mass: 100}}"
  lacks err.txt "nothing holds"
  bears 3 11000
done
expect "without a foot" 2 on_ranks 2 "$talus" run plate.yaml --out none --quiet --set 'boundary=[]' --set 'measures={}'
says err.txt "nothing holds 'below' and what it touches in x and y: a static analysis has no answer"
lacks err.txt "friction"
expect "a plate that is free to fall" 2 "$talus" run plate.yaml --out none --quiet --set 'boundary=[]' --set 'measures={}' --set 'walls[0].mass.free=[y]'
says err.txt "nothing holds 'below' and what it touches in y:"
expect "a plate that is free to turn" 0 "$talus" run plate.yaml --out o --force --quiet --set 'boundary=[]' --set 'measures={f: {wall_force: y, of: {wall: plate}}}' --set 'walls[0].mass.free=[rotation]'
bears 3 10000

# Two that rub on each other slide together on a smooth third.
expect "two on a third" 2 "$talus" run plate.yaml --out none --quiet --set 'walls=[]' \
  --set 'bodies[1].shape.box={min: [0, 0.5], max: [1, 1]}' --set 'bodies[2]={name: top, shape: {box: {min: [0, 1], max: [1, 1.5]}}, material: e}' \
  --set 'interfaces=[{name: i, between: [above, below]}, {name: j, between: [top, above], friction: 0.4}]'
says err.txt "nothing holds 'above' and what it touches in x: a static analysis has no answer"
finish
