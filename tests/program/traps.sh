#!/bin/sh
# What is right by the letter and hardly meant is said where the user stands, and what is meant is not cried at.
. "$(dirname "$0")/library.sh"

# only: the last check warned once.
only() { [ "$(grep -c warning: err.txt)" -eq 1 ] || fail "$name: more than one warning"; }

# warned NAME TEXT... -- OPTION...: `check` of case.yaml passes, and warns with all these texts; without a text it must be silent.
warned() {
  name=$1
  shift
  : >texts.txt
  while [ "$1" != -- ]; do
    echo "$1" >>texts.txt
    shift
  done
  shift
  expect "$name" 0 "$talus" check case.yaml "$@"
  while read -r text; do says err.txt "$text"; done <texts.txt
  [ -s texts.txt ] || [ ! -s err.txt ] || fail "$name: it warns"
}

# --- a slope of 10 m on 10 m of ground, held by rollers: its first stress is that of what is there ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [40, 22]}, size: 1}
bodies:
  - {name: soil, shape: {polygon: [[0, 0], [40, 0], [40, 10], [25, 10], [15, 20], [0, 20]]}, fill: cells, material: soil, k0: 0.5}
materials:
  soil: {law: mohr-coulomb, density: 2000, young: 1e8, poisson: 0.3, friction_angle: 35, cohesion: 20e3}
boundary:
  - {name: floor, on: {boundary: bottom}, fix: [x, y]}
  - {on: {x: 0}, fix: [x]}
  - {on: {x: 40}, fix: [x]}
loads: {gravity: [0, -9.81]}
measures:
  weight: {mass: total}
  floor: {reaction: y, of: {boundary: floor}}
  crest: {displacement: y, of: {tracer: [5, 19]}}
  dissipated: {energy: dissipated}
END
# last COLUMN: of the last row.
last() { tail -n 1 run/history.csv | cut -d, -f "$1"; }
instant='analysis={type: dynamic, end: 1e-5, step: 1e-5}'
expect "a slope" 0 on_ranks 3 "$talus" run case.yaml --out run --force --quiet --set "$instant"
awk -v m="$(last 3)" -v r="$(last 4)" 'BEGIN { d = r / (m * 9.81) - 1; exit !(d < 1e-9 && d > -1e-9) }' ||
  fail "$name: the floor carries $(last 4) N of $(last 3) kg"
expect "a slope in statics" 0 "$talus" run case.yaml --out run --force --quiet
says run/log.txt "gravity = from the start"
# what k0 lacks was taken away before the first step, which moves nothing and dissipates nothing but round-off
awk -v u="$(last 5)" -v d="$(last 6)" 'BEGIN { exit !(u <= 0 && u > -1e-6 && d > -1e-9 && d < 1e-9) }' || fail "$name: the crest moves by $(last 5) m, dissipated $(last 6) J"
warned "a surface where it is" -- --set 'bodies[0].surface=20'
warned "a surface that is not there" "warning: the highest material above 'soil' ends at a height of 20 m, not at 30 m" \
  "loads.tractions" -- --set 'bodies[0].surface=30'
expect "k0 under gravity that grows" 2 "$talus" check case.yaml --set 'loads.gravity_amplitude=[[0, 0], [1, 1]]'
says err.txt "gravity is 0 at the start, but k0 of 'soil' gives the stress that carries it" "leave gravity_amplitude out"
expect "k0 without gravity" 2 "$talus" check case.yaml --set 'loads.gravity=[0, 0]'
says err.txt "k0 gives 'soil' the stress that carries its weight, but there is no gravity"

# --- locking ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static, end: 1, step: 0.1}
grid: {box: {min: [0, -3], max: [5, 0]}, size: 0.25}
bodies:
  - {name: soil, shape: {box: {min: [0, -3], max: [5, 0]}}, material: clay, points_per_cell: 4}
materials:
  clay: {law: mohr-coulomb, density: 1e-3, young: 1e5, poisson: 0.3, friction_angle: 0, cohesion: 100}
boundary:
  - {on: {boundary: bottom}, fix: [x, y]}
  - {on: {x: 0}, fix: [x]}
  - {on: {x: 5}, fix: [x]}
loads: {tractions: [{on: {body: soil, x: [0, 1], y: 0}, value: [0, -1000]}]}
END
warned "a material of no body" "warning: materials.rock has no effect here: no body is made of it" -- --set formulation=mixed \
  --set 'materials.rock={law: neo-hookean, density: 1000, young: 1e9, poisson: 0}'
only # the mixed formulation does not lock
warned "a material that has been of a body, and friction" -- --set 'materials.sand={law: mohr-coulomb, density: 1e-3, young: 1e5, poisson: 0.3, friction_angle: 20, cohesion: 100}' --set 'bodies[0].material=sand'
warned "undrained clay" "case.yaml:8:86: warning: 'clay' yields without any change of its volume: with displacements as the only unknowns quadrilaterals lock" \
  '`formulation: mean-dilatation` keeps that away, and so does `mixed`' --
