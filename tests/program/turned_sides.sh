#!/bin/sh
# Smooth sides that lie along no axis: forces on any number of ranks, what such sides leave free, and what a stage takes
# away of them.
. "$(dirname "$0")/library.sh"

# Two squares on each other, turned by `a` degrees, the line between them twice.
cat >blocks.geo <<'END'
DefineConstant[ a = 30, h = 0.5 ];
c = Cos(a * Pi / 180); s = Sin(a * Pi / 180);
Point(1) = {0, 0, 0}; Point(2) = {c, s, 0}; Point(3) = {c - s, s + c, 0}; Point(4) = {-s, c, 0};
Point(5) = {-s, c, 0}; Point(6) = {c - s, s + c, 0}; Point(7) = {c - 2 * s, s + 2 * c, 0}; Point(8) = {-2 * s, 2 * c, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Transfinite Curve{1:8} = Round(1 / h) + 1; Transfinite Surface{1:2}; Recombine Surface{1:2};
Physical Surface("lo") = {1}; Physical Surface("up") = {2};
Physical Curve("bottom") = {1}; Physical Curve("left") = {4, 8}; Physical Curve("right") = {2, 6};
END
cat >blocks.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {mesh: blocks.geo}
bodies:
  - {name: lo, region: lo, points_per_cell: 4, material: m}
  - {name: up, region: up, points_per_cell: 4, material: m}
materials: {m: {law: neo-hookean, density: 2000, young: 1e7, poisson: 0.3}}
boundary:
  - {name: bottom, on: {boundary: bottom}, fix: [normal]}
  - {name: left, on: {boundary: left}, fix: [normal]}
  - {name: right, on: {boundary: right}, fix: [normal]}
interfaces: [{name: i, between: [up, lo], contact: frictionless}]
loads: {gravity: [5, -8.660254037844386]}
measures:
  bx: {reaction: x, of: {boundary: bottom}}
  by: {reaction: y, of: {boundary: bottom}}
  lx: {reaction: x, of: {boundary: left}}
  ly: {reaction: y, of: {boundary: left}}
  rx: {reaction: x, of: {boundary: right}}
  ry: {reaction: y, of: {boundary: right}}
output: {every: end}
END
# 4000 kg/m bear on the bottom, along its normal; what the sides give is in balance, or, held along both axes, not its own.
sums() {
  awk -F, -v lone="$1" 'function off(x, y) { return (x / y - 1) ^ 2 > 1e-18 }
    END { x = $3 + (lone ? 0 : $5 + $7); y = $4 + (lone ? 0 : $6 + $8); exit off(x, -20000) || off(y, 34641.01615137755) }' o/history.csv ||
    fail "$name: $(tail -n 1 o/history.csv)"
}
for ranks in 1 3; do
  expect "blocks between smooth sides, $ranks" 0 on_ranks $ranks "$talus" run blocks.yaml --out o --force --quiet
  sums 1
  sums
  says o/log.txt "iterations = 3 "
done
expect "blocks between rough sides" 0 on_ranks 2 "$talus" run blocks.yaml --out o --force --quiet --set 'boundary[1].fix=[x,y]' --set 'boundary[2].fix=[x,y]'
sums

# A square between two smooth sides that lie alike may slide along them; with a third it may not, and is pressed.
cat >slides.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {mesh: square.geo}
bodies: [{name: b, region: body, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 2000, young: 1e6, poisson: 0.3}}
boundary:
  - {name: bottom, on: {boundary: bottom}, fix: [normal]}
  - {name: top, on: {boundary: top}, fix: [normal]}
loads: {pressures: [{on: {boundary: left}, value: 1e4}, {on: {boundary: right}, value: 1e4}]}
output: {every: end}
END
cat >square.geo <<'END'
DefineConstant[ a = 45 ];
c = Cos(a * Pi / 180); s = Sin(a * Pi / 180);
Point(1) = {0, 0, 0}; Point(2) = {c, s, 0}; Point(3) = {c - s, s + c, 0}; Point(4) = {-s, c, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve{1:4} = 4; Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("body") = {1}; Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
END
for a in 17 45; do
  [ $a = 17 ] && ranks=2 || ranks=1
  expect "between two sides at $a degrees" 2 on_ranks $ranks "$talus" run slides.yaml --out o --force --set "grid.parameters={a: $a}"
  says err.txt "nothing holds 'b' along a line that leans: a static analysis has no answer" "analysis: {unheld: hold}"
  expect "on one of them" 2 on_ranks $ranks "$talus" run slides.yaml --out o --force --set "grid.parameters={a: $a}" --set 'boundary[1].absent=true'
  says err.txt "nothing holds 'b' along a line that leans"
done
expect "held by hand" 0 "$talus" run slides.yaml --out o --force --set analysis.unheld=hold
expect "at the end of them" 0 "$talus" run slides.yaml --out o --force --set 'boundary[2]={name: left, on: {boundary: left}, fix: [normal]}' --set 'loads.pressures=[{on: {boundary: right}, value: 1e4}]'
expect "level ones" 2 "$talus" run slides.yaml --out o --force --set "grid.parameters={a: 0}"
says err.txt "nothing holds 'b' in x: a static analysis has no answer"

# The upper one of two blocks on a smooth seam, across which its weight pulls; with both on a rough one, nothing but their
# floor's normal holds them.
for a in 17 45; do
  expect "a seam at $a degrees" 2 "$talus" run blocks.yaml --out o --force --set "grid.parameters={a: $a}" \
    --set 'boundary=[{name: bottom, on: {boundary: bottom}, fix: [x, y]}]' --set 'measures={}' --set 'loads.gravity=[0, -10]'
  says err.txt "nothing holds 'up' along a line that leans"
  [ $a = 17 ] && ranks=2 || ranks=1
  expect "both on a side at $a degrees" 2 on_ranks $ranks "$talus" run blocks.yaml --out o --force --set "grid.parameters={a: $a}" \
    --set 'boundary=[{name: bottom, on: {boundary: bottom}, fix: [normal]}]' --set 'interfaces[0]={name: i, between: [up, lo], friction: 0.5}' \
    --set 'measures={}' --set 'loads.gravity=[0, -10]'
  says err.txt "nothing holds 'lo' and what it touches along a line that leans"
done

# Pressed between two smooth planes, and a third one goes away along them: said at the end.
expect "a stop that goes" 0 "$talus" run slides.yaml --out o --force --quiet --set 'grid.parameters={a: 30}' --set analysis.steps=4 --set 'boundary=[]' --set 'loads={}' --set 'walls=[
  {name: floor, shape: {half-space: {point: [0, 0], normal: [-0.5, 0.8660254037844386]}}},
  {name: press, shape: {half-space: {point: [-0.5, 0.8660254037844386], normal: [0.5, -0.8660254037844386]}}, motion: [{displacement: {x: 0.005, y: -0.00866}}]},
  {name: stop, shape: {half-space: {point: [0, 0], normal: [0.8660254037844386, 0.5]}}, motion: [{displacement: {x: -0.0866, y: -0.05}}]}]'
says err.txt "nothing holds 'b' along a line that leans any more"

# A disk that is held along its normals all round is free to turn.
cat >disk.geo <<'END'
Point(1) = {0, 0, 0, 0.3}; Point(2) = {1, 0, 0, 0.3}; Point(3) = {0, 1, 0, 0.3}; Point(4) = {-1, 0, 0, 0.3}; Point(5) = {0, -1, 0, 0.3};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Physical Surface("body") = {1}; Physical Curve("rim") = {1:4};
END
disk() {
  "$talus" run slides.yaml --out o --force --set grid.mesh=disk.geo --set 'bodies[0].points_per_cell=3' --set 'boundary=[{name: rim, on: {boundary: rim}, fix: [normal]}]' \
    --set 'loads={gravity: [0, -10]}' "$@"
}
expect "a disk" 2 disk
says err.txt "nothing holds 'b' from turning: a static analysis has no answer" "analysis: {unheld: hold}"
expect "a disk by hand" 0 disk --set analysis.unheld=hold

# In space: a cube between four planes that are turned about x and y, free along their edges.
cat >cube.geo <<'END'
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Rotate {{1, 0, 0}, {0, 0, 0}, 0.5} { Surface{1}; } Rotate {{0, 1, 0}, {0, 0, 0}, 0.4} { Surface{1}; }
Transfinite Curve{1:4} = 3; Transfinite Surface{1}; Recombine Surface{1};
side[] = Extrude {Cos(0.5) * Sin(0.4), -Sin(0.5), Cos(0.5) * Cos(0.4)} { Surface{1}; Layers{2}; Recombine; };
Physical Volume("body") = {1}; Physical Surface("around") = {side[2], side[3], side[4], side[5]}; Physical Surface("foot") = {1};
END
expect "in space" 2 "$talus" run slides.yaml --out o --force --set kinematics=3d --set grid.mesh=cube.geo --set 'bodies[0].points_per_cell=8' \
  --set 'boundary=[{name: around, on: {boundary: around}, fix: [normal]}]' --set 'loads={gravity: [0, 0, -10]}'
says err.txt "nothing holds 'b' along a line that leans"
expect "in space, on a foot" 0 "$talus" run slides.yaml --out o --force --set kinematics=3d --set grid.mesh=cube.geo --set 'bodies[0].points_per_cell=8' --quiet \
  --set 'boundary=[{name: around, on: {boundary: around}, fix: [normal]}, {name: foot, on: {boundary: foot}, fix: [normal]}]' --set 'loads={gravity: [0, 0, -10]}'

# A stage takes a smooth side away: nothing is left of its force, and the block is that which never had it.
cat >stage.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [2, 1]}, size: 0.5}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [2, 1]}}, material: m}]
materials: {m: {law: neo-hookean, density: 2000, young: 1e7, poisson: 0.3}}
boundary:
  - {name: bottom, on: {boundary: bottom}, fix: [x, y]}
  - {name: right, on: {boundary: right}, fix: [normal]}
loads: {gravity: [0, -10]}
stages: [{name: one}, {name: two, boundary: [{name: right, absent: true}]}]
measures: {rx: {reaction: x, of: {boundary: right}}, ux: {displacement: x, of: {tracer: [2, 1]}}}
output: {every: end}
END
expect "one that never was" 0 "$talus" run stage.yaml --out never --force --quiet --set 'boundary[1].absent=true' --set 'stages=[]'
for ranks in 1 3; do
  expect "a side that goes, $ranks" 0 on_ranks $ranks "$talus" run stage.yaml --out o --force --quiet
  pushed=$(awk -F, 'NR == 3 { print -$4 }' o/history.csv)
  away=$(awk -F, 'END { print $5 }' o/history.csv)
  awk -F, -v pushed=$pushed -v away=$away 'END { exit !(pushed > 100 && away > 1e-5 && (away / $4 - 1) ^ 2 < 1e-12) }' never/history.csv ||
    fail "$name: $pushed N, $away m, $(tail -n 1 never/history.csv)"
done
finish
