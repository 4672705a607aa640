#!/bin/sh
# What `boundary` holds of one of two bodies that meet, by `bodies`: at their interface both have nodes, and the other
# one slides on what is held. Without it a run says that it hangs there.
. "$(dirname "$0")/library.sh"

# A block under 10 kN is pushed along a base that is held up to its top face, friction 0.3: 3000 N.
cat >base.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, end: 1, steps: 4}
grid: {box: {min: [0, 0], max: [2, 1.25]}, size: 0.125}
bodies:
  - {name: up, shape: {box: {min: [0.5, 0.5], max: [1, 1]}}, material: s}
  - {name: low, shape: {box: {min: [0, 0], max: [2, 0.5]}}, material: s}
materials: {s: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
interfaces: [{name: i, between: [up, low], contact: friction, friction: 0.3}]
boundary: [{name: base, on: {y: [0, 0.5]}, fix: [x, y], bodies: [low]}]
walls: [{name: w, shape: {half-space: {point: [0.5, 0], normal: [1, 0]}}, bodies: [up],
  motion: [{displacement: {x: 0.02}}]}]
loads: {tractions: [{on: {body: up, y: 1}, value: [0, -2e4], amplitude: [[0, 1], [1, 1]]}]}
measures:
  push: {wall_force: x, of: {wall: w}}
  normal: {interface_force: y, of: {interface: i}}
  across: {reaction: x, of: {boundary: base}}
  below: {reaction: y, of: {boundary: base}}
output: {fields: [displacement], every: end}
checkpoint: {steps: 2, keep: 5}
END
# slides TOLERANCE: the end of the last run: push and normal force, and what holds the base bears both.
slides() {
  awk -F, -v t=$1 'function off(a, b) { return (a / b - 1) ^ 2 > t ^ 2 }
    END { exit off($(NF - 3), 3000) || off($(NF - 2), 1e4) || off($(NF - 1), -3000) || off($NF, 1e4) }' \
    run/history.csv ||
    fail "$name: $(tail -n 1 run/history.csv)"
  lacks err.txt "hangs on them"
}
for method in mpm fem gmm; do
  test $method = gmm && ranks=2 || ranks=1
  expect "a held base, $method, $ranks" 0 on_ranks $ranks "$talus" run base.yaml --out run --force --quiet \
    --set method=$method
  slides 1e-3
done
rm -f run/checkpoint*4*
expect "goes on" 0 "$talus" run --resume run --quiet
slides 1e-3
# The base goes back under the block, and takes its nodes along.
expect "a place that moves" 0 "$talus" run base.yaml --out run --force --quiet --set 'walls[0].motion=null' \
  --set 'boundary[0]={name: base, on: {y: [0, 0.5]}, displacement: {x: -0.02, y: 0}, moves: true, bodies: [low]}'
slides 1e-6

# The block comes in the second stage.
sed 's/^analysis.*/analysis: {type: static}/; /^loads/d; s/{name: up,/{name: up, absent: true,/
  s/bodies: \[up\],$/bodies: [up]}]/; /^  motion/d' \
  base.yaml >stages.yaml
cat >>stages.yaml <<'END'
stages:
  - {name: alone, analysis: {type: static, steps: 1}}
  - name: both
    analysis: {type: static, steps: 4}
    bodies: [{name: up, absent: false}]
    walls:
      - {name: w, shape: {half-space: {point: [0.5, 0], normal: [1, 0]}}, bodies: [up],
         motion: [{displacement: {x: 0.02}}]}
    loads: {tractions: [{on: {body: up, y: 1}, value: [0, -2e4], amplitude: [[0, 1], [1, 1]]}]}
END
expect "a later body" 0 "$talus" run stages.yaml --out run --force --quiet
slides 1e-3

# Held for all, the block hangs on the nodes of its foot.
expect "all, and half of them" 0 "$talus" check base.yaml --set 'boundary[0].bodies=[up, low]' \
  --set 'boundary[1]={on: {y: [0, 0.5]}, fix: [x, y], bodies: [low]}'
says out.txt "boundary[0]: moves 170 nodes of up, low" "boundary[1]: moves 85 nodes of low"
expect "hangs" 0 on_ranks 3 "$talus" check base.yaml \
  --set 'boundary[0]={name: base, on: {y: [0, 0.5]}, fix: [x, y]}'
says err.txt "boundary[0] takes nodes of 'up' (5), all of them where it takes 'low', which 'up' meets at" \
  "bodies: [low] takes 'low' alone"

