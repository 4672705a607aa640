#!/bin/sh
# Where loads act on bodies: named boundaries, meshes of their own, surfaces between two bodies. Forces by hand.
. "$(dirname "$0")/library.sh"

# near WHAT COLUMN VALUE OFF: of the last row.
near() {
  awk -F, -v c="$2" -v e="$3" -v o="$4" 'END { d = $c - e; exit !(d <= o && d >= -o) }' run/history.csv ||
    fail "$name: $1 is $(tail -n 1 run/history.csv | cut -d, -f"$2"), not $3"
}

# --- a side of the grid, as far as a body has it: 1 m of the 4 m around it ---
cat >side.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
boundary: [{name: left, on: {boundary: left}, fix: [x]}, {name: base, on: {boundary: bottom}, fix: [y]}]
loads: {tractions: [{on: {body: b, boundary: top}, value: [0, -1000]}]}
measures: {base: {reaction: y, of: {boundary: base}}, left: {reaction: x, of: {boundary: left}}}
END
# and along x another load, on half of it
half='loads.tractions[1]={on: {body: b, boundary: top, x: [0, 0.5]}, value: [-1000, 0]}'
for method in gmm mpm fem; do
  turn
  expect "a side, $method" 0 on_ranks $ranks "$talus" run side.yaml --out run --force --set method=$method --set "$half"
  near base 3 1000 1e-3
  near left 4 500 1e-3
done
expect "no such side, and one that the body does not reach" 2 "$talus" check side.yaml --set method=mpm \
  --set 'loads.tractions[1]={on: {body: b, boundary: tpo}, value: [0, 1]}' --set 'grid.box.max=[1, 1.5]'
says err.txt "no boundary is named 'tpo'" "did you mean 'top'" "selects no face of the body's boundary" \
  "'top' is the side of the grid at y = 1.5 m" "on: {body: b, y: ...}"

# --- whole sides of cells bear it, of which bodies that fill their shapes have a part ---
part='bodies=[{name: b, shape: {box: {min: [0.1, 0], max: [0.7, 1]}}, material: m}]'
awk '/^loads/ { $0 = "loads:\n  tractions: [{on: {boundary: top}, value: [0, -500]}]\n  pressures: [{on: {boundary: top}, value: 1000}]" }
  { print }' side.yaml >whole.yaml
expect "a part of sides" 0 on_ranks 2 "$talus" run whole.yaml --out run --force --set method=mpm --set "$part"
says err.txt "whole.yaml:9:16: warning: the sides of cells that bear it have 0.75 m, the bodies 0.6 m of them" \
  "whole.yaml:10:16: warning: the sides of cells that bear it have 0.75 m, the bodies 0.6 m of them" "on: {body: b, boundary: top}"
near base 3 1125 1e-3 # 375 and 750 N
expect "all of them" 0 "$talus" check whole.yaml --set method=mpm
lacks err.txt "the sides of cells that bear it"
# as far as the body goes; and a point force, at a corner of the shape
expect "up to the side" 0 "$talus" run side.yaml --out run --force --set method=mpm --set "$part" --set 'loads.points=[{at: [0.7, 1], force: [-1000, 0]}]'
near base 3 600 1e-3
near left 4 1000 1e-3
lacks err.txt "the sides of cells that bear it"
expect "below the side" 0 "$talus" check side.yaml --set method=mpm --set 'loads.tractions[0].on={boundary: top}' \
  --set 'bodies=[{name: b, shape: {box: {min: [0, 0], max: [1, 0.9]}}, material: m}]'
says err.txt "the sides of cells that bear it have 1 m, the bodies 0 m of them" "no body reaches that side"

# --- a point force has material at its place, not somewhere in its cell ---
for ranks in 1 3; do
  expect "beside the shape, $ranks ranks" 2 on_ranks $ranks "$talus" run side.yaml --out run --force --set method=mpm --set "$part" --set 'loads={points: [{at: [0.72, 0.9], force: [0, -1000]}]}'
  says err.txt "no material carries the force: it acts outside of all bodies" "bodies end where their shapes do"
done

# --- whole cells in the place of a disk: their steps are longer than its circle ---
expect "steps" 0 "$talus" check side.yaml --set 'bodies=[{name: b, shape: {circle: {centre: [0.5, 0.5], radius: 0.5}}, fill: cells, material: m}]' \
  --set method=mpm --set 'grid.size=0.125' --set 'boundary=[{name: base, on: {y: 0.5}, fix: [x, y]}]' --set measures=null --set 'loads.tractions[0].on={body: b}'
says err.txt "the sides of cells that bear it have 4 m, the surface of the shape 3.142 m" "0.785 times as large"