warned "triangles of J2" "'clay' yields without any change of its volume" "triangles lock" '`formulation: mixed` keeps that away' -- \
  --set grid.cell=triangle --set 'bodies[0].points_per_cell=3' --set 'materials.clay={law: j2, density: 1, young: 1e5, poisson: 0.3, yield_stress: 100}'
warned "clouds of rubber" "'clay' hardly changes its volume" "clouds lock" "method gmm has no mixed form: take mpm or fem" -- --set method=gmm \
  --set 'materials.clay={law: neo-hookean, density: 1, young: 1e5, poisson: 0.49}'
warned "rubber by its moduli" "'clay' hardly changes its volume" -- --set 'materials.clay={law: neo-hookean, density: 1, bulk: 1e6, shear: 1e4}'
# Cam clay with K = p (1 - kappa / v) / (kappa / v): 0.49 is K = 149 / 3 G, reached at p = 1e4 149 / 3 0.02 / 0.98 = 10136 Pa, whatever its reference.
for way in "1.02e4 2" "1.01e4 1"; do
  set -- $way
  pressure=$1
  expect "clay under $pressure" 0 on_ranks $2 "$talus" check case.yaml --set loads="{}" --set "bodies[0].stress={xx: \"-$pressure\", yy: \"-$pressure\", zz: \"-$pressure\"}" \
    --set 'materials.clay={law: modified-cam-clay, density: 1, critical_stress_ratio: 1, lambda: 0.1, kappa: 0.02, shear_modulus: 1e4, ocr: 2}'
  if [ $pressure = 1.02e4 ]; then says err.txt "'clay' hardly changes its volume under the stress that it begins with"; else lacks err.txt "hardly changes"; fi
done
warned "a shared volume" -- --set formulation=mean-dilatation
warned "a shared volume of triangles" "formulation 'mean-dilatation' does nothing for linear triangles" "take quadrilaterals" -- \
  --set formulation=mean-dilatation --set grid.cell=triangle --set 'bodies[0].points_per_cell=3'
cat >some.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 1 "block"
$EndPhysicalNames
$Nodes
5
1 0 -3 0
2 2.5 -3 0
3 5 -3 0
4 2.5 0 0
5 0 0 0
$EndNodes
$Elements
2
1 3 2 1 1 1 2 4 5
2 2 2 1 1 2 3 4
$EndElements
END
warned "a shared volume of some triangles" "does nothing for 1 of 2 cells, which are linear triangles" "SubdivisionAlgorithm = 1" -- \
  --set formulation=mean-dilatation --set 'grid={mesh: some.msh}' --set 'loads={gravity: [0, -10]}' \
  --set 'bodies=[{name: soil, region: block, material: clay, points_per_cell: 4}]' --set 'boundary=[{on: {y: -3}, fix: [x, y]}]'
expect "a shared volume by gmm" 2 "$talus" check case.yaml --set formulation=mean-dilatation --set method=gmm
says err.txt "formulation 'mean-dilatation' shares the volume of a cell among its points, and method gmm has no cells"
expect "a shared volume by gimp" 2 "$talus" check case.yaml --set formulation=mean-dilatation --set method=mpm --set 'basis={gimp: {}}'
says err.txt "formulation 'mean-dilatation' takes no other basis than 'cell', not 'gimp'"
warned "an ordinary solid" -- --set 'materials.clay={law: neo-hookean, density: 1, young: 1e5, poisson: 0.45}'

# --- a limit load: Prandtl's is 5.14 c, that is 0.514 of this one; eight cells under half the footing are 8 % too strong, four 13 % ---
expect "beyond Prandtl's load" 1 "$talus" run case.yaml --out run --force --quiet --set formulation=mixed --set grid.size=0.125 \
  --set 'grid.box={min: [0, -2], max: [3.5, 0]}' --set 'bodies[0].shape={box: {min: [0, -2], max: [3.5, 0]}}' --set 'boundary[2].on.x=3.5'
says err.txt "This may be a limit load, at load factor 0.55" "as far as at first"
expect "stopped for another reason" 1 "$talus" run case.yaml --out run --force --quiet --set formulation=mixed --set newton.max_iterations=2
says err.txt "the run gave up"
lacks err.txt "limit load"
expect "not begun" 1 "$talus" run case.yaml --out run --force --quiet --set formulation=mixed --set newton.max_iterations=1 --set analysis.step=1
lacks err.txt "limit load" "nan"
# a bar that yields all at once, at 2 c in plane strain: half of the traction
cat >case.yaml <<'END'
kinematics: plane-strain
method: fem
formulation: mixed
analysis: {type: static, end: 1, step: 0.1}
grid: {box: {min: [0, 0], max: [1, 2]}, size: 0.5}
bodies:
  - {name: bar, shape: {box: {min: [0, 0], max: [1, 2]}}, material: clay}
materials:
  clay: {law: mohr-coulomb, density: 1e-3, young: 1e6, poisson: 0.3, friction_angle: 0, cohesion: 100}
