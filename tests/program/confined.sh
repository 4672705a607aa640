#!/bin/sh
# Nearly incompressible matter that cannot give way sideways: its weight, and waves through it, strain it by what its bulk modulus allows, whatever
# holds the pressure within cells.
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
settles 0.01 --set method=mpm --set 'basis={bspline: {}}' --set 'bodies[0].points_per_cell=9'
settles 0.01 --set kinematics=axisymmetric
for cell in hexahedron tetrahedron; do
  turn
  settles 0.02 --set kinematics=3d --set 'grid={box: {min: [0, 0, 0], max: [0.25, 1.125, 0.25]}, size: 0.125}' --set grid.cell=$cell --set 'loads.gravity=[0, -10, 0]' \
    --set "bodies=[{name: c, shape: {box: {min: [0, 0, 0], max: [0.25, 1, 0.25]}}, points_per_cell: $([ $cell = hexahedron ] && echo 8 || echo 4), material: m}]" \
    --set 'boundary=[{on: {x: 0}, fix: [x]}, {on: {x: 0.25}, fix: [x]}, {on: {z: 0}, fix: [z]}, {on: {z: 0.25}, fix: [z]}, {on: {y: 0}, fix: [y]}]' \
    --set 'measures={mid: {displacement: y, of: {tracer: [0.1, 0.5, 0.1]}}, top: {displacement: y, of: {tracer: [0.1, 0.9, 0.1]}}}'
done

# --- let go at once it swings about that, with the period 4 L / sqrt(M / rho) = 3.0976 ms, in 50 steps ---
for how in fem "mpm --set basis=gimp" "fem --set grid.cell=triangle --set bodies[0].points_per_cell=3"; do
  turn
  expect "swings, $how" 0 on_ranks $ranks "$talus" run column.yaml --out run --force --quiet --set method=$how --set 'analysis={type: dynamic, end: 7e-3, step: 6.2e-5}' --set 'output={history: {steps: 1}}'
  awk -F, 'BEGIN { M = 1e6 * 0.5001 / 1.4999 / 0.0002; T = 4 / sqrt(M / 1000); rest = -1e4 * 0.495 / M; before = -rest }
    NR > 1 { u = $4 - rest; if (u * before < 0) at[++n] = (t * u - $1 * before) / (u - before); before = u; t = $1 }
    END { p = (at[3] - at[1]) / T; exit !(n >= 3 && p < 1.04 && p > 0.99) }' run/history.csv || fail "$name: another period"
done
finish
