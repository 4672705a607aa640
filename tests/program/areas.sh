#!/bin/sh
# Surfaces in contact, against geometry: whatever lies where on the grid, however many points share the nodes of an edge, and
# with what bears by its surface alone, adhesion.
. "$(dirname "$0")/library.sh"

# last COLUMN: of the last row.
last() { tail -n 1 run/history.csv | cut -d, -f"$1"; }
# near NAME VALUE EXPECTED SHARE
near() {
  awk -v v="$2" -v e="$3" -v s="$4" 'BEGIN { d = v / e - 1; exit !(d < s && d > -s) }' || fail "$name: $1 is $2, not $3"
}

# --- a cube on a floor that lies anywhere in a layer of cells ---
cat >cube.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [-0.5, -0.5, LOW], max: [1.5, 1.5, HIGH]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, points_per_cell: 8, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
loads: {gravity: [0, 0, -10]}
walls: [{name: low, shape: {half-space: {point: [0, 0, 0], normal: [0, 0, 1]}}, friction: 0.3}]
measures: {force: {wall_force: z, of: {wall: low}}, area: {contact: area, of: {wall: low}}, mean: {contact: pressure, of: {wall: low}}, peak: {contact: peak_pressure, of: {wall: low}}}
END
for low in -0.375 -0.4 -0.5; do
  sed "s/LOW/$low/; s/HIGH/$(awk -v l=$low 'BEGIN { print l + 2 }')/" cube.yaml >case.yaml
  expect "a cube, $low" 0 "$talus" run case.yaml --out run --force --quiet
  near force "$(last 3)" 10000 1e-6
  near area "$(last 4)" 1 5e-4
  near mean "$(last 5)" 10000 5e-4
  near peak "$(last 6)" 11200 0.02 # its foot is held by friction
done

# --- a box has its mass, wherever its sides and edges are in their cells ---
sed -e 's/LOW/-0.4/; s/HIGH/1.6/; s/box: {min: \[0, 0, 0\], max: \[1, 1, 1\]}/box: {min: [0.13, -0.07, 0], max: [0.97, 0.61, 0.38]}/' -e 's/^measures.*/measures: {mass: {mass: total}, force: {wall_force: z, of: {wall: low}}, area: {contact: area, of: {wall: low}}}/' cube.yaml >case.yaml
for points in 8 27; do
  expect "a box of $points" 0 "$talus" run case.yaml --set "bodies[0].points_per_cell=$points" --out run --force --quiet
  near mass "$(last 3)" 217.056 1e-12 # 1000 x 0.84 x 0.68 x 0.38
  near force "$(last 4)" 2170.56 1e-8
  near area "$(last 5)" 0.5712 2e-4
done

# ... and a strip that is thinner than the places where cells are looked at are apart, too
expect "a strip" 0 "$talus" run case.yaml --set 'bodies[0].shape.box.max=[0.97, 0.61, 0.015]' --set 'grid.box={min: [-0.5, -0.5, -0.05], max: [1.5, 1.5, 1.95]}' --out run --force --quiet
near mass "$(last 3)" 8.568 1e-12

# --- adhesion of a side that is pressed by its neighbour alone and dragged along ---
cat >side.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [-1.1, -1], max: [1.9, 2]}, size: 0.2}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 2000, young: 1e6, poisson: 0.3}}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}}
  - {name: left, shape: {half-space: {point: [0, 0], normal: [1, 0]}}}
  - {name: right, shape: {half-space: {point: [1, 0], normal: [-1, 0]}}, adhesion: 100, motion: [{displacement: {y: -0.1}}]}
  - {name: punch, shape: {half-space: {point: [0, 1], normal: [0, -1]}}, motion: [{displacement: {y: -0.001}}]}
measures: {along: {wall_force: y, of: {wall: right}}, across: {wall_force: x, of: {wall: right}}, area: {contact: area, of: {wall: right}}}
END
# What is dragged along by 0.1 m and pressed by 1 mm: lambda times the strain, which a gap of 1e-5 of a cell had 1 % of.
for set in grid.cell=quadrilateral 'grid.box={min: [-1.05, -1.13], max: [1.95, 1.87]}' 'basis={cell: {}}' method=fem; do
  sed 's/min: \[-1.1, -1\], max: \[1.9, 2\]/min: [0, 0], max: [1, 1]/' side.yaml >own.yaml
  case=side.yaml
  [ "$set" != method=fem ] || case=own.yaml
  expect "a side, $set" 0 "$talus" run $case --set "$set" --out run --force --quiet
  near along "$(last 3)" -99.95 1e-3
  near across "$(last 4)" -576.6 2e-3
  near area "$(last 5)" 0.999 1e-3