# Bodies without an interface have the same nodes; names that are none.
expect "one field" 2 "$talus" check base.yaml --set interfaces=null --set measures=null
says err.txt "boundary[0] takes 'low' without 'up': no interface parts them" "between: [low, up]"
expect "no body" 2 "$talus" check base.yaml --set 'boundary[0].bodies=[lwo]'
says err.txt "there is no 'lwo' in bodies" "did you mean 'low'?"

# Two layers in a box, the lower one between rough sides, the upper one between smooth ones: 20 kN go through.
cat >layers.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [1, 1.125]}, size: 0.125}
bodies:
  - {name: up, shape: {box: {min: [0, 0.5], max: [1, 1]}}, material: s}
  - {name: low, shape: {box: {min: [0, 0], max: [1, 0.5]}}, material: s}
materials: {s: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
interfaces: [{name: i, between: [up, low], contact: frictionless}]
boundary:
  - {on: {y: 0}, fix: [x, y]}
  - {on: {x: 0, y: [0, 0.5]}, fix: [x, y], bodies: [low]}
  - {on: {x: 1, y: [0, 0.5]}, fix: [x, y], bodies: [low]}
  - {on: {boundary: left}, fix: [normal], bodies: [up]}
  - {on: {x: 1}, fix: [x]}
loads: {tractions: [{on: {body: up, y: 1}, value: [0, -2e4]}]}
measures: {normal: {interface_force: y, of: {interface: i}}}
output: {every: end}
END
expect "rough sides" 0 "$talus" run layers.yaml --out run --force --quiet
lacks err.txt "hangs on them"
awk -F, 'END { exit ($3 / 2e4 - 1) ^ 2 > 1e-9 ^ 2 }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"

# A block flies over a base that is held to the row of nodes below its top face, which the block's domains reach; what
# only the run finds it says at its end. Without friction it keeps its 1 m/s.
flies() {
  expect "flies$1" 0 "$talus" run base.yaml --out run --force --quiet --set walls=null --set 'basis={gimp: {}}' \
    --set 'analysis={type: dynamic, end: 0.1, step: 5e-3}' --set grid.size=0.0625 --set 'bodies[0].velocity=[1, 0]' \
    --set 'materials.s.young=1e7' --set 'interfaces[0]={name: i, between: [up, low]}' --set 'bodies[0].k0=0' \
    --set 'bodies[1].k0=0' --set 'loads={gravity: [0, -10]}' \
    --set 'measures={way: {displacement: x, of: {tracer: [0.75, 0.75]}}}' \
    --set "boundary[0]={name: base, on: {y: [0, 0.44]}, fix: [x, y]$1}" --set analysis.end=$2
}
flies ', bodies: [low]' 0.1
lacks err.txt "hangs on them"
awk -F, 'END { exit ($3 / 0.1 - 1) ^ 2 > 1e-3 ^ 2 }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
flies '' 0.01
says err.txt "'up' hangs on them"

# In a mesh nodes are those of the cells of bodies: two layers of two cells.
cat >two.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "low"
2 2 "up"
$EndPhysicalNames
$Nodes
12
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
7 0 1 0
8 1 1 0
9 2 1 0
10 0 2 0
11 1 2 0
12 2 2 0
$EndNodes
$Elements
4
1 3 2 1 1 1 2 5 4
2 3 2 1 1 2 3 6 5
3 3 2 2 2 7 8 11 10
4 3 2 2 2 8 9 12 11
$EndElements
END
cat >mesh.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, steps: 1}
grid: {mesh: two.msh}
bodies:
  - {name: low, region: low, points_per_cell: 4, material: s}
  - {name: up, region: up, points_per_cell: 4, material: s}
materials: {s: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
interfaces: [{name: i, between: [up, low], contact: frictionless}]
boundary:
  - {on: {y: [0, 1]}, fix: [x, y], bodies: [low]}
  - {on: {x: 0}, fix: [x], bodies: [up]}
loads: {tractions: [{on: {body: up, y: 2}, value: [0, -1e4]}]}
measures: {normal: {interface_force: y, of: {interface: i}}}
output: {every: end}
END
expect "what check says of a mesh" 0 "$talus" check mesh.yaml
says out.txt "boundary[0]: moves 6 nodes of low" "boundary[1]: moves 2 nodes of up"
expect "a mesh" 0 on_ranks 2 "$talus" run mesh.yaml --out run --force --quiet
awk -F, 'END { exit ($3 / 2e4 - 1) ^ 2 > 1e-9 ^ 2 }' run/history.csv || fail "$name: $(tail -n 1 run/history.csv)"
expect "hangs in a mesh" 0 "$talus" check mesh.yaml --set 'boundary[0]={on: {y: [0, 1]}, fix: [x, y]}'
says err.txt "boundary[0] takes nodes of 'up' (3)"
finish
