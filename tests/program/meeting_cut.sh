#!/bin/sh
# A plane face that lies across the cells is a plane face, whichever of them it cuts: what slides on it rubs by its
# normal force, and what slides without friction keeps its energy. Corners were taken for such that are none: forces
# along a slope of 17 degrees were 1.2 to 1.9 times as large as friction allows, in single steps, and a fifth of the
# energy of a block came from nothing.
. "$(dirname "$0")/library.sh"

# turned DEGREES X Y: a place or a vector of the level case.
turned() {
  awk -v t="$1" -v x="$2" -v y="$3" 'BEGIN { t *= atan2(0, -1) / 180; printf "[%.12f, %.12f]", x * cos(t) - y * sin(t), x * sin(t) + y * cos(t) }'
}
# box DEGREES LEFT BELOW RIGHT ABOVE
box() { echo "{polygon: [$(turned $1 $2 $3), $(turned $1 $4 $3), $(turned $1 $4 $5), $(turned $1 $2 $5)]}"; }
part() { awk -v t="$1" -v v="$2" -v f="$3" 'BEGIN { t *= atan2(0, -1) / 180; printf "%.12f", v * (f == "sin" ? sin(t) : cos(t)) }'; }

# --- a block that is pushed over the end of another one by 0.2 m, in statics ---
pushed() {
  cat <<END
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 1.1, steps: 22}
grid: {box: {min: [-0.75, -0.25], max: [2.25, 2]}, size: 0.125}
bodies:
  - {name: top, shape: $(box $1 0.75 0.5 1.75 1), material: rubber}
  - {name: base, shape: $(box $1 0 0 1.783 0.5), material: rubber}
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e8, poisson: 0.3}}
walls:
  - {name: floor, shape: {half-space: {point: [0, 0], normal: $(turned $1 0 1)}}, contact: bonded, bodies: [base]}
  - {name: pusher, shape: {half-space: {point: $(turned $1 0.75 0.5), normal: $(turned $1 1 0)}}, bodies: [top],
     motion: [{displacement: {x: $(part $1 0.2 cos), y: $(part $1 0.2 sin)}, amplitude: [[0.1, 0], [1.1, 1]]}]}
interfaces: [{name: i, between: [top, base], contact: friction, friction: 0.3}]
loads: {gravity: $(turned $1 0 -10), gravity_amplitude: [[0, 0], [0.1, 1]]}
measures: {x: {wall_force: x, of: {wall: pusher}}, y: {wall_force: y, of: {wall: pusher}}}
output: {fields: [displacement], every: end}
END
}
for turn in 10 17; do
  pushed $turn >pushed.yaml
  expect "pushed, $turn" 0 on_ranks $((turn == 17 ? 2 : 1)) "$talus" run pushed.yaml --out pushed --force --quiet
  awk -F, 'NR > 1 && $1 > 0.16 { p = sqrt($3 ^ 2 + $4 ^ 2); if (p < 1498 || p > 1502) bad = 1; ++n } END { exit bad || n != 19 }' pushed/history.csv || fail "$name: $(cut -d, -f1,3,4 pushed/history.csv)"
done

# --- one that slides without friction on another one, which is free itself, in dynamics ---
slides() {
  stress="-1e4 * (1 - (y * $(part $1 1 cos) - x * $(part $1 1 sin)))"
  given="{xx: $stress * $(part $1 1 sin)^2, yy: $stress * $(part $1 1 cos)^2, xy: $stress * (-$(part $1 1 sin)) * $(part $1 1 cos)}"
  cat <<END
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.2, step: 0.002}
grid: {box: {min: [-0.75, -0.25], max: [3.25, 2]}, size: 0.125}
bodies:
  - {name: top, shape: $(box $1 0.25 0.5 1.25 1), material: rubber, velocity: $(turned $1 1 0), stress: $given}
  - {name: base, shape: $(box $1 0 0 2.5 0.5), material: rubber, stress: $given}
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0}}
walls: [{name: floor, shape: {half-space: {point: [0, 0], normal: $(turned $1 0 1)}}}]
interfaces: [{name: i, between: [top, base], contact: frictionless}]
loads: {gravity: $(turned $1 0 -10)}
measures: {transfer: {energy: transfer}}
output: {fields: [displacement], every: end}
END
}
for turn in 10 26; do
  slides $turn >slides.yaml
  expect "slides, $turn" 0 "$talus" run slides.yaml --out slides --force --quiet
  awk -F, 'END { exit !($3 < 2.5 && $3 > -2.5) }' slides/history.csv || fail "$name: $(tail -n 1 slides/history.csv)" # of 250 J