done

# --- a body that ends anywhere in a cell, on another one ---
cat >rings.yaml <<'END'
kinematics: axisymmetric
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [0.8, 1.2]}, size: 0.1}
bodies:
  - {name: low, shape: {box: {min: [0, 0], max: [0.7, 0.5]}}, material: m}
  - {name: up, shape: {box: {min: [0, 0.5], max: [RADIUS, 1]}}, material: m}
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
boundary: [{name: floor, on: {boundary: bottom}, fix: [x, y]}, {name: ax, on: {boundary: left}, fix: [x]}]
interfaces: [{name: i, between: [up, low], friction: 0.3}]
loads: {tractions: [{on: {body: up, y: 1}, value: [0, -1e4]}]}
measures: {force: {interface_force: y, of: {interface: i}}, area: {interface: area, of: {interface: i}}}
END
for radius in 0.4 0.43 0.45; do
  sed "s/RADIUS/$radius/" rings.yaml >case.yaml
  expect "rings to $radius" 0 "$talus" run case.yaml --out run --force --quiet
  near area "$(last 4)" "$(awk -v r=$radius 'BEGIN { print 3.14159265 * r * r }')" 5e-4
done

# ... and in two directions, at its corners
cat >corners.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 4}
grid: {box: {min: [0, 0], max: [2, 2]}, size: 0.125}
bodies:
  - {name: low, shape: {box: {min: [0.25, 0], max: [1.75, 0.81]}}, material: m}
  - {name: top, shape: {box: {min: [0.58, 0.81], max: [1.42, 1.33]}}, material: m}
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
boundary: [{on: {y: 0}, fix: [x, y]}]
walls: [{name: p, shape: {half-space: {point: [0.58, 0], normal: [1, 0]}}, bodies: [top], motion: [{displacement: {x: 0.02}}]}]
interfaces: [{name: i, between: [top, low], adhesion: 500}]
loads: {gravity: [0, -10], gravity_amplitude: [[0, 1], [1, 1]]}
measures: {along: {interface_force: x, of: {interface: i}}, area: {interface: area, of: {interface: i}}}
END
expect "corners" 0 "$talus" run corners.yaml --out run --force --quiet
near along "$(last 3)" -420 1e-3
near area "$(last 4)" 0.84 1e-3

# A gap of the digits in which places are written is none.
for low in 0.8100000001 0.810005; do
  expect "a gap, $low" 0 "$talus" run corners.yaml --set "bodies[1].shape.box.min=[0.58, $low]" --out run --force --quiet
  near along "$(last 3)" -420 1e-3
done

# --- adhesion of a body that is pushed over another one: of the whole joint in every step, whichever of its points bear ---
cat >joint.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, end: 2, steps: 20}
grid: {box: {min: [0, 0], max: [2, 1]}, size: 0.125}
bodies:
  - {name: low, shape: {box: {min: [0, 0], max: [2, 0.5]}}, material: m, points_per_cell: 4}
  - {name: up, shape: {box: {min: [0.5, 0.5], max: [1.5, 1]}}, material: m, points_per_cell: 4}
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0}}
boundary: [{name: floor, on: {boundary: bottom}, fix: [x, y]}]
walls: [{name: push, shape: {box: {min: [0.25, 0.505], max: [0.5, 0.7]}}, bodies: [up], motion: [{displacement: {x: 0.1}, amplitude: [[0, 0], [1, 0], [2, 1]]}]}]
interfaces: [{name: i, between: [up, low], contact: friction, adhesion: 2e4}]
loads: {tractions: [{on: {body: up, y: 1}, value: [0, -1e5], amplitude: [[0, 0], [1, 1]]}]}
measures: {along: {interface_force: x, of: {interface: i}}, area: {interface: area, of: {interface: i}}}
END
expect "a joint" 0 "$talus" run joint.yaml --set linear=direct --out run --force --quiet
awk -F, 'NR > 1 && $1 > 1.2 && ($3 > -19800 || $3 < -20200 || $4 < 0.999 || $4 > 1.001) { bad = 1; print } NR > 1 && $1 > 1.2 { ++n } END { exit bad || n < 8 }' run/history.csv >out.txt ||
  fail "$name: $(cat out.txt)"

