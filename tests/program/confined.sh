#!/bin/sh
# Nearly incompressible matter that cannot give way sideways: its weight strains it by what its bulk modulus allows, whatever holds the pressure
# within cells.
. "$(dirname "$0")/library.sh"

cat >column.yaml <<'END'
kinematics: plane-strain
method: fem
formulation: mixed
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [0.25, 1.125]}, size: 0.125}
bodies: [{name: c, shape: {box: {min: [0, 0], max: [0.25, 1]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean-split, density: 1000, young: 1e6, poisson: 0.4999}}
boundary: [{on: {x: 0}, fix: [x]}, {on: {x: 0.25}, fix: [x]}, {on: {y: 0}, fix: [y]}]
loads: {gravity: [0, -10]}
measures: {mid: {displacement: y, of: {tracer: [0.1, 0.5]}}, top: {displacement: y, of: {tracer: [0.1, 0.9]}}}
END

# settles SHARE ARGUMENT...: rho g (y - y^2 / 2) / M with M = E (1 - nu) / (1 + nu) / (1 - 2 nu)
settles() {
  share=$1
  shift
  expect "settles, $*" 0 on_ranks "${ranks:-1}" "$talus" run column.yaml --out run --force --quiet "$@"
  awk -F, -v s="$share" 'function off(u, y) { return u / (-1e4 * (y - y * y / 2) / M) - 1 }
    BEGIN { M = 1e6 * 0.5001 / 1.4999 / 0.0002 }
    END { m = off($3, 0.5); t = off($4, 0.9); exit !(m < s && m > -s && t < s && t > -s) }' run/history.csv ||
    fail "$name: $(tail -n 1 run/history.csv)"
}
for method in fem mpm; do
  turn
  settles 0.01 --set method=$method
done
ranks=1
settles 0.01 --set grid.cell=triangle --set 'bodies[0].points_per_cell=3'
settles 0.01 --set method=mpm --set 'basis={gimp: {}}'
settles 0.01 --set method=mpm --set 'basis={bspline: {}}' --set 'bodies[0].points_per_cell=9' --set grid.size=0.03125
settles 0.01 --set kinematics=axisymmetric
for cell in hexahedron tetrahedron; do
  turn
  settles 0.02 --set kinematics=3d --set 'grid={box: {min: [0, 0, 0], max: [0.25, 1.125, 0.25]}, size: 0.125}' --set grid.cell=$cell --set 'loads.gravity=[0, -10, 0]' \
    --set "bodies=[{name: c, shape: {box: {min: [0, 0, 0], max: [0.25, 1, 0.25]}}, points_per_cell: $([ $cell = hexahedron ] && echo 8 || echo 4), material: m}]" \
    --set 'boundary=[{on: {x: 0}, fix: [x]}, {on: {x: 0.25}, fix: [x]}, {on: {z: 0}, fix: [z]}, {on: {z: 0.25}, fix: [z]}, {on: {y: 0}, fix: [y]}]' \
    --set 'measures={mid: {displacement: y, of: {tracer: [0.1, 0.5, 0.1]}}, top: {displacement: y, of: {tracer: [0.1, 0.9, 0.1]}}}'
done

# ... and is at rest when dynamics begin; that waves of pressure are slow there is told
expect "rests" 0 "$talus" run column.yaml --out run --force --quiet --set materials.m.poisson=0.49 --set 'output={history: {steps: 1}}' --set 'measures={foot: {reaction: y, of: {boundary: 2}}}' \
  --set 'stages=[{name: rest}, {name: swings, analysis: {type: dynamic, end: 0.01, step: 1e-3}}]'
awk -F, 'NR > 2 && ($4 > 2500.0001 || $4 < 2499.9999) { exit 1 }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
says err.txt "waves of pressure through 'm' take 1.16 times as long as they should" "formulation: mean-dilatation"
expect "has them right" 0 "$talus" check column.yaml --set formulation=mean-dilatation --set 'analysis={type: dynamic, end: 0.01, step: 1e-3}'
lacks err.txt "waves of pressure"
says out.txt "waves: 1291" # sqrt(M / rho)
expect "small steps" 0 "$talus" check column.yaml --set 'analysis={type: dynamic, end: 0.01, step: 1e-3}'
says out.txt "waves: 1291"
# --- what falls freely bears nothing, and begins at rest only where it says so ---
for method in fem mpm; do
  expect "falls, $method" 0 "$talus" run column.yaml --out run --force --quiet --set method=$method --set boundary=null --set 'grid.box={min: [0, 0], max: [0.5, 1.25]}' \
    --set 'bodies=[{name: c, shape: {box: {min: [0.125, 0.125], max: [0.375, 1.125]}}, points_per_cell: 4, material: m}]' --set 'analysis={type: dynamic, end: 0.02, step: 2e-3}' \
    --set 'measures={low: {stress: yy, of: {tracer: [0.2, 0.2]}}, most: {energy: elastic}}'
  awk -F, 'NR > 2 && ($3 * $3 > 1e-8 || $4 * $4 > 1e-16) { exit 1 }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
done
expect "k0" 0 "$talus" run column.yaml --out run --force --quiet --set 'bodies=[{name: c, shape: {box: {min: [0, 0], max: [0.25, 1]}}, material: m, k0: 1}]' --set 'analysis={type: dynamic, end: 0.02, step: 2e-3}' \
  --set 'measures={top: {displacement: y, of: {tracer: [0.1, 0.9]}}}' --set 'output={history: {steps: 1}}'
awk -F, 'NR > 2 && $3 * $3 > 1e-22 { exit 1 }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
# --- held all around, what is exactly incompressible has no level of its pressure ---
for method in fem mpm; do
  expect "held all around, $method" 2 "$talus" check column.yaml --set method=$method --set 'grid.box.max=[0.25, 1]' --set 'boundary=[{on: {}, fix: [x, y]}]' --set materials.m.poisson=0.5
  says err.txt "nothing determines the level of the pressure in 'c'" "poisson: 0.4999"
  expect "slides all around, $method" 2 "$talus" check column.yaml --set method=$method --set 'grid.box.max=[0.25, 1]' --set materials.m.poisson=0.5 \
    --set 'boundary=[{on: {x: 0}, fix: [x]}, {on: {x: 0.25}, fix: [x]}, {on: {y: 0}, fix: [y]}, {on: {y: 1}, fix: [y]}]'
  says err.txt "nothing determines the level of the pressure in 'c'"
  expect "free at its top, $method" 0 "$talus" check column.yaml --set method=$method --set materials.m.poisson=0.5
done
expect "free at its end, in long cells" 0 "$talus" check column.yaml --set method=fem --set materials.m.poisson=0.5 \
  --set 'grid={box: {min: [0, 0], max: [100, 0.1]}, counts: [10, 1]}' \
  --set 'bodies=[{name: c, shape: {box: {min: [0, 0], max: [100, 0.1]}}, points_per_cell: 4, material: m}]' \
  --set 'boundary=[{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}, {on: {y: 0.1}, fix: [y]}]' --set measures=null

# --- metal that flows far: a ring between plates of little friction bears what fem has (a checkerboard of pressure took 18 % of it) ---
cat >ring.yaml <<'END'
kinematics: axisymmetric
method: mpm
formulation: mixed
analysis: {type: static, end: 1, steps: 60}
grid: {box: {min: [0, 0], max: [4.5, 1.125]}, size: 0.125, cell: quadrilateral}
bodies: [{name: ring, shape: {box: {min: [1.5, 0], max: [3, 1]}}, points_per_cell: 4, material: metal}]
materials: {metal: {law: j2-log, density: 8000, young: 1e9, poisson: 0.3, yield_stress: 1e6}}
walls: [{name: plate, shape: {box: {min: [0, 1], max: [9, 2]}}, friction: 0.05, motion: [{displacement: {y: -0.5}}]}]
boundary: [{on: {y: 0}, fix: [y]}]
measures: {force: {wall_force: y, of: {wall: plate}}, rough: {roughness: pressure}}
END
expect "a ring" 0 "$talus" run ring.yaml --out run --force --quiet
awk -F, 'END { r = $3 / -48.25e6 - 1; exit !(r < 0.01 && r > -0.01 && $4 < 0.3) }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
finish