done

# --- a block on a slope of 25 degrees, which needs a friction of 0.4628 to stand: its foremost point met a plane that
# was none, 0.6 of a cell ahead, and held it there in a single step (slid by 0.06 m, by 0.44) ---
cat >slope.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {gimp: {}}
analysis: {type: static, steps: 1}
grid: {box: {min: [-0.5, -0.5], max: [3, 2]}, size: 0.1}
bodies:
  - {name: wedge, material: r, shape: {polygon: [[0.033, -0.3], [2.233, -0.3], [2.233, 0], [0.033, 1.0258768479]]}}
  - {name: block, material: r,
     shape: {polygon: [[0.5767846722, 0.7723058909], [1.3018309019, 0.4342112815], [1.4708782065, 0.7967343963],
       [0.7458319769, 1.1348290057]]}}
materials: {r: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
walls: [{name: floor, shape: {half-space: {point: [0, -0.3], normal: [0, 1]}}, contact: bonded}]
interfaces: [{name: f, between: [block, wedge], friction: 0.44}]
loads: {gravity: [0, -9.81]}
output: {fields: [displacement], every: end}
END
expect "slides off" 1 "$talus" run slope.yaml --out slope --force --quiet --set analysis.smallest=1
says err.txt "Friction may be overcome: 'block' slides at 16 of the 16 places"
expect "stands" 0 on_ranks 2 "$talus" run slope.yaml --out slope --force --quiet --set 'interfaces[0].friction=0.48'

# --- a block of cells that are taller than wide, on flat ones: points at its corners are nearer to its ends than to its
# foot, which is plane all the same ---
tall() { # CELLS ROWS of the block, CELLS ROWS of the wedge: a mesh as gmsh writes it, which takes longer to start
  awk -v cells="$1 $3" -v rows="$2 $4" 'BEGIN {
    split(cells, c); split(rows, r); split("0.633 0.033", x0); split("1.433 2.233", x1); split("1.2 0.7", y0); split("1.6 1.2", y1)
    for (k = 1; k <= 2; ++k) {
      for (j = 0; j <= r[k]; ++j) for (i = 0; i <= c[k]; ++i)
        nodes = nodes sprintf("%d %.17g %.17g 0\n", ++n, x0[k] + (x1[k] - x0[k]) * i / c[k], y0[k] + (y1[k] - y0[k]) * j / r[k])
      for (j = 0; j < r[k]; ++j) for (i = 0; i < c[k]; ++i) {
        a = first + 1 + i + (c[k] + 1) * j
        elements = elements sprintf("%d 3 2 %d %d %d %d %d %d\n", ++e, k, k, a, a + 1, a + c[k] + 2, a + c[k] + 1)
      }
      if (k == 2) for (i = 0; i < c[k]; ++i) elements = elements sprintf("%d 1 2 3 3 %d %d\n", ++e, first + 1 + i, first + 2 + i)
      first = n
    }
    print "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 1 \"block\"\n2 2 \"wedge\"\n1 3 \"foot\"\n$EndPhysicalNames"
    print "$Nodes\n" n "\n" nodes "$EndNodes\n$Elements\n" e "\n" elements "$EndElements"
  }' >tall.msh
}
cat >tall.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1, smallest: 1}
grid: {mesh: tall.msh}
bodies:
  - {name: wedge, region: wedge, points_per_cell: 4, material: r}
  - {name: block, region: block, points_per_cell: 4, material: r}