# --- a body with a mesh of its own in a box: on its surface, wherever the grid's cells are ---
cat >disk.geo <<'END'
Point(1) = {0, 0, 0, 0.06}; Point(2) = {0.5, 0, 0, 0.06}; Point(3) = {0, 0.5, 0, 0.06};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 1}; Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Physical Surface("d") = {1}; Physical Curve("arc") = {2};
END
# mesh NAME NUMBER...: of NAME.geo, once: gmsh takes longer to start than the program has to do
mesh() {
  of=$1
  shift
  gmsh -2 $of.geo -o $of.msh -format msh41 "$@" >out.txt 2>&1 || fail "$of.geo: no mesh"
}
mesh disk
cat >disk.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [0.75, 0.75]}, size: 0.125}
bodies: [{name: d, mesh: disk.msh, points_per_cell: 3, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0.3}}
boundary: [{name: left, on: {x: 0}, fix: [x]}, {name: base, on: {y: 0}, fix: [y]}]
loads: {tractions: [{on: {body: d, boundary: arc}, value: [0, -1000]}]}
measures: {base: {reaction: y, of: {boundary: base}}, left: {reaction: x, of: {boundary: left}}, xx: {stress: xx}, yy: {stress: yy}}
END
# along x another load as far as its range: the grid's lines, and a fourth of its cells, are elsewhere; within a part
for basis in bspline gimp cell; do
  turn
  test $basis = bspline && range="0.203, 0.204" length=1 || { range="0.123, 0.4" length=277; }
  expect "an arc, $basis" 0 "$talus" run disk.yaml --out run --force --set "basis={$basis: {}}" \
    --set "loads.tractions[1]={on: {body: d, boundary: left, y: [$range]}, value: [-1000, 0]}"
  near base 3 785.398 1 # a polygon
  near left 4 $length 1e-5
  expect "a pressure, $basis" 0 on_ranks $ranks "$talus" run disk.yaml --out run --force --set "basis={$basis: {}}" --set 'loads={pressures: [{on: {body: d, boundary: arc}, value: 1000}]}'
  near base 3 500 0.1
  near xx 5 -1000 0.1
  near yy 6 -1000 0.1
done
expect "in a ring" 0 "$talus" run disk.yaml --out run --force --set kinematics=axisymmetric --set 'loads={pressures: [{on: {body: d, boundary: arc}, value: 1000}]}'
near base 3 785.398 0.2 # p pi R^2
expect "a ring as far as its range" 0 "$talus" run disk.yaml --out run --force --set kinematics=axisymmetric --set 'loads.tractions[0].on={body: d, boundary: bottom, x: [0.1234, 0.377]}'
near base 3 398.672632 1e-5 # t pi (b^2 - a^2)
# A group of the mesh by the name of a side of the grid too, where the body has 0.5 m; and a side without a group.
sed 's/"arc"/"bottom"/' disk.msh >bottom.msh
expect "its own name, and a place" 0 on_ranks 2 "$talus" run disk.yaml --out run --force --set 'bodies[0].mesh=bottom.msh' --set 'loads.tractions[0].on={body: d, boundary: bottom}' \
  --set 'loads.tractions[1]={on: {body: d, boundary: left}, value: [-1000, 0]}'
near base 3 785.398 1
near left 4 500 1e-3
expect "no such group" 2 "$talus" check disk.yaml --set 'loads.tractions[0].on.boundary=ark'
says err.txt "no boundary is named 'ark'" "did you mean 'arc'"

# --- points of such a mesh, 0.125 m apart, stand as 2, 1, 2, 1, 2 in cells of 0.2 m: a third of a uniform stress ---
cat >plate.geo <<'END'
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1}; Transfinite Curve {1, 2, 3, 4} = 5; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("d") = {1}; Physical Curve("top") = {3};
END
mesh plate
cat >plate.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {cell: {}}
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.2}
bodies: [{name: d, mesh: plate.msh, points_per_cell: 4, material: m}]
materials: {m: {law: mohr-coulomb, density: 1000, young: 1e9, poisson: 0.3, friction_angle: 0, cohesion: 1000}}
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}]
loads: {tractions: [{name: press, on: {body: d, boundary: top}, value: [0, -100]}]}
END
uneven="points of 'd' stand unevenly in the cells of the grid (2.6 in each): inside it 33 % of a uniform stress is out of balance"
for ranks in 2 3; do
  expect "uneven, $ranks" 0 on_ranks $ranks "$talus" check plate.yaml
  says err.txt "plate.yaml:6:26: warning: $uneven" "points_per_cell, a finer mesh of the body, a coarser grid"