boundary:
  - {on: {boundary: bottom}, fix: [y]}
  - {on: {x: 0}, fix: [x]}
loads: {tractions: [{on: {body: bar, y: 2}, value: [0, 400]}]}
END
expect "a bar" 1 "$talus" run case.yaml --out run --force --quiet
says err.txt "This may be a limit load, at load factor 0.4999"
expect "a bar that is pulled by its end" 0 "$talus" run case.yaml --out run --force --quiet --set loads={} \
  --set 'boundary[2]={on: {y: 2}, displacement: {y: 0.1}}'

# --- a soft layer that shares its cells with what is around it ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
formulation: mixed
analysis: {type: factor-of-safety}
grid: {box: {min: [-1, 0], max: [9, 6]}, size: 1}
bodies:
  - {name: clay, shape: {difference: [{box: {min: [0, 0], max: [8, 5]}}, {box: {min: [0, 2.5], max: [8, 3.5]}}]}, material: stiff}
  - {name: layer, shape: {box: {min: [0, 2.5], max: [8, 3.5]}}, material: weak}
materials:
  stiff: {law: mohr-coulomb, density: 2000, young: 1e8, poisson: 0.4, friction_angle: 0, cohesion: 50e3}
  weak: {law: mohr-coulomb, density: 2000, young: 1e8, poisson: 0.4, friction_angle: 0, cohesion: 10e3}
boundary: [{on: {boundary: bottom}, fix: [x, y]}]
loads: {gravity: [0, -10]}
END
shared="case.yaml:11:3: warning: 100 % of the points of 'weak' share their cells with other materials"
warned "a layer in cells that it shares" "$shared" "six across it or more" --
expect "the same on two ranks" 0 on_ranks 2 "$talus" check case.yaml
says err.txt "$shared"
warned "a layer of cells of its own" -- --set 'grid.size=0.5'
warned "no strength is sought" -- --set 'analysis={type: static}'

