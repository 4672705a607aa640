#!/bin/sh
# At the coordinates of a map, hundreds of kilometres from the origin, all is as at it: what is small is no difference of
# what is large.
. "$(dirname "$0")/library.sh"

# at X Y <FILE: its places, written (x, y), shifted.
at() { awk -v X="$1" -v Y="$2" '{ while (match($0, /\([-0-9.]+, [-0-9.]+\)/)) { split(substr($0, RSTART + 1, RLENGTH - 2), v, ", ")
  $0 = substr($0, 1, RSTART - 1) sprintf("[%.9f, %.9f]", v[1] + X, v[2] + Y) substr($0, RSTART + RLENGTH) } print }'; }
# alike COLUMN SHARE: of the last row, here and far away.
alike() {
  awk -F, -v c="$1" -v s="$2" 'FNR == 1 { ++n } { v[n] = $c } END { d = v[2] / v[1] - 1; exit !(d ^ 2 < s ^ 2) }' near/history.csv far/history.csv ||
    fail "$name: column $1 is $(tail -n 1 far/history.csv | cut -d, -f"$1"), not $(tail -n 1 near/history.csv | cut -d, -f"$1")"
}

# --- a block that spins while it flies, and a triangle with mass that is turned ---
cat >free.txt <<'END'
kinematics: plane-strain
method: METHOD
analysis: {type: dynamic, step: 0.01, end: 0.2}
grid: {box: {min: (0, 0), max: (4, 4)}, size: 0.1}
bodies: [{name: b, shape: {box: {min: (1.4, 1.4), max: (2, 2)}}, material: m, spin: 3, spin_centre: (1.7, 1.7), velocity: [0.1, 0.2]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
walls: [{name: w, shape: {polygon: [(3, 1), (3.4, 1.2), (3.2, 1.5)]}, mass: {mass: 50, torque: 3, spin: 1}}]
measures: {spin: {spin: z, of: {body: b}}, angle: {wall_angle: z, of: {wall: w}}}
END
for method in mpm fem gmm; do
  sed "s/METHOD/$method/" free.txt >case.txt
  at 0 0 <case.txt >near.yaml
  at 499999 4999998 <case.txt >far.yaml
  for place in near far; do expect "$method, $place" 0 "$talus" run $place.yaml --out $place --force --quiet; done
  alike 3 1e-6
  alike 4 1e-9
done
# I of a triangle about its middle is m (a^2 + b^2 + c^2) / 36
awk -F, 'END { exit !(($4 / (0.2 + 3 * 0.04 / 2 / (50 * (0.2 + 0.13 + 0.29) / 36)) - 1) ^ 2 < 1e-18) }' near/history.csv || fail "$name: $(tail -n 1 near/history.csv)"

# --- a pressure on the side of a body that fills its mesh, under a plate that rubs ---
cat >side.txt <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 4}
grid: {mesh: square.geo, parameters: {X: EAST, Y: NORTH}}
bodies: [{name: b, region: square, material: m, points_per_cell: 4, stress: {xx: -200, yy: -400}}]
walls: [{name: w, shape: {box: {min: (0.2, 1), max: (1.5, 1.3)}}, friction: 0.4, motion: [{displacement: {y: -0.01, x: 0.003}}]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
boundary: [{name: foot, on: {boundary: bottom}, fix: [x, y]}]
loads: {pressures: [{on: {boundary: right}, value: 500}]}
measures: {aside: {displacement: x, of: {tracer: (0.6, 0.9)}}, held: {reaction: x, of: {boundary: foot}}}
END
cat >square.geo <<'END'
DefineConstant[ X = 0, Y = 0 ];
Point(1) = {X, Y, 0}; Point(2) = {X + 1, Y, 0}; Point(3) = {X + 1, Y + 1, 0}; Point(4) = {X, Y + 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 7; Transfinite Surface{1}; Recombine Surface{1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Surface("square") = {1};
END
sed 's/EAST/0/; s/NORTH/0/' side.txt | at 0 0 >near.yaml
sed 's/EAST/400000.1/; s/NORTH/-5000000.7/' side.txt | at 400000.1 -5000000.7 >far.yaml
for place in near far; do expect "a pressed side, $place" 0 "$talus" run $place.yaml --out $place --force --quiet; done
alike 3 1e-5
alike 4 1e-6

# --- a block that slides down terrain, and down a polygon: 0.3 mm, of which places there know 2e-6 ---
ground() {
  awk -v X="$1" -v Y="$2" 'BEGIN { printf "ncols 10\nnrows 6\nxllcenter %d\nyllcenter %d\ncellsize 1\n", X - 1, Y - 1
    for (j = 0; j < 6; ++j) { for (i = 0; i < 10; ++i) printf "%.8f ", 5.5 - 0.57735027 * i; print "" } }'
}
cat >slope.txt <<'END'
kinematics: 3d
method: mpm
analysis: {type: dynamic, step: 0.01, end: 0.05}
grid: {box: {min: [EAST0, NORTH0.0, 0], max: [EAST6, NORTH2, 7]}, size: 0.5}
bodies:
  - name: b
    shape:
      difference:
        - intersection: [{terrain: {file: PLACE.asc, offset: [0, 0, 1]}}, {box: {min: [EAST1.13, NORTH0.6, 1], max: [EAST3.17, NORTH1.7, 6]}}]
        - terrain: {file: PLACE.asc}
    material: m
materials: {m: {law: neo-hookean, density: 2000, young: 1e8, poisson: 0.2}}
walls: [{name: w, shape: {terrain: {file: PLACE.asc}}, friction: 0.2}]
loads: {gravity: [0, 0, -9.81], gravity_amplitude: [[0, 0], [0.2, 1]]}
measures: {way: {displacement: x, of: {tracer: [EAST2.1, NORTH1.2, 4.3]}}, rubs: {wall_force: x, of: {wall: w}}}
END
ground 0 0 >near.asc
ground 500000 4000000 >far.asc
sed 's/EAST//g; s/NORTH//g; s/PLACE/near/' slope.txt >near.yaml
sed 's/EAST/50000/g; s/NORTH/400000/g; s/PLACE/far/' slope.txt >far.yaml
for place in near far; do expect "terrain, $place" 0 "$talus" run $place.yaml --out $place --force --quiet; done
alike 3 1e-5
alike 4 1e-5
cat >slope.txt <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, step: 0.01, end: 0.05}
grid: {box: {min: (0, 0), max: (6, 6)}, size: 0.25}
bodies: [{name: b, shape: {polygon: [(1, 3), (2, 2.4), (2.6, 3.4), (1.6, 4)]}, fill: shape, material: m}]
materials: {m: {law: neo-hookean, density: 2000, young: 1e8, poisson: 0.2}}
walls: [{name: w, shape: {polygon: [(0, 0), (6, 0), (1, 3), (0, 3.6)]}, friction: 0.2}]
loads: {gravity: [0, -9.81], gravity_amplitude: [[0, 0], [0.2, 1]]}
measures: {way: {displacement: x, of: {tracer: (1.8, 3.2)}}, rubs: {wall_force: x, of: {wall: w}}}
END
at 0 0 <slope.txt >near.yaml
at 500000 4000000 <slope.txt >far.yaml
for place in near far; do expect "a polygon, $place" 0 "$talus" run $place.yaml --out $place --force --quiet; done
alike 3 1e-5
alike 4 1e-5

finish