# --- a block that a floor's adhesion stops after v^2 m / 2 c: in dynamics, too ---
cat >stops.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.5, step: 4e-3}
grid: {box: {min: [0, 0], max: [3, 1.5]}, size: 0.125}
bodies: [{name: up, shape: {box: {min: [0.5, 0.5], max: [1.5, 1]}}, material: m, k0: 0, velocity: [1, 0]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
walls: [{name: w, shape: {half-space: {point: [0, 0.5], normal: [0, 1]}}, contact: friction, adhesion: 1000}]
loads: {gravity: [0, -10]}
measures: {left: {momentum: x}, at: {position: x, of: {tracer: [1, 0.75]}}, area: {contact: area, of: {wall: w}}}
END
expect "stops" 0 "$talus" run stops.yaml --out run --force --quiet
awk -F, 'END { exit !($3 < 10 && $3 > -10 && ($4 - 1.25) ^ 2 < 4e-6 && $5 > 0.99 && $5 < 1.01) }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"

# --- a wedge into a block: along the edge that it has turned every point touches ---
cat >wedge.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 10}
grid: {box: {min: [0, -1], max: [1, 0]}, size: 0.03125}
bodies: [{name: b, shape: {box: {min: [0, -1], max: [1, 0]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {boundary: left}, fix: [x]}, {on: {boundary: right}, fix: [x]}, {on: {boundary: bottom}, fix: [x, y]}]
walls: [{name: wedge, shape: {polygon: [[0, 0], [0.8, 0.4], [0, 0.4]]}, motion: [{displacement: {y: -0.15}}]}]
measures: {force: {wall_force: y, of: {wall: wedge}}, area: {contact: area, of: {wall: wedge}}}
END
expect "a wedge" 0 "$talus" run wedge.yaml --out run --force --quiet
near area "$(last 4)" 0.171 0.11 # half of it before; an edge of a cell is 0.035

# --- a wall that is not for all bodies may stand in others ---
sed 's/^bodies:.*/bodies:\n  - {name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}\n  - {name: other, shape: {box: {min: [1.4, 0], max: [1.8, 1]}}, material: m}/; s/adhesion: 100, motion.*/bodies: [b]}/; s/normal: \[1, 0\]}}/&, bodies: [b]/' side.yaml >others.yaml
expect "a wall in another body" 0 "$talus" check others.yaml --set 'walls[3].bodies=[b]' --set analysis.type=dynamic --set analysis.steps=null --set analysis.end=1 --set analysis.step=0.01
! grep -q "goes through" err.txt || fail "$name: $(cat err.txt)"
sed -i 's/bodies: \[b\]/bodies: [other]/' others.yaml
expect "a wall in its body" 2 "$talus" check others.yaml --set analysis.type=dynamic --set analysis.steps=null --set analysis.end=1 --set analysis.step=0.01
says err.txt "wall 'right' goes through a body at the start"

# --- a foot that lies almost in a plane of the grid: a body has one surface, not one in each layer of cells ---
cat >almost.yaml <<'END'
kinematics: 3d
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0, 0], max: [1.6, 1.6, 1.2]}, size: 0.1}
bodies:
  - name: b
    shape:
      intersection:
        - {half-space: {point: [0.8, 0.8, 0.6], normal: [-TX, -TY, -1]}}
        - {half-space: {point: [0.8, 0.8, 0.8], normal: [TX, TY, 1]}}
        - {box: {min: [XL, 0.6, 0], max: [XH, 1, 1.2]}}
    material: m