# --- which way is down ---
cat >case.yaml <<'END'
kinematics: 3d
method: fem
analysis: {type: static}
grid: {box: {min: [0, 0, 0], max: [1, 1, 1]}, size: 0.5}
bodies:
  - {name: block, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
boundary:
  - {on: {boundary: bottom}, fix: [x, y, z]}
loads: {gravity: [0, 0, -9.81]}
END
warned "a floor beside gravity" "case.yaml:10:21: warning: 'bottom' is the side of the lowest y, but gravity points along -z, where nothing is held" \
  "there the side is called 'front'" --
warned "a wall beside a floor" -- --set 'boundary[1]={on: {z: 0}, fix: [z]}'
warned "a slope" -- --set 'loads.gravity=[0, -5, -8]'

# --- names ---
cantilever >case.yaml
expect "a side" 2 "$talus" check case.yaml --set 'boundary[0].on={boundary: rigth}'
says err.txt "a box has no boundary 'rigth'" "did you mean 'right'? There are: left, right, bottom, top"
expect "a list" 2 "$talus" list lawss
says err.txt "did you mean 'laws'?"
plate 1
cp case.yaml geo.yaml
# The same as two triangles, for names that are no matter of the .geo: gmsh takes as long as the rest.
cat >plate.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 2 "wall"
1 3 "edge"
2 1 "plate"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 3 0 0
3 3 1 0
4 0 1.5 0
$EndNodes
$Elements
4
1 1 2 3 3 2 3
2 1 2 2 2 4 1
3 2 2 1 1 1 2 3
4 2 2 1 1 1 3 4
$EndElements
END
for wrong in "grid.parameters.hh=0.1 grid.parameters.hh=0.1: error: the .geo of the case has no use for a number 'hh'|did you mean 'h'? There are: h" \
  "boundary[0].on.boundary=wal no boundary is named 'wal'|did you mean 'wall'? There are: wall, edge" \
  "loads.tractions[0].on.boundary=sky no boundary is named 'sky'|there are: wall, edge" \
  "loads.tractions[0].on.boundary=plate 'plate' is a region of cells, not a boundary|there are: wall, edge" \
  "boundary[0].on.boundary=plate 'plate' is a region of cells, not a boundary|there are: wall, edge" \
  "bodies[0].region=plat the mesh has no region 'plat'|did you mean 'plate'? There are: "; do
  case $wrong in *hh*) cp geo.yaml case.yaml ;; *) sed 's/mesh: plate.geo.*/mesh: plate.msh}/' geo.yaml >case.yaml ;; esac
  expect "${wrong%% *}" 2 "$talus" check case.yaml --set "${wrong%% *}"
  text=${wrong#* }
  says err.txt "${text%|*}" "${text#*|}"
  lacks err.txt "prescribed by other entries" "plate$"
done

cp geo.yaml case.yaml
# A .geo that gives a name a value itself does not listen; one that asks first does, and one that counts with it.
geo=$(sed -n 's/.*mesh: \([a-z]*\.geo\).*/\1/p' case.yaml)
cp "$geo" listens.geo
{ echo 'h = 0.5;' && cat listens.geo; } >"$geo"
expect "deaf" 2 "$talus" check case.yaml --set grid.parameters.h=0.25
says err.txt "grid.parameters.h=0.25: error: the .geo of the case gives 'h' a value itself: what it is told is lost" "DefineConstant[ name = value ]"
{ echo 'If (!Exists(h)) h = 0.5; EndIf' && cat listens.geo && echo 'h = 2 * h;'; } >"$geo"
expect "hears" 0 "$talus" check case.yaml --set grid.parameters.h=0.25

# --- cells in cells ---
cat >over.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0.36 0 0
6 1.36 0 0
7 1.36 1 0
8 0.36 1 0
$EndNodes
$Elements
2
11 3 2 1 1 1 2 3 4
12 3 2 1 1 5 6 7 8
$EndElements
END
cat >case.yaml <<'END'
kinematics: plane-strain
method: fem
analysis: {type: static}
grid: {mesh: over.msh}
bodies:
  - {name: plate, shape: {box: {min: [0, 0], max: [1.36, 1]}}, points_per_cell: 4, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
boundary:
  - {on: {x: 0}, fix: [x, y]}
END
expect "cells in cells" 2 "$talus" check case.yaml
says err.txt "case.yaml:4:14: error: 2 of 2 cells overlap others, so that material there would count twice: elements 11 and 12 share ("
sed -i 's/^5 0.36/5 1/; s/^6 1.36/6 2/; s/^7 1.36/7 2/; s/^8 0.36/8 1/; s/5 6 7 8/2 6 7 3/' over.msh
expect "cells side by side" 0 "$talus" check case.yaml --set 'bodies[0].shape.box.max=[2, 1]'
says out.txt "mass 2000 kg"
expect "a number for a .msh" 2 "$talus" check case.yaml --set grid.parameters.h=1
says err.txt "parameters are for a .geo; a .msh takes none"

# --- a drum: its rim must be closed ---
# drum EDGE...: four triangles about the middle, `rim`: these of their four outer edges.
drum() {
  cat <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "rim"
2 2 "inside"
$EndPhysicalNames
$Nodes
5
1 -1 0 0
2 0 -1 0
3 1 0 0
4 0 1 0
5 0 0 0
$EndNodes
$Elements
END
  echo $(($# + 4))
  for edge; do echo "$edge 1 2 1 1 $edge $((edge % 4 + 1))"; done
  for edge in 1 2 3 4; do echo "$((4 + edge)) 2 2 2 1 $edge $((edge % 4 + 1)) 5"; done
  echo '$EndElements'
}
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 1, step: 0.1}
grid: {mesh: drum.msh}
bodies:
  - {name: powder, shape: {polygon: [[-1, 0], [0, -1], [0, 0]]}, points_per_cell: 3, material: rubber}
materials:
  rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}
boundary:
  - {on: {boundary: rim}, rotation: {centre: [0, 0], rate: -1}}
END
drum 1 2 3 4 >drum.msh
warned "a drum" --
drum 1 2 3 >drum.msh
warned "a drum that is not closed" "case.yaml:10:21: warning: 'rim' turns but is not closed: it ends at (-1, 0) and (0, 1) m" "every line of the drum's rim" --
expect "the same on two ranks" 0 on_ranks 2 "$talus" check case.yaml
says err.txt "'rim' turns but is not closed: it ends at (" "(-1, 0)" "(0, 1)"

# --- numbers that cannot be meant together (each by itself: input/test_case_bad) ---
block >case.yaml
expect "waves faster than light" 2 "$talus" check case.yaml --set materials.rubber.density=1e-14
says err.txt "case.yaml:10:3: error: waves would run through 'rubber' at 5.19e+09 m/s, faster than light"
# at the bounds a body still falls: 5 cm in 0.1 s (functions that are averaged round differently: E times 1e-16 is no longer little there)
for extreme in young=6e19 density=1e-10; do
  expect "free fall with $extreme" 0 "$talus" run case.yaml --out run --force --quiet --set materials.rubber.$extreme --set 'basis={cell: {}}' --set boundary=[] --set bodies[0].spin=0 \
    --set bodies[0].velocity='[0, 0]' --set loads.gravity='[0, -10]' --set analysis.end=0.1 --set 'measures={y: {displacement: y, of: {tracer: [1, 0.75]}}}'
  awk -v y="$(last 3)" 'BEGIN { exit !(y < -0.04999999 && y > -0.05000001) }' || fail "$name: by $(last 3) m"
done

# --- a block of words forgotten, a sign lost, a number that no soil has ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 0.1, step: 1e-3}
grid: {box: {min: [0, 0], max: [4, 4]}, size: 0.5}
bodies:
  - {name: sand, shape: {box: {min: [1, 0], max: [3, 2]}}, material: sand}
materials:
  sand: {law: mohr-coulomb, density: 1600, young: 1e7, poisson: 0.3, friction_angle: 33, cohesion: 0}
boundary:
  - {on: {y: 0}, fix: [x, y]}
END
warned "nothing that acts" "nothing acts on what is here" 'weight is `loads: {gravity: [0, -9.81]}`' --
warned "a velocity" -- --set 'bodies[0].velocity=[0, 1]'
warned "weight in a later stage" -- --set 'stages=[{name: rest}, {name: fall, loads: {gravity: [0, -9.81]}}]'
warned "nothing in any stage" "nothing acts on what is here" -- --set 'stages=[{name: rest}, {name: more}]'
warned "weight upwards" "gravity points along +y, upwards, where nothing is held" 'downwards is `gravity: [0, -9.81]`' -- \
  --set 'loads={gravity: [0, 9.81]}'
warned "heights downwards" -- --set 'loads={gravity: [0, 9.81]}' --set 'boundary=[{on: {boundary: top}, fix: [x, y]}]' \
  --set 'bodies[0].shape={box: {min: [1, 2], max: [3, 4]}}'
warned "ground that leans" "warning: k0 of 8: the ground would press sideways 8 times as much as it weighs" -- \
  --set 'loads={gravity: [0, -9.81]}' --set 'bodies[0].k0=8'
only # weight is none

# --- what prescribed nodes of a restored grid push passes them; a wall that does the same bears the exact force ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 10}
grid: {box: {min: [-1, 0], max: [4, 2]}, size: 0.5}
bodies:
  - {name: bar, shape: {box: {min: [0, 0], max: [4, 1]}}, material: soft}
materials:
  soft: {law: neo-hookean, density: 1000, young: 2e6, poisson: 0}
boundary:
  - {on: {boundary: right}, fix: [x]}
  - {on: {boundary: bottom}, fix: [y]}
  - {on: {x: 0}, displacement: {x: 0.4}}
END
warned "nodes that stay" "case.yaml:12:18: warning: material is moved by 0.8 cells along x, and the nodes that move it stay where they are" \
  "contact: bonded or stick" --
for on in '{x: [-1, 0.01]}' '{shape: {box: {min: [-1, 0], max: [0.6, 2]}}}'; do
  warned "the same nodes by $on" "warning: material is moved by 0.8 cells along x, and the nodes that move it stay where they are" -- --set "boundary[2].on=$on"
done
warned "what lies in the place altogether" -- --set 'boundary[2].on.x=[-1, 5]' --set 'boundary[0]={on: {boundary: top}, fix: [y]}'
warned "a place that hardly goes in" "this place has no depth along x" -- --set boundary[2].moves=true --set 'boundary[2].on.x=[-1, 0.1]'
warned "a small way" -- --set boundary[2].displacement.x=0.04
warned "fem" -- --set method=fem --set 'grid.box={min: [0, 0], max: [4, 1]}'
warned "a place that goes along" -- --set boundary[2].moves=true --set boundary[2].on.x='[-0.5, 0.5]'
warned "a plane that goes along" "this place has no depth along x" -- --set boundary[2].moves=true
# what is prescribed where no material is: in statics of mpm where it moves something, on a mesh always
beside="warning: no material is beside the 5 nodes that boundary[3] takes: what it prescribes does nothing"
apart() { warned "$@" --set 'boundary[2]={on: {x: [3, 4]}, displacement: {x: 0}}'; }
apart "moved beside the body" "$beside" -- --set 'boundary[3]={on: {x: -1}, displacement: {x: 0.01}}'
says out.txt "boundary[3]: moves 5 nodes, none beside material"
apart "moved far beside the body" "$beside" -- --set 'boundary[3]={on: {x: -1}, displacement: {x: 0.4}}'
lacks err.txt "material is moved by"
for held in '{on: {x: -1}, fix: [x]}' '{on: {x: -1}, displacement: {x: 0}}' '{on: {x: [-1, 0]}, displacement: {x: 0.01}}' \
  '{on: {shape: {box: {min: [-1, 1.4], max: [4, 2]}}}, moves: true, displacement: {y: -0.01}}'; do
  apart "where material may come: $held" -- --set "boundary[3]=$held"
done
apart "dynamics" -- --set analysis='{type: dynamic, end: 0.1, step: 0.01}' --set 'boundary[3]={on: {x: -1}, velocity: {x: 4}}'
apart "held beside a mesh" "$beside" -- --set method=fem --set 'boundary[3]={on: {x: -1}, fix: [x]}'
expect "a wall for it" 0 "$talus" run case.yaml --out run --force --quiet \
  --set 'boundary=[{on: {boundary: right}, fix: [x]}, {on: {boundary: bottom}, fix: [y]}]' \
  --set 'walls=[{name: press, shape: {half-space: {point: [0, 0], normal: [1, 0]}}, contact: stick, motion: [{displacement: {x: 0.4}}]}]' \
  --set 'measures={press: {wall_force: x, of: {wall: press}}}'
awk -v f="$(last 3)" 'BEGIN { exit !(f > 211100 && f < 211122) }' || fail "$name: $(last 3) N" # mu (1 / l - l), l = 0.9

# --- nodes of gmm beside a body that glides along a plane ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 2}
grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [0.5, 0.5]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0, x: [0, 0.5]}, fix: [y]}]
loads: {tractions: [{on: {body: b, y: 0.5}, value: [0, 1e4]}]}
END
warned "a plane that goes on" "have nodes in their clouds where no body has any, which the boundary holds in some directions and leaves free" \
  'hint: hold what the body has and no more' --