materials: {r: {law: neo-hookean, density: 1000, young: 1e7, poisson: 0.3}}
boundary: [{on: {boundary: foot}, fix: [x, y]}]
interfaces: [{name: f, between: [block, wedge], friction: 0.45}]
loads: {gravity: [4.14588514768, -8.89087939083]}
measures: {x: {interface_force: x, of: {interface: f}}, y: {interface_force: y, of: {interface: f}}}
output: {fields: [displacement], every: end}
END
ranks=0
for method in gmm fem; do
  tall 5 2 14 7
  expect "stood, $method" 1 "$talus" run tall.yaml --out tall --force --quiet --set method=$method
  expect "stands, $method" 0 "$talus" run tall.yaml --out tall --force --quiet --set method=$method --set 'interfaces[0].friction=0.48'
  tall 5 2 8 4
  turn
  expect "was refused, $method" 0 on_ranks $ranks "$talus" run tall.yaml --out tall --force --quiet --set method=$method \
    --set 'loads.gravity=[0, -9.81]'
done
tall 5 2 14 7
expect "slides in time" 0 "$talus" run tall.yaml --out tall --force --quiet --set 'interfaces[0].friction=0.3' \
  --set 'analysis={type: dynamic, end: 0.2, step: 2e-3, bossak: -0.3}' --set 'loads.gravity_amplitude=[[0, 0], [0.2, 1]]'
awk -F, 'NR > 20 && ($3 / $4 > -0.29 || $3 / $4 < -0.31) { bad = 1 } END { exit bad }' tall/history.csv ||
  fail "$name: $(cut -d, -f1,3,4 tall/history.csv)"

# --- whole cells of a box along a slope are stairs: a run says so, and says nothing of level ones ---
sed 's/^method.*/method: fem/; /^basis/d; s/^analysis.*/analysis: {type: dynamic, end: 0.002, step: 0.001}/
  s/^interfaces.*/interfaces: [{name: f, between: [block, wedge], contact: frictionless}]/' slope.yaml >stairs.yaml
for method in fem gmm; do
  expect "stairs, $method" 0 on_ranks $(test $method = fem && echo 3 || echo 1) "$talus" run stairs.yaml --out stairs --force --quiet --set method=$method
  says err.txt "its shape slants at 'f'"
  expect "level, $method" 0 "$talus" run stairs.yaml --out stairs --force --quiet --set method=$method \
    --set 'bodies[0].shape={box: {min: [0, 0], max: [2, 0.73]}}' --set 'bodies[1].shape={box: {min: [0.5, 0.73], max: [1.27, 1.2]}}' \
    --set 'walls[0].shape={half-space: {point: [0, 0], normal: [0, 1]}}'
  lacks err.txt "slants at"
done

# --- cells 2.5 times as wide along the face as deep, whose neighbours are farther away than a cell is deep: a block that
# slides over ends keeps its momentum (872 of 1200 kg m/s before) ---
cat >flat.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: dynamic, end: 0.3, step: 5e-3}
grid: {box: {min: [-1.5, -0.4], max: [1, 0.8]}, size: [0.25, 0.1]}
bodies:
  - {name: base, shape: {box: {min: [-1.5, -0.4], max: [1, 0]}}, points_per_cell: 4, material: stiff}
  - {name: block, shape: {box: {min: [-1, 0], max: [0, 0.6]}}, points_per_cell: 4, material: stiff, velocity: [1, 0]}
materials: {stiff: {law: neo-hookean, density: 2000, young: 50e6, poisson: 0.3}}
boundary: [{name: bottom, on: {boundary: bottom}, fix: [x, y]}]
interfaces: [{name: joint, between: [base, block], contact: frictionless}]
loads: {gravity: [0, -9.81], gravity_amplitude: [[0, 0], [0.1, 1]]}
measures: {p: {momentum: x, of: {body: block}}}
END
expect "slides over flat cells" 0 "$talus" run flat.yaml --out flat --force --quiet
awk -F, 'END { exit !($3 > 1199.5 && $3 < 1200.5) }' flat/history.csv || fail "$name: $(tail -n 1 flat/history.csv)"

finish