materials: {m: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
loads: {gravity: [0, 0, -9.81]}
walls: [{name: w, shape: {half-space: {point: [0.8, 0.8, 0.6], normal: [TX, TY, 1]}}, contact: stick}]
measures: {area: {contact: area, of: {wall: w}}}
END
for tilt in 0:0 1.7e-5:0 1e-4:3e-5 1.4e-3:1e-3 1.7e-2:5e-3; do
  case $tilt in 0:0) sides="0.55:1.05 0.6:1.1" ;; 1.7e-5* | 1.4e-3*) sides=0.6:1.1 ;; *) sides=0.55:1.05 ;; esac
  for side in $sides; do # beside the lines of the grid, and on them
    sed "s/TX/${tilt%:*}/g; s/TY/${tilt#*:}/g; s/XL/${side%:*}/; s/XH/${side#*:}/" almost.yaml >case.yaml
    expect "a foot tilted by $tilt, $side" 0 "$talus" run case.yaml --out run --force --quiet
    near area "$(last 3)" 0.2 0.01
  done
done

# --- sides of a container meet at its corners: what is largest on the floor is no mean of floor and sides ---
cat >container.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [-1, -1], max: [1.5, 1.5]}, size: 0.125}
bodies: [{name: b, shape: {polygon: [[0, 0], [CX, CY], [DX, DY], [EX, EY]]}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0.3}}
walls: [{name: w, inside: true, shape: {polygon: [[0, 0], [CX, CY], [DX, DY], [EX, EY]]}}]
loads: {gravity: [GX, GY]}
measures: {peak: {contact: peak_pressure, of: {wall: w}}}
END
for turned in 0 45; do # a block of 0.5 x 0.75 m, whose weight presses it on one side of 0.5 m
  awk -v t=$turned 'BEGIN { c = cos(t * 3.14159265358979 / 180); s = sin(t * 3.14159265358979 / 180)
    printf "s/CX/%.9f/g; s/CY/%.9f/g; s/DX/%.9f/g; s/DY/%.9f/g; ", 0.5 * c, 0.5 * s, 0.5 * c - 0.75 * s, 0.5 * s + 0.75 * c
    printf "s/EX/%.9f/g; s/EY/%.9f/g; s/GX/%.9f/; s/GY/%.9f/", -0.75 * s, 0.75 * c, 10 * s, -10 * c }' >turn.sed
  sed -f turn.sed container.yaml >case.yaml
  expect "a container turned by $turned" 0 "$talus" run case.yaml --out run --force --quiet
  near peak "$(last 3)" 7500 0.01
done

# --- a block on another one, at any angle, whichever is named first ---
cat >turned.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [-0.5, -0.5], max: [2.5, 2.5]}, size: 0.1}
bodies:
  - {name: up, shape: {polygon: [[A], [B], [C], [D]]}, material: m}
  - {name: low, shape: {polygon: [[E], [F], [G], [H]]}, material: m}
materials: {m: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
loads: {gravity: [GX, GY]}
walls: [{name: w, shape: {half-space: {point: [E], normal: [NX, NY]}}, contact: stick}]
interfaces: [{name: i, between: [up, low], contact: stick}]
measures: {force: {interface_force: y, of: {interface: i}}, area: {interface: area, of: {interface: i}}}
END
for turned in 0 1 10 17 30 45 80; do # 0.8 x 0.4 m on 1.4 x 0.4 m, with the middle of its foot at (1.013, 0.997)
  awk -v t=$turned 'function at(k, u, v) { printf "s/\\[%s\\]/[%.12f, %.12f]/; ", k, 1.013 + c * u - s * v, 0.997 + s * u + c * v }
    BEGIN { c = cos(t * 3.14159265358979 / 180); s = sin(t * 3.14159265358979 / 180)
    at("A", -0.4, 0); at("B", 0.4, 0); at("C", 0.4, 0.4); at("D", -0.4, 0.4)
    at("E", -0.7, -0.4); at("F", 0.7, -0.4); at("G", 0.7, 0); at("H", -0.7, 0)
    printf "s/NX/%.12f/; s/NY/%.12f/; s/GX/%.12f/; s/GY/%.12f/", -s, c, 10 * s, -10 * c }' >turn.sed
  sed -f turn.sed turned.yaml >case.yaml
  for order in 'up, low' 'low, up'; do
    case "$turned $order" in 1' 'up* | 10' 'low* | 30' 'up* | 45' 'low* | 80' 'up*) continue ;; esac
    expect "turned by $turned, $order" 0 "$talus" run case.yaml --set "interfaces=[{name: i, between: [$order], contact: stick}]" --out run --force --quiet
    near area "$(last 4)" 0.8 0.02
  done