warned "a plane that ends with the body" -- --set 'boundary[0].on.y=[0, 0.5]'

# --- a place across gravity that points along x ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: dynamic, end: 1, step: 0.01}
grid: {box: {min: [-0.4, -0.2], max: [0, 0.2]}, size: 0.1}
bodies: [{name: s, shape: {box: {min: [-0.2, -0.1], max: [0, 0.1]}}, material: m}]
materials: {m: {law: mohr-coulomb, density: 2000, young: 1e6, poisson: 0.3, friction_angle: 30, cohesion: 0}}
boundary: [{on: {boundary: right}, fix: [x, y]}]
loads: {gravity: [9.81, 0]}
measures: {top: {free_surface: elevation, at: 0.05}}
END
warned "across gravity" --
expect "beside it" 2 "$talus" check case.yaml --set measures.top.at=-0.3
says err.txt "this is outside the grid"

# --- what never comes, and numbers of other units ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [4, 3]}, size: 0.5}
bodies:
  - {name: soil, shape: {box: {min: [0, 0], max: [4, 2]}}, material: soil}
materials:
  soil: {law: mohr-coulomb, density: 2000, young: 1e8, poisson: 0.3, friction_angle: 30, cohesion: 1e4}
boundary:
  - {on: {boundary: bottom}, fix: [x, y]}
  - {on: {boundary: left}, fix: [x]}
  - {on: {boundary: right}, fix: [x]}