done
expect "uneven, as it is sought" 0 "$talus" run plate.yaml --out run --force --set 'analysis={type: limit-load, limit: {raise: press}}'
says err.txt "$uneven"
says out.txt "warning = what is told is unsafe: points stand unevenly in cells, 33 % of a uniform stress is out of balance"
for fits in 'basis={gimp: {}}' grid.size=0.25 'bodies[0].points_per_cell=25'; do
  expect "even, $fits" 0 "$talus" check plate.yaml --set "$fits"
  lacks err.txt "points of 'd'"
done
expect "even, a ring" 0 "$talus" check plate.yaml --set kinematics=axisymmetric --set basis='{gimp: {}}'
lacks err.txt "points of 'd'"
expect "far apart" 0 on_ranks 2 "$talus" check plate.yaml --set 'basis={gimp: {}}' --set grid.size=0.1
says err.txt "warning: points of 'd' are farther apart than the cells of the grid (0.64 in a cell): nothing joins them"

# --- a surface between two bodies: whichever of both the mesh has first, a pressure pushes the one that is named ---
cat >two.geo <<'END'
DefineConstant[up = {0}];
Point(1) = {0, 0, 0, 0.5}; Point(2) = {1, 0, 0, 0.5}; Point(3) = {1, 1, 0, 0.5}; Point(4) = {0, 1, 0, 0.5}; Point(5) = {1, 2, 0, 0.5}; Point(6) = {0, 2, 0, 0.5};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Line(5) = {3, 5}; Line(6) = {5, 6}; Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {-3, 5, 6, 7};
If (up) Plane Surface(1) = {2}; Plane Surface(2) = {1};
Else Plane Surface(1) = {1}; Plane Surface(2) = {2}; EndIf
Physical Surface("low") = {up ? 2 : 1}; Physical Surface("up") = {up ? 1 : 2}; Physical Curve("mid") = {3}; Physical Curve("base") = {1}; Physical Curve("left") = {4, 7};
END
cat >two.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {mesh: two.msh}
bodies: [{name: low, region: low, points_per_cell: 1, material: m}, {name: up, region: up, points_per_cell: 1, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
boundary: [{name: left, on: {boundary: left}, fix: [x]}, {name: base, on: {boundary: base}, fix: [y]}]
loads: {pressures: [{on: {body: low, boundary: mid}, value: 2000}, {on: {body: up, boundary: mid}, value: 1000}]}
measures: {base: {reaction: y, of: {boundary: base}}, left: {reaction: x, of: {boundary: left}}, yy: {stress: yy, of: {body: low}}}
END
for up in 0 1; do
  mesh two -setnumber up $up
  expect "pushes both, $up" 0 on_ranks $((3 - up)) "$talus" run two.yaml --out run --force
  near base 3 1000 0.1
  near yy 5 -1000 0.1
  expect "neither, $up" 2 on_ranks $((1 + up)) "$talus" run two.yaml --out run --force --set 'loads.pressures[0].on={boundary: mid}'
  says err.txt "2 of these sides lie within the material" "on: {body: ..., boundary: mid}"
  expect "alone, $up" 0 on_ranks $((1 + up)) "$talus" run two.yaml --out run --force --set 'bodies=[{name: low, region: low, points_per_cell: 1, material: m}]' \
    --set 'loads={pressures: [{on: {boundary: mid}, value: 1000}], tractions: [{on: {boundary: mid}, value: [-2000, 0]}]}'
  near base 3 1000 0.1
  near left 4 2000 0.1
done

# --- a surface that goes along the axis of rings ---
ranks=0
for method in gmm mpm fem; do
  turn
  expect "all round a cylinder, $method" 0 on_ranks $ranks "$talus" run side.yaml --out run --force --set method=$method --set kinematics=axisymmetric --set 'boundary=[{name: base, on: {boundary: bottom}, fix: [y]}]' \
    --set 'grid.box.max=[1.25, 1]' --set 'loads={pressures: [{on: {body: b, x: 1}, value: 1000}, {on: {body: b, y: 1}, value: 1000}]}' --set 'measures={base: {reaction: y, of: {boundary: base}}, xx: {stress: xx}}'
  near base 3 3141.593 4
  near xx 4 -1000 4
done
expect "with its axis" 0 "$talus" run side.yaml --out run --force --set kinematics=axisymmetric --set 'boundary=[{name: base, on: {boundary: bottom}, fix: [y]}]' \
  --set 'loads={pressures: [{on: {body: b}, value: 1000}]}' --set 'measures={base: {reaction: y, of: {boundary: base}}, xx: {stress: xx}}'
near xx 4 -1000 1
finish