done

# --- what is pressed and rests in dynamics touches as in statics, also the points that bear nothing ---
cat >round.yaml <<'END'
kinematics: axisymmetric
method: mpm
analysis: {type: dynamic, end: 0.7, step: 0.02, damping: 40}
grid: {box: {min: [0, 0], max: [1, 1.2]}, size: 0.05}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {x: 0}, fix: [x]}, {on: {x: 1}, fix: [x]}, {on: {y: 0}, fix: [y]}]
walls: [{name: ball, shape: {circle: {centre: [0, 1.5], radius: 0.5}}, motion: [{displacement: {y: -0.02}, amplitude: [[0, 0], [0.5, 1], [9, 1]]}]}]
measures: {force: {wall_force: y, of: {wall: ball}}, area: {contact: area, of: {wall: ball}}, peak: {contact: peak_pressure, of: {wall: ball}}}
END
for method in mpm gmm; do
  expect "$method pressed in statics" 0 "$talus" run round.yaml --set method=$method --set 'analysis={type: static, end: 0.5, steps: 4}' --out run --force --quiet
  force=$(last 3) area=$(last 4) peak=$(last 5)
  expect "$method at rest" 0 "$talus" run round.yaml --set method=$method --out run --force --quiet
  near force "$(last 3)" "$force" 5e-3
  near area "$(last 4)" "$area" 5e-3
  near peak "$(last 5)" "$peak" 0.06
done