loads: {gravity: [0, -9.81], gravity_amplitude: [[0, 0], [1, 1]]}
END
warned "gravity" --
warned "gravity too late, a wall too late, diagonals of squares, tonnes" "it is 0 until the end of the run, at t = 1 s: nothing of it ever acts" \
  "the run ends at t = 1 s: wall 'gate' never stands" "grid.diagonal has no effect here: quadrilaterals and hexahedra are not cut" \
  "'soil' weighs 2 kg a cubic metre, less than any soil" -- --set 'loads.gravity_amplitude=[[2, 0], [3, 1]]' \
  --set 'walls=[{name: gate, shape: {half-space: {point: [0, 2], normal: [0, -1]}}, from: 3}]' --set grid.diagonal=left --set materials.soil.density=2
warned "a tenth of gravity, millimetres" "the run ends at t = 1 s, where it is 0.1: it would be 1 at t = 10 s" \
  "gravity of 9810 m/s2 is 1e+03 times that of the earth" -- --set 'loads.gravity_amplitude=[[0, 0], [10, 1]]' --set 'loads.gravity=[0, -9810]'

# --- grains that long steps shear: the axes of stretch turn within a step, and speeds are off many times as far ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {cell: {}}
analysis: {type: dynamic, end: 2, step: 8e-3}
grid: {box: {min: [0, 0], max: [3e3, 0.125]}, counts: [3, 25], cell: quadrilateral}
bodies:
  - name: layer
    shape: {box: {min: [0, 0], max: [3e3, 0.1]}}
    material: grains
    stress: {xx: 13442.83 * (y - 0.1), yy: 13442.83 * (y - 0.1), zz: 13442.83 * (y - 0.1)}
materials:
  grains: {law: mu-i, density: 1500, young: 1e7, poisson: 0.3, static_friction: 0.38, limit_friction: 0.64, inertial_number: 0.279, grain_size: 0.02, grain_density: 2500}
boundary: [{on: {y: 0}, fix: [x, y]}]
loads: {gravity: [3.990086, -8.961881], gravity_amplitude: [[0, 1]]}
END
expect "long steps" 0 "$talus" run case.yaml --out run --force --quiet
says err.txt "warning: steps shear the grains by 0.01" "take half of it and compare"
expect "steps of a quarter" 0 "$talus" run case.yaml --out run --force --quiet --set analysis.step=2e-3
lacks err.txt "shear the grains"

# --- cells whose points do not hold a uniform stress: skew ones of mpm in statics, uneven nodes of gmm ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 1}
grid: {mesh: mesh.msh}
bodies: [{name: block, region: all, points_per_cell: 4, material: rubber}]
materials: {rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary:
  - {name: left, on: {x: 0}, fix: [x, y]}
  - {name: right, on: {x: 1}, displacement: {x: 1e-3, y: 0}}
END
# mesh X: four quadrilaterals of a square with its middle node at x = X, y = 0.5
mesh() {
  cat >mesh.msh <<END
\$MeshFormat
2.2 0 8
\$EndMeshFormat
\$PhysicalNames
1
2 1 "all"
\$EndPhysicalNames
\$Nodes
9
1 0 0 0
2 $1 0 0
3 1 0 0
4 0 0.5 0
5 $2 0.5 0
6 1 0.5 0
7 0 1 0
8 $1 1 0
9 1 1 0
\$EndNodes
\$Elements
4
1 3 2 1 1 1 2 5 4
2 3 2 1 1 2 3 6 5
3 3 2 1 1 4 5 8 7
4 3 2 1 1 5 6 9 8
\$EndElements
END
}
mesh 0.5 0.6
warned "skew cells" "points share skew cells equally" "weights: gauss" --
warned "skew cells with the weights of Gauss" -- --set 'bodies[0].weights=gauss'
warned "skew cells of fem" -- --set method=fem
warned "skew cells, clouds" -- --set method=gmm
mesh 0.2 0.2
warned "narrow cells are parallelograms" --
expect "uneven clouds" 0 on_ranks 2 "$talus" check case.yaml --set method=gmm
says err.txt "nodes of gmm at uneven distances: its points have from 0.025 to 0.1 m2" "fem is exact on the same mesh"

# --- a bonded wall that holds nothing ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
basis: {cell: {}}
analysis: {type: dynamic, end: 0.2, step: 0.01}
grid: {box: {min: [-1.03, -1.05], max: [0.97, 0.95]}, size: 0.1}
bodies: [{name: b, shape: {box: {min: [-0.4, -0.4], max: [0.4, 0.4]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e5, poisson: 0.3}}
walls: [{name: w, shape: {half-space: {point: [0, -0.4], normal: [0, 1]}}, contact: bonded}]
loads: {gravity: [0, -10]}
measures: {foot: {displacement: y, of: {tracer: [0, -0.39]}}}
END
warned "a wall below" "nothing touches wall 'w' at the start" -- --set walls[0].shape.half-space.point=[0,-0.41]
warned "a wall beside the lines" --
# Its surface in the middle of a row of cells, where Gauss's points are nearer to their cell's side than to it.
expect "held in the middle of a cell" 0 "$talus" run case.yaml --out held --force --quiet
awk -F, 'END { exit !($3 > -0.002 && $3 < 0) }' held/history.csv || fail "$name: $(tail -n 1 held/history.csv)"

# --- loads on slanting sides and points, explicit steps ---
# A wedge in free flight under a traction of 1 Pa: it gains that impulse, and next to no strain.
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: explicit, end: 0.5, step: 0.002}
grid: {box: {min: [-1, -1], max: [3, 3]}, size: 0.1}
bodies: [{name: b, shape: {polygon: [[0, 0], [1.5, 0], [0.5, 0.6], [0, 0.6]]}, material: m, velocity: [0.2, 0.3]}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
loads: {tractions: [{on: {body: b}, value: [0, 1]}]}
measures: {along: {momentum: x}, up: {momentum: y}, elastic: {energy: elastic}, mechanical: {energy: mechanical}}
END
expect "a wedge" 0 "$talus" run case.yaml --out wedge --force --quiet
# the circumference, 1.5 + sqrt(1.36) + 0.5 + 0.6, times 1 Pa and 0.5 s
awk -F, 'END { exit !(($3 / 120 - 1) ^ 2 < 1e-18 && ($4 / 181.883095 - 1) ^ 2 < 1e-12 && $5 < 1e-3 && $6 < 39.6) }' wedge/history.csv ||
  fail "$name: $(tail -n 1 wedge/history.csv)"
# A triangle that is pulled to one side all around gains all of the impulse, however far it goes: its points' nodes, too,
# where there is nothing around that could lead them.
sed -i -e 's/analysis: .*/analysis: {type: explicit, end: 0.8, step: 0.01}/' -e 's/polygon: .*, material: m.*/polygon: [[0.03, 0.03], [1.03, 0.31], [0.2, 1.1]]}, material: m}]/' \
  -e 's/value: .*/value: [1000, 0]}]}/' -e 's/max: \[3, 3\]/max: [5, 3]/' -e 's/along:/tip: {displacement: x, of: {tracer: [0.2, 1.099]}}, middle: {displacement: x, of: {tracer: [0.4, 0.5]}}, along:/' case.yaml
expect "a triangle" 0 on_ranks 2 "$talus" run case.yaml --out triangle --force --quiet
! grep -q "left behind" err.txt || fail "$name: loses its load"
# circumference: sqrt(1 + 0.28^2) + sqrt(0.83^2 + 0.79^2) + sqrt(0.17^2 + 1.07^2); the tip is pulled ahead
awk -F, 'END { exit !(($5 / 2614.19441 - 1) ^ 2 < 1e-16 && $3 > $4 && $3 < 1.1 * $4) }' triangle/history.csv || fail "$name: $(tail -n 1 triangle/history.csv)"

# --- a pressed surface that moves, where stress beside it is and is not borne by the nodes that bear the load ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: mpm
analysis: {type: static, steps: 4}
grid: {box: {min: [0, 0], max: [1.5, 1.5]}, size: 0.25}
bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}]
materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}
boundary: [{on: {boundary: left}, fix: [x]}, {on: {boundary: bottom}, fix: [y]}]
loads: {pressures: [{on: {body: b, y: 1}, value: 3e5}]}
END
expect "a pressed block" 0 "$talus" run case.yaml --out pressed --force --quiet
! grep -q "a loaded surface has moved" err.txt || fail "$name: $(cat err.txt)"
expect "a pressed block of the mixed formulation" 0 "$talus" run case.yaml --set formulation=mixed --out pressed --force --quiet
grep -q "a loaded surface has moved by .* cells: with the mixed formulation" err.txt || fail "$name: does not warn"
expect "a block that its weight presses, and a load of 0" 0 "$talus" run case.yaml --set formulation=mixed --out pressed --force --quiet \
  --set 'loads={gravity: [0, -600], pressures: [{on: {body: b, y: 1}, value: 0}]}'