# --- a sphere between plates, five cells in the radius of its contact: Hertz's pressure to the axis, though a ring there
# is 0.007 of a cell off the plate (peak 1.48, pressure beside the axis 1.52 of it without that ring's surface) ---
cat >sphere.yaml <<'END'
kinematics: axisymmetric
method: mpm
analysis: {type: static, steps: 4}
grid: {box: {min: [0, -0.0703125], max: [0.5625, 1.0703125]}, size: 0.015625}
bodies: [{name: b, shape: {circle: {centre: [0, 0.5], radius: 0.50046875}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {x: 0}, fix: [x]}]
walls:
  - {name: w, shape: {half-space: {point: [0, 0], normal: [0, 1]}}}
  - {name: top, shape: {half-space: {point: [0, 1], normal: [0, -1]}}, motion: [{displacement: {y: -0.02}}]}
measures:
  area: {contact: area, of: {wall: w}}
  peak: {contact: peak_pressure, of: {wall: w}}
  mean: {contact: pressure, of: {wall: w}}
  inner: {contact: pressure, of: {wall: w}, in: {box: {min: [0, -0.1], max: [0.03, 0.1]}}}
  force: {wall_force: y, of: {wall: w}}
END
expect "a sphere" 0 "$talus" run sphere.yaml --out run --force --quiet
expect "a sphere between plates on lines of the grid" 2 "$talus" check sphere.yaml --set 'grid.box={min: [0, -0.0625], max: [0.5625, 1.0625]}'
says err.txt "wall 'w' goes through a body" "let the wall stand amidst a row of cells"
# a^3 = 3 F R / 4 E', p0 = 3 F / 2 pi a^2; within 0.03 m of the axis the mean is 2/3 p0 (1 - (1 - s^2)^1.5) / s^2 with s = 0.03 / a
peak=$(awk -F, 'END { a = (0.75 * $7 * 0.50046875 * 0.91e-6) ^ (1 / 3); print 1.5 * $7 / 3.14159265 / a ^ 2 }' run/history.csv)
near peak "$(last 4)" "$peak" 0.05
near inner "$(last 6)" "$(awk -F, -v p="$peak" 'END { a = (0.75 * $7 * 0.50046875 * 0.91e-6) ^ (1 / 3); s = 0.03 / a; print p * 2 / 3 * (1 - (1 - s ^ 2) ^ 1.5) / s ^ 2 }' run/history.csv)" 0.05

# --- a body that lay along lines of the grid keeps its foot while its floor turns it, and adhesion what it bears ---
cat >turns.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 5}
grid: {box: {min: [0, 0], max: [4, 3]}, size: 0.125}
bodies: [{name: b, shape: {box: {min: [1.5, 1], max: [2.5, 1.25]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
walls: [{name: w, contact: bonded, shape: {half-space: {point: [2, 1], normal: [0, 1]}}, motion: [{rotation: {centre: [2, 1], rate: -0.5}, amplitude: [[0, 1], [1, 1]]}]}]
loads: {gravity: [0, -10], gravity_amplitude: [[0, 1], [1, 1]]}
measures: {area: {contact: area, of: {wall: w}}, mean: {contact: pressure, of: {wall: w}}}
END
expect "turned by its floor" 0 "$talus" run turns.yaml --out run --force --quiet
near area "$(last 3)" 1 1e-3
near mean "$(last 4)" 2193.95 1e-3 # 2500 cos 0.5
expect "turned by its floor in explicit steps" 0 "$talus" run turns.yaml --set 'analysis={type: explicit, end: 1, step: 0.02, damping: 20}' --out run --force --quiet
near area "$(last 3)" 1 2e-3
sed -e 's/plane-strain/3d/; s/min: \[0, 0\], max: \[4, 3\]/min: [0, 0, 0], max: [4, 3, 0.75]/; s/min: \[1.5, 1\], max: \[2.5, 1.25\]/min: [1.5, 1, 0.125], max: [2.5, 1.25, 0.625]/' \
  -e 's/point: \[2, 1\], normal: \[0, 1\]/point: [2, 1, 0], normal: [0, 1, 0]/; s/centre: \[2, 1\]/centre: [2, 1, 0], axis: [0, 0, 1]/; s/gravity: \[0, -10\]/gravity: [0, -10, 0]/' turns.yaml >case.yaml
expect "turned by its floor in space" 0 "$talus" run case.yaml --out run --force --quiet
near area "$(last 3)" 0.5 1e-3
# it slides where 10 sin t = 0.2 x 10 cos t + 3, at 0.496
expect "tilted" 1 "$talus" run turns.yaml --set 'walls[0].contact=friction' --set 'walls[0].friction=0.2' --set 'walls[0].adhesion=750' \
  --set 'walls[0].motion[0].rotation.rate=-0.75' --set analysis.steps=75 --set analysis.smallest=1e-3 --out run --force --quiet
near angle "$(awk -F, 'END { print 0.75 * $1 }' run/history.csv)" 0.496 0.02

# --- explicit steps let material in by more than its lowest layer of points is thick: its surface counts once ---
cat >thin.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: explicit, end: 1.5, step: 0.02, damping: 5}
grid: {box: {min: [-0.5, -0.5], max: [2.5, 2]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0.245], max: [1.5, 1.245]}}, points_per_cell: 4, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 2e5, poisson: 0}}
walls: [{name: w, shape: {half-space: {point: [0, 0.245], normal: [0, 1]}}, friction: 0, adhesion: 2000}]
loads: {gravity: [4, -9.81]}
measures: {area: {contact: area, of: {wall: w}}, mean: {contact: pressure, of: {wall: w}}, along: {wall_force: x, of: {wall: w}}, momentum: {momentum: x}}
END
# thin RANKS CASE AREA PRESSURE ADHESION MOMENTUM OPTIONS...
thin() {
  ranks=$1 thin=$2 area=$3 mean=$4 along=$5 momentum=$6
  shift 6
  expect "a thin layer in explicit steps, $thin $*" 0 on_ranks $ranks "$talus" run "$thin" "$@" --out run --force --quiet
  near area "$(last 3)" "$area" 0.015
  near mean "$(last 4)" "$mean" 0.025
  near along "$(last 5)" "$along" 0.015
  near momentum "$(last 6)" "$momentum" 0.015
}
# 1500 kg are pulled by 6000 N and held by 3000: momentum is 600 (1 - exp(-7.5))
thin 3 thin.yaml 1.5 9810 -3000 599.7
thin 1 thin.yaml 1.5 9810 -3000 599.7 --set 'basis={bspline: {}}'
thin 1 thin.yaml 1.5 9810 -3000 599.7 --set 'bodies[0].points_per_cell=9'
sed -e 's/plane-strain/3d/; s/min: \[-0.5, -0.5\], max: \[2.5, 2\]/min: [-0.5, -0.5, -0.5], max: [1.5, 1, 1]/; s/min: \[0, 0.245\], max: \[1.5, 1.245\]/min: [0, 0, 0.245], max: [0.75, 0.5, 0.745]/' \
  -e 's/points_per_cell: 4/points_per_cell: 8/; s/point: \[0, 0.245\], normal: \[0, 1\]/point: [0, 0, 0.245], normal: [0, 0, 1]/; s/gravity: \[4, -9.81\]/gravity: [4, 0, -9.81]/; s/adhesion: 2000/adhesion: 1000/' thin.yaml >space.yaml