lacks err.txt "a loaded surface has moved"

# --- a circular cone in plane strain: sin phi = 6 sin 35 / sqrt(3) (3 - sin 35), c = 20 kPa tan phi / tan 35 ---
sed -i -e 's/law: neo-hookean.*/law: drucker-prager, density: 1, young: 1e8, poisson: 0.3, friction_angle: 35, cohesion: 20e3}}/' case.yaml
cone="as strong as friction_angle 54.97 and cohesion 4.075e+04 Pa"
warned "a cone in plane strain" "materials: {m: {law: drucker-prager" "$cone" '`match: plane-strain`' --
warned "a cone of plane strain" -- --set materials.m.match=plane-strain
warned "a cone about the axis" -- --set kinematics=axisymmetric
warned "a cone that bears all" "bears any load" -- --set materials.m.friction_angle=45
warned "a cone without friction" "friction_angle 0 and cohesion 2.309e+04 Pa" -- --set materials.m.friction_angle=0

# --- cells that are flat, and layers that share nodes, of gmm ---
cat >case.yaml <<'END'
kinematics: plane-strain
method: gmm
analysis: {type: static, steps: 1}
grid: {box: {min: [0, 0], max: [2, 1]}, counts: [4, 8]}
bodies:
  - {name: soft, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}
  - {name: stiff, shape: {box: {min: [1, 0], max: [2, 1]}}, material: s}
materials:
  m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0}
  s: {law: neo-hookean, density: 1000, young: 2.9e6, poisson: 0}
boundary: [{on: {x: 0}, fix: [x]}, {on: {y: 0}, fix: [y]}]
loads: {tractions: [{on: {body: stiff, x: 2}, value: [1e4, 0]}]}
measures: {ux: {displacement: x, of: {tracer: [2, 1]}}}
END
flat="warning: its cells are up to 4 times as long as wide, as at (0.25, 0.0625) m: clouds of gmm are round"
expect "flat cells" 0 on_ranks 2 "$talus" check case.yaml
says err.txt "case.yaml:6:5: $flat" "case.yaml:7:5: warning: its cells"
warned "hardly flat cells" -- --set grid.counts='[4, 6]'
warned "hardly flat cells of mls" "up to 3 times as long" -- --set grid.counts='[4, 6]' --set 'basis={mls: {}}'
warned "square cells" -- --set grid.counts='[4, 2]' --set 'basis={mls: {}}'
warned "flat cells of fem" -- --set method=fem
warned "flat triangles" "times as long as wide" -- --set grid.cell=triangle --set 'bodies[0].points_per_cell=3' --set 'bodies[1].points_per_cell=3'
expect "layers" 0 "$talus" check case.yaml --set grid.counts='[8, 4]' --set materials.s.young=1e8
says err.txt "case.yaml:7:5: warning: 'soft' and 'stiff' share nodes, and one is 100 times as stiff: clouds of gmm reach over the seam" \
  "hint: - {name: ..., between: [soft, stiff], contact: bonded}"
warned "layers not so different" -- --set grid.counts='[8, 4]'
warned "layers that are bonded" -- --set grid.counts='[8, 4]' --set materials.s.young=1e8 \
  --set 'interfaces=[{name: seam, between: [soft, stiff], contact: bonded}]'

# --- a load that is there at once, in statics: half of its work is stored ---
at_once='loads.tractions[0].amplitude=[[0, 1], [1, 1]]'
seam='interfaces=[{name: seam, between: [soft, stiff], contact: bonded}]'
for way in "gmm $seam" "gmm interfaces=[]" "fem $seam"; do
  set -- "${way%% *}" "${way#* }"
  expect "a load at once, $way" 0 "$talus" run case.yaml --out run --force --quiet --set grid.counts='[8, 4]' --set method=$1 --set "$2" --set "$at_once"
  says err.txt "the transfer to what stops or holds it took 50 %" "a load that is there at once works twice what the body stores in statics"
done
expect "a load that grows" 0 "$talus" run case.yaml --out run --force --quiet --set grid.counts='[8, 4]' --set "$seam"
lacks err.txt "the transfer"

finish