thin 2 space.yaml 0.375 4905 -375 74.96

# ... in layers that end in steps across a slope of 2 degrees, too: as implicit steps have it
sed -e 's/box: {min: \[0, 0.245\], max: \[1.5, 1.245\]}/polygon: [[-0.749543, -0.031175], [0.749543, 0.021175], [0.714643, 1.020565], [-0.784443, 0.968216]]/; s/min: \[-0.5, -0.5\], max: \[2.5, 2\]/min: [-1.5, -0.5], max: [3, 2]/' \
  -e 's/point: \[0, 0.245\], normal: \[0, 1\]/point: [0, -0.005], normal: [-0.0348995, 0.9993908]/; s/gravity: \[4, -9.81\]/gravity: [3.3424, -9.6994]/' thin.yaml >slope.yaml
expect "a thin layer on a slope" 0 "$talus" run slope.yaml --out run --force --quiet
near area "$(last 3)" 1.4939 5e-3

# ... and on another body, whichever of them looks
sed -e 's/^bodies.*/bodies: [{name: b, shape: {box: {min: [0.5, 0.245], max: [2, 1.245]}}, material: m}, {name: c, shape: {box: {min: [0, -0.5], max: [3, 0.245]}}, material: m}]/; s/poisson: 0}/poisson: 0.3}/; s/max: \[2.5, 2\]/max: [4, 2]/' \
  -e 's/^walls.*/interfaces: [{name: w, between: [FIRST], contact: friction, friction: 0, adhesion: 1000}]/; s/gravity: \[4/gravity: [2/; s/end: 1.5/end: 1/' \
  -e 's/^measures.*/measures: {momentum: {momentum: x, of: {body: b}}}\nboundary: [{on: {boundary: bottom}, fix: [x, y]}]/' thin.yaml >both.yaml
for first in 'b, c' 'c, b'; do
  [ "$first" = 'b, c' ] && ranks=2 || ranks=1
  sed "s/FIRST/$first/" both.yaml >case.yaml
  expect "a thin layer on a body, $first" 0 on_ranks $ranks "$talus" run case.yaml --out run --force --quiet
  near momentum "$(last 3)" 298 0.05
done

# What has flowed keeps the surface that it had, as far as it has grown: a block of metal pressed to 0.7 between smooth
# platens, and drawn along by its adhesion
cat >pressed.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 1, steps: 20}
grid: {box: {min: [0, 0], max: [2, 1.25]}, size: 0.125}
bodies: [{name: block, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: metal}]
materials: {metal: {law: j2-log, density: 8000, young: 1e9, poisson: 0.3, yield_stress: 1e6}}
walls:
  - name: platen
    shape: {box: {min: [-1, 1], max: [4, 2]}}
    motion: [{displacement: {y: -0.3}, amplitude: [[0, 0], [0.75, 1], [1, 1]]}, {displacement: {x: 0.1}, amplitude: [[0, 0], [0.75, 0], [1, 1]]}]
    adhesion: 1e4
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}]
measures: {area: {contact: area, of: {wall: platen}}, along: {wall_force: x, of: {wall: platen}}}
output: {fields: [stress], every: end}
END
# sqrt(J) / 0.7 of the 1 m that it was, J - 1 = -5.6e-4 by the mean stress
for row in "mpm 1.25 2" "gmm 1 1"; do
  set -- $row
  expect "the area of what has flowed, $1" 0 on_ranks $3 "$talus" run pressed.yaml --out run --force --quiet --set method=$1 --set "grid.box={min: [0, 0], max: [$(awk -v m=$1 'BEGIN {print m == "mpm" ? 2 : 1}'), $2]}"
  near area "$(last 3)" 1.4275 5e-3
  near along "$(last 4)" 14275 5e-3
done

finish
